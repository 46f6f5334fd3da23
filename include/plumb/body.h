/// body.h - rigid bodies: made, moved, pushed, asked.
///
/// A body's frame has its origin where the user put it; the solver works at the centre of mass.
/// Getters take a const world; on a bad handle they return zeros, and plumb_world_error and the log tell so, as of
/// any refused call. plumb_body_valid, plumb_entity_alive and the like ask about the handle and tell nothing.
#ifndef PLUMB_BODY_H
#define PLUMB_BODY_H

#include "plumb/geometry.h"
#include "plumb/world.h"

PLUMB_BEGIN

typedef enum plumb_body_type {
    PLUMB_DYNAMIC,   ///< moved by forces and contacts
    PLUMB_KINEMATIC, ///< moved by its velocity alone, as if of infinite mass
    PLUMB_STATIC     ///< does not move
} plumb_body_type;

/// {0} is valid: a dynamic body at rest at the origin.
typedef struct plumb_body_desc {
    plumb_body_type type;        ///< default PLUMB_DYNAMIC
    plumb_vec2 position;         ///< [m] of the body's origin, finite, |x|, |y| <= 1e9
    plumb_real angle;            ///< [rad] finite
    plumb_vec2 velocity;         ///< [m/s] of the centre of mass; must be 0 for static bodies
    plumb_real angular_velocity; ///< [rad/s]; must be 0 for static bodies
    plumb_real mass;             ///< [kg] >= 0; 0: from the shapes' densities
    plumb_real inertia;          ///< [kg m^2] about the centre, >= 0; 0: from the shapes, scaled to `mass`
    plumb_real gravity_scale;    ///< [-] factor on gravity; 0 means 1 (see no_gravity)
    bool no_gravity;             ///< gravity does not act on this body
    bool fixed_rotation;         ///< it never turns: infinite inertia; `angular_velocity` must then be 0
    bool no_sleep;               ///< it never falls asleep, nor what it touches: see plumb/sleep.h
    bool asleep;                 ///< dynamic, without velocity: it starts asleep, alone, and sleeps on while
                                 ///< shapes and joints are added before the next step. In a world without
                                 ///< sleeping it starts awake
    bool continuous;             ///< dynamic bodies: however fast, this body and other dynamic ones do not
                                 ///< pass through each other (static and kinematic ones are never passed)
    bool lock_x, lock_y;         ///< its centre never moves along that axis: infinite mass that way; then
                                 ///< `velocity` must be 0 along it. As fixed_rotation, for dynamic bodies
    plumb_real damping;          ///< [1/s] >= 0: see plumb_body_set_damping
    plumb_real angular_damping;  ///< [1/s] >= 0
    plumb_real max_speed;        ///< [m/s] >= 0: see plumb_body_set_speed_cap; 0: none
    plumb_real max_spin;         ///< [rad/s] >= 0; 0: none
    plumb_real time_scale;       ///< [-] 0..100: see plumb_body_set_time_scale; 0 means 1
    plumb_real charge;           ///< [C]: see plumb/law.h
    plumb_real attraction;       ///< [-] 0..1e6: see plumb/law.h
    plumb_real dipole;           ///< [C m]: see plumb/law.h
    plumb_real dipole_angle;     ///< [rad] whereto it points, from the x axis of the body's frame
    plumb_real drag;             ///< [kg/m] 0..1e9: see plumb_body_set_drag
    plumb_real thrust;           ///< [N] 0..1e12: see plumb_body_set_thrust
    plumb_real exhaust;          ///< [m/s] 0..1e9 of its engine; 0: it burns nothing
    plumb_real fuel;             ///< [kg] 0..1e12 left, part of the mass
    plumb_real thrust_x;         ///< [m] of its engine in the body's frame
    plumb_real thrust_y;         ///< [m]
    plumb_real thrust_angle;     ///< [rad] whereto it pushes, from the x axis of the body's frame
    plumb_real break_force;      ///< [N] >= 0: see plumb_body_set_break_force in plumb/fracture.h
    plumb_real break_impulse;    ///< [N s] >= 0
    plumb_real break_energy;     ///< [J] >= 0
    plumb_real break_cells;      ///< [-] 0..64 that it breaks into at most; 0 means 12
    plumb_real temperature;      ///< [K] 0..1e6: see plumb/heat.h; 0: it takes no part in heat
    plumb_real heat_capacity;    ///< [J/(kg K)] up to 1e9; 0 means 1000
    plumb_real conductance;      ///< [W/K] 0..1e9 of its half of each contact
    plumb_real emissivity;       ///< [-] 0..1 of its surface
    plumb_real ambient;          ///< [K] up to 1e6 around it; 0 means 293
    plumb_real heating;          ///< [W] |heating| <= 1e12
    plumb_real melting_point;    ///< [K] 0..1e6; 0: it does not melt
    plumb_real latent_heat;      ///< [J/kg] 0..1e12
    plumb_real melt_phase;       ///< [-] 0..7 of the liquid that it melts into
    plumb_real ignition;         ///< [K] 0..1e6; 0: it does not burn
    plumb_real burn_rate;        ///< [m/s] 0..1e3 at which its surface burns away
    plumb_real burn_heat;        ///< [J/kg] 0..1e12 of what burns that stays with the body
    plumb_real growth;           ///< [1/s] |growth| <= 100
    plumb_real smallest;         ///< [m] up to 1e4; 0 means 0.02
    bool disabled;               ///< out of the simulation: see plumb_body_set_enabled
    void *user_data;             ///< see plumb_body_user_data
} plumb_body_desc;

