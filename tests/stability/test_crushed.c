// test_crushed.c - what a kinematic body crushes: nothing can solve that, so it is to be borne calmly. Crates and balls under presses
// that come down askew, and between doors that close on them; no finer or exact solution may turn that into a cannon.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/sim.h"

#define HZ60   (1 / 60.0)
#define TRIALS 200
#define SHOT   50.0 // [m/s] that a press of 3 m/s does not give

typedef struct spread {
    int shot;
    double fastest;
} spread;

static void watch(spread *s, plumb_world *w, int steps)
{
    double fastest = 0;
    for (int i = 0; i < steps; ++i) {
        sim_step(w, HZ60);
        fastest = fmax(fastest, sim_max_speed(w));
    }
    s->shot += fastest > SHOT;
    s->fastest = fmax(s->fastest, fastest);
}

static plumb_world *make(plumb_material m)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    sim_floor(w, m);
    return w;
}

static void press(uint32_t *r, spread *s, bool ball)
{
    const plumb_material m = PLUMB_NULL_INIT;
    plumb_world *w = make(m);
    const double hx = sim_uniform(r, 0.2, 0.7), hy = sim_uniform(r, 0.2, 0.7);
    const double x = sim_uniform(r, -1, 1), aside = sim_uniform(r, -0.5, 0.5);
    sim_crate(w, x, hy, hx, hy, m);
    if (ball) {
        sim_ball(w, x + aside, 2 * hy + 0.3, 0.3, m);
    } else {
        sim_crate(w, x + aside, 2 * hy + 0.3, 0.3, 0.3, m);
    }
    plumb_body plate = sim_body(w, PLUMB_KINEMATIC, 0, 2 * hy + 1.2, sim_uniform(r, -0.3, 0.3));
    sim_add_box(w, plate, 2, 0.2, m);
    sim_launch(w, plate, 0, -sim_uniform(r, 0.5, 3), sim_uniform(r, -0.5, 0.5));
    watch(s, w, 120);
    plumb_world_destroy(w);
}

static void doors(uint32_t *r, spread *s, bool ball)
{
    const plumb_material m = PLUMB_NULL_INIT;
    plumb_world *w = make(m);
    double x = 0;
    for (int i = 0; i < 3; ++i) {
        const double hx = sim_uniform(r, 0.2, 0.6), hy = sim_uniform(r, 0.2, 0.6);
        if (i == 1 && ball) {
            sim_ball(w, x + hx, hx, hx, m);
        } else {
            sim_crate(w, x + hx, hy, hx, hy, m);
        }
        x += 2 * hx;
    }
    const double shut = (1 - sim_uniform(r, 0.4, 0.95)) * x / 2, time = sim_uniform(r, 0.2, 1.5);
    plumb_body left = sim_body(w, PLUMB_KINEMATIC, -2, 2, 0);
    plumb_body right = sim_body(w, PLUMB_KINEMATIC, x + 2, 2, 0);
    sim_add_box(w, left, 1, 2, m);
    sim_add_box(w, right, 1, 2, m);
    plumb_body_set_target(w, left, sim_vec(-1 + shut, 2), 0, (plumb_real)time);
    plumb_body_set_target(w, right, sim_vec(x + 1 - shut, 2), 0, (plumb_real)time);
    watch(s, w, 180);
    plumb_world_destroy(w);
}

static void what_is_crushed_is_no_cannon(void **state)
{
    (void)state;
    uint32_t chance = 7;
    spread pressed = { 0, 0 }, shut = { 0, 0 };
    for (int i = 0; i < TRIALS; ++i) {
        press(&chance, &pressed, i % 2 == 1);
        doors(&chance, &shut, i % 2 == 1);
    }
    print_message("press: %d of %d beyond %g m/s, fastest %.3g; doors: %d, %.3g\n", pressed.shot,
                  TRIALS, SHOT, pressed.fastest, shut.shot, shut.fastest);
    assert_in_range(pressed.shot, 0, TRIALS / 10);
    assert_in_range(shut.shot, 0, TRIALS / 50);
    assert_true(pressed.fastest < 1000 && shut.fastest < 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(what_is_crushed_is_no_cannon) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
