// stroke.c - lines, dashes, arrows, dots and panels, all with feathered edges.
//
// A polyline is one strip with four vertices across: transparent, opaque, opaque, transparent,
// so that a translucent line does not darken where its segments meet. Where it turns sharply the
// strip is broken and the corner covered by a disc. Cost: O(points).
#include "internal.h"

#include <math.h>

static const double half_ramp = 0.5;
// Points nearer than this [px] are one point.
static const double same_point = 0.01;
// The strip is broken where directions turn by more than acos(this), about 107 degrees.
static const double sharp_turn = -0.3;
// Lines are clipped this far [px] outside the picture, where float coordinates are still exact.
static const double guard = 256.0;

static render_vec direction(render_vec a, render_vec b)
{
    const double length = hypot(b.x - a.x, b.y - a.y);
    return (render_vec){ (b.x - a.x) / length, (b.y - a.y) / length };
}

// Lateral profile of a line.
typedef struct profile {
    double outer;
    double core;
    double alpha;
} profile;

static profile make_profile(double width)
{
    const double half = 0.5 * width;
    return (profile){ half + half_ramp, fmax(half - half_ramp, 0.0), fmin(width, 1.0) };
}

// Adds the four vertices across the line at `p`; `side` points to the left, scaled by the mitre.
static uint32_t add_section(plr_batch *batch, profile shape, render_vec p, render_vec side,
                            render_rgba color, double alpha)
{
    const double across[4] = { -shape.outer, -shape.core, shape.core, shape.outer };
    const render_rgba full = plr_fade(color, alpha * shape.alpha), none = plr_fade(color, 0.0);
    const uint32_t first = (uint32_t)batch->vertex_count;
    for (int i = 0; i < 4; i++) {
        plr_batch_vertex(batch, p.x + side.x * across[i], p.y + side.y * across[i],
                         i == 1 || i == 2 ? full : none);
    }
    return first;
}

static void join_sections(plr_batch *batch, uint32_t a, uint32_t b)
{
    for (uint32_t i = 0; i < 3; i++) {
        plr_batch_quad(batch, a + i, b + i, b + i + 1, a + i + 1);
    }
}

static render_vec left_of(render_vec d)
{
    return (render_vec){ -d.y, d.x };
}

// Begins or ends a strip: the ramp along the line. `outward` is the direction out of the line.
static uint32_t add_cap(plr_batch *batch, profile shape, render_vec p, render_vec outward,
                        render_vec side, render_rgba color, bool begin)
{
    const render_vec in = { p.x - outward.x * half_ramp, p.y - outward.y * half_ramp };
    const render_vec out = { p.x + outward.x * half_ramp, p.y + outward.y * half_ramp };
    const uint32_t a = add_section(batch, shape, begin ? out : in, side, color, begin ? 0.0 : 1.0);
    const uint32_t b = add_section(batch, shape, begin ? in : out, side, color, begin ? 1.0 : 0.0);
    join_sections(batch, a, b);
    return begin ? b : a;
}

static bool in_guard(const plr_painter *painter, render_vec p)
{
    return p.x > -guard && p.y > -guard && p.x < painter->width + guard &&
           p.y < painter->height + guard;
}

// Clips a-b to the guard rectangle (Liang and Barsky 1984). False when nothing is left.
static bool clip(const plr_painter *painter, render_vec *a, render_vec *b)
{
    const render_vec d = { b->x - a->x, b->y - a->y };
    const double p[4] = { -d.x, d.x, -d.y, d.y };
    const double q[4] = { a->x + guard, painter->width + guard - a->x, a->y + guard,
                          painter->height + guard - a->y };
    double t0 = 0.0, t1 = 1.0;
    for (int i = 0; i < 4; i++) {
        if (p[i] < 0.0) {
            t0 = fmax(t0, q[i] / p[i]);
        } else if (p[i] > 0.0) {
            t1 = fmin(t1, q[i] / p[i]);
        } else if (q[i] < 0.0) {
            return false;
        }
    }
    if (t0 > t1) {
        return false;
    }
    const render_vec start = *a;
    *a = (render_vec){ start.x + t0 * d.x, start.y + t0 * d.y };
    *b = (render_vec){ start.x + t1 * d.x, start.y + t1 * d.y };
    return true;
}

