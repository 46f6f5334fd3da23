// room.c - how open faces are, how much room cells have, what flows through faces, and what fills cells that solids have left.
//
// A cell that solids cut has the room that is left, and at least as much as its faces are open, or it would be emptied
// in no time.
//
// Reads: grid, velocities. Writes: openness, room, fluxes; smoke and heat of cells whose solids have come or gone. Cost: O(cells).
#include "air/air.h"

#include <string.h>

// In place of room before: filled in this round, in which none may see it.
#define FILLED ((near_real)-1)

// Of what is beside it, weighed by the faces between.
typedef struct beside {
    near_real open, smoke, heat;
} beside;

static void add_to(beside *sum, const pl_air_scratch *s, size_t from, near_real open)
{
    if (s->first[from] > 0) {
        sum->open += open;
        sum->smoke += open * s->smoke[from];
        sum->heat += open * s->heat[from];
    }
}

// Fills cells that solids have left where they lie beside others. How many are left over; `any`: whether one was filled.
static uint32_t fill_ring(pl_air_scratch *s, bool *any)
{
    const size_t way = s->stride;
    uint32_t left = 0;
    *any = false;
    for (int32_t j = 0; j < s->columns_y; ++j) {
        for (int32_t i = 0; i < s->columns_x; ++i) {
            const size_t k = pl_air_at(s, i, j);
            if (s->room[k] == 0 || s->first[k] != 0) {
                continue;
            }
            beside sum = { 0, 0, 0 };
            add_to(&sum, s, k - 1, s->open_u[k]);
            add_to(&sum, s, k + 1, s->open_u[k + 1]);
            add_to(&sum, s, k - way, s->open_v[k]);
            add_to(&sum, s, k + way, s->open_v[k + way]);
            if (sum.open > 0) {
                s->smoke[k] = sum.smoke / sum.open;
                s->heat[k] = sum.heat / sum.open;
                s->first[k] = FILLED;
                *any = true;
            } else {
                ++left;
            }
        }
    }
    return left;
}

static void know_filled(pl_air_scratch *s)
{
    for (int32_t j = 0; j < s->columns_y; ++j) {
        const size_t line = pl_air_at(s, 0, j);
        for (size_t k = line; k < line + (size_t)s->columns_x; ++k) {
            s->first[k] = s->first[k] == FILLED ? 1 : s->first[k];
        }
    }
}

// What solids have left is filled with what flowed in behind them, while it had no cell to go into: from its rim inwards.
// `first`: room before.
static void fill_left(pl_air_scratch *s, const pl_air_outside *nearest)
{
    const pl_air_area n = { s->columns_x, s->columns_y };
    bool any = true;
    for (uint32_t left = 1; left > 0 && any;) {
        pl_air_fill_ghosts(s, s->first, n, nearest);
        pl_air_fill_ghosts(s, s->smoke, n, nearest);
        pl_air_fill_ghosts(s, s->heat, n, nearest);
        left = fill_ring(s, &any);
        if (left > 0 && any) {
            know_filled(s);
        }
    }
}

void pl_air_find_room(pl_air_scratch *s, const plumb_air_desc *d)
{
    bool any_left = false;
    memcpy(s->first, s->room, pl_air_column_bytes(s));
    const pl_liquid_grid *g = &s->liquid.grid;
    const int32_t nx = s->columns_x, ny = s->columns_y;
    const bool wraps_x = d->left == PLUMB_AIR_PERIODIC, wraps_y = d->bottom == PLUMB_AIR_PERIODIC;
    for (int32_t j = 0; j <= ny; ++j) {
        for (int32_t i = 0; i <= nx; ++i) {
            const int32_t x = wraps_x && i == nx ? 0 : i, y = wraps_y && j == ny ? 0 : j;
            const uint32_t c = pl_liquid_cell_at(g, s->low_x + x, s->low_y + y);
            const size_t k = pl_air_at(s, i, j);
            const bool inside = i < nx && j < ny;
            s->open_u[k] = j < ny ? g->open_u[c] : 0;
            s->open_v[k] = i < nx ? g->open_v[c] : 0;
            s->room[k] = 0;
            if (!inside || g->row[c] == 0) {
                s->smoke[k] = s->heat[k] = 0;
                continue;
            }
            const uint32_t right = g->right[c], up = g->up[c];
            const near_real open = pl_air_most_of(pl_air_most_of(g->open_u[c], g->open_u[right]),
                                                  pl_air_most_of(g->open_v[c], g->open_v[up]));
            s->room[k] = pl_air_most_of(1 - g->cover[c], open);
            any_left |= s->room[k] > 0 && s->first[k] == 0;
        }
    }
    const pl_air_outside nearest = pl_air_outside_of(d);
    if (any_left) {
        fill_left(s, &nearest);
    }
    pl_air_fill_ghosts(s, s->room, (pl_air_area){ nx, ny }, &nearest);
}

// Sides do not fill cells: they let air in and out.
void pl_air_find_filled(pl_air_scratch *s, const plumb_air_desc *d)
{
    const pl_liquid_grid *g = &s->liquid.grid;
    const int32_t nx = s->columns_x, ny = s->columns_y;
    const bool wraps_x = d->left == PLUMB_AIR_PERIODIC, wraps_y = d->bottom == PLUMB_AIR_PERIODIC;
    for (int32_t j = 0; j < ny; ++j) {
        for (int32_t i = 0; i < nx; ++i) {
            const uint32_t c = pl_liquid_cell_at(g, s->low_x + i, s->low_y + j);
            const uint32_t right = g->right[c], up = g->up[c];
            s->filled[pl_air_at(s, i, j)] = (i + 1 < nx || wraps_x ? g->solid_u[right] : 0) -
                                            (i > 0 || wraps_x ? g->solid_u[c] : 0) +
                                            (j + 1 < ny || wraps_y ? g->solid_v[up] : 0) -
                                            (j > 0 || wraps_y ? g->solid_v[c] : 0);
        }
    }
}

void pl_air_find_fluxes(pl_air_scratch *s, const plumb_air_desc *d)
{
    const int32_t nx = s->columns_x, ny = s->columns_y;
    for (int32_t j = 0; j <= ny; ++j) {
        for (int32_t i = 0; i <= nx; ++i) {
            const size_t k = pl_air_at(s, i, j);
            s->flux_u[k] = s->open_u[k] * s->u[k];
            s->flux_v[k] = s->open_v[k] * s->v[k];
        }
        if (j < ny) {
            const size_t left = pl_air_at(s, 0, j), right = pl_air_at(s, nx, j);
            s->flux_u[left] = d->left == PLUMB_AIR_FLOW ? (near_real)d->flow.x : s->flux_u[left];
            s->flux_u[right] = d->right == PLUMB_AIR_FLOW ? (near_real)d->flow.x : s->flux_u[right];
        }
    }
    for (int32_t i = 0; i < nx; ++i) {
        const size_t low = pl_air_at(s, i, 0), high = pl_air_at(s, i, ny);
        s->flux_v[low] = d->bottom == PLUMB_AIR_FLOW ? (near_real)d->flow.y : s->flux_v[low];
        s->flux_v[high] = d->top == PLUMB_AIR_FLOW ? (near_real)d->flow.y : s->flux_v[high];
    }
    const pl_air_outside nearest = pl_air_outside_of(d);
    pl_air_fill_ghosts(s, s->flux_u, (pl_air_area){ nx + 1, ny }, &nearest);
    pl_air_fill_ghosts(s, s->flux_v, (pl_air_area){ nx, ny + 1 }, &nearest);
}
