// step.c - drives the schedule: the step, row by row, and the user's systems between our rows.
//
// Reads, writes: what the rows do. The clock is read, and data is digested, only where somebody watches.
#include "step/step.h"

#include "accuracy/dial.h"
#include "character/character.h"
#include "core/clock.h"
#include "effects/effects.h"
#include "event/event.h"
#include "internal_edges/internal_edges.h"
#include "air/air.h"
#include "broad/pairs.h"
#include "liquid/liquid.h"
#include "narrow/ahead.h"
#include "narrow/one_way.h"
#include "sleep/sleep.h"
#include "step/measure.h"
#include "step/place.h"
#include "step/quarantine.h"
#include "step/system.h"
#include "world/check.h"
#include "world/observer.h"
#include "watchdog/watchdog.h"
#include "world/state.h"

// Nothing is left from a step in which there was collision.
static void forget_contacts(plumb_world *world)
{
    world->narrow.manifold_count = world->narrow.borne_count = 0;
    world->narrow.any_friction = world->narrow.any_elastic = world->narrow.any_low = false;
    world->solver.slot_count = 0;
    world->solver.follows_impacts = false;
    world->effects.gravity = plumb_v2(0, 0);
    world->effects.any_called = world->effects.any_alone = false;
    world->laws.step.flies = false;
    world->joints.broken_count = world->joints.strained_count = 0;
    world->broad.refreshed = false;
    world->lookahead.kept_count = world->lookahead.sought_count = world->lookahead.looks = 0;
    world->lookahead.again = false;
    world->internal_edges.noted = world->internal_edges.opened = false;
    world->continuous.count = world->continuous.stopped_count = 0;
    world->continuous.noting = false;
}

//---- rows ----------------------------------------------------------------------------------------

// What a line runs once a step; NULL: a system.
static pl_once_fn *once_of(plumb_world *world, uint32_t line)
{
    const pl_line place = pl_schedule_place(world, line);
    return place.system == PL_NO_SYSTEM ? pl_passes[place.pass].run : NULL;
}

static const char *const homes[] = {
    [PLUMB_PHASE_BEGIN] = "begin systems",
    [PLUMB_PHASE_FORCES] = "force systems",
    [PLUMB_PHASE_CONTACTS] = "contact systems",
    [PLUMB_PHASE_END] = "end systems",
};

static pl_doing doing_of(plumb_world *world, uint32_t line)
{
    static const struct {
        pl_once_fn *run;
        pl_doing doing;
    } rows[] = { { NULL, PL_DOES_SYSTEM },          { pl_run_broad, PL_DOES_FILE },
                 { pl_run_waking, PL_DOES_WAKE },   { pl_run_characters, PL_DOES_MOVE },
                 { pl_run_motion, PL_DOES_MOTION }, { pl_run_continuous, PL_DOES_STOP },
                 { pl_run_arrive, PL_DOES_MOVE },   { pl_run_edges, PL_DOES_SHIFT } };
    pl_once_fn *const run = once_of(world, line);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        if (rows[i].run == run) {
            return rows[i].doing;
        }
    }
    return PL_DOES_NOTHING;
}

static void watch_row(plumb_world *world, uint32_t line, real dt)
{
    const pl_line place = pl_schedule_place(world, line);
    const bool is_system = place.system != PL_NO_SYSTEM;
    pl_watchdog_after(world, doing_of(world, line),
                      is_system ? homes[world->systems.items[place.system].desc.phase]
                                : pl_passes[place.pass].name,
                      place.system, dt);
}

// What is watched in a step of dt. A step of dt 0 moves nothing: neither measures nor watchdog have begun one.
static unsigned watched_in(const plumb_world *world, real dt)
{
    const unsigned watched = world->schedule.watched;
    return dt > 0 ? watched : watched & ~(PL_WATCH_MEASURES | PL_WATCH_DOG);
}

// Around a row, where somebody watches. Returns when it starts [ns], if times are watched.
static double open_row(plumb_world *world, uint32_t line, real dt)
{
    const unsigned watched = watched_in(world, dt);
    if ((watched & PL_WATCH_MEASURES) != 0) {
        pl_measure_before(world, once_of(world, line));
    }
    if ((watched & PL_WATCH_DOG) != 0) {
        pl_watchdog_before(world, doing_of(world, line));
    }
    if ((watched & PLUMB_WATCH_WRITES) != 0) {
        pl_check_before(world);
    }
    world->schedule.inner_ns = 0;
    return (watched & PLUMB_WATCH_TIMES) != 0 ? pl_now_ns() : 0;
}

