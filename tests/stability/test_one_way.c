// test_one_way.c - one-way platforms: what comes from below passes untouched and can stand on them,
// stacks stand on them as on solid ground, fast bodies, moving and turning platforms, dropping
// through. With both solvers.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "plumb/plumb.h"

#define R(x)    ((plumb_real)(x))
#define V(x, y) plumb_v2(R(x), R(y))
#define DT      R(1.0 / 60)
#define SOLVERS 3

static const plumb_one_way upwards = { { 0, 1 }, 0 };

static plumb_world *make_world(int solver)
{
    plumb_world *world = NULL;
    plumb_world_desc desc = { .solver = (plumb_solver)solver };
    assert_int_equal(plumb_world_create(&desc, &world), PLUMB_OK);
    return world;
}

typedef enum form { BOX, LINE, CHAIN, FORMS } form;

static plumb_shape_desc form_of(form kind)
{
    static const plumb_vec2 points[] = { { -3, 0 }, { -1, 0 }, { 1, 0 }, { 3, 0 } };
    static const plumb_vec2 ends[] = { { -3, 0 }, { 3, 0 } };
    switch (kind) {
    case BOX:
        return (
            plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 3, R(0.1) }, .center = { 0, R(-0.1) } };
    case LINE:
        return (plumb_shape_desc){ .kind = PLUMB_SEGMENT, .points = ends, .count = 2 };
    default:
        return (plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = points, .count = 4 };
    }
}

// A platform whose top is at `at`.
static plumb_body add_platform(plumb_world *world, plumb_body_type type, form kind, plumb_vec2 at,
                               plumb_one_way one_way)
{
    plumb_body body = plumb_body_create(world, &(plumb_body_desc){ .type = type, .position = at });
    plumb_shape_desc desc = form_of(kind);
    desc.one_way = one_way;
    assert_false(plumb_is_null(plumb_shape_create(world, body, &desc)));
    return body;
}

static plumb_body add_box(plumb_world *world, plumb_vec2 at, plumb_vec2 velocity)
{
    plumb_body body =
        plumb_body_create(world, &(plumb_body_desc){ .position = at, .velocity = velocity });
    plumb_shape_desc desc = { .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } };
    assert_false(plumb_is_null(plumb_shape_create(world, body, &desc)));
    return body;
}

static plumb_body add_ball(plumb_world *world, plumb_vec2 at, plumb_vec2 velocity)
{
    plumb_body body =
        plumb_body_create(world, &(plumb_body_desc){ .position = at, .velocity = velocity });
    plumb_shape_desc desc = { .kind = PLUMB_CIRCLE, .radius = R(0.5) };
    assert_false(plumb_is_null(plumb_shape_create(world, body, &desc)));
    return body;
}

static void run(plumb_world *world, double seconds)
{
    for (int i = 0; i < (int)lrint(seconds * 60); ++i) {
        assert_int_equal(plumb_world_step(world, DT), PLUMB_OK);
    }
}

static double y_of(plumb_world *world, plumb_body body)
{
    return (double)plumb_body_position(world, body).y;
}

static void assert_free(plumb_world *world, plumb_body body, double v0, double y0, double t)
{
    double y = y0 + v0 * t - 9.81 / 2 * t * t;
    plumb_vec2 p = plumb_body_position(world, body);
    assert_true(fabs((double)p.y - y) < 1e-4 && fabs((double)p.x) < 1e-6);
    assert_true(plumb_body_angular_velocity(world, body) == 0);
}

// Thrown up through it, free flight all the way, then it lands and stays.
static void through_and_onto(void **state)
{
    (void)state;
    for (int solver = 0; solver < SOLVERS; ++solver) {
        for (form kind = BOX; kind < FORMS; ++kind) {
            for (int ball = 0; ball < 2; ++ball) {
                plumb_world *world = make_world(solver);
                add_platform(world, PLUMB_STATIC, kind, V(0, 0), upwards);
                plumb_body body =
                    ball ? add_ball(world, V(0, -3), V(0, 10)) : add_box(world, V(0, -3), V(0, 10));
                // Back down at y = 0.5, where it lands: t = (10 + sqrt(100 - 2 g 3.5)) / g.
                double landing = (10 + sqrt(100 - 2 * 9.81 * 3.5)) / 9.81;
                int steps = (int)(landing * 60) - 1;
                for (int i = 1; i <= steps; ++i) {
                    plumb_world_step(world, DT);
                    assert_free(world, body, 10, -3, i / 60.0);
                }
                run(world, 3);
                assert_near(y_of(world, body), 0.5, 2e-3);
                plumb_world_destroy(world);
            }
        }
    }
}

