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
#include "geometry/in_box.h"

#include <limits.h>
#include <math.h>

#define SIDE   PL_LIQUID_SIDE
#define NARROW 3 // [cells] across
#define AROUND 4 // lines beside a tile that such a piece may take most of, too

//---- faces ---------------------------------------------------------------------------------------

// A solid in a tile: coordinates from the tile's corner, with x and y exchanged for lines y = at.
typedef struct view {
    double x[16], y[16];
    double radius, left, right; // left, right: how far it reaches along x
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

static bool add_soft_link(pl_memory *memory, pl_liquid_scratch *scratch,
                          const pl_liquid_soft_link *link)
{
    pl_liquid_grid *g = &scratch->grid;
    if (!pl_buffer_reserve(memory, &scratch->soft_links, (g->soft_link_count + 1) * sizeof *link)) {
        return false;
    }
    g->soft_links = scratch->soft_links.data;
    g->soft_links[g->soft_link_count++] = *link;
    return true;
}

// A solid takes a part of a cell's lower face (upright) or left one, of what is left, and lets less or as much through. x, y: the middle of
// it, from the tile's corner.
static bool close_part(pl_memory *memory, pl_liquid_scratch *scratch, const view *v, uint32_t c,
                       bool upright, double wanted_part, double shut_part, double x, double y)
{
    pl_liquid_grid *g = &scratch->grid;
    near_real *open = upright ? &g->open_v[c] : &g->open_u[c];
    const near_real wanted = (near_real)wanted_part, shut = (near_real)shut_part;
    const near_real part = wanted < *open ? wanted : *open;
    *open = *open - shut < (near_real)1e-3 ? 0 : *open - shut;
    if (v->solid->soft && wanted > 0) {
        pl_liquid_soft_link link = {
            .cell = c, .upright = upright, .part = part, .rest = wanted - part
        };
        pl_liquid_close_softly(g, v->solid, &link, v->corner_x + x, v->corner_y + y);
        return add_soft_link(memory, scratch, &link);
    }
    if (v->body == NULL || !(wanted > 0)) {
        return true;
    }
    const double h = (double)g->h;
    const double arm =
        upright ? (v->corner_x + x) * h - v->body->x : v->body->y - (v->corner_y + y) * h;
    const double moves = (upright ? v->body->vy : v->body->vx) + arm * v->body->w;
    pl_liquid_add_speed(g, c, upright, part, moves);
    return !v->body->moves || add_link(memory, scratch,
                                       (pl_liquid_link){ c, v->solid->body, upright, part,
                                                         wanted - part, (near_real)arm });
}

// What lies on the line x = at from low to high; in an upright view, on y = at.
static bool close_face(pl_memory *memory, pl_liquid_scratch *scratch, const view *v, uint32_t c,
                       double at, double low, double high)
{
    const double mid = (low + high) / 2;
    return close_part(memory, scratch, v, c, v->upright, high - low, high - low,
                      v->upright ? mid : at, v->upright ? at : mid);
}

// The first of a tile's cells at or above a place; a large piece may begin far above it.
static int first_at(double low)
{
    return low >= SIDE ? SIDE : low > 0 ? (int)low : 0;
}

// The one behind the last that begins below a place.
static int end_at(double high)
{
    return high >= SIDE ? SIDE : high > 0 ? (int)ceil(high) : 0;
}

// Chords of the 16 lines of a tile that begin at x = from.
typedef struct lines {
    double low[SIDE], high[SIDE];
} lines;

static void find_lines(lines *out, const view *v, double from)
{
    double at[SIDE];
    for (int i = 0; i < SIDE; ++i) {
        at[i] = from + i;
    }
    pl_chords(v->x, v->y, v->solid->count, v->radius, at, SIDE, out->low, out->high);
}

// Lines x = i of a tile, from its left side on.
static bool close_lines(pl_memory *memory, pl_liquid_scratch *scratch, const view *v)
{
    lines all;
    find_lines(&all, v, 0);
    for (int i = 0; i < SIDE; ++i) {
        const double low = all.low[i], high = all.high[i];
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
    lines all;
    find_lines(&all, other, 0.5);
    for (int j = 0; j < SIDE; ++j) {
        const double low = all.low[j], high = all.high[j];
        for (int i = first_at(low + 0.5); i < SIDE && i - 0.5 <= high; ++i) {
            if (i + 0.5 >= low && !close_face(memory, scratch, v, cell_of(v, i, j), i, j, j + 1)) {
                return false;
            }
        }
    }
    return true;
}

// Gauss's rule of three chords over as much of each of a tile's columns of cells as the piece is wide.
#define CHORDS 3

typedef struct columns {
    double at[CHORDS * SIDE], low[CHORDS * SIDE], high[CHORDS * SIDE], width[SIDE];
    int first, end; // of the tile's
} columns;

static void find_columns(columns *c, const view *v)
{
    c->first = first_at(v->left);
    c->end = end_at(v->right);
    for (int i = c->first; i < c->end; ++i) {
        const double from = v->left > i ? v->left : i, to = v->right < i + 1 ? v->right : i + 1;
        const double middle = (from + to) / 2, off = (to - from) * 0.3872983346207417;
        double *at = &c->at[CHORDS * i];
        at[0] = middle - off, at[1] = middle, at[2] = middle + off;
        c->width[i] = to - from;
    }
    const int k = CHORDS * c->first, count = c->end > c->first ? CHORDS * c->end - k : 0;
    pl_chords(v->x, v->y, v->solid->count, v->radius, c->at + k, count, c->low + k, c->high + k);
}

static double bottom_of(const columns *c, int i)
{
    const double *low = &c->low[CHORDS * i], side = low[0] < low[2] ? low[0] : low[2];
    return low[1] < side ? low[1] : side;
}

static double top_of(const columns *c, int i)
{
    const double *high = &c->high[CHORDS * i], side = high[0] > high[2] ? high[0] : high[2];
    return high[1] > side ? high[1] : side;
}

// The area of a column between two heights; the mean of where in its width that is.
static double area_in(const columns *c, int i, double low, double high, double *mean)
{
    static const double weights[CHORDS] = { 5.0 / 18, 8.0 / 18, 5.0 / 18 };
    double area = 0, moment = 0;
    for (int k = 0; k < CHORDS; ++k) {
        const int chord = CHORDS * i + k;
        const double from = c->low[chord] > low ? c->low[chord] : low;
        const double to = c->high[chord] < high ? c->high[chord] : high;
        const double part = from < to ? weights[k] * c->width[i] * (to - from) : 0;
        area += part;
        moment += part * c->at[chord];
    }
    *mean = area > 0 ? moment / area : 0;
    return area;
}

static void cover_cells(pl_liquid_grid *g, const view *v, const columns *c, int i)
{
    double mean;
    for (int j = first_at(bottom_of(c, i)), end = end_at(top_of(c, i)); j < end; ++j) {
        near_real *cover = &g->cover[cell_of(v, i, j)];
        *cover += (near_real)area_in(c, i, j, j + 1, &mean);
        *cover = *cover > 1 ? 1 : *cover;
    }
}

static void cover_columns(pl_liquid_grid *g, const view *v)
{
    columns c;
    find_columns(&c, v);
    for (int i = c.first; i < c.end; ++i) {
        cover_cells(g, v, &c, i);
    }
}

// Of a narrow piece: the line of a column of which it takes most. There it shuts all of a face that it lies on, or water would go
// through walls; elsewhere not, or what it covers would be cut off from the pressures on both sides.
static int middle_of(const columns *inner, int i)
{
    const double bottom = bottom_of(inner, i), top = top_of(inner, i);
    double most = 0, unused;
    int middle = INT_MIN;
    for (int j = -AROUND; j < SIDE + AROUND; ++j) {
        if (j + 0.5 > bottom && j - 0.5 < top) {
            const double area = area_in(inner, i, j - 0.5, j + 0.5, &unused);
            middle = area > most ? j : middle;
            most = area > most ? area : most;
        }
    }
    return middle;
}

// How much of the face from i to i + 1 on line j of a tile lies in a piece.
static double chord_at(const lines *across, int i, int j)
{
    const double from = across->low[j] > i ? across->low[j] : i;
    const double to = across->high[j] < i + 1 ? across->high[j] : i + 1;
    return from < to ? to - from : 0;
}

// Bodies that yield take of a face what they have of the area between the centres of its two cells: so the pressures of water at
// rest add up to the weight of what they displace, wherever they lie in their cells (Batty et al. 2007). They shut it as if they were
// thinner by a film. Columns of cells tell how much of these is solid, too. `across`: the film as lines of the other kind see it.
static bool close_areas(pl_memory *memory, pl_liquid_scratch *scratch, const view *v,
                        const view *film, const view *across)
{
    const bool narrow = v->solid->width < NARROW;
    columns whole, inner;
    lines chords;
    find_columns(&whole, v);
    find_columns(&inner, film);
    if (narrow) {
        find_lines(&chords, across, 0);
    }
    for (int i = whole.first; i < whole.end; ++i) {
        if (!v->upright) {
            cover_cells(&scratch->grid, v, &whole, i);
        }
        const bool is_film = i >= inner.first && i < inner.end;
        const int middle = narrow && is_film ? middle_of(&inner, i) : INT_MIN;
        const int end = end_at(top_of(&whole, i) + 0.5);
        for (int j = first_at(bottom_of(&whole, i) - 0.5); j < end; ++j) {
            double mean, unused;
            const double part = area_in(&whole, i, j - 0.5, j + 0.5, &mean);
            const double area = is_film ? area_in(&inner, i, j - 0.5, j + 0.5, &unused) : 0;
            const double chord = j == middle ? chord_at(&chords, i, j) : 0;
            if (part > 0 && !close_part(memory, scratch, v, cell_of(v, i, j), !v->upright, part,
                                        chord > area ? chord : area, v->upright ? j : mean,
                                        v->upright ? mean : j)) {
                return false;
            }
        }
    }
    return true;
}

// A triangle of a soft body does the same, by exact areas: what they leave open between them would let the pressure in.
static bool close_triangle(pl_memory *memory, pl_liquid_scratch *scratch, const view *v)
{
    pl_liquid_grid *g = &scratch->grid;
    const pl_liquid_solid *s = v->solid;
    const int first_x = first_at(s->low_x - v->corner_x - 0.5);
    const int first_y = first_at(s->low_y - v->corner_y - 0.5);
    for (int j = first_y; j < SIDE && v->corner_y + j - 0.5 < s->high_y; ++j) {
        for (int i = first_x; i < SIDE && v->corner_x + i - 0.5 < s->high_x; ++i) {
            const uint32_t c = cell_of(v, i, j);
            const pl_in_box in = pl_triangle_in_box(v->x, v->y, i, j, i + 1, j + 1);
            const pl_in_box left = pl_triangle_in_box(v->x, v->y, i - 0.5, j, i + 0.5, j + 1);
            const pl_in_box low = pl_triangle_in_box(v->x, v->y, i, j - 0.5, i + 1, j + 0.5);
            const near_real cover = g->cover[c] + (near_real)in.area;
            g->cover[c] = cover > 1 ? 1 : cover;
            if ((left.area > 0 &&
                 !close_part(memory, scratch, v, c, false, left.area, left.area, left.x, left.y)) ||
                (low.area > 0 &&
                 !close_part(memory, scratch, v, c, true, low.area, low.area, low.x, low.y))) {
                return false;
            }
        }
    }
    return true;
}

// A piece as lines of a tile see it: as x = i, and upright as y = j, with its corners the other way round.
static view view_of(const pl_liquid_grid *g, const pl_liquid_tile *tile, uint32_t t,
                    const pl_liquid_solid *s, bool upright, bool film)
{
    view v = { .radius = film ? s->film_radius : s->radius,
               .left = INFINITY,
               .right = -INFINITY,
               .solid = s,
               .body = s->body == PL_LIQUID_NONE ? NULL : &g->bodies[s->body],
               .first = 1 + t * PL_LIQUID_TILE,
               .upright = upright,
               .corner_x = (double)tile->x * SIDE,
               .corner_y = (double)tile->y * SIDE };
    const double *all_x = film ? s->film_x : s->x, *all_y = film ? s->film_y : s->y;
    for (int i = 0; i < s->count; ++i) {
        const int k = upright ? s->count - 1 - i : i;
        const double x = all_x[i] - v.corner_x, y = all_y[i] - v.corner_y;
        v.x[k] = upright ? y : x;
        v.y[k] = upright ? x : y;
        v.left = v.x[k] - v.radius < v.left ? v.x[k] - v.radius : v.left;
        v.right = v.x[k] + v.radius > v.right ? v.x[k] + v.radius : v.right;
    }
    return v;
}

static bool close_tile(pl_memory *memory, pl_liquid_scratch *scratch, const pl_liquid_tile *tile,
                       uint32_t t, const pl_liquid_solid *s)
{
    pl_liquid_grid *g = &scratch->grid;
    const view v = view_of(g, tile, t, s, false, false), up = view_of(g, tile, t, s, true, false);
    if (s->soft) {
        return close_triangle(memory, scratch, &v);
    }
    if (pl_liquid_yields(g, s)) {
        const view film = view_of(g, tile, t, s, false, true);
        const view film_up = view_of(g, tile, t, s, true, true);
        return close_areas(memory, scratch, &v, &film, &film_up) &&
               close_areas(memory, scratch, &up, &film_up, &film);
    }
    cover_columns(g, &v);
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
    g->link_count = g->soft_link_count = 0;
    pl_liquid_see_bodies(g);
    pl_liquid_see_nodes(g);
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
