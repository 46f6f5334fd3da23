// carry.c - what air carries along: its own velocity, smoke and heat, by fluxes through faces.
//
// A cell loses what its neighbour gets, so smoke is kept to rounding. What goes through a face is the value on its upwind
// side with two slopes, (b + 2 a) / 6 with a the slope behind and b the one across: of third order where it is smooth
// (van Leer's kappa = 1/3). Of smoke and heat it is limited (Koren 1993), so that none is below 0, or above what there was;
// velocities have no limit, which would flatten their peaks. Time by Heun's method, in as many parts as keep what leaves a
// cell in one well below what is in it: of second order, stable at any speed.
//
// Where moving solids fill a cell, what is in it stays as thick (room.c). Cells of velocities are those of
// faces, half of each cell beside; they take from the fluxes what these leave behind, so that even flow stays even.
//
// Reads: velocities, openness. Writes: what is carried. Cost: O(cells x parts).
#include "air/air.h"

#include <math.h>

#define MOST_MOVES  0.75 // of a cell, in a part, by velocities: beyond 0.87 it would not be stable
#define MOST_LEAVES 0.5  // likewise of smoke: beyond that there might be less than none
#define MOST_PARTS  64
#define LEAST       16 // lines that are worth a thread
#define HALF        ((near_real)0.5)
#define SIXTH       ((near_real)(1.0 / 6))

//---- one part ------------------------------------------------------------------------------------

// What is carried: its values, where fluxes go through the sides of its cells, and what is to be had of them.
typedef struct load {
    pl_air_scratch *s;
    pl_air_area n;
    const near_real *flux_x, *flux_y;
    const near_real *from;
    near_real *to;
    const near_real *moves; // 0: this one stays; NULL: all move
    near_real step;         // dt / h
    bool limited;           // smoke or heat
} load;

static inline near_real smooth(near_real behind, near_real here, near_real ahead)
{
    return here + SIXTH * (ahead - here + 2 * (here - behind));
}

static inline near_real limited(near_real behind, near_real here, near_real ahead)
{
    const near_real a = here - behind, b = ahead - here;
    const near_real size_a = a < 0 ? -a : a, size_b = b < 0 ? -b : b;
    const near_real least = size_a < size_b ? size_a : size_b;
    const near_real mean = SIXTH * (size_b + 2 * size_a);
    const near_real add = mean < least ? mean : least;
    return a * b > 0 ? here + (b < 0 ? -add : add) : here;
}

// The value that goes through the lower side of a cell across `way`, times its flux f.
static inline near_real through(const near_real *at, ptrdiff_t way, near_real f)
{
    const near_real up = smooth(at[-2 * way], at[-way], at[0]);
    const near_real down = smooth(at[way], at[0], at[-way]);
    return f * (f > 0 ? up : down);
}

// Of smoke: nothing is known behind a wall.
static inline near_real through_limited(const near_real *at, const near_real *f, ptrdiff_t way)
{
    const near_real up = limited(f[-way] != 0 ? at[-2 * way] : at[-way], at[-way], at[0]);
    const near_real down = limited(f[way] != 0 ? at[way] : at[0], at[0], at[-way]);
    return f[0] * (f[0] > 0 ? up : down);
}

// All that goes through the lower sides of cells and those at their left, the last of a line and of all lines too.
static void flow_lines(void *context, uint32_t first, uint32_t count)
{
    const load *l = context;
    const pl_air_scratch *s = l->s;
    const ptrdiff_t up = (ptrdiff_t)s->stride;
    const int32_t n = l->n.columns + 1;
    for (int32_t j = (int32_t)first; j < (int32_t)(first + count); ++j) {
        const size_t line = pl_air_at(s, 0, j);
        const near_real *q = l->from + line, *fx = l->flux_x + line, *fy = l->flux_y + line;
        near_real *restrict x = s->flow_x + line, *restrict y = s->flow_y + line;
        if (l->limited) {
            for (int32_t i = 0; i < n; ++i) {
                x[i] = through_limited(q + i, fx + i, 1);
            }
            for (int32_t i = 0; i < n; ++i) {
                y[i] = through_limited(q + i, fy + i, up);
            }
        } else {
            for (int32_t i = 0; i < n; ++i) {
                x[i] = through(q + i, 1, fx[i]);
            }
            for (int32_t i = 0; i < n; ++i) {
                y[i] = through(q + i, up, fy[i]);
            }
        }
    }
}

