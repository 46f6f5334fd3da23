// solids.c - which part of each face is closed by solids: chords of convex pieces with the lines of the grid.
//
// A line x = i of the grid meets a convex piece in one interval, found exactly; what it covers of the faces along the
// line is closed. A piece that is less than a cell across could lie between two lines and close nothing: it closes
// every face that it crosses on the way from one cell's centre to the next. Three chords tell how much of a cell is
// solid.
//
// What moving bodies close is a link each: it pushes the liquid by the body's velocity, and the pressure there pushes
// the body (pressure.c).
//
// Reads: solids, tiles. Writes: openness, speeds of what closes, links. Cost: O(tiles x (solids + chords in them)).
#include "liquid/liquid.h"

#include "geometry/chord.h"

#include <math.h>

#define SIDE PL_LIQUID_SIDE

//---- faces ---------------------------------------------------------------------------------------

// A solid in a tile: coordinates from the tile's corner, with x and y exchanged for lines y = at.
typedef struct interval {
    double low, high;
} interval;

typedef struct view {
    double x[16], y[16];
    const pl_liquid_solid *solid;
    const pl_liquid_body *body; // NULL: static
    uint32_t first;             // cell of the tile
    bool upright;               // x and y are exchanged
    double corner_x, corner_y;  // of the tile, cells
} view;

static uint32_t cell_of(const view *v, int along, int across)
{
    return v->first + (uint32_t)(v->upright ? along * SIDE + across : across * SIDE + along);
}

static bool add_link(pl_memory *memory, pl_liquid_scratch *scratch, pl_liquid_link link)
{
    pl_liquid_grid *g = &scratch->grid;
    if (!pl_buffer_reserve(memory, &scratch->links, (g->link_count + 1) * sizeof link)) {
        return false;
    }
    g->links = scratch->links.data;
    g->links[g->link_count++] = link;
    return true;
}

// Closes the part of a face from low to high along it. What is closed already stays with whom it is.
static bool close_face(pl_memory *memory, pl_liquid_scratch *scratch, const view *v, uint32_t c,
                       double at, double low, double high)
{
    pl_liquid_grid *g = &scratch->grid;
    near_real *open = v->upright ? &g->open_v[c] : &g->open_u[c];
    near_real *speed = v->upright ? &g->solid_v[c] : &g->solid_u[c];
    const near_real wanted = (near_real)(high - low), part = wanted < *open ? wanted : *open;
    if (!(part > 0)) {
        return true;
    }
    *open = *open - part < (near_real)1e-3 ? 0 : *open - part;
    if (v->body == NULL) {
        return true;
    }
    // The middle of what is closed, seen from the body's centre.
    const double h = (double)g->h, mid = (low + high) / 2;
    const double x = (v->corner_x + (v->upright ? mid : at)) * h - v->body->x;
    const double y = (v->corner_y + (v->upright ? at : mid)) * h - v->body->y;
    const double arm = v->upright ? x : -y;
    const double moves = (v->upright ? v->body->vy : v->body->vx) + arm * v->body->w;
    *speed += part * (near_real)pl_liquid_held(moves, PL_LIQUID_SPEED);
    return !v->body->moves ||
           add_link(memory, scratch,
                    (pl_liquid_link){ c, v->solid->body, v->upright, part, (near_real)arm });
}

// The first of a tile's cells at or above a place; a large piece may begin far above it.
static int first_at(double low)
{
    return low >= SIDE ? SIDE : low > 0 ? (int)low : 0;
}

// Lines x = i of a tile, from its left side on.
static bool close_lines(pl_memory *memory, pl_liquid_scratch *scratch, const view *v)
{
    const pl_liquid_solid *s = v->solid;
    double low, high;
    for (int i = 0; i < SIDE; ++i) {
        if (!pl_chord(v->x, v->y, s->count, s->radius, i, &low, &high)) {
            continue;
        }
        for (int j = first_at(low); j < SIDE && j < high; ++j) {
            const double from = low > j ? low : j, to = high < j + 1 ? high : j + 1;
            if (from < to && !close_face(memory, scratch, v, cell_of(v, i, j), i, from, to)) {
                return false;
            }
        }
    }
    return true;
}

// Lines y = j + 1/2 from centre to centre; `other`: the view with x and y exchanged.
static bool close_crossed(pl_memory *memory, pl_liquid_scratch *scratch, const view *v,
                          const view *other)
{
    const pl_liquid_solid *s = v->solid;
    double low, high;
    for (int j = 0; j < SIDE; ++j) {
        if (!pl_chord(other->x, other->y, s->count, s->radius, j + 0.5, &low, &high)) {
            continue;
        }
        for (int i = first_at(low + 0.5); i < SIDE && i - 0.5 <= high; ++i) {
            if (i + 0.5 >= low && !close_face(memory, scratch, v, cell_of(v, i, j), i, j, j + 1)) {
                return false;
            }
        }
    }
    return true;
}

