// grid.c - sparse tiles of cells round the particles, and the particles sorted by cell.
//
// A world has no end, so there is no box of cells: tiles of 16 x 16 lie where particles are, and as far around as
// the kernels look. Cells know their neighbours by index; cell 0 stands for all that lie in no tile. Tiles are
// sorted by their places, so neither memory nor the order of insertion decides anything.
//
// Reads: particles. Writes: tiles, columns of cells, points. Cost: O(particles + cells).
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

static int32_t tile_of(int32_t cell)
{
    return cell >> 4;
}

static uint64_t key_of(int32_t x, int32_t y)
{
    return pl_key((uint32_t)y + (UINT32_C(1) << 31), (uint32_t)x + (UINT32_C(1) << 31));
}

//---- the table of tiles --------------------------------------------------------------------------

// Open addressing; capacity is a power of 2, at most half full.
typedef struct entry {
    uint64_t key;
    uint32_t tile;
    uint32_t taken;
} entry;

static entry *slot_of(const pl_liquid_scratch *scratch, uint64_t key)
{
    entry *table = scratch->hash.data;
    const uint32_t mask = scratch->slots - 1;
    uint32_t slot = (uint32_t)((key * UINT64_C(0x9e3779b97f4a7c15)) >> 40) & mask;
    while (table[slot].taken != 0 && table[slot].key != key) {
        slot = (slot + 1) & mask;
    }
    return &table[slot];
}

static bool resize(pl_memory *memory, pl_liquid_scratch *scratch, uint32_t slots)
{
    if (!pl_buffer_reserve(memory, &scratch->hash, slots * sizeof(entry))) {
        return false;
    }
    memset(scratch->hash.data, 0, slots * sizeof(entry));
    scratch->slots = slots;
    const pl_liquid_tile *tiles = scratch->grid.tiles;
    for (uint32_t i = 0; i < scratch->grid.tile_count; ++i) {
        *slot_of(scratch, tiles[i].key) = (entry){ tiles[i].key, i, 1 };
    }
    return true;
}

static bool add_tile(pl_memory *memory, pl_liquid_scratch *scratch, int32_t x, int32_t y)
{
    pl_liquid_grid *g = &scratch->grid;
    const uint64_t key = key_of(x, y);
    entry *slot = slot_of(scratch, key);
    if (slot->taken != 0) {
        return true;
    }
    const uint32_t i = g->tile_count;
    if (!pl_buffer_reserve(memory, &scratch->tiles, (i + 1) * sizeof(pl_liquid_tile))) {
        return false;
    }
    g->tiles = scratch->tiles.data;
    g->tiles[i] = (pl_liquid_tile){ .key = key, .x = x, .y = y };
    *slot = (entry){ key, i, 1 };
    ++g->tile_count;
    return 2 * g->tile_count <= scratch->slots || resize(memory, scratch, 2 * scratch->slots);
}

static bool find_tiles(pl_memory *memory, pl_liquid_scratch *scratch, uint32_t count)
{
    const pl_liquid_spot *spots = scratch->spots.data;
    uint64_t last = 0;
    for (uint32_t k = 0; k < count; ++k) {
        const int32_t i = spots[k].i, j = spots[k].j;
        const int32_t x = tile_of(i - PL_LIQUID_REACH), y = tile_of(j - PL_LIQUID_REACH);
        const int32_t right = tile_of(i + PL_LIQUID_REACH), top = tile_of(j + PL_LIQUID_REACH);
        const uint64_t seen = key_of(x, y) * 4 + (uint64_t)(2 * (right - x) + (top - y)) + 1;
        if (seen == last) {
            continue;
        }
        last = seen;
        if (!add_tile(memory, scratch, x, y) || !add_tile(memory, scratch, right, y) ||
            !add_tile(memory, scratch, x, top) || !add_tile(memory, scratch, right, top)) {
            return false;
        }
    }
    return true;
}

static bool sort_tiles(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    const uint32_t n = g->tile_count;
    if (!pl_buffer_reserve(memory, &scratch->keys, n * sizeof(pl_keyed))) {
        return false;
    }
    pl_keyed *keys = scratch->keys.data;
    for (uint32_t i = 0; i < n; ++i) {
        keys[i] = (pl_keyed){ .key = g->tiles[i].key, .value = i };
    }
    pl_sort_keyed(keys, n);
    g->low_x = g->low_y = INT32_MAX;
    g->high_x = g->high_y = INT32_MIN;
    for (uint32_t i = 0; i < n; ++i) {
        const int32_t x = (int32_t)((uint32_t)keys[i].key - (UINT32_C(1) << 31));
        const int32_t y = (int32_t)((uint32_t)(keys[i].key >> 32) - (UINT32_C(1) << 31));
        g->tiles[i] = (pl_liquid_tile){ .key = keys[i].key, .x = x, .y = y };
        slot_of(scratch, keys[i].key)->tile = i;
        g->low_x = x < g->low_x ? x : g->low_x, g->high_x = x > g->high_x ? x : g->high_x;
        g->low_y = y < g->low_y ? y : g->low_y, g->high_y = y > g->high_y ? y : g->high_y;
    }
    g->hash = scratch->hash.data;
    g->slots = scratch->slots;
    return true;
}

