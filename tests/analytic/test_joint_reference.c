// test_joint_reference.c - a joint made where its value is not 0: it is that of one whose limits and rest are told from there.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "harness/sim.h"
#include "harness/trials.h"

#define DT (1 / 60.0)

typedef struct machine {
    plumb_world *world;
    plumb_body body[2]; // null: the world
    plumb_joint joint;
} machine;

static plumb_body one_end(plumb_world *w, uint32_t *random)
{
    double r[8];
    for (int i = 0; i < 8; ++i) {
        r[i] = sim_uniform(random, -1, 1);
    }
    return plumb_body_create(w, &(plumb_body_desc){ .position = sim_vec(2 * r[0], 2 * r[1]),
                                                    .angle = (plumb_real)(3 * r[2]),
                                                    .velocity = sim_vec(r[3], r[4]),
                                                    .angular_velocity = (plumb_real)(2 * r[5]),
                                                    .mass = (plumb_real)(2 + r[6]),
                                                    .inertia = (plumb_real)(0.6 + 0.4 * r[7]) });
}

/// The joint of a case between bodies of that case. `counted_from_0`: its reference is taken from it and from all that counts from there.
static machine machine_of(uint32_t seed, bool counted_from_0)
{
    static const plumb_joint_kind kinds[] = { PLUMB_REVOLUTE, PLUMB_PRISMATIC, PLUMB_WHEEL };
    uint32_t random = (seed * 2654435761u) | 1;
    sim_random(&random);
    machine m = { .world = sim_world(
                      &(plumb_world_desc){ .gravity = sim_vec(3, -9), .no_sleep = true }) };
    const uint32_t ends = sim_random(&random) % 3; // 1 and 2: one of them is the world
    for (uint32_t i = 0; i < 2; ++i) {
        const plumb_body body = one_end(m.world, &random);
        if (ends == i + 1) {
            plumb_body_destroy(m.world, body);
        } else {
            m.body[i] = body;
        }
    }
    const bool sprung = sim_random(&random) % 2 == 0;
    plumb_joint_desc d = { .kind = kinds[sim_random(&random) % 3],
                           .body_a = m.body[0],
                           .body_b = m.body[1],
                           .enable_limit = true };
    const double x = sim_uniform(&random, -2, 2), y = sim_uniform(&random, -2, 2),
                 tilt = sim_uniform(&random, -1, 1);
    const double low = sim_uniform(&random, -1, 0.4),
                 reference = sim_uniform(&random, low, low + 0.6);
    const double zero = counted_from_0 ? reference : 0;
    d.anchor = sim_vec(x, y);
    d.axis = d.kind == PLUMB_REVOLUTE ? sim_vec(0, 0) : sim_vec(tilt, 1);
    d.reference = (plumb_real)(reference - zero);
    d.lower = (plumb_real)(low - zero);
    d.upper = (plumb_real)(low + 0.6 - zero);
    if (sprung) {
        d.hertz = 2;
        d.damping = (plumb_real)0.2;
        d.rest = (plumb_real)(low + 0.2 - zero);
    }
    m.joint = sim_joint(m.world, d);
    return m;
}

// In which substep a limit is met may hang on the last digit.
static void limits_and_rest_count_from_it(void **state)
{
    (void)state;
    const trials t = trials_from(1, 150);
    for (uint32_t seed = t.first; seed < t.end; ++seed) {
        machine told = machine_of(seed, false), shifted = machine_of(seed, true);
        plumb_joint_desc d = { .reference = 0 };
        assert_int_equal(plumb_joint_settings(told.world, told.joint, &d), PLUMB_OK);
        assert_near(plumb_joint_value(told.world, told.joint), d.reference, ROUNDED(2e-6));
        assert_near(plumb_joint_value(shifted.world, shifted.joint), 0, ROUNDED(2e-6));
        for (int i = 0; i < 60; ++i) {
            sim_step(told.world, DT);
            sim_step(shifted.world, DT);
        }
        for (int i = 0; i < 2; ++i) {
            if (!plumb_is_null(told.body[i])) {
                const plumb_vec2 at = plumb_body_position(shifted.world, shifted.body[i]);
                assert_vec_near(plumb_body_position(told.world, told.body[i]), at.x, at.y, 2e-3);
            }
        }
        assert_near(plumb_joint_value(told.world, told.joint) - d.reference,
                    plumb_joint_value(shifted.world, shifted.joint), 2e-3);
        assert_true(plumb_joint_value(told.world, told.joint) > d.lower - (plumb_real)0.02);
        assert_true(plumb_joint_value(told.world, told.joint) < d.upper + (plumb_real)0.02);
        plumb_world_destroy(told.world);
        plumb_world_destroy(shifted.world);
    }
}

// A door that stands open by half a radian falls shut, as it hangs from its upper corner, and stays so.
static void an_open_door_falls_shut(void **state)
{
    (void)state;
    const plumb_body none = PLUMB_NULL_INIT;
    for (int world_is_a = 0; world_is_a < 2; ++world_is_a) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
        const plumb_body door =
            plumb_body_create(w, &(plumb_body_desc){ .position = sim_vec(sin(0.5), -cos(0.5)),
                                                     .angle = (plumb_real)0.5,
                                                     .mass = 1,
                                                     .inertia = (plumb_real)0.1 });
        const plumb_joint hinge =
            sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                             .body_a = world_is_a ? none : door,
                                             .body_b = world_is_a ? door : none,
                                             .reference = (plumb_real)(world_is_a ? 0.5 : -0.5),
                                             .enable_limit = true,
                                             .lower = world_is_a ? 0 : -2,
                                             .upper = world_is_a ? 2 : 0 });
        for (int i = 0; i < 120; ++i) {
            sim_step(w, DT);
        }
        assert_near(plumb_body_angle(w, door), 0, ROUNDED(1e-4) + 1e-4);
        assert_near(plumb_joint_value(w, hinge), 0, ROUNDED(1e-4) + 1e-4);
        plumb_world_destroy(w);
    }
}

static void kinds_without_one_refuse_it(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    const plumb_body b = plumb_body_create(
        w, &(plumb_body_desc){ .position = sim_vec(1, 0), .mass = 1, .inertia = 1 });
    for (int kind = 0; kind <= PLUMB_CABLE; ++kind) {
        const bool has = kind == PLUMB_REVOLUTE || kind == PLUMB_PRISMATIC || kind == PLUMB_WHEEL;
        const plumb_joint j = plumb_joint_create(
            w, &(plumb_joint_desc){ .kind = (plumb_joint_kind)kind, .body_b = b, .reference = 1 });
        assert_true(plumb_is_null(j) == !has);
        assert_true(has || plumb_world_error(w).code == PLUMB_E_RANGE);
    }
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(limits_and_rest_count_from_it),
        cmocka_unit_test(an_open_door_falls_shut),
        cmocka_unit_test(kinds_without_one_refuse_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
