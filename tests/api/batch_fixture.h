// batch_fixture.h - what the tests of batch.h share: worlds with a ground, a cart that is pushed, a pole on it.
#ifndef BATCH_FIXTURE_H
#define BATCH_FIXTURE_H

#include "harness/heap.h"
#include "world_fixture.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#define DT ((plumb_real)(1.0 / 60))

//---- the worlds: a ground, a cart that is pushed, a pole that stands on it ------------------------
enum { GROUND, CART, POLE, PEOPLE };
static const plumb_body people[PEOPLE] = { { { 0, 1 } }, { { 2, 1 } }, { { 4, 1 } } };

static inline plumb_result build(plumb_world *world, uint32_t index, plumb_random *random,
                                 void *context)
{
    (void)index, (void)random, (void)context;
    const plumb_vec2 at[PEOPLE] = { { 0, -1 }, { 0, R(0.25) }, { 0, 1 } };
    const plumb_vec2 half[PEOPLE] = { { 40, 1 }, { R(0.5), R(0.25) }, { R(0.1), R(0.5) } };
    for (int i = 0; i < PEOPLE; ++i) {
        plumb_body b = plumb_body_create(
            world, &(plumb_body_desc){ .type = i == GROUND ? PLUMB_STATIC : PLUMB_DYNAMIC,
                                       .position = at[i] });
        const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = half[i] };
        if (plumb_is_null(b) || plumb_is_null(plumb_shape_create(world, b, &box))) {
            return plumb_world_error(world).code;
        }
        if (b.entity.index != people[i].entity.index ||
            b.entity.generation != people[i].entity.generation) {
            return PLUMB_E_STATE;
        }
    }
    return PLUMB_OK;
}

static inline plumb_result randomise(plumb_world *world, uint32_t index, plumb_random *random,
                                     void *context)
{
    (void)index, (void)context;
    plumb_vec2 v = { plumb_random_range(random, -1, 1), 0 };
    plumb_result r = plumb_body_set_velocity(world, people[CART], v);
    return r != PLUMB_OK ? r
                         : plumb_body_set_angular_velocity(world, people[POLE],
                                                           plumb_random_range(random, -1, 1));
}

static inline plumb_batch *make(plumb_batch_desc d)
{
    plumb_batch *batch = NULL;
    d.build = d.build == NULL ? build : d.build;
    assert_int_equal(plumb_batch_create(&d, &batch), PLUMB_OK);
    assert_non_null(batch);
    return batch;
}

//---- bits ----------------------------------------------------------------------------------------
enum { WORLDS = 37 };

static inline void play(plumb_batch *batch)
{
    const plumb_batch_field push[] = { PLUMB_FIELD_FORCE_X };
    const plumb_batch_view how = { &people[CART], 1, push, 1 };
    plumb_real force[WORLDS];
    for (int step = 0; step < 40; ++step) {
        for (int i = 0; i < WORLDS; ++i) {
            force[i] = R((i + step) % 5 - 2);
        }
        assert_int_equal(plumb_batch_act(batch, &how, force, WORLDS), PLUMB_OK);
        assert_int_equal(plumb_batch_step(batch, DT, 2), PLUMB_OK);
        const uint32_t some[] = { 30, 2, (uint32_t)step % 20 + 5 };
        if (step % 8 == 7) {
            assert_int_equal(plumb_batch_reset(batch, some, 3), PLUMB_OK);
        }
    }
}

static inline plumb_result build_unlike(plumb_world *world, uint32_t index, plumb_random *random,
                                        void *context)
{
    plumb_result r = build(world, index, random, context);
    plumb_vec2 v = { R(index), 0 };
    return r != PLUMB_OK ? r : plumb_body_set_velocity(world, people[CART], v);
}

#endif
