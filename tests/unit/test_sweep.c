// test_sweep.c - gaps and first times of moving pieces against brute force: the gap against a search
// over all directions, the time against samples of the gap, ways of bodies against their ends.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "continuous/swept_motion.h"
#include "continuous/target.h"
#include "harness/sim.h"

#define PI SIM_PI

enum { DIRECTIONS = 3600, SAMPLES = 400 };

// A random piece: a point, a line or a polygon, sharp or rounded, about its pivot or away from it.
static pl_swept random_piece(unsigned *seed, double motion, double turns)
{
    pl_swept p = { .count = 1 + (int)sim_uniform(seed, 0, 9) };
    double size = exp(sim_uniform(seed, log(0.05), log(4)));
    double flat = exp(sim_uniform(seed, log(0.02), 0));
    double x = sim_uniform(seed, -1, 1) * size, y = sim_uniform(seed, -1, 1) * size;
    double lean = sim_uniform(seed, -PI, PI), start = sim_uniform(seed, -PI, PI);
    for (int i = 0; i < p.count; ++i) {
        double a = start + 2 * PI * (i + sim_uniform(seed, 0, 0.9)) / p.count;
        double u = size * cos(a), v = size * flat * sin(a);
        p.x[i] = x + cos(lean) * u - sin(lean) * v;
        p.y[i] = y + sin(lean) * u + cos(lean) * v;
    }
    p.radius = sim_uniform(seed, 0, 2) < 1 && p.count > 1 ? 0 : size * sim_uniform(seed, 0, 0.5);
    p.px = sim_uniform(seed, -2, 2);
    p.py = sim_uniform(seed, -2, 2);
    p.dx = sim_uniform(seed, -motion, motion);
    p.dy = sim_uniform(seed, -motion, motion);
    p.angle = sim_uniform(seed, -1, 1) * turns * 2 * PI;
    return p;
}

static void place(const pl_swept *p, double time, double x[16], double y[16])
{
    double c = cos(p->angle * time), s = sin(p->angle * time);
    for (int i = 0; i < p->count; ++i) {
        x[i] = p->px + p->dx * time + c * p->x[i] - s * p->y[i];
        y[i] = p->py + p->dy * time + s * p->x[i] + c * p->y[i];
    }
}

// Signed distance along a direction.
static double gap_along(const pl_swept *a, const pl_swept *b, double time, double nx, double ny)
{
    double ax[16], ay[16], bx[16], by[16], low = INFINITY, high = -INFINITY;
    place(a, time, ax, ay);
    place(b, time, bx, by);
    for (int i = 0; i < a->count; ++i) {
        low = fmin(low, nx * ax[i] + ny * ay[i]);
    }
    for (int i = 0; i < b->count; ++i) {
        high = fmax(high, nx * bx[i] + ny * by[i]);
    }
    return low - high - a->radius - b->radius;
}

// Two convex sets are apart by the largest gap over all directions (and overlap by its negative).
static void the_gap_is_the_largest_of_all_directions(void **state)
{
    (void)state;
    unsigned seed = 5;
    double worst_over = 0;
    int apart = 0;
    for (int i = 0; i < 3000; ++i) {
        pl_swept a = random_piece(&seed, 1, 1), b = random_piece(&seed, 1, 1);
        double time = sim_uniform(&seed, 0, 1);
        pl_gap gap = pl_sweep_gap(&a, &b, time);
        double best = -INFINITY, reach = 0;
        for (int k = 0; k < DIRECTIONS; ++k) {
            double t = 2 * PI * k / DIRECTIONS;
            best = fmax(best, gap_along(&a, &b, time, cos(t), sin(t)));
        }
        for (int k = 0; k < 16; ++k) {
            reach = fmax(reach, k < a.count ? hypot(a.x[k], a.y[k]) : 0);
            reach = fmax(reach, k < b.count ? hypot(b.x[k], b.y[k]) : 0);
        }
        // Where the pieces are, seen from one another, bounds what a direction in between adds.
        double bound = (2 * reach + 12) * PI / DIRECTIONS;
        worst_over = fmax(worst_over, best - gap.distance);
        assert_true(best <= gap.distance + 1e-12);
        assert_true(gap.distance <= best + bound);
        assert_near(hypot(gap.nx, gap.ny), 1, 1e-12);
        // The normal is one along which the gap is what it says.
        assert_near(gap_along(&a, &b, time, gap.nx, gap.ny), gap.distance, 1e-12);
        apart += gap.distance > 0;
    }
    print_message("gaps of 3000 pairs, %d apart: never below brute force by more than %.1g m\n",
                  apart, worst_over);
    assert_true(apart > 500 && apart < 2700);
}

