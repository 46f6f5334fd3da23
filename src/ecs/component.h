// component.h - user components: a sparse set each (dense values and owners, entity slot -> dense row).
//
// Knows no physics: where a body row is, it asks the registry; who runs hooks is the world's business
// (world/component.c).
#ifndef PL_COMPONENT_H
#define PL_COMPONENT_H

#include "core/digest.h"
#include "core/sort.h"
#include "ecs/registry.h"
#include "plumb/ecs.h"

#define PL_COMPONENT_MAX 256
#define PL_NAME_MAX      64
#define PL_ABSENT        UINT32_MAX // no value; no row

// When something was derived from the order of values and of rows.
typedef struct pl_seen {
    uint64_t version; // of the component, + 1; 0: never
    uint64_t moves;   // of the registry
} pl_seen;

typedef struct pl_component {
    char name[PL_NAME_MAX];
    plumb_component_desc desc; // name and fields point to copies
    plumb_field *fields;       // names copied behind the array in the same block
    size_t fields_bytes;
    uint32_t count;
    pl_buffer values; // count * stride bytes
    pl_buffer owners; // count entities
    pl_buffer rows;   // entity slot -> dense row + 1, 0: absent

    // Scratch: what follows from values, owners and registry.
    uint64_t version; // counts the changes of which value lies where
    pl_seen aligned;  // when values were put in the order of rows
    pl_buffer order;  // uint32_t: permutation of the values
    pl_seen viewed;   // when the runs were made
    pl_buffer runs;   // pl_keyed: see view.h
    uint32_t run_count;
} pl_component;

typedef struct pl_components {
    pl_component *items;
    size_t bytes;
    uint32_t count;
} pl_components;

void pl_components_free(pl_memory *memory, pl_components *components);

// NULL for a handle that is none.
pl_component *pl_component_find(const pl_components *components, plumb_component component);
// Stores a checked descriptor. Null when out of memory.
plumb_component pl_component_register(pl_memory *memory, pl_components *components,
                                      const plumb_component_desc *desc);

// Place of an entity slot's value, PL_ABSENT without. O(1).
uint32_t pl_component_place(const pl_component *component, uint32_t slot);

static inline char *pl_component_value(const pl_component *component, uint32_t place)
{
    return (char *)component->values.data + (size_t)place * component->desc.size;
}

static inline plumb_entity *pl_component_owners(const pl_component *component)
{
    return (plumb_entity *)component->owners.data;
}

// Gives a value to an entity that has none, zeros for NULL; it may be one of this very column. Returns its
// place, PL_ABSENT when out of memory (nothing changed).
uint32_t pl_component_append(pl_memory *memory, pl_component *component, plumb_entity entity,
                             const void *value);
void pl_component_write(const pl_component *component, uint32_t place, const void *value);
// Takes the value at a place away; the last one fills the gap.
void pl_component_erase(pl_component *component, uint32_t place);

bool pl_components_align(pl_memory *memory, pl_components *components, const pl_registry *registry,
                         uint32_t kind);

// Adds a value to the world hash: its fields, or its bytes where none were told.
void pl_component_digest(const pl_component *component, const char *value, pl_digest *digest);

// Row of an owner, PL_ABSENT where it is of another kind.
static inline uint32_t pl_row_of_kind(const pl_registry *registry, plumb_entity owner,
                                      uint32_t kind)
{
    const pl_slot *slot = &registry->slots[owner.index];
    return slot->kind == kind ? slot->row : PL_ABSENT;
}

static inline bool pl_is_seen(pl_seen seen, const pl_component *component,
                              const pl_registry *registry)
{
    return seen.version == component->version + 1 && seen.moves == registry->moves;
}

static inline pl_seen pl_see(const pl_component *component, const pl_registry *registry)
{
    return (pl_seen){ component->version + 1, registry->moves };
}

#endif
