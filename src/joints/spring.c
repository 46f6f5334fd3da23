// spring.c - factors of spring rows: the linear oscillator, exact over a substep.
//
// With frequency w, damping ratio z, x = h w, a substep of the oscillator C'' = -w^2 C - 2 z w C' + f has the matrix
// E = exp(h ((0, 1), (-w^2, -2 z w))). The solver moves places by h v', so its substep is
//     v' = b (v + h f - h w^2 C) + (k - b) v,    C' = C + h v',
// whose matrix has determinant k and trace 1 + k - b x^2. With
//     k = det E = exp(-2 z x),    b = (1 + det E - trace E) / x^2
// these are those of E: frequency and decay are exact, undamped springs keep their amplitude, and where several springs
// meet, nothing grows. Places are exact, too, where the first substep goes to E's place (the factors `start`): v' is
// then the velocity half a substep ago, as in leapfrog. At rest, v = v' = 0, C = f / w^2, exactly.
//
// Springs in newtons are the same with w^2 = k / m and 2 z w = c / m, m being the mass that the row meets at the moment.
// A damper alone is one with w = 0.
//
// Stiffer springs fade to pl_joint_spring, which is implicit and damps them, from x = FULL on; where n joints meet on a
// body, from MANY / sqrt(n) on: sweeps that leave something undone would feed the network (DECISIONS.md).
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
    return (pl_joint_soft){ 1 - b, b * xx / h, b };
}

pl_joint_soft pl_joint_spring(const pl_row *row, real mass, real h)
{
    if (row->type == PL_ROW_DRIVE || row->spring == PL_SPRING_NONE) {
        return (pl_joint_soft){ 1, 0, 0 };
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

// The same for one of many, which are not all solved to the end: it takes less of C back at once, and is no stiffer
// than some substeps can tell.
static pl_joint_soft spring_of_many(swing s, real h)
{
    const real x = plumb_min(s.x, STIFFEST), zx = s.x > x ? s.zx * (x / s.x) : s.zx, xx = x * x;
    real b = 1 / (1 + 2 * zx + 2 * zx * zx + 2 * xx * xx / (1 + xx));
    return (pl_joint_soft){ 1 - b, b * xx / h, b };
}

pl_oscillator pl_joint_oscillator(const pl_row *row, real mass, real h, uint32_t degree)
{
    const swing s = swing_of(row, mass, h);
    const pl_joint_soft plain = degree > 1 ? spring_of_many(s, h) : plain_spring(s, h);
    const double x = (double)s.x, zx = (double)s.zx, q = x * x - zx * zx;
    const bool creeps = q <= -0.5 || zx > 2 * x;
    const double met = MANY / sqrt((double)degree), full = met < FULL ? met : FULL;
    const double fades = (FADES - x / full) / (FADES - 1), share = fades < 1 ? fades : 1;
    if (!(share > 0) || !(creeps ? zx > 1e-5 : x > 1e-5)) {
        return (pl_oscillator){ .soft = plain };
    }
    const oscillation o = creeps ? creeping(x, zx, q) : swinging(x, zx, q);
    const double gives = share * (1 - o.b) + (1 - share) * (double)plain.velocity, b = 1 - gives;
    const double bias = share / gives;
    return (pl_oscillator){
        .soft = { (real)gives, (real)(b * x * x / (double)h), (real)b },
        .lead = (real)(bias * (o.k - o.b)),
        .start_rate = (real)(bias * (o.gone - o.k)),
        .start_error = (real)(bias * (o.b - o.start) * x * x / (double)h),
    };
}
