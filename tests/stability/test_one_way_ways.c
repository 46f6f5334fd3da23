// test_one_way_ways.c - one-way platforms of many forms, and what comes to them on random ways: from below it flies as in a
// world without the platform until it is out; from above it stays where it would on a solid one. In any direction of
// gravity, mirrored, of any size, with all solvers, at any steps and substeps, on platforms that move. Then who
// sleeps pressed into one, and characters that are half through rows of tiles or drop through them.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/sim.h"
#include "plumb/plumb.h"

#define R(x)  ((plumb_real)(x))
#define TRIPS 1500
#define WIDE  20.0  // [m] half the width of a platform
#define BAND  0.035 // [m] what is nearer below the top may be held or let pass

static uint32_t seed;

static double uniform(double low, double high)
{
    return sim_uniform(&seed, low, high);
}

static double spread(double low, double high)
{
    return exp(uniform(log(low), log(high)));
}

static int below(int n)
{
    return (int)(sim_random(&seed) % (uint32_t)n);
}

typedef enum form { BOX, THICK, ROUND, LINE, CHAIN, CAPSULE, OUTLINE, TILES, FORMS } form;
static const double tops[FORMS] = { 0.1, 1.5, 0.35, 0, 0, 0.3, 0.2, 0.25 }; // [m] of scale 1

typedef enum kind { BALL, BRICK, PILL, HEXAGON, COMPOUND, KINDS } kind;

// A scene is thought of with up along y; in the world it is turned and mirrored.
typedef struct trip {
    double c, s, mirror;
    form form;
    kind kind;
    double height, top,
        under;   // [m] scale of the platform, its surface and lowest point above its origin
    double size; // [m] of the body
    double x, y, vx, vy, angle, spin;
    double px, py; // [m/s] velocity of the platform
    double dt;
    bool varies, from_below, continuous;
    plumb_world_desc desc;
} trip;

static plumb_vec2 in_world(const trip *t, double x, double y)
{
    x *= t->mirror;
    return plumb_v2(R(t->c * x - t->s * y), R(t->s * x + t->c * y));
}

static double up_of(const trip *t, plumb_vec2 v)
{
    return -t->s * (double)v.x + t->c * (double)v.y;
}

static double along_of(const trip *t, plumb_vec2 v)
{
    return t->mirror * (t->c * (double)v.x + t->s * (double)v.y);
}

static plumb_body add_platform(plumb_world *world, const trip *t, bool one_way)
{
    const bool moves = t->px != 0 || t->py != 0;
    plumb_body body =
        plumb_body_create(world, &(plumb_body_desc){ .type = moves ? PLUMB_KINEMATIC : PLUMB_STATIC,
                                                     .velocity = in_world(t, t->px, t->py) });
    const double k = t->height, angle = atan2(t->s, t->c);
    plumb_vec2 points[21];
    plumb_shape_desc desc = { .kind = PLUMB_BOX, .angle = R(angle), .points = NULL };
    desc.one_way.direction = one_way ? in_world(t, 0, 3) : plumb_v2(0, 0);
    desc.half = plumb_v2(R(WIDE), R(t->form == THICK   ? 1.5 * k
                                    : t->form == ROUND ? 0.2 * k
                                                       : 0.1 * k));
    desc.radius = t->form == ROUND ? R(0.15 * k) : 0;
    if (t->form == LINE || t->form == CHAIN || t->form == CAPSULE) {
        const int count = t->form == CHAIN ? 21 : 2;
        for (int i = 0; i < count; ++i) {
            points[i] = in_world(t, WIDE * (2.0 * i / (count - 1) - 1), 0);
        }
        desc = (plumb_shape_desc){ .kind = t->form == LINE    ? PLUMB_SEGMENT
                                           : t->form == CHAIN ? PLUMB_CHAIN
                                                              : PLUMB_CAPSULE,
                                   .points = points,
                                   .count = count,
                                   .radius = t->form == CAPSULE ? R(0.3 * k) : 0,
                                   .one_way = desc.one_way };
    } else if (t->form == OUTLINE) {
        const double corners[][2] = { { -1, 0.2 },   { -1, -0.3 }, { -0.5, -0.2 }, { 0, -0.5 },
                                      { 0.5, -0.2 }, { 1, -0.4 },  { 1, 0.2 } };
        for (int i = 0; i < 7; ++i) {
            points[i] = in_world(t, WIDE * corners[i][0], k * corners[i][1]);
        }
        desc = (plumb_shape_desc){
            .kind = PLUMB_OUTLINE, .points = points, .count = 7, .one_way = desc.one_way
        };
    }
    const int tiles = t->form == TILES ? 40 : 1;
    for (int i = 0; i < tiles; ++i) {
        if (tiles > 1) {
            desc.half = plumb_v2(R(WIDE / tiles), R(0.25 * k));
            desc.center = in_world(t, WIDE * ((2 * i + 1.0) / tiles - 1), 0);
        }
        assert_false(plumb_is_null(plumb_shape_create(world, body, &desc)));
    }
    return body;
}

