// scene.c - the life of a scene: load, step, finish, destroy, and what users may ask.
// Everything that may raise runs inside sc_protect: an error or an exhausted limit ends there, is
// kept in s->error, and the scene stays failed.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

#define DEFAULT_MEMORY  ((size_t)256 << 20)  // [B]
#define DEFAULT_BUILD   UINT64_C(1000000000) // instructions: some seconds
#define DEFAULT_HANDLER UINT64_C(10000000)   // instructions: some hundredths of a second
#define HANDLERS_A_STEP 10                   // so many times as much for all handlers of a step
#define BUILD_SECONDS   60.0                 // [s] ten times what the instructions take, and more
#define HANDLER_SECONDS 10.0                 // [s]
#define LARGEST_FILE    ((long)64 << 20)     // [B]

// --------------------------------------------------------------------------------------- loading

static void refuse_powers(scene *s)
{
    int line;
    int column;
    if (sc_lua_find_power(s->source, s->source_size, &line, &column)) {
        sc_set_error(
            s, SCENE_E_SYNTAX, line, column, "math.pow(x, y)",
            "only x^2 is offered: other powers differ in the last place from machine to machine");
        lua_pushlightuserdata(s->L, s);
        lua_error(s->L);
    }
}

static void load_lua(scene *s, void *unused)
{
    (void)unused;
    sc_apply_sets(s);
    int status = luaL_loadbufferx(s->L, s->source, s->source_size, "=" SC_CHUNK, "t");
    if (status != LUA_OK) {
        sc_take_error(s, status);
        lua_pushlightuserdata(s->L, s);
        lua_error(s->L);
    }
    refuse_powers(s);
    lua_call(s->L, 0, 0);
    lua_settop(s->L, 0);
    sc_check_build(s);
    sc_expect_begin(s);
}

static void load_json(scene *s, void *unused)
{
    (void)unused;
    sc_apply_sets(s);
    sc_json_load(s);
    lua_settop(s->L, 0);
    sc_check_build(s);
    sc_expect_begin(s);
}

// What plumb_recorder_start writes begins so: the name is easily given to the wrong command.
static bool is_recording(const scene *s)
{
    static const char magic[] = "PLUMBREC";
    return s->source_size >= sizeof magic - 1 && memcmp(s->source, magic, sizeof magic - 1) == 0;
}

static bool read_file(scene *s, const char *path)
{
    errno = 0;
    FILE *file = fopen(path, "rb");
    long size = -1;
    int reason = errno;
    errno = 0;
    // A folder opens like a file and only cannot be read.
    bool is_folder = file != NULL && fgetc(file) == EOF && errno == EISDIR;
    if (file != NULL && !is_folder && fseek(file, 0, SEEK_END) == 0) {
        size = ftell(file);
    }
    bool good = size >= 0 && size <= LARGEST_FILE && fseek(file, 0, SEEK_SET) == 0;
    if (good) {
        s->source = malloc((size_t)size + 1);
        good = s->source != NULL && fread(s->source, 1, (size_t)size, file) == (size_t)size;
        s->source_size = (size_t)size;
    }
    if (file != NULL) {
        fclose(file);
    }
    char text[160];
    const char *wrong = is_folder             ? "is a folder, not a scene"
                        : size > LARGEST_FILE ? "is larger than 64 MiB"
                        : !good               ? "cannot be read"
                        : is_recording(s) ? "is a recording, not a scene; 'plumb replay' plays it"
                                          : NULL;
    if (file == NULL) {
        snprintf(text, sizeof text, "cannot be opened: %s", strerror(reason));
        wrong = text;
    }
    if (wrong != NULL) {
        bool readable = good && is_recording(s);
        sc_set_error(s, readable ? SCENE_E_SYNTAX : SCENE_E_IO, 0, 0, NULL, wrong);
    }
    return wrong == NULL;
}

static bool take_source(scene *s)
{
    const scene_options *o = &s->options;
    if (o->text == NULL) {
        return read_file(s, o->path);
    }
    s->source = malloc(o->text_size + 1);
    if (s->source == NULL) {
        sc_set_error(s, SCENE_E_LIMIT, 0, 0, NULL, "no memory for the source");
        return false;
    }
    memcpy(s->source, o->text, o->text_size);
    s->source_size = o->text_size;
    return true;
}

