// test_api_snapshot.c - world hash, images, frames, deltas: what they promise.
#include "snapshot_fixture.h"

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
    CHANGES(plumb_component_set(w, f->dynamic.entity, f->health, &(float){ 1 }));
    CHANGES(plumb_component_set(w, f->dynamic.entity, f->health, &(float){ 2 }));
    CHANGES(plumb_entity_create(w));
    CHANGES(plumb_command_destroy(w, f->fixed.entity));
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
    plumb_command_destroy(p.world, p.bodies[7].entity);
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
    assert_string_equal(plumb_component_get(fresh.world, p.bodies[3].entity, p.tag), "1234567");
    assert_null(plumb_component_get(fresh.world, p.bodies[4].entity, p.tag));
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
    plumb_component_set(p.world, late.entity, p.tag, NULL);
    plumb_component_remove(p.world, p.bodies[3].entity, p.tag);
    plumb_body_destroy(p.world, p.bodies[0]);
    plumb_world_set_gravity(p.world, plumb_v2(5, 5));
    plumb_system_enable(p.world, "count", false);
    step(p.world, 20);
    assert_int_equal(plumb_world_restore(p.world, i.bytes, i.size), PLUMB_OK);
    assert_false(plumb_body_valid(p.world, late));
    assert_true(plumb_body_valid(p.world, p.bodies[0]));
    assert_int_equal(plumb_world_column(p.world, p.tag).count, 1);
    assert_non_null(plumb_component_get(p.world, p.bodies[3].entity, p.tag));
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
    assert_near(info.time, 25.0 / 60, ROUNDED(1e-6));
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

// Between any two states of worlds that have nothing in common, too; and a slot that is too small is told how small.
static void a_slot_of_the_bound_takes_every_delta(void **state)
{
    (void)state;
    enum { IMAGES = 7 };
    image images[IMAGES];
    size_t largest = 0;
    for (int i = 0; i < IMAGES; ++i) {
        pile p;
        make_pile(&p,
                  (plumb_world_desc){ .solver = i % 2 == 0 ? PLUMB_SOLVER_SOFT : PLUMB_SOLVER_PGS },
                  3 * i * i);
        for (int k = 0; k < 20 * i; ++k) {
            step(p.world, k);
        }
        for (int k = 0; k < 3 * i; k += 2) { // pairs come and go all over the list
            plumb_body_destroy(p.world, p.bodies[k]);
        }
        images[i] = save(p.world);
        largest = images[i].size > largest ? images[i].size : largest;
        plumb_world_destroy(p.world);
    }
    const size_t slot = plumb_snapshot_delta_bound(largest);
    char *delta = malloc(slot), *rebuilt = malloc(largest);
    for (int i = 0; i < IMAGES * IMAGES; ++i) {
        const image *from = &images[i / IMAGES], *to = &images[i % IMAGES];
        size_t size = 0, wanted = 0, back = 0;
        assert_int_equal(
            plumb_snapshot_delta(from->bytes, from->size, to->bytes, to->size, delta, slot, &size),
            PLUMB_OK);
        assert_true(size <= plumb_snapshot_delta_bound(to->size));
        assert_int_equal(plumb_snapshot_delta(from->bytes, from->size, to->bytes, to->size, delta,
                                              size - 1, &wanted),
                         PLUMB_E_RANGE);
        assert_int_equal(wanted, size);
        assert_int_equal(plumb_snapshot_delta(from->bytes, from->size, to->bytes, to->size, delta,
                                              wanted, &size),
                         PLUMB_OK);
        assert_int_equal(
            plumb_snapshot_apply(from->bytes, from->size, delta, size, rebuilt, largest, &back),
            PLUMB_OK);
        assert_memory_equal(rebuilt, to->bytes, to->size);
    }
    for (int i = 0; i < IMAGES; ++i) {
        free(images[i].bytes);
    }
    free(delta);
    free(rebuilt);
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
        cmocka_unit_test(a_slot_of_the_bound_takes_every_delta),
        cmocka_unit_test(frames_of_one_base_have_deltas_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
