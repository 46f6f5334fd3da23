// test_box2d.c - the same scene through Plumb and Box2D 2.4.1: refining the time step must bring
// their trajectories together. Printed: scene, rate, largest distance of any two counterparts at
// any common time.
//
// Both engines get the same shapes, masses and materials; Box2D without its polygon skin and
// without a restitution threshold. Where both are first order, the distance falls as the step does.
// Box2D computes in float and stops short of contact by its slop of 5 mm: the floor that a bound
// allows for.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/engine.h"

// [m] Both compute in float: about 1000 roundings of 10 m. What is nearer need not fall any more.
#define NOISE 5e-4

enum { MAX_BODIES = 24, SAMPLES = 60, RATES = 5 };

static const double rates[RATES] = { 60, 120, 240, 480, 960 };

typedef struct engine_world engine_world;

typedef struct scene {
    const char *name;
    double seconds;
    double gravity_x, gravity_y;
    void (*build)(const struct engine *e, engine_world *w);
    double fall;   // distance at the finest step over that at the coarsest, at most
    double finest; // [m] distance at the finest step, at most
    // [m] Not 0: a difference that stays. Where an impact without bounce meets friction or several
    // contacts at once, the soft step takes the impulses in another order (one sweep a substep,
    // what is left in the next) than an iteration to convergence does, and ends at another outcome
    // that satisfies the contact laws as well.
    double lasting;
} scene;

typedef struct track {
    int bodies;
    double x[SAMPLES][MAX_BODIES], y[SAMPLES][MAX_BODIES], turn[SAMPLES][MAX_BODIES];
} track;

//---- scenes --------------------------------------------------------------------------------------

static int add(const struct engine *e, engine_world *w, enum engine_body_type type, double x,
               double y, double angle)
{
    struct engine_body_def def = { .type = type, .x = x, .y = y, .angle = angle };
    int body = e->add_body(w, &def);
    assert_true(body >= 0);
    return body;
}

static struct engine_material stuff(double friction, double restitution)
{
    return (struct engine_material){ 1, friction, restitution };
}

static int disc(const struct engine *e, engine_world *w, double x, double y, double r,
                struct engine_material m)
{
    int body = add(e, w, ENGINE_DYNAMIC, x, y, 0);
    assert_int_equal(e->add_circle(w, body, &m, 0, 0, r), ENGINE_OK);
    return body;
}

static void box_on(const struct engine *e, engine_world *w, int body, double hx, double hy,
                   struct engine_material m)
{
    const double x[4] = { -hx, hx, hx, -hx }, y[4] = { -hy, -hy, hy, hy };
    assert_int_equal(e->add_polygon(w, body, &m, x, y, 4, 0), ENGINE_OK);
}

static int box(const struct engine *e, engine_world *w, double x, double y, double hx, double hy,
               double angle, struct engine_material m)
{
    int body = add(e, w, ENGINE_DYNAMIC, x, y, angle);
    box_on(e, w, body, hx, hy, m);
    return body;
}

static void ground(const struct engine *e, engine_world *w, double angle, struct engine_material m)
{
    int body = add(e, w, ENGINE_STATIC, -sin(angle), -cos(angle), -angle);
    box_on(e, w, body, 50, 1, m);
}

static void free_fall(const struct engine *e, engine_world *w)
{
    int a = disc(e, w, 0, 10, 0.5, stuff(0.5, 0));
    int b = box(e, w, -3, 10, 0.5, 0.25, 0.3, stuff(0.5, 0));
    e->set_velocity(w, a, 3, 4, 2);
    e->set_velocity(w, b, -2, 5, -3);
}

static void bounce(const struct engine *e, engine_world *w)
{
    ground(e, w, 0, stuff(0, 0.8));
    disc(e, w, 0, 3.5, 0.5, stuff(0, 0.8));
    disc(e, w, 3, 2.5, 0.5, stuff(0, 0.5));
}

static void slide(const struct engine *e, engine_world *w)
{
    ground(e, w, 0, stuff(0.4, 0));
    e->set_velocity(w, box(e, w, -8, 0.25, 0.5, 0.25, 0, stuff(0.4, 0)), 8, 0, 0);
}

