// sandbox.c - the Lua state of a scene: an allow-list of names. The limits are in limits.c, the functions of Lua's
// libraries that do work in C in library.c.
//
// Nothing that catches errors (pcall, coroutines) is offered: the first error ends the script.
// Nothing that depends on addresses or hash seeds is offered: pairs is sorted, tostring of a table
// says "table", sort is a stable merge sort.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lualib.h>

#include "internal.h"

// ------------------------------------------------------------------------------ base functions

static int lua_tostring_plain(lua_State *L)
{
    luaL_checkany(L, 1);
    int type = lua_type(L, 1);
    if (type == LUA_TTABLE || type == LUA_TFUNCTION) {
        lua_pushstring(L, lua_typename(L, type));
    } else {
        luaL_tolstring(L, 1, NULL);
    }
    return 1;
}

static int lua_print(lua_State *L)
{
    scene *s = sc_of(L);
    luaL_Buffer buffer;
    int count = lua_gettop(L);
    luaL_buffinit(L, &buffer);
    for (int i = 1; i <= count; i++) {
        if (i > 1) {
            luaL_addchar(&buffer, '\t');
        }
        lua_pushcfunction(L, lua_tostring_plain);
        lua_pushvalue(L, i);
        lua_call(L, 1, 1);
        luaL_addvalue(&buffer);
    }
    luaL_pushresult(&buffer);
    sc_work(s, 100 + lua_rawlen(L, -1)); // a line takes a system call, and some microseconds
    if (s->options.print != NULL) {
        s->options.print(s->options.print_context, lua_tostring(L, -1));
    } else {
        fprintf(stderr, "%s\n", lua_tostring(L, -1));
    }
    return 0;
}

// assert, with the position that Lua's own leaves out.
static int lua_assert_placed(lua_State *L)
{
    luaL_checkany(L, 1);
    if (lua_toboolean(L, 1)) {
        return lua_gettop(L);
    }
    const char *message = luaL_optstring(L, 2, "assertion failed");
    return luaL_error(L, "%s", message);
}

// A name that the allow-list (or the script) does not have. Upvalue: what to call the table.
static int lua_strict_index(lua_State *L)
{
    scene *s = sc_of(L);
    const char *owner = lua_tostring(L, lua_upvalueindex(1));
    if (lua_type(L, 2) != LUA_TSTRING) {
        lua_pushnil(L);
        return 1;
    }
    const char *name = lua_tostring(L, 2);
    sc_suggest g = sc_suggest_start(name);
    for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) {
        if (lua_type(L, -2) == LUA_TSTRING) {
            sc_suggest_offer(&g, lua_tostring(L, -2));
        }
    }
    for (int i = 0; owner[0] == 0 && sc_other_names[i].elsewhere != NULL; i++) {
        if (strcmp(name, sc_other_names[i].elsewhere) == 0) {
            sc_suggest_force(&g, sc_other_names[i].here);
        }
    }
    sc_site site = sc_here(s, name);
    int column = sc_lua_column(s->source, s->source_size, site.line, name);
    char full[160], message[300];
    snprintf(full, sizeof full, "%s%s%.63s", owner, owner[0] != 0 ? "." : "", name);
    const char *instead = NULL;
    for (int i = 0; sc_absent_names[i].elsewhere != NULL; i++) {
        instead =
            strcmp(full, sc_absent_names[i].elsewhere) == 0 ? sc_absent_names[i].here : instead;
    }
    const char *gap = instead != NULL ? "; " : "", *rest = instead != NULL ? instead : "";
    if (owner[0] == 0) {
        snprintf(message, sizeof message, "unknown name '%.63s'%s%s", name, gap, rest);
    } else {
        snprintf(message, sizeof message, "%s has no '%.63s'%s%s", owner, name, gap, rest);
    }
    sc_set_error(s, SCENE_E_NAME, site.line, column, instead == NULL ? sc_suggest_best(&g) : NULL,
                 message);
    lua_settop(L, 0);
    lua_pushlightuserdata(L, s);
    return lua_error(L);
}

// ------------------------------------------------------------------------------ the environment

// What a C loop would do unseen by the hook is written in Lua, where it is counted.
static const char prelude[] =
    "local t = table\n"
    "local error, type = error, type\n"
    "function t.insert(a, i, v, ...)\n"
    "  if ... ~= nil then error('table.insert takes a list, a position and a value', 2) end\n"
    "  local n = #a\n"
    "  if v == nil then a[n + 1] = i return end\n"
    "  if i < 1 or i > n + 1 then error('table.insert: position out of bounds', 2) end\n"
    "  for k = n, i, -1 do a[k + 1] = a[k] end\n"
    "  a[i] = v\n"
    "end\n"
    "function t.remove(a, i)\n"
    "  local n = #a\n"
    "  i = i or n\n"
    "  if n == 0 then return nil end\n"
    "  if i < 1 or i > n then error('table.remove: position out of bounds', 2) end\n"
    "  local v = a[i]\n"
    "  for k = i, n - 1 do a[k] = a[k + 1] end\n"
    "  a[n] = nil\n"
    "  return v\n"
    "end\n"
    "local function less(a, b) return a < b end\n"
    "function t.sort(a, before)\n"
    "  before = before or less\n"
    "  local n, from, to, width = #a, a, {}, 1\n"
    "  while width < n do\n"
    "    for low = 1, n, 2 * width do\n"
    "      local i, mid = low, low + width\n"
    "      local j, high = mid, mid + width\n"
    "      if mid > n + 1 then mid = n + 1 end\n"
    "      if high > n + 1 then high = n + 1 end\n"
    "      for k = low, high - 1 do\n"
    "        if i < mid and (j >= high or not before(from[j], from[i])) then\n"
    "          to[k] = from[i] i = i + 1\n"
    "        else to[k] = from[j] j = j + 1 end\n"
    "      end\n"
    "    end\n"
    "    from, to, width = to, from, 2 * width\n"
    "  end\n"
    "  if from ~= a then for k = 1, n do a[k] = from[k] end end\n"
    "end\n";

