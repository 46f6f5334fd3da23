// contour.c - convex outlines that can be grown and shrunk, and their feathered fill.
//
// A rounded polygon is its core polygon grown by a radius. Offsetting by d gives radius + d: while
// that is positive the corners are arcs around the core's vertices; below zero the core itself
// shrinks along its mitres. One formula (plr_contour_at) so covers disc, capsule and polygon.
// Cost: O(points); a disc of R pixels has about 2 pi / acos(1 - tolerance / R) / 2 points.
#include "internal.h"

#include <math.h>

// Largest distance between an arc and its chord [px]; not visible under the one-pixel feather.
static const double chord_error = 0.03;
// Spikes of acute corners are cut at this multiple of the offset.
static const double mitre_max = 4.0;
// Points nearer than this [px] are one point.
static const double same_point = 1e-4;
// From this many points on a fan around the centre rasterises faster than one around a corner.
static const size_t center_fan_points = 8;
// Half of the anti-aliasing ramp [px].
static const double half_ramp = 0.5;
// Of a small shape the outline takes at most this share of its inradius.
static const double outline_share = 0.28;

static void add_point(plr_contour *contour, render_vec base, render_vec normal, render_vec mitre)
{
    if (contour->count < PLR_CONTOUR_MAX) {
        const size_t i = contour->count++;
        contour->base[i] = base;
        contour->normal[i] = normal;
        contour->mitre[i] = mitre;
    }
}

// Points of an arc around `base` from direction n0, turning by `turn` in the sense of the contour.
static void add_arc(plr_contour *contour, render_vec base, render_vec n0, double turn,
                    render_vec mitre, bool with_end)
{
    const double ratio = fmin(chord_error / fmax(contour->radius, chord_error), 0.25);
    const double step = fmax(2.0 * acos(1.0 - ratio), 2.0 * PLR_PI / 2048.0);
    const int pieces = (int)fmax(1.0, ceil(turn / step));
    const int last = with_end ? pieces : pieces - 1;
    for (int i = 0; i <= last; i++) {
        const double a = turn * i / pieces, c = cos(a), s = sin(a);
        const render_vec n = { n0.x * c - n0.y * s, n0.x * s + n0.y * c };
        add_point(contour, base, n, mitre);
    }
}

// Copies the points without neighbours that coincide, in positive orientation.
static size_t tidy(const render_vec *points, size_t count, render_vec *out)
{
    double area = 0.0;
    for (size_t i = 0; i < count; i++) {
        const render_vec a = points[i], b = points[(i + 1) % count], o = points[0];
        area += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
    }
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const render_vec p = points[area < 0.0 ? count - 1 - i : i];
        if (kept == 0 || hypot(p.x - out[kept - 1].x, p.y - out[kept - 1].y) > same_point) {
            out[kept++] = p;
        }
    }
    while (kept > 1 &&
           hypot(out[0].x - out[kept - 1].x, out[0].y - out[kept - 1].y) <= same_point) {
        kept--;
    }
    return kept;
}

static render_vec outward(render_vec a, render_vec b)
{
    const double length = hypot(b.x - a.x, b.y - a.y);
    return (render_vec){ (b.y - a.y) / length, (a.x - b.x) / length };
}

static void make_polygon(plr_contour *contour, const render_vec *v, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const render_vec n0 = outward(v[(i + count - 1) % count], v[i]);
        const render_vec n1 = outward(v[i], v[(i + 1) % count]);
        const double dot = n0.x * n1.x + n0.y * n1.y;
        const double k = 1.0 / fmax(1.0 + dot, 2.0 / (mitre_max * mitre_max));
        const render_vec mitre = { (n0.x + n1.x) * k, (n0.y + n1.y) * k };
        if (contour->radius > 0.0) {
            const double turn = fmax(atan2(n0.x * n1.y - n0.y * n1.x, dot), 0.0);
            add_arc(contour, v[i], n0, turn, mitre, true);
        } else {
            add_point(contour, v[i], mitre, mitre);
        }
    }
    double least = INFINITY;
    for (size_t i = 0; i < count; i++) {
        const render_vec n = outward(v[i], v[(i + 1) % count]);
        const double d = (v[i].x - contour->center.x) * n.x + (v[i].y - contour->center.y) * n.y;
        least = fmin(least, d);
    }
    contour->inradius = contour->radius + fmax(least, 0.0);
}

