// tiles.c - which tiles of cells there are.
//
// A world has no end, so there is no box of cells: tiles of 16 x 16 lie where particles are, and as far around as
// the kernels look. They are sorted by their places, so neither memory nor the order of insertion decides anything.
//
// Reads: spots, strays. Writes: homes, tiles and their table. Cost: O(particles + tiles).
#include "liquid/liquid.h"

#include <string.h>

#define LEAST_SLOTS 64
#define RECENT      64 // homes that are remembered, and how many of these lie in a line
#define RECENT_LINE 16

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

bool pl_liquid_add_tile(pl_memory *memory, pl_liquid_scratch *scratch, int32_t x, int32_t y)
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

bool pl_liquid_clear_tiles(pl_memory *memory, pl_liquid_scratch *scratch)
{
    scratch->grid.tile_count = 0;
    return resize(memory, scratch, scratch->slots > LEAST_SLOTS ? scratch->slots : LEAST_SLOTS);
}

uint32_t pl_liquid_tile_at(const pl_liquid_scratch *scratch, int32_t x, int32_t y)
{
    const entry *slot = slot_of(scratch, key_of(x, y));
    return slot->taken != 0 ? slot->tile : PL_LIQUID_NONE;
}

bool pl_liquid_sort_tiles(pl_memory *memory, pl_liquid_scratch *scratch)
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

uint32_t pl_liquid_tile_first(const pl_liquid_grid *g, int32_t x, int32_t y)
{
    const pl_liquid_scratch view = { .hash = { g->hash, 0 }, .slots = g->slots };
    const entry *slot = slot_of(&view, key_of(x, y));
    return slot->taken != 0 ? 1 + slot->tile * PL_LIQUID_TILE : 0;
}

//---- round particles -----------------------------------------------------------------------------

// Bits of the tiles that the surroundings of a cell reach into.
static uint32_t around_of(int32_t i, int32_t j)
{
    const int32_t x = i & (PL_LIQUID_SIDE - 1), y = j & (PL_LIQUID_SIDE - 1);
    const int32_t near = PL_LIQUID_REACH, far = PL_LIQUID_SIDE - PL_LIQUID_REACH;
    const uint32_t columns = (x < near) | 2U | (uint32_t)(x >= far) << 2;
    const uint32_t lines = (y < near) | 8U | (uint32_t)(y >= far) << 6;
    return columns * lines;
}

static bool add_home(pl_memory *memory, pl_liquid_scratch *scratch, int32_t x, int32_t y)
{
    if (!pl_liquid_add_tile(memory, scratch, x, y)) {
        return false;
    }
    const uint32_t count = scratch->grid.tile_count;
    if (count > scratch->home_count) {
        if (!pl_buffer_reserve(memory, &scratch->homes, count * sizeof(pl_liquid_home))) {
            return false;
        }
        pl_liquid_home *homes = scratch->homes.data;
        homes[scratch->home_count++] = (pl_liquid_home){ .x = x, .y = y, .lively = true };
    }
    return true;
}

bool pl_liquid_find_homes(pl_memory *memory, pl_liquid_scratch *scratch, uint32_t count)
{
    const uint8_t *strays = scratch->grid.strays;
    pl_liquid_spot *spots = scratch->spots.data;
    struct {
        uint64_t key;
        uint32_t home;
    } recent[RECENT];
    if (!pl_liquid_clear_tiles(memory, scratch)) {
        return false;
    }
    scratch->home_count = 0;
    for (uint32_t i = 0; i < RECENT; ++i) {
        recent[i].key = UINT64_MAX; // no tile has it
    }
    for (uint32_t k = 0; k < count; ++k) {
        if (strays != NULL && strays[k]) {
            continue;
        }
        const int32_t x = pl_liquid_tile_of(spots[k].i), y = pl_liquid_tile_of(spots[k].j);
        const uint64_t key = key_of(x, y);
        const uint32_t slot = (uint32_t)(x + RECENT_LINE * y) & (RECENT - 1);
        if (recent[slot].key != key) {
            if (!add_home(memory, scratch, x, y)) {
                return false;
            }
            recent[slot].key = key;
            recent[slot].home = pl_liquid_tile_at(scratch, x, y);
        }
        pl_liquid_home *home = (pl_liquid_home *)scratch->homes.data + recent[slot].home;
        ++home->points;
        home->around |= around_of(spots[k].i, spots[k].j);
        spots[k].cell = recent[slot].home;
    }
    return true;
}

static bool add_around(pl_memory *memory, pl_liquid_scratch *scratch, const pl_liquid_home *home)
{
    for (int32_t i = 0; i < 9; ++i) {
        if ((home->around >> i & 1) != 0 &&
            !pl_liquid_add_tile(memory, scratch, home->x + i % 3 - 1, home->y + i / 3 - 1)) {
            return false;
        }
    }
    return true;
}

bool pl_liquid_find_tiles(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_home *homes = scratch->homes.data;
    if (!pl_liquid_clear_tiles(memory, scratch)) {
        return false;
    }
    for (uint32_t i = 0; i < scratch->home_count; ++i) {
        if (homes[i].lively && !add_around(memory, scratch, &homes[i])) {
            return false;
        }
    }
    if (!pl_liquid_sort_tiles(memory, scratch)) {
        return false;
    }
    for (uint32_t i = 0; i < scratch->home_count; ++i) {
        homes[i].tile = pl_liquid_tile_at(scratch, homes[i].x, homes[i].y);
    }
    return true;
}
