// state.h - the whole state of a world, for the library's own files.
//
// Reading order: columns.h (what is stored), this file (how it hangs together), schema/passes.h (what
// happens to it in a step).
#ifndef PL_STATE_H
#define PL_STATE_H

#include "core/tasks.h"
#include "world/command.h"
#include "ecs/registry.h"
#include "plumb/event.h"
#include "plumb/query.h"
#include "world/columns.h"
#include "world/tables/air.h"
#include "world/tables/broad.h"
#include "world/tables/character.h"
#include "world/tables/continuous.h"
#include "world/tables/dial.h"
#include "world/tables/event.h"
#include "world/tables/exact.h"
#include "world/tables/fracture.h"
#include "world/tables/heat.h"
#include "world/tables/internal_edges.h"
#include "world/tables/joint.h"
#include "world/tables/law.h"
#include "world/tables/liquid.h"
#include "world/tables/softbody.h"
#include "world/tables/manifold.h"
#include "world/tables/measure.h"
#include "world/tables/effects.h"
#include "world/tables/sleep.h"
#include "world/tables/solver.h"
#include "world/tables/step.h"
#include "world/tables/watchdog.h"
#include "world/tables/waves.h"
#include "world/component.h"

// A size class of the vertex pool holds runs of 4, 8 or 16 corners.
#define PL_VERTEX_CLASSES 3

typedef struct pl_vertex_pool {
    pl_vertex *items;
    size_t bytes;
    uint32_t count; // corners handed out, free runs included
    uint32_t capacity;
    uint32_t free_head
        [PL_VERTEX_CLASSES]; // first corner of a free run; its x holds no value, see pool.c
} pl_vertex_pool;

// Body rows as the narrow phase gathers them: eight reals a row, in the far build ten.
typedef struct pl_pose {
    real x, y;   // [m] origin
    real c, s;   // rotation
    real dx, dy; // [m] centre of mass minus origin, in world axes
    real vx, vy; // [m/s] velocity of the centre
#if PLUMB_IS_FAR
    real residual_x, residual_y; // [m] what rounding took from the origin
#endif
} pl_pose;

struct plumb_world {
    plumb_world_desc desc; // defaults resolved
    pl_memory memory;
    pl_tasks *tasks; // null: one thread
    plumb_vec2 gravity;
    uint64_t step_count;
    double time;
    real last_dt;           // [s] of the last step that moved anything
    near_real soft_substep; // [s] see pl_soft_substep; of that step
    // bodies taken out because a step would have left them without a finite state
    uint32_t arrested_count;

    // Entities and rows.
    pl_registry registry;
    pl_bodies bodies;
    uint32_t dynamic_count, kinematic_count, asleep_count, disabled_count; // the rest is static
    pl_pieces pieces;
    uint32_t shape_count;
    uint32_t serial;   // counts the pieces ever made
    pl_buffer made;    // pl_made_piece: pieces of a shape between check and commit
    pl_buffer outline; // plumb_convex_piece: scratch of the decomposition
    pl_vertex_pool vertices;
    pl_materials materials;
    pl_components components;
    pl_systems systems;
    pl_commands commands;

    // Lists and flags that structural changes keep up.
    pl_buffer moving; // uint32_t: pieces of awake dynamic and of kinematic bodies, unordered
    uint32_t moving_count;
    pl_buffer poses;   // pl_pose a body row
    bool rows_moved;   // body rows changed place: pairs must look their rows up again
    bool pairs_dirty;  // pieces came, went or were teleported: grids and pair list must be rebuilt
    bool static_dirty; // static pieces came, went or moved: the static grid must be rebuilt
    bool schedule_dirty; // something structural changed: `wanted` is asked again
    bool rearranged;     // since the last step pieces came, went or were moved, or others may meet

    // Counters behind `wanted`: how many pieces or bodies ask for an effect.
    uint32_t piece_kinds[PL_PIECE_KIND_COUNT]; // live pieces of each kind
    uint32_t turning_bodies; // dynamic bodies with inverse inertia > 0, asleep or not

    uint32_t continuous_bodies; // dynamic bodies with PL_BODY_CONTINUOUS

    uint32_t sensor_pieces, filtered_pieces, part_pieces; // live pieces with the flag
    uint32_t one_way_pieces;
    bool one_way_noted;       // in this step: pairs know what they were
    uint32_t dropping_bodies; // requests to drop through since the last step
    uint32_t locked_bodies;   // bodies locked in x or y
    pl_body_settings_list settings;
    pl_targets targets;
    pl_tracks tracks;
    pl_effects effects;

