// wake.c - the waking pass: islands that are due, and those that something touches, get up before
// contacts are looked for.
//
// 1. Fat boxes of what moves are brought up to date; what is near a sleeping piece is listed, anew
//    only when a box was left. Bodies that are awake count, kinematic ones that move or were
//    changed, and, once, static pieces that were placed here.
// 2. The narrow phase says which of these make a manifold, by the very rule that makes contacts.
// 3. Whoever wakes may touch others that sleep, or be joined to them: round by round, until no
//    manifold and no joint has a sleeping body on one side only.
// 4. All of them get up. Their contacts go back into the pair list, with impulses and flags, as if
//    they had never left it; those of pieces that are gone, too, so that their ends are told.
//
// So the solver never sees a sleeping body, and a body struck in this step moves in this step.
// Reads: pieces, grids, islands. Writes: rows, lists of pieces, pair list, wake events. Order:
// before the broad phase, whose refreshing of boxes it does. Cost: O(1) when nothing moves;
// O(moving pieces) when a box was left; O(what wakes), and one pass over the pair list, in steps in
// which something does.
#include "world/push.h"
#include "world/joint_list.h"
#include "world/island.h"
#include "world/marks.h"
#include "sleep/fall.h"
#include "broad/images.h"
#include "broad/pairs.h"
#include "core/sort.h"
#include "narrow/narrow.h"
#include "world/rows.h"

#include <string.h>

//---- pairs to look at ----------------------------------------------------------------------------

typedef struct seeker {
    plumb_world *world;
    uint32_t piece; // whose neighbours are being collected
} seeker;

static pl_found *found_at(const pl_sleep *s, uint32_t i)
{
    return (pl_found *)s->found.data + i;
}

static bool collect(void *context, const pl_grid_entry *entry)
{
    seeker *k = context;
    plumb_world *world = k->world;
    pl_sleep *s = &world->sleep;
    uint32_t p = k->piece, q = entry->piece;
    if ((world->pieces.flags[q] & PL_PIECE_ASLEEP) == 0 ||
        pl_islands(s)[world->bodies.island[world->pieces.body[q]]].marked ||
        !pl_pair_is_solid(world, p, q)) {
        return true;
    }
    if (!pl_buffer_reserve(&world->memory, &s->found, (s->found_count + 1) * sizeof(pl_found))) {
        return false;
    }
    *found_at(s, s->found_count++) = p < q ? (pl_found){ p, q } : (pl_found){ q, p };
    return true;
}

// Collects what sleeps near the boxes of a piece.
static bool seek(plumb_world *world, uint32_t piece, pl_box box)
{
    seeker k = { world, piece };
    return (world->pieces.flags[piece] & PL_PIECE_SENSOR) != 0 ||
           pl_world_query(world, &world->broad.resting, box, collect, &k);
}

// The found pairs by kinds, as the narrow phase wants them.
static bool lay_out(plumb_world *world, pl_pair_list *list)
{
    const pl_sleep *s = &world->sleep;
    const uint8_t *kind = world->pieces.kind;
    pl_by_kinds at;
    uint32_t first = 0;
    if (!pl_buffer_reserve(&world->memory, &list->items,
                           ((size_t)s->found_count + 1) * sizeof(pl_pair))) {
        return false;
    }
    memset(list->size, 0, sizeof list->size);
    for (uint32_t i = 0; i < s->found_count; ++i) {
        pl_pair pair = pl_pair_fresh(world, *found_at(s, i));
        ++list->size[kind[pair.a]][kind[pair.b]];
    }
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            at[a][b] = list->first[a][b] = first;
            first += list->size[a][b];
        }
    }
    for (uint32_t i = 0; i < s->found_count; ++i) {
        pl_pair pair = pl_pair_fresh(world, *found_at(s, i));
        pl_pairs(list)[at[kind[pair.a]][kind[pair.b]]++] = pair;
    }
    list->count = s->found_count;
    return true;
}

//---- marking -------------------------------------------------------------------------------------

// Room for every island is there.
static void mark(pl_sleep *s, uint32_t island)
{
    if (island != PL_NONE && !pl_islands(s)[island].marked) {
        pl_islands(s)[island].marked = true;
        ((uint32_t *)s->marked.data)[s->marked_count++] = island;
    }
}

