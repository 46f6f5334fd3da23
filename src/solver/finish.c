// finish.c - what the step did, written into the columns: moved bodies, free flight, kinematic
// motion.
//
// A body in no contact flies freely: x += v dt + a dt^2 / 2, the exact parabola, once for the whole
// step. Rotations turn by the exact angle. Bodies that moved farther than their slack are noted for the
// continuous pass, with where they came from. W rows at a time go through lanes where all are plain (finish.simd.c).
//
// Reads: solver bodies, forces. Writes: transforms, velocities, poses, movers; clears forces. Cost: O(dynamic and
// kinematic bodies).
#include "solver/finish.h"

#include "effects/effects.h"
#include "effects/laws.h"
#include "plumb/math.h"
#include "world/body_settings.h"
#include "world/flight.h"
#include "world/marks.h"

#include <string.h>

static real noticed(real speed)
{
    return plumb_abs(speed) > PL_NO_SPEED ? speed : 0;
}

// Returns the angle by which the body turned.
static real fly(plumb_world *world, uint32_t row, real dt)
{
    pl_bodies *b = &world->bodies;
    real gravity = b->gravity_scale[row];
    real ax = world->effects.gravity.x * gravity + b->fx[row] * b->inv_mass[row];
    real ay = world->effects.gravity.y * gravity + b->fy[row] * b->inv_mass[row];
    real aw = b->torque[row] * b->inv_inertia[row];
    // The large and the small part of the way apart: v + a dt / 2 would round the same way every
    // step.
    pl_add(&b->center_x[row], &b->residual_x[row], dt * (b->residual_vx[row] + ax * dt / 2));
    pl_add(&b->center_y[row], &b->residual_y[row], dt * (b->residual_vy[row] + ay * dt / 2));
    pl_add(&b->center_x[row], &b->residual_x[row], dt * b->vx[row]);
    pl_add(&b->center_y[row], &b->residual_y[row], dt * b->vy[row]);
    real angle = dt * (b->w[row] + aw * dt / 2);
    pl_turn(b, row, angle);
    pl_add(&b->vx[row], &b->residual_vx[row], ax * dt);
    pl_add(&b->vy[row], &b->residual_vy[row], ay * dt);
    b->w[row] += aw * dt;
    return angle;
}

// The large part of a change, then what rounding to a real takes from it.
static void add_exactly(real *value, real *low, double change)
{
    real large = (real)change;
    pl_add(value, low, (real)(change - (double)large));
    pl_add(value, low, large);
}

static real take_flight(plumb_world *world, uint32_t row, pl_flight f)
{
    pl_bodies *b = &world->bodies;
    add_exactly(&b->center_x[row], &b->residual_x[row], f.x);
    add_exactly(&b->center_y[row], &b->residual_y[row], f.y);
    pl_turn(b, row, (real)f.angle);
    add_exactly(&b->vx[row], &b->residual_vx[row], f.vx);
    add_exactly(&b->vy[row], &b->residual_vy[row], f.vy);
    b->w[row] = (real)((double)b->w[row] + f.w);
    return (real)f.angle;
}

// The same for a body that has locked axes, damping, caps or a time of its own.
static real fly_with_effects(plumb_world *world, uint32_t row, real dt)
{
    return take_flight(world, row, pl_effects_fly(world, row, dt));
}

typedef struct where {
    real x, y, c, s;
} where;

static bool is_sane(real v)
{
    return v >= -PL_LARGEST && v <= PL_LARGEST; // false for NaN
}

// A body whose points may have moved farther than its slack is noted for the continuous pass. Returns
// how many were.
static inline uint32_t note_if_fast(const plumb_world *world, uint32_t row, where before,
                                    real angle, pl_mover *out)
{
    const pl_bodies *b = &world->bodies;
    real moved = plumb_abs(b->center_x[row] - before.x) + plumb_abs(b->center_y[row] - before.y) +
                 plumb_abs(angle) * b->extent[row];
    if (!(moved > b->slack[row])) {
        return 0;
    }
    *out = (pl_mover){ .row = row,
                       .x = before.x,
                       .y = before.y,
                       .c = before.c,
                       .s = before.s,
                       .angle = angle,
                       .moved = moved,
                       .stop = 1 };
    return 1;
}