static void close_row(plumb_world *world, uint32_t line, double start, real dt)
{
    const unsigned watched = watched_in(world, dt);
    if ((watched & PLUMB_WATCH_TIMES) != 0) {
        const double ns = pl_now_ns() - start - world->schedule.inner_ns;
        pl_schedule_note(world, pl_schedule_place(world, line), ns);
    }
    if ((watched & PLUMB_WATCH_WRITES) != 0) {
        pl_schedule_check(world, line);
    }
    if ((watched & PL_WATCH_MEASURES) != 0) {
        pl_measure_after(world, once_of(world, line), dt);
    }
    if ((watched & PL_WATCH_DOG) != 0) {
        watch_row(world, line, dt);
    }
}

static plumb_result run_pass(plumb_world *world, uint32_t line, real dt)
{
    const uint32_t i = pl_schedule_place(world, line).pass;
    const pl_pass *pass = &pl_passes[i];
    if (dt == 0 && (pass->kind & PL_REFRESHES) == 0) {
        return PLUMB_OK;
    }
    const bool watched = world->schedule.watched != 0;
    const double start = watched ? open_row(world, line, dt) : 0;
    world->query_grids.fresh = false; // what systems ask about moves from pass to pass
    const plumb_result result = pass->run(world, dt);
    if (watched) {
        close_row(world, line, start, dt);
    }
    if (result == PLUMB_OK && !world->quarantine.again && world->observer != NULL &&
        world->observer->passed != NULL) {
        world->observer->passed(world->observer, world, (int)i);
    }
    return result;
}

//---- systems -------------------------------------------------------------------------------------

// Systems that follow one another: lines [first, end).
typedef struct group {
    uint32_t first, end;
} group;

static pl_system *system_at(plumb_world *world, uint32_t line)
{
    return &world->systems.items[pl_schedule_place(world, line).system];
}

// Whether the system is to run now. What one did to columns holds when the step is taken anew (quarantine.c);
// contacts are found anew.
static bool runs_now(const plumb_world *world, const pl_system *system, real dt)
{
    const char *unused;
    const bool edits = system->desc.phase == PLUMB_PHASE_CONTACTS;
    return (dt > 0 || edits) && (!system->ran || edits) && pl_system_wanted(world, system, &unused);
}

static void run_systems(plumb_world *world, group g, real dt)
{
    for (uint32_t line = g.first; line < g.end; ++line) {
        pl_system *system = system_at(world, line);
        if (!runs_now(world, system, dt)) {
            continue;
        }
        const bool watched = world->schedule.watched != 0;
        const double start = watched ? open_row(world, line, dt) : 0;
        pl_system_run(world, system, dt);
        if (watched) {
            close_row(world, line, start, dt);
        }
    }
}

// What the user does in a step, or what is on the recording of it.
static void run_observed(plumb_world *world, group g, plumb_phase phase, real dt)
{
    pl_step_observer *observer = world->observer;
    if (observer != NULL && observer->before != NULL) {
        observer->before(observer, world, phase);
    }
    if (observer == NULL || !observer->replays) {
        run_systems(world, g, dt);
    }
    for (uint32_t line = g.first; line < g.end; ++line) {
        system_at(world, line)->ran |= runs_now(world, system_at(world, line), dt);
    }
    if (observer != NULL && observer->after != NULL) {
        observer->after(observer, world, phase);
    }
}

// What systems leave without a finite state is taken out: at once where nothing of the step has been found out yet.
static void run_group(plumb_world *world, group g, real dt)
{
    const plumb_phase phase = system_at(world, g.first)->desc.phase;
    const pl_stage stage = pl_passes[pl_schedule_place(world, g.first).pass].stage;
    world->query_grids.fresh = false;
    if (phase == PLUMB_PHASE_CONTACTS) {
        pl_edits_open(world);
    }
    run_observed(world, g, phase, dt);
    if (phase == PLUMB_PHASE_CONTACTS) {
        pl_edits_close(world);
    }
    if (stage < PL_STAGE_PAIRS) {
        pl_quarantine_guard(world, dt, homes[phase]);
    } else if (stage < PL_STAGE_GRAPH) {
        pl_quarantine_guard_late(world, dt, homes[phase]);
    }
    if (!world->quarantine.again && world->observer != NULL && world->observer->passed != NULL) {
        world->observer->passed(world->observer, world, pl_pass_find(homes[phase]));
    }
}

