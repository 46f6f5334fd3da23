// columns.simd.c - a program over columns of places: a step is a loop, of which compilers make lanes.
//
// A place never meets another, so every width gives the same bits, those of pl_formula_at among them.
//
// Reads: program, constants, inputs. Writes: registers. Cost: O(steps); two to four instructions a place where it adds or
// multiplies (effects/DECISIONS.md).
#include "formula/ops.h"

#include "core/wide.h"

// A step never writes where it reads, which GCC does not see: without a copy of each loop for the other case they are half as long.
// Nor are long ones worth it to be written out eight times.
#if defined(__clang__)
#define APART
#define SHORT _Pragma("clang loop unroll(disable)")
#elif defined(__GNUC__)
#define APART _Pragma("GCC ivdep")
#define SHORT _Pragma("GCC ivdep") _Pragma("GCC unroll 1")
#else
#define APART
#define SHORT
#endif

// + - * /, of columns that are registers, one behind the other; or of a constant and a column.
WIDE_INLINE void calculate(const pl_formula_step *step, const double *constants,
                           double (*columns)[PL_FORMULA_LANES])
{
    const bool first_is_even = step->a >= PL_FORMULA_CONSTANT,
               second_is_even = step->b >= PL_FORMULA_CONSTANT;
    const double *pa = columns[first_is_even ? 0 : step->a];
    const double *pb = columns[second_is_even ? 0 : step->b];
    double *restrict to = columns[step->to];
    switch ((pl_formula_op)step->op) {
#define LOOP(A, B, value)                                                                          \
    APART                                                                                          \
    for (int i = 0; i < PL_FORMULA_LANES; ++i) {                                                   \
        const double a = A, b = B;                                                                 \
        to[i] = value;                                                                             \
    }
#define CASE(name, takes, value)                                                                   \
    case PL_OP_##name:                                                                             \
        if (first_is_even) {                                                                       \
            const double k = constants[step->a - PL_FORMULA_CONSTANT];                             \
            LOOP(k, pb[i], value)                                                                  \
        } else if (second_is_even) {                                                               \
            const double k = constants[step->b - PL_FORMULA_CONSTANT];                             \
            LOOP(pa[i], k, value)                                                                  \
        } else {                                                                                   \
            LOOP(pa[i], pb[i], value)                                                              \
        }                                                                                          \
        break;
        PL_FORMULA_ARITHMETIC(CASE)
#undef CASE
#undef LOOP
    default:
        break;
    }
}

// Where an operand's values are: its column, or a constant in all lanes of `room`.
WIDE_INLINE const double *operand(const double *constants, double (*columns)[PL_FORMULA_LANES],
                                  uint8_t at, double *room)
{
    if (at < PL_FORMULA_CONSTANT) {
        return columns[at];
    }
    SHORT
    for (int i = 0; i < PL_FORMULA_LANES; ++i) {
        room[i] = constants[at - PL_FORMULA_CONSTANT];
    }
    return room;
}

WIDE_INLINE void call(const pl_formula_step *step, const double *constants,
                      double (*columns)[PL_FORMULA_LANES])
{
    double room[3][PL_FORMULA_LANES];
    double *restrict to = columns[step->to];
    const double *pa = operand(constants, columns, step->a, room[0]);
    const double *pb = operand(constants, columns, step->b, room[1]);
    const double *pc = operand(constants, columns, step->c, room[2]);
    uint64_t any_far = 0;
    switch ((pl_formula_op)step->op) {
#define CASE(name, takes, value)                                                                   \
    case PL_OP_##name:                                                                             \
        SHORT                                                                                      \
        for (int i = 0; i < PL_FORMULA_LANES; ++i) {                                               \
            const double a = pa[i], b = pb[i], c = pc[i];                                          \
            (void)b, (void)c;                                                                      \
            to[i] = value;                                                                         \
        }                                                                                          \
        break;
        PL_FORMULA_FUNCTIONS(CASE)
#undef CASE
#define CASE(name, takes, value, far)                                                              \
    case PL_OP_##name:                                                                             \
        SHORT                                                                                      \
        for (int i = 0; i < PL_FORMULA_LANES; ++i) {                                               \
            const double a = pa[i];                                                                \
            any_far |= pl_lane_bits(pl_lane_abs(a) > PL_LANE_TURN_MOST ? 1.0 : 0.0);               \
            to[i] = value;                                                                         \
        }                                                                                          \
        for (int i = 0; i < PL_FORMULA_LANES && any_far != 0; ++i) {                               \
            const double a = pa[i];                                                                \
            to[i] = pl_lane_abs(a) > PL_LANE_TURN_MOST ? far : to[i];                              \
        }                                                                                          \
        break;
        PL_FORMULA_ANGLES(CASE)
#undef CASE
    default:
        break;
    }
}

void PL_WIDE_NAME(pl_formula_columns)(const pl_formula *f, const double *constants,
                                      double (*columns)[PL_FORMULA_LANES], bool whole)
{
    const uint32_t end = whole ? f->end : f->force_end;
    for (uint32_t i = f->even_end; i < end; ++i) {
        const pl_formula_step *step = &f->steps[i];
        if (step->op <= PL_OP_DIVIDE) {
            calculate(step, constants, columns);
        } else {
            call(step, constants, columns);
        }
    }
}
