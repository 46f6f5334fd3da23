// hud.c - what frames the picture: grid, scale bar, title, caption, legend.
//
// The grid and the scale bar follow the camera at round distances (1, 2 or 5 times a power of
// ten). The legend lists the overlays that are both switched on and present.
// Cost: O(grid lines + text).
#include "internal.h"

#include <math.h>
#include <stdio.h>

// Sizes in pixels at ui_scale 1, chosen by eye on the sample scenes.
static const double grid_distance = 45.0; // between grid lines, at least
static const double bar_length = 130.0;   // of the scale bar, at most
static const double margin = 16.0;
enum { title_size = 17, small_size = 12, legend_rows_max = 24 };

static const double minor_strength = 0.055; // of ink over the background
static const double major_strength = 0.10;
static const double axis_strength = 0.20;

double plr_round_step(double x)
{
    const double power = pow(10.0, floor(log10(x)));
    const double lead = x / power * (1.0 + 1e-12); // forgives rounding just below a step
    return power * (lead >= 5.0 ? 5.0 : lead >= 2.0 ? 2.0 : 1.0);
}

// ---- grid

static void grid_lines(plr_painter *painter, bool vertical)
{
    const render_camera *camera = painter->camera;
    const double pixels = vertical ? painter->width : painter->height;
    const double middle = vertical ? camera->center.x : camera->center.y;
    const double least = grid_distance * painter->ui / painter->scale;
    const double step = plr_round_step(least * 2.5); // a step is at least 0.4 of its bound
    const double half = 0.5 * pixels / painter->scale;
    const double first = ceil((middle - half) / step), last = floor((middle + half) / step);
    if (fabs(first) > 1e12 || fabs(last) > 1e12) {
        return; // so far out that lines can no longer be counted exactly
    }
    for (double k = first; k <= last; k += 1.0) {
        const render_vec world = { vertical ? k * step : middle, vertical ? middle : k * step };
        const render_vec p = plr_pixel(painter, world);
        const double strength = k == 0.0              ? axis_strength
                                : fmod(k, 5.0) == 0.0 ? major_strength
                                                      : minor_strength;
        const double at = floor(vertical ? p.x : p.y) + 0.5; // on a pixel row: crisp
        const render_vec a = { vertical ? at : -1.0, vertical ? -1.0 : at };
        const render_vec b = { vertical ? at : painter->width + 1.0,
                               vertical ? painter->height + 1.0 : at };
        plr_line(painter, a, b, 1.0, plr_fade(plr_ink, strength));
    }
}

void plr_draw_grid(plr_painter *painter)
{
    if (plr_shows(painter, RENDER_SHOW_GRID)) {
        grid_lines(painter, true);
        grid_lines(painter, false);
    }
}

// ---- corners

static int text_size(const plr_painter *painter, int size)
{
    return (int)lround(size * painter->ui);
}

static void draw_title(plr_painter *painter)
{
    const render_frame *frame = painter->frame;
    const char *title = plr_frame_text(frame, frame->title);
    const char *caption = plr_frame_text(frame, frame->caption);
    const double ui = painter->ui;
    double y = (margin - 3.0) * ui;
    if (title != NULL) {
        y += title_size * ui;
        plr_text_draw(painter, PLR_FONT_BOLD, text_size(painter, title_size),
                      (render_vec){ margin * ui, y }, title, plr_ink, painter->options.background);
        y += 5.0 * ui;
    }
    if (caption != NULL) {
        y += small_size * ui;
        const render_rgba color = plr_mix(plr_ink, painter->options.background, 0.2);
        plr_text_draw(painter, PLR_FONT_REGULAR, text_size(painter, small_size),
                      (render_vec){ margin * ui, y }, caption, color, painter->options.background);
    }
}

