// plan.c - which bodies hang together, in which order they are eliminated, and what that fills in.
//
// Two bodies are neighbours that a contact or joint ties. The order is that of least degree, by the quotient graph: a body
// that is gone leaves an element, the list of those behind it that it made neighbours (George and Liu 1989). Chains and trees
// fill in nothing.
//
// Bodies are told by their place: the order of their handles. Contacts and joints are listed by the places of their bodies, then
// by handles of pieces and joints. So what is the same in an island stays so whatever else there is, and wherever rows went.
//
// Reads: manifolds, marks of joints, slots. Writes: world->exact. Order: after the graph. Cost: O(entries + contacts).
#include "core/sort.h"
#include "exact/exact.h"
#include "joints/joint.h"
#include "world/body_settings.h"

#include <string.h>

// Of an island: 150 MB.
#define MOST_ENTRIES 1000000u

typedef struct search {
    plumb_world *world;
    pl_exact_solver *exact;
    uint32_t base; // first of the slots that are looked at: all that move, or those of hard islands
    uint32_t slots, ties;     // how many; contacts and joints between two of them
    uint32_t *place;          // a slot, from `base` on. What follows is about places
    uint32_t *slot;           // a place
    uint32_t *first, *length; // in `near`; of it
    uint32_t *elements;       // how many of its list are elements; these come first
    uint32_t *near;           // places, for elements their nodes
    uint32_t *island;
    uint32_t *node;                   // PL_NONE: not yet eliminated
    uint32_t *mark, *seen;            // stamp of the column, and of the count, that met it last
    uint32_t *degree, *next, *before; // in the list of its degree
    uint32_t *list;                   // a degree: first place
    pl_keyed *keyed;                  // scratch
    uint32_t stamp, count;
} search;

void pl_exact_free(pl_memory *memory, pl_exact_solver *e)
{
    pl_buffer *all[] = { &e->nodes,  &e->entries, &e->items,    &e->islands, &e->rows,
                         &e->blocks, &e->vectors, &e->turnings, &e->scratch };
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
        pl_buffer_free(memory, all[i]);
    }
}

//---- contacts and joints -------------------------------------------------------------------------------

// Of bodies that move: all, or those of hard islands.
static pl_slots slots_of(const pl_solver *s)
{
    return s->hard_cluster == PL_NONE ? (pl_slots){ 0, s->dynamic_slots }
                                      : pl_clusters(s)[s->hard_cluster].slots[0];
}

static bool list_items(plumb_world *world, pl_exact_solver *e)
{
    const pl_solver *solver = &world->solver;
    const uint32_t movable = world->dynamic_count + world->kinematic_count;
    const pl_manifold *manifolds = pl_manifolds(&world->narrow);
    const uint32_t contacts = pl_classic_count(solver, world->narrow.manifold_count);
    const pl_joint_context c = pl_joint_context_of(
        world, solver->hard_cluster == PL_NONE ? 0 : solver->hard_cluster, NULL, 0, 1, 1);
    const bool any = pl_joints_any(&c);
    const uint32_t joints = any ? c.group->end - c.group->alone : 0;
    if (!pl_buffer_reserve(&world->memory, &e->items,
                           2 * ((size_t)contacts + joints) * sizeof(pl_exact_item))) {
        return false;
    }
    pl_exact_item *items = e->items.data;
    e->item_count = contacts + joints;
    e->turning_count = 0;
    for (uint32_t i = 0; i < contacts; ++i) {
        const pl_manifold *m = &manifolds[pl_classic_manifold(solver, i)];
        const bool turns = pl_exact_may_turn(world, m);
        items[i] = (pl_exact_item){ .contact = i,
                                    .joint = PL_NONE,
                                    .turning = turns ? e->turning_count++ : PL_NONE,
                                    .slot = { pl_solver_slot(solver, m->body_a, movable),
                                              pl_solver_slot(solver, m->body_b, movable) },
                                    .row_count = 2u * m->count + (m->rolling > 0 ? 1 : 0) };
    }
    const uint32_t *grouped = world->joints.plan.grouped.data;
    for (uint32_t i = 0; i < joints; ++i) {
        const pl_joint_mark *mark = &pl_joint_marks(&world->joints)[grouped[c.group->alone + i]];
        items[contacts + i] =
            (pl_exact_item){ .contact = PL_NONE,
                             .joint = c.group->alone + i,
                             .turning = PL_NONE,
                             .slot = { pl_solver_slot(solver, mark->row_a, movable),
                                       pl_solver_slot(solver, mark->row_b, movable) },
                             .row_count = PL_JOINT_ROWS };
    }
    return pl_buffer_reserve(&world->memory, &e->turnings,
                             e->turning_count * sizeof(pl_exact_turning));
}

