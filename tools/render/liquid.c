// liquid.c - a liquid of particles as one body: not dots, but what they fill.
//
// Particles are summed as soft hats over a raster of points a few pixels apart; where the sum passes a level, there is
// the surface. Each point of the raster gets a colour and how much of it covers, and triangles between points
// carry both over, so the surface is smooth without being traced. Paler near the surface, which shows its shape.
//
// Liquids of several colours have one surface. Within it a point has the colours of all, weighed by the fourth power of how
// much there is of each: the border between two is soft over about a spacing, and nothing shines through it.
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
    float *sum;  // of hats: those of one colour, or all of them
    // Of several colours: sum, then r, g, b times weight, and weights, one plane behind the other.
    float *all;
} raster;

enum { PLANES = 5 };

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

static size_t size_of(const raster *r)
{
    return (size_t)r->columns * (size_t)r->rows;
}

// The colour of what is deep at a point of the raster.
static render_rgba mixed(const raster *r, size_t k, render_rgba one)
{
    const size_t n = size_of(r);
    const double weight = r->all != NULL ? (double)r->all[4 * n + k] : 0;
    if (!(weight > 0)) {
        return one;
    }
    return (render_rgba){ (unsigned char)((double)r->all[n + k] / weight),
                          (unsigned char)((double)r->all[2 * n + k] / weight),
                          (unsigned char)((double)r->all[3 * n + k] / weight), 0xff };
}

static void paint_raster(plr_painter *painter, const raster *r, double full, render_rgba deep)
{
    uint32_t last[MOST], now[MOST];
    const double least = (LEVEL - BAND / 2) * full;
    for (int j = 0; j < r->rows; j++) {
        const size_t line = (size_t)j * (size_t)r->columns;
        const float *row = r->sum + line;
        for (int i = 0; i < r->columns; i++) {
            const render_rgba color = mixed(r, line + (size_t)i, deep);
            now[i] = plr_batch_vertex(painter->batch, i * r->step, j * r->step,
                                      color_of(color, (double)row[i] / full));
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

static void add_points(const plr_painter *painter, const plr_mark *mark, const raster *r,
                       double reach)
{
    const render_vec *points = painter->frame->points + mark->first_point;
    for (size_t i = 0; i < mark->point_count; i++) {
        const render_vec at = plr_pixel(painter, points[i]);
        if (at.x > -reach && at.y > -reach && at.x < painter->width + reach &&
            at.y < painter->height + reach) {
            add_hat(r, at, reach);
        }
    }
}

// Adds the hats of one colour to those of all, and empties them.
static void fold(const raster *r, double full, render_rgba color)
{
    const size_t n = size_of(r);
    for (size_t k = 0; k < n; k++) {
        const float share = r->sum[k] / (float)full, weight = share * share * share * share;
        r->all[k] += r->sum[k];
        r->all[n + k] += weight * (float)color.r;
        r->all[2 * n + k] += weight * (float)color.g;
        r->all[3 * n + k] += weight * (float)color.b;
        r->all[4 * n + k] += weight;
        r->sum[k] = 0;
    }
}

static float *make_planes(const plr_painter *painter, size_t floats)
{
    const render_allocator *memory = &painter->batch->allocator;
    float *p = memory->resize(memory->user, NULL, 0, floats * sizeof *p);
    if (p != NULL) {
        memset(p, 0, floats * sizeof *p);
    }
    return p;
}

static void free_planes(const plr_painter *painter, float *p, size_t floats)
{
    const render_allocator *memory = &painter->batch->allocator;
    if (p != NULL) {
        memory->resize(memory->user, p, floats * sizeof *p, 0);
    }
}

static render_rgba deep_of(const plr_mark *mark)
{
    const render_rgba water = { 0x3d, 0x86, 0xc6, 0xff };
    return mark->color.a > 0 ? mark->color : water;
}

// The marks of liquids, a colour each, from the first one on: all in one raster.
static void draw_liquid(plr_painter *painter, size_t first, size_t count)
{
    const render_frame *frame = painter->frame;
    const plr_mark *one = &frame->marks[first];
    const double side = fmax(painter->width, painter->height);
    raster r = { .step = fmax(STEP * fmin(painter->ui, 1), side / (MOST - 2)) };
    r.columns = (int)(painter->width / r.step) + 2;
    r.rows = (int)(painter->height / r.step) + 2;
    const size_t n = size_of(&r);
    r.sum = make_planes(painter, n);
    float *own = r.sum;
    r.all = count > 1 ? make_planes(painter, PLANES * n) : NULL;
    if (own != NULL && (count == 1 || r.all != NULL)) {
        const double spacing = one->value * painter->scale;
        const double reach = fmax(REACH * spacing, 1.6 * r.step);
        // The integral of a hat over its disc is pi R^2 / 4.
        const double full = PLR_PI * reach * reach / 4 / (spacing * spacing);
        for (size_t i = first; i < frame->mark_count; i++) {
            if (frame->marks[i].kind == PLR_LIQUID) {
                add_points(painter, &frame->marks[i], &r, reach);
                if (count > 1) {
                    fold(&r, full, deep_of(&frame->marks[i]));
                }
            }
        }
        r.sum = count > 1 ? r.all : own;
        paint_raster(painter, &r, full, deep_of(one));
    } else {
        painter->batch->failed = true;
    }
    free_planes(painter, own, n);
    free_planes(painter, r.all, PLANES * n);
}

void plr_draw_liquids(plr_painter *painter)
{
    const render_frame *frame = painter->frame;
    const size_t count = frame->mark_kind_count[PLR_LIQUID];
    for (size_t i = 0; count > 0 && i < frame->mark_count; i++) {
        if (frame->marks[i].kind == PLR_LIQUID) {
            draw_liquid(painter, i, count);
            return;
        }
    }
}
