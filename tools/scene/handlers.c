// handlers.c - what a script does while the scene runs: at, every, every_step before a step (what
// follows a step is in events.c), counters, text, and what a script may ask of the world. Handlers of
// one kind of moment are called in the order in which they were registered.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "internal.h"

#define MOST_PARTS 100000 ///< of a step

void sc_call(scene *s, int args, int results)
{
    sc_budget_call(s);
    lua_call(s->L, args, results);
}

// ------------------------------------------------------------------------------------ registering

sc_handler *sc_handler_add(scene *s, sc_handler_kind kind, const sc_site *site)
{
    sc_need_world(s);
    sc_handler *h = SC_PUSH(s, s->handlers);
    *h = (sc_handler){ .kind = kind, .line = site->line, .contact.function = LUA_NOREF };
    return h;
}

// at(time, function) and every(period, function)
static int register_timed(lua_State *L, const char *name, sc_handler_kind kind)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, name);
    if (lua_gettop(L) != 2 || lua_type(L, 1) != LUA_TNUMBER || lua_type(L, 2) != LUA_TFUNCTION) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL, "%s takes a time in seconds and a function",
                 name);
    }
    double time = lua_tonumber(L, 1);
    bool good = isfinite(time) && (kind == SC_AT ? time >= 0 : time > 0);
    if (!good) {
        sc_raise(s, SCENE_E_RANGE, &site, NULL, 1, NULL,
                 "the time of %s() must be %s 0 and finite, not %.10g", name,
                 kind == SC_AT ? "at least" : "above", time);
    }
    sc_need_world(s);
    if (kind == SC_AT && time > s->start_time + s->duration && s->building) {
        bool asked = false; // a shorter run may be asked for with --set
        for (int i = 0; i < s->sets.count; i++) {
            asked |= strcmp(s->sets.items[i].key, "duration") == 0;
        }
        if (!asked) {
            sc_raise(s, SCENE_E_RANGE, &site, NULL, 1, NULL,
                     "at(%.10g) never happens: the scene ends at %.10g s", time,
                     s->start_time + s->duration);
        }
    }
    int function = luaL_ref(L, LUA_REGISTRYINDEX);
    sc_handler *h = sc_handler_add(s, kind, &site);
    h->time = time;
    h->contact.function = function;
    h->next = kind == SC_EVERY ? floor(scene_time(s) / time) + 1 : 0;
    return 0;
}

static int lua_at(lua_State *L)
{
    return register_timed(L, "at", SC_AT);
}

static int lua_every(lua_State *L)
{
    return register_timed(L, "every", SC_EVERY);
}

static int lua_every_step(lua_State *L)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, "every_step");
    if (lua_gettop(L) != 1 || lua_type(L, 1) != LUA_TFUNCTION) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL, "every_step takes a function");
    }
    int function = luaL_ref(L, LUA_REGISTRYINDEX);
    sc_handler_add(s, SC_EVERY_STEP, &site)->contact.function = function;
    return 0;
}

// ---------------------------------------------------------------------------------------- calling

static void call_timed(scene *s, const sc_handler *h, double time)
{
    lua_rawgeti(s->L, LUA_REGISTRYINDEX, h->contact.function);
    lua_pushnumber(s->L, time);
    sc_call(s, 1, 0);
}

void sc_handlers_before(scene *s)
{
    double now = scene_time(s);
    double slack = 1e-9 * s->dt; // k * period and k * dt may differ in the last place
    sc_step_work(s, (uint64_t)s->handlers.count);
    for (int i = 0; i < s->handlers.count; i++) {
        sc_handler *h = &s->handlers.items[i];
        if (h->kind == SC_AT && !h->spent && h->time <= now + slack) {
            h->spent = true;
            call_timed(s, h, now);
        } else if (h->kind == SC_EVERY && h->next * h->time <= now + slack) {
            h->next = floor((now + slack) / h->time) + 1;
            call_timed(s, h, now);
        } else if (h->kind == SC_EVERY_STEP) {
            call_timed(s, h, now);
        }
    }
}

// --------------------------------------------------------------------- scores, text, the world

sc_score *sc_score_find(scene *s, const char *name)
{
    for (int i = 0; i < s->scores.count; i++) {
        if (strcmp(s->scores.items[i].name, name) == 0) {
            return &s->scores.items[i];
        }
    }
    return NULL;
}

