// rollback.h - a world is run twice: straight on, and going back and on again at random. Each step
// must have the same hash both times.
#ifndef ROLLBACK_H
#define ROLLBACK_H

#include "plumb/plumb.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define ROLLBACK_MOST 24 // steps of a script

// A step of a script: calls between steps of the world, or one of those. A function of the world's state
// alone.
typedef void rollback_step(plumb_world *world, void *context);

// Hashes of the world after 0..steps steps.
void rollback_reference(plumb_world *world, rollback_step *step, void *context, int steps,
                        uint64_t *hashes);

// The same world from the start: every fourth step or so goes back by 1..`most` steps first, into
// `other` if that is not null; the two worlds then take turns.
// `frames`: what is kept are frames of a base, made anew now and then, instead of whole images.
// Returns how often it went back.
int rollback_run(plumb_world *world, plumb_world *other, rollback_step *step, void *context,
                 int steps, int most, bool frames, const uint64_t *hashes);

#endif
