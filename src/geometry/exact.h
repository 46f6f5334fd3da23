// exact.h - the sign of a turn, computed so that it is right also for points almost in line, and
// what the outline functions share.
//
// A plain cross product in rounded arithmetic can call a left turn a right turn; a hull or an ear
// clipper that is told contradicting things can lose vertices or never end. Here the rounding
// error of each difference and product is kept (two-sum by Knuth 1969, two-product by Dekker
// 1971), which leaves an error of about 1e-31 relative: in the float build, and in double but for
// coordinates whose sizes differ by more than 2^20 or so, the sign is exact.

#ifndef PL_EXACT_H
#define PL_EXACT_H

#include "plumb/geometry.h"

/// An unevaluated sum of two doubles.
typedef struct pl_exact {
    double high;
    double low;
} pl_exact;

/// a - b exactly.
static inline pl_exact pl_exact_difference(double a, double b)
{
    double d = a - b;
    double b_virtual = a - d;
    double a_virtual = d + b_virtual;
    pl_exact r = { d, (a - a_virtual) - (b - b_virtual) };
    return r;
}

/// a times b exactly, by splitting both into halves of 26 bits.
static inline pl_exact pl_exact_product(double a, double b)
{
    const double splitter = 134217729.0; // 2^27 + 1
    double ca = splitter * a;
    double cb = splitter * b;
    double a1 = ca - (ca - a);
    double b1 = cb - (cb - b);
    double a2 = a - a1;
    double b2 = b - b1;
    double p = a * b;
    pl_exact r = { p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2 };
    return r;
}

/// Twice the signed area of the triangle a, b, c [m^2]: positive when c is left of a to b. The
/// sign, and zero for points in line, are exact in the sense above.
static inline double pl_orient(plumb_vec2 a, plumb_vec2 b, plumb_vec2 c)
{
    double left = ((double)b.x - (double)a.x) * ((double)c.y - (double)a.y);
    double right = ((double)b.y - (double)a.y) * ((double)c.x - (double)a.x);
    double det = left - right;
    double size = (left < 0 ? -left : left) + (right < 0 ? -right : right);
    // Four roundings went into each product and one into the difference: far less than this.
    if (det > 1e-15 * size || -det > 1e-15 * size) {
        return det;
    }
    pl_exact ux = pl_exact_difference((double)b.x, (double)a.x);
    pl_exact uy = pl_exact_difference((double)b.y, (double)a.y);
    pl_exact vx = pl_exact_difference((double)c.x, (double)a.x);
    pl_exact vy = pl_exact_difference((double)c.y, (double)a.y);
    pl_exact p = pl_exact_product(ux.high, vy.high);
    pl_exact q = pl_exact_product(uy.high, vx.high);
    pl_exact d = pl_exact_difference(p.high, q.high);
    double tails_p = ux.high * vy.low + ux.low * vy.high;
    double tails_q = uy.high * vx.low + uy.low * vx.high;
    return d.high + (d.low + (p.low - q.low) + (tails_p - tails_q));
}

/// True when both points are the same, to the bit.
static inline bool pl_same_point(plumb_vec2 a, plumb_vec2 b)
{
    return a.x == b.x && a.y == b.y;
}

/// Distance of two points, in double.
static inline double pl_distance(plumb_vec2 a, plumb_vec2 b)
{
    double dx = (double)b.x - (double)a.x;
    double dy = (double)b.y - (double)a.y;
    return sqrt(dx * dx + dy * dy);
}

/// Checks the points of a cloud or outline: null, count 3..256, finite, within PLUMB_LENGTH_MAX.
/// @return PLUMB_OK | E_NULL | E_RANGE | E_CAPACITY | E_NOT_FINITE
plumb_result pl_points_check(const plumb_vec2 *points, int count);

/// [m] 8 roundings of the largest coordinate: less than that is noise of whoever computed them.
double pl_points_noise(const plumb_vec2 *points, int count);

/// The mathematics of a simple, finite outline, prepared: repeated points and points in line
/// (within pl_points_noise) left out, counter-clockwise. Returns the number of vertices left, 0
/// when fewer than 3 are, or when the edges touch or cross.
int pl_outline_simplify(const plumb_vec2 *points, int count,
                        plumb_vec2 out[PLUMB_OUTLINE_MAX_VERTICES]);

#endif
