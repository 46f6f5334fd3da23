// passes.c - the step as a table: every row of ours in order, what it reads and writes, what wants it, what runs it.
//
// This array is the architecture. It drives the step (step.c) and the substeps (solver/substep.c), the timers, the
// check of what is written (check.c) and `plumb explain`. A row that nothing in the world wants is not in the schedule
// and costs nothing. Systems of the user stand between these rows (schedule.c). A pass that changes the world's motion
// comes after the last one that can run out of memory, so a refused step changes nothing.
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
#include "step/wanted.h"
#include "world/wrap.h"

//---- what is done once a step --------------------------------------------------------------------

static plumb_result run_guard(plumb_world *world, plumb_real dt)
{
    pl_quarantine_guard(world, dt, "calls");
    return PLUMB_OK;
}

static plumb_result run_characters(plumb_world *world, plumb_real dt)
{
    return pl_characters_move(world, dt) ? PLUMB_OK : PLUMB_E_MEMORY;
}

static plumb_result run_feet(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_characters_feet(world);
    return PLUMB_OK;
}

static plumb_result run_waking(plumb_world *world, plumb_real dt)
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

static plumb_result run_sleep(plumb_world *world, plumb_real dt)
{
    return pl_sleep_fall(world, dt) ? PLUMB_OK : PLUMB_E_MEMORY;
}

static plumb_result run_arrive(plumb_world *world, plumb_real dt)
{
    pl_targets_arrive(world, dt);
    return PLUMB_OK;
}

static plumb_result run_broad(plumb_world *world, plumb_real dt)
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

static plumb_result run_narrow(plumb_world *world, plumb_real dt)
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

static plumb_result run_internal_edges(plumb_world *world, plumb_real dt)
{
    (void)dt;
    return pl_internal_edges_update(world) ? PLUMB_OK : PLUMB_E_MEMORY;
}

static plumb_result run_candidates(plumb_world *world, plumb_real dt)
{
    (void)dt;
    return pl_sensing_prepare(world) ? PLUMB_OK : PLUMB_E_MEMORY;
}

static plumb_result run_surfaces(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_surfaces_mix(world);
    return PLUMB_OK;
}

static plumb_result run_sensors(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_sensing_run(world);
    return PLUMB_OK;
}

static plumb_result run_graph(plumb_world *world, plumb_real dt)
{
    (void)dt;
    const char *unused;
    bool room = pl_solver_graph(world) &&
                (!pl_want_continuous(world, &unused) || pl_continuous_reserve(world)) &&
                pl_quarantine_keep(world);
    return room ? PLUMB_OK : PLUMB_E_MEMORY;
}

static plumb_result run_gravity(plumb_world *world, plumb_real dt)
{
    (void)dt;
    world->effects.gravity = world->gravity;
    return PLUMB_OK;
}

static plumb_result run_called(plumb_world *world, plumb_real dt)
{
    (void)dt;
    return pl_acting_call(world) ? PLUMB_OK : PLUMB_E_MEMORY;
}

static plumb_result run_acting(plumb_world *world, plumb_real dt)
{
    return pl_acting_find(world, dt) ? PLUMB_OK : PLUMB_E_MEMORY;
}

static plumb_result run_soft(plumb_world *world, plumb_real dt)
{
    pl_schedule_substeps(world, dt);
    pl_quarantine_judge(world, dt, "soft step");
    return PLUMB_OK;
}

static plumb_result run_classic(plumb_world *world, plumb_real dt)
{
    pl_schedule_substeps(world, dt);
    pl_quarantine_judge(world, dt, "classic solver");
    return PLUMB_OK;
}

static plumb_result run_motion(plumb_world *world, plumb_real dt)
{
    pl_solver_finish(world, dt);
    pl_sleep_clear_forces(world);
    world->time += (double)dt;
    world->last_dt = dt;
    ++world->step_count;
    return PLUMB_OK;
}

static plumb_result run_continuous(plumb_world *world, plumb_real dt)
{
    pl_continuous_run(world, dt);
    return PLUMB_OK;
}

static plumb_result run_edges(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_wrap_bodies(world);
    return PLUMB_OK;
}

static plumb_result run_reactions(plumb_world *world, plumb_real dt)
{
    pl_joints_finish(world, dt);
    return PLUMB_OK;
}

static plumb_result run_events(plumb_world *world, plumb_real dt)
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

// Names of data are those of data.h. A row without a function is where systems of a phase stand.
#define ONCE(run)           run, NULL, NULL
#define EACH(row)           NULL, row, row
#define BOTH(soft, classic) NULL, soft, classic
#define HOME                NULL, NULL, NULL

