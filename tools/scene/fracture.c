// fracture.c - bodies that are cut, shatter, merge, grow and shrink: body:cut, :shatter, :merge, :scale, and on_shatter. The
// parts of a body become bodies of the scene, called as it is with a number behind ("pane.1"), with its looks and what it said of
// itself; their records have the shapes that the world has. Cost: O(shapes of the bodies).
#include <stdio.h>
#include <string.h>

#include "internal.h"

// ---------------------------------------------------------------------------------- records

static sc_material *material_of(const scene *s, plumb_material handle)
{
    for (int i = 0; i < s->materials.count; i++) {
        if (plumb_same(s->materials.items[i]->handle, handle)) {
            return s->materials.items[i];
        }
    }
    return NULL;
}

static void forget_shapes(scene *s, sc_body *b)
{
    for (int i = 0; i < b->def.shape_count; i++) {
        sc_shape_def *d = &b->shapes[i];
        sc_resize(s, d->points, (size_t)d->point_count * sizeof *d->points, 0);
    }
    sc_resize(s, b->shapes, (size_t)b->def.shape_count * sizeof *b->shapes, 0);
    b->shapes = NULL;
    b->def.shape_count = 0;
}

// One convex piece as a shape that a scene can say.
static void describe(scene *s, const plumb_convex *c, plumb_shape shape, sc_shape_def *d)
{
    *d = (sc_shape_def){ .kind = c->count == 1   ? SC_CIRCLE
                                 : c->count > 2  ? SC_POLYGON
                                 : c->radius > 0 ? SC_CAPSULE
                                                 : SC_SEGMENT };
    const sc_list *list = &sc_list_shapes[d->kind];
    if (c->count == 1) {
        d->r = (double)c->radius;
        d->at[0] = (double)c->points[0].x;
        d->at[1] = (double)c->points[0].y;
        SC_GIVE(list, d, sc_shape_def, r);
        SC_GIVE(list, d, sc_shape_def, at);
    } else if (d->kind == SC_CAPSULE) {
        const plumb_vec2 middle = plumb_vec2_lerp(c->points[0], c->points[1], (plumb_real)0.5);
        const plumb_vec2 way = plumb_vec2_sub(c->points[1], c->points[0]);
        d->at[0] = (double)middle.x;
        d->at[1] = (double)middle.y;
        d->angle = (double)plumb_atan2(way.y, way.x);
        d->length = (double)plumb_vec2_magnitude(way);
        d->r = (double)c->radius;
        SC_GIVE(list, d, sc_shape_def, at);
        SC_GIVE(list, d, sc_shape_def, angle);
        SC_GIVE(list, d, sc_shape_def, length);
        SC_GIVE(list, d, sc_shape_def, r);
    } else {
        d->points = sc_need(s, NULL, 0, (size_t)c->count * sizeof *d->points);
        d->point_count = c->count;
        for (int k = 0; k < c->count; k++) {
            d->points[k][0] = (double)c->points[k].x;
            d->points[k][1] = (double)c->points[k].y;
        }
        SC_GIVE(list, d, sc_shape_def, point_count);
        if (c->radius > 0) {
            d->round = (double)c->radius;
            SC_GIVE(list, d, sc_shape_def, round);
        }
    }
    if (plumb_shape_is_sensor(s->world, shape)) {
        d->sensor = true;
        SC_GIVE(list, d, sc_shape_def, sensor);
    }
    const sc_material *m = material_of(s, plumb_shape_material(s->world, shape));
    const double density = (double)plumb_shape_density(s->world, shape);
    d->material = material_of(s, plumb_shape_material(s->world, shape));
    if (m != NULL) {
        SC_GIVE(list, d, sc_shape_def, material);
    }
    if (density > 0 && (m == NULL || density != m->def.density)) {
        d->density = density;
        SC_GIVE(list, d, sc_shape_def, density);
    }
}