// Copies the named functions of a library table (on top) into a new table and pushes that.
static void copy_allowed(lua_State *L, const char *const *names)
{
    lua_newtable(L);
    for (; *names != NULL; names++) {
        lua_getfield(L, -2, *names);
        lua_setfield(L, -2, *names);
    }
}

static void make_strict(lua_State *L, const char *owner)
{
    lua_newtable(L);
    lua_pushstring(L, owner);
    lua_pushcclosure(L, lua_strict_index, 1);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
}

static void open_base(lua_State *L)
{
    static const char *const base[] = { "error", "ipairs", "type", NULL };
    luaL_requiref(L, LUA_GNAME, luaopen_base, 0);
    copy_allowed(L, base);
    sc_copy_counted(L, "base");
    lua_pushvalue(L, -1); // this is the global table from now on
    lua_rawseti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
    lua_pushcfunction(L, lua_assert_placed);
    lua_setfield(L, -2, "assert");
    lua_pushcfunction(L, lua_print);
    lua_setfield(L, -2, "print");
    lua_pushcfunction(L, lua_tostring_plain);
    lua_setfield(L, -2, "tostring");
    lua_pop(L, 2);
    luaL_requiref(L, LUA_TABLIBNAME, luaopen_table, 0);
    lua_newtable(L);
    sc_copy_counted(L, "table");
    lua_setglobal(L, "table");
    lua_pop(L, 1);
}

static void open_string(lua_State *L)
{
    static const char *const names[] = { "len", "sub", NULL };
    luaL_requiref(L, LUA_STRLIBNAME, luaopen_string, 0);
    copy_allowed(L, names);
    sc_copy_counted(L, "string");
    make_strict(L, "string");
    lua_pushliteral(L, ""); // methods of strings come from the same table
    lua_getmetatable(L, -1);
    sc_count_arithmetic(L);
    lua_pushvalue(L, -3);
    lua_setfield(L, -2, "__index");
    lua_pop(L, 2);
    lua_setglobal(L, "string");
    lua_pop(L, 1);
}

static int open_protected(lua_State *L)
{
    open_base(L);
    open_string(L);
    sc_open_math(L);
    if (luaL_loadbufferx(L, prelude, sizeof prelude - 1, "=prelude", "t") != LUA_OK) {
        return lua_error(L);
    }
    lua_call(L, 0, 0);
    sc_open_shapes(L);
    sc_open_body(L);
    sc_open_motion(L);
    sc_open_liquid(L);
    sc_open_wet(L);
    sc_open_air(L);
    sc_open_waves(L);
    sc_open_heat(L);
    sc_open_light(L);
    sc_open_softbody(L);
    sc_open_laws(L);
    sc_open_characters(L);
    sc_open_queries(L);
    sc_open_build(L);
    sc_open_materials(L);
    sc_open_fluids(L);
    sc_open_filters(L);
    sc_open_joints(L);
    sc_open_joint(L);
    sc_open_handlers(L);
    sc_open_events(L);
    sc_open_told(L);
    sc_open_field(L);
    sc_open_expect(L);
    sc_open_json(L);
    lua_getglobal(L, "table");
    make_strict(L, "table");
    lua_getglobal(L, "math");
    make_strict(L, "math");
    lua_pushglobaltable(L);
    make_strict(L, "");
    lua_settop(L, 0);
    scene *s = sc_of(L);
    for (int i = 0; i < SC_PROTECTED_DEPTH; i++) {
        s->threads[i] = lua_newthread(L);
        lua_rawsetp(L, LUA_REGISTRYINDEX, &s->threads[i]);
    }
    return 0;
}

lua_State *sc_sandbox_open(scene *s)
{
    lua_State *L = lua_newstate(sc_lua_alloc, s);
    if (L == NULL) {
        return NULL;
    }
    *(scene **)lua_getextraspace(L) = s;
    s->L = L;
    lua_sethook(L, sc_count_hook, LUA_MASKCOUNT, SC_HOOK_STEP);
    lua_pushcfunction(L, open_protected);
    if (lua_pcall(L, 0, 0, 0) != LUA_OK) {
        s->L = NULL;
        lua_close(L);
        return NULL;
    }
    return L;
}

typedef struct protected_call {
    sc_protected_fn *run;
    void *argument;
} protected_call;

static int run_protected(lua_State *L)
{
    const protected_call *call = lua_touserdata(L, 1);
    lua_settop(L, 0);
    sc_need_stack(sc_of(L), 100);
    call->run(sc_of(L), call->argument);
    return 0;
}

// A thread and not lua_pcall: an error leaves the calls on a thread's stack as they stood, so that the
// line of one that has no message of its own (memory, limits) can still be told.
bool sc_protect(scene *s, sc_protected_fn *run, void *argument)
{
    protected_call call = { run, argument };
    lua_State *from = s->L;
    lua_State *thread = s->threads[s->protected_depth++];
    s->L = thread;
    lua_pushcfunction(thread, run_protected);
    lua_pushlightuserdata(thread, &call);
    int results;
    int status = lua_resume(thread, from, 1, &results);
    if (status != LUA_OK) {
        sc_take_error(s, status);
    }
    s->L = from;
    s->protected_depth--;
    return status == LUA_OK;
}
