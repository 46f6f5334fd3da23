// values.c - small readers and writers of Lua values, and the `present` bits of what a list has read.
// Cost: O(1) each, O(rows) for the bits.
#include <string.h>

#include "internal.h"

const char *sc_type_name(scene *s, int index)
{
    lua_State *L = s->L;
    plumb_body body;
    plumb_joint joint;
    switch (lua_type(L, index)) {
    case LUA_TNIL:
        return "nothing";
    case LUA_TBOOLEAN:
        return lua_toboolean(L, index) ? "true" : "false";
    case LUA_TNUMBER:
        return "a number";
    case LUA_TSTRING:
        return "a string";
    case LUA_TTABLE:
        return "a table";
    case LUA_TFUNCTION:
        return "a function";
    default:
        if (sc_to_material(L, index) != NULL) {
            return "a material";
        }
        if (sc_to_shape(L, index) != NULL) {
            return "a shape";
        }
        return sc_body_at_index(L, index, &body)     ? "a body"
               : sc_joint_at_index(L, index, &joint) ? "a joint"
               : sc_is_world(L, index)               ? "the world"
                                                     : "something else";
    }
}

bool sc_row_given(const sc_list *list, const void *def, int row)
{
    uint64_t present[SC_ROWS_MOST / 64] = { 0 };
    memcpy(present, def, list->count > 64 ? 2 * sizeof *present : sizeof *present);
    return (present[row / 64] >> row % 64 & 1) != 0;
}

void sc_row_mark(const sc_list *list, void *def, int row, bool given)
{
    uint64_t present[SC_ROWS_MOST / 64] = { 0 };
    const size_t bytes = list->count > 64 ? 2 * sizeof *present : sizeof *present;
    const uint64_t bit = (uint64_t)1 << row % 64;
    memcpy(present, def, bytes);
    present[row / 64] = given ? present[row / 64] | bit : present[row / 64] & ~bit;
    memcpy(def, present, bytes);
}

int sc_row_of(const sc_list *list, size_t offset)
{
    for (int i = 0; i < list->count; i++) {
        if (list->rows[i].offset == offset) {
            return i;
        }
    }
    return -1;
}

bool sc_given(const sc_list *list, const void *def, size_t offset)
{
    const int row = sc_row_of(list, offset);
    return row >= 0 && sc_row_given(list, def, row);
}

void sc_mark(const sc_list *list, void *def, size_t offset, bool given)
{
    for (int i = 0; i < list->count; i++) {
        if (list->rows[i].offset == offset) {
            sc_row_mark(list, def, i, given);
        }
    }
}

void sc_give(const sc_list *list, void *def, size_t offset)
{
    sc_mark(list, def, offset, true);
}

bool sc_to_vec2(scene *s, int index, double v[2])
{
    lua_State *L = s->L;
    int top = lua_gettop(L);
    if (lua_type(L, index) != LUA_TTABLE || lua_rawlen(L, index) != 2) {
        return false;
    }
    int count = 0;
    lua_pushnil(L);
    int at = index < 0 ? index - 1 : index;
    while (count <= 2 && lua_next(L, at) != 0) { // a third key is enough to know
        count++;
        lua_pop(L, 1);
    }
    lua_settop(L, top);
    for (int i = 0; i < 2; i++) {
        if (lua_rawgeti(L, index, i + 1) != LUA_TNUMBER) {
            lua_pop(L, 1);
            return false;
        }
        v[i] = lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    return count == 2;
}

static int hex_digit(char ch)
{
    return ch >= '0' && ch <= '9'   ? ch - '0'
           : ch >= 'a' && ch <= 'f' ? ch - 'a' + 10
           : ch >= 'A' && ch <= 'F' ? ch - 'A' + 10
                                    : -1;
}

bool sc_parse_color(const char *text, sc_color *out)
{
    uint8_t bytes[3];
    if (text[0] != '#' || strlen(text) != 7) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        int high = hex_digit(text[1 + 2 * i]);
        int low = hex_digit(text[2 + 2 * i]);
        if (high < 0 || low < 0) {
            return false;
        }
        bytes[i] = (uint8_t)(16 * high + low);
    }
    *out = (sc_color){ -1, { bytes[0], bytes[1], bytes[2], 255 } };
    return true;
}

int sc_push_vector(lua_State *L, plumb_vec2 v)
{
    lua_pushnumber(L, (double)v.x);
    lua_pushnumber(L, (double)v.y);
    return 2;
}

int sc_push_real(lua_State *L, plumb_real v)
{
    lua_pushnumber(L, (double)v);
    return 1;
}
