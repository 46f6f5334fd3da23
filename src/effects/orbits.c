// orbits.c - bodies that fly in the fields of laws: one by one, or together where they attract one another.
//
// The step is split: what is constant (gravity, forces, uniform laws without end) and the turn by magnetic laws are followed
// exactly, what depends on the place is given in kicks between. Of order 2, velocity Verlet: half a kick, the flow, half
// a kick. Of order 4, SRKN of Blanes and Moan (2002, J. Comput. Appl. Math. 142, table 3): seven kicks, of which the last is
// the first of the next substep. Both are symplectic and symmetric: energies and periods stay. With a tolerance, Verlet with
// 1, 2, ... 8 parts of an interval is extrapolated in the square of their lengths (Gragg; Bulirsch and Stoer 1966) until two
// results agree; where 8 do not do, the interval is halved. What only constant things act on is followed in one piece.
//
// A formula of velocities is no kick of that kind. Of order 2: half of the flow, a kick for which the velocity on its way is
// solved for (law_forces.c), half of the flow: stable however strong the drag. That is not symmetric, so its error has all powers from
// the square on. Of order 4: that in 1, 2 and 3 parts, extrapolated; with a tolerance in 1, 2, ... 8, as above, but in the lengths
// themselves.
//
// Bodies alone fly one by one; where there are formulas, in blocks, unless there is a tolerance, since each has steps of its own.
//
// The flow of dv/dt = a + w (vy, -vx): with z = vx + i vy, z' = z e + a t p, way = t (z p) + a t^2 r, where e = exp(-i w t),
// p = (1 - e) / (i w t), r = (1 - p) / (i w t).
//
// Reads: laws and bodies of the step. Writes: flights. Order: behind the substeps, before motion. Cost: O(bodies laws) a
// kick; coupled bodies O(those that attract x all).
#include "effects/laws.h"

#include "schema/passes.h"
#include "math/trig.h"

#include <math.h>
#include <string.h>

enum { COLUMNS = 8 };

// Kicks, and the flows between them.
typedef struct scheme {
    int flows;
    double kick[7], flow[6];
} scheme;

static const scheme verlet = { 1, { 0.5, 0.5 }, { 1 } };

#define B1 0.0829844064174052
#define B2 0.396309801498368
#define B3 (-0.0390563049223486)
#define A1 0.245298957184271
#define A2 0.604872665711080
static const scheme fourth = { 6,
                               { B1, B2, B3, 1 - 2 * (B1 + B2 + B3), B3, B2, B1 },
                               { A1, A2, 0.5 - (A1 + A2), 0.5 - (A1 + A2), A2, A1 } };

// Bodies on their way through the step, and room for as many.
typedef struct voyage {
    pl_law_system system;
    pl_law_state *now, *start, *table; // table: COLUMNS + 1 of them
    double *pull;
    double *constant; // [m/s^2] x, y a body
    double *slopes;   // four a body
    bool dragged;     // a formula that asks for velocities may act on a body
} voyage;

static size_t state_bytes(size_t count)
{
    return count * (COLUMNS + 3) * sizeof(pl_law_state);
}

static size_t force_bytes(size_t count)
{
    return count * 8 * sizeof(double);
}

bool pl_orbits_reserve(plumb_world *world)
{
    pl_law_step *s = &world->laws.step;
    pl_memory *memory = &world->memory;
    const size_t flights = s->flies ? world->dynamic_count : 0;
    return pl_buffer_reserve(memory, &s->flights, flights * sizeof(pl_flight)) &&
           pl_buffer_reserve(memory, &s->states, state_bytes(s->coupled_count)) &&
           pl_buffer_reserve(memory, &s->forces, force_bytes(s->coupled_count));
}

//---- the flow ------------------------------------------------------------------------------------

typedef struct turn {
    double e[2], p[2], r[2];
} turn;

