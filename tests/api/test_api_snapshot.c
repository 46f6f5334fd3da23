// test_api_snapshot.c - world hash, images, frames, deltas: what they promise, what they refuse.
#include "harness/heap.h"
#include "world_fixture.h"

#include <stdio.h>
#include <stdlib.h>

//---- worlds --------------------------------------------------------------------------------------

typedef struct pile {
    plumb_world *world;
    plumb_body bodies[40];
    plumb_shape shape; // of the first body
    plumb_component tag;
} pile;

static void count_calls(const plumb_system_call *call)
{
    int *calls = call->context;
    ++*calls;
}

static int calls;

// A heap of boxes and balls on the ground, one of them with a component, steps apart.
static void make_pile(pile *p, plumb_world_desc desc, int steps)
{
    assert_int_equal(plumb_world_create(&desc, &p->world), PLUMB_OK);
    plumb_world *w = p->world;
    p->tag = plumb_component_create(w, &(plumb_component_desc){ .name = "tag", .size = 8 });
    plumb_system_create(
        w, &(plumb_system_desc){
               .name = "count", .phase = PLUMB_PHASE_END, .run = count_calls, .context = &calls });
    plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, 1 } });
    for (int i = 0; i < 40; ++i) {
        p->bodies[i] = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(i % 8) - 4, R(1.6) + R(i / 8) * R(1.1) },
                                   .user_data = &p->bodies[i] });
        plumb_shape_desc d = { .kind = i % 4 == 3 ? PLUMB_CIRCLE : PLUMB_BOX, .user_data = p };
        if (d.kind == PLUMB_CIRCLE) {
            d.radius = R(0.5);
        } else {
            d.half = plumb_v2(R(0.5), R(0.5));
        }
        plumb_shape s = plumb_shape_create(w, p->bodies[i], &d);
        p->shape = i == 0 ? s : p->shape;
    }
    plumb_component_set(w, p->bodies[3], p->tag, "1234567");
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    }
}

typedef struct image {
    char *bytes;
    size_t size;
} image;

static image save(const plumb_world *w)
{
    image i = { .size = plumb_world_snapshot_size(w) };
    i.bytes = malloc(i.size);
    assert_non_null(i.bytes);
    assert_int_equal(plumb_world_save(w, i.bytes, i.size), PLUMB_OK);
    return i;
}

static image save_frame(const plumb_world *w, image base)
{
    image i = { .size = plumb_world_snapshot_size(w) };
    i.bytes = malloc(i.size);
    assert_non_null(i.bytes);
    assert_int_equal(plumb_world_save_frame(w, base.bytes, base.size, i.bytes, i.size, &i.size),
                     PLUMB_OK);
    return i;
}

static void step(plumb_world *w, int steps)
{
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    }
}

//---- hash ----------------------------------------------------------------------------------------

static void hash_sees_what_decides_motion(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    uint64_t before = plumb_world_hash(w);
    assert_true(before != 0);
    assert_true(plumb_world_hash(NULL) == 0);
#define CHANGES(call)                                                                              \
    do {                                                                                           \
        call;                                                                                      \
        uint64_t now_ = plumb_world_hash(w);                                                       \
        assert_true(now_ != before);                                                               \
        before = now_;                                                                             \
    } while (0)
    CHANGES(plumb_body_set_velocity(w, f->dynamic, plumb_v2(1, 0)));
    CHANGES(plumb_body_set_velocity(w, f->dynamic, plumb_v2(0, 1)));
    CHANGES(plumb_body_apply_torque(w, f->dynamic, 1));
    CHANGES(plumb_body_teleport(w, f->fixed, plumb_v2(0, -1), 0));
    CHANGES(plumb_body_set_gravity_scale(w, f->dynamic, 2));
    CHANGES(plumb_body_set_mass(w, f->dynamic, 2));
    CHANGES(plumb_world_set_gravity(w, plumb_v2(0, -1)));
    CHANGES(plumb_world_set_hit_speed(w, 1));
    CHANGES(plumb_shape_set_material(w, f->box, f->wood));
    CHANGES(plumb_shape_set_sensor(w, f->box, true));
    CHANGES(plumb_shape_set_filter(w, f->box, (plumb_filter){ .category = 4 }));
    CHANGES(plumb_material_set(w, f->wood, &(plumb_material_desc){ .friction = R(0.25) }));
    CHANGES(plumb_material_pair_set(w, f->wood, f->used, &(plumb_material_pair){ .friction = 1 }));
    CHANGES(plumb_world_exclude_pair(w, f->dynamic, f->fixed, true));
    CHANGES(plumb_component_set(w, f->dynamic, f->health, &(float){ 1 }));
    CHANGES(plumb_component_set(w, f->dynamic, f->health, &(float){ 2 }));
    CHANGES(plumb_entity_create(w));
    CHANGES(plumb_command_destroy(w, f->fixed));
    CHANGES(plumb_commands_apply(w));
    plumb_joint_desc hinge = { .body_a = f->dynamic, .body_b = f->kinematic };
    plumb_joint joint;
    CHANGES(joint = plumb_joint_create(w, &hinge));
    CHANGES(plumb_joint_set_motor(w, joint, true, 1, 2));
    CHANGES(step(w, 1));
    CHANGES(plumb_body_destroy(w, f->kinematic));
#undef CHANGES
}

