// step.c - drives the pass table: the schedule, the step, the timers, and the schedule's public
// view.
#include "core/clock.h"
#include "event/event.h"
#include "step/observer.h"
#include "world/check.h"
#include "world/state.h"

// Asks every pass whether it is wanted.
static void revise_schedule(plumb_world *world)
{
    pl_schedule *schedule = &world->schedule;
    for (int i = 0; i < pl_pass_count; ++i) {
        schedule->reason[i] = "part of every step";
        schedule->scheduled[i] =
            pl_passes[i].wanted == NULL || pl_passes[i].wanted(world, &schedule->reason[i]);
        if (!schedule->scheduled[i]) {
            schedule->last_ns[i] = 0;
        }
    }
    world->schedule_dirty = false;
}

// Nothing is left from a step in which there was collision.
static void forget_contacts(plumb_world *world)
{
    world->narrow.manifold_count = world->narrow.borne_count = 0;
    world->narrow.any_friction = world->narrow.any_elastic = world->narrow.any_low = false;
    world->solver.slot_count = 0;
    world->solver.follows_impacts = false;
    world->joints.broken_count = world->joints.strained_count = 0;
    world->broad.refreshed = false;
    world->internal_edges.noted = world->internal_edges.opened = false;
    world->continuous.count = world->continuous.stopped_count = 0;
    world->continuous.noting = false;
}

static plumb_result run_passes(plumb_world *world, plumb_real dt)
{
    pl_schedule *schedule = &world->schedule;
    double start = pl_now_ns();
    for (int i = 0; i < pl_pass_count; ++i) {
        if (!schedule->scheduled[i] || pl_passes[i].run == NULL ||
            (dt == 0 && !pl_passes[i].refreshes)) {
            continue;
        }
        world->query_grids.fresh = false; // what systems ask about moves from pass to pass
        plumb_result result = pl_passes[i].run(world, dt);
        if (result != PLUMB_OK) {
            return result;
        }
        if (world->quarantine.again) {
            return PLUMB_OK;
        }
        if (world->observer != NULL && world->observer->passed != NULL) {
            world->observer->passed(world->observer, world, i);
        }
        // Bodies that fell asleep or woke may leave passes without anything to do, or give them some.
        if (world->schedule_dirty) {
            revise_schedule(world);
        }
        double end = pl_now_ns();
        schedule->last_ns[i] = end - start;
        schedule->total_ns[i] += end - start;
        start = end;
    }
    return PLUMB_OK;
}

// The passes, from the beginning. Of a step of dt 0 only those that move nothing (pl_pass.refreshes), and those only
// where something was rearranged since the last step: else contacts, overlaps and grids are as that step left
// them, and to look again could only change what the next step starts from.
static plumb_result try_step(plumb_world *world, plumb_real dt)
{
    pl_events_clear(world);
    pl_edits_forget(world);
    if (dt == 0 && !world->rearranged) {
        world->joints.broken_count = world->joints.strained_count =
            0; // that is an event; contacts are those of the last step
        return PLUMB_OK;
    }
    forget_contacts(world);
    // Systems with `needs` come and go with their component, which is no structural change of
    // physics.
    if (world->schedule_dirty || world->systems.count > 0) {
        revise_schedule(world);
    }
    world->characters.moved = false;
    return run_passes(world, dt);
}

// Nothing has moved; what passes did before motion does not count.
static void undo_step(plumb_world *world)
{
    pl_characters_undo(world);
    pl_internal_edges_undo(world);
    world->narrow.manifold_count = world->narrow.borne_count = 0; // pairs no longer name them
}

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
    // Systems walk values beside rows.
    if (!pl_components_align(&world->memory, &world->components, &world->registry,
                             PLUMB_KIND_BODY)) {
        return pl_fail_memory(world, __func__);
    }
    if (observer != NULL) {
        observer->steps = true;
    }
    pl_tasks_rouse(world->tasks);
    pl_quarantine_begin(world);
    result = try_step(world, dt);
    while (result == PLUMB_OK && world->quarantine.again) {
        pl_quarantine_undo(world);
        undo_step(world);
        pl_quarantine_finish(world);
        result = try_step(world, dt);
    }
    pl_tasks_rest(world->tasks);
    if (observer != NULL) {
        observer->steps = false;
    }
    if (result == PLUMB_E_MEMORY) {
        undo_step(world);
        return pl_fail_memory(world, __func__);
    }
    if (world->quarantine.lost) {
        pl_quarantine_finish(world);
    }
    world->sleep.events_told |= result == PLUMB_OK;
    world->rearranged = false;
    if (observer != NULL && observer->end != NULL) {
        observer->end(observer, world, dt);
    }
    return result;
}

typedef struct listing {
    plumb_pass_info *rows;
    int capacity, count;
} listing;

static void list_row(listing *out, plumb_pass_info row)
{
    if (out->count < out->capacity) {
        out->rows[out->count] = row;
    }
    ++out->count;
}

static void list_systems(listing *out, const plumb_world *world, plumb_phase phase)
{
    static const char *const phase_names[] = { "begin", "forces", "contacts", "end" };
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        const pl_system *system = &world->systems.items[i];
        if (system->desc.phase != phase) {
            continue;
        }
        plumb_pass_info row = { .name = system->name,
                                .phase = phase_names[phase],
                                .reads = system->reads,
                                .writes = system->writes,
                                .is_user = true,
                                .last_ns = system->last_ns,
                                .total_ns = system->total_ns };
        row.scheduled = pl_system_wanted(world, system, &row.reason);
        list_row(out, row);
    }
}

int plumb_world_schedule(const plumb_world *world, plumb_pass_info *rows, int capacity)
{
    if (world == NULL) {
        return 0;
    }
    listing out = { rows, rows == NULL ? 0 : capacity, 0 };
    int phase = PLUMB_PHASE_BEGIN;
    for (int i = 0; i < pl_pass_count; ++i) {
        const pl_pass *pass = &pl_passes[i];
        if (pass->phase == pl_user_phase) {
            list_systems(&out, world, (plumb_phase)phase++);
            continue;
        }
        plumb_pass_info row = { .name = pass->name,
                                .phase = pass->phase,
                                .reads = pass->reads,
                                .writes = pass->writes,
                                .reason = "part of every step",
                                .last_ns = world->schedule.last_ns[i],
                                .total_ns = world->schedule.total_ns[i] };
        row.scheduled = pass->wanted == NULL || pass->wanted(world, &row.reason);
        list_row(&out, row);
    }
    return out.count;
}
