// joint.h - a joint as it is stored, what a kind of joint is, and what the passes call.
#ifndef PL_JOINT_H
#define PL_JOINT_H

#include "core/tasks.h"
#include "joints/rows.h"
#include "joints/wide.h"
#include "plumb/joint.h"

// Members of the descriptor that a kind has.
enum {
    PL_JOINT_LIMIT = 1,
    PL_JOINT_MOTOR = 2,
    PL_JOINT_SPRING = 4,
    PL_JOINT_TARGET = 8,
    PL_JOINT_TWO_ANCHORS = 16,
    PL_JOINT_RADIANS = 32, // its value is an angle
    PL_JOINT_TRAVELS = 64, // its value is a way
    PL_JOINT_SPINS = 128,  // B turns about A besides
    PL_JOINT_GROUNDS = 256,
    PL_JOINT_AXIS = 512,
    PL_JOINT_LENGTH = 1024,
    PL_JOINT_RATIO = 2048,
    PL_JOINT_PITCH = 4096,
    PL_JOINT_FORCE = 8192,
    PL_JOINT_TORQUE = 16384,
    PL_JOINT_REST = 32768
};

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
    // A row whose J is the slope of the value; null: that of the turn of B relative to A.
    pl_row (*slope)(const pl_joint *joint, const pl_joint_pose *a, const pl_joint_pose *b);
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
    plumb_body body;  // null: the world
    uint32_t next;    // next joint of the body: see pl_joint_next
    plumb_vec2 local; // [m] anchor in the body's frame; the world's: in the world
    double start;     // [rad] angle of the body when the joint was made
    int32_t turns;    // full turns since
    uint32_t eighth;  // of a turn in which the body was seen last: see pl_joint_eighth
} pl_joint_end;

struct pl_joint {
    // What every step reads and writes of every joint comes first, on one cache line.
    real impulse[PL_JOINT_ROWS]; // [N s] of a substep
    real h;                      // [s] substep that the impulses belong to
    plumb_vec2 force;            // [N] reaction
    real torque;                 // [N m]
    plumb_joint entity;          // null: a free slot, whose a.next is the next one
    plumb_joint_desc desc;
    pl_joint_end a, b;
    plumb_vec2 axis;   // unit, in A's frame (the world's without A)
    plumb_vec2 target; // mouse: world [m]; motor: in A's frame [m]
    real sum;          // gear, pulley: what is kept; ratchet: the tooth behind the pawl [rad]
    uint32_t strained; // 1: its reaction was beyond its bounds for events when last seen
    // What is behind here is of one step, and not saved (snapshot/list.h).
    pl_joint_pose pose_a, pose_b; // at the start of the step; first: aligned as the whole
    uint32_t slot_a, slot_b;      // solver slots
    plumb_vec2 origin; // [m] from where poses are told: A's centre at the start of the step
    // Solver: of joints solved one by one.
    real mass[PL_JOINT_ROWS]; // [kg] effective, of rows outside the block
    real inverse[3][3];       // of the block's K = J M^-1 J^T
    real turn[6];             // change of momentum owed because J has turned: see solve.c
    pl_rows rows;
    plumb_vec2 arm_b;        // [m] from B's centre to its anchor, at the rows
    plumb_vec2 step_impulse; // [N s] on B over the step, where it is watched; 0 between steps
    real step_turn;          // [N m s] likewise, about B's anchor
};

// A joint as the plan sees it, so that a step need not look at the joint itself.
typedef struct pl_joint_mark {
    plumb_body a, b;
    uint32_t row_a, row_b; // of the bodies, as last found; PL_NONE: the world
    uint32_t cluster;      // of the bodies that it was grouped with
    uint8_t what;  // 0: not solved (off, or a body of it asleep or disabled); else see plan.c
    uint8_t color; // PL_JOINT_COLORS: it is solved by itself
    uint8_t pattern;
    bool quiet; // nothing but its reaction comes of it after the step
} pl_joint_mark;

#define PL_JOINT_COLORS 64

// It is in a lane: the kernels tell its reaction.
static inline bool pl_joint_is_wide(const pl_joint_mark *mark)
{
    return mark->color < PL_JOINT_COLORS;
}

// The joints of a cluster of bodies.
typedef struct pl_joint_group {
    uint32_t first, end; // in `grouped`: in lanes, then those solved one by one
    uint32_t alone;      // the first of these
    uint32_t color_first[PL_JOINT_COLORS + 1]; // first bundle of a colour; then where the last ends
} pl_joint_group;

// Who is solved with whom: what follows from the joints and bodies that there are, and is kept from step to
// step as long as it does (plan.c); which of them are in which cluster, and their lanes (group.c).
typedef struct pl_joint_plan {
    pl_buffer marks; // pl_joint_mark a slot
    // pl_ends: rows of the bodies of each awake joint; PL_NONE where it is not solved
    pl_buffer ends;
    pl_buffer order;   // uint32_t: joints that are solved, by colour and pattern
    pl_buffer groups;  // pl_joint_group a cluster
    pl_buffer grouped; // uint32_t: joints group by group, by colour and pattern
    pl_buffer bundles; // pl_joint_bundle
    pl_buffer lanes;   // pl_joint_lane
    pl_buffer slots;   // uint32_t, two a lane: see pl_joint_call
    // of the bundles of a group, room for one group a thread; from step to step nothing is kept
    pl_buffer records;
    size_t room; // [B] of a thread
    uint32_t order_count, group_count, bundle_count, pattern_count;
    pl_joint_pattern patterns[PL_JOINT_PATTERNS];
    bool made, changed; // since the last step
    bool adrift;        // no joint is off, or ties a body to what dynamics does not move
} pl_joint_plan;

