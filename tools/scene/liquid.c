// liquid.c - liquid{}: the world's water, filled by shapes; liquid_in(): what a box has of it.
#include <math.h>
#include <string.h>

#include "internal.h"

#define GIVEN(member) SC_GIVEN(&sc_list_liquid, &def, sc_liquid_def, member)

// The first call makes it, and has its settings.
static void make_liquid(scene *s, const sc_site *site, const sc_liquid_def *d)
{
    const plumb_liquid_desc desc = { .spacing = (plumb_real)d->spacing,
                                     .density = (plumb_real)d->density,
                                     .viscosity = (plumb_real)d->viscosity };
    const plumb_result r = plumb_liquid_create(s->world, &desc);
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "liquid{}");
    }
    s->liquid = *d;
    s->liquid_line = site->line > 0 ? site->line : 1;
}

static void add_shape(scene *s, const sc_site *site, const sc_liquid_def *d)
{
    plumb_vec2 points[256];
    const int count = sc_shape_outline(s, site, points);
    const plumb_vec2 velocity = { (plumb_real)d->velocity[0], (plumb_real)d->velocity[1] };
    int before, after;
    plumb_liquid_particles(s->world, &before);
    const plumb_result r = d->refill ? plumb_liquid_refill(s->world, points, count, velocity)
                                     : plumb_liquid_add_shape(s->world, points, count, velocity);
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "liquid{}");
    }
    plumb_liquid_particles(s->world, &after);
    sc_work(s, 100 + 10 * (uint64_t)(after - before) + (d->refill ? (uint64_t)before : 0));
}

