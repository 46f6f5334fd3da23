/// joint.h - joints: what ties two bodies, or a body and the world, together.
///
///     plumb_joint hinge = plumb_joint_create(world, &(plumb_joint_desc){
///         .kind = PLUMB_REVOLUTE, .body_a = door, .anchor = { 1, 2 } });
///
/// Points and directions in the descriptor are in world coordinates, as things are when the joint is
/// made; from then on they move with their bodies. Angles and lengths are those of B seen from A.
/// A null body is the world. Joints are rigid unless a spring is asked for.
#ifndef PLUMB_JOINT_H
#define PLUMB_JOINT_H

#include "plumb/world.h"

PLUMB_BEGIN

/// Every kind of joint: X(NAME, name, text). The one list: enum, table, scene words.
// clang-format off
#define PLUMB_JOINT_LIST(X)                                                                         \
    X(REVOLUTE,  revolute,  "a common point, free to turn; limit, motor, rotary spring")            \
    X(PRISMATIC, prismatic, "slides along an axis of A, does not turn; limit, motor, spring")       \
    X(WELD,      weld,      "nothing moves; a spring softens the angle")                            \
    X(WHEEL,     wheel,     "slides along an axis of A and turns; suspension spring, limit, motor") \
    X(DISTANCE,  distance,  "rod; with limits a rope or slack rod, with a spring a spring")         \
    X(MOUSE,     mouse,     "a point of B is drawn to a target in the world or on A")               \
    X(MOTOR,     motor,     "B is driven to a pose relative to A by bounded force and torque")      \
    X(GEAR,      gear,      "turns, or a turn and a travel, keep a ratio")                          \
    X(PULLEY,    pulley,    "length of A's rope + ratio * length of B's rope is constant")          \
    X(RATCHET,   ratchet,   "B turns one way only, relative to A; falls back by less than a tooth") \
    X(FRICTION,  friction,  "resists motion of B over A by bounded force and torque")               \
    X(CABLE,     cable,     "a rope from rim to rim, which it winds on and off; it only pulls")
// clang-format on

typedef enum plumb_joint_kind {
#define PLUMB_JOINT_ENUM(NAME, name, text) PLUMB_##NAME,
    PLUMB_JOINT_LIST(PLUMB_JOINT_ENUM)
#undef PLUMB_JOINT_ENUM
} plumb_joint_kind;

