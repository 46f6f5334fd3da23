// test_wrap.c - worlds that wrap around: a scene that lies across an edge does what the same scene does in
// the middle of the period: to the last bit while all coordinates have the same spacing of reals in both
// (what hovers at the edge itself, where the spacing doubles, differs by a rounding), else within rounding.
#include "harness/near.h"
#include "harness/random.h"
#include "plumb/math.h"
#include "plumb/plumb.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))

static const plumb_real dt = R(1.0 / 60);

// A power of two. Between a quarter of it and the edge all coordinates have one spacing, on both sides: what lies
// about 3/8 is by 1/8 farther at the edge, bit for bit the same.
#define PERIOD R(64)
#define INSIDE R(24) // 3/8 of the period
#define EDGE   R(32)
#define MOST   64

typedef struct scene {
    plumb_world *w;
    plumb_vec2 at; // all places are told from here
    plumb_body bodies[MOST];
    int count;
} scene;

static plumb_vec2 from(const scene *s, double x, double y)
{
    return plumb_v2(s->at.x + R(x), s->at.y + R(y));
}

static plumb_body add(scene *s, plumb_body_type type, double x, double y,
                      const plumb_shape_desc *shape)
{
    plumb_body body =
        plumb_body_create(s->w, &(plumb_body_desc){ .type = type, .position = from(s, x, y) });
    assert_false(plumb_is_null(body));
    assert_false(plumb_is_null(plumb_shape_create(s->w, body, shape)));
    assert_true(s->count < MOST);
    s->bodies[s->count++] = body;
    return body;
}

static plumb_body box(scene *s, plumb_body_type type, double x, double y, double hx, double hy)
{
    return add(s, type, x, y, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(hx), R(hy) } });
}

static plumb_body disc(scene *s, plumb_body_type type, double x, double y, double radius)
{
    return add(s, type, x, y, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(radius) });
}

static plumb_body rod(scene *s, double x, double y, double half)
{
    const plumb_vec2 ends[2] = { { R(-half), 0 }, { R(half), 0 } };
    return add(s, PLUMB_DYNAMIC, x, y,
               &(plumb_shape_desc){
                   .kind = PLUMB_CAPSULE, .points = ends, .count = 2, .radius = R(0.125) });
}

static void ground(scene *s)
{
    for (int i = -2; i <= 2; ++i) {
        box(s, PLUMB_STATIC, 4.0 * i, -1, 2, 1);
    }
}

//---- scenes --------------------------------------------------------------------------------------

static void make_stack(scene *s)
{
    ground(s);
    for (int i = 0; i < 8; ++i) {
        box(s, PLUMB_DYNAMIC, 0.1875 + 0.0625 * (i % 2), 0.5 + i, 0.5, 0.5);
    }
    for (int i = 0; i < 4; ++i) {
        disc(s, PLUMB_DYNAMIC, -3.5 + 0.03125 * i, 0.5 + i, 0.5);
    }
}

static void make_heap(scene *s)
{
    const plumb_vec2 kite[] = { { -1, 0 }, { 0, R(-0.5) }, { 1, 0 }, { 0, R(0.5) } };
    ground(s);
    box(s, PLUMB_STATIC, -6, 3, 0.5, 3);
    box(s, PLUMB_STATIC, 6, 3, 0.5, 3);
    for (int i = 0; i < 24; ++i) {
        double x = -1.75 + (i % 3) * 2 + 0.25 * (i % 2), y = 1 + 1.5 * (i / 3);
        if (i % 4 == 0) {
            add(s, PLUMB_DYNAMIC, x, y,
                &(plumb_shape_desc){ .kind = PLUMB_POLYGON, .points = kite, .count = 4 });
        } else if (i % 4 == 1) {
            rod(s, x, y, 0.5);
        } else if (i % 4 == 2) {
            disc(s, PLUMB_DYNAMIC, x, y, 0.5);
        } else {
            box(s, PLUMB_DYNAMIC, x, y, 0.5, 0.375);
        }
    }
}

