// query_grids.c - see query_grids.h.
//
// Reads: poses, pieces, fat boxes, the step's grids and what is due to be filed. Writes: world->query_grids alone.
#include "broad/query_grids.h"

#include "broad/pairs.h"
#include "world/state.h"

#include <string.h>

// All that moves is still in the boxes that it is filed by.
static bool moving_holds(const plumb_world *world)
{
    const pl_broad *broad = &world->broad;
    if (world->pairs_dirty || broad->unfiled || broad->moving_lost) {
        return false;
    }
    const uint32_t *moving = pl_moving(world);
    for (uint32_t i = 0; i < world->moving_count; ++i) {
        pl_box tight = pl_piece_filed_box(world, moving[i]);
        if (!pl_box_contains(&world->pieces.fat[moving[i]], &tight)) {
            return false;
        }
    }
    return true;
}

static bool resting_holds(const plumb_world *world)
{
    const pl_sleep *s = &world->sleep;
    return !s->boxes_stale && !s->grid_stale && !world->broad.resting_lost;
}

static bool fixed_holds(const plumb_world *world)
{
    return !world->static_dirty && !world->broad.fixed_lost;
}

bool pl_step_grids_hold(const plumb_world *world)
{
    return resting_holds(world) && fixed_holds(world) && moving_holds(world);
}

static pl_grid *own_grids(const pl_query_grid_set *set)
{
    return set->grids.data;
}

static bool reserve(plumb_world *world)
{
    pl_query_grid_set *set = &world->query_grids;
    const uint32_t slots = world->pieces.table.count;
    const size_t bytes = PL_QUERY_GRID_COUNT * sizeof(pl_grid);
    if (set->grids.data == NULL) {
        if (!pl_buffer_reserve(&world->memory, &set->grids, bytes)) {
            return false;
        }
        memset(set->grids.data, 0, bytes);
    }
    return pl_buffer_reserve(&world->memory, &set->boxes, slots * sizeof(pl_box));
}

static bool file(plumb_world *world, pl_query_grid which, const uint32_t *pieces, uint32_t count)
{
    pl_query_grid_set *set = &world->query_grids;
    pl_box *boxes = set->boxes.data;
    for (uint32_t i = 0; i < count; ++i) {
        boxes[pieces[i]] = pl_piece_filed_box(world, pieces[i]);
    }
    return pl_grid_build(&world->memory, NULL, &own_grids(set)[which], pieces, count, boxes);
}

static bool file_fixed(plumb_world *world)
{
    pl_buffer *list = &world->query_grids.list;
    uint32_t count;
    return pl_broad_list_fixed(world, list, &count) &&
           file(world, PL_QUERY_FIXED, list->data, count);
}

// Those of the strays that are still there, in a grid of their own. What the other grids say of them is where they were: a query
// asks each piece by its pose, so it hears of them twice at most, or not at all (pl_query_sees).
static bool file_strays(plumb_world *world)
{
    pl_query_grid_set *set = &world->query_grids;
    uint32_t there[PL_QUERY_STRAYS_MOST], count = 0;
    for (uint32_t i = 0; i < set->stray_count; ++i) {
        const uint32_t p = ((const uint32_t *)set->strays.data)[i];
        there[count] = p;
        count += world->pieces.kind[p] != PL_PIECE_FREE && world->pieces.moving[p] != PL_OUT;
    }
    set->strays_filed = reserve(world) && file(world, PL_QUERY_STRAYS, there, count);
    return set->strays_filed;
}

bool pl_query_grids_update(plumb_world *world)
{
    pl_query_grid_set *set = &world->query_grids;
    if (set->fresh) {
        return set->strays_filed || file_strays(world);
    }
    set->stray_count = 0;
    set->strays_filed = true;
    bool *owns = set->owns;
    owns[PL_QUERY_MOVING] = !moving_holds(world);
    owns[PL_QUERY_RESTING] = !resting_holds(world);
    owns[PL_QUERY_FIXED] = !fixed_holds(world);
    bool any = owns[PL_QUERY_MOVING] || owns[PL_QUERY_RESTING] || owns[PL_QUERY_FIXED];
    set->fresh =
        pl_buffer_reserve(&world->memory, &set->strays, PL_QUERY_STRAYS_MOST * sizeof(uint32_t)) &&
        (!any ||
         (reserve(world) &&
          (!owns[PL_QUERY_MOVING] ||
           file(world, PL_QUERY_MOVING, pl_moving(world), world->moving_count)) &&
          (!owns[PL_QUERY_RESTING] ||
           file(world, PL_QUERY_RESTING, pl_resting(&world->sleep), world->sleep.resting_count)) &&
          (!owns[PL_QUERY_FIXED] || file_fixed(world))));
    return set->fresh;
}

bool pl_query_grids_file_all(plumb_world *world)
{
    world->query_grids.fresh &= world->query_grids.stray_count == 0;
    return pl_query_grids_update(world);
}

const pl_grid *pl_query_grid_of(const plumb_world *world, pl_query_grid which)
{
    const pl_broad *broad = &world->broad;
    const pl_grid *filed[] = { &broad->moving, &broad->resting, &broad->fixed };
    const bool is_own = which == PL_QUERY_STRAYS || world->query_grids.owns[which];
    return is_own ? &own_grids(&world->query_grids)[which] : filed[which];
}

void pl_query_grids_free(pl_memory *memory, pl_query_grid_set *set)
{
    for (int i = 0; set->grids.data != NULL && i < PL_QUERY_GRID_COUNT; ++i) {
        pl_grid_free(memory, &own_grids(set)[i]);
    }
    pl_buffer_free(memory, &set->grids);
    pl_buffer_free(memory, &set->boxes);
    pl_buffer_free(memory, &set->list);
    pl_buffer_free(memory, &set->strays);
    *set = (pl_query_grid_set){ 0 };
}
