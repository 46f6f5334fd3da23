// softbody.c - soft bodies: made, changed, asked.
//
// Reads: arguments, checked first (softbody_check.c). Writes: the list of soft bodies. Cost: O(nodes and elements).
#include "api/softbody.h"

#include "sleep/sleep.h"
#include "softbody/softbody.h"
#include "world/check.h"
#include "world/destroy.h"
#include "world/rows.h"
#include "world/softbody_list.h"

#include <string.h>

//---- made ----------------------------------------------------------------------------------------

// Pins are kept by rising node.
static void put_pin(plumb_world *world, uint32_t row, const plumb_softbody_pin *pin)
{
    pl_softbodies *s = &world->softbodies;
    pl_softbody *item = &pl_softbody_items(s)[row];
    const uint32_t first = pl_softbody_place_of(s, row).pin;
    plumb_softbody_pin *pins = pl_softbody_pins(s);
    uint32_t at = s->pin_count++;
    for (; at > first + item->pins || (at > first && pins[at - 1].node > pin->node); --at) {
        pins[at] = pins[at - 1];
    }
    memset(&pins[at], 0, sizeof pins[at]);
    pins[at].node = pin->node, pins[at].body = pin->body, pins[at].point = pin->point;
    ++item->pins;
}

static bool reserve(plumb_world *world, const pl_softbody *item)
{
    pl_softbodies *s = &world->softbodies;
    const struct {
        pl_buffer *to;
        size_t count, more, size;
    } lists[] = { { &s->items, s->count, 1, sizeof(pl_softbody) },
                  { &s->nodes, s->node_count, item->nodes, sizeof(plumb_softbody_node) },
                  { &s->rests, s->rest_count, item->nodes, sizeof(pl_soft_rest) },
                  { &s->edges, s->edge_count, item->edges, sizeof(plumb_softbody_edge) },
                  { &s->bends, s->bend_count, item->bends, sizeof(plumb_softbody_bend) },
                  { &s->triangles, s->triangle_count, item->triangles,
                    sizeof(plumb_softbody_triangle) },
                  { &s->rings, s->ring_count, item->ring, sizeof(uint32_t) },
                  { &s->pins, s->pin_count, item->pins, sizeof(plumb_softbody_pin) } };
    bool room = pl_registry_reserve(&world->memory, &world->registry, 1);
    for (size_t i = 0; i < sizeof lists / sizeof lists[0] && room; ++i) {
        room = pl_buffer_reserve(&world->memory, lists[i].to,
                                 (lists[i].count + lists[i].more) * lists[i].size);
    }
    return room;
}

#define PUT(to, from, member) (to)->member = (from).member

static void put_elements(pl_softbodies *s, const plumb_softbody_desc *d)
{
    for (int i = 0; i < d->edge_count; ++i) {
        const plumb_softbody_edge e = pl_softbody_edge_of(d, i);
        plumb_softbody_edge *to = &pl_softbody_edges(s)[s->edge_count++];
        memset(to, 0, sizeof *to);
        PUT(to, e, a), PUT(to, e, b), PUT(to, e, flags), PUT(to, e, length);
        PUT(to, e, stiffness), PUT(to, e, damping), PUT(to, e, break_strain);
        PUT(to, e, yield_strain);
    }
    for (int i = 0; i < d->bend_count; ++i) {
        const plumb_softbody_bend b = pl_softbody_bend_of(d, i);
        plumb_softbody_bend *to = &pl_softbody_bends(s)[s->bend_count++];
        memset(to, 0, sizeof *to);
        PUT(to, b, a), PUT(to, b, b), PUT(to, b, c);
        PUT(to, b, stiffness), PUT(to, b, length), PUT(to, b, angle);
    }
    for (int i = 0; i < d->triangle_count; ++i) {
        const plumb_softbody_triangle t = pl_softbody_triangle_of(d, i);
        plumb_softbody_triangle *to = &pl_softbody_triangles(s)[s->triangle_count++];
        memset(to, 0, sizeof *to);
        PUT(to, t, a), PUT(to, t, b), PUT(to, t, c), PUT(to, t, young), PUT(to, t, poisson);
        PUT(to, t, damping), PUT(to, t, ab), PUT(to, t, ac);
    }
    for (int i = 0; i < d->ring_count; ++i) {
        pl_softbody_rings(s)[s->ring_count++] = d->ring[i];
    }
}

