// immersed.c - outlines of edges and arcs, cut by half planes; their area and centroid.
//
// Reads, writes: what it is given. Cost: O(elements) a cut, without allocation; one arc tangent an arc for the area.
//
// Cutting: each element is divided where it crosses the line, and each part is in or out as its middle is. A row of parts
// that are out is replaced by one cut. Area: by Green's theorem, edges from the origin and circular segments over
// chords; of one of angle a the area is r^2 (a - sin a) / 2, its moment about the centre 2/3 r^3 sin^3(a/2).
#include "geometry/immersed.h"

#include "math/trig.h"

#include <math.h>

//---- made ----------------------------------------------------------------------------------------

typedef struct vec {
    double x, y;
} vec;

static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y;
}

static double cross(vec a, vec b)
{
    return a.x * b.y - a.y * b.x;
}

static vec turned(plumb_rot q, double x, double y)
{
    const double c = (double)q.c, s = (double)q.s;
    return (vec){ c * x - s * y, s * x + c * y };
}

static vec placed(plumb_vec2 p, plumb_transform frame, vec from)
{
    const vec r = turned(frame.q, (double)p.x, (double)p.y);
    return (vec){ r.x + ((double)frame.p.x - from.x), r.y + ((double)frame.p.y - from.y) };
}

static void add_edge(pl_contour *out, vec from, bool cut, bool inner)
{
    out->at[out->count++] = (pl_element){ .x = from.x, .y = from.y, .cut = cut, .inner = inner };
}

static void add_arc(pl_contour *out, vec from, vec center, double r)
{
    out->at[out->count++] = (pl_element){ from.x, from.y, center.x, center.y, r, false, false };
}

// Arcs about a core point, from one normal to another a quarter or less of a turn at a time.
static void add_quarters(pl_contour *out, vec center, double r, vec normal, int quarters)
{
    for (int i = 0; i < quarters; ++i) {
        add_arc(out, (vec){ center.x + r * normal.x, center.y + r * normal.y }, center, r);
        normal = (vec){ -normal.y, normal.x };
    }
}

void pl_contour_of(const plumb_convex *shape, uint32_t inner, plumb_transform frame, double x,
                   double y, pl_contour *out)
{
    const vec from = { x, y };
    const double r = (double)shape->radius;
    const int n = shape->count;
    out->count = 0;
    for (int i = 0; i < n; ++i) {
        const vec p = placed(shape->points[i], frame, from);
        if (n == 1) {
            add_quarters(out, p, r, (vec){ 1, 0 }, 4);
            return;
        }
        // The normal of the edge behind the point, and of the one before it.
        const plumb_vec2 normal = shape->normals[i], before = shape->normals[(i + n - 1) % n];
        const vec ahead = turned(frame.q, (double)normal.x, (double)normal.y);
        const vec back = turned(frame.q, (double)before.x, (double)before.y);
        if (r > 0 && n == 2) {
            add_quarters(out, p, r, back, 2);
        } else if (r > 0) {
            add_arc(out, (vec){ p.x + r * back.x, p.y + r * back.y }, p, r);
        }
        add_edge(out, (vec){ p.x + r * ahead.x, p.y + r * ahead.y }, false, (inner >> i & 1) != 0);
    }
}

int pl_half_planes_of(const plumb_convex *shape, plumb_transform frame, double x, double y,
                      pl_half_plane out[PL_HALF_PLANES_MOST])
{
    const vec from = { x, y };
    const double r = (double)shape->radius, turn = 6.283185307179586 / 24;
    const int edges = shape->count > 1 ? shape->count : 0,
              all = shape->count > 2 ? edges : edges + 24;
    for (int i = 0; i < all; ++i) {
        vec n;
        if (i < edges) {
            n = turned(frame.q, (double)shape->normals[i].x, (double)shape->normals[i].y);
        } else {
            pl_sincos(turn * (i - edges), &n.y, &n.x);
        }
        double farthest = -INFINITY;
        for (int k = 0; k < shape->count; ++k) {
            const double d = dot(n, placed(shape->points[k], frame, from));
            farthest = d > farthest ? d : farthest;
        }
        out[i] = (pl_half_plane){ n.x, n.y, farthest + r };
    }
    return all;
}

//---- cut -----------------------------------------------------------------------------------------

static vec start_of(const pl_contour *o, int i)
{
    const pl_element *e = &o->at[i == o->count ? 0 : i];
    return (vec){ e->x, e->y };
}

