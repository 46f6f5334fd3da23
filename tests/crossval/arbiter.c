// arbiter.c - see arbiter.h. Cost: O((a + b + a b) (a + b)) for cores of a and b corners.
#include "crossval/arbiter.h"

#include <math.h>

placed arbiter_place(const pair_side *side)
{
    const plumb_convex *convex = &side->shape.convex;
    const pl_pose *pose = &side->pose;
    placed p = { .count = convex->count, .radius = (double)convex->radius };
    for (int i = 0; i < p.count; ++i) {
        double x = (double)convex->points[i].x, y = (double)convex->points[i].y;
        p.x[i] = (double)pose->x + (double)pose->c * x - (double)pose->s * y;
        p.y[i] = (double)pose->y + (double)pose->s * x + (double)pose->c * y;
        p.cx += p.x[i] / p.count;
        p.cy += p.y[i] / p.count;
    }
    return p;
}

double arbiter_beyond(const placed *a, const placed *b, double nx, double ny)
{
    double most = -INFINITY, least = INFINITY;
    for (int i = 0; i < a->count; ++i) {
        most = fmax(most, nx * a->x[i] + ny * a->y[i]);
    }
    for (int i = 0; i < b->count; ++i) {
        least = fmin(least, nx * b->x[i] + ny * b->y[i]);
    }
    return least - most - a->radius - b->radius;
}

typedef struct best {
    double s, nx, ny;
} best;

static void attempt(best *found, const placed *a, const placed *b, double x, double y)
{
    double length = hypot(x, y);
    if (length > 1e-12) {
        double s = arbiter_beyond(a, b, x / length, y / length);
        if (s > found->s) {
            *found = (best){ s, x / length, y / length };
        }
    }
}

double arbiter_separation(const placed *a, const placed *b, double *nx, double *ny)
{
    best found = { -INFINITY, 1, 0 };
    for (int side = 0; side < 2; ++side) {
        const placed *p = side == 0 ? a : b;
        for (int i = 0; i < p->count && p->count > 1; ++i) {
            int k = (i + 1) % p->count;
            double ex = p->x[k] - p->x[i], ey = p->y[k] - p->y[i];
            // Both ways: a segment has two faces, and a wrong one never wins.
            attempt(&found, a, b, ey, -ex);
            attempt(&found, a, b, -ey, ex);
        }
    }
    for (int i = 0; i < a->count; ++i) {
        for (int k = 0; k < b->count; ++k) {
            attempt(&found, a, b, b->x[k] - a->x[i], b->y[k] - a->y[i]);
        }
    }
    if (isinf(found.s)) { // two circles in one place: every direction is as good
        found.s = arbiter_beyond(a, b, 1, 0);
    }
    *nx = found.nx;
    *ny = found.ny;
    return found.s;
}

double arbiter_distance(const placed *p, double x, double y)
{
    placed point = { .count = 1 };
    point.x[0] = x;
    point.y[0] = y;
    double nx, ny;
    return arbiter_separation(p, &point, &nx, &ny);
}
