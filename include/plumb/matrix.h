/// matrix.h - 2x2 matrices, homogeneous 3x3 transforms of the plane and their inverses, and the
/// step between y-up world metres and y-down screen pixels. Included by math.h.
///
///     plumb_mat3 m = plumb_mat3_rotation_about(hinge, plumb_radians(90));
///     plumb_vec2 q = plumb_mat3_apply(m, p);            // p turned about the hinge
///     plumb_vec2 pixel = plumb_view_to_screen(view, q); // where it is drawn
///
/// Rows first, points are columns: the product a b applies b first. Pure functions, any thread.
#ifndef PLUMB_MATRIX_H
#define PLUMB_MATRIX_H

#include "plumb/math.h"

PLUMB_BEGIN

// --- Matrices, 2x2 -------------------------------------------------------------------------------

/// The matrix with rows (a, b) and (c, d).
static inline plumb_mat2 plumb_mat2_rows(plumb_real a, plumb_real b, plumb_real c, plumb_real d)
{
    plumb_mat2 r = { { { a, b }, { c, d } } };
    return r;
}

/// The identity matrix.
static inline plumb_mat2 plumb_mat2_identity(void)
{
    return plumb_mat2_rows(1, 0, 0, 1);
}

/// The matrix that turns vectors by an angle [rad].
static inline plumb_mat2 plumb_mat2_rotation(plumb_real angle)
{
    plumb_rot q;
    plumb_sincos(angle, &q);
    return plumb_mat2_rows(q.c, -q.s, q.s, q.c);
}

/// Matrix times vector.
static inline plumb_vec2 plumb_mat2_apply(plumb_mat2 a, plumb_vec2 v)
{
    return plumb_v2(a.m[0][0] * v.x + a.m[0][1] * v.y, a.m[1][0] * v.x + a.m[1][1] * v.y);
}

/// Matrix product a b: applies b first.
static inline plumb_mat2 plumb_mat2_mul(plumb_mat2 a, plumb_mat2 b)
{
    return plumb_mat2_rows(a.m[0][0] * b.m[0][0] + a.m[0][1] * b.m[1][0],
                           a.m[0][0] * b.m[0][1] + a.m[0][1] * b.m[1][1],
                           a.m[1][0] * b.m[0][0] + a.m[1][1] * b.m[1][0],
                           a.m[1][0] * b.m[0][1] + a.m[1][1] * b.m[1][1]);
}

/// Rows and columns exchanged; the inverse of a rotation.
static inline plumb_mat2 plumb_mat2_transpose(plumb_mat2 a)
{
    return plumb_mat2_rows(a.m[0][0], a.m[1][0], a.m[0][1], a.m[1][1]);
}

/// Determinant: by how much areas grow; negative when the matrix mirrors.
static inline plumb_real plumb_mat2_determinant(plumb_mat2 a)
{
    return a.m[0][0] * a.m[1][1] - a.m[0][1] * a.m[1][0];
}

/// The inverse, by Cramer's rule. False, and *out untouched, when the determinant is 0 or the
/// inverse is not finite.
static inline bool plumb_mat2_inverse(plumb_mat2 a, plumb_mat2 *out)
{
    plumb_real k = 1 / plumb_mat2_determinant(a);
    plumb_mat2 r = plumb_mat2_rows(k * a.m[1][1], -k * a.m[0][1], -k * a.m[1][0], k * a.m[0][0]);
    if (!plumb_is_finite(k) || !plumb_is_finite(r.m[0][0] + r.m[0][1] + r.m[1][0] + r.m[1][1])) {
        return false;
    }
    *out = r;
    return true;
}

// --- Matrices, homogeneous 3x3 -------------------------------------------------------------------

/// The affine matrix with rows (a, b, tx), (c, d, ty), (0, 0, 1).
static inline plumb_mat3 plumb_mat3_affine(plumb_mat2 linear, plumb_vec2 t)
{
    plumb_mat3 r = { { { linear.m[0][0], linear.m[0][1], t.x },
                       { linear.m[1][0], linear.m[1][1], t.y },
                       { 0, 0, 1 } } };
    return r;
}

/// The identity matrix.
static inline plumb_mat3 plumb_mat3_identity(void)
{
    return plumb_mat3_affine(plumb_mat2_identity(), plumb_v2(0, 0));
}

/// Moves points by t. Its inverse is the translation by -t.
static inline plumb_mat3 plumb_mat3_translation(plumb_vec2 t)
{
    return plumb_mat3_affine(plumb_mat2_identity(), t);
}

/// Turns points about the origin by an angle [rad]. Its inverse is the rotation by -angle.
static inline plumb_mat3 plumb_mat3_rotation(plumb_real angle)
{
    return plumb_mat3_affine(plumb_mat2_rotation(angle), plumb_v2(0, 0));
}

/// The affine matrix that does `linear` about a fixed point instead of the origin:
/// T(point) linear T(-point), multiplied out.
static inline plumb_mat3 plumb_mat3_about(plumb_mat2 linear, plumb_vec2 point)
{
    return plumb_mat3_affine(linear, plumb_vec2_sub(point, plumb_mat2_apply(linear, point)));
}

/// Turns points about any fixed point by an angle [rad]. Its inverse turns by -angle about the
/// same point.
static inline plumb_mat3 plumb_mat3_rotation_about(plumb_vec2 point, plumb_real angle)
{
    return plumb_mat3_about(plumb_mat2_rotation(angle), point);
}

