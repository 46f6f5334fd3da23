// sweep.c - see sweep.h: the sum of two convex cores, its nearest place, a ray against it.
//
// The edges of the sum of two convex polygons are those of both, in order of direction: they are
// merged like two sorted lists, O(n + m) (de Berg et al., Computational Geometry, 13.3). A point has
// no edges, a line two, there and back.
//
// Reads, writes: arguments. Cost: O(corners), no allocation.
#include "query/sweep.h"

#include <math.h>

//---- the sum ------------------------------------------------------------------------------------

// The corner from which edges go by ascending direction, starting at that of +x: the lowest, of
// those the leftmost. `sign` -1 mirrors the shape.
static int first_corner(const pl_round *r, double sign)
{
    int first = 0;
    for (int i = 1; i < r->count; ++i) {
        double dy = sign * (r->y[i] - r->y[first]);
        if (dy < 0 || (dy == 0 && sign * (r->x[i] - r->x[first]) < 0)) {
            first = i;
        }
    }
    return first;
}

// The edges of a shape, or of its mirror image, one after the other.
typedef struct edges {
    const pl_round *r;
    double sign;
    int at, left; // corner, edges to come
    double dx, dy;
} edges;

static void look(edges *e)
{
    int next = e->at + 1 < e->r->count ? e->at + 1 : 0;
    e->dx = e->sign * (e->r->x[next] - e->r->x[e->at]);
    e->dy = e->sign * (e->r->y[next] - e->r->y[e->at]);
}

static edges edges_of(const pl_round *r, double sign)
{
    edges e = { .r = r, .sign = sign, .left = r->count > 1 ? r->count : 0 };
    e.at = first_corner(r, sign);
    look(&e);
    return e;
}

static void pass(edges *e)
{
    e->at = e->at + 1 < e->r->count ? e->at + 1 : 0;
    --e->left;
    look(e);
}

static void add_corner(pl_sum *out, const edges *f, const edges *m)
{
    double x = f->r->x[f->at] - m->r->x[m->at];
    double y = f->r->y[f->at] - m->r->y[m->at];
    int last = out->count - 1;
    if (out->count == 0 || x != out->x[last] || y != out->y[last]) {
        out->x[out->count] = x;
        out->y[out->count++] = y;
    }
}

static void set_normals(pl_sum *out)
{
    for (int i = 0; i < out->count; ++i) {
        int next = i + 1 < out->count ? i + 1 : 0;
        double dx = out->x[next] - out->x[i];
        double dy = out->y[next] - out->y[i];
        double length = sqrt(dx * dx + dy * dy);
        out->nx[i] = length > 0 ? dy / length : 0;
        out->ny[i] = length > 0 ? -dx / length : 0;
    }
}

void pl_sum_make(const pl_round *fixed, const pl_round *mover, pl_sum *out)
{
    edges f = edges_of(fixed, 1);
    edges m = edges_of(mover, -1);
    out->count = 0;
    out->radius = fixed->radius + mover->radius;
    if (f.left + m.left == 0) {
        add_corner(out, &f, &m);
    }
    while (f.left + m.left > 0) {
        add_corner(out, &f, &m);
        double turn = f.dx * m.dy - f.dy * m.dx;
        bool f_first = m.left == 0 || (f.left > 0 && (turn > 0 || (f.dx == 0 && f.dy == 0)));
        bool m_first = f.left == 0 || (m.left > 0 && (turn < 0 || (m.dx == 0 && m.dy == 0)));
        bool both = f_first == m_first; // one direction: one edge
        if (f_first || both) {
            pass(&f);
        }
        if (m_first || both) {
            pass(&m);
        }
    }
    if (out->count > 1 && out->x[0] == out->x[out->count - 1] &&
        out->y[0] == out->y[out->count - 1]) {
        --out->count;
    }
    set_normals(out);
}

//---- nearest place ------------------------------------------------------------------------------

// Squared distance of (x, y) from edge i; *qx, *qy: from its nearest place to the point.
static double edge_distance_sq(const pl_sum *s, int i, double x, double y, double *qx, double *qy)
{
    int next = i + 1 < s->count ? i + 1 : 0;
    double dx = s->x[next] - s->x[i];
    double dy = s->y[next] - s->y[i];
    double rx = x - s->x[i];
    double ry = y - s->y[i];
    double length_sq = dx * dx + dy * dy;
    double t = length_sq > 0 ? (rx * dx + ry * dy) / length_sq : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    *qx = rx - t * dx;
    *qy = ry - t * dy;
    return *qx * *qx + *qy * *qy;
}

