// cells.c - which cells of the grids are in use, for drawing. Reads: both grids. Cost: O(pieces);
// entries of one cell lie in one bucket, side by side but for the cells that share it.
#include "broad/broad.h"
#include "world/state.h"

// An entry before this one, back to the start of its bucket, lies in the same cell.
static bool is_known(const pl_grid_level *level, const pl_grid_entry *entries, uint32_t i)
{
    const pl_grid_entry *e = &entries[i];
    for (uint32_t k = i; k > level->first; --k) {
        const pl_grid_entry *other = &entries[k - 1];
        if (pl_grid_bucket(level, other->cell_x, other->cell_y) !=
            pl_grid_bucket(level, e->cell_x, e->cell_y)) {
            return false;
        }
        if (other->cell_x == e->cell_x && other->cell_y == e->cell_y) {
            return true;
        }
    }
    return false;
}

static int cells_of(const pl_grid *grid, plumb_aabb *cells, int count, int capacity)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    for (uint32_t l = 0; l < grid->level_count; ++l) {
        const pl_grid_level *level = &grid->levels[l];
        for (uint32_t i = level->first; i < level->first + level->count; ++i) {
            if (is_known(level, entries, i)) {
                continue;
            }
            if (cells != NULL && count < capacity) {
                double x = entries[i].cell_x * level->cell, y = entries[i].cell_y * level->cell;
                cells[count] = (plumb_aabb){ { (real)x, (real)y },
                                             { (real)(x + level->cell), (real)(y + level->cell) } };
            }
            ++count;
        }
    }
    return count;
}

int plumb_world_cells(const plumb_world *world, plumb_aabb *cells, int capacity)
{
    if (world == NULL) {
        return 0;
    }
    int count = cells_of(&world->broad.moving, cells, 0, capacity);
    return cells_of(&world->broad.fixed, cells, count, capacity);
}
