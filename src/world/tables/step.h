// step.h - the schedule and its timers; systems of the user; who was taken out.
#ifndef PL_TABLE_STEP_H
#define PL_TABLE_STEP_H

#include "ecs/component.h"
#include "core/memory.h"
#include "plumb/ecs.h"
#include "plumb/event.h"
#include "plumb/world.h"

#define PL_PASS_MAX 96

#define PL_NO_SYSTEM UINT32_MAX

// Beside plumb_watch: the world measures its error (step/measure.c), it has a watchdog (src/watchdog).
#define PL_WATCH_MEASURES 0x10000u
#define PL_WATCH_DOG      0x20000u

static inline unsigned pl_watched_bits(unsigned what, const plumb_world_desc *desc)
{
    return (what & ~(PL_WATCH_MEASURES | PL_WATCH_DOG)) | (desc->measure ? PL_WATCH_MEASURES : 0) |
           (desc->watchdog ? PL_WATCH_DOG : 0);
}

// A line of the schedule.
typedef struct pl_line {
    uint32_t pass;   // place of it in pl_passes; of a system that of a row of its stage
    uint32_t system; // PL_NO_SYSTEM: it is the pass itself
} pl_line;

typedef struct pl_time {
    double last_ns, total_ns;
} pl_time;

typedef struct pl_schedule {
    bool scheduled
        [PL_PASS_MAX]; // passes; revised when something structural changed (schedule_dirty)
    pl_buffer places;  // pl_line, in order
    uint32_t count;    // 0: passes as they are in the table, no systems
    pl_buffer rows;    // pl_substep_row: what runs in the substeps
    pl_buffer next;    // uint16_t a line, and one behind: the first from it on that runs outside of the substeps
    uint32_t ends[8];  // behind the last row of each of their stages
    unsigned watched;  // plumb_watch, PL_WATCH_...
    pl_buffer times;   // pl_time a pass, if times were ever watched
    pl_buffer shares;  // double a thread and row of the substeps: [ns]
    double inner_ns;   // of the rows of the last substeps
    pl_buffer digests; // uint64_t a kind of data, before the row that runs
    uint32_t breaches; // how often a row wrote what it does not declare
} pl_schedule;

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

typedef struct pl_quarantine {
    plumb_quarantine events[PLUMB_QUARANTINE_MAX]; // of the last step, the first ones
    int event_count;
    bool again;       // the step is to be taken anew, without who was found
    bool lost;        // some body is marked PL_BODY_LOST: it is taken out when the step is over
    uint32_t attempt; // how often the step has been taken anew
    // What the solver changes that outlives the step, as it was before.
    pl_buffer joints;  // pl_kept_joint of each joint that is awake
    pl_buffer rolling; // near_real a manifold, where surfaces roll hard
    bool kept;
    plumb_real since; // [s] world->sleep.since
} pl_quarantine;

#endif
