// engine.c - engines that burn fuel: thrust at a point of a body, whose mass falls by what leaves with the exhaust.
//
// A thrust F of exhaust speed u burns F / u a second. From m0 to m1 it gives u ln(m0 / m1) (Tsiolkovsky 1903), whatever
// the step; in a substep that is a velocity over h, along the direction in its middle. The fuel may end within it: what is left
// burns. The inertia is in proportion to the mass, and the centre of mass stays, so the torque r x F gives r x d m / I of
// that. Over a step contacts, joints and forces meet the mean mass (m0 - m1) / ln(m0 / m1), by which F dt is what is given: of
// second order. Mass and fuel change as the step ends, with what rounding took from them kept: a real of six digits
// would not see a gram of a ton.
//
// The logarithm is 2 atanh((m0 - m1) / (m0 + m1)) by its series, of square roots until they are near 1: the same bits everywhere.
//
// Reads: settings, solver bodies. Writes: solver bodies, accelerations; masses, settings as a step ends. Order: behind
// fluids, before drag. Cost: O(engines) a substep; the solver moves their bodies.
#include "effects/engine.h"

#include "math/trig.h"
#include "plumb/math.h"
#include "schema/passes.h"
#include "world/rows.h"
#include "world/body_settings.h"

#include <math.h>

typedef struct pl_engine {
    uint32_t slot, row;
    plumb_body body;        // rows move before the step ends
    double mass, fuel;      // [kg] as the step begins
    double rate;            // [kg/s] of the body's own time; 0: it burns nothing
    double thrust, exhaust; // [N], [m/s]
    double dx, dy, arm;     // direction in the body's frame; [m] lever arm
    double ratio;           // [1/m^2] mass over inertia; 0: it does not turn
    double time;            // [-] time scale
    double share;           // [-] mass over mass with what fluids lend
    double burnt;           // [kg] in the step
} pl_engine;

static pl_body_settings *settings(const plumb_world *world)
{
    return world->settings.items.data;
}

bool pl_want_engines(const plumb_world *world, const char **reason)
{
    const bool wanted = world->settings.engines > 0;
    *reason = wanted ? "some body has thrust" : "no body has thrust";
    return wanted;
}

// With nothing but fuel left there is nobody to be pushed.
bool pl_engine_acts_on(const plumb_world *world, uint32_t row)
{
    const uint32_t record = world->bodies.settings[row];
    const pl_body_settings *t = record == 0 ? NULL : &settings(world)[record - 1];
    return t != NULL && t->thrust > 0 && t->time_scale > 0 && world->bodies.inv_mass[row] > 0 &&
           (t->exhaust == 0 || (t->fuel > 0 && t->fuel < world->bodies.mass[row]));
}

// ln(from / to), from >= to > 0.
static double log_ratio(double from, double to)
{
    double ratio = from / to, times = 2, sum = 0, power;
    double x = (from - to) / (from + to);
    for (; ratio > 1.3; times *= 2) {
        ratio = sqrt(ratio);
        x = (ratio - 1) / (ratio + 1);
    }
    power = x;
    for (int i = 1; i < 24; i += 2) {
        sum += power / i;
        power *= x * x;
    }
    return times * sum;
}

static double burnt_by(const pl_engine *e, double time)
{
    const double all = e->rate * time * e->time;
    return all < e->fuel ? all : e->fuel;
}

// A residual of what it belongs to; what a call has set anew, or an image brings, may have another one.
static double with_low(real value, real low)
{
    return plumb_abs(low) <= value * PLUMB_REAL_EPSILON ? (double)value + (double)low
                                                        : (double)value;
}

static pl_engine engine_of(const plumb_world *world, uint32_t slot, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    const pl_body_settings *t = &settings(world)[b->settings[row] - 1];
    pl_engine e = { .slot = slot,
                    .row = row,
                    .body = b->entity[row],
                    .mass = with_low(b->mass[row], t->mass_low),
                    .fuel = with_low(t->fuel, t->fuel_low),
                    .rate = t->exhaust > 0 ? (double)t->thrust / (double)t->exhaust : 0,
                    .thrust = (double)t->thrust,
                    .exhaust = (double)t->exhaust,
                    .ratio = (double)b->mass[row] * (double)b->inv_inertia[row],
                    .time = (double)t->time_scale,
                    .share = 1 };
    pl_sincos((double)t->thrust_angle, &e.dy, &e.dx);
    e.arm = ((double)t->thrust_x - (double)b->local_x[row]) * e.dy -
            ((double)t->thrust_y - (double)b->local_y[row]) * e.dx;
    return e;
}

