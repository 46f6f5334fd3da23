// broad.h - grids of boxes, the list of pairs, the grids that queries search.
#ifndef PL_TABLE_BROAD_H
#define PL_TABLE_BROAD_H

#include "world/tables/pair.h"

typedef struct pl_grid_level {
    double cell, inv_cell; // [m], [1/m]
    uint32_t first, count; // entries [first, first + count)
    uint32_t starts;       // its bucket starts begin here; mask + 2 of them
    uint32_t mask;         // buckets - 1
    uint32_t stride;       // buckets between rows of cells
    int32_t origin_x, origin_y;
    pl_box bounds; // of its boxes: most of a pile does not reach down to the tiles of the ground
    double map_per_x, map_per_y; // [1/m] squares of its map, which begins where the bounds do
} pl_grid_level;

typedef struct pl_grid {
    pl_grid_level *levels; // used ones, finest first; in `level_room`
    uint32_t level_count;
    uint32_t entry_count;
    pl_buffer level_room; // few worlds have sizes of more than three octaves, none of all
    pl_buffer entries;    // pl_grid_entry
    pl_buffer starts;     // uint32_t
    pl_buffer places;     // scratch of the build
    pl_buffer maps;       // uint64_t, PL_GRID_MAP rows a level
    bool mapped;
    pl_buffer sides; // real, of pl_grid_lanes
} pl_grid;

typedef struct pl_broad {
    pl_grid moving, fixed;
    pl_grid resting; // may still name pieces that sleep no more: see PL_PIECE_ASLEEP
    pl_pair_list pairs;
    pl_buffer list;   // uint32_t pieces to file
    pl_buffer found;  // pl_found: pairs of a rebuild as they come
    pl_buffer sorted; // pl_found: scratch of sorting
    pl_buffer sensed; // pl_found: sensor piece and what is near it
    uint32_t sensed_count;
    pl_buffer counts; // uint32_t, or pl_keyed a pair: scratch of sorting
    pl_buffer lost;   // uint32_t places of pairs that are no more
    uint32_t found_count;
    uint32_t serial; // newest piece serial at the last rebuild: younger slots carry nothing over
    uint64_t rebuilds;
    bool stale;     // the pair list must be made from nothing
    bool emptied;   // so many boxes were left that it had better be
    bool unfiled;   // a box was left since the moving grid was filed
    pl_buffer left; // uint32_t moving pieces whose box was made anew since the pair list was made
    pl_buffer left_marks; // uint8_t a piece slot: it is in `left`
    uint32_t left_count;
    bool moving_lost, fixed_lost, resting_lost; // the world was restored: a grid to be filed anew
    bool refreshed; // fat boxes were brought up to date in this step already
} pl_broad;

typedef enum pl_query_grid {
    PL_QUERY_MOVING,
    PL_QUERY_RESTING,
    PL_QUERY_FIXED,
    PL_QUERY_STRAYS, // what came or was moved since the others were brought up to date; these may name it too
    PL_QUERY_GRID_COUNT
} pl_query_grid;

// So many may stray before all is filed anew, at 20 ns a piece of the world: between a query and the next a game makes or moves few.
#define PL_QUERY_STRAYS_MOST 64

typedef struct pl_query_grid_set {
    bool fresh; // nothing but the strays has moved, come or gone since it was brought up to date
    bool strays_filed;
    uint32_t stray_count;
    bool owns
        [PL_QUERY_GRID_COUNT]; // the step's grid does not hold: the queries have one of their own
    pl_buffer grids;           // pl_grid [PL_QUERY_GRID_COUNT], made when the first one is needed
    pl_buffer boxes;           // pl_box a piece slot: tight boxes of what is in grids of its own
    pl_buffer list;            // uint32_t pieces to file
    pl_buffer strays;          // uint32_t [PL_QUERY_STRAYS_MOST] pieces, each once; those that are gone too
} pl_query_grid_set;

#endif
