// material.c - materials: rows of a table, row 0 the default one, which has no handle.
//
// Reads: descriptors. Writes: material rows, and the copies of friction and restitution in pieces.
// Cost: O(1); plumb_material_set and _destroy O(pieces of the world).
#include "world/destroy.h"
#include "world/island.h"
#include "world/check.h"
#include "world/rows.h"

static plumb_result check_desc(const plumb_world *world, const char *fn,
                               const plumb_material_desc *desc)
{
    PL_TRY(pl_check_pointer(world, fn, "desc", desc));
    PL_TRY(pl_check_desc(world, fn, "", PLUMB_TABLE_MATERIAL, desc));
    if (desc->frictionless && desc->friction != 0) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "friction is %g; it must be 0 together with frictionless",
                       (double)desc->friction);
    }
    const struct {
        bool none;
        plumb_real value;
        const char *name, *zero;
    } twice[] = { { desc->no_drag, desc->drag, "drag", "no_drag" },
                  { desc->no_skin_drag, desc->skin_drag, "skin_drag", "no_skin_drag" },
                  { desc->no_added_mass, desc->added_mass, "added_mass", "no_added_mass" },
                  { desc->no_wave_drag, desc->wave_drag, "wave_drag", "no_wave_drag" } };
    for (size_t i = 0; i < sizeof twice / sizeof twice[0]; ++i) {
        if (twice[i].none && twice[i].value != 0) {
            return pl_fail(world, PLUMB_E_RANGE, fn, "%s is %g; it must be 0 together with %s",
                           twice[i].name, (double)twice[i].value, twice[i].zero);
        }
    }
    return PLUMB_OK;
}

void pl_material_fill(plumb_world *world, uint32_t row, const plumb_material_desc *desc)
{
    pl_materials *materials = &world->materials;
    PL_MATERIAL_ROWS(PL_ROW_FILL, materials)
}

plumb_material plumb_material_create(plumb_world *world, const plumb_material_desc *desc)
{
    plumb_material none = PLUMB_NULL_INIT;
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        check_desc(world, __func__, desc) != PLUMB_OK) {
        return none;
    }
    pl_materials *materials = &world->materials;
    if (!pl_registry_reserve(&world->memory, &world->registry, 1) ||
        !pl_table_reserve(&world->memory, &materials->table, pl_material_columns,
                          pl_material_column_count, materials->table.count + 1)) {
        pl_fail_memory(world, __func__);
        return none;
    }
    uint32_t row = materials->table.count++;
    pl_table_clear(&materials->table, pl_material_columns, pl_material_column_count, row);
    materials->entity[row].entity = pl_entity_claim(world, none.entity, PLUMB_KIND_MATERIAL, row);
    pl_material_fill(world, row, desc);
    return materials->entity[row];
}

plumb_result pl_check_unused(const plumb_world *world, const char *fn, uint32_t row)
{
    uint32_t users = world->materials.users[row];
    if (users == 0) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_STATE, fn, "material is used by %u piece%s; no shape may name it",
                   (unsigned)users, users == 1 ? "" : "s");
}

plumb_result plumb_material_destroy(plumb_world *world, plumb_material material)
{
    PL_TRY(pl_check_world(world));
    uint32_t row = pl_material_row(world, material);
    if (row == PL_NONE) {
        return pl_fail_handle(world, __func__, "material", material.entity, "a live material");
    }
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_unused(world, __func__, row));
    pl_destroy_entity(world, material.entity);
    return PLUMB_OK;
}

plumb_result plumb_material_settings(const plumb_world *world, plumb_material material,
                                     plumb_material_desc *desc)
{
    uint32_t row;
    PL_TRY(pl_check_material(world, __func__, material, &row));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    const pl_materials *m = &world->materials;
    *desc = (plumb_material_desc){ .density = 0 };
    PL_MATERIAL_ROWS(PL_ROW_GET, m)
    return PLUMB_OK;
}

// All that is made of it.
static void disturb_users(plumb_world *world, uint32_t row)
{
    const pl_pieces *pieces = &world->pieces;
    for (uint32_t p = 0; p < pieces->table.count; ++p) {
        if (pieces->kind[p] != PL_PIECE_FREE && pieces->material[p] == row) {
            pl_sleep_disturb_piece(world, p);
        }
    }
}

plumb_result plumb_material_set(plumb_world *world, plumb_material material,
                                const plumb_material_desc *desc)
{
    uint32_t row;
    PL_TRY(pl_check_material(world, __func__, material, &row));
    PL_TRY(check_desc(world, __func__, desc));
    plumb_material_desc old;
    PL_TRY(plumb_material_settings(world, material, &old));
    if (pl_descs_agree(PLUMB_TABLE_MATERIAL, &old, desc)) {
        return PLUMB_OK; // nothing wakes
    }
    disturb_users(world, row); // those that float in what is a fluid no more, too
    pl_material_fill(world, row, desc);
    disturb_users(world, row);
    pl_pieces *pieces = &world->pieces;
    for (uint32_t p = 0; p < pieces->table.count; ++p) {
        if (pieces->kind[p] != PL_PIECE_FREE && pieces->material[p] == row) {
            pieces->friction[p] = world->materials.friction[row];
            pieces->restitution[p] = world->materials.restitution[row];
        }
    }
    world->schedule_dirty = true;
    return PLUMB_OK;
}
