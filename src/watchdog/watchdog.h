// watchdog.h - what the step does for the watchdog, and what its detectors share.
#ifndef PL_WATCHDOG_H
#define PL_WATCHDOG_H

#include "world/state.h"
#include "world/told.h"
#include "schema/passes.h"

#include <math.h>

// What a row of the step does to bodies.
typedef enum pl_doing {
    PL_DOES_NOTHING,
    PL_DOES_FILE, // pieces into grids
    PL_DOES_WAKE,
    PL_DOES_SYSTEM, // what the user wants
    PL_DOES_MOVE,
    PL_DOES_MOTION, // with what the solver found
    PL_DOES_STOP,   // puts them back to where they would have passed into something
    PL_DOES_SHIFT   // brings them back into the period of a world that wraps
} pl_doing;

void pl_watchdog_free(pl_memory *memory, pl_watchdog *dog);
// It knows nothing of the world any more, and begins anew.
void pl_watchdog_forget(pl_watchdog *dog);

// Around rows. `pass`: the name of the row; `system`: place of the user's, or PL_NO_SYSTEM.
void pl_watchdog_before(plumb_world *world, pl_doing doing);
void pl_watchdog_after(plumb_world *world, pl_doing doing, const char *pass, uint32_t system,
                       plumb_real dt);

//---- detectors: each looks at the step behind its last row -------------------------------------------

void pl_watch_speeds(plumb_world *world, plumb_real dt);
void pl_watch_passages(plumb_world *world, plumb_real dt);
void pl_watch_contacts(plumb_world *world, plumb_real dt);
void pl_watch_joints(plumb_world *world, plumb_real dt);
// Energy: before and behind motion, when velocities are those of both ends.
void pl_watch_energy_before(plumb_world *world);
void pl_watch_energy_after(plumb_world *world, plumb_real dt);
// Energy that forces gave the row of a flight [J].
double pl_watch_work(const plumb_world *world, uint32_t row, plumb_real dt);

//---- what they share ---------------------------------------------------------------------------------

// What is found of a body, or of a joint.
typedef struct pl_finding {
    plumb_alarm_kind kind;
    uint32_t row;          // of the body; PL_NONE: none
    uint32_t other;        // likewise, whom it touches or passed
    const pl_joint *joint; // or NULL
    double value;
    const char *pass, *work;
} pl_finding;

// Tells it, if it exceeds its bound and was silent until now.
void pl_watchdog_tell(plumb_world *world, const pl_finding *finding);

static inline double pl_more(double a, double b)
{
    return a > b ? a : b;
}

static inline double pl_less(double a, double b)
{
    return a < b ? a : b;
}

static inline double pl_length(double x, double y)
{
    return sqrt(x * x + y * y);
}

// Of a body row that has been looked at.
static inline pl_watched *pl_watched_row(const plumb_world *world, uint32_t row)
{
    return &pl_watched_entities(&world->watchdog)[world->bodies.entity[row].entity.index];
}

// The row of the schedule that solves.
const char *pl_watchdog_solver(const plumb_world *world);
// The bound of a kind.
double pl_watchdog_bound(plumb_alarm_kind kind);

#endif