plumb_softbody plumb_softbody_create(plumb_world *world, const plumb_softbody_desc *desc)
{
    plumb_softbody made = PLUMB_NULL_INIT;
    pl_softbody item;
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        pl_check_pointer(world, __func__, "desc", desc) != PLUMB_OK ||
        pl_softbody_check_desc(world, __func__, desc, &item) != PLUMB_OK) {
        return made;
    }
    if (!reserve(world, &item)) {
        pl_fail_memory(world, __func__);
        return made;
    }
    pl_softbodies *s = &world->softbodies;
    const uint32_t row = s->count++;
    made.entity = pl_entity_claim(world, made.entity, PLUMB_KIND_SOFTBODY, row);
    item.entity = made;
    item.pins = 0;
    memcpy(&pl_softbody_items(s)[row], &item, sizeof item);
    for (int i = 0; i < desc->node_count; ++i) {
        plumb_softbody_node *to = &pl_softbody_nodes(s)[s->node_count++];
        memset(to, 0, sizeof *to);
        *to = desc->nodes[i];
        pl_softbody_rests(s)[s->rest_count++] = (pl_soft_rest){ 0, 0, 0, 0 };
    }
    put_elements(s, desc);
    for (int i = 0; i < desc->pin_count; ++i) {
        put_pin(world, row, &desc->pins[i]);
    }
    pl_softbody_see_box(world, row, pl_softbody_place_of(s, row));
    if (desc->asleep && !desc->no_sleep && !world->desc.no_sleep) {
        pl_softbody_lay(world, row, pl_softbody_place_of(s, row));
    }
    world->schedule_dirty = true;
    return made;
}

static plumb_result check_softbody(const plumb_world *world, const char *fn,
                                   plumb_softbody softbody, uint32_t *row)
{
    PL_TRY(pl_check_world(world));
    *row = pl_softbody_find(world, softbody);
    return *row != PL_NONE
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_HANDLE, fn,
                         "soft body %u:%u does not exist; it was destroyed or never made",
                         (unsigned)softbody.entity.index, (unsigned)softbody.entity.generation);
}

plumb_result plumb_softbody_destroy(plumb_world *world, plumb_softbody softbody)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_destroy_entity(world, softbody.entity);
    return PLUMB_OK;
}

plumb_result plumb_softbody_settings(const plumb_world *world, plumb_softbody softbody,
                                     plumb_softbody_desc *desc)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    const pl_softbodies *s = &world->softbodies;
    const pl_softbody *item = &pl_softbody_items(s)[row];
    const pl_softbody_place at = pl_softbody_place_of(s, row);
    *desc = (plumb_softbody_desc){
        .nodes = pl_softbody_nodes(s) + at.node,
        .edges = item->edges > 0 ? pl_softbody_edges(s) + at.edge : NULL,
        .bends = item->bends > 0 ? pl_softbody_bends(s) + at.bend : NULL,
        .triangles = item->triangles > 0 ? pl_softbody_triangles(s) + at.triangle : NULL,
        .ring = item->ring > 0 ? pl_softbody_rings(s) + at.ring : NULL,
        .pins = item->pins > 0 ? pl_softbody_pins(s) + at.pin : NULL,
        .node_count = (int)item->nodes,
        .edge_count = (int)item->edges,
        .bend_count = (int)item->bends,
        .triangle_count = (int)item->triangles,
        .ring_count = (int)item->ring,
        .pin_count = (int)item->pins,
        .friction = item->friction,
        .damping = item->damping,
        .pressure = item->pressure,
        .ambient = item->ambient,
        .area = item->area,
        .filter = item->filter,
        .no_sleep = item->no_sleep,
        .asleep = item->asleep && !item->due,
    };
    return PLUMB_OK;
}

