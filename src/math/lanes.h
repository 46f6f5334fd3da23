// lanes.h - exponential, logarithm, sine and their like in double without branches: compilers put loops of them into lanes,
// and each lane has the bits that one value alone has.
//
// All from + - * / sqrt, choices and the bits of a number, so they are the same everywhere. (Of pl_sincos and pl_decay_of,
// which are older, the bits are kept; they have branches.)
//
// sine: x = k pi/2 + r as in trig.c, with three parts of pi/2: |x| < PL_LANE_TURN_MOST, beyond it the answer means
// nothing. Taylor to r^17 and r^16, |r| <= pi/4: terms left out are below 1e-19.
// exp: x = k ln 2 + r, |r| <= ln(2) / 2, Taylor to r^13: below 5e-18. log: m in [sqrt(1/2), sqrt(2)), 2 artanh((m - 1) / (m + 1))
// to the 21st power: below 1e-18. Errors against a long double: tests/unit/test_lanes.c.
#ifndef PL_MATH_LANES_H
#define PL_MATH_LANES_H

#include <stdint.h>
#include <string.h>

#define PL_LANE_TURN_MOST 1e6 // [rad] in size: the greatest angle that a sine takes

#define PL_LANE_WHOLE 6755399441055744.0 // 1.5 * 2^52: what is added to it is rounded

static inline uint64_t pl_lane_bits(double v)
{
    uint64_t bits;
    memcpy(&bits, &v, sizeof bits);
    return bits;
}

static inline double pl_lane_of_bits(uint64_t bits)
{
    double v;
    memcpy(&v, &bits, sizeof v);
    return v;
}

// 2^k of what was rounded as k + PL_LANE_WHOLE; -1022 <= k <= 1023.
static inline double pl_lane_power_of_two(double rounded)
{
    return pl_lane_of_bits((pl_lane_bits(rounded) + 1023) << 52);
}

static inline double pl_lane_abs(double v)
{
    return pl_lane_of_bits(pl_lane_bits(v) & (UINT64_MAX >> 1));
}

// 1, 0 or -1.
static inline double pl_lane_sign(double v)
{
    return (v > 0 ? 1.0 : 0.0) - (v < 0 ? 1.0 : 0.0);
}

static inline double pl_lane_floor(double v)
{
    const double near = (v + PL_LANE_WHOLE) - PL_LANE_WHOLE;
    const double below = near - (near > v ? 1.0 : 0.0);
    return pl_lane_abs(v) < 0x1p+51 ? below : v;
}

// sin(x + quarters pi / 2).
static inline double pl_lane_sine(double x, uint64_t quarters)
{
    const double rounded = x * 0.6366197723675814 + PL_LANE_WHOLE;
    const double k = rounded - PL_LANE_WHOLE;
    const double r =
        ((x - k * 1.5707963267341256) - k * 6.077100506303966e-11) - k * 2.0222662487959506e-21;
    const double z = r * r;
    double s = 1.0 / 355687428096000.0; // 1/17!
    s = -1.0 / 1307674368000.0 + z * s; // 1/15!
    s = 1.0 / 6227020800.0 + z * s;     // 1/13!
    s = -1.0 / 39916800.0 + z * s;      // 1/11!
    s = 1.0 / 362880.0 + z * s;         // 1/9!
    s = -1.0 / 5040.0 + z * s;          // 1/7!
    s = 1.0 / 120.0 + z * s;            // 1/5!
    s = -1.0 / 6.0 + z * s;             // 1/3!
    double c = 1.0 / 20922789888000.0;  // 1/16!
    c = -1.0 / 87178291200.0 + z * c;   // 1/14!
    c = 1.0 / 479001600.0 + z * c;      // 1/12!
    c = -1.0 / 3628800.0 + z * c;       // 1/10!
    c = 1.0 / 40320.0 + z * c;          // 1/8!
    c = -1.0 / 720.0 + z * c;           // 1/6!
    c = 1.0 / 24.0 + z * c;             // 1/4!
    const double half = 0.5 * z, first = 1.0 - half;
    const double sine = r + r * z * s;
    const double cosine = first + (((1.0 - first) - half) + z * z * c);
    const uint64_t turns = pl_lane_bits(rounded) + quarters;
    const double swaps = (double)(int)(turns & 1);
    const double value = swaps != 0 ? cosine : sine;
    return pl_lane_of_bits(pl_lane_bits(value) ^ ((turns & 2) << 62));
}