static plumb_body add_body(plumb_world *world, const trip *t)
{
    plumb_body body =
        plumb_body_create(world, &(plumb_body_desc){ .position = in_world(t, t->x, t->y),
                                                     .velocity = in_world(t, t->vx, t->vy),
                                                     .angle = R(t->angle),
                                                     .angular_velocity = R(t->spin),
                                                     .continuous = t->continuous });
    const double e = t->size / 2;
    plumb_vec2 points[6] = { plumb_v2(0, R(-e)), plumb_v2(0, R(e)) };
    for (int i = 0; t->kind == HEXAGON && i < 6; ++i) {
        points[i] = plumb_v2(R(e * cos(i * SIM_PI / 3)), R(e * sin(i * SIM_PI / 3)));
    }
    const plumb_shape_desc shapes[KINDS] = {
        { .kind = PLUMB_CIRCLE, .radius = R(e) },
        { .kind = PLUMB_BOX, .half = { R(e), R(0.6 * e) } },
        { .kind = PLUMB_CAPSULE, .points = points, .count = 2, .radius = R(0.4 * e) },
        { .kind = PLUMB_POLYGON, .points = points, .count = 6 },
        { .kind = PLUMB_BOX, .half = { R(e), R(0.3 * e) } },
    };
    assert_false(plumb_is_null(plumb_shape_create(world, body, &shapes[t->kind])));
    if (t->kind == COMPOUND) {
        const plumb_shape_desc ball = { .kind = PLUMB_CIRCLE,
                                        .radius = R(0.5 * e),
                                        .center = { R(0.7 * e), R(0.5 * e) } };
        assert_false(plumb_is_null(plumb_shape_create(world, body, &ball)));
    }
    return body;
}

// Of its shapes. [m]
static double lowest_of(plumb_world *world, plumb_body body, const trip *t)
{
    plumb_shape shapes[2];
    const int count = plumb_body_shapes(world, body, shapes, 2);
    double lowest = HUGE_VAL;
    for (int i = 0; i < count; ++i) {
        plumb_convex piece;
        assert_int_equal(plumb_shape_piece(world, shapes[i], 0, &piece, NULL), PLUMB_OK);
        for (int k = 0; k < piece.count; ++k) {
            plumb_vec2 at = plumb_body_world_point(world, body, piece.points[k]);
            lowest = fmin(lowest, up_of(t, at) - (double)piece.radius);
        }
    }
    return lowest;
}

static trip random_trip(int i)
{
    seed = (uint32_t)i * 2654435761u + 1;
    const double angle = below(2) ? uniform(-SIM_PI, SIM_PI) : 0;
    trip t = { .c = cos(angle), .s = sin(angle), .mirror = below(2) ? 1 : -1 };
    t.form = (form)below(FORMS), t.kind = (kind)below(KINDS);
    t.height = below(3) ? 1 : spread(0.4, 4);
    const double k = t.height;
    t.top = k * tops[t.form];
    t.under = t.form == OUTLINE ? -0.5 * k : -t.top;
    t.size = below(3) ? 1 : spread(0.3, 4);
    t.dt = below(2) ? 1.0 / 60 : spread(1.0 / 240, 1.0 / 25);
    t.varies = below(5) == 0, t.continuous = below(4) == 0;
    t.angle = uniform(-3, 3), t.spin = below(2) ? uniform(-15, 15) : 0;
    t.x = uniform(-8, 8), t.vx = below(2) ? uniform(-6, 6) : 0;
    if (below(3) == 0) {
        t.px = below(2) ? uniform(-5, 5) : 0, t.py = uniform(-6, 6);
    }
    t.from_below = below(2);
    const double far = spread(0.2, 15), thick = t.top - t.under + t.size;
    if (t.from_below) { // as high as to the middle, above, or far above
        t.y = t.under - 0.75 * t.size - far;
        t.vy = t.py +
               (below(4) == 0 ? spread(5, 200) : sqrt(2 * SIM_G * (far + uniform(0, 1.5) * thick)));
    } else {
        t.y = t.top + 0.75 * t.size + far;
        t.vy = t.py - (below(4) == 0 ? spread(5, 200) : uniform(-4, 4));
    }
    t.desc = (plumb_world_desc){ .gravity = in_world(&t, 0, -SIM_G),
                                 .solver = (plumb_solver)(below(2) ? 0 : below(3)),
                                 .substeps = below(2) ? 0 : 1 + below(8) };
    return t;
}

