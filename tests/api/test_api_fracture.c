// test_api_fracture.c - bodies that are cut, break, merge and scale as a user has them: refused calls, handles, what parts inherit, systems,
// images and rollback in the middle of breaking, recordings, threads and widths, out of memory.
#include "harness/heap.h"
#include "harness/recording.h"
#include "world_fixture.h"

#include <stdlib.h>

#define DT R(1.0 / 60)

#define AS_RESULT(call) ((call) < 0 ? plumb_world_error(f->world).code : PLUMB_OK)

#define NAN_ ((plumb_real)NAN)
#define DENIED(code, call)                                                                         \
    do {                                                                                           \
        const uint64_t before_ = digest_world(f->world);                                           \
        assert_int_equal((call), PLUMB_##code);                                                    \
        assert_true(digest_world(f->world) == before_);                                            \
    } while (0)

static void bad_calls_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body parts[4];
    const plumb_body gone = { { 1, 77 } };
    const plumb_vec2 at = { 0, 0 }, along = { 0, 1 }, nowhere = { NAN_, 0 };
    assert_int_equal(plumb_body_cut(NULL, f->dynamic, at, along, parts, 4), -1);
    assert_int_equal(plumb_body_shatter(NULL, f->dynamic, NULL, parts, 4), -1);
    assert_int_equal(plumb_body_merge(NULL, f->dynamic, f->dynamic, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_body_scale(NULL, f->dynamic, 2), PLUMB_E_NULL);
    DENIED(E_HANDLE, AS_RESULT(plumb_body_cut(w, gone, at, along, parts, 4)));
    DENIED(E_HANDLE, AS_RESULT(plumb_body_shatter(w, gone, NULL, parts, 4)));
    DENIED(E_HANDLE, plumb_body_merge(w, f->dynamic, gone, NULL));
    REFUSED(E_HANDLE, "plumb_body_merge: other is body; it must be another",
            plumb_body_merge(w, f->dynamic, f->dynamic, NULL));
    DENIED(E_HANDLE, plumb_body_scale(w, gone, 2));
    const plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { 40, 40 } });
    REFUSED(E_STATE, "plumb_body_cut: body has no shape with an area; it must have one",
            AS_RESULT(plumb_body_cut(w, b, at, along, parts, 4)));
    plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 1, 1 } });
    DENIED(E_NOT_FINITE, AS_RESULT(plumb_body_cut(w, b, nowhere, along, parts, 4)));
    DENIED(E_NOT_FINITE, AS_RESULT(plumb_body_cut(w, b, at, nowhere, parts, 4)));
    REFUSED(E_RANGE, "plumb_body_cut: along is (0, 0); it must not be 0",
            AS_RESULT(plumb_body_cut(w, b, at, at, parts, 4)));
    DENIED(E_RANGE, AS_RESULT(plumb_body_cut(w, b, at, along, parts, -1)));
    DENIED(E_NULL, AS_RESULT(plumb_body_cut(w, b, at, along, NULL, 4)));
    plumb_shatter_desc d = { .cells = 1 };
    REFUSED(E_RANGE, "plumb_body_shatter: cells is 1; it must be 0, or 2 to 64",
            AS_RESULT(plumb_body_shatter(w, b, &d, parts, 4)));
    d = (plumb_shatter_desc){ .cells = 65 };
    DENIED(E_RANGE, AS_RESULT(plumb_body_shatter(w, b, &d, parts, 4)));
    d = (plumb_shatter_desc){ .even = R(1.5) };
    DENIED(E_RANGE, AS_RESULT(plumb_body_shatter(w, b, &d, parts, 4)));
    d = (plumb_shatter_desc){ .min_share = R(0.6) };
    DENIED(E_RANGE, AS_RESULT(plumb_body_shatter(w, b, &d, parts, 4)));
    d = (plumb_shatter_desc){ .point = nowhere };
    DENIED(E_NOT_FINITE, AS_RESULT(plumb_body_shatter(w, b, &d, parts, 4)));
    DENIED(E_NOT_FINITE, plumb_body_scale(w, b, NAN_));
    DENIED(E_RANGE, plumb_body_scale(w, b, 0));
    DENIED(E_RANGE, plumb_body_scale(w, b, 2000));
    DENIED(E_RANGE, plumb_body_set_break_force(w, b, -1));
    DENIED(E_NOT_FINITE, plumb_body_set_break_impulse(w, b, NAN_));
    DENIED(E_RANGE, plumb_body_set_break_energy(w, b, -1));
    DENIED(E_RANGE, plumb_body_set_break_cells(w, b, 65));
    // A shape that would be too small.
    const plumb_body small = plumb_body_create(w, &(plumb_body_desc){ .position = { 50, 50 } });
    plumb_shape_create(w, small, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.01) });
    DENIED(E_RANGE, plumb_body_scale(w, small, R(0.001)));
    int count = 7;
    assert_null(plumb_world_body_break_events(NULL, &count));
    assert_int_equal(count, 0);
    assert_null(plumb_world_body_break_parts(w, &count));
}

