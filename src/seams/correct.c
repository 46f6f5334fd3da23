// correct.c - contacts whose normal the ground does not admit, set right or taken out.
//
// A kernel sees two convex pieces and takes the axis that separates them most. That may be a side
// that a neighbour covers, or lean on a corner where the ground goes on. Then the best face of the
// ground that is open there takes its place: the other piece is clipped to the strip in front of the
// open part of that face, and gives the points of its nearest edge. Where nothing of it lies in
// the strip, nor will within the step, the neighbour has the contact, and this one is taken out.
//
// The strip ends with the face where the outline turns away. It is longer by the slop where the
// neighbour goes on flat, so that nothing falls between two tiles. Points that are in front of the
// face, and any points where something stands at its end, count also if they get into the strip
// within the step: a slope that a fast body will meet is a contact now.
//
// Reads: pairs, poses, pieces, seams. Writes: manifolds, pairs, summary. Order: after the narrow
// phase, before anything else looks at manifolds. Cost: about 100 instructions a contact that is
// right, 600 for one that is not.
#include "narrow/surface.h"
#include "seams/admit.h"
#include "world/state.h"

#include <math.h>
#include <string.h>

// A contact as seen from its ground: `own` is the piece whose seams count, everything lies in the
// frame of its body.
typedef struct view {
    const plumb_world *world;
    const pl_manifold *m;
    uint32_t own, other;
    const pl_pose *own_pose, *other_pose;
    bool own_is_a;
    pl_side side;
    double nx, ny; // outward normal of the ground
    double vx, vy; // [m] way of the other in this step
    double radii;  // [m]
    int count;     // corners of the other
    double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES];
} view;

static void look_from(view *v, const plumb_world *world, const pl_pair *pair, const pl_manifold *m,
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
    v->side = pl_side_of(world, v->own);
    double sign = own_is_a ? 1 : -1;
    double c = (double)v->own_pose->c, s = (double)v->own_pose->s;
    double nx = sign * (double)m->nx, ny = sign * (double)m->ny;
    v->nx = c * nx + s * ny;
    v->ny = c * ny - s * nx;
    double wx = ((double)v->other_pose->vx - (double)v->own_pose->vx) * dt;
    double wy = ((double)v->other_pose->vy - (double)v->own_pose->vy) * dt;
    v->vx = c * wx + s * wy;
    v->vy = c * wy - s * wx;
}

// Corners of the other, only for contacts that need a closer look.
static void bring_other(view *v)
{
    const pl_pieces *pieces = &v->world->pieces;
    const pl_pose *f = v->own_pose, *p = v->other_pose;
    double fc = (double)f->c, fs = (double)f->s, pc = (double)p->c, ps = (double)p->s;
    double dx = (double)p->x - (double)f->x, dy = (double)p->y - (double)f->y;
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

// An edge of the own piece as a frame: u in front of it, v along it from its start.
typedef struct face {
    double x, y, nx, ny, length;
} face;

static face face_of(const view *v, int k)
{
    const pl_vertex *p = &v->side.corners[k], *q = &v->side.corners[pl_side_next(&v->side, k)];
    double nx = (double)p->nx, ny = (double)p->ny;
    double ex = (double)q->x - (double)p->x, ey = (double)q->y - (double)p->y;
    return (face){ (double)p->x, (double)p->y, nx, ny, ey * nx - ex * ny };
}

static double ahead(const face *f, double x, double y)
{
    return (x - f->x) * f->nx + (y - f->y) * f->ny;
}

static double along(const face *f, double x, double y)
{
    return (y - f->y) * f->nx - (x - f->x) * f->ny;
}

// True when the other piece is, or comes, before a part of edge k that is open.
static bool faces_open_part(view *v, int k)
{
    if (!(v->side.edge_bits & PL_SEAM_PARTLY(k))) {
        return pl_side_edge_is_open(&v->side, k, 0, 0);
    }
    bring_other(v);
    face f = face_of(v, k);
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < v->count; ++i) {
        double at = along(&f, v->x[i], v->y[i]);
        low = fmin(low, at);
        high = fmax(high, at);
    }
    double way = v->vy * f.nx - v->vx * f.ny;
    low = fmax(0, low + fmin(0, way));
    high = fmin(f.length, high + fmax(0, way));
    return pl_side_edge_is_open(&v->side, k, low, fmax(low, high));
}

