// sweep.c - conservative advancement of two convex pieces (the idea: Mirtich 1996; the bound here
// follows each corner instead of one speed for the whole piece).
//
// At a moment the pieces are g apart along a normal n from B to A: every core point a of A lies at
// least g + radii beyond every core point b of B. Keep n and let time run on by t. A point p of a
// piece that moves by d and turns by w about its pivot has
//     n.p(t) >= n.p + (n.d + w n.(p - pivot)^) t - w^2 |p - pivot| t^2 / 2
// (^: turned left; the second derivative of a point on a circle is at most w^2 r), and likewise from
// above for B. As long as the smallest of these over A stays beyond the largest over B, n still
// separates the pieces by the target, whatever they do. The first root over all corners is how far
// time may run; then the next n is taken. A motion without turning is solved in one round for each
// pair of features; a spinning rod that passes a post takes steps with the square root of the gap,
// not with the gap.
//
// n is the direction of least distance where the cores are apart, else the axis of least overlap
// among the normals of both (separating axes; lines count with their ends). The bound holds for any
// n, so rounding in its choice costs time but never a hit.
//
// Reads: arguments. Writes: the answer. Cost: O(corners of A x corners of B) a round.
#include "geometry/sweep.h"

#include <math.h>

#include "math/compare.h"
#include "math/trig.h"

#define CORNERS PLUMB_POLYGON_MAX_VERTICES

// A core at one time, from the common origin, and its points from the pivot.
typedef struct core {
    int count;
    double x[CORNERS], y[CORNERS];
    double rx[CORNERS], ry[CORNERS];
} core;

static void place(const pl_swept *piece, double time, core *out)
{
    double c = 1, s = 0;
    if (piece->angle != 0 && time != 0) {
        pl_sincos(piece->angle * time, &s, &c);
    }
    double px = piece->px + piece->dx * time;
    double py = piece->py + piece->dy * time;
    out->count = piece->count;
    for (int i = 0; i < piece->count; ++i) {
        out->rx[i] = c * piece->x[i] - s * piece->y[i];
        out->ry[i] = s * piece->x[i] + c * piece->y[i];
        out->x[i] = px + out->rx[i];
        out->y[i] = py + out->ry[i];
    }
}

//---- the axis -----------------------------------------------------------------------------------

typedef struct axis {
    double distance; // of the cores along it
    double nx, ny;   // from B to A
} axis;

static double lowest(const core *a, double nx, double ny)
{
    double low = HUGE_VAL;
    for (int i = 0; i < a->count; ++i) {
        double v = nx * a->x[i] + ny * a->y[i];
        low = v < low ? v : low;
    }
    return low;
}

// Where the best axis comes from: the edge of `of` from this corner on, its unit normal; -1: the end of a line.
typedef struct origin {
    const core *of, *other;
    int edge;
    double nx, ny;
} origin;

// Tries the unit normal n out of `a` at its value `edge`; `sign` makes it point from B to A.
static bool try_axis(axis *best, const core *other, double edge, double nx, double ny, double sign)
{
    double distance = lowest(other, nx, ny) - edge;
    if (distance > best->distance) {
        *best = (axis){ distance, sign * nx, sign * ny };
        return true;
    }
    return false;
}

// The normals of a's edges, and the ends of a line.
static void try_edges(axis *best, const core *a, const core *other, double sign, origin *from)
{
    for (int i = 0; i < a->count && a->count > 1; ++i) {
        int next = i + 1 == a->count ? 0 : i + 1;
        double ex = a->x[next] - a->x[i];
        double ey = a->y[next] - a->y[i];
        double length = sqrt(ex * ex + ey * ey);
        if (length == 0) {
            continue;
        }
        ex /= length;
        ey /= length;
        if (try_axis(best, other, ey * a->x[i] - ex * a->y[i], ey, -ex, sign)) {
            *from = (origin){ a, other, i, ey, -ex };
        }
        if (a->count == 2 &&
            try_axis(best, other, ex * a->x[next] + ey * a->y[next], ex, ey, sign)) {
            *from = (origin){ a, other, -1, ex, ey };
        }
    }
}

