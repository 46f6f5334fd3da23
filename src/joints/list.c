// list.c - every kind of joint, from the one list in plumb/joint.h.
#include "joints/joint.h"

const pl_joint_class *const pl_joint_classes[] = {
#define CLASS_ROW(NAME, name, text) [PLUMB_##NAME] = &pl_joint_##name,
    PLUMB_JOINT_LIST(CLASS_ROW)
#undef CLASS_ROW
};

const int pl_joint_class_count = (int)(sizeof pl_joint_classes / sizeof pl_joint_classes[0]);
