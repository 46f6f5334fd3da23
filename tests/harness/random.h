/// random.h - seeded random numbers for tests, for those that need nothing else of sim.h.
#ifndef HARNESS_RANDOM_H
#define HARNESS_RANDOM_H

#include <stdint.h>

/// xorshift32 (Marsaglia 2003): the next number, 1..2^32 - 1. The state must not be 0.
static inline uint32_t sim_random(uint32_t *state)
{
    uint32_t s = *state;
    s ^= s << 13;
    s ^= s >> 17;
    s ^= s << 5;
    return *state = s;
}

/// Uniform in [low, high).
static inline double sim_uniform(uint32_t *state, double low, double high)
{
    return low + (high - low) * (sim_random(state) / 4294967296.0);
}

#endif
