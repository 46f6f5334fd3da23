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

#define IMMOVABLE 1e30 // [kg]

double pl_walker_mass_at(const plumb_world *world, uint32_t row, double px, double py, double dx,
                         double dy)
{
    const pl_bodies *b = &world->bodies;
    const pl_shift arm = pl_wrap_arm(world, row, px, py);
    const double turn = arm.x * dy - arm.y * dx;
    const double inverse = (double)b->inv_mass[row] + (double)b->inv_inertia[row] * turn * turn;
    return inverse > 0 ? 1 / inverse : IMMOVABLE;
}

// [m/s] of the body's point (px, py) along (dx, dy).
static double speed_at(const plumb_world *world, uint32_t row, double px, double py, double dx,
                       double dy)
{
    const pl_bodies *b = &world->bodies;
    const pl_shift arm = pl_wrap_arm(world, row, px, py);
    const double vx = (double)b->vx[row] - (double)b->w[row] * arm.y;
    const double vy = (double)b->vy[row] + (double)b->w[row] * arm.x;
    return vx * dx + vy * dy;
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
    const double v = speed_at(m->world, row, x, y, -t->nx, -t->ny);
    const double mass = pl_walker_mass_at(m->world, row, x, y, t->nx, t->ny);
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

// Times its own weight, at the place that is trod on: what a body bears of a character at once, and however it stands.
#define FIRST_WEIGHT 3.0
#define MOST_WEIGHT  30.0

// [m/s] along gravity, [rad/s] what goes faster is not held by anything.
#define STEADY_SPEED 1.0
#define STEADY_TURN  1.5

// [N] the weight that the body bears at a point (x, y), along gravity. It acts for a whole step, whatever comes of it meanwhile: on what is
// light and gives way it would make any speed, and carry the character with it in the next. So it is no more than
// FIRST_WEIGHT times the body's own and what stood against the last one, MOST_WEIGHT times at most: what bore may let go.
static double weight_on(const pl_walker *m, uint32_t row, double x, double y, double g)
{
    pl_character *c = m->c;
    const pl_bodies *b = &m->world->bodies;
    const double dx = m->gravity_x / g, dy = m->gravity_y / g;
    const double full = m->mass * g, mass = pl_walker_mass_at(m->world, row, x, y, dx, dy);
    const double v = speed_at(m->world, row, x, y, dx, dy);
    double borne = 0;
    if (plumb_same(c->trod, b->entity[row]) && fabs(v) < STEADY_SPEED &&
        fabs((double)b->w[row]) < STEADY_TURN) {
        borne = (double)c->weight - mass * (v - (double)c->weight_speed) / m->dt;
        borne = pl_least(pl_most(borne, 0), (double)c->weight);
    }
    const double own = mass * g;
    const double weight = pl_least(pl_least(borne + FIRST_WEIGHT * own, MOST_WEIGHT * own), full);
    c->trod = b->entity[row];
    c->weight = (real)weight;
    c->weight_speed = (real)v;
    return weight;
}

void pl_walker_weigh(pl_walker *m)
{
    pl_character *c = m->c;
    const pl_bodies *b = &m->world->bodies;
    uint32_t row = c->on_ground ? pl_body_row(m->world, c->ground.body) : PL_NONE;
    if (row == PL_NONE || b->type[row] != PLUMB_DYNAMIC) {
        c->trod = (plumb_body)PLUMB_NULL_INIT;
        return;
    }
    m->world->characters.treads = true;
    // What sleeps under somebody who stands still bears him already.
    const double g = sqrt(m->gravity_x * m->gravity_x + m->gravity_y * m->gravity_y);
    const bool rests = pl_row_slept(m->world, row) && c->speed == 0 && !m->landed;
    if (!rests && g > 0) {
        const double x = (double)c->ground.point.x, y = (double)c->ground.point.y;
        const double share = weight_on(m, row, x, y, g) / g;
        pl_shove_add(m->world, row, share * m->gravity_x, share * m->gravity_y, x, y);
    }
}