static void take_options(scene *s, const scene_options *opts)
{
    s->options = *opts;
    scene_options *o = &s->options;
    o->memory_limit = o->memory_limit != 0 ? o->memory_limit : DEFAULT_MEMORY;
    o->build_instructions = o->build_instructions != 0 ? o->build_instructions : DEFAULT_BUILD;
    o->handler_instructions =
        o->handler_instructions != 0 ? o->handler_instructions : DEFAULT_HANDLER;
    o->build_seconds = o->build_seconds > 0 ? o->build_seconds : BUILD_SECONDS;
    o->handler_seconds = o->handler_seconds > 0 ? o->handler_seconds : HANDLER_SECONDS;
    s->budget.limit = o->memory_limit;
    sc_budget_begin(s, UINT64_MAX / 4, UINT64_MAX / 2, o->build_seconds);
    snprintf(s->path, sizeof s->path, "%s", o->path != NULL ? o->path : "scene");
    size_t length = strlen(s->path);
    s->is_json = length >= 5 && strcmp(s->path + length - 5, ".json") == 0;
    s->dt = 1.0 / 60;
    s->duration = 10;
    s->split = 1;
}

// The title when the author gave none: the file's name without folder and ending.
static void name_scene(scene *s)
{
    const char *slash = strrchr(s->path, '/');
    const char *base = slash != NULL ? slash + 1 : s->path;
    const char *dot = strrchr(base, '.');
    int length = dot != NULL && dot != base ? (int)(dot - base) : (int)strlen(base);
    snprintf(s->title, sizeof s->title, "%.*s", length, base);
}

scene_code scene_load(const scene_options *opts, scene **out, scene_error *err)
{
    scene_error ignored;
    err = err != NULL ? err : &ignored;
    *err = (scene_error){ 0 };
    if (out != NULL) {
        *out = NULL;
    }
    scene *s = calloc(1, sizeof *s);
    if (s == NULL || out == NULL || opts == NULL || (opts->path == NULL && opts->text == NULL)) {
        free(s);
        err->code = SCENE_E_ARGUMENT;
        snprintf(err->message, sizeof err->message,
                 "scene_load needs options with a path or a text");
        snprintf(err->text, sizeof err->text, "%s", err->message);
        return err->code;
    }
    take_options(s, opts);
    bool good = take_source(s);
    if (good && sc_sandbox_open(s) == NULL) {
        sc_set_error(s, SCENE_E_LIMIT, 0, 0, NULL,
                     "the memory limit leaves no room for the script");
        good = false;
    }
    if (good) {
        s->building = true;
        sc_budget_begin(s, s->options.build_instructions, UINT64_MAX / 2, s->options.build_seconds);
        good = sc_protect(s, s->is_json ? load_json : load_lua, NULL);
        s->building = false;
    }
    if (!good) {
        *err = s->error;
        scene_destroy(s);
        return err->code;
    }
    name_scene(s);
    s->options.path = s->path; // the caller's strings need not outlive the call
    s->options.text = NULL;
    s->options.sets = NULL;
    *out = s;
    return SCENE_OK;
}

void scene_destroy(scene *s)
{
    if (s == NULL) {
        return;
    }
    if (s->L != NULL) {
        lua_close(s->L);
    }
    plumb_world_destroy(s->world);
    for (int i = 0; i < s->bodies.count; i++) {
        sc_body *b = s->bodies.items[i];
        for (int k = 0; k < b->def.shape_count; k++) {
            free(b->shapes[k].points);
        }
        free(b->shapes);
        free(b);
    }
    for (int i = 0; i < s->joints.count; i++) {
        free(s->joints.items[i]);
    }
    for (int i = 0; i < s->materials.count; i++) {
        free(s->materials.items[i]);
    }
    void *const blocks[] = {
        s->bodies.items,   s->materials.items,  s->made.items,     s->handlers.items,
        s->expects.items,  s->exacts,           s->scores.items,   s->params.items,
        s->sets.items,     s->begins.items,     s->ends.items,     s->wet.items,
        s->dry.items,      s->points,           s->source,         s->joints.items,
        s->broken.items,   s->categories.items, s->groups.items,   s->pairs.items,
        s->excluded.items, s->hits.items,       s->enters.items,   s->leaves.items,
        s->breaks.items,   s->strains.items,    s->strained.items, s->laws.items,
        s->unheard.items,  s->shatters.items,   s->sources.items,  s->softbodies.items,
        s->waves.items,    s->gone.items,       s->lights.items
    };
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        free(blocks[i]);
    }
    free(s);
}

