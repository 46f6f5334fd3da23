// test_formula.c - formulas as programs: what they give against a plain recursion over random trees, their slopes against
// differences, columns against single places. Texts: test_formula_text.c.
#include "formula_fixture.h"

//---- random trees --------------------------------------------------------------------------------

typedef enum kind { NUMBER, NAME, SIGNED, BINARY, POWERED, CALL } kind;

typedef struct tree {
    kind kind;
    double number;
    int which, count;
    struct tree *part[3];
} tree;

static const char *const names[] = { "x", "y", "r", "t", "vx", "vy", "pi", "e" };
static const struct {
    const char *name;
    int count;
} calls[] = { { "sin", 1 },  { "cos", 1 },   { "exp", 1 },   { "tanh", 1 },  { "sqrt", 1 },
              { "log", 1 },  { "atan", 1 },  { "hypot", 2 }, { "atan2", 2 }, { "tan", 1 },
              { "asin", 1 }, { "acos", 1 },  { "abs", 1 },   { "min", 2 },   { "max", 2 },
              { "if", 3 },   { "clamp", 3 }, { "sign", 1 },  { "floor", 1 }, { "step", 1 } };
enum { SMOOTH = 12, IF = 15, STEADY = 17, CALLS = sizeof calls / sizeof calls[0] };

typedef struct garden {
    uint32_t random;
    tree all[200];
    int count, names, calls; // how many of the lists
} garden;

static int pick(garden *g, int n)
{
    return (int)(sim_random(&g->random) % (uint32_t)n);
}

static tree *grow(garden *g, int depth)
{
    tree *t = &g->all[g->count++];
    const int roll = depth == 0 || g->count > 60 ? pick(g, 4) : 3 + pick(g, 12);
    *t = (tree){ .kind = roll < 1    ? NUMBER
                         : roll < 4  ? NAME
                         : roll < 5  ? SIGNED
                         : roll < 11 ? BINARY
                         : roll < 12 ? POWERED
                                     : CALL };
    t->number = floor(sim_uniform(&g->random, 0, 400)) / 100;
    t->which = t->kind == NAME     ? pick(g, g->names)
               : t->kind == BINARY ? pick(g, g->calls == CALLS ? 5 : 4)
                                   : pick(g, g->calls);
    t->count = t->kind == SIGNED || t->kind == POWERED ? 1
               : t->kind == BINARY                     ? 2
               : t->kind == CALL                       ? calls[t->which].count
                                                       : 0;
    for (int i = 0; i < t->count; ++i) {
        t->part[i] = grow(g, depth - 1);
    }
    return t;
}

// With spaces and needless parentheses.
static void put_tree(writing *w, const tree *t)
{
    static const char *const ends[] = { "", "", ")", ")", ")^%d", ")" };
    put(w, t->kind == SIGNED ? "(-" : t->kind == BINARY || t->kind == POWERED ? "(" : "");
    if (t->kind == NUMBER) {
        put(w, "%.17g", t->number);
    } else if (t->kind == NAME) {
        put(w, t->which % 2 == 0 ? " %s" : "(%s )", names[t->which]);
    } else if (t->kind == CALL) {
        put(w, "%s(", calls[t->which].name);
    }
    for (int i = 0; i < t->count; ++i) {
        if (i > 0 && t->kind == BINARY) {
            put(w, " %c ", "+-*/<"[t->which]);
        } else if (i > 0) {
            put(w, ",");
        }
        put_tree(w, t->part[i]);
    }
    put(w, ends[t->kind], 1 + (int)t->number);
}

// As a formula may be: false if it is too long.
static bool write_tree(writing *w, const tree *t)
{
    w->used = 0;
    w->text[0] = 0;
    put_tree(w, t);
    return w->used < PL_FORMULA_TEXT;
}

static long double called(int which, const long double *a)
{
    long double top;
    switch (which) {
    case 0:
        return sinl(a[0]);
    case 1:
        return cosl(a[0]);
    case 2:
        return expl(a[0]);
    case 3:
        return tanhl(a[0]);
    case 4:
        return sqrtl(a[0]);
    case 5:
        return logl(a[0]);
    case 6:
        return atanl(a[0]);
    case 7:
        return sqrtl(a[0] * a[0] + a[1] * a[1]);
    case 8:
        return atan2l(a[0], a[1]);
    case 9:
        return tanl(a[0]);
    case 10:
        return asinl(a[0]);
    case 11:
        return acosl(a[0]);
    case 12:
        return fabsl(a[0]);
    case 13:
        return a[0] < a[1] ? a[0] : a[1];
    case 14:
        return a[0] > a[1] ? a[0] : a[1];
    case 15:
        return a[0] != 0 ? a[1] : a[2];
    case 16:
        top = a[0] > a[1] ? a[0] : a[1];
        return top < a[2] ? top : a[2];
    case 17:
        return (long double)((a[0] > 0) - (a[0] < 0));
    case 18:
        return floorl(a[0]);
    default:
        return a[0] >= 0 ? 1 : 0;
    }
}

