// error.c - every message of the loader: recorded once, with file, line, column and suggestion.
// sc_raise is for the loader's own complaints; sc_take_error translates Lua's.
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

const char *scene_code_text(scene_code code)
{
    switch (code) {
#define SCENE_CODE_CASE(name, value, text)                                                         \
    case SCENE_##name:                                                                             \
        return text;
        SCENE_CODE_LIST(SCENE_CODE_CASE)
#undef SCENE_CODE_CASE
    }
    return "unknown code";
}

void sc_set_error(scene *s, scene_code code, int line, int column, const char *suggestion,
                  const char *message)
{
    scene_error *e = &s->error;
    *e = (scene_error){ .code = code, .line = line, .column = column };
    snprintf(e->message, sizeof e->message, "%s", message);
    snprintf(e->suggestion, sizeof e->suggestion, "%s", suggestion == NULL ? "" : suggestion);
    snprintf(e->file, sizeof e->file, "%s", s->raising_set != NULL ? "--set" : s->path);
    char place[400];
    if (s->raising_set != NULL) {
        snprintf(place, sizeof place, "--set %s", s->raising_set);
        e->line = e->column = 0;
    } else if (line > 0) {
        snprintf(place, sizeof place, "%s:%d:%d", e->file, line, column);
    } else {
        snprintf(place, sizeof place, "%s", e->file);
    }
    if (e->suggestion[0] != 0) {
        snprintf(e->text, sizeof e->text, "%s: %s (did you mean '%s'?)", place, e->message,
                 e->suggestion);
    } else {
        snprintf(e->text, sizeof e->text, "%s: %s", place, e->message);
    }
}

void sc_raise(scene *s, scene_code code, const sc_site *site, const char *key, int index,
              const char *suggestion, const char *format, ...)
{
    char message[sizeof s->error.message];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    int line = 0;
    int column = 0;
    if (site != NULL && site->path != NULL) {
        sc_json_position(s->source, s->source_size, site->path, key, index, &line, &column);
    } else if (site != NULL && site->line > 0) {
        sc_lua_position(s->source, s->source_size, site, key, index, &line, &column);
    }
    if (site != NULL && strcmp(site->construct, "scene") == 0 && key != NULL) {
        for (int i = 0; i < s->sets.count; i++) {
            if (strcmp(s->sets.items[i].key, key) == 0) {
                s->raising_set = s->sets.items[i].key;
            }
        }
    }
    sc_set_error(s, code, line, column, suggestion, message);
    lua_settop(s->L, 0); // makes room: raising must not need memory
    lua_pushlightuserdata(s->L, s);
    lua_error(s->L);
    abort(); // lua_error does not return
}

// Why the world refused the last call, without the name of its function.
static const char *world_message(const scene *s)
{
    const char *message = plumb_world_error(s->world).message;
    const char *after = strstr(message, ": ");
    return after != NULL ? after + 2 : message;
}

void sc_refused(scene *s, const sc_site *site, const char *key, plumb_result result,
                const char *format, ...)
{
    if (result == PLUMB_E_MEMORY) {
        sc_raise(s, SCENE_E_LIMIT, site, NULL, 0, NULL,
                 "the scene needs more than %zu bytes of memory", s->budget.limit);
    }
    char what[160];
    va_list list;
    va_start(list, format);
    vsnprintf(what, sizeof what, format, list);
    va_end(list);
    bool range = result == PLUMB_E_RANGE || result == PLUMB_E_NOT_FINITE;
    scene_code code = range                        ? SCENE_E_RANGE
                      : result == PLUMB_E_GEOMETRY ? SCENE_E_GEOMETRY
                      : result == PLUMB_E_STATE    ? SCENE_E_STATE
                                                   : SCENE_E_WORLD;
    sc_raise(s, code, site, key, 0, NULL, "%s: %s", what,
             s->world != NULL ? world_message(s) : plumb_result_text(result));
}

sc_site sc_here(scene *s, const char *construct)
{
    sc_site site = { .construct = construct };
    lua_Debug d;
    for (int level = 0; lua_getstack(s->L, level, &d); level++) {
        lua_getinfo(s->L, "Sl", &d);
        if (strcmp(d.source, "=" SC_CHUNK) == 0) {
            site.line = d.currentline;
            return site;
        }
    }
    return site;
}

// ------------------------------------------------------------------------------- Lua's messages

// Copies what stands between the n-th pair of apostrophes; "" if there is none.
static void quoted(const char *text, int n, char *out, size_t size)
{
    out[0] = 0;
    const char *p = text;
    for (int i = 0; p != NULL; i++) {
        p = strchr(p, '\'');
        const char *close = p == NULL ? NULL : strchr(p + 1, '\'');
        if (close == NULL) {
            return;
        }
        if (i == n) {
            snprintf(out, size, "%.*s", (int)(close - p - 1), p + 1);
            return;
        }
        p = close + 1;
    }
}

