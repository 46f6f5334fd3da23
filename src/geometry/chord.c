// chord.c - where a line meets a convex shape.
//
// Reads: corners and a radius. Writes: intervals. Cost: O(corners), and O(chords).
#include "geometry/chord.h"

#include <math.h>

typedef struct interval {
    double low, high;
} interval;

static void widen(interval *a, double y)
{
    a->low = y < a->low ? y : a->low;
    a->high = y > a->high ? y : a->high;
}

// The edge from corner a to b, moved outwards by the radius: where it meets the line.
static void meet_edge(interval *out, double ax, double ay, double bx, double by, double radius,
                      double at)
{
    const double dx = bx - ax, dy = by - ay, length = sqrt(dx * dx + dy * dy);
    if (!(length > 0)) {
        return;
    }
    const double nx = dy / length * radius, ny = -dx / length * radius;
    const double from = at - ax - nx;
    if (dx != 0 && (dx > 0 ? from >= 0 && from <= dx : from <= 0 && from >= dx)) {
        widen(out, ay + ny + dy * (from / dx));
    }
}

// The same of an edge that is not moved.
static void meet_side(interval *out, double ax, double ay, double bx, double by, double at)
{
    const double from = at - ax, dx = bx - ax;
    if (from == 0) {
        widen(out, ay);
    }
    if (dx != 0 && (dx > 0 ? from >= 0 && from <= dx : from <= 0 && from >= dx)) {
        widen(out, ay + (by - ay) * (from / dx));
    }
}

static interval chord_of_round(const double *x, const double *y, int n, double radius, double at)
{
    interval out = { INFINITY, -INFINITY };
    for (int i = 0; i < n; ++i) {
        const int k = i + 1 < n ? i + 1 : 0;
        const double off = at - x[i], square = radius * radius - off * off;
        if (square >= 0) {
            const double half = sqrt(square);
            widen(&out, y[i] - half);
            widen(&out, y[i] + half);
        }
        meet_edge(&out, x[i], y[i], x[k], y[k], radius, at);
        if (n == 2) {
            meet_edge(&out, x[k], y[k], x[i], y[i], radius, at);
        }
    }
    return out;
}

bool pl_chord(const double *x, const double *y, int n, double radius, double at, double *low,
              double *high)
{
    interval out = { INFINITY, -INFINITY };
    if (radius != 0) {
        out = chord_of_round(x, y, n, radius, at);
    }
    for (int i = 0; i < n && radius == 0; ++i) {
        const int k = i + 1 < n ? i + 1 : 0;
        meet_side(&out, x[i], y[i], x[k], y[k], at);
    }
    *low = out.low;
    *high = out.high;
    return out.low <= out.high;
}

// An edge that goes right is below all that is in the shape, one that goes left above it.
static void meet_lines(double ax, double ay, double bx, double by, const double *at, int count,
                       double *low, double *high)
{
    const double dx = bx - ax, left = dx > 0 ? ax : bx, right = dx > 0 ? bx : ax;
    int k = 0;
    while (k < count && at[k] < left) {
        ++k;
    }
    for (; k < count && at[k] <= right && dx != 0; ++k) {
        const double y = ay + (by - ay) * ((at[k] - ax) / dx);
        if (dx > 0) {
            low[k] = y < low[k] ? y : low[k];
        } else {
            high[k] = y > high[k] ? y : high[k];
        }
    }
}

void pl_chords(const double *x, const double *y, int n, double radius, const double *at, int count,
               double *low, double *high)
{
    for (int k = 0; k < count; ++k) {
        const interval none = { INFINITY, -INFINITY };
        const interval out = radius != 0 ? chord_of_round(x, y, n, radius, at[k]) : none;
        low[k] = out.low, high[k] = out.high;
    }
    for (int i = 0; i < n && radius == 0; ++i) {
        const int k = i + 1 < n ? i + 1 : 0;
        meet_lines(x[i], y[i], x[k], y[k], at, count, low, high);
    }
}
