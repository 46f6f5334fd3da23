// dynamic.c - a dynamic character: forces that walk, hold on slopes and follow the ground.
//
// On ground it is driven along the tangent towards its wanted speed relative to the ground, with at
// most its acceleration, and held against gravity along the slope; what drives it acts back on the
// ground. Its feet have no friction of their own (pl_characters_feet): the force is all there is, so
// speeds are met exactly. A jump sets the velocity, since a force over a step would be half a step
// late.
//
// Reads: obstacles, body columns. Writes: forces and velocity of the body, forces of the ground.
// Cost: as a kinematic character that stands.
#include "character/walker.h"
#include "narrow/surface.h"
#include "query/query.h"
#include "world/island.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <math.h>

#define DEFAULT_ACCELERATION 40.0 // [m/s^2]
#define REACH                0.1  // [-] of the half width: ground this near is stood on
#define LEAVING              0.2  // [m/s] away from the ground, and what gravity does in two steps

static double clamp(double v, double most)
{
    return v < -most ? -most : v > most ? most : v;
}

static void look_for_ground(pl_walker *m)
{
    pl_character *c = m->c;
    const pl_bodies *b = &m->world->bodies;
    pl_touch t;
    double reach = m->skin + REACH * m->half_width;
    bool was = c->on_ground;
    c->on_ground = c->on_slope = false;
    c->slope_side = 0;
    if (!pl_walker_sweep(m, -reach * m->ux, -reach * m->uy, &t)) {
        c->ground = (pl_ground){ 0 };
        return;
    }
    double x, y;
    pl_walker_touch_point(m, &t, &x, &y);
    x += (double)m->start.x, y += (double)m->start.y;
    uint32_t row = t.obstacle->row;
    double w = (double)b->w[row];
    pl_shift arm = pl_wrap_arm(m->world, row, x, y);
    double gx = (double)b->vx[row] - w * arm.y;
    double gy = (double)b->vy[row] + w * arm.x;
    const double belt = (double)pl_belt_speed(m->world, t.obstacle->piece);
    gx += belt * t.ny, gy -= belt * t.nx;
    double away = ((double)b->vx[m->row] - gx) * t.nx + ((double)b->vy[m->row] - gy) * t.ny;
    double g = sqrt(m->gravity_x * m->gravity_x + m->gravity_y * m->gravity_y);
    bool stays = away <= LEAVING + 2 * g * m->dt && (was || away <= LEAVING);
    c->on_ground = stays && pl_is_floor(m, t.nx, t.ny);
    c->on_slope = stays && !c->on_ground;
    c->slope_side = !c->on_slope ? 0 : pl_right(m, t.nx, t.ny) > 0 ? 1 : -1;
    m->nx = t.nx, m->ny = t.ny;
    c->ground = !c->on_ground ? (pl_ground){ 0 }
                              : (pl_ground){ .body = b->entity[row],
                                             .shape = m->world->pieces.shape[t.obstacle->piece],
                                             .point = { (real)x, (real)y },
                                             .normal = { (real)t.nx, (real)t.ny },
                                             .velocity = { (real)gx, (real)gy },
                                             .spin = (real)w };
}

// The opposite of a force on the character acts on what it stands on. It acts for a whole step, whatever comes of it meanwhile: what is
// lighter than the character is not made faster by it than the character.
static void act_back(pl_walker *m, double fx, double fy)
{
    const pl_ground *g = &m->c->ground;
    const pl_bodies *b = &m->world->bodies;
    const double x = (double)g->point.x, y = (double)g->point.y, force = sqrt(fx * fx + fy * fy);
    const uint32_t row = pl_body_row(m->world, g->body);
    if (row != PL_NONE && b->type[row] == PLUMB_DYNAMIC && force > 0) {
        const double mass = pl_walker_mass_at(m->world, row, x, y, fx / force, fy / force);
        const double share = pl_least(mass / (double)b->mass[m->row], 1);
        pl_shove_add(m->world, row, -share * fx, -share * fy, x, y);
    }
}

