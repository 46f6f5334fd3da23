// test_accuracy.c - worlds with a tolerance: what they choose where, what they tell, what they refuse, and that roll back,
// threads and the way there change nothing of it.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/sim.h"

#define HZ60 (1 / 60.0)

static int warnings;

static void count_warnings(void *context, plumb_log_level level, const char *message)
{
    (void)context;
    warnings += level == PLUMB_LOG_WARN && strstr(message, "tolerance") != NULL;
}

static plumb_world *world_with(double tolerance)
{
    plumb_world *w = NULL;
    warnings = 0;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .tolerance = (plumb_real)tolerance,
                                                             .no_sleep = true,
                                                             .log = count_warnings },
                                        &w),
                     PLUMB_OK);
    return w;
}

// `links` rods of 0.2 m from the origin to the right, and a ball of so many times their mass. Returns the ball.
static plumb_body swing(plumb_world *w, int links, double ratio)
{
    const plumb_material m = sim_material(w, 0.5, 0);
    plumb_body before = { 0 };
    for (int i = 0; i <= links; ++i) {
        const plumb_body next = sim_mass(w, 0.2 * i + 0.1, 0, i < links ? 1 : ratio, 0.01);
        (void)m;
        plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                   .body_a = before,
                                                   .body_b = next,
                                                   .anchor = sim_vec(0.2 * i, 0) });
        before = next;
    }
    return before;
}

