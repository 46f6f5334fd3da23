// driven.c - who is slow because it is driven slowly: carried by a surface that runs, moved by a joint's motor. A
// motor that crawls must not stop by itself.
//
// Reads: manifolds, joints, velocities. Writes: nothing. Cost: O(1) a contact or joint, when islands are looked for.
#include "sleep/sleep.h"
#include "joints/joint.h"
#include "world/state.h"

bool pl_sleep_is_carried(const plumb_world *world, const pl_manifold *m)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t p = m->body_a, q = m->body_b;
    const double surface = (double)m->surface_speed, nx = (double)m->nx, ny = (double)m->ny;
    if (surface == 0) {
        return false;
    }
    // A point of B over one of A: surfaces that stick take it along at -surface.
    const pl_manifold_point *at = &m->point[0];
    const double rat = (double)at->ax * nx + (double)at->ay * ny;
    const double rbt = (double)at->bx * nx + (double)at->by * ny;
    const double pace = nx * (double)(b->vy[q] - b->vy[p]) - ny * (double)(b->vx[q] - b->vx[p]) +
                        rbt * (double)b->w[q] - rat * (double)b->w[p];
    return pl_keeps_pace(-pace, surface);
}

bool pl_sleep_is_driven(const plumb_world *world, const pl_joint *joint)
{
    const plumb_joint_desc *d = &joint->desc;
    return d->enable_motor && d->motor_speed != 0 && d->max_motor > 0 && !d->disabled &&
           pl_keeps_pace((double)pl_joint_motor_rate(world, joint), (double)d->motor_speed);
}
