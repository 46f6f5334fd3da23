// impact.c - restitution by events: which contacts bounce in a substep, and in what order.
//
// Every contact with restitution has a record. Impacts are resolved one after the other, by their moments
// (impact_queue.h), until none is left, so that a row of touching balls passes momentum on (Newton's
// cradle); whatever meets a struck body is foreseen anew. Contacts of little restitution, the dull ones, strike
// once, as they stand, after the lively ones. Where all are dull, there are no records: dull.h.
// When a contact is struck and what that does: bounce.c.
//
// Reads, writes: solver bodies. Order: after velocities are integrated, before contacts are solved.
// Cost: O(elastic contacts) a substep, and O(log) for each impact and each contact of the bodies struck.
#include "solver/bounce.h"
#include "solver/dull.h"
#include "solver/impact_queue.h"
#include "world/state.h"

// Impacts of one substep that are followed, of each elastic contact; what is left then is solved
// without bounce. A light ball between two heavy ones strikes many times within a substep; but little of
// the energy is left then (PL_IMPACT_KEPT): a stirred heap of e = 0.1 strikes ten times a contact.
#define CHAIN 64

static near_real *lane_value(pl_solver *s, const pl_contact_kernels *kernels, size_t lane,
                             size_t offset)
{
    size_t width = (size_t)kernels->width;
    char *bundle = (char *)s->bundles.data + lane / width * kernels->bundle_size;
    return (near_real *)(void *)(bundle + offset) + lane % width;
}

// Apart, for few worlds have a locked body and impact_of is worth inlining.
static __attribute__((noinline)) void note_locks(const plumb_world *world, const pl_manifold *m,
                                                 pl_impact *impact)
{
    const uint16_t *flags = world->bodies.flags;
    near_real ima = pl_solver_bodies(&world->solver)[impact->a].inv_mass;
    near_real imb = pl_solver_bodies(&world->solver)[impact->b].inv_mass;
    impact->locked = true;
    impact->aix = (near_real)pl_unlocked(flags[m->body_a], PL_BODY_LOCK_X, ima);
    impact->aiy = (near_real)pl_unlocked(flags[m->body_a], PL_BODY_LOCK_Y, ima);
    impact->bix = (near_real)pl_unlocked(flags[m->body_b], PL_BODY_LOCK_X, imb);
    impact->biy = (near_real)pl_unlocked(flags[m->body_b], PL_BODY_LOCK_Y, imb);
}

static uint32_t chain_of(near_real restitution)
{
    double square = (double)restitution * (double)restitution, left = square;
    uint32_t count = 1;
    for (; count < CHAIN && left > PL_IMPACT_KEPT; ++count) {
        left *= square;
    }
    return count;
}

// What a manifold's impact needs; where its contact reads separations and keeps impulses is the caller's.
static pl_impact impact_of(const plumb_world *world, const pl_manifold *m)
{
    const pl_solver *s = &world->solver;
    uint32_t movable = world->dynamic_count + world->kinematic_count;
    pl_impact impact = { .a = pl_solver_slot(s, m->body_a, movable),
                         .b = pl_solver_slot(s, m->body_b, movable),
                         .pair = m->pair,
                         .count = m->count,
                         .nx = m->nx,
                         .ny = m->ny,
                         .friction = m->friction,
                         .restitution = m->restitution,
                         .chain = chain_of(m->restitution),
                         .surface_speed = m->surface_speed };
    if (world->locked_bodies > 0) {
        note_locks(world, m, &impact);
    }
    for (uint32_t j = 0; j < m->count; ++j) {
        const pl_manifold_point *p = &m->point[j];
        impact.point[j] = (pl_impact_point){ .ran = p->ax * m->ny - p->ay * m->nx,
                                             .rbn = p->bx * m->ny - p->by * m->nx,
                                             .rat = p->ax * m->nx + p->ay * m->ny,
                                             .rbt = p->bx * m->nx + p->by * m->ny,
                                             .separation = p->separation };
    }
    return impact;
}

// Records of all that bounce.
static void record_impacts(plumb_world *world)
{
    pl_solver *s = &world->solver;
    const pl_contact_kernels *kernels = pl_solver_kernels(world);
    const uint32_t *lanes = s->lanes.data;
    pl_predicted_ends *ends = s->predicted_ends.data;
    for (size_t lane = 0; lane < s->predicted_lanes; ++lane) {
        const pl_manifold *m =
            lanes[lane] != PL_NONE ? &pl_manifolds(&world->narrow)[lanes[lane]] : NULL;
        ends[lane].impact = PL_NONE;
        if (m == NULL || !pl_bounces(m)) {
            continue;
        }
        pl_impact *impact = (pl_impact *)s->impacts.data + s->impact_count;
        *impact = impact_of(world, m);
        for (uint32_t j = 0; j < m->count; ++j) {
            pl_impact_point *p = &impact->point[j];
            p->lane_separation = lane_value(s, kernels, lane, kernels->separation_offset[j]);
            p->lane_impulse = lane_value(s, kernels, lane, kernels->impulse_offset[j]);
        }
        if (pl_is_dull(m->restitution)) {
            ends[lane] = (pl_predicted_ends){ impact->a, impact->b, s->impact_count };
        }
        ++s->impact_count;
    }
    pl_impact_queue_link(s);
}

// Where all impacts are dull, and no axis is locked, the kernels need no record of them.
void pl_impacts_prepare(plumb_world *world)
{
    pl_solver *s = &world->solver;
    s->impact_count = s->bounce_count = s->lively_count = 0;
    s->predicted_lanes = s->bundle_count * (uint32_t)pl_solver_kernels(world)->width;
    if (pl_dull_impacts_prepare(world) > 0 || world->locked_bodies > 0) {
        record_impacts(world);
    }
}

