// labels.c - names of bodies, placed where they can be read.
//
// A name goes inside its body if it fits, else above, right, below or left of it; the first place
// that is inside the picture and free of other names wins, and a name without a place is left
// out. Large bodies choose first, so that small neighbours give way.
// Cost: O(names^2), bounded by names_max.
#include "internal.h"

#include <math.h>
#include <stdlib.h>

enum { names_max = 256, size_px = 13 };

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
        if (is_free(painter, found, taken, count)) {
            return true;
        }
    }
    return false;
}

void plr_draw_labels(plr_painter *painter)
{
    if (!plr_shows(painter, RENDER_SHOW_LABELS)) {
        return;
    }
    name names[names_max];
    place taken[names_max];
    const render_frame *frame = painter->frame;
    size_t count = 0, placed = 0;
    for (size_t i = 0; i < frame->body_count && count < names_max; i++) {
        if (frame->bodies[i].label != PLR_NO_TEXT) {
            names[count].body = &frame->bodies[i];
            measure(painter, &names[count++]);
        }
    }
    qsort(names, count, sizeof names[0], by_size);
    const int size = (int)lround(size_px * painter->ui);
    const double height = 1.15 * size;
    for (size_t i = 0; i < count; i++) {
        const char *string = plr_frame_text(frame, names[i].body->label);
        const double width = plr_text_width(painter->text, PLR_FONT_REGULAR, size, string);
        place *spot = &taken[placed];
        if (!find_place(painter, &names[i], width, height, taken, placed, spot)) {
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