//---- neighbours --------------------------------------------------------------------------------------

// PL_NONE: the body does not move, or only as it likes.
static uint32_t place_of(const search *s, const pl_exact_item *item, int end)
{
    const uint32_t slot = item->slot[end] - s->base;
    return slot < s->slots ? s->place[slot] : PL_NONE;
}

static bool is_tie(const search *s, const pl_exact_item *item)
{
    return item->slot[0] - s->base < s->slots && item->slot[1] - s->base < s->slots &&
           item->slot[0] != item->slot[1];
}

static bool open_search(plumb_world *world, pl_exact_solver *e, search *s)
{
    const pl_slots slots = slots_of(&world->solver);
    *s = (search){ .world = world, .exact = e, .base = slots.first, .slots = slots.count };
    const pl_exact_item *items = e->items.data;
    for (uint32_t i = 0; i < e->item_count; ++i) {
        s->ties += is_tie(s, &items[i]);
    }
    const size_t n = s->slots, keyed = n > e->item_count ? n : e->item_count;
    if (!pl_buffer_reserve(&world->memory, &e->scratch,
                           keyed * sizeof(pl_keyed) +
                               (13 * n + 1 + 2 * (size_t)s->ties) * sizeof(uint32_t))) {
        return false;
    }
    s->keyed = e->scratch.data;
    uint32_t *at = (uint32_t *)(s->keyed + keyed);
    s->first = at, s->length = at + n, s->elements = at + 2 * n, s->island = at + 3 * n;
    s->node = at + 4 * n, s->mark = at + 5 * n, s->degree = at + 6 * n, s->next = at + 7 * n;
    s->before = at + 8 * n, s->place = at + 9 * n, s->slot = at + 10 * n, s->seen = at + 11 * n;
    s->list = at + 12 * n, s->near = at + 13 * n + 1;
    memset(s->length, 0, 2 * n * sizeof(uint32_t));    // and elements
    memset(s->island, 0xff, 2 * n * sizeof(uint32_t)); // and node
    memset(s->mark, 0, n * sizeof(uint32_t));
    memset(s->seen, 0, n * sizeof(uint32_t));
    memset(s->list, 0xff, (n + 1) * sizeof(uint32_t));
    return true;
}

static void order_bodies(search *s)
{
    const uint32_t *rows = s->world->solver.rows.data;
    const plumb_body *entity = s->world->bodies.entity;
    for (uint32_t i = 0; i < s->slots; ++i) {
        s->keyed[i] = (pl_keyed){ .key = entity[rows[s->base + i]].entity.index, .value = i };
    }
    pl_sort_keyed(s->keyed, s->slots);
    for (uint32_t i = 0; i < s->slots; ++i) {
        s->slot[i] = s->base + s->keyed[i].value;
        s->place[s->keyed[i].value] = i;
    }
}

