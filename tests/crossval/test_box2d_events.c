// test_box2d_events.c - the events of impacts in Plumb (both solvers) beside those of the contact listener of Box2D
// 2.4.1: one body thrown at another, at random. An impact is what changes the thrown body's velocity.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "harness/engine.h"
#include "harness/random.h"

#define THROWS 1500
#define STEPS  30
#define PI     3.14159265358979323846

typedef struct engine_world engine_world;
typedef enum form { CIRCLE, BOX, TRIANGLE, SEGMENT, FORMS } form;

typedef struct throw
{
    form thrown, target;
    enum engine_body_type type; // of the target
    double size, target_size, angle, target_angle, way, aside, speed, spin, lead, restitution;
}
throw;

typedef struct tally {
    int struck, touched, begins, missed, twice, odd; // throws, but for begins
} tally;

static throw throw_at_random(uint32_t * seed)
{
    throw t = { .thrown = (form)(sim_random(seed) % SEGMENT),
                .target = (form)(sim_random(seed) % FORMS) };
    t.type = t.target != SEGMENT && sim_random(seed) % 2 == 0 ? ENGINE_DYNAMIC : ENGINE_STATIC;
    t.size = sim_uniform(seed, 0.2, 0.6);
    t.target_size = sim_uniform(seed, 0.5, 2);
    t.angle = sim_uniform(seed, -PI, PI);
    t.target_angle = sim_uniform(seed, -PI, PI);
    t.way = sim_uniform(seed, -PI, PI);
    t.aside = sim_uniform(seed, -0.5, 0.5) * t.target_size;
    t.speed = sim_uniform(seed, 2, 60);
    t.spin = sim_uniform(seed, -3, 3);
    t.lead = t.speed / 60 * sim_uniform(seed, 0.1, 3);
    t.restitution = sim_random(seed) % 2 == 0 ? 0 : sim_uniform(seed, 0.1, 0.9);
    return t;
}

static void add_form(const struct engine *e, engine_world *w, int body, form f, double size,
                     double restitution)
{
    const struct engine_material m = { 1, 0, restitution };
    const double bx[] = { -size, size, size, -size },
                 by[] = { -size / 2, -size / 2, size / 2, size / 2 };
    const double tx[] = { -size, size, 0 }, ty[] = { -size, -size, size };
    const int status = f == CIRCLE     ? e->add_circle(w, body, &m, 0, 0, size)
                       : f == BOX      ? e->add_polygon(w, body, &m, bx, by, 4, 0)
                       : f == TRIANGLE ? e->add_polygon(w, body, &m, tx, ty, 3, 0)
                                       : e->add_segment(w, body, &m, -2 * size, 0, 2 * size, 0);
    assert_int_equal(status, ENGINE_OK);
}

static void fire(const struct engine *e, const char *solver, const throw *t, tally *of)
{
    struct engine_options o = engine_options_default();
    o.gravity_y = 0;
    o.solver = solver;
    o.restitution_threshold = 0;
    o.skin = 0;
    engine_world *w = e->create(&o);
    struct engine_body_def target = { .type = t->type, .angle = t->target_angle };
    add_form(e, w, e->add_body(w, &target), t->target, t->target_size, t->restitution);
    const double dx = cos(t->way), dy = sin(t->way),
                 far = 1.5 * t->size + 2.1 * t->target_size + t->lead;
    struct engine_body_def def = { .type = ENGINE_DYNAMIC,
                                   .x = -far * dx - t->aside * dy,
                                   .y = -far * dy + t->aside * dx,
                                   .angle = t->angle,
                                   .vx = t->speed * dx,
                                   .vy = t->speed * dy,
                                   .w = t->spin };
    const int body = e->add_body(w, &def);
    add_form(e, w, body, t->thrown, t->size, t->restitution);
    int begins = 0, ends = 0;
    bool struck = false, missed = false, odd = false;
    struct engine_velocity v = e->get_velocity(w, body);
    for (int i = 0; i < STEPS; ++i) {
        e->step(w, 1 / 60.0);
        const struct engine_velocity now = e->get_velocity(w, body);
        const bool is = hypot(now.x - v.x, now.y - v.y) > 1e-4 * (1 + t->speed);
        const struct engine_touches told = e->touches(w);
        missed |=
            is && begins == ends && told.begins == 0; // nothing touched, and nothing is told to
        begins += told.begins, ends += told.ends;
        odd |= begins < ends || begins > ends + 1;
        struck |= is;
        v = now;
    }
    e->destroy(w);
    of->struck += struck;
    of->touched += begins > 0;
    of->begins += begins;
    of->missed += missed;
    of->twice += begins > 1;
    of->odd += odd;
}

static void events_equal_those_of_box2d(void **state)
{
    (void)state;
    const struct {
        const struct engine *engine;
        const char *solver, *name;
    } rows[] = { { &engine_plumb, "soft", "plumb soft" },
                 { &engine_plumb, "baseline", "plumb pgs" },
                 { &engine_box2d2, NULL, "box2d 2.4.1" } };
    tally tallies[3] = { { 0 } };
    print_message("%-12s %7s %7s %7s %7s %7s %7s\n", "of 1500", "struck", "touched", "begins",
                  "missed", "again", "odd");
    for (int k = 0; k < 3; ++k) {
        uint32_t seed = 77;
        for (int i = 0; i < THROWS; ++i) {
            const throw t = throw_at_random(&seed);
            fire(rows[k].engine, rows[k].solver, &t, &tallies[k]);
        }
        const tally *t = &tallies[k];
        print_message("%-12s %7d %7d %7d %7d %7d %7d\n", rows[k].name, t->struck, t->touched,
                      t->begins, t->missed, t->twice, t->odd);
    }
    for (int k = 0; k < 2; ++k) {
        assert_int_equal(tallies[k].missed, 0);
        assert_int_equal(tallies[k].odd, 0);
        assert_true(tallies[k].struck > THROWS / 2);
        // Which of them are struck is not the same throw by throw: some graze.
        assert_true(abs(tallies[k].touched - tallies[2].touched) <= THROWS / 100);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_equal_those_of_box2d),
    };
    return cmocka_run_group_tests_name("box2d_events", tests, NULL, NULL);
}
