// heat.c - heat of bodies set and asked.
//
// Reads: arguments, checked first. Writes: the body's record (world/heat_list.c). Cost: O(log n), to set O(n), n such records.
#include "api/listed.h"
#include "plumb/heat.h"

#include "world/check.h"
#include "world/heat_list.h"
#include "world/told.h"

// The body's record, to be changed and given back.
static plumb_result open(plumb_world *world, const char *fn, plumb_body body, pl_heat *heat)
{
    if (!pl_heat_reserve(world, 1)) {
        return pl_fail_memory(world, fn);
    }
    *heat = pl_heat_get(world, body);
    return PLUMB_OK;
}

#define NUMBER(name, initial)                                                                      \
    plumb_result plumb_body_set_##name(plumb_world *world, plumb_body body, plumb_real name)       \
    {                                                                                              \
        uint32_t row;                                                                              \
        pl_heat heat;                                                                              \
        PL_TRY(pl_check_body(world, __func__, body, &row));                                        \
        PL_TRY(pl_check_property(world, __func__, #name, PLUMB_TABLE_BODY, #name, name));          \
        PL_TRY(open(world, __func__, body, &heat));                                                \
        heat.name = (double)name;                                                                  \
        pl_told(world, body.entity, __func__);                                                     \
        pl_heat_set(world, &heat);                                                                 \
        return PLUMB_OK;                                                                           \
    }                                                                                              \
    plumb_real plumb_body_##name(const plumb_world *world, plumb_body body)                        \
    {                                                                                              \
        const bool lives = pl_ask_body(world, __func__, body) != PL_NONE;                          \
        return lives ? (plumb_real)pl_heat_get(world, body).name : 0;                              \
    }
PL_BODY_ROWS(PL_ROW_HEAT, NUMBER)

PL_LISTED(plumb_body_gone, plumb_world_body_gone_events, pl_heat_step_of(&world->heats)->gone.data,
          world->heats.gone_count)

plumb_result plumb_world_heat(const plumb_world *world, plumb_heat_sums *sums)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_pointer(world, __func__, "sums", sums));
    const pl_heats *heats = &world->heats;
    *sums =
        heats->state_count > 0 ? pl_heat_state_of(heats)->sums : (plumb_heat_sums){ .content = 0 };
    for (int k = 0; heats->state_count > 0 && k <= PLUMB_LIQUID_MAX_PHASES; ++k) {
        sums->owed += pl_heat_state_of(heats)->owed[k];
    }
    for (uint32_t i = 0; i < heats->count; ++i) {
        const pl_heat *heat = &pl_heat_items(heats)[i];
        const uint32_t row = pl_body_row(world, heat->body);
        if (world->bodies.type[row] == PLUMB_DYNAMIC) {
            sums->content += pl_heat_content(heat, (double)world->bodies.mass[row]);
            sums->burnt += heat->burnt;
        }
    }
    return PLUMB_OK;
}
