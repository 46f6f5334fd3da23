// broad.c - the broad phase as a whole: fat boxes, grids, and when to rebuild the pair list.
#include "broad/broad.h"

#include "world/marks.h"
#include "broad/pairs.h"
#include "world/state.h"

bool pl_broad_list_fixed(plumb_world *world, pl_buffer *list, uint32_t *count)
{
    const pl_pieces *pieces = &world->pieces;
    if (!pl_buffer_reserve(&world->memory, list, pieces->table.count * sizeof(uint32_t))) {
        return false;
    }
    uint32_t *to = list->data;
    *count = 0;
    for (uint32_t piece = 0; piece < pieces->table.count; ++piece) {
        if (pieces->kind[piece] != PL_PIECE_FREE && pieces->moving[piece] == PL_NONE) {
            to[(*count)++] = piece;
        }
    }
    return true;
}

static bool file_fixed(plumb_world *world)
{
    pl_broad *broad = &world->broad;
    uint32_t count;
    return pl_broad_list_fixed(world, &broad->list, &count) &&
           pl_grid_build(&world->memory, world->tasks, &broad->fixed, broad->list.data, count,
                         world->pieces.fat) &&
           pl_grid_make_maps(&world->memory, &broad->fixed);
}

bool pl_broad_update_resting(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    pl_grid *grid = &world->broad.resting;
    if (s->boxes_stale) {
        pl_broad_refresh_resting(world);
        s->boxes_stale = false;
        s->grid_stale = true;
    }
    // Entries of pieces that woke are passed over; when they are the half, it is filed anew.
    if (!s->grid_stale && !world->broad.resting_lost && s->gone <= grid->entry_count / 2) {
        return true;
    }
    if (!pl_grid_build(&world->memory, world->tasks, grid, pl_resting(s), s->resting_count,
                       world->pieces.fat) ||
        !pl_grid_make_maps(&world->memory, grid)) {
        s->grid_stale = true;
        return false;
    }
    s->gone = 0;
    s->grid_stale = world->broad.resting_lost = false;
    s->near_stale = true;
    return true;
}

bool pl_broad_update_grids(plumb_world *world, real dt, bool *stale)
{
    pl_broad *broad = &world->broad;
    if (world->static_dirty) {
        pl_broad_refresh_fixed(world);
        if (!file_fixed(world)) {
            return false;
        }
        world->static_dirty = false;
        world->pairs_dirty = true;
        if (world->asleep_count > 0) {
            pl_sensing_note_rest(world);
        }
    } else if (broad->fixed_lost && !file_fixed(world)) {
        return false;
    }
    broad->fixed_lost = false;
    if (!pl_broad_update_resting(world)) {
        return false;
    }
    if (!broad->refreshed) {
        pl_broad_refresh_moving(world, dt);
    }
    if (world->pairs_dirty || broad->unfiled || broad->moving_lost) {
        if (!pl_grid_build(&world->memory, world->tasks, &broad->moving, pl_moving(world),
                           world->moving_count, world->pieces.fat) ||
            !pl_grid_make_lanes(&world->memory, world->tasks, &broad->moving)) {
            return false;
        }
        broad->stale = broad->stale || world->pairs_dirty;
        world->pairs_dirty = broad->unfiled = broad->moving_lost = false;
    }
    *stale = pl_broad_is_stale(broad);
    return true;
}

// So many pairs are worth a thread.
#define LEAST 1024

// Rows moved but no piece came or went: pairs stay, their rows are looked up again.
static void refresh_rows(void *context, uint32_t first, uint32_t count)
{
    const plumb_world *world = context;
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (uint32_t i = first; i < first + count; ++i) {
        pairs[i].body_a = world->pieces.body[pairs[i].a];
        pairs[i].body_b = world->pieces.body[pairs[i].b];
    }
}

bool pl_broad_update(plumb_world *world, real dt, const pl_pair_listener *listener)
{
    bool stale;
    if (!pl_broad_update_grids(world, dt, &stale)) {
        return false;
    }
    if (stale && !pl_pairs_update(world, listener)) {
        return false;
    }
    if (world->rows_moved) {
        pl_tasks_ranges(world->tasks, world->broad.pairs.count, LEAST, refresh_rows, world);
    }
    world->rows_moved = false;
    world->sleep.tested_step = world->step_count + 1;
    return true;
}

void pl_broad_free(pl_memory *memory, pl_broad *broad)
{
    pl_grid_free(memory, &broad->moving);
    pl_grid_free(memory, &broad->fixed);
    pl_grid_free(memory, &broad->resting);
    pl_buffer_free(memory, &broad->pairs.items);
    pl_buffer_free(memory, &broad->pairs.old_items);
    pl_buffer_free(memory, &broad->left);
    pl_buffer_free(memory, &broad->left_marks);
    pl_buffer_free(memory, &broad->list);
    pl_buffer_free(memory, &broad->found);
    pl_buffer_free(memory, &broad->sorted);
    pl_buffer_free(memory, &broad->sensed);
    pl_buffer_free(memory, &broad->counts);
    pl_buffer_free(memory, &broad->lost);
    *broad = (pl_broad){ 0 };
}