// ---------------------------------------------------------------------------------------- running

// What a step, an end or a closed form asks of scripts has a budget of its own.
void sc_begin_handlers(scene *s)
{
    uint64_t most = s->options.handler_instructions;
    sc_budget_begin(s, most, most < UINT64_MAX / 100 ? HANDLERS_A_STEP * most : UINT64_MAX / 2,
                    s->options.handler_seconds);
}

// A step of the scene is one of the world, or as many shorter ones as split_step() has said.
static void step_inside(scene *s, void *unused)
{
    (void)unused;
    sc_begin_handlers(s);
    sc_handlers_before(s);
    for (int left = s->split, count = left; left > 0; left--) {
        plumb_result result = PLUMB_OK;
        if (s->options.step != NULL) {
            s->options.step(s->options.step_context, s->world, s->dt / count);
        } else {
            result = plumb_world_step(s->world, (plumb_real)(s->dt / count));
        }
        if (s->edit_failed) { // s->error says why
            lua_pushlightuserdata(s->L, s);
            lua_error(s->L);
        }
        if (result != PLUMB_OK) {
            sc_refused(s, NULL, NULL, result, "step %llu failed", (unsigned long long)s->steps + 1);
        }
        s->steps += left == 1;
        sc_events_after(s);
        if (count > 1) {
            sc_step_work(s,
                         (uint64_t)s->bodies.count + 10); // the limits hold between the parts, too
        }
    }
    sc_expect_step(s);
}

static scene_code answer(const scene *s, scene_error *err)
{
    if (err != NULL) {
        *err = s->error;
    }
    return s->error.code;
}

scene_code scene_step(scene *s, scene_error *err)
{
    if (s->error.code == SCENE_OK) {
        sc_protect(s, step_inside, NULL);
    }
    return answer(s, err);
}

static void finish_inside(scene *s, void *unused)
{
    (void)unused;
    sc_begin_handlers(s);
    sc_expect_finish(s);
}

scene_code scene_finish(scene *s, scene_error *err)
{
    if (s->error.code == SCENE_OK && !s->finished) {
        s->finished = sc_protect(s, finish_inside, NULL);
    }
    return answer(s, err);
}

unsigned scene_activity(const scene *s)
{
    unsigned bits = s->split > 1 ? SCENE_ACTS : 0;
    for (int i = 0; i < s->handlers.count; i++) {
        sc_handler_kind kind = s->handlers.items[i].kind;
        bits |= kind == SC_FIELD        ? SCENE_FIELDS
                : kind <= SC_EVERY_STEP ? SCENE_ACTS
                                        : SCENE_LISTENS;
    }
    return bits;
}

double scene_time(const scene *s)
{
    return s->start_time + (double)s->steps * s->dt;
}

bool scene_done(const scene *s)
{
    return s->stop || s->error.code != SCENE_OK ||
           (double)s->steps * s->dt >= s->duration - 0.5 * s->dt;
}

plumb_world *scene_world(const scene *s)
{
    return s->world;
}

// ----------------------------------------------------------------------------------------- asking

scene_info scene_get_info(const scene *s)
{
    plumb_world_desc d = plumb_world_settings(s->world);
    return (scene_info){
        .title = s->settings.title[0] != 0 ? s->settings.title : s->title,
        .description = s->settings.description,
        .dt = s->dt,
        .duration = s->duration,
        .y_axis = d.y_axis,
        .solver = d.solver,
        .substeps = d.substeps,
        .iterations = d.iterations,
        .seed = (uint64_t)s->settings.seed,
    };
}

int scene_body_count(const scene *s)
{
    return s->bodies.count;
}

