/// air.h - air that flows: a box of cells, with the scene's shapes as obstacles, that carries smoke and heat.
///
///     plumb_air_create(world, &(plumb_air_desc){ .position = { 0, 2 }, .half = { 2, 2 }, .cell = 0.05f });
///     plumb_air_set_sources(world, &(plumb_air_source){ .radius = 0.1f, .smoke = 4, .heat = 200 }, 1);
///     for (;;) {
///         plumb_world_step(world, 1.0f / 60);
///         plumb_air_sample s = plumb_air_at(world, (plumb_vec2){ 0, 1 });
///     }
///
/// A world has one such box or none. The air in it is incompressible: it goes round solid shapes (sensors let it through,
/// filters do not count), is driven by those that move, and pushes dynamic bodies; what a body gets the air loses. Hot air
/// rises: against the world's gravity, by the share of its temperature that it is warmer (Boussinesq). What is thinner than
/// a cell holds it back as a wall of a cell does; what is smaller is not seen. Air at rest does nothing to what is at rest.
/// The world must not wrap around. Nothing of it is done in a world without it. For a wind that bodies cannot change, which
/// costs next to nothing: a sensor of a fluid material (`plumb/material.h`).
#ifndef PLUMB_AIR_H
#define PLUMB_AIR_H

#include "plumb/world.h"

PLUMB_BEGIN

/// Most cells of a box, and most sources.
#define PLUMB_AIR_MAX         4000000
#define PLUMB_AIR_MAX_SOURCES 1024

/// What a side of the box is.
typedef enum plumb_air_side {
    PLUMB_AIR_OPEN,     ///< still air behind it, without smoke and heat: what flows goes in and out
    PLUMB_AIR_CLOSED,   ///< a wall
    PLUMB_AIR_PERIODIC, ///< what goes out comes in at the opposite side, which must be periodic, too
    PLUMB_AIR_FLOW      ///< air with the velocity `flow` behind it: it blows in, or draws out. Along a side, as a wall
                        ///< that moves: a lid, a belt
} plumb_air_side;

/// {0} is not a box: it needs `half`.
typedef struct plumb_air_desc {
    plumb_vec2 position; ///< [m] of its centre, |x|, |y| <= 1e6
    plumb_vec2 half;     ///< [m] > 0 half of its width and height. Its sides are moved to the nearest multiples of `cell`
    plumb_real cell;     ///< [m] 1e-4..1e4 side of a cell; 0 means a 64th of its longer side
    plumb_real density;  ///< [kg/m^2] 1e-9..1e9 of area; 0 means 1.2
    /// [m^2/s] 0..1e9 kinematic; 0: it slips along walls. Above 0 it clings to them. What a grid can tell apart ends at
    /// 1e6 cell^2 / dt; higher values act as that
    plumb_real viscosity;
    plumb_real temperature;                  ///< [K] 1e-3..1e6 without heat; 0 means 293. Air that is so much warmer is weightless
    plumb_real fading;                       ///< [1/s] 0..1e6 smoke fades by e^(-fading t)
    plumb_real cooling;                      ///< [1/s] 0..1e6 heat is lost by e^(-cooling t)
    plumb_vec2 flow;                         ///< [m/s] |x|, |y| <= 1e4 behind sides that are PLUMB_AIR_FLOW
    plumb_air_side left, right, bottom, top; ///< at the least and the most x, at the least and the most y
} plumb_air_desc;

/// A place where smoke and heat come from, or that blows. {0} is not one: it needs a radius.
typedef struct plumb_air_source {
    plumb_body body;     ///< `position` and `push` are in its frame; null: in the world's
    plumb_vec2 position; ///< [m] |x|, |y| <= 1e6
    plumb_real radius;   ///< [m] > 0, at most 1e6; strongest in its middle, by 1 - (r/radius)^2; at least one cell
    plumb_real smoke;    ///< [1/s] |smoke| <= 1e6 so much more a second; below 0 it is drawn off
    plumb_real heat;     ///< [K/s] |heat| <= 1e6; below 0 it cools
    /// [m/s^2] |x|, |y| <= 1e6: a fan. A dynamic body that carries one near itself is pushed back: a propeller
    plumb_vec2 push;
} plumb_air_source;

