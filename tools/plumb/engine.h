/// engine.h - the engine and the scene loader behind plain types, so that the float and the
/// double build of both live in one process.
///
/// Nothing here depends on plumb_real. The files engine*.c implement it; they are compiled
/// twice, and each variant is linked with its own libplumb and scene loader into one object of
/// which only engine_float, engine_double or engine_far is visible (README.md, "Three precisions").
///
/// A function that can fail answers a cli_exit and fills `error` (never null).
#ifndef PLUMB_ENGINE_H
#define PLUMB_ENGINE_H

#include "cli.h"

struct render_frame;
struct engine_mover;

/// What went wrong: an exit code and complete text for the user, possibly several lines.
typedef struct engine_error {
    int code;   ///< cli_exit
    int reason; ///< errno of a write that failed, else 0
    char text[2048];
} engine_error;

/// What to open and what to override.
typedef struct engine_settings {
    const char *path;        ///< scene file, .lua or .json
    const char *text;        ///< the scene itself, `path` only names it; NULL: read the file
    const char *const *sets; ///< "key=value" each
    int set_count;
    double dt;            ///< [s] step; 0: the scene's
    int substeps;         ///< 0: the scene's
    int iterations;       ///< 0: the scene's
    int solver;           ///< index into ENGINE_SOLVERS; -1: the scene's
    const char *accuracy; ///< a tolerance or the name of a preset; NULL: the scene's
    int width;            ///< SIMD lanes; 0: the scene's or the best
    int workers;          ///< threads; 0: the scene's or one
    bool watchdog;        ///< the world is watched, and measures
    bool no_expect;       ///< nobody asks whether expectations hold
    bool worst; ///< expectations tell their worst moment, not the first at which they break
    bool
        unseen; ///< nobody looks between steps, nor at the time: what only looks need may be left out
    const struct engine_mover *mover; ///< moves the scene instead of its world; NULL: none
} engine_settings;

/// The solvers by name, in the order of plumb_solver.
#define ENGINE_SOLVERS "soft,pgs,exact"

/// What the scene says about where to look.
typedef struct engine_camera {
    bool has_view;      ///< center and height are given
    double x, y;        ///< [m] centre
    double height;      ///< [m] of the view
    bool has_fit;       ///< the box is given: all of it must be visible
    double box[4];      ///< [m] min x, min y, max x, max y
    const char *follow; ///< body to keep in the middle, "" if none
    double at;          ///< [s] when a single picture is taken; < 0: not given
    double trail;       ///< [s] how long trails are; 0: none
} engine_camera;

/// What was opened, with all defaults resolved.
typedef struct engine_info {
    const char *name;       ///< the scene's title, or its file's name
    double duration;        ///< [s] the scene's, the recording's
    double dt;              ///< [s] of a recording the mean
    int substeps;           ///< [-]
    int iterations;         ///< [-]
    int solver;             ///< index into ENGINE_SOLVERS
    int width;              ///< SIMD lanes in use
    bool y_down;            ///< the scene's y axis points down
    double wrap_x, wrap_y;  ///< [m] the world wraps around every so many; 0: not along that axis
    int exact_count;        ///< closed forms declared
    int joint_count;        ///< joints now
    const char *exact_unit; ///< of their errors; "" when they have several
    engine_camera camera;
} engine_info;

/// One body now.
typedef struct engine_row {
    const char *name;       ///< valid until the next step
    double x, y;            ///< [m]
    double angle;           ///< [rad]
    double vx, vy;          ///< [m/s]
    double w;               ///< [rad/s]
    bool moves;             ///< not static
    unsigned char color[4]; ///< red, green, blue, opacity in which it is drawn
} engine_row;

/// One closed form of a scene.
typedef struct engine_form {
    const char *name; ///< "" if none
    const char *unit; ///< of its error
    bool is_motion;   ///< of a body, not of what the script measures
    bool is_place;    ///< of where it is or how it is turned: the way counts, not the value
    bool is_scaled;   ///< the author divides by a scale of his own
    double value[2];  ///< what it says now: place, angle, velocity, spin, or value
} engine_form;

/// What all dynamic bodies are together.
typedef struct engine_totals {
    double x, y;   ///< [m] centre of mass
    double spread; ///< [m] root of the mean square distance from it
    double energy; ///< [J] kinetic and potential
} engine_totals;

