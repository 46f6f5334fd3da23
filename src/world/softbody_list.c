// softbody_list.c - the list of soft bodies: dense, in the order in which they were made.
//
// Reads, writes: the list, the registry. Cost: O(nodes and elements of those behind).
#include "world/softbody_list.h"

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
    const pl_softbody gone = items[row];
    const pl_softbody_place at = pl_softbody_place_of(s, row);
    close_gap(&s->nodes, &s->node_count, at.node, gone.nodes, sizeof(plumb_softbody_node));
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
                pl_softbody_drop_pin(world, row, i);
            }
        }
    }
}