// The plain recursion; `loss`: by how much rounding of doubles may change it.
static long double evaluate(const tree *t, const place *p, long double *loss)
{
    const long double leaves[] = { (long double)p->x,
                                   (long double)p->y,
                                   sqrtl((long double)p->x * (long double)p->x +
                                         (long double)p->y * (long double)p->y),
                                   (long double)p->t,
                                   (long double)p->vx,
                                   (long double)p->vy,
                                   (long double)3.141592653589793,
                                   (long double)2.718281828459045 };
    long double a[3] = { 0 }, l[3] = { 0 }, value = 0, spread = 0;
    for (int i = 0; i < t->count; ++i) {
        a[i] = evaluate(t->part[i], p, &l[i]);
    }
    switch (t->kind) {
    case NUMBER:
        value = (long double)t->number;
        break;
    case NAME:
        value = leaves[t->which];
        break;
    case SIGNED:
        value = -a[0], spread = l[0];
        break;
    case POWERED:
        value = powl(a[0], 1 + floorl((long double)t->number));
        for (int k = -1; k <= 1; k += 2) {
            spread = fmaxl(
                spread, fabsl(powl(a[0] + k * l[0], 1 + floorl((long double)t->number)) - value));
        }
        break;
    default: // as its operands may be off, so may it
        for (int k = -1; k < (1 << t->count); ++k) {
            long double b[3];
            for (int i = 0; i < 3; ++i) {
                b[i] = k < 0 ? a[i] : (k >> i & 1) != 0 ? a[i] + l[i] : a[i] - l[i];
            }
            const long double is = t->kind == CALL ? called(t->which, b)
                                   : t->which == 0 ? b[0] + b[1]
                                   : t->which == 1 ? b[0] - b[1]
                                   : t->which == 2 ? b[0] * b[1]
                                   : t->which == 3 ? b[0] / b[1]
                                                   : (long double)(b[0] < b[1]);
            value = k < 0 ? is : value;
            spread = k < 0 ? 0 : fmaxl(spread, isnan(is) ? INFINITY : fabsl(is - value));
        }
    }
    if (t->kind == CALL && t->which == IF && fabsl(a[0]) <= l[0]) {
        spread = INFINITY; // 0 or nearly so
    }
    *loss =
        fabsl(value) < 1e100L ? spread + 1e-15L * fabsl(value) + 1e-300L : (long double)INFINITY;
    for (int i = 0; i < t->count; ++i) { // what an operand has lost is lost
        *loss = isinf(l[i]) ? l[i] : *loss;
    }
    return value;
}

static place anywhere(garden *g)
{
    return (place){ sim_uniform(&g->random, -2, 2), sim_uniform(&g->random, -2, 2),
                    sim_uniform(&g->random, -2, 2), sim_uniform(&g->random, -2, 2),
                    sim_uniform(&g->random, 0, 3) };
}

static void programs_give_what_the_recursion_gives(void **state)
{
    (void)state;
    const uint32_t count = trials_count(30000);
    garden g = { .random = 5, .names = 8, .calls = CALLS };
    uint32_t compared = 0, none = 0;
    for (uint32_t n = 0; n < count; ++n) {
        static writing w;
        g.count = 0;
        const tree *t = grow(&g, 1 + pick(&g, 5));
        if (!write_tree(&w, t)) {
            continue;
        }
        const pl_formula f = made(w.text, "0");
        for (int k = 0; k < 3; ++k) {
            const place p = anywhere(&g);
            double out[PL_FORMULA_RESULTS];
            long double loss;
            const long double should = evaluate(t, &p, &loss);
            ask(&f, p, out);
            if (isfinite(should) && isfinite(loss) && loss < 1e-6L * (1 + fabsl(should))) {
                ++compared;
                if (!(fabsl((long double)out[0] - should) <= 4 * loss)) {
                    print_message("%s at %.17g %.17g %.17g %.17g %.17g: %.17g, not %.17Lg\n",
                                  w.text, p.x, p.y, p.vx, p.vy, p.t, out[0], should);
                    fail();
                }
            } else if (isnan(should) && isfinite(loss)) {
                ++none;
            }
        }
    }
    print_message("%u places compared\n", compared);
    assert_true(compared > 2 * count);
    (void)none;
}

