// fields.c - a Lua table becomes a struct, as the constructor's list (lists.c) says.
// Reads: a table without metatable, the list. Writes: the struct, s->points, function references.
// Everything that the list does not allow is an error that names key, value and what was expected.
// Cost: O(keys * rows) string comparisons; a body with four keys takes about a microsecond.
#include <math.h>
#include <string.h>

#include "internal.h"

static const sc_field *find_row(const sc_list *list, const char *name)
{
    for (int i = 0; i < list->count; i++) {
        if (strcmp(list->rows[i].name, name) == 0) {
            return &list->rows[i];
        }
    }
    return NULL;
}

// ---------------------------------------------------------------------------------- one value

void sc_fail_type(const sc_context *c, const char *expected, int value)
{
    sc_raise(c->s, SCENE_E_TYPE, c->site, c->row->name, c->index, NULL,
             "'%s' of %s{} must be %s, not %s", c->row->name, c->site->construct, expected,
             sc_type_name(c->s, value));
}

static void check_number(const sc_context *c, double v)
{
    const sc_field *row = c->row;
    bool low = (row->flags & SC_ABOVE) != 0 ? v <= row->min : v < row->min;
    if (!isfinite(v)) {
        sc_raise(c->s, SCENE_E_RANGE, c->site, row->name, c->index, NULL,
                 "'%s' of %s{} must be finite, not %s", row->name, c->site->construct,
                 isnan(v) ? "nan"
                 : v > 0  ? "inf"
                          : "-inf");
    }
    if (low || v > row->max) {
        bool unit = row->detail != NULL && strcmp(row->detail, "1") != 0;
        sc_raise(c->s, SCENE_E_RANGE, c->site, row->name, c->index, NULL,
                 "'%s' of %s{} must be %s %.10g and at most %.10g%s%s, not %.10g", row->name,
                 c->site->construct, (row->flags & SC_ABOVE) != 0 ? "above" : "at least", row->min,
                 row->max, unit ? " " : "", unit ? row->detail : "", v);
    }
}

static void read_number(const sc_context *c, int value, double *out)
{
    lua_State *L = c->s->L;
    if (lua_type(L, value) != LUA_TNUMBER) {
        sc_fail_type(c, c->row->kind == SC_INTEGER ? "an integer" : "a number", value);
    }
    double v = lua_tonumber(L, value);
    check_number(c, v);
    if (c->row->kind == SC_INTEGER && v != floor(v)) {
        sc_raise(c->s, SCENE_E_TYPE, c->site, c->row->name, c->index, NULL,
                 "'%s' of %s{} must be an integer, not %.10g", c->row->name, c->site->construct, v);
    }
    *out = v;
}

static void read_vec2(const sc_context *c, int value, double out[2])
{
    if (!sc_to_vec2(c->s, value, out)) {
        if (lua_type(c->s->L, value) == LUA_TTABLE) {
            sc_raise(c->s, SCENE_E_TYPE, c->site, c->row->name, c->index, NULL,
                     "'%s' of %s{} must be two numbers {x, y}", c->row->name, c->site->construct);
        }
        sc_fail_type(c, "two numbers {x, y}", value);
    }
    check_number(c, out[0]);
    check_number(c, out[1]);
}

static void read_range(const sc_context *c, int value, double out[2])
{
    if (lua_type(c->s->L, value) == LUA_TNUMBER) {
        out[0] = out[1] = lua_tonumber(c->s->L, value);
        check_number(c, out[0]);
        return;
    }
    if (!sc_to_vec2(c->s, value, out) || isnan(out[0]) || isnan(out[1])) {
        sc_raise(c->s, SCENE_E_TYPE, c->site, c->row->name, c->index, NULL,
                 "'%s' of %s{} must be a number or a range {min, max}", c->row->name,
                 c->site->construct);
    }
    if (out[0] > out[1]) {
        sc_raise(c->s, SCENE_E_RANGE, c->site, c->row->name, c->index, NULL,
                 "'%s' of %s{} is empty: min %.10g is above max %.10g", c->row->name,
                 c->site->construct, out[0], out[1]);
    }
}

