// library.c - the functions of Lua's libraries whose work grows with what they are given. Lua counts a call of one
// as one instruction, however long it takes: here each counts what it touches before, or while, it does.
// To offer one more: a row of `rows`. Functions that copy no more than Lua allocates (string.sub) need none.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "internal.h"

enum {
    BYTES_READ = 8,      // of a text that is looked at byte by byte, for one instruction
    BYTES_COMPARED = 32, // by memchr and memcmp
    UNPACK_MAX =
        10000 // [-] most values of table.unpack: `...` is copied by every call that passes it on
};

// The original function, called in place: its messages name what the script has called.
static int call_original(lua_State *L)
{
    return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

// Upvalue 1: the original. Counts the arguments, the bytes of those that are strings, and the results.
static int lua_counted(lua_State *L)
{
    int count = lua_gettop(L);
    uint64_t work = (uint64_t)count;
    for (int i = 1; i <= count; i++) {
        work += lua_type(L, i) == LUA_TSTRING ? lua_rawlen(L, i) / BYTES_READ : 0;
    }
    sc_work(sc_of(L), work);
    int results = call_original(L);
    if (results > 8) {
        sc_work(sc_of(L), (uint64_t)results);
    }
    return results;
}

// How many elements from..to of a list are; as most as if the list reached so far.
static uint64_t span(lua_State *L, int from_index, int to_index)
{
    lua_Integer from = luaL_optinteger(L, from_index, 1);
    lua_Integer to = lua_isnoneornil(L, to_index) ? (lua_Integer)lua_rawlen(L, 1)
                                                  : luaL_checkinteger(L, to_index);
    return to < from ? 0 : (uint64_t)to - (uint64_t)from + 1;
}

static int lua_concat_counted(lua_State *L)
{
    luaL_checktype(L, 1, LUA_TTABLE);
    sc_work(sc_of(L), 4 * span(L, 3, 4) + 2);
    return call_original(L);
}

static int lua_unpack_counted(lua_State *L)
{
    luaL_checktype(L, 1, LUA_TTABLE);
    uint64_t count = span(L, 2, 3);
    luaL_argcheck(L, count <= UNPACK_MAX, 1, "has more than the 10000 values that unpack gives");
    sc_work(sc_of(L), count + 2);
    return call_original(L);
}

// ---------------------------------------------------------------------------------------- pairs

/// A key of a table while it is sorted.
typedef struct sort_key {
    const char *text; ///< null: a number
    size_t length;
    bool is_integer; ///< `integer` is the number
    lua_Integer integer;
    double number; ///< of integers the nearest
} sort_key;

// Lua turns numbers that are integers into integers, so a float among keys is none, or beyond all of them: where the
// nearest double of an integer equals one, that is 2^63, above all integers.
static int compare_numbers(const sort_key *a, const sort_key *b)
{
    if (a->is_integer && b->is_integer) {
        return (a->integer > b->integer) - (a->integer < b->integer);
    }
    int order = (a->number > b->number) - (a->number < b->number);
    return order != 0 ? order : b->is_integer - a->is_integer;
}

static int compare_keys(const void *pa, const void *pb)
{
    const sort_key *a = pa;
    const sort_key *b = pb;
    if (a->text == NULL || b->text == NULL) {
        return a->text != NULL ? 1 : b->text != NULL ? -1 : compare_numbers(a, b);
    }
    size_t shorter = a->length < b->length ? a->length : b->length;
    int order = memcmp(a->text, b->text, shorter);
    return order != 0 ? order : (a->length > b->length) - (a->length < b->length);
}

// Upvalues: table, sorted keys, how many were handed out.
static int pairs_next(lua_State *L)
{
    const sort_key *keys = lua_touserdata(L, lua_upvalueindex(2));
    lua_Integer count = (lua_Integer)(lua_rawlen(L, lua_upvalueindex(2)) / sizeof *keys);
    for (lua_Integer i = lua_tointeger(L, lua_upvalueindex(3)); i < count; i++) {
        lua_pushinteger(L, i + 1);
        lua_replace(L, lua_upvalueindex(3));
        if (lua_rawgeti(L, lua_upvalueindex(4), i + 1) == LUA_TNIL) {
            lua_pop(L, 1);
            continue;
        }
        lua_pushvalue(L, -1);
        if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) { // else removed meanwhile
            return 2;
        }
        lua_pop(L, 2);
    }
    return 0;
}

// Pushes a table of the keys of the table at 1 in the order of `keys`.
static void push_sorted(lua_State *L, const sort_key *keys, size_t count)
{
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        if (keys[i].text != NULL) {
            lua_pushlstring(L, keys[i].text, keys[i].length);
        } else if (keys[i].is_integer) {
            lua_pushinteger(L, keys[i].integer);
        } else {
            lua_pushnumber(L, keys[i].number);
        }
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

static int lua_sorted_pairs(lua_State *L)
{
    luaL_checktype(L, 1, LUA_TTABLE);
    size_t count = 0;
    lua_settop(L, 1);
    for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) {
        count++;
    }
    // A look at a key and its part of the sorting; and the empty places of a table that was large, which nobody counts.
    sc_work(sc_of(L), 8 * count + 100);
    sort_key *keys = lua_newuserdatauv(L, count * sizeof *keys, 0);
    size_t i = 0;
    for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) {
        keys[i] = (sort_key){ 0 };
        if (lua_type(L, -2) == LUA_TSTRING) {
            keys[i].text = lua_tolstring(L, -2, &keys[i].length);
        } else if (lua_type(L, -2) == LUA_TNUMBER) {
            keys[i].is_integer = lua_isinteger(L, -2);
            keys[i].integer = keys[i].is_integer ? lua_tointeger(L, -2) : 0;
            keys[i].number = lua_tonumber(L, -2);
        } else {
            return luaL_error(L, "pairs needs keys that are numbers or strings, not %s",
                              luaL_typename(L, -2));
        }
        i++;
    }
    if (count > 0) {
        qsort(keys, count, sizeof *keys, compare_keys);
    }
    lua_pushvalue(L, 1);         // upvalue 1
    lua_pushvalue(L, 2);         // upvalue 2
    lua_pushinteger(L, 0);       // upvalue 3
    push_sorted(L, keys, count); // upvalue 4
    lua_pushcclosure(L, pairs_next, 4);
    return 1;
}

