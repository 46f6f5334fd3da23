// shapes.c - the shape constructors: box{}, circle{}, ... as Lua objects, and their way into the
// world. A shape object is plain data; a body takes a copy, so one object may serve many bodies.
#include <string.h>

#include "internal.h"

const char *sc_shape_kind_name(sc_shape_kind kind)
{
    return sc_list_shapes[kind].name;
}

sc_shape_object *sc_to_shape(lua_State *L, int index)
{
    return luaL_testudata(L, index, SC_META_SHAPE);
}

void sc_build_shape(scene *s, const sc_site *site, sc_shape_kind kind, int table)
{
    lua_State *L = s->L;
    sc_shape_def def = { .kind = kind };
    sc_read(s, site, &sc_list_shapes[kind], table, &def);
    if (kind != SC_CIRCLE && SC_GIVEN(&sc_list_shapes[kind], &def, sc_shape_def, angle) &&
        SC_GIVEN(&sc_list_shapes[kind], &def, sc_shape_def, angle_deg)) {
        sc_raise(s, SCENE_E_CONFLICT, site, "angle_deg", 0, NULL,
                 "%s{} has both 'angle' and 'angle_deg'", site->construct);
    }
    sc_filter_given given = SC_FILTER_GIVEN(&sc_list_shapes[kind], &def, sc_shape_def);
    sc_filter_check(s, site, &given);
    if (def.angle_deg != 0) {
        def.angle = def.angle_deg * (3.141592653589793 / 180);
    }
    size_t points_size = (size_t)def.point_count * sizeof *def.points;
    int made = s->made.count;
    if (s->building) {
        *SC_PUSH(s, s->made) = (sc_made){ .kind = kind, .line = site->line };
    }
    sc_shape_object *object = lua_newuserdatauv(L, sizeof *object + points_size, 0);
    object->def = def;
    object->made = made;
    object->epoch = s->building ? s->epoch : -1;
    object->def.points = (double(*)[2])(object + 1);
    if (points_size > 0) {
        memcpy(object->def.points, s->points, points_size);
    }
    luaL_setmetatable(L, SC_META_SHAPE);
}

// ------------------------------------------------------------------------------- into the world

// A point of the shape in the frame of the body.
static plumb_vec2 place(const sc_shape_def *d, double x, double y)
{
    double c = sc_cos(d->angle);
    double s = sc_sin(d->angle);
    return (plumb_vec2){ (plumb_real)(d->at[0] + c * x - s * y),
                         (plumb_real)(d->at[1] + s * x + c * y) };
}

static void check_polygon(scene *s, const sc_site *site, const sc_shape_def *d,
                          const plumb_vec2 *points)
{
    plumb_convex convex;
    plumb_result result =
        plumb_convex_polygon(points, d->point_count, (plumb_real)d->round, &convex);
    if (result == PLUMB_E_CAPACITY) {
        sc_raise(s, SCENE_E_GEOMETRY, site, NULL, 0, NULL, "a polygon{} has at most %d corners",
                 PLUMB_POLYGON_MAX_VERTICES);
    }
    if (result != PLUMB_OK) {
        sc_raise(s, SCENE_E_GEOMETRY, site, NULL, 0, NULL, "this polygon{} has no area");
    }
    if (!plumb_outline_is_convex(points, d->point_count)) {
        sc_raise(s, SCENE_E_GEOMETRY, site, NULL, 0, "outline",
                 "this polygon{} is not convex, or its points are not in order");
    }
}

static void check_lines(scene *s, const sc_site *site, const sc_shape_def *d,
                        const plumb_vec2 *points)
{
    int links = d->closed ? d->point_count : d->point_count - 1;
    for (int i = 0; i < links; i++) {
        int next = (i + 1) % d->point_count;
        if (plumb_vec2_distance(points[i], points[next]) < PLUMB_LENGTH_MIN) {
            sc_raise(s, SCENE_E_GEOMETRY, site, NULL, 0, NULL,
                     "points %d and %d of %s{} are less than 0.0001 m apart", i + 1, next + 1,
                     sc_shape_kind_name(d->kind));
        }
    }
}

// The points of the shape in the frame of the body, in memory that Lua collects.
static plumb_vec2 *placed_points(scene *s, const sc_shape_def *d, int count)
{
    plumb_vec2 *points =
        lua_newuserdatauv(s->L, (size_t)(count > 0 ? count : 1) * sizeof *points, 0);
    for (int i = 0; i < count; i++) {
        if (d->kind == SC_CAPSULE) {
            points[i] = place(d, (i == 0 ? -0.5 : 0.5) * d->length, 0);
        } else if (d->kind == SC_REGULAR) {
            double a = 3.141592653589793 * (0.5 + 2.0 * i / d->n); // the first corner on top
            points[i] = place(d, d->r * sc_cos(a), d->r * sc_sin(a));
        } else {
            points[i] = place(d, d->points[i][0], d->points[i][1]);
        }
    }
    return points;
}

