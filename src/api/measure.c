// measure.c - the public side of step/measure.c.
//
// Reads, writes: settings, the last measures. Cost: O(1).
#include "world/check.h"
#include "world/state.h"

plumb_result plumb_world_set_measure(plumb_world *world, bool measure)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    if (measure) {
        PL_TRY(PL_CHECK_HAS(world, __func__, "measure", MEASURES, "measures"));
    }
    world->desc.measure = measure;
    world->schedule.watched = pl_watched_bits(world->schedule.watched, &world->desc);
    world->schedule_dirty = true;
    return PLUMB_OK;
}

const plumb_measures *plumb_world_measures(const plumb_world *world)
{
    static const plumb_measures none = { .step = 0 };
    if (world == NULL) {
        return NULL;
    }
    return world->measure.last.data == NULL ? &none : pl_measures_last(&world->measure);
}

static const struct {
    const char *name, *text;
} works[PLUMB_WORKS] = {
#define ROW(NAME, name, text) [PLUMB_WORK_##NAME] = { #name, text },
    PLUMB_WORK_LIST(ROW)
#undef ROW
};

const char *plumb_work_name(plumb_work work)
{
    return (unsigned)work < PLUMB_WORKS ? works[work].name : NULL;
}

const char *plumb_work_text(plumb_work work)
{
    return (unsigned)work < PLUMB_WORKS ? works[work].text : NULL;
}
