// sleep_fixture.h - what the tests of sleeping share: a few bodies that have fallen asleep.
#ifndef SLEEP_FIXTURE_H
#define SLEEP_FIXTURE_H

#include "world_fixture.h"

static inline void steps(plumb_world *w, int count)
{
    for (int i = 0; i < count; ++i) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    }
}

// Two crates on one another and a third apart, on the ground; a kinematic ledge with a crate; two
// discs that are joined, without contacts, held by a hinge.
typedef struct place {
    plumb_world *w;
    plumb_body ground, ledge, low, high, apart, on_ledge, hung;
    plumb_shape floor, board, low_box;
    plumb_material wood;
    plumb_joint rod;
} place;

static inline plumb_body crate(plumb_world *w, double x, double y, plumb_material m,
                               plumb_shape *shape)
{
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { R(x), R(y) } });
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) }, .material = m };
    plumb_shape made = plumb_shape_create(w, b, &box);
    if (shape != NULL) {
        *shape = made;
    }
    return b;
}

static inline place make_place(void)
{
    place p = { .w = NULL };
    assert_int_equal(plumb_world_create(NULL, &p.w), PLUMB_OK);
    p.wood = plumb_material_create(p.w, &(plumb_material_desc){ .friction = R(0.6) });
    p.ground =
        plumb_body_create(p.w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, -1 } });
    p.floor = plumb_shape_create(
        p.w, p.ground,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 50, 1 }, .material = p.wood });
    p.ledge = plumb_body_create(
        p.w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 10, 5 } });
    p.board = plumb_shape_create(p.w, p.ledge,
                                 &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 2, R(0.25) } });
    p.low = crate(p.w, 0, 0.5, p.wood, &p.low_box);
    p.high = crate(p.w, 0.1, 1.5, p.wood, NULL);
    p.apart = crate(p.w, 5, 0.5, p.wood, NULL);
    p.on_ledge = crate(p.w, 10, 5.75, p.wood, NULL);
    p.hung = crate(p.w, -10, 8, p.wood, NULL);
    p.rod = plumb_joint_create(p.w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                         .body_b = p.hung,
                                                         .anchor = { -10, 10 },
                                                         .anchor_b = { -10, 8 } });
    steps(p.w, 150);
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
    assert_int_equal(plumb_world_stats(p.w).dynamic_count, 0);
    assert_int_equal(plumb_world_stats(p.w).island_count, 4);
    return p;
}

#endif
