// joint.h - joints as they are stored, the rows that they are made of, the plan of who is solved with whom.
#ifndef PL_TABLE_JOINT_H
#define PL_TABLE_JOINT_H

#include "core/memory.h"
#include "plumb/joint.h"
#include "world/columns.h"

#define PL_JOINT_ROWS 6

// Where a body is, as rows see it.
typedef struct pl_joint_pose {
    real x, y;    // [m] centre, from A's centre at the start of the step
    double angle; // [rad] turned since the joint was made, full turns included
    real c, s;    // rotation
    real rx, ry;  // [m] centre to anchor, in world axes
} pl_joint_pose;

typedef enum pl_row_type {
    PL_ROW_OFF,   // not in force
    PL_ROW_EQUAL, // C = 0, or a spring
    PL_ROW_LEAST, // C >= 0
    PL_ROW_DRIVE  // J v = speed; C is the coordinate driven
} pl_row_type;

// How a row follows from where the bodies are: what the wide kernels (joint.simd.c) go by.
typedef enum pl_row_form {
    PL_FORM_OWN,     // only its kind knows
    PL_FORM_POINT_X, // pl_rows_point, always both
    PL_FORM_POINT_Y,
    PL_FORM_ALONG, // pl_row_along_axis, the axis turning with A
    PL_FORM_ANGLE, // pl_row_angle
    PL_FORM_LENGTH // pl_row_length
} pl_row_form;

// In what a spring is told.
typedef enum pl_row_spring {
    PL_SPRING_NONE,   // rigid
    PL_SPRING_HERTZ,  // frequency [1/s] and damping ratio, with the mass that the row meets, which does not change
    PL_SPRING_NEWTONS // stiffness [N/m] or [N m/rad], damper [N s/m] or [N m s/rad]
} pl_row_spring;

// The spring of a joint is told by stiffness and damper; it has one at all.
static inline bool pl_spring_is_in_newtons(const plumb_joint_desc *d)
{
    return d->stiffness > 0 || d->damper > 0;
}
static inline bool pl_joint_has_spring(const plumb_joint_desc *d)
{
    return d->hertz > 0 || pl_spring_is_in_newtons(d);
}

typedef struct pl_row {
    real ax, ay, aw, bx, by, bw; // J
    real error;                  // C
    real speed;                  // [m/s] or [rad/s] of DRIVE
    real along_a, along_b, over; // of a length: n . r of A and of B [m], 1 / |d| [1/m]; else 0
    real stiff, damp;            // of the spring, if it is one
    real most;                   // [N] or [N m] largest force either way
    pl_row_type type;
    pl_row_form form;
    pl_row_spring spring;
} pl_row;

// What the halves of a substep know of a row beside its impulse (one.c).
typedef struct pl_row_half {
    real start;  // [N s] with which the substep began
    real lag;    // [N s] of the impulse, what is not of this half
    real before; // of springs: J v at the start of the half
} pl_row_half;

typedef struct pl_rows {
    int count;       // rows; the same for all life of a joint
    int block;       // so many of the first are solved as one system; 0: none. All are of one type
    real block_most; // [N] bound of the block's force as a vector (two rows)
    pl_row row[PL_JOINT_ROWS];
} pl_rows;

#define PL_JOINT_PATTERNS 32 // joints of further patterns are solved one by one

typedef struct pl_pattern_row {
    uint8_t index; // in pl_joint.impulse
    uint8_t form;  // pl_row_form
    uint8_t type;  // pl_row_type
    uint8_t spring; // pl_row_spring
} pl_pattern_row;

typedef struct pl_joint_pattern {
    uint32_t variant;     // what joints of the pattern have in common: see plan.c
    uint32_t rows_of_all; // rows of the joint, those that are off included
    uint8_t count;        // rows in force
    uint8_t block;        // so many of the first are solved as one system
    bool bare;            // nothing but the point of a rigid hinge
    bool tempered;        // the block is a spring, or of bounded force
    bool newtons;         // it has springs in newtons
    pl_pattern_row row[PL_JOINT_ROWS];
} pl_joint_pattern;