static void move_velocities(const load *l, size_t line)
{
    const pl_air_scratch *s = l->s;
    const size_t up = s->stride;
    const near_real *q = l->from + line, *fx = l->flux_x + line, *fy = l->flux_y + line;
    const near_real *x = s->flow_x + line, *y = s->flow_y + line, *share = s->share + line;
    const near_real *open = l->moves + line;
    near_real *restrict to = l->to + line;
    for (int32_t i = 0; i < l->n.columns; ++i) {
        const near_real sum = fx[i + 1] - fx[i] + fy[(size_t)i + up] - fy[i];
        const near_real out = x[i + 1] - x[i] + y[(size_t)i + up] - y[i];
        const near_real more = l->step * share[i] * (q[i] * sum - out);
        to[i] = q[i] + (open[i] > 0 ? more : 0);
    }
}

static void move_scalars(const load *l, size_t line)
{
    const pl_air_scratch *s = l->s;
    const size_t up = s->stride;
    const near_real *q = l->from + line, *x = s->flow_x + line, *y = s->flow_y + line;
    const near_real *share = s->share + line, *filled = s->filled + line;
    near_real *restrict to = l->to + line;
    for (int32_t i = 0; i < l->n.columns; ++i) {
        const near_real out = x[i + 1] - x[i] + y[(size_t)i + up] - y[i];
        to[i] = q[i] - l->step * share[i] * (out + q[i] * filled[i]);
    }
}

static void move_lines(void *context, uint32_t first, uint32_t count)
{
    const load *l = context;
    for (int32_t j = (int32_t)first; j < (int32_t)(first + count); ++j) {
        if (l->limited) {
            move_scalars(l, pl_air_at(l->s, 0, j));
        } else {
            move_velocities(l, pl_air_at(l->s, 0, j));
        }
    }
}

static void add_halves(const pl_air_scratch *s, near_real *q, const near_real *later, pl_air_area n)
{
    for (int32_t j = 0; j < n.lines; ++j) {
        const size_t line = pl_air_at(s, 0, j);
        for (size_t k = line; k < line + (size_t)n.columns; ++k) {
            q[k] = HALF * (q[k] + later[k]);
        }
    }
}

static void go_on(load *l, near_real *from, near_real *to, const pl_air_outside *o, pl_tasks *tasks)
{
    pl_air_fill_ghosts(l->s, from, l->n, o);
    l->from = from;
    l->to = to;
    pl_tasks_ranges(tasks, (uint32_t)l->n.lines + 1, LEAST, flow_lines, l);
    pl_tasks_ranges(tasks, (uint32_t)l->n.lines, LEAST, move_lines, l);
}

// Heun: the mean of what was, and of two parts further on.
static void carry(load l, near_real *q, const pl_air_outside *o, pl_tasks *tasks, int parts)
{
    for (int part = 0; part < parts; ++part) {
        go_on(&l, q, l.s->first, o, tasks);
        go_on(&l, l.s->first, l.s->second, o, tasks);
        add_halves(l.s, q, l.s->second, l.n);
    }
}

//---- all of it -----------------------------------------------------------------------------------

static near_real positive(near_real x)
{
    return x > 0 ? x : 0;
}

// How much goes into a cell, and out of it.
typedef struct exchange {
    near_real in, out;
} exchange;

static exchange exchange_of(const near_real *x, const near_real *y, size_t k, size_t up)
{
    return (exchange){
        positive(x[k]) + positive(-x[k + 1]) + positive(y[k]) + positive(-y[k + up]),
        positive(x[k + 1]) + positive(-x[k]) + positive(y[k + up]) + positive(-y[k]),
    };
}

// In how many parts, and how far one goes [s/m]: not as far as all, beyond what so many parts can bear.
typedef struct stride {
    int parts;
    near_real step;
} stride;

// `fastest`: the largest share of a cell that is exchanged in a second, times h.
static stride stride_of(double fastest, double dt, double h, double most)
{
    const double parts = fastest * dt / h / most;
    if (parts > MOST_PARTS) {
        return (stride){ MOST_PARTS, (near_real)(most / fastest) };
    }
    const int count = (int)ceil(parts);
    return (stride){ count, (near_real)(count > 0 ? dt / h / count : 0) };
}

