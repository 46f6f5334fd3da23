// outline.c - checks of polygon outlines: simple, convex, area, containment.
//
// Signs of turns are exact (exact.h), so that "simple" means simple, and whoever relies on it
// (decompose.c) cannot run into a contradiction.
//
// Reads: the points. Writes: the answer. Cost: O(n); the check for crossings O(n^2), 2 KiB of
// stack (4 in double).

#include "core/try.h"
#include "geometry/exact.h"

static int sign(double x)
{
    return (x > 0) - (x < 0);
}

// For c in line with a and b: whether it lies between them or on one.
static bool between(plumb_vec2 a, plumb_vec2 b, plumb_vec2 c)
{
    return plumb_min(a.x, b.x) <= c.x && c.x <= plumb_max(a.x, b.x) && plumb_min(a.y, b.y) <= c.y &&
           c.y <= plumb_max(a.y, b.y);
}

// Whether the segments a b and c d share any point.
static bool segments_meet(plumb_vec2 a, plumb_vec2 b, plumb_vec2 c, plumb_vec2 d)
{
    int c_side = sign(pl_orient(a, b, c));
    int d_side = sign(pl_orient(a, b, d));
    int a_side = sign(pl_orient(c, d, a));
    int b_side = sign(pl_orient(c, d, b));
    if (c_side * d_side < 0 && a_side * b_side < 0) {
        return true;
    }
    return (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d)) ||
           (a_side == 0 && between(c, d, a)) || (b_side == 0 && between(c, d, b));
}

// Whether edges that are not neighbours meet.
static bool edges_meet(const plumb_vec2 *points, int count)
{
    for (int i = 0; i < count; i++) {
        for (int k = i + 2; k < count; k++) {
            bool neighbours = i == 0 && k == count - 1;
            if (!neighbours && segments_meet(points[i], points[i + 1], points[k],
                                             points[k + 1 == count ? 0 : k + 1])) {
                return true;
            }
        }
    }
    return false;
}

// Leaves out vertices that repeat the one before (within `noise`).
static int drop_repeated(plumb_vec2 *points, int count, double noise)
{
    int n = 1;
    for (int i = 1; i < count; i++) {
        if (pl_distance(points[n - 1], points[i]) > noise) {
            points[n++] = points[i];
        }
    }
    while (n > 1 && pl_distance(points[n - 1], points[0]) <= noise) {
        n--;
    }
    return n;
}

// Leaves out vertices on the line between their neighbours (within `noise`). False when an edge
// folds back over the one before.
static bool drop_in_line(plumb_vec2 *points, int *count, double noise)
{
    int n = *count;
    int bent = 0; // consecutive vertices known not to be in line
    int i = 0;
    while (n >= 3 && bent < n) {
        plumb_vec2 a = points[(i + n - 1) % n];
        plumb_vec2 b = points[i];
        plumb_vec2 c = points[(i + 1) % n];
        double turn = pl_orient(a, b, c);
        double reach = pl_distance(a, c);
        if (turn > noise * reach || -turn > noise * reach) {
            bent++;
            i = (i + 1) % n;
            continue;
        }
        double forward = ((double)b.x - (double)a.x) * ((double)c.x - (double)b.x) +
                         ((double)b.y - (double)a.y) * ((double)c.y - (double)b.y);
        if (forward < 0) {
            return false;
        }
        for (int k = i; k + 1 < n; k++) {
            points[k] = points[k + 1];
        }
        n--;
        bent = 0;
        i = i == n ? 0 : i;
    }
    *count = n;
    return n >= 3;
}

// Direction of a simple outline without points in line: the turn at its leftmost lowest vertex,
// which is always an outer corner.
static bool is_clockwise(const plumb_vec2 *points, int count)
{
    int first = 0;
    for (int i = 1; i < count; i++) {
        if (points[i].x < points[first].x ||
            (points[i].x == points[first].x && points[i].y < points[first].y)) {
            first = i;
        }
    }
    return pl_orient(points[(first + count - 1) % count], points[first],
                     points[(first + 1) % count]) < 0;
}