pl_sum_near pl_sum_nearest(const pl_sum *s, double x, double y)
{
    int deepest = 0;
    double outside = -HUGE_VAL; // of the line of the edge that sees the point from farthest
    for (int i = 0; i < s->count && s->count > 2; ++i) {
        double h = s->nx[i] * (x - s->x[i]) + s->ny[i] * (y - s->y[i]);
        if (h > outside) {
            outside = h;
            deepest = i;
        }
    }
    if (s->count > 2 && outside <= 0) {
        return (pl_sum_near){ outside - s->radius, s->nx[deepest], s->ny[deepest] };
    }
    double least = HUGE_VAL, nx = 0, ny = 0;
    for (int i = 0; i < s->count; ++i) {
        double qx, qy;
        double d = edge_distance_sq(s, i, x, y, &qx, &qy);
        if (d < least) {
            least = d;
            nx = qx;
            ny = qy;
            deepest = i;
        }
    }
    double distance = sqrt(least);
    if (distance > 0) {
        return (pl_sum_near){ distance - s->radius, nx / distance, ny / distance };
    }
    // On the core itself: a line has its normal, a point none, so any.
    bool is_line = s->nx[deepest] != 0 || s->ny[deepest] != 0;
    return (pl_sum_near){ -s->radius, is_line ? s->nx[deepest] : 0, is_line ? s->ny[deepest] : 1 };
}

//---- ray ----------------------------------------------------------------------------------------

// [-] of the lengths that a height is made of: what rounding may do to it.
#define ROUNDING 1e-14

// A ray in unit direction; `length` shrinks to the first meeting.
typedef struct line {
    double x, y, dx, dy, length;
    double nx, ny; // of the meeting
    bool met;
} line;

static void meet(line *l, double at, double nx, double ny)
{
    l->length = at;
    l->nx = nx;
    l->ny = ny;
    l->met = true;
}

// The circle of the sum's radius about corner i, from outside. The distance of the centre from the
// line, not a quadratic formula: that loses the digits of a far start.
static void meet_corner(line *l, const pl_sum *s, int i)
{
    double cx = s->x[i] - l->x;
    double cy = s->y[i] - l->y;
    double along = cx * l->dx + cy * l->dy;
    double ox = along * l->dx - cx;
    double oy = along * l->dy - cy;
    double half_chord_sq = s->radius * s->radius - (ox * ox + oy * oy);
    bool grazes = half_chord_sq == 0 && s->radius > 0;
    if (along <= 0 || half_chord_sq < 0 || grazes) {
        return;
    }
    double half_chord = sqrt(half_chord_sq);
    double at = along - half_chord;
    at = at > 0 ? at : 0;
    if (at > l->length || (l->met && at == l->length)) {
        return;
    }
    double nx = ox - (along - at) * l->dx, ny = oy - (along - at) * l->dy;
    double size = sqrt(nx * nx + ny * ny);
    // A core without rounding has no normal at its corner: it faces the ray.
    meet(l, at, size > 0 ? nx / size : -l->dx, size > 0 ? ny / size : -l->dy);
}

// Edge i moved out by the radius, from its outer side.
static void meet_edge(line *l, const pl_sum *s, int i)
{
    double rx = l->x - s->x[i], ry = l->y - s->y[i];
    double height = s->nx[i] * rx + s->ny[i] * ry - s->radius;
    double approach = -(l->dx * s->nx[i] + l->dy * s->ny[i]);
    if (approach <= 0 || height < -ROUNDING * (fabs(rx) + fabs(ry) + s->radius)) {
        return;
    }
    double at = height > 0 ? height / approach : 0; // outside all the same: by rounding
    if (at > l->length) {
        return;
    }
    int next = i + 1 < s->count ? i + 1 : 0;
    double tx = -s->ny[i], ty = s->nx[i]; // along the edge
    double along = tx * (l->x + at * l->dx - s->x[i]) + ty * (l->y + at * l->dy - s->y[i]);
    double length = tx * (s->x[next] - s->x[i]) + ty * (s->y[next] - s->y[i]);
    if (along >= 0 && along <= length) {
        meet(l, at, s->nx[i], s->ny[i]);
    }
}

