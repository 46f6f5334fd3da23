// passes.h - the step: a row a pass, in order. From the rows follow the schedule (step/passes.c), with what it shows,
// times and checks, and the prototypes of what they name: a pass is its file and a row here.
//
//     X(name, stage, wanted, run, kind, reads, writes, variants)
//
//   name      in the schedule
//   stage     of pl_stage (step/pass.h); rows are in the order of their stages
//   wanted    ALWAYS; IF(f): bool f(world, &reason), whether this world needs it; the reason is a static string
//   run       ONCE(f): plumb_result f(world, dt), once a step, where f may run out of memory; of the stages PREPARE to STORE a
//             function of the substep and cluster (world/substep.h): EACH(f) with all solvers, THREE(soft,
//             classic, exact), BOTH(soft, classic), NOT_CLASSIC(f), SOFT(f), EXACT(f); ACTS(f, whom): an effect with all, on the
//             dynamic bodies of whom bool whom(world, row) is true: the solver moves them; HOME: the place of the
//             user's systems of a phase
//   kind      ONCE a step; REFRESHES: in a step of dt 0 as well, it moves nothing; REPLACEABLE: a system may take its
//             place, nothing behind it relies on what it leaves
//   reads     names of data (step/data.h), which the check of what is written holds it to; and
//   writes
//   variants  ONE; HAS(f): void f(world, variants) says which variants of its kernels run, and which do not
//
// A row that nothing in the world wants is not in the schedule and costs nothing. A pass that changes the world's motion
// comes after the last one that can run out of memory, so a refused step changes nothing.
#ifndef PL_PASSES_H
#define PL_PASSES_H

#include "plumb/world.h"

