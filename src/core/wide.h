// wide.h - vectors of PL_WIDTH near_reals for files that are compiled once per width (*.simd.c), on the
// vector extensions of GCC and Clang. Arithmetic is the language's own operators; lanes never mix,
// so every width gives the same bits.
//
// Included by *.simd.c only. All functions are static inline: an instruction of a wide unit can
// never leak into code that runs on a narrow machine.
#ifndef PL_WIDE_H
#define PL_WIDE_H

#include "core/quad.h"

#include <string.h>

#ifndef PL_SIMD
#error "PL_SIMD, the floats of a register, must be 4, 8 or 16"
#endif

// [B] of a register. Of other machines none has been asked for more than four floats.
#if defined(__x86_64__)
#define PL_REGISTER_SIZE (4 * PL_SIMD)
#else
#define PL_REGISTER_SIZE 16
#endif

// Lanes: as many as a register holds, but four at the least, as rows are transposed by fours. GCC takes vectors that no
// register holds to pieces, shuffles and masks lane by lane: doubles in as many lanes as floats took 2 to 5 times as long
// (src/solver/DECISIONS.md).
#if !PL_NEAR_IS_DOUBLE
#define PL_WIDTH     (PL_REGISTER_SIZE / 4)
#define PL_WIDE_SIZE (4 * PL_WIDTH) // [B]
#else
#define PL_WIDTH     (PL_REGISTER_SIZE == 64 ? 8 : 4)
#define PL_WIDE_SIZE (8 * PL_WIDTH)
#endif

// PL_WIDE_NAME(solve) is solve_w8 and so on.
#define PL_PASTE2(a, b)    a##b
#define PL_PASTE(a, b)     PL_PASTE2(a, b)
#define PL_WIDE_NAME(name) PL_PASTE(name##_w, PL_SIMD)

#define WIDE_INLINE static inline __attribute__((always_inline, unused))

// Parts of a kernel. Lanes of doubles that no register holds live in memory, each one ever written: all parts in one
// function would have a stack frame of 32 kB.
#if PL_WIDE_SIZE > PL_REGISTER_SIZE
#define WIDE_PART static __attribute__((noinline, unused))
#else
#define WIDE_PART WIDE_INLINE
#endif

#if PL_NEAR_IS_DOUBLE
typedef int64_t pl_lane;
#define LANE_SQRT __builtin_sqrt
#else
typedef int32_t pl_lane;
#define LANE_SQRT __builtin_sqrtf
#endif

typedef near_real vf
    __attribute__((vector_size(PL_WIDTH * sizeof(near_real)), PL_REGISTER(PL_REGISTER_SIZE)));
typedef pl_lane vm // masks: 0 or -1
    __attribute__((vector_size(PL_WIDTH * sizeof(pl_lane)), PL_REGISTER(PL_REGISTER_SIZE)));
typedef pl_near_quad quad;

WIDE_INLINE vf splat(near_real v)
{
    return v - (vf){ 0 };
}

WIDE_INLINE vf load(const near_real *p)
{
    vf v;
    memcpy(&v, p, sizeof v);
    return v;
}

WIDE_INLINE void store(near_real *p, vf v)
{
    memcpy(p, &v, sizeof v);
}

// mask ? a : b, lane by lane.
WIDE_INLINE vf sel(vm mask, vf a, vf b)
{
    return (vf)((mask & (vm)a) | (~mask & (vm)b));
}

WIDE_INLINE vm selm(vm mask, vm a, vm b)
{
    return (mask & a) | (~mask & b);
}

WIDE_INLINE vf vmin(vf a, vf b)
{
    return sel(a < b, a, b);
}

WIDE_INLINE vf vmax(vf a, vf b)
{
    return sel(a > b, a, b);
}

WIDE_INLINE vf vclamp(vf v, vf low, vf high)
{
    return vmin(vmax(v, low), high);
}

WIDE_INLINE vf vabs(vf v)
{
    return (vf)((vm)v & ~(vm)splat((near_real)-0.0));
}

WIDE_INLINE vf vsqrt(vf v)
{
    vf r = v;
    for (int i = 0; i < PL_WIDTH; ++i) {
        r[i] = LANE_SQRT(v[i]);
    }
    return r;
}

