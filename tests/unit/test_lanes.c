// test_lanes.c - functions without branches against long double, and their ends.
#include "math/lanes.h"

#include "harness/random.h"
#include "math/trig.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

// Relative, and where the number is small so much in itself.
static double off(double is, long double should, long double floor)
{
    const long double size = fabsl(should) > floor ? fabsl(should) : floor;
    return (double)(fabsl((long double)is - should) / size);
}

// As doubles are spread: any size.
static double any_size(uint32_t *state, double least, double most)
{
    const double v = exp(sim_uniform(state, log(least), log(most)));
    return sim_random(state) % 2 == 0 ? v : -v;
}

static void they_agree_with_long_double(void **state)
{
    (void)state;
    double sine = 0, cosine = 0, exponential = 0, less = 0, logarithm = 0, near = 0, tangent = 0;
    uint32_t random = 7;
    for (int i = 0; i < 300000; ++i) {
        const double x = any_size(&random, 1e-9, 1e6), e = any_size(&random, 1e-9, 700);
        const double l = fabs(any_size(&random, 1e-308, 1e308));
        const double one = 1 + any_size(&random, 1e-12, 0.4), t = any_size(&random, 1e-9, 25);
        sine = fmax(sine, off(pl_lane_sine(x, 0), sinl((long double)x), 1e-3L));
        cosine = fmax(cosine, off(pl_lane_sine(x, 1), cosl((long double)x), 1e-3L));
        exponential = fmax(exponential, off(pl_lane_exp(e), expl((long double)e), 0));
        logarithm = fmax(logarithm, off(pl_lane_log(l), logl((long double)l), 0));
        near = fmax(near, off(pl_lane_log(one), logl((long double)one), 0));
        tangent = fmax(tangent, off(pl_lane_tanh(t), tanhl((long double)t), 0));
        const double r = sim_uniform(&random, -0.34, 0.34);
        less = fmax(less, off(pl_lane_exp_less_one(r), expm1l((long double)r), 0));
    }
    print_message(
        "sine %.2g, cosine %.2g, exp %.2g, exp - 1 %.2g, log %.2g, near 1 %.2g, tanh %.2g\n", sine,
        cosine, exponential, less, logarithm, near, tangent);
    assert_true(sine < 4e-16 && cosine < 4e-16 && exponential < 5e-16 && less < 4e-16);
    assert_true(logarithm < 4e-16 && near < 4e-16 && tangent < 7e-16);
}

static void powers_agree_with_long_double(void **state)
{
    (void)state;
    uint32_t random = 3;
    double worst = 0;
    for (int i = 0; i < 100000; ++i) {
        const double u = fabs(any_size(&random, 1e-3, 1e3)), v = sim_uniform(&random, -6, 6);
        worst = fmax(worst, off(pl_lane_power(u, v), powl((long double)u, (long double)v), 0));
    }
    print_message("power %.2g\n", worst);
    assert_true(worst < 1e-14);
    const double odd[][3] = { { -2, 3, -8 },    { -2, 2, 4 },          { -2, -1, -0.5 },
                              { 0, 2, 0 },      { 0, 0, 1 },           { 0, -1, INFINITY },
                              { -3, 0, 1 },     { 5, 0, 1 },           { 1e300, 2, INFINITY },
                              { 1e-300, 2, 0 }, { -2, 1e18, INFINITY } };
    for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i) {
        const double is = pl_lane_power(odd[i][0], odd[i][1]);
        assert_true(is == odd[i][2] || fabs(is - odd[i][2]) < 1e-14 * fabs(odd[i][2]));
    }
    assert_true(isnan(pl_lane_power(-2, 0.5)));
}

static void ends_are_right(void **state)
{
    (void)state;
    const double inf = INFINITY, nan = NAN;
    assert_true(pl_lane_exp(0) == 1 && pl_lane_exp(-inf) == 0 && pl_lane_exp(inf) == inf);
    assert_true(pl_lane_exp(710) == inf && pl_lane_exp(-746) == 0 && pl_lane_exp(-740) > 0);
    assert_true(fabs(pl_lane_exp(-740) / exp(-740) - 1) < 1e-1 && isnan(pl_lane_exp(nan)));
    assert_true(pl_lane_log(1) == 0 && pl_lane_log(0) == -inf && pl_lane_log(-0.0) == -inf);
    assert_true(pl_lane_log(inf) == inf && isnan(pl_lane_log(-1)) && isnan(pl_lane_log(nan)) &&
                isnan(pl_lane_log(-inf)));
    assert_true(fabs(pl_lane_log(0x1p-1074) / log(0x1p-1074) - 1) < 1e-15);
    assert_true(pl_lane_tanh(0) == 0 && pl_lane_tanh(inf) == 1 && pl_lane_tanh(-1e5) == -1);
    assert_true(isnan(pl_lane_tanh(nan)) && isnan(pl_lane_sine(nan, 0)));
    assert_true(pl_lane_sine(0, 0) == 0 && pl_lane_sine(0, 1) == 1);
    assert_true(pl_lane_sign(-3) == -1 && pl_lane_sign(0) == 0 && pl_lane_sign(nan) == 0);
    const double floors[] = { 0, -0.5, 0.5, 1, -1, 2.9999, -2.0001, 1e15 + 0.5, -1e300, inf, -inf };
    for (size_t i = 0; i < sizeof floors / sizeof floors[0]; ++i) {
        assert_true(pl_lane_floor(floors[i]) == floor(floors[i]));
    }
    assert_true(isnan(pl_lane_floor(nan)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(they_agree_with_long_double),
        cmocka_unit_test(powers_agree_with_long_double),
        cmocka_unit_test(ends_are_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
