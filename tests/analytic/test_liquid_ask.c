// test_liquid_ask.c - the liquid, asked: how full it is at a place and how it flows there, by a sum over all particles;
// where rays meet its surface; whom it touches, what that weighs, and that nobody is told twice.
// PLUMB_LONG
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "harness/sim.h"
#include "harness/tank.h"

#define HZ60 (1 / 60.0)

//---- by all particles ----------------------------------------------------------------------------

typedef struct answer {
    double fill, vx, vy;
} answer;

static double spline(double t)
{
    t = fabs(t);
    return t < 0.5 ? 0.75 - t * t : t < 1.5 ? (1.5 - t) * (1.5 - t) / 2 : 0;
}

static answer sum_at(const plumb_world *w, double spacing, double x, double y)
{
    int count;
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    answer a = { 0, 0, 0 };
    for (int i = 0; i < count; ++i) {
        const double dx = x - (double)p[i].position.x, dy = y - (double)p[i].position.y;
        const double weight = spline(dx / (2 * spacing)) * spline(dy / (2 * spacing)) / 4;
        a.fill += weight;
        a.vx += weight * ((double)p[i].velocity.x + (double)p[i].gradient[0] * dx +
                          (double)p[i].gradient[1] * dy);
        a.vy += weight * ((double)p[i].velocity.y + (double)p[i].gradient[2] * dx +
                          (double)p[i].gradient[3] * dy);
    }
    if (a.fill > 0) {
        a.vx /= a.fill, a.vy /= a.fill;
    }
    return a;
}

// Water that falls into a corner, with a plank in it.
static plumb_world *splash(double spacing, int steps)
{
    plumb_world *w = tank_make(3, 3, spacing);
    tank_fill(w, 0.2, 0.4, 1.4, 1.6);
    const plumb_body plank = sim_body(w, PLUMB_DYNAMIC, 1.5, 0.4, 0.3);
    sim_add_box(w, plank, 0.4, 0.1,
                plumb_material_create(w, &(plumb_material_desc){ .density = 500 }));
    for (int i = 0; i < steps; ++i) {
        sim_step(w, HZ60);
    }
    return w;
}

static void places_are_as_full_as_all_particles_say(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int run = 0; run < 6; ++run) {
        const double spacing = 0.04 + 0.02 * run;
        plumb_world *w = splash(spacing, 20 * run);
        for (int i = 0; i < 400; ++i) {
            const double x = (double)(plumb_real)sim_uniform(&seed, -0.5, 3.5);
            const double y = (double)(plumb_real)sim_uniform(&seed, -0.5, 3.5);
            const plumb_liquid_sample s = plumb_liquid_at(w, sim_vec(x, y));
            const answer a = sum_at(w, spacing, x, y);
            assert_near((double)s.fill, a.fill, 1e-5);
            assert_near((double)s.velocity.x, a.vx, 1e-4 * (1 + fabs(a.vx)));
            assert_near((double)s.velocity.y, a.vy, 1e-4 * (1 + fabs(a.vy)));
        }
        plumb_world_destroy(w);
    }
}

static void a_lattice_is_full_and_half_full_at_its_edges(void **state)
{
    (void)state;
    plumb_world *w = tank_make(4, 4, 0.05);
    tank_fill(w, 0, 0, 2, 1);
    plumb_liquid_set_phases(w, &(plumb_liquid_phase){ .density = 800 }, 1);
    plumb_liquid_add_box(w, sim_vec(0, 1), sim_vec(2, 1.5), &(plumb_particle){ .phase = 1 });
    uint32_t seed = 3;
    for (int i = 0; i < 300; ++i) {
        const double x = sim_uniform(&seed, 0.16, 1.84), y = sim_uniform(&seed, 0.16, 1.34);
        const plumb_liquid_sample s = plumb_liquid_at(w, sim_vec(x, y));
        assert_near((double)s.fill, 1, 1e-5);
        assert_int_equal(s.phase, y > 1 + 1e-6 ? 1 : 0);
        assert_near((double)plumb_liquid_at(w, sim_vec(x, 1.5)).fill, 0.5, 1e-5);
        assert_near((double)plumb_liquid_at(w, sim_vec(2, y)).fill, 0.5, 1e-5);
        assert_true(plumb_liquid_at(w, sim_vec(x, 1.66)).fill == 0);
    }
    plumb_world_destroy(w);
}