static void incline(const struct engine *e, engine_world *w)
{
    const double angle = 0.5;
    ground(e, w, angle, stuff(0.3, 0));
    box(e, w, 0.25 * sin(angle), 0.25 * cos(angle), 0.5, 0.25, -angle, stuff(0.3, 0));
}

static void incline_rest(const struct engine *e, engine_world *w)
{
    const double angle = 0.3;
    ground(e, w, angle, stuff(0.5, 0));
    box(e, w, 0.25 * sin(angle), 0.25 * cos(angle), 0.5, 0.25, -angle, stuff(0.5, 0));
}

static void roll(const struct engine *e, engine_world *w)
{
    const double angle = 0.3;
    ground(e, w, angle, stuff(0.6, 0));
    disc(e, w, 0.5 * sin(angle), 0.5 * cos(angle), 0.5, stuff(0.6, 0));
}

static void slip_to_roll(const struct engine *e, engine_world *w)
{
    ground(e, w, 0, stuff(0.3, 0));
    e->set_velocity(w, disc(e, w, -8, 0.5, 0.5, stuff(0.3, 0)), 8, 0, 0);
}

static void discs_head_on(const struct engine *e, engine_world *w)
{
    e->set_velocity(w, disc(e, w, -2, 0, 0.5, stuff(0, 1)), 4, 0, 0);
    disc(e, w, 1, 0, 0.7, stuff(0, 1));
}

static void discs_off_centre(const struct engine *e, engine_world *w)
{
    e->set_velocity(w, disc(e, w, -2, 0.4, 0.5, stuff(0.3, 0.7)), 4, 0, 0);
    disc(e, w, 1, 0, 0.5, stuff(0.3, 0.7));
}

static void box_struck_off_centre(const struct engine *e, engine_world *w)
{
    e->set_velocity(w, disc(e, w, -2, 0.6, 0.25, stuff(0, 0.9)), 4, 0, 0);
    box(e, w, 1, 0, 0.25, 1, 0, stuff(0, 0.9));
}

static void box_corner_hits_box(const struct engine *e, engine_world *w)
{
    e->set_velocity(w, box(e, w, -2, 0.3, 0.4, 0.4, 0.6, stuff(0, 0.5)), 3, 0, 1);
    box(e, w, 1, 0, 0.5, 0.8, 0, stuff(0, 0.5));
}

static void rough_box_hits_box(const struct engine *e, engine_world *w)
{
    e->set_velocity(w, box(e, w, -2, 0.3, 0.4, 0.4, 0.6, stuff(0.2, 0)), 3, 0, 1);
    box(e, w, 1, 0, 0.5, 0.8, 0, stuff(0.2, 0));
}

static void stack(const struct engine *e, engine_world *w)
{
    ground(e, w, 0, stuff(0.6, 0));
    for (int i = 0; i < 5; ++i) {
        box(e, w, 0, 0.5 + i, 0.5, 0.5, 0, stuff(0.6, 0));
    }
}

static void dominoes(const struct engine *e, engine_world *w)
{
    ground(e, w, 0, stuff(0.5, 0));
    for (int i = 0; i < 6; ++i) {
        int b = box(e, w, 0.6 * i, 0.75, 0.1, 0.75, 0, stuff(0.5, 0));
        if (i == 0) {
            e->set_velocity(w, b, 1.2, 0, -1.6); // tips about its right foot
        }
    }
}

static const scene scenes[] = {
    { "free fall", 2, 0, -10, free_fall, 0.1, 0.012, 0 },
    { "bounce", 2.5, 0, -10, bounce, 0.3, 0.03, 0 },
    { "slide", 2.5, 0, -10, slide, 0.2, 0.012, 0 },
    { "incline, sliding", 2, 0, -10, incline, 0.2, 0.012, 0 },
    { "incline, at rest", 4, 0, -10, incline_rest, 1, 6e-3, 0 },
    { "rolling down", 2, 0, -10, roll, 0.2, 0.012, 0 },
    { "slipping, rolling", 2.5, 0, -10, slip_to_roll, 0.2, 0.012, 0 },
    { "discs head on", 1.5, 0, 0, discs_head_on, 0.2, 0.01, 0 },
    { "discs off centre", 1.5, 0, 0, discs_off_centre, 0.2, 0.01, 0 },
    { "box struck off centre", 1.5, 0, 0, box_struck_off_centre, 0.3, 0.01, 0 },
    { "box corner hits box", 1.5, 0, 0, box_corner_hits_box, 0.5, 0.02, 0 },
    { "rough box hits box", 1.5, 0, 0, rough_box_hits_box, 0.5, 0.03, 0.15 },
    { "stack of 5 at rest", 4, 0, -10, stack, 1, 0.03, 0 },
    { "dominoes", 1.5, 0, -10, dominoes, 0.6, 0.05, 0 },
};

