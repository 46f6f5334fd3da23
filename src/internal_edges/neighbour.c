// neighbour.c - a convex core against a corner or an edge of its neighbour.
//
// A corner p of the ground allows the normal n when nothing solid lies in front of it: (q - p) . n
// <= 0 for all q of the ground near p. Each piece that has p says so for itself: a corner of it allows
// the arc between the normals of its two edges, a point of its edge that edge's normal, its inside
// none. What all of them allow is what the ground allows (README.md).
//
// Cost: O(corners) a call.
#include "internal_edges/neighbour.h"

#include <math.h>

#define WALL_LEAST 1e-3 // [rad] as PL_EDGE_ANGLE

static int after(const pl_outline *o, int k)
{
    return k + 1 < o->count ? k + 1 : 0;
}

static int before(const pl_outline *o, int k)
{
    return k > 0 ? k - 1 : o->count - 1;
}

// How far (x, y) lies in front of edge k.
static double ahead(const pl_outline *o, int k, double x, double y)
{
    return (x - o->x[k]) * o->nx[k] + (y - o->y[k]) * o->ny[k];
}

double pl_outline_edge_length(const pl_outline *o, int k)
{
    double x = o->x[after(o, k)] - o->x[k], y = o->y[after(o, k)] - o->y[k];
    return sqrt(x * x + y * y);
}

pl_cone pl_outline_cone(const pl_outline *o, int k)
{
    int b = before(o, k);
    return (pl_cone){ o->nx[b], o->ny[b], o->nx[k], o->ny[k], PL_CONE_ARC };
}

static pl_cone edge_cone(const pl_outline *o, int k)
{
    return (pl_cone){ o->nx[k], o->ny[k], o->nx[k], o->ny[k], PL_CONE_ARC };
}

// A line has two sides and no inside.
static bool line_cone_at(const pl_outline *o, double x, double y, double slop, pl_cone *cone)
{
    double length = pl_outline_edge_length(o, 0);
    double along = (y - o->y[0]) * o->nx[0] - (x - o->x[0]) * o->ny[0];
    if (fabs(ahead(o, 0, x, y)) > slop || along < -slop || along > length + slop) {
        return false;
    }
    if (along < slop || along > length - slop) {
        *cone = pl_outline_cone(o, along < slop ? 0 : 1);
    } else {
        *cone = (pl_cone){ o->nx[0], o->ny[0], o->nx[1], o->ny[1], PL_CONE_ENDS };
    }
    return true;
}

bool pl_outline_cone_at(const pl_outline *o, double x, double y, double slop, pl_cone *cone)
{
    if (o->count == 2) {
        return line_cone_at(o, x, y, slop, cone);
    }
    unsigned near = 0;
    int corner = -1, edge = -1;
    double nearest = 0;
    for (int k = 0; k < o->count; ++k) {
        double d = ahead(o, k, x, y);
        if (d > slop) {
            return false;
        }
        if (d >= -slop) {
            near |= 1u << k;
            edge = k;
        }
    }
    for (int k = 0; k < o->count; ++k) {
        if ((near >> k & 1) && (near >> before(o, k) & 1)) {
            double dx = x - o->x[k], dy = y - o->y[k];
            double square = dx * dx + dy * dy;
            if (corner < 0 || square < nearest) {
                corner = k;
                nearest = square;
            }
        }
    }
    if (corner < 0) {
        *cone = edge < 0 ? (pl_cone){ 0 } : edge_cone(o, edge);
        return true;
    }
    // In front of a sharp corner the two edges alone would reach far.
    if (ahead(o, corner, x, y) > 0 && ahead(o, before(o, corner), x, y) > 0 &&
        nearest > 4 * slop * slop) {
        return false;
    }
    *cone = pl_outline_cone(o, corner);
    return true;
}

// The face with normal m runs along left(m); its part before the corner bounds the free space of an
// edge that starts there, the part behind it that of one that ends.
static void add_wall(pl_wall *wall, double mx, double my, double nx, double ny, bool starts)
{
    double sign = starts ? 1 : -1;
    double fx = sign * my, fy = -sign * mx; // from the corner along the face
    double ex = -sign * ny, ey = sign * nx; // from the corner along the edge
    double rise = fx * nx + fy * ny, flatness = fx * ex + fy * ey;
    bool none = wall->nx == 0 && wall->ny == 0;
    if (rise > WALL_LEAST && (none || flatness > wall->flatness)) {
        *wall = (pl_wall){ mx, my, flatness };
    }
}

void pl_wall_meet(pl_wall *wall, const pl_cone *has, double nx, double ny, bool starts)
{
    if (has->form == PL_CONE_NONE) {
        return;
    }
    if (starts || has->form == PL_CONE_ENDS) {
        add_wall(wall, has->lo_x, has->lo_y, nx, ny, starts);
    }
    if (!starts || has->form == PL_CONE_ENDS) {
        add_wall(wall, has->hi_x, has->hi_y, nx, ny, starts);
    }
}

// Share of the slop within which what lies in front of an edge lies on its line: a neighbour that is
// flush with the edge does not cover it.
#define ON_LINE 0.01

bool pl_outline_covers(const pl_outline *o, const pl_outline *edge_of, int edge, double slop,
                       double *from, double *to)
{
    double nx = edge_of->nx[edge], ny = edge_of->ny[edge], near = ON_LINE * slop;
    double u[PLUMB_POLYGON_MAX_VERTICES], least = INFINITY, most = -INFINITY;
    for (int k = 0; k < o->count; ++k) {
        u[k] = (o->x[k] - edge_of->x[edge]) * nx + (o->y[k] - edge_of->y[edge]) * ny;
        least = u[k] < least ? u[k] : least;
        most = u[k] > most ? u[k] : most;
    }
    if (o->count == 2 || most < near || least > slop) {
        return false; // a line covers nothing; the rest lies behind the edge, or far in front
    }
    // Where the part of the core at heights near..slop lies along the edge.
    double low = INFINITY, high = -INFINITY;
    for (int k = 0; k < o->count; ++k) {
        int next = after(o, k);
        double u0 = u[k], u1 = u[next];
        if ((u0 < near && u1 < near) || (u0 > slop && u1 > slop)) {
            continue;
        }
        double v0 = (o->y[k] - edge_of->y[edge]) * nx - (o->x[k] - edge_of->x[edge]) * ny;
        double v1 = (o->y[next] - edge_of->y[edge]) * nx - (o->x[next] - edge_of->x[edge]) * ny;
        double rate = u1 == u0 ? 0 : (v1 - v0) / (u1 - u0);
        double p = v0 + rate * (pl_lesser(pl_greater(u0, near), slop) - u0);
        double q = v1 + rate * (pl_lesser(pl_greater(u1, near), slop) - u1);
        low = pl_lesser(low, pl_lesser(p, q));
        high = pl_greater(high, pl_greater(p, q));
    }
    double length = pl_outline_edge_length(edge_of, edge);
    low = pl_greater(low, 0);
    high = pl_lesser(high, length);
    if (!(high - low >= pl_lesser(slop, length / 2))) {
        return false; // it lies beside the edge, or touches it at a corner
    }
    *from = pl_greater(0, low - slop);
    *to = pl_lesser(length, high + slop);
    return true;
}
