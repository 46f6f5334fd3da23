// edge.c - the edge of the world: no body goes beyond x = 10 m.
//
// Reads: poses. Writes: velocities, poses. Order: behind motion. Cost: O(dynamic bodies).
#include "schema/passes.h"
#include "world/state.h"

#define EDGE ((real)10)

bool pl_want_edge(const plumb_world *world, const char **reason)
{
    *reason = world->dynamic_count > 0 ? "bodies may leave" : "nothing moves";
    return world->dynamic_count > 0;
}

plumb_result pl_run_edge(plumb_world *world, plumb_real dt)
{
    pl_bodies *b = &world->bodies;
    (void)dt;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (b->x[row] > EDGE) {
            b->x[row] = EDGE;
            b->vx[row] = b->residual_vx[row] = 0;
            pl_body_update_center(world, row);
        }
    }
    return PLUMB_OK;
}