// The solver meets the mean mass of the step, besides what fluids lend.
static void weigh(plumb_world *world, pl_engine *e)
{
    pl_solver_body *body = &pl_solver_bodies(&world->solver)[e->slot];
    pl_solver_motion *motion = &pl_solver_motions(&world->solver)[e->slot];
    const pl_bodies *b = &world->bodies;
    const double mean = e->burnt > 0 ? e->burnt / log_ratio(e->mass, e->mass - e->burnt) : e->mass;
    const double square = e->time * e->time;
    const double lent = square / (double)body->inv_mass - (double)b->mass[e->row];
    const double more = square * (1 / mean - (double)b->inv_mass[e->row]);
    const double turn = (double)b->mass[e->row] / mean;
    e->share = mean / (mean + (lent > 0 ? lent : 0));
    body->inv_mass = motion->inv_mass = (near_real)(square * e->share / mean);
    motion->ax += (near_real)(more * (double)b->fx[e->row]);
    motion->ay += (near_real)(more * (double)b->fy[e->row]);
    motion->aw +=
        (near_real)(square * (turn - 1) * (double)(b->torque[e->row] * b->inv_inertia[e->row]));
    body->inv_inertia *= (near_real)turn;
}

bool pl_engines_find(plumb_world *world, real dt)
{
    pl_effects *e = &world->effects;
    const pl_solver *s = &world->solver;
    const uint32_t slots = s->slot_count > 0 ? s->dynamic_slots : 0;
    const uint32_t *rows = s->rows.data;
    e->engine_count = 0;
    if (!pl_buffer_reserve(&world->memory, &e->engines,
                           (size_t)world->settings.count * sizeof(pl_engine))) {
        return false;
    }
    for (uint32_t slot = 0; slot < slots; ++slot) {
        if (!pl_engine_acts_on(world, rows[slot])) {
            continue;
        }
        pl_engine *item = &((pl_engine *)e->engines.data)[e->engine_count++];
        *item = engine_of(world, slot, rows[slot]);
        item->burnt = burnt_by(item, (double)dt);
        weigh(world, item);
    }
    return true;
}

//---- the row -------------------------------------------------------------------------------------

static void push(const plumb_world *world, const pl_engine *e, double from, double h)
{
    const pl_bodies *b = &world->bodies;
    const pl_solver_body *body = &pl_solver_bodies(&world->solver)[e->slot];
    pl_solver_motion *motion = &pl_solver_motions(&world->solver)[e->slot];
    const double before = e->mass - burnt_by(e, from), after = e->mass - burnt_by(e, from + h);
    // [m/s^2] of the world's time.
    const double speed =
        e->rate > 0 ? e->exhaust * log_ratio(before, after) : e->thrust / e->mass * h * e->time;
    const double a = e->time * speed / h;
    double s, c;
    pl_sincos((double)body->da + h / 2 * (double)body->w, &s, &c);
    const double x = c * e->dx - s * e->dy, y = s * e->dx + c * e->dy;
    const double bc = (double)b->c[e->row], bs = (double)b->s[e->row];
    const uint32_t flags = b->flags[e->row];
    if ((flags & PL_BODY_LOCK_X) == 0) {
        motion->ax += (near_real)(a * e->share * (bc * x - bs * y));
    }
    if ((flags & PL_BODY_LOCK_Y) == 0) {
        motion->ay += (near_real)(a * e->share * (bs * x + bc * y));
    }
    motion->aw += (near_real)(a * e->ratio * e->arm);
}

void pl_thrust_row(pl_substep *s)
{
    const pl_effects *e = &s->world->effects;
    const pl_engine *all = e->engines.data;
    const pl_share mine =
        pl_substep_share(all, sizeof(pl_engine), offsetof(pl_engine, slot), e->engine_count, s);
    for (uint32_t i = mine.first; i < mine.end; ++i) {
        push(s->world, &all[i], (double)s->h * s->number, (double)s->h);
    }
}

//---- the end of a step ---------------------------------------------------------------------------

void pl_engines_burn(plumb_world *world)
{
    pl_bodies *b = &world->bodies;
    const pl_engine *all = world->effects.engines.data;
    for (uint32_t i = 0; i < world->effects.engine_count; ++i) {
        const pl_engine *e = &all[i];
        const uint32_t row = pl_body_row(world, e->body);
        // Systems may have taken its body out, or its engine.
        if (row >= world->dynamic_count || b->settings[row] == 0) {
            continue;
        }
        b->rest_time[row] = PL_NOT_RESTING;
        if (!(e->burnt > 0)) {
            continue;
        }
        pl_body_settings *t = &settings(world)[b->settings[row] - 1];
        const double fuel = e->fuel - e->burnt, mass = e->mass - e->burnt;
        const double inertia = (double)b->inertia[row] * mass / (double)b->mass[row];
        const bool given = b->set_inertia[row] > 0;
        t->fuel = (real)fuel;
        t->fuel_low = (real)(fuel - (double)t->fuel);
        b->mass[row] = b->set_mass[row] = (real)mass;
        t->mass_low = (real)(mass - (double)b->mass[row]);
        b->inv_mass[row] = 1 / b->mass[row];
        b->inertia[row] = (real)inertia;
        b->set_inertia[row] = given ? (real)inertia : 0;
        b->inv_inertia[row] = b->inv_inertia[row] > 0 ? 1 / b->inertia[row] : 0;
    }
}
