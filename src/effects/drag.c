// drag.c - drag of still air: dv/dt = a - c v - k |v| v, c the body's damping, k = drag / mass.
//
// In a substep of h, with f what is on the right now, and the derivative of the drag C = c I + k (|v| I + v v' / |v|),
//     v' = v + 2 T (I + T C)^-1 f,   T = tanh(s h / 2) / s,   s = sqrt(c^2 + 4 k |a|).
// Along the fall that is the solution of Riccati's equation: exact for what falls from rest or slows down alone, with
// one of c and k or both, for any h; a body at its terminal speed, c v + k v^2 = |a|, stays at it whatever its way there. Otherwise T is
// h / 2 to third order, and the step Kahan's (1993), linearly implicit, of second order. T instead of h / 2 keeps
// it from ringing where drag is faster than the substep. Linear damping of such bodies is done here, so that both are one
// equation; that of their spin by damping.c.
//
// A body of own time scale z has z v in the solver: c and s count z times, k, which is a length, not.
//
// Reads: settings, solver bodies. Writes: accelerations. Order: behind what accelerates. Cost: O(bodies with drag) a
// substep, an exponential each; the solver moves them, in free flight too.
#include "effects/drag.h"

#include "core/sort.h"
#include "math/decay.h"
#include "schema/passes.h"
#include "world/body_settings.h"

#include <math.h>

typedef struct pl_dragger {
    uint32_t slot;
    double linear; // [1/s] of the world's time
    double drag;   // [kg/m] times the square of the time scale: over the solver's mass
} pl_dragger;

bool pl_want_drag(const plumb_world *world, const char **reason)
{
    const bool wanted = world->settings.dragged > 0;
    *reason = wanted ? "some body has drag" : "no body has drag";
    return wanted;
}

bool pl_drag_acts_on(const plumb_world *world, uint32_t row)
{
    const uint32_t record = world->bodies.settings[row];
    const pl_body_settings *all = world->settings.items.data;
    return record != 0 && all[record - 1].drag > 0 && all[record - 1].time_scale > 0;
}

bool pl_drag_find(plumb_world *world)
{
    pl_effects *e = &world->effects;
    const pl_solver *s = &world->solver;
    const uint32_t slots = s->slot_count > 0 ? s->dynamic_slots : 0;
    const uint32_t *rows = s->rows.data;
    e->dragger_count = 0;
    if (world->settings.dragged == 0) {
        return true;
    }
    if (!pl_buffer_reserve(&world->memory, &e->draggers,
                           world->settings.count * sizeof(pl_dragger))) {
        return false;
    }
    pl_dragger *to = e->draggers.data;
    for (uint32_t slot = 0; slot < slots; ++slot) {
        if (!pl_drag_acts_on(world, rows[slot])) {
            continue;
        }
        const pl_body_settings t = pl_body_settings_get(world, rows[slot]);
        const double time = (double)t.time_scale;
        to[e->dragger_count++] = (pl_dragger){ slot, e->damps ? time * (double)t.damping : 0,
                                               (double)t.drag / (time * time) };
    }
    return true;
}

static void resist(const pl_dragger *d, const pl_solver_body *body, pl_solver_motion *motion,
                   double h)
{
    const double vx = (double)body->vx, vy = (double)body->vy;
    const double ax = (double)motion->ax, ay = (double)motion->ay;
    const double k = d->drag * (double)motion->inv_mass, c = d->linear,
                 speed = sqrt(vx * vx + vy * vy);
    const double s = sqrt(c * c + 4 * k * sqrt(ax * ax + ay * ay));
    const pl_decay e = pl_decay_of(s * h);
    const double t = h * e.mean / (1 + e.left);
    const double resistance = c + k * speed;
    const double fx = ax - resistance * vx, fy = ay - resistance * vy;
    // The inverse has one value along the velocity and another across it.
    const double across = 2 * t / (1 + t * resistance);
    const double along = 2 * t / (1 + t * (resistance + k * speed));
    const double ux = speed > 0 ? vx / speed : 0, uy = speed > 0 ? vy / speed : 0;
    const double more = (along - across) * (ux * fx + uy * fy);
    motion->ax = (near_real)((across * fx + more * ux) / h);
    motion->ay = (near_real)((across * fy + more * uy) / h);
}

void pl_drag_row(pl_substep *s)
{
    const plumb_world *world = s->world;
    const pl_effects *e = &world->effects;
    const pl_dragger *all = e->draggers.data;
    const pl_share mine =
        pl_substep_share(all, sizeof(pl_dragger), offsetof(pl_dragger, slot), e->dragger_count, s);
    for (uint32_t i = mine.first; i < mine.end; ++i) {
        const uint32_t slot = all[i].slot;
        resist(&all[i], &pl_solver_bodies(&world->solver)[slot],
               &pl_solver_motions(&world->solver)[slot], (double)s->h);
    }
}