/// Makes a body without shapes: a dynamic one has `mass` (1 kg if 0) and no inertia until it has.
/// Null handle on error: E_NULL, E_RANGE, E_NOT_FINITE, E_MEMORY, E_LOCKED. O(1) amortised.
PLUMB_API plumb_body plumb_body_create(plumb_world *world, const plumb_body_desc *desc);

/// Reads what the body is now, as a descriptor that would make another like it, without its shapes: `mass` and `inertia`
/// only where they were given. A time scale of 0 cannot be told so: there 0 means 1. O(1). Errors: E_HANDLE, E_NULL.
PLUMB_API plumb_result plumb_body_settings(const plumb_world *world, plumb_body body, plumb_body_desc *desc);

/// Destroys a body, its shapes and its contacts (their end is told after the next step). Errors: E_HANDLE,
/// E_LOCKED.
PLUMB_API plumb_result plumb_body_destroy(plumb_world *world, plumb_body body);

/// True for a live handle of a body.
PLUMB_API bool plumb_body_valid(const plumb_world *world, plumb_body body);

/// Its type; PLUMB_DYNAMIC for a bad handle.
PLUMB_API plumb_body_type plumb_body_get_type(const plumb_world *world, plumb_body body);
/// Changes what moves the body. A body that ceases to be dynamic loses mass, forces and a centre that was
/// given; one that becomes dynamic has the mass of its shapes, or that of the descriptor or of
/// plumb_body_set_mass. Static bodies lose their velocity. Shapes, joints, settings and touches stay.
/// O(pieces of the body). Errors: E_HANDLE, E_RANGE (type; mass or inertia of its shapes), E_LOCKED.
PLUMB_API plumb_result plumb_body_set_type(plumb_world *world, plumb_body body, plumb_body_type type);

/// Takes a body out of the simulation (false) or back in. Out of it, nothing moves it, nothing meets it
/// and no query sees it; its joints rest, and its touches end with the next step. It keeps shapes, joints,
/// velocity and settings, and all of them can be changed, but it takes no forces and impulses. Idempotent.
/// O(pieces of the body), needs no memory. Errors: E_HANDLE, E_LOCKED.
PLUMB_API plumb_result plumb_body_set_enabled(plumb_world *world, plumb_body body, bool enabled);
/// False when disabled, and for a bad handle.
PLUMB_API bool plumb_body_is_enabled(const plumb_world *world, plumb_body body);

/// [m] origin of the body's frame.
PLUMB_API plumb_vec2 plumb_body_position(const plumb_world *world, plumb_body body);
/// [m] centre of mass.
PLUMB_API plumb_vec2 plumb_body_center(const plumb_world *world, plumb_body body);
/// [rad] in (-pi, pi].
PLUMB_API plumb_real plumb_body_angle(const plumb_world *world, plumb_body body);
/// Frame of the body: origin and rotation.
PLUMB_API plumb_transform plumb_body_transform(const plumb_world *world, plumb_body body);
/// [m/s] of the centre of mass.
PLUMB_API plumb_vec2 plumb_body_velocity(const plumb_world *world, plumb_body body);
/// [rad/s]
PLUMB_API plumb_real plumb_body_angular_velocity(const plumb_world *world, plumb_body body);
/// [m/s] of the body's material point now at the world point [m].
PLUMB_API plumb_vec2 plumb_body_velocity_at(const plumb_world *world, plumb_body body, plumb_vec2 point);
/// [kg]; 0 for static and kinematic bodies.
PLUMB_API plumb_real plumb_body_mass(const plumb_world *world, plumb_body body);
/// [kg m^2] about the centre of mass; 0 when the body cannot turn.
PLUMB_API plumb_real plumb_body_inertia(const plumb_world *world, plumb_body body);
/// [m] centre of mass in the body's frame.
PLUMB_API plumb_vec2 plumb_body_local_center(const plumb_world *world, plumb_body body);

