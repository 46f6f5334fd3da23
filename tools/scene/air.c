// air.c - air{}: the world's box of air; air_source{}: what feeds it; air_fill(), air_at(), air_sum(): what is in it.
//
// A source answers with an object: source:set{...} changes some of it, source:remove() takes it away. The world has
// them as one list, which is told anew.
#include <math.h>
#include <string.h>

#include "internal.h"

#define META "plumb.air_source"

static plumb_vec2 vec(const double v[2])
{
    return (plumb_vec2){ (plumb_real)v[0], (plumb_real)v[1] };
}

// ------------------------------------------------------------------------------------ air{}

// {u, v, smoke, heat, room}: on top of the stack.
static void take_cell(scene *s, const sc_site *site, int number, plumb_air_cell *out)
{
    lua_State *L = s->L;
    plumb_real *const to[] = { &out->u, &out->v, &out->smoke, &out->heat, &out->room };
    bool good = lua_type(L, -1) == LUA_TTABLE && lua_rawlen(L, -1) == 5;
    for (int k = 0; good && k < 5; k++) {
        lua_rawgeti(L, -1, k + 1);
        good = lua_type(L, -1) == LUA_TNUMBER && isfinite(lua_tonumber(L, -1));
        *to[k] = good ? (plumb_real)lua_tonumber(L, -1) : 0;
        lua_pop(L, 1);
    }
    if (!good) {
        sc_raise(s, SCENE_E_TYPE, site, "cells", 0, NULL,
                 "cell %d of air{} must be five numbers: velocities, smoke, heat, room", number);
    }
}

static void take_cells(scene *s, const sc_site *site, int table)
{
    lua_State *L = s->L;
    plumb_air_box box;
    plumb_air_cells(s->world, &box);
    const int count = (box.columns + 1) * (box.rows + 1);
    lua_getfield(L, table, "cells");
    if ((lua_Integer)lua_rawlen(L, -1) != count) {
        sc_raise(s, SCENE_E_RANGE, site, "cells", 0, NULL,
                 "air{} has %d cells; 'cells' must have as many", count);
    }
    sc_work(s, 10 * (uint64_t)count);
    plumb_air_cell *cells = lua_newuserdatauv(L, (size_t)count * sizeof *cells, 0);
    for (int i = 0; i < count; i++) {
        lua_rawgeti(L, -2, i + 1);
        take_cell(s, site, i + 1, &cells[i]);
        lua_pop(L, 1);
    }
    const plumb_result r = plumb_air_set_cells(s->world, cells, count);
    if (r != PLUMB_OK) {
        sc_refused(s, site, "cells", r, "air{}");
    }
    lua_pop(L, 2);
}

void sc_build_air(scene *s, const sc_site *site, int table)
{
    sc_need_world(s);
    table = lua_absindex(s->L, table);
    sc_air_def def = { .color = { .palette = -1 } };
    sc_read(s, site, &sc_list_air, table, &def);
    if (s->air_line != 0) {
        sc_raise(s, SCENE_E_DUPLICATE, site, NULL, 0, NULL,
                 "the world has air since line %d; it has one box of it, or none", s->air_line);
    }
    const plumb_air_desc desc = { .position = vec(def.at),
                                  .half = { (plumb_real)(def.size[0] / 2),
                                            (plumb_real)(def.size[1] / 2) },
                                  .cell = (plumb_real)def.cell,
                                  .density = (plumb_real)def.density,
                                  .viscosity = (plumb_real)def.viscosity,
                                  .temperature = (plumb_real)def.temperature,
                                  .fading = (plumb_real)def.fading,
                                  .cooling = (plumb_real)def.cooling,
                                  .flow = vec(def.flow),
                                  .left = (plumb_air_side)def.left,
                                  .right = (plumb_air_side)def.right,
                                  .bottom = (plumb_air_side)def.bottom,
                                  .top = (plumb_air_side)def.top };
    const plumb_result r = plumb_air_create(s->world, &desc);
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "air{}");
    }
    plumb_air_box box;
    plumb_air_cells(s->world, &box);
    sc_work(s, 100 + (uint64_t)box.columns * (uint64_t)box.rows);
    if (def.cells) {
        take_cells(s, site, table);
    }
    s->air = def;
    s->air_line = site->line > 0 ? site->line : 1;
}

static int lua_air(lua_State *L)
{
    return sc_construct(L, "air", sc_build_air, 0);
}

scene_air scene_get_air(const scene *s)
{
    return (scene_air){ s->air.color.palette, s->air.color.rgba, s->air.hidden };
}

// ------------------------------------------------------------------------------------ air_source{}

static plumb_air_source describe(scene *s, const sc_site *site, const sc_source_def *d)
{
    plumb_air_source source = { .position = vec(d->at),
                                .radius = (plumb_real)d->radius,
                                .smoke = (plumb_real)d->smoke,
                                .heat = (plumb_real)d->heat,
                                .push = vec(d->push) };
    if (d->radius == 0) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL, "air_source{} needs 'radius'");
    }
    if (d->body[0] != 0) {
        const sc_body *b = sc_body_named(s, d->body);
        if (b == NULL) {
            sc_check_body_name(s, site, "body", d->body);
            sc_raise(s, SCENE_E_NAME, site, "body", 0, NULL,
                     "'body' of air_source{} must name one body");
        }
        source.body = b->entity;
    }
    return source;
}