static void draw_scale(plr_painter *painter)
{
    const double ui = painter->ui;
    const double length = plr_round_step(bar_length * ui / painter->scale);
    const double pixels = length * painter->scale;
    const double y = painter->height - margin * ui;
    const render_vec a = { margin * ui, y }, b = { margin * ui + pixels, y };
    const render_vec bar[4] = { { a.x, y - 5.0 * ui }, a, b, { b.x, y - 5.0 * ui } };
    const render_rgba halo = painter->options.background;
    plr_stroke(painter, bar, 4, false, 4.0 * ui, halo, halo);
    plr_stroke(painter, bar, 4, false, 1.6 * ui, plr_ink, plr_ink);
    char label[64];
    snprintf(label, sizeof label, "%g %s", length, painter->options.unit);
    const int size = text_size(painter, small_size);
    const double width = plr_text_width(painter->text, PLR_FONT_REGULAR, size, label);
    const double left = fmax(0.5 * (a.x + b.x - width), a.x);
    plr_text_draw(painter, PLR_FONT_REGULAR, size, (render_vec){ left, y - 7.0 * ui }, label,
                  plr_ink, halo);
}

// ---- legend

typedef struct legend_row {
    plr_mark_kind kind;
    const render_joint *joint; // not null: a row for joints like this
    char text[64];
} legend_row;

// Adds a row for each kind of joint that is there; those with a motor are a kind of their own.
static int joint_rows(const plr_painter *painter, legend_row *rows, int count)
{
    const render_frame *frame = painter->frame;
    bool seen[RENDER_JOINT_KINDS][2] = { { false } };
    if (!plr_shows(painter, RENDER_SHOW_JOINTS)) {
        return count;
    }
    for (size_t i = 0; i < frame->joint_count && count < legend_rows_max; i++) {
        const render_joint *j = &frame->joints[i];
        const bool driven = j->drive != 0.0 && j->kind != RENDER_JOINT_RATCHET;
        if (!seen[j->kind][driven]) {
            seen[j->kind][driven] = true;
            rows[count].joint = j;
            snprintf(rows[count].text, sizeof rows[count].text, "%s%s", plr_joint_name(j->kind),
                     driven ? " with motor" : "");
            count++;
        }
    }
    return count;
}

// Fills the rows; returns how many.
static int legend_rows(const plr_painter *painter, legend_row *rows)
{
    static const struct {
        unsigned flag;
        plr_mark_kind kind;
        const char *name;
        const char *quantity; // unit of an arrow
    } entries[] = {
        { RENDER_SHOW_CONTACTS, PLR_CONTACT, "contact and normal", NULL },
        { RENDER_SHOW_IMPULSES, PLR_IMPULSE, "impulse", "N s" },
        { RENDER_SHOW_VELOCITIES, PLR_VELOCITY, "velocity", "m/s" },
        { RENDER_SHOW_SURFACES, PLR_SURFACE, "running surface", NULL },
        { RENDER_SHOW_DIPOLES, PLR_DIPOLE, "dipole, red: its north pole", NULL },
        { RENDER_SHOW_FIELD, PLR_FIELD, "field", NULL },
        { RENDER_SHOW_FLOW, PLR_FLOW, "flow", NULL },
        { RENDER_SHOW_TRAILS, PLR_TRAIL, "trail", NULL },
        { RENDER_SHOW_AABBS, PLR_AABB, "bounding box", NULL },
        { RENDER_SHOW_CELLS, PLR_CELL, "grid cell in use", NULL },
    };
    int count = 0;
    for (size_t i = 0; i < sizeof entries / sizeof entries[0] && count < legend_rows_max; i++) {
        const plr_mark_kind kind = entries[i].kind;
        if (!plr_shows(painter, entries[i].flag) || painter->frame->mark_kind_count[kind] == 0) {
            continue;
        }
        legend_row *row = &rows[count++];
        row->kind = kind;
        row->joint = NULL;
        if (kind == PLR_FIELD || kind == PLR_FLOW) {
            double most = 0.0;
            for (size_t k = 0; k < painter->frame->mark_count; k++) {
                const plr_mark *mark = &painter->frame->marks[k];
                most = mark->kind == kind ? fmax(most, mark->value) : most;
            }
            snprintf(row->text, sizeof row->text, "%s, up to %.3g %s", entries[i].name, most,
                     kind == PLR_FIELD ? "m/s²" : "m/s");
        } else if (entries[i].quantity != NULL) {
            snprintf(row->text, sizeof row->text, "%s: 1 %s = %g %s", entries[i].name,
                     entries[i].quantity, plr_arrow_scale(painter, kind), painter->options.unit);
        } else {
            snprintf(row->text, sizeof row->text, "%s", entries[i].name);
        }
    }
    return joint_rows(painter, rows, count);
}

