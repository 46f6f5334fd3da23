// heat.c - bodies that melt, burn and grow: their records follow the shapes that the world gives them, those that are gone leave the
// scene and are told (on_gone); heat() answers with what the world's heat came to. Cost: O(bodies that may change) a step.
#include <stddef.h>
#include <string.h>

#include "internal.h"

// ------------------------------------------------------------------------------------ other shapes

// The first shape has another measure than the record.
static bool is_stale(const scene *s, const sc_body *b)
{
    plumb_shape shapes[1];
    plumb_convex c;
    if (b->def.shape_count == 0 || plumb_body_shapes(s->world, b->entity, shapes, 1) == 0) {
        return false;
    }
    const plumb_mass_properties now = plumb_shape_mass(s->world, shapes[0]);
    plumb_shape_piece(s->world, shapes[0], 0, &c, NULL);
    return now.mass != b->seen_mass || c.points[0].x != b->seen_corner.x ||
           c.points[0].y != b->seen_corner.y;
}

static void note(const scene *s, sc_body *b)
{
    plumb_shape shapes[1];
    plumb_convex c;
    if (plumb_body_shapes(s->world, b->entity, shapes, 1) > 0) {
        b->seen_mass = plumb_shape_mass(s->world, shapes[0]).mass;
        plumb_shape_piece(s->world, shapes[0], 0, &c, NULL);
        b->seen_corner = c.points[0];
    }
}

static void follow(scene *s, sc_body *b)
{
    if (!b->is_seen) {
        b->is_seen = true;
        note(s, b);
    } else if (is_stale(s, b)) {
        sc_step_work(s, 200);
        sc_body_refit(s, b);
        note(s, b);
    }
}

// Those that melt, burn or grow, and so may be others without a call.
static void follow_all(scene *s)
{
    static const size_t members[] = { offsetof(sc_body_def, growth),
                                      offsetof(sc_body_def, melting_point),
                                      offsetof(sc_body_def, ignition) };
    enum { count = sizeof members / sizeof *members };
    int rows[count];
    for (int k = 0; k < count; k++) {
        rows[k] = sc_row_of(&sc_list_body, members[k]);
    }
    for (int i = 0; i < s->bodies.count; i++) {
        sc_body *b = s->bodies.items[i];
        bool changes = false;
        for (int k = 0; k < count; k++) {
            changes |= sc_row_given(&sc_list_body, &b->def, rows[k]);
        }
        if (changes) {
            follow(s, b);
        }
    }
}

// ---------------------------------------------------------------------------------------- the end

// Joints that went with it.
static void forget_joints(scene *s)
{
    for (int i = s->joints.count - 1; i >= 0; i--) {
        if (!plumb_joint_valid(s->world, s->joints.items[i]->entity)) {
            sc_joint_release(s, s->joints.items[i]);
        }
    }
}

void sc_gone_take(scene *s)
{
    lua_State *L = s->L;
    int count;
    const plumb_body_gone *events = plumb_world_body_gone_events(s->world, &count);
    s->gone.count = 0;
    for (int i = 0; i < count; i++) {
        sc_body *b = events[i].user_data;
        if (b == NULL || !plumb_same(b->entity, events[i].body)) {
            continue;
        }
        sc_step_work(s, 200 + (uint64_t)s->bodies.count / 8 + (uint64_t)s->joints.count);
        sc_need_stack(s, 4);
        sc_gone *e = SC_PUSH(s, s->gone);
        *e = (sc_gone){ .event = events[i] };
        memcpy(e->name, b->def.name, sizeof e->name);
        sc_body_push(s, b);
        e->object = luaL_ref(L, LUA_REGISTRYINDEX);
        sc_body_depart(s, b);
        forget_joints(s);
        sc_excluded_forget(s, b->entity);
        sc_body_release(s, b);
    }
    follow_all(s);
}

static void tell(scene *s, const sc_gone *e, const sc_handler *h)
{
    static const char *const ends[] = { "melted", "burnt", "shrunk" };
    lua_State *L = s->L;
    if (h->contact.a[0] != 0 && !sc_name_matches(h->contact.a, e->name)) {
        return;
    }
    sc_need_stack(s, 6);
    lua_rawgeti(L, LUA_REGISTRYINDEX, h->contact.function);
    lua_rawgeti(L, LUA_REGISTRYINDEX, e->object);
    sc_push_told(L, SC_TOLD_GONE);
    sc_push_field(L, "x", e->event.position.x);
    sc_push_field(L, "y", e->event.position.y);
    sc_push_field(L, "mass", e->event.mass);
    lua_pushstring(L, ends[e->event.end]);
    lua_setfield(L, -2, "how");
    sc_call(s, 2, 0);
}

void sc_gone_tell(scene *s)
{
    const int handlers = s->handlers.count;
    for (int i = 0; i < s->gone.count; i++) {
        const sc_gone e = s->gone.items[i];
        sc_step_work(s, (uint64_t)handlers);
        for (int k = 0; k < handlers; k++) {
            const sc_handler h = s->handlers.items[k];
            if (h.kind == SC_ON_GONE) {
                tell(s, &e, &h);
            }
        }
        luaL_unref(s->L, LUA_REGISTRYINDEX, e.object);
    }
    s->gone.count = 0;
}

// ---------------------------------------------------------------------------------------- asking

// heat(): the world's sums, in a table.
static int lua_heat(lua_State *L)
{
    scene *s = sc_of(L);
    plumb_heat_sums sums;
    sc_need_world(s);
    sc_work(s, 20 + (uint64_t)s->bodies.count);
    plumb_world_heat(s->world, &sums);
    sc_push_told(L, SC_TOLD_HEAT);
#define FIELD(member)                                                                              \
    lua_pushnumber(L, sums.member);                                                                \
    lua_setfield(L, -2, #member);
    FIELD(content)
    FIELD(burnt)
    FIELD(heating)
    FIELD(burning)
    FIELD(held)
    FIELD(radiated)
    FIELD(carried)
    FIELD(melted)
    FIELD(gone)
    FIELD(owed)
    FIELD(mechanical)
#undef FIELD
    return 1;
}

void sc_open_heat(lua_State *L)
{
    lua_register(L, "heat", lua_heat);
}
