// rooms.c - what cannot flow out of a room that has no way out stays in it.
//
// A room is what open faces join: cells, and bodies beside them that yield, so that two rooms of one body are one. In one that
// is closed as much must come in as goes out. A right side that says otherwise, as a piston presses into it, or particles
// were pressed together in it, has no answer, and conjugate gradients then find none for all other rooms, either. So its
// mean is taken out. Without this 100 crates that fell into a pool of 14 m^2 pressed it to a seventh of its height.
//
// Air has bodies that reach into walls by a hair, and close corners off (pl_liquid_balance_rooms): see src/air/DECISIONS.md.
//
// Reads: openness, rows, links. Writes: vectors[PL_LIQUID_R]. Cost: O(cells + links).
#include "liquid/liquid.h"
#include "core/union_find.h"

#include <math.h>
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

// Rooms, each at the place of its leader. Leader 0: it leads outside.
typedef struct finding {
    pl_liquid_room *rooms;
    uint32_t *leaders;
} finding;

// Place for two, the rooms of the second behind those of the first.
static bool make_place(pl_memory *memory, pl_liquid_scratch *scratch, finding f[2])
{
    const size_t n = scratch->grid.cell_count + scratch->grid.body_count;
    if (!pl_buffer_reserve(memory, &scratch->rooms,
                           2 * n * (sizeof(pl_liquid_room) + sizeof(uint32_t)))) {
        return false;
    }
    pl_liquid_room *rooms = scratch->rooms.data;
    uint32_t *leaders = (uint32_t *)(void *)(rooms + 2 * n);
    memset(rooms, 0, 2 * n * sizeof *rooms);
    f[0] = (finding){ rooms, leaders };
    f[1] = (finding){ rooms + n, leaders + n };
    return true;
}

static uint32_t room_of(const pl_liquid_grid *g, const finding *f, uint32_t cell)
{
    return g->row[cell] != 0 ? pl_union_leader(f->leaders, cell) : 0;
}

static void sum_up(const pl_liquid_grid *g, const finding *f)
{
    const near_real *r = g->vectors[PL_LIQUID_R];
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        pl_liquid_room *of = &f->rooms[room_of(g, f, c)];
        of->sum += g->row[c] != 0 ? (double)r[g->row[c]] : 0;
        of->count += g->row[c] != 0;
    }
}

// Takes out of each cell its part of what its room has.
static void take_out(const pl_liquid_grid *g, const finding *f)
{
    near_real *r = g->vectors[PL_LIQUID_R];
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t room = room_of(g, f, c);
        if (room != 0) {
            r[g->row[c]] -= (near_real)(f->rooms[room].sum / f->rooms[room].count);
        }
    }
}

bool pl_liquid_balance(pl_memory *memory, pl_liquid_scratch *scratch, bool bodies_move)
{
    finding f[2];
    if (!make_place(memory, scratch, f)) {
        return false;
    }
    find_rooms(&scratch->grid, f->leaders, bodies_move);
    sum_up(&scratch->grid, f);
    take_out(&scratch->grid, f);
    return true;
}

//---- rooms that leak -----------------------------------------------------------------------------

#define POCKET 16 // cells: a room of fewer is no vessel

static bool is_pocket(const pl_liquid_room *room)
{
    return room->count < POCKET;
}

// What goes into all vessels of one body together is taken out of those into which it goes, as much as goes into each; of a pocket all. So none
// is left with what its body would have to be thrown about for.
static void share_out(const pl_liquid_grid *g, const finding *each, const finding *joined)
{
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const pl_liquid_room *room = &each->rooms[c]; // of the cells that it leads
        if (room->count > 0 && !is_pocket(room)) {
            pl_liquid_room *all = &joined->rooms[room_of(g, joined, c)];
            all->sum += room->sum;
            all->gain += room->sum > 0 ? room->sum : 0;
            all->count += room->count;
        }
    }
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        pl_liquid_room *room = &each->rooms[c];
        const uint32_t leader = room->count > 0 ? room_of(g, joined, c) : 0;
        const pl_liquid_room *all = &joined->rooms[leader];
        if (room->count > 0 && !is_pocket(room)) {
            const double same = all->sum > 0 ? all->gain : all->sum - all->gain;
            const bool gives = leader != 0 && room->sum * all->sum > 0;
            room->sum = gives ? room->sum * (all->sum / same) : 0;
        }
    }
}

