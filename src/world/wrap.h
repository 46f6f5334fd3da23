// wrap.h - worlds that wrap around: shifts by whole periods.
//
// The centre of a body lies in [-wrap/2, wrap/2); pieces lie where their body has them, beyond the edge
// too. Fat boxes are kept where their middle is in the period (broad/images.h). Wherever two positions
// are compared, one of them is shifted by the whole periods that bring it nearest to the other. In a world
// that does not wrap all of this is a comparison with 0.
#ifndef PL_WRAP_H
#define PL_WRAP_H

#include "world/state.h"

// [m] by which something is to be shifted: whole periods, 0 along axes that do not wrap.
typedef struct pl_shift {
    double x, y;
} pl_shift;

static inline bool pl_is_wrapped(const plumb_world *world)
{
    return world->desc.wrap_x > 0 || world->desc.wrap_y > 0;
}

// What to add to something that lies (dx, dy) [m] from a place, so that it lies nearest to it.
pl_shift pl_wrap_shift(const plumb_world *world, double dx, double dy);

// `point`, by the image nearest to `about`.
plumb_vec2 pl_wrap_point(const plumb_world *world, plumb_vec2 point, plumb_vec2 about);

// What to add to a piece so that the middle of its core is nearest to a place.
pl_shift pl_wrap_piece(const plumb_world *world, uint32_t piece, double x, double y);

// From the centre of mass of a row to a place, the shortest way [m].
pl_shift pl_wrap_arm(const plumb_world *world, uint32_t row, double x, double y);

// From the origin of body p's frame to that of q's [m], such that two pieces of theirs are nearest. Exact
// where that is less than half a period, but for what rounding took from the origins: 1e-8 m at 1e8 m, by which no
// crate on tiles and no ball on a platform is elsewhere (tests/stability/test_far.c).
pl_shift pl_wrap_between(const plumb_world *world, uint32_t p, uint32_t q);

// A box by the image of which the middle lies in the period.
pl_box pl_wrap_box(const plumb_world *world, pl_box box);

// Brings the centre of a row back into the period, its origin and pose with it.
void pl_wrap_row(plumb_world *world, uint32_t row);

// The pass: all that moves.
void pl_wrap_bodies(plumb_world *world);

// Of the size of a piece of the shape that is made. E_RANGE.
plumb_result pl_wrap_check_piece(const plumb_world *world, const char *function,
                                 const pl_core *core);

#endif
