// labels.c - names of bodies, placed where they can be read.
//
// A name goes inside its body if it fits, else above, right, below or left of it; the first place
// that is inside the picture and free of other names and of other bodies wins. A name without a place
// tries smaller letters, and is left out at last. Large bodies choose first, so that small neighbours give way.
// Cost: O(names^2 + names * shapes), names bounded by names_max.
#include "internal.h"

#include <math.h>
#include <stdlib.h>

enum { names_max = 256 };

static const int sizes_px[] = { 13, 10, 8 };

static const double halo_lightness = 0.55; // share of paper in the halo on a body

typedef struct name {
    const plr_body *body;
    render_vec min, max; // of the body, pixels
} name;

typedef struct place {
    double left, top, right, bottom;
} place;

// Largest first; equal ones in the caller's order, so that the result is the same everywhere.
static int by_size(const void *a, const void *b)
{
    const name *p = a, *q = b;
    const double areas[2] = { (p->max.x - p->min.x) * (p->max.y - p->min.y),
                              (q->max.x - q->min.x) * (q->max.y - q->min.y) };
    if (areas[0] != areas[1]) {
        return areas[0] > areas[1] ? -1 : 1;
    }
    return p->body < q->body ? -1 : p->body > q->body;
}

static void measure(const plr_painter *painter, name *entry)
{
    const render_frame *frame = painter->frame;
    entry->min = (render_vec){ INFINITY, INFINITY };
    entry->max = (render_vec){ -INFINITY, -INFINITY };
    for (size_t i = 0; i < entry->body->shape_count; i++) {
        const plr_shape *shape = &frame->shapes[entry->body->first_shape + i];
        const double r = shape->radius * painter->scale;
        for (size_t k = 0; k < shape->point_count; k++) {
            const render_vec p = plr_pixel(painter, frame->points[shape->first_point + k]);
            entry->min = (render_vec){ fmin(entry->min.x, p.x - r), fmin(entry->min.y, p.y - r) };
            entry->max = (render_vec){ fmax(entry->max.x, p.x + r), fmax(entry->max.y, p.y + r) };
        }
    }
}

static bool is_free(const plr_painter *painter, const place *wanted, const place *taken,
                    size_t count)
{
    if (wanted->left < 0.0 || wanted->top < 0.0 || wanted->right > painter->width ||
        wanted->bottom > painter->height) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        if (wanted->left < taken[i].right && wanted->right > taken[i].left &&
            wanted->top < taken[i].bottom && wanted->bottom > taken[i].top) {
            return false;
        }
    }
    return true;
}

// True if the line through `a` and `b`, moved outwards by `radius`, parts the rectangle from the
// convex shape that the edge belongs to (on the side where `inner` is).
static bool edge_parts(render_vec a, render_vec b, render_vec inner, double radius,
                       const place *wanted)
{
    render_vec n = { b.y - a.y, a.x - b.x };
    const double length = hypot(n.x, n.y);
    if (!(length > 0.0)) {
        return false;
    }
    const double side = (inner.x - a.x) * n.x + (inner.y - a.y) * n.y > 0.0 ? -1.0 : 1.0;
    n = (render_vec){ side * n.x / length, side * n.y / length };
    const render_vec nearest = { n.x > 0.0 ? wanted->left : wanted->right,
                                 n.y > 0.0 ? wanted->top : wanted->bottom };
    return (nearest.x - a.x) * n.x + (nearest.y - a.y) * n.y >= radius;
}

// True if a disc, capsule or polygon reaches into the rectangle (rounded corners count as sharp).
static bool shape_meets(const plr_painter *painter, const plr_shape *shape, const place *wanted)
{
    const render_vec *world = painter->frame->points + shape->first_point;
    const double r = shape->radius * painter->scale;
    render_vec min = { INFINITY, INFINITY }, max = { -INFINITY, -INFINITY }, middle = { 0.0, 0.0 };
    for (size_t k = 0; k < shape->point_count; k++) {
        const render_vec p = plr_pixel(painter, world[k]);
        min = (render_vec){ fmin(min.x, p.x - r), fmin(min.y, p.y - r) };
        max = (render_vec){ fmax(max.x, p.x + r), fmax(max.y, p.y + r) };
        middle.x += p.x / (double)shape->point_count;
        middle.y += p.y / (double)shape->point_count;
    }
    if (min.x >= wanted->right || max.x <= wanted->left || min.y >= wanted->bottom ||
        max.y <= wanted->top) {
        return false;
    }
    for (size_t k = 0; shape->kind == PLR_POLYGON && k < shape->point_count; k++) {
        const render_vec a = plr_pixel(painter, world[k]);
        const render_vec b = plr_pixel(painter, world[(k + 1) % shape->point_count]);
        if (edge_parts(a, b, middle, r, wanted)) {
            return false;
        }
    }
    return true;
}

