// measure.c - the energy of a world around the rows that are done once a step, and a step's sum.
//
// Reads: columns of bodies, joints, what the substeps found. Writes: what is measured. Order: before the first row of a
// step; behind the graph; around rows that change bodies; behind the last row. Cost: O(bodies + joints).
#include "step/measure.h"

#include "effects/laws.h"
#include "joints/energy.h"
#include "joints/measure.h"
#include "solver/substep.h"
#include "world/body_settings.h"
#include "world/measured.h"
#include "world/rows.h"
#include "world/state.h"

#include <math.h>
#include <string.h>

void pl_measure_free(pl_memory *memory, pl_measure *m)
{
    pl_buffer *buffers[] = { &m->last,   &m->bodies,  &m->flights, &m->pushes,   &m->bundles,
                             &m->extras, &m->classic, &m->records, &m->impulses, &m->found };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
}

bool pl_want_measures(const plumb_world *world, const char **reason)
{
    *reason = world->desc.measure ? "the world measures its error"
                                  : "nobody asked the world to measure its error";
    return world->desc.measure;
}

static bool wants_solver(const plumb_world *world)
{
    return world->solver.slot_count > 0;
}

bool pl_want_residuals(const plumb_world *world, const char **reason)
{
    return pl_want_measures(world, reason) && pl_want_solver(world, reason);
}

//---- energy of the columns -----------------------------------------------------------------------

static double own_inertia(const pl_bodies *b, uint32_t row)
{
    return b->inv_inertia[row] > 0 ? (double)b->inertia[row] : 0;
}

static double kinetic(const pl_bodies *b, uint32_t row)
{
    const double vx = (double)b->vx[row], vy = (double)b->vy[row], w = (double)b->w[row];
    return ((double)b->mass[row] * (vx * vx + vy * vy) + own_inertia(b, row) * w * w) / 2;
}

// Of rows [first, first + count).
static double mechanical_of(const plumb_world *world, uint32_t first, uint32_t count)
{
    const pl_bodies *b = &world->bodies;
    double sum = 0;
    for (uint32_t row = first; row < first + count; ++row) {
        sum += kinetic(b, row) - (double)b->mass[row] * (double)b->gravity_scale[row] *
                                     ((double)world->gravity.x * (double)b->center_x[row] +
                                      (double)world->gravity.y * (double)b->center_y[row]);
    }
    return sum;
}

static double mechanical(const plumb_world *world)
{
    return mechanical_of(world, 0, world->dynamic_count) +
           mechanical_of(world, pl_partition_first(world, PL_PART_ASLEEP), world->asleep_count);
}

//---- what pushes before the step -----------------------------------------------------------------

plumb_work pl_measure_steady(int i)
{
    return i == PL_STEADY_LIQUID ? PLUMB_WORK_LIQUID : PLUMB_WORK_SYSTEMS;
}

// Which of them a row is; PL_STEADY_WORKS: none.
static int steady_of(pl_once_fn *run)
{
    return run == pl_run_liquid || run == pl_run_air ? PL_STEADY_LIQUID
           : run == pl_run_characters                ? PL_STEADY_CHARACTERS
                                                     : PL_STEADY_WORKS;
}

// NULL: the body was made in this very step, and what pushes it counts as the user's.
static pl_measured_push *push_on(const plumb_world *world, uint32_t row)
{
    const uint32_t slot = world->bodies.entity[row].entity.index;
    return slot < world->measure.push_slots ? (pl_measured_push *)world->measure.pushes.data + slot
                                            : NULL;
}

// Notes the forces of rows [first, first + count), or, behind the row that pushes, what it added.
static void note_pushes(plumb_world *world, uint32_t first, uint32_t count, int work, bool behind)
{
    const pl_bodies *b = &world->bodies;
    for (uint32_t row = first; row < first + count; ++row) {
        const double now[] = { (double)b->fx[row], (double)b->fy[row], (double)b->torque[row] };
        pl_measured_push *push = push_on(world, row);
        for (int i = 0; i < 3 && push != NULL; ++i) {
            push->of[work][i] += behind ? now[i] - push->before[i] : 0;
            push->before[i] = now[i];
        }
    }
}

