// continuous.c - the pass: how far each fast body may go along its way, and putting it there.
//
// 1. What fast kinematic bodies may have swept over joins the fast bodies.
// 2. Each dynamic one is swept against static pieces; then, in rounds until nothing changes, bodies
//    that ask for it against one another, and jointed bodies stop together.
// 3. What a kinematic body would pass is carried along by it, as far as static pieces let it.
// 4. Bodies that were stopped are put where they stop. Their velocity stays: the contact that is
//    then there resolves it in the next step, with all that belongs to a contact.
//
// Reads: movers, end poses, pieces, grids, filters, joints. Writes: transforms of stopped bodies.
// Order: after motion, before whatever looks at the new poses. Cost: for each fast body a search of
// the grid and a few rounds of sweep.c for each piece on its way; nothing else.
#include "continuous/continuous.h"

#include "broad/images.h"
#include "continuous/search.h"
#include "plumb/math.h"
#include "world/joint_list.h"

// Rounds among moving bodies; a pile-up that takes longer stays where it was for one step.
#define MOST_ROUNDS 64

//---- what is wanted, what there is room for ------------------------------------------------------

bool pl_continuous_wanted(const plumb_world *world, const char **reason)
{
    if (world->desc.no_continuous) {
        *reason = "the world asks for no continuous collision";
        return false;
    }
    if (world->pieces.live > world->moving_count) {
        *reason = "bodies that move fast might pass through static shapes";
        return true;
    }
    if (world->kinematic_count > 0) {
        *reason = "bodies that move fast might pass through kinematic ones";
        return true;
    }
    *reason = world->continuous_bodies > 0 ? "some body asks not to pass through moving ones"
                                           : "nothing is there that must not be passed through";
    return world->continuous_bodies > 0;
}

bool pl_continuous_reserve(plumb_world *world)
{
    size_t rows = (size_t)world->dynamic_count + world->kinematic_count;
    world->continuous.noting =
        pl_buffer_reserve(&world->memory, &world->continuous.movers, rows * sizeof(pl_mover));
    return world->continuous.noting;
}

void pl_continuous_free(pl_memory *memory, pl_continuous *continuous)
{
    pl_buffer_free(memory, &continuous->movers);
    *continuous = (pl_continuous){ 0 };
}

//---- all bodies ----------------------------------------------------------------------------------

static bool visit_any(void *context, const pl_grid_entry *entry)
{
    (void)context;
    (void)entry;
    return false;
}

static bool visit_sleeper(void *context, const pl_grid_entry *entry)
{
    const plumb_world *world = context;
    return (world->pieces.flags[entry->piece] & PL_PIECE_ASLEEP) == 0;
}

// Whether nothing that stands still lies near the way of a body whose centre goes straight, however it turned. Most
// fast bodies are out in the open: this is all that they cost.
static bool is_in_the_open(const plumb_world *world, const pl_mover *m)
{
    real x = world->bodies.center_x[m->row], y = world->bodies.center_y[m->row];
    real reach = world->bodies.extent[m->row] * (real)1.001 +
                 4 * PLUMB_REAL_EPSILON * (plumb_abs(x) + plumb_abs(y) + m->moved);
    pl_box box = { m->x < x ? m->x : x, m->y < y ? m->y : y, m->x > x ? m->x : x,
                   m->y > y ? m->y : y };
    box = (pl_box){ box.min_x - reach, box.min_y - reach, box.max_x + reach, box.max_y + reach };
    return pl_world_query(world, &world->broad.fixed, box, visit_any, NULL) &&
           pl_search_sleepers(world, box, visit_sleeper, (void *)(uintptr_t)world) &&
           pl_swept_motion_is_free(world, m->row);
}

// So many fast bodies are worth a thread.
#define LEAST 64

static void sweep_some(void *context, uint32_t first, uint32_t count)
{
    const plumb_world *world = context;
    pl_mover *movers = pl_movers(&world->continuous);
    for (uint32_t i = first; i < first + count && pl_row_is_dynamic(world, movers[i].row); ++i) {
        if (!is_in_the_open(world, &movers[i])) {
            pl_search s = pl_search_of(world, &movers[i]);
            movers[i].stop = pl_search_still(&s);
        }
    }
}

static void sweep_still(plumb_world *world)
{
    pl_tasks_ranges(world->tasks, world->continuous.count, LEAST, sweep_some, world);
}

// Which of two bodies that hit each other stops: the one that still moves; of two, the lighter;
// of equals, the faster. The other one stops only if it then is found to run into it.
static pl_mover *who_stops(const plumb_world *world, pl_mover *a, pl_mover *b, double time)
{
    if (b == NULL || b->stop <= time) {
        return a;
    }
    if (a->stop <= time) {
        return b;
    }
    real mass_a = world->bodies.inv_mass[a->row], mass_b = world->bodies.inv_mass[b->row];
    if (mass_a < mass_b || mass_a > mass_b) {
        return mass_a > mass_b ? a : b;
    }
    return a->moved >= b->moved ? a : b;
}

// One round over all pairs in which either body asks; true when some body now stops earlier.
static bool sweep_among(plumb_world *world, real dt)
{
    bool changed = false;
    pl_mover *movers = pl_movers(&world->continuous);
    for (uint32_t i = 0; i < world->continuous.count && pl_row_is_dynamic(world, movers[i].row);
         ++i) {
        pl_search s = pl_search_of(world, &movers[i]);
        s.dt = dt;
        double time = pl_search_among(&s);
        if (time < 1) {
            pl_mover *other = pl_mover_find(world, s.partner);
            pl_mover *stopped = who_stops(world, &movers[i], other, time);
            changed |= stopped->stop > time;
            stopped->stop = stopped->stop > time ? time : stopped->stop;
        }
    }
    return changed;
}

