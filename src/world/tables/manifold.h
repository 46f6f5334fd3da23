// manifold.h - what the narrow phase hands to the solver.
#ifndef PL_MANIFOLD_H
#define PL_MANIFOLD_H

#include "world/tables/pair.h"

// A point of a manifold. Anchors lie on the surfaces, relative to the centres of mass, in world
// axes.
typedef struct pl_manifold_point {
    near_real ax, ay;     // [m] from A's centre of mass
    near_real bx, by;     // [m] from B's centre of mass
    near_real separation; // [m] negative: overlap
    near_real normal;     // [N s] impulse carried over from the last step
    near_real tangent;    // [N s]
    union {
        near_real total; // [N s] along the normal over the step, where the world adds it up
        near_real bend;  // [1/m] of the face that the normal is of; of the second point where it is absent
    };
} pl_manifold_point;

// A touching or nearly touching pair of this step: three rows of eight reals, which the kernels
// read by transposes, and a row of indices.
typedef struct pl_manifold {
    near_real nx, ny;        // unit, from A to B
    near_real friction;      // [-]
    near_real restitution;   // [-]
    near_real approach;      // [m/s] for events: see pl_manifold_strike; 0 for pairs that touched
    union {
        near_real surface_speed; // [m/s] added to the slip: see surface.c; until it is prepared to be solved
        near_real struck_at;     // [s] since the step began: when `approach` was measured; then
    };
    near_real rolling;       // [m] lever arm of rolling resistance
    union {
        near_real adhesion; // [N] that the contact may pull, until events are made
        near_real
            hit_impulse; // [N s] impulse of the hit that is due, steps before included; then only
    };
    pl_manifold_point point[2]; // a point that is absent has separation PL_APART
    uint32_t body_a, body_b;    // body rows
    uint32_t pair;              // index in the pair list
    uint16_t count;             // points, 1 or 2
    // Its plane acts from one impact of its bodies to another, by when they come (PL_WINDOW_UNIT); 0: from the start, to
    // the end of the step.
    uint8_t waits, ends;
    uint32_t feature[2];
    uint16_t disabled; // by a system; only while the contact systems run
    uint16_t met;      // PL_MET_...: what events want to know
    union {
        uint32_t bearer; // of manifolds behind manifold_count: pair that bears the load of this one
        // of the others: pl_pair.manifold in the last step; PL_NONE: they were apart
        uint32_t before;
        uint32_t ahead; // of those whose pair is PL_PAIR_AHEAD: the record
    };
} pl_manifold;

// The whole step in pl_manifold.waits and ends; and of ends: but not before the contact itself has struck.
#define PL_WINDOW_UNIT  127
#define PL_ENDS_STRUCK  128

#define PL_MET_ACTED 1u // it pushed in some substep, though not in the last one
#define PL_MET_MEASURED                                                                            \
    2u // `approach` is the fastest at which a point of it was struck in this step
#define PL_MET_ASIDE                                                                               \
    4u // its plane is that of a later moment or of the ground: the pieces are clear of one another

#define PL_MET_KINETIC 0x40u // what slides has another friction than what sticks (narrow/surface.h)
#define PL_MET_SLID    0x80u // PL_PAIR_SLIDES as the step began

// How the normal goes on within the step: with A, whose face it is, with B, or as the connection of the centres of two
// round features. 0: it stays as it is.
#define PL_MET_TURNS     0x30u
#define PL_MET_TURNS_A   0x10u
#define PL_MET_TURNS_B   0x20u
#define PL_MET_TURNS_MID 0x30u

// [m] contacts that are farther apart lie ahead: whether they will meet is asked (ahead.c).
#define PL_AHEAD ((near_real)5e-4)
// [m] the same of round features that bounce: their line of centres turns until they meet, however near they are.
#define PL_AHEAD_HIT ((near_real)1e-6)

// [m] an impact that moves a body by less until the horizon is none: it would meet what it would have met.
#define PL_TURNED ((near_real)2e-3)

// pl_narrow.candidates: the place of a manifold, and what is known of it while the bodies fly on.
#define PL_CANDIDATE_STRIKES                                                                       \
    0x40000000u // it is there already, and may close by PL_TURNED; others lie ahead
