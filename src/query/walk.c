// walk.c - the cells along a segment, row by row.
//
// A box is filed under its lower corner and is no larger than a cell c. What is filed in row j
// therefore covers y from j c to (j + 2) c and nothing else: the piece of the segment in that band
// has an x range, and that range, begun one cell earlier, is the part of the row to look at. Rows
// are taken in the direction of the segment and so are blocks of cells in a row, which lets a hit
// end the walk early.
//
// Reads: grid. Writes: nothing. Cost: see walk.h.
#include "query/walk.h"

#include "query/query.h"

#include <math.h>

// Cells of a row that are looked up at once. Less than the fewest buckets of a level (16).
#define BLOCK 8

// grid.c files everything beyond 2^30 cells from the origin in the outermost cells, whose bands
// have no outer end; a walk that comes so far goes through the whole level.
#define FAR_CELLS 1e9

pl_walk pl_walk_make(plumb_vec2 from, plumb_vec2 to)
{
    pl_walk walk = { .ox = (double)from.x,
                     .oy = (double)from.y,
                     .dx = (double)to.x - (double)from.x,
                     .dy = (double)to.y - (double)from.y,
                     .limit = 1 };
    walk.slack = pl_query_slack(fabs(walk.ox) + fabs(walk.oy) + fabs(walk.dx) + fabs(walk.dy));
    return walk;
}

pl_walk pl_walk_make_box(plumb_aabb box, plumb_vec2 translation)
{
    pl_walk walk = { .ox = ((double)box.min.x + (double)box.max.x) / 2,
                     .oy = ((double)box.min.y + (double)box.max.y) / 2,
                     .dx = (double)translation.x,
                     .dy = (double)translation.y,
                     .limit = 1,
                     .half_x = ((double)box.max.x - (double)box.min.x) / 2,
                     .half_y = ((double)box.max.y - (double)box.min.y) / 2 };
    walk.slack = pl_query_slack(fabs(walk.ox) + fabs(walk.oy) + fabs(walk.dx) + fabs(walk.dy) +
                                walk.half_x + walk.half_y);
    return walk;
}

// [m] by how much boxes count as larger.
static double slack_x(const pl_walk *w)
{
    return w->slack + w->half_x;
}

static double slack_y(const pl_walk *w)
{
    return w->slack + w->half_y;
}

// True when the segment meets the box before the limit: neither the axes nor the segment's normal
// separate them.
static bool meets(const pl_walk *w, const pl_box *box)
{
    double ex = w->ox + w->dx * w->limit;
    double ey = w->oy + w->dy * w->limit;
    double hx = ((double)box->max_x - (double)box->min_x) / 2 + slack_x(w);
    double hy = ((double)box->max_y - (double)box->min_y) / 2 + slack_y(w);
    double cx = ((double)box->max_x + (double)box->min_x) / 2;
    double cy = ((double)box->max_y + (double)box->min_y) / 2;
    return pl_least(w->ox, ex) <= cx + hx && cx - hx <= pl_most(w->ox, ex) &&
           pl_least(w->oy, ey) <= cy + hy && cy - hy <= pl_most(w->oy, ey) &&
           fabs(w->dx * (cy - w->oy) - w->dy * (cx - w->ox)) <= fabs(w->dx) * hy + fabs(w->dy) * hx;
}

// Box around the segment between two fractions, rounded outwards.
static pl_box box_between(const pl_walk *w, double t0, double t1)
{
    double x0 = w->ox + w->dx * t0, x1 = w->ox + w->dx * t1;
    double y0 = w->oy + w->dy * t0, y1 = w->oy + w->dy * t1;
    return (pl_box){ (plumb_real)(pl_least(x0, x1) - slack_x(w)),
                     (plumb_real)(pl_least(y0, y1) - slack_y(w)),
                     (plumb_real)(pl_most(x0, x1) + slack_x(w)),
                     (plumb_real)(pl_most(y0, y1) + slack_y(w)) };
}

pl_box pl_walk_box(const pl_walk *walk)
{
    return box_between(walk, 0, walk->limit);
}

// Where on the segment `along` o + t d enters and leaves [low, high], clamped to 0..limit. False
// when that is beyond the limit.
static bool clip(double o, double d, double low, double high, double limit, double t[2])
{
    t[0] = 0;
    t[1] = limit;
    if (d != 0) {
        double a = (low - o) / d;
        double b = (high - o) / d;
        t[0] = pl_least(pl_most(pl_least(a, b), 0), limit);
        t[1] = pl_least(pl_most(pl_most(a, b), 0), limit);
        return pl_least(a, b) <= limit;
    }
    return true;
}