int plumb_world_softbodies(const plumb_world *world, plumb_softbody *softbodies, int capacity)
{
    const int count = world == NULL ? 0 : (int)world->softbodies.count;
    for (int i = 0; i < count && i < capacity && softbodies != NULL; ++i) {
        softbodies[i] = pl_softbody_items(&world->softbodies)[i].entity;
    }
    return count;
}

//---- changed -------------------------------------------------------------------------------------

static plumb_result check_index(const plumb_world *world, const char *fn, const char *what, int i,
                                uint32_t count)
{
    return i >= 0 && (uint32_t)i < count
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_RANGE, fn, "%s is %d; it must be 0 to %d", what, i,
                         (int)count - 1);
}

plumb_result plumb_softbody_set_node(plumb_world *world, plumb_softbody softbody, int node,
                                     const plumb_softbody_node *value)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "value", value));
    pl_softbodies *s = &world->softbodies;
    PL_TRY(check_index(world, __func__, "node", node, pl_softbody_items(s)[row].nodes));
    PL_TRY(pl_softbody_check_node(world, __func__, value));
    const pl_softbody_place at = pl_softbody_place_of(s, row);
    plumb_softbody_node *to = &pl_softbody_nodes(s)[at.node + (uint32_t)node];
    _Static_assert(sizeof *to == 10 * sizeof(real), "a node is reals alone");
    if (memcmp(to, value, sizeof *to) == 0) {
        return PLUMB_OK; // nothing wakes
    }
    pl_softbody_disturb(world, row);
    *to = *value;
    pl_softbody_see_box(world, row, at);
    return PLUMB_OK;
}

plumb_result plumb_softbody_set_edge(plumb_world *world, plumb_softbody softbody, int edge,
                                     const plumb_softbody_edge *value)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "value", value));
    pl_softbodies *s = &world->softbodies;
    PL_TRY(check_index(world, __func__, "edge", edge, pl_softbody_items(s)[row].edges));
    PL_TRY(pl_softbody_check_edge(world, __func__, value));
    const pl_softbody_place at = pl_softbody_place_of(s, row);
    plumb_softbody_edge *to = &pl_softbody_edges(s)[at.edge + (uint32_t)edge];
    if (to->flags == value->flags && to->length == value->length &&
        to->stiffness == value->stiffness && to->damping == value->damping &&
        to->break_strain == value->break_strain && to->yield_strain == value->yield_strain) {
        return PLUMB_OK; // nothing wakes
    }
    pl_softbody_disturb(world, row);
    const bool cut = (value->flags & ~to->flags & PLUMB_EDGE_TORN) != 0;
    PUT(to, *value, flags), PUT(to, *value, length), PUT(to, *value, stiffness);
    PUT(to, *value, damping), PUT(to, *value, break_strain), PUT(to, *value, yield_strain);
    if (cut) {
        pl_softbody_tear(s, &pl_softbody_items(s)[row], at, to);
    }
    return PLUMB_OK;
}

plumb_result plumb_softbody_set_gas(plumb_world *world, plumb_softbody softbody, real pressure,
                                    real ambient)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_softbody *item = &pl_softbody_items(&world->softbodies)[row];
    if (item->ring == 0) {
        return pl_fail(world, PLUMB_E_STATE, __func__,
                       "the soft body has no ring; it must have one for gas to be in");
    }
    pl_softbody changed = *item;
    changed.pressure = pressure, changed.ambient = ambient;
    PL_TRY(pl_softbody_check_gas(world, __func__, &changed));
    if (item->pressure == pressure && item->ambient == ambient) {
        return PLUMB_OK; // nothing wakes
    }
    pl_softbody_disturb(world, row);
    item->pressure = pressure, item->ambient = ambient;
    return PLUMB_OK;
}

