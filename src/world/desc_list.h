// desc_list.h - the members of the descriptors that a world keeps, so that they are kept one by one: without
// the user's padding between them, which images of equal worlds would not have in common. A member that is
// missing here fails to compile in snapshot/complete.c.
//
// user_data comes last: it is the one member that means something in this process only.
#ifndef PL_DESC_LIST_H
#define PL_DESC_LIST_H

#include "schema/body.h"
#include "schema/joint.h"

// clang-format off
#define PL_BODY_DESC(X) PL_BODY_ROWS(PL_ROW_MEMBERS, X) X(user_data)

// Points lie behind it.
#define PL_SHAPE_DESC(X)                                                                           \
    X(kind) X(center) X(radius) X(half) X(angle) X(count) X(closed) X(density) X(material)         \
    X(filter.category) X(filter.mask) X(filter.group) X(filter.nothing)                            \
    X(one_way.direction) X(one_way.angle) X(sensor) X(user_data)

#define PL_JOINT_DESC(X) X(body_a) X(body_b) PL_JOINT_DESC_ROWS(PL_ROW_MEMBERS, X) X(user_data)

#define PL_LAW_DESC(X)                                                                             \
    X(kind) X(hold) X(falloff) X(combine) X(priority) X(body) X(position) X(angle) X(vector)       \
    X(strength) X(softening) X(radius) X(half) X(categories)
// Texts lie in the list of formulas.
#define PL_LAW_TEXTS(X) X(formula_x) X(formula_y) X(potential)

#define PL_CHARACTER_DESC(X)                                                                       \
    X(up) X(max_slope) X(skin) X(step_height) X(step_width) X(snap_distance) X(acceleration)       \
    X(air_acceleration) X(max_fall_speed) X(mass) X(push_force) X(no_steps) X(no_snap) X(no_push)  \
    X(no_air_control)
// clang-format on

// A statement of `LIST(PL_COPY_MEMBER)`: *to becomes *from, and keeps its own padding.
#define PL_COPY_MEMBER(path) to->path = from->path;

// A term of `true LIST(PL_SAME_MEMBER)`: whether *a and *b are the same.
#define PL_SAME_MEMBER(path) &&memcmp(&a->path, &b->path, sizeof a->path) == 0

#endif