/// {0} with one body is a hinge at the world's origin. "Value" is the joint's coordinate: see
/// plumb_joint_value. Members that a kind does not have must be 0 (E_RANGE). Bounds without enable_limit, motor
/// members without enable_motor and a motor with max_motor 0 are allowed, do nothing, and are a warning in the log.
typedef struct plumb_joint_desc {
    plumb_joint_kind kind;
    plumb_body body_a, body_b; ///< not both null, not the same; null: the world
    plumb_vec2 anchor;         ///< [m] the common point; distance, pulley: on A; mouse: the point of B; cable: centre of
                               ///< the rim on A; gear: not used, it acts at the centres of mass, which are told as its
                               ///< anchors
    plumb_vec2 anchor_b;       ///< [m] distance, pulley: on B; cable: centre of the rim on B
    plumb_vec2 ground_a;       ///< [m] pulley: the wheel of A's rope, on the world
    plumb_vec2 ground_b;       ///< [m] pulley: the wheel of B's rope, on the world
    plumb_vec2 axis;           ///< prismatic, wheel: direction of the value, any length; {0}: x (wheel: up).
                               ///< gear: {0}: turns of both; else B's travel along it (rack)
    plumb_real reference;      ///< [rad] or [m] revolute, prismatic, wheel: the value as things are when the joint is made, from
                               ///< which limits, spring and plumb_joint_value count: 0.5 of a door that stands open by that.
                               ///< Of a slider the anchor on A is so far behind that on B
    bool enable_limit;         ///< lower <= value <= upper; distance: instead of the rod
    plumb_real lower, upper;   ///< [rad] or [m] lower <= upper; distance: >= 0
    plumb_real restitution;    ///< [-] 0 to 1 of the limit: share of the rate at which the value meets a bound with which it
                               ///< leaves it; a rope is a distance joint with a limit. 0: what is met stops. Nothing
                               ///< slower than the world's restitution_speed bounces. Newton's law at the joint's own
                               ///< bodies: what other joints hold of them takes its share in the sweeps
    bool enable_motor;         ///< revolute, prismatic, wheel: drives the value's rate
    plumb_real motor_speed;    ///< [rad/s] or [m/s]; wheel: [rad/s] of B
    plumb_real max_motor;      ///< [N m] or [N] >= 0; wheel: [N m]
    plumb_real hertz;          ///< [1/s] >= 0 of the spring with the joint's own effective mass, as things were when
                               ///< it was made: its stiffness stays, however they turn (motor: as in the
                               ///< mean of all directions; mouse: with the mass of the moment); 0: none.
                               ///< Weld, distance, motor: 0 is rigid. Mouse: 0 means 5. Alone on its body it moves
                               ///< exactly as the oscillator up to 0.09 of the substep rate, and is damped above
    plumb_real damping;        ///< [-] >= 0 damping ratio of the spring. Mouse: 0 means 1
    plumb_real stiffness;      ///< [N/m] or [N m/rad] >= 0 of the spring, told instead of hertz and damping (which are
                               ///< then 0: E_RANGE): the force stays what it is when masses and anchors change. As
                               ///< exact as hertz, up to 0.09 of the substep rate for the mass that it meets. Mouse,
                               ///< motor: [N/m] in all directions; motor besides, with the same number, [N m/rad]
    plumb_real damper;         ///< [N s/m] or [N m s/rad] >= 0 with stiffness, or alone: a dashpot
    plumb_real rest;           ///< [rad] or [m] value at which the spring is at rest; motor: wanted angle
    plumb_real length;         ///< [m] distance: of rod or spring; 0 means as things are. Cable: of what is free between
                               ///< the rims when it is made and taut; longer than things are: it is slack; 0: taut
    plumb_real radius_a;       ///< [m] cable: of the rim on A. Look from A to B: > 0 the rope leaves it on the left, < 0 on
                               ///< the right, 0: it is tied to the point. So with A on the left of the picture and B on the
                               ///< right both > 0 is a rope over the tops of two wheels, both < 0 one beneath (a belt has
                               ///< one of each), and unlike signs a rope that crosses from the top of one to the bottom of
                               ///< the other; of A above B, > 0 hangs down at the right of the wheel. It does not slip:
                               ///< a wheel takes up radius * turn, and the free run leaves it where it touches. Rims are round
                               ///< and never run out: as many turns as come, and no end that comes off the rim. Where one rim
                               ///< comes to lie within the other (or on it, of a rope that crosses) no line touches both: the
                               ///< rope is loose until they part, and has slipped where it would be too short then
    plumb_real radius_b;       ///< [m] cable: of the rim on B, with the side as seen from A to B too
    plumb_real ratio;          ///< [-] gear: turn of A + ratio * turn or travel [m] of B is constant; pulley,
                               ///< > 0; 0 means 1
    plumb_real pitch;          ///< [rad] ratchet: a tooth, not 0; negative: B turns clockwise only
    plumb_real max_force;      ///< [N] >= 0; mouse, motor: 0 is unbounded; friction: as given. A motor that has
                               ///< a bound wants hertz too: rigid, it creeps at force / mass * h, h [s]: a substep
    plumb_real max_torque;     ///< [N m] likewise
    plumb_real break_force;    ///< [N] >= 0 breaks where the mean of the reaction over a step exceeds it; 0: never
    plumb_real break_torque;   ///< [N m] likewise
    plumb_real break_impulse;  ///< [N s] likewise of the reaction summed over a step, whatever its length
    plumb_real event_force;    ///< [N] >= 0 a strain event where that mean exceeds it; 0: none
    plumb_real event_torque;   ///< [N m] likewise
    bool tell_impulse;         ///< plumb_joint_impulse tells what it gave over the step; breaking and strain ask for that too
    bool disabled;             ///< it does nothing until plumb_joint_set_enabled
    bool collide_connected;    ///< the two bodies collide with one another; default: they do not
    void *user_data;
} plumb_joint_desc;

