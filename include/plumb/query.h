/// query.h - questions to a world: rays, shape casts, overlaps, nearest points. They use the same grids as the
/// broad phase and see every shape where it is now. Not to be called during a step, except from systems.
///
/// A world that is asked goes on, bit for bit, as one that is not. The first question after a step looks through all
/// that moves; where that is not where the step has filed it, the grids are filed anew for the questions: O(shapes). The
/// next ones are free of that. Shapes that come, go or are moved between questions are kept apart, up to 64 convex pieces
/// (a few us a question); with more, all is filed anew.
#ifndef PLUMB_QUERY_H
#define PLUMB_QUERY_H

#include "plumb/geometry.h"
#include "plumb/world.h"

PLUMB_BEGIN

/// Which shapes a query sees. {0} (or null where a pointer is taken): all but sensors.
typedef struct plumb_query_filter {
    plumb_body ignore_body;                           ///< null: none. Shapes of this body are not seen
    bool ignore_static;                               ///< skip shapes of static bodies
    bool ignore_dynamic;                              ///< skip shapes of dynamic and kinematic bodies
    uint64_t category;                                ///< bits that a shape's own mask must have one of; 0: its mask is not asked
    uint64_t mask;                                    ///< bits that a shape's category must have one of; 0: all
    bool sensors;                                     ///< see sensors too
    bool one_way;                                     ///< rays and casts pass one-way shapes (plumb_one_way) in the direction in which
                                                      ///< those let things pass; false: they meet them from all sides
    bool (*accept)(void *context, plumb_shape shape); ///< null: accept all
    void *context;
} plumb_query_filter;

/// Where a ray met a shape.
typedef struct plumb_ray_hit {
    plumb_shape shape;
    plumb_body body;
    plumb_vec2 point;    ///< [m]
    plumb_vec2 normal;   ///< unit, out of the shape; zero when the ray starts inside
    plumb_real fraction; ///< [-] 0..1 along the ray
} plumb_ray_hit;

/// First shape on the segment from `from` to `to` [m]; true when there is one. Ties: lower shape slot.
/// False on non-finite input (see plumb_world_error). Cost: grid cells along the ray.
PLUMB_API bool plumb_world_ray(plumb_world *world, plumb_vec2 from, plumb_vec2 to,
                               const plumb_query_filter *filter, plumb_ray_hit *hit);

/// All shapes on the segment sorted by fraction, then slot: writes up to `capacity`, returns how many.
/// -1 on error.
PLUMB_API int plumb_world_ray_all(plumb_world *world, plumb_vec2 from, plumb_vec2 to,
                                  const plumb_query_filter *filter, plumb_ray_hit *hits, int capacity);

/// True when there is any shape on the segment: cheaper than the first one. False also on error.
PLUMB_API bool plumb_world_ray_any(plumb_world *world, plumb_vec2 from, plumb_vec2 to,
                                   const plumb_query_filter *filter);

/// A ray of a batch.
typedef struct plumb_ray {
    plumb_vec2 from, to; ///< [m]
} plumb_ray;

/// The first hit of each of `count` rays, in their order; a ray that meets nothing gets a hit of null
/// handles with fraction 1. Returns how many met something, -1 on error (then nothing is written).
/// Arguments and grids are looked at once for all.
PLUMB_API int plumb_world_ray_batch(plumb_world *world, const plumb_ray *rays, int count,
                                    const plumb_query_filter *filter, plumb_ray_hit *hits);

/// A convex shape that is moved along a translation without turning.
typedef struct plumb_cast {
    const plumb_convex *convex; ///< rounded or not: plumb_convex_capsule and the like
    plumb_transform transform;  ///< where it starts
    plumb_vec2 translation;     ///< [m] may be zero: then only what it overlaps is met
} plumb_cast;

/// Where a moving shape met another. Exact to rounding, some 1e-7 of the coordinates in the float build;
/// overlaps of up to 5e-7 of them at the start count as touches.
typedef struct plumb_cast_hit {
    plumb_shape shape;
    plumb_body body;
    plumb_vec2 point;    ///< [m] on the surface of the shape that was met; midway where faces meet
    plumb_vec2 normal;   ///< unit, out of the shape that was met. In an overlap: the shortest way out
    plumb_real fraction; ///< [-] 0..1 of the translation
    plumb_real depth;    ///< [m] of the overlap at the start, > 0: fraction is 0 then; 0: apart or touching.
                         ///< A shape that touches is met when the cast approaches it
} plumb_cast_hit;

