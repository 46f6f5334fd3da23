// dial.h - what a world with a tolerance knows of its error, and has chosen (src/accuracy).
#ifndef PL_TABLE_DIAL_H
#define PL_TABLE_DIAL_H

#include <stdbool.h>
#include <stdint.h>

typedef enum pl_dial_tier {
    PL_DIAL_SWEPT,  // the soft step
    PL_DIAL_DIRECT, // the soft step, joints solved together
    PL_DIAL_EXACT,
    PL_DIAL_TIERS
} pl_dial_tier;

// Why it chose what it chose; see plumb_world_accuracy.
typedef enum pl_dial_reason {
    PL_DIAL_BEGUN,  // as the world was set
    PL_DIAL_EASY,   // few substeps are enough
    PL_DIAL_MOTION, // motion asks for so many substeps
    PL_DIAL_REST,   // overlaps and gaps of joints ask for so many
    PL_DIAL_MOST,   // more would not help
    PL_DIAL_LOOSE,  // overlaps and gaps ask for a direct solver
    PL_DIAL_HEAVY,  // mass ratios do
    PL_DIAL_RESTING, // bodies that rest on two points do: limits of stability
    PL_DIAL_TIED,   // joints that hold one another do
    PL_DIAL_REASONS
} pl_dial_reason;

typedef struct pl_dial {
    // Decides later steps.
    uint32_t tier;   // pl_dial_tier
    uint32_t reason; // pl_dial_reason
    double elapsed;  // [s] since the tolerance was set
    double speed;    // [m/s] fastest of late
    double push;     // [m/s^2] of what is accelerated most, mean of late
    double need;     // [-] substeps that were asked for of late
    double loose;    // [-] overlaps and gaps over the smallest body, mean of late
    // Is told.
    double motion, frozen, rest; // [-] errors of the last seconds
    double worst;
    uint64_t steps, solved;
    bool told; // in the log
} pl_dial;

#endif