//---- runs ----------------------------------------------------------------------------------------

static void run(const struct engine *e, const scene *s, const char *solver, double rate, track *out)
{
    struct engine_options o = engine_options_default();
    o.gravity_x = s->gravity_x;
    o.gravity_y = s->gravity_y;
    o.restitution_threshold = 0;
    o.skin = 0;
    o.solver = solver;
    engine_world *w = e->create(&o);
    assert_non_null(w);
    s->build(e, w);
    out->bodies = e->counts(w).bodies;
    assert_in_range(out->bodies, 1, MAX_BODIES);
    double turn[MAX_BODIES] = { 0 };
    int step = 0;
    for (int k = 0; k < SAMPLES; ++k) {
        int until = (int)lround(s->seconds * rate * (k + 1) / SAMPLES);
        for (; step < until; ++step) {
            e->step(w, 1 / rate);
        }
        for (int i = 0; i < out->bodies; ++i) {
            struct engine_pose p = e->get_pose(w, i);
            turn[i] += remainder(p.angle - turn[i], 6.283185307179586);
            out->x[k][i] = p.x, out->y[k][i] = p.y, out->turn[k][i] = turn[i];
        }
    }
    e->destroy(w);
}

// [m] farthest apart that any two counterparts ever were; an angle counts by a lever of 0.5 m.
static double distance(const track *a, const track *b)
{
    double worst = 0;
    for (int k = 0; k < SAMPLES; ++k) {
        for (int i = 0; i < a->bodies; ++i) {
            double d = hypot(a->x[k][i] - b->x[k][i], a->y[k][i] - b->y[k][i]) +
                       0.5 * fabs(a->turn[k][i] - b->turn[k][i]);
            worst = d <= worst ? worst : d;
        }
    }
    return worst;
}

// One row of the table; true when it passes.
static bool compare(const scene *s, const char *solver, track *plumb, track *other)
{
    double d[RATES];
    print_message("%-24s", s->name);
    for (int r = 0; r < RATES; ++r) {
        run(&engine_plumb, s, solver, rates[r], plumb);
        run(&engine_box2d2, s, NULL, rates[r], other);
        d[r] = distance(plumb, other);
        print_message(" %11.3g", d[r]);
    }
    bool lasts = s->lasting > 0 && strcmp(solver, "soft") == 0;
    double bound = lasts ? s->lasting : s->finest;
    bool near = d[RATES - 1] <= bound;
    bool falls = lasts || d[RATES - 1] <= s->fall * d[0] || d[RATES - 1] <= NOISE;
    print_message("   %8g   %4g  %s\n", bound, s->fall,
                  near && falls ? (lasts ? "lasting" : "ok")
                  : near        ? "DOES NOT FALL"
                                : "APART");
    return near && falls;
}

static void engines_agree(const char *solver)
{
    track *plumb = malloc(sizeof *plumb), *other = malloc(sizeof *other);
    assert_non_null(plumb);
    assert_non_null(other);
    int failures = 0;
    print_message("%-9s distance [m] at", solver);
    for (int r = 0; r < RATES; ++r) {
        print_message(" %*.0f Hz", r == 0 ? 4 : 8, rates[r]);
    }
    print_message("   finest <=, fall <=\n");
    for (size_t k = 0; k < sizeof scenes / sizeof scenes[0]; ++k) {
        failures += !compare(&scenes[k], solver, plumb, other);
    }
    free(plumb);
    free(other);
    assert_int_equal(failures, 0);
}

static void soft_step_agrees(void **state)
{
    (void)state;
    engines_agree("soft");
}

static void baseline_agrees(void **state)
{
    (void)state;
    engines_agree("baseline");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(soft_step_agrees),
        cmocka_unit_test(baseline_agrees),
    };
    return cmocka_run_group_tests_name("box2d", tests, NULL, NULL);
}
