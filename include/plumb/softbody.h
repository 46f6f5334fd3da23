/// softbody.h - what bends and stretches: ropes, nets and cloth, jelly, skins with gas in them.
///
///     plumb_softbody rope = plumb_rope_create(world, &(plumb_rope_desc){ .from = { 0, 5 }, .to = { 4, 5 } });
///     plumb_softbody_hold(world, rope, 0, (plumb_body)PLUMB_NULL_INIT, (plumb_vec2){ 0, 5 });
///     plumb_softbody_desc now;
///     plumb_softbody_settings(world, rope, &now); // now.nodes[i].position
///
/// A soft body is nodes with mass, and elements between them: edges that pull (and push), bends, triangles of an elastic
/// sheet, a ring of nodes with gas in it. Stiffness is in physical units and does not depend on the step: in each substep all
/// nodes and all bodies that they pull or touch are one implicit system in double, whatever their masses. Smooth
/// motion is of second order in the substep; what is too stiff for the substep is held, and its vibration dies out.
/// Nodes are circles that touch the solid shapes of bodies, with friction and without restitution; fast ones do not
/// pass through. They fall by the world's gravity; laws and the lift of fluids do not act on them. A liquid carries and presses
/// what has an area, triangles and rings with gas, whatever its mass and stiffness, and passes threads (plumb/liquid.h). Soft
/// bodies do not touch one another, nor themselves. At rest they sleep, together with the bodies that they hold or touch.
/// The world must not wrap around. Nothing of it is done in a world without soft bodies.
#ifndef PLUMB_SOFTBODY_H
#define PLUMB_SOFTBODY_H

#include "plumb/shape.h"

PLUMB_BEGIN

/// Most nodes, elements of a kind, or pins of a soft body.
#define PLUMB_SOFTBODY_MAX 100000

/// A point with mass. It touches bodies as a circle.
typedef struct plumb_softbody_node {
    plumb_vec2 position; ///< [m] within +-1e9
    plumb_vec2 velocity; ///< [m/s] up to 1e6
    plumb_real mass;     ///< [kg] 1e-9..1e9
    plumb_real radius;   ///< [m] 0..1e6
    /// [m], [m/s] what rounding has left of place and velocity: added to them they are what they are. {0} in a new one
    plumb_vec2 position_rest, velocity_rest;
} plumb_softbody_node;

#define PLUMB_EDGE_PULLS    1u ///< it does not push: thread, rope
#define PLUMB_EDGE_TORN     2u ///< it is torn, and does nothing any more
#define PLUMB_EDGE_TORN_NOW 4u ///< in the last step

/// A spring with a damper between two nodes: force = stiffness (l - length) + damping dl/dt.
typedef struct plumb_softbody_edge {
    uint32_t a, b;           ///< nodes, counted from 0 in the soft body
    uint32_t flags;          ///< PLUMB_EDGE_...
    plumb_real length;       ///< [m] at rest, up to 1e6; 0: as the nodes lie
    plumb_real stiffness;    ///< [N/m] 0..1e15
    plumb_real damping;      ///< [N s/m] 0..1e15
    plumb_real break_strain; ///< [-] (l - length) / length beyond which it tears; 0: never
    plumb_real yield_strain; ///< [-] beyond which, either way, its length at rest flows after it; 0: never
    plumb_real tension;      ///< [N] of the last step, below 0 where it pushes; told, not asked for
} plumb_softbody_edge;

/// Bending between the edges a b and b c: moment = stiffness / length (turn - angle).
typedef struct plumb_softbody_bend {
    uint32_t a, b, c;     ///< nodes
    plumb_real stiffness; ///< [N m^2] E I, 0..1e15
    plumb_real length;    ///< [m] of what is bent there: half of both edges; 0: as the nodes lie
    plumb_real angle;     ///< [rad] -pi..pi at rest from a b to b c, counter-clockwise; 0: straight
} plumb_softbody_bend;

/// A triangle of an elastic sheet: stable neo-Hookean (Smith, de Goes, Kim 2018), in the plane.
typedef struct plumb_softbody_triangle {
    uint32_t a, b, c;   ///< nodes, counter-clockwise
    plumb_real young;   ///< [N/m] Young's modulus times thickness, 1e-6..1e15
    plumb_real poisson; ///< [-] 0..0.95 of the plane; 1 would keep its area
    plumb_real damping; ///< [s] 0..1e3: stress of a rate of strain is damping times that of the strain
    plumb_vec2 ab, ac;  ///< [m] sides at rest; {0}: as the nodes lie
} plumb_softbody_triangle;

