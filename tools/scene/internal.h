/// internal.h - what the files of the scene loader share. Nothing here is for users.
///
/// Reading order: scene.h, internal.h, fields.c (how a table becomes a struct), lists.c (one list a
/// constructor), build.c, shapes.c, body_api.c, handlers.c, expect.c, scene.c, sandbox.c, the rest.
#ifndef SCENE_INTERNAL_H
#define SCENE_INTERNAL_H

#include <lua.h>
#include <lauxlib.h>

#include "scene.h"

#define SC_NAME_SIZE 64      ///< [B] of a name with its final zero
#define SC_CHUNK     "scene" ///< chunk name given to Lua; errors carry the real path

// ------------------------------------------------------------------------------------- memory

/// Memory and instructions that the script, the loader and the world may use together.
typedef struct sc_budget {
    size_t used;          ///< [B] now
    size_t limit;         ///< [B]
    uint64_t spent;       ///< Lua instructions since the start of the build pass or handler call
    uint64_t spend_limit; ///< see scene_options
    bool out_of_time;     ///< `spent` went past its limit
    bool long_string;     ///< a string longer than SC_STRING_MAX was asked for
    int line;             ///< where the script stood when a limit was met
    lua_State *L;
} sc_budget;

#define SC_HOOK_STEP  1000                ///< instructions between two looks at the budget
#define SC_STRING_MAX ((size_t)64 * 1024) ///< [B] longest string a script may make

void *sc_resize(scene *s, void *p, size_t old_size, size_t new_size); ///< realloc within the budget
void *sc_need(scene *s, void *p, size_t old_size, size_t new_size); ///< the same, raises on failure
void *sc_world_resize(void *context, void *p, size_t old_size, size_t new_size);
void *sc_lua_alloc(void *context, void *p, size_t old_size, size_t new_size);

// ------------------------------------------------------------------------------------- errors

/// Where a construct stands in the source, for messages.
typedef struct sc_site {
    const char *construct; ///< "body", "box", ...; a JSON object of that kind
    int line;              ///< Lua: line of the call
    const char *path;      ///< JSON: "bodies[3].shapes[0]"; null in Lua
} sc_site;

/// Records an error and leaves the protected call. `key` (may be null) or `index` (0: none) tell
/// which part of the construct is meant; `suggestion` may be null.
_Noreturn void sc_raise(scene *s, scene_code code, const sc_site *site, const char *key, int index,
                        const char *suggestion, const char *format, ...)
    __attribute__((format(printf, 7, 8)));
/// The site of the function that the script is calling now.
sc_site sc_here(scene *s, const char *construct);
/// Turns a failed lua_pcall into s->error (unless sc_raise did already) and empties the stack.
void sc_take_error(scene *s, int status);
/// Fills s->error without leaving.
void sc_set_error(scene *s, scene_code code, int line, int column, const char *suggestion,
                  const char *message);

/// Position of a key or element of a construct in Lua text.
void sc_lua_position(const char *text, size_t size, const sc_site *site, const char *key, int index,
                     int *line, int *column);
/// Column of a word on a line (whole token; the first one if `word` is null).
int sc_lua_column(const char *text, size_t size, int line, const char *word);
/// Column of the token at which Lua's parser gave up.
int sc_lua_syntax_column(lua_State *L, const char *text, size_t size, int line, const char *near);
/// First `^` that is not `^ 2`; false if there is none.
bool sc_lua_find_power(const char *text, size_t size, int *line, int *column);
/// Position of a value (or of its key) in JSON text.
void sc_json_position(const char *text, size_t size, const char *path, const char *key, int index,
                      int *line, int *column);

/// The candidate that is most like a word, for "did you mean".
typedef struct sc_suggest {
    const char *word;
    char best[SC_NAME_SIZE];
    int distance;
} sc_suggest;

sc_suggest sc_suggest_start(const char *word);
void sc_suggest_offer(sc_suggest *g, const char *candidate);
/// Takes a word whatever the distance (a known synonym, shorter than SC_NAME_SIZE).
void sc_suggest_force(sc_suggest *g, const char *candidate);
/// The best one, or null when none is near enough.
const char *sc_suggest_best(const sc_suggest *g);

// ------------------------------------------------------------------------------------- fields

typedef enum sc_kind {
    SC_NUMBER,   ///< double
    SC_INTEGER,  ///< double with an integer in it
    SC_BOOL,     ///< bool
    SC_STRING,   ///< char[size]
    SC_VEC2,     ///< double[2], from {x, y}
    SC_CHOICE,   ///< int, index into `detail` = "up|down"
    SC_RANGE,    ///< double[2], from a number or {min, max}
    SC_COLOR,    ///< sc_color, from "#rrggbb" or a palette number
    SC_MATERIAL, ///< struct sc_material *
    SC_POINTS,   ///< int: how many points were put into s->points
    SC_FUNCTION, ///< int: reference in the registry
    SC_BODY,     ///< char[SC_NAME_SIZE]: from a name or a body
    SC_BOX,      ///< double[4], from {{x0, y0}, {x1, y1}}
    SC_SHAPES,   ///< int: how many shapes stand in the array part
    SC_AXES,     ///< int: bits of locked axes, from {"x", "y", "rotation"}
    SC_TABLE     ///< bool: a table is there
} sc_kind;