/// One expectation after engine_api.finish.
typedef struct engine_expect {
    const char *name;
    bool passed;
    bool reached;     ///< false: the run ended before its time
    const char *text; ///< what was measured, the limit and when, in one line
    const char *quantity, *unit;
    double measured, limit, time; ///< time [s]: of the measurement
} engine_expect;

/// One pass of the schedule.
typedef struct engine_pass {
    const char *name, *phase, *reads, *writes, *reason;
    const char *variants[8]; ///< of its kernels that run
    int variant_count;
    const char *away[8]; ///< and those that nothing in this world needs
    int away_count;
    bool scheduled, is_user;
    bool in_substeps; ///< runs inside of the solver's pass
    double total_ns;  ///< [ns] since passes were first asked for
} engine_pass;

/// Because of whom a pass runs, and what it visits.
typedef struct engine_because {
    char first[64];   ///< name; "": nobody's, or nobody knows
    int count;        ///< of those like it
    long rows;        ///< -1: nobody knows
    const char *what; ///< "bodies", "contacts", ...; "" if rows is -1
    double bytes;     ///< [B] of the data that it reads or writes, a step
} engine_because;

#define ENGINE_WORKS 32 ///< more than there are

/// What a run did to the energy of its world, by what did it, and the most that is left of laws in any step: plumb_measures.
typedef struct engine_measures {
    int count; ///< of works
    struct {
        const char *name, *text;
        double kinetic, potential; ///< [J] summed over the steps
    } works[ENGINE_WORKS];
    double before, after; ///< [J] as the run began, as it is now
    double gap, approach, complementarity, cone, momentum, joint_length, joint_angle;
    long long steps;
} engine_measures;

/// Counts of the last step, as in plumb_stats.
typedef struct engine_stats {
    unsigned long long step_count;
    double time; ///< [s]
    unsigned bodies, moving, asleep, islands, statics, shapes, pieces, pairs, contacts, points,
        colors, overflow;
    unsigned pair_rebuilds;
    unsigned soft_asleep; ///< soft bodies that sleep
    unsigned soft_missed; ///< substeps in all whose soft bodies had not settled
    unsigned cut_chains;  ///< contacts in all whose impacts in a substep were not all followed
    double max_penetration, mean_penetration; ///< [m]
    size_t bytes, peak_bytes;                 ///< [B]
} engine_stats;

/// What a world with a tolerance chose: see plumb/accuracy.h.
typedef struct engine_accuracy {
    double tolerance; ///< [-] 0: it has none
    double motion, frozen, rest, worst;
    int solver, substeps;
    bool direct_joints, met;
    const char *reason;
    double solved; ///< [-] substeps a step
} engine_accuracy;

/// A word of the scene language.
typedef struct engine_word {
    const char *name;
    const char *topic; ///< "shapes", "joints", ...: what the constructor belongs to
    const char *kind;  ///< what is expected: "number", "true or false", "one of up|down"
    const char *unit;  ///< "" if none
    double min, max;   ///< range of numbers, equal if there is none
    int position;      ///< may also be given as the n-th element; 0: by name only
    bool required;
    bool above;       ///< `min` itself is not allowed
    double initial;   ///< the default, where `text` is not ""
    const char *text; ///< one sentence; "" for a word of the language alone
} engine_word;

/// A box in the plane [m]; empty when min > max.
typedef struct engine_box {
    double min_x, min_y, max_x, max_y;
} engine_box;

/// A bit for engine_api.draw beside those of the renderer: write the names of all bodies. Without
/// it names are written only where few bodies have one; labels that the author gave always are.
#define ENGINE_SHOW_NAMES (1u << 30)

/// A recording that is being replayed, and where it stands.
typedef struct engine_replay_info {
    const char *title;
    unsigned long long steps, step; ///< in the recording; taken
    unsigned long long keyframes, edited, bytes;
    unsigned long long first; ///< steps that the world had taken before
    double start, end;        ///< [s] of the world at the head and after the last step
    double time, dt;          ///< [s] now; of the step that led here
    unsigned long long hash;  ///< of the world here
    bool complete;            ///< it was ended; false: it breaks off
} engine_replay_info;

