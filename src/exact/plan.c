// plan.c - which bodies hang together, in which order they are eliminated, and what that fills in.
//
// Two bodies are neighbours that a contact or joint ties; the order is that of core/elimination.h.
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
    uint32_t slots;  // how many
    uint32_t *place; // a slot, from `base` on. What follows is about places
    uint32_t *slot;  // a place
    pl_keyed *keyed; // scratch
} search;

void pl_exact_free(pl_memory *memory, pl_exact_solver *e)
{
    pl_buffer *all[] = { &e->nodes,   &e->items,    &e->islands, &e->rows, &e->blocks,
                         &e->vectors, &e->turnings, &e->scratch, &e->swept };
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
        pl_buffer_free(memory, all[i]);
    }
    pl_elimination_free(memory, &e->elimination);
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
    const size_t n = s->slots, keyed = n > e->item_count ? n : e->item_count;
    if (!pl_buffer_reserve(&world->memory, &e->scratch,
                           keyed * sizeof(pl_keyed) + 2 * n * sizeof(uint32_t)) ||
        !pl_elimination_open(&world->memory, &e->elimination, s->slots, e->item_count)) {
        return false;
    }
    s->keyed = e->scratch.data;
    s->place = (uint32_t *)(s->keyed + keyed);
    s->slot = s->place + n;
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

static void pair_neighbours(search *s)
{
    const pl_exact_item *items = s->exact->items.data;
    pl_elimination *to = &s->exact->elimination;
    for (uint32_t i = 0; i < s->exact->item_count; ++i) {
        if (is_tie(s, &items[i])) {
            uint32_t *pair = to->pairs + 2 * (size_t)to->pair_count++;
            pair[0] = place_of(s, &items[i], 0), pair[1] = place_of(s, &items[i], 1);
        }
    }
}

//---- islands -----------------------------------------------------------------------------------------

// The island of a contact or joint; NULL: nothing of it moves.
static pl_exact_island *island_of(const search *s, const pl_exact_item *item)
{
    const uint32_t a = place_of(s, item, 0), place = a != PL_NONE ? a : place_of(s, item, 1);
    return place != PL_NONE
               ? (pl_exact_island *)s->exact->islands.data + s->exact->elimination.component[place]
               : NULL;
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
        pl_range_open(&islands[k].first_item, &islands[k].end_item, &at);
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

//---- nodes -------------------------------------------------------------------------------------------

// An island of too many entries has none: what a body does to another is left out of Newton's steps, which then seldom settle,
// and are told as missed.
static bool find_islands(search *s)
{
    pl_exact_solver *e = s->exact;
    pl_elimination *order = &e->elimination;
    if (!pl_elimination_run(&s->world->memory, order, MOST_ENTRIES) ||
        !pl_buffer_reserve(&s->world->memory, &e->nodes, s->slots * sizeof(pl_exact_node)) ||
        !pl_buffer_reserve(&s->world->memory, &e->islands,
                           order->component_count * sizeof(pl_exact_island)) ||
        !pl_buffer_reserve(&s->world->memory, &e->vectors,
                           PL_EXACT_VECTORS * 3 * (size_t)s->slots * sizeof(double))) {
        return false;
    }
    e->node_count = s->slots;
    e->entry_count = order->entry_count;
    e->island_count = order->component_count;
    for (uint32_t k = 0; k < e->island_count; ++k) {
        ((pl_exact_island *)e->islands.data)[k] =
            (pl_exact_island){ .first_node = order->start[k], .end_node = order->start[k + 1] };
    }
    for (uint32_t i = 0; i < e->node_count; ++i) {
        ((pl_exact_node *)e->nodes.data)[i] = (pl_exact_node){ .slot = s->slot[order->order[i]],
                                                               .first = order->column[i],
                                                               .count = order->fill[i] };
    }
    return true;
}

// Entries as nodes; which entry is between the bodies of each contact and joint.
static void number_entries(search *s)
{
    pl_exact_solver *e = s->exact;
    uint32_t *entries = e->elimination.entries.data;
    const uint32_t *rank = e->elimination.rank;
    const pl_exact_node *nodes = e->nodes.data;
    for (uint32_t i = 0; i < e->entry_count; ++i) {
        entries[i] = rank[entries[i]];
    }
    pl_exact_item *items = e->items.data;
    for (uint32_t i = 0; i < e->item_count; ++i) {
        pl_exact_item *item = &items[i];
        for (int end = 0; end < 2; ++end) {
            const uint32_t place = place_of(s, item, end);
            item->node[end] = place != PL_NONE ? rank[place] : PL_NONE;
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
    pair_neighbours(&s);
    if (!find_islands(&s)) {
        return false;
    }
    sort_items(&s);
    number_entries(&s);
    weigh(&s);
    const size_t blocks = (size_t)e->node_count + 2 * (size_t)e->entry_count;
    return pl_buffer_reserve(&world->memory, &e->rows, e->row_count * sizeof(pl_exact_row)) &&
           pl_buffer_reserve(&world->memory, &e->swept,
                             e->row_count * sizeof(pl_exact_swept_row)) &&
           pl_buffer_reserve(&world->memory, &e->blocks, 9 * blocks * sizeof(double));
}
