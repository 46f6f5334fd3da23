// overlap.c - shapes that overlap a box, a convex shape or a point; when two convex shapes overlap.
//
// Two rounded shapes overlap when the distance of their cores is at most the sum of their radii. No
// axis that separates the cores by more than that, then no axis that separates them at all (they
// intersect), else the distance from corners to edges, which two convex sets that are apart have.
//
// Axes that suffice are the normals of both outlines (separating axis theorem; Gottschalk 1996). A
// segment counts as a flat box: both its sides and both its ends.
//
// Reads: grids, pieces, poses. Writes: the answer. Cost: cells of the box + O(corners^2) a piece.
#include "query/overlap.h"

#include "broad/images.h"
#include "query/query.h"
#include "world/check.h"

#include <math.h>

//---- two convex shapes -------------------------------------------------------------------------

void pl_round_make(const plumb_convex *convex, plumb_transform t, plumb_vec2 origin, pl_round *out)
{
    double px = (double)t.p.x - (double)origin.x;
    double py = (double)t.p.y - (double)origin.y;
    double c = (double)t.q.c;
    double s = (double)t.q.s;
    out->count = convex->count;
    out->radius = (double)convex->radius;
    for (int i = 0; i < convex->count; ++i) {
        double x = (double)convex->points[i].x;
        double y = (double)convex->points[i].y;
        out->x[i] = c * x - s * y + px;
        out->y[i] = s * x + c * y + py;
    }
}

// How far b lies beyond a along a unit vector; negative: not at all.
static double gap(const pl_round *a, const pl_round *b, double nx, double ny)
{
    double farthest = -HUGE_VAL;
    double nearest = HUGE_VAL;
    for (int i = 0; i < a->count; ++i) {
        farthest = pl_most(farthest, nx * a->x[i] + ny * a->y[i]);
    }
    for (int i = 0; i < b->count; ++i) {
        nearest = pl_least(nearest, nx * b->x[i] + ny * b->y[i]);
    }
    return nearest - farthest;
}

// The widest gap between the cores along the axes of a's outline; -inf when a is a point.
static double widest_gap(const pl_round *a, const pl_round *b)
{
    double widest = -HUGE_VAL;
    for (int i = 0; i < a->count && a->count > 1; ++i) {
        int next = i + 1 == a->count ? 0 : i + 1;
        double dx = a->x[next] - a->x[i];
        double dy = a->y[next] - a->y[i];
        double length = sqrt(dx * dx + dy * dy);
        if (length == 0) {
            continue;
        }
        dx /= length;
        dy /= length;
        widest = pl_most(widest, gap(a, b, dy, -dx));
        if (a->count == 2) { // the end towards which this edge runs
            widest = pl_most(widest, gap(a, b, dx, dy));
        }
    }
    return widest;
}

// Squared distance of a point from the edge that starts at corner i.
static double distance_sq(const pl_round *a, int i, double px, double py)
{
    int next = i + 1 == a->count ? 0 : i + 1;
    double dx = a->x[next] - a->x[i];
    double dy = a->y[next] - a->y[i];
    double rx = px - a->x[i];
    double ry = py - a->y[i];
    double length_sq = dx * dx + dy * dy;
    double t = length_sq > 0 ? (rx * dx + ry * dy) / length_sq : 0; // 0: a point has no edge
    t = pl_least(pl_most(t, 0), 1);
    rx -= t * dx;
    ry -= t * dy;
    return rx * rx + ry * ry;
}

// Smallest squared distance from b's corners to a's outline.
static double corners_distance_sq(const pl_round *a, const pl_round *b)
{
    double nearest = HUGE_VAL;
    for (int i = 0; i < a->count; ++i) {
        for (int k = 0; k < b->count; ++k) {
            nearest = pl_least(nearest, distance_sq(a, i, b->x[k], b->y[k]));
        }
    }
    return nearest;
}

bool pl_rounds_overlap(const pl_round *a, const pl_round *b)
{
    double reach = a->radius + b->radius;
    double widest = pl_most(widest_gap(a, b), widest_gap(b, a));
    if (widest > reach) {
        return false;
    }
    if (widest <= 0 && widest > -HUGE_VAL) { // two points have no axes: -inf
        return true;
    }
    return pl_least(corners_distance_sq(a, b), corners_distance_sq(b, a)) <= reach * reach;
}

//---- queries -----------------------------------------------------------------------------------

typedef struct search {
    pl_query q;
    pl_box box;
    pl_round round;   // of overlap_convex, relative to `origin`
    plumb_vec2 point; // of overlap_point
    plumb_vec2 origin;
} search;

typedef bool overlaps_fn(const search *s, const pl_grid_entry *entry);

typedef struct visitor {
    search *s;
    overlaps_fn *overlaps;
} visitor;

static bool visit(void *context, const pl_grid_entry *entry)
{
    visitor *v = context;
    if (!pl_query_sees(&v->s->q, entry->piece) || !v->overlaps(v->s, entry)) {
        return true;
    }
    pl_query_hit hit = pl_query_hit_of(v->s->q.world, entry->piece);
    return pl_query_add(&v->s->q, &hit);
}

