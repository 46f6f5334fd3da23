// view.c - geometry of one contact in the frame of its ground.
//
// A strip is the region in front of the open part of a face. It ends with the face where the outline
// turns away. It is longer by the slop where the neighbour goes on flat, so that nothing falls
// between two tiles. Points in front of the face, and any points where something stands at its
// end, count also if they get into the strip within the step: a slope that a fast body will meet is a
// contact now.
//
// Everything is computed in double from differences of positions, so that distance from the world's
// origin costs nothing. Cost: O(corners) a question, O(corners x corners) to rebuild.
#include "internal_edges/view.h"

#include "internal_edges/cone.h"
#include "narrow/ahead.h"
#include "narrow/surface.h"
#include "world/wrap.h"

#include <math.h>
#include <string.h>

void pl_view_open(pl_view *v, const plumb_world *world, const pl_pair *pair, const pl_manifold *m,
                  bool own_is_a, double dt)
{
    const pl_pieces *pieces = &world->pieces;
    v->world = world;
    v->m = m;
    v->own = own_is_a ? pair->a : pair->b;
    v->other = own_is_a ? pair->b : pair->a;
    v->own_is_a = own_is_a;
    v->own_pose = &pl_poses(world)[pieces->body[v->own]];
    v->other_pose = &pl_poses(world)[pieces->body[v->other]];
    v->ahead = (pair->flags & PL_PAIR_AHEAD) != 0;
    if (v->ahead) { // both are where they meet, and have nowhere to go
        const pl_pose *poses = pl_ahead_poses(world, m);
        v->own_pose = &poses[own_is_a ? 0 : 1];
        v->other_pose = &poses[own_is_a ? 1 : 0];
        dt = 0;
    }
    v->side = pl_side_of(world, v->own);
    double sign = own_is_a ? 1 : -1;
    double c = (double)v->own_pose->c, s = (double)v->own_pose->s;
    double nx = sign * (double)m->nx, ny = sign * (double)m->ny;
    v->nx = c * nx + s * ny;
    v->ny = c * ny - s * nx;
    v->feature = pl_side_feature(&v->side, v->nx, v->ny, &v->is_edge);
    double wx = ((double)v->other_pose->vx - (double)v->own_pose->vx) * dt;
    double wy = ((double)v->other_pose->vy - (double)v->own_pose->vy) * dt;
    v->vx = c * wx + s * wy;
    v->vy = c * wy - s * wx;
    v->turn_a = (double)world->bodies.w[m->body_a] * dt;
    v->turn_b = (double)world->bodies.w[m->body_b] * dt;
}

// [m] from the own origin to the other's.
static pl_shift way_to_other(const pl_view *v)
{
    if (!v->ahead) {
        return pl_wrap_between(v->world, v->own, v->other);
    }
    return (pl_shift){ (double)v->other_pose->x - (double)v->own_pose->x,
                       (double)v->other_pose->y - (double)v->own_pose->y };
}

// Corners of the other, only for contacts that need a closer look.
void pl_view_bring_other(pl_view *v)
{
    const pl_pieces *pieces = &v->world->pieces;
    const pl_pose *f = v->own_pose, *p = v->other_pose;
    double fc = (double)f->c, fs = (double)f->s, pc = (double)p->c, ps = (double)p->s;
    pl_shift way = way_to_other(v);
    double dx = way.x, dy = way.y;
    double c = fc * pc + fs * ps, s = fc * ps - fs * pc;
    double ox = fc * dx + fs * dy, oy = fc * dy - fs * dx;
    const pl_vertex *corner = v->world->vertices.items + pieces->vertices[v->other];
    const pl_core *core = &pieces->core[v->other];
    bool round = pieces->vertex_count[v->other] == 0;
    v->radii = (double)pieces->core[v->own].radius + (double)core->radius;
    v->count = round ? 1 : pieces->vertex_count[v->other];
    for (int k = 0; k < v->count; ++k) {
        double x = (double)(round ? core->x : corner[k].x);
        double y = (double)(round ? core->y : corner[k].y);
        v->x[k] = ox + c * x - s * y;
        v->y[k] = oy + s * x + c * y;
    }
}

//---- is it right ---------------------------------------------------------------------------------