// All of them, on Lua's stack.
static plumb_shape *shapes_of(scene *s, plumb_body body, int *count)
{
    *count = plumb_body_shapes(s->world, body, NULL, 0);
    luaL_checkstack(s->L, 1, NULL);
    plumb_shape *all = lua_newuserdatauv(s->L, ((size_t)*count + 1) * sizeof *all, 0);
    plumb_body_shapes(s->world, body, all, *count);
    return all;
}

static plumb_joint *joints_of(scene *s, plumb_body body, int *count)
{
    *count = plumb_body_joints(s->world, body, NULL, 0);
    luaL_checkstack(s->L, 1, NULL);
    plumb_joint *all = lua_newuserdatauv(s->L, ((size_t)*count + 1) * sizeof *all, 0);
    plumb_body_joints(s->world, body, all, *count);
    return all;
}

// The record of a body whose shapes are others now.
static void refit(scene *s, sc_body *b)
{
    int count, pieces = 0;
    const plumb_shape *shapes = shapes_of(s, b->entity, &count);
    for (int i = 0; i < count; i++) {
        pieces += plumb_shape_piece_count(s->world, shapes[i]);
    }
    forget_shapes(s, b);
    b->shapes = sc_need(s, NULL, 0, (size_t)pieces * sizeof *b->shapes);
    for (int i = count - 1; i >= 0; i--) { // the oldest first, as they were said
        for (int k = 0; k < plumb_shape_piece_count(s->world, shapes[i]); k++) {
            plumb_convex c;
            plumb_shape_piece(s->world, shapes[i], k, &c, NULL);
            describe(s, &c, shapes[i], &b->shapes[b->def.shape_count]);
            b->def.shape_count++;
        }
    }
    lua_pop(s->L, 1);
}

// What the world shares among the parts.
static void reread(const scene *s, sc_body *b)
{
    const sc_list *list = &sc_list_body;
    sc_body_def *d = &b->def;
    const plumb_world *w = s->world;
    plumb_body_desc now;
    plumb_body_settings(w, b->entity, &now);
#define REREAD(member)                                                                             \
    d->member = (double)now.member;                                                                \
    SC_MARK(list, d, sc_body_def, member, now.member != 0)
    REREAD(mass);
    REREAD(inertia);
    REREAD(charge);
    REREAD(dipole);
    REREAD(drag);
    REREAD(fuel);
    REREAD(thrust);
    REREAD(exhaust);
    REREAD(break_force);
    REREAD(break_impulse);
    REREAD(break_energy);
    REREAD(break_cells);
#undef REREAD
}

void sc_body_refit(scene *s, sc_body *b)
{
    refit(s, b);
    reread(s, b);
}

static void rejoin(scene *s, plumb_body body)
{
    int count;
    const plumb_joint *joints = joints_of(s, body, &count);
    for (int i = 0; i < count; i++) {
        sc_joint *j = sc_joint_of(s, joints[i]);
        if (j != NULL) {
            j->def.a.body = plumb_joint_body_a(s->world, joints[i]);
            j->def.b.body = plumb_joint_body_b(s->world, joints[i]);
        }
    }
    lua_pop(s->L, 1);
}

// A part of a body becomes one of the scene.
static sc_body *adopt(scene *s, const sc_body *whole, plumb_body part)
{
    sc_body_def def = whole->def;
    def.shape_count = 0;
    int base = (int)strlen(whole->def.name);
    const char *dot = whole->is_part ? strrchr(whole->def.name, '.') : NULL;
    base =
        dot != NULL ? (int)(dot - whole->def.name) : base; // parts of "pane.3" are those of "pane"
    base = base < 50 ? base : 50;
    for (int number = 1, found = 0; found == 0; number++) {
        snprintf(def.name, sizeof def.name, "%.*s.%d", base, whole->def.name, number);
        found = sc_body_named(s, def.name) == NULL;
        sc_step_work(s, 1);
    }
    sc_body *b = sc_body_add(s, &def);
    b->entity = part;
    b->line = whole->line;
    b->is_part = true;
    b->set_rot = whole->set_rot;
    plumb_body_set_user_data(s->world, part, b);
    lua_State *L = s->L;
    sc_need_stack(s, 4);
    plumb_body *object = lua_newuserdatauv(L, sizeof *object, SC_BODY_KEEPSAKES);
    *object = part;
    luaL_setmetatable(L, SC_META_BODY);
    b->object = luaL_ref(L, LUA_REGISTRYINDEX);
    refit(s, b);
    reread(s, b);
    rejoin(s, part);
    return b;
}

