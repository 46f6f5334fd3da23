// fragments.c - what cells have of a body: its convex pieces, each cut by the borders of the cells, and what of it hangs
// together.
//
// Two fragments of one cell are parts of one body when they touch, or are joined by others that do: union and find
// (Tarjan 1975). Order: pieces as the body has them, cells as they come; so are the numbers of the children.
//
// Reads: pieces of one body. Writes: world->fracture. Cost: O(pieces x cells^2), and O(fragments of a cell, squared) boxes that are compared.
#include "api/fracture.h"

#include "core/memory.h"
#include "plumb/math.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

// [m] what is not farther apart hangs together; of what lies beyond a line by less, nothing is cut off.
#define TOUCHING ((double)PLUMB_LENGTH_MIN)
// [m] what a border of cells takes away that is less is nothing.
#define NOTHING 1e-9

void pl_fracture_free(pl_memory *memory, pl_fracture *fracture)
{
    pl_buffer_free(memory, &fracture->fragments);
    pl_buffer_free(memory, &fracture->parts);
    pl_buffer_free(memory, &fracture->children);
    pl_buffer_free(memory, &fracture->shapes);
    pl_buffer_free(memory, &fracture->before);
    pl_buffer_free(memory, &fracture->breaks);
    pl_buffer_free(memory, &fracture->pieces);
    pl_buffer_free(memory, &fracture->pending);
}

bool pl_fragments_have(const plumb_world *world, uint32_t piece)
{
    const pl_pieces *pieces = &world->pieces;
    return (pieces->flags[piece] & PL_PIECE_SENSOR) == 0 &&
           pieces->shape_kind[piece] != PLUMB_SEGMENT && pieces->shape_kind[piece] != PLUMB_CHAIN;
}

//---- cells ---------------------------------------------------------------------------------------

// What is beyond it is nearer to cell j than to cell i.
static pl_border border(const pl_cells *cells, int i, int j)
{
    if (cells->is_line) {
        const pl_border h = cells->line;
        return i == 0 ? h : (pl_border){ -h.nx, -h.ny, -h.d };
    }
    const double dx = cells->x[j] - cells->x[i], dy = cells->y[j] - cells->y[i];
    const double length = sqrt(dx * dx + dy * dy);
    const double mx = (cells->x[j] + cells->x[i]) / 2, my = (cells->y[j] + cells->y[i]) / 2;
    return (pl_border){ dx / length, dy / length, (dx * mx + dy * my) / length };
}

// Cuts a piece by the borders of a cell. Returns whether anything is left, *whole whether all of it.
static bool take(const pl_cells *cells, int cell, const plumb_convex *convex, pl_region *region,
                 bool *whole)
{
    *whole = true;
    for (int j = 0; j < cells->count && region->count > 2; ++j) {
        if (j == cell) {
            continue;
        }
        const pl_border h = border(cells, cell, j);
        const double beyond = pl_border_beyond(h, convex);
        if (beyond <= (cells->is_line ? TOUCHING : NOTHING)) {
            continue;
        }
        const double within = pl_border_beyond((pl_border){ -h.nx, -h.ny, -h.d }, convex);
        if (within <= (cells->is_line ? TOUCHING : NOTHING)) {
            return false;
        }
        pl_region_clip(region, h);
        *whole = false;
    }
    return region->count > 2;
}

//---- fragments -----------------------------------------------------------------------------------

static bool room_for_one(plumb_world *world)
{
    pl_fracture *f = &world->fracture;
    return pl_buffer_reserve(&world->memory, &f->fragments,
                             ((size_t)f->fragment_count + 1) * sizeof(pl_fragment)) &&
           pl_buffer_reserve(&world->memory, &f->parts,
                             ((size_t)f->part_count + PL_REGION_PARTS) * sizeof(pl_fragment_part));
}

static void measure(pl_fragment *g, const pl_region *region)
{
    g->min_x = g->min_y = HUGE_VAL;
    g->max_x = g->max_y = -HUGE_VAL;
    g->x = g->y = 0;
    for (int k = 0; k < region->count; ++k) {
        g->min_x = pl_smaller(g->min_x, region->x[k]);
        g->max_x = pl_larger(g->max_x, region->x[k]);
        g->min_y = pl_smaller(g->min_y, region->y[k]);
        g->max_y = pl_larger(g->max_y, region->y[k]);
        g->x += region->x[k] / region->count;
        g->y += region->y[k] / region->count;
    }
}

static void add_parts(pl_fracture *f, pl_fragment *g, pl_region *region)
{
    plumb_convex parts[PL_REGION_PARTS];
    uint32_t inner[PL_REGION_PARTS];
    pl_region_clean(region);
    g->part = f->part_count;
    g->parts = (uint32_t)pl_region_parts(region, parts, inner);
    pl_fragment_part *to = (pl_fragment_part *)f->parts.data + f->part_count;
    for (uint32_t k = 0; k < g->parts; ++k) {
        to[k] = (pl_fragment_part){ parts[k], inner[k] };
    }
    f->part_count += g->parts;
}

