// test_api_formula_step.c - what steps make of formulas: the same bits in any block, at any width, with any threads; images,
// recordings, sleep, out of memory.
#include "formula_fixture.h"

#include "harness/heap.h"
#include "harness/recording.h"
#include "harness/sim.h"

#include <stdlib.h>

//---- the step ------------------------------------------------------------------------------------

// Bodies on their own, heaps of them in bowls, a wheel with a field, time, drag.
static plumb_world *make_bowls(plumb_world_desc desc)
{
    plumb_world *w = make_world(desc);
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(
        w, ground,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 40, 1 }, .center = { 0, -8 } });
    for (int i = 0; i < 90; ++i) {
        ball(w, R(i % 18) * R(0.7) - 6, R(i / 18) * R(0.9),
             (plumb_body_desc){ .velocity = { R(i % 5) - 2, 0 },
                                .charge = R(i % 3),
                                .damping = i % 7 == 0 ? R(0.1) : 0 });
    }
    const plumb_body wheel = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC,
                                                                      .position = { 30, 0 },
                                                                      .angular_velocity = 2 });
    (void)wheel;
    ball(w, 31, 0, (plumb_body_desc){ .no_sleep = true });
    return w;
}

enum { LAWS = 5 };

static void add_laws(plumb_world *w, plumb_law out[LAWS])
{
    const plumb_law_desc all[LAWS] = {
        { FORMULA, .potential = "0.2 * (0.1 * x^2 - 1)^2" },
        { FORMULA, .formula_x = "sin(2 * t) - 0.2 * vx * hypot(vx, vy)", .formula_y = "-0.2 * vy" },
        { FORMULA, .potential = "x - exp(-r^2)", .hold = PLUMB_LAW_ON_CHARGE, .radius = 3 },
        { FORMULA, .potential = "30 * x^2 + 8 * y^2", .position = { 30, 0 }, .radius = 5 },
        { FORMULA, .formula_y = "4 * step(sin(t))", .half = { 2, 2 }, .combine = PLUMB_LAW_REPLACE,
          .priority = 1 },
    };
    for (int i = 0; i < LAWS; ++i) {
        while (plumb_is_null(out[i] = plumb_law_create(w, &all[i]))) {
        }
    }
}

static plumb_world *make_full(plumb_world_desc desc)
{
    plumb_law laws[LAWS];
    plumb_world *w = make_bowls(desc);
    add_laws(w, laws);
    return w;
}

static void threads_and_widths_change_no_bit(void **state)
{
    (void)state;
    const int widths[] = { 4, 8, 16, 8, 4 }, workers[] = { 1, 1, 1, 3, 2 };
    for (int mode = 0; mode < 3; ++mode) {
        uint64_t first = 0;
        for (int i = 0; i < 5; ++i) {
            plumb_world *w =
                make_full((plumb_world_desc){ .simd_width = widths[i], .workers = workers[i] });
            plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = mode == 1 ? 4 : 2,
                                                           .tolerance = mode == 2 ? R(1e-6) : 0 });
            run(w, mode == 2 ? 40 : 150);
            first = i == 0 ? plumb_world_hash(w) : first;
            assert_true(plumb_world_hash(w) == first);
            plumb_world_destroy(w);
        }
    }
}

// Bodies that never meet, alone, among many, in another order: each goes its way bit by bit.
static void a_body_has_the_same_bits_in_any_block(void **state)
{
    (void)state;
    enum { MOST = 70 };
    for (int mode = 0; mode < 6; ++mode) {
        static plumb_vec2 place[3][MOST], velocity[3][MOST];
        const int counts[] = { MOST, 3, MOST };
        for (int k = 0; k < 3; ++k) {
            plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
            plumb_world_set_orbits(w,
                                   &(plumb_orbit_desc){ .order = mode % 3 == 1 ? 4 : 2,
                                                        .tolerance = mode % 3 == 2 ? R(1e-7) : 0 });
            add(w, (plumb_law_desc){ .potential = "cos(3 * x) * sin(y + t) + 0.01 * r^2" });
            add(w, (plumb_law_desc){ .formula_x = "-0.1 * vx * abs(vx)", .radius = 6 });
            plumb_body bodies[MOST];
            for (int i = 0; i < counts[k]; ++i) {
                const int n = k == 2 ? counts[k] - 1 - i : i;
                bodies[n] =
                    plumb_body_create(w, &(plumb_body_desc){ .position = { R(n % 10), R(n / 10) },
                                                             .velocity = { R(n % 3), 1 },
                                                             .damping = mode >= 3 ? R(1e-30) : 0,
                                                             .no_sleep = true });
            }
            run(w, 60);
            for (int i = 0; i < counts[k]; ++i) {
                place[k][i] = plumb_body_center(w, bodies[i]);
                velocity[k][i] = plumb_body_velocity(w, bodies[i]);
            }
            plumb_world_destroy(w);
        }
        for (int i = 0; i < MOST; ++i) {
            for (int k = 1; k < 3 && i < counts[k]; ++k) {
                assert_memory_equal(&place[0][i], &place[k][i], sizeof(plumb_vec2));
                assert_memory_equal(&velocity[0][i], &velocity[k][i], sizeof(plumb_vec2));
            }
        }
    }
}

