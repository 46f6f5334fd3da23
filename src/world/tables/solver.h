// solver.h - bodies as the solver has them, clusters, room for the rest.
#ifndef PL_TABLE_SOLVER_H
#define PL_TABLE_SOLVER_H

#include "plumb/ecs.h"
#include "world/tables/manifold.h"

// A body that is in a contact, as the kernels gather it: one row of eight reals.
typedef plumb_substep_body pl_solver_body;

// What only the passes over bodies touch. Quads, so that they run as vectors. ux, uy, uw: velocity as integrated,
// before any contact impulse of the substep.
typedef plumb_substep_motion pl_solver_motion;

#define PL_COLORS 64

#define PL_DYNAMIC_COLORS                                                                          \
    48 // contacts with immovable bodies have the last 16: they are solved last

// Overflow contacts count as one more colour.
#define PL_OVERFLOW_COLOR PL_COLORS

#define PL_COLOR_SLOTS (PL_COLORS + 1)

// Fewer bodies than this are not worth another thread in a pass that goes over them once.
#define PL_BODIES_SHARED 256

// Slots [first, first + count).
typedef struct pl_slots {
    uint32_t first, count;
} pl_slots;

// Islands that are solved together (cluster.c): their bodies, and the bundles of their contacts; joints have
// a group a cluster (joints/joint.h). A thread uses the same room for the bundles of all its clusters: they
// stay in its cache.
typedef struct pl_cluster {
    pl_slots slots[2]; // of dynamic, of kinematic bodies
    size_t first_lane;
    // first bundle of a colour, of the overflow contacts; end
    uint32_t color_first[PL_COLOR_SLOTS + 1];
} pl_cluster;

typedef struct pl_solver {
    pl_buffer bodies, motions; // active dynamic bodies, active kinematic ones, one immovable body
    // if impacts are events, a quad a slot: what rounding took from its velocity, if kept
    pl_buffer residuals;
    // a quad a slot: what of the kick comes behind the drift, and its share (halves.c)
    pl_buffer kicked;
    pl_buffer struck;  // likewise a real a slot: when in the substep an impact struck it last [s]
    pl_buffer rows;    // uint32_t: body row of a slot
    pl_buffer slots;   // uint32_t: slot of a dynamic or kinematic row; PL_NONE: not in a contact
    pl_buffer masks;   // uint64_t a slot: colours taken
    pl_buffer colors;  // uint8_t a manifold
    pl_buffer lanes;   // uint32_t a lane: its manifold; PL_NONE: empty
    pl_buffer bundles; // constraints of `width` contacts each
    pl_buffer extras; // a record a bundle, where surfaces run or roll hard or impulses are added up
    pl_buffer specials; // a record a bundle, where bodies are locked or surfaces stick
    pl_buffer grips;    // a record a bundle, where what slides has another friction than what sticks
    pl_buffer turnings; // a record a bundle, where something moves
    pl_buffer bounces;  // a record a bundle, where contacts are of low restitution
    pl_buffer rubbed;   // near_real, two a manifold: [N s] along the tangent over the step, where impulses are added up
    pl_buffer impacts;  // pl_impact
    pl_buffer impact_heap,
        impact_heads;  // uint32_t: due ones by time; the first one of a dynamic slot
    pl_buffer classic; // pl_classic_contact, for the classic solver alone
    uint32_t dynamic_slots,
        slot_count;     // slots [0, dynamic_slots) move; the last is the immovable one
    pl_buffer clusters; // pl_cluster
    pl_buffer labels;   // uint32_t a movable row: its cluster; if there are several
    // uint32_t a movable row; PL_NONE: tied to nothing that moves, as far as is known
    pl_buffer islands;
    pl_buffer homes;   // uint32_t an island: its cluster
    pl_buffer leaders; // uint32_t a row or island, while they are joined
    pl_buffer cursors; // uint32_t a cluster and colour: contacts, then the next lane
    uint32_t cluster_count, cluster_age; // steps since islands were looked for
    uint32_t island_count;
    // Islands that are solved apart (apart.c), in finer substeps and exactly, all of a kind one cluster, behind the others; PL_NONE:
    // there are none.
    uint32_t fine_cluster, hard_cluster;
    uint32_t fine_islands;
    bool fine_before;          // some contact has a level of stiffness
    uint32_t hard_count;       // contacts of them, in `hard_contacts`
    uint32_t hard_islands;
    bool hard_pressed;         // some contact was PL_PAIR_PRESSED at the last look
    bool hard_before;          // some contact is PL_PAIR_EXACT
    pl_buffer hard_contacts;   // uint32_t: manifolds
    pl_buffer apart_leaders;   // uint32_t a movable row, while they are looked for
    pl_buffer apart_tallies;   // pl_apart_tally a movable row, likewise
    uint32_t labelled; // rows whose islands are kept; 0: none
    // bundles of the largest cluster; of each thread's room, if there are several
    uint32_t bundle_room;
    uint32_t bundle_count; // of cluster 0: all that impacts as events look at
    uint32_t impact_count, due_count;
    near_real since;      // [s] from the start of the step to that of the substep of cluster 0
    bool turning;         // of this step: some body moves fast enough for a contact to turn
    bool follows_impacts; // of this step: some are events
    uint32_t spare_impacts; // of this substep, that contacts may still take (impact.c)
    uint64_t colors_used; // by contacts: a bit each
    uint32_t overflow_count, bounce_count;
    uint32_t chain_count; // impacts of the step in the longest chain of one contact
    uint32_t cut_count;   // chains of impacts that were not followed to their ends, in all
} pl_solver;