static void hash_does_not_see_what_does_not(void **state)
{
    (void)state;
    pile a, b;
    make_pile(&a, (plumb_world_desc){ .simd_width = 4 }, 0);
    make_pile(&b, (plumb_world_desc){ .body_capacity = 1000, .contact_capacity = 99 }, 0);
    plumb_body_set_user_data(a.world, a.bodies[0], &a);
    plumb_shape_set_user_data(a.world, a.shape, NULL);
    plumb_body_set_mass(b.world, b.bodies[0], -1); // an error is on record
    for (int i = 0; i < 120; ++i) {
        // Queries file the grids at their own times.
        plumb_ray_hit hit;
        plumb_world_ray(b.world, plumb_v2(-9, R(i) / 9), plumb_v2(9, 1), NULL, &hit);
        assert_true(plumb_world_hash(a.world) == plumb_world_hash(b.world));
        if (i % 10 == 5) {
            plumb_body_teleport(a.world, a.bodies[i / 3], plumb_v2(0, 9), 1);
            plumb_body_teleport(b.world, b.bodies[i / 3], plumb_v2(0, 9), 1);
            plumb_world_ray(b.world, plumb_v2(0, 20), plumb_v2(0, -20), NULL, &hit);
        }
        step(a.world, 1);
        step(b.world, 1);
    }
    plumb_world_destroy(a.world);
    plumb_world_destroy(b.world);
}

static void components_count_by_their_fields(void **state)
{
    (void)state;
    typedef struct padded {
        char c; // no field: does not count
        double d;
        bool b;
    } padded;
    const plumb_field fields[] = { { "d", PLUMB_FIELD_F64, offsetof(padded, d), "m" },
                                   { "b", PLUMB_FIELD_BOOL, offsetof(padded, b), "1" } };
    uint64_t hash[3];
    const padded values[] = { { 'x', 1, true }, { 'y', 1, true }, { 'x', 1, false } };
    for (int i = 0; i < 3; ++i) {
        plumb_world *w = NULL;
        plumb_world_create(NULL, &w);
        plumb_component c = plumb_component_create(
            w, &(plumb_component_desc){
                   .name = "p", .size = sizeof(padded), .fields = fields, .field_count = 2 });
        plumb_component_set(w, plumb_entity_create(w), c, &values[i]);
        hash[i] = plumb_world_hash(w);
        plumb_world_destroy(w);
    }
    assert_true(hash[0] == hash[1]);
    assert_true(hash[0] != hash[2]);
}

//---- images --------------------------------------------------------------------------------------

// Steps of both worlds agree from here on.
static void go_on_alike(plumb_world *a, plumb_world *b)
{
    assert_true(plumb_world_hash(a) == plumb_world_hash(b));
    for (int i = 0; i < 60; ++i) {
        step(a, 1);
        step(b, 1);
        assert_true(plumb_world_hash(a) == plumb_world_hash(b));
        assert_true(digest_world(a) == digest_world(b));
    }
}