static plumb_joint tie(scene *s, plumb_joint_kind kind, plumb_body a, plumb_body b, double x,
                       double y)
{
    plumb_joint joint = plumb_joint_create(
        s->w,
        &(plumb_joint_desc){ .kind = kind, .body_a = a, .body_b = b, .anchor = from(s, x, y) });
    assert_false(plumb_is_null(joint));
    return joint;
}

static void make_chain(scene *s)
{
    plumb_body before = PLUMB_NULL_INIT;
    for (int i = 0; i < 10; ++i) {
        plumb_body link = rod(s, -4.5 + i, 6, 0.5);
        if (i > 0) {
            tie(s, PLUMB_REVOLUTE, before, link, -5.0 + i, 6);
        }
        before = link;
    }
    tie(s, PLUMB_REVOLUTE, (plumb_body)PLUMB_NULL_INIT, s->bodies[0], -5, 6);
    tie(s, PLUMB_REVOLUTE, (plumb_body)PLUMB_NULL_INIT, before, 5, 6);
    plumb_body a = box(s, PLUMB_DYNAMIC, -1, 2, 0.5, 0.5),
               b = box(s, PLUMB_DYNAMIC, 2, 2, 0.5, 0.5);
    tie(s, PLUMB_REVOLUTE, (plumb_body)PLUMB_NULL_INIT, a, -1, 2);
    plumb_joint_create(s->w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                  .body_a = a,
                                                  .body_b = b,
                                                  .anchor = from(s, -1, 2),
                                                  .anchor_b = from(s, 2, 2) });
    plumb_body c = box(s, PLUMB_DYNAMIC, 0, -2, 0.5, 0.25);
    plumb_joint_create(s->w, &(plumb_joint_desc){ .kind = PLUMB_PRISMATIC,
                                                  .body_b = c,
                                                  .anchor = from(s, 0, -2),
                                                  .axis = { 1, 0 },
                                                  .enable_motor = true,
                                                  .motor_speed = 2,
                                                  .max_motor = 1000,
                                                  .enable_limit = true,
                                                  .lower = -2,
                                                  .upper = 2 });
}

static void join(scene *s, plumb_joint_desc desc)
{
    assert_false(plumb_is_null(plumb_joint_create(s->w, &desc)));
}

// The kinds of joints that a chain has not. A pinion turns several times, and with it what lies far from its centre. The pulley's
// rope is not used up: of length 0 it has no direction but by rounding.
static void make_machines(scene *s)
{
    const plumb_body none = PLUMB_NULL_INIT;
    plumb_body pinion = disc(s, PLUMB_DYNAMIC, 0, 0, 0.5), cog = disc(s, PLUMB_DYNAMIC, 2, 0, 1);
    plumb_body rack = box(s, PLUMB_DYNAMIC, 4, 1, 0.25, 1), arm = rod(s, -3, 1, 1);
    plumb_body heavy = box(s, PLUMB_DYNAMIC, -6, -2, 0.5, R(0.265));
    plumb_body light = box(s, PLUMB_DYNAMIC, -8, 2, 0.5, 0.25);
    plumb_body drawn = box(s, PLUMB_DYNAMIC, 6, 3, 0.5, 0.5);
    plumb_body driven = box(s, PLUMB_DYNAMIC, 7, -1, 0.5, 0.5);
    plumb_body hub = disc(s, PLUMB_DYNAMIC, 0, 4, 0.5);
    join(s, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                .body_b = pinion,
                                .anchor = from(s, 0, 0),
                                .enable_motor = true,
                                .motor_speed = 6,
                                .max_motor = 200 });
    tie(s, PLUMB_REVOLUTE, none, cog, 2, 0);
    join(s,
         (plumb_joint_desc){
             .kind = PLUMB_PRISMATIC, .body_b = rack, .anchor = from(s, 4, 1), .axis = { 0, 1 } });
    join(s, (plumb_joint_desc){ .kind = PLUMB_GEAR, .body_a = pinion, .body_b = cog, .ratio = 2 });
    join(s, (plumb_joint_desc){
                .kind = PLUMB_GEAR, .body_a = cog, .body_b = rack, .axis = { 0, 1 }, .ratio = 4 });
    tie(s, PLUMB_REVOLUTE, none, arm, -4, 1);
    join(s, (plumb_joint_desc){
                .kind = PLUMB_RATCHET, .body_b = arm, .anchor = from(s, -4, 1), .pitch = R(0.25) });
    join(s, (plumb_joint_desc){ .kind = PLUMB_PULLEY,
                                .body_a = heavy,
                                .body_b = light,
                                .anchor = from(s, -6, -2),
                                .anchor_b = from(s, -8, 2),
                                .ground_a = from(s, -6, 6),
                                .ground_b = from(s, -8, 6) });
    join(s, (plumb_joint_desc){
                .kind = PLUMB_MOUSE, .body_b = drawn, .anchor = from(s, 6, 3), .max_force = 20 });
    join(s, (plumb_joint_desc){ .kind = PLUMB_MOTOR,
                                .body_b = driven,
                                .anchor = from(s, 7, -1),
                                .rest = 1,
                                .hertz = 2,
                                .max_force = 40 });
    join(s, (plumb_joint_desc){ .kind = PLUMB_WHEEL,
                                .body_b = hub,
                                .anchor = from(s, 0, 4),
                                .hertz = 1,
                                .damping = R(0.25) });
    join(s, (plumb_joint_desc){
                .kind = PLUMB_FRICTION, .body_b = hub, .anchor = from(s, 0, 4), .max_force = 1 });
}

