// event.h - how the step makes events; the public readers are in world/event.c and sensor_events.c.
#ifndef PL_EVENT_H
#define PL_EVENT_H

#include "narrow/manifold.h"
#include "plumb/event.h"

// Touches of pairs of which a piece is only a part of its shape: told once a pair of shapes.
typedef struct pl_parts {
    pl_buffer items; // pl_keyed: slots of the two shapes, what happened to a pair of pieces
    uint32_t count;
    pl_buffer lost; // plumb_contact_end: who they were, of pairs that have left the list
    uint32_t lost_count;
    bool buried; // a piece that was a part went since the pair list was made
} pl_parts;

// A contact that is made in the last substep of a step may only be slowed down there, to meet in the
// next one: such a hit is told a step later, as a whole.
typedef struct pl_pending_hit {
    uint32_t a, b;      // pieces of the pair
    near_real approach; // [m/s]
    near_real impulse;  // [N s]
    near_real nx, ny;   // unit, from A to B
    plumb_vec2 at;      // [m]
} pl_pending_hit;

// Hits that began in a step and will be through in the next one.
typedef struct pl_pending_hits {
    pl_buffer items, old; // pl_pending_hit, in order of pairs: of this step, of the one before
    uint32_t count, old_count;
    uint32_t next; // where in `old` to look first
} pl_pending_hits;

typedef struct pl_overlap {
    uint64_t key; // slots of sensor and shape
    plumb_sensor_event who;
} pl_overlap;

// Who a piece was that went since the pair list was made: what touched it still has to be told.
typedef struct pl_tombstone {
    plumb_shape shape;
    plumb_body body;
    uint32_t epoch; // 1 + rebuilds of the pair list when it went; 0: never
    uint32_t flags; // PL_PIECE_...
} pl_tombstone;

// What sensors see (sensor_events.c).
typedef struct pl_sensing {
    pl_buffer candidates; // pl_keyed: slots of sensor and shape; pieces. Sorted
    uint32_t candidate_count;
    uint64_t rebuilds;       // those of the broad phase when the candidates were listed
    pl_buffer overlaps, old; // pl_overlap, sorted: after the last step, after the one before
    uint32_t count, old_count;
    // Pairs of which neither moves: looked for only in steps in which one falls asleep, wakes, is placed
    // or goes.
    pl_buffer rest_candidates; // as candidates
    uint32_t rest_candidate_count;
    pl_buffer rest_overlaps, rest_old;
    uint32_t rest_count, rest_old_count;
    bool rest_stale;
    pl_buffer begins, ends; // plumb_sensor_event
    int begin_count, end_count;
} pl_sensing;

// Forgets the events of the step before.
void pl_events_clear(plumb_world *world);
// Room for `count` more end events. False when out of memory.
bool pl_events_reserve_ends(plumb_world *world, uint32_t count);
// A pair left the list: ends its touch. Room must be reserved.
void pl_pair_lost(plumb_world *world, const pl_pair *pair);
// Room for the tombstones of `slots` piece slots.
bool pl_tombstones_reserve(plumb_world *world, uint32_t slots);
// A piece goes: keeps who it was if a pair may name it. Its slot and body are still as they were.
void pl_tombstone_set(plumb_world *world, uint32_t piece);
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
// Whether the hit of a pair that touches, or did, is to be told, with the manifold's `approach` and `hit_impulse`.
bool pl_hit_is_due(plumb_world *world, pl_pair *pair, bool touches);
void pl_hit_append(plumb_world *world, const pl_pair *pair, real impulse);
// A pair left the list: tells the hit that lasted. Room must be reserved.
void pl_hit_lost(plumb_world *world, const pl_pair *pair, plumb_contact_end who);

// Room for `count` more pairs of pieces that are parts; nothing where there are none.
bool pl_parts_reserve(plumb_world *world, uint32_t count);
void pl_parts_free(pl_memory *memory, pl_parts *parts);
void pl_pending_hits_free(pl_memory *memory, pl_pending_hits *hits);

// Before anything has moved: candidates and room for what may come. False when out of memory.
bool pl_sensing_prepare(plumb_world *world);
// After the bodies have moved: overlaps and sensor events.
void pl_sensing_run(plumb_world *world);
// Something static or asleep came, went or moved.
void pl_sensing_note_rest(plumb_world *world);
void pl_sensing_free(pl_memory *memory, pl_sensing *sensing);

// Contact systems are about to run, have run: edits are allowed in between (contact_edit.c).
void pl_edits_open(plumb_world *world);
// What was edited in the step before no longer holds.
void pl_edits_forget(plumb_world *world);
void pl_edits_close(plumb_world *world);

#endif