// score(name) returns, score(name, value) sets; a new score begins at 0.
static int lua_score(lua_State *L)
{
    scene *s = sc_of(L);
    size_t length;
    const char *name = luaL_checklstring(L, 1, &length);
    luaL_argcheck(L, length > 0 && length < SC_NAME_SIZE, 1, "must have 1 to 63 characters");
    sc_work(s, 10 + (uint64_t)s->scores.count);
    sc_score *score = sc_score_find(s, name);
    if (score == NULL) {
        score = SC_PUSH(s, s->scores);
        *score = (sc_score){ 0 };
        memcpy(score->name, name, length + 1);
    }
    if (!lua_isnoneornil(L, 2)) {
        double v = luaL_checknumber(L, 2);
        luaL_argcheck(L, isfinite(v), 2, "must be finite");
        score->value = v;
    }
    if (score->value == floor(score->value) && fabs(score->value) < 0x1p53) {
        lua_pushinteger(L, (lua_Integer)score->value);
    } else {
        lua_pushnumber(L, score->value);
    }
    return 1;
}

static int lua_text(lua_State *L)
{
    scene *s = sc_of(L);
    size_t length;
    const char *text = luaL_checklstring(L, 1, &length);
    luaL_argcheck(L, length < sizeof s->text, 1, "must have at most 255 characters");
    snprintf(s->text, sizeof s->text, "%s", text);
    return 0;
}

static int lua_find_body(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_body *b = sc_body_named(s, luaL_checkstring(L, 1));
    if (b == NULL) {
        sc_missed_set(s, "find", lua_tostring(L, 1));
        lua_pushnil(L);
    } else {
        sc_body_push(s, b);
    }
    return 1;
}

static int lua_body_count(lua_State *L)
{
    lua_pushinteger(L, sc_of(L)->bodies.count);
    return 1;
}

static int lua_time(lua_State *L)
{
    lua_pushnumber(L, scene_time(sc_of(L)));
    return 1;
}

static int lua_finish(lua_State *L)
{
    sc_of(L)->stop = true;
    return 0;
}

static int lua_energy(lua_State *L)
{
    scene *s = sc_of(L);
    sc_need_world(s);
    sc_work(s, (uint64_t)s->bodies.count + 10);
    plumb_energy e = plumb_world_energy(s->world);
    lua_pushnumber(L, e.kinetic);
    lua_pushnumber(L, e.potential);
    lua_pushnumber(L, e.stored);
    return 3;
}

static int lua_momentum(lua_State *L)
{
    scene *s = sc_of(L);
    sc_need_world(s);
    sc_work(s, (uint64_t)s->bodies.count + 10);
    plumb_energy e = plumb_world_energy(s->world);
    lua_pushnumber(L, e.momentum_x);
    lua_pushnumber(L, e.momentum_y);
    return 2;
}

static int lua_penetration(lua_State *L)
{
    scene *s = sc_of(L);
    sc_need_world(s);
    sc_work(s, (uint64_t)s->bodies.count / 16 + 10); // every sleeping island is looked at
    lua_pushnumber(L, (double)plumb_world_stats(s->world).max_penetration);
    return 1;
}

static int lua_set_gravity(lua_State *L)
{
    scene *s = sc_of(L);
    sc_need_world(s);
    sc_work(s, (uint64_t)s->bodies.count + 10); // who sleeps wakes
    double x = luaL_checknumber(L, 1);
    double y = luaL_checknumber(L, 2);
    luaL_argcheck(L, fabs(x) <= 1e6 && fabs(y) <= 1e6, 1, "must be at most 1e6 m/s^2");
    plumb_world_set_gravity(s->world, (plumb_vec2){ (plumb_real)x, (plumb_real)y });
    return 0;
}

// split_step(n): from the next step on, each is n steps of the world of dt / n.
static int lua_split_step(lua_State *L)
{
    scene *s = sc_of(L);
    lua_Integer parts = luaL_checkinteger(L, 1);
    luaL_argcheck(L, parts >= 1 && parts <= MOST_PARTS, 1, "must be 1 to 100000");
    luaL_argcheck(L, s->dt / (double)parts >= 1e-6, 1, "makes steps shorter than 1e-6 s");
    s->split = (int)parts;
    return 0;
}

void sc_open_handlers(lua_State *L)
{
    static const luaL_Reg names[] = {
        { "at", lua_at },
        { "every", lua_every },
        { "every_step", lua_every_step },
        { "score", lua_score },
        { "text", lua_text },
        { "find", lua_find_body },
        { "body_count", lua_body_count },
        { "time", lua_time },
        { "finish", lua_finish },
        { "energy", lua_energy },
        { "momentum", lua_momentum },
        { "penetration", lua_penetration },
        { "set_gravity", lua_set_gravity },
        { "split_step", lua_split_step },
        { NULL, NULL },
    };
    for (const luaL_Reg *r = names; r->name != NULL; r++) {
        lua_register(L, r->name, r->func);
    }
}