enum {
    SC_REQUIRED = 1, ///< must be given
    SC_ABOVE = 2,    ///< `min` itself is not allowed
    SC_REST = -1     ///< as `position`: takes the whole array part
};

/// One key of a constructor. The lists in lists.c are the single source of names, ranges and units.
typedef struct sc_field {
    const char *name;
    sc_kind kind;
    size_t offset;
    size_t size; ///< SC_STRING: bytes
    double min, max;
    const char *detail; ///< unit, or choices
    int position;       ///< may also be given as the n-th element; 0: by name only
    unsigned flags;
} sc_field;

/// All keys of a constructor, sorted by name. Every struct filled by a list begins with
/// `uint64_t present`: bit i says that rows[i] was given.
typedef struct sc_list {
    const char *name;
    const sc_field *rows;
    int count;
} sc_list;

/// Reads the table at `table` into *out; raises on anything that the list does not allow.
void sc_read(scene *s, const sc_site *site, const sc_list *list, int table, void *out);
/// Whether a field was given: offset of the struct's member.
bool sc_given(const sc_list *list, const void *def, size_t offset);
#define SC_GIVEN(list, def, type, member) sc_given((list), (def), offsetof(type, member))
/// Marks a field as given.
void sc_give(const sc_list *list, void *def, size_t offset);
#define SC_GIVE(list, def, type, member) sc_give((list), (def), offsetof(type, member))
/// What a value on the stack is, in words: "a number", "a material".
const char *sc_type_name(scene *s, int index);
/// {x, y} at `index` into v. False if it is not two finite numbers.
bool sc_to_vec2(scene *s, int index, double v[2]);

typedef struct sc_color {
    int palette; ///< -1: none
    scene_rgba rgba;
} sc_color;

bool sc_parse_color(const char *text, sc_color *out);

// ----------------------------------------------------------------------- what constructors hold

typedef struct sc_settings {
    uint64_t present;
    char title[128];
    char description[512];
    double gravity[2];
    int y, solver;
    double dt, duration, seed, substeps, iterations;
    double contact_hertz, contact_damping, push_speed, restitution_speed, simd_width;
    bool sleep; ///< read only where it was given
    bool continuous;
} sc_settings;

typedef struct sc_material_def {
    uint64_t present;
    char name[SC_NAME_SIZE];
    double density, friction, restitution;
    double adhesion;
} sc_material_def;

typedef struct sc_material {
    sc_material_def def;
    plumb_material handle;
    bool used, collected;
    int line;
    char id[SC_NAME_SIZE]; ///< its name, or material1, material2, ...
} sc_material;

typedef enum sc_shape_kind {
    SC_CIRCLE,
    SC_CAPSULE,
    SC_BOX_SHAPE,
    SC_POLYGON,
    SC_OUTLINE,
    SC_SEGMENT,
    SC_CHAIN,
    SC_REGULAR,
    SC_SHAPE_KINDS
} sc_shape_kind;

typedef struct sc_shape_def {
    uint64_t present;
    sc_shape_kind kind;
    double w, h, r, n, length, round;
    double at[2], angle, angle_deg, density;
    bool closed;
    sc_material *material;
    int point_count;
    double (*points)[2]; ///< as written, before at and angle
} sc_shape_def;

typedef struct sc_body_def {
    uint64_t present;
    int type;
    double at[2], angle, angle_deg, velocity[2], spin;
    double mass, gravity_scale, density;
    double damping, angular_damping, max_speed, max_spin, time_scale;
    int lock; ///< bits: SC_LOCK_X, ...
    bool enabled;
    bool fixed_rotation, hidden, user, sleep, asleep, continuous;
    char name[SC_NAME_SIZE];
    char label[SC_NAME_SIZE];
    sc_color color;
    sc_material *material;
    int shape_count;
} sc_body_def;

/// A body of the scene; the world's user data of the body point here.
typedef struct sc_body {
    sc_body_def def;
    plumb_body entity;
    bool is_named;
    int line;
    int object;        ///< registry reference of its Lua object
    int user;          ///< registry reference of its user table
    plumb_rot set_rot; ///< rotation right after `def.angle` was given to the world
    sc_shape_def *shapes;
} sc_body;

typedef struct sc_camera {
    uint64_t present;
    double center[2], height, fit[4], at, trail;
    char follow[SC_NAME_SIZE];
} sc_camera;

