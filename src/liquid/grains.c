// grains.c - granular phases: sand that rests in heaps, and flows where they are too steep.
//
// Grains bear a shear stress, as a solid does, until it is friction times the pressure between them; then they flow, and bear so
// much (Drucker, Prager 1952, without dilation). Each particle keeps what it bears, s. A part of a step adds what an elastic solid
// would bear of the rates of strain D at its end, and what is beyond the bound is left out:
//
//     s' = y (s + 2 G dt D),   y = min(1, friction P / |s + 2 G dt D|).
//
// With G = STIFF density h^2 / dt^2 elastic waves cross some cells a part, so a heap gives by a thousandth or so: for grains without
// end stiff. What particles bear acts on velocities first, so that a heap at rest has its pressures from the first projection; the
// rest is a viscosity of y STIFF a cell with a stress (y - 1) s beside, where y is found by iteration (viscosity.c).
//
// |s| is the larger of shear stresses in a plane: sqrt(((sxx - syy) / 2)^2 + sxy^2).
//
// Reads: particles, faces, pressures. Writes: the grains of the grid, what particles bear. Cost: O(cells + points).
#include "liquid/liquid.h"

#include <math.h>

// [cells] that lie on grains at the surface, of which pressures there know nothing: with 0 grains run on from the foot of a heap, with
// 0.5 a layer of five cells on a slope of 0.8 gets 0.38 of its speed in place of 0.55.
#define SURFACE 0.25

static double friction_of(const pl_liquid *liquid, uint32_t phase)
{
    return (double)(phase == 0 ? pl_liquid_desc(liquid)->friction
                               : pl_liquid_phases(liquid)[phase - 1].friction);
}

static bool is_granular(const pl_liquid *liquid)
{
    bool any = false;
    for (uint32_t i = 0; i <= liquid->phase_count; ++i) {
        any |= friction_of(liquid, i) > 0;
    }
    return any;
}

void pl_liquid_find_grains(pl_liquid *liquid)
{
    pl_liquid_scratch *scratch = liquid->scratch;
    pl_liquid_grains *grains = &scratch->grains;
    scratch->grid.grains = is_granular(liquid) ? grains : NULL;
    grains->particles = scratch->moved.data;
    for (uint32_t i = 0; i <= liquid->phase_count; ++i) {
        grains->friction[i] = friction_of(liquid, i);
    }
}

static uint32_t phase_at(const pl_liquid_grid *g, uint32_t point)
{
    return g->mixture != NULL ? g->mixture->phases[point] : 0;
}

//---- of cells ------------------------------------------------------------------------------------

static void gather_range(void *context, uint32_t first, uint32_t count)
{
    const pl_liquid_grid *g = context;
    const pl_liquid_grains *s = g->grains;
    const double scale = 1 / s->unit;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        double normal = 0, tangent = 0, friction = 0, share = 0;
        for (uint32_t k = g->first[c]; k < g->first[c + 1]; ++k) {
            const plumb_particle *p = &s->particles[g->points[k].index];
            const double own = s->friction[phase_at(g, k)];
            friction += own;
            share += own > 0;
            normal += own > 0 ? (double)p->shear[0] : 0;
            tangent += own > 0 ? (double)p->shear[1] : 0;
        }
        const double part = share > 0 ? 1.0 / (g->first[c + 1] - g->first[c]) : 0;
        s->normal[c] = (near_real)(part * scale * normal);
        s->tangent[c] = (near_real)(part * scale * tangent);
        s->bound[c] = (near_real)(part * friction);
        s->share[c] = (near_real)(part * share);
        s->pressure[c] = s->trial[c] = s->gain_normal[c] = s->gain_tangent[c] = 0;
        s->yield[c] = s->kept[c] = 1;
    }
}

