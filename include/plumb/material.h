/// material.h - what shapes are made of. A material is an entity shared by any number of shapes;
/// the null handle is the world's default material (friction 0.6, restitution 0, density 1).
///
/// A material may be a fluid. Sensors of it are volumes of water, of air that blows, of a lake, whatever their shape, on
/// whichever body: what is in them floats by what it displaces, exactly, is dragged surface by surface, and carried
/// along. Their sides are the surface.
///
///     plumb_material water = plumb_material_create(world, &(plumb_material_desc){ .density = 1000, .fluid = true });
///     plumb_shape_create(world, ground, &(plumb_shape_desc){
///         .kind = PLUMB_BOX, .center = { 0, -2 }, .half = { 10, 2 }, .sensor = true, .material = water });
#ifndef PLUMB_MATERIAL_H
#define PLUMB_MATERIAL_H

#include "plumb/world.h"

PLUMB_BEGIN

/// How a number of a pair follows from those of its two materials. If their rules differ, the one that
/// comes later in this list holds.
typedef enum plumb_mix {
    PLUMB_MIX_DEFAULT,   ///< friction: geometric mean; restitution, adhesion: the larger
    PLUMB_MIX_AVERAGE,   ///< (a + b) / 2
    PLUMB_MIX_GEOMETRIC, ///< sqrt(a b)
    PLUMB_MIX_MULTIPLY,  ///< a b
    PLUMB_MIX_MIN,       ///< the smaller
    PLUMB_MIX_MAX        ///< the larger
} plumb_mix;

/// {0} is valid and is the world's default material: a member that is left out has the default told beside it, as in
/// every descriptor, and what is to be 0 all the same has a member of its own.
typedef struct plumb_material_desc {
    plumb_real density; ///< [kg/m^2] > 0; 0 means 1
    /// [-] Coulomb coefficient, 0..10; 0 means 0.6 (see frictionless). A pair uses sqrt(a b)
    plumb_real friction;
    bool frictionless; ///< no friction at all; `friction` must then be 0
    /// [-] 0..10. A pair uses max(a, b). 1 conserves energy; more gives it, as bumpers do, up to the world's
    /// restitution_cap
    plumb_real restitution;
    /// [m] >= 0, lever arm of rolling resistance: the torque against rolling is at most this times the
    /// normal force. The coefficient of text books, c = f / radius, means radius times c here. A pair
    /// uses the larger.
    plumb_real rolling_resistance;
    /// [m/s] at which the surface runs along the outline of the shape, like a conveyor belt: positive
    /// carries what lies on top of a shape to +x (the outward normal turned clockwise; in a y-down world, where
    /// that is what a screen shows, counter-clockwise). Needs friction.
    plumb_real surface_speed;
    plumb_mix friction_mix;    ///< how pairs mix friction
    plumb_mix restitution_mix; ///< how pairs mix restitution
    /// [N] >= 0, pull-off force: once two surfaces have touched, it takes so much force along the normal
    /// to part them, shared among the points of their contact; each pair of convex pieces has its own.
    /// Friction goes by the normal force plus it, and what sticks does not bounce. They have parted, with
    /// an end event, when their nearest points are 5 mm apart. A pair uses the larger.
    plumb_real adhesion;
    plumb_mix adhesion_mix; ///< how pairs mix adhesion; default: the larger

    /// A fluid: every sensor of this material is a volume of it, be it a pool, a tank that moves or a gust of wind
    /// (see above). Its `density` is what floats and drags go by; solid shapes of it are solid.
    bool fluid;
    bool weightless; ///< it drags and carries, but neither lifts nor lends its mass: wind, among bodies whose
                     ///< density is far from that of the real ones
    /// [-] 0..1000, of pressure: a surface that goes ahead at v . n feels drag / 2 density (v . n)^2 against
    /// its normal. 0 means 1.8, which is 1.2 for a disc and 1.8 for a box that goes flat (measured: 1.2, 2.05)
    plumb_real drag;
    bool no_drag;         ///< none; `drag` must then be 0
    plumb_real skin_drag; ///< [-] 0..1000, of friction along all surfaces, likewise by their speed; 0 means 0.01
    bool no_skin_drag;
    /// [-] 0..100, the mass that moves along with a body, of what it displaces: it accelerates as if it had so much more.
    /// 0 means 1, which is right for discs, and for ellipses and plates in the mean
    plumb_real added_mass;
    bool no_added_mass;
    /// [-] 0..100, of the force density area sqrt(g / width) v on what floats, which the waves take that it would
    /// make; 0 means 0.5
    plumb_real wave_drag;
    bool no_wave_drag;
    plumb_real flow_x;       ///< [m/s] at which the fluid flows, in the frame of the world, in addition to the
    plumb_real flow_y;       ///< motion of the body that holds it: it moves and turns along with that
    plumb_real gust;         ///< [-] 0..10, root mean square of the changes of the flow's speed, over the speed
    plumb_real gust_length;  ///< [m] > 0, length of gusts; 0 means 50
    plumb_real shear_height; ///< [m] >= 0, thickness of the layer at the bottom: at height z above it the flow is
                             ///< 1 - exp(-z / shear_height) of itself; 0: everywhere the same
    /// [-] 0..10, lift of what spins: a force magnus 2 density area w v across its velocity v against the fluid, to the
    /// side that goes with the flow; 1 is the law of Kutta and Joukowski for a cylinder, real balls have 0.2 to 0.5
    plumb_real magnus;
    /// [-] 0..10, of what slides; `friction` is then that of what sticks. 0, and what is above `friction`, means the
    /// same as that. A contact that stuck in the substep before, or is new and slower than 1 cm/s along its surfaces,
    /// holds up to `friction` times its load; once it slides it bears `kinetic_friction` times its load until it
    /// sticks again. A pair mixes both by the same rule.
    plumb_real kinetic_friction;

    /// [-] 0..1, of a fluid that flows: what stands behind a shape, seen along the flow, gets so much less of it; 0: as if it
    /// stood alone. Surfaces that are hidden in part are so in part, exactly. All solid shapes in the volume shelter that may meet
    /// it; parts of one body shelter one another. As it is at the beginning of the step; not in worlds that wrap around.
    /// Each step looks at all pieces: O(n log n) of those in the volume, and O(1) for each two that stand behind one another
    plumb_real shelter;
    /// [-] 0..10, how far shelter reaches: a distance x behind a shape that is 2 r wide across the flow it is shelter (r / (r +
    /// wake x))^2, of several the most (Jensen 1983; 0.04 to 0.1 of turbines, more in gusty wind). 0: for ever
    plumb_real wake;

    /// What follows makes a fluid flow another way at each place, on top of flow_x, flow_y, about the origin of the body
    /// that holds the volume; it moves along with that, and a jet turns with it. Each edge of what is in it feels the flow
    /// that is there.
    /// What lifts (no wind) also pushes what floats towards the middle of its turns, as it does itself:
    /// (1 + added_mass) of the mass that is displaced, times the fluid's acceleration. Each of two volumes at one place drags as if
    /// it were alone: what belongs together, as a jet with eddies, is one material.

    /// [m^2/s] circulation of a vortex, positive from +x to +y: at the distance r the fluid goes round at
    /// swirl / (2 pi r) (1 - exp(-(r / core_radius)^2)) (Lamb, Oseen); within the core nearly as a wheel does
    plumb_real swirl;
    /// [m^2/s] that a source at the origin gives, negative: a drain; outwards at outflow / (2 pi r), less within the core
    /// by the same law
    plumb_real outflow;
    plumb_real core_radius; ///< [m] >= 1e-3 of vortex and source; 0 means 1
    /// [m/s] of a jet out of a slot at the origin along the body's own x axis. Up to 6 widths ahead it has a core of that speed,
    /// from there on its axis has jet sqrt(6 jet_width / x); it widens by x / 8, its profile is sech^2, and what it
    /// carries of momentum is the same all along (turbulent plane jet: Schlichting). Negative: along minus x
    plumb_real jet;
    plumb_real jet_width; ///< [m] >= 1e-3, of the slot across the jet; 0 means 1
    /// [m/s] root mean square speed of eddies: 16 waves of a stream function between eddy_length and a sixteenth of it, with
    /// Kolmogorov's spectrum, which pass with flow_x, flow_y and change in the time in which they turn (Kraichnan 1970; Fung and
    /// others 1992). Free of divergence; stateless. Who is in such a volume stays awake, as in gusts
    plumb_real eddies;
    plumb_real eddy_length; ///< [m] >= 1e-3, of the largest; 0 means 10

    /// What light sees of it (plumb/light.h); nothing else asks for these.

    plumb_real refractive_index; ///< [-] 0..10: glass 1.5, water 1.33, diamond 2.42; 0: opaque
    plumb_real reflectance;      ///< [-] 0..1, share of the light that its surface sends back, before Fresnel has his; 1: a mirror
    plumb_real absorption;       ///< [1/m] 0..1e9: of light in it e^(-absorption x) is left after x (Beer, Lambert)
} plumb_material_desc;

