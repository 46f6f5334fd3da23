// formula.h - a formula: text of a force or a potential becomes a small program, which runs over columns of places.
//
// Knows no world. What a user may write: include/plumb/law.h.
#ifndef PL_FORMULA_H
#define PL_FORMULA_H

#include <stdbool.h>
#include <stdint.h>

enum {
    PL_FORMULA_TEXT = 512,     // [B] of a text and the 0 behind it
    PL_FORMULA_LANES = 32,     // places that a program takes at a time
    PL_FORMULA_REGISTERS = 40, // columns of them
    PL_FORMULA_CONSTANTS = 96, // numbers, and what is the same at all places
    PL_FORMULA_STEPS = 400,    // of a program
    PL_FORMULA_RESULTS = 6
};

// Where a step finds what it takes: a register below PL_FORMULA_CONSTANT, else a constant.
enum { PL_FORMULA_CONSTANT = 128 };

// The first registers are what a program is about. They are lost while it runs.
typedef enum pl_formula_input {
    PL_FORMULA_X, // [m]
    PL_FORMULA_Y,
    PL_FORMULA_VX, // [m/s] where it uses velocities
    PL_FORMULA_VY,
    PL_FORMULA_INPUTS
} pl_formula_input;

// What comes of it.
typedef enum pl_formula_result {
    PL_FORMULA_AX, // of components; of a potential its slope along x, which is minus the force
    PL_FORMULA_AY,
    PL_FORMULA_AX_VX, // how AX changes with VX; of a potential: itself
    PL_FORMULA_AX_VY,
    PL_FORMULA_AY_VX,
    PL_FORMULA_AY_VY,
    PL_FORMULA_POTENTIAL = PL_FORMULA_AX_VX
} pl_formula_result;

typedef struct pl_formula_step {
    uint8_t op; // pl_formula_op
    uint8_t to; // register; in the first part a constant
    uint8_t a, b, c;
} pl_formula_step;

// Saved and hashed: no padding, and zeros where nothing is. Texts that are the same make the same program.
typedef struct pl_formula {
    double constants[PL_FORMULA_CONSTANTS]; // the first is the time, [s]
    pl_formula_step steps[PL_FORMULA_STEPS];
    // Ends of its parts: what is the same at all places, AX and AY, the other results.
    uint16_t even_end, force_end, end;
    uint8_t results[PL_FORMULA_RESULTS]; // where they are
    uint8_t constant_count;
    uint8_t uses_time, uses_velocity, is_potential; // 0 or 1
} pl_formula;

_Static_assert(sizeof(pl_formula) == 8 * PL_FORMULA_CONSTANTS +
                                         sizeof(pl_formula_step) * PL_FORMULA_STEPS +
                                         3 * sizeof(uint16_t) + PL_FORMULA_RESULTS + 4,
               "pl_formula has no padding");

// Why a text is no formula.
typedef struct pl_formula_fault {
    int text;       // 0 or 1: which
    char says[320]; // with the place in it, counted from 1
} pl_formula_fault;

//---- compile.c -----------------------------------------------------------------------------------

// Two components, of which one may be null, or a potential, the first. False: see the fault.
bool pl_formula_compile(const char *const texts[2], bool is_potential, pl_formula *out,
                        pl_formula_fault *fault);

//---- run.c, columns.simd.c -----------------------------------------------------------------------

// At so many seconds: the constants of a run.
void pl_formula_begin(const pl_formula *f, double time, double constants[PL_FORMULA_CONSTANTS]);

// The column of each register, from the inputs on. `whole`: all results, not only AX and AY.
typedef void pl_formula_columns(const pl_formula *f, const double *constants,
                                double (*columns)[PL_FORMULA_LANES], bool whole);
pl_formula_columns pl_formula_columns_w4, pl_formula_columns_w8, pl_formula_columns_w16;

// By the world's simd_width.
static inline pl_formula_columns *pl_formula_columns_of(int width)
{
    return width == 16  ? pl_formula_columns_w16
           : width == 8 ? pl_formula_columns_w8
                        : pl_formula_columns_w4;
}

// One place: the bits that it has in columns.
void pl_formula_at(const pl_formula *f, const double *constants,
                   double registers[PL_FORMULA_REGISTERS], bool whole);

static inline double pl_formula_result_at(const pl_formula *f, const double *constants,
                                          const double *registers, pl_formula_result result)
{
    const uint8_t at = f->results[result];
    return at < PL_FORMULA_CONSTANT ? registers[at] : constants[at - PL_FORMULA_CONSTANT];
}

#endif
