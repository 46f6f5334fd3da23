// ops.h - what the steps of a program do: the one list.
//
// X(NAME, takes, value): value is an expression of a, b and c, without branches, of which run.c makes the operation on numbers,
// columns.simd.c that on columns.
#ifndef PL_FORMULA_OPS_H
#define PL_FORMULA_OPS_H

#include "formula/formula.h"
#include "math/lanes.h"
#include "math/trig.h"

#include <math.h>

// clang-format off
#define PL_FORMULA_LEAVES(X)                                                                       \
    X(NUMBER) X(TIME) X(PLACE_X) X(PLACE_Y) X(SPEED_X) X(SPEED_Y)

// Those of which an operand may be a constant without a column of its own.
#define PL_FORMULA_ARITHMETIC(X)                                                                   \
    X(ADD,      2, a + b)                                                                          \
    X(SUBTRACT, 2, a - b)                                                                          \
    X(MULTIPLY, 2, a * b)                                                                          \
    X(DIVIDE,   2, a / b)

#define PL_FORMULA_FUNCTIONS(X)                                                                    \
    X(NEGATE,   1, -a)                                                                             \
    X(ABS,      1, pl_lane_abs(a))                                                                 \
    X(SIGN,     1, pl_lane_sign(a))                                                                \
    X(FLOOR,    1, pl_lane_floor(a))                                                               \
    X(SQRT,     1, sqrt(a))                                                                        \
    X(EXP,      1, pl_lane_exp(a))                                                                 \
    X(LOG,      1, pl_lane_log(a))                                                                 \
    X(TANH,     1, pl_lane_tanh(a))                                                                \
    X(SHARE,    2, b == 0 ? 0 : a / b) /* slopes of roots, which have none at 0 */                 \
    X(MIN,      2, a < b ? a : b)                                                                  \
    X(MAX,      2, a > b ? a : b)                                                                  \
    X(LESS,     2, a < b ? 1.0 : 0.0)                                                              \
    X(AT_MOST,  2, a <= b ? 1.0 : 0.0)                                                             \
    X(HYPOT,    2, sqrt(a * a + b * b))                                                            \
    X(ATAN2,    2, pl_atan2(a, b))                                                                 \
    X(POWER,    2, pl_lane_power(a, b))                                                            \
    X(CHOOSE,   3, a != 0 ? b : c)

// Of angles: in lanes while they are not too large, the others one by one.
#define PL_FORMULA_ANGLES(X)                                                                       \
    X(SIN, 1, pl_lane_sine(a, 0),                        pl_formula_far_sine(a, false))            \
    X(COS, 1, pl_lane_sine(a, 1),                        pl_formula_far_sine(a, true))             \
    X(TAN, 1, pl_lane_sine(a, 0) / pl_lane_sine(a, 1),                                             \
      pl_formula_far_sine(a, false) / pl_formula_far_sine(a, true))
// clang-format on

#define PL_FORMULA_LEAF(name)      PL_OP_##name,
#define PL_FORMULA_NAME(name, ...) PL_OP_##name,
typedef enum pl_formula_op {
    PL_FORMULA_LEAVES(PL_FORMULA_LEAF) PL_FORMULA_ARITHMETIC(PL_FORMULA_NAME)
        PL_FORMULA_FUNCTIONS(PL_FORMULA_NAME) PL_FORMULA_ANGLES(PL_FORMULA_NAME) PL_OPS
} pl_formula_op;

// How many values it takes; leaves take none.
static inline int pl_formula_takes(pl_formula_op op)
{
#define PL_FORMULA_TAKES(name, takes, ...) [PL_OP_##name] = takes,
    static const uint8_t takes[PL_OPS] = { PL_FORMULA_ARITHMETIC(PL_FORMULA_TAKES)
                                               PL_FORMULA_FUNCTIONS(PL_FORMULA_TAKES)
                                                   PL_FORMULA_ANGLES(PL_FORMULA_TAKES) };
    return takes[op];
}

static inline double pl_formula_far_sine(double angle, bool cosine)
{
    double s, c;
    pl_sincos(angle, &s, &c);
    return cosine ? c : s;
}

// What an operation gives (run.c).
double pl_formula_value(pl_formula_op op, double a, double b, double c);

#endif
