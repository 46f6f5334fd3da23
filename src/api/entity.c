// entity.c - entities of any kind: made bare, destroyed, asked.
//
// Reads, writes: the registry; destruction goes through rows.c. Cost: O(1), destruction as its
// kind.
#include "world/destroy.h"
#include "world/check.h"
#include "world/rows.h"

plumb_entity plumb_entity_create(plumb_world *world)
{
    plumb_entity none = PLUMB_NULL_ENTITY_INIT;
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK) {
        return none;
    }
    if (!pl_registry_reserve(&world->memory, &world->registry, 1)) {
        pl_fail_memory(world, __func__);
        return none;
    }
    return pl_entity_claim(world, none, PLUMB_KIND_BARE, PL_NONE);
}

plumb_result plumb_entity_destroy(plumb_world *world, plumb_entity entity)
{
    PL_TRY(pl_check_entity(world, __func__, entity));
    PL_TRY(pl_check_unlocked(world, __func__));
    uint32_t material = pl_material_row(world, (plumb_material){ entity });
    PL_TRY(material != PL_NONE ? pl_check_unused(world, __func__, material) : PLUMB_OK);
    pl_destroy_entity(world, entity);
    return PLUMB_OK;
}

bool plumb_entity_alive(const plumb_world *world, plumb_entity entity)
{
    return world != NULL && pl_registry_find(&world->registry, entity) != NULL;
}

plumb_entity_kind plumb_entity_get_kind(const plumb_world *world, plumb_entity entity)
{
    const pl_slot *slot = world == NULL ? NULL : pl_registry_find(&world->registry, entity);
    return slot == NULL ? PLUMB_KIND_NONE : (plumb_entity_kind)slot->kind;
}

const char *plumb_entity_kind_name(plumb_entity_kind kind)
{
    return pl_kind_name((uint32_t)kind);
}
