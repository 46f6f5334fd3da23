// test_api_dipole.c - dipoles as a user has them: settings, rows of the step, sleep and what wakes, images, recordings, threads, out
// of memory, bodies that are cut. Motion against closed forms: tests/analytic/test_dipoles.c.
#include "harness/heap.h"
#include "harness/recording.h"
#include "harness/sim.h"
#include "world_fixture.h"

#include <stdlib.h>

#define DT R(1.0 / 60)

static plumb_world *make_world(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

static plumb_body box(plumb_world *w, plumb_real x, plumb_real y, plumb_body_desc desc)
{
    desc.position = (plumb_vec2){ x, y };
    const plumb_body b = plumb_body_create(w, &desc);
    plumb_shape_create(
        w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.25), R(0.1) }, .density = 10 });
    return b;
}

static void pin(plumb_world *w, plumb_body body)
{
    const plumb_joint j = plumb_joint_create(
        w, &(plumb_joint_desc){
               .kind = PLUMB_REVOLUTE, .body_a = body, .anchor = plumb_body_center(w, body) });
    assert_false(plumb_is_null(j));
}

static plumb_law_desc uniform(plumb_real x, plumb_real y)
{
    return (plumb_law_desc){ .hold = PLUMB_LAW_ON_CHARGE, .vector = { x, y } };
}

static plumb_law_desc mutual(plumb_real k)
{
    return (plumb_law_desc){
        .kind = PLUMB_LAW_MUTUAL, .hold = PLUMB_LAW_ON_CHARGE, .strength = k, .softening = R(0.2)
    };
}

static void run(plumb_world *w, int steps)
{
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
}

static int asleep(const plumb_world *w)
{
    return (int)plumb_world_stats(w).asleep_count;
}

//---- calls ---------------------------------------------------------------------------------------

static void properties_are_checked(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const uint64_t before = plumb_world_hash(w);
    plumb_body_desc d;
    assert_int_equal(plumb_body_set_dipole(w, f->dynamic, R(-2)), PLUMB_OK);
    assert_true(plumb_body_dipole(w, f->dynamic) == -2);
    assert_true(plumb_world_hash(w) != before);
    assert_int_equal(plumb_body_set_dipole_angle(w, f->dynamic, 3), PLUMB_OK);
    assert_true(plumb_body_dipole_angle(w, f->dynamic) == 3);
    assert_int_equal(plumb_body_settings(w, f->dynamic, &d), PLUMB_OK);
    assert_true(d.dipole == -2 && d.dipole_angle == 3);
    const plumb_body like = plumb_body_create(w, &d);
    assert_true(plumb_body_dipole(w, like) == -2 && plumb_body_dipole_angle(w, like) == 3);
    assert_int_equal(plumb_body_destroy(w, like), PLUMB_OK);
    REFUSED(E_NOT_FINITE, "plumb_body_set_dipole: dipole is inf; it must be finite",
            plumb_body_set_dipole(w, f->dynamic, R(INFINITY)));
    REFUSED(E_RANGE, "plumb_body_set_dipole: dipole is 2e+09; it must be -1e+09 to 1e+09",
            plumb_body_set_dipole(w, f->dynamic, R(2e9)));
    REFUSED(E_RANGE,
            "plumb_body_set_dipole_angle: dipole_angle is -2e+09; it must be -1e+09 to 1e+09",
            plumb_body_set_dipole_angle(w, f->dynamic, R(-2e9)));
    REFUSED(E_HANDLE, "plumb_body_set_dipole: body is null; it must be a live body",
            plumb_body_set_dipole(w, NO_BODY, 1));
    assert_int_equal(plumb_body_set_dipole_angle(w, f->stale, 1), PLUMB_E_HANDLE);
    assert_true(plumb_body_dipole(w, f->stale) == 0 && plumb_body_dipole_angle(w, f->stale) == 0);
    assert_true(plumb_is_null(plumb_body_create(w, &(plumb_body_desc){ .dipole = R(NAN) })));
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_body_set_dipole_angle(w, f->dynamic, 0), PLUMB_OK);
    assert_int_equal(plumb_body_set_dipole(w, f->dynamic, 0), PLUMB_OK);
}

