// det_math.c - sin, cos, atan2, exp, log, pow and random numbers for scripts, in double, that give
// the same bits on every machine: only + - * / sqrt, ldexp and frexp, all exact or correctly
// rounded.
//
// sin, cos: Cody-Waite reduction by pi/2 in three parts (|x| < 2^20 keeps k * part exact to far
// below
//   the last place; larger arguments are first reduced by fmod, which is exact), Taylor to x^19.
// atan: arguments above tan(pi/12) are turned by pi/6, Taylor to x^25.
// exp: x = k ln2 + r, |r| <= ln2 / 2, Taylor to r^14. log: m in [sqrt(1/2), sqrt(2)), atanh series.
// Errors against a multi-precision reference: below 4e-16 relative for exp and log, 3e-16 absolute
// else. Random: splitmix64 (Steele, Lea, Flood 2014), the top 53 bits.
#include <math.h>

#include "internal.h"

#define PI_2      1.5707963267948966         // pi / 2
#define PI_2_HIGH 1.57079632673412561417     // its first 33 bits
#define PI_2_MID  6.07710050630396597660e-11 // the next 33
#define PI_2_LOW  2.02226624879595063154e-21 // the rest
#define LN2_HIGH  6.93147180369123816490e-01 // ln 2, first 33 bits
#define LN2_LOW   1.90821492927058770002e-10 // the rest

// sum of c[i] y^i, highest first
static double series(const double *c, int count, double y)
{
    double sum = 0;
    for (int i = count - 1; i >= 0; i--) {
        sum = sum * y + c[i];
    }
    return sum;
}

static double sin_small(double x)
{
    static const double c[] = { 1.0,
                                -1.0 / 6,
                                1.0 / 120,
                                -1.0 / 5040,
                                1.0 / 362880,
                                -1.0 / 39916800,
                                1.0 / 6227020800.0,
                                -1.0 / 1307674368000.0,
                                1.0 / 355687428096000.0 };
    return x * series(c, 9, x * x);
}

static double cos_small(double x)
{
    static const double c[] = { 1.0,
                                -1.0 / 2,
                                1.0 / 24,
                                -1.0 / 720,
                                1.0 / 40320,
                                -1.0 / 3628800,
                                1.0 / 479001600.0,
                                -1.0 / 87178291200.0,
                                1.0 / 20922789888000.0,
                                -1.0 / 6402373705728000.0 };
    return series(c, 10, x * x);
}

// sin(x + quarter * pi / 2)
static double sine(double x, int quarter)
{
    if (!(fabs(x) < HUGE_VAL)) {
        return (double)NAN;
    }
    if (fabs(x) > 1048576.0) {
        x = fmod(x, 4 * PI_2);
    }
    double k = floor(x / PI_2 + 0.5);
    double r = ((x - k * PI_2_HIGH) - k * PI_2_MID) - k * PI_2_LOW;
    switch (((int)fmod(k, 4.0) + 4 + quarter) & 3) {
    case 0:
        return sin_small(r);
    case 1:
        return cos_small(r);
    case 2:
        return -sin_small(r);
    default:
        return -cos_small(r);
    }
}

double sc_sin(double x)
{
    return sine(x, 0);
}

double sc_cos(double x)
{
    return sine(x, 1);
}

// atan of 0 <= x <= 1
static double atan_unit(double x)
{
    static const double c[] = { 1.0,       -1.0 / 3,  1.0 / 5,   -1.0 / 7, 1.0 / 9,
                                -1.0 / 11, 1.0 / 13,  -1.0 / 15, 1.0 / 17, -1.0 / 19,
                                1.0 / 21,  -1.0 / 23, 1.0 / 25 };
    const double sqrt3 = 1.7320508075688772;
    const double tan_pi_12 = 0.2679491924311227;
    if (x > tan_pi_12) {
        double turned = (sqrt3 * x - 1) / (sqrt3 + x);
        return PI_2 / 3 + turned * series(c, 13, turned * turned);
    }
    return x * series(c, 13, x * x);
}

double sc_atan2(double y, double x)
{
    if (isnan(x) || isnan(y)) {
        return (double)NAN;
    }
    double ax = fabs(x);
    double ay = fabs(y);
    double a;
    if (ax == 0 && ay == 0) {
        a = 0;
    } else if (isinf(ax) && isinf(ay)) {
        a = PI_2 / 2;
    } else {
        a = ay <= ax ? atan_unit(ay / ax) : PI_2 - atan_unit(ax / ay);
    }
    if (signbit(x)) {
        a = 2 * PI_2 - a;
    }
    return signbit(y) ? -a : a;
}

double sc_exp(double x)
{
    static const double c[] = { 1.0,
                                1.0,
                                1.0 / 2,
                                1.0 / 6,
                                1.0 / 24,
                                1.0 / 120,
                                1.0 / 720,
                                1.0 / 5040,
                                1.0 / 40320,
                                1.0 / 362880,
                                1.0 / 3628800,
                                1.0 / 39916800,
                                1.0 / 479001600.0,
                                1.0 / 6227020800.0,
                                1.0 / 87178291200.0 };
    if (isnan(x)) {
        return x;
    }
    if (x > 709.79 || x < -745.2) { // beyond the range of double
        return x > 0 ? HUGE_VAL : 0.0;
    }
    double k = floor(x / (LN2_HIGH + LN2_LOW) + 0.5);
    double r = (x - k * LN2_HIGH) - k * LN2_LOW;
    return ldexp(series(c, 15, r), (int)k);
}

double sc_log(double x)
{
    if (isnan(x) || x < 0) {
        return (double)NAN;
    }
    if (x == 0 || isinf(x)) {
        return x == 0 ? -HUGE_VAL : x;
    }
    int e;
    double m = frexp(x, &e);
    if (m < 0.7071067811865476) {
        m *= 2;
        e -= 1;
    }
    static const double c[] = { 2.0,      2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11,
                                2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21, 2.0 / 23 };
    double q = (m - 1) / (m + 1);
    double k = (double)e;
    return k * LN2_HIGH + (q * series(c, 12, q * q) + k * LN2_LOW);
}

double sc_pow(double x, double y)
{
    const double most = 1024; // beyond, repeated squaring has no advantage in accuracy
    if (y == floor(y) && fabs(y) <= most) {
        double product = 1;
        double square = x;
        for (int n = (int)fabs(y); n > 0; n >>= 1) {
            if (n & 1) {
                product *= square;
            }
            square *= square;
        }
        return y < 0 ? 1 / product : product;
    }
    return x == 0 ? (y > 0 ? 0.0 : HUGE_VAL) : sc_exp(y * sc_log(x));
}

double sc_random(scene *s)
{
    s->random += 0x9e3779b97f4a7c15u;
    uint64_t z = s->random;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}
