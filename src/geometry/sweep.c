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

#include "math/compare.h"
#include "math/trig.h"

#include <math.h>

#define CORNERS PLUMB_POLYGON_MAX_VERTICES

// [-], [m] roots are looked at although they are later by so little: rounding does not decide.
#define MARGIN 1e-12

typedef pl_swept_core core;

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

// The unit directions of its edges; (0, 0) where two points are one.
static void find_edges(core *c)
{
    for (int i = 0; i < c->count && c->count > 1; ++i) {
        const int next = i + 1 == c->count ? 0 : i + 1;
        const double ex = c->x[next] - c->x[i], ey = c->y[next] - c->y[i];
        const double length = sqrt(ex * ex + ey * ey);
        c->ex[i] = length == 0 ? 0 : ex / length;
        c->ey[i] = length == 0 ? 0 : ey / length;
    }
}

//---- the axis -----------------------------------------------------------------------------------

typedef pl_swept_axis axis;

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

// Whether the other core lies farther out along n than `best`, from the value `edge`; `distance`: how far.
static bool is_farther(const core *other, double edge, double nx, double ny, double best,
                       double *distance)
{
    double low = HUGE_VAL;
    for (int i = 0; i < other->count; ++i) {
        const double v = nx * other->x[i] + ny * other->y[i];
        if (!(v - edge > best)) {
            return false; // nor would the lowest be
        }
        low = v < low ? v : low;
    }
    *distance = low - edge;
    return true;
}

