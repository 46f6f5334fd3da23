// rooms.c - what cannot flow out of a room that has no way out stays in it.
//
// A room is what open faces join: cells, and bodies beside them that yield, so that two rooms of one body are one. In one that
// is closed as much must come in as goes out. A right side that says otherwise, as a piston presses into it, or particles
// were pressed together in it, has no answer, and conjugate gradients then find none for all other rooms, either. So its
// mean is taken out. Without this 100 crates that fell into a pool of 14 m^2 pressed it to a seventh of its height.
//
// Reads: openness, rows, links. Writes: vectors[PL_LIQUID_R]. Cost: O(cells + links).
#include "liquid/liquid.h"
#include "core/union_find.h"

#include <string.h>

// Of cells, with bodies behind them. Cell 0 is what all open sides lead to.
static void find_rooms(const pl_liquid_grid *g, uint32_t *leaders, bool bodies_move)
{
    pl_union_reset(leaders, g->cell_count + g->body_count);
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t left = g->left[c], down = g->down[c];
        const bool here = g->row[c] != 0, at_left = g->row[left] != 0, below = g->row[down] != 0;
        if (g->open_u[c] > 0 && (here || at_left)) {
            pl_union_join(leaders, here ? c : 0, at_left ? left : 0);
        }
        if (g->open_v[c] > 0 && (here || below)) {
            pl_union_join(leaders, here ? c : 0, below ? down : 0);
        }
    }
    for (uint32_t i = 0; bodies_move && i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const uint32_t other = link->upright ? g->down[link->cell] : g->left[link->cell];
        if (g->row[link->cell] != 0) {
            pl_union_join(leaders, link->cell, g->cell_count + link->body);
        }
        if (g->row[other] != 0) {
            pl_union_join(leaders, other, g->cell_count + link->body);
        }
    }
    for (uint32_t i = 0; bodies_move && i < g->soft_link_count; ++i) {
        // What is soft yields to a room that it closes.
        const pl_liquid_soft_link *link = &g->soft_links[i];
        pl_union_join(leaders, g->row[link->cell] != 0 ? link->cell : 0, 0);
        const uint32_t other = link->upright ? g->down[link->cell] : g->left[link->cell];
        pl_union_join(leaders, g->row[other] != 0 ? other : 0, 0);
    }
}

typedef struct room {
    double sum;
    uint32_t count;
} room;

bool pl_liquid_balance(pl_memory *memory, pl_liquid_scratch *scratch, bool bodies_move)
{
    const pl_liquid_grid *g = &scratch->grid;
    near_real *r = g->vectors[PL_LIQUID_R];
    const uint32_t n = g->cell_count + g->body_count;
    if (!pl_buffer_reserve(memory, &scratch->rooms, n * (sizeof(room) + sizeof(uint32_t)))) {
        return false;
    }
    room *rooms = scratch->rooms.data;
    uint32_t *leaders = (uint32_t *)(void *)(rooms + n);
    find_rooms(g, leaders, bodies_move);
    memset(rooms, 0, n * sizeof *rooms);
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        if (g->row[c] != 0) {
            room *of = &rooms[pl_union_leader(leaders, c)];
            of->sum += (double)r[g->row[c]];
            ++of->count;
        }
    }
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t leader = g->row[c] != 0 ? pl_union_leader(leaders, c) : 0;
        if (leader != 0) {
            r[g->row[c]] -= (near_real)(rooms[leader].sum / rooms[leader].count);
        }
    }
    return true;
}
