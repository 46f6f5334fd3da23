// cover.c - one piece of ground among its neighbours: what is covered, what stands out.
//
// Reads: the piece, pieces around it, poses. Writes: its internal edge columns, corners and intervals. Order: part
// of an update. Cost: O(neighbours x corners x corners of theirs), about 19,000 instructions for a
// square tile among eight others.
#include "internal_edges/cover.h"

#include "broad/images.h"
#include "internal_edges/neighbour.h"
#include "world/interval.h"
#include "world/joint_list.h"
#include "world/stale_edges.h"
#include "world/state.h"

#include <math.h>
#include <string.h>

//---- who is a neighbour --------------------------------------------------------------------------

// A body that something passes through by a joint or an exclusion is not one ground with others.
static bool is_passed(const plumb_world *world, uint32_t row)
{
    return (world->bodies.flags[row] & PL_BODY_EXCLUDING) != 0 || pl_joints_part(world, row);
}

// Both let pass what the other does.
static bool hold_alike(const plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_pieces *s = &world->pieces;
    const pl_pose *a = &pl_poses(world)[s->body[p]], *b = &pl_poses(world)[s->body[q]];
    double px = (double)a->c * (double)s->one_way_x[p] - (double)a->s * (double)s->one_way_y[p];
    double py = (double)a->s * (double)s->one_way_x[p] + (double)a->c * (double)s->one_way_y[p];
    double qx = (double)b->c * (double)s->one_way_x[q] - (double)b->s * (double)s->one_way_y[q];
    double qy = (double)b->s * (double)s->one_way_x[q] + (double)b->c * (double)s->one_way_y[q];
    return s->one_way_cos[p] == s->one_way_cos[q] && fabs(px - qx) + fabs(py - qy) < PL_EDGE_ANGLE;
}

// Whether two pieces are one ground to all that meets them.
static bool are_joined(const plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_pieces *s = &world->pieces;
    uint32_t row_p = s->body[p], row_q = s->body[q];
    if (p == q || s->vertex_count[q] == 0 || ((s->flags[p] | s->flags[q]) & PL_PIECE_SENSOR) ||
        s->category[p] != s->category[q] || s->mask[p] != s->mask[q] ||
        s->group[p] != s->group[q]) {
        return false;
    }
    if (((s->flags[p] | s->flags[q]) & PL_PIECE_ONE_WAY) != 0 && !hold_alike(world, p, q)) {
        return false;
    }
    // Cores tell it only of surfaces that lie equally far outside them.
    double apart = fabs((double)s->core[p].radius - (double)s->core[q].radius);
    if (apart > 1e-3 * (double)s->core[p].radius) {
        return false;
    }
    return row_p == row_q || (pl_piece_is_static(world, p) && pl_piece_is_static(world, q) &&
                              !is_passed(world, row_p) && !is_passed(world, row_q));
}

typedef struct gathering {
    plumb_world *world;
    uint32_t piece;
} gathering;

static bool gather(void *context, const pl_grid_entry *entry)
{
    const gathering *g = context;
    pl_internal_edges *s = &g->world->internal_edges;
    if (!are_joined(g->world, g->piece, entry->piece)) {
        return true;
    }
    if (!pl_buffer_reserve(&g->world->memory, &s->around,
                           ((size_t)s->around_count + 1) * sizeof(uint32_t))) {
        return false;
    }
    ((uint32_t *)s->around.data)[s->around_count++] = entry->piece;
    return true;
}

static bool gather_around(plumb_world *world, uint32_t piece)
{
    gathering g = { world, piece };
    pl_box box = world->pieces.fat[piece];
    const bool asleep = (world->pieces.flags[piece] & PL_PIECE_ASLEEP) != 0;
    world->internal_edges.around_count = 0;
    return pl_world_query(world, &world->broad.fixed, box, gather, &g) &&
           (pl_piece_is_static(world, piece) ||
            pl_world_query(world, asleep ? &world->broad.resting : &world->broad.moving, box,
                           gather, &g));
}

//---- what they do --------------------------------------------------------------------------------

// A piece while it is looked at.
typedef struct look {
    pl_outline own;
    pl_cone cones[PLUMB_POLYGON_MAX_VERTICES];
    pl_wall walls[PLUMB_POLYGON_MAX_VERTICES][2];
    double slops[PLUMB_POLYGON_MAX_VERTICES]; // [m] largest with which a neighbour has a say
    bool narrowed[PLUMB_POLYGON_MAX_VERTICES];
    uint32_t covered[PLUMB_POLYGON_MAX_VERTICES]; // stretches of each edge
    pl_interval *intervals;                       // room for one a neighbour, edge by edge
    uint32_t room;
} look;