/// Stretches by sx along x and sy along y, about the origin. Its inverse is the scale by 1 / sx,
/// 1 / sy; a factor of 0 has none.
static inline plumb_mat3 plumb_mat3_scale(plumb_real sx, plumb_real sy)
{
    return plumb_mat3_affine(plumb_mat2_rows(sx, 0, 0, sy), plumb_v2(0, 0));
}

/// Stretches about any fixed point.
static inline plumb_mat3 plumb_mat3_scale_about(plumb_vec2 point, plumb_real sx, plumb_real sy)
{
    return plumb_mat3_about(plumb_mat2_rows(sx, 0, 0, sy), point);
}

/// The matrix of a rigid transform.
static inline plumb_mat3 plumb_mat3_from_transform(plumb_transform t)
{
    return plumb_mat3_affine(plumb_mat2_rows(t.q.c, -t.q.s, t.q.s, t.q.c), t.p);
}

/// The upper left 2x2 block: what happens to vectors.
static inline plumb_mat2 plumb_mat3_linear(plumb_mat3 a)
{
    return plumb_mat2_rows(a.m[0][0], a.m[0][1], a.m[1][0], a.m[1][1]);
}

/// Matrix product a b: applies b first.
static inline plumb_mat3 plumb_mat3_mul(plumb_mat3 a, plumb_mat3 b)
{
    plumb_mat3 r;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            r.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
        }
    }
    return r;
}

/// Affine matrix times point (x, y, 1). The last row is taken to be (0, 0, 1).
static inline plumb_vec2 plumb_mat3_apply(plumb_mat3 a, plumb_vec2 point)
{
    return plumb_v2(a.m[0][0] * point.x + a.m[0][1] * point.y + a.m[0][2],
                    a.m[1][0] * point.x + a.m[1][1] * point.y + a.m[1][2]);
}

/// Affine matrix times vector (x, y, 0): directions and velocities are not translated.
static inline plumb_vec2 plumb_mat3_apply_vector(plumb_mat3 a, plumb_vec2 v)
{
    return plumb_v2(a.m[0][0] * v.x + a.m[0][1] * v.y, a.m[1][0] * v.x + a.m[1][1] * v.y);
}

/// The inverse of a translation, a rotation or a product of such: transpose the rotation, then
/// turn the translation back with it. Wrong for anything that scales: see the affine one.
static inline plumb_mat3 plumb_mat3_rigid_inverse(plumb_mat3 a)
{
    plumb_mat2 back = plumb_mat2_transpose(plumb_mat3_linear(a));
    plumb_vec2 t = plumb_v2(a.m[0][2], a.m[1][2]);
    return plumb_mat3_affine(back, plumb_vec2_neg(plumb_mat2_apply(back, t)));
}

/// The inverse of any affine matrix (last row 0 0 1). False, and *out untouched, when it has none.
static inline bool plumb_mat3_affine_inverse(plumb_mat3 a, plumb_mat3 *out)
{
    plumb_mat2 back;
    if (!plumb_mat2_inverse(plumb_mat3_linear(a), &back)) {
        return false;
    }
    plumb_vec2 t = plumb_v2(a.m[0][2], a.m[1][2]);
    *out = plumb_mat3_affine(back, plumb_vec2_neg(plumb_mat2_apply(back, t)));
    return true;
}

// --- World metres and screen pixels --------------------------------------------------------------

/// How a y-up world is seen on a y-down screen (pixel (0, 0) is the top left corner).
typedef struct plumb_view {
    plumb_vec2 origin;           ///< [px] where on the screen the world's origin is drawn
    plumb_real pixels_per_metre; ///< [px/m] > 0
} plumb_view;

/// World point [m, y up] to screen point [px, y down].
static inline plumb_vec2 plumb_view_to_screen(plumb_view view, plumb_vec2 world)
{
    return plumb_v2(view.origin.x + world.x * view.pixels_per_metre,
                    view.origin.y - world.y * view.pixels_per_metre);
}

/// Screen point [px, y down] to world point [m, y up]: a mouse click, for instance.
static inline plumb_vec2 plumb_view_to_world(plumb_view view, plumb_vec2 screen)
{
    return plumb_v2((screen.x - view.origin.x) / view.pixels_per_metre,
                    (view.origin.y - screen.y) / view.pixels_per_metre);
}

/// World vector (a velocity [m/s], a difference [m]) to screen vector [px/s, px].
static inline plumb_vec2 plumb_view_vector_to_screen(plumb_view view, plumb_vec2 v)
{
    return plumb_v2(v.x * view.pixels_per_metre, -v.y * view.pixels_per_metre);
}

/// Screen vector to world vector.
static inline plumb_vec2 plumb_view_vector_to_world(plumb_view view, plumb_vec2 v)
{
    return plumb_v2(v.x / view.pixels_per_metre, -v.y / view.pixels_per_metre);
}

/// An angle changes its sign between the two, in either direction: what turns to the left in the
/// world has falling y on the screen.
static inline plumb_real plumb_view_angle(plumb_real angle)
{
    return -angle;
}

/// The same step from world to screen as a matrix, to be multiplied with others.
static inline plumb_mat3 plumb_mat3_view(plumb_view view)
{
    plumb_real k = view.pixels_per_metre;
    return plumb_mat3_affine(plumb_mat2_rows(k, 0, 0, -k), view.origin);
}

PLUMB_END

#endif
