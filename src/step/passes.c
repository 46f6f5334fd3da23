// passes.c - the rows of schema/passes.h as a constant table, and what runs those that are done once a step.
//
// The table drives the step (step.c) and the substeps (solver/substep.c), the timers, the check of what is written
// (check.c) and `plumb explain`. Systems of the user stand between its rows (place.c).
#include "step/system.h"
#include "accuracy/dial.h"
#include "effects/effects.h"
#include "effects/engine.h"
#include "effects/fluid.h"
#include "effects/heat.h"
#include "effects/laws.h"
#include "effects/waves.h"
#include "step/quarantine.h"
#include "world/push.h"
#include "joints/joint.h"
#include "character/character.h"
#include "internal_edges/internal_edges.h"
#include "broad/pairs.h"
#include "sleep/sleep.h"
#include "continuous/continuous.h"
#include "event/event.h"
#include "exact/exact.h"
#include "narrow/ahead.h"
#include "narrow/narrow.h"
#include "narrow/one_way.h"
#include "narrow/surface.h"
#include "solver/substep.h"
#include "step/acting.h"
#include "world/wrap.h"

//---- what is done once a step --------------------------------------------------------------------

// The function of a row with ONCE: a call that does not fail, or one that says whether there was memory for it.
#define FUNCTION(run, ...)                                                                         \
    plumb_result run(plumb_world *world, plumb_real dt)                                            \
    {                                                                                              \
        (void)dt;                                                                                  \
        __VA_ARGS__;                                                                               \
    }
#define RUN(run, call) FUNCTION(run, call; return PLUMB_OK)
#define TRY(run, call) FUNCTION(run, return (call) ? PLUMB_OK : PLUMB_E_MEMORY)

static bool wake(plumb_world *world, plumb_real dt)
{
    const uint32_t awake = world->dynamic_count;
    if (!pl_sleep_wake(world, dt)) {
        return false;
    }
    if (world->dynamic_count != awake) { // what slept may have been given any velocity
        pl_quarantine_guard_late(world, dt, "calls");
    }
    return true;
}

static bool make_manifolds(plumb_world *world, plumb_real dt)
{
    return pl_narrow_reserve(world, &world->broad.pairs, &world->narrow) &&
           pl_narrow_run(world, &world->broad.pairs, dt, &world->narrow);
}

// Some pairs that impacts of this step make meet were in no list, or asleep: they are now, and all manifolds are made
// anew.
static bool look_again(plumb_world *world, plumb_real dt)
{
    pl_lookahead *ahead = &world->lookahead;
    const char *unused;
    ahead->again = false;
    pl_ahead_undo(world);
    pl_internal_edges_undo(world);
    if (pl_sleep_is_struck(world) &&
        !(wake(world, dt) && pl_broad_update(world, dt, &pl_end_listener))) {
        return false;
    }
    return pl_pairs_seek(world, ahead->sought.data, ahead->sought_count) &&
           (!pl_want_internal_edges(world, &unused) || pl_internal_edges_update(world)) &&
           make_manifolds(world, dt);
}

// Times that a chain of impacts may lead to somebody new in one step.
#define MOST_LOOKS 12

static bool narrow(plumb_world *world, plumb_real dt)
{
    if (!make_manifolds(world, dt)) {
        return false;
    }
    for (int i = 0; world->lookahead.again && i < MOST_LOOKS; ++i) {
        if (!look_again(world, dt)) {
            return false;
        }
    }
    pl_pairs_seek_no_more(world, world->lookahead.sought.data, world->lookahead.sought_count);
    if (world->one_way_pieces > 0 || world->dropping_bodies > 0) {
        pl_one_way_run(world, dt);
    }
    // Each tile of the ground keeps a contact of its own where systems look at contacts.
    world->internal_edges.apart = pl_system_sees_contacts(world);
    const bool corrected =
        world->internal_edges.pair_count == 0 || pl_internal_edges_correct(world, dt);
    pl_ahead_settle(world);
    if (corrected && !world->internal_edges.apart) {
        pl_narrow_leave_out_implied(world);
    }
    return corrected && pl_events_prepare(world);
}

static bool graph(plumb_world *world, plumb_real dt)
{
    const char *unused;
    return pl_solver_graph(world, dt) &&
           (!pl_want_continuous(world, &unused) || pl_continuous_reserve(world)) &&
           pl_quarantine_keep(world);
}

static void substeps(plumb_world *world, plumb_real dt, const char *name)
{
    pl_schedule_substeps(world, dt);
    pl_quarantine_judge(world, dt, name);
    if (!world->quarantine.again) {
        world->quarantine.again = pl_dial_look(world, dt);
    }
}

