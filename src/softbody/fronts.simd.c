// fronts.simd.c - the inner loops of a factor and of a solution: four numbers of a column at a time.
//
// A panel has `width` columns of its own unknowns, by columns of `tall` numbers: rows of these, then of what is below them, each
// filled up with zeros to a multiple of four. The rest is the square of what is below, its lower half. Whatever the width of
// registers, each number loses its products one by one in the order of columns, and sums along a column have four parts: the same bits.
//
// Reads, writes: a panel, what it leaves to others, a piece of a vector. Cost: O(tall width (width + below)), O(tall width).
#include "core/wide.h"
#include "softbody/softbody.h"

#define FOUR(n) (((size_t)(n) + 3) & ~(size_t)3)

// Doubles of a vector: four, or as many as a register holds (core/wide.h). In memory as doubles are aligned.
#define PART (PL_REGISTER_SIZE == 16 ? 2 : 4)
typedef double part
    __attribute__((vector_size(PART * sizeof(double)), aligned(sizeof(double)), may_alias));

WIDE_INLINE part at(const double *p)
{
    return *(const part *)(const void *)p;
}

WIDE_INLINE void put(double *p, part v)
{
    *(part *)(void *)p = v;
}

// `high` parts of rows and `wide` columns of c lose l y', y as `scale` leaves it.
WIDE_INLINE void take_tile(double *c, const double *l, size_t tall, size_t c_tall, const double *y,
                           size_t depth, int high, int wide)
{
    part sum[4][2];
    for (int j = 0; j < wide; ++j) {
        for (int i = 0; i < high; ++i) {
            sum[j][i] = at(c + (size_t)j * c_tall + PART * i);
        }
    }
    for (size_t k = 0; k < depth; ++k) {
        for (int i = 0; i < high; ++i) {
            const part of = at(l + k * tall + PART * i);
            for (int j = 0; j < wide; ++j) {
                sum[j][i] -= of * y[4 * k + (size_t)j];
            }
        }
    }
    for (int j = 0; j < wide; ++j) {
        for (int i = 0; i < high; ++i) {
            put(c + (size_t)j * c_tall + PART * i, sum[j][i]);
        }
    }
}

// `rows` of `wide` columns likewise.
WIDE_INLINE void take_columns(double *c, const double *l, size_t tall, size_t c_tall,
                              const double *y, size_t depth, size_t rows, int wide)
{
    size_t i = 0;
    for (; i + 2 * PART <= rows; i += 2 * PART) {
        take_tile(c + i, l + i, tall, c_tall, y, depth, 2, wide);
    }
    if (i < rows) {
        take_tile(c + i, l + i, tall, c_tall, y, depth, 1, wide);
    }
}

static void take(double *c, const double *l, size_t tall, size_t c_tall, const double *y,
                 size_t depth, size_t rows, int wide)
{
    switch (wide) {
    case 1:
        take_columns(c, l, tall, c_tall, y, depth, rows, 1);
        return;
    case 2:
        take_columns(c, l, tall, c_tall, y, depth, rows, 2);
        return;
    case 3:
        take_columns(c, l, tall, c_tall, y, depth, rows, 3);
        return;
    default:
        take_columns(c, l, tall, c_tall, y, depth, rows, 4);
        return;
    }
}

// Columns [from, from + wide) of a panel, as those before left them, become columns of L; `scaled` L D, four rows at a time.
static void scale(double *panel, size_t tall, size_t width, size_t from, int wide, double *inverse,
                  double *scaled)
{
    for (int k = 0; k < wide; ++k) {
        double *column = panel + (from + (size_t)k) * tall, *y = scaled + 4 * (from + (size_t)k);
        const double by = 1 / column[from + (size_t)k];
        inverse[from + (size_t)k] = by;
        for (size_t i = from; i < tall; i += PART) {
            const part of = at(column + i);
            put(y + (i & ~(size_t)3) * width + (i & 3), of);
            put(column + i, of * by);
        }
        for (int j = k + 1; j < wide; ++j) {
            double *other = panel + (from + (size_t)j) * tall;
            const double of = y[from * width + (size_t)j];
            for (size_t i = from; i < tall; i += PART) {
                put(other + i, at(other + i) - at(column + i) * of);
            }
        }
    }
}

