// pairs.c - the pair list: what was found, merged with the list before it, so that contacts keep their
// impulses.
//
// Threads cut both lists at the same keys and merge what lies between two cuts. Cost: O(pairs), linear.
#include "broad/pairs.h"

#include "core/sort.h"
#include "world/state.h"
#include "world/wrap.h"

#include <string.h>

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

static uint64_t key_of_pair(const void *pairs, uint32_t place)
{
    const pl_pair *pair = (const pl_pair *)pairs + place;
    return pl_pair_key(pair->a, pair->b);
}

static uint64_t key_of_found(const void *found, uint32_t place)
{
    const pl_found *pair = (const pl_found *)found + place;
    return pl_key(pair->low, pair->high);
}

// Place of the first of `count` from `low` on that does not come before `key`.
static uint32_t seek(const void *items, uint64_t (*key_of)(const void *items, uint32_t place),
                     uint32_t low, uint32_t count, uint64_t key)
{
    uint32_t high = low + count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (key_of(items, middle) < key) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

pl_pair *pl_pairs_find_one(const plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_pair_list *list = &world->broad.pairs;
    uint8_t kind_p = world->pieces.kind[p], kind_q = world->pieces.kind[q];
    uint8_t a = kind_p < kind_q ? kind_p : kind_q, b = kind_p < kind_q ? kind_q : kind_p;
    const uint32_t end = list->first[a][b] + list->size[a][b];
    const uint64_t key = pl_pair_key(p, q);
    uint32_t at = seek(pl_pairs(list), key_of_pair, list->first[a][b], list->size[a][b], key);
    return at < end && key_of_pair(pl_pairs(list), at) == key ? pl_pairs(list) + at : NULL;
}

//---- merging with the list before -----------------------------------------------------------------

// So many pairs, old and found, are worth a thread.
#define LEAST 4096

// Where a share of both lists begins.
typedef struct cut {
    uint32_t old, found; // places
    uint32_t out;        // and in the new list
} cut;

typedef struct merger {
    const plumb_world *world;
    const uint8_t *left; // marks of the pieces whose pairs were found; NULL: all were
    bool reborn;         // a slot may have changed its piece
    const pl_pair *all;  // the old list
    const pl_pair *old, *old_end;
    const pl_pair *kept; // first of the pairs of the old list that stay and are yet to be copied
    pl_pair *out;
    uint32_t *lost; // places of those that do not, told of later
    bool changed;
} merger;

typedef struct merging {
    plumb_world *world;
    const pl_pair_listener *listener;
    const pl_sorted *sorted;
    merger start;
    pl_pair *made; // the new list
    uint32_t *lost;
    uint32_t shares;
    cut cuts[PLUMB_WORKERS_MAX + 1];
    uint32_t lost_count[PLUMB_WORKERS_MAX];
    pl_by_kinds size[PLUMB_WORKERS_MAX]; // of what was made
    bool changed[PLUMB_WORKERS_MAX];
} merging;

// Mark of a lost pair: its slots are those of another pair now.
#define REPLACED 0x80000000u

static bool is_younger(const plumb_world *world, uint32_t piece)
{
    return world->pieces.serial[piece] > world->broad.serial;
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

static void drop_old(merger *m, uint32_t mark)
{
    *m->lost++ = (uint32_t)(m->old - m->all) | mark;
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
        drop_old(m, 0);
        return false;
    }
    if (m->reborn && (is_younger(m->world, old->a) || is_younger(m->world, old->b))) {
        drop_old(m, REPLACED);
        return false;
    }
    ++m->old;
    return is_found;
}

// The pairs of two kinds; what was found is in order.
static void merge_kinds(merger *m, const pl_found *found, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        uint64_t key = pl_key(found[i].low, found[i].high);
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

// What of [first, first + size) lies between two cuts.
static pl_share clip(uint32_t first, uint32_t size, uint32_t from, uint32_t to)
{
    uint32_t end = first + size < to ? first + size : to;
    first = first > from ? first : from;
    return (pl_share){ first, end > first ? end : first };
}

// The runs of the kinds follow one another in both lists, so pairs that stay are copied across them.
static void merge_share(void *context, uint32_t i)
{
    merging *g = context;
    const pl_pair_list *list = &g->world->broad.pairs;
    const pl_sorted *sorted = g->sorted;
    const cut *from = &g->cuts[i], *to = from + 1;
    merger m = g->start;
    m.old = m.kept = m.all + from->old;
    m.out = g->made + from->out;
    m.lost = g->lost + from->old;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            if ((list->size[a][b] | sorted->size[a][b]) == 0) {
                g->size[i][a][b] = 0;
                continue;
            }
            pl_share old = clip(list->first[a][b], list->size[a][b], from->old, to->old);
            pl_share found = clip(sorted->first[a][b], sorted->size[a][b], from->found, to->found);
            uint32_t before = (uint32_t)(m.out - g->made) + (uint32_t)(m.old - m.kept);
            m.old_end = m.old + (old.end - old.first);
            merge_kinds(&m, sorted->pairs + found.first, found.end - found.first);
            g->size[i][a][b] = (uint32_t)(m.out - g->made) + (uint32_t)(m.old - m.kept) - before;
        }
    }
    if (m.changed || g->shares > 1) {
        copy_kept(&m, m.old);
    }
    g->changed[i] = m.changed;
    g->lost_count[i] = (uint32_t)(m.lost - g->lost) - from->old;
}

