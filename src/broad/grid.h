// grid.h - uniform grids over fat boxes: one level for each octave of sizes, so that a pebble and a
// continent coexist; the world has no bounds.
//
// A piece is filed once, in the cell of its box's lower corner. No box of a level is larger than
// the level's cell, so everything that overlaps a box lies in the cells from one before its lower
// corner to its upper corner. Cells map to buckets row by row: neighbours in x are neighbours in
// memory, and when the level's extent allows it the mapping is one to one; otherwise rows wrap
// around a power of two and entries tell their cell, so that a collision costs a comparison and
// never a wrong answer.
#ifndef PL_GRID_H
#define PL_GRID_H

#include "world/tables/broad.h"
#include "core/tasks.h"

#define PL_GRID_LEVELS 32 // octaves of sizes from 2^-16 m to 2^15 m; beyond: the outermost

typedef struct pl_grid_entry {
    int32_t cell_x, cell_y; // of the lower corner
    uint32_t piece;
    pl_box box;
} pl_grid_entry;

// A map of a level: for each of its rows of squares in which of them a lower corner lies.
#define PL_GRID_MAP 64

// The sides of the entries' boxes, side by side, for what looks at several at a time (box_overlap.h).
typedef struct pl_grid_lanes {
    const real *min_x, *min_y, *max_x,
        *max_y; // of as many as there are entries, and PL_GRID_SPARE more
} pl_grid_lanes;

#define PL_GRID_SPARE 8 // may be read beyond the last one

// A range of cells, both ends included.
typedef struct pl_cell_range {
    int32_t x0, y0, x1, y1;
} pl_cell_range;

// Files `count` pieces by their fat boxes (indexed by piece slot). False when out of memory; the
// grid is then empty. O(count). `tasks`: null outside of a step, as nobody would send the threads to rest.
bool pl_grid_build(pl_memory *memory, pl_tasks *tasks, pl_grid *grid, const uint32_t *pieces,
                   uint32_t count, const pl_box *fat);
// Makes a map of each level, until the grid is built again. Queries ask it first: worth it for a grid that is
// built seldom, for the bounds of ground, walls and rings are mostly void. False when out of memory. O(count).
bool pl_grid_make_maps(pl_memory *memory, pl_grid *grid);
// Makes its lanes, until the grid is built again. False when out of memory. O(count).
bool pl_grid_make_lanes(pl_memory *memory, pl_tasks *tasks, pl_grid *grid);
pl_grid_lanes pl_grid_lanes_of(const pl_grid *grid);
void pl_grid_free(pl_memory *memory, pl_grid *grid);

// Cells of a level in which boxes that overlap `box` can be filed.
pl_cell_range pl_grid_range(const pl_grid_level *level, pl_box box);

// True when going through the range cell by cell costs more than going through all entries.
bool pl_grid_range_is_wide(const pl_grid_level *level, pl_cell_range range);

// Calls visit(context, entry) once for every entry whose box overlaps `box`; stops and returns
// false when visit does. Order: level, row of cells, order of filing; wide ranges in order of
// storage.
typedef bool pl_grid_visit(void *context, const pl_grid_entry *entry);
bool pl_grid_query(const pl_grid *grid, pl_box box, pl_grid_visit *visit, void *context);

static inline bool pl_boxes_overlap(const pl_box *a, const pl_box *b)
{
    return a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_y <= b->max_y &&
           b->min_y <= a->max_y;
}

static inline bool pl_box_contains(const pl_box *outer, const pl_box *inner)
{
    return outer->min_x <= inner->min_x && outer->min_y <= inner->min_y &&
           outer->max_x >= inner->max_x && outer->max_y >= inner->max_y;
}

static inline const pl_grid_entry *pl_grid_entries(const pl_grid *grid)
{
    return (const pl_grid_entry *)grid->entries.data;
}

// Bucket of a cell of a level. Unsigned throughout: cells at both ends of the world are farther apart
// than an int32_t reaches.
static inline uint32_t pl_grid_bucket(const pl_grid_level *level, int32_t x, int32_t y)
{
    return ((uint32_t)x - (uint32_t)level->origin_x +
            ((uint32_t)y - (uint32_t)level->origin_y) * level->stride) &
           level->mask;
}

// A run of entries [begin, end) in storage; a row of cells is one run, or two when it wraps.
typedef struct pl_grid_run {
    uint32_t begin, end;
} pl_grid_run;

// The runs of the cells x0..x1 of row y; x1 - x0 must be below the number of buckets. The caller
// compares the entries' cells. Returns how many runs there are (1 or 2; a second one that is none is empty).
static inline int pl_grid_row(const pl_grid *grid, const pl_grid_level *level, int32_t x0,
                              int32_t x1, int32_t y, pl_grid_run runs[2])
{
    const uint32_t *starts = (const uint32_t *)grid->starts.data + level->starts;
    uint32_t first = pl_grid_bucket(level, x0, y);
    uint32_t last = first + (uint32_t)(x1 - x0);
    if (last <= level->mask) {
        runs[0] = (pl_grid_run){ starts[first], starts[last + 1] };
        runs[1] = (pl_grid_run){ 0, 0 };
        return 1;
    }
    runs[0] = (pl_grid_run){ starts[first], starts[level->mask + 1] };
    runs[1] = (pl_grid_run){ starts[0], starts[last - level->mask] };
    return 2;
}

#endif
