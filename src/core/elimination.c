// elimination.c - order of least degree, by the quotient graph.
#include "core/elimination.h"
#include "core/dissection.h"

#include <string.h>

#define NONE UINT32_MAX

// Arrays of a word a vertex, beside `start` and `list`, which have one more.
#define ARRAYS 13

bool pl_elimination_open(pl_memory *memory, pl_elimination *e, uint32_t vertices, uint32_t pairs)
{
    const size_t n = vertices, words = (ARRAYS + 2) * n + 2 + 4 * (size_t)pairs;
    if (!pl_buffer_reserve(memory, &e->words, words * sizeof(uint32_t) + n)) {
        return false;
    }
    uint32_t *at = e->words.data;
    uint32_t **arrays[ARRAYS] = { &e->rank,   &e->component, &e->order,    &e->column, &e->fill,
                                  &e->first,  &e->length,    &e->elements, &e->mark,   &e->seen,
                                  &e->degree, &e->next,      &e->before };
    for (int i = 0; i < ARRAYS; ++i) {
        *arrays[i] = at, at += n;
    }
    e->start = at, at += n + 1;
    e->list = at, at += n + 1;
    e->pairs = at, at += 2 * (size_t)pairs;
    e->near = at, at += 2 * (size_t)pairs;
    e->used = (uint8_t *)at;
    e->count = vertices;
    e->pair_count = 0;
    e->whole = NONE;
    return true;
}

void pl_elimination_free(pl_memory *memory, pl_elimination *e)
{
    pl_buffer_free(memory, &e->words);
    pl_buffer_free(memory, &e->entries);
    pl_buffer_free(memory, &e->cuts);
}

//---- neighbours ----------------------------------------------------------------------------------

static void clear(pl_elimination *e)
{
    const size_t n = e->count;
    e->component_count = e->entry_count = 0;
    e->stamp = e->seen_stamp = 0;
    memset(e->length, 0, n * sizeof *e->length);
    memset(e->elements, 0, n * sizeof *e->elements);
    memset(e->mark, 0, n * sizeof *e->mark);
    memset(e->seen, 0, n * sizeof *e->seen);
    memset(e->used, 0, n);
    memset(e->component, 0xff, n * sizeof *e->component);
    memset(e->rank, 0xff, n * sizeof *e->rank);
    memset(e->list, 0xff, (n + 1) * sizeof *e->list);
}

static void add_near(pl_elimination *e, uint32_t to, uint32_t other)
{
    e->near[e->first[to] + e->length[to]++] = other;
}

// Lists of neighbours, each once.
static void list_neighbours(pl_elimination *e)
{
    for (uint32_t i = 0; i < 2 * e->pair_count; ++i) {
        ++e->length[e->pairs[i]];
    }
    uint32_t at = 0;
    for (uint32_t v = 0; v < e->count; ++v) {
        e->first[v] = at;
        at += e->length[v];
        e->length[v] = 0;
    }
    for (uint32_t i = 0; i < e->pair_count; ++i) {
        add_near(e, e->pairs[2 * i], e->pairs[2 * i + 1]);
        add_near(e, e->pairs[2 * i + 1], e->pairs[2 * i]);
    }
    for (uint32_t v = 0; v < e->count; ++v) {
        const uint32_t count = e->length[v];
        e->length[v] = 0;
        ++e->stamp;
        for (uint32_t k = 0; k < count; ++k) {
            const uint32_t u = e->near[e->first[v] + k];
            if (e->mark[u] != e->stamp) {
                e->mark[u] = e->stamp;
                add_near(e, v, u);
            }
        }
    }
}

// Numbers all that hangs together with vertex `from`; `queue` has room for all that are left.
static uint32_t flood(pl_elimination *e, uint32_t from, uint32_t *queue)
{
    uint32_t count = 0;
    queue[count++] = from;
    e->component[from] = e->component_count;
    for (uint32_t at = 0; at < count; ++at) {
        const uint32_t v = queue[at];
        for (uint32_t k = 0; k < e->length[v]; ++k) {
            const uint32_t u = e->near[e->first[v] + k];
            if (e->component[u] == NONE) {
                e->component[u] = e->component_count;
                queue[count++] = u;
            }
        }
    }
    return count;
}

//---- elimination ---------------------------------------------------------------------------------

static void unlist(pl_elimination *e, uint32_t v)
{
    if (e->before[v] != NONE) {
        e->next[e->before[v]] = e->next[v];
    } else {
        e->list[e->degree[v]] = e->next[v];
    }
    if (e->next[v] != NONE) {
        e->before[e->next[v]] = e->before[v];
    }
}

static void enlist(pl_elimination *e, uint32_t v, uint32_t degree)
{
    e->degree[v] = degree;
    e->before[v] = NONE;
    e->next[v] = e->list[degree];
    if (e->next[v] != NONE) {
        e->before[e->next[v]] = v;
    }
    e->list[degree] = v;
}

static const uint32_t *entries_of(const pl_elimination *e, uint32_t place)
{
    return (const uint32_t *)e->entries.data + e->column[place];
}

static bool add_entry(pl_memory *memory, pl_elimination *e, uint32_t v)
{
    if (e->mark[v] == e->stamp) {
        return true;
    }
    e->mark[v] = e->stamp;
    if ((size_t)(e->entry_count + 1) * sizeof(uint32_t) > e->entries.size &&
        !pl_buffer_reserve(memory, &e->entries,
                           2 * (size_t)(e->entry_count + 1) * sizeof(uint32_t))) {
        return false;
    }
    ((uint32_t *)e->entries.data)[e->entry_count++] = v;
    return true;
}

