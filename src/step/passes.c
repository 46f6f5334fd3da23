// passes.c - the step as a table: every pass in order, what it reads and writes, and what wants it.
//
// This array is the architecture. It drives the step (step.c), the timers and `plumb explain`; a
// pass that nothing in the world wants is not in the schedule and costs nothing. A pass that
// changes the world's motion comes after the last one that can run out of memory, so a refused step
// changes nothing.
#include "continuous/continuous.h"
#include "event/event.h"
#include "narrow/ahead.h"
#include "narrow/narrow.h"
#include "narrow/one_way.h"
#include "narrow/surface.h"
#include "step/observer.h"
#include "world/wrap.h"

//---- what is wanted ------------------------------------------------------------------------------

static bool say(bool wanted, const char **reason, const char *because, const char *because_not)
{
    *reason = wanted ? because : because_not;
    return wanted;
}

static bool any_system(const plumb_world *world, plumb_phase phase, const char **reason)
{
    const char *unused;
    bool wanted = false;
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        const pl_system *system = &world->systems.items[i];
        wanted |= system->desc.phase == phase && pl_system_wanted(world, system, &unused);
    }
    return say(wanted, reason, "a system of the user's runs here",
               "no system of the user's runs here");
}

static bool begin_wanted(const plumb_world *world, const char **reason)
{
    return any_system(world, PLUMB_PHASE_BEGIN, reason);
}

static bool forces_wanted(const plumb_world *world, const char **reason)
{
    return any_system(world, PLUMB_PHASE_FORCES, reason);
}

static bool contacts_wanted(const plumb_world *world, const char **reason)
{
    return any_system(world, PLUMB_PHASE_CONTACTS, reason);
}

static bool end_wanted(const plumb_world *world, const char **reason)
{
    return any_system(world, PLUMB_PHASE_END, reason);
}

static bool targets_wanted(const plumb_world *world, const char **reason)
{
    return say(world->targets.count > 0, reason, "kinematic bodies are on their way to a target",
               "no kinematic body has a target");
}

static bool damping_wanted(const plumb_world *world, const char **reason)
{
    return say(world->settings.damped > 0, reason, "some body is damped", "no body is damped");
}

static bool caps_wanted(const plumb_world *world, const char **reason)
{
    return say(world->settings.capped > 0, reason, "some body has a speed cap",
               "no body has a speed cap");
}

static bool own_time_wanted(const plumb_world *world, const char **reason)
{
    return say(world->settings.scaled > 0, reason, "some body has a time scale of its own",
               "all bodies move in the world's time");
}

static bool locks_wanted(const plumb_world *world, const char **reason)
{
    return say(world->locked_bodies > 0, reason, "some body has a locked axis",
               "no body has a locked axis");
}

// Something dynamic has a shape, and there is something to meet; or pairs are left that have to end.
static bool collision_wanted(const plumb_world *world, const char **reason)
{
    bool wanted = world->dynamic_count > 0 && world->moving_count > 0 && world->pieces.live > 1;
    wanted |= world->broad.pairs.count > 0 || world->parts.count > 0;
    return say(wanted, reason, "dynamic bodies have shapes that can meet others",
               "no awake dynamic body has a shape that could meet another");
}

// A sensor that something could meet, or what it saw has to be forgotten.
static bool sensing_wanted(const plumb_world *world, const char **reason)
{
    bool wanted = world->sensor_pieces > 0 && world->moving_count > 0 && world->pieces.live > 1;
    return say(wanted || world->sensing.count > 0 || world->sensing.rest_stale, reason,
               "there are sensors", "no shape is a sensor that could meet another");
}

static bool broad_wanted(const plumb_world *world, const char **reason)
{
    const char *seen;
    if (collision_wanted(world, reason)) {
        return true;
    }
    bool sensing = sensing_wanted(world, &seen);
    *reason = sensing ? seen : *reason;
    return sensing;
}

static bool surfaces_wanted(const plumb_world *world, const char **reason)
{
    return collision_wanted(world, reason) && pl_surfaces_wanted(world, reason);
}

static bool one_way_wanted(const plumb_world *world, const char **reason)
{
    return collision_wanted(world, reason) && pl_one_way_wanted(world, reason);
}

static bool feet_wanted(const plumb_world *world, const char **reason)
{
    return collision_wanted(world, reason) && pl_characters_wanted(world, reason);
}

static bool internal_edges_wanted(const plumb_world *world, const char **reason)
{
    return collision_wanted(world, reason) && pl_internal_edges_wanted(world, reason);
}

static bool joints_wanted(const plumb_world *world, const char **reason)
{
    if (world->joints.live > 0 && !pl_joints_any_awake(world)) {
        return say(false, reason, "", "all that is joined sleeps");
    }
    return say(world->joints.live > 0, reason, "there are joints", "there are no joints");
}

static bool waking_wanted(const plumb_world *world, const char **reason)
{
    return say(world->asleep_count > 0, reason, "some bodies sleep: what touches them wakes them",
               "no body sleeps");
}

