// told.c - the last call that changed a body or joint, for the watchdog.
//
// Writes: world->watchdog. Cost: O(1); nobody calls it where nobody watches.
#include "world/told.h"

#include <string.h>

pl_watched *pl_watched_find(plumb_world *world, plumb_entity entity)
{
    pl_buffer *entities = &world->watchdog.entities;
    const size_t known = entities->size;
    if (!pl_buffer_reserve(&world->memory, entities,
                           ((size_t)entity.index + 1) * sizeof(pl_watched))) {
        return NULL;
    }
    memset((char *)entities->data + known, 0, entities->size - known);
    pl_watched *w = &pl_watched_entities(&world->watchdog)[entity.index];
    if (w->generation != entity.generation) {
        *w = (pl_watched){ .generation = entity.generation, .command = "" };
    }
    return w;
}

void pl_told_note(plumb_world *world, plumb_entity entity, const char *function)
{
    pl_watched *w = pl_watched_find(world, entity);
    if (w != NULL) {
        w->command = function;
        w->command_step = world->step_count;
        w->system = 0;
    }
}
