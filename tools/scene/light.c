// light.c - light{}: lamps and lasers, which are drawn and asked, and change nothing of the world (plumb/light.h);
// light_on(), light_path(): what they meet. A lamp is an object: lamp:set{...}, lamp:remove().
//
// A lamp stands in the world or on a body, which its light passes. Its rays lie beside one another over `width`, and fan out
// over `spread`; each has as much of the power. Cost: of who asks, the rays.
#include <math.h>
#include <string.h>

#include "internal.h"

#define META "plumb.light"

/// Pieces of a path that scripts are told of, a ray.
enum { PATH_MOST = 256 };

// ------------------------------------------------------------------------------------------- rays

static int ray_count(const sc_light_def *d)
{
    return d->rays > 1 ? (int)d->rays : 1;
}

static const sc_body *holder_of(const scene *s, const sc_light_def *d)
{
    return d->body[0] != 0 ? sc_body_named(s, d->body) : NULL;
}

/// Ray i of a lamp, where its body is now; in double, so that only the last rounding is one of the world's precision.
static plumb_light_desc ray_of(const scene *s, const sc_light_def *d, int i)
{
    const int count = ray_count(d);
    const double share = count > 1 ? (double)i / (count - 1) - 0.5 : 0;
    const double angle = d->angle + share * d->spread, aside = share * d->width;
    double x = d->at[0] - aside * sc_sin(d->angle), y = d->at[1] + aside * sc_cos(d->angle);
    double dx = sc_cos(angle), dy = sc_sin(angle);
    const sc_body *body = holder_of(s, d);
    if (body != NULL) {
        const plumb_transform t = plumb_body_transform(s->world, body->entity);
        const double c = (double)t.q.c, e = (double)t.q.s, from[] = { x, y }, to[] = { dx, dy };
        x = (double)t.p.x + c * from[0] - e * from[1];
        y = (double)t.p.y + e * from[0] + c * from[1];
        dx = c * to[0] - e * to[1];
        dy = e * to[0] + c * to[1];
    }
    const double power = (SC_GIVEN(&sc_list_light, d, sc_light_def, power) ? d->power : 1) / count;
    return (plumb_light_desc){ .from = { (plumb_real)x, (plumb_real)y },
                               .direction = { (plumb_real)dx, (plumb_real)dy },
                               .length = (plumb_real)d->length,
                               .power = (plumb_real)power,
                               .polarization = (plumb_real)d->polarization,
                               .max_bounces = (int)d->bounces,
                               .min_power = (plumb_real)(d->least / count),
                               .index = (plumb_real)d->around };
}

static int trace(const scene *s, const sc_light_def *d, int ray, plumb_light_segment *segments,
                 int capacity, plumb_light_sum *sum)
{
    const plumb_light_desc desc = ray_of(s, d, ray);
    const sc_body *body = holder_of(s, d);
    plumb_query_filter filter = { .sensors = d->sensors };
    if (body != NULL) {
        filter.ignore_body = body->entity;
    }
    return plumb_world_light(s->world, &desc, &filter, segments, capacity, sum);
}

/// Whether there is a lamp still: its body may be gone.
static bool shines(const scene *s, const sc_light *light)
{
    return light->def.body[0] == 0 || holder_of(s, &light->def) != NULL;
}

int scene_light_count(const scene *s)
{
    return s->lights.count;
}

scene_light scene_light_get(const scene *s, int i)
{
    const sc_light *light = &s->lights.items[i];
    const sc_light_def *d = &light->def;
    const bool power = SC_GIVEN(&sc_list_light, d, sc_light_def, power);
    const bool colored = SC_GIVEN(&sc_list_light, d, sc_light_def, color);
    return (scene_light){ .name = d->name,
                          .palette = colored ? d->color.palette : -1,
                          .color = colored ? d->color.rgba : (scene_rgba){ 0 },
                          .power = power ? d->power : 1,
                          .rays = shines(s, light) && !d->hidden ? ray_count(d) : 0 };
}

int scene_light_trace(const scene *s, int i, int ray, plumb_light_segment *segments, int capacity,
                      plumb_light_sum *sum)
{
    return trace(s, &s->lights.items[i].def, ray, segments, capacity, sum);
}

// ---------------------------------------------------------------------------------------- light{}

