// math_lib.c - the names `math`, `random` and the angle helpers of scripts.
// sin and company come from det_math.c; floor, sqrt, fmod and the like are exact in IEEE arithmetic
// and are Lua's own. math.random is left out: random() and random_int() are seeded by scene{seed=}.
#include <math.h>

#include <lualib.h>

#include "internal.h"

static int math_sin(lua_State *L)
{
    lua_pushnumber(L, sc_sin(luaL_checknumber(L, 1)));
    return 1;
}

static int math_cos(lua_State *L)
{
    lua_pushnumber(L, sc_cos(luaL_checknumber(L, 1)));
    return 1;
}

static int math_tan(lua_State *L)
{
    double x = luaL_checknumber(L, 1);
    lua_pushnumber(L, sc_sin(x) / sc_cos(x));
    return 1;
}

static int math_atan(lua_State *L)
{
    lua_pushnumber(L, sc_atan2(luaL_checknumber(L, 1), luaL_optnumber(L, 2, 1.0)));
    return 1;
}

static int math_asin(lua_State *L)
{
    double x = luaL_checknumber(L, 1);
    lua_pushnumber(L, sc_atan2(x, sqrt((1 - x) * (1 + x))));
    return 1;
}

static int math_acos(lua_State *L)
{
    double x = luaL_checknumber(L, 1);
    lua_pushnumber(L, sc_atan2(sqrt((1 - x) * (1 + x)), x));
    return 1;
}

static int math_exp(lua_State *L)
{
    lua_pushnumber(L, sc_exp(luaL_checknumber(L, 1)));
    return 1;
}

static int math_log(lua_State *L)
{
    double x = sc_log(luaL_checknumber(L, 1));
    lua_pushnumber(L, lua_isnoneornil(L, 2) ? x : x / sc_log(luaL_checknumber(L, 2)));
    return 1;
}

static int math_pow(lua_State *L)
{
    lua_pushnumber(L, sc_pow(luaL_checknumber(L, 1), luaL_checknumber(L, 2)));
    return 1;
}

static int lua_random(lua_State *L)
{
    scene *s = sc_of(L);
    if (lua_gettop(L) == 0) {
        lua_pushnumber(L, sc_random(s));
        return 1;
    }
    double low = luaL_checknumber(L, 1);
    double high = luaL_checknumber(L, 2);
    luaL_argcheck(L, isfinite(low) && isfinite(high) && low <= high, 2,
                  "must be finite and not below #1");
    lua_pushnumber(L, low + (high - low) * sc_random(s));
    return 1;
}

static int lua_random_int(lua_State *L)
{
    scene *s = sc_of(L);
    lua_Integer low = luaL_checkinteger(L, 1);
    lua_Integer high = luaL_checkinteger(L, 2);
    const lua_Integer most = (lua_Integer)1 << 53; // what 53 random bits can tell apart
    luaL_argcheck(L, low <= high && low > -most / 2 && high < most / 2, 2,
                  "must be small and not below #1");
    lua_pushinteger(L, low + (lua_Integer)(sc_random(s) * (double)(high - low + 1)));
    return 1;
}

static int lua_radians(lua_State *L)
{
    lua_pushnumber(L, luaL_checknumber(L, 1) * (3.141592653589793 / 180));
    return 1;
}

static int lua_degrees(lua_State *L)
{
    lua_pushnumber(L, luaL_checknumber(L, 1) * (180 / 3.141592653589793));
    return 1;
}

void sc_open_math(lua_State *L)
{
    static const char *const exact[] = { "abs", "ceil",       "floor",     "fmod",       "huge",
                                         "max", "maxinteger", "min",       "mininteger", "modf",
                                         "pi",  "sqrt",       "tointeger", "type",       "ult" };
    static const luaL_Reg ours[] = {
        { "sin", math_sin },   { "cos", math_cos },   { "tan", math_tan }, { "atan", math_atan },
        { "asin", math_asin }, { "acos", math_acos }, { "exp", math_exp }, { "log", math_log },
        { "pow", math_pow },   { NULL, NULL },
    };
    luaL_requiref(L, LUA_MATHLIBNAME, luaopen_math, 0);
    lua_newtable(L);
    for (size_t i = 0; i < sizeof exact / sizeof *exact; i++) {
        lua_getfield(L, -2, exact[i]);
        lua_setfield(L, -2, exact[i]);
    }
    luaL_setfuncs(L, ours, 0);
    lua_setglobal(L, "math");
    lua_pop(L, 1);
    lua_register(L, "random", lua_random);
    lua_register(L, "random_int", lua_random_int);
    lua_register(L, "radians", lua_radians);
    lua_register(L, "degrees", lua_degrees);
}