/// Moves a body at once, without travel: contacts are found anew. [m], [rad]. One that is there already keeps its contacts, and
/// sleeps on if it does.
/// Errors: E_HANDLE, E_RANGE, E_NOT_FINITE, E_LOCKED.
PLUMB_API plumb_result plumb_body_teleport(plumb_world *world, plumb_body body, plumb_vec2 position,
                                           plumb_real angle);

/// plumb_body_teleport that keeps the angle, or the position.
PLUMB_API plumb_result plumb_body_set_position(plumb_world *world, plumb_body body, plumb_vec2 position);
PLUMB_API plumb_result plumb_body_set_angle(plumb_world *world, plumb_body body, plumb_real angle);

/// Sends a kinematic body to a pose [m], [rad], to be there after dt [s], turning the shorter way. Steps
/// move it straight and evenly, so that what it meets is pushed and carried; in the step in which the time
/// is up it arrives, its pose is the target exactly, and it stands still from then on. With dt the step of
/// the world, that is the next one; a shorter dt makes it push as if it were as fast as that says. A new target,
/// velocity, teleport or type takes the place of this one.
/// O(1). Errors: E_HANDLE, E_RANGE, E_NOT_FINITE, E_STATE (not kinematic), E_MEMORY.
PLUMB_API plumb_result plumb_body_set_target(plumb_world *world, plumb_body body, plumb_vec2 position,
                                             plumb_real angle, plumb_real dt);
/// Sends a kinematic body to a pose as above, to arrive there after dt [s] with a velocity [m/s] of its centre of mass and an
/// angular velocity [rad/s], with which it goes on. From the pose and the velocity that it has now it goes by cubics of
/// time: keyframes are joined so, and the velocity has no jumps; with both velocities 0 it starts and stops smoothly. What it
/// carries bears m (g + a) in every substep. It turns the way, and as often, as comes nearest to what its angular
/// velocities would turn it by. dt is of the world's time, and need not be a number of steps: for what is left of the step in which it
/// arrives it goes on (the next keyframe is due so much earlier); within one step it is spread over that.
/// O(1). Errors: E_HANDLE, E_RANGE (also where it would be faster than 1e12 m/s), E_NOT_FINITE, E_STATE (not
/// kinematic), E_MEMORY.
PLUMB_API plumb_result plumb_body_set_target_moving(plumb_world *world, plumb_body body, plumb_vec2 position,
                                                    plumb_real angle, plumb_vec2 velocity,
                                                    plumb_real angular_velocity, plumb_real dt);
/// True while the body is on its way to a target.
PLUMB_API bool plumb_body_has_target(const plumb_world *world, plumb_body body);

/// Sets the velocity [m/s] of the centre of mass. Errors: E_HANDLE, E_NOT_FINITE, E_STATE (static; not 0
/// along a locked axis).
PLUMB_API plumb_result plumb_body_set_velocity(plumb_world *world, plumb_body body, plumb_vec2 velocity);
/// Sets the angular velocity [rad/s]. Errors: E_HANDLE, E_NOT_FINITE, E_STATE (static; not 0 and fixed rotation).
PLUMB_API plumb_result plumb_body_set_angular_velocity(plumb_world *world, plumb_body body, plumb_real w);

/// Adds a force [N] at a world point [m] for the next step. The same force in each step lets a body at rest
/// sleep; another wakes it: see plumb/sleep.h. Errors: E_HANDLE, E_NOT_FINITE, E_STATE
/// (not dynamic, or disabled).
PLUMB_API plumb_result plumb_body_apply_force(plumb_world *world, plumb_body body, plumb_vec2 force,
                                              plumb_vec2 point);
