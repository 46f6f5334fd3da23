// heat_list.c - records of heat: dense, one for each body that asks, sorted by the index of its handle.
//
// No body has a column for it: worlds without heat have no byte of it. Reads, writes: the list. Cost: O(log n) to find, O(n) to
// come and go.
#include "world/heat_list.h"

#include <string.h>

// Where the record of a handle's index is, or would be put.
static uint32_t place_of(const pl_heats *heats, uint32_t index)
{
    const pl_heat *items = pl_heat_items(heats);
    uint32_t low = 0, high = heats->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (items[middle].body.entity.index < index) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

pl_heat *pl_heat_find(const plumb_world *world, plumb_body body)
{
    const pl_heats *heats = &world->heats;
    const uint32_t at = place_of(heats, body.entity.index);
    pl_heat *items = pl_heat_items(heats);
    return at < heats->count && plumb_same(items[at].body, body) ? &items[at] : NULL;
}

// As a real would have it: descriptors say so.
#define DEFAULT(name, initial) .name = (double)(real)(initial),

pl_heat pl_heat_get(const plumb_world *world, plumb_body body)
{
    const pl_heat *found = pl_heat_find(world, body);
    return found != NULL ? *found : (pl_heat){ .body = body, PL_BODY_ROWS(PL_ROW_HEAT, DEFAULT) };
}

// Systems add records amid a step, which has room for them.
bool pl_heat_reserve(plumb_world *world, uint32_t extra)
{
    pl_heats *heats = &world->heats;
    const size_t count = (size_t)heats->count + extra;
    const bool is_new = heats->step.data == NULL;
    if (!pl_buffer_reserve(&world->memory, &heats->step, sizeof(pl_heat_step))) {
        return false;
    }
    if (is_new) {
        memset(heats->step.data, 0, sizeof(pl_heat_step));
    }
    return pl_buffer_reserve(&world->memory, &heats->items, count * sizeof(pl_heat)) &&
           pl_buffer_reserve(&world->memory, &heats->state, sizeof(pl_heat_state)) &&
           pl_buffer_reserve(&world->memory, &pl_heat_step_of(heats)->bodies,
                             count * sizeof(pl_heat_body));
}

void pl_heats_free(pl_memory *memory, pl_heats *heats)
{
    pl_heat_step *step = pl_heat_step_of(heats);
    if (step != NULL) {
        pl_buffer_free(memory, &step->bodies);
        pl_buffer_free(memory, &step->links);
        pl_buffer_free(memory, &step->keys);
        pl_buffer_free(memory, &step->gone);
    }
    pl_buffer_free(memory, &heats->items);
    pl_buffer_free(memory, &heats->state);
    pl_buffer_free(memory, &heats->step);
}

bool pl_heat_is_any(const pl_heat *values)
{
#define IS_SET(name, initial) || values->name != (double)(real)(initial)
    return false PL_BODY_ROWS(PL_ROW_HEAT, IS_SET);
#undef IS_SET
}

pl_heat pl_heat_of_desc(const plumb_body_desc *desc)
{
#define MEANT(name, initial) .name = desc->name != 0 ? (double)desc->name : (double)(real)(initial),
    return (pl_heat){ PL_BODY_ROWS(PL_ROW_HEAT, MEANT) };
#undef MEANT
}

void pl_heat_forget(plumb_world *world, plumb_body body)
{
    pl_heats *heats = &world->heats;
    pl_heat *found = heats->count > 0 ? pl_heat_find(world, body) : NULL;
    if (found != NULL) {
        const size_t behind = (size_t)(pl_heat_items(heats) + heats->count - (found + 1));
        memmove(found, found + 1, behind * sizeof *found);
        --heats->count;
        world->schedule_dirty = true;
    }
}

void pl_heat_set(plumb_world *world, const pl_heat *values)
{
    pl_heats *heats = &world->heats;
    pl_heat *found = pl_heat_find(world, values->body);
    if (!pl_heat_is_any(values)) {
        pl_heat_forget(world, values->body);
        return;
    }
    if (heats->state_count == 0) {
        memset(heats->state.data, 0, sizeof(pl_heat_state));
        heats->state_count = 1;
    }
    if (found == NULL) {
        const uint32_t at = place_of(heats, values->body.entity.index);
        found = pl_heat_items(heats) + at;
        memmove(found + 1, found, (heats->count - at) * sizeof *found);
        ++heats->count;
        world->schedule_dirty = true;
    }
    *found = *values;
}

double pl_heat_content(const pl_heat *heat, double mass)
{
    return heat->temperature > 0 ? (mass - heat->burnt) * heat->heat_capacity * heat->temperature +
                                       heat->molten * heat->latent_heat
                                 : 0;
}

void pl_heat_merge(plumb_world *world, plumb_body body, double own, plumb_body other, double mass)
{
    pl_heat *to = pl_heat_find(world, body);
    const pl_heat *from = pl_heat_find(world, other);
    if (to == NULL || from == NULL) {
        return;
    }
    const double content = pl_heat_content(to, own) + pl_heat_content(from, mass);
    const bool are_warm = own > 0 && to->temperature > 0 && from->temperature > 0;
    to->molten += from->molten;
    to->burnt += from->burnt;
    if (are_warm) {
        const double rest = content - to->molten * to->latent_heat;
        const double warm = (own + mass - to->burnt) * to->heat_capacity;
        to->temperature = rest > 0 && warm > 0 ? rest / warm : to->temperature;
    }
}

void pl_heat_share(plumb_world *world, plumb_body part, const pl_heat *whole, double share)
{
    pl_heat *to = pl_heat_find(world, part);
    if (to != NULL) {
        to->temperature = whole->temperature;
        to->molten = whole->molten * share;
        to->burnt = whole->burnt * share;
        to->grown = whole->grown;
    }
}
