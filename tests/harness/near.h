/// near.h - assert_near: two numbers are as near as they should be. They are compared as doubles, whatever the
/// precision of the build (cmocka's assert_float_equal casts to float), and a failure tells both and the tolerance.
///
///     assert_near(plumb_body_angle(w, b), 0.3, 0);                        // the very real that 0.3 becomes
///     assert_near(plumb_body_position(w, b).y, 4.905, ROUNDED(1e-5));     // but for rounding
///     assert_vec_near(plumb_body_velocity(w, b), 0, -9.81, 1e-3);         // but for the method's own error
#ifndef HARNESS_NEAR_H
#define HARNESS_NEAR_H

#include "plumb/plumb.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/// What rounding leaves: `in_float` where reals are floats, and where all but places are (the far build); in double
/// 1e-7 of it. Errors of a method, which are the same in every precision, are plain numbers.
#define ROUNDED(in_float)                                                                          \
    (sizeof(plumb_real) == sizeof(float) || PLUMB_IS_FAR ? (in_float) : (in_float)*1e-7)

// Not even near what is no number. What was given to the library came back as the nearest real.
static inline void near_at(double value, double expected, double tolerance, const char *text,
                           const char *file, int line)
{
    const double real = (double)(plumb_real)expected;
    if (!(fabs(value - expected) <= tolerance || fabs(value - real) <= tolerance)) {
        print_error("%s is %.17g, not %.17g within %g: off by %.3g\n", text, value, expected,
                    tolerance, value - expected);
        _fail(file, line);
    }
}

/// Holds value and expected no more than tolerance apart.
#define assert_near(value, expected, tolerance)                                                    \
    near_at((double)(value), (double)(expected), (double)(tolerance), #value, __FILE__, __LINE__)

/// Both coordinates of a vector.
#define assert_vec_near(v, vx, vy, tolerance)                                                      \
    do {                                                                                           \
        assert_near((v).x, (vx), (tolerance));                                                     \
        assert_near((v).y, (vy), (tolerance));                                                     \
    } while (0)

#endif