// The normals of a's edges, and the ends of a line. `sign` makes them point from B to A.
static void try_edges(axis *best, const core *a, const core *other, double sign, origin *from)
{
    for (int i = 0; i < a->count && a->count > 1; ++i) {
        const double ex = a->ex[i], ey = a->ey[i];
        if (ex == 0 && ey == 0) {
            continue;
        }
        double distance;
        if (is_farther(other, ey * a->x[i] - ex * a->y[i], ey, -ex, best->distance, &distance)) {
            *best = (axis){ distance, sign * ey, sign * -ex };
            *from = (origin){ a, other, i, ey, -ex };
        }
        const int next = 1 - i;
        if (a->count == 2 && is_farther(other, ex * a->x[next] + ey * a->y[next], ex, ey,
                                        best->distance, &distance)) {
            *best = (axis){ distance, sign * ex, sign * ey };
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
// [m] by which corners must be farther apart than edges tell: their direction is as wrong as rounding is large beside the
// distance, and a face of kilometres reaches millimetres beyond where it says.
#define CORNERS_TELL 1e-9

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
        if (distance > NO_DIRECTION && (points || distance > best.distance + CORNERS_TELL)) {
            best = (axis){ distance, n.x / distance, n.y / distance };
        } else if (points) {
            best.distance = 0;
        }
    }
    return best;
}

//---- a pair at one time ----------------------------------------------------------------------------

void pl_sweep_open(pl_sweep *s, const pl_swept *a, const pl_swept *b)
{
    s->piece[0] = a, s->piece[1] = b;
    s->placed = s->has_axis = false;
}

static bool is_still(const pl_swept *piece)
{
    return piece->dx == 0 && piece->dy == 0 && piece->angle == 0;
}

static void place_both(pl_sweep *s, double time)
{
    if (s->placed && s->time == time) {
        return;
    }
    for (int i = 0; i < 2; ++i) {
        if (!s->placed || !is_still(s->piece[i])) {
            place(s->piece[i], time, &s->at[i]);
            s->has_edges[i] = false;
        }
    }
    s->placed = true;
    s->time = time;
}

static void find_axis_at(pl_sweep *s, double time)
{
    place_both(s, time);
    if (s->has_axis && s->axis_time == time) {
        return;
    }
    for (int i = 0; i < 2; ++i) {
        if (!s->has_edges[i]) {
            find_edges(&s->at[i]);
            s->has_edges[i] = true;
        }
    }
    s->axis = find_axis(&s->at[0], &s->at[1]);
    s->has_axis = true;
    s->axis_time = time;
}

static pl_gap gap_of(const pl_sweep *s)
{
    return (pl_gap){ s->axis.distance - s->piece[0]->radius - s->piece[1]->radius, s->axis.nx,
                     s->axis.ny };
}

pl_gap pl_sweep_gap_at(pl_sweep *s, double time)
{
    find_axis_at(s, time);
    return gap_of(s);
}

pl_gap pl_sweep_gap(const pl_swept *a, const pl_swept *b, double time)
{
    pl_sweep s;
    pl_sweep_open(&s, a, b);
    return pl_sweep_gap_at(&s, time);
}

void pl_sweep_point(const pl_swept *piece, double time, double nx, double ny, double *x, double *y)
{
    core at;
    at.x[0] = at.y[0] = 0; // a piece has a point, which GCC does not know
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

pl_nearest pl_sweep_nearest_at(pl_sweep *s, double time)
{
    find_axis_at(s, time);
    const pl_swept *a = s->piece[0], *b = s->piece[1];
    const axis n = s->axis;
    brink of_a = brink_of(&s->at[0], -n.nx, -n.ny), of_b = brink_of(&s->at[1], n.nx, n.ny);
    // Across it, seen along B's normal; A's runs the other way.
    double across = (pl_greater(-of_a.to, of_b.from) + pl_lesser(-of_a.from, of_b.to)) / 2;
    double along = (of_b.at + b->radius - (of_a.at + a->radius)) / 2;
    const double x = n.nx * along - n.ny * across, y = n.ny * along + n.nx * across;
    return (pl_nearest){ .gap = gap_of(s),
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

// How long every point of A stays beyond every point of B by `apart` along n, if that is less than `left`; else for ever.
static double time_free(const pl_sweep *s, const axis *n, double apart, double left)
{
    track of_a[CORNERS], of_b[CORNERS];
    const int count_a = tracks_of(s->piece[0], &s->at[0], n->nx, n->ny, 1, of_a);
    const int count_b = tracks_of(s->piece[1], &s->at[1], n->nx, n->ny, -1, of_b);
    double first = left * (1 + MARGIN);
    bool any = false;
    for (int i = 0; i < count_a; ++i) {
        for (int k = 0; k < count_b; ++k) {
            // Rounding may have closed it, by more than a tolerance where pieces are large.
            const double gap = pl_greater(of_a[i].at - of_b[k].at - apart, 0);
            const double rate = of_a[i].rate - of_b[k].rate, bend = of_a[i].bend + of_b[k].bend;
            if (gap + (rate - bend / 2 * first) * first > MARGIN) {
                continue; // still apart at the first root of those before
            }
            const double t = time_to_close(gap, rate, bend);
            any = any || t < first;
            first = t < first ? t : first;
        }
    }
    return any ? first : HUGE_VAL;
}

// [m] how far the pieces go by one another to one side of their way, as far as can be told at once, if that is more than
// `apart`; else `apart`.
static double passes_by(const pl_sweep *s, double apart, double left)
{
    const pl_swept *a = s->piece[0], *b = s->piece[1];
    const double dx = a->dx - b->dx, dy = a->dy - b->dy, way = sqrt(dx * dx + dy * dy);
    if (!(way > 0)) {
        return apart;
    }
    for (int side = -1; side <= 1; side += 2) {
        const axis n = { 0, side * -dy / way, side * dx / way };
        const double gap = lowest(&s->at[0], n.nx, n.ny) + lowest(&s->at[1], -n.nx, -n.ny);
        if (gap > apart) {
            return time_free(s, &n, apart, left) < left ? apart : gap;
        }
    }
    return apart;
}

//---- what turns several times about ----------------------------------------------------------------

// [rad] of a leg from there on a piece is asked first how far its corners reach at all.
#define WHIRLS (2 * (double)PLUMB_PI)

double pl_swept_reach(const pl_swept *piece)
{
    double square = 0;
    for (int i = 0; i < piece->count; ++i) {
        square = pl_greater(square, piece->x[i] * piece->x[i] + piece->y[i] * piece->y[i]);
    }
    return sqrt(square) + piece->radius;
}

// What a piece passes over while it turns, as one that does not.
static pl_swept whirl_of(const pl_swept *piece)
{
    pl_swept disc = *piece;
    disc.count = 1;
    disc.x[0] = disc.y[0] = disc.angle = 0;
    disc.radius = pl_swept_reach(piece);
    return disc;
}

static bool is_whirling(const pl_swept *piece)
{
    return fabs(piece->angle) > WHIRLS;
}

// A time until which nothing comes near, however it is turned; above 1: nothing does.
static double out_of_reach(const pl_sweep *s, double from, double to, double target,
                           double tolerance)
{
    pl_swept disc[2];
    const pl_swept *piece[2];
    for (int i = 0; i < 2; ++i) {
        piece[i] = s->piece[i];
        if (is_whirling(piece[i])) {
            disc[i] = whirl_of(piece[i]);
            piece[i] = &disc[i];
        }
    }
    return pl_sweep_first(piece[0], piece[1], from, to, target, tolerance);
}

//---- the first time --------------------------------------------------------------------------------

double pl_sweep_first_of(pl_sweep *s, double from, double to, double target, double tolerance)
{
    if (is_whirling(s->piece[0]) || is_whirling(s->piece[1])) {
        from = out_of_reach(s, from, to, target, tolerance);
        if (!(from < to)) {
            return PL_SWEEP_NEVER;
        }
    }
    const double apart = s->piece[0]->radius + s->piece[1]->radius + target; // of the cores
    place_both(s, from);
    // First, as it costs little.
    const double by = passes_by(s, apart, to - from);
    if (by > apart + tolerance) {
        return PL_SWEEP_NEVER;
    }
    double time = from;
    for (int round = 0; round < PL_SWEEP_ROUNDS; ++round) {
        find_axis_at(s, time);
        if (!(s->axis.distance > apart + tolerance)) {
            return time;
        }
        time += time_free(s, &s->axis, apart, to - time);
        if (!(time < to) || by > apart) {
            return PL_SWEEP_NEVER;
        }
    }
    return time;
}

double pl_sweep_first(const pl_swept *a, const pl_swept *b, double from, double to, double target,
                      double tolerance)
{
    pl_sweep s;
    pl_sweep_open(&s, a, b);
    return pl_sweep_first_of(&s, from, to, target, tolerance);
}