void sc_read_string(const sc_context *c, int value, char *out, size_t size)
{
    size_t length;
    if (lua_type(c->s->L, value) != LUA_TSTRING) {
        sc_fail_type(c, "a string", value);
    }
    const char *text = lua_tolstring(c->s->L, value, &length);
    if (length >= size || strlen(text) != length) {
        sc_raise(c->s, SCENE_E_RANGE, c->site, c->row->name, c->index, NULL,
                 "'%s' of %s{} must be at most %d characters without zeros", c->row->name,
                 c->site->construct, (int)size - 1);
    }
    if (length == 0 && strcmp(c->row->name, "name") == 0) {
        sc_raise(c->s, SCENE_E_RANGE, c->site, c->row->name, c->index, NULL,
                 "'name' of %s{} must not be empty", c->site->construct);
    }
    memcpy(out, text, length + 1);
}

static void read_choice(const sc_context *c, int value, int *out)
{
    if (lua_type(c->s->L, value) != LUA_TSTRING) {
        sc_fail_type(c, "a string", value);
    }
    const char *text = lua_tostring(c->s->L, value);
    sc_suggest g = sc_suggest_start(text);
    int number = 0;
    for (const char *p = c->row->detail; *p != 0; number++) {
        char option[SC_NAME_SIZE];
        size_t length = strcspn(p, "|");
        memcpy(option, p, length);
        option[length] = 0;
        if (strcmp(option, text) == 0) {
            *out = number;
            return;
        }
        sc_suggest_offer(&g, option);
        p += length + (p[length] == '|');
    }
    sc_raise(c->s, SCENE_E_RANGE, c->site, c->row->name, c->index, sc_suggest_best(&g),
             "'%s' of %s{} must be one of %s, not '%.40s'", c->row->name, c->site->construct,
             c->row->detail, text);
}

static void read_color(const sc_context *c, int value, sc_color *out)
{
    lua_State *L = c->s->L;
    if (lua_type(L, value) == LUA_TNUMBER) {
        double v = lua_tonumber(L, value);
        if (v >= 0 && v <= 1000 && v == floor(v)) {
            *out = (sc_color){ (int)v, { 0 } };
            return;
        }
    } else if (lua_type(L, value) == LUA_TSTRING && sc_parse_color(lua_tostring(L, value), out)) {
        return;
    }
    sc_raise(c->s, SCENE_E_TYPE, c->site, c->row->name, c->index, NULL,
             "'%s' of %s{} must be \"#rrggbb\" or a palette number 0..1000", c->row->name,
             c->site->construct);
}

static void read_box(const sc_context *c, int value, double out[4])
{
    lua_State *L = c->s->L;
    bool good = lua_type(L, value) == LUA_TTABLE && lua_rawlen(L, value) == 2;
    for (int i = 0; i < 2 && good; i++) {
        lua_rawgeti(L, value, i + 1);
        good = sc_to_vec2(c->s, -1, out + 2 * i);
        lua_pop(L, 1);
    }
    if (!good) {
        sc_raise(c->s, SCENE_E_TYPE, c->site, c->row->name, c->index, NULL,
                 "'%s' of %s{} must be two corners {{x, y}, {x, y}}", c->row->name,
                 c->site->construct);
    }
    for (int i = 0; i < 4; i++) {
        check_number(c, out[i]);
    }
    for (int i = 0; i < 2; i++) {
        double low = fmin(out[i], out[i + 2]);
        out[i + 2] = fmax(out[i], out[i + 2]);
        out[i] = low;
    }
    if (out[0] == out[2] || out[1] == out[3]) {
        sc_raise(c->s, SCENE_E_RANGE, c->site, c->row->name, c->index, NULL,
                 "'%s' of %s{} is an empty box", c->row->name, c->site->construct);
    }
}

static void read_points(const sc_context *c, int value, int *out)
{
    scene *s = c->s;
    if (lua_type(s->L, value) != LUA_TTABLE) {
        sc_fail_type(c, "points {{x, y}, ...}", value);
    }
    lua_Unsigned count = lua_rawlen(s->L, value);
    if ((double)count < c->row->min || (double)count > c->row->max) {
        if (c->row->min == c->row->max) {
            sc_raise(s, SCENE_E_RANGE, c->site, NULL, 0, NULL, "%s{} needs %d points, not %d",
                     c->site->construct, (int)c->row->min, (int)count);
        }
        sc_raise(s, SCENE_E_RANGE, c->site, NULL, 0, NULL, "%s{} needs %d to %d points, not %d",
                 c->site->construct, (int)c->row->min, (int)c->row->max, (int)count);
    }
    if ((int)count > s->point_capacity) {
        s->points = sc_need(s, s->points, (size_t)s->point_capacity * sizeof *s->points,
                            count * sizeof *s->points);
        s->point_capacity = (int)count;
    }
    for (int i = 0; i < (int)count; i++) {
        lua_rawgeti(s->L, value, i + 1);
        if (!sc_to_vec2(s, -1, s->points[i])) {
            sc_raise(s, SCENE_E_TYPE, c->site, NULL, i + 1, NULL,
                     "point %d of %s{} must be two numbers {x, y}, not %s", i + 1,
                     c->site->construct,
                     lua_type(s->L, -1) == LUA_TTABLE ? "another table" : sc_type_name(s, -1));
        }
        for (int k = 0; k < 2; k++) {
            double v = s->points[i][k];
            if (!isfinite(v) || fabs(v) > 1e7) { // PLUMB_LENGTH_MAX
                sc_raise(s, SCENE_E_RANGE, c->site, NULL, i + 1, NULL,
                         "point %d of %s{} must lie within 1e+07 m of the origin", i + 1,
                         c->site->construct);
            }
        }
        lua_pop(s->L, 1);
    }
    s->point_count = (int)count;
    *out = (int)count;
}