static bool find_apart(plumb_world *world)
{
    if (!world->desc.no_exact_islands) {
        pl_hard_look(world);
    }
    return pl_apart_find(world);
}

static void finish(plumb_world *world, plumb_real dt)
{
    pl_solver_finish(world, dt);
    pl_sleep_clear_forces(world);
    world->time += (double)dt;
    world->last_dt = dt;
    world->soft_substep = pl_soft_substep(world, dt);
    ++world->step_count;
}

static void publish(plumb_world *world, plumb_real dt)
{
    if (world->internal_edges.load_count > 0 && dt > 0) {
        pl_internal_edges_remember(world);
    }
    pl_events_publish(world, dt == 0);
    if (dt == 0) {
        pl_internal_edges_give_back(world);
    }
    pl_one_way_forget(world);
}

RUN(pl_run_guard, pl_quarantine_guard(world, dt, "calls"))
TRY(pl_run_characters, pl_characters_move(world, dt))
TRY(pl_run_waking, wake(world, dt))
TRY(pl_run_broad, pl_broad_update(world, dt, &pl_end_listener))
TRY(pl_run_internal_edges, pl_internal_edges_update(world))
TRY(pl_run_narrow, narrow(world, dt))
RUN(pl_run_surfaces, pl_surfaces_mix(world))
RUN(pl_run_feet, pl_characters_feet(world))
TRY(pl_run_sleep, pl_sleep_fall(world, dt))
TRY(pl_run_candidates, pl_sensing_prepare(world))
RUN(pl_run_gravity, world->effects.gravity = world->gravity)
TRY(pl_run_fluids, pl_fluids_find(world))
TRY(pl_run_laws, pl_laws_find(world, dt))
TRY(pl_run_called, pl_acting_call(world))
TRY(pl_run_clusters, pl_solver_open(world))
TRY(pl_run_apart, find_apart(world))
TRY(pl_run_graph, graph(world, dt))
TRY(pl_run_waves, pl_waves_open(world, dt))
TRY(pl_run_immersion, pl_fluids_immerse(world))
TRY(pl_run_engines, pl_engines_find(world, dt))
TRY(pl_run_law_slots, pl_laws_take_slots(world))
TRY(pl_run_acting, pl_acting_find(world, dt))
RUN(pl_run_soft, substeps(world, dt, "soft step"); pl_hard_note(world); pl_fine_note(world, dt))
RUN(pl_run_classic, substeps(world, dt, "classic solver"))
TRY(pl_run_elimination, pl_exact_plan(world))
RUN(pl_run_exact, substeps(world, dt, "exact solver"); pl_exact_tell(world))
RUN(pl_run_motion, finish(world, dt))
RUN(pl_run_continuous, pl_continuous_run(world, dt))
RUN(pl_run_tracks, pl_tracks_open(world, dt))
RUN(pl_run_arrive, pl_targets_arrive(world, dt); pl_tracks_arrive(world, dt))
RUN(pl_run_burning, pl_engines_burn(world))
TRY(pl_run_heat, pl_heat_reserve_flow(world))
RUN(pl_run_heat_flow, pl_heat_flow(world, (double)dt))
RUN(pl_run_edges, pl_wrap_bodies(world))
RUN(pl_run_reactions, pl_joints_finish(world, dt))
RUN(pl_run_events, publish(world, dt))
TRY(pl_run_breakable, pl_breaking_prepare(world))
RUN(pl_run_breaking, pl_breaking_find(world, dt))
RUN(pl_run_sensors, pl_sensing_run(world))

//---- the table -----------------------------------------------------------------------------------

#define WANTED_ALWAYS              NULL
#define WANTED_IF(f)               f
#define RUN_HOME                   .run = NULL
#define RUN_ONCE(f)                .run = f
#define RUN_THREE(one, two, three) .row = { one, two, three }
#define RUN_EACH(f)                RUN_THREE(f, f, f)
#define RUN_ACTS(f, whom)          RUN_EACH(f), .acts_on = whom
#define RUN_NOT_CLASSIC(f)         RUN_THREE(f, NULL, f)
#define RUN_SOFT(f)                RUN_THREE(f, NULL, NULL)
#define RUN_EXACT(f)               RUN_THREE(NULL, NULL, f)
#define RUN_BOTH(one, two)         RUN_THREE(one, two, NULL)
#define VARIANTS_ONE               NULL
#define VARIANTS_HAS(f)            f
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