/// Adds a force [N] at the centre of mass for the next step. Errors as above.
PLUMB_API plumb_result plumb_body_apply_force_center(plumb_world *world, plumb_body body, plumb_vec2 force);
/// Adds a torque [N m] for the next step. Errors as above.
PLUMB_API plumb_result plumb_body_apply_torque(plumb_world *world, plumb_body body, plumb_real torque);
/// Takes back the forces and torques given for the next step. Errors: E_HANDLE.
PLUMB_API plumb_result plumb_body_clear_forces(plumb_world *world, plumb_body body);
/// [N], [N m] given for the next step so far.
PLUMB_API plumb_vec2 plumb_body_force(const plumb_world *world, plumb_body body);
PLUMB_API plumb_real plumb_body_torque(const plumb_world *world, plumb_body body);
/// Changes the velocity at once by an impulse [N s] at a world point [m]. Errors as above.
PLUMB_API plumb_result plumb_body_apply_impulse(plumb_world *world, plumb_body body, plumb_vec2 impulse,
                                                plumb_vec2 point);
/// Impulse [N s] at the centre of mass. Errors as above.
PLUMB_API plumb_result plumb_body_apply_impulse_center(plumb_world *world, plumb_body body,
                                                       plumb_vec2 impulse);
/// Angular impulse [N m s]. Errors as above.
PLUMB_API plumb_result plumb_body_apply_angular_impulse(plumb_world *world, plumb_body body,
                                                        plumb_real impulse);

/// Gives the body a mass [kg] > 0; the inertia scales along. Errors: E_HANDLE, E_RANGE, E_NOT_FINITE,
/// E_STATE (not dynamic).
PLUMB_API plumb_result plumb_body_set_mass(plumb_world *world, plumb_body body, plumb_real mass);
/// Gives the body an inertia [kg m^2] > 0 about its centre of mass. Errors as above.
PLUMB_API plumb_result plumb_body_set_inertia(plumb_world *world, plumb_body body, plumb_real inertia);
/// Puts the centre of mass at a point [m] of the body's frame, whatever its shapes say; an inertia that
/// was not given follows by the parallel axis theorem, and the velocity follows the rigid motion.
/// Errors: E_HANDLE, E_RANGE (|x|, |y| <= 1e7; inertia), E_NOT_FINITE, E_STATE (not dynamic).
PLUMB_API plumb_result plumb_body_set_local_center(plumb_world *world, plumb_body body, plumb_vec2 center);
/// Computes mass, centre and inertia from the shapes' densities again. Errors: E_HANDLE, E_STATE.
PLUMB_API plumb_result plumb_body_reset_mass(plumb_world *world, plumb_body body);
/// Forbids or allows turning. Errors: E_HANDLE, E_STATE (not dynamic).
PLUMB_API plumb_result plumb_body_set_fixed_rotation(plumb_world *world, plumb_body body, bool fixed);
/// Whether it and other dynamic bodies, however fast, do not pass through each other: see
/// plumb_body_desc.continuous. Costs a search among what moves nearby in steps in which either moves
/// fast. Errors: E_HANDLE, E_STATE (not dynamic).
PLUMB_API plumb_result plumb_body_set_continuous(plumb_world *world, plumb_body body, bool continuous);
PLUMB_API bool plumb_body_is_continuous(const plumb_world *world, plumb_body body);

/// Axes along which a body does not move, whatever pushes it: there it has infinite mass, for contacts and
/// joints alike. x, y are those of the world and hold the centre of mass; rotation is fixed_rotation.
typedef struct plumb_axis_locks {
    bool x, y, rotation;
} plumb_axis_locks;

/// Locks and frees axes; velocity along a locked one becomes 0. Worlds without locks in x or y pay nothing
/// for them, others solve contacts with a slower kernel. Errors: E_HANDLE, E_STATE (not dynamic).
PLUMB_API plumb_result plumb_body_set_locks(plumb_world *world, plumb_body body, plumb_axis_locks locks);
PLUMB_API plumb_axis_locks plumb_body_locks(const plumb_world *world, plumb_body body);

/// Damping rates [1/s] >= 0 of a dynamic body: dv/dt = a - linear v, dw/dt = a - angular w. Velocities
/// follow the exact exponential whatever the step and substeps; so do places of a body that nothing
/// touches (else within (rate h)^2 / 12 of the way, h the substep, and a body at rest weighs less by the
/// share rate h / 2). Linear c is a top speed of a / c.
/// Bodies without damping pay nothing. Errors: E_HANDLE, E_RANGE, E_NOT_FINITE, E_MEMORY.
PLUMB_API plumb_result plumb_body_set_damping(plumb_world *world, plumb_body body, plumb_real linear,
                                              plumb_real angular);