/// Raises where the lamp cannot be: the world tells of a ray that it refuses.
static void check(scene *s, const sc_site *site, const sc_light_def *d)
{
    if (d->body[0] != 0 && sc_body_named(s, d->body) == NULL) {
        sc_check_body_name(s, site, "body", d->body);
        sc_raise(s, SCENE_E_NAME, site, "body", 0, NULL, "'body' of light{} must name one body");
    }
    if (trace(s, d, 0, NULL, 0, NULL) < 0) {
        sc_refused(s, site, NULL, plumb_world_error(s->world).code, "light{}");
    }
}

static const sc_light *light_named(const scene *s, const char *name)
{
    for (int i = 0; i < s->lights.count; i++) {
        if (strcmp(s->lights.items[i].def.name, name) == 0) {
            return &s->lights.items[i];
        }
    }
    return NULL;
}

void sc_build_light(scene *s, const sc_site *site, int table)
{
    sc_need_world(s);
    sc_light_def def = { 0 };
    sc_read(s, site, &sc_list_light, lua_absindex(s->L, table), &def);
    if (def.name[0] != 0 && light_named(s, def.name) != NULL) {
        sc_raise(s, SCENE_E_DUPLICATE, site, "name", 0, NULL, "two lights are called '%s'",
                 def.name);
    }
    sc_query_work(s);
    check(s, site, &def);
    *SC_PUSH(s, s->lights) = (sc_light){ def, ++s->light_number };
    int *object = lua_newuserdatauv(s->L, sizeof *object, 0);
    *object = s->light_number;
    luaL_setmetatable(s->L, META);
}

static int lua_light(lua_State *L)
{
    return sc_construct(L, "light", sc_build_light, 1);
}

static int light_self(lua_State *L, const sc_site *site)
{
    scene *s = sc_of(L);
    const int *object = luaL_checkudata(L, 1, META);
    for (int i = 0; i < s->lights.count; i++) {
        if (s->lights.items[i].number == *object) {
            return i;
        }
    }
    sc_raise(s, SCENE_E_NAME, site, NULL, 0, NULL, "the light was removed");
}

// lamp:set{power = 2}
static int light_set(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "set");
    sc_light *light = &s->lights.items[light_self(L, &site)];
    luaL_checktype(L, 2, LUA_TTABLE);
    sc_light_def def = light->def;
    sc_read(s, &site, &sc_list_light, 2, &def);
    def.present |= light->def.present;
    const sc_light *named = def.name[0] != 0 ? light_named(s, def.name) : NULL;
    if (named != NULL && named != light) {
        sc_raise(s, SCENE_E_DUPLICATE, &site, "name", 0, NULL, "two lights are called '%s'",
                 def.name);
    }
    sc_query_work(s);
    check(s, &site, &def);
    light->def = def;
    return 0;
}

static int light_remove(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "remove");
    const int i = light_self(L, &site);
    memmove(&s->lights.items[i], &s->lights.items[i + 1],
            (size_t)(s->lights.count - 1 - i) * sizeof *s->lights.items);
    s->lights.count--;
    return 0;
}

// --------------------------------------------------------------------------------------- questions

/// The light of that name; raises where there is none.
static const sc_light *asked_light(lua_State *L, const sc_site *site, int index)
{
    scene *s = sc_of(L);
    const char *name = luaL_checkstring(L, index);
    const sc_light *light = light_named(s, name);
    if (light == NULL) {
        sc_suggest g = sc_suggest_start(name);
        for (int i = 0; i < s->lights.count; i++) {
            sc_suggest_offer(&g, s->lights.items[i].def.name);
        }
        sc_raise(s, SCENE_E_NAME, site, NULL, 0, sc_suggest_best(&g), "no light is called '%s'",
                 name);
    }
    return light;
}

/// Room for a path, which Lua frees.
static plumb_light_segment *path_room(lua_State *L)
{
    return lua_newuserdatauv(L, PATH_MOST * sizeof(plumb_light_segment), 0);
}

/// Traces for a script: counts what that is.
static int traced(scene *s, const sc_light *light, int ray, plumb_light_segment *segments)
{
    sc_query_work(s);
    const int count = trace(s, &light->def, ray, segments, PATH_MOST, NULL);
    for (int i = 0; i < count; i++) {
        sc_query_work(s);
    }
    return count;
}