// Whether some bit of N / 8 words is set, by halves: a loop over the lanes becomes an extraction of each.
typedef int64_t words2 __attribute__((vector_size(16), PL_REGISTER(16)));
typedef int64_t words4
    __attribute__((vector_size(32), PL_REGISTER(PL_REGISTER_SIZE == 16 ? 16 : 32)));
typedef int64_t words8 __attribute__((vector_size(64), PL_REGISTER(PL_REGISTER_SIZE)));

WIDE_INLINE bool any16(words2 w)
{
    return (w[0] | w[1]) != 0;
}

WIDE_INLINE bool any32(words4 w)
{
    return any16(__builtin_shufflevector(w, w, 0, 1) | __builtin_shufflevector(w, w, 2, 3));
}

WIDE_INLINE bool any64(words8 w)
{
    return any32(__builtin_shufflevector(w, w, 0, 1, 2, 3) |
                 __builtin_shufflevector(w, w, 4, 5, 6, 7));
}

typedef uint32_t numbers __attribute__((vector_size(PL_WIDTH * sizeof(uint32_t))));

WIDE_INLINE bool any(vm mask)
{
#if PL_WIDE_SIZE == 64
    return any64((words8)mask);
#elif PL_WIDE_SIZE == 32
    return any32((words4)mask);
#else
    return any16((words2)mask);
#endif
}

// Whether W numbers are all below `end`.
WIDE_INLINE bool all_below(const uint32_t *x, uint32_t end)
{
    numbers n;
    memcpy(&n, x, sizeof n);
#if PL_WIDTH == 16
    return !any64((words8)(n >= end));
#elif PL_WIDTH == 8
    return !any32((words4)(n >= end));
#else
    return !any16((words2)(n >= end));
#endif
}

// Of the first `count` lanes.
WIDE_INLINE vm lanes_below(uint32_t count)
{
    pl_lane number[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        number[i] = i;
    }
    vm n;
    memcpy(&n, number, sizeof n);
    return n < (pl_lane)count;
}

WIDE_INLINE uint32_t count_set(vm mask)
{
    pl_lane sum = 0;
    for (int i = 0; i < PL_WIDTH; ++i) {
        sum -= mask[i];
    }
    return (uint32_t)sum;
}

// Sum of what is left without fractions: whole numbers, so that their order makes no difference. 0 <= v < 2^62.
WIDE_INLINE uint64_t sum_whole(vf v)
{
    int64_t sum = 0;
    for (int i = 0; i < PL_WIDTH; ++i) {
        sum += (int64_t)v[i];
    }
    return (uint64_t)sum;
}

WIDE_INLINE near_real most_of(vf v)
{
    near_real most = v[0];
    for (int i = 1; i < PL_WIDTH; ++i) {
        most = v[i] > most ? v[i] : most;
    }
    return most;
}

//---- rows <-> lanes ----------------------------------------------------------------------------
//
// A row is 4 or 8 consecutive reals; lane k of the result comes from row k. Four rows at a time are
// transposed within groups of four lanes, so one pattern serves every width.

#if PL_WIDTH == 4
#define PATTERN(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#define B(i)                      ((i) + 4)
#elif PL_WIDTH == 8
#define PATTERN(a, b, i, j, k, l)                                                                  \
    __builtin_shufflevector(a, b, i, j, k, l, (i) + 4, (j) + 4, (k) + 4, (l) + 4)
#define B(i) ((i) + 8)
#else
#define PATTERN(a, b, i, j, k, l)                                                                  \
    __builtin_shufflevector(a, b, i, j, k, l, (i) + 4, (j) + 4, (k) + 4, (l) + 4, (i) + 8,         \
                            (j) + 8, (k) + 8, (l) + 8, (i) + 12, (j) + 12, (k) + 12, (l) + 12)
#define B(i) ((i) + 16)
#endif

// Transposes the 4x4 blocks of four vectors.
WIDE_INLINE void transpose4(vf r[4])
{
    vf t0 = PATTERN(r[0], r[1], 0, B(0), 1, B(1));
    vf t1 = PATTERN(r[0], r[1], 2, B(2), 3, B(3));
    vf t2 = PATTERN(r[2], r[3], 0, B(0), 1, B(1));
    vf t3 = PATTERN(r[2], r[3], 2, B(2), 3, B(3));
    r[0] = PATTERN(t0, t2, 0, 1, B(0), B(1));
    r[1] = PATTERN(t0, t2, 2, 3, B(2), B(3));
    r[2] = PATTERN(t1, t3, 0, 1, B(0), B(1));
    r[3] = PATTERN(t1, t3, 2, 3, B(2), B(3));
}