/// A node that is held, by a body or by the world. Its mass does not count then: it is a point of what
/// holds it, which touches in its place.
typedef struct plumb_softbody_pin {
    uint32_t node;
    plumb_body body;  ///< null: the world
    plumb_vec2 point; ///< [m] in the body's frame, or in the world
} plumb_softbody_pin;

typedef struct plumb_softbody_desc {
    const plumb_softbody_node *nodes;
    const plumb_softbody_edge *edges;
    const plumb_softbody_bend *bends;
    const plumb_softbody_triangle *triangles;
    const uint32_t *ring; ///< nodes around the gas, counter-clockwise
    const plumb_softbody_pin *pins;
    int node_count; ///< 1..PLUMB_SOFTBODY_MAX
    int edge_count, bend_count, triangle_count, ring_count, pin_count;
    plumb_real friction; ///< [-] 0..1e3 of nodes, mixed with that of what they touch by the geometric mean
    /// [1/s] 0..1e6 of velocities against the fluid that a node is in (sensors of a fluid material, wind and gusts
    /// among them, that the filter meets; of several the densest), still air elsewhere: dv/dt = a - damping (v - flow)
    plumb_real damping;
    /// Gas in the ring: (pressure + ambient) area is constant. Of the ring's two sides this is the difference at rest
    plumb_real pressure; ///< [N/m] 0..1e12 at rest; 0: no gas
    plumb_real ambient;  ///< [N/m] 0..1e12 outside: much of it makes the gas stiff
    plumb_real area;     ///< [m^2] at rest; 0: as the nodes lie
    plumb_filter filter; ///< {0}: category 1, touches everything
    bool no_sleep;       ///< it does not fall asleep, nor does what it holds or touches
    bool asleep;         ///< it sleeps until something wakes it, and its nodes stand still; not where nothing sleeps
} plumb_softbody_desc;

/// Makes a soft body. `desc` and its arrays are copied. Null on error: E_NULL, E_RANGE, E_NOT_FINITE, E_HANDLE (a pin's
/// body), E_STATE (the world wraps around), E_MEMORY, E_LOCKED, E_UNSUPPORTED.
PLUMB_API plumb_softbody plumb_softbody_create(plumb_world *world, const plumb_softbody_desc *desc);
/// Errors: E_NULL, E_HANDLE, E_LOCKED.
PLUMB_API plumb_result plumb_softbody_destroy(plumb_world *world, plumb_softbody softbody);
/// How it is now: the arrays are the world's own, valid until the next step or change of a soft body. Errors: E_NULL,
/// E_HANDLE.
PLUMB_API plumb_result plumb_softbody_settings(const plumb_world *world, plumb_softbody softbody,
                                               plumb_softbody_desc *desc);
/// All soft bodies, in the order in which they were made: writes up to `capacity`, returns how many there are.
PLUMB_API int plumb_world_softbodies(const plumb_world *world, plumb_softbody *softbodies,
                                     int capacity);

/// Changes a node: place, velocity, mass, radius. Errors: E_NULL, E_HANDLE, E_RANGE, E_NOT_FINITE, E_LOCKED.
PLUMB_API plumb_result plumb_softbody_set_node(plumb_world *world, plumb_softbody softbody,
                                               int node, const plumb_softbody_node *value);
/// Changes what an edge is made of; its nodes stay. With PLUMB_EDGE_TORN it is cut, and as where one tears nothing bends over it
/// any more, and the gas of a ring is out whose two nodes it joined. Errors: the same.
PLUMB_API plumb_result plumb_softbody_set_edge(plumb_world *world, plumb_softbody softbody,
                                               int edge, const plumb_softbody_edge *value);
/// Changes the gas: `pressure` and `ambient` [N/m]. Errors: the same; E_STATE: it has no ring.
PLUMB_API plumb_result plumb_softbody_set_gas(plumb_world *world, plumb_softbody softbody,
                                              plumb_real pressure, plumb_real ambient);
/// Pins a node to a point of a body's frame [m], or with a null body of the world; if it was pinned, from now on there.
/// Errors: the same; E_MEMORY.
PLUMB_API plumb_result plumb_softbody_hold(plumb_world *world, plumb_softbody softbody, int node,
                                           plumb_body body, plumb_vec2 point);
