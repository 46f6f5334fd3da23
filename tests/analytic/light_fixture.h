// light_fixture.h - what the tests of light share: shapes of a material, a ray, what it came to.
#ifndef LIGHT_FIXTURE_H
#define LIGHT_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define MOST 2048
// Places are told in plumb_real; what is computed is in double.
#define PLACES                         ((double)PLUMB_REAL_EPSILON)
#define TOLERANCE(in_float, in_double) (PLACES > 1e-10 ? (in_float) : (in_double))

static plumb_light_segment path[MOST];
static plumb_light_sum sum;
static uint32_t seed;

static inline double uniform(double low, double high)
{
    return sim_uniform(&seed, low, high);
}

static inline plumb_material optical(plumb_world *w, double index, double reflectance,
                                     double absorption)
{
    return plumb_material_create(w, &(plumb_material_desc){ .refractive_index = (plumb_real)index,
                                                            .reflectance = (plumb_real)reflectance,
                                                            .absorption = (plumb_real)absorption });
}

static inline plumb_body add(plumb_world *w, double x, double y, double angle,
                             plumb_shape_desc desc, plumb_material m)
{
    plumb_body b = sim_body(w, PLUMB_STATIC, x, y, angle);
    desc.material = m;
    assert_false(plumb_is_null(plumb_shape_create(w, b, &desc)));
    return b;
}

static inline plumb_shape_desc box(double hx, double hy)
{
    return (plumb_shape_desc){ .kind = PLUMB_BOX, .half = sim_vec(hx, hy) };
}

static inline plumb_shape_desc disc(double r)
{
    return (plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = (plumb_real)r };
}

static inline int shine(plumb_world *w, plumb_light_desc d)
{
    const int count = plumb_world_light(w, &d, NULL, path, MOST, &sum);
    assert_true(count > 0);
    return count;
}

static inline void direction_of(const plumb_light_segment *s, double out[2])
{
    const double x = (double)s->to.x - (double)s->from.x, y = (double)s->to.y - (double)s->from.y;
    const double size = sqrt(x * x + y * y);
    out[0] = x / size;
    out[1] = y / size;
}

// The piece that came of path[parent] in that way; NULL: none.
static inline const plumb_light_segment *child_of(int count, int parent, plumb_light_how how)
{
    for (int i = parent + 1; i < count; ++i) {
        if (path[i].parent == parent && path[i].how == how) {
            return &path[i];
        }
    }
    return NULL;
}

#endif