// The list of the objects of the parts is left on the stack.
static void adopt_all(scene *s, sc_body *whole, const plumb_body *parts, int count)
{
    lua_State *L = s->L;
    sc_need_stack(s, 6);
    lua_createtable(L, count, 0);
    for (int i = 0; i < count; i++) {
        sc_body_push(s, adopt(s, whole, parts[i]));
        lua_rawseti(L, -2, i + 1);
    }
    if (count > 0) {
        refit(s, whole);
        reread(s, whole);
    }
}

// ---------------------------------------------------------------------------------- methods

#define PARTS_MOST 1024 // of one call

static int finish(const sc_body_call *c, const plumb_body *parts, int count)
{
    if (count < 0) {
        sc_body_check(c, plumb_world_error(c->world).code);
    }
    sc_work(c->s, 200 + 300 * (uint64_t)count);
    adopt_all(c->s, c->body, parts, count < PARTS_MOST ? count : PARTS_MOST);
    return 1;
}

// body:cut(x, y, dx, dy): along the line through a place in a direction. The new bodies, in a list.
static int method_cut(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "cut");
    int index = 2;
    const plumb_vec2 point = sc_vector(L, &index);
    const plumb_vec2 along = sc_vector(L, &index);
    plumb_body *parts = lua_newuserdatauv(L, PARTS_MOST * sizeof *parts, 0);
    return finish(&c, parts, plumb_body_cut(c.world, c.entity, point, along, parts, PARTS_MOST));
}

// body:shatter(x, y [, cells [, seed [, even]]])
static int method_shatter(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "shatter");
    int index = 2;
    plumb_shatter_desc d = { .point = sc_vector(L, &index) };
    d.cells = lua_isnoneornil(L, index) ? 0 : (int)luaL_checkinteger(L, index);
    d.seed = lua_isnoneornil(L, index + 1) ? 0 : (uint64_t)luaL_checkinteger(L, index + 1);
    d.even = lua_isnoneornil(L, index + 2) ? 0 : (plumb_real)sc_finite_number(L, index + 2);
    sc_work(c.s, 4000);
    plumb_body *parts = lua_newuserdatauv(L, PARTS_MOST * sizeof *parts, 0);
    return finish(&c, parts, plumb_body_shatter(c.world, c.entity, &d, parts, PARTS_MOST));
}

// body:merge(other): the energy that is lost [J].
static int method_merge(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "merge");
    const plumb_body *object = luaL_checkudata(L, 2, SC_META_BODY);
    sc_body *other = sc_body_of(c.s, *object);
    luaL_argcheck(L, other != NULL, 2, "must not be destroyed");
    luaL_argcheck(L, other != c.body, 2, "must be another body");
    int count;
    const plumb_joint *joints = joints_of(c.s, other->entity, &count);
    for (int i = 0; i < count; i++) { // those between the two go; their records are ours to forget
        const plumb_body a = plumb_joint_body_a(c.world, joints[i]);
        const plumb_body b = plumb_joint_body_b(c.world, joints[i]);
        if (plumb_same(a, c.entity) || plumb_same(b, c.entity)) {
            sc_joint *record = sc_joint_of(c.s, joints[i]);
            sc_body_check(&c, plumb_joint_destroy(c.world, joints[i]));
            sc_joint_release(c.s, record);
        }
    }
    sc_work(c.s, 400 + (uint64_t)c.s->bodies.count / 8);
    double lost = 0;
    sc_body_depart(c.s, other);
    sc_body_check(&c, plumb_body_merge(c.world, c.entity, other->entity, &lost));
    sc_excluded_forget(c.s, other->entity);
    sc_body_release(c.s, other);
    refit(c.s, c.body);
    reread(c.s, c.body);
    rejoin(c.s, c.entity);
    lua_pushnumber(L, lost);
    return 1;
}

