// softbody_list.c - the list of soft bodies: dense, in the order in which they were made.
//
// Reads, writes: the list, the registry. Cost: O(nodes and elements of those behind).
#include "world/softbody_list.h"

#include "world/filter.h"
#include "world/island.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

uint32_t pl_softbody_find(const plumb_world *world, plumb_softbody softbody)
{
    if (world == NULL) {
        return PL_NONE;
    }
    const pl_slot *slot = pl_registry_find(&world->registry, softbody.entity);
    return slot != NULL && slot->kind == PLUMB_KIND_SOFTBODY ? slot->row : PL_NONE;
}

// Takes `gone` elements of `size` bytes at `first` out of `*count`.
static void close_gap(const pl_buffer *buffer, uint32_t *count, uint32_t first, uint32_t gone,
                      size_t size)
{
    if (gone > 0) {
        char *at = (char *)buffer->data + first * size;
        memmove(at, at + gone * size, (*count - first - gone) * size);
        *count -= gone;
    }
}

void pl_softbody_remove(plumb_world *world, uint32_t row)
{
    pl_softbodies *s = &world->softbodies;
    pl_softbody *items = pl_softbody_items(s);
    pl_softbody_disturb(world, row);
    const pl_softbody gone = items[row];
    const pl_softbody_place at = pl_softbody_place_of(s, row);
    s->asleep_count -= gone.asleep;
    close_gap(&s->nodes, &s->node_count, at.node, gone.nodes, sizeof(plumb_softbody_node));
    close_gap(&s->rests, &s->rest_count, at.node, gone.nodes, sizeof(pl_soft_rest));
    close_gap(&s->edges, &s->edge_count, at.edge, gone.edges, sizeof(plumb_softbody_edge));
    close_gap(&s->bends, &s->bend_count, at.bend, gone.bends, sizeof(plumb_softbody_bend));
    close_gap(&s->triangles, &s->triangle_count, at.triangle, gone.triangles,
              sizeof(plumb_softbody_triangle));
    close_gap(&s->rings, &s->ring_count, at.ring, gone.ring, sizeof(uint32_t));
    close_gap(&s->pins, &s->pin_count, at.pin, gone.pins, sizeof(plumb_softbody_pin));
    pl_registry_release(&world->registry, gone.entity.entity);
    close_gap(&s->items, &s->count, row, 1, sizeof(pl_softbody));
    for (uint32_t i = row; i < s->count; ++i) {
        pl_registry_move(&world->registry, items[i].entity.entity.index, i);
    }
    world->schedule_dirty = true;
}

static bool is_edge(const plumb_softbody_edge *edge, uint32_t a, uint32_t b)
{
    return (edge->a == a && edge->b == b) || (edge->a == b && edge->b == a);
}

void pl_softbody_tear(const pl_softbodies *all, pl_softbody *item, pl_softbody_place at,
                      const plumb_softbody_edge *torn)
{
    for (uint32_t k = 0; k < item->bends; ++k) {
        plumb_softbody_bend *b = &pl_softbody_bends(all)[at.bend + k];
        const bool over = is_edge(torn, b->a, b->b) || is_edge(torn, b->b, b->c);
        b->stiffness = over ? 0 : b->stiffness;
    }
    const uint32_t *ring = pl_softbody_rings(all) + at.ring;
    for (uint32_t k = 0; k < item->ring; ++k) {
        if (is_edge(torn, ring[k], ring[(k + 1) % item->ring])) {
            item->pressure = item->ambient = 0;
        }
    }
}

void pl_softbody_drop_pin(plumb_world *world, uint32_t row, uint32_t pin)
{
    pl_softbodies *s = &world->softbodies;
    const uint32_t first = pl_softbody_place_of(s, row).pin;
    close_gap(&s->pins, &s->pin_count, first + pin, 1, sizeof(plumb_softbody_pin));
    --pl_softbody_items(s)[row].pins;
}

void pl_softbodies_forget(plumb_world *world, plumb_body body)
{
    pl_softbodies *s = &world->softbodies;
    uint32_t end = s->pin_count;
    for (uint32_t row = s->count; row-- > 0;) {
        const uint32_t count = pl_softbody_items(s)[row].pins;
        end -= count;
        for (uint32_t i = count; i-- > 0;) {
            if (plumb_same(pl_softbody_pins(s)[end + i].body, body)) {
                pl_softbody_stir(world, row);
                pl_softbody_drop_pin(world, row, i);
            }
        }
    }
}

//---- sleep ---------------------------------------------------------------------------------------

// Outwards, by more than rounding takes.
static real below(double v)
{
    return (real)(v - 1e-6 * fabs(v));
}

static real above(double v)
{
    return (real)(v + 1e-6 * fabs(v));
}