/// Makes a joint. Null handle on error: E_NULL, E_HANDLE, E_RANGE, E_NOT_FINITE, E_GEOMETRY (a rope or
/// axis without length), E_MEMORY, E_LOCKED. O(1) amortised.
PLUMB_API plumb_joint plumb_joint_create(plumb_world *world, const plumb_joint_desc *desc);
/// Destroys a joint. Errors: E_HANDLE, E_LOCKED. A joint also goes with either of its bodies.
PLUMB_API plumb_result plumb_joint_destroy(plumb_world *world, plumb_joint joint);

/// Sets lower and upper bound and switches the limit. Errors: E_HANDLE, E_NOT_FINITE, E_RANGE, E_STATE
/// (the kind has none).
PLUMB_API plumb_result plumb_joint_set_limit(plumb_world *world, plumb_joint joint, bool enabled,
                                             plumb_real lower, plumb_real upper);
/// Sets the restitution of the limit, 0 to 1. Errors as above.
PLUMB_API plumb_result plumb_joint_set_restitution(plumb_world *world, plumb_joint joint,
                                                   plumb_real restitution);
/// Sets speed [rad/s] or [m/s] and largest torque [N m] or force [N] and switches the motor. Errors as
/// above.
PLUMB_API plumb_result plumb_joint_set_motor(plumb_world *world, plumb_joint joint, bool enabled,
                                             plumb_real speed, plumb_real max_motor);
/// Sets the spring; hertz 0 as in the descriptor. Stiffness and damper are 0 from then on. Of a distance joint `rest` is the
/// length >= 0 of rod or spring, and 0 leaves that as it is; of a mouse joint it must be 0. Errors as above.
PLUMB_API plumb_result plumb_joint_set_spring(plumb_world *world, plumb_joint joint, plumb_real hertz,
                                              plumb_real damping, plumb_real rest);
/// Sets the spring by stiffness [N/m] or [N m/rad] and damper [N s/m] or [N m s/rad]; hertz and damping are 0 from then
/// on. Both 0: as plumb_joint_set_spring with hertz 0. Errors as above.
PLUMB_API plumb_result plumb_joint_set_stiffness(plumb_world *world, plumb_joint joint, plumb_real stiffness,
                                                 plumb_real damper, plumb_real rest);
/// Mouse: the target [m] in the world. Motor: where B's anchor is to be [m], in A's frame relative to
/// A's anchor. Errors: E_HANDLE, E_NOT_FINITE, E_STATE (another kind).
PLUMB_API plumb_result plumb_joint_set_target(plumb_world *world, plumb_joint joint, plumb_vec2 target);
/// Sets the bounds beyond which it breaks; 0: never. Errors: E_HANDLE, E_NOT_FINITE, E_RANGE.
PLUMB_API plumb_result plumb_joint_set_break(plumb_world *world, plumb_joint joint, plumb_real force,
                                             plumb_real torque);
/// Sets the impulse [N s] in a step beyond which it breaks; 0: never. Errors: E_HANDLE, E_NOT_FINITE,
/// E_RANGE.
PLUMB_API plumb_result plumb_joint_set_break_impulse(plumb_world *world, plumb_joint joint,
                                                     plumb_real impulse);
/// Sets the bounds beyond which it makes strain events; 0: none. Errors: E_HANDLE, E_NOT_FINITE, E_RANGE.
PLUMB_API plumb_result plumb_joint_set_event(plumb_world *world, plumb_joint joint, plumb_real force,
                                             plumb_real torque);
