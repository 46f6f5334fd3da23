// snapshot_fixture.h - what the tests of snapshot.h share: a heap of bodies, images of it.
#ifndef SNAPSHOT_FIXTURE_H
#define SNAPSHOT_FIXTURE_H

#include "harness/heap.h"
#include "world_fixture.h"
#include <stdio.h>
#include <stdlib.h>

//---- worlds --------------------------------------------------------------------------------------
typedef struct pile {
    plumb_world *world;
    plumb_body bodies[40];
    plumb_shape shape; // of the first body
    plumb_component tag;
} pile;

static inline void count_calls(const plumb_system_call *call)
{
    int *calls = call->context;
    ++*calls;
}

static int calls;

// A heap of boxes and balls on the ground, one of them with a component, steps apart.
static inline void make_pile(pile *p, plumb_world_desc desc, int steps)
{
    assert_int_equal(plumb_world_create(&desc, &p->world), PLUMB_OK);
    plumb_world *w = p->world;
    p->tag = plumb_component_create(w, &(plumb_component_desc){ .name = "tag", .size = 8 });
    plumb_system_create(
        w, &(plumb_system_desc){
               .name = "count", .phase = PLUMB_PHASE_END, .run = count_calls, .context = &calls });
    plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, 1 } });
    for (int i = 0; i < 40; ++i) {
        p->bodies[i] = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(i % 8) - 4, R(1.6) + R(i / 8) * R(1.1) },
                                   .user_data = &p->bodies[i] });
        plumb_shape_desc d = { .kind = i % 4 == 3 ? PLUMB_CIRCLE : PLUMB_BOX, .user_data = p };
        if (d.kind == PLUMB_CIRCLE) {
            d.radius = R(0.5);
        } else {
            d.half = plumb_v2(R(0.5), R(0.5));
        }
        plumb_shape s = plumb_shape_create(w, p->bodies[i], &d);
        p->shape = i == 0 ? s : p->shape;
    }
    plumb_component_set(w, p->bodies[3].entity, p->tag, "1234567");
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    }
}

typedef struct image {
    char *bytes;
    size_t size;
} image;

static inline image save(const plumb_world *w)
{
    image i = { .size = plumb_world_snapshot_size(w) };
    i.bytes = malloc(i.size);
    assert_non_null(i.bytes);
    assert_int_equal(plumb_world_save(w, i.bytes, i.size), PLUMB_OK);
    return i;
}

static inline image save_frame(const plumb_world *w, image base)
{
    image i = { .size = plumb_world_snapshot_size(w) };
    i.bytes = malloc(i.size);
    assert_non_null(i.bytes);
    assert_int_equal(plumb_world_save_frame(w, base.bytes, base.size, i.bytes, i.size, &i.size),
                     PLUMB_OK);
    return i;
}

static inline void step(plumb_world *w, int steps)
{
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    }
}

#endif