// A sharp polygon is clipped half-plane by half-plane (Cyrus and Beck 1978): no ray slips between
// two of its edges.
static void meet_polygon(line *l, const pl_sum *s)
{
    double enter = 0, leave = l->length;
    int edge = -1;
    for (int i = 0; i < s->count; ++i) {
        double height = s->nx[i] * (l->x - s->x[i]) + s->ny[i] * (l->y - s->y[i]);
        double approach = -(l->dx * s->nx[i] + l->dy * s->ny[i]);
        if (approach > 0) {
            if (height >= enter * approach) {
                enter = height / approach;
                edge = i;
            }
        } else if (height >= 0) {
            return; // outside, and not on the way in
        } else if (approach < 0) {
            leave = height > leave * approach ? height / approach : leave;
        }
        if (enter > leave) {
            return;
        }
    }
    if (edge >= 0) {
        meet(l, enter, s->nx[edge], s->ny[edge]);
    }
}

static bool cast_from_outside(const pl_sum *s, line *l)
{
    if (s->count > 2 && s->radius == 0) {
        meet_polygon(l, s);
        return l->met;
    }
    for (int i = 0; i < s->count; ++i) {
        if (s->count > 1) {
            meet_edge(l, s, i);
        }
        meet_corner(l, s, i);
    }
    return l->met;
}

bool pl_sum_cast(const pl_sum *s, double x, double y, double dx, double dy, double touch,
                 pl_sum_hit *hit)
{
    pl_sum_near near = pl_sum_nearest(s, x, y);
    if (near.distance < -touch) {
        *hit = (pl_sum_hit){ 0, near.nx, near.ny, -near.distance };
        return true;
    }
    double length = sqrt(dx * dx + dy * dy);
    if (near.distance <= 0) {
        // A convex set lies on one side of the tangent: who does not approach it never meets it.
        bool approaches = near.nx * dx + near.ny * dy < 0;
        *hit = (pl_sum_hit){ 0, near.nx, near.ny, 0 };
        return approaches;
    }
    if (length < near.distance) {
        return false;
    }
    line l = { .x = x, .y = y, .dx = dx / length, .dy = dy / length, .length = length };
    if (!cast_from_outside(s, &l)) {
        return false;
    }
    double fraction = l.length / length;
    *hit = (pl_sum_hit){ fraction < 1 ? fraction : 1, l.nx, l.ny, 0 };
    return true;
}

//---- where they touch ---------------------------------------------------------------------------

// [-] an edge that leans less than this against the normal's right angle lies in the contact.
#define FLAT 1e-4

// The stretch of a core that is farthest along (nx, ny), as a range along the tangent (-ny, nx); how
// far that is. All relative to the shape's own frame.
static double farthest_stretch(const pl_round *r, double nx, double ny, double flat,
                               double range[2])
{
    int best = 0;
    double farthest = -HUGE_VAL;
    for (int i = 0; i < r->count; ++i) {
        double h = nx * r->x[i] + ny * r->y[i];
        if (h > farthest) {
            farthest = h;
            best = i;
        }
    }
    double along = nx * r->y[best] - ny * r->x[best];
    range[0] = range[1] = along;
    const int neighbours[2] = { best + 1 < r->count ? best + 1 : 0,
                                best > 0 ? best - 1 : r->count - 1 };
    for (int k = 0; k < 2 && r->count > 1; ++k) {
        int i = neighbours[k];
        double t = nx * r->y[i] - ny * r->x[i];
        double drop = farthest - (nx * r->x[i] + ny * r->y[i]);
        if (drop <= flat * fabs(t - along)) {
            range[0] = t < range[0] ? t : range[0];
            range[1] = t > range[1] ? t : range[1];
        }
    }
    return farthest;
}

void pl_round_touch(const pl_round *fixed, const pl_round *mover, double dx, double dy, double nx,
                    double ny, double *x, double *y)
{
    pl_round_touch_within(fixed, mover, dx, dy, nx, ny, FLAT, x, y);
}

void pl_round_touch_within(const pl_round *fixed, const pl_round *mover, double dx, double dy,
                           double nx, double ny, double flat, double *x, double *y)
{
    double f[2], m[2], flipped[2];
    double height = farthest_stretch(fixed, nx, ny, flat, f) + fixed->radius;
    farthest_stretch(mover, -nx, -ny, flat, flipped);
    double moved = nx * dy - ny * dx;
    m[0] = moved - flipped[1];
    m[1] = moved - flipped[0];
    double low = f[0] > m[0] ? f[0] : m[0];
    double high = f[1] < m[1] ? f[1] : m[1];
    double t = (low + high) / 2; // beside each other: between them
    t = t < f[0] ? f[0] : t > f[1] ? f[1] : t;
    *x = nx * height - ny * t;
    *y = ny * height + nx * t;
}