static pl_face face_of(const pl_view *v, int k)
{
    const pl_vertex *p = &v->side.corners[k], *q = &v->side.corners[pl_side_next(&v->side, k)];
    double nx = (double)p->nx, ny = (double)p->ny;
    double ex = (double)q->x - (double)p->x, ey = (double)q->y - (double)p->y;
    return (pl_face){ (double)p->x, (double)p->y, nx, ny, ey * nx - ex * ny };
}

static double ahead(const pl_face *f, double x, double y)
{
    return (x - f->x) * f->nx + (y - f->y) * f->ny;
}

static double along(const pl_face *f, double x, double y)
{
    return (y - f->y) * f->nx - (x - f->x) * f->ny;
}

// [m] what lies deeper behind a face is not stopped by it: it has come through, or from the other side.
// A solid holds what lies inside it, and like a line, all that has its middle in front of its own: of a
// thin wall the sweeps let corners through by more than its thickness (continuous/target.h).
static double depth_of(const pl_view *v, const pl_face *f)
{
    double deepest = 0, low = INFINITY, high = -INFINITY;
    for (int k = 0; k < v->side.count; ++k) {
        const pl_vertex *p = &v->side.corners[k];
        deepest = pl_greater(deepest, -ahead(f, (double)p->x, (double)p->y));
    }
    for (int i = 0; i < v->count; ++i) {
        double u = ahead(f, v->x[i], v->y[i]);
        low = pl_lesser(low, u);
        high = pl_greater(high, u);
    }
    return v->radii + pl_greater(deepest, (deepest + high - low) / 2);
}

// True when the other piece is, or comes, before a part of edge k that is open.
static bool faces_open_part(pl_view *v, int k)
{
    bool is_line = v->side.count == 2;
    if (!is_line && !(v->side.edge_bits & PL_EDGE_PARTLY(k))) {
        return pl_side_edge_is_open(&v->side, k, 0, 0);
    }
    pl_view_bring_other(v);
    pl_face f = face_of(v, k);
    double low = INFINITY, high = -INFINITY, nearest = INFINITY;
    for (int i = 0; i < v->count; ++i) {
        double at = along(&f, v->x[i], v->y[i]);
        low = pl_lesser(low, at);
        high = pl_greater(high, at);
        nearest = pl_lesser(nearest, ahead(&f, v->x[i], v->y[i]));
    }
    // A corner hardly below the end of a line may be taken for one that has come from the other side.
    if (is_line && nearest - v->radii < -(depth_of(v, &f) + PL_EDGE_SLOP)) {
        return false;
    }
    double way = v->vy * f.nx - v->vx * f.ny;
    low = pl_greater(0, low + pl_lesser(0, way));
    high = pl_lesser(f.length, high + pl_greater(0, way));
    return pl_side_edge_is_open(&v->side, k, low, pl_greater(low, high));
}

// True when the deepest point lies at a corner of the own piece; (nx, ny) is the normal in its frame.
static bool is_at(const plumb_world *world, const pl_manifold_point *p, uint32_t own, bool own_is_a,
                  const pl_pose *pose, double nx, double ny, const pl_vertex *corner)
{
    double c = (double)pose->c, s = (double)pose->s;
    double x = (double)(own_is_a ? p->ax : p->bx) + (double)pose->dx;
    double y = (double)(own_is_a ? p->ay : p->by) + (double)pose->dy;
    double radius = (double)world->pieces.core[own].radius;
    double dx = c * x + s * y - radius * nx - (double)corner->x;
    double dy = c * y - s * x - radius * ny - (double)corner->y;
    return dx * dx + dy * dy <= PL_EDGE_SLOP * PL_EDGE_SLOP;
}

static const pl_manifold_point *deepest_of(const pl_manifold *m)
{
    return &m->point[m->point[1].separation < m->point[0].separation];
}

bool pl_view_end_bears(const plumb_world *world, const pl_manifold *m, uint32_t own, bool own_is_a,
                       int k)
{
    const pl_pose *pose = &pl_poses(world)[world->pieces.body[own]];
    const pl_vertex *corners = world->vertices.items + world->pieces.vertices[own];
    const int next = k + 1 < world->pieces.vertex_count[own] ? k + 1 : 0;
    const double sign = own_is_a ? 1 : -1, c = (double)pose->c, s = (double)pose->s;
    const double wx = sign * (double)m->nx, wy = sign * (double)m->ny;
    const double nx = c * wx + s * wy, ny = c * wy - s * wx;
    const double ex = (double)corners[next].x - (double)corners[k].x;
    const double ey = (double)corners[next].y - (double)corners[k].y;
    return is_at(world, deepest_of(m), own, own_is_a, pose, nx, ny,
                 &corners[ex * nx + ey * ny > 0 ? next : k]);
}

