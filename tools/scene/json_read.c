// json_read.c - canonical JSON becomes a scene: each object turns into a Lua table and goes through
// the same constructors as a script's, so the same checks and messages hold, with the JSON's line
// and column. Only data: no handlers, no functions. cJSON parses; positions are found again by
// json_pos.c.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "internal.h"

#define META_JSON "plumb.json"

enum { DEEPEST = 16 }; // nesting; a scene needs 6

static int json_collect(lua_State *L)
{
    cJSON **root = luaL_checkudata(L, 1, META_JSON);
    cJSON_Delete(*root);
    *root = NULL;
    return 0;
}

void sc_open_json(lua_State *L)
{
    luaL_newmetatable(L, META_JSON);
    lua_pushcfunction(L, json_collect);
    lua_setfield(L, -2, "__gc");
    lua_pop(L, 1);
}

// The value as Lua sees it, on the stack.
static void push_value(scene *s, const sc_site *site, const cJSON *item, int depth)
{
    lua_State *L = s->L;
    sc_need_stack(s, 8);
    if (depth > DEEPEST) {
        sc_raise(s, SCENE_E_LIMIT, site, NULL, 0, NULL, "values are nested more than %d deep",
                 DEEPEST);
    }
    if (cJSON_IsNumber(item)) {
        lua_pushnumber(L, item->valuedouble);
    } else if (cJSON_IsBool(item)) {
        lua_pushboolean(L, cJSON_IsTrue(item));
    } else if (cJSON_IsString(item)) {
        lua_pushstring(L, item->valuestring);
    } else if (cJSON_IsArray(item)) {
        lua_newtable(L);
        lua_Integer i = 1;
        for (const cJSON *child = item->child; child != NULL; child = child->next) {
            push_value(s, site, child, depth + 1);
            lua_rawseti(L, -2, i++);
        }
    } else if (cJSON_IsObject(item)) {
        lua_newtable(L);
        for (const cJSON *child = item->child; child != NULL; child = child->next) {
            lua_pushstring(L, child->string);
            if (lua_rawget(L, -2) != LUA_TNIL) {
                sc_raise(s, SCENE_E_DUPLICATE, site, child->string, 0, NULL,
                         "key '%.63s' is given twice", child->string);
            }
            lua_pop(L, 1);
            push_value(s, site, child, depth + 1);
            lua_setfield(L, -2, child->string);
        }
    } else {
        sc_raise(s, SCENE_E_TYPE, site, item->string, 0, NULL, "null is not a value of a scene");
    }
}

static void push_object(scene *s, const sc_site *site, const cJSON *item)
{
    if (!cJSON_IsObject(item)) {
        sc_raise(s, SCENE_E_TYPE, site, NULL, 0, NULL, "%s must be an object {...}",
                 site->construct);
    }
    push_value(s, site, item, 0);
}

// Puts the material named by the string field `key` of the table on top in its place.
static void resolve_material(scene *s, const sc_site *site, const char *key)
{
    lua_State *L = s->L;
    if (lua_getfield(L, -1, key) != LUA_TSTRING) {
        lua_pop(L, 1); // absent, or for sc_read to complain about
        return;
    }
    const char *name = lua_tostring(L, -1);
    sc_suggest g = sc_suggest_start(name);
    for (int i = 0; i < s->materials.count; i++) {
        sc_suggest_offer(&g, s->materials.items[i]->id);
        if (strcmp(s->materials.items[i]->id, name) == 0) {
            lua_getfield(L, LUA_REGISTRYINDEX, "plumb.materials");
            lua_rawgeti(L, -1, i + 1);
            lua_setfield(L, -4, key);
            lua_pop(L, 2);
            return;
        }
    }
    sc_raise(s, SCENE_E_NAME, site, key, 0, sc_suggest_best(&g), "no material is called '%.63s'",
             name);
}

// {"kind": "box", ...} on top becomes a shape object.
static void make_shape(scene *s, sc_site *site)
{
    lua_State *L = s->L;
    if (lua_type(L, -1) != LUA_TTABLE) {
        sc_raise(s, SCENE_E_TYPE, site, NULL, 0, NULL, "a shape must be an object {...}");
    }
    if (lua_getfield(L, -1, "kind") != LUA_TSTRING) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL, "a shape needs 'kind', such as \"box\"");
    }
    const char *kind = lua_tostring(L, -1);
    sc_suggest g = sc_suggest_start(kind);
    for (int k = 0; k < SC_SHAPE_KINDS; k++) {
        const char *name = sc_shape_kind_name((sc_shape_kind)k);
        sc_suggest_offer(&g, name);
        if (strcmp(name, kind) == 0) {
            site->construct = name;
            lua_pop(L, 1);
            lua_pushnil(L);
            lua_setfield(L, -2, "kind");
            resolve_material(s, site, "material");
            sc_build_shape(s, site, (sc_shape_kind)k, lua_gettop(L));
            lua_remove(L, -2);
            return;
        }
    }
    sc_raise(s, SCENE_E_NAME, site, "kind", 0, sc_suggest_best(&g), "unknown kind of shape '%.63s'",
             kind);
}