// A step that would leave a body's state without meaning is undone for that body: it stays where it was,
// at rest, and is marked to be counted and told. NaN never gets into the columns.
static bool arrest_if_lost(plumb_world *world, uint32_t row, where before)
{
    pl_bodies *b = &world->bodies;
    if (is_sane(b->center_x[row]) && is_sane(b->center_y[row]) && is_sane(b->c[row]) &&
        is_sane(b->s[row]) && is_sane(b->vx[row]) && is_sane(b->vy[row]) && is_sane(b->w[row])) {
        return false;
    }
    b->center_x[row] = before.x, b->center_y[row] = before.y;
    b->c[row] = before.c, b->s[row] = before.s;
    b->vx[row] = b->vy[row] = b->w[row] = 0;
    b->residual_x[row] = b->residual_y[row] = b->residual_vx[row] = b->residual_vy[row] = 0;
    b->flags[row] |= PL_BODY_LOST;
    return true;
}

static void tell_lost(plumb_world *world)
{
    const pl_bodies *b = &world->bodies;
    for (uint32_t row = 0; row < world->dynamic_count + world->kinematic_count; ++row) {
        if ((b->flags[row] & PL_BODY_LOST) != 0) {
            pl_quarantine_note_lost(world, row);
        }
    }
}

// The new state of a dynamic body in a contact.
static void take_over(plumb_world *world, uint32_t row, const pl_solver_body *body,
                      const near_real *low)
{
    pl_bodies *b = &world->bodies;
    pl_add(&b->center_x[row], &b->residual_x[row], body->dx);
    pl_add(&b->center_y[row], &b->residual_y[row], body->dy);
    pl_turn(b, row, body->da);
    b->vx[row] = noticed(body->vx);
    b->vy[row] = noticed(body->vy);
    b->w[row] = noticed(body->w);
    const bool kept = low != NULL && low[3] != 0;
    b->residual_vx[row] = kept ? low[0] : 0;
    b->residual_vy[row] = kept ? low[1] : 0;
}

// Of a world in which some fly where laws lead them. Not inlined: the others fly as they did.
static __attribute__((noinline)) bool took_orbit(const pl_finish *p, uint32_t row, real *angle)
{
    const bool orbits = pl_law_way_of(p->world, row) == PL_LAW_FLIES;
    *angle = orbits ? take_flight(p->world, row, *pl_orbit_of(p->world, row)) : 0;
    return orbits;
}

// Moves a dynamic body; returns the angle by which it turned.
static real move_dynamic(const pl_finish *p, uint32_t row)
{
    plumb_world *world = p->world;
    const bool has_effects = (world->bodies.flags[row] & PL_BODY_HAS_EFFECTS) != 0;
    const uint32_t slot = p->collided ? ((const uint32_t *)world->solver.slots.data)[row] : PL_NONE;
    if (slot == PL_NONE) {
        real angle;
        if (p->orbits && took_orbit(p, row, &angle)) {
            return angle;
        }
        const pl_damping_decay *decay =
            has_effects ? pl_damping_alone(&world->effects, &world->bodies, row) : NULL;
        return decay != NULL ? pl_damping_fly(world, row, decay)
               : has_effects ? fly_with_effects(world, row, p->dt)
                             : fly(world, row, p->dt);
    }
    const bool taken = has_effects && world->effects.taken;
    if (taken && !(pl_time_scale(world, row) > 0)) {
        return 0;
    }
    const pl_solver_body *body = &pl_solver_bodies(&world->solver)[slot];
    take_over(world, row, body, p->residuals == NULL ? NULL : &p->residuals[(size_t)slot * 4]);
    if (taken) {
        pl_effects_take_over(world, row);
    }
    return body->da;
}