static bool is_admitted(view *v)
{
    if ((v->side.corner_bits | v->side.edge_bits) == 0) {
        return true;
    }
    bool is_edge;
    int k = pl_side_feature(&v->side, v->nx, v->ny, &is_edge);
    return is_edge ? faces_open_part(v, k) : pl_side_corner_admits(&v->side, k, v->nx, v->ny);
}

//---- setting it right ----------------------------------------------------------------------------

// Where on a face the other piece may touch.
typedef struct strip {
    face f;
    int edge;
    double separation;   // [m] of the whole other piece from the face's line
    double low, high;    // [m] open part of the face
    double before, after; // [m] how much longer it is for points that move
    bool any_before, any_after; // those count also behind the line
} strip;

// Open part of the edge as one stretch, from its first open point to its last.
static void open_stretch(const view *v, int k, double length, double *low, double *high)
{
    *low = 0;
    *high = length;
    if (v->side.edge_bits & PL_SEAM_PARTLY(k)) {
        const pl_seam *seam = &v->side.seams[k];
        const pl_span *spans = v->side.spans + seam->spans;
        const pl_span *last = &spans[seam->span_count - 1];
        *low = spans[0].from <= 0 ? (double)spans[0].to : 0;
        *high = (double)last->to >= length ? (double)last->from : length;
    }
}

static strip strip_of(const view *v, int k)
{
    strip s = { .f = face_of(v, k), .edge = k, .separation = INFINITY };
    for (int i = 0; i < v->count; ++i) {
        s.separation = fmin(s.separation, ahead(&s.f, v->x[i], v->y[i]) - v->radii);
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
        double slop = kind == PL_END_FLAT ? (double)v->side.seams[corner].slop : 0;
        double reach = kind == PL_END_FLAT ? 0 : fmax(0, at_start ? way : -way);
        *(at_start ? &s.before : &s.after) = reach;
        *(at_start ? &s.any_before : &s.any_after) = kind == PL_END_INNER;
        s.low -= at_start ? slop : 0;
        s.high += at_start ? 0 : slop;
    }
    return s;
}

// A point of the other piece in the frame of the face.
typedef struct place {
    double u, v;
} place;

static bool counts(const strip *s, place p, double radii)
{
    bool front = p.u > radii;
    double low = s->low - (s->any_before || front ? s->before : 0);
    double high = s->high + (s->any_after || front ? s->after : 0);
    return p.v >= low && p.v <= high;
}

static place place_of(const view *v, const strip *s, int i)
{
    return (place){ ahead(&s->f, v->x[i], v->y[i]), along(&s->f, v->x[i], v->y[i]) };
}

// The part of the edge from p to q (which runs towards greater v) over the open part itself.
static bool clip(const strip *s, place *p, place *q)
{
    double slope = (q->u - p->u) / (q->v - p->v);
    double low = fmax(p->v, s->low), high = fmin(q->v, s->high);
    if (!(low <= high)) {
        return false;
    }
    place from = { p->u + slope * (low - p->v), low };
    place to = { q->u + slope * (high - q->v), high };
    *p = from, *q = to;
    return true;
}

#define FLATTEST (-1e-3) // [-] edges that face away, or stand on end, give no points

