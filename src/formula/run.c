// run.c - a program at one place, and what it has that is the same at all places.
//
// Reads: program, constants, inputs. Writes: constants; registers. Cost: O(steps).
#include "formula/ops.h"

static __attribute__((noinline)) double call(pl_formula_op op, double a, double b, double c)
{
    switch (op) {
#define CASE(name, takes, value)                                                                   \
    case PL_OP_##name:                                                                             \
        return value;
        PL_FORMULA_FUNCTIONS(CASE)
#undef CASE
#define CASE(name, takes, value, far)                                                              \
    case PL_OP_##name:                                                                             \
        return pl_lane_abs(a) > PL_LANE_TURN_MOST ? far : value;
        PL_FORMULA_ANGLES(CASE)
#undef CASE
    default:
        return 0;
    }
}

double pl_formula_value(pl_formula_op op, double a, double b, double c)
{
    switch (op) { // what is most of it takes no call
#define CASE(name, takes, value)                                                                   \
    case PL_OP_##name:                                                                             \
        return value;
        PL_FORMULA_ARITHMETIC(CASE)
#undef CASE
    default:
        return call(op, a, b, c);
    }
}

static double operand(const double *constants, const double *registers, uint8_t at)
{
    return at < PL_FORMULA_CONSTANT ? registers[at] : constants[at - PL_FORMULA_CONSTANT];
}

void pl_formula_begin(const pl_formula *f, double time, double constants[PL_FORMULA_CONSTANTS])
{
    memcpy(constants, f->constants, f->constant_count * sizeof *constants);
    constants[0] = time;
    for (uint32_t i = 0; i < f->even_end; ++i) {
        const pl_formula_step *s = &f->steps[i];
        constants[s->to - PL_FORMULA_CONSTANT] = pl_formula_value(
            (pl_formula_op)s->op, constants[s->a - PL_FORMULA_CONSTANT],
            constants[s->b - PL_FORMULA_CONSTANT], constants[s->c - PL_FORMULA_CONSTANT]);
    }
}

void pl_formula_at(const pl_formula *f, const double *constants,
                   double registers[PL_FORMULA_REGISTERS], bool whole)
{
    const uint32_t end = whole ? f->end : f->force_end;
    for (uint32_t i = f->even_end; i < end; ++i) {
        const pl_formula_step *s = &f->steps[i];
        registers[s->to] = pl_formula_value(
            (pl_formula_op)s->op, operand(constants, registers, s->a),
            operand(constants, registers, s->b), operand(constants, registers, s->c));
    }
}
