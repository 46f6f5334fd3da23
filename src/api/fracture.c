// fracture.c - bodies are cut along lines, and shatter along the borders of Voronoi cells.
//
// Places of cells: from one that lies in the body, a direction, evenly, and a distance R u^2 (R sqrt(u) where cells are to be even),
// R as far as the body goes from the point; places outside of the body are thrown again. A cell that has a part
// that is too small or too slender goes, the worst of all first, and its neighbours have its room.
//
// Reads: arguments, checked first; the pieces of the body. Writes: see divide.c. Cost: see plumb/fracture.h.
#include "api/fracture.h"

#include "math/trig.h"
#include "plumb/math.h"
#include "world/check.h"
#include "world/rows.h"

#include <math.h>

#define DEFAULT_CELLS 12
#define DEFAULT_SHARE 0.005
#define THROWS        32  // for the place of one cell
#define SLENDER       0.1 // [-] width over length
#define WIDE          0.6 // [-] of the width of the body
#define PLACE_MOST    ((plumb_real)1e9)
#define PI            3.14159265358979323846

//---- what both ask -------------------------------------------------------------------------------

bool pl_is_divisible(const plumb_world *world, uint32_t row)
{
    uint32_t p = world->bodies.first_piece[row];
    while (p != PL_NONE && !pl_fragments_have(world, p)) {
        p = world->pieces.next_in_body[p];
    }
    return p != PL_NONE;
}

static plumb_result check(const plumb_world *world, const char *fn, plumb_body body, int capacity,
                          const plumb_body *parts)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, fn, body, &row));
    PL_TRY(pl_check_unlocked(world, fn));
    if (capacity < 0 || (capacity > 0 && parts == NULL)) {
        return pl_fail(world, capacity < 0 ? PLUMB_E_RANGE : PLUMB_E_NULL, fn,
                       "capacity is %d; it must be 0 or more, and 0 without parts", capacity);
    }
    return pl_is_divisible(world, row)
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_STATE, fn,
                         "body has no shape with an area; it must have one");
}

static int tell(const plumb_world *world, plumb_body body, plumb_body *parts, int capacity)
{
    const pl_child *all = pl_children(world);
    int count = 0;
    for (uint32_t i = 0; i < world->fracture.child_count; ++i) {
        if (!plumb_same(all[i].body, body)) {
            if (count < capacity) {
                parts[count] = all[i].body;
            }
            ++count;
        }
    }
    return count;
}

//---- lines ---------------------------------------------------------------------------------------

plumb_result pl_cut_check(const plumb_world *world, const char *function, plumb_vec2 point,
                          plumb_vec2 along)
{
    PL_TRY(pl_check_within(world, function, "point", point, PLACE_MOST));
    PL_TRY(pl_check_finite_vec(world, function, "along", along));
    return along.x != 0 || along.y != 0
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_RANGE, function, "along is (0, 0); it must not be 0");
}

double pl_cut_way(plumb_vec2 along, double way[2])
{
    const double scale = pl_larger(fabs((double)along.x), fabs((double)along.y));
    way[0] = (double)along.x / scale, way[1] = (double)along.y / scale;
    return sqrt(way[0] * way[0] + way[1] * way[1]);
}

// The two sides of a line, in the frame of the body of `row`, in double.
static pl_cells sides_of(const plumb_world *world, uint32_t row, plumb_vec2 point, plumb_vec2 along)
{
    const pl_bodies *b = &world->bodies;
    const double c = (double)b->c[row], s = (double)b->s[row];
    const double dx = (double)point.x - (double)b->x[row], dy = (double)point.y - (double)b->y[row];
    const double px = c * dx + s * dy, py = c * dy - s * dx;
    double way[2];
    const double length = pl_cut_way(along, way);
    const double nx = -(c * way[1] - s * way[0]) / length, ny = (c * way[0] + s * way[1]) / length;
    return (pl_cells){ .count = 2, .is_line = true, .line = { nx, ny, nx * px + ny * py } };
}

plumb_result pl_cut(plumb_world *world, const char *function, plumb_body body, plumb_vec2 point,
                    plumb_vec2 along, bool tells, int *count)
{
    *count = 0;
    const uint32_t row = pl_body_row(world, body);
    const pl_cells cells = sides_of(world, row, point, along);
    if (!pl_fragments_make(world, row, &cells)) {
        return pl_fail_memory(world, function);
    }
    bool cuts = false;
    for (uint32_t i = 0; i < world->fracture.fragment_count; ++i) {
        cuts |= pl_fragments(world)[i].cell != pl_fragments(world)[0].cell;
    }
    if (!cuts || world->fracture.child_count < 2) {
        return PLUMB_OK;
    }
    PL_TRY(pl_divide(world, function, body, tells));
    *count = (int)world->fracture.child_count - 1;
    return PLUMB_OK;
}

