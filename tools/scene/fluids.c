// fluids.c - water{} and wind{}: a material that is a fluid and a body of sensors of it, in one table; fluid_at(): what flows.
//
// Keys of materials make the material, `flow` its flow_x and flow_y, all others the body: JSON has the two as such.
// Cost: that of material{} and body{}.
#include <string.h>

#include "internal.h"

static bool is_of_material(const char *key)
{
    for (int i = 0; i < sc_list_material.count; i++) {
        if (strcmp(sc_list_material.rows[i].name, key) == 0) {
            return strcmp(key, "name") != 0;
        }
    }
    return false;
}

static void set_number(lua_State *L, int table, const char *key, double value)
{
    lua_pushnumber(L, value);
    lua_setfield(L, table, key);
}

static void set_bool(lua_State *L, int table, const char *key)
{
    lua_pushboolean(L, 1);
    lua_setfield(L, table, key);
}

// Moves what is said of the fluid from `from` into the material's table.
static void split(scene *s, const sc_site *site, int from, int material, int body)
{
    lua_State *L = s->L;
    for (lua_pushnil(L); lua_next(L, from) != 0;) {
        const bool named = lua_type(L, -2) == LUA_TSTRING;
        const char *key = named ? lua_tostring(L, -2) : "";
        if (strcmp(key, "flow") == 0) {
            const bool pair = lua_istable(L, -1) && lua_rawlen(L, -1) == 2;
            for (int axis = 0; axis < 2 && pair; axis++) {
                lua_rawgeti(L, -1, axis + 1);
                lua_setfield(L, material, axis == 0 ? "flow_x" : "flow_y");
            }
            if (!pair) {
                sc_raise(s, SCENE_E_TYPE, site, key, 0, NULL, "'flow' of %s{} must be {x, y}",
                         site->construct);
            }
            lua_pop(L, 1);
            continue;
        }
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, is_of_material(key) ? material : body);
    }
}

void sc_offer_fluid_keys(const sc_site *site, sc_suggest *g)
{
    if (strcmp(site->construct, "water") != 0 && strcmp(site->construct, "wind") != 0) {
        return;
    }
    sc_suggest_offer(g, "flow");
    for (int i = 0; i < sc_list_material.count; i++) {
        sc_suggest_offer(g, sc_list_material.rows[i].name);
    }
}

// Leaves the body on the stack; `wind`: of nothing more than air.
static void build_fluid(scene *s, const sc_site *site, int table, bool wind)
{
    lua_State *L = s->L;
    sc_need_stack(s, 20);
    table = lua_absindex(L, table);
    lua_newtable(L);
    lua_newtable(L);
    const int body = lua_gettop(L), material = body - 1;
    set_number(L, material, "density", wind ? 1.2 : 1000);
    set_bool(L, material, "fluid");
    lua_pushstring(L, "static");
    lua_setfield(L, body, "type");
    set_bool(L, body, "sensor");
    if (wind) {
        set_bool(L, material, "weightless");
        set_bool(L, body, "hidden");
    }
    split(s, site, table, material, body);
    sc_build_material(s, site, material);
    lua_setfield(L, body, "material");
    sc_build_body(s, site, body);
    lua_replace(L, table);
    lua_settop(L, table);
}

static void build_water(scene *s, const sc_site *site, int table)
{
    build_fluid(s, site, table, false);
}

static void build_wind(scene *s, const sc_site *site, int table)
{
    build_fluid(s, site, table, true);
}

static int lua_water(lua_State *L)
{
    return sc_construct(L, "water", build_water, 1);
}

static int lua_wind(lua_State *L)
{
    return sc_construct(L, "wind", build_wind, 1);
}

// fluid_at(x, y): velocity and density of the fluid there.
static int lua_fluid_at(lua_State *L)
{
    scene *s = sc_of(L);
    const plumb_vec2 at = { (plumb_real)luaL_checknumber(L, 1),
                            (plumb_real)luaL_checknumber(L, 2) };
    sc_need_world(s);
    sc_query_work(s);
    const plumb_fluid_sample f = plumb_fluid_at(s->world, at);
    lua_pushnumber(L, (double)f.velocity.x);
    lua_pushnumber(L, (double)f.velocity.y);
    lua_pushnumber(L, (double)f.density);
    return 3;
}

void sc_open_fluids(lua_State *L)
{
    lua_register(L, "fluid_at", lua_fluid_at);
    lua_register(L, "water", lua_water);
    lua_register(L, "wind", lua_wind);
}