static void make_body(scene *s, const cJSON *item, int number)
{
    lua_State *L = s->L;
    char path[48];
    snprintf(path, sizeof path, "bodies[%d]", number);
    sc_site site = { .construct = "body", .path = path };
    push_object(s, &site, item);
    if (lua_getfield(L, -1, "shapes") == LUA_TTABLE) {
        lua_Integer count = (lua_Integer)lua_rawlen(L, -1);
        for (lua_Integer i = 1; i <= count; i++) {
            char shape_path[96];
            snprintf(shape_path, sizeof shape_path, "%s.shapes[%d]", path, (int)i - 1);
            sc_site shape_site = { .construct = "shape", .path = shape_path };
            lua_rawgeti(L, -1, i);
            make_shape(s, &shape_site);
            lua_rawseti(L, -2, i);
        }
    }
    lua_pop(L, 1);
    resolve_material(s, &site, "material");
    sc_build_body(s, &site, lua_gettop(L));
    lua_settop(L, 1); // 1: the parsed tree
}

// Elements of a member that is an array; null (absent) is an empty one.
static const cJSON *elements(scene *s, const cJSON *root, const char *name)
{
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(root, name);
    if (list != NULL && !cJSON_IsArray(list)) {
        sc_raise(s, SCENE_E_TYPE, &(sc_site){ .construct = "scene", .path = "" }, name, 0, NULL,
                 "'%s' must be an array [...]", name);
    }
    return list == NULL ? NULL : list->child;
}

static void check_root(scene *s, const cJSON *root)
{
    static const char *const names[] = { "air",       "bodies", "camera", "excluded", "expect",
                                         "format",    "joints", "laws",   "lights",   "liquid",
                                         "materials", "orbits", "pairs",  "scene",    "softbodies",
                                         "sources",   "time",   "waves" };
    sc_site site = { .construct = "file", .path = "" };
    if (!cJSON_IsObject(root)) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL, "a scene must be an object {...}");
    }
    for (const cJSON *child = root->child; child != NULL; child = child->next) {
        sc_suggest g = sc_suggest_start(child->string);
        bool known = false;
        for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
            sc_suggest_offer(&g, names[i]);
            known |= strcmp(names[i], child->string) == 0;
        }
        if (!known) {
            sc_raise(s, SCENE_E_KEY, &site, child->string, 0, sc_suggest_best(&g),
                     "unknown key '%.63s' in a scene", child->string);
        }
        for (const cJSON *other = root->child; other != child; other = other->next) {
            if (strcmp(other->string, child->string) == 0) {
                sc_raise(s, SCENE_E_DUPLICATE, &site, child->string, 0, NULL,
                         "key '%.63s' is given twice", child->string);
            }
        }
    }
    const cJSON *format = cJSON_GetObjectItemCaseSensitive(root, "format");
    if (!cJSON_IsString(format) || strcmp(format->valuestring, "plumb-scene-1") != 0) {
        sc_raise(s, SCENE_E_MISSING, &site, "format", 0, NULL,
                 "a scene needs \"format\":\"plumb-scene-1\"");
    }
    const cJSON *time = cJSON_GetObjectItemCaseSensitive(root, "time");
    if (time != NULL &&
        (!cJSON_IsNumber(time) || !(time->valuedouble >= 0 && time->valuedouble <= 1e9))) {
        sc_raise(s, SCENE_E_TYPE, &site, "time", 0, NULL,
                 "'time' must be a number from 0 to 1e9 [s]");
    }
    s->start_time = time != NULL ? time->valuedouble : 0;
}

// Things of several kinds, each with a list of its words.
typedef struct kinds {
    const char *what, *plural, *example;
    const sc_list *lists;
    int count;
    void (*build)(scene *s, const sc_site *site, int kind, int table); // pushes it
} kinds;

static void build_joint(scene *s, const sc_site *site, int kind, int table)
{
    sc_build_joint(s, site, (plumb_joint_kind)kind, table);
}

