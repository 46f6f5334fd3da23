/// scene_args.h - what all commands that run a scene have in common: the options that override
/// the scene, opening it, and the time line of a run.
#ifndef PLUMB_SCENE_ARGS_H
#define PLUMB_SCENE_ARGS_H

#include "engine.h"
#include "watch.h"

/// Values of SCENE_OPTIONS. Begin with SCENE_ARGS_INIT.
typedef struct scene_args {
    double time;          ///< [s] to simulate; < 0: the scene's duration
    double dt;            ///< [s] 0: the scene's
    int substeps;         ///< 0: the scene's
    int iterations;       ///< 0: the scene's
    int solver;           ///< -1: the scene's
    const char *accuracy; ///< NULL: the scene's
    int width;            ///< 0: best
    int workers;          ///< 0: the scene's
    int precision;        ///< index into SCENE_PRECISIONS
    cli_texts sets;
    bool watchdog;
    cli_texts allowed; ///< of check: alarms that may be told, or rules of the linter
    bool quiet;
    bool no_expect; ///< no option: nobody asks whether expectations hold
    bool unseen;    ///< no option: nobody looks between steps
    const engine_api
        *engine; ///< no option: another engine behind the same table; NULL: Plumb in `precision`
} scene_args;

#define SCENE_ARGS_INIT                                                                            \
    {                                                                                              \
        .time = -1, .solver = -1                                                                   \
    }
#define SCENE_PRECISIONS "float,double,far"

/// [s] the longest run: 2^53 steps are not reached with it at any step size.
#define SCENE_TIME_MAX 1e9

// clang-format off
/// Rows of the option table for a struct `type` whose member `member` is a scene_args.
#define SCENE_OPTION_TIME_OR(type, member, otherwise)                                            \
    { "time", 't', CLI_REAL, offsetof(type, member.time), "S", 0, SCENE_TIME_MAX, NULL,          \
      "simulate S seconds (default: " otherwise ")" }
#define SCENE_OPTION_TIME(type, member)                                                          \
    SCENE_OPTION_TIME_OR(type, member, "the scene's duration")
#define SCENE_OPTION_PRECISION(type, member)                                                     \
    { "precision", 0, CLI_CHOICE, offsetof(type, member.precision), "P", 0, 0, SCENE_PRECISIONS, \
      "float (default), double, or far: positions in double, the solver in float" }
#define SCENE_OPTION_WIDTH(type, member)                                                         \
    { "width", 0, CLI_INT, offsetof(type, member.width), "N", 0, 16, NULL,                       \
      "SIMD lanes of floats: 4, 8 or 16; 0 takes the best measured (default). Changes the speed, "          \
      "not a bit of the result" }
#define SCENE_OPTION_WORKERS(type, member)                                                       \
    { "workers", 0, CLI_INT, offsetof(type, member.workers), "N", 1, 64, NULL,                   \
      "threads that share the work of a step (default: the scene's, else 1). Changes the speed, " \
      "not a bit of the result" }
#define SCENE_OPTION_SET(type, member)                                                           \
    { "set", 0, CLI_TEXTS, offsetof(type, member.sets), "KEY=VALUE", 0, 0, NULL,                 \
      "override what the scene declares; may be repeated" }
#define SCENE_OPTION_WATCHDOG(type, member)                                                      \
    { "watchdog", 0, CLI_FLAG, offsetof(type, member.watchdog), NULL, 0, 0, NULL,                \
      "watch each step: alarms of what it should never do, with who, where, and what was called last" }
#define SCENE_OPTION_QUIET(type, member)                                                         \
    { "quiet", 'q', CLI_FLAG, offsetof(type, member.quiet), NULL, 0, 0, NULL,                    \
      "no progress bar" }
#define SCENE_OPTION_DT(type, member)                                                            \
    { "dt", 0, CLI_REAL, offsetof(type, member.dt), "S", 1e-6, 1, NULL,                          \
      "step size in seconds; 1/120 works, too (default: the scene's, else 1/60)" }
