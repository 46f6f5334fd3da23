// between.c - two convex shapes without a world: how far apart, and when one that moves meets the other.
//
// Both are put into one, their Minkowski difference (sweep.h), of which the distance to the origin is that of the
// shapes. Of shapes that turn see continuous/impact.c.
//
// Reads, writes: arguments. Cost: O(corners).
#include "query/query.h"
#include "query/sweep.h"

#include <math.h>

// [-] edges that lean less than this lie in the contact: the rounding of their direction, so that points told to be
// on a surface are.
#define FLAT 1e-9

static plumb_vec2 placed(plumb_vec2 origin, double x, double y)
{
    return plumb_v2((plumb_real)((double)origin.x + x), (plumb_real)((double)origin.y + y));
}

plumb_convex_gap plumb_convex_distance(const plumb_convex *a, plumb_transform at_a,
                                       const plumb_convex *b, plumb_transform at_b)
{
    pl_round fixed, mover;
    pl_sum sum;
    pl_round_make(a, at_a, at_a.p, &fixed);
    pl_round_make(b, at_b, at_a.p, &mover);
    pl_sum_make(&fixed, &mover, &sum);
    const pl_sum_near near = pl_sum_nearest(&sum, 0, 0);
    const double d = near.distance;
    double x, y;
    pl_round_touch_within(&fixed, &mover, -d * near.nx, -d * near.ny, near.nx, near.ny, FLAT, &x,
                          &y);
    return (plumb_convex_gap){
        .distance = (plumb_real)d,
        .point_a = placed(at_a.p, x, y),
        .point_b = placed(at_a.p, x + d * near.nx, y + d * near.ny),
        .normal = plumb_v2((plumb_real)near.nx, (plumb_real)near.ny),
    };
}

bool plumb_convex_cast(const plumb_convex *a, plumb_transform at_a, const plumb_convex *b,
                       plumb_transform at_b, plumb_vec2 translation, plumb_convex_hit *hit)
{
    pl_round fixed, mover;
    pl_sum sum;
    pl_sum_hit met;
    const double dx = (double)translation.x, dy = (double)translation.y;
    pl_round_make(a, at_a, at_a.p, &fixed);
    pl_round_make(b, at_b, at_a.p, &mover);
    pl_sum_make(&fixed, &mover, &sum);
    const double size = fabs((double)at_b.p.x - (double)at_a.p.x) +
                        fabs((double)at_b.p.y - (double)at_a.p.y) + fixed.radius + mover.radius;
    if (!pl_sum_cast(&sum, 0, 0, dx, dy, PL_QUERY_TOUCH * size, &met)) {
        return false;
    }
    double x, y;
    const double way = met.fraction, back = met.depth;
    pl_round_touch_within(&fixed, &mover, way * dx + back * met.nx, way * dy + back * met.ny,
                          met.nx, met.ny, FLAT, &x, &y);
    *hit = (plumb_convex_hit){ .fraction = (plumb_real)way,
                               .point = placed(at_a.p, x, y),
                               .normal = plumb_v2((plumb_real)met.nx, (plumb_real)met.ny) };
    return true;
}