typedef struct sc_expect_def {
    uint64_t present;
    char name[128];
    double at, from, till;
    bool always;
    char body[SC_NAME_SIZE];
    double position[2], tolerance;
    double x[2], y[2], vx[2], vy[2], angle[2], spin[2], speed[2];
    double max_speed, min_speed, max_spin, max_penetration, energy_drift, momentum_drift;
    double count[2], value[2];
    char score[SC_NAME_SIZE];
    int test;
} sc_expect_def;

typedef struct sc_expect {
    sc_expect_def def;
    int line;
    scene_expect_status status;
    bool done;
    double ratio; ///< how near to the limit: > 1 is broken
    double measured, limit, time;
    char quantity[2 * SC_NAME_SIZE];
    const char *unit;
    char description[320];
} sc_expect;

/// blast{}
typedef struct sc_blast_def {
    uint64_t present;
    double at[2], radius, falloff, impulse;
    bool per_body;
    int occlusion;
    char ignore[SC_NAME_SIZE];
} sc_blast_def;

typedef struct sc_exact_def {
    uint64_t present;
    char body[SC_NAME_SIZE];
    int x, y, angle, vx, vy, spin;
    double till;
} sc_exact_def;

typedef struct sc_contact_def {
    uint64_t present;
    char a[SC_NAME_SIZE], b[SC_NAME_SIZE];
    int function;
} sc_contact_def;

typedef enum sc_handler_kind {
    SC_AT,
    SC_EVERY,
    SC_EVERY_STEP,
    SC_ON_CONTACT,
    SC_ON_END
} sc_handler_kind;

typedef struct sc_handler {
    sc_handler_kind kind;
    double time;   ///< [s] at: when; every: the period
    uint64_t next; ///< every: number of the next call
    bool spent;    ///< at: has been called
    int line;
    sc_contact_def contact;
} sc_handler;

typedef struct sc_score {
    char name[SC_NAME_SIZE];
    double value;
} sc_score;

typedef struct sc_param {
    char name[SC_NAME_SIZE];
    char value[SC_NAME_SIZE];
    bool overridden;
} sc_param;

typedef struct sc_set {
    char key[SC_NAME_SIZE];
    char value[256];
    bool used;
} sc_set;

/// A shape that the script made: for "is never used".
typedef struct sc_made {
    sc_shape_kind kind;
    int line;
    bool used, collected;
} sc_made;

/// What a Lua shape object holds; the points follow in the same block.
typedef struct sc_shape_object {
    sc_shape_def def;
    int made;  ///< index into s->made
    int epoch; ///< valid while s->epoch is the same
} sc_shape_object;

/// Growable array of T within the budget.
#define SC_ARRAY(T)                                                                                \
    struct {                                                                                       \
        T *items;                                                                                  \
        int count, capacity;                                                                       \
    }

struct scene {
    lua_State *L;
    plumb_world *world;
    sc_budget budget;
    scene_options options;
    char path[256];
    char title[128]; ///< when scene{} gives none
    char *source;
    size_t source_size;
    bool is_json;
    scene_error error;       ///< code != SCENE_OK: the scene has failed
    const char *raising_set; ///< key of --set whose value is being read, else null

    sc_settings settings;
    bool settings_given;
    int settings_line;
    double dt, duration, start_time;
    uint64_t steps;
    bool building, finished, stop;

    sc_camera camera;
    int camera_line;
    SC_ARRAY(sc_body *) bodies;
    uint64_t body_serial;
    SC_ARRAY(sc_material *) materials;
    SC_ARRAY(sc_made) made;
    int epoch;
    SC_ARRAY(sc_handler) handlers;
    SC_ARRAY(sc_expect) expects;
    struct sc_exact_entry {
        sc_exact_def def;
        int line;
    } * exacts;
    int exact_count, exact_capacity;
    SC_ARRAY(sc_score) scores;
    SC_ARRAY(sc_param) params;
    SC_ARRAY(sc_set) sets;
    SC_ARRAY(plumb_contact_begin) begins;
    SC_ARRAY(plumb_contact_end) ends;
    double (*points)[2]; ///< last points read by a SC_POINTS field
    int point_count, point_capacity;
    char text[256];
    char shown[512];
    uint64_t random;
    bool wants_energy;
    double energy_start, energy_scale;        ///< [J] see expect.c
    double momentum_start[2], momentum_scale; ///< [kg m/s]
};

/// Makes room for one more element; raises when the budget is used up.
void sc_grow(scene *s, void *array_of_items, int count, int *capacity, size_t item_size);
#define SC_PUSH(s, array)                                                                          \
    (sc_grow((s), &(array).items, (array).count, &(array).capacity, sizeof *(array).items),        \
     &(array).items[(array).count++])

