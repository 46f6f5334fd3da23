// marks.c - what a change of pieces leaves for the next step to see: who went, what sensors have to look at anew.
//
// Reads: pieces. Writes: tombstones, flags of sensing, room for pieces that leave their boxes. Cost: O(1).
#include "world/marks.h"

#include <string.h>

// One a slot is enough: a piece that is younger than the pair list is in no pair.
bool pl_tombstones_reserve(plumb_world *world, uint32_t slots)
{
    size_t old = world->tombstones.size;
    if (!pl_buffer_reserve(&world->memory, &world->tombstones, slots * sizeof(pl_tombstone))) {
        return false;
    }
    if (world->tombstones.size > old) {
        memset((char *)world->tombstones.data + old, 0, world->tombstones.size - old);
    }
    return true;
}

void pl_tombstone_set(plumb_world *world, uint32_t piece)
{
    const pl_pieces *p = &world->pieces;
    if (p->serial[piece] <= world->broad.serial) {
        ((pl_tombstone *)world->tombstones.data)[piece] =
            (pl_tombstone){ .shape = p->shape[piece],
                            .body = world->bodies.entity[p->body[piece]],
                            .epoch = (uint32_t)world->broad.rebuilds + 1,
                            .flags = p->flags[piece] };
        world->parts.buried |= (p->flags[piece] & PL_PIECE_PART) != 0;
    }
}

void pl_sensing_note_rest(plumb_world *world)
{
    pl_sensing *s = &world->sensing;
    if (!s->rest_stale && (world->sensor_pieces > 0 || s->rest_count > 0)) {
        s->rest_stale = true;
        world->schedule_dirty = true;
    }
}

bool pl_broad_reserve_left(plumb_world *world, uint32_t slots)
{
    pl_broad *broad = &world->broad;
    size_t old = broad->left_marks.size;
    if (!pl_buffer_reserve(&world->memory, &broad->left, slots * sizeof(uint32_t)) ||
        !pl_buffer_reserve(&world->memory, &broad->left_marks, slots)) {
        return false;
    }
    if (broad->left_marks.size > old) {
        memset((char *)broad->left_marks.data + old, 0, broad->left_marks.size - old);
    }
    return true;
}

void pl_quarantine_tell(plumb_world *world, uint32_t row, const char *pass)
{
    pl_quarantine *q = &world->quarantine;
    const pl_bodies *b = &world->bodies;
    ++world->arrested_count;
    if (q->event_count < PLUMB_QUARANTINE_MAX) {
        q->events[q->event_count++] = (plumb_quarantine){ .body = b->entity[row], .pass = pass };
    }
    pl_warn(world, "body %u:%u was taken out: %s would have left it without a finite state",
            (unsigned)b->entity[row].entity.index, (unsigned)b->entity[row].entity.generation,
            pass);
}

void pl_quarantine_note_lost(plumb_world *world, uint32_t row)
{
    pl_quarantine_tell(world, row, "motion");
    world->quarantine.lost = true;
}
