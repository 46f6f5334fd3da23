/// math.h - the plane geometry of a physics text: vectors, rotations, rigid transforms, boxes.
/// Matrices, homogeneous transforms and the screen are in matrix.h.
///
///     plumb_vec2 v = plumb_vec2_polar(20, plumb_radians(35));       // 20 m/s at 35 degrees
///     plumb_real uphill = plumb_vec2_component(v, slope_direction); // scalar projection
///     plumb_vec2 r = plumb_rot_apply(plumb_rot_make(plumb_radians(90)), v); // turned left
///
/// Everything is a pure function of its arguments: no state, no allocation, any thread.
/// Units are those of the arguments (metres, seconds ...), angles are radians, counter-clockwise
/// from +x to +y. NaN and infinity pass through; callers at the API check with *_is_finite.
/// Only + - * / and the square root are used, which IEEE 754 defines to the last bit, so results
/// are the same on every compiler and machine (build with -ffp-contract=off).
#ifndef PLUMB_MATH_H
#define PLUMB_MATH_H

#include <math.h> // sqrt and sqrtf only: the one function besides + - * / that IEEE 754 fixes

#include "plumb/types.h"

PLUMB_BEGIN

// The symbols tell the precision: see plumb_real.
#define plumb_sincos     PLUMB_SYMBOL(plumb_sincos)
#define plumb_atan2      PLUMB_SYMBOL(plumb_atan2)
#define plumb_angle_wrap PLUMB_SYMBOL(plumb_angle_wrap)

/// A literal as a plumb_real, without conversion warnings in either build: PLUMB_REAL(0.5).
#define PLUMB_REAL(literal) ((plumb_real)(literal))

#define PLUMB_PI PLUMB_REAL(3.14159265358979323846) ///< [rad] half a turn

/// [m] a vector shorter than this has no direction: its unit vector is zero. The square is still
/// a normal float, and it is a thousandth of the size of a proton.
#define PLUMB_MAGNITUDE_MIN PLUMB_REAL(1e-18)

// --- Scalars -------------------------------------------------------------------------------------

/// Square root, correctly rounded; NaN for a negative argument.
static inline plumb_real plumb_sqrt(plumb_real x)
{
#if PLUMB_REAL_IS_DOUBLE
    return sqrt(x);
#else
    return sqrtf(x);
#endif
}

/// |x|.
static inline plumb_real plumb_abs(plumb_real x)
{
    return x < 0 ? -x : x;
}

/// The smaller of two; b when either is NaN.
static inline plumb_real plumb_min(plumb_real a, plumb_real b)
{
    return a < b ? a : b;
}

/// The larger of two; b when either is NaN.
static inline plumb_real plumb_max(plumb_real a, plumb_real b)
{
    return a > b ? a : b;
}

/// x, or the nearer end of [low, high]; low when x is NaN. Needs low <= high.
static inline plumb_real plumb_clamp(plumb_real x, plumb_real low, plumb_real high)
{
    return plumb_min(plumb_max(x, low), high);
}

/// True for every number that is neither NaN nor infinite.
static inline bool plumb_is_finite(plumb_real x)
{
    return x - x == 0;
}

/// Degrees to radians: 180 degrees are pi.
static inline plumb_real plumb_radians(plumb_real degrees)
{
    return degrees * (PLUMB_PI / 180);
}

/// Radians to degrees.
static inline plumb_real plumb_degrees(plumb_real radians)
{
    return radians * (180 / PLUMB_PI);
}

/// Cosine and sine of an angle [rad], as a unit rotation.
/// Within 1 ulp of plumb_real for |angle| <= 1e4 (tested against long double; 4 are promised).
/// Beyond that the angle is still reduced with 150 bits of pi, up to 1e6 rad; past it, with the
/// double nearest to pi, so the result remains a unit rotation, but its angle is only good to
/// |angle| * 2e-16. sin(-a) == -sin(a) and cos(-a) == cos(a) exactly. Not finite gives NaN.
PLUMB_API void plumb_sincos(plumb_real angle, plumb_rot *out);

/// Angle of the point (x, y) seen from the origin [rad], in (-pi, pi]; 0 for (0, 0).
/// Within 2 ulp of plumb_real (tested against long double). The sign of a zero is ignored.
/// Not finite gives NaN.
PLUMB_API plumb_real plumb_atan2(plumb_real y, plumb_real x);

