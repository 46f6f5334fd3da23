// soft.c - soft bodies in islands: whom they hold or touch falls asleep with them, and wakes with them.
//
// What touches is what comes within 2 cm or may in this step, as with bodies. A soft body asleep is in no list of an island: it
// wakes when something awake touches or holds it, and then its sleeping neighbours do.
//
// Reads: soft bodies, pieces, rows. Writes: parents, holds; soft bodies that lie down or wake. Cost: nothing without soft bodies. When
// islands are looked for O(soft bodies (bodies + pieces)), and nodes times pieces in their boxes; in the waking pass boxes of what moves against
// those of soft bodies asleep, and a query of what sleeps for each that is awake.
#include "sleep/fall.h"
#include "broad/images.h"
#include "core/union_find.h"
#include "softbody/softbody.h"
#include "world/rows.h"

#include <math.h>

#define TOUCHES 2e-3 // [m] between a node and what bears it, at most

typedef void mark_fn(pl_sleep *, uint32_t);

static pl_softbody *item_at(const plumb_world *world, uint32_t i)
{
    return &pl_softbody_items(&world->softbodies)[i];
}

// [m] that the fastest node may move in the step.
static real way_of(const plumb_world *world, const pl_softbody *item, pl_softbody_place at, real dt)
{
    return item->asleep ? 0 : (real)(3 * (double)dt * sqrt(pl_soft_square_speed(world, item, at)));
}

//---- falling asleep ------------------------------------------------------------------------------

uint32_t pl_sleep_soft_candidates(plumb_world *world)
{
    uint32_t *parents = world->sleep.parents.data, count = 0;
    uint8_t *held = world->sleep.held.data;
    for (uint32_t i = 0; i < world->softbodies.count; ++i) {
        const uint32_t m = world->dynamic_count + i;
        const pl_softbody *item = item_at(world, i);
        const bool rests = pl_soft_is_rested(item) && !pl_soft_is_blown(world, item);
        parents[m] = rests ? m : PL_NONE;
        held[m] = 0;
        count += rests;
    }
    return count;
}

// Soft body i with a row that it touches or is held by; `bears`: not from afar.
static void link_row(plumb_world *world, uint32_t i, uint32_t row, bool bears)
{
    uint32_t *parents = world->sleep.parents.data;
    uint8_t *held = world->sleep.held.data;
    const uint32_t m = world->dynamic_count + i;
    const bool candidate = row < world->dynamic_count && parents[row] != PL_NONE;
    if (parents[m] == PL_NONE) {
        if (candidate && !item_at(world, i)->asleep) {
            held[row] |= PL_HELD;
        }
    } else if (candidate) {
        pl_union_join(parents, row, m);
    } else {
        const bool calm = pl_is_calm(world, row) && !pl_row_is_asleep(world, row);
        const unsigned anchored = row >= world->dynamic_count && bears ? PL_ANCHORED : 0;
        held[m] = (uint8_t)(held[m] | anchored | (calm ? 0 : PL_HELD));
    }
}

static void link_pins(plumb_world *world, uint32_t i, pl_softbody_place at)
{
    uint8_t *held = world->sleep.held.data;
    const pl_softbody *item = item_at(world, i);
    for (uint32_t k = at.pin; k < at.pin + item->pins; ++k) {
        const uint32_t row = pl_body_row(world, pl_softbody_pins(&world->softbodies)[k].body);
        if (row == PL_NONE) {
            held[world->dynamic_count + i] |= PL_ANCHORED;
        } else {
            link_row(world, i, row, true);
        }
    }
}

static void link_touched(plumb_world *world, uint32_t i, pl_softbody_place at, real dt)
{
    const uint32_t rows = pl_partition_first(world, PL_PART_DISABLED);
    const pl_softbody *item = item_at(world, i);
    const real way = way_of(world, item, at, dt);
    for (uint32_t row = 0; row < rows; ++row) {
        const real by = way + (real)pl_soft_way_of_row(world, row, (double)dt);
        double least = INFINITY;
        for (uint32_t p = world->bodies.first_piece[row]; p != PL_NONE;
             p = world->pieces.next_in_body[p]) {
            const pl_box box = pl_piece_tight_box(world, p);
            if (pl_softbody_overlaps(item, &box, by)) {
                const double gap = pl_soft_gap(world, item, at, row, p, (double)dt);
                least = gap < least ? gap : least;
            }
        }
        if (least < INFINITY) {
            link_row(world, i, row, least <= TOUCHES);
        }
    }
}