bool plr_contour_make(plr_contour *contour, const render_vec *points, size_t count, double radius)
{
    render_vec v[PLR_CLIPPED_MAX];
    const render_vec none = { 0.0, 0.0 };
    const size_t kept = tidy(points, count, v);
    contour->count = 0;
    contour->radius = radius;
    contour->inradius = radius;
    contour->center = none;
    for (size_t i = 0; i < kept; i++) {
        contour->center.x += v[i].x / (double)kept;
        contour->center.y += v[i].y / (double)kept;
    }
    if (kept >= 3) {
        make_polygon(contour, v, kept);
    } else if (kept == 2) {
        const render_vec n = outward(v[0], v[1]);
        add_arc(contour, v[1], n, PLR_PI, none, true);
        add_arc(contour, v[0], (render_vec){ -n.x, -n.y }, PLR_PI, none, true);
    } else {
        add_arc(contour, v[0], (render_vec){ 1.0, 0.0 }, 2.0 * PLR_PI, none, false);
    }
    return contour->inradius > 0.0;
}

render_vec plr_contour_at(const plr_contour *contour, size_t index, double offset)
{
    const double d = contour->radius + offset;
    const render_vec base = contour->base[index];
    const render_vec along = d >= 0.0 ? contour->normal[index] : contour->mitre[index];
    return (render_vec){ base.x + along.x * d, base.y + along.y * d };
}

// ---- fill

// Adds the contour's points at an offset; returns the index of the first.
static uint32_t add_ring(plr_batch *batch, const plr_contour *contour, double offset,
                         render_rgba color)
{
    const uint32_t first = (uint32_t)batch->vertex_count;
    for (size_t i = 0; i < contour->count; i++) {
        const render_vec p = plr_contour_at(contour, i, offset);
        plr_batch_vertex(batch, p.x, p.y, color);
    }
    return first;
}

static void join_rings(plr_batch *batch, uint32_t outer, uint32_t inner, size_t count)
{
    const uint32_t n = (uint32_t)count;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t k = i + 1 < n ? i + 1 : 0;
        plr_batch_quad(batch, outer + i, outer + k, inner + k, inner + i);
    }
}

static void fill_ring(plr_batch *batch, const plr_contour *contour, uint32_t ring,
                      render_rgba color)
{
    const uint32_t n = (uint32_t)contour->count;
    if (n >= center_fan_points) {
        const uint32_t middle =
            plr_batch_vertex(batch, contour->center.x, contour->center.y, color);
        for (uint32_t i = 0; i < n; i++) {
            plr_batch_triangle(batch, middle, ring + i, ring + (i + 1 < n ? i + 1 : 0));
        }
        return;
    }
    for (uint32_t i = 2; i < n; i++) {
        plr_batch_triangle(batch, ring, ring + i - 1, ring + i);
    }
}

void plr_paint_contour(plr_painter *painter, const plr_contour *contour, double outline_width,
                       render_rgba fill, render_rgba outline)
{
    plr_batch *batch = painter->batch;
    const double width = fmin(outline_width, outline_share * contour->inradius);
    const double inner = fmin(half_ramp, contour->inradius);
    const render_rgba edge = width > 0.0 ? plr_mix(fill, outline, fmin(width, 1.0)) : fill;
    // A shape thinner than the ramp cannot cover a pixel fully.
    const double cover = fmin(1.0, contour->inradius + half_ramp);
    const uint32_t a = add_ring(batch, contour, half_ramp, plr_fade(edge, 0.0));
    uint32_t b = add_ring(batch, contour, -inner, plr_fade(edge, cover));
    join_rings(batch, a, b, contour->count);
    if (width > 0.0) {
        if (width > 1.0) {
            const uint32_t c = add_ring(batch, contour, half_ramp - width, edge);
            join_rings(batch, b, c, contour->count);
            b = c;
        }
        const double end = fmin(fmax(width, half_ramp) + half_ramp, contour->inradius);
        const uint32_t d = add_ring(batch, contour, -end, fill);
        join_rings(batch, b, d, contour->count);
        b = d;
    }
    fill_ring(batch, contour, b, fill);
}

void plr_paint_inside(plr_painter *painter, const plr_contour *contour, double outline_width,
                      render_rgba fill)
{
    plr_batch *batch = painter->batch;
    const double width = fmin(outline_width, outline_share * contour->inradius);
    // A little further in than the outline's own ramp, or the two together would thin it.
    const double inner = fmin(width + half_ramp + PLR_INSIDE_SHIFT, contour->inradius);
    const double outer = fmin(width - half_ramp + PLR_INSIDE_SHIFT, inner);
    const uint32_t a = add_ring(batch, contour, -outer, plr_fade(fill, 0.0));
    const uint32_t b = add_ring(batch, contour, -inner, fill);
    join_rings(batch, a, b, contour->count);
    fill_ring(batch, contour, b, fill);
}
