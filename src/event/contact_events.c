// contact_events.c - who began and who ceased to touch in this step, and who struck whom.
//
// A pair touches when its surfaces overlapped at the start of the step, or an impulse passed between them in
// any substep or impact. It touches on while they are nearer than PL_TOUCH_HOLD, so that what lies against something
// without being pressed there, or hops by less, neither ends nor begins. Hits: hit_events.c.
//
// Pairs of shapes of several pieces tell each event once: what happens to their pairs of pieces is
// kept, sorted by shapes, and summed up at the end. They touch while any pair of pieces does, so a
// body that goes from link to link of a chain neither ends nor begins.
//
// Reads: pairs, manifolds. Writes: event arrays, the pairs' flags. Order: last of the built-in
// passes. Cost: O(pairs), and O(n log n) for the n touching pairs of shapes of several pieces.
#include "core/sort.h"
#include "event/event.h"
#include "internal_edges/internal_edges.h"
#include "sleep/sleep.h"
#include "world/body_settings.h"
#include "world/state.h"

#include <string.h>

void pl_events_clear(plumb_world *world)
{
    world->begin_count = 0;
    world->contact_index.made = false;
    // What was found to have ended by a step that was refused is still to be told.
    if (world->sleep.events_told) {
        world->end_count = world->hit_count = 0;
        world->parts.count = world->parts.lost_count = 0;
    }
    world->sensing.begin_count = world->sensing.end_count = 0;
    pl_sleep_events_clear(world);
}

static bool reserve_ends(plumb_world *world, uint32_t count)
{
    size_t room = ((size_t)world->end_count + count) * sizeof(plumb_contact_end);
    return pl_buffer_reserve(&world->memory, &world->end_events, room) && pl_hits_reserve(world, 0);
}

// So many contacts are worth a thread.
#define SHARED 256

//---- pieces that went ----------------------------------------------------------------------------

// Who a piece is, or was for pairs that have left the list. `epoch` 0: the pair is in the list;
// else 1 + the rebuilds before the one that found it gone.
static pl_tombstone who(const plumb_world *world, uint32_t piece, uint32_t epoch)
{
    const pl_tombstone *tombstone = &((const pl_tombstone *)world->tombstones.data)[piece];
    const pl_pieces *p = &world->pieces;
    return epoch != 0 && tombstone->epoch == epoch
               ? *tombstone
               : (pl_tombstone){ .shape = p->shape[piece],
                                 .body = world->bodies.entity[p->body[piece]],
                                 .flags = p->flags[piece] };
}

static plumb_contact_end end_of(const plumb_world *world, const pl_pair *pair, uint32_t epoch)
{
    pl_tombstone a = who(world, pair->a, epoch), b = who(world, pair->b, epoch);
    return (plumb_contact_end){ a.shape, b.shape, a.body, b.body };
}

static void append_end(plumb_world *world, plumb_contact_end end)
{
    ((plumb_contact_end *)world->end_events.data)[world->end_count++] = end;
}

//---- shapes of several pieces --------------------------------------------------------------------

#define PART_WAS  1u  // the pair of pieces touched before
#define PART_IS   2u  // it touches now
#define PART_HIT  4u  // a hit is due
#define PART_LOST 8u  // it has left the list of pairs: its index is that of parts.lost
#define PART_NEAR 16u // it would touch on if it had touched before
#define PART_BITS 5

static bool parts_reserve(plumb_world *world, uint32_t count)
{
    if (world->part_pieces == 0 && !world->parts.buried) {
        return true;
    }
    pl_parts *parts = &world->parts;
    size_t lost = (size_t)parts->lost_count + count, all = (size_t)parts->count + count;
    return pl_buffer_reserve(&world->memory, &parts->items, all * sizeof(pl_keyed)) &&
           pl_buffer_reserve(&world->memory, &parts->lost, lost * sizeof(plumb_contact_end));
}

void pl_parts_free(pl_memory *memory, pl_parts *parts)
{
    pl_buffer_free(memory, &parts->items);
    pl_buffer_free(memory, &parts->lost);
}

static bool is_part(const plumb_world *world, const pl_pair *pair)
{
    const uint8_t *flags = world->pieces.flags;
    return ((flags[pair->a] | flags[pair->b]) & PL_PIECE_PART) != 0;
}