// True if less of the bodies lies behind a legend in the lower right corner than in the upper.
static bool lower_is_free(const plr_painter *painter, render_vec min, render_vec max)
{
    const render_frame *frame = painter->frame;
    const double down = painter->height - max.y - min.y; // how far the legend would move
    size_t upper = 0, lower = 0;
    for (size_t i = 0; i < frame->shape_count; i++) {
        const plr_shape *shape = &frame->shapes[i];
        const double r = shape->radius * painter->scale;
        render_vec low = { INFINITY, INFINITY }, high = { -INFINITY, -INFINITY };
        for (size_t k = 0; k < shape->point_count; k++) {
            const render_vec p = plr_pixel(painter, frame->points[shape->first_point + k]);
            low = (render_vec){ fmin(low.x, p.x - r), fmin(low.y, p.y - r) };
            high = (render_vec){ fmax(high.x, p.x + r), fmax(high.y, p.y + r) };
        }
        if (high.x < min.x || low.x > max.x) {
            continue;
        }
        upper += low.y < max.y && high.y > min.y ? 1 : 0;
        lower += low.y < max.y + down && high.y > min.y + down ? 1 : 0;
    }
    return lower < upper;
}

static void draw_legend(plr_painter *painter)
{
    legend_row rows[legend_rows_max];
    const int count = legend_rows(painter, rows);
    if (count == 0) {
        return;
    }
    const double ui = painter->ui, sample = 24.0 * ui, pad = 10.0 * ui, line = 20.0 * ui;
    const int size = text_size(painter, small_size);
    double width = 0.0;
    for (int i = 0; i < count; i++) {
        width = fmax(width, plr_text_width(painter->text, PLR_FONT_REGULAR, size, rows[i].text));
    }
    render_vec max = { floor(painter->width - margin * ui),
                       floor(margin * ui + 1.2 * pad + count * line) };
    render_vec min = { floor(max.x - width - sample - 3.0 * pad), floor(margin * ui) };
    const render_legend_at at = painter->options.legend_at;
    if (at == RENDER_LEGEND_LOWER ||
        (at == RENDER_LEGEND_AUTO && lower_is_free(painter, min, max))) {
        const double down = painter->height - max.y - min.y;
        min.y += down;
        max.y += down;
    }
    const render_rgba paper =
        plr_mix(painter->options.background, (render_rgba){ 0xff, 0xff, 0xff, 0xff }, 0.6);
    plr_panel(painter, min, max, 5.0 * ui, plr_fade(paper, 0.9),
              plr_mix(plr_ink, painter->options.background, 0.72));
    for (int i = 0; i < count; i++) {
        const double y = min.y + 0.6 * pad + (i + 0.5) * line;
        const render_vec middle = { min.x + pad + 0.5 * sample, y };
        if (rows[i].joint != NULL) {
            plr_joint_sample(painter, rows[i].joint, middle, sample);
        } else {
            plr_overlay_sample(painter, rows[i].kind, middle, sample);
        }
        plr_text_draw(painter, PLR_FONT_REGULAR, size,
                      (render_vec){ min.x + 2.0 * pad + sample, y + 0.36 * size }, rows[i].text,
                      plr_ink, (render_rgba){ 0 });
    }
}

void plr_draw_hud(plr_painter *painter)
{
    if (plr_shows(painter, RENDER_SHOW_SCALE)) {
        draw_scale(painter);
    }
    if (plr_shows(painter, RENDER_SHOW_TITLE)) {
        draw_title(painter);
    }
    if (plr_shows(painter, RENDER_SHOW_LEGEND)) {
        draw_legend(painter);
    }
}
