/// law.h - forces at a distance as data: gravity of places and of bodies, electric and magnetic fields, zones, formulas.
///
///     plumb_law_create(world, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR, .body = planet, .strength = 40 });
///     plumb_law_create(world, &(plumb_law_desc){ .kind = PLUMB_LAW_FORMULA, .potential = "(x^2 - 1)^2 + 0.5 * y^2" });
///     plumb_world_set_orbits(world, &(plumb_orbit_desc){ .order = 4 });
///
/// A law acts on dynamic bodies, at their centres of mass, in every substep; on top of the world's gravity, unless it
/// replaces it. Bodies that nothing but laws, gravity and forces act on in a step (no contact, joint, damping, cap, lock,
/// time scale, dipole, no system of the substep) fly: they are moved by an integrator of orbits, of second order by default, of
/// fourth or to a tolerance by choice; what only uniform laws act on without end flies exactly. All others get the laws'
/// accelerations in their substeps. Bodies that attract one another fly together or not at all. Those that nothing holds (no
/// contact, joint, lock) do not fall asleep; the others do while the pull on them stays, and wake when it is another: by more
/// than plumb/sleep.h says of forces, and than 2 % of it.
/// The world must not wrap around. Nothing of it is done in a world without laws.
///
/// Formulas are expressions of the place where a body is, as the law sees it: `x` and `y` [m] from the law's position, along axes that
/// are turned by its angle and go with the body that carries it; `r`, the distance sqrt(x^2 + y^2); `t` [s], the simulated time. They
/// have numbers (1, .5, 2e-3), `pi`, `e`, + - * / ^ and parentheses, comparisons < <= > >= that are 1 or 0, and the functions abs, acos,
/// asin, atan, atan2(y, x), clamp(x, low, high), cos, exp, floor, hypot, if(condition, then, otherwise), log (natural), max, min, sign,
/// sin, sqrt, step (1 from 0 on, else 0), tan, tanh. -x^2 is -(x^2), 2^3^2 is 2^(3^2). Either `formula_x` and `formula_y` are the
/// components along the law's axes, an acceleration [m/s^2] or a force a charge [N/C]; these also know `vx` and `vy` [m/s], what x and y
/// change by in a second. Or `potential` [J/kg or J/C] is one whose slope downwards is the force, found by the rules of differentiation,
/// and plumb_world_energy knows it. Where a result is not finite, or above 1e30 in size, the law gives nothing: 1 / x at 0, log(-1). What
/// a root, or r, changes by counts as 0 where it is 0.
///
/// A formula becomes a program when it is set, which takes all bodies that fly or are pushed together, 32 at a time, step by step. Of
/// place and time alone it is flown at the order of the orbits; bodies that one of velocities reaches are flown at order 2 by kicks that
/// are solved for (by exact slopes; however strong, drag never overshoots, and what only turns keeps its speed), at order 4
/// and to a tolerance (of 1e-11 at the least) by extrapolation of that. A formula of t keeps awake, and wakes, whom it acts on while
/// it changes there by more than what rests does not feel in 100 s (see plumb/sleep.h).
#ifndef PLUMB_LAW_H
#define PLUMB_LAW_H

#include "plumb/body.h"

PLUMB_BEGIN

typedef enum plumb_law_kind {
    PLUMB_LAW_UNIFORM,   ///< `vector` everywhere, or in a zone: gravity [m/s^2] or an electric field [N/C]
    PLUMB_LAW_ATTRACTOR, ///< towards a place, or a body, by its distance
    PLUMB_LAW_MAGNETIC,  ///< `strength` [T] out of the plane, everywhere or in a zone: turns the velocity of charges
    PLUMB_LAW_MUTUAL,    ///< between each two bodies: gravitation, or forces between charges
    PLUMB_LAW_FORMULA    ///< what a text says, everywhere or in a zone
} plumb_law_kind;

/// What of a body a law takes hold of.
typedef enum plumb_law_hold {
    PLUMB_LAW_ON_MASS,  ///< mass times gravity scale: the law gives accelerations
    PLUMB_LAW_ON_CHARGE ///< charge: the law gives forces
} plumb_law_hold;