void plr_line(plr_painter *painter, render_vec a, render_vec b, double width, render_rgba color)
{
    if (!clip(painter, &a, &b) || hypot(b.x - a.x, b.y - a.y) < same_point) {
        return;
    }
    plr_batch *batch = painter->batch;
    const profile shape = make_profile(width);
    const render_vec d = direction(a, b), side = left_of(d);
    const render_vec back = { -d.x, -d.y };
    const uint32_t from = add_cap(batch, shape, a, back, side, color, true);
    const uint32_t to = add_cap(batch, shape, b, d, side, color, false);
    join_sections(batch, from, to);
}

// A stroke that leaves the guard rectangle, segment by segment.
static void stroke_far(plr_painter *painter, const render_vec *points, size_t count, bool closed,
                       double width, render_rgba first, render_rgba last)
{
    const size_t segments = closed ? count : count - 1;
    for (size_t i = 0; i < segments; i++) {
        const double t = ((double)i + 0.5) / (double)segments;
        plr_line(painter, points[i], points[(i + 1) % count], width, plr_mix(first, last, t));
        if (width > 2.0 && in_guard(painter, points[i])) {
            plr_dot(painter, points[i], 0.5 * width, plr_mix(first, last, t));
        }
    }
}

// Walks a polyline without the points that coincide with their predecessor.
typedef struct walk {
    const render_vec *points;
    size_t count;
    size_t total; // positions, one more than points when closed
} walk;

static bool next_point(const walk *line, size_t *position, render_vec from, render_vec *to)
{
    for (size_t i = *position + 1; i < line->total; i++) {
        const render_vec p = line->points[i % line->count];
        if (hypot(p.x - from.x, p.y - from.y) >= same_point) {
            *position = i;
            *to = p;
            return true;
        }
    }
    return false;
}

static void stroke_strip(plr_painter *painter, const walk *line, double width, render_rgba first,
                         render_rgba last, bool closed)
{
    plr_batch *batch = painter->batch;
    const profile shape = make_profile(width);
    size_t position = 0;
    render_vec here = line->points[0], there;
    if (!next_point(line, &position, here, &there)) {
        return;
    }
    render_vec d = direction(here, there);
    uint32_t from =
        add_cap(batch, shape, here, (render_vec){ -d.x, -d.y }, left_of(d), first, true);
    for (;;) {
        const render_rgba color =
            plr_mix(first, last, (double)position / (double)(line->total - 1));
        here = there;
        if (!next_point(line, &position, here, &there)) {
            join_sections(batch, from, add_cap(batch, shape, here, d, left_of(d), color, false));
            break;
        }
        const render_vec e = direction(here, there), n0 = left_of(d), n1 = left_of(e);
        const double dot = d.x * e.x + d.y * e.y;
        if (dot < sharp_turn) {
            join_sections(batch, from, add_cap(batch, shape, here, d, n0, color, false));
            plr_dot(painter, here, 0.5 * width, color);
            from = add_cap(batch, shape, here, (render_vec){ -e.x, -e.y }, n1, color, true);
        } else {
            const double k = 1.0 / (1.0 + dot);
            const render_vec side = { (n0.x + n1.x) * k, (n0.y + n1.y) * k };
            const uint32_t to = add_section(batch, shape, here, side, color, 1.0);
            join_sections(batch, from, to);
            from = to;
        }
        d = e;
    }
    if (closed && width > 1.0) {
        plr_dot(painter, here, 0.5 * width, last); // covers the notch where the ends meet
    }
}

