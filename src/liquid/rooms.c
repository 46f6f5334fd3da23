// rooms.c - what cannot flow out of a room that has no way out stays in it.
//
// A room is what open faces join: cells, and bodies beside them that yield, so that two rooms of one body are one. In one that
// is closed as much must come in as goes out. A right side that says otherwise, as a piston presses into it, or particles
// were pressed together in it, has no answer, and conjugate gradients then find none for all other rooms, either. So its
// mean is taken out. Without this 100 crates that fell into a pool of 14 m^2 pressed it to a seventh of its height.
//
// Air has bodies that reach into walls by a hair, and close corners off (pl_liquid_balance_rooms): see src/air/DECISIONS.md.
//
// Reads: openness, rows, rims. Writes: room, vectors[PL_LIQUID_R]. Cost: O(cells + rims).
#include "liquid/liquid.h"
#include "core/union_find.h"

#include <math.h>
#include <string.h>

//---- what faces join -----------------------------------------------------------------------------

#define OUTSIDE                                                                                    \
    1 // `room` of cells with liquid that lead out; beyond it those of one room each. 0: not found, or dry

// Cells in the order in which they were found.
typedef struct flood {
    pl_liquid_grid *g;
    uint32_t *list, count, done; // done: of the list, what is behind their faces was looked at
    uint32_t room;
} flood;

static void enter(flood *f, uint32_t c)
{
    if (f->g->room[c] == 0) {
        f->g->room[c] = f->room;
        f->list[f->count++] = c;
    }
}

static void follow_faces(flood *f)
{
    const pl_liquid_grid *g = f->g;
    while (f->done < f->count) {
        const uint32_t c = f->list[f->done++];
        const uint32_t near[4] = { g->left[c], g->right[c], g->down[c], g->up[c] };
        near_real open[4];
        pl_liquid_faces_of(g, c, open);
        for (int k = 0; k < 4; ++k) {
            if (open[k] > 0 && g->row[near[k]] != 0) {
                enter(f, near[k]);
            }
        }
    }
}

static bool is_beside_air(const pl_liquid_grid *g, uint32_t c)
{
    const uint32_t near[4] = { g->left[c], g->right[c], g->down[c], g->up[c] };
    near_real open[4];
    bool beside = false;
    pl_liquid_faces_of(g, c, open);
    for (int k = 0; k < 4; ++k) {
        beside |= open[k] > 0 && g->row[near[k]] == 0;
    }
    return beside;
}

// What leads out first, then a room at each cell that is in none yet.
static void fill_rooms(flood *f, bool outside)
{
    pl_liquid_grid *g = f->g;
    for (uint32_t s = 1; s < g->levels[0].end; ++s) {
        for (uint32_t c = g->strips[s].cell; c < g->strips[s].cell + PL_LIQUID_SIDE; ++c) {
            if (g->row[c] != 0 && g->room[c] == 0 && (!outside || is_beside_air(g, c))) {
                f->room += !outside;
                enter(f, c);
                follow_faces(f);
            }
        }
    }
}

bool pl_liquid_find_rooms(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    if (!pl_buffer_reserve(memory, &scratch->joined, g->cell_count * sizeof(uint32_t))) {
        return false;
    }
    flood f = { .g = g, .list = scratch->joined.data, .room = OUTSIDE };
    fill_rooms(&f, true);
    fill_rooms(&f, false);
    g->room_count = f.room;
    return true;
}

//---- what bodies join ----------------------------------------------------------------------------

// Rooms, each at the place of its leader. 0: outside.
typedef struct finding {
    pl_liquid_room *rooms;
    uint32_t *leaders;
} finding;

static uint32_t own_room(const pl_liquid_grid *g, uint32_t cell)
{
    return g->row[cell] != 0 ? g->room[cell] - OUTSIDE : 0;
}

static uint32_t room_of(const pl_liquid_grid *g, const finding *f, uint32_t cell)
{
    return pl_union_leader(f->leaders, own_room(g, cell));
}

// Place for two, the rooms of the second behind those of the first; each leads itself.
static bool make_place(pl_memory *memory, pl_liquid_scratch *scratch, finding f[2])
{
    const size_t n = scratch->grid.room_count;
    if (!pl_buffer_reserve(memory, &scratch->rooms,
                           2 * n * (sizeof(pl_liquid_room) + sizeof(uint32_t)))) {
        return false;
    }
    pl_liquid_room *rooms = scratch->rooms.data;
    uint32_t *leaders = (uint32_t *)(void *)(rooms + 2 * n);
    memset(rooms, 0, 2 * n * sizeof *rooms);
    for (int k = 0; k < 2; ++k) {
        f[k] = (finding){ rooms + (size_t)k * n, leaders + (size_t)k * n };
        pl_union_reset(f[k].leaders, (uint32_t)n);
    }
    return true;
}

static void join_rooms(const pl_liquid_grid *g, const finding *f)
{
    for (uint32_t b = 0; b < g->body_count; ++b) {
        const uint32_t *rows = g->rim_rows + g->bodies[b].first_rim;
        for (uint32_t i = 1; i < g->bodies[b].rim_count; ++i) {
            pl_union_join(f->leaders, own_room(g, pl_liquid_cell_of(g, rows[i - 1])),
                          own_room(g, pl_liquid_cell_of(g, rows[i])));
        }
    }
    for (uint32_t i = 0; i < g->soft_link_count; ++i) {
        // What is soft yields to a room that it closes.
        const pl_liquid_soft_link *link = &g->soft_links[i];
        pl_union_join(f->leaders, own_room(g, link->cell), 0);
        pl_union_join(f->leaders,
                      own_room(g, link->upright ? g->down[link->cell] : g->left[link->cell]), 0);
    }
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
    const pl_liquid_grid *g = &scratch->grid;
    finding f[2];
    if (g->room_count == 1) { // all leads out, as it mostly does
        return true;
    }
    if (!make_place(memory, scratch, f)) {
        return false;
    }
    if (bodies_move) {
        join_rooms(g, f);
    }
    sum_up(g, f);
    take_out(g, f);
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
    for (uint32_t k = 1; k < g->room_count; ++k) {
        const pl_liquid_room *room = &each->rooms[k];
        if (!is_pocket(room)) {
            pl_liquid_room *all = &joined->rooms[pl_union_leader(joined->leaders, k)];
            all->sum += room->sum;
            all->gain += room->sum > 0 ? room->sum : 0;
            all->count += room->count;
        }
    }
    for (uint32_t k = 1; k < g->room_count; ++k) {
        pl_liquid_room *room = &each->rooms[k];
        const uint32_t leader = pl_union_leader(joined->leaders, k);
        const pl_liquid_room *all = &joined->rooms[leader];
        if (!is_pocket(room)) {
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
    if (room != 0 && !is_pocket(&each->rooms[own_room(g, cell)])) {
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
    for (uint32_t k = 1; k < g->room_count; ++k) {
        each->rooms[k].even = is_pocket(&each->rooms[k]);
    }
}

static void list_room_cells(pl_liquid_grid *g, const finding *each, const finding *joined)
{
    const uint32_t behind = g->room_count; // where the joined ones begin
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t own = own_room(g, c), all = room_of(g, joined, c);
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
    join_rooms(g, joined);
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
