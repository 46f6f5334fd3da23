// softbody.c - rope{}, cloth{}, jelly{}, balloon{}: ready-made soft bodies (plumb/softbody.h); softbody{}: one node by node,
// which is also what JSON has. Each answers with an object (softbody_api.c).
//
// In scenes nodes and edges count from 1.
#include <math.h>
#include <string.h>

#include "internal.h"

#define GIVEN(list, member) SC_GIVEN(list, d, sc_softbody_def, member)

static plumb_vec2 vec(const double v[2])
{
    return (plumb_vec2){ (plumb_real)v[0], (plumb_real)v[1] };
}

static plumb_filter filter_of(scene *s, const sc_site *site, const sc_list *list,
                              const sc_softbody_def *d)
{
    const sc_filter_given none = { 0 };
    const sc_filter_given given = { .category = GIVEN(list, filter.category),
                                    .collides = GIVEN(list, filter.collides),
                                    .ignores = GIVEN(list, filter.ignores) };
    sc_filter_check(s, site, &given);
    return sc_filter_resolve(s, &d->filter, given, &d->filter, none);
}

// Who says 0 means it: what is 0 in a descriptor would be a default.
static plumb_real or_none(const sc_list *list, const sc_softbody_def *d, size_t offset,
                          double value)
{
    return sc_given(list, d, offset) && value == 0 ? -1 : (plumb_real)value;
}

#define OR_NONE(list, member) or_none(list, d, offsetof(sc_softbody_def, member), d->member)

// ------------------------------------------------------------------------------------- ready made

static plumb_body end_of(scene *s, const sc_site *site, const char *key, const char *name)
{
    const plumb_body none = PLUMB_NULL_INIT;
    if (name[0] == 0) {
        return none;
    }
    const sc_body *b = sc_body_named(s, name);
    if (b == NULL) {
        sc_check_body_name(s, site, key, name);
        sc_raise(s, SCENE_E_NAME, site, key, 0, NULL, "'%s' of %s{} must name one body", key,
                 site->construct);
    }
    return b->entity;
}

static plumb_softbody make_rope(scene *s, const sc_site *site, const sc_softbody_def *d, int table)
{
    (void)table;
    const sc_list *list = &sc_list_softbodies[SC_ROPE];
    const plumb_rope_desc desc = { .from = vec(d->from),
                                   .to = vec(d->to),
                                   .length = (plumb_real)d->length,
                                   .nodes = (int)d->node_count,
                                   .mass = (plumb_real)d->mass,
                                   .stiffness = (plumb_real)d->stiffness,
                                   .damping = (plumb_real)d->damping,
                                   .bending = (plumb_real)d->bending,
                                   .drag = (plumb_real)d->drag,
                                   .radius = (plumb_real)d->radius,
                                   .friction = OR_NONE(list, friction),
                                   .break_strain = (plumb_real)d->break_strain,
                                   .yield_strain = (plumb_real)d->yield_strain,
                                   .pushes = d->pushes,
                                   .hold_from = (d->hold & SC_HOLD_FROM) != 0,
                                   .hold_to = (d->hold & SC_HOLD_TO) != 0,
                                   .from_body = end_of(s, site, "from_body", d->from_body),
                                   .to_body = end_of(s, site, "to_body", d->to_body),
                                   .filter = filter_of(s, site, list, d),
                                   .no_sleep = GIVEN(list, sleep) && !d->sleep };
    return plumb_rope_create(s->world, &desc);
}