// Columns [j, count) of what a child leaves, `from` column j of it, go where `local` has their unknowns: there row `shift` is the first.
// `run`: how many from each on lie one behind the other.
static void add(double *to, const double *from, uint32_t j, uint32_t count, const uint32_t *local,
                const uint32_t *run, size_t shift)
{
    for (size_t i = j; i < count; i += run[i]) {
        double *a = to + (local[i] - shift);
        const size_t n = run[i];
        size_t k = 0;
        for (; k + PART <= n; k += PART) {
            put(a + k, at(a + k) + at(from + i + k));
        }
        for (; k < n; ++k) {
            a[k] += from[i + k];
        }
    }
}

// The lower half of a square becomes 0.
static void clear(double *rest, size_t tall)
{
    for (size_t j = 0; j < tall; ++j) {
        for (size_t i = j & ~(size_t)3; i < tall; i += PART) {
            put(rest + j * tall + i, (part){ 0 });
        }
    }
}

static void factor(double *panel, uint32_t width, uint32_t below, double *inverse, double *scaled,
                   double *rest)
{
    const size_t own = FOUR(width), tall = own + FOUR(below);
    for (size_t j = 0; j < width; j += 4) {
        const int wide = width - j < 4 ? (int)(width - j) : 4;
        if (j > 0) {
            take(panel + j * tall + j, panel + j, tall, tall, scaled + j * width, j, tall - j,
                 wide);
        }
        scale(panel, tall, width, j, wide, inverse, scaled);
    }
    for (size_t j = own; j < tall; j += 4) {
        double *to = rest + (j - own) * (tall - own) + (j - own);
        take(to, panel + j, tall, tall - own, scaled + j * width, width, tall - j, 4);
    }
}

// The rest of x loses L of `wide` columns times theirs, which lose what they are to one another.
static void push(const double *panel, uint32_t width, uint32_t below, double *x)
{
    const size_t tall = FOUR(width) + FOUR(below);
    for (size_t k = 0; k < width; k += 4) {
        const int wide = width - k < 4 ? (int)(width - k) : 4;
        const double *l = panel + k * tall;
        for (int j = 1; j < wide; ++j) {
            for (int i = 0; i < j; ++i) {
                x[k + (size_t)j] -= l[(size_t)i * tall + k + (size_t)j] * x[k + (size_t)i];
            }
        }
        const double a = x[k], b = wide > 1 ? x[k + 1] : 0, c = wide > 2 ? x[k + 2] : 0;
        const double d = wide > 3 ? x[k + 3] : 0;
        const double *l1 = l + (wide > 1 ? tall : 0), *l2 = l + (wide > 2 ? 2 * tall : 0);
        const double *l3 = l + (wide > 3 ? 3 * tall : 0);
        for (size_t i = k + 4; i < tall; i += PART) {
            put(x + i,
                at(x + i) - at(l + i) * a - at(l1 + i) * b - at(l2 + i) * c - at(l3 + i) * d);
        }
    }
}

// Of numbers that go on by four: those of the first and the second, of the third and the fourth, of both.
WIDE_INLINE double all_of(const part *sum)
{
    double v[4];
    memcpy(v, sum, sizeof v);
    return (v[0] + v[1]) + (v[2] + v[3]);
}

static void pull(const double *panel, uint32_t width, uint32_t below, double *x)
{
    const size_t tall = FOUR(width) + FOUR(below);
    for (size_t k = FOUR(width); k > 0;) {
        k -= 4;
        const int wide = width - k < 4 ? (int)(width - k) : 4;
        const double *l = panel + k * tall;
        const double *l1 = l + (wide > 1 ? tall : 0), *l2 = l + (wide > 2 ? 2 * tall : 0);
        const double *l3 = l + (wide > 3 ? 3 * tall : 0);
        part a[4 / PART] = { 0 }, b[4 / PART] = { 0 }, c[4 / PART] = { 0 }, d[4 / PART] = { 0 };
        for (size_t i = k + 4; i < tall; i += 4) {
            for (size_t p = 0; p < 4 / PART; ++p) {
                const size_t row = i + PART * p;
                const part of = at(x + row);
                a[p] += at(l + row) * of, b[p] += at(l1 + row) * of;
                c[p] += at(l2 + row) * of, d[p] += at(l3 + row) * of;
            }
        }
        const double sums[4] = { all_of(a), all_of(b), all_of(c), all_of(d) };
        for (int j = wide; j-- > 0;) {
            double sum = sums[j];
            for (int i = j + 1; i < wide; ++i) {
                sum += l[(size_t)j * tall + k + (size_t)i] * x[k + (size_t)i];
            }
            x[k + (size_t)j] -= sum;
        }
    }
}

const pl_soft_kernels *PL_WIDE_NAME(pl_soft_kernels)(void)
{
    static const pl_soft_kernels all = { clear, add, factor, push, pull };
    return &all;
}
