// passes.c - the rows of schema/passes.h as a constant table, and what runs those that are done once a step.
//
// The table drives the step (step.c) and the substeps (solver/substep.c), the timers, the check of what is written
// (check.c) and `plumb explain`. Systems of the user stand between its rows (place.c).
#include "step/system.h"
#include "effects/effects.h"
#include "step/quarantine.h"
#include "world/push.h"
#include "joints/joint.h"
#include "character/character.h"
#include "internal_edges/internal_edges.h"
#include "sleep/sleep.h"
#include "continuous/continuous.h"
#include "event/event.h"
#include "narrow/ahead.h"
#include "narrow/narrow.h"
#include "narrow/one_way.h"
#include "narrow/surface.h"
#include "solver/substep.h"
#include "step/acting.h"
#include "world/wrap.h"

//---- what is done once a step --------------------------------------------------------------------

plumb_result pl_run_guard(plumb_world *world, plumb_real dt)
{
    pl_quarantine_guard(world, dt, "calls");
    return PLUMB_OK;
}

plumb_result pl_run_characters(plumb_world *world, plumb_real dt)
{
    return pl_characters_move(world, dt) ? PLUMB_OK : PLUMB_E_MEMORY;
}

plumb_result pl_run_feet(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_characters_feet(world);
    return PLUMB_OK;
}

plumb_result pl_run_waking(plumb_world *world, plumb_real dt)
{
    const uint32_t awake = world->dynamic_count;
    if (!pl_sleep_wake(world, dt)) {
        return PLUMB_E_MEMORY;
    }
    if (world->dynamic_count != awake) { // what slept may have been given any velocity
        pl_quarantine_guard_late(world, dt, "calls");
    }
    return PLUMB_OK;
}

plumb_result pl_run_sleep(plumb_world *world, plumb_real dt)
{
    return pl_sleep_fall(world, dt) ? PLUMB_OK : PLUMB_E_MEMORY;
}

plumb_result pl_run_arrive(plumb_world *world, plumb_real dt)
{
    pl_targets_arrive(world, dt);
    return PLUMB_OK;
}

plumb_result pl_run_broad(plumb_world *world, plumb_real dt)
{
    return pl_broad_update(world, dt, &pl_end_listener) ? PLUMB_OK : PLUMB_E_MEMORY;
}

// Each tile of the ground keeps a contact of its own where systems look at contacts.
static bool contacts_are_shown(const plumb_world *world)
{
    const char *reason;
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        const pl_system *system = &world->systems.items[i];
        if (system->desc.phase == PLUMB_PHASE_CONTACTS &&
            pl_system_wanted(world, system, &reason)) {
            return true;
        }
    }
    return false;
}

plumb_result pl_run_narrow(plumb_world *world, plumb_real dt)
{
    if (!pl_narrow_reserve(world, &world->broad.pairs, &world->narrow)) {
        return PLUMB_E_MEMORY;
    }
    if (!pl_narrow_run(world, &world->broad.pairs, dt, &world->narrow)) {
        return PLUMB_E_MEMORY;
    }
    if (world->one_way_pieces > 0 || world->dropping_bodies > 0) {
        pl_one_way_run(world);
    }
    world->internal_edges.apart = contacts_are_shown(world);
    const bool corrected =
        world->internal_edges.pair_count == 0 || pl_internal_edges_correct(world, dt);
    pl_ahead_settle(world);
    if (!corrected) {
        return PLUMB_E_MEMORY;
    }
    return pl_events_prepare(world) ? PLUMB_OK : PLUMB_E_MEMORY;
}

plumb_result pl_run_internal_edges(plumb_world *world, plumb_real dt)
{
    (void)dt;
    return pl_internal_edges_update(world) ? PLUMB_OK : PLUMB_E_MEMORY;
}

plumb_result pl_run_candidates(plumb_world *world, plumb_real dt)
{
    (void)dt;
    return pl_sensing_prepare(world) ? PLUMB_OK : PLUMB_E_MEMORY;
}

