// test_internal_edges.c - ground made of many pieces is one ground: what slides over it is not disturbed by
// the edges inside, whatever its shape, the kind of ground and the speed. What stands out of the ground:
// test_internal_edges_shapes.c.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "internal_edges_ground.h"

#include "harness/trials.h"

//---- the table -----------------------------------------------------------------------------------

typedef struct disturbance {
    double across, spin, along; // [-] of the speed; spin times 1 m
    bool unsettled;
} disturbance;

static disturbance slide(body_kind body, ground_kind ground, double speed, double restitution,
                         bool body_first, plumb_solver solver)
{
    double tilt = tilt_of(ground);
    double nx = -sin(tilt), ny = cos(tilt);
    plumb_world *w = sim_world(
        &(plumb_world_desc){ .gravity = sim_vec(-SIM_G * nx, -SIM_G * ny), .solver = solver });
    plumb_material m = sim_material(w, 0, restitution);
    plumb_body b = PLUMB_NULL_INIT;
    double x = start_of(ground);
    if (body_first) {
        b = make_body(w, body, x, tilt, m);
    }
    make_ground(w, ground, m);
    if (!body_first) {
        b = make_body(w, body, x, tilt, m);
    }
    sim_run(w, 120, HZ60);
    disturbance d = { .unsettled = fabs(sim_vx(w, b) * nx + sim_vy(w, b) * ny) > 1e-4 };
    sim_launch(w, b, speed * cos(tilt), speed * sin(tilt), 0);
    int steps = (int)fmin(201 * TILE / speed * 60, 6000);
    steps = steps < 9 ? 9 : steps;
    for (int i = 0; i < steps; ++i) {
        sim_step(w, HZ60);
        double vx = sim_vx(w, b), vy = sim_vy(w, b);
        double across = fabs(vx * nx + vy * ny) / speed;
        double along = fabs(vx * ny - vy * nx - speed) / speed;
        d.across = across <= d.across ? d.across : across;
        d.along = along <= d.along ? d.along : along;
        d.spin = fabs(sim_w(w, b)) / speed <= d.spin ? d.spin : fabs(sim_w(w, b)) / speed;
    }
    plumb_world_destroy(w);
    return d;
}

// [-] the promise; in float, the places of rotated tiles 200 m away are rounded to 15 um, over which
// the body is lifted or falls: 2 mm/s whatever its speed. In the far build the rounding of velocities along the
// slope, always the same way, adds up to as much in 100 s.
static double bound_of(ground_kind ground, double speed, plumb_solver solver)
{
    bool in_float = SIM_IS_FLOAT;
    if (ground == ONE_PIECE) {
        return 1; // the control: what the solver does where there are no internal edges
    }
    if (in_float && ground == ROTATED) {
        return fmax(2e-6, 2e-3 / speed);
    }
    return in_float && solver == PLUMB_SOLVER_PGS ? 5e-6
                                                  : 1e-6; // the classic solver creeps by itself
}

// Of tables but the first, each row is that of one precision; TRIALS=3: of all.
static void check_table(uint32_t table, double restitution, bool body_first, plumb_solver solver)
{
    const double speeds[] = { 1, 20, 100, 500, 2000 };
    bool failed = false;
    print_message("%-16s %-9s %9.0f %9.0f %9.0f %9.0f %9.0f m/s\n", "", "", speeds[0], speeds[1],
                  speeds[2], speeds[3], speeds[4]);
    for (int ground = 0; ground < GROUND_KINDS; ++ground) {
        for (int body = 0; body < BODY_KINDS; ++body) {
            if (table > 0 && !trials_takes((uint32_t)(ground + body) + table, 3)) {
                continue;
            }
            char line[200];
            int at =
                snprintf(line, sizeof line, "%-16s %-9s", ground_names[ground], body_names[body]);
            for (size_t k = 0; k < sizeof speeds / sizeof speeds[0]; ++k) {
                disturbance d = slide((body_kind)body, (ground_kind)ground, speeds[k], restitution,
                                      body_first, solver);
                double worst = fmax(d.across, fmax(d.spin, d.along));
                bool bad =
                    !(worst <= bound_of((ground_kind)ground, speeds[k], solver)) || d.unsettled;
                at += snprintf(line + at, sizeof line - (size_t)at, " %8.1e%s", worst,
                               bad ? "!" : " ");
                failed |= bad;
            }
            print_message("%s\n", line);
        }
    }
    assert_false(failed);
}