// --------------------------------------------------------------------------------------- strings

static int lua_rep(lua_State *L)
{
    size_t length;
    size_t gap = 0;
    luaL_checklstring(L, 1, &length);
    lua_Integer n = luaL_checkinteger(L, 2);
    luaL_optlstring(L, 3, "", &gap);
    if (n <= 0 || length + gap == 0) { // Lua's own would loop n times over nothing
        lua_pushliteral(L, "");
        return 1;
    }
    if ((uint64_t)n > SC_STRING_MAX / (length + gap)) {
        return luaL_error(L, "a string of more than %d bytes was made", (int)SC_STRING_MAX);
    }
    sc_work(sc_of(L), (uint64_t)n); // a copy each
    return call_original(L);
}

// string.format without %p, and without addresses of tables behind %s.
static int lua_format(lua_State *L)
{
    int count = lua_gettop(L);
    const char *format = luaL_checkstring(L, 1);
    for (const char *p = strchr(format, '%'); p != NULL; p = strchr(p, '%')) {
        p++;
        p += strspn(p, "-+ #0123456789.");
        if (*p == 'p') {
            return luaL_error(L, "format does not offer %%p: addresses differ from run to run");
        }
        p += *p != 0;
    }
    for (int i = 2; i <= count; i++) {
        if (lua_type(L, i) == LUA_TTABLE || lua_type(L, i) == LUA_TFUNCTION) {
            lua_pushstring(L, luaL_typename(L, i));
            lua_replace(L, i);
        }
    }
    return lua_counted(L);
}

// Where `word` begins in text[0..n), SIZE_MAX: nowhere. Counts as it goes: a text of one letter and a word that ends in
// another are compared in full at every place.
static size_t find_word(scene *s, const char *text, size_t n, const char *word, size_t m)
{
    const char *at = text;
    uint64_t work = 2;
    while ((size_t)(text + n - at) >= m) {
        const char *next = m == 0 ? at : memchr(at, word[0], (size_t)(text + n - at) - m + 1);
        const char *passed = next != NULL ? next : text + n;
        work += 2 + (uint64_t)(passed - at) / BYTES_COMPARED + m / BYTES_COMPARED;
        if (work > SC_HOOK_STEP) {
            sc_work(s, work);
            work = 0;
        }
        if (next == NULL) {
            break;
        }
        if (memcmp(next, word, m) == 0) {
            sc_work(s, work);
            return (size_t)(next - text);
        }
        at = next + 1;
    }
    sc_work(s, work);
    return SIZE_MAX;
}

// string.find of plain text: Lua's patterns can take exponential time that no hook sees.
static int lua_find(lua_State *L)
{
    size_t n, m;
    const char *text = luaL_checklstring(L, 1, &n);
    const char *word = luaL_checklstring(L, 2, &m);
    lua_Integer from = luaL_optinteger(L, 3, 1);
    from = from < 0 && from >= -(lua_Integer)n ? (lua_Integer)n + from + 1 : from < 1 ? 1 : from;
    size_t skip = (size_t)from - 1;
    size_t at = skip <= n ? find_word(sc_of(L), text + skip, n - skip, word, m) : SIZE_MAX;
    if (at == SIZE_MAX) {
        lua_pushnil(L);
        lua_pushnil(L);
        return 2;
    }
    lua_pushinteger(L, (lua_Integer)(skip + at) + 1);
    lua_pushinteger(L, (lua_Integer)(skip + at + m));
    return 2;
}

// ------------------------------------------------------------------------------- what is offered

static const struct {
    const char *library, *name;
    lua_CFunction counted;
} rows[] = {
    { "base", "pairs", lua_sorted_pairs }, { "base", "select", lua_counted },
    { "base", "tonumber", lua_counted },   { "table", "concat", lua_concat_counted },
    { "table", "pack", lua_counted },      { "table", "unpack", lua_unpack_counted },
    { "string", "byte", lua_counted },     { "string", "char", lua_counted },
    { "string", "find", lua_find },        { "string", "format", lua_format },
    { "string", "lower", lua_counted },    { "string", "rep", lua_rep },
    { "string", "reverse", lua_counted },  { "string", "upper", lua_counted },
};

void sc_copy_counted(lua_State *L, const char *library)
{
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (strcmp(rows[i].library, library) == 0) {
            lua_getfield(L, -2, rows[i].name);
            lua_pushcclosure(L, rows[i].counted, 1);
            lua_setfield(L, -2, rows[i].name);
        }
    }
}

void sc_count_arithmetic(lua_State *L)
{
    static const char *const names[] = { "__add", "__sub", "__mul",  "__mod",
                                         "__pow", "__div", "__idiv", "__unm" };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        lua_getfield(L, -1, names[i]);
        lua_pushcclosure(L, lua_counted, 1);
        lua_setfield(L, -2, names[i]);
    }
}
