// one_way.c - the one-way property of shapes, set and asked; bodies that ask to drop through.
//
// Reads: arguments. Writes: the pieces' columns, flags, counters. Cost: O(pieces of the shape).
#include "math/trig.h"
#include "narrow/one_way.h"
#include "plumb/math.h"
#include "world/check.h"
#include "world/filter.h"
#include "world/island.h"
#include "world/rows.h"
#include "world/stale_edges.h"

#define DEFAULT_COS ((real)0.5) // of 60 degrees
#define RIGHT_ANGLE ((real)1.5707964)

plumb_result pl_one_way_check(const plumb_world *world, const char *function,
                              const plumb_one_way *one_way)
{
    PL_TRY(pl_check_finite_vec(world, function, "one_way.direction", one_way->direction));
    PL_TRY(pl_check_range(world, function, "one_way.angle", one_way->angle, 0, RIGHT_ANGLE));
    if (one_way->direction.x == 0 && one_way->direction.y == 0 && one_way->angle != 0) {
        return pl_fail(world, PLUMB_E_RANGE, function,
                       "one_way.angle is %g; it must be 0 without one_way.direction",
                       (double)one_way->angle);
    }
    return PLUMB_OK;
}

void pl_one_way_apply(plumb_world *world, uint32_t first, const plumb_one_way *one_way)
{
    pl_pieces *pieces = &world->pieces;
    bool on = one_way->direction.x != 0 || one_way->direction.y != 0;
    plumb_vec2 d = plumb_vec2_unit(one_way->direction);
    double sine, cosine = (double)DEFAULT_COS;
    if (one_way->angle > 0) {
        pl_sincos((double)one_way->angle, &sine, &cosine);
    }
    for (uint32_t p = first; p != PL_NONE; p = pieces->next_in_shape[p]) {
        pieces->one_way_x[p] = on ? d.x : 0;
        pieces->one_way_y[p] = on ? d.y : 0;
        pieces->one_way_cos[p] = on ? (real)(cosine > 0 ? cosine : 0) : 0;
        pieces->one_way_angle[p] = one_way->angle;
        pl_piece_flag(world, p, PL_PIECE_ONE_WAY, on, &world->one_way_pieces);
    }
    pl_internal_edges_touch_shape(world, first);
    world->schedule_dirty = true;
}

plumb_one_way plumb_shape_one_way(const plumb_world *world, plumb_shape shape)
{
    uint32_t p = pl_ask_shape(world, __func__, shape);
    if (p == PL_NONE) {
        return (plumb_one_way){ 0 };
    }
    const pl_pieces *pieces = &world->pieces;
    return (plumb_one_way){ { pieces->one_way_x[p], pieces->one_way_y[p] },
                            pieces->one_way_angle[p] };
}

plumb_result plumb_shape_set_one_way(plumb_world *world, plumb_shape shape, plumb_one_way one_way)
{
    uint32_t first;
    PL_TRY(pl_check_shape(world, __func__, shape, &first));
    PL_TRY(pl_one_way_check(world, __func__, &one_way));
    const plumb_one_way was = plumb_shape_one_way(world, shape);
    pl_one_way_apply(world, first, &one_way);
    const plumb_one_way is = plumb_shape_one_way(world, shape);
    if (is.direction.x != was.direction.x || is.direction.y != was.direction.y ||
        is.angle != was.angle) {
        pl_sleep_disturb_piece(world, first);
        world->rearranged = true;
    }
    return PLUMB_OK;
}

plumb_result plumb_body_drop_through(plumb_world *world, plumb_body body)
{
    uint32_t row;
    PL_TRY(pl_check_dynamic(world, __func__, body, &row));
    pl_sleep_stir(world, row);
    // Else nobody would take the request back.
    bool any = world->one_way_pieces > 0 && (world->bodies.flags[row] & PL_BODY_DISABLED) == 0;
    world->bodies.flags[row] |= any ? PL_BODY_DROPPING : 0;
    world->dropping_bodies += any;
    return PLUMB_OK;
}
