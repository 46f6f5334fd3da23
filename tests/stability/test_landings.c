// test_landings.c - what falls without restitution lies where it landed: bodies of one box or of several, on one floor or on tiles,
// tilted when they come; none of their ends springs up again.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "harness/sim.h"
#include "harness/trials.h"

enum { CASES = 200 };

typedef struct setting {
    int boxes; // of the body, side by side
    bool tiles;
    int rate; // [1/s]
    plumb_solver solver;
} setting;

static void lay_floor(plumb_world *w, plumb_material m, bool tiles)
{
    if (!tiles) {
        sim_floor(w, m);
        return;
    }
    plumb_body ground = sim_body(w, PLUMB_STATIC, 0, -0.5, 0);
    for (int i = -20; i <= 20; ++i) {
        plumb_shape_create(w, ground,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = sim_vec(0.35, 0.5),
                                                .center = sim_vec(0.7 * i, 0),
                                                .material = m });
    }
}

// [m] by which an end rises after both have been down.
static double rise(uint32_t number, setting s)
{
    uint32_t seed = 7919 * number + 3;
    const double tilt = sim_uniform(&seed, 0.05, 0.9), half = sim_uniform(&seed, 0.5, 1);
    const double high = sim_uniform(&seed, 0.15, 0.5) * half, mu = sim_uniform(&seed, 0.1, 1);
    plumb_world *w = sim_world(&(plumb_world_desc){ .solver = s.solver });
    const plumb_material m = sim_material(w, mu, 0);
    lay_floor(w, m, s.tiles);
    plumb_body b = sim_body(w, PLUMB_DYNAMIC, 0, 2, tilt);
    for (int i = 0; i < s.boxes; ++i) {
        const double each = half / s.boxes;
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = sim_vec(each, high),
                                                .center = sim_vec(-half + each * (2 * i + 1), 0),
                                                .material = m });
    }
    sim_launch(w, b, sim_uniform(&seed, -1, 1), 0, 0);
    bool landed = false;
    double most = 0;
    for (int i = 0; i < 2 * s.rate; ++i) {
        sim_step(w, 1.0 / s.rate);
        const double angle = sim_angle(w, b);
        landed = landed || (angle < 0.01 && sim_y(w, b) < high + 0.02);
        most = landed && fabs(angle) > most ? fabs(angle) : most;
    }
    assert_true(landed);
    plumb_world_destroy(w);
    return 2 * half * most;
}

// Few rise by more than 3 cm, as corners that come within the same millisecond may; `mean` [m].
static void ends_stay_down(setting s, double mean, int few)
{
    const trials t = trials_from(0, CASES);
    double sum = 0, most = 0;
    int high = 0;
    for (uint32_t i = t.first; i < t.end; ++i) {
        const double up = rise(i, s);
        sum += up;
        high += up > 0.03;
        most = up > most ? up : most;
    }
    const double count = t.end - t.first;
    print_message("%d boxes%s, %d Hz: an end rises by %.4f m in the mean, %.3f at most; by more "
                  "than 3 cm %d of %.0f\n",
                  s.boxes, s.tiles ? " on tiles" : "", s.rate, sum / count, most, high, count);
    assert_true(sum < mean * count);
    assert_true(high <= few * count / CASES + 2);
}

static void bodies_of_several_boxes(void **state)
{
    (void)state;
    for (int boxes = 1; boxes <= 5; ++boxes) {
        ends_stay_down((setting){ boxes, false, 60, PLUMB_SOLVER_SOFT }, 0.01, 8);
    }
    ends_stay_down((setting){ 2, false, 240, PLUMB_SOLVER_SOFT }, 0.01, 8);
    ends_stay_down((setting){ 5, false, 240, PLUMB_SOLVER_SOFT }, 0.01, 8);
}

static void on_tiles(void **state)
{
    (void)state;
    ends_stay_down((setting){ 1, true, 60, PLUMB_SOLVER_SOFT }, 0.02, 35);
    ends_stay_down((setting){ 1, true, 240, PLUMB_SOLVER_SOFT }, 0.02, 35);
    ends_stay_down((setting){ 3, true, 60, PLUMB_SOLVER_SOFT }, 0.045, 80);
}

static void with_the_classic_solver(void **state)
{
    (void)state;
    ends_stay_down((setting){ 1, false, 60, PLUMB_SOLVER_PGS }, 0.01, 8);
    ends_stay_down((setting){ 3, false, 60, PLUMB_SOLVER_PGS }, 0.01, 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_of_several_boxes),
        cmocka_unit_test(on_tiles),
        cmocka_unit_test(with_the_classic_solver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
