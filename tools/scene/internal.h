/// internal.h - what the files of the scene loader share. Nothing here is for users.
///
/// Reading order: scene.h, internal.h, fields.c (how a table becomes a struct), lists.c (one list a
/// constructor), build.c, shapes.c, joints.c, body_api.c, handlers.c, events.c, expect.c, scene.c,
/// sandbox.c, the rest.
#ifndef SCENE_INTERNAL_H
#define SCENE_INTERNAL_H

#include <lua.h>
#include <lauxlib.h>

#include "scene.h"

#define SC_NAME_SIZE 64      ///< [B] of a name with its final zero
#define SC_CHUNK     "scene" ///< chunk name given to Lua; errors carry the real path

// ------------------------------------------------------------------------------------- memory

/// Memory, work and time that the script, the loader and the world may use together. Work is counted in Lua
/// instructions; what C does for a script counts as many as take about the same time.
typedef struct sc_budget {
    size_t used;          ///< [B] now
    size_t limit;         ///< [B]
    uint64_t spent;       ///< work since the start of the build pass or handler call
    uint64_t spend_limit; ///< see scene_options
    uint64_t step_spent;  ///< work of all earlier handler calls of this step
    uint64_t step_limit;
    double seconds_limit; ///< [s] processor time of the build pass, or of all handlers of a step
    uint64_t since_look;  ///< work since a stop and the time were last asked for
    double looked;        ///< [s] on the monotonic clock: when processor time was last asked for
    double began;         ///< [s] processor time of this thread at the first look; < 0: none yet
    bool out_of_time;     ///< `spent` went past its limit
    bool long_string;     ///< a string longer than SC_STRING_MAX was asked for
} sc_budget;

#define SC_PROTECTED_DEPTH 2    ///< a step, and contact edits or a closed form within
#define SC_HOOK_STEP       1000 ///< instructions between two looks at the budget
#define SC_STRING_MAX      ((size_t)64 * 1024) ///< [B] longest string a script may make

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
    const char *outer;     ///< Lua: the constructor in whose table `construct` is a key; else null
} sc_site;

/// Records an error and leaves the protected call. `key` (may be null) or `index` (0: none) tell
/// which part of the construct is meant; `suggestion` may be null.
_Noreturn void sc_raise(scene *s, scene_code code, const sc_site *site, const char *key, int index,
                        const char *suggestion, const char *format, ...)
    __attribute__((format(printf, 7, 8)));
/// Raises for a call that the world has refused with that result: "what: why". `key` as for sc_raise.
_Noreturn void sc_refused(scene *s, const sc_site *site, const char *key, plumb_result result,
                          const char *what, ...) __attribute__((format(printf, 5, 6)));
/// The site of the function that the script is calling now.
sc_site sc_here(scene *s, const char *construct);
/// Room for so many more values on Lua's stack; raises when the budget is used up.
void sc_need_stack(scene *s, int slots);
/// Turns a failed lua_pcall into s->error (unless sc_raise did already) and empties the stack.
void sc_take_error(scene *s, int status);
/// Keeps what a script has looked for in vain, for the message of who uses the nil that it got.
void sc_missed_set(scene *s, const char *what, const char *name);
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
/// What is wrong with a text that is not JSON, and where; NULL: nothing that is known here.
const char *sc_json_wrong(const char *text, size_t size, const char **where);
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

/// What other engines, languages and people call our keys, and our constructors; null at the end.
typedef struct sc_synonym {
    const char *elsewhere, *here;
} sc_synonym;

extern const sc_synonym sc_synonyms[], sc_other_names[];
/// Names that Lua or other engines have and scenes do not, each with what to do instead.
extern const sc_synonym sc_absent_names[];

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
    SC_TABLE,    ///< bool: a table is there
    SC_LIMITS,   ///< double[2], from {lower, upper}
    SC_NAMES,    ///< uint64_t: categories, from a name or a list of names
    SC_END,      ///< sc_end: a body, its name, or world; where a gear goes, a joint
    SC_JOINT,    ///< char[SC_NAME_SIZE]: from the name of a joint, or a joint
    SC_RECORD,   ///< a struct, from a table with the list that `detail` names
    SC_NUMBERS   ///< double[size / sizeof(double)], from so many numbers
} sc_kind;