typedef struct pl_joints {
    pl_buffer items;  // pl_joint; slots are stable
    pl_buffer broken; // plumb_joint_break of the last step, room for every joint
    uint32_t count;   // slots ever used
    uint32_t live;
    uint32_t watched;   // pl_joint_is_watched
    uint32_t free_head; // PL_NONE: none
    int broken_count;
    // place in `broken` of the strain events: a joint makes one event a step at most
    uint32_t strained_first;
    int strained_count;
    pl_buffer awake; // uint32_t: slots of joints of which no body sleeps, in order
    uint32_t awake_count;
    bool awake_stale; // joints came or went, or bodies fell asleep or woke
    pl_joint_plan plan;
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
// Descriptors of joints are copied by it alone.
void pl_joint_copy_desc(plumb_joint_desc *to, const plumb_joint_desc *from);
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
// Eighth of a turn, 0 to 7 from -pi on, in which the rotation of a body row lies.
uint32_t pl_joint_eighth(const plumb_world *world, uint32_t row);
// The same as pl_joint_begin with the rows of its bodies known (PL_NONE: the world).
void pl_joint_place(const plumb_world *world, pl_joint *joint, uint32_t row_a, uint32_t row_b);
// How a lane of a bare hinge begins a step: of the joint itself, impulses are read, and turns counted
// where an angle has left the eighth in which it was last seen.
void pl_joint_start_bare(const plumb_world *world, pl_joint_lane *lane, pl_joint_start *start,
                         real h);

typedef enum pl_joint_sweep {
    PL_SWEEP_PULL,   // springs, and errors undone
    PL_SWEEP_RELAX,  // rigid rows alone, errors left
    PL_SWEEP_CLASSIC // springs, errors left: pl_joints_move undoes them
} pl_joint_sweep;

// Before anything moves, false when out of memory: rows of bodies, before clusters are made of these; the
// plan, when bodies have their slots (plan.c); groups (group.c).
bool pl_joints_look(plumb_world *world);
bool pl_joints_plan(plumb_world *world);
bool pl_joints_group(plumb_world *world);
// How many `ends` there are after pl_joints_look; whether other joints are solved than in the last step.
uint32_t pl_joints_tied(const plumb_world *world);
bool pl_joints_changed(const plumb_world *world);
// Those of the world's width.
const pl_joint_kernels *pl_joint_kernels_of(const plumb_world *world);
void pl_joints_plan_free(pl_memory *memory, pl_joint_plan *plan);

static inline const pl_joint_mark *pl_joint_marks(const pl_joints *joints)
{
    return (const pl_joint_mark *)joints->plan.marks.data;
}

static inline pl_joint_group *pl_joint_groups(const pl_joints *joints)
{
    return (pl_joint_group *)joints->plan.groups.data;
}

// The i-th joint of all groups.
static inline pl_joint *pl_joint_grouped(const pl_joints *joints, uint32_t i)
{
    return &pl_joint_items(joints)[((const uint32_t *)joints->plan.grouped.data)[i]];
}

// Somebody looks at its reaction after every step.
static inline bool pl_joint_is_watched(const plumb_joint_desc *d)
{
    return d->break_force > 0 || d->break_torque > 0 || d->break_impulse > 0 ||
           d->event_force > 0 || d->event_torque > 0;
}

// What the pattern of a joint depends on. Who changes it, or where a joint is on its bodies, or whether
// it is watched, must call pl_joints_replan.
uint32_t pl_joint_variant(const plumb_joint_desc *desc);
#define PL_JOINT_WATCHED 0x1000u // bit of it

// Warns of a motor that is on and may exert nothing.
void pl_joint_warn_of_motor(const plumb_world *world, const char *fn, const plumb_joint_desc *d);

static inline void pl_joints_replan(pl_joints *joints)
{
    joints->plan.made = false;
}

// The joints of one cluster in the hands of some threads; of one, if null.
typedef struct pl_joint_context {
    plumb_world *world;
    const pl_joint_group *group;
    pl_tasks *tasks;
    unsigned char *records; // a thread's
    real h;                 // [s] substep
} pl_joint_context;

// `thread`: whose room for records it takes.
pl_joint_context pl_joint_context_of(plumb_world *world, uint32_t cluster, pl_tasks *tasks,
                                     uint32_t thread, real h);

static inline bool pl_joints_any(const pl_joint_context *c)
{
    return c->group != NULL && c->group->end > c->group->first;
}

// The solver's part (solve.c). Prepare: poses and rows at the start of the step.
void pl_joints_prepare(const pl_joint_context *context);
void pl_joints_warm_start(const pl_joint_context *context);
// Sweeps. The first of a substep that pulls pays what J's turning owes, the first that relaxes makes
// rows at the moved poses.
void pl_joints_solve(const pl_joint_context *context, pl_joint_sweep sweep, bool first);
// Impulses and reactions of joints in lanes, into the joints.
void pl_joints_store(const pl_joint_context *context);
// Moves bodies against the errors that are left (classic solver).
void pl_joints_move(const pl_joint_context *context, real share);
// Adds the substep's reactions to those of the step, where some joint is watched.
void pl_joints_tally(const pl_joint_context *context);
void pl_joints_tally_lanes(const pl_joint_context *context);
// Takes out of the rows what lies along locked axes of their bodies: infinite mass (lock.c).
void pl_joint_lock_rows(const plumb_world *world, pl_joint *joint);
// Reactions; breaks what is loaded too much (finish.c).
void pl_joints_finish(plumb_world *world, real dt);

#endif
