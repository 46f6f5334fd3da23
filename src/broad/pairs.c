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

// So many pairs are worth a thread.
#define LEAST 2048

typedef struct sorter {
    const pl_found *found;
    uint32_t count;
    pl_found *sorted;
    uint32_t *at; // a piece slot: of how many pairs it is the lower one; then where the next goes
    uint32_t slots, shares;
} sorter;

// The pairs whose lower piece is in a share of the slots. Each thread goes over all that was found, so it
// knows how many come before its own.
static void sort_share(void *context, uint32_t i)
{
    const sorter *s = context;
    const pl_share mine = pl_share_of(s->slots, s->shares, i);
    const uint32_t width = mine.end - mine.first;
    uint32_t *at = s->at + mine.first, before = 0;
    memset(at, 0, width * sizeof *at);
    for (uint32_t k = 0; k < s->count; ++k) {
        uint32_t low = s->found[k].low - mine.first;
        before += s->found[k].low < mine.first;
        if (low < width) {
            ++at[low];
        }
    }
    uint32_t sum = before;
    for (uint32_t k = 0; k < width; ++k) {
        uint32_t here = at[k];
        at[k] = sum;
        sum += here;
    }
    for (uint32_t k = 0; k < s->count; ++k) {
        uint32_t low = s->found[k].low - mine.first;
        if (low < width) {
            s->sorted[at[low]++] = s->found[k];
        }
    }
    // Each `at` now is where the pairs of the next piece begin.
    for (uint32_t k = 0; k < width; ++k) {
        uint32_t first = k == 0 ? before : at[k - 1];
        if (at[k] - first > 1) {
            sort_run(s->sorted + first, at[k] - first);
        }
    }
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
    sorter s = { .found = broad->found.data,
                 .count = broad->found_count,
                 .sorted = broad->sorted.data,
                 .at = broad->counts.data,
                 .slots = (uint32_t)slots,
                 .shares = pl_tasks_share_count(world->tasks, broad->found_count, LEAST) };
    pl_tasks_run(world->tasks, sort_share, &s, s.shares);
    return true;
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

pl_pair *pl_pairs_find_one(const plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_pair_list *list = &world->broad.pairs;
    uint8_t kind_p = world->pieces.kind[p], kind_q = world->pieces.kind[q];
    uint8_t a = kind_p < kind_q ? kind_p : kind_q, b = kind_p < kind_q ? kind_q : kind_p;
    pl_pair *pairs = pl_pairs(list) + list->first[a][b];
    uint32_t low = 0, high = list->size[a][b];
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (pl_pair_key(pairs[middle].a, pairs[middle].b) < pl_pair_key(p, q)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    bool found =
        low < list->size[a][b] && pl_pair_key(pairs[low].a, pairs[low].b) == pl_pair_key(p, q);
    return found ? &pairs[low] : NULL;
}

//---- merging with the list before -----------------------------------------------------------------

typedef struct merger {
    plumb_world *world;
    const uint8_t *left; // marks of the pieces whose pairs were found; NULL: all were
    bool reborn;         // a slot may have changed its piece
    const pl_pair *old, *old_end;
    const pl_pair *kept; // first of the pairs of the old list that stay and are yet to be copied
    pl_pair *out;
    bool changed;
} merger;

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

// Copies the pairs that stay, up to `end`.
static void copy_kept(merger *m, const pl_pair *end)
{
    size_t count = (size_t)(end - m->kept);
    if (count > 0) {
        memcpy(m->out, m->kept, count * sizeof(pl_pair));
    }
    m->out += count;
    m->kept = end;
}

static void drop_old(merger *m)
{
    copy_kept(m, m->old);
    m->kept = ++m->old;
    m->changed = true;
}

static void add_fresh(merger *m, pl_found found)
{
    copy_kept(m, m->old);
    *m->out++ = pl_pair_fresh(m->world, found);
    m->changed = true;
}

// What becomes of the next pair of the old list, when the next one found has this key. True: it is
// that one, and stays.
static bool pass_old(merger *m, uint64_t key)
{
    const pl_pair *old = m->old;
    bool is_found = pl_pair_key(old->a, old->b) == key;
    if (!is_found && (m->left == NULL || m->left[old->a] != 0 || m->left[old->b] != 0)) {
        lose_pair(m->world, old);
        drop_old(m);
        return false;
    }
    if (m->reborn && (is_younger(m->world, old->a) || is_younger(m->world, old->b))) {
        pl_pair_lost(m->world, old); // other pieces in the same slots
        drop_old(m);
        return false;
    }
    ++m->old;
    return is_found;
}

// The pairs of two kinds; what was found is in order.
static void merge_kinds(merger *m, const pl_found *found, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        uint64_t key = pl_pair_key(found[i].low, found[i].high);
        while (m->old < m->old_end && pl_pair_key(m->old->a, m->old->b) < key) {
            pass_old(m, key);
        }
        if (m->old == m->old_end || pl_pair_key(m->old->a, m->old->b) != key || !pass_old(m, key)) {
            add_fresh(m, found[i]);
        }
    }
    while (m->old < m->old_end) {
        pass_old(m, UINT64_MAX);
    }
}

// Sorts broad->sorted by kinds into broad->found; the order within stays.
static void part_kinds(plumb_world *world, pl_by_kinds first, pl_by_kinds size)
{
    pl_broad *broad = &world->broad;
    const uint8_t *kind = world->pieces.kind;
    const pl_found *sorted = broad->sorted.data;
    pl_found *parted = broad->found.data;
    pl_by_kinds at;
    memset(size, 0, sizeof(pl_by_kinds));
    for (uint32_t i = 0; i < broad->found_count; ++i) {
        uint8_t low = kind[sorted[i].low], high = kind[sorted[i].high];
        ++size[low < high ? low : high][low < high ? high : low];
    }
    uint32_t sum = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            at[a][b] = first[a][b] = sum;
            sum += size[a][b];
        }
    }
    for (uint32_t i = 0; i < broad->found_count; ++i) {
        uint8_t low = kind[sorted[i].low], high = kind[sorted[i].high];
        parted[at[low < high ? low : high][low < high ? high : low]++] = sorted[i];
    }
}

