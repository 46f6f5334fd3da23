// parts.h - what several kinds of joints have in common: their value; motor, spring, limit of it.
#ifndef PL_JOINT_PARTS_H
#define PL_JOINT_PARTS_H

#include "joints/joint.h"
#include "plumb/math.h"

// The joint's axis in the world.
static inline plumb_vec2 pl_joint_axis(const pl_joint *j, const pl_joint_pose *a)
{
    return plumb_rot_apply((plumb_rot){ a->c, a->s }, j->axis);
}

// Values of joints and, but for the turn, the rows that are their slopes: see pl_joint_class. The turn of B relative to A
// since the joint was made [rad], the distance of the anchors [m], the travel of B's along the axis [m], what the only
// row errs by.
real pl_value_turn(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b);
real pl_value_distance(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b);
real pl_value_travel(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b);
real pl_value_row(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b);
pl_row pl_slope_distance(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b);
pl_row pl_slope_travel(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b);
pl_row pl_slope_row(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b);

// Writes spring, lower and upper limit of a coordinate whose row is `row` (offset 0), three rows;
// of what is switched off, the type alone is set.
void pl_rows_spring_limits(const pl_joint *j, pl_row row, pl_row *out);
// The motor on a coordinate.
void pl_row_motor(const pl_joint *j, pl_row row, pl_row *out);
// `most` [N] or [N m], 0 being unbounded.
static inline real pl_joint_bound(real most)
{
    return most > 0 ? most : PL_UNBOUNDED;
}

// Gives the axis unit length, `fallback` where it is {0}. E_NOT_FINITE, E_GEOMETRY.
plumb_result pl_joint_check_axis(const plumb_world *world, const char *fn, plumb_joint_desc *desc,
                                 plumb_vec2 fallback);

#endif