// p and r by their series where their differences would cancel.
static turn turn_of(double angle)
{
    turn t;
    double s, c;
    pl_sincos(angle, &s, &c);
    const double q = angle * angle;
    t.e[0] = c, t.e[1] = -s;
    if (q < 1e-2) {
        t.p[0] = 1 - q / 6 * (1 - q / 20 * (1 - q / 42 * (1 - q / 72)));
        t.p[1] = -angle / 2 * (1 - q / 12 * (1 - q / 30 * (1 - q / 56)));
        t.r[0] = 0.5 - q / 24 * (1 - q / 30 * (1 - q / 56 * (1 - q / 90)));
        t.r[1] = -angle / 6 * (1 - q / 20 * (1 - q / 42 * (1 - q / 72)));
    } else {
        t.p[0] = s / angle, t.p[1] = (c - 1) / angle;
        t.r[0] = -t.p[1] / angle, t.r[1] = (t.p[0] - 1) / angle;
    }
    return t;
}

static void flow_one(const voyage *v, uint32_t i, double time, double t)
{
    pl_law_state *s = &v->now[i];
    const double ax = v->constant[2 * i], ay = v->constant[2 * i + 1];
    const double spin = pl_laws_spin(&v->system, &v->system.bodies[i], s, time);
    if (spin == 0) {
        s->x += t * s->vx + t * t / 2 * ax;
        s->y += t * s->vy + t * t / 2 * ay;
        s->vx += t * ax;
        s->vy += t * ay;
        return;
    }
    const turn by = turn_of(spin * t);
    const double vx = s->vx, vy = s->vy;
    s->x += t * (vx * by.p[0] - vy * by.p[1]) + t * t * (ax * by.r[0] - ay * by.r[1]);
    s->y += t * (vx * by.p[1] + vy * by.p[0]) + t * t * (ax * by.r[1] + ay * by.r[0]);
    s->vx = vx * by.e[0] - vy * by.e[1] + t * (ax * by.p[0] - ay * by.p[1]);
    s->vy = vx * by.e[1] + vy * by.e[0] + t * (ax * by.p[1] + ay * by.p[0]);
}

static inline void flow(const voyage *v, double time, double t)
{
    for (uint32_t i = 0; i < v->system.count; ++i) {
        if (v->system.bodies[i].mass > 0) {
            flow_one(v, i, time, t);
        }
    }
}

static void kick(const voyage *v, double t)
{
    for (uint32_t i = 0; i < v->system.count; ++i) {
        if (v->system.bodies[i].mass > 0) {
            v->now[i].vx += t * v->pull[2 * i];
            v->now[i].vy += t * v->pull[2 * i + 1];
        }
    }
}

// An interval from `time` on, in n parts.
static void run(const voyage *v, const scheme *by, double time, double length, int n)
{
    const double h = length / n;
    pl_laws_pull(&v->system, v->now, time, v->pull, NULL);
    for (int part = 0; part < n; ++part) {
        double at = time + part * h;
        for (int k = 0; k < by->flows; ++k) {
            kick(v, h * by->kick[k]);
            flow(v, at, h * by->flow[k]);
            at += h * by->flow[k];
            pl_laws_pull(&v->system, v->now, at, v->pull, NULL);
        }
        kick(v, h * by->kick[by->flows]);
    }
}

//---- where velocities count ----------------------------------------------------------------------

static void run_midway(const voyage *v, double time, double length, int n)
{
    const double h = length / n;
    for (int part = 0; part < n; ++part) {
        const double at = time + h * part;
        flow(v, at, h / 2);
        pl_laws_pull(&v->system, v->now, at + h / 2, v->pull, v->slopes);
        for (uint32_t i = 0; i < v->system.count; ++i) {
            pl_law_kick(&v->pull[2 * i], &v->slopes[4 * i], h, &v->pull[2 * i]);
        }
        kick(v, h);
        flow(v, at + h / 2, h / 2);
    }
}

