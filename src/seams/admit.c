// admit.c - is this normal one of the ground's? The questions that contacts and impacts ask.
//
// Reads: pieces, seams. Cost: O(corners), O(log stretches) where an edge is covered in part.
#include "seams/admit.h"
#include "seams/span.h"
#include "world/state.h"

pl_side pl_side_of(const plumb_world *world, uint32_t piece)
{
    const pl_pieces *pieces = &world->pieces;
    uint32_t first = pieces->vertices[piece];
    bool has = pl_piece_has_seams(pieces, piece);
    return (pl_side){ .corners = world->vertices.items + first,
                      .seams = has ? pl_seam_items(&world->seams) + first : NULL,
                      .spans = pl_seam_spans(&world->seams),
                      .corner_bits = pieces->seam_corners[piece] & PL_SEAM_CORNERS,
                      .edge_bits = pieces->seam_edges[piece],
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
    if (side->edge_bits & PL_SEAM_COVERED(k)) {
        return false;
    }
    if (!(side->edge_bits & PL_SEAM_PARTLY(k))) {
        return true;
    }
    return pl_spans_leave_open(side->spans + side->seams[k].spans, side->seams[k].span_count, low,
                               high);
}

static pl_cone cone_of(const pl_seam *seam)
{
    return (pl_cone){ (double)seam->lo_x, (double)seam->lo_y, (double)seam->hi_x,
                      (double)seam->hi_y, (pl_cone_form)seam->form };
}

bool pl_side_corner_admits(const pl_side *side, int k, double nx, double ny)
{
    if (!(side->corner_bits >> k & 1)) {
        return true;
    }
    pl_cone cone = cone_of(&side->seams[k]);
    return pl_cone_admits(&cone, nx, ny, PL_SAME_DIRECTION);
}

bool pl_side_corner_is_flat(const pl_side *side, int k)
{
    return (side->corner_bits >> k & 1) != 0 && side->seams[k].flat;
}

pl_edge_end pl_side_edge_end(const pl_side *side, int k, bool at_start)
{
    int corner = at_start ? k : pl_side_next(side, k);
    return (side->corner_bits >> corner & 1) == 0
               ? PL_END_OUTER
               : (pl_edge_end)side->seams[corner].ends[at_start ? 1 : 0];
}

bool pl_seams_admit(const plumb_world *world, uint32_t piece, double nx, double ny, double x,
                    double y)
{
    if (!pl_piece_has_seams(&world->pieces, piece)) {
        return true;
    }
    const pl_pose *pose = &pl_poses(world)[world->pieces.body[piece]];
    double c = (double)pose->c, s = (double)pose->s;
    double lx = c * nx + s * ny, ly = c * ny - s * nx;
    pl_side side = pl_side_of(world, piece);
    bool is_edge;
    int k = pl_side_feature(&side, lx, ly, &is_edge);
    if (!is_edge) {
        return !pl_side_corner_is_flat(&side, k) && pl_side_corner_admits(&side, k, lx, ly);
    }
    const pl_vertex *v = &side.corners[k];
    double px = c * x + s * y - (double)v->x, py = c * y - s * x - (double)v->y;
    double along = py * (double)v->nx - px * (double)v->ny;
    return pl_side_edge_is_open(&side, k, along, along);
}
