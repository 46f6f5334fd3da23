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

#ifndef PL_WIDTH
#error "PL_WIDTH must be 4, 8 or 16"
#endif

// PL_WIDE_NAME(solve) is solve_w8 and so on.
#define PL_PASTE2(a, b)    a##b
#define PL_PASTE(a, b)     PL_PASTE2(a, b)
#define PL_WIDE_NAME(name) PL_PASTE(name##_w, PL_WIDTH)

#define WIDE_INLINE static inline __attribute__((always_inline, unused))

// Parts of a kernel. Lanes of doubles that no register holds live in memory, each one ever written: all parts in one
// function would have a stack frame of 32 kB.
#if PL_NEAR_IS_DOUBLE
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
    __attribute__((vector_size(PL_WIDTH * sizeof(near_real)), PL_REGISTER(PL_WIDTH * 4)));
typedef pl_lane vm // masks: 0 or -1
    __attribute__((vector_size(PL_WIDTH * sizeof(pl_lane)), PL_REGISTER(PL_WIDTH * 4)));
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

WIDE_INLINE bool any(vm mask)
{
    pl_lane r = 0;
    for (int i = 0; i < PL_WIDTH; ++i) {
        r |= mask[i];
    }
    return r != 0;
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

WIDE_INLINE void gather8(vf out[8], const near_real *const *rows)
{
    gather4(out, rows, 0);
    gather4(out + 4, rows, 4);
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
    gather4_far(out, rows, 0);
    gather4_far(out + 4, rows, 4);
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
    scatter4(rows, 0, in);
    scatter4(rows, 4, in + 4);
}

#undef PATTERN
#undef JOIN
#undef B

#endif
