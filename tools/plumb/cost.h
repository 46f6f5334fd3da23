/// cost.h - what `plumb cost` measures of a scene: settings, quantities, ladders of settings.
///
/// A quantity is something that a setting gets more or less wrong; a row is a setting with its error in each quantity
/// and its processor time; a ladder is a row of settings of which each costs twice the one before.
#ifndef PLUMB_COST_H
#define PLUMB_COST_H

#include "scene_args.h"

enum {
    COST_QUANTITIES_MAX = 24,
    COST_PARTS = 8,        ///< equal parts of the simulated time, each with an error of its own
    COST_SAMPLES_MAX = 64, ///< times that are kept of a row
    COST_ROWS_MAX = 1024,
    COST_LADDERS_MAX = 256
};

/// What is measured of a run.
typedef enum cost_kind {
    COST_FORM,   ///< a closed form of the scene
    COST_PLACES, ///< where bodies are, against the reference, as long as trajectories can be compared
    COST_CENTRE, ///< beyond that, means over time and an ensemble: centre of mass,
    COST_SPREAD, ///< spread of the bodies about it,
    COST_ENERGY  ///< kinetic and potential energy
} cost_kind;

typedef struct cost_quantity {
    cost_kind kind;
    int form; ///< of COST_FORM: its index
    char name[64], unit[16];
    double
        extent;  ///< [unit] size of the truth, by which relative errors are divided; 0: it has none
    double till; ///< [s] measured up to here
    double floor; ///< [unit] how far the truth itself can be trusted
} cost_quantity;

/// One setting of one engine.
typedef struct cost_setting {
    int side;       ///< index into cost_plan.sides
    int solver;     ///< index into the side's solvers
    int precision;  ///< index into SCENE_PRECISIONS
    int substeps;   ///< [-]
    int iterations; ///< [-]
    double dt;      ///< [s]
} cost_setting;

/// One setting and what came of it.
typedef struct cost_row {
    cost_setting set;
    double error[COST_QUANTITIES_MAX]; ///< [unit] largest; < 0: there was nothing to compare
    double noise[COST_QUANTITIES_MAX]; ///< [unit] of ensembles: standard error
    double part[COST_QUANTITIES_MAX]
               [COST_PARTS]; ///< [unit] largest in each part of the time; < 0: none
    bool
        front[COST_QUANTITIES_MAX]; ///< nothing that costs less, or as much within noise, equals it
    double penetration;             ///< [m] deepest overlap of the run
    double samples[COST_SAMPLES_MAX]; ///< [s/s] processor time for a simulated second, run by run
    int sample_count;
    double cpu;    ///< [s/s] the least of all
    double jitter; ///< [s/s] from the least to the median
    bool diverged;
    bool given_up; ///< it took many times the budget, and is no row
    bool own;      ///< the scene's own setting
} cost_row;

/// Which knob a ladder turns.
typedef enum cost_way {
    COST_BY_SUBSTEPS,
    COST_BY_STEP,       ///< steps are halved, with the substeps of the scene
    COST_BY_STEP_ALONE, ///< steps are halved, with one substep
    COST_BY_ITERATIONS,
    COST_WAYS
} cost_way;

/// Why a ladder ended.
typedef enum cost_end {
    COST_FLAT,     ///< errors no longer fell
    COST_ROUNDING, ///< rounding was reached
    COST_BUDGET,   ///< the next run would have taken longer than the budget
    COST_RANGE,    ///< the next setting is not allowed
    COST_ENDS
} cost_end;

typedef struct cost_ladder {
    cost_setting base; ///< what the knob does not turn
    cost_way way;
    cost_end end;
    int rows[48]; ///< indices of rows, cheapest first
    int count;
} cost_ladder;

/// One engine with the settings that it has.
typedef struct cost_side {
    const char *name;
    const char *set;          ///< "key=value" that goes with all its settings; NULL: none
    const char *solvers;      ///< comma list
    unsigned solver_bits;     ///< which of them
    unsigned precision_bits;  ///< of SCENE_PRECISIONS
    unsigned ways;            ///< bits 1 << cost_way
    const engine_api *engine; ///< NULL: Plumb in the setting's precision
    int substeps, iterations; ///< 0: those of the scene, else the engine's own
} cost_side;

/// Settings that the user lists; without a list ladders are climbed.
typedef struct cost_lists {
    cli_ints substeps, iterations, divide;
} cost_lists;

