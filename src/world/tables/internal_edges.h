// internal_edges.h - what neighbours cover of edges, and narrow at corners; loads of runs.
#ifndef PL_TABLE_INTERNAL_EDGES_H
#define PL_TABLE_INTERNAL_EDGES_H

#include "core/memory.h"
#include "world/columns.h"

// Piece column internal_corners: bit k: neighbours narrow what corner k allows.
#define PL_EDGE_CORNERS UINT32_C(0xffff)

#define PL_EDGE_ANY UINT32_C(0x20000000) // some corner is narrowed, or some edge covered

#define PL_EDGE_FLAT UINT32_C(0x10000000) // the ground goes on flat at some corner

#define PL_EDGE_STALE UINT32_C(0x80000000) // the piece is new, moved or changed

#define PL_EDGE_CHOSEN UINT32_C(0x40000000) // in the list of an update that runs

// Piece column internal_edges: bit k: edge k is covered from end to end; bit 16 + k: in part.
#define PL_EDGE_COVERED(k) (UINT32_C(1) << (k))

#define PL_EDGE_PARTLY(k) (UINT32_C(0x10000) << (k))

// What the ground does at an end of an edge.
typedef enum pl_edge_end {
    PL_END_OUTER, // the outline turns away: nothing lies beyond
    PL_END_FLAT,  // it goes on as it is
    PL_END_INNER  // it turns towards the front: something stands there
} pl_edge_end;

// A covered stretch of an edge.
typedef struct pl_interval {
    real from, to; // [m] from the start of the edge
} pl_interval;

// A corner and the edge that starts there; index as in the vertex pool. Normals are in the body's
// frame. Valid where a bit of the piece says so.
typedef struct pl_edge {
    real lo_x, lo_y, hi_x, hi_y;
    real walls[2][2]; // normals of what stands here in front of the edge that ends, and that starts
    real slop;        // [m] largest with which a neighbour touched the corner
    uint8_t form;     // pl_cone_form
    uint8_t ends[2];  // pl_edge_end of the edge that ends here, and of the one that starts
    bool flat;        // the ground goes on flat: see pl_cone_is_flat
    uint32_t intervals; // first covered stretch, sorted
    uint32_t interval_count;
} pl_edge;

// A pair one of whose pieces has internal edges, with what it kept from the last step.
typedef struct pl_edge_pair {
    uint32_t pair;
    uint32_t feature[2];
    near_real normal[2], tangent[2];
    near_real rolling;
    uint32_t a, b;     // its pieces
    uint32_t manifold; // PL_NONE: it was apart
    uint32_t borne;    // PL_PAIR_BORNE if it was
} pl_edge_pair;

// What the owner of a run of flush faces bore in the last step, by the mover's piece and the ground (run.c).
typedef struct pl_run_load {
    uint32_t mover, serial, next, pair;
    plumb_entity ground; // the body; null: all static ones, which are one
    uint32_t feature[2];
    near_real normal[2], tangent[2];
    near_real rolling;
    near_real nx, ny;
} pl_run_load;

#define PL_INTERVAL_CLASSES 32 // runs of 1, 2, 4, ... intervals

typedef struct pl_internal_edges {
    uint32_t count;         // pieces that have internal edges
    bool dirty;             // some piece is stale, or a region changed
    bool all;               // everything must be looked at again
    bool relist;            // the list of pairs is out of date
    pl_buffer corners;      // pl_edge a corner of the pool
    uint32_t corner_count;  // of those made so far; 0 where no piece has internal edges
    pl_buffer intervals;    // pl_interval
    uint32_t interval_used; // handed out, free runs included
    uint32_t interval_free
        [PL_INTERVAL_CLASSES]; // first interval of a free run + 1, whose bytes hold the next
    pl_buffer regions;         // pl_box: where static pieces went away
    uint32_t region_count;
    pl_buffer chosen; // uint32_t pieces to look at
    uint32_t chosen_count;
    pl_buffer around; // uint32_t neighbours of the piece that is looked at
    uint32_t around_count;
    pl_buffer scratch; // pl_interval: what they cover
    pl_buffer pairs;   // pl_edge_pair
    uint32_t pair_count;
    // Runs of flush faces (run.c): contacts of the step, and what the owners bore in the last one.
    pl_buffer contacts, runs, order, loads, old_loads, slots, borne;
    uint32_t contact_count, load_count, old_load_count, slot_count;
    bool noted;       // in this step: what the pairs had is in `pairs`
    bool opened;      // in this step: loads were swapped
    bool apart;       // each tile keeps its own contact: systems look at them
    uint64_t listed;  // broad->rebuilds when the pairs were listed
    uint64_t updated; // pieces looked at so far: what changes cost
} pl_internal_edges;

static inline bool pl_piece_has_internal_edges(const pl_pieces *pieces, uint32_t piece)
{
    return (pieces->internal_corners[piece] & PL_EDGE_ANY) != 0;
}

static inline pl_edge *pl_edge_items(const pl_internal_edges *edges)
{
    return (pl_edge *)edges->corners.data;
}

static inline pl_interval *pl_edge_intervals(const pl_internal_edges *edges)
{
    return (pl_interval *)edges->intervals.data;
}

#endif