static void make_roll(scene *s)
{
    ground(s);
    plumb_body body = disc(s, PLUMB_DYNAMIC, -7, 0.5, 0.5);
    plumb_body_set_velocity(s->w, body, plumb_v2(8, 0));
    plumb_body_set_angular_velocity(s->w, body, -16);
}

static void make_bullets(scene *s)
{
    box(s, PLUMB_STATIC, 0.5, 0, 0.03125, 4);
    box(s, PLUMB_KINEMATIC, -1, 6, 0.03125, 1);
    for (int i = 0; i < 8; ++i) {
        plumb_body body = disc(s, PLUMB_DYNAMIC, -6 + 0.5 * i, -3 + 0.75 * i, 0.0625);
        plumb_body_set_velocity(s->w, body, plumb_v2(400, R(3.0 * i)));
    }
    plumb_body spin = rod(s, 2, -1, 1);
    plumb_body_set_velocity(s->w, spin, plumb_v2(-200, 0));
    plumb_body_set_angular_velocity(s->w, spin, 100);
    plumb_body a = disc(s, PLUMB_DYNAMIC, -4, 8, 0.125), b = disc(s, PLUMB_DYNAMIC, 4, 8, 0.125);
    plumb_body_set_continuous(s->w, a, true);
    plumb_body_set_velocity(s->w, a, plumb_v2(300, 0));
    plumb_body_set_velocity(s->w, b, plumb_v2(-300, 0));
}

//---- side by side --------------------------------------------------------------------------------

typedef void make_fn(scene *s);

static void open_at(scene *s, const plumb_world_desc *desc, plumb_vec2 at, make_fn *make)
{
    *s = (scene){ .at = at };
    assert_int_equal(plumb_world_create(desc, &s->w), PLUMB_OK);
    make(s);
}