static plumb_softbody make_cloth(scene *s, const sc_site *site, const sc_softbody_def *d, int table)
{
    (void)table;
    const sc_list *list = &sc_list_softbodies[SC_CLOTH];
    const plumb_cloth_desc desc = { .low = { (plumb_real)(d->at[0] - d->size[0] / 2),
                                             (plumb_real)(d->at[1] - d->size[1] / 2) },
                                    .high = { (plumb_real)(d->at[0] + d->size[0] / 2),
                                              (plumb_real)(d->at[1] + d->size[1] / 2) },
                                    .columns = (int)d->columns,
                                    .rows = (int)d->row_count,
                                    .mass = (plumb_real)d->mass,
                                    .stiffness = (plumb_real)d->stiffness,
                                    .shear = OR_NONE(list, shear),
                                    .damping = (plumb_real)d->damping,
                                    .drag = (plumb_real)d->drag,
                                    .radius = (plumb_real)d->radius,
                                    .friction = OR_NONE(list, friction),
                                    .break_strain = (plumb_real)d->break_strain,
                                    .hold_top = d->held == SC_HELD_TOP,
                                    .hold_corners = d->held == SC_HELD_CORNERS,
                                    .filter = filter_of(s, site, list, d),
                                    .no_sleep = GIVEN(list, sleep) && !d->sleep };
    return plumb_cloth_create(s->world, &desc);
}

static plumb_softbody make_jelly(scene *s, const sc_site *site, const sc_softbody_def *d, int table)
{
    const sc_list *list = &sc_list_softbodies[SC_JELLY];
    lua_State *L = s->L;
    plumb_vec2 points[256];
    if (d->shape_count != 1) {
        sc_raise(s, SCENE_E_RANGE, site, NULL, 0, NULL,
                 "jelly{} takes one shape, such as box{1, 1}");
    }
    lua_rawgeti(L, table, 1);
    const int count = sc_shape_outline(s, site, points);
    const plumb_jelly_desc desc = { .points = points,
                                    .count = count,
                                    .spacing = (plumb_real)d->spacing,
                                    .density = (plumb_real)d->density,
                                    .young = (plumb_real)d->young,
                                    .poisson = OR_NONE(list, poisson),
                                    .damping = OR_NONE(list, damping),
                                    .drag = (plumb_real)d->drag,
                                    .friction = OR_NONE(list, friction),
                                    .velocity = vec(d->velocity),
                                    .filter = filter_of(s, site, list, d),
                                    .no_sleep = GIVEN(list, sleep) && !d->sleep };
    return plumb_jelly_create(s->world, &desc);
}

static plumb_softbody make_balloon(scene *s, const sc_site *site, const sc_softbody_def *d,
                                   int table)
{
    (void)table;
    const sc_list *list = &sc_list_softbodies[SC_BALLOON];
    const plumb_skin_desc desc = { .center = vec(d->at),
                                   .radius = (plumb_real)d->radius,
                                   .nodes = (int)d->node_count,
                                   .mass = (plumb_real)d->mass,
                                   .stiffness = (plumb_real)d->stiffness,
                                   .damping = (plumb_real)d->damping,
                                   .bending = (plumb_real)d->bending,
                                   .drag = (plumb_real)d->drag,
                                   .pressure = (plumb_real)d->pressure,
                                   .ambient = (plumb_real)d->ambient,
                                   .friction = OR_NONE(list, friction),
                                   .break_strain = (plumb_real)d->break_strain,
                                   .velocity = vec(d->velocity),
                                   .filter = filter_of(s, site, list, d),
                                   .no_sleep = GIVEN(list, sleep) && !d->sleep };
    return plumb_skin_create(s->world, &desc);
}

// ------------------------------------------------------------------------------------- node by node