static void keep_part(plumb_world *world, plumb_shape shape_a, plumb_shape shape_b, uint32_t index,
                      uint32_t bits)
{
    uint32_t a = shape_a.entity.index, b = shape_b.entity.index, order = world->parts.count++;
    ((pl_keyed *)world->parts.items.data)[order] =
        (pl_keyed){ pl_pair_key(a, b), order, index << PART_BITS | bits };
}

static pl_pair *part_pair(const plumb_world *world, const pl_keyed *part)
{
    return pl_pairs(&world->broad.pairs) + (part->value >> PART_BITS);
}

static const plumb_contact_end *part_lost(const plumb_world *world, const pl_keyed *part)
{
    return (const plumb_contact_end *)world->parts.lost.data + (part->value >> PART_BITS);
}

//---- before the solver ---------------------------------------------------------------------------

static void lose_pair(plumb_world *world, const pl_pair *pair)
{
    const uint32_t epoch = (uint32_t)world->broad.rebuilds + 1;
    if ((pair->flags & PL_PAIR_TOUCHING) == 0) {
        return;
    }
    pl_hit_lost(world, pair, end_of(world, pair, epoch));
    uint32_t flags = who(world, pair->a, epoch).flags | who(world, pair->b, epoch).flags;
    if ((flags & PL_PIECE_PART) != 0) {
        pl_parts *parts = &world->parts;
        plumb_contact_end end = end_of(world, pair, epoch);
        ((plumb_contact_end *)parts->lost.data)[parts->lost_count] = end;
        keep_part(world, end.shape_a, end.shape_b, parts->lost_count++, PART_WAS | PART_LOST);
    } else {
        append_end(world, end_of(world, pair, epoch));
    }
}

static bool reserve_losses(plumb_world *world, uint32_t count)
{
    return reserve_ends(world, count) && parts_reserve(world, count);
}

const pl_pair_listener pl_end_listener = { .reserve = reserve_losses, .lost = lose_pair };

real pl_approach_speed(const plumb_world *world, const pl_manifold *m)
{
    const pl_bodies *b = &world->bodies;
    real sa = 1, sb = 1; // what moves in slow motion strikes in slow motion
    if (world->settings.scaled > 0) {
        sa = pl_time_scale(world, m->body_a), sb = pl_time_scale(world, m->body_b);
    }
    real dvx = sb * b->vx[m->body_b] - sa * b->vx[m->body_a];
    real dvy = sb * b->vy[m->body_b] - sa * b->vy[m->body_a];
    real wa = sa * b->w[m->body_a], wb = sb * b->w[m->body_b];
    real fastest = 0;
    for (uint32_t j = 0; j < m->count; ++j) {
        const pl_manifold_point *p = &m->point[j];
        real vx = dvx - wb * p->by + wa * p->ay;
        real vy = dvy + wb * p->bx - wa * p->ax;
        real speed = -(m->nx * vx + m->ny * vy);
        fastest = speed > fastest ? speed : fastest;
    }
    return fastest;
}

// Approaches of pairs that did not touch.
static void note_fresh(void *context, uint32_t first, uint32_t count)
{
    const plumb_world *world = context;
    const uint32_t *fresh = world->narrow.fresh.data;
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    pl_manifold *m = pl_manifolds(&world->narrow);
    for (uint32_t k = first; k < first + count; ++k) {
        const uint32_t i = pairs[fresh[k]].manifold;
        if (i != PL_NONE) { // some have lost it since
            m[i].approach = (near_real)pl_approach_speed(world, &m[i]);
        }
    }
}

bool pl_events_prepare(plumb_world *world)
{
    uint32_t begins = world->narrow.manifold_count + world->narrow.borne_count;
    if (!pl_buffer_reserve(&world->memory, &world->begin_events,
                           begins * sizeof(plumb_contact_begin)) ||
        !pl_buffer_reserve(&world->memory, &world->changed_pairs,
                           ((size_t)world->broad.pairs.count + 1) * sizeof(uint32_t)) ||
        !reserve_ends(world, world->broad.pairs.count + world->parts.count) ||
        !parts_reserve(world, world->broad.pairs.count)) {
        return false;
    }
    if (world->desc.hit_speed > 0 && !pl_hits_reserve(world, begins)) {
        return false;
    }
    pl_tasks_ranges(world->tasks, world->narrow.fresh_count, SHARED, note_fresh, world);
    return true;
}

//---- after the solver ----------------------------------------------------------------------------

