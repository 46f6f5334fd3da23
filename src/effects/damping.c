// damping.c - velocities that decay: dv/dt = a - c v.
//
// Over h with a constant, v(h) = v E + a h M, E = exp(-c h), M = (1 - E) / (c h). As a row of the substep this is the
// acceleration (v(h) - v) / h = a M - v (1 - E) / h, so that velocities are exact for any h where nothing touches;
// places are off by (c h)^2 / 12 of the way. In free flight the way is exact as well (flight.c).
//
// The two factors of a body stay as they are while nothing is set: they are kept beside its record. A substep is then
// one pass over a packed list of slots, a quad a body, cluster by cluster of islands. (Before, each body and substep had
// exponentials of its own, in double, and all damped bodies were one cluster: 122 ns a body and step.) Factors are
// rounded to near_real, which is why damped bodies have other bits than then.
//
// Reads: settings, solver bodies. Writes: accelerations. Order: behind other effects, whose accelerations are damped
// too. Cost: O(damped bodies) a substep.

#include "math/decay.h"
#include "effects/effects.h"
#include "core/quad.h"
#include "world/flight.h"
#include "world/substep.h"
#include "world/state.h"

#include <math.h>

// Of a record.
typedef struct pl_damping_factors {
    pl_near_quad drop; // [1/s] (1 - E) / h of vx, vy, w; 0
    pl_near_quad mean; // [-] M of ax, ay, aw; 1
} pl_damping_factors;

typedef struct pl_damper {
    uint32_t slot, record;
} pl_damper;

static const pl_body_settings *settings(const plumb_world *world)
{
    return world->settings.items.data;
}

static pl_decay_step step_of(const pl_decay *d, double time)
{
    const double way = time * d->mean;
    return (pl_decay_step){ .way = (real)way,
                            .way_low = (real)(way - (double)(real)way),
                            .way_of_a = (real)(time * time * d->twice),
                            .drop = (real)(1 - d->left) };
}

// [1/s] Where there is drag besides, both are one equation (drag.c).
static real linear_of(const pl_body_settings *t)
{
    return t->drag > 0 ? 0 : t->damping;
}

static pl_damping_decay decay_of(const pl_body_settings *t, real dt, real h)
{
    const double own = (double)t->time_scale, step = own * (double)dt,
                 sub = (double)(t->time_scale * h);
    const pl_decay linear = pl_decay_of((double)linear_of(t) * sub);
    const pl_decay turn = pl_decay_of((double)t->angular_damping * sub);
    const pl_decay flight = pl_decay_of((double)linear_of(t) * step);
    const pl_decay flight_turn = pl_decay_of((double)t->angular_damping * step);
    return (pl_damping_decay){ .damping = linear_of(t),
                               .angular_damping = t->angular_damping,
                               .time_scale = t->time_scale,
                               .dt = dt,
                               .h = h,
                               .step = step_of(&flight, step),
                               .turn = step_of(&flight_turn, step),
                               .flight = flight,
                               .flight_turn = flight_turn,
                               .drop = (near_real)((1 - linear.left) / (double)h),
                               .drop_turn = (near_real)((1 - turn.left) / (double)h),
                               .mean = (near_real)linear.mean,
                               .mean_turn = (near_real)turn.mean };
}

static bool is_of(const pl_damping_decay *d, const pl_body_settings *t, real dt, real h)
{
    return d->damping == linear_of(t) && d->angular_damping == t->angular_damping &&
           d->time_scale == t->time_scale && d->dt == dt && d->h == h;
}

// Those that are not what they were; as a rule bodies beside one another are damped alike.
static void refresh_decays(plumb_world *world, uint32_t known, real dt)
{
    const real h = (real)(near_real)(dt / (real)world->desc.substeps);
    pl_damping_decay *decays = world->effects.decays.data;
    pl_damping_factors *factors = world->effects.factors.data;
    pl_damping_decay last = { .h = 0 };
    if (!world->effects.decays_stale && known == world->settings.count && known > 0 &&
        decays[0].dt == dt && decays[0].h == h) {
        return;
    }
    world->effects.decays_stale = false;
    for (uint32_t i = 0; i < world->settings.count; ++i) {
        const pl_body_settings *t = &settings(world)[i];
        if (i < known && is_of(&decays[i], t, dt, h)) {
            continue;
        }
        last = is_of(&last, t, dt, h) ? last : decay_of(t, dt, h);
        decays[i] = last;
    }
    for (uint32_t i = 0; i < world->settings.count; ++i) {
        const pl_body_settings *t = &settings(world)[i];
        const bool capped = world->effects.caps && (t->max_speed > 0 || t->max_spin > 0);
        decays[i].alone = t->time_scale == 1 && !capped;
        const pl_damping_decay *d = &decays[i];
        factors[i] = (pl_damping_factors){ .drop = { d->drop, d->drop, d->drop_turn, 0 },
                                           .mean = { d->mean, d->mean, d->mean_turn, 1 } };
    }
}

