// component.h - components of a world: values with their hooks (component.c), and views over bodies.
#ifndef PL_WORLD_COMPONENT_H
#define PL_WORLD_COMPONENT_H

#include "ecs/component.h"

// True when some entity has the component (a null one: false).
bool pl_component_in_use(const plumb_world *world, plumb_component component);

// Gives or overwrites; the handles were checked. False when out of memory (nothing changed).
bool pl_component_put(plumb_world *world, plumb_entity entity, plumb_component component,
                      const void *value);
// Takes the component away, its hook first. False when the entity does not have it.
bool pl_component_drop(plumb_world *world, plumb_entity entity, plumb_component component);
// Takes all components of an entity away, in order of registration.
void pl_components_drop_all(plumb_world *world, plumb_entity entity);
// Runs the removal hooks of everything that is left, at the end of a world.
void pl_components_bury(plumb_world *world);

#endif
