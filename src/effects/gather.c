// gather.c - bodies of PL_BODY_HAS_EFFECTS on their way into the solver and back: locked axes, own time, caps.
//
// Reads: settings, flags. Writes: solver bodies and motions, velocities. Cost: O(bodies that ask).
#include "effects/gather.h"

#include "world/state.h"

static void lock(plumb_world *world, uint32_t slot, uint32_t flags)
{
    pl_solver_body *body = &pl_solver_bodies(&world->solver)[slot];
    pl_solver_motion *motion = &pl_solver_motions(&world->solver)[slot];
    near_real unused[2];
    near_real *low = world->solver.follows_impacts
                         ? (near_real *)world->solver.residuals.data + (size_t)slot * 4
                         : unused;
    if ((flags & PL_BODY_LOCK_X) != 0) {
        body->vx = motion->ux = motion->ax = low[0] = 0;
    }
    if ((flags & PL_BODY_LOCK_Y) != 0) {
        body->vy = motion->uy = motion->ay = low[1] = 0;
    }
}

static const pl_body_settings *settings_of(const plumb_world *world, uint32_t row)
{
    return (const pl_body_settings *)world->settings.items.data + world->bodies.settings[row] - 1;
}

void pl_effects_open(plumb_world *world)
{
    pl_effects *e = &world->effects;
    e->gathered = (world->locked_bodies > 0 ? PL_BODY_LOCKED : 0) |
                  (world->settings.scaled > 0 ? PL_BODY_HAS_SETTINGS : 0);
    e->taken = world->settings.scaled > 0 || (e->caps && world->settings.capped > 0);
}

void pl_effects_gather(plumb_world *world, uint32_t row, uint32_t slot)
{
    uint32_t flags = world->bodies.flags[row];
    if (row < world->dynamic_count) {
        lock(world, slot, flags);
    }
    if ((flags & PL_BODY_HAS_SETTINGS) != 0 && settings_of(world, row)->time_scale != 1) {
        pl_time_scale_gather(world, slot, (near_real)settings_of(world, row)->time_scale);
    }
}

void pl_effects_take_over(plumb_world *world, uint32_t row)
{
    if ((world->bodies.flags[row] & PL_BODY_HAS_SETTINGS) == 0) {
        return;
    }
    const pl_body_settings *t = settings_of(world, row);
    if (t->time_scale != 1) {
        pl_time_scale_take_over(world, row, t->time_scale);
    }
    pl_caps_take_over(world, row, t);
}

void pl_effects_free(pl_memory *memory, pl_effects *e)
{
    pl_buffer *buffers[] = { &e->called,     &e->bases,    &e->decays,   &e->factors,
                             &e->dampers,    &e->cappers,  &e->swims,    &e->volumes,
                             &e->immersions, &e->swimmers, &e->draggers, &e->engines };
    if (e->shelter != NULL) {
        pl_shelter copy = *e->shelter; // of a copy of the effects it tells what would be freed
        pl_buffer_free(memory, &copy.shades);
        pl_buffer_free(memory, &copy.shadows);
        pl_buffer_free(memory, &copy.blockers);
        pl_buffer_free(memory, &copy.casts);
        pl_resize(memory, e->shelter, sizeof *e->shelter, 0);
    }
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
}
