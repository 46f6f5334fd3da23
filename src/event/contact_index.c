// contact_index.c - which pairs touch each body, so that who asks about many bodies does not go through all pairs for each.
//
// It is made at the end of a step in a world that was asked since the one before, and only then: asking is const, and may be done by
// several threads. It is keyed by entity slots, for rows change places between steps; who reads it looks whether a pair is still of
// the body and still touches. What edits between steps can do is end contacts, not begin them.
//
// Reads: pairs, pieces. Writes: world->contact_index. Cost: O(pairs + entities) a step, where it is made: as much as two or three
// questions without it.
#include "event/event.h"
#include "world/state.h"

#include <string.h>

#define ASKED_LEAST 3

void pl_contact_index_free(pl_memory *memory, pl_contact_index *index)
{
    pl_buffer_free(memory, &index->starts);
    pl_buffer_free(memory, &index->pairs);
    *index = (pl_contact_index){ 0 };
}

static uint32_t slot_of(const plumb_world *world, uint32_t piece)
{
    return world->bodies.entity[world->pieces.body[piece]].entity.index;
}

// A piece that went with the step, as one that broke, has no body.
static bool touches(const plumb_world *world, const pl_pair *pair)
{
    const uint8_t *kind = world->pieces.kind;
    return (pair->flags & PL_PAIR_TOUCHING) != 0 && kind[pair->a] != PL_PIECE_FREE &&
           kind[pair->b] != PL_PIECE_FREE;
}

static bool reserve(plumb_world *world, uint32_t touching)
{
    pl_contact_index *index = &world->contact_index;
    return pl_buffer_reserve(&world->memory, &index->starts,
                             ((size_t)index->slots + 1) * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &index->pairs,
                             2 * (size_t)touching * sizeof(uint32_t));
}

// Counting sort by slot; within a body in the order of the pairs.
static bool make(plumb_world *world)
{
    pl_contact_index *index = &world->contact_index;
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const uint32_t count = world->broad.pairs.count;
    uint32_t touching = 0;
    for (uint32_t i = 0; i < count; ++i) {
        touching += touches(world, &pairs[i]);
    }
    index->slots = world->registry.count;
    index->pair_count = count;
    if (!reserve(world, touching)) {
        return false;
    }
    uint32_t *ends = index->starts.data, *places = index->pairs.data;
    memset(ends, 0, ((size_t)index->slots + 1) * sizeof *ends);
    for (uint32_t i = 0; i < count; ++i) {
        if (touches(world, &pairs[i])) {
            ++ends[slot_of(world, pairs[i].a)];
            ++ends[slot_of(world, pairs[i].b)];
        }
    }
    for (uint32_t s = 1; s <= index->slots; ++s) {
        ends[s] += ends[s - 1];
    }
    // From behind, each end becomes the start of its own.
    for (uint32_t i = count; i-- > 0;) {
        if (touches(world, &pairs[i])) {
            places[--ends[slot_of(world, pairs[i].a)]] = i;
            places[--ends[slot_of(world, pairs[i].b)]] = i;
        }
    }
    return true;
}

void pl_contact_index_update(plumb_world *world)
{
    pl_contact_index *index = &world->contact_index;
    index->made = index->asked >= ASKED_LEAST && make(world);
    index->asked = 0;
}

bool pl_contact_index_of(const plumb_world *world, plumb_body body, const uint32_t **pairs,
                         uint32_t *count)
{
    const pl_contact_index *index = &world->contact_index;
    // What is asked is not the state of the world: the one member that a question writes.
    __atomic_fetch_add((uint32_t *)&index->asked, 1, __ATOMIC_RELAXED);
    if (!index->made || index->pair_count != world->broad.pairs.count) {
        return false;
    }
    const uint32_t slot = body.entity.index, *starts = index->starts.data;
    *pairs = index->pairs.data;
    *count = 0; // made since
    if (slot < index->slots) {
        *pairs += starts[slot];
        *count = starts[slot + 1] - starts[slot];
    }
    return true;
}