int plumb_body_cut(plumb_world *world, plumb_body body, plumb_vec2 point, plumb_vec2 along,
                   plumb_body *parts, int capacity)
{
    int count;
    if (check(world, __func__, body, capacity, parts) != PLUMB_OK ||
        pl_cut_check(world, __func__, point, along) != PLUMB_OK ||
        pl_cut(world, __func__, body, point, along, false, &count) != PLUMB_OK) {
        return -1;
    }
    return count == 0 ? 0 : tell(world, body, parts, capacity);
}

//---- cells ---------------------------------------------------------------------------------------

static bool contains(const plumb_world *world, uint32_t row, double x, double y)
{
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        plumb_convex convex;
        pl_piece_convex(world, p, &convex);
        if (pl_fragments_have(world, p) &&
            plumb_convex_contains(&convex, plumb_v2((plumb_real)x, (plumb_real)y))) {
            return true;
        }
    }
    return false;
}

// [m] of the solid pieces from a point, in the body's frame.
static double farthest(const plumb_world *world, uint32_t row, double x, double y)
{
    double most = 0;
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        plumb_convex convex;
        pl_piece_convex(world, p, &convex);
        for (int k = 0; k < convex.count && pl_fragments_have(world, p); ++k) {
            const double dx = (double)convex.points[k].x - x, dy = (double)convex.points[k].y - y;
            most = pl_larger(most, sqrt(dx * dx + dy * dy) + (double)convex.radius);
        }
    }
    return most;
}

// The place of the surface nearest to a point outside; a point within stays.
static void bring_near(const plumb_world *world, uint32_t row, double *x, double *y)
{
    const plumb_vec2 from = plumb_v2((plumb_real)*x, (plumb_real)*y);
    plumb_convex_near nearest = { .distance = PLUMB_REAL_MAX, .point = from };
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        plumb_convex convex;
        pl_piece_convex(world, p, &convex);
        if (pl_fragments_have(world, p)) {
            const plumb_convex_near near = plumb_convex_nearest(&convex, from);
            nearest = near.distance < nearest.distance ? near : nearest;
        }
    }
    if (nearest.distance > 0) {
        *x = (double)nearest.point.x;
        *y = (double)nearest.point.y;
    }
}

