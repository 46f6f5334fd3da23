// test_islands.c - islands that never meet end in the same bits whatever the order in which they were
// made, and whatever else is in the world.
#include "harness/random.h"
#include "harness/trials.h"
#include "plumb/plumb.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))

#define BODIES      40 // of an island
#define STEPS       240
#define STEPS_EXACT 150

typedef struct island {
    plumb_real x;                // [m] where it is
    uint32_t seed;               // of its sizes
    plumb_material_desc surface; // of its circles
    int made;                    // bodies so far
    plumb_body ground, body[BODIES];
    plumb_material material;
} island;

static void begin(plumb_world *w, island *i)
{
    i->ground = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { i->x, R(-0.5) } });
    plumb_shape_create(w, i->ground,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 12, R(0.5) } });
    i->material = plumb_material_create(w, &i->surface);
}

// One body more: boxes, circles and rounded polygons in a heap, some hinged to the one before.
static void add(plumb_world *w, island *i)
{
    static const plumb_vec2 kite[] = {
        { R(-0.4), 0 }, { 0, R(-0.3) }, { R(0.5), 0 }, { 0, R(0.6) }
    };
    int n = i->made++;
    plumb_real x = i->x + R(n % 5) * R(0.8) - 2 + R(sim_random(&i->seed) % 100) / 1000;
    plumb_vec2 at = { x, R(0.75) + R(n) / 5 };
    i->body[n] = plumb_body_create(w, &(plumb_body_desc){ .position = at, .angle = R(n) / 7 });
    plumb_real size = R(0.2) + R(sim_random(&i->seed) % 100) / 500;
    const plumb_shape_desc shapes[] = {
        { .kind = PLUMB_BOX, .half = { size, R(0.3) } },
        { .kind = PLUMB_CIRCLE, .radius = size, .material = i->material },
        { .kind = PLUMB_POLYGON, .points = kite, .count = 4, .radius = R(0.05) },
    };
    plumb_shape_create(w, i->body[n], &shapes[n % 3]);
    if (n % 7 == 6) {
        plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                   .body_a = i->body[n - 1],
                                                   .body_b = i->body[n],
                                                   .anchor = at });
    }
}

static void make(plumb_world *w, island *i)
{
    begin(w, i);
    while (i->made < BODIES) {
        add(w, i);
    }
}

// All that a body is, as bits.
typedef struct outcome {
    plumb_transform at[BODIES];
    plumb_vec2 velocity[BODIES];
    plumb_real spin[BODIES];
} outcome;

static void collect(const plumb_world *w, const island *i, outcome *out)
{
    for (int n = 0; n < BODIES; ++n) {
        out->at[n] = plumb_body_transform(w, i->body[n]);
        out->velocity[n] = plumb_body_velocity(w, i->body[n]);
        out->spin[n] = plumb_body_angular_velocity(w, i->body[n]);
    }
}

enum { ALONE, LEFT_FIRST, RIGHT_FIRST, IN_TURNS, AMONG_DAMPED, AMONG_OTHERS, ORDERS };

static void run(plumb_solver solver, int order, outcome *left, outcome *right)
{
    plumb_world *w = NULL;
    const plumb_world_desc desc = { .solver = solver };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    // What one island alone asks of the solver must not change the others.
    island a = { .x = -20, .seed = 1, .surface = { .friction = R(0.5) } };
    // (The exact solver warm starts where anything bounces.)
    const plumb_real bounce = solver == PLUMB_SOLVER_EXACT ? 0 : R(0.5);
    island b = { .x = 20, .seed = 2, .surface = { .friction = R(0.5), .restitution = bounce } };
    island c = { .x = 100,
                 .seed = 3,
                 .surface = { .friction = 1, .surface_speed = 1, .rolling_resistance = R(0.01) } };
    plumb_body gone = PLUMB_NULL_INIT;
    switch (order) {
    case ALONE:
        make(w, &a);
        break;
    case LEFT_FIRST:
        make(w, &a);
        make(w, &b);
        break;
    case RIGHT_FIRST:
        make(w, &b);
        make(w, &a);
        break;
    case IN_TURNS:
        begin(w, &b);
        begin(w, &a);
        for (int n = 0; n < BODIES; ++n) {
            add(w, n % 2 == 0 ? &a : &b);
            add(w, n % 2 == 0 ? &b : &a);
        }
        break;
    case AMONG_DAMPED:
        // Far bodies whose motion is another stand between theirs: what is done in lanes elsewhere is not here.
        begin(w, &a);
        begin(w, &b);
        for (int n = 0; n < BODIES; ++n) {
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(200 + n), 0 }, .damping = 1 });
            add(w, &a);
            add(w, &b);
        }
        break;
    default:
        // A third island, handles taken anew, a kinematic body.
        gone = plumb_body_create(w, &(plumb_body_desc){ 0 });
        make(w, &c);
        plumb_body_destroy(w, gone);
        make(w, &b);
        plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .velocity = { 1, 0 } });
        make(w, &a);
        break;
    }
    uint32_t most = 0;
    for (int i = 0; i < (solver == PLUMB_SOLVER_EXACT ? trials_steps(STEPS_EXACT) : STEPS); ++i) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
        const uint32_t contacts = plumb_world_stats(w).contact_count;
        most = contacts > most ? contacts : most;
    }
    assert_true(most > BODIES / 2);
    collect(w, &a, left);
    if (order != ALONE) {
        collect(w, &b, right);
    }
    plumb_world_destroy(w);
}

static void orders_agree(plumb_solver solver)
{
    static outcome left, right, other_left, other_right;
    run(solver, LEFT_FIRST, &left, &right);
    assert_memory_not_equal(&left, &right, sizeof left);
    for (int order = 0; order < ORDERS; ++order) {
        if (solver == PLUMB_SOLVER_EXACT && !trials_takes((uint32_t)order, 3)) {
            continue; // it takes long
        }
        other_right = right;
        run(solver, order, &other_left, &other_right);
        assert_memory_equal(&left, &other_left, sizeof left);
        assert_memory_equal(&right, &other_right, sizeof right);
    }
}

static void islands_do_not_depend_on_their_order_in_the_soft_step(void **state)
{
    (void)state;
    orders_agree(PLUMB_SOLVER_SOFT);
}

static void islands_do_not_depend_on_their_order_in_the_classic_solver(void **state)
{
    (void)state;
    orders_agree(PLUMB_SOLVER_PGS);
}

static void islands_do_not_depend_on_their_order_in_the_exact_solver(void **state)
{
    (void)state;
    orders_agree(PLUMB_SOLVER_EXACT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(islands_do_not_depend_on_their_order_in_the_soft_step),
        cmocka_unit_test(islands_do_not_depend_on_their_order_in_the_classic_solver),
        cmocka_unit_test(islands_do_not_depend_on_their_order_in_the_exact_solver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
