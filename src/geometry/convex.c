// convex.c - makes convex shapes and answers the simple questions about them: box, support.
//
// A shape is a core of 1..16 points with a radius around it, so that circle, capsule, segment and
// rounded polygon need one routine each, not four. Unused points and normals are zero, so equal
// shapes are equal bytes.
//
// Reads: arguments. Writes: the shape made. Cost: O(vertices); the polygon maker as plumb_hull.

#include "core/try.h"
#include "geometry/exact.h"

#include <string.h>

// Whether a rounding radius is in range; a lower bound above 0 is for circles and capsules.
static plumb_result check_radius(plumb_real radius, plumb_real low)
{
    if (!plumb_is_finite(radius)) {
        return PLUMB_E_NOT_FINITE;
    }
    return radius >= low && radius <= PLUMB_LENGTH_MAX ? PLUMB_OK : PLUMB_E_RANGE;
}

static plumb_result check_point(plumb_vec2 p)
{
    if (!plumb_vec2_is_finite(p)) {
        return PLUMB_E_NOT_FINITE;
    }
    bool near = plumb_abs(p.x) <= PLUMB_LENGTH_MAX && plumb_abs(p.y) <= PLUMB_LENGTH_MAX;
    return near ? PLUMB_OK : PLUMB_E_RANGE;
}

// The more basic of two results: not finite before range.
static plumb_result worse(plumb_result a, plumb_result b)
{
    if (a == PLUMB_E_NOT_FINITE || b == PLUMB_OK) {
        return a;
    }
    return b == PLUMB_E_NOT_FINITE || a == PLUMB_OK ? b : a;
}

// Outward unit normals of all edges, from the points; in double, so that each is good to the last
// bit of a plumb_real wherever the shape lies.
static void set_normals(plumb_convex *shape)
{
    for (int i = 0; i < shape->count; i++) {
        plumb_vec2 a = shape->points[i];
        plumb_vec2 b = shape->points[(i + 1) % shape->count];
        double length = pl_distance(a, b);
        shape->normals[i] = plumb_v2((plumb_real)(((double)b.y - (double)a.y) / length),
                                     (plumb_real)(((double)a.x - (double)b.x) / length));
    }
}

plumb_result plumb_convex_circle(plumb_vec2 center, plumb_real radius, plumb_convex *out)
{
    if (out == NULL) {
        return PLUMB_E_NULL;
    }
    PL_TRY(worse(check_point(center), check_radius(radius, PLUMB_LENGTH_MIN)));
    memset(out, 0, sizeof *out);
    out->points[0] = center;
    out->count = 1;
    out->radius = radius;
    return PLUMB_OK;
}

// Capsule or segment.
static plumb_result make_two_points(plumb_vec2 a, plumb_vec2 b, plumb_real radius,
                                    plumb_real radius_low, plumb_convex *out)
{
    if (out == NULL) {
        return PLUMB_E_NULL;
    }
    PL_TRY(worse(worse(check_point(a), check_point(b)), check_radius(radius, radius_low)));
    if (pl_distance(a, b) < (double)PLUMB_LENGTH_MIN) {
        return PLUMB_E_GEOMETRY;
    }
    memset(out, 0, sizeof *out);
    out->points[0] = a;
    out->points[1] = b;
    out->count = 2;
    out->radius = radius;
    set_normals(out);
    return PLUMB_OK;
}

plumb_result plumb_convex_capsule(plumb_vec2 a, plumb_vec2 b, plumb_real radius, plumb_convex *out)
{
    return make_two_points(a, b, radius, PLUMB_LENGTH_MIN, out);
}

plumb_result plumb_convex_segment(plumb_vec2 a, plumb_vec2 b, plumb_convex *out)
{
    return make_two_points(a, b, 0, 0, out);
}

plumb_result plumb_convex_box(plumb_vec2 half, plumb_vec2 center, plumb_real angle,
                              plumb_real radius, plumb_convex *out)
{
    if (out == NULL) {
        return PLUMB_E_NULL;
    }
    plumb_result sizes =
        worse(check_radius(half.x, PLUMB_LENGTH_MIN), check_radius(half.y, PLUMB_LENGTH_MIN));
    plumb_result checked = worse(worse(sizes, check_point(center)), check_radius(radius, 0));
    if (checked != PLUMB_OK || !plumb_is_finite(angle)) {
        return plumb_is_finite(angle) ? checked : PLUMB_E_NOT_FINITE;
    }
    plumb_transform t = plumb_transform_make(center, angle);
    plumb_convex box;
    memset(&box, 0, sizeof box);
    box.count = 4;
    box.radius = radius;
    for (int i = 0; i < 4; i++) {
        plumb_vec2 corner =
            plumb_v2(i == 1 || i == 2 ? half.x : -half.x, i >= 2 ? half.y : -half.y);
        box.points[i] = plumb_transform_apply(t, corner);
    }
    // Far from the origin a small box can lose its shape in the rounding of its corners.
    for (int i = 0; i < 4; i++) {
        double side = 2 * (double)(i % 2 == 0 ? half.x : half.y);
        double made = pl_distance(box.points[i], box.points[(i + 1) % 4]);
        if (made < 0.5 * side || made > 2 * side) {
            return PLUMB_E_GEOMETRY;
        }
    }
    set_normals(&box);
    *out = box;
    return PLUMB_OK;
}

plumb_result plumb_convex_polygon(const plumb_vec2 *points, int count, plumb_real radius,
                                  plumb_convex *out)
{
    if (points == NULL || out == NULL) {
        return PLUMB_E_NULL;
    }
    PL_TRY(check_radius(radius, 0));
    plumb_convex made;
    memset(&made, 0, sizeof made);
    PL_TRY(plumb_hull(points, count, made.points, PLUMB_POLYGON_MAX_VERTICES, &made.count));
    made.radius = radius;
    set_normals(&made);
    *out = made;
    return PLUMB_OK;
}

void plumb_convex_transform(const plumb_convex *shape, plumb_transform t, plumb_convex *out)
{
    plumb_convex moved = *shape; // out may be the shape itself
    for (int i = 0; i < shape->count; i++) {
        moved.points[i] = plumb_transform_apply(t, shape->points[i]);
        moved.normals[i] = plumb_rot_apply(t.q, shape->normals[i]);
    }
    *out = moved;
}

plumb_aabb plumb_convex_aabb(const plumb_convex *shape, plumb_transform t)
{
    plumb_aabb box = plumb_aabb_empty();
    for (int i = 0; i < shape->count; i++) {
        box = plumb_aabb_add_point(box, plumb_transform_apply(t, shape->points[i]));
    }
    return plumb_aabb_expand(box, shape->radius);
}

int plumb_convex_support_index(const plumb_convex *shape, plumb_vec2 direction)
{
    int best = 0;
    plumb_real farthest = plumb_vec2_dot(shape->points[0], direction);
    for (int i = 1; i < shape->count; i++) {
        plumb_real reach = plumb_vec2_dot(shape->points[i], direction);
        if (reach > farthest) {
            farthest = reach;
            best = i;
        }
    }
    return best;
}

plumb_vec2 plumb_convex_support(const plumb_convex *shape, plumb_vec2 direction)
{
    plumb_vec2 core = shape->points[plumb_convex_support_index(shape, direction)];
    return plumb_vec2_add_scaled(core, shape->radius, plumb_vec2_unit(direction));
}