// The rows of a table `key` of the table at `table`, each of `width` numbers: a block on the stack, or null; how many.
static double *take_rows(scene *s, const sc_site *site, int table, const char *key, int width,
                         int *count)
{
    lua_State *L = s->L;
    *count = 0;
    if (lua_getfield(L, table, key) != LUA_TTABLE) {
        return NULL;
    }
    const lua_Integer rows = (lua_Integer)lua_rawlen(L, -1);
    if (rows > PLUMB_SOFTBODY_MAX) {
        sc_raise(s, SCENE_E_LIMIT, site, key, 0, NULL, "'%s' has more than %d rows", key,
                 PLUMB_SOFTBODY_MAX);
    }
    sc_work(s, 10 * (uint64_t)rows);
    double *out = lua_newuserdatauv(L, (size_t)(rows * width + 1) * sizeof *out, 0);
    for (lua_Integer i = 1; i <= rows; i++) {
        bool good = lua_rawgeti(L, -2, i) == LUA_TTABLE && (int)lua_rawlen(L, -1) == width;
        for (int k = 0; good && k < width; k++) {
            lua_rawgeti(L, -1, k + 1);
            good = lua_type(L, -1) == LUA_TNUMBER && isfinite(lua_tonumber(L, -1));
            out[(i - 1) * width + k] = good ? lua_tonumber(L, -1) : 0;
            lua_pop(L, 1);
        }
        if (!good) {
            sc_raise(s, SCENE_E_TYPE, site, key, 0, NULL, "row %d of '%s' must be %d numbers",
                     (int)i, key, width);
        }
        lua_pop(L, 1);
    }
    lua_remove(L, -2);
    *count = (int)rows;
    return out;
}

uint32_t sc_node_index(scene *s, const sc_site *site, const char *key, double number, int of)
{
    if (!(number >= 1 && number <= of && number == floor(number))) {
        sc_raise(s, SCENE_E_RANGE, site, key, 0, NULL, "'%s' names node %.10g; there are 1..%d",
                 key != NULL ? key : site->construct, number, of);
    }
    return (uint32_t)number - 1;
}

static void *block(scene *s, int count, size_t size)
{
    void *to = lua_newuserdatauv(s->L, (size_t)(count + 1) * size, 0);
    memset(to, 0, (size_t)(count + 1) * size);
    return to;
}

static void take_nodes(scene *s, const sc_site *site, int table, plumb_softbody_desc *desc)
{
    const double *v = take_rows(s, site, table, "nodes", 6, &desc->node_count);
    plumb_softbody_node *nodes = block(s, desc->node_count, sizeof *nodes);
    for (int i = 0; i < desc->node_count; i++, v += 6) {
        nodes[i] = (plumb_softbody_node){ .position = vec(v),
                                          .velocity = vec(v + 2),
                                          .mass = (plumb_real)v[4],
                                          .radius = (plumb_real)v[5] };
    }
    desc->nodes = nodes;
}

static void take_edges(scene *s, const sc_site *site, int table, plumb_softbody_desc *desc)
{
    const double *v = take_rows(s, site, table, "edges", 8, &desc->edge_count);
    plumb_softbody_edge *edges = block(s, desc->edge_count, sizeof *edges);
    for (int i = 0; i < desc->edge_count; i++, v += 8) {
        if (!(v[7] == 0 || v[7] == 1 || v[7] == 2 || v[7] == 3)) {
            sc_raise(s, SCENE_E_RANGE, site, "edges", 0, NULL,
                     "the last number of an edge is 0, 1 (it only pulls), 2 (torn) or 3");
        }
        edges[i] =
            (plumb_softbody_edge){ .a = sc_node_index(s, site, "edges", v[0], desc->node_count),
                                   .b = sc_node_index(s, site, "edges", v[1], desc->node_count),
                                   .length = (plumb_real)v[2],
                                   .stiffness = (plumb_real)v[3],
                                   .damping = (plumb_real)v[4],
                                   .break_strain = (plumb_real)v[5],
                                   .yield_strain = (plumb_real)v[6],
                                   .flags = (uint32_t)v[7] };
    }
    desc->edges = edges;
}

