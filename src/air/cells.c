// cells.c - the state of the air as columns, with ghosts round them, and its velocities on the grid of pressures.
//
// Reads, writes: cells, columns, faces of the grid. Cost: O(cells).
#include "air/air.h"

#include <math.h>
#include <string.h>

#define SIDE PL_LIQUID_SIDE

pl_air_extent pl_air_extent_of(const plumb_air_desc *d)
{
    const double cell = (double)d->cell;
    const double low_x = floor(((double)d->position.x - (double)d->half.x) / cell + 0.5);
    const double low_y = floor(((double)d->position.y - (double)d->half.y) / cell + 0.5);
    const double high_x = floor(((double)d->position.x + (double)d->half.x) / cell + 0.5);
    const double high_y = floor(((double)d->position.y + (double)d->half.y) / cell + 0.5);
    const double columns = high_x - low_x, rows = high_y - low_y;
    return (pl_air_extent){ (int32_t)low_x, (int32_t)low_y, columns > 1 ? (int32_t)columns : 1,
                            rows > 1 ? (int32_t)rows : 1 };
}

void pl_air_free(pl_memory *memory, pl_air *air)
{
    if (air->scratch != NULL) {
        pl_air_scratch copy = *air->scratch;
        pl_buffer *all[] = { &copy.columns, &copy.moved, &copy.wraps, &copy.gains };
        pl_liquid_free_arrays(memory, &copy.liquid);
        for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) {
            pl_buffer_free(memory, all[i]);
        }
        pl_resize(memory, air->scratch, sizeof *air->scratch, 0);
    }
    pl_buffer_free(memory, &air->settings);
    pl_buffer_free(memory, &air->cells);
    pl_buffer_free(memory, &air->sources);
    pl_buffer_free(memory, &air->supports.items);
    *air = (pl_air){ .cell_count = 0 };
}

bool pl_air_make_columns(pl_memory *memory, pl_air_scratch *s, pl_air_extent extent)
{
    s->low_x = extent.low_x;
    s->low_y = extent.low_y;
    s->columns_x = extent.columns;
    s->columns_y = extent.rows;
    s->stride = (uint32_t)extent.columns + 1 + 2 * PL_AIR_GHOSTS;
    const size_t lines = (size_t)extent.rows + 1 + 2 * PL_AIR_GHOSTS;
    const size_t room =
        (lines * s->stride * sizeof(near_real) + PL_ALIGN - 1) / PL_ALIGN * PL_ALIGN;
    size_t count = 0;
#define COUNT(name) ++count;
    PL_AIR_COLUMNS(COUNT)
    if (!pl_buffer_reserve(memory, &s->columns, count * room)) {
        return false;
    }
    memset(s->columns.data, 0, count * room);
    char *at = s->columns.data;
#define CARVE(name)                                                                                \
    s->name = (near_real *)(void *)at;                                                             \
    at += room;
    PL_AIR_COLUMNS(CARVE)
    return true;
}

// Steps leave nothing in a cell without room: what is there has been set, and stays if the solid has gone.
static near_real room_before(const plumb_air_cell *cell)
{
    return cell->smoke != 0 || cell->heat != 0 ? 1 : (near_real)cell->room;
}

void pl_air_load(pl_air_scratch *s, const plumb_air_cell *cells, double fastest)
{
    for (int32_t j = 0; j <= s->columns_y; ++j) {
        const size_t line = pl_air_at(s, 0, j);
        for (int32_t i = 0; i <= s->columns_x; ++i, ++cells) {
            const size_t k = line + (size_t)i;
            s->u[k] = (near_real)pl_liquid_held((double)cells->u, fastest);
            s->v[k] = (near_real)pl_liquid_held((double)cells->v, fastest);
            s->smoke[k] = (near_real)cells->smoke;
            s->heat[k] = (near_real)cells->heat;
            s->room[k] = i < s->columns_x && j < s->columns_y ? room_before(cells) : 0;
        }
    }
}

void pl_air_store(const pl_air_scratch *s, plumb_air_cell *cells)
{
    for (int32_t j = 0; j <= s->columns_y; ++j) {
        const size_t line = pl_air_at(s, 0, j);
        for (int32_t i = 0; i <= s->columns_x; ++i, ++cells) {
            const size_t k = line + (size_t)i;
            const bool has_u = j < s->columns_y, has_v = i < s->columns_x;
            const bool is_cell = has_u && has_v && s->room[k] > 0;
            const double smoke = is_cell ? (double)s->smoke[k] : 0;
            const double heat = is_cell ? (double)s->heat[k] : 0;
            cells->u = has_u ? (real)pl_liquid_held((double)s->u[k], PL_AIR_SPEED) : 0;
            cells->v = has_v ? (real)pl_liquid_held((double)s->v[k], PL_AIR_SPEED) : 0;
            cells->smoke = (real)pl_liquid_held(smoke > 0 ? smoke : 0, PL_AIR_MOST);
            cells->heat = (real)pl_liquid_held(heat, PL_AIR_MOST);
            cells->room = has_u && has_v ? (real)s->room[k] : 0;
        }
    }
}

// What of a line of a tile lies in the box with its right and upper faces: cells of the grid from `cell`, of the columns from
// `place`.
typedef struct run {
    uint32_t cell, count;
    size_t place;
} run;

