// density.c - the liquid's volume where velocities have lost it: particles are moved until they lie evenly.
//
// A velocity field without divergence still lets particles gather, step by step; what is lost so is found in their
// places alone. The density at a cell's centre is a sum of hats over particles, and solid counts as full of them; the
// excess e over that of rest is sent away by displacements d = -grad f, with the matrix of the pressures:
// sum a (f - f_beside) = e. Velocities do not change (after Kugelstadt et al. 2019). Too little is filled up only in
// cells that no air is beside: a surface is thin by itself.
//
// Reads: densities (transfer.c), openness, rows. Writes: new_u, new_v, vectors. Cost: O(cells + rows x iterations).
#include "liquid/liquid.h"

#define MOST_EXCESS ((near_real)0.5)
#define MOST_WAY    ((near_real)0.5) // cells
#define LOOSE                                                                                      \
    ((near_real)0.05) // by which grains may lie looser or closer: a heap whose particles go on to be moved creeps
#define SOLVE_TO 1e-2
#define EVEN     1e-4 // excess that is left alone

static near_real excess(const pl_liquid_grid *g, uint32_t c)
{
    const uint32_t near[4] = { g->left[c], g->right[c], g->down[c], g->up[c] };
    near_real open[4];
    pl_liquid_faces_of(g, c, open);
    near_real e = g->density[c] - 1;
    if (g->grains != NULL) {
        const near_real slack = g->grains->share[c] * LOOSE;
        e = e > slack ? e - slack : e < -slack ? e + slack : 0;
    }
    e = e > MOST_EXCESS ? MOST_EXCESS : e < -MOST_EXCESS ? -MOST_EXCESS : e;
    for (int k = 0; k < 4 && e < 0; ++k) {
        e = g->row[near[k]] == 0 && open[k] > 0 ? 0 : e;
    }
    return e;
}

static void excess_range(void *context, uint32_t first, uint32_t count)
{
    const pl_liquid_grid *g = context;
    for (uint32_t s = 1 + first; s < 1 + first + count; ++s) {
        for (uint32_t i = 0; i < PL_LIQUID_SIDE; ++i) {
            const uint32_t c = g->strips[s].cell + i;
            if (g->row[c] != 0) {
                g->vectors[PL_LIQUID_R][g->row[c]] = excess(g, c);
            }
        }
    }
}

static near_real held(near_real way)
{
    return way > MOST_WAY ? MOST_WAY : way < -MOST_WAY ? -MOST_WAY : way;
}

static void displace_cells(void *context, uint32_t first, uint32_t count)
{
    pl_liquid_grid *g = context;
    const near_real *p = g->vectors[PL_LIQUID_P];
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const uint32_t left = g->left[c], down = g->down[c], here = g->row[c];
        const bool u = here != 0 || g->row[left] != 0, v = here != 0 || g->row[down] != 0;
        g->known_u[c] = u;
        g->known_v[c] = v;
        g->new_u[c] = u && g->open_u[c] > 0
                          ? held(pl_liquid_light_u(g, c) * (p[g->row[left]] - p[here]) /
                                 pl_liquid_gap(g, left, c))
                          : 0;
        g->new_v[c] = v && g->open_v[c] > 0
                          ? held(pl_liquid_light_v(g, c) * (p[g->row[down]] - p[here]) /
                                 pl_liquid_gap(g, down, c))
                          : 0;
    }
}

bool pl_liquid_even_out(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    pl_tasks_ranges(g->tasks, g->levels[0].end - 1, 64, excess_range, g);
    if (!pl_liquid_balance(memory, scratch, false)) {
        return false;
    }
    pl_liquid_solve(g, 0, SOLVE_TO, EVEN);
    pl_liquid_cells(g, displace_cells);
    g->new_u[0] = g->new_v[0] = 0;
    pl_liquid_extrapolate(g, g->new_u, g->new_v, 1);
    return true;
}
