// carry.c - what air carries along: its own velocity, smoke and heat, by fluxes through faces.
//
// A cell loses what its neighbour gets, so smoke is kept to rounding. What goes through a face is the value on its upwind
// side with two slopes, (b + 2 a) / 6 with a the slope behind and b the one across: of third order where it is smooth
// (van Leer's kappa = 1/3). Of smoke and heat it is limited (Koren 1993), so that none is below 0, or above what there was;
// velocities have no limit, which would flatten their peaks. Time by Heun's method, in as many parts as keep what leaves a
// cell below half of what is in it: of second order, stable at any speed.
//
// A cell that solids cut has the room that is left, and at least as much as its faces are open, or it would be emptied
// in no time. Where moving solids fill it, what is in it stays as thick. Cells of velocities are those of
// faces, half of each cell beside; they take from the fluxes what these leave behind, so that even flow stays even.
//
// Reads: velocities, openness. Writes: what is carried. Cost: O(cells x parts): 2 x 4 faces a cell.
#include "air/air.h"

#include <math.h>
#include <string.h>

#define MOST_LEAVES 0.5 // of what is in a cell, in a part
#define MOST_PARTS  64
#define LEAST       16 // lines that are worth a thread
#define HALF        ((near_real)0.5)
#define SIXTH       ((near_real)(1.0 / 6))

//---- ghosts --------------------------------------------------------------------------------------

typedef struct span {
    int32_t columns, lines; // of what there is from (0, 0)
} span;

// What lies beyond sides, of values: those at the opposite side; `in`, where air blows in, else the nearest.
typedef struct outside {
    bool periodic_x, periodic_y;
    near_real left, right, bottom, top; // where the flux there comes in
    bool gives[4];                      // else the nearest
} outside;

static void fill_line(const pl_air_scratch *s, near_real *q, span n, int32_t j, const outside *o)
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

static void fill_ghosts(const pl_air_scratch *s, near_real *q, span n, const outside *o)
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

// What blows in has the velocity that it has outside.
static outside outside_of_velocity(const plumb_air_desc *d, near_real flow)
{
    outside o = outside_of(d);
    o.left = o.right = o.bottom = o.top = flow;
    o.gives[0] = d->left == PLUMB_AIR_FLOW;
    o.gives[1] = d->right == PLUMB_AIR_FLOW;
    o.gives[2] = d->bottom == PLUMB_AIR_FLOW;
    o.gives[3] = d->top == PLUMB_AIR_FLOW;
    return o;
}

//---- room and fluxes -----------------------------------------------------------------------------

static near_real most_of(near_real a, near_real b)
{
    return a > b ? a : b;
}

void pl_air_find_room(pl_air_scratch *s, const plumb_air_desc *d)
{
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
            s->room[k] = s->filled[k] = 0;
            if (!inside || g->row[c] == 0) {
                continue;
            }
            const uint32_t right = g->right[c], up = g->up[c];
            const near_real open = most_of(most_of(g->open_u[c], g->open_u[right]),
                                           most_of(g->open_v[c], g->open_v[up]));
            s->room[k] = most_of(1 - g->cover[c], open);
            // Sides do not fill cells: they let air in and out.
            s->filled[k] = (i + 1 < nx || wraps_x ? g->solid_u[right] : 0) -
                           (i > 0 || wraps_x ? g->solid_u[c] : 0) +
                           (j + 1 < ny || wraps_y ? g->solid_v[up] : 0) -
                           (j > 0 || wraps_y ? g->solid_v[c] : 0);
        }
    }
    const outside nearest = outside_of(d);
    fill_ghosts(s, s->room, (span){ nx, ny }, &nearest);
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
    fill_ghosts(s, s->flux_u, (span){ nx + 1, ny }, &nearest);
    fill_ghosts(s, s->flux_v, (span){ nx, ny + 1 }, &nearest);
}

//---- one part ------------------------------------------------------------------------------------

