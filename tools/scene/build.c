// build.c - the constructors scene{}, body{}, camera{} and param().
// Each checks its table by its list, then gives the thing to the world at once, so that whatever
// the world refuses is reported at the author's line. The same functions serve JSON (json_read.c).
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

// ------------------------------------------------------------------------------------ scene{}

static void make_world(scene *s, const sc_site *site)
{
    const sc_settings *def = &s->settings;
    plumb_world_desc desc = { .allocator = { sc_world_resize, s } };
#define GIVEN(word) SC_GIVEN(&sc_list_scene, def, sc_settings, word)
    PL_WORLD_ROWS(SC_DESCRIBE, GIVEN)
#undef GIVEN
    plumb_result result = plumb_world_create(&desc, &s->world);
    if (result != PLUMB_OK) {
        sc_refused(s, site, NULL, result, "the world could not be made");
    }
    plumb_world_set_time(s->world, s->start_time); // gusts and swell go on
}

void sc_build_settings(scene *s, const sc_site *site, int table)
{
    lua_State *L = s->L;
    if (s->world != NULL) {
        if (s->settings_given) {
            sc_raise(s, SCENE_E_DUPLICATE, site, NULL, 0, NULL,
                     "scene{} was called before, on line %d", s->settings_line);
        }
        sc_raise(s, SCENE_E_STATE, site, NULL, 0, NULL,
                 "scene{} must come before the first material{} and body{}");
    }
    lua_newtable(L);
    int merged = lua_gettop(L);
    if (table != 0) {
        for (lua_pushnil(L); lua_next(L, table) != 0;) {
            lua_pushvalue(L, -2);
            lua_insert(L, -2);
            lua_rawset(L, merged);
        }
    }
    for (int i = 0; i < sc_list_scene.count; i++) {
        if (sc_take_set(s, sc_list_scene.rows[i].name)) {
            lua_setfield(L, merged, sc_list_scene.rows[i].name);
        }
    }
    sc_take_accuracy(s, site, merged);
    sc_settings *d = &s->settings;
    sc_read(s, site, &sc_list_scene, merged, d);
    lua_pop(L, 1);
    if (d->simd_width != 0 && d->simd_width != 4 && d->simd_width != 8 && d->simd_width != 16) {
        sc_raise(s, SCENE_E_RANGE, site, "simd_width", 0, NULL,
                 "'simd_width' of scene{} must be 0, 4, 8 or 16, not %g", d->simd_width);
    }
    s->dt = SC_GIVEN(&sc_list_scene, d, sc_settings, dt) ? d->dt : 1.0 / 60;
    s->duration = SC_GIVEN(&sc_list_scene, d, sc_settings, duration) ? d->duration : 10;
    s->random = (uint64_t)d->seed;
    s->settings_given = table != 0;
    s->settings_line = site->line;
    make_world(s, site);
}

void sc_need_world(scene *s)
{
    if (s->world == NULL) {
        sc_build_settings(s, &(sc_site){ .construct = "scene" }, 0);
    }
}

// -------------------------------------------------------------------------------------- body{}

static void refuse(scene *s, const sc_site *site, bool given, const char *key, const char *kind)
{
    if (given) {
        sc_raise(s, SCENE_E_CONFLICT, site, key, 0, NULL, "a %s body{} cannot have '%s'", kind,
                 key);
    }
}

