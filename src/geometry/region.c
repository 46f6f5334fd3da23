// region.c - convex polygons in double that are cut by lines.
//
// Reads: its arguments. Writes: the region. Cost: O(corners), pl_region_diameter O(corners^2).
#include "geometry/region.h"

#include "math/trig.h"
#include "plumb/math.h"

#include <math.h>

#define PI 3.14159265358979323846

static void add(pl_region *r, double x, double y, bool inner)
{
    r->x[r->count] = x;
    r->y[r->count] = y;
    r->inner[r->count++] = inner;
}

//---- of a shape ----------------------------------------------------------------------------------

// Corners on the arc around core point k, from the direction of normal `from` over `angle`.
static void add_arc(pl_region *r, const plumb_convex *c, int k, plumb_vec2 from, double angle)
{
    const int chords = (int)ceil(angle * (PL_REGION_CHORDS / (2 * PI)) - 1e-6);
    const int n = chords > 1 ? chords : 1;
    for (int i = 0; i <= n; ++i) {
        double sine, cosine;
        pl_sincos(angle * i / n, &sine, &cosine);
        const double x = (double)from.x * cosine - (double)from.y * sine;
        const double y = (double)from.x * sine + (double)from.y * cosine;
        add(r, (double)c->points[k].x + (double)c->radius * x,
            (double)c->points[k].y + (double)c->radius * y, false);
    }
}

// [rad] 0..2 pi from one direction to another, counter-clockwise.
static double turn(plumb_vec2 from, plumb_vec2 to)
{
    const plumb_real angle = plumb_atan2(plumb_vec2_cross(from, to), plumb_vec2_dot(from, to));
    return angle < 0 ? (double)angle + 2 * PI : (double)angle;
}

void pl_region_of(const plumb_convex *convex, uint32_t inner, pl_region *out)
{
    out->count = 0;
    if (convex->count == 1) {
        for (int i = 0; i < PL_REGION_CHORDS; ++i) {
            double sine, cosine;
            pl_sincos(2 * PI * i / PL_REGION_CHORDS, &sine, &cosine);
            add(out, (double)convex->points[0].x + (double)convex->radius * cosine,
                (double)convex->points[0].y + (double)convex->radius * sine, false);
        }
        return;
    }
    for (int k = 0; k < convex->count; ++k) {
        if (convex->radius > 0) {
            const plumb_vec2 before = convex->normals[k == 0 ? convex->count - 1 : k - 1];
            add_arc(out, convex, k, before,
                    convex->count == 2 ? PI : turn(before, convex->normals[k]));
        } else {
            add(out, (double)convex->points[k].x, (double)convex->points[k].y,
                (inner >> k & 1u) != 0);
        }
    }
}

//---- cutting -------------------------------------------------------------------------------------

double pl_border_beyond(pl_border h, const plumb_convex *convex)
{
    double most = -HUGE_VAL;
    for (int k = 0; k < convex->count; ++k) {
        const double beyond =
            h.nx * (double)convex->points[k].x + h.ny * (double)convex->points[k].y - h.d;
        most = beyond > most ? beyond : most;
    }
    return most + (double)convex->radius;
}

void pl_region_clip(pl_region *region, pl_border h)
{
    pl_region in = *region;
    region->count = 0;
    for (int k = 0; k < in.count; ++k) {
        const int next = k + 1 == in.count ? 0 : k + 1;
        const double here = h.nx * in.x[k] + h.ny * in.y[k] - h.d;
        const double there = h.nx * in.x[next] + h.ny * in.y[next] - h.d;
        const bool keeps = here <= 0, kept_next = there <= 0;
        const double t = keeps != kept_next ? here / (here - there) : 0;
        const double x = in.x[k] + t * (in.x[next] - in.x[k]);
        const double y = in.y[k] + t * (in.y[next] - in.y[k]);
        if (keeps && region->count < PL_REGION_MOST) {
            add(region, in.x[k], in.y[k], in.inner[k] != 0);
        }
        if (keeps != kept_next && region->count < PL_REGION_MOST) {
            add(region, x, y,
                !keeps && in.inner[k] != 0); // leaving: the edge along the line begins
        }
    }
}

//---- measures ------------------------------------------------------------------------------------

