// compare.h - the lesser and the greater of two: the same in every C library, zeros of either sign included.
#ifndef PL_MATH_COMPARE_H
#define PL_MATH_COMPARE_H

static inline double pl_greater(double a, double b)
{
    return a > b ? a : b;
}

static inline double pl_lesser(double a, double b)
{
    return a < b ? a : b;
}

#endif
