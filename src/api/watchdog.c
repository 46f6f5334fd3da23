// watchdog.c - the public side of src/watchdog.
//
// Reads, writes: settings, the last alarms. Cost: O(1); switching O(entities).
#include "api/listed.h"
#include "watchdog/watchdog.h"
#include "world/check.h"

plumb_result plumb_world_set_watchdog(plumb_world *world, bool watchdog)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    if (watchdog) {
        PL_TRY(PL_CHECK_HAS(world, __func__, "watchdog", WATCHDOG, "watchdog"));
    }
    pl_watchdog_forget(&world->watchdog);
    world->desc.watchdog = watchdog;
    world->schedule.watched = pl_watched_bits(world->schedule.watched, &world->desc);
    world->schedule_dirty = true;
    return PLUMB_OK;
}

PL_LISTED(plumb_alarm, plumb_world_alarms, world->watchdog.alarms.data, world->watchdog.count)

static const struct {
    const char *name, *unit, *text, *advice;
    double bound;
} kinds[PLUMB_ALARM_KINDS] = {
#define ROW(NAME, name, bound, unit, text, advice)                                                 \
    [PLUMB_ALARM_##NAME] = { name, unit, text, advice, bound },
    PLUMB_ALARM_LIST(ROW)
#undef ROW
};

static bool is_kind(plumb_alarm_kind kind)
{
    return (unsigned)kind < PLUMB_ALARM_KINDS;
}

const char *plumb_alarm_name(plumb_alarm_kind kind)
{
    return is_kind(kind) ? kinds[kind].name : NULL;
}

const char *plumb_alarm_text(plumb_alarm_kind kind)
{
    return is_kind(kind) ? kinds[kind].text : NULL;
}

const char *plumb_alarm_advice(plumb_alarm_kind kind)
{
    return is_kind(kind) ? kinds[kind].advice : NULL;
}

const char *plumb_alarm_unit(plumb_alarm_kind kind)
{
    return is_kind(kind) ? kinds[kind].unit : NULL;
}

double plumb_alarm_bound(plumb_alarm_kind kind)
{
    return is_kind(kind) ? kinds[kind].bound : 0;
}
