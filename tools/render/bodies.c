// bodies.c - draws bodies: fill, outline, hatching, rotation marks, lines.
//
// Order: sensors below, then static bodies, then the rest as the caller listed them, fluids over them. A body of
// several shapes is drawn in passes, outlines first and insides on top, so that only the outline
// of the union remains; group.c removes the seams between polygons that touch.
// Cost: O(points) a body; shapes out of view cost a box test.
#include "internal.h"

#include <math.h>

// Widths and distances in pixels at ui_scale 1, chosen by eye.
static const double default_outline = 1.6;
static const double hatch_distance = 9.0;
static const double hatch_width = 1.1;
static const double stripe_distance = 11.0;
static const double stripe_width = 4.0;
static const double line_width = 2.4;
static const double tick_distance = 9.0;
static const double tick_length = 7.0;
static const double spoke_radius_min = 4.0; // a smaller disc has no room for a spoke
static const double view_guard = 64.0;      // polygons are clipped this far outside the picture

double plr_outline_width(const plr_painter *painter)
{
    const double wanted = painter->options.outline_px;
    return wanted < 0.0 ? 0.0 : (wanted > 0.0 ? wanted : default_outline) * painter->ui;
}

// ---- hatching

// Clips the line p + t * d to the half planes; false when nothing is left.
static bool clip_line(const plr_half_plane *planes, size_t count, render_vec p, render_vec d,
                      double *t0, double *t1)
{
    for (size_t i = 0; i < count; i++) {
        const render_vec n = planes[i].normal;
        const double speed = n.x * d.x + n.y * d.y;
        const double gap = planes[i].offset - (n.x * p.x + n.y * p.y);
        if (speed > 0.0) {
            *t1 = fmin(*t1, gap / speed);
        } else if (speed < 0.0) {
            *t0 = fmax(*t0, gap / speed);
        } else if (gap < 0.0) {
            return false;
        }
    }
    return *t0 < *t1;
}

void plr_hatch(plr_painter *painter, const plr_half_plane *planes, size_t count, render_vec min,
               render_vec max, const plr_body *body, render_rgba color)
{
    const bool stripes = body->kind == RENDER_KINEMATIC;
    const double distance = (stripes ? stripe_distance : hatch_distance) * painter->ui;
    const double width = (stripes ? stripe_width : hatch_width) * painter->ui;
    min = (render_vec){ fmax(min.x, -view_guard), fmax(min.y, -view_guard) };
    max = (render_vec){ fmin(max.x, painter->width + view_guard),
                        fmin(max.y, painter->height + view_guard) };
    if (min.x >= max.x || min.y >= max.y) {
        return;
    }
    // Lines x + y = c * sqrt(2), rising to the right; they are fixed to the world's origin so
    // that they do not swim when the camera moves.
    const render_vec d = { sqrt(0.5), -sqrt(0.5) };
    const render_vec origin = plr_pixel(painter, (render_vec){ 0.0, 0.0 });
    // So far from the origin lines can no longer be counted.
    const bool countable = fabs(origin.x) + fabs(origin.y) < 1e12;
    const double phase = countable ? (origin.x + origin.y) * sqrt(0.5) : 0.0;
    const double low = (min.x + min.y) * sqrt(0.5), high = (max.x + max.y) * sqrt(0.5);
    const double first = phase + ceil((low - phase) / distance) * distance;
    for (double c = first; c <= high; c += distance) {
        const render_vec p = { c * sqrt(0.5), c * sqrt(0.5) };
        double t0 = -(painter->width + painter->height), t1 = -t0;
        if (clip_line(planes, count, p, d, &t0, &t1)) {
            plr_line(painter, (render_vec){ p.x + d.x * t0, p.y + d.y * t0 },
                     (render_vec){ p.x + d.x * t1, p.y + d.y * t1 }, width, color);
        }
    }
}

