// component.h - user components: a sparse set each (dense values and owners, entity slot -> dense row).
#ifndef PL_COMPONENT_H
#define PL_COMPONENT_H

#include "core/digest.h"
#include "core/memory.h"
#include "plumb/ecs.h"

#define PL_COMPONENT_MAX 256
#define PL_NAME_MAX      64

typedef struct pl_component {
    char name[PL_NAME_MAX];
    plumb_component_desc desc; // name and fields point to copies
    plumb_field *fields;       // names copied behind the array in the same block
    size_t fields_bytes;
    uint32_t count;
    pl_buffer values; // count * stride bytes
    pl_buffer owners; // count entities
    pl_buffer rows;   // entity slot -> dense row + 1, 0: absent
} pl_component;

typedef struct pl_components {
    pl_component *items;
    size_t bytes;
    uint32_t count;
} pl_components;

void pl_components_free(pl_memory *memory, pl_components *components);

// True when some entity has the component (a null one: false).
bool pl_component_in_use(const plumb_world *world, plumb_component component);

// Gives or overwrites; the handles were checked. False when out of memory (nothing changed).
bool pl_component_put(plumb_world *world, plumb_entity entity, plumb_component component,
                      const void *value);
// Takes the component away, its hook first. False when the entity does not have it.
bool pl_component_drop(plumb_world *world, plumb_entity entity, plumb_component component);
// Takes all components of an entity away, in order of registration.
void pl_components_drop_all(plumb_world *world, plumb_entity entity);
// Adds a value to the world hash: its fields, or its bytes where none were told.
void pl_component_digest(const pl_component *component, const char *value, pl_digest *digest);
// Runs the removal hooks of everything that is left, at the end of a world.
void pl_components_bury(plumb_world *world);

#endif