static void note_all_pushes(plumb_world *world, int work, bool behind)
{
    if (work < PL_STEADY_WORKS) {
        note_pushes(world, 0, world->dynamic_count, work, behind);
        note_pushes(world, pl_partition_first(world, PL_PART_ASLEEP), world->asleep_count, work,
                    behind); // who is pushed wakes, later on
    }
}

//---- free flight ---------------------------------------------------------------------------------

static void note_flights(plumb_world *world)
{
    const pl_bodies *b = &world->bodies;
    pl_measured_flight *flights = world->measure.flights.data;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        flights[row] = (pl_measured_flight){ (double)b->vx[row],       (double)b->vy[row],
                                             (double)b->w[row],        (double)b->center_x[row],
                                             (double)b->center_y[row], (double)b->fx[row],
                                             (double)b->fy[row],       (double)b->torque[row] };
    }
}

// [J] of a force and torque over a way and a turn.
static double work_along(const double force[3], double x, double y, double turn)
{
    return force[0] * x + force[1] * y + force[2] * turn;
}

// What a body that no contact or joint has to do with did in the step.
static void book_flight(plumb_world *world, uint32_t row, double dt)
{
    const pl_bodies *b = &world->bodies;
    const pl_measured_flight *f = (const pl_measured_flight *)world->measure.flights.data + row;
    plumb_balance *work = pl_measures_last(&world->measure)->work;
    const bool has_effects = (b->flags[row] & PL_BODY_HAS_EFFECTS) != 0;
    const double time = has_effects ? dt * (double)pl_time_scale(world, row) : dt;
    const double m = (double)b->mass[row], scale = (double)b->gravity_scale[row];
    const double dvx = (double)b->vx[row] - f->vx, dvy = (double)b->vy[row] - f->vy,
                 dw = (double)b->w[row] - f->w;
    const double vx = f->vx + dvx / 2, vy = f->vy + dvy / 2, w = f->w + dw / 2;
    const double turn = own_inertia(b, row) > 0 ? time * w : 0;
    const plumb_vec2 g = world->effects.gravity, told = world->gravity;
    const double pulled = time * m * scale * ((double)g.x * vx + (double)g.y * vy);
    const double pushed =
        work_along((double[]){ f->fx, f->fy, f->torque }, time * vx, time * vy, turn);
    const pl_measured_push *push = push_on(world, row);
    work[PLUMB_WORK_GRAVITY].kinetic += pulled;
    work[PLUMB_WORK_GRAVITY].potential -= m * scale *
                                          ((double)told.x * ((double)b->center_x[row] - f->x) +
                                           (double)told.y * ((double)b->center_y[row] - f->y));
    work[PLUMB_WORK_FORCES].kinetic += pushed;
    for (int i = 0; i < PL_STEADY_WORKS && push != NULL; ++i) {
        const double done = work_along(push->of[i], time * vx, time * vy, turn);
        work[pl_measure_steady(i)].kinetic += done;
        work[PLUMB_WORK_FORCES].kinetic -= done;
    }
    const bool orbits = world->laws.step.flies && pl_law_way_of(world, row) == PL_LAW_FLIES;
    if (has_effects || orbits) {
        work[orbits ? PLUMB_WORK_LAWS : PLUMB_WORK_DAMPING].kinetic +=
            m * (dvx * vx + dvy * vy) + own_inertia(b, row) * dw * w - pulled - pushed;
    }
}

