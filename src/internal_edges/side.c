// side.c - is this normal one of the ground's? The questions that contacts and impacts ask.
//
// Reads: pieces, internal edges. Cost: O(corners), O(log stretches) where an edge is covered in part.
#include "internal_edges/side.h"

#include "world/interval.h"
#include "world/state.h"

pl_side pl_side_of(const plumb_world *world, uint32_t piece)
{
    const pl_pieces *pieces = &world->pieces;
    uint32_t first = pieces->vertices[piece];
    bool has = pl_piece_has_internal_edges(pieces, piece);
    return (pl_side){ .corners = world->vertices.items + first,
                      .edges = has ? pl_edge_items(&world->internal_edges) + first : NULL,
                      .intervals = pl_edge_intervals(&world->internal_edges),
                      .corner_bits = pieces->internal_corners[piece] & PL_EDGE_CORNERS,
                      .edge_bits = pieces->internal_edges[piece],
                      .count = pieces->vertex_count[piece] };
}

int pl_side_feature(const pl_side *side, double nx, double ny, bool *is_edge)
{
    int corner = 0;
    for (int k = 0; k < side->count; ++k) {
        const pl_vertex *v = &side->corners[k];
        if (pl_directions_agree((double)v->nx, (double)v->ny, nx, ny, PL_SAME_DIRECTION)) {
            *is_edge = true;
            return k;
        }
        // Left of edge k and right of the next one, the corner between them is the farthest.
        const pl_vertex *w = &side->corners[pl_side_next(side, k)];
        if ((double)v->nx * ny - (double)v->ny * nx > 0 &&
            nx * (double)w->ny - ny * (double)w->nx >= 0) {
            corner = pl_side_next(side, k);
        }
    }
    *is_edge = false;
    return corner;
}

bool pl_side_edge_is_open(const pl_side *side, int k, double low, double high)
{
    if (side->edge_bits & PL_EDGE_COVERED(k)) {
        return false;
    }
    if (!(side->edge_bits & PL_EDGE_PARTLY(k))) {
        return true;
    }
    return pl_intervals_leave_open(side->intervals + side->edges[k].intervals,
                                   side->edges[k].interval_count, low, high);
}

static pl_cone cone_of(const pl_edge *kept)
{
    return (pl_cone){ (double)kept->lo_x, (double)kept->lo_y, (double)kept->hi_x,
                      (double)kept->hi_y, (pl_cone_form)kept->form };
}

bool pl_side_corner_allows(const pl_side *side, int k, double nx, double ny)
{
    if (!(side->corner_bits >> k & 1)) {
        return true;
    }
    pl_cone cone = cone_of(&side->edges[k]);
    return pl_cone_contains(&cone, nx, ny, PL_SAME_DIRECTION);
}

bool pl_side_corner_is_flat(const pl_side *side, int k)
{
    return (side->corner_bits >> k & 1) != 0 && side->edges[k].flat;
}

pl_edge_end pl_side_edge_end(const pl_side *side, int k, bool at_start)
{
    int corner = at_start ? k : pl_side_next(side, k);
    return (side->corner_bits >> corner & 1) == 0
               ? PL_END_OUTER
               : (pl_edge_end)side->edges[corner].ends[at_start ? 1 : 0];
}

bool pl_internal_edges_allow(const plumb_world *world, uint32_t piece, double nx, double ny,
                             double x, double y)
{
    if (!pl_piece_has_internal_edges(&world->pieces, piece)) {
        return true;
    }
    const pl_pose *pose = &pl_poses(world)[world->pieces.body[piece]];
    double c = (double)pose->c, s = (double)pose->s;
    double lx = c * nx + s * ny, ly = c * ny - s * nx;
    pl_side side = pl_side_of(world, piece);
    bool is_edge;
    int k = pl_side_feature(&side, lx, ly, &is_edge);
    if (!is_edge) {
        return !pl_side_corner_is_flat(&side, k) && pl_side_corner_allows(&side, k, lx, ly);
    }
    const pl_vertex *v = &side.corners[k];
    double px = c * x + s * y - (double)v->x, py = c * y - s * x - (double)v->y;
    double along = py * (double)v->nx - px * (double)v->ny;
    return pl_side_edge_is_open(&side, k, along, along);
}