static void a_fresh_world_takes_an_image(void **state)
{
    (void)state;
    pile p, fresh;
    make_pile(&p, (plumb_world_desc){ .substeps = 3 }, 50);
    plumb_command_destroy(p.world, p.bodies[7]);
    plumb_command_teleport(p.world, p.bodies[8], plumb_v2(0, 20), 1);
    image i = save(p.world);
    // Other settings, capacities and contents: all of it becomes the image's.
    plumb_world_desc desc = { .gravity = { 1, 0 }, .solver = PLUMB_SOLVER_PGS, .simd_width = 4 };
    assert_int_equal(plumb_world_create(&desc, &fresh.world), PLUMB_OK);
    plumb_component_create(fresh.world, &(plumb_component_desc){ .name = "tag", .size = 8 });
    plumb_body_create(fresh.world, &(plumb_body_desc){ 0 });
    step(fresh.world, 5);
    assert_int_equal(plumb_world_restore(fresh.world, i.bytes, i.size), PLUMB_OK);
    plumb_world_desc got = plumb_world_settings(fresh.world);
    assert_int_equal(got.substeps, 3);
    assert_int_equal(got.solver, PLUMB_SOLVER_SOFT);
    assert_int_equal(got.simd_width, 4);
    assert_near(got.gravity.x, 0, 0);
    assert_ptr_equal(plumb_body_user_data(fresh.world, p.bodies[9]), &p.bodies[9]);
    assert_ptr_equal(plumb_shape_user_data(fresh.world, p.shape), &p);
    assert_string_equal(plumb_component_get(fresh.world, p.bodies[3], p.tag), "1234567");
    assert_null(plumb_component_get(fresh.world, p.bodies[4], p.tag));
    go_on_alike(p.world, fresh.world);
    assert_false(plumb_body_valid(fresh.world, p.bodies[7]));
    free(i.bytes);
    plumb_world_destroy(p.world);
    plumb_world_destroy(fresh.world);
}

static void what_came_after_the_image_is_gone(void **state)
{
    (void)state;
    pile p, twin;
    make_pile(&p, (plumb_world_desc){ 0 }, 30);
    make_pile(&twin, (plumb_world_desc){ 0 }, 30);
    image i = save(p.world);
    plumb_body late = plumb_body_create(p.world, &(plumb_body_desc){ .position = { 0, 30 } });
    plumb_shape_create(p.world, late, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 9 });
    plumb_component_set(p.world, late, p.tag, NULL);
    plumb_component_remove(p.world, p.bodies[3], p.tag);
    plumb_body_destroy(p.world, p.bodies[0]);
    plumb_world_set_gravity(p.world, plumb_v2(5, 5));
    plumb_system_enable(p.world, "count", false);
    step(p.world, 20);
    assert_int_equal(plumb_world_restore(p.world, i.bytes, i.size), PLUMB_OK);
    assert_false(plumb_body_valid(p.world, late));
    assert_true(plumb_body_valid(p.world, p.bodies[0]));
    assert_int_equal(plumb_world_column(p.world, p.tag).count, 1);
    assert_non_null(plumb_component_get(p.world, p.bodies[3], p.tag));
    // The handle that the next body gets is the one that `late` had.
    plumb_body again = plumb_body_create(p.world, &(plumb_body_desc){ .position = { 0, 30 } });
    plumb_body other = plumb_body_create(twin.world, &(plumb_body_desc){ .position = { 0, 30 } });
    assert_true(plumb_same(again, late) && plumb_same(other, late));
    calls = 0;
    step(p.world, 1);
    assert_int_equal(calls, 1);
    step(twin.world, 1);
    go_on_alike(p.world, twin.world);
    free(i.bytes);
    plumb_world_destroy(p.world);
    plumb_world_destroy(twin.world);
}

static void events_and_contacts_of_the_last_step_are_gone(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ .hit_speed = R(0.1) }, 0);
    int begins = 0;
    while (begins == 0) {
        step(p.world, 1);
        plumb_world_begin_events(p.world, &begins);
    }
    assert_true(plumb_world_contacts(p.world, NULL, 0) > 0);
    image i = save(p.world);
    assert_int_equal(plumb_world_restore(p.world, i.bytes, i.size), PLUMB_OK);
    int ends = 1, hits = 1, sensed = 1;
    assert_null(plumb_world_begin_events(p.world, &begins));
    assert_null(plumb_world_end_events(p.world, &ends));
    assert_null(plumb_world_hit_events(p.world, &hits));
    assert_null(plumb_world_sensor_begin_events(p.world, &sensed));
    assert_int_equal(begins + ends + hits + sensed, 0);
    assert_int_equal(plumb_world_contacts(p.world, NULL, 0), 0);
    assert_int_equal(plumb_world_stats(p.world).contact_count, 0);
    assert_int_equal(plumb_world_stats(p.world).color_count, 0);
    // What is still touching does not begin again.
    uint64_t hash = plumb_world_hash(p.world);
    step(p.world, 1);
    plumb_world_begin_events(p.world, &begins);
    int after = begins;
    plumb_world_restore(p.world, i.bytes, i.size);
    assert_true(plumb_world_hash(p.world) == hash);
    step(p.world, 1);
    plumb_world_begin_events(p.world, &begins);
    assert_int_equal(begins, after);
    assert_true(plumb_world_contacts(p.world, NULL, 0) > 0);
    free(i.bytes);
    plumb_world_destroy(p.world);
}

