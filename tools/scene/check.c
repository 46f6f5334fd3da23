// check.c - what only the whole scene can tell: --set keys that nothing took, things that were made
// and never used, names of bodies that do not exist, times after the end. Also how --set is read.
// The checks run once, after the build pass. Cost: one full garbage collection, O(things made).
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

// ------------------------------------------------------------------------------------- --set

void sc_apply_sets(scene *s)
{
    for (int i = 0; i < s->options.set_count; i++) {
        const char *text = s->options.sets[i];
        const char *equal = text == NULL ? NULL : strchr(text, '=');
        size_t length = equal == NULL ? 0 : (size_t)(equal - text);
        if (length == 0 || length >= SC_NAME_SIZE ||
            strlen(equal + 1) >= sizeof s->sets.items->value) {
            s->raising_set = text == NULL ? "" : text;
            sc_raise(s, SCENE_E_SET, NULL, NULL, 0, NULL, "must have the form key=value");
        }
        sc_set *set = SC_PUSH(s, s->sets);
        *set = (sc_set){ 0 };
        memcpy(set->key, text, length);
        snprintf(set->value, sizeof set->value, "%s", equal + 1);
    }
}

// A number, or a fraction such as 1/60; *rest is what follows it, `text` where there is none.
static double read_real(const char *text, char **rest)
{
    double v = strtod(text, rest);
    if (*rest != text && **rest == '/') {
        char *behind;
        double divisor = strtod(*rest + 1, &behind);
        v = behind != *rest + 1 ? v / divisor : v;
        *rest = behind != *rest + 1 ? behind : *rest;
    }
    return v;
}

// "0,-5" as a table. False, and nothing pushed, when that is not all there is.
static bool push_numbers(lua_State *L, const char *text)
{
    lua_newtable(L);
    for (int i = 1;; i++) {
        char *rest;
        double v = read_real(text, &rest);
        rest += strspn(rest, " ");
        if (rest == text || (*rest != ',' && *rest != 0)) {
            lua_pop(L, 1);
            return false;
        }
        lua_pushnumber(L, v);
        lua_rawseti(L, -2, i);
        if (*rest == 0) {
            return true;
        }
        text = rest + 1;
    }
}

// Text as a Lua value: true, false, a number, numbers with commas (in braces, as in a scene, or without) as a table,
// else a string, in quotes or without.
static void push_parsed(lua_State *L, const char *text)
{
    char inner[sizeof((sc_set *)0)->value];
    size_t length = strlen(text);
    char *rest;
    double v = read_real(text, &rest);
    bool in_braces = length >= 2 && text[0] == '{' && text[length - 1] == '}';
    bool in_quotes =
        length >= 2 && (text[0] == '"' || text[0] == '\'') && text[length - 1] == text[0];
    snprintf(inner, sizeof inner, "%.*s", in_braces || in_quotes ? (int)length - 2 : 0, text + 1);
    if (strcmp(text, "true") == 0 || strcmp(text, "false") == 0) {
        lua_pushboolean(L, text[0] == 't');
    } else if (rest != text && *rest == 0) {
        if (v == floor(v) && fabs(v) < 0x1p53) {
            lua_pushinteger(L, (lua_Integer)v);
        } else {
            lua_pushnumber(L, v);
        }
    } else if (in_quotes) {
        lua_pushstring(L, inner);
    } else if (!(in_braces ? push_numbers(L, inner) : push_numbers(L, text))) {
        lua_pushstring(L, text);
    }
}

bool sc_take_set(scene *s, const char *key)
{
    const sc_set *last = NULL;
    for (int i = 0; i < s->sets.count; i++) {
        if (strcmp(s->sets.items[i].key, key) == 0) {
            s->sets.items[i].used = true;
            last = &s->sets.items[i];
        }
    }
    if (last != NULL) {
        push_parsed(s->L, last->value);
    }
    return last != NULL;
}

static void check_sets(scene *s)
{
    for (int i = 0; i < s->sets.count; i++) {
        const sc_set *set = &s->sets.items[i];
        if (set->used) {
            continue;
        }
        sc_suggest g = sc_suggest_start(set->key);
        for (int k = 0; k < sc_list_scene.count; k++) {
            sc_suggest_offer(&g, sc_list_scene.rows[k].name);
        }
        for (int k = 0; k < s->params.count; k++) {
            sc_suggest_offer(&g, s->params.items[k].name);
        }
        s->raising_set = set->key;
        sc_raise(s, SCENE_E_SET, NULL, NULL, 0, sc_suggest_best(&g),
                 "neither a key of scene{} nor a param of this scene");
    }
}

// ------------------------------------------------------------------------- after the build pass