static void build_law(scene *s, const sc_site *site, int kind, int table)
{
    sc_build_law(s, site, (sc_law_kind)kind, table);
}

static const kinds joint_kinds = { "joint",        "joints",       "revolute",
                                   sc_list_joints, SC_JOINT_KINDS, build_joint };
static const kinds law_kinds = {
    "law", "laws", "attractor", sc_list_laws, SC_LAW_KINDS, build_law
};

// {"kind": "revolute", ...}
static void make_of(scene *s, const kinds *of, const cJSON *item, int number)
{
    lua_State *L = s->L;
    char path[48];
    snprintf(path, sizeof path, "%s[%d]", of->plural, number);
    sc_site site = { .construct = of->what, .path = path };
    push_object(s, &site, item);
    if (lua_getfield(L, -1, "kind") != LUA_TSTRING) {
        sc_raise(s, SCENE_E_MISSING, &site, NULL, 0, NULL, "a %s needs 'kind', such as \"%s\"",
                 of->what, of->example);
    }
    const char *kind = lua_tostring(L, -1);
    sc_suggest g = sc_suggest_start(kind);
    for (int k = 0; k < of->count; k++) {
        const char *name = of->lists[k].name;
        sc_suggest_offer(&g, name);
        if (strcmp(name, kind) == 0) {
            site.construct = name;
            lua_pop(L, 1);
            lua_pushnil(L);
            lua_setfield(L, -2, "kind");
            of->build(s, &site, k, lua_gettop(L));
            lua_settop(L, 1); // 1: the parsed tree
            return;
        }
    }
    sc_raise(s, SCENE_E_NAME, &site, "kind", 0, sc_suggest_best(&g), "unknown kind of %s '%.63s'",
             of->what, kind);
}

// ["a", "b"]
static void make_excluded(scene *s, const cJSON *item, int number)
{
    char path[48];
    plumb_body ends[2];
    snprintf(path, sizeof path, "excluded[%d]", number);
    sc_site site = { .construct = "excluded", .path = path };
    const cJSON *names[2] = { item->child, item->child != NULL ? item->child->next : NULL };
    bool good = cJSON_IsArray(item) && cJSON_IsString(names[0]) && cJSON_IsString(names[1]) &&
                names[1]->next == NULL && strcmp(names[0]->valuestring, names[1]->valuestring) != 0;
    if (!good) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL,
                 "an excluded pair must be the names of two bodies");
    }
    for (int i = 0; i < 2; i++) {
        const char *name = names[i]->valuestring;
        const sc_body *b = sc_body_named(s, name);
        if (b == NULL) {
            sc_check_body_name(s, &site, NULL, name); // says what is meant
            sc_raise(s, SCENE_E_NAME, &site, NULL, 0, NULL, "no body is called '%.63s'", name);
        }
        ends[i] = b->entity;
    }
    plumb_result r = sc_exclude(s, ends[0], ends[1], true);
    if (r != PLUMB_OK) {
        sc_refused(s, &site, NULL, r, "excluded");
    }
}

static cJSON *parse(scene *s)
{
    lua_State *L = s->L;
    cJSON **holder = lua_newuserdatauv(L, sizeof *holder, 0);
    *holder = NULL;
    luaL_setmetatable(L, META_JSON);
    const char *end = NULL;
    const char *stop = s->source + s->source_size;
    *holder = cJSON_ParseWithLengthOpts(s->source, s->source_size, &end, false);
    bool good = *holder != NULL;
    while (good && end < stop && (unsigned char)*end <= ' ') {
        end++;
    }
    if (!good || end != stop) {
        const char *known = good ? "something follows the end of the scene" : NULL;
        const char *where = end;
        if (!good) {
            known = sc_json_wrong(s->source, s->source_size, &where);
            end = known != NULL ? where : end;
        }
        int line = 1;
        int column = 1;
        for (const char *p = s->source; end != NULL && p < end && p < stop; p++) {
            column = *p == '\n' ? 1 : column + 1;
            line += *p == '\n';
        }
        sc_set_error(s, SCENE_E_SYNTAX, line, column, NULL,
                     known != NULL ? known : "this is not JSON");
        lua_pushlightuserdata(L, s);
        lua_error(L);
    }
    return *holder;
}

static void make_pair(scene *s, const cJSON *item, int number)
{
    char path[48];
    snprintf(path, sizeof path, "pairs[%d]", number);
    sc_site site = { .construct = "material_pair", .path = path };
    push_object(s, &site, item);
    resolve_material(s, &site, "a");
    resolve_material(s, &site, "b");
    sc_build_pair(s, &site, lua_gettop(s->L));
    lua_settop(s->L, 1);
}