void pl_sleep_soft_link(plumb_world *world, real dt)
{
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < world->softbodies.count; ++i) {
        const pl_softbody *item = item_at(world, i);
        if (!item->asleep) {
            link_pins(world, i, at);
            link_touched(world, i, at, dt);
        }
        at = pl_softbody_behind(at, item);
    }
}

void pl_sleep_soft_hold(plumb_world *world)
{
    const uint32_t *parents = world->sleep.parents.data;
    uint8_t *held = world->sleep.held.data;
    const double still = (double)PL_STILL * (double)world->desc.sleep_speed;
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < world->softbodies.count; ++i) {
        const uint32_t root = parents[world->dynamic_count + i];
        const pl_softbody *item = item_at(world, i);
        if (root != PL_NONE && !(held[root] & PL_ANCHORED) &&
            pl_soft_square_speed(world, item, at) > still * still) {
            held[root] |= PL_HELD;
        }
        at = pl_softbody_behind(at, item);
    }
}

void pl_sleep_soft_lie(plumb_world *world)
{
    const uint32_t *parents = world->sleep.parents.data;
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < world->softbodies.count; ++i) {
        if (parents[world->dynamic_count + i] != PL_NONE) {
            pl_softbody_lay(world, i, at);
        }
        at = pl_softbody_behind(at, item_at(world, i));
    }
}

//---- waking --------------------------------------------------------------------------------------

// A piece that is awake, or was placed here: a solid one touches, a volume of fluid drags what it reaches.
static bool is_reached(const plumb_world *world, const pl_softbody *item, pl_softbody_place at,
                       uint32_t piece, real dt)
{
    const pl_pieces *p = &world->pieces;
    if (!pl_softbody_overlaps(item, &p->fat[piece], 0)) {
        return false;
    }
    if ((p->flags[piece] & PL_PIECE_SENSOR) != 0) {
        return item->damping > 0 && world->materials.fluid[p->material[piece]];
    }
    return pl_soft_gap(world, item, at, p->body[piece], piece, (double)dt) < INFINITY;
}

static bool moves(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return b->vx[row] != 0 || b->vy[row] != 0 || b->w[row] != 0;
}

static bool is_touched(const plumb_world *world, const pl_softbody *item, pl_softbody_place at,
                       real dt)
{
    const uint32_t end = world->dynamic_count + world->kinematic_count;
    for (uint32_t k = at.pin; k < at.pin + item->pins; ++k) {
        const uint32_t row = pl_body_row(world, pl_softbody_pins(&world->softbodies)[k].body);
        if (row < world->dynamic_count || (row < end && moves(world, row))) {
            return true;
        }
    }
    for (uint32_t i = 0; i < world->moving_count; ++i) {
        const uint32_t piece = pl_moving(world)[i], row = world->pieces.body[piece];
        if ((row < world->dynamic_count || moves(world, row)) &&
            is_reached(world, item, at, piece, dt)) {
            return true;
        }
    }
    return false;
}

bool pl_sleep_soft_wake(plumb_world *world, real dt, mark_fn *mark)
{
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < world->softbodies.count && world->softbodies.asleep_count > 0; ++i) {
        const pl_softbody *item = item_at(world, i);
        if (item->asleep && (item->due || is_touched(world, item, at, dt))) {
            pl_softbody_rise(world, i);
        }
        at = pl_softbody_behind(at, item);
    }
    return pl_sleep_soft_mark(world, dt, mark);
}

