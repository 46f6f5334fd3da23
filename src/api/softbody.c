// softbody.c - soft bodies: made, changed, asked.
//
// Reads: arguments, checked first. Writes: the list of soft bodies. Cost: O(nodes and elements).
#include "plumb/softbody.h"

#include "softbody/softbody.h"
#include "world/check.h"
#include "world/destroy.h"
#include "world/filter.h"
#include "world/rows.h"
#include "world/softbody_list.h"
#include "world/wrap.h"

#include <math.h>
#include <string.h>

#define FAR    ((real)1e9)
#define SPEED  ((real)PL_SOFT_SPEED)
#define STIFF  ((real)1e15)
#define LENGTH ((real)1e6)
#define SHORT  ((real)1e-6) // [m] of a length at rest, at least

//---- what is sound, of a call and of an image ----------------------------------------------------

// A number of an element, and between what it lies.
typedef struct number {
    const char *name;
    real value, low, high;
} number;

enum { NUMBERS = 10 };

static int list_node(const plumb_softbody_node *n, number out[NUMBERS])
{
    const number all[] = { { "node position.x", n->position.x, -FAR, FAR },
                           { "node position.y", n->position.y, -FAR, FAR },
                           { "node velocity.x", n->velocity.x, -SPEED, SPEED },
                           { "node velocity.y", n->velocity.y, -SPEED, SPEED },
                           { "node mass", n->mass, (real)1e-9, FAR },
                           { "node radius", n->radius, 0, LENGTH },
                           { "node position_rest.x", n->position_rest.x, -1000, 1000 },
                           { "node position_rest.y", n->position_rest.y, -1000, 1000 },
                           { "node velocity_rest.x", n->velocity_rest.x, -1, 1 },
                           { "node velocity_rest.y", n->velocity_rest.y, -1, 1 } };
    memcpy(out, all, sizeof all);
    return NUMBERS;
}

static int list_edge(const plumb_softbody_edge *e, number out[NUMBERS])
{
    const number all[] = { { "edge length", e->length, SHORT, LENGTH },
                           { "edge stiffness", e->stiffness, 0, STIFF },
                           { "edge damping", e->damping, 0, STIFF },
                           { "edge break_strain", e->break_strain, 0, LENGTH },
                           { "edge yield_strain", e->yield_strain, 0, LENGTH } };
    memcpy(out, all, sizeof all);
    return 5;
}

static int list_bend(const plumb_softbody_bend *b, number out[NUMBERS])
{
    const number all[] = { { "bend stiffness", b->stiffness, 0, STIFF },
                           { "bend length", b->length, SHORT, LENGTH },
                           { "bend angle", b->angle, (real)-3.1415928, (real)3.1415928 } };
    memcpy(out, all, sizeof all);
    return 3;
}

static int list_triangle(const plumb_softbody_triangle *t, number out[NUMBERS])
{
    const number all[] = { { "triangle young", t->young, (real)1e-6, STIFF },
                           { "triangle poisson", t->poisson, 0, (real)0.95 },
                           { "triangle damping", t->damping, 0, 1000 },
                           { "triangle ab.x", t->ab.x, -LENGTH, LENGTH },
                           { "triangle ab.y", t->ab.y, -LENGTH, LENGTH },
                           { "triangle ac.x", t->ac.x, -LENGTH, LENGTH },
                           { "triangle ac.y", t->ac.y, -LENGTH, LENGTH },
                           { "area of a triangle at rest", t->ab.x * t->ac.y - t->ab.y * t->ac.x,
                             (real)1e-12, FAR } };
    memcpy(out, all, sizeof all);
    return 8;
}

static int list_item(const pl_softbody *s, number out[NUMBERS])
{
    const real gas = (real)1e12;
    const number all[] = { { "friction", s->friction, 0, 1000 },
                           { "damping", s->damping, 0, SPEED },
                           { "pressure", s->pressure, 0, gas },
                           { "ambient", s->ambient, 0, gas },
                           { "area", s->area, s->ring > 0 ? (real)1e-9 : 0, FAR } };
    memcpy(out, all, sizeof all);
    return 5;
}

static plumb_result check_numbers(const plumb_world *world, const char *fn, const number *n,
                                  int count)
{
    for (int i = 0; i < count; ++i) {
        PL_TRY(pl_check_range(world, fn, n[i].name, n[i].value, n[i].low, n[i].high));
    }
    return PLUMB_OK;
}

