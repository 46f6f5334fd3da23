// trig.c - sine, cosine and arc tangent from + - * / alone: the same bits everywhere.
//
// libm's versions differ from one C library to the next, which would break replays across
// machines. These are in double for both builds, and rounded to plumb_real at the end.
//
// Sine and cosine: angle = k pi/2 + r, |r| <= pi/4. pi/2 is a sum of four parts (a split after
// Cody and Waite 1980), three of 33 bits, so that k times a part is exact while k < 2^20, and r
// is carried as an unevaluated sum of two doubles. Then the Taylor series at r, whose first terms
// left out are r^19/19! < 9e-20 and r^20/20! < 4e-21, far below half a rounding (6e-17).
//
// Arc tangent: with t = min/max of the coordinates and c the multiple of 1/8 next to t,
// atan t = atan c + atan((t - c) / (1 + t c)), whose argument is at most 1/16 in size. Its Taylor
// series is cut before q^15/15 < 6e-20. The octants follow by symmetry.
//
// Reads, writes: arguments only. Cost: about 40 multiplications each, one or no division.

#include "math/trig.h"

#include "plumb/math.h"

#include <float.h>

// Results are only the same bits if doubles are computed as doubles (not so on the x87).
// 16: that, and _Float16 in its own format.
_Static_assert(FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 16,
               "plumb needs plain double arithmetic (SSE2, NEON, ...)");

// pi / 2 in four parts; the first three have 33 significant bits.
#define HALF_PI_1 1.5707963267341256
#define HALF_PI_2 6.077100506303966e-11
#define HALF_PI_3 2.0222662487111665e-21
#define HALF_PI_4 8.4784276603689e-32

#define TWO_OVER_PI 0.6366197723675814
#define HALF_PI     1.5707963267948966    // the double nearest to pi / 2 ...
#define HALF_PI_LOW 6.123233995736766e-17 // ... and what is missing
#define TWO_PI      6.283185307179586

// [rad] largest angle that is reduced with all four parts: below 2^20 pi / 2.
#define EXACT_REDUCTION_MAX 1e6

// [rad] below this nothing is reduced.
#define SMALL 0.78

// An angle reduced to a quarter turn: angle = quarters * pi / 2 + high + low.
typedef struct reduced {
    double high;  // |high| <= pi / 4, give or take a rounding
    double low;   // below half a rounding of high
    int quarters; // 0..3
} reduced;

// a - b as a sum of two doubles, exactly (Knuth 1969, 4.2.2 theorem B).
static double subtract_exactly(double a, double b, double *error)
{
    double d = a - b;
    double b_virtual = a - d;
    double a_virtual = d + b_virtual;
    *error = (a - a_virtual) - (b - b_virtual);
    return d;
}

// Remainder of a division by the double 2 pi, by doubling and subtracting; each step is exact.
static double remainder_of_turns(double x)
{
    double m = TWO_PI;
    while (m <= x / 2) {
        m *= 2;
    }
    for (; m >= TWO_PI; m /= 2) {
        if (x >= m) {
            x -= m;
        }
    }
    return x;
}

// Reduces a finite angle >= 0.
static reduced reduce(double x)
{
    if (x > EXACT_REDUCTION_MAX) {
        x = remainder_of_turns(x);
    }
    int k = (int)(x * TWO_OVER_PI + 0.5);
    double error_2, error_3;
    double r = x - k * HALF_PI_1; // exact: both are multiples of the same power of two
    r = subtract_exactly(r, k * HALF_PI_2, &error_2);
    r = subtract_exactly(r, k * HALF_PI_3, &error_3);
    double rest = error_2 + error_3 - k * HALF_PI_4;
    reduced out;
    out.high = r + rest;
    out.low = rest - (out.high - r);
    out.quarters = k & 3;
    return out;
}

typedef double pair __attribute__((vector_size(16)));

// sin(high + low) and cos(high + low) for |high| <= pi/4: series, and the first order of low. Of the cosine 1 - z/2 is split
// off with its rounding error.
static pair series(double high, double low)
{
    const double z = high * high;
    pair p = { 1.0 / 355687428096000.0, -1.0 / 6402373705728000.0 };      // 1/17!, 1/18!
    p = (pair){ -1.0 / 1307674368000.0, 1.0 / 20922789888000.0 } + z * p; // 1/15!, 1/16!
    p = (pair){ 1.0 / 6227020800.0, -1.0 / 87178291200.0 } + z * p;       // 1/13!, 1/14!
    p = (pair){ -1.0 / 39916800.0, 1.0 / 479001600.0 } + z * p;           // 1/11!, 1/12!
    p = (pair){ 1.0 / 362880.0, -1.0 / 3628800.0 } + z * p;               // 1/9!, 1/10!
    p = (pair){ -1.0 / 5040.0, 1.0 / 40320.0 } + z * p;                   // 1/7!, 1/8!
    p = (pair){ 1.0 / 120.0, -1.0 / 720.0 } + z * p;                      // 1/5!, 1/6!
    p = (pair){ -1.0 / 6.0, 1.0 / 24.0 } + z * p;                         // 1/3!, 1/4!
    const double half = 0.5 * z, first = 1.0 - half;
    return (pair){ high + (high * z * p[0] + low * (1.0 - 0.5 * z)),
                   first + ((1.0 - first) - half + (z * z * p[1] - high * low)) };
}

