// test_trig.c - plumb_sincos, plumb_atan2 and plumb_angle_wrap against long double libm: error in
// units in the last place of plumb_real, worst cases next to multiples of a quarter turn, the
// symmetries promised, and a hash of results that every compiler and build option must reproduce.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "plumb/math.h"

#define SAMPLES 400000

static uint32_t random_state;

// Uniform in [-1, 1] with all bits of a double in use.
static double uniform(void)
{
    double high = sim_random(&random_state);
    return (high + sim_random(&random_state) / 4294967296.0) / 2147483648.0 - 1;
}

static int seed(void **state)
{
    (void)state;
    random_state = 77003u;
    return 0;
}

// Spacing of plumb_real at a value.
static long double spacing(long double value)
{
    int exponent;
    frexpl(value, &exponent);
    long double s = ldexpl((long double)PLUMB_REAL_EPSILON, exponent - 1);
    long double smallest = sizeof(plumb_real) == 4 ? 0x1p-149L : 0x1p-1074L;
    return s > smallest ? s : smallest;
}

static double ulps(plumb_real got, long double want)
{
    return (double)(fabsl((long double)got - want) / spacing(want));
}

static double sincos_error(plumb_real angle)
{
    plumb_rot q;
    plumb_sincos(angle, &q);
    double es = ulps(q.s, sinl((long double)angle));
    double ec = ulps(q.c, cosl((long double)angle));
    return es > ec ? es : ec;
}

static void sine_and_cosine_are_within_one_ulp(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < SAMPLES; i++) {
        // Sizes from 1e-8 to 1e4, as many in each decade.
        double size = i % 2 == 0 ? 1e4 : pow(10, -8 + 12.0 * (i / (double)SAMPLES));
        double e = sincos_error((plumb_real)(size * uniform()));
        worst = e > worst ? e : worst;
    }
    print_message("sincos, random |a| <= 1e4: %.3f ulp\n", worst);
    assert_true(worst < 1);
}

static void sine_and_cosine_hold_next_to_quarter_turns(void **state)
{
    (void)state;
    double worst = 0;
    for (int k = -6366; k <= 6366; k++) {
        plumb_real a = (plumb_real)(k * 1.57079632679489661923L);
        plumb_real b = (plumb_real)((double)a * (1 + (double)PLUMB_REAL_EPSILON));
        double e = sincos_error(a);
        worst = e > worst ? e : worst;
        e = sincos_error(b);
        worst = e > worst ? e : worst;
    }
    print_message("sincos, next to k pi/2, |a| <= 1e4: %.3f ulp\n", worst);
    assert_true(worst < 1);
}

static void sine_and_cosine_are_symmetric_and_unit(void **state)
{
    (void)state;
    for (int i = 0; i < 20000; i++) {
        plumb_real a = (plumb_real)(uniform() * (i % 2 == 0 ? 10 : 1e5));
        plumb_rot p, n;
        plumb_sincos(a, &p);
        plumb_sincos(-a, &n);
        assert_true(p.c == n.c && p.s == -n.s);
        double square = (double)p.c * (double)p.c + (double)p.s * (double)p.s;
        assert_near(square, 1, 2 * (double)PLUMB_REAL_EPSILON);
    }
    plumb_rot q;
    plumb_sincos(0, &q);
    assert_true(q.c == 1 && q.s == 0);
}

static void huge_angles_are_still_rotations(void **state)
{
    (void)state;
    static const double sizes[] = { 1e5, 9.9e5, 1.1e6, 1e9, 1e15, 1e30, 3e38, 1e300 };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        if (sizes[i] > (double)PLUMB_REAL_MAX) {
            continue;
        }
        plumb_real a = (plumb_real)sizes[i];
        plumb_rot q;
        plumb_sincos(a, &q);
        double square = (double)q.c * (double)q.c + (double)q.s * (double)q.s;
        assert_near(square, 1, 2 * (double)PLUMB_REAL_EPSILON);
        double slack = sizes[i] <= 1e6 ? 0 : 2.5e-16 * sizes[i];
        if (slack < 1) {
            double want = (double)sinl((long double)a);
            assert_near(q.s, want, slack + (double)PLUMB_REAL_EPSILON);
        }
    }
    plumb_real zero = 0;
    plumb_rot q;
    plumb_sincos(1 / zero, &q);
    assert_true(q.c != q.c && q.s != q.s);
    plumb_sincos(zero / zero, &q);
    assert_true(q.c != q.c && q.s != q.s);
}

static void arc_tangent_is_within_two_ulp(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double scale = i % 3 == 0 ? 1 : pow(10, 8 * uniform());
        plumb_real x = (plumb_real)uniform();
        plumb_real y = (plumb_real)(scale * uniform());
        double e = ulps(plumb_atan2(y, x), atan2l((long double)y, (long double)x));
        worst = e > worst ? e : worst;
    }
    print_message("atan2, random: %.3f ulp\n", worst);
    assert_true(worst < 2);
}

