// group.c - a body made of several sharp convex polygons, drawn as the one shape it is.
//
// The pieces' corners are welded; an edge is split where another piece's corner lies on it; two
// edges that run along each other in opposite directions are a seam. What remains is the body's
// outer outline. Fill and outline are then one mesh: corners on the outline are moved inwards for
// the fill by the same mitres that the outline's inner edge has, so nothing gaps or overlaps.
// Cost: O(corners^2) a body with several polygons; in pixels, per frame.
#include "internal.h"

#include <math.h>

// Corners nearer than this [px] are one corner; well above rounding, well below what is visible.
static const double weld = 0.05;
static const double half_ramp = 0.5;
static const double mitre_max = 3.0;
// The outline is at most this share of the thickest piece's inradius wide.
static const double outline_share = 0.8;

typedef struct corner {
    render_vec at;
    render_vec mitre;
    bool on_outline;
    uint32_t first_vertex; // of its four vertices in the batch
} corner;

typedef struct edge {
    uint32_t from;
    uint32_t to;
    bool seam;
} edge;

typedef struct piece {
    size_t first_edge;
    size_t edge_count;
    render_vec center;
} piece;

struct plr_group {
    render_allocator allocator;
    corner *corners;
    size_t corner_count, corner_capacity;
    edge *edges;
    size_t edge_count, edge_capacity;
    piece *pieces;
    size_t piece_count, piece_capacity;
    double inradius; // of the thickest piece [px]
};

plr_group *plr_group_create(const render_allocator *allocator)
{
    plr_group *group = allocator->resize(allocator->user, NULL, 0, sizeof *group);
    if (group != NULL) {
        *group = (plr_group){ .allocator = *allocator };
    }
    return group;
}

void plr_group_destroy(plr_group *group)
{
    if (group == NULL) {
        return;
    }
    const render_allocator memory = group->allocator;
    plr_release(&memory, group->corners, group->corner_capacity, sizeof *group->corners);
    plr_release(&memory, group->edges, group->edge_capacity, sizeof *group->edges);
    plr_release(&memory, group->pieces, group->piece_capacity, sizeof *group->pieces);
    plr_release(&memory, group, 1, sizeof *group);
}

bool plr_group_takes(const plr_shape *shape)
{
    return shape->kind == PLR_POLYGON && shape->radius == 0.0;
}

// ---- making

static bool add_corner(plr_group *group, render_vec at, uint32_t *index)
{
    for (size_t i = 0; i < group->corner_count; i++) {
        if (hypot(group->corners[i].at.x - at.x, group->corners[i].at.y - at.y) < weld) {
            *index = (uint32_t)i;
            return true;
        }
    }
    if (!plr_reserve(&group->allocator, (void **)&group->corners, &group->corner_capacity,
                     group->corner_count + 1, sizeof *group->corners)) {
        return false;
    }
    *index = (uint32_t)group->corner_count;
    group->corners[group->corner_count++] = (corner){ .at = at };
    return true;
}

static bool add_edge(plr_group *group, uint32_t from, uint32_t to)
{
    if (from == to) {
        return true;
    }
    if (!plr_reserve(&group->allocator, (void **)&group->edges, &group->edge_capacity,
                     group->edge_count + 1, sizeof *group->edges)) {
        return false;
    }
    group->edges[group->edge_count++] = (edge){ .from = from, .to = to };
    return true;
}

// Adds from-to, split at all corners that lie on it, nearest first.
static bool add_split_edge(plr_group *group, uint32_t from, uint32_t to)
{
    for (;;) {
        const render_vec a = group->corners[from].at, b = group->corners[to].at;
        const double length = hypot(b.x - a.x, b.y - a.y);
        const render_vec d = { (b.x - a.x) / length, (b.y - a.y) / length };
        uint32_t nearest = to;
        double nearest_at = length;
        for (uint32_t i = 0; from != to && i < group->corner_count; i++) {
            const render_vec p = group->corners[i].at;
            const double along = (p.x - a.x) * d.x + (p.y - a.y) * d.y;
            const double aside = (p.y - a.y) * d.x - (p.x - a.x) * d.y;
            if (i != from && along > weld && along < nearest_at - weld && fabs(aside) < weld) {
                nearest = i;
                nearest_at = along;
            }
        }
        if (!add_edge(group, from, nearest)) {
            return false;
        }
        if (nearest == to) {
            return true;
        }
        from = nearest;
    }
}

