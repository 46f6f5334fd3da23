/// waves.h - waves on water: the surface of a standing box of it, which bodies stir and are carried by.
///
///     plumb_shape pool = ...; // a sensor, a box of a fluid material, on a static body
///     plumb_waves_create(world, pool, &(plumb_waves_desc){ .modes = 64 });
///     for (;;) {
///         plumb_world_step(world, 1.0f / 60);
///         plumb_wave_sample s = plumb_waves_at(world, pool, 2.5f); // how high the water is at x = 2.5 m
///     }
///
/// Linear waves of an ideal fluid between two walls: the surface is a sum of standing waves, mode n being cos(n pi x / width),
/// each of which swings at omega = sqrt(g k tanh(k depth)) and is turned exactly, whatever the step. What moves in the
/// water, dynamic or kinematic, pushes it aside and makes waves; what floats is lifted by where the surface is, slides
/// down its slopes and drifts with the water. Waves that are steeper than water bears, 0.44 of their length over two pi, break
/// and lose what is too much. The mean level stays where the top of the box is: no body raises it. `wave_drag` of the material does not act on
/// bodies here: waves take that energy. A world without waves does nothing for them.
///
/// The shape must be a convex polygon without rounding, a sensor on a static body, of a fluid material that is not weightless, with a
/// level upper side; gravity must be along y. As soon as that does not hold the surface is still, until it does again. The world must not wrap
/// around. Cost: O(modes) a step, and O(modes corners) a body in it.
#ifndef PLUMB_WAVES_H
#define PLUMB_WAVES_H

#include "plumb/world.h"

PLUMB_BEGIN

/// Most standing waves of a surface.
#define PLUMB_WAVES_MAX_MODES 512

/// {0} is a surface with the defaults.
typedef struct plumb_waves_desc {
    int modes;          ///< 1..512 standing waves; the shortest is 2 width / modes long. 0 means 64
    plumb_real damping; ///< [1/s] 0..1e3 heights fall by e^(-damping t). 0 means 0.1
    bool no_damping;    ///< waves never end
    plumb_real height;  ///< [m] 1e-3..1e6 bodies are looked for so far above the box; higher waves do not lift. 0 means a
                        ///< quarter of the depth
    plumb_real swell;   ///< [m] 0..1e3 amplitude of a swell that runs through for ever, whatever bodies do
    /// [m] 1e-3..1e6 length of that swell; below 0 it runs to lesser x. 0 means half of the width
    plumb_real swell_length;
} plumb_waves_desc;

/// A standing wave: what is added to the surface is height cos(n pi x / width), x from the end with the lesser x.
typedef struct plumb_wave_mode {
    double height; ///< [m]
    double rate;   ///< [m/s] at which the height changes
} plumb_wave_mode;

/// The surface at a place.
typedef struct plumb_wave_sample {
    plumb_real y;      ///< [m] of the surface in the world
    plumb_real height; ///< [m] above the still surface
    plumb_real slope;  ///< [-] of the height along x
    plumb_real rate;   ///< [m/s] at which it rises
} plumb_wave_sample;

/// Gives the surface of a shape waves, flat at first. `desc` may be null (= {0}). Errors: E_NULL, E_HANDLE, E_RANGE, E_NOT_FINITE, E_STATE (it has
/// some; it is no such shape as above; the world wraps around), E_MEMORY, E_LOCKED.
PLUMB_API plumb_result plumb_waves_create(plumb_world *world, plumb_shape shape,
                                          const plumb_waves_desc *desc);
/// Takes them away; so does the end of the shape. Errors: E_NULL, E_HANDLE, E_STATE (it has none), E_LOCKED.
PLUMB_API plumb_result plumb_waves_destroy(plumb_world *world, plumb_shape shape);
/// The settings in force, defaults resolved. Errors: E_NULL, E_HANDLE, E_STATE (it has none).
PLUMB_API plumb_result plumb_waves_settings(const plumb_world *world, plumb_shape shape,
                                            plumb_waves_desc *desc);
/// Changes all settings; of modes that are more now the heights are 0. `desc` may be null (= {0}). Errors: as plumb_waves_create.
PLUMB_API plumb_result plumb_waves_set(plumb_world *world, plumb_shape shape,
                                       const plumb_waves_desc *desc);
/// Sets the first `count` modes, mode 1 first, and flattens the rest: a splash, a wave that was measured. Errors: E_NULL, E_HANDLE, E_STATE (it has
/// none), E_RANGE (more than it has; beyond 1e6 m, m/s), E_NOT_FINITE, E_LOCKED.
PLUMB_API plumb_result plumb_waves_set_modes(plumb_world *world, plumb_shape shape,
                                             const plumb_wave_mode *modes, int count);
/// The modes, and how many. Valid until the next step, or change. Null where there are none.
PLUMB_API const plumb_wave_mode *plumb_waves_modes(const plumb_world *world, plumb_shape shape,
                                                   int *count);
/// The surface at x [m] in the world; flat beyond its ends. {0} of a shape without waves.
PLUMB_API plumb_wave_sample plumb_waves_at(const plumb_world *world, plumb_shape shape,
                                           plumb_real x);
/// [J] kinetic and potential, of a metre across, without the swell; 0 of a shape without waves.
PLUMB_API double plumb_waves_energy(const plumb_world *world, plumb_shape shape);
/// The shapes with waves, in the order in which they got them: fills at most `capacity`, returns how many there are.
PLUMB_API int plumb_world_waves(const plumb_world *world, plumb_shape *shapes, int capacity);

PLUMB_END

#endif
