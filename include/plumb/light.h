/// light.h - rays of light through the shapes of a world: mirrors, glass, what is neither. A question like those of query.h:
/// nothing of it lies in the world, nothing is allocated.
///
///     plumb_material glass = plumb_material_create(world, &(plumb_material_desc){ .refractive_index = 1.5f });
///     plumb_light_segment path[64];
///     plumb_light_sum sum;
///     int count = plumb_world_light(world, &(plumb_light_desc){ .from = { -5, 1 }, .direction = { 1, 0 } }, NULL,
///                                   path, 64, &sum);
///     for (int i = 0; i < count; ++i) draw_line(path[i].from, path[i].to, path[i].power);
///
/// What a shape is to light its material says (plumb/material.h): `refractive_index` 0 is opaque and sends back the share
/// `reflectance`; above 0 light goes through it, and loses `absorption` a metre. At a surface between two media directions
/// follow Snell's law and powers the equations of Fresnel, of either polarisation its own; where a ray parts in two, both go on.
///
/// - A medium is a material. Of transparent shapes that overlap that of the least area counts, as it lies in the other: a lens in
///   water, a bubble in glass. Of equal areas the one of the larger index.
/// - Shapes of one material that touch or overlap are one piece of glass. Between others that touch there is one surface, and no film of
///   air: gaps below PLUMB_WELD_DISTANCE are none. So it is with glass on what is opaque: a mirror behind glass.
/// - At a surface between two media the larger `reflectance` of the two goes back before Fresnel has his share: half mirrors, silvered glass.
/// - Segments and chains are mirrors on both sides. With a refractive index they are films without thickness: what they do not
///   reflect goes straight on. One that lies just in a face of glass may be missed: give the glass its reflectance.
/// - One-way shapes are met from all sides, or as the filter says. Sensors are passed over; where the filter
///   sees them, those with a refractive index are met, such as the water of a pool, as if its surface were still.
/// - Directions, angles and places are computed in double in all precisions, from the shapes as they are stored.
#ifndef PLUMB_LIGHT_H
#define PLUMB_LIGHT_H

#include "plumb/query.h"

PLUMB_BEGIN

/// Most surfaces that a ray may have behind it.
#define PLUMB_LIGHT_MAX_BOUNCES 128

/// A ray. {0} but for the direction is one watt of unpolarised light from the origin.
typedef struct plumb_light_desc {
    plumb_vec2 from;      ///< [m]
    plumb_vec2 direction; ///< of any length but 0
    plumb_real length;    ///< [m] 0..1e12 of its way, over all surfaces; 0 means 1000, in a world that wraps at most 8 periods
    plumb_real power;     ///< [W] 0..1e12; 0 means 1
    /// -1..1: 1 is all in the plane of the world (p: the electric field lies in it), -1 all across it (s), 0 half of
    /// each. In two dimensions either stays what it is
    plumb_real polarization;
    int max_bounces;      ///< 0..PLUMB_LIGHT_MAX_BOUNCES surfaces that a ray goes on from; 0 means 64
    plumb_real min_power; ///< [W] 0..1e12: what is weaker does not go on; 0 means a thousandth of `power`
    plumb_real index;     ///< 0..10, refractive index of what is around all shapes; 0 means 1
} plumb_light_desc;

/// How a piece of a path begins.
typedef enum plumb_light_how {
    PLUMB_LIGHT_SENT,      ///< where the ray starts
    PLUMB_LIGHT_REFLECTED, ///< at the end of its parent, on the same side
    PLUMB_LIGHT_REFRACTED  ///< at the end of its parent, through the surface
} plumb_light_how;

/// A straight piece of a path.
typedef struct plumb_light_segment {
    plumb_vec2 from, to;     ///< [m]
    plumb_real power;        ///< [W] at `from`
    plumb_real power_end;    ///< [W] at `to`: less where the medium absorbs
    plumb_real absorbed;     ///< [W] of power_end that what it meets keeps; the rest went on, or was cut off
    plumb_real polarization; ///< -1..1 at `from`, as in the descriptor
    plumb_real index;        ///< refractive index of the medium it runs in
    plumb_real path;         ///< [m] of way from the source to `from`
    plumb_light_how how;
    int parent;           ///< index of the piece that it comes from; -1: it starts here
    int depth;            ///< surfaces behind it
    plumb_shape shape;    ///< what it meets at `to`; null: nothing, its length ends there
    plumb_body body;      ///< of that shape
    plumb_vec2 normal;    ///< unit, of the surface there, against the ray; zero: none, or it starts in what is opaque
    plumb_real incidence; ///< [rad] 0..pi/2 between the ray and that normal
} plumb_light_segment;

/// Where the power went: sent = absorbed + left + cut, to rounding.
typedef struct plumb_light_sum {
    double sent;     ///< [W] of the source
    double absorbed; ///< [W] by surfaces, and within media
    double left;     ///< [W] of rays whose length ended
    double cut;      ///< [W] that was not followed: below min_power, behind max_bounces, beyond the capacity
} plumb_light_sum;

/// Follows a ray and all that comes of it: writes up to `capacity` pieces, returns how many. Depth first, at each surface the stronger
/// of the two before the weaker, of equals the one that went through: parents before their children, the strongest path at the front. `sum`
/// may be null. The filter is that of query.h; leave out what holds the lamp (ignore_body).
/// -1 on error: E_NULL, E_RANGE, E_NOT_FINITE, E_HANDLE (filter), E_UNSUPPORTED. Cost: a ray of query.h and a look at a point for each
/// surface. Reads what is there; the same bits whatever the order in which shapes are stored, but where two are met in one place.
/// Born and Wolf, Principles of Optics, 1.5.
PLUMB_API int plumb_world_light(plumb_world *world, const plumb_light_desc *desc,
                                const plumb_query_filter *filter, plumb_light_segment *segments,
                                int capacity, plumb_light_sum *sum);

PLUMB_END

#endif
