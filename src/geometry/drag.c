// drag.c - drag on the elements of an outline (immersed.h).
//
// Along an edge v . n is linear and v . t the same everywhere; it is divided where v . n changes its sign, and of
// what is left the integrand is of third degree: Gauss's rule of two points is exact. On an arc, with u the velocity of
// its centre, v . n = u . n and v . t = u . t + w r: both are linear in the normal, as N and T are, so that
// all follows from the moments of (n_x, n_y, 1) up to the third, between the zeros of v . n or v . t.
//
// Reads: an outline. Writes: a matrix. Cost: O(elements); an arc that has skin drag takes an arc tangent.
#include "geometry/immersed.h"

#include "math/trig.h"

#include <math.h>

// Adds weight times the square of a vector.
static void add(pl_drag *d, double weight, double x, double y, double w)
{
    d->xx += weight * x * x;
    d->xy += weight * x * y;
    d->yy += weight * y * y;
    d->xw += weight * x * w;
    d->yw += weight * y * w;
    d->ww += weight * w * w;
}

//---- edges ---------------------------------------------------------------------------------------

static void drag_edge(const pl_element *e, const pl_element *next, const pl_spin *v,
                      double pressure, double skin, pl_drag *drag)
{
    const double dx = next->x - e->x, dy = next->y - e->y, length = sqrt(dx * dx + dy * dy);
    if (!(length > 0)) {
        return;
    }
    const double tx = dx / length, ty = dy / length;
    // p x n = -p . t; p x t is the same all along.
    const double along = e->x * tx + e->y * ty, arm = e->x * ty - e->y * tx;
    const double vn = v->vx * ty - v->vy * tx, slope = -v->w; // at p . t = 0; by the metre
    const double slide = v->vx * tx + v->vy * ty + v->w * arm;
    add(drag, skin * fabs(slide) * length, tx, ty, arm);
    double from = along, to = along + length;
    const double at_from = vn + slope * from, at_to = vn + slope * to;
    if (at_from <= 0 && at_to <= 0) {
        return;
    }
    if (at_from < 0) {
        from = -vn / slope;
    } else if (at_to < 0) {
        to = -vn / slope;
    }
    const double middle = (from + to) / 2, half = (to - from) / 2, node = half / sqrt(3.0);
    for (int side = -1; side <= 1; side += 2) {
        const double s = middle + side * node, speed = vn + slope * s;
        add(drag, pressure * (speed > 0 ? speed : 0) * half, ty, -tx, -s);
    }
}

//---- arcs ----------------------------------------------------------------------------------------

// An arc's radius vectors are r n; its velocities and forces are linear in q = (n_x, n_y, 1).
typedef struct arc {
    double a[3];      // speed: a . q
    double map[3][3]; // q to (x, y, w)
    double r;         // [m]
    double weight;    // [kg/m^2]
    bool ahead;       // where the speed is negative there is no drag
} arc;

// Integrals of n_x^i n_y^k over the angle from one unit vector to another, less than pi on.
typedef struct moments {
    double m[4][4];
} moments;

static moments moments_of(const double p[2], const double q[2])
{
    const double c0 = p[0], s0 = p[1], c1 = q[0], s1 = q[1];
    const double angle = pl_atan2(c0 * s1 - s0 * c1, c0 * c1 + s0 * s1);
    const double ds = s1 - s0, dc = c1 - c0;
    const double sss = (s1 * s1 * s1 - s0 * s0 * s0) / 3, ccc = (c1 * c1 * c1 - c0 * c0 * c0) / 3;
    const double sc = (s1 * c1 - s0 * c0) / 2;
    moments of = { { { 0 } } };
    of.m[0][0] = angle;
    of.m[1][0] = ds;
    of.m[0][1] = -dc;
    of.m[2][0] = angle / 2 + sc;
    of.m[0][2] = angle / 2 - sc;
    of.m[1][1] = (s1 * s1 - s0 * s0) / 2;
    of.m[3][0] = ds - sss;
    of.m[1][2] = sss;
    of.m[2][1] = -ccc;
    of.m[0][3] = ccc - dc;
    return of;
}