static void hatch_contour(plr_painter *painter, const plr_body *body, render_rgba color)
{
    enum { planes_max = 128 }; // a hatched disc is cut to that many sides
    plr_half_plane planes[planes_max];
    const plr_contour *contour = &painter->contour;
    const double inset = plr_outline_width(painter) + 0.5;
    const size_t step = (contour->count + planes_max - 1) / planes_max;
    render_vec min = { INFINITY, INFINITY }, max = { -INFINITY, -INFINITY };
    size_t count = 0;
    for (size_t i = 0; i < contour->count; i += step) {
        const size_t k = i + step < contour->count ? i + step : 0;
        const render_vec a = plr_contour_at(contour, i, 0.0), b = plr_contour_at(contour, k, 0.0);
        const double length = hypot(b.x - a.x, b.y - a.y);
        min = (render_vec){ fmin(min.x, a.x), fmin(min.y, a.y) };
        max = (render_vec){ fmax(max.x, a.x), fmax(max.y, a.y) };
        if (length > 0.0) {
            const render_vec n = { (b.y - a.y) / length, (a.x - b.x) / length };
            planes[count++] = (plr_half_plane){ n, n.x * a.x + n.y * a.y - inset };
        }
    }
    plr_hatch(painter, planes, count, min, max, body, color);
}

// ---- contours of shapes

// Keeps the part of a convex polygon on the lower side of `limit` along an axis (Sutherland and
// Hodgman 1974); `sign` -1 keeps the upper side.
static size_t clip_axis(const render_vec *in, size_t count, render_vec *out, bool vertical,
                        double sign, double limit)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const render_vec a = in[i], b = in[(i + 1) % count];
        const double da = sign * ((vertical ? a.y : a.x) - limit);
        const double db = sign * ((vertical ? b.y : b.x) - limit);
        if (da <= 0.0 && kept < PLR_CLIPPED_MAX) {
            out[kept++] = a;
        }
        if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
            const double t = da / (da - db);
            if (kept < PLR_CLIPPED_MAX) {
                out[kept++] = (render_vec){ a.x + t * (b.x - a.x), a.y + t * (b.y - a.y) };
            }
        }
    }
    return kept;
}

// Cuts a polygon much larger than the picture down, because float coordinates of the order of
// 1e6 px are no longer exact to a fraction of a pixel.
static size_t clip_view(const plr_painter *painter, render_vec *points, size_t count, double radius)
{
    const double border = view_guard + radius;
    render_vec other[PLR_CLIPPED_MAX];
    count = clip_axis(points, count, other, false, -1.0, -border);
    count = clip_axis(other, count, points, false, 1.0, painter->width + border);
    count = clip_axis(points, count, other, true, -1.0, -border);
    return clip_axis(other, count, points, true, 1.0, painter->height + border);
}

// Makes `painter->contour` from a filled shape. False when it is degenerate or out of view.
static bool make_contour(plr_painter *painter, const plr_shape *shape)
{
    render_vec points[PLR_CLIPPED_MAX];
    const double radius = shape->radius * painter->scale;
    const render_vec *world = painter->frame->points + shape->first_point;
    render_vec min = { INFINITY, INFINITY }, max = { -INFINITY, -INFINITY };
    size_t count = shape->point_count;
    for (size_t i = 0; i < count; i++) {
        const render_vec p = plr_pixel(painter, world[i]);
        points[i] = p;
        min = (render_vec){ fmin(min.x, p.x - radius), fmin(min.y, p.y - radius) };
        max = (render_vec){ fmax(max.x, p.x + radius), fmax(max.y, p.y + radius) };
    }
    if (max.x < -1.0 || max.y < -1.0 || min.x > painter->width + 1.0 ||
        min.y > painter->height + 1.0) {
        return false;
    }
    const double far = 16.0 * (painter->width + painter->height);
    if (count >= 3 && (max.x - min.x > far || max.y - min.y > far)) {
        count = clip_view(painter, points, count, radius);
    }
    return count > 0 && plr_contour_make(&painter->contour, points, count, radius);
}