// clang-format off
#define PL_PASSES(X)                                                                                                                         \
    X("measure",           COMMANDS,    IF(pl_want_measures),        ONCE(pl_run_measure_open),                              ONCE,           \
      "poses, velocities, masses, joints", "", ONE)                                                                                          \
    X("watch",             COMMANDS,    IF(pl_want_watchdog),        ONCE(pl_run_watch),                                     ONCE,           \
      "poses, velocities, masses, pieces, joints", "", ONE)                                                                                  \
    X("guard",             COMMANDS,    ALWAYS,                      ONCE(pl_run_guard),                                     REFRESHES,      \
      "velocities, forces", "rows", ONE)                                                                                                     \
    X("begin systems",     BEGIN,       ALWAYS,                      HOME,                                                   ONCE,           \
      "", "", ONE)                                                                                                                           \
    X("force systems",     FORCES,      ALWAYS,                      HOME,                                                   ONCE,           \
      "", "", ONE)                                                                                                                           \
    X("tracks",           FORCES,      IF(pl_want_tracks),           ONCE(pl_run_tracks),                                     ONCE,           \
      "targets, rows", "velocities, poses", ONE)                                                                                             \
    X("characters",        FORCES,      IF(pl_characters_wanted),    ONCE(pl_run_characters),                                ONCE,           \
      "grids, poses, velocities", "velocities, forces, characters, poses, rows, islands", ONE)                                               \
    X("liquid",            FORCES,      IF(pl_want_liquid),          ONCE(pl_run_liquid),                                    ONCE,           \
      "liquid, soft bodies, poses, velocities, masses, pieces, forces", "forces, islands", ONE)                                              \
    X("air",               FORCES,      IF(pl_want_air),             ONCE(pl_run_air),                                       ONCE,           \
      "air, poses, velocities, masses, pieces, forces", "forces, islands", ONE)                                                              \
    X("waking",            PAIRS,       IF(pl_want_waking),          ONCE(pl_run_waking),                                    REFRESHES,      \
      "islands, pieces, grids, joints, soft bodies", "rows, pairs, grids, islands", ONE)                                                     \
    X("broad phase",       PAIRS,       IF(pl_want_broad),           ONCE(pl_run_broad),                                     REFRESHES,      \
      "poses, pieces", "grids, pairs, events", ONE)                                                                                          \
    X("internal edges",    PAIRS,       IF(pl_want_internal_edges),  ONCE(pl_run_internal_edges),                            REFRESHES,      \
      "pieces, grids, pairs", "internal edges", ONE)                                                                                         \
    X("narrow phase",      CONTACTS,    IF(pl_want_collision),       ONCE(pl_run_narrow),                                    REFRESHES,      \
      "pairs, poses, pieces, materials, grids, islands", "manifolds, pairs, internal edges, grids, rows, islands, events", HAS(pl_narrow_variants))                                        \
    X("surfaces",          CONTACTS,    IF(pl_want_surfaces),        ONCE(pl_run_surfaces),                                  REFRESHES,      \
      "pairs, materials", "manifolds", ONE)                                                                                                  \
    X("feet",              CONTACTS,    IF(pl_want_feet),            ONCE(pl_run_feet),                                      ONCE,           \
      "manifolds, characters", "manifolds, characters", ONE)                                                                                 \
    X("sleep",             CONTACTS,    IF(pl_want_sleep),           ONCE(pl_run_sleep),                                     ONCE,           \
      "velocities, pairs, joints, soft bodies", "islands, rows, pairs, manifolds, velocities, soft bodies", ONE)                             \
    X("sensor pairs",      CONTACTS,    IF(pl_want_sensing),         ONCE(pl_run_candidates),                                REFRESHES,      \
      "pairs", "sensors", ONE)                                                                                                               \
    X("breakable",         CONTACTS,    IF(pl_want_breaking),        ONCE(pl_run_breakable),                                 ONCE,           \
      "body settings, velocities", "events", ONE)                                                                                                        \
    X("heat contacts",     CONTACTS,    IF(pl_want_heat),            ONCE(pl_run_heat),                                      ONCE,           \
      "pairs, islands", "", ONE)                                                                                                             \
    X("contact systems",   EDITS,       ALWAYS,                      HOME,                                                   REFRESHES,      \
      "", "", ONE)                                                                                                                           \
    X("gravity",           GRAPH,       IF(pl_want_gravity),         ONCE(pl_run_gravity),                                   REPLACEABLE,    \
      "settings", "accelerations", ONE)                                                                                                      \
    X("fluids",              GRAPH,       IF(pl_want_fluids),           ONCE(pl_run_fluids),                                     ONCE,              \
      "sensors, pieces, materials", "constraints, islands", ONE)                                                                                    \
    X("laws",              GRAPH,       IF(pl_want_laws),            ONCE(pl_run_laws),                                      ONCE,           \
      "poses, velocities, masses, body settings, pieces, manifolds, joints", "constraints", ONE)                                    \
    X("soft bodies",       GRAPH,       IF(pl_want_softbodies),      ONCE(pl_run_softbodies),                                ONCE,           \
      "soft bodies, poses, velocities, masses, pieces, rows", "", ONE)                                                                       \
    X("called",            GRAPH,       IF(pl_want_called),          ONCE(pl_run_called),                                    ONCE,           \
      "components, rows", "constraints", ONE)                                                                                                \
    X("clusters",          GRAPH,       IF(pl_want_solver),          ONCE(pl_run_clusters),                                  ONCE,           \
      "manifolds, joints, islands", "constraints, joints", ONE)                                                                              \
    X("islands apart",     GRAPH,       IF(pl_want_apart),           ONCE(pl_run_apart),                                     ONCE,           \
      "manifolds, pairs, joints, masses", "constraints, pairs", ONE)                                                                         \
    X("graph",             GRAPH,       IF(pl_want_solver),          ONCE(pl_run_graph),                                     ONCE,           \
      "manifolds, velocities, forces, masses, joints", "solver bodies, accelerations, constraints, joints, movers", HAS(pl_gather_variants)) \
    X("waves",               GRAPH,       IF(pl_want_waves),            ONCE(pl_run_waves),                                      ONCE,              \
      "waves, pieces, poses, materials", "islands", ONE)                                                                                              \
    X("immersion",           GRAPH,       IF(pl_want_fluids),           ONCE(pl_run_immersion),                                  ONCE,              \
      "pieces, poses, materials, solver bodies", "constraints, solver bodies", ONE)                                                                 \
    X("engines",           GRAPH,       IF(pl_want_engines),         ONCE(pl_run_engines),                                   ONCE,           \
      "solver bodies, forces, masses, body settings", "solver bodies, accelerations", ONE)                                                   \
    X("law slots",         GRAPH,       IF(pl_want_laws),            ONCE(pl_run_law_slots),                                 ONCE,           \
      "solver bodies", "constraints", ONE)                                                                                                   \
    X("soft slots",        GRAPH,       IF(pl_want_softbodies),      ONCE(pl_run_soft_slots),                                ONCE,           \
      "soft bodies, solver bodies", "", ONE)                                                                                                 \
    X("acting",            GRAPH,       IF(pl_want_acting),          ONCE(pl_run_acting),                                    ONCE,           \
      "body settings, components, solver bodies", "constraints", ONE)                                                                        \
    X("measure bodies",    GRAPH,       IF(pl_want_measures),        ONCE(pl_run_measure_bodies),                            ONCE,           \
      "solver bodies, masses", "", ONE)                                                                                                      \
    X("elimination",       GRAPH,       IF(pl_want_direct),          ONCE(pl_run_elimination),                               ONCE,           \
      "manifolds, joints, solver bodies", "constraints", ONE)                                                                                \
    /* The substeps: rows up to "store contacts" run inside of one of the next three, cluster by cluster of islands. */                       \
    X("soft step",         SOLVE,       IF(pl_want_soft),            ONCE(pl_run_soft),                                      ONCE,           \
      "manifolds", "manifolds, pairs, joints, solver bodies, accelerations, constraints, rows", ONE)                                         \
    X("classic solver",    SOLVE,       IF(pl_want_classic),         ONCE(pl_run_classic),                                   ONCE,           \
      "manifolds", "manifolds, pairs, joints, solver bodies, accelerations, constraints, rows", ONE)                                         \
    X("exact solver",      SOLVE,       IF(pl_want_exact),           ONCE(pl_run_exact),                                     ONCE,           \
      "manifolds", "manifolds, pairs, joints, solver bodies, accelerations, constraints, rows", ONE)                                         \
    X("prepare joints",    PREPARE,     IF(pl_want_joints),          EACH(pl_joints_row_prepare),                            ONCE,           \
      "joints, poses, solver bodies", "joints, constraints, solver bodies", ONE)                                                                            \
    X("prepare contacts",  PREPARE,     IF(pl_want_collision),       THREE(pl_soft_prepare, pl_classic_prepare, pl_classic_prepare), ONCE,           \
      "manifolds, solver bodies", "constraints", HAS(pl_contact_variants))                                                                   \
    X("prepare impacts",   PREPARE,     IF(pl_want_impacts),         THREE(pl_impacts_row_prepare, pl_impacts_row_classic, pl_impacts_row_classic), ONCE,           \
      "manifolds, constraints", "constraints", ONE)                                                                                          \
    X("forces of now",     MOMENT,      IF(pl_want_reset),           EACH(pl_acting_reset),                                  ONCE,           \
      "accelerations", "accelerations", ONE)                                                                                                 \
    X("substep systems",   MOMENT,      ALWAYS,                      HOME,                                                   ONCE,           \
      "", "", ONE)                                                                                                                           \
    X("fluid forces",        MOMENT,      IF(pl_want_fluids),           ACTS(pl_fluid_row, pl_fluid_acts_on),                    ONCE,              \
      "solver bodies, poses, velocities, pieces, materials", "accelerations, islands", ONE)                                                                  \
    X("dipoles",           MOMENT,      IF(pl_want_dipoles),         EACH(pl_dipole_row),                                    ONCE,           \
      "solver bodies, poses, velocities, masses, body settings", "accelerations", ONE)                                                       \
    X("law forces",        MOMENT,      IF(pl_want_laws),            ACTS(pl_law_row, pl_law_acts_on),                       ONCE,           \
      "solver bodies, poses, velocities, masses, body settings", "accelerations", HAS(pl_law_variants))                                      \
    X("soft forces",       MOMENT,      IF(pl_want_softbodies),      ACTS(pl_softbodies_row, pl_softbodies_act_on),          ONCE,           \
      "soft bodies, solver bodies, poses, velocities, pieces", "accelerations", ONE)                                                         \
    X("damping",           MOMENT,      IF(pl_want_damping),         EACH(pl_damping_row),                                   REPLACEABLE,    \
      "solver bodies, body settings", "accelerations", ONE)                                                                                  \
    X("thrust",            MOMENT,      IF(pl_want_engines),         ACTS(pl_thrust_row, pl_engine_acts_on),                 ONCE,           \
      "solver bodies, poses, body settings", "accelerations", ONE)                                                                           \
    X("drag",              MOMENT,      IF(pl_want_drag),            ACTS(pl_drag_row, pl_drag_acts_on),                     ONCE,           \
      "solver bodies, body settings", "accelerations", ONE)                                                                                  \
    X("speed caps",        MOMENT,      IF(pl_want_caps),            EACH(pl_caps_row),                                      REPLACEABLE,    \
      "solver bodies, body settings", "accelerations", ONE)                                                                                  \
    X("integrate",         VELOCITIES,  IF(pl_want_solver),          THREE(pl_soft_integrate, pl_classic_integrate, pl_classic_integrate), ONCE,           \
      "accelerations, targets", "solver bodies, accelerations", ONE)                                                                               \
    X("warm start joints", VELOCITIES,  IF(pl_want_joints),          THREE(pl_joints_row_warm_start, pl_joints_row_warm_start, pl_exact_warm_start_joints), ONCE,           \
      "joints", "solver bodies, joints", ONE)                                                                                                \
    X("warm start",        VELOCITIES,  IF(pl_want_collision),       THREE(pl_soft_warm_start, pl_classic_warm_start, pl_exact_warm_start), ONCE,           \
      "constraints", "solver bodies, constraints", ONE)                                                                                      \
    X("impacts",           VELOCITIES,  IF(pl_want_impacts),         THREE(pl_soft_impacts, pl_classic_impacts, pl_classic_impacts), ONCE,           \
      "constraints", "solver bodies, constraints, pairs, manifolds", ONE)                                                                    \
    X("limits",            VELOCITIES,  IF(pl_want_strikes),         EACH(pl_joints_row_strike),                              ONCE,          \
      "joints, constraints", "solver bodies, joints", ONE)                                                                                   \
    X("half kick",         VELOCITIES,  IF(pl_want_soft),            SOFT(pl_soft_halve),                                    ONCE,           \
      "accelerations", "solver bodies", ONE)                                                                                                 \
    X("open moment",       VELOCITIES,  IF(pl_want_moment),          SOFT(pl_soft_open_moment),                              ONCE,           \
      "constraints, solver bodies", "solver bodies, constraints", ONE)                                                                       \
    X("joints",            CONSTRAINTS, IF(pl_want_joints),          BOTH(pl_joints_row_solve, pl_joints_row_classic),       ONCE,           \
      "joints, constraints", "solver bodies, joints, constraints", ONE)                                                                      \
    X("contacts",          CONSTRAINTS, IF(pl_want_collision),       BOTH(pl_soft_contacts, pl_classic_contacts),            ONCE,           \
      "constraints", "solver bodies, constraints", HAS(pl_contact_variants))                                                                 \
    X("exact pull",        CONSTRAINTS, IF(pl_want_direct),          EXACT(pl_exact_pull),                                   ONCE,           \
      "joints, constraints, manifolds", "solver bodies, joints, constraints", ONE)                                                           \
    X("positions",         POSITIONS,   IF(pl_want_solver),          THREE(pl_soft_move, pl_classic_move, pl_move_bodies), ONCE,           \
      "solver bodies, accelerations, targets", "solver bodies, joints", ONE)                                                                          \
    X("follow moment",     POSITIONS,   IF(pl_want_moment),          SOFT(pl_soft_follow_moment),                            ONCE,           \
      "solver bodies", "solver bodies, constraints", ONE)                                                                                             \
    X("relax joints",      RELAX,       IF(pl_want_joints),          BOTH(pl_joints_row_relax, pl_joints_row_correct),       ONCE,           \
      "joints, constraints", "solver bodies, joints, constraints", ONE)                                                                      \
    X("relax contacts",    RELAX,       IF(pl_want_collision),       BOTH(pl_soft_relax, pl_classic_correct),                ONCE,           \
      "constraints", "solver bodies, constraints", HAS(pl_contact_variants))                                                                 \
    X("exact relax",       RELAX,       IF(pl_want_direct),          EXACT(pl_exact_relax),                                  ONCE,           \
      "joints, constraints, manifolds", "solver bodies, joints, constraints", ONE)                                                           \
    X("sum reactions",     SUMS,        IF(pl_want_reactions),       NOT_CLASSIC(pl_joints_row_sum),                         ONCE,           \
      "joints, constraints", "joints, constraints", ONE)                                                                                     \
    X("sum impulses",      SUMS,        IF(pl_want_sums),            THREE(pl_soft_sum, pl_classic_sum, pl_classic_sum),     ONCE,           \
      "constraints", "constraints, manifolds", ONE)                                                                                          \
    X("measure contacts",  STORE,       IF(pl_want_residuals),       EACH(pl_measure_row),                                   ONCE,           \
      "solver bodies, constraints, joints", "", ONE)                                                                                         \
    X("store joints",      STORE,       IF(pl_want_joints),          NOT_CLASSIC(pl_joints_row_store),                       ONCE,           \
      "constraints", "joints", ONE)                                                                                                          \
    X("store contacts",    STORE,       IF(pl_want_collision),       THREE(pl_soft_store, pl_classic_store, pl_classic_store), ONCE,           \
      "constraints", "pairs, manifolds", ONE)                                                                                                \
    X("orbits",            FINISH,      IF(pl_want_laws),            ONCE(pl_run_orbits),                                    ONCE,           \
      "poses, velocities, forces, masses, body settings", "islands, body settings", HAS(pl_law_variants))                                                          \
    X("motion",            FINISH,      ALWAYS,                      ONCE(pl_run_motion),                                    ONCE,           \
      "solver bodies, forces, masses", "poses, velocities, forces, movers, time", HAS(pl_motion_variants))                                   \
    X("continuous",        FINISH,      IF(pl_want_continuous),      ONCE(pl_run_continuous),                                ONCE,           \
      "movers, pieces, grids", "poses, velocities, movers, manifolds, pairs, joints, events", ONE)                                           \
    X("targets",           FINISH,      IF(pl_want_targets),         ONCE(pl_run_arrive),                                    REPLACEABLE,    \
      "targets, poses", "poses, velocities, targets", ONE)                                                                                   \
    X("edges",             FINISH,      IF(pl_want_edges),           ONCE(pl_run_edges),                                     ONCE,           \
      "poses", "poses", ONE)                                                                                                                 \
    X("soft motion",       FINISH,      IF(pl_want_softbodies),      ONCE(pl_run_softbodies_motion),                         ONCE,           \
      "poses", "soft bodies, islands", ONE)                                                                                                  \
    X("liquid motion",     FINISH,      IF(pl_want_liquid),          ONCE(pl_run_liquid_motion),                             ONCE,           \
      "soft bodies, velocities, masses", "liquid", ONE)                                                                                      \
    X("air motion",        FINISH,      IF(pl_want_air),             ONCE(pl_run_air_motion),                                ONCE,           \
      "velocities, masses", "air", ONE)                                                                                                      \
    X("wave motion",         FINISH,      IF(pl_want_waves),            ONCE(pl_run_wave_motion),                                ONCE,              \
      "poses, pieces, materials", "waves", ONE)                                                                                                       \
    X("reactions",         FINISH,      IF(pl_want_joints),          ONCE(pl_run_reactions),                                 ONCE,           \
      "joints, poses", "joints, rows, events, islands, components, pairs", ONE)                                                              \
    X("events",            EVENTS,      IF(pl_want_collision),       ONCE(pl_run_events),                                    REFRESHES,      \
      "pairs, manifolds", "events, pairs, internal edges, manifolds", ONE)                                                                   \
    X("breaking",          EVENTS,      IF(pl_want_breaking),        ONCE(pl_run_breaking),                                  ONCE,           \
      "manifolds, body settings, masses", "velocities, events", ONE)                                                                         \
    X("sensors",           EVENTS,      IF(pl_want_sensing),         ONCE(pl_run_sensors),                                   REFRESHES,      \
      "sensors, poses, pieces", "sensors, events, islands", ONE)                                                                                   \
    X("burning",           END,         IF(pl_want_engines),         ONCE(pl_run_burning),                                   ONCE,           \
      "body settings", "masses, body settings, islands", ONE)                                                                                \
    X("heat flow",         END,         IF(pl_want_heat),            ONCE(pl_run_heat_flow),                                 ONCE,           \
      "heat, pairs, islands, pieces, masses", "heat", ONE)                                                                                   \
    X("end systems",       END,         ALWAYS,                      HOME,                                                   ONCE,           \
      "", "", ONE)                                                                                                                           \
    X("measure sums",      END,         IF(pl_want_measures),        ONCE(pl_run_measure_close),                             ONCE,           \
      "poses, velocities, masses, joints", "", ONE)                                                                                          \
    X("watchdog",          END,         IF(pl_want_watchdog),        ONCE(pl_run_watchdog),                                  ONCE,           \
      "poses, velocities, masses, pieces, grids, pairs, manifolds, joints", "", ONE)
