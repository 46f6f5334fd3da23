/// period.c - frames that wrap around: everything is drawn at each of its images in view, and the edges of the
/// period are marked.
///
/// Where the whole period is in view, what lies outside is faded: it is there a second time.
#include "internal.h"

#include <math.h>

enum { MOST_IMAGES = 9 }; ///< along an axis; a view of more periods shows those in the middle
static const double farthest = 1e6; ///< [-] periods: beyond, nothing is drawn

static const double edge_width = 1.2; ///< [px] at ui_scale 1
static const double edge_dash = 6.0;  ///< [px] at ui_scale 1
static const double fade = 0.75;      ///< [-] of the background over what lies outside

/// View along one axis, world units.
typedef struct span {
    double min, max;
} span;

static span view_x(const plr_painter *painter)
{
    const double half = 0.5 * painter->width / painter->scale;
    return (span){ painter->camera->center.x - half, painter->camera->center.x + half };
}

static span view_y(const plr_painter *painter)
{
    const double half = 0.5 * painter->height / painter->scale;
    return (span){ painter->camera->center.y - half, painter->camera->center.y + half };
}

/// The k for which [low, high] + k period is in view.
static void images_in(span view, double low, double high, double period, int *first, int *last)
{
    *first = *last = 0;
    if (period > 0.0 && low <= high) {
        const double from = ceil((view.min - high) / period);
        const double to = floor((view.max - low) / period);
        const double middle = floor(0.5 * (from + to));
        if (!(fabs(middle) <= farthest)) {
            *last = -1;
            return;
        }
        *first = (int)fmax(from, middle - MOST_IMAGES / 2);
        *last = (int)fmin(to, middle + MOST_IMAGES / 2);
    }
}

void plr_for_images(plr_painter *painter, plr_draw_fn *draw)
{
    const render_frame *frame = painter->frame;
    const render_camera *camera = painter->camera;
    if (!(frame->period.x > 0.0) && !(frame->period.y > 0.0)) {
        draw(painter);
        return;
    }
    const render_box box = render_frame_bounds(frame);
    int x0, x1, y0, y1;
    images_in(view_x(painter), box.min.x, box.max.x, frame->period.x, &x0, &x1);
    images_in(view_y(painter), box.min.y, box.max.y, frame->period.y, &y0, &y1);
    for (int ky = y0; ky <= y1; ky++) {
        for (int kx = x0; kx <= x1; kx++) {
            render_camera shifted = *camera;
            shifted.center.x -= kx * frame->period.x;
            shifted.center.y -= ky * frame->period.y;
            painter->camera = &shifted;
            draw(painter);
            painter->camera = camera;
        }
    }
}

/// A plain quad in pixels.
static void cover(plr_painter *painter, double x0, double y0, double x1, double y1)
{
    if (x1 > x0 && y1 > y0) {
        const render_rgba color = plr_fade(painter->options.background, fade);
        plr_batch *batch = painter->batch;
        const uint32_t a = plr_batch_vertex(batch, x0, y0, color);
        const uint32_t b = plr_batch_vertex(batch, x1, y0, color);
        const uint32_t c = plr_batch_vertex(batch, x1, y1, color);
        const uint32_t d = plr_batch_vertex(batch, x0, y1, color);
        plr_batch_quad(batch, a, b, c, d);
    }
}

static void draw_edge(plr_painter *painter, render_vec a, render_vec b)
{
    const render_vec points[2] = { a, b };
    const double dash = edge_dash * painter->ui;
    plr_dashes(painter, points, 2, false, edge_width * painter->ui, dash, dash,
               plr_fade(plr_ink, 0.45));
}

void plr_draw_period(plr_painter *painter)
{
    const render_vec period = painter->frame->period;
    const bool wraps_x = period.x > 0.0, wraps_y = period.y > 0.0;
    const render_vec a = plr_pixel(painter, (render_vec){ -0.5 * period.x, -0.5 * period.y });
    const render_vec b = plr_pixel(painter, (render_vec){ 0.5 * period.x, 0.5 * period.y });
    const double x0 = wraps_x ? fmin(a.x, b.x) : 0.0;
    const double x1 = wraps_x ? fmax(a.x, b.x) : painter->width;
    const double y0 = wraps_y ? fmin(a.y, b.y) : 0.0;
    const double y1 = wraps_y ? fmax(a.y, b.y) : painter->height;
    if ((!wraps_x && !wraps_y) || !plr_shows(painter, RENDER_SHOW_GRID)) {
        return;
    }
    if (x0 >= 0.0 && x1 <= painter->width && y0 >= 0.0 && y1 <= painter->height) {
        cover(painter, 0.0, 0.0, x0, painter->height);
        cover(painter, x1, 0.0, painter->width, painter->height);
        cover(painter, x0, 0.0, x1, y0);
        cover(painter, x0, y1, x1, painter->height);
    }
    // Dashes of lines far out of view would be without number.
    const double top = fmax(y0, 0.0), bottom = fmin(y1, painter->height);
    const double left = fmax(x0, 0.0), right = fmin(x1, painter->width);
    for (int end = 0; end < 2; end++) {
        const double x = end == 0 ? x0 : x1, y = end == 0 ? y0 : y1;
        if (wraps_x && x >= 0.0 && x <= painter->width && top < bottom) {
            draw_edge(painter, (render_vec){ x, top }, (render_vec){ x, bottom });
        }
        if (wraps_y && y >= 0.0 && y <= painter->height && left < right) {
            draw_edge(painter, (render_vec){ left, y }, (render_vec){ right, y });
        }
    }
}