static bool is_followed(const plumb_world *world, const pl_softbody *item, pl_softbody_place at,
                        uint32_t island, real dt)
{
    const pl_bodies *b = &world->bodies;
    uint32_t slot = pl_islands(&world->sleep)[island].first_body;
    while (slot != PL_NONE) {
        const uint32_t row = world->registry.slots[slot].row;
        for (uint32_t p = b->first_piece[row]; p != PL_NONE; p = world->pieces.next_in_body[p]) {
            const pl_box box = pl_piece_tight_box(world, p);
            if (pl_softbody_overlaps(item, &box,
                                     (real)pl_soft_way_of_row(world, row, (double)dt)) &&
                pl_soft_gap(world, item, at, row, p, (double)dt) < INFINITY) {
                return true;
            }
        }
        slot = b->next_asleep[row];
    }
    return false;
}

static bool is_held_by_marked(const plumb_world *world, const pl_softbody *item,
                              pl_softbody_place at)
{
    bool held = false;
    for (uint32_t k = at.pin; k < at.pin + item->pins && !held; ++k) {
        const uint32_t row = pl_body_row(world, pl_softbody_pins(&world->softbodies)[k].body);
        const uint32_t island = row == PL_NONE ? PL_NONE : world->bodies.island[row];
        held = island != PL_NONE && pl_islands(&world->sleep)[island].marked;
    }
    return held;
}

bool pl_sleep_soft_follow(plumb_world *world, real dt, uint32_t first)
{
    const uint32_t *marked = world->sleep.marked.data;
    pl_softbody_place at = { 0 };
    bool any = false;
    for (uint32_t i = 0; i < world->softbodies.count && world->softbodies.asleep_count > 0; ++i) {
        const pl_softbody *item = item_at(world, i);
        bool wakes = item->asleep && is_held_by_marked(world, item, at);
        for (uint32_t k = first; item->asleep && k < world->sleep.marked_count && !wakes; ++k) {
            wakes = is_followed(world, item, at, marked[k], dt);
        }
        if (wakes) {
            pl_softbody_rise(world, i);
            any = true;
        }
        at = pl_softbody_behind(at, item);
    }
    return any;
}

typedef struct seeker {
    plumb_world *world;
    const pl_softbody *item;
    pl_softbody_place at;
    real dt;
    mark_fn *mark;
} seeker;

static bool see_sleeper(void *context, const pl_grid_entry *entry)
{
    const seeker *k = context;
    plumb_world *world = k->world;
    const uint32_t piece = entry->piece, row = world->pieces.body[piece];
    if ((world->pieces.flags[piece] & PL_PIECE_ASLEEP) != 0 &&
        !pl_islands(&world->sleep)[world->bodies.island[row]].marked &&
        pl_soft_gap(world, k->item, k->at, row, piece, (double)k->dt) < INFINITY) {
        k->mark(&world->sleep, world->bodies.island[row]);
    }
    return true;
}

static bool mark_around(plumb_world *world, uint32_t i, pl_softbody_place at, real dt,
                        mark_fn *mark)
{
    const pl_softbody *item = item_at(world, i);
    for (uint32_t k = at.pin; k < at.pin + item->pins; ++k) {
        const uint32_t row = pl_body_row(world, pl_softbody_pins(&world->softbodies)[k].body);
        if (row != PL_NONE) {
            mark(&world->sleep, world->bodies.island[row]);
        }
    }
    const real way = way_of(world, item, at, dt);
    const pl_box box = { item->low.x - way, item->low.y - way, item->high.x + way,
                         item->high.y + way };
    seeker k = { world, item, at, dt, mark };
    return pl_world_query(world, &world->broad.resting, box, see_sleeper, &k);
}

bool pl_sleep_soft_mark(plumb_world *world, real dt, mark_fn *mark)
{
    pl_softbody_place at = { 0 };
    bool done = true;
    for (uint32_t i = 0; i < world->softbodies.count && world->asleep_count > 0 && done; ++i) {
        const pl_softbody *item = item_at(world, i);
        done = item->asleep || mark_around(world, i, at, dt, mark);
        at = pl_softbody_behind(at, item);
    }
    return done;
}
