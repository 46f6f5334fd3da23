// piece.c - pieces: slots, the lists that run through them, and their corners in the vertex pool.
//
// Slots stay put while the shape lives, since grids and contacts name them. Free slots are a stack:
// the same calls give the same slots.
//
// Reads: world->made. Writes: piece table, vertex pool, moving list, counters and flags.
// Cost: O(pieces of the shape + pieces of the body).
#include "world/island.h"
#include "world/marks.h"
#include "world/stale_edges.h"
#include "world/rows.h"

#include <string.h>

// Either list has room for all pieces: bodies fall asleep, change their type and are enabled without
// asking.
static bool reserve_lists(plumb_world *world, uint32_t extra)
{
    size_t most = (size_t)world->pieces.table.count + extra;
    return pl_buffer_reserve(&world->memory, &world->moving, most * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &world->sleep.resting, most * sizeof(uint32_t));
}

bool pl_pieces_reserve(plumb_world *world, uint32_t extra)
{
    pl_pieces *pieces = &world->pieces;
    uint32_t free_slots = pieces->table.count - pieces->live;
    uint32_t fresh = extra > free_slots ? extra - free_slots : 0;
    if (fresh >= PL_NONE - pieces->table.count) {
        return false;
    }
    return pl_table_reserve(&world->memory, &pieces->table, pl_piece_columns, pl_piece_column_count,
                            pieces->table.count + fresh) &&
           reserve_lists(world, extra) &&
           pl_broad_reserve_left(world, pieces->table.count + fresh) &&
           pl_tombstones_reserve(world, pieces->table.count + fresh);
}

static uint32_t take_slot(plumb_world *world)
{
    pl_pieces *pieces = &world->pieces;
    uint32_t slot = pieces->free_head;
    if (slot == PL_NONE) {
        slot = pieces->table.count++;
    } else {
        pieces->free_head = pieces->next_in_shape[slot];
    }
    pl_table_clear(&pieces->table, pl_piece_columns, pl_piece_column_count, slot);
    ++pieces->live;
    pieces->serial[slot] = ++world->serial;
    return slot;
}

// Queries find it among the strays until all is filed anew.
static void stray(plumb_world *world, uint32_t slot)
{
    pl_query_grid_set *set = &world->query_grids;
    if (!set->fresh) {
        return;
    }
    uint32_t *strays = set->strays.data, i = 0;
    while (i < set->stray_count && strays[i] != slot) {
        ++i;
    }
    set->strays_filed = false;
    if (i == PL_QUERY_STRAYS_MOST) {
        set->fresh = false;
    } else if (i == set->stray_count) {
        strays[set->stray_count++] = slot;
    }
}

void pl_pieces_stray(plumb_world *world, uint32_t row)
{
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE && world->query_grids.fresh; p = world->pieces.next_in_body[p]) {
        stray(world, p);
    }
}

static void enlist(plumb_world *world, uint32_t *list, uint32_t *count, uint32_t slot)
{
    list[*count] = slot;
    world->pieces.moving[slot] = (*count)++;
}

// The last of the list fills the gap.
static void delist(plumb_world *world, uint32_t *list, uint32_t *count, uint32_t slot)
{
    uint32_t place = world->pieces.moving[slot];
    uint32_t last = list[--*count];
    list[place] = last;
    world->pieces.moving[last] = place;
    world->pieces.moving[slot] = PL_OUT;
}

static void enlist_resting(plumb_world *world, uint32_t slot)
{
    pl_sleep *s = &world->sleep;
    enlist(world, pl_resting(s), &s->resting_count, slot);
    world->pieces.flags[slot] |= PL_PIECE_ASLEEP;
    s->grid_stale = true;
}

static void delist_resting(plumb_world *world, uint32_t slot)
{
    pl_sleep *s = &world->sleep;
    delist(world, pl_resting(s), &s->resting_count, slot);
    world->pieces.flags[slot] &= (uint8_t)~PL_PIECE_ASLEEP;
    ++s->gone;
}

void pl_piece_lose_box(plumb_world *world, uint32_t slot)
{
    world->pieces.fat[slot] =
        (pl_box){ PLUMB_REAL_MAX, PLUMB_REAL_MAX, -PLUMB_REAL_MAX, -PLUMB_REAL_MAX };
}

bool pl_piece_has_lost_box(const pl_pieces *pieces, uint32_t piece)
{
    return pieces->fat[piece].min_x > pieces->fat[piece].max_x;
}

