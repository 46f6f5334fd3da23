/// cost.h - what `plumb cost` measures of one setting of a scene.
#ifndef PLUMB_COST_H
#define PLUMB_COST_H

#include "scene_args.h"

/// One setting and what came of it.
typedef struct cost_row {
    int solver;         ///< index into ENGINE_SOLVERS
    int substeps;       ///< [-]
    int precision;      ///< index into SCENE_PRECISIONS
    double cpu;         ///< [s/s] processor time for a simulated second, the least of all repeats
    double error;       ///< [m] see cost_measure; < 0: there was nothing to compare
    double penetration; ///< [m] deepest overlap of the run
    bool diverged;
    bool best; ///< nothing cheaper is as accurate
} cost_row;

/// Where the bodies were at some moments. {0} is empty; cost_track_free.
typedef struct cost_track {
    struct cost_point *points; ///< all moments one after another
    size_t count, room;        ///< of points
    size_t *ends;              ///< of each moment in `points`
    int moments, moment_room;
} cost_track;

/// What all rows have in common.
typedef struct cost_plan {
    const scene_args *args;
    const char *path;
    double time;            ///< [s] simulated
    double dt;              ///< [s] step of the rows
    long long steps;        ///< of them
    long long sample_steps; ///< steps from one compared moment to the next
    bool has_exact;         ///< compare with the scene's closed form, not with `reference`
    cost_track reference;
    double reference_error; ///< [m] how far the reference moves when its step is doubled
    int reference_substeps;
    progress bar;
    double work; ///< done, in the bar's unit
} cost_plan;

/// How many times finer than the rows the reference steps.
enum { COST_REFERENCE_FINER = 10 };

/// Work of a run in the bar's unit: a step costs about as much as its substeps and two more.
double cost_work(double steps, int substeps);

/// Computes the reference: soft, double, steps of a tenth, and once with a fifth to tell how far
/// it can be trusted. CLI_OK or a code after a message.
int cost_refer(cost_plan *plan);
/// Runs a row once and fills all but `cpu`. The error is the largest distance of any body at any
/// compared moment from the closed form or the reference.
int cost_measure(cost_plan *plan, cost_row *row);
/// Runs a row once by the clock and lowers `cpu` when it was faster.
int cost_time(cost_plan *plan, cost_row *row);

void cost_track_free(cost_track *track);

#endif
