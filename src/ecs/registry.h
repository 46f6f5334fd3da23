// registry.h - entity handles: slot, generation, and where the entity's row is. Knows no physics: kind
// and row are numbers to it. The free list is first in, first out and part of the state, so that the
// same calls give the same handles.
#ifndef PL_REGISTRY_H
#define PL_REGISTRY_H

#include "core/memory.h"

typedef struct pl_slot {
    uint32_t generation; // of the live entity, or of the next one while free
    uint32_t kind;       // 0: free; otherwise plumb_entity_kind
    uint32_t row;        // row in the table of its kind; next free slot while free
    uint32_t state;      // PL_SLOT_LIVE, PL_SLOT_PENDING (reserved by a command), PL_SLOT_FREE
} pl_slot;

enum { PL_SLOT_FREE, PL_SLOT_LIVE, PL_SLOT_PENDING };

typedef struct pl_registry {
    pl_slot *slots;
    size_t bytes;
    uint32_t count; // slots ever used
    uint32_t capacity;
    uint32_t free_head; // UINT32_MAX: none
    uint32_t free_tail;
    uint32_t live;  // slots taken, reserved ones included
    uint64_t moves; // counts the rows that changed place; not saved
} pl_registry;

void pl_registry_init(pl_registry *registry);
void pl_registry_free(pl_memory *memory, pl_registry *registry);

// Makes sure that the next `extra` acquisitions cannot fail.
bool pl_registry_reserve(pl_memory *memory, pl_registry *registry, uint32_t extra);
// Takes a slot (room must be reserved).
plumb_entity pl_registry_acquire(pl_registry *registry, uint32_t kind, uint32_t row,
                                 uint32_t state);
// The row of a live slot has changed.
static inline void pl_registry_move(pl_registry *registry, uint32_t slot, uint32_t row)
{
    registry->slots[slot].row = row;
    ++registry->moves;
}
void pl_registry_release(pl_registry *registry, plumb_entity entity);
// The slot of a handle when it is live, else NULL. O(1).
pl_slot *pl_registry_find(const pl_registry *registry, plumb_entity entity);
// The slot of a handle that a command has reserved and that is not alive yet, else NULL. O(1).
pl_slot *pl_registry_find_pending(const pl_registry *registry, plumb_entity entity);

#endif
