/// ecs.h - entities, user components, user systems, commands.
///
/// Bodies, shapes, materials, joints, laws and soft bodies are entities; so are things of the user's own. A component is a value
/// of fixed size that any entity may have; a system is a function called in each step or substep, at a named
/// phase, with whole columns. A system whose component nobody has is not in the schedule (plumb_world_schedule).
///
///     plumb_component health = plumb_component_create(world, &(plumb_component_desc){
///         .name = "health", .size = sizeof(float) });
///     plumb_component_set(world, body, health, &(float){ 100 });
#ifndef PLUMB_ECS_H
#define PLUMB_ECS_H

#include "plumb/body.h"
#include "plumb/material.h"
#include "plumb/shape.h"

PLUMB_BEGIN

typedef enum plumb_entity_kind {
    PLUMB_KIND_NONE, ///< stale or null
    PLUMB_KIND_BARE, ///< made by plumb_entity_create
    PLUMB_KIND_BODY,
    PLUMB_KIND_SHAPE,
    PLUMB_KIND_MATERIAL,
    PLUMB_KIND_JOINT,
    PLUMB_KIND_LAW,
    PLUMB_KIND_SOFTBODY
} plumb_entity_kind;

/// Makes a bare entity, to carry user components. Null on error: E_MEMORY, E_LOCKED.
PLUMB_API plumb_entity plumb_entity_create(plumb_world *world);
/// Destroys an entity of any kind with its components. Errors: E_HANDLE, E_LOCKED, E_STATE (material in use).
PLUMB_API plumb_result plumb_entity_destroy(plumb_world *world, plumb_entity entity);
PLUMB_API bool plumb_entity_alive(const plumb_world *world, plumb_entity entity);
PLUMB_API plumb_entity_kind plumb_entity_get_kind(const plumb_world *world, plumb_entity entity);
/// "body", "soft body", ...; "nothing" of PLUMB_KIND_NONE, null for what is no kind.
PLUMB_API const char *plumb_entity_kind_name(plumb_entity_kind kind);

/// A registered component: 1 + its index; 0 is null.
typedef struct plumb_component {
    uint32_t id;
} plumb_component;

typedef enum plumb_field_type {
    PLUMB_FIELD_F32,
    PLUMB_FIELD_F64,
    PLUMB_FIELD_I32,
    PLUMB_FIELD_I64,
    PLUMB_FIELD_U32,
    PLUMB_FIELD_U64,
    PLUMB_FIELD_BOOL
} plumb_field_type;

/// One member of a component's value, for tools that print or load it.
typedef struct plumb_field {
    const char *name;
    plumb_field_type type;
    size_t offset;    ///< [B] in the value
    const char *unit; ///< "m", "J", "1", ...
} plumb_field;

/// Called after a value was added, or before it is removed (also when its entity is destroyed).
/// The world is locked meanwhile: structural changes go through commands.
typedef void plumb_component_hook(plumb_world *world, plumb_entity entity, void *value, void *context);

typedef struct plumb_component_desc {
    const char *name;                ///< 1..63 characters, unique in the world; copied
    size_t size;                     ///< [B] of one value, 1..65536
    const plumb_field *fields;       ///< may be null; copied, names too
    int field_count;                 ///< 0..64
    plumb_component_hook *on_add;    ///< may be null
    plumb_component_hook *on_remove; ///< may be null
    void *context;                   ///< for the hooks
} plumb_component_desc;

/// Registers a component. Null on error: E_NULL, E_RANGE, E_DUPLICATE, E_CAPACITY (256), E_MEMORY, E_LOCKED.
PLUMB_API plumb_component plumb_component_create(plumb_world *world, const plumb_component_desc *desc);
/// Finds a component by name; null when there is none.
PLUMB_API plumb_component plumb_component_find(const plumb_world *world, const char *name);
/// Reads back a registration; fields point into the world. Errors: E_HANDLE, E_NULL.
PLUMB_API plumb_result plumb_component_info(const plumb_world *world, plumb_component component,
                                            plumb_component_desc *desc);

