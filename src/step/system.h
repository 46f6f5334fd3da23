// system.h - the user's systems, kept in order of phase, then registration. Where they stand among the rows of the
// step is the schedule's (schedule.c).
#ifndef PL_SYSTEM_H
#define PL_SYSTEM_H

#include "ecs/component.h"
#include "step/pass.h"

#define PL_SYSTEM_MAX 256

// Whom a system of the substep acts on in this step (acting.c).
typedef struct pl_acting {
    uint32_t count;
    pl_buffer slots;                // uint32_t: solver slots, rising
    pl_buffer rows;                 // uint32_t: body rows, beside
    pl_buffer at[PLUMB_NEEDS_MOST]; // uint32_t: places in the columns of the components, beside
} pl_acting;

typedef struct pl_system {
    char name[PL_NAME_MAX];
    char reads[128];
    char writes[128];
    char before[PL_NAME_MAX], after[PL_NAME_MAX], instead[PL_NAME_MAX]; // "": not given
    plumb_system_desc desc; // strings point to the copies above
    uint32_t need_count;
    uint32_t serial;  // order of registration
    uint32_t written; // mask of `writes`
    bool checked;     // `writes` was given
    bool enabled;
    bool ran; // in this step
    pl_time time;
    pl_acting acting;
} pl_system;

typedef struct pl_systems {
    pl_system *items;
    size_t bytes;
    uint32_t count, made;
    uint32_t in_substeps; // systems of phase SUBSTEP
} pl_systems;

void pl_systems_free(pl_memory *memory, pl_systems *systems);

// NULL: none has the name.
pl_system *pl_system_find(const plumb_world *world, const char *name);
// True when the system would run in this step; *reason says why or why not.
bool pl_system_wanted(const plumb_world *world, const pl_system *system, const char **reason);
// Runs one, with the world locked by its name.
void pl_system_run(plumb_world *world, pl_system *system, plumb_real dt);

#endif