#define SCENE_OPTION_SUBSTEPS(type, member)                                                      \
    { "substeps", 0, CLI_INT, offsetof(type, member.substeps), "N", 1, 64, NULL,                 \
      "substeps a step (default: the scene's, else 4)" }
#define SCENE_OPTION_ITERATIONS(type, member)                                                    \
    { "iterations", 0, CLI_INT, offsetof(type, member.iterations), "N", 1, 1000, NULL,           \
      "solver sweeps: a step (pgs, default 10), a substep (soft, default 1)" }
#define SCENE_OPTION_SOLVER(type, member)                                                        \
    { "solver", 0, CLI_CHOICE, offsetof(type, member.solver), "NAME", 0, 0, ENGINE_SOLVERS,      \
      "soft: soft step with substeps (default); pgs: projected Gauss-Seidel, the classic; exact: all of an island by a direct method" }

#define SCENE_OPTION_ACCURACY(type, member)                                                      \
    { "accuracy", 0, CLI_TEXT, offsetof(type, member.accuracy), "X", 0, 0, NULL,                 \
      "a tolerance as 1e-3, for which the world chooses solver and substeps itself, or a preset: arcade, game, "  \
      "precise, reference" }

/// All of them, for commands that run one scene with one setting.
#define SCENE_OPTIONS(type, member)                                                              \
    SCENE_OPTION_TIME(type, member), SCENE_OPTION_DT(type, member),                              \
    SCENE_OPTION_SUBSTEPS(type, member), SCENE_OPTION_ITERATIONS(type, member),                  \
    SCENE_OPTION_SOLVER(type, member), SCENE_OPTION_ACCURACY(type, member),                      \
    SCENE_OPTION_WIDTH(type, member),                                                            \
    SCENE_OPTION_WORKERS(type, member),                                                          \
    SCENE_OPTION_PRECISION(type, member), SCENE_OPTION_SET(type, member),                        \
    SCENE_OPTION_WATCHDOG(type, member)
// clang-format on

/// Checks a --width. CLI_OK or CLI_USAGE after a message.
int scene_width_check(const cli_command *command, int width);

/// Checks what the table cannot (width, form of --set). CLI_OK or CLI_USAGE after a message.
int scene_args_check(const cli_command *command, const scene_args *args);

/// A scene that is open.
typedef struct scene_run {
    const engine_api *engine;
    engine_session *session;
    engine_stage *stage;
    engine_info info;
    double time;       ///< [s] to simulate
    long long steps;   ///< of info.dt, to reach `time`
    watch_tally watch; ///< alarms so far
} scene_run;

/// Opens the scene. On failure a message was printed and `run` holds nothing.
int scene_run_open(const scene_args *args, const char *path, scene_run *run);
/// Tells on stderr of bodies that begin inside one another: they will fly apart, which authors seldom mean.
void scene_run_warn(const scene_run *run, const char *path);
/// What a world with a tolerance chose, and what error it made: words without a line's end. False: it has no tolerance.
bool scene_run_accuracy(const scene_run *run, char *text, size_t size);
/// Takes one step and looks whether all is finite. On failure the bar (may be null) is taken away
/// and the message printed.
int scene_run_step(scene_run *run, progress *bar);
/// True when `step` steps are all: the time is over, the scene's code ended the run, or the user.
bool scene_run_done(const scene_run *run, long long step);
/// Closes. Answers `code`.
int scene_run_close(scene_run *run, int code);

/// Tells that no body is named `name`, as `option` (without dashes) says, and which name is near.
/// CLI_USAGE.
int scene_unknown_body(const engine_scenery *of, const char *option, const char *name);

/// Prints an engine's message to stderr and answers its code.
int scene_report(const engine_error *error);

/// Number of steps of `dt` that reach `time`.
long long scene_step_count(double time, double dt);

#endif
