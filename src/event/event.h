// event.h - how the step makes events; the public readers are in api/event.c and sensor_events.c.
#ifndef PL_EVENT_H
#define PL_EVENT_H

#include "broad/broad.h"
#include "world/tables/event.h"

// Forgets the events of the step before.
void pl_events_clear(plumb_world *world);
// Ends the touch of a pair that leaves the list.
extern const pl_pair_listener pl_end_listener;
// Before the solver: room for all events of this step, approach speeds of pairs that did not touch.
bool pl_events_prepare(plumb_world *world);
// After the solver: begin, end and hit events. A step that only refreshes makes no hits, and ends none.
void pl_events_publish(plumb_world *world, bool refresh);

// [m/s] at which the points of a manifold approach each other, the fastest; by velocities as they are now.
real pl_approach_speed(const plumb_world *world, const pl_manifold *m);
// Where point j of a manifold meets: on the surface that no contact moves, or midway between the two as they were
// at the start of the step. [m]
plumb_vec2 pl_contact_place(const plumb_world *world, const pl_manifold *m, uint32_t j);

// Hits (hit_events.c). Room for `count` more, and for the hits that lasted beyond the step before.
bool pl_hits_reserve(plumb_world *world, uint32_t count);
// Before the pairs of a step are gone through, in their order.
void pl_hits_begin(plumb_world *world);
// Behind the last of them: of one pair of shapes one hit is left.
void pl_hits_end(plumb_world *world);
// Whether the hit of a pair that touches, or did, is to be told, with the manifold's `approach` and `hit_impulse`.
bool pl_hit_is_due(plumb_world *world, pl_pair *pair, bool touches);
void pl_hit_append(plumb_world *world, const pl_pair *pair, real impulse);
// A pair left the list: tells the hit that lasted. Room must be reserved.
void pl_hit_lost(plumb_world *world, const pl_pair *pair, plumb_contact_end who);

void pl_parts_free(pl_memory *memory, pl_parts *parts);
void pl_pending_hits_free(pl_memory *memory, pl_pending_hits *hits);

// Before anything has moved: candidates and room for what may come. False when out of memory.
bool pl_sensing_prepare(plumb_world *world);
// After the bodies have moved: overlaps and sensor events.
void pl_sensing_run(plumb_world *world);
void pl_sensing_free(pl_memory *memory, pl_sensing *sensing);

// Which contacts each body has, for plumb_body_contacts (contact_index.c). A world that has been asked about several bodies since the
// last step gets it with the next one; without it all pairs are gone through.
void pl_contact_index_update(plumb_world *world);
// The pairs that may touch a body; their number; false: it does not know.
bool pl_contact_index_of(const plumb_world *world, plumb_body body, const uint32_t **pairs,
                         uint32_t *count);
void pl_contact_index_free(pl_memory *memory, pl_contact_index *index);

// Bodies that break (breaking.c): room for those of a step; after motion, who breaks, and what of the blow it gives back.
bool pl_breaking_prepare(plumb_world *world);
void pl_breaking_find(plumb_world *world, plumb_real dt);

// Contact systems are about to run, have run: edits are allowed in between (contact_edit.c).
void pl_edits_open(plumb_world *world);
// What was edited in the step before no longer holds.
void pl_edits_forget(plumb_world *world);
void pl_edits_close(plumb_world *world);

#endif
