// finish.c - what the step did, written into the columns: moved bodies, free flight, kinematic
// motion.
//
// A body in no contact flies freely: x += v dt + a dt^2 / 2, the exact parabola, once for the whole
// step. Rotations turn by the exact angle. Bodies that moved farther than their slack are noted for the
// continuous pass, with where they came from. Reads: solver bodies, forces. Writes: transforms,
// velocities, poses, movers; clears forces. Cost: O(dynamic and kinematic bodies).
#include "plumb/math.h"
#include "world/state.h"

// What is left of a motion that contacts and joints have damped away halves and halves until it is
// subnormal, and then costs hundreds of cycles wherever it is multiplied. Less than this counts as none:
// a turn [rad] that moves no coordinate, and a speed [m/s, rad/s].
#if defined(PLUMB_DOUBLE) && PLUMB_DOUBLE
#define NO_TURN  1e-100
#define NO_SPEED 1e-150
#else
#define NO_TURN  1e-12f
#define NO_SPEED 1e-20f
#endif

static real noticed(real speed)
{
    return plumb_abs(speed) > NO_SPEED ? speed : 0;
}

static void turn(pl_bodies *b, uint32_t row, real angle)
{
    if (plumb_abs(angle) > NO_TURN) {
        plumb_rot q = plumb_rot_integrate((plumb_rot){ b->c[row], b->s[row] }, angle);
        b->c[row] = q.c;
        b->s[row] = q.s;
    }
}

// Adds to a value and keeps what rounding takes away for the next time (compensated summation, in
// double). Without it, an elastic ball drifts by 2e-7 of its energy a bounce in the float library.
static void add(real *value, real *low, real change)
{
    double wanted = (double)*value + ((double)change + (double)*low);
    *value = (real)wanted;
    *low = (real)(wanted - (double)*value);
}

// Returns the angle by which the body turned.
static real fly(plumb_world *world, uint32_t row, real dt)
{
    pl_bodies *b = &world->bodies;
    real gravity = b->gravity_scale[row];
    real ax = world->gravity.x * gravity + b->fx[row] * b->inv_mass[row];
    real ay = world->gravity.y * gravity + b->fy[row] * b->inv_mass[row];
    real aw = b->torque[row] * b->inv_inertia[row];
    // The large and the small part of the way apart: v + a dt / 2 would round the same way every
    // step.
    add(&b->center_x[row], &b->low_x[row], dt * (b->low_vx[row] + ax * dt / 2));
    add(&b->center_y[row], &b->low_y[row], dt * (b->low_vy[row] + ay * dt / 2));
    add(&b->center_x[row], &b->low_x[row], dt * b->vx[row]);
    add(&b->center_y[row], &b->low_y[row], dt * b->vy[row]);
    real angle = dt * (b->w[row] + aw * dt / 2);
    turn(b, row, angle);
    add(&b->vx[row], &b->low_vx[row], ax * dt);
    add(&b->vy[row], &b->low_vy[row], ay * dt);
    b->w[row] += aw * dt;
    return angle;
}

// The large part of a change, then what rounding to a real takes from it.
static void add_exactly(real *value, real *low, double change)
{
    real large = (real)change;
    add(value, low, (real)(change - (double)large));
    add(value, low, large);
}

// The same for a body that has locked axes, damping, caps or a time of its own.
static real fly_oddly(plumb_world *world, uint32_t row, real dt)
{
    pl_bodies *b = &world->bodies;
    pl_flight f = pl_effects_fly(world, row, dt);
    add_exactly(&b->center_x[row], &b->low_x[row], f.x);
    add_exactly(&b->center_y[row], &b->low_y[row], f.y);
    turn(b, row, (real)f.angle);
    add_exactly(&b->vx[row], &b->low_vx[row], f.vx);
    add_exactly(&b->vy[row], &b->low_vy[row], f.vy);
    b->w[row] = (real)((double)b->w[row] + f.w);
    return (real)f.angle;
}

typedef struct where {
    real x, y, c, s;
} where;

static bool is_sane(real v)
{
    return v >= -PL_LARGEST && v <= PL_LARGEST; // false for NaN
}

