// step.c - the public step: what was asked for beforehand, the step itself, who looks on.
#include "api/command.h"
#include "api/fracture.h"
#include "api/heat_run.h"
#include "step/step.h"
#include "world/check.h"
#include "world/observer.h"
#include "world/state.h"

plumb_result plumb_world_step(plumb_world *world, plumb_real dt)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_range(world, __func__, "dt", dt, 0, 1));
    PL_TRY(pl_commands_run(world));
    if (world->fracture.pending_count != 0) {
        PL_TRY(pl_breaks_run(world, __func__, dt == 0));
    }
    if ((world->heats.count | world->heats.gone_count) != 0) {
        PL_TRY(pl_heat_run(world, __func__, dt == 0));
    }
    pl_step_observer *observer = world->observer;
    if (observer != NULL && observer->begin != NULL) {
        observer->begin(observer, world);
    }
    if (observer != NULL) {
        observer->steps = true;
    }
    const plumb_result result = pl_step(world, dt);
    if (observer != NULL) {
        observer->steps = false;
    }
    world->fracture.events_told |= result == PLUMB_OK;
    if (result == PLUMB_E_MEMORY) {
        return pl_fail_memory(world, __func__);
    }
    if (observer != NULL && observer->end != NULL) {
        observer->end(observer, world, dt);
    }
    return result;
}
