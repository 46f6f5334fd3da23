// nearest.c - the shape nearest to a point, all shapes near it, the nearest to each of many points.
//
// Each level of the grid is searched in squares about the point, each twice as large as the one
// before, until the square holds all that can be nearer than the nearest so far. When a square has
// more cells than the level has boxes, all boxes are looked at, once.
//
// Inside an outline the surface is the outline's and not that of the convex piece that the point is
// in: edges that are inner cuts do not count.
//
// Reads: grids, pieces, poses. Writes: the answer. Cost: cells and boxes nearer than the answer.
#include "broad/images.h"
#include "query/query.h"
#include "query/walk.h"
#include "world/check.h"

#include <math.h>
#include <stdio.h>

typedef struct search {
    pl_query q;
    plumb_vec2 point;        // an image of the one that is asked about
    pl_shift back;           // [m] from that image to the point
    double slack;            // [m]
    plumb_real max_distance; // [m]
    bool met;
    plumb_nearest_hit best;
    uint32_t best_piece; // of its shape
    double done;         // [m] half of the last square: what overlaps it was looked at
} search;

// [m] nothing farther than this can be nearer than the best.
static double bound_of(const search *s)
{
    double bound = (double)(s->met ? s->best.distance : s->max_distance);
    return pl_most(bound, 0) + s->slack;
}

// How far a box is away along the axes, 0 on those where it spans the point. [m]
static void box_distance(const search *s, const pl_box *box, double *dx, double *dy)
{
    double x = (double)s->point.x;
    double y = (double)s->point.y;
    *dx = pl_most(pl_most((double)box->min_x - x, x - (double)box->max_x), 0);
    *dy = pl_most(pl_most((double)box->min_y - y, y - (double)box->max_y), 0);
}

static plumb_convex_near nearest_on_edge(const plumb_convex *convex, int k, plumb_vec2 local)
{
    plumb_vec2 a = convex->points[k];
    plumb_vec2 b = convex->points[k + 1 == convex->count ? 0 : k + 1];
    plumb_vec2 along = plumb_vec2_sub(b, a);
    plumb_real t = plumb_vec2_dot(plumb_vec2_sub(local, a), along) / plumb_vec2_magnitude_sq(along);
    plumb_convex_near near = { .point = plumb_vec2_lerp(a, b, plumb_clamp(t, 0, 1)) };
    near.distance = -plumb_vec2_distance(near.point, local);
    return near;
}

// The nearest edge of a piece's whole shape that is not an inner cut, for a point inside.
static plumb_convex_near nearest_of_outline(const plumb_world *world, uint32_t piece,
                                            plumb_vec2 local)
{
    plumb_convex_near best = { .distance = -PLUMB_REAL_MAX };
    uint32_t p = pl_shape_piece(world, world->pieces.shape[piece]);
    for (; p != PL_NONE; p = world->pieces.next_in_shape[p]) {
        plumb_convex convex;
        pl_piece_convex(world, p, &convex);
        for (int k = 0; k < convex.count; ++k) {
            if ((world->pieces.cuts[p] >> k & 1u) == 0) {
                plumb_convex_near near = nearest_on_edge(&convex, k, local);
                best = near.distance > best.distance ? near : best;
            }
        }
    }
    return best;
}

static plumb_nearest_hit nearest_of_piece(const search *s, const pl_grid_entry *entry)
{
    const uint32_t piece = entry->piece;
    const plumb_world *world = s->q.world;
    plumb_convex convex;
    plumb_transform frame = pl_query_frame_of(world, entry);
    plumb_vec2 local = plumb_transform_inv_apply(frame, s->point);
    pl_query_convex(world, piece, &convex);
    plumb_convex_near near = plumb_convex_nearest(&convex, local);
    if (near.distance <= 0 && world->pieces.cuts[piece] != 0) {
        near = nearest_of_outline(world, piece, local);
    }
    pl_query_hit names = pl_query_hit_of(world, piece);
    plumb_vec2 at = plumb_transform_apply(frame, near.point);
    if (pl_is_wrapped(world)) {
        at = plumb_v2((plumb_real)((double)at.x + s->back.x),
                      (plumb_real)((double)at.y + s->back.y));
    }
    return (plumb_nearest_hit){ names.shape, names.body, at, near.distance };
}