/// Gives an entity the component, or overwrites its value. `value` null: zeros.
/// Errors: E_HANDLE, E_MEMORY; E_LOCKED when it would add a row during a step.
PLUMB_API plumb_result plumb_component_set(plumb_world *world, plumb_entity entity,
                                           plumb_component component, const void *value);
/// The entity's value, or null; a dead entity is a refused call. Valid until the next step or structural
/// change. O(1).
PLUMB_API void *plumb_component_get(plumb_world *world, plumb_entity entity, plumb_component component);
/// Takes the component away. Errors: E_HANDLE, E_MISSING, E_LOCKED.
PLUMB_API plumb_result plumb_component_remove(plumb_world *world, plumb_entity entity,
                                              plumb_component component);

/// All values of a component, one after another. A new value comes last, and the last one fills the gap of
/// one that is removed; at its start, behind the commands, each step puts the values of bodies in the order
/// of their body rows, first, and leaves the others behind them as they lie. Valid until the next step or
/// structural change.
typedef struct plumb_component_span {
    int count;
    size_t stride;              ///< [B] from value to value
    const plumb_entity *entity; ///< owner of each value
    void *values;
} plumb_component_span;

/// The span of now; all zero for a component that is not there. O(1).
PLUMB_API plumb_component_span plumb_world_column(plumb_world *world, plumb_component component);

#define PLUMB_VIEW_MOST 8 ///< components of a view

/// The bodies that a view looks at, by their rows (see plumb_body_span).
typedef enum plumb_view_rows {
    PLUMB_VIEW_AWAKE,   ///< awake dynamic ones
    PLUMB_VIEW_MOVING,  ///< those, and kinematic ones
    PLUMB_VIEW_DYNAMIC, ///< awake dynamic ones, then sleeping ones: for forces that may change, see plumb/sleep.h
    PLUMB_VIEW_ALL
} plumb_view_rows;

typedef struct plumb_body_view_desc {
    plumb_component with[PLUMB_VIEW_MOST]; ///< at least one; a null one ends the list
    plumb_view_rows rows;
} plumb_body_view_desc;

/// A walk over the bodies that have all of some components: component values beside body columns, range
/// by range of consecutive body rows, by rising row. The price is that of an array of your own with a value
/// a body row, and some 70 instructions a range.
///
///     plumb_body_span b = plumb_world_bodies(world);
///     plumb_body_view view;
///     plumb_body_view_open(world, &(plumb_body_view_desc){ .with = { drag } }, &view);
///     while (plumb_body_view_next(&view)) {
///         const float *k = view.values[0];
///         const plumb_real *vx = b.vx + view.row;
///         plumb_real *fx = b.fx + view.row;
///         for (int i = 0; i < view.count; ++i) {
///             fx[i] -= k[i] * vx[i];
///         }
///     }
///
/// A range goes on while one body row follows another and their values lie one behind the other: each step
/// puts values in the order of rows, so where all bodies have the component there is one range.
/// Falling asleep, waking, and values that come or go split ranges until the next step begins.
typedef struct plumb_body_view {
    int count;                     ///< bodies of this range
    int row;                       ///< body row of its first; the k-th one has row + k
    void *values[PLUMB_VIEW_MOST]; ///< of each component in `with`: `count` values, one after another
    // The rest is the view's own.
    struct {
        const void *run, *end;
        char *values;
        size_t stride;
    } of[PLUMB_VIEW_MOST];
    int components;
    uint32_t first, last;           // rows still to be walked, the last one excluded
    uint32_t more_first, more_last; // and those after them
} plumb_body_view;