//---- shares --------------------------------------------------------------------------------------

// Cuts the longer list at `place`, the other where the same pair is or would be.
static cut cut_at(const merging *g, uint32_t place)
{
    const pl_pair_list *list = &g->world->broad.pairs;
    const pl_sorted *sorted = g->sorted;
    const bool by_old = list->count > sorted->count;
    for (int a = PL_PIECE_CIRCLE; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = a; b < PL_PIECE_KIND_COUNT; ++b) {
            uint32_t old = list->first[a][b], old_size = list->size[a][b];
            uint32_t found = sorted->first[a][b], found_size = sorted->size[a][b];
            if (by_old && place - old < old_size) {
                uint64_t key = key_of_pair(g->start.all, place);
                return (cut){ place, seek(sorted->pairs, key_of_found, found, found_size, key), 0 };
            }
            if (!by_old && place - found < found_size) {
                uint64_t key = key_of_found(sorted->pairs, place);
                return (cut){ seek(g->start.all, key_of_pair, old, old_size, key), place, 0 };
            }
        }
    }
    return (cut){ list->count, sorted->count, 0 };
}

// How many pairs a share keeps: those around which nobody looked.
static void count_kept(void *context, uint32_t i)
{
    merging *g = context;
    const uint8_t *left = g->start.left;
    uint32_t kept = 0;
    for (uint32_t k = g->cuts[i].old; k < g->cuts[i + 1].old; ++k) {
        kept += (left[g->start.all[k].a] | left[g->start.all[k].b]) == 0;
    }
    g->cuts[i + 1].out = kept;
}

// Each share is to know where in the new list it begins: it makes a pair of each that was found, and of each old one
// around which nobody looked.
static void cut_up(merging *g)
{
    const uint32_t old = g->world->broad.pairs.count, found = g->sorted->count;
    const uint32_t longer = old > found ? old : found;
    const bool sure =
        g->start.left == NULL || !g->start.reborn; // else an old pair may go, though nobody looked
    g->shares = sure ? pl_tasks_share_count(g->world->tasks, longer, LEAST) : 1;
    g->cuts[0] = (cut){ 0, 0, 0 };
    for (uint32_t i = 1; i < g->shares; ++i) {
        g->cuts[i] = cut_at(g, pl_share_of(longer, g->shares, i).first);
    }
    g->cuts[g->shares] = (cut){ old, found, 0 };
    if (g->shares > 1 && g->start.left != NULL) {
        pl_tasks_run(g->world->tasks, count_kept, g, g->shares);
    }
    for (uint32_t i = 1; i <= g->shares; ++i) {
        cut *c = &g->cuts[i];
        c->out += c[-1].out + c->found - c[-1].found;
    }
}