/// First shape on the way; true when there is one. Of several that it overlaps at the start: the deepest.
/// Ties: lower shape slot. False on error: E_NULL, E_RANGE, E_NOT_FINITE, E_HANDLE (filter). Cost: grid
/// cells under the way, O(corners) for each shape near it.
PLUMB_API bool plumb_world_cast(plumb_world *world, const plumb_cast *cast,
                                const plumb_query_filter *filter, plumb_cast_hit *hit);
/// True when there is any shape on the way. False also on error.
PLUMB_API bool plumb_world_cast_any(plumb_world *world, const plumb_cast *cast,
                                    const plumb_query_filter *filter);
/// All shapes on the way sorted by fraction, then slot: writes up to `capacity`, returns how many.
/// -1 on error.
PLUMB_API int plumb_world_cast_all(plumb_world *world, const plumb_cast *cast,
                                   const plumb_query_filter *filter, plumb_cast_hit *hits,
                                   int capacity);
/// The first hit of each of `count` casts, as plumb_world_ray_batch does it.
PLUMB_API int plumb_world_cast_batch(plumb_world *world, const plumb_cast *casts, int count,
                                     const plumb_query_filter *filter, plumb_cast_hit *hits);

/// Shapes of which the tight box of some convex piece overlaps the box, in slot order: writes up to `capacity`, returns how many.
/// Any finite box is answered; one that is a period long or longer holds all there is along that axis.
/// -1 on error.
PLUMB_API int plumb_world_overlap_aabb(plumb_world *world, plumb_aabb box,
                                       const plumb_query_filter *filter, plumb_shape *shapes, int capacity);

/// Shapes that overlap a convex shape placed at `transform`, in slot order. -1 on error.
PLUMB_API int plumb_world_overlap_convex(plumb_world *world, const plumb_convex *convex,
                                         plumb_transform transform, const plumb_query_filter *filter,
                                         plumb_shape *shapes, int capacity);

/// Shapes that contain a point [m], in slot order. -1 on error.
PLUMB_API int plumb_world_overlap_point(plumb_world *world, plumb_vec2 point,
                                        const plumb_query_filter *filter, plumb_shape *shapes, int capacity);

/// What flows at a place.
typedef struct plumb_fluid_sample {
    plumb_shape shape;   ///< the volume, a sensor of a fluid material; null: there is none
    plumb_vec2 velocity; ///< [m/s] of the fluid in the world, gusts, vortices and the motion of its body included
    plumb_real density;  ///< [kg/m^2]; 0: there is none
} plumb_fluid_sample;

/// The fluid at a point [m], of several volumes (plumb/material.h) that of the densest one, as soft bodies feel it; for
/// sparks, smoke, leaves of a game's own. Liquid and air have their own (plumb_liquid_at, plumb_air_at). {0} where there is
/// none, and on error: E_NOT_FINITE, E_RANGE. Cost: plumb_world_overlap_point, and a volume's sides.
PLUMB_API plumb_fluid_sample plumb_fluid_at(plumb_world *world, plumb_vec2 position);

/// The nearest surface to a point.
typedef struct plumb_nearest_hit {
    plumb_shape shape;
    plumb_body body;
    plumb_vec2 point;    ///< [m] on the surface
    plumb_real distance; ///< [m] negative when the point is inside
} plumb_nearest_hit;

/// The shape nearest to `point` within `max_distance` [m] (> 0, may be PLUMB_REAL_MAX); true if any.
PLUMB_API bool plumb_world_nearest(plumb_world *world, plumb_vec2 point, plumb_real max_distance,
                                   const plumb_query_filter *filter, plumb_nearest_hit *hit);

/// All shapes within `max_distance` [m] of a point, sorted by distance, then slot: writes up to
/// `capacity`, returns how many. -1 on error.
PLUMB_API int plumb_world_nearest_all(plumb_world *world, plumb_vec2 point, plumb_real max_distance,
                                      const plumb_query_filter *filter, plumb_nearest_hit *hits,
                                      int capacity);
/// The nearest shape to each of `count` points [m], in their order; a point with none near gets null
/// handles and `max_distance`. Returns how many have one, -1 on error (then nothing is written).
PLUMB_API int plumb_world_nearest_batch(plumb_world *world, const plumb_vec2 *points, int count,
                                        plumb_real max_distance, const plumb_query_filter *filter,
                                        plumb_nearest_hit *hits);

PLUMB_END

#endif
