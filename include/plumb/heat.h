/// heat.h - bodies that warm, melt, burn, grow and shrink: temperatures, heat through contacts and from surfaces.
///
///     plumb_body_set_temperature(world, plate, 500);                       // static: it stays so hot
///     plumb_body_set_conductance(world, plate, 1e9f);
///     plumb_body ice = plumb_body_create(world, &(plumb_body_desc){ .temperature = 263, .heat_capacity = 2100,
///         .conductance = 50, .melting_point = 273, .latent_heat = 3.3e5f });
///
/// A body has one temperature in all of it, and takes part in heat when that is not 0. A dynamic one of mass m has the heat
/// m heat_capacity temperature; others hold their temperature whatever they give and take. Heat is of the world's time,
/// and goes on while bodies sleep. It acts on no motion by itself.
///
/// Contacts: each contact of two convex pieces conducts g (Ta - Tb) [W], 1 / g = 1 / conductance_a + 1 / conductance_b: the
/// two halves are in series, so a body without conductance is insulated. Two bodies that touch come together
/// exactly as exp(-g (1 / Ca + 1 / Cb) t), C = m heat_capacity, whatever the step; of many, each pair does so to and fro
/// (G. Strang 1968): of second order in the step, stable at any, and what one gives the other gets to rounding.
///
/// Surfaces: emissivity sigma P (T^4 - ambient^4) [W], sigma = 5.670374419e-8 W/(m^2 K^4) (J. Stefan 1879, L. Boltzmann
/// 1884; CODATA 2018), P the perimeter of the shapes, a metre deep. Of second order, stable at any step. Bodies do not see
/// one another.
///
/// What melts at its melting point takes latent_heat; melt stays with the body until it is a 256th of its mass, and a
/// particle, then leaves it: in a world with a liquid that has its phase it becomes particles on the outline of the body, each with the velocity that the body
/// has there; momentum and angular momentum of both are what they were, to rounding. Else it is gone. What burns, hotter than its ignition
/// temperature, loses burn_rate from all of its surface; what has burnt is gone, with the momentum that it has. The
/// body shrinks about its centre of mass at the density that it has (plumb_body_scale), when the next step begins: what it touches wakes then. A body
/// below `smallest` (the root of its area) is gone, melt as particles of liquid, and is told by plumb_world_body_gone_events. A rest of melt that is no
/// particle is kept for the next of its phase.
///
/// Nothing of it is done in a world without it. Not in it: heat of friction; exchange with air (plumb/air.h) and liquid.
#ifndef PLUMB_HEAT_H
#define PLUMB_HEAT_H

#include "plumb/body.h"

PLUMB_BEGIN

/// Of a body, as members of plumb_body_desc of the same names. Temperature of the moment [K]; setting it adds or takes heat, and 0
/// ends its part in it. Errors of all that set: E_HANDLE, E_RANGE, E_NOT_FINITE, E_MEMORY, E_UNSUPPORTED (a library without
/// it). Getters: what the body has; defaults without. O(log n), to set O(n), n bodies that have any of it.
PLUMB_API plumb_result plumb_body_set_temperature(plumb_world *world, plumb_body body,
                                                  plumb_real temperature);
PLUMB_API plumb_real plumb_body_temperature(const plumb_world *world, plumb_body body);
/// [J/(kg K)] above 0, at most 1e9. Default 1000; water has 4186, ice 2100, wood 1700, iron 450.
PLUMB_API plumb_result plumb_body_set_heat_capacity(plumb_world *world, plumb_body body,
                                                    plumb_real heat_capacity);
PLUMB_API plumb_real plumb_body_heat_capacity(const plumb_world *world, plumb_body body);
/// [W/K] 0..1e9 from the body to the face of each of its contacts. Default 0: none flows.
PLUMB_API plumb_result plumb_body_set_conductance(plumb_world *world, plumb_body body,
                                                  plumb_real conductance);
PLUMB_API plumb_real plumb_body_conductance(const plumb_world *world, plumb_body body);
/// [-] 0..1. Default 0; 1 is black.
PLUMB_API plumb_result plumb_body_set_emissivity(plumb_world *world, plumb_body body,
                                                 plumb_real emissivity);
PLUMB_API plumb_real plumb_body_emissivity(const plumb_world *world, plumb_body body);
/// [K] above 0, at most 1e6, of what it radiates to. Default 293.
PLUMB_API plumb_result plumb_body_set_ambient(plumb_world *world, plumb_body body, plumb_real ambient);
PLUMB_API plumb_real plumb_body_ambient(const plumb_world *world, plumb_body body);
/// [W] |heating| <= 1e12; below 0 it is cooled, down to a thousandth of a kelvin at the least.
PLUMB_API plumb_result plumb_body_set_heating(plumb_world *world, plumb_body body, plumb_real heating);
PLUMB_API plumb_real plumb_body_heating(const plumb_world *world, plumb_body body);
/// [K] 0..1e6. Default 0: it does not melt.
PLUMB_API plumb_result plumb_body_set_melting_point(plumb_world *world, plumb_body body,
                                                    plumb_real melting_point);
