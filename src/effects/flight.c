// flight.c - free flight of a body with locked axes, damping, caps or a time of its own.
//
// Over T = s dt of its own time, with constant acceleration a and damping c (dv/dt = a - c v):
//     v' = v E + a T M,  way = v T M + a T^2 K,
//     E = exp(-c T),  M = (1 - E) / (c T),  K = (1 - M) / (c T),
// which without damping (E = M = 1, K = 1/2) is the parabola: exact for any step. A speed that ends
// above the cap is shortened to it, and the way is then that of the mean of both velocities.
//
// Reads: one body row, its record, its decay (damping.c). Writes: nothing. Cost: O(1).
#include "math/decay.h"
#include "effects/effects.h"
#include "world/body_settings.h"
#include "plumb/math.h"
#include "world/state.h"

#include <math.h>

typedef struct axis {
    double v, way, after;
} axis;

static axis fly(double v, double a, double time, const pl_decay *d)
{
    return (axis){ v, v * time * d->mean + a * time * time * d->twice,
                   v * d->left + a * time * d->mean };
}

static double length(double x, double y)
{
    return sqrt(x * x + y * y);
}

// Shortens (x, y) to `most`.
static void shorten(double *x, double *y, double most)
{
    double now = length(*x, *y);
    if (now > most) {
        *x *= most / now;
        *y *= most / now;
    }
}

static const pl_decay undamped = { 1, 1, 0.5 };

pl_flight pl_effects_fly(const plumb_world *world, uint32_t row, real dt)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t flags = b->flags[row];
    const uint32_t record = b->settings[row];
    const pl_body_settings t = pl_body_settings_get(world, row);
    const double time = (double)t.time_scale * (double)dt;
    const bool damped = record != 0 && world->effects.damps;
    const pl_damping_decay *decay = damped ? &pl_damping_decays(&world->effects)[record - 1] : NULL;
    const pl_decay d = damped ? decay->flight : undamped,
                   dw = damped ? decay->flight_turn : undamped;
    double free_x = (flags & PL_BODY_LOCK_X) == 0, free_y = (flags & PL_BODY_LOCK_Y) == 0;
    double gravity = (double)b->gravity_scale[row], im = (double)b->inv_mass[row];
    double ax = free_x * ((double)world->effects.gravity.x * gravity + (double)b->fx[row] * im);
    double ay = free_y * ((double)world->effects.gravity.y * gravity + (double)b->fy[row] * im);
    double aw = (double)b->torque[row] * (double)b->inv_inertia[row];
    double vx = free_x * ((double)b->vx[row] + (double)b->residual_vx[row]);
    double vy = free_y * ((double)b->vy[row] + (double)b->residual_vy[row]);
    double w = (double)b->w[row];
    const bool caps = world->effects.caps;
    const double cap = caps ? (double)t.max_speed : 0, most = caps ? (double)t.max_spin : 0;
    if (cap > 0) {
        shorten(&vx, &vy, cap);
    }
    if (most > 0) {
        w = w > most ? most : w < -most ? -most : w;
    }
    axis x = fly(vx, ax, time, &d), y = fly(vy, ay, time, &d), turn = fly(w, aw, time, &dw);
    if (cap > 0 && length(x.after, y.after) > cap) {
        shorten(&x.after, &y.after, cap);
        x.way = time * (x.v + x.after) / 2;
        y.way = time * (y.v + y.after) / 2;
    }
    if (most > 0 && (turn.after > most || turn.after < -most)) {
        turn.after = turn.after > 0 ? most : -most;
        turn.way = time * (turn.v + turn.after) / 2;
    }
    // Changes against the columns, without what rounding had taken from them.
    return (pl_flight){ x.way,
                        y.way,
                        turn.way,
                        x.after - (double)b->vx[row] - (double)b->residual_vx[row],
                        y.after - (double)b->vy[row] - (double)b->residual_vy[row],
                        turn.after - (double)b->w[row] };
}
