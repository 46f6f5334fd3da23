// ghosts.c - what lies beyond the sides of the box, in the cells round it that kernels look at.
//
// Reads: fluxes through sides. Writes: ghosts of a column. Cost: O(cells at sides).
#include "air/air.h"

static void fill_line(const pl_air_scratch *s, near_real *q, pl_air_area n, int32_t j,
                      const pl_air_outside *o)
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

void pl_air_fill_ghosts(const pl_air_scratch *s, near_real *q, pl_air_area n,
                        const pl_air_outside *o)
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

pl_air_outside pl_air_outside_of(const plumb_air_desc *d)
{
    return (pl_air_outside){ .periodic_x = d->left == PLUMB_AIR_PERIODIC,
                             .periodic_y = d->bottom == PLUMB_AIR_PERIODIC };
}

pl_air_outside pl_air_outside_of_scalars(const plumb_air_desc *d)
{
    pl_air_outside o = pl_air_outside_of(d);
    o.gives[0] = o.gives[1] = !o.periodic_x;
    o.gives[2] = o.gives[3] = !o.periodic_y;
    return o;
}

pl_air_outside pl_air_outside_of_velocity(const plumb_air_desc *d, near_real flow)
{
    pl_air_outside o = pl_air_outside_of_scalars(d);
    o.left = d->left == PLUMB_AIR_FLOW ? flow : 0;
    o.right = d->right == PLUMB_AIR_FLOW ? flow : 0;
    o.bottom = d->bottom == PLUMB_AIR_FLOW ? flow : 0;
    o.top = d->top == PLUMB_AIR_FLOW ? flow : 0;
    return o;
}
