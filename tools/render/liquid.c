// liquid.c - a liquid of particles as one body: not dots, but what they fill.
//
// Particles are summed as soft hats over a raster of points a few pixels apart; where the sum passes a level, there is
// the surface. Each point of the raster gets a colour and how much of it covers, and triangles between points
// carry both over, so the surface is smooth without being traced. Paler near the surface, which shows its shape.
#include "internal.h"

#include <math.h>
#include <string.h>

#define STEP    2.0  // [px] between points of the raster, times ui scale
#define MOST    1000 // points along a side
#define REACH   3.6  // of a hat, spacings
#define LEVEL   0.34 // of the sum in the midst of the liquid: where its surface is
#define BAND    0.08 // of that sum over which it becomes opaque
#define OPACITY 0.86

typedef struct raster {
    int columns, rows;
    double step; // [px]
    float *sum;
} raster;

static void add_hat(const raster *r, render_vec at, double reach)
{
    const int low_x = (int)fmax(ceil((at.x - reach) / r->step), 0);
    const int low_y = (int)fmax(ceil((at.y - reach) / r->step), 0);
    const int high_x = (int)fmin(floor((at.x + reach) / r->step), r->columns - 1);
    const int high_y = (int)fmin(floor((at.y + reach) / r->step), r->rows - 1);
    for (int j = low_y; j <= high_y; j++) {
        for (int i = low_x; i <= high_x; i++) {
            const double dx = i * r->step - at.x, dy = j * r->step - at.y;
            const double t = 1 - (dx * dx + dy * dy) / (reach * reach);
            r->sum[j * r->columns + i] += t > 0 ? (float)(t * t * t) : 0;
        }
    }
}

static double smooth(double low, double high, double v)
{
    const double t = fmin(fmax((v - low) / (high - low), 0), 1);
    return t * t * (3 - 2 * t);
}

// Of a point with a share of the full sum.
static render_rgba color_of(render_rgba deep, double share)
{
    const render_rgba foam = { 0xf4, 0xfa, 0xfd, 0xff };
    const render_rgba pale = plr_mix(deep, foam, 0.5);
    const render_rgba body = plr_mix(pale, deep, smooth(LEVEL, 0.50, share));
    return plr_fade(body, OPACITY * smooth(LEVEL - BAND / 2, LEVEL + BAND / 2, share));
}

static void paint_raster(plr_painter *painter, const raster *r, double full, render_rgba deep)
{
    uint32_t last[MOST], now[MOST];
    const double least = (LEVEL - BAND / 2) * full;
    for (int j = 0; j < r->rows; j++) {
        const float *row = r->sum + j * r->columns;
        for (int i = 0; i < r->columns; i++) {
            now[i] = plr_batch_vertex(painter->batch, i * r->step, j * r->step,
                                      color_of(deep, (double)row[i] / full));
        }
        for (int i = 1; j > 0 && i < r->columns; i++) {
            const float *above = row - r->columns;
            const double most = fmax(fmax((double)row[i], (double)row[i - 1]),
                                     fmax((double)above[i], (double)above[i - 1]));
            if (most > least) {
                plr_batch_quad(painter->batch, last[i - 1], last[i], now[i], now[i - 1]);
            }
        }
        memcpy(last, now, (size_t)r->columns * sizeof *now);
    }
}

static void draw_liquid(plr_painter *painter, const plr_mark *mark)
{
    const render_rgba water = { 0x3d, 0x86, 0xc6, 0xff };
    const render_allocator *memory = &painter->batch->allocator;
    const double side = fmax(painter->width, painter->height);
    raster r = { .step = fmax(STEP * fmin(painter->ui, 1), side / (MOST - 2)) };
    r.columns = (int)(painter->width / r.step) + 2;
    r.rows = (int)(painter->height / r.step) + 2;
    const size_t bytes = (size_t)r.columns * (size_t)r.rows * sizeof *r.sum;
    r.sum = memory->resize(memory->user, NULL, 0, bytes);
    if (r.sum == NULL) {
        painter->batch->failed = true;
        return;
    }
    memset(r.sum, 0, bytes);
    const double spacing = mark->value * painter->scale;
    const double reach = fmax(REACH * spacing, 1.6 * r.step);
    const render_vec *points = painter->frame->points + mark->first_point;
    for (size_t i = 0; i < mark->point_count; i++) {
        const render_vec at = plr_pixel(painter, points[i]);
        if (at.x > -reach && at.y > -reach && at.x < painter->width + reach &&
            at.y < painter->height + reach) {
            add_hat(&r, at, reach);
        }
    }
    // The integral of a hat over its disc is pi R^2 / 4.
    const double full = PLR_PI * reach * reach / 4 / (spacing * spacing);
    paint_raster(painter, &r, full, mark->color.a > 0 ? mark->color : water);
    memory->resize(memory->user, r.sum, bytes, 0);
}

void plr_draw_liquids(plr_painter *painter)
{
    const render_frame *frame = painter->frame;
    for (size_t i = 0; frame->mark_kind_count[PLR_LIQUID] > 0 && i < frame->mark_count; i++) {
        if (frame->marks[i].kind == PLR_LIQUID) {
            draw_liquid(painter, &frame->marks[i]);
        }
    }
}