// Its highest place is half way in: nothing pushes it out, it falls back.
static void not_quite_through(void **state)
{
    (void)state;
    for (int solver = 0; solver < SOLVERS; ++solver) {
        for (form kind = BOX; kind < FORMS; ++kind) {
            for (int tenth = -4; tenth <= 4; ++tenth) {
                plumb_world *world = make_world(solver);
                add_platform(world, PLUMB_STATIC, kind, V(0, 0), upwards);
                double top = tenth * 0.11, v0 = sqrt(2 * 9.81 * (top + 3));
                plumb_body body = add_box(world, V(0, -3), V(0, v0));
                for (int i = 1; i <= 120; ++i) {
                    plumb_world_step(world, DT);
                    assert_free(world, body, v0, -3, i / 60.0);
                }
                plumb_world_destroy(world);
            }
        }
    }
}

// A stack on a one-way platform is, bit for bit, a stack on a solid one.
static void stacks_do_not_sink(void **state)
{
    (void)state;
    for (int solver = 0; solver < SOLVERS; ++solver) {
        plumb_world *worlds[2];
        plumb_body boxes[2][12];
        for (int k = 0; k < 2; ++k) {
            worlds[k] = make_world(solver);
            add_platform(worlds[k], PLUMB_STATIC, BOX, V(0, 0), k ? upwards : (plumb_one_way){ 0 });
            for (int i = 0; i < 12; ++i) {
                boxes[k][i] = add_box(worlds[k], V(0, 0.5 + i), V(0, 0));
            }
            run(worlds[k], 10);
        }
        for (int i = 0; i < 12; ++i) {
            plumb_vec2 a = plumb_body_position(worlds[0], boxes[0][i]);
            plumb_vec2 b = plumb_body_position(worlds[1], boxes[1][i]);
            assert_memory_equal(&a, &b, sizeof a);
            assert_near((double)a.y - (0.5 + i), 0, 0.15);
        }
        plumb_world_destroy(worlds[0]);
        plumb_world_destroy(worlds[1]);
    }
}

// A load that presses a box 7 cm into a line without thickness, 1 : 100, as into a solid one.
static void heavy_loads_are_held(void **state)
{
    (void)state;
    plumb_vec2 end[2];
    double lowest = 1;
    for (int k = 0; k < 2; ++k) {
        plumb_world *world = NULL;
        const plumb_world_desc swept = { .no_exact_islands = true, .no_fine_islands = true };
        assert_int_equal(plumb_world_create(&swept, &world), PLUMB_OK);
        add_platform(world, PLUMB_STATIC, LINE, V(0, 0), k ? upwards : (plumb_one_way){ 0 });
        plumb_body low = add_box(world, V(0, 0.5), V(0, 0));
        plumb_body high = add_box(world, V(0, 1.6), V(0, -8));
        plumb_body_set_mass(world, high, 100);
        for (int i = 0; i < 360; ++i) {
            plumb_world_step(world, DT);
            lowest = fmin(lowest, y_of(world, low));
        }
        end[k] = plumb_body_position(world, low);
        plumb_world_destroy(world);
    }
    assert_true(lowest < 0.44); // it was pressed in
    assert_true((double)end[0].y > 0.49);
    assert_memory_equal(&end[0], &end[1], sizeof end[0]);
}

static void fast_bodies(void **state)
{
    (void)state;
    for (int solver = 0; solver < SOLVERS; ++solver) {
        for (form kind = BOX; kind < FORMS; ++kind) {
            plumb_world *world = make_world(solver);
            add_platform(world, PLUMB_STATIC, kind, V(0, 0), upwards);
            plumb_body down = add_ball(world, V(-1.5, 20), V(0, -200));
            plumb_body up = add_ball(world, V(1.5, -20), V(0, 200));
            run(world, 0.5);
            double t = 0.5;
            assert_near(y_of(world, down), 0.5, 0.02);
            assert_near(y_of(world, up) - (-20 + 200 * t - 9.81 / 2 * t * t), 0, ROUNDED(1e-3));
            plumb_world_destroy(world);
        }
    }
}

