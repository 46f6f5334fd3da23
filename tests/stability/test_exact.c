// test_exact.c - the exact solver: what sweeps cannot bear, Coulomb's law on slopes, and what must not differ.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "harness/sim.h"

#define HZ60 (1 / 60.0)

static plumb_world *exact_world(void)
{
    return sim_world(&(plumb_world_desc){ .solver = PLUMB_SOLVER_EXACT, .no_sleep = true });
}

// One light crate under a heavy one: nothing sinks, and the ground bears the sum.
static void light_ones_bear_heavy_ones(void **state)
{
    (void)state;
    for (double ratio = 1; ratio <= 1e6; ratio *= 10) {
        plumb_world *w = exact_world();
        const plumb_material m = sim_material(w, 0.6, 0);
        const plumb_body ground = sim_floor(w, m);
        const plumb_body light = sim_crate(w, 0, 0.5, 0.5, 0.5, m);
        const plumb_body heavy = sim_crate(w, 0, 1.5, 0.5, 0.5, m);
        plumb_body_set_mass(w, heavy, (plumb_real)ratio);
        sim_run(w, 60, HZ60);
        const double low = sim_normal_force(w, ground, light, HZ60) / ((1 + ratio) * SIM_G) - 1;
        const double high = sim_normal_force(w, light, heavy, HZ60) / (ratio * SIM_G) - 1;
        const plumb_stats stats = plumb_world_stats(w);
        print_message(
            "%7.0f : 1: forces off by %.1g, %.1g, sunk %.1g m, left %.1g, %u factors a step\n",
            ratio, low, high, 1.5 - sim_y(w, heavy), stats.exact_residual, stats.exact_factored);
        assert_true(fabs(low) < SIM_TOLERANCE(1e-5, 1e-8));
        assert_true(fabs(high) < SIM_TOLERANCE(1e-5, 1e-8));
        assert_true(fabs(sim_y(w, heavy) - 1.5) < SIM_TOLERANCE(2e-5, 1e-7));
        assert_int_equal(stats.exact_missed, 0);
        plumb_world_destroy(w);
    }
}

// Fifty links of 0.2 m with a ball of so many links' mass at the end, at rest.
static void chains_bear_what_hangs_on_them(void **state)
{
    (void)state;
    for (double ratio = 1; ratio <= 1e5; ratio *= 10) {
        plumb_world *w = exact_world();
        const plumb_material m = sim_material(w, 0.5, 0);
        plumb_body before = { 0 };
        plumb_joint top = { 0 };
        for (int i = 0; i <= 50; ++i) {
            const plumb_body next = i < 50 ? sim_crate(w, 0, -0.2 * i - 0.1, 0.02, 0.1, m)
                                           : sim_ball(w, 0, -10.4, 0.1, m);
            plumb_body_set_mass(w, next, (plumb_real)(i < 50 ? 0.01 : 0.01 * ratio));
            const plumb_joint j =
                plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                           .body_a = before,
                                                           .body_b = next,
                                                           .anchor = sim_vec(0, -0.2 * i) });
            top = i == 0 ? j : top;
            before = next;
        }
        sim_run(w, 120, HZ60);
        const double weight = 0.01 * (50 + ratio) * SIM_G;
        const double longer = -sim_y(w, before) / 10.4 - 1;
        const double force = (double)plumb_joint_force(w, top).y / weight - 1;
        print_message("50 links, %6.0f : 1: longer by %.1g, force off by %.1g\n", ratio, longer,
                      force);
        assert_true(fabs(longer) < SIM_TOLERANCE(2e-5, 1e-7));
        assert_true(fabs(force) < SIM_TOLERANCE(2e-5, 1e-7));
        plumb_world_destroy(w);
    }
}

