// test_formula_text.c - texts of formulas: how operators bind, what is no formula and where, what is too much, numbers against the C
// library, anything at all. What programs give: test_formula.c.
#include "formula_fixture.h"

static double value_of(const char *text, place p)
{
    const pl_formula f = made(text, "0");
    double out[PL_FORMULA_RESULTS];
    ask(&f, p, out);
    return out[PL_FORMULA_AX];
}

static void operators_bind_as_in_mathematics(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
    } cases[] = { { "1 + 2 * 3", 7 },
                  { "-2^2", -4 },
                  { "2^-1", 0.5 },
                  { "2^3^2", 512 },
                  { "-x^2", -9 },
                  { "6 / 2 / 3", 1 },
                  { "1 - 2 - 3", -4 },
                  { "- - 2", 2 },
                  { "+3", 3 },
                  { "2 * -3", -6 },
                  { "1 < 2", 1 },
                  { "2 <= 1 + 1", 1 },
                  { "2 > 2", 0 },
                  { "2 >= 2", 1 },
                  { "1e3", 1000 },
                  { ".5", 0.5 },
                  { "5.", 5 },
                  { "1.5E-1", 0.15 },
                  { "2 * e", 5.43656365691809 },
                  { "x", 3 },
                  { "hypot(3, 4)", 5 },
                  { "min(3, 1, 2)", 1 },
                  { "clamp(5, 0, 2)", 2 },
                  { "if(0, 1, 2)", 2 },
                  { "step(-1) + step(0)", 1 },
                  { "(1 < 2) * 4", 4 },
                  { "\t1\n+\r2 ", 3 },
                  { "x^3", 27 },
                  { "x^-2", 1.0 / 9 },
                  { "4^1.5", 8 },
                  { "x^0", 1 },
                  { "r", 5 },
                  { "t * vx - vy", 7 * 2 - 1 },
                  { "2^x", 8 },
                  { "pi", 3.141592653589793 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const double is = value_of(cases[i].text, (place){ 3, 4, 2, 1, 7 });
        if (fabs(is - cases[i].value) > 1e-14 * fabs(cases[i].value)) {
            print_message("%s is %.17g\n", cases[i].text, is);
            fail();
        }
    }
}

static void what_is_no_formula_is_told_where(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
        bool is_potential;
    } cases[] = {
        { "2 * xx", "unknown name 'xx' at 5; known are x, y, r, t, vx, vy, pi, e", false },
        { "vx", "'vx' at 1 is a velocity; a potential knows x, y, r, t, pi, e", true },
        { "sine(x)", "unknown function 'sine' at 1; known are abs, acos,", false },
        { "sin x", "expected '(' at 5, not 'x'", false },
        { "sin(x", "expected an operator, ',' or ')' at 6, not the end", false },
        { "(x", "expected an operator or ')' at 3, not the end", false },
        { "x)", "expected an operator or the end at 2, not ')'", false },
        { "2 x", "expected an operator or the end at 3, not 'x'", false },
        { "2 +", "expected a number, a name or '(' at 4, not the end", false },
        { "* 2", "expected a number, a name or '(' at 1, not '*'", false },
        { "()", "expected a number, a name or '(' at 2, not ')'", false },
        { "sin()", "expected a number, a name or '(' at 5, not ')'", false },
        { "", "empty", false },
        { "  \t ", "empty", false },
        { "1e999", "the number at 1 is too large", false },
        { "1 + 1e400", "the number at 5 is too large", false },
        { "x \xc3\xa9", "expected an operator or the end at 3, not byte 0xC3", false },
        { "\xe2\x88\x92x", "expected a number, a name or '(' at 1, not byte 0xE2", false },
        { "atan2(x)", "atan2() at 1 takes 2 values, not 1", false },
        { "sin(x, y)", "sin() at 1 takes 1 value, not 2", false },
        { "min(x)", "min() at 1 takes 2 to 8 values, not 1", false },
        { "max(1,2,3,4,5,6,7,8,9)", "max() at 1 takes 2 to 8 values, not 9", false },
        { "1 < 2 < 3", "expected an operator or the end at 7, not '<'", false },
        { "x == 2", "expected an operator or the end at 3, not '='", false },
        { "thisnameistoolongforanyword", "unknown name 'thisnameistoolongforany' at 1", false },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        pl_formula f;
        pl_formula_fault fault;
        const char *const texts[2] = { cases[i].text, NULL };
        assert_false(pl_formula_compile(texts, cases[i].is_potential, &f, &fault));
        if (strncmp(fault.says, cases[i].says, strlen(cases[i].says)) != 0) {
            print_message("%s: %s\n", cases[i].text, fault.says);
            fail();
        }
    }
    const char *const second[2] = { "x", "y +" };
    pl_formula f;
    pl_formula_fault fault;
    assert_false(pl_formula_compile(second, false, &f, &fault));
    assert_int_equal(fault.text, 1);
}

// A piece so many times, and what is behind.
static bool is_taken(bool is_potential, const char *piece, int times, const char *behind,
                     pl_formula_fault *fault)
{
    static writing w;
    w.used = 0;
    for (int i = 0; i < times; ++i) {
        put(&w, piece, i + 2); // a piece may have a number
    }
    put(&w, "%s", behind);
    pl_formula f;
    const char *const texts[2] = { w.text, NULL };
    return pl_formula_compile(texts, is_potential, &f, fault);
}

