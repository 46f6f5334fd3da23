// waves.h - surfaces with waves as they are stored, and what a step makes of them.
#ifndef PL_TABLE_WAVES_H
#define PL_TABLE_WAVES_H

#include "core/memory.h"
#include "plumb/waves.h"

typedef struct pl_wave_surface {
    plumb_shape shape;
    plumb_waves_desc desc; // resolved
    uint32_t first;        // of its modes
} pl_wave_surface;

// What a step makes, and forgets.
typedef struct pl_waves_step {
    pl_buffer basins;  // pl_basin a surface
    pl_buffer midway;  // plumb_wave_mode: of the middle of the step
    pl_buffer swings;  // pl_wave_swing a mode
    pl_buffer tides;   // pl_tide an immersion; then those of who only stirs
    pl_buffer spectra; // pl_spectrum: of each tide that has one
    pl_buffer soundings; // pl_soundings: scratch of one tide
    pl_buffer order;   // pl_keyed: tides by pieces
    pl_buffer stirrers; // pl_keyed, as immersions: kinematic bodies in such volumes
    uint32_t tide_count, stirrer_count;
    double dt;
} pl_waves_step;

typedef struct pl_waves {
    pl_buffer items; // pl_wave_surface
    uint32_t count;
    pl_buffer modes; // plumb_wave_mode, surface by surface
    uint32_t mode_count;
    pl_waves_step step;
} pl_waves;

static inline pl_wave_surface *pl_wave_surfaces(const pl_waves *waves)
{
    return (pl_wave_surface *)waves->items.data;
}

static inline plumb_wave_mode *pl_wave_modes(const pl_waves *waves)
{
    return (plumb_wave_mode *)waves->modes.data;
}

#endif
