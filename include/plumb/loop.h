/// loop.h - fixed steps from frames of any length, and where bodies are in between, for game loops.
///
///     plumb_loop *loop;
///     plumb_loop_create(world, &(plumb_loop_desc){ .dt = 1.0 / 60 }, &loop);
///     for (;;) {                                             // a frame
///         for (int n = plumb_loop_frame(loop, seconds_since_last_frame); n > 0; --n) {
///             ...                                            // inputs, forces
///             plumb_loop_step(loop);
///             ...                                            // events
///         }
///         draw(plumb_loop_transform(loop, player));
///     }
///
/// What is drawn lags behind the world by up to one step: at a frame that falls between two steps, bodies are
/// shown on their way from where they were before the last step to where they are. Whoever was teleported or made
/// since is shown where it is: nothing smears. In a world that wraps around the way is the shortest one.
#ifndef PLUMB_LOOP_H
#define PLUMB_LOOP_H

#include "plumb/body.h"

PLUMB_BEGIN

/// Null: no steps are owed, nothing is blended.
typedef struct plumb_loop plumb_loop;

/// {0} is valid: every zero means the default told beside the field.
typedef struct plumb_loop_desc {
    double dt;     ///< [s] 0..1 of a step; default 1/60
    int steps_max; ///< most steps that a frame may ask for, 1..1000, default 8: where steps take longer than the
                   ///< time that they stand for, the game slows down instead of falling ever further behind
} plumb_loop_desc;

/// Makes a loop for a world; `desc` may be null (= {0}). It must go before the world does. On an error *loop is null.
/// Errors: E_NULL, E_RANGE, E_NOT_FINITE, E_MEMORY.
PLUMB_API plumb_result plumb_loop_create(plumb_world *world, const plumb_loop_desc *desc,
                                         plumb_loop **loop);
/// Null is ignored.
PLUMB_API void plumb_loop_destroy(plumb_loop *loop);

/// A frame has taken `seconds` [s] >= 0: how many steps are due now. Time that is left over is kept for the next
/// frame; what exceeds steps_max is forgotten. -1 on an error: E_NOT_FINITE, E_RANGE.
PLUMB_API int plumb_loop_frame(plumb_loop *loop, double seconds);
/// Carries out commands, remembers where bodies are, and steps the world by dt. Bodies: O(those that are not
/// static) besides the step. Errors: those of plumb_world_step.
PLUMB_API plumb_result plumb_loop_step(plumb_loop *loop);
/// [-] 0..1: how far the last frame has come from the step before the last one to the last one.
PLUMB_API plumb_real plumb_loop_alpha(const plumb_loop *loop);
/// Where a body is to be drawn in the last frame. In a world that wraps around: beside where it is now. All zeros for
/// a bad handle. O(1).
PLUMB_API plumb_transform plumb_loop_transform(const plumb_loop *loop, plumb_body body);

PLUMB_END

#endif