static bool are_sound(const number *n, int count)
{
    bool sound = true;
    for (int i = 0; i < count; ++i) {
        sound &= n[i].value >= n[i].low && n[i].value <= n[i].high;
    }
    return sound;
}

#define FLAGS_MOST (PLUMB_EDGE_PULLS | PLUMB_EDGE_TORN | PLUMB_EDGE_TORN_NOW)

static bool is_edge_of(const plumb_softbody_edge *e, uint32_t nodes)
{
    return e->a < nodes && e->b < nodes && e->a != e->b;
}

static bool are_three_of(uint32_t a, uint32_t b, uint32_t c, uint32_t nodes)
{
    return a < nodes && b < nodes && c < nodes && a != b && b != c && a != c;
}

// No node is pinned twice, none is in the ring twice.
static bool is_new(const uint32_t *first, uint32_t stride, uint32_t i, uint32_t node)
{
    for (uint32_t k = 0; k < i; ++k) {
        if (*(const uint32_t *)(const void *)((const char *)first + (size_t)k * stride) == node) {
            return false;
        }
    }
    return true;
}

static bool is_item_sound(const pl_softbodies *s, const pl_softbody *item, pl_softbody_place at)
{
    number n[NUMBERS];
    bool sound = item->nodes > 0 && are_sound(n, list_item(item, n)) &&
                 *(const uint8_t *)&item->filter.nothing <= 1 &&
                 (item->ring == 0 || item->ring >= 3);
    for (uint32_t i = 0; i < item->nodes && sound; ++i) {
        sound = are_sound(n, list_node(&pl_softbody_nodes(s)[at.node + i], n));
    }
    for (uint32_t i = 0; i < item->edges && sound; ++i) {
        const plumb_softbody_edge *e = &pl_softbody_edges(s)[at.edge + i];
        sound = is_edge_of(e, item->nodes) && e->flags <= FLAGS_MOST &&
                are_sound(n, list_edge(e, n)) && e->tension - e->tension == 0;
    }
    for (uint32_t i = 0; i < item->bends && sound; ++i) {
        const plumb_softbody_bend *b = &pl_softbody_bends(s)[at.bend + i];
        sound = are_three_of(b->a, b->b, b->c, item->nodes) && are_sound(n, list_bend(b, n));
    }
    for (uint32_t i = 0; i < item->triangles && sound; ++i) {
        const plumb_softbody_triangle *t = &pl_softbody_triangles(s)[at.triangle + i];
        sound = are_three_of(t->a, t->b, t->c, item->nodes) && are_sound(n, list_triangle(t, n));
    }
    for (uint32_t i = 0; i < item->ring && sound; ++i) {
        sound = pl_softbody_rings(s)[at.ring + i] < item->nodes;
    }
    const plumb_softbody_pin *pins = pl_softbody_pins(s) + at.pin;
    for (uint32_t i = 0; i < item->pins && sound; ++i) {
        const plumb_vec2 p = pins[i].point;
        sound = pins[i].node < item->nodes && p.x >= -FAR && p.x <= FAR && p.y >= -FAR &&
                p.y <= FAR && (i == 0 || pins[i].node > pins[i - 1].node);
    }
    return sound;
}

bool pl_softbodies_are_sound(const pl_softbodies *s)
{
    uint64_t sum[6] = { 0 };
    for (uint32_t i = 0; i < s->count; ++i) {
        const pl_softbody *item = &pl_softbody_items(s)[i];
        sum[0] += item->nodes, sum[1] += item->edges, sum[2] += item->bends;
        sum[3] += item->triangles, sum[4] += item->ring, sum[5] += item->pins;
    }
    bool sound = sum[0] == s->node_count && sum[1] == s->edge_count && sum[2] == s->bend_count &&
                 sum[3] == s->triangle_count && sum[4] == s->ring_count && sum[5] == s->pin_count;
    pl_softbody_place at = { 0, 0, 0, 0, 0, 0 };
    for (uint32_t i = 0; i < s->count && sound; ++i) {
        const pl_softbody *item = &pl_softbody_items(s)[i];
        sound = is_item_sound(s, item, at);
        at = pl_softbody_behind(at, item);
    }
    return sound;
}

//---- made ----------------------------------------------------------------------------------------

