// test_idle_calls.c - what a game asks, or sets to what it is already, neither moves nor wakes a body: random heaps amid such calls
// move as they do without them, to the bit.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "harness/pile.h"
#include "harness/trials.h"

enum { STEPS = 150 };

static plumb_shape first_shape(const plumb_world *w, plumb_body b)
{
    plumb_shape shapes[2] = { PLUMB_NULL_INIT };
    plumb_body_shapes(w, b, shapes, 2);
    return shapes[0];
}

// Given at first, so that later it is what it was.
static void give(plumb_world *w, plumb_body b)
{
    assert_int_equal(plumb_body_set_mass(w, b, plumb_body_mass(w, b)), PLUMB_OK);
    assert_int_equal(plumb_body_set_inertia(w, b, plumb_body_inertia(w, b)), PLUMB_OK);
    assert_int_equal(plumb_body_set_local_center(w, b, plumb_body_local_center(w, b)), PLUMB_OK);
    assert_int_equal(plumb_shape_set_density(w, first_shape(w, b), 1), PLUMB_OK);
}

#define IDLE(name, call)                                                                           \
    static plumb_result name(plumb_world *w, plumb_body b)                                         \
    {                                                                                              \
        (void)b;                                                                                   \
        return call;                                                                               \
    }
IDLE(no_time, plumb_world_step(w, 0))
IDLE(velocity, plumb_body_set_velocity(w, b, plumb_body_velocity(w, b)))
IDLE(spin, plumb_body_set_angular_velocity(w, b, plumb_body_angular_velocity(w, b)))
IDLE(position, plumb_body_set_position(w, b, plumb_body_position(w, b)))
IDLE(angle, plumb_body_set_angle(w, b, plumb_body_angle(w, b)))
IDLE(pose, plumb_body_teleport(w, b, plumb_body_position(w, b), plumb_body_angle(w, b)))
IDLE(type, plumb_body_set_type(w, b, PLUMB_DYNAMIC))
IDLE(enabled, plumb_body_set_enabled(w, b, true))
IDLE(mass, plumb_body_set_mass(w, b, plumb_body_mass(w, b)))
IDLE(inertia, plumb_body_set_inertia(w, b, plumb_body_inertia(w, b)))
IDLE(center, plumb_body_set_local_center(w, b, plumb_body_local_center(w, b)))
IDLE(damping, plumb_body_set_damping(w, b, 0, 0))
IDLE(speed_cap, plumb_body_set_speed_cap(w, b, 0, 0))
IDLE(time_scale, plumb_body_set_time_scale(w, b, 1))
IDLE(gravity_scale, plumb_body_set_gravity_scale(w, b, 1))
IDLE(charge, plumb_body_set_charge(w, b, 0))
IDLE(dipole, plumb_body_set_dipole(w, b, 0))
IDLE(locks, plumb_body_set_locks(w, b, (plumb_axis_locks){ .x = false }))
IDLE(rotation, plumb_body_set_fixed_rotation(w, b, false))
IDLE(continuous, plumb_body_set_continuous(w, b, false))
IDLE(no_force, plumb_body_apply_force_center(w, b, sim_vec(0, 0)))
IDLE(no_impulse, plumb_body_apply_impulse_center(w, b, sim_vec(0, 0)))
IDLE(material,
     plumb_shape_set_material(w, first_shape(w, b), plumb_shape_material(w, first_shape(w, b))))
IDLE(density, plumb_shape_set_density(w, first_shape(w, b), 1))
IDLE(filter, plumb_shape_set_filter(w, first_shape(w, b), plumb_shape_filter(w, first_shape(w, b))))
IDLE(no_sensor, plumb_shape_set_sensor(w, first_shape(w, b), false))
IDLE(one_way,
     plumb_shape_set_one_way(w, first_shape(w, b), plumb_shape_one_way(w, first_shape(w, b))))
