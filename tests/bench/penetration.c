// penetration.c - overlap depths by brute force: all pairs whose boxes overlap, every axis.
// Reads: scene, poses. Writes: the result. Cost: O(n log n + pairs in x), double precision.
//
// Depth of two convex cores: the least overlap over all face normals of both, because the boundary
// of their Minkowski difference has no other normals (Ericson, Real-Time Collision Detection, 2005,
// 5.2 and 9.3). Cores that do not overlap: their distance, reached between a corner of one
// and an edge of the other. The radii add to either.
#include "penetration.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

// [m] farther than this from the origin a body is astray; no scene is a tenth as large, but
// smash throws boxes 200 m.
static const double far_away = 1000.0;

// Largest gap between a and b over the face normals of a, and for a segment also its directions:
// positive when one of them separates the cores.
static double largest_gap(const struct convex *a, const struct convex *b)
{
    double largest = -DBL_MAX;
    for (int i = 0; i < a->count && a->count > 1; ++i) {
        int k = i + 1 < a->count ? i + 1 : 0;
        double ex = a->x[k] - a->x[i];
        double ey = a->y[k] - a->y[i];
        double length = sqrt(ex * ex + ey * ey);
        double across = DBL_MAX;
        double along = DBL_MAX;
        for (int j = 0; j < b->count; ++j) {
            double dx = b->x[j] - a->x[i];
            double dy = b->y[j] - a->y[i];
            across = fmin(across, (ey * dx - ex * dy) / length);
            along = fmin(along, -(ex * dx + ey * dy) / length);
        }
        largest = fmax(largest, across);
        if (a->count == 2) {
            largest = fmax(largest, along);
        }
    }
    return largest;
}

// Least distance from a corner of a to the boundary of b.
static double corner_distance(const struct convex *a, const struct convex *b)
{
    double least = DBL_MAX;
    for (int i = 0; i < a->count; ++i) {
        for (int j = 0; j < b->count; ++j) {
            int k = j + 1 < b->count ? j + 1 : 0;
            double ex = b->x[k] - b->x[j];
            double ey = b->y[k] - b->y[j];
            double dx = a->x[i] - b->x[j];
            double dy = a->y[i] - b->y[j];
            double square = ex * ex + ey * ey;
            double t = square > 0.0 ? (dx * ex + dy * ey) / square : 0.0;
            t = fmin(fmax(t, 0.0), 1.0);
            least = fmin(least, hypot(dx - t * ex, dy - t * ey));
        }
    }
    return least;
}

// [m] How far two shapes must be moved to part them (> 0), or minus their distance. Exact.
static double convex_depth(const struct convex *a, const struct convex *b)
{
    double rounding = a->radius + b->radius;
    double gap = fmax(largest_gap(a, b), largest_gap(b, a));
    // Two points have no axes at all: their gap is -DBL_MAX.
    if (gap < 0.0 && a->count + b->count > 2) {
        return rounding - gap;
    }
    return rounding - fmin(corner_distance(a, b), corner_distance(b, a));
}

// A shape placed in the world, with its box.
struct placed {
    double min_x, max_x, min_y, max_y;
    struct convex convex;
    int body, group;
    bool dynamic;
};

static void place(const struct scene_shape *shape, struct engine_pose pose, double skin,
                  struct placed *p)
{
    p->min_x = p->min_y = DBL_MAX;
    p->max_x = p->max_y = -DBL_MAX;
    p->convex.count = shape->count;
    p->convex.radius = shape->radius + (shape->count > 1 ? skin : 0.0);
    for (int i = 0; i < shape->count; ++i) {
        double x = pose.x + pose.c * shape->x[i] - pose.s * shape->y[i];
        double y = pose.y + pose.s * shape->x[i] + pose.c * shape->y[i];
        p->convex.x[i] = x;
        p->convex.y[i] = y;
        p->min_x = fmin(p->min_x, x - p->convex.radius);
        p->max_x = fmax(p->max_x, x + p->convex.radius);
        p->min_y = fmin(p->min_y, y - p->convex.radius);
        p->max_y = fmax(p->max_y, y + p->convex.radius);
    }
}