// Solver slot of a body row.
static inline uint32_t pl_solver_slot(const pl_solver *solver, uint32_t row, uint32_t movable_rows)
{
    return row < movable_rows ? ((const uint32_t *)solver->slots.data)[row]
                              : solver->slot_count - 1;
}

// Manifolds that the classic and the exact solver have: all, or those of hard islands.
static inline uint32_t pl_classic_count(const pl_solver *solver, uint32_t manifolds)
{
    return solver->hard_cluster == PL_NONE ? manifolds : solver->hard_count;
}

static inline uint32_t pl_classic_manifold(const pl_solver *solver, uint32_t i)
{
    return solver->hard_cluster == PL_NONE ? i : ((const uint32_t *)solver->hard_contacts.data)[i];
}

// Clusters of rows; null: all are of one cluster.
static inline const uint32_t *pl_solver_labels(const pl_solver *solver)
{
    return solver->cluster_count == 1 ? NULL : solver->labels.data;
}

static inline pl_cluster *pl_clusters(const pl_solver *solver)
{
    return (pl_cluster *)solver->clusters.data;
}

static inline pl_solver_body *pl_solver_bodies(const pl_solver *solver)
{
    return (pl_solver_body *)solver->bodies.data;
}

// Share of a slot's kick that comes behind the drift, of pl_solver.kicked; there it is negative while the kick is whole.
static inline near_real pl_kick_behind(const near_real *kicked, uint32_t slot)
{
    const near_real share = kicked[4 * (size_t)slot + 3];
    return share > 0 ? share : 0;
}

// Of a body with joints, which may be one that nothing kicks.
static inline near_real pl_joint_behind(const near_real *kicked, uint32_t dynamic_slots,
                                        uint32_t slot)
{
    return slot < dynamic_slots ? pl_kick_behind(kicked, slot) : 0;
}

// Of a row between two: after a hit, of which neither end is to be kicked in halves, none of its impulse comes behind.
static inline near_real pl_joint_lag(const near_real *kicked, uint32_t dynamic_slots, uint32_t a,
                                     uint32_t b)
{
    const near_real of_a = pl_joint_behind(kicked, dynamic_slots, a);
    const near_real of_b = pl_joint_behind(kicked, dynamic_slots, b);
    return a >= dynamic_slots ? of_b : b >= dynamic_slots ? of_a : of_a < of_b ? of_a : of_b;
}

static inline pl_solver_motion *pl_solver_motions(const pl_solver *solver)
{
    return (pl_solver_motion *)solver->motions.data;
}

#endif