/// What all rows have in common.
typedef struct cost_plan {
    const scene_args *args;
    const char *path;
    const cost_side *sides;
    int side_count;
    char title[128];
    cost_lists lists;
    cost_setting own; ///< the scene's, in float if nothing else is asked for
    double time;      ///< [s] simulated
    double dt;        ///< [s] the scene's step
    double budget;    ///< [s] processor time that a run may take
    int repeat;
    cost_quantity quantities[COST_QUANTITIES_MAX];
    int quantity_count;
    bool has_joints;
    bool has_exact; ///< compared with closed forms, not with a run of its own
    double
        horizon; ///< [s] up to which trajectories can be compared; the whole time if they always can
    bool is_wandering; ///< the horizon is where the reference itself moves when its step is doubled
    double growth;     ///< [-] by how much a tiny difference at the start had grown then
    int reference_substeps;       ///< of the scene's own finest setting
    double reference_dt;          ///< [s]
    struct cost_track *reference; ///< NULL: none
    double means
        [8]; ///< of the reference's ensemble: centre x, y, spread, energy; then the standard error of each
    cost_row *rows;
    int row_count;
    int order[COST_ROWS_MAX]; ///< of rows, cheapest first, what diverged last: cost_rank
    cost_ladder *ladders;
    int ladder_count;
    progress bar;
} cost_plan;

/// Starts of an ensemble, and by how much of the scene's size they are moved.
enum { COST_MEMBERS = 8 };

/// Opens the scene with a setting. CLI_OK or a code after a message.
int cost_open(const cost_plan *plan, const cost_setting *set, scene_run *run);
/// Plumb's own sides: its solvers of `solver_bits`, and once more with joints solved directly, which pays only where
/// there are some (cost_plan_open leaves it out elsewhere). 2.
int cost_own_sides(unsigned solver_bits, unsigned precision_bits, cost_side sides[2]);
/// Fills a plan that has sides, lists, budget and repeats from the scene as the command line has it. CLI_OK or a code
/// after a message.
int cost_plan_open(cost_plan *plan, const scene_args *args, const char *path);
/// Finds quantities, the horizon and, where the scene has no closed form, the reference.
int cost_survey(cost_plan *plan);
void cost_plan_free(cost_plan *plan);

/// Runs a row and fills its errors. CLI_OK, also when it diverged, or a code after a message.
int cost_measure(cost_plan *plan, cost_row *row);
/// Runs a row by the clock, once or, if it is short, a few times.
int cost_time(cost_plan *plan, cost_row *row);

/// Climbs all ladders, or goes through the lists; then times all rows in turns, so that a slow second of the machine
/// hits all alike.
int cost_climb(cost_plan *plan);
const char *cost_way_text(cost_way way);
const char *cost_end_text(cost_end end);

/// Puts rows in order and marks the fronts.
void cost_rank(cost_plan *plan);
/// Error of a quantity over its extent.
double cost_relative(const cost_quantity *quantity, double error);
/// The cheapest row whose errors are all within `tolerance`, of sides named `side` (NULL: of all); NULL: none.
const cost_row *cost_cheapest(const cost_plan *plan, const char *side, double tolerance,
                              bool relative);
/// The words of the command line for a setting.
void cost_words(const cost_plan *plan, const cost_setting *set, char *text, size_t size);

void cost_print_table(const cost_plan *plan, bool relative, bool all);
void cost_print_csv(FILE *file, const cost_plan *plan, bool relative);

/// Refuses a name that is neither .svg nor .png. CLI_OK or CLI_USAGE after a message.
int cost_chart_check(const char *path);
/// Draws the rows, ranked, by gnuplot. CLI_OK, or CLI_FAILED after a message: gnuplot is not there, the disk is full.
int cost_chart(const cost_plan *plan, const char *path, bool relative);
/// Draws what `put` writes as a script; it begins with cost_put_terminal.
int cost_draw(const char *path, void (*put)(FILE *script, const char *path, const void *context),
              const void *context);
/// The picture's kind by its name, its size, and how axes look.
void cost_put_terminal(FILE *script, const char *path, int width, int height);

// ------------------------------------------------------------------------------- tracks (cost_track.c)

/// Where the bodies were at some moments.
typedef struct cost_track cost_track;
cost_track *cost_track_new(void);
void cost_track_free(cost_track *track); ///< null is allowed
/// Appends the moving bodies as they are now; `run` null: a moment at which nobody looked. False: out of memory.
bool cost_track_add(cost_track *track, const scene_run *run);
int cost_track_moments(const cost_track *track);
/// The largest distance of a body at a moment; -1 when no body is in both, or nobody looked. A body that only one of them still has
/// cannot be compared.
double cost_track_distance(const cost_track *a, const cost_track *b, int moment);
/// [m] the longest way of a body from where it was at the first moment.
double cost_track_way(const cost_track *track);

/// How many moments tracks are taken at, and one of them [s]; moment -1 is the start.
int cost_moments(const cost_plan *plan);
double cost_moment(const cost_plan *plan, int moment);
/// Runs a setting, its start moved by `nudge` [m], into a track. CLI_DIVERGED comes without a message.
int cost_follow(cost_plan *plan, const cost_setting *set, double nudge, unsigned seed,
                cost_track *track);
/// Means over an ensemble, from the horizon on: centre x, y, spread, energy, and the standard error of each.
int cost_ensemble(cost_plan *plan, const cost_setting *set, double mean[4], double error[4]);

#endif
