/// geometry.h - pure functions on outlines and convex shapes: hull, decomposition, mass, boxes,
/// rays, nearest points. No world, no allocation, no state; any thread.
///
///     plumb_convex shape;                                  // a rounded triangle
///     if (plumb_convex_polygon(points, 3, 0.05f, &shape) == PLUMB_OK) {
///         plumb_mass_properties m = plumb_convex_mass(&shape, 1000);
///         plumb_aabb box = plumb_convex_aabb(&shape, where);
///     }
///
/// A convex shape is up to 16 core points and a radius around them: one point is a circle, two
/// are a capsule (a segment when the radius is 0), three or more a counter-clockwise polygon,
/// rounded when the radius is not 0. Lengths in metres, areas in m^2, mass in kg.
///
/// Every function that returns a plumb_result checks its arguments: null, then count, finite,
/// range, geometry; on an error the outputs are untouched (except where said). The others trust
/// a shape that a maker has made.
#ifndef PLUMB_GEOMETRY_H
#define PLUMB_GEOMETRY_H

#include "plumb/math.h"

PLUMB_BEGIN

// The symbols tell the precision: see plumb_real.
#define plumb_convex_circle        PLUMB_SYMBOL(plumb_convex_circle)
#define plumb_convex_capsule       PLUMB_SYMBOL(plumb_convex_capsule)
#define plumb_convex_segment       PLUMB_SYMBOL(plumb_convex_segment)
#define plumb_convex_box           PLUMB_SYMBOL(plumb_convex_box)
#define plumb_convex_polygon       PLUMB_SYMBOL(plumb_convex_polygon)
#define plumb_convex_transform     PLUMB_SYMBOL(plumb_convex_transform)
#define plumb_hull                 PLUMB_SYMBOL(plumb_hull)
#define plumb_outline_check        PLUMB_SYMBOL(plumb_outline_check)
#define plumb_outline_area         PLUMB_SYMBOL(plumb_outline_area)
#define plumb_outline_is_convex    PLUMB_SYMBOL(plumb_outline_is_convex)
#define plumb_outline_contains     PLUMB_SYMBOL(plumb_outline_contains)
#define plumb_outline_decompose    PLUMB_SYMBOL(plumb_outline_decompose)
#define plumb_circle_mass          PLUMB_SYMBOL(plumb_circle_mass)
#define plumb_capsule_mass         PLUMB_SYMBOL(plumb_capsule_mass)
#define plumb_convex_mass          PLUMB_SYMBOL(plumb_convex_mass)
#define plumb_outline_mass         PLUMB_SYMBOL(plumb_outline_mass)
#define plumb_mass_combine         PLUMB_SYMBOL(plumb_mass_combine)
#define plumb_mass_with_total      PLUMB_SYMBOL(plumb_mass_with_total)
#define plumb_mass_inertia_about   PLUMB_SYMBOL(plumb_mass_inertia_about)
#define plumb_convex_aabb          PLUMB_SYMBOL(plumb_convex_aabb)
#define plumb_convex_support_index PLUMB_SYMBOL(plumb_convex_support_index)
#define plumb_convex_support       PLUMB_SYMBOL(plumb_convex_support)
#define plumb_convex_contains      PLUMB_SYMBOL(plumb_convex_contains)
#define plumb_convex_nearest       PLUMB_SYMBOL(plumb_convex_nearest)
#define plumb_convex_ray           PLUMB_SYMBOL(plumb_convex_ray)
#define plumb_convex_distance      PLUMB_SYMBOL(plumb_convex_distance)
#define plumb_convex_cast          PLUMB_SYMBOL(plumb_convex_cast)
#define plumb_convex_impact        PLUMB_SYMBOL(plumb_convex_impact)

/// Most vertices of one convex polygon.
#define PLUMB_POLYGON_MAX_VERTICES 16

/// Most vertices of an outline, and most points of a cloud that a hull is taken of. The work
/// arrays of that size are on the stack (at most 16 KiB).
#define PLUMB_OUTLINE_MAX_VERTICES 256

/// [m] smallest radius, half extent or length of a shape.
#define PLUMB_LENGTH_MIN PLUMB_REAL(1e-4)

/// [m] largest radius, half extent, or distance of a vertex from the local origin.
#define PLUMB_LENGTH_MAX PLUMB_REAL(1e7)

/// [m] hull points nearer than this are one point, and a hull thinner than this is none: a tenth
/// of PLUMB_LENGTH_MIN, or 8 roundings of the largest coordinate if that is more.
#define PLUMB_WELD_DISTANCE PLUMB_REAL(1e-5)

