// formula_fixture.h - what the tests of formulas share: a program of texts, all that it gives at a place.
#ifndef FORMULA_FIXTURE_H
#define FORMULA_FIXTURE_H

#include "formula/graph.h"
#include "harness/random.h"
#include "harness/trials.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

typedef struct place {
    double x, y, vx, vy, t;
} place;

static inline pl_formula made(const char *x, const char *y)
{
    pl_formula f;
    pl_formula_fault fault;
    const char *const texts[2] = { x, y };
    if (!pl_formula_compile(texts, y == NULL, &f, &fault)) {
        print_message("%s: %s\n", x, fault.says);
        fail();
    }
    return f;
}

// All results at one place.
static inline void ask(const pl_formula *f, place p, double out[PL_FORMULA_RESULTS])
{
    double constants[PL_FORMULA_CONSTANTS],
        registers[PL_FORMULA_REGISTERS] = { p.x, p.y, p.vx, p.vy };
    pl_formula_begin(f, p.t, constants);
    pl_formula_at(f, constants, registers, true);
    for (int i = 0; i < PL_FORMULA_RESULTS; ++i) {
        out[i] = pl_formula_result_at(f, constants, registers, (pl_formula_result)i);
    }
}

// A text that grows, and is cut where its room ends.
typedef struct writing {
    char text[20000];
    size_t used;
} writing;

static inline void put(writing *w, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int more = vsnprintf(w->text + w->used, sizeof w->text - w->used, format, arguments);
    va_end(arguments);
    w->used += (size_t)more;
    assert_true(w->used < sizeof w->text);
}

#endif
