/// liquid.h - water that flows: particles that carry mass, a grid that keeps their volume.
///
///     plumb_liquid_create(world, &(plumb_liquid_desc){ .spacing = 0.05f });
///     plumb_liquid_add_box(world, (plumb_vec2){ 0, 0 }, (plumb_vec2){ 2, 1 }, NULL);
///     for (;;) {
///         plumb_world_step(world, 1.0f / 60);
///         int count;
///         const plumb_particle *p = plumb_liquid_particles(world, &count);
///     }
///
/// A world has one liquid or none. It falls by the world's gravity, is kept out by every solid shape (sensors let it
/// through, filters do not count), and floats, pushes and is pushed by dynamic bodies: their velocities are unknowns of
/// its one system of pressures, so that a body of a thousandth of its density is as stable as a heavy one.
/// So are the nodes of soft bodies near it: triangles and rings with gas keep it out and are pressed together by it, threads let it
/// through. What of a soft body is far lighter than the layer of cells beside it takes a quarter of that along when its speed changes.
/// Shapes without area, and those thinner than a cell (two spacings), hold it back as walls do.
/// Particles on their own, fewer than 24 in tiles of 16 x 16 cells with no body near, fly as points.
///
/// It may have phases, liquids that do not mix: oil on water.
///
///     plumb_liquid_set_phases(world, &(plumb_liquid_phase){ .density = 800, .viscosity = 0.1f }, 1);
///     plumb_liquid_add_box(world, (plumb_vec2){ 0, 1 }, (plumb_vec2){ 2, 1.5f }, &(plumb_particle){ .phase = 1 });
///
/// A liquid, or a phase, with `friction` is granular: sand that rests in heaps, bears what lies on it, and runs out of a hole evenly.
///
/// Where phases of different density share a cell they part: a particle is a drop of its size, which rises or sinks at
/// its terminal velocity. All have one velocity at a place, so two that stream past one another rub within a cell or two.
///
/// The world must not wrap around. Nothing of it is done in a world without a liquid, nor of phases where there is one.
#ifndef PLUMB_LIQUID_H
#define PLUMB_LIQUID_H

#include "plumb/world.h"

PLUMB_BEGIN

/// Most particles of a liquid.
#define PLUMB_LIQUID_MAX 4000000

/// {0} is valid: water, 5 cm apart.
typedef struct plumb_liquid_desc {
    plumb_real spacing; ///< [m] 1e-4..1e3 between particles at rest; 0 means 0.05. Cells are twice as wide
    plumb_real density; ///< [kg/m^2] 1e-6..1e9 of area; 0 means 1000
    /// [Pa s] 0..1e9 dynamic; 0: it slips along walls. Above 0 it clings to them, as honey (10), and pitch (1e6 and
    /// more). Stable at any; values beyond 1e6 density (2 spacing)^2 / dt act as that. Costs a solution of its own
    plumb_real viscosity;
    /// [N/m] 0..1e9 of the surface to the air, not between phases; 0: it has none. Water: 0.072. The pressure in a drop of radius R
    /// is higher by tension / R; the surface meets walls and bodies at right angles, and does not pull at these. Good where radii
    /// are five cells (ten spacings) and more. A step is cut into parts below sqrt(density (2 spacing)^3 / (2 pi tension)), at
    /// most eight; more acts as what these can follow
    plumb_real tension;
    /// [-] 0..10 of grains on grains, the tangent of the steepest slope at which they rest: sand 0.6. 0: a liquid. Grains
    /// bear a shear stress of at most friction times the pressure between them, and cling to walls and bodies as far
    plumb_real friction;
} plumb_liquid_desc;

/// Most phases beside the first.
#define PLUMB_LIQUID_MAX_PHASES 7

/// Another liquid in the same world: one that does not mix with the first. {0} is valid: water.
typedef struct plumb_liquid_phase {
    plumb_real density;   ///< [kg/m^2] a thousandth to a thousand times the first's; 0 means 1000
    plumb_real viscosity; ///< [Pa s] 0..1e9, as of plumb_liquid_desc
    plumb_real friction;  ///< [-] 0..10, as of plumb_liquid_desc
} plumb_liquid_phase;