/// How a pull falls off with the distance r, which is sqrt(r^2 + softening^2) for what follows.
typedef enum plumb_falloff {
    PLUMB_FALLOFF_SQUARE,  ///< 1/r^2: gravitation, charges
    PLUMB_FALLOFF_INVERSE, ///< 1/r: the same in a plane
    PLUMB_FALLOFF_CUBE,    ///< 1/r^3
    PLUMB_FALLOFF_NONE,    ///< the same at any distance
    PLUMB_FALLOFF_SPRING   ///< r
} plumb_falloff;

/// What becomes of the others where a uniform law, an attractor or a formula acts.
typedef enum plumb_law_combine {
    PLUMB_LAW_ADD,    ///< it is added to them
    PLUMB_LAW_REPLACE ///< uniform laws, attractors and formulas of the same hold and of less priority do not act there, nor
                      ///< does, if it is on mass, the world's gravity
} plumb_law_combine;

#define PLUMB_LAW_PRIORITY_MOST 1000000
#define PLUMB_LAW_FORMULA_MOST  511 ///< characters of a formula

typedef struct plumb_law_desc {
    plumb_law_kind kind;
    plumb_law_hold hold;       ///< not of magnetic laws
    plumb_falloff falloff;     ///< of attractors and mutual laws
    plumb_law_combine combine; ///< of uniform laws, attractors and formulas
    int priority;              ///< -PLUMB_LAW_PRIORITY_MOST..PLUMB_LAW_PRIORITY_MOST: see combine
    /// Carries the law, null: nobody. Not of mutual laws. An attractor that a dynamic body carries pulls to its centre
    /// of mass, with a reaction on it, so that momentum is kept. Of a zone or a formula there is no reaction; it acts on who carries it,
    /// too. The law goes with the body, and rests while it is disabled.
    plumb_body body;
    plumb_vec2 position; ///< [m] of the attractor, the middle of the zone or of the formula: in the world, or in the body's frame
    plumb_real angle;    ///< [rad] of a box zone, and of a formula's axes
    plumb_vec2 vector;   ///< [m/s^2] or [N/C] of a uniform law, along the world's axes
    /// Of an attractor G m [m^3/s^2 where it falls off with the square] or so much force a charge [N m^2/C]: towards it, or
    /// away where it is negative. [T] of a magnetic law. Of a mutual law G: masses attract each other; or k: charges of one
    /// sign repel each other.
    plumb_real strength;
    plumb_real softening; ///< [m] >= 0 of attractors and mutual laws; with 0 nothing acts at distance 0
    plumb_real radius;    ///< [m] >= 0: beyond nothing acts; a zone is a circle. 0: without end
    plumb_vec2 half;      ///< [m] >= 0: half extents of a zone that is a box, both or none; then radius must be 0
    uint64_t categories;  ///< acts on bodies with a shape of one of these; 0: on all
    /// Of a formula: its components, of which a null one is 0, or its potential; texts of at most PLUMB_LAW_FORMULA_MOST characters.
    /// The world keeps copies.
    const char *formula_x, *formula_y;
    const char *potential;
} plumb_law_desc;

/// Adds a law. Null on error: E_NULL, E_RANGE (a formula: the message says where it is none, and why), E_NOT_FINITE, E_HANDLE (body),
/// E_STATE (the world wraps around), E_MEMORY, E_LOCKED, E_UNSUPPORTED (a library without laws, or without
/// formulas). What sleeps where it acts wakes.
PLUMB_API plumb_law plumb_law_create(plumb_world *world, const plumb_law_desc *desc);
/// Takes it away. Errors: E_HANDLE, E_LOCKED.
PLUMB_API plumb_result plumb_law_destroy(plumb_world *world, plumb_law law);
/// What it is. Texts are the world's: they hold until a law is made, changed or destroyed, or the world is restored. Errors: E_HANDLE,
/// E_NULL.
PLUMB_API plumb_result plumb_law_settings(const plumb_world *world, plumb_law law, plumb_law_desc *desc);
/// Makes another of it, its kind included. Errors: as plumb_law_create, E_HANDLE.
PLUMB_API plumb_result plumb_law_set(plumb_world *world, plumb_law law, const plumb_law_desc *desc);
/// The laws of a world in the order in which they were made: writes up to `capacity`, returns how many there are.
PLUMB_API int plumb_world_laws(const plumb_world *world, plumb_law *laws, int capacity);

