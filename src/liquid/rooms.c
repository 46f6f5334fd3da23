// rooms.c - what cannot flow out of a room that has no way out stays in it.
//
// A room is what open faces join: cells, and bodies beside them that yield, so that two rooms of one body are one. In one that
// is closed as much must come in as goes out. A right side that says otherwise, as a piston presses into it, or particles
// were pressed together in it, has no answer, and conjugate gradients then find none for all other rooms, either. So its
// mean is taken out. Without this 100 crates that fell into a pool of 14 m^2 pressed it to a seventh of its height.
//
// Where nothing is said of a room's volume but that it stays as bodies make it (pl_liquid_balance_rooms), a pressure that is the same in
// all of the room does nothing. It is kept out of the solution: a body that closes a corner off, or reaches into a wall by a hair, would
// have to be thrown about to change the volume by as little as rounding does, and conjugate gradients did not find that.
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

static pl_liquid_room *rooms_of(const pl_liquid_scratch *scratch)
{
    return scratch->rooms.data;
}

static uint32_t *leaders_of(const pl_liquid_scratch *scratch)
{
    const pl_liquid_grid *g = &scratch->grid;
    return (uint32_t *)(void *)(rooms_of(scratch) + g->cell_count + g->body_count);
}

// 0: it leads outside, or has no row.
static uint32_t room_of(const pl_liquid_grid *g, uint32_t *leaders, uint32_t cell)
{
    return g->row[cell] != 0 ? pl_union_leader(leaders, cell) : 0;
}

bool pl_liquid_balance(pl_memory *memory, pl_liquid_scratch *scratch, bool bodies_move)
{
    const pl_liquid_grid *g = &scratch->grid;
    near_real *r = g->vectors[PL_LIQUID_R];
    const uint32_t n = g->cell_count + g->body_count;
    if (!pl_buffer_reserve(memory, &scratch->rooms,
                           n * (sizeof(pl_liquid_room) + sizeof(uint32_t)))) {
        return false;
    }
    pl_liquid_room *rooms = rooms_of(scratch);
    uint32_t *leaders = leaders_of(scratch);
    find_rooms(g, leaders, bodies_move);
    memset(rooms, 0, n * sizeof *rooms);
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        if (g->row[c] != 0) {
            pl_liquid_room *of = &rooms[pl_union_leader(leaders, c)];
            of->sum += (double)r[g->row[c]];
            ++of->count;
        }
    }
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t room = room_of(g, leaders, c);
        if (room != 0) {
            r[g->row[c]] -= (near_real)(rooms[room].sum / rooms[room].count);
        }
    }
    return true;
}

//---- rooms that bodies make narrower -------------------------------------------------------------

// What a body does to the only closed room that it closes faces of, or to one of several.
typedef struct squeeze {
    uint32_t room;
    double volume[3]; // [cells] that go into it by 1 m/s to the right, up, by 1 rad/s
} squeeze;

#define NONE_SQUEEZED 1e-4 // rounding of a body that a room is all around

static void note_end(pl_liquid_room *rooms, squeeze *q, const pl_liquid_link *link, uint32_t room,
                     double sign)
{
    if (room == 0) {
        return;
    }
    if (q->room != 0 && q->room != room) {
        rooms[q->room].even = rooms[room].even = true;
    }
    q->room = room;
    q->volume[link->upright ? 1 : 0] += sign * (double)link->part;
    q->volume[2] += sign * (double)(link->part * link->arm);
}

static bool is_squeezed(const squeeze *q, double h)
{
    return fabs(q->volume[0]) > NONE_SQUEEZED || fabs(q->volume[1]) > NONE_SQUEEZED ||
           fabs(q->volume[2]) > NONE_SQUEEZED * h;
}

// Which rooms have a volume that bodies change: those in which a body is that reaches into a wall, or out of them.
static void find_squeezed(const pl_liquid_grid *g, pl_liquid_room *rooms, uint32_t *leaders,
                          squeeze *of)
{
    for (uint32_t b = 0; b < g->body_count; ++b) {
        of[b] = (squeeze){ .room = 0 };
    }
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const uint32_t other = link->upright ? g->down[link->cell] : g->left[link->cell];
        note_end(rooms, &of[link->body], link, room_of(g, leaders, link->cell), 1);
        note_end(rooms, &of[link->body], link, room_of(g, leaders, other), -1);
    }
    for (uint32_t b = 0; b < g->body_count; ++b) {
        rooms[of[b].room].even |= is_squeezed(&of[b], (double)g->h);
    }
    for (uint32_t i = 0; i < g->soft_link_count; ++i) {
        const pl_liquid_soft_link *link = &g->soft_links[i];
        const uint32_t other = link->upright ? g->down[link->cell] : g->left[link->cell];
        rooms[room_of(g, leaders, link->cell)].even = true;
        rooms[room_of(g, leaders, other)].even = true;
    }
    rooms[0].even = false;
}

bool pl_liquid_balance_rooms(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    g->inmate_count = 0;
    if (!pl_liquid_balance(memory, scratch, false)) {
        return false;
    }
    if (g->link_count == 0 && g->soft_link_count == 0) {
        return true;
    }
    const size_t squeezes = g->body_count * sizeof(squeeze);
    if (!pl_buffer_reserve(memory, &scratch->inmates,
                           squeezes + g->cell_count * sizeof(pl_liquid_inmate))) {
        return false;
    }
    squeeze *of = scratch->inmates.data;
    uint32_t *leaders = leaders_of(scratch);
    g->rooms = rooms_of(scratch);
    g->inmates = (pl_liquid_inmate *)(void *)(of + g->body_count);
    find_squeezed(g, g->rooms, leaders, of);
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t room = room_of(g, leaders, c);
        if (g->rooms[room].even) {
            g->inmates[g->inmate_count++] = (pl_liquid_inmate){ g->row[c], room };
        }
    }
    return true;
}

void pl_liquid_even_rooms(const pl_liquid_grid *g, near_real *vector)
{
    for (uint32_t i = 0; i < g->inmate_count; ++i) {
        g->rooms[g->inmates[i].room].sum = 0;
    }
    for (uint32_t i = 0; i < g->inmate_count; ++i) {
        g->rooms[g->inmates[i].room].sum += (double)vector[g->inmates[i].row];
    }
    for (uint32_t i = 0; i < g->inmate_count; ++i) {
        const pl_liquid_room *room = &g->rooms[g->inmates[i].room];
        vector[g->inmates[i].row] -= (near_real)(room->sum / room->count);
    }
}