static void unmark_all(pl_sleep *s)
{
    for (uint32_t i = 0; i < s->marked_count; ++i) {
        pl_islands(s)[((const uint32_t *)s->marked.data)[i]].marked = false;
    }
    s->marked_count = 0;
}

// What was made asleep since the last step, and something immovable that lies still: both are as the scene has them, in whatever
// order they were made.
static bool is_scenery(const plumb_world *world, uint32_t row, uint32_t sleeper)
{
    const pl_bodies *b = &world->bodies;
    return b->type[row] != PLUMB_DYNAMIC && b->vx[row] == 0 && b->vy[row] == 0 && b->w[row] == 0 &&
           pl_row_is_furnished(world, sleeper);
}

// Marks what the pairs of a list touch.
static bool mark_touched(plumb_world *world, const pl_pair_list *list, real dt)
{
    pl_sleep *s = &world->sleep;
    pl_pair *pairs = pl_pairs(list);
    if (list->count == 0) {
        return true;
    }
    if (!pl_narrow_reserve(world, list, &s->touched)) {
        return false;
    }
    for (uint32_t i = 0; i < list->count; ++i) {
        pairs[i].body_a = world->pieces.body[pairs[i].a];
        pairs[i].body_b = world->pieces.body[pairs[i].b];
    }
    if (!pl_narrow_run(world, list, dt, &s->touched)) {
        return false;
    }
    const pl_manifold *m = pl_manifolds(&s->touched);
    for (uint32_t i = 0; i < s->touched.manifold_count; ++i) {
        const uint32_t a = m[i].body_a, b = m[i].body_b;
        if (!is_scenery(world, a, b) && !is_scenery(world, b, a)) {
            mark(s, world->bodies.island[a]);
            mark(s, world->bodies.island[b]);
        }
    }
    return true;
}

// Kinematic bodies wake while they move and when they were changed.
static void note_stirring(plumb_world *world)
{
    pl_bodies *b = &world->bodies;
    uint32_t end = world->dynamic_count + world->kinematic_count;
    for (uint32_t row = world->dynamic_count; row < end; ++row) {
        bool stirs = b->vx[row] != 0 || b->vy[row] != 0 || b->w[row] != 0 ||
                     b->changed_step[row] == (uint32_t)(world->step_count + 1);
        world->sleep.near_stale |= stirs != b->stirring[row].is;
        b->stirring[row].is = stirs;
    }
}

static bool list_near(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    const pl_pieces *pieces = &world->pieces;
    s->found_count = 0;
    for (uint32_t i = 0; i < world->moving_count; ++i) {
        uint32_t piece = pl_moving(world)[i], row = pieces->body[piece];
        bool stirs = row < world->dynamic_count || world->bodies.stirring[row].is;
        if (stirs && !seek(world, piece, pieces->fat[piece])) {
            return false;
        }
    }
    return lay_out(world, &s->near);
}

// Marks what moving bodies touch.
static bool mark_near(plumb_world *world, real dt)
{
    pl_sleep *s = &world->sleep;
    if (world->moving_count == 0) {
        s->near.count = 0;
        s->near_stale = true;
        return true;
    }
    note_stirring(world);
    pl_broad_refresh_moving(world, dt);
    world->broad.refreshed = true;
    if (world->pairs_dirty || pl_broad_is_stale(&world->broad) || s->near_stale) {
        s->near_stale = true;
        if (!list_near(world)) {
            return false;
        }
        s->near_stale = false;
    }
    return mark_touched(world, &s->near, dt);
}

// Marks what static pieces touch that have come or were moved.
static bool mark_placed(plumb_world *world, real dt)
{
    pl_sleep *s = &world->sleep;
    const pl_pieces *pieces = &world->pieces;
    if (world->static_dirty) {
        pl_sensing_note_rest(world);
        pl_broad_refresh_fixed(world);
    }
    if (s->placed_pieces == 0) {
        return true;
    }
    s->found_count = 0;
    for (uint32_t p = 0; p < pieces->table.count; ++p) {
        if ((pieces->flags[p] & PL_PIECE_PLACED) != 0 && !seek(world, p, pieces->fat[p])) {
            return false;
        }
    }
    return lay_out(world, &s->probe) && mark_touched(world, &s->probe, dt);
}