/// Whether plumb_joint_impulse is to tell what it gave, from the next step on. Errors: E_HANDLE.
PLUMB_API plumb_result plumb_joint_set_tell_impulse(plumb_world *world, plumb_joint joint, bool tell);
/// Switches a joint off, or on again. Off, it exerts nothing, does not break, and keeps nobody apart; a
/// rigid joint that is switched on pulls its bodies together. Errors: E_HANDLE, E_LOCKED.
PLUMB_API plumb_result plumb_joint_set_enabled(plumb_world *world, plumb_joint joint, bool enabled);
/// False when it was switched off, and for a bad handle; a joint of a disabled body rests too, but is on.
PLUMB_API bool plumb_joint_is_enabled(const plumb_world *world, plumb_joint joint);
PLUMB_API plumb_result plumb_joint_set_user_data(plumb_world *world, plumb_joint joint, void *user_data);

/// Questions. On a bad handle: zeros, and the refusal is told (but by plumb_joint_valid).
PLUMB_API bool plumb_joint_valid(const plumb_world *world, plumb_joint joint);
PLUMB_API plumb_joint_kind plumb_joint_get_kind(const plumb_world *world, plumb_joint joint);
/// "revolute", ...; null for what is no kind.
PLUMB_API const char *plumb_joint_kind_name(plumb_joint_kind kind);
PLUMB_API plumb_body plumb_joint_body_a(const plumb_world *world, plumb_joint joint);
PLUMB_API plumb_body plumb_joint_body_b(const plumb_world *world, plumb_joint joint);
/// [m] where the anchor on A, or B, is now.
PLUMB_API plumb_vec2 plumb_joint_anchor_a(const plumb_world *world, plumb_joint joint);
PLUMB_API plumb_vec2 plumb_joint_anchor_b(const plumb_world *world, plumb_joint joint);
/// The descriptor as it was given, with defaults resolved and setters applied. Errors: E_HANDLE, E_NULL.
PLUMB_API plumb_result plumb_joint_settings(const plumb_world *world, plumb_joint joint,
                                            plumb_joint_desc *desc);
/// The joint's coordinate now. Revolute, weld, motor, friction, ratchet: [rad] turn of B relative to A
/// since the joint was made, full turns included. Prismatic, wheel: [m] travel along the axis. `reference` is added.
/// Distance, mouse: [m] length. Gear, pulley: the sum that is kept, less what it was. Cable: [m] what is free between the
/// rims and what they have wound on since it was made: `length` where it is taut, less where it is slack.
PLUMB_API plumb_real plumb_joint_value(const plumb_world *world, plumb_joint joint);
/// Rate of that coordinate now, from the velocities of the bodies: [rad/s] or [m/s] as the value. O(1).
PLUMB_API plumb_real plumb_joint_rate(const plumb_world *world, plumb_joint joint);
/// [rad/s] at which B turns relative to A. 0 on an error: E_HANDLE, E_STATE (a kind that does not turn about a point:
/// prismatic, distance, mouse, gear, pulley).
PLUMB_API plumb_real plumb_joint_turn_rate(const plumb_world *world, plumb_joint joint);
/// [m/s] along the axis (prismatic, wheel) or of the length (distance, mouse, cable). 0 on an error: E_HANDLE,
/// E_STATE (other kinds).
PLUMB_API plumb_real plumb_joint_travel_rate(const plumb_world *world, plumb_joint joint);
/// [m] by how far the rigid part is apart (angles count by the radian), 0 when it has none.
PLUMB_API plumb_real plumb_joint_error(const plumb_world *world, plumb_joint joint);
/// [N] on B at its anchor, [N m] on B about its anchor: mean of the last substep of the last step.
PLUMB_API plumb_vec2 plumb_joint_force(const plumb_world *world, plumb_joint joint);
PLUMB_API plumb_real plumb_joint_torque(const plumb_world *world, plumb_joint joint);
/// [N s] on B and [N m s] about its anchor over the whole last step, all substeps and blows at limits summed: divided by
/// the step's length the mean force and torque. {0} on an error: E_HANDLE, E_STATE (nobody asks for the sums: neither
/// tell_impulse nor a bound of breaking or strain is set).
PLUMB_API plumb_vec2 plumb_joint_impulse(const plumb_world *world, plumb_joint joint);
PLUMB_API plumb_real plumb_joint_angular_impulse(const plumb_world *world, plumb_joint joint);
PLUMB_API void *plumb_joint_user_data(const plumb_world *world, plumb_joint joint);