// ---------------------------------------------------------------------------------------- lists

extern const sc_list sc_list_scene, sc_list_material, sc_list_body, sc_list_camera, sc_list_expect,
    sc_list_exact, sc_list_contact, sc_list_blast;
extern const sc_list sc_list_shapes[SC_SHAPE_KINDS];

// --------------------------------------------------------------------------------------- pieces

static inline scene *sc_of(lua_State *L)
{
    return *(scene **)lua_getextraspace(L);
}

/// Bits of SC_AXES, in the order of the names "x", "y", "rotation".
enum { SC_LOCK_X = 1, SC_LOCK_Y = 2, SC_LOCK_ROTATION = 4 };
/// The bit of an axis by its name; 0: there is none.
int sc_axis_bit(const char *name);
/// Raises when what a body says of its motion does not fit its type or itself.
void sc_motion_check(scene *s, const sc_site *site, const sc_body_def *d);
/// Puts it into the world's descriptor.
void sc_motion_describe(const sc_body_def *d, plumb_body_desc *desc);
/// Whether a row of body{} is for dynamic bodies alone.
bool sc_motion_is_dynamic(const char *row);

/// Metatable names of the Lua objects.
#define SC_META_SHAPE    "plumb.shape"
#define SC_META_MATERIAL "plumb.material"
#define SC_META_BODY     "plumb.body"

lua_State *sc_sandbox_open(scene *s); ///< state with allow-listed environment; null: no memory
void sc_count_hook(lua_State *L, lua_Debug *d);          ///< the hook of sc_sandbox_open
void sc_sandbox_budget(scene *s, uint64_t instructions); ///< a fresh instruction budget
void sc_open_build(lua_State *L);    ///< scene, material, body, camera, param, ...
void sc_open_shapes(lua_State *L);   ///< box, circle, ...
void sc_open_body(lua_State *L);     ///< methods of bodies
void sc_open_motion(lua_State *L);   ///< blast
void sc_open_handlers(lua_State *L); ///< at, every, on_contact, ...
void sc_open_expect(lua_State *L);   ///< expect, exact
void sc_open_math(lua_State *L);     ///< math, random

void sc_build_settings(scene *s, const sc_site *site, int table); ///< scene{}; table 0: none
void sc_need_world(scene *s); ///< makes it with defaults if need be
void sc_build_material(scene *s, const sc_site *site, int table); ///< pushes the object
void sc_build_shape(scene *s, const sc_site *site, sc_shape_kind kind, int table); ///< pushes it
void sc_build_body(scene *s, const sc_site *site, int table);                      ///< pushes it
void sc_build_camera(scene *s, const sc_site *site, int table);
void sc_build_expect(scene *s, const sc_site *site, int table);
void sc_check_build(scene *s);               ///< after the build pass: unused things, unknown names
void sc_apply_sets(scene *s);                ///< parses scene_options.sets
bool sc_take_set(scene *s, const char *key); ///< pushes the Lua value of --set key; false: none

const char *sc_shape_kind_name(sc_shape_kind kind);
/// Checks a shape and gives it to a body of the world.
void sc_shape_create(scene *s, const sc_site *site, int index, const sc_body *body,
                     const sc_shape_def *shape);
sc_shape_object *sc_to_shape(lua_State *L, int index);
sc_material *sc_to_material(lua_State *L, int index);

sc_body *sc_body_of(const scene *s, plumb_body body); ///< null if it is none of ours or dead
sc_body *sc_body_named(const scene *s, const char *name);
void sc_body_push(scene *s, const sc_body *body);
void sc_body_release(scene *s, sc_body *body); ///< forgets it; the world's body is gone
bool sc_body_at_index(lua_State *L, int index, plumb_body *out); ///< a Lua body object?
bool sc_name_matches(const char *pattern, const char *name);     ///< "brick*" or exact
/// Raises unless the name (or pattern) fits a body that is alive.
void sc_check_body_name(scene *s, const sc_site *site, const char *key, const char *name);

void sc_handlers_before(scene *s); ///< at, every, every_step
void sc_handlers_after(scene *s);  ///< on_contact, on_end
/// Calls the function on the stack (below `args` arguments) with a fresh instruction budget.
void sc_call(scene *s, int args, int results);

void sc_expect_begin(scene *s); ///< remembers energy and momentum at the start
void sc_expect_step(scene *s);
void sc_expect_finish(scene *s);
sc_score *sc_score_find(scene *s, const char *name);

void sc_open_json(lua_State *L);
void sc_json_load(scene *s); ///< builds the scene from s->source

double sc_sin(double x);
double sc_cos(double x);
double sc_atan2(double y, double x);
double sc_exp(double x);
double sc_log(double x);
double sc_pow(double x, double y);
double sc_random(scene *s); ///< [0, 1)

#endif