// By handles of pieces, then of joints.
static uint64_t handle_key(const search *s, const pl_exact_item *item)
{
    if (item->contact == PL_NONE) {
        return pl_key(PL_NONE, ((const uint32_t *)s->world->joints.plan.grouped.data)[item->joint]);
    }
    const uint32_t manifold = pl_classic_manifold(&s->world->solver, item->contact);
    const uint32_t pair = pl_manifolds(&s->world->narrow)[manifold].pair;
    return pl_key(pl_pairs(&s->world->broad.pairs)[pair].a,
                  pl_pairs(&s->world->broad.pairs)[pair].b);
}

static void order_items(search *s)
{
    const uint32_t count = s->exact->item_count;
    if (count == 0) {
        return;
    }
    pl_exact_item *items = s->exact->items.data, *sorted = items + count;
    for (uint32_t i = 0; i < count; ++i) {
        s->keyed[i] = (pl_keyed){ .key = handle_key(s, &items[i]), .value = i };
    }
    pl_sort_keyed(s->keyed, count);
    for (uint32_t rank = 0; rank < count; ++rank) {
        const pl_exact_item *item = &items[s->keyed[rank].value];
        s->keyed[rank].key = pl_pair_key(place_of(s, item, 0), place_of(s, item, 1));
        s->keyed[rank].order = rank;
    }
    pl_sort_keyed(s->keyed, count);
    for (uint32_t i = 0; i < count; ++i) {
        sorted[i] = items[s->keyed[i].value];
    }
    memcpy(items, sorted, count * sizeof *items);
}

static void add_near(search *s, uint32_t to, uint32_t other)
{
    s->near[s->first[to] + s->length[to]++] = other;
}

// Lists of neighbours, each once.
static void list_neighbours(search *s)
{
    const pl_exact_item *items = s->exact->items.data;
    for (uint32_t i = 0; i < s->exact->item_count; ++i) {
        for (int end = 0; end < 2 && is_tie(s, &items[i]); ++end) {
            ++s->length[place_of(s, &items[i], end)];
        }
    }
    uint32_t at = 0;
    for (uint32_t v = 0; v < s->slots; ++v) {
        s->first[v] = at;
        at += s->length[v];
        s->length[v] = 0;
    }
    for (uint32_t i = 0; i < s->exact->item_count; ++i) {
        if (is_tie(s, &items[i])) {
            const uint32_t a = place_of(s, &items[i], 0), b = place_of(s, &items[i], 1);
            add_near(s, a, b);
            add_near(s, b, a);
        }
    }
    for (uint32_t v = 0; v < s->slots; ++v) {
        const uint32_t count = s->length[v];
        s->length[v] = 0;
        ++s->stamp;
        for (uint32_t k = 0; k < count; ++k) {
            const uint32_t u = s->near[s->first[v] + k];
            if (s->mark[u] != s->stamp) {
                s->mark[u] = s->stamp;
                add_near(s, v, u);
            }
        }
    }
}

//---- islands -----------------------------------------------------------------------------------------

// Numbers all that hangs together with place `from`; `queue` has room for all places.
static uint32_t flood(search *s, uint32_t from, uint32_t number, uint32_t *queue)
{
    uint32_t count = 0;
    queue[count++] = from;
    s->island[from] = number;
    for (uint32_t at = 0; at < count; ++at) {
        const uint32_t v = queue[at];
        for (uint32_t k = 0; k < s->length[v]; ++k) {
            const uint32_t u = s->near[s->first[v] + k];
            if (s->island[u] == PL_NONE) {
                s->island[u] = number;
                queue[count++] = u;
            }
        }
    }
    return count;
}

// The island of a contact or joint; NULL: nothing of it moves.
static pl_exact_island *island_of(const search *s, const pl_exact_item *item)
{
    const uint32_t a = place_of(s, item, 0), place = a != PL_NONE ? a : place_of(s, item, 1);
    return place != PL_NONE ? (pl_exact_island *)s->exact->islands.data + s->island[place] : NULL;
}