/// Joints of the world in order of their slots, or of a body, newest first: writes up to `capacity`,
/// returns how many there are.
PLUMB_API int plumb_world_joints(const plumb_world *world, plumb_joint *joints, int capacity);
PLUMB_API int plumb_body_joints(const plumb_world *world, plumb_body body, plumb_joint *joints,
                                int capacity);

/// What a joint knows of its past: enough to go on from, once it has been made anew between bodies
/// that stand where they stood. All of {0} is not valid: read one, keep it, give it back.
typedef struct plumb_joint_memory {
    plumb_vec2 anchor_a, anchor_b; ///< [m] in the frames of A and B; the world's: in the world
    plumb_vec2 axis;               ///< unit, in A's frame; {0}: the kind has none. Cable: its free run as it was made
    plumb_vec2 offset;             ///< [m] motor: where B's anchor is to be, in A's frame. Cable: x: what has slipped
                                   ///< [m], y: 1 where no line touches both rims, else 0
    plumb_real start_a, start_b;   ///< [rad] angles of the bodies where the value is 0
    int32_t turns_a, turns_b;      ///< full turns of each since
    plumb_real kept;               ///< gear, pulley: the sum that is kept; ratchet: [rad] its tooth; cable: [rad] by which
                                   ///< its free run has turned
    plumb_real substep;            ///< [s] >= 0, to which the impulses belong; 0: there are none
    plumb_real impulses[6];        ///< [N s], [N m s] with which the next step starts
} plumb_joint_memory;

/// Reads what a joint knows of its past. Errors: E_HANDLE, E_NULL.
PLUMB_API plumb_result plumb_joint_get_memory(const plumb_world *world, plumb_joint joint,
                                              plumb_joint_memory *memory);
/// Gives a joint that past, for loading what was saved: the angles, lengths and sums that it keeps are
/// then those of the joint that was read, to the last bit. The bodies must stand where they stood.
/// Errors: E_HANDLE, E_NULL, E_NOT_FINITE, E_RANGE (anchor, axis, substep), E_LOCKED.
PLUMB_API plumb_result plumb_joint_set_memory(plumb_world *world, plumb_joint joint,
                                              const plumb_joint_memory *memory);

/// A joint broke in the last step; its handle is stale.
typedef struct plumb_joint_break {
    plumb_joint joint;
    plumb_joint_kind kind;
    plumb_body body_a, body_b;
    plumb_vec2 point;   ///< [m] anchor on B
    plumb_vec2 force;   ///< [N] on B, mean over the step
    plumb_real torque;  ///< [N m] about B's anchor, likewise
    plumb_vec2 impulse; ///< [N s] on B over the step
    void *user_data;
} plumb_joint_break;

/// A joint's reaction rose above event_force or event_torque in the last step: told once, and again only after a step
/// in which it was below both. It holds on; where it breaks in that step, that is told instead.
typedef plumb_joint_break plumb_joint_strain; // `force` and `torque`: the reaction

/// Strain events of the last step in order of the joints' slots; *count is set. Null when there are none.
PLUMB_API const plumb_joint_strain *plumb_world_joint_strain_events(const plumb_world *world,
                                                                    int *count);

/// Break events of the last step; *count is set. Null when there are none.
PLUMB_API const plumb_joint_break *plumb_world_joint_break_events(const plumb_world *world, int *count);

PLUMB_END

#endif
