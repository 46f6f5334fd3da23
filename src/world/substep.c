// substep.c - which part of a list is of a cluster: lists of effects and systems are by rising slot, as clusters are.
//
// Reads: the list. Cost: O(log records).
#include "world/substep.h"

#include <string.h>

static uint32_t slot_at(const void *records, size_t size, size_t offset, uint32_t i)
{
    uint32_t slot;
    memcpy(&slot, (const char *)records + size * i + offset, sizeof slot);
    return slot;
}

// The first record whose slot is not below.
static uint32_t first_at(const void *records, size_t size, size_t offset, uint32_t count,
                         uint32_t slot)
{
    uint32_t low = 0, high = count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (slot_at(records, size, offset, middle) < slot) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

pl_share pl_substep_share(const void *records, size_t size, size_t offset, uint32_t count,
                          const pl_substep *s)
{
    const pl_slots slots = s->cluster->slots[0];
    return (pl_share){ first_at(records, size, offset, count, slots.first),
                       first_at(records, size, offset, count, slots.first + slots.count) };
}