// All that a vertex has to do with when it goes to its place; the elements that it used up are gone with it.
static bool fill_column(pl_memory *memory, pl_elimination *e, uint32_t v, uint32_t place)
{
    e->column[place] = e->entry_count;
    ++e->stamp;
    e->mark[v] = e->stamp;
    for (uint32_t k = 0; k < e->length[v]; ++k) {
        const uint32_t u = e->near[e->first[v] + k];
        if (k >= e->elements[v]) {
            if (!add_entry(memory, e, u)) {
                return false;
            }
            continue;
        }
        for (uint32_t i = 0; i < e->fill[u]; ++i) {
            const uint32_t w = entries_of(e, u)[i]; // which the buffer that grows may move
            if (e->rank[w] == NONE && !add_entry(memory, e, w)) {
                return false;
            }
        }
        e->used[u] = 1;
    }
    e->fill[place] = e->entry_count - e->column[place];
    return true;
}

static uint32_t count_once(pl_elimination *e, uint32_t v)
{
    if (e->seen[v] == e->seen_stamp || e->rank[v] != NONE) {
        return 0;
    }
    e->seen[v] = e->seen_stamp;
    return 1;
}

// How many a vertex would leave as neighbours of one another.
static uint32_t degree_of(pl_elimination *e, uint32_t v)
{
    const uint32_t *near = e->near + e->first[v];
    uint32_t degree = 0;
    e->seen[v] = ++e->seen_stamp;
    for (uint32_t k = 0; k < e->length[v]; ++k) {
        if (k >= e->elements[v]) {
            degree += count_once(e, near[k]);
            continue;
        }
        for (uint32_t i = 0; i < e->fill[near[k]]; ++i) {
            degree += count_once(e, entries_of(e, near[k])[i]);
        }
    }
    return degree;
}

// A neighbour of the vertex that went to `place`: what it knew of that, and of those that the element tells, goes.
static void shorten(pl_elimination *e, uint32_t v, uint32_t place)
{
    uint32_t *near = e->near + e->first[v];
    uint32_t elements = 0, kept = 0, last = place; // goes in behind the elements that are left
    for (uint32_t k = 0; k < e->elements[v]; ++k) {
        if (e->used[near[k]] == 0) {
            near[elements++] = near[k];
        }
    }
    kept = elements;
    for (uint32_t k = e->elements[v]; k < e->length[v]; ++k) {
        if (e->mark[near[k]] != e->stamp) {
            near[kept++] = near[k];
        }
    }
    // One place at least has become free: of the vertex itself, or of an element that was used up.
    if (kept > elements) {
        const uint32_t moved = near[elements];
        near[elements] = last;
        last = moved;
    }
    near[kept++] = last;
    e->elements[v] = elements + 1;
    e->length[v] = kept;
    if (e->degree[v] != NONE) {
        unlist(e, v);
        enlist(e, v, degree_of(e, v));
    }
}

static bool eliminate(pl_memory *memory, pl_elimination *e, uint32_t v, uint32_t place)
{
    if (!fill_column(memory, e, v, place)) {
        return false;
    }
    e->rank[v] = place;
    for (uint32_t i = 0; i < e->fill[place]; ++i) {
        shorten(e, entries_of(e, place)[i], place);
    }
    return true;
}

// The order is `queue` itself, without entries: a matrix of its blocks beside the diagonal would be too large.
static void give_up(pl_elimination *e, const uint32_t *queue, uint32_t count, uint32_t from)
{
    const uint32_t start = e->start[e->component_count];
    e->entry_count = from;
    memset(e->list, 0xff, (e->count + 1) * sizeof *e->list);
    for (uint32_t i = 0; i < count; ++i) {
        e->rank[queue[i]] = start + i;
        e->column[start + i] = from;
        e->fill[start + i] = 0;
    }
}

static uint32_t take_least(pl_elimination *e)
{
    uint32_t degree = 0;
    while (e->list[degree] == NONE) {
        ++degree;
    }
    const uint32_t v = e->list[degree];
    unlist(e, v);
    return v;
}

// Takes the first vertices of `queue` in the order of least degree, the others in their own, to the places from the component's start on.
static bool eliminate_all(pl_memory *memory, pl_elimination *e, const uint32_t *queue,
                          uint32_t count, uint32_t by_degree, uint32_t most)
{
    const uint32_t from = e->entry_count, start = e->start[e->component_count];
    for (uint32_t i = count; i-- > 0;) {
        if (i < by_degree) {
            enlist(e, queue[i], e->length[queue[i]]);
        } else {
            e->degree[queue[i]] = NONE;
        }
    }
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t v = i < by_degree ? take_least(e) : queue[i];
        if (!eliminate(memory, e, v, start + i)) {
            return false;
        }
        if (e->entry_count - from > most) {
            give_up(e, queue, count, from);
            break;
        }
    }
    return true;
}

bool pl_elimination_run(pl_memory *memory, pl_elimination *e, uint32_t most)
{
    clear(e);
    list_neighbours(e);
    uint32_t at = 0;
    e->start[0] = 0;
    for (uint32_t v = 0; v < e->count; ++v) {
        if (e->component[v] != NONE) {
            continue;
        }
        uint32_t *queue = e->order + at; // told when all is known
        const uint32_t count = flood(e, v, queue);
        uint32_t by_degree = count;
        if (count > e->whole) {
            const size_t bytes = pl_dissection_words(e->count) * sizeof(uint32_t);
            if (!pl_buffer_reserve(memory, &e->cuts, bytes)) {
                return false;
            }
            by_degree = pl_dissect(e, queue, count, e->cuts.data);
        }
        if (!eliminate_all(memory, e, queue, count, by_degree, most)) {
            return false;
        }
        at += count;
        e->start[++e->component_count] = at;
    }
    for (uint32_t v = 0; v < e->count; ++v) {
        e->order[e->rank[v]] = v;
    }
    return true;
}