bool pl_view_is_at_corner(const pl_view *v, const pl_manifold_point *p, int k)
{
    return is_at(v->world, p, v->own, v->own_is_a, v->own_pose, v->nx, v->ny, &v->side.corners[k]);
}

// True when the deepest point is at corner k. Otherwise it lies on an edge, with the normal of the other
// piece's face, which leans as that piece does.
static bool lies_at(const pl_view *v, int k)
{
    return pl_view_is_at_corner(v, deepest_of(v->m), k);
}

// [rad] between two grounds, what bears at a flat corner bears on the face beside it that leans no more than this against the normal:
// where both sides left it to their neighbours, as their flat corners lie on one another, nobody had it.
#define FLAT_CORNER_ANGLE 5e-3

// The edge beside the flat corner k that has the normal; -1 if none.
static int edge_at_flat_corner(const pl_view *v, int k)
{
    if (!pl_piece_has_internal_edges(&v->world->pieces, v->other)) {
        return -1; // its neighbour has it
    }
    const int beside[2] = { k, k > 0 ? k - 1 : v->side.count - 1 };
    for (int i = 0; i < 2; ++i) {
        const pl_vertex *corner = &v->side.corners[beside[i]];
        if (pl_directions_agree((double)corner->nx, (double)corner->ny, v->nx, v->ny,
                                FLAT_CORNER_ANGLE)) {
            return beside[i];
        }
    }
    return -1;
}

bool pl_view_is_allowed(pl_view *v)
{
    if ((v->side.corner_bits | v->side.edge_bits) == 0) {
        return true;
    }
    const int k = v->feature;
    const bool is_flat = !v->is_edge && pl_side_corner_is_flat(&v->side, k);
    const int edge = v->is_edge ? k : is_flat ? edge_at_flat_corner(v, k) : -1;
    if (edge >= 0) {
        return faces_open_part(v, edge);
    }
    return !is_flat && pl_side_corner_allows(&v->side, k, v->nx, v->ny) && lies_at(v, k);
}

//---- setting it right ----------------------------------------------------------------------------

// Open part of the edge as one stretch, from its first open point to its last.
static void open_stretch(const pl_view *v, int k, double length, double *low, double *high)
{
    *low = 0;
    *high = length;
    if (v->side.edge_bits & PL_EDGE_PARTLY(k)) {
        const pl_edge *kept = &v->side.edges[k];
        const pl_interval *intervals = v->side.intervals + kept->intervals;
        const pl_interval *last = &intervals[kept->interval_count - 1];
        *low = intervals[0].from <= 0 ? (double)intervals[0].to : 0;
        *high = (double)last->to >= length ? (double)last->from : length;
    }
}

pl_strip pl_view_strip(const pl_view *v, int k)
{
    pl_strip s = { .f = face_of(v, k), .edge = k, .separation = INFINITY };
    for (int i = 0; i < v->count; ++i) {
        s.separation = pl_lesser(s.separation, ahead(&s.f, v->x[i], v->y[i]) - v->radii);
    }
    open_stretch(v, k, s.f.length, &s.low, &s.high);
    double way = v->vy * s.f.nx - v->vx * s.f.ny;
    for (int end = 0; end < 2; ++end) {
        bool at_start = end == 0;
        if (at_start ? s.low > 0 : s.high < s.f.length) {
            continue; // it ends where something lies on it
        }
        pl_edge_end kind = pl_side_edge_end(&v->side, k, at_start);
        int corner = at_start ? k : pl_side_next(&v->side, k);
        double slop = kind == PL_END_FLAT ? (double)v->side.edges[corner].slop : 0;
        double reach = kind == PL_END_FLAT ? 0 : pl_greater(0, at_start ? way : -way);
        *(at_start ? &s.before : &s.after) = reach;
        if (kind == PL_END_INNER) {
            s.walls[end] = v->side.edges[corner].walls[at_start ? 1 : 0];
        }
        s.low -= at_start ? slop : 0;
        s.high += at_start ? 0 : slop;
    }
    return s;
}

// [m] points that deep in a wall are still in front of it.
#define IN_WALL ((double)PL_SPECULATIVE)

