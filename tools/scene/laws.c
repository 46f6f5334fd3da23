// laws.c - attractor{}, zone{}, magnetic{}, mutual{}, formula{}: laws of the world (plumb/law.h), orbits{}: how what flies in
// them is moved. A law answers with an object: law:set{...} changes some of it, law:remove() takes it away.
#include <string.h>

#include "internal.h"

#define META "plumb.law"

static const plumb_law_kind kinds[SC_LAW_KINDS] = {
    [SC_ATTRACTOR] = PLUMB_LAW_ATTRACTOR, [SC_ZONE] = PLUMB_LAW_UNIFORM,
    [SC_MAGNETIC] = PLUMB_LAW_MAGNETIC,   [SC_MUTUAL] = PLUMB_LAW_MUTUAL,
    [SC_FORMULA] = PLUMB_LAW_FORMULA,
};

#define GIVEN(member) SC_GIVEN(list, d, sc_law_def, member)

static plumb_vec2 vec(const double v[2])
{
    return (plumb_vec2){ (plumb_real)v[0], (plumb_real)v[1] };
}

// What goes together, and what must be said.
static void check_given(scene *s, const sc_site *site, const sc_law_def *d)
{
    const sc_list *list = &sc_list_laws[d->kind];
    if (d->kind == SC_ZONE && GIVEN(gravity) == GIVEN(electric)) {
        sc_raise(s, GIVEN(gravity) ? SCENE_E_CONFLICT : SCENE_E_MISSING, site,
                 GIVEN(gravity) ? "electric" : NULL, 0, NULL,
                 "zone{} takes either 'gravity' or 'electric'");
    }
    const bool components = GIVEN(x) || GIVEN(y);
    if (d->kind == SC_FORMULA && components == GIVEN(potential)) {
        sc_raise(s, components ? SCENE_E_CONFLICT : SCENE_E_MISSING, site,
                 components ? "potential" : NULL, 0, NULL,
                 "formula{} takes either 'x' and 'y' or 'potential'");
    }
    if (d->kind != SC_ZONE && d->kind != SC_FORMULA && !GIVEN(strength)) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL, "%s{} needs 'strength'", list->name);
    }
}

// What the world is told; raises for what the lists do not see.
static plumb_law_desc describe(scene *s, const sc_site *site, const sc_law_def *d)
{
    const sc_list *list = &sc_list_laws[d->kind];
    const bool electric = d->kind == SC_ZONE && GIVEN(electric);
    const bool formula = d->kind == SC_FORMULA;
    check_given(s, site, d);
    plumb_law_desc desc = { .kind = kinds[d->kind],
                            .hold =
                                electric || d->on == 1 ? PLUMB_LAW_ON_CHARGE : PLUMB_LAW_ON_MASS,
                            .falloff = (plumb_falloff)d->falloff,
                            .combine = d->replace ? PLUMB_LAW_REPLACE : PLUMB_LAW_ADD,
                            .priority = (int)d->priority,
                            .position = vec(d->at),
                            .angle = (plumb_real)d->angle,
                            .vector = vec(electric ? d->electric : d->gravity),
                            .strength = (plumb_real)d->strength,
                            .softening = (plumb_real)d->softening,
                            .radius = (plumb_real)d->radius,
                            .half = vec(d->half),
                            .categories = d->only,
                            .formula_x = formula && GIVEN(x) ? d->x : NULL,
                            .formula_y = formula && GIVEN(y) ? d->y : NULL,
                            .potential = formula && GIVEN(potential) ? d->potential : NULL };
    if (d->body[0] != 0) {
        const sc_body *b = sc_body_named(s, d->body);
        if (b == NULL) {
            sc_check_body_name(s, site, "body", d->body);
            sc_raise(s, SCENE_E_NAME, site, "body", 0, NULL, "'body' of %s{} must name one body",
                     list->name);
        }
        desc.body = b->entity;
    }
    return desc;
}

// Formulas are compiled: some 500 instructions a character.
static uint64_t work_of(const sc_law_def *d)
{
    return 100 + 40 * (strlen(d->x) + strlen(d->y) + strlen(d->potential));
}

// The world refused it: of a formula the key that is none, and where in it.
static void refuse(scene *s, const sc_site *site, const sc_law_def *d, plumb_result r,
                   const char *what)
{
    static const char *const keys[] = { "x", "y", "potential" }, *const names[] = {
        ": formula_x: ", ": formula_y: ", ": potential: "
    };
    const char *message = plumb_world_error(s->world).message;
    for (int i = 0; i < 3 && d->kind == SC_FORMULA && r == PLUMB_E_RANGE; i++) {
        const char *says = strstr(message, names[i]);
        if (says != NULL) {
            sc_raise(s, SCENE_E_RANGE, site, keys[i], 0, NULL, "'%s' of formula{}: %s", keys[i],
                     says + strlen(names[i]));
        }
    }
    sc_refused(s, site, NULL, r, "%s", what);
}

