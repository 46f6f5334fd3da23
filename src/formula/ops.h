// ops.h - what the steps of a program do: the one list, and one step over so many lanes.
//
// X(NAME, takes, value): value is an expression of a, b and c.
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
    X(COPY,     1, a)                                                                              \
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

//---- a step --------------------------------------------------------------------------------------

// Written out for each number of lanes, which is a constant where it is called.
#define PL_FORMULA_INLINE static inline __attribute__((always_inline, unused))

// Where an operand's values are: its column, or a constant in all lanes of `room`.
PL_FORMULA_INLINE const double *pl_formula_operand(const double *constants, const double *registers,
                                                   uint8_t at, double *room, int lanes)
{
    if (at < PL_FORMULA_CONSTANT) {
        return registers + (uint32_t)at * (uint32_t)lanes;
    }
    for (int i = 0; i < lanes; ++i) {
        room[i] = constants[at - PL_FORMULA_CONSTANT];
    }
    return room;
}

// Columns of so many lanes, one behind the other.
PL_FORMULA_INLINE void pl_formula_step_over(const pl_formula_step *step, const double *constants,
                                            double *registers, int lanes)
{
    double room[3][PL_FORMULA_LANES];
    double *restrict to = registers + (uint32_t)step->to * (uint32_t)lanes;
    const bool first_is_even = step->a >= PL_FORMULA_CONSTANT,
               second_is_even = step->b >= PL_FORMULA_CONSTANT;
    switch ((pl_formula_op)step->op) {
#define PL_FORMULA_LOOP(A, B, value)                                                               \
    for (int i = 0; i < lanes; ++i) {                                                              \
        const double a = A, b = B;                                                                 \
        to[i] = value;                                                                             \
    }
#define PL_FORMULA_CASE(name, takes, value)                                                        \
    case PL_OP_##name: {                                                                           \
        const double *pa = registers + (uint32_t)step->a * (uint32_t)lanes;                        \
        const double *pb = registers + (uint32_t)step->b * (uint32_t)lanes;                        \
        if (first_is_even) {                                                                       \
            const double k = constants[step->a - PL_FORMULA_CONSTANT];                             \
            PL_FORMULA_LOOP(k, pb[i], value)                                                       \
        } else if (second_is_even) {                                                               \
            const double k = constants[step->b - PL_FORMULA_CONSTANT];                             \
            PL_FORMULA_LOOP(pa[i], k, value)                                                       \
        } else {                                                                                   \
            PL_FORMULA_LOOP(pa[i], pb[i], value)                                                   \
        }                                                                                          \
        break;                                                                                     \
    }
        PL_FORMULA_ARITHMETIC(PL_FORMULA_CASE)
#undef PL_FORMULA_CASE
#define PL_FORMULA_CASE(name, takes, value)                                                        \
    case PL_OP_##name: {                                                                           \
        const double *pa = pl_formula_operand(constants, registers, step->a, room[0], lanes);      \
        const double *pb =                                                                         \
            takes < 2 ? pa : pl_formula_operand(constants, registers, step->b, room[1], lanes);    \
        const double *pc =                                                                         \
            takes < 3 ? pa : pl_formula_operand(constants, registers, step->c, room[2], lanes);    \
        for (int i = 0; i < lanes; ++i) {                                                          \
            const double a = pa[i], b = pb[i], c = pc[i];                                          \
            (void)b, (void)c;                                                                      \
            to[i] = value;                                                                         \
        }                                                                                          \
        break;                                                                                     \
    }
        PL_FORMULA_FUNCTIONS(PL_FORMULA_CASE)
#undef PL_FORMULA_CASE
#define PL_FORMULA_CASE(name, takes, value, far)                                                   \
    case PL_OP_##name: {                                                                           \
        const double *pa = pl_formula_operand(constants, registers, step->a, room[0], lanes);      \
        double *angles = room[1];                                                                  \
        uint64_t any_far = 0;                                                                      \
        for (int i = 0; i < lanes; ++i) {                                                          \
            const double a = pa[i];                                                                \
            any_far |= pl_lane_bits(pl_lane_abs(a) > PL_LANE_TURN_MOST ? 1.0 : 0.0);               \
            angles[i] = a;                                                                         \
            to[i] = value;                                                                         \
        }                                                                                          \
        for (int i = 0; i < lanes && any_far != 0; ++i) {                                          \
            const double a = angles[i];                                                            \
            to[i] = pl_lane_abs(a) > PL_LANE_TURN_MOST ? far : to[i];                              \
        }                                                                                          \
        break;                                                                                     \
    }
        PL_FORMULA_ANGLES(PL_FORMULA_CASE)
#undef PL_FORMULA_CASE
#undef PL_FORMULA_LOOP
    default:
        break;
    }
}

#endif