PLUMB_API plumb_real plumb_body_melting_point(const plumb_world *world, plumb_body body);
/// [J/kg] 0..1e12; 0: what reaches its melting point melts at once. Ice has 3.34e5.
PLUMB_API plumb_result plumb_body_set_latent_heat(plumb_world *world, plumb_body body,
                                                  plumb_real latent_heat);
PLUMB_API plumb_real plumb_body_latent_heat(const plumb_world *world, plumb_body body);
/// [-] 0..7: see plumb_liquid_set_phases. Without a fraction.
PLUMB_API plumb_result plumb_body_set_melt_phase(plumb_world *world, plumb_body body,
                                                 plumb_real melt_phase);
PLUMB_API plumb_real plumb_body_melt_phase(const plumb_world *world, plumb_body body);
/// [K] 0..1e6. Default 0: it does not burn.
PLUMB_API plumb_result plumb_body_set_ignition(plumb_world *world, plumb_body body,
                                               plumb_real ignition);
PLUMB_API plumb_real plumb_body_ignition(const plumb_world *world, plumb_body body);
/// [m/s] 0..1e3.
PLUMB_API plumb_result plumb_body_set_burn_rate(plumb_world *world, plumb_body body,
                                                plumb_real burn_rate);
PLUMB_API plumb_real plumb_body_burn_rate(const plumb_world *world, plumb_body body);
/// [J/kg] 0..1e12: what burning gives, but for what rises with the flame.
PLUMB_API plumb_result plumb_body_set_burn_heat(plumb_world *world, plumb_body body,
                                                plumb_real burn_heat);
PLUMB_API plumb_real plumb_body_burn_heat(const plumb_world *world, plumb_body body);
/// [1/s] |growth| <= 100, of bodies of all types, with a temperature or without: lengths grow by exp(growth t), in steps of a 256th. Ends where
/// plumb_body_scale refuses. What grows keeps its velocity and temperature.
PLUMB_API plumb_result plumb_body_set_growth(plumb_world *world, plumb_body body, plumb_real growth);
PLUMB_API plumb_real plumb_body_growth(const plumb_world *world, plumb_body body);
/// [m] above 0, at most 1e4: root of the area below which a body that melts, burns or shrinks is gone. Default 0.02.
PLUMB_API plumb_result plumb_body_set_smallest(plumb_world *world, plumb_body body,
                                               plumb_real smallest);
PLUMB_API plumb_real plumb_body_smallest(const plumb_world *world, plumb_body body);

/// What became of a body.
typedef enum plumb_body_end {
    PLUMB_END_MELTED,
    PLUMB_END_BURNT,
    PLUMB_END_SHRUNK ///< by a growth below 0
} plumb_body_end;

/// A body that is gone.
typedef struct plumb_body_gone {
    plumb_body body;     ///< its handle, which is stale
    void *user_data;     ///< as it had
    plumb_vec2 position; ///< [m] of its centre of mass
    plumb_real mass;     ///< [kg] that it had left
    plumb_body_end end;
} plumb_body_gone;

/// Bodies that are gone since the last step began, in the order of their handles' indices; valid until the next step. Saved
/// worlds have none. Null and 0 where there are none.
PLUMB_API const plumb_body_gone *plumb_world_body_gone_events(const plumb_world *world, int *count);

/// The heat of a world: what there is, and what came and went since its first body with heat. `content` changes by
/// heating + burning + held - radiated - carried, to rounding (and by what bodies that come, go by a call, or are set bring and take).
/// The mass of bodies (plumb_body_mass less `burnt`), the mass of particles that melt became, `gone` and `owed` add up to what there was.
typedef struct plumb_heat_sums {
    double content;    ///< [J] heat of dynamic bodies, from 0 K, and latent heat of melt that is with them
    double burnt;      ///< [kg] that burnt and is still counted to bodies and their shapes
    double heating;    ///< [J] by `heating`
    double burning;    ///< [J] by `burn_heat`
    double held;       ///< [J] from bodies that hold their temperature
    double radiated;   ///< [J] given to the surroundings, less what was taken
    double carried;    ///< [J] that left with mass; less what came by growth
    double melted;     ///< [kg] that became particles of liquid
    double gone;       ///< [kg] that burnt, and melt without a liquid
    double owed;       ///< [kg] of melt that is no particle yet, of bodies that are gone
    double mechanical; ///< [J] kinetic and potential energy that left with mass between steps; less what came by growth
} plumb_heat_sums;

/// Errors: E_NULL. O(bodies with heat).
PLUMB_API plumb_result plumb_world_heat(const plumb_world *world, plumb_heat_sums *sums);

PLUMB_END

#endif
