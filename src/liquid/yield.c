// yield.c - grains in the system of viscosity: where they yield to shear, and what they bear (the formulas: grains.c).
//
// Reads: the system, what grains bear, pressures. Writes: faces, bodies, the grains of the grid. Cost: O(cells with liquid).
#include "liquid/viscous.h"

#include <math.h>

#define QUARTER ((near_real)0.25)
// Of what resists strain, how much is kept as stress; the rest is a damper: else light bodies shake.
#define SPRING 0.5
// [cells of liquid] a lighter body is the end of a spring whose force is a step old: less is kept of the stress beside it.
#define HEAVY 16

//---- stresses ------------------------------------------------------------------------------------

// Of what grains bear in a cell, what these stresses lack.
static near_real borne(const pl_viscous *s, const near_real *stress, uint32_t c, bool yields)
{
    return s->g->row[c] == 0 ? 0 : (yields ? s->grains->yield[c] - 1 : 1) * stress[c] / s->k;
}

void pl_viscous_add_shear(pl_viscous *s, bool yields)
{
    const pl_liquid_grid *g = s->g;
    const near_real *normal = s->grains->normal, *tangent = s->grains->tangent;
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i], left = g->left[c], down = g->down[c];
        const near_real own = borne(s, normal, c, yields);
        s->xx[c] += own;
        s->yy[c] -= own;
        if (s->twice.u[c] > 0) {
            s->xy[c] += QUARTER * (borne(s, tangent, c, yields) + borne(s, tangent, left, yields) +
                                   borne(s, tangent, down, yields) +
                                   borne(s, tangent, g->left[down], yields));
        }
    }
}

// What an elastic solid would bear more in a cell; `tangent` is the mean of its corners, `size` that of all, with what it bears.
typedef struct shear {
    double normal, tangent, size;
} shear;

static shear shear_of(const pl_viscous *s, uint32_t c)
{
    const pl_liquid_grid *g = s->g;
    const near_real *u = s->speed.u, *v = s->speed.v;
    const uint32_t corners[4] = { c, g->right[c], g->up[c], g->right[g->up[c]] };
    const double more = PL_LIQUID_STIFF * (double)(u[g->right[c]] - u[c] - v[g->up[c]] + v[c]);
    const double normal = (double)s->grains->normal[c] + more;
    const double tangent = (double)s->grains->tangent[c];
    double sum = 0, squares = 0;
    int count = 0;
    for (int i = 0; i < 4; ++i) {
        if (s->twice.u[corners[i]] > 0) {
            const double t = PL_LIQUID_STIFF * (double)pl_viscous_slope(s, &s->speed, corners[i]);
            sum += t;
            squares += (tangent + t) * (tangent + t);
            ++count;
        }
    }
    const double square = count > 0 ? squares / count : tangent * tangent;
    return (shear){ more, count > 0 ? sum / count : 0, sqrt(normal * normal + square) };
}

bool pl_liquid_push_shear(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    pl_viscous s;
    if (!pl_viscous_begin(memory, scratch, 0, &s)) {
        return false;
    }
    for (uint32_t i = 0; i < s.count; ++i) {
        g->grains->trial[s.cells[i]] = (near_real)shear_of(&s, s.cells[i]).size;
    }
    pl_viscous_add_shear(&s, false); // to stresses of 0: none have been found yet
    for (uint32_t i = 0; i < s.count; ++i) {
        const uint32_t c = s.cells[i];
        g->u[c] += s.is_free.u[c] * s.k * pl_viscous_pull_u(&s, c) / s.mass.u[c];
        g->v[c] += s.is_free.v[c] * s.k * pl_viscous_pull_v(&s, c) / s.mass.v[c];
    }
    pl_viscous_push_bodies(&s);
    return true;
}

//---- yield ---------------------------------------------------------------------------------------

static near_real yield_of(const pl_liquid_grains *grains, uint32_t c, double size)
{
    const double most = (double)grains->bound[c] * pl_liquid_bearing(grains, c);
    return size > most ? (near_real)(most / size) : 1;
}

void pl_viscous_guess_yield(const pl_liquid_grid *g)
{
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        g->grains->yield[c] = yield_of(g->grains, c, (double)g->grains->trial[c]);
    }
}

double pl_viscous_find_yield(pl_viscous *s)
{
    const pl_liquid_grains *grains = s->grains;
    double most = 0;
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i];
        if (s->g->row[c] != 0 && grains->share[c] > 0) {
            const near_real yield = yield_of(grains, c, shear_of(s, c).size);
            const double change = fabs((double)(yield - grains->yield[c]));
            most = change > most ? change : most;
            grains->yield[c] = yield;
        }
    }
    return most;
}

//---- what they bear then -------------------------------------------------------------------------

static near_real kept_beside(const pl_liquid_body *b, double push)
{
    const double ease = b->inv_mass_x > b->inv_mass_y ? b->inv_mass_x : b->inv_mass_y;
    const double mass = ease > 0 ? 1 / (ease * push) : HEAVY;
    return mass < HEAVY ? (near_real)(mass / HEAVY) : 1;
}

// In the two cells at a face that a body closes, and those beside them along it.
static void find_kept(pl_viscous *s)
{
    const pl_liquid_grid *g = s->g;
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const near_real keep = kept_beside(&g->bodies[link->body], g->drag);
        const uint32_t *before = link->upright ? g->left : g->down;
        const uint32_t *behind = link->upright ? g->right : g->up;
        const uint32_t c = link->cell, other = link->upright ? g->down[c] : g->left[c];
        const uint32_t near[6] = { c, before[c], behind[c], other, before[other], behind[other] };
        for (int k = 0; k < 6; ++k) {
            near_real *to = &s->grains->kept[near[k]];
            *to = keep < *to ? keep : *to;
        }
    }
}

bool pl_liquid_strain(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_viscous s;
    if (!pl_viscous_begin(memory, scratch, 0, &s)) {
        return false;
    }
    find_kept(&s);
    for (uint32_t i = 0; i < s.count; ++i) {
        const uint32_t c = s.cells[i];
        const shear more = shear_of(&s, c);
        const double keep = SPRING * (double)s.grains->kept[c];
        s.grains->gain_normal[c] = (near_real)(keep * more.normal);
        s.grains->gain_tangent[c] = (near_real)(keep * more.tangent);
    }
    return true;
}