// Corners of a piece in the frame of the body of another, without the rounding of world positions.
static void outline_of(const plumb_world *world, uint32_t piece, uint32_t in_frame_of,
                       pl_outline *out)
{
    const pl_pieces *pieces = &world->pieces;
    const pl_pose *f = &pl_poses(world)[pieces->body[in_frame_of]];
    const pl_pose *p = &pl_poses(world)[pieces->body[piece]];
    double fc = (double)f->c, fs = (double)f->s, pc = (double)p->c, ps = (double)p->s;
    pl_shift way = pl_wrap_between(world, in_frame_of, piece);
    double dx = way.x, dy = way.y;
    bool same = pieces->body[piece] == pieces->body[in_frame_of];
    double c = same ? 1 : fc * pc + fs * ps, s = same ? 0 : fc * ps - fs * pc;
    double ox = fc * dx + fs * dy, oy = fc * dy - fs * dx;
    const pl_vertex *v = world->vertices.items + pieces->vertices[piece];
    out->count = pieces->vertex_count[piece];
    for (int k = 0; k < out->count; ++k) {
        double x = (double)v[k].x, y = (double)v[k].y;
        double nx = (double)v[k].nx, ny = (double)v[k].ny;
        out->x[k] = ox + c * x - s * y;
        out->y[k] = oy + s * x + c * y;
        out->nx[k] = c * nx - s * ny;
        out->ny[k] = s * nx + c * ny;
    }
}

// [m] how thick a core is, by the box around it; a line has its length.
static double thickness(const pl_core *core)
{
    double x = 2 * (double)core->hx, y = 2 * (double)core->hy;
    return y > 0 && y < x ? y : x;
}

// [m] what lies nearer touches: PL_EDGE_SLOP and what rounding may have done to the positions.
static double slop_of(const plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_pieces *pieces = &world->pieces;
    const uint32_t both[] = { p, q };
    bool apart = pieces->body[p] != pieces->body[q];
    double thin = PL_EDGE_SLOP * 100, reach = 0;
    for (int i = 0; i < 2; ++i) {
        const pl_core *core = &pieces->core[both[i]];
        const pl_pose *pose = &pl_poses(world)[pieces->body[both[i]]];
        double far = apart ? pl_greater(fabs((double)pose->x), fabs((double)pose->y)) : 0;
        thin = pl_lesser(thin, thickness(core));
        reach = pl_greater(reach, far + (double)core->reach);
    }
    double rounding = 4 * (double)PLUMB_REAL_EPSILON * reach;
    return pl_lesser(thin / 100 + rounding, (double)PL_SPECULATIVE / 2);
}

// The edge that ends at corner k (0), or starts there (1).
static int edge_at(const pl_outline *o, int k, int i)
{
    return i == 1 ? k : k > 0 ? k - 1 : o->count - 1;
}

static void look_at_neighbour(look *l, const pl_outline *other, double slop)
{
    for (int k = 0; k < l->own.count; ++k) {
        pl_cone has;
        if (pl_outline_cone_at(other, l->own.x[k], l->own.y[k], slop, &has)) {
            pl_cone met = pl_cone_meet(&l->cones[k], &has, PL_EDGE_ANGLE);
            l->narrowed[k] |= met.form != l->cones[k].form || met.lo_x != l->cones[k].lo_x ||
                              met.lo_y != l->cones[k].lo_y || met.hi_x != l->cones[k].hi_x ||
                              met.hi_y != l->cones[k].hi_y;
            l->cones[k] = met;
            l->slops[k] = pl_greater(l->slops[k], slop);
            for (int i = 0; i < 2; ++i) {
                int edge = edge_at(&l->own, k, i);
                pl_wall_meet(&l->walls[k][i], &has, l->own.nx[edge], l->own.ny[edge], i == 1);
            }
        }
        double from, to;
        if (pl_outline_covers(other, &l->own, k, slop, &from, &to)) {
            pl_interval *edge = l->intervals + (size_t)k * l->room;
            edge[l->covered[k]++] = (pl_interval){ (real)from, (real)to };
        }
    }
}

