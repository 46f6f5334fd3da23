// destroy.h - destruction of entities of any kind.
#ifndef PL_DESTROY_H
#define PL_DESTROY_H

#include "world/state.h"

// The character of a body row; null: it is none.
pl_character *pl_character_of(const plumb_world *world, uint32_t row);
// The body of a row is about to be destroyed.
void pl_character_forget(plumb_world *world, uint32_t row);
// Destroys pieces, rows and components of an entity of any kind; the handle was checked.
void pl_destroy_entity(plumb_world *world, plumb_entity entity);

#endif