// What the solver found of a body. A cap shortens what it makes of velocities (pl_effects_take_over).
static void book_solved(plumb_world *world, uint32_t row, uint32_t slot)
{
    const pl_bodies *b = &world->bodies;
    const pl_measured_body *body = (const pl_measured_body *)world->measure.bodies.data + slot;
    const pl_solver_body *solved = &pl_solver_bodies(&world->solver)[slot];
    plumb_balance *work = pl_measures_last(&world->measure)->work;
    for (int i = 0; i < PLUMB_WORKS; ++i) {
        work[i].kinetic += body->work[i].kinetic;
        work[i].potential += body->work[i].potential;
    }
    const bool stands = body->mass == 0; // its time does, and it keeps the velocity that it has
    if ((b->flags[row] & PL_BODY_HAS_SETTINGS) != 0 && !stands) {
        const double vx = (double)solved->vx, vy = (double)solved->vy, w = (double)solved->w;
        work[PLUMB_WORK_DAMPING].kinetic +=
            kinetic(b, row) - (body->mass * (vx * vx + vy * vy) + body->inertia * w * w) / 2;
    }
}

static void book_motion(plumb_world *world, double dt)
{
    const uint32_t *slots = world->solver.slots.data;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        const uint32_t slot = wants_solver(world) ? slots[row] : PL_NONE;
        if (slot == PL_NONE) {
            book_flight(world, row, dt);
        } else {
            book_solved(world, row, slot);
        }
    }
}

//---- around rows ---------------------------------------------------------------------------------

void pl_measure_before(plumb_world *world, pl_once_fn *run)
{
    note_all_pushes(world, steady_of(run), false);
    if (run == pl_run_motion) {
        note_flights(world);
    }
}

static bool is_counted(pl_once_fn *run, plumb_work *work)
{
    static const struct {
        pl_once_fn *run;
        plumb_work work;
    } rows[] = { { NULL, PLUMB_WORK_SYSTEMS },
                 { pl_run_characters, PLUMB_WORK_SYSTEMS },
                 { pl_run_liquid, PLUMB_WORK_LIQUID },
                 { pl_run_air, PLUMB_WORK_LIQUID },
                 { pl_run_waking, PLUMB_WORK_SLEEP },
                 { pl_run_sleep, PLUMB_WORK_SLEEP },
                 { pl_run_continuous, PLUMB_WORK_STOPS },
                 { pl_run_edges, PLUMB_WORK_SYSTEMS },
                 { pl_run_breaking, PLUMB_WORK_SYSTEMS },
                 { pl_run_burning, PLUMB_WORK_THRUST } };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        if (rows[i].run == run) {
            *work = rows[i].work;
            return true;
        }
    }
    return false;
}

void pl_measure_after(plumb_world *world, pl_once_fn *run, plumb_real dt)
{
    pl_measure *m = &world->measure;
    plumb_work work;
    note_all_pushes(world, steady_of(run), true);
    if (run == pl_run_motion) {
        book_motion(world, (double)dt);
        m->mechanical = mechanical(world);
    } else if (is_counted(run, &work)) {
        const double now = mechanical(world);
        pl_measures_last(m)->work[work].kinetic += now - m->mechanical;
        m->mechanical = now;
    }
}

//---- rows of the step ----------------------------------------------------------------------------

plumb_result pl_run_measure_open(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_measure *m = &world->measure;
    const uint32_t slots = world->registry.count;
    if (!pl_buffer_reserve(&world->memory, &m->last, sizeof(plumb_measures)) ||
        !pl_buffer_reserve(&world->memory, &m->pushes, slots * sizeof(pl_measured_push))) {
        return PLUMB_E_MEMORY;
    }
    m->push_slots = slots;
    if (slots > 0) {
        memset(m->pushes.data, 0, slots * sizeof(pl_measured_push));
    }
    *pl_measures_last(m) = (plumb_measures){ .step = 0 };
    m->mechanical = mechanical(world);
    m->stored = pl_joints_stored(world);
    pl_measures_last(m)->before = m->mechanical + m->stored;
    return PLUMB_OK;
}