// Whether the nearest corner of the other lies before the edge of the best axis: then that axis tells the distance.
static bool is_before_edge(const origin *o)
{
    if (o->edge < 0) {
        return false;
    }
    const core *a = o->of, *b = o->other;
    const int i = o->edge, next = i + 1 == a->count ? 0 : i + 1;
    int low = 0;
    for (int k = 1; k < b->count; ++k) {
        if (o->nx * (b->x[k] - b->x[low]) + o->ny * (b->y[k] - b->y[low]) < 0) {
            low = k;
        }
    }
    const double ex = a->x[next] - a->x[i], ey = a->y[next] - a->y[i];
    return ex * (b->x[low] - a->x[i]) + ey * (b->y[low] - a->y[i]) >= 0 &&
           ex * (b->x[low] - a->x[next]) + ey * (b->y[low] - a->y[next]) <= 0;
}

typedef struct nearest {
    double square; // [m^2]
    double x, y;   // from the point of `b` to that of `a`
} nearest;

// Every point of `a` against every edge of `b`.
static void try_corners(nearest *best, const core *a, const core *b, double sign)
{
    for (int k = 0; k < b->count; ++k) {
        int next = k + 1 == b->count ? 0 : k + 1;
        double ex = b->x[next] - b->x[k];
        double ey = b->y[next] - b->y[k];
        double length = ex * ex + ey * ey;
        for (int i = 0; i < a->count; ++i) {
            double rx = a->x[i] - b->x[k];
            double ry = a->y[i] - b->y[k];
            double at = length > 0 ? (rx * ex + ry * ey) / length : 0;
            at = at < 0 ? 0 : at > 1 ? 1 : at;
            rx -= at * ex;
            ry -= at * ey;
            double square = rx * rx + ry * ry;
            if (square < best->square) {
                *best = (nearest){ square, sign * rx, sign * ry };
            }
        }
    }
}

// Distances below this have no direction. [m]
#define NO_DIRECTION 1e-12

static axis find_axis(const core *a, const core *b)
{
    axis best = { -HUGE_VAL, 1, 0 };
    origin from = { .edge = -1 };
    try_edges(&best, a, b, -1, &from);
    try_edges(&best, b, a, 1, &from);
    bool points = a->count == 1 && b->count == 1;
    if (points || (best.distance > 0 && !is_before_edge(&from))) {
        nearest n = { HUGE_VAL, 1, 0 };
        try_corners(&n, a, b, 1);
        try_corners(&n, b, a, -1);
        double distance = sqrt(n.square);
        if (distance > NO_DIRECTION && (points || distance > best.distance)) {
            best = (axis){ distance, n.x / distance, n.y / distance };
        } else if (points) {
            best.distance = 0;
        }
    }
    return best;
}

pl_gap pl_sweep_gap(const pl_swept *a, const pl_swept *b, double time)
{
    core at_a, at_b;
    place(a, time, &at_a);
    place(b, time, &at_b);
    axis n = find_axis(&at_a, &at_b);
    return (pl_gap){ n.distance - a->radius - b->radius, n.nx, n.ny };
}

void pl_sweep_point(const pl_swept *piece, double time, double nx, double ny, double *x, double *y)
{
    core at;
    place(piece, time, &at);
    int best = 0;
    for (int i = 1; i < at.count; ++i) {
        if (nx * (at.x[i] - at.x[best]) + ny * (at.y[i] - at.y[best]) > 0) {
            best = i;
        }
    }
    *x = at.x[best] + nx * piece->radius;
    *y = at.y[best] + ny * piece->radius;
}

// [m] corners that reach as far but for this along a normal are an edge across it.
#define LEVEL 1e-7

// How far a core reaches along n, and from where to where across it do the points that reach so far.
typedef struct brink {
    double at, from, to;
} brink;

static brink brink_of(const core *c, double nx, double ny)
{
    brink b = { -HUGE_VAL, HUGE_VAL, -HUGE_VAL };
    for (int i = 0; i < c->count; ++i) {
        b.at = pl_greater(b.at, nx * c->x[i] + ny * c->y[i]);
    }
    for (int i = 0; i < c->count; ++i) {
        if (nx * c->x[i] + ny * c->y[i] >= b.at - LEVEL) {
            double across = nx * c->y[i] - ny * c->x[i];
            b.from = pl_lesser(b.from, across);
            b.to = pl_greater(b.to, across);
        }
    }
    return b;
}

// [m] a whole step by which a point of a piece moves along n.
static double rate_of(const pl_swept *piece, double time, double x, double y, double nx, double ny)
{
    const double rx = x - (piece->px + piece->dx * time), ry = y - (piece->py + piece->dy * time);
    return nx * (piece->dx - piece->angle * ry) + ny * (piece->dy + piece->angle * rx);
}

