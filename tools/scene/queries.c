// queries.c - what handlers ask the world: ray{}, cast{}, nearest{}, inside{}. Bodies are answered,
// not shapes. To add one: a list in lists_play.c, a function here.
#include "internal.h"

typedef struct question {
    scene *s;
    sc_site site;
    sc_query_def def;
    plumb_query_filter filter;
} question;

static plumb_vec2 vec(const double v[2])
{
    return (plumb_vec2){ (plumb_real)v[0], (plumb_real)v[1] };
}

static question ask(lua_State *L, sc_query kind)
{
    const sc_list *list = &sc_list_queries[kind];
    question q = { .s = sc_of(L), .site = sc_here(sc_of(L), list->name) };
    if (lua_gettop(L) != 1 || lua_type(L, 1) != LUA_TTABLE) {
        sc_raise(q.s, SCENE_E_TYPE, &q.site, NULL, 0, NULL, "%s takes one table: %s{...}",
                 list->name, list->name);
    }
    sc_need_world(q.s);
    sc_read(q.s, &q.site, list, 1, &q.def);
    sc_query_work(q.s);
    sc_check_body_name(q.s, &q.site, "ignore", q.def.ignore);
    const sc_body *ignored = q.def.ignore[0] != 0 ? sc_body_named(q.s, q.def.ignore) : NULL;
    q.filter.ignore_body = ignored != NULL ? ignored->entity : (plumb_body)PLUMB_NULL_INIT;
    q.filter.one_way = q.def.one_way;
    q.filter.sensors = q.def.sensors;
    return q;
}

// body, x, y, nx, ny, fraction; nil where there is none.
static int answer(question *q, bool met, plumb_body body, plumb_vec2 point, plumb_vec2 normal,
                  plumb_real fraction)
{
    lua_State *L = q->s->L;
    const sc_body *b = met ? sc_body_of(q->s, body) : NULL;
    if (b == NULL) {
        lua_pushnil(L);
        return 1;
    }
    sc_body_push(q->s, b);
    lua_pushnumber(L, (double)point.x);
    lua_pushnumber(L, (double)point.y);
    lua_pushnumber(L, (double)normal.x);
    lua_pushnumber(L, (double)normal.y);
    lua_pushnumber(L, (double)fraction);
    return 6;
}

static int lua_ray(lua_State *L)
{
    question q = ask(L, SC_RAY);
    plumb_ray_hit hit = { 0 };
    bool met = plumb_world_ray(q.s->world, vec(q.def.from), vec(q.def.to), &q.filter, &hit);
    return answer(&q, met, hit.body, hit.point, hit.normal, hit.fraction);
}

// cast{ box{1, 1}, from = {0, 5}, to = {0, 0} }: from where it would first touch.
static int lua_cast(lua_State *L)
{
    question q = ask(L, SC_CAST);
    if (q.def.shape_count != 1) {
        sc_raise(q.s, SCENE_E_MISSING, &q.site, NULL, 0, NULL,
                 "cast{} needs one shape such as circle{0.5}, not %d", q.def.shape_count);
    }
    plumb_convex convex;
    lua_rawgeti(L, 1, 1);
    sc_shape_convex(q.s, &q.site, &convex);
    plumb_vec2 from = vec(q.def.from);
    plumb_cast cast = { .convex = &convex,
                        .transform = plumb_transform_make(from, (plumb_real)q.def.angle),
                        .translation = plumb_vec2_sub(vec(q.def.to), from) };
    plumb_cast_hit hit = { 0 };
    bool met = plumb_world_cast(q.s->world, &cast, &q.filter, &hit);
    return answer(&q, met, hit.body, hit.point, hit.normal, hit.fraction);
}

// body, x, y, distance; nil where none is near.
static int lua_nearest(lua_State *L)
{
    question q = ask(L, SC_NEAREST);
    plumb_nearest_hit hit = { 0 };
    plumb_real within = q.def.within > 0 ? (plumb_real)q.def.within : PLUMB_REAL_MAX;
    bool met = plumb_world_nearest(q.s->world, vec(q.def.from), within, &q.filter, &hit);
    int results = answer(&q, met, hit.body, hit.point, (plumb_vec2){ 0, 0 }, 0);
    if (results == 6) {
        lua_pop(L, 3);
        lua_pushnumber(L, (double)hit.distance);
    }
    return results == 6 ? 4 : 1;
}

// A list of the bodies that contain a point.
static int lua_inside(lua_State *L)
{
    question q = ask(L, SC_INSIDE);
    plumb_vec2 at = vec(q.def.from);
    int count = plumb_world_overlap_point(q.s->world, at, &q.filter, NULL, 0), found = 0;
    count = count > 0 ? count : 0;
    plumb_shape *shapes = lua_newuserdatauv(L, ((size_t)count + 1) * sizeof *shapes, 0);
    plumb_world_overlap_point(q.s->world, at, &q.filter, shapes, count);
    lua_newtable(L);
    sc_work(q.s, 10 * (uint64_t)count);
    q.s->list_number++;
    for (int i = 0; i < count; i++) {
        sc_body *b = sc_body_of(q.s, plumb_shape_body(q.s->world, shapes[i]));
        if (b != NULL && b->listed != q.s->list_number) {
            b->listed = q.s->list_number;
            sc_body_push(q.s, b);
            lua_rawseti(L, -2, ++found);
        }
    }
    return 1;
}

void sc_open_queries(lua_State *L)
{
    lua_register(L, "ray", lua_ray);
    lua_register(L, "cast", lua_cast);
    lua_register(L, "nearest", lua_nearest);
    lua_register(L, "inside", lua_inside);
}