static void arc_tangent_knows_its_special_points(void **state)
{
    (void)state;
    plumb_real zero = 0, infinite = 1 / zero, huge = PLUMB_REAL_MAX;
    plumb_real tiny = sizeof(plumb_real) == 4 ? PLUMB_REAL(0x1p-149) : PLUMB_REAL(0x1p-1074);
    assert_true(plumb_atan2(0, 0) == 0);
    assert_true(plumb_atan2(0, 1) == 0);
    assert_true(plumb_atan2(0, -1) == PLUMB_PI);
    assert_true(plumb_atan2(-zero, -1) == PLUMB_PI);
    assert_true(plumb_atan2(1, 0) == PLUMB_PI / 2);
    assert_true(plumb_atan2(-1, 0) == -PLUMB_PI / 2);
    assert_true(plumb_atan2(1, 1) == PLUMB_PI / 4);
    assert_true(plumb_atan2(huge, huge) == PLUMB_PI / 4);
    // Sums of the coordinates overflow here unless they are scaled.
    assert_true(ulps(plumb_atan2(PLUMB_REAL(0.4) * huge, huge), 0.380506377112364942L) < 3);
    assert_true(plumb_atan2(tiny, tiny) == PLUMB_PI / 4);
    assert_true(plumb_atan2(tiny, 0) == PLUMB_PI / 2);
    assert_true(plumb_atan2(huge, tiny) == PLUMB_PI / 2);
    assert_true(plumb_atan2(tiny, huge) == 0);
    assert_true(plumb_atan2(-tiny, -huge) == -PLUMB_PI);
    assert_false(plumb_is_finite(plumb_atan2(infinite, 1)));
    assert_false(plumb_is_finite(plumb_atan2(1, -infinite)));
    assert_false(plumb_is_finite(plumb_atan2(zero / zero, 1)));
}

static void wrapped_angles_are_the_same_direction(void **state)
{
    (void)state;
    for (int i = 0; i < 50000; i++) {
        plumb_real a = (plumb_real)(uniform() * (i % 2 == 0 ? 20 : 1e4));
        plumb_real w = plumb_angle_wrap(a);
        assert_true(w > -PLUMB_PI && w <= PLUMB_PI);
        long double turn = 6.28318530717958647693L;
        long double want = (long double)a - turn * roundl((long double)a / turn);
        long double off = fabsl((long double)w - want);
        off = off > 3 ? fabsl(off - turn) : off; // on the internal edge
        // The reference itself is only as good as the 64 bits of pi that it subtracts.
        assert_true(off <= spacing(want) + 2e-19L * fabsl((long double)a));
    }
    assert_true(plumb_angle_wrap(PLUMB_PI) == PLUMB_PI);
    assert_true(plumb_angle_wrap(-PLUMB_PI) == PLUMB_PI);
    assert_true(plumb_angle_wrap(1) == 1);
    plumb_real zero = 0;
    assert_false(plumb_is_finite(plumb_angle_wrap(1 / zero)));
}

// FNV-1a (Fowler, Noll, Vo) over the bytes of results.
static uint64_t hash_real(uint64_t hash, plumb_real value)
{
    unsigned char bytes[sizeof value];
    memcpy(bytes, &value, sizeof value);
    for (size_t i = 0; i < sizeof value; i++) {
        hash = (hash ^ bytes[i]) * 1099511628211u;
    }
    return hash;
}

static void bits_are_the_same_everywhere(void **state)
{
    (void)state;
    uint64_t hash = 14695981039346656037u;
    for (int i = 0; i < 100000; i++) {
        plumb_real a = (plumb_real)(uniform() * 1e4);
        plumb_real b = (plumb_real)(uniform() * 10);
        plumb_rot q;
        plumb_sincos(a, &q);
        hash = hash_real(hash_real(hash, q.c), q.s);
        hash = hash_real(hash, plumb_atan2(a, b));
        hash = hash_real(hash, plumb_angle_wrap(a));
    }
    // Little endian. Made once; gcc and clang at -O0, -O2, -O3 and with sanitizers agree.
    uint64_t expected = sizeof(plumb_real) == 4 ? 0x691cff78c1adbfe9u : 0xfc7bc81ac4afbfebu;
    if (hash != expected) {
        fail_msg("hash is 0x%016llx", (unsigned long long)hash);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(sine_and_cosine_are_within_one_ulp, seed),
        cmocka_unit_test_setup(sine_and_cosine_hold_next_to_quarter_turns, seed),
        cmocka_unit_test_setup(sine_and_cosine_are_symmetric_and_unit, seed),
        cmocka_unit_test_setup(huge_angles_are_still_rotations, seed),
        cmocka_unit_test_setup(arc_tangent_is_within_two_ulp, seed),
        cmocka_unit_test_setup(arc_tangent_knows_its_special_points, seed),
        cmocka_unit_test_setup(wrapped_angles_are_the_same_direction, seed),
        cmocka_unit_test_setup(bits_are_the_same_everywhere, seed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