pl_nearest pl_sweep_nearest(const pl_swept *a, const pl_swept *b, double time)
{
    core at_a, at_b;
    place(a, time, &at_a);
    place(b, time, &at_b);
    axis n = find_axis(&at_a, &at_b);
    brink of_a = brink_of(&at_a, -n.nx, -n.ny), of_b = brink_of(&at_b, n.nx, n.ny);
    // Across it, seen along B's normal; A's runs the other way.
    double across = (pl_greater(-of_a.to, of_b.from) + pl_lesser(-of_a.from, of_b.to)) / 2;
    double along = (of_b.at + b->radius - (of_a.at + a->radius)) / 2;
    const double x = n.nx * along - n.ny * across, y = n.ny * along + n.nx * across;
    return (pl_nearest){ .gap = { n.distance - a->radius - b->radius, n.nx, n.ny },
                         .x = x,
                         .y = y,
                         .opens = rate_of(a, time, x, y, n.nx, n.ny) -
                                  rate_of(b, time, x, y, n.nx, n.ny) };
}

//---- how far time may run -----------------------------------------------------------------------

// A point's value along n, how it changes, and the most that the change can change.
typedef struct track {
    double at, rate, bend;
} track;

// The points of a core along n. Of a piece that does not turn one decides: the nearest to the other.
static int tracks_of(const pl_swept *piece, const core *c, double nx, double ny, double side,
                     track out[CORNERS])
{
    double way = nx * piece->dx + ny * piece->dy;
    double w = piece->angle;
    int count = 0;
    for (int i = 0; i < c->count; ++i) {
        track t = { nx * c->x[i] + ny * c->y[i], way + w * (ny * c->rx[i] - nx * c->ry[i]), 0 };
        if (w == 0) {
            if (count == 0 || side * t.at < side * out[0].at) {
                out[0] = t;
            }
            count = 1;
            continue;
        }
        t.bend = w * w * sqrt(c->rx[i] * c->rx[i] + c->ry[i] * c->ry[i]);
        out[count++] = t;
    }
    return count;
}

// First root of gap + rate t - bend t^2 / 2, gap > 0; without one, very late.
static double time_to_close(double gap, double rate, double bend)
{
    double root = sqrt(rate * rate + 2 * bend * gap);
    if (rate < 0) {
        return 2 * gap / (root - rate);
    }
    return bend > 0 ? (rate + root) / bend : HUGE_VAL;
}

static double time_free(const pl_swept *a, const core *at_a, const pl_swept *b, const core *at_b,
                        const axis *n, double apart)
{
    track of_a[CORNERS], of_b[CORNERS];
    int count_a = tracks_of(a, at_a, n->nx, n->ny, 1, of_a);
    int count_b = tracks_of(b, at_b, n->nx, n->ny, -1, of_b);
    double first = HUGE_VAL;
    for (int i = 0; i < count_a; ++i) {
        for (int k = 0; k < count_b; ++k) {
            double t = time_to_close(of_a[i].at - of_b[k].at - apart, of_a[i].rate - of_b[k].rate,
                                     of_a[i].bend + of_b[k].bend);
            first = t < first ? t : first;
        }
    }
    return first;
}

// Whether the pieces go by one another to one side of their way, as far as can be told at once.
static bool goes_by(const pl_swept *a, const core *at_a, const pl_swept *b, const core *at_b,
                    double apart, double left)
{
    const double dx = a->dx - b->dx, dy = a->dy - b->dy, way = sqrt(dx * dx + dy * dy);
    if (!(way > 0)) {
        return false;
    }
    for (int side = -1; side <= 1; side += 2) {
        const axis n = { 0, side * -dy / way, side * dx / way };
        const double gap = lowest(at_a, n.nx, n.ny) + lowest(at_b, -n.nx, -n.ny);
        if (gap > apart) {
            return !(time_free(a, at_a, b, at_b, &n, apart) < left);
        }
    }
    return false;
}

double pl_sweep_first(const pl_swept *a, const pl_swept *b, double from, double to, double target,
                      double tolerance)
{
    double apart = a->radius + b->radius + target; // of the cores
    double time = from;
    for (int round = 0; round < PL_SWEEP_ROUNDS; ++round) {
        core at_a, at_b;
        place(a, time, &at_a);
        place(b, time, &at_b);
        axis n = find_axis(&at_a, &at_b);
        if (!(n.distance > apart + tolerance)) {
            return time;
        }
        time += time_free(a, &at_a, b, &at_b, &n, apart);
        if (!(time < to) || (round == 0 && goes_by(a, &at_a, b, &at_b, apart, to - from))) {
            return PL_SWEEP_NEVER;
        }
    }
    return time;
}