// It touched before, and what sticks is still within reach.
static bool holds(const pl_pair *pair, const pl_manifold *m)
{
    real s0 = m->point[0].separation, s1 = m->point[1].separation;
    return (pair->flags & PL_PAIR_TOUCHING) != 0 &&
           (s0 < s1 ? s0 : s1) < pl_adhesion_reach(pair->flags);
}

static bool touches(const plumb_world *world, const pl_pair *pair, const pl_manifold *m)
{
    const near_real near = (pair->flags & PL_PAIR_TOUCHING) != 0 ? PL_TOUCH_HOLD : 0;
    // First what asks for no line of the manifold: most that touch have pushed.
    return pl_has_met(pair, m) || pl_is_near(m, near) || (m->adhesion > 0 && holds(pair, m)) ||
           ((pair->flags & PL_PAIR_BORNE) != 0 && pl_internal_edges_borne_touches(world, m));
}

static const pl_manifold *manifold_of(const plumb_world *world, const pl_pair *pair)
{
    return &pl_manifolds(&world->narrow)[pair->manifold];
}

static void append_begin(plumb_world *world, const pl_pair *pair)
{
    const pl_bodies *b = &world->bodies;
    const pl_manifold *m = manifold_of(world, pair);
    const uint32_t nearest = m->point[1].separation < m->point[0].separation ? 1 : 0;
    ((plumb_contact_begin *)world->begin_events.data)[world->begin_count++] =
        (plumb_contact_begin){ .shape_a = world->pieces.shape[pair->a],
                               .shape_b = world->pieces.shape[pair->b],
                               .body_a = b->entity[m->body_a],
                               .body_b = b->entity[m->body_b],
                               .point = pl_contact_place(world, m, nearest),
                               .normal = { m->nx, m->ny },
                               .approach_speed = m->approach };
}

static bool is_gone(const plumb_world *world, const plumb_contact_end *end)
{
    return pl_shape_piece(world, end->shape_a) == PL_NONE ||
           pl_shape_piece(world, end->shape_b) == PL_NONE;
}

// What has ended of the parts [first, last): told once of those whose shapes are gone, whose slots
// others may have by now. Returns that of shapes that are still there; NULL: none.
static const plumb_contact_end *end_gone(plumb_world *world, const pl_keyed *first,
                                         const pl_keyed *last)
{
    const plumb_contact_end *gone = NULL, *there = NULL;
    for (const pl_keyed *part = first; part < last; ++part) {
        const plumb_contact_end *end =
            (part->value & PART_LOST) != 0 ? part_lost(world, part) : NULL;
        bool is_old = end != NULL && is_gone(world, end);
        gone = is_old ? end : gone;
        there = is_old ? there : end != NULL ? end : there;
    }
    if (gone != NULL) {
        append_end(world, *gone);
    }
    return there;
}

// The parts [first, last) are those of one pair of shapes, or of shapes that had its slots before.
static void publish_group(plumb_world *world, const pl_keyed *first, const pl_keyed *last)
{
    const plumb_contact_end *lost = end_gone(world, first, last);
    bool was = lost != NULL;
    real impulse = 0, fastest = -1, fastest_hit = -1;
    const pl_pair *touching = NULL, *struck = NULL, *parted = NULL;
    pl_pair *near = NULL;
    for (const pl_keyed *part = first; part < last; ++part) {
        if ((part->value & PART_LOST) != 0) {
            continue;
        }
        pl_pair *pair = part_pair(world, part);
        near = (part->value & PART_NEAR) != 0 ? pair : near;
        if ((part->value & PART_WAS) != 0) {
            was = true;
            parted = pair;
        }
        if ((part->value & PART_IS) != 0 && manifold_of(world, pair)->approach > fastest) {
            fastest = manifold_of(world, pair)->approach;
            touching = pair;
        }
        if ((part->value & PART_HIT) != 0) {
            const pl_manifold *m = manifold_of(world, pair);
            impulse += m->hit_impulse;
            struck = m->approach > fastest_hit ? pair : struck;
            fastest_hit = m->approach > fastest_hit ? m->approach : fastest_hit;
        }
    }
    if (!was && touching != NULL) {
        append_begin(world, touching);
    } else if (was && touching == NULL && near != NULL) {
        near->flags |= PL_PAIR_TOUCHING; // the next piece has the contact now
    } else if (was && touching == NULL) {
        append_end(world, lost != NULL ? *lost : end_of(world, parted, 0));
    }
    if (struck != NULL) {
        pl_hit_append(world, struck, impulse);
    }
}

