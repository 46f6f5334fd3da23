// tuning.c - records of damping, speed caps and time scale: kept dense, one for each body that asks.
//
// The body's column `tuning` names its record, the record names the body; when one goes, the last
// one fills the gap. The order means nothing: a record concerns its body alone. Reads, writes: the
// list, the body's column and flag. Cost: O(1).
#include "world/state.h"

static pl_tuning *items(const plumb_world *world)
{
    return (pl_tuning *)world->tunings.items.data;
}

pl_tuning pl_tuning_get(const plumb_world *world, uint32_t row)
{
    uint32_t at = world->bodies.tuning[row];
    return at != 0 ? items(world)[at - 1]
                   : (pl_tuning){ .body = world->bodies.entity[row], .time_scale = 1 };
}

real pl_time_scale(const plumb_world *world, uint32_t row)
{
    uint32_t at = world->bodies.tuning[row];
    return at != 0 ? items(world)[at - 1].time_scale : 1;
}

bool pl_tuning_reserve(plumb_world *world)
{
    return pl_buffer_reserve(&world->memory, &world->tunings.items,
                             ((size_t)world->tunings.count + 1) * sizeof(pl_tuning));
}

static bool is_damped(const pl_tuning *t)
{
    return t->damping > 0 || t->angular_damping > 0;
}

static bool is_capped(const pl_tuning *t)
{
    return t->max_speed > 0 || t->max_spin > 0;
}

static void count(pl_tunings *tunings, const pl_tuning *t, uint32_t by)
{
    tunings->damped += is_damped(t) ? by : 0;
    tunings->capped += is_capped(t) ? by : 0;
    tunings->scaled += t->time_scale != 1 ? by : 0;
    tunings->frozen += t->time_scale == 0 ? by : 0;
}

static void take_away(plumb_world *world, uint32_t row)
{
    uint32_t at = world->bodies.tuning[row];
    if (at == 0) {
        return;
    }
    pl_tunings *tunings = &world->tunings;
    count(tunings, &items(world)[at - 1], UINT32_MAX);
    pl_tuning last = items(world)[--tunings->count];
    if (at - 1 != tunings->count) {
        items(world)[at - 1] = last;
        world->bodies.tuning[pl_body_row(world, last.body)] = at;
    }
    world->bodies.tuning[row] = 0;
    world->bodies.flags[row] &= (uint16_t)~PL_BODY_TUNED;
}

void pl_tuning_set(plumb_world *world, uint32_t row, const pl_tuning *values)
{
    take_away(world, row);
    world->schedule_dirty = true;
    if (!is_damped(values) && !is_capped(values) && values->time_scale == 1) {
        return;
    }
    pl_tunings *tunings = &world->tunings;
    items(world)[tunings->count] = *values;
    items(world)[tunings->count].body = world->bodies.entity[row];
    count(tunings, values, 1);
    world->bodies.tuning[row] = ++tunings->count;
    world->bodies.flags[row] |= PL_BODY_TUNED;
}

void pl_body_forget(plumb_world *world, uint32_t row)
{
    take_away(world, row);
    pl_target_forget(world, row);
    world->locked_bodies -= (world->bodies.flags[row] & PL_BODY_LOCKED) != 0;
}