/// The same direction as an angle in (-pi, pi] [rad]. Reduction as in plumb_sincos.
PLUMB_API plumb_real plumb_angle_wrap(plumb_real angle);

// --- Vectors -------------------------------------------------------------------------------------

/// The vector (x, y).
static inline plumb_vec2 plumb_v2(plumb_real x, plumb_real y)
{
    plumb_vec2 v = { x, y };
    return v;
}

/// The vector of this magnitude that points at this angle [rad]: its components are
/// (magnitude cos angle, magnitude sin angle).
static inline plumb_vec2 plumb_vec2_polar(plumb_real magnitude, plumb_real angle)
{
    plumb_rot q;
    plumb_sincos(angle, &q);
    return plumb_v2(magnitude * q.c, magnitude * q.s);
}

/// True when both components are finite.
static inline bool plumb_vec2_is_finite(plumb_vec2 v)
{
    return plumb_is_finite(v.x) && plumb_is_finite(v.y);
}

/// a + b.
static inline plumb_vec2 plumb_vec2_add(plumb_vec2 a, plumb_vec2 b)
{
    return plumb_v2(a.x + b.x, a.y + b.y);
}

/// a - b: the arrow from point b to point a.
static inline plumb_vec2 plumb_vec2_sub(plumb_vec2 a, plumb_vec2 b)
{
    return plumb_v2(a.x - b.x, a.y - b.y);
}

/// -v.
static inline plumb_vec2 plumb_vec2_neg(plumb_vec2 v)
{
    return plumb_v2(-v.x, -v.y);
}

/// s v.
static inline plumb_vec2 plumb_vec2_scale(plumb_real s, plumb_vec2 v)
{
    return plumb_v2(s * v.x, s * v.y);
}

/// a + s b: where one is after time s, having started at a with velocity b.
static inline plumb_vec2 plumb_vec2_add_scaled(plumb_vec2 a, plumb_real s, plumb_vec2 b)
{
    return plumb_v2(a.x + s * b.x, a.y + s * b.y);
}

/// Componentwise minimum.
static inline plumb_vec2 plumb_vec2_min(plumb_vec2 a, plumb_vec2 b)
{
    return plumb_v2(plumb_min(a.x, b.x), plumb_min(a.y, b.y));
}

/// Componentwise maximum.
static inline plumb_vec2 plumb_vec2_max(plumb_vec2 a, plumb_vec2 b)
{
    return plumb_v2(plumb_max(a.x, b.x), plumb_max(a.y, b.y));
}

/// Dot product |a| |b| cos(angle between).
static inline plumb_real plumb_vec2_dot(plumb_vec2 a, plumb_vec2 b)
{
    return a.x * b.x + a.y * b.y;
}

/// Cross product |a| |b| sin(angle from a to b): the z component; positive when b is to the left
/// of a. Twice the signed area of the triangle 0, a, b.
static inline plumb_real plumb_vec2_cross(plumb_vec2 a, plumb_vec2 b)
{
    return a.x * b.y - a.y * b.x;
}

/// v turned a quarter to the left: (-y, x). Also the cross product z x v, so w * left(r) is the
/// velocity of a point at r on a body that turns at w.
static inline plumb_vec2 plumb_vec2_left(plumb_vec2 v)
{
    return plumb_v2(-v.y, v.x);
}

/// v turned a quarter to the right: (y, -x). The outward normal of a counter-clockwise edge.
static inline plumb_vec2 plumb_vec2_right(plumb_vec2 v)
{
    return plumb_v2(v.y, -v.x);
}

/// |v|^2.
static inline plumb_real plumb_vec2_magnitude_sq(plumb_vec2 v)
{
    return v.x * v.x + v.y * v.y;
}

/// |v|, by Pythagoras. Exact to rounding for components from 1e-18 to 1e18 in magnitude; in the
/// float build larger ones overflow to infinity and smaller ones vanish.
static inline plumb_real plumb_vec2_magnitude(plumb_vec2 v)
{
    return plumb_sqrt(plumb_vec2_magnitude_sq(v));
}

/// Distance of two points.
static inline plumb_real plumb_vec2_distance(plumb_vec2 a, plumb_vec2 b)
{
    return plumb_vec2_magnitude(plumb_vec2_sub(b, a));
}

/// Squared distance of two points.
static inline plumb_real plumb_vec2_distance_sq(plumb_vec2 a, plumb_vec2 b)
{
    return plumb_vec2_magnitude_sq(plumb_vec2_sub(b, a));
}

