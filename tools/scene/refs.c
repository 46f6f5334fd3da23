// refs.c - readers of values that refer to bodies and joints: by the Lua object, or by its name.
// Reads: the name tables in the registry, the world's handles. Cost: O(1), a gear's joints too.
#include <stdio.h>
#include <string.h>

#include "internal.h"

void sc_read_body(const sc_context *c, int value, char out[SC_NAME_SIZE])
{
    plumb_body body;
    if (sc_body_at_index(c->s->L, value, &body)) {
        const sc_body *b = sc_body_of(c->s, body);
        if (b == NULL) {
            sc_raise(c->s, SCENE_E_STATE, c->site, c->row->name, c->index, NULL,
                     "'%s' of %s{} is a body that was destroyed", c->row->name, c->site->construct);
        }
        snprintf(out, SC_NAME_SIZE, "%s", b->def.name);
        return;
    }
    if (lua_type(c->s->L, value) != LUA_TSTRING) {
        sc_fail_type(c, "a body or the name of one", value);
    }
    sc_read_string(c, value, out, SC_NAME_SIZE);
}

void sc_read_joint(const sc_context *c, int value, char out[SC_NAME_SIZE])
{
    plumb_joint joint;
    if (sc_joint_at_index(c->s->L, value, &joint)) {
        const sc_joint *j = sc_joint_of(c->s, joint);
        if (j == NULL) {
            sc_raise(c->s, SCENE_E_STATE, c->site, c->row->name, c->index, NULL,
                     "'%s' of %s{} is a joint that is gone", c->row->name, c->site->construct);
        }
        snprintf(out, SC_NAME_SIZE, "%s", j->def.name);
        return;
    }
    if (lua_type(c->s->L, value) != LUA_TSTRING) {
        sc_fail_type(c, "a joint or the name of one", value);
    }
    sc_read_string(c, value, out, SC_NAME_SIZE);
}

// The body of that name, which must be there already.
static void end_by_name(const sc_context *c, int value, sc_end *out)
{
    char name[SC_NAME_SIZE];
    sc_read_string(c, value, name, sizeof name);
    if (strcmp(name, "world") == 0) {
        return;
    }
    const sc_body *b = sc_body_named(c->s, name);
    if (b == NULL) {
        sc_suggest g = sc_suggest_start(name);
        for (int i = 0; i < c->s->bodies.count; i++) {
            sc_suggest_offer(&g, c->s->bodies.items[i]->def.name);
        }
        sc_suggest_offer(&g, "world");
        sc_raise(c->s, SCENE_E_NAME, c->site, c->row->name, c->index, sc_suggest_best(&g),
                 "no body is called '%s'", name);
    }
    out->body = b->entity;
}

void sc_read_end(const sc_context *c, int value, sc_end *out)
{
    lua_State *L = c->s->L;
    bool is_gear = strcmp(c->site->construct, "gear") == 0;
    *out = (sc_end){ .given = true };
    if (sc_is_world(L, value)) {
        return;
    }
    if (sc_body_at_index(L, value, &out->body)) {
        if (sc_body_of(c->s, out->body) == NULL) {
            sc_raise(c->s, SCENE_E_STATE, c->site, c->row->name, c->index, NULL,
                     "'%s' of %s{} is a body that was destroyed", c->row->name, c->site->construct);
        }
    } else if (is_gear && sc_joint_at_index(L, value, &out->joint)) {
        if (sc_joint_of(c->s, out->joint) == NULL) {
            sc_raise(c->s, SCENE_E_STATE, c->site, c->row->name, c->index, NULL,
                     "'%s' of gear{} is a joint that is gone", c->row->name);
        }
        out->body = plumb_joint_body_b(c->s->world, out->joint);
    } else if (lua_type(L, value) == LUA_TSTRING) {
        end_by_name(c, value, out);
    } else {
        sc_fail_type(c,
                     is_gear ? "a body, a joint, the name of a body, or world"
                             : "a body, the name of one, or world",
                     value);
    }
}