// Those whose bodies are gone are told no more.
static void tell_sources(scene *s, const sc_site *site)
{
    int count = 0;
    lua_State *L = s->L;
    plumb_air_source *all = lua_newuserdatauv(L, (size_t)(s->sources.count + 1) * sizeof *all, 0);
    for (int i = 0; i < s->sources.count; i++) {
        const sc_source_def *d = &s->sources.items[i].def;
        if (d->body[0] == 0 || sc_body_named(s, d->body) != NULL) {
            all[count++] = describe(s, site, d);
        }
    }
    const plumb_result r = plumb_air_set_sources(s->world, all, count);
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "%s", site->construct);
    }
    sc_work(s, 10 * (uint64_t)count + 10);
    lua_pop(L, 1);
}

void sc_build_source(scene *s, const sc_site *site, int table)
{
    sc_need_world(s);
    sc_source_def def = { 0 };
    sc_read(s, site, &sc_list_source, lua_absindex(s->L, table), &def);
    describe(s, site, &def); // raises where it cannot be
    *SC_PUSH(s, s->sources) = (sc_source){ def, ++s->source_number };
    tell_sources(s, site);
    int *object = lua_newuserdatauv(s->L, sizeof *object, 0);
    *object = s->source_number;
    luaL_setmetatable(s->L, META);
}

static int lua_source(lua_State *L)
{
    return sc_construct(L, "air_source", sc_build_source, 1);
}

static int source_self(lua_State *L, const sc_site *site)
{
    scene *s = sc_of(L);
    const int *object = luaL_checkudata(L, 1, META);
    for (int i = 0; i < s->sources.count; i++) {
        if (s->sources.items[i].number == *object) {
            return i;
        }
    }
    sc_raise(s, SCENE_E_NAME, site, NULL, 0, NULL, "the source was removed");
}

// source:set{smoke = 0}
static int source_set(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "set");
    sc_source *source = &s->sources.items[source_self(L, &site)];
    luaL_checktype(L, 2, LUA_TTABLE);
    sc_source_def def = source->def;
    sc_read(s, &site, &sc_list_source, 2, &def);
    def.present |= source->def.present;
    describe(s, &site, &def);
    source->def = def;
    tell_sources(s, &site);
    return 0;
}

static int source_remove(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "remove");
    const int i = source_self(L, &site);
    memmove(&s->sources.items[i], &s->sources.items[i + 1],
            (size_t)(s->sources.count - 1 - i) * sizeof *s->sources.items);
    s->sources.count--;
    tell_sources(s, &site);
    return 0;
}

// ------------------------------------------------------------------------------------ what is in it

typedef struct filling {
    lua_State *L;
    int function;
} filling;

static void fill_from_lua(void *context, plumb_vec2 at, plumb_air_sample *sample)
{
    lua_State *L = ((filling *)context)->L;
    plumb_real *const to[] = { &sample->velocity.x, &sample->velocity.y, &sample->smoke,
                               &sample->heat };
    lua_pushvalue(L, ((filling *)context)->function);
    lua_pushnumber(L, (double)at.x);
    lua_pushnumber(L, (double)at.y);
    lua_call(L, 2, 4);
    for (int k = 0; k < 4; k++) {
        if (!lua_isnil(L, k - 4)) {
            *to[k] = (plumb_real)luaL_checknumber(L, k - 4);
        }
    }
    lua_pop(L, 4);
}

// air_fill(function(x, y) return vx, vy, smoke, heat end); what is nil stays.
static int lua_air_fill(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "air_fill");
    luaL_checktype(L, 1, LUA_TFUNCTION);
    sc_need_world(s);
    filling f = { L, 1 };
    const plumb_result r = plumb_air_fill(s->world, fill_from_lua, &f);
    if (r != PLUMB_OK) {
        sc_refused(s, &site, NULL, r, "air_fill");
    }
    return 0;
}

// air_at(x, y): its velocity, smoke, heat.
static int lua_air_at(lua_State *L)
{
    scene *s = sc_of(L);
    const plumb_vec2 at = { (plumb_real)luaL_checknumber(L, 1),
                            (plumb_real)luaL_checknumber(L, 2) };
    sc_need_world(s);
    const plumb_air_sample a = plumb_air_at(s->world, at);
    sc_work(s, 10);
    lua_pushnumber(L, (double)a.velocity.x);
    lua_pushnumber(L, (double)a.velocity.y);
    lua_pushnumber(L, (double)a.smoke);
    lua_pushnumber(L, (double)a.heat);
    return 4;
}

// air_sum(): smoke [m^2], heat [K m^2], momentum x, y [kg m/s], energy [J] in all.
static int lua_air_sum(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "air_sum");
    plumb_air_sums sums;
    plumb_air_box box;
    sc_need_world(s);
    const plumb_result r = plumb_air_sum(s->world, &sums);
    if (r != PLUMB_OK) {
        sc_refused(s, &site, NULL, r, "air_sum");
    }
    plumb_air_cells(s->world, &box);
    sc_work(s, 10 + (uint64_t)box.columns * (uint64_t)box.rows);
    lua_pushnumber(L, sums.smoke);
    lua_pushnumber(L, sums.heat);
    lua_pushnumber(L, sums.momentum_x);
    lua_pushnumber(L, sums.momentum_y);
    lua_pushnumber(L, sums.energy);
    return 5;
}

void sc_open_air(lua_State *L)
{
    static const luaL_Reg methods[] = { { "set", source_set },
                                        { "remove", source_remove },
                                        { NULL, NULL } };
    luaL_newmetatable(L, META);
    lua_newtable(L);
    luaL_setfuncs(L, methods, 0);
    lua_setfield(L, -2, "__index");
    lua_pushliteral(L, "air_source");
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 1);
    lua_register(L, "air", lua_air);
    lua_register(L, "air_source", lua_source);
    lua_register(L, "air_fill", lua_air_fill);
    lua_register(L, "air_at", lua_air_at);
    lua_register(L, "air_sum", lua_air_sum);
}
