// test_measure_effects.c - each effect's work is in a row of its own: of a body that one alone drives that row is what its energy
// rises by, the others are 0; with a force of the user's beside it, that does F s and the effect the rest. Free and in contact, by all
// solvers. Float, double, far.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define DT (1 / 60.0)

#define R(x) PLUMB_REAL(x)

enum { STEPS = 45 };

// A crate on a floor, or in space, which something drives to greater x.
typedef struct scene {
    plumb_world *world;
    plumb_body crate;
} scene;

static scene make_scene(plumb_solver solver, bool floor, double friction)
{
    scene s = {
        .world = sim_world(&(plumb_world_desc){
            .measure = true, .solver = solver, .zero_gravity = !floor, .no_sleep = true })
    };
    const plumb_material m = sim_material(s.world, friction, 0);
    if (floor) {
        sim_floor(s.world, m);
    }
    s.crate = sim_body(s.world, PLUMB_DYNAMIC, 0, 0.5, 0);
    plumb_shape_create(
        s.world, s.crate,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) }, .density = 100, .material = m });
    sim_run(s.world, floor ? 30 : 1, DT);
    return s;
}

static void add_wind(scene *s)
{
    plumb_world *w = s->world;
    const plumb_material air = plumb_material_create(
        w, &(plumb_material_desc){ .fluid = true, .weightless = true, .density = 50 });
    const plumb_body sky = sim_body(w, PLUMB_KINEMATIC, 0, 0.5, 0);
    plumb_shape_create(
        w, sky,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 50, 50 }, .sensor = true, .material = air });
    plumb_body_set_velocity(w, sky, sim_vec(8, 0));
}

static void add_law(scene *s)
{
    plumb_law_create(s->world, &(plumb_law_desc){ .kind = PLUMB_LAW_UNIFORM, .vector = { 4, 0 } });
}

// A magnet that points the same way draws it along.
static void add_magnet(scene *s)
{
    plumb_law_create(s->world, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR,
                                                  .hold = PLUMB_LAW_ON_CHARGE,
                                                  .falloff = PLUMB_FALLOFF_INVERSE,
                                                  .position = { 4, R(0.5) },
                                                  .strength = 50 });
    plumb_body_set_dipole(s->world, s->crate, 100);
    plumb_body_set_dipole_angle(s->world, s->crate, R(0.2));
}

static void add_thrust(scene *s)
{
    plumb_body_set_thrust(s->world, s->crate, 600);
}

static void add_rope(scene *s)
{
    plumb_rope_create(s->world, &(plumb_rope_desc){ .from = { R(0.5), R(0.5) },
                                                    .to = { 6, R(0.5) },
                                                    .length = 4,
                                                    .nodes = 12,
                                                    .stiffness = 4000,
                                                    .radius = R(0.02),
                                                    .from_body = s->crate,
                                                    .hold_to = true });
}

static void add_liquid(scene *s)
{
    plumb_liquid_create(s->world, &(plumb_liquid_desc){ .spacing = R(0.1) });
    plumb_liquid_add_box(s->world, sim_vec(-2.5, 0.05), sim_vec(-0.7, 0.95),
                         &(plumb_particle){ .velocity = { 6, 0 } });
}

static void add_character(scene *s)
{
    const plumb_body hero = plumb_body_create(
        s->world, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { R(-1.2), R(0.8) } });
    const plumb_vec2 ends[2] = { sim_vec(0, -0.4), sim_vec(0, 0.4) };
    plumb_shape_create(
        s->world, hero,
        &(plumb_shape_desc){ .kind = PLUMB_CAPSULE, .points = ends, .count = 2, .radius = R(0.3) });
    plumb_character_create(s->world, hero, &(plumb_character_desc){ .push_force = 20000 });
    plumb_character_walk(s->world, hero, 2);
}

typedef struct driver {
    const char *name;
    void (*add)(scene *s);
    plumb_work work;
    bool needs_floor;
} driver;