// Contacts and joints by their islands, in the order in which they were; rows of each.
static void sort_items(search *s)
{
    pl_exact_solver *e = s->exact;
    pl_exact_item *items = e->items.data;
    pl_exact_item *sorted =
        e->item_count > 0 ? items + e->item_count : items; // of none there is no array
    pl_exact_island *islands = e->islands.data;
    for (uint32_t i = 0; i < e->item_count; ++i) {
        pl_exact_island *island = island_of(s, &items[i]);
        if (island != NULL) {
            ++island->end_item;
        }
    }
    uint32_t at = 0;
    for (uint32_t k = 0; k < e->island_count; ++k) {
        islands[k].first_item = at;
        at += islands[k].end_item;
        islands[k].end_item = islands[k].first_item;
    }
    for (uint32_t i = 0; i < e->item_count; ++i) {
        pl_exact_island *island = island_of(s, &items[i]);
        if (island != NULL) {
            sorted[island->end_item++] = items[i];
        }
    }
    e->item_count = at;
    for (uint32_t i = 0; i < at; ++i) {
        items[i] = sorted[i];
    }
    e->row_count = 0;
    for (uint32_t k = 0; k < e->island_count; ++k) {
        islands[k].first_row = e->row_count;
        for (uint32_t i = islands[k].first_item; i < islands[k].end_item; ++i) {
            items[i].first_row = e->row_count;
            e->row_count += items[i].row_count;
        }
        islands[k].end_row = e->row_count;
    }
}

//---- elimination --------------------------------------------------------------------------------------

static void unlist(search *s, uint32_t v)
{
    if (s->before[v] != PL_NONE) {
        s->next[s->before[v]] = s->next[v];
    } else {
        s->list[s->degree[v]] = s->next[v];
    }
    if (s->next[v] != PL_NONE) {
        s->before[s->next[v]] = s->before[v];
    }
}

static void enlist(search *s, uint32_t v, uint32_t degree)
{
    s->degree[v] = degree;
    s->before[v] = PL_NONE;
    s->next[v] = s->list[degree];
    if (s->next[v] != PL_NONE) {
        s->before[s->next[v]] = v;
    }
    s->list[degree] = v;
}

static bool add_entry(search *s, uint32_t place)
{
    pl_exact_solver *e = s->exact;
    if (s->mark[place] == s->stamp) {
        return true;
    }
    s->mark[place] = s->stamp;
    if ((size_t)(e->entry_count + 1) * sizeof(uint32_t) > e->entries.size &&
        !pl_buffer_reserve(&s->world->memory, &e->entries,
                           2 * (size_t)(e->entry_count + 1) * sizeof(uint32_t))) {
        return false;
    }
    ((uint32_t *)e->entries.data)[e->entry_count++] = place;
    return true;
}

// All that a body has to do with when it goes, as places; the elements that it used up are gone with it.
static bool fill_column(search *s, uint32_t v, pl_exact_node *node)
{
    pl_exact_solver *e = s->exact;
    pl_exact_node *nodes = e->nodes.data;
    node->first = e->entry_count;
    ++s->stamp;
    s->mark[v] = s->stamp;
    for (uint32_t k = 0; k < s->length[v]; ++k) {
        const uint32_t u = s->near[s->first[v] + k];
        if (k >= s->elements[v]) {
            if (!add_entry(s, u)) {
                return false;
            }
            continue;
        }
        for (uint32_t i = nodes[u].first; i < nodes[u].first + nodes[u].count; ++i) {
            const uint32_t w = ((const uint32_t *)e->entries.data)[i];
            if (s->node[w] == PL_NONE && !add_entry(s, w)) {
                return false;
            }
        }
        nodes[u].where = 1; // used up
    }
    node->count = e->entry_count - node->first;
    return true;
}

static uint32_t count_once(search *s, uint32_t place)
{
    if (s->seen[place] == s->count || s->node[place] != PL_NONE) {
        return 0;
    }
    s->seen[place] = s->count;
    return 1;
}