// Files a piece that is in no grid.
static void file(plumb_world *world, uint32_t slot, uint32_t row)
{
    pl_pieces *pieces = &world->pieces;
    pl_piece_lose_box(world, slot);
    stray(world, slot);
    if ((world->bodies.flags[row] & PL_BODY_DISABLED) != 0) {
        pieces->moving[slot] = PL_OUT;
    } else if (world->bodies.type[row] == PLUMB_STATIC) {
        pieces->moving[slot] = PL_NONE;
        world->static_dirty = true;
    } else if (pl_row_is_asleep(world, row)) {
        enlist_resting(world, slot);
        world->sleep.boxes_stale = true;
    } else {
        enlist(world, pl_moving(world), &world->moving_count, slot);
    }
}

static void unfile(plumb_world *world, uint32_t slot)
{
    stray(world, slot);
    if (world->pieces.moving[slot] == PL_NONE) {
        world->static_dirty = true;
    } else if ((world->pieces.flags[slot] & PL_PIECE_ASLEEP) != 0) {
        delist_resting(world, slot);
        pl_sensing_note_rest(world);
    } else if (world->pieces.moving[slot] != PL_OUT) {
        delist(world, pl_moving(world), &world->moving_count, slot);
    }
}

void pl_pieces_refile(plumb_world *world, uint32_t row)
{
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        unfile(world, p);
        file(world, p, row);
        pl_rearranged(world);
    }
    world->schedule_dirty = true;
}

void pl_piece_rest(plumb_world *world, uint32_t piece)
{
    stray(world, piece);
    delist(world, pl_moving(world), &world->moving_count, piece);
    enlist_resting(world, piece);
    // A piece alone in the world, or put to sleep between steps, may never have had a fat box.
    world->sleep.boxes_stale = true;
}

void pl_piece_move(plumb_world *world, uint32_t piece)
{
    stray(world, piece);
    delist_resting(world, piece);
    enlist(world, pl_moving(world), &world->moving_count, piece);
}

static void store_corners(plumb_world *world, uint32_t slot, const plumb_convex *convex)
{
    pl_pieces *pieces = &world->pieces;
    if (convex->count < 2) {
        return;
    }
    uint8_t vertex_class = pl_pool_class(convex->count);
    uint32_t first = pl_pool_take(&world->vertices, vertex_class);
    pieces->vertex_count[slot] = (uint8_t)convex->count;
    pieces->vertex_class[slot] = vertex_class;
    pieces->vertices[slot] = first;
    pl_vertex *corner = world->vertices.items + first;
    uint32_t run = pl_pool_run(vertex_class);
    for (uint32_t i = 0; i < run; ++i) {
        // What is left of the run repeats the last corner: kernels may read whole runs.
        uint32_t k = i < (uint32_t)convex->count ? i : (uint32_t)convex->count - 1;
        corner[i] = (pl_vertex){ convex->points[k].x, convex->points[k].y, convex->normals[k].x,
                                 convex->normals[k].y };
    }
}

static void fill_slot(plumb_world *world, uint32_t slot, uint32_t row, const pl_made_piece *made)
{
    pl_pieces *pieces = &world->pieces;
    pieces->kind[slot] = made->kind;
    pieces->core[slot] = made->core;
    pieces->cuts[slot] = made->cuts;
    pieces->body[slot] = row;
    pieces->first_sleeping[slot] = PL_NONE;
    store_corners(world, slot, &made->convex);
    ++world->piece_kinds[made->kind];
    file(world, slot, row);
}

uint32_t pl_pieces_add(plumb_world *world, uint32_t row, plumb_shape shape, const pl_made *made)
{
    pl_pieces *pieces = &world->pieces;
    const pl_made_piece *source = world->made.data;
    uint32_t first = PL_NONE;
    uint32_t before = PL_NONE;
    for (uint32_t i = 0; i < made->count; ++i) {
        uint32_t slot = take_slot(world);
        fill_slot(world, slot, row, &source[i]);
        pieces->shape[slot] = shape;
        if (before == PL_NONE) {
            first = slot;
        } else {
            pieces->next_in_shape[before] = slot;
            pieces->next_in_body[before] = slot;
        }
        before = slot;
    }
    pieces->next_in_shape[before] = PL_NONE;
    pieces->next_in_body[before] = world->bodies.first_piece[row];
    world->bodies.first_piece[row] = first;
    pieces->area[first] = made->area;
    for (uint32_t p = first; made->count > 1 && p != PL_NONE; p = pieces->next_in_shape[p]) {
        pieces->flags[p] |= PL_PIECE_PART;
        ++world->part_pieces;
    }
    pl_internal_edges_touch_shape(world, first);
    ++world->shape_count;
    pl_sleep_disturb_shape(world, first);
    pl_rearranged(world);
    world->schedule_dirty = true;
    return first;
}

