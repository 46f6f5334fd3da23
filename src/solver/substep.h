// substep.h - the rows of a substep: who runs them, and the solver's own.
//
// A cluster goes through all substeps of a step before the next one does (substep.c): its bodies and bundles stay in
// the cache. Which rows there are, and in what order, is the schedule's (schema/passes.h).
#ifndef PL_SUBSTEP_H
#define PL_SUBSTEP_H

#include "solver/solver.h"
#include "world/substep.h"

// In order. Preparing and storing are done once a step, the rest in each substep.
typedef enum pl_substep_stage {
    PL_SUBSTEP_PREPARE,
    PL_SUBSTEP_FORCES,      // of the moment
    PL_SUBSTEP_VELOCITIES,  // v += h a, warm starting, impacts
    PL_SUBSTEP_CONSTRAINTS, // as many times as there are iterations
    PL_SUBSTEP_POSITIONS,
    PL_SUBSTEP_RELAX, // as many times; by the classic solver as often as it corrects positions
    PL_SUBSTEP_SUMS,  // over the step: impulses, reactions
    PL_SUBSTEP_STORE,
    PL_SUBSTEP_STAGES
} pl_substep_stage;

// What all clusters of a step have in common.
typedef struct pl_solving_step {
    plumb_world *world;
    const pl_contact_kernels *kernels;
    pl_contact_call call;
    uint32_t threads;
    pl_surface_variant surface;
    pl_motion_variant motion;
    bool tallies, elastic;
    near_real soft_substep; // [s] see pl_soft_substep
    real dt;                // [s]
    bool together; // something of cluster 0 is not to be shared out: it is solved by itself
    const struct pl_substep_rows *rows;
} pl_solving_step;

// What the solver's own rows need of a cluster.
typedef struct pl_solving {
    const pl_solving_step *step;
    pl_contact_call call; // the step's, for this cluster
    const struct pl_joint_context *joints;
    bool any_joints;
    bool elastic; // cluster 0 alone has impacts that are followed one by one
    bool exact;   // islands that sweeps cannot hold, in a world of the soft step
    bool fine;    // islands that take finer substeps
} pl_solving;

// What the row that runs is for the cluster.
static inline pl_substep_fn *pl_substep_fn_of(const pl_substep *s)
{
    return s->solving->exact ? s->row->exact : s->row->run;
}

typedef struct pl_substep_rows {
    const pl_substep_row *items;
    uint32_t end[PL_SUBSTEP_STAGES]; // behind the last row of each stage
    uint32_t count;
    double *ns;                    // [ns] a thread and row: time is added here; null: nobody asked
    pl_substep_fn *before, *after; // around each row, where somebody watches; null: nobody
    bool alone;                    // clusters are solved by one thread
} pl_substep_rows;

// All clusters through all rows (substep.c).
void pl_substeps_run(plumb_world *world, const pl_substep_rows *rows, plumb_real dt);

// What a pass over slots from `first` on is given, and one over a cluster's dynamic bodies (kind 0) or its kinematic ones
// (1), shared out (integrate.c).
typedef struct pl_passage {
    const plumb_world *world;
    uint32_t first;
    near_real h; // [s]
} pl_passage;
void pl_pass_bodies(struct pl_substep *s, int kind, pl_range_fn *pass);

void pl_move_kinematic(struct pl_substep *s); // by their velocities (integrate.c)

// Before all rows of the soft step: what kernels are called with, and which of them (soft.c).
void pl_soft_open(plumb_world *world, pl_solving_step *out);
// What fine islands (apart.c) have besides: sweeps that relax them where a substep of the world ends; the share of the push speed.
#define PL_FINE_RELAXATIONS    5
#define PL_FINE_PUSH           ((near_real)0.1)
#define PL_CLASSIC_CORRECTIONS 3 // sweeps over positions, by the classic solver

#endif
