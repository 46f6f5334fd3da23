// back.h - what the faces round a point give back to it: velocity, slopes, displacement (APIC, the way back of transfer.c).
#ifndef PL_LIQUID_BACK_H
#define PL_LIQUID_BACK_H

#include "core/quad.h"
#include "liquid/liquid.h"

// Of u, v [m/s] and of displacements along x, y [cells]; slopes are per cell.
typedef struct pl_liquid_flow {
    pl_near_quad value, along_x, along_y;
} pl_liquid_flow;

// Bilinear between four faces: lines of u are half a cell off in y, columns of v in x.
static inline void pl_liquid_find_flow(const pl_liquid_grid *g, const pl_liquid_point *p,
                                       pl_liquid_flow *flow)
{
    const near_real half = (near_real)0.5;
    const bool below = p->fy < half, before = p->fx < half;
    const uint32_t u = below ? g->down[p->cell] : p->cell, v = before ? g->left[p->cell] : p->cell;
    const uint32_t up_u = g->up[u], up_v = g->up[v];
    const uint32_t u_of[4] = { u, g->right[u], up_u, g->right[up_u] };
    const uint32_t v_of[4] = { v, g->right[v], up_v, g->right[up_v] };
    pl_near_quad f[4];
    for (int i = 0; i < 4; ++i) {
        f[i] = (pl_near_quad){ g->u[u_of[i]], g->v[v_of[i]], g->new_u[u_of[i]], g->new_v[v_of[i]] };
    }
    const near_real u_y = below ? p->fy + half : p->fy - half;
    const near_real v_x = before ? p->fx + half : p->fx - half;
    const pl_near_quad x = { p->fx, v_x, p->fx, v_x }, y = { u_y, p->fy, u_y, p->fy };
    const pl_near_quad low = f[0] + x * (f[1] - f[0]), high = f[2] + x * (f[3] - f[2]);
    flow->value = low + y * (high - low);
    flow->along_x = (1 - y) * (f[1] - f[0]) + y * (f[3] - f[2]);
    flow->along_y = high - low;
}

#endif
