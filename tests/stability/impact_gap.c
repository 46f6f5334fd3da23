// impact_gap.c - see impact_gap.h. Cost: O(corners of one times corners of the other).
#include "impact_gap.h"

#include <math.h>

typedef struct piece {
    double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES];
    double radius;
    int count;
} piece;

// Piece i of a shape in world axes, seen from `origin`.
static piece piece_at(const plumb_world *w, plumb_shape shape, int i, plumb_vec2 origin)
{
    plumb_convex c;
    plumb_shape_piece(w, shape, i, &c, NULL);
    const plumb_body body = plumb_shape_body(w, shape);
    const plumb_vec2 way = plumb_world_way(w, origin, plumb_body_center(w, body));
    const plumb_transform at = plumb_body_transform(w, body);
    const plumb_vec2 arm = plumb_vec2_sub(at.p, plumb_body_center(w, body));
    piece p = { .radius = (double)c.radius, .count = c.count };
    for (int k = 0; k < c.count; ++k) {
        const plumb_vec2 v = plumb_rot_apply(at.q, c.points[k]);
        p.x[k] = (double)way.x + (double)arm.x + (double)v.x;
        p.y[k] = (double)way.y + (double)arm.y + (double)v.y;
    }
    return p;
}

// [m] from a point to an edge.
static double point_to_edge(double px, double py, double ax, double ay, double bx, double by)
{
    const double ex = bx - ax, ey = by - ay, length = ex * ex + ey * ey;
    double t = length > 0 ? ((px - ax) * ex + (py - ay) * ey) / length : 0;
    t = fmin(fmax(t, 0), 1);
    return hypot(px - ax - t * ex, py - ay - t * ey);
}

static int edges(const piece *p)
{
    return p->count > 2 ? p->count : 1;
}

static bool inside(const piece *p, double x, double y)
{
    bool in = p->count > 2;
    for (int i = 0; i < p->count && in; ++i) {
        const int k = (i + 1) % p->count;
        in = (p->x[k] - p->x[i]) * (y - p->y[i]) - (p->y[k] - p->y[i]) * (x - p->x[i]) >= 0;
    }
    return in;
}

static double side(double ax, double ay, double bx, double by, double px, double py)
{
    return (bx - ax) * (py - ay) - (by - ay) * (px - ax);
}

static bool any_edges_cross(const piece *p, const piece *q)
{
    for (int i = 0; i < edges(p); ++i) {
        const int k = (i + 1) % p->count;
        for (int j = 0; j < edges(q); ++j) {
            const int l = (j + 1) % q->count;
            const double a = side(p->x[i], p->y[i], p->x[k], p->y[k], q->x[j], q->y[j]);
            const double b = side(p->x[i], p->y[i], p->x[k], p->y[k], q->x[l], q->y[l]);
            const double c = side(q->x[j], q->y[j], q->x[l], q->y[l], p->x[i], p->y[i]);
            const double d = side(q->x[j], q->y[j], q->x[l], q->y[l], p->x[k], p->y[k]);
            if (a * b < 0 && c * d < 0) {
                return true;
            }
        }
    }
    return false;
}

// [m] of the corners of p to the edges of q.
static double corners_to_edges(const piece *p, const piece *q)
{
    double least = INFINITY;
    for (int i = 0; i < p->count; ++i) {
        for (int j = 0; j < edges(q); ++j) {
            const int l = (j + 1) % q->count;
            least =
                fmin(least, point_to_edge(p->x[i], p->y[i], q->x[j], q->y[j], q->x[l], q->y[l]));
        }
    }
    return least;
}

static double piece_gap(const piece *p, const piece *q)
{
    if (inside(p, q->x[0], q->y[0]) || inside(q, p->x[0], p->y[0]) || any_edges_cross(p, q)) {
        return 0;
    }
    const double cores = fmin(corners_to_edges(p, q), corners_to_edges(q, p));
    return fmax(cores - p->radius - q->radius, 0);
}

double impact_gap(const plumb_world *w, plumb_shape a, plumb_shape b)
{
    const plumb_vec2 origin = plumb_body_center(w, plumb_shape_body(w, a));
    double least = INFINITY;
    for (int i = 0; i < plumb_shape_piece_count(w, a); ++i) {
        const piece p = piece_at(w, a, i, origin);
        for (int j = 0; j < plumb_shape_piece_count(w, b); ++j) {
            const piece q = piece_at(w, b, j, origin);
            least = fmin(least, piece_gap(&p, &q));
        }
    }
    return least;
}
