// hit_events.c - who struck whom in this step, how fast, how hard, and where.
//
// The speed is that of the moment: the contact kernels note how fast a point came that bore nothing and pushes now
// (contact.simd.c, pgs.c), and impacts how fast they were (bounce.c). A hit is a pair that was struck faster than
// the world's hit speed. While a hit lasts it is not told again: a pair that was struck in the step before as
// well, and has not been apart since.
//
// A contact that is made in the last substep of a step may only be slowed down there, to meet in the next step: its
// hit waits for that (pl_pending_hit), so that speed and impulse are those of the whole hit. It is told in the next step
// whatever becomes of the pair: so it may be told beside another of the same shapes, of another piece or of the pair as it was
// made anew, and the two are made one.
//
// Reads: pairs, manifolds, places. Writes: hit events, hits, the pairs' flags. Order: within contact_events.c.
// Cost: O(1) a touching pair, where hits are told;
// O(hits) for each that was told of a pair which touches no more.
#include "event/event.h"
#include "world/state.h"

#include <string.h>

#define STILL_CLOSING                                                                              \
    ((real)0.01) // [-] share of the approach that is left of a contact not yet made

void pl_pending_hits_free(pl_memory *memory, pl_pending_hits *hits)
{
    pl_buffer_free(memory, &hits->items);
    pl_buffer_free(memory, &hits->old);
}

bool pl_hits_reserve(plumb_world *world, uint32_t count)
{
    pl_pending_hits *hits = &world->pending_hits;
    const size_t waiting = hits->count;
    if (count + waiting == 0) {
        return true;
    }
    return pl_buffer_reserve(&world->memory, &world->hit_events,
                             ((size_t)world->hit_count + count + waiting) *
                                 sizeof(plumb_contact_hit)) &&
           pl_buffer_reserve(&world->memory, &hits->old, count * sizeof(pl_pending_hit));
}

void pl_hits_begin(plumb_world *world)
{
    pl_pending_hits *hits = &world->pending_hits;
    pl_buffer items = hits->items;
    hits->items = hits->old;
    hits->old = items;
    hits->old_count = hits->count;
    hits->count = hits->next = hits->late_count = 0;
    hits->lost_count = (uint32_t)world->hit_count;
}

//---- where ---------------------------------------------------------------------------------------

// Where a row's centre was at the start of the step: what the solver counts from. Where no graph was made, in a step
// that only refreshes, nothing has moved.
static plumb_vec2 start_of(const plumb_world *world, uint32_t row)
{
    plumb_vec2 at = { world->bodies.center_x[row], world->bodies.center_y[row] };
    const uint32_t movable = world->dynamic_count + world->kinematic_count;
    if (row < movable && world->solver.slot_count > 0) {
        const uint32_t slot = pl_solver_slot(&world->solver, row, movable);
        if (slot ==
            PL_NONE) { // no contact of the row was solved, others bear its loads: it moved by itself
            at.x -= world->bodies.vx[row] * world->last_dt;
            at.y -= world->bodies.vy[row] * world->last_dt;
        } else {
            at.x -= pl_solver_bodies(&world->solver)[slot].dx;
            at.y -= pl_solver_bodies(&world->solver)[slot].dy;
        }
    }
    return at;
}

plumb_vec2 pl_contact_place(const plumb_world *world, const pl_manifold *m, uint32_t j)
{
    const pl_manifold_point *p = &m->point[j];
    const plumb_vec2 a = start_of(world, m->body_a), b = start_of(world, m->body_b);
    const bool fixed_a = m->body_a >= world->dynamic_count;
    if (!fixed_a && m->body_b >= world->dynamic_count) {
        return plumb_v2(b.x + p->bx, b.y + p->by);
    }
    const real half = fixed_a ? 0 : p->separation / 2;
    return plumb_v2(a.x + p->ax + m->nx * half, a.y + p->ay + m->ny * half);
}

//---- hits that last -----------------------------------------------------------------------------

// What the step before kept of a pair. Both lists are in order of pairs: it is mostly the next one.
static const pl_pending_hit *find_pending(pl_pending_hits *hits, const pl_pair *pair)
{
    const pl_pending_hit *old = hits->old.data;
    for (uint32_t tries = 0; tries < hits->old_count; ++tries) {
        hits->next = hits->next < hits->old_count ? hits->next : 0;
        const pl_pending_hit *hit = &old[hits->next++];
        if (hit->a == pair->a && hit->b == pair->b) {
            return hit;
        }
    }
    return NULL;
}

static void keep_pending(plumb_world *world, const pl_pair *pair, const pl_manifold *m,
                         plumb_vec2 at)
{
    const near_real since = m->struck_at > 0 ? m->struck_at : 0; // found out a substep late at most
    ((pl_pending_hit *)world->pending_hits.items.data)[world->pending_hits.count++] =
        (pl_pending_hit){ pair->a, pair->b, m->approach, m->hit_impulse,
                          m->nx,   m->ny,   at,          (double)since - (double)world->last_dt };
}

// `who`: shapes and bodies.
static void append_pending(plumb_world *world, const pl_pending_hit *hit, plumb_contact_end who)
{
    ((plumb_contact_hit *)world->hit_events.data)[world->hit_count++] =
        (plumb_contact_hit){ .shape_a = who.shape_a,
                             .shape_b = who.shape_b,
                             .body_a = who.body_a,
                             .body_b = who.body_b,
                             .point = hit->at,
                             .normal = { hit->nx, hit->ny },
                             .approach_speed = hit->approach,
                             .moment = (plumb_real)hit->moment,
                             .impulse = hit->impulse };
}