static void fill_points(plumb_shape_desc *desc, const plumb_vec2 *points, int count)
{
    desc->points = points;
    desc->count = count;
}

// The descriptor of the shape; its points are left on the Lua stack, where they stay alive.
static plumb_shape_desc describe(scene *s, const sc_site *site, const sc_shape_def *d)
{
    plumb_shape_desc desc = { 0 };
    int count = d->kind == SC_CAPSULE ? 2 : d->kind == SC_REGULAR ? (int)d->n : d->point_count;
    // An outline is cut into convex pieces: a comb of 256 points takes 10 ms.
    uint64_t n = (uint64_t)count;
    sc_work(s, d->kind == SC_OUTLINE ? 8 * n * n : 10 * n);
    const plumb_vec2 *points = placed_points(s, d, count);
    switch (d->kind) {
    case SC_CIRCLE:
        desc.kind = PLUMB_CIRCLE;
        desc.center = place(d, 0, 0);
        desc.radius = (plumb_real)d->r;
        break;
    case SC_CAPSULE:
        desc.kind = PLUMB_CAPSULE;
        desc.radius = (plumb_real)d->r;
        fill_points(&desc, points, count);
        break;
    case SC_BOX_SHAPE:
        desc.kind = PLUMB_BOX;
        desc.half = (plumb_vec2){ (plumb_real)(d->w / 2), (plumb_real)(d->h / 2) };
        desc.center = place(d, 0, 0);
        desc.angle = (plumb_real)d->angle;
        desc.radius = (plumb_real)d->round;
        break;
    case SC_POLYGON:
        check_polygon(s, site, d, points);
        desc.kind = PLUMB_POLYGON;
        desc.radius = (plumb_real)d->round;
        fill_points(&desc, points, count);
        break;
    case SC_REGULAR:
        desc.kind = PLUMB_POLYGON;
        desc.radius = (plumb_real)d->round;
        fill_points(&desc, points, count);
        break;
    case SC_OUTLINE:
        if (plumb_outline_check(points, count) != PLUMB_OK) {
            sc_raise(s, SCENE_E_GEOMETRY, site, NULL, 0, NULL,
                     "this outline{} crosses or touches itself, or has no area");
        }
        desc.kind = PLUMB_OUTLINE;
        fill_points(&desc, points, count);
        break;
    case SC_SEGMENT:
        check_lines(s, site, d, points);
        desc.kind = PLUMB_SEGMENT;
        fill_points(&desc, points, count);
        break;
    case SC_CHAIN:
    case SC_SHAPE_KINDS:
        check_lines(s, site, d, points);
        desc.kind = PLUMB_CHAIN;
        desc.closed = d->closed;
        fill_points(&desc, points, count);
        break;
    }
    return desc;
}

void sc_shape_convex(scene *s, const sc_site *site, plumb_convex *convex)
{
    sc_shape_object *object = sc_to_shape(s->L, -1);
    if (object->epoch == s->epoch) {
        s->made.items[object->made].used = true;
    }
    plumb_shape_desc d = describe(s, site, &object->def);
    plumb_result r = PLUMB_E_GEOMETRY;
    if (d.kind == PLUMB_CIRCLE) {
        r = plumb_convex_circle(d.center, d.radius, convex);
    } else if (d.kind == PLUMB_CAPSULE) {
        r = plumb_convex_capsule(d.points[0], d.points[1], d.radius, convex);
    } else if (d.kind == PLUMB_BOX) {
        r = plumb_convex_box(d.half, d.center, d.angle, d.radius, convex);
    } else if (d.kind == PLUMB_POLYGON) {
        r = plumb_convex_polygon(d.points, d.count, d.radius, convex);
    } else if (d.kind == PLUMB_SEGMENT) {
        r = plumb_convex_segment(d.points[0], d.points[1], convex);
    }
    lua_pop(s->L, 1);
    if (r != PLUMB_OK) {
        sc_raise(s, SCENE_E_GEOMETRY, site, NULL, 0, NULL, "%s{} takes a convex shape, not %s{}",
                 site->construct, sc_shape_kind_name(object->def.kind));
    }
}

static int outline_of(const plumb_shape_desc *d, const sc_shape_def *def, plumb_vec2 points[256])
{
    enum { AROUND = 64 };
    if (d->kind == PLUMB_CIRCLE) {
        for (int i = 0; i < AROUND; i++) {
            const double a = 2 * 3.141592653589793 * i / AROUND;
            points[i] = place(def, def->r * sc_cos(a), def->r * sc_sin(a));
        }
        return AROUND;
    }
    if (d->kind == PLUMB_BOX) {
        const double x = def->w / 2, y = def->h / 2;
        const plumb_vec2 corners[4] = { place(def, -x, -y), place(def, x, -y), place(def, x, y),
                                        place(def, -x, y) };
        memcpy(points, corners, sizeof corners);
        return 4;
    }
    if (d->kind == PLUMB_POLYGON || d->kind == PLUMB_OUTLINE) {
        memcpy(points, d->points, (size_t)d->count * sizeof *points);
        return d->count;
    }
    return 0;
}