static void a_part_that_has_no_mass_is_refused(void **state)
{
    fixture *f = *state;
    const plumb_body b = plumb_body_create(f->world, &(plumb_body_desc){ .position = { 40, 40 } });
    const plumb_material light =
        plumb_material_create(f->world, &(plumb_material_desc){ .density = R(1e-30) });
    for (int i = 0; i < 2; ++i) {
        plumb_shape_desc d = { .kind = PLUMB_BOX, .half = { 1, 1 }, .center = { R(2 * i), 0 } };
        if (i == 1) {
            d.material = light;
        }
        plumb_shape_create(f->world, b, &d);
    }
    DENIED(E_RANGE,
           AS_RESULT(plumb_body_cut(f->world, b, plumb_v2(41, 40), plumb_v2(0, 1), NULL, 0)));
}

static void parts_have_what_the_whole_had(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    int mark;
    const plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { 40, 40 },
                                                                  .damping = 2,
                                                                  .charge = 6,
                                                                  .drag = 3,
                                                                  .thrust = 5,
                                                                  .fuel = 1,
                                                                  .break_impulse = 9,
                                                                  .mass = 8,
                                                                  .no_gravity = true,
                                                                  .no_sleep = true,
                                                                  .user_data = &mark });
    const plumb_material m = plumb_material_create(w, &(plumb_material_desc){ .density = 2 });
    const plumb_filter filter = { .category = 4, .mask = 2, .group = -3 };
    const plumb_shape whole = plumb_shape_create(w, b,
                                                 &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                                      .half = { 2, 1 },
                                                                      .material = m,
                                                                      .filter = filter,
                                                                      .user_data = &mark });
    const plumb_shape eye = plumb_shape_create(
        w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 3, .sensor = true });
    plumb_body part;
    assert_int_equal(plumb_body_cut(w, b, plumb_v2(41, 40), plumb_v2(0, 1), &part, 1), 1);
    assert_near(plumb_body_mass(w, b), 6, ROUNDED(1e-5));
    assert_near(plumb_body_mass(w, part), 2, ROUNDED(1e-5));
    assert_true(plumb_shape_valid(w, whole) && plumb_shape_valid(w, eye));
    assert_true(plumb_same(plumb_shape_body(w, whole), b));
    assert_near(plumb_body_damping(w, part), 2, 0);
    assert_near(plumb_body_charge(w, part), 1.5, ROUNDED(1e-6));
    assert_near(plumb_body_charge(w, b), 4.5, ROUNDED(1e-6));
    assert_near(plumb_body_drag(w, part), 0.75, ROUNDED(1e-6));
    assert_near(plumb_body_fuel(w, b), 0.75, ROUNDED(1e-6));
    assert_near(plumb_body_thrust(w, b), 5, 0);
    assert_near(plumb_body_thrust(w, part), 0, 0);
    assert_near(plumb_body_break_impulse(w, b), 9, 0);
    assert_near(plumb_body_break_impulse(w, part), 0, 0);
    assert_near(plumb_body_break_force(w, b), 0, 0);
    assert_near(plumb_body_break_energy(w, b), 0, 0);
    assert_near(plumb_body_break_cells(w, b), 0, 0);
    assert_true(plumb_body_user_data(w, part) == &mark && plumb_body_no_sleep(w, part));
    assert_near(plumb_body_gravity_scale(w, part), 0, 0);
    plumb_shape shape;
    assert_int_equal(plumb_body_shapes(w, part, &shape, 1), 1);
    assert_true(plumb_same(plumb_shape_material(w, shape), m));
    assert_true(plumb_shape_filter(w, shape).category == 4 &&
                plumb_shape_filter(w, shape).mask == 2 && plumb_shape_filter(w, shape).group == -3);
    assert_true(plumb_shape_user_data(w, shape) == &mark);
    // A point of the material keeps its local coordinates.
    assert_vec_near(plumb_body_position(w, part), 40, 40, 0);
    assert_true(plumb_shape_contains(w, shape, plumb_v2(R(41.5), 40)));
    assert_false(plumb_shape_contains(w, whole, plumb_v2(R(41.5), 40)));
}