//---- rays ----------------------------------------------------------------------------------------

// Straight down from anywhere above it, the level; the same from below, from the side.
static void rays_tell_the_level(void **state)
{
    (void)state;
    uint32_t seed = 11;
    plumb_world *w = tank_make(4, 4, 0.05);
    tank_fill(w, 1, 0, 3, 1);
    for (int i = 0; i < 200; ++i) {
        const double x = sim_uniform(&seed, 1.2, 2.8), top = sim_uniform(&seed, 1.01, 50);
        plumb_liquid_hit hit;
        assert_true(plumb_liquid_ray(w, sim_vec(x, top), sim_vec(x, -1), &hit));
        assert_near((double)hit.point.y, 1, 1e-4);
        assert_near((double)hit.fraction, (top - 1) / (top + 1), 1e-4);
        assert_near((double)hit.normal.y, 1, 1e-3);
        assert_true(plumb_liquid_ray(w, sim_vec(-top, x / 4), sim_vec(8, x / 4), &hit));
        assert_near((double)hit.point.x, 1, 1e-4);
        assert_near((double)hit.normal.x, -1, 1e-3);
        assert_false(plumb_liquid_ray(w, sim_vec(x, top), sim_vec(x, 1.005), &hit));
        assert_false(plumb_liquid_ray(w, sim_vec(x, top), sim_vec(x, top + 9), &hit));
        assert_true(plumb_liquid_ray(w, sim_vec(x, 0.5), sim_vec(x, top), &hit));
        assert_true(hit.fraction == 0 && hit.normal.x == 0 && hit.normal.y == 0);
        assert_true(plumb_liquid_ray(w, sim_vec(x, 0.5), sim_vec(x, 0.5), &hit));
        assert_false(plumb_liquid_ray(w, sim_vec(x, top), sim_vec(x, top), &hit));
    }
    plumb_world_destroy(w);
}

// What is hit is half full, nothing before it is full; what is not hit is nowhere.
static void rays_stop_at_what_is_half_full(void **state)
{
    (void)state;
    uint32_t seed = 23;
    int hits = 0;
    for (int run = 0; run < 5; ++run) {
        plumb_world *w = splash(0.05, 15 * run);
        for (int i = 0; i < 80; ++i) {
            const double x = sim_uniform(&seed, -1, 4), y = sim_uniform(&seed, -1, 4);
            const double dx = sim_uniform(&seed, -4, 4), dy = sim_uniform(&seed, -4, 4);
            const double length = sqrt(dx * dx + dy * dy);
            plumb_liquid_hit hit;
            const bool met = plumb_liquid_ray(w, sim_vec(x, y), sim_vec(x + dx, y + dy), &hit);
            const double end = met ? (double)hit.fraction : 1;
            hits += met;
            // A sheet may be full for less than half a spacing, which is the promise.
            int full = 0, longest = 0;
            for (double at = 0; at < end * length - 1e-3; at += 0.0025) {
                const answer a = sum_at(w, 0.05, x + dx * at / length, y + dy * at / length);
                full = a.fill > 0.5 + 1e-4 ? full + 1 : 0;
                longest = full > longest ? full : longest;
            }
            assert_true(longest * 0.0025 <= 0.025);
            if (met && end > 0) {
                const answer a = sum_at(w, 0.05, x + dx * end, y + dy * end);
                assert_near(a.fill, 0.5, 2e-3);
                assert_near(hypot((double)hit.normal.x, (double)hit.normal.y), 1, 1e-5);
            }
        }
        plumb_world_destroy(w);
    }
    assert_true(hits > 80);
}