int sc_shape_outline(scene *s, const sc_site *site, plumb_vec2 points[256])
{
    sc_shape_object *object = sc_to_shape(s->L, -1);
    if (object->epoch == s->epoch) {
        s->made.items[object->made].used = true;
    }
    const plumb_shape_desc d = describe(s, site, &object->def);
    const int count = outline_of(&d, &object->def, points);
    lua_pop(s->L, 1);
    if (count == 0 || object->def.round != 0) {
        sc_raise(s, SCENE_E_GEOMETRY, site, NULL, 0, NULL,
                 "%s{} takes circles, boxes, polygons and outlines without 'round', not this %s{}",
                 site->construct, sc_shape_kind_name(object->def.kind));
    }
    return count;
}

bool sc_shape_is_sensor(const sc_body *body, const sc_shape_def *shape)
{
    bool own = SC_GIVEN(&sc_list_shapes[shape->kind], shape, sc_shape_def, sensor);
    return own ? shape->sensor : body->def.sensor;
}

void sc_shape_create(scene *s, const sc_site *site, int index, const sc_body *body,
                     const sc_shape_def *shape)
{
    // Geometry is judged in the body; in Lua the message stands at the shape if it is on the same
    // line.
    sc_site own = *site;
    char path[160];
    own.construct = sc_shape_kind_name(shape->kind);
    if (site->path != NULL) {
        snprintf(path, sizeof path, "%s.shapes[%d]", site->path, index);
        own.path = path;
    }
    plumb_shape_desc desc = describe(s, &own, shape);
    const sc_material *material = shape->material != NULL ? shape->material : body->def.material;
    desc.material = material != NULL ? material->handle : (plumb_material)PLUMB_NULL_INIT;
    bool line_like = shape->kind == SC_SEGMENT || shape->kind == SC_CHAIN;
    desc.density = line_like             ? 0
                   : shape->density != 0 ? (plumb_real)shape->density
                                         : (plumb_real)body->def.density;
    desc.sensor = sc_shape_is_sensor(body, shape);
    desc.one_way = desc.sensor ? (plumb_one_way){ 0 } : sc_one_way_of(&body->def);
    desc.filter = sc_filter_resolve(
        s, &shape->filter, SC_FILTER_GIVEN(&sc_list_shapes[shape->kind], shape, sc_shape_def),
        &body->def.filter, SC_FILTER_GIVEN(&sc_list_body, &body->def, sc_body_def));
    if (plumb_is_null(plumb_shape_create(s->world, body->entity, &desc))) {
        sc_refused(s, &own, NULL, plumb_world_error(s->world).code, "%s{}", own.construct);
    }
    lua_pop(s->L, 1);
}

// ----------------------------------------------------------------------------- Lua's side of it

// box{1, 2}, box(1, 2) and box{w = 1, h = 2} are the same. Upvalue: the kind.
static int lua_shape(lua_State *L)
{
    scene *s = sc_of(L);
    sc_shape_kind kind = (sc_shape_kind)lua_tointeger(L, lua_upvalueindex(1));
    sc_site site = sc_here(s, sc_shape_kind_name(kind));
    int count = lua_gettop(L);
    bool numbers = count > 0;
    for (int i = 1; i <= count; i++) {
        numbers = numbers && lua_type(L, i) == LUA_TNUMBER;
    }
    if (numbers) {
        lua_createtable(L, count, 0);
        lua_insert(L, 1);
        for (int i = count; i >= 1; i--) {
            lua_rawseti(L, 1, i);
        }
    } else if (count != 1 || lua_type(L, 1) != LUA_TTABLE) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL, "%s takes one table: %s{...}",
                 site.construct, site.construct);
    }
    sc_build_shape(s, &site, kind, 1);
    return 1;
}

static int shape_collect(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_shape_object *object = sc_to_shape(L, 1);
    if (object != NULL && object->epoch == s->epoch && object->made < s->made.count) {
        s->made.items[object->made].collected = true;
    }
    return 0;
}

void sc_open_shapes(lua_State *L)
{
    luaL_newmetatable(L, SC_META_SHAPE);
    lua_pushcfunction(L, shape_collect);
    lua_setfield(L, -2, "__gc");
    lua_pushliteral(L, "shape");
    lua_setfield(L, -2, "__name");
    lua_pop(L, 1);
    for (int kind = 0; kind < SC_SHAPE_KINDS; kind++) {
        lua_pushinteger(L, kind);
        lua_pushcclosure(L, lua_shape, 1);
        lua_setglobal(L, sc_list_shapes[kind].name);
    }
}
