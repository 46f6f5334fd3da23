// waves.h - surfaces with waves as a step has them: modes in the middle of the step, and what bodies feel of them.
#ifndef PL_WAVES_H
#define PL_WAVES_H

#include "effects/fluid.h"
#include "geometry/harmonics.h"

// A surface as a step begins.
typedef struct pl_basin {
    uint32_t piece; // of the volume
    double up;      // 1, or -1: against gravity along y
    double gravity; // [m/s^2]
    double density; // [kg/m^2]
    double added;   // [-] mass that moves along with a body, of what it displaces
    double left,
        level; // [m] its end with the lesser x and its height (times up), from the centre of the volume's body
    double width, depth; // [m]
    bool stands;         // there are waves; else it is still
} pl_basin;

// How a mode swings in half a step.
typedef struct pl_wave_swing {
    double k, omega;     // [rad/m], [rad/s]
    double cosine, sine; // of omega dt / 2
} pl_wave_swing;

// The surface near a body is the line height + slope (x - at) + rate t', with x from the centre of the volume's body, heights from
// the still surface and t' from the middle of the step.
typedef struct pl_tide {
    uint32_t basin, piece;
    double at, height, slope, rate; // [m], [m], [-], [m/s]
    double answer; // [-] of a rise of the body, by how much the surface near it falls at once
    double force
        [3]; // [N], [N m] at the centre: of the pressure of waves on what is immersed, and on what moves along
    double flow[2];    // [m/s] of the water, the mean over what is immersed
    double away[2];    // [m] from the body's centre to that of the volume's body, as the step began
    uint32_t spectrum; // its first; PL_NONE
} pl_tide;

// Of an outline, for a mode: integrals of exp(k z + i k x) and of its mirror image, over 1 + exp(-2 k depth).
typedef struct pl_spectrum {
    pl_complex sum, difference; // [m^2]
    pl_complex
        turn; // [m^2] k times what a turn about the body's centre changes the sum by, a radian
} pl_spectrum;

// Of one length, Re(conj(height) e^(ikx)): what stands has a real height, what runs a complex one.
typedef struct pl_wave_term {
    double k;                // [rad/m]
    pl_complex height, rate; // [m], [m/s]
} pl_wave_term;

// The swell at a time [s].
pl_wave_term pl_swell_term(const pl_basin *basin, const plumb_waves_desc *desc, double time);

// How a volume's surface lies, and whether it has waves.
pl_basin pl_basin_of(const plumb_world *world, const pl_wave_surface *surface);
// Of a standing wave of number k [rad/m].
double pl_wave_tanh(const pl_basin *basin, double k);
double pl_wave_omega(const pl_basin *basin, double k);
// The surface at x [m] from the left end: height, slope, rate.
void pl_waves_sample(const pl_basin *basin, const pl_wave_surface *surface,
                     const plumb_wave_mode *modes, double time, double x, double out[3]);
// The flow of its waves there, z [m] (below 0) under the surface.
void pl_waves_flow(const pl_basin *basin, const pl_wave_surface *surface,
                   const plumb_wave_mode *modes, double time, double x, double z, double out[2]);

void pl_waves_free(pl_memory *memory, pl_waves *waves);

// Whether they move bodies fast enough to keep them awake.
bool pl_waves_are_lively(const plumb_world *world, uint32_t piece);

// Modes in the middle of the step. False when out of memory.
bool pl_waves_open(plumb_world *world, real dt);
// What immersed bodies feel, once immersions have their order. False when out of memory.
bool pl_waves_feel(plumb_world *world);
// The outline of what of a tide's body is below the tide's line where it is now, mode by mode; away: pl_fluid_contour.
typedef struct pl_soundings {
    pl_harmonics here, mirrored;
    double left, power; // exp(-2 k depth) of the first mode, of this one
    bool shallow;       // waves feel the bottom
} pl_soundings;

void pl_tide_sound(const plumb_world *world, const pl_tide *tide, pl_soundings *out,
                   double away[2]);
// Of mode 1, 2, 3, ...
pl_spectrum pl_soundings_next(pl_soundings *soundings);

// Of an immersion in this step: NULL where the surface is still.
static inline const pl_tide *pl_tide_of(const plumb_world *world, uint32_t immersion)
{
    const pl_tide *tides = world->waves.step.tides.data;
    return world->waves.step.tide_count > 0 && tides[immersion].basin != PL_NONE ? &tides[immersion]
                                                                                 : NULL;
}

static inline pl_basin *pl_basins(const plumb_world *world)
{
    return (pl_basin *)world->waves.step.basins.data;
}

#endif