void pl_hit_lost(plumb_world *world, const pl_pair *pair, plumb_contact_end who)
{
    const pl_pending_hit *hits = world->pending_hits.items.data;
    for (uint32_t i = 0; i < world->pending_hits.count && (pair->flags & PL_PAIR_PENDING) != 0;
         ++i) {
        if (hits[i].a == pair->a && hits[i].b == pair->b) {
            append_pending(world, &hits[i], who);
        }
    }
}

//---- hits ----------------------------------------------------------------------------------------

// Of the two points, the one that was pushed more.
static plumb_vec2 place_of_hit(const plumb_world *world, const pl_manifold *m)
{
    return pl_contact_place(world, m,
                            m->count > 1 && m->point[1].total > m->point[0].total ? 1 : 0);
}

void pl_hit_append(plumb_world *world, const pl_pair *pair, real impulse)
{
    const pl_manifold *m = &pl_manifolds(&world->narrow)[pair->manifold];
    const near_real dt = (near_real)world->last_dt; // behind it: foreseen, by less than a substep
    ((plumb_contact_hit *)world->hit_events.data)[world->hit_count++] =
        (plumb_contact_hit){ .shape_a = world->pieces.shape[pair->a],
                             .shape_b = world->pieces.shape[pair->b],
                             .body_a = world->bodies.entity[m->body_a],
                             .body_b = world->bodies.entity[m->body_b],
                             .point = place_of_hit(world, m),
                             .normal = { m->nx, m->ny },
                             .approach_speed = m->approach,
                             .moment = m->struck_at < dt ? m->struck_at : dt,
                             .impulse = impulse };
}

// It was only slowed down in the last substep.
static bool is_unfinished(const plumb_world *world, const pl_pair *pair, const pl_manifold *m)
{
    return (pair->normal[0] > 0 || pair->normal[1] > 0) &&
           pl_approach_speed(world, m) > STILL_CLOSING * m->approach;
}

// The pair no longer touches: nothing is to be added to what was kept of it.
static void tell_as_it_was(plumb_world *world, const pl_pair *pair, const pl_pending_hit *hit)
{
    const pl_pieces *p = &world->pieces;
    ((uint32_t *)world->changed_pairs.data)[world->pending_hits.late_count++] =
        (uint32_t)world->hit_count;
    append_pending(world, hit,
                   (plumb_contact_end){ p->shape[pair->a], p->shape[pair->b],
                                        world->bodies.entity[p->body[pair->a]],
                                        world->bodies.entity[p->body[pair->b]] });
}

bool pl_hit_is_due(plumb_world *world, pl_pair *pair, bool touches)
{
    const real least = world->desc.hit_speed;
    const pl_pending_hit *pending =
        (pair->flags & PL_PAIR_PENDING) != 0 ? find_pending(&world->pending_hits, pair) : NULL;
    const bool struck = (pair->flags & PL_PAIR_STRUCK) != 0;
    pair->flags &= ~(PL_PAIR_STRUCK | PL_PAIR_PENDING);
    if (!touches) {
        if (pending != NULL) {
            tell_as_it_was(world, pair, pending);
        }
        return false;
    }
    if (!(least > 0)) {
        return false;
    }
    pl_manifold *m = &pl_manifolds(&world->narrow)[pair->manifold];
    m->hit_impulse = m->point[0].total + (m->count > 1 ? m->point[1].total : 0);
    const bool strikes =
        (m->met & PL_MET_MEASURED) != 0 && m->approach > least && m->hit_impulse > 0;
    pair->flags |= strikes || pending != NULL ? PL_PAIR_STRUCK : 0;
    if (pending != NULL) {
        if (pending->approach > m->approach || (m->met & PL_MET_MEASURED) == 0) {
            m->struck_at = (near_real)pending->moment;
        }
        m->approach = pending->approach > m->approach ? pending->approach : m->approach;
        m->hit_impulse += pending->impulse;
        return true;
    }
    const bool lasts = struck && pl_is_near(m, PL_TOUCH_HOLD);
    if (!strikes || lasts) {
        return false;
    }
    if (is_unfinished(world, pair, m)) {
        pair->flags |= PL_PAIR_PENDING;
        keep_pending(world, pair, m, place_of_hit(world, m));
        return false;
    }
    return true;
}

//---- one a pair of shapes ------------------------------------------------------------------------

static bool is_of_same(const plumb_contact_hit *x, const plumb_contact_hit *y)
{
    return (plumb_same(x->shape_a, y->shape_a) && plumb_same(x->shape_b, y->shape_b)) ||
           (plumb_same(x->shape_a, y->shape_b) && plumb_same(x->shape_b, y->shape_a));
}

// Adds hit i to a later one of its shapes, or a later one to it; false: there is none but itself.
static bool fold(plumb_world *world, uint32_t i)
{
    plumb_contact_hit *hits = world->hit_events.data;
    for (uint32_t k = (uint32_t)world->hit_count; k-- > 0;) {
        if (k == i || !is_of_same(&hits[i], &hits[k])) {
            continue;
        }
        const plumb_real impulse = hits[i].impulse + hits[k].impulse;
        if (hits[i].approach_speed > hits[k].approach_speed) {
            hits[k] = hits[i];
        }
        hits[k].impulse = impulse;
        --world->hit_count;
        memmove(&hits[i], &hits[i + 1], ((uint32_t)world->hit_count - i) * sizeof *hits);
        return true;
    }
    return false;
}

void pl_hits_end(plumb_world *world)
{
    const pl_pending_hits *late = &world->pending_hits;
    const uint32_t *others = world->changed_pairs.data;
    // From the last to the first: those that are still to be looked at stay where they are.
    for (uint32_t k = late->late_count; k-- > 0;) {
        fold(world, others[k]);
    }
    for (uint32_t i = late->lost_count; i-- > 0;) {
        fold(world, i);
    }
}