static void take_bends(scene *s, const sc_site *site, int table, plumb_softbody_desc *desc)
{
    const double *v = take_rows(s, site, table, "bends", 6, &desc->bend_count);
    plumb_softbody_bend *bends = block(s, desc->bend_count, sizeof *bends);
    for (int i = 0; i < desc->bend_count; i++, v += 6) {
        bends[i] =
            (plumb_softbody_bend){ .a = sc_node_index(s, site, "bends", v[0], desc->node_count),
                                   .b = sc_node_index(s, site, "bends", v[1], desc->node_count),
                                   .c = sc_node_index(s, site, "bends", v[2], desc->node_count),
                                   .stiffness = (plumb_real)v[3],
                                   .length = (plumb_real)v[4],
                                   .angle = (plumb_real)v[5] };
    }
    desc->bends = bends;
}

static void take_triangles(scene *s, const sc_site *site, int table, plumb_softbody_desc *desc)
{
    const double *v = take_rows(s, site, table, "triangles", 10, &desc->triangle_count);
    plumb_softbody_triangle *t = block(s, desc->triangle_count, sizeof *t);
    for (int i = 0; i < desc->triangle_count; i++, v += 10) {
        t[i] = (plumb_softbody_triangle){
            .a = sc_node_index(s, site, "triangles", v[0], desc->node_count),
            .b = sc_node_index(s, site, "triangles", v[1], desc->node_count),
            .c = sc_node_index(s, site, "triangles", v[2], desc->node_count),
            .young = (plumb_real)v[3],
            .poisson = (plumb_real)v[4],
            .damping = (plumb_real)v[5],
            .ab = vec(v + 6),
            .ac = vec(v + 8)
        };
    }
    desc->triangles = t;
}

static void take_ring(scene *s, const sc_site *site, int table, plumb_softbody_desc *desc)
{
    const double *v = take_rows(s, site, table, "ring", 1, &desc->ring_count);
    uint32_t *ring = block(s, desc->ring_count, sizeof *ring);
    for (int i = 0; i < desc->ring_count; i++) {
        ring[i] = sc_node_index(s, site, "ring", v[i], desc->node_count);
    }
    desc->ring = ring;
}

// {node, x, y} of the world, {node, x, y, "body"} of a body.
static void take_pins(scene *s, const sc_site *site, int table, plumb_softbody_desc *desc)
{
    lua_State *L = s->L;
    if (lua_getfield(L, table, "pins") != LUA_TTABLE) {
        return;
    }
    const int at = lua_gettop(L);
    desc->pin_count = (int)lua_rawlen(L, at);
    sc_work(s, 10 * (uint64_t)desc->pin_count);
    plumb_softbody_pin *pins = block(s, desc->pin_count, sizeof *pins);
    for (int i = 0; i < desc->pin_count; i++) {
        double v[3] = { 0 };
        bool good = lua_rawgeti(L, at, i + 1) == LUA_TTABLE;
        for (int k = 0; good && k < 3; k++) {
            lua_rawgeti(L, -1, k + 1);
            good = lua_type(L, -1) == LUA_TNUMBER && isfinite(lua_tonumber(L, -1));
            v[k] = good ? lua_tonumber(L, -1) : 0;
            lua_pop(L, 1);
        }
        if (good && lua_rawgeti(L, -1, 4) == LUA_TSTRING) {
            pins[i].body = end_of(s, site, "pins", lua_tostring(L, -1));
        }
        if (!good) {
            sc_raise(s, SCENE_E_TYPE, site, "pins", 0, NULL,
                     "pin %d must be a node, x, y and, in the frame of a body, its name", i + 1);
        }
        lua_settop(L, at + 1);
        pins[i].node = sc_node_index(s, site, "pins", v[0], desc->node_count);
        pins[i].point = vec(v + 1);
    }
    desc->pins = pins;
}

