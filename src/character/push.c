// push.c - what a character does to dynamic bodies: it pushes those in its way and weighs on those
// that it stands on.
//
// A push brings the point of contact to the character's speed with the force F = M (u - v) / dt, M
// the effective mass there, as far as push_force allows. Friction of the body works against it during
// the step, so F alone would leave the body slow by what friction takes in a step, the more the longer
// the step. What stood against the last push is therefore added: R = F' - M (v - v') / dt, what was
// pushed less what it did (a disturbance observer; Ohnishi 1987). The body then moves at the
// character's speed whatever the step.
//
// Reads: body columns. Writes: forces, with what they were, so that a refused step can be undone.
// Cost: O(1) a push.
#include "world/island.h"
#include "query/query.h"
#include "character/walker.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <math.h>

// What has fallen asleep in this very step, which was refused, would have been awake now.
void pl_walker_rouse(plumb_world *world, uint32_t row)
{
    if (pl_row_is_asleep(world, row) && pl_row_slept(world, row)) {
        pl_sleep_stir(world, row);
    }
}

// Wakes what sleeps.
void pl_shove_add(plumb_world *world, uint32_t row, double fx, double fy, double px, double py)
{
    pl_bodies *b = &world->bodies;
    pl_shove *pushes = world->characters.pushes.data;
    pushes[world->characters.push_count++] =
        (pl_shove){ b->entity[row], b->fx[row], b->fy[row], b->torque[row] };
    pl_shift arm = pl_wrap_arm(world, row, px, py);
    pl_walker_rouse(world, row);
    b->fx[row] += (real)fx;
    b->fy[row] += (real)fy;
    b->torque[row] += (real)(arm.x * fy - arm.y * fx);
}

void pl_walker_push(pl_walker *m, const pl_touch *t, double speed)
{
    pl_character *c = m->c;
    const pl_bodies *b = &m->world->bodies;
    uint32_t row = t->obstacle->row;
    if (!t->obstacle->is_dynamic || !(m->push_force > 0) || m->pushed || !(speed > 0)) {
        return;
    }
    double x, y;
    pl_walker_touch_point(m, t, &x, &y);
    x += (double)m->start.x, y += (double)m->start.y;
    pl_shift arm = pl_wrap_arm(m->world, row, x, y);
    double rx = arm.x, ry = arm.y;
    double turn = rx * t->ny - ry * t->nx;
    double inverse = (double)b->inv_mass[row] + (double)b->inv_inertia[row] * turn * turn;
    double vx = (double)b->vx[row] - (double)b->w[row] * ry;
    double vy = (double)b->vy[row] + (double)b->w[row] * rx;
    double v = -(vx * t->nx + vy * t->ny), mass = 1 / inverse;
    double resistance = 0;
    if (plumb_same(c->pushed, b->entity[row])) {
        resistance = (double)c->push - mass * (v - (double)c->push_speed) / m->dt;
        resistance = pl_least(pl_most(resistance, 0), m->push_force);
    }
    double force = mass * (speed - v) / m->dt + resistance;
    force = pl_least(pl_most(force, 0), m->push_force);
    c->pushed = b->entity[row];
    c->push = (real)force;
    c->push_speed = (real)v;
    m->pushed = true;
    pl_shove_add(m->world, row, -force * t->nx, -force * t->ny, x, y);
}

void pl_walker_weigh(pl_walker *m)
{
    pl_character *c = m->c;
    const pl_bodies *b = &m->world->bodies;
    uint32_t row = c->on_ground ? pl_body_row(m->world, c->ground.body) : PL_NONE;
    if (row == PL_NONE || b->type[row] != PLUMB_DYNAMIC) {
        return;
    }
    m->world->characters.treads = true;
    // What sleeps under somebody who stands still bears him already.
    bool rests = pl_row_slept(m->world, row) && c->speed == 0 && !m->landed;
    if (!rests) {
        pl_shove_add(m->world, row, m->mass * m->gravity_x, m->mass * m->gravity_y,
                     (double)c->ground.point.x, (double)c->ground.point.y);
    }
}