static void forget_placed(plumb_world *world)
{
    for (uint32_t p = 0; world->sleep.placed_pieces > 0; ++p) {
        uint8_t *flags = &world->pieces.flags[p];
        world->sleep.placed_pieces -= (*flags & PL_PIECE_PLACED) != 0;
        *flags &= (uint8_t)~PL_PIECE_PLACED;
    }
}

static void mark_due(pl_sleep *s)
{
    for (uint32_t i = s->first_due; i != PL_NONE; i = pl_islands(s)[i].next_due) {
        mark(s, i);
    }
}

// The island of a piece that an impact of this step throws somebody at (narrow/struck.c); PL_NONE: it is awake. Of pair
// i / 2, its lower piece first.
static uint32_t struck_island(const plumb_world *world, uint32_t i)
{
    const pl_keyed *sought = (const pl_keyed *)world->lookahead.sought.data + i / 2;
    const uint32_t piece = i % 2 == 0 ? (uint32_t)(sought->key >> 32) : (uint32_t)sought->key;
    return world->bodies.island[world->pieces.body[piece]];
}

bool pl_sleep_is_struck(const plumb_world *world)
{
    bool any = false;
    for (uint32_t i = 0; i < 2 * world->lookahead.sought_count && !any; ++i) {
        any = struck_island(world, i) != PL_NONE;
    }
    return any;
}

static void mark_struck(plumb_world *world)
{
    for (uint32_t i = 0; i < 2 * world->lookahead.sought_count; ++i) {
        mark(&world->sleep, struck_island(world, i));
    }
}

//---- what wakes with them ------------------------------------------------------------------------

static void mark_joined(plumb_world *world, uint32_t row)
{
    const pl_joint *items = pl_joint_items(&world->joints);
    plumb_body body = world->bodies.entity[row];
    for (uint32_t i = world->bodies.first_joint[row]; i != PL_NONE;
         i = pl_joint_next(&items[i], body)) {
        plumb_body other = plumb_same(items[i].a.body, body) ? items[i].b.body : items[i].a.body;
        if (!plumb_is_null(other)) {
            mark(&world->sleep, world->bodies.island[pl_body_row(world, other)]);
        }
    }
}

// A body may have been pushed in its sleep: its boxes reach as far as it goes in the step.
static pl_box reach_of(const plumb_world *world, uint32_t piece, uint32_t row, real dt)
{
    pl_box box = world->pieces.fat[piece];
    real dx = world->bodies.vx[row] * dt, dy = world->bodies.vy[row] * dt;
    box.min_x += dx < 0 ? dx : 0;
    box.max_x += dx > 0 ? dx : 0;
    box.min_y += dy < 0 ? dy : 0;
    box.max_y += dy > 0 ? dy : 0;
    return box;
}

static bool seek_around(plumb_world *world, uint32_t island, real dt)
{
    const pl_bodies *b = &world->bodies;
    uint32_t slot = pl_islands(&world->sleep)[island].first_body;
    while (slot != PL_NONE) {
        uint32_t row = world->registry.slots[slot].row;
        mark_joined(world, row);
        uint32_t p = b->first_piece[row];
        for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
            if (!seek(world, p, reach_of(world, p, row, dt))) {
                return false;
            }
        }
        slot = b->next_asleep[row];
    }
    return true;
}

// From island `done` of those that are marked on.
static bool mark_neighbours_from(plumb_world *world, real dt, uint32_t done)
{
    pl_sleep *s = &world->sleep;
    while (done < s->marked_count) {
        s->found_count = 0;
        for (uint32_t end = s->marked_count; done < end; ++done) {
            if (!seek_around(world, ((const uint32_t *)s->marked.data)[done], dt)) {
                return false;
            }
        }
        if (s->found_count > 0 &&
            (!lay_out(world, &s->probe) || !mark_touched(world, &s->probe, dt))) {
            return false;
        }
    }
    return true;
}

// Where soft bodies hang in between, round by round.
static bool mark_neighbours(plumb_world *world, real dt)
{
    pl_sleep *s = &world->sleep;
    if (world->softbodies.count == 0) {
        return mark_neighbours_from(world, dt, 0);
    }
    uint32_t done = 0;
    bool any = true;
    if (!pl_sleep_soft_wake(world, dt, mark)) {
        return false;
    }
    while (any) {
        if (!mark_neighbours_from(world, dt, done)) {
            return false;
        }
        any = done < s->marked_count && pl_sleep_soft_follow(world, dt, done);
        done = s->marked_count;
        if (any && !pl_sleep_soft_mark(world, dt, mark)) {
            return false;
        }
    }
    return true;
}