static void check_body(scene *s, const sc_site *site, const sc_body_def *d)
{
    const sc_list *list = &sc_list_body;
    static const char *const kinds[] = { "dynamic", "kinematic", "static" };
    if (SC_GIVEN(list, d, sc_body_def, angle) && SC_GIVEN(list, d, sc_body_def, angle_deg)) {
        sc_raise(s, SCENE_E_CONFLICT, site, "angle_deg", 0, NULL,
                 "body{} has both 'angle' and 'angle_deg'");
    }
    if (d->type != 0) {
        refuse(s, site, SC_GIVEN(list, d, sc_body_def, mass), "mass", kinds[d->type]);
        refuse(s, site, d->continuous, "continuous", kinds[d->type]);
        refuse(s, site, d->fixed_rotation, "fixed_rotation", kinds[d->type]);
        refuse(s, site, d->asleep, "asleep", kinds[d->type]);
        refuse(s, site, SC_GIVEN(list, d, sc_body_def, sleep), "sleep", kinds[d->type]);
        refuse(s, site, SC_GIVEN(list, d, sc_body_def, gravity_scale), "gravity_scale",
               kinds[d->type]);
    }
    if (d->asleep) {
        refuse(s, site, d->velocity[0] != 0 || d->velocity[1] != 0, "velocity", "sleeping");
        refuse(s, site, d->spin != 0, "spin", "sleeping");
        refuse(s, site, !d->sleep, "sleep", "sleeping");
    }
    if (d->type == 2) {
        refuse(s, site, SC_GIVEN(list, d, sc_body_def, velocity), "velocity", "static");
        refuse(s, site, SC_GIVEN(list, d, sc_body_def, spin), "spin", "static");
    }
    sc_motion_check(s, site, d);
    sc_one_way_check(s, site, d);
    if (d->shape_count == 0 && !SC_GIVEN(list, d, sc_body_def, mass)) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL, "body{} needs a shape such as box{1, 1}");
    }
    sc_filter_given given = SC_FILTER_GIVEN(list, d, sc_body_def);
    sc_filter_check(s, site, &given);
    if (strcmp(d->name, "world") == 0) {
        sc_raise(s, SCENE_E_RANGE, site, "name", 0, NULL,
                 "'name' of body{} must not be 'world': that is what joints hold on to");
    }
    if (strchr(d->name, '*') != NULL) {
        sc_raise(s, SCENE_E_RANGE, site, "name", 0, NULL,
                 "'name' of body{} must not contain '*': it stands for any ending elsewhere");
    }
    const sc_body *other = d->name[0] != 0 ? sc_body_named(s, d->name) : NULL;
    if (other != NULL) {
        sc_raise(s, SCENE_E_DUPLICATE, site, "name", 0, NULL, "two bodies are called '%s'",
                 d->name);
    }
}

// Puts a fresh record with its name into the scene's lists; its Lua object is left on the stack.
sc_body *sc_body_add(scene *s, const sc_body_def *def)
{
    sc_body **slot = SC_PUSH(s, s->bodies);
    s->bodies.count--; // until there is a record
    sc_body *b = sc_need(s, NULL, 0, sizeof *b);
    *b = (sc_body){
        .def = *def, .is_named = def->name[0] != 0, .object = LUA_NOREF, .user = LUA_NOREF
    };
    b->def.shape_count = 0;
    *slot = b;
    s->bodies.count++;
    s->body_serial++;
    unsigned long long number = s->body_serial;
    while (b->def.name[0] == 0) { // skip a number that the author has taken
        char name[SC_NAME_SIZE];
        snprintf(name, sizeof name, "body%llu", number++);
        if (sc_body_named(s, name) == NULL) {
            snprintf(b->def.name, sizeof b->def.name, "%s", name);
        }
    }
    sc_record_name(s, &sc_bodies, b->def.name, b);
    return b;
}

static void create_body(scene *s, const sc_site *site, sc_body *b)
{
    const sc_body_def *def = &b->def;
    plumb_body_desc desc = { .user_data = b };
#define GIVEN(word) SC_GIVEN(&sc_list_body, def, sc_body_def, word)
    PL_BODY_ROWS(SC_DESCRIBE, GIVEN)
#undef GIVEN
    desc.velocity = (plumb_vec2){ 0, 0 }; // when the shapes are there
    desc.angular_velocity = 0;
    sc_motion_describe(def, &desc);
    b->entity = plumb_body_create(s->world, &desc);
    if (plumb_is_null(b->entity)) {
        sc_refused(s, site, NULL, plumb_world_error(s->world).code, "body{}");
    }
}

// Copies shape `index` (0-based; its Lua object is on top) into the record and gives it to the
// world.
static void add_shape(scene *s, const sc_site *site, sc_body *b, int index)
{
    sc_shape_object *object = sc_to_shape(s->L, -1);
    if (object->epoch == s->epoch) {
        s->made.items[object->made].used = true;
    }
    sc_shape_def *copy = &b->shapes[index];
    *copy = object->def;
    copy->points = NULL;
    b->def.shape_count = index + 1;
    if (object->def.point_count > 0) {
        size_t size = (size_t)object->def.point_count * sizeof *copy->points;
        copy->points = sc_need(s, NULL, 0, size);
        memcpy(copy->points, object->def.points, size);
    }
    sc_shape_create(s, site, index, b, copy);
}