// A crate on a slope: it stays where friction is more than the slope, else it slides as Coulomb says.
static void slopes_obey_coulomb(void **state)
{
    (void)state;
    uint32_t seed = 3;
    double worst = 0, crept = 0;
    for (int i = 0; i < 60; ++i) {
        const double lean = sim_uniform(&seed, 0.05, 0.6), mu = sim_uniform(&seed, 0, 0.9);
        const double share = mu / tan(lean);
        if (fabs(share - 1) < 1e-3) {
            continue;
        }
        plumb_world *w = exact_world();
        const plumb_material m = sim_material(w, mu, 0);
        const plumb_body ground = sim_body(w, PLUMB_STATIC, 0, 0, -lean);
        sim_add_box(w, ground, 100, 1, m);
        const double x = 1.5 * sin(lean), y = 1.5 * cos(lean);
        const plumb_body crate = sim_body(w, PLUMB_DYNAMIC, x, y, -lean);
        sim_add_box(w, crate, 0.5, 0.5, m);
        sim_run(w, 120, HZ60);
        const double way = hypot(sim_x(w, crate) - x, sim_y(w, crate) - y);
        const double a = SIM_G * (sin(lean) - mu * cos(lean)), t = 120 * HZ60;
        if (share > 1) {
            crept = fmax(crept, way);
        } else {
            worst = fmax(worst, fabs(way / (a * t * t / 2) - 1));
        }
        plumb_world_destroy(w);
    }
    print_message("60 slopes: way off by %.1g, crept %.1g m\n", worst, crept);
    assert_true(worst < SIM_TOLERANCE(2e-4, 1e-6));
    assert_true(crept < SIM_TOLERANCE(2e-5, 1e-9));
}

// Rows of crates, one more in each: still within a second, at a factor a solution.
static void pyramids_are_still(void **state)
{
    (void)state;
    plumb_world *w = exact_world();
    const plumb_material m = sim_material(w, 0.6, 0);
    sim_floor(w, m);
    for (int row = 0; row < 15; ++row) {
        for (int i = 0; i < 15 - row; ++i) {
            sim_crate(w, i - (15 - row) / 2.0, 0.5 + row, 0.5, 0.5, m);
        }
    }
    sim_run(w, 60, HZ60);
    const plumb_stats stats = plumb_world_stats(w);
    print_message("pyramid of 15: %.1g m/s, deepest %.1g m, %u factors a step\n", sim_max_speed(w),
                  (double)stats.max_penetration, stats.exact_factored);
    assert_true(sim_max_speed(w) < SIM_TOLERANCE(1e-4, 1e-9));
    assert_true((double)stats.max_penetration < SIM_TOLERANCE(1e-5, 1e-9));
    assert_int_equal(stats.exact_missed, 0);
    assert_true(stats.exact_factored <= 40);
    plumb_world_destroy(w);
}

// Anything that meets anything, with joints, masses from 1 to 10,000 and friction.
static plumb_world *any_world(uint32_t seed, const plumb_world_desc *like)
{
    plumb_world_desc desc = *like;
    desc.solver = PLUMB_SOLVER_EXACT;
    plumb_world *w = sim_world(&desc);
    const plumb_material m = sim_material(w, sim_uniform(&seed, 0, 1), 0);
    plumb_body before = { 0 };
    for (int i = 0; i < 24; ++i) {
        const double x = 1.3 * (i % 6) - 3.2, y = 0.7 + 1.3 * (i / 6);
        const plumb_body b =
            sim_uniform(&seed, 0, 1) < 0.5
                ? sim_ball(w, x, y, sim_uniform(&seed, 0.2, 0.6), m)
                : sim_crate(w, x, y, sim_uniform(&seed, 0.1, 0.6), sim_uniform(&seed, 0.1, 0.6), m);
        plumb_body_set_mass(w, b, (plumb_real)pow(10, sim_uniform(&seed, 0, 4)));
        sim_launch(w, b, sim_uniform(&seed, -3, 3), sim_uniform(&seed, -3, 3),
                   sim_uniform(&seed, -3, 3));
        if (i % 6 != 0 && sim_uniform(&seed, 0, 1) < 0.3) {
            plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                       .body_a = before,
                                                       .body_b = b,
                                                       .anchor = sim_vec(x - 0.65, y) });
        }
        before = b;
    }
    return w;
}

static void momentum(plumb_world *w, double sum[2])
{
    const plumb_body_span b = plumb_world_bodies(w);
    sum[0] = sum[1] = 0;
    for (int i = 0; i < b.dynamic_count; ++i) {
        const double m = 1 / (double)b.inv_mass[i];
        sum[0] += m * (double)b.vx[i], sum[1] += m * (double)b.vy[i];
    }
}