    // Tables that few worlds have, sorted by key.
    pl_buffer excluded; // uint64_t: slots of two bodies (filter.c)
    uint32_t excluded_count;
    pl_buffer material_pairs; // pl_material_pair (material_pair.c)
    uint32_t material_pair_count;

    // Broad phase, narrow phase, solver: each owns its struct.
    pl_broad broad;
    pl_query_grid_set query_grids;
    pl_narrow narrow;
    pl_lookahead lookahead; // contacts ahead, of the narrow phase that ran last
    pl_solver solver;
    pl_exact_solver exact;
    pl_continuous continuous;
    pl_internal_edges internal_edges;
    pl_joints joints;
    pl_characters characters;
    pl_liquid liquid;
    pl_air air;
    pl_softbodies softbodies;
    pl_laws laws;
    pl_waves waves;
    pl_fracture fracture;
    pl_heats heats;
    pl_schedule schedule;
    pl_quarantine quarantine;
    pl_measure measure;
    pl_watchdog watchdog;
    pl_dial dial;

    // Events of the last step.
    pl_buffer begin_events, end_events; // plumb_contact_begin, plumb_contact_end
    pl_buffer changed_pairs;            // uint32_t: pairs that began or ceased to touch
    pl_buffer hit_events;               // plumb_contact_hit
    int begin_count, end_count, hit_count;
    pl_buffer tombstones; // pl_tombstone by piece slot
    pl_parts parts;
    pl_pending_hits pending_hits;
    pl_sensing sensing;
    pl_contact_index contact_index;
    pl_sleep sleep;

    pl_buffer checking, checked; // scratch of images that are checked (snapshot/check.c, restore.c)
    struct pl_step_observer
        *observer; // who records or replays this world (world/observer.h); NULL: nobody

    // Locking and errors.
    const char *locked_by; // name of the system or hook that runs; NULL: structural changes allowed
    bool editing;          // systems of PLUMB_PHASE_CONTACTS run
    bool edited;           // one of them changed a contact
    bool in_hook;          // locked_by is the component whose hook runs, not a system
    plumb_error error;
    char error_text[512];
};

//---- errors (world/error.c) -----------------------------------------------------------------------

// Records a refused call, sends it to the log, returns `code`.
plumb_result pl_fail(const plumb_world *world, plumb_result code, const char *function,
                     const char *format, ...) PL_PRINTF(4, 5);

// Sends a warning to the log hook.
void pl_warn(const plumb_world *world, const char *format, ...) PL_PRINTF(2, 3);

// E_LOCKED with the name of the system and the remedy when the world is stepping; E_NULL without a world.
plumb_result pl_check_unlocked(const plumb_world *world, const char *function);

//---- rows (world/rows.c) --------------------------------------------------------------------------

// The body row, piece slot (first of the shape) or material row of a live handle, PL_NONE otherwise.
uint32_t pl_body_row(const plumb_world *world, plumb_body body);
uint32_t pl_shape_piece(const plumb_world *world, plumb_shape shape);
uint32_t pl_material_row(const plumb_world *world, plumb_material material);

// Derives origin and pose of a row from its centre, rotation and local centre.
void pl_body_update_origin(plumb_world *world, uint32_t row);
// Derives centre and pose from origin and rotation (after a teleport or a change of mass).
void pl_body_update_center(plumb_world *world, uint32_t row);

// Derives the pose of a row alone (after a restore, which brings origin and centre).
void pl_body_update_pose(plumb_world *world, uint32_t row);

// Fills `out` with the piece as the user gave it.
void pl_piece_convex(const plumb_world *world, uint32_t piece, plumb_convex *out);
// Tight box of a piece at its body's pose.
pl_box pl_piece_tight_box(const plumb_world *world, uint32_t piece);
// The same where the grids have it, in a world that wraps around.
pl_box pl_piece_filed_box(const plumb_world *world, uint32_t piece);

static inline pl_pose *pl_poses(const plumb_world *world)
{
    return (pl_pose *)world->poses.data;
}

// The pair that a manifold is of.
static inline pl_pair *pl_pair_of(const plumb_world *world, const pl_manifold *m)
{
    return &pl_pairs(&world->broad.pairs)[m->pair];
}

static inline uint32_t *pl_moving(const plumb_world *world)
{
    return (uint32_t *)world->moving.data;
}

// Unit, away from the ground.
static inline plumb_vec2 pl_world_up(const plumb_world *world)
{
    return (plumb_vec2){ 0, world->desc.y_axis == PLUMB_Y_DOWN ? -1 : 1 };
}

// Pieces came, went or were moved, or others may meet: pairs are sought anew.
static inline void pl_rearranged(plumb_world *world)
{
    world->pairs_dirty = world->rearranged = true;
}

#endif