/// Begins a walk; plumb_body_view_next leads to the first range. Valid until the next structural change, and
/// within a step until the system that opened it returns. Errors, with a view that has no range: E_NULL,
/// E_HANDLE (not a registered component; none at all), E_RANGE (rows), E_MEMORY (the first view of a component
/// that has grown). O(1), and 33 instructions a value the first time after bodies or values have changed
/// places.
PLUMB_API plumb_result plumb_body_view_open(plumb_world *world, const plumb_body_view_desc *desc, plumb_body_view *view);
/// Goes to the next range; false when there is none. Safe on several threads, each with its own copy of a view.
PLUMB_API bool plumb_body_view_next(plumb_body_view *view);
/// The rows [first_row, end_row) of what a view has still to walk, as a view of its own: so several threads
/// share one. Safe on several threads.
PLUMB_API plumb_body_view plumb_body_view_part(const plumb_body_view *view, int first_row, int end_row);

/// When a user system runs. Built-in passes lie between the phases.
typedef enum plumb_phase {
    PLUMB_PHASE_BEGIN,    ///< at the start of the step, after commands were applied
    PLUMB_PHASE_FORCES,   ///< before forces are integrated: add to the force columns here
    PLUMB_PHASE_CONTACTS, ///< after the narrow phase, before the solver
    PLUMB_PHASE_END,      ///< after everything: events and transforms are those of this step
    PLUMB_PHASE_SUBSTEP   ///< in each substep, before velocities are integrated: accelerations of the moment
} plumb_phase;

#if PLUMB_REAL_IS_DOUBLE && !PLUMB_IS_FAR
typedef double plumb_near; ///< the scalar of the solver: plumb_real, but float where places are far (PLUMB_FAR)
#else
typedef float plumb_near; ///< the scalar of the solver: plumb_real, but float where places are far (PLUMB_FAR)
#endif

/// A body as the solver has it within a step.
typedef struct plumb_substep_body {
    plumb_near vx, vy, w;   ///< [m/s], [rad/s] of the moment
    plumb_near inv_mass;    ///< [1/kg]
    plumb_near dx, dy, da;  ///< [m], [rad] moved since the start of the step, where the columns are
    plumb_near inv_inertia; ///< [1/(kg m^2)]
} plumb_substep_body;

/// What moves it in this substep.
typedef struct plumb_substep_motion {
    plumb_near ax, ay, aw; ///< [m/s^2], [rad/s^2] of gravity, forces and systems before: to be added to
    plumb_near none;       ///< 0
    plumb_near ux, uy, uw; ///< [m/s], [rad/s] the solver's own
    plumb_near inv_mass;   ///< [1/kg]
} plumb_substep_motion;

#define PLUMB_NEEDS_MOST 4 ///< components that a system needs

/// The bodies that a call of a system of phase SUBSTEP is for: awake dynamic ones that have all components it needs (of
/// none: all). They are moved by the solver, substep by substep, even where nothing touches them.
/// It moves them by v h + a h^2 / 2 and adds a h: an acceleration asked for the middle, at dx + vx h / 2, makes that the
/// leapfrog, of second order; asked for the beginning, at dx, orbits gain energy by first order.
///
///     for (int i = 0; i < s->count; ++i) {
///         const drag *d = (const drag *)s->values[0] + s->at[0][i];
///         const plumb_substep_body *b = &s->bodies[s->slot[i]];
///         s->motions[s->slot[i]].ax -= d->k * b->vx * b->inv_mass;
///     }
typedef struct plumb_substep {
    int count;
    int number;           ///< of the substep, from 0
    const uint32_t *slot; ///< of each in `bodies` and `motions`
    const uint32_t *row;  ///< of each in plumb_world_bodies: there are poses of the start of the step
    plumb_substep_body *bodies;
    plumb_substep_motion *motions;
    void *values[PLUMB_NEEDS_MOST];       ///< columns of the components
    const uint32_t *at[PLUMB_NEEDS_MOST]; ///< place of each in these
} plumb_substep;

/// What a system is called with.
typedef struct plumb_system_call {
    plumb_world *world;
    plumb_real dt; ///< [s] of the step; of the substep
    double time;   ///< [s] simulated before the step or substep (phase END: after it)
    void *context;
    int first, end;               ///< body rows [first, end) are this call's: all, unless the system is parallel
    const plumb_substep *substep; ///< phase SUBSTEP; else null
} plumb_system_call;