// ---- one shape

static void dashed_outline(plr_painter *painter, double width, render_rgba color)
{
    const plr_contour *contour = &painter->contour;
    double phase = 0.0;
    const double dash = 5.0 * painter->ui, gap = 3.5 * painter->ui;
    for (size_t i = 0; i < contour->count; i++) {
        const size_t k = i + 1 < contour->count ? i + 1 : 0;
        const render_vec ends[2] = { plr_contour_at(contour, i, -0.5 * width),
                                     plr_contour_at(contour, k, -0.5 * width) };
        // Arcs are runs of short pieces: a piece is drawn when its middle lies in a dash.
        const double length = hypot(ends[1].x - ends[0].x, ends[1].y - ends[0].y);
        if (length > dash) {
            plr_dashes(painter, ends, 2, false, width, dash, gap, color);
        } else if (fmod(phase + 0.5 * length, dash + gap) < dash) {
            plr_line(painter, ends[0], ends[1], width, color);
        }
        phase += length;
    }
}

static void draw_spoke(plr_painter *painter, const plr_shape *shape, const plr_paint *paint)
{
    const double radius = shape->radius * painter->scale;
    if (shape->kind != PLR_CIRCLE || radius < spoke_radius_min ||
        !plr_shows(painter, RENDER_SHOW_SPOKES)) {
        return;
    }
    const render_vec center = painter->frame->points[shape->first_point];
    const render_vec rim = { center.x + shape->radius * cos(shape->angle),
                             center.y + shape->radius * sin(shape->angle) };
    const double width = fmin(1.5 * painter->ui, 0.12 * radius + 0.5);
    plr_line(painter, plr_pixel(painter, center), plr_pixel(painter, rim), width,
             plr_fade(paint->outline, 0.8));
}

static void draw_ticks(plr_painter *painter, const plr_shape *shape, double width,
                       render_rgba color)
{
    const render_vec *world = painter->frame->points + shape->first_point;
    const size_t count = shape->point_count;
    const size_t segments = (shape->flags & RENDER_LINE_CLOSED) != 0 ? count : count - 1;
    const double distance = tick_distance * painter->ui, length = tick_length * painter->ui;
    // The right-hand side in the world is the left-hand side in a picture with y upwards.
    const double side = painter->camera->y_down ? -1.0 : 1.0;
    double next = 0.5 * distance; // along the segment
    for (size_t i = 0; i < segments; i++) {
        const render_vec a = plr_pixel(painter, world[i]);
        const render_vec b = plr_pixel(painter, world[(i + 1) % count]);
        const double total = hypot(b.x - a.x, b.y - a.y);
        const double skip = total > 1e5 ? floor(total / 1e5) : 1.0; // bounds the work when far
        for (; next < total; next += distance * skip) {
            const render_vec d = { (b.x - a.x) / total, (b.y - a.y) / total };
            const render_vec p = { a.x + d.x * next, a.y + d.y * next };
            const render_vec n = { -d.y * side, d.x * side };
            const render_vec q = { p.x + (n.x - d.x) * (length * 0.7 + 0.5 * width),
                                   p.y + (n.y - d.y) * (length * 0.7 + 0.5 * width) };
            plr_line(painter, p, q, 1.2 * painter->ui, color);
        }
        next -= total;
    }
}

