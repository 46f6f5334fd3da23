// registry.c - see registry.h. A slot's generation counts its tenants, so that a handle outlives
// what it named by telling so. A slot whose generations are used up (after 2^32 - 1 tenants) is
// retired.
//
// Reads, writes: the registry alone. Cost: O(1), growth amortised.
#include "ecs/registry.h"

#include <string.h>

#define NO_SLOT        UINT32_MAX
#define FIRST_CAPACITY 16 // slots

void pl_registry_init(pl_registry *registry)
{
    *registry = (pl_registry){ .free_head = NO_SLOT, .free_tail = NO_SLOT };
}

void pl_registry_free(pl_memory *memory, pl_registry *registry)
{
    pl_resize(memory, registry->slots, registry->bytes, 0);
    pl_registry_init(registry);
}

bool pl_registry_reserve(pl_memory *memory, pl_registry *registry, uint32_t extra)
{
    // Free slots are not counted in: after a while there are enough of them, and no growth either.
    if (extra > NO_SLOT - registry->count) {
        return false;
    }
    uint32_t needed = registry->count + extra;
    if (needed <= registry->capacity) {
        return true;
    }
    uint32_t capacity = registry->capacity < NO_SLOT / 2 ? registry->capacity * 2 : NO_SLOT;
    capacity = capacity < FIRST_CAPACITY ? FIRST_CAPACITY : capacity;
    capacity = capacity < needed ? needed : capacity;
    size_t bytes = capacity * sizeof(pl_slot);
    pl_slot *slots = pl_resize(memory, registry->slots, registry->bytes, bytes);
    if (slots == NULL) {
        return false;
    }
    registry->slots = slots;
    registry->bytes = bytes;
    registry->capacity = capacity;
    return true;
}

static uint32_t take_slot(pl_registry *registry)
{
    uint32_t index = registry->free_head;
    if (index == NO_SLOT) {
        index = registry->count++;
        registry->slots[index] = (pl_slot){ .generation = 1 };
        return index;
    }
    registry->free_head = registry->slots[index].row;
    if (registry->free_head == NO_SLOT) {
        registry->free_tail = NO_SLOT;
    }
    return index;
}

plumb_entity pl_registry_acquire(pl_registry *registry, uint32_t kind, uint32_t row, uint32_t state)
{
    uint32_t index = take_slot(registry);
    pl_slot *slot = &registry->slots[index];
    slot->kind = kind;
    slot->row = row;
    slot->state = state;
    ++registry->live;
    return (plumb_entity){ index, slot->generation };
}

void pl_registry_release(pl_registry *registry, plumb_entity entity)
{
    pl_slot *slot = &registry->slots[entity.index];
    slot->kind = 0;
    slot->row = NO_SLOT;
    slot->state = PL_SLOT_FREE;
    --registry->live;
    if (++slot->generation == 0) {
        return; // retired: no handle can name it again
    }
    if (registry->free_tail == NO_SLOT) {
        registry->free_head = entity.index;
    } else {
        registry->slots[registry->free_tail].row = entity.index;
    }
    registry->free_tail = entity.index;
}

static pl_slot *find_in_state(const pl_registry *registry, plumb_entity entity, uint32_t state)
{
    if (entity.generation == 0 || entity.index >= registry->count) {
        return NULL;
    }
    pl_slot *slot = &registry->slots[entity.index];
    return slot->generation == entity.generation && slot->state == state ? slot : NULL;
}

pl_slot *pl_registry_find(const pl_registry *registry, plumb_entity entity)
{
    return find_in_state(registry, entity, PL_SLOT_LIVE);
}

pl_slot *pl_registry_find_pending(const pl_registry *registry, plumb_entity entity)
{
    return find_in_state(registry, entity, PL_SLOT_PENDING);
}