static bool reserve(plumb_world *world)
{
    pl_measure *m = &world->measure;
    const pl_solver *s = &world->solver;
    pl_memory *memory = &world->memory;
    const size_t threads = (size_t)pl_tasks_workers(world->tasks);
    const size_t slots = wants_solver(world) ? s->dynamic_slots : 0;
    return pl_buffer_reserve(memory, &m->bodies, slots * sizeof(pl_measured_body)) &&
           pl_buffer_reserve(memory, &m->flights,
                             world->dynamic_count * sizeof(pl_measured_flight)) &&
           pl_buffer_reserve(memory, &m->bundles, s->bundles.size) &&
           pl_buffer_reserve(memory, &m->extras, s->extras.size) &&
           pl_buffer_reserve(memory, &m->classic, s->classic.size) &&
           pl_buffer_reserve(memory, &m->found, threads * sizeof(pl_measuring)) &&
           pl_joints_measure_reserve(world);
}

#define BORROWED 1e-5 // share of a mass, beyond its rounding

static void open_body(const plumb_world *world, uint32_t row, uint32_t slot)
{
    const pl_bodies *b = &world->bodies;
    const bool has_settings = (b->flags[row] & PL_BODY_HAS_SETTINGS) != 0;
    const double time = has_settings ? (double)pl_time_scale(world, row) : 1;
    const double share = time > 0 ? 1 / (time * time) : 0;
    const double m = (double)b->mass[row], weight = m * (double)b->gravity_scale[row];
    const plumb_vec2 g = world->effects.gravity, told = world->gravity;
    const double im = (double)pl_solver_bodies(&world->solver)[slot].inv_mass;
    const bool borrows = im > 0 && fabs(im * m * share - 1) > BORROWED;
    ((pl_measured_body *)world->measure.bodies.data)[slot] =
        (pl_measured_body){ .mass = m * share,
                            .met = borrows ? 1 / im : m * share,
                            .borrows = borrows,
                            .inertia = own_inertia(b, row) * share,
                            .pull_x = weight * (double)g.x,
                            .pull_y = weight * (double)g.y,
                            .weight_x = weight * (double)told.x,
                            .weight_y = weight * (double)told.y,
                            .ease = pl_solver_bodies(&world->solver)[slot].inv_inertia };
    const pl_measured_push *push = push_on(world, row);
    if (push != NULL) {
        pl_measured_body *body = (pl_measured_body *)world->measure.bodies.data + slot;
        memcpy(body->steady, push->of, sizeof body->steady);
    }
}

plumb_result pl_run_measure_bodies(plumb_world *world, plumb_real dt)
{
    (void)dt;
    if (!reserve(world)) {
        return PLUMB_E_MEMORY;
    }
    const uint32_t *rows = world->solver.rows.data;
    for (uint32_t slot = 0; wants_solver(world) && slot < world->solver.dynamic_slots; ++slot) {
        open_body(world, rows[slot], slot);
    }
    memset(world->measure.found.data, 0, world->measure.found.size);
    return PLUMB_OK;
}

static void gather_residuals(const plumb_world *world, plumb_measures *last)
{
    const pl_measuring *found = world->measure.found.data;
    const uint32_t threads = (uint32_t)pl_tasks_workers(world->tasks);
    for (uint32_t i = 0; i < threads; ++i) {
        pl_measure_most(&last->gap, found[i].gap);
        pl_measure_most(&last->approach, found[i].approach);
        pl_measure_most(&last->complementarity, found[i].complementarity);
        pl_measure_most(&last->cone, found[i].cone);
        pl_measure_most(&last->momentum, found[i].momentum);
    }
}

plumb_result pl_run_measure_close(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_measure *m = &world->measure;
    plumb_measures *last = pl_measures_last(m);
    const double stored = pl_joints_stored(world);
    last->step = world->step_count;
    last->after = mechanical(world) + stored;
    last->work[PLUMB_WORK_SPRINGS].potential += stored - m->stored;
    double known = 0;
    for (int i = 0; i < PLUMB_WORKS; ++i) {
        known += last->work[i].kinetic + last->work[i].potential;
    }
    last->work[PLUMB_WORK_REST].kinetic += last->after - last->before - known;
    gather_residuals(world, last);
    pl_joints_errors(world, last);
    return PLUMB_OK;
}