static scene_body show_body(const sc_body *b)
{
    if (b == NULL) {
        return (scene_body){ .name = "", .label = "", .palette = -1 };
    }
    return (scene_body){ .entity = b->entity,
                         .name = b->def.name,
                         .is_named = b->is_named,
                         .angle = b->def.angle,
                         .label = b->def.label,
                         .palette = b->def.color.palette,
                         .color = b->def.color.rgba,
                         .hidden = b->def.hidden || !b->def.enabled };
}

scene_body scene_body_get(const scene *s, int i)
{
    return show_body(i >= 0 && i < s->bodies.count ? s->bodies.items[i] : NULL);
}

scene_body scene_body_find(const scene *s, const char *name)
{
    for (int i = 0; i < s->bodies.count; i++) { // not through Lua: asking must not need memory
        if (strcmp(s->bodies.items[i]->def.name, name) == 0) {
            return show_body(s->bodies.items[i]);
        }
    }
    return show_body(NULL);
}

scene_body scene_body_of(const scene *s, plumb_body body)
{
    return show_body(sc_body_of(s, body));
}

int scene_joint_count(const scene *s)
{
    return s->joints.count;
}

scene_joint scene_joint_get(const scene *s, int i)
{
    if (i < 0 || i >= s->joints.count) {
        return (scene_joint){ .name = "" };
    }
    const sc_joint *j = s->joints.items[i];
    return (scene_joint){
        .entity = j->entity, .name = j->def.name, .is_named = j->is_named, .hidden = j->def.hidden
    };
}

scene_camera scene_get_camera(const scene *s)
{
    const sc_camera *c = &s->camera;
    scene_camera out = { .follow = c->follow };
    out.has_view = SC_GIVEN(&sc_list_camera, c, sc_camera, height);
    out.has_fit = SC_GIVEN(&sc_list_camera, c, sc_camera, fit);
    memcpy(out.center, c->center, sizeof out.center);
    memcpy(out.box, c->fit, sizeof out.box);
    out.height = c->height;
    out.has_at = SC_GIVEN(&sc_list_camera, c, sc_camera, at);
    out.at = c->at;
    out.trail = c->trail;
    return out;
}

const char *scene_get_text(const scene *s)
{
    scene *mutable = (scene *)s; // the buffer is a cache of what the scores say now
    size_t used = 0;
    mutable->shown[0] = 0;
    for (int i = 0; i <= s->scores.count && used < sizeof s->shown; i++) {
        const char *gap = used > 0 ? "   " : "";
        int n;
        if (i < s->scores.count) {
            n = snprintf(mutable->shown + used, sizeof s->shown - used, "%s%s %.10g", gap,
                         s->scores.items[i].name, s->scores.items[i].value);
        } else {
            n = s->text[0] == 0
                    ? 0
                    : snprintf(mutable->shown + used, sizeof s->shown - used, "%s%s", gap, s->text);
        }
        used += (size_t)(n > 0 ? n : 0);
    }
    return s->shown;
}

int scene_score_count(const scene *s)
{
    return s->scores.count;
}

const char *scene_score_name(const scene *s, int i)
{
    return s->scores.items[i].name;
}

double scene_score_value(const scene *s, int i)
{
    return s->scores.items[i].value;
}

int scene_expect_count(const scene *s)
{
    return s->expects.count;
}

scene_expect_result scene_expect_get(const scene *s, int i)
{
    sc_expect *e = &s->expects.items[i];
    return (scene_expect_result){ .name = e->def.name,
                                  .status = e->status,
                                  .passed = e->status == SCENE_EXPECT_PASSED,
                                  .quantity = e->quantity,
                                  .unit = e->unit,
                                  .measured = e->measured,
                                  .limit = e->limit,
                                  .time = e->time,
                                  .line = e->line,
                                  .description = sc_expect_describe(e) };
}

int scene_expect_failures(const scene *s)
{
    int failures = 0;
    for (int i = 0; i < s->expects.count; i++) {
        failures += s->expects.items[i].status != SCENE_EXPECT_PASSED;
    }
    return failures;
}

int scene_param_count(const scene *s)
{
    return s->params.count;
}

scene_param scene_param_get(const scene *s, int i)
{
    const sc_param *p = &s->params.items[i];
    return (scene_param){ .name = p->name, .value = p->value, .overridden = p->overridden };
}