// The corners of one polygon as indices, in positive orientation. 0 when out of memory.
static size_t weld_polygon(plr_painter *painter, const plr_shape *shape, uint32_t *ring)
{
    const render_vec *world = painter->frame->points + shape->first_point;
    const size_t n = shape->point_count;
    double area = 0.0;
    for (size_t i = 0; i < n; i++) {
        const render_vec a = plr_pixel(painter, world[i]);
        const render_vec b = plr_pixel(painter, world[(i + 1) % n]);
        const render_vec o = plr_pixel(painter, world[0]);
        area += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
    }
    for (size_t i = 0; i < n; i++) {
        const render_vec p = plr_pixel(painter, world[area < 0.0 ? n - 1 - i : i]);
        if (!add_corner(painter->group, p, &ring[i])) {
            return 0;
        }
    }
    return n;
}

static bool add_piece(plr_painter *painter, const plr_shape *shape)
{
    plr_group *group = painter->group;
    uint32_t ring[RENDER_POLYGON_MAX];
    const size_t n = weld_polygon(painter, shape, ring);
    if (n == 0 || !plr_reserve(&group->allocator, (void **)&group->pieces, &group->piece_capacity,
                               group->piece_count + 1, sizeof *group->pieces)) {
        return false;
    }
    piece *added = &group->pieces[group->piece_count++];
    *added = (piece){ .first_edge = group->edge_count };
    for (size_t i = 0; i < n; i++) {
        if (!add_split_edge(group, ring[i], ring[(i + 1) % n])) {
            return false;
        }
        added->center.x += group->corners[ring[i]].at.x / (double)n;
        added->center.y += group->corners[ring[i]].at.y / (double)n;
    }
    added->edge_count = group->edge_count - added->first_edge;
    return true;
}

static render_vec edge_normal(const plr_group *group, const edge *e)
{
    const render_vec a = group->corners[e->from].at, b = group->corners[e->to].at;
    const double length = hypot(b.x - a.x, b.y - a.y);
    return (render_vec){ (b.y - a.y) / length, (a.x - b.x) / length };
}

static void find_seams(plr_group *group)
{
    for (size_t i = 0; i < group->edge_count; i++) {
        edge *e = &group->edges[i];
        for (size_t k = i + 1; k < group->edge_count && !e->seam; k++) {
            edge *f = &group->edges[k];
            if (!f->seam && f->from == e->to && f->to == e->from) {
                e->seam = true;
                f->seam = true;
            }
        }
    }
}

// The mitre of a corner joins its first outline edge in and its first outline edge out; where the
// outline touches itself in a point the others follow, which moves them by a pixel at most.
static void find_mitres(plr_group *group)
{
    for (size_t c = 0; c < group->corner_count; c++) {
        const edge *in = NULL, *out = NULL;
        for (size_t i = 0; i < group->edge_count; i++) {
            const edge *e = &group->edges[i];
            in = in == NULL && !e->seam && e->to == c ? e : in;
            out = out == NULL && !e->seam && e->from == c ? e : out;
        }
        corner *at = &group->corners[c];
        at->on_outline = in != NULL && out != NULL;
        if (at->on_outline) {
            const render_vec n0 = edge_normal(group, in), n1 = edge_normal(group, out);
            const double dot = n0.x * n1.x + n0.y * n1.y;
            const double k = 1.0 / fmax(1.0 + dot, 2.0 / (mitre_max * mitre_max));
            at->mitre = (render_vec){ (n0.x + n1.x) * k, (n0.y + n1.y) * k };
        }
    }
}

static double piece_inradius(const plr_group *group, const piece *p)
{
    double least = INFINITY;
    for (size_t i = 0; i < p->edge_count; i++) {
        const edge *e = &group->edges[p->first_edge + i];
        const render_vec n = edge_normal(group, e), a = group->corners[e->from].at;
        least = fmin(least, (a.x - p->center.x) * n.x + (a.y - p->center.y) * n.y);
    }
    return p->edge_count > 0 ? fmax(least, 0.0) : 0.0;
}