// Which pin of a soft body holds a node; PL_NONE: none does.
static uint32_t find_pin(const pl_softbodies *s, uint32_t row, int node)
{
    const plumb_softbody_pin *pins = pl_softbody_pins(s);
    const uint32_t first = pl_softbody_place_of(s, row).pin;
    for (uint32_t i = 0; i < pl_softbody_items(s)[row].pins; ++i) {
        if (pins[first + i].node == (uint32_t)node) {
            return i;
        }
    }
    return PL_NONE;
}

plumb_result plumb_softbody_hold(plumb_world *world, plumb_softbody softbody, int node,
                                 plumb_body body, plumb_vec2 point)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_softbodies *s = &world->softbodies;
    PL_TRY(check_index(world, __func__, "node", node, pl_softbody_items(s)[row].nodes));
    const plumb_softbody_pin pin = { (uint32_t)node, body, point };
    PL_TRY(pl_softbody_check_pin(world, __func__, &pin));
    if (!pl_buffer_reserve(&world->memory, &s->pins,
                           ((size_t)s->pin_count + 1) * sizeof(plumb_softbody_pin))) {
        return pl_fail_memory(world, __func__);
    }
    const uint32_t old = find_pin(s, row, node);
    const plumb_softbody_pin *held =
        old == PL_NONE ? NULL : &pl_softbody_pins(s)[pl_softbody_place_of(s, row).pin + old];
    if (held != NULL && plumb_same(held->body, body) && held->point.x == point.x &&
        held->point.y == point.y) {
        return PLUMB_OK; // nothing wakes
    }
    pl_softbody_disturb(world, row);
    if (old != PL_NONE) {
        pl_softbody_drop_pin(world, row, old);
    }
    put_pin(world, row, &pin);
    return PLUMB_OK;
}

plumb_result plumb_softbody_release(plumb_world *world, plumb_softbody softbody, int node)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_softbodies *s = &world->softbodies;
    PL_TRY(check_index(world, __func__, "node", node, pl_softbody_items(s)[row].nodes));
    const uint32_t pin = find_pin(s, row, node);
    if (pin == PL_NONE) {
        return pl_fail(world, PLUMB_E_STATE, __func__, "node %d is not pinned; it must be", node);
    }
    pl_softbody_disturb(world, row);
    pl_softbody_drop_pin(world, row, pin);
    return PLUMB_OK;
}

//---- sleep ---------------------------------------------------------------------------------------

bool plumb_softbody_is_awake(const plumb_world *world, plumb_softbody softbody)
{
    const uint32_t row = pl_softbody_find(world, softbody);
    const pl_softbody *item = row == PL_NONE ? NULL : &pl_softbody_items(&world->softbodies)[row];
    return item != NULL && (!item->asleep || item->due);
}

plumb_result plumb_softbody_wake(plumb_world *world, plumb_softbody softbody)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    pl_softbody_disturb(world, row);
    return PLUMB_OK;
}

plumb_result plumb_softbody_sleep(plumb_world *world, plumb_softbody softbody)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (world->desc.no_sleep) {
        return pl_fail(world, PLUMB_E_STATE, __func__,
                       "the world has no_sleep; see plumb_world_set_sleep");
    }
    pl_softbody *item = &pl_softbody_items(&world->softbodies)[row];
    item->due = false;
    return item->asleep ? PLUMB_OK
                        : pl_sleep_put_to_sleep(world, __func__, world->dynamic_count + row);
}

plumb_result plumb_softbody_set_no_sleep(plumb_world *world, plumb_softbody softbody, bool no_sleep)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    pl_softbody_items(&world->softbodies)[row].no_sleep = no_sleep;
    if (no_sleep) {
        pl_softbody_disturb(world, row);
    }
    return PLUMB_OK;
}

bool plumb_softbody_no_sleep(const plumb_world *world, plumb_softbody softbody)
{
    const uint32_t row = pl_softbody_find(world, softbody);
    return row != PL_NONE && pl_softbody_items(&world->softbodies)[row].no_sleep;
}