// Whether a point before the start of the strip, or behind its end, counts: in front of the face where
// nothing stands at the end, else in front of what stands there.
static bool counts_outside(const pl_strip *s, pl_face_point p, double radii, int end)
{
    const real *wall = s->walls[end];
    double reach = end == 0 ? s->before : s->after;
    double beyond = end == 0 ? s->low - p.v : p.v - s->high;
    if (beyond > reach) {
        return false;
    }
    if (wall == NULL) {
        return p.u > radii;
    }
    // The wall's normal in the frame of the face, and the point from its foot.
    double mu = (double)wall[0] * s->f.nx + (double)wall[1] * s->f.ny;
    double mv = (double)wall[1] * s->f.nx - (double)wall[0] * s->f.ny;
    double foot = end == 0 ? s->low : s->high;
    return (mu != 0 || mv != 0) && p.u * mu + (p.v - foot) * mv > radii - IN_WALL;
}

static bool counts(const pl_strip *s, pl_face_point p, double radii)
{
    return p.v < s->low    ? counts_outside(s, p, radii, 0)
           : p.v > s->high ? counts_outside(s, p, radii, 1)
                           : true;
}

static pl_face_point place_of(const pl_view *v, const pl_strip *s, int i)
{
    return (pl_face_point){ ahead(&s->f, v->x[i], v->y[i]), along(&s->f, v->x[i], v->y[i]) };
}

// The part of the edge from p to q (which runs towards greater v) over the open part itself.
static bool clip(const pl_strip *s, pl_face_point *p, pl_face_point *q)
{
    double slope = (q->u - p->u) / (q->v - p->v);
    double low = pl_greater(p->v, s->low), high = pl_lesser(q->v, s->high);
    if (!(low <= high)) {
        return false;
    }
    pl_face_point from = { p->u + slope * (low - p->v), low };
    pl_face_point to = { q->u + slope * (high - q->v), high };
    *p = from, *q = to;
    return true;
}

#define FLATTEST (-1e-3) // [-] edges that face away, or stand on end, give no points
#define LEVEL    1e-9    // [m] less is no difference in depth

int pl_view_points(const pl_view *v, const pl_strip *s, pl_face_point out[2], int *feature)
{
    double most = FLATTEST;
    int count = 0;
    for (int i = 0; i < v->count && v->count > 1; ++i) {
        // Counter-clockwise, edges that face the ground run against v.
        pl_face_point q = place_of(v, s, i), p = place_of(v, s, i + 1 < v->count ? i + 1 : 0);
        double run = q.v - p.v, rise = q.u - p.u;
        double facing = -run / sqrt(run * run + rise * rise); // the edge's normal along the face's
        if (run > 0 && facing < most && clip(s, &p, &q)) {
            most = facing;
            out[0] = p, out[1] = q;
            count = q.v - p.v > 1e-6 * run ? 2 : 1;
            *feature = i;
        }
    }
    // A corner that will get into the strip may be deeper than what is in it now.
    double deepest = count == 0 ? INFINITY : count == 1 ? out[0].u : pl_lesser(out[0].u, out[1].u);
    for (int i = 0; i < v->count; ++i) {
        pl_face_point p = place_of(v, s, i);
        if (p.u < deepest - LEVEL && counts(s, p, v->radii)) {
            bool beyond = count == 2 && p.v >= out[1].v, before = count == 2 && p.v <= out[0].v;
            deepest = p.u;
            out[beyond ? 1 : 0] = p;
            if (!beyond && !before) {
                count = 1;
                *feature = i;
            }
        }
    }
    return count;
}

// [m] points farther than this play no part in the step; as in narrow/lanes.h.
static double limit_of(const pl_view *v, const pl_face *f)
{
    double closing = -(v->vx * f->nx + v->vy * f->ny);
    bool elastic = v->m->restitution > (pl_restitution_is_mixed(v->world) ? -1 : 0);
    closing = elastic ? sqrt(v->vx * v->vx + v->vy * v->vy) : closing;
    return (double)PL_SPECULATIVE + pl_greater(0, closing);
}