PLUMB_API plumb_real plumb_body_damping(const plumb_world *world, plumb_body body);
PLUMB_API plumb_real plumb_body_angular_damping(const plumb_world *world, plumb_body body);

/// Drag [kg/m] 0..1e9 of still air on a dynamic body, at its centre of mass: a force -drag |v| v, besides that of
/// damping. Of a shape it is density of the air times drag coefficient times width / 2: 0.7 of a ball of 1 m in
/// air of 1.2 kg/m^2. Top speed of what falls: sqrt(m g / drag). Exact for what falls from rest and for what slows down alone,
/// with damping or without, whatever the step; top speeds are exact, other motion is of second order in the substep. A
/// body at rest weighs less by the share drag g h^2 / (3 m). Where air flows, or shapes are to be dragged by their outlines:
/// a sensor of a fluid, see plumb/material.h. Bodies without it pay nothing. Default 0. Errors: E_HANDLE, E_RANGE,
/// E_NOT_FINITE, E_MEMORY, E_UNSUPPORTED (a library without it).
PLUMB_API plumb_result plumb_body_set_drag(plumb_world *world, plumb_body body, plumb_real drag);
PLUMB_API plumb_real plumb_body_drag(const plumb_world *world, plumb_body body);

/// An engine: thrust [N] 0..1e12 that pushes a dynamic body at the point (thrust_x, thrust_y) [m] of its frame towards thrust_angle
/// [rad] in it, until it is set to 0. With an exhaust speed [m/s] it burns thrust / exhaust a second of its fuel [kg], which is
/// part of the body's mass: mass and inertia fall alike, the centre of mass stays, and it ends when the fuel is out, within
/// the substep. The speed that it wins is exhaust ln(m0 / m1), whatever the step (the rocket equation); places are of second
/// order. With exhaust 0 (the default) it burns nothing and never ends. It does not run while fuel is not less than the
/// mass. A mass that burns is given from then on (as by plumb_body_set_mass). A body whose engine runs does not fall
/// asleep. Bodies without thrust pay nothing. Errors: E_HANDLE, E_RANGE, E_NOT_FINITE, E_MEMORY, E_UNSUPPORTED (a library
/// without it).
PLUMB_API plumb_result plumb_body_set_thrust(plumb_world *world, plumb_body body, plumb_real thrust);
PLUMB_API plumb_real plumb_body_thrust(const plumb_world *world, plumb_body body);
PLUMB_API plumb_result plumb_body_set_exhaust(plumb_world *world, plumb_body body, plumb_real exhaust);
PLUMB_API plumb_real plumb_body_exhaust(const plumb_world *world, plumb_body body);
/// The mass stays as it is: fuel that is taken aboard is added by plumb_body_set_mass.
PLUMB_API plumb_result plumb_body_set_fuel(plumb_world *world, plumb_body body, plumb_real fuel);
PLUMB_API plumb_real plumb_body_fuel(const plumb_world *world, plumb_body body);
PLUMB_API plumb_result plumb_body_set_thrust_x(plumb_world *world, plumb_body body, plumb_real thrust_x);
PLUMB_API plumb_real plumb_body_thrust_x(const plumb_world *world, plumb_body body);
PLUMB_API plumb_result plumb_body_set_thrust_y(plumb_world *world, plumb_body body, plumb_real thrust_y);
PLUMB_API plumb_real plumb_body_thrust_y(const plumb_world *world, plumb_body body);
PLUMB_API plumb_result plumb_body_set_thrust_angle(plumb_world *world, plumb_body body,
                                                   plumb_real thrust_angle);
PLUMB_API plumb_real plumb_body_thrust_angle(const plumb_world *world, plumb_body body);

/// Speeds [m/s], [rad/s] >= 0 that a dynamic body never ends a step with more than; 0: no cap, the default.
/// Bodies without a cap pay nothing. Errors: E_HANDLE, E_RANGE, E_NOT_FINITE, E_MEMORY.
PLUMB_API plumb_result plumb_body_set_speed_cap(plumb_world *world, plumb_body body, plumb_real max_speed,
                                                plumb_real max_spin);
PLUMB_API plumb_real plumb_body_max_speed(const plumb_world *world, plumb_body body);
PLUMB_API plumb_real plumb_body_max_spin(const plumb_world *world, plumb_body body);