// clang-format on

struct pl_substep;
struct pl_variants;

#define PL_PROTOTYPE_ALWAYS
#define PL_PROTOTYPE_HOME
#define PL_PROTOTYPE_ONE
#define PL_PROTOTYPE_IF(f)               bool f(const plumb_world *world, const char **reason);
#define PL_PROTOTYPE_ONCE(f)             plumb_result f(plumb_world *world, plumb_real dt);
#define PL_PROTOTYPE_EACH(f)             void f(struct pl_substep *substep);
#define PL_PROTOTYPE_NOT_CLASSIC(f)      PL_PROTOTYPE_EACH(f)
#define PL_PROTOTYPE_EXACT(f)            PL_PROTOTYPE_EACH(f)
#define PL_PROTOTYPE_SOFT(f)             PL_PROTOTYPE_EACH(f)
#define PL_PROTOTYPE_BOTH(soft, classic) PL_PROTOTYPE_EACH(soft) PL_PROTOTYPE_EACH(classic)
#define PL_PROTOTYPE_THREE(soft, classic, exact)                                                   \
    PL_PROTOTYPE_BOTH(soft, classic) PL_PROTOTYPE_EACH(exact)
#define PL_PROTOTYPE_ACTS(f, whom)                                                                 \
    PL_PROTOTYPE_EACH(f) bool whom(const plumb_world *world, uint32_t row);
#define PL_PROTOTYPE_HAS(f) void f(const plumb_world *world, struct pl_variants *v);
#define PL_PROTOTYPE_PASS(name, stage, wanted, run, kind, reads, writes, variants)                 \
    PL_PROTOTYPE_##wanted PL_PROTOTYPE_##run PL_PROTOTYPE_##variants

PL_PASSES(PL_PROTOTYPE_PASS)

#endif
