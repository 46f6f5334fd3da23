// waves.c - waves{}: the surface of a body of water gets waves (plumb/waves.h); wave_at(): where it is.
#include <math.h>
#include <string.h>

#include "internal.h"

// The first shape of a body that has waves, or may get some; null: none.
static plumb_shape water_of(const scene *s, plumb_body body)
{
    enum { MOST = 64 };
    plumb_shape shapes[MOST], none = PLUMB_NULL_INIT;
    const int count = plumb_body_shapes(s->world, body, shapes, MOST);
    for (int i = 0; i < count && i < MOST; i++) {
        if (plumb_shape_is_sensor(s->world, shapes[i])) {
            return shapes[i];
        }
    }
    return count > 0 ? shapes[0] : none;
}

static plumb_waves_desc describe(const sc_waves_def *d)
{
    const bool still = SC_GIVEN(&sc_list_waves, d, sc_waves_def, damping) && d->damping == 0;
    return (plumb_waves_desc){ .modes = (int)d->modes,
                               .damping = (plumb_real)d->damping,
                               .no_damping = still,
                               .height = (plumb_real)d->height,
                               .swell = (plumb_real)d->swell,
                               .swell_length = (plumb_real)d->swell_length };
}

// {{height, rate}, ...}
static void take_state(scene *s, const sc_site *site, int table, plumb_shape shape)
{
    lua_State *L = s->L;
    lua_getfield(L, table, "state");
    const int count = (int)lua_rawlen(L, -1);
    int most;
    plumb_waves_modes(s->world, shape, &most);
    if (count > most) {
        sc_raise(s, SCENE_E_RANGE, site, "state", 0, NULL,
                 "waves{} has %d modes; 'state' must not have more", most);
    }
    plumb_wave_mode *modes = lua_newuserdatauv(L, (size_t)(count + 1) * sizeof *modes, 0);
    for (int i = 0; i < count; i++) {
        double *const to[] = { &modes[i].height, &modes[i].rate };
        bool good = lua_rawgeti(L, -2, i + 1) == LUA_TTABLE && lua_rawlen(L, -1) == 2;
        for (int k = 0; good && k < 2; k++) {
            good = lua_rawgeti(L, -1, k + 1) == LUA_TNUMBER && isfinite(lua_tonumber(L, -1));
            *to[k] = good ? lua_tonumber(L, -1) : 0;
            lua_pop(L, 1);
        }
        lua_pop(L, 1);
        if (!good) {
            sc_raise(s, SCENE_E_TYPE, site, "state", 0, NULL,
                     "mode %d of waves{} must be two numbers: height, rate", i + 1);
        }
    }
    const plumb_result r = plumb_waves_set_modes(s->world, shape, modes, count);
    if (r != PLUMB_OK) {
        sc_refused(s, site, "state", r, "waves{}");
    }
    lua_pop(L, 2);
}

void sc_build_waves(scene *s, const sc_site *site, int table)
{
    sc_need_world(s);
    table = lua_absindex(s->L, table);
    sc_waves_def def = { .present = 0 };
    sc_read(s, site, &sc_list_waves, table, &def);
    const sc_body *b = sc_body_named(s, def.body);
    if (b == NULL) {
        sc_check_body_name(s, site, "body", def.body);
        sc_raise(s, SCENE_E_NAME, site, "body", 0, NULL, "'body' of waves{} must name one body");
    }
    const plumb_shape shape = water_of(s, b->entity);
    const plumb_waves_desc desc = describe(&def);
    sc_work(s, 1000);
    const plumb_result r = plumb_waves_create(s->world, shape, &desc);
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "waves{}");
    }
    if (def.state) {
        take_state(s, site, table, shape);
    }
    *SC_PUSH(s, s->waves) = (sc_waves){ def, shape };
}

static int lua_waves(lua_State *L)
{
    return sc_construct(L, "waves", sc_build_waves, 0);
}

// wave_at(x [, body]): y of the surface, its slope, how fast it rises; of the first surface, or of a body's. nil: there is none.
static int lua_wave_at(lua_State *L)
{
    scene *s = sc_of(L);
    const plumb_real x = (plumb_real)luaL_checknumber(L, 1);
    const char *name = luaL_optstring(L, 2, NULL);
    sc_need_world(s);
    sc_query_work(s);
    for (int i = 0; i < s->waves.count; i++) {
        const sc_waves *w = &s->waves.items[i];
        if (plumb_waves_modes(s->world, w->shape, NULL) != NULL &&
            (name == NULL || strcmp(name, w->def.body) == 0)) {
            const plumb_wave_sample at = plumb_waves_at(s->world, w->shape, x);
            lua_pushnumber(L, (double)at.y);
            lua_pushnumber(L, (double)at.slope);
            lua_pushnumber(L, (double)at.rate);
            return 3;
        }
    }
    lua_pushnil(L);
    return 1;
}

void sc_open_waves(lua_State *L)
{
    lua_register(L, "wave_at", lua_wave_at);
    lua_register(L, "waves", lua_waves);
}
