// body_record.c - the records of bodies: matched against patterns; forgotten. Cost: O(1), O(bodies) to forget
// one.
#include <string.h>

#include "internal.h"

bool sc_name_matches(const char *pattern, const char *name)
{
    size_t length = strlen(pattern);
    if (length > 0 && pattern[length - 1] == '*') {
        return strncmp(pattern, name, length - 1) == 0;
    }
    return strcmp(pattern, name) == 0;
}

void sc_body_push(scene *s, const sc_body *body)
{
    lua_rawgeti(s->L, LUA_REGISTRYINDEX, body->object);
}

void sc_body_release(scene *s, sc_body *body)
{
    lua_State *L = s->L;
    sc_record_name(s, &sc_bodies, body->def.name, NULL);
    luaL_unref(L, LUA_REGISTRYINDEX, body->object);
    luaL_unref(L, LUA_REGISTRYINDEX, body->user);
    for (int i = 0; i < body->def.shape_count; i++) {
        sc_shape_def *d = &body->shapes[i];
        sc_resize(s, d->points, (size_t)d->point_count * sizeof *d->points, 0);
    }
    sc_resize(s, body->shapes, (size_t)body->def.shape_count * sizeof *body->shapes, 0);
    int at = 0;
    while (s->bodies.items[at] != body) {
        at++;
    }
    s->bodies.count--;
    memmove(&s->bodies.items[at], &s->bodies.items[at + 1],
            (size_t)(s->bodies.count - at) * sizeof(sc_body *));
    sc_resize(s, body, sizeof *body, 0);
}
