// sides.c - the box of the air on the grid of pressures: walls at its sides, periodic ones.
//
// A side that is closed, or flows, is a solid beside the box that stands still or is driven: faces close as those of all
// solids do (liquid/solids.c). An open side has nothing behind it: pressure is 0 at its faces. Cells at periodic sides are
// joined to one another; what the matrix has across them is a list besides, as its lines end at sides.
//
// Reads: settings, faces. Writes: solids, tiles, cells, wraps. Cost: O(cells).
#include "air/air.h"

#include <string.h>

#define SIDE  PL_LIQUID_SIDE
#define DEPTH 24 // [cells] of walls: more than a tile

//---- walls ---------------------------------------------------------------------------------------

static void put_wall(pl_liquid_grid *g, uint32_t body, double x0, double y0, double x1, double y1)
{
    pl_liquid_solid *s = &g->solids[g->solid_count++];
    memset(s, 0, sizeof *s);
    s->piece = PL_LIQUID_NONE;
    s->body = body;
    s->count = 4;
    s->exits = UINT32_MAX;
    s->x[0] = s->x[3] = s->low_x = x0;
    s->x[1] = s->x[2] = s->high_x = x1;
    s->y[0] = s->y[1] = s->low_y = y0;
    s->y[2] = s->y[3] = s->high_y = y1;
}

bool pl_air_add_sides(pl_memory *memory, pl_air_scratch *s, const plumb_air_desc *d)
{
    pl_liquid_grid *g = &s->liquid.grid;
    const plumb_air_side sides[4] = { d->left, d->right, d->bottom, d->top };
    const double x0 = s->low_x, y0 = s->low_y, x1 = x0 + s->columns_x, y1 = y0 + s->columns_y;
    const double low_x = x0 - DEPTH, low_y = y0 - DEPTH, high_x = x1 + DEPTH, high_y = y1 + DEPTH;
    const double walls[4][4] = { { low_x, low_y, x0, high_y },
                                 { x1, low_y, high_x, high_y },
                                 { low_x, low_y, high_x, y0 },
                                 { low_x, y1, high_x, high_y } };
    if (!pl_buffer_reserve(memory, &s->liquid.solids, 4 * sizeof(pl_liquid_solid)) ||
        !pl_buffer_reserve(memory, &s->liquid.bodies, sizeof(pl_liquid_body)) ||
        !pl_buffer_reserve(memory, &s->liquid.pushes, sizeof(pl_liquid_push))) {
        return false;
    }
    g->solids = s->liquid.solids.data;
    g->bodies = s->liquid.bodies.data;
    g->solid_count = 0;
    g->body_count = 1; // who drives sides that flow
    g->bodies[0] = (pl_liquid_body){ .vx = (double)d->flow.x, .vy = (double)d->flow.y, .c = 1 };
    // Still walls first: corners are theirs.
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < 4; ++k) {
            if (sides[k] == (pass == 0 ? PLUMB_AIR_CLOSED : PLUMB_AIR_FLOW)) {
                const double *w = walls[k];
                put_wall(g, pass == 0 ? PL_LIQUID_NONE : 0, w[0], w[1], w[2], w[3]);
            }
        }
    }
    return true;
}

//---- cells ---------------------------------------------------------------------------------------

static bool is_inside(const pl_air_scratch *s, int32_t i, int32_t j)
{
    return i >= 0 && j >= 0 && i < s->columns_x && j < s->columns_y;
}

// As if each cell of the box had one particle in it. Beyond its sides air is thin, so that pressure is 0 half way.
static void fill_cells(pl_air_scratch *s)
{
    pl_liquid_grid *g = &s->liquid.grid;
    uint32_t count = 0;
    for (uint32_t t = 0; t < g->tile_count; ++t) {
        const int32_t x = g->tiles[t].x * SIDE - s->low_x, y = g->tiles[t].y * SIDE - s->low_y;
        for (uint32_t k = 0; k < PL_LIQUID_TILE; ++k) {
            const uint32_t c = 1 + t * PL_LIQUID_TILE + k;
            const bool inside = is_inside(s, x + (int32_t)(k % SIDE), y + (int32_t)(k / SIDE));
            g->first[c] = count;
            count += inside;
            g->density[c] = inside;
            g->solid[c] = 0;
            g->u[c] = g->v[c] = 0;
            g->known_u[c] = g->known_v[c] = 0;
        }
    }
    g->first[g->cell_count] = count;
}

