// body_api.c - bodies as Lua objects: the methods that handlers and test functions call.
// An object holds the world's handle only, so a destroyed body is noticed; the record (name, looks,
// user table) hangs on the world's user data. What changes a body is in body_act.c. To add a method: one
// function, one row in `methods`.
#include <string.h>

#include "internal.h"

// -------------------------------------------------------------------------------------- getters

// The name and the user table can be asked for when the body is gone, too: its object keeps them.
static int method_name(lua_State *L)
{
    const plumb_body *object = luaL_testudata(L, 1, SC_META_BODY);
    if (object != NULL && sc_body_of(sc_of(L), *object) == NULL) {
        sc_work(sc_of(L), 10);
        lua_getiuservalue(L, 1, SC_BODY_NAME);
        return 1;
    }
    lua_pushstring(L, sc_body_self(L, "name").body->def.name);
    return 1;
}

static int method_alive(lua_State *L)
{
    const plumb_body *object = luaL_checkudata(L, 1, SC_META_BODY);
    lua_pushboolean(L, sc_body_of(sc_of(L), *object) != NULL);
    return 1;
}

static int method_type(lua_State *L)
{
    lua_pushstring(L, sc_body_types[sc_body_self(L, "type").body->def.type]);
    return 1;
}

static int method_position(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "position");
    return sc_push_vector(L, plumb_body_position(c.world, c.entity));
}

static int method_center(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "center");
    return sc_push_vector(L, plumb_body_center(c.world, c.entity));
}

static int method_velocity(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "velocity");
    return sc_push_vector(L, plumb_body_velocity(c.world, c.entity));
}

static int method_speed(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "speed");
    return sc_push_real(L, plumb_vec2_magnitude(plumb_body_velocity(c.world, c.entity)));
}

static int method_angle(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "angle");
    return sc_push_real(L, plumb_body_angle(c.world, c.entity));
}

static int method_spin(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "spin");
    return sc_push_real(L, plumb_body_angular_velocity(c.world, c.entity));
}

static int method_fuel(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "fuel");
    return sc_push_real(L, plumb_body_fuel(c.world, c.entity));
}

static int method_temperature(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "temperature");
    return sc_push_real(L, plumb_body_temperature(c.world, c.entity));
}

static int method_mass(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "mass");
    return sc_push_real(L, plumb_body_mass(c.world, c.entity));
}

static int method_inertia(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "inertia");
    return sc_push_real(L, plumb_body_inertia(c.world, c.entity));
}

// -------------------------------------------------------------------------------------- the end

// Joints go with their bodies; their records are ours to forget.
static plumb_result destroy_body(scene *s, plumb_body body)
{
    plumb_joint joint;
    while (plumb_body_joints(s->world, body, &joint, 1) > 0) {
        sc_joint *record = sc_joint_of(s, joint);
        plumb_result r = plumb_joint_destroy(s->world, joint);
        if (r != PLUMB_OK) {
            return r;
        }
        sc_joint_release(s, record);
    }
    plumb_result r = plumb_body_destroy(s->world, body);
    if (r == PLUMB_OK) {
        sc_excluded_forget(s, body);
    }
    return r;
}

static int method_destroy(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "destroy");
    // It is looked for in lists, which move up, and so is each of its joints.
    int joints = plumb_body_joints(c.world, c.entity, NULL, 0);
    sc_work(c.s, 100 + (uint64_t)c.s->bodies.count / 8 + (uint64_t)c.s->excluded.count +
                     (uint64_t)joints * (100 + (uint64_t)c.s->joints.count / 8));
    sc_body_depart(c.s, c.body);
    sc_body_check(&c, destroy_body(c.s, c.entity));
    sc_body_release(c.s, c.body);
    return 0;
}

// --------------------------------------------------------------------------------- metamethods

static const luaL_Reg methods[] = {
    { "alive", method_alive },
    { "angle", method_angle },
    { "center", method_center },
    { "destroy", method_destroy },
    { "fuel", method_fuel },
    { "inertia", method_inertia },
    { "mass", method_mass },
    { "name", method_name },
    { "position", method_position },
    { "speed", method_speed },
    { "spin", method_spin },
    { "temperature", method_temperature },
    { "type", method_type },
    { "velocity", method_velocity },
    { NULL, NULL },
};

// All methods, in four tables.
static const luaL_Reg *const tables[] = { methods, sc_body_acts, sc_character_methods,
                                          sc_fracture_methods };

enum { TABLES = sizeof tables / sizeof tables[0] };

_Noreturn static void fail_member(lua_State *L, const char *name)
{
    scene *s = sc_of(L);
    sc_suggest g = sc_suggest_start(name);
    sc_suggest_offer(&g, "user");
    for (int i = 0; i < TABLES; i++) {
        for (const luaL_Reg *m = tables[i]; m->name != NULL; m++) {
            sc_suggest_offer(&g, m->name);
        }
    }
    sc_site site = sc_here(s, name);
    sc_raise(s, SCENE_E_NAME, &site, NULL, 0, sc_suggest_best(&g), "a body has no '%.40s'", name);
}

static void push_user(lua_State *L)
{
    const plumb_body *object = luaL_testudata(L, 1, SC_META_BODY);
    sc_body *b = object == NULL ? NULL : sc_body_of(sc_of(L), *object);
    if (b != NULL && b->user != LUA_NOREF) {
        lua_rawgeti(L, LUA_REGISTRYINDEX, b->user);
    } else if (b != NULL) {
        lua_newtable(L);
        lua_pushvalue(L, -1);
        b->user = luaL_ref(L, LUA_REGISTRYINDEX);
    } else if (lua_getiuservalue(L, 1, SC_BODY_USER) != LUA_TTABLE) {
        lua_newtable(L);
        lua_pushvalue(L, -1);
        lua_setiuservalue(L, 1, SC_BODY_USER);
    }
}

// body.user, else a method (upvalue 1).
static int body_index(lua_State *L)
{
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "?";
    if (strcmp(name, "user") == 0) {
        push_user(L);
        return 1;
    }
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(1)) == LUA_TNIL) {
        fail_member(L, name);
    }
    return 1;
}

static int body_newindex(lua_State *L)
{
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "?";
    scene *s = sc_of(L);
    sc_site site = sc_here(s, name);
    sc_raise(s, SCENE_E_STATE, &site, NULL, 0, NULL,
             "a body's '%.40s' cannot be assigned: call a method, or keep values in body.user",
             name);
}

static int body_tostring(lua_State *L)
{
    const plumb_body *object = luaL_checkudata(L, 1, SC_META_BODY);
    const sc_body *b = sc_body_of(sc_of(L), *object);
    lua_pushstring(L, b == NULL ? "destroyed body" : b->def.name);
    return 1;
}

void sc_open_body(lua_State *L)
{
    luaL_newmetatable(L, SC_META_BODY);
    lua_newtable(L);
    for (int i = 0; i < TABLES; i++) {
        luaL_setfuncs(L, tables[i], 0);
    }
    lua_pushcclosure(L, body_index, 1);
    lua_setfield(L, -2, "__index");
    lua_pushcfunction(L, body_newindex);
    lua_setfield(L, -2, "__newindex");
    lua_pushcfunction(L, body_tostring);
    lua_setfield(L, -2, "__tostring");
    lua_pop(L, 1);
}