static void run_trip(int number)
{
    const trip t = random_trip(number);
    plumb_world *world = NULL, *other = NULL;
    assert_int_equal(plumb_world_create(&t.desc, &world), PLUMB_OK);
    assert_int_equal(plumb_world_create(&t.desc, &other), PLUMB_OK);
    plumb_body plate = add_platform(world, &t, true);
    if (!t.from_below) {
        add_platform(other, &t, false);
    }
    const plumb_body body = add_body(world, &t), twin = add_body(other, &t);
    double time = 0;
    for (int i = 0; i < (int)(3 / t.dt); ++i) {
        const double dt = t.varies ? t.dt * uniform(0.3, 1.2) : t.dt;
        assert_int_equal(plumb_world_step(world, R(dt)), PLUMB_OK);
        assert_int_equal(plumb_world_step(other, R(dt)), PLUMB_OK);
        time += dt;
        const plumb_vec2 at = plumb_body_position(world, body);
        const plumb_vec2 free = plumb_body_position(other, twin);
        const plumb_vec2 base = plumb_body_position(world, plate);
        const double top = t.top + up_of(&t, base);
        if (fabs(along_of(&t, free) - along_of(&t, base)) > 0.6 * WIDE) {
            break;
        }
        const double its = lowest_of(world, body, &t), twins = lowest_of(other, twin, &t);
        int begun;
        plumb_world_begin_events(world, &begun);
        if (t.from_below && twins > top - BAND) {
            break; // it is out
        }
        const double off = (double)plumb_vec2_distance(at, free);
        if (t.from_below && (begun > 0 || off > 1e-4 * (1 + fabs(t.y) + fabs(t.vy) * time))) {
            fail_msg("trip %d: hindered on its way through at %.3f s, off by %.3g m", number, time,
                     off);
        }
        if (!t.from_below && its < top - t.size / 2 && twins > top - t.size / 2) {
            fail_msg("trip %d: fell through at %.3f s: %.3f m, on a solid one %.3f", number, time,
                     its - top, twins - top);
        }
    }
    plumb_world_destroy(world);
    plumb_world_destroy(other);
}

static void from_below_and_above(void **state)
{
    (void)state;
    for (int i = 1; i <= TRIPS; ++i) {
        run_trip(i);
    }
}

//---- asleep ------------------------------------------------------------------------------------------

// A heavy load on soft contacts presses a box deep into a platform. Asleep and awake again, it stays there.
static void pressed_asleep(void **state)
{
    (void)state;
    int deep = 0;
    for (int i = 1; i <= 60; ++i) {
        trip t = { .c = 1, .mirror = 1, .form = (form)(i % FORMS), .kind = BRICK };
        seed = (uint32_t)i * 2654435761u + 1;
        t.height = t.size = 1, t.y = tops[t.form] + 0.35;
        t.desc = (plumb_world_desc){ .no_exact_islands = true,
                                     .no_fine_islands = true,
                                     .contact_hertz = R(uniform(3, 10)) };
        plumb_world *world = NULL;
        assert_int_equal(plumb_world_create(&t.desc, &world), PLUMB_OK);
        add_platform(world, &t, true);
        const plumb_body low = add_body(world, &t);
        t.y += 0.6;
        const plumb_body load = add_body(world, &t);
        assert_int_equal(plumb_body_set_mass(world, load, R(spread(1e3, 2e5))), PLUMB_OK);
        sim_run(world, 400, 1.0 / 60);
        const double y = sim_y(world, low);
        const bool asleep = plumb_world_bodies(world).asleep_count > 0;
        deep += asleep && y < tops[t.form] + 0.3 - 0.025;
        assert_int_equal(plumb_body_wake(world, low), PLUMB_OK);
        sim_run(world, 60, 1.0 / 60);
        if (asleep && sim_y(world, low) < y - 0.3) {
            fail_msg("load %d: woken, it falls from %.3f to %.3f", i, y, sim_y(world, low));
        }
        plumb_world_destroy(world);
    }
    assert_true(deep > 10);
}