// Without a law there is nothing to do, nor without a dipole, whatever else has a charge.
static void without_dipoles_there_is_no_pass(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
    const plumb_body b = box(w, 0, 0, (plumb_body_desc){ .charge = 1, .no_sleep = true });
    const plumb_law_desc d = mutual(1);
    const plumb_law law = plumb_law_create(w, &d);
    run(w, 1);
    assert_true(sim_has_pass(w, "law forces") && !sim_has_pass(w, "dipoles"));
    plumb_body_set_dipole(w, b, 1);
    run(w, 1);
    assert_true(sim_has_pass(w, "dipoles"));
    plumb_law_destroy(w, law);
    run(w, 1);
    assert_false(sim_has_pass(w, "dipoles"));
    plumb_world_destroy(w);
}

// A blow apart: parts have their share of the moment, which points where it did.
static void parts_share_it_by_mass(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
    const plumb_body b =
        box(w, 0, 0, (plumb_body_desc){ .dipole = 8, .dipole_angle = 2, .charge = 4 });
    plumb_body part;
    assert_int_equal(plumb_body_cut(w, b, plumb_v2(R(0.125), 0), plumb_v2(0, 1), &part, 1), 1);
    assert_near(plumb_body_dipole(w, part), 2, ROUNDED(1e-5));
    assert_near(plumb_body_dipole(w, b), 6, ROUNDED(1e-5));
    assert_near(plumb_body_dipole_angle(w, part), 2, 0);
    assert_near(plumb_body_dipole_angle(w, b), 2, 0);
    plumb_world_destroy(w);
}

//---- sleep ---------------------------------------------------------------------------------------

// A compass on a pin, and what sets it swinging again.
static void a_compass_sleeps_in_a_steady_field(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
    plumb_law_desc d = uniform(2, 0);
    const plumb_law field = plumb_law_create(w, &d);
    const plumb_body needle =
        box(w, 0, 0, (plumb_body_desc){ .dipole = 1, .angle = 1, .angular_damping = 6 });
    pin(w, needle);
    run(w, 400);
    assert_int_equal(asleep(w), 1);
    assert_near(plumb_body_angle(w, needle), 0, 0.02);
    assert_int_equal(plumb_law_set(w, field, &d), PLUMB_OK); // what it was
    run(w, 1);
    assert_int_equal(asleep(w), 1);
    d.vector = plumb_v2(0, 2);
    plumb_law_set(w, field, &d);
    run(w, 1);
    assert_int_equal(asleep(w), 0);
    run(w, 500);
    assert_int_equal(asleep(w), 1);
    assert_near(plumb_body_angle(w, needle), 1.5707963, 0.02);
    plumb_body_set_dipole_angle(w, needle, 1);
    run(w, 500);
    assert_int_equal(asleep(w), 1);
    assert_near(plumb_body_angle(w, needle), 0.5707963, 0.02);
    plumb_body_set_dipole(w, needle, 1);
    run(w, 1);
    assert_int_equal(asleep(w), 1);
    plumb_world_destroy(w);
}

// Damped so much that it creeps, slow and even, it goes all the way.
static void a_damped_compass_does_not_stop_on_its_way(void **state)
{
    (void)state;
    for (int pinned = 0; pinned < 2; ++pinned) {
        plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
        const plumb_law_desc d = uniform(R(0.1), 0);
        plumb_law_create(w, &d);
        const plumb_body needle = box(w, 0, 0,
                                      (plumb_body_desc){ .dipole = 1,
                                                         .angle = 1,
                                                         .angular_damping = 30,
                                                         .lock_x = true,
                                                         .lock_y = pinned == 0 });
        if (pinned == 1) {
            pin(w, needle);
        }
        for (int i = 0; i < 6000 && asleep(w) == 0; ++i) {
            run(w, 1);
        }
        assert_int_equal(asleep(w), 1);
        assert_near(plumb_body_angle(w, needle), 0, 0.01);
        plumb_world_destroy(w);
    }
}

typedef struct bench {
    plumb_world *w;
    plumb_body magnet, needles[3]; // on the ground, and round it on pins
} bench;

