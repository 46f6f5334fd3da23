// carry.c - what air carries along: its own velocity, smoke and heat, by fluxes through faces.
//
// A cell loses what its neighbour gets, so smoke is kept to rounding. What goes through a face is the value on its upwind
// side with two slopes, (b + 2 a) / 6 with a the slope behind and b the one across: of third order where it is smooth
// (van Leer's kappa = 1/3). Of smoke and heat it is limited (Koren 1993), so that none is below 0, or above what there was;
// velocities have no limit, which would flatten their peaks. Time by Heun's method, in as many parts as keep what leaves a
// cell in one well below what is in it: of second order, stable at any speed.
//
// A cell that solids cut has the room that is left, and at least as much as its faces are open, or it would be emptied
// in no time. Where moving solids fill it, what is in it stays as thick. Cells of velocities are those of
// faces, half of each cell beside; they take from the fluxes what these leave behind, so that even flow stays even.
//
// Reads: velocities, openness. Writes: what is carried. Cost: O(cells x parts).
#include "air/air.h"

#include <math.h>
#include <string.h>

#define MOST_MOVES  0.75 // of a cell, in a part, by velocities: beyond 0.87 it would not be stable
#define MOST_LEAVES 0.5  // likewise of smoke: beyond that there might be less than none
#define MOST_PARTS  64
#define LEAST       16 // lines that are worth a thread
#define HALF        ((near_real)0.5)
#define SIXTH       ((near_real)(1.0 / 6))

//---- ghosts --------------------------------------------------------------------------------------

typedef struct area {
    int32_t columns, lines; // of what there is from (0, 0)
} area;

// What lies beyond sides, of values: those at the opposite side; `in`, where air blows in, else the nearest.
typedef struct outside {
    bool periodic_x, periodic_y;
    near_real left, right, bottom, top; // where the flux there comes in
    bool gives[4];                      // else the nearest
} outside;

static void fill_line(const pl_air_scratch *s, near_real *q, area n, int32_t j, const outside *o)
{
    const size_t at = pl_air_at(s, 0, j);
    near_real *line = q + at;
    const int32_t period = s->columns_x;
    const bool from_left = o->gives[0] && s->flux_u[at] > 0;
    const bool from_right = o->gives[1] && s->flux_u[at + (size_t)period] < 0;
    for (int32_t i = -PL_AIR_GHOSTS; i < 0; ++i) {
        line[i] = o->periodic_x ? line[period + i] : from_left ? o->left : line[0];
    }
    // The last face of a periodic line is the first.
    for (int32_t i = o->periodic_x ? period : n.columns; i <= period + PL_AIR_GHOSTS; ++i) {
        line[i] = o->periodic_x ? line[i - period] : from_right ? o->right : line[n.columns - 1];
    }
}

// A line of ghosts from another line, or where the flux goes as `sign` says, a value.
static void copy_line(const pl_air_scratch *s, near_real *q, int32_t to, int32_t from,
                      const near_real *flux, near_real sign, near_real value)
{
    near_real *line = q + pl_air_at(s, 0, to);
    const near_real *other = q + pl_air_at(s, 0, from);
    for (int32_t i = -PL_AIR_GHOSTS; i <= s->columns_x + PL_AIR_GHOSTS; ++i) {
        const int32_t f = i < 0 ? 0 : i < s->columns_x ? i : s->columns_x - 1;
        line[i] = sign * flux[f] > 0 ? value : other[i];
    }
}

static void fill_ghosts(const pl_air_scratch *s, near_real *q, area n, const outside *o)
{
    const int32_t period = s->columns_y;
    const near_real *low = s->flux_v + pl_air_at(s, 0, 0);
    const near_real *high = s->flux_v + pl_air_at(s, 0, period);
    for (int32_t j = 0; j < n.lines; ++j) {
        fill_line(s, q, n, j, o);
    }
    for (int32_t j = -PL_AIR_GHOSTS; j < 0; ++j) {
        copy_line(s, q, j, o->periodic_y ? period + j : 0, low, o->gives[2], o->bottom);
    }
    for (int32_t j = o->periodic_y ? period : n.lines; j <= period + PL_AIR_GHOSTS; ++j) {
        copy_line(s, q, j, o->periodic_y ? j - period : n.lines - 1, high, -(near_real)o->gives[3],
                  o->top);
    }
}

static outside outside_of(const plumb_air_desc *d)
{
    return (outside){ .periodic_x = d->left == PLUMB_AIR_PERIODIC,
                      .periodic_y = d->bottom == PLUMB_AIR_PERIODIC };
}

// Nothing is carried in from outside.
static outside outside_of_scalars(const plumb_air_desc *d)
{
    outside o = outside_of(d);
    o.gives[0] = o.gives[1] = !o.periodic_x;
    o.gives[2] = o.gives[3] = !o.periodic_y;
    return o;
}