static void act(pl_walker *m, double fx, double fy, bool on_ground)
{
    const pl_bodies *b = &m->world->bodies;
    pl_shove_add(m->world, m->row, fx, fy, (double)b->center_x[m->row],
                 (double)b->center_y[m->row]);
    if (on_ground) {
        act_back(m, fx, fy);
    }
}

static void jump(pl_walker *m)
{
    pl_character *c = m->c;
    pl_bodies *b = &m->world->bodies;
    double vx = (double)(b->vx[m->row] - c->ground.velocity.x);
    double vy = (double)(b->vy[m->row] - c->ground.velocity.y);
    double gain = (double)c->jump - pl_up(m, vx, vy);
    pl_walker_rouse(m->world, m->row); // a velocity alone wakes nobody
    b->vx[m->row] += (real)(gain * m->ux);
    b->vy[m->row] += (real)(gain * m->uy);
    const double force = gain * (double)b->mass[m->row] / m->dt;
    act_back(m, force * m->ux, force * m->uy);
    pl_walker_take_along(m, c->ground.velocity);
    c->on_ground = false;
    c->ground = (pl_ground){ 0 };
}

static void walk(pl_walker *m, double acceleration)
{
    const pl_character *c = m->c;
    const pl_bodies *b = &m->world->bodies;
    double tx = m->ny, ty = -m->nx, mass = (double)b->mass[m->row];
    double speed = (double)(b->vx[m->row] - c->ground.velocity.x) * tx +
                   (double)(b->vy[m->row] - c->ground.velocity.y) * ty;
    double a = clamp(((double)c->walk - speed) / m->dt, acceleration);
    double force = mass * (a - (m->gravity_x * tx + m->gravity_y * ty));
    act(m, force * tx, force * ty, true);
}

static void steer(pl_walker *m, double acceleration)
{
    const pl_bodies *b = &m->world->bodies;
    double speed = pl_right(m, (double)b->vx[m->row], (double)b->vy[m->row]);
    double a = clamp(((double)m->c->walk + (double)m->c->left - speed) / m->dt, acceleration);
    double force = (double)b->mass[m->row] * a;
    act(m, force * m->rx, force * m->ry, false);
}

static void fly(pl_walker *m, double acceleration)
{
    const pl_bodies *b = &m->world->bodies;
    double mass = (double)b->mass[m->row];
    double gx = (double)(m->c->fly.x - b->vx[m->row]) / m->dt;
    double gy = (double)(m->c->fly.y - b->vy[m->row]) / m->dt;
    double a = sqrt(gx * gx + gy * gy), share = a > acceleration ? acceleration / a : 1;
    act(m, mass * (share * gx - m->gravity_x), mass * (share * gy - m->gravity_y), false);
}

bool pl_character_drive(plumb_world *world, pl_character *c, real dt)
{
    pl_walker m;
    bool idle = c->walk == 0 && c->jump == 0 && !c->flies;
    if (!pl_walker_begin(world, c, dt, &m) || (idle && pl_row_slept(world, m.row))) {
        return true;
    }
    if (!pl_walker_look(&m, REACH * m.half_width + m.skin)) {
        return false;
    }
    double acceleration = c->desc.acceleration > 0 ? m.acceleration : DEFAULT_ACCELERATION;
    double in_air = c->desc.air_acceleration > 0 ? m.air_acceleration : acceleration;
    const plumb_vec2 carried = c->ground.velocity;
    const bool stood = c->on_ground;
    look_for_ground(&m);
    if (stood && !c->on_ground) {
        pl_walker_take_along(&m, carried);
    }
    bool jumps = c->jump > 0 && c->on_ground;
    if (c->flies) {
        c->on_ground = false;
        c->left = 0;
        c->ground = (pl_ground){ 0 };
        fly(&m, acceleration);
    } else if (jumps) {
        jump(&m);
    } else if (c->on_ground) {
        walk(&m, acceleration);
    } else if (pl_walker_steers(c, c->slope_side)) {
        steer(&m, in_air);
    }
    c->jump = 0;
    c->air_time = c->on_ground ? 0 : c->air_time + dt;
    return true;
}