/// Something that a user changed, or that differs between two worlds, in words.
typedef struct engine_change {
    char when[24];         ///< "before the step", "begin systems", ...
    char who[160];         ///< "body 'ball'", "shape 7:1 of body 'ball'", "world"
    char what[96];         ///< "vx", "created", ...
    char from[64], to[64]; ///< values, "" if none
} engine_change;

/// Where two recordings differ first.
typedef struct engine_difference {
    bool found;
    unsigned long long step;
    double time[2];          ///< [s]
    char pass[64];           ///< "": unknown, one of them is of another build
    unsigned long long seen; ///< steps at which `first` was seen; 0: nowhere
    engine_change first;
} engine_difference;

/// An alarm of the watchdog: plumb_alarm, in words.
typedef struct engine_alarm {
    int number; ///< of the kind
    const char *kind, *advice;
    char text[256];
} engine_alarm;

typedef struct engine_replay engine_replay;
typedef struct engine_session engine_session;
/// Two bodies that begin inside one another.
typedef struct engine_overlap {
    const char *a, *b; ///< names
    double depth;      ///< [m]
} engine_overlap;

/// What a rule of the linter has found, and what to do (lint.h).
typedef struct engine_finding {
    const char *rule, *advice;
    char text[224];
    int more; ///< of `unused`: so many others like it
} engine_finding;

/// What is to be seen now: of a scene that runs, or of a recording.
typedef struct engine_stage engine_stage;

