// liquid.c - liquid{}: the world's water and its phases, filled by shapes; liquid_in(): what a box has of it;
// liquid_drain(), liquid_change(): what is in a box goes, or becomes another phase.
#include <math.h>
#include <string.h>

#include "internal.h"

#define GIVEN(member) SC_GIVEN(&sc_list_liquid, &def, sc_liquid_def, member)

// The first call makes it, and has its settings.
static void make_liquid(scene *s, const sc_site *site, const sc_liquid_def *d)
{
    const plumb_liquid_desc desc = { .spacing = (plumb_real)d->spacing,
                                     .density = (plumb_real)d->density,
                                     .viscosity = (plumb_real)d->viscosity,
                                     .tension = (plumb_real)d->tension,
                                     .friction = (plumb_real)d->friction };
    const plumb_result r = plumb_liquid_create(s->world, &desc);
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "liquid{}");
    }
    s->liquid = *d;
    s->liquid_line = site->line > 0 ? site->line : 1;
}

// ------------------------------------------------------------------------------------ phases

// The first is called as liquid{} says, or water.
const char *sc_liquid_phase_name(const scene *s, int phase)
{
    const char *first = s->liquid.name[0] != 0 ? s->liquid.name : "water";
    return phase == 0 ? first : s->phases[phase - 1].name;
}

static int phase_named(const scene *s, const char *name)
{
    for (int i = 0; i <= s->phase_count; i++) {
        if (strcmp(sc_liquid_phase_name(s, i), name) == 0) {
            return i;
        }
    }
    return -1;
}

static int find_phase(scene *s, const sc_site *site, const char *name)
{
    const int phase = phase_named(s, name);
    sc_suggest g = sc_suggest_start(name);
    for (int i = 0; phase < 0 && i <= s->phase_count; i++) {
        sc_suggest_offer(&g, sc_liquid_phase_name(s, i));
    }
    if (phase < 0) {
        sc_raise(s, SCENE_E_NAME, site, NULL, 0, sc_suggest_best(&g),
                 "liquid{} has no phase '%.40s'", name);
    }
    return phase;
}

static void take_phase(scene *s, const sc_site *site, int table, int number)
{
    const sc_site inner = {
        .construct = "phases", .line = site->line, .outer = site->construct, .path = site->path
    };
    sc_phase_def def = { .color = { .palette = -1 } };
    if (s->phase_count == PLUMB_LIQUID_MAX_PHASES) {
        sc_raise(s, SCENE_E_RANGE, site, "phases", 0, NULL, "liquid{} has at most %d phases",
                 PLUMB_LIQUID_MAX_PHASES);
    }
    if (lua_type(s->L, table) != LUA_TTABLE) {
        sc_raise(s, SCENE_E_TYPE, site, "phases", 0, NULL,
                 "phase %d of liquid{} must be a table: { name = 'oil', density = 900 }", number);
    }
    sc_read(s, &inner, &sc_list_phase, table, &def);
    if (phase_named(s, def.name) >= 0) {
        sc_raise(s, SCENE_E_DUPLICATE, &inner, "name", 0, NULL, "liquid{} has a phase '%s' already",
                 def.name);
    }
    s->phases[s->phase_count++] = def;
}

static void take_phases(scene *s, const sc_site *site, int table)
{
    lua_State *L = s->L;
    plumb_liquid_phase phases[PLUMB_LIQUID_MAX_PHASES];
    lua_getfield(L, table, "phases");
    for (int i = 1; lua_rawgeti(L, -1, i) != LUA_TNIL; i++) {
        take_phase(s, site, lua_absindex(L, -1), i);
        lua_pop(L, 1);
    }
    lua_pop(L, 2);
    for (int i = 0; i < s->phase_count; i++) {
        phases[i] = (plumb_liquid_phase){ .density = (plumb_real)s->phases[i].density,
                                          .viscosity = (plumb_real)s->phases[i].viscosity,
                                          .friction = (plumb_real)s->phases[i].friction };
    }
    const plumb_result r = plumb_liquid_set_phases(s->world, phases, s->phase_count);
    if (r != PLUMB_OK) {
        sc_refused(s, site, "phases", r, "liquid{}");
    }
}