//---- slopes --------------------------------------------------------------------------------------

// A central difference of the recursion, and how far off it may be by what it is at other distances.
static long double difference(const tree *t, place p, int variable, long double *off)
{
    long double last = 0, before = INFINITY, loss[2];
    for (double h = 1e-2; h > 1e-6; h /= 4) {
        place a = p, b = p;
        double *const at_a[] = { &a.x, &a.y, &a.vx, &a.vy }, *const at_b[] = { &b.x, &b.y, &b.vx,
                                                                               &b.vy };
        *at_a[variable] -= h, *at_b[variable] += h;
        const long double width = (long double)*at_b[variable] - (long double)*at_a[variable];
        const long double slope = (evaluate(t, &b, &loss[1]) - evaluate(t, &a, &loss[0])) / width;
        const long double change = fabsl(slope - last);
        *off =
            isfinite(loss[0]) && isfinite(loss[1]) ? fmaxl(change, before) : (long double)INFINITY;
        *off += 1e-3L * (loss[0] + loss[1]) / width; // long doubles are rounded, too
        before = change;
        last = slope;
    }
    return last;
}

// Of a potential along x and y, of components by velocities.
static void slopes_are_those_of_differences(void **state)
{
    (void)state;
    const uint32_t count = trials_count(12000);
    garden g = { .random = 11, .calls = SMOOTH };
    uint32_t compared = 0;
    for (uint32_t n = 0; n < count; ++n) {
        const bool of_place = n % 2 == 0;
        static writing w;
        g.count = 0;
        g.names = of_place ? 4 : 6;
        g.calls = n % 3 == 0 ? STEADY : SMOOTH;
        const tree *t = grow(&g, 1 + pick(&g, 5));
        pl_formula f;
        pl_formula_fault fault;
        const char *const texts[2] = { w.text, "vx" };
        if (!write_tree(&w, t) || !pl_formula_compile(texts, of_place, &f, &fault)) {
            continue;
        }
        const place p = anywhere(&g);
        double out[PL_FORMULA_RESULTS];
        ask(&f, p, out);
        for (int k = 0; k < 2; ++k) {
            long double off;
            const long double should = difference(t, p, of_place ? k : 2 + k, &off);
            const double is = out[of_place ? PL_FORMULA_AX + k : PL_FORMULA_AX_VX + k];
            if (!isfinite(should) || !(off < 1e-6L * (1 + fabsl(should)))) {
                continue;
            }
            ++compared;
            if (!(fabsl((long double)is - should) <= 20 * off + 1e-9L * (1 + fabsl(should)))) {
                print_message("%s by %d at %.17g %.17g %.17g %.17g %.17g: %.17g, not %.17Lg\n",
                              w.text, k, p.x, p.y, p.vx, p.vy, p.t, is, should);
                fail();
            }
        }
        if (of_place) { // itself is among the results
            long double loss;
            const long double should = evaluate(t, &p, &loss);
            assert_true(!isfinite(should) || !(loss < 1e-6L * (1 + fabsl(should))) ||
                        fabsl((long double)out[PL_FORMULA_POTENTIAL] - should) <= 4 * loss);
        } else {
            assert_true(out[PL_FORMULA_AY_VX] == 1 && out[PL_FORMULA_AY_VY] == 0);
        }
    }
    print_message("%u slopes compared\n", compared);
    assert_true(compared > count);
}

static void slopes_where_there_is_a_kink_are_told(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double x, y, ax, ay;
    } cases[] = { { "r", 0, 0, 0, 0 },
                  { "r^2 + 3 * x", 0, 0, 3, 0 },
                  { "sqrt(x^2 + y^2) - y", 0, 0, 0, -1 },
                  { "abs(x) + 2 * y", 0, 0, 0, 2 },
                  { "max(x, 0) + min(y, 0)", 0, 0, 0, 0 },
                  { "max(x, 0) + min(y, 0)", 1, -1, 1, 1 },
                  { "if(x < 1, x, 2 * x)", 1, 0, 2, 0 },
                  { "step(x) + floor(y) + sign(x)", 1, 1, 0, 0 },
                  { "0 * exp(1000 * x) + y", 5, 0, 0, 1 },
                  { "x^0.5", 4, 0, 0.25, 0 },
                  { "2 ^ x", 0, 0, 0.69314718055994531, 0 },
                  { "x ^ y", 2, 3, 12, 5.5451774444795625 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const pl_formula f = made(cases[i].text, NULL);
        double out[PL_FORMULA_RESULTS];
        ask(&f, (place){ cases[i].x, cases[i].y, 0, 0, 0 }, out);
        assert_true(fabs(out[0] - cases[i].ax) < 1e-14 && fabs(out[1] - cases[i].ay) < 1e-14);
    }
}