//---- getting up ----------------------------------------------------------------------------------

// Kinds of a contact in the pair list: of one whose pieces have changed any will do, as it is only there to be lost.
static void kinds_of(const plumb_world *world, const pl_sleeping_contact *c, uint8_t kinds[2])
{
    const bool intact = pl_sleeping_contact_is_intact(world, c);
    kinds[0] = intact ? world->pieces.kind[c->pair.a] : PL_PIECE_CIRCLE;
    kinds[1] = intact ? world->pieces.kind[c->pair.b] : PL_PIECE_CIRCLE;
}

// The contacts of marked islands, in s->woken by kinds and key. Bodies and contacts are counted.
static bool list_woken(plumb_world *world, pl_by_kinds first, pl_by_kinds size, uint32_t *bodies)
{
    pl_sleep *s = &world->sleep;
    const pl_sleeping_contact *all = pl_sleeping_contacts(s);
    const uint32_t *marked = s->marked.data;
    pl_by_kinds at;
    uint32_t total = 0;
    uint8_t kind[2];
    *bodies = 0;
    memset(size, 0, sizeof(pl_by_kinds));
    for (uint32_t i = 0; i < s->marked_count; ++i) {
        const pl_island *island = &pl_islands(s)[marked[i]];
        *bodies += island->body_count;
        for (uint32_t c = island->first_contact; c != PL_NONE; c = all[c].next) {
            kinds_of(world, &all[c], kind);
            ++size[kind[0]][kind[1]];
        }
    }
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            at[a][b] = first[a][b] = total;
            total += size[a][b];
        }
    }
    if (!pl_buffer_reserve(&world->memory, &s->woken, total * sizeof(pl_keyed))) {
        return false;
    }
    pl_keyed *woken = s->woken.data;
    for (uint32_t i = 0; i < s->marked_count; ++i) {
        for (uint32_t c = pl_islands(s)[marked[i]].first_contact; c != PL_NONE; c = all[c].next) {
            kinds_of(world, &all[c], kind);
            uint32_t *to = &at[kind[0]][kind[1]];
            woken[(*to)++] = (pl_keyed){ pl_pair_key(all[c].pair.a, all[c].pair.b), 0, c };
        }
    }
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            if (size[a][b] > 0) { // else `woken` may be null
                pl_sort_keyed(woken + first[a][b], size[a][b]);
            }
        }
    }
    return true;
}

// Those of an island that was solved exactly are so again from the step in which they wake (exact/hard.c).
static pl_pair woken_pair(plumb_world *world, const pl_keyed *woken)
{
    const pl_sleeping_contact *c = &pl_sleeping_contacts(&world->sleep)[woken->value];
    world->solver.hard_pressed |= (c->pair.flags & PL_PAIR_PRESSED) != 0;
    world->solver.hard_before |= (c->pair.flags & PL_PAIR_EXACT) != 0;
    return c->pair; // its manifold is not one of this step, but tells whether it had one
}

// Merges the woken contacts into the pair list, kind by kind. Room must be reserved.
static void merge_pairs(plumb_world *world, pl_by_kinds first, pl_by_kinds size)
{
    pl_sleep *s = &world->sleep;
    pl_pair_list *list = &world->broad.pairs;
    const pl_pair *old = list->items.data;
    const pl_keyed *woken = s->woken.data;
    pl_pair *out = list->old_items.data;
    uint32_t count = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            uint32_t o = list->first[a][b], w = first[a][b];
            const uint32_t o_end = o + list->size[a][b], w_end = w + size[a][b];
            list->first[a][b] = count;
            while (o < o_end || w < w_end) {
                bool takes_old =
                    w == w_end || (o < o_end && pl_pair_key(old[o].a, old[o].b) < woken[w].key);
                out[count++] = takes_old ? old[o++] : woken_pair(world, &woken[w++]);
            }
            list->size[a][b] = count - list->first[a][b];
        }
    }
    pl_buffer items = list->items;
    list->items = list->old_items;
    list->old_items = items;
    list->count = count;
}

