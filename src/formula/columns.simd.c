// columns.simd.c - a program over columns of places: a step is a loop, of which compilers make lanes.
//
// A place never meets another, so every width gives the same bits, those of pl_formula_at among them.
//
// Reads: program, constants, inputs. Writes: registers. Cost: O(steps); one to three instructions a place where it adds or
// multiplies (effects/DECISIONS.md).
#include "formula/ops.h"

#include "core/wide.h"

void PL_WIDE_NAME(pl_formula_columns)(const pl_formula *f, const double *constants,
                                      double (*columns)[PL_FORMULA_LANES], bool whole)
{
    const uint32_t end = whole ? f->end : f->force_end;
    for (uint32_t i = f->even_end; i < end; ++i) {
        pl_formula_step_over(&f->steps[i], constants, columns[0], PL_FORMULA_LANES);
    }
}