/// The unit vector v / |v|, and |v| in *magnitude (may be null). A vector shorter than
/// PLUMB_MAGNITUDE_MIN has no direction: the result is (0, 0) and the magnitude 0.
static inline plumb_vec2 plumb_vec2_unit_and_magnitude(plumb_vec2 v, plumb_real *magnitude)
{
    plumb_real length = plumb_vec2_magnitude(v);
    bool directed = !(length < PLUMB_MAGNITUDE_MIN);
    if (magnitude != NULL) {
        *magnitude = directed ? length : 0;
    }
    return directed ? plumb_v2(v.x / length, v.y / length) : plumb_v2(0, 0);
}

/// The unit vector v / |v|; (0, 0) for a vector shorter than PLUMB_MAGNITUDE_MIN.
static inline plumb_vec2 plumb_vec2_unit(plumb_vec2 v)
{
    return plumb_vec2_unit_and_magnitude(v, NULL);
}

/// The direction of v as an angle from +x [rad], in (-pi, pi]; 0 for (0, 0).
static inline plumb_real plumb_vec2_angle(plumb_vec2 v)
{
    return plumb_atan2(v.y, v.x);
}

/// The turn that takes the direction of a to that of b [rad], in (-pi, pi], positive to the left;
/// 0 when either is (0, 0).
static inline plumb_real plumb_vec2_turn(plumb_vec2 a, plumb_vec2 b)
{
    return plumb_atan2(plumb_vec2_cross(a, b), plumb_vec2_dot(a, b));
}

/// The angle between two vectors [rad], 0 to pi; 0 when either is (0, 0). From atan2, since the
/// textbook's arc cosine of the dot product loses half the digits at small angles.
static inline plumb_real plumb_vec2_angle_between(plumb_vec2 a, plumb_vec2 b)
{
    return plumb_abs(plumb_vec2_turn(a, b));
}

/// Scalar projection: the signed length of the shadow of v on the direction `onto`, any
/// magnitude; 0 when `onto` has no direction.
static inline plumb_real plumb_vec2_component(plumb_vec2 v, plumb_vec2 onto)
{
    return plumb_vec2_dot(v, plumb_vec2_unit(onto));
}

/// Vector projection: the part of v along `onto`; (0, 0) when `onto` has no direction.
static inline plumb_vec2 plumb_vec2_project(plumb_vec2 v, plumb_vec2 onto)
{
    plumb_vec2 u = plumb_vec2_unit(onto);
    return plumb_vec2_scale(plumb_vec2_dot(v, u), u);
}

/// The rest of that: the part of v at right angles to `from`; v when `from` has no direction.
static inline plumb_vec2 plumb_vec2_reject(plumb_vec2 v, plumb_vec2 from)
{
    return plumb_vec2_sub(v, plumb_vec2_project(v, from));
}

/// v mirrored by a wall of this unit normal: v - 2 (v . n) n.
static inline plumb_vec2 plumb_vec2_reflect(plumb_vec2 v, plumb_vec2 normal)
{
    return plumb_vec2_add_scaled(v, -2 * plumb_vec2_dot(v, normal), normal);
}

/// The point t of the way from a to b; exactly a at 0 and exactly b at 1. t may lie outside 0..1.
static inline plumb_vec2 plumb_vec2_lerp(plumb_vec2 a, plumb_vec2 b, plumb_real t)
{
    return plumb_v2((1 - t) * a.x + t * b.x, (1 - t) * a.y + t * b.y);
}

// --- Rotations -----------------------------------------------------------------------------------

/// No rotation.
static inline plumb_rot plumb_rot_identity(void)
{
    plumb_rot q = { 1, 0 };
    return q;
}

/// The rotation by an angle [rad].
static inline plumb_rot plumb_rot_make(plumb_real angle)
{
    plumb_rot q;
    plumb_sincos(angle, &q);
    return q;
}

/// The angle of a rotation [rad], in (-pi, pi].
static inline plumb_real plumb_rot_angle(plumb_rot q)
{
    return plumb_atan2(q.s, q.c);
}

/// The rotation that takes +x to the direction of v; none when v has no direction.
static inline plumb_rot plumb_rot_from_direction(plumb_vec2 v)
{
    plumb_vec2 u = plumb_vec2_unit(v);
    plumb_rot q = { u.x, u.y };
    return u.x == 0 && u.y == 0 ? plumb_rot_identity() : q;
}