// A thing that was made, is not used, and cannot be used any more: nothing refers to it, or there
// is no handler left that could.
static void check_unused(scene *s)
{
    lua_gc(s->L, LUA_GCCOLLECT);
    bool may_come = s->handlers.count > 0;
    for (int i = 0; i < s->made.count; i++) {
        const sc_made *m = &s->made.items[i];
        if (!m->used && (m->collected || !may_come)) {
            const char *name = sc_shape_kind_name(m->kind);
            sc_site site = { .construct = name, .line = m->line };
            sc_raise(s, SCENE_E_UNUSED, &site, NULL, 0, NULL,
                     "this %s{} is never used: put it into a body{}", name);
        }
    }
    for (int i = 0; i < s->materials.count; i++) {
        const sc_material *m = s->materials.items[i];
        if (!m->used && (m->collected || !may_come) && !s->is_json) {
            sc_site site = { .construct = "material", .line = m->line };
            sc_raise(s, SCENE_E_UNUSED, &site, NULL, 0, NULL,
                     "this material{} is never used: give it to a body{} or a shape");
        }
    }
    s->made.count = 0;
    s->epoch++;
}

// Whether a name stands for several; raises when it does so in a way that nothing could match.
static bool is_pattern(scene *s, const sc_site *site, const char *key, const char *name)
{
    const char *star = strchr(name, '*');
    if (star != NULL && star[1] != 0) {
        sc_raise(s, SCENE_E_RANGE, site, key, 0, NULL,
                 "'%s' fits nothing: '*' stands for any ending, and must be the last", name);
    }
    return star != NULL;
}

void sc_check_body_name(scene *s, const sc_site *site, const char *key, const char *name)
{
    if (name[0] == 0 || is_pattern(s, site, key, name) || sc_body_named(s, name) != NULL) {
        return;
    }
    sc_suggest g = sc_suggest_start(name);
    for (int i = 0; i < s->bodies.count; i++) {
        sc_suggest_offer(&g, s->bodies.items[i]->def.name);
    }
    sc_raise(s, SCENE_E_NAME, site, key, 0, sc_suggest_best(&g), "no body is called '%s'", name);
}

void sc_check_joint_name(scene *s, const sc_site *site, const char *key, const char *name)
{
    if (name[0] == 0 || is_pattern(s, site, key, name) || sc_joint_named(s, name) != NULL) {
        return;
    }
    sc_suggest g = sc_suggest_start(name);
    for (int i = 0; i < s->joints.count; i++) {
        sc_suggest_offer(&g, s->joints.items[i]->def.name);
    }
    sc_raise(s, SCENE_E_NAME, site, key, 0, sc_suggest_best(&g), "no joint is called '%s'", name);
}

// Finds the exact{} that a line of expect{} is about.
static void check_form(scene *s, const sc_site *site, sc_expect *e)
{
    if (!SC_GIVEN(&sc_list_expect, &e->def, sc_expect_def, exact)) {
        return;
    }
    e->exact = sc_exact_find(s, e->def.exact);
    if (e->exact >= 0) {
        return;
    }
    sc_suggest g = sc_suggest_start(e->def.exact);
    for (int i = 0; i < s->exact_count; i++) {
        sc_suggest_offer(&g, s->exacts[i].def.name);
    }
    sc_raise(s, SCENE_E_NAME, site, "exact", 0, sc_suggest_best(&g), "no exact{} is called '%s'",
             e->def.exact);
}

void sc_check_build(scene *s)
{
    sc_need_world(s);
    check_sets(s);
    check_unused(s);
    sc_check_categories(s);
    sc_check_body_name(s,
                       &(sc_site){ .construct = "camera",
                                   .line = s->camera_line,
                                   .path = s->is_json ? "camera" : NULL },
                       "follow", s->camera.follow);
    for (int i = 0; i < s->expects.count; i++) {
        char path[32];
        snprintf(path, sizeof path, "expect[%d]", i);
        sc_expect *e = &s->expects.items[i];
        sc_site site = { .construct = "expect", .line = e->line, .path = s->is_json ? path : NULL };
        sc_check_body_name(s, &site, "body", e->def.body);
        sc_check_joint_name(s, &site, "joint", e->def.joint);
        check_form(s, &site, e);
        if (SC_GIVEN(&sc_list_expect, &e->def, sc_expect_def, at) &&
            e->def.at > s->start_time + s->duration) {
            // a shorter run was asked for: then the line is simply not reached
            bool asked = false;
            for (int k = 0; k < s->sets.count; k++) {
                asked |= strcmp(s->sets.items[k].key, "duration") == 0;
            }
            if (!asked) {
                sc_raise(s, SCENE_E_RANGE, &site, "at", 0, NULL,
                         "'at' of expect{} is %.10g s, after the end of the scene at %.10g s",
                         e->def.at, s->start_time + s->duration);
            }
        }
    }
    for (int i = 0; i < s->exact_count; i++) {
        sc_check_body_name(s, &(sc_site){ .construct = "exact", .line = s->exacts[i].line }, "body",
                           s->exacts[i].def.body);
    }
    for (int i = 0; i < s->handlers.count; i++) {
        const sc_handler *h = &s->handlers.items[i];
        sc_site site = { .construct = sc_handler_name(h->kind), .line = h->line };
        sc_check_body_name(s, &site, h->kind == SC_FIELD ? "body" : "a", h->contact.a);
        sc_check_body_name(s, &site, "b", h->contact.b);
        sc_check_joint_name(s, &site, "joint", h->contact.joint);
    }
}