//---- characters --------------------------------------------------------------------------------------

static plumb_body add_character(plumb_world *world, bool dynamic, double x, double y)
{
    const plumb_vec2 ends[2] = { { 0, R(-0.3) }, { 0, R(0.3) } };
    plumb_body body = plumb_body_create(
        world, &(plumb_body_desc){ .type = dynamic ? PLUMB_DYNAMIC : PLUMB_KINEMATIC,
                                   .position = { R(x), R(y) } });
    const plumb_shape_desc pill = {
        .kind = PLUMB_CAPSULE, .points = ends, .count = 2, .radius = R(0.35)
    };
    assert_false(plumb_is_null(plumb_shape_create(world, body, &pill)));
    const plumb_character_desc desc = { .no_air_control = true };
    assert_int_equal(plumb_character_create(world, body, &desc), PLUMB_OK);
    return body;
}

// The highest point of its way lies within the platform: it comes back as if that were not there.
static void characters_half_through(void **state)
{
    (void)state;
    for (int i = 1; i <= 300; ++i) {
        trip t = { .c = 1, .mirror = 1, .form = (form)(i % FORMS), .height = 1 };
        seed = (uint32_t)i * 2654435761u + 1;
        const double short_by = uniform(BAND, 1), vx = uniform(-6, 6), start = tops[t.form] - 4;
        plumb_world *worlds[2];
        plumb_body body[2];
        for (int k = 0; k < 2; ++k) {
            assert_int_equal(plumb_world_create(&t.desc, &worlds[k]), PLUMB_OK);
            if (k == 0) {
                add_platform(worlds[k], &t, true);
            }
            body[k] = add_character(worlds[k], i % 3 == 0, 0, start);
            const double v = sqrt(2 * SIM_G * (4 + 0.65 - short_by));
            plumb_character_set_velocity(worlds[k], body[k], plumb_v2(R(vx), R(v)));
        }
        for (int step = 0; step < 100; ++step) {
            sim_run(worlds[0], 1, 1.0 / 60);
            sim_run(worlds[1], 1, 1.0 / 60);
            const plumb_vec2 a = plumb_body_position(worlds[0], body[0]);
            const plumb_vec2 b = plumb_body_position(worlds[1], body[1]);
            if ((double)plumb_vec2_distance(a, b) > 5e-4) {
                fail_msg("character %d: hindered, %.4f m", i, (double)plumb_vec2_distance(a, b));
            }
        }
        plumb_world_destroy(worlds[0]);
        plumb_world_destroy(worlds[1]);
    }
}

static void characters_drop_through_rows(void **state)
{
    (void)state;
    for (int i = 1; i <= 120; ++i) {
        const trip t = { .c = 1, .mirror = 1, .form = i % 2 ? TILES : CHAIN, .height = 1 };
        seed = (uint32_t)i * 2654435761u + 1;
        plumb_world *world = NULL;
        assert_int_equal(plumb_world_create(&t.desc, &world), PLUMB_OK);
        add_platform(world, &t, true);
        plumb_body body = add_character(world, i % 3 == 0, uniform(-2, 2), 1);
        sim_run(world, 30, 1.0 / 60);
        const double standing = t.form == TILES ? 0.9 : 0.65;
        if (!(fabs(sim_y(world, body) - standing) < 0.02)) {
            fail_msg("character %d stands at %.3f", i, sim_y(world, body));
        }
        plumb_character_walk(world, body, R(uniform(-1.5, 1.5)));
        assert_true(plumb_character_drop(world, body));
        sim_run(world, 60, 1.0 / 60);
        if (!(sim_y(world, body) < -2)) {
            fail_msg("character %d does not drop: it is at %.3f", i, sim_y(world, body));
        }
        plumb_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(from_below_and_above),
        cmocka_unit_test(pressed_asleep),
        cmocka_unit_test(characters_half_through),
        cmocka_unit_test(characters_drop_through_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
