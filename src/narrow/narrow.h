// narrow.h - the narrow phase: manifolds of all pairs, kind by kind, one pair a SIMD lane.
#ifndef PL_NARROW_H
#define PL_NARROW_H

#include "world/tables/manifold.h"

// Everything a batch of equal pairs needs; plain arrays, no world.
typedef struct pl_narrow_input {
    const plumb_real *poses;                  // pl_pose rows of 8 reals, by body row
    const pl_core *cores;                     // by piece slot
    const pl_vertex *vertices;                // the pool
    const uint32_t *vertex_first;             // by piece slot
    const uint8_t *vertex_count;              // by piece slot
    const plumb_real *friction, *restitution; // by piece slot
    const plumb_real *w;                      // [rad/s] by body row; NULL: nothing turns
    const plumb_real *extent;                 // [m] by body row, about the centre of mass
    near_real dt;                             // [s] elastic pairs look ahead this long
    near_real elastic_above; // pairs of more restitution are elastic: 0; -1 where it may yet change
    pl_pair *pairs;          // the whole list
    bool seeks;              // some are PL_PAIR_SOUGHT
    bool wrapped;            // the world wraps around: the nearest images meet
    plumb_real wrap_x, wrap_y; // [m] its periods; 0: none
    // What the bodies do until the horizon, where gravity is all that acts on them (else `plain` is false, and every
    // contact may do anything).
    bool plain;
    uint32_t dynamic_count;   // body rows that fall
    near_real horizon;        // [s]
    near_real fall_x, fall_y; // [m] by gravity until then
} pl_narrow_input;

// Appends the manifolds of pairs [first, first + count) to the narrow phase's list and keeps up its
// summary. Sets the pairs' `manifold` and clears PL_PAIR_HIT. Room for every pair must be reserved. `kind_b`: the
// pl_piece_kind of their second pieces.
typedef void pl_narrow_kernel(const pl_narrow_input *in, uint32_t first, uint32_t count, int kind_b,
                              pl_narrow *out);

// Features of the general kernel (convex.simd.c): reference face and the edge of the other piece that lies before it, whose
// points are 0 and 1.
#define PL_CONVEX_FEATURE(face, edge) ((face) << 3 | (edge) << 8)
#define PL_CONVEX_FACE(feature)       ((feature) >> 3 & 31)
#define PL_CONVEX_EDGE(feature)       ((feature) >> 8 & 31)
#define PL_CONVEX_OF_B                4 // the face is one of B
#define PL_CONVEX_CORNERS             2 // instead, the nearest corners of both

// One kernel for each shape of pair; which serves which kinds is the matrix in narrow.c.
typedef struct pl_narrow_kernels {
    pl_narrow_kernel *circle; // against a circle, a capsule, a box
    pl_narrow_kernel *circle_convex;
    pl_narrow_kernel *box_box;
    pl_narrow_kernel *convex_convex;
} pl_narrow_kernels;

extern const pl_narrow_kernels pl_narrow_kernels_w4;
extern const pl_narrow_kernels pl_narrow_kernels_w8;
extern const pl_narrow_kernels pl_narrow_kernels_w16;

// Makes the manifolds of all pairs of a list. Room for them; false when out of memory.
bool pl_narrow_reserve(plumb_world *world, const pl_pair_list *list, pl_narrow *narrow);
// Contacts that lie ahead are told for the moment at which they happen, until pl_ahead_settle (ahead.h). False when
// out of memory.
bool pl_narrow_run(plumb_world *world, const pl_pair_list *list, plumb_real dt, pl_narrow *narrow);
// The kernel of so many lanes for pairs of these kinds (pl_piece_kind, the lower one first).
pl_narrow_kernel *pl_narrow_kernel_for(int width, int a, int b);
// Takes the manifolds that are `disabled` out of the world's list; their pairs forget their impulses and
// get a flag (0: none).
void pl_narrow_take_out_disabled(plumb_world *world, uint32_t flag);

// Leaves points out that two others of the same bodies imply (implied.c).
void pl_narrow_leave_out_implied(plumb_world *world);

// Keeps the room, nothing else.
void pl_narrow_clear(pl_narrow *narrow);
void pl_narrow_free(pl_memory *memory, pl_narrow *narrow);
void pl_ahead_free(pl_memory *memory, pl_lookahead *ahead);

#endif
