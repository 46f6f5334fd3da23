// random.c - counter-based random numbers: SplitMix64, whose n-th output is a hash of key + n gamma.
//
// Source: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014; the
// constants of the finisher are David Stafford's variant 13. Cost: three multiplications a number.
#include "plumb/batch.h"

#define GAMMA UINT64_C(0x9e3779b97f4a7c15) // 2^64 over the golden ratio, odd

static uint64_t mixed(uint64_t z)
{
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

// Keys of one seed differ, for the finisher is a bijection; hashed twice so that they do not lie in
// one sequence of gammas.
plumb_random plumb_random_stream(uint64_t seed, uint64_t stream)
{
    return (plumb_random){ mixed(mixed(seed + GAMMA) ^ mixed(stream * GAMMA + 1)), 0 };
}

uint64_t plumb_random_bits(plumb_random *random)
{
    return random == NULL ? 0 : mixed(random->key + GAMMA * ++random->drawn);
}

plumb_real plumb_random_range(plumb_random *random, plumb_real low, plumb_real high)
{
    const int bits = sizeof(plumb_real) == sizeof(float) ? 24 : 53;
    uint64_t drawn = plumb_random_bits(random) >> (64 - bits);
    plumb_real share = (plumb_real)drawn / (plumb_real)(UINT64_C(1) << bits);
    plumb_real value = low + share * (high - low); // may round up to high
    return value < high ? value : low;
}
