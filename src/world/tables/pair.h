// pair.h - a pair of pieces whose fat boxes overlap: all of a contact that outlives a step.
#ifndef PL_PAIR_H
#define PL_PAIR_H

#include "core/memory.h"
#include "world/columns.h"

typedef struct pl_pair {
    uint32_t a, b;           // piece slots: kind of a <= kind of b, equal kinds: a < b
    uint32_t body_a, body_b; // body rows
    uint32_t feature[2];     // of the manifold points that the impulses belong to; PL_NONE: none
    near_real normal[2];     // [N s] impulses of the last substep
    near_real tangent[2];    // [N s]
    near_real rolling;       // [N m s] about the pair's contact as a whole
    uint32_t manifold;       // index of this step's manifold; PL_NONE: apart
    uint32_t flags;          // PL_PAIR_...
} pl_pair;

#define PL_PAIR_TOUCHING 1u     // touched in the last step, so the begin event was sent
#define PL_PAIR_HIT      2u     // an impact with restitution was resolved in this step
#define PL_PAIR_STRUCK   4u     // it struck in the last step
#define PL_PAIR_PENDING  8u     // and had not been stopped yet: the hit is still to be told
#define PL_PAIR_WAIVED   16u    // a system disabled its contact in this step
#define PL_PAIR_BORNE    32u    // flush ground: another pair bears the load of this one
#define PL_PAIR_HELD     64u    // of a one-way piece: it holds
#define PL_PAIR_PASSING  128u   // it is under way through it
#define PL_PAIR_DROPPING 16384u // it was held and asked to drop through
#define PL_PAIR_ONE_WAY  (PL_PAIR_HELD | PL_PAIR_PASSING | PL_PAIR_DROPPING)
// These as they were before the step, should it be taken anew (narrow/one_way.c).
#define PL_PAIR_WAS_HELD     268435456u
#define PL_PAIR_WAS_PASSING  536870912u
#define PL_PAIR_WAS_DROPPING 1073741824u
#define PL_PAIR_WAS_ONE_WAY  (PL_PAIR_WAS_HELD | PL_PAIR_WAS_PASSING | PL_PAIR_WAS_DROPPING)
#define PL_PAIR_AHEAD                                                                              \
    32768u // its manifold is that of a later moment; only within the narrow phase (narrow/ahead.h)
#define PL_PAIR_COVERED                                                                            \
    65536u // parts only, until events are made: its surfaces met, but a neighbour has the contact
#define PL_PAIR_SLIDES                                                                             \
    131072u // of surfaces with a kinetic friction: they slid in the last substep
// What is known of a contact's load (exact/hard.c): whether it bore much at the last two looks, which take turns; it is
// why its island is to be solved exactly; that was too large for it at the last look.
#define PL_PAIR_LOADED_0    262144u
#define PL_PAIR_LOADED_1    524288u
#define PL_PAIR_PRESSED     1048576u
#define PL_PAIR_LARGE       2097152u
#define PL_PAIR_EXACT       4194304u // it was solved exactly in the last step
// How stiff its contact is in an island of finer substeps (solver/apart.c): 0 as the world's, else 1 to PL_STIFF_LEVELS.
#define PL_PAIR_STIFF_SHIFT 23u
#define PL_PAIR_STIFF_MASK  (15u << PL_PAIR_STIFF_SHIFT)
#define PL_STIFF_LEVELS     15u
#define PL_PAIR_SOUGHT                                                                             \
    134217728u // an impact of this step makes its pieces meet, however far apart they are; only within the narrow phase
#define PL_PAIR_LOADS                                                                              \
    (PL_PAIR_LOADED_0 | PL_PAIR_LOADED_1 | PL_PAIR_PRESSED | PL_PAIR_LARGE | PL_PAIR_EXACT |       \
     PL_PAIR_STIFF_MASK)

// The face that parted the pieces when they were last looked at, in bits of the flags: 0 none, else
// 1 + 2 x edge, + 1 when it is an edge of b. Tried first; see narrow/convex.simd.c.
#define PL_PAIR_FACE_SHIFT 8u
#define PL_PAIR_FACE_MASK  (63u << PL_PAIR_FACE_SHIFT)

// [m] manifolds are made for pieces closer than this: contacts are ready before they are needed.
#define PL_SPECULATIVE ((near_real)0.02)

// [m] the same beside what a spin closes by in the step: what turns slowly has the points of what does not turn (narrow/DECISIONS.md).
#define PL_BESIDE_SPIN ((near_real)0.005)

// Something for each two kinds of pieces, the lower kind first.
typedef uint32_t pl_by_kinds[PL_PIECE_KIND_COUNT][PL_PIECE_KIND_COUNT];

// The list, sorted by the kinds of a and b, then by slots; pairs of equal kinds are one range.
typedef struct pl_pair_list {
    pl_buffer items, old_items; // pl_pair; the list before the last rebuild is kept for reuse
    uint32_t count;
    pl_by_kinds first, size;
} pl_pair_list;

// Leaves it nothing to warm start from.
static inline void pl_pair_forget(pl_pair *pair)
{
    pair->rolling = 0;
    pair->flags &= ~(PL_PAIR_SLIDES | PL_PAIR_LOADS);
    for (int k = 0; k < 2; ++k) {
        pair->feature[k] = PL_NONE;
        pair->normal[k] = pair->tangent[k] = 0;
    }
}

static inline pl_pair *pl_pairs(const pl_pair_list *list)
{
    return (pl_pair *)list->items.data;
}

#endif