//---- measured ------------------------------------------------------------------------------------

static void sum_nodes(const pl_softbodies *s, const pl_softbody *item, pl_softbody_place at,
                      plumb_energy *e)
{
    const plumb_softbody_pin *pins = pl_softbody_pins(s);
    uint32_t pin = 0;
    for (uint32_t i = 0; i < item->nodes; ++i) {
        if (pin < item->pins && pins[at.pin + pin].node == i) {
            ++pin;
            continue;
        }
        const plumb_softbody_node *n = &pl_softbody_nodes(s)[at.node + i];
        const double m = (double)n->mass;
        const double x = pl_soft_exact(n->position.x, n->position_rest.x);
        const double y = pl_soft_exact(n->position.y, n->position_rest.y);
        const double u = pl_soft_exact(n->velocity.x, n->velocity_rest.x);
        const double v = pl_soft_exact(n->velocity.y, n->velocity_rest.y);
        e->kinetic += m * (u * u + v * v) / 2;
        e->momentum_x += m * u, e->momentum_y += m * v;
        e->angular_momentum += m * (x * v - y * u);
        e->mass += m;
        e->potential += m * x; // first moments: see below
        e->stored += m * y;
    }
}

void pl_softbodies_energy(const plumb_world *world, plumb_energy *energy)
{
    const pl_softbodies *s = &world->softbodies;
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < s->count; ++i) {
        const pl_softbody *item = &pl_softbody_items(s)[i];
        plumb_energy own = { 0 };
        sum_nodes(s, item, at, &own);
        energy->kinetic += own.kinetic;
        energy->momentum_x += own.momentum_x, energy->momentum_y += own.momentum_y;
        energy->angular_momentum += own.angular_momentum;
        energy->mass += own.mass;
        energy->potential -=
            (double)world->gravity.x * own.potential + (double)world->gravity.y * own.stored;
        energy->stored += pl_soft_elastic(world, i, at);
        at = pl_softbody_behind(at, item);
    }
}

plumb_result plumb_softbody_measure(const plumb_world *world, plumb_softbody softbody,
                                    plumb_softbody_state *state)
{
    uint32_t row;
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_pointer(world, __func__, "state", state));
    const pl_softbodies *s = &world->softbodies;
    const pl_softbody *item = &pl_softbody_items(s)[row];
    const pl_softbody_place at = pl_softbody_place_of(s, row);
    plumb_energy e = { 0 };
    sum_nodes(s, item, at, &e);
    *state = (plumb_softbody_state){ .momentum = { (real)e.momentum_x, (real)e.momentum_y },
                                     .mass = (real)e.mass,
                                     .kinetic = (real)e.kinetic,
                                     .elastic = (real)pl_soft_elastic(world, row, at) };
    if (e.mass > 0) {
        state->center = (plumb_vec2){ (real)(e.potential / e.mass), (real)(e.stored / e.mass) };
    }
    const plumb_softbody_node *nodes = pl_softbody_nodes(s) + at.node;
    for (uint32_t i = 0; i < item->edges; ++i) {
        const plumb_softbody_edge *edge = &pl_softbody_edges(s)[at.edge + i];
        const bool torn = (edge->flags & PLUMB_EDGE_TORN) != 0;
        const real strain =
            (pl_softbody_way(&nodes[edge->a], &nodes[edge->b]) - edge->length) / edge->length;
        state->strain = !torn && strain > state->strain ? strain : state->strain;
        state->tension = edge->tension > state->tension ? edge->tension : state->tension;
        state->torn += torn;
        state->torn_now += (edge->flags & PLUMB_EDGE_TORN_NOW) != 0;
    }
    if (item->ring > 0) {
        const double area = pl_soft_area(world, item, at);
        state->area = (real)area;
        state->pressure = (real)pl_soft_pressure(item, area);
    }
    return PLUMB_OK;
}
