// test_stacks.c - what stands must stand: stacks, pyramids, mass ratios, thin cards, far from the
// origin. Each case is a row: scene, time, and how far anything may have moved.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/sim.h"

enum { MAX_BODIES = 256 };

#define HZ60 (1 / 60.0)

typedef struct pile {
    plumb_world *w;
    plumb_material m;
    plumb_body body[MAX_BODIES];
    double x[MAX_BODIES], y[MAX_BODIES]; // where it was put
    int count;
    double at_x, at_y; // [m] everything is moved by this much
} pile;

static void put(pile *p, double x, double y, double hx, double hy, double density)
{
    plumb_body b = sim_body(p->w, PLUMB_DYNAMIC, p->at_x + x, p->at_y + y, 0);
    plumb_shape_desc box = { .kind = PLUMB_BOX, .half = sim_vec(hx, hy), .material = p->m };
    box.density = (plumb_real)density;
    assert_false(plumb_is_null(plumb_shape_create(p->w, b, &box)));
    assert_in_range(p->count, 0, MAX_BODIES - 1);
    p->body[p->count] = b;
    p->x[p->count] = sim_x(p->w, b), p->y[p->count] = sim_y(p->w, b);
    ++p->count;
}

//---- scenes --------------------------------------------------------------------------------------

static void stack(pile *p, int n, double unused)
{
    (void)unused;
    for (int i = 0; i < n; ++i) {
        put(p, 0, 0.5 + i, 0.5, 0.5, 1);
    }
}

static void pyramid(pile *p, int base, double unused)
{
    (void)unused;
    for (int row = 0; row < base; ++row) {
        for (int i = 0; i < base - row; ++i) {
            put(p, 1.1 * (i - 0.5 * (base - row - 1)), 0.5 + row, 0.5, 0.5, 1);
        }
    }
}

// One box `ratio` times as heavy on top of n light ones.
static void heavy_on_light(pile *p, int n, double ratio)
{
    for (int i = 0; i <= n; ++i) {
        put(p, 0, 0.5 + i, 0.5, 0.5, i < n ? 1 : ratio);
    }
}

static void alternating(pile *p, int n, double ratio)
{
    for (int i = 0; i < n; ++i) {
        put(p, 0, 0.5 + i, 0.5, 0.5, i % 2 ? ratio : 1);
    }
}

// Thin boxes, `ratio` times as wide as high.
static void cards(pile *p, int n, double ratio)
{
    for (int i = 0; i < n; ++i) {
        put(p, 0, 0.02 * (2 * i + 1), 0.02 * ratio, 0.02, 1);
    }
}

static void slender(pile *p, int n, double ratio)
{
    for (int i = 0; i < n; ++i) {
        put(p, 0, 0.5 * ratio * (2 * i + 1), 0.5, 0.5 * ratio, 1);
    }
}

// Rounded boxes, each a little beside the one below, as bricks are: their flat faces overhang.
static void staggered(pile *p, int n, double shift)
{
    for (int i = 0; i < n; ++i) {
        double x = i % 2 ? shift : 0;
        plumb_body b = sim_body(p->w, PLUMB_DYNAMIC, x, 0.5 + i, 0);
        plumb_shape_desc box = { .kind = PLUMB_BOX, .half = sim_vec(0.4, 0.4), .material = p->m };
        box.radius = (plumb_real)0.1;
        assert_false(plumb_is_null(plumb_shape_create(p->w, b, &box)));
        p->body[p->count] = b;
        p->x[p->count] = x, p->y[p->count] = 0.5 + i;
        ++p->count;
    }
}

// Capsules lying on one another, side by side.
static void logs(pile *p, int n, double shift)
{
    for (int i = 0; i < n; ++i) {
        double x = i % 2 ? shift : 0;
        plumb_vec2 ends[2] = { sim_vec(-1, 0), sim_vec(1, 0) };
        plumb_body b = sim_body(p->w, PLUMB_DYNAMIC, x, 0.25 + 0.5 * i, 0);
        plumb_shape_desc log = { .kind = PLUMB_CAPSULE, .points = ends, .count = 2 };
        log.radius = (plumb_real)0.25;
        log.material = p->m;
        assert_false(plumb_is_null(plumb_shape_create(p->w, b, &log)));
        p->body[p->count] = b;
        p->x[p->count] = x, p->y[p->count] = 0.25 + 0.5 * i;
        ++p->count;
    }
}

// Each level of two posts and a beam across them.
static void portal(pile *p, int levels, double unused)
{
    (void)unused;
    for (int i = 0; i < levels; ++i) {
        put(p, -0.9, 1.2 * i + 0.5, 0.1, 0.5, 1);
        put(p, 0.9, 1.2 * i + 0.5, 0.1, 0.5, 1);
        put(p, 0, 1.2 * i + 1.1, 1.1, 0.1, 1);
    }
}

//---- the table -----------------------------------------------------------------------------------

// Sinking: a soft contact of stiffness m w^2 (m: effective mass of a point, w: 2 pi times the
// contact frequency) gives way by F / (m w^2). All that is above adds to F, and every contact below
// adds to the way of the topmost body, so a stack of n sinks with n (n + 1) / 2; measured 2.8e-4 m
// times that. Points far from the centre have less effective mass: cards sink more.
typedef struct stand_case {
    const char *name;
    void (*build)(pile *p, int n, double ratio);
    int n;
    double ratio;
    double seconds;
    double sideways, sink; // [m] at most, of any body against where it was put
    double creep;          // [m] at most, of any body in the second half of the time
    double at_x, at_y;     // [m]
    bool float_only;       // a limit of float; in double the line is that of the origin
} stand_case;

