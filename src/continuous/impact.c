// impact.c - when two convex shapes that move and turn first meet, without a world: see plumb/geometry.h.
//
// Reads, writes: arguments. Cost: that of pl_sweep_first.
#include "geometry/sweep.h"

// [m] so near they have met: half is how far apart they are to be, half how exactly that is found.
#define NEAR 1e-4

static pl_swept swept_of(const plumb_convex *shape, const plumb_convex_motion *m, plumb_vec2 origin)
{
    pl_swept s = { .count = shape->count,
                   .radius = (double)shape->radius,
                   .px = (double)m->from.p.x - (double)origin.x,
                   .py = (double)m->from.p.y - (double)origin.y,
                   .dx = (double)m->translation.x,
                   .dy = (double)m->translation.y,
                   .angle = (double)m->angle };
    const double cos = (double)m->from.q.c, sin = (double)m->from.q.s;
    for (int i = 0; i < s.count; ++i) {
        const double x = (double)shape->points[i].x, y = (double)shape->points[i].y;
        s.x[i] = cos * x - sin * y;
        s.y[i] = sin * x + cos * y;
    }
    return s;
}

static plumb_transform at(const plumb_convex_motion *m, double time)
{
    const plumb_real t = (plumb_real)time;
    return (plumb_transform){
        plumb_vec2_add_scaled(m->from.p, t, m->translation),
        plumb_rot_mul(m->from.q, plumb_rot_make(t * m->angle)),
    };
}

bool plumb_convex_impact(const plumb_convex *a, plumb_convex_motion motion_a, const plumb_convex *b,
                         plumb_convex_motion motion_b, plumb_convex_hit *hit)
{
    const plumb_vec2 origin = motion_a.from.p;
    const pl_swept swept_a = swept_of(a, &motion_a, origin);
    const pl_swept swept_b = swept_of(b, &motion_b, origin);
    double time = 0;
    if (pl_sweep_gap(&swept_a, &swept_b, 0).distance > NEAR) {
        time = pl_sweep_first(&swept_a, &swept_b, 0, 1, NEAR / 2, NEAR / 2);
    }
    if (time > 1) {
        return false;
    }
    const plumb_convex_gap gap =
        plumb_convex_distance(a, at(&motion_a, time), b, at(&motion_b, time));
    *hit = (plumb_convex_hit){ .fraction = (plumb_real)time,
                               .point = gap.point_a,
                               .normal = gap.normal };
    return true;
}
