// laws.h - forces at a distance: what the files of laws share, and what the step and the API call.
#ifndef PL_LAWS_H
#define PL_LAWS_H

#include "effects/effects.h"
#include "world/state.h"

//---- laws.c: a step ------------------------------------------------------------------------------

// Of an image: numbers in their ranges; the body is asked for elsewhere.
bool pl_law_desc_is_sound(const pl_law_data *desc);
bool pl_law_formula_is_sound(const pl_law_formula *formula);
bool pl_orbit_desc_is_sound(const plumb_orbit_desc *desc);
plumb_orbit_desc pl_orbits_of(const plumb_world *world); // defaults resolved
void pl_laws_free(pl_memory *memory, pl_laws *laws);

// A body as laws have it.
pl_law_body pl_law_body_of(const plumb_world *world, uint32_t row);
// A law as it lies now; false: who carries it is out of the simulation.
bool pl_law_place(const plumb_world *world, const pl_law *item, pl_law_now *law);
// Laws as they lie now, by priority, into room for all of them; returns how many act.
uint32_t pl_laws_place(const plumb_world *world, pl_law_now *out);
// Before the graph: who flies, who is pushed. False when out of memory.
bool pl_laws_find(plumb_world *world, plumb_real dt);
// Those that are pushed together are in one cluster, which one thread solves: marks them. True if there are any.
bool pl_laws_couple(const plumb_world *world, uint8_t *called);
// When nothing can fail any more: who wakes, who does not fall asleep, where laws were.
void pl_laws_settle(plumb_world *world, plumb_real dt);
// Behind the graph: slots of those that are pushed. False when out of memory.
bool pl_laws_take_slots(plumb_world *world);

static inline pl_law_now *pl_laws_now(const plumb_world *world)
{
    return (pl_law_now *)world->laws.step.laws.data;
}

static inline pl_law_body *pl_law_bodies(const plumb_world *world)
{
    return (pl_law_body *)world->laws.step.bodies.data;
}

static inline pl_law_way pl_law_way_of(const plumb_world *world, uint32_t row)
{
    return (pl_law_way)((const uint8_t *)world->laws.step.ways.data)[row];
}

// Uniform or magnetic, everywhere.
static inline bool pl_law_is_endless(const pl_law_data *d)
{
    return (d->kind == PLUMB_LAW_UNIFORM || d->kind == PLUMB_LAW_MAGNETIC) && d->radius == 0 &&
           d->half.x == 0;
}

static inline bool pl_law_names(const pl_law_data *d, const pl_law_body *body)
{
    return d->categories == 0 || (d->categories & body->categories) != 0;
}

// It wakes bodies that sleep, though none is awake.
static inline bool pl_law_is_restless(const pl_laws *laws, const pl_law *law)
{
    return !plumb_is_null(law->desc.body) ||
           (law->formula > 0 && pl_law_formula_of(laws, law)->program.uses_time != 0);
}

// [kg] or [C] by which a law takes hold of a body; 0: it does not.
static inline double pl_law_hold_of(const pl_law_data *d, const pl_law_body *body)
{
    const bool charge = d->hold == PLUMB_LAW_ON_CHARGE || d->kind == PLUMB_LAW_MAGNETIC;
    return !pl_law_names(d, body) ? 0 : charge ? body->charge : body->weight;
}

static inline bool pl_law_has_dipole(const pl_law_body *body)
{
    return body->mx != 0 || body->my != 0;
}

// By its mass, its charge or its dipole.
static inline bool pl_law_holds(const pl_law_data *d, const pl_law_body *body)
{
    return pl_law_hold_of(d, body) != 0 ||
           (pl_law_has_dipole(body) && d->hold == PLUMB_LAW_ON_CHARGE &&
            d->kind != PLUMB_LAW_MAGNETIC && pl_law_names(d, body));
}

// By a mutual law it attracts, or repels, whatever that holds.
static inline bool pl_law_is_source(const pl_law_data *d, const pl_law_body *body)
{
    return d->kind == PLUMB_LAW_MUTUAL && pl_law_holds(d, body) &&
           (d->hold == PLUMB_LAW_ON_CHARGE || body->attraction > 0);
}

//---- law_forces.c --------------------------------------------------------------------------------

// Bodies that are moved together, or one alone.
typedef struct pl_law_system {
    const plumb_world *world;
    const pl_law_now *laws;
    pl_law_body *bodies;
    uint32_t law_count, count;
    uint32_t sources;   // the first so many attract; 0: the system is not coupled
    plumb_vec2 gravity; // that acts besides, where nothing replaces it
    bool replaces;      // some law does: then nothing is in the bodies' ax, ay
    bool formulas;      // some law is one
    bool others;        // some law is none, or replaces
    bool alone; // one body, out of reach of all laws that coupled ones carry as the step began
} pl_law_system;

// Accelerations (x, y a body) at a time [s] since the step began, but for those in the bodies' ax, ay, and for magnetic
// laws. `slopes`, if not NULL: how they change with a body's velocity, [1/s] ax by vx, ax by vy, ay by vx, ay by vy.
static inline void pl_laws_pull(const pl_law_system *system, const pl_law_state *states,
                                double time, double *out, double *slopes);
// Those of laws that are no formulas.
void pl_laws_pull_plain(const pl_law_system *system, const pl_law_state *states, double time,
                        double *out);