static void presets_are_a_table(void **state)
{
    (void)state;
    plumb_world_desc desc = { .iterations = 7 };
    assert_string_equal(plumb_accuracy_name(PLUMB_ACCURACY_ARCADE), "arcade");
    assert_null(plumb_accuracy_name(PLUMB_ACCURACY_PRESETS));
    assert_null(plumb_accuracy_text((plumb_accuracy_preset)-1));
    assert_non_null(plumb_accuracy_text(PLUMB_ACCURACY_REFERENCE));
    assert_int_equal(plumb_accuracy_apply(PLUMB_ACCURACY_PRECISE, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_accuracy_apply(PLUMB_ACCURACY_PRESETS, &desc), PLUMB_E_RANGE);
    assert_int_equal(desc.iterations, 7);
    assert_int_equal(plumb_accuracy_apply(PLUMB_ACCURACY_PRECISE, &desc), PLUMB_OK);
    assert_true(desc.tolerance == (plumb_real)1e-3 && desc.iterations == 0);
    for (int i = 0; i < PLUMB_ACCURACY_PRESETS; ++i) {
        plumb_world *w = NULL;
        plumb_accuracy_apply((plumb_accuracy_preset)i, &desc);
        assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
        sim_step(w, HZ60);
        plumb_world_destroy(w);
    }
}

static void what_is_no_tolerance_is_refused(void **state)
{
    (void)state;
    plumb_world *w = world_with(0);
    const plumb_real wrong[] = { -1, (plumb_real)0.6, (plumb_real)NAN, (plumb_real)INFINITY };
    for (int i = 0; i < 4; ++i) {
        plumb_world *none = NULL;
        assert_int_not_equal(plumb_world_set_tolerance(w, wrong[i]), PLUMB_OK);
        assert_int_not_equal(
            plumb_world_create(&(plumb_world_desc){ .tolerance = wrong[i] }, &none), PLUMB_OK);
    }
    assert_int_equal(plumb_world_set_tolerance(NULL, 0), PLUMB_E_NULL);
    plumb_accuracy a = plumb_world_accuracy(w);
    assert_true(a.tolerance == 0 && a.steps == 0);
    assert_true(plumb_world_accuracy(NULL).tolerance == 0);
    assert_int_equal(plumb_world_set_tolerance(w, (plumb_real)0.01), PLUMB_OK);
    sim_run(w, 3, HZ60);
    assert_int_equal(plumb_world_accuracy(w).steps, 3);
    assert_int_equal(plumb_world_step(w, 0), PLUMB_OK); // nothing moves
    assert_int_equal(plumb_world_accuracy(w).steps, 3);
    plumb_world_destroy(w);
}

// A pendulum of 0.1 m asks for more substeps, in proportion to what the tolerance falls, or by its root where the substep is of
// second order.
static void swings_ask_for_substeps(void **state)
{
    (void)state;
    int before = 0;
    for (double tolerance = 4e-2; tolerance > 1e-4; tolerance /= 4) {
        plumb_world *w = world_with(tolerance);
        swing(w, 0, 1);
        sim_run(w, 300, HZ60);
        const plumb_accuracy a = plumb_world_accuracy(w);
        print_message("tolerance %.2g: %d substeps, error about %.2g, %s\n", a.tolerance,
                      a.substeps, a.error, a.reason);
        assert_true(a.substeps >= before && a.solver == PLUMB_SOLVER_SOFT && !a.direct_joints);
        if (a.substeps < 32 && a.substeps > 4 && before > 4) {
            const double more = (double)a.substeps / before;
            assert_true(more > 1.6 && more < 4.4);
        }
        assert_true(a.met == (a.worst <= a.tolerance));
        before = a.substeps;
        plumb_world_destroy(w);
    }
    assert_true(before > 16);
}

// From the first step on: it is taken anew.
static void heavy_ends_are_solved_directly(void **state)
{
    (void)state;
    plumb_world *w = world_with(1e-3);
    const plumb_body end = swing(w, 20, 2000);
    sim_step(w, HZ60);
    assert_true(plumb_world_accuracy(w).direct_joints);
    sim_run(w, 60, HZ60);
    const double length = hypot(sim_x(w, end), sim_y(w, end));
    print_message("20 links, 2,000 : 1: %.2g m too long\n", length - 4.1);
    assert_true(fabs(length - 4.1) < 4e-3);
    plumb_world_destroy(w);
}

static void heavy_ones_are_borne_exactly(void **state)
{
    (void)state;
    plumb_world *w = world_with(1e-3);
    const plumb_material m = sim_material(w, 0.6, 0);
    sim_floor(w, m);
    sim_crate(w, 0, 0.5, 0.5, 0.5, m);
    const plumb_body heavy = sim_crate(w, 0, 1.5, 0.5, 0.5, m);
    plumb_body_set_mass(w, heavy, 1000000);
    sim_run(w, 60, HZ60);
    const plumb_accuracy a = plumb_world_accuracy(w);
    print_message("1,000 : 1: sunk %.1g m: %s\n", 1.5 - sim_y(w, heavy), a.reason);
    assert_int_equal(a.solver, PLUMB_SOLVER_EXACT);
    assert_true(fabs(1.5 - sim_y(w, heavy)) < 1e-4 && a.met);
    // Taken away, the rest rests on.
    plumb_body_destroy(w, heavy);
    sim_run(w, 60, HZ60);
    assert_true(plumb_world_accuracy(w).met);
    plumb_world_destroy(w);
}

// A crate that slides is swept; when it has come to rest, it is solved exactly.
static void what_slides_is_swept(void **state)
{
    (void)state;
    plumb_world *w = world_with(1e-3);
    const plumb_material m = sim_material(w, 0.5, 0);
    sim_floor(w, m);
    const plumb_body crate = sim_crate(w, 0, 0.5, 0.5, 0.5, m);
    sim_launch(w, crate, 5, 0, 0);
    sim_run(w, 30, HZ60);
    assert_int_equal(plumb_world_accuracy(w).solver, PLUMB_SOLVER_SOFT);
    sim_run(w, 60, HZ60);
    assert_int_equal(plumb_world_accuracy(w).solver, PLUMB_SOLVER_EXACT);
    plumb_world_destroy(w);
}

// So small a tolerance is missed, in float or double: it is told, once.
static void what_is_missed_is_told(void **state)
{
    (void)state;
    plumb_world *w = world_with(1e-6);
    swing(w, 0, 1);
    sim_run(w, 240, HZ60);
    const plumb_accuracy a = plumb_world_accuracy(w);
    assert_true(!a.met && a.worst > 1e-6);
    assert_int_equal(warnings, 1);
    assert_int_equal(plumb_world_set_tolerance(w, (plumb_real)0.4), PLUMB_OK);
    sim_run(w, 240, HZ60);
    assert_true(plumb_world_accuracy(w).met);
    plumb_world_destroy(w);
}

//---- the same again ------------------------------------------------------------------------------

static plumb_world *busy(int threads)
{
    plumb_world *w =
        sim_world(&(plumb_world_desc){ .tolerance = (plumb_real)1e-3, .workers = threads });
    const plumb_material m = sim_material(w, 0.5, 0.3);
    sim_floor(w, m);
    swing(w, 2, 60);
    for (int i = 0; i < 6; ++i) {
        const plumb_body b = sim_crate(w, 3 + 1.1 * i, 0.5 + 0.4 * i, 0.5, 0.5, m);
        sim_launch(w, b, i - 3, 0, 0.3 * i);
        sim_ball(w, 3 + 1.1 * i, 6, 0.3, m);
    }
    return w;
}

static void roll_back_and_threads_choose_the_same(void **state)
{
    (void)state;
    plumb_world *w = busy(1), *other = busy(2);
    uint64_t straight[120];
    int changes = 0, before = 0;
    for (int i = 0; i < 120; ++i) {
        sim_step(w, HZ60);
        sim_step(other, HZ60);
        straight[i] = plumb_world_hash(w);
        assert_true(straight[i] == plumb_world_hash(other));
        const plumb_accuracy a = plumb_world_accuracy(w);
        changes += a.substeps + 100 * (int)a.solver + 1000 * a.direct_joints != before;
        before = a.substeps + 100 * (int)a.solver + 1000 * a.direct_joints;
    }
    print_message("%d changes of mind\n", changes);
    assert_true(changes > 2); // the first is no choice
    plumb_world_destroy(w);
    plumb_world_destroy(other);
    w = busy(1);
    other = busy(1);
    for (int i = 0; i < 120; ++i) {
        sim_step(w, HZ60);
        assert_true(straight[i] == plumb_world_hash(w));
        if (i % 10 == 5) { // the other one goes on from here, whatever it was before
            const size_t size = plumb_world_snapshot_size(w);
            void *image = malloc(size);
            assert_int_equal(plumb_world_save(w, image, size), PLUMB_OK);
            assert_int_equal(plumb_world_restore(other, image, size), PLUMB_OK);
            free(image);
            plumb_world *swap = w;
            w = other, other = swap;
        }
    }
    plumb_world_destroy(w);
    plumb_world_destroy(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(presets_are_a_table),
        cmocka_unit_test(what_is_no_tolerance_is_refused),
        cmocka_unit_test(swings_ask_for_substeps),
        cmocka_unit_test(heavy_ends_are_solved_directly),
        cmocka_unit_test(heavy_ones_are_borne_exactly),
        cmocka_unit_test(what_slides_is_swept),
        cmocka_unit_test(what_is_missed_is_told),
        cmocka_unit_test(roll_back_and_threads_choose_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