// The old list and what was found, to a new list in old_items. False: nothing has changed.
static bool merge(plumb_world *world, const uint8_t *left)
{
    pl_broad *broad = &world->broad;
    pl_pair_list *list = &broad->pairs;
    merger m = { .world = world,
                 .left = left,
                 .reborn = world->serial > broad->serial,
                 .old = list->items.data,
                 .kept = list->items.data,
                 .out = list->old_items.data };
    pl_by_kinds first, size, new_first, new_size;
    part_kinds(world, first, size);
    // The runs of the kinds follow one another in both lists, so pairs that stay are copied across them.
    uint32_t before = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            m.old_end = m.old + list->size[a][b];
            merge_kinds(&m, (const pl_found *)broad->found.data + first[a][b], size[a][b]);
            uint32_t here =
                (uint32_t)(m.out - (pl_pair *)list->old_items.data) + (uint32_t)(m.old - m.kept);
            new_first[a][b] = before;
            new_size[a][b] = here - before;
            before = here;
        }
    }
    if (!m.changed) {
        return false;
    }
    copy_kept(&m, pl_pairs(list) + list->count);
    memcpy(list->first, new_first, sizeof new_first);
    memcpy(list->size, new_size, sizeof new_size);
    world->schedule_dirty |= (list->count > 0) != (before > 0);
    list->count = before;
    return true;
}

// The two lists take turns, so both get the room: else a second time as busy might find the smaller one.
static bool reserve_lists(plumb_world *world)
{
    pl_pair_list *list = &world->broad.pairs;
    size_t most = ((size_t)list->count + world->broad.found_count + 1) * sizeof(pl_pair);
    return pl_buffer_reserve(&world->memory, &list->items, most) &&
           pl_buffer_reserve(&world->memory, &list->old_items, most);
}

bool pl_pairs_update(plumb_world *world)
{
    pl_broad *broad = &world->broad;
    pl_pair_list *list = &broad->pairs;
    const bool whole = broad->stale;
    if (!(whole ? pl_pairs_find(world) : pl_pairs_find_left(world)) || !sort_found(world) ||
        !reserve_lists(world) || !pl_events_reserve_ends(world, list->count) ||
        !pl_parts_reserve(world, list->count)) {
        broad->stale = true; // what sensors see may have been taken out
        return false;
    }
    bool changed = merge(world, whole ? NULL : broad->left_marks.data);
    if (changed) {
        pl_buffer items = list->items;
        list->items = list->old_items;
        list->old_items = items;
    }
    broad->rebuilds += changed || whole || world->sensor_pieces > 0; // or what sensors see
    world->rows_moved |= whole; // contacts of what woke do not know their rows
    world->parts.buried = false;
    broad->serial = world->serial;
    broad->stale = false;
    pl_broad_forget_left(broad);
    return true;
}