static interval chord_at(const view *v, double at)
{
    interval c;
    if (!pl_chord(v->x, v->y, v->solid->count, v->solid->radius, at, &c.low, &c.high)) {
        c = (interval){ 0, 0 };
    }
    return c;
}

// What of a chord lies in line j.
static double length_in(interval c, int j)
{
    const double low = c.low > j ? c.low : j, high = c.high < j + 1 ? c.high : j + 1;
    return high > low ? high - low : 0;
}

// The part of each cell of a column that is solid: Gauss's rule of three chords over as much of it as the piece is wide.
static void cover_column(pl_liquid_grid *g, const view *v, int i)
{
    const pl_liquid_solid *s = v->solid;
    const double left = s->low_x - v->corner_x, right = s->high_x - v->corner_x;
    const double from = left > i ? left : i, to = right < i + 1 ? right : i + 1;
    if (!(from < to)) {
        return;
    }
    const double middle = (from + to) / 2, off = (to - from) * 0.3872983346207417;
    const interval a = chord_at(v, middle - off), b = chord_at(v, middle);
    const interval c = chord_at(v, middle + off);
    const double low = s->low_y - v->corner_y, high = s->high_y - v->corner_y;
    for (int j = first_at(low); j < SIDE && j <= high; ++j) {
        near_real *cover = &g->cover[cell_of(v, i, j)];
        const double part = 5 * length_in(a, j) + 8 * length_in(b, j) + 5 * length_in(c, j);
        *cover += (near_real)((to - from) * part / 18);
        *cover = *cover > 1 ? 1 : *cover;
    }
}

static void cover_cells(pl_liquid_grid *g, const view *v)
{
    for (int i = 0; i < SIDE; ++i) {
        cover_column(g, v, i);
    }
}

static bool close_tile(pl_memory *memory, pl_liquid_scratch *scratch, const pl_liquid_tile *tile,
                       uint32_t t, const pl_liquid_solid *s)
{
    pl_liquid_grid *g = &scratch->grid;
    view v = { .solid = s,
               .body = s->body == PL_LIQUID_NONE ? NULL : &g->bodies[s->body],
               .first = 1 + t * PL_LIQUID_TILE,
               .corner_x = (double)tile->x * SIDE,
               .corner_y = (double)tile->y * SIDE };
    view up = v;
    up.upright = true;
    for (int i = 0; i < s->count; ++i) {
        const int k = s->count - 1 - i; // mirrored: the other way round
        v.x[i] = up.y[k] = s->x[i] - v.corner_x;
        v.y[i] = up.x[k] = s->y[i] - v.corner_y;
    }
    cover_cells(g, &v);
    if (s->thin &&
        (!close_crossed(memory, scratch, &v, &up) || !close_crossed(memory, scratch, &up, &v))) {
        return false;
    }
    return close_lines(memory, scratch, &v) && close_lines(memory, scratch, &up);
}

//---- all of them ---------------------------------------------------------------------------------

static bool overlaps(const pl_liquid_tile *tile, const pl_liquid_solid *s, double margin)
{
    const double x = (double)tile->x * SIDE, y = (double)tile->y * SIDE;
    return s->low_x - margin < x + SIDE && s->high_x + margin > x && s->low_y - margin < y + SIDE &&
           s->high_y + margin > y;
}

static bool list_solid(pl_memory *memory, pl_liquid_scratch *scratch, pl_liquid_tile *tile,
                       uint32_t s)
{
    const size_t place = (size_t)tile->first_solid + tile->solid_count;
    if (!pl_buffer_reserve(memory, &scratch->tile_solids, (place + 1) * sizeof(uint32_t))) {
        return false;
    }
    scratch->grid.tile_solids = scratch->tile_solids.data;
    scratch->grid.tile_solids[place] = s;
    ++tile->solid_count;
    return true;
}

bool pl_liquid_close_faces(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    uint32_t listed = 0;
    g->link_count = 0;
    pl_liquid_see_bodies(g);
    near_real *restrict u = g->open_u, *restrict v = g->open_v;
    for (uint32_t c = 0; c < g->cell_count; ++c) {
        u[c] = v[c] = 1;
    }
    for (uint32_t t = 0; t < g->tile_count; ++t) {
        pl_liquid_tile *tile = &g->tiles[t];
        tile->first_solid = listed;
        tile->solid_count = 0;
        for (uint32_t s = 0; s < g->solid_count; ++s) {
            const pl_liquid_solid *solid = &g->solids[s];
            if (overlaps(tile, solid, PL_LIQUID_REACH) && !list_solid(memory, scratch, tile, s)) {
                return false;
            }
            if (overlaps(tile, solid, 1) && !close_tile(memory, scratch, tile, t, solid)) {
                return false;
            }
        }
        listed += tile->solid_count;
    }
    return true;
}
