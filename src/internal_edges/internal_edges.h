// internal_edges.h - where pieces of ground lie side by side: which edges are covered, which normals the
// corners allow. README.md has the definitions and the derivation.
#ifndef PL_INTERNAL_EDGES_H
#define PL_INTERNAL_EDGES_H

#include "world/tables/internal_edges.h"
#include "world/tables/manifold.h"

// [m] pieces nearer than this touch, and steps lower than this are none; at most a hundredth of the
// thinner piece, and more by the rounding of the positions.
#define PL_EDGE_SLOP 1e-3
// [rad] bends of less count as flat.
#define PL_EDGE_ANGLE 1e-3

// [rad] normals that differ by less are equal: rounding, above all of kernels that find a normal from
// points. What lies on flat ground gets its exact normal afterwards (run.c).
#define PL_SAME_DIRECTION 1e-5

//---- passes ----------------------------------------------------------------------------------------

bool pl_internal_edges_wanted(const plumb_world *world, const char **reason);
// Looks again at pieces that changed and at their neighbours, and notes what pairs with internal edges keep.
// After the broad phase. False when out of memory.
bool pl_internal_edges_update(plumb_world *world);
// Gives pairs and loads back what they had when a step began that is refused.
void pl_internal_edges_undo(plumb_world *world);
// The same behind a step of dt 0, whose contacts stay: only their impulses are again as before.
void pl_internal_edges_give_back(plumb_world *world);
// Sets manifolds right whose normals the ground does not allow (correct.c). After the narrow phase. False
// when out of memory; the next step makes manifolds anew.
bool pl_internal_edges_correct(plumb_world *world, real dt);

// Pairs of what fell asleep have left the list: `places` tells where each of the others now is (PL_NONE:
// it has left). Manifolds whose load others bear lie from `borne` on; those that stay close up to the rest.
void pl_internal_edges_follow(plumb_world *world, const uint32_t *places, uint32_t borne);

// Notes what runs of flush faces bear, for the next step. After the solver.
void pl_internal_edges_remember(plumb_world *world);

// Whether a contact touches whose load another bears.
bool pl_internal_edges_borne_touches(const plumb_world *world, const pl_manifold *m);

void pl_internal_edges_free(pl_memory *memory, pl_internal_edges *edges);

//---- questions (side.c) ---------------------------------------------------------------------------

// Whether ground allows the outward unit normal (nx, ny), in world axes: at the corner of the piece
// that lies farthest that way, or, where the normal is that of an edge, at the point (x, y) of it,
// [m] in world axes from the origin of the piece's body. True for pieces without internal edges. A contact or
// an impact whose normal is not allowed is not one of the ground; a neighbour has the true one.
bool pl_internal_edges_allow(const plumb_world *world, uint32_t piece, double nx, double ny,
                             double x, double y);

#endif
