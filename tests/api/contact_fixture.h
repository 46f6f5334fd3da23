// contact_fixture.h - what the tests of contacts share: a flat floor, discs, steps.
#ifndef CONTACT_FIXTURE_H
#define CONTACT_FIXTURE_H

#include "world_fixture.h"

#define DT R(0.015625) // 1/64 s
#define W  f->world

static inline void steps(plumb_world *w, int count)
{
    for (int i = 0; i < count; ++i) {
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
}

static inline plumb_world *flat_world(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

static inline plumb_shape add_floor(plumb_world *w, plumb_material material)
{
    plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    return plumb_shape_create(
        w, ground,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 200, 1 }, .center = { 0, -1 }, .material = material });
}

static inline plumb_body add_disc(plumb_world *w, double x, double y, plumb_shape_desc desc,
                                  plumb_shape *shape)
{
    plumb_body body = plumb_body_create(w, &(plumb_body_desc){ .position = { R(x), R(y) } });
    desc.kind = PLUMB_CIRCLE;
    desc.radius = R(0.5);
    plumb_shape made = plumb_shape_create(w, body, &desc);
    if (shape != NULL) {
        *shape = made;
    }
    return body;
}

#endif