static void read_shapes(const sc_context *c, int value, int *out)
{
    lua_State *L = c->s->L;
    if (lua_type(L, value) != LUA_TTABLE) {
        sc_fail_type(c, "shapes", value);
    }
    *out = (int)lua_rawlen(L, value);
    for (int i = 1; i <= *out; i++) {
        lua_rawgeti(L, value, i);
        if (sc_to_shape(L, -1) == NULL) {
            sc_raise(c->s, SCENE_E_TYPE, c->site, NULL, i, NULL,
                     "value %d in %s{} must be a shape such as box{1, 1}, not %s", i,
                     c->site->construct, sc_type_name(c->s, -1));
        }
        lua_pop(L, 1);
    }
}

// {"x", "y", "rotation"}, in any order, or one of them.
static void read_axes(const sc_context *c, int value, int *out)
{
    lua_State *L = c->s->L;
    bool is_table = lua_type(L, value) == LUA_TTABLE;
    int count = is_table ? (int)lua_rawlen(L, value) : 1;
    *out = 0;
    for (int i = 1; i <= count; i++) {
        if (is_table) {
            lua_rawgeti(L, value, i);
        } else {
            lua_pushvalue(L, value);
        }
        int bit = lua_type(L, -1) == LUA_TSTRING ? sc_axis_bit(lua_tostring(L, -1)) : 0;
        if (bit == 0 || (*out & bit) != 0) {
            sc_raise(c->s, SCENE_E_TYPE, c->site, c->row->name, c->index, NULL,
                     "'%s' of %s{} must be a list of \"x\", \"y\", \"rotation\", each once",
                     c->row->name, c->site->construct);
        }
        *out |= bit;
        lua_pop(L, 1);
    }
}

static void read_limits(const sc_context *c, int value, double out[2])
{
    if (!sc_to_vec2(c->s, value, out)) {
        sc_fail_type(c, "two numbers {lower, upper}", value);
    }
    check_number(c, out[0]);
    check_number(c, out[1]);
    if (out[0] > out[1]) {
        sc_raise(c->s, SCENE_E_RANGE, c->site, c->row->name, c->index, NULL,
                 "'%s' of %s{} is empty: lower %.10g is above upper %.10g", c->row->name,
                 c->site->construct, out[0], out[1]);
    }
}

