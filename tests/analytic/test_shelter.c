// test_shelter.c - what stands behind what in a wind: walls, halves, the same from all sides, wakes, random scenes against many
// lines along the flow.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define R(x) ((plumb_real)(x))

#define SPEED    8.0
#define PRESSURE (0.5 * 1.2 * 2 * SPEED * SPEED) // [N/m] of a surface across the flow
#define DT       1e-3

// A wind of a direction over all of a scene.
static plumb_world *make_wind(double angle, double shelter, double wake)
{
    plumb_world *w = sim_space();
    const plumb_material air =
        plumb_material_create(w, &(plumb_material_desc){ .fluid = true,
                                                         .weightless = true,
                                                         .density = R(1.2),
                                                         .drag = 2,
                                                         .no_skin_drag = true,
                                                         .flow_x = R(SPEED * cos(angle)),
                                                         .flow_y = R(SPEED * sin(angle)),
                                                         .shelter = R(shelter),
                                                         .wake = R(wake) });
    assert_false(plumb_is_null(air));
    const plumb_body holder = sim_body(w, PLUMB_STATIC, 0, 0, 0);
    assert_false(plumb_is_null(plumb_shape_create(
        w, holder,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 100, 100 }, .sensor = true, .material = air })));
    return w;
}

static plumb_body add_box(plumb_world *w, plumb_body_type type, double x, double y, double angle,
                          double hx, double hy)
{
    const plumb_body b = sim_body(w, type, x, y, angle);
    sim_add_box(w, b, hx, hy, sim_material(w, 0, 0));
    return b;
}

typedef struct push {
    double x, y, turn; // [N], [N m]
} push;

#define MASS 1e9 // [kg] what gives way feels less

// What the wind does to a body at rest.
static push push_on(plumb_world *w, plumb_body b)
{
    plumb_body_set_mass(w, b, R(MASS));
    sim_step(w, DT);
    const plumb_vec2 v = plumb_body_velocity(w, b);
    const double inertia = (double)plumb_body_inertia(w, b);
    return (push){ (double)v.x * MASS / DT, (double)v.y * MASS / DT,
                   (double)plumb_body_angular_velocity(w, b) * inertia / DT };
}

//---- walls ---------------------------------------------------------------------------------------

static void a_crate_behind_a_wall_feels_nothing(void **state)
{
    (void)state;
    const double heights[] = { 0, 1, 0.5, 0.25 }; // of the wall, from below
    for (int i = 0; i < 4; ++i) {
        plumb_world *w = make_wind(0, 1, 0);
        const plumb_body b = add_box(w, PLUMB_DYNAMIC, 0, 0.5, 0, 0.5, 0.5);
        if (heights[i] > 0) {
            add_box(w, PLUMB_STATIC, -0.75, heights[i] / 2, 0, 0.25, heights[i] / 2);
        }
        const push p = push_on(w, b);
        const double left = 1 - heights[i];
        assert_near(p.x / PRESSURE, left, ROUNDED(1e-5) + 1e-9);
        assert_near(p.turn / PRESSURE, -left * (1 - left) / 2, ROUNDED(2e-5) + 1e-9);
        plumb_world_destroy(w);
    }
}

// Who keeps the wind off: static, kinematic and sleeping bodies, another part of the same body; not what lies behind, nor
// sensors, nor what does not meet the wind, nor anybody where the wind has no shelter.
static void who_shelters(void **state)
{
    (void)state;
    for (int k = 0; k < 8; ++k) {
        plumb_world *w = make_wind(0, k == 7 ? 0 : 1, 0);
        const plumb_body b = add_box(w, PLUMB_DYNAMIC, 0, 0, 0, 0.5, 0.5);
        const double x = k == 4 ? 2 : -3;
        if (k == 3) {
            plumb_shape_create(w, b,
                               &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                    .half = { R(0.1), 1 },
                                                    .center = { R(x), 0 },
                                                    .material = sim_material(w, 0, 0) });
        } else {
            const plumb_body wall = sim_body(w,
                                             k == 1   ? PLUMB_KINEMATIC
                                             : k == 2 ? PLUMB_DYNAMIC
                                                      : PLUMB_STATIC,
                                             x, 0, 0);
            plumb_shape_create(w, wall,
                               &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                    .half = { R(0.1), 1 },
                                                    .sensor = k == 5,
                                                    .filter = { .nothing = k == 6 },
                                                    .material = sim_material(w, 0, 0) });
            if (k == 2) {
                plumb_body_sleep(w, wall);
            }
        }
        const double found = push_on(w, b).x / PRESSURE;
        assert_near(found,
                    k < 3    ? 0
                    : k == 3 ? 2
                             : 1,
                    1e-4); // k 3: the wall is a part of it, and catches for both
        plumb_world_destroy(w);
    }
}