// Asks all pieces near s->box, writes the shapes in slot order.
static int run(search *s, overlaps_fn *overlaps, plumb_shape *shapes, int capacity)
{
    const pl_grid *grids[PL_QUERY_GRIDS];
    int grid_count = pl_query_grids(&s->q, grids);
    visitor v = { s, overlaps };
    for (int i = 0; i < grid_count; ++i) {
        if (!pl_world_query(s->q.world, grids[i], s->box, visit, &v)) {
            break;
        }
    }
    pl_query_one_per_shape(&s->q);
    int count = (int)s->q.count;
    for (int i = 0; i < count && i < capacity; ++i) {
        shapes[i] = s->q.hits[i].shape;
    }
    return pl_query_end(&s->q) == PLUMB_OK ? count : -1;
}

static bool tight_box_overlaps(const search *s, const pl_grid_entry *entry)
{
    const plumb_world *world = s->q.world;
    pl_box tight = pl_piece_tight_box(world, entry->piece);
    if (pl_is_wrapped(world)) {
        pl_shift at = pl_wrap_shift(world, (double)(tight.min_x - entry->box.min_x),
                                    (double)(tight.min_y - entry->box.min_y));
        tight = (pl_box){ tight.min_x + (real)at.x, tight.min_y + (real)at.y,
                          tight.max_x + (real)at.x, tight.max_y + (real)at.y };
    }
    return pl_boxes_overlap(&tight, &s->box);
}

// The same along an axis that wraps: a period or more is all there is, and what lies far out is brought to the
// period, where coordinates still tell it from its neighbours.
static void bring_near(real period, real *min, real *max)
{
    double low = (double)*min, width = (double)*max - low, wide = (double)period;
    if (!(period > 0)) {
        return;
    }
    if (width >= wide) {
        *min = -period;
        *max = period;
    } else if (fabs(low) > PL_QUERY_PERIODS * wide) {
        low = fmod(low, wide);
        *min = (real)low;
        *max = (real)(low + width);
    }
}

int plumb_world_overlap_aabb(plumb_world *world, plumb_aabb box, const plumb_query_filter *filter,
                             plumb_shape *shapes, int capacity)
{
    search s;
    if (world == NULL ||
        pl_query_check_output(world, __func__, "shapes", shapes, capacity) != PLUMB_OK ||
        pl_check_finite_vec(world, __func__, "box.min", box.min) != PLUMB_OK ||
        pl_check_finite_vec(world, __func__, "box.max", box.max) != PLUMB_OK ||
        pl_query_begin(&s.q, world, __func__, filter) != PLUMB_OK) {
        return -1;
    }
    if (plumb_aabb_is_empty(box)) {
        return 0;
    }
    s.box = (pl_box){ box.min.x, box.min.y, box.max.x, box.max.y };
    bring_near(world->desc.wrap_x, &s.box.min_x, &s.box.max_x);
    bring_near(world->desc.wrap_y, &s.box.min_y, &s.box.max_y);
    return run(&s, tight_box_overlaps, shapes, capacity);
}

static bool contains_point(const search *s, const pl_grid_entry *entry)
{
    plumb_convex convex;
    pl_query_convex(s->q.world, entry->piece, &convex);
    plumb_transform frame = pl_query_frame_of(s->q.world, entry);
    return plumb_convex_contains(&convex, plumb_transform_inv_apply(frame, s->point));
}

int plumb_world_overlap_point(plumb_world *world, plumb_vec2 point,
                              const plumb_query_filter *filter, plumb_shape *shapes, int capacity)
{
    search s;
    if (world == NULL ||
        pl_query_check_output(world, __func__, "shapes", shapes, capacity) != PLUMB_OK ||
        pl_check_within(world, __func__, "point", point, PL_QUERY_LIMIT) != PLUMB_OK ||
        pl_query_begin(&s.q, world, __func__, filter) != PLUMB_OK) {
        return -1;
    }
    s.point = point = plumb_world_wrapped(world, point);
    s.box = pl_query_box_at(point, pl_query_slack(fabs((double)point.x) + fabs((double)point.y)));
    return run(&s, contains_point, shapes, capacity);
}

static bool rounds_overlap(const search *s, const pl_grid_entry *entry)
{
    plumb_convex convex;
    pl_round round;
    pl_query_convex(s->q.world, entry->piece, &convex);
    pl_round_make(&convex, pl_query_frame_of(s->q.world, entry), s->origin, &round);
    return pl_rounds_overlap(&s->round, &round);
}

int plumb_world_overlap_convex(plumb_world *world, const plumb_convex *convex,
                               plumb_transform transform, const plumb_query_filter *filter,
                               plumb_shape *shapes, int capacity)
{
    search s;
    if (world == NULL ||
        pl_query_check_output(world, __func__, "shapes", shapes, capacity) != PLUMB_OK ||
        pl_query_check_convex(world, __func__, "", convex) != PLUMB_OK ||
        pl_query_check_transform(world, __func__, "", transform) != PLUMB_OK ||
        pl_query_begin(&s.q, world, __func__, filter) != PLUMB_OK) {
        return -1;
    }
    plumb_aabb box = plumb_convex_aabb(convex, transform);
    if (pl_query_check_reach(world, __func__, "the shape", (double)box.max.x - (double)box.min.x,
                             (double)box.max.y - (double)box.min.y) != PLUMB_OK) {
        return -1;
    }
    double largest = fabs((double)transform.p.x) + fabs((double)transform.p.y) +
                     (double)(box.max.x - box.min.x) + (double)(box.max.y - box.min.y);
    box = plumb_aabb_expand(box, (plumb_real)pl_query_slack(largest));
    s.box = (pl_box){ box.min.x, box.min.y, box.max.x, box.max.y };
    s.origin = transform.p;
    pl_round_make(convex, transform, s.origin, &s.round);
    return run(&s, rounds_overlap, shapes, capacity);
}