typedef struct motion_case {
    const char *name;
    double motion, turns; // at most [m], [-]
} motion_case;

static void the_first_time_is_never_late(void **state)
{
    (void)state;
    const motion_case cases[] = { { "straight", 10, 0 },
                                  { "slow turns", 5, 0.1 },
                                  { "a turn", 5, 1 },
                                  { "many turns", 3, 8 },
                                  { "whirling", 3, 300 } };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        unsigned seed = 9;
        int hits = 0, searched = 0, given_up = 0;
        double late = 0, early = 0;
        for (int i = 0; i < 4000; ++i) {
            pl_swept a = random_piece(&seed, cases[k].motion, cases[k].turns);
            pl_swept b =
                random_piece(&seed, i % 2 ? 0 : cases[k].motion, i % 2 ? 0 : cases[k].turns);
            double from = i % 3 == 0 ? sim_uniform(&seed, 0, 0.5) : 0;
            double to = i % 5 == 0 ? sim_uniform(&seed, 0.6, 1) : 1;
            double target = sim_uniform(&seed, -0.05, 0.01), tolerance = 1e-4;
            if (!(pl_sweep_gap(&a, &b, from).distance > target + tolerance)) {
                continue;
            }
            ++searched;
            double time = pl_sweep_first(&a, &b, from, to, target, tolerance);
            bool hit = time < to;
            assert_true(hit || time == PL_SWEEP_NEVER);
            for (int n = 0; n <= SAMPLES; ++n) {
                double t = from + (fmin(time, to) - from) * n / SAMPLES;
                double gap = pl_sweep_gap(&a, &b, t).distance;
                late = fmax(late, target - gap);
                assert_true(gap > target - 1e-9);
            }
            if (hit) {
                ++hits;
                double gap = pl_sweep_gap(&a, &b, time).distance;
                given_up += gap > target + tolerance;
                early = fmax(early, fmin(gap - target, tolerance));
            }
        }
        print_message(
            "%-10s: %d of %d hit; at most %.1g m too deep, %.2g m too early; %d given up\n",
            cases[k].name, hits, searched, fmax(late, 0), early, given_up);
        assert_true(hits > searched / 20 && hits < searched);
        // What meets only when two corners come there at once may take many turns to tell.
        assert_true(given_up <= (cases[k].turns > 8 ? searched / 60 : 0));
    }
}

// A rod that turns eight times in a step past a post, or a touch into it.
static void near_misses_are_told_from_hits(void **state)
{
    (void)state;
    pl_swept rod = {
        .count = 4, .x = { -2, 2, 2, -2 }, .y = { -0.01, -0.01, 0.01, 0.01 }, .angle = 50
    };
    double reach = hypot(2, 0.01);
    for (int i = 0; i < 100; ++i) {
        for (int e = 1; e <= 5; ++e) {
            double clear = pow(10, -e), at = 0.1 + 0.06 * i;
            pl_swept post = { .count = 1, .x = { 0 }, .radius = 0.025 };
            post.px = (reach + 0.025 + clear) * cos(at);
            post.py = (reach + 0.025 + clear) * sin(at);
            assert_true(pl_sweep_first(&rod, &post, 0, 1, 0, clear / 4) > 1);
            post.px = (reach + 0.025 - clear) * cos(at);
            post.py = (reach + 0.025 - clear) * sin(at);
            double time = pl_sweep_first(&rod, &post, 0, 1, 0, clear / 4);
            // It arrives when an end has turned to the post, a little before by its size.
            double turned = fmod(at, PI), arrives = time * 50;
            assert_true(arrives < turned && arrives > turned - 0.4);
        }
    }
}