// [m] or [-] how far two bodies are from being in the same place, seen from their scenes.
static double apart(const scene *a, const scene *b, int i)
{
    plumb_vec2 way_a = plumb_world_way(a->w, a->at, plumb_body_position(a->w, a->bodies[i]));
    plumb_vec2 way_b = plumb_world_way(b->w, b->at, plumb_body_position(b->w, b->bodies[i]));
    plumb_vec2 va = plumb_body_velocity(a->w, a->bodies[i]);
    plumb_vec2 vb = plumb_body_velocity(b->w, b->bodies[i]);
    plumb_transform ta = plumb_body_transform(a->w, a->bodies[i]);
    plumb_transform tb = plumb_body_transform(b->w, b->bodies[i]);
    return fabs((double)(way_a.x - way_b.x)) + fabs((double)(way_a.y - way_b.y)) +
           fabs((double)(va.x - vb.x)) + fabs((double)(va.y - vb.y)) +
           fabs((double)(ta.q.c - tb.q.c)) + fabs((double)(ta.q.s - tb.q.s));
}

static void assert_in_period(const scene *s, const plumb_world_desc *desc)
{
    plumb_body_span span = plumb_world_bodies(s->w);
    for (int i = 0; i < span.count; ++i) {
        assert_true(!(desc->wrap_x > 0) ||
                    (span.center_x[i] >= -desc->wrap_x / 2 && span.center_x[i] < desc->wrap_x / 2));
        assert_true(!(desc->wrap_y > 0) ||
                    (span.center_y[i] >= -desc->wrap_y / 2 && span.center_y[i] < desc->wrap_y / 2));
    }
}

static void same_at(const plumb_world_desc *desc, plumb_vec2 here, plumb_vec2 there, make_fn *make,
                    int steps, double tolerance)
{
    scene a, b;
    open_at(&a, desc, here, make);
    open_at(&b, desc, there, make);
    for (int step = 0; step < steps; ++step) {
        assert_int_equal(plumb_world_step(a.w, dt), PLUMB_OK);
        assert_int_equal(plumb_world_step(b.w, dt), PLUMB_OK);
        for (int i = 0; i < a.count; ++i) {
            double d = apart(&a, &b, i);
            if (!(d <= tolerance)) {
                fail_msg("step %d, body %d: %g apart", step, i, d);
            }
        }
        assert_in_period(&b, desc);
        plumb_stats sa = plumb_world_stats(a.w), sb = plumb_world_stats(b.w);
        assert_int_equal(sa.contact_count, sb.contact_count);
        assert_int_equal(sa.stopped_count, sb.stopped_count);
        assert_int_equal(sa.asleep_count, sb.asleep_count);
    }
    plumb_world_destroy(a.w);
    plumb_world_destroy(b.w);
}

// The exact claim is that of the float build, which keeps what rounding takes from positions; the double one has
// no wider type to keep it in.
static void across(make_fn *make, int steps, double tolerance)
{
    if (sizeof(plumb_real) > sizeof(float) && !(tolerance > 0)) {
        tolerance = 1e-12;
    }
    for (int solver = 0; solver < 3; ++solver) {
        plumb_world_desc x = { .wrap_x = PERIOD, .solver = (plumb_solver)solver };
        same_at(&x, plumb_v2(INSIDE, 0), plumb_v2(EDGE, 0), make, steps, tolerance);
        plumb_world_desc y = { .wrap_y = PERIOD, .solver = (plumb_solver)solver };
        same_at(&y, plumb_v2(0, INSIDE), plumb_v2(0, -EDGE), make, steps, tolerance);
        plumb_world_desc both = { .wrap_x = PERIOD,
                                  .wrap_y = PERIOD,
                                  .solver = (plumb_solver)solver };
        same_at(&both, plumb_v2(INSIDE, INSIDE), plumb_v2(EDGE, EDGE), make, steps, tolerance);
    }
}

static void stack_across_the_edge(void **state)
{
    (void)state;
    across(make_stack, 240, 0);
}

static void heap_across_the_edge(void **state)
{
    (void)state;
    across(make_heap, 45, 1e-4);
}

static void chain_across_the_edge(void **state)
{
    (void)state;
    across(make_chain, 300, 0);
}

static void machines_across_the_edge(void **state)
{
    (void)state;
    across(make_machines, 300, 1e-3);
}

static void disc_rolls_across_the_edge(void **state)
{
    (void)state;
    across(make_roll, 90, 0);
}

