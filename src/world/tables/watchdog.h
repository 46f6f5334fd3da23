// watchdog.h - what the watchdog knows of bodies and joints, and what it tells: see src/watchdog.
#ifndef PL_TABLE_WATCHDOG_H
#define PL_TABLE_WATCHDOG_H

#include "core/memory.h"
#include "plumb/watchdog.h"

// A body or joint, by the slot of its entity.
typedef struct pl_watched {
    uint32_t generation; // of whom it is about; 0: nobody yet
    uint32_t deepening;  // steps in a row in which it sank, or its joint came apart
    const char *command; // the last call; "": none
    uint32_t system;     // 1 + the serial of the system that changed it since; 0: none
    uint32_t deep_with;  // row of the body that it is deepest in
    uint64_t command_step;
    uint64_t seen; // 1 + the step that it began with what follows
    double vx, vy, w, x, y, c, s; // as last looked at: velocity, centre, rotation
    double from_vx, from_vy, from_w, from_x, from_y, from_c, from_s; // as the step began
    double depth, depth_now; // [-] deepest contact, of the thinner half width; before, in this step. Of a joint [m] or [rad]
    double worked;           // [J/kg] that forces gave it
    const char *hastened;    // pass that gave it most energy of motion in this step; "": none
    double hastened_by;      // [J]
    bool stopped;            // in this step, by the continuous pass
    const char *moved;       // pass that moved it last in this step
    uint64_t told[PLUMB_ALARM_KINDS]; // 1 + the step in which an alarm was last due; 0: never
} pl_watched;

// A dynamic row as motion begins.
typedef struct pl_watched_flight {
    double kinetic, x, y, w, force_x, force_y, torque;
} pl_watched_flight;

// What hangs together, at the first of its rows.
typedef struct pl_watched_island {
    double gained, known;  // [J]; of it what forces gave
    double kinetic, mass;  // [J], [kg] as motion begins
    double fastest, deepest; // [m/s], [m] likewise
    double driven;         // [m/s] fastest surface, motor or kinematic body that it has to do with; HUGE_VAL: no bound
    double most;           // [J] gained by one row,
    uint32_t worst;        // this one
} pl_watched_island;

#define PL_ALARM_TEXT 96 // longest command

typedef struct pl_watchdog {
    pl_buffer entities; // pl_watched a registry slot
    pl_buffer flights;  // pl_watched_flight a dynamic row
    pl_buffer leaders;  // uint32_t a dynamic row
    pl_buffer islands;  // pl_watched_island a dynamic row
    pl_buffer stored;   // double a joint slot: [J] as motion begins
    pl_buffer deep;     // uint32_t a piece: its deep contacts
    pl_buffer alarms;   // plumb_alarm, then texts of PL_ALARM_TEXT; PLUMB_ALARM_MAX of each
    int count;          // alarms of the last step, the first ones
    uint32_t total;     // in all, since it watches
    bool filed;         // pieces were, in this step: grids are of now
    bool begun;         // it has seen the world
    plumb_vec2 gravity; // when it last looked
    double given;       // [m/s] fastest that calls, systems, kinematic bodies, surfaces and motors gave
    double stored_most; // [J] most that springs had
    double highest, lowest; // [J/kg] places against gravity so far
    double worked_most; // [J/kg]
    double heaviest;    // [kg]
} pl_watchdog;

static inline pl_watched *pl_watched_entities(const pl_watchdog *dog)
{
    return (pl_watched *)dog->entities.data;
}

#endif
