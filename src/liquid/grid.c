// grid.c - the cells of tiles, and the particles sorted by cell.
//
// Cells know their neighbours by index; cell 0 stands for all that lie in no tile.
//
// Reads: particles, strays. Writes: tiles, columns of cells, points. Cost: O(particles + cells).
#include "liquid/liquid.h"

#include <string.h>

#define FEWEST 2048 // particles that are worth a thread

int32_t pl_liquid_floor(double cells, near_real *fraction)
{
    const double most = PL_LIQUID_MOST_CELL;
    cells = cells > most ? most : cells >= -most ? cells : -most;
    int32_t i = (int32_t)cells;
    i -= (double)i > cells;
    *fraction = (near_real)(cells - (double)i);
    return i;
}

//---- cells ---------------------------------------------------------------------------------------

uint32_t pl_liquid_cell_at(const pl_liquid_grid *g, int32_t i, int32_t j)
{
    const uint32_t first = pl_liquid_tile_first(g, pl_liquid_tile_of(i), pl_liquid_tile_of(j));
    return first == 0 ? 0 : first + (uint32_t)((j & 15) * PL_LIQUID_SIDE + (i & 15));
}

// One block of memory, a column behind the other. Cell 0 is zero in all of them.
static bool make_columns(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    const uint32_t n = 1 + g->tile_count * PL_LIQUID_TILE;
    size_t bytes = 0;
#define SIZE(type)       (((n + 1) * sizeof(type) + PL_ALIGN - 1) / PL_ALIGN * PL_ALIGN)
#define ROOM(type, name) bytes += SIZE(type);
    PL_LIQUID_ZEROED(ROOM)
    const size_t zeroed = bytes;
    PL_LIQUID_WRITTEN(ROOM)
    if (!pl_buffer_reserve(memory, &scratch->cells, bytes)) {
        return false;
    }
    memset(scratch->cells.data, 0, zeroed);
    char *at = scratch->cells.data;
#define CARVE(type, name)                                                                          \
    g->name = (type *)(void *)at;                                                                  \
    g->name[0] = 0;                                                                                \
    at += SIZE(type);
    PL_LIQUID_COLUMNS(CARVE)
    g->cell_count = n;
    return true;
}

static void link_tile(pl_liquid_grid *g, uint32_t t)
{
    const pl_liquid_tile *tile = &g->tiles[t];
    const uint32_t side = PL_LIQUID_SIDE, first = 1 + t * PL_LIQUID_TILE;
    const uint32_t left = pl_liquid_tile_first(g, tile->x - 1, tile->y);
    const uint32_t right = pl_liquid_tile_first(g, tile->x + 1, tile->y);
    const uint32_t down = pl_liquid_tile_first(g, tile->x, tile->y - 1);
    const uint32_t up = pl_liquid_tile_first(g, tile->x, tile->y + 1);
    for (uint32_t c = first; c < first + PL_LIQUID_TILE; ++c) {
        g->left[c] = c - 1;
        g->right[c] = c + 1;
        g->down[c] = c - side;
        g->up[c] = c + side;
    }
    for (uint32_t k = 0; k < side; ++k) {
        const uint32_t line = k * side, top = PL_LIQUID_TILE - side;
        g->left[first + line] = left != 0 ? left + line + side - 1 : 0;
        g->right[first + line + side - 1] = right != 0 ? right + line : 0;
        g->down[first + k] = down != 0 ? down + top + k : 0;
        g->up[first + top + k] = up != 0 ? up + k : 0;
    }
}

void pl_liquid_cells(pl_liquid_grid *g, pl_range_fn *range)
{
    pl_tasks_ranges(g->tasks, g->cell_count - 1, 2048, range, g);
}

//---- points --------------------------------------------------------------------------------------

// Of a build, for its threads.
typedef struct build {
    pl_liquid_grid *g;
    const plumb_particle *particles;
    const uint8_t *strays; // null: there are none
    pl_liquid_spot *spots;
    const pl_liquid_home *homes;
    double scale;
} build;

static void spot_range(void *context, uint32_t first, uint32_t count)
{
    const build *b = context;
    for (uint32_t k = first; k < first + count; ++k) {
        pl_liquid_spot *s = &b->spots[k];
        s->i = pl_liquid_floor((double)b->particles[k].position.x * b->scale, &s->fx);
        s->j = pl_liquid_floor((double)b->particles[k].position.y * b->scale, &s->fy);
    }
}

bool pl_liquid_find_spots(pl_memory *memory, pl_liquid_scratch *scratch,
                          const plumb_particle *particles, uint32_t count)
{
    pl_liquid_grid *g = &scratch->grid;
    if (!pl_buffer_reserve(memory, &scratch->spots, (count + 1) * sizeof(pl_liquid_spot))) {
        return false;
    }
    build b = { g, particles, NULL, scratch->spots.data, NULL, 1 / (double)g->h };
    pl_tasks_ranges(g->tasks, count, FEWEST, spot_range, &b);
    return pl_liquid_find_homes(memory, scratch, count);
}

static void cell_range(void *context, uint32_t first, uint32_t count)
{
    const build *b = context;
    for (uint32_t k = first; k < first + count; ++k) {
        pl_liquid_spot *s = &b->spots[k];
        const uint32_t place = (uint32_t)((s->j & 15) * PL_LIQUID_SIDE + (s->i & 15));
        const bool strays = b->strays != NULL && b->strays[k];
        s->cell = strays ? 0 : 1 + b->homes[s->cell].tile * PL_LIQUID_TILE + place;
    }
}