// light_on(body [, light]): what the body keeps of it, and what comes to it [W].
static int lua_light_on(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "light_on");
    plumb_body body;
    double kept = 0, comes = 0;
    sc_need_world(s);
    if (!sc_body_at_index(L, 1, &body)) {
        const char *name = luaL_checkstring(L, 1);
        const sc_body *b = sc_body_named(s, name);
        if (b == NULL) {
            sc_check_body_name(s, &site, NULL, name);
            sc_raise(s, SCENE_E_NAME, &site, NULL, 0, NULL,
                     "light_on() takes the name of one body");
        }
        body = b->entity;
    }
    const sc_light *only = lua_isnoneornil(L, 2) ? NULL : asked_light(L, &site, 2);
    plumb_light_segment *segments = path_room(L);
    for (int i = 0; i < s->lights.count; i++) {
        const sc_light *light = &s->lights.items[i];
        const bool wanted = (only == NULL || only == light) && shines(s, light);
        for (int ray = 0; wanted && ray < ray_count(&light->def); ray++) {
            const int count = traced(s, light, ray, segments);
            for (int k = 0; k < count; k++) {
                if (plumb_same(segments[k].body, body)) {
                    kept += (double)segments[k].absorbed;
                    comes += (double)segments[k].power_end;
                }
            }
        }
    }
    lua_pushnumber(L, kept);
    lua_pushnumber(L, comes);
    return 2;
}

static void push_segment(scene *s, const plumb_light_segment *p)
{
    lua_State *L = s->L;
    static const char *const hows[] = { "sent", "reflected", "refracted" };
    sc_push_told(L, SC_TOLD_RAY);
    sc_push_field(L, "x0", p->from.x);
    sc_push_field(L, "y0", p->from.y);
    sc_push_field(L, "x1", p->to.x);
    sc_push_field(L, "y1", p->to.y);
    sc_push_field(L, "power", p->power);
    sc_push_field(L, "power_end", p->power_end);
    sc_push_field(L, "absorbed", p->absorbed);
    sc_push_field(L, "polarization", p->polarization);
    sc_push_field(L, "index", p->index);
    sc_push_field(L, "incidence", p->incidence);
    lua_pushinteger(L, p->parent + 1);
    lua_setfield(L, -2, "parent");
    lua_pushinteger(L, p->depth);
    lua_setfield(L, -2, "depth");
    lua_pushstring(L, hows[p->how]);
    lua_setfield(L, -2, "how");
    const sc_body *body = plumb_is_null(p->body) ? NULL : sc_body_of(s, p->body);
    if (body != NULL) {
        lua_pushstring(L, body->def.name);
        lua_setfield(L, -2, "body");
    }
}

// light_path(light [, ray]): a list of the pieces of its path, parents before their children.
static int lua_light_path(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "light_path");
    sc_need_world(s);
    const sc_light *light = asked_light(L, &site, 1);
    const lua_Integer ray = luaL_optinteger(L, 2, 1);
    if (ray < 1 || ray > ray_count(&light->def)) {
        sc_raise(s, SCENE_E_RANGE, &site, NULL, 0, NULL, "light '%s' has rays 1 to %d",
                 light->def.name, ray_count(&light->def));
    }
    plumb_light_segment *segments = path_room(L);
    const int count = shines(s, light) ? traced(s, light, (int)ray - 1, segments) : 0;
    sc_work(s, 100 * (uint64_t)count);
    lua_newtable(L);
    for (int i = 0; i < count; i++) {
        push_segment(s, &segments[i]);
        lua_rawseti(L, -2, i + 1);
    }
    return 1;
}

void sc_open_light(lua_State *L)
{
    static const luaL_Reg methods[] = { { "set", light_set },
                                        { "remove", light_remove },
                                        { NULL, NULL } };
    luaL_newmetatable(L, META);
    lua_newtable(L);
    luaL_setfuncs(L, methods, 0);
    lua_setfield(L, -2, "__index");
    lua_pushliteral(L, "light");
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 1);
    lua_register(L, "light", lua_light);
    lua_register(L, "light_on", lua_light_on);
    lua_register(L, "light_path", lua_light_path);
}