// Of order 4: each substep in 1, 2 and 3 parts, weighed so that h^2 and h^3 cancel.
static void run_midway_thrice(const voyage *v, double dt, int n)
{
    static const double weight[] = { 1.0 / 12, -4.0 / 3, 9.0 / 4 };
    const uint32_t count = v->system.count;
    const double h = dt / n;
    pl_law_state *sum = v->table;
    for (int part = 0; part < n; ++part) {
        memcpy(v->start, v->now, count * sizeof *sum);
        memset(sum, 0, count * sizeof *sum);
        for (int k = 0; k < 3; ++k) {
            memcpy(v->now, v->start, count * sizeof *sum);
            run_midway(v, h * part, h, k + 1);
            for (uint32_t i = 0; i < count; ++i) {
                const pl_law_state *s = &v->now[i];
                sum[i].x += weight[k] * s->x, sum[i].y += weight[k] * s->y;
                sum[i].vx += weight[k] * s->vx, sum[i].vy += weight[k] * s->vy;
            }
        }
        memcpy(v->now, sum, count * sizeof *sum);
    }
}

//---- to a tolerance ------------------------------------------------------------------------------

static double larger(double a, double b)
{
    return a > b ? a : b;
}

// Two results agree, and which of them is in `now`.
static bool agree(const voyage *v, const pl_law_state *other, double length, double tolerance)
{
    bool good = true;
    for (uint32_t i = 0; i < v->system.count; ++i) {
        const pl_law_state *a = &v->now[i], *b = &other[i], *s = &v->start[i];
        const double speed = larger(fabs(a->vx) + fabs(a->vy), fabs(s->vx) + fabs(s->vy));
        const double way = fabs(a->x - b->x) + fabs(a->y - b->y);
        const double change = fabs(a->vx - b->vx) + fabs(a->vy - b->vy);
        good &= way <= tolerance * length * speed && change <= tolerance * speed;
    }
    return good;
}

// now = now + (now - before) / by.
static void extrapolate(const voyage *v, const pl_law_state *before, double by)
{
    for (uint32_t i = 0; i < v->system.count; ++i) {
        pl_law_state *a = &v->now[i];
        const pl_law_state *b = &before[i];
        a->x += (a->x - b->x) / by, a->y += (a->y - b->y) / by;
        a->vx += (a->vx - b->vx) / by, a->vy += (a->vy - b->vy) / by;
    }
}

// From `start`; what comes of it is in `now`. The table holds the last row, by columns.
static bool attempt(const voyage *v, double time, double length, double tolerance)
{
    const size_t count = v->system.count, bytes = count * sizeof(pl_law_state);
    pl_law_state *spare = v->table + COLUMNS * count;
    for (int n = 1; n <= COLUMNS; ++n) {
        memcpy(v->now, v->start, bytes);
        if (v->dragged) {
            run_midway(v, time, length, n);
        } else {
            run(v, &verlet, time, length, n);
        }
        for (int k = 1; k < n; ++k) {
            pl_law_state *before = v->table + (size_t)(k - 1) * count;
            const double ratio = (double)n / (n - k);
            memcpy(spare, v->now, bytes);
            extrapolate(v, before, v->dragged ? ratio - 1 : ratio * ratio - 1);
            memcpy(before, spare, bytes);
        }
        if (n > 2 && agree(v, spare, length, tolerance)) {
            return true;
        }
        memcpy(v->table + (size_t)(n - 1) * count, v->now, bytes);
    }
    return false;
}

// Parts of a step, and how often it is tried at most: at an edge of a zone nothing agrees.
#define PARTS    (UINT64_C(1) << 24)
#define ATTEMPTS 4000
// [-] Extrapolated in lengths, not in their squares, rounding comes to more than less would ask for.
#define LEAST_DRAGGED 1e-11

