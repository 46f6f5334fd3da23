// air.h - the air as it is stored: velocities, smoke and heat of the cells of a box are its state.
#ifndef PL_TABLE_AIR_H
#define PL_TABLE_AIR_H

#include "plumb/air.h"
#include "world/tables/liquid.h"

#define PL_AIR_GHOSTS 2 // cells round the box that kernels look at

// Columns of the box with its ghosts, line by line: of faces those at a cell's left (u) and lower side (v).
// clang-format off
#define PL_AIR_COLUMNS(X)                                                                             \
    X(u) X(v) X(smoke) X(heat)          /* [m/s], [-], [K] */                                         \
    X(now) X(now_v)                     /* [m/s] velocities before a projection */                    \
    X(flux_u) X(flux_v)                 /* [m/s] open part times what flows through it */             \
    X(open_u) X(open_v)                 /* 0..1 */                                                    \
    X(room)                             /* 0..1 of a cell, and at least what its faces are open */    \
    X(filled)                           /* [m/s] by which moving solids fill a cell */                \
    X(across_x) X(across_y)             /* fluxes of what is being carried */                         \
    X(flow_x) X(flow_y)                 /* what goes through its sides of that */                     \
    X(share)                            /* 1 over its room */                                         \
    X(first) X(second)                  /* what is carried, in the midst of that; first: room before, too */
// clang-format on

// What a step of the air needs besides its state: made when it first flows.
typedef struct pl_air_scratch {
    pl_liquid_scratch liquid; // grid, solids, bodies, matrix: the liquid's kernels
    pl_buffer columns;
    pl_buffer moved;      // plumb_air_cell: as they are after the step
    pl_buffer wraps;      // pl_liquid_wrap
    pl_buffer gains;      // double[3]: of bodies, what a projection gives their velocities
    int32_t low_x, low_y; // cells, from the origin of the world
    int32_t columns_x, columns_y;
    uint32_t stride;
#define PL_AIR_DECLARE(name) near_real *name;
    PL_AIR_COLUMNS(PL_AIR_DECLARE)
#undef PL_AIR_DECLARE
} pl_air_scratch;

typedef struct pl_air {
    pl_buffer settings; // plumb_air_desc: one, or none
    uint32_t settings_count;
    uint32_t cell_count; // (columns + 1) * (rows + 1)
    pl_buffer cells;     // plumb_air_cell
    uint32_t source_count;
    pl_buffer sources; // plumb_air_source
    pl_liquid_supports supports;
    pl_air_scratch *scratch; // NULL: no step has needed it yet
} pl_air;

static inline plumb_air_cell *pl_air_items(const pl_air *air)
{
    return (plumb_air_cell *)air->cells.data;
}

static inline const plumb_air_desc *pl_air_desc(const pl_air *air)
{
    return (const plumb_air_desc *)air->settings.data;
}

static inline const plumb_air_source *pl_air_sources(const pl_air *air)
{
    return (const plumb_air_source *)air->sources.data;
}

#endif
