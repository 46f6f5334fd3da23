// body_record.c - the records of bodies: matched against patterns; forgotten. Of a body that is gone its Lua object keeps
// the name and the user table, and can be found by the handle until the events have been told that its end brings: those
// of the next step. Cost: O(1), O(bodies) to forget one.
#include <stdio.h>
#include <string.h>

#include "internal.h"

bool sc_name_matches(const char *pattern, const char *name)
{
    size_t length = strlen(pattern);
    if (length > 0 && pattern[length - 1] == '*') {
        return strncmp(pattern, name, length - 1) == 0;
    }
    return strcmp(pattern, name) == 0;
}

void sc_body_push(scene *s, const sc_body *body)
{
    lua_rawgeti(s->L, LUA_REGISTRYINDEX, body->object);
}

// Tables of Lua objects by handle: of those destroyed since the last step, and of those whose ends are being told.
static const char DEPARTED[] = "plumb.departed", TOLD[] = "plumb.told";

static lua_Integer key_of(plumb_body body)
{
    return (lua_Integer)((uint64_t)body.entity.generation << 32 | body.entity.index);
}

void sc_body_depart(scene *s, const sc_body *body)
{
    lua_State *L = s->L;
    sc_need_stack(s, 5);
    sc_body_push(s, body);
    lua_pushstring(L, body->def.name);
    lua_setiuservalue(L, -2, SC_BODY_NAME);
    lua_rawgeti(L, LUA_REGISTRYINDEX, body->user);
    lua_setiuservalue(L, -2, SC_BODY_USER);
    if (lua_getfield(L, LUA_REGISTRYINDEX, DEPARTED) != LUA_TTABLE) {
        lua_newtable(L);
        lua_pushvalue(L, -1);
        lua_setfield(L, LUA_REGISTRYINDEX, DEPARTED);
        lua_replace(L, -2);
    }
    lua_insert(L, -2);
    lua_rawseti(L, -2, key_of(body->entity));
    lua_pop(L, 1);
    s->departed = true;
}

void sc_departed_turn(scene *s)
{
    if (s->departed || s->told) {
        lua_getfield(s->L, LUA_REGISTRYINDEX, DEPARTED);
        lua_setfield(s->L, LUA_REGISTRYINDEX, TOLD);
        lua_pushnil(s->L);
        lua_setfield(s->L, LUA_REGISTRYINDEX, DEPARTED);
        s->told = s->departed;
        s->departed = false;
    }
}

// Pushes what the table has of the body; false: nothing.
static bool push_from(lua_State *L, const char *table, plumb_body body)
{
    const int top = lua_gettop(L);
    if (lua_getfield(L, LUA_REGISTRYINDEX, table) == LUA_TTABLE &&
        lua_rawgeti(L, -1, key_of(body)) == LUA_TUSERDATA) {
        lua_remove(L, -2);
        return true;
    }
    lua_settop(L, top);
    return false;
}

bool sc_body_recall(scene *s, plumb_body body, char name[SC_NAME_SIZE])
{
    const sc_body *record = sc_body_of(s, body);
    if (record != NULL) {
        sc_body_push(s, record);
        memcpy(name, record->def.name, SC_NAME_SIZE);
        return true;
    }
    const bool any = s->departed || s->told;
    if (!any || (!push_from(s->L, DEPARTED, body) && !push_from(s->L, TOLD, body))) {
        return false;
    }
    lua_getiuservalue(s->L, -1, SC_BODY_NAME);
    snprintf(name, SC_NAME_SIZE, "%s", lua_tostring(s->L, -1));
    lua_pop(s->L, 1);
    return true;
}

void sc_body_release(scene *s, sc_body *body)
{
    lua_State *L = s->L;
    sc_record_name(s, &sc_bodies, body->def.name, NULL);
    luaL_unref(L, LUA_REGISTRYINDEX, body->object);
    luaL_unref(L, LUA_REGISTRYINDEX, body->user);
    for (int i = 0; i < body->def.shape_count; i++) {
        sc_shape_def *d = &body->shapes[i];
        sc_resize(s, d->points, (size_t)d->point_count * sizeof *d->points, 0);
    }
    sc_resize(s, body->shapes, (size_t)body->def.shape_count * sizeof *body->shapes, 0);
    int at = 0;
    while (s->bodies.items[at] != body) {
        at++;
    }
    s->bodies.count--;
    memmove(&s->bodies.items[at], &s->bodies.items[at + 1],
            (size_t)(s->bodies.count - at) * sizeof(sc_body *));
    sc_resize(s, body, sizeof *body, 0);
}