static void run_to(const voyage *v, double dt, double tolerance)
{
    uint64_t at = 0, length = PARTS;
    for (int tries = 0; at < PARTS; ++tries) {
        memcpy(v->start, v->now, v->system.count * sizeof(pl_law_state));
        const double time = dt * ((double)at / (double)PARTS);
        const double part = dt * ((double)length / (double)PARTS);
        if (attempt(v, time, part, tolerance) || length == 1 || tries > ATTEMPTS) {
            at += length;
            while (length < PARTS && at % (2 * length) == 0 && at + 2 * length <= PARTS) {
                length *= 2;
            }
        } else {
            memcpy(v->now, v->start, v->system.count * sizeof(pl_law_state));
            length /= 2;
        }
    }
}

//---- the pass ------------------------------------------------------------------------------------

// What does not depend on the place.
static void set_out(const voyage *v, uint32_t i)
{
    const plumb_world *world = v->system.world;
    const pl_bodies *b = &world->bodies;
    const pl_law_body *body = &v->system.bodies[i];
    const uint32_t row = body->row;
    const plumb_vec2 g = world->effects.gravity;
    const double scale = (double)b->gravity_scale[row], ease = (double)b->inv_mass[row];
    v->constant[2 * i] = body->ax + scale * (double)g.x + ease * (double)b->fx[row];
    v->constant[2 * i + 1] = body->ay + scale * (double)g.y + ease * (double)b->fy[row];
    v->now[i] = (pl_law_state){ (double)b->center_x[row] + (double)b->residual_x[row],
                                (double)b->center_y[row] + (double)b->residual_y[row],
                                (double)b->vx[row] + (double)b->residual_vx[row],
                                (double)b->vy[row] + (double)b->residual_vy[row] };
}

static void arrive(const voyage *v, uint32_t i, double dt)
{
    const plumb_world *world = v->system.world;
    const pl_bodies *b = &world->bodies;
    const uint32_t row = v->system.bodies[i].row;
    const pl_law_state *s = &v->now[i];
    const double aw = (double)b->torque[row] * (double)b->inv_inertia[row];
    ((pl_flight *)world->laws.step.flights.data)[row] = (pl_flight){
        .x = s->x - (double)b->center_x[row] - (double)b->residual_x[row],
        .y = s->y - (double)b->center_y[row] - (double)b->residual_y[row],
        .angle = dt * ((double)b->w[row] + aw * dt / 2),
        .vx = s->vx - (double)b->vx[row] - (double)b->residual_vx[row],
        .vy = s->vy - (double)b->vy[row] - (double)b->residual_vy[row],
        .w = aw * dt,
    };
}

static bool is_bent(const pl_law_system *system)
{
    bool bent = system->replaces;
    for (uint32_t k = 0; k < system->law_count; ++k) {
        bent |= !pl_law_is_endless(system->laws[k].desc);
    }
    return bent;
}

static bool is_dragged(const pl_law_system *system)
{
    bool dragged = false;
    for (uint32_t i = 0; i < system->count; ++i) {
        dragged |= system->bodies[i].dragged;
    }
    return dragged;
}

static void travel(voyage *v, double dt)
{
    const plumb_world *world = v->system.world;
    const plumb_orbit_desc orbits = pl_orbits_of(world);
    for (uint32_t i = 0; i < v->system.count; ++i) {
        set_out(v, i);
    }
    v->dragged = v->system.formulas && is_dragged(&v->system);
    if (!is_bent(&v->system)) {
        flow(v, 0, dt);
    } else if (orbits.tolerance > 0) {
        const double tolerance = (double)orbits.tolerance;
        run_to(v, dt, v->dragged ? larger(tolerance, LEAST_DRAGGED) : tolerance);
    } else if (v->dragged && orbits.order == 4) {
        run_midway_thrice(v, dt, world->desc.substeps);
    } else if (v->dragged) {
        run_midway(v, 0, dt, world->desc.substeps);
    } else {
        run(v, orbits.order == 4 ? &fourth : &verlet, 0, dt, world->desc.substeps);
    }
    for (uint32_t i = 0; i < v->system.count; ++i) {
        if (v->system.bodies[i].mass > 0) {
            arrive(v, i, dt);
        }
    }
}

