// character.h - a character as it is stored, and what the step calls.
#ifndef PL_CHARACTER_H
#define PL_CHARACTER_H

#include "world/tables/character.h"

// Unit, the way up for it.
plumb_vec2 pl_character_up(const plumb_world *world, const pl_character *c, uint32_t row);
void pl_characters_free(pl_memory *memory, pl_characters *characters);

// Before the broad phase: velocities of kinematic characters, forces on dynamic ones. False when out
// of memory.
bool pl_characters_move(plumb_world *world, real dt);
// After the narrow phase: dynamic characters walk by force, not by friction; kinematic ones weigh on
// dynamic bodies as much as they weigh, not like a mountain.
void pl_characters_feet(plumb_world *world);
// The step was refused: everything as before it.
void pl_characters_undo(plumb_world *world);

#endif