static real way_between(const plumb_softbody_node *a, const plumb_softbody_node *b)
{
    const double x = (double)b->position.x - (double)a->position.x;
    const double y = (double)b->position.y - (double)a->position.y;
    return (real)sqrt(x * x + y * y);
}

static plumb_vec2 offset(const plumb_softbody_node *a, const plumb_softbody_node *b)
{
    return (plumb_vec2){ b->position.x - a->position.x, b->position.y - a->position.y };
}

static real area_of(const plumb_softbody_desc *d)
{
    double area = 0;
    for (int i = 0; i < d->ring_count; ++i) {
        const plumb_vec2 p = d->nodes[d->ring[i]].position;
        const plumb_vec2 q = d->nodes[d->ring[(i + 1) % d->ring_count]].position;
        area += ((double)p.x * (double)q.y - (double)p.y * (double)q.x) / 2;
    }
    return (real)area;
}

// Elements with what they have at rest resolved.
static plumb_softbody_edge edge_of(const plumb_softbody_desc *d, int i)
{
    plumb_softbody_edge e = d->edges[i];
    e.length = e.length == 0 ? way_between(&d->nodes[e.a], &d->nodes[e.b]) : e.length;
    e.tension = 0;
    return e;
}

static plumb_softbody_bend bend_of(const plumb_softbody_desc *d, int i)
{
    plumb_softbody_bend b = d->bends[i];
    const plumb_softbody_node *n = d->nodes;
    b.length = b.length == 0 ? (way_between(&n[b.a], &n[b.b]) + way_between(&n[b.b], &n[b.c])) / 2
                             : b.length;
    return b;
}

static plumb_softbody_triangle triangle_of(const plumb_softbody_desc *d, int i)
{
    plumb_softbody_triangle t = d->triangles[i];
    if (t.ab.x == 0 && t.ab.y == 0 && t.ac.x == 0 && t.ac.y == 0) {
        t.ab = offset(&d->nodes[t.a], &d->nodes[t.b]);
        t.ac = offset(&d->nodes[t.a], &d->nodes[t.c]);
    }
    return t;
}

static plumb_result check_counts(const plumb_world *world, const char *fn,
                                 const plumb_softbody_desc *d)
{
    const struct {
        const char *name;
        const void *items;
        int count, least;
    } lists[] = { { "nodes", d->nodes, d->node_count, 1 },
                  { "edges", d->edges, d->edge_count, 0 },
                  { "bends", d->bends, d->bend_count, 0 },
                  { "triangles", d->triangles, d->triangle_count, 0 },
                  { "ring", d->ring, d->ring_count, 0 },
                  { "pins", d->pins, d->pin_count, 0 } };
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; ++i) {
        if (lists[i].count < lists[i].least || lists[i].count > PLUMB_SOFTBODY_MAX) {
            return pl_fail(world, PLUMB_E_RANGE, fn, "%s are %d; they must be %d to %d",
                           lists[i].name, lists[i].count, lists[i].least, PLUMB_SOFTBODY_MAX);
        }
        if (lists[i].count > 0) {
            PL_TRY(pl_check_pointer(world, fn, lists[i].name, lists[i].items));
        }
    }
    if (d->ring_count > 0 && d->ring_count < 3) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "ring is of %d nodes; it must have at least 3",
                       d->ring_count);
    }
    return PLUMB_OK;
}

static plumb_result fail_nodes(const plumb_world *world, const char *fn, const char *what, int i)
{
    return pl_fail(world, PLUMB_E_RANGE, fn,
                   "%s %d names nodes that are none or the same; they must be different ones", what,
                   i);
}

static plumb_result check_edge(const plumb_world *world, const char *fn,
                               const plumb_softbody_edge *e)
{
    number n[NUMBERS];
    if (e->flags > FLAGS_MOST) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "edge flags are %u; they must be at most %u",
                       (unsigned)e->flags, (unsigned)FLAGS_MOST);
    }
    return check_numbers(world, fn, n, list_edge(e, n));
}