double pl_region_area(const pl_region *region)
{
    double twice = 0;
    for (int k = 2; k < region->count; ++k) {
        twice += (region->x[k - 1] - region->x[0]) * (region->y[k] - region->y[0]) -
                 (region->y[k - 1] - region->y[0]) * (region->x[k] - region->x[0]);
    }
    return twice / 2;
}

double pl_region_diameter(const pl_region *region)
{
    double most = 0;
    for (int k = 0; k < region->count; ++k) {
        for (int i = 0; i < k; ++i) {
            const double dx = region->x[k] - region->x[i], dy = region->y[k] - region->y[i];
            most = dx * dx + dy * dy > most ? dx * dx + dy * dy : most;
        }
    }
    return sqrt(most);
}

// [m] below which corners are one: a few roundings of `real` at this distance.
static double grain(const pl_region *r)
{
    double far = 0;
    for (int k = 0; k < r->count; ++k) {
        far = pl_larger(far, pl_larger(fabs(r->x[k]), fabs(r->y[k])));
    }
    return pl_larger(1e-9, 16 * (double)PLUMB_REAL_EPSILON * far);
}

static void remove_corner(pl_region *r, int k)
{
    for (int i = k + 1; i < r->count; ++i) {
        r->x[i - 1] = r->x[i];
        r->y[i - 1] = r->y[i];
        r->inner[i - 1] = r->inner[i];
    }
    --r->count;
}

void pl_region_clean(pl_region *r)
{
    const double least = grain(r);
    for (int k = 0; k < r->count && r->count > 2;) {
        const int before = k == 0 ? r->count - 1 : k - 1, next = k + 1 == r->count ? 0 : k + 1;
        const double ax = r->x[k] - r->x[before], ay = r->y[k] - r->y[before];
        const double bx = r->x[next] - r->x[before], by = r->y[next] - r->y[before];
        const double length = sqrt(bx * bx + by * by);
        const bool near = ax * ax + ay * ay <= least * least;
        const bool flat = bx * ay - by * ax >= -least * length;
        if (near || flat) {
            // The edge before runs on to the next corner; of two corners that are one, the edge behind is left.
            r->inner[before] = near ? r->inner[k] : r->inner[before] & r->inner[k];
            remove_corner(r, k);
            k = 0;
        } else {
            ++k;
        }
    }
}

//---- pieces --------------------------------------------------------------------------------------

// Corners first..last of a region, the edge from the last to the first an inner one if they are not all.
static bool make_part(const pl_region *r, int first, int last, bool is_all, plumb_convex *out,
                      uint32_t *inner)
{
    *out = (plumb_convex){ 0 };
    *inner = 0;
    int count = 0;
    if (first > 0) {
        out->points[count++] = plumb_v2((plumb_real)r->x[0], (plumb_real)r->y[0]);
        *inner |= 1u; // from corner 0 to `first`: shared with the part before
    }
    for (int k = first; k <= last; ++k) {
        *inner |= (uint32_t)(r->inner[k] & 1u) << count;
        out->points[count++] = plumb_v2((plumb_real)r->x[k], (plumb_real)r->y[k]);
    }
    if (!is_all && last < r->count - 1) {
        *inner |= 1u << (count - 1);
    }
    out->count = count;
    for (int k = 0; k < count; ++k) {
        const plumb_vec2 way =
            plumb_vec2_sub(out->points[k + 1 == count ? 0 : k + 1], out->points[k]);
        plumb_real length;
        out->normals[k] = plumb_vec2_right(plumb_vec2_unit_and_magnitude(way, &length));
        if (!(length > 0)) {
            return false;
        }
    }
    return true;
}

int pl_region_parts(const pl_region *region, plumb_convex *parts, uint32_t *inner)
{
    if (region->count < 3 || pl_region_area(region) <= grain(region) * pl_region_diameter(region)) {
        return 0;
    }
    int count = 0;
    // A fan: each part has corner 0 and up to 15 more, neighbours share one of them.
    for (int first = 0; first < region->count - 1;) {
        const int room = first == 0 ? PLUMB_POLYGON_MAX_VERTICES : PLUMB_POLYGON_MAX_VERTICES - 1;
        const int last =
            first + room - 1 < region->count - 1 ? first + room - 1 : region->count - 1;
        if (make_part(region, first, last, first == 0 && last == region->count - 1, &parts[count],
                      &inner[count])) {
            ++count;
        }
        first = last;
    }
    return count;
}