// The same scene turned, and mirrored: the same forces, turned and mirrored.
static void all_sides_are_alike(void **state)
{
    (void)state;
    double first[3] = { 0, 0, 0 };
    for (int k = 0; k < 24; ++k) {
        const double angle = 0.3 + 0.5236 * (k % 12), c = cos(angle), s = sin(angle);
        const double side = k < 12 ? 1 : -1;
        plumb_world *w = make_wind(angle, 0.8, 0.05);
        const plumb_body b = add_box(w, PLUMB_DYNAMIC, 0, 0, angle + side * 0.2, 0.5, 0.4);
        for (int i = 0; i < 3; ++i) {
            const double x = -1.6 - i, y = side * (0.35 - 0.3 * i);
            add_box(w, PLUMB_STATIC, c * x - s * y, s * x + c * y, angle + side * (0.4 * i), 0.2,
                    0.15);
        }
        const push p = push_on(w, b);
        const double found[3] = { c * p.x + s * p.y, side * (c * p.y - s * p.x), side * p.turn };
        for (int i = 0; i < 3; ++i) {
            first[i] = k == 0 ? found[i] : first[i];
            assert_near(found[i] / PRESSURE, first[i] / PRESSURE, ROUNDED(2e-5));
        }
        plumb_world_destroy(w);
    }
    print_message("%.4f %.4f %.4f of the pressure\n", first[0] / PRESSURE, first[1] / PRESSURE,
                  first[2] / PRESSURE);
}

// Jensen: behind a wall 2 r high the flow lacks (r / (r + wake x))^2.
static void wakes_recover(void **state)
{
    (void)state;
    for (double x = 0; x < 60; x = 2 * x + 0.5) {
        plumb_world *w = make_wind(0, 0.7, 0.1);
        const plumb_body b = add_box(w, PLUMB_DYNAMIC, x + 0.5, 0, 0, 0.5, 0.5);
        add_box(w, PLUMB_STATIC, -0.1, 0, 0, 0.1, 2);
        add_box(w, PLUMB_STATIC, -9, 0, 0, 0.1, 0.1); // farther off, and small: it adds nothing
        const double share = 0.7 * pow(2 / (2 + 0.1 * x), 2);
        assert_near(push_on(w, b).x / PRESSURE, pow(1 - share, 2), ROUNDED(2e-5) + 1e-11);
        plumb_world_destroy(w);
    }
}

//---- many ----------------------------------------------------------------------------------------

typedef struct thing {
    double x, y, angle, hx, hy, radius; // radius > 0: a disc
} thing;

// Where the line at `t` across the flow along +x meets it first, and the normal there. False: nowhere.
static bool front_of(const thing *a, double t, double *at, double n[2])
{
    if (a->radius > 0) {
        const double d = t - a->y, root = a->radius * a->radius - d * d;
        if (root <= 0) {
            return false;
        }
        *at = a->x - sqrt(root);
        n[0] = -sqrt(root) / a->radius;
        n[1] = d / a->radius;
        return true;
    }
    // In the box's frame the line is p + s d: it enters by the last of the slabs that it enters.
    const double c = cos(a->angle), s = sin(a->angle), dy = t - a->y;
    const double p[2] = { s * dy - c * a->x, c * dy + s * a->x }, d[2] = { c, -s };
    const double half[2] = { a->hx, a->hy };
    double from = -INFINITY, to = INFINITY, normal[2] = { 0, 0 };
    for (int i = 0; i < 2; ++i) {
        const double u = (-half[i] - p[i]) / d[i], v = (half[i] - p[i]) / d[i];
        if (fmin(u, v) > from) {
            from = fmin(u, v);
            normal[0] = i == 0 ? (d[0] > 0 ? -1 : 1) : 0;
            normal[1] = i == 1 ? (d[1] > 0 ? -1 : 1) : 0;
        }
        to = fmin(to, fmax(u, v));
    }
    *at = from;
    n[0] = c * normal[0] - s * normal[1];
    n[1] = s * normal[0] + c * normal[1];
    return from < to;
}