static plumb_result check_elements(const plumb_world *world, const char *fn,
                                   const plumb_softbody_desc *d)
{
    const uint32_t nodes = (uint32_t)d->node_count;
    number n[NUMBERS];
    for (int i = 0; i < d->node_count; ++i) {
        PL_TRY(check_numbers(world, fn, n, list_node(&d->nodes[i], n)));
    }
    for (int i = 0; i < d->edge_count; ++i) {
        if (!is_edge_of(&d->edges[i], nodes)) {
            return fail_nodes(world, fn, "edge", i);
        }
        const plumb_softbody_edge e = edge_of(d, i);
        PL_TRY(check_edge(world, fn, &e));
    }
    for (int i = 0; i < d->bend_count; ++i) {
        const plumb_softbody_bend *b = &d->bends[i];
        if (!are_three_of(b->a, b->b, b->c, nodes)) {
            return fail_nodes(world, fn, "bend", i);
        }
        const plumb_softbody_bend resolved = bend_of(d, i);
        PL_TRY(check_numbers(world, fn, n, list_bend(&resolved, n)));
    }
    for (int i = 0; i < d->triangle_count; ++i) {
        const plumb_softbody_triangle *t = &d->triangles[i];
        if (!are_three_of(t->a, t->b, t->c, nodes)) {
            return fail_nodes(world, fn, "triangle", i);
        }
        const plumb_softbody_triangle resolved = triangle_of(d, i);
        PL_TRY(check_numbers(world, fn, n, list_triangle(&resolved, n)));
    }
    for (int i = 0; i < d->ring_count; ++i) {
        if (d->ring[i] >= nodes || !is_new(d->ring, sizeof *d->ring, (uint32_t)i, d->ring[i])) {
            return fail_nodes(world, fn, "place in the ring", i);
        }
    }
    return PLUMB_OK;
}

static plumb_result check_pin(const plumb_world *world, const char *fn,
                              const plumb_softbody_pin *pin)
{
    uint32_t row;
    PL_TRY(pl_check_within(world, fn, "pin point", pin->point, FAR));
    return plumb_is_null(pin->body) ? PLUMB_OK : pl_check_body(world, fn, pin->body, &row);
}

static plumb_result check_desc(const plumb_world *world, const char *fn,
                               const plumb_softbody_desc *d, pl_softbody *item)
{
    number n[NUMBERS];
    PL_TRY(PL_CHECK_HAS(world, fn, "a soft body", SOFTBODIES, "softbodies"));
    if (pl_is_wrapped(world)) {
        return pl_fail(world, PLUMB_E_STATE, fn,
                       "the world wraps around; one with soft bodies must not");
    }
    PL_TRY(check_counts(world, fn, d));
    PL_TRY(pl_filter_check(world, fn, &d->filter));
    PL_TRY(check_elements(world, fn, d));
    for (int i = 0; i < d->pin_count; ++i) {
        const plumb_softbody_pin *pin = &d->pins[i];
        if (pin->node >= (uint32_t)d->node_count ||
            !is_new(&d->pins->node, sizeof *d->pins, (uint32_t)i, pin->node)) {
            return fail_nodes(world, fn, "pin", i);
        }
        PL_TRY(check_pin(world, fn, pin));
    }
    memset(item, 0, sizeof *item); // padding, too: it is saved
    item->nodes = (uint32_t)d->node_count, item->edges = (uint32_t)d->edge_count;
    item->bends = (uint32_t)d->bend_count, item->triangles = (uint32_t)d->triangle_count;
    item->ring = (uint32_t)d->ring_count, item->pins = (uint32_t)d->pin_count;
    item->friction = d->friction, item->damping = d->damping;
    item->pressure = d->pressure, item->ambient = d->ambient;
    item->area = d->ring_count == 0 ? 0 : d->area != 0 ? d->area : area_of(d);
    item->filter.category = d->filter.category, item->filter.mask = d->filter.mask;
    item->filter.group = d->filter.group, item->filter.nothing = d->filter.nothing;
    return check_numbers(world, fn, n, list_item(item, n));
}

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
        const plumb_softbody_edge e = edge_of(d, i);
        plumb_softbody_edge *to = &pl_softbody_edges(s)[s->edge_count++];
        memset(to, 0, sizeof *to);
        PUT(to, e, a), PUT(to, e, b), PUT(to, e, flags), PUT(to, e, length);
        PUT(to, e, stiffness), PUT(to, e, damping), PUT(to, e, break_strain);
        PUT(to, e, yield_strain);
    }
    for (int i = 0; i < d->bend_count; ++i) {
        const plumb_softbody_bend b = bend_of(d, i);
        plumb_softbody_bend *to = &pl_softbody_bends(s)[s->bend_count++];
        memset(to, 0, sizeof *to);
        PUT(to, b, a), PUT(to, b, b), PUT(to, b, c);
        PUT(to, b, stiffness), PUT(to, b, length), PUT(to, b, angle);
    }
    for (int i = 0; i < d->triangle_count; ++i) {
        const plumb_softbody_triangle t = triangle_of(d, i);
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
        check_desc(world, __func__, desc, &item) != PLUMB_OK) {
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
    }
    put_elements(s, desc);
    for (int i = 0; i < desc->pin_count; ++i) {
        put_pin(world, row, &desc->pins[i]);
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

plumb_result plumb_softbody_get(const plumb_world *world, plumb_softbody softbody,
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
    number n[NUMBERS];
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "value", value));
    pl_softbodies *s = &world->softbodies;
    PL_TRY(check_index(world, __func__, "node", node, pl_softbody_items(s)[row].nodes));
    PL_TRY(check_numbers(world, __func__, n, list_node(value, n)));
    pl_softbody_nodes(s)[pl_softbody_place_of(s, row).node + (uint32_t)node] = *value;
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
    PL_TRY(check_edge(world, __func__, value));
    plumb_softbody_edge *to =
        &pl_softbody_edges(s)[pl_softbody_place_of(s, row).edge + (uint32_t)edge];
    PUT(to, *value, flags), PUT(to, *value, length), PUT(to, *value, stiffness);
    PUT(to, *value, damping), PUT(to, *value, break_strain), PUT(to, *value, yield_strain);
    return PLUMB_OK;
}

