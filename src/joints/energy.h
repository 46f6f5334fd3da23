// energy.h - what springs of joints have stored.
#ifndef PL_JOINT_ENERGY_H
#define PL_JOINT_ENERGY_H

#include "joints/joint.h"

// [J] in the springs of one joint, of all joints that are on, asleep or not. O(1), O(joints).
double pl_joint_stored(const plumb_world *world, const pl_joint *joint);
double pl_joints_stored(const plumb_world *world);

#endif