// Cells with liquid that no particle is in, under what lies on grains, bear what those beside them do.
static void fill_range(void *context, uint32_t first, uint32_t count)
{
    const pl_liquid_grid *g = context;
    const pl_liquid_grains *s = g->grains;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const uint32_t near[4] = { g->left[c], g->right[c], g->down[c], g->up[c] };
        near_real sums[4] = { 0 };
        int any = 0;
        if (g->row[c] == 0 || g->first[c + 1] > g->first[c]) {
            continue;
        }
        for (int k = 0; k < 4; ++k) {
            if (near[k] != 0 && g->first[near[k] + 1] > g->first[near[k]]) {
                sums[0] += s->normal[near[k]], sums[1] += s->tangent[near[k]];
                sums[2] += s->bound[near[k]], sums[3] += s->share[near[k]];
                ++any;
            }
        }
        const near_real part = any > 0 ? 1 / (near_real)any : 0;
        s->normal[c] = part * sums[0], s->tangent[c] = part * sums[1];
        s->bound[c] = part * sums[2], s->share[c] = part * sums[3];
    }
}

bool pl_liquid_gather_grains(pl_memory *memory, pl_liquid_scratch *scratch, double unit,
                             double fall)
{
    pl_liquid_grid *g = &scratch->grid;
    pl_liquid_grains *s = &scratch->grains;
    const size_t cells = (size_t)g->cell_count + 1;
    near_real **const columns[] = { &s->normal,       &s->tangent, &s->bound, &s->share,
                                    &s->pressure,     &s->trial,   &s->yield, &s->gain_normal,
                                    &s->gain_tangent, &s->kept };
    const size_t count = sizeof columns / sizeof columns[0];
    if (!pl_buffer_reserve(memory, &scratch->granular, count * cells * sizeof(near_real))) {
        return false;
    }
    for (size_t i = 0; i < count; ++i) {
        *columns[i] = (near_real *)scratch->granular.data + i * cells;
        (*columns[i])[0] = 0;
    }
    s->unit = unit;
    s->least = SURFACE * fall;
    pl_liquid_cells(g, gather_range);
    pl_liquid_cells(g, fill_range);
    return true;
}

static void press_range(void *context, uint32_t first, uint32_t count)
{
    const pl_liquid_grid *g = context;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        g->grains->pressure[c] += g->row[c] != 0 ? g->vectors[PL_LIQUID_P][g->row[c]] : 0;
    }
}

void pl_liquid_press_grains(pl_liquid_grid *g)
{
    pl_liquid_cells(g, press_range);
}

//---- of particles --------------------------------------------------------------------------------

// Stresses are turned by the angle that a place turns by in a part, twice: t is about that, and keeps their size.
static void turn(double t, double *normal, double *tangent)
{
    const double cosine = (1 - t * t / 4) / (1 + t * t / 4), sine = t / (1 + t * t / 4);
    const double before = *normal;
    *normal = cosine * before - sine * *tangent;
    *tangent = sine * before + cosine * *tangent;
}

typedef struct bearing {
    const pl_liquid_grid *g;
    double way; // [cells per m/s] in a part
} bearing;

static void bear_range(void *context, uint32_t first, uint32_t count)
{
    const bearing *b = context;
    const pl_liquid_grid *g = b->g;
    const pl_liquid_grains *s = g->grains;
    for (uint32_t k = first; k < first + count; ++k) {
        const pl_liquid_point *p = &g->points[k];
        const double pressure = pl_liquid_bearing(s, p->cell);
        const double most = s->friction[phase_at(g, k)] * pressure * s->unit;
        plumb_particle *own = &s->particles[p->index];
        double normal = (double)own->shear[0], tangent = (double)own->shear[1];
        turn((double)(p->slope[2] - p->slope[1]) * b->way, &normal, &tangent);
        normal += s->unit * (double)s->gain_normal[p->cell];
        tangent += s->unit * (double)s->gain_tangent[p->cell];
        const double size = sqrt(normal * normal + tangent * tangent);
        const double part = size <= most ? 1 : most / size;
        own->shear[0] = (plumb_real)pl_liquid_held(part * normal, PL_LIQUID_FORCE);
        own->shear[1] = (plumb_real)pl_liquid_held(part * tangent, PL_LIQUID_FORCE);
    }
}

void pl_liquid_bear_shear(pl_liquid_grid *g, double way)
{
    bearing b = { g, way };
    pl_tasks_ranges(g->tasks, g->point_count, 512, bear_range, &b);
}
