/// material.h - what shapes are made of. A material is an entity shared by any number of shapes;
/// the null handle is the world's default material (friction 0.6, restitution 0, density 1).
#ifndef PLUMB_MATERIAL_H
#define PLUMB_MATERIAL_H

#include "plumb/world.h"

PLUMB_BEGIN

/// {0} is valid: no friction, no restitution, density 1.
typedef struct plumb_material_desc {
    plumb_real density;     ///< [kg/m^2] > 0; 0 means 1
    plumb_real friction;    ///< [-] Coulomb coefficient, 0..10. A pair uses sqrt(a b)
    plumb_real restitution; ///< [-] 0..1. A pair uses max(a, b); 1 conserves energy
} plumb_material_desc;

/// Makes a material. Null handle on error (see plumb_world_error): E_NULL, E_RANGE, E_NOT_FINITE,
/// E_MEMORY, E_LOCKED.
PLUMB_API plumb_material plumb_material_create(plumb_world *world, const plumb_material_desc *desc);

/// Destroys a material. Errors: E_HANDLE (also for the default one), E_STATE (still used by a shape).
PLUMB_API plumb_result plumb_material_destroy(plumb_world *world, plumb_material material);

/// Reads a material; null reads the default one. Errors: E_HANDLE, E_NULL.
PLUMB_API plumb_result plumb_material_get(const plumb_world *world, plumb_material material,
                                          plumb_material_desc *desc);

/// Changes a material; null changes the default one. Friction and restitution hold from the next
/// step; masses computed from the density are not revised (see plumb_body_reset_mass).
/// Errors: E_HANDLE, E_NULL, E_RANGE, E_NOT_FINITE.
PLUMB_API plumb_result plumb_material_set(plumb_world *world, plumb_material material,
                                          const plumb_material_desc *desc);

PLUMB_END

#endif