static void publish_parts(plumb_world *world)
{
    if (world->parts.count == 0) {
        return; // perhaps there is no list
    }
    const pl_keyed *parts = world->parts.items.data;
    const pl_keyed *end = parts + world->parts.count;
    pl_sort_keyed(world->parts.items.data, world->parts.count);
    for (const pl_keyed *first = parts; first < end;) {
        const pl_keyed *next = first;
        while (next < end && next->key == first->key) {
            ++next;
        }
        publish_group(world, first, next);
        first = next;
    }
}

// What happened to one pair, in a world of shapes of several pieces or of hits.
static void publish_pair(plumb_world *world, pl_pair *pair, uint32_t index, bool was, bool is,
                         bool refresh)
{
    const bool part = is_part(world, pair);
    const bool near =
        part && !is &&
        (pair->manifold == PL_NONE ? (pair->flags & PL_PAIR_COVERED) != 0
                                   : pl_is_near(manifold_of(world, pair), PL_TOUCH_HOLD));
    if (!is && !was && !near) {
        return;
    }
    bool hit = (is || was) && !refresh && pl_hit_is_due(world, pair, is);
    if (part) {
        const plumb_shape *shape = world->pieces.shape;
        keep_part(world, shape[pair->a], shape[pair->b], index,
                  (was ? PART_WAS : 0) | (is ? PART_IS : 0) | (hit ? PART_HIT : 0) |
                      (near ? PART_NEAR : 0));
        return;
    }
    if (is && !was) {
        append_begin(world, pair);
    } else if (was && !is) {
        append_end(world, end_of(world, pair, 0));
    }
    if (hit) {
        pl_hit_append(world, pair, manifold_of(world, pair)->hit_impulse);
    }
}

static void publish_all(plumb_world *world, bool refresh)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    if (!refresh) {
        pl_hits_begin(world);
    }
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        pl_pair *pair = &pairs[i];
        bool was = (pair->flags & PL_PAIR_TOUCHING) != 0;
        bool is = pair->manifold != PL_NONE && touches(world, pair, manifold_of(world, pair));
        publish_pair(world, pair, i, was, is, refresh);
        pair->flags = (pair->flags & ~PL_PAIR_COVERED) ^ (is != was ? PL_PAIR_TOUCHING : 0);
    }
    publish_parts(world);
    if (!refresh) {
        pl_hits_end(world);
    }
}

// Pairs of a share of the list that begin or cease to touch, noted where the share begins.
typedef struct watch {
    const plumb_world *world;
    uint32_t shares;
    uint32_t count[PLUMB_WORKERS_MAX];
} watch;

static void watch_share(void *context, uint32_t i)
{
    watch *w = context;
    const plumb_world *world = w->world;
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const pl_share s = pl_share_of(world->broad.pairs.count, w->shares, i);
    uint32_t *changed = (uint32_t *)world->changed_pairs.data + s.first, count = 0;
    for (uint32_t k = s.first; k < s.end; ++k) {
        bool was = (pairs[k].flags & PL_PAIR_TOUCHING) != 0;
        bool is = pairs[k].manifold != PL_NONE &&
                  touches(world, &pairs[k], manifold_of(world, &pairs[k]));
        changed[count] = k;
        count += is != was;
    }
    w->count[i] = count;
}

// In a world without parts and hits: few pairs have anything to tell.
static void publish_changes(plumb_world *world)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    watch w = { .world = world };
    w.shares = pl_tasks_share_count(world->tasks, world->broad.pairs.count, SHARED);
    pl_tasks_run(world->tasks, watch_share, &w, w.shares);
    for (uint32_t i = 0; i < w.shares; ++i) {
        const uint32_t first = pl_share_of(world->broad.pairs.count, w.shares, i).first;
        const uint32_t *changed = (const uint32_t *)world->changed_pairs.data + first;
        for (uint32_t k = 0; k < w.count[i]; ++k) {
            pl_pair *pair = &pairs[changed[k]];
            if ((pair->flags & PL_PAIR_TOUCHING) == 0) {
                append_begin(world, pair);
            } else {
                append_end(world, end_of(world, pair, 0));
            }
            pair->flags ^= PL_PAIR_TOUCHING;
        }
    }
}

void pl_events_publish(plumb_world *world, bool refresh)
{
    // Parts may have left the list together with the last shape that had any.
    if (world->part_pieces > 0 || world->parts.count > 0 || world->desc.hit_speed > 0) {
        publish_all(world, refresh);
    } else {
        publish_changes(world);
    }
}