// Up, down and sideways it carries what stands on it; moved down onto a body it lets it in.
static void moving_platforms(void **state)
{
    (void)state;
    for (int solver = 0; solver < SOLVERS; ++solver) {
        const double velocities[][2] = { { 0, 1.5 }, { 0, -1.5 }, { 1.5, 0 }, { 1, 1 } };
        for (int k = 0; k < 4; ++k) {
            plumb_world *world = make_world(solver);
            plumb_body lift = add_platform(world, PLUMB_KINEMATIC, BOX, V(0, 0), upwards);
            plumb_body box = add_box(world, V(0, 0.5), V(0, 0));
            run(world, 0.5);
            plumb_body_set_velocity(world, lift, V(velocities[k][0], velocities[k][1]));
            run(world, 3);
            plumb_vec2 at = plumb_body_local_point(world, lift, plumb_body_position(world, box));
            assert_near(at.y, 0.5, 5e-3);
            assert_true(fabs((double)at.x) < 0.3); // it slides until it has the platform's speed
            plumb_world_destroy(world);
        }
        plumb_world *world = make_world(solver);
        plumb_body press = add_platform(world, PLUMB_KINEMATIC, BOX, V(0, 1.5), upwards);
        add_platform(world, PLUMB_STATIC, BOX, V(0, 0), (plumb_one_way){ 0 });
        plumb_body box = add_box(world, V(0, 0.5), V(0, 0));
        plumb_body_set_velocity(world, press, V(0, -1));
        run(world, 1.2); // through the box, down to its lower half
        assert_near(y_of(world, box), 0.5, 2e-3);
        plumb_body_set_velocity(world, press, V(0, 1));
        run(world, 2); // and out of it again
        assert_near(y_of(world, box), 0.5, 2e-3);
        plumb_world_destroy(world);
    }
}

// A platform that tilts keeps what it holds; turned right over, its other side lets things in.
static void turning_platforms(void **state)
{
    (void)state;
    plumb_world *world = make_world(PLUMB_SOLVER_SOFT);
    plumb_body plate = add_platform(world, PLUMB_KINEMATIC, BOX, V(0, 0), upwards);
    plumb_body box = add_box(world, V(0, 0.5), V(0, 0));
    for (int i = 0; i < 600; ++i) {
        plumb_body_set_angular_velocity(world, plate, R(0.4 * cos(i / 60.0))); // 0.4 sin t
        plumb_world_step(world, DT);
        plumb_vec2 at = plumb_body_local_point(world, plate, plumb_body_position(world, box));
        assert_near(at.y, 0.5, 0.01);
    }
    plumb_world_destroy(world);
    for (int over = 0; over < 2; ++over) {
        world = make_world(PLUMB_SOLVER_SOFT);
        plate = add_platform(world, PLUMB_STATIC, BOX, V(0, 0), upwards);
        plumb_body_teleport(world, plate, V(0, 0), over ? R(3.14159265) : 0);
        plumb_body ball = add_ball(world, V(0, 3), V(0, 0));
        run(world, 2);
        assert_true(over ? y_of(world, ball) < -3 : fabs(y_of(world, ball) - 0.5) < 2e-3);
        plumb_world_destroy(world);
    }
}

// A flank lets pass: a box that slides along the ground through a one-way block keeps its way.
static void flanks_let_pass(void **state)
{
    (void)state;
    plumb_world *world = make_world(PLUMB_SOLVER_SOFT);
    plumb_body ground = plumb_body_create(world, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_material ice =
        plumb_material_create(world, &(plumb_material_desc){ .frictionless = true });
    plumb_shape_create(
        world, ground,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 40, 1 }, .center = { 0, -1 }, .material = ice });
    plumb_shape_create(
        world, ground,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 1, 1 }, .center = { 0, 1 }, .one_way = upwards });
    plumb_body box = add_box(world, V(-6, 0.5), V(4, 0));
    run(world, 3);
    plumb_vec2 p = plumb_body_position(world, box);
    assert_true(fabs((double)p.x - 6) < 0.01 && fabs((double)p.y - 0.5) < 5e-3);
    plumb_world_destroy(world);
}

// Only who asks drops, through what holds it then, and no further than the next platform.
static void dropping_through(void **state)
{
    (void)state;
    for (int solver = 0; solver < SOLVERS; ++solver) {
        for (form kind = BOX; kind < FORMS; ++kind) {
            plumb_world *world = make_world(solver);
            add_platform(world, PLUMB_STATIC, kind, V(0, 0), upwards);
            add_platform(world, PLUMB_STATIC, kind, V(0, -3), upwards);
            plumb_body stays = add_box(world, V(-1.5, 0.5), V(0, 0));
            plumb_body drops = add_box(world, V(1.5, 0.5), V(0, 0));
            run(world, 1);
            assert_int_equal(plumb_body_drop_through(world, drops), PLUMB_OK);
            run(world, 3);
            assert_near(y_of(world, stays), 0.5, 2e-3);
            assert_near(y_of(world, drops) + 2.5, 0, 2e-3);
            assert_int_equal(plumb_body_drop_through(world, drops), PLUMB_OK);
            run(world, 2);
            assert_true(y_of(world, drops) < -5);
            plumb_world_destroy(world);
        }
    }
}