static const driver drivers[] = {
    { "wind", add_wind, PLUMB_WORK_FLUIDS, false },
    { "a law", add_law, PLUMB_WORK_LAWS, false },
    { "a dipole", add_magnet, PLUMB_WORK_LAWS, false },
    { "an engine", add_thrust, PLUMB_WORK_THRUST, false },
    { "a rope", add_rope, PLUMB_WORK_SOFT, false },
    { "liquid", add_liquid, PLUMB_WORK_LIQUID, false },
    { "a character", add_character, PLUMB_WORK_SYSTEMS, true },
};

enum { DRIVERS = sizeof drivers / sizeof drivers[0] };

static const plumb_work driving[] = { PLUMB_WORK_FORCES, PLUMB_WORK_FLUIDS, PLUMB_WORK_LIQUID,
                                      PLUMB_WORK_LAWS,   PLUMB_WORK_THRUST, PLUMB_WORK_SOFT,
                                      PLUMB_WORK_MOTORS, PLUMB_WORK_SYSTEMS };

// [J] that each row did from now on, with a force of the user's.
static void add_up(scene *s, double force, double sum[PLUMB_WORKS])
{
    for (int i = 0; i < STEPS; ++i) {
        if (force != 0) {
            plumb_body_apply_force_center(s->world, s->crate, sim_vec(force, 0));
        }
        sim_step(s->world, DT);
        const plumb_measures *m = plumb_world_measures(s->world);
        for (int k = 0; k < PLUMB_WORKS; ++k) {
            sum[k] += m->work[k].kinetic + m->work[k].potential;
        }
    }
}

static void each_effect_has_its_row(void **state)
{
    (void)state;
    for (int i = 0; i < DRIVERS; ++i) {
        for (int k = 0; k < 6; ++k) {
            const plumb_solver solver = (plumb_solver)(k / 2);
            const bool floor = k % 2 == 1;
            if (drivers[i].needs_floor && !floor) {
                continue;
            }
            scene s = make_scene(solver, floor, 0.2);
            drivers[i].add(&s);
            double sum[PLUMB_WORKS] = { 0 };
            add_up(&s, 0, sum);
            const double done = sum[drivers[i].work];
            if (k == 0 || drivers[i].needs_floor) {
                print_message("%-11s: %.4g J, %.2f m/s\n", drivers[i].name, done,
                              sim_vx(s.world, s.crate));
            }
            assert_true(done > 50);
            for (size_t j = 0; j < sizeof driving / sizeof driving[0]; ++j) {
                if (driving[j] != drivers[i].work) {
                    assert_near(sum[driving[j]] / done, 0, ROUNDED(1e-4));
                }
            }
            assert_near(sum[PLUMB_WORK_REST] / done, 0, ROUNDED(1e-4));
            plumb_world_destroy(s.world);
        }
    }
}

static void a_force_beside_it_does_its_own(void **state)
{
    (void)state;
    for (int i = 0; i < DRIVERS; ++i) {
        for (int k = 0; k < 6; ++k) {
            const bool floor = k % 2 == 1;
            const double force = 700;
            if (drivers[i].needs_floor && !floor) {
                continue;
            }
            scene s = make_scene((plumb_solver)(k / 2), floor, 0.2);
            drivers[i].add(&s);
            double sum[PLUMB_WORKS] = { 0 };
            const double x = sim_x(s.world, s.crate);
            add_up(&s, force, sum);
            const double way = sim_x(s.world, s.crate) - x;
            assert_true(way > 0.2 && fabs(sum[drivers[i].work]) > 20);
            // Along the mean of the velocities before and behind a substep, which is its way to second order.
            assert_near(sum[PLUMB_WORK_FORCES] / (force * way), 1, 0.03);
            plumb_world_destroy(s.world);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_effect_has_its_row),
        cmocka_unit_test(a_force_beside_it_does_its_own),
    };
    return cmocka_run_group_tests_name("measure_effects", tests, NULL, NULL);
}
