// event.h - what events are made of: touches of parts, hits that wait, what sensors see.
#ifndef PL_TABLE_EVENT_H
#define PL_TABLE_EVENT_H

#include "plumb/event.h"
#include "world/tables/manifold.h"

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
    double moment;      // [s] since the step in which it is told began
} pl_pending_hit;

// Hits that began in a step and will be through in the next one.
typedef struct pl_pending_hits {
    pl_buffer items, old; // pl_pending_hit, in order of pairs: of this step, of the one before
    uint32_t count, old_count;
    uint32_t next; // where in `old` to look first
    // Hits told of pairs that have left the list: the first ones; of pairs that touch no more: their places are in
    // world->changed_pairs.
    uint32_t lost_count, late_count;
} pl_pending_hits;

// Which pairs touched each body when the step ended (contact_index.c).
typedef struct pl_contact_index {
    pl_buffer starts;    // uint32_t an entity slot and one more: where those of a body begin in `pairs`
    pl_buffer pairs;     // uint32_t: pairs, each body's in their order
    uint32_t slots;      // entity slots when it was made
    uint32_t asked;      // by bodies since the last step
    uint32_t pair_count; // of all pairs, when it was made
    bool made;
} pl_contact_index;

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

#endif
