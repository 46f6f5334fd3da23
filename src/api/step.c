// step.c - the public step: what was asked for beforehand, the step itself, who looks on.
#include "api/command.h"
#include "step/step.h"
#include "world/check.h"
#include "world/observer.h"
#include "world/state.h"

plumb_result plumb_world_step(plumb_world *world, plumb_real dt)
{
    if (world == NULL) {
        return PLUMB_E_NULL;
    }
    plumb_result result = pl_check_unlocked(world, __func__);
    if (result != PLUMB_OK) {
        return result;
    }
    result = pl_check_range(world, __func__, "dt", dt, 0, 1);
    if (result != PLUMB_OK) {
        return result;
    }
    pl_step_observer *observer = world->observer;
    if (observer == NULL || !observer->replays) {
        result = pl_commands_run(world);
    }
    if (result != PLUMB_OK) {
        return result;
    }
    if (observer != NULL && observer->begin != NULL) {
        observer->begin(observer, world);
    }
    if (observer != NULL) {
        observer->steps = true;
    }
    result = pl_step(world, dt);
    if (observer != NULL) {
        observer->steps = false;
    }
    if (result == PLUMB_E_MEMORY) {
        return pl_fail_memory(world, __func__);
    }
    if (observer != NULL && observer->end != NULL) {
        observer->end(observer, world, dt);
    }
    return result;
}