/// A convex shape in its own frame. Made by plumb_convex_*, plain data afterwards.
typedef struct plumb_convex {
    plumb_vec2 points[PLUMB_POLYGON_MAX_VERTICES];  ///< [m] core points, counter-clockwise
    plumb_vec2 normals[PLUMB_POLYGON_MAX_VERTICES]; ///< outward unit normal of edge i to i + 1;
                                                    ///< of both sides for count 2, unused for 1
    int count;                                      ///< 1 circle, 2 capsule or segment, 3..16
    plumb_real radius;                              ///< [m] >= 0, around the core
} plumb_convex;

/// One convex piece of an outline: counter-clockwise, no three vertices in line.
typedef struct plumb_convex_piece {
    plumb_vec2 vertices[PLUMB_POLYGON_MAX_VERTICES]; ///< [m]
    int count;                                       ///< 3..16
} plumb_convex_piece;

/// Mass, where its centre is, and how hard it is to turn.
typedef struct plumb_mass_properties {
    plumb_real mass;    ///< [kg]
    plumb_vec2 center;  ///< [m] centre of mass
    plumb_real inertia; ///< [kg m^2] about the centre
} plumb_mass_properties;

/// Where a ray meets a shape.
typedef struct plumb_convex_hit {
    plumb_real fraction; ///< 0..1 of the translation
    plumb_vec2 point;    ///< [m] on the surface; the origin if that lies inside
    plumb_vec2 normal;   ///< outward unit normal there; (0, 0) if the origin lies inside
} plumb_convex_hit;

/// The place of a shape's surface nearest to a point.
typedef struct plumb_convex_near {
    plumb_real distance; ///< [m] negative inside
    plumb_vec2 point;    ///< [m] on the surface
    plumb_vec2 normal;   ///< outward unit normal there: query = point + distance * normal
} plumb_convex_near;

/// How far two shapes are apart, and where they are nearest.
typedef struct plumb_convex_gap {
    plumb_real distance; ///< [m] between their surfaces; negative: how far they must be moved to part
    plumb_vec2 point_a;  ///< [m] on the surface of A
    plumb_vec2 point_b;  ///< [m] on the surface of B: point_a + distance * normal
    plumb_vec2 normal;   ///< unit, from A to B
} plumb_convex_gap;

/// A shape on its way: its frame's origin moves on a straight line while the shape turns about it, both evenly.
typedef struct plumb_convex_motion {
    plumb_transform from;   ///< where it is at first
    plumb_vec2 translation; ///< [m]
    plumb_real angle;       ///< [rad] turned on the way, full turns included
} plumb_convex_motion;

// --- Makers --------------------------------------------------------------------------------------

/// A circle. Radius PLUMB_LENGTH_MIN..PLUMB_LENGTH_MAX.
/// @return PLUMB_OK | E_NULL | E_NOT_FINITE | E_RANGE (radius, or centre too far out)
PLUMB_API plumb_result plumb_convex_circle(plumb_vec2 center, plumb_real radius, plumb_convex *out);

/// A capsule: all points within the radius of the line from a to b. Radius and the distance of
/// a and b PLUMB_LENGTH_MIN..PLUMB_LENGTH_MAX.
/// @return PLUMB_OK | E_NULL | E_NOT_FINITE | E_RANGE | E_GEOMETRY (a and b too near: a circle)
PLUMB_API plumb_result plumb_convex_capsule(plumb_vec2 a, plumb_vec2 b, plumb_real radius,
                                            plumb_convex *out);

/// A segment: a capsule of radius 0. It has no mass.
/// @return PLUMB_OK | E_NULL | E_NOT_FINITE | E_RANGE | E_GEOMETRY (a and b too near)
PLUMB_API plumb_result plumb_convex_segment(plumb_vec2 a, plumb_vec2 b, plumb_convex *out);

/// A box of half width and half height `half`, turned by `angle` [rad] about its centre, with
/// rounding radius 0..PLUMB_LENGTH_MAX added outside. Points start at the corner -half.
/// @return PLUMB_OK | E_NULL | E_NOT_FINITE | E_RANGE | E_GEOMETRY (so far out, or so uneven, that
///         its corners are lost in rounding)
PLUMB_API plumb_result plumb_convex_box(plumb_vec2 half, plumb_vec2 center, plumb_real angle,
                                        plumb_real radius, plumb_convex *out);