static real move_kinematic(const pl_finish *p, uint32_t row)
{
    pl_bodies *b = &p->world->bodies;
    bool has_settings = (b->flags[row] & PL_BODY_HAS_SETTINGS) != 0;
    real time = has_settings ? p->dt * pl_time_scale(p->world, row) : p->dt;
    pl_add(&b->center_x[row], &b->residual_x[row], time * b->vx[row]);
    pl_add(&b->center_y[row], &b->residual_y[row], time * b->vy[row]);
    pl_turn(b, row, time * b->w[row]);
    return time * b->w[row];
}

// One row; movers are noted behind the `count` that there are. Returns whether it was lost.
static bool move_row(const pl_finish *p, uint32_t row, pl_mover *movers, uint32_t *count)
{
    plumb_world *world = p->world;
    pl_bodies *b = &world->bodies;
    const where before = { b->center_x[row], b->center_y[row], b->c[row], b->s[row] };
    real angle;
    if (row < world->dynamic_count) {
        angle = move_dynamic(p, row);
        b->fx[row] = b->fy[row] = b->torque[row] = 0;
    } else {
        angle = move_kinematic(p, row);
    }
    const bool lost = arrest_if_lost(world, row, before);
    pl_body_update_origin(world, row);
    if (p->noting) {
        *count += note_if_fast(world, row, before, angle, &movers[*count]);
    }
    return lost;
}

static void move_share(void *context, uint32_t i)
{
    pl_finish *p = context;
    plumb_world *world = p->world;
    const pl_share rows = pl_share_of(world->dynamic_count + world->kinematic_count, p->shares, i);
    const pl_contact_kernels *kernels = pl_solver_kernels(world);
    const uint32_t width = (uint32_t)kernels->width;
    pl_mover *movers = p->noting ? pl_movers(&world->continuous) + rows.first : NULL;
    uint32_t count = 0;
    bool lost = false;
    for (uint32_t row = rows.first; row < rows.end;) {
        const uint32_t end = row + width;
        if (!p->orbits && end <= rows.end && end <= world->dynamic_count &&
            kernels->place(p, row, movers, &count)) {
            row = end;
            continue;
        }
        for (uint32_t last = end < rows.end ? end : rows.end; row < last; ++row) {
            lost |= move_row(p, row, movers, &count);
        }
    }
    p->made[i].count = count;
    p->made[i].lost = lost;
}

// Movers in order of rows, without gaps.
static void close_up(pl_finish *p)
{
    pl_continuous *c = &p->world->continuous;
    const uint32_t rows = p->world->dynamic_count + p->world->kinematic_count;
    for (uint32_t i = 0; i < p->shares; ++i) {
        uint32_t first = pl_share_of(rows, p->shares, i).first;
        if (first != c->count && p->made[i].count > 0) {
            memmove(pl_movers(c) + c->count, pl_movers(c) + first,
                    p->made[i].count * sizeof(pl_mover));
        }
        c->count += p->made[i].count;
    }
}

void pl_solver_finish(plumb_world *world, real dt)
{
    const uint32_t rows = world->dynamic_count + world->kinematic_count;
    pl_finish p = { .world = world,
                    .dt = dt,
                    .collided = world->solver.slot_count > 0,
                    .noting = world->continuous.noting,
                    .orbits = world->laws.step.flies,
                    .residuals =
                        world->solver.follows_impacts ? world->solver.residuals.data : NULL,
                    .shares = pl_tasks_share_count(world->tasks, rows, PL_BODIES_SHARED) };
    pl_tasks_run(world->tasks, move_share, &p, p.shares);
    bool lost = false;
    for (uint32_t i = 0; i < p.shares; ++i) {
        lost |= p.made[i].lost;
    }
    if (lost) {
        tell_lost(world);
    }
    if (p.noting) {
        close_up(&p);
    }
}