// clang-format off
const pl_pass pl_passes[] = {
    //name                 stage                 reads                                        writes                                       wanted                  run                                                   kind            variants
    { "guard",             PL_STAGE_COMMANDS,    "velocities, forces",                        "rows",                                      NULL,                   ONCE(run_guard),                                      PL_REFRESHES,   NULL },
    { "begin systems",     PL_STAGE_BEGIN,       "",                                          "",                                          NULL,                   HOME,                                                 PL_ONCE,        NULL },
    { "force systems",     PL_STAGE_FORCES,      "",                                          "",                                          NULL,                   HOME,                                                 PL_ONCE,        NULL },
    { "characters",        PL_STAGE_FORCES,      "grids, poses, velocities",                  "velocities, forces, characters, poses, rows, islands", pl_characters_wanted,   ONCE(run_characters),                                 PL_ONCE,        NULL },
    { "waking",            PL_STAGE_PAIRS,       "islands, pieces, grids, joints",            "rows, pairs, grids, islands",               pl_want_waking,         ONCE(run_waking),                                     PL_REFRESHES,   NULL },
    { "broad phase",       PL_STAGE_PAIRS,       "poses, pieces",                             "grids, pairs, events",                      pl_want_broad,          ONCE(run_broad),                                      PL_REFRESHES,   NULL },
    { "internal edges",    PL_STAGE_PAIRS,       "pieces, grids, pairs",                      "internal edges",                            pl_want_internal_edges, ONCE(run_internal_edges),                             PL_REFRESHES,   NULL },
    { "narrow phase",      PL_STAGE_CONTACTS,    "pairs, poses, pieces, materials",           "manifolds, pairs, internal edges",          pl_want_collision,      ONCE(run_narrow),                                     PL_REFRESHES,   pl_narrow_variants },
    { "surfaces",          PL_STAGE_CONTACTS,    "pairs, materials",                          "manifolds",                                 pl_want_surfaces,       ONCE(run_surfaces),                                   PL_REFRESHES,   NULL },
    { "feet",              PL_STAGE_CONTACTS,    "manifolds, characters",                     "manifolds, characters",                     pl_want_feet,           ONCE(run_feet),                                       PL_ONCE,        NULL },
    { "sleep",             PL_STAGE_CONTACTS,    "velocities, pairs, joints",                 "islands, rows, pairs, manifolds, velocities", pl_want_sleep,          ONCE(run_sleep),                                      PL_ONCE,        NULL },
    { "sensor pairs",      PL_STAGE_CONTACTS,    "pairs",                                     "sensors",                                   pl_want_sensing,        ONCE(run_candidates),                                 PL_REFRESHES,   NULL },
    { "contact systems",   PL_STAGE_EDITS,       "",                                          "",                                          NULL,                   HOME,                                                 PL_REFRESHES,   NULL },
    { "gravity",           PL_STAGE_GRAPH,       "settings",                                  "accelerations",                             pl_want_gravity,        ONCE(run_gravity),                                    PL_REPLACEABLE, NULL },
    { "called",            PL_STAGE_GRAPH,       "components, rows",                          "constraints",                               pl_want_called,         ONCE(run_called),                                     PL_ONCE,        NULL },
    { "graph",             PL_STAGE_GRAPH,       "manifolds, velocities, forces, masses, joints", "solver bodies, accelerations, constraints, joints, movers", pl_want_solver,         ONCE(run_graph),                                      PL_ONCE,        pl_gather_variants },
    { "acting",            PL_STAGE_GRAPH,       "body settings, components, solver bodies",       "constraints",                     pl_want_acting,         ONCE(run_acting),                                     PL_ONCE,        NULL },

    // The substeps: rows up to "store contacts" run inside of one of these two, cluster by cluster of islands.
    { "soft step",         PL_STAGE_SOLVE,       "manifolds",                                 "manifolds, pairs, joints, solver bodies, accelerations, constraints, rows", pl_want_soft,           ONCE(run_soft),                                       PL_ONCE,        NULL },
    { "classic solver",    PL_STAGE_SOLVE,       "manifolds",                                 "manifolds, pairs, joints, solver bodies, accelerations, constraints, rows", pl_want_classic,        ONCE(run_classic),                                    PL_ONCE,        NULL },
    { "prepare contacts",  PL_STAGE_PREPARE,     "manifolds, solver bodies",                  "constraints",                               pl_want_collision,      BOTH(pl_soft_prepare, pl_classic_prepare),            PL_ONCE,        pl_contact_variants },
    { "prepare impacts",   PL_STAGE_PREPARE,     "manifolds, constraints",                    "constraints",                               pl_want_impacts,        BOTH(pl_impacts_row_prepare, pl_impacts_row_classic), PL_ONCE,        NULL },
    { "prepare joints",    PL_STAGE_PREPARE,     "joints, poses, solver bodies",              "joints, constraints",                       pl_want_joints,         EACH(pl_joints_row_prepare),                          PL_ONCE,        NULL },
    { "forces of now",     PL_STAGE_MOMENT,      "accelerations",                             "accelerations",                             pl_want_reset,          EACH(pl_acting_reset),                                PL_ONCE,        NULL },
    { "substep systems",   PL_STAGE_MOMENT,      "",                                          "",                                          NULL,                   HOME,                                                 PL_ONCE,        NULL },
    { "damping",           PL_STAGE_MOMENT,      "solver bodies, body settings",                   "accelerations",                             pl_want_damping,        EACH(pl_damping_row),                                 PL_REPLACEABLE, NULL },
    { "speed caps",        PL_STAGE_MOMENT,      "solver bodies, body settings",                   "accelerations",                             pl_want_caps,           EACH(pl_caps_row),                                    PL_REPLACEABLE, NULL },
    { "integrate",         PL_STAGE_VELOCITIES,  "accelerations",                             "solver bodies, accelerations",              pl_want_solver,         BOTH(pl_soft_integrate, pl_classic_integrate),        PL_ONCE,        NULL },
    { "warm start joints", PL_STAGE_VELOCITIES,  "joints",                                    "solver bodies, joints",                     pl_want_joints,         EACH(pl_joints_row_warm_start),                       PL_ONCE,        NULL },
    { "warm start",        PL_STAGE_VELOCITIES,  "constraints",                               "solver bodies, constraints",                pl_want_collision,      BOTH(pl_soft_warm_start, pl_classic_warm_start),      PL_ONCE,        NULL },
    { "impacts",           PL_STAGE_VELOCITIES,  "constraints",                               "solver bodies, constraints, pairs, manifolds", pl_want_impacts,        BOTH(pl_soft_impacts, pl_classic_impacts),             PL_ONCE,        NULL },
    { "joints",            PL_STAGE_CONSTRAINTS, "joints, constraints",                       "solver bodies, joints, constraints",        pl_want_joints,         BOTH(pl_joints_row_solve, pl_joints_row_classic),     PL_ONCE,        NULL },
    { "contacts",          PL_STAGE_CONSTRAINTS, "constraints",                               "solver bodies, constraints",                pl_want_collision,      BOTH(pl_soft_contacts, pl_classic_contacts),          PL_ONCE,        pl_contact_variants },
    { "positions",         PL_STAGE_POSITIONS,   "solver bodies, accelerations",              "solver bodies, joints",                     pl_want_solver,         BOTH(pl_move_bodies, pl_classic_move),                PL_ONCE,        NULL },
    { "relax joints",      PL_STAGE_RELAX,       "joints, constraints",                       "solver bodies, joints, constraints",        pl_want_joints,         BOTH(pl_joints_row_relax, pl_joints_row_correct),     PL_ONCE,        NULL },
    { "relax contacts",    PL_STAGE_RELAX,       "constraints",                               "solver bodies, constraints",                pl_want_collision,      BOTH(pl_soft_relax, pl_classic_correct),              PL_ONCE,        pl_contact_variants },
    { "sum reactions",     PL_STAGE_SUMS,        "joints, constraints",                       "joints, constraints",                       pl_want_reactions,      BOTH(pl_joints_row_sum, NULL),                        PL_ONCE,        NULL },
    { "sum impulses",      PL_STAGE_SUMS,        "constraints",                               "constraints, manifolds",                    pl_want_sums,           BOTH(pl_soft_sum, pl_classic_sum),                    PL_ONCE,        NULL },
    { "store joints",      PL_STAGE_STORE,       "constraints",                               "joints",                                    pl_want_joints,         BOTH(pl_joints_row_store, NULL),                      PL_ONCE,        NULL },
    { "store contacts",    PL_STAGE_STORE,       "constraints",                               "pairs, manifolds",                          pl_want_collision,      BOTH(pl_soft_store, pl_classic_store),                PL_ONCE,        NULL },

    { "motion",            PL_STAGE_FINISH,      "solver bodies, forces, masses",             "poses, velocities, forces, movers, time", NULL,                   ONCE(run_motion),                                     PL_ONCE,        pl_motion_variants },
    { "continuous",        PL_STAGE_FINISH,      "movers, pieces, grids",                     "poses, velocities, movers, manifolds, pairs, joints, events", pl_want_continuous,     ONCE(run_continuous),                                 PL_ONCE,        NULL },
    { "targets",           PL_STAGE_FINISH,      "targets, poses",                            "poses, velocities, targets",                pl_want_targets,        ONCE(run_arrive),                                     PL_REPLACEABLE, NULL },
    { "edges",             PL_STAGE_FINISH,      "poses",                                     "poses",                                     pl_want_edges,          ONCE(run_edges),                                      PL_ONCE,        NULL },
    { "reactions",         PL_STAGE_FINISH,      "joints, poses",                             "joints, rows, events, islands, components, pairs", pl_want_joints,         ONCE(run_reactions),                                  PL_ONCE,        NULL },
    { "events",            PL_STAGE_EVENTS,      "pairs, manifolds",                          "events, pairs, internal edges, manifolds",  pl_want_collision,      ONCE(run_events),                                     PL_REFRESHES,   NULL },
    { "sensors",           PL_STAGE_EVENTS,      "sensors, poses, pieces",                    "sensors, events",                           pl_want_sensing,        ONCE(run_sensors),                                    PL_REFRESHES,   NULL },
    { "end systems",       PL_STAGE_END,         "",                                          "",                                          NULL,                   HOME,                                                 PL_ONCE,        NULL },
};
// clang-format on

const int pl_pass_count = (int)(sizeof pl_passes / sizeof pl_passes[0]);

_Static_assert(sizeof pl_passes / sizeof pl_passes[0] <= PL_PASS_MAX, "raise PL_PASS_MAX");