static plumb_softbody make_plain(scene *s, const sc_site *site, const sc_softbody_def *d, int table)
{
    const sc_list *list = &sc_list_softbodies[SC_SOFTBODY];
    const int top = lua_gettop(s->L);
    sc_need_stack(s, 32);
    plumb_softbody_desc desc = { .friction = (plumb_real)d->friction,
                                 .damping = (plumb_real)d->drag,
                                 .pressure = (plumb_real)d->pressure,
                                 .ambient = (plumb_real)d->ambient,
                                 .area = (plumb_real)d->area,
                                 .filter = filter_of(s, site, list, d),
                                 .no_sleep = GIVEN(list, sleep) && !d->sleep,
                                 .asleep = d->asleep };
    take_nodes(s, site, table, &desc);
    take_edges(s, site, table, &desc);
    take_bends(s, site, table, &desc);
    take_triangles(s, site, table, &desc);
    take_ring(s, site, table, &desc);
    take_pins(s, site, table, &desc);
    const plumb_softbody made = plumb_softbody_create(s->world, &desc);
    lua_settop(s->L, top);
    return made;
}

// ------------------------------------------------------------------------------------- one of them

void sc_build_softbody(scene *s, const sc_site *site, sc_softbody_kind kind, int table)
{
    static plumb_softbody (*const makers[])(scene *, const sc_site *, const sc_softbody_def *,
                                            int) = { [SC_ROPE] = make_rope,
                                                     [SC_CLOTH] = make_cloth,
                                                     [SC_JELLY] = make_jelly,
                                                     [SC_BALLOON] = make_balloon,
                                                     [SC_SOFTBODY] = make_plain };
    sc_need_world(s);
    const sc_list *list = &sc_list_softbodies[kind];
    table = lua_absindex(s->L, table);
    sc_softbody_def def = { .color = { .palette = -1 } };
    sc_read(s, site, list, table, &def);
    plumb_softbody_desc now;
    const plumb_softbody made = makers[kind](s, site, &def, table);
    if (plumb_is_null(made)) {
        sc_refused(s, site, NULL, plumb_world_error(s->world).code, "%s{}", list->name);
    }
    plumb_softbody_settings(s->world, made, &now);
    sc_work(s, 100 + 20 * ((uint64_t)now.node_count + (uint64_t)now.edge_count));
    *SC_PUSH(s, s->softbodies) = (sc_softbody){ .def = def, .kind = kind, .handle = made };
    plumb_softbody *object = lua_newuserdatauv(s->L, sizeof *object, 0);
    *object = made;
    luaL_setmetatable(s->L, SC_META_SOFTBODY);
}

static int make_one(lua_State *L, sc_softbody_kind kind)
{
    const char *name = sc_list_softbodies[kind].name;
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, name);
    if (lua_gettop(L) != 1 || lua_type(L, 1) != LUA_TTABLE) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL, "%s takes one table: %s{...}", name, name);
    }
    sc_build_softbody(s, &site, kind, 1);
    return 1;
}

static int lua_rope(lua_State *L)
{
    return make_one(L, SC_ROPE);
}

static int lua_cloth(lua_State *L)
{
    return make_one(L, SC_CLOTH);
}

static int lua_jelly(lua_State *L)
{
    return make_one(L, SC_JELLY);
}

static int lua_balloon(lua_State *L)
{
    return make_one(L, SC_BALLOON);
}

static int lua_softbody(lua_State *L)
{
    return make_one(L, SC_SOFTBODY);
}

scene_softbody scene_get_softbody(const scene *s, plumb_softbody handle)
{
    for (int i = 0; i < s->softbodies.count; i++) {
        const sc_softbody *b = &s->softbodies.items[i];
        if (plumb_same(b->handle, handle)) {
            return (scene_softbody){ b->def.color.palette, b->def.color.rgba };
        }
    }
    return (scene_softbody){ .palette = -1 };
}

void sc_open_softbody(lua_State *L)
{
    sc_open_softbody_methods(L);
    lua_register(L, "rope", lua_rope);
    lua_register(L, "cloth", lua_cloth);
    lua_register(L, "jelly", lua_jelly);
    lua_register(L, "balloon", lua_balloon);
    lua_register(L, "softbody", lua_softbody);
}
