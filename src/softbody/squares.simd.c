// squares.simd.c - the inner loop of L D L^T where all blocks are two by two: a block in one register of four doubles.
//
// Sums run as in matrix.c, number by number, so every width gives the same bits.
//
// Reads: a column of L. Writes: the work of a row. Cost: O(blocks of the column).
#include "core/wide.h"
#include "softbody/softbody.h"

// In memory as doubles are aligned.
typedef double square
    __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double)), may_alias));

void PL_WIDE_NAME(pl_soft_squares)(double *work, const double *y, const double *l,
                                   const uint32_t *rows, uint32_t count)
{
    const square first = { y[0], y[0], y[2], y[2] }, second = { y[1], y[1], y[3], y[3] };
    for (uint32_t p = 0; p < count; ++p) {
        const square of = *(const square *)(const void *)(l + 9 * (size_t)p);
        square *to = (square *)(void *)(work + 9 * (size_t)rows[p]);
        *to -= first * __builtin_shufflevector(of, of, 0, 2, 0, 2) +
               second * __builtin_shufflevector(of, of, 1, 3, 1, 3);
    }
}
