// drops.c - drops that touch nothing keep their momentum.
//
// Curvature of a grid's resolution does not sum up to 0 round a drop, quite: one that wobbles would swim away. What no solid
// is near gets, by drops, what their particles are about to gain beside gravity taken off all of their faces: flow
// without divergence stays so. Only with surface tension.
//
// Reads: points, cells, covers. Writes: velocities of faces. Cost: O(cells + points), one thread.
#include "liquid/back.h"

#include <string.h>

#define BOUND (-1e30) // mass of what solids are near: no particles make it more than 0

enum { NONE, MARKED, FIRST }; // labels of cells

// Of a drop. A label lies in 25 cells or more, so there is room behind the labels.
typedef struct drop {
    double mass, u, v;
} drop;

static uint32_t moved(const pl_liquid_grid *g, uint32_t c, int x, int y)
{
    for (; x != 0; x += x < 0 ? 1 : -1) {
        c = x < 0 ? g->left[c] : g->right[c];
    }
    for (; y != 0; y += y < 0 ? 1 : -1) {
        c = y < 0 ? g->down[c] : g->up[c];
    }
    return c;
}

// Cells whose faces its particles feel, and one more: drops that near are one.
static void mark(const pl_liquid_grid *g, uint32_t *labels)
{
    memset(labels, 0, g->cell_count * sizeof *labels);
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        for (int k = 0; k < 25 && g->block[c] != 0; ++k) {
            labels[moved(g, c, k % 5 - 2, k / 5 - 2)] = MARKED;
        }
    }
    labels[0] = NONE;
}

// Labels all that is joined to a cell; whether a solid is near it.
static bool spread(const pl_liquid_grid *g, uint32_t *labels, uint32_t *list, uint32_t label,
                   uint32_t from)
{
    uint32_t count = 1;
    bool bound = false;
    list[0] = from;
    labels[from] = label;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t c = list[i], near[4] = { g->left[c], g->right[c], g->down[c], g->up[c] };
        bound |= g->cover[c] > 0 || g->open_u[c] < 1 || g->open_v[c] < 1;
        for (int k = 0; k < 4; ++k) {
            if (labels[near[k]] == MARKED) {
                labels[near[k]] = label;
                list[count++] = near[k];
            }
        }
    }
    return bound;
}

static void add_points(const pl_liquid_grid *g, const uint32_t *labels, drop *drops, double fall_x,
                       double fall_y)
{
    for (uint32_t k = 0; k < g->point_count; ++k) {
        const pl_liquid_point *p = &g->points[k];
        drop *d = &drops[labels[p->cell]];
        const double mass =
            g->mixture != NULL ? (double)g->mixture->kinds[g->mixture->phases[k]].mass : 1;
        pl_liquid_flow flow;
        pl_liquid_find_flow(g, p, &flow);
        d->mass += mass;
        d->u += mass * ((double)flow.value[0] - (double)p->u - fall_x);
        d->v += mass * ((double)flow.value[1] - (double)p->v - fall_y);
    }
}

void pl_liquid_keep_momentum(pl_liquid_grid *g, pl_liquid_scratch *scratch, double fall_x,
                             double fall_y)
{
    drop *drops = scratch->tension.data; // which has no further use in this part of a step
    const uint32_t most = FIRST + g->cell_count / 25 + 1;
    uint32_t *labels = (uint32_t *)(void *)(drops + most), *list = labels + g->cell_count;
    uint32_t count = FIRST;
    memset(drops, 0, most * sizeof *drops);
    mark(g, labels);
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        if (labels[c] == MARKED) {
            drops[count].mass = spread(g, labels, list, count, c) ? BOUND : 0;
            ++count;
        }
    }
    add_points(g, labels, drops, fall_x, fall_y);
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const drop *d = &drops[labels[c]];
        if (labels[c] >= FIRST && d->mass > 0) {
            g->u[c] -= (near_real)(d->u / d->mass);
            g->v[c] -= (near_real)(d->v / d->mass);
        }
    }
}
