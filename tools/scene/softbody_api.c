// softbody_api.c - methods of rope{}, cloth{}, jelly{}, balloon{} and softbody{}: they hold, free, cut, draw in and ask.
//
// In scenes nodes and edges count from 1.
#include <math.h>
#include <string.h>

#include "internal.h"

static plumb_softbody self_of(lua_State *L, const sc_site *site, plumb_softbody_desc *now)
{
    scene *s = sc_of(L);
    const plumb_softbody *object = luaL_checkudata(L, 1, SC_META_SOFTBODY);
    if (plumb_softbody_settings(s->world, *object, now) != PLUMB_OK) {
        sc_raise(s, SCENE_E_NAME, site, NULL, 0, NULL, "the soft body was removed");
    }
    sc_work(s, 10);
    return *object;
}

static int done(scene *s, const sc_site *site, plumb_result r)
{
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "%s", site->construct);
    }
    return 0;
}

// The node that argument 2 names.
static int node_of(lua_State *L, const sc_site *site, const plumb_softbody_desc *now)
{
    const double number = (double)luaL_checknumber(L, 2);
    return (int)sc_node_index(sc_of(L), site, NULL, number, now->node_count);
}

// rope:hold(node, x, y): in the world; rope:hold(node, x, y, body): in its frame.
static int soft_hold(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "hold");
    plumb_softbody_desc now;
    plumb_body body = PLUMB_NULL_INIT;
    const plumb_softbody self = self_of(L, &site, &now);
    const int node = node_of(L, &site, &now);
    const double at[2] = { luaL_checknumber(L, 3), luaL_checknumber(L, 4) };
    if (!lua_isnoneornil(L, 5) && !sc_is_world(L, 5) && !sc_body_at_index(L, 5, &body)) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 4, NULL, "hold takes a node, x, y and a body");
    }
    return done(s, &site,
                plumb_softbody_hold(s->world, self, node, body,
                                    (plumb_vec2){ (plumb_real)at[0], (plumb_real)at[1] }));
}

// rope:release(node)
static int soft_release(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "release");
    plumb_softbody_desc now;
    const plumb_softbody self = self_of(L, &site, &now);
    const int node = node_of(L, &site, &now);
    bool held = false;
    for (int i = 0; i < now.pin_count; i++) {
        held |= now.pins[i].node == (uint32_t)node;
    }
    if (!held) {
        sc_raise(s, SCENE_E_RANGE, &site, NULL, 1, NULL, "nothing holds node %d", node + 1);
    }
    return done(s, &site, plumb_softbody_release(s->world, self, node));
}

// A soft body, and the edge of it that argument 2 names.
typedef struct named_edge {
    sc_site site;
    plumb_softbody self;
    int number;
    plumb_softbody_edge edge;
} named_edge;

static named_edge edge_of(lua_State *L, const char *method)
{
    named_edge e = { .site = sc_here(sc_of(L), method) };
    plumb_softbody_desc now;
    e.self = self_of(L, &e.site, &now);
    const double number = (double)luaL_checknumber(L, 2);
    if (!(number >= 1 && number <= now.edge_count && number == floor(number))) {
        sc_raise(sc_of(L), SCENE_E_RANGE, &e.site, NULL, 1, NULL,
                 "there are edges 1..%d, not %.10g", now.edge_count, number);
    }
    e.number = (int)number - 1;
    e.edge = now.edges[e.number];
    return e;
}

static int change_edge(lua_State *L, const named_edge *e)
{
    scene *s = sc_of(L);
    return done(s, &e->site, plumb_softbody_set_edge(s->world, e->self, e->number, &e->edge));
}

// rope:cut(edge)
static int soft_cut(lua_State *L)
{
    named_edge e = edge_of(L, "cut");
    e.edge.flags |= PLUMB_EDGE_TORN;
    return change_edge(L, &e);
}

// rope:set_rest(edge, length [m]): a muscle, a winch
static int soft_set_rest(lua_State *L)
{
    named_edge e = edge_of(L, "set_rest");
    e.edge.length = (plumb_real)luaL_checknumber(L, 3);
    return change_edge(L, &e);
}

// rope:edge(n): its two nodes, its length at rest [m], whether it is torn
static int soft_edge(lua_State *L)
{
    const named_edge e = edge_of(L, "edge");
    lua_pushinteger(L, (lua_Integer)e.edge.a + 1);
    lua_pushinteger(L, (lua_Integer)e.edge.b + 1);
    lua_pushnumber(L, (double)e.edge.length);
    lua_pushboolean(L, (e.edge.flags & PLUMB_EDGE_TORN) != 0);
    return 4;
}

