// formula_fixture.h - what the tests of formulas in worlds share: bodies, laws, steps.
#ifndef FORMULA_FIXTURE_H
#define FORMULA_FIXTURE_H

#include "world_fixture.h"

#define DT R(1.0 / 60)

static inline plumb_world *make_world(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

static inline plumb_body ball(plumb_world *w, plumb_real x, plumb_real y, plumb_body_desc desc)
{
    desc.position = (plumb_vec2){ x, y };
    const plumb_body b = plumb_body_create(w, &desc);
    plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.2) });
    return b;
}

static inline void run(plumb_world *w, int steps)
{
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
}

static inline plumb_law add(plumb_world *w, plumb_law_desc d)
{
    d.kind = PLUMB_LAW_FORMULA;
    const plumb_law law = plumb_law_create(w, &d);
    assert_false(plumb_is_null(law));
    return law;
}

static inline plumb_vec2 at(const plumb_world *w, plumb_real x, plumb_real y)
{
    return plumb_world_law_at(w, plumb_v2(x, y), plumb_v2(0, 0), 0);
}

#define FORMULA .kind = PLUMB_LAW_FORMULA

#endif
