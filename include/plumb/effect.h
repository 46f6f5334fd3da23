/// effect.h - what acts on many bodies at once.
///
///     plumb_world_explode(world, &(plumb_explosion_desc){
///         .position = { 3, 0 }, .radius = 2, .falloff = 3, .impulse = 40 });
#ifndef PLUMB_EFFECT_H
#define PLUMB_EFFECT_H

#include "plumb/query.h"

PLUMB_BEGIN

/// What shields bodies from a blast. The parts of one body always shield one another.
typedef enum plumb_occlusion {
    PLUMB_OCCLUDE_NOTHING, ///< no other body
    PLUMB_OCCLUDE_WALLS,   ///< static and kinematic bodies
    PLUMB_OCCLUDE_ALL      ///< every other body
} plumb_occlusion;

/// {0} is not an explosion: it needs a reach.
typedef struct plumb_explosion_desc {
    plumb_vec2 position; ///< [m] |x|, |y| <= 1e9
    plumb_real radius;   ///< [m] >= 0, as far as this it has its full strength
    plumb_real falloff;  ///< [m] >= 0, over this further way its strength falls evenly to 0;
                         ///< 0 < radius + falloff <= 1e7
    /// [N s/m] per metre of its front, away from `position`: a surface gets it as far as it faces the
    /// blast, where it is hit. Negative draws bodies in.
    plumb_real impulse;
    bool per_body;             ///< `impulse` is [N s] a body instead, away from `position` through its centre of mass,
                               ///< times the share of the body that the blast reaches
    plumb_occlusion occlusion; ///< default: nothing shields
    plumb_query_filter filter; ///< which shapes are hit; {0}: all but sensors
} plumb_explosion_desc;

/// Pushes dynamic bodies away from a point at once, and wakes those that it pushes. A disc of radius R at the distance D
/// within `radius` gets impulse * (D (t + sin t cos t) - pi R^2 / (2 D)), sin t = R / D, which is 2 R impulse
/// from far off. A convex piece that contains the point is pushed as if the blast were at its far side: along
/// the way to its body's centre, by its width across. A blast inside what shields reaches nothing.
/// Each piece is hit by 32 rays; what shields is asked of each. O(pieces near x 32 rays).
/// Errors: E_NULL, E_RANGE, E_NOT_FINITE (also: the velocity of a body would not be), E_HANDLE (filter), E_MEMORY;
/// then no body is pushed.
PLUMB_API plumb_result plumb_world_explode(plumb_world *world, const plumb_explosion_desc *desc);

/// What a library may be built without: `make EFFECTS="all -liquid"`. Whatever asks for what is not in it is refused:
/// E_UNSUPPORTED. What is on by default is off without it: gravity, friction, `continuous`.
typedef struct plumb_effect {
    const char *name; ///< "liquid"
    const char *text; ///< "particles that flow"
    bool present;     ///< it is in this library
} plumb_effect;

/// All of them, and how many (`count` may be null). Constant.
PLUMB_API const plumb_effect *plumb_effects(int *count);

PLUMB_END

#endif