// Fluxes through the sides of the cells of faces, and their room.
static void find_across(pl_air_scratch *s, pl_air_area n, bool upright)
{
    const size_t way = upright ? s->stride : 1;
    for (int32_t j = 0; j <= n.lines; ++j) {
        for (int32_t i = 0; i <= n.columns; ++i) {
            const size_t k = pl_air_at(s, i, j);
            const near_real room = s->room[k - way] + s->room[k];
            s->across_x[k] = HALF * (s->flux_u[k - way] + s->flux_u[k]);
            s->across_y[k] = HALF * (s->flux_v[k - way] + s->flux_v[k]);
            s->share[k] = room > 0 ? 2 / room : 0;
        }
    }
}

// What comes in counts as well: where solids make room nothing goes out, and a velocity that is replaced more than once in a part
// would swing ever wider.
static stride stride_of_velocities(const pl_air_scratch *s, pl_air_area n, double dt, double h)
{
    near_real most = 0;
    for (int32_t j = 0; j < n.lines; ++j) {
        for (int32_t i = 0; i < n.columns; ++i) {
            const size_t k = pl_air_at(s, i, j);
            const exchange e = exchange_of(s->across_x, s->across_y, k, s->stride);
            most = pl_air_most_of(most, s->share[k] * pl_air_most_of(e.in, e.out));
        }
    }
    return stride_of((double)most, dt, h, MOST_MOVES);
}

// Velocities of upright faces, or of the others.
static void carry_velocities(pl_air_scratch *s, const plumb_air_desc *d, pl_tasks *tasks, double dt,
                             double h, bool upright)
{
    const pl_air_area n = { s->columns_x + !upright, s->columns_y + upright };
    const pl_air_outside o =
        pl_air_outside_of_velocity(d, (near_real)(upright ? d->flow.y : d->flow.x));
    find_across(s, n, upright);
    const stride way = stride_of_velocities(s, n, dt, h);
    const load l = { .s = s,
                     .n = n,
                     .flux_x = s->across_x,
                     .flux_y = s->across_y,
                     .moves = upright ? s->open_v : s->open_u,
                     .step = way.step };
    carry(l, upright ? s->v : s->u, &o, tasks, way.parts);
}

void pl_air_carry_velocities(pl_air_scratch *s, const plumb_air_desc *d, pl_tasks *tasks, double dt,
                             double h)
{
    carry_velocities(s, d, tasks, dt, h, false);
    carry_velocities(s, d, tasks, dt, h, true);
}

static stride stride_of_scalars(const pl_air_scratch *s, pl_air_area n, double dt, double h)
{
    near_real most = 0;
    for (int32_t j = 0; j < n.lines; ++j) {
        for (int32_t i = 0; i < n.columns; ++i) {
            const size_t k = pl_air_at(s, i, j);
            most = pl_air_most_of(most, s->share[k] *
                                            exchange_of(s->flux_u, s->flux_v, k, s->stride).out);
        }
    }
    return stride_of((double)most, dt, h, MOST_LEAVES);
}

static bool is_all_zero(const pl_air_scratch *s, const near_real *q)
{
    for (int32_t j = 0; j < s->columns_y; ++j) {
        const near_real *line = q + pl_air_at(s, 0, j);
        for (int32_t i = 0; i < s->columns_x; ++i) {
            if (line[i] != 0) {
                return false;
            }
        }
    }
    return true;
}

void pl_air_carry_scalars(pl_air_scratch *s, const plumb_air_desc *d, pl_tasks *tasks, double dt,
                          double h)
{
    const pl_air_outside o = pl_air_outside_of_scalars(d);
    near_real *const all[] = { s->smoke, s->heat };
    const pl_air_area n = { s->columns_x, s->columns_y };
    for (int32_t j = 0; j < n.lines; ++j) {
        for (int32_t i = 0; i < n.columns; ++i) {
            const size_t k = pl_air_at(s, i, j);
            s->share[k] = s->room[k] > 0 ? 1 / s->room[k] : 0;
        }
    }
    const stride way = stride_of_scalars(s, n, dt, h);
    for (int i = 0; i < 2; ++i) {
        if (!is_all_zero(s, all[i])) {
            const load l = { .s = s,
                             .n = n,
                             .flux_x = s->flux_u,
                             .flux_y = s->flux_v,
                             .step = way.step,
                             .limited = true };
            carry(l, all[i], &o, tasks, way.parts);
        }
    }
}
