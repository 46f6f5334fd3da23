// test_decay.c - exp(-x) and its integrals against long double.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "math/decay.h"

// The integrals by their series in long double where the formulas cancel.
static long double series(long double x, int shift)
{
    long double term = 1, sum = 0;
    for (int k = 1; k <= shift; ++k) {
        term /= k;
    }
    for (int n = 0; n < 60; ++n) {
        sum += term;
        term *= -x / (long double)(n + shift + 1);
    }
    return sum;
}

static double off(double is, long double should)
{
    return should == 0 ? fabs(is) : (double)fabsl(((long double)is - should) / should);
}

static void agrees_with_long_double(void **state)
{
    (void)state;
    double worst[3] = { 0, 0, 0 };
    for (int i = 0; i < 40000; ++i) {
        double x = i < 20000 ? i * 1e-4 : exp((i - 20000) * 3.2e-4);
        if (x > 700) {
            break;
        }
        pl_decay d = pl_decay_of(x);
        long double e = expl(-(long double)x);
        long double mean = x < 1 ? series(x, 1) : (1 - e) / x;
        long double twice = x < 1 ? series(x, 2) : (1 - mean) / x;
        worst[0] = fmax(worst[0], off(d.left, e));
        worst[1] = fmax(worst[1], off(d.mean, mean));
        worst[2] = fmax(worst[2], off(d.twice, twice));
    }
    print_message("exp(-x) off by %.2g, its mean by %.2g, its integral by %.2g\n", worst[0],
                  worst[1], worst[2]);
    assert_true(worst[0] <= 4e-16);
    assert_true(worst[1] <= 8e-16);
    assert_true(worst[2] <= 8e-16);
}

static void ends_are_right(void **state)
{
    (void)state;
    pl_decay none = pl_decay_of(0);
    assert_true(none.left == 1 && none.mean == 1 && none.twice == 0.5);
    pl_decay all = pl_decay_of(1e6);
    assert_true(all.left == 0 && all.mean == 1e-6);
    pl_decay last = pl_decay_of(707.9);
    assert_true(last.left > 0);
    assert_true(pl_decay_of(1e300).left == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_long_double),
        cmocka_unit_test(ends_are_right),
    };
    return cmocka_run_group_tests_name("decay", tests, NULL, NULL);
}
