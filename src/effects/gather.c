// gather.c - locked axes, own time, damping and caps, as solver bodies are gathered and moved.
//
// Own time: a body of time scale s lives s seconds in a second of the world. Its columns keep the
// velocity v that it has in its own time; in the world it moves by V = s v. The solver works with V,
// as it must, since surfaces may not cross in the world. With forces F as the world knows them,
// m dv/dtau = F and dtau = s dt give (m / s^2) dV/dt = F: in the world's time it is a body of mass
// m / s^2 and inertia I / s^2. So the solver needs to know nothing else: contacts and joints
// balance (a body weighs m g whatever its time), momentum m V / s^2 is exchanged and energy
// m V^2 / (2 s^2) = m v^2 / 2 kept between bodies of any time. s = 0 is a body of infinite mass.
//
// Damping and caps: before each substep of length h, the acceleration is set to what leads from
// the velocity of now to the wanted one at the substep's end, v exp(-c h) + a (1 - exp(-c h)) / c,
// then shortened to the cap. Velocities are thus exact for any h where nothing touches; places are
// off by (c h)^2 / 12 of the way.
//
// Reads: settings, flags. Writes: solver bodies and motions, velocities. Cost: O(bodies that ask).
#include "math/decay.h"
#include "plumb/math.h"
#include "world/state.h"

static pl_body_settings *items(const plumb_world *world)
{
    return (pl_body_settings *)world->settings.items.data;
}

static void slow_down(plumb_world *world, uint32_t slot, near_real s)
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

void pl_effects_gather(plumb_world *world, uint32_t row, uint32_t slot)
{
    uint32_t flags = world->bodies.flags[row];
    if (row < world->dynamic_count) {
        lock(world, slot, flags);
    }
    if ((flags & PL_BODY_HAS_SETTINGS) == 0) {
        return;
    }
    pl_body_settings *t = &items(world)[world->bodies.settings[row] - 1];
    if (t->time_scale != 1) {
        slow_down(world, slot, (near_real)t->time_scale);
    }
    const pl_solver_motion *motion = &pl_solver_motions(&world->solver)[slot];
    t->ax = motion->ax, t->ay = motion->ay, t->aw = motion->aw;
}

bool pl_effects_resist(const plumb_world *world)
{
    return world->settings.damped + world->settings.capped > 0;
}

// [1/s^2] acceleration that leads from v to the damped velocity after h.
static near_real damped(near_real v, near_real a, const pl_decay *decay, real h)
{
    double wanted = (double)v * decay->left + (double)a * (double)h * decay->mean;
    return (near_real)((wanted - (double)v) / (double)h);
}

static void resist(const pl_body_settings *t, const pl_solver_body *body, pl_solver_motion *motion,
                   real h)
{
    real s = t->time_scale;
    motion->ax = (near_real)t->ax, motion->ay = (near_real)t->ay, motion->aw = (near_real)t->aw;
    if (t->damping > 0) {
        pl_decay decay = pl_decay_of((double)t->damping * (double)(s * h));
        motion->ax = damped(body->vx, motion->ax, &decay, h);
        motion->ay = damped(body->vy, motion->ay, &decay, h);
    }
    if (t->angular_damping > 0) {
        pl_decay decay = pl_decay_of((double)t->angular_damping * (double)(s * h));
        motion->aw = damped(body->w, motion->aw, &decay, h);
    }
    plumb_vec2 v = { body->vx + h * motion->ax, body->vy + h * motion->ay };
    real speed = plumb_vec2_magnitude(v);
    if (t->max_speed > 0 && speed > s * t->max_speed) {
        real share = s * t->max_speed / speed;
        motion->ax = (near_real)((share * v.x - body->vx) / h);
        motion->ay = (near_real)((share * v.y - body->vy) / h);
    }
    real spin = body->w + h * motion->aw, most = s * t->max_spin;
    if (t->max_spin > 0 && plumb_abs(spin) > most) {
        motion->aw = (near_real)((plumb_clamp(spin, -most, most) - body->w) / h);
    }
}

void pl_effects_substep(plumb_world *world, real h)
{
    const uint32_t *slots = world->solver.slots.data;
    for (uint32_t i = 0; i < world->settings.count; ++i) {
        const pl_body_settings *t = &items(world)[i];
        uint32_t row = pl_body_row(world, t->body);
        if (row < world->dynamic_count && slots[row] != PL_NONE && t->time_scale > 0) {
            resist(t, &pl_solver_bodies(&world->solver)[slots[row]],
                   &pl_solver_motions(&world->solver)[slots[row]], h);
        }
    }
}

void pl_effects_take_over(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    if ((b->flags[row] & PL_BODY_HAS_SETTINGS) == 0) {
        return;
    }
    const pl_body_settings *t = &items(world)[b->settings[row] - 1];
    if (t->time_scale != 1) {
        real inverse = 1 / t->time_scale;
        b->vx[row] *= inverse, b->vy[row] *= inverse, b->w[row] *= inverse;
        b->residual_vx[row] *= inverse, b->residual_vy[row] *= inverse;
    }
    real speed = plumb_vec2_magnitude(plumb_v2(b->vx[row], b->vy[row]));
    if (t->max_speed > 0 && speed > t->max_speed) {
        b->vx[row] *= t->max_speed / speed;
        b->vy[row] *= t->max_speed / speed;
    }
    if (t->max_spin > 0) {
        b->w[row] = plumb_clamp(b->w[row], -t->max_spin, t->max_spin);
    }
}

void pl_effects_poses(plumb_world *world)
{
    uint32_t movable = world->dynamic_count + world->kinematic_count;
    for (uint32_t i = 0; i < world->settings.count; ++i) {
        uint32_t row = pl_body_row(world, items(world)[i].body);
        if (row < movable) {
            pl_poses(world)[row].vx *= items(world)[i].time_scale;
            pl_poses(world)[row].vy *= items(world)[i].time_scale;
        }
    }
}