// What blows in has the velocity that it has outside, what comes in at an open side none: so it is sucked in by half the square
// of its speed, as Bernoulli says, and brings no energy.
static outside outside_of_velocity(const plumb_air_desc *d, near_real flow)
{
    outside o = outside_of_scalars(d);
    o.left = d->left == PLUMB_AIR_FLOW ? flow : 0;
    o.right = d->right == PLUMB_AIR_FLOW ? flow : 0;
    o.bottom = d->bottom == PLUMB_AIR_FLOW ? flow : 0;
    o.top = d->top == PLUMB_AIR_FLOW ? flow : 0;
    return o;
}

//---- room and fluxes -----------------------------------------------------------------------------

static near_real most_of(near_real a, near_real b)
{
    return a > b ? a : b;
}

#define FILLED                                                                                     \
    ((near_real)-1) // in place of room before: now, which none that is filled in this round may see

// Of what is beside it, weighed by the faces between.
typedef struct beside {
    near_real open, smoke, heat;
} beside;

static void add_to(beside *sum, const pl_air_scratch *s, size_t from, near_real open)
{
    if (s->first[from] > 0) {
        sum->open += open;
        sum->smoke += open * s->smoke[from];
        sum->heat += open * s->heat[from];
    }
}

// Fills cells that solids have left where they lie beside others. How many are left over; `any`: whether one was filled.
static uint32_t fill_ring(pl_air_scratch *s, bool *any)
{
    const size_t way = s->stride;
    uint32_t left = 0;
    *any = false;
    for (int32_t j = 0; j < s->columns_y; ++j) {
        for (int32_t i = 0; i < s->columns_x; ++i) {
            const size_t k = pl_air_at(s, i, j);
            if (s->room[k] == 0 || s->first[k] != 0) {
                continue;
            }
            beside sum = { 0, 0, 0 };
            add_to(&sum, s, k - 1, s->open_u[k]);
            add_to(&sum, s, k + 1, s->open_u[k + 1]);
            add_to(&sum, s, k - way, s->open_v[k]);
            add_to(&sum, s, k + way, s->open_v[k + way]);
            if (sum.open > 0) {
                s->smoke[k] = sum.smoke / sum.open;
                s->heat[k] = sum.heat / sum.open;
                s->first[k] = FILLED;
                *any = true;
            } else {
                ++left;
            }
        }
    }
    return left;
}

static void know_filled(pl_air_scratch *s)
{
    for (int32_t j = 0; j < s->columns_y; ++j) {
        const size_t line = pl_air_at(s, 0, j);
        for (size_t k = line; k < line + (size_t)s->columns_x; ++k) {
            s->first[k] = s->first[k] == FILLED ? 1 : s->first[k];
        }
    }
}

// What solids have left is filled with what flowed in behind them, while it had no cell to go into: from its rim inwards.
// `first`: room before.
static void fill_left(pl_air_scratch *s, const outside *nearest)
{
    const area n = { s->columns_x, s->columns_y };
    bool any = true;
    for (uint32_t left = 1; left > 0 && any;) {
        fill_ghosts(s, s->first, n, nearest);
        fill_ghosts(s, s->smoke, n, nearest);
        fill_ghosts(s, s->heat, n, nearest);
        left = fill_ring(s, &any);
        if (left > 0 && any) {
            know_filled(s);
        }
    }
}

void pl_air_find_room(pl_air_scratch *s, const plumb_air_desc *d)
{
    memcpy(s->first, s->room, pl_air_column_bytes(s));
    const pl_liquid_grid *g = &s->liquid.grid;
    const int32_t nx = s->columns_x, ny = s->columns_y;
    const bool wraps_x = d->left == PLUMB_AIR_PERIODIC, wraps_y = d->bottom == PLUMB_AIR_PERIODIC;
    for (int32_t j = 0; j <= ny; ++j) {
        for (int32_t i = 0; i <= nx; ++i) {
            const int32_t x = wraps_x && i == nx ? 0 : i, y = wraps_y && j == ny ? 0 : j;
            const uint32_t c = pl_liquid_cell_at(g, s->low_x + x, s->low_y + y);
            const size_t k = pl_air_at(s, i, j);
            const bool inside = i < nx && j < ny;
            s->open_u[k] = j < ny ? g->open_u[c] : 0;
            s->open_v[k] = i < nx ? g->open_v[c] : 0;
            s->room[k] = 0;
            if (!inside || g->row[c] == 0) {
                s->smoke[k] = s->heat[k] = 0;
                continue;
            }
            const uint32_t right = g->right[c], up = g->up[c];
            const near_real open = most_of(most_of(g->open_u[c], g->open_u[right]),
                                           most_of(g->open_v[c], g->open_v[up]));
            s->room[k] = most_of(1 - g->cover[c], open);
        }
    }
    const outside nearest = outside_of(d);
    fill_left(s, &nearest);
    fill_ghosts(s, s->room, (area){ nx, ny }, &nearest);
}