static void take_syntax(scene *s, int line, const char *message)
{
    char near[SC_NAME_SIZE] = "";
    const char *p = strstr(message, " near ");
    for (const char *q = p; q != NULL; q = strstr(q + 1, " near ")) {
        p = q;
    }
    if (p != NULL && p[6] == '\'') {
        snprintf(near, sizeof near, "%s", p + 7);
        size_t length = strlen(near);
        near[length > 0 ? length - 1 : 0] = 0;
    }
    int column;
    if (p != NULL && strcmp(p + 6, "<eof>") == 0) {
        column = 1;
        for (size_t i = 0; i < s->source_size; i++) {
            column = s->source[i] == '\n' ? 1 : column + 1;
        }
    } else {
        column = sc_lua_syntax_column(s->L, s->source, s->source_size, line, near);
    }
    sc_set_error(s, SCENE_E_SYNTAX, line, column, NULL, message);
}

void sc_missed_set(scene *s, const char *what, const char *name)
{
    s->missed = (sc_missed){ .what = what, .line = sc_here(s, what).line };
    snprintf(s->missed.name, sizeof s->missed.name, "%s", name);
}

// find("b"):destroy() where nobody is called b: Lua knows only that something is nil.
static bool take_missed(scene *s, int line, const char *message)
{
    const sc_missed *m = &s->missed;
    if (m->what == NULL || m->line != line ||
        strcmp(message, "attempt to index a nil value") != 0) {
        return false;
    }
    const bool body = strcmp(m->what, "find") == 0;
    sc_suggest g = sc_suggest_start(m->name);
    for (int i = 0; i < (body ? s->bodies.count : s->joints.count); i++) {
        sc_suggest_offer(&g, body ? s->bodies.items[i]->def.name : s->joints.items[i]->def.name);
    }
    char text[sizeof s->error.message];
    snprintf(text, sizeof text, "there is no %s '%s'", body ? "body" : "joint", m->name);
    sc_set_error(s, SCENE_E_NAME, line, sc_lua_column(s->source, s->source_size, line, m->what),
                 sc_suggest_best(&g), text);
    return true;
}

static void take_runtime(scene *s, int line, const char *message)
{
    if (take_missed(s, line, message)) {
        return;
    }
    char name[SC_NAME_SIZE] = "";
    const char *p = strchr(message, '(');
    if (p != NULL) { // attempt to index a nil value (local 'x')
        quoted(p, 0, name, sizeof name);
    }
    if (name[0] == 0 || strncmp(message, "bad argument", 12) == 0) {
        quoted(message, 0, name, sizeof name); // bad argument #1 to 'floor' (...)
    }
    int column = sc_lua_column(s->source, s->source_size, line, name[0] != 0 ? name : NULL);
    sc_set_error(s, SCENE_E_RUNTIME, line, column, NULL, message);
}

static void take_limit(scene *s)
{
    char message[160];
    sc_budget *b = &s->budget;
    if (b->long_string) {
        snprintf(message, sizeof message, "a string of more than %zu bytes was made",
                 SC_STRING_MAX);
    } else if (b->out_of_time) {
        snprintf(message, sizeof message, "the %s takes more than %llu instructions",
                 s->building ? "scene" : "handler", (unsigned long long)b->spend_limit);
    } else {
        snprintf(message, sizeof message, "the scene needs more than %zu bytes of memory",
                 b->limit);
    }
    int line = s->is_json ? 0 : sc_here(s, "").line;
    int column = line > 0 ? sc_lua_column(s->source, s->source_size, line, NULL) : 0;
    sc_set_error(s, SCENE_E_LIMIT, line, column, NULL, message);
}

void sc_need_stack(scene *s, int slots)
{
    if (!lua_checkstack(s->L, slots)) {
        take_limit(s);
        lua_settop(s->L, 0);
        lua_pushlightuserdata(s->L, s);
        lua_error(s->L);
    }
}

void sc_take_error(scene *s, int status)
{
    if (s->error.code == SCENE_OK && status == LUA_ERRMEM) {
        take_limit(s);
    } else if (s->error.code == SCENE_OK) {
        const char *text = lua_type(s->L, -1) == LUA_TSTRING
                               ? lua_tostring(s->L, -1)
                               : "error() with a value that is no string";
        char message[sizeof s->error.message];
        int line = 0;
        size_t prefix = strlen(SC_CHUNK ":");
        if (strncmp(text, SC_CHUNK ":", prefix) == 0) {
            char *rest;
            line = (int)strtol(text + prefix, &rest, 10);
            text = strncmp(rest, ": ", 2) == 0 ? rest + 2 : rest;
        }
        snprintf(message, sizeof message, "%s", text);
        message[strcspn(message, "\n")] = 0; // "stack overflow" carries a traceback
        if (status == LUA_ERRSYNTAX) {
            take_syntax(s, line, message);
        } else {
            take_runtime(s, line, message);
        }
    }
    lua_settop(s->L, 0);
}
