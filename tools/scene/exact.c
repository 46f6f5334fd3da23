// exact.c - the closed forms that a scene declares, evaluated for `plumb cost`.
#include <math.h>

#include "internal.h"

/// One evaluation, handed into the protected call.
typedef struct evaluation {
    int index;
    double t;
    double *values;
} evaluation;

int scene_exact_count(const scene *s)
{
    return s->exact_count;
}

scene_exact scene_exact_get(const scene *s, int i)
{
    const sc_exact_def *d = &s->exacts[i].def;
    const sc_list *list = &sc_list_exact;
    scene_exact out = { .body = d->body, .till = s->start_time + s->duration };
    const bool given[SCENE_EXACT_COUNT] = {
        SC_GIVEN(list, d, sc_exact_def, x),     SC_GIVEN(list, d, sc_exact_def, y),
        SC_GIVEN(list, d, sc_exact_def, angle), SC_GIVEN(list, d, sc_exact_def, vx),
        SC_GIVEN(list, d, sc_exact_def, vy),    SC_GIVEN(list, d, sc_exact_def, spin),
    };
    for (int q = 0; q < SCENE_EXACT_COUNT; q++) {
        out.given |= given[q] ? 1u << q : 0;
    }
    if (SC_GIVEN(list, d, sc_exact_def, till)) {
        out.till = d->till;
    }
    return out;
}

static void evaluate(scene *s, void *argument)
{
    lua_State *L = s->L;
    const evaluation *e = argument;
    const sc_exact_def *d = &s->exacts[e->index].def;
    const int functions[SCENE_EXACT_COUNT] = { d->x, d->y, d->angle, d->vx, d->vy, d->spin };
    unsigned given = scene_exact_get(s, e->index).given;
    for (int q = 0; q < SCENE_EXACT_COUNT; q++) {
        e->values[q] = (double)NAN;
        if ((given >> q & 1u) == 0) {
            continue;
        }
        lua_rawgeti(L, LUA_REGISTRYINDEX, functions[q]);
        lua_pushnumber(L, e->t);
        sc_call(s, 1, 1);
        if (lua_type(L, -1) != LUA_TNUMBER || !isfinite(lua_tonumber(L, -1))) {
            sc_site site = { .construct = "exact", .line = s->exacts[e->index].line };
            sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL,
                     "a function of exact{} must return a finite number, not %s at t = %.10g",
                     sc_type_name(s, -1), e->t);
        }
        e->values[q] = lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
}

scene_code scene_exact_eval(scene *s, int i, double t, double values[SCENE_EXACT_COUNT],
                            scene_error *err)
{
    evaluation e = { i, t, values };
    if (s->error.code == SCENE_OK) {
        sc_begin_handlers(s);
        sc_protect(s, evaluate, &e);
    }
    if (err != NULL) {
        *err = s->error;
    }
    return s->error.code;
}