#define PL_CANDIDATE_ACTS    0x20000000u // it may reach its plane
#define PL_CANDIDATE_BOUNCES 0x10000000u // its restitution is above 0
#define PL_CANDIDATE_SOUGHT  0x08000000u // PL_PAIR_SOUGHT
#define PL_CANDIDATE_PLACE   0x07ffffffu

// [m] what touched goes on to touch while it is nearer than this.
#define PL_TOUCH_HOLD PL_AHEAD

// Whether the surfaces of a manifold met, or are nearer than `reach` [m], at the start of the step.
static inline bool pl_is_near(const pl_manifold *m, near_real reach)
{
    return (m->point[0].separation <= reach || m->point[1].separation <= reach) &&
           (m->met & PL_MET_ASIDE) == 0;
}

// Whether the geometry of a manifold can be that of the moment (solver/moment.simd.c): of what meets the face, no corner may be
// the next to meet. Round are discs and capsules.
static inline bool pl_can_turn(const pl_manifold *m, bool round_a, bool round_b)
{
    const uint32_t turns = m->met & PL_MET_TURNS;
    return turns != 0 && (m->met & PL_MET_ASIDE) == 0 && !(m->restitution > 0) &&
           (turns == PL_MET_TURNS_A || round_a) && (turns == PL_MET_TURNS_B || round_b);
}

// A point was struck at this speed [m/s], so long [s] after the step began. Before, `approach` is what velocities at the start of the step make of
// it, of pairs that did not touch.
static inline void pl_manifold_strike(pl_manifold *m, near_real speed, near_real at)
{
    if ((m->met & PL_MET_MEASURED) == 0 || speed > m->approach) {
        m->approach = speed;
        m->struck_at = at;
        m->met |= PL_MET_MEASURED;
    }
}

// A contact that was struck n times has no more than e^(2 n) of its energy left to return: below this it is
// not worth following.
#define PL_IMPACT_KEPT ((near_real)0.02)

// Whether more than one impact a substep is worth following. Others are of low restitution.
static inline bool pl_is_elastic(near_real restitution)
{
    return restitution * restitution > PL_IMPACT_KEPT;
}

// Whether an impulse passed between the surfaces in this step, of the solver or of an impact.
static inline bool pl_has_met(const pl_pair *pair, const pl_manifold *m)
{
    return (pair->flags & PL_PAIR_HIT) != 0 || pair->normal[0] != 0 || pair->normal[1] != 0 ||
           (m->met & PL_MET_ACTED) != 0;
}

// [m] within which surfaces that stick pull: those that touched in the step before hold while they are
// pulled out of touch; others do not draw one another near.
static inline near_real pl_adhesion_reach(uint32_t pair_flags)
{
    return (pair_flags & PL_PAIR_TOUCHING) != 0 ? (near_real)0.005 : (near_real)1e-4;
}

// [m] separation of a point that is not there: no impulse can ever act on it.
#define PL_APART ((near_real)1e6)

// [m] sums of penetration are whole numbers of this, so that the order of adding makes no difference.
#define PL_DEPTH_UNIT 0x1p-36

static inline uint64_t pl_depth_units(near_real depth)
{
    return depth < 1000 ? (uint64_t)((double)depth / PL_DEPTH_UNIT)
                        : (uint64_t)(1000 / PL_DEPTH_UNIT);
}

// How many manifolds touch, and how deep: of a step, of what sleeps, of all.
typedef struct pl_overlaps {
    uint32_t touching_count;   // manifolds whose surfaces met
    uint32_t point_count;      // of all manifolds
    near_real max_penetration; // [m]
    uint64_t sum_penetration;  // [PL_DEPTH_UNIT] of the deeper point of each touching manifold
} pl_overlaps;

static inline void pl_overlaps_count(pl_overlaps *o, const pl_manifold *m)
{
    near_real s0 = m->point[0].separation, s1 = m->point[1].separation;
    near_real depth = s0 < s1 ? -s0 : -s1;
    o->point_count += m->count;
    if (depth >= 0) {
        ++o->touching_count;
        o->sum_penetration += pl_depth_units(depth);
        o->max_penetration = depth > o->max_penetration ? depth : o->max_penetration;
    }
}

