// stale_edges.c - changes of pieces after which internal edges have to be found anew: who is stale, and where.
//
// Reads: pieces, fat boxes. Writes: columns of internal edges, regions, pool of intervals. Cost: O(1) a piece.
#include "world/stale_edges.h"

#include "world/interval.h"
#include "world/rows.h"

bool pl_piece_is_static(const plumb_world *world, uint32_t piece)
{
    return world->bodies.type[world->pieces.body[piece]] == PLUMB_STATIC;
}

static void mark_dirty(plumb_world *world)
{
    if (!world->internal_edges.dirty) {
        world->internal_edges.dirty = true;
        world->schedule_dirty = true;
    }
}

void pl_internal_edges_touch(plumb_world *world, uint32_t piece)
{
    const pl_pieces *pieces = &world->pieces;
    uint32_t first = world->bodies.first_piece[pieces->body[piece]];
    bool alone = pieces->next_in_body[first] == PL_NONE && !pl_piece_is_static(world, piece);
    if (!alone || pl_piece_has_internal_edges(pieces, piece)) {
        world->pieces.internal_corners[piece] |= PL_EDGE_STALE;
        mark_dirty(world);
    }
}

void pl_internal_edges_touch_shape(plumb_world *world, uint32_t first)
{
    for (uint32_t p = first; p != PL_NONE; p = world->pieces.next_in_shape[p]) {
        pl_internal_edges_touch(world, p);
    }
}

void pl_internal_edges_touch_static(plumb_world *world, uint32_t row)
{
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE && pl_piece_is_static(world, p); p = world->pieces.next_in_body[p]) {
        pl_internal_edges_touch(world, p);
    }
}

// Without room for the region everything is looked at again. What has lost its box has left before.
void pl_internal_edges_leave(plumb_world *world, uint32_t piece)
{
    pl_internal_edges *s = &world->internal_edges;
    // As it is filed: its body may have another type by now.
    bool is_filed = world->pieces.moving[piece] == PL_NONE;
    if (!is_filed || pl_piece_has_lost_box(&world->pieces, piece) ||
        !pl_piece_has_internal_edges(&world->pieces, piece)) {
        return; // what has no internal edges has no neighbours that could lose theirs
    }
    mark_dirty(world);
    if (!pl_buffer_reserve(&world->memory, &s->regions,
                           ((size_t)s->region_count + 1) * sizeof(pl_box))) {
        s->all = true;
        return;
    }
    ((pl_box *)s->regions.data)[s->region_count++] = world->pieces.fat[piece];
}

void pl_internal_edges_move_static(plumb_world *world, uint32_t row)
{
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE && pl_piece_is_static(world, p); p = world->pieces.next_in_body[p]) {
        pl_internal_edges_leave(world, p);
        pl_internal_edges_touch(world, p);
    }
}

void pl_internal_edges_clear(plumb_world *world, uint32_t piece)
{
    pl_pieces *pieces = &world->pieces;
    pl_internal_edges *s = &world->internal_edges;
    if (!pl_piece_has_internal_edges(pieces, piece)) {
        return;
    }
    for (uint32_t k = 0; k < pieces->vertex_count[piece]; ++k) {
        if (pieces->internal_edges[piece] & PL_EDGE_PARTLY(k)) {
            const pl_edge *kept = &pl_edge_items(s)[pieces->vertices[piece] + k];
            pl_intervals_give(s, kept->intervals, kept->interval_count);
        }
    }
    pieces->internal_edges[piece] = 0;
    pieces->internal_corners[piece] &= ~(PL_EDGE_CORNERS | PL_EDGE_ANY | PL_EDGE_FLAT);
    --s->count;
}

void pl_internal_edges_forget(plumb_world *world, uint32_t piece)
{
    pl_internal_edges_leave(world, piece);
    if (pl_piece_has_internal_edges(&world->pieces, piece)) {
        mark_dirty(world); // what is noted of its pairs is out of date, even if it was the last one
    }
    pl_internal_edges_clear(world, piece);
    world->pieces.internal_corners[piece] = 0;
}