static void join_columns(const pl_air_scratch *s, pl_liquid_grid *g)
{
    const int32_t first = s->low_x, last = s->low_x + s->columns_x - 1;
    for (int32_t j = s->low_y - 1; j <= s->low_y + s->columns_y; ++j) {
        const uint32_t a = pl_liquid_cell_at(g, first, j), b = pl_liquid_cell_at(g, last, j);
        g->left[a] = b;
        g->right[b] = a;
    }
}

static void join_rows(const pl_air_scratch *s, pl_liquid_grid *g)
{
    const int32_t first = s->low_y, last = s->low_y + s->columns_y - 1;
    for (int32_t i = s->low_x - 1; i <= s->low_x + s->columns_x; ++i) {
        const uint32_t a = pl_liquid_cell_at(g, i, first), b = pl_liquid_cell_at(g, i, last);
        g->down[a] = b;
        g->up[b] = a;
    }
}

bool pl_air_make_grid(pl_memory *memory, pl_air_scratch *s, const plumb_air_desc *d)
{
    pl_liquid_grid *g = &s->liquid.grid;
    // A cell more on each side: walls are there, and the faces at the right and upper sides.
    const int32_t x0 = pl_liquid_tile_of(s->low_x - 1), y0 = pl_liquid_tile_of(s->low_y - 1);
    const int32_t x1 = pl_liquid_tile_of(s->low_x + s->columns_x);
    const int32_t y1 = pl_liquid_tile_of(s->low_y + s->columns_y);
    if (!pl_liquid_clear_tiles(memory, &s->liquid)) {
        return false;
    }
    for (int32_t y = y0; y <= y1; ++y) {
        for (int32_t x = x0; x <= x1; ++x) {
            if (!pl_liquid_add_tile(memory, &s->liquid, x, y)) {
                return false;
            }
        }
    }
    if (!pl_liquid_sort_tiles(memory, &s->liquid) || !pl_liquid_make_cells(memory, &s->liquid)) {
        return false;
    }
    fill_cells(s);
    if (d->left == PLUMB_AIR_PERIODIC) {
        join_columns(s, g);
    }
    if (d->bottom == PLUMB_AIR_PERIODIC) {
        join_rows(s, g);
    }
    return true;
}

//---- wraps ---------------------------------------------------------------------------------------

static void add_wrap(pl_liquid_grid *g, uint32_t cell, uint32_t other, near_real open)
{
    if (g->row[cell] != 0 && g->row[other] != 0 && open > 0) {
        g->wraps[g->wrap_count++] = (pl_liquid_wrap){ g->row[cell], g->row[other], open };
    }
}

bool pl_air_make_wraps(pl_memory *memory, pl_air_scratch *s, const plumb_air_desc *d)
{
    pl_liquid_grid *g = &s->liquid.grid;
    const size_t most = (size_t)s->columns_x + (size_t)s->columns_y;
    g->wrap_count = 0;
    if (d->left != PLUMB_AIR_PERIODIC && d->bottom != PLUMB_AIR_PERIODIC) {
        return true;
    }
    if (!pl_buffer_reserve(memory, &s->wraps, most * sizeof(pl_liquid_wrap))) {
        return false;
    }
    g->wraps = s->wraps.data;
    for (int32_t j = 0; j < s->columns_y && d->left == PLUMB_AIR_PERIODIC; ++j) {
        const uint32_t c = pl_liquid_cell_at(g, s->low_x, s->low_y + j);
        add_wrap(g, c, g->left[c], g->open_u[c]);
    }
    for (int32_t i = 0; i < s->columns_x && d->bottom == PLUMB_AIR_PERIODIC; ++i) {
        const uint32_t c = pl_liquid_cell_at(g, s->low_x + i, s->low_y);
        add_wrap(g, c, g->down[c], g->open_v[c]);
    }
    return true;
}
