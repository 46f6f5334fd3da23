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

// Makes bodies of the children of pl_fragments_make, two or more; the body itself becomes the heaviest. `tells`: with room for
// the event; otherwise events stay where they are. E_MEMORY, E_RANGE (a mass): nothing has changed.
plumb_result pl_divide(plumb_world *world, const char *function, plumb_body body, bool tells);

//---- fracture.c ----------------------------------------------------------------------------------

// Whether some shape of a body has an area.
bool pl_is_divisible(const plumb_world *world, uint32_t row);
// The way of a line as a vector of length 1 to 1.5, which no length of `along` overflows. Returns its length.
double pl_cut_way(plumb_vec2 along, double way[2]);
plumb_result pl_cut_check(const plumb_world *world, const char *function, plumb_vec2 point,
                          plumb_vec2 along);
plumb_result pl_shatter_check(const plumb_world *world, const char *function,
                              const plumb_shatter_desc *desc);
// As plumb_body_cut and plumb_body_shatter of what was checked; *count new bodies are children of the fracture. `tells`: an
// event is to follow.
plumb_result pl_cut(plumb_world *world, const char *function, plumb_body body, plumb_vec2 point,
                    plumb_vec2 along, bool tells, int *count);
plumb_result pl_shatter(plumb_world *world, const char *function, plumb_body body,
                        const plumb_shatter_desc *desc, bool tells, int *count);

//---- merge.c -------------------------------------------------------------------------------------

// As the public functions, told as another.
plumb_result pl_merge(plumb_world *world, const char *function, plumb_body body, plumb_body other,
                      double *lost);
plumb_result pl_scale_check(const plumb_world *world, const char *function, plumb_real factor);
plumb_result pl_scale(plumb_world *world, const char *function, plumb_body body, plumb_real factor);

//---- breaking.c ----------------------------------------------------------------------------------

// Bodies that broke in the step before shatter, with their events. `waits`: not yet, as in a step of dt 0, in which
// nothing changes. E_MEMORY: those that are left wait for the next step.
plumb_result pl_breaks_run(plumb_world *world, const char *function, bool waits);
// Room for one more event, before a body is divided.
bool pl_break_reserve(plumb_world *world);
// Appends the event of a body that has become children of the fracture; these are its parts.
void pl_break_tell(plumb_world *world, plumb_body_break event);

// What a step told is forgotten when the next one begins, or commands are carried out for it.
static inline void pl_breaks_begin(plumb_world *world)
{
    pl_fracture *f = &world->fracture;
    if (f->events_told) {
        f->break_count = f->piece_count = 0;
        f->events_told = false;
    }
}

#endif