IDLE(gravity, plumb_world_set_gravity(w, sim_vec(0, -SIM_G)))
IDLE(measured, plumb_world_set_measure(w, true))
IDLE(watched, plumb_world_set_watchdog(w, true))

static plumb_result saved_and_restored(plumb_world *w, plumb_body b)
{
    (void)b;
    const size_t size = plumb_world_snapshot_size(w);
    void *image = malloc(size);
    assert_int_equal(plumb_world_save(w, image, size), PLUMB_OK);
    const plumb_result r = plumb_world_restore(w, image, size);
    free(image);
    return r;
}

static plumb_result asked(plumb_world *w, plumb_body b)
{
    plumb_ray_hit hit;
    plumb_contact contacts[8];
    plumb_world_ray(w, sim_vec(-10, 1), plumb_body_position(w, b), NULL, &hit);
    plumb_world_contacts(w, contacts, 8);
    plumb_world_energy(w);
    return PLUMB_OK;
}

static plumb_result another_comes_and_goes(plumb_world *w, plumb_body b)
{
    (void)b;
    return plumb_body_destroy(w, sim_ball(w, 0, 300, 0.5, sim_material(w, 0.5, 0)));
}

#define ROW(name)                                                                                  \
    {                                                                                              \
#name, name                                                                                \
    }

static const struct {
    const char *name;
    plumb_result (*call)(plumb_world *w, plumb_body b);
} idles[] = {
    ROW(no_time),       ROW(velocity),
    ROW(spin),          ROW(position),
    ROW(angle),         ROW(pose),
    ROW(type),          ROW(enabled),
    ROW(mass),          ROW(inertia),
    ROW(center),        ROW(damping),
    ROW(speed_cap),     ROW(time_scale),
    ROW(gravity_scale), ROW(charge),
    ROW(locks),         ROW(rotation),
    ROW(continuous),    ROW(no_force),
    ROW(no_impulse),    ROW(material),
    ROW(density),       ROW(filter),
    ROW(no_sensor),     ROW(one_way),
    ROW(gravity),       ROW(measured),
    ROW(watched),       ROW(saved_and_restored),
    ROW(asked),         ROW(another_comes_and_goes),
    ROW(dipole),
};

// `which`: -1 for nothing. Every so many steps, but not before the first: a step of no time that finds new bodies lists pairs by boxes
// that no speed has stretched, and how old the list is decides in rare cases what is far apart and bounces (broad/DECISIONS.md).
static pile_poses motion_amid(uint32_t seed, int which, int every)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body bodies[PILE_MOST];
    const int count = pile_make(w, seed, bodies);
    for (int i = 0; i < count; ++i) {
        give(w, bodies[i]);
    }
    for (int step = 0; step < STEPS; ++step) {
        for (int i = 0; which >= 0 && step > 0 && step % every == 0 && i < count; ++i) {
            assert_int_equal(idles[which].call(w, bodies[i]), PLUMB_OK);
        }
        sim_step(w, 1.0 / 60);
    }
    const pile_poses p = pile_poses_of(w, bodies, count);
    plumb_world_destroy(w);
    return p;
}

static void what_is_set_to_what_it_is_changes_nothing(void **state)
{
    (void)state;
    const int kinds = (int)(sizeof idles / sizeof idles[0]);
    const trials t = trials_from(0, 5);
    for (uint32_t n = t.first; n < t.end; ++n) {
        uint32_t random = 977 * n + 13;
        const uint32_t seed = sim_random(&random);
        const pile_poses alone = motion_amid(seed, -1, 1);
        for (int k = 0; k < kinds; ++k) {
            const pile_poses amid = motion_amid(seed, k, n % 2 == 0 ? 1 : 40);
            const int i = pile_first_apart(&alone, &amid);
            if (i >= 0) {
                fail_msg("case %u: %s moved body %d by %g, %g m", (unsigned)n, idles[k].name, i,
                         amid.x[i] - alone.x[i], amid.y[i] - alone.y[i]);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_set_to_what_it_is_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