// ------------------------------------------------------------------------------------ particles

// 0xffrrggbb; 0: none.
static uint32_t dye_of(const sc_liquid_def *d)
{
    const scene_rgba c = d->dye.rgba;
    return d->dye.palette >= 0
               ? 1 + (uint32_t)d->dye.palette
               : (uint32_t)c.a << 24 | (uint32_t)c.r << 16 | (uint32_t)c.g << 8 | (uint32_t)c.b;
}

static void add_shape(scene *s, const sc_site *site, const sc_liquid_def *d)
{
    plumb_vec2 points[256];
    const int count = sc_shape_outline(s, site, points);
    const plumb_particle like = {
        .velocity = { (plumb_real)d->velocity[0], (plumb_real)d->velocity[1] },
        .phase = d->phase[0] != 0 ? (uint32_t)find_phase(s, site, d->phase) : 0,
        .tag = dye_of(d),
    };
    int before, after;
    plumb_liquid_particles(s->world, &before);
    const plumb_result r = d->refill ? plumb_liquid_refill(s->world, points, count, &like)
                                     : plumb_liquid_add_shape(s->world, points, count, &like);
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

// {x, y}, {x, y, vx, vy}, with four of the gradient, or with phase and tag behind these, and shear stresses: on top of the stack.
static void add_particle(scene *s, const sc_site *site, int number)
{
    lua_State *L = s->L;
    double v[12] = { 0 };
    const int count = lua_type(L, -1) == LUA_TTABLE ? (int)lua_rawlen(L, -1) : 0;
    bool good = count == 2 || count == 4 || count == 8 || count == 10 || count == 12;
    for (int k = 0; good && k < count; k++) {
        lua_rawgeti(L, -1, k + 1);
        good = lua_type(L, -1) == LUA_TNUMBER && isfinite(lua_tonumber(L, -1));
        v[k] = good ? lua_tonumber(L, -1) : 0;
        lua_pop(L, 1);
    }
    for (int k = 8; good && k < 10; k++) {
        good = v[k] >= 0 && v[k] <= UINT32_MAX;
    }
    if (!good) {
        sc_raise(s, SCENE_E_TYPE, site, "particles", 0, NULL,
                 "particle %d of liquid{} must be 2, 4, 8, 10 or 12 numbers: place, velocity, "
                 "gradient, phase and tag, shear stresses",
                 number);
    }
    plumb_particle p = { .position = { (plumb_real)v[0], (plumb_real)v[1] },
                         .velocity = { (plumb_real)v[2], (plumb_real)v[3] },
                         .shear = { (plumb_real)v[10], (plumb_real)v[11] },
                         .phase = (uint32_t)v[8],
                         .tag = (uint32_t)v[9] };
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
    sc_liquid_def def = { .color = { .palette = -1 }, .dye = { .palette = -1 } };
    sc_read(s, site, &sc_list_liquid, table, &def);
    if (s->liquid_line == 0) {
        make_liquid(s, site, &def);
    } else if (GIVEN(spacing) || GIVEN(density) || GIVEN(viscosity) || GIVEN(tension) ||
               GIVEN(friction) || GIVEN(color) || GIVEN(name) || GIVEN(phases)) {
        sc_raise(s, SCENE_E_DUPLICATE, site, NULL, 0, NULL,
                 "settings of liquid{} were given on line %d; another one only adds to it",
                 s->liquid_line);
    }
    if (def.phases) {
        take_phases(s, site, table);
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

// The argument at `index`: the name of a phase.
static int take_phase_name(scene *s, const sc_site *site, int index)
{
    if (lua_type(s->L, index) != LUA_TSTRING) {
        sc_raise(s, SCENE_E_TYPE, site, NULL, 0, NULL, "%s takes names of phases behind its box",
                 site->construct);
    }
    return find_phase(s, site, lua_tostring(s->L, index));
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

// liquid_in(x0, y0, x1, y1, phase): of one phase, or of all: area [m^2], the highest place of a particle [m] or nil, their
// rms speed [m/s], their centre [m] or nils.
static int lua_liquid_in(lua_State *L)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, "liquid_in");
    double box[4];
    take_box(s, &site, box);
    sc_need_world(s);
    const int phase = lua_isnoneornil(L, 5) ? -1 : take_phase_name(s, &site, 5);
    int count, inside = 0;
    double squares = 0, top = 0, sum[2] = { 0, 0 };
    const double up = (double)plumb_world_up(s->world).y;
    const plumb_particle *p = plumb_liquid_particles(s->world, &count);
    sc_work(s, 10 + (uint64_t)count);
    for (int i = 0; i < count; i++) {
        const double x = (double)p[i].position.x, y = (double)p[i].position.y;
        const double u = (double)p[i].velocity.x, v = (double)p[i].velocity.y;
        if (x >= box[0] && x <= box[2] && y >= box[1] && y <= box[3] &&
            (phase < 0 || p[i].phase == (uint32_t)phase)) {
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

// The box that liquid_drain and liquid_change take.
typedef struct region {
    plumb_vec2 low, high; // [m]
    int count;            // particles to look at
    double area;          // [m^2] of one
} region;

static region take_region(scene *s, const sc_site *site)
{
    double box[4];
    region r = { .count = 0 };
    plumb_liquid_desc d = { 0 };
    take_box(s, site, box);
    sc_need_world(s);
    plumb_liquid_particles(s->world, &r.count);
    sc_work(s, 10 + (uint64_t)r.count);
    if (r.count > 0) {
        plumb_liquid_settings(s->world, &d);
        r.low = corner(box, &d), r.high = corner(box + 2, &d);
        r.area = (double)d.spacing * (double)d.spacing;
    }
    return r;
}

// They answer with the area of so many particles.
static int push_area(scene *s, const sc_site *site, const region *r, int count)
{
    if (count < 0) {
        sc_raise(s, SCENE_E_RANGE, site, NULL, 0, NULL, "%s takes a box x0 < x1, y0 < y1",
                 site->construct);
    }
    lua_pushnumber(s->L, count * r->area);
    return 1;
}

// liquid_drain(x0, y0, x1, y1): removes what is in the box; the area that went [m^2].
static int lua_liquid_drain(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "liquid_drain");
    const region r = take_region(s, &site);
    const int removed = r.count > 0 ? plumb_liquid_remove(s->world, r.low, r.high) : 0;
    return push_area(s, &site, &r, removed);
}

// liquid_change(x0, y0, x1, y1, from, to): what is of one phase in the box is of another; the area that changed [m^2].
static int lua_liquid_change(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "liquid_change");
    const region r = take_region(s, &site);
    const int from = take_phase_name(s, &site, 5), to = take_phase_name(s, &site, 6);
    const int changed =
        r.count > 0 ? plumb_liquid_change_phase(s->world, r.low, r.high, from, to) : 0;
    return push_area(s, &site, &r, changed);
}

scene_liquid scene_get_liquid(const scene *s, int phase)
{
    const sc_color *c = phase == 0 ? &s->liquid.color : &s->phases[phase - 1].color;
    return (scene_liquid){ c->palette, c->rgba };
}

void sc_open_liquid(lua_State *L)
{
    lua_register(L, "liquid", lua_liquid);
    lua_register(L, "liquid_in", lua_liquid_in);
    lua_register(L, "liquid_drain", lua_liquid_drain);
    lua_register(L, "liquid_change", lua_liquid_change);
}
