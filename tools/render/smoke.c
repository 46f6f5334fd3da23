// smoke.c - smoke and heat in cells as a soft veil.
//
// Between cells values are those of a quadratic B-spline, whose slopes have no corners, so that no cell is to be seen. A
// raster of points a few pixels apart gets colour and cover, and triangles between points carry both over. Smoke
// lets through 2^-smoke of what is behind it; what is hot glows, the hotter the paler.
#include "internal.h"

#include <math.h>
#include <string.h>

#define STEP     3.0  // [px] between points of the raster, times ui scale
#define MOST     1000 // points along a side
#define THICKEST 0.88 // of what is behind it smoke hides so much at the most

typedef struct cells {
    const render_vec *at;
    int columns, rows;
} cells;

static render_vec value_at(const cells *c, int i, int j)
{
    i = i < 0 ? 0 : i < c->columns ? i : c->columns - 1;
    j = j < 0 ? 0 : j < c->rows ? j : c->rows - 1;
    return c->at[(size_t)j * (size_t)c->columns + (size_t)i];
}

// At (x, y) in cells from the middle of the first.
static render_vec smooth_at(const cells *c, double x, double y)
{
    const int i = (int)floor(x + 0.5), j = (int)floor(y + 0.5);
    const double fx = x - i, fy = y - j; // -0.5..0.5
    const double wx[3] = { 0.5 * (0.5 - fx) * (0.5 - fx), 0.75 - fx * fx,
                           0.5 * (0.5 + fx) * (0.5 + fx) };
    const double wy[3] = { 0.5 * (0.5 - fy) * (0.5 - fy), 0.75 - fy * fy,
                           0.5 * (0.5 + fy) * (0.5 + fy) };
    render_vec sum = { 0, 0 };
    for (int b = 0; b < 3; b++) {
        for (int a = 0; a < 3; a++) {
            const render_vec v = value_at(c, i + a - 1, j + b - 1);
            sum.x += wx[a] * wy[b] * v.x;
            sum.y += wx[a] * wy[b] * v.y;
        }
    }
    return sum;
}

// Smoke before what glows.
static render_rgba color_of(render_rgba smoke, render_vec value)
{
    const render_rgba ember = { 0xf0, 0x7c, 0x22, 0xff }, flame = { 0xff, 0xdc, 0x7a, 0xff };
    const double veil = THICKEST * (1 - exp2(-fmax(value.x, 0)));
    const double heat = fmax(value.y, 0), glow = 0.9 * (1 - exp2(-1.5 * heat * heat));
    const double cover = veil + (1 - veil) * glow;
    const render_rgba hot = plr_mix(ember, flame, fmin(heat / 2.0, 1));
    const double share = cover > 0 ? (1 - veil) * glow / cover : 0;
    return plr_fade(plr_mix(smoke, hot, share), cover);
}

static void draw_smoke(plr_painter *painter, const plr_mark *mark)
{
    const render_rgba grey = { 0x5a, 0x63, 0x70, 0xff };
    const render_rgba color = mark->color.a > 0 ? mark->color : grey;
    const cells c = { painter->frame->points + mark->first_point, mark->variant,
                      (int)(mark->point_count / (size_t)mark->variant) };
    const double scale = painter->scale * mark->value; // [px] a cell
    const double up = painter->camera->y_down ? 1 : -1;
    const render_vec corner = plr_pixel(painter, mark->a);
    const double width = c.columns * scale, height = c.rows * scale;
    const double top = up < 0 ? corner.y - height : corner.y;
    const double x0 = fmax(corner.x, 0), x1 = fmin(corner.x + width, painter->width);
    const double y0 = fmax(top, 0), y1 = fmin(top + height, painter->height);
    if (!(x0 < x1 && y0 < y1)) {
        return;
    }
    const double step = fmax(STEP * fmin(painter->ui, 1), fmax(x1 - x0, y1 - y0) / (MOST - 2));
    const int columns = (int)ceil((x1 - x0) / step) + 1, rows = (int)ceil((y1 - y0) / step) + 1;
    uint32_t last[MOST], now[MOST];
    bool was[MOST] = { false }, is[MOST];
    for (int j = 0; j < rows; j++) {
        const double y = fmin(y0 + j * step, y1);
        for (int i = 0; i < columns; i++) {
            const double x = fmin(x0 + i * step, x1);
            const render_vec value =
                smooth_at(&c, (x - corner.x) / scale - 0.5, up * (y - corner.y) / scale - 0.5);
            const render_rgba shade = color_of(color, value);
            is[i] = shade.a > 0;
            now[i] = plr_batch_vertex(painter->batch, x, y, shade);
        }
        for (int i = 1; j > 0 && i < columns; i++) {
            if (is[i] || is[i - 1] || was[i] || was[i - 1]) {
                plr_batch_quad(painter->batch, last[i - 1], last[i], now[i], now[i - 1]);
            }
        }
        memcpy(last, now, (size_t)columns * sizeof *now);
        memcpy(was, is, (size_t)columns * sizeof *is);
    }
}

void plr_draw_smoke(plr_painter *painter)
{
    const render_frame *frame = painter->frame;
    for (size_t i = 0; frame->mark_kind_count[PLR_SMOKE] > 0 && i < frame->mark_count; i++) {
        if (frame->marks[i].kind == PLR_SMOKE) {
            draw_smoke(painter, &frame->marks[i]);
        }
    }
}