static inline void pl_overlaps_add(pl_overlaps *sum, const pl_overlaps *more)
{
    sum->touching_count += more->touching_count;
    sum->point_count += more->point_count;
    sum->sum_penetration += more->sum_penetration;
    if (more->max_penetration > sum->max_penetration) {
        sum->max_penetration = more->max_penetration;
    }
}

// Body rows of a manifold, apart from it: all that the graph looks at.
typedef struct pl_ends {
    uint32_t a, b;
} pl_ends;

// Contacts that lie ahead and are looked at closely (toi.h).
typedef struct pl_lookahead {
    pl_buffer items; // pl_toi
    uint32_t count;
    pl_buffer list;       // uint32_t: items of which kernels make manifolds
    pl_buffer poses;      // pl_pose: of both bodies of each
    pl_buffer pairs;      // pl_pair: copies, whose bodies are these poses
    pl_buffer made;       // pl_manifold
    pl_buffer unread;     // what else a kernel writes
    pl_buffer kept;       // what pairs had whose manifolds became others (settle.c)
    uint32_t kept_count;
    uint32_t looks; // contacts that were looked at in this step, each as often as it was
    pl_buffer map, paths; // of bodies that have such contacts: where, pl_way
    pl_buffer listed;     // uint32_t a candidate: 1 + its item; 0: none
    pl_buffer meetings;   // pl_keyed: items that meet, by time
    // Pairs whose pieces an impact of this step makes meet, and that had no manifold (struck.c).
    pl_buffer sought; // pl_keyed by pl_pair_key
    uint32_t sought_count;
    pl_buffer strays; // of one look: bodies that impacts take from their flight
    bool again;       // some are new: the pass is to be run once more
} pl_lookahead;

typedef struct pl_narrow {
    pl_buffer manifolds; // pl_manifold of this step, room for every pair
    pl_buffer staged;    // pl_manifold, with several threads: before they are put together
    pl_buffer ends;      // pl_ends a manifold, as the kernels left them
    pl_buffer chains;    // uint32_t: manifolds by their bodies (narrow/implied.c)
    pl_buffer fresh;     // uint32_t: pairs with a manifold that did not touch in the last step
    pl_buffer
        candidates; // uint32_t: manifolds all of whose points are apart by PL_AHEAD or more, and strikes
    uint32_t fresh_count, candidate_count;
    bool ends_stale; // manifolds or rows have moved since
    uint32_t manifold_count;
    uint32_t
        borne_count; // more manifolds behind those, whose load others bear (internal_edges/run.c)
    // Summary of this step's manifolds.
    bool any_friction; // some manifold has friction > 0
    bool any_elastic;  // some manifold's impacts are worth following
    bool any_low;      // some manifold has a restitution, a low one
    bool any_surface;  // some manifold has surface speed or rolling resistance
    bool any_adhesion; // some manifold may pull
    bool any_kinetic;  // some manifold has a kinetic friction
    pl_overlaps overlaps;
} pl_narrow;

static inline void pl_narrow_note_restitution(pl_narrow *narrow, near_real restitution)
{
    const bool elastic = pl_is_elastic(restitution);
    narrow->any_elastic |= elastic;
    narrow->any_low |= !elastic && restitution > 0;
}

// The summary, for whoever goes through all manifolds anyway: from none on, one after another.
static inline void pl_narrow_forget_summary(pl_narrow *narrow)
{
    narrow->any_friction = narrow->any_surface = narrow->any_adhesion = false;
    narrow->any_kinetic = false;
    narrow->any_elastic = narrow->any_low = false;
    narrow->overlaps = (pl_overlaps){ 0 };
}

static inline void pl_narrow_sum_up(pl_narrow *narrow, const pl_manifold *m)
{
    narrow->any_friction |= m->friction > 0;
    pl_narrow_note_restitution(narrow, m->restitution);
    narrow->any_surface |= m->surface_speed != 0 || m->rolling > 0;
    narrow->any_adhesion |= m->adhesion > 0;
    narrow->any_kinetic |= (m->met & PL_MET_KINETIC) != 0;
    pl_overlaps_count(&narrow->overlaps, m);
}

static inline pl_manifold *pl_manifolds(const pl_narrow *narrow)
{
    return (pl_manifold *)narrow->manifolds.data;
}

#endif