/// How many seconds [-] 0..100 a dynamic or kinematic body lives in a second of the world: below 1 is slow
/// motion, 0 stands still. Its velocity, damping, caps and accelerations are those of its own time: it goes
/// through the same path at `scale` times the speed, and on from there when the scale is 1 again. To others
/// it is a body of mass / scale^2 that moves at scale times its velocity: surfaces do not cross, forces
/// balance (it weighs what it weighs), and the energy m v^2 / 2 is kept when bodies of different time
/// meet. Bodies of scale 1 pay nothing. Errors: E_HANDLE, E_RANGE, E_NOT_FINITE, E_MEMORY.
PLUMB_API plumb_result plumb_body_set_time_scale(plumb_world *world, plumb_body body, plumb_real scale);
PLUMB_API plumb_real plumb_body_time_scale(const plumb_world *world, plumb_body body);

/// Sets the factor on gravity [-], finite; 0 is none. Errors: E_HANDLE, E_NOT_FINITE.
PLUMB_API plumb_result plumb_body_set_gravity_scale(plumb_world *world, plumb_body body,
                                                    plumb_real gravity_scale);
PLUMB_API plumb_real plumb_body_gravity_scale(const plumb_world *world, plumb_body body);

/// A pointer of your own, null until set; the library only keeps it. Errors: E_HANDLE.
PLUMB_API plumb_result plumb_body_set_user_data(plumb_world *world, plumb_body body, void *user_data);
PLUMB_API void *plumb_body_user_data(const plumb_world *world, plumb_body body);

/// Shapes of a body in order of creation: writes up to `capacity`, returns how many there are.
PLUMB_API int plumb_body_shapes(const plumb_world *world, plumb_body body, plumb_shape *shapes,
                                int capacity);

/// [J] of translation and rotation; 0 for static and kinematic bodies.
PLUMB_API plumb_real plumb_body_kinetic_energy(const plumb_world *world, plumb_body body);

/// Box around all shapes [m]; empty (min > max) without shapes.
PLUMB_API plumb_aabb plumb_body_aabb(const plumb_world *world, plumb_body body);

/// A point or vector of the body's frame in world coordinates, and back.
PLUMB_API plumb_vec2 plumb_body_world_point(const plumb_world *world, plumb_body body, plumb_vec2 local);
PLUMB_API plumb_vec2 plumb_body_local_point(const plumb_world *world, plumb_body body, plumb_vec2 point);
PLUMB_API plumb_vec2 plumb_body_world_vector(const plumb_world *world, plumb_body body, plumb_vec2 local);
PLUMB_API plumb_vec2 plumb_body_local_vector(const plumb_world *world, plumb_body body, plumb_vec2 vector);

/// The body columns as they are stored: no copy. Rows are dense and partitioned: awake dynamic rows
/// first, then kinematic, then asleep, then static, then disabled. Valid until the next step or structural change.
/// Rows keep their order but for these moves: a body that falls asleep becomes the first sleeping row, one
/// that wakes the last awake one; the last row of each partition that lost one fills its gap.
/// Velocities and forces may be written (rows below dynamic_count; kinematic velocities too). Of sleeping rows
/// forces may be, and wake where they differ from those that the body fell asleep under (plumb/sleep.h);
/// velocities must not be: nothing would wake the body, see plumb_body_wake and the setters.
typedef struct plumb_body_span {
    int count;           ///< all rows
    int dynamic_count;   ///< rows [0, dynamic_count) are awake dynamic
    int kinematic_count; ///< then so many kinematic rows
    int asleep_count;    ///< then so many sleeping rows
    int static_count;    ///< then so many static rows
    int disabled_count;  ///< then so many rows of disabled bodies, of any type
    const plumb_body *body;
    const plumb_real *x, *y;               ///< [m] origin
    const plumb_real *center_x, *center_y; ///< [m] centre of mass
    const plumb_real *c, *s;               ///< cosine, sine of the angle
    plumb_real *vx, *vy;                   ///< [m/s]
    plumb_real *w;                         ///< [rad/s]
    plumb_real *fx, *fy;                   ///< [N] summed for the next step
    plumb_real *torque;                    ///< [N m] summed for the next step
    const plumb_real *inv_mass;            ///< [1/kg]
    const plumb_real *inv_inertia;         ///< [1/(kg m^2)]
} plumb_body_span;

/// The span of now; all zero for null. O(1).
PLUMB_API plumb_body_span plumb_world_bodies(plumb_world *world);

PLUMB_END

#endif