// Static ground falls apart where it is cut, and what lies on it wakes.
static void what_is_asleep_wakes(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 4, 1 } });
    const plumb_body box = plumb_body_create(w, &(plumb_body_desc){ .position = { 2, R(1.5) } });
    plumb_shape_create(w, box,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
    for (int i = 0; i < 120; ++i) {
        plumb_world_step(w, DT);
    }
    assert_false(plumb_body_is_awake(w, box));
    plumb_body part;
    assert_int_equal(plumb_body_cut(w, ground, plumb_v2(1, 0), plumb_v2(0, 1), &part, 1), 1);
    assert_int_equal(plumb_body_get_type(w, part), PLUMB_STATIC);
    assert_int_equal(plumb_body_set_type(w, part, PLUMB_DYNAMIC), PLUMB_OK);
    for (int i = 0; i < 30; ++i) {
        plumb_world_step(w, DT);
    }
    assert_true(plumb_body_position(w, box).y < R(0.9)); // both fall
    assert_int_equal(plumb_body_scale(w, box, 2), PLUMB_OK);
    assert_int_equal(plumb_body_merge(w, ground, box, NULL), PLUMB_OK);
    assert_int_equal(plumb_body_get_type(w, ground), PLUMB_STATIC);
    plumb_world_destroy(w);
}

static plumb_body_break kept_event;
static int events_seen;

static int answer;

static void cut_within(const plumb_system_call *call)
{
    answer = plumb_body_cut(call->world, *(plumb_body *)call->context, plumb_v2(0, 5),
                            plumb_v2(0, 1), NULL, 0);
}

static void systems_may_not_cut(void **state)
{
    fixture *f = *state;
    plumb_system_desc d = {
        .name = "cutter", .phase = PLUMB_PHASE_BEGIN, .run = cut_within, .context = &f->dynamic
    };
    plumb_system_create(f->world, &d);
    plumb_world_step(f->world, DT);
    assert_int_equal(answer, -1);
    assert_int_equal(plumb_world_error(f->world).code, PLUMB_E_LOCKED);
}

//---- a wall that is shot at ----------------------------------------------------------------------