static void queries_see_the_restored_world(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 10);
    image i = save(p.world);
    plumb_ray_hit before, after;
    assert_true(
        plumb_world_ray(p.world, plumb_v2(R(-3.5), 20), plumb_v2(R(-3.5), -20), NULL, &before));
    for (int k = 0; k < 40; ++k) {
        plumb_body_teleport(p.world, p.bodies[k], plumb_v2(100, R(2) * R(k)), 0);
    }
    assert_int_equal(plumb_world_restore(p.world, i.bytes, i.size), PLUMB_OK);
    assert_true(
        plumb_world_ray(p.world, plumb_v2(R(-3.5), 20), plumb_v2(R(-3.5), -20), NULL, &after));
    assert_memory_equal(&before, &after, sizeof before);
    assert_false(plumb_world_ray(p.world, plumb_v2(80, 5), plumb_v2(120, 5), NULL, &after));
    free(i.bytes);
    plumb_world_destroy(p.world);
}

static void static_geometry_is_restored(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 10);
    plumb_ray_hit hit;
    image without = save(p.world);
    plumb_body wall = plumb_body_create(
        p.world, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 50, 0 } });
    plumb_shape_create(p.world, wall, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 2 });
    step(p.world, 1);
    image with = save(p.world);
    for (int i = 0; i < 4; ++i) {
        const image *now = i % 2 == 0 ? &without : &with;
        assert_int_equal(plumb_world_restore(p.world, now->bytes, now->size), PLUMB_OK);
        assert_int_equal(plumb_world_ray(p.world, plumb_v2(40, 0), plumb_v2(60, 0), NULL, &hit),
                         i % 2);
        step(p.world, 1);
        assert_int_equal(plumb_world_ray(p.world, plumb_v2(40, 0), plumb_v2(60, 0), NULL, &hit),
                         i % 2);
    }
    free(without.bytes);
    free(with.bytes);
    plumb_world_destroy(p.world);
}

static void images_of_one_state_are_equal(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 25);
    image a = save(p.world), b;
    step(p.world, 7);
    plumb_world_restore(p.world, a.bytes, a.size);
    b = save(p.world);
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.bytes, b.bytes, a.size);
    plumb_snapshot_info info;
    assert_int_equal(plumb_snapshot_read_info(a.bytes, a.size, &info), PLUMB_OK);
    assert_int_equal(info.bytes, a.size);
    assert_int_equal(info.step_count, 25);
    assert_near(info.time, 25.0 / 60, 1e-6);
    assert_false(info.is_frame);
    assert_int_equal(info.base_id, 0);
    free(a.bytes);
    free(b.bytes);
    plumb_world_destroy(p.world);
}

//---- frames --------------------------------------------------------------------------------------

static void a_frame_leaves_out_what_the_base_has(void **state)
{
    (void)state;
    pile p, twin;
    make_pile(&p, (plumb_world_desc){ 0 }, 20);
    make_pile(&twin, (plumb_world_desc){ 0 }, 20);
    image base = save(p.world);
    step(p.world, 10);
    step(twin.world, 10);
    image frame = save_frame(p.world, base);
    print_message("40 bodies: image %zu B, frame %zu B\n", base.size, frame.size);
    assert_true(frame.size < base.size / 2);
    plumb_snapshot_info info, base_info;
    assert_int_equal(plumb_snapshot_read_info(base.bytes, base.size, &base_info), PLUMB_OK);
    assert_int_equal(plumb_snapshot_read_info(frame.bytes, frame.size, &info), PLUMB_OK);
    assert_true(info.is_frame);
    assert_true(info.base_id == base_info.id);
    assert_int_equal(info.bytes, frame.size);
    // Whatever happens to the world meanwhile, structure included.
    step(p.world, 5);
    plumb_body_destroy(p.world, p.bodies[1]);
    plumb_material_create(p.world, &(plumb_material_desc){ 0 });
    step(p.world, 5);
    assert_int_equal(
        plumb_world_restore_frame(p.world, base.bytes, base.size, frame.bytes, frame.size),
        PLUMB_OK);
    go_on_alike(p.world, twin.world);
    free(base.bytes);
    free(frame.bytes);
    plumb_world_destroy(p.world);
    plumb_world_destroy(twin.world);
}