void plr_stroke(plr_painter *painter, const render_vec *points, size_t count, bool closed,
                double width, render_rgba first, render_rgba last)
{
    if (count < 2) {
        return;
    }
    for (size_t i = 0; i < count; i++) {
        if (!in_guard(painter, points[i])) {
            stroke_far(painter, points, count, closed, width, first, last);
            return;
        }
    }
    const walk line = { points, count, closed ? count + 1 : count };
    stroke_strip(painter, &line, width, first, last, closed);
}

void plr_dashes(plr_painter *painter, const render_vec *points, size_t count, bool closed,
                double width, double dash, double gap, render_rgba color)
{
    const size_t segments = closed ? count : count - 1;
    double phase = 0.0; // position within the period at the start of the segment
    for (size_t i = 0; i < segments; i++) {
        render_vec a = points[i], b = points[(i + 1) % count];
        if (!clip(painter, &a, &b)) {
            continue;
        }
        const double length = hypot(b.x - a.x, b.y - a.y);
        if (length < same_point) {
            continue;
        }
        const render_vec d = direction(a, b);
        for (double s = -phase; s < length; s += dash + gap) {
            const double s0 = fmax(s, 0.0), s1 = fmin(s + dash, length);
            if (s1 > s0) {
                plr_line(painter, (render_vec){ a.x + d.x * s0, a.y + d.y * s0 },
                         (render_vec){ a.x + d.x * s1, a.y + d.y * s1 }, width, color);
            }
        }
        phase = fmod(phase + length, dash + gap);
    }
}

void plr_fill(plr_painter *painter, const render_vec *points, size_t count, render_rgba color)
{
    if (plr_contour_make(&painter->contour, points, count, 0.0)) {
        plr_paint_contour(painter, &painter->contour, 0.0, color, color);
    }
}

void plr_dot(plr_painter *painter, render_vec center, double radius, render_rgba color)
{
    if (plr_contour_make(&painter->contour, &center, 1, radius)) {
        plr_paint_contour(painter, &painter->contour, 0.0, color, color);
    }
}

void plr_ring(plr_painter *painter, render_vec center, double radius, double width,
              render_rgba color)
{
    enum { steps = 24 };
    render_vec points[steps];
    for (int i = 0; i < steps; i++) {
        const double a = 2.0 * PLR_PI * i / steps;
        points[i] = (render_vec){ center.x + radius * cos(a), center.y + radius * sin(a) };
    }
    plr_stroke(painter, points, steps, true, width, color, color);
}

void plr_arrow(plr_painter *painter, render_vec a, render_vec b, double width, render_rgba color)
{
    const double length = hypot(b.x - a.x, b.y - a.y);
    if (length < 1.0) {
        return; // shorter than a pixel: nothing to see, and no direction
    }
    const double head = fmin(length, 3.4 * width + 2.0), half = 0.42 * head;
    const render_vec d = direction(a, b), n = left_of(d);
    const render_vec neck = { b.x - d.x * head, b.y - d.y * head };
    if (length > head) {
        const render_vec end = { neck.x + d.x, neck.y + d.y }; // one pixel below the head
        plr_line(painter, a, end, width, color);
    }
    const render_vec tip[3] = { b,
                                { neck.x + n.x * half, neck.y + n.y * half },
                                { neck.x - n.x * half, neck.y - n.y * half } };
    plr_fill(painter, tip, 3, color);
}

void plr_panel(plr_painter *painter, render_vec min, render_vec max, double radius,
               render_rgba fill, render_rgba outline)
{
    const render_vec corners[4] = { { min.x + radius, min.y + radius },
                                    { max.x - radius, min.y + radius },
                                    { max.x - radius, max.y - radius },
                                    { min.x + radius, max.y - radius } };
    if (plr_contour_make(&painter->contour, corners, 4, radius)) {
        plr_paint_contour(painter, &painter->contour, outline.a > 0 ? 1.0 : 0.0, fill, outline);
    }
}