// Levels whose buckets are a plain matrix of cells have an end: nothing is filed beyond.
static pl_cell_range clip_to_level(const pl_grid_level *level, pl_cell_range range)
{
    uint32_t buckets = level->mask + 1;
    if (level->stride > buckets) {
        return range; // rows are scattered: the level may be of any extent
    }
    int32_t last_x = level->origin_x + (int32_t)level->stride - 1;
    int32_t last_y = level->origin_y + (int32_t)(buckets / level->stride) - 1;
    range.x0 = range.x0 > level->origin_x ? range.x0 : level->origin_x;
    range.y0 = range.y0 > level->origin_y ? range.y0 : level->origin_y;
    range.x1 = range.x1 < last_x ? range.x1 : last_x;
    range.y1 = range.y1 < last_y ? range.y1 : last_y;
    return range;
}

static bool visit_all(const pl_grid *grid, const pl_grid_level *level, const pl_walk *walk,
                      pl_grid_visit *visit, void *context)
{
    const pl_grid_entry *e = pl_grid_entries(grid) + level->first;
    for (const pl_grid_entry *end = e + level->count; e < end; ++e) {
        if (meets(walk, &e->box) && !visit(context, e)) {
            return false;
        }
    }
    return true;
}

static bool visit_block(const pl_grid *grid, const pl_grid_level *level, int32_t x0, int32_t x1,
                        int32_t y, const pl_walk *walk, pl_grid_visit *visit, void *context)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    pl_grid_run runs[2];
    int run_count = pl_grid_row(grid, level, x0, x1, y, runs);
    uint32_t width = (uint32_t)(x1 - x0);
    for (int r = 0; r < run_count; ++r) {
        for (uint32_t i = runs[r].begin; i < runs[r].end; ++i) {
            const pl_grid_entry *e = &entries[i];
            if (e->cell_y == y && (uint32_t)e->cell_x - (uint32_t)x0 <= width &&
                meets(walk, &e->box) && !visit(context, e)) {
                return false;
            }
        }
    }
    return true;
}

// The cells of row y along the segment, block by block in its direction.
static bool walk_row(const pl_grid *grid, const pl_grid_level *level, pl_cell_range range,
                     const pl_walk *walk, pl_grid_visit *visit, void *context)
{
    int32_t y = range.y0;
    for (int64_t k = 0; k <= (int64_t)range.x1 - range.x0; k += BLOCK) {
        int64_t rest = (int64_t)range.x1 - range.x0 - k;
        int32_t length = rest < BLOCK - 1 ? (int32_t)rest : BLOCK - 1;
        bool right = walk->dx >= 0;
        int32_t x0 = right ? (int32_t)(range.x0 + k) : (int32_t)(range.x1 - k - length);
        int32_t x1 = x0 + length;
        double t[2];
        if (!clip(walk->ox, walk->dx, (double)x0 * level->cell - slack_x(walk),
                  ((double)x1 + 2) * level->cell + slack_x(walk), walk->limit, t)) {
            break;
        }
        if (!visit_block(grid, level, x0, x1, y, walk, visit, context)) {
            return false;
        }
    }
    return true;
}

bool pl_walk_level(const pl_grid *grid, const pl_grid_level *level, pl_walk *walk,
                   pl_grid_visit *visit, void *context)
{
    pl_cell_range whole =
        clip_to_level(level, pl_grid_range(level, box_between(walk, 0, walk->limit)));
    double rows = (double)whole.y1 - whole.y0 + 1;
    // Each row has the width of what is moved; the way adds its columns once.
    double wide = pl_least((double)whole.x1 - whole.x0 + 1, 2 * slack_x(walk) * level->inv_cell);
    double blocks = ((double)whole.x1 - whole.x0 + 1 + rows * wide) / BLOCK;
    double farthest = pl_most(pl_most(fabs(walk->ox), fabs(walk->ox + walk->dx)),
                              pl_most(fabs(walk->oy), fabs(walk->oy + walk->dy)));
    if ((farthest + walk->slack + walk->half_x + walk->half_y) * level->inv_cell > FAR_CELLS ||
        rows + blocks > (double)level->count + 16) {
        return visit_all(grid, level, walk, visit, context);
    }
    bool up = walk->dy >= 0;
    for (int32_t k = 0; k <= whole.y1 - whole.y0; ++k) {
        int32_t y = up ? whole.y0 + k : whole.y1 - k;
        double t[2];
        if (!clip(walk->oy, walk->dy, (double)y * level->cell - slack_y(walk),
                  ((double)y + 2) * level->cell + slack_y(walk), walk->limit, t)) {
            break;
        }
        pl_cell_range row = pl_grid_range(level, box_between(walk, t[0], t[1]));
        row.y0 = row.y1 = y;
        row = clip_to_level(level, row);
        if (!walk_row(grid, level, row, walk, visit, context)) {
            return false;
        }
    }
    return true;
}

bool pl_walk_grid(const pl_grid *grid, pl_walk *walk, pl_grid_visit *visit, void *context)
{
    for (uint32_t k = 0; k < grid->level_count; ++k) {
        if (!pl_walk_level(grid, &grid->levels[k], walk, visit, context)) {
            return false;
        }
    }
    return true;
}