static int method_scale(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "scale");
    sc_body_check(&c, plumb_body_scale(c.world, c.entity, (plumb_real)sc_finite_number(L, 2)));
    sc_work(c.s, 200);
    refit(c.s, c.body);
    reread(c.s, c.body);
    return 0;
}

const luaL_Reg sc_fracture_methods[] = {
    { "cut", method_cut },
    { "merge", method_merge },
    { "scale", method_scale },
    { "shatter", method_shatter },
    { NULL, NULL },
};

// ---------------------------------------------------------------------------------- events

// The parts of what broke by itself become bodies of the scene, before anybody is told of anything.
void sc_shatters_take(scene *s)
{
    int count, all;
    const plumb_body_break *events = plumb_world_body_break_events(s->world, &count);
    const plumb_body *parts = plumb_world_body_break_parts(s->world, &all);
    lua_State *L = s->L;
    s->shatters.count = 0;
    for (int i = 0; i < count; i++) {
        sc_body *whole = sc_body_of(s, events[i].body);
        if (whole == NULL) {
            continue;
        }
        sc_step_work(s, 200 + 300 * (uint64_t)events[i].part_count);
        adopt_all(s, whole, parts + events[i].first_part, events[i].part_count);
        sc_shattered *e = SC_PUSH(s, s->shatters);
        *e = (sc_shattered){ events[i], luaL_ref(L, LUA_REGISTRYINDEX) };
    }
}

static void tell(scene *s, const sc_shattered *e, const sc_handler *h)
{
    lua_State *L = s->L;
    const sc_body *body = sc_body_of(s, e->event.body), *other = sc_body_of(s, e->event.other);
    if (body == NULL || (h->contact.a[0] != 0 && !sc_name_matches(h->contact.a, body->def.name)) ||
        (h->contact.b[0] != 0 &&
         (other == NULL || !sc_name_matches(h->contact.b, other->def.name)))) {
        return;
    }
    lua_rawgeti(L, LUA_REGISTRYINDEX, h->contact.function);
    sc_body_push(s, body);
    sc_push_told(L, SC_TOLD_SHATTER);
    sc_push_field(L, "x", e->event.point.x);
    sc_push_field(L, "y", e->event.point.y);
    sc_push_field(L, "nx", e->event.normal.x);
    sc_push_field(L, "ny", e->event.normal.y);
    sc_push_field(L, "impulse", e->event.impulse);
    sc_push_field(L, "energy", e->event.energy);
    lua_rawgeti(L, LUA_REGISTRYINDEX, e->parts);
    lua_setfield(L, -2, "parts");
    if (other != NULL) {
        sc_body_push(s, other);
        lua_setfield(L, -2, "other");
    }
    sc_call(s, 2, 0);
}

void sc_shatters_tell(scene *s)
{
    const int handlers = s->handlers.count;
    for (int i = 0; i < s->shatters.count; i++) {
        const sc_shattered e = s->shatters.items[i];
        sc_step_work(s, (uint64_t)handlers);
        for (int k = 0; k < handlers; k++) {
            const sc_handler h = s->handlers.items[k];
            if (h.kind == SC_ON_SHATTER) {
                tell(s, &e, &h);
            }
        }
        luaL_unref(s->L, LUA_REGISTRYINDEX, e.parts);
    }
    s->shatters.count = 0;
}