/// What the laws and the world's gravity give a body of so much charge per mass [C/kg] and of gravity scale 1 that is at a
/// place with a velocity now: an acceleration [m/s^2]. Categories do not count, mutual laws are those of bodies that attract
/// (of charges: that are charged or have a dipole). 0 on error: E_NOT_FINITE.
PLUMB_API plumb_vec2 plumb_world_law_at(const plumb_world *world, plumb_vec2 position,
                                        plumb_vec2 velocity, plumb_real charge_per_mass);

/// How bodies that fly are moved. {0} is the default.
typedef struct plumb_orbit_desc {
    int order; ///< 2 or 4 in the substep; 0: 2. Of 2: velocity Verlet, a force a substep. Of 4: SRKN of Blanes and Moan
               ///< (2002), six forces a substep: both symplectic, energies stay bounded
    /// [-] 0..0.01. Above 0 the step is taken by extrapolation and divided until errors of a step are below tolerance
    /// times its way, whatever the order and the substeps: close encounters
    plumb_real tolerance;
} plumb_orbit_desc;

/// Errors: E_RANGE, E_NOT_FINITE, E_MEMORY, E_LOCKED, E_UNSUPPORTED (a library without laws). `desc` may be null (= {0}).
PLUMB_API plumb_result plumb_world_set_orbits(plumb_world *world, const plumb_orbit_desc *desc);
/// What is in force. Errors: E_NULL.
PLUMB_API plumb_result plumb_world_orbits(const plumb_world *world, plumb_orbit_desc *desc);

/// Charge [C] of a dynamic body, at its centre of mass; 0, the default: none. Errors: E_HANDLE, E_RANGE, E_NOT_FINITE,
/// E_MEMORY.
PLUMB_API plumb_result plumb_body_set_charge(plumb_world *world, plumb_body body, plumb_real charge);
PLUMB_API plumb_real plumb_body_charge(const plumb_world *world, plumb_body body);
/// How strongly [-] 0..1e6 a dynamic body attracts others by its mass where there is a mutual law on mass: the force
/// between two is G m1 m2 times the larger of both. 0, the default: it attracts only those that attract it; 1 is gravitation.
/// Errors: as plumb_body_set_charge.
PLUMB_API plumb_result plumb_body_set_attraction(plumb_world *world, plumb_body body,
                                                 plumb_real attraction);
PLUMB_API plumb_real plumb_body_attraction(const plumb_world *world, plumb_body body);

/// Dipole moment [C m] -1e9..1e9 of a dynamic body, at its centre of mass, towards dipole_angle [rad] from the x axis of its frame: two
/// opposite charges, the positive one ahead, whose distance is next to nothing. A bar magnet or a compass needle, with its
/// north pole ahead, is such a dipole of poles: a mutual law on charge acts between magnets, a uniform one is a field in the plane.
/// Every law on charge turns it by p x E and pulls it where the field E is another from place to place, by (p . grad) E;
/// by a mutual law on charge it acts on charges and dipoles as they do on it, so that momentum and angular momentum stay.
/// Two dipoles in line attract each other by 6 k p1 p2 / r^4 where charges have 1/r^2, side by side by half of that where
/// they point opposite ways. Close together the law's softening bounds it: forces of magnets that touch are those of dipoles
/// sqrt(r^2 + softening^2) apart. In a formula it is two charges 0.2 mm apart: where that jumps, it is kicked. Magnetic laws, whose field is out of the plane, leave dipoles alone; at the edge of a zone
/// nothing pulls. Of second order in the substep; a needle that swings at w [rad/s] needs substeps below 2 / w. Bodies with a dipole
/// that something acts on do not fly. The energy -p . E is part of plumb_world_energy. 0, the default: none; bodies
/// without it pay nothing. Cutting a body shares its dipole by mass. Errors: as plumb_body_set_charge.
PLUMB_API plumb_result plumb_body_set_dipole(plumb_world *world, plumb_body body, plumb_real dipole);
PLUMB_API plumb_real plumb_body_dipole(const plumb_world *world, plumb_body body);
/// Angle [rad] -1e9..1e9. Errors: as plumb_body_set_charge.
PLUMB_API plumb_result plumb_body_set_dipole_angle(plumb_world *world, plumb_body body,
                                                   plumb_real dipole_angle);
PLUMB_API plumb_real plumb_body_dipole_angle(const plumb_world *world, plumb_body body);

PLUMB_END

#endif