static void images_go_on_with_the_same_bits(void **state)
{
    (void)state;
    plumb_world *w = make_full((plumb_world_desc){ 0 });
    plumb_world *other = make_world((plumb_world_desc){ .workers = 2 }); // a new one
    size_t size, later_size;
    run(w, 40);
    void *bytes = sim_save(w, &size);
    run(w, 80);
    const uint64_t end = plumb_world_hash(w);
    void *later = sim_save(w, &later_size);
    assert_int_equal(plumb_world_restore(other, bytes, size), PLUMB_OK);
    plumb_law laws[LAWS];
    assert_int_equal(plumb_world_laws(other, laws, LAWS), LAWS);
    plumb_law_desc d;
    plumb_law_settings(other, laws[1], &d);
    assert_string_equal(d.formula_y, "-0.2 * vy");
    run(other, 80);
    assert_true(plumb_world_hash(other) == end);
    assert_int_equal(plumb_law_destroy(w, laws[0]), PLUMB_OK);
    assert_int_equal(plumb_world_restore_trusted(w, bytes, size),
                     PLUMB_OK); // rollback, in the midst of it
    run(w, 80);
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
    plumb_world_destroy(w), plumb_world_destroy(other);
}

static void recordings_hold_them(void **state)
{
    (void)state;
    plumb_world *w = make_bowls((plumb_world_desc){ 0 });
    recording tape = { 0 };
    uint64_t hashes[61];
    plumb_law laws[LAWS];
    plumb_law_desc d;
    assert_int_equal(
        plumb_recorder_start(w, &(plumb_recorder_desc){ .write = to_recording, .context = &tape }),
        PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        if (i == 10) {
            add_laws(w, laws);
        } else if (i == 30) {
            plumb_law_settings(w, laws[0], &d);
            d.potential = "0.3 * x^2";
            assert_int_equal(plumb_law_set(w, laws[0], &d), PLUMB_OK);
        } else if (i == 45) {
            assert_int_equal(plumb_law_destroy(w, laws[1]), PLUMB_OK);
        }
        run(w, 1);
        hashes[i] = plumb_world_hash(w);
    }
    plumb_recorder_stop(w);
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, NULL, &replay), PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        assert_int_equal(plumb_replay_step(replay), PLUMB_OK);
        assert_true(plumb_world_hash(plumb_replay_world(replay)) == hashes[i]);
    }
    plumb_law_settings(plumb_replay_world(replay), laws[0], &d);
    assert_string_equal(d.potential, "0.3 * x^2");
    plumb_replay_close(replay);
    recording_free(&tape);
    plumb_world_destroy(w);
}

//---- sleep ---------------------------------------------------------------------------------------

// Twelve boxes on the ground.
static plumb_world *make_row(void)
{
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(
        w, ground,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 40, 1 }, .center = { 0, -1 } });
    for (int i = 0; i < 12; ++i) {
        const plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(2 * i), R(0.5) } });
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
    }
    return w;
}

static int asleep(const plumb_world *w)
{
    return (int)plumb_world_stats(w).asleep_count;
}

static void what_rests_in_a_steady_field_sleeps(void **state)
{
    (void)state;
    plumb_world *w = make_row();
    const plumb_law law = add(w, (plumb_law_desc){ .potential = "0.02 * x^2 + y" });
    run(w, 120);
    assert_int_equal(asleep(w), 12);
    plumb_law_desc d;
    plumb_law_settings(w, law, &d);
    assert_int_equal(plumb_law_set(w, law, &d), PLUMB_OK); // the same
    run(w, 1);
    assert_int_equal(asleep(w), 12);
    d.potential = "0.03 * x^2 + y";
    assert_int_equal(plumb_law_set(w, law, &d), PLUMB_OK);
    run(w, 1);
    assert_int_equal(asleep(w), 0);
    run(w, 120);
    assert_int_equal(asleep(w), 12);
    plumb_law_destroy(w, law);
    run(w, 1);
    assert_int_equal(asleep(w), 0);
    plumb_world_destroy(w);
}

static void what_changes_keeps_awake_and_wakes(void **state)
{
    (void)state;
    plumb_world *w = make_row();
    // For boxes left of 7 m alone: a push from 4 s to 5 s.
    const plumb_law law =
        add(w, (plumb_law_desc){ .formula_x = "2 * step(t - 4) * step(5 - t) * step(7 - x)" });
    run(w, 200);
    assert_int_equal(asleep(w), 12);
    run(w, 42);
    assert_int_equal(asleep(w), 8); // those at 0, 2, 4, 6 m feel it
    run(w, 39);
    assert_int_equal(asleep(w), 12); // it is steady again
    run(w, 21);
    assert_int_equal(asleep(w), 8); // and ends
    run(w, 60);
    assert_int_equal(asleep(w), 12);
    plumb_world_set_time(w, 4.5); // it is set back
    run(w, 1);
    assert_int_equal(asleep(w), 0);
    plumb_law_desc d;
    plumb_law_settings(w, law, &d);
    d.formula_x = "0.3 * cos(0.5 * t)"; // creeps
    plumb_law_set(w, law, &d);
    for (int i = 0; i < 600; ++i) {
        run(w, 1);
        assert_int_equal(asleep(w), 0);
    }
    d.formula_x = "exp(-t)"; // is nothing in the end
    plumb_world_set_time(w, 0);
    plumb_law_set(w, law, &d);
    run(w, 200);
    assert_int_equal(asleep(w), 0);
    run(w, 1200);
    assert_int_equal(asleep(w), 12);
    plumb_world_destroy(w);
}