static bool sleep_wanted(const plumb_world *world, const char **reason)
{
    if (world->desc.no_sleep) {
        return say(false, reason, "", "the world does not let bodies sleep");
    }
    return say(world->dynamic_count > 0, reason, "what rests long enough falls asleep",
               "no dynamic body is awake");
}

static bool edges_wanted(const plumb_world *world, const char **reason)
{
    return say(pl_is_wrapped(world), reason, "the world wraps around", "the world does not wrap");
}

// Contacts or joints.
static bool solver_wanted(const plumb_world *world, const char **reason)
{
    return joints_wanted(world, reason) || collision_wanted(world, reason);
}

static bool soft_wanted(const plumb_world *world, const char **reason)
{
    if (!solver_wanted(world, reason)) {
        return false;
    }
    return say(world->desc.solver == PLUMB_SOLVER_SOFT, reason, "the world asks for the soft step",
               "the world asks for the classic solver");
}

static bool classic_wanted(const plumb_world *world, const char **reason)
{
    if (!solver_wanted(world, reason)) {
        return false;
    }
    return say(world->desc.solver == PLUMB_SOLVER_PGS, reason,
               "the world asks for the classic solver", "the world asks for the soft step");
}

static bool rotation_wanted(const plumb_world *world, const char **reason)
{
    return say(world->turning_bodies > 0, reason, "some dynamic body can turn",
               "no dynamic body can turn");
}

static bool continuous_wanted(const plumb_world *world, const char **reason)
{
    return collision_wanted(world, reason) && pl_continuous_wanted(world, reason);
}

// A material that some shape is made of.
static bool any_material(const plumb_world *world, const real *column)
{
    for (uint32_t row = 0; row < world->materials.table.count; ++row) {
        if (world->materials.users[row] > 0 && column[row] > 0) {
            return true;
        }
    }
    return false;
}

static bool adhesion_wanted(const plumb_world *world, const char **reason)
{
    return say(any_material(world, world->materials.adhesion) || world->material_pair_count > 0,
               reason, "some shape's material may stick", "no shape's material sticks");
}

static bool friction_wanted(const plumb_world *world, const char **reason)
{
    return say(any_material(world, world->materials.friction), reason,
               "some shape's material has friction", "no shape's material has friction");
}

static bool impacts_wanted(const plumb_world *world, const char **reason)
{
    return say(any_material(world, world->materials.restitution), reason,
               "some shape's material has restitution", "no shape's material has restitution");
}

//---- what is done --------------------------------------------------------------------------------

// What the user does in a step, or what is on the recording of it.
static void run_systems(plumb_world *world, plumb_phase phase, plumb_real dt)
{
    pl_step_observer *observer = world->observer;
    if (observer != NULL && observer->before != NULL) {
        observer->before(observer, world, phase);
    }
    if (observer == NULL || !observer->replays) {
        pl_systems_run(world, phase, dt, world->time);
    }
    if (observer != NULL && observer->after != NULL) {
        observer->after(observer, world, phase);
    }
}

static plumb_result run_guard(plumb_world *world, plumb_real dt)
{
    pl_quarantine_guard(world, dt, "calls");
    return PLUMB_OK;
}

// What they did holds when the step is taken anew (step/quarantine.c).
static void run_once(plumb_world *world, plumb_phase phase, plumb_real dt, const char *pass)
{
    if (world->quarantine.attempt == 0) {
        run_systems(world, phase, dt);
        pl_quarantine_guard(world, dt, pass);
    }
}

static plumb_result run_begin(plumb_world *world, plumb_real dt)
{
    run_once(world, PLUMB_PHASE_BEGIN, dt, "begin systems");
    return PLUMB_OK;
}

