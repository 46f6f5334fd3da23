// sight.c - see sight.h.
//
// Reads: poses, pieces, fat boxes, the step's grids and what is due to be filed. Writes: world->sight alone.
#include "broad/sight.h"
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

static pl_grid *own_grids(const pl_sight *sight)
{
    return sight->grids.data;
}

static bool reserve(plumb_world *world)
{
    pl_sight *sight = &world->sight;
    const uint32_t slots = world->pieces.table.count;
    const size_t bytes = PL_SIGHT_GRIDS * sizeof(pl_grid);
    if (sight->grids.data == NULL) {
        if (!pl_buffer_reserve(&world->memory, &sight->grids, bytes)) {
            return false;
        }
        memset(sight->grids.data, 0, bytes);
    }
    return pl_buffer_reserve(&world->memory, &sight->boxes, slots * sizeof(pl_box));
}

static bool file(plumb_world *world, pl_sight_grid which, const uint32_t *pieces, uint32_t count)
{
    pl_sight *sight = &world->sight;
    pl_box *boxes = sight->boxes.data;
    for (uint32_t i = 0; i < count; ++i) {
        boxes[pieces[i]] = pl_piece_filed_box(world, pieces[i]);
    }
    return pl_grid_build(&world->memory, NULL, &own_grids(sight)[which], pieces, count, boxes);
}

static bool file_fixed(plumb_world *world)
{
    pl_buffer *list = &world->sight.list;
    uint32_t count;
    return pl_broad_list_fixed(world, list, &count) &&
           file(world, PL_SIGHT_FIXED, list->data, count);
}

bool pl_sight_update(plumb_world *world)
{
    pl_sight *sight = &world->sight;
    if (sight->fresh) {
        return true;
    }
    bool *owns = sight->owns;
    owns[PL_SIGHT_MOVING] = !moving_holds(world);
    owns[PL_SIGHT_RESTING] = !resting_holds(world);
    owns[PL_SIGHT_FIXED] = !fixed_holds(world);
    bool any = owns[PL_SIGHT_MOVING] || owns[PL_SIGHT_RESTING] || owns[PL_SIGHT_FIXED];
    sight->fresh =
        !any ||
        (reserve(world) &&
         (!owns[PL_SIGHT_MOVING] ||
          file(world, PL_SIGHT_MOVING, pl_moving(world), world->moving_count)) &&
         (!owns[PL_SIGHT_RESTING] ||
          file(world, PL_SIGHT_RESTING, pl_resting(&world->sleep), world->sleep.resting_count)) &&
         (!owns[PL_SIGHT_FIXED] || file_fixed(world)));
    return sight->fresh;
}

const pl_grid *pl_sight_of(const plumb_world *world, pl_sight_grid which)
{
    const pl_broad *broad = &world->broad;
    const pl_grid *filed[] = { &broad->moving, &broad->resting, &broad->fixed };
    return world->sight.owns[which] ? &own_grids(&world->sight)[which] : filed[which];
}

void pl_sight_free(pl_memory *memory, pl_sight *sight)
{
    for (int i = 0; sight->grids.data != NULL && i < PL_SIGHT_GRIDS; ++i) {
        pl_grid_free(memory, &own_grids(sight)[i]);
    }
    pl_buffer_free(memory, &sight->grids);
    pl_buffer_free(memory, &sight->boxes);
    pl_buffer_free(memory, &sight->list);
    *sight = (pl_sight){ 0 };
}