void sc_build_body(scene *s, const sc_site *site, int table)
{
    lua_State *L = s->L;
    sc_need_stack(s, 20);
    table = lua_absindex(L, table);
    sc_need_world(s);
    sc_body_def def = { .color = { .palette = -1 } };
    PL_BODY_ROWS(SC_DEFAULT, )
    sc_read(s, site, &sc_list_body, table, &def);
    check_body(s, site, &def);
    if (SC_GIVEN(&sc_list_body, &def, sc_body_def, angle_deg)) {
        def.angle = def.angle_deg * (3.141592653589793 / 180);
        SC_GIVE(&sc_list_body, &def, sc_body_def, angle);
    }
    sc_work(s, 200 + 100 * (uint64_t)def.shape_count); // some microseconds
    sc_body *b = sc_body_add(s, &def);
    b->line = site->line;
    create_body(s, site, b);
    b->shapes = def.shape_count == 0
                    ? NULL
                    : sc_need(s, NULL, 0, (size_t)def.shape_count * sizeof *b->shapes);
    b->def.shape_count = 0;
    lua_getfield(L, table, "shapes");
    if (lua_isnil(L, -1)) {
        lua_pushvalue(L, table);
        lua_replace(L, -2);
    }
    bool massive = false, sensors = false;
    for (int i = 0; i < def.shape_count; i++) {
        lua_rawgeti(L, -1, i + 1);
        add_shape(s, site, b, i);
        bool is_sensor = sc_shape_is_sensor(b, &b->shapes[i]);
        sensors |= is_sensor;
        massive |= !is_sensor && b->shapes[i].kind != SC_SEGMENT && b->shapes[i].kind != SC_CHAIN;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    if (def.type == 0 && !massive && def.mass == 0) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 sensors ? "a dynamic body{} of nothing but sensors needs 'mass'"
                         : "a dynamic body{} of segments and chains needs 'mass'");
    }
    if (def.type != 2) { // after the shapes: they have moved the centre of mass
        plumb_body_set_velocity(
            s->world, b->entity,
            (plumb_vec2){ (plumb_real)def.velocity[0], (plumb_real)def.velocity[1] });
        plumb_body_set_angular_velocity(s->world, b->entity, (plumb_real)def.spin);
    }
    if ((plumb_real)def.time_scale == 0) { // which is 1 to the descriptor
        plumb_body_set_time_scale(s->world, b->entity, (plumb_real)def.time_scale);
    }
    if (SC_GIVEN(&sc_list_body, &def, sc_body_def, character)) {
        sc_character_make(s, site, b);
    }
    b->set_rot = plumb_body_transform(s->world, b->entity).q;
    lua_getfield(L, table, "user");
    b->user = lua_istable(L, -1) ? luaL_ref(L, LUA_REGISTRYINDEX) : (lua_pop(L, 1), LUA_NOREF);
    plumb_body *object = lua_newuserdatauv(L, sizeof *object, SC_BODY_KEEPSAKES);
    *object = b->entity;
    luaL_setmetatable(L, SC_META_BODY);
    lua_pushvalue(L, -1);
    b->object = luaL_ref(L, LUA_REGISTRYINDEX);
}

// ------------------------------------------------------------------------------------ camera{}

void sc_build_camera(scene *s, const sc_site *site, int table)
{
    const sc_list *list = &sc_list_camera;
    if (s->camera.present != 0) {
        sc_raise(s, SCENE_E_DUPLICATE, site, NULL, 0, NULL,
                 "camera{} was called before, on line %d", s->camera_line);
    }
    sc_camera *c = &s->camera;
    sc_read(s, site, list, table, c);
    s->camera_line = site->line;
    bool center = SC_GIVEN(list, c, sc_camera, center);
    bool height = SC_GIVEN(list, c, sc_camera, height);
    bool fit = SC_GIVEN(list, c, sc_camera, fit);
    if (fit && (center || height)) {
        sc_raise(s, SCENE_E_CONFLICT, site, "fit", 0, NULL,
                 "camera{} takes either 'fit' or 'center' and 'height'");
    }
    if (center && !height) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL, "camera{} with 'center' needs 'height'");
    }
    bool other = SC_GIVEN(list, c, sc_camera, at) || SC_GIVEN(list, c, sc_camera, trail);
    if (!fit && !height && !other && c->follow[0] == 0) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "camera{} needs 'fit', 'center' and 'height', or 'follow'");
    }
    if (height && !center && c->follow[0] == 0) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "camera{} with 'height' needs 'center' or 'follow'");
    }
}

// ----------------------------------------------------------------------------- Lua's side of it