static bench make_bench(plumb_world_desc desc)
{
    bench b = { .w = make_world(desc) };
    const plumb_body ground = plumb_body_create(b.w, &(plumb_body_desc){ 0 });
    plumb_body_set_type(b.w, ground, PLUMB_STATIC);
    plumb_shape_create(b.w, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 9, R(0.5) } });
    b.magnet = box(b.w, 0, R(0.6), (plumb_body_desc){ .dipole = 2 });
    for (int i = 0; i < 3; ++i) {
        b.needles[i] =
            box(b.w, R(i - 1), 2,
                (plumb_body_desc){ .angle = R(0.3), .dipole = R(0.1), .angular_damping = R(1.5) });
        pin(b.w, b.needles[i]);
    }
    const plumb_law_desc d = mutual(1);
    while (plumb_is_null(plumb_law_create(b.w, &d))) {
    }
    return b;
}

static void all_sleep(const bench *b, int count)
{
    for (int i = 0; i < 4000 && asleep(b->w) < count; ++i) {
        run(b->w, 1);
    }
    assert_int_equal(asleep(b->w), count);
}

static plumb_result turn_round(bench *b)
{
    return plumb_body_set_dipole_angle(b->w, b->magnet, R(2.5));
}

static plumb_result move_off(bench *b)
{
    return plumb_body_teleport(b->w, b->magnet, plumb_v2(-3, R(0.6)), 0);
}

static plumb_result weaken(bench *b)
{
    return plumb_body_set_dipole(b->w, b->magnet, 1);
}

static plumb_result take_out(bench *b)
{
    return plumb_body_set_enabled(b->w, b->magnet, false);
}

static plumb_result make_fixed(bench *b)
{
    return plumb_body_set_type(b->w, b->magnet, PLUMB_STATIC);
}

static plumb_result take_away(bench *b)
{
    return plumb_body_destroy(b->w, b->magnet);
}

static plumb_result bring_another(bench *b)
{
    box(b->w, 2, R(0.6), (plumb_body_desc){ .dipole = 2, .dipole_angle = 2 });
    return PLUMB_OK;
}

static plumb_result bring_a_charge(bench *b)
{
    box(b->w, 2, R(0.6), (plumb_body_desc){ .charge = 2 });
    return PLUMB_OK;
}

// Needles that nothing touches turn when the magnet on the ground does, in whatever way; and fall asleep again.
static void what_sleeps_wakes_when_a_magnet_changes(void **state)
{
    (void)state;
    plumb_result (*const changes[])(bench *) = { turn_round,    move_off,      weaken,
                                                 take_out,      make_fixed,    take_away,
                                                 bring_another, bring_a_charge };
    const int sleepers[] = { 4, 4, 4, 3, 3, 3, 5, 5 };
    const bool turns[] = { true, true, false, true, true, true, true, true };
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; ++i) {
        bench b = make_bench((plumb_world_desc){ 0 });
        all_sleep(&b, 4);
        const double before = (double)plumb_body_angle(b.w, b.needles[2]);
        assert_int_equal(changes[i](&b), PLUMB_OK);
        run(b.w, 2);
        for (int k = 0; k < 3; ++k) {
            assert_true(plumb_body_is_awake(b.w, b.needles[k]));
        }
        all_sleep(&b, sleepers[i]);
        const double turned = fabs((double)plumb_body_angle(b.w, b.needles[2]) - before);
        print_message("change %d: the needle turned by %.3f rad\n", (int)i, turned);
        assert_true(!turns[i] || turned > 0.02);
        plumb_world_destroy(b.w);
    }
}

// A magnet that turns too slowly to count as moving is followed all the same.
static void what_creeps_wakes_in_the_end(void **state)
{
    (void)state;
    bench b = make_bench((plumb_world_desc){ 0 });
    all_sleep(&b, 4);
    const double before = (double)plumb_body_angle(b.w, b.needles[1]);
    int woke = 0;
    for (int i = 0; i < 4000; ++i) {
        plumb_body_set_dipole_angle(b.w, b.magnet, R(i * 2e-4));
        run(b.w, 1);
        int count;
        plumb_world_wake_events(b.w, &count);
        woke += count > 0;
    }
    const double turn = (double)plumb_body_angle(b.w, b.needles[1]) - before;
    const double turned = fabs(atan2(sin(turn), cos(turn)));
    print_message("woke %d times, turned by %.3f rad\n", woke, turned);
    assert_in_range(woke, 2, 400); // now and then, not all the time
    assert_true(turned > 0.5);
    plumb_world_destroy(b.w);
}