// Where an element from p to q crosses the line, in order; returns how often.
static int crossings(const pl_element *e, vec p, vec q, pl_half_plane by, vec out[2])
{
    const vec n = { by.nx, by.ny };
    if (e->r == 0) {
        const double before = dot(n, p) - by.d, behind = dot(n, q) - by.d;
        if ((before <= 0) == (behind <= 0)) {
            return 0;
        }
        const double at = before / (before - behind);
        out[0] = (vec){ p.x + at * (q.x - p.x), p.y + at * (q.y - p.y) };
        return 1;
    }
    const vec c = { e->cx, e->cy }, u = { p.x - c.x, p.y - c.y }, v = { q.x - c.x, q.y - c.y };
    const double near = by.d - dot(n, c), square = e->r * e->r - near * near;
    if (!(square > 0)) {
        return 0;
    }
    const double half = sqrt(square);
    int count = 0;
    for (int side = -1; side <= 1; side += 2) {
        const vec w = { near * n.x - side * half * n.y, near * n.y + side * half * n.x };
        if (cross(u, w) > 0 && cross(w, v) > 0) {
            out[count++] = (vec){ c.x + w.x, c.y + w.y };
        }
    }
    if (count == 2) {
        const vec a = { out[0].x - c.x, out[0].y - c.y }, b = { out[1].x - c.x, out[1].y - c.y };
        if (cross(a, b) < 0) {
            const vec kept = out[0];
            out[0] = out[1];
            out[1] = kept;
        }
    }
    return count;
}

// Whether the middle of a part of an element is in the half plane.
static bool is_in(const pl_element *e, vec p, vec q, pl_half_plane by)
{
    const vec n = { by.nx, by.ny };
    vec middle = { (p.x + q.x) / 2, (p.y + q.y) / 2 };
    if (e->r > 0) {
        const vec m = { middle.x - e->cx, middle.y - e->cy };
        const double length = sqrt(dot(m, m));
        const double k = length > 0 ? e->r / length : 0;
        middle = (vec){ e->cx + k * m.x, e->cy + k * m.y };
    }
    return dot(n, middle) <= by.d;
}

// Whether all of it is within; it is nowhere beyond its ends and the tops of its arcs.
static bool holds_all(const pl_contour *o, pl_half_plane by)
{
    const vec n = { by.nx, by.ny };
    for (int i = 0; i < o->count; ++i) {
        const pl_element *e = &o->at[i];
        const double top = by.nx * e->cx + by.ny * e->cy + e->r;
        if (dot(n, start_of(o, i)) > by.d || (e->r > 0 && top > by.d)) {
            return false;
        }
    }
    return true;
}

void pl_contour_cut(pl_contour *o, pl_half_plane by)
{
    if (holds_all(o, by)) {
        return;
    }
    pl_contour left = { .count = 0 };
    bool first_in = true, was_in = true, any = false;
    for (int i = 0; i < o->count; ++i) {
        const pl_element *e = &o->at[i];
        vec points[4] = { start_of(o, i) };
        const int crossed = crossings(e, points[0], start_of(o, i + 1), by, points + 1);
        points[crossed + 1] = start_of(o, i + 1);
        for (int k = 0; k <= crossed && left.count + 2 < PL_ELEMENTS_MOST; ++k) {
            const bool in = is_in(e, points[k], points[k + 1], by);
            if (!any) {
                first_in = was_in = in;
                any = true;
            }
            if (in) {
                left.at[left.count++] =
                    (pl_element){ points[k].x, points[k].y, e->cx, e->cy, e->r, e->cut, e->inner };
            } else if (was_in && (i > 0 || k > 0)) {
                add_edge(&left, points[k], true, false);
            }
            was_in = in;
        }
    }
    if (was_in && !first_in) {
        add_edge(&left, start_of(o, 0), true, false);
    }
    *o = left;
}

//---- area ----------------------------------------------------------------------------------------

pl_area pl_contour_area(const pl_contour *o)
{
    pl_area sum = { 0 };
    for (int i = 0; i < o->count; ++i) {
        const pl_element *e = &o->at[i];
        const vec p = start_of(o, i), q = start_of(o, i + 1);
        const double twice = cross(p, q);
        sum.area += twice / 2;
        sum.x += (p.x + q.x) * twice / 6;
        sum.y += (p.y + q.y) * twice / 6;
        if (e->r > 0) {
            const vec u = { p.x - e->cx, p.y - e->cy }, v = { q.x - e->cx, q.y - e->cy };
            const vec middle = { u.x + v.x, u.y + v.y };
            const double length = sqrt(dot(middle, middle)), rr = e->r * e->r;
            const double sine = cross(u, v) / rr, angle = pl_atan2(cross(u, v), dot(u, v));
            // Of a sliver the product rounds to more than the square.
            const double versed = 1 - dot(u, v) / rr, half = versed > 0 ? sqrt(versed / 2) : 0;
            const double area = rr * (angle - sine) / 2;
            const double moment =
                length > 0 ? 2 * e->r * rr * half * half * half / (3 * length) : 0;
            sum.area += area;
            sum.x += area * e->cx + moment * middle.x;
            sum.y += area * e->cy + moment * middle.y;
        }
    }
    return sum;
}

pl_waterline pl_contour_waterline(const pl_contour *o, double x, double y)
{
    pl_waterline sum = { 0 };
    for (int i = 0; i < o->count; ++i) {
        const vec p = start_of(o, i), q = start_of(o, i + 1);
        // Counter-clockwise, a cut that faces (x, y) runs to its left.
        const double from = x * p.y - y * p.x, to = x * q.y - y * q.x;
        if (o->at[i].cut && to > from) {
            sum.width += to - from;
            sum.second += (to * to * to - from * from * from) / 3;
        }
    }
    return sum;
}