/// Frees a node. Errors: as plumb_softbody_destroy; E_RANGE; E_STATE: it is not pinned.
PLUMB_API plumb_result plumb_softbody_release(plumb_world *world, plumb_softbody softbody, int node);

/// What of it can be measured.
typedef struct plumb_softbody_state {
    plumb_vec2 center, momentum; ///< [m], [N s] of the nodes that are not pinned
    plumb_real mass;             ///< [kg] of these
    plumb_real kinetic, elastic; ///< [J]
    plumb_real strain;           ///< [-] of the edge that is stretched most; 0 without any
    plumb_real tension;          ///< [N] of the edge that pulls most; 0 where none pulls
    plumb_real area, pressure;   ///< [m^2], [N/m] of the gas
    int torn;                    ///< edges torn by now
    int torn_now;                ///< in the last step
} plumb_softbody_state;

/// Errors: E_NULL, E_HANDLE. O(nodes and elements).
PLUMB_API plumb_result plumb_softbody_measure(const plumb_world *world, plumb_softbody softbody,
                                              plumb_softbody_state *state);

//---- sleep ---------------------------------------------------------------------------------------
//
// A soft body rests when all of its nodes do, by the speed and the time of bodies (plumb/sleep.h), and falls asleep when
// all bodies that it holds or touches rest as well and are allowed to sleep; they are of one island through it. It stays awake where the
// liquid may press it, where the fluid that drags it has gusts, eddies or lively waves or is held by a body that moves, and beside
// a kinematic body that moves. What hangs on nothing fixed and touches nothing fixed falls asleep below a
// thousandth of sleep_speed.
//
// What it has still before it then is left out: by as much as a / w^2 of what swings at w [rad/s] and a t^2 of what creeps to its
// place in t [s], a being the 8 mm/s^2 of plumb/sleep.h. Tensions are those of the last step, of what still swings with it.
//
// Asleep its nodes stand still, and it costs nothing but for boxes that are compared where bodies move. It wakes, before contacts
// are solved, when something awake touches it, comes within 2 cm or may in this step, when a body that holds it wakes
// or moves, when it, such a body, what it rests on or the fluid that drags it is changed, and with gravity. What sleeps and touches it wakes
// with it.

/// False for a stale handle.
PLUMB_API bool plumb_softbody_is_awake(const plumb_world *world, plumb_softbody softbody);
/// Wakes it, and its neighbours at the start of the next step; one that is awake rests anew from 0. Errors: E_NULL, E_HANDLE.
PLUMB_API plumb_result plumb_softbody_wake(plumb_world *world, plumb_softbody softbody);
/// Puts it, all bodies that it holds or touches, and what these touch, to sleep at once, whatever their speed. Rows move.
/// Errors: E_NULL, E_HANDLE, E_STATE (the world, or who is of its island, may not sleep), E_MEMORY, E_LOCKED.
PLUMB_API plumb_result plumb_softbody_sleep(plumb_world *world, plumb_softbody softbody);
/// Forbids or allows it to fall asleep; forbidding wakes it. Errors: E_NULL, E_HANDLE.
PLUMB_API plumb_result plumb_softbody_set_no_sleep(plumb_world *world, plumb_softbody softbody,
                                                   bool no_sleep);
PLUMB_API bool plumb_softbody_no_sleep(const plumb_world *world, plumb_softbody softbody);

//---- ready made ----------------------------------------------------------------------------------

/// A rope, cable or chain. {0} but for `from` and `to` is valid: 1 kg/m, a load of 100 times its weight stretches it by 1 %.
typedef struct plumb_rope_desc {
    plumb_vec2 from, to;                   ///< [m] its ends
    plumb_real length;                     ///< [m] at rest; 0: the distance. Longer: it hangs in an arc to begin with
    int nodes;                             ///< 2..10000; 0: 24
    plumb_real mass;                       ///< [kg] 0: 1 a metre
    plumb_real stiffness;                  ///< [N] E A: force of a strain of 1; 0: 1e4 a kg of mass times 9.81
    plumb_real damping;                    ///< [N s] force of a rate of strain of 1/s; 0: none
    plumb_real bending;                    ///< [N m^2] E I; 0: limp
    plumb_real drag;                       ///< [1/s] of velocities in still air
    plumb_real radius;                     ///< [m] of nodes; 0: half of the way between two
    plumb_real friction;                   ///< [-] 0: 0.5; below 0: none
    plumb_real break_strain, yield_strain; ///< [-] see plumb_softbody_edge
    bool pushes;                           ///< a rod: it takes compression as well
    bool hold_from, hold_to;               ///< pinned to the world where no body is given
    plumb_body from_body, to_body;         ///< its ends are pinned to these, where they lie
    plumb_filter filter;
    bool no_sleep; ///< see plumb_softbody_desc
} plumb_rope_desc;
/// Null on error, as plumb_softbody_create.
PLUMB_API plumb_softbody plumb_rope_create(plumb_world *world, const plumb_rope_desc *desc);

