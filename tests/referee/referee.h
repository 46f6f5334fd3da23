/// referee.h - the judge of `make stability`: scenes run by several engines, expectations of the scene made from poses.
///
/// Every engine stands behind the table that the command line sees Plumb through (tools/plumb/engine.h): Plumb itself, and
/// others whose motion is written into the scene's world (harness/peer.h). What is measured is the scene's `expect{}`
/// and nothing else, and those of assets/scenes/hard ask for places and angles alone.
#ifndef REFEREE_REFEREE_H
#define REFEREE_REFEREE_H

#include "plumb/engine.h"

#include <stdio.h>

enum { CONTENDERS_MAX = 10, LINES_MAX = 32, NAME_SIZE = 96 };

/// An engine with its settings.
struct contender {
    const char *name, *way; ///< "Box2D 2.4.1", "as it comes"
    const char *key;        ///< of --engines
    const engine_api *api;
    int solver, substeps, iterations; ///< of engine_settings
    const char *set;                  ///< "key=value" besides; NULL: none
};

extern const engine_api engine_float;

/// All, in the order of columns; what is not in this build has no api.
extern const struct contender referee_contenders[CONTENDERS_MAX];

enum cell_status {
    CELL_CRASHED, ///< nothing came of it: the first state of a run
    CELL_JUDGED,
    CELL_LOST,   ///< its motion is no longer finite: what was not yet judged does not hold
    CELL_SLOW,   ///< it took longer than it may
    CELL_LACKS,  ///< the engine has no words for the scene
    CELL_REFUSED ///< the scene itself is wrong
};

/// One expectation of a scene, as one engine met it.
struct line {
    char name[NAME_SIZE], quantity[64], unit[12];
    double measured, limit, time; ///< time [s]: of the measurement
    bool judged, holds;
};

/// A scene by one engine.
struct cell {
    enum cell_status status;
    char reason[192]; ///< why it lacks words, or is refused
    int count;
    struct line lines[LINES_MAX];
};

/// A scene, with one of its parameters set if `key` is given; or a point of a sweep.
struct task {
    const char *path;
    const char *key;
    double value;
    struct cell *cells; ///< one a contender
};

struct referee {
    const struct contender *contenders[CONTENDERS_MAX];
    int contender_count;
    struct task *tasks;
    int task_count;
    int jobs;
    double limit; ///< [s] of processor time that a run may take
};

/// Runs all tasks, `jobs` at a time, each in a process of its own. CLI_OK, or what went wrong.
int referee_run(struct referee *r);

/// Whether all lines hold.
bool referee_holds(const struct cell *cell);
/// "mass_press" of "assets/scenes/hard/mass_press.lua".
void referee_name(const char *path, char *name, size_t size);

/// Tables of the first `count` tasks, which are scenes. `colour`: for a terminal.
void referee_print(FILE *file, const struct referee *r, int count, bool colour);
void referee_print_summary(FILE *file, const struct referee *r, int count, bool markdown);
void referee_print_markdown(FILE *file, const struct referee *r, int count);
void referee_print_csv(FILE *file, const struct referee *r, int count);

/// The sweeps: how many points, their tasks (scenes below `folder`), and their charts and CSV into `out`.
int referee_sweep_points(void);
void referee_sweep_tasks(struct task *tasks, const char *folder);
int referee_sweep_draw(const struct referee *r, const struct task *tasks, const char *out);

#endif