static void bullets_across_the_edge(void **state)
{
    (void)state;
    across(make_bullets, 30, 5e-3);
}

//---- what lies at both sides ---------------------------------------------------------------------

static plumb_world *open_world(plumb_real x, plumb_real y, bool gravity)
{
    plumb_world *w;
    plumb_world_desc desc = { .wrap_x = x, .wrap_y = y, .zero_gravity = !gravity };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

static bool same_place(plumb_vec2 a, plumb_vec2 b)
{
    return a.x == b.x && a.y == b.y;
}

static void step_many(plumb_world *w, int count)
{
    for (int i = 0; i < count; ++i) {
        assert_int_equal(plumb_world_step(w, dt), PLUMB_OK);
    }
}

// An elastic gas without walls: over thousands of crossings momentum and energy stay what they were, and
// nothing passes through anything.
static void gas_keeps_momentum_and_energy(void **state)
{
    (void)state;
    plumb_world *w = open_world(R(12.5), R(9.25), false);
    plumb_material elastic =
        plumb_material_create(w, &(plumb_material_desc){ .frictionless = true, .restitution = 1 });
    uint32_t seed = 5;
    for (int i = 0; i < 60; ++i) {
        double vx = sim_uniform(&seed, -3, 7), vy = sim_uniform(&seed, -6, 4);
        plumb_body body = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(1.2 * (i % 10)), R(1.5 * (i / 10)) },
                                   .velocity = { R(vx), R(vy) } });
        plumb_shape_create(w, body,
                           &(plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                                .radius = R(0.1 + 0.05 * (i % 5)),
                                                .material = elastic });
    }
    plumb_energy before = plumb_world_energy(w);
    for (int step = 0; step < 1200; ++step) {
        step_many(w, 1);
        assert_true(plumb_world_stats(w).max_penetration < R(0.2)); // chance impacts of three
    }
    plumb_energy after = plumb_world_energy(w);
    double speed = sqrt(2 * before.kinetic * before.mass);
    double small = sizeof(plumb_real) == sizeof(float) || PLUMB_IS_FAR ? 1e-4 : 1e-9;
    assert_near(after.momentum_x, before.momentum_x, small * speed);
    assert_near(after.momentum_y, before.momentum_y, small * speed);
    assert_near(after.kinetic / before.kinetic, 1, ROUNDED(1e-3));
    plumb_world_destroy(w);
}

static void island_sleeps_across_the_edge(void **state)
{
    (void)state;
    scene s;
    plumb_world_desc desc = { .wrap_x = PERIOD };
    open_at(&s, &desc, plumb_v2(EDGE, 0), ground);
    for (int i = 0; i < 6; ++i) { // bricks, half of them over the edge
        box(&s, PLUMB_DYNAMIC, -1.875 + 0.75 * i, 0.25, 0.25, 0.25);
    }
    step_many(s.w, 180);
    assert_int_equal(plumb_world_stats(s.w).asleep_count, 6);
    assert_int_equal(plumb_world_stats(s.w).island_count, 6);
    // What falls on one side of the edge wakes what it touches on the other.
    plumb_body wide = box(&s, PLUMB_DYNAMIC, 0, 1.5, 0.75, 0.25);
    step_many(s.w, 30);
    assert_int_equal(plumb_world_stats(s.w).asleep_count, 4);
    assert_true(plumb_body_position(s.w, wide).y > R(0.7));
    step_many(s.w, 180);
    plumb_stats stats = plumb_world_stats(s.w);
    assert_int_equal(stats.asleep_count, 7);
    assert_int_equal(stats.island_count, 5);
    // A whole island that is moved by a period is where it was.
    plumb_vec2 at = plumb_body_position(s.w, wide);
    plumb_body_teleport(s.w, wide, plumb_v2(at.x + 3 * PERIOD, at.y), 0);
    plumb_vec2 moved = plumb_world_way(s.w, at, plumb_body_position(s.w, wide));
    assert_true(plumb_vec2_magnitude(moved) < R(1e-4));
    step_many(s.w, 120);
    assert_int_equal(plumb_world_stats(s.w).asleep_count, 7);
    plumb_world_destroy(s.w);
}

