// halves.c - rows of the kick in halves: what it is, and the passes over bodies, in halves.simd.c.
//
// Order: behind impacts, before the sweeps; the drift.
#include "solver/substep.h"
#include "world/state.h"

#define HALF ((near_real)0.5)

void pl_soft_share(const plumb_world *world, uint32_t row, uint32_t slot)
{
    near_real *kicked = (near_real *)world->solver.kicked.data + 4 * (size_t)slot;
    kicked[3] = row < world->dynamic_count ? -HALF : 0; // whole until it is pushed
}

void pl_soft_halve(pl_substep *s)
{
    pl_pass_bodies(s, 0, s->solving->step->kernels->halve);
}

void pl_soft_move(pl_substep *s)
{
    pl_pass_bodies(s, 0, s->solving->step->kernels->drift);
    pl_move_kinematic(s);
}