bool plr_group_make(plr_painter *painter, const plr_body *body)
{
    plr_group *group = painter->group;
    group->corner_count = 0;
    group->edge_count = 0;
    group->piece_count = 0;
    group->inradius = 0.0;
    const plr_shape *shapes = painter->frame->shapes + body->first_shape;
    // Twice: the second time all corners are known, so that edges are split at all of them.
    for (int round = 0; round < 2; round++) {
        group->edge_count = 0;
        group->piece_count = 0;
        for (size_t i = 0; i < body->shape_count; i++) {
            if (plr_group_takes(&shapes[i]) && !add_piece(painter, &shapes[i])) {
                painter->batch->failed = true;
                return false;
            }
        }
    }
    find_seams(group);
    find_mitres(group);
    for (size_t i = 0; i < group->piece_count; i++) {
        group->inradius = fmax(group->inradius, piece_inradius(group, &group->pieces[i]));
    }
    return group->piece_count > 0 && group->inradius > 0.0;
}

// ---- drawing

static void add_at(plr_batch *batch, const corner *c, double offset, render_rgba color)
{
    plr_batch_vertex(batch, c->at.x + c->mitre.x * offset, c->at.y + c->mitre.y * offset, color);
}

static void draw_mesh(plr_painter *painter, const plr_paint *paint, double width, bool inside)
{
    plr_group *group = painter->group;
    plr_batch *batch = painter->batch;
    const render_rgba edge_color =
        plr_mix(paint->fill, paint->outline, inside ? 0.0 : fmin(width, 1.0));
    const double ramp = inside ? half_ramp - width - PLR_INSIDE_SHIFT : half_ramp;
    const double depth = width > 0.0 || inside ? fmax(width, half_ramp) + half_ramp : half_ramp;
    const double end = inside ? depth + PLR_INSIDE_SHIFT : depth;
    for (size_t i = 0; i < group->corner_count; i++) {
        corner *c = &group->corners[i];
        c->first_vertex = (uint32_t)batch->vertex_count;
        add_at(batch, c, ramp, plr_fade(edge_color, 0.0));
        add_at(batch, c, inside ? -end : -half_ramp, edge_color);
        add_at(batch, c, fmin(half_ramp - width, -half_ramp), edge_color);
        add_at(batch, c, -end, paint->fill);
    }
    for (size_t i = 0; i < group->edge_count; i++) {
        const edge *e = &group->edges[i];
        if (e->seam) {
            continue;
        }
        const uint32_t a = group->corners[e->from].first_vertex;
        const uint32_t b = group->corners[e->to].first_vertex;
        for (uint32_t k = 0; k < (inside ? 1u : 3u); k++) {
            plr_batch_quad(batch, a + k, b + k, b + k + 1, a + k + 1);
        }
    }
    for (size_t i = 0; i < group->piece_count; i++) {
        const piece *p = &group->pieces[i];
        const uint32_t middle = plr_batch_vertex(batch, p->center.x, p->center.y, paint->fill);
        for (size_t k = 0; k < p->edge_count; k++) {
            const edge *e = &group->edges[p->first_edge + k];
            plr_batch_triangle(batch, middle, group->corners[e->from].first_vertex + 3,
                               group->corners[e->to].first_vertex + 3);
        }
    }
}

static void hatch_pieces(plr_painter *painter, const plr_body *body, double width,
                         render_rgba color)
{
    enum { planes_max = 2 * RENDER_POLYGON_MAX };
    plr_half_plane planes[planes_max];
    const plr_group *group = painter->group;
    for (size_t i = 0; i < group->piece_count; i++) {
        const piece *p = &group->pieces[i];
        render_vec min = { INFINITY, INFINITY }, max = { -INFINITY, -INFINITY };
        size_t count = 0;
        for (size_t k = 0; k < p->edge_count && count < planes_max; k++) {
            const edge *e = &group->edges[p->first_edge + k];
            const render_vec n = edge_normal(group, e), a = group->corners[e->from].at;
            const double inset = e->seam ? 0.0 : width + half_ramp;
            planes[count++] = (plr_half_plane){ n, n.x * a.x + n.y * a.y - inset };
            min = (render_vec){ fmin(min.x, a.x), fmin(min.y, a.y) };
            max = (render_vec){ fmax(max.x, a.x), fmax(max.y, a.y) };
        }
        plr_hatch(painter, planes, count, min, max, body, color);
    }
}

void plr_group_draw(plr_painter *painter, const plr_body *body, const plr_paint *paint,
                    plr_group_pass pass)
{
    const double width = fmin(plr_outline_width(painter), outline_share * painter->group->inradius);
    if (pass == PLR_GROUP_HATCH) {
        if (paint->hatch.a > 0) {
            hatch_pieces(painter, body, width, paint->hatch);
        }
        return;
    }
    draw_mesh(painter, paint, width, pass == PLR_GROUP_INSIDE);
}
