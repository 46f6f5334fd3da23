// phases.c - several liquids that do not mix: oil on water.
//
// All phases have one velocity at a place and one system of pressures, in which each face has the density of the particles
// round it: light = density of the first phase / density there, so that
//
//     u -= light (P - P_beside),   the row of a cell: sum a light (P - P_beside) = -(what flows out of it).
//
// What is of another phase within a cell cannot part by that: the cell has one velocity. There a particle is a drop as
// wide as the spacing d, in what lies ahead of it along gravity g or against it, and has the velocity at which its
// drag is its weight less its lift,
//
//     3/4 density v^2 / d + 18 viscosity v / d^2 = difference of densities * g
//
// (Stokes' drag of a sphere and one of C_D = 1; the drift flux of Ishii, Hibiki 2011). It goes on by that as by a
// displacement, and where it has nothing but its own phase ahead it stays.
//
// Reads: phases, particles, blends. Writes: the mixture. Cost: O(cells + points).
#include "liquid/liquid.h"

#include <math.h>

#define MOST_DRIFT 0.5 // [cells] a part of a step
// Of the range of densities: less than that ahead is the reach of a hat, not another phase.
#define OTHER 0.15

double pl_liquid_thickest(const pl_liquid *liquid)
{
    double most = (double)pl_liquid_desc(liquid)->viscosity;
    for (uint32_t i = 0; i < liquid->phase_count; ++i) {
        const double viscosity = (double)pl_liquid_phases(liquid)[i].viscosity;
        most = viscosity > most ? viscosity : most;
    }
    return most;
}

// Whether a particle is of another phase than the first, and that differs from it.
static bool is_mixed(const pl_liquid *liquid)
{
    const plumb_liquid_desc *d = pl_liquid_desc(liquid);
    const plumb_particle *p = pl_liquid_items(liquid);
    for (uint32_t i = 0; liquid->phase_count > 0 && i < liquid->count; ++i) {
        if (p[i].phase > 0) {
            const plumb_liquid_phase *phase = &pl_liquid_phases(liquid)[p[i].phase - 1];
            if (phase->density != d->density || phase->viscosity != d->viscosity ||
                phase->friction != d->friction) {
                return true;
            }
        }
    }
    return false;
}

static pl_liquid_kind kind_of(plumb_real density, plumb_real viscosity, double first, double most)
{
    return (pl_liquid_kind){ (near_real)((double)density / first),
                             most > 0 ? (near_real)((double)viscosity / most) : 0 };
}

void pl_liquid_find_mixture(const pl_liquid *liquid, plumb_vec2 gravity)
{
    pl_liquid_scratch *scratch = liquid->scratch;
    pl_liquid_mixture *m = &scratch->mixture;
    const plumb_liquid_desc *d = pl_liquid_desc(liquid);
    const double first = (double)d->density, thickest = pl_liquid_thickest(liquid);
    near_real low = 1, high = 1;
    scratch->grid.mixture = NULL;
    if (!is_mixed(liquid)) {
        return;
    }
    m->kinds[0] = kind_of(d->density, d->viscosity, first, thickest);
    for (uint32_t i = 0; i < liquid->phase_count; ++i) {
        const plumb_liquid_phase *phase = &pl_liquid_phases(liquid)[i];
        const pl_liquid_kind kind = kind_of(phase->density, phase->viscosity, first, thickest);
        m->kinds[1 + i] = kind;
        low = kind.mass < low ? kind.mass : low;
        high = kind.mass > high ? kind.mass : high;
    }
    m->other = OTHER * (double)(high - low);
    m->drag = thickest / first;
    m->fall_x = (double)gravity.x;
    m->fall_y = (double)gravity.y;
    scratch->grid.mixture = m;
}

bool pl_liquid_make_mixture(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_mixture *m = &scratch->mixture;
    const size_t cells = (size_t)scratch->grid.cell_count + 1;
    if (!pl_buffer_reserve(memory, &scratch->mixed, 4 * cells * sizeof(near_real))) {
        return false;
    }
    near_real *columns = scratch->mixed.data;
    m->light_u = columns, m->light_v = columns + cells;
    m->mass = columns + 2 * cells, m->thick = columns + 3 * cells;
    m->light_u[0] = m->light_v[0] = 1;
    m->mass[0] = m->thick[0] = 0;
    return true;
}

// Of a face that no particle is near: what is at its sides.
static near_real light_between(const pl_liquid_mixture *m, uint32_t a, uint32_t b)
{
    const int count = (m->mass[a] > 0) + (m->mass[b] > 0);
    return count > 0 ? (near_real)count / (m->mass[a] + m->mass[b]) : 1;
}

static void lighten_range(void *context, uint32_t first, uint32_t count)
{
    const pl_liquid_grid *g = context;
    const pl_liquid_mixture *m = g->mixture;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        m->light_u[c] = m->light_u[c] > 0 ? m->light_u[c] : light_between(m, g->left[c], c);
        m->light_v[c] = m->light_v[c] > 0 ? m->light_v[c] : light_between(m, g->down[c], c);
    }
}

void pl_liquid_lighten(pl_liquid_grid *g)
{
    pl_liquid_cells(g, lighten_range);
}

// The cell beside one, along gravity or against it.
static uint32_t ahead_of(const pl_liquid_grid *g, uint32_t c, bool rises)
{
    const pl_liquid_mixture *m = g->mixture;
    const bool upright = fabs(m->fall_y) >= fabs(m->fall_x);
    const bool up = ((upright ? m->fall_y : m->fall_x) < 0) == rises;
    return upright ? (up ? g->up[c] : g->down[c]) : (up ? g->right[c] : g->left[c]);
}

pl_liquid_place pl_liquid_drift(const pl_liquid_grid *g, uint32_t point, double way)
{
    const pl_liquid_mixture *m = g->mixture;
    const uint32_t c = g->points[point].cell;
    const double own = (double)m->kinds[m->phases[point]].mass, here = (double)m->mass[c];
    const bool rises = own < here;
    const uint32_t ahead = ahead_of(g, c, rises);
    const double there = (double)m->mass[ahead],
                 fall = sqrt(m->fall_x * m->fall_x + m->fall_y * m->fall_y);
    const double apart = (rises ? there - own : own - there) - m->other;
    if (own == here || !(there > 0) || !(apart > 0) || !(fall > 0)) {
        return (pl_liquid_place){ 0, 0 };
    }
    const double d = (double)g->h / 2;
    const double a = 0.75 * there / d, b = 18 * m->drag * (double)m->thick[ahead] / (d * d);
    const double pull = apart * fall;
    const double speed = 2 * pull / (b + sqrt(b * b + 4 * a * pull));
    const double cells = pl_liquid_held(way * speed, MOST_DRIFT) * (rises ? -1 : 1);
    return (pl_liquid_place){ cells * m->fall_x / fall, cells * m->fall_y / fall };
}
