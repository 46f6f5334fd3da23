// impact.c - restitution by events: which contacts bounce in a substep, and in what order.
//
// Every elastic contact has a record. Impacts are resolved one after the other, by their moments
// (impact_queue.h), until none is left, so that a row of touching balls passes momentum on (Newton's
// cradle); whatever meets a struck body is foreseen anew. When a contact is struck and what that does: bounce.c.
// Contacts of low restitution strike once a substep, in lanes (restitution.simd.c); but the classic solver has no
// lanes, so there they have records, too.
//
// Reads, writes: solver bodies. Order: after velocities are integrated, before contacts are solved.
// Cost: O(elastic contacts) a substep, and O(log) for each impact and each contact of the bodies struck.
#include "world/body_settings.h"
#include "solver/bounce.h"
#include "solver/impact_queue.h"
#include "world/state.h"

// Impacts of one substep that are followed, of each elastic contact, as long as energy is left (PL_IMPACT_KEPT: a
// stirred heap of e = 0.1 strikes ten times a contact). A light ball between two heavy ones strikes thousands of times
// within a substep, and every one counts; so what contacts need beyond CHAIN they take from SPARE, which all share. What
// is left when that is used up is solved without bounce, and told: energy is lost then. A kinematic body that moves
// gives energy with every impact, for ever when it closes a gap: its contacts take nothing from it.
#define CHAIN      64
#define SPARE_BITS 17
#define SPARE      (1u << SPARE_BITS)
#define ENDLESS    (1u << 30)

// Impacts within this share of a substep are of one moment; so many of them are solved together.
#define MOMENT   1e-4
#define TOGETHER 64

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

static bool drives(const pl_solver *s, uint32_t slot)
{
    const pl_solver_body *b = &pl_solver_bodies(s)[slot];
    return slot >= s->dynamic_slots && (b->vx != 0 || b->vy != 0 || b->w != 0);
}

// Impacts of a contact until its energy is spent: one more than the largest n with e^(2 n) > PL_IMPACT_KEPT, found bit by
// bit. (One after another took 300,000 instructions a contact and step where e is 1.)
// Above 1 they are as those of 1.
static uint32_t chain_of(near_real restitution)
{
    double power[SPARE_BITS], left = 1;
    power[0] = restitution < 1 ? (double)restitution * (double)restitution : 1;
    for (int k = 1; k < SPARE_BITS; ++k) {
        power[k] = power[k - 1] * power[k - 1];
    }
    uint32_t count = 1;
    for (int k = SPARE_BITS - 1; k >= 0; --k) {
        if (left * power[k] > (double)PL_IMPACT_KEPT) {
            left *= power[k];
            count += 1u << k;
        }
    }
    return count < SPARE ? count : ENDLESS;
}

// What a manifold's impact needs; where its contact reads separations and keeps impulses is the caller's.
static pl_impact impact_of(const plumb_world *world, const pl_manifold *m, near_real dt)
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
                         .waits = m->waits > 0,
                         .after = (near_real)m->waits / PL_WINDOW_UNIT * dt,
                         .until = (near_real)(m->ends % PL_ENDS_STRUCK) / PL_WINDOW_UNIT * dt,
                         .met = m->ends < PL_ENDS_STRUCK,
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

// Records of all elastic contacts.
void pl_impacts_prepare(plumb_world *world, near_real dt)
{
    pl_solver *s = &world->solver;
    const pl_contact_kernels *kernels = pl_solver_kernels(world);
    const uint32_t *lanes = s->lanes.data;
    const size_t count = (size_t)s->bundle_count * (size_t)kernels->width;
    s->impact_count = 0;
    for (size_t lane = 0; lane < count; ++lane) {
        const pl_manifold *m =
            lanes[lane] != PL_NONE ? &pl_manifolds(&world->narrow)[lanes[lane]] : NULL;
        if (m == NULL || !pl_bounces(m) || !pl_is_elastic(m->restitution)) {
            continue;
        }
        pl_impact *impact = (pl_impact *)s->impacts.data + s->impact_count++;
        *impact = impact_of(world, m, dt);
        for (uint32_t j = 0; j < m->count; ++j) {
            pl_impact_point *p = &impact->point[j];
            p->lane_separation = lane_value(s, kernels, lane, kernels->separation_offset[j]);
            p->lane_impulse = lane_value(s, kernels, lane, kernels->impulse_offset[j]);
        }
    }
    pl_impact_queue_link(s);
}

void pl_impacts_prepare_classic(plumb_world *world, near_real dt)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    pl_classic_contact *contacts = s->classic.data;
    s->impact_count = 0;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        if (!pl_bounces(m)) {
            continue;
        }
        pl_impact *impact = &impacts[s->impact_count++];
        *impact = impact_of(world, m, dt);
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