// In space: momentum stays, energy never grows, and what is left of the law is told and small nearly always.
static void nothing_comes_from_nothing(void **state)
{
    (void)state;
    double lost = 0, gained = 0;
    int solved = 0, missed = 0, wide = 0, wrong = 0;
    for (uint32_t seed = 1; seed <= 30; ++seed) {
        plumb_world *w =
            any_world(seed, &(plumb_world_desc){ .zero_gravity = true, .no_sleep = true });
        double before[2], now_there[2];
        momentum(w, before);
        const double start = sim_energy(w);
        double most = start;
        for (int i = 0; i < 90; ++i) {
            sim_step(w, HZ60);
            const double now = sim_energy(w);
            gained = fmax(gained, (now - most) / start);
            most = now; // a loss is not given back
            const double left = plumb_world_stats(w).exact_residual;
            missed += left > 1e-9, wide += left > 1e-6, wrong += left > 1e-3;
            ++solved;
        }
        momentum(w, now_there);
        lost = fmax(lost, hypot(now_there[0] - before[0], now_there[1] - before[1]) /
                              sqrt(2 * start * 24e4));
        plumb_world_destroy(w);
    }
    print_message(
        "30 worlds: momentum off by %.1g, energy gained %.1g; left more than 1e-9, 1e-6, 1e-3 in "
        "%d, %d, %d of %d steps\n",
        lost, gained, missed, wide, wrong, solved);
    assert_true(lost < SIM_TOLERANCE(1e-6, 1e-10));
    assert_true(gained < SIM_TOLERANCE(1e-3, 1e-3));
    assert_true(wide < solved / 20 && wrong < solved / 100);
}

// Planks in a line between two nails, which nothing can lower: undone to the last digit, their errors would ask for any speed across.
// Discs that roll and crates that fall onto them, up to 300 times as heavy as a plank. The most that a joint came apart, that anything sank into another;
// what energy was gained, of that of the fall.
static void try_bridge(uint32_t seed, double *apart, double *sunk, double *gained)
{
    plumb_world *w = exact_world();
    const int planks = 3 + (int)sim_uniform(&seed, 0, 18);
    const double mass = sim_uniform(&seed, 1, 30);
    const plumb_material m = sim_material(w, sim_uniform(&seed, 0, 1), 0);
    plumb_joint joints[24];
    plumb_body before = { 0 };
    for (int i = 0; i <= planks; ++i) {
        plumb_body plank = { 0 };
        if (i < planks) {
            plank = sim_crate(w, i + 0.5, 0, 0.49, 0.08, m);
            plumb_body_set_mass(w, plank, (plumb_real)mass);
        }
        joints[i] = plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                               .body_a = before,
                                                               .body_b = plank,
                                                               .anchor = sim_vec(i, 0) });
        before = plank;
    }
    for (int i = 0; i < 3; ++i) {
        const double x = planks * (0.2 + 0.3 * i), r = sim_uniform(&seed, 0.2, 0.4);
        const double y = 0.09 + r + sim_uniform(&seed, 0, 1), speed = sim_uniform(&seed, -2, 2);
        const plumb_body load = i % 2 == 0 ? sim_ball(w, x, y, r, m) : sim_crate(w, x, y, r, r, m);
        plumb_body_set_mass(w, load, (plumb_real)(mass * pow(10, sim_uniform(&seed, 0, 2.5))));
        sim_launch(w, load, speed, 0, 0);
    }
    const double start = sim_energy(w);
    for (int i = 0; i < 240; ++i) {
        sim_step(w, HZ60);
        *sunk = fmax(*sunk, (double)plumb_world_stats(w).max_penetration);
        *gained = fmax(*gained, sim_energy(w) / start - 1);
        for (int k = 0; k <= planks; ++k) {
            *apart = fmax(*apart, (double)plumb_joint_error(w, joints[k]));
        }
    }
    plumb_world_destroy(w);
}

