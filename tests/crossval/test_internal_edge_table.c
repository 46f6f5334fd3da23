// test_internal_edge_table.c - bodies that slide without friction over ground of many pieces: the largest
// disturbance (velocity across the ground, change of speed, spin times 1 m) as a share of the speed, in
// Plumb and beside it in Box2D 2.4.1 as it is by default, skin and all.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "harness/engine.h"

#define HZ60  (1 / 60.0)
#define TILE  0.5 // [m]
#define TILES 500

typedef struct engine_world engine_world;
typedef enum ground_kind {
    TILE_ROW,
    ONE_BODY,
    KINEMATIC,
    SEGMENTS,
    CHAIN,
    GROUND_KINDS
} ground_kind;
typedef enum body_kind { BOX, DISC, CAPSULE, TRIANGLE, BODY_KINDS } body_kind;

static const char *const ground_names[] = { "tile row", "tiles, one body", "kinematic row",
                                            "segments", "chain" };
static const char *const body_names[] = { "box", "disc", "capsule", "triangle" };
static const struct engine_material ice = { 1, 0, 0 };

static int add_body(const struct engine *e, engine_world *w, enum engine_body_type type, double x,
                    double y)
{
    struct engine_body_def def = { .type = type, .x = x, .y = y };
    int body = e->add_body(w, &def);
    assert_true(body >= 0);
    return body;
}

static void tile(const struct engine *e, engine_world *w, int body, double x)
{
    const double h = TILE / 2;
    const double px[] = { x - h, x + h, x + h, x - h }, py[] = { -TILE, -TILE, 0, 0 };
    assert_int_equal(e->add_polygon(w, body, &ice, px, py, 4, 0), ENGINE_OK);
}

static void make_ground(const struct engine *e, engine_world *w, ground_kind kind)
{
    static double x[TILES], y[TILES];
    int body = -1;
    if (kind != TILE_ROW) {
        body = add_body(e, w, kind == KINEMATIC ? ENGINE_KINEMATIC : ENGINE_STATIC, 0, 0);
    }
    for (int i = 0; i < TILES; ++i) {
        double at = TILE * i - 10;
        x[i] = TILE * (TILES - 1 - i) - 10; // free space on the right of the direction of travel
        switch (kind) {
        case TILE_ROW:
            tile(e, w, add_body(e, w, ENGINE_STATIC, at, 0), 0);
            break;
        case ONE_BODY:
        case KINEMATIC:
            tile(e, w, body, at);
            break;
        case SEGMENTS:
            assert_int_equal(e->add_segment(w, body, &ice, at, 0, at + TILE, 0), ENGINE_OK);
            break;
        default:
            break;
        }
    }
    if (kind == CHAIN) {
        assert_int_equal(e->add_chain(w, body, &ice, x, y, TILES, false), ENGINE_OK);
    }
}

// False when the engine has no such shape.
static bool make_body(const struct engine *e, engine_world *w, body_kind kind, int *body)
{
    const double bx[] = { -0.5, 0.5, 0.5, -0.5 }, by[] = { -0.5, -0.5, 0.5, 0.5 };
    const double tx[] = { -0.5, 0.5, 0 }, ty[] = { -0.5, -0.5, 0.5 };
    *body = add_body(e, w, ENGINE_DYNAMIC, 0, kind == CAPSULE ? 0.25 : 0.5);
    switch (kind) {
    case BOX:
        return e->add_polygon(w, *body, &ice, bx, by, 4, 0) == ENGINE_OK;
    case DISC:
        return e->add_circle(w, *body, &ice, 0, 0, 0.5) == ENGINE_OK;
    case CAPSULE:
        return e->add_capsule(w, *body, &ice, -0.3, 0, 0.3, 0, 0.25) == ENGINE_OK;
    default:
        return e->add_polygon(w, *body, &ice, tx, ty, 3, 0) == ENGINE_OK;
    }
}

// Largest disturbance, -1 when the engine has no such body.
static double slide(const struct engine *e, ground_kind ground, body_kind kind, double speed)
{
    struct engine_options options = engine_options_default();
    engine_world *w = e->create(&options);
    assert_non_null(w);
    int body;
    if (!make_body(e, w, kind, &body)) {
        e->destroy(w);
        return -1;
    }
    make_ground(e, w, ground);
    for (int i = 0; i < 180; ++i) {
        e->step(w, HZ60);
    }
    e->set_velocity(w, body, speed, 0, 0);
    double worst = 0;
    int steps = (int)fmin(200 * TILE / speed * 60, 3000);
    for (int i = 0; i < steps; ++i) {
        e->step(w, HZ60);
        struct engine_velocity v = e->get_velocity(w, body);
        worst = fmax(worst, fmax(fabs(v.y), fmax(fabs(v.x - speed), fabs(v.w))) / speed);
    }
    e->destroy(w);
    return worst;
}

static void table(void **state)
{
    (void)state;
    const double speeds[] = { 1, 20, 100 };
    bool failed = false;
    print_message("%-16s %-9s | %-10s at 1, 20, 100 m/s    | %s\n", "", "", engine_plumb.name,
                  engine_box2d2.name);
    for (int g = 0; g < GROUND_KINDS; ++g) {
        for (int b = 0; b < BODY_KINDS; ++b) {
            char line[200];
            int at = snprintf(line, sizeof line, "%-16s %-9s |", ground_names[g], body_names[b]);
            for (int k = 0; k < 3; ++k) {
                double d = slide(&engine_plumb, (ground_kind)g, (body_kind)b, speeds[k]);
                failed |= !(d >= 0 && d <= 1e-6);
                at += snprintf(line + at, sizeof line - (size_t)at, " %10.1e", d);
            }
            at += snprintf(line + at, sizeof line - (size_t)at, " |");
            for (int k = 0; k < 3; ++k) {
                double d = slide(&engine_box2d2, (ground_kind)g, (body_kind)b, speeds[k]);
                at += d < 0 ? snprintf(line + at, sizeof line - (size_t)at, " %10s", "no such")
                            : snprintf(line + at, sizeof line - (size_t)at, " %10.1e", d);
            }
            print_message("%s\n", line);
        }
    }
    assert_false(failed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
