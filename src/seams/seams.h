// seams.h - where pieces of ground lie side by side: which edges are covered, which normals the
// corners admit. README.md has the definitions and the derivation.
#ifndef PL_SEAMS_H
#define PL_SEAMS_H

#include "core/memory.h"
#include "narrow/manifold.h"
#include "world/columns.h"

// [m] pieces nearer than this touch, and steps lower than this are none; at most a hundredth of the
// thinner piece, and more by the rounding of the positions.
#define PL_SEAM_SLOP 1e-3
// [rad] bends of less count as flat.
#define PL_SEAM_ANGLE 1e-3

// [rad] normals that differ by less are equal: rounding, above all of kernels that find a normal from
// points. What lies on flat ground gets its exact normal afterwards (run.c).
#define PL_SAME_DIRECTION 1e-5

// Piece column seam_corners: bit k: neighbours narrow what corner k admits.
#define PL_SEAM_CORNERS UINT32_C(0xffff)
#define PL_SEAM_HAS     UINT32_C(0x20000000) // some corner is narrowed, or some edge covered
#define PL_SEAM_FLAT    UINT32_C(0x10000000) // the ground goes on flat at some corner
#define PL_SEAM_STALE   UINT32_C(0x80000000) // the piece is new, moved or changed
#define PL_SEAM_CHOSEN  UINT32_C(0x40000000) // in the list of an update that runs
// Piece column seam_edges: bit k: edge k is covered from end to end; bit 16 + k: in part.
#define PL_SEAM_COVERED(k) (UINT32_C(1) << (k))
#define PL_SEAM_PARTLY(k)  (UINT32_C(0x10000) << (k))

// What the ground does at an end of an edge.
typedef enum pl_edge_end {
    PL_END_OUTER, // the outline turns away: nothing lies beyond
    PL_END_FLAT,  // it goes on as it is
    PL_END_INNER  // it turns towards the front: something stands there
} pl_edge_end;

// A covered stretch of an edge.
typedef struct pl_span {
    real from, to; // [m] from the start of the edge
} pl_span;

// A corner and the edge that starts there; index as in the vertex pool. Normals are in the body's
// frame. Valid where a bit of the piece says so.
typedef struct pl_seam {
    real lo_x, lo_y, hi_x, hi_y;
    real walls[2][2]; // normals of what stands here in front of the edge that ends, and that starts
    real slop;        // [m] largest with which a neighbour touched the corner
    uint8_t form;     // pl_cone_form
    uint8_t ends[2];  // pl_edge_end of the edge that ends here, and of the one that starts
    bool flat;        // the ground goes on flat: see pl_cone_is_flat
    uint32_t spans;   // first covered stretch, sorted
    uint32_t span_count;
} pl_seam;

// A pair one of whose pieces has seams, with what it kept from the last step.
typedef struct pl_seam_pair {
    uint32_t pair;
    uint32_t feature[2];
    near_real normal[2], tangent[2];
    near_real rolling;
    uint32_t a, b;     // its pieces
    uint32_t manifold; // PL_NONE: it was apart
} pl_seam_pair;

// What the owner of a run of flush faces bore in the last step, by the mover's piece (run.c).
typedef struct pl_run_load {
    uint32_t mover, serial, next, pair;
    uint32_t feature[2];
    near_real normal[2], tangent[2];
    near_real rolling;
    near_real nx, ny;
} pl_run_load;

#define PL_SPAN_CLASSES 32 // runs of 1, 2, 4, ... spans

