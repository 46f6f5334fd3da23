/// scene.h - loads a scene file (Lua, or canonical JSON), runs it, checks what it expects.
///
///     scene *s;
///     scene_error err;
///     if (scene_load(&(scene_options){ .path = "stack.lua" }, &s, &err) != SCENE_OK) {
///         fprintf(stderr, "%s\n", err.text);          // file:line:column: message (did you mean
///         ...) return 3;
///     }
///     while (!scene_done(s)) {
///         if (scene_step(s, &err) != SCENE_OK) { ... }    // a handler went wrong, or the world
///     }
///     scene_finish(s, &err);
///     for (int i = 0; i < scene_expect_count(s); i++) { scene_expect_result r =
///     scene_expect_get(s, i); } scene_destroy(s);
///
/// The language is described in tools/scene/README.md. A scene is used by one thread at a time;
/// different scenes share nothing. Strings returned live until the next scene_step or the scene's
/// end.
#ifndef SCENE_H
#define SCENE_H

#include <stdio.h>

#include "plumb/plumb.h"

#ifdef __cplusplus
extern "C" {
#endif

// A program cannot link the loader of the other precision by mistake, as with plumb_world_create.
#define scene_load PLUMB_SYMBOL(scene_load)

// clang-format off
/// Every code of the loader: X(name, value, text).
#define SCENE_CODE_LIST(X)                                                                      \
    X(OK,            0, "ok")                                                                   \
    X(E_ARGUMENT,    1, "the caller passed a bad argument")                                     \
    X(E_IO,          2, "a file could not be read")                                             \
    X(E_SYNTAX,      3, "the text is not Lua, or not JSON")                                     \
    X(E_RUNTIME,     4, "the script did something that Lua does not allow")                     \
    X(E_NAME,        5, "an unknown name")                                                      \
    X(E_KEY,         6, "an unknown key")                                                       \
    X(E_TYPE,        7, "a value of the wrong type")                                            \
    X(E_RANGE,       8, "a value out of range, or not finite")                                  \
    X(E_MISSING,     9, "something required is missing")                                        \
    X(E_UNUSED,     10, "something was made and never used")                                    \
    X(E_DUPLICATE,  11, "something was said twice")                                             \
    X(E_CONFLICT,   12, "two things exclude each other")                                        \
    X(E_GEOMETRY,   13, "an outline is degenerate or crosses itself")                           \
    X(E_STATE,      14, "a call at the wrong time, or on something destroyed")                  \
    X(E_LIMIT,      15, "the limit of memory, instructions or time was reached")                          \
    X(E_SET,        16, "--set names something that the scene does not have")                   \
    X(E_WORLD,      17, "the world refused a call")                                             \
    X(E_STOPPED,    18, "the caller asked to stop")
// clang-format on

typedef enum scene_code {
#define SCENE_CODE_ENUM(name, value, text) SCENE_##name = value,
    SCENE_CODE_LIST(SCENE_CODE_ENUM)
#undef SCENE_CODE_ENUM
} scene_code;

/// The fixed text of a code.
const char *scene_code_text(scene_code code);

/// What went wrong and where. `text` is the line to print: "file:line:column: message (did you mean
/// 'x'?)"; line and column are left out where there is none (a file that cannot be opened).
typedef struct scene_error {
    scene_code code;
    char file[256]; ///< the path as given, or "--set"
    int line;       ///< 1-based, 0 if unknown
    int column;     ///< 1-based, in bytes, 0 if unknown
    char message[512];
    char suggestion[64]; ///< "" when there is none
    char text[1024];
} scene_error;

/// How to load. {0} with a path is valid.
typedef struct scene_options {
    const char *path; ///< the file; ".json" at its end means canonical JSON, anything else Lua
    const char *text; ///< the source itself instead of the file; `path` then only names it
    size_t text_size; ///< [B] of `text`
    const char *const *sets; ///< "key=value" each: a key of scene{} or a declared param
    int set_count;
    size_t memory_limit;           ///< [B] of script, world and loader together; 0: 256 MiB
    uint64_t build_instructions;   ///< Lua instructions of the build pass; 0: 1e9
    uint64_t handler_instructions; ///< of one handler call; ten times as many of a step; 0: 1e7
    double build_seconds;          ///< [s] processor time of the build pass; 0: 60
    double handler_seconds;        ///< [s] processor time of all handlers of a step; 0: 10
    bool no_expect; ///< expect{} lines are read but never looked at: they stay PENDING
    bool
        worst; ///< what is broken is measured on: the line tells the worst instead of the first break
    /// True ends the script with E_STOPPED; asked every 1000 instructions; null: none.
    bool (*stop)(void *context);
    void *stop_context;
    void (*print)(void *context, const char *line); ///< for print(); null: stderr
    void *print_context;
    /// Takes the world's step instead of plumb_world_step: another engine, whose motion is written back. Null: none.
    void (*step)(void *context, plumb_world *world, double dt);
    /// What a joint bears of that motion [N], [N m], on b; asked by force(), torque() and reaction(). Null: the world's.
    void (*joint_force)(void *context, plumb_joint joint, double force[2], double *torque);
    void *step_context;
} scene_options;

typedef struct scene scene;

/// Reads and runs the script's build pass and makes its world. On failure *out is null and *err is
/// filled (err may be null).
scene_code scene_load(const scene_options *opts, scene **out, scene_error *err);

/// Frees a scene with its world. Null is ignored.
void scene_destroy(scene *s);

/// One step: due `at`/`every` handlers, plumb_world_step, on_contact/on_end handlers, due
/// expectations. After an error the scene stays failed: the same error comes again.
scene_code scene_step(scene *s, scene_error *err);

/// Evaluates the expectations that wait for the end. Called twice it does nothing.
scene_code scene_finish(scene *s, scene_error *err);

/// What the scene's code does to its world on the way.
enum {
    SCENE_ACTS = 1,    ///< at, every, every_step, split_step
    SCENE_LISTENS = 2, ///< on_contact and its like, edit_contact
    SCENE_FIELDS = 4   ///< field
};
/// Bits of those; 0: a step of the scene is one of its world and nothing else.
unsigned scene_activity(const scene *s);

/// [s] simulated time, exactly start + steps * dt in double.
double scene_time(const scene *s);
/// True when the duration has been reached, or the script called finish().
bool scene_done(const scene *s);
/// The world. Bodies' user data belong to the scene.
plumb_world *scene_world(const scene *s);

/// What scene{} said, overrides applied, defaults resolved.
typedef struct scene_info {
    const char *title;       ///< scene{title=}, or the file name without folder and ending
    const char *description; ///< "" if none
    double dt;               ///< [s]
    double duration;         ///< [s]
    plumb_y_axis y_axis;
    plumb_solver solver;
    int substeps;   ///< [-] in force
    int iterations; ///< [-] in force
    uint64_t seed;
} scene_info;

scene_info scene_get_info(const scene *s);

/// An sRGB colour; a == 0 means "not given".
typedef struct scene_rgba {
    uint8_t r, g, b, a;
} scene_rgba;

/// A body with its name and its looks.
typedef struct scene_body {
    plumb_body entity;
    const char *name; ///< never empty: unnamed bodies are body1, body2, ... by order of making
    bool is_named;    ///< the author gave the name
    double angle;     ///< [rad] that the author gave last, with its full turns
    /// "" when none is wanted; the renderer may fall back on the name if is_named
    const char *label;
    int palette;      ///< colour number, -1 when the author gave none
    scene_rgba color; ///< replaces the palette colour when a > 0
    bool hidden;      ///< not to be drawn: said so, or disabled
} scene_body;

/// Bodies now alive, in order of making. i in [0, count). The array changes when handlers make or
/// destroy bodies, that is only in scene_step.
int scene_body_count(const scene *s);
scene_body scene_body_get(const scene *s, int i);
/// By name; entity null if there is none.
scene_body scene_body_find(const scene *s, const char *name);
/// By entity; entity null if it is not a body of the scene.
scene_body scene_body_of(const scene *s, plumb_body body);

/// A joint with its name and its looks.
typedef struct scene_joint {
    plumb_joint entity;
    const char *name; ///< never empty: unnamed joints are joint1, joint2, ... by order of making
    bool is_named;    ///< the author gave the name
    bool hidden;      ///< not to be drawn
} scene_joint;

/// Joints now there, in order of making. i in [0, count).
int scene_joint_count(const scene *s);
scene_joint scene_joint_get(const scene *s, int i);

/// What camera{} said.
typedef struct scene_camera {
    bool has_view;      ///< `center` and `height` are given
    double center[2];   ///< [m]
    double height;      ///< [m] from lower to upper edge
    bool has_fit;       ///< `box` is given: all of it must be visible
    double box[4];      ///< [m] min x, min y, max x, max y
    const char *follow; ///< name of the body to keep in the middle, "" if none
    bool has_at;        ///< `at` is given
    double at;          ///< [s] when a single picture is taken
    double trail;       ///< [s] how long trails behind moving bodies are; 0: none
} scene_camera;

scene_camera scene_get_camera(const scene *s);
/// How liquid{} wants a phase drawn: palette number, -1: see color; color.a 0: neither was said.
typedef struct scene_liquid {
    int palette;
    scene_rgba color;
} scene_liquid;
scene_liquid scene_get_liquid(const scene *s, int phase);
/// How a soft body wants to be drawn: likewise.
typedef struct scene_softbody {
    int palette;
    scene_rgba color;
} scene_softbody;
scene_softbody scene_get_softbody(const scene *s, plumb_softbody softbody);
/// How air{} wants its smoke drawn: likewise.
typedef struct scene_air {
    int palette;
    scene_rgba color;
    bool hidden;
} scene_air;
scene_air scene_get_air(const scene *s);

/// A lamp of light{}, and how it wants its beams drawn: likewise. Lamps change when handlers make or remove some.
typedef struct scene_light {
    const char *name; ///< "" if none
    int palette;
    scene_rgba color;
    double power; ///< [W] of all rays
    int rays;     ///< 0: nothing of it is to be seen
} scene_light;
int scene_light_count(const scene *s);
scene_light scene_light_get(const scene *s, int i);
/// Follows ray 0, 1, ... of a lamp through the world as it is now: plumb_world_light.
int scene_light_trace(const scene *s, int i, int ray, plumb_light_segment *segments, int capacity,
                      plumb_light_sum *sum);

/// The counters and the text of the scene in one line, e.g. "left 3   right 2   second half"; "" if
/// none.
const char *scene_get_text(const scene *s);

/// Counters made by score(name, value), in order of first use.
int scene_score_count(const scene *s);
const char *scene_score_name(const scene *s, int i);
double scene_score_value(const scene *s, int i);

typedef enum scene_expect_status {
    SCENE_EXPECT_PENDING, ///< not evaluated yet
    SCENE_EXPECT_PASSED,  ///< holds (of `always` and from/till: so far, final after scene_finish)
    SCENE_EXPECT_FAILED,  ///< does not hold
    SCENE_EXPECT_NOT_REACHED ///< the run ended before its time
} scene_expect_status;

/// One expect{} line. On failure `quantity`, `measured` and `limit` are the first that broke; on
/// success the ones that came nearest to breaking.
typedef struct scene_expect_result {
    const char *name;
    scene_expect_status status;
    bool passed;          ///< status == SCENE_EXPECT_PASSED
    const char *quantity; ///< "max_penetration", "ball.y", "test", ...
    const char *unit;     ///< "m", "m/s", "1", ...
    double measured;
    double limit;
    double time;             ///< [s] when it was measured
    int line;                ///< of the expect{} in the file
    const char *description; ///< one readable line: "max_penetration 0.0012 m <= 0.005 m at 10 s"
} scene_expect_result;

int scene_expect_count(const scene *s);
scene_expect_result scene_expect_get(const scene *s, int i);
/// How many expectations are not PASSED.
int scene_expect_failures(const scene *s);

/// The quantities a closed form can give, in this order in `values` and as bits 1 << q.
typedef enum scene_exact_quantity {
    SCENE_EXACT_X,
    SCENE_EXACT_Y,
    SCENE_EXACT_ANGLE,
    SCENE_EXACT_VX,
    SCENE_EXACT_VY,
    SCENE_EXACT_SPIN,
    SCENE_EXACT_COUNT
} scene_exact_quantity;

/// One exact{}: the closed form of one body's motion, or of what the script measures.
typedef struct scene_exact {
    const char *name; ///< "" if none
    const char *body; ///< "": of what the script measures
    const char *unit; ///< of its error: "m", "rad", "m/s", "rad/s", the author's; "1" with a scale
    unsigned given;   ///< bits 1 << SCENE_EXACT_*
    double from;      ///< [s] the form holds from here on; the start when not given
    double till;      ///< [s] up to here; the end when not given
} scene_exact;

int scene_exact_count(const scene *s);
scene_exact scene_exact_get(const scene *s, int i);
/// Values of the closed form at time t [s]: SI units and radians; those not given are NaN.
scene_code scene_exact_eval(scene *s, int i, double t, double values[SCENE_EXACT_COUNT],
                            scene_error *err);
/// What the form says now, of a body what counts of it: its place, else angle, velocity, spin (the second is 0 where
/// there is but one); of what the script measures its value. `scaled`: the error is over a scale of the author's.
scene_code scene_exact_truth(scene *s, int i, double truth[2], bool *scaled, scene_error *err);
/// How far the world is from the form now, in its unit, over its scale: of a body the distance of the place; of forms
/// without a place of the angle, else of the velocity, else of the spin. -1 when the form says nothing of now.
scene_code scene_exact_error(scene *s, int i, double *error, scene_error *err);

/// A declared param("name", default, min, max).
typedef struct scene_param {
    const char *name;
    const char *value; ///< in force, as text
    bool overridden;   ///< by --set
} scene_param;

int scene_param_count(const scene *s);
scene_param scene_param_get(const scene *s, int i);

/// What of the scene has no JSON form, in words: "2 handlers (at, on_contact), 1 closed form"; "" if nothing. Returns
/// how many characters that takes, as snprintf.
int scene_json_lacks(const scene *s, char *text, size_t size);
/// Writes the state now as canonical JSON: sorted keys, one body a line, shortest numbers that read
/// back exactly. Handlers, exact{} and test functions have no JSON form and are left out.
/// False when writing failed.
bool scene_to_json(const scene *s, FILE *file);

#ifdef __cplusplus
}
#endif

#endif