int pl_outline_simplify(const plumb_vec2 *points, int count,
                        plumb_vec2 out[PLUMB_OUTLINE_MAX_VERTICES])
{
    double noise = pl_points_noise(points, count);
    for (int i = 0; i < count; i++) {
        out[i] = points[i];
    }
    int n = drop_repeated(out, count, noise);
    if (n < 3 || !drop_in_line(out, &n, noise) || edges_meet(out, n)) {
        return 0;
    }
    if (is_clockwise(out, n)) {
        for (int i = 0; i < n / 2; i++) {
            plumb_vec2 t = out[i];
            out[i] = out[n - 1 - i];
            out[n - 1 - i] = t;
        }
    }
    return n;
}

plumb_result plumb_outline_check(const plumb_vec2 *points, int count)
{
    PL_TRY(pl_points_check(points, count));
    plumb_vec2 simple[PLUMB_OUTLINE_MAX_VERTICES];
    return pl_outline_simplify(points, count, simple) >= 3 ? PLUMB_OK : PLUMB_E_GEOMETRY;
}

plumb_real plumb_outline_area(const plumb_vec2 *points, int count)
{
    if (points == NULL || count < 3) {
        return 0;
    }
    double twice = 0;
    for (int i = 1; i + 1 < count; i++) { // triangles about the first point: small numbers
        double ax = (double)points[i].x - (double)points[0].x;
        double ay = (double)points[i].y - (double)points[0].y;
        double bx = (double)points[i + 1].x - (double)points[0].x;
        double by = (double)points[i + 1].y - (double)points[0].y;
        twice += ax * by - ay * bx;
    }
    return (plumb_real)(twice / 2);
}

// Index after i of the next point that differs from it; i when there is none.
static int next_different(const plumb_vec2 *points, int count, int i)
{
    for (int step = 1; step < count; step++) {
        int k = (i + step) % count;
        if (!pl_same_point(points[i], points[k])) {
            return k;
        }
    }
    return i;
}

// Whether an edge runs to the right (or straight up).
static bool runs_right(plumb_vec2 a, plumb_vec2 b)
{
    return b.x > a.x || (b.x == a.x && b.y > a.y);
}

bool plumb_outline_is_convex(const plumb_vec2 *points, int count)
{
    if (points == NULL || count < 3) {
        return false;
    }
    int start = 0; // the first of a run of equal points, so that next_different comes back to it
    while (start < count && pl_same_point(points[start], points[(start + count - 1) % count])) {
        start++;
    }
    if (start == count) {
        return false;
    }
    int side = 0;      // which way the outline turns
    int reversals = 0; // between running right and running left: 2 if it goes around once
    int i = start;
    do {
        int j = next_different(points, count, i);
        int k = next_different(points, count, j);
        int turn = sign(pl_orient(points[i], points[j], points[k]));
        bool reversed = runs_right(points[i], points[j]) != runs_right(points[j], points[k]);
        if (turn * side < 0 || (turn == 0 && reversed)) {
            return false; // bends the other way, or folds back
        }
        side = turn != 0 ? turn : side;
        reversals += reversed;
        i = j;
    } while (i != start);
    return side != 0 && reversals == 2;
}

bool plumb_outline_contains(const plumb_vec2 *points, int count, plumb_vec2 point)
{
    bool inside = false;
    for (int i = 0; i < count; i++) {
        plumb_vec2 a = points[i];
        plumb_vec2 b = points[i + 1 == count ? 0 : i + 1];
        if ((a.y > point.y) != (b.y > point.y)) {
            bool left = pl_orient(a, b, point) > 0;
            inside = left == (b.y > a.y) ? !inside : inside; // a ray to the right crosses it
        }
    }
    return inside;
}