static void what_is_too_much_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *piece, *behind, *says;
        int times;
        bool is_potential;
    } cases[] = {
        { "(", "", "nested more than 48 deep at 49", 300, false },
        { "2^", "2", "nested more than 48 deep at 97", 100, false },
        { "x+", "x", "more than 511 characters", 300, false },
        { "x+", "x", NULL, 255, false }, // 511 of them
        { "-", "1", NULL, 510, false },
        { "%d+", "0", "too long: more than 640 operations or 96 numbers", 110, false },
        { "x^%d+", "x", NULL, 43, true }, // its slope needs all powers at a time
        { "x^%d+", "x", "too long: it takes more than 400 steps, or 40 values at a time", 60,
          true },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        pl_formula_fault fault = { 0 };
        const bool taken = is_taken(cases[i].is_potential, cases[i].piece, cases[i].times,
                                    cases[i].behind, &fault);
        if (taken != (cases[i].says == NULL) ||
            (!taken && strstr(fault.says, cases[i].says) == NULL)) {
            print_message("%d times %s: %s\n", cases[i].times, cases[i].piece, fault.says);
            fail();
        }
    }
}

static void numbers_are_those_of_the_c_library(void **state)
{
    (void)state;
    uint32_t random = 9;
    const uint32_t count = trials_count(200000);
    for (uint32_t i = 0; i < count; ++i) {
        char text[64];
        uint64_t bits = (uint64_t)sim_random(&random) << 32 | sim_random(&random);
        double v = pl_lane_of_bits(bits & (UINT64_MAX >> 1)), is;
        if (!isfinite(v)) {
            continue;
        }
        static const char *const forms[] = { "%.17g", "%.3g", "%.25e", "%.9g", "%.16e" };
        snprintf(text, sizeof text, forms[i % 5], v);
        assert_int_equal(pl_formula_number(text, &is), (int)strlen(text));
        assert_true(is == strtod(text, NULL));
        snprintf(text, sizeof text, "%u.%u", sim_random(&random) >> (i % 30), sim_random(&random));
        pl_formula_number(text, &is);
        assert_true(is == strtod(text, NULL));
    }
    // Halves between two doubles, ends of the range, many digits.
    static const char *const odd[] = { "9007199254740993",
                                       "9007199254740995",
                                       "9007199254740993.00000000000000000000000000000000000000001",
                                       "2.4703282292062327e-324",
                                       "2.4703282292062328e-324",
                                       "4.9e-324",
                                       "1e-400",
                                       "1e-5000",
                                       "2.2250738585072011e-308",
                                       "1.7976931348623157e308",
                                       "1.7976931348623158e308",
                                       "0.000000000000000000000000000000000000000000000000000001",
                                       "100000000000000000000000000000000000000000000000000000000",
                                       "0",
                                       "0.0e9",
                                       "00012.50",
                                       "1.7976931348623159e308",
                                       "1e309" };
    for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i) {
        double is;
        assert_int_equal(pl_formula_number(odd[i], &is), (int)strlen(odd[i]));
        assert_true(is == strtod(odd[i], NULL));
    }
    double is;
    assert_int_equal(pl_formula_number("x", &is), 0);
    assert_int_equal(pl_formula_number(".", &is), 0);
    assert_int_equal(pl_formula_number("1e", &is), 1);
    assert_int_equal(pl_formula_number("1.e+", &is), 2);
    assert_int_equal(pl_formula_number("1..2", &is), 2);
}

// Any characters: told, or a program that runs.
static void any_text_is_taken_or_told(void **state)
{
    (void)state;
    static const char *const pieces[] = { "x",    "y",     "r",    "t",    "vx",   "(",
                                          ")",    "+",     "-",    "*",    "/",    "^",
                                          "<",    ">=",    ",",    "sin(", "if(",  "2",
                                          ".5",   "1e3",   "e",    "pi",   " ",    "^2",
                                          "max(", "sqrt(", "\xff", "@",    "log(", "atan2(" };
    uint32_t random = 77;
    const uint32_t count = trials_count(60000);
    uint32_t good = 0;
    for (uint32_t n = 0; n < count; ++n) {
        static writing w;
        const uint32_t parts = 1 + sim_random(&random) % (n % 50 == 0 ? 300 : 12);
        w.used = 0;
        for (uint32_t i = 0; i < parts; ++i) {
            put(&w, "%s", pieces[sim_random(&random) % 30]);
        }
        pl_formula f;
        pl_formula_fault fault = { 0 };
        const char *const texts[2] = { w.text, n % 3 == 0 ? w.text : NULL };
        if (pl_formula_compile(texts, n % 2 == 0, &f, &fault)) {
            double out[PL_FORMULA_RESULTS];
            ask(&f, (place){ 1, 2, 3, 4, 5 }, out);
            ++good;
        } else {
            assert_true(fault.says[0] != 0 && strlen(fault.says) < sizeof fault.says - 1);
        }
    }
    print_message("%u of %u were formulas\n", good, count);
    assert_true(good > count / 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(operators_bind_as_in_mathematics),
        cmocka_unit_test(what_is_no_formula_is_told_where),
        cmocka_unit_test(what_is_too_much_is_refused),
        cmocka_unit_test(numbers_are_those_of_the_c_library),
        cmocka_unit_test(any_text_is_taken_or_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