typedef struct pl_joint pl_joint;

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
    plumb_vec2 axis;   // unit, in A's frame (the world's without A); distance, cable: as it was made
    plumb_vec2 target; // mouse: world [m]; motor: in A's frame [m]; cable: see cable.c
    real sum;          // gear, pulley: what is kept; ratchet: the tooth behind the pawl [rad]; cable: turn of its free run [rad]
    plumb_vec2 told_impulse; // [N s] on B over the last step, where it is watched
    real told_turn;          // [N m s] likewise, about B's anchor
    uint32_t strained; // 1: its reaction was beyond its bounds for events when last seen
    // What is behind here is of one step, and not saved (snapshot/list.h).
    pl_joint_pose pose_a, pose_b; // at the start of the step; first: aligned as the whole
    uint32_t slot_a, slot_b;      // solver slots
    uint32_t degree;               // see pl_joint_mark
    real spring_mass;              // [kg] see pl_joint_spring_mass
    plumb_vec2 origin; // [m] from where poses are told: A's centre at the start of the step
    // Solver: of joints solved one by one.
    real mass[PL_JOINT_ROWS]; // [kg] effective, of rows outside the block
    real inverse[3][3];       // of the block's K = J M^-1 J^T
    real turn[6], paid[6];    // change of momentum owed because J has turned, and last paid: see one.c
    real behind[2];           // shares of A's and B's kick that come behind the drift
    real lag;                 // that of a row between the two (pl_joint_lag)
    pl_row_half half[PL_JOINT_ROWS];
    pl_rows rows;
    plumb_vec2 arm_b;        // [m] from B's centre to its anchor, at the rows
    int struck;              // row of a limit that bounced in this substep; 0: none (strike.c)
    uint32_t clear;          // bit of each limit that stays apart in this substep, by its flight
    real struck_rate;        // [m/s] or [rad/s] of that row behind the blow, in the half that is solved
    real struck_change;      // [m/s] or [rad/s] to the half behind the drift
    plumb_vec2 step_impulse; // [N s] on B over the step, where it is watched; 0 between steps
    real step_turn;          // [N m s] likewise, about B's anchor
};

// A joint as the plan sees it, so that a step need not look at the joint itself.
typedef struct pl_joint_mark {
    plumb_body a, b;
    uint32_t row_a, row_b; // of the bodies, as last found; PL_NONE: the world
    uint32_t cluster;      // of the bodies that it was grouped with
    uint32_t assembly;     // bodies that joints tie together; PL_NONE: none moves (assembly.c)
    uint8_t what;  // 0: not solved (off, or a body of it asleep or disabled); else see plan.c
    uint8_t color; // PL_JOINT_COLORS: it is solved by itself
    uint8_t pattern;
    uint8_t degree; // joints in lanes at that of its bodies which has more of them; at least 1
    bool quiet; // nothing but its reaction comes of it after the step
    bool direct; // it is solved together with the others of its group: see direct.c
} pl_joint_mark;

#define PL_JOINT_COLORS 64

// The joints of a cluster of bodies.
typedef struct pl_joint_group {
    uint32_t first, end; // in `grouped`: in lanes, then those solved one by one
    uint32_t alone;      // the first of these
    uint32_t direct_first, direct_end; // columns of those solved together, of `alone` to `end`
    uint32_t color_first[PL_JOINT_COLORS + 1]; // first bundle of a colour; then where the last ends
} pl_joint_group;

// A joint that is solved together with the others of its group: its place in the order of elimination.
typedef struct pl_direct_column {
    uint32_t joint;        // in `grouped`
    uint32_t first, count; // in `entries`: columns of the same group, all of them behind it
} pl_direct_column;

// What direct_plan.c finds of the joints that are solved together, and room to solve them in (direct.c).
typedef struct pl_direct {
    pl_buffer columns; // pl_direct_column, group by group
    pl_buffer entries; // uint32_t
    pl_buffer swept;   // bool a joint of `grouped`: it is not among the columns
    pl_buffer parts;   // pl_direct_part a column
    pl_buffer blocks;  // double, PL_DIRECT_BLOCK a column, then as many an entry
    pl_buffer scratch;
    uint32_t column_count, entry_count;
} pl_direct;

#define PL_DIRECT_BLOCK (PL_JOINT_ROWS * PL_JOINT_ROWS)

// A body with joints, and the assembly that has its number (hub.c).
typedef struct pl_hub {
    double share;      // of a body, added up over its joints
    uint32_t joints;   // of a body
    uint32_t assembly; // of a body with joints
    uint32_t joints_of_all, bodies; // of an assembly
    double most;                    // share of its bodies
    double cubes;                   // sum of its bodies' joints to the third
} pl_hub;

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
    pl_buffer leaders; // uint32_t a dynamic row, while assemblies are found
    pl_buffer looped, states; // uint8_t an assembly: see assembly.c
    pl_buffer hubs; // pl_hub a dynamic row, while it is found which joints are solved together
    uint32_t assembly_count;
    bool any_whole; // assembly is kicked whole in this step
    bool any_direct; // joint is solved together with others
    size_t room; // [B] of a thread
    uint32_t exact_group; // that of hard islands, all of whose joints are alone; PL_NONE: there are none
    uint32_t order_count, group_count, bundle_count, pattern_count;
    pl_joint_pattern patterns[PL_JOINT_PATTERNS];
    pl_direct direct;
    bool made, changed; // since the last step
    bool adrift;        // no joint is off, or ties a body to what dynamics does not move
} pl_joint_plan;

typedef struct pl_joints {
    pl_buffer items;  // pl_joint; slots are stable
    pl_buffer broken; // plumb_joint_break of the last step, room for every joint
    uint32_t count;   // slots ever used
    uint32_t live;
    uint32_t watched;   // pl_joint_is_watched
    uint32_t bouncing;  // pl_joint_bounces
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

static inline void pl_joints_replan(pl_joints *joints)
{
    joints->plan.made = false;
}

#endif
