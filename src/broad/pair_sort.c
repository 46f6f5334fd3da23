// pair_sort.c - what was found, in the order of the list: by kinds, then by slots.
//
// Counting sort by `high`, then by kinds and `low`: no comparison, and a ground under thousands of bodies costs what
// as many loose pairs do. Threads first deal the pairs out by ranges of `low`, each then sorts its range; no pair comes
// twice, so the order is the same however they are dealt. Cost: O(pairs + piece slots), 2.4 ns a pair.
#include "broad/pairs.h"
#include "core/sort.h"
#include "world/state.h"

#include <string.h>

// So few pairs among so many slots (most asleep or static) are not worth a pass over the slots.
#define FEW 32

// So many pairs are worth a thread, and as many as there are slots: each has a counter for every slot.
#define LEAST 2048

#define KINDS   PL_PIECE_KIND_COUNT
#define CLASSES (KINDS * KINDS) // pairs of two kinds are a class
#define BUCKETS 256 // ranges of `low`, of which threads get as many as make equal numbers of pairs

// What a thread sorts.
typedef struct section {
    uint32_t first, end;         // pairs
    uint32_t low_first, low_end; // of which these are the lower slots
    uint32_t count[CLASSES];
    uint32_t at[CLASSES]; // where they go
} section;

typedef struct sorter {
    pl_found *from, *to;
    uint32_t count, slots, shares;
    const uint8_t *kind;       // of a slot
    uint8_t class_of[CLASSES]; // of two kinds: its place among those that can be
    uint32_t class_count;
    uint32_t *by_high; // slots for each share
    uint32_t *by_low;  // a share's slots for each class, share after share
    uint32_t *dealt;   // BUCKETS for each share
    uint32_t shift;    // of `low` to its bucket
    uint8_t share_of[BUCKETS];
    uint32_t *deal_at; // shares for each share
    section *sections; // one a share
} sorter;

// Numbers the classes that pieces of the kinds there are can make.
static void name_classes(const plumb_world *world, sorter *s)
{
    for (int a = 0; a < KINDS; ++a) {
        for (int b = a; b < KINDS; ++b) {
            if (world->piece_kinds[a] > 0 && world->piece_kinds[b] > 0) {
                s->class_of[a * KINDS + b] = s->class_of[b * KINDS + a] = (uint8_t)s->class_count++;
            }
        }
    }
}

static inline uint32_t class_of(const sorter *s, pl_found pair)
{
    return s->class_of[s->kind[pair.low] * KINDS + s->kind[pair.high]];
}

//---- dealing out ---------------------------------------------------------------------------------

static void count_dealt(void *context, uint32_t i)
{
    const sorter *s = context;
    const pl_share mine = pl_share_of(s->count, s->shares, i);
    uint32_t *dealt = s->dealt + (size_t)i * BUCKETS;
    memset(dealt, 0, BUCKETS * sizeof *dealt);
    for (uint32_t k = mine.first; k < mine.end; ++k) {
        ++dealt[s->from[k].low >> s->shift];
    }
}

// Sections of about equal numbers of pairs.
static void part_buckets(sorter *s)
{
    uint32_t i = 0, sum = 0;
    s->sections[0].low_first = s->sections[0].first = 0;
    for (uint32_t b = 0; b < BUCKETS; ++b) {
        s->share_of[b] = (uint8_t)i;
        for (uint32_t t = 0; t < s->shares; ++t) {
            uint32_t here = s->dealt[t * BUCKETS + b];
            s->deal_at[t * s->shares + i] += here;
            sum += here;
        }
        while (i + 1 < s->shares && sum >= pl_share_of(s->count, s->shares, i).end) {
            uint32_t low = (b + 1) << s->shift;
            low = low < s->slots ? low : s->slots;
            s->sections[i].end = s->sections[i + 1].first = sum;
            s->sections[i].low_end = s->sections[i + 1].low_first = low;
            ++i;
        }
    }
    s->sections[i].end = s->count;
    s->sections[i].low_end = s->slots;
    sum = 0;
    for (i = 0; i < s->shares; ++i) {
        for (uint32_t t = 0; t < s->shares; ++t) {
            uint32_t here = s->deal_at[t * s->shares + i];
            s->deal_at[t * s->shares + i] = sum;
            sum += here;
        }
    }
}