plumb_result pl_run_surfaces(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_surfaces_mix(world);
    return PLUMB_OK;
}

plumb_result pl_run_sensors(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_sensing_run(world);
    return PLUMB_OK;
}

plumb_result pl_run_graph(plumb_world *world, plumb_real dt)
{
    (void)dt;
    const char *unused;
    bool room = pl_solver_graph(world) &&
                (!pl_want_continuous(world, &unused) || pl_continuous_reserve(world)) &&
                pl_quarantine_keep(world);
    return room ? PLUMB_OK : PLUMB_E_MEMORY;
}

plumb_result pl_run_gravity(plumb_world *world, plumb_real dt)
{
    (void)dt;
    world->effects.gravity = world->gravity;
    return PLUMB_OK;
}

plumb_result pl_run_called(plumb_world *world, plumb_real dt)
{
    (void)dt;
    return pl_acting_call(world) ? PLUMB_OK : PLUMB_E_MEMORY;
}

plumb_result pl_run_acting(plumb_world *world, plumb_real dt)
{
    return pl_acting_find(world, dt) ? PLUMB_OK : PLUMB_E_MEMORY;
}

plumb_result pl_run_soft(plumb_world *world, plumb_real dt)
{
    pl_schedule_substeps(world, dt);
    pl_quarantine_judge(world, dt, "soft step");
    return PLUMB_OK;
}

plumb_result pl_run_classic(plumb_world *world, plumb_real dt)
{
    pl_schedule_substeps(world, dt);
    pl_quarantine_judge(world, dt, "classic solver");
    return PLUMB_OK;
}

plumb_result pl_run_motion(plumb_world *world, plumb_real dt)
{
    pl_solver_finish(world, dt);
    pl_sleep_clear_forces(world);
    world->time += (double)dt;
    world->last_dt = dt;
    ++world->step_count;
    return PLUMB_OK;
}

plumb_result pl_run_continuous(plumb_world *world, plumb_real dt)
{
    pl_continuous_run(world, dt);
    return PLUMB_OK;
}

plumb_result pl_run_edges(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_wrap_bodies(world);
    return PLUMB_OK;
}

plumb_result pl_run_reactions(plumb_world *world, plumb_real dt)
{
    pl_joints_finish(world, dt);
    return PLUMB_OK;
}

plumb_result pl_run_events(plumb_world *world, plumb_real dt)
{
    if (world->internal_edges.load_count > 0 && dt > 0) {
        pl_internal_edges_remember(world);
    }
    pl_events_publish(world, dt == 0);
    if (dt == 0) {
        pl_internal_edges_give_back(world);
    }
    return PLUMB_OK;
}

//---- the table -----------------------------------------------------------------------------------

#define WANTED_ALWAYS      NULL
#define WANTED_IF(f)       f
#define RUN_HOME           .run = NULL
#define RUN_ONCE(f)        .run = f
#define RUN_EACH(f)        .soft = f, .classic = f
#define RUN_ACTS(f, whom)  .soft = f, .classic = f, .acts_on = whom
#define RUN_SOFT(f)        .soft = f
#define RUN_BOTH(one, two) .soft = one, .classic = two
#define VARIANTS_ONE       NULL
#define VARIANTS_HAS(f)    f
#define ROW(text, at, want, how, when, read, write, which)                                         \
    { .name = text,                                                                                \
      .stage = PL_STAGE_##at,                                                                      \
      .reads = read,                                                                               \
      .writes = write,                                                                             \
      .wanted = WANTED_##want,                                                                     \
      RUN_##how,                                                                                   \
      .kind = PL_##when,                                                                           \
      .variants = VARIANTS_##which },

const pl_pass pl_passes[] = { PL_PASSES(ROW) };
const int pl_pass_count = (int)(sizeof pl_passes / sizeof pl_passes[0]);

_Static_assert(sizeof pl_passes / sizeof pl_passes[0] <= PL_PASS_MAX, "raise PL_PASS_MAX");
