/// query.h - questions to a world: rays, overlaps, nearest points. They use the same grid as the
/// broad phase and see every shape where it is now. Not to be called during a step, except from systems.
#ifndef PLUMB_QUERY_H
#define PLUMB_QUERY_H

#include "plumb/geometry.h"
#include "plumb/world.h"

PLUMB_BEGIN

/// Which shapes a query sees. {0} (or null where a pointer is taken): all but sensors.
typedef struct plumb_query_filter {
    plumb_body ignore_body; ///< null: none. Shapes of this body are not seen
    bool ignore_static;     ///< skip shapes of static bodies
    bool ignore_dynamic;    ///< skip shapes of dynamic and kinematic bodies
    uint64_t category;      ///< bits that a shape's own mask must have one of; 0: its mask is not asked
    uint64_t mask;          ///< bits that a shape's category must have one of; 0: all
    bool sensors;           ///< see sensors too
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

/// Shapes whose tight box overlaps the box, in slot order: writes up to `capacity`, returns how many.
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

PLUMB_END

#endif