//---- all -----------------------------------------------------------------------------------------

// What ceases to be touched rests anew: it may have lost what it stood on.
static void lose_pair(plumb_world *world, const pl_pair_listener *listener, const pl_pair *pair)
{
    const pl_pieces *pieces = &world->pieces;
    const uint32_t ends[2] = { pair->a, pair->b };
    for (int i = 0; i < 2 && (pair->flags & PL_PAIR_TOUCHING) != 0; ++i) {
        if (pieces->kind[ends[i]] != PL_PIECE_FREE) {
            world->bodies.rest_time[pieces->body[ends[i]]] = PL_NOT_RESTING;
        }
    }
    listener->lost(world, pair);
}

static void lose(const merging *g)
{
    for (uint32_t i = 0; i < g->shares; ++i) {
        const uint32_t *lost = g->lost + g->cuts[i].old;
        for (uint32_t k = 0; k < g->lost_count[i]; ++k) {
            const pl_pair *pair = g->start.all + (lost[k] & ~REPLACED);
            if ((lost[k] & REPLACED) == 0) {
                lose_pair(g->world, g->listener, pair);
            } else {
                g->listener->lost(g->world, pair);
            }
        }
    }
}

static void note_sizes(const merging *g, pl_pair_list *list)
{
    uint32_t sum = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            list->first[a][b] = sum;
            for (uint32_t i = 0; i < g->shares; ++i) {
                sum += g->size[i][a][b];
            }
            list->size[a][b] = sum - list->first[a][b];
        }
    }
    g->world->schedule_dirty |= (list->count > 0) != (sum > 0);
    list->count = sum;
}

// The old list and what was found, to a new list in old_items. False: nothing has changed.
static bool merge(plumb_world *world, const pl_pair_listener *listener, const pl_sorted *sorted,
                  const uint8_t *left)
{
    pl_broad *broad = &world->broad;
    if (sorted->count == 0 && broad->pairs.count == 0) {
        return false;
    }
    merging g; // most of it is for threads, and written where there are some
    g.world = world;
    g.listener = listener;
    g.sorted = sorted;
    g.start = (merger){ .world = world,
                        .left = left,
                        .reborn = world->serial > broad->serial,
                        .all = broad->pairs.items.data };
    g.made = broad->pairs.old_items.data;
    g.lost = broad->lost.data;
    cut_up(&g);
    pl_tasks_run(world->tasks, merge_share, &g, g.shares);
    lose(&g);
    bool changed = false;
    for (uint32_t i = 0; i < g.shares; ++i) {
        changed |= g.changed[i];
    }
    if (changed) {
        note_sizes(&g, &broad->pairs);
        pl_buffer items = broad->pairs.items;
        broad->pairs.items = broad->pairs.old_items;
        broad->pairs.old_items = items;
    }
    return changed;
}

// The two lists take turns, so both get the room: else a second time as busy might find the smaller one.
static bool reserve_lists(plumb_world *world)
{
    pl_pair_list *list = &world->broad.pairs;
    size_t most = ((size_t)list->count + world->broad.found_count + 1) * sizeof(pl_pair);
    return pl_buffer_reserve(&world->memory, &list->items, most) &&
           pl_buffer_reserve(&world->memory, &list->old_items, most) &&
           pl_buffer_reserve(&world->memory, &world->broad.lost,
                             ((size_t)list->count + 1) * sizeof(uint32_t));
}

