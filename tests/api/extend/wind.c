// wind.c - a force along x on bodies that have a wind: a = F / m.
//
// Reads: winds, masses of solver bodies. Writes: accelerations. Order: before damping. Cost: O(bodies of the cluster) a
// substep.
#include "world/substep.h"
#include "world/state.h"

bool pl_want_wind(const plumb_world *world, const char **reason)
{
    bool any = false;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        any |= world->bodies.wind[row] != 0;
    }
    *reason = any ? "there is a wind" : "there is no wind";
    return any;
}

bool pl_wind_acts_on(const plumb_world *world, uint32_t row)
{
    return world->bodies.wind[row] != 0;
}

void pl_wind_row(pl_substep *s)
{
    const plumb_world *world = s->world;
    const pl_slots slots = s->cluster->slots[0];
    const uint32_t *rows = world->solver.rows.data;
    pl_solver_motion *motions = pl_solver_motions(&world->solver);
    for (uint32_t slot = slots.first; slot < slots.first + slots.count; ++slot) {
        motions[slot].ax += (near_real)world->bodies.wind[rows[slot]] * motions[slot].inv_mass;
    }
}