/// A net or cloth: a lattice of threads, seen from the front.
typedef struct plumb_cloth_desc {
    plumb_vec2 low, high;        ///< [m] corners
    int columns, rows;           ///< meshes, 1..300; 0: 16 along the longer side
    plumb_real mass;             ///< [kg] 0: 1 a square metre
    plumb_real stiffness;        ///< [N/m] E times thickness of threads along either axis; 0: 1000 times its weight a metre
    plumb_real shear;            ///< [N/m] of the diagonals; 0: a tenth; below 0: a net without any
    plumb_real damping;          ///< [N s/m] of a thread; 0: none
    plumb_real drag;             ///< [1/s] of velocities in still air
    plumb_real radius;           ///< [m] of nodes; 0: half a mesh
    plumb_real friction;         ///< [-] 0: 0.5; below 0: none
    plumb_real break_strain;     ///< [-] 0: never
    bool hold_top, hold_corners; ///< pinned to the world: the upper edge; its two ends
    plumb_filter filter;
    bool no_sleep; ///< see plumb_softbody_desc
} plumb_cloth_desc;
/// Null on error, as plumb_softbody_create.
PLUMB_API plumb_softbody plumb_cloth_create(plumb_world *world, const plumb_cloth_desc *desc);

/// Jelly: the inside of an outline as triangles.
typedef struct plumb_jelly_desc {
    const plumb_vec2 *points; ///< [m] of a closed outline, counter-clockwise, concave or not
    int count;                ///< 3..256
    plumb_real spacing;       ///< [m] of nodes; 0: a tenth of its longer side
    plumb_real density;       ///< [kg/m^2] 0: 100
    plumb_real young;         ///< [N/m] 0: 2e4
    plumb_real poisson;       ///< [-] 0: 0.4; below 0: none
    plumb_real damping;       ///< [s] 0: 0.005; below 0: none
    plumb_real drag;          ///< [1/s] of velocities in still air
    plumb_real friction;      ///< [-] 0: 0.5; below 0: none
    plumb_vec2 velocity;      ///< [m/s]
    plumb_filter filter;
    bool no_sleep; ///< see plumb_softbody_desc
} plumb_jelly_desc;
/// Null on error, as plumb_softbody_create.
PLUMB_API plumb_softbody plumb_jelly_create(plumb_world *world, const plumb_jelly_desc *desc);

/// A skin with gas in it: balloon, tyre.
typedef struct plumb_skin_desc {
    plumb_vec2 center;       ///< [m]
    plumb_real radius;       ///< [m] 0: 0.5
    int nodes;               ///< 6..10000; 0: 32
    plumb_real mass;         ///< [kg] 0: 1
    plumb_real stiffness;    ///< [N] E A of the skin; 0: 1e4
    plumb_real damping;      ///< [N s]; 0: none
    plumb_real bending;      ///< [N m^2]; 0: limp
    plumb_real drag;         ///< [1/s] of velocities in still air
    plumb_real pressure;     ///< [N/m] 0: 500
    plumb_real ambient;      ///< [N/m] 0: none
    plumb_real friction;     ///< [-] 0: 0.5; below 0: none
    plumb_real break_strain; ///< [-] 0: never
    plumb_vec2 velocity;     ///< [m/s]
    plumb_filter filter;
    bool no_sleep; ///< see plumb_softbody_desc
} plumb_skin_desc;
/// Null on error, as plumb_softbody_create.
PLUMB_API plumb_softbody plumb_skin_create(plumb_world *world, const plumb_skin_desc *desc);

PLUMB_END

#endif
