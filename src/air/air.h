// air.h - the kernels of the air, and what the step calls.
#ifndef PL_AIR_H
#define PL_AIR_H

#include "liquid/liquid.h"
#include "world/state.h"

#define PL_AIR_SPEED 1e4 // [m/s] of air, at most
#define PL_AIR_MOST  1e6 // of smoke, and of heat [K] either way

// Of an image: defaults are resolved in it.
bool pl_air_desc_is_sound(const plumb_air_desc *desc);
bool pl_air_source_is_sound(const plumb_air_source *source);
bool pl_air_cell_is_sound(const plumb_air_cell *cell);
// Does not write to the scratch: of a copy of the air it tells what would be freed (api/memory_rows.c).
void pl_air_free(pl_memory *memory, pl_air *air);

// The box in cells: its lowest, and how many there are.
typedef struct pl_air_extent {
    int32_t low_x, low_y, columns, rows;
} pl_air_extent;

// Of a descriptor with a cell above 0, within the ranges of the API.
pl_air_extent pl_air_extent_of(const plumb_air_desc *desc);

// Place of the cell (i, j) of the box in the columns of the scratch.
static inline size_t pl_air_at(const pl_air_scratch *s, int32_t i, int32_t j)
{
    return (size_t)(j + PL_AIR_GHOSTS) * s->stride + (size_t)(i + PL_AIR_GHOSTS);
}

static inline near_real pl_air_most_of(near_real a, near_real b)
{
    return a > b ? a : b;
}

// Of one column with its ghosts.
static inline size_t pl_air_column_bytes(const pl_air_scratch *s)
{
    return (size_t)s->stride * (size_t)(s->columns_y + 1 + 2 * PL_AIR_GHOSTS) * sizeof(near_real);
}

//---- cells.c -------------------------------------------------------------------------------------

// Room for the columns. False when out of memory.
bool pl_air_make_columns(pl_memory *memory, pl_air_scratch *scratch, pl_air_extent extent);
// From cells to columns, and back.
void pl_air_load(pl_air_scratch *scratch, const plumb_air_cell *cells, double fastest);
void pl_air_store(const pl_air_scratch *scratch, plumb_air_cell *cells);
// Velocities between the columns and the grid of pressures.
void pl_air_to_grid(pl_air_scratch *scratch);
void pl_air_from_grid(pl_air_scratch *scratch);
// Faces that are open by next to nothing are shut: air that a body drives through one would be as fast as it is narrow, and go through
// many of them in a step, which a projection does not see.
void pl_air_shut_slits(pl_air_scratch *scratch);
// Before solids move: `now`, `now_v` get the speed of what closes faces. Behind that, when faces are closed anew: what has been uncovered
// flows at that speed.
void pl_air_keep_speeds(pl_air_scratch *scratch);
void pl_air_uncover(pl_air_scratch *scratch);

//---- sides.c -------------------------------------------------------------------------------------

// Walls at sides that are closed, or flow, as solids of the grid. False when out of memory.
bool pl_air_add_sides(pl_memory *memory, pl_air_scratch *scratch, const plumb_air_desc *desc);
// The tiles of the box, their cells, those at periodic sides joined to one another. False when out of memory.
bool pl_air_make_grid(pl_memory *memory, pl_air_scratch *scratch, const plumb_air_desc *desc);
// Behind pl_liquid_plan: what lies across periodic sides. False when out of memory.
bool pl_air_make_wraps(pl_memory *memory, pl_air_scratch *scratch, const plumb_air_desc *desc);

//---- ghosts.c ------------------------------------------------------------------------------------

typedef struct pl_air_area {
    int32_t columns, lines; // of what there is from (0, 0)
} pl_air_area;

// What lies beyond sides, of values: those at the opposite side; `in`, where air blows in, else the nearest.
typedef struct pl_air_outside {
    bool periodic_x, periodic_y;
    near_real left, right, bottom, top; // where the flux there comes in
    bool gives[4];                      // else the nearest
} pl_air_outside;

// Of a column that has so much.
void pl_air_fill_ghosts(const pl_air_scratch *scratch, near_real *column, pl_air_area area,
                        const pl_air_outside *outside);
pl_air_outside pl_air_outside_of(const plumb_air_desc *desc);
// Nothing is carried in from outside.
pl_air_outside pl_air_outside_of_scalars(const plumb_air_desc *desc);
// What blows in has the velocity that it has outside, what comes in at an open side none: so it is sucked in by half the square
// of its speed, as Bernoulli says, and brings no energy.
pl_air_outside pl_air_outside_of_velocity(const plumb_air_desc *desc, near_real flow);

//---- room.c --------------------------------------------------------------------------------------

// How open faces are, how much room cells have: from the grid. Smoke and heat of cells that solids have left since `room` was found
// come from what is beside them; where a solid is there are none.
void pl_air_find_room(pl_air_scratch *scratch, const plumb_air_desc *desc);
// How fast solids fill cells, as they move in the grid.
void pl_air_find_filled(pl_air_scratch *scratch, const plumb_air_desc *desc);
// Fluxes of the velocities as they are.
void pl_air_find_fluxes(pl_air_scratch *scratch, const plumb_air_desc *desc);

//---- carry.c -------------------------------------------------------------------------------------

// Carries with the fluxes for dt [s]; cells are h [m].
void pl_air_carry_velocities(pl_air_scratch *scratch, const plumb_air_desc *desc, pl_tasks *tasks,
                             double dt, double h);
void pl_air_carry_scalars(pl_air_scratch *scratch, const plumb_air_desc *desc, pl_tasks *tasks,
                          double dt, double h);

//---- sources.c -----------------------------------------------------------------------------------

// Smoke and heat of sources, and what fades, in dt.
void pl_air_feed(const plumb_world *world, pl_air_scratch *scratch, double dt);
// Fans, and heat that rises.
void pl_air_drive(const plumb_world *world, pl_air_scratch *scratch, double dt);

//---- step.c --------------------------------------------------------------------------------------

// The step was refused: forces on bodies as before it.
void pl_air_undo(plumb_world *world);

#endif
