// destroy.c - destruction of entities of any kind: pieces, joints, lists and components that go with them.
//
// Reads, writes: rows and lists. Cost: that of the hooks; O(pieces + joints + contacts asleep) of a body.
#include "world/destroy.h"

#include "world/island.h"
#include "world/filter.h"
#include "world/joint_list.h"
#include "world/law_list.h"
#include "world/softbody_list.h"
#include "world/material_pair.h"
#include "world/rows.h"
#include "world/waves_list.h"

// The last one fills the gap.
pl_character *pl_character_of(const plumb_world *world, uint32_t row)
{
    uint32_t place = world->bodies.character[row];
    return place == 0 ? NULL : &pl_character_items(&world->characters)[place - 1];
}

void pl_character_forget(plumb_world *world, uint32_t row)
{
    pl_characters *all = &world->characters;
    pl_character *c = pl_character_of(world, row);
    if (c == NULL) {
        return;
    }
    pl_character *last = &pl_character_items(all)[all->count - 1];
    world->bodies.character[pl_body_row(world, last->body)] = world->bodies.character[row];
    *c = *last;
    world->bodies.character[row] = 0;
    --all->count;
    world->schedule_dirty = true;
}

static void destroy_shape(plumb_world *world, plumb_shape shape)
{
    uint32_t first = pl_shape_piece(world, shape);
    uint32_t row = world->pieces.body[first];
    pl_sleep_disturb_shape(world, first);
    pl_waves_forget(world, shape);
    pl_pieces_remove(world, first);
    pl_registry_release(&world->registry, shape.entity);
    pl_mass_revise(world, row);
}

static void destroy_body(plumb_world *world, plumb_body body)
{
    uint32_t row = pl_body_row(world, body);
    pl_exclusions_forget(world, row);
    pl_character_forget(world, row);
    pl_sleep_forget(world, row);
    while (world->bodies.first_piece[row] != PL_NONE) {
        plumb_shape shape = world->pieces.shape[world->bodies.first_piece[row]];
        pl_waves_forget(world, shape);
        pl_pieces_remove(world, world->bodies.first_piece[row]);
        pl_registry_release(&world->registry, shape.entity);
    }
    while (world->bodies.first_joint[row] != PL_NONE) {
        pl_joint_remove(world, world->bodies.first_joint[row]);
    }
    if (world->laws.count > 0) {
        pl_laws_miss(world, row);
        pl_laws_forget(world, body);
    }
    pl_softbodies_forget(world, body);
    pl_row_close(world, row);
    pl_registry_release(&world->registry, body.entity);
}

// The last row fills the gap; the pieces that name it are told. Row 0 is the default and stays.
static void destroy_material(plumb_world *world, plumb_material material)
{
    pl_materials *materials = &world->materials;
    uint32_t row = pl_material_row(world, material);
    pl_material_pairs_forget(world, row);
    uint32_t last = --materials->table.count;
    if (row != last) {
        pl_table_copy(&materials->table, pl_material_columns, pl_material_column_count, last, row);
        world->registry.slots[materials->entity[row].entity.index].row = row;
        for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
            if (world->pieces.kind[p] != PL_PIECE_FREE && world->pieces.material[p] == last) {
                world->pieces.material[p] = row;
            }
        }
    }
    pl_registry_release(&world->registry, material.entity);
}

// Removal hooks run while everything is still there: shapes of a body first, oldest last, then joints.
static void drop_components(plumb_world *world, plumb_entity entity)
{
    uint32_t row = pl_body_row(world, (plumb_body){ entity });
    if (row != PL_NONE) {
        plumb_shape last = PLUMB_NULL_INIT;
        uint32_t p = world->bodies.first_piece[row];
        for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
            if (!plumb_same(world->pieces.shape[p], last)) {
                last = world->pieces.shape[p];
                pl_components_drop_all(world, last.entity);
            }
        }
    }
    uint32_t joint = row == PL_NONE ? PL_NONE : world->bodies.first_joint[row];
    while (joint != PL_NONE) {
        const pl_joint *j = &pl_joint_items(&world->joints)[joint];
        pl_components_drop_all(world, j->entity.entity);
        joint = pl_joint_next(j, (plumb_body){ entity });
    }
    pl_components_drop_all(world, entity);
}

void pl_destroy_entity(plumb_world *world, plumb_entity entity)
{
    drop_components(world, entity);
    world->schedule_dirty = true;
    switch (world->registry.slots[entity.index].kind) {
    case PLUMB_KIND_BODY:
        destroy_body(world, (plumb_body){ entity });
        break;
    case PLUMB_KIND_SHAPE:
        destroy_shape(world, (plumb_shape){ entity });
        break;
    case PLUMB_KIND_JOINT:
        pl_joint_remove(world, pl_joint_slot(world, (plumb_joint){ entity }));
        break;
    case PLUMB_KIND_LAW:
        pl_law_remove(world, pl_law_find(world, (plumb_law){ entity }));
        break;
    case PLUMB_KIND_SOFTBODY:
        pl_softbody_remove(world, pl_softbody_find(world, (plumb_softbody){ entity }));
        break;
    case PLUMB_KIND_MATERIAL:
        destroy_material(world, (plumb_material){ entity });
        break;
    default:
        pl_registry_release(&world->registry, entity);
        break;
    }
}