// One impact of a contact less; the last one where none is to spare.
static void count_off(pl_solver *s, pl_impact *m)
{
    --m->left;
    if (m->left > 0 && m->chain - m->left >= CHAIN) {
        m->cut = s->spare_impacts == 0 || drives(s, m->a) || drives(s, m->b);
        m->left = m->cut ? 0 : m->left;
        s->spare_impacts -= !m->cut;
    }
}

// An impact has been: foresees anew what its bodies meet.
static void follow(plumb_world *world, pl_impact *m, double h)
{
    pl_pairs(&world->broad.pairs)[m->pair].flags |= PL_PAIR_HIT;
    m->met = true;
    ++world->solver.bounce_count;
    queue_neighbours(world, m->a, h);
    queue_neighbours(world, m->b, h);
}

// Takes the impact that comes first out of the queue.
static void take(plumb_world *world, pl_impact *m, double h, pl_bounce *out)
{
    pl_solver *s = &world->solver;
    *out = (pl_bounce){ .impact = m };
    pl_bounce_foresee(world, m, h, out->at);
    m->due = false;
    pl_impact_queue_put(s, (uint32_t)(m - (pl_impact *)s->impacts.data));
    count_off(s, m);
}

static void empty_queue(plumb_world *world, double h)
{
    pl_solver *s = &world->solver;
    pl_bounce now[TOGETHER];
    for (pl_impact *m; (m = pl_impact_queue_first(s)) != NULL;) {
        const double until = m->time + MOMENT * h;
        uint32_t count = 0;
        for (; m != NULL && m->time <= until && count < TOGETHER; m = pl_impact_queue_first(s)) {
            take(world, m, h, &now[count++]);
        }
        if (count == 1) {
            if (pl_bounce_resolve(world, now[0].impact, now[0].at)) {
                follow(world, now[0].impact, h);
            }
            continue;
        }
        pl_bounce_resolve_together(world, now, count);
        for (uint32_t i = 0; i < count; ++i) {
            if (now[i].impulse[0] > 0 || now[i].impulse[1] > 0) {
                follow(world, now[i].impact, h);
            }
        }
    }
}

// A body of it has been struck in this substep.
static bool is_upset(const pl_solver *s, const pl_impact *m, near_real h)
{
    const near_real *struck = s->struck.data;
    return struck[m->a] > -h || struck[m->b] > -h;
}

void pl_impacts_run(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    near_real *struck = s->struck.data;
    pl_approach at[2];
    for (uint32_t slot = 0; slot < s->slot_count; ++slot) {
        struck[slot] = -h; // none yet; an impact may lie one substep in the past
    }
    s->spare_impacts = SPARE;
    for (uint32_t i = 0; i < s->impact_count; ++i) {
        impacts[i].left = impacts[i].chain;
        impacts[i].cut = false;
        pl_bounce_foresee(world, &impacts[i], (double)h, at);
        pl_impact_queue_put(s, i);
    }
    empty_queue(world, (double)h);
}

void pl_impacts_run_on(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    pl_approach at[2];
    for (uint32_t i = 0; i < s->impact_count; ++i) {
        if (is_upset(s, &impacts[i], h)) {
            pl_bounce_foresee(world, &impacts[i], (double)h, at);
            pl_impact_queue_put(s, i);
        }
    }
    empty_queue(world, (double)h);
}

static void note_cut(plumb_world *world, uint32_t cut)
{
    if (cut > 0 && world->solver.cut_count == 0) {
        pl_warn(world, "more impacts in a substep at %.6g s than are followed: bounce is lost",
                world->time);
    }
    world->solver.cut_count += cut;
}

// Points that stay clear of their own accord are none of the sweep's business.
void pl_impacts_tell(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    uint32_t cut = 0, longest = 0;
    for (uint32_t i = 0; i < s->impact_count; ++i) {
        pl_impact *m = &impacts[i];
        const uint32_t chain = m->chain - m->left;
        longest = chain > longest ? chain : longest;
        pl_approach at[2] = { { 0 }, { 0 } };
        if (is_upset(s, m, h)) {
            pl_bounce_foresee(world, m, (double)h, at);
            cut += m->cut && (at[0].due || at[1].due);
        }
        for (uint32_t j = 0; j < m->count; ++j) {
            const pl_impact_point *p = &m->point[j];
            const bool off = *p->lane_impulse <= 0 && m->clear[j];
            *p->lane_separation = p->separation + (off ? PL_APART : 0);
        }
    }
    s->chain_count += longest;
    note_cut(world, cut);
}
