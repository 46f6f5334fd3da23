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
// Stiffer springs fade to pl_joint_spring, which is implicit and damps them, from x = FULL on; where n joints meet on a
// body, from MANY / sqrt(n) on: sweeps that leave something undone would feed the network (DECISIONS.md).
#include "joints/rows.h"
#include "joints/wide.h"
#include "math/decay.h"
#include "plumb/math.h"

#define TAU ((real)6.2831853071795864769)

#define STIFFEST ((real)1.6)

#define FULL  0.55
#define MANY  0.8
#define FADES 1.5 // [-] of where it begins to fade, where nothing is left

pl_joint_soft pl_joint_spring(const pl_row *row, real h)
{
    if (row->type == PL_ROW_DRIVE || row->hertz == 0) {
        return (pl_joint_soft){ 1, 0, 0 };
    }
    real x = TAU * row->hertz * h, zx = row->damping * x, xx = x * x;
    real b = 1 / (1 + 2 * zx + 2 * zx * zx + xx * xx / (1 + xx));
    return (pl_joint_soft){ 1 - b, b * xx / h, b };
}

typedef struct oscillation {
    double b, k;        // see above
    double there, gone; // E00; E01 / h
} oscillation;

// With q = x^2 (1 - z^2), which is at most 1: cos and sin of its root by their series, for either sign of q.
static oscillation swinging(double x, double z, double q)
{
    const double left = pl_decay_of(z * x).left;
    const double versed = q / 2 * (1 - q / 12 * (1 - q / 30 * (1 - q / 56 * (1 - q / 90))));
    const double slope =
        1 - q / 6 * (1 - q / 20 * (1 - q / 42 * (1 - q / 72 * (1 - q / 110)))); // sin / root
    const double way = z * x * pl_decay_of(z * x).mean;                         // 1 - left
    return (oscillation){ .b = (way * way + 2 * left * versed) / (x * x),
                          .k = left * left,
                          .there = left * (1 - versed + z * x * slope),
                          .gone = left * slope };
}

// Two rates of decay, s over a substep.
static oscillation creeping(double x, double z)
{
    const double root = sqrt(z * z - 1), s1 = x / (z + root), s2 = x * (z + root);
    const pl_decay one = pl_decay_of(s1), two = pl_decay_of(s2);
    return (oscillation){ .b = s1 * one.mean * s2 * two.mean / (x * x),
                          .k = one.left * two.left,
                          .there = (s2 * one.left - s1 * two.left) / (s2 - s1),
                          .gone = (one.left - two.left) / (s2 - s1) };
}

// The same for one of many, which are not all solved to the end: it takes less of C back at once, and is no stiffer
// than some substeps can tell.
static pl_joint_soft spring_of_many(const pl_row *row, real h)
{
    real x = plumb_min(TAU * row->hertz * h, STIFFEST), zx = row->damping * x, xx = x * x;
    real b = 1 / (1 + 2 * zx + 2 * zx * zx + 2 * xx * xx / (1 + xx));
    return (pl_joint_soft){ 1 - b, b * xx / h, b };
}

pl_oscillator pl_joint_oscillator(const pl_row *row, real h, uint32_t degree)
{
    const pl_joint_soft plain = degree > 1 ? spring_of_many(row, h) : pl_joint_spring(row, h);
    const double x = (double)(TAU * row->hertz * h), z = (double)row->damping;
    const double met = MANY / sqrt((double)degree), full = met < FULL ? met : FULL;
    const double fades = (FADES - x / full) / (FADES - 1), share = fades < 1 ? fades : 1;
    if (!(share > 0) || !(x > 1e-5)) {
        return (pl_oscillator){ .soft = plain };
    }
    const double q = x * x * (1 - z * z);
    const oscillation o = q > -0.5 ? swinging(x, z, q) : creeping(x, z);
    const double gives = share * (1 - o.b) + (1 - share) * (double)plain.velocity, b = 1 - gives;
    const double start = (1 - o.there) / (x * x);
    const double bias = share / gives;
    return (pl_oscillator){
        .soft = { (real)gives, (real)(b * x * x / (double)h), (real)b },
        .lead = (real)(bias * (o.k - o.b)),
        .start_rate = (real)(bias * (o.gone - o.k)),
        .start_error = (real)(bias * (o.b - start) * x * x / (double)h),
    };
}