// Of pieces that are as near, the same one whatever the grid.
static bool is_nearer(const search *s, const plumb_nearest_hit *hit, uint32_t piece)
{
    if (!s->met) {
        return hit->distance <= s->max_distance;
    }
    if (hit->distance != s->best.distance) {
        return hit->distance < s->best.distance;
    }
    const uint32_t slot = hit->shape.entity.index, best = s->best.shape.entity.index;
    return slot != best ? slot < best : piece < s->best_piece;
}

static bool visit(void *context, const pl_grid_entry *entry)
{
    search *s = context;
    double dx, dy;
    box_distance(s, &entry->box, &dx, &dy);
    if (pl_most(dx, dy) <= s->done || sqrt(dx * dx + dy * dy) > bound_of(s) ||
        !pl_query_sees(&s->q, entry->piece)) {
        return true;
    }
    plumb_nearest_hit hit = nearest_of_piece(s, entry);
    if (is_nearer(s, &hit, entry->piece) && pl_query_accepts(&s->q, hit.shape)) {
        s->met = true;
        s->best = hit;
        s->best_piece = entry->piece;
    }
    return true;
}

static void search_level(search *s, const pl_grid *grid, const pl_grid_level *level)
{
    s->done = -1;
    for (double half = level->cell;; half *= 2) {
        double reach = pl_least(half, bound_of(s));
        pl_box box = pl_query_box_at(s->point, reach + s->slack);
        if (pl_grid_range_is_wide(level, pl_grid_range(level, box))) {
            const pl_grid_entry *e = pl_grid_entries(grid) + level->first;
            for (uint32_t i = 0; i < level->count; ++i) {
                visit(s, &e[i]);
            }
            return;
        }
        pl_walk square = { .ox = (double)s->point.x,
                           .oy = (double)s->point.y,
                           .limit = 1,
                           .slack = reach + s->slack };
        pl_walk_level(grid, level, &square, visit, s);
        if (half >= bound_of(s)) {
            return;
        }
        s->done = reach;
    }
}

static plumb_result check_distance(const plumb_world *world, const char *function,
                                   plumb_real max_distance)
{
    PL_TRY(pl_check_finite(world, function, "max_distance", max_distance));
    return max_distance > 0
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_RANGE, function, "max_distance is %g; it must be above 0",
                         (double)max_distance);
}

static plumb_result begin(search *s, plumb_world *world, const char *function, plumb_vec2 point,
                          plumb_real max_distance, const plumb_query_filter *filter)
{
    PL_TRY(pl_check_within(world, function, "point", point, PL_QUERY_LIMIT));
    PL_TRY(check_distance(world, function, max_distance));
    return pl_query_begin(&s->q, world, function, filter);
}

// Goes on with what was found at other images of the point.
static void find_at(search *s, plumb_vec2 point, pl_shift back)
{
    s->point = point;
    s->back = back;
    s->slack = pl_query_slack(fabs((double)point.x) + fabs((double)point.y));
    const pl_grid *grids[PL_QUERY_GRIDS];
    int grid_count = pl_query_grids(&s->q, grids);
    for (int i = 0; i < grid_count; ++i) {
        for (uint32_t k = 0; k < grids[i]->level_count; ++k) {
            search_level(s, grids[i], &grids[i]->levels[k]);
        }
    }
}

// Shapes are looked for by the images of the point that may be nearest to them, of which one lies in the period.
static void find(search *s, plumb_vec2 point, plumb_real max_distance)
{
    s->max_distance = max_distance;
    s->met = false;
    if (!pl_is_wrapped(s->q.world)) {
        find_at(s, point, (pl_shift){ 0, 0 });
        return;
    }
    plumb_vec2 at = plumb_world_wrapped(s->q.world, point);
    const double wrap_x = (double)s->q.world->desc.wrap_x, wrap_y = (double)s->q.world->desc.wrap_y;
    static const int order[] = { 0, 1, -1 }; // the nearest first
    for (int i = 0; i < 9; ++i) {
        double x = order[i % 3] * wrap_x, y = order[i / 3] * wrap_y;
        if ((x != 0 || i % 3 == 0) && (y != 0 || i / 3 == 0)) {
            plumb_vec2 image = { (plumb_real)((double)at.x + x), (plumb_real)((double)at.y + y) };
            find_at(
                s, image,
                (pl_shift){ (double)point.x - (double)image.x, (double)point.y - (double)image.y });
        }
    }
}