static void a_frame_holds_changed_structure(void **state)
{
    (void)state;
    pile p, twin;
    make_pile(&p, (plumb_world_desc){ 0 }, 20);
    make_pile(&twin, (plumb_world_desc){ 0 }, 20);
    image base = save(p.world);
    plumb_body_destroy(p.world, p.bodies[1]);
    plumb_body_destroy(twin.world, p.bodies[1]);
    plumb_body_set_mass(p.world, p.bodies[2], 7);
    plumb_body_set_mass(twin.world, p.bodies[2], 7);
    image frame = save_frame(p.world, base);
    assert_int_equal(plumb_world_restore(p.world, base.bytes, base.size), PLUMB_OK);
    assert_true(plumb_body_valid(p.world, p.bodies[1]));
    assert_int_equal(
        plumb_world_restore_frame(p.world, base.bytes, base.size, frame.bytes, frame.size),
        PLUMB_OK);
    assert_false(plumb_body_valid(p.world, p.bodies[1]));
    go_on_alike(p.world, twin.world);
    free(base.bytes);
    free(frame.bytes);
    plumb_world_destroy(p.world);
    plumb_world_destroy(twin.world);
}

//---- deltas --------------------------------------------------------------------------------------

static void a_delta_rebuilds_the_image(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 20);
    image from = save(p.world);
    for (int i = 0; i < 30; ++i) {
        step(p.world, i % 3);
        if (i % 7 == 3) {
            plumb_body_destroy(p.world, p.bodies[i]);
        }
        if (i % 7 == 5) {
            plumb_body b = plumb_body_create(p.world, &(plumb_body_desc){ .position = { 0, 9 } });
            plumb_shape_create(p.world, b,
                               &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
        }
        image to = save(p.world);
        size_t bound = plumb_snapshot_delta_bound(to.size), size = 0, back = 0;
        char *delta = malloc(bound), *rebuilt = malloc(to.size);
        assert_int_equal(
            plumb_snapshot_delta(from.bytes, from.size, to.bytes, to.size, delta, bound, &size),
            PLUMB_OK);
        assert_true(size <= bound && size < to.size);
        assert_int_equal(
            plumb_snapshot_apply(from.bytes, from.size, delta, size, rebuilt, to.size, &back),
            PLUMB_OK);
        assert_int_equal(back, to.size);
        assert_memory_equal(rebuilt, to.bytes, to.size);
        free(delta);
        free(rebuilt);
        free(from.bytes);
        from = to;
    }
    free(from.bytes);
    plumb_world_destroy(p.world);
}

static void frames_of_one_base_have_deltas_too(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 20);
    image base = save(p.world);
    step(p.world, 1);
    image from = save_frame(p.world, base);
    step(p.world, 3);
    image to = save_frame(p.world, base);
    char delta[65536], rebuilt[65536];
    size_t size, back;
    assert_int_equal(
        plumb_snapshot_delta(from.bytes, from.size, to.bytes, to.size, delta, sizeof delta, &size),
        PLUMB_OK);
    assert_true(size < to.size);
    assert_int_equal(
        plumb_snapshot_apply(from.bytes, from.size, delta, size, rebuilt, sizeof rebuilt, &back),
        PLUMB_OK);
    assert_int_equal(back, to.size);
    assert_memory_equal(rebuilt, to.bytes, to.size);
    assert_int_equal(
        plumb_snapshot_delta(base.bytes, base.size, to.bytes, to.size, delta, sizeof delta, &size),
        PLUMB_E_IMAGE);
    free(base.bytes);
    free(from.bytes);
    free(to.bytes);
    plumb_world_destroy(p.world);
}

//---- refusals ------------------------------------------------------------------------------------

static void damage_is_refused_whole(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 20);
    image base = save(p.world);
    step(p.world, 3);
    image frame = save_frame(p.world, base), whole = save(p.world);
    step(p.world, 3);
    uint64_t hash = plumb_world_hash(p.world);
    plumb_snapshot_info info;
    for (size_t i = 0; i < whole.size; ++i) {
        whole.bytes[i] ^= (char)(1 + i % 255);
        assert_int_equal(plumb_world_restore(p.world, whole.bytes, whole.size), PLUMB_E_IMAGE);
        whole.bytes[i] ^= (char)(1 + i % 255);
        assert_int_equal(plumb_world_restore(p.world, whole.bytes, i), PLUMB_E_IMAGE);
    }
    for (size_t i = 0; i < frame.size; ++i) {
        frame.bytes[i] ^= (char)0x80;
        assert_int_equal(
            plumb_world_restore_frame(p.world, base.bytes, base.size, frame.bytes, frame.size),
            PLUMB_E_IMAGE);
        frame.bytes[i] ^= (char)0x80;
        assert_int_equal(plumb_world_restore_frame(p.world, base.bytes, base.size, frame.bytes, i),
                         PLUMB_E_IMAGE);
    }
    for (size_t i = 0; i < base.size; i += 7) {
        base.bytes[i] ^= 1;
        assert_int_equal(
            plumb_world_restore_frame(p.world, base.bytes, base.size, frame.bytes, frame.size),
            PLUMB_E_IMAGE);
        assert_int_equal(plumb_snapshot_read_info(base.bytes, base.size, &info), PLUMB_E_IMAGE);
        base.bytes[i] ^= 1;
    }
    assert_true(plumb_world_hash(p.world) == hash);
    assert_int_equal(plumb_world_restore(p.world, whole.bytes, whole.size), PLUMB_OK);
    free(base.bytes);
    free(frame.bytes);
    free(whole.bytes);
    plumb_world_destroy(p.world);
}

