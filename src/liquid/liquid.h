// liquid.h - the kernels of the liquid, and what the step calls.
#ifndef PL_LIQUID_H
#define PL_LIQUID_H

#include "world/state.h"

#define PL_LIQUID_REACH     3 // cells around particles that tiles cover
#define PL_LIQUID_FULL      4 // particles in a cell at rest
#define PL_LIQUID_MOST_CELL (INT32_C(1) << 29)

#define PL_LIQUID_NONE UINT32_MAX

#define PL_LIQUID_SPEED 1e6 // [m/s] of particles, and of what pushes them, at most
#define PL_LIQUID_SLOPE 1e9 // [1/s] of their gradients

// Within bounds; what is no number is 0. Numbers that float cannot hold come with bodies that fly to infinity.
static inline double pl_liquid_held(double value, double most)
{
    return value > most ? most : value < -most ? -most : value == value ? value : 0;
}

// Of an image: defaults are resolved in it.
bool pl_liquid_desc_is_sound(const plumb_liquid_desc *desc);
bool pl_liquid_particle_is_sound(const plumb_particle *particle);
// Does not write to the scratch: of a copy of the liquid it tells what would be freed (api/memory_rows.c).
void pl_liquid_free(pl_memory *memory, pl_liquid *liquid);
// The arrays of the scratch, not itself.
void pl_liquid_free_arrays(pl_memory *memory, pl_liquid_scratch *scratch);

//---- grid.c --------------------------------------------------------------------------------------

// Tiles round the particles, points sorted by cell, and by their order within one. False when out of memory.
bool pl_liquid_grid_build(pl_memory *memory, pl_liquid_scratch *scratch,
                          const plumb_particle *particles, uint32_t count, double h);
// The cell at (i, j); 0: in no tile.
uint32_t pl_liquid_cell_at(const pl_liquid_grid *grid, int32_t i, int32_t j);
// Cell coordinate of a place, and what is left of it.
int32_t pl_liquid_floor(double cells, near_real *fraction);

//---- solids.c ------------------------------------------------------------------------------------

// Closes faces by the grid's solids, as they are now. False when out of memory.
bool pl_liquid_close_faces(pl_memory *memory, pl_liquid_scratch *scratch);
// Chord of the line x = at with a convex piece of n corners and a radius; false: none. Corners y, x for y = at.
bool pl_liquid_chord(const double *x, const double *y, int n, double radius, double at, double *low,
                     double *high);

//---- transfer.c ----------------------------------------------------------------------------------

void pl_liquid_to_grid(pl_liquid_grid *grid);
// Fills faces that are not known from those beside them, two cells far and more.
void pl_liquid_extrapolate(pl_liquid_grid *grid, near_real *u, near_real *v, int cells);
void pl_liquid_accelerate(pl_liquid_grid *grid, near_real du, near_real dv);
// What flows along faces that solids close goes with them.
void pl_liquid_bound(pl_liquid_grid *grid);
void pl_liquid_from_grid(pl_liquid_grid *grid);
// Between faces, at a point.
void pl_liquid_sample(const pl_liquid_grid *grid, const near_real *u, const near_real *v,
                      const pl_liquid_point *point, near_real *x, near_real *y);
// Viscosity by explicit sweeps; amount: kinematic times the step, in squares of a cell.
void pl_liquid_diffuse(pl_liquid_grid *grid, double amount);

//---- pressure.c, density.c -----------------------------------------------------------------------

// Which cells have liquid, the matrix, its factors. False when out of memory.
bool pl_liquid_plan(pl_memory *memory, pl_liquid_scratch *scratch);
// Makes velocities free of divergence. `push`: [kg] density times the square of a cell's side.
void pl_liquid_project(pl_liquid_grid *grid, double push);
// Solves the system without bodies for what lies in vectors[PL_LIQUID_R]; the answer is in P.
void pl_liquid_solve(pl_liquid_grid *grid, double push, double tolerance);
// Densities at centres of cells.
void pl_liquid_weigh(pl_liquid_grid *grid);
// How far it is [cells] from the centre of the one of two cells that has liquid to the surface between them; 1 where both
// have.
near_real pl_liquid_gap(const pl_liquid_grid *grid, uint32_t a, uint32_t b);
// Displacements [cells] that even the density out, into new_u and new_v.
void pl_liquid_even_out(pl_liquid_grid *grid);

//---- move.c --------------------------------------------------------------------------------------

// Moves points by their velocities times `way` [cells a m/s] and by the displacements, out of solids, and writes them
// to the particles.
void pl_liquid_move(const pl_liquid_grid *grid, double way, plumb_particle *particles);

//---- bodies.c ------------------------------------------------------------------------------------

// Shapes near the liquid as solids, those of bodies that are not static with their motion. False when out of memory.
bool pl_liquid_find_solids(plumb_world *world, real dt);
// Gravity and forces on bodies in dt.
void pl_liquid_pull_bodies(plumb_world *world, real dt);
// Bodies go on by their velocities for dt, and solids with them.
void pl_liquid_place_solids(plumb_world *world, double dt);
// Impulses of the step become forces on bodies. Room was made by pl_liquid_find_solids.
void pl_liquid_push_rows(plumb_world *world, real dt);

//---- step.c --------------------------------------------------------------------------------------

// The step was refused: forces on bodies as before it.
void pl_liquid_undo(plumb_world *world);

#endif