/// The convex hull of 3..256 points, with rounding radius 0..PLUMB_LENGTH_MAX added outside.
/// Points in any order; see plumb_hull for what is merged.
/// @return PLUMB_OK | E_NULL | E_RANGE (count < 3, radius, coordinates) | E_NOT_FINITE |
///         E_CAPACITY (more than 256 points, or more than 16 left) | E_GEOMETRY (no area)
PLUMB_API plumb_result plumb_convex_polygon(const plumb_vec2 *points, int count, plumb_real radius,
                                            plumb_convex *out);

/// The same shape moved by a transform.
PLUMB_API void plumb_convex_transform(const plumb_convex *shape, plumb_transform t,
                                      plumb_convex *out);

// --- Outlines ------------------------------------------------------------------------------------

/// The convex hull of a cloud of 3..256 points, counter-clockwise, starting at the leftmost
/// (lowest of those) point, no three in line. Points nearer than PLUMB_WELD_DISTANCE are welded;
/// points that stick out less than 8 roundings of the largest coordinate are dropped.
/// Andrew's monotone chain (1979) on exact orientation signs. O(n^2), no allocation.
/// @param hull        room for `capacity` points; untouched on an error
/// @param hull_count  receives the number of hull vertices
/// @return PLUMB_OK | E_NULL | E_RANGE (count < 3, coordinates) | E_NOT_FINITE |
///         E_CAPACITY (count above 256, or more hull vertices than `capacity`) |
///         E_GEOMETRY (fewer than 3 left, or thinner than PLUMB_WELD_DISTANCE)
PLUMB_API plumb_result plumb_hull(const plumb_vec2 *points, int count, plumb_vec2 *hull,
                                  int capacity, int *hull_count);

/// Whether 3..256 points are the outline of a simple polygon, in either direction: finite, edges
/// that neither cross nor touch one another, some area. Repeated points and points in line are
/// allowed. O(n^2), exact.
/// @return PLUMB_OK | E_NULL | E_RANGE (count < 3 or coordinates) | E_NOT_FINITE | E_CAPACITY |
///         E_GEOMETRY
PLUMB_API plumb_result plumb_outline_check(const plumb_vec2 *points, int count);

/// Signed area of an outline [m^2] (shoelace formula): positive counter-clockwise. 0 below 3
/// points.
PLUMB_API plumb_real plumb_outline_area(const plumb_vec2 *points, int count);

/// True when the outline turns to one side only, once around; repeated points and points in line
/// are allowed. False below 3 points or without area. O(n), exact.
PLUMB_API bool plumb_outline_is_convex(const plumb_vec2 *points, int count);

/// True when the point lies in the outline (even-odd rule, exact); on the edge it may be either.
PLUMB_API bool plumb_outline_contains(const plumb_vec2 *points, int count, plumb_vec2 point);

/// Splits a simple outline of 3..256 vertices, either direction, into convex pieces of at most 16
/// vertices, using the outline's own vertices only: the pieces cover the outline exactly and do
/// not overlap. Vertices in line within 8 roundings of the largest coordinate are left out.
/// Ear clipping (Meisters 1975; best-shaped ear first), then diagonals whose removal leaves both
/// sides convex are removed (Hertel and Mehlhorn 1983: at most four times the fewest pieces).
/// At most count - 2 pieces. No allocation, 16 KiB of stack. Measured on random outlines: 0.13 ms
/// for 64 vertices, 3.3 ms for 256.
/// A piece can be thinner than PLUMB_WELD_DISTANCE where the outline's vertices are nearly in line;
/// plumb_convex_polygon refuses such a sliver, which may then be left out.
/// @param pieces       room for `capacity` pieces; untouched on an error
/// @param piece_count  receives the number of pieces; if the room was too small (E_CAPACITY), the
///                     number needed; untouched on any other error
/// @return PLUMB_OK | E_NULL | E_RANGE (count < 3, coordinates) | E_NOT_FINITE |
///         E_CAPACITY (count above 256, or too little room) | E_GEOMETRY (not simple, or no area)
PLUMB_API plumb_result plumb_outline_decompose(const plumb_vec2 *points, int count,
                                               plumb_convex_piece *pieces, int capacity,
                                               int *piece_count);

// --- Mass ----------------------------------------------------------------------------------------

/// A disc: m = pi r^2 d, I = m r^2 / 2. density [kg/m^2].
PLUMB_API plumb_mass_properties plumb_circle_mass(plumb_vec2 center, plumb_real radius,
                                                  plumb_real density);