// Quads of every fourth row side by side.
#if PL_WIDTH == 4
#define JOIN(q0, q1, q2, q3) ((vf)(q0))
#elif PL_WIDTH == 8
#define JOIN(q0, q1, q2, q3) __builtin_shufflevector(q0, q1, 0, 1, 2, 3, 4, 5, 6, 7)
#else
#define JOIN(q0, q1, q2, q3)                                                                       \
    __builtin_shufflevector(__builtin_shufflevector(q0, q1, 0, 1, 2, 3, 4, 5, 6, 7),               \
                            __builtin_shufflevector(q2, q3, 0, 1, 2, 3, 4, 5, 6, 7), 0, 1, 2, 3,   \
                            4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#endif

WIDE_INLINE vf join(const near_real *const *rows, int k, int offset)
{
#define QUAD(i) (*(const quad *)(const void *)(rows[i] + offset))
    return JOIN(QUAD(k), QUAD(k + 4), QUAD(k + 8), QUAD(k + 12));
#undef QUAD
}

WIDE_INLINE void split(near_real *const *rows, int k, int offset, vf v)
{
#define QUAD(i) (*(quad *)(void *)(rows[i] + offset))
#if PL_WIDTH == 4
    QUAD(k) = (quad)v;
#elif PL_WIDTH == 8
    QUAD(k) = __builtin_shufflevector(v, v, 0, 1, 2, 3);
    QUAD(k + 4) = __builtin_shufflevector(v, v, 4, 5, 6, 7);
#else
    QUAD(k) = __builtin_shufflevector(v, v, 0, 1, 2, 3);
    QUAD(k + 4) = __builtin_shufflevector(v, v, 4, 5, 6, 7);
    QUAD(k + 8) = __builtin_shufflevector(v, v, 8, 9, 10, 11);
    QUAD(k + 12) = __builtin_shufflevector(v, v, 12, 13, 14, 15);
#endif
#undef QUAD
}

// out[j] lane i = rows[i][offset + j], j < 4. Rows are aligned to four reals.
WIDE_INLINE void gather4(vf out[4], const near_real *const *rows, int offset)
{
    for (int k = 0; k < 4; ++k) {
        out[k] = join(rows, k, offset);
    }
    transpose4(out);
}

// Rows of eight: half as many loads, and a third stage that exchanges groups of four lanes, 40 instructions in place of 72.
#if PL_WIDTH > 4
#define EIGHTS 1
typedef near_real oct
    __attribute__((vector_size(8 * sizeof(near_real)), aligned(4 * sizeof(near_real)), may_alias));

// Groups of four lanes of two vectors, side by side: low has x0 y0 (x2 y2) and high x1 y1 (x3 y3), or where W is
// 16 `FIRSTS` x0 x2 y0 y2, `SECONDS` x1 x3 y1 y3.
#if PL_WIDTH == 8
#define FIRSTS(x, y)    __builtin_shufflevector(x, y, 0, 1, 2, 3, 8, 9, 10, 11)
#define SECONDS(x, y)   __builtin_shufflevector(x, y, 4, 5, 6, 7, 12, 13, 14, 15)
#define LOW(x, y)       FIRSTS(x, y)
#define HIGH(x, y)      SECONDS(x, y)
#define EIGHT(i)        (*(const oct *)(const void *)rows[i])
#define PUT_EIGHT(i, v) *(oct *)(void *)rows[i] = (v)
#else
#define FIRSTS(x, y)                                                                               \
    __builtin_shufflevector(x, y, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27)
#define SECONDS(x, y)                                                                              \
    __builtin_shufflevector(x, y, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31)
#define LOW(x, y)                                                                                  \
    __builtin_shufflevector(x, y, 0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23)
#define HIGH(x, y)                                                                                 \
    __builtin_shufflevector(x, y, 8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31)
#define EIGHT(i)                                                                                   \
    __builtin_shufflevector(*(const oct *)(const void *)rows[i],                                   \
                            *(const oct *)(const void *)rows[(i) + 4], 0, 1, 2, 3, 4, 5, 6, 7, 8,  \
                            9, 10, 11, 12, 13, 14, 15)
#define PUT_EIGHT(i, v)                                                                            \
    do {                                                                                           \
        *(oct *)(void *)rows[i] = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);           \
        *(oct *)(void *)rows[(i) + 4] =                                                            \
            __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);                           \
    } while (0)