static void read_numbers(const sc_context *c, int value, double *out)
{
    lua_State *L = c->s->L;
    size_t count = c->row->size / sizeof *out;
    bool good = lua_type(L, value) == LUA_TTABLE && lua_rawlen(L, value) == count;
    for (size_t i = 0; i < count && good; i++) {
        good = lua_rawgeti(L, value, (lua_Integer)i + 1) == LUA_TNUMBER;
        out[i] = lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    if (!good) {
        sc_raise(c->s, SCENE_E_TYPE, c->site, c->row->name, c->index, NULL,
                 "'%s' of %s{} must be %d numbers", c->row->name, c->site->construct, (int)count);
    }
    for (size_t i = 0; i < count; i++) {
        check_number(c, out[i]);
    }
}

// A table in the table, with a list of its own: motor = { speed = 3, torque = 10 }.
static void read_record(const sc_context *c, int value, void *out)
{
    char path[200];
    if (lua_type(c->s->L, value) != LUA_TTABLE) {
        sc_fail_type(c, "a table {...}", value);
    }
    sc_site inner = { .construct = c->row->name, .line = c->site->line };
    inner.outer = c->site->construct;
    if (c->site->path != NULL) {
        snprintf(path, sizeof path, "%s.%s", c->site->path, c->row->name);
        inner.path = path;
    }
    sc_read(c->s, &inner, sc_list_named(c->row->detail), value, out);
}

static void read_value(const sc_context *c, int value, void *out)
{
    lua_State *L = c->s->L;
    void *member = (char *)out + c->row->offset;
    switch (c->row->kind) {
    case SC_NUMBER:
    case SC_INTEGER:
        read_number(c, value, member);
        break;
    case SC_BOOL:
        if (lua_type(L, value) != LUA_TBOOLEAN) {
            sc_fail_type(c, "true or false", value);
        }
        *(bool *)member = lua_toboolean(L, value) != 0;
        break;
    case SC_STRING:
        sc_read_string(c, value, member, c->row->size);
        break;
    case SC_VEC2:
        read_vec2(c, value, member);
        break;
    case SC_CHOICE:
        read_choice(c, value, member);
        break;
    case SC_RANGE:
        read_range(c, value, member);
        break;
    case SC_COLOR:
        read_color(c, value, member);
        break;
    case SC_MATERIAL:
        if (sc_to_material(L, value) == NULL) {
            sc_fail_type(c, "a material", value);
        }
        *(sc_material **)member = sc_to_material(L, value);
        (*(sc_material **)member)->used |= (c->row->flags & SC_MENTION) == 0;
        break;
    case SC_POINTS:
        read_points(c, value, member);
        break;
    case SC_FUNCTION:
        if (lua_type(L, value) != LUA_TFUNCTION) {
            sc_fail_type(c, "a function", value);
        }
        lua_pushvalue(L, value);
        *(int *)member = luaL_ref(L, LUA_REGISTRYINDEX);
        break;
    case SC_BODY:
        sc_read_body(c, value, member);
        break;
    case SC_BOX:
        read_box(c, value, member);
        break;
    case SC_SHAPES:
        read_shapes(c, value, member);
        break;
    case SC_AXES:
        read_axes(c, value, member);
        break;
    case SC_TABLE:
        if (lua_type(L, value) != LUA_TTABLE) {
            sc_fail_type(c, "a table", value);
        }
        *(bool *)member = true;
        break;
    case SC_LIMITS:
        read_limits(c, value, member);
        break;
    case SC_NUMBERS:
        read_numbers(c, value, member);
        break;
    case SC_RECORD:
        read_record(c, value, member);
        break;
    case SC_NAMES:
        *(uint64_t *)member = sc_read_names(c, value);
        break;
    case SC_END:
        sc_read_end(c, value, member);
        break;
    case SC_JOINT:
        sc_read_joint(c, value, member);
        break;
    }
}

// ---------------------------------------------------------------------------------- the table

// Most elements that the array part may have; -1: any number.
static int positions(const sc_list *list)
{
    int most = 0;
    for (int i = 0; i < list->count; i++) {
        if (list->rows[i].position == SC_REST) {
            return -1;
        }
        most = list->rows[i].position > most ? list->rows[i].position : most;
    }
    return most;
}

// "; it belongs to material{}", or nothing: whose the key is, when it is none of this list.
static void name_owners(const char *key, char *out, size_t size)
{
    enum { MOST = 3 };
    const sc_list *owners[MOST];
    int count = 0;
    for (int i = 0; sc_list_at(i) != NULL; i++) {
        if (find_row(sc_list_at(i), key) != NULL) {
            if (count < MOST) {
                owners[count] = sc_list_at(i);
            }
            count++;
        }
    }
    size_t used = 0;
    for (int i = 0; i < count && i < MOST && used < size; i++) {
        bool last = i == count - 1;
        const char *before = i == 0 ? "; it belongs to " : last ? " or " : ", ";
        used += (size_t)snprintf(out + used, size - used, "%s%s{}", before, owners[i]->name);
    }
    if (count > MOST && used < size) {
        snprintf(out + used, size - used, " and others");
    }
}

_Noreturn static void fail_key(scene *s, const sc_site *site, const sc_list *list, const char *key)
{
    sc_suggest g = sc_suggest_start(key);
    for (int i = 0; i < list->count; i++) {
        sc_suggest_offer(&g, list->rows[i].name);
    }
    sc_offer_fluid_keys(site, &g);
    for (int i = 0; sc_synonyms[i].elsewhere != NULL && sc_suggest_best(&g) == NULL; i++) {
        sc_suggest h = sc_suggest_start(key);
        sc_suggest_offer(&h, sc_synonyms[i].elsewhere);
        if (sc_suggest_best(&h) != NULL && find_row(list, sc_synonyms[i].here) != NULL) {
            sc_suggest_force(&g, sc_synonyms[i].here);
        }
    }
    char owners[160] = "";
    if (sc_suggest_best(&g) == NULL) {
        name_owners(key, owners, sizeof owners);
    }
    sc_raise(s, SCENE_E_KEY, site, key, 0, sc_suggest_best(&g), "unknown key '%.63s' in %s{}%s",
             key, site->construct, owners);
}

// Checks that the table has no keys but those of the list. lua_next's order depends on string
// hashes, so of several unknown keys the alphabetically first is reported.
static void check_keys(scene *s, const sc_site *site, const sc_list *list, int table)
{
    lua_State *L = s->L;
    int most = positions(list);
    const char *unknown = NULL;
    lua_Integer elements = 0;
    lua_Integer highest = 0;
    uint64_t work = 20; // a table of four keys is read in a microsecond
    lua_pushnil(L);
    while (lua_next(L, table) != 0) {
        lua_pop(L, 1);
        work += 10;
        if (lua_type(L, -1) == LUA_TSTRING) {
            const char *key = lua_tostring(L, -1);
            const sc_field *row = find_row(list, key);
            if (row == NULL && (unknown == NULL || strcmp(key, unknown) < 0)) {
                unknown = key;
            }
        } else if (lua_isinteger(L, -1) && lua_tointeger(L, -1) >= 1) {
            elements++;
            highest = lua_tointeger(L, -1) > highest ? lua_tointeger(L, -1) : highest;
        } else {
            lua_pop(L, 1);
            sc_raise(s, SCENE_E_KEY, site, NULL, 0, NULL,
                     "a key of %s{} is neither a name nor a position", site->construct);
        }
    }
    sc_work(s, work);
    if (unknown != NULL) {
        fail_key(s, site, list, unknown);
    }
    if (highest != elements) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL, "the array part of %s{} has a nil in it",
                 site->construct);
    }
    if (most >= 0 && elements > most) {
        sc_raise(s, SCENE_E_KEY, site, NULL, most + 1, NULL, "%s{} takes %d %s by position, not %d",
                 site->construct, most, most == 1 ? "value" : "values", (int)elements);
    }
}