/// A capsule: rectangle and two half discs. density [kg/m^2]. A circle when a == b.
PLUMB_API plumb_mass_properties plumb_capsule_mass(plumb_vec2 a, plumb_vec2 b, plumb_real radius,
                                                   plumb_real density);

/// Any convex shape, rounding included, exactly: polygon, a strip along each edge, a sector at
/// each vertex. density [kg/m^2]. A segment has mass 0, with its middle as centre.
PLUMB_API plumb_mass_properties plumb_convex_mass(const plumb_convex *shape, plumb_real density);

/// A simple outline of 3 or more vertices, concave or not, either direction. density [kg/m^2].
/// Without area: mass 0, the mean of the points as centre.
PLUMB_API plumb_mass_properties plumb_outline_mass(const plumb_vec2 *points, int count,
                                                   plumb_real density);

/// Several masses that are one body: masses add, centres average, inertias add by the parallel
/// axis theorem. Mass 0 in all: mass 0 with the mean of the centres. count 0: all zero.
PLUMB_API plumb_mass_properties plumb_mass_combine(const plumb_mass_properties *parts, int count);

/// The same shape with another total mass [kg]; unchanged when its mass is 0.
PLUMB_API plumb_mass_properties plumb_mass_with_total(plumb_mass_properties m, plumb_real total);

/// Inertia about another point [kg m^2]: I + m d^2 (parallel axis theorem).
PLUMB_API plumb_real plumb_mass_inertia_about(plumb_mass_properties m, plumb_vec2 point);

// --- Queries on one convex shape, in its own frame -----------------------------------------------

/// The shape's box after a transform.
PLUMB_API plumb_aabb plumb_convex_aabb(const plumb_convex *shape, plumb_transform t);

/// Index of the core point farthest in a direction (any length); the lowest of equals.
PLUMB_API int plumb_convex_support_index(const plumb_convex *shape, plumb_vec2 direction);

/// The point of the surface farthest in a direction, rounding included. For the direction (0, 0),
/// a core point.
PLUMB_API plumb_vec2 plumb_convex_support(const plumb_convex *shape, plumb_vec2 direction);

/// True when the point lies in the shape or on its surface.
PLUMB_API bool plumb_convex_contains(const plumb_convex *shape, plumb_vec2 point);

/// The nearest place of the surface, inside or outside. In a tie (a circle's centre, a polygon's
/// middle axis) one of the nearest: the lowest edge, or (1, 0) as normal of a circle's centre.
PLUMB_API plumb_convex_near plumb_convex_nearest(const plumb_convex *shape, plumb_vec2 point);

/// The first place where the ray from `origin` to `origin + translation` meets the shape.
/// A ray that starts inside or on the surface hits at fraction 0 with normal (0, 0). A segment is
/// met from either side, the normal facing the origin; a ray along it meets the nearer end.
/// False, and *hit untouched, when there is none; a zero translation hits only from inside.
PLUMB_API bool plumb_convex_ray(const plumb_convex *shape, plumb_vec2 origin,
                                plumb_vec2 translation, plumb_convex_hit *hit);

// --- Queries on two convex shapes ----------------------------------------------------------------

/// The nearest places of two shapes, or how deep they overlap: exact to rounding, computed in double. Of faces that
/// face each other evenly, the middle of what they share; of equal ways to part, one. O(corners).
PLUMB_API plumb_convex_gap plumb_convex_distance(const plumb_convex *a, plumb_transform at_a,
                                                 const plumb_convex *b, plumb_transform at_b);

/// Where B first meets A when it is moved by `translation` [m] without turning: exact to rounding. hit->point is on
/// the surface of A, hit->normal goes from A to B. Shapes that overlap at first meet at fraction 0, whatever the
/// translation; those that touch, if they approach. False, and *hit untouched, when they do not meet. O(corners).
PLUMB_API bool plumb_convex_cast(const plumb_convex *a, plumb_transform at_a, const plumb_convex *b,
                                 plumb_transform at_b, plumb_vec2 translation,
                                 plumb_convex_hit *hit);

/// Where two shapes that move and turn first come within a ten-thousandth of a metre: never after they overlap, however
/// fast they turn. Shapes that are so near at first meet at fraction 0. hit->point and normal as above, at that
/// moment. False, and *hit untouched, when they do not meet. O(corners of A x corners of B) a round, 3 to 20
/// rounds; conservative advancement (Mirtich 1996).
PLUMB_API bool plumb_convex_impact(const plumb_convex *a, plumb_convex_motion motion_a,
                                   const plumb_convex *b, plumb_convex_motion motion_b,
                                   plumb_convex_hit *hit);

PLUMB_END

#endif
