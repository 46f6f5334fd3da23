// joint.h - a joint as it is stored, what a kind of joint is, and what the passes call.
#ifndef PL_JOINT_H
#define PL_JOINT_H

#include "core/tasks.h"
#include "joints/rows.h"
#include "joints/wide.h"
#include "plumb/joint.h"
#include "plumb/math.h"

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
    PL_JOINT_REST = 32768,
    PL_JOINT_CENTRAL = 65536, // acts at the centres of its bodies, whatever anchor it was given
    PL_JOINT_RADII = 131072,
    PL_JOINT_REFERENCE = 262144
};

typedef struct pl_joint_class {
    const char *name;
    unsigned has; // PL_JOINT_...
    // Checks what only this kind has, and resolves its defaults; null: nothing to do.
    plumb_result (*check)(const plumb_world *world, const char *function, plumb_joint_desc *desc);
    // The axis of what has none in its descriptor, as it is made; null: that of the descriptor.
    plumb_vec2 (*direction)(const plumb_world *world, const plumb_joint_desc *desc);
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

// It is in a lane: the kernels tell its reaction.
static inline bool pl_joint_is_wide(const pl_joint_mark *mark)
{
    return mark->color < PL_JOINT_COLORS;
}

// Descriptors of joints are copied by it alone.
void pl_joint_copy_desc(plumb_joint_desc *to, const plumb_joint_desc *from);
void pl_joints_free(pl_memory *memory, pl_joints *joints);
// How many joints the solver has to do with; the others sleep. O(1) unless something changed.
uint32_t pl_joints_awake(plumb_world *world);
bool pl_joints_any_awake(const plumb_world *world);
// [m] anchor of an end, in the world.
plumb_vec2 pl_joint_anchor(const plumb_world *world, const pl_joint_end *end);
// n, and L [m], of the free run of a cable between rims whose centres are d apart; `e` [m]: radius of A less that of B. L = 0: no line
// touches both (cable.c). Inline: what draws a world is there without joints, too.
static inline plumb_vec2 pl_cable_run(plumb_vec2 d, real e, real *length)
{
    real apart;
    plumb_vec2 u = plumb_vec2_unit_and_magnitude(d, &apart);
    u = apart > 0 ? u : plumb_v2(1, 0);
    if (apart <= plumb_abs(e)) {
        *length = 0;
        return e > 0 ? plumb_vec2_right(u) : e < 0 ? plumb_vec2_left(u) : u;
    }
    const real across = e / apart, along = plumb_sqrt((1 - across) * (1 + across));
    *length = along * apart;
    return plumb_v2(along * u.x + across * u.y, along * u.y - across * u.x);
}
// [rad/s] or [m/s] of what its motor drives, if its kind has one.
real pl_joint_motor_rate(const plumb_world *world, const pl_joint *joint);
// Full turns, origin and poses up to date.
void pl_joint_begin(const plumb_world *world, pl_joint *joint);
// Eighth of a turn, 0 to 7 from -pi on, in which the rotation of a body row lies.
uint32_t pl_joint_eighth(const plumb_world *world, uint32_t row);
// [kg] of a spring told by its frequency: what its row met as the joint was made, with the masses of now. 0: what the row meets never
// changes, or there is no such spring.
real pl_joint_spring_mass(const plumb_world *world, const pl_joint *joint, uint32_t row_a,
                          uint32_t row_b);
// The same as pl_joint_begin with the rows of its bodies known (PL_NONE: the world).
void pl_joint_place(const plumb_world *world, pl_joint *joint, uint32_t row_a, uint32_t row_b);
// Impulses of a shorter step are multiplied by no more than this. What rounding and few sweeps leave of them is not in
// proportion to the step: with a step of 1/10 s behind one of 1 us, five orders of magnitude larger than what it
// should be, a hanging chain of two links flew to pieces at 1e10 m/s (tests/stability/test_step_changes.c).
#define PL_JOINT_MOST_GROWTH ((real)4)
// [-] by which the impulses of the step before are multiplied for the first substep, of h [s], of this one.
static inline real pl_joint_carried(const pl_joint *joint, real h)
{
    return joint->h > 0 ? plumb_min(h / joint->h, PL_JOINT_MOST_GROWTH) : 0;
}

// How a lane of a bare hinge begins a step: of the joint itself, impulses are read, and turns counted
// where an angle has left the eighth in which it was last seen.
void pl_joint_start_bare(const plumb_world *world, pl_joint_lane *lane, pl_joint_start *start,
                         real h);

// Whether joints are solved together, by a direct method (direct.c); then, in which order: false when out of memory.
bool pl_joints_direct(const plumb_world *world);
bool pl_direct_plan(plumb_world *world);

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
// Which joints are solved together, once there are assemblies (hub.c).
void pl_joints_find_hubs(plumb_world *world);
// Room for assemblies and hubs, which are made with the plan; then, once contacts have colours, whose kicks are whole (assembly.c).
bool pl_assemblies_reserve(plumb_world *world);
void pl_assemblies_make(plumb_world *world);
void pl_assemblies_share(plumb_world *world);
// How many `ends` there are after pl_joints_look; whether other joints are solved than in the last step.
uint32_t pl_joints_tied(const plumb_world *world);
bool pl_joints_changed(const plumb_world *world);
// Those of the world's width.
const pl_joint_kernels *pl_joint_kernels_of(const plumb_world *world);
void pl_joints_plan_free(pl_memory *memory, pl_joint_plan *plan);

// What the pattern of a joint depends on. Who changes it, or where a joint is on its bodies, or whether
// it is watched, must call pl_joints_replan.
uint32_t pl_joint_variant(const plumb_joint_desc *desc);
#define PL_JOINT_WATCHED 0x1000u // bit of it

// Warns of a motor that is on and may exert nothing.
void pl_joint_warn_of_motor(const plumb_world *world, const char *fn, const plumb_joint_desc *d);

// The joints of one cluster in the hands of some threads; of one, if null.
typedef struct pl_joint_context {
    plumb_world *world;
    const pl_joint_group *group;
    pl_tasks *tasks;
    unsigned char *records; // a thread's
    real h;                 // [s] substep
    bool exact;             // of hard islands
    pl_joint_soft rigid;    // of rows that are no springs, where they pull
    double recovery; // [-] of joints solved together: substep over that which they are as stiff for
} pl_joint_context;

// `thread`: whose room for records it takes; `soft` [s]: the substep that rigid rows are as stiff for.
pl_joint_context pl_joint_context_of(plumb_world *world, uint32_t cluster, pl_tasks *tasks,
                                     uint32_t thread, real h, real soft);

static inline bool pl_joints_any(const pl_joint_context *c)
{
    return c->group != NULL && c->group->end > c->group->first;
}

// The solver's part (solve.c, one.c). Prepare: poses and rows at the start of the step.
void pl_joints_prepare(const pl_joint_context *context);
// Limits with restitution that are met in this substep (strike.c).
void pl_joints_strike(const pl_joint_context *context);
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
// What impulses of joints in lanes have done (measure.c).
void pl_joints_measure_lanes(const pl_joint_context *context, const struct pl_measuring *m);
// PL_BODY_LOCK_... of the body at a row (PL_NONE: the world), of those that move.
uint32_t pl_joint_locks(const plumb_world *world, uint32_t row);
// Takes out of the rows what lies along locked axes of their bodies: infinite mass (lock.c).
void pl_joint_lock_rows(const plumb_world *world, pl_joint *joint);
// Reactions; breaks what is loaded too much (finish.c).
void pl_joints_finish(plumb_world *world, real dt);

#endif