typedef struct pl_seams {
    uint32_t count;                      // pieces that have seams
    bool dirty;                          // some piece is stale, or a region changed
    bool all;                            // everything must be looked at again
    bool relist;                         // the list of pairs is out of date
    pl_buffer corners;                   // pl_seam a corner of the pool
    uint32_t corner_count;               // of those made so far; 0 where no piece has seams
    pl_buffer spans;                     // pl_span
    uint32_t span_used;                  // handed out, free runs included
    uint32_t span_free[PL_SPAN_CLASSES]; // first span of a free run + 1, whose bytes hold the next
    pl_buffer regions;                   // pl_box: where static pieces went away
    uint32_t region_count;
    pl_buffer chosen; // uint32_t pieces to look at
    uint32_t chosen_count;
    pl_buffer around; // uint32_t neighbours of the piece that is looked at
    uint32_t around_count;
    pl_buffer scratch; // pl_span: what they cover
    pl_buffer pairs;   // pl_seam_pair
    uint32_t pair_count;
    // Runs of flush faces (run.c): contacts of the step, and what the owners bore in the last one.
    pl_buffer contacts, runs, order, loads, old_loads, slots, borne;
    uint32_t contact_count, load_count, old_load_count, slot_count;
    bool noted;       // in this step: what the pairs had is in `pairs`
    bool opened;      // in this step: loads were swapped
    bool apart;       // each tile keeps its own contact: systems look at them
    uint64_t listed;  // broad->rebuilds when the pairs were listed
    uint64_t updated; // pieces looked at so far: what changes cost
} pl_seams;

//---- what happened to pieces (seams.c) -------------------------------------------------------------

// The piece is new, has moved, or meets others than before.
void pl_seams_touch(plumb_world *world, uint32_t piece);
// The same of every piece of a shape, and of a body if it is static.
void pl_seams_touch_shape(plumb_world *world, uint32_t first);
void pl_seams_touch_static(plumb_world *world, uint32_t row);
// The piece is about to go or to be moved from where it lies.
void pl_seams_leave(plumb_world *world, uint32_t piece);
// The same of every piece of a body that has been moved, if it is static; its boxes still tell where
// it lay.
void pl_seams_move_static(plumb_world *world, uint32_t row);
// The piece's slot is about to be freed.
void pl_seams_forget(plumb_world *world, uint32_t piece);

bool pl_piece_is_static(const plumb_world *world, uint32_t piece);

//---- passes ----------------------------------------------------------------------------------------

bool pl_seams_wanted(const plumb_world *world, const char **reason);
// Looks again at pieces that changed and at their neighbours, and notes what pairs with seams keep.
// After the broad phase. False when out of memory.
bool pl_seams_update(plumb_world *world);
// Gives pairs and loads back what they had when a step began that is refused.
void pl_seams_undo(plumb_world *world);
// The same behind a step of dt 0, whose contacts stay: only their impulses are again as before.
void pl_seams_give_back(plumb_world *world);
// Sets manifolds right whose normals the ground does not admit (correct.c). After the narrow phase. False
// when out of memory; the next step makes manifolds anew.
bool pl_seams_correct(plumb_world *world, real dt);

// Pairs of what fell asleep have left the list: `places` tells where each of the others now is (PL_NONE:
// it has left). Manifolds whose load others bear lie from `borne` on; those that stay close up to the rest.
void pl_seams_follow(plumb_world *world, const uint32_t *places, uint32_t borne);

// Notes what runs of flush faces bear, for the next step. After the solver.
void pl_seams_remember(plumb_world *world);

// Whether a contact touches whose load another bears.
bool pl_seams_borne_touches(const plumb_world *world, const pl_manifold *m);

void pl_seams_free(pl_memory *memory, pl_seams *seams);

//---- questions (admit.c) ---------------------------------------------------------------------------

// Whether ground admits the outward unit normal (nx, ny), in world axes: at the corner of the piece
// that lies farthest that way, or, where the normal is that of an edge, at the point (x, y) of it,
// [m] in world axes from the origin of the piece's body. True for pieces without seams. A contact or
// an impact whose normal is not admitted is not one of the ground; a neighbour has the true one.
bool pl_seams_admit(const plumb_world *world, uint32_t piece, double nx, double ny, double x,
                    double y);

static inline bool pl_piece_has_seams(const pl_pieces *pieces, uint32_t piece)
{
    return (pieces->seam_corners[piece] & PL_SEAM_HAS) != 0;
}

static inline pl_seam *pl_seam_items(const pl_seams *seams)
{
    return (pl_seam *)seams->corners.data;
}

static inline pl_span *pl_seam_spans(const pl_seams *seams)
{
    return (pl_span *)seams->spans.data;
}

#endif
