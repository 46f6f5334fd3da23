// digest.c - see digest.h.
#include "core/digest.h"

#include <string.h>

// Odd constants with about half their bits set: 2^64 times the fractions of sqrt(2), sqrt(3).
#define FACTOR UINT64_C(0x6a09e667f3bcc909)
#define START  UINT64_C(0xbb67ae8584caa73b)

#define BLOCK (PL_DIGEST_LANES * sizeof(uint64_t))

static inline uint64_t mixed(uint64_t lane, uint64_t word)
{
    uint64_t v = lane ^ word;
    return (v << 29 | v >> 35) * FACTOR;
}

static void add_blocks(pl_digest *digest, const char *data, size_t blocks)
{
    uint64_t lane[PL_DIGEST_LANES];
    memcpy(lane, digest->lane, sizeof lane);
    for (size_t i = 0; i < blocks; ++i, data += BLOCK) {
        for (size_t k = 0; k < PL_DIGEST_LANES; ++k) {
            uint64_t word;
            memcpy(&word, data + k * sizeof word, sizeof word);
            lane[k] = mixed(lane[k], word);
        }
    }
    memcpy(digest->lane, lane, sizeof lane);
}

void pl_digest_begin(pl_digest *digest)
{
    digest->length = 0;
    for (uint64_t k = 0; k < PL_DIGEST_LANES; ++k) {
        digest->lane[k] = START * (2 * k + 1);
    }
}

void pl_digest_add(pl_digest *digest, const void *data, size_t bytes)
{
    size_t whole = bytes / BLOCK * BLOCK;
    if (whole > 0) {
        add_blocks(digest, data, whole / BLOCK);
    }
    if (bytes > whole) {
        char rest[BLOCK] = { 0 };
        memcpy(rest, (const char *)data + whole, bytes - whole);
        add_blocks(digest, rest, 1);
    }
    digest->length += bytes;
    digest->lane[0] = mixed(digest->lane[0], bytes);
}

uint64_t pl_digest_end(const pl_digest *digest)
{
    uint64_t sum = mixed(START, digest->length);
    for (int k = 0; k < PL_DIGEST_LANES; ++k) {
        sum = mixed(sum, digest->lane[k]);
        sum ^= sum >> 32;
    }
    return sum;
}

uint64_t pl_digest_of(const void *data, size_t bytes)
{
    pl_digest digest;
    pl_digest_begin(&digest);
    pl_digest_add(&digest, data, bytes);
    return pl_digest_end(&digest);
}

uint64_t pl_digest_sealed(const void *header, size_t size, size_t at, const void *behind,
                          size_t bytes)
{
    static const uint64_t none = 0;
    char blank[256];
    pl_digest digest;
    memcpy(blank, header, size);
    memcpy(blank + at, &none, sizeof none);
    pl_digest_begin(&digest);
    pl_digest_add(&digest, blank, size);
    pl_digest_add(&digest, behind, bytes);
    return pl_digest_end(&digest);
}
