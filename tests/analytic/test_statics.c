// test_statics.c - forces at rest: what contacts carry against what statics says. Forces are read
// from the contacts: impulse of the last substep over its length.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/sim.h"

#define HZ60 (1 / 60.0)

typedef struct groove_case {
    double left, right; // [degrees] of the walls from the horizontal
} groove_case;

// Walls at b1, b2: N1 = m g sin(b2) / sin(b1 + b2), N2 = m g sin(b1) / sin(b1 + b2).
static void disc_in_a_groove(void **state)
{
    (void)state;
    const groove_case cases[] = { { 45, 45 }, { 30, 60 }, { 20, 20 }, { 70, 35 } };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        double b1 = cases[k].left * SIM_PI / 180, b2 = cases[k].right * SIM_PI / 180;
        const double r = 0.5;
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, 0, 0);
        plumb_body left = sim_body(w, PLUMB_STATIC, 0, 0, 0);
        plumb_body right = sim_body(w, PLUMB_STATIC, 0, 0, 0);
        sim_add_segment(w, left, sim_vec(-8 * cos(b1), 8 * sin(b1)), sim_vec(0, 0), m);
        sim_add_segment(w, right, sim_vec(0, 0), sim_vec(8 * cos(b2), 8 * sin(b2)), m);
        // The centre is r away from both walls: r / sin(half the opening) from the corner.
        double open = SIM_PI - b1 - b2;
        double far = r / sin(open / 2), up = b2 + open / 2;
        plumb_body b = sim_ball(w, far * cos(up), far * sin(up), r, m);
        sim_run(w, 180, HZ60);
        double weight = (double)plumb_body_mass(w, b) * SIM_G;
        double n1 = weight * sin(b2) / sin(b1 + b2), n2 = weight * sin(b1) / sin(b1 + b2);
        double e1 = fabs(sim_normal_force(w, left, b, HZ60) / n1 - 1);
        double e2 = fabs(sim_normal_force(w, right, b, HZ60) / n2 - 1);
        print_message("groove %2.0f / %2.0f: forces off by %.2g, %.2g\n", cases[k].left,
                      cases[k].right, e1, e2);
        assert_true(e1 <= 1e-3 && e2 <= 1e-3);
        plumb_world_destroy(w);
    }
}

typedef struct beam_case {
    double left, right; // [m] of the supports from the beam's middle
} beam_case;

// Supports at distances a and b from the centre: N1 = m g b / (a + b), N2 = m g a / (a + b).
static void beam_on_two_supports(void **state)
{
    (void)state;
    const beam_case cases[] = { { 1.8, 1.8 }, { 1.8, 0.6 }, { 0.5, 1.5 }, { 1.9, 0.1 } };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const beam_case *c = &cases[k];
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, 0.5, 0);
        plumb_body support[2];
        for (int i = 0; i < 2; ++i) {
            support[i] = sim_body(w, PLUMB_STATIC, i == 0 ? -c->left : c->right, -0.05, 0);
            sim_add_circle(w, support[i], 0.05, m);
        }
        plumb_body beam = sim_crate(w, 0, 0.1, 2, 0.1, m);
        sim_run(w, 300, HZ60);
        double weight = (double)plumb_body_mass(w, beam) * SIM_G;
        double n1 = weight * c->right / (c->left + c->right);
        double n2 = weight * c->left / (c->left + c->right);
        double e1 = fabs(sim_normal_force(w, support[0], beam, HZ60) - n1) / weight;
        double e2 = fabs(sim_normal_force(w, support[1], beam, HZ60) - n2) / weight;
        print_message("beam on %.1f, %.1f: forces off by %.2g, %.2g of its weight\n", c->left,
                      c->right, e1, e2);
        assert_true(e1 <= 1e-3 && e2 <= 1e-3);
        plumb_world_destroy(w);
    }
}

typedef struct stack_case {
    int count;
    double seconds;
    double tolerance; // of the force, relative
    bool discs;
} stack_case;

// Under body k, counted from 0 at the bottom, rest count - k weights.
static void stack_carries_its_weight(void **state)
{
    (void)state;
    const stack_case cases[] = { { 1, 2, 1e-3, false },
                                 { 5, 5, 5e-3, false },
                                 { 10, 10, 0.01, false },
                                 { 20, 20, 0.02, false } };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const stack_case *c = &cases[k];
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, 0.6, 0);
        plumb_body body[20], ground = sim_floor(w, m);
        for (int i = 0; i < c->count; ++i) {
            body[i] = sim_crate(w, 0, 0.5 + i, 0.5, 0.5, m);
        }
        sim_run(w, (int)(c->seconds * 60), HZ60);
        double weight = (double)plumb_body_mass(w, body[0]) * SIM_G, worst = 0;
        for (int i = 0; i < c->count; ++i) {
            double force = sim_normal_force(w, i == 0 ? ground : body[i - 1], body[i], HZ60);
            worst = fmax(worst, fabs(force / ((c->count - i) * weight) - 1));
        }
        print_message("stack of %2d after %2.0f s: forces within %.2g\n", c->count, c->seconds,
                      worst);
        assert_true(worst <= c->tolerance);
        plumb_world_destroy(w);
    }
}

// The tangential impulses of a block at rest on a slope carry m g sin(theta).
static void friction_carries_the_slope(void **state)
{
    (void)state;
    const double degrees[] = { 10, 20, 30 };
    for (int k = 0; k < 3; ++k) {
        double angle = degrees[k] * SIM_PI / 180;
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, 0.8, 0);
        plumb_body ramp = sim_body(w, PLUMB_STATIC, -sin(angle), -cos(angle), -angle);
        sim_add_box(w, ramp, 20, 1, m);
        plumb_body b = sim_body(w, PLUMB_DYNAMIC, 0.25 * sin(angle), 0.25 * cos(angle), -angle);
        sim_add_box(w, b, 0.5, 0.25, m);
        sim_run(w, 180, HZ60);
        plumb_contact contact;
        assert_int_equal(plumb_world_contacts(w, &contact, 1), 1);
        double normal = 0, tangent = 0;
        for (int i = 0; i < contact.point_count; ++i) {
            normal += (double)contact.points[i].normal_impulse;
            tangent += (double)contact.points[i].tangent_impulse;
        }
        double h = HZ60 / plumb_world_settings(w).substeps;
        double weight = (double)plumb_body_mass(w, b) * SIM_G;
        double en = fabs(normal / h / (weight * cos(angle)) - 1);
        double et = fabs(fabs(tangent) / h / (weight * sin(angle)) - 1);
        print_message("slope %2.0f degrees: normal force off by %.2g, friction by %.2g\n",
                      degrees[k], en, et);
        assert_true(en <= 1e-3 && et <= 1e-3);
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(disc_in_a_groove),
        cmocka_unit_test(beam_on_two_supports),
        cmocka_unit_test(stack_carries_its_weight),
        cmocka_unit_test(friction_carries_the_slope),
    };
    return cmocka_run_group_tests_name("statics", tests, NULL, NULL);
}