static void sensor_sees_across_the_edge(void **state)
{
    (void)state;
    plumb_world *w = open_world(20, 20, false);
    plumb_body post = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { R(9.5), R(9.5) } });
    plumb_shape_create(w, post,
                       &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 2, .sensor = true });
    plumb_body ball = plumb_body_create(
        w, &(plumb_body_desc){ .position = { R(-7), R(-9) }, .velocity = { -3, 0 } });
    plumb_shape_create(w, ball, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.25) });
    int began = 0, ended = 0;
    for (int i = 0; i < 180; ++i) {
        int count;
        step_many(w, 1);
        plumb_world_sensor_begin_events(w, &count);
        began += count;
        double x = (double)plumb_body_position(w, ball).x;
        if (count > 0) { // on its way, at 2.25 m from the sensor's middle: 1.5 m above it is
            assert_near(x, (-10.5 + sqrt(2.25 * 2.25 - 1.5 * 1.5)), 0.06);
        }
        plumb_world_sensor_end_events(w, &count);
        ended += count;
    }
    assert_int_equal(began, 1);
    assert_int_equal(ended, 1);
    plumb_world_destroy(w);
}

static void blast_reaches_over_the_edge(void **state)
{
    (void)state;
    plumb_world *w = open_world(PERIOD, PERIOD, false);
    plumb_body bodies[4];
    for (int i = 0; i < 4; ++i) {
        plumb_vec2 at = { EDGE + (i % 2 == 0 ? R(-2) : R(2)), EDGE + (i / 2 == 0 ? R(-1) : 1) };
        bodies[i] = plumb_body_create(w, &(plumb_body_desc){ .position = at });
        plumb_shape_create(w, bodies[i],
                           &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
    }
    plumb_explosion_desc blast = { .position = { EDGE, -EDGE }, .radius = 5, .impulse = 3 };
    assert_int_equal(plumb_world_explode(w, &blast), PLUMB_OK);
    plumb_vec2 v = plumb_body_velocity(w, bodies[3]);
    assert_true(v.x > 1 && v.y > R(0.5));
    for (int i = 0; i < 4; ++i) {
        plumb_vec2 other = plumb_body_velocity(w, bodies[i]);
        assert_near(other.x, i % 2 == 0 ? -v.x : v.x, ROUNDED(1e-5));
        assert_near(other.y, i / 2 == 0 ? -v.y : v.y, ROUNDED(1e-5));
    }
    plumb_world_destroy(w);
}

static void goes_the_short_way_to_a_target(void **state)
{
    (void)state;
    plumb_world *w = open_world(20, 0, false);
    plumb_body body =
        plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 9, 0 } });
    assert_int_equal(plumb_body_set_target(w, body, plumb_v2(-9, 1), 0, 1), PLUMB_OK);
    assert_true(plumb_body_velocity(w, body).x == 2);
    step_many(w, 60);
    assert_false(plumb_body_has_target(w, body));
    assert_true(same_place(plumb_body_position(w, body), plumb_v2(-9, 1)));
    plumb_world_destroy(w);
}

static void force_acts_at_the_nearest_image(void **state)
{
    (void)state;
    plumb_world *w = open_world(20, 0, false);
    plumb_body body = plumb_body_create(w, &(plumb_body_desc){ .position = { R(9.5), 0 } });
    plumb_shape_create(w, body, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 1, 1 } });
    assert_int_equal(plumb_body_apply_impulse(w, body, plumb_v2(0, 1), plumb_v2(R(-9.5), 0)),
                     PLUMB_OK);
    double inertia = (double)plumb_body_inertia(w, body);
    assert_near(plumb_body_angular_velocity(w, body), 1 / inertia, ROUNDED(1e-6));
    plumb_vec2 local = plumb_body_local_point(w, body, plumb_v2(R(-9.5), 0));
    assert_true(same_place(local, plumb_v2(1, 0)));
    plumb_world_destroy(w);
}