//---- columns -------------------------------------------------------------------------------------

static uint64_t bits_of(double v)
{
    return pl_lane_bits(v == v ? v : 0); // no number is no number
}

static void columns_have_the_bits_of_single_places(void **state)
{
    (void)state;
    static const int widths[] = { 4, 8, 16 };
    const uint32_t count = trials_count(4000);
    garden g = { .random = 23, .names = 8, .calls = CALLS };
    static double columns[PL_FORMULA_REGISTERS][PL_FORMULA_LANES];
    for (uint32_t n = 0; n < count; ++n) {
        static writing w;
        g.count = 0;
        if (!write_tree(&w, grow(&g, 1 + pick(&g, 5)))) {
            continue;
        }
        const pl_formula f = made(w.text, "y - x");
        double constants[PL_FORMULA_CONSTANTS];
        place places[PL_FORMULA_LANES];
        const double wide = n % 5 == 0 ? 1e7 : 1; // angles beyond those that lanes take
        pl_formula_begin(&f, sim_uniform(&g.random, 0, 3), constants);
        for (int i = 0; i < PL_FORMULA_LANES; ++i) {
            places[i] = anywhere(&g);
            places[i].x *= i % 3 == 0 ? wide : 1;
        }
        for (int width = 0; width < 3; ++width) {
            if (widths[width] == 16 && !__builtin_cpu_supports("avx512dq")) {
                continue;
            }
            for (int i = 0; i < PL_FORMULA_LANES; ++i) {
                columns[0][i] = places[i].x, columns[1][i] = places[i].y;
                columns[2][i] = places[i].vx, columns[3][i] = places[i].vy;
            }
            pl_formula_columns_of(widths[width])(&f, constants, columns, true);
            for (int i = 0; i < PL_FORMULA_LANES; ++i) {
                const place p = places[i];
                double registers[PL_FORMULA_REGISTERS] = { p.x, p.y, p.vx, p.vy };
                pl_formula_at(&f, constants, registers, true);
                for (int k = 0; k < PL_FORMULA_RESULTS; ++k) {
                    const uint8_t at = f.results[k];
                    const double is = at < PL_FORMULA_CONSTANT
                                          ? columns[at][i]
                                          : constants[at - PL_FORMULA_CONSTANT];
                    const double should =
                        pl_formula_result_at(&f, constants, registers, (pl_formula_result)k);
                    assert_true(bits_of(is) == bits_of(should));
                }
            }
        }
    }
}

static void steps_that_are_alike_are_one(void **state)
{
    (void)state;
    pl_formula f = made("sin(x) * sin(x) + sin(x)", "sin(x) - cos(2 * t) / (3 - 1)");
    // sin, its square, their sum; for y the cosine and its half are even, one difference.
    assert_int_equal(f.force_end - f.even_end, 4);
    assert_int_equal(f.even_end, 3);
    assert_true(f.uses_time && !f.uses_velocity && !f.is_potential);
    f = made("2 * 3 + sqrt(16)", "0");
    assert_int_equal(f.end, 0);
    f = made("3 * x + t - vx", "0");
    assert_true(f.uses_time && f.uses_velocity);
    // Of -2 (x^2 + y^2) a slope has no more than a product.
    f = made("2 * (x^2 + y^2)", NULL);
    assert_true(f.force_end <= 4 && f.is_potential);
    const pl_formula other = made("2*(x^2+y^2)", NULL);
    assert_memory_equal(&f, &other, sizeof f); // spaces are nothing
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(programs_give_what_the_recursion_gives),
        cmocka_unit_test(slopes_are_those_of_differences),
        cmocka_unit_test(slopes_where_there_is_a_kink_are_told),
        cmocka_unit_test(columns_have_the_bits_of_single_places),
        cmocka_unit_test(steps_that_are_alike_are_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
