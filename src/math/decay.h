// decay.h - the exponential of linear damping, the same bits on every compiler and machine.
#ifndef PL_DECAY_H
#define PL_DECAY_H

// exp(-x) and its integrals, x >= 0.
typedef struct pl_decay {
    double left;  // exp(-x)
    double mean;  // (1 - exp(-x)) / x: mean of exp(-x t) over 0..1; 1 at 0
    double twice; // (1 - mean) / x: integral of t times that over 0..1; 1/2 at 0
} pl_decay;

pl_decay pl_decay_of(double x);

#endif
