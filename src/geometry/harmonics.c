// harmonics.c - see harmonics.h.
//
// Reads, writes: what it is given. Cost: an exponential and a sine a corner to open; O(corners) a harmonic.
#include "geometry/harmonics.h"

#include "math/decay.h"
#include "math/trig.h"

#include <math.h>

typedef struct point {
    double x, z;
} point;

typedef struct corners {
    point at[PL_HARMONICS_MOST];
    int count;
} corners;

static double depth_of(const pl_depths *where, double x, double y, bool mirrored)
{
    const double z = where->up * (where->py + y) - where->slope * (where->px + x);
    return mirrored ? -z - 2 * where->bottom : z;
}

static void add(corners *out, double x, double y, const pl_depths *where, bool mirrored)
{
    const double z = depth_of(where, x, y, mirrored), least = mirrored ? -2 * where->bottom : 0;
    const bool above = mirrored ? z < least : z > least; // rounding: it was cut there
    out->at[out->count++] = (point){ where->px + x, above ? least : z };
}

static void add_arc(corners *out, const pl_element *e, const pl_element *next,
                    const pl_depths *where, bool mirrored)
{
    const double ux = e->x - e->cx, uy = e->y - e->cy, vx = next->x - e->cx, vy = next->y - e->cy;
    const double turn = pl_atan2(ux * vy - uy * vx, ux * vx + uy * vy);
    const double angle = turn < 0 ? turn + 6.283185307179586 : turn;
    const int chords = 1 + (int)(angle * PL_CHORDS_OF_TURN / 6.2831853072);
    for (int i = 0; i < chords && out->count < PL_HARMONICS_MOST; ++i) {
        double s, c;
        pl_sincos(angle * i / chords, &s, &c);
        add(out, e->cx + c * ux - s * uy, e->cy + s * ux + c * uy, where, mirrored);
    }
}

static double area_of(const corners *all)
{
    double sum = 0;
    const point o = all->at[0];
    for (int i = 0; i < all->count; ++i) {
        const point p = all->at[i], q = all->at[i + 1 < all->count ? i + 1 : 0];
        sum += (p.x - o.x) * (q.z - o.z) - (q.x - o.x) * (p.z - o.z);
    }
    return sum / 2;
}

// dz / (dx - i dz); 0 of no edge.
static pl_complex slant(point p, point q)
{
    const double dx = q.x - p.x, dz = q.z - p.z, square = dx * dx + dz * dz;
    return square > 0 ? (pl_complex){ dz * dx / square, dz * dz / square } : (pl_complex){ 0, 0 };
}

void pl_harmonics_open(const pl_contour *outline, const pl_depths *where, bool mirrored, double k,
                       pl_harmonics *out)
{
    corners all = { .count = 0 };
    for (int i = 0; i < outline->count; ++i) {
        const pl_element *e = &outline->at[i];
        if (e->r > 0) {
            add_arc(&all, e, &outline->at[i + 1 < outline->count ? i + 1 : 0], where, mirrored);
        } else {
            add(&all, e->x, e->y, where, mirrored);
        }
    }
    *out = (pl_harmonics){ .k = k };
    const double area = all.count > 2 ? area_of(&all) : 0;
    if (area == 0) {
        return;
    }
    // Mirrored, or where up is downwards, corners go round clockwise: the sign of the area.
    out->scale = fabs(pl_contour_area(outline).area) / area;
    const double middle = depth_of(where, 0, 0, mirrored);
    pl_complex before = slant(all.at[all.count - 1], all.at[0]);
    for (int i = 0; i < all.count; ++i) {
        const point p = all.at[i];
        const pl_complex c = slant(p, all.at[i + 1 < all.count ? i + 1 : 0]);
        double s, co;
        pl_sincos(k * p.x, &s, &co);
        const double left = pl_decay_of(-k * p.z).left;
        const pl_complex d = { before.re - c.re, before.im - c.im };
        const pl_complex from = { p.x - where->px, middle - p.z };
        out->at[out->count++] =
            (pl_harmonic_corner){ d, pl_times(d, from), { left * co, left * s }, { 1, 0 } };
        before = c;
    }
}

pl_harmonic pl_harmonics_next(pl_harmonics *h)
{
    pl_complex sum = { 0, 0 }, moment = { 0, 0 };
    const double k = h->k * ++h->number, by = -h->scale / (k * k);
    for (int i = 0; i < h->count; ++i) {
        pl_harmonic_corner *c = &h->at[i];
        c->power = pl_times(c->power, c->base);
        const pl_complex part = pl_times(c->weight, c->power);
        const pl_complex arm = pl_times(c->moment, c->power);
        sum = (pl_complex){ sum.re + part.re, sum.im + part.im };
        moment = (pl_complex){ moment.re + arm.re, moment.im + arm.im };
    }
    return (
        pl_harmonic){ { by * sum.re, by * sum.im },
                      { by * (moment.re - 2 / k * sum.im), by * (moment.im + 2 / k * sum.re) } };
}
