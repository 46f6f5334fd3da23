// viscous.h - the system of viscosity and of grains that rub: what viscosity.c, dragged.c and yield.c share.
#ifndef PL_LIQUID_VISCOUS_H
#define PL_LIQUID_VISCOUS_H

#include "liquid/liquid.h"

// Columns of faces, 0 where nothing flows.
typedef struct pl_viscous_faces {
    near_real *u, *v;
} pl_viscous_faces;

// A body's part of the vectors; those of faces and of bodies have one mass, density h^2.
typedef struct pl_viscous_body {
    double mass[3];     // over density h^2; 0: this axis does not move
    double diagonal[3]; // likewise
    double now[3], left[3], way[3], out[3];
} pl_viscous_body;

typedef struct pl_viscous {
    pl_liquid_grid *g;
    const pl_liquid_grains *grains; // or null
    near_real k, elastic;           // elastic: share of grains in that
    // The velocities, those of solids where these shut faces.
    pl_viscous_faces speed;
    // 1: unknown.
    pl_viscous_faces is_free;
    // How much of a face solids close that it goes with; 0: none does.
    pl_viscous_faces shut;
    pl_viscous_faces mass;
    // 2: the slope to the face below ends at a wall, half a cell away; 0: one of them is air's.
    pl_viscous_faces twice;
    // What is left; where conjugate gradients go; the matrix times that.
    pl_viscous_faces left, way, out;
    pl_viscous_faces diagonal;
    near_real *thick;        // viscosity of a cell over k, without grains
    near_real *weight;       // of a cell, with them
    near_real *corner;       // of the one at its lower left
    near_real *xx, *yy, *xy; // stresses over k; xy at that corner
    uint32_t *cells;         // in which something is not 0
    uint32_t count;
    pl_viscous_body *bodies; // NULL: all are driven
    double enough;           // of what is left, once known
} pl_viscous;

//---- viscosity.c ---------------------------------------------------------------------------------

// Of velocities there are; amount: see pl_liquid_diffuse. False when out of memory.
bool pl_viscous_begin(pl_memory *memory, pl_liquid_scratch *scratch, double amount, pl_viscous *s);

// The slope of velocities at the corner at a cell's lower left.
static inline near_real pl_viscous_slope(const pl_viscous *s, const pl_viscous_faces *of,
                                         uint32_t c)
{
    return s->twice.u[c] * (of->u[c] - of->u[s->g->down[c]]) +
           s->twice.v[c] * (of->v[c] - of->v[s->g->left[c]]);
}

// What stresses do to a face.
static inline near_real pl_viscous_pull_u(const pl_viscous *s, uint32_t c)
{
    const uint32_t up = s->g->up[c];
    return s->xx[c] - s->xx[s->g->left[c]] + s->twice.u[up] * s->xy[up] - s->twice.u[c] * s->xy[c];
}

static inline near_real pl_viscous_pull_v(const pl_viscous *s, uint32_t c)
{
    const uint32_t right = s->g->right[c];
    return s->yy[c] - s->yy[s->g->down[c]] + s->twice.v[right] * s->xy[right] -
           s->twice.v[c] * s->xy[c];
}

//---- dragged.c -----------------------------------------------------------------------------------

// Adds to `shut` what bodies close of faces, by their whole areas.
void pl_viscous_add_closed(pl_viscous *s);
void pl_viscous_find_bodies(pl_viscous *s);
void pl_viscous_find_body_diagonal(pl_viscous *s);
// Faces that bodies close go as these do: of a part of the vectors.
void pl_viscous_carry(pl_viscous *s, const pl_viscous_faces *way);
// out: what stresses of the last product do to bodies; with their mass times the way, if inert.
void pl_viscous_drag(pl_viscous *s, bool inert);
// What is left of bodies at the velocities there are, by stresses there.
void pl_viscous_find_body_left(pl_viscous *s);
// left . left over the diagonal; of bend way . out.
double pl_viscous_dot_bodies(const pl_viscous *s, bool bend);
// now += alpha way, left -= alpha out
void pl_viscous_go_bodies(pl_viscous *s, double alpha);
// way = beta way + left over the diagonal
void pl_viscous_turn_bodies(pl_viscous *s, double beta);
// Bodies have what they got.
void pl_viscous_keep_bodies(pl_viscous *s);
// Stresses that are found push bodies.
void pl_viscous_push_bodies(pl_viscous *s);

//---- yield.c -------------------------------------------------------------------------------------

// By pressures, and the velocities that particles had.
void pl_viscous_guess_yield(const pl_liquid_grid *g);
// By the velocities there are. The answer is how much of the stress of any cell has changed.
double pl_viscous_find_yield(pl_viscous *s);
// Adds to stresses what grains bear; `yields`: only what has yielded of that, which is less than 0.
void pl_viscous_add_shear(pl_viscous *s, bool yields);

#endif