static run run_of(const pl_air_scratch *s, const pl_liquid_tile *tile, uint32_t t, int32_t line)
{
    const int32_t x = tile->x * SIDE - s->low_x, y = tile->y * SIDE - s->low_y + line;
    const int32_t from = x > 0 ? x : 0, most = s->columns_x + 1;
    const int32_t end = x + SIDE < most ? x + SIDE : most;
    if (y < 0 || y > s->columns_y || from >= end) {
        return (run){ 0, 0, 0 };
    }
    return (run){ 1 + t * PL_LIQUID_TILE + (uint32_t)(line * SIDE + from - x),
                  (uint32_t)(end - from), pl_air_at(s, from, y) };
}

void pl_air_to_grid(pl_air_scratch *s)
{
    pl_liquid_grid *g = &s->liquid.grid;
    for (uint32_t t = 0; t < g->tile_count; ++t) {
        for (int32_t line = 0; line < SIDE; ++line) {
            const run r = run_of(s, &g->tiles[t], t, line);
            for (uint32_t k = 0; k < r.count; ++k) {
                g->u[r.cell + k] = s->u[r.place + k];
                g->v[r.cell + k] = s->v[r.place + k];
            }
        }
    }
}

// Faces at the right and upper sides of periodic boxes are those at the other sides.
static void take_last_faces(pl_air_scratch *s, const pl_liquid_grid *g)
{
    for (int32_t j = 0; j < s->columns_y; ++j) {
        const uint32_t c = pl_liquid_cell_at(g, s->low_x + s->columns_x - 1, s->low_y + j);
        s->u[pl_air_at(s, s->columns_x, j)] = g->u[g->right[c]];
    }
    for (int32_t i = 0; i < s->columns_x; ++i) {
        const uint32_t c = pl_liquid_cell_at(g, s->low_x + i, s->low_y + s->columns_y - 1);
        s->v[pl_air_at(s, i, s->columns_y)] = g->v[g->up[c]];
    }
}

void pl_air_from_grid(pl_air_scratch *s)
{
    const pl_liquid_grid *g = &s->liquid.grid;
    for (uint32_t t = 0; t < g->tile_count; ++t) {
        for (int32_t line = 0; line < SIDE; ++line) {
            const run r = run_of(s, &g->tiles[t], t, line);
            for (uint32_t k = 0; k < r.count; ++k) {
                s->u[r.place + k] = g->u[r.cell + k];
                s->v[r.place + k] = g->v[r.cell + k];
            }
        }
    }
    take_last_faces(s, g);
}

//---- slits ---------------------------------------------------------------------------------------

#define SLIT ((near_real)0.1) // of a face: what is open of one that is open by less is shut

static bool is_slit(near_real open)
{
    return open > 0 && open < SLIT;
}

static near_real open_of(const pl_liquid_grid *g, uint32_t cell, bool upright)
{
    return upright ? g->open_v[cell] : g->open_u[cell];
}

static void shut(near_real *open, near_real *speed)
{
    if (is_slit(*open)) {
        *speed /= 1 - *open;
        *open = 0;
    }
}

void pl_air_shut_slits(pl_air_scratch *s)
{
    pl_liquid_grid *g = &s->liquid.grid;
    for (uint32_t i = 0; i < g->link_count; ++i) {
        pl_liquid_link *link = &g->links[i];
        const near_real open = open_of(g, link->cell, link->upright);
        link->part /= is_slit(open) ? 1 - open : 1;
    }
    for (uint32_t i = 0; i < g->soft_link_count; ++i) {
        pl_liquid_soft_link *link = &g->soft_links[i];
        const near_real open = open_of(g, link->cell, link->upright);
        link->part /= is_slit(open) ? 1 - open : 1;
    }
    for (uint32_t c = 0; c < g->cell_count; ++c) {
        shut(&g->open_u[c], &g->solid_u[c]);
        shut(&g->open_v[c], &g->solid_v[c]);
    }
}

//---- what moving solids uncover ------------------------------------------------------------------

static near_real speed_of(near_real sum, near_real open)
{
    return open < 1 ? sum / (1 - open) : 0;
}

void pl_air_keep_speeds(pl_air_scratch *s)
{
    const pl_liquid_grid *g = &s->liquid.grid;
    for (int32_t j = 0; j <= s->columns_y; ++j) {
        for (int32_t i = 0; i <= s->columns_x; ++i) {
            const uint32_t c = pl_liquid_cell_at(g, s->low_x + i, s->low_y + j);
            const size_t k = pl_air_at(s, i, j);
            s->now[k] = speed_of(g->solid_u[c], s->open_u[k]);
            s->now_v[k] = speed_of(g->solid_v[c], s->open_v[k]);
        }
    }
}

static near_real mix(near_real open, near_real before, near_real flow, near_real speed)
{
    return open > before ? (before * flow + (open - before) * speed) / open : flow;
}

void pl_air_uncover(pl_air_scratch *s)
{
    const pl_liquid_grid *g = &s->liquid.grid;
    for (int32_t j = 0; j <= s->columns_y; ++j) {
        for (int32_t i = 0; i <= s->columns_x; ++i) {
            const uint32_t c = pl_liquid_cell_at(g, s->low_x + i, s->low_y + j);
            const size_t k = pl_air_at(s, i, j);
            if (j < s->columns_y) {
                s->u[k] = mix(g->open_u[c], s->open_u[k], s->u[k], s->now[k]);
            }
            if (i < s->columns_x) {
                s->v[k] = mix(g->open_v[c], s->open_v[k], s->v[k], s->now_v[k]);
            }
        }
    }
}