// The part between two unit vectors, where the speed does not change its sign.
static void drag_part(const arc *a, const double p[2], const double q[2], pl_drag *drag)
{
    const double mx = p[0] + q[0], my = p[1] + q[1], length = sqrt(mx * mx + my * my);
    const double middle = length > 0 ? (a->a[0] * mx + a->a[1] * my) / length + a->a[2] : 0;
    if (middle == 0 || (middle < 0 && a->ahead)) {
        return;
    }
    const moments of = moments_of(p, q);
    static const int power[3][2] = { { 1, 0 }, { 0, 1 }, { 0, 0 } };
    const double weight = (middle < 0 ? -1 : 1) * a->weight * a->r;
    double s[3][3], sb[3][3], d[3][3];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            s[i][j] = 0;
            for (int k = 0; k < 3; ++k) {
                const int x = power[i][0] + power[j][0] + power[k][0];
                const int y = power[i][1] + power[j][1] + power[k][1];
                s[i][j] += a->a[k] * of.m[x][y];
            }
        }
    }
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            sb[i][j] = s[i][0] * a->map[j][0] + s[i][1] * a->map[j][1] + s[i][2] * a->map[j][2];
        }
    }
    for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
            d[i][j] = a->map[i][0] * sb[0][j] + a->map[i][1] * sb[1][j] + a->map[i][2] * sb[2][j];
        }
    }
    drag->xx += weight * d[0][0];
    drag->xy += weight * d[0][1];
    drag->yy += weight * d[1][1];
    drag->xw += weight * d[0][2];
    drag->yw += weight * d[1][2];
    drag->ww += weight * d[2][2];
}

// Divided where the speed is 0.
static void drag_arc(const arc *a, const double p[2], const double q[2], pl_drag *drag)
{
    const double square = a->a[0] * a->a[0] + a->a[1] * a->a[1], b = a->a[2];
    const double under = square - b * b;
    double at[4][2] = { { p[0], p[1] } };
    int count = 1;
    for (int side = -1; side <= 1 && under > 0; side += 2) {
        const double root = side * sqrt(under);
        const double x = (-b * a->a[0] - root * a->a[1]) / square;
        const double y = (-b * a->a[1] + root * a->a[0]) / square;
        if (p[0] * y - p[1] * x > 0 && x * q[1] - y * q[0] > 0) {
            at[count][0] = x, at[count++][1] = y;
        }
    }
    if (count == 3 && at[1][0] * at[2][1] - at[1][1] * at[2][0] < 0) {
        const double x = at[1][0], y = at[1][1];
        at[1][0] = at[2][0], at[1][1] = at[2][1];
        at[2][0] = x, at[2][1] = y;
    }
    at[count][0] = q[0], at[count][1] = q[1];
    for (int i = 0; i < count; ++i) {
        drag_part(a, at[i], at[i + 1], drag);
    }
}

static void drag_round(const pl_element *e, const pl_element *next, const pl_spin *v,
                       double pressure, double skin, pl_drag *drag)
{
    const double p[2] = { (e->x - e->cx) / e->r, (e->y - e->cy) / e->r };
    const double q[2] = { (next->x - e->cx) / e->r, (next->y - e->cy) / e->r };
    const double ux = v->vx - v->w * e->cy, uy = v->vy + v->w * e->cx;
    const arc ahead = { .a = { ux, uy, 0 },
                        .map = { { 1, 0, 0 }, { 0, 1, 0 }, { -e->cy, e->cx, 0 } },
                        .r = e->r,
                        .weight = pressure,
                        .ahead = true };
    const arc slide = { .a = { uy, -ux, v->w * e->r },
                        .map = { { 0, -1, 0 }, { 1, 0, 0 }, { e->cx, e->cy, e->r } },
                        .r = e->r,
                        .weight = skin };
    if (pressure > 0) {
        drag_arc(&ahead, p, q, drag);
    }
    if (skin > 0) {
        drag_arc(&slide, p, q, drag);
    }
}

void pl_element_drag(const pl_element *e, const pl_element *next, pl_spin v, double pressure,
                     double skin, pl_drag *drag)
{
    if (e->r > 0) {
        drag_round(e, next, &v, pressure, skin, drag);
    } else {
        drag_edge(e, next, &v, pressure, skin, drag);
    }
}

void pl_contour_drag(const pl_contour *o, pl_spin v, double pressure, double skin, pl_drag *drag)
{
    for (int i = 0; i < o->count; ++i) {
        const pl_element *e = &o->at[i], *next = &o->at[i + 1 == o->count ? 0 : i + 1];
        if (!e->cut && !e->inner) {
            pl_element_drag(e, next, v, pressure, skin, drag);
        }
    }
}

void pl_drag_force(const pl_drag *d, pl_spin v, double force[3])
{
    force[0] -= (d->xx * v.vx + d->xy * v.vy + d->xw * v.w) / 2;
    force[1] -= (d->xy * v.vx + d->yy * v.vy + d->yw * v.w) / 2;
    force[2] -= (d->xw * v.vx + d->yw * v.vy + d->ww * v.w) / 2;
}