bool plumb_world_nearest(plumb_world *world, plumb_vec2 point, plumb_real max_distance,
                         const plumb_query_filter *filter, plumb_nearest_hit *hit)
{
    search s;
    if (world == NULL || pl_check_pointer(world, __func__, "hit", hit) != PLUMB_OK ||
        begin(&s, world, __func__, point, max_distance, filter) != PLUMB_OK) {
        return false;
    }
    find(&s, point, max_distance);
    if (s.met) {
        *hit = s.best;
    }
    return s.met;
}

static bool keep_near(void *context, const pl_grid_entry *entry)
{
    search *s = context;
    if (!pl_query_sees(&s->q, entry->piece)) {
        return true;
    }
    plumb_nearest_hit near = nearest_of_piece(s, entry);
    pl_query_hit hit = { .shape = near.shape,
                         .body = near.body,
                         .piece = entry->piece,
                         .fraction = near.distance,
                         .point = near.point };
    return near.distance > s->max_distance || pl_query_add(&s->q, &hit);
}

// What may be near enough. Of what wraps around, the nearest image is less than a period away.
static pl_box box_of(const search *s)
{
    const plumb_world_desc *d = &s->q.world->desc;
    const double most = pl_least((double)s->max_distance, PLUMB_REAL_MAX / 2);
    const double slack = pl_query_slack(fabs((double)s->point.x) + fabs((double)s->point.y));
    const double x = d->wrap_x > 0 ? pl_least(most, (double)d->wrap_x) : most;
    const double y = d->wrap_y > 0 ? pl_least(most, (double)d->wrap_y) : most;
    pl_box box = pl_query_box_at(s->point, x + slack), tall = pl_query_box_at(s->point, y + slack);
    box.min_y = tall.min_y;
    box.max_y = tall.max_y;
    return box;
}

int plumb_world_nearest_all(plumb_world *world, plumb_vec2 point, plumb_real max_distance,
                            const plumb_query_filter *filter, plumb_nearest_hit *hits, int capacity)
{
    search s;
    if (world == NULL ||
        pl_query_check_output(world, __func__, "hits", hits, capacity) != PLUMB_OK ||
        begin(&s, world, __func__, point, max_distance, filter) != PLUMB_OK) {
        return -1;
    }
    s.point = plumb_world_wrapped(world, point);
    s.back = (pl_shift){ (double)point.x - (double)s.point.x, (double)point.y - (double)s.point.y };
    s.max_distance = max_distance;
    pl_box box = box_of(&s);
    const pl_grid *grids[PL_QUERY_GRIDS];
    int grid_count = pl_query_grids(&s.q, grids);
    for (int i = 0; i < grid_count; ++i) {
        if (!pl_world_query(world, grids[i], box, keep_near, &s)) {
            break;
        }
    }
    pl_query_one_per_shape(&s.q);
    pl_query_sort_along(&s.q);
    int count = (int)s.q.count;
    for (int i = 0; i < count && i < capacity; ++i) {
        const pl_query_hit *hit = &s.q.hits[i];
        hits[i] = (plumb_nearest_hit){ hit->shape, hit->body, hit->point, hit->fraction };
    }
    return pl_query_end(&s.q) == PLUMB_OK ? count : -1;
}

static plumb_result check_points(const plumb_world *world, const char *function,
                                 const plumb_vec2 *points, int count, const plumb_nearest_hit *hits)
{
    PL_TRY(pl_query_check_lists(world, function, count, "points", points, hits));
    for (int i = 0; i < count; ++i) {
        if (!pl_query_is_near(points[i])) {
            char field[32];
            snprintf(field, sizeof field, "points[%d]", i);
            return pl_check_within(world, function, field, points[i], PL_QUERY_LIMIT);
        }
    }
    return PLUMB_OK;
}

int plumb_world_nearest_batch(plumb_world *world, const plumb_vec2 *points, int count,
                              plumb_real max_distance, const plumb_query_filter *filter,
                              plumb_nearest_hit *hits)
{
    search s;
    if (world == NULL || check_points(world, __func__, points, count, hits) != PLUMB_OK ||
        check_distance(world, __func__, max_distance) != PLUMB_OK ||
        pl_query_begin(&s.q, world, __func__, filter) != PLUMB_OK) {
        return -1;
    }
    int met = 0;
    for (int i = 0; i < count; ++i) {
        find(&s, points[i], max_distance);
        hits[i] = s.met ? s.best : (plumb_nearest_hit){ .distance = max_distance };
        met += s.met;
    }
    return met;
}