// What is tied by a joint to a body that stops, stops with it. True when one changed.
static bool share_stop(plumb_world *world, const pl_mover *m)
{
    bool changed = false;
    const pl_joint *items = pl_joint_items(&world->joints);
    plumb_body body = world->bodies.entity[m->row];
    for (uint32_t i = world->bodies.first_joint[m->row]; i != PL_NONE;
         i = pl_joint_next(&items[i], body)) {
        const pl_joint *j = &items[i];
        plumb_body other = plumb_same(j->a.body, body) ? j->b.body : j->a.body;
        pl_mover *o = plumb_is_null(other) ? NULL : pl_mover_find(world, pl_body_row(world, other));
        if (o != NULL && pl_row_is_dynamic(world, o->row) && o->stop > m->stop) {
            o->stop = m->stop;
            changed = true;
        }
    }
    return changed;
}

// Bodies with a joint between them stop together, so that it is not torn. True when one changed.
static bool share_stops(plumb_world *world)
{
    bool changed = false;
    const pl_mover *movers = pl_movers(&world->continuous);
    for (uint32_t i = 0; i < world->continuous.count && pl_row_is_dynamic(world, movers[i].row);
         ++i) {
        if (movers[i].stop < 1) {
            changed |= share_stop(world, &movers[i]);
        }
    }
    return changed;
}

// Until no body stops earlier for another. Each round stops some body earlier; where they do not
// come to an end, all fast bodies stay where the step began.
static void settle_stops(plumb_world *world, real dt)
{
    const bool asked = world->continuous_bodies > 0;
    for (int round = 0; round < MOST_ROUNDS; ++round) {
        bool changed = asked && sweep_among(world, dt);
        while (world->joints.live > 0 && share_stops(world)) {
            changed = true;
        }
        if (!changed || !asked) {
            return;
        }
    }
    pl_mover *movers = pl_movers(&world->continuous);
    for (uint32_t i = 0; i < world->continuous.count && pl_row_is_dynamic(world, movers[i].row);
         ++i) {
        movers[i].stop = 0;
    }
}

static void put(plumb_world *world, uint32_t row, pl_place at)
{
    pl_bodies *b = &world->bodies;
    b->center_x[row] = (real)at.x;
    b->center_y[row] = (real)at.y;
    b->residual_x[row] = (real)(at.x - (double)b->center_x[row]);
    b->residual_y[row] = (real)(at.y - (double)b->center_y[row]);
    b->c[row] = (real)at.c;
    b->s[row] = (real)at.s;
    pl_body_update_origin(world, row);
}

// From `time` on the mover keeps its place on a kinematic body, as far as static pieces let it.
static void carry(plumb_world *world, const pl_search *s, double time)
{
    uint32_t row = s->mover->row;
    pl_swept_motion by = pl_mover_motion(world, s->partner, s->dt, s->motion.ox, s->motion.oy);
    by.px += s->partner_shift.x, by.py += s->partner_shift.y;
    double stop = time < s->mover->stop ? time : s->mover->stop;
    pl_place from = pl_swept_motion_place(world, row, &s->motion, stop);
    pl_place by_from = pl_swept_motion_place(world, s->partner, &by, time);
    pl_place by_to = pl_swept_motion_place(world, s->partner, &by, 1);
    double angle = by.angle * (1 - time), c = by_from.c * by_to.c + by_from.s * by_to.s,
           sine = by_from.c * by_to.s - by_from.s * by_to.c;
    double rx = from.x - by_from.x, ry = from.y - by_from.y;
    pl_place to = { by_to.x + c * rx - sine * ry, by_to.y + sine * rx + c * ry,
                    c * from.c - sine * from.s, c * from.s + sine * from.c };
    pl_search leg = pl_search_of(world, s->mover);
    leg.motion = pl_swept_motion_between(world, row, from, to, angle);
    put(world, row, pl_swept_motion_place(world, row, &leg.motion, pl_search_still(&leg)));
}

typedef struct ending {
    plumb_world *world;
    real dt;
} ending;

// Each body by itself: it looks at the ways of kinematic bodies only. Returns how many were stopped.
static uint32_t finish_some(void *context, uint32_t first, uint32_t count)
{
    const ending *e = context;
    plumb_world *world = e->world;
    const pl_mover *movers = pl_movers(&world->continuous);
    uint32_t stopped = 0;
    for (uint32_t i = first; i < first + count && pl_row_is_dynamic(world, movers[i].row); ++i) {
        if (!movers[i].beside && movers[i].stop >= 1) {
            continue;
        }
        pl_search s = pl_search_of(world, &movers[i]);
        s.dt = e->dt;
        s.among_kinematic = true;
        double time = movers[i].beside ? pl_search_among(&s) : 1;
        if (time < 1) {
            carry(world, &s, time);
            ++stopped;
        } else if (movers[i].stop < 1) {
            put(world, movers[i].row,
                pl_swept_motion_place(world, movers[i].row, &s.motion, movers[i].stop));
            ++stopped;
        }
    }
    return stopped;
}

static void finish(plumb_world *world, real dt)
{
    world->continuous.stopped_count += pl_tasks_count(world->tasks, world->continuous.count, LEAST,
                                                      finish_some, &(ending){ world, dt });
}

void pl_continuous_run(plumb_world *world, real dt)
{
    pl_movers_complete(world, dt);
    if (world->continuous.count == 0) {
        return;
    }
    sweep_still(world);
    if (world->joints.live > 0 || world->continuous_bodies > 0) {
        settle_stops(world, dt);
    }
    finish(world, dt);
}
