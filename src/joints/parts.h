// parts.h - what several kinds of joints put on their coordinate: motor, spring, limit.
#ifndef PL_JOINT_PARTS_H
#define PL_JOINT_PARTS_H

#include "joints/joint.h"
#include "plumb/math.h"

// [rad] turn of B relative to A since the joint was made.
static inline real pl_joint_turn(const pl_joint_pose *a, const pl_joint_pose *b)
{
    return (real)(b->angle - a->angle);
}

// The joint's axis in the world.
static inline plumb_vec2 pl_joint_axis(const pl_joint *j, const pl_joint_pose *a)
{
    return plumb_rot_apply((plumb_rot){ a->c, a->s }, j->axis);
}

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
