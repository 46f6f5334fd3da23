// sparse.h - a code for bytes of which most are 0: the bitwise difference of things that changed little.
//
// Groups of eight 32-bit words: a byte that says which words are not 0, half a byte for each of those
// that says which of its bytes are not, those bytes; groups of zeros as a count. Numbers that move a
// little keep their sign, exponent and first digits, so that most words cost one to three and a half bytes.
#ifndef PL_SPARSE_H
#define PL_SPARSE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PL_SPARSE_GROUP 32u // [B]

typedef struct pl_sparse_coder {
    unsigned char *to;
    size_t size, used; // used goes on counting when it does not fit
    unsigned char group[PL_SPARSE_GROUP];
    uint32_t fill;
    uint32_t zero_groups;
} pl_sparse_coder;

// Plain bytes and numbers (seven bits a byte, low ones first) stand between runs of differences.
void pl_sparse_put_byte(pl_sparse_coder *c, unsigned byte);
void pl_sparse_put_number(pl_sparse_coder *c, uint32_t v);
// Difference of `bytes` bytes to those at `from`; NULL: to zeros.
void pl_sparse_put(pl_sparse_coder *c, const char *to, const char *from, size_t bytes);
// Ends a run of differences.
void pl_sparse_end(pl_sparse_coder *c);

typedef struct pl_sparse_decoder {
    const unsigned char *from;
    size_t size, used;
    bool damaged;
    unsigned char group[PL_SPARSE_GROUP];
    uint32_t left; // bytes of the group not taken yet
    uint32_t zero_groups;
} pl_sparse_decoder;

// What stands there; what is not there makes it `damaged` and gives 0.
uint32_t pl_sparse_get_number(pl_sparse_decoder *d);
void pl_sparse_get(pl_sparse_decoder *d, char *to, const char *from, size_t bytes);
// Ends a run: the rest of a group, and of the zeros behind, belongs to nothing.
void pl_sparse_drop(pl_sparse_decoder *d);

#endif
