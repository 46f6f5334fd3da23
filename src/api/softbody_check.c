// softbody_check.c - what soft bodies are made of: numbers in their ranges, nodes that there are; what is left out, resolved.
//
// Reads: descriptors, and soft bodies of an image. Writes: nothing. Cost: O(nodes and elements); pins and ring O(n^2).
#include "api/softbody.h"

#include "softbody/softbody.h"
#include "world/check.h"
#include "world/filter.h"
#include "world/softbody_list.h"
#include "world/wrap.h"

#include <math.h>
#include <string.h>

#define FAR ((real)1e9)
#define CARRIED                                                                                    \
    (2 * PL_LARGEST) // [m] as far as bodies get, which carry nodes along; see check_rows.c
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

// `far`: [m] how far off it may be.
static int list_node(const plumb_softbody_node *n, real far, number out[NUMBERS])
{
    const real rest = (real)1e-6 * far;
    const number all[] = { { "node position.x", n->position.x, -far, far },
                           { "node position.y", n->position.y, -far, far },
                           { "node velocity.x", n->velocity.x, -SPEED, SPEED },
                           { "node velocity.y", n->velocity.y, -SPEED, SPEED },
                           { "node mass", n->mass, (real)1e-9, FAR },
                           { "node radius", n->radius, 0, LENGTH },
                           { "node position_rest.x", n->position_rest.x, -rest, rest },
                           { "node position_rest.y", n->position_rest.y, -rest, rest },
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

static bool is_place(plumb_vec2 p)
{
    return p.x - p.x == 0 && p.y - p.y == 0;
}

static bool is_rest_sound(const pl_soft_rest *r)
{
    return r->x - r->x == 0 && r->y - r->y == 0 && r->dx - r->dx == 0 && r->dy - r->dy == 0;
}

static bool is_item_sound(const pl_softbodies *s, const pl_softbody *item, pl_softbody_place at)
{
    number n[NUMBERS];
    bool sound = item->nodes > 0 && are_sound(n, list_item(item, n)) &&
                 *(const uint8_t *)&item->filter.nothing <= 1 &&
                 *(const uint8_t *)&item->asleep <= 1 &&
                 *(const uint8_t *)&item->due <= *(const uint8_t *)&item->asleep &&
                 *(const uint8_t *)&item->no_sleep <= 1 && item->rest_samples <= 2 &&
                 item->rest_time - item->rest_time == 0 && is_place(item->low) &&
                 is_place(item->high) && (item->ring == 0 || item->ring >= 3);
    for (uint32_t i = 0; i < item->nodes && sound; ++i) {
        sound = are_sound(n, list_node(&pl_softbody_nodes(s)[at.node + i], CARRIED, n)) &&
                is_rest_sound(&pl_softbody_rests(s)[at.node + i]);
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
    for (uint32_t i = 0; i < item->pins && sound; ++i) {
        const plumb_softbody_pin *pins = pl_softbody_pins(s) + at.pin;
        const plumb_vec2 p = pins[i].point;
        sound = pins[i].node < item->nodes && p.x >= -FAR && p.x <= FAR && p.y >= -FAR &&
                p.y <= FAR && (i == 0 || pins[i].node > pins[i - 1].node);
    }
    return sound;
}

bool pl_softbodies_are_sound(const pl_softbodies *s)
{
    uint64_t sum[6] = { 0 };
    uint32_t asleep = 0;
    for (uint32_t i = 0; i < s->count; ++i) {
        const pl_softbody *item = &pl_softbody_items(s)[i];
        sum[0] += item->nodes, sum[1] += item->edges, sum[2] += item->bends;
        sum[3] += item->triangles, sum[4] += item->ring, sum[5] += item->pins;
        asleep += *(const uint8_t *)&item->asleep == 1;
    }
    bool sound = s->rest_count == s->node_count && asleep == s->asleep_count &&
                 sum[0] == s->node_count && sum[1] == s->edge_count && sum[2] == s->bend_count &&
                 sum[3] == s->triangle_count && sum[4] == s->ring_count && sum[5] == s->pin_count;
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < s->count && sound; ++i) {
        const pl_softbody *item = &pl_softbody_items(s)[i];
        sound = is_item_sound(s, item, at);
        if (sound) { // its flags are 0 or 1
            at = pl_softbody_behind(at, item);
        }
    }
    return sound;
}

//---- what is left out, resolved ----------------------------------------------------------------------

real pl_softbody_way(const plumb_softbody_node *a, const plumb_softbody_node *b)
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
plumb_softbody_edge pl_softbody_edge_of(const plumb_softbody_desc *d, int i)
{
    plumb_softbody_edge e = d->edges[i];
    e.length = e.length == 0 ? pl_softbody_way(&d->nodes[e.a], &d->nodes[e.b]) : e.length;
    e.tension = 0;
    return e;
}

plumb_softbody_bend pl_softbody_bend_of(const plumb_softbody_desc *d, int i)
{
    plumb_softbody_bend b = d->bends[i];
    const plumb_softbody_node *n = d->nodes;
    b.length = b.length == 0
                   ? (pl_softbody_way(&n[b.a], &n[b.b]) + pl_softbody_way(&n[b.b], &n[b.c])) / 2
                   : b.length;
    return b;
}

plumb_softbody_triangle pl_softbody_triangle_of(const plumb_softbody_desc *d, int i)
{
    plumb_softbody_triangle t = d->triangles[i];
    if (t.ab.x == 0 && t.ab.y == 0 && t.ac.x == 0 && t.ac.y == 0) {
        t.ab = offset(&d->nodes[t.a], &d->nodes[t.b]);
        t.ac = offset(&d->nodes[t.a], &d->nodes[t.c]);
    }
    return t;
}

//---- of a call -----------------------------------------------------------------------------------

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

plumb_result pl_softbody_check_edge(const plumb_world *world, const char *fn,
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
        PL_TRY(check_numbers(world, fn, n, list_node(&d->nodes[i], FAR, n)));
    }
    for (int i = 0; i < d->edge_count; ++i) {
        if (!is_edge_of(&d->edges[i], nodes)) {
            return fail_nodes(world, fn, "edge", i);
        }
        const plumb_softbody_edge e = pl_softbody_edge_of(d, i);
        PL_TRY(pl_softbody_check_edge(world, fn, &e));
    }
    for (int i = 0; i < d->bend_count; ++i) {
        const plumb_softbody_bend *b = &d->bends[i];
        if (!are_three_of(b->a, b->b, b->c, nodes)) {
            return fail_nodes(world, fn, "bend", i);
        }
        const plumb_softbody_bend resolved = pl_softbody_bend_of(d, i);
        PL_TRY(check_numbers(world, fn, n, list_bend(&resolved, n)));
    }
    for (int i = 0; i < d->triangle_count; ++i) {
        const plumb_softbody_triangle *t = &d->triangles[i];
        if (!are_three_of(t->a, t->b, t->c, nodes)) {
            return fail_nodes(world, fn, "triangle", i);
        }
        const plumb_softbody_triangle resolved = pl_softbody_triangle_of(d, i);
        PL_TRY(check_numbers(world, fn, n, list_triangle(&resolved, n)));
    }
    for (int i = 0; i < d->ring_count; ++i) {
        if (d->ring[i] >= nodes || !is_new(d->ring, sizeof *d->ring, (uint32_t)i, d->ring[i])) {
            return fail_nodes(world, fn, "place in the ring", i);
        }
    }
    return PLUMB_OK;
}

plumb_result pl_softbody_check_pin(const plumb_world *world, const char *fn,
                                   const plumb_softbody_pin *pin)
{
    uint32_t row;
    PL_TRY(pl_check_within(world, fn, "pin point", pin->point, FAR));
    return plumb_is_null(pin->body) ? PLUMB_OK : pl_check_body(world, fn, pin->body, &row);
}

plumb_result pl_softbody_check_desc(const plumb_world *world, const char *fn,
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
        PL_TRY(pl_softbody_check_pin(world, fn, pin));
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
    item->no_sleep = d->no_sleep, item->rest_time = PL_NOT_RESTING;
    return check_numbers(world, fn, n, list_item(item, n));
}

plumb_result pl_softbody_check_node(const plumb_world *world, const char *fn,
                                    const plumb_softbody_node *node)
{
    number n[NUMBERS];
    return check_numbers(world, fn, n, list_node(node, FAR, n));
}

plumb_result pl_softbody_check_gas(const plumb_world *world, const char *fn,
                                   const pl_softbody *item)
{
    number n[NUMBERS];
    return check_numbers(world, fn, n, list_item(item, n));
}