enum {
    SC_REQUIRED = 1, ///< must be given
    SC_ABOVE = 2,    ///< `min` itself is not allowed
    SC_MENTION = 4,  ///< naming a material here is not using it
    SC_REST = -1     ///< as `position`: takes the whole array part
};

/// One key of a constructor. The lists in lists.c are the single source of names, ranges and units.
typedef struct sc_field {
    const char *name;
    sc_kind kind;
    size_t offset;
    size_t size; ///< SC_STRING: bytes
    double min, max;
    const char *detail; ///< unit, or choices, or name of a list
    int position;       ///< may also be given as the n-th element; 0: by name only
    unsigned flags;
} sc_field;

#define SC_ROWS_MOST 128 ///< keys of a constructor: bits of `present`

/// All keys of a constructor. Every struct filled by a list begins with
/// `uint64_t present`: bit i says that rows[i] was given. Of lists of more than 64 rows with two of them.
typedef struct sc_list {
    const char *name;
    const sc_field *rows;
    int count;
} sc_list;

/// What a reader of one value needs to know to complain.
typedef struct sc_context {
    scene *s;
    const sc_site *site;
    const sc_field *row;
    int index; ///< element of the construct when given by position, else 0
} sc_context;

_Noreturn void sc_fail_type(const sc_context *c, const char *expected, int value);
void sc_read_string(const sc_context *c, int value, char *out, size_t size);
/// Readers of what refers to something else (refs.c, filters.c).
void sc_read_body(const sc_context *c, int value, char out[SC_NAME_SIZE]);
void sc_read_joint(const sc_context *c, int value, char out[SC_NAME_SIZE]);
struct sc_end;
void sc_read_end(const sc_context *c, int value, struct sc_end *out);
uint64_t sc_read_names(const sc_context *c, int value);

/// Reads the table at `table` into *out; raises on anything that the list does not allow.
void sc_read(scene *s, const sc_site *site, const sc_list *list, int table, void *out);
/// Whether rows[row] was given; marks it as given or not.
bool sc_row_given(const sc_list *list, const void *def, int row);
void sc_row_mark(const sc_list *list, void *def, int row, bool given);
/// The row of the struct's member at an offset; -1: of none.
int sc_row_of(const sc_list *list, size_t offset);
/// Whether a field was given: offset of the struct's member. Looks for its row; who asks of many looks once.
bool sc_given(const sc_list *list, const void *def, size_t offset);
#define SC_GIVEN(list, def, type, member) sc_given((list), (def), offsetof(type, member))
/// Marks a field as given.
void sc_give(const sc_list *list, void *def, size_t offset);
#define SC_GIVE(list, def, type, member) sc_give((list), (def), offsetof(type, member))
/// Marks a field as given or not.
void sc_mark(const sc_list *list, void *def, size_t offset, bool given);
#define SC_MARK(list, def, type, member, given)                                                    \
    sc_mark((list), (def), offsetof(type, member), (given))
/// What a value on the stack is, in words: "a number", "a material".
const char *sc_type_name(scene *s, int index);
/// {x, y} at `index` into v. False if it is not two finite numbers.
bool sc_to_vec2(scene *s, int index, double v[2]);

typedef struct sc_color {
    int palette; ///< -1: none
    scene_rgba rgba;
} sc_color;

bool sc_parse_color(const char *text, sc_color *out);

#include "rows.h"

#include "defs.h"

// ------------------------------------------------------------------------------------ the scene

/// Growable array of T within the budget.
#define SC_ARRAY(T)                                                                                \
    struct {                                                                                       \
        T *items;                                                                                  \
        int count, capacity;                                                                       \
    }

/// find() or find_joint() that found nothing; `what` is NULL: none has yet.
typedef struct sc_missed {
    const char *what; ///< "find", "find_joint"
    char name[SC_NAME_SIZE];
    int line;
} sc_missed;

