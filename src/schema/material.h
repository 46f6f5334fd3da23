// material.h - the properties of materials, and of what two materials have between them. See row.h.
#ifndef PL_SCHEMA_MATERIAL_H
#define PL_SCHEMA_MATERIAL_H

#include "plumb/material.h"
#include "schema/row.h"

// clang-format off
#define PL_MATERIAL_ROWS(R, X)                                                                      \
    R(X, COLUMN, REAL, density, SAID(density), "kg/m^2", ABOVE(0, NO_END), 1, NO_ZERO,              \
      "mass of an area of what is made of it")                                                      \
    R(X, COLUMN, REAL, friction, SAID(friction), "1", FROM(0, 10), 0.6, ZERO(frictionless),         \
      "Coulomb coefficient; a pair uses the root of the product")                                   \
    R(X, COLUMN, REAL, restitution, SAID(restitution), "1", FROM(0, 1), 0, NO_ZERO,                 \
      "share of the speed that an impact gives back; a pair uses the larger")                       \
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
      PLUMB_MIX_DEFAULT, NO_ZERO, "how a pair mixes adhesion")

#define PL_MATERIAL_PAIR_ROWS(R, X)                                                                 \
    R(X, OWN, REAL, friction, SAID(friction), "1", FROM(0, 10), 0, NO_ZERO, "Coulomb coefficient")  \
    R(X, OWN, REAL, restitution, SAID(restitution), "1", FROM(0, 1), 0, NO_ZERO,                    \
      "share of the speed that an impact gives back")                                               \
    R(X, OWN, REAL, rolling_resistance, SAID(rolling_resistance), "m", FROM(0, NO_END), 0, NO_ZERO, \
      "lever arm of the torque against rolling, by the normal force")                               \
    R(X, OWN, REAL, adhesion, SAID(adhesion), "N", FROM(0, NO_END), 0, NO_ZERO,                     \
      "force that it takes to part what has touched")
// clang-format on

#endif
