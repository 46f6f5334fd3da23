// touch.c - which bodies the liquid touches, what it does to them, and which it has left: told when the step is over.
//
// Reads: bodies and nodes of the grid, supports of the step before. Writes: contacts and ends. Cost: O(n log n) bodies near the liquid.
#include "core/sort.h"
#include "liquid/liquid.h"
#include "world/state.h"

bool pl_liquid_reserve_touches(pl_memory *memory, pl_liquid *liquid)
{
    pl_liquid_scratch *scratch = liquid->scratch;
    const size_t count = (size_t)scratch->grid.body_count + scratch->grid.softbody_count;
    return pl_buffer_reserve(memory, &scratch->touches, count * sizeof(plumb_liquid_contact)) &&
           pl_buffer_reserve(memory, &liquid->contacts, count * sizeof(plumb_liquid_contact)) &&
           pl_buffer_reserve(memory, &liquid->ends,
                             liquid->supports.count * sizeof(plumb_liquid_end));
}

bool pl_liquid_softbody_is_wet(const pl_liquid_grid *g, const pl_liquid_softbody *body)
{
    bool wet = false;
    for (uint32_t i = body->first; i < body->first + body->count; ++i) {
        wet |= g->nodes[i].wet;
    }
    return wet;
}

static plumb_liquid_contact contact_of(const pl_liquid_body *body, double dt)
{
    return (plumb_liquid_contact){
        .body = body->body,
        .force = { pl_held(body->impulse_x / dt), pl_held(body->impulse_y / dt) },
        .torque = pl_held(body->turn / dt),
    };
}

static plumb_liquid_contact soft_contact_of(const pl_liquid_grid *g, const pl_liquid_softbody *body,
                                            double dt)
{
    double sum[3] = { 0, 0, 0 };
    for (uint32_t i = body->first; i < body->first + body->count; ++i) {
        const pl_liquid_node *n = &g->nodes[i];
        sum[0] += n->impulse[0], sum[1] += n->impulse[1];
        sum[2] += (n->x - body->x) * n->impulse[1] - (n->y - body->y) * n->impulse[0];
    }
    return (plumb_liquid_contact){
        .softbody = body->entity,
        .force = { pl_held(sum[0] / dt), pl_held(sum[1] / dt) },
        .torque = pl_held(sum[2] / dt),
    };
}

static void tell_contacts(pl_liquid *liquid, const pl_keyed *order, uint32_t count)
{
    const plumb_liquid_contact *touches = liquid->scratch->touches.data;
    const pl_liquid_support *notes = liquid->scratch->supports.data;
    plumb_liquid_contact *to = liquid->contacts.data;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t k = order[i].value;
        if (notes[k].wet != PL_LIQUID_DRY) {
            const pl_liquid_support *before = pl_liquid_support_of(&liquid->supports, notes[k].key);
            to[liquid->contact_count] = touches[k];
            to[liquid->contact_count++].began = before == NULL || before->wet == PL_LIQUID_DRY;
        }
    }
}

static void tell_ends(pl_liquid *liquid, const pl_keyed *order, uint32_t count)
{
    const pl_liquid_support *notes = liquid->scratch->supports.data;
    const pl_liquid_support *before = liquid->supports.items.data;
    plumb_liquid_end *to = liquid->ends.data;
    for (uint32_t i = 0; i < liquid->supports.count; ++i) {
        bool found = false;
        const uint32_t at = pl_find_key(order, count, sizeof *order, before[i].key, &found);
        const plumb_entity entity = { (uint32_t)(before[i].key >> 32), (uint32_t)before[i].key };
        if (before[i].wet == PL_LIQUID_DRY ||
            (found && notes[order[at].value].wet != PL_LIQUID_DRY)) {
            continue;
        }
        to[liquid->end_count++] = before[i].wet == PL_LIQUID_WET_BODY
                                      ? (plumb_liquid_end){ .body = { entity } }
                                      : (plumb_liquid_end){ .softbody = { entity } };
    }
}

void pl_liquid_tell_touches(plumb_world *world, double dt)
{
    pl_liquid *liquid = &world->liquid;
    const pl_liquid_grid *g = &liquid->scratch->grid;
    plumb_liquid_contact *touches = liquid->scratch->touches.data;
    uint32_t count = 0;
    for (uint32_t i = 0; i < g->body_count; ++i) {
        if (g->bodies[i].moves) {
            touches[count++] = contact_of(&g->bodies[i], dt);
        }
    }
    for (uint32_t i = 0; i < g->softbody_count; ++i) {
        touches[count++] = soft_contact_of(g, &g->softbodies[i], dt);
    }
    tell_contacts(liquid, liquid->scratch->order.data, count);
    tell_ends(liquid, liquid->scratch->order.data, count);
}
