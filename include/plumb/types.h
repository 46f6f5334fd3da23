/// types.h - the small value types: vector, rotation, transform, box, matrices.
/// The functions on them are in math.h.
#ifndef PLUMB_TYPES_H
#define PLUMB_TYPES_H

#include "plumb/base.h"

PLUMB_BEGIN

/// A vector or point in the plane, in metres unless its user says otherwise.
typedef struct plumb_vec2 {
    plumb_real x;
    plumb_real y;
} plumb_vec2;

/// A rotation as cosine and sine. {0, 0} is not a rotation, but where a descriptor holds
/// one it means "no rotation".
typedef struct plumb_rot {
    plumb_real c;
    plumb_real s;
} plumb_rot;

/// A rigid transform: rotate by q, then translate by p.
typedef struct plumb_transform {
    plumb_vec2 p;
    plumb_rot q;
} plumb_transform;

/// An axis-aligned box. Empty when min > max on an axis.
typedef struct plumb_aabb {
    plumb_vec2 min;
    plumb_vec2 max;
} plumb_aabb;

/// A 2x2 matrix, rows first: m[row][column].
typedef struct plumb_mat2 {
    plumb_real m[2][2];
} plumb_mat2;

/// A homogeneous 3x3 matrix, rows first: m[row][column]; points are columns (x, y, 1).
typedef struct plumb_mat3 {
    plumb_real m[3][3];
} plumb_mat3;

PLUMB_END

#endif
