// body_settings.c - records of damping, speed caps and time scale: kept dense, one for each body that asks.
//
// The body's column `settings` names its record, the record names the body; when one goes, the last
// one fills the gap. The order means nothing: a record concerns its body alone. Reads, writes: the
// list, the body's column and flag. Cost: O(1).
#include "world/body_settings.h"

#include "world/heat_list.h"
#include "world/state.h"

static pl_body_settings *items(const plumb_world *world)
{
    return (pl_body_settings *)world->settings.items.data;
}

#define DEFAULT(name, initial) .name = initial,

pl_body_settings pl_body_settings_get(const plumb_world *world, uint32_t row)
{
    uint32_t at = world->bodies.settings[row];
    return at != 0 ? items(world)[at - 1]
                   : (pl_body_settings){ .body = world->bodies.entity[row],
                                         PL_BODY_ROWS(PL_ROW_RECORD, DEFAULT) };
}

real pl_time_scale(const plumb_world *world, uint32_t row)
{
    uint32_t at = world->bodies.settings[row];
    return at != 0 ? items(world)[at - 1].time_scale : 1;
}

bool pl_body_settings_reserve(plumb_world *world)
{
    return pl_buffer_reserve(&world->memory, &world->settings.items,
                             ((size_t)world->settings.count + 1) * sizeof(pl_body_settings));
}

static bool is_damped(const pl_body_settings *t)
{
    return t->damping > 0 || t->angular_damping > 0;
}

static bool is_capped(const pl_body_settings *t)
{
    return t->max_speed > 0 || t->max_spin > 0;
}

static bool is_breakable(const pl_body_settings *t)
{
    return t->break_force > 0 || t->break_impulse > 0;
}

static void count(pl_body_settings_list *settings, const pl_body_settings *t, uint32_t by)
{
    settings->damped += is_damped(t) ? by : 0;
    settings->dragged += t->drag > 0 ? by : 0;
    settings->engines += t->thrust > 0 ? by : 0;
    settings->breakable += is_breakable(t) ? by : 0;
    settings->dipoles += t->dipole != 0 ? by : 0;
    settings->capped += is_capped(t) ? by : 0;
    settings->scaled += t->time_scale != 1 ? by : 0;
    settings->frozen += t->time_scale == 0 ? by : 0;
}

// Whether any of them is not the default.
static bool is_any(const pl_body_settings *t)
{
#define IS_SET(name, initial) || t->name != (initial)
    return false PL_BODY_ROWS(PL_ROW_RECORD, IS_SET);
#undef IS_SET
}

static void take_away(plumb_world *world, uint32_t row)
{
    uint32_t at = world->bodies.settings[row];
    if (at == 0) {
        return;
    }
    pl_body_settings_list *settings = &world->settings;
    count(settings, &items(world)[at - 1], UINT32_MAX);
    pl_body_settings last = items(world)[--settings->count];
    if (at - 1 != settings->count) {
        items(world)[at - 1] = last;
        world->bodies.settings[pl_body_row(world, last.body)] = at;
    }
    world->bodies.settings[row] = 0;
    world->bodies.flags[row] &= (uint16_t)~PL_BODY_HAS_SETTINGS;
}

void pl_body_settings_set(plumb_world *world, uint32_t row, const pl_body_settings *values)
{
    take_away(world, row);
    world->schedule_dirty = true;
    if (!is_any(values)) {
        return;
    }
    pl_body_settings_list *settings = &world->settings;
    items(world)[settings->count] = *values;
    items(world)[settings->count].body = world->bodies.entity[row];
    count(settings, values, 1);
    world->bodies.settings[row] = ++settings->count;
    world->bodies.flags[row] |= PL_BODY_HAS_SETTINGS;
}

static pl_target *targets(const plumb_world *world)
{
    return (pl_target *)world->targets.items.data;
}

void pl_target_forget(plumb_world *world, uint32_t row)
{
    if ((world->bodies.flags[row] & PL_BODY_TARGETED) == 0) {
        return;
    }
    world->bodies.flags[row] &= (uint16_t)~PL_BODY_TARGETED;
    plumb_body body = world->bodies.entity[row];
    uint32_t kept = 0;
    for (uint32_t i = 0; i < world->targets.count; ++i) {
        if (!plumb_same(targets(world)[i].body, body)) {
            targets(world)[kept++] = targets(world)[i];
        }
    }
    world->targets.count = kept;
    pl_track *tracks = world->tracks.items.data;
    kept = 0;
    for (uint32_t i = 0; i < world->tracks.count; ++i) {
        if (!plumb_same(tracks[i].body, body)) {
            tracks[kept++] = tracks[i];
        }
    }
    world->tracks.count = kept;
    world->schedule_dirty = true;
}

void pl_settings_of_poses(plumb_world *world)
{
    uint32_t movable = world->dynamic_count + world->kinematic_count;
    for (uint32_t i = 0; i < world->settings.count; ++i) {
        uint32_t row = pl_body_row(world, items(world)[i].body);
        if (row < movable) {
            pl_poses(world)[row].vx *= items(world)[i].time_scale;
            pl_poses(world)[row].vy *= items(world)[i].time_scale;
        }
    }
}

void pl_body_forget(plumb_world *world, uint32_t row)
{
    take_away(world, row);
    pl_target_forget(world, row);
    pl_heat_forget(world, world->bodies.entity[row]);
    world->locked_bodies -= (world->bodies.flags[row] & PL_BODY_LOCKED) != 0;
}
