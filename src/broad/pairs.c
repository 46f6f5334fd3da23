// pairs.c - the pair list: sorted, so that its order depends on piece slots alone, and merged with
// the list before it, so that contacts keep their impulses.
//
// Cost: O(pairs + piece slots), three linear passes.
#include "broad/pairs.h"
#include "core/sort.h"
#include "world/state.h"

#include <string.h>

// Sorts the pairs of one piece by `high`. Shell sort: the usual few cost a single insertion pass,
// and a ground under thousands of bodies does not cost their square. Gaps: Ciura 2001, then
// times 2.25.
static void sort_run(pl_found *run, uint32_t count)
{
    static const uint32_t gaps[] = {
        40412, 17961, 7983, 3548, 1577, 701, 301, 132, 57, 23, 10, 4, 1
    };
    for (size_t g = 0; g < sizeof gaps / sizeof gaps[0]; ++g) {
        uint32_t gap = gaps[g];
        for (uint32_t i = gap; i < count; ++i) {
            pl_found pair = run[i];
            uint32_t j = i;
            while (j >= gap && run[j - gap].high > pair.high) {
                run[j] = run[j - gap];
                j -= gap;
            }
            run[j] = pair;
        }
    }
}

// So few pairs among so many slots (most asleep or static) are not worth a pass over the slots.
#define FEW 32

static bool sort_few(plumb_world *world)
{
    pl_broad *broad = &world->broad;
    uint32_t count = broad->found_count;
    const pl_found *found = broad->found.data;
    if (!pl_buffer_reserve(&world->memory, &broad->counts, count * sizeof(pl_keyed)) ||
        !pl_buffer_reserve(&world->memory, &broad->sorted,
                           ((size_t)count + 1) * sizeof(pl_found))) {
        return false;
    }
    pl_keyed *keyed = broad->counts.data;
    pl_found *sorted = broad->sorted.data;
    for (uint32_t i = 0; i < count; ++i) {
        keyed[i] = (pl_keyed){ pl_key(found[i].low, found[i].high), 0, 0 };
    }
    pl_sort_keyed(keyed, count);
    for (uint32_t i = 0; i < count; ++i) {
        sorted[i] = (pl_found){ (uint32_t)(keyed[i].key >> 32), (uint32_t)keyed[i].key };
    }
    return true;
}

// Sorts broad->found by (low, high) into broad->sorted: counting sort by `low`, then by `high`
// within the pairs of a piece.
static bool sort_found(plumb_world *world)
{
    pl_broad *broad = &world->broad;
    size_t slots = world->pieces.table.count;
    if ((size_t)broad->found_count * FEW < slots) {
        return sort_few(world);
    }
    if (!pl_buffer_reserve(&world->memory, &broad->counts, (slots + 1) * sizeof(uint32_t)) ||
        !pl_buffer_reserve(&world->memory, &broad->sorted,
                           ((size_t)broad->found_count + 1) * sizeof(pl_found))) {
        return false;
    }
    uint32_t *at = broad->counts.data;
    const pl_found *found = broad->found.data;
    pl_found *sorted = broad->sorted.data;
    memset(at, 0, (slots + 1) * sizeof(uint32_t));
    for (uint32_t i = 0; i < broad->found_count; ++i) {
        ++at[found[i].low + 1];
    }
    for (size_t s = 1; s <= slots; ++s) {
        at[s] += at[s - 1];
    }
    for (uint32_t i = 0; i < broad->found_count; ++i) {
        sorted[at[found[i].low]++] = found[i];
    }
    // Each `at` now is where the pairs of the next piece begin.
    for (size_t s = 0; s < slots; ++s) {
        uint32_t first = s == 0 ? 0 : at[s - 1];
        if (at[s] - first > 1) {
            sort_run(sorted + first, at[s] - first);
        }
    }
    return true;
}

static void lay_out_kinds(pl_pair_list *list, const pl_found *sorted, uint32_t count,
                          const uint8_t *kind)
{
    memset(list->size, 0, sizeof list->size);
    for (uint32_t i = 0; i < count; ++i) {
        uint8_t low = kind[sorted[i].low];
        uint8_t high = kind[sorted[i].high];
        ++list->size[low < high ? low : high][low < high ? high : low];
    }
    uint32_t first = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            list->first[a][b] = first;
            first += list->size[a][b];
        }
    }
}

pl_pair pl_pair_fresh(const plumb_world *world, pl_found found)
{
    const pl_pieces *pieces = &world->pieces;
    bool swap = pieces->kind[found.low] > pieces->kind[found.high];
    pl_pair pair = { .a = swap ? found.high : found.low, .b = swap ? found.low : found.high };
    pair.body_a = pieces->body[pair.a];
    pair.body_b = pieces->body[pair.b];
    pair.feature[0] = pair.feature[1] = PL_NONE;
    pair.manifold = PL_NONE;
    return pair;
}