void pl_sincos(double angle, double *sine, double *cosine)
{
    if (!(angle - angle == 0)) {
        *sine = *cosine = angle - angle; // NaN
        return;
    }
    const double size = angle < 0 ? -angle : angle;
    const bool small = size < SMALL;
    reduced r = small ? (reduced){ size, 0, 0 } : reduce(size);
    const pair both = series(r.high, r.low);
    const double s = both[0], c = both[1];
    double turned_s = (r.quarters & 1) != 0 ? c : s;
    double turned_c = (r.quarters & 1) != 0 ? -s : c;
    bool opposite = (r.quarters & 2) != 0;
    *sine = opposite != (angle < 0) ? -turned_s : turned_s;
    *cosine = opposite ? -turned_c : turned_c;
}

// atan(k / 8): the double nearest to it, and what is missing.
static const double atan_eighths[9][2] = {
    { 0.0, 0.0 },
    { 0.12435499454676144, -3.1253241424539383e-18 },
    { 0.24497866312686414, 1.0698755618734451e-17 },
    { 0.35877067027057225, -2.4623815582638635e-17 },
    { 0.4636476090008061, 2.2698777452961687e-17 },
    { 0.5585993153435624, -5.4556305485916264e-18 },
    { 0.6435011087932844, 1.5834785051444286e-17 },
    { 0.7188299996216245, -2.1478388444456983e-17 },
    { 0.7853981633974483, 3.061616997868383e-17 },
};

// atan(small / large) for 0 <= small <= large, large > 0, in two parts: the sum is the result.
static double octant_angle(double small, double large, double *low)
{
    int k = (int)(small / large * 8.0 + 0.5);
    double c = k / 8.0;
    double q = (small - c * large) / (large + c * small);
    double z = q * q;
    double p = 1.0 / 13.0;
    p = -1.0 / 11.0 + z * p;
    p = 1.0 / 9.0 + z * p;
    p = -1.0 / 7.0 + z * p;
    p = 1.0 / 5.0 + z * p;
    p = -1.0 / 3.0 + z * p;
    *low = atan_eighths[k][1] + q * z * p;
    if (k == 0) {
        return q;
    }
    *low += q;
    return atan_eighths[k][0];
}

double pl_atan2(double y, double x)
{
    // Brought near 1 by a power of two, sums of coordinates can neither overflow nor lose digits.
    const double big = 0x1p+900;
    const double tiny = 0x1p-900;
    double ax = x < 0 ? -x : x;
    double ay = y < 0 ? -y : y;
    if (!(ax - ax == 0) || !(ay - ay == 0)) {
        return (ax - ax) + (ay - ay); // NaN
    }
    double large = ax > ay ? ax : ay;
    double small = ax > ay ? ay : ax;
    if (large == 0) {
        return 0;
    }
    double scale = large > big ? tiny : large < tiny ? big : 1.0;
    double low;
    double high = octant_angle(small * scale, large * scale, &low);
    if (ay > ax) { // mirrored by the diagonal
        high = HALF_PI - high;
        low = HALF_PI_LOW - low;
    }
    if (x < 0) { // mirrored by the y axis
        high = 2 * HALF_PI - high;
        low = 2 * HALF_PI_LOW - low;
    }
    double angle = high + low;
    return y < 0 ? -angle : angle;
}

void plumb_sincos(plumb_real angle, plumb_rot *out)
{
    double s, c;
    pl_sincos((double)angle, &s, &c);
    out->s = (plumb_real)s;
    out->c = (plumb_real)c;
}

plumb_real plumb_atan2(plumb_real y, plumb_real x)
{
    return (plumb_real)pl_atan2((double)y, (double)x);
}

plumb_real plumb_angle_wrap(plumb_real angle)
{
    if (plumb_abs(angle) <= PLUMB_PI) {
        return angle == -PLUMB_PI ? PLUMB_PI : angle;
    }
    if (!plumb_is_finite(angle)) {
        return angle - angle; // NaN
    }
    reduced r = reduce((double)plumb_abs(angle));
    int quarters = r.quarters;
    if (quarters == 3 || (quarters == 2 && r.high > 0)) {
        quarters -= 4;
    }
    double wrapped = quarters * HALF_PI + (r.high + (r.low + quarters * HALF_PI_LOW));
    plumb_real result = (plumb_real)(angle < 0 ? -wrapped : wrapped);
    return result <= -PLUMB_PI ? PLUMB_PI : result;
}
