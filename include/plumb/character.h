/// character.h - bodies that walk: slopes, steps, jumps, moving and one-way platforms, pushing.
///
///     plumb_body hero = plumb_body_create(world, &(plumb_body_desc){ .type = PLUMB_KINEMATIC });
///     plumb_shape_create(world, hero, &(plumb_shape_desc){ .kind = PLUMB_CAPSULE, .points = ends,
///                                                          .count = 2, .radius = 0.3f });
///     plumb_character_create(world, hero, NULL);
///     plumb_character_walk(world, hero, 3);      // until told otherwise
///     plumb_character_jump(world, hero, 5);
///
/// A character is a body whose motion is made by the step from what was asked of it. The type of the
/// body tells how:
/// - kinematic: it goes where it is told, collides and slides along everything, stands still on slopes,
///   climbs steps, follows the ground downhill, is carried by what it stands on (exactly, turning
///   and belts, see plumb_material_desc.surface_speed, included), is pushed aside by kinematic bodies, never pushed by dynamic ones. Other bodies meet it
///   as a kinematic body; it pushes dynamic ones with a limited force and weighs on them. Water, air and laws do not
///   move it: a game that sees it in water (events of the water's sensor) lets it swim by plumb_character_fly.
/// - dynamic: a body that cannot turn, driven by forces: everything can push it, its mass counts.
/// When the body's type is changed, it goes on as the other kind, by those of its settings that are for both.
/// Its shape is the first of the body's that is no sensor, one convex piece (a capsule, best), as it is turned
/// when the step begins.
///
/// Motion does not depend on the length of steps: walking goes by the way along the ground, jumps are exact
/// parabolas, accelerations are integrated exactly; src/character/DECISIONS.md has measured differences.
#ifndef PLUMB_CHARACTER_H
#define PLUMB_CHARACTER_H

#include "plumb/body.h"
#include "plumb/shape.h"

PLUMB_BEGIN

/// {0} is valid. Fields marked k are of kinematic characters and must be 0 for dynamic ones.
typedef struct plumb_character_desc {
    plumb_vec2 up; ///< direction, any length; {0, 0}: against gravity, or plumb_world_up without.
                   ///< Walking to the right is walking to `up` turned clockwise, as seen on a screen:
                   ///< to +x on level ground, whichever way y points
    /// [rad] 0..1.5, steepest ground to stand and walk on; 0 means 50 degrees
    plumb_real max_slope;
    plumb_real skin;        ///< k [m] distance kept from everything; 0: 1/50 of its half width
    plumb_real step_height; ///< k [m] highest step that is walked up; 0: a quarter of its height
    /// k [m] narrowest tread that counts as one; 0: a quarter of its half width
    plumb_real step_width;
    /// k [m] largest drop of the ground that it follows; 0: as step_height
    plumb_real snap_distance;
    /// [m/s^2] of walking and flying; 0: the wanted velocity is reached at once
    /// (dynamic: 40)
    plumb_real acceleration;
    plumb_real air_acceleration; ///< [m/s^2] sideways in the air; 0: as `acceleration`
    plumb_real max_fall_speed;   ///< k [m/s] 0: no limit
    /// k [kg] weight on dynamic bodies it stands on; on what gives way three times what that weighs at most; 0 means 70
    plumb_real mass;
    /// k [N] most force on dynamic bodies in its way; 0: 10 m/s^2 times `mass`
    plumb_real push_force;
    bool no_steps;       ///< k it does not climb steps
    bool no_snap;        ///< k it does not follow the ground downwards
    bool no_push;        ///< k dynamic bodies in its way are walls to it
    bool no_air_control; ///< in the air its velocity is left alone
} plumb_character_desc;

/// Makes a body a character. `desc` may be null (= {0}). Errors: E_HANDLE, E_STATE (static body, already one),
/// E_RANGE, E_NOT_FINITE, E_MEMORY, E_LOCKED.
PLUMB_API plumb_result plumb_character_create(plumb_world *world, plumb_body body,
                                              const plumb_character_desc *desc);
/// Makes it an ordinary body again; also done when the body is destroyed. Errors: E_HANDLE (no character),
/// E_LOCKED.
PLUMB_API plumb_result plumb_character_destroy(plumb_world *world, plumb_body body);
PLUMB_API bool plumb_body_is_character(const plumb_world *world, plumb_body body);

