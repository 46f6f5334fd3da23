// wet.c - the liquid, asked: liquid_at(), liquid_ray(); whom it touches: on_wet, on_dry. Soft bodies, which have no names, are not told of.
#include <string.h>

#include "internal.h"

static double number_at(scene *s, const sc_site *site, int index, const char *takes)
{
    if (lua_type(s->L, index) != LUA_TNUMBER) {
        sc_raise(s, SCENE_E_TYPE, site, NULL, 0, NULL, "%s takes %s", site->construct, takes);
    }
    return lua_tonumber(s->L, index);
}

static plumb_vec2 place_at(scene *s, const sc_site *site, int index, const char *takes)
{
    return (plumb_vec2){ (plumb_real)number_at(s, site, index, takes),
                         (plumb_real)number_at(s, site, index + 1, takes) };
}

// The world, and what filing all particles costs.
static void open_liquid(scene *s, const sc_site *site)
{
    sc_need_world(s);
    if (s->liquid_line == 0) {
        sc_raise(s, SCENE_E_NAME, site, NULL, 0, NULL, "%s needs a liquid{}", site->construct);
    }
    int count;
    plumb_liquid_particles(s->world, &count);
    sc_work(s, 100 + (uint64_t)count / 8);
}

// liquid_at(x, y): how full the liquid is there, 0..1; its velocity; the name of its phase, nil where there is nothing.
static int lua_liquid_at(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "liquid_at");
    const plumb_vec2 at = place_at(s, &site, 1, "two numbers: x, y");
    open_liquid(s, &site);
    const plumb_liquid_sample a = plumb_liquid_at(s->world, at);
    lua_pushnumber(L, (double)a.fill);
    lua_pushnumber(L, (double)a.velocity.x);
    lua_pushnumber(L, (double)a.velocity.y);
    if (a.fill > 0) {
        lua_pushstring(L, sc_liquid_phase_name(s, (int)a.phase));
    } else {
        lua_pushnil(L);
    }
    return 4;
}

// liquid_ray(x0, y0, x1, y1): x, y, nx, ny where it meets the surface; nil: nowhere.
static int lua_liquid_ray(lua_State *L)
{
    static const char takes[] = "four numbers: x0, y0, x1, y1";
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "liquid_ray");
    const plumb_vec2 from = place_at(s, &site, 1, takes), to = place_at(s, &site, 3, takes);
    plumb_liquid_hit hit;
    open_liquid(s, &site);
    sc_work(s, 10000);
    if (!plumb_liquid_ray(s->world, from, to, &hit)) {
        lua_pushnil(L);
        return 1;
    }
    lua_pushnumber(L, (double)hit.point.x);
    lua_pushnumber(L, (double)hit.point.y);
    lua_pushnumber(L, (double)hit.normal.x);
    lua_pushnumber(L, (double)hit.normal.y);
    return 4;
}

// ------------------------------------------------------------------------------------ whom it touches

void sc_wet_take(scene *s)
{
    int count = 0;
    s->wet.count = s->dry.count = 0;
    if (sc_handler_any(s, SC_ON_WET)) {
        const plumb_liquid_contact *all = plumb_liquid_contacts(s->world, &count);
        for (int i = 0; i < count; i++) {
            if (all[i].began && !plumb_is_null(all[i].body)) {
                *SC_PUSH(s, s->wet) = all[i];
            }
        }
    }
    if (sc_handler_any(s, SC_ON_DRY)) {
        const plumb_liquid_end *all = plumb_liquid_ends(s->world, &count);
        for (int i = 0; i < count; i++) {
            if (!plumb_is_null(all[i].body)) {
                *SC_PUSH(s, s->dry) = all[i];
            }
        }
    }
}

// The handlers of a kind that want this body, which may be gone. `force`: NULL, it has dried.
static void tell(scene *s, sc_handler_kind kind, plumb_body body, const plumb_vec2 *force)
{
    lua_State *L = s->L;
    const int top = lua_gettop(L), count = s->handlers.count;
    char name[SC_NAME_SIZE];
    sc_need_stack(s, 6);
    sc_step_work(s, (uint64_t)count);
    if (!sc_body_recall(s, body, name)) {
        return;
    }
    for (int i = 0; i < count; i++) {
        const sc_handler h = s->handlers.items[i];
        if (h.kind != kind || (h.contact.a[0] != 0 && !sc_name_matches(h.contact.a, name)) ||
            (force != NULL && sc_body_of(s, body) == NULL)) { // destroyed by an earlier handler
            continue;
        }
        lua_rawgeti(L, LUA_REGISTRYINDEX, h.contact.function);
        lua_pushvalue(L, top + 1);
        if (force != NULL) {
            sc_push_told(L, SC_TOLD_WET);
            sc_push_field(L, "fx", force->x);
            sc_push_field(L, "fy", force->y);
        }
        sc_call(s, force != NULL ? 2 : 1, 0);
    }
    lua_settop(L, top);
}

void sc_wet_tell(scene *s)
{
    for (int i = 0; i < s->wet.count; i++) {
        const plumb_liquid_contact c = s->wet.items[i];
        tell(s, SC_ON_WET, c.body, &c.force);
    }
    for (int i = 0; i < s->dry.count; i++) {
        tell(s, SC_ON_DRY, s->dry.items[i].body, NULL);
    }
}

void sc_open_wet(lua_State *L)
{
    lua_register(L, "liquid_at", lua_liquid_at);
    lua_register(L, "liquid_ray", lua_liquid_ray);
}