// Sides do not fill cells: they let air in and out.
void pl_air_find_filled(pl_air_scratch *s, const plumb_air_desc *d)
{
    const pl_liquid_grid *g = &s->liquid.grid;
    const int32_t nx = s->columns_x, ny = s->columns_y;
    const bool wraps_x = d->left == PLUMB_AIR_PERIODIC, wraps_y = d->bottom == PLUMB_AIR_PERIODIC;
    for (int32_t j = 0; j < ny; ++j) {
        for (int32_t i = 0; i < nx; ++i) {
            const uint32_t c = pl_liquid_cell_at(g, s->low_x + i, s->low_y + j);
            const uint32_t right = g->right[c], up = g->up[c];
            s->filled[pl_air_at(s, i, j)] = (i + 1 < nx || wraps_x ? g->solid_u[right] : 0) -
                                            (i > 0 || wraps_x ? g->solid_u[c] : 0) +
                                            (j + 1 < ny || wraps_y ? g->solid_v[up] : 0) -
                                            (j > 0 || wraps_y ? g->solid_v[c] : 0);
        }
    }
}

void pl_air_find_fluxes(pl_air_scratch *s, const plumb_air_desc *d)
{
    const int32_t nx = s->columns_x, ny = s->columns_y;
    for (int32_t j = 0; j <= ny; ++j) {
        for (int32_t i = 0; i <= nx; ++i) {
            const size_t k = pl_air_at(s, i, j);
            s->flux_u[k] = s->open_u[k] * s->u[k];
            s->flux_v[k] = s->open_v[k] * s->v[k];
        }
        if (j < ny) {
            const size_t left = pl_air_at(s, 0, j), right = pl_air_at(s, nx, j);
            s->flux_u[left] = d->left == PLUMB_AIR_FLOW ? (near_real)d->flow.x : s->flux_u[left];
            s->flux_u[right] = d->right == PLUMB_AIR_FLOW ? (near_real)d->flow.x : s->flux_u[right];
        }
    }
    for (int32_t i = 0; i < nx; ++i) {
        const size_t low = pl_air_at(s, i, 0), high = pl_air_at(s, i, ny);
        s->flux_v[low] = d->bottom == PLUMB_AIR_FLOW ? (near_real)d->flow.y : s->flux_v[low];
        s->flux_v[high] = d->top == PLUMB_AIR_FLOW ? (near_real)d->flow.y : s->flux_v[high];
    }
    const outside nearest = outside_of(d);
    fill_ghosts(s, s->flux_u, (area){ nx + 1, ny }, &nearest);
    fill_ghosts(s, s->flux_v, (area){ nx, ny + 1 }, &nearest);
}

//---- one part ------------------------------------------------------------------------------------

// What is carried: its values, where fluxes go through the sides of its cells, and what is to be had of them.
typedef struct load {
    pl_air_scratch *s;
    area n;
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

static void add_halves(const pl_air_scratch *s, near_real *q, const near_real *later, area n)
{
    for (int32_t j = 0; j < n.lines; ++j) {
        const size_t line = pl_air_at(s, 0, j);
        for (size_t k = line; k < line + (size_t)n.columns; ++k) {
            q[k] = HALF * (q[k] + later[k]);
        }
    }
}

static void go_on(load *l, near_real *from, near_real *to, const outside *o, pl_tasks *tasks)
{
    fill_ghosts(l->s, from, l->n, o);
    l->from = from;
    l->to = to;
    pl_tasks_ranges(tasks, (uint32_t)l->n.lines + 1, LEAST, flow_lines, l);
    pl_tasks_ranges(tasks, (uint32_t)l->n.lines, LEAST, move_lines, l);
}

// Heun: the mean of what was, and of two parts further on.
static void carry(load l, near_real *q, const outside *o, pl_tasks *tasks, int parts)
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
static void find_across(pl_air_scratch *s, area n, bool upright)
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
static stride stride_of_velocities(const pl_air_scratch *s, area n, double dt, double h)
{
    near_real most = 0;
    for (int32_t j = 0; j < n.lines; ++j) {
        for (int32_t i = 0; i < n.columns; ++i) {
            const size_t k = pl_air_at(s, i, j);
            const exchange e = exchange_of(s->across_x, s->across_y, k, s->stride);
            most = most_of(most, s->share[k] * most_of(e.in, e.out));
        }
    }
    return stride_of((double)most, dt, h, MOST_MOVES);
}

// Velocities of upright faces, or of the others.
static void carry_velocities(pl_air_scratch *s, const plumb_air_desc *d, pl_tasks *tasks, double dt,
                             double h, bool upright)
{
    const area n = { s->columns_x + !upright, s->columns_y + upright };
    const outside o = outside_of_velocity(d, (near_real)(upright ? d->flow.y : d->flow.x));
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

static stride stride_of_scalars(const pl_air_scratch *s, area n, double dt, double h)
{
    near_real most = 0;
    for (int32_t j = 0; j < n.lines; ++j) {
        for (int32_t i = 0; i < n.columns; ++i) {
            const size_t k = pl_air_at(s, i, j);
            most = most_of(most, s->share[k] * exchange_of(s->flux_u, s->flux_v, k, s->stride).out);
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
    const outside o = outside_of_scalars(d);
    near_real *const all[] = { s->smoke, s->heat };
    const area n = { s->columns_x, s->columns_y };
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