// True if another body than `own` is where the name would be. Lines may be written over.
static bool meets_body(const plr_painter *painter, const place *wanted, const plr_body *own)
{
    const render_frame *frame = painter->frame;
    for (size_t i = 0; i < frame->body_count; i++) {
        const plr_body *body = &frame->bodies[i];
        for (size_t k = 0; body != own && k < body->shape_count; k++) {
            const plr_shape *shape = &frame->shapes[body->first_shape + k];
            if (shape->kind != PLR_POLYLINE && shape_meets(painter, shape, wanted)) {
                return true;
            }
        }
    }
    return false;
}

// True if the body is one convex piece, whose middle is inside of it.
static bool has_middle(const plr_painter *painter, const plr_body *body)
{
    return body->shape_count == 1 && painter->frame->shapes[body->first_shape].kind != PLR_POLYLINE;
}

static bool find_place(const plr_painter *painter, const name *entry, double width, double height,
                       const place *taken, size_t count, place *found)
{
    const double gap = 3.0 * painter->ui;
    // The visible part of the body is what the name belongs to.
    const render_vec min = { fmax(entry->min.x, 0.0), fmax(entry->min.y, 0.0) };
    const render_vec max = { fmin(entry->max.x, painter->width),
                             fmin(entry->max.y, painter->height) };
    if (min.x >= max.x || min.y >= max.y) {
        return false;
    }
    const render_vec middle = { 0.5 * (min.x + max.x), 0.5 * (min.y + max.y) };
    const render_vec centers[5] = { middle,
                                    { middle.x, min.y - gap - 0.5 * height },
                                    { max.x + gap + 0.5 * width, middle.y },
                                    { middle.x, max.y + gap + 0.5 * height },
                                    { min.x - gap - 0.5 * width, middle.y } };
    const bool fits = has_middle(painter, entry->body) && width + 2.0 * gap < max.x - min.x &&
                      height < max.y - min.y;
    for (int i = fits ? 0 : 1; i < 5; i++) {
        *found = (place){ centers[i].x - 0.5 * width, centers[i].y - 0.5 * height,
                          centers[i].x + 0.5 * width, centers[i].y + 0.5 * height };
        if (is_free(painter, found, taken, count) && !meets_body(painter, found, entry->body)) {
            return true;
        }
    }
    return false;
}

// The largest letters for which there is a place; 0: there is none.
static int size_of(const plr_painter *painter, const name *entry, const char *string,
                   const place *taken, size_t count, place *found)
{
    for (size_t i = 0; i < sizeof sizes_px / sizeof *sizes_px; i++) {
        const int size = (int)lround(sizes_px[i] * painter->ui);
        const double width = plr_text_width(painter->text, PLR_FONT_REGULAR, size, string);
        if (find_place(painter, entry, width, 1.15 * size, taken, count, found)) {
            return size;
        }
    }
    return 0;
}

// Each name in turn where there is room left. Apart from who sorts them, or both lists would be in one frame.
static __attribute__((noinline)) void draw_names(plr_painter *painter, const name *names,
                                                 size_t count)
{
    place taken[names_max];
    size_t placed = 0;
    for (size_t i = 0; i < count; i++) {
        const char *string = plr_frame_text(painter->frame, names[i].body->label);
        place *spot = &taken[placed];
        const int size = size_of(painter, &names[i], string, taken, placed, spot);
        if (size == 0) {
            continue;
        }
        placed++;
        // On its body a name has a halo of a lighter shade, outside one of paper.
        const plr_paint paint = plr_body_paint(names[i].body, painter->options.background);
        const bool inside = spot->top > names[i].min.y && spot->bottom < names[i].max.y &&
                            spot->left > names[i].min.x && spot->right < names[i].max.x;
        const render_rgba paper = painter->options.background;
        const render_rgba halo =
            inside && paint.fill.a == 0xff ? plr_mix(paint.fill, paper, halo_lightness) : paper;
        const render_vec at = { spot->left, 0.5 * (spot->top + spot->bottom) + 0.36 * size };
        plr_text_draw(painter, PLR_FONT_REGULAR, size, at, string, plr_ink, halo);
    }
}

void plr_draw_labels(plr_painter *painter)
{
    if (!plr_shows(painter, RENDER_SHOW_LABELS)) {
        return;
    }
    name names[names_max];
    const render_frame *frame = painter->frame;
    size_t count = 0;
    for (size_t i = 0; i < frame->body_count && count < names_max; i++) {
        if (frame->bodies[i].label != PLR_NO_TEXT) {
            names[count].body = &frame->bodies[i];
            measure(painter, &names[count++]);
        }
    }
    qsort(names, count, sizeof names[0], by_size);
    draw_names(painter, names, count);
}