// Bar magnets on the ground draw one another, hit, come to rest in a chain and sleep; one more that comes near wakes them.
static void magnets_snap_together_and_sleep(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, R(0.5) } });
    plumb_body bars[6];
    for (int i = 0; i < 6; ++i) {
        bars[i] = box(w, R(0.75 * i), R(0.6), (plumb_body_desc){ .dipole = R(0.7) });
    }
    const plumb_law_desc d = mutual(1);
    plumb_law_create(w, &d);
    run(w, 900);
    assert_int_equal(asleep(w), 6);
    for (int i = 0; i < 5; ++i) {
        const plumb_vec2 a = plumb_body_center(w, bars[i]), b = plumb_body_center(w, bars[i + 1]);
        assert_near((double)b.x - (double)a.x, 0.5, 0.01);
    }
    const double end = (double)plumb_body_center(w, bars[5]).x;
    const plumb_body guest = box(w, R(end + 0.75), R(0.6), (plumb_body_desc){ .dipole = R(0.7) });
    run(w, 2);
    assert_int_equal(asleep(w), 0);
    run(w, 900);
    assert_int_equal(asleep(w), 7);
    assert_true((double)plumb_body_center(w, guest).x - (double)plumb_body_center(w, bars[5]).x <
                0.52);
    plumb_world_destroy(w);
}

//---- bits ----------------------------------------------------------------------------------------

// Magnets and charges that fly, meet, and hang; a field, an attractor that one of them carries.
static plumb_world *make_store(plumb_world_desc desc)
{
    plumb_world *w = make_world(desc);
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, R(0.5) } });
    plumb_body last = NO_BODY;
    for (int i = 0; i < 24; ++i) {
        const plumb_body b = box(w, R(0.8 * (i % 6)), R(0.7 + 0.5 * (i / 6)),
                                 (plumb_body_desc){ .angle = R(0.3 * i),
                                                    .dipole = R(i % 3 == 0 ? 0 : 0.3),
                                                    .dipole_angle = R(i),
                                                    .charge = R(i % 4 == 0 ? 0.2 : 0),
                                                    .time_scale = R(i == 5 ? 0.5 : 1) });
        last = b;
    }
    // Alone in a zone, whom no mutual law names.
    for (int i = 0; i < 80; ++i) {
        const plumb_body b = plumb_body_create(
            w,
            &(plumb_body_desc){ .position = { R(-100 - i), 20 }, .dipole = 1, .no_gravity = true });
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                                .radius = R(0.2),
                                                .filter = { .category = 2, .mask = 2 } });
    }
    (void)last;
    return w;
}

static void add_laws(plumb_world *w, plumb_law out[2])
{
    plumb_law_desc d = mutual(1);
    d.categories = 1;
    while (plumb_is_null(out[0] = plumb_law_create(w, &d))) {
    }
    d = uniform(1, 2);
    while (plumb_is_null(out[1] = plumb_law_create(w, &d))) {
    }
}

static void threads_and_widths_change_no_bit(void **state)
{
    (void)state;
    const int widths[] = { 4, 8, 16, 8 }, workers[] = { 1, 1, 1, 3 };
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS };
    for (int k = 0; k < 2; ++k) {
        uint64_t first = 0;
        for (int i = 0; i < 4; ++i) {
            plumb_world *w = make_store((plumb_world_desc){
                .simd_width = widths[i], .workers = workers[i], .solver = solvers[k] });
            plumb_law laws[2];
            add_laws(w, laws);
            run(w, 200);
            first = i == 0 ? plumb_world_hash(w) : first;
            assert_true(plumb_world_hash(w) == first);
            plumb_world_destroy(w);
        }
    }
}

