// material.h - the properties of materials, and of what two materials have between them. See row.h.
#ifndef PL_SCHEMA_MATERIAL_H
#define PL_SCHEMA_MATERIAL_H

#include "plumb/material.h"
#include "schema/effects.h"
#include "schema/row.h"

// A library without friction has none by default.
#define PL_DEFAULT_FRICTION (PL_HAS(FRICTION) ? 0.6 : 0)

// Above 1 it gives energy: bumpers.
#define PL_RESTITUTION_MOST 10

// clang-format off
#define PL_MATERIAL_ROWS(R, X)                                                                      \
    R(X, COLUMN, REAL, density, SAID(density), "kg/m^2", ABOVE(0, NO_END), 1, NO_ZERO,              \
      "mass of an area of what is made of it")                                                      \
    R(X, COLUMN, REAL, friction, SAID(friction), "1", FROM(0, 10), PL_DEFAULT_FRICTION, ZERO(frictionless), \
      "Coulomb coefficient; a pair uses the root of the product")                                   \
    R(X, COLUMN, REAL, restitution, SAID(restitution), "1", FROM(0, PL_RESTITUTION_MOST), 0, NO_ZERO, \
      "share of the speed that an impact gives back, above 1 up to restitution_cap; a pair uses the larger") \
    R(X, COLUMN, REAL, rolling_resistance, SAID(rolling_resistance), "m", FROM(0, NO_END), 0, NO_ZERO, \
      "lever arm of the torque against rolling, by the normal force; a pair uses the larger")       \
    R(X, COLUMN, REAL, surface_speed, SAID(surface_speed), "m/s", ANY, 0, NO_ZERO,                  \
      "speed at which the surface runs along the outline, like a conveyor belt")                    \
    R(X, COLUMN, REAL, adhesion, SAID(adhesion), "N", FROM(0, NO_END), 0, NO_ZERO,                  \
      "force that it takes to part what has touched; a pair uses the larger")                       \
    R(X, COLUMN, MIX, friction_mix, SAID(friction_mix), PL_MIX_CHOICES, CHOICES(PLUMB_MIX_MAX),     \
      PLUMB_MIX_DEFAULT, NO_ZERO, "how a pair mixes friction; of two rules the later one holds")    \
    R(X, COLUMN, MIX, restitution_mix, SAID(restitution_mix), PL_MIX_CHOICES, CHOICES(PLUMB_MIX_MAX), \
      PLUMB_MIX_DEFAULT, NO_ZERO, "how a pair mixes restitution")                                   \
    R(X, COLUMN, MIX, adhesion_mix, SAID(adhesion_mix), PL_MIX_CHOICES, CHOICES(PLUMB_MIX_MAX),     \
      PLUMB_MIX_DEFAULT, NO_ZERO, "how a pair mixes adhesion")                                      \
    R(X, COLUMN, BOOL, fluid, SAID(fluid), "1", CHOICES(1), 0, NO_ZERO,                             \
      "sensors of it are filled with it: what is in them floats, is dragged and carried along")     \
    R(X, COLUMN, BOOL, weightless, SAID(weightless), "1", CHOICES(1), 0, NO_ZERO,                   \
      "a fluid that drags without lifting, nor lending its mass: wind")                             \
    R(X, COLUMN, REAL, drag, SAID(drag), "1", FROM(0, 1000), 1.8, ZERO(no_drag),                    \
      "coefficient of a fluid's pressure on surfaces that go ahead; of a disc two thirds of it")    \
    R(X, COLUMN, REAL, skin_drag, SAID(skin_drag), "1", FROM(0, 1000), 0.01, ZERO(no_skin_drag),    \
      "coefficient of a fluid's friction along all surfaces")                                       \
    R(X, COLUMN, REAL, added_mass, SAID(added_mass), "1", FROM(0, 100), 1, ZERO(no_added_mass),     \
      "mass of the fluid that moves along with a body, of what it displaces")                       \
    R(X, COLUMN, REAL, wave_drag, SAID(wave_drag), "1", FROM(0, 100), 0.5, ZERO(no_wave_drag),      \
      "how soon a floating body comes to rest by the waves that it makes")                          \
    R(X, COLUMN, REAL, flow_x, SAID(flow_x), "m/s", ANY, 0, NO_ZERO,                                \
      "at which a fluid flows along x, against the body that holds it")                             \
    R(X, COLUMN, REAL, flow_y, SAID(flow_y), "m/s", ANY, 0, NO_ZERO, "at which it flows along y")   \
    R(X, COLUMN, REAL, gust, SAID(gust), "1", FROM(0, 10), 0, NO_ZERO,                              \
      "root mean square of how a flow's speed changes, over the speed")                             \
    R(X, COLUMN, REAL, gust_length, SAID(gust_length), "m", ABOVE(0, NO_END), 50, NO_ZERO,          \
      "length of gusts, which pass at the flow's speed")                                            \
    R(X, COLUMN, REAL, shear_height, SAID(shear_height), "m", FROM(0, NO_END), 0, NO_ZERO,          \
      "height above the bottom at which a flow has 63 % of its speed; 0: it is the same everywhere") \
    R(X, COLUMN, REAL, magnus, SAID(magnus), "1", FROM(0, 10), 0, NO_ZERO,                          \
      "lift of what spins in a fluid, of that of a cylinder in an ideal one")                       \
    R(X, COLUMN, REAL, kinetic_friction, SAID(kinetic_friction), "1", FROM(0, 10), 0, NO_ZERO,      \
      "Coulomb coefficient of what slides; 0, and what is above friction: the same as that")        \
    R(X, COLUMN, REAL, shelter, SAID(shelter), "1", FROM(0, 1), 0, NO_ZERO,                         \
      "share of a fluid's flow that what stands in it keeps from what stands right behind")         \
    R(X, COLUMN, REAL, wake, SAID(wake), "1", FROM(0, 10), 0, NO_ZERO,                              \
      "widening of wakes a metre, by which flow recovers behind what shelters; 0: it never does")    \
    R(X, COLUMN, REAL, swirl, SAID(swirl), "m^2/s", ANY, 0, NO_ZERO,                                \
      "circulation of a vortex about the origin of the body that holds the fluid")                  \
    R(X, COLUMN, REAL, outflow, SAID(outflow), "m^2/s", ANY, 0, NO_ZERO,                            \
      "what a source there gives; below 0: a drain")                                                \
    R(X, COLUMN, REAL, core_radius, SAID(core_radius), "m", FROM(1e-3, NO_END), 1, NO_ZERO,           \
      "of a vortex and a source: within it they are weaker")                                        \
    R(X, COLUMN, REAL, jet, SAID(jet), "m/s", ANY, 0, NO_ZERO,                                      \
      "speed of a jet from there along the body's x axis, which widens and slows down")             \
    R(X, COLUMN, REAL, jet_width, SAID(jet_width), "m", FROM(1e-3, NO_END), 1, NO_ZERO,               \
      "of the slot that a jet comes out of")                                                        \
    R(X, COLUMN, REAL, eddies, SAID(eddies), "m/s", FROM(0, NO_END), 0, NO_ZERO,                    \
      "root mean square speed of eddies, which pass with the flow and change")                      \
    R(X, COLUMN, REAL, eddy_length, SAID(eddy_length), "m", FROM(1e-3, NO_END), 10, NO_ZERO,          \
      "size of the largest eddy; the smallest has a sixteenth of it")                               \
    R(X, COLUMN, REAL, refractive_index, SAID(refractive_index), "1", FROM(0, 10), 0, NO_ZERO,      \
      "of light in it, by which it bends at surfaces: glass 1.5, water 1.33; 0: opaque")             \
    R(X, COLUMN, REAL, reflectance, SAID(reflectance), "1", FROM(0, 1), 0, NO_ZERO,                 \
      "share of light that its surface sends back, be it opaque or not: 1 is a mirror")              \
    R(X, COLUMN, REAL, absorption, SAID(absorption), "1/m", FROM(0, 1e9), 0, NO_ZERO,               \
      "of light that goes through it, which falls by e^(-absorption x)")

#define PL_MATERIAL_PAIR_ROWS(R, X)                                                                 \
    R(X, OWN, REAL, friction, SAID(friction), "1", FROM(0, 10), 0, NO_ZERO, "Coulomb coefficient")  \
    R(X, OWN, REAL, restitution, SAID(restitution), "1", FROM(0, PL_RESTITUTION_MOST), 0, NO_ZERO,  \
      "share of the speed that an impact gives back")                                               \
    R(X, OWN, REAL, rolling_resistance, SAID(rolling_resistance), "m", FROM(0, NO_END), 0, NO_ZERO, \
      "lever arm of the torque against rolling, by the normal force")                               \
    R(X, OWN, REAL, adhesion, SAID(adhesion), "N", FROM(0, NO_END), 0, NO_ZERO,                     \
      "force that it takes to part what has touched")                                               \
    R(X, OWN, REAL, kinetic_friction, SAID(kinetic_friction), "1", FROM(0, 10), 0, NO_ZERO,         \
      "Coulomb coefficient once they slide; 0, and what is above friction: the same as that")
// clang-format on

#endif