// Before the best of the rounds was kept they came apart by up to 6 m. Of 150 bridges four still do, by 2 to 60 cm, as a load
// falls on one that is taut; which ones hangs on the last digits: of seed 10 with velocities 1e-6 m/s off ten of 24.
static void level_bridges_hold(void **state)
{
    (void)state;
    double gained = 0;
    int fail = 0;
    for (uint32_t seed = 1; seed <= 24; ++seed) {
        double apart = 0, sunk = 0;
        try_bridge(seed, &apart, &sunk, &gained);
        fail += apart > 0.01 || sunk > 0.05;
    }
    print_message("24 level bridges: %d apart by 1 cm or sunk by 5, energy gained %.1g\n", fail,
                  gained);
    assert_true(fail <= 1);
    assert_true(gained < 1e-3);
}

// In space, bodies that overlap or links that are torn apart, in a line, a block or anyhow, which begin at rest. The farthest that one goes in a
// step, as a speed; the fastest when it is over; how far the centre of mass has gone; what is left of the errors.
static void undo_errors(uint32_t seed, double *brisk, double *left, double *gone, double *open)
{
    plumb_world *w = sim_world(&(plumb_world_desc){
        .solver = PLUMB_SOLVER_EXACT, .no_sleep = true, .zero_gravity = true });
    const plumb_material m = sim_material(w, sim_uniform(&seed, 0, 1), 0);
    const int count = 2 + (int)sim_uniform(&seed, 0, 24), wide = 1 + (int)sim_uniform(&seed, 0, 6);
    const bool chain = seed % 2 == 0, turned = sim_uniform(&seed, 0, 1) < 0.5;
    const double share = chain ? sim_uniform(&seed, 1.1, 2) : sim_uniform(&seed, 0.5, 0.95);
    plumb_body bodies[32];
    plumb_joint joints[32];
    for (int i = 0; i < count; ++i) {
        const double x = chain ? i : i % wide, y = chain ? 0 : i / wide;
        bodies[i] = sim_crate(w, x, y, 0.5, chain ? 0.1 : 0.5, m);
        if (chain && i > 0) {
            joints[i] = plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                                   .body_a = bodies[i - 1],
                                                                   .body_b = bodies[i],
                                                                   .anchor = sim_vec(x - 0.5, 0) });
        }
    }
    for (int i = 0; i < count; ++i) {
        const double angle = turned ? sim_uniform(&seed, -0.5, 0.5) : 0;
        plumb_body_teleport(w, bodies[i],
                            sim_vec(sim_x(w, bodies[i]) * share, sim_y(w, bodies[i]) * share),
                            (plumb_real)angle);
    }
    double sum[2] = { 0, 0 };
    for (int n = 0; n < 240; ++n) {
        double was[32][2];
        for (int i = 0; i < count; ++i) {
            was[i][0] = sim_x(w, bodies[i]), was[i][1] = sim_y(w, bodies[i]);
        }
        sim_step(w, HZ60);
        for (int i = 0; i < count; ++i) {
            const double dx = sim_x(w, bodies[i]) - was[i][0], dy = sim_y(w, bodies[i]) - was[i][1];
            *brisk = fmax(*brisk, hypot(dx, dy) / HZ60);
            sum[0] += dx, sum[1] += dy;
        }
    }
    *left = fmax(*left, sim_max_speed(w));
    *gone = fmax(*gone, hypot(sum[0], sum[1]) / count);
    for (int i = 1; i < count && chain; ++i) {
        *open = fmax(*open, (double)plumb_joint_error(w, joints[i]));
    }
    *open = fmax(*open, (double)plumb_world_stats(w).max_penetration);
    plumb_world_destroy(w);
}

static void errors_are_undone_gently(void **state)
{
    (void)state;
    double brisk = 0, left = 0, gone = 0, open = 0;
    for (uint32_t seed = 1; seed <= 60; ++seed) {
        undo_errors(seed, &brisk, &left, &gone, &open);
    }
    print_message("60 worlds: errors undone at up to %.3g m/s; then %.1g m/s, %.1g m off, %.1g m "
                  "left\n",
                  brisk, left, gone, open);
    assert_true(brisk < 6.01); // the push speed; where each row had that for itself: 191 m/s
    assert_true(left < 2e-3);
    assert_true(gone < 1e-4);
    assert_true(open < 1e-3);
}