typedef struct motion {
    double sideways, sink, turn, creep, speed;
} motion;

static motion watch(const stand_case *c)
{
    static pile p;
    p = (pile){ .at_x = c->at_x, .at_y = c->at_y };
    p.w = sim_world(&(plumb_world_desc){ 0 });
    p.m = sim_material(p.w, 0.6, 0);
    plumb_body ground = sim_body(p.w, PLUMB_STATIC, c->at_x, c->at_y - 1, 0);
    sim_add_box(p.w, ground, 50, 1, p.m);
    c->build(&p, c->n, c->ratio);
    int steps = (int)(c->seconds * 60);
    sim_run(p.w, steps / 2, HZ60);
    double half_x[MAX_BODIES], half_y[MAX_BODIES];
    for (int i = 0; i < p.count; ++i) {
        half_x[i] = sim_x(p.w, p.body[i]), half_y[i] = sim_y(p.w, p.body[i]);
    }
    sim_run(p.w, steps - steps / 2, HZ60);
    motion m = { .speed = sim_max_speed(p.w) };
    for (int i = 0; i < p.count; ++i) {
        double x = sim_x(p.w, p.body[i]), y = sim_y(p.w, p.body[i]);
        m.sideways = fmax(m.sideways, fabs(x - p.x[i]));
        m.sink = fmax(m.sink, fabs(y - p.y[i]));
        m.turn = fmax(m.turn, fabs(sim_angle(p.w, p.body[i])));
        m.creep = fmax(m.creep, hypot(x - half_x[i], y - half_y[i]));
    }
    plumb_world_destroy(p.w);
    return m;
}

static void what_stands_stands(void **state)
{
    (void)state;
    const stand_case cases[] = {
        { "stack of 10", stack, 10, 0, 30, 1e-3, 0.02, 1e-4, 0, 0, false },
        { "stack of 20", stack, 20, 0, 30, 5e-3, 0.08, 1e-3, 0, 0, false },
        { "pyramid, base 10", pyramid, 10, 0, 20, 5e-3, 0.02, 1e-3, 0, 0, false },
        { "pyramid, base 20", pyramid, 20, 0, 20, 0.02, 0.05, 5e-3, 0, 0, false },
        { "10 times as heavy on 3", heavy_on_light, 3, 10, 20, 1e-3, 0.02, 1e-4, 0, 0, false },
        { "50 times as heavy on 3", heavy_on_light, 3, 50, 20, 5e-3, 0.1, 1e-3, 0, 0, false },
        { "100 times as heavy on 1", heavy_on_light, 1, 100, 20, 5e-3, 0.1, 1e-3, 0, 0, false },
        { "100 times as heavy on 3", heavy_on_light, 3, 100, 20, 0.01, 0.2, 1e-3, 0, 0, false },
        { "alternating 1 : 10", alternating, 10, 10, 20, 5e-3, 0.08, 1e-3, 0, 0, false },
        { "cards 25 : 1", cards, 20, 25, 20, 1e-3, 0.12, 1e-3, 0, 0, false },
        { "slender 1 : 4", slender, 5, 4, 20, 0.01, 0.02, 1e-3, 0, 0, false },
        { "rounded boxes, staggered", staggered, 8, 0.2, 20, 0.01, 0.03, 1e-3, 0, 0, false },
        { "capsules, staggered", logs, 8, 0.5, 20, 5e-3, 0.03, 1e-3, 0, 0, false },
        { "portals", portal, 5, 0, 20, 5e-3, 0.02, 1e-3, 0, 0, false },
        // Spacing of float: 6e-5 m at 1e3, 1e-3 m at 1e4. A few of those is what there is.
        { "stack of 5, 1 km off", stack, 5, 0, 20, 5e-3, 0.02, 2e-3, 1e3, 0, true },
        { "stack of 5, 1 km up", stack, 5, 0, 20, 5e-3, 0.02, 2e-3, 0, 1e3, true },
        { "stack of 5, 10 km off", stack, 5, 0, 20, 0.03, 0.05, 0.02, 1e4, 1e4, true },
    };
    int failures = 0;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const stand_case *c = &cases[k];
        motion m = watch(c);
        double exact = c->float_only ? SIM_TOLERANCE(1, 0.1) : 1;
        bool ok = m.sideways <= c->sideways * exact && m.sink <= c->sink &&
                  m.creep <= c->creep * exact && m.turn <= 0.05 && m.speed <= 0.05;
        print_message("%-24s %2.0f s: sideways %.2g (%.2g), sinks %.2g (%.2g), creeps %.2g (%.2g), "
                      "turns %.2g, speed %.2g%s\n",
                      c->name, c->seconds, m.sideways, c->sideways * exact, m.sink, c->sink,
                      m.creep, c->creep * exact, m.turn, m.speed, ok ? "" : "   FAILS");
        failures += !ok;
    }
    assert_int_equal(failures, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_stands_stands),
    };
    return cmocka_run_group_tests_name("stacks", tests, NULL, NULL);
}