/// Scaled back to unit length; none when q is {0, 0}.
static inline plumb_rot plumb_rot_normalize(plumb_rot q)
{
    return plumb_rot_from_direction(plumb_v2(q.c, q.s));
}

/// True when c^2 + s^2 is 1 within 1e-3: a rotation, give or take what a few steps do to it.
static inline bool plumb_rot_is_unit(plumb_rot q)
{
    return plumb_abs(q.c * q.c + q.s * q.s - 1) < PLUMB_REAL(1e-3);
}

/// The opposite rotation.
static inline plumb_rot plumb_rot_inverse(plumb_rot q)
{
    plumb_rot r = { q.c, -q.s };
    return r;
}

/// a b: the angles add.
static inline plumb_rot plumb_rot_mul(plumb_rot a, plumb_rot b)
{
    plumb_rot r = { a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s };
    return r;
}

/// a^-1 b: the angle of b as seen from a.
static inline plumb_rot plumb_rot_inv_mul(plumb_rot a, plumb_rot b)
{
    plumb_rot r = { a.c * b.c + a.s * b.s, a.c * b.s - a.s * b.c };
    return r;
}

/// v turned by q.
static inline plumb_vec2 plumb_rot_apply(plumb_rot q, plumb_vec2 v)
{
    return plumb_v2(q.c * v.x - q.s * v.y, q.s * v.x + q.c * v.y);
}

/// v turned back by q.
static inline plumb_vec2 plumb_rot_inv_apply(plumb_rot q, plumb_vec2 v)
{
    return plumb_v2(q.c * v.x + q.s * v.y, q.c * v.y - q.s * v.x);
}

/// [rad] up to here plumb_rot_integrate is exact to rounding by its series alone: the first term
/// left out, 2 * 1382/155925 (d/2)^11, is below half a rounding of 1.
#if PLUMB_REAL_IS_DOUBLE
#define PLUMB_ROT_SMALL_TURN PLUMB_REAL(0.0625)
#else
#define PLUMB_ROT_SMALL_TURN PLUMB_REAL(0.5)
#endif

/// q turned by a further angle [rad] (angular velocity times time): exact to rounding, and the
/// result stays a unit rotation however often it is repeated, without a square root.
/// With t = tan(angle / 2), cos = (1 - t^2) / (1 + t^2) and sin = 2 t / (1 + t^2); t is the Taylor
/// series of the tangent. Then one Newton step of 1/sqrt(c^2 + s^2) about 1. Needs q near unit.
static inline plumb_rot plumb_rot_integrate(plumb_rot q, plumb_real angle)
{
    plumb_rot d;
    if (plumb_abs(angle) <= PLUMB_ROT_SMALL_TURN) {
        plumb_real h = angle / 2;
        plumb_real z = h * h;
        plumb_real t = PLUMB_REAL(17.0 / 315.0) + z * PLUMB_REAL(62.0 / 2835.0);
        t = h + h * z * (PLUMB_REAL(1.0 / 3.0) + z * (PLUMB_REAL(2.0 / 15.0) + z * t));
        plumb_real k = 1 / (1 + t * t);
        d.c = (1 - t * t) * k;
        d.s = 2 * t * k;
    } else {
        plumb_sincos(angle, &d);
    }
    plumb_rot r = plumb_rot_mul(q, d);
    plumb_real k = (3 - (r.c * r.c + r.s * r.s)) / 2;
    r.c *= k;
    r.s *= k;
    return r;
}

/// From a (t = 0) to b (t = 1) at an even rate, the shorter way around (counter-clockwise of two equal ones).
static inline plumb_rot plumb_rot_blend(plumb_rot a, plumb_rot b, plumb_real t)
{
    plumb_rot way = plumb_rot_inv_mul(a, b);
    return plumb_rot_mul(a, plumb_rot_make(t * plumb_atan2(way.s, way.c)));
}

// --- Rigid transforms ----------------------------------------------------------------------------

/// No movement.
static inline plumb_transform plumb_transform_identity(void)
{
    plumb_transform t = { { 0, 0 }, { 1, 0 } };
    return t;
}

/// Turn by an angle [rad], then move by p.
static inline plumb_transform plumb_transform_make(plumb_vec2 p, plumb_real angle)
{
    plumb_transform t;
    t.p = p;
    t.q = plumb_rot_make(angle);
    return t;
}

/// A point of the body's own frame, in the frame that t maps to (usually the world).
static inline plumb_vec2 plumb_transform_apply(plumb_transform t, plumb_vec2 point)
{
    return plumb_vec2_add(plumb_rot_apply(t.q, point), t.p);
}

