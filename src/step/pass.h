// pass.h - a pass of the step, and the schedule: which passes this world wants.
#ifndef PL_PASS_H
#define PL_PASS_H

#include "plumb/world.h"

#define PL_PASS_MAX 36

typedef struct pl_pass {
    const char *name, *phase, *reads, *writes;
    // Whether this world needs the pass; *reason (a static string) says why or why not. NULL:
    // always.
    bool (*wanted)(const plumb_world *world, const char **reason);
    // Does it. NULL: a part of the pass above, listed because it is left out on its own.
    plumb_result (*run)(plumb_world *world, plumb_real dt);
    bool refreshes; // part of a step of dt 0 too: it moves nothing
} pl_pass;

extern const pl_pass pl_passes[];
extern const int pl_pass_count;

// The phase of the passes that run the user's systems; compared by address.
extern const char pl_user_phase[];

// Revised when something structural changed (world->schedule_dirty).
typedef struct pl_schedule {
    bool scheduled[PL_PASS_MAX];
    const char *reason[PL_PASS_MAX];
    double last_ns[PL_PASS_MAX], total_ns[PL_PASS_MAX];
} pl_schedule;

#endif
