// fracture.h - bodies divided: what the files of it share, and what a step's commands call.
#ifndef PL_API_FRACTURE_H
#define PL_API_FRACTURE_H

#include "world/state.h"

// The plane, divided in cells: the two sides of a line, or Voronoi cells.
typedef struct pl_cells {
    int count;
    bool is_line;   // two cells: cell 0 is the side of n . p <= d
    pl_border line; // in the body's frame
    double x[PLUMB_SHATTER_MAX], y[PLUMB_SHATTER_MAX]; // [m] places of cells, in the body's frame
} pl_cells;

//---- fragments.c ---------------------------------------------------------------------------------

void pl_fracture_free(pl_memory *memory, pl_fracture *fracture);
// What the cells have of the solid pieces of a body, and which of it hangs together. False: out of memory.
bool pl_fragments_make(plumb_world *world, uint32_t row, const pl_cells *cells);
// Whether a piece is divided: not lines and sensors.
bool pl_fragments_have(const plumb_world *world, uint32_t piece);

static inline pl_fragment *pl_fragments(const plumb_world *world)
{
    return (pl_fragment *)world->fracture.fragments.data;
}

static inline pl_fragment_part *pl_fragment_parts(const plumb_world *world)
{
    return (pl_fragment_part *)world->fracture.parts.data;
}

static inline pl_child *pl_children(const plumb_world *world)
{
    return (pl_child *)world->fracture.children.data;
}

//---- divide.c ------------------------------------------------------------------------------------

// Makes bodies of the children of pl_fragments_make, two or more; the body itself becomes the heaviest. E_MEMORY, E_RANGE
// (a mass): nothing has changed.
plumb_result pl_divide(plumb_world *world, const char *function, plumb_body body);

//---- fracture.c ----------------------------------------------------------------------------------

// As plumb_body_shatter of a body that was checked. Returns the result; *count new bodies are children of the fracture.
plumb_result pl_shatter(plumb_world *world, const char *function, plumb_body body,
                        const plumb_shatter_desc *desc, int *count);

//---- breaking.c ----------------------------------------------------------------------------------

// Bodies that broke in the step before shatter, with their events; those of the step before are forgotten. `waits`: that
// alone, as in a step of dt 0, in which nothing changes. E_MEMORY: those
// that are left wait for the next step.
plumb_result pl_breaks_run(plumb_world *world, const char *function, bool waits);

#endif