// What the target allows, by depth: always deeper than the beginning, never beyond the middle.
static void targets_leave_room_and_keep_sides(void **state)
{
    (void)state;
    for (double thick = 1e-4; thick < 2; thick *= 1.7) {
        for (double depth = -thick; depth < 0.9 * thick; depth += thick / 37) {
            for (double sunk = 0; sunk < thick; sunk += thick / 5) {
                pl_sweep_target t = pl_target_of(thick, depth, sunk);
                assert_true(t.tolerance > 0);
                assert_true(-depth > t.distance + t.tolerance); // a search can begin
                assert_true(-t.distance < 0.9 * thick);
                assert_true(depth > thick / 2 || -t.distance <= thick / 2 + thick / 8);
                if (depth <= 0 && sunk <= 0) {
                    assert_true(-t.distance <= PL_TARGET_LEAST);
                }
            }
        }
        assert_true(pl_target_is_lost(thick, thick));
    }
    pl_sweep_target lines = pl_target_of(0, -0.1, 0);
    assert_true(lines.distance >= 0 && lines.tolerance > 0);
    assert_true(pl_target_is_lost(0, 0) && !pl_target_is_lost(0, -1e-6));
}

//---- ways of bodies ------------------------------------------------------------------------------

static void a_way_joins_its_ends_within_its_box(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    plumb_body b = sim_body(w, PLUMB_DYNAMIC, 3, 4, 0.7);
    plumb_vec2 corner[3] = { sim_vec(0.2, 0.1), sim_vec(1.5, -0.3), sim_vec(1, 1) };
    plumb_shape_create(w, b,
                       &(plumb_shape_desc){ .kind = PLUMB_POLYGON,
                                            .points = corner,
                                            .count = 3,
                                            .radius = (plumb_real)0.05,
                                            .material = m });
    uint32_t row = pl_body_row(w, b), piece = w->bodies.first_piece[row];
    unsigned seed = 13;
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
        double a0 = sim_uniform(&seed, -PI, PI), angle = sim_uniform(&seed, -1, 1) * (i % 40);
        pl_place from = { sim_uniform(&seed, -9, 9), sim_uniform(&seed, -9, 9), cos(a0), sin(a0) };
        pl_place to = { sim_uniform(&seed, -9, 9), sim_uniform(&seed, -9, 9), cos(a0 + angle),
                        sin(a0 + angle) };
        pl_swept_motion motion = pl_swept_motion_between(w, row, from, to, angle);
        pl_place at = pl_swept_motion_place(w, row, &motion, 0);
        worst = fmax(
            worst, fmax(hypot(at.x - from.x, at.y - from.y), hypot(at.c - from.c, at.s - from.s)));
        at = pl_swept_motion_place(w, row, &motion, 1);
        worst = fmax(worst, fmax(hypot(at.x - to.x, at.y - to.y), hypot(at.c - to.c, at.s - to.s)));
        pl_swept swept = pl_swept_motion_piece(w, piece, &motion);
        pl_box box = pl_swept_motion_box(&motion, &swept);
        for (int n = 0; n <= 50; ++n) {
            double t = n / 50.0, x[16], y[16];
            place(&swept, t, x, y);
            pl_swept_motion stopped = pl_swept_motion_stopped(&motion, t);
            pl_swept still = pl_swept_motion_piece(w, piece, &stopped);
            for (int k = 0; k < swept.count; ++k) {
                double px = x[k] + motion.ox, py = y[k] + motion.oy, r = swept.radius;
                assert_true((double)box.min_x <= px - r && px + r <= (double)box.max_x);
                assert_true((double)box.min_y <= py - r && py + r <= (double)box.max_y);
                worst =
                    fmax(worst, hypot(still.px + still.x[k] - x[k], still.py + still.y[k] - y[k]));
            }
        }
    }
    print_message("ways of a body: off by %.1g m at most\n", worst);
    assert_true(worst < 1e-12);
    plumb_world_destroy(w);
}