static void damaged_deltas_are_refused(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 20);
    image from = save(p.world);
    step(p.world, 2);
    image to = save(p.world);
    char *delta = malloc(plumb_snapshot_delta_bound(to.size)), *out = malloc(to.size);
    size_t size, back;
    plumb_snapshot_delta(from.bytes, from.size, to.bytes, to.size, delta,
                         plumb_snapshot_delta_bound(to.size), &size);
    for (size_t i = 0; i < size; ++i) {
        delta[i] ^= (char)(1 + i % 255);
        assert_int_equal(
            plumb_snapshot_apply(from.bytes, from.size, delta, size, out, to.size, &back),
            PLUMB_E_IMAGE);
        delta[i] ^= (char)(1 + i % 255);
        assert_int_equal(plumb_snapshot_apply(from.bytes, from.size, delta, i, out, to.size, &back),
                         PLUMB_E_IMAGE);
    }
    // Not the image that it was made from.
    assert_int_equal(plumb_snapshot_apply(to.bytes, to.size, delta, size, out, to.size, &back),
                     PLUMB_E_IMAGE);
    assert_int_equal(
        plumb_snapshot_apply(from.bytes, from.size, delta, size, out, to.size - 1, &back),
        PLUMB_E_RANGE);
    assert_int_equal(plumb_snapshot_apply(from.bytes, from.size, delta, size, out, to.size, &back),
                     PLUMB_OK);
    char small[64];
    assert_int_equal(
        plumb_snapshot_delta(from.bytes, from.size, to.bytes, to.size, small, sizeof small, &size),
        PLUMB_E_RANGE);
    from.bytes[100] ^= 1;
    assert_int_equal(plumb_snapshot_delta(from.bytes, from.size, to.bytes, to.size, delta,
                                          plumb_snapshot_delta_bound(to.size), &size),
                     PLUMB_E_IMAGE);
    assert_int_equal(plumb_snapshot_delta(NULL, 0, to.bytes, to.size, delta, 1, &size),
                     PLUMB_E_NULL);
    assert_int_equal(plumb_snapshot_apply(from.bytes, from.size, NULL, 0, out, 1, &back),
                     PLUMB_E_NULL);
    free(from.bytes);
    free(to.bytes);
    free(delta);
    free(out);
    plumb_world_destroy(p.world);
}

// A header with one number changed; the checksum is not reached.
static void foreign(char *header, size_t at, size_t bytes)
{
    for (size_t i = 0; i < bytes / 2; ++i) {
        char swapped = header[at + i];
        header[at + i] = header[at + bytes - 1 - i];
        header[at + bytes - 1 - i] = swapped;
    }
}