// The points of the other piece over the strip: those of the edge that most faces the ground, or the
// deepest corner that gets there. Returns how many.
static int find_points(const view *v, const strip *s, place out[2], int *feature)
{
    double most = FLATTEST;
    int count = 0;
    for (int i = 0; i < v->count && v->count > 1; ++i) {
        place p = place_of(v, s, i), q = place_of(v, s, i + 1 < v->count ? i + 1 : 0);
        double run = q.v - p.v, rise = q.u - p.u;
        double facing = -run / sqrt(run * run + rise * rise); // the edge's normal along the face's
        if (run > 0 && facing < most && clip(s, &p, &q)) {
            most = facing;
            out[0] = p, out[1] = q;
            count = q.v - p.v > 1e-6 * run ? 2 : 1;
            *feature = i;
        }
    }
    for (int i = 0; i < v->count && count == 0; ++i) {
        place p = place_of(v, s, i);
        if (counts(s, p, v->radii)) {
            out[0] = p;
            count = 1;
            *feature = i;
        }
    }
    for (int i = 0; i < v->count && count == 1; ++i) {
        place p = place_of(v, s, i);
        if (p.u < out[0].u && counts(s, p, v->radii)) {
            out[0] = p;
            *feature = i;
        }
    }
    return count;
}

// [m] points farther than this play no part in the step; as in narrow/lanes.h.
static double limit_of(const view *v, const face *f, double dt)
{
    (void)dt;
    double closing = -(v->vx * f->nx + v->vy * f->ny);
    bool elastic = v->m->restitution > (pl_restitution_is_mixed(v->world) ? -1 : 0);
    closing = elastic ? sqrt(v->vx * v->vx + v->vy * v->vy) : closing;
    return (double)PL_SPECULATIVE + fmax(0, closing);
}

// Writes point k of the manifold: (u, v) of the other's core in the face's frame.
static void write_point(const view *v, const face *f, place p, pl_manifold_point *out)
{
    const pl_pose *own = v->own_pose, *other = v->other_pose;
    double c = (double)own->c, s = (double)own->s;
    double own_radius = (double)v->world->pieces.core[v->own].radius;
    double other_radius = v->radii - own_radius;
    double dx = (double)other->x - (double)own->x, dy = (double)other->y - (double)own->y;
    double anchor[2][2]; // on the own surface, on the other's; world axes, from the own origin
    for (int side = 0; side < 2; ++side) {
        double u = side == 0 ? own_radius : p.u - other_radius;
        double x = f->x + f->nx * u - f->ny * p.v, y = f->y + f->ny * u + f->nx * p.v;
        anchor[side][0] = c * x - s * y;
        anchor[side][1] = s * x + c * y;
    }
    double ox = anchor[0][0] - (double)own->dx, oy = anchor[0][1] - (double)own->dy;
    double tx = anchor[1][0] - dx - (double)other->dx, ty = anchor[1][1] - dy - (double)other->dy;
    *out = (pl_manifold_point){ .ax = (real)(v->own_is_a ? ox : tx),
                                .ay = (real)(v->own_is_a ? oy : ty),
                                .bx = (real)(v->own_is_a ? tx : ox),
                                .by = (real)(v->own_is_a ? ty : oy),
                                .separation = (real)(p.u - v->radii) };
}

// Puts the manifold on the best open face of the own piece. False when none has the other before it.
static bool rebuild(view *v, pl_manifold *m, double dt)
{
    bring_other(v);
    strip best = { .separation = -INFINITY };
    place points[2];
    int count = 0, feature = 0;
    for (int k = 0; k < v->side.count; ++k) {
        if (v->side.edge_bits & PL_SEAM_COVERED(k)) {
            continue;
        }
        strip s = strip_of(v, k);
        place found[2];
        int from = 0;
        int n = s.separation > best.separation ? find_points(v, &s, found, &from) : 0;
        if (n > 0) {
            best = s;
            count = n;
            feature = from;
            memcpy(points, found, sizeof points);
        }
    }
    double limit = limit_of(v, &best.f, dt);
    uint32_t kept = 0;
    for (int i = 0; i < count; ++i) {
        if (points[i].u - v->radii < limit) {
            write_point(v, &best.f, points[i], &m->point[kept]);
            m->feature[kept++] =
                UINT32_C(0x40000000) | (uint32_t)best.edge << 8 | (uint32_t)feature << 1 | (uint32_t)i;
        }
    }
    for (uint32_t i = kept; i < 2; ++i) {
        m->point[i] = (pl_manifold_point){ .separation = PL_APART };
        m->feature[i] = PL_NONE;
    }
    double sign = v->own_is_a ? 1 : -1;
    double c = (double)v->own_pose->c, s = (double)v->own_pose->s;
    m->nx = (real)(sign * (c * best.f.nx - s * best.f.ny));
    m->ny = (real)(sign * (s * best.f.nx + c * best.f.ny));
    m->count = kept;
    return kept > 0;
}