/// One engine. All lists that it hands out are valid until the next call with the same session, stage
/// or replay.
typedef struct engine_api {
    const char *precision; ///< "float", "double" or "far"
    bool is_float;

    engine_session *(*open)(const engine_settings *settings, engine_error *error);
    void (*close)(engine_session *session); ///< null is allowed
    /// As long as the session is open, always the same.
    engine_stage *(*stage)(engine_session *session);
    /// Advances by info.dt. CLI_SCENE: an error in the scene's code; CLI_FAILED: out of memory.
    int (*step)(engine_session *session, engine_error *error);
    /// CLI_DIVERGED when a body's state is NaN or infinite. O(bodies).
    int (*check)(engine_session *session, engine_error *error);
    /// Pairs of bodies that are inside one another now, by more than a twentieth of the smaller one's thickness, and
    /// will be pushed apart; deepest first. -1: out of memory.
    int (*overlaps)(engine_session *session, const engine_overlap **list);
    /// What is likely to go wrong with the scene as it is now, by rules. -1: out of memory.
    int (*lint)(engine_session *session, const engine_finding **list);
    /// Alarms of the last step. -1: out of memory.
    int (*alarms)(engine_session *session, const engine_alarm **list);
    /// True when the scene's code has ended the run.
    bool (*ended)(const engine_session *session);
    /// The end of the run, for what only then can be judged.
    int (*finish)(engine_session *session, engine_error *error);
    /// How far the worst of the closed forms is from the truth now, in info.exact_unit. -1 when no form holds now.
    int (*exact)(engine_session *session, double *distance, engine_error *error);
    /// How far the world is from form `i` now, in the form's unit; -1 when it says nothing of now.
    int (*form_error)(engine_session *session, int i, double *distance, engine_error *error);
    /// The form itself, and what it says now.
    int (*form)(engine_session *session, int i, engine_form *form, engine_error *error);
    /// Moves dynamic bodies that are awake by `distance` [m], each in a direction of its own that follows from `seed`.
    void (*nudge)(engine_session *session, double distance, unsigned seed);
    /// -1: out of memory.
    int (*expectations)(engine_session *session, const engine_expect **list);
    /// -1: out of memory.
    int (*passes)(engine_session *session, const engine_pass **list);
    /// Because of whom a pass of that list runs now, and what it visits. O(bodies + shapes + joints).
    void (*because)(engine_session *session, const engine_pass *pass, engine_because *because);
    /// Notes what of the scene's effects was of use in the last step. False: out of memory. O(bodies + shapes).
    bool (*note_use)(engine_session *session);
    /// What was of no use in any step that was noted. -1: out of memory.
    int (*unused)(engine_session *session, const engine_finding **list);
    /// Names of effects that the library is built without; null behind the last.
    const char *(*lacks)(int index);
    /// From the first call on, with {0}, steps are measured; each call behind a step adds it to `sum`.
    void (*measure)(engine_session *session, engine_measures *sum);
    /// Key `key` of constructor `constructor` of the scene language; key -1: the constructor
    /// itself. False past the end.
    bool (*word)(int constructor, int key, engine_word *word);
    /// What of it has no JSON form, in words, "" if nothing; until the next call.
    const char *(*json_lacks)(engine_session *session);
    /// Writes the scene as canonical JSON. False when writing failed.
    bool (*to_json)(const engine_session *session, FILE *file);

    /// Records the session from here on, with the names of bodies and joints; every `keyframes` steps
    /// (0: the default) with a keyframe. CLI_FAILED: out of memory, or the file takes no more.
    int (*record)(engine_session *session, FILE *file, int keyframes, engine_error *error);
    int (*record_end)(engine_session *session, engine_error *error);

    engine_info (*info)(const engine_stage *stage);
    double (*time)(const engine_stage *stage); ///< [s] simulated
    engine_stats (*stats)(const engine_stage *stage);
    engine_accuracy (*accuracy)(const engine_stage *stage);
    engine_totals (*totals)(const engine_stage *stage);
    /// The scene's counters and text in one line, "" if none.
    const char *(*text)(const engine_stage *stage);
    /// All bodies in the order in which they were made; of a recording by handle, which is the same as
    /// long as none is used again. -1: out of memory.
    int (*rows)(engine_stage *stage, const engine_row **rows);
    /// Boxes around the bodies that move and around those that do not. Of those that move, who is farther than `reach` [m] and
    /// its size from where most are does not count.
    void (*bounds)(const engine_stage *stage, double reach, engine_box *moving, engine_box *fixed);
    /// Adds bodies and overlays (RENDER_SHOW_* bits, ENGINE_SHOW_NAMES) to the frame. CLI_FAILED:
    /// out of memory.
    int (*draw)(engine_stage *stage, struct render_frame *frame, unsigned show);
    /// Adds arrows of gravity and laws on a grid over what the camera shows. CLI_FAILED: out of memory.
    int (*draw_field)(engine_stage *stage, struct render_frame *frame, const engine_box *view);
    /// The same of the flow of air and fluids.
    int (*draw_flow)(engine_stage *stage, struct render_frame *frame, const engine_box *view);

    /// Opens a recording, which must stay where it is; NULL: see `error`. `edits`: they are told.
    engine_replay *(*replay_open)(const char *path, const void *bytes, size_t size, int width,
                                  bool edits, engine_error *error);
    void (*replay_close)(engine_replay *replay); ///< null is allowed
    engine_replay_info (*replay_info)(const engine_replay *replay);
    /// Goes to where `step` steps have been taken. CLI_DIFFERS: a step does not give the bits that were
    /// recorded.
    int (*replay_seek)(engine_replay *replay, unsigned long long step, engine_error *error);
    /// The last step at which no more than `time` [s] had gone by.
    unsigned long long (*replay_find)(const engine_replay *replay, double time);
    /// What is to be seen where it stands, until the next seek; NULL: out of memory. O(bodies), sorted.
    engine_stage *(*replay_stage)(engine_replay *replay);
    /// What the user changed in the step that led here. -1: out of memory.
    int (*replay_edits)(engine_replay *replay, const engine_change **list);
    /// Settings in which two replays differ now. -1: out of memory.
    int (*replay_settings)(engine_replay *a, engine_replay *b, const engine_change **list);
    /// From where both stand to the first step in which they differ.
    int (*replay_compare)(engine_replay *a, engine_replay *b, engine_difference *difference,
                          engine_error *error);
} engine_api;

/// A stage, its engine and what is known of it: what cameras aim at and pictures are taken of.
typedef struct engine_scenery {
    const engine_api *engine;
    engine_stage *stage;
    engine_info info;
} engine_scenery;

// Those that the program was linked with: `make demo` leaves out double and far.
extern const engine_api engine_float __attribute__((weak));
extern const engine_api engine_double __attribute__((weak));
extern const engine_api engine_far __attribute__((weak));
#define CLI_LACKS_PRECISION "this program was built without that precision; `make` builds all"

#endif
