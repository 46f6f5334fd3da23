// wide.h - joints that are solved several at a time: patterns of rows, what the kernels are given,
// one set of kernels a width.
//
// Two joints have one pattern when they are of one kind with the same parts switched on. Lanes of a
// bundle hold joints of one pattern of which no two share a body that moves.
#ifndef PL_JOINTS_WIDE_H
#define PL_JOINTS_WIDE_H

#include "joints/rows.h"
#include "plumb/ecs.h"

#define PL_LEAST_ARC ((near_real)1e-4) // [rad] less is straight: its cube may be subnormal

typedef struct pl_joint pl_joint;
typedef plumb_substep_body pl_solver_body;

// Factors of J v, C, the impulse so far, and of J v at the start of the half: see one.c, spring.c.
typedef struct pl_joint_soft {
    real velocity, error, impulse, before;
} pl_joint_soft;

// A lane's joint, and what a bare hinge needs of it.
typedef struct pl_joint_lane {
    uint32_t joint;              // slot; PL_NONE: an empty lane
    uint8_t eighth_a, eighth_b;  // of a turn, where its bodies were last seen
    plumb_vec2 local_a, local_b; // [m] anchors in the bodies' frames
} pl_joint_lane;

// How a lane's joint begins a step: eight reals, gathered by the kernels as one row.
typedef struct pl_joint_start {
    near_real arm_a[2], arm_b[2]; // [m]
    near_real apart[2];           // [m] from A's centre to B's
    near_real impulse[2];         // [N s] of the first rows
} pl_joint_start;

typedef struct pl_joint_bundle {
    size_t at; // [B] of its record
    uint32_t pattern;
} pl_joint_bundle;

typedef struct pl_joint_call {
    pl_solver_body *bodies;
    const near_real *kicked; // as in pl_solver
    uint32_t dynamic_slots;  // slots from here on are read but never written
    uint32_t immovable_slot;
    uint32_t first, end; // bundles to go through
    const pl_joint_bundle *bundles;
    const pl_joint_pattern *patterns;
    const pl_joint_lane *lanes;
    const uint32_t *slots; // of a bundle: solver slots of all lanes' A, then of all B
    unsigned char *records;
    pl_joint *joints;
    const struct pl_joint_mark *marks; // of the same
    const pl_joint_start *starts;      // for `fill`: of the lanes of its one bundle
    const pl_rows *rows;               // likewise, unless that is bare
    real h;                            // [s] substep
    pl_joint_soft rigid;               // of rows that are no springs, where they pull
    bool *tense; // for `fill`: set where a lane asks for more inertia (pl_joint_inertia)
} pl_joint_call;

#define PL_JOINT_LANES 16 // of the widest kernel

typedef void pl_joint_kernel(const pl_joint_call *call);

struct pl_measuring;

typedef struct pl_joint_kernels {
    int width;
    size_t (*record_size)(const pl_joint_pattern *pattern); // [B]
    pl_joint_kernel *fill;       // one bundle, from poses, rows and impulses of the joints
    pl_joint_kernel *stiffen;    // bodies of tense joints get more inertia
    pl_joint_kernel *refill;     // rows for that
    pl_joint_kernel *warm_start; // the impulses that the step begins with
    // One sweep each. First of a substep: what J's turning owes is paid before pulling, rows are made
    // for the new poses before relaxing.
    pl_joint_kernel *pull_first, *pull, *relax_first, *relax;
    pl_joint_kernel *tally; // adds the substep's reactions to those of the step, of what is watched
    pl_joint_kernel *store; // impulses and reactions into the joints
    void (*measure)(const pl_joint_call *call, const struct pl_measuring *m); // measure.h
} pl_joint_kernels;

extern const pl_joint_kernels pl_joint_kernels_w4;
extern const pl_joint_kernels pl_joint_kernels_w8;
extern const pl_joint_kernels pl_joint_kernels_w16;

// Of what a half knows to be no matter of its own (pl_joint_lag), so much is not held against a rigid row: all where sweeps
// solve a joint to the end. Where several meet, what they leave undone would feed the network (DECISIONS.md).
static inline near_real pl_joint_spared(uint32_t degree)
{
    return degree > 1 ? (near_real)0.5 : 1;
}

// Geometric stiffness: a force F at the arm r turns a body back by r . F a radian, as a weight does a pendulum. Where
// links are light and what hangs on them is heavy, that spring is too stiff for the substep, and the links flutter ever
// faster. So such a body gets the inertia, h^2 r . F, with which a substep is a radian of its swing. [kg m^2] that a
// joint adds to it; `pull` [N m s]: r . impulse; `own`: inverse inertia. Half of the body's own is free for each of two
// joints: most bodies need no more, and keep every bit.
// (Tournier et al., Stable Constrained Dynamics, 2015, add the matrix of which this is the turning part.)
static inline near_real pl_joint_inertia(near_real pull, near_real h, near_real own)
{
    const near_real wanted = pull * h * own;
    return wanted > (near_real)0.5 ? (wanted - (near_real)0.5) / own : 0;
}

static inline void pl_joint_stiffen(pl_solver_body *body, near_real pull, near_real h,
                                    near_real own)
{
    const near_real more = pl_joint_inertia(pull, h, own);
    if (more > 0) {
        body->inv_inertia = 1 / (1 / body->inv_inertia + more);
    }
}

// A spring of the classic solver and the exact one, implicit. `mass` [kg] that the row meets: springs in newtons go by
// it. The same for a half of a substep of the soft step.
pl_joint_soft pl_joint_spring(const pl_row *row, real mass, real h);
pl_joint_soft pl_joint_half_spring(const pl_row *row, real mass, real h);

// In the halves of a substep, before the bodies move and behind that (spring.c).
typedef struct pl_oscillator {
    pl_joint_soft half[2];
} pl_oscillator;

// `degree`: as pl_joint has it.
pl_oscillator pl_joint_oscillator(const pl_row *row, real mass, real h, uint32_t degree);

#endif