// Row upon row of one-way tiles is one platform: what slides over it neither stops nor sinks in.
static void tiles_in_a_row(void **state)
{
    (void)state;
    for (int solver = 0; solver < SOLVERS; ++solver) {
        for (int ball = 0; ball < 2; ++ball) {
            for (double speed = 0.5; speed < 40; speed *= 3) {
                plumb_world *world = make_world(solver);
                plumb_body ground =
                    plumb_body_create(world, &(plumb_body_desc){ .type = PLUMB_STATIC });
                plumb_material ice =
                    plumb_material_create(world, &(plumb_material_desc){ .frictionless = true });
                for (int i = -4; i < 120; ++i) {
                    plumb_shape_create(world, ground,
                                       &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                            .half = { R(0.25), R(0.25) },
                                                            .center = { R(i * 0.5), R(-0.25) },
                                                            .material = ice,
                                                            .one_way = upwards });
                }
                plumb_body body = ball ? add_ball(world, V(0, 0.5), V(speed, 0))
                                       : add_box(world, V(0, 0.5), V(speed, 0));
                plumb_body_set_fixed_rotation(world, body, !ball);
                double seconds = fmin(50 / speed, 6);
                run(world, seconds);
                assert_near(y_of(world, body), 0.5, 5e-3);
                plumb_vec2 v = plumb_body_velocity(world, body);
                assert_near(v.x, speed, 0.01 * speed);
                plumb_world_destroy(world);
            }
        }
    }
}

// The angle: of a roof's two slopes, a narrow one holds neither, a wide one both.
static void the_angle_counts(void **state)
{
    (void)state;
    const plumb_vec2 roof[] = { { -3, -3 }, { 0, 0 }, { 3, -3 } }; // normals at 45 degrees
    for (int wide = 0; wide < 2; ++wide) {
        plumb_world *world = make_world(PLUMB_SOLVER_SOFT);
        plumb_body body = plumb_body_create(world, &(plumb_body_desc){ .type = PLUMB_STATIC });
        plumb_shape_create(world, body,
                           &(plumb_shape_desc){ .kind = PLUMB_CHAIN,
                                                .points = roof,
                                                .count = 3,
                                                .one_way = { { 0, 1 }, R(wide ? 1 : 0.5) } });
        plumb_body ball = add_ball(world, V(2, 2), V(0, 0));
        run(world, 1.1); // free fall: 5.9 m, straight through
        plumb_vec2 p = plumb_body_position(world, ball);
        assert_true(wide ? (double)p.x > 2.5 : fabs((double)p.x - 2) < 1e-5);
        plumb_world_destroy(world);
    }
}

// What passes is no contact: no events, no penetration told; what stands is one.
static void what_passes_is_no_contact(void **state)
{
    (void)state;
    plumb_world *world = make_world(PLUMB_SOLVER_SOFT);
    add_platform(world, PLUMB_STATIC, BOX, V(0, 0), upwards);
    plumb_body ball = add_ball(world, V(0, -3), V(0, 10));
    int begins = 0, ends = 0, count;
    for (int i = 0; i < 200; ++i) {
        plumb_world_step(world, DT);
        plumb_world_begin_events(world, &count);
        begins += count;
        plumb_world_end_events(world, &count);
        ends += count;
        assert_true((double)plumb_world_stats(world).max_penetration < 0.01);
    }
    assert_true(begins == 1 && ends == 0);
    plumb_body_drop_through(world, ball);
    plumb_world_step(world, DT);
    plumb_world_end_events(world, &count);
    assert_int_equal(count, 1);
    plumb_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(through_and_onto),
        cmocka_unit_test(not_quite_through),
        cmocka_unit_test(stacks_do_not_sink),
        cmocka_unit_test(heavy_loads_are_held),
        cmocka_unit_test(fast_bodies),
        cmocka_unit_test(moving_platforms),
        cmocka_unit_test(turning_platforms),
        cmocka_unit_test(flanks_let_pass),
        cmocka_unit_test(dropping_through),
        cmocka_unit_test(the_angle_counts),
        cmocka_unit_test(what_passes_is_no_contact),
        cmocka_unit_test(tiles_in_a_row),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
