// told.h - the last call that changed a body or joint, noted while the world has a watchdog (src/watchdog).
#ifndef PL_TOLD_H
#define PL_TOLD_H

#include "world/state.h"

// What the watchdog knows of an entity; a slot that was taken anew begins anew. NULL: out of memory.
pl_watched *pl_watched_find(plumb_world *world, plumb_entity entity);
// `function` has changed an entity.
void pl_told_note(plumb_world *world, plumb_entity entity, const char *function);

static inline void pl_told(plumb_world *world, plumb_entity entity, const char *function)
{
    if (world->desc.watchdog) {
        pl_told_note(world, entity, function);
    }
}

#endif