static plumb_result run_forces(plumb_world *world, plumb_real dt)
{
    run_once(world, PLUMB_PHASE_FORCES, dt, "force systems");
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
    return pl_broad_update(world, dt) ? PLUMB_OK : PLUMB_E_MEMORY;
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

static plumb_result run_contacts(plumb_world *world, plumb_real dt)
{
    pl_edits_open(world);
    run_systems(world, PLUMB_PHASE_CONTACTS, dt);
    pl_edits_close(world);
    pl_quarantine_guard_late(world, dt, "contact systems");
    return PLUMB_OK;
}

static plumb_result run_graph(plumb_world *world, plumb_real dt)
{
    (void)dt;
    const char *unused;
    bool room = pl_solver_graph(world) &&
                (!continuous_wanted(world, &unused) || pl_continuous_reserve(world)) &&
                pl_quarantine_keep(world);
    return room ? PLUMB_OK : PLUMB_E_MEMORY;
}

static plumb_result run_soft(plumb_world *world, plumb_real dt)
{
    pl_solver_soft(world, dt);
    pl_quarantine_judge(world, dt, "soft step");
    return PLUMB_OK;
}

static plumb_result run_classic(plumb_world *world, plumb_real dt)
{
    pl_solver_pgs(world, dt);
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

static plumb_result run_end(plumb_world *world, plumb_real dt)
{
    run_systems(world, PLUMB_PHASE_END, dt);
    return PLUMB_OK;
}

// Phase of the passes that run the user's systems, in the order of plumb_phase.
const char pl_user_phase[] = "user";

// clang-format off
const pl_pass pl_passes[] = {
    //name             phase       reads                              writes                       wanted            run             refreshes
    { "guard",         "commands", "velocities, forces",              "rows of what is not finite", NULL,              run_guard,      true  },
    { "begin systems", pl_user_phase, "declared by the systems",         "declared by the systems",   begin_wanted,     run_begin,      false },
    { "force systems", pl_user_phase, "declared by the systems",         "declared by the systems",   forces_wanted,    run_forces,     false },
    { "characters",    "forces",   "grids, poses, velocities",        "velocities, forces",        pl_characters_wanted, run_characters, false },
    { "waking",      "broad",    "islands, pieces, grids, joints",   "rows, pairs, fat boxes",     waking_wanted,    run_waking,     true  },
    { "broad phase",   "broad",    "poses, pieces",                   "fat boxes, grids, pairs",   broad_wanted,     run_broad,      true  },
    { "internal edges", "broad",    "static pieces, grids, pairs",     "covered edges, corners",    internal_edges_wanted,     run_internal_edges,      true  },
    { "narrow phase",  "narrow",   "pairs, poses, pieces, materials", "manifolds",                 collision_wanted, run_narrow,     true  },
    { "- one-way",     "narrow",   "manifolds, pieces, rotations",    "manifolds, pairs",          one_way_wanted,   NULL,           true  },
    { "surfaces",      "narrow",   "pairs, materials",                "manifolds",                 surfaces_wanted,  run_surfaces,   true  },
    { "feet",          "narrow",   "manifolds, characters",           "manifolds",                 feet_wanted,      run_feet,       false },
    { "sleep",       "narrow",   "velocities, pairs, joints",        "islands, rows, pairs, manifolds", sleep_wanted, run_sleep,      false },
    { "sensor pairs",  "narrow",   "pairs with sensors",              "candidates of sensors",     sensing_wanted,   run_candidates, true  },
    { "contact systems", pl_user_phase, "declared by the systems",         "declared by the systems",   contacts_wanted,  run_contacts,   true  },
    { "graph",         "solve",    "manifolds, velocities, forces",   "solver bodies, colours",    solver_wanted,    run_graph,      false },
    { "soft step",     "solve",    "manifolds, solver bodies",        "solver bodies, impulses",   soft_wanted,      run_soft,       false },
    { "classic solver", "solve",   "manifolds, solver bodies",        "solver bodies, impulses",   classic_wanted,   run_classic,    false },
    { "- friction",    "solve",    "materials",                       "solver bodies, impulses",   friction_wanted,  NULL,           false },
    { "- rotation",    "solve",    "inertias",                        "solver bodies",             rotation_wanted,  NULL,           false },
    { "- impacts",     "solve",    "materials, manifolds",            "solver bodies",             impacts_wanted,   NULL,           false },
    { "- adhesion",    "solve",    "materials, manifolds",            "solver bodies, impulses",   adhesion_wanted,  NULL,           false },
    { "- locked axes", "solve",    "bodies",                          "solver bodies, impulses",   locks_wanted,     NULL,           false },
    { "- damping",     "solve",    "settings",                         "solver bodies, velocities", damping_wanted,   NULL,           false },
    { "- speed caps",  "solve",    "settings",                         "solver bodies, velocities", caps_wanted,      NULL,           false },
    { "- own time",    "solve",    "settings",                         "solver bodies, transforms", own_time_wanted,  NULL,           false },
    { "- joints",      "solve",    "joints, poses",                   "solver bodies, joints",     joints_wanted,    NULL,           false },
    { "motion",        "finish",   "solver bodies, forces, gravity",  "transforms, velocities",    NULL,             run_motion,     false },
    { "continuous",    "finish",   "bodies that moved fast, pieces",  "transforms",                continuous_wanted, run_continuous, false },
    { "targets",       "finish",   "targets, poses",                  "kinematic poses, velocities", targets_wanted, run_arrive,     false },
    { "edges",         "finish",   "transforms",                      "transforms",                edges_wanted,     run_edges,      false },
    { "reactions",     "finish",   "joints, poses",                   "joints, break events",      joints_wanted,    run_reactions,  false },
    { "events",        "finish",   "pairs, manifolds",                "event arrays",              collision_wanted, run_events,     true  },
    { "sensors",       "finish",   "candidates, poses, pieces",       "overlaps, sensor events",   sensing_wanted,   run_sensors,    true  },
    { "end systems",   pl_user_phase, "declared by the systems",         "declared by the systems",   end_wanted,       run_end,        false },
};
// clang-format on

const int pl_pass_count = (int)(sizeof pl_passes / sizeof pl_passes[0]);

_Static_assert(sizeof pl_passes / sizeof pl_passes[0] <= PL_PASS_MAX, "raise PL_PASS_MAX");