// Writes point k of the manifold: (u, v) of the other's core in the face's frame.
static void write_point(const pl_view *v, const pl_face *f, pl_face_point p, pl_manifold_point *out)
{
    const pl_pose *own = v->own_pose, *other = v->other_pose;
    double c = (double)own->c, s = (double)own->s;
    double own_radius = (double)v->world->pieces.core[v->own].radius;
    double other_radius = v->radii - own_radius;
    pl_shift way = way_to_other(v);
    double dx = way.x, dy = way.y;
    double anchor[2][2]; // on the own surface, on the other's; world axes, from the own origin
    for (int side = 0; side < 2; ++side) {
        double u = side == 0 ? own_radius : p.u - other_radius;
        double x = f->x + f->nx * u - f->ny * p.v, y = f->y + f->ny * u + f->nx * p.v;
        anchor[side][0] = c * x - s * y;
        anchor[side][1] = s * x + c * y;
    }
    double ox = anchor[0][0] - (double)own->dx, oy = anchor[0][1] - (double)own->dy;
    double tx = anchor[1][0] - dx - (double)other->dx, ty = anchor[1][1] - dy - (double)other->dy;
    *out = (pl_manifold_point){ .ax = (near_real)(v->own_is_a ? ox : tx),
                                .ay = (near_real)(v->own_is_a ? oy : ty),
                                .bx = (near_real)(v->own_is_a ? tx : ox),
                                .by = (near_real)(v->own_is_a ? ty : oy),
                                .separation = (near_real)(p.u - v->radii) };
}

// [m] by which the turning of both bodies closes a point within the step, and a little more.
static double turned(const pl_view *v, const pl_manifold *m, const pl_manifold_point *p)
{
    const double nx = (double)m->nx, ny = (double)m->ny;
    const double a = (double)p->ax * ny - (double)p->ay * nx;
    const double b = (double)p->bx * ny - (double)p->by * nx;
    return a * v->turn_a - b * v->turn_b + (double)PL_BESIDE_SPIN;
}

uint32_t pl_view_write(const pl_view *v, const pl_face *f, const pl_face_point *points, int count,
                       uint32_t feature, pl_manifold *m)
{
    const double limit = limit_of(v, f), linear = -(v->vx * f->nx + v->vy * f->ny);
    uint32_t kept = 0;
    double sign = v->own_is_a ? 1 : -1;
    double c = (double)v->own_pose->c, s = (double)v->own_pose->s;
    m->nx = (near_real)(sign * (c * f->nx - s * f->ny));
    m->ny = (near_real)(sign * (s * f->nx + c * f->ny));
    for (int i = 0; i < count; ++i) {
        pl_manifold_point p;
        write_point(v, f, points[i], &p);
        if (points[i].u - v->radii < pl_greater(limit, linear + turned(v, m, &p))) {
            m->feature[kept] = feature + (uint32_t)i;
            m->point[kept++] = p;
        }
    }
    for (uint32_t i = kept; i < 2; ++i) {
        m->point[i] = (pl_manifold_point){ .separation = PL_APART };
        m->feature[i] = PL_NONE;
    }
    m->count = (uint16_t)kept;
    m->met = (uint16_t)((m->met & ~PL_MET_TURNS) | (v->own_is_a ? PL_MET_TURNS_A : PL_MET_TURNS_B));
    return kept;
}

// Puts the manifold on the best open face of the own piece. False when none has the other before it.
bool pl_view_rebuild(pl_view *v, pl_manifold *m)
{
    pl_view_bring_other(v);
    pl_strip best = { .separation = -INFINITY };
    pl_face_point points[2];
    int count = 0, feature = 0;
    // What is apart from the piece is behind none of its faces: it flies by.
    const bool apart =
        (double)plumb_min(m->point[0].separation, m->point[1].separation) > PL_EDGE_SLOP;
    for (int k = 0; k < v->side.count; ++k) {
        if (v->side.edge_bits & PL_EDGE_COVERED(k)) {
            continue;
        }
        pl_strip s = pl_view_strip(v, k);
        pl_face_point found[2];
        int from = 0;
        double depth = apart ? PL_EDGE_SLOP : depth_of(v, &s.f);
        bool better = s.separation > best.separation && s.separation >= -depth;
        int n = better ? pl_view_points(v, &s, found, &from) : 0;
        if (n > 0) {
            best = s;
            count = n;
            feature = from;
            memcpy(points, found, sizeof points);
        }
    }
    return pl_view_write(v, &best.f, points, count,
                         PL_EDGE_FEATURE | (uint32_t)best.edge << 8 | (uint32_t)feature << 1,
                         m) > 0;
}