// The group that begins at a line: of one phase. Runs it if one of it is to run; returns the line behind it.
static uint32_t run_group_at(plumb_world *world, uint32_t line, real dt)
{
    const uint32_t count = pl_schedule_count(world);
    const plumb_phase phase = system_at(world, line)->desc.phase;
    group g = { line, line };
    bool any = false;
    while (g.end < count && pl_schedule_place(world, g.end).system != PL_NO_SYSTEM &&
           system_at(world, g.end)->desc.phase == phase) {
        any |= runs_now(world, system_at(world, g.end), dt);
        ++g.end;
    }
    if (any && phase != PLUMB_PHASE_SUBSTEP) {
        run_group(world, g, dt);
    }
    return g.end;
}

static uint32_t next_line(const plumb_world *world, uint32_t line)
{
    return ((const uint16_t *)world->schedule.next.data)[line];
}

static plumb_result run_passes(plumb_world *world, real dt)
{
    const uint32_t count = pl_schedule_count(world);
    for (uint32_t line = 0; (line = next_line(world, line)) < count;) {
        if (pl_schedule_place(world, line).system != PL_NO_SYSTEM) {
            line = run_group_at(world, line, dt);
        } else {
            const plumb_result result = run_pass(world, line++, dt);
            if (result != PLUMB_OK) {
                return result;
            }
        }
        if (world->quarantine.again) {
            return PLUMB_OK;
        }
        // Bodies that fell asleep or woke may leave passes without anything to do, or give them some.
        if (world->schedule_dirty) {
            pl_schedule_revise(world);
        }
    }
    return PLUMB_OK;
}

//---- the step ------------------------------------------------------------------------------------

// The passes, from the beginning. Of a step of dt 0 only those that move nothing (PL_REFRESHES), and those only
// where something was rearranged since the last step: else contacts, overlaps and grids are as that step left
// them, and to look again could only change what the next step starts from.
static plumb_result try_step(plumb_world *world, plumb_real dt)
{
    pl_events_clear(world);
    world->liquid.contact_count = world->liquid.end_count = 0;
    pl_sleep_recall(world);
    pl_edits_forget(world);
    if (dt == 0 && !world->rearranged) {
        world->joints.broken_count = world->joints.strained_count =
            0; // that is an event; contacts are those of the last step
        return PLUMB_OK;
    }
    forget_contacts(world);
    if (!pl_schedule_reserve(world)) {
        return PLUMB_E_MEMORY;
    }
    // Systems with `needs` come and go with their component, which is no structural change of
    // physics.
    if (world->schedule_dirty || world->systems.count > 0) {
        pl_schedule_revise(world);
    }
    world->characters.moved = world->one_way_noted = false;
    return run_passes(world, dt);
}

// Nothing has moved; what passes did before motion does not count.
static void undo_step(plumb_world *world)
{
    pl_sleep_undo_open(world);
    pl_air_undo(world);
    pl_liquid_undo(world);
    pl_characters_undo(world);
    pl_sleep_undo_close(world);
    pl_tracks_undo(world);
    pl_ahead_undo(world);
    pl_one_way_undo(world);
    pl_pairs_undo_seek(world, world->lookahead.sought.data, world->lookahead.sought_count);
    pl_internal_edges_undo(world);
    world->narrow.manifold_count = world->narrow.borne_count = 0; // pairs no longer name them
}

plumb_result pl_step(plumb_world *world, real dt)
{
    // Systems walk values beside rows.
    if (!pl_components_align(&world->memory, &world->components, &world->registry,
                             PLUMB_KIND_BODY)) {
        return PLUMB_E_MEMORY;
    }
    pl_tasks_rouse(world->tasks);
    pl_quarantine_begin(world);
    world->watchdog.count = 0;
    pl_dial_begin(world, dt);
    pl_schedule_begin(world);
    plumb_result result = try_step(world, dt);
    while (result == PLUMB_OK && world->quarantine.again) {
        pl_quarantine_undo(world);
        undo_step(world);
        pl_quarantine_finish(world);
        pl_dial_apply(world);
        result = try_step(world, dt);
    }
    pl_tasks_rest(world->tasks);
    if (result == PLUMB_E_MEMORY) {
        undo_step(world);
    }
    pl_sleep_recall_end(world);
    if (result == PLUMB_E_MEMORY) {
        return result;
    }
    if (world->quarantine.lost) {
        pl_quarantine_finish(world);
    }
    world->sleep.events_told |= result == PLUMB_OK;
    pl_contact_index_update(world);
    world->rearranged = false;
    return result;
}