// [cells] that a body's motion fills of the vessels beside it in all, by 1 m/s to the right, up, by 1 rad/s.
typedef struct squeeze {
    uint32_t room;
    double volume[3];
} squeeze;

#define NONE_SQUEEZED 1e-4 // rounding of a body that a room is all around

static void note_end(const pl_liquid_grid *g, const finding *each, const finding *joined,
                     squeeze *q, const pl_liquid_link *link, uint32_t cell, double sign)
{
    const uint32_t room = room_of(g, joined, cell);
    if (room != 0 && !is_pocket(&each->rooms[room_of(g, each, cell)])) {
        q->room = room;
        q->volume[link->upright ? 1 : 0] += sign * (double)link->part;
        q->volume[2] += sign * (double)(link->part * link->arm);
    }
}

static bool is_squeezed(const squeeze *q, double h)
{
    return fabs(q->volume[0]) > NONE_SQUEEZED || fabs(q->volume[1]) > NONE_SQUEEZED ||
           fabs(q->volume[2]) > NONE_SQUEEZED * h;
}

// Which rooms are evened out: pockets, and vessels of a body that reaches into a wall, or out of them.
static void find_leaks(const pl_liquid_grid *g, const finding *each, const finding *joined,
                       squeeze *of)
{
    for (uint32_t b = 0; b < g->body_count; ++b) {
        of[b] = (squeeze){ .room = 0 };
    }
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const uint32_t other = link->upright ? g->down[link->cell] : g->left[link->cell];
        note_end(g, each, joined, &of[link->body], link, link->cell, 1);
        note_end(g, each, joined, &of[link->body], link, other, -1);
    }
    for (uint32_t b = 0; b < g->body_count; ++b) {
        joined->rooms[of[b].room].even |= is_squeezed(&of[b], (double)g->h);
    }
    joined->rooms[0].even = false;
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        each->rooms[c].even = each->rooms[c].count > 0 && is_pocket(&each->rooms[c]);
    }
}

static void list_room_cells(pl_liquid_grid *g, const finding *each, const finding *joined)
{
    const uint32_t behind = g->cell_count + g->body_count; // where the joined ones begin
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t own = room_of(g, each, c), all = room_of(g, joined, c);
        if (own != 0 && (each->rooms[own].even || joined->rooms[all].even)) {
            const uint32_t room = each->rooms[own].even ? own : behind + all;
            g->room_cells[g->room_cell_count++] = (pl_liquid_room_cell){ g->row[c], room };
        }
    }
}

bool pl_liquid_balance_rooms(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    finding f[2];
    const size_t squeezes = g->body_count * sizeof(squeeze);
    g->room_cell_count = 0;
    if (g->link_count == 0 && g->soft_link_count == 0) {
        return pl_liquid_balance(memory, scratch, false);
    }
    if (!make_place(memory, scratch, f) ||
        !pl_buffer_reserve(memory, &scratch->room_cells,
                           squeezes + g->cell_count * sizeof(pl_liquid_room_cell))) {
        return false;
    }
    const finding *each = &f[0], *joined = &f[1];
    find_rooms(g, each->leaders, false);
    find_rooms(g, joined->leaders, true);
    sum_up(g, each);
    share_out(g, each, joined);
    take_out(g, each);
    squeeze *of = scratch->room_cells.data;
    g->rooms = each->rooms;
    g->room_cells = (pl_liquid_room_cell *)(void *)(of + g->body_count);
    find_leaks(g, each, joined, of);
    list_room_cells(g, each, joined);
    return true;
}

void pl_liquid_even_rooms(const pl_liquid_grid *g, near_real *vector)
{
    for (uint32_t i = 0; i < g->room_cell_count; ++i) {
        g->rooms[g->room_cells[i].room].sum = 0;
    }
    for (uint32_t i = 0; i < g->room_cell_count; ++i) {
        g->rooms[g->room_cells[i].room].sum += (double)vector[g->room_cells[i].row];
    }
    for (uint32_t i = 0; i < g->room_cell_count; ++i) {
        const pl_liquid_room *room = &g->rooms[g->room_cells[i].room];
        vector[g->room_cells[i].row] -= (near_real)(room->sum / room->count);
    }
}
