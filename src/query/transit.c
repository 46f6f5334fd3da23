// transit.c - see transit.h.
//
// An edge is crossed where its two ends lie on different sides of the line: of edges that share an end one is, whatever
// rounding does. A rounded shape is the union of the full discs about its corners, its edges moved out and its core, so a line comes in
// where it first meets one of the two, and goes out where it last does.
//
// Reads: arguments. Writes: the answer. Cost: O(corners), a root a corner where it is rounded.
#include "query/transit.h"

#include "query/query.h"

#include <math.h>

void pl_transit_round(const plumb_convex *convex, plumb_transform t, double x, double y,
                      pl_round *out)
{
    const double c = (double)t.q.c, s = (double)t.q.s, size = sqrt(c * c + s * s);
    const double px = (double)t.p.x - x, py = (double)t.p.y - y;
    out->count = convex->count;
    out->radius = (double)convex->radius;
    for (int i = 0; i < convex->count; ++i) {
        const double lx = (double)convex->points[i].x, ly = (double)convex->points[i].y;
        out->x[i] = (c * lx - s * ly) / size + px;
        out->y[i] = (s * lx + c * ly) / size + py;
    }
}

static void come_in(pl_transit *transit, double t, double nx, double ny)
{
    if (t < transit->enter) {
        transit->enter = t;
        transit->enter_x = nx;
        transit->enter_y = ny;
    }
}

static void go_out(pl_transit *transit, double t, double nx, double ny)
{
    if (t > transit->leave) {
        transit->leave = t;
        transit->leave_x = nx;
        transit->leave_y = ny;
    }
}

// The edge from a to b of a shape that lies to its left.
static void cross_edge(pl_transit *transit, double dx, double dy, double ax, double ay, double bx,
                       double by)
{
    const double a = dx * ay - dy * ax, b = dx * by - dy * bx; // how far to the left of the line
    if ((a >= 0) == (b >= 0)) {
        return;
    }
    const double ex = bx - ax, ey = by - ay, length = sqrt(ex * ex + ey * ey);
    const double at_a = dx * ax + dy * ay, along = dx * ex + dy * ey;
    const double t = at_a + along * (a / (a - b));
    if (b < a) {
        come_in(transit, t, ey / length, -ex / length);
    } else {
        go_out(transit, t, ey / length, -ex / length);
    }
}

static void cross_disc(pl_transit *transit, double dx, double dy, double x, double y, double radius)
{
    const double off = dx * y - dy * x, along = dx * x + dy * y;
    const double half_sq = (radius - off) * (radius + off);
    if (!(half_sq >= 0)) {
        return;
    }
    const double half = sqrt(half_sq);
    const double across_x = off * dy, across_y = -off * dx; // from the centre to the line
    come_in(transit, along - half, (across_x - half * dx) / radius,
            (across_y - half * dy) / radius);
    go_out(transit, along + half, (across_x + half * dx) / radius, (across_y + half * dy) / radius);
}

// A line of no thickness is one edge, met from either side.
static bool cross_line(const pl_round *r, double dx, double dy, pl_transit *out)
{
    cross_edge(out, dx, dy, r->x[0], r->y[0], r->x[1], r->y[1]);
    if (out->enter < HUGE_VAL) {
        go_out(out, out->enter, -out->enter_x, -out->enter_y);
    } else if (out->leave > -HUGE_VAL) {
        come_in(out, out->leave, -out->leave_x, -out->leave_y);
    }
    return out->enter <= out->leave;
}

bool pl_transit_of(const pl_round *r, double dx, double dy, pl_transit *out)
{
    *out = (pl_transit){ .enter = HUGE_VAL, .leave = -HUGE_VAL };
    if (r->count == 2 && r->radius == 0) {
        return cross_line(r, dx, dy, out);
    }
    for (int i = 0; i < r->count; ++i) {
        const int next = i + 1 == r->count ? 0 : i + 1;
        double mx = 0, my = 0;
        if (r->radius > 0) {
            const double ex = r->x[next] - r->x[i], ey = r->y[next] - r->y[i];
            const double length = sqrt(ex * ex + ey * ey);
            mx = length > 0 ? r->radius * ey / length : 0;
            my = length > 0 ? -r->radius * ex / length : 0;
            cross_disc(out, dx, dy, r->x[i], r->y[i], r->radius);
        }
        if (r->count > 1) {
            cross_edge(out, dx, dy, r->x[i] + mx, r->y[i] + my, r->x[next] + mx, r->y[next] + my);
        }
    }
    return out->enter <= out->leave;
}

bool pl_transit_holds(const pl_round *r)
{
    bool in_core = r->count > 2;
    double nearest_sq = HUGE_VAL;
    for (int i = 0; i < r->count; ++i) {
        const int next = i + 1 == r->count ? 0 : i + 1;
        const double ex = r->x[next] - r->x[i], ey = r->y[next] - r->y[i];
        const double length_sq = ex * ex + ey * ey;
        // From corner i to the origin.
        in_core = in_core && ey * r->x[i] - ex * r->y[i] >= 0;
        const double t = length_sq > 0 ? -(r->x[i] * ex + r->y[i] * ey) / length_sq : 0;
        const double share = pl_least(pl_most(t, 0), 1);
        const double nx = r->x[i] + share * ex, ny = r->y[i] + share * ey;
        nearest_sq = pl_least(nearest_sq, nx * nx + ny * ny);
    }
    return in_core || (r->radius > 0 && nearest_sq <= r->radius * r->radius);
}