// e^r - 1, |r| <= ln(2) / 2.
static inline double pl_lane_exp_less_one(double r)
{
    double p = 1.0 / 6227020800.0; // 1/13!
    p = 1.0 / 479001600.0 + r * p; // 1/12!
    p = 1.0 / 39916800.0 + r * p;  // 1/11!
    p = 1.0 / 3628800.0 + r * p;   // 1/10!
    p = 1.0 / 362880.0 + r * p;    // 1/9!
    p = 1.0 / 40320.0 + r * p;     // 1/8!
    p = 1.0 / 5040.0 + r * p;      // 1/7!
    p = 1.0 / 720.0 + r * p;       // 1/6!
    p = 1.0 / 120.0 + r * p;       // 1/5!
    p = 1.0 / 24.0 + r * p;        // 1/4!
    p = 1.0 / 6.0 + r * p;         // 1/3!
    return r + r * r * (0.5 + r * p);
}

#define PL_LANE_LN2_HIGH 0x1.62e42fefa0000p-1 // 32 bits (Cody and Waite 1980)
#define PL_LANE_LN2_LOW  0x1.cf79abc9e3b3ap-40
#define PL_LANE_INV_LN2  0x1.71547652b82fep+0

// e^x: 0 and infinity where a double ends.
static inline double pl_lane_exp(double x)
{
    const double low = x < -1000 ? -1000 : x, v = low > 1000 ? 1000 : low;
    const double k = (v * PL_LANE_INV_LN2 + PL_LANE_WHOLE) - PL_LANE_WHOLE;
    const double p = 1 + pl_lane_exp_less_one((v - k * PL_LANE_LN2_HIGH) - k * PL_LANE_LN2_LOW);
    // In thirds: 2^k alone may be none.
    const double part = k * (1.0 / 3.0) + PL_LANE_WHOLE, third = part - PL_LANE_WHOLE;
    const double scale = pl_lane_power_of_two(part);
    return p * scale * scale * pl_lane_power_of_two((k - 2 * third) + PL_LANE_WHOLE);
}

// ln x: -infinity of 0, no number below it.
static inline double pl_lane_log(double x)
{
    const double tiny = x < 0x1p-1022 ? 1.0 : 0.0; // denormal
    const uint64_t bits = pl_lane_bits(tiny != 0 ? x * 0x1p+54 : x);
    // The exponent as a double: its bits below those of 2^52.
    double exponent =
        pl_lane_of_bits((bits >> 52) | pl_lane_bits(0x1p+52)) - (0x1p+52 + 1023) - 54 * tiny;
    double m = pl_lane_of_bits((bits & (UINT64_MAX >> 12)) | pl_lane_bits(1.0));
    const double large = m > 1.4142135623730951 ? 1.0 : 0.0;
    m = large != 0 ? m / 2 : m;
    exponent += large;
    const double y = (m - 1) / (m + 1), q = y * y;
    double sum = 1.0 / 21;
    sum = 1.0 / 19 + q * sum;
    sum = 1.0 / 17 + q * sum;
    sum = 1.0 / 15 + q * sum;
    sum = 1.0 / 13 + q * sum;
    sum = 1.0 / 11 + q * sum;
    sum = 1.0 / 9 + q * sum;
    sum = 1.0 / 7 + q * sum;
    sum = 1.0 / 5 + q * sum;
    sum = 1.0 / 3 + q * sum;
    // 2 y is m - 1 - y (m - 1), the first of which is exact.
    const double whole = exponent * PL_LANE_LN2_HIGH;
    const double rest = exponent * PL_LANE_LN2_LOW + (2 * y * q * sum - y * (m - 1));
    const double value = whole + ((m - 1) + rest);
    const double none = x == 0 ? -1 / (x * x) : x - x; // x - x: infinite or no number
    const double of_zero_up = x > 0 && x - x == 0 ? value : none;
    const double of_infinity = x > 0 && x - x != 0 ? x : of_zero_up;
    return x < 0 ? (x - x) / (x - x) : of_infinity;
}

// By e^(2 |x|) - 1, without loss near 0.
static inline double pl_lane_tanh(double x)
{
    const double size = pl_lane_abs(x), v = 2 * (size > 30 ? 30 : size);
    const double rounded = v * PL_LANE_INV_LN2 + PL_LANE_WHOLE, k = rounded - PL_LANE_WHOLE;
    const double p = pl_lane_exp_less_one((v - k * PL_LANE_LN2_HIGH) - k * PL_LANE_LN2_LOW);
    const double scale = pl_lane_power_of_two(rounded);
    const double grown = scale * p + (scale - 1), t = grown / (grown + 2);
    return x < 0 ? -t : t;
}

// u^v: of u < 0 where v is whole, else no number.
static inline double pl_lane_power(double u, double v)
{
    const double size = pl_lane_exp(v * pl_lane_log(pl_lane_abs(u)));
    const double flips = pl_lane_floor(v / 2) * 2 == v ? 0.0 : 1.0;
    const double whole = pl_lane_floor(v) == v ? 1.0 : 0.0;
    const double turned = flips != 0 ? -size : size;
    const double of_negative = whole != 0 ? turned : (u - u) / (u - u);
    const double value = u < 0 ? of_negative : size;
    return v == 0 ? 1.0 : value;
}

#endif