// Bricks that break, a plank on two hinges, bullets that come one after another.
static plumb_world *make_wall(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    const plumb_body ground =
        plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, -1 } });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 30, 1 } });
    for (int i = 0; i < 8; ++i) {
        const plumb_body brick = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(2 + 3 * (i % 2)), R(0.5 + i / 2) },
                                   .break_impulse = R(0.4),
                                   .break_energy = R(0.5),
                                   .break_cells = R(6 + i) });
        plumb_shape_create(w, brick,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.2), R(0.5) } });
    }
    for (int i = 0; i < 4; ++i) {
        const plumb_body bullet =
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(-2 - 6 * i), R(0.5 + i) },
                                                     .velocity = { 30, 2 },
                                                     .mass = R(0.5),
                                                     .continuous = true });
        plumb_shape_create(w, bullet,
                           &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.1) });
    }
    return w;
}

static int run(plumb_world *w, int steps)
{
    int broken = 0;
    for (int i = 0; i < steps; ++i) {
        int count;
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
        const plumb_body_break *e = plumb_world_body_break_events(w, &count);
        broken += count;
        if (count > 0) {
            kept_event = e[0];
            int parts;
            const plumb_body *all = plumb_world_body_break_parts(w, &parts);
            assert_true(e[count - 1].first_part + e[count - 1].part_count == parts);
            for (int k = 0; k < parts; ++k) {
                assert_true(plumb_body_valid(w, all[k]));
            }
        }
    }
    events_seen += broken;
    return broken;
}

static void blows_are_told_once(void **state)
{
    (void)state;
    plumb_world *w = make_wall((plumb_world_desc){ 0 });
    assert_in_range(run(w, 120), 3, 8);
    assert_true(plumb_body_valid(w, kept_event.body) && kept_event.part_count > 1);
    assert_near(plumb_body_break_impulse(w, kept_event.body), 0, 0);
    plumb_world_destroy(w);
}

static uint64_t hash_of(plumb_world_desc desc)
{
    plumb_world *w = make_wall(desc);
    run(w, 120);
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    return hash;
}

static void threads_and_widths_change_no_bit(void **state)
{
    (void)state;
    const uint64_t hash = hash_of((plumb_world_desc){ 0 });
    const int widths[] = { 4, 8, 16 };
    for (int i = 0; i < 3; ++i) {
        assert_true(hash_of((plumb_world_desc){ .simd_width = widths[i] }) == hash);
        assert_true(hash_of((plumb_world_desc){ .workers = i + 2 }) == hash);
    }
}

// Saved and restored before each of 60 steps, also between the blow and the breaking, elsewhere and in place.
static void images_go_on_with_the_same_bits(void **state)
{
    (void)state;
    plumb_world *w = make_wall((plumb_world_desc){ 0 }),
                *other = make_wall((plumb_world_desc){ 0 });
    for (int i = 0; i < 60; ++i) {
        const size_t size = plumb_world_snapshot_size(w);
        void *bytes = malloc(size);
        assert_int_equal(plumb_world_save(w, bytes, size), PLUMB_OK);
        run(w, 2);
        const uint64_t hash = plumb_world_hash(w);
        assert_int_equal(plumb_world_restore(other, bytes, size), PLUMB_OK);
        run(other, 2);
        assert_true(plumb_world_hash(other) == hash);
        assert_int_equal(plumb_world_restore_trusted(w, bytes, size), PLUMB_OK); // rollback
        run(w, 1);
        free(bytes);
    }
    assert_true(plumb_world_bodies(w).count > 20);
    plumb_world_destroy(w), plumb_world_destroy(other);
}

static void change(plumb_world *w, plumb_body body, int how)
{
    if (how == 0) {
        assert_int_equal(plumb_body_destroy(w, body), PLUMB_OK);
    } else if (how == 1) {
        assert_int_equal(plumb_body_set_break_impulse(w, body, 0), PLUMB_OK);
    } else if (how == 2) {
        assert_int_equal(plumb_body_set_type(w, body, PLUMB_STATIC), PLUMB_OK);
    } else {
        assert_int_equal(plumb_body_set_enabled(w, body, false), PLUMB_OK);
    }
}