void pl_softbody_see_box(plumb_world *world, uint32_t row, pl_softbody_place at)
{
    pl_softbody *item = &pl_softbody_items(&world->softbodies)[row];
    double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY;
    for (uint32_t i = at.node; i < at.node + item->nodes; ++i) {
        const plumb_softbody_node *n = &pl_softbody_nodes(&world->softbodies)[i];
        const double x = (double)n->position.x, y = (double)n->position.y;
        const double by = (double)n->radius + (double)PL_SPECULATIVE;
        low_x = x - by < low_x ? x - by : low_x, high_x = x + by > high_x ? x + by : high_x;
        low_y = y - by < low_y ? y - by : low_y, high_y = y + by > high_y ? y + by : high_y;
    }
    item->low = (plumb_vec2){ below(low_x), below(low_y) };
    item->high = (plumb_vec2){ above(high_x), above(high_y) };
}

void pl_softbody_lay(plumb_world *world, uint32_t row, pl_softbody_place at)
{
    pl_softbodies *s = &world->softbodies;
    pl_softbody *item = &pl_softbody_items(s)[row];
    for (uint32_t i = at.node; i < at.node + item->nodes; ++i) {
        plumb_softbody_node *n = &pl_softbody_nodes(s)[i];
        n->velocity = n->velocity_rest = (plumb_vec2){ 0, 0 };
    }
    for (uint32_t i = at.edge; i < at.edge + item->edges; ++i) {
        pl_softbody_edges(s)[i].flags &= ~PLUMB_EDGE_TORN_NOW; // that was before
    }
    pl_softbody_see_box(world, row, at);
    s->asleep_count += !item->asleep;
    item->asleep = true;
    item->due = false;
    world->schedule_dirty = true;
}

void pl_softbody_stir(plumb_world *world, uint32_t row)
{
    pl_softbody *item = &pl_softbody_items(&world->softbodies)[row];
    item->rest_time = PL_NOT_RESTING;
    item->due = item->asleep;
}

void pl_softbody_rise(plumb_world *world, uint32_t row)
{
    pl_softbody *item = &pl_softbody_items(&world->softbodies)[row];
    item->rest_time = PL_NOT_RESTING;
    if (item->asleep) {
        item->asleep = item->due = false;
        --world->softbodies.asleep_count;
        world->schedule_dirty = true;
    }
}

// By boxes, where the piece was filed and where it is now.
static bool may_touch(const plumb_world *world, const pl_softbody *item, uint32_t piece)
{
    const pl_box tight = pl_piece_tight_box(world, piece);
    return pl_softbody_overlaps(item, &world->pieces.fat[piece], 0) ||
           pl_softbody_overlaps(item, &tight, 0);
}

static void disturb_held(plumb_world *world, uint32_t row)
{
    const pl_softbodies *s = &world->softbodies;
    const uint32_t first = pl_softbody_place_of(s, row).pin;
    for (uint32_t i = first; i < first + pl_softbody_items(s)[row].pins; ++i) {
        const uint32_t holder = pl_body_row(world, pl_softbody_pins(s)[i].body);
        if (holder != PL_NONE && pl_row_is_asleep(world, holder)) {
            pl_sleep_disturb(world, holder);
        }
    }
}

void pl_softbody_disturb(plumb_world *world, uint32_t row)
{
    const pl_softbody *item = &pl_softbody_items(&world->softbodies)[row];
    const bool slept = item->asleep && !item->due;
    pl_softbody_stir(world, row);
    if (!slept) {
        return;
    }
    disturb_held(world, row);
    for (uint32_t i = 0; i < world->sleep.resting_count; ++i) {
        const uint32_t piece = pl_resting(&world->sleep)[i];
        if (may_touch(world, item, piece)) {
            pl_sleep_disturb(world, world->pieces.body[piece]);
        }
    }
}

void pl_softbodies_stir_near(plumb_world *world, uint32_t piece)
{
    const pl_softbodies *s = &world->softbodies;
    const bool sensor = (world->pieces.flags[piece] & PL_PIECE_SENSOR) != 0;
    const bool fluid = sensor && world->materials.fluid[world->pieces.material[piece]];
    for (uint32_t i = 0; i < s->count; ++i) {
        const pl_softbody *item = &pl_softbody_items(s)[i];
        if ((!sensor || (fluid && item->damping > 0)) && may_touch(world, item, piece)) {
            pl_softbody_stir(world, i);
        }
    }
}

void pl_softbodies_stir_by(plumb_world *world, uint32_t row)
{
    const pl_softbodies *s = &world->softbodies;
    const plumb_body body = world->bodies.entity[row];
    uint32_t pin = 0;
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t end = pin + pl_softbody_items(s)[i].pins;
        for (; pin < end; ++pin) {
            if (plumb_same(pl_softbody_pins(s)[pin].body, body)) {
                pl_softbody_stir(world, i);
            }
        }
    }
    for (uint32_t p = world->bodies.first_piece[row]; p != PL_NONE && s->count > 0;
         p = world->pieces.next_in_body[p]) {
        pl_softbodies_stir_near(world, p);
    }
}

void pl_softbodies_stir_all(plumb_world *world)
{
    for (uint32_t i = 0; i < world->softbodies.count; ++i) {
        pl_softbody_stir(world, i);
    }
}