static void deal_share(void *context, uint32_t i)
{
    sorter *s = context;
    const pl_share mine = pl_share_of(s->count, s->shares, i);
    uint32_t at[PLUMB_WORKERS_MAX];
    memcpy(at, s->deal_at + (size_t)i * s->shares, s->shares * sizeof *at);
    for (uint32_t k = mine.first; k < mine.end; ++k) {
        s->to[at[s->share_of[s->from[k].low >> s->shift]]++] = s->from[k];
    }
}

static void turn_over(sorter *s)
{
    pl_found *from = s->from;
    s->from = s->to;
    s->to = from;
}

static void deal(plumb_world *world, sorter *s)
{
    if (s->shares == 1) {
        s->sections[0] = (section){ .end = s->count, .low_end = s->slots };
        return;
    }
    memset(s->deal_at, 0, (size_t)s->shares * s->shares * sizeof *s->deal_at);
    s->shift = 0;
    while ((s->slots - 1) >> s->shift >= BUCKETS) {
        ++s->shift;
    }
    pl_tasks_run(world->tasks, count_dealt, s, s->shares);
    part_buckets(s);
    pl_tasks_run(world->tasks, deal_share, s, s->shares);
    turn_over(s);
}

//---- sorting a section ---------------------------------------------------------------------------

// What the loops of a section need, apart from what they write: else it would be read again for each pair.
typedef struct reader {
    const pl_found *pairs;
    uint32_t count, low_first;
    const uint8_t *kind;
    uint32_t row[CLASSES]; // of two kinds: where the counters of their class begin
} reader;

static reader reader_of(const sorter *s, uint32_t i)
{
    const section *mine = &s->sections[i];
    reader r = { .pairs = s->from + mine->first,
                 .count = mine->end - mine->first,
                 .low_first = mine->low_first,
                 .kind = s->kind };
    for (uint32_t c = 0; c < CLASSES; ++c) {
        r.row[c] = s->class_of[c] * (mine->low_end - mine->low_first);
    }
    return r;
}

// Counter of a pair. `single`: all are of one class, which need not be looked up.
static inline uint32_t counter_of(const reader *r, pl_found pair, bool single)
{
    uint32_t row = single ? 0 : r->row[r->kind[pair.low] * KINDS + r->kind[pair.high]];
    return row + pair.low - r->low_first;
}

static inline __attribute__((always_inline)) void count_section(const reader *r,
                                                                uint32_t *restrict high,
                                                                uint32_t *restrict low, bool single)
{
    for (uint32_t k = 0; k < r->count; ++k) {
        const pl_found pair = r->pairs[k];
        ++high[pair.high];
        ++low[counter_of(r, pair, single)];
    }
}

static void sort_share_high(void *context, uint32_t i)
{
    sorter *s = context;
    section *mine = &s->sections[i];
    const uint32_t width = mine->low_end - mine->low_first;
    uint32_t *restrict high = s->by_high + (size_t)i * s->slots;
    uint32_t *low = s->by_low + (size_t)mine->low_first * s->class_count;
    const reader r = reader_of(s, i);
    memset(high, 0, s->slots * sizeof *high);
    memset(low, 0, (size_t)width * s->class_count * sizeof *low);
    if (s->class_count == 1) {
        count_section(&r, high, low, true);
    } else {
        count_section(&r, high, low, false);
    }
    pl_counts_to_places(high, s->slots, mine->first);
    for (uint32_t c = 0; c < s->class_count; ++c) {
        mine->count[c] = pl_counts_to_places(low + (size_t)c * width, width, 0);
    }
    pl_found *restrict to = s->to;
    for (uint32_t k = 0; k < r.count; ++k) {
        const pl_found pair = r.pairs[k];
        to[high[pair.high]++] = pair;
    }
}

static inline __attribute__((always_inline)) void sort_section(const reader *r,
                                                               uint32_t *restrict low,
                                                               pl_found *restrict to, bool single)
{
    for (uint32_t k = 0; k < r->count; ++k) {
        const pl_found pair = r->pairs[k];
        to[low[counter_of(r, pair, single)]++] = pair;
    }
}

// The counters of a class begin where it goes.
static void sort_share_low(void *context, uint32_t i)
{
    sorter *s = context;
    const section *mine = &s->sections[i];
    const uint32_t width = mine->low_end - mine->low_first;
    uint32_t *low = s->by_low + (size_t)mine->low_first * s->class_count;
    const reader r = reader_of(s, i);
    for (uint32_t c = 0; c < s->class_count; ++c) {
        for (uint32_t k = 0; k < width; ++k) {
            low[(size_t)c * width + k] += mine->at[c];
        }
    }
    if (s->class_count == 1) {
        sort_section(&r, low, s->to, true);
    } else {
        sort_section(&r, low, s->to, false);
    }
}