#endif
#else
#define EIGHTS 0
#endif

WIDE_INLINE void gather8(vf out[8], const near_real *const *rows)
{
#if EIGHTS
    vf r[8];
    for (int k = 0; k < 4; ++k) {
        r[k] = EIGHT(k);
        r[k + 4] = EIGHT(k + PL_WIDTH / 2);
    }
    transpose4(r);
    transpose4(r + 4);
    for (int k = 0; k < 4; ++k) {
        out[k] = FIRSTS(r[k], r[k + 4]);
        out[k + 4] = SECONDS(r[k], r[k + 4]);
    }
#else
    gather4(out, rows, 0);
    gather4(out + 4, rows, 4);
#endif
}

//---- rows of plumb_real ---------------------------------------------------------------------------

#if PLUMB_IS_FAR
typedef plumb_real far_quad
    __attribute__((vector_size(4 * sizeof(plumb_real)), aligned(sizeof(plumb_real)), may_alias));

WIDE_INLINE quad to_near(far_quad q)
{
    return __builtin_convertvector(q, quad);
}
#endif

// In the far build these become near as they are read.
WIDE_INLINE void gather4_far(vf out[4], const plumb_real *const *rows, int offset)
{
#if PLUMB_IS_FAR
#define QUAD(i) to_near(*(const far_quad *)(const void *)(rows[i] + offset))
    for (int k = 0; k < 4; ++k) {
        out[k] = JOIN(QUAD(k), QUAD(k + 4), QUAD(k + 8), QUAD(k + 12));
    }
#undef QUAD
    transpose4(out);
#else
    gather4(out, rows, offset);
#endif
}

WIDE_INLINE void gather8_far(vf out[8], const plumb_real *const *rows)
{
#if PLUMB_IS_FAR
    gather4_far(out, rows, 0);
    gather4_far(out + 4, rows, 4);
#else
    gather8(out, rows);
#endif
}

// Quads x y .. .. with the places (x, y) seen from origins: (cx, cy) are the lanes' origins[i][0] and [1].
WIDE_INLINE void gather4_from(vf out[4], const plumb_real *const *rows,
                              const plumb_real *const *origins, vf cx, vf cy)
{
#if PLUMB_IS_FAR
    (void)cx, (void)cy;
#define QUAD(i)                                                                                    \
    to_near(*(const far_quad *)(const void *)rows[i] - (far_quad){ origins[i][0], origins[i][1] })
    for (int k = 0; k < 4; ++k) {
        out[k] = JOIN(QUAD(k), QUAD(k + 4), QUAD(k + 8), QUAD(k + 12));
    }
#undef QUAD
    transpose4(out);
#else
    (void)origins;
    gather4(out, rows, 0);
    out[0] -= cx;
    out[1] -= cy;
#endif
}

//---- lanes to rows -------------------------------------------------------------------------------

// rows[i][offset + j] = in[j] lane i, j < 4.
WIDE_INLINE void scatter4(near_real *const *rows, int offset, const vf in[4])
{
    vf r[4] = { in[0], in[1], in[2], in[3] };
    transpose4(r);
    for (int k = 0; k < 4; ++k) {
        split(rows, k, offset, r[k]);
    }
}

WIDE_INLINE void scatter8(near_real *const *rows, const vf in[8])
{
#if EIGHTS
    vf r[8];
    for (int k = 0; k < 4; ++k) {
        r[k] = LOW(in[k], in[k + 4]);
        r[k + 4] = HIGH(in[k], in[k + 4]);
    }
    transpose4(r);
    transpose4(r + 4);
    for (int k = 0; k < 4; ++k) {
        PUT_EIGHT(k, r[k]);
        PUT_EIGHT(k + PL_WIDTH / 2, r[k + 4]);
    }
#else
    scatter4(rows, 0, in);
    scatter4(rows, 4, in + 4);
#endif
}

#undef PATTERN
#undef JOIN
#undef B
#if EIGHTS
#undef FIRSTS
#undef SECONDS
#undef LOW
#undef HIGH
#undef EIGHT
#undef PUT_EIGHT
#endif
#undef EIGHTS

#endif
