// spring.c - factors of spring rows: the linear oscillator, exact over a substep.
//
// With frequency w, damping ratio z, x = h w, a substep of the oscillator C'' = -w^2 C - 2 z w C' + f has the matrix
// E = exp(h ((0, 1), (-w^2, -2 z w))). The soft step kicks by half of the substep's impulses, moves places by h u, and
// kicks by the other half (soft.c). So a spring is two rows, before the places move and behind that, of the form
//     u = p v + q h (f - w^2 C),    C' = C + h u,    v' = r u + s h (f - w^2 C')
// whose matrix is E with
//     q = (1 - E00) / x^2,    p = E01 / h,    r = det E / p,    s = (b - q) / p,    b = (1 + det E - trace E) / x^2.
// So places and velocities are exact, with a constant f, too. A row knows f by what that has done until the row is
// solved: without the row's own impulse, J v is v + h f / 2 =: g then, and
//     u = 2 q g + (p - 2 q) v - q h w^2 C.
// Of the row's impulse, so much of the substep's (`lag`) is not in J v yet when a half begins.
//
// Springs in newtons are the same with w^2 = k / m and 2 z w = c / m, m being the mass that the row meets at the moment.
// A damper alone is one with w = 0.
//
// Stiffer springs fade to implicit halves, which damp them, from x = FULL on; where n joints meet on a body, from
// MANY / sqrt(n) on: sweeps that leave something undone would feed the network (DECISIONS.md).
#include "joints/rows.h"
#include "joints/wide.h"
#include "math/decay.h"
#include "plumb/math.h"

#define TAU ((real)6.2831853071795864769)

#define STIFFEST ((real)1.6)
#define MOST     1e9 // [-] of x and z x

#define FULL  0.55
#define MANY  0.8
#define FADES 1.5 // [-] of where it begins to fade, where nothing is left

// x = h w, and z x, which is half of what the damper takes of the speed.
typedef struct swing {
    real x, zx;
} swing;

// `mass` [kg] that the row meets; 0: nothing can move.
static swing swing_of(const pl_row *row, real mass, real h)
{
    if (row->spring == PL_SPRING_HERTZ) {
        const real x = plumb_min(TAU * row->stiff * h, (real)MOST);
        return (swing){ x, plumb_min(row->damp * x, (real)MOST) };
    }
    // Neither square nor quotient leaves the range of a real: the stiffest are no stiffer than no substep could tell.
    const double per = mass > 0 ? (double)h / (double)mass : 0;
    const double x = sqrt((double)row->stiff * per * (double)h), zx = (double)row->damp * per / 2;
    return (swing){ (real)(x < MOST ? x : MOST), (real)(zx < MOST ? zx : MOST) };
}

static pl_joint_soft plain_spring(swing s, real h)
{
    const real zx = s.zx, xx = s.x * s.x;
    real b = 1 / (1 + 2 * zx + 2 * zx * zx + xx * xx / (1 + xx));
    return (pl_joint_soft){ 1 - b, b * xx / h, b, 0 };
}

pl_joint_soft pl_joint_spring(const pl_row *row, real mass, real h)
{
    if (row->type == PL_ROW_DRIVE || row->spring == PL_SPRING_NONE) {
        return (pl_joint_soft){ 1, 0, 0, 0 };
    }
    return plain_spring(swing_of(row, mass, h), h);
}

typedef struct oscillation {
    double b, k;        // see above
    double start, gone; // (1 - E00) / x^2; E01 / h
} oscillation;

// With q = x^2 - (z x)^2, which is at most 1: cos and sin of its root by their series, for either sign of q.
static oscillation swinging(double x, double zx, double q)
{
    const double left = pl_decay_of(zx).left;
    const double versed = q / 2 * (1 - q / 12 * (1 - q / 30 * (1 - q / 56 * (1 - q / 90))));
    const double slope =
        1 - q / 6 * (1 - q / 20 * (1 - q / 42 * (1 - q / 72 * (1 - q / 110)))); // sin / root
    const double way = zx * pl_decay_of(zx).mean;                               // 1 - left
    const double there = left * (1 - versed + zx * slope);
    return (oscillation){ .b = (way * way + 2 * left * versed) / (x * x),
                          .k = left * left,
                          .start = (1 - there) / (x * x),
                          .gone = left * slope };
}

// Two rates of decay, s over a substep; their product is x^2, and the slower one is 0 of a damper alone.
static oscillation creeping(double x, double zx, double q)
{
    const double root = sqrt(-q), s2 = zx + root, s1 = x * x / s2;
    const pl_decay one = pl_decay_of(s1), two = pl_decay_of(s2);
    return (oscillation){ .b = one.mean * two.mean,
                          .k = one.left * two.left,
                          .start = (one.mean - two.mean) / (s2 - s1),
                          .gone = (one.left - two.left) / (s2 - s1) };
}

// One of many, which are not all solved to the end, takes less of C back at once, and is no stiffer than some substeps
// can tell.
static swing bounded(swing s)
{
    const real x = plumb_min(s.x, STIFFEST);
    return (swing){ x, s.x > x ? s.zx * (x / s.x) : s.zx };
}

// b = 2 q = 2 s of implicit halves.
static double fading(swing s, bool many)
{
    const double zx = (double)s.zx, xx = (double)s.x * (double)s.x;
    return 1 / (1 + zx + zx * zx / 2 + (many ? 1 : 0.5) * xx * xx / (1 + xx));
}

static pl_joint_soft half_of(double b, swing s, double before, real h)
{
    const double xx = (double)s.x * (double)s.x;
    return (pl_joint_soft){ (real)(1 - b), (real)(b * xx / (2 * (double)h)), (real)b,
                            (real)before };
}

pl_joint_soft pl_joint_half_spring(const pl_row *row, real mass, real h)
{
    const swing s = swing_of(row, mass, h);
    return half_of(fading(s, false), s, 0, h);
}

pl_oscillator pl_joint_oscillator(const pl_row *row, real mass, real h, uint32_t degree)
{
    if (row->type == PL_ROW_DRIVE || row->spring == PL_SPRING_NONE) {
        return (pl_oscillator){ .half = { { 1, 0, 0, 0 }, { 1, 0, 0, 0 } } };
    }
    const bool many = degree > 1;
    const swing told = swing_of(row, mass, h), s = many ? bounded(told) : told;
    const double plain = fading(s, many);
    const double x = (double)told.x, zx = (double)told.zx, w = x * x - zx * zx;
    const bool creeps = w <= -0.5 || zx > 2 * x;
    const double met = MANY / sqrt((double)(many ? degree : 1)), full = met < FULL ? met : FULL;
    const double fades = (FADES - x / full) / (FADES - 1), share = fades < 1 ? fades : 1;
    if (!(share > 0) || !(creeps ? zx > 1e-5 : x > 1e-5)) {
        return (pl_oscillator){ .half = { half_of(plain, s, 0, h), half_of(plain, s, 0, h) } };
    }
    const oscillation o = creeps ? creeping(x, zx, w) : swinging(x, zx, w);
    const double q = o.start, p = o.gone, r = o.k / p, t = (o.b - q) / p;
    const double first = share * 2 * q + (1 - share) * plain;
    const double last = share * 2 * t + (1 - share) * plain;
    return (pl_oscillator){ .half = { half_of(first, told, share * (p - 2 * q), h),
                                      half_of(last, told, share * (r - 2 * t), h) } };
}