// What has been struck may be gone, or break no more, before it breaks: such worlds have images like any.
static void images_hold_what_broke_and_is_gone(void **state)
{
    (void)state;
    for (int how = 0; how < 4; ++how) {
        plumb_world *w = make_wall((plumb_world_desc){ 0 });
        plumb_world *changed = make_wall((plumb_world_desc){ 0 });
        plumb_world *other = make_wall((plumb_world_desc){ 0 });
        for (int i = 0; i < 60; ++i) {
            const size_t before = plumb_world_snapshot_size(w);
            void *bytes = malloc(before);
            assert_int_equal(plumb_world_save(w, bytes, before), PLUMB_OK);
            assert_int_equal(plumb_world_restore(changed, bytes, before), PLUMB_OK);
            free(bytes);
            const plumb_body_span span = plumb_world_bodies(changed);
            plumb_body all[400];
            const int count = (int)span.count < 400 ? (int)span.count : 400;
            memcpy(all, span.body, (size_t)count * sizeof *all);
            for (int k = 0; k < count; ++k) {
                if (plumb_body_break_impulse(changed, all[k]) > 0) {
                    change(changed, all[k], how);
                }
            }
            const size_t size = plumb_world_snapshot_size(changed);
            bytes = malloc(size);
            assert_int_equal(plumb_world_save(changed, bytes, size), PLUMB_OK);
            assert_int_equal(plumb_world_restore(other, bytes, size), PLUMB_OK);
            run(other, 2), run(changed, 2);
            assert_true(plumb_world_hash(other) == plumb_world_hash(changed));
            free(bytes);
            run(w, 1);
        }
        plumb_world_destroy(w), plumb_world_destroy(changed), plumb_world_destroy(other);
    }
}

static void recordings_hold_it(void **state)
{
    (void)state;
    plumb_world *w = make_wall((plumb_world_desc){ 0 });
    recording tape = { 0 };
    uint64_t hashes[91];
    assert_int_equal(
        plumb_recorder_start(w, &(plumb_recorder_desc){ .write = to_recording, .context = &tape }),
        PLUMB_OK);
    for (int i = 1; i <= 90; ++i) {
        const plumb_body_span span = plumb_world_bodies(w);
        const plumb_body first = span.body[0], last = span.body[span.dynamic_count - 1];
        if (i == 30) {
            assert_true(
                plumb_body_cut(w, first, plumb_body_center(w, first), plumb_v2(1, 1), NULL, 0) > 0);
        } else if (i == 40) {
            assert_int_equal(plumb_body_merge(w, first, last, NULL), PLUMB_OK);
        } else if (i == 50) {
            assert_int_equal(plumb_body_scale(w, first, R(1.3)), PLUMB_OK);
        }
        run(w, 1);
        hashes[i] = plumb_world_hash(w);
    }
    plumb_recorder_stop(w);
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, NULL, &replay), PLUMB_OK);
    for (int i = 1; i <= 90; ++i) {
        assert_int_equal(plumb_replay_step(replay), PLUMB_OK);
        assert_true(plumb_world_hash(plumb_replay_world(replay)) == hashes[i]);
    }
    plumb_replay_close(replay);
    recording_free(&tape);
    plumb_world_destroy(w);
}

//---- out of memory -------------------------------------------------------------------------------