// Everybody sleeps; a lamp goes by that pulls, a wheel begins to turn.
static void who_comes_by_wakes(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; ++kind) {
        plumb_world *w = make_row();
        const plumb_body lamp = plumb_body_create(
            w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 10, 20 } });
        if (kind == 0) {
            plumb_law_create(
                w, &(plumb_law_desc){
                       .kind = PLUMB_LAW_ATTRACTOR, .body = lamp, .strength = 50, .radius = 4 });
        } else {
            add(w, (plumb_law_desc){ .body = lamp, .formula_x = "3", .radius = 4 });
        }
        run(w, 120);
        assert_int_equal(asleep(w), 12);
        plumb_body_set_velocity(w, lamp, plumb_v2(0, -10));
        run(w, 110);
        assert_true(asleep(w) < 12 && asleep(w) > 0);
        plumb_world_destroy(w);
    }
    plumb_world *w = make_row();
    const plumb_body wheel =
        plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 10, 20 } });
    add(w, (plumb_law_desc){ .body = wheel, .formula_x = "2" });
    run(w, 120);
    assert_int_equal(asleep(w), 12);
    plumb_body_set_angular_velocity(w, wheel, 1);
    run(w, 2);
    assert_int_equal(asleep(w), 0);
    plumb_world_destroy(w);
}

//---- memory --------------------------------------------------------------------------------------

static double sum_of(plumb_world *w)
{
    const plumb_body_span b = plumb_world_bodies(w);
    double sum = 0;
    for (int i = 0; i < b.count; ++i) {
        sum += (i + 1) * ((double)b.center_x[i] + 3 * (double)b.center_y[i]) + (double)b.vx[i] * 5 +
               7 * (double)b.vy[i] + 11 * (double)b.w[i];
    }
    return sum;
}

// Every allocation fails once: the call or the step is refused, changes nothing, and succeeds when it is tried again.
static uint64_t play(heap *h, long fail_at, long *calls, int *refusals)
{
    *h = (heap){ .fail_at = -1 };
    plumb_world *w =
        make_bowls((plumb_world_desc){ .allocator = heap_allocator(h), .no_sleep = true });
    plumb_law laws[LAWS];
    run(w, 1);
    const long before = h->calls;
    h->fail_at = fail_at < 0 ? -1 : before + fail_at;
    const plumb_law plain = plumb_law_create(w, &(plumb_law_desc){ .vector = { 0, 0 } });
    add_laws(w, laws);
    if (!plumb_is_null(plain)) {
        const plumb_law_desc d = { FORMULA, .formula_y = "0 * x" };
        while (plumb_law_set(w, plain, &d) == PLUMB_E_MEMORY) {
            plumb_law_desc is;
            plumb_law_settings(w, plain, &is);
            assert_true(is.kind == PLUMB_LAW_UNIFORM && is.formula_y == NULL);
        }
        plumb_law_destroy(w, plain);
    }
    for (int i = 0; i < 10; ++i) {
        const double before_it = sum_of(w);
        plumb_result r;
        while ((r = plumb_world_step(w, DT)) == PLUMB_E_MEMORY) {
            ++*refusals;
            assert_true(sum_of(w) == before_it);
        }
        assert_int_equal(r, PLUMB_OK);
    }
    *calls = h->calls - before;
    const double end = sum_of(w);
    uint64_t bits;
    memcpy(&bits, &end, sizeof bits);
    plumb_world_destroy(w);
    assert_int_equal(h->bytes, 0);
    return bits;
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    static heap h;
    long calls, unused;
    int refusals = 0;
    const uint64_t hash = play(&h, -1, &calls, &refusals);
    assert_int_equal(refusals, 0);
    assert_in_range(calls, 6, 400);
    for (long k = 0; k < calls; ++k) {
        assert_true(play(&h, k, &unused, &refusals) == hash);
    }
    assert_in_range(refusals, 2, calls);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_and_widths_change_no_bit),
        cmocka_unit_test(a_body_has_the_same_bits_in_any_block),
        cmocka_unit_test(images_go_on_with_the_same_bits),
        cmocka_unit_test(recordings_hold_them),
        cmocka_unit_test(what_rests_in_a_steady_field_sleeps),
        cmocka_unit_test(what_changes_keeps_awake_and_wakes),
        cmocka_unit_test(who_comes_by_wakes),
        cmocka_unit_test(any_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
