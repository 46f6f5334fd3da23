// convex_query.c - nearest point, containment and ray against one convex shape, in its own frame.
//
// The surface of a rounded shape is its edges moved out by the radius, joined by arcs about the
// core points. Nearest points are found on the core and moved out along the normal (Minkowski sum
// with a disc). A ray that starts outside enters where it first meets a moved edge or a full
// circle about a core point: those circles lie within the shape, so the first meeting is on the
// surface. Sharp polygons are clipped half-plane by half-plane instead (Cyrus and Beck 1978), so
// that a ray at a corner cannot slip between two edges.
//
// Reads: arguments. Writes: the answer. Cost: O(vertices), no allocation.

#include "plumb/geometry.h"

// Edge that sees the point from farthest outside; *separation is the distance to its line.
static int most_separated_edge(const plumb_convex *shape, plumb_vec2 point, plumb_real *separation)
{
    int best = 0;
    plumb_real farthest = -PLUMB_REAL_MAX;
    for (int i = 0; i < shape->count; i++) {
        plumb_real s = plumb_vec2_dot(shape->normals[i], plumb_vec2_sub(point, shape->points[i]));
        if (s > farthest) {
            farthest = s;
            best = i;
        }
    }
    *separation = farthest;
    return best;
}

// Nearest place on the core point of a circle or on a corner: `fallback` is the normal when the
// point is the corner itself.
static plumb_convex_near near_corner(plumb_vec2 corner, plumb_vec2 point, plumb_vec2 fallback)
{
    plumb_convex_near near;
    near.normal = plumb_vec2_unit_and_magnitude(plumb_vec2_sub(point, corner), &near.distance);
    near.normal = near.distance == 0 ? fallback : near.normal;
    near.point = corner;
    return near;
}

// Nearest place on edge i of the core, for a point on its outer side.
static plumb_convex_near near_edge(const plumb_convex *shape, int i, plumb_vec2 point,
                                   plumb_real separation)
{
    plumb_vec2 a = shape->points[i];
    plumb_vec2 b = shape->points[(i + 1) % shape->count];
    plumb_vec2 n = shape->normals[i];
    plumb_vec2 along = plumb_vec2_left(n);
    if (plumb_vec2_dot(plumb_vec2_sub(point, a), along) <= 0) {
        return near_corner(a, point, n);
    }
    if (plumb_vec2_dot(plumb_vec2_sub(point, b), along) >= 0) {
        return near_corner(b, point, n);
    }
    plumb_convex_near near;
    near.distance = separation;
    near.normal = n;
    near.point = plumb_vec2_add_scaled(point, -separation, n);
    return near;
}

// Nearest place on the core's boundary, ignoring the radius.
static plumb_convex_near near_core(const plumb_convex *shape, plumb_vec2 point)
{
    if (shape->count == 1) {
        return near_corner(shape->points[0], point, plumb_v2(1, 0));
    }
    plumb_convex_near best;
    int edge = most_separated_edge(shape, point, &best.distance);
    if (shape->count >= 3 && best.distance <= 0) { // inside: the shallowest edge
        best.normal = shape->normals[edge];
        best.point = plumb_vec2_add_scaled(point, -best.distance, best.normal);
        return best;
    }
    // Outside, the nearest place lies on the edge seen from farthest: at a corner, the direction to
    // the point lies between the normals of two edges, and every other normal is farther from it.
    // In line with a segment, rounding may put the point behind both its sides.
    return near_edge(shape, edge, point, plumb_max(best.distance, 0));
}

plumb_convex_near plumb_convex_nearest(const plumb_convex *shape, plumb_vec2 point)
{
    plumb_convex_near near = near_core(shape, point);
    near.point = plumb_vec2_add_scaled(near.point, shape->radius, near.normal);
    near.distance -= shape->radius;
    return near;
}

bool plumb_convex_contains(const plumb_convex *shape, plumb_vec2 point)
{
    return near_core(shape, point).distance <= shape->radius;
}

// A ray as unit direction and length.
typedef struct ray {
    plumb_vec2 origin;
    plumb_vec2 direction; // unit
    plumb_real length;    // [m] > 0
} ray;

// Meeting with a circle, from outside. Uses the distance of the centre from the ray's line rather
// than the quadratic formula, whose difference of squares loses the digits of a far origin.
static bool ray_circle(const ray *r, plumb_vec2 center, plumb_real radius, plumb_real *t,
                       plumb_vec2 *normal)
{
    plumb_vec2 to_center = plumb_vec2_sub(center, r->origin);
    plumb_real along = plumb_vec2_dot(to_center, r->direction);
    plumb_vec2 offset = plumb_vec2_add_scaled(plumb_vec2_neg(to_center), along, r->direction);
    plumb_real half_chord_sq = radius * radius - plumb_vec2_magnitude_sq(offset);
    if (half_chord_sq < 0) {
        return false;
    }
    plumb_real half_chord = plumb_sqrt(half_chord_sq);
    plumb_real enter = along - half_chord;
    if (enter < 0 || enter > *t) {
        return false;
    }
    *t = enter;
    // A segment's end has no round to stand on: the normal faces the ray.
    *normal = radius > 0 ? plumb_vec2_unit(plumb_vec2_add_scaled(offset, -half_chord, r->direction))
                         : plumb_vec2_neg(r->direction);
    return true;
}