// Where in the order of (low, high) a pair stands.
static uint64_t key_of(uint32_t a, uint32_t b)
{
    return a < b ? ((uint64_t)a << 32 | b) : ((uint64_t)b << 32 | a);
}

pl_pair *pl_pairs_find_one(const plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_pair_list *list = &world->broad.pairs;
    uint8_t kind_p = world->pieces.kind[p], kind_q = world->pieces.kind[q];
    uint8_t a = kind_p < kind_q ? kind_p : kind_q, b = kind_p < kind_q ? kind_q : kind_p;
    pl_pair *pairs = pl_pairs(list) + list->first[a][b];
    uint32_t low = 0, high = list->size[a][b];
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (key_of(pairs[middle].a, pairs[middle].b) < key_of(p, q)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    bool found = low < list->size[a][b] && key_of(pairs[low].a, pairs[low].b) == key_of(p, q);
    return found ? &pairs[low] : NULL;
}

typedef struct carry {
    const pl_pair *old;
    uint32_t next[PL_PIECE_KIND_COUNT][PL_PIECE_KIND_COUNT]; // cursor into the old list
    uint32_t end[PL_PIECE_KIND_COUNT][PL_PIECE_KIND_COUNT];
} carry;

static bool is_younger(const plumb_world *world, uint32_t piece)
{
    return world->pieces.serial[piece] > world->broad.serial;
}

// What ceases to be touched rests anew: it may have lost what it stood on.
static void lose_pair(plumb_world *world, const pl_pair *pair)
{
    const pl_pieces *pieces = &world->pieces;
    const uint32_t ends[2] = { pair->a, pair->b };
    for (int i = 0; i < 2 && pair->manifold != PL_NONE; ++i) {
        if (pieces->kind[ends[i]] != PL_PIECE_FREE) {
            world->bodies.looked[pieces->body[ends[i]]] = PL_UNSEEN;
        }
    }
    pl_pair_lost(world, pair);
}

static void place_pairs(plumb_world *world, pl_pair *items, carry *c)
{
    pl_broad *broad = &world->broad;
    const pl_found *sorted = broad->sorted.data;
    const uint8_t *kind = world->pieces.kind;
    const uint32_t *body = world->pieces.body;
    uint32_t at[PL_PIECE_KIND_COUNT][PL_PIECE_KIND_COUNT];
    memcpy(at, broad->pairs.first, sizeof at);
    const bool reborn = world->serial > broad->serial; // a slot may have changed its piece
    for (uint32_t i = 0; i < broad->found_count; ++i) {
        uint8_t low = kind[sorted[i].low], high = kind[sorted[i].high];
        uint8_t ka = low < high ? low : high, kb = low < high ? high : low;
        uint64_t key = key_of(sorted[i].low, sorted[i].high);
        uint32_t *next = &c->next[ka][kb];
        uint32_t end = c->end[ka][kb];
        while (*next < end && key_of(c->old[*next].a, c->old[*next].b) < key) {
            lose_pair(world, &c->old[(*next)++]);
        }
        pl_pair *item = &items[at[ka][kb]++];
        const pl_pair *old = &c->old[*next];
        if (*next < end && key_of(old->a, old->b) == key) {
            ++*next;
            if (!reborn || (!is_younger(world, old->a) && !is_younger(world, old->b))) {
                *item = *old;
                item->body_a = body[old->a];
                item->body_b = body[old->b];
                continue;
            }
            pl_pair_lost(world, old); // other pieces in the same slots
        }
        *item = pl_pair_fresh(world, sorted[i]);
    }
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            while (c->next[a][b] < c->end[a][b]) {
                lose_pair(world, &c->old[c->next[a][b]++]);
            }
        }
    }
}

bool pl_pairs_rebuild(plumb_world *world)
{
    pl_broad *broad = &world->broad;
    pl_pair_list *list = &broad->pairs;
    if (!pl_pairs_find(world) || !sort_found(world) ||
        !pl_buffer_reserve(&world->memory, &list->old_items,
                           ((size_t)broad->found_count + 1) * sizeof(pl_pair)) ||
        !pl_events_reserve_ends(world, list->count) || !pl_parts_reserve(world, list->count)) {
        return false;
    }
    carry c = { .old = list->items.data };
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            c.next[a][b] = list->first[a][b];
            c.end[a][b] = list->first[a][b] + list->size[a][b];
        }
    }
    lay_out_kinds(list, broad->sorted.data, broad->found_count, world->pieces.kind);
    place_pairs(world, list->old_items.data, &c);
    pl_buffer items = list->items;
    list->items = list->old_items;
    list->old_items = items;
    world->schedule_dirty |= (list->count > 0) != (broad->found_count > 0);
    world->parts.buried = false;
    list->count = broad->found_count;
    broad->serial = world->serial;
    return true;
}