/// A particle: spacing^2 of area. {0} is water at rest.
typedef struct plumb_particle {
    plumb_vec2 position; ///< [m]
    plumb_vec2 velocity; ///< [m/s]
    /// [1/s] how velocity changes around it: of its x component along x and y, then of its y component
    plumb_real gradient[4];
    uint32_t phase; ///< 0: what plumb_liquid_desc says; from 1: of plumb_liquid_set_phases
    uint32_t tag;   ///< yours: carried along, never read. A dye, for example
    /// [Pa] what a grain bears beside pressure: half of the difference of normal stresses along x and y, the shear stress. 0
    /// where there is no friction
    plumb_real shear[2];
} plumb_particle;

/// Gives the world a liquid without any particle yet. `desc` may be null (= {0}). Errors: E_NULL, E_RANGE,
/// E_NOT_FINITE, E_STATE (it has one; the world wraps around), E_MEMORY, E_LOCKED.
PLUMB_API plumb_result plumb_liquid_create(plumb_world *world, const plumb_liquid_desc *desc);
/// Takes the liquid away with all of its particles. Errors: E_NULL, E_STATE (there is none), E_LOCKED.
PLUMB_API plumb_result plumb_liquid_destroy(plumb_world *world);

/// The settings in force, defaults resolved. Errors: E_NULL, E_STATE (there is no liquid).
PLUMB_API plumb_result plumb_liquid_settings(const plumb_world *world, plumb_liquid_desc *desc);
/// Changes density, viscosity and tension from the next step on; `spacing` must be 0 or what it is. `desc` may be null
/// (= {0}). Errors: as plumb_liquid_create; E_STATE also for another spacing; E_RANGE also for a density that is not
/// within a thousandth to a thousand times that of each phase.
PLUMB_API plumb_result plumb_liquid_set(plumb_world *world, const plumb_liquid_desc *desc);
/// What particles of the phases 1 to `count` are, from the next step on; 0..PLUMB_LIQUID_MAX_PHASES. Costs in steps with
/// several densities or viscosities about a third more. Errors: E_NULL, E_STATE (there is no liquid; particles have a
/// phase beyond `count`), E_RANGE, E_NOT_FINITE, E_MEMORY, E_LOCKED; then nothing changes.
PLUMB_API plumb_result plumb_liquid_set_phases(plumb_world *world, const plumb_liquid_phase *phases,
                                               int count);
/// The phases from 1 on, defaults resolved, and how many (`count` may be null). Valid until they are set, or the
/// liquid is destroyed. Null without any, or without a world.
PLUMB_API const plumb_liquid_phase *plumb_liquid_phases(const plumb_world *world, int *count);

/// Adds `count` particles as they are: positions [m], |x|, |y| <= 1e9 and at most 2^29 cells from 0, velocities [m/s] up
/// to 1e6, gradients up to 1e9, shear stresses up to 1e30. They should lie a spacing apart; those inside of shapes are pushed out. Errors: E_NULL,
/// E_STATE (there is no liquid), E_RANGE (also: more than PLUMB_LIQUID_MAX, no such phase), E_NOT_FINITE, E_MEMORY, E_LOCKED;
/// then none is added.
PLUMB_API plumb_result plumb_liquid_add(plumb_world *world, const plumb_particle *particles,
                                        int count);
/// Fills a box from `low` to `high` [m] with particles: the places of the lattice of multiples of the spacing plus one half
/// that lie in it. A box that is a multiple of cells (two spacings) wide is filled to its edges. All are as `like`, which
/// may be null (= {0}), but for their places. Errors: as plumb_liquid_add; E_RANGE where `low` is not below `high`.
PLUMB_API plumb_result plumb_liquid_add_box(plumb_world *world, plumb_vec2 low, plumb_vec2 high,
                                            const plumb_particle *like);
/// Fills a closed outline of `count` points [m], 3..256 in order, concave or not, in the same lattice. Errors: as
/// plumb_liquid_add.
PLUMB_API plumb_result plumb_liquid_add_shape(plumb_world *world, const plumb_vec2 *points,
                                              int count, const plumb_particle *like);
/// Keeps an outline full: as plumb_liquid_add_shape, but only at places from which every particle is a spacing off, or nearly,
/// along x or y. Called before each step it is a source: a jet with a velocity, a spring without. Errors: the same.
PLUMB_API plumb_result plumb_liquid_refill(plumb_world *world, const plumb_vec2 *points, int count,
                                           const plumb_particle *like);