static uint32_t last_of_shape(const plumb_world *world, uint32_t piece)
{
    while (world->pieces.next_in_shape[piece] != PL_NONE) {
        piece = world->pieces.next_in_shape[piece];
    }
    return piece;
}

// The pieces of a shape follow one another in the list of the body: they come out as one run.
static void unlink_from_body(plumb_world *world, uint32_t first)
{
    pl_pieces *pieces = &world->pieces;
    const uint32_t last = last_of_shape(world, first);
    uint32_t *link = &world->bodies.first_piece[pieces->body[first]];
    while (*link != first) {
        link = &pieces->next_in_body[*link];
    }
    *link = pieces->next_in_body[last];
}

static void free_slot(plumb_world *world, uint32_t slot)
{
    pl_pieces *pieces = &world->pieces;
    pl_internal_edges_forget(world, slot);
    unfile(world, slot);
    pl_sleep_void_contacts(world, slot);
    world->sleep.placed_pieces -= (pieces->flags[slot] & PL_PIECE_PLACED) != 0;
    pl_tombstone_set(world, slot);
    if (pieces->vertex_count[slot] > 0) {
        pl_pool_give(&world->vertices, pieces->vertex_class[slot], pieces->vertices[slot]);
    }
    --world->materials.users[pieces->material[slot]];
    --world->piece_kinds[pieces->kind[slot]];
    --pieces->live;
    world->sensor_pieces -= (pieces->flags[slot] & PL_PIECE_SENSOR) != 0;
    world->filtered_pieces -= (pieces->flags[slot] & PL_PIECE_FILTERED) != 0;
    world->part_pieces -= (pieces->flags[slot] & PL_PIECE_PART) != 0;
    world->one_way_pieces -= (pieces->flags[slot] & PL_PIECE_ONE_WAY) != 0;
    pieces->kind[slot] = PL_PIECE_FREE;
    pieces->vertex_count[slot] = 0;
    pieces->next_in_shape[slot] = pieces->free_head;
    pieces->free_head = slot;
}

void pl_pieces_move_behind(plumb_world *world, uint32_t first, uint32_t other)
{
    pl_pieces *pieces = &world->pieces;
    uint32_t *head = &world->bodies.first_piece[pieces->body[first]];
    const uint32_t last = last_of_shape(world, first), place = last_of_shape(world, other);
    unlink_from_body(world, first);
    uint32_t at = *head;
    while (at != PL_NONE &&
           at != place) { // images may be forged: it may be in no list, or in another
        at = pieces->next_in_body[at];
    }
    uint32_t *link = at == PL_NONE ? head : &pieces->next_in_body[place];
    pieces->next_in_body[last] = *link;
    *link = first;
}

void pl_pieces_remove(plumb_world *world, uint32_t first)
{
    const uint32_t *left = &world->bodies.first_piece[world->pieces.body[first]];
    unlink_from_body(world, first);
    uint32_t slot = first;
    while (slot != PL_NONE) {
        uint32_t next = world->pieces.next_in_shape[slot];
        free_slot(world, slot);
        slot = next;
    }
    if (*left != PL_NONE && !pl_piece_is_static(world, *left)) {
        pl_internal_edges_touch(world,
                                *left); // one stale piece stands for the whole of a moving body
    }
    --world->shape_count;
    pl_rearranged(world);
    world->schedule_dirty = true;
}

void pl_piece_convex(const plumb_world *world, uint32_t piece, plumb_convex *out)
{
    const pl_pieces *pieces = &world->pieces;
    memset(out, 0, sizeof *out);
    out->radius = pieces->core[piece].radius;
    if (pieces->vertex_count[piece] == 0) {
        out->count = 1;
        out->points[0] = plumb_v2(pieces->core[piece].x, pieces->core[piece].y);
        return;
    }
    out->count = pieces->vertex_count[piece];
    const pl_vertex *corner = world->vertices.items + pieces->vertices[piece];
    for (int i = 0; i < out->count; ++i) {
        out->points[i] = plumb_v2(corner[i].x, corner[i].y);
        out->normals[i] = plumb_v2(corner[i].nx, corner[i].ny);
    }
}
