// hull.c - convex hull of a point cloud.
//
// Andrew's monotone chain (A. M. Andrew, "Another efficient algorithm for convex hulls in two
// dimensions", Inf. Proc. Letters 9, 1979): sort by x, then walk the lower and the upper chain,
// dropping whatever does not turn left. Orientation signs are exact, so equal points and points in
// line are dropped for certain and the result is convex. What is left is then cleaned of vertices
// that a collision routine could make nothing of: edges shorter than the weld distance, and
// vertices that stick out by less than the coordinates' own rounding.
//
// Reads: the points. Writes: the hull. Cost: O(n^2) (the sort), 6 KiB of stack (12 in double).

#include "core/try.h"
#include "geometry/exact.h"

#include <string.h>

plumb_result pl_points_check(const plumb_vec2 *points, int count)
{
    if (points == NULL) {
        return PLUMB_E_NULL;
    }
    if (count < 3) {
        return PLUMB_E_RANGE;
    }
    if (count > PLUMB_OUTLINE_MAX_VERTICES) {
        return PLUMB_E_CAPACITY;
    }
    plumb_result result = PLUMB_OK;
    for (int i = 0; i < count; i++) {
        if (!plumb_vec2_is_finite(points[i])) {
            return PLUMB_E_NOT_FINITE;
        }
        if (plumb_abs(points[i].x) > PLUMB_LENGTH_MAX ||
            plumb_abs(points[i].y) > PLUMB_LENGTH_MAX) {
            result = PLUMB_E_RANGE;
        }
    }
    return result;
}

double pl_points_noise(const plumb_vec2 *points, int count)
{
    plumb_real size = 0;
    for (int i = 0; i < count; i++) {
        size = plumb_max(size, plumb_max(plumb_abs(points[i].x), plumb_abs(points[i].y)));
    }
    return 4 * (double)PLUMB_REAL_EPSILON * (double)size; // a rounding is half an epsilon
}

// Order of the sweep: by x, then y.
static bool sweeps_before(plumb_vec2 a, plumb_vec2 b)
{
    return a.x != b.x ? a.x < b.x : a.y < b.y;
}

// Insertion sort: the C library's qsort may allocate, and a hull of 256 random points takes 20 us.
static void sort_points(plumb_vec2 *points, int count)
{
    for (int i = 1; i < count; i++) {
        plumb_vec2 p = points[i];
        int k = i;
        for (; k > 0 && sweeps_before(p, points[k - 1]); k--) {
            points[k] = points[k - 1];
        }
        points[k] = p;
    }
}

// Hull of sorted points, counter-clockwise from the first; needs room for 2 * count.
static int chain(const plumb_vec2 *sorted, int count, plumb_vec2 *hull)
{
    int n = 0;
    for (int i = 0; i < count; i++) { // lower chain, left to right
        while (n >= 2 && pl_orient(hull[n - 2], hull[n - 1], sorted[i]) <= 0) {
            n--;
        }
        hull[n++] = sorted[i];
    }
    int lower = n + 1;
    for (int i = count - 2; i >= 0; i--) { // upper chain, back again
        while (n >= lower && pl_orient(hull[n - 2], hull[n - 1], sorted[i]) <= 0) {
            n--;
        }
        hull[n++] = sorted[i];
    }
    return n - 1; // the last point is the first again
}

// Leaves out vertices nearer than `weld` to the last one kept.
static int weld_neighbours(plumb_vec2 *hull, int count, double weld)
{
    int n = 1;
    for (int i = 1; i < count; i++) {
        if (pl_distance(hull[n - 1], hull[i]) >= weld) {
            hull[n++] = hull[i];
        }
    }
    while (n > 1 && pl_distance(hull[n - 1], hull[0]) < weld) {
        n--;
    }
    return n;
}

// Leaves out vertices that stick out of the line of their neighbours by less than `noise`.
static int drop_flat(plumb_vec2 *hull, int count, double noise)
{
    int flat_free = 0; // consecutive vertices known to stick out
    int i = 0;
    while (count >= 3 && flat_free < count) {
        plumb_vec2 before = hull[(i + count - 1) % count];
        plumb_vec2 after = hull[(i + 1) % count];
        if (pl_orient(before, hull[i], after) > noise * pl_distance(before, after)) {
            flat_free++;
            i = (i + 1) % count;
            continue;
        }
        memmove(&hull[i], &hull[i + 1], (size_t)(count - i - 1) * sizeof *hull);
        count--;
        flat_free = 0;
        i = i == count ? 0 : i;
    }
    return count;
}

// Smallest extent [m] of a convex polygon: it is at right angles to one of the edges.
static double thickness(const plumb_vec2 *hull, int count)
{
    double thinnest = (double)PLUMB_REAL_MAX;
    for (int i = 0; i < count; i++) {
        plumb_vec2 a = hull[i];
        plumb_vec2 b = hull[(i + 1) % count];
        double widest = 0;
        for (int k = 0; k < count; k++) {
            double twice_area = pl_orient(a, b, hull[k]);
            widest = twice_area > widest ? twice_area : widest;
        }
        double width = widest / pl_distance(a, b);
        thinnest = width < thinnest ? width : thinnest;
    }
    return thinnest;
}

plumb_result plumb_hull(const plumb_vec2 *points, int count, plumb_vec2 *hull, int capacity,
                        int *hull_count)
{
    if (hull == NULL || hull_count == NULL) {
        return PLUMB_E_NULL;
    }
    PL_TRY(pl_points_check(points, count));
    plumb_vec2 sorted[PLUMB_OUTLINE_MAX_VERTICES];
    plumb_vec2 work[2 * PLUMB_OUTLINE_MAX_VERTICES];
    memcpy(sorted, points, (size_t)count * sizeof *points);
    sort_points(sorted, count);

    double noise = pl_points_noise(points, count);
    double weld = noise > (double)PLUMB_WELD_DISTANCE ? noise : (double)PLUMB_WELD_DISTANCE;
    int n = chain(sorted, count, work);
    n = n >= 3 ? weld_neighbours(work, n, weld) : n;
    n = n >= 3 ? drop_flat(work, n, noise) : n;
    if (n < 3 || thickness(work, n) < weld) {
        return PLUMB_E_GEOMETRY;
    }
    if (n > capacity) {
        return PLUMB_E_CAPACITY;
    }
    memcpy(hull, work, (size_t)n * sizeof *work);
    *hull_count = n;
    return PLUMB_OK;
}
