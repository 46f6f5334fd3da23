// sleep.c - the public functions of plumb/sleep.h, and the events' life.
//
// Reads: arguments, islands. Writes: flags, islands due; plumb_body_sleep moves rows. Cost: O(1)
// but for plumb_body_sleep and plumb_world_set_sleep.
#include "plumb/sleep.h"
#include "sleep/sleep.h"
#include "world/check.h"
#include "world/island.h"
#include "world/rows.h"

bool plumb_body_is_awake(const plumb_world *world, plumb_body body)
{
    uint32_t row = pl_ask_body(world, __func__, body);
    if (row == PL_NONE) {
        return false;
    }
    uint32_t island = world->bodies.island[row];
    return island == PL_NONE || pl_islands(&world->sleep)[island].due;
}

plumb_result plumb_body_wake(plumb_world *world, plumb_body body)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    if (world->bodies.type[row] == PLUMB_DYNAMIC) {
        pl_sleep_stir(world, row);
    }
    return PLUMB_OK;
}

plumb_result plumb_body_sleep(plumb_world *world, plumb_body body)
{
    uint32_t row;
    PL_TRY(pl_check_dynamic(world, __func__, body, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (world->desc.no_sleep) {
        return pl_fail(world, PLUMB_E_STATE, __func__,
                       "the world has no_sleep; see plumb_world_set_sleep");
    }
    if ((world->bodies.flags[row] & PL_BODY_DISABLED) != 0) {
        return pl_fail(world, PLUMB_E_STATE, __func__, "body is disabled; it must be enabled");
    }
    if (pl_row_is_asleep(world, row)) {
        const bool due = plumb_body_is_awake(world, body);
        return !due || pl_island_calm(world, world->bodies.island[row])
                   ? PLUMB_OK
                   : pl_fail_memory(world, __func__);
    }
    return pl_sleep_put_to_sleep(world, __func__, row);
}

plumb_result plumb_body_set_no_sleep(plumb_world *world, plumb_body body, bool no_sleep)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    uint16_t *flags = &world->bodies.flags[row];
    *flags =
        (uint16_t)(no_sleep ? *flags | PL_BODY_NO_SLEEP : *flags & (uint16_t)~PL_BODY_NO_SLEEP);
    if (no_sleep && world->bodies.island[row] != PL_NONE) {
        pl_sleep_stir(world, row);
    }
    return PLUMB_OK;
}

plumb_result plumb_world_set_sleep(plumb_world *world, bool allowed, plumb_real speed,
                                   plumb_real time)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_range(world, __func__, "speed", speed, 0, PLUMB_REAL_MAX));
    PL_TRY(pl_check_range(world, __func__, "time", time, 0, PLUMB_REAL_MAX));
    if (!allowed) {
        pl_sleep_disturb_all(world);
    }
    world->desc.no_sleep = !allowed;
    world->desc.sleep_speed = speed;
    world->desc.sleep_time = time;
    pl_world_resolve(&world->desc);
    world->schedule_dirty = true;
    return PLUMB_OK;
}