static void images_go_on_with_the_same_bits(void **state)
{
    (void)state;
    plumb_world *w = make_store((plumb_world_desc){ 0 });
    plumb_world *other = make_world((plumb_world_desc){ .workers = 2 });
    plumb_law laws[2];
    add_laws(w, laws);
    size_t size, later_size;
    for (int start = 40; start < 1000; start *= 3) { // in motion, and when some sleep
        run(w, start);
        void *bytes = sim_save(w, &size);
        run(w, 150);
        const uint64_t end = plumb_world_hash(w);
        void *later = sim_save(w, &later_size);
        assert_int_equal(plumb_world_restore(other, bytes, size), PLUMB_OK);
        run(other, 150);
        assert_true(plumb_world_hash(other) == end);
        assert_int_equal(plumb_world_restore_trusted(w, bytes, size), PLUMB_OK); // rollback
        run(w, 150);
        assert_true(plumb_world_hash(w) == end);
        const size_t bound = plumb_snapshot_delta_bound(later_size);
        void *delta = malloc(bound), *again = malloc(later_size);
        size_t used, got;
        assert_int_equal(plumb_snapshot_delta(bytes, size, later, later_size, delta, bound, &used),
                         PLUMB_OK);
        assert_int_equal(plumb_snapshot_apply(bytes, size, delta, used, again, later_size, &got),
                         PLUMB_OK);
        assert_true(got == later_size && memcmp(again, later, got) == 0);
        free(bytes), free(later), free(delta), free(again);
    }
    plumb_world_destroy(w), plumb_world_destroy(other);
}

static void recordings_hold_them(void **state)
{
    (void)state;
    bench b = make_bench((plumb_world_desc){ 0 });
    recording tape = { 0 };
    uint64_t hashes[61];
    assert_int_equal(plumb_recorder_start(
                         b.w, &(plumb_recorder_desc){ .write = to_recording, .context = &tape }),
                     PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        if (i == 10) {
            plumb_body_set_dipole(b.w, b.needles[0], 2);
        } else if (i == 45) {
            plumb_body_set_dipole_angle(b.w, b.needles[1], 1);
        } else if (i == 50) {
            box(b.w, 3, R(0.6), (plumb_body_desc){ .dipole = 1, .dipole_angle = 2 });
        }
        run(b.w, 1);
        hashes[i] = plumb_world_hash(b.w);
    }
    plumb_recorder_stop(b.w);
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, NULL, &replay), PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        assert_int_equal(plumb_replay_step(replay), PLUMB_OK);
        assert_true(plumb_world_hash(plumb_replay_world(replay)) == hashes[i]);
    }
    plumb_replay_close(replay);
    recording_free(&tape);
    plumb_world_destroy(b.w);
}

static int refused_steps; // of all plays

// Every allocation fails once: the step is refused and succeeds when it is tried again, in the same bits.
static uint64_t play(heap *h, long fail_at, long *calls, int *refused)
{
    *h = (heap){ .fail_at = -1 };
    plumb_world *w =
        make_store((plumb_world_desc){ .allocator = heap_allocator(h), .no_sleep = true });
    plumb_law laws[2];
    run(w, 1);
    const long before = h->calls;
    h->fail_at = fail_at < 0 ? -1 : before + fail_at;
    add_laws(w, laws);
    for (int i = 0; i < 20; ++i) {
        plumb_result r;
        while ((r = plumb_world_step(w, DT)) == PLUMB_E_MEMORY) {
            ++refused_steps;
        }
        assert_int_equal(r, PLUMB_OK);
    }
    *calls = h->calls - before;
    *refused = (int)h->refused;
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    assert_int_equal(h->bytes, 0);
    return hash;
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    refused_steps = 0;
    heap_fail_each(play, 6, 400);
    assert_in_range(refused_steps, 4, 400);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(properties_are_checked, set_up, tear_down),
        cmocka_unit_test(without_dipoles_there_is_no_pass),
        cmocka_unit_test(parts_share_it_by_mass),
        cmocka_unit_test(a_compass_sleeps_in_a_steady_field),
        cmocka_unit_test(a_damped_compass_does_not_stop_on_its_way),
        cmocka_unit_test(what_sleeps_wakes_when_a_magnet_changes),
        cmocka_unit_test(what_creeps_wakes_in_the_end),
        cmocka_unit_test(magnets_snap_together_and_sleep),
        cmocka_unit_test(threads_and_widths_change_no_bit),
        cmocka_unit_test(images_go_on_with_the_same_bits),
        cmocka_unit_test(recordings_hold_them),
        cmocka_unit_test(any_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