bool pl_pairs_update(plumb_world *world, const pl_pair_listener *listener)
{
    pl_broad *broad = &world->broad;
    pl_pair_list *list = &broad->pairs;
    const bool whole = broad->stale || broad->emptied;
    pl_sorted sorted;
    if (!(whole ? pl_pairs_find(world) : pl_pairs_find_left(world)) ||
        !pl_pairs_sort(world, &sorted) || !reserve_lists(world) ||
        !listener->reserve(world, list->count)) {
        broad->stale = true; // what sensors see may have been taken out
        return false;
    }
    const bool changed = merge(world, listener, &sorted, whole ? NULL : broad->left_marks.data);
    broad->rebuilds += changed || whole || world->sensor_pieces > 0; // or what sensors see
    world->rows_moved |= broad->stale; // contacts of what woke do not know their rows
    world->parts.buried = false;
    broad->serial = world->serial;
    broad->stale = broad->emptied = false;
    pl_broad_forget_left(broad);
    return true;
}

//---- pairs that are sought (narrow/struck.c) ---------------------------------------------------------

// What a pair that was sought has as its value, if it was in no list before.
enum { LISTED, ADDED };

static pl_pair *find_sought(const plumb_world *world, const pl_keyed *sought)
{
    return pl_pairs_find_one(world, (uint32_t)(sought->key >> 32), (uint32_t)sought->key);
}

bool pl_pairs_seek(plumb_world *world, pl_keyed *sought, uint32_t count)
{
    pl_broad *broad = &world->broad;
    pl_sorted sorted;
    if (!pl_buffer_reserve(&world->memory, &broad->found, count * sizeof(pl_found))) {
        return false;
    }
    broad->found_count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (find_sought(world, &sought[i]) == NULL) {
            sought[i].value = ADDED;
            ((pl_found *)broad->found.data)[broad->found_count++] =
                (pl_found){ (uint32_t)(sought[i].key >> 32), (uint32_t)sought[i].key };
        }
    }
    if (!pl_pairs_sort(world, &sorted) || !reserve_lists(world)) {
        return false;
    }
    broad->rebuilds += merge(world, NULL, &sorted, broad->left_marks.data);
    for (uint32_t i = 0; i < count; ++i) {
        pl_pair *pair = find_sought(world, &sought[i]);
        // The face that parts the pieces as the step begins says nothing of later.
        pair->flags = (pair->flags & ~PL_PAIR_FACE_MASK) | PL_PAIR_SOUGHT;
    }
    return true;
}

void pl_pairs_seek_no_more(plumb_world *world, const pl_keyed *sought, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        pl_pair *pair = find_sought(world, &sought[i]);
        if (pair != NULL) {
            pair->flags &= ~PL_PAIR_SOUGHT;
        }
    }
}

// Closes up the list without the pairs that are PL_PAIR_SOUGHT.
static void take_out_sought(pl_pair_list *list)
{
    pl_pair *pairs = pl_pairs(list);
    uint32_t to = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            const uint32_t first = list->first[a][b], end = first + list->size[a][b];
            list->first[a][b] = to;
            for (uint32_t i = first; i < end; ++i) {
                if ((pairs[i].flags & PL_PAIR_SOUGHT) == 0) {
                    pairs[to++] = pairs[i];
                }
            }
            list->size[a][b] = to - list->first[a][b];
        }
    }
    list->count = to;
}

void pl_pairs_undo_seek(plumb_world *world, const pl_keyed *sought, uint32_t count)
{
    const pl_box *fat = world->pieces.fat;
    bool any = false;
    pl_pairs_seek_no_more(world, sought, count);
    for (uint32_t i = 0; i < count && !pl_is_wrapped(world); ++i) {
        pl_pair *pair = find_sought(world, &sought[i]);
        // One of the step before may touch, wherever its boxes are.
        if (pair != NULL && sought[i].value == ADDED &&
            !pl_boxes_overlap(&fat[pair->a], &fat[pair->b])) {
            pair->flags |= PL_PAIR_SOUGHT;
            any = true;
        }
    }
    if (any) {
        take_out_sought(&world->broad.pairs);
        ++world->broad.rebuilds;
    }
}
