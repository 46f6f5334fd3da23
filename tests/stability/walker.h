// walker.h - what the tests of characters share: worlds, ground, somebody who walks on it.
#ifndef WALKER_H
#define WALKER_H

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

#define RADIUS 0.3             // [m] of the capsule
#define HALF   0.6             // [m] of its core
#define SKIN   (RADIUS / 50)   // [m] default
#define STANDS (HALF + RADIUS) // [m] height of its origin above the ground, skin aside

static inline plumb_world *make_world(void)
{
    plumb_world *world = NULL;
    assert_int_equal(plumb_world_create(NULL, &world), PLUMB_OK);
    return world;
}

static inline plumb_body add_body(plumb_world *world, plumb_body_type type, plumb_vec2 at)
{
    plumb_body body = plumb_body_create(world, &(plumb_body_desc){ .type = type, .position = at });
    assert_false(plumb_is_null(body));
    return body;
}

static inline plumb_body add_box(plumb_world *world, plumb_body_type type, plumb_vec2 at,
                                 plumb_vec2 half)
{
    plumb_body body = add_body(world, type, at);
    plumb_shape_desc desc = { .kind = PLUMB_BOX, .half = half };
    assert_false(plumb_is_null(plumb_shape_create(world, body, &desc)));
    return body;
}

static inline plumb_body add_chain(plumb_world *world, const plumb_vec2 *points, int count)
{
    plumb_body body = add_body(world, PLUMB_STATIC, V(0, 0));
    plumb_shape_desc desc = { .kind = PLUMB_CHAIN, .points = points, .count = count };
    assert_false(plumb_is_null(plumb_shape_create(world, body, &desc)));
    return body;
}

// A floor whose top is at y = 0.
static inline plumb_body add_floor(plumb_world *world)
{
    return add_box(world, PLUMB_STATIC, V(0, -1), V(100, 1));
}

static inline plumb_body add_hero_of(plumb_world *world, plumb_body_type type, plumb_vec2 at,
                                     const plumb_character_desc *desc)
{
    const plumb_vec2 ends[] = { { 0, R(-HALF) }, { 0, R(HALF) } };
    plumb_body body = add_body(world, type, at);
    plumb_shape_create(world, body,
                       &(plumb_shape_desc){ .kind = PLUMB_CAPSULE,
                                            .points = ends,
                                            .count = 2,
                                            .radius = R(RADIUS),
                                            .density = 50 });
    assert_int_equal(plumb_character_create(world, body, desc), PLUMB_OK);
    return body;
}

// A kinematic one, its feet at the height of `at`.
static inline plumb_body add_hero(plumb_world *world, double x, double y,
                                  const plumb_character_desc *desc)
{
    return add_hero_of(world, PLUMB_KINEMATIC, V(x, y + STANDS + SKIN), desc);
}

static inline void run(plumb_world *world, double rate, double seconds)
{
    int steps = (int)lrint(seconds * rate);
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(world, R(1 / rate)), PLUMB_OK);
    }
}

static inline double x_of(plumb_world *world, plumb_body body)
{
    return (double)plumb_body_position(world, body).x;
}

static inline double y_of(plumb_world *world, plumb_body body)
{
    return (double)plumb_body_position(world, body).y;
}

// Height of the feet of a kinematic one above y = 0.
static inline double feet_of(plumb_world *world, plumb_body body)
{
    return y_of(world, body) - STANDS - SKIN;
}

static inline plumb_character_state state_of(plumb_world *world, plumb_body body)
{
    plumb_character_state state;
    assert_int_equal(plumb_character_get(world, body, &state), PLUMB_OK);
    return state;
}

// [1/s] steps of which a way must not depend
static const double step_rates[] = { 30, 60, 144, 1000 };
#define STEP_RATES ((int)(sizeof step_rates / sizeof step_rates[0]))

#endif