// How many a body would leave as neighbours of one another.
static uint32_t degree_of(search *s, uint32_t v)
{
    const pl_exact_node *nodes = s->exact->nodes.data;
    const uint32_t *near = s->near + s->first[v], *entries = s->exact->entries.data;
    uint32_t degree = 0;
    s->seen[v] = ++s->count;
    for (uint32_t k = 0; k < s->length[v]; ++k) {
        if (k >= s->elements[v]) {
            degree += count_once(s, near[k]);
            continue;
        }
        const pl_exact_node *e = &nodes[near[k]];
        for (uint32_t i = e->first; i < e->first + e->count; ++i) {
            degree += count_once(s, entries[i]);
        }
    }
    return degree;
}

// A neighbour of the body that became `node`: what it knew of that, and of those that the element tells, goes.
static void shorten(search *s, uint32_t v, uint32_t node)
{
    const pl_exact_node *nodes = s->exact->nodes.data;
    uint32_t *near = s->near + s->first[v];
    uint32_t elements = 0, kept = 0, last = node; // goes in behind the elements that are left
    for (uint32_t k = 0; k < s->elements[v]; ++k) {
        if (nodes[near[k]].where == 0) {
            near[elements++] = near[k];
        }
    }
    kept = elements;
    for (uint32_t k = s->elements[v]; k < s->length[v]; ++k) {
        if (s->mark[near[k]] != s->stamp) {
            near[kept++] = near[k];
        }
    }
    // One place at least has become free: of the body itself, or of an element that was used up.
    if (kept > elements) {
        const uint32_t moved = near[elements];
        near[elements] = last;
        last = moved;
    }
    near[kept++] = last;
    s->elements[v] = elements + 1;
    s->length[v] = kept;
    unlist(s, v);
    enlist(s, v, degree_of(s, v));
}

static bool eliminate(search *s, uint32_t v)
{
    pl_exact_solver *e = s->exact;
    const uint32_t number = e->node_count++;
    pl_exact_node *node = (pl_exact_node *)e->nodes.data + number;
    *node = (pl_exact_node){ .slot = v };
    if (!fill_column(s, v, node)) {
        return false;
    }
    s->node[v] = number;
    for (uint32_t i = node->first; i < node->first + node->count; ++i) {
        shorten(s, ((const uint32_t *)e->entries.data)[i], number);
    }
    return true;
}

// Takes the places of `queue` in the order of least degree. An island of too many entries has none: what a body does to
// another is left out of Newton's steps, which then seldom settle, and are told as missed.
static bool eliminate_all(search *s, const uint32_t *queue, uint32_t count, pl_exact_island *island)
{
    pl_exact_solver *e = s->exact;
    const uint32_t first_entry = e->entry_count;
    bool too_dense = false;
    island->first_node = e->node_count;
    for (uint32_t i = count; i-- > 0;) {
        enlist(s, queue[i], s->length[queue[i]]);
    }
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t degree = 0;
        while (s->list[degree] == PL_NONE) {
            ++degree;
        }
        const uint32_t v = s->list[degree];
        unlist(s, v);
        if (!eliminate(s, v)) {
            return false;
        }
        if (e->entry_count - first_entry > MOST_ENTRIES) {
            too_dense = true;
            e->entry_count = first_entry;
            e->node_count = island->first_node;
            memset(s->list, 0xff, (s->slots + 1) * sizeof(uint32_t));
            break;
        }
    }
    for (uint32_t i = 0; i < count && too_dense; ++i) {
        s->node[queue[i]] = e->node_count;
        ((pl_exact_node *)e->nodes.data)[e->node_count++] =
            (pl_exact_node){ .slot = queue[i], .first = first_entry };
    }
    island->end_node = e->node_count;
    return true;
}

//---- all ---------------------------------------------------------------------------------------------