static int by_min_x(const void *a, const void *b)
{
    double x = ((const struct placed *)a)->min_x;
    double y = ((const struct placed *)b)->min_x;
    return (x > y) - (x < y);
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

static bool is_astray(struct engine_pose pose)
{
    // Written so that NaN is astray.
    return !(fabs(pose.x) <= far_away && fabs(pose.y) <= far_away && isfinite(pose.c + pose.s));
}

// A growing list of depths.
struct depths {
    double *values;
    size_t count, capacity;
};

static bool push(struct depths *list, double value)
{
    if (list->count == list->capacity) {
        size_t capacity = list->capacity > 0 ? 2 * list->capacity : 1024;
        double *values = realloc(list->values, capacity * sizeof *values);
        if (values == NULL) {
            return false;
        }
        list->values = values;
        list->capacity = capacity;
    }
    list->values[list->count++] = value;
    return true;
}

// Sweeps along x: `shapes` are sorted by min_x.
static bool collect(const struct placed *shapes, int count, struct depths *list)
{
    for (int i = 0; i < count; ++i) {
        const struct placed *a = &shapes[i];
        for (int j = i + 1; j < count && shapes[j].min_x <= a->max_x; ++j) {
            const struct placed *b = &shapes[j];
            if (a->min_y > b->max_y || b->min_y > a->max_y || a->body == b->body ||
                !(a->dynamic || b->dynamic) || (a->group != 0 && a->group == b->group)) {
                continue;
            }
            double depth = convex_depth(&a->convex, &b->convex);
            if (depth > 0.0 && !push(list, depth)) {
                return false;
            }
        }
    }
    return true;
}

// What is placed so far.
struct placing {
    const struct scene *scene;
    const struct engine_pose *poses;
    int step;
    double skin;
    struct placed *shapes;
    int count;
};

static void place_shape(struct placing *p, const struct scene_shape *shape)
{
    const struct scene_member *body = &p->scene->bodies[shape->body];
    if (!scene_has(p->scene, shape->body, p->step) || is_astray(p->poses[shape->body])) {
        return;
    }
    struct placed *out = &p->shapes[p->count++];
    out->body = shape->body;
    out->group = body->def.group;
    out->dynamic = body->def.type == ENGINE_DYNAMIC;
    place(shape, p->poses[shape->body], p->skin, out);
}

static void place_chain(struct placing *p, const struct scene_chain *chain)
{
    for (int i = 0; i + (chain->loop ? 0 : 1) < chain->count; ++i) {
        int k = i + 1 < chain->count ? i + 1 : 0;
        struct scene_shape edge = { .body = chain->body, .count = 2 };
        edge.x[0] = chain->x[i], edge.y[0] = chain->y[i];
        edge.x[1] = chain->x[k], edge.y[1] = chain->y[k];
        place_shape(p, &edge);
    }
}

static bool place_all(struct placing *p)
{
    size_t most = (size_t)p->scene->shape_count;
    for (int i = 0; i < p->scene->chain_count; ++i) {
        most += (size_t)p->scene->chains[i].count;
    }
    p->shapes = malloc(most * sizeof *p->shapes);
    if (p->shapes == NULL) {
        return false;
    }
    for (int i = 0; i < p->scene->shape_count; ++i) {
        place_shape(p, &p->scene->shapes[i]);
    }
    for (int i = 0; i < p->scene->chain_count; ++i) {
        place_chain(p, &p->scene->chains[i]);
    }
    return true;
}

bool penetration_measure(const struct scene *scene, const struct engine_pose *poses, int step,
                         double skin, struct penetration *result)
{
    *result = (struct penetration){ 0 };
    struct placing placing = { .scene = scene, .poses = poses, .step = step, .skin = skin };
    if (!place_all(&placing)) {
        return false;
    }
    for (int i = 0; i < scene->body_count; ++i) {
        result->astray += scene_has(scene, i, step) && is_astray(poses[i]) ? 1 : 0;
    }
    struct placed *shapes = placing.shapes;
    const int count = placing.count;
    qsort(shapes, (size_t)count, sizeof *shapes, by_min_x);
    struct depths list = { NULL, 0, 0 };
    bool done = collect(shapes, count, &list);
    if (done && list.count > 0) {
        qsort(list.values, list.count, sizeof *list.values, by_value);
        for (size_t i = 0; i < list.count; ++i) {
            result->sum += list.values[i];
        }
        result->pairs = (long)list.count;
        result->max = list.values[list.count - 1];
        result->p99 = list.values[(list.count - 1) * 99 / 100];
    }
    free(list.values);
    free(shapes);
    return done;
}
