// sleep.h - what a world keeps of bodies that sleep, and what the step and the API call.
#ifndef PL_SLEEP_H
#define PL_SLEEP_H

#include "world/tables/sleep.h"

//---- the passes ----------------------------------------------------------------------------------

// Wakes what is due and what is touched (wake.c). False when out of memory: nobody has woken.
bool pl_sleep_wake(plumb_world *world, plumb_real dt);
// Whether impacts of this step throw somebody at what sleeps: it is to be run again.
bool pl_sleep_is_struck(const plumb_world *world);
// Puts to sleep what has rested long enough (fall.c). False when out of memory: nothing has
// changed.
bool pl_sleep_fall(plumb_world *world, plumb_real dt);
void pl_sleep_events_clear(plumb_world *world);
// Puts the island of an awake dynamic row, or of soft body i that is awake (dynamic_count + i), to sleep at once.
// Errors: E_MEMORY, E_STATE (who is of it may not sleep).
plumb_result pl_sleep_put_to_sleep(plumb_world *world, const char *function, uint32_t member);

//---- a step that is taken again (retry.c) ----------------------------------------------------------

// At the head of a try: bodies that turned in one that was refused are as they were before it.
void pl_sleep_recall(plumb_world *world);
// What fell asleep lies still again: at the head of the waking pass.
void pl_sleep_lay(plumb_world *world);
// Around what a refused try undoes: what fell asleep in it has the forces of then.
void pl_sleep_undo_open(plumb_world *world);
void pl_sleep_undo_close(plumb_world *world);
// The step is over, refused or not.
void pl_sleep_recall_end(plumb_world *world);

//---- what is driven (driven.c) -------------------------------------------------------------------

struct pl_joint;

// At least half as fast as it is meant to be, and the same way.
static inline bool pl_keeps_pace(double rate, double meant)
{
    return 2 * rate * meant >= meant * meant;
}

// The surface of one carries the other along, however slowly.
bool pl_sleep_is_carried(const plumb_world *world, const pl_manifold *m);
// The motor of a joint moves its bodies, however slowly.
bool pl_sleep_is_driven(const plumb_world *world, const struct pl_joint *joint);

void pl_sleep_free(pl_memory *memory, pl_sleep *sleep);

#endif
