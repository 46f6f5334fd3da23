/// trials.h - which random cases a generated test tries. All of `make test` takes minutes so; before an issue closes:
///
///     make test TRIALS=10                                  ten times as many of each (any factor above 0); from 3 on long tests
///                                                          in all precisions, too (PLUMB_LONG in tools/make/test.mk)
///     FIRST=137 COUNT=1 build/tests/determinism/test_mixed  one of them
#ifndef HARNESS_TRIALS_H
#define HARNESS_TRIALS_H

#include "plumb/base.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/// Case numbers first .. end - 1.
typedef struct trials {
    uint32_t first, end;
} trials;

/// A number that the environment gives; what is no such number ends the program.
static inline double trials_asked(const char *name, double otherwise)
{
    const char *text = getenv(name);
    if (text == NULL || *text == '\0') {
        return otherwise;
    }
    char *end;
    const double value = strtod(text, &end);
    if (*end != '\0' || !(value >= 0) || value > 1e9) {
        fprintf(stderr, "%s is '%s'; it must be a number from 0 to 1e9\n", name, text);
        exit(2);
    }
    return value;
}

/// How many, of so many in a run that nobody asked more of: one at the least.
static inline uint32_t trials_share(uint32_t usual, double share)
{
    const double count = trials_asked("COUNT", usual * share * trials_asked("TRIALS", 1));
    return count < 1 ? 1 : (uint32_t)count;
}

/// What of a test's work a precision does where what it adds is its precision: all in float, the default, a third in double and in
/// the far build.
static inline double trials_part(void)
{
    return PLUMB_IS_FAR || sizeof(plumb_real) > sizeof(float) ? 1.0 / 3 : 1;
}

/// How many, for tests that draw all cases from one stream of random numbers: of that part the first.
static inline uint32_t trials_count(uint32_t usual)
{
    return trials_share(usual, trials_part());
}

/// How many steps of so many, for tests of one long case: that part, but with TRIALS of 3 and more all.
static inline int trials_steps(int all)
{
    const double part = trials_part() * trials_asked("TRIALS", 1);
    return part < 1 ? (int)(all * part) : all;
}

static inline trials trials_from(uint32_t first, uint32_t usual)
{
    const uint32_t from = (uint32_t)trials_asked("FIRST", first);
    return (trials){ from, from + trials_count(usual) };
}

/// As many in every precision: where among all of them each thing must be seen once.
static inline trials trials_whole(uint32_t first, uint32_t usual)
{
    const uint32_t from = (uint32_t)trials_asked("FIRST", first);
    return (trials){ from, from + trials_share(usual, 1) };
}

/// Of a list of cases that take long one in `every`: others in float, in double and in the far build, so that with 3 each is
/// taken by one of them. With TRIALS=`every` all are. A test that says PLUMB_LONG takes those of float alone until then.
static inline bool trials_takes(uint32_t number, uint32_t every)
{
    const uint32_t turn = PLUMB_IS_FAR ? 2 : sizeof(plumb_real) > sizeof(float) ? 1 : 0;
    return (number + turn) % every < trials_asked("TRIALS", 1);
}

#endif
