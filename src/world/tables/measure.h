// measure.h - what a step keeps of itself to know its error: see step/measure.c.
#ifndef PL_TABLE_MEASURE_H
#define PL_TABLE_MEASURE_H

#include "core/memory.h"
#include "core/near.h"
#include "plumb/measure.h"

// What pushes bodies all step long, by their columns of forces: pl_measure_steady has the work of each.
enum { PL_STEADY_LIQUID, PL_STEADY_CHARACTERS, PL_STEADY_WORKS };

// A dynamic body in the solver.
typedef struct pl_measured_body {
    double mass, inertia;  // as the solver has it: own time counts
    double met;            // [kg] that impulses meet: with what fluids lend it, or fuel that burns
    bool borrows;          // that is another than its mass
    double pull_x, pull_y; // [N] of the gravity that acts
    double weight_x, weight_y;     // [N] of the gravity that potential energy is told by
    near_real ease;                // [1/(kg m^2)] its own inverse inertia: joints may give it less
    double vx, vy, w, dx, dy;      // before the row that runs
    double ax, ay, aw;             // likewise, accelerations
    double booked;                 // [J] likewise, the sum of all kinetic work
    double mean_x, mean_y, mean_w; // velocity, mean of before and behind the row
    double push[PLUMB_WORKS][3];   // [N], [N m] of effects: in this substep
    double steady[PL_STEADY_WORKS][3]; // likewise, all step long
    double px, py, pw;             // [N s], [N m s] impulses of contacts and joints
    plumb_balance work[PLUMB_WORKS]; // in this step
    double kick[PLUMB_WORKS][3];     // [N s], [N m s] of what this substep kicked with (halves.c)
} pl_measured_body;

// A dynamic body as motion begins.
typedef struct pl_measured_flight {
    double vx, vy, w, x, y, fx, fy, torque;
} pl_measured_flight;

// [N], [N m] a registry slot: by what, and its forces as a row that pushes began.
typedef struct pl_measured_push {
    double of[PL_STEADY_WORKS][3];
    double before[3];
} pl_measured_push;

// Of what joints owe because J has turned (joints/one.c).
typedef enum pl_measured_debt {
    PL_DEBT_NONE,
    PL_DEBT_OPEN,       // less what is owed still
    PL_DEBT_PAID,       // what the sweep before the drift paid
    PL_DEBT_PAID_BEHIND // and the one behind it
} pl_measured_debt;

// What the kernels are given, and what they find.
typedef struct pl_measuring {
    pl_measured_body *bodies;
    uint32_t count;          // slots from here on are immovable or kinematic
    bool balances;           // impulses are added up instead of work
    bool kicks;              // and besides, as a part of the substep's kick
    pl_measured_debt debt;   // what of it is added to the impulses
    const void *kept;        // bundles or records before the row; null: all of an impulse counts
    const void *kept_extras; // likewise
    const void
        *kept_impulses; // real, PL_JOINT_ROWS a joint of `grouped`, of those solved one by one
    double gap, approach, complementarity, cone, momentum;
} pl_measuring;

typedef struct pl_measure {
    pl_buffer last;    // one plumb_measures
    double mechanical; // [J] kinetic and potential, as last looked at
    double stored;     // [J] as the step began
    pl_buffer bodies;  // pl_measured_body a dynamic slot
    pl_buffer flights; // pl_measured_flight a dynamic row
    pl_buffer pushes;  // pl_measured_push a registry slot
    uint32_t push_slots;
    // Copies of the solver's and the joints' buffers of these names, before the row that runs.
    pl_buffer bundles, extras, classic, records, impulses;
    pl_buffer found; // pl_measuring a thread: residuals
} pl_measure;

static inline plumb_measures *pl_measures_last(const pl_measure *m)
{
    return (plumb_measures *)m->last.data;
}

#endif