void sc_build_law(scene *s, const sc_site *site, sc_law_kind kind, int table)
{
    sc_need_world(s);
    sc_law_def def = { .kind = kind };
    table = lua_absindex(s->L, table);
    sc_read(s, site, &sc_list_laws[kind], table, &def);
    const plumb_law_desc desc = describe(s, site, &def);
    sc_work(s, work_of(&def));
    const plumb_law law = plumb_law_create(s->world, &desc);
    if (plumb_is_null(law)) {
        char what[SC_NAME_SIZE];
        snprintf(what, sizeof what, "%s{}", sc_list_laws[kind].name);
        refuse(s, site, &def, plumb_world_error(s->world).code, what);
    }
    *SC_PUSH(s, s->laws) = (sc_law){ def, law };
    plumb_law *object = lua_newuserdatauv(s->L, sizeof *object, 0);
    *object = law;
    luaL_setmetatable(s->L, META);
}

static int make_law(lua_State *L, sc_law_kind kind)
{
    const sc_site site = sc_here(sc_of(L), sc_list_laws[kind].name);
    luaL_checktype(L, 1, LUA_TTABLE);
    sc_build_law(sc_of(L), &site, kind, 1);
    return 1;
}

static int lua_attractor(lua_State *L)
{
    return make_law(L, SC_ATTRACTOR);
}

static int lua_zone(lua_State *L)
{
    return make_law(L, SC_ZONE);
}

static int lua_magnetic(lua_State *L)
{
    return make_law(L, SC_MAGNETIC);
}

static int lua_mutual(lua_State *L)
{
    return make_law(L, SC_MUTUAL);
}

static int lua_formula(lua_State *L)
{
    return make_law(L, SC_FORMULA);
}

// ------------------------------------------------------------------------------------- methods

// The law of an object; raises where it is gone.
static sc_law *law_self(lua_State *L, const sc_site *site)
{
    scene *s = sc_of(L);
    const plumb_law *object = luaL_checkudata(L, 1, META);
    for (int i = 0; i < s->laws.count; i++) {
        if (plumb_same(s->laws.items[i].handle, *object) &&
            plumb_entity_alive(s->world, object->entity)) {
            return &s->laws.items[i];
        }
    }
    sc_raise(s, SCENE_E_NAME, site, NULL, 0, NULL, "the law was removed, or its body was");
}

// law:set{strength = 0}
static int law_set(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "set");
    sc_law *law = law_self(L, &site);
    luaL_checktype(L, 2, LUA_TTABLE);
    sc_law_def def = law->def;
    sc_read(s, &site, &sc_list_laws[def.kind], 2, &def);
    def.present |= law->def.present;
    const plumb_law_desc desc = describe(s, &site, &def);
    sc_work(s, work_of(&def));
    const plumb_result r = plumb_law_set(s->world, law->handle, &desc);
    if (r != PLUMB_OK) {
        refuse(s, &site, &def, r, "set");
    }
    law->def = def;
    return 0;
}

static int law_remove(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "remove");
    const plumb_result r = plumb_law_destroy(s->world, law_self(L, &site)->handle);
    if (r != PLUMB_OK) {
        sc_refused(s, &site, NULL, r, "remove");
    }
    return 0;
}

// ------------------------------------------------------------------------------------ orbits{}

void sc_build_orbits(scene *s, const sc_site *site, int table)
{
    sc_need_world(s);
    sc_orbits_def def = { 0 };
    sc_read(s, site, &sc_list_orbits, table, &def);
    const plumb_orbit_desc desc = { (int)def.order, (plumb_real)def.tolerance };
    const plumb_result r = plumb_world_set_orbits(s->world, &desc);
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "orbits{}");
    }
    s->orbits = def;
}

static int lua_orbits(lua_State *L)
{
    return sc_construct(L, "orbits", sc_build_orbits, 0);
}

void sc_open_laws(lua_State *L)
{
    static const luaL_Reg methods[] = { { "set", law_set },
                                        { "remove", law_remove },
                                        { NULL, NULL } };
    luaL_newmetatable(L, META);
    lua_newtable(L);
    luaL_setfuncs(L, methods, 0);
    lua_setfield(L, -2, "__index");
    lua_pushliteral(L, "law");
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 1);
    lua_register(L, "attractor", lua_attractor);
    lua_register(L, "zone", lua_zone);
    lua_register(L, "magnetic", lua_magnetic);
    lua_register(L, "mutual", lua_mutual);
    lua_register(L, "formula", lua_formula);
    lua_register(L, "orbits", lua_orbits);
}
