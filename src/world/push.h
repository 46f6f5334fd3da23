// push.h - forces on bodies at rest: which are the same, which wake.
#ifndef PL_PUSH_H
#define PL_PUSH_H

#include "world/state.h"

#define PL_EVEN ((real)0.02) // [-] of sleep_speed * sleep_time, by which ways may differ
// [-] of sleep_speed, below which what floats stands still: by default 3 mm a minute.
#define PL_STILL ((real)1e-3)

// [m^2/s^2] of its farthest point.
static inline real pl_square_speed(const pl_bodies *b, uint32_t row)
{
    const real tip = b->w[row] * b->extent[row];
    return b->vx[row] * b->vx[row] + b->vy[row] * b->vy[row] + tip * tip;
}

static inline bool pl_stands_still(const plumb_world *world, uint32_t row)
{
    const real still = PL_STILL * world->desc.sleep_speed;
    return pl_square_speed(&world->bodies, row) <= still * still;
}

// A call is about to push the awake or sleeping body of a row.
void pl_sleep_push(plumb_world *world, uint32_t row);
// Force columns are handed out: they may be written until the next step is over.
void pl_sleep_heed(plumb_world *world);
// They were written over, and what is asleep may be another.
void pl_sleep_heed_all(plumb_world *world);
// A system was switched: who is not told what pushes him asks.
void pl_sleep_wake_untold(plumb_world *world);
// Forces of sleeping rows were for the step that is over.
void pl_sleep_clear_forces(plumb_world *world);
// [m/s^2] by which accelerations of forces that count as the same may differ.
real pl_push_tolerance(const plumb_world *world);
// The force on a row is not the one that was taken down.
bool pl_push_differs(const plumb_world *world, uint32_t row, real tolerance);
bool pl_is_pushed(const plumb_world *world, uint32_t row);
// A body wakes; it is looked at in its rest: whether its pusher tells sleeping rows.
void pl_push_wake(plumb_world *world, uint32_t row);
void pl_push_sample(plumb_world *world, uint32_t row);
void pl_push_keep(pl_bodies *bodies, uint32_t row);
// A body falls asleep; `steps`: in a step, not by a call.
void pl_push_begin_sleep(plumb_world *world, uint32_t row, bool steps);
// Whether some sleeping row may be pushed otherwise than before; marks the islands of those that are; then, when
// nothing can fail any more, takes down the force on those that sleep on.
bool pl_push_matters(const plumb_world *world);
void pl_push_mark(plumb_world *world, void (*mark)(pl_sleep *, uint32_t));
void pl_push_settle(plumb_world *world);

#endif
