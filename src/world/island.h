// island.h - islands asleep as lists, and the changes that make one due to wake.
#ifndef PL_ISLAND_H
#define PL_ISLAND_H

#include "world/state.h"

//---- changes that wake (disturb.c) -----------------------------------------------------------------
//
// They only take down that an island is due: rows do not move before the next step. For bodies that
// are awake, the time of rest begins anew.

// The body of a row was changed in what it is or where: it wakes, or what touches it when it is
// immovable. A body made asleep sleeps on until a step has seen it.
void pl_sleep_disturb(plumb_world *world, uint32_t row);
// The same of a piece and its body.
void pl_sleep_disturb_piece(plumb_world *world, uint32_t piece);
// A shape, known by its first piece, comes or goes: what touches another shape of a static body sleeps on.
void pl_sleep_disturb_shape(plumb_world *world, uint32_t first);
// What sleeps in a piece of a volume of fluid; nothing of another piece.
void pl_sleep_wake_swimmers(plumb_world *world, uint32_t piece);
// The body of a row was set in motion.
void pl_sleep_stir(plumb_world *world, uint32_t row);
// All bodies.
void pl_sleep_disturb_all(plumb_world *world);
// A static or kinematic piece is about to go, or its filter was changed.
void pl_sleep_void_contacts(plumb_world *world, uint32_t piece);
void pl_sleep_see_anew(plumb_world *world, uint32_t piece);
// A body is about to be destroyed.
void pl_sleep_forget(plumb_world *world, uint32_t row);

//---- islands (island.c) -----------------------------------------------------------------------------

// Makes the new body of a row of the sleeping partition an island (room must be reserved).
void pl_sleep_make(plumb_world *world, uint32_t row);
// It was made asleep, and no step has seen it yet.
bool pl_row_is_furnished(const plumb_world *world, uint32_t row);
// Room for so many more islands, contacts and events of falling asleep.
bool pl_islands_reserve(plumb_world *world, uint32_t islands, uint32_t contacts);
// A new island without bodies (room must be reserved).
uint32_t pl_island_open(plumb_world *world);
// Adds the body of a row to the end of its list.
void pl_island_add(plumb_world *world, uint32_t island, uint32_t row);
void pl_island_remove(plumb_world *world, uint32_t row);
// Keeps a pair as a contact of an island (room must be reserved); manifold NULL: it has none. `steps`: a
// step runs, and the manifold is its own; else that of the step before, which a restore forgets.
void pl_island_keep(plumb_world *world, uint32_t island, const pl_pair *pair,
                    const pl_manifold *manifold, bool steps);
// Gives contacts and slot back; its bodies have been taken out.
void pl_island_close(plumb_world *world, uint32_t island);
// It wakes in the next step.
void pl_island_make_due(plumb_world *world, uint32_t island);
// It is not due any more, and nothing pushes its bodies. False when out of memory: it is as it was.
bool pl_island_calm(plumb_world *world, uint32_t island);
// Both pieces of a contact are those that it was made for.
bool pl_sleeping_contact_is_intact(const plumb_world *world, const pl_sleeping_contact *contact);
// Moves the body of a row between the partitions, and its pieces between lists. At most two other
// rows move. Returns the new row.
uint32_t pl_sleep_put_down(plumb_world *world, uint32_t row);
uint32_t pl_sleep_take_up(plumb_world *world, uint32_t row);

#endif