// balloon:set_gas(pressure [N/m])
static int soft_set_gas(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "set_gas");
    plumb_softbody_desc now;
    const plumb_softbody self = self_of(L, &site, &now);
    return done(
        s, &site,
        plumb_softbody_set_gas(s->world, self, (plumb_real)luaL_checknumber(L, 2), now.ambient));
}

// rope:node(n): x, y, vx, vy
static int soft_node(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "node");
    plumb_softbody_desc now;
    self_of(L, &site, &now);
    const plumb_softbody_node *n = &now.nodes[node_of(L, &site, &now)];
    lua_pushnumber(L, (double)n->position.x);
    lua_pushnumber(L, (double)n->position.y);
    lua_pushnumber(L, (double)n->velocity.x);
    lua_pushnumber(L, (double)n->velocity.y);
    return 4;
}

// rope:count(): nodes, edges
static int soft_count(lua_State *L)
{
    const sc_site site = sc_here(sc_of(L), "count");
    plumb_softbody_desc now;
    self_of(L, &site, &now);
    lua_pushinteger(L, now.node_count);
    lua_pushinteger(L, now.edge_count);
    return 2;
}

// rope:measure(): a table
static int soft_measure(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "measure");
    plumb_softbody_desc now;
    plumb_softbody_state m;
    done(s, &site, plumb_softbody_measure(s->world, self_of(L, &site, &now), &m));
    sc_work(s, (uint64_t)now.node_count + (uint64_t)now.edge_count);
    lua_newtable(L);
    sc_push_field(L, "x", m.center.x);
    sc_push_field(L, "y", m.center.y);
    sc_push_field(L, "momentum_x", m.momentum.x);
    sc_push_field(L, "momentum_y", m.momentum.y);
    sc_push_field(L, "mass", m.mass);
    sc_push_field(L, "kinetic", m.kinetic);
    sc_push_field(L, "elastic", m.elastic);
    sc_push_field(L, "strain", m.strain);
    sc_push_field(L, "tension", m.tension);
    sc_push_field(L, "area", m.area);
    sc_push_field(L, "pressure", m.pressure);
    sc_push_field(L, "torn", (plumb_real)m.torn);
    return 1;
}

// rope:awake(), wake(), sleep(): as of bodies
static int soft_awake(lua_State *L)
{
    const sc_site site = sc_here(sc_of(L), "awake");
    plumb_softbody_desc now;
    lua_pushboolean(L, plumb_softbody_is_awake(sc_of(L)->world, self_of(L, &site, &now)));
    return 1;
}

static int soft_wake(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "wake");
    plumb_softbody_desc now;
    return done(s, &site, plumb_softbody_wake(s->world, self_of(L, &site, &now)));
}

static int soft_sleep(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "sleep");
    plumb_softbody_desc now;
    return done(s, &site, plumb_softbody_sleep(s->world, self_of(L, &site, &now)));
}

// rope:remove()
static int soft_remove(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_site site = sc_here(s, "remove");
    plumb_softbody_desc now;
    const plumb_softbody self = self_of(L, &site, &now);
    for (int i = 0; i < s->softbodies.count; i++) {
        if (plumb_same(s->softbodies.items[i].handle, self)) {
            memmove(&s->softbodies.items[i], &s->softbodies.items[i + 1],
                    (size_t)(s->softbodies.count - 1 - i) * sizeof *s->softbodies.items);
            s->softbodies.count--;
            break;
        }
    }
    return done(s, &site, plumb_softbody_destroy(s->world, self));
}

void sc_open_softbody_methods(lua_State *L)
{
    static const luaL_Reg methods[] = { { "hold", soft_hold },         { "release", soft_release },
                                        { "cut", soft_cut },           { "set_gas", soft_set_gas },
                                        { "set_rest", soft_set_rest }, { "edge", soft_edge },
                                        { "node", soft_node },         { "count", soft_count },
                                        { "measure", soft_measure },   { "remove", soft_remove },
                                        { "awake", soft_awake },       { "wake", soft_wake },
                                        { "sleep", soft_sleep },       { NULL, NULL } };
    luaL_newmetatable(L, SC_META_SOFTBODY);
    lua_newtable(L);
    luaL_setfuncs(L, methods, 0);
    lua_setfield(L, -2, "__index");
    lua_pushliteral(L, "softbody");
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 1);
}
