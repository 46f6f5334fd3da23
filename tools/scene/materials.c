// materials.c - material{}, what a script may change of one, and material_pair{}.
// The world's material is made at once; its record keeps what JSON writes. Cost: O(materials) for a
// name, O(pairs) for a pair.
#include <stdio.h>
#include <string.h>

#include "internal.h"

static plumb_material_desc describe(const sc_material_def *def)
{
    plumb_material_desc desc = { 0 };
#define GIVEN(word) SC_GIVEN(&sc_list_material, def, sc_material_def, word)
    PL_MATERIAL_ROWS(SC_DESCRIBE, GIVEN)
#undef GIVEN
    return desc;
}

void sc_build_material(scene *s, const sc_site *site, int table)
{
    lua_State *L = s->L;
    sc_need_world(s);
    sc_material_def def = { 0 };
    PL_MATERIAL_ROWS(SC_DEFAULT, )
    sc_read(s, site, &sc_list_material, table, &def);
    sc_work(s, (uint64_t)s->materials.count);
    for (int i = 0; i < s->materials.count && def.name[0] != 0; i++) {
        if (strcmp(s->materials.items[i]->id, def.name) == 0) {
            sc_raise(s, SCENE_E_DUPLICATE, site, "name", 0, NULL, "two materials are called '%s'",
                     def.name);
        }
    }
    sc_material **slot = SC_PUSH(s, s->materials);
    *slot = NULL;
    sc_material *m = *slot = sc_need(s, NULL, 0, sizeof *m);
    *m = (sc_material){ .def = def, .line = site->line };
    if (def.name[0] != 0) {
        snprintf(m->id, sizeof m->id, "%s", def.name);
    } else {
        snprintf(m->id, sizeof m->id, "material%d", s->materials.count);
    }
    plumb_material_desc desc = describe(&def);
    m->handle = plumb_material_create(s->world, &desc);
    if (plumb_is_null(m->handle)) {
        sc_refused(s, site, NULL, plumb_world_error(s->world).code, "material{}");
    }
    sc_material **object = lua_newuserdatauv(L, sizeof *object, 0);
    *object = m;
    luaL_setmetatable(L, SC_META_MATERIAL);
}

sc_material *sc_to_material(lua_State *L, int index)
{
    sc_material **object = luaL_testudata(L, index, SC_META_MATERIAL);
    return object == NULL ? NULL : *object;
}

static int material_collect(lua_State *L)
{
    sc_material *m = sc_to_material(L, 1);
    if (m != NULL) {
        m->collected = true;
    }
    return 0;
}

// material:set{ surface_speed = 0 }: the keys of material{} but its name.
static int material_set(lua_State *L)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, "set");
    sc_material *m = sc_to_material(L, 1);
    if (m == NULL || lua_gettop(L) != 2 || lua_type(L, 2) != LUA_TTABLE) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL,
                 "set is a method that takes one table: write material:set{...}");
    }
    sc_material_def def = m->def;
    sc_read(s, &site, &sc_list_material, 2, &def);
    if (SC_GIVEN(&sc_list_material, &def, sc_material_def, name)) {
        sc_raise(s, SCENE_E_STATE, &site, "name", 0, NULL, "a material keeps its name");
    }
    def.present |= m->def.present;
    plumb_material_desc desc = describe(&def);
    plumb_result r = plumb_material_set(s->world, m->handle, &desc);
    if (r != PLUMB_OK) {
        sc_refused(s, &site, NULL, r, "set()");
    }
    m->def = def;
    return 0;
}

// ----------------------------------------------------------------------------- material_pair{}

static plumb_material_pair describe_pair(const sc_pair_def *def)
{
    plumb_material_pair desc = { 0 };
#define GIVEN(word) SC_GIVEN(&sc_list_pair, def, sc_pair_def, word)
    PL_MATERIAL_PAIR_ROWS(SC_DESCRIBE, GIVEN)
#undef GIVEN
    return desc;
}

void sc_build_pair(scene *s, const sc_site *site, int table)
{
    sc_pair_def def = { 0 };
    sc_need_world(s);
    sc_read(s, site, &sc_list_pair, table, &def);
    if (!SC_GIVEN(&sc_list_pair, &def, sc_pair_def, friction)) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL, "material_pair{} needs 'friction'");
    }
    sc_work(s, (uint64_t)s->pairs.count);
    sc_pair_def *place = NULL;
    for (int i = 0; i < s->pairs.count; i++) {
        sc_pair_def *p = &s->pairs.items[i];
        if ((p->a == def.a && p->b == def.b) || (p->a == def.b && p->b == def.a)) {
            if (s->building) {
                sc_raise(s, SCENE_E_DUPLICATE, site, NULL, 0, NULL,
                         "there is a material_pair{} of '%s' and '%s' already", def.a->id,
                         def.b->id);
            }
            place = p;
        }
    }
    place = place != NULL ? place : SC_PUSH(s, s->pairs);
    *place = def;
    const plumb_material_pair pair = describe_pair(&def);
    plumb_result r = plumb_material_pair_set(s->world, def.a->handle, def.b->handle, &pair);
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "material_pair{}");
    }
}

// ----------------------------------------------------------------------------- Lua's side of it

static int lua_material(lua_State *L)
{
    return sc_construct(L, "material", sc_build_material, 1);
}

static int lua_pair(lua_State *L)
{
    return sc_construct(L, "material_pair", sc_build_pair, 0);
}

static int material_index(lua_State *L)
{
    scene *s = sc_of(L);
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "?";
    if (strcmp(name, "set") != 0) {
        sc_site site = sc_here(s, name);
        sc_suggest g = sc_suggest_start(name);
        sc_suggest_offer(&g, "set");
        sc_raise(s, SCENE_E_NAME, &site, NULL, 0, sc_suggest_best(&g), "a material has no '%.40s'",
                 name);
    }
    lua_pushcfunction(L, material_set);
    return 1;
}

void sc_open_materials(lua_State *L)
{
    luaL_newmetatable(L, SC_META_MATERIAL);
    lua_pushcfunction(L, material_collect);
    lua_setfield(L, -2, "__gc");
    lua_pushcfunction(L, material_index);
    lua_setfield(L, -2, "__index");
    lua_pushliteral(L, "material");
    lua_setfield(L, -2, "__name");
    lua_pop(L, 1);
    lua_register(L, "material", lua_material);
    lua_register(L, "material_pair", lua_pair);
}