// Class by class, sections in order within.
static void place_classes(sorter *s, pl_sorted *sorted)
{
    uint32_t sum = 0;
    for (int a = 0; a < KINDS; ++a) {
        for (int b = 0; b < KINDS; ++b) {
            const uint32_t c = s->class_of[a * KINDS + b];
            sorted->first[a][b] = sum;
            for (uint32_t i = 0; i < s->shares && a <= b && c < s->class_count; ++i) {
                s->sections[i].at[c] = sum;
                sum += s->sections[i].count[c];
            }
            sorted->size[a][b] = sum - sorted->first[a][b];
        }
    }
}

static bool sort_many(plumb_world *world, sorter *s, pl_sorted *sorted)
{
    pl_broad *broad = &world->broad;
    const uint32_t least = s->slots > LEAST ? s->slots : LEAST;
    s->shares = pl_tasks_share_count(world->tasks, s->count, least);
    const size_t high = (size_t)s->shares * s->slots, low = (size_t)s->class_count * s->slots;
    const size_t dealt = (size_t)s->shares * BUCKETS, deal_at = (size_t)s->shares * s->shares;
    const size_t sections = s->shares * (sizeof(section) / sizeof(uint32_t));
    const size_t counts = high + low + dealt + deal_at + sections;
    _Static_assert(sizeof(section) % sizeof(uint32_t) == 0, "a section is numbers alone");
    if (!pl_buffer_reserve(&world->memory, &broad->counts, counts * sizeof(uint32_t))) {
        return false;
    }
    s->by_high = broad->counts.data;
    s->by_low = s->by_high + high;
    s->dealt = s->by_low + low;
    s->deal_at = s->dealt + dealt;
    s->sections = (section *)(void *)(s->deal_at + deal_at);
    deal(world, s);
    pl_tasks_run(world->tasks, sort_share_high, s, s->shares);
    place_classes(s, sorted);
    turn_over(s);
    pl_tasks_run(world->tasks, sort_share_low, s, s->shares);
    sorted->pairs = s->to;
    return true;
}

static bool sort_few(plumb_world *world, sorter *s, pl_sorted *sorted)
{
    section one = { 0 }, *all = s->sections = &one;
    if (!pl_buffer_reserve(&world->memory, &world->broad.counts,
                           ((size_t)s->count + 1) * sizeof(pl_keyed))) {
        return false;
    }
    pl_keyed *keyed = world->broad.counts.data;
    s->shares = 1;
    for (uint32_t i = 0; i < s->count; ++i) {
        ++all->count[class_of(s, s->from[i])];
    }
    place_classes(s, sorted);
    for (uint32_t i = 0; i < s->count; ++i) {
        uint64_t key = pl_key(s->from[i].low, s->from[i].high);
        keyed[all->at[class_of(s, s->from[i])]++] = (pl_keyed){ key, 0, 0 };
    }
    for (uint32_t c = 0; c < s->class_count; ++c) {
        pl_sort_keyed(keyed + (all->at[c] - all->count[c]), all->count[c]);
    }
    for (uint32_t i = 0; i < s->count; ++i) {
        s->to[i] = (pl_found){ (uint32_t)(keyed[i].key >> 32), (uint32_t)keyed[i].key };
    }
    sorted->pairs = s->to;
    return true;
}

bool pl_pairs_sort(plumb_world *world, pl_sorted *sorted)
{
    pl_broad *broad = &world->broad;
    const uint32_t count = broad->found_count;
    if (!pl_buffer_reserve(&world->memory, &broad->sorted,
                           ((size_t)count + 1) * sizeof(pl_found))) {
        return false;
    }
    if (count == 0) {
        *sorted = (pl_sorted){ .pairs = broad->sorted.data };
        return true;
    }
    sorter s; // what is for threads is written where there are some
    s.from = broad->found.data;
    s.to = broad->sorted.data;
    s.count = sorted->count = count;
    s.slots = world->pieces.table.count;
    s.kind = world->pieces.kind;
    s.class_count = 0;
    memset(s.class_of, CLASSES, sizeof s.class_of);
    name_classes(world, &s);
    return (size_t)count * FEW < s.slots ? sort_few(world, &s, sorted)
                                         : sort_many(world, &s, sorted);
}
