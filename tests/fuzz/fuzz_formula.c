// fuzz_formula.c - any text as a formula: told what is wrong with it, or a program that gives the same bits in columns as at
// one place, whose own texts make it again.
//
// The first byte says whether it is a potential, and how wide the columns are; the second component begins behind a 0.
#include "formula/formula.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void need(bool holds)
{
    if (!holds) {
        abort();
    }
}

// No number is no number, whatever its bits.
static bool is_same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (a != a && b != b);
}

static double value_at(int i, int k)
{
    static const double odd[] = { 0, -0.0, 1, -1, 1e300, -1e-300, 0.5, 7 };
    return i < 8 ? odd[(i + k) % 8] : (i - 16) * 0.37 + k;
}

static void run(const pl_formula *f, int width)
{
    static double columns[PL_FORMULA_REGISTERS][PL_FORMULA_LANES];
    double constants[PL_FORMULA_CONSTANTS];
    pl_formula_begin(f, 1.25, constants);
    for (int k = 0; k < PL_FORMULA_INPUTS; ++k) {
        for (int i = 0; i < PL_FORMULA_LANES; ++i) {
            columns[k][i] = value_at(i, k);
        }
    }
    pl_formula_columns_of(width)(f, constants, columns, true);
    for (int i = 0; i < PL_FORMULA_LANES; ++i) {
        double registers[PL_FORMULA_REGISTERS];
        for (int k = 0; k < PL_FORMULA_INPUTS; ++k) {
            registers[k] = value_at(i, k);
        }
        pl_formula_at(f, constants, registers, true);
        for (int k = 0; k < (f->is_potential ? PL_FORMULA_POTENTIAL + 1 : PL_FORMULA_RESULTS);
             ++k) {
            const uint8_t at = f->results[k];
            const double is =
                at < PL_FORMULA_CONSTANT ? columns[at][i] : constants[at - PL_FORMULA_CONSTANT];
            need(is_same(is, pl_formula_result_at(f, constants, registers, (pl_formula_result)k)));
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const int how = size > 0 ? data[0] : 0;
    char *text = malloc(size + 1);
    need(text != NULL);
    memcpy(text, data + (size > 0), size > 0 ? size - 1 : 0);
    text[size > 0 ? size - 1 : 0] = 0;
    const size_t first = strlen(text);
    const bool is_potential = how % 2 == 1;
    const char *const texts[2] = { text,
                                   !is_potential && first + 1 < size ? text + first + 1 : NULL };
    pl_formula f, again;
    pl_formula_fault fault = { 0 };
    if (pl_formula_compile(texts, is_potential, &f, &fault)) {
        run(&f, how % 4 < 2 ? 4 : 8);
        need(pl_formula_compile(texts, is_potential, &again, &fault) &&
             memcmp(&f, &again, sizeof f) == 0);
    } else {
        need(fault.says[0] != 0 && fault.text >= 0 && fault.text < 2);
    }
    free(text);
    return 0;
}
