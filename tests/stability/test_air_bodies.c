// test_air_bodies.c - air and bodies that fly through it, turn and squeeze it out between walls, without gravity: nothing gives energy, so
// there is never more of it than there was.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/random.h"
#include "harness/sim.h"
#include "harness/trials.h"

#define R(x)  ((plumb_real)(x))
#define SEEDS 40
#define STEPS 120

static double number(uint32_t *seed, double low, double high)
{
    return sim_uniform(seed, low, high);
}

// x before y, whatever the compiler evaluates first.
static plumb_vec2 pair(uint32_t *seed, double x, double y)
{
    const double first = number(seed, -x, x);
    return sim_vec(first, number(seed, -y, y));
}

static plumb_vec2 size(uint32_t *seed, double low, double high)
{
    const double first = number(seed, low, high);
    return sim_vec(first, number(seed, low, high));
}

// A box with walls and open sides.
static void add_air(plumb_world *w, uint32_t *seed)
{
    plumb_air_side side[4];
    for (int i = 0; i < 4; ++i) {
        side[i] = sim_random(seed) % 2 == 0 ? PLUMB_AIR_OPEN : PLUMB_AIR_CLOSED;
    }
    const plumb_air_desc d = { .half = size(seed, 1, 3),
                               .cell = R(number(seed, 0.1, 0.3)),
                               .density = R(number(seed, 0.1, 2)),
                               .left = side[0],
                               .right = side[1],
                               .bottom = side[2],
                               .top = side[3] };
    assert_int_equal(plumb_air_create(w, &d), PLUMB_OK);
}

static void add_walls(plumb_world *w, uint32_t *seed)
{
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    const int count = (int)(sim_random(seed) % 4);
    for (int i = 0; i < count; ++i) {
        plumb_shape_desc d = { .kind = PLUMB_BOX, .half = size(seed, 0.1, 1) };
        d.center = pair(seed, 3, 2);
        assert_true(plumb_shape_valid(w, plumb_shape_create(w, ground, &d)));
    }
}

static void add_shape(plumb_world *w, plumb_body b, uint32_t *seed)
{
    static const plumb_vec2 ell[] = { { 0, 0 },           { R(0.8), 0 },      { R(0.8), R(0.4) },
                                      { R(0.4), R(0.4) }, { R(0.4), R(0.8) }, { 0, R(0.8) } };
    plumb_shape_desc d = { .density = R(number(seed, 0.3, 3)) };
    switch (sim_random(seed) % 3) {
    case 0:
        d.kind = PLUMB_CIRCLE;
        d.radius = R(number(seed, 0.1, 0.5));
        break;
    case 1:
        d.kind = PLUMB_BOX;
        d.half = size(seed, 0.1, 0.5);
        break;
    default:
        d.kind = PLUMB_OUTLINE;
        d.points = ell;
        d.count = 6;
        break;
    }
    assert_true(plumb_shape_valid(w, plumb_shape_create(w, b, &d)));
}

// Where it overlaps nothing.
static void add_body(plumb_world *w, uint32_t *seed)
{
    plumb_body_desc d = { .position = pair(seed, 3, 2), .velocity = pair(seed, 4, 4) };
    d.angle = R(number(seed, -3, 3));
    d.angular_velocity = R(number(seed, -6, 6));
    const plumb_body b = plumb_body_create(w, &d);
    add_shape(w, b, seed);
    plumb_shape met[2];
    for (int tries = 0; plumb_world_overlap_aabb(w, plumb_body_aabb(w, b), NULL, met, 2) > 1;
         ++tries) {
        assert_true(tries < 1000);
        assert_int_equal(plumb_body_teleport(w, b, pair(seed, 4, 3), d.angle), PLUMB_OK);
    }
}

static double energy_of(const plumb_world *w)
{
    plumb_air_sums s;
    assert_int_equal(plumb_air_sum(w, &s), PLUMB_OK);
    return s.energy + plumb_world_energy(w).kinetic;
}

// What air has is summed with the room of cells, so a body's edge that passes faces changes the sum: by a fifth at the worst of 800
// worlds. Once, 12 of them gained up to 14 times what they had, and others a million times.
static void nothing_gains_energy(void **state)
{
    (void)state;
    const trials t = trials_from(0, SEEDS);
    for (uint32_t k = t.first; k < t.end; ++k) {
        uint32_t seed = (k + 1) * 2654435761u;
        plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true });
        add_air(w, &seed);
        add_walls(w, &seed);
        for (int i = 1 + (int)(sim_random(&seed) % 4); i > 0; --i) {
            add_body(w, &seed);
        }
        const double first = energy_of(w);
        for (int i = 0; i < STEPS; ++i) {
            assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
            if (energy_of(w) > 1.3 * first) {
                fail_msg("world %u, step %d: %.3g J, %.3g at first", (unsigned)k, i, energy_of(w),
                         first);
            }
        }
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_gains_energy),
    };
    return cmocka_run_group_tests_name("air_bodies", tests, NULL, NULL);
}