// Stores what one edge has; a stretch from end to end needs no interval.
static bool store_edge(plumb_world *world, uint32_t piece, look *l, int k)
{
    pl_internal_edges *s = &world->internal_edges;
    pl_interval *found = l->intervals + (size_t)k * l->room;
    uint32_t count = pl_intervals_merge(found, l->covered[k]);
    real length = (real)pl_outline_edge_length(&l->own, k);
    if (count == 0) {
        return true;
    }
    if (found[0].from <= 0 && found[0].to >= length) {
        world->pieces.internal_edges[piece] |= PL_EDGE_COVERED(k);
        return true;
    }
    uint32_t first = pl_intervals_take(&world->memory, s, count);
    if (first == PL_NONE) {
        return false;
    }
    pl_edge *kept = &pl_edge_items(s)[world->pieces.vertices[piece] + (uint32_t)k];
    kept->intervals = first;
    kept->interval_count = count;
    for (uint32_t i = 0; i < count; ++i) {
        pl_edge_intervals(s)[first + i] = found[i];
    }
    world->pieces.internal_edges[piece] |= PL_EDGE_PARTLY(k);
    return true;
}

static pl_edge_end end_of(const pl_cone *cone, double nx, double ny)
{
    if (!pl_cone_contains(cone, nx, ny, PL_SAME_DIRECTION)) {
        return PL_END_INNER;
    }
    return pl_cone_is_flat(cone) ? PL_END_FLAT : PL_END_OUTER;
}

static bool store(plumb_world *world, uint32_t piece, look *l)
{
    pl_pieces *pieces = &world->pieces;
    bool ok = true;
    for (int k = 0; k < l->own.count && ok; ++k) {
        pl_edge *kept =
            &pl_edge_items(&world->internal_edges)[pieces->vertices[piece] + (uint32_t)k];
        const pl_cone *cone = &l->cones[k];
        memset(kept, 0, sizeof *kept); // padding, too: it is saved
        kept->lo_x = (real)cone->lo_x;
        kept->lo_y = (real)cone->lo_y;
        kept->hi_x = (real)cone->hi_x;
        kept->hi_y = (real)cone->hi_y;
        kept->slop = (real)l->slops[k];
        kept->form = (uint8_t)cone->form;
        kept->flat = pl_cone_is_flat(cone);
        for (int i = 0; i < 2; ++i) {
            int edge = edge_at(&l->own, k, i);
            kept->ends[i] = (uint8_t)end_of(cone, l->own.nx[edge], l->own.ny[edge]);
            kept->walls[i][0] = (real)l->walls[k][i].nx;
            kept->walls[i][1] = (real)l->walls[k][i].ny;
        }
        if (l->narrowed[k]) {
            pieces->internal_corners[piece] |= UINT32_C(1) << k | (kept->flat ? PL_EDGE_FLAT : 0);
        }
        ok = store_edge(world, piece, l, k);
    }
    if ((pieces->internal_corners[piece] & PL_EDGE_CORNERS) != 0 ||
        pieces->internal_edges[piece] != 0) {
        pieces->internal_corners[piece] |= PL_EDGE_ANY;
        ++world->internal_edges.count;
    }
    if (!ok) {
        pl_internal_edges_clear(world, piece);
    }
    return ok;
}

bool pl_internal_edges_find(plumb_world *world, uint32_t piece)
{
    const pl_pieces *pieces = &world->pieces;
    pl_internal_edges *s = &world->internal_edges;
    pl_internal_edges_clear(world, piece);
    if (pieces->vertex_count[piece] == 0) {
        return true; // a circle has no edge and no corner
    }
    if (!gather_around(world, piece)) {
        return false;
    }
    if (s->around_count == 0) {
        return true;
    }
    look l = { .room = s->around_count };
    outline_of(world, piece, piece, &l.own);
    if (!pl_buffer_reserve(&world->memory, &s->scratch,
                           (size_t)l.own.count * l.room * sizeof(pl_interval))) {
        return false;
    }
    l.intervals = s->scratch.data;
    for (int k = 0; k < l.own.count; ++k) {
        l.cones[k] = pl_outline_cone(&l.own, k);
    }
    const uint32_t *around = s->around.data;
    for (uint32_t i = 0; i < s->around_count; ++i) {
        pl_outline other;
        outline_of(world, around[i], piece, &other);
        look_at_neighbour(&l, &other, slop_of(world, piece, around[i]));
    }
    return store(world, piece, &l);
}