/// The settings in force, sizes that are 0 as given. Errors: E_HANDLE, E_NULL.
PLUMB_API plumb_result plumb_character_settings(const plumb_world *world, plumb_body body,
                                                plumb_character_desc *desc);
/// Changes the settings from the next step on. Errors: as plumb_character_create.
PLUMB_API plumb_result plumb_character_set(plumb_world *world, plumb_body body,
                                           const plumb_character_desc *desc);

/// Walks at `speed` [m/s] along the ground, uphill and downhill alike, relative to what it stands on;
/// positive to the right. Holds until changed. In the air it is the sideways velocity, in addition to that of the
/// ground that it left, until it lands or a wall stops it.
/// Errors: E_HANDLE, E_NOT_FINITE.
PLUMB_API plumb_result plumb_character_walk(plumb_world *world, plumb_body body, plumb_real speed);
/// Moves at `velocity` [m/s] through the air, without gravity, sliding along what it meets: swimming,
/// ladders, worlds seen from above. Holds until plumb_character_walk is called. Errors: E_HANDLE, E_NOT_FINITE.
PLUMB_API plumb_result plumb_character_fly(plumb_world *world, plumb_body body,
                                           plumb_vec2 velocity);
/// Leaves the ground in the next step at `speed` [m/s] > 0 against it, in addition to the ground's own
/// velocity. False, and nothing happens, if it does not stand on ground now; also on errors (E_HANDLE, E_RANGE,
/// E_NOT_FINITE).
PLUMB_API bool plumb_character_jump(plumb_world *world, plumb_body body, plumb_real speed);
/// Gives it a velocity [m/s] at once (a blow, a spring board): it leaves the ground when that points away
/// from it. Errors: E_HANDLE, E_NOT_FINITE.
PLUMB_API plumb_result plumb_character_set_velocity(plumb_world *world, plumb_body body,
                                                    plumb_vec2 velocity);
/// Drops through the one-way shape it stands on. False, and nothing happens, if it stands on none; also on
/// errors (E_HANDLE).
PLUMB_API bool plumb_character_drop(plumb_world *world, plumb_body body);

/// What a character does after the last step.
typedef struct plumb_character_state {
    plumb_vec2 velocity;    ///< [m/s] in the world
    plumb_vec2 up;          ///< unit, in force
    bool on_ground;         ///< it stands on ground no steeper than max_slope, or climbs a step
    bool on_slope;          ///< it touches ground that is too steep, and slides
    bool at_wall;           ///< something stopped it sideways in the last step
    bool at_ceiling;        ///< something stopped it upwards
    bool crushed;           ///< k it is squeezed between things and overlaps one of them
    plumb_real air_time;    ///< [s] since it left the ground; 0 on it
    plumb_body ground_body; ///< what it stands on; null in the air
    plumb_shape ground_shape;
    plumb_vec2 ground_point;    ///< [m] where
    plumb_vec2 ground_normal;   ///< unit, out of the ground
    plumb_vec2 ground_velocity; ///< [m/s] of the ground there
    plumb_real ground_spin;     ///< [rad/s] of the ground: by which a game turns what stands on it
} plumb_character_state;

/// Errors: E_HANDLE, E_NULL.
PLUMB_API plumb_result plumb_character_get(const plumb_world *world, plumb_body body,
                                           plumb_character_state *state);

/// Something that a kinematic character met in the last step.
typedef struct plumb_character_hit {
    plumb_shape shape;
    plumb_body body;
    plumb_vec2 point;  ///< [m] on the shape that was met
    plumb_vec2 normal; ///< unit, out of it
    plumb_real speed;  ///< [m/s] of approach
} plumb_character_hit;

#define PLUMB_CHARACTER_HITS 8 ///< most that are kept of a step

/// What it met in the last step, in order; ground that it stood on already is not told. Writes up to
/// `capacity`, returns how many there are; -1 on error: E_HANDLE, E_RANGE (capacity), E_NULL.
PLUMB_API int plumb_character_hits(const plumb_world *world, plumb_body body,
                                   plumb_character_hit *hits, int capacity);

PLUMB_END

#endif