static void refusals_say_why(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    image i = save(w);
    REFUSED(E_NULL, "plumb_world_save: buffer is null; it must be given",
            plumb_world_save(w, NULL, 10));
    char text[160];
    snprintf(text, sizeof text,
             "plumb_world_save: size is %zu; it must be at least %zu in this world now", i.size - 1,
             i.size);
    REFUSED(E_RANGE, text, plumb_world_save(w, i.bytes, i.size - 1));
    snprintf(text, sizeof text,
             "plumb_world_save: size is 3; it must be at least %zu in this world now", i.size);
    REFUSED(E_RANGE, text, plumb_world_save(w, i.bytes, 3));
    assert_int_equal(plumb_world_save(w, i.bytes, i.size), PLUMB_OK);
    REFUSED(E_NULL, "plumb_world_restore: buffer is null; it must be given",
            plumb_world_restore(w, NULL, 10));
    REFUSED(E_IMAGE, "plumb_world_restore: buffer is truncated; it must be as it was saved",
            plumb_world_restore(w, i.bytes, i.size - 1));
    i.bytes[i.size - 1] ^= 1;
    REFUSED(E_IMAGE, "plumb_world_restore: buffer is damaged; it must be as it was saved",
            plumb_world_restore(w, i.bytes, i.size));
    i.bytes[i.size - 1] ^= 1;
    i.bytes[8] ^= 1;
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer is of another version of the format; it must be as it was "
            "saved",
            plumb_world_restore(w, i.bytes, i.size));
    i.bytes[8] ^= 1;
    i.bytes[12] ^= 12; // 4 <-> 8
    REFUSED(
        E_IMAGE,
        "plumb_world_restore: buffer is of a world of the other precision; it must be as it was "
        "saved",
        plumb_world_restore(w, i.bytes, i.size));
    i.bytes[12] ^= 12;
    i.bytes[32] ^= 1;
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer was made by a build that stores other columns; it must be "
            "as it was saved",
            plumb_world_restore(w, i.bytes, i.size));
    i.bytes[32] ^= 1;
    i.bytes[0] ^= 1;
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer is no image of a world; it must be as it was saved",
            plumb_world_restore(w, i.bytes, i.size));
    i.bytes[0] ^= 1;
    foreign(i.bytes, 0, 8);
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer was made on a machine of another byte order; it must be "
            "as it was saved",
            plumb_world_restore(w, i.bytes, i.size));
    foreign(i.bytes, 0, 8);
    image frame = save_frame(w, i);
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer is a frame; plumb_world_restore_frame takes it with its "
            "base",
            plumb_world_restore(w, frame.bytes, frame.size));
    size_t bytes;
    REFUSED(E_IMAGE, "plumb_world_save_frame: base is a frame; it must come from plumb_world_save",
            plumb_world_save_frame(w, frame.bytes, frame.size, i.bytes, i.size, &bytes));
    REFUSED(E_NULL, "plumb_world_save_frame: bytes is null; it must be given",
            plumb_world_save_frame(w, i.bytes, i.size, frame.bytes, frame.size, NULL));
    REFUSED(E_NULL, "plumb_world_save_frame: base is null; it must be given",
            plumb_world_save_frame(w, NULL, 0, frame.bytes, frame.size, &bytes));
    REFUSED(E_NULL, "plumb_world_save_frame: buffer is null; it must be given",
            plumb_world_save_frame(w, i.bytes, i.size, NULL, frame.size, &bytes));
    snprintf(text, sizeof text,
             "plumb_world_save_frame: size is %zu; it must be at least %zu in this world now",
             frame.size - 1, frame.size);
    REFUSED(E_RANGE, text,
            plumb_world_save_frame(w, i.bytes, i.size, frame.bytes, frame.size - 1, &bytes));
    assert_int_equal(plumb_world_save_frame(w, i.bytes, i.size, frame.bytes, frame.size, &bytes),
                     PLUMB_OK);
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(1, 1));
    image other = save(w);
    REFUSED(E_IMAGE, "plumb_world_restore_frame: base is not the one that the frame was made with",
            plumb_world_restore_frame(w, other.bytes, other.size, frame.bytes, frame.size));
    REFUSED(E_NULL, "plumb_world_restore_frame: frame is null; it must be given",
            plumb_world_restore_frame(w, i.bytes, i.size, NULL, 0));
    REFUSED(E_NULL, "plumb_world_restore_frame: base is null; it must be given",
            plumb_world_restore_frame(w, NULL, 0, frame.bytes, frame.size));
    plumb_component_create(w, &(plumb_component_desc){ .name = "more", .size = 1 });
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer has other components; register the same ones in the same "
            "order",
            plumb_world_restore(w, i.bytes, i.size));
    assert_int_equal(plumb_world_save(NULL, i.bytes, i.size), PLUMB_E_NULL);
    assert_int_equal(plumb_world_restore(NULL, i.bytes, i.size), PLUMB_E_NULL);
    assert_int_equal(plumb_world_save_frame(NULL, i.bytes, 1, i.bytes, 1, &bytes), PLUMB_E_NULL);
    assert_int_equal(plumb_world_restore_frame(NULL, i.bytes, 1, i.bytes, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_snapshot_read_info(NULL, 0, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_world_snapshot_size(NULL), 0);
    free(i.bytes);
    free(frame.bytes);
    free(other.bytes);
}

typedef struct attempt {
    char *bytes;
    size_t size;
    plumb_result saved, restored;
    char message[128];
} attempt;

static void try_inside(const plumb_system_call *call)
{
    attempt *a = call->context;
    a->saved = plumb_world_save(call->world, a->bytes, a->size);
    strncpy(a->message, plumb_world_error(call->world).message, sizeof a->message - 1);
    a->restored = plumb_world_restore(call->world, a->bytes, a->size);
}

static void a_stepping_world_is_locked(void **state)
{
    fixture *f = *state;
    image i = save(f->world);
    attempt a = { .bytes = i.bytes, .size = i.size };
    plumb_system_create(f->world, &(plumb_system_desc){ .name = "thief",
                                                        .phase = PLUMB_PHASE_END,
                                                        .run = try_inside,
                                                        .context = &a });
    step(f->world, 1);
    assert_int_equal(a.saved, PLUMB_E_LOCKED);
    assert_int_equal(a.restored, PLUMB_E_LOCKED);
    assert_string_equal(a.message, "plumb_world_save: the world is stepping (system 'thief'); "
                                   "call it between steps");
    free(i.bytes);
}

//---- memory --------------------------------------------------------------------------------------

static void rolling_back_allocates_nothing(void **state)
{
    (void)state;
    heap h = HEAP_INIT;
    pile p;
    make_pile(&p, (plumb_world_desc){ .allocator = heap_allocator(&h) }, 10);
    image base = save(p.world), kept[12];
    for (int i = 0; i < 12; ++i) {
        kept[i] = (image){ malloc(2 * base.size), 2 * base.size };
    }
    long warm = 0;
    for (int round = 0; round < 40; ++round) {
        warm = round == 8 ? h.calls : warm;
        for (int i = 0; i < 12; ++i) {
            assert_int_equal(plumb_world_save_frame(p.world, base.bytes, base.size, kept[i].bytes,
                                                    2 * base.size, &kept[i].size),
                             PLUMB_OK);
            step(p.world, 1);
        }
        int to = round % 12;
        assert_int_equal(plumb_world_restore_frame(p.world, base.bytes, base.size, kept[to].bytes,
                                                   kept[to].size),
                         PLUMB_OK);
        step(p.world, 12 - to);
        assert_int_equal(
            plumb_world_restore_frame(p.world, base.bytes, base.size, kept[0].bytes, kept[0].size),
            PLUMB_OK);
    }
    assert_int_equal(h.calls, warm);
    for (int i = 0; i < 12; ++i) {
        free(kept[i].bytes);
    }
    free(base.bytes);
    plumb_world_destroy(p.world);
}

static void out_of_memory_leaves_the_world_as_it_was(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 30);
    image i = save(p.world);
    int refused = 0;
    for (long k = 0;; ++k) {
        heap h = HEAP_INIT;
        plumb_world *w = NULL;
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ .allocator = heap_allocator(&h) }, &w),
                         PLUMB_OK);
        plumb_component_create(w, &(plumb_component_desc){ .name = "tag", .size = 8 });
        plumb_body_create(w, &(plumb_body_desc){ 0 });
        step(w, 2);
        uint64_t hash = plumb_world_hash(w);
        heap_fail(&h, k);
        plumb_result r = plumb_world_restore(w, i.bytes, i.size);
        if (r == PLUMB_E_MEMORY) {
            ++refused;
            assert_true(plumb_world_hash(w) == hash);
            r = plumb_world_restore(w, i.bytes, i.size);
            assert_int_equal(r, PLUMB_OK);
        } else {
            assert_int_equal(r, PLUMB_OK);
        }
        assert_true(plumb_world_hash(w) == plumb_world_hash(p.world));
        bool all = h.refused == 0;
        plumb_world_destroy(w);
        if (all) {
            break;
        }
    }
    assert_in_range(refused, 5, 100);
    free(i.bytes);
    plumb_world_destroy(p.world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(hash_sees_what_decides_motion),
        cmocka_unit_test(hash_does_not_see_what_does_not),
        cmocka_unit_test(components_count_by_their_fields),
        cmocka_unit_test(a_fresh_world_takes_an_image),
        cmocka_unit_test(what_came_after_the_image_is_gone),
        cmocka_unit_test(events_and_contacts_of_the_last_step_are_gone),
        cmocka_unit_test(queries_see_the_restored_world),
        cmocka_unit_test(static_geometry_is_restored),
        cmocka_unit_test(images_of_one_state_are_equal),
        cmocka_unit_test(a_frame_leaves_out_what_the_base_has),
        cmocka_unit_test(a_frame_holds_changed_structure),
        cmocka_unit_test(a_delta_rebuilds_the_image),
        cmocka_unit_test(frames_of_one_base_have_deltas_too),
        cmocka_unit_test(damage_is_refused_whole),
        cmocka_unit_test(damaged_deltas_are_refused),
        API_TEST(refusals_say_why),
        API_TEST(a_stepping_world_is_locked),
        cmocka_unit_test(rolling_back_allocates_nothing),
        cmocka_unit_test(out_of_memory_leaves_the_world_as_it_was),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