void pl_impacts_prepare_classic(plumb_world *world)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    pl_classic_contact *contacts = s->classic.data;
    s->impact_count = s->bounce_count = s->predicted_lanes = 0;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        if (!pl_bounces(m)) {
            continue;
        }
        pl_impact *impact = &impacts[s->impact_count++];
        *impact = impact_of(world, m);
        for (uint32_t j = 0; j < m->count; ++j) {
            impact->point[j].lane_separation = &contacts[i].point[j].separation;
            impact->point[j].lane_impulse = &contacts[i].point[j].ln;
        }
    }
    pl_impact_queue_link(s);
}

// Foresees anew what a struck body meets.
static void queue_neighbours(plumb_world *world, uint32_t slot, double h)
{
    pl_solver *s = &world->solver;
    pl_approach unused[2];
    if (slot >= s->dynamic_slots) {
        return;
    }
    uint32_t i = pl_impact_of_slot(s, slot);
    for (; i != PL_NONE; i = pl_impact_after(s, slot, i)) {
        pl_bounce_foresee(world, (pl_impact *)s->impacts.data + i, h, unused);
        pl_impact_queue_put(s, i);
    }
}

// Resolves an impact that is due, and foresees anew what its bodies meet.
static void happen(plumb_world *world, pl_impact *m, const pl_approach at[2], double h)
{
    --m->left;
    if (pl_bounce_resolve(world, m, at)) {
        pl_pairs(&world->broad.pairs)[m->pair].flags |= PL_PAIR_HIT;
        ++world->solver.bounce_count;
        queue_neighbours(world, m->a, h);
        queue_neighbours(world, m->b, h);
    }
}

static void empty_queue(plumb_world *world, double h)
{
    pl_solver *s = &world->solver;
    for (pl_impact *m; (m = pl_impact_queue_first(s)) != NULL;) {
        pl_approach at[2] = { { 0 }, { 0 } };
        pl_bounce_foresee(world, m, h, at);
        m->due = false;
        pl_impact_queue_put(s, (uint32_t)(m - (pl_impact *)s->impacts.data));
        happen(world, m, at, h);
    }
}

// A body of it has been struck in this substep.
static bool is_upset(const pl_solver *s, const pl_impact *m, near_real h)
{
    const near_real *struck = s->struck.data;
    return struck[m->a] > -h || struck[m->b] > -h;
}

// Points that stay clear of their own accord are none of the contact kernel's business.
static void tell_kernel(const pl_impact *m)
{
    for (uint32_t j = 0; j < m->count; ++j) {
        const pl_impact_point *p = &m->point[j];
        bool off = *p->lane_impulse <= 0 && m->clear[j];
        *p->lane_separation = p->separation + (off ? PL_APART : 0);
    }
}

static void run_lively(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    pl_approach at[2];
    for (uint32_t i = 0; i < s->impact_count; ++i) {
        if (impacts[i].chain > 1) {
            impacts[i].left = impacts[i].chain;
            pl_bounce_foresee(world, &impacts[i], (double)h, at);
            pl_impact_queue_put(s, i);
        }
    }
    empty_queue(world, (double)h);
}

// Dull ones strike once, one after the other as they stand.
static void take_turn(plumb_world *world, pl_impact *m, near_real h)
{
    pl_approach at[2] = { { 0 }, { 0 } };
    m->left = 1;
    pl_bounce_foresee(world, m, (double)h, at);
    tell_kernel(m);
    if (m->due) {
        happen(world, m, at, (double)h);
        empty_queue(world, (double)h);
        pl_bounce_foresee(world, m, (double)h, at);
        tell_kernel(m);
    }
}

static void run_all_dull(plumb_world *world, near_real h)
{
    pl_impact *impacts = world->solver.impacts.data;
    for (uint32_t i = 0; i < world->solver.impact_count; ++i) {
        if (impacts[i].chain == 1) {
            take_turn(world, &impacts[i], h);
        }
    }
}

// Those that the prediction leaves open, and those of which a body has been struck since.
static void run_open(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    const pl_predicted_ends *ends = s->predicted_ends.data;
    const uint8_t *open = s->predicted_open.data;
    const near_real *struck = s->struck.data;
    pl_dull_impacts_look(world, h);
    for (uint32_t lane = 0; lane < s->predicted_lanes; ++lane) {
        if (ends[lane].impact != PL_NONE &&
            (open[lane] != 0 || struck[ends[lane].a] > -h || struck[ends[lane].b] > -h)) {
            take_turn(world, &impacts[ends[lane].impact], h);
        }
    }
}

static void run_recorded(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    if (s->lively_count > 0) {
        run_lively(world, h);
    }
    if (s->lively_count < s->impact_count) {
        (s->predicted_lanes > 0 ? run_open : run_all_dull)(world, h);
    }
    for (uint32_t i = 0; i < s->impact_count && s->lively_count > 0; ++i) {
        pl_approach at[2];
        if (impacts[i].chain > 1) {
            if (is_upset(s, &impacts[i], h)) {
                pl_bounce_foresee(world, &impacts[i], (double)h, at);
            }
            tell_kernel(&impacts[i]);
        }
    }
}

void pl_impacts_run(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    near_real *struck = s->struck.data;
    for (uint32_t slot = 0; slot < s->slot_count; ++slot) {
        struck[slot] = -h; // none yet; an impact may lie one substep in the past
    }
    (s->impact_count == 0 && s->predicted_lanes > 0 ? pl_dull_impacts_run : run_recorded)(world, h);
}