typedef enum verdict { RIGHT, SET_RIGHT, FALSE_CONTACT } verdict;

// Either piece may be ground; the ground of one must admit what the other's makes of the contact.
static verdict judge(const plumb_world *world, const pl_pair *pair, pl_manifold *m, double dt)
{
    view views[2];
    bool admitted[2];
    for (int i = 0; i < 2; ++i) {
        look_from(&views[i], world, pair, m, i == 0, dt);
        admitted[i] = is_admitted(&views[i]);
    }
    if (admitted[0] && admitted[1]) {
        return RIGHT;
    }
    for (int i = 0; i < 2; ++i) {
        if (admitted[i] || !rebuild(&views[i], m, dt)) {
            continue;
        }
        view across;
        look_from(&across, world, pair, m, i == 1, dt);
        if (is_admitted(&across)) {
            return SET_RIGHT;
        }
    }
    return FALSE_CONTACT;
}

// Impulses follow their features, as in narrow/lanes.h.
static void carry_over(const pl_seam_pair *old, pl_pair *pair, pl_manifold *m)
{
    for (uint32_t k = 0; k < 2; ++k) {
        pair->feature[k] = m->feature[k];
        for (int j = 0; j < 2 && k < m->count; ++j) {
            if (old->feature[j] == m->feature[k]) {
                m->point[k].normal = old->normal[j];
                m->point[k].tangent = old->tangent[j];
            }
        }
        pair->normal[k] = m->point[k].normal;
        pair->tangent[k] = m->point[k].tangent;
    }
}

static void take_out(pl_pair *pair)
{
    pair->manifold = PL_NONE;
    pair->rolling = 0;
    for (int k = 0; k < 2; ++k) {
        pair->feature[k] = PL_NONE;
        pair->normal[k] = pair->tangent[k] = 0;
    }
}

// Closes the gaps that were left; their manifolds have no points.
static void close_gaps(plumb_world *world)
{
    pl_narrow *narrow = &world->narrow;
    pl_manifold *m = pl_manifolds(narrow);
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < narrow->manifold_count; ++i) {
        if (m[i].count == 0) {
            continue;
        }
        if (kept != i) {
            m[kept] = m[i];
            pairs[m[kept].pair].manifold = kept;
        }
        ++kept;
    }
    narrow->manifold_count = kept;
}

void pl_seams_correct(plumb_world *world, real dt)
{
    pl_narrow *narrow = &world->narrow;
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const pl_seam_pair *list = world->seams.pairs.data;
    bool changed = false, gaps = false;
    for (uint32_t i = 0; i < world->seams.pair_count; ++i) {
        pl_pair *pair = &pairs[list[i].pair];
        if (pair->manifold == PL_NONE) {
            continue;
        }
        pl_manifold *m = &pl_manifolds(narrow)[pair->manifold];
        switch (judge(world, pair, m, (double)dt)) {
        case SET_RIGHT:
            carry_over(&list[i], pair, m);
            changed = true;
            break;
        case FALSE_CONTACT:
            m->count = 0;
            take_out(pair);
            gaps = true;
            break;
        case RIGHT:
            break;
        }
    }
    if (gaps) {
        close_gaps(world);
    }
    if (changed || gaps) {
        pl_narrow_summarise(narrow);
    }
}
