// test_rubbing.c - impulses of contacts over a step along the tangent, against the change of momentum.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define DT (1 / 60.0)

// [N s] on a body, along x, of all its contacts in the last step.
static double pushed_x(const plumb_world *w, plumb_body b)
{
    plumb_contact contacts[8];
    const int count = plumb_body_contacts(w, b, contacts, 8);
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const plumb_contact *c = &contacts[i];
        const double sign = plumb_same(c->body_b, b) ? 1 : -1;
        for (int k = 0; k < c->point_count; ++k) {
            sum += sign * ((double)c->normal.x * (double)c->points[k].step_impulse -
                           (double)c->normal.y * (double)c->points[k].step_tangent_impulse);
        }
    }
    return sum;
}

// A crate slides, a ball bounces with spin: what a step takes from m v is what its contacts tell.
static void contacts_tell_all_that_rubs(void **state)
{
    (void)state;
    const double es[] = { 0, 0.3, 0.9 };
    static const char *const names[] = { "soft", "pgs", "exact" };
    for (int solver = PLUMB_SOLVER_SOFT; solver <= PLUMB_SOLVER_EXACT; ++solver) {
        for (int k = 0; k < 3; ++k) {
            plumb_world *w = sim_world(&(plumb_world_desc){
                .solver = (plumb_solver)solver, .contact_impulses = true, .no_sleep = true });
            plumb_material m = sim_material(w, 0.5, es[k]);
            sim_floor(w, m);
            plumb_body b = k == 0 ? sim_crate(w, 0, 0.6, 0.5, 0.5, m) : sim_ball(w, 0, 1, 0.5, m);
            sim_launch(w, b, 4, 0, k == 0 ? 0 : -3);
            const double mass = (double)plumb_body_mass(w, b);
            double told = 0, off = 0, before = sim_vx(w, b);
            for (int i = 0; i < 90; ++i) {
                sim_step(w, DT);
                const double now = sim_vx(w, b), impulse = pushed_x(w, b);
                // What bounced off within the step touches nothing any more, and is told no contact of.
                plumb_contact c;
                if (plumb_body_contacts(w, b, &c, 1) > 0) {
                    off = fmax(off, fabs(mass * (now - before) - impulse));
                    told += fabs(impulse);
                }
                before = now;
            }
            print_message("%s, e = %.1f: %.4f N s told, off by %.2g N s at most\n", names[solver],
                          es[k], told, off);
            assert_true(told > (k == 0 ? 3.9 * mass : 0.5 * mass));
            assert_true(off <= ROUNDED(1e-4));
            plumb_world_destroy(w);
        }
    }
}

// Asleep on a slope, a crate's contacts tell what holds it.
static void asleep_they_tell_what_holds(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .contact_impulses = true });
    plumb_material m = sim_material(w, 0.8, 0);
    plumb_body slope = sim_body(w, PLUMB_STATIC, 0, 0, 0.3);
    sim_add_box(w, slope, 5, 0.5, m);
    plumb_body b = sim_body(w, PLUMB_DYNAMIC, -sin(0.3) * 0.99, cos(0.3) * 0.99, 0.3);
    sim_add_box(w, b, 0.5, 0.5, m);
    sim_run(w, 300, DT);
    assert_false(plumb_body_is_awake(w, b));
    plumb_contact c;
    assert_int_equal(plumb_body_contacts(w, b, &c, 1), 1);
    const double weight = (double)plumb_body_mass(w, b) * SIM_G * DT;
    double along = 0;
    for (int k = 0; k < c.point_count; ++k) {
        along += (double)c.points[k].step_tangent_impulse;
    }
    assert_near(fabs(along) / (weight * sin(0.3)), 1, 0.01);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contacts_tell_all_that_rubs),
        cmocka_unit_test(asleep_they_tell_what_holds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
