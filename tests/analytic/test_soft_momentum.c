// test_soft_momentum.c - soft bodies and rigid ones in space: whatever they do to one another, momentum stays to rounding, angular
// momentum within what a substep leaves out. Worlds are drawn by a seed: friction, masses of 1 to 1,000, spins, what is tied.
#include "harness/sim.h"
#include "harness/trials.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define R(x) ((plumb_real)(x))

typedef enum kind { TIED, THREAD, CLOTH, JELLY, SKIN, KINDS } kind;

static double among(uint32_t *seed, double low, double high)
{
    return low + (high - low) * (double)(sim_random(seed) % 10001) / 10000;
}

static double decades(uint32_t *seed, double low, double high)
{
    return pow(10, among(seed, low, high));
}

static plumb_body thrown(plumb_world *w, uint32_t *seed, double x, double y, double speed)
{
    const plumb_body b = plumb_body_create(
        w, &(plumb_body_desc){ .position = { R(x), R(y) }, .angle = R(among(seed, -3, 3)) });
    const double r = among(seed, 0.15, 0.4), way = sqrt(x * x + y * y);
    plumb_shape_desc of = { .kind = PLUMB_CIRCLE, .radius = R(r) };
    if (sim_random(seed) % 2 != 0) {
        of = (plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(r), R(0.6 * r) } };
    }
    of.density = R(decades(seed, 0, 3));
    assert_true(plumb_shape_valid(w, plumb_shape_create(w, b, &of)));
    sim_launch(w, b, -speed * x / way, -speed * y / way, among(seed, -8, 8));
    return b;
}

static void surround(plumb_world *w, uint32_t *seed, double distance)
{
    for (int i = 0; i < 4; ++i) {
        const double at = 1.5707963 * i + among(seed, -0.3, 0.3);
        thrown(w, seed, distance * cos(at), distance * sin(at), among(seed, 0.5, 6));
    }
}

static void make_tied(plumb_world *w, uint32_t *seed, double mass)
{
    const double half = among(seed, 0.5, 2);
    const plumb_body a = thrown(w, seed, -half - 0.45, 0, 0),
                     b = thrown(w, seed, half + 0.45, 0, 0);
    sim_launch(w, a, 0, among(seed, -8, 8), among(seed, -8, 8));
    plumb_rope_create(w, &(plumb_rope_desc){ .from = { R(-half), 0 },
                                             .to = { R(half), 0 },
                                             .nodes = 12,
                                             .mass = R(mass),
                                             .from_body = a,
                                             .to_body = b });
}

static void make(plumb_world *w, kind k, uint32_t *seed)
{
    const double mass = decades(seed, -1, 1), friction = among(seed, 0, 1);
    const plumb_real mu = friction < 0.3 ? -1 : R(friction);
    const plumb_vec2 box[4] = {
        { -R(0.5), -R(0.5) }, { R(0.5), -R(0.5) }, { R(0.5), R(0.5) }, { -R(0.5), R(0.5) }
    };
    switch (k) {
    case TIED:
        make_tied(w, seed, mass);
        break;
    case THREAD:
        plumb_rope_create(w,
                          &(plumb_rope_desc){
                              .from = { -2, 0 }, .to = { 2, 0 }, .mass = R(mass), .friction = mu });
        for (int i = 0; i < 4; ++i) {
            const double side = sim_random(seed) % 2 ? 1 : -1;
            thrown(w, seed, i - 1.5, side * among(seed, 0.8, 2), among(seed, 1, 4));
        }
        break;
    case CLOTH:
        plumb_cloth_create(w, &(plumb_cloth_desc){ .low = { -1, -1 },
                                                   .high = { 1, 1 },
                                                   .columns = 6,
                                                   .mass = R(mass),
                                                   .friction = mu });
        surround(w, seed, 2.2);
        break;
    case JELLY:
        plumb_jelly_create(w, &(plumb_jelly_desc){ .points = box,
                                                   .count = 4,
                                                   .spacing = R(0.2),
                                                   .density = R(30 * mass),
                                                   .friction = mu,
                                                   .velocity = { R(among(seed, -4, 4)), 1 } });
        surround(w, seed, 1.6);
        break;
    default:
        plumb_skin_create(w, &(plumb_skin_desc){ .mass = R(mass), .friction = mu });
        surround(w, seed, 1.6);
        break;
    }
}

// The worst of a step, of a bound that no momentum of this energy and mass can exceed, and the same 2 m from the centre.
typedef struct worst {
    double momentum, turning;
} worst;

static worst follow(kind k, uint32_t seed, plumb_solver solver, int substeps)
{
    plumb_world *w = sim_world(
        &(plumb_world_desc){ .zero_gravity = true, .solver = solver, .substeps = substeps });
    make(w, k, &seed);
    worst out = { 0, 0 };
    plumb_energy a = plumb_world_energy(w);
    for (int i = 0; i < 90; ++i) {
        sim_step(w, 1 / 60.0);
        const plumb_energy b = plumb_world_energy(w);
        const double scale = sqrt(2 * fmax(a.kinetic, b.kinetic) * b.mass) + 1e-9;
        const double x = b.momentum_x - a.momentum_x, y = b.momentum_y - a.momentum_y;
        out.momentum = fmax(out.momentum, sqrt(x * x + y * y) / scale);
        out.turning =
            fmax(out.turning, fabs(b.angular_momentum - a.angular_momentum) / (2 * scale));
        a = b;
    }
    plumb_world_destroy(w);
    return out;
}

// Ten of each with the defaults, two with 16 substeps, pgs and exact each.
static void momentum_stays(void **state)
{
    (void)state;
    for (int k = 0; k < KINDS; ++k) {
        worst of = { 0, 0 };
        for (uint32_t i = 0; i < 16; ++i) {
            if (!trials_takes(i, 4)) {
                continue;
            }
            const plumb_solver solver = i < 12   ? PLUMB_SOLVER_SOFT
                                        : i < 14 ? PLUMB_SOLVER_PGS
                                                 : PLUMB_SOLVER_EXACT;
            const int substeps = i < 10 ? 0 : i < 12 ? 16 : 4;
            const worst one = follow((kind)k, 4242 + 97 * i, solver, substeps);
            of.momentum = fmax(of.momentum, one.momentum);
            of.turning = fmax(of.turning, one.turning);
        }
        print_message("kind %d: momentum %.2g, angular momentum %.2g\n", k, of.momentum,
                      of.turning);
        assert_true(of.momentum < 2e-5);
        assert_true(of.turning < (k == CLOTH || k == THREAD ? 5e-3 : 1.5e-3));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(momentum_stays) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
