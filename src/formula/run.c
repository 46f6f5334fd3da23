// run.c - a program at one place, and what it has that is the same at all places.
//
// Reads: program, constants, inputs. Writes: constants; registers. Cost: O(steps).
#include "formula/ops.h"

void pl_formula_begin(const pl_formula *f, double time, double constants[PL_FORMULA_CONSTANTS])
{
    memcpy(constants, f->constants, f->constant_count * sizeof *constants);
    constants[0] = time;
    for (uint32_t i = 0; i < f->even_end; ++i) {
        const pl_formula_step *s = &f->steps[i];
        double values[] = { constants[s->a - PL_FORMULA_CONSTANT],
                            constants[s->b - PL_FORMULA_CONSTANT],
                            constants[s->c - PL_FORMULA_CONSTANT], 0 };
        const pl_formula_step alone = { .op = s->op, .to = 3, .a = 0, .b = 1, .c = 2 };
        pl_formula_step_over(&alone, constants, values, 1);
        constants[s->to - PL_FORMULA_CONSTANT] = values[3];
    }
}

void pl_formula_at(const pl_formula *f, const double *constants,
                   double registers[PL_FORMULA_REGISTERS], bool whole)
{
    const uint32_t end = whole ? f->end : f->force_end;
    for (uint32_t i = f->even_end; i < end; ++i) {
        pl_formula_step_over(&f->steps[i], constants, registers, 1);
    }
}