/// A cell, or face: of those at the right and upper sides of the box only the velocity through them counts.
typedef struct plumb_air_cell {
    plumb_real u;     ///< [m/s] to the right, in the middle of its left side
    plumb_real v;     ///< [m/s] upwards (to larger y), in the middle of its side at the lesser y
    plumb_real smoke; ///< 0 or more: an amount for the eye. It weighs nothing
    plumb_real heat;  ///< [K] warmer than `temperature`
    /// 0..1 so much of it is no solid, as far as the last step saw it. A cell that has none has neither smoke nor heat but
    /// what is set; once its solid has gone, those of what is beside it.
    plumb_real room;
} plumb_air_cell;

/// The box as it is.
typedef struct plumb_air_box {
    plumb_vec2 low, high;     ///< [m] its corners: multiples of `cell`
    plumb_real cell;          ///< [m]
    int columns, rows;        ///< cells
    const plumb_air_cell *at; ///< (columns + 1) a row, rows + 1 of them. Valid until the next step, or change
} plumb_air_box;

/// What there is at a place.
typedef struct plumb_air_sample {
    plumb_vec2 velocity; ///< [m/s]
    plumb_real smoke;
    plumb_real heat; ///< [K]
} plumb_air_sample;

/// What there is in all of the box.
typedef struct plumb_air_sums {
    double smoke;                  ///< [m^2] of smoke 1, in as much of cells as is no solid
    double heat;                   ///< [K m^2]
    double momentum_x, momentum_y; ///< [kg m/s]
    double energy;                 ///< [J] kinetic
} plumb_air_sums;

/// Gives the world a box of air at rest. Errors: E_NULL, E_RANGE (also: more than PLUMB_AIR_MAX cells; a side that is
/// periodic and its opposite not), E_NOT_FINITE, E_STATE (it has one; the world wraps around), E_MEMORY, E_LOCKED.
PLUMB_API plumb_result plumb_air_create(plumb_world *world, const plumb_air_desc *desc);
/// Takes it away, with its sources. Errors: E_NULL, E_STATE (there is none), E_LOCKED.
PLUMB_API plumb_result plumb_air_destroy(plumb_world *world);

/// The settings in force, defaults resolved. Errors: E_NULL, E_STATE (there is no air).
PLUMB_API plumb_result plumb_air_settings(const plumb_world *world, plumb_air_desc *desc);
/// Changes all but `position`, `half` and `cell`, which must be what they are, from the next step on. Errors: as
/// plumb_air_create; E_STATE also for another box.
PLUMB_API plumb_result plumb_air_set(plumb_world *world, const plumb_air_desc *desc);

/// All sources, instead of those before (null and 0: none). Errors: E_NULL, E_STATE (there is no air), E_RANGE,
/// E_NOT_FINITE, E_HANDLE (body), E_MEMORY, E_LOCKED; then they are those before. A source whose body is gone, or disabled,
/// does nothing.
PLUMB_API plumb_result plumb_air_set_sources(plumb_world *world, const plumb_air_source *sources,
                                             int count);
/// The sources, and how many (`count` may be null). Valid until they are changed. Null without any.
PLUMB_API const plumb_air_source *plumb_air_sources(const plumb_world *world, int *count);

/// What to fill a place with: `sample` has what is there.
typedef void plumb_air_fill_fn(void *context, plumb_vec2 at, plumb_air_sample *sample);
/// Sets all of the box: velocities in the middle of faces, smoke and heat in that of cells. What is not finite, or beyond
/// 1e4 m/s, 1e6, 1e6 K, becomes the nearest that is not (0 of no number); the next step makes velocities free of divergence.
/// Errors: E_NULL, E_STATE (there is no air), E_LOCKED.
PLUMB_API plumb_result plumb_air_fill(plumb_world *world, plumb_air_fill_fn *fill, void *context);

/// Sets all cells of the box as plumb_air_cells has them. If `room` is 0 in all of them, it becomes 1. Errors: E_NULL, E_STATE
/// (there is no air), E_RANGE (not as many as there are; a number beyond what it may be), E_NOT_FINITE, E_LOCKED; then
/// they are as before.
PLUMB_API plumb_result plumb_air_set_cells(plumb_world *world, const plumb_air_cell *cells,
                                           int count);
/// The box with its cells. Errors: E_NULL, E_STATE (there is no air).
PLUMB_API plumb_result plumb_air_cells(const plumb_world *world, plumb_air_box *box);
/// Between cells, at a place [m]; nothing outside of the box, or without air.
PLUMB_API plumb_air_sample plumb_air_at(const plumb_world *world, plumb_vec2 position);
/// What there is in all: O(cells). Errors: E_NULL, E_STATE (there is no air).
PLUMB_API plumb_result plumb_air_sum(const plumb_world *world, plumb_air_sums *sums);

PLUMB_END

#endif