/// A world point in the body's own frame.
static inline plumb_vec2 plumb_transform_inv_apply(plumb_transform t, plumb_vec2 point)
{
    return plumb_rot_inv_apply(t.q, plumb_vec2_sub(point, t.p));
}

/// a b: applies b first.
static inline plumb_transform plumb_transform_mul(plumb_transform a, plumb_transform b)
{
    plumb_transform r;
    r.p = plumb_transform_apply(a, b.p);
    r.q = plumb_rot_mul(a.q, b.q);
    return r;
}

/// a^-1 b: b as seen from a.
static inline plumb_transform plumb_transform_inv_mul(plumb_transform a, plumb_transform b)
{
    plumb_transform r;
    r.p = plumb_transform_inv_apply(a, b.p);
    r.q = plumb_rot_inv_mul(a.q, b.q);
    return r;
}

/// From a (t = 0) to b (t = 1): the origin on a straight line, the rotation the shorter way around. For bodies
/// between two steps see plumb/loop.h.
static inline plumb_transform plumb_transform_blend(plumb_transform a, plumb_transform b,
                                                    plumb_real t)
{
    plumb_transform r;
    r.p = plumb_vec2_lerp(a.p, b.p, t);
    r.q = plumb_rot_blend(a.q, b.q, t);
    return r;
}

/// The transform back.
static inline plumb_transform plumb_transform_inverse(plumb_transform t)
{
    plumb_transform r;
    r.q = plumb_rot_inverse(t.q);
    r.p = plumb_vec2_neg(plumb_rot_inv_apply(t.q, t.p));
    return r;
}

// --- Axis-aligned boxes --------------------------------------------------------------------------

/// The box from min to max.
static inline plumb_aabb plumb_aabb_make(plumb_vec2 min, plumb_vec2 max)
{
    plumb_aabb box;
    box.min = min;
    box.max = max;
    return box;
}

/// The empty box: the neutral element of union.
static inline plumb_aabb plumb_aabb_empty(void)
{
    return plumb_aabb_make(plumb_v2(PLUMB_REAL_MAX, PLUMB_REAL_MAX),
                           plumb_v2(-PLUMB_REAL_MAX, -PLUMB_REAL_MAX));
}

/// True when the box holds no point, not even one.
static inline bool plumb_aabb_is_empty(plumb_aabb box)
{
    return box.min.x > box.max.x || box.min.y > box.max.y;
}

/// The smallest box around both.
static inline plumb_aabb plumb_aabb_union(plumb_aabb a, plumb_aabb b)
{
    return plumb_aabb_make(plumb_vec2_min(a.min, b.min), plumb_vec2_max(a.max, b.max));
}

/// The smallest box around a box and a point.
static inline plumb_aabb plumb_aabb_add_point(plumb_aabb box, plumb_vec2 point)
{
    return plumb_aabb_make(plumb_vec2_min(box.min, point), plumb_vec2_max(box.max, point));
}

/// True when the boxes share at least a point; touching edges count.
static inline bool plumb_aabb_overlap(plumb_aabb a, plumb_aabb b)
{
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y;
}

/// True when `inner` lies in `outer`; common edges are allowed.
static inline bool plumb_aabb_contains(plumb_aabb outer, plumb_aabb inner)
{
    return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && inner.max.x <= outer.max.x &&
           inner.max.y <= outer.max.y;
}

/// True when the point lies in the box or on its edge.
static inline bool plumb_aabb_contains_point(plumb_aabb box, plumb_vec2 point)
{
    return plumb_aabb_contains(box, plumb_aabb_make(point, point));
}

/// Grown by a margin on every side; a negative one shrinks, and may leave an empty box.
static inline plumb_aabb plumb_aabb_expand(plumb_aabb box, plumb_real margin)
{
    return plumb_aabb_make(plumb_v2(box.min.x - margin, box.min.y - margin),
                           plumb_v2(box.max.x + margin, box.max.y + margin));
}

/// The middle of the box. Not defined for an empty one.
static inline plumb_vec2 plumb_aabb_center(plumb_aabb box)
{
    return plumb_v2((box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2);
}

/// Half the width and half the height. Not defined for an empty one.
static inline plumb_vec2 plumb_aabb_extent(plumb_aabb box)
{
    return plumb_v2((box.max.x - box.min.x) / 2, (box.max.y - box.min.y) / 2);
}

PLUMB_END

#endif
