// records.c - the records of bodies and joints: found by handle, by name, by Lua object. A record hangs on the
// user data of what it is of, and stands by its name in a table of the registry. Cost: O(1).
#include "internal.h"

static void *body_data(const plumb_world *world, plumb_entity entity)
{
    return plumb_body_user_data(world, (plumb_body){ entity });
}

static void *joint_data(const plumb_world *world, plumb_entity entity)
{
    return plumb_joint_user_data(world, (plumb_joint){ entity });
}

const sc_record_kind sc_bodies = { SC_META_BODY, "plumb.names", PLUMB_KIND_BODY, body_data };
const sc_record_kind sc_joints = { SC_META_JOINT, "plumb.joints", PLUMB_KIND_JOINT, joint_data };

void sc_records_open(lua_State *L, const sc_record_kind *kind)
{
    lua_newtable(L);
    lua_setfield(L, LUA_REGISTRYINDEX, kind->names);
}

void *sc_record_of(const scene *s, const sc_record_kind *kind, plumb_entity entity)
{
    bool alive = s->world != NULL && plumb_entity_get_kind(s->world, entity) == kind->kind;
    return alive ? kind->user_data(s->world, entity) : NULL;
}

void *sc_record_named(const scene *s, const sc_record_kind *kind, const char *name)
{
    lua_State *L = s->L;
    lua_getfield(L, LUA_REGISTRYINDEX, kind->names);
    lua_pushstring(L, name);
    lua_rawget(L, -2);
    void *record = lua_touserdata(L, -1);
    lua_pop(L, 2);
    return record;
}

void sc_record_name(scene *s, const sc_record_kind *kind, const char *name, void *record)
{
    lua_State *L = s->L;
    lua_getfield(L, LUA_REGISTRYINDEX, kind->names);
    if (record != NULL) {
        lua_pushlightuserdata(L, record);
    } else {
        lua_pushnil(L);
    }
    lua_setfield(L, -2, name);
    lua_pop(L, 1);
}

bool sc_handle_at(lua_State *L, int index, const sc_record_kind *kind, plumb_entity *out)
{
    const plumb_entity *object = luaL_testudata(L, index, kind->meta);
    if (object != NULL) {
        *out = *object;
    }
    return object != NULL;
}