static push sampled(const thing *all, int count, int who)
{
    push sum = { 0, 0, 0 };
    const thing *a = &all[who];
    const double size = hypot(a->hx, a->hy) + a->radius, step = size / 10000;
    for (double t = a->y - size + step / 2; t < a->y + size; t += step) {
        double at, n[2], other, unused[2];
        bool seen = front_of(a, t, &at, n);
        for (int k = 0; k < count && seen; ++k) {
            seen = k == who || !front_of(&all[k], t, &other, unused) || other > at;
        }
        if (seen) {
            const double p = PRESSURE * fabs(n[0]) * step;
            sum.x -= p * n[0];
            sum.y -= p * n[1];
            sum.turn -= p * ((at - a->x) * n[1] - (t - a->y) * n[0]);
        }
    }
    return sum;
}

static bool is_free(const thing *all, int count, const thing *a)
{
    for (int k = 0; k < count; ++k) {
        const double size =
            hypot(a->hx, a->hy) + a->radius + hypot(all[k].hx, all[k].hy) + all[k].radius;
        if (hypot(a->x - all[k].x, a->y - all[k].y) < size) {
            return false;
        }
    }
    return true;
}

// Twelve bodies anywhere in a wind, all dynamic but some: the force and torque of each.
static void sums_are_those_of_many_lines(void **state)
{
    (void)state;
    uint32_t seed = 5;
    double worst = 0;
    int sheltered = 0;
    for (int scene = 0; scene < 6; ++scene) {
        thing all[12];
        plumb_body bodies[12];
        plumb_world *w = make_wind(0, 1, 0);
        for (int i = 0; i < 12;) {
            const bool round = sim_uniform(&seed, 0, 1) < 0.4;
            const thing a = { .x = sim_uniform(&seed, -6, 6),
                              .y = sim_uniform(&seed, -2, 2),
                              .angle = sim_uniform(&seed, 0.01, 1.5),
                              .hx = round ? 0 : sim_uniform(&seed, 0.1, 0.6),
                              .hy = round ? 0 : sim_uniform(&seed, 0.1, 0.6),
                              .radius = round ? sim_uniform(&seed, 0.1, 0.5) : 0 };
            if (!is_free(all, i, &a)) {
                continue;
            }
            bodies[i] = sim_body(w, i % 4 == 3 ? PLUMB_STATIC : PLUMB_DYNAMIC, a.x, a.y, a.angle);
            if (round) {
                sim_add_circle(w, bodies[i], a.radius, sim_material(w, 0, 0));
            } else {
                sim_add_box(w, bodies[i], a.hx, a.hy, sim_material(w, 0, 0));
            }
            if (i % 4 != 3) {
                plumb_body_set_mass(w, bodies[i], 10000);
            }
            all[i++] = a;
        }
        sim_step(w, DT);
        for (int i = 0; i < 12; ++i) {
            if (i % 4 == 3) {
                continue;
            }
            const push wanted = sampled(all, 12, i);
            const plumb_vec2 v = plumb_body_velocity(w, bodies[i]);
            const double turn = (double)plumb_body_angular_velocity(w, bodies[i]) *
                                (double)plumb_body_inertia(w, bodies[i]) / DT;
            const double off[3] = { (double)v.x * 10000 / DT - wanted.x,
                                    (double)v.y * 10000 / DT - wanted.y, turn - wanted.turn };
            for (int k = 0; k < 3; ++k) {
                worst = fmax(worst, fabs(off[k]) / PRESSURE);
                assert_near(off[k] / PRESSURE, 0, 2e-3);
            }
            sheltered += fabs(wanted.x) < 0.02 * PRESSURE;
        }
        plumb_world_destroy(w);
    }
    print_message("worst off by %.2g of the pressure a metre; %d all but hidden\n", worst,
                  sheltered);
    assert_true(sheltered > 3);
}

// A row of crates that nearly touch, seen along it: each step is quick, however many there are.
static void long_rows(void **state)
{
    (void)state;
    plumb_world *w = make_wind(0, 1, R(0.1));
    plumb_body bodies[400];
    for (int i = 0; i < 400; ++i) {
        bodies[i] = add_box(w, PLUMB_DYNAMIC, -90 + 0.45 * i, 0.001 * (i % 7), 0, 0.2, 0.2);
        plumb_body_set_mass(w, bodies[i], 10000);
    }
    sim_run(w, 3, DT);
    assert_true(plumb_body_velocity(w, bodies[0]).x > 50 * plumb_body_velocity(w, bodies[399]).x);
    assert_true(plumb_body_velocity(w, bodies[399]).x >= 0);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_crate_behind_a_wall_feels_nothing),
        cmocka_unit_test(who_shelters),
        cmocka_unit_test(all_sides_are_alike),
        cmocka_unit_test(wakes_recover),
        cmocka_unit_test(sums_are_those_of_many_lines),
        cmocka_unit_test(long_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
