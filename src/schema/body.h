// body.h - the properties of bodies. See row.h.
#ifndef PL_SCHEMA_BODY_H
#define PL_SCHEMA_BODY_H

#include "plumb/body.h"
#include "schema/row.h"

// [kg], [kg m^2]: masses and inertias beyond these have no inverse that a float could hold.
#define PL_MASS_LEAST ((plumb_real)1e-36)
#define PL_MASS_MOST  ((plumb_real)1e36)

// clang-format off
#define PL_BODY_ROWS(R, X)                                                                          \
    R(X, OWN, BODY_TYPE, type, SAID(type), PL_BODY_TYPE_CHOICES, CHOICES(PLUMB_STATIC),             \
      PLUMB_DYNAMIC, NO_ZERO, "what moves it: forces and contacts, its velocity alone, nothing")    \
    R(X, OWN, VEC2, position, SAID(at), "m", FROM(-1e9, 1e9), 0, NO_ZERO, "origin of its frame")    \
    R(X, OWN, REAL, angle, SAID(angle), "rad", ANY, 0, NO_ZERO, "of its frame")                     \
    R(X, OWN, VEC2, velocity, SAID(velocity), "m/s", ANY, 0, NO_ZERO,                               \
      "of the centre of mass; not for static bodies")                                               \
    R(X, OWN, REAL, angular_velocity, SAID(spin), "rad/s", ANY, 0, NO_ZERO, "not for static bodies") \
    R(X, OWN, REAL, mass, SAID(mass), "kg", FROM(PL_MASS_LEAST, PL_MASS_MOST), 0, NO_ZERO,          \
      "in place of that of its shapes; dynamic bodies")                                             \
    R(X, OWN, REAL, inertia, SAID(inertia), "kg m^2", FROM(PL_MASS_LEAST, PL_MASS_MOST), 0, NO_ZERO, \
      "about the centre of mass, in place of that of its shapes; dynamic bodies")                   \
    R(X, COLUMN, REAL, gravity_scale, SAID(gravity_scale), "1", ANY, 1, ZERO(no_gravity),           \
      "factor on gravity; dynamic bodies")                                                          \
    R(X, OWN, BOOL, fixed_rotation, SAID(fixed_rotation), "1", CHOICES(1), 0, NO_ZERO,              \
      "never turns; dynamic bodies")                                                                \
    R(X, OWN, BOOL, no_sleep, NOT(sleep), "1", CHOICES(1), 0, NO_ZERO,                              \
      "whether it falls asleep at rest; dynamic bodies")                                            \
    R(X, OWN, BOOL, asleep, SAID(asleep), "1", CHOICES(1), 0, NO_ZERO,                              \
      "starts asleep, without velocity; dynamic bodies")                                            \
    R(X, OWN, BOOL, continuous, SAID(continuous), "1", CHOICES(1), 0, NO_ZERO,                      \
      "it and moving bodies, however fast, do not pass through each other; dynamic bodies")         \
    R(X, OWN, BOOL, lock_x, UNSAID, "1", CHOICES(1), 0, NO_ZERO, "never moves along x; dynamic bodies") \
    R(X, OWN, BOOL, lock_y, UNSAID, "1", CHOICES(1), 0, NO_ZERO, "never moves along y; dynamic bodies") \
    R(X, RECORD, REAL, damping, SAID(damping), "1/s", FROM(0, NO_END), 0, NO_ZERO,                  \
      "dv/dt = a - damping v; dynamic bodies")                                                      \
    R(X, RECORD, REAL, angular_damping, SAID(angular_damping), "1/s", FROM(0, NO_END), 0, NO_ZERO,  \
      "dw/dt = a - angular_damping w; dynamic bodies")                                              \
    R(X, RECORD, REAL, max_speed, SAID(max_speed), "m/s", ABOVE(0, NO_END), 0, NO_ZERO,             \
      "speed that it never exceeds; dynamic bodies")                                                \
    R(X, RECORD, REAL, max_spin, SAID(max_spin), "rad/s", ABOVE(0, NO_END), 0, NO_ZERO,             \
      "angular speed that it never exceeds; dynamic bodies")                                        \
    R(X, RECORD, REAL, time_scale, SAID(time_scale), "1", FROM(0, 100), 1, NO_ZERO,                 \
      "below 1 it moves in slow motion, through the same path; not for static bodies")              \
    R(X, RECORD, REAL, charge, SAID(charge), "C", FROM(-1e9, 1e9), 0, NO_ZERO,                      \
      "what electric and magnetic laws act on; dynamic bodies")                                     \
    R(X, RECORD, REAL, attraction, SAID(attraction), "1", FROM(0, 1e6), 0, NO_ZERO,                 \
      "1: attracts others by mutual gravitation; dynamic bodies")                                   \
    R(X, RECORD, REAL, drag, SAID(drag), "kg/m", FROM(0, 1e9), 0, NO_ZERO,                          \
      "of still air, by the square of the speed; dynamic bodies")                                   \
    R(X, RECORD, REAL, thrust, SAID(thrust), "N", FROM(0, 1e12), 0, NO_ZERO,                        \
      "of its engine; dynamic bodies")                                                              \
    R(X, RECORD, REAL, exhaust, SAID(exhaust), "m/s", FROM(0, 1e9), 0, NO_ZERO,                     \
      "speed of the exhaust: it burns thrust / exhaust; 0: nothing; dynamic bodies")                \
    R(X, RECORD, REAL, fuel, SAID(fuel), "kg", FROM(0, 1e12), 0, NO_ZERO,                           \
      "left, part of its mass; dynamic bodies")                                                     \
    R(X, RECORD, REAL, thrust_x, SAID(thrust_x), "m", FROM(-1e7, 1e7), 0, NO_ZERO,                  \
      "where its engine is, in its frame; dynamic bodies")                                          \
    R(X, RECORD, REAL, thrust_y, SAID(thrust_y), "m", FROM(-1e7, 1e7), 0, NO_ZERO,                  \
      "where its engine is, in its frame; dynamic bodies")                                          \
    R(X, RECORD, REAL, thrust_angle, SAID(thrust_angle), "rad", FROM(-1e9, 1e9), 0, NO_ZERO,        \
      "whereto its engine pushes, from the x axis of its frame; dynamic bodies")                    \
    R(X, RECORD, REAL, break_force, SAID(break_force), "N", FROM(0, NO_END), 0, NO_ZERO,            \
      "mean force of a contact over a step above which it breaks; dynamic bodies")                  \
    R(X, RECORD, REAL, break_impulse, SAID(break_impulse), "N s", FROM(0, NO_END), 0, NO_ZERO,      \
      "impulse of a contact in a step above which it breaks; dynamic bodies")                       \
    R(X, RECORD, REAL, break_energy, SAID(break_energy), "J", FROM(0, NO_END), 0, NO_ZERO,          \
      "that breaking takes from the hit; dynamic bodies")                                          \
    R(X, RECORD, REAL, break_cells, SAID(break_cells), "1", FROM(0, 64), 0, NO_ZERO,                \
      "parts that it breaks into at most; 0: twelve; dynamic bodies")                               \
    R(X, RECORD, REAL, dipole, SAID(dipole), "C m", FROM(-1e9, 1e9), 0, NO_ZERO,                    \
      "moment of a dipole or magnet, which laws on charge turn; dynamic bodies")                    \
    R(X, RECORD, REAL, dipole_angle, SAID(dipole_angle), "rad", FROM(-1e9, 1e9), 0, NO_ZERO,        \
      "whereto its dipole points, from the x axis of its frame; dynamic bodies")                    \
    R(X, HEAT, REAL, temperature, SAID(temperature), "K", FROM(0, 1e6), 0, NO_ZERO,                 \
      "of all of it; 0: it takes no part in heat. Bodies that are not dynamic hold it")             \
    R(X, HEAT, REAL, heat_capacity, SAID(heat_capacity), "J/(kg K)", ABOVE(0, 1e9), 1000, NO_ZERO,  \
      "energy that warms a kilogram by a kelvin; dynamic bodies")                                   \
    R(X, HEAT, REAL, conductance, SAID(conductance), "W/K", FROM(0, 1e9), 0, NO_ZERO,               \
      "of its half of each contact")                                                                \
    R(X, HEAT, REAL, emissivity, SAID(emissivity), "1", FROM(0, 1), 0, NO_ZERO,                     \
      "of its surface, which glows and takes in what its surroundings glow; dynamic bodies")        \
    R(X, HEAT, REAL, ambient, SAID(ambient), "K", ABOVE(0, 1e6), 293, NO_ZERO,                      \
      "temperature of what surrounds it; dynamic bodies")                                           \
    R(X, HEAT, REAL, heating, SAID(heating), "W", FROM(-1e12, 1e12), 0, NO_ZERO,                    \
      "that it gets, or loses; dynamic bodies")                                                     \
    R(X, HEAT, REAL, melting_point, SAID(melting_point), "K", FROM(0, 1e6), 0, NO_ZERO,             \
      "where it melts; 0: nowhere; dynamic bodies")                                                 \
    R(X, HEAT, REAL, latent_heat, SAID(latent_heat), "J/kg", FROM(0, 1e12), 0, NO_ZERO,             \
      "that melting takes; dynamic bodies")                                                         \
    R(X, HEAT, REAL, melt_phase, SAID(melt_phase), "1", FROM(0, 7), 0, NO_ZERO,                     \
      "of the liquid that it melts into; dynamic bodies")                                           \
    R(X, HEAT, REAL, ignition, SAID(ignition), "K", FROM(0, 1e6), 0, NO_ZERO,                       \
      "from which on it burns; 0: it does not; dynamic bodies")                                     \
    R(X, HEAT, REAL, burn_rate, SAID(burn_rate), "m/s", FROM(0, 1e3), 0, NO_ZERO,                   \
      "at which its surface burns away; dynamic bodies")                                            \
    R(X, HEAT, REAL, burn_heat, SAID(burn_heat), "J/kg", FROM(0, 1e12), 0, NO_ZERO,                 \
      "of what burns that stays with the body; dynamic bodies")                                     \
    R(X, HEAT, REAL, growth, SAID(growth), "1/s", FROM(-100, 100), 0, NO_ZERO,                      \
      "size grows by e^(growth t)")                                                                 \
    R(X, HEAT, REAL, smallest, SAID(smallest), "m", ABOVE(0, 1e4), 0.02, NO_ZERO,                   \
      "root of its area below which what melts, burns or shrinks is gone")                          \
    R(X, OWN, BOOL, disabled, NOT(enabled), "1", CHOICES(1), 0, NO_ZERO, "whether it is in the simulation")
// clang-format on

#endif