int sc_construct(lua_State *L, const char *name, sc_constructor *build, int results)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, name);
    if (lua_gettop(L) != 1 || lua_type(L, 1) != LUA_TTABLE) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL, "%s takes one table: %s{...}", name, name);
    }
    build(s, &site, 1);
    return results;
}

static int lua_scene(lua_State *L)
{
    return sc_construct(L, "scene", sc_build_settings, 0);
}

static int lua_body(lua_State *L)
{
    return sc_construct(L, "body", sc_build_body, 1);
}

static int lua_camera(lua_State *L)
{
    return sc_construct(L, "camera", sc_build_camera, 0);
}

// Raises unless the value on top fits what the param's default says.
static void check_param(scene *s, const sc_site *site, const char *name)
{
    lua_State *L = s->L;
    int type = lua_type(L, 2);
    if (lua_type(L, -1) != type || (lua_isinteger(L, 2) && !lua_isinteger(L, -1))) {
        sc_raise(s, SCENE_E_TYPE, site, NULL, 2, NULL,
                 "param '%s' must be %s like its default, not %s", name,
                 lua_isinteger(L, 2)    ? "an integer"
                 : type == LUA_TNUMBER  ? "a number"
                 : type == LUA_TBOOLEAN ? "true or false"
                                        : "a string",
                 lua_type(L, -1) == LUA_TNUMBER ? lua_tostring(L, -1) : sc_type_name(s, -1));
    }
    if (type == LUA_TNUMBER) {
        double v = lua_tonumber(L, -1);
        double low = luaL_optnumber(L, 3, -HUGE_VAL);
        double high = luaL_optnumber(L, 4, HUGE_VAL);
        if (!(v >= low && v <= high && isfinite(v))) {
            sc_raise(s, SCENE_E_RANGE, site, NULL, 2, NULL,
                     "param '%s' must be from %.10g to %.10g, not %.10g", name, low, high, v);
        }
    }
}

static int lua_param(lua_State *L)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, "param");
    lua_settop(L, 4);
    int type = lua_type(L, 2);
    if (lua_type(L, 1) != LUA_TSTRING ||
        (type != LUA_TNUMBER && type != LUA_TBOOLEAN && type != LUA_TSTRING)) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL,
                 "param takes a name, a default and optionally min and max");
    }
    const char *name = lua_tostring(L, 1);
    sc_param p = { 0 };
    if (strlen(name) >= sizeof p.name || name[0] == 0) {
        sc_raise(s, SCENE_E_RANGE, &site, NULL, 1, NULL,
                 "a param's name must have 1 to 63 characters");
    }
    snprintf(p.name, sizeof p.name, "%s", name);
    sc_work(s, (uint64_t)s->params.count + 10);
    for (int i = 0; i < s->params.count; i++) {
        if (strcmp(s->params.items[i].name, name) == 0) {
            sc_raise(s, SCENE_E_DUPLICATE, &site, NULL, 1, NULL, "param '%s' is declared twice",
                     name);
        }
    }
    for (int i = 0; i < sc_list_scene.count; i++) {
        if (strcmp(sc_list_scene.rows[i].name, name) == 0) {
            sc_raise(s, SCENE_E_DUPLICATE, &site, NULL, 1, NULL,
                     "param '%s' has the name of a key of scene{}", name);
        }
    }
    lua_pushvalue(L, 2);
    check_param(s, &site, p.name);
    p.overridden = sc_take_set(s, name);
    if (p.overridden) {
        s->raising_set = p.name;
        if (type == LUA_TSTRING && lua_type(L, -1) != LUA_TSTRING) { // --set title=1 is a text too
            lua_pop(L, 1);
            for (int i = 0; i < s->sets.count; i++) {
                if (strcmp(s->sets.items[i].key, name) == 0) {
                    lua_settop(L, 5);
                    lua_pushstring(L, s->sets.items[i].value);
                }
            }
        }
        check_param(s, &site, p.name);
        s->raising_set = NULL;
    }
    lua_pushvalue(L, -1);
    snprintf(p.value, sizeof p.value, "%s",
             type == LUA_TBOOLEAN ? (lua_toboolean(L, -1) ? "true" : "false")
                                  : lua_tostring(L, -1));
    lua_pop(L, 1);
    *SC_PUSH(s, s->params) = p;
    return 1;
}

void sc_open_build(lua_State *L)
{
    sc_records_open(L, &sc_bodies);
    lua_register(L, "scene", lua_scene);
    lua_register(L, "body", lua_body);
    lua_register(L, "camera", lua_camera);
    lua_register(L, "param", lua_param);
}