static void draw_polyline(plr_painter *painter, const plr_shape *shape, const plr_paint *paint)
{
    enum { chunk = 256 }; // long chains are stroked in pieces that overlap by one point
    render_vec points[chunk];
    const render_vec *world = painter->frame->points + shape->first_point;
    const size_t count = shape->point_count;
    const bool closed = (shape->flags & RENDER_LINE_CLOSED) != 0 && count > 2;
    const double width = fmax(2.0 * shape->radius * painter->scale, line_width * painter->ui);
    const double inner = width - 2.0 * plr_outline_width(painter);
    if ((shape->flags & RENDER_LINE_TICKS) != 0) {
        draw_ticks(painter, shape, width, plr_fade(paint->outline, 0.75));
    }
    const size_t total = closed ? count + 1 : count;
    for (int pass = 0; pass < (inner > 2.0 ? 2 : 1); pass++) {
        const render_rgba color = pass == 0 ? paint->outline : paint->fill;
        for (size_t start = 0; start + 1 < total; start += chunk - 1) {
            size_t n = 0;
            for (; n < chunk && start + n < total; n++) {
                points[n] = plr_pixel(painter, world[(start + n) % count]);
            }
            // A ring of one chunk is stroked as such; its repeated point is dropped.
            const bool whole = closed && start == 0 && n == total;
            plr_stroke(painter, points, whole ? n - 1 : n, whole, pass == 0 ? width : inner, color,
                       color);
            if (!whole && width > 4.0) {
                plr_dot(painter, points[0], 0.5 * (pass == 0 ? width : inner), color);
                plr_dot(painter, points[n - 1], 0.5 * (pass == 0 ? width : inner), color);
            }
        }
    }
}

static void draw_filled(plr_painter *painter, const plr_body *body, const plr_shape *shape,
                        const plr_paint *paint, plr_group_pass pass)
{
    if (!make_contour(painter, shape)) {
        return;
    }
    const double width = plr_outline_width(painter);
    if (pass == PLR_GROUP_HATCH) {
        if (paint->hatch.a > 0) {
            hatch_contour(painter, body, paint->hatch);
        }
        return;
    }
    if (pass == PLR_GROUP_INSIDE) {
        plr_paint_inside(painter, &painter->contour, width, paint->fill);
    } else if (paint->plain) {
        plr_paint_contour(painter, &painter->contour, 0.0, paint->fill, paint->fill);
    } else if (paint->dashed) {
        plr_paint_contour(painter, &painter->contour, 0.0, paint->fill, paint->outline);
        if (width > 0.0) {
            // Lines use the scratch contour only for discs, which plr_line does not draw.
            dashed_outline(painter, width, paint->outline);
        }
    } else {
        plr_paint_contour(painter, &painter->contour, width, paint->fill, paint->outline);
    }
}

// ---- bodies

static void draw_body(plr_painter *painter, const plr_body *body)
{
    const plr_paint paint = plr_body_paint(body, painter->options.background);
    const plr_shape *shapes = painter->frame->shapes + body->first_shape;
    const bool several = body->shape_count > 1 && !paint.dashed && !paint.plain;
    const bool grouped = several && plr_group_make(painter, body);
    for (int pass = PLR_GROUP_ALL; pass <= PLR_GROUP_HATCH; pass++) {
        if (pass == PLR_GROUP_INSIDE && !several) {
            continue;
        }
        for (size_t i = 0; i < body->shape_count; i++) {
            if (shapes[i].kind != PLR_POLYLINE && !(grouped && plr_group_takes(&shapes[i]))) {
                draw_filled(painter, body, &shapes[i], &paint, (plr_group_pass)pass);
            }
        }
        if (grouped) {
            plr_group_draw(painter, body, &paint, (plr_group_pass)pass);
        }
    }
    for (size_t i = 0; i < body->shape_count; i++) {
        if (shapes[i].kind == PLR_POLYLINE) {
            draw_polyline(painter, &shapes[i], &paint);
        } else {
            draw_spoke(painter, &shapes[i], &paint);
        }
    }
}

void plr_draw_bodies(plr_painter *painter)
{
    const render_frame *frame = painter->frame;
    for (int layer = 0; layer < 4; layer++) {
        for (size_t i = 0; i < frame->body_count; i++) {
            const render_class kind = frame->bodies[i].kind;
            const int wanted = kind == RENDER_SENSOR   ? 0
                               : kind == RENDER_STATIC ? 1
                               : kind == RENDER_FLUID  ? 3
                                                       : 2;
            if (wanted == layer) {
                draw_body(painter, &frame->bodies[i]);
            }
        }
    }
}
