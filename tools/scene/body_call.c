// body_call.c - what a method of a body begins and ends with: whose it is, its arguments, what the world answers.
#include <math.h>

#include "internal.h"

const char *const sc_body_types[] = { "dynamic", "kinematic", "static", NULL };

sc_body_call sc_body_self(lua_State *L, const char *method)
{
    sc_body_call c = { .s = sc_of(L), .method = method };
    sc_work(c.s, 10);
    const plumb_body *object = luaL_testudata(L, 1, SC_META_BODY);
    sc_site site = sc_here(c.s, method);
    if (object == NULL) {
        sc_raise(c.s, SCENE_E_TYPE, &site, NULL, 0, NULL, "%s is a method: write body:%s(...)",
                 method, method);
    }
    c.world = c.s->world;
    c.entity = *object;
    c.body = sc_body_of(c.s, c.entity);
    if (c.body == NULL) {
        sc_raise(c.s, SCENE_E_STATE, &site, NULL, 0, NULL, "%s() of a body that was destroyed",
                 method);
    }
    return c;
}

double sc_finite_number(lua_State *L, int index)
{
    double v = luaL_checknumber(L, index);
    luaL_argcheck(L, isfinite(v), index, "must be finite");
    return v;
}

plumb_vec2 sc_vector(lua_State *L, int *index)
{
    double v[2];
    if (lua_istable(L, *index)) {
        luaL_argcheck(L, sc_to_vec2(sc_of(L), *index, v) && isfinite(v[0]) && isfinite(v[1]),
                      *index, "must be two finite numbers {x, y}");
        *index += 1;
    } else {
        v[0] = sc_finite_number(L, *index);
        v[1] = sc_finite_number(L, *index + 1);
        *index += 2;
    }
    return (plumb_vec2){ (plumb_real)v[0], (plumb_real)v[1] };
}

int sc_body_check(const sc_body_call *c, plumb_result result)
{
    if (result != PLUMB_OK) {
        sc_site site = sc_here(c->s, c->method);
        sc_refused(c->s, &site, NULL, result, "%s() of '%s'", c->method, c->body->def.name);
    }
    return 0;
}
