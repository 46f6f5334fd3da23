// told.c - the tables of facts that scripts are handed: about a contact, a joint that broke, a ray of light. Reading or writing a
// field that such a table cannot have is an error with a suggestion, not nil.
// Cost: that of a metatable for each table; a field that is there is read without a word of ours.
#include <stdio.h>
#include <string.h>

#include "internal.h"

// In the order of sc_told. A field may be nil, as the `other` of a body that broke by a force.
static const struct {
    const char *what, *fields;
} kinds[] = {
    [SC_TOLD_CONTACT] = { "a contact", "impulse nx ny speed time x y" },
    [SC_TOLD_EDIT] = { "a contact", "enabled friction nx ny restitution rolling_resistance "
                                    "separation surface_speed "
                                    "touching x y" },
    [SC_TOLD_JOINT] = { "a joint's event", "a b fx fy kind torque x y" },
    [SC_TOLD_SHATTER] = { "a broken body's event", "energy impulse nx ny other parts x y" },
    [SC_TOLD_GONE] = { "a gone body's event", "how mass x y" },
    [SC_TOLD_WET] = { "a wet body's event", "fx fy" },
    [SC_TOLD_HEAT] = { "heat()", "burning burnt carried content gone heating held mechanical "
                                 "melted owed radiated" },
    [SC_TOLD_RAY] = { "a piece of a light's path",
                      "absorbed body depth how incidence index parent polarization power "
                      "power_end x0 x1 y0 y1" },
};

enum { KINDS = sizeof kinds / sizeof kinds[0] };

// Raises unless the name is one of the fields.
static void check_field(lua_State *L, int kind, const char *name)
{
    sc_suggest g = sc_suggest_start(name);
    for (const char *p = kinds[kind].fields; *p != 0; p += strspn(p, " ")) {
        char field[SC_NAME_SIZE];
        const int length = (int)strcspn(p, " ");
        snprintf(field, sizeof field, "%.*s", length, p);
        if (strcmp(field, name) == 0) {
            return;
        }
        sc_suggest_offer(&g, field);
        p += length;
    }
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, name);
    sc_raise(s, SCENE_E_NAME, &site, NULL, 0, sc_suggest_best(&g), "%s has no '%.40s'; it has %s",
             kinds[kind].what, name, kinds[kind].fields);
}

// Upvalue: the kind. __index comes here only for what is not in the table, __newindex as well.
static int lua_told_index(lua_State *L)
{
    if (lua_type(L, 2) == LUA_TSTRING) {
        check_field(L, (int)lua_tointeger(L, lua_upvalueindex(1)), lua_tostring(L, 2));
    }
    lua_pushnil(L);
    return 1;
}

static int lua_told_newindex(lua_State *L)
{
    lua_settop(L, 3);
    if (lua_type(L, 2) == LUA_TSTRING) {
        check_field(L, (int)lua_tointeger(L, lua_upvalueindex(1)), lua_tostring(L, 2));
    }
    lua_rawset(L, 1);
    return 0;
}

void sc_push_told(lua_State *L, sc_told kind)
{
    lua_createtable(L, 0, 12);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &kinds[kind]);
    lua_setmetatable(L, -2);
}

void sc_open_told(lua_State *L)
{
    for (int i = 0; i < KINDS; i++) {
        lua_newtable(L);
        lua_pushinteger(L, i);
        lua_pushcclosure(L, lua_told_index, 1);
        lua_setfield(L, -2, "__index");
        lua_pushinteger(L, i);
        lua_pushcclosure(L, lua_told_newindex, 1);
        lua_setfield(L, -2, "__newindex");
        lua_rawsetp(L, LUA_REGISTRYINDEX, &kinds[i]);
    }
}
