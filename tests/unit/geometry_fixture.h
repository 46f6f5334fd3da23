// geometry_fixture.h - what the tests of geometry.h share: numbers that are near, random shapes.
#ifndef GEOMETRY_FIXTURE_H
#define GEOMETRY_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "plumb/geometry.h"

#define PI           3.14159265358979323846
#define EPS          ((double)PLUMB_REAL_EPSILON)
#define R(x)         PLUMB_REAL(x)
#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

#define SAYS(call, code) assert_int_equal(call, PLUMB_##code)

static uint32_t random_state;

static inline double uniform(double low, double high)
{
    return sim_uniform(&random_state, low, high);
}

static inline plumb_vec2 random_point(double size)
{
    plumb_real x = R(uniform(-size, size));
    return plumb_v2(x, R(uniform(-size, size)));
}

static inline int seed(void **state)
{
    (void)state;
    random_state = 31415927u;
    return 0;
}

// A random shape: circle, capsule, segment, or polygon with or without rounding.
static inline plumb_convex random_shape(int kind)
{
    plumb_convex shape = { .count = 0 };
    plumb_vec2 p[12];
    for (int i = 0; i < COUNT(p); i++) {
        p[i] = random_point(2);
    }
    switch (kind % 5) {
    case 0:
        SAYS(plumb_convex_circle(p[0], R(uniform(0.1, 1)), &shape), OK);
        break;
    case 1:
        SAYS(plumb_convex_capsule(p[0], p[1], R(uniform(0.1, 1)), &shape), OK);
        break;
    case 2:
        SAYS(plumb_convex_segment(p[0], p[1], &shape), OK);
        break;
    case 3:
        SAYS(plumb_convex_polygon(p, 3 + kind % 10, 0, &shape), OK);
        break;
    default:
        SAYS(plumb_convex_polygon(p, 3 + kind % 10, R(uniform(0.05, 0.5)), &shape), OK);
    }
    return shape;
}

static inline plumb_real nan_real(void)
{
    plumb_real zero = 0;
    return zero / zero;
}

#endif
