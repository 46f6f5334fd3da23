// bits.h - sets of up to 64 as the bits of a word.
#ifndef PL_BITS_H
#define PL_BITS_H

#include <stdint.h>

// In as many turns as there are bits: the compiler's own is a function of its library on machines without the instruction.
static inline uint32_t pl_count_bits(uint64_t set)
{
    uint32_t count = 0;
    for (; set != 0; set &= set - 1) {
        ++count;
    }
    return count;
}

#endif
