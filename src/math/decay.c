// decay.c - exp(-x) and its first two integrals for x >= 0, in double, from + - * / alone.
//
// x = k ln 2 + r, |r| <= ln(2) / 2: exp(-x) = 2^-k exp(-r), by Taylor's series up to r^17 (the next
// term is below 3e-24). ln 2 is taken off in two parts, the first with trailing zeros, so that k
// times it is exact (Cody and Waite 1980). Below 1 the integrals have series of their own: their
// formulas would lose digits. Cost: 20 operations, at most 60.
#include "math/decay.h"

#include <stdint.h>
#include <string.h>

#define LN2_HIGH 0x1.62e42fefa0000p-1 // 32 bits
#define LN2_LOW  0x1.cf79abc9e3b3ap-40
#define INV_LN2  0x1.71547652b82fep+0
#define LARGEST  708.0 // beyond it exp(-x) would be denormal: counts as 0
#define SMALL    1.0
#define TERMS    17

// 2^-k, 0 <= k <= 1022.
static double half_power(int k)
{
    uint64_t bits = (uint64_t)(1023 - k) << 52;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// Sum of (-x)^n / (n + shift)! times shift!, |x| <= SMALL.
static double series(double x, int shift)
{
    double sum = 1;
    for (int n = TERMS; n > 0; --n) {
        sum = 1 - x / (double)(n + shift) * sum;
    }
    return sum;
}

pl_decay pl_decay_of(double x)
{
    pl_decay d = { 0, 0, 0 };
    if (x < LARGEST) {
        int k = (int)(x * INV_LN2 + 0.5);
        double r = (x - k * LN2_HIGH) - k * LN2_LOW;
        d.left = half_power(k) * series(r, 0);
    }
    if (x < SMALL) {
        d.mean = series(x, 1);
        d.twice = series(x, 2) / 2;
    } else {
        d.mean = (1 - d.left) / x;
        d.twice = (1 - d.mean) / x;
    }
    return d;
}
