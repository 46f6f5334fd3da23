// time_scale.c - bodies with a time of their own.
//
// Own time: a body of time scale s lives s seconds in a second of the world. Its columns keep the
// velocity v that it has in its own time; in the world it moves by V = s v. The solver works with V,
// as it must, since surfaces may not cross in the world. With forces F as the world knows them,
// m dv/dtau = F and dtau = s dt give (m / s^2) dV/dt = F: in the world's time it is a body of mass
// m / s^2 and inertia I / s^2. So the solver needs to know nothing else: contacts and joints
// balance (a body weighs m g whatever its time), momentum m V / s^2 is exchanged and energy
// m V^2 / (2 s^2) = m v^2 / 2 kept between bodies of any time. s = 0 is a body of infinite mass.
//
// Reads: settings. Writes: solver bodies, motions, velocities. Cost: O(bodies that ask).
#include "effects/gather.h"
#include "world/state.h"

void pl_time_scale_gather(plumb_world *world, uint32_t slot, near_real s)
{
    pl_solver_body *body = &pl_solver_bodies(&world->solver)[slot];
    pl_solver_motion *motion = &pl_solver_motions(&world->solver)[slot];
    near_real ss = s * s;
    body->vx *= s, body->vy *= s, body->w *= s;
    body->inv_mass *= ss, body->inv_inertia *= ss;
    motion->ax *= ss, motion->ay *= ss, motion->aw *= ss;
    motion->ux = body->vx, motion->uy = body->vy, motion->uw = body->w;
    motion->inv_mass = body->inv_mass;
    if (world->solver.follows_impacts) {
        near_real *low = (near_real *)world->solver.residuals.data + (size_t)slot * 4;
        low[0] *= s, low[1] *= s;
    }
}

void pl_time_scale_take_over(plumb_world *world, uint32_t row, real scale)
{
    pl_bodies *b = &world->bodies;
    const real inverse = 1 / scale;
    b->vx[row] *= inverse, b->vy[row] *= inverse, b->w[row] *= inverse;
    b->residual_vx[row] *= inverse, b->residual_vy[row] *= inverse;
}