// Pushes the value of a row; *index tells the element it came from (0: by name).
static void push_value(scene *s, const sc_site *site, const sc_field *row, int table, int *index)
{
    lua_State *L = s->L;
    *index = 0;
    lua_pushstring(L, row->name);
    lua_rawget(L, table);
    if (row->position == 0 || (row->position == SC_REST && lua_rawlen(L, table) == 0)) {
        return;
    }
    bool named = !lua_isnil(L, -1);
    if (row->position == SC_REST) {
        lua_pushvalue(L, table);
    } else {
        lua_rawgeti(L, table, row->position);
    }
    if (named && !lua_isnil(L, -1)) {
        sc_raise(s, SCENE_E_DUPLICATE, site, row->name, 0, NULL,
                 "'%s' of %s{} is given by name and by position", row->name, site->construct);
    }
    if (named) {
        lua_pop(L, 1);
        return;
    }
    lua_remove(L, -2);
    *index = row->position == SC_REST ? 0 : row->position;
}

void sc_read(scene *s, const sc_site *site, const sc_list *list, int table, void *out)
{
    lua_State *L = s->L;
    sc_need_stack(s, 10);
    table = lua_absindex(L, table);
    check_keys(s, site, list, table);
    bool given[SC_ROWS_MOST] = { false };
    memset(out, 0, (list->count > 64 ? 2 : 1) * sizeof(uint64_t));
    for (int i = 0; i < list->count; i++) {
        sc_context c = { s, site, &list->rows[i], 0 };
        push_value(s, site, c.row, table, &c.index);
        if (!lua_isnil(L, -1)) {
            read_value(&c, lua_gettop(L), out);
            given[i] = true;
        } else if ((c.row->flags & SC_REQUIRED) != 0) {
            bool plain = c.row->kind == SC_POINTS || c.row->kind == SC_FUNCTION;
            sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL, "%s{} needs %s%s%s", site->construct,
                     c.row->kind == SC_FUNCTION ? "a "
                     : plain                    ? ""
                                                : "'",
                     c.row->name, plain ? "" : "'");
        }
        lua_pop(L, 1);
    }
    for (int i = 0; i < list->count; i++) {
        sc_row_mark(list, out, i, given[i]);
    }
}
