// accuracy.c - `accuracy` of scene{}: a tolerance, or a preset, becomes what the world's descriptor says.
#include <string.h>

#include "internal.h"

// Sets what the author has not said himself.
static void set_unless(lua_State *L, int table, const char *key, double value)
{
    if (lua_getfield(L, table, key) == LUA_TNIL) {
        lua_pushnumber(L, value);
        lua_setfield(L, table, key);
    }
    lua_pop(L, 1);
}

static void take_preset(scene *s, const sc_site *site, int merged, const char *name)
{
    sc_suggest g = sc_suggest_start(name);
    for (int i = 0; i < PLUMB_ACCURACY_PRESETS; i++) {
        plumb_world_desc desc = { 0 };
        sc_suggest_offer(&g, plumb_accuracy_name((plumb_accuracy_preset)i));
        if (strcmp(name, plumb_accuracy_name((plumb_accuracy_preset)i)) == 0) {
            plumb_accuracy_apply((plumb_accuracy_preset)i, &desc);
            set_unless(s->L, merged, "tolerance", (double)desc.tolerance);
            set_unless(s->L, merged, "substeps", desc.substeps);
            return;
        }
    }
    sc_raise(s, SCENE_E_RANGE, site, "accuracy", 0, sc_suggest_best(&g),
             "'accuracy' of scene{} must be a preset, or a table with 'tolerance', not '%s'", name);
}

// accuracy = { tolerance = 1e-3 }, a number, or a preset: becomes `tolerance` and what the world begins with.
void sc_take_accuracy(scene *s, const sc_site *site, int merged)
{
    lua_State *L = s->L;
    if (sc_take_set(s, "accuracy")) {
        lua_setfield(L, merged, "accuracy");
        lua_pushnil(L);
        lua_setfield(L, merged, "tolerance"); // the command line comes last
    }
    const int type = lua_getfield(L, merged, "accuracy");
    const int value = lua_gettop(L);
    if (type == LUA_TSTRING) {
        take_preset(s, site, merged, lua_tostring(L, value));
    } else if (type == LUA_TTABLE) {
        for (lua_pushnil(L); lua_next(L, value) != 0; lua_pop(L, 1)) {
            if (lua_type(L, -2) != LUA_TSTRING || strcmp(lua_tostring(L, -2), "tolerance") != 0) {
                sc_raise(s, SCENE_E_KEY, site, "accuracy", 0, NULL,
                         "'accuracy' of scene{} has one key: tolerance");
            }
        }
        lua_getfield(L, value, "tolerance");
        lua_setfield(L, merged, "tolerance");
    } else if (type == LUA_TNUMBER) {
        lua_pushvalue(L, value);
        lua_setfield(L, merged, "tolerance");
    } else if (type != LUA_TNIL) {
        sc_raise(s, SCENE_E_TYPE, site, "accuracy", 0, NULL,
                 "'accuracy' of scene{} must be a preset, or a table with 'tolerance', not %s",
                 sc_type_name(s, value));
    }
    lua_pop(L, 1);
    lua_pushnil(L);
    lua_setfield(L, merged, "accuracy");
}
