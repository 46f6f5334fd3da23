// run.h - faces of ground that go on flat from piece to piece bear what lies on them as one.
#ifndef PL_RUN_H
#define PL_RUN_H

#include "internal_edges/view.h"

// Before the contacts of a step: none is in a run. False when out of memory.
bool pl_runs_open(plumb_world *world);
// Makes room for one more contact. False when out of memory: none is in a run.
bool pl_runs_make_room(plumb_world *world);
// Adds the contact of entry `index` of the list of pairs with internal edges, if the ground of this view has such a face there;
// there is room for it. False: it has none.
bool pl_runs_add(plumb_world *world, uint32_t index, pl_view *v);
// Joins what was added into runs and gives each to one of its contacts. False when out of memory.
bool pl_runs_join(plumb_world *world, double dt);
// Pairs have moved in the list: see pl_internal_edges_follow.
void pl_runs_follow(plumb_world *world, const uint32_t *places);
// The loads as they were when the step began.
void pl_runs_undo(pl_internal_edges *edges);

#endif
