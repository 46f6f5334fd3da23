// joint.h - a joint as it is stored, what a kind of joint is, and what the passes call.
#ifndef PL_JOINT_H
#define PL_JOINT_H

#include "joints/rows.h"
#include "plumb/joint.h"

// Members of the descriptor that a kind has.
enum {
    PL_JOINT_LIMIT = 1,
    PL_JOINT_MOTOR = 2,
    PL_JOINT_SPRING = 4,
    PL_JOINT_TARGET = 8,
    PL_JOINT_TWO_ANCHORS = 16,
    PL_JOINT_RADIANS = 32 // its value is an angle
};

typedef struct pl_joint pl_joint;

typedef struct pl_joint_class {
    const char *name;
    unsigned has; // PL_JOINT_...
    // Checks what only this kind has, and resolves its defaults; null: nothing to do.
    plumb_result (*check)(const plumb_world *world, const char *function, plumb_joint_desc *desc);
    // The rows at these poses. Count and block must not change in the life of a joint unless the
    // user changes the joint.
    void (*rows)(const pl_joint *joint, const pl_joint_pose *a, const pl_joint_pose *b,
                 pl_rows *rows);
    real (*value)(const pl_joint *joint, const pl_joint_pose *a, const pl_joint_pose *b);
    // What is kept (pl_joint.sum) of a new joint; null: 0.
    real (*keep)(const pl_joint *joint, const pl_joint_pose *a, const pl_joint_pose *b);
    // What changes from step to step, after the step; null: nothing.
    void (*advance)(pl_joint *joint, const pl_joint_pose *a, const pl_joint_pose *b);
} pl_joint_class;

#define PL_DECLARE_CLASS(NAME, name, text) extern const pl_joint_class pl_joint_##name;
PLUMB_JOINT_LIST(PL_DECLARE_CLASS)
#undef PL_DECLARE_CLASS

extern const pl_joint_class *const pl_joint_classes[]; // by plumb_joint_kind
extern const int pl_joint_class_count;

// What a joint knows of one of its bodies.
typedef struct pl_joint_end {
    plumb_body body;    // null: the world
    uint32_t next;      // next joint of the body: see pl_joint_next
    plumb_vec2 local;   // [m] anchor in the body's frame; the world's: in the world
    double start;       // [rad] angle of the body when the joint was made
    double seen;        // [rad] angle when last looked, in (-pi, pi]
    int32_t turns;      // full turns since
    uint32_t slot;      // solver slot in this step
    pl_joint_pose pose; // at the start of the step
} pl_joint_end;

struct pl_joint {
    plumb_joint entity; // null: a free slot, whose a.next is the next one
    plumb_joint_desc desc;
    pl_joint_end a, b;
    plumb_vec2 axis;   // unit, in A's frame (the world's without A)
    plumb_vec2 target; // mouse: world [m]; motor: in A's frame [m]
    plumb_vec2 origin; // [m] from where poses are told: A's centre at the start of the step
    real sum;          // gear, pulley: what is kept; ratchet: the tooth behind the pawl [rad]
    // Solver.
    real impulse[PL_JOINT_ROWS]; // [N s] of a substep
    real h;                      // [s] substep that the impulses belong to
    real mass[PL_JOINT_ROWS];    // [kg] effective, of rows outside the block
    real inverse[3][3];          // of the block's K = J M^-1 J^T
    real turn[6];                // change of momentum owed because J has turned: see solve.c
    pl_rows rows;
    plumb_vec2 arm_b; // [m] from B's centre to its anchor, at the rows
    bool active;      // in this step: it is on and so are its bodies
    plumb_vec2 force; // [N] reaction
    plumb_vec2 step_impulse; // [N s] on B over the step, where some joint breaks by impulse
    real torque;      // [N m]
};

typedef struct pl_joints {
    pl_buffer items;  // pl_joint; slots are stable
    pl_buffer broken; // plumb_joint_break of the last step, room for every joint
    uint32_t count;   // slots ever used
    uint32_t live;
    uint32_t impulsive; // those that break by impulse
    uint32_t free_head; // PL_NONE: none
    int broken_count;
    pl_buffer awake; // uint32_t: slots of joints of which no body sleeps, in order
    uint32_t awake_count;
    bool awake_stale; // joints came or went, or bodies fell asleep or woke
} pl_joints;

static inline pl_joint *pl_joint_items(const pl_joints *joints)
{
    return (pl_joint *)joints->items.data;
}

// The i-th joint that is awake, after pl_joints_awake.
static inline pl_joint *pl_joint_awake(const pl_joints *joints, uint32_t i)
{
    return &pl_joint_items(joints)[((const uint32_t *)joints->awake.data)[i]];
}

// The slot of a live joint or PL_NONE.
uint32_t pl_joint_slot(const plumb_world *world, plumb_joint joint);
// Unlinks a joint, gives its slot back and releases its handle.
void pl_joint_remove(plumb_world *world, uint32_t slot);
void pl_joints_free(pl_memory *memory, pl_joints *joints);
// How many joints the solver has to do with; the others sleep. O(1) unless something changed.
uint32_t pl_joints_awake(plumb_world *world);
bool pl_joints_any_awake(const plumb_world *world);
// Both bodies of a joint are about to notice that it is another: see sleep.h.
void pl_joint_disturb(plumb_world *world, const pl_joint *joint);
// The next joint of a body in its list.
uint32_t pl_joint_next(const pl_joint *joint, plumb_body body);
// Whether a joint forbids contacts of two body rows. O(joints of `row`).
bool pl_joints_forbid(const plumb_world *world, uint32_t row, uint32_t other);
// Whether a joint forbids contacts of a body row with any other. O(joints of `row`).
bool pl_joints_part(const plumb_world *world, uint32_t row);
// Full turns, origin and poses up to date.
void pl_joint_begin(const plumb_world *world, pl_joint *joint);

typedef enum pl_joint_sweep {
    PL_SWEEP_PULL,   // springs, and errors undone
    PL_SWEEP_RELAX,  // rigid rows alone, errors left
    PL_SWEEP_CLASSIC // springs, errors left: pl_joints_move undoes them
} pl_joint_sweep;

// The solver's part (solve.c), over all joints. Prepare: slots, poses and rows at the start of the
// step of substeps h [s]. Turn: what J's turning owes. Refresh: rows at the moved poses.
void pl_joints_prepare(plumb_world *world, real h);
void pl_joints_warm_start(plumb_world *world);
void pl_joints_turn(plumb_world *world);
void pl_joints_solve(plumb_world *world, pl_joint_sweep sweep);
void pl_joints_refresh(plumb_world *world);
// Moves bodies against the errors that are left (classic solver).
void pl_joints_move(plumb_world *world, real share);
// Adds the substep's reactions to those of the step, where some joint breaks by impulse (finish.c).
void pl_joints_tally(plumb_world *world);
// Takes out of the rows what lies along locked axes of their bodies: infinite mass (lock.c).
void pl_joint_lock_rows(const plumb_world *world, pl_joint *joint);
// Reactions; breaks what is loaded too much (finish.c).
void pl_joints_finish(plumb_world *world);

#endif