static void snapshot_keeps_the_period(void **state)
{
    (void)state;
    static unsigned char image[1 << 20];
    scene s;
    plumb_world_desc desc = { .wrap_x = PERIOD };
    open_at(&s, &desc, plumb_v2(EDGE, 0), make_heap);
    step_many(s.w, 60);
    assert_true(plumb_world_snapshot_size(s.w) <= sizeof image);
    assert_int_equal(plumb_world_save(s.w, image, sizeof image), PLUMB_OK);
    plumb_world *other;
    assert_int_equal(plumb_world_create(NULL, &other), PLUMB_OK);
    assert_int_equal(plumb_world_restore(other, image, sizeof image), PLUMB_OK);
    assert_true(plumb_world_settings(other).wrap_x == PERIOD);
    for (int i = 0; i < 120; ++i) {
        assert_true(plumb_world_hash(s.w) == plumb_world_hash(other));
        step_many(s.w, 1);
        step_many(other, 1);
    }
    assert_true(plumb_world_hash(s.w) == plumb_world_hash(other));
    plumb_world_destroy(other);
    plumb_world_destroy(s.w);
}

static void make_walk(scene *s)
{
    const plumb_vec2 slope[3] = { { -1, 0 }, { 1, 0 }, { 1, R(0.5) } };
    ground(s);
    add(s, PLUMB_STATIC, -0.5, 0,
        &(plumb_shape_desc){ .kind = PLUMB_POLYGON, .points = slope, .count = 3 });
    box(s, PLUMB_STATIC, 1.5, 0.25, 1, 0.25);
    plumb_body lift = box(s, PLUMB_KINEMATIC, 3.5, 0.25, 0.9375, 0.25);
    plumb_body_set_velocity(s->w, lift, plumb_v2(0, R(0.5)));
    plumb_body crate = box(s, PLUMB_DYNAMIC, -4, 0.375, 0.375, 0.375);
    plumb_body_set_no_sleep(s->w, crate, true);
    for (int i = 0; i < 2; ++i) {
        plumb_body hero =
            add(s, i == 0 ? PLUMB_KINEMATIC : PLUMB_DYNAMIC, -6.5 + 4 * i, 0.75,
                &(plumb_shape_desc){
                    .kind = PLUMB_BOX, .half = { R(0.25), R(0.5) }, .radius = R(0.125) });
        assert_int_equal(plumb_character_create(s->w, hero, NULL), PLUMB_OK);
        assert_int_equal(plumb_character_walk(s->w, hero, 2), PLUMB_OK);
    }
}

// Kinematic and dynamic characters push a crate, climb, and ride a lift across the edge.
// Until the crate is jammed between one of them and the lift: then rounding decides who slips off the corner.
static void characters_walk_across_the_edge(void **state)
{
    (void)state;
    plumb_world_desc x = { .wrap_x = PERIOD };
    same_at(&x, plumb_v2(INSIDE, 0), plumb_v2(EDGE, 0), make_walk, 160, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stack_across_the_edge),
        cmocka_unit_test(heap_across_the_edge),
        cmocka_unit_test(chain_across_the_edge),
        cmocka_unit_test(machines_across_the_edge),
        cmocka_unit_test(disc_rolls_across_the_edge),
        cmocka_unit_test(bullets_across_the_edge),
        cmocka_unit_test(gas_keeps_momentum_and_energy),
        cmocka_unit_test(island_sleeps_across_the_edge),
        cmocka_unit_test(sensor_sees_across_the_edge),
        cmocka_unit_test(blast_reaches_over_the_edge),
        cmocka_unit_test(goes_the_short_way_to_a_target),
        cmocka_unit_test(force_acts_at_the_nearest_image),
        cmocka_unit_test(snapshot_keeps_the_period),
        cmocka_unit_test(characters_walk_across_the_edge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