typedef struct plumb_system_desc {
    const char *name; ///< 1..63 characters, unique in the world, also among its passes; copied
    plumb_phase phase;
    void (*run)(const plumb_system_call *call);
    plumb_component needs[PLUMB_NEEDS_MOST]; ///< runs only while each has a value; a null one ends the list
    const char *reads;                       ///< data read: names of plumb_data_name or components, with commas between
                                             ///< them ("velocities, drag"); may be null; copied
    const char *writes;                      ///< data written, likewise; held by PLUMB_WATCH_WRITES, unless null
    void *context;
    /// Whether `run` may be called on several threads at once, each time for bodies or rows of its own: it writes
    /// nothing else, allocates nothing, and calls no function that takes a plumb_world but plumb_world_bodies and
    /// plumb_world_column. What it does must not depend on how rows are divided. Phase SUBSTEP: once a cluster of
    /// islands; a system that is not parallel has all its bodies in one cluster, and is slower.
    bool parallel;
    const char *before;  ///< name of a pass or system right before which it stands; may be null; copied
    const char *after;   ///< name of one behind which it stands (and behind systems that named it before); likewise
    const char *instead; ///< name of a pass that does not run while this system is switched on: "damping",
                         ///< "speed caps", "gravity", "targets". Stands at its place, or at that of the phase
} plumb_system_desc;

/// Registers a system after those already in its phase, or where `before`, `after`, `instead` say. Of phase BEGIN and
/// FORCES it may stand before the pass "gravity", of CONTACTS among others of that phase, of END behind "motion", of
/// SUBSTEP among the rows of the substep from "forces of now" to "sum impulses"; beside a row of the stage
/// "constraints" or "relax" it runs in each sweep. While the world is recorded, systems can stand only at the place of
/// their phase: others are refused, and so is the recorder of a world that has them. Errors: E_NULL, E_RANGE (phase,
/// texts too long), E_HANDLE (needs), E_MISSING (`reads`, `writes`, `before`, `after`, `instead` name nothing that is
/// there), E_STATE (a system of this phase cannot stand there; `after` does not stand before `before`; the pass
/// cannot be replaced; the world is recorded), E_DUPLICATE (name; two in place of one pass), E_CAPACITY (256),
/// E_MEMORY, E_LOCKED.
PLUMB_API plumb_result plumb_system_create(plumb_world *world, const plumb_system_desc *desc);
/// Switches a system off or on. Errors: E_NULL, E_MISSING.
PLUMB_API plumb_result plumb_system_enable(plumb_world *world, const char *name, bool enabled);

/// Commands: structural changes asked for during a step (those that cut and merge bodies: plumb/fracture.h), carried out in
/// order at the start of the next one (or by plumb_commands_apply). Handles returned are valid at once and come alive when
/// applied; a command on something that has died meanwhile is dropped and counted as a warning in the log. Descriptors are
/// checked when the command is given; the same errors as the direct calls, no E_LOCKED.
PLUMB_API plumb_body plumb_command_body_create(plumb_world *world, const plumb_body_desc *desc);
PLUMB_API plumb_shape plumb_command_shape_create(plumb_world *world, plumb_body body,
                                                 const plumb_shape_desc *desc);
PLUMB_API plumb_entity plumb_command_entity_create(plumb_world *world);
PLUMB_API plumb_result plumb_command_destroy(plumb_world *world, plumb_entity entity);
PLUMB_API plumb_result plumb_command_teleport(plumb_world *world, plumb_body body, plumb_vec2 position,
                                              plumb_real angle);
PLUMB_API plumb_result plumb_command_component_set(plumb_world *world, plumb_entity entity,
                                                   plumb_component component, const void *value);
PLUMB_API plumb_result plumb_command_component_remove(plumb_world *world, plumb_entity entity,
                                                      plumb_component component);
/// Carries out pending commands now. Errors: E_LOCKED (during a step), E_MEMORY (the rest stays pending).
PLUMB_API plumb_result plumb_commands_apply(plumb_world *world);

PLUMB_END

#endif