/// Makes a material. Null handle on error (see plumb_world_error): E_NULL, E_RANGE, E_NOT_FINITE,
/// E_MEMORY, E_LOCKED.
PLUMB_API plumb_material plumb_material_create(plumb_world *world, const plumb_material_desc *desc);

/// Destroys a material. Errors: E_HANDLE (also for the default one), E_STATE (still used by a shape).
PLUMB_API plumb_result plumb_material_destroy(plumb_world *world, plumb_material material);

/// Reads a material; null reads the default one. Errors: E_HANDLE, E_NULL.
PLUMB_API plumb_result plumb_material_settings(const plumb_world *world, plumb_material material,
                                               plumb_material_desc *desc);

/// Changes a material; null changes the default one. Friction and restitution hold from the next
/// step; masses computed from the density are not revised (see plumb_body_reset_mass).
/// Errors: E_HANDLE, E_NULL, E_RANGE, E_NOT_FINITE.
PLUMB_API plumb_result plumb_material_set(plumb_world *world, plumb_material material,
                                          const plumb_material_desc *desc);

/// What two materials have between them, instead of what mixing gives.
typedef struct plumb_material_pair {
    plumb_real friction;           ///< [-] 0..10
    plumb_real restitution;        ///< [-] 0..10
    plumb_real rolling_resistance; ///< [m] >= 0
    plumb_real adhesion;           ///< [N] >= 0
    plumb_real kinetic_friction;   ///< [-] 0..10, once they slide; 0, or above `friction`: the same as that
} plumb_material_pair;

/// Sets what two materials have between them, from the next step on; null handles are the default
/// material, `pair` null goes back to mixing. Forgotten when one of them is destroyed. A world without
/// such pairs pays nothing. O(pairs set). Errors: E_HANDLE, E_RANGE, E_NOT_FINITE, E_MEMORY.
PLUMB_API plumb_result plumb_material_pair_set(plumb_world *world, plumb_material a, plumb_material b,
                                               const plumb_material_pair *pair);
/// Reads what was set. Errors: E_HANDLE, E_NULL, E_MISSING (the two are mixed).
PLUMB_API plumb_result plumb_material_pair_get(const plumb_world *world, plumb_material a,
                                               plumb_material b, plumb_material_pair *pair);

PLUMB_END

#endif