// Builds one object by a constructor.
static void make(scene *s, const cJSON *item, const char *construct, const char *path,
                 void (*build)(scene *, const sc_site *, int))
{
    sc_site site = { .construct = construct, .path = path };
    push_object(s, &site, item);
    build(s, &site, lua_gettop(s->L));
}

static void build_softbody(scene *s, const sc_site *site, int table)
{
    sc_build_softbody(s, site, SC_SOFTBODY, table);
}

void sc_json_load(scene *s)
{
    lua_State *L = s->L;
    lua_settop(L, 0);
    const cJSON *root = parse(s);
    check_root(s, root);
    char path[48];
    const cJSON *settings = cJSON_GetObjectItemCaseSensitive(root, "scene");
    if (settings != NULL) {
        make(s, settings, "scene", "scene", sc_build_settings);
    }
    lua_settop(L, 1);
    lua_newtable(L);
    lua_setfield(L, LUA_REGISTRYINDEX, "plumb.materials");
    int i = 0;
    for (const cJSON *item = elements(s, root, "materials"); item != NULL; item = item->next, i++) {
        snprintf(path, sizeof path, "materials[%d]", i);
        lua_getfield(L, LUA_REGISTRYINDEX, "plumb.materials");
        make(s, item, "material", path, sc_build_material);
        lua_rawseti(L, 2, i + 1);
        lua_settop(L, 1);
    }
    i = 0;
    for (const cJSON *item = elements(s, root, "pairs"); item != NULL; item = item->next, i++) {
        make_pair(s, item, i);
    }
    i = 0;
    for (const cJSON *item = elements(s, root, "bodies"); item != NULL; item = item->next, i++) {
        make_body(s, item, i);
    }
    i = 0;
    for (const cJSON *item = elements(s, root, "joints"); item != NULL; item = item->next, i++) {
        make_of(s, &joint_kinds, item, i);
    }
    i = 0;
    for (const cJSON *item = elements(s, root, "excluded"); item != NULL; item = item->next, i++) {
        make_excluded(s, item, i);
    }
    i = 0;
    for (const cJSON *item = elements(s, root, "laws"); item != NULL; item = item->next, i++) {
        make_of(s, &law_kinds, item, i);
    }
    i = 0;
    for (const cJSON *item = elements(s, root, "softbodies"); item != NULL;
         item = item->next, i++) {
        snprintf(path, sizeof path, "softbodies[%d]", i);
        make(s, item, "softbody", path, build_softbody);
        lua_settop(L, 1);
    }
    const cJSON *orbits = cJSON_GetObjectItemCaseSensitive(root, "orbits");
    if (orbits != NULL) {
        make(s, orbits, "orbits", "orbits", sc_build_orbits);
        lua_settop(L, 1);
    }
    const cJSON *liquid = cJSON_GetObjectItemCaseSensitive(root, "liquid");
    if (liquid != NULL) {
        make(s, liquid, "liquid", "liquid", sc_build_liquid);
        lua_settop(L, 1);
    }
    const cJSON *air = cJSON_GetObjectItemCaseSensitive(root, "air");
    if (air != NULL) {
        make(s, air, "air", "air", sc_build_air);
        lua_settop(L, 1);
    }
    i = 0;
    for (const cJSON *item = elements(s, root, "sources"); item != NULL; item = item->next, i++) {
        snprintf(path, sizeof path, "sources[%d]", i);
        make(s, item, "air_source", path, sc_build_source);
        lua_settop(L, 1);
    }
    i = 0;
    for (const cJSON *item = elements(s, root, "waves"); item != NULL; item = item->next, i++) {
        snprintf(path, sizeof path, "waves[%d]", i);
        make(s, item, "waves", path, sc_build_waves);
        lua_settop(L, 1);
    }
    i = 0;
    for (const cJSON *item = elements(s, root, "lights"); item != NULL; item = item->next, i++) {
        snprintf(path, sizeof path, "lights[%d]", i);
        make(s, item, "light", path, sc_build_light);
        lua_settop(L, 1);
    }
    const cJSON *camera = cJSON_GetObjectItemCaseSensitive(root, "camera");
    if (camera != NULL) {
        make(s, camera, "camera", "camera", sc_build_camera);
    }
    i = 0;
    for (const cJSON *item = elements(s, root, "expect"); item != NULL; item = item->next, i++) {
        snprintf(path, sizeof path, "expect[%d]", i);
        make(s, item, "expect", path, sc_build_expect);
        lua_settop(L, 1);
    }
}