// A drop that flew to the end of the world does not make rays longer.
static void far_drops_cost_nothing(void **state)
{
    (void)state;
    plumb_world *w = tank_make(4, 4, 0.05);
    tank_fill(w, 0, 0, 2, 1);
    const plumb_particle far[] = { { .position = { (plumb_real)-5e7, 0 } },
                                   { .position = { (plumb_real)5e7, (plumb_real)5e7 } } };
    assert_int_equal(plumb_liquid_add(w, far, 2), PLUMB_OK);
    plumb_liquid_hit hit;
    assert_true(plumb_liquid_ray(w, sim_vec(1, 1e9), sim_vec(1, -1), &hit));
    assert_near((double)hit.point.y, 1, PLUMB_REAL_IS_DOUBLE ? 1e-4 : 100);
    assert_true(plumb_liquid_ray(w, sim_vec(-1e9, 0.5), sim_vec(1e9, 0.5), &hit));
    assert_false(plumb_liquid_ray(w, sim_vec(-1e9, 3), sim_vec(1e9, 3), &hit));
    plumb_world_destroy(w);
}

//---- whom it touches -----------------------------------------------------------------------------

static const plumb_liquid_contact *contact_of(const plumb_world *w, plumb_body body)
{
    int count;
    const plumb_liquid_contact *all = plumb_liquid_contacts(w, &count);
    for (int i = 0; i < count; ++i) {
        if (plumb_same(all[i].body, body)) {
            return &all[i];
        }
    }
    return NULL;
}

// All that changes the momentum of a body that floats is its weight and what the liquid is said to do to it; that begins once,
// and bears it in the end.
static void what_floats_is_borne_by_what_is_told(void **state)
{
    (void)state;
    for (int i = 0; i < 4; ++i) {
        const double density = 200 + 200 * i, mass = density * 0.8 * 0.5, weight = 9.81 * mass;
        plumb_world *w = tank_make(4, 4, 0.05);
        plumb_world_set_gravity(w, sim_vec(0, -9.81));
        tank_fill(w, 0, 0, 4, 1.2);
        const plumb_body box = sim_body(w, PLUMB_DYNAMIC, 2, 1.6, 0.2);
        const plumb_material m =
            plumb_material_create(w, &(plumb_material_desc){ .density = (plumb_real)density });
        sim_add_box(w, box, 0.4, 0.25, m);
        int begun = 0;
        double mean = 0;
        for (int k = 0; k < 900; ++k) {
            const plumb_vec2 before = plumb_body_velocity(w, box);
            const double spun = (double)plumb_body_angular_velocity(w, box);
            sim_step(w, HZ60);
            const plumb_liquid_contact *c = contact_of(w, box);
            const plumb_vec2 now = plumb_body_velocity(w, box);
            const double turned = (double)plumb_body_angular_velocity(w, box) - spun;
            const double x = c != NULL ? (double)c->force.x : 0,
                         y = c != NULL ? (double)c->force.y : 0;
            assert_near(((double)now.x - (double)before.x) * mass / HZ60, x, 1e-4 * weight);
            assert_near(((double)now.y - (double)before.y) * mass / HZ60, y - weight,
                        1e-4 * weight);
            assert_near(turned * (double)plumb_body_inertia(w, box) / HZ60,
                        c != NULL ? (double)c->torque : 0, 1e-4 * weight);
            begun += c != NULL && c->began;
            mean += k >= 600 ? y / 300 : 0;
        }
        assert_int_equal(begun, 1);
        assert_near(mean, weight, 0.02 * weight);
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_as_full_as_all_particles_say),
        cmocka_unit_test(a_lattice_is_full_and_half_full_at_its_edges),
        cmocka_unit_test(rays_tell_the_level),
        cmocka_unit_test(rays_stop_at_what_is_half_full),
        cmocka_unit_test(far_drops_cost_nothing),
        cmocka_unit_test(what_floats_is_borne_by_what_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
