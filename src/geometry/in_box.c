// in_box.c - what a triangle has of an upright box: cut by its four sides one after the other (Sutherland and Hodgman 1974).
//
// Reads: its arguments. Writes: nothing. Cost: O(1).
#include "geometry/in_box.h"

#define MOST 8 // corners: each side adds one at most

typedef struct polygon {
    double p[MOST][2];
    int count;
} polygon;

// Keeps what is at sign * coordinate <= sign * at.
static void cut(polygon *a, int axis, double sign, double at)
{
    polygon out = { .count = 0 };
    for (int i = 0; i < a->count; ++i) {
        const double *p = a->p[i], *q = a->p[i + 1 < a->count ? i + 1 : 0];
        const double here = sign * (p[axis] - at), there = sign * (q[axis] - at);
        if (here <= 0) {
            out.p[out.count][0] = p[0];
            out.p[out.count++][1] = p[1];
        }
        if ((here < 0 && there > 0) || (here > 0 && there < 0)) {
            const double t = here / (here - there);
            out.p[out.count][axis] = at;
            out.p[out.count++][1 - axis] = p[1 - axis] + t * (q[1 - axis] - p[1 - axis]);
        }
    }
    *a = out;
}

pl_in_box pl_triangle_in_box(const double x[3], const double y[3], double low_x, double low_y,
                             double high_x, double high_y)
{
    polygon a = { { { x[0], y[0] }, { x[1], y[1] }, { x[2], y[2] } }, 3 };
    pl_in_box out = { 0, 0, 0 };
    cut(&a, 0, -1, low_x);
    cut(&a, 0, 1, high_x);
    cut(&a, 1, -1, low_y);
    cut(&a, 1, 1, high_y);
    for (int i = 2; i < a.count; ++i) {
        const double ux = a.p[i - 1][0] - a.p[0][0], uy = a.p[i - 1][1] - a.p[0][1];
        const double vx = a.p[i][0] - a.p[0][0], vy = a.p[i][1] - a.p[0][1];
        const double part = (ux * vy - uy * vx) / 2;
        out.area += part;
        out.x += part * (ux + vx) / 3, out.y += part * (uy + vy) / 3;
    }
    if (out.area > 0) {
        out.x = a.p[0][0] + out.x / out.area;
        out.y = a.p[0][1] + out.y / out.area;
    }
    return out;
}