// What the cells have of one piece.
static bool cut_piece(plumb_world *world, uint32_t piece, const pl_cells *cells)
{
    pl_fracture *f = &world->fracture;
    plumb_convex convex;
    pl_region all, region;
    pl_piece_convex(world, piece, &convex);
    pl_region_of(&convex, world->pieces.cuts[piece], &all);
    const double area = (double)plumb_convex_mass(&convex, 1).mass;
    const double arcs = area / pl_region_area(&all); // 1 of what is not round
    for (int cell = 0; cell < cells->count; ++cell) {
        bool whole;
        region = all;
        if (!take(cells, cell, &convex, &region, &whole)) {
            continue;
        }
        if (!room_for_one(world)) {
            return false;
        }
        pl_fragment g = { .piece = piece, .cell = (uint32_t)cell };
        measure(&g, &region);
        g.area = whole ? area : pl_region_area(&region) * (convex.radius > 0 ? arcs : 1);
        if (!whole) {
            add_parts(f, &g, &region);
        }
        if (whole || g.parts > 0) {
            pl_fragments(world)[f->fragment_count++] = g;
        }
        if (whole) {
            return true; // nothing is left for the other cells
        }
    }
    return true;
}

//---- what hangs together -------------------------------------------------------------------------

static void convex_of(const plumb_world *world, const pl_fragment *g, uint32_t part,
                      plumb_convex *out)
{
    if (g->parts == 0) {
        pl_piece_convex(world, g->piece, out);
    } else {
        *out = pl_fragment_parts(world)[g->part + part].convex;
    }
}

static bool touch(const plumb_world *world, const pl_fragment *a, const pl_fragment *b)
{
    if (a->min_x > b->max_x + TOUCHING || b->min_x > a->max_x + TOUCHING ||
        a->min_y > b->max_y + TOUCHING || b->min_y > a->max_y + TOUCHING) {
        return false;
    }
    const plumb_transform here = { { 0, 0 }, { 1, 0 } };
    for (uint32_t i = 0; i < (a->parts > 0 ? a->parts : 1); ++i) {
        plumb_convex p;
        convex_of(world, a, i, &p);
        for (uint32_t k = 0; k < (b->parts > 0 ? b->parts : 1); ++k) {
            plumb_convex q;
            convex_of(world, b, k, &q);
            if (plumb_convex_distance(&p, here, &q, here).distance <= PLUMB_LENGTH_MIN) {
                return true;
            }
        }
    }
    return false;
}

static uint32_t root_of(pl_fragment *all, uint32_t i)
{
    while (all[i].child != i) {
        all[i].child = all[all[i].child].child;
        i = all[i].child;
    }
    return i;
}

static void unite(plumb_world *world)
{
    pl_fragment *all = pl_fragments(world);
    const uint32_t count = world->fracture.fragment_count;
    for (uint32_t i = 0; i < count; ++i) {
        all[i].child = i;
    }
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t k = 0; k < i; ++k) {
            const uint32_t a = root_of(all, k), b = root_of(all, i);
            if (all[i].cell == all[k].cell && a != b && touch(world, &all[i], &all[k])) {
                all[a < b ? b : a].child = a < b ? a : b; // the first of all is the root
            }
        }
    }
}

static void add_to_child(const plumb_world *world, pl_child *child, const pl_fragment *g)
{
    const double density = (double)world->pieces.density[g->piece];
    const bool is_dynamic = world->bodies.type[world->pieces.body[g->piece]] == PLUMB_DYNAMIC;
    child->area += g->area;
    child->weight += g->area * (is_dynamic ? density : 1);
    child->min_x = pl_smaller(child->min_x, g->min_x);
    child->min_y = pl_smaller(child->min_y, g->min_y);
    child->max_x = pl_larger(child->max_x, g->max_x);
    child->max_y = pl_larger(child->max_y, g->max_y);
}

// Numbers the children in the order of their first fragments.
static bool number(plumb_world *world)
{
    pl_fracture *f = &world->fracture;
    pl_fragment *all = pl_fragments(world);
    if (!pl_buffer_reserve(&world->memory, &f->children,
                           ((size_t)f->fragment_count + 1) * sizeof(pl_child))) {
        return false;
    }
    for (uint32_t i = 0; i < f->fragment_count; ++i) {
        const uint32_t root = root_of(all, i);
        all[i].child = root;
    }
    f->child_count = 0;
    for (uint32_t i = 0; i < f->fragment_count; ++i) {
        // A root comes before what hangs on it, and has its number by then.
        const uint32_t root = all[i].child;
        if (root == i) {
            pl_children(world)[f->child_count] = (pl_child){
                .min_x = HUGE_VAL, .min_y = HUGE_VAL, .max_x = -HUGE_VAL, .max_y = -HUGE_VAL
            };
            all[i].child = f->child_count++;
        } else {
            all[i].child = all[root].child;
        }
        add_to_child(world, &pl_children(world)[all[i].child], &all[i]);
    }
    return true;
}

bool pl_fragments_make(plumb_world *world, uint32_t row, const pl_cells *cells)
{
    pl_fracture *f = &world->fracture;
    f->fragment_count = f->part_count = f->child_count = 0;
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        if (pl_fragments_have(world, p) && !cut_piece(world, p, cells)) {
            return false;
        }
    }
    unite(world);
    return number(world);
}