// Meeting with edge i moved out by the radius, from its outer side.
static bool ray_edge(const ray *r, const plumb_convex *shape, int i, plumb_real *t,
                     plumb_vec2 *normal)
{
    plumb_vec2 n = shape->normals[i];
    plumb_vec2 a = plumb_vec2_add_scaled(shape->points[i], shape->radius, n);
    plumb_vec2 b = plumb_vec2_add_scaled(shape->points[(i + 1) % shape->count], shape->radius, n);
    plumb_vec2 from_a = plumb_vec2_sub(r->origin, a);
    plumb_real height = plumb_vec2_dot(from_a, n);
    plumb_real approach = -plumb_vec2_dot(r->direction, n);
    if (height < 0 || approach <= 0 || height > *t * approach) {
        return false;
    }
    plumb_real enter = height / approach;
    plumb_vec2 at = plumb_vec2_add_scaled(from_a, enter, r->direction); // relative to a
    plumb_real along = plumb_vec2_dot(at, plumb_vec2_left(n));
    if (along < 0 || along > plumb_vec2_distance(a, b)) {
        return false;
    }
    *t = enter;
    *normal = n;
    return true;
}

// Meeting with a sharp polygon, from outside: the last half-plane to be entered, if that is
// before the first to be left.
static bool ray_polygon(const ray *r, const plumb_convex *shape, plumb_real *t, plumb_vec2 *normal)
{
    plumb_real enter = 0;
    plumb_real leave = *t;
    int edge = -1;
    for (int i = 0; i < shape->count; i++) {
        plumb_vec2 n = shape->normals[i];
        plumb_real height = plumb_vec2_dot(n, plumb_vec2_sub(r->origin, shape->points[i]));
        plumb_real approach = -plumb_vec2_dot(n, r->direction);
        if (approach > 0) {
            if (height >= enter * approach) {
                enter = height / approach;
                edge = i;
            }
        } else if (approach < 0) {
            leave = height > leave * approach ? height / approach : leave;
        } else if (height > 0) {
            return false;
        }
        if (enter > leave) {
            return false;
        }
    }
    if (edge < 0) {
        return false;
    }
    *t = enter;
    *normal = shape->normals[edge];
    return true;
}

// A ray along a line meets its nearer end, where rounding lets it go by that one and find the other.
static void meet_nearer_end(const ray *r, const plumb_convex *line, plumb_real *t)
{
    for (int i = 0; i < 2; i++) {
        plumb_vec2 to = plumb_vec2_sub(line->points[i], r->origin);
        plumb_real along = plumb_vec2_dot(to, r->direction);
        plumb_real reach =
            plumb_abs(r->origin.x) + plumb_abs(r->origin.y) + plumb_abs(to.x) + plumb_abs(to.y);
        if (along >= 0 && along < *t &&
            plumb_abs(plumb_vec2_cross(to, r->direction)) <= 8 * PLUMB_REAL_EPSILON * reach) {
            *t = along;
        }
    }
}

// First meeting with the moved edges and the circles about the core points.
static bool ray_rounded(const ray *r, const plumb_convex *shape, plumb_real *t, plumb_vec2 *normal)
{
    bool met = false;
    for (int i = 0; i < shape->count; i++) {
        if (ray_circle(r, shape->points[i], shape->radius, t, normal)) {
            met = true;
        }
        if (shape->count >= 2 && ray_edge(r, shape, i, t, normal)) {
            met = true;
        }
    }
    if (met && shape->count == 2 && shape->radius == 0) {
        meet_nearer_end(r, shape, t);
    }
    return met;
}

bool plumb_convex_ray(const plumb_convex *shape, plumb_vec2 origin, plumb_vec2 translation,
                      plumb_convex_hit *hit)
{
    if (plumb_convex_contains(shape, origin)) {
        hit->fraction = 0;
        hit->point = origin;
        hit->normal = plumb_v2(0, 0);
        return true;
    }
    ray r;
    r.origin = origin;
    r.direction = plumb_vec2_unit_and_magnitude(translation, &r.length);
    if (r.length == 0) {
        return false;
    }
    plumb_real t = r.length;
    plumb_vec2 normal = plumb_v2(0, 0);
    bool sharp = shape->count >= 3 && shape->radius == 0;
    bool met = sharp ? ray_polygon(&r, shape, &t, &normal) : ray_rounded(&r, shape, &t, &normal);
    if (met) {
        hit->fraction = plumb_min(t / r.length, 1);
        hit->point = plumb_vec2_add_scaled(origin, t, r.direction);
        hit->normal = normal;
    }
    return met;
}