//---- cells ---------------------------------------------------------------------------------------

static uint32_t first_cell(const pl_liquid_grid *g, int32_t x, int32_t y)
{
    const pl_liquid_scratch view = { .hash = { g->hash, 0 }, .slots = g->slots };
    const entry *slot = slot_of(&view, key_of(x, y));
    return slot->taken != 0 ? 1 + slot->tile * PL_LIQUID_TILE : 0;
}

uint32_t pl_liquid_cell_at(const pl_liquid_grid *g, int32_t i, int32_t j)
{
    const uint32_t first = first_cell(g, tile_of(i), tile_of(j));
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
    const uint32_t left = first_cell(g, tile->x - 1, tile->y);
    const uint32_t right = first_cell(g, tile->x + 1, tile->y);
    const uint32_t down = first_cell(g, tile->x, tile->y - 1);
    const uint32_t up = first_cell(g, tile->x, tile->y + 1);
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
    pl_liquid_spot *spots;
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

static void cell_range(void *context, uint32_t first, uint32_t count)
{
    const build *b = context;
    int32_t x = INT32_MAX, y = INT32_MAX; // no tile has these
    uint32_t tile = 0;
    for (uint32_t k = first; k < first + count; ++k) {
        pl_liquid_spot *s = &b->spots[k];
        if (tile_of(s->i) != x || tile_of(s->j) != y) {
            x = tile_of(s->i);
            y = tile_of(s->j);
            tile = first_cell(b->g, x, y);
        }
        s->cell = tile + (uint32_t)((s->j & 15) * PL_LIQUID_SIDE + (s->i & 15));
    }
}

static void point_range(void *context, uint32_t first, uint32_t count)
{
    const build *b = context;
    const near_real h = b->g->h;
    for (uint32_t k = first; k < first + count; ++k) {
        const pl_liquid_spot *s = &b->spots[k];
        const plumb_particle *p = &b->particles[k];
        b->g->points[s->place] = (pl_liquid_point){
            .fx = s->fx,
            .fy = s->fy,
            .u = (near_real)p->velocity.x,
            .v = (near_real)p->velocity.y,
            .ux = (near_real)p->gradient[0] * h,
            .uy = (near_real)p->gradient[1] * h,
            .vx = (near_real)p->gradient[2] * h,
            .vy = (near_real)p->gradient[3] * h,
            .cell = s->cell,
            .index = k,
        };
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
    pl_tasks_ranges(g->tasks, count, FEWEST, cell_range, b);
    for (uint32_t k = 0; k < count; ++k) {
        ++g->first[b->spots[k].cell];
    }
    pl_counts_to_places(g->first, g->cell_count, 0);
    for (uint32_t k = 0; k < count; ++k) {
        b->spots[k].place = g->first[b->spots[k].cell]++;
    }
    memmove(g->first + 1, g->first, g->cell_count * sizeof *g->first);
    g->first[0] = 0;
    pl_tasks_ranges(g->tasks, count, FEWEST, point_range, b);
    g->point_count = count;
    return true;
}

static void link_range(void *context, uint32_t first, uint32_t count)
{
    for (uint32_t t = first; t < first + count; ++t) {
        link_tile(context, t);
    }
}

bool pl_liquid_grid_build(pl_memory *memory, pl_liquid_scratch *scratch,
                          const plumb_particle *particles, uint32_t count, double h)
{
    pl_liquid_grid *g = &scratch->grid;
    g->tile_count = 0;
    g->h = (near_real)h;
    if (!pl_buffer_reserve(memory, &scratch->spots, (count + 1) * sizeof(pl_liquid_spot))) {
        return false;
    }
    build b = { g, particles, scratch->spots.data, 1 / h };
    pl_tasks_ranges(g->tasks, count, FEWEST, spot_range, &b);
    if (!resize(memory, scratch, scratch->slots > 64 ? scratch->slots : 64) ||
        !find_tiles(memory, scratch, count) || !sort_tiles(memory, scratch) ||
        !make_columns(memory, scratch)) {
        return false;
    }
    pl_tasks_ranges(g->tasks, g->tile_count, 8, link_range, g);
    return sort_points(memory, scratch, &b, count);
}

void pl_liquid_free_arrays(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_buffer *all[] = { &scratch->moved,  &scratch->pushes,     &scratch->cells,
                         &scratch->tiles,  &scratch->hash,       &scratch->keys,
                         &scratch->points, &scratch->spots,      &scratch->occupied,
                         &scratch->blocks, &scratch->strips,     &scratch->vectors,
                         &scratch->sums,   &scratch->bodies,     &scratch->links,
                         &scratch->solids, &scratch->tile_solids };
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
    *liquid = (pl_liquid){ .count = 0 };
}