static void point_range(void *context, uint32_t first, uint32_t count)
{
    const build *b = context;
    const near_real h = b->g->h;
    for (uint32_t k = first; k < first + count; ++k) {
        const pl_liquid_spot *s = &b->spots[k];
        const plumb_particle *p = &b->particles[k];
        if (s->cell == 0) {
            continue;
        }
        b->g->points[s->place] = (pl_liquid_point){
            .fx = s->fx,
            .fy = s->fy,
            .u = (near_real)p->velocity.x,
            .v = (near_real)p->velocity.y,
            .slope = { (near_real)p->gradient[0] * h, (near_real)p->gradient[1] * h,
                       (near_real)p->gradient[2] * h, (near_real)p->gradient[3] * h },
            .cell = s->cell,
            .index = k,
        };
        if (b->g->mixture != NULL) {
            b->g->mixture->phases[s->place] = (uint8_t)p->phase;
        }
    }
}

// By counting: `first` of a cell runs through its places, and is put back to where they begin.
static bool sort_points(pl_memory *memory, pl_liquid_scratch *scratch, build *b, uint32_t count)
{
    pl_liquid_grid *g = &scratch->grid;
    if (!pl_buffer_reserve(memory, &scratch->points, (count + 1) * sizeof(pl_liquid_point))) {
        return false;
    }
    g->points = scratch->points.data;
    if (g->mixture != NULL && !pl_buffer_reserve(memory, &scratch->phases, count + 1)) {
        return false;
    }
    scratch->mixture.phases = scratch->phases.data;
    pl_tasks_ranges(g->tasks, count, FEWEST, cell_range, b);
    for (uint32_t k = 0; k < count; ++k) {
        ++g->first[b->spots[k].cell];
    }
    g->first[0] = 0;
    g->point_count = pl_counts_to_places(g->first, g->cell_count, 0);
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t c = b->spots[k].cell;
        b->spots[k].place = c != 0 ? g->first[c]++ : 0;
    }
    memmove(g->first + 1, g->first, g->cell_count * sizeof *g->first);
    g->first[0] = 0;
    pl_tasks_ranges(g->tasks, count, FEWEST, point_range, b);
    return true;
}

static void link_range(void *context, uint32_t first, uint32_t count)
{
    for (uint32_t t = first; t < first + count; ++t) {
        link_tile(context, t);
    }
}

bool pl_liquid_make_cells(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    if (!make_columns(memory, scratch)) {
        return false;
    }
    pl_tasks_ranges(g->tasks, g->tile_count, 8, link_range, g);
    return true;
}

bool pl_liquid_grid_build(pl_memory *memory, pl_liquid_scratch *scratch,
                          const plumb_particle *particles, uint32_t count)
{
    pl_liquid_grid *g = &scratch->grid;
    build b = {
        g, particles, g->strays, scratch->spots.data, scratch->homes.data, 1 / (double)g->h
    };
    if (!pl_liquid_find_tiles(memory, scratch) || !pl_liquid_make_cells(memory, scratch) ||
        (g->mixture != NULL && !pl_liquid_make_mixture(memory, scratch))) {
        return false;
    }
    return sort_points(memory, scratch, &b, count);
}

void pl_liquid_free_arrays(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_buffer *all[] = {
        &scratch->moved,   &scratch->pushes,     &scratch->cells,       &scratch->tiles,
        &scratch->hash,    &scratch->keys,       &scratch->points,      &scratch->spots,
        &scratch->strays,  &scratch->occupied,   &scratch->viscous,     &scratch->blocks,
        &scratch->strips,  &scratch->vectors,    &scratch->sums,        &scratch->bodies,
        &scratch->links,   &scratch->solids,     &scratch->tile_solids, &scratch->phases,
        &scratch->blends,  &scratch->mixed,      &scratch->rooms,       &scratch->room_cells,
        &scratch->order,   &scratch->supports,   &scratch->joined,      &scratch->nodes,
        &scratch->rings,   &scratch->softbodies, &scratch->soft_links,  &scratch->sides,
        &scratch->touches, &scratch->tension,    &scratch->rims,        &scratch->granular,
        &scratch->homes
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) {
        pl_buffer_free(memory, all[i]);
    }
    scratch->slots = 0;
}

void pl_liquid_free(pl_memory *memory, pl_liquid *liquid)
{
    if (liquid->scratch != NULL) {
        pl_liquid_scratch copy = *liquid->scratch;
        pl_liquid_free_arrays(memory, &copy);
        pl_resize(memory, liquid->scratch, sizeof *liquid->scratch, 0);
    }
    pl_buffer_free(memory, &liquid->settings);
    pl_buffer_free(memory, &liquid->particles);
    pl_buffer_free(memory, &liquid->phases);
    pl_buffer_free(memory, &liquid->supports.items);
    pl_buffer_free(memory, &liquid->contacts);
    pl_buffer_free(memory, &liquid->ends);
    pl_buffer_free(memory, &liquid->index.heads);
    pl_buffer_free(memory, &liquid->index.next);
    *liquid = (pl_liquid){ .count = 0 };
}