static pl_law_system system_of(const plumb_world *world, uint32_t first, uint32_t count,
                               uint32_t sources)
{
    const pl_law_step *s = &world->laws.step;
    return (pl_law_system){ .world = world,
                            .laws = pl_laws_now(world),
                            .law_count = s->law_count,
                            .bodies = pl_law_bodies(world) + first,
                            .count = count,
                            .sources = sources,
                            .gravity = world->effects.gravity,
                            .replaces = s->replaces,
                            .formulas = s->formulas,
                            .others = s->others };
}

typedef struct singles {
    const plumb_world *world;
    uint32_t first;
    double dt;
} singles;

static void travel_alone(void *context, uint32_t first, uint32_t count)
{
    const singles *all = context;
    for (uint32_t i = all->first + first; i < all->first + first + count; ++i) {
        pl_law_state states[COLUMNS + 3];
        double numbers[8];
        voyage v = { .system = system_of(all->world, i, 1, 0),
                     .now = states,
                     .start = states + 1,
                     .table = states + 2,
                     .pull = numbers,
                     .constant = numbers + 2,
                     .slopes = numbers + 4 };
        v.system.alone = true;
        if (pl_law_way_of(all->world, v.system.bodies->row) == PL_LAW_FLIES) {
            travel(&v, all->dt);
        }
    }
}

// Those of a range that fly, and on which a formula of velocities may act, or may not, from *next on: up to a block.
static uint32_t gather(const singles *all, uint32_t *next, uint32_t end, bool dragged,
                       pl_law_body *bodies)
{
    uint32_t count = 0;
    for (; *next < end && count < PL_LAW_BLOCK; ++*next) {
        const pl_law_body *body = &pl_law_bodies(all->world)[*next];
        if (body->dragged == dragged && pl_law_way_of(all->world, body->row) == PL_LAW_FLIES) {
            bodies[count++] = *body;
        }
    }
    return count;
}

// In blocks. A body has the same bits whoever else is in its block.
static void travel_in_blocks(void *context, uint32_t first, uint32_t count)
{
    const singles *all = context;
    const uint32_t begin = all->first + first, end = begin + count;
    for (int dragged = 0; dragged < 2; ++dragged) {
        pl_law_body bodies[PL_LAW_BLOCK];
        uint32_t next = begin, found;
        while ((found = gather(all, &next, end, dragged != 0, bodies)) > 0) {
            pl_law_state states[3 * PL_LAW_BLOCK];
            double numbers[8 * PL_LAW_BLOCK];
            voyage v = { .system = system_of(all->world, 0, found, 0),
                         .now = states,
                         .start = states + found,
                         .table = states + 2 * found,
                         .pull = numbers,
                         .constant = numbers + 2 * found,
                         .slopes = numbers + 4 * found };
            v.system.bodies = bodies;
            v.system.alone = true;
            travel(&v, all->dt);
        }
    }
}

// So many bodies are worth a thread.
#define LEAST 16

plumb_result pl_run_orbits(plumb_world *world, plumb_real dt)
{
    const pl_law_step *s = &world->laws.step;
    const uint32_t count = s->coupled_count;
    if (s->flies && count > 0 && !s->couples) {
        pl_law_state *states = s->states.data;
        double *numbers = s->forces.data;
        voyage v = { .system = system_of(world, 0, count, s->source_count),
                     .now = states,
                     .start = states + count,
                     .table = states + 2 * (size_t)count,
                     .pull = numbers,
                     .constant = numbers + 2 * (size_t)count,
                     .slopes = numbers + 4 * (size_t)count };
        travel(&v, (double)dt);
    }
    pl_laws_settle(world, dt);
    singles rest = { world, count, (double)dt };
    const bool in_blocks = s->formulas && !(pl_orbits_of(world).tolerance > 0);
    pl_tasks_ranges(world->tasks, s->flies ? s->body_count - count : 0, LEAST,
                    in_blocks ? travel_in_blocks : travel_alone, &rest);
    return PLUMB_OK;
}
