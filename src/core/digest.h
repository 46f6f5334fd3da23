// digest.h - a 64-bit digest of bytes: checksum of images, hash of worlds. Not cryptographic.
//
// Eight lanes of 64 bits, each lane = rotate(lane ^ word, 29) * odd: a word more is a bijection of
// its lane, so a single changed word always changes the result; eight lanes keep the multiplier
// busy. Words are read as the machine stores them: digests of little-endian machines agree.
// Cost: about 8 bytes a cycle.
#ifndef PL_DIGEST_H
#define PL_DIGEST_H

#include <stddef.h>
#include <stdint.h>

#define PL_DIGEST_LANES 8

typedef struct pl_digest {
    uint64_t lane[PL_DIGEST_LANES];
    uint64_t length; // [B] so far
} pl_digest;

void pl_digest_begin(pl_digest *digest);
// Adds a run of bytes; where runs begin and end counts too.
void pl_digest_add(pl_digest *digest, const void *data, size_t bytes);
uint64_t pl_digest_end(const pl_digest *digest);

// The digest of one run.
uint64_t pl_digest_of(const void *data, size_t bytes);

// Of a header, in which the checksum at `at` counts as 0, and what is behind it.
uint64_t pl_digest_sealed(const void *header, size_t size, size_t at, const void *behind,
                          size_t bytes);

// The bytes of a number the other way round: how a magic number looks from a foreign byte order.
static inline uint64_t pl_reversed(uint64_t v)
{
    uint64_t out = 0;
    for (int i = 0; i < 8; ++i) {
        out = out << 8 | (v >> 8 * i & 0xff);
    }
    return out;
}

#endif