// A hinged body turns about its hinge, and whole turns are counted.
static void a_hinged_body_turns_about_its_hinge(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    plumb_body b = sim_crate(w, 2, 0, 2, 0.1, m);
    uint32_t row = pl_body_row(w, b);
    for (int hinged = 0; hinged < 2; ++hinged) {
        if (hinged) {
            plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_a = b });
        }
        for (int turns = -3; turns <= 3; ++turns) {
            double angle = 1 + 2 * PI * turns;
            pl_mover mover = { .row = row,
                               .x = (plumb_real)(2 * cos(1)),
                               .y = (plumb_real)(-2 * sin(1)),
                               .c = (plumb_real)cos(1),
                               .s = (plumb_real)-sin(1),
                               .angle = (plumb_real)(angle * 1.001),
                               .stop = 1 };
            pl_swept_motion motion = pl_swept_motion_of_mover(w, &mover, 0, 0);
            assert_near(motion.angle, angle, SIM_TOLERANCE(1e-6, 1e-14));
            pl_place half = pl_swept_motion_place(w, row, &motion, 0.5);
            double x = hinged ? 2 * cos(angle / 2) : (2 * cos(1) + 2) / 2;
            double y = hinged ? -2 * sin(angle / 2) : -2 * sin(1) / 2;
            assert_true(hypot(half.x - x, half.y - y) < SIM_TOLERANCE(1e-5, 1e-13));
        }
    }
    plumb_world_destroy(w);
}

// A box slides down a face of ten kilometres, in touch to rounding. The direction between the corners that are nearest is off by
// 1e-6 there, and time ran backwards.
static void what_slides_along_a_long_face_goes_on(void **state)
{
    (void)state;
    const pl_swept box = {
        .count = 4,
        .x = { -0.60633905231952667, 0.363803431391716, 0.60633905231952667, -0.363803431391716 },
        .y = { -0.363803431391716, -0.60633905231952667, 0.363803431391716, 0.60633905231952667 },
        .dx = 0.2094268798828125,
        .dy = -0.052355766296386719
    };
    const pl_swept ground = {
        .count = 4,
        .x = { -4850.9549541771412, 4850.4698829352856, 4850.9549541771412, -4850.4698829352856 },
        .y = { 1211.7079621553421, -1213.6482471227646, -1211.7079621553421, 1213.6482471227646 },
        .px = -42.22211554646492,
        .py = 9.0093640089035034
    };
    unsigned seed = 31;
    for (int i = 0; i < 300; ++i) {
        pl_swept other = box;
        const double by = i == 0 ? 0 : pow(10, sim_uniform(&seed, -12, -6));
        other.px = by * 0.2425356, other.py = by * 0.9701425;
        other.angle = i % 2 == 0 ? 0 : pow(10, sim_uniform(&seed, -16, -8));
        assert_true(pl_sweep_first(&other, &ground, 0, 1, -0.005, 0.00125) >= 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_gap_is_the_largest_of_all_directions),
        cmocka_unit_test(the_first_time_is_never_late),
        cmocka_unit_test(what_slides_along_a_long_face_goes_on),
        cmocka_unit_test(near_misses_are_told_from_hits),
        cmocka_unit_test(targets_leave_room_and_keep_sides),
        cmocka_unit_test(a_way_joins_its_ends_within_its_box),
        cmocka_unit_test(a_hinged_body_turns_about_its_hinge),
    };
    return cmocka_run_group_tests_name("sweep", tests, NULL, NULL);
}