// Each allocation fails once: the call changes nothing, and does all of it when it is tried again.
static uint64_t play(heap *h, long fail_at, long *calls, int *refused)
{
    *h = (heap){ .fail_at = -1 };
    plumb_world *w = make_wall((plumb_world_desc){ .allocator = heap_allocator(h) });
    run(w, 1);
    const long before = h->calls;
    h->fail_at = fail_at < 0 ? -1 : before + fail_at;
    for (int i = 0; i < 40; ++i) {
        plumb_result r;
        const plumb_body_span span = plumb_world_bodies(w);
        const plumb_body first = span.body[0], last = span.body[span.dynamic_count - 1];
        const uint64_t hash = plumb_world_hash(w);
        if (i == 3) {
            while (plumb_body_shatter(w, first, NULL, NULL, 0) < 0) {
                ++*refused;
                assert_int_equal(plumb_world_error(w).code, PLUMB_E_MEMORY);
                assert_true(plumb_world_hash(w) == hash);
            }
        } else if (i == 5 || i == 7) {
            while ((r = i == 5 ? plumb_body_merge(w, first, last, NULL)
                               : plumb_body_scale(w, first, R(1.2))) == PLUMB_E_MEMORY) {
                ++*refused;
                assert_true(plumb_world_hash(w) == hash);
            }
            assert_int_equal(r, PLUMB_OK);
        }
        while ((r = plumb_world_step(w, DT)) == PLUMB_E_MEMORY) {
            ++*refused;
        }
        assert_int_equal(r, PLUMB_OK);
    }
    *calls = h->calls - before;
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    assert_int_equal(h->bytes, 0);
    return hash;
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    heap_fail_each(play, 12, 1000);
}

// What a hinge is held at goes along, also where no mass changes: a pendulum on a body that is not dynamic, or has a sensor alone.
static void hinges_go_along_with_what_grows(void **state)
{
    (void)state;
    for (int k = 0; k < 12; ++k) {
        const plumb_body_type type = (plumb_body_type)(k % 3);
        plumb_world *w, *copy;
        assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
        assert_int_equal(plumb_world_create(NULL, &copy), PLUMB_OK);
        plumb_body arm =
            plumb_body_create(w, &(plumb_body_desc){ .type = type, .no_gravity = true });
        plumb_body bob = plumb_body_create(w, &(plumb_body_desc){ .position = { 1, -2 } });
        plumb_shape_create(w, arm,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = { 1, R(0.1) },
                                                .sensor = type == PLUMB_DYNAMIC });
        plumb_shape_create(w, bob, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.3) });
        plumb_joint hinge = plumb_joint_create(
            w, &(plumb_joint_desc){
                   .kind = PLUMB_REVOLUTE, .body_a = arm, .body_b = bob, .anchor = { 1, 0 } });
        for (int i = 0; i < k; ++i) {
            plumb_world_step(w, DT);
        }
        assert_int_equal(plumb_body_scale(w, arm, R(1.5)), PLUMB_OK);
        const plumb_vec2 at = plumb_body_local_point(w, arm, plumb_joint_anchor_a(w, hinge));
        assert_near(at.x, 1.5, 1e-5);
        size_t size = plumb_world_snapshot_size(w);
        void *image = malloc(size);
        assert_int_equal(plumb_world_save(w, image, size), PLUMB_OK);
        assert_int_equal(plumb_world_restore(copy, image, size), PLUMB_OK);
        for (int i = 0; i < 120; ++i) {
            assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
            plumb_world_step(copy, DT);
            assert_true(plumb_world_hash(w) == plumb_world_hash(copy));
        }
        const plumb_vec2 a = plumb_joint_anchor_a(w, hinge), b = plumb_joint_anchor_b(w, hinge);
        assert_near(a.x, b.x, 0.01);
        assert_near(a.y, b.y, 0.01);
        free(image);
        plumb_world_destroy(w);
        plumb_world_destroy(copy);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(bad_calls_are_refused),
        API_TEST(a_part_that_has_no_mass_is_refused),
        API_TEST(parts_have_what_the_whole_had),
        API_TEST(systems_may_not_cut),
        cmocka_unit_test(what_is_asleep_wakes),
        cmocka_unit_test(hinges_go_along_with_what_grows),
        cmocka_unit_test(blows_are_told_once),
        cmocka_unit_test(threads_and_widths_change_no_bit),
        cmocka_unit_test(images_go_on_with_the_same_bits),
        cmocka_unit_test(images_hold_what_broke_and_is_gone),
        cmocka_unit_test(recordings_hold_it),
        cmocka_unit_test(any_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
