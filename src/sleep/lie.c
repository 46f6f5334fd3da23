// lie.c - lying down: what falls asleep is taken out of pair list and manifolds, of which it is the last to see this
// step, and its rows change partition. Nothing after the pass knows of it.
//
// Reads: parents (fall.c), pairs. Writes: islands, rows, pairs, manifolds, sleep events. Cost: O(pairs + rows).
#include "sleep/fall.h"
#include "world/push.h"
#include "world/island.h"
#include "internal_edges/internal_edges.h"
#include "narrow/surface.h"
#include "world/rows.h"
#include "world/marks.h"

// The island of a pair that falls asleep; PL_NONE: it stays.
static uint32_t island_of(const plumb_world *world, const pl_pair *pair)
{
    const uint32_t *parents = world->sleep.parents.data;
    uint32_t a, b;
    if (!pl_linked_rows(world, pair, &a, &b)) {
        return PL_NONE;
    }
    uint32_t row = a < world->dynamic_count && parents[a] != PL_NONE   ? a
                   : b < world->dynamic_count && parents[b] != PL_NONE ? b
                                                                       : PL_NONE;
    return row == PL_NONE ? PL_NONE : parents[row];
}

bool pl_lie_reserve(plumb_world *world, uint32_t pair_count, uint32_t bodies)
{
    pl_sleep *s = &world->sleep;
    const uint32_t *parents = s->parents.data;
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    uint32_t islands = 0, contacts = 0;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        islands += parents[row] == row;
    }
    for (uint32_t i = 0; i < pair_count; ++i) {
        contacts += pl_is_linked(&pairs[i]) && island_of(world, &pairs[i]) != PL_NONE;
    }
    size_t events = ((size_t)s->sleep_event_count + bodies) * sizeof(plumb_body);
    size_t fallen = ((size_t)s->sleep_event_count + bodies) * sizeof(pl_fallen);
    size_t places = world->internal_edges.pair_count > 0 ? pair_count * sizeof(uint32_t) : 0;
    return pl_islands_reserve(world, islands, contacts) &&
           pl_buffer_reserve(&world->memory, &s->places, places) &&
           pl_buffer_reserve(&world->memory, &s->sleep_events, events) &&
           pl_buffer_reserve(&world->memory, &s->fallen, fallen);
}

// Takes the pairs of sleepers out of the list, and their manifolds; those that are contacts are
// kept.
static void take_out_pairs(plumb_world *world, uint32_t pair_count, bool steps)
{
    pl_pair_list *list = &world->broad.pairs;
    pl_pair *pairs = pl_pairs(list);
    pl_narrow *narrow = &world->narrow;
    pl_manifold *m = pl_manifolds(narrow);
    const uint8_t *kind = world->pieces.kind;
    const uint32_t own = narrow->manifold_count, all = own + narrow->borne_count;
    uint32_t *places = world->internal_edges.pair_count > 0 ? world->sleep.places.data : NULL;
    uint32_t *fresh = narrow->fresh.data, fresh_at = 0,
             fresh_kept = 0; // in the order of pairs, too
    uint32_t kept = 0, kept_manifolds = 0, taken[PL_PIECE_KIND_COUNT][PL_PIECE_KIND_COUNT] = { 0 };
    for (uint32_t i = 0; i < pair_count; ++i) {
        pl_pair *pair = &pairs[i];
        // Manifolds lie in the order of their pairs.
        pl_manifold *its = pair->manifold < all ? &m[pair->manifold] : NULL;
        uint32_t root = island_of(world, pair);
        if (fresh_at < narrow->fresh_count && fresh[fresh_at] == i) {
            ++fresh_at;
            fresh[fresh_kept] = kept;
            fresh_kept += root == PL_NONE;
        }
        if (places != NULL) {
            places[i] = root == PL_NONE ? kept : PL_NONE;
        }
        if (root != PL_NONE) {
            if (pl_is_linked(pair)) {
                pl_island_keep(world, world->bodies.island[root], pair, its, steps);
            }
            ++taken[kind[pair->a]][kind[pair->b]];
            continue;
        }
        if (pair->manifold < own) {
            its->pair = kept;
            pair->manifold = kept_manifolds;
            m[kept_manifolds++] = *its;
        }
        pairs[kept++] = *pair;
    }
    uint32_t first = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            list->first[a][b] = first;
            list->size[a][b] -= taken[a][b];
            first += list->size[a][b];
        }
    }
    list->count = kept;
    narrow->manifold_count = kept_manifolds;
    narrow->fresh_count = fresh_kept;
    narrow->ends_stale = true; // rows move next
    if (places != NULL) {
        pl_internal_edges_follow(world, places, own);
    }
    pl_narrow_summarise(narrow);
}

// Rows of what is left, after rows have moved.
static void look_up_rows(plumb_world *world)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    pl_manifold *m = pl_manifolds(&world->narrow);
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        pairs[i].body_a = world->pieces.body[pairs[i].a];
        pairs[i].body_b = world->pieces.body[pairs[i].b];
    }
    for (uint32_t i = 0; i < world->narrow.manifold_count + world->narrow.borne_count; ++i) {
        m[i].body_a = pairs[m[i].pair].body_a;
        m[i].body_b = pairs[m[i].pair].body_b;
    }
}

void pl_lie_down(plumb_world *world, uint32_t pair_count, bool steps)
{
    pl_sleep *s = &world->sleep;
    const uint32_t *parents = s->parents.data;
    uint32_t rows = world->dynamic_count;
    for (uint32_t row = 0; row < rows; ++row) {
        if (parents[row] != PL_NONE) {
            uint32_t root = parents[row];
            uint32_t island = root == row ? pl_island_open(world) : world->bodies.island[root];
            pl_island_add(world, island, row);
        }
    }
    if (pair_count > 0) {
        take_out_pairs(world, pair_count, steps);
    }
    // From the last on: what fills a gap stays awake.
    for (uint32_t row = rows; row-- > 0;) {
        if (parents[row] != PL_NONE) {
            pl_push_begin_sleep(world, row, steps);
            pl_sleep_put_down(world, row);
        }
    }
    look_up_rows(world);
    s->near_stale = true;
    pl_sensing_note_rest(world);
    world->joints.awake_stale = true;
    world->pairs_dirty = true;
}

void pl_lie_tell(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    const uint32_t *parents = s->parents.data;
    plumb_body *events = s->sleep_events.data;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (parents[row] != PL_NONE) {
            pl_sleep_note_fallen(world, row);
            events[s->sleep_event_count++] = world->bodies.entity[row];
        }
    }
}