// What is to be added to a velocity in a second of h seconds in which the acceleration a [m/s^2] changes with it by `slopes`.
void pl_law_kick(const double a[2], const double slopes[4], double h, double out[2]);
// A law takes hold of the body of index i and reaches it.
bool pl_law_acts(const pl_law_system *system, const pl_law_now *law, const pl_law_state *states,
                 uint32_t i, double time);
// [rad/s] by which magnetic laws turn the velocity of a body clockwise.
double pl_laws_spin(const pl_law_system *system, const pl_law_body *body, const pl_law_state *state,
                    double time);
// A law acts at an offset from where it is.
bool pl_law_reaches(const pl_law_now *law, double dx, double dy);
// What a law of strength 1 makes of the square of a distance [m^2]: a force over the way's vector.
double pl_law_falloff(const pl_law_now *law, double square);
// How strongly two bodies attract each other by a mutual law; below 0 they repel.
double pl_law_pair(const pl_law_now *law, const pl_law_body *a, const pl_law_body *b);
// Where a body of the solver is in the middle of a substep of h [s], without what laws do; one that sleeps, where it lies.
pl_law_state pl_law_middle(const plumb_world *world, const pl_law_body *body, double h);

//---- dipoles.c -----------------------------------------------------------------------------------

// A body at a place and an angle.
typedef struct pl_pole {
    const pl_law_body *body;
    double x, y;   // [m]
    double mx, my; // [C m] of its dipole, along the world's axes
} pl_pole;

// What laws give a body for its dipole, or for those of others: beyond what charges do to each other.
typedef struct pl_dipole_push {
    double fx, fy;         // [N]; of a pair on the second, and the first has the opposite
    double torque, answer; // [N m] of a pair on the second; on the first
} pl_dipole_push;

// Room for poles of coupled bodies. False when out of memory.
bool pl_dipoles_reserve(plumb_world *world);
// [C m] moment of a body of a record, along the world's axes.
void pl_dipole_moment(const pl_bodies *bodies, uint32_t row, const pl_body_settings *record,
                      double out[2]);
// As its columns have it.
pl_pole pl_pole_of(const plumb_world *world, const pl_law_body *body);
// Between two bodies, by a mutual law on charge; nothing by another, or where neither has a dipole.
pl_dipole_push pl_dipole_pair(const pl_law_now *law, const pl_pole *a, const pl_pole *b);
// From a uniform law or an attractor on charge that is at a place; nothing from another. Whether its zone reaches so far is
// not asked.
pl_dipole_push pl_dipole_in(const pl_law_now *law, const pl_pole *pole, double x, double y);
// From a formula on charge, of a body that moves as the state says.
pl_dipole_push pl_dipole_in_formula(const plumb_world *world, const pl_law_now *law,
                                    const pl_pole *pole, const pl_law_state *state, double time);
// [J] of the same, where the law has a potential (law_field.c).
double pl_dipole_energy(const pl_law_now *law, const pl_pole *a, const pl_pole *b);
double pl_dipole_energy_in(const plumb_world *world, const pl_law_now *law, const pl_pole *pole);

//---- law_rest.c ----------------------------------------------------------------------------------

// Room for what coupled bodies are pulled by. False when out of memory.
bool pl_law_rest_reserve(plumb_world *world);
// When nothing can fail any more: who attracts others, or has a dipole, and does not come to rest, or wakes.
void pl_law_rest(plumb_world *world);

//---- law_field.c ---------------------------------------------------------------------------------

// [J] of the laws that have a potential, at the bodies' places now.
double pl_laws_potential(const plumb_world *world);
// What all laws of a system of one body give it at a place, mutual ones too: as pl_laws_pull.
void pl_laws_at(const pl_law_system *of, const pl_law_state *state, double out[2]);
// What all laws and gravity give a body of a charge a mass [C/kg] at a place: an acceleration.
void pl_laws_probe(const plumb_world *world, const pl_law_state *state, double charge,
                   double out[2]);
// Laws that move, and bodies that attract, pull the body of a row more than what rests may be pushed otherwise.
bool pl_laws_stir(const plumb_world *world, uint32_t row);
pl_law_state pl_law_state_of(const plumb_world *world, uint32_t row);

//---- law_formula.c -------------------------------------------------------------------------------

// Bodies that are taken together.
#define PL_LAW_BLOCK PL_FORMULA_LANES

// As pl_laws_pull, where some law is a formula.
void pl_formulas_pull(const pl_law_system *system, const pl_law_state *states, double time,
                      double *out, double *slopes);
// [J] that a body has in a law whose formula is a potential.
double pl_formula_potential(const plumb_world *world, const pl_law_now *law, double x, double y);
// Who wakes or does not fall asleep because a formula of the time changes where it is.
void pl_formulas_heed(plumb_world *world, double dt);

static inline void pl_laws_pull(const pl_law_system *system, const pl_law_state *states,
                                double time, double *out, double *slopes)
{
    if (system->formulas) {
        pl_formulas_pull(system, states, time, out, slopes);
    } else {
        pl_laws_pull_plain(system, states, time, out);
    }
}

//---- orbits.c ------------------------------------------------------------------------------------

// Room for those that fly. False when out of memory.
bool pl_orbits_reserve(plumb_world *world);
// The flight of a body of PL_LAW_FLIES over the step.
static inline const pl_flight *pl_orbit_of(const plumb_world *world, uint32_t row)
{
    return (const pl_flight *)world->laws.step.flights.data + row;
}

#endif