static void get_up(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    plumb_body *events = s->wake_events.data;
    for (uint32_t i = 0; i < s->marked_count; ++i) {
        uint32_t island = ((const uint32_t *)s->marked.data)[i];
        uint32_t slot = pl_islands(s)[island].first_body;
        while (slot != PL_NONE) {
            uint32_t row = world->registry.slots[slot].row;
            slot = world->bodies.next_asleep[row];
            events[s->wake_event_count++] = world->bodies.entity[row];
            world->bodies.island[row] = PL_NONE;
            pl_sleep_take_up(world, row);
        }
        pl_island_close(world, island);
    }
    s->marked_count = 0;
    s->near_stale = true;
    pl_sensing_note_rest(world);
    world->joints.awake_stale = true;
    world->schedule_dirty = true;   // there are pairs, if no rows
    world->broad.refreshed = false; // their boxes have not been
    world->pairs_dirty = true;
    world->broad.stale = true;
}

// By slots: they were marked in an order that depends on when the grids were filed, which a restored world does
// not remember, and rows follow the order in which islands get up.
static bool sort_marked(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    uint32_t *marked = s->marked.data;
    if (!pl_buffer_reserve(&world->memory, &s->woken, s->marked_count * sizeof(pl_keyed))) {
        return false;
    }
    pl_keyed *order = s->woken.data;
    for (uint32_t i = 0; i < s->marked_count; ++i) {
        order[i] = (pl_keyed){ marked[i], 0, marked[i] };
    }
    pl_sort_keyed(order, s->marked_count);
    for (uint32_t i = 0; i < s->marked_count; ++i) {
        marked[i] = order[i].value;
    }
    return true;
}

static bool wake_marked(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    pl_by_kinds first, size;
    uint32_t bodies;
    if (!sort_marked(world) || !list_woken(world, first, size, &bodies)) {
        return false;
    }
    size_t contacts = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            contacts += size[a][b];
        }
    }
    pl_buffer *old = &world->broad.pairs.old_items;
    size_t pairs = (world->broad.pairs.count + contacts) * sizeof(pl_pair);
    size_t events = ((size_t)s->wake_event_count + bodies) * sizeof(plumb_body);
    if (!pl_buffer_reserve(&world->memory, old, pairs) ||
        !pl_buffer_reserve(&world->memory, &s->wake_events, events)) {
        return false;
    }
    if (contacts > 0) {
        merge_pairs(world, first, size);
    }
    get_up(world);
    return true;
}

bool pl_sleep_wake(plumb_world *world, real dt)
{
    pl_sleep *s = &world->sleep;
    pl_sleep_lay(world);
    if (!pl_broad_update_resting(world) ||
        !pl_buffer_reserve(&world->memory, &s->marked, s->island_count * sizeof(uint32_t))) {
        return false;
    }
    mark_due(s);
    mark_struck(world);
    // A step that is taken anew, or looks again, has heard already, and forces have no part in one that moves nothing.
    const bool hears = dt > 0 && world->quarantine.attempt == 0 &&
                       world->lookahead.sought_count == 0 && pl_push_matters(world);
    if (hears) {
        pl_push_mark(world, mark);
    }
    bool done = mark_near(world, dt) && mark_placed(world, dt) && mark_neighbours(world, dt) &&
                (s->marked_count == 0 || wake_marked(world));
    if (done) {
        forget_placed(world);
        if (hears) {
            pl_push_settle(world);
        }
    } else {
        unmark_all(s);
        s->near_stale = true; // what was marked is not in it
    }
    return done;
}

void pl_sleep_free(pl_memory *memory, pl_sleep *s)
{
    pl_buffer *buffers[] = { &s->islands,     &s->contacts, &s->resting, &s->near.items,
                             &s->probe.items, &s->found,    &s->marked,  &s->woken,
                             &s->parents,     &s->held,     &s->places,  &s->sleep_events,
                             &s->wake_events, &s->fallen };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
    pl_narrow_free(memory, &s->touched);
    *s = (pl_sleep){ 0 };
}

// A step that ran out of memory may have woken bodies: they are still to be told.
void pl_sleep_events_clear(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    if (s->events_told) {
        s->sleep_event_count = s->wake_event_count = 0;
        s->events_told = false;
    }
}
