// integrate.c - positions from velocities, for both solvers.
//
// Free flight is exact: a body that no contact pushed in the substep (its velocity is the one that was
// integrated, bit for bit) moves by h v - h^2 a / 2, the parabola. A pushed body moves by h v; the parabola
// would make resting bodies hop. Cost: O(bodies in contacts) a substep.
#include "world/state.h"

// Moves dynamic and kinematic bodies by the velocities with which the substep's contacts left them.
void pl_integrate_positions(const plumb_world *world, real h)
{
    const pl_solver *s = &world->solver;
    pl_solver_body *body = pl_solver_bodies(s);
    const pl_solver_motion *motion = pl_solver_motions(s);
    real half = h * h / 2;
    for (uint32_t i = 0; i + 1 < s->slot_count; ++i) {
        bool free =
            body[i].vx == motion[i].ux && body[i].vy == motion[i].uy && body[i].w == motion[i].uw;
        real back = free ? half : 0;
        body[i].dx += h * body[i].vx - back * motion[i].ax;
        body[i].dy += h * body[i].vy - back * motion[i].ay;
        body[i].da += h * body[i].w - back * motion[i].aw;
    }
}
