// random_world.h - worlds of all kinds of shapes by a seed, for tests that have a model to compare with.
#ifndef RANDOM_WORLD_H
#define RANDOM_WORLD_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "harness/random.h"
#include "plumb/plumb.h"

static uint32_t random_state;

static inline double uniform(double low, double high)
{
    return sim_uniform(&random_state, low, high);
}

static inline double spread(double low, double high)
{
    return exp(uniform(log(low), log(high)));
}

static inline plumb_vec2 place(double reach)
{
    return plumb_v2((plumb_real)uniform(-reach, reach), (plumb_real)uniform(-reach, reach));
}

static inline plumb_world *make_world(uint32_t seed)
{
    random_state = seed * 2654435761u + 1;
    plumb_world *world = NULL;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &world),
                     PLUMB_OK);
    return world;
}

// One of that kind of the size [m], turned, rounded, open or closed as it comes.
static inline plumb_shape random_shape(plumb_world *world, plumb_body body, int kind, double size,
                                       plumb_material material)
{
    const double star[][2] = {
        { -1, -1 }, { 0, -0.4 }, { 1, -1 }, { 0.9, 1 }, { 0, 0.3 }, { -1, 1 }
    };
    plumb_vec2 points[6];
    for (int i = 0; i < 6; ++i) {
        points[i] = plumb_v2((plumb_real)(size * star[i][0]), (plumb_real)(size * star[i][1]));
    }
    plumb_shape_desc desc = { .kind = (plumb_shape_kind)kind, .material = material };
    if (kind == PLUMB_CIRCLE || kind == PLUMB_CAPSULE) {
        desc.radius = (plumb_real)(size);
    }
    if (kind == PLUMB_BOX) {
        desc.half = plumb_v2((plumb_real)size, (plumb_real)(size / 3));
        desc.angle = (plumb_real)(uniform(-3, 3));
    }
    if ((kind == PLUMB_BOX || kind == PLUMB_POLYGON) && uniform(0, 1) < 0.5) {
        desc.radius = (plumb_real)(size / 5);
    }
    if (kind == PLUMB_POLYGON || kind == PLUMB_OUTLINE || kind == PLUMB_CHAIN) {
        desc.points = points;
        desc.count = 6;
        desc.closed = kind == PLUMB_CHAIN && uniform(0, 1) < 0.5;
    }
    if (kind == PLUMB_CAPSULE || kind == PLUMB_SEGMENT) {
        desc.points = points;
        desc.count = 2;
    }
    plumb_shape shape = plumb_shape_create(world, body, &desc);
    assert_true(plumb_shape_valid(world, shape));
    return shape;
}

#endif