static void add_shapes(scene *s, const sc_site *site, int table, const sc_liquid_def *d)
{
    lua_State *L = s->L;
    lua_getfield(L, table, "shapes");
    if (lua_isnil(L, -1)) {
        lua_pushvalue(L, table);
        lua_replace(L, -2);
    }
    for (int i = 0; i < d->shape_count; i++) {
        lua_rawgeti(L, -1, i + 1);
        add_shape(s, site, d);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

// {x, y}, {x, y, vx, vy} or with four of the gradient: on top of the stack.
static void add_particle(scene *s, const sc_site *site, int number)
{
    lua_State *L = s->L;
    double v[8] = { 0 };
    const int count = lua_type(L, -1) == LUA_TTABLE ? (int)lua_rawlen(L, -1) : 0;
    bool good = count == 2 || count == 4 || count == 8;
    for (int k = 0; good && k < count; k++) {
        lua_rawgeti(L, -1, k + 1);
        good = lua_type(L, -1) == LUA_TNUMBER && isfinite(lua_tonumber(L, -1));
        v[k] = good ? lua_tonumber(L, -1) : 0;
        lua_pop(L, 1);
    }
    if (!good) {
        sc_raise(s, SCENE_E_TYPE, site, "particles", 0, NULL,
                 "particle %d of liquid{} must be 2, 4 or 8 numbers: place, velocity, gradient",
                 number);
    }
    plumb_particle p = { { (plumb_real)v[0], (plumb_real)v[1] },
                         { (plumb_real)v[2], (plumb_real)v[3] },
                         { 0 } };
    for (int k = 0; k < 4; k++) {
        p.gradient[k] = (plumb_real)v[4 + k];
    }
    const plumb_result r = plumb_liquid_add(s->world, &p, 1);
    if (r != PLUMB_OK) {
        sc_refused(s, site, "particles", r, "liquid{}");
    }
}

static void add_particles(scene *s, const sc_site *site, int table)
{
    lua_State *L = s->L;
    lua_getfield(L, table, "particles");
    const int count = (int)lua_rawlen(L, -1);
    sc_work(s, 10 * (uint64_t)count);
    for (int i = 1; i <= count; i++) {
        lua_rawgeti(L, -1, i);
        add_particle(s, site, i);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

void sc_build_liquid(scene *s, const sc_site *site, int table)
{
    sc_need_world(s);
    table = lua_absindex(s->L, table);
    sc_liquid_def def = { .color = { .palette = -1 } };
    sc_read(s, site, &sc_list_liquid, table, &def);
    if (s->liquid_line == 0) {
        make_liquid(s, site, &def);
    } else if (GIVEN(spacing) || GIVEN(density) || GIVEN(viscosity) || GIVEN(color)) {
        sc_raise(s, SCENE_E_DUPLICATE, site, NULL, 0, NULL,
                 "settings of liquid{} were given on line %d; another one only adds to it",
                 s->liquid_line);
    }
    add_shapes(s, site, table, &def);
    if (def.particles) {
        add_particles(s, site, table);
    }
}

static int lua_liquid(lua_State *L)
{
    return sc_construct(L, "liquid", sc_build_liquid, 0);
}

static void take_box(scene *s, const sc_site *site, double box[4])
{
    for (int i = 0; i < 4; i++) {
        if (lua_type(s->L, i + 1) != LUA_TNUMBER) {
            sc_raise(s, SCENE_E_TYPE, site, NULL, 0, NULL, "%s takes four numbers: x0, y0, x1, y1",
                     site->construct);
        }
        box[i] = lua_tonumber(s->L, i + 1);
    }
}

// Nil where nothing is.
static void push_place(lua_State *L, int inside, double place)
{
    if (inside > 0) {
        lua_pushnumber(L, place);
    } else {
        lua_pushnil(L);
    }
}

// liquid_in(x0, y0, x1, y1): area [m^2], the highest place of a particle [m] or nil, their rms speed [m/s], their centre
// [m] or nils.
static int lua_liquid_in(lua_State *L)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, "liquid_in");
    double box[4];
    take_box(s, &site, box);
    sc_need_world(s);
    int count, inside = 0;
    double squares = 0, top = 0, sum[2] = { 0, 0 };
    const double up = (double)plumb_world_up(s->world).y;
    const plumb_particle *p = plumb_liquid_particles(s->world, &count);
    sc_work(s, 10 + (uint64_t)count);
    for (int i = 0; i < count; i++) {
        const double x = (double)p[i].position.x, y = (double)p[i].position.y;
        const double u = (double)p[i].velocity.x, v = (double)p[i].velocity.y;
        if (x >= box[0] && x <= box[2] && y >= box[1] && y <= box[3]) {
            top = inside == 0 || y * up > top * up ? y : top;
            squares += u * u + v * v;
            sum[0] += x, sum[1] += y;
            inside++;
        }
    }
    plumb_liquid_desc d = { 0 };
    if (count > 0) {
        plumb_liquid_settings(s->world, &d);
    }
    lua_pushnumber(L, inside * (double)d.spacing * (double)d.spacing);
    push_place(L, inside, top);
    lua_pushnumber(L, inside > 0 ? sqrt(squares / inside) : 0);
    push_place(L, inside, inside > 0 ? sum[0] / inside : 0);
    push_place(L, inside, inside > 0 ? sum[1] / inside : 0);
    return 5;
}

// Beyond what the grid can count nothing flows.
static plumb_vec2 corner(const double at[2], const plumb_liquid_desc *d)
{
    const double most = fmin(1e9, 1e9 * (double)d->spacing);
    return (plumb_vec2){ (plumb_real)fmin(fmax(at[0], -most), most),
                         (plumb_real)fmin(fmax(at[1], -most), most) };
}

// liquid_drain(x0, y0, x1, y1): removes what is in the box; the area that went [m^2].
static int lua_liquid_drain(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "liquid_drain");
    double box[4];
    take_box(s, &site, box);
    sc_need_world(s);
    plumb_liquid_desc d = { 0 };
    int count, removed = 0;
    plumb_liquid_particles(s->world, &count);
    sc_work(s, 10 + (uint64_t)count);
    if (count > 0) {
        plumb_liquid_settings(s->world, &d);
        removed = plumb_liquid_remove(s->world, corner(box, &d), corner(box + 2, &d));
    }
    if (removed < 0) {
        sc_raise(s, SCENE_E_RANGE, &site, NULL, 0, NULL,
                 "liquid_drain takes a box x0 < x1, y0 < y1");
    }
    lua_pushnumber(L, removed * (double)d.spacing * (double)d.spacing);
    return 1;
}

scene_liquid scene_get_liquid(const scene *s)
{
    return (scene_liquid){ s->liquid.color.palette, s->liquid.color.rgba };
}

void sc_open_liquid(lua_State *L)
{
    lua_register(L, "liquid", lua_liquid);
    lua_register(L, "liquid_in", lua_liquid_in);
    lua_register(L, "liquid_drain", lua_liquid_drain);
}