/// Removes the particles in a box [m]; the others keep their order. Returns how many were removed; -1 on error: E_NULL,
/// E_STATE, E_RANGE (low above high), E_NOT_FINITE, E_LOCKED.
PLUMB_API int plumb_liquid_remove(plumb_world *world, plumb_vec2 low, plumb_vec2 high);

/// Particles of phase `from` in a box [m] are of phase `to` from now on: wax that is heated, or freezes. Returns how many;
/// -1 on error: as plumb_liquid_remove; E_RANGE also where there is no such phase.
PLUMB_API int plumb_liquid_change_phase(plumb_world *world, plumb_vec2 low, plumb_vec2 high,
                                        int from, int to);

/// All particles, in the order in which they were added, and how many (`count` may be null). Valid until the next
/// step, or change of the liquid. Null without any, or without a world.
PLUMB_API const plumb_particle *plumb_liquid_particles(const plumb_world *world, int *count);

//---- what is where -------------------------------------------------------------------------------

/// The liquid at a place.
typedef struct plumb_liquid_sample {
    plumb_real fill;     ///< [-] how full the liquid round the place is: 1 within, 0.5 at its surface and along walls, 0 where none
                         ///< is within three spacings. Quadratic B-splines of the particles, a cell (two spacings) wide
    plumb_vec2 velocity; ///< [m/s] mean of the particles round it, each as its gradient has it there; 0 where fill is
    uint32_t phase;      ///< of the nearest particle; 0 where there is none
} plumb_liquid_sample;

/// What is at a place [m]: whether a hero can breathe there, where an oar dips in (fill >= 0.5). {0} where there is nothing, and on
/// error (see plumb_world_error): E_NULL, E_STATE (no liquid), E_NOT_FINITE. The first question after particles moved files
/// them anew, O(particles); E_MEMORY. Then O(1): some 80 particles. A world that is asked goes on as one that is not.
PLUMB_API plumb_liquid_sample plumb_liquid_at(plumb_world *world, plumb_vec2 position);

/// Where a ray met the surface of the liquid.
typedef struct plumb_liquid_hit {
    plumb_vec2 point;    ///< [m]
    plumb_vec2 normal;   ///< unit, out of the liquid; zero when the ray starts in it
    plumb_real fraction; ///< [-] 0..1 along the ray
    plumb_vec2 velocity; ///< [m/s] as that of plumb_liquid_sample
    uint32_t phase;      ///< likewise
} plumb_liquid_hit;

/// The first place on the segment from `from` to `to` [m] where `fill` reaches 0.5; true when there is one. Straight down it tells
/// how high the liquid stands. Within 1e-3 spacings; what is thinner than half a spacing may be missed. Shapes are not seen: a
/// wall before the liquid is another question (plumb_world_ray). False also on error, as plumb_liquid_at; E_NULL also for `hit`.
/// Cost: O(1) for each half spacing of the way within the box round all particles.
PLUMB_API bool plumb_liquid_ray(plumb_world *world, plumb_vec2 from, plumb_vec2 to,
                                plumb_liquid_hit *hit);

/// A dynamic body, or a soft one, that the liquid touched in the last step: some of its cells beside it were full.
typedef struct plumb_liquid_contact {
    plumb_body body;         ///< null: a soft body
    plumb_softbody softbody; ///< null: a body
    plumb_vec2 force;        ///< [N] what the liquid did to it, mean of the step: what lifts, drags and strikes it
    plumb_real torque;       ///< [N m] about its centre of mass
    bool began;              ///< it was dry in the step before: a splash, as hard as `force` says
} plumb_liquid_contact;

/// Those of the last step, by slot of body or soft body; *count is set (may be null). Null when there are none, after a step of
/// dt 0, and after a restore. Valid as events are (plumb/event.h).
PLUMB_API const plumb_liquid_contact *plumb_liquid_contacts(const plumb_world *world, int *count);

/// What the liquid touched in the step before and touches no more, or is gone: its handle may be stale.
typedef struct plumb_liquid_end {
    plumb_body body;         ///< null: a soft body
    plumb_softbody softbody; ///< null: a body
} plumb_liquid_end;

/// Those of the last step, as plumb_liquid_contacts has them. Whoever counts `began` and ends is right, also across a restore. A liquid
/// that is destroyed ends nothing.
PLUMB_API const plumb_liquid_end *plumb_liquid_ends(const plumb_world *world, int *count);

PLUMB_END

#endif