// A beam on parallel bars, turned by a motor: where all of them lie on one line, rows say nothing of how bars turn against
// each other, and all but two bars are redundant. What a substep undoes there is the arcs of the pins alone: an exact solution
// to 1e-9 of the errors of before, which are next to nothing, was missed, and thrown away. The most that a pin opened [m].
static double turn_linkage(uint32_t seed)
{
    const bool falls = seed % 2 == 0;
    plumb_world *w = sim_world(&(plumb_world_desc){
        .solver = PLUMB_SOLVER_EXACT, .no_sleep = true, .zero_gravity = !falls });
    const int bars = 2 + (int)sim_uniform(&seed, 0, 6);
    const double gap = sim_uniform(&seed, 0.3, 2), length = sim_uniform(&seed, 0.5, 2);
    const double start = sim_uniform(&seed, 0, 2 * SIM_PI), rate = sim_uniform(&seed, 1, 4);
    const double line = falls ? 0 : sim_uniform(&seed, 0, 2 * SIM_PI); // that the feet are on
    const double ux = gap * cos(line), uy = gap * sin(line);
    const double lx = length * cos(start), ly = length * sin(start), middle = (bars - 1) / 2.0;
    const plumb_body beam = sim_mass(w, middle * ux + lx, middle * uy + ly, 2, 2);
    plumb_joint pins[16];
    for (int i = 0; i < bars; ++i) {
        const double x = i * ux, y = i * uy;
        const plumb_body bar = sim_mass(w, x + lx / 2, y + ly / 2, 1, length * length / 12);
        pins[2 * i] = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                       .body_b = bar,
                                                       .anchor = sim_vec(x, y),
                                                       .enable_motor = i == 0,
                                                       .motor_speed = i == 0 ? (plumb_real)rate : 0,
                                                       .max_motor = i == 0 ? (plumb_real)1e4 : 0 });
        pins[2 * i + 1] = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                           .body_a = bar,
                                                           .body_b = beam,
                                                           .anchor = sim_vec(x + lx, y + ly) });
    }
    double open = 0;
    for (int n = 0; n < 360; ++n) {
        sim_step(w, HZ60);
        for (int i = 0; i < 2 * bars; ++i) {
            open = fmax(open, (double)plumb_joint_error(w, pins[i]));
        }
    }
    plumb_world_destroy(w);
    return open;
}

static void linkages_pass_where_they_are_singular(void **state)
{
    (void)state;
    double light = 0, loaded = 0;
    for (uint32_t seed = 1; seed <= 40; ++seed) {
        double *open = seed % 2 == 0 ? &loaded : &light;
        *open = fmax(*open, turn_linkage(seed));
    }
    print_message("40 linkages of 2 to 7 bars: pins open by up to %.1g m, under weight %.1g\n",
                  light, loaded);
    assert_true(light < SIM_TOLERANCE(1e-5, 1e-6));
    assert_true(loaded < 1e-5);
}

// Threads and lanes change no bit; nor does going back.
static void the_same_again(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        plumb_world *a = any_world(seed, &(plumb_world_desc){ .workers = 1, .simd_width = 4 });
        plumb_world *b = any_world(seed, &(plumb_world_desc){ .workers = 3, .simd_width = 8 });
        sim_run(a, 40, HZ60);
        sim_run(b, 40, HZ60);
        assert_int_equal(plumb_world_hash(a), plumb_world_hash(b));
        const size_t size = plumb_world_snapshot_size(a);
        void *image = malloc(size);
        assert_int_equal(plumb_world_save(a, image, size), PLUMB_OK);
        sim_run(a, 30, HZ60);
        const uint64_t hash = plumb_world_hash(a);
        assert_int_equal(plumb_world_restore(a, image, size), PLUMB_OK);
        sim_run(a, 30, HZ60);
        assert_int_equal(plumb_world_hash(a), hash);
        free(image);
        plumb_world_destroy(a);
        plumb_world_destroy(b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_ones_bear_heavy_ones),
        cmocka_unit_test(chains_bear_what_hangs_on_them),
        cmocka_unit_test(slopes_obey_coulomb),
        cmocka_unit_test(pyramids_are_still),
        cmocka_unit_test(nothing_comes_from_nothing),
        cmocka_unit_test(level_bridges_hold),
        cmocka_unit_test(errors_are_undone_gently),
        cmocka_unit_test(linkages_pass_where_they_are_singular),
        cmocka_unit_test(the_same_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