// A body whose points may have moved farther than its slack is noted for the continuous pass.
static inline void note_if_fast(plumb_world *world, uint32_t row, where before, real angle)
{
    const pl_bodies *b = &world->bodies;
    real moved = plumb_abs(b->center_x[row] - before.x) + plumb_abs(b->center_y[row] - before.y) +
                 plumb_abs(angle) * b->extent[row];
    if (moved > b->slack[row]) {
        pl_movers(&world->continuous)[world->continuous.count++] = (pl_mover){ .row = row,
                                                                               .x = before.x,
                                                                               .y = before.y,
                                                                               .c = before.c,
                                                                               .s = before.s,
                                                                               .angle = angle,
                                                                               .moved = moved,
                                                                               .stop = 1 };
    }
}

// A step that would leave a body's state without meaning is undone for that body: it stays where it was,
// at rest, and the world counts and tells it. NaN never gets into the columns.
static void arrest_if_lost(plumb_world *world, uint32_t row, where before)
{
    pl_bodies *b = &world->bodies;
    if (is_sane(b->center_x[row]) && is_sane(b->center_y[row]) && is_sane(b->c[row]) &&
        is_sane(b->s[row]) && is_sane(b->vx[row]) && is_sane(b->vy[row]) && is_sane(b->w[row])) {
        return;
    }
    b->center_x[row] = before.x, b->center_y[row] = before.y;
    b->c[row] = before.c, b->s[row] = before.s;
    b->vx[row] = b->vy[row] = b->w[row] = 0;
    b->low_x[row] = b->low_y[row] = b->low_vx[row] = b->low_vy[row] = 0;
    ++world->arrested_count;
    pl_warn(world, "body %u was stopped: the step would have left it without a finite state",
            b->entity[row].index);
}

// The new state of a dynamic body in a contact.
static void take_over(plumb_world *world, uint32_t row, const pl_solver_body *body, const real *low)
{
    pl_bodies *b = &world->bodies;
    add(&b->center_x[row], &b->low_x[row], body->dx);
    add(&b->center_y[row], &b->low_y[row], body->dy);
    turn(b, row, body->da);
    b->vx[row] = noticed(body->vx);
    b->vy[row] = noticed(body->vy);
    b->w[row] = noticed(body->w);
    b->low_vx[row] = low == NULL ? 0 : low[0];
    b->low_vy[row] = low == NULL ? 0 : low[1];
}

void pl_solver_finish(plumb_world *world, real dt)
{
    pl_bodies *b = &world->bodies;
    const pl_solver_body *bodies = pl_solver_bodies(&world->solver);
    const uint32_t *slots = world->solver.slots.data;
    const bool collided = world->solver.slot_count > 0; // the graph was made in this step
    const bool noting = world->continuous.noting;
    const real *lows = world->narrow.any_bounce ? world->solver.lows.data : NULL;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        where before = { b->center_x[row], b->center_y[row], b->c[row], b->s[row] };
        bool odd = (b->flags[row] & PL_BODY_ODD) != 0;
        real angle = 0;
        if ((!collided || slots[row] == PL_NONE) && odd) {
            angle = fly_oddly(world, row, dt);
        } else if (!collided || slots[row] == PL_NONE) {
            angle = fly(world, row, dt);
        } else if (!odd || pl_time_scale(world, row) > 0) {
            uint32_t slot = slots[row];
            angle = bodies[slot].da;
            take_over(world, row, &bodies[slot], lows == NULL ? NULL : &lows[(size_t)slot * 4]);
            if (odd) {
                pl_effects_take_over(world, row);
            }
        }
        b->fx[row] = b->fy[row] = b->torque[row] = 0;
        arrest_if_lost(world, row, before);
        pl_body_update_origin(world, row);
        if (noting) {
            note_if_fast(world, row, before, angle);
        }
    }
    for (uint32_t row = world->dynamic_count; row < world->dynamic_count + world->kinematic_count;
         ++row) {
        where before = { b->center_x[row], b->center_y[row], b->c[row], b->s[row] };
        real time = (b->flags[row] & PL_BODY_TUNED) != 0 ? dt * pl_time_scale(world, row) : dt;
        add(&b->center_x[row], &b->low_x[row], time * b->vx[row]);
        add(&b->center_y[row], &b->low_y[row], time * b->vy[row]);
        turn(b, row, time * b->w[row]);
        arrest_if_lost(world, row, before);
        pl_body_update_origin(world, row);
        if (noting) {
            note_if_fast(world, row, before, time * b->w[row]);
        }
    }
}