bool pl_damping_find(plumb_world *world, real dt)
{
    pl_effects *e = &world->effects;
    const pl_solver *s = &world->solver;
    const uint32_t known = (uint32_t)(e->decays.size / sizeof(pl_damping_decay));
    const uint32_t slots = s->slot_count > 0 ? s->dynamic_slots : 0;
    const size_t count = world->settings.count;
    if (!pl_buffer_reserve(&world->memory, &e->decays, count * sizeof(pl_damping_decay)) ||
        !pl_buffer_reserve(&world->memory, &e->factors, count * sizeof(pl_damping_factors)) ||
        !pl_buffer_reserve(&world->memory, &e->dampers, count * sizeof(pl_damper))) {
        return false;
    }
    refresh_decays(world, e->decay_count < known ? e->decay_count : known, dt);
    e->decay_count = world->settings.count;
    const uint32_t *rows = s->rows.data, *records = world->bodies.settings;
    pl_damper *dampers = e->dampers.data;
    e->damper_count = 0;
    for (uint32_t slot = 0; slot < slots; ++slot) {
        const uint32_t record = records[rows[slot]];
        if (record == 0) {
            continue;
        }
        const pl_body_settings *t = &settings(world)[record - 1];
        if ((linear_of(t) > 0 || t->angular_damping > 0) && t->time_scale > 0) {
            dampers[e->damper_count++] = (pl_damper){ slot, record - 1 };
        }
    }
    return true;
}

typedef struct passage {
    const pl_damper *dampers;
    const pl_damping_factors *factors;
    const pl_near_quad *bodies;
    const pl_near_quad *from; // accelerations, `stride` quads from one slot to the next
    size_t stride;
    pl_near_quad *motions;
    double h;  // [s] substep of the world
    int finer; // substeps of the cluster in place of one
} passage;

// What is lost in a substep of h is lost in `finer` shorter ones, a power of two of them.
static pl_damping_factors in_finer(const pl_damping_factors *f, double h, int finer)
{
    pl_damping_factors out = *f;
    for (int k = 0; k < 3; ++k) {
        const double lost = (double)f->drop[k] * h;
        double left = 1 - lost;
        for (int n = finer; n > 1; n /= 2) {
            left = sqrt(left);
        }
        const near_real ratio = lost > 0 ? (near_real)((1 - left) * finer / lost) : 1;
        out.drop[k] *= ratio;
        out.mean[k] *= ratio;
    }
    return out;
}

// a = a M - v (1 - E) / h.
static void damp(void *context, uint32_t first, uint32_t count)
{
    const passage p = *(const passage *)context;
    for (uint32_t i = first; i < first + count; ++i) {
        const size_t slot = p.dampers[i].slot;
        const pl_damping_factors *own = &p.factors[p.dampers[i].record];
        const pl_damping_factors f = p.finer > 1 ? in_finer(own, p.h, p.finer) : *own;
        p.motions[2 * slot] = p.from[p.stride * slot] * f.mean - p.bodies[2 * slot] * f.drop;
    }
}

void pl_damping_row(pl_substep *s)
{
    const plumb_world *world = s->world;
    const pl_effects *e = &world->effects;
    const pl_share mine = pl_substep_share(e->dampers.data, sizeof(pl_damper),
                                           offsetof(pl_damper, slot), e->damper_count, s);
    passage p = { .dampers = (const pl_damper *)e->dampers.data + mine.first,
                  .bodies = (const pl_near_quad *)(const void *)pl_solver_bodies(&world->solver),
                  .motions = (pl_near_quad *)(void *)pl_solver_motions(&world->solver) };
    p.factors = e->factors.data;
    p.finer = s->finer;
    p.h = (double)s->h * p.finer;
    // Where nothing else acts in the substeps, no row has reset them.
    p.from = e->resets ? p.motions : e->bases.data;
    p.stride = e->resets ? 2 : 1;
    pl_tasks_ranges(s->tasks, mine.end - mine.first, PL_BODIES_SHARED, damp, &p);
}

//---- free flight ---------------------------------------------------------------------------------

// As an undamped body flies (solver/finish.c): large and small parts apart, so that they do not round the same way
// every step.
static void fly_axis(real *x, real *residual_x, real *v, real *low_v, real a,
                     const pl_decay_step *d)
{
    const real before = *v, low = *low_v;
    pl_add(x, residual_x, before * d->way_low + (low * d->way + a * d->way_of_a));
    pl_add(x, residual_x, before * d->way);
    pl_add(v, low_v, a * d->way - (before * d->drop + low * d->drop));
}

real pl_damping_fly(plumb_world *world, uint32_t row, const pl_damping_decay *decay)
{
    pl_bodies *b = &world->bodies;
    const plumb_vec2 g = world->effects.gravity;
    const real scale = b->gravity_scale[row], im = b->inv_mass[row];
    const real aw = b->torque[row] * b->inv_inertia[row], w = b->w[row];
    fly_axis(&b->center_x[row], &b->residual_x[row], &b->vx[row], &b->residual_vx[row],
             g.x * scale + b->fx[row] * im, &decay->step);
    fly_axis(&b->center_y[row], &b->residual_y[row], &b->vy[row], &b->residual_vy[row],
             g.y * scale + b->fy[row] * im, &decay->step);
    const real angle = w * decay->turn.way + aw * decay->turn.way_of_a;
    pl_turn(b, row, angle);
    b->w[row] = w + (aw * decay->turn.way - w * decay->turn.drop);
    return angle;
}