static void nothing_catches(void **state)
{
    (void)state;
    check_table(0, 0, false, PLUMB_SOLVER_SOFT);
}

static void nothing_catches_whoever_came_first(void **state)
{
    (void)state;
    check_table(1, 0, true, PLUMB_SOLVER_SOFT);
}

static void elastic_bodies_do_not_begin_to_bounce(void **state)
{
    (void)state;
    check_table(2, 0.5, false, PLUMB_SOLVER_SOFT);
}

static void nothing_catches_in_the_classic_solver(void **state)
{
    (void)state;
    check_table(3, 0, false, PLUMB_SOLVER_PGS);
}

//---- other motion ----------------------------------------------------------------------------------

typedef struct flight {
    double x, y, vx, vy, w;
} flight;

static flight run_flight(body_kind body, ground_kind ground, double friction, double restitution,
                         double x, double y, double vx, double vy, double spin, int steps)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material m = sim_material(w, friction, restitution);
    make_ground(w, ground, m);
    plumb_body b = make_body(w, body, x, 0, m);
    plumb_body_teleport(w, b, sim_vec(x, y), 0);
    sim_launch(w, b, vx, vy, spin);
    sim_run(w, steps, HZ60);
    flight f = { sim_x(w, b), sim_y(w, b), sim_vx(w, b), sim_vy(w, b), sim_w(w, b) };
    plumb_world_destroy(w);
    return f;
}

// Rolling, falling, skidding and bouncing end as they do on one floor.
static void motion_is_that_on_one_floor(void **state)
{
    (void)state;
    const struct {
        const char *name;
        body_kind body;
        double friction, restitution, y, vx, vy, spin;
        int steps;
    } cases[] = {
        { "disc rolls 100 m", DISC, 0.5, 0, 0.5, 10, 0, -20, 600 },
        { "disc begins to roll", DISC, 0.3, 0, 0.5, 10, 0, 0, 300 },
        { "box slides to rest", BOX, 0.4, 0, 0.5, 8, 0, 0, 300 },
        { "box falls flat", BOX, 0, 0, 1.5, 3, 0, 0, 120 },
        { "box lands at 100 m/s", BOX, 0, 0, 3, 100, -20, 0, 60 },
        { "disc lands at 100 m/s", DISC, 0, 0, 3, 100, -20, 0, 60 },
        { "disc bounces", DISC, 0, 0.8, 3, 7, 0, 0, 300 },
        { "box bounces", BOX, 0, 0.5, 2, 7, 0, 0, 120 },
        { "capsule lands", CAPSULE, 0, 0, 2, 31, -5, 0, 120 },
    };
    const ground_kind grounds[] = { TILE_ROW, OFFSET, CHAIN, KINEMATIC, OVERLAPPING };
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; ++c) {
        double x = 0.1;
        flight one =
            run_flight(cases[c].body, ONE_PIECE, cases[c].friction, cases[c].restitution, x,
                       cases[c].y, cases[c].vx, cases[c].vy, cases[c].spin, cases[c].steps);
        double worst = 0;
        for (size_t g = 0; g < sizeof grounds / sizeof grounds[0]; ++g) {
            flight many =
                run_flight(cases[c].body, grounds[g], cases[c].friction, cases[c].restitution, x,
                           cases[c].y, cases[c].vx, cases[c].vy, cases[c].spin, cases[c].steps);
            double off = fmax(fabs(many.vx - one.vx), fabs(many.vy - one.vy));
            off = fmax(off, fmax(fabs(many.w - one.w), fabs(many.y - one.y)));
            worst = off <= worst ? worst : off;
            print_message("%-24s %-16s off by %.1e m/s\n", cases[c].name, ground_names[grounds[g]],
                          off);
        }
        assert_true(worst <= SIM_TOLERANCE(2e-4, 1e-6));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_catches),
        cmocka_unit_test(nothing_catches_whoever_came_first),
        cmocka_unit_test(elastic_bodies_do_not_begin_to_bounce),
        cmocka_unit_test(nothing_catches_in_the_classic_solver),
        cmocka_unit_test(motion_is_that_on_one_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