plumb_result plumb_softbody_set_gas(plumb_world *world, plumb_softbody softbody, real pressure,
                                    real ambient)
{
    uint32_t row;
    number n[NUMBERS];
    PL_TRY(check_softbody(world, __func__, softbody, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_softbody *item = &pl_softbody_items(&world->softbodies)[row];
    if (item->ring == 0) {
        return pl_fail(world, PLUMB_E_STATE, __func__,
                       "the soft body has no ring; it must have one for gas to be in");
    }
    pl_softbody changed = *item;
    changed.pressure = pressure, changed.ambient = ambient;
    PL_TRY(check_numbers(world, __func__, n, list_item(&changed, n)));
    item->pressure = pressure, item->ambient = ambient;
    return PLUMB_OK;
}

// Which pin of a soft body holds a node; PL_NONE: none does.
static uint32_t find_pin(const pl_softbodies *s, uint32_t row, int node)
{
    const plumb_softbody_pin *pins = pl_softbody_pins(s) + pl_softbody_place_of(s, row).pin;
    for (uint32_t i = 0; i < pl_softbody_items(s)[row].pins; ++i) {
        if (pins[i].node == (uint32_t)node) {
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
    PL_TRY(check_pin(world, __func__, &pin));
    if (!pl_buffer_reserve(&world->memory, &s->pins,
                           ((size_t)s->pin_count + 1) * sizeof(plumb_softbody_pin))) {
        return pl_fail_memory(world, __func__);
    }
    const uint32_t old = find_pin(s, row, node);
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
    pl_softbody_drop_pin(world, row, pin);
    return PLUMB_OK;
}

//---- measured ------------------------------------------------------------------------------------

static double exact(real value, real rest)
{
    return (double)value + (double)rest;
}

static void sum_nodes(const pl_softbodies *s, const pl_softbody *item, pl_softbody_place at,
                      plumb_energy *e)
{
    const plumb_softbody_pin *pins = pl_softbody_pins(s) + at.pin;
    uint32_t pin = 0;
    for (uint32_t i = 0; i < item->nodes; ++i) {
        if (pin < item->pins && pins[pin].node == i) {
            ++pin;
            continue;
        }
        const plumb_softbody_node *n = &pl_softbody_nodes(s)[at.node + i];
        const double m = (double)n->mass;
        const double x = exact(n->position.x, n->position_rest.x);
        const double y = exact(n->position.y, n->position_rest.y);
        const double u = exact(n->velocity.x, n->velocity_rest.x);
        const double v = exact(n->velocity.y, n->velocity_rest.y);
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
    pl_softbody_place at = { 0, 0, 0, 0, 0, 0 };
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
            (way_between(&nodes[edge->a], &nodes[edge->b]) - edge->length) / edge->length;
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