static bool find_islands(search *s)
{
    pl_exact_solver *e = s->exact;
    e->island_count = e->node_count = e->entry_count = 0;
    if (!pl_buffer_reserve(&s->world->memory, &e->nodes, s->slots * sizeof(pl_exact_node)) ||
        !pl_buffer_reserve(&s->world->memory, &e->islands, s->slots * sizeof(pl_exact_island)) ||
        !pl_buffer_reserve(&s->world->memory, &e->vectors,
                           PL_EXACT_VECTORS * 3 * (size_t)s->slots * sizeof(double))) {
        return false;
    }
    uint32_t *found = (uint32_t *)e->vectors.data; // scratch until the step is solved
    for (uint32_t v = 0; v < s->slots; ++v) {
        if (s->island[v] != PL_NONE) {
            continue;
        }
        pl_exact_island *island = (pl_exact_island *)e->islands.data + e->island_count;
        *island = (pl_exact_island){ 0 };
        const uint32_t count = flood(s, v, e->island_count, found);
        ++e->island_count;
        if (!eliminate_all(s, found, count, island)) {
            return false;
        }
    }
    return true;
}

// Entries as nodes; which entry is between the bodies of each contact and joint.
static void number_entries(search *s)
{
    pl_exact_solver *e = s->exact;
    uint32_t *entries = e->entries.data;
    const pl_exact_node *nodes = e->nodes.data;
    for (uint32_t i = 0; i < e->entry_count; ++i) {
        entries[i] = s->node[entries[i]];
    }
    pl_exact_item *items = e->items.data;
    for (uint32_t i = 0; i < e->item_count; ++i) {
        pl_exact_item *item = &items[i];
        for (int end = 0; end < 2; ++end) {
            const uint32_t place = place_of(s, item, end);
            item->node[end] = place != PL_NONE ? s->node[place] : PL_NONE;
        }
        item->entry = PL_NONE;
        if (item->node[0] == PL_NONE || item->node[1] == PL_NONE) {
            continue;
        }
        const uint32_t low = item->node[0] < item->node[1] ? item->node[0] : item->node[1];
        const uint32_t high = item->node[0] + item->node[1] - low;
        for (uint32_t k = nodes[low].first; k < nodes[low].first + nodes[low].count; ++k) {
            if (entries[k] == high) {
                item->entry = k;
            }
        }
    }
}

static void weigh(search *s)
{
    pl_exact_node *nodes = s->exact->nodes.data;
    const pl_solver *solver = &s->world->solver;
    const uint32_t *rows = solver->rows.data;
    for (uint32_t i = 0; i < s->exact->node_count; ++i) {
        nodes[i].slot = s->slot[nodes[i].slot]; // was the place
        const pl_solver_body *body = &pl_solver_bodies(solver)[nodes[i].slot];
        const uint16_t flags = s->world->bodies.flags[rows[nodes[i].slot]];
        nodes[i].inv_mass[0] = (double)pl_unlocked(flags, PL_BODY_LOCK_X, body->inv_mass);
        nodes[i].inv_mass[1] = (double)pl_unlocked(flags, PL_BODY_LOCK_Y, body->inv_mass);
    }
}

bool pl_exact_plan(plumb_world *world)
{
    pl_exact_solver *e = &world->exact;
    search s;
    e->factored = e->missed = 0;
    e->residual = 0;
    e->island_count = 0;
    if (!pl_exact_wanted(world)) {
        return true;
    }
    if (!list_items(world, e) || !open_search(world, e, &s)) {
        return false;
    }
    order_bodies(&s);
    order_items(&s);
    list_neighbours(&s);
    if (!find_islands(&s)) {
        return false;
    }
    sort_items(&s);
    number_entries(&s);
    weigh(&s);
    const size_t blocks = (size_t)e->node_count + 2 * (size_t)e->entry_count;
    return pl_buffer_reserve(&world->memory, &e->rows, e->row_count * sizeof(pl_exact_row)) &&
           pl_buffer_reserve(&world->memory, &e->blocks, 9 * blocks * sizeof(double));
}