// What is carried: its values, where fluxes go through the sides of its cells, and what is to be had of them.
typedef struct load {
    pl_air_scratch *s;
    span n;
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

// The value that goes through the lower side of k across `way`, whose flux is f.
static inline near_real through(const near_real *q, size_t k, ptrdiff_t way, near_real f)
{
    const near_real *at = q + k;
    return f > 0 ? smooth(at[-2 * way], at[-way], at[0]) : smooth(at[way], at[0], at[-way]);
}

// Of smoke: nothing is known behind a wall.
static inline near_real through_limited(const near_real *q, const near_real *flux, size_t k,
                                        ptrdiff_t way)
{
    const near_real *at = q + k, *f = flux + k;
    return f[0] > 0 ? limited(f[-way] != 0 ? at[-2 * way] : at[-way], at[-way], at[0])
                    : limited(f[way] != 0 ? at[way] : at[0], at[0], at[-way]);
}

static void carry_velocity_line(const load *l, int32_t j)
{
    const pl_air_scratch *s = l->s;
    const ptrdiff_t up = (ptrdiff_t)s->stride;
    const near_real *q = l->from, *fx = s->across_x, *fy = s->across_y;
    for (int32_t i = 0; i < l->n.columns; ++i) {
        const size_t k = pl_air_at(s, i, j), above = k + s->stride;
        const near_real sum = fx[k + 1] - fx[k] + fy[above] - fy[k];
        const near_real out =
            fx[k + 1] * through(q, k + 1, 1, fx[k + 1]) - fx[k] * through(q, k, 1, fx[k]) +
            fy[above] * through(q, above, up, fy[above]) - fy[k] * through(q, k, up, fy[k]);
        const near_real more = l->step * s->share[k] * (q[k] * sum - out);
        l->to[k] = q[k] + (l->moves[k] > 0 ? more : 0);
    }
}

static void carry_scalar_line(const load *l, int32_t j)
{
    const pl_air_scratch *s = l->s;
    const ptrdiff_t up = (ptrdiff_t)s->stride;
    const near_real *q = l->from, *fx = s->flux_u, *fy = s->flux_v;
    for (int32_t i = 0; i < l->n.columns; ++i) {
        const size_t k = pl_air_at(s, i, j), above = k + s->stride;
        const near_real out =
            fx[k + 1] * through_limited(q, fx, k + 1, 1) - fx[k] * through_limited(q, fx, k, 1) +
            fy[above] * through_limited(q, fy, above, up) - fy[k] * through_limited(q, fy, k, up);
        l->to[k] = q[k] - l->step * s->share[k] * (out + q[k] * s->filled[k]);
    }
}

static void carry_lines(void *context, uint32_t first, uint32_t count)
{
    const load *l = context;
    for (int32_t j = (int32_t)first; j < (int32_t)(first + count); ++j) {
        if (l->limited) {
            carry_scalar_line(l, j);
        } else {
            carry_velocity_line(l, j);
        }
    }
}

static void add_halves(const pl_air_scratch *s, near_real *q, const near_real *later, span n)
{
    for (int32_t j = 0; j < n.lines; ++j) {
        const size_t line = pl_air_at(s, 0, j);
        for (size_t k = line; k < line + (size_t)n.columns; ++k) {
            q[k] = HALF * (q[k] + later[k]);
        }
    }
}

// Heun: the mean of what was, and of two parts further on.
static void carry(load l, near_real *q, const outside *o, pl_tasks *tasks, int parts)
{
    pl_air_scratch *s = l.s;
    for (int part = 0; part < parts; ++part) {
        fill_ghosts(s, q, l.n, o);
        l.from = q;
        l.to = s->first;
        pl_tasks_ranges(tasks, (uint32_t)l.n.lines, LEAST, carry_lines, &l);
        fill_ghosts(s, s->first, l.n, o);
        l.from = s->first;
        l.to = s->second;
        pl_tasks_ranges(tasks, (uint32_t)l.n.lines, LEAST, carry_lines, &l);
        add_halves(s, q, s->second, l.n);
    }
}

//---- all of it -----------------------------------------------------------------------------------

static near_real positive(near_real x)
{
    return x > 0 ? x : 0;
}

// The largest share of a cell that leaves it in a second, times h.
static double fastest(const pl_air_scratch *s)
{
    near_real most = 0;
    for (int32_t j = 0; j < s->columns_y; ++j) {
        for (int32_t i = 0; i < s->columns_x; ++i) {
            const size_t k = pl_air_at(s, i, j), above = k + s->stride;
            const near_real out = positive(s->flux_u[k + 1]) + positive(-s->flux_u[k]) +
                                  positive(s->flux_v[above]) + positive(-s->flux_v[k]);
            const near_real share = s->room[k] > 0 ? out / s->room[k] : 0;
            most = share > most ? share : most;
        }
    }
    return (double)most;
}

// In how many parts, and how far one goes [s/m]: not as far as all, beyond what so many parts can bear.
typedef struct stride {
    int parts;
    near_real step;
} stride;

static stride stride_of(const pl_air_scratch *s, double dt, double h)
{
    const double speed = fastest(s), parts = speed * dt / h / MOST_LEAVES;
    if (parts > MOST_PARTS) {
        return (stride){ MOST_PARTS, (near_real)(MOST_LEAVES / speed) };
    }
    const int count = (int)ceil(parts);
    return (stride){ count, (near_real)(count > 0 ? dt / h / count : 0) };
}

// Fluxes through the sides of the cells of faces, and their room.
static void find_across(pl_air_scratch *s, span n, bool upright)
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

void pl_air_carry_velocities(pl_air_scratch *s, const plumb_air_desc *d, pl_tasks *tasks, double dt,
                             double h)
{
    const stride way = stride_of(s, dt, h);
    if (way.parts == 0) {
        return;
    }
    load l = { .s = s, .step = way.step };
    outside o = outside_of_velocity(d, (near_real)d->flow.x);
    l.n = (span){ s->columns_x + 1, s->columns_y };
    l.moves = s->open_u;
    find_across(s, l.n, false);
    carry(l, s->u, &o, tasks, way.parts);
    o = outside_of_velocity(d, (near_real)d->flow.y);
    l.n = (span){ s->columns_x, s->columns_y + 1 };
    l.moves = s->open_v;
    find_across(s, l.n, true);
    carry(l, s->v, &o, tasks, way.parts);
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
    const stride way = stride_of(s, dt, h);
    const outside o = outside_of_scalars(d);
    near_real *const all[] = { s->smoke, s->heat };
    const span n = { s->columns_x, s->columns_y };
    if (way.parts == 0) {
        return;
    }
    for (int32_t j = 0; j < n.lines; ++j) {
        for (int32_t i = 0; i < n.columns; ++i) {
            const size_t k = pl_air_at(s, i, j);
            s->share[k] = s->room[k] > 0 ? 1 / s->room[k] : 0;
        }
    }
    for (int i = 0; i < 2; ++i) {
        if (!is_all_zero(s, all[i])) {
            const load l = { .s = s, .n = n, .step = way.step, .limited = true };
            carry(l, all[i], &o, tasks, way.parts);
        }
    }
}
