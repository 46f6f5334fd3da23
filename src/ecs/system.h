// system.h - user systems, kept in order of phase, then registration.
#ifndef PL_SYSTEM_H
#define PL_SYSTEM_H

#include "ecs/component.h"

#define PL_SYSTEM_MAX 256

typedef struct pl_system {
    char name[PL_NAME_MAX];
    char reads[128];
    char writes[128];
    plumb_system_desc desc; // strings point to the copies above
    bool enabled;
    double last_ns, total_ns;
} pl_system;

typedef struct pl_systems {
    pl_system *items;
    size_t bytes;
    uint32_t count;
} pl_systems;

void pl_systems_free(pl_memory *memory, pl_systems *systems);

// True when the system would run in this step; *reason says why or why not.
bool pl_system_wanted(const plumb_world *world, const pl_system *system, const char **reason);
// Runs the systems of one phase, in order. Called by the step with the world locked.
void pl_systems_run(plumb_world *world, plumb_phase phase, plumb_real dt, double time);

#endif