// 0..1, the next of SplitMix64 (Steele, Lea and Flood 2014).
static double number(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static void place_cells(const plumb_world *world, uint32_t row, const plumb_shatter_desc *desc,
                        pl_cells *cells)
{
    const pl_bodies *b = &world->bodies;
    const double c = (double)b->c[row], s = (double)b->s[row];
    const double dx = (double)desc->point.x - (double)b->x[row];
    const double dy = (double)desc->point.y - (double)b->y[row];
    double px = c * dx + s * dy, py = c * dy - s * dx;
    bring_near(world, row, &px, &py);
    const double reach = farthest(world, row, px, py), even = (double)desc->even;
    uint64_t random = desc->seed;
    const int wanted = desc->cells == 0 ? DEFAULT_CELLS : desc->cells;
    for (int i = 0; i < wanted; ++i) {
        for (int k = 0; k < THROWS; ++k) {
            const double u = number(&random);
            double sine, cosine;
            pl_sincos(2 * PI * number(&random), &sine, &cosine);
            const double r = reach * ((1 - even) * u * u + even * sqrt(u));
            const double x = px + r * cosine, y = py + r * sine;
            if (contains(world, row, x, y)) {
                cells->x[cells->count] = x;
                cells->y[cells->count++] = y;
                break;
            }
        }
    }
}

// Nearer than 0.1 mm, borders of cells are rounding.
static void thin_out(pl_cells *cells)
{
    int kept = 0;
    for (int i = 0; i < cells->count; ++i) {
        bool near = false;
        for (int k = 0; k < kept; ++k) {
            const double dx = cells->x[i] - cells->x[k], dy = cells->y[i] - cells->y[k];
            near |= dx * dx + dy * dy < (double)PLUMB_LENGTH_MIN * (double)PLUMB_LENGTH_MIN;
        }
        if (!near) {
            cells->x[kept] = cells->x[i];
            cells->y[kept++] = cells->y[i];
        }
    }
    cells->count = kept;
}

static void drop(pl_cells *cells, uint32_t cell)
{
    for (int k = (int)cell + 1; k < cells->count; ++k) {
        cells->x[k - 1] = cells->x[k];
        cells->y[k - 1] = cells->y[k];
    }
    --cells->count;
}

// Width over length of the narrowest of six boxes around it, each turned by 15 degrees; *width [m].
static double thickness(const plumb_world *world, uint32_t child, double *width)
{
    double least = HUGE_VAL;
    for (int way = 0; way < 6; ++way) {
        double s, c, low[2] = { HUGE_VAL, HUGE_VAL }, high[2] = { -HUGE_VAL, -HUGE_VAL };
        pl_sincos(way * PI / 12, &s, &c);
        for (uint32_t i = 0; i < world->fracture.fragment_count; ++i) {
            const pl_fragment *g = &pl_fragments(world)[i];
            for (uint32_t k = 0; g->child == child && k < (g->parts > 0 ? g->parts : 1); ++k) {
                plumb_convex convex;
                if (g->parts > 0) {
                    convex = pl_fragment_parts(world)[g->part + k].convex;
                } else {
                    pl_piece_convex(world, g->piece, &convex);
                }
                for (int j = 0; j < convex.count; ++j) {
                    const double x = (double)convex.points[j].x, y = (double)convex.points[j].y;
                    const double at[2] = { c * x + s * y, c * y - s * x };
                    for (int a = 0; a < 2; ++a) {
                        low[a] = pl_smaller(low[a], at[a] - (double)convex.radius);
                        high[a] = pl_larger(high[a], at[a] + (double)convex.radius);
                    }
                }
            }
        }
        const double w = high[0] - low[0], h = high[1] - low[1];
        const double ratio = pl_smaller(w / h, h / w);
        *width = ratio < least ? pl_smaller(w, h) : *width;
        least = pl_smaller(least, ratio);
    }
    return least;
}

// The cell that has the worst part of those that are none, or PL_NONE. Slender is not what is about as wide as the body, `wide` [m].
static uint32_t worst_cell(const plumb_world *world, double least_area, double wide)
{
    const pl_fracture *f = &world->fracture;
    double worst = 1;
    uint32_t cell = PL_NONE;
    for (uint32_t i = 0; i < f->child_count; ++i) {
        const double area = pl_children(world)[i].area / least_area;
        double width = 0;
        const double slender = thickness(world, i, &width) / SLENDER;
        const double thick = width > WIDE * wide ? 1 : slender;
        const double bad = area < thick ? area : thick;
        for (uint32_t k = 0; bad < worst && k < f->fragment_count; ++k) {
            if (pl_fragments(world)[k].child == i) {
                cell = pl_fragments(world)[k].cell;
                worst = bad;
            }
        }
    }
    return cell;
}

static bool settle_cells(plumb_world *world, uint32_t row, const plumb_shatter_desc *desc,
                         pl_cells *cells)
{
    const pl_cells one = { .count = 1 };
    if (!pl_fragments_make(world, row, &one)) {
        return false;
    }
    double area = 0, wide = HUGE_VAL;
    for (uint32_t i = 0; i < world->fracture.child_count; ++i) {
        area += pl_children(world)[i].area;
        double width = 0;
        thickness(world, i, &width);
        wide = pl_smaller(wide, width);
    }
    const double share = desc->min_share > 0 ? (double)desc->min_share : DEFAULT_SHARE;
    uint32_t worst = PL_NONE;
    do {
        if (worst != PL_NONE) {
            drop(cells, worst);
        }
        if (!pl_fragments_make(world, row, cells)) {
            return false;
        }
        worst = worst_cell(world, share * area, wide);
    } while (worst != PL_NONE && cells->count > 1);
    return true;
}

plumb_result pl_shatter(plumb_world *world, const char *function, plumb_body body,
                        const plumb_shatter_desc *desc, bool tells, int *count)
{
    *count = 0;
    pl_cells cells = { 0 };
    const uint32_t row = pl_body_row(world, body);
    place_cells(world, row, desc, &cells);
    thin_out(&cells);
    if (cells.count < 2) {
        return PLUMB_OK;
    }
    if (!settle_cells(world, row, desc, &cells)) {
        return pl_fail_memory(world, function);
    }
    if (cells.count < 2 || world->fracture.child_count < 2) {
        return PLUMB_OK;
    }
    PL_TRY(pl_divide(world, function, body, tells));
    *count = (int)world->fracture.child_count - 1;
    return PLUMB_OK;
}

plumb_result pl_shatter_check(const plumb_world *world, const char *fn,
                              const plumb_shatter_desc *desc)
{
    PL_TRY(pl_check_within(world, fn, "point", desc->point, PLACE_MOST));
    PL_TRY(pl_check_range(world, fn, "even", desc->even, 0, 1));
    PL_TRY(pl_check_range(world, fn, "min_share", desc->min_share, 0, (plumb_real)0.5));
    return desc->cells == 0 || (desc->cells >= 2 && desc->cells <= PLUMB_SHATTER_MAX)
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_RANGE, fn, "cells is %d; it must be 0, or 2 to %d",
                         desc->cells, PLUMB_SHATTER_MAX);
}

int plumb_body_shatter(plumb_world *world, plumb_body body, const plumb_shatter_desc *desc,
                       plumb_body *parts, int capacity)
{
    const plumb_shatter_desc none = { 0 };
    desc = desc != NULL ? desc : &none;
    int count;
    if (check(world, __func__, body, capacity, parts) != PLUMB_OK ||
        pl_shatter_check(world, __func__, desc) != PLUMB_OK ||
        pl_shatter(world, __func__, body, desc, false, &count) != PLUMB_OK) {
        return -1;
    }
    return count == 0 ? 0 : tell(world, body, parts, capacity);
}