struct scene {
    lua_State *L; ///< the thread that runs; outside sc_protect, the main one
    lua_State *threads[SC_PROTECTED_DEPTH]; ///< what sc_protect runs in
    int protected_depth;                    ///< of these, in use
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
    sc_missed missed;        ///< what a script last looked for in vain

    sc_settings settings;
    bool settings_given;
    int settings_line;
    double dt, duration, start_time;
    uint64_t steps;
    int split; ///< steps of the world in one of the scene
    bool building, finished, stop;

    sc_liquid_def liquid; ///< present: it was made
    int liquid_line;
    sc_phase_def phases[PLUMB_LIQUID_MAX_PHASES]; ///< those behind the first
    int phase_count;
    sc_air_def air; ///< present: it was made
    int air_line;
    SC_ARRAY(sc_source) sources;
    SC_ARRAY(sc_waves) waves;
    SC_ARRAY(sc_light) lights;
    int light_number;  ///< of the last that was made
    int source_number; ///< of the last that was made
    SC_ARRAY(sc_softbody) softbodies;
    SC_ARRAY(sc_law) laws;
    sc_orbits_def orbits; ///< present: it was said
    sc_camera camera;
    int camera_line;
    SC_ARRAY(sc_body *) bodies;
    uint64_t body_serial;
    SC_ARRAY(sc_joint *) joints;
    uint64_t joint_serial;
    SC_ARRAY(sc_name) broken; ///< names of joints that broke, oldest first
    int broken_before;        ///< how many of them before the last step
    SC_ARRAY(sc_category) categories;
    SC_ARRAY(sc_name) groups; ///< of apart and together; group numbers count from 1
    SC_ARRAY(sc_pair_def) pairs;
    SC_ARRAY(sc_excluded) excluded;
    SC_ARRAY(sc_material *) materials;
    SC_ARRAY(sc_made) made;
    int epoch;
    uint64_t list_number; ///< of the last list of bodies, each once, that was made for a script
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
    SC_ARRAY(plumb_contact_hit) hits;
    SC_ARRAY(plumb_sensor_event) enters;
    SC_ARRAY(plumb_sensor_event) leaves;
    SC_ARRAY(plumb_liquid_contact) wet;
    SC_ARRAY(plumb_liquid_end) dry;
    SC_ARRAY(sc_shattered) shatters;
    SC_ARRAY(sc_gone) gone;
    SC_ARRAY(plumb_joint_break) breaks;
    SC_ARRAY(plumb_joint_strain) strains;
    SC_ARRAY(sc_name) strained; ///< name of the joint of each strain
    SC_ARRAY(plumb_contact_end)
    unheard;             ///< began with a body that was gone before a handler was called
    bool departed, told; ///< bodies were destroyed since the last step; before it (body_record.c)
    bool edits;          ///< the system of edit_contact is there
    bool fields;         ///< the system of field{} is there
    bool edit_failed;    ///< a handler within the step raised; s->error has it
    bool wants_visits;
    double (*points)[2]; ///< last points read by a SC_POINTS field
    int point_count, point_capacity;
    char text[256];
    char shown[512];
    uint64_t random;
    bool wants_energy;
    int alarms[PLUMB_ALARM_KINDS];            ///< so far
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
    sc_list_exact, sc_list_contact, sc_list_field, sc_list_hit, sc_list_break, sc_list_pair,
    sc_list_filter, sc_list_motor, sc_list_spring, sc_list_state, sc_list_blast, sc_list_character,
    sc_list_liquid, sc_list_phase, sc_list_air, sc_list_source, sc_list_orbits, sc_list_waves,
    sc_list_light;
extern const sc_list sc_list_laws[SC_LAW_KINDS];
extern const sc_list sc_list_softbodies[SC_SOFTBODY_KINDS];
extern const sc_list sc_list_queries[SC_QUERIES];
extern const sc_list sc_list_shapes[SC_SHAPE_KINDS];

#define SC_COUNT_JOINT(NAME, name, text) +1
enum { SC_JOINT_KINDS = 0 PLUMB_JOINT_LIST(SC_COUNT_JOINT) };
#undef SC_COUNT_JOINT
extern const sc_list sc_list_joints[SC_JOINT_KINDS]; ///< by plumb_joint_kind
/// A list of which a key may be meant; null past the end.
const sc_list *sc_list_at(int i);
/// The list of a SC_RECORD.
const sc_list *sc_list_named(const char *name);

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

/// Makes a body a character, as its definition says.
void sc_character_make(scene *s, const sc_site *site, const sc_body *b);
extern const luaL_Reg sc_character_methods[]; ///< of bodies
plumb_one_way sc_one_way_of(const sc_body_def *d);
void sc_one_way_check(scene *s, const sc_site *site, const sc_body_def *d);
/// The outline of the shape whose object is on top of the stack, in its own frame, up to 256 points; raises when it
/// encloses nothing.
int sc_shape_outline(scene *s, const sc_site *site, plumb_vec2 points[256]);
/// The convex shape whose object is on top of the stack, in its own frame; raises when it is none.
void sc_shape_convex(scene *s, const sc_site *site, plumb_convex *convex);

/// Metatable names of the Lua objects.
#define SC_META_SHAPE    "plumb.shape"
#define SC_META_MATERIAL "plumb.material"
#define SC_META_BODY     "plumb.body"
#define SC_META_JOINT    "plumb.joint"
#define SC_META_WORLD    "plumb.world"
#define SC_META_SOFTBODY "plumb.softbody"

lua_State *sc_sandbox_open(scene *s); ///< state with allow-listed environment; null: no memory
typedef void sc_protected_fn(scene *s, void *argument);
/// Runs `run` where an error ends, on an empty stack with room for 100. True when it came to its end; else the
/// error stands in the scene, of which no script runs any more.
bool sc_protect(scene *s, sc_protected_fn *run, void *argument);
void sc_count_hook(lua_State *L, lua_Debug *d); ///< the hook of sc_sandbox_open
/// Begins the build pass, or what follows or precedes a step: `instructions` a call, `most` in all.
void sc_budget_begin(scene *s, uint64_t instructions, uint64_t most, double seconds);
void sc_budget_call(scene *s);    ///< begins a handler call
void sc_begin_handlers(scene *s); ///< begins those of a step, of the end or of a closed form
/// Counts what C has done or is about to do for the script. Raises when the limit is reached, or the caller
/// asks to stop.
void sc_work(scene *s, uint64_t work);
/// The same for what is done on the way to handlers: it counts for the step, and for no call.
void sc_step_work(scene *s, uint64_t work);
/// In water{} and wind{} keys of materials may have been meant, too, and `flow`.
void sc_offer_fluid_keys(const sc_site *site, sc_suggest *g);
/// Counts a question to the world: what it costs at least, and a share for every shape it may look at.
void sc_query_work(scene *s);
void sc_open_build(lua_State *L);      ///< scene, material, body, camera, param, ...
void sc_open_materials(lua_State *L);  ///< material, material_pair
void sc_open_fluids(lua_State *L);     ///< water, wind, fluid_at
void sc_open_shapes(lua_State *L);     ///< box, circle, ...
void sc_open_body(lua_State *L);       ///< methods of bodies
void sc_open_motion(lua_State *L);     ///< blast
void sc_open_laws(lua_State *L);       ///< attractor, zone, magnetic, mutual, formula, orbits
void sc_open_liquid(lua_State *L);     ///< liquid, liquid_in, liquid_drain, liquid_change
void sc_open_wet(lua_State *L);        ///< liquid_at, liquid_ray
void sc_open_softbody(lua_State *L);   ///< rope, cloth, jelly, balloon, softbody
void sc_open_air(lua_State *L);        ///< air, air_source, air_fill, air_at, air_sum
void sc_open_waves(lua_State *L);      ///< waves, wave_at
void sc_open_heat(lua_State *L);       ///< heat
void sc_open_light(lua_State *L);      ///< light, light_on, light_path
void sc_open_characters(lua_State *L); ///< character
void sc_open_queries(lua_State *L);    ///< ray, cast, nearest, inside
void sc_open_joints(lua_State *L);     ///< revolute, wheel, ..., exclude, world
void sc_open_joint(lua_State *L);      ///< methods of joints
void sc_open_handlers(lua_State *L);   ///< at, every, score, ...
void sc_open_events(lua_State *L);     ///< on_contact, on_break, ...
void sc_open_told(lua_State *L);       ///< tables of facts
void sc_open_expect(lua_State *L);     ///< expect, exact
void sc_open_field(lua_State *L);      ///< field
void sc_open_math(lua_State *L);       ///< math, random

/// Copies the functions of a library that count their work (library.c) from the table below into the one on top.
void sc_copy_counted(lua_State *L, const char *library);
/// Makes the arithmetic of strings, in the metatable on top, count its work.
void sc_count_arithmetic(lua_State *L);

typedef void sc_constructor(scene *s, const sc_site *site, int table);
/// What a constructor does that takes one table and leaves `results` values.
int sc_construct(lua_State *L, const char *name, sc_constructor *build, int results);

void sc_build_settings(scene *s, const sc_site *site, int table); ///< scene{}; table 0: none
void sc_need_world(scene *s); ///< makes it with defaults if need be
void sc_build_material(scene *s, const sc_site *site, int table); ///< pushes the object
void sc_build_shape(scene *s, const sc_site *site, sc_shape_kind kind, int table); ///< pushes it
/// A joint's definition as the world has it now, for writing down.
sc_joint_def sc_joint_now(const scene *s, const sc_joint *joint);
void sc_build_body(scene *s, const sc_site *site, int table);                         ///< pushes it
void sc_build_joint(scene *s, const sc_site *site, plumb_joint_kind kind, int table); ///< pushes it
void sc_build_pair(scene *s, const sc_site *site, int table);
void sc_build_law(scene *s, const sc_site *site, sc_law_kind kind, int table); ///< pushes it
void sc_build_orbits(scene *s, const sc_site *site, int table);
void sc_build_liquid(scene *s, const sc_site *site, int table);
void sc_build_air(scene *s, const sc_site *site, int table);
void sc_build_waves(scene *s, const sc_site *site, int table);
void sc_build_light(scene *s, const sc_site *site, int table); ///< pushes it
void sc_build_softbody(scene *s, const sc_site *site, sc_softbody_kind kind,
                       int table);                              ///< pushes it
void sc_build_source(scene *s, const sc_site *site, int table); ///< pushes it
void sc_build_camera(scene *s, const sc_site *site, int table);
/// A node that counts from 1, of so many, as one that counts from 0.
uint32_t sc_node_index(scene *s, const sc_site *site, const char *key, double number, int of);
void sc_open_softbody_methods(lua_State *L);
void sc_build_expect(scene *s, const sc_site *site, int table);
void sc_build_exact(scene *s, const sc_site *site, int table);
void sc_check_build(scene *s); ///< after the build pass: unused things, unknown names
void sc_apply_sets(scene *s);  ///< parses scene_options.sets
/// Key `accuracy` of the table of scene{}, and --set accuracy, become `tolerance` and `substeps` in it.
void sc_take_accuracy(scene *s, const sc_site *site, int merged);
bool sc_take_set(scene *s, const char *key); ///< pushes the Lua value of --set key; false: none

const char *sc_shape_kind_name(sc_shape_kind kind);
/// Checks a shape and gives it to a body of the world.
void sc_shape_create(scene *s, const sc_site *site, int index, const sc_body *body,
                     const sc_shape_def *shape);
sc_shape_object *sc_to_shape(lua_State *L, int index);
sc_material *sc_to_material(lua_State *L, int index);

/// What has records (records.c): bodies, joints.
typedef struct sc_record_kind {
    const char *meta;  ///< metatable of its Lua objects, which hold the handle
    const char *names; ///< table of its records by name, in the registry
    plumb_entity_kind kind;
    void *(*user_data)(const plumb_world *world, plumb_entity entity);
} sc_record_kind;
extern const sc_record_kind sc_bodies, sc_joints;

void sc_records_open(lua_State *L, const sc_record_kind *kind); ///< no names yet
void *sc_record_of(const scene *s, const sc_record_kind *kind, plumb_entity entity);
void *sc_record_named(const scene *s, const sc_record_kind *kind, const char *name);
/// Gives a record its name; null: takes it away.
void sc_record_name(scene *s, const sc_record_kind *kind, const char *name, void *record);
bool sc_handle_at(lua_State *L, int index, const sc_record_kind *kind, plumb_entity *out);

/// Null if it is none of ours or dead.
static inline sc_body *sc_body_of(const scene *s, plumb_body body)
{
    return sc_record_of(s, &sc_bodies, body.entity);
}
static inline sc_joint *sc_joint_of(const scene *s, plumb_joint joint)
{
    return sc_record_of(s, &sc_joints, joint.entity);
}
/// Null if there is none.
static inline sc_body *sc_body_named(const scene *s, const char *name)
{
    return sc_record_named(s, &sc_bodies, name);
}
static inline sc_joint *sc_joint_named(const scene *s, const char *name)
{
    return sc_record_named(s, &sc_joints, name);
}
/// A Lua object of that kind?
static inline bool sc_body_at_index(lua_State *L, int index, plumb_body *out)
{
    return sc_handle_at(L, index, &sc_bodies, &out->entity);
}
static inline bool sc_joint_at_index(lua_State *L, int index, plumb_joint *out)
{
    return sc_handle_at(L, index, &sc_joints, &out->entity);
}

/// Values of methods: 2 numbers, 1.
int sc_push_vector(lua_State *L, plumb_vec2 v);
int sc_push_real(lua_State *L, plumb_real v);

bool sc_is_world(lua_State *L, int index);
void sc_joint_push(scene *s, plumb_joint joint);
void sc_joint_release(scene *s, sc_joint *joint); ///< forgets it; the world's joint is gone
/// Raises unless the name (or pattern) is that of a joint that is there.
void sc_check_joint_name(scene *s, const sc_site *site, const char *key, const char *name);
/// Two bodies that never meet, or do again. Codes as of plumb_world_exclude_pair.
plumb_result sc_exclude(scene *s, plumb_body a, plumb_body b, bool exclude);

/// Which words of a filter were said.
typedef struct sc_filter_given {
    bool category, collides, ignores, apart, together;
} sc_filter_given;

#define SC_FILTER_GIVEN(list, def, type)                                                           \
    ((sc_filter_given){                                                                            \
        SC_GIVEN(list, def, type, filter.category), SC_GIVEN(list, def, type, filter.collides),    \
        SC_GIVEN(list, def, type, filter.ignores), SC_GIVEN(list, def, type, filter.apart),        \
        SC_GIVEN(list, def, type, filter.together) })

/// What a shape's own words and, where it says nothing, its body's make.
plumb_filter sc_filter_resolve(scene *s, const sc_filter *own, sc_filter_given g,
                               const sc_filter *body, sc_filter_given b);
/// Raises when words exclude each other.
void sc_filter_check(scene *s, const sc_site *site, const sc_filter_given *g);
void sc_check_categories(scene *s); ///< after the build pass: masks that name what nothing is
bool sc_shape_is_sensor(const sc_body *body, const sc_shape_def *shape);
/// Writes into the records of a body and its shapes what all its shapes now have.
void sc_filter_record(sc_body *body, const sc_filter *filter, sc_filter_given g);
/// Pushes a list of the bodies that overlap a body's sensors; returns how many.
int sc_body_overlaps(scene *s, plumb_body body);
void sc_excluded_forget(scene *s, plumb_body body);
void sc_open_filters(lua_State *L); ///< exclude

void sc_body_push(scene *s, const sc_body *body);
/// What the Lua object of a body keeps when the body is gone: its user values.
enum { SC_BODY_NAME = 1, SC_BODY_USER, SC_BODY_KEEPSAKES = SC_BODY_USER };
/// The body is about to be destroyed: its object keeps the name and the user table.
void sc_body_depart(scene *s, const sc_body *body);
/// A step has been taken: the ends that it tells of are those of bodies that departed before, and none earlier.
void sc_departed_turn(scene *s);
/// Pushes the object of a body that is there, or whose end may be told now. False, and pushes nothing: it is neither.
bool sc_body_recall(scene *s, plumb_body body, char name[SC_NAME_SIZE]);
void sc_body_release(scene *s, sc_body *body); ///< forgets it; the world's body is gone
bool sc_name_matches(const char *pattern, const char *name); ///< "brick*" or exact
/// Raises unless the name (or pattern) fits a body that is alive.
void sc_check_body_name(scene *s, const sc_site *site, const char *key, const char *name);

/// What a method of a body needs: filled by sc_body_self.
typedef struct sc_body_call {
    scene *s;
    plumb_world *world;
    sc_body *body;
    plumb_body entity;
    const char *method;
} sc_body_call;

/// Whose method is called, argument 1. Raises unless it is a body that is there.
sc_body_call sc_body_self(lua_State *L, const char *method);
/// A finite number at `index`.
double sc_finite_number(lua_State *L, int index);
/// Two finite numbers, or a table {x, y}, at *index, which moves on.
plumb_vec2 sc_vector(lua_State *L, int *index);
/// Raises when the world has refused the call. Always 0, for methods that return nothing.
int sc_body_check(const sc_body_call *c, plumb_result result);
extern const char *const sc_body_types[];    ///< in the order of plumb_body_type, then null
extern const luaL_Reg sc_body_acts[];        ///< body_act.c
extern const luaL_Reg sc_fracture_methods[]; ///< fracture.c
/// Bodies that broke in the step: their parts become bodies of the scene; handlers hear of it.
void sc_shatters_take(scene *s);
void sc_shatters_tell(scene *s);
/// The record of a body whose shapes are others now (fracture.c).
void sc_body_refit(scene *s, sc_body *body);
/// Those that changed in the step, and those that are gone: records follow; handlers hear of it.
void sc_gone_take(scene *s);
void sc_gone_tell(scene *s);
/// Whom the liquid touches now, and touches no more; told to on_wet and on_dry.
void sc_wet_take(scene *s);
void sc_wet_tell(scene *s);
/// A fresh record with its name (one is made up where it has none) in the scene's lists.
sc_body *sc_body_add(scene *s, const sc_body_def *def);

const char *sc_handler_name(sc_handler_kind kind);
bool sc_handler_any(const scene *s, sc_handler_kind kind);
const char *sc_liquid_phase_name(const scene *s, int phase); ///< from 0
sc_handler *sc_handler_add(scene *s, sc_handler_kind kind, const sc_site *site);
void sc_handlers_before(scene *s); ///< at, every, every_step
void sc_events_after(scene *s);    ///< on_contact and all others that follow a step
/// Whether the handler wants bodies of these names; *swapped when its `a` fits the second. Sensor events are never
/// swapped: `a` is the sensor.
bool sc_handler_wants(const sc_handler *h, const char *a, const char *b, bool *swapped);
/// Makes the system of edit_contact, once (edits.c).
void sc_open_edits(scene *s, const sc_site *site);
/// A number in the table on top.
void sc_push_field(lua_State *L, const char *name, plumb_real v);
/// What a table of facts is about (told.c).
typedef enum sc_told {
    SC_TOLD_CONTACT,
    SC_TOLD_EDIT,
    SC_TOLD_JOINT,
    SC_TOLD_SHATTER,
    SC_TOLD_GONE,
    SC_TOLD_WET,
    SC_TOLD_HEAT,
    SC_TOLD_RAY
} sc_told;
/// A new table that refuses fields which facts of that kind do not have.
void sc_push_told(lua_State *L, sc_told kind);
/// Calls the function on the stack (below `args` arguments) with a fresh instruction budget.
void sc_call(scene *s, int args, int results);

/// Measured criteria: each is held against its limit, the line keeps the worst (expect_measure.c).
void sc_measure(scene *s, sc_expect *e);
/// What came of it, as a line.
const char *sc_expect_describe(sc_expect *e);
void sc_expect_begin(scene *s); ///< remembers energy and momentum at the start
void sc_expect_step(scene *s);
void sc_expect_finish(scene *s);
int sc_exact_find(const scene *s, const char *name); ///< index, -1: there is none
bool sc_exact_holds(scene *s, int i);                ///< whether form i says something of now
/// How far the world is from form i now, in its unit. Raises.
double sc_exact_error(scene *s, int i);
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
