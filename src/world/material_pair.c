// material_pair.c - the table of what pairs of materials have between them: a sorted array.
//
// Keys are made of the registry slots of the materials, since rows move when one is destroyed; the
// default material, which has no slot, counts as 0 and the others from 1. Reads: materials. Writes:
// the table, and in each material how many entries name it. Cost: O(log entries) to look up where
// both materials are named, O(1) else; O(entries) to change.
#include "world/material_pair.h"

#include "core/sort.h"
#include "world/check.h"
#include "world/island.h"

#include <string.h>

static uint64_t key_of(const plumb_world *world, uint32_t row_a, uint32_t row_b)
{
    const plumb_material *entity = world->materials.entity;
    uint32_t a = row_a == 0 ? 0 : entity[row_a].entity.index + 1;
    uint32_t b = row_b == 0 ? 0 : entity[row_b].entity.index + 1;
    return pl_pair_key(a, b);
}

static pl_material_pair *find(const plumb_world *world, uint64_t key, uint32_t *at)
{
    bool found;
    *at = pl_find_key(world->material_pairs.data, world->material_pair_count,
                      sizeof(pl_material_pair), key, &found);
    return found ? (pl_material_pair *)world->material_pairs.data + *at : NULL;
}

const plumb_material_pair *pl_material_pair_of(const plumb_world *world, uint32_t row_a,
                                               uint32_t row_b)
{
    if (world->materials.pairs[row_a] == 0 || world->materials.pairs[row_b] == 0) {
        return NULL;
    }
    uint32_t at;
    const pl_material_pair *entry = find(world, key_of(world, row_a, row_b), &at);
    return entry == NULL ? NULL : &entry->value;
}

static void remove_at(plumb_world *world, uint32_t at)
{
    pl_material_pair *items = world->material_pairs.data;
    --world->material_pair_count;
    memmove(items + at, items + at + 1, (world->material_pair_count - at) * sizeof *items);
}

void pl_material_pairs_forget(plumb_world *world, uint32_t row)
{
    for (uint32_t other = 0; other < world->materials.table.count; ++other) {
        uint32_t at;
        if (world->materials.pairs[row] > 0 &&
            find(world, key_of(world, row, other), &at) != NULL) {
            remove_at(world, at);
            --world->materials.pairs[row];
            --world->materials.pairs[other];
        }
    }
}

static plumb_result check(const plumb_world *world, const char *function, plumb_material a,
                          plumb_material b, uint32_t *row_a, uint32_t *row_b)
{
    *row_a = plumb_is_null(a) ? 0 : pl_material_row(world, a);
    *row_b = plumb_is_null(b) ? 0 : pl_material_row(world, b);
    if (*row_a == PL_NONE) {
        return pl_fail_handle(world, function, "a", a.entity, "a live material or null");
    }
    return *row_b != PL_NONE
               ? PLUMB_OK
               : pl_fail_handle(world, function, "b", b.entity, "a live material or null");
}

// What is made of either may slide now.
static void disturb_users(plumb_world *world, uint32_t row_a, uint32_t row_b)
{
    const pl_pieces *pieces = &world->pieces;
    for (uint32_t p = 0; p < pieces->table.count; ++p) {
        if (pieces->kind[p] != PL_PIECE_FREE &&
            (pieces->material[p] == row_a || pieces->material[p] == row_b)) {
            pl_sleep_disturb_piece(world, p);
        }
    }
}

plumb_result plumb_material_pair_set(plumb_world *world, plumb_material a, plumb_material b,
                                     const plumb_material_pair *pair)
{
    PL_TRY(pl_check_world(world));
    uint32_t row_a, row_b, at;
    PL_TRY(check(world, __func__, a, b, &row_a, &row_b));
    if (pair != NULL) {
        PL_TRY(pl_check_desc(world, __func__, "pair.", PLUMB_TABLE_MATERIAL_PAIR, pair));
    }
    uint64_t key = key_of(world, row_a, row_b);
    pl_material_pair *entry = find(world, key, &at);
    if (entry == NULL
            ? pair == NULL
            : pair != NULL && pl_descs_agree(PLUMB_TABLE_MATERIAL_PAIR, &entry->value, pair)) {
        return PLUMB_OK; // nothing wakes
    }
    if (entry != NULL && pair != NULL) {
        entry->value = *pair;
    } else if (entry != NULL) {
        remove_at(world, at);
        --world->materials.pairs[row_a];
        --world->materials.pairs[row_b];
    } else if (pair != NULL) {
        if (!pl_buffer_reserve(&world->memory, &world->material_pairs,
                               ((size_t)world->material_pair_count + 1) *
                                   sizeof(pl_material_pair))) {
            return pl_fail_memory(world, __func__);
        }
        pl_material_pair *items = world->material_pairs.data;
        memmove(items + at + 1, items + at, (world->material_pair_count - at) * sizeof *items);
        memset(&items[at], 0, sizeof items[at]); // images have no padding of chance
        items[at].key = key;
        items[at].value = *pair;
        ++world->material_pair_count;
        ++world->materials.pairs[row_a];
        ++world->materials.pairs[row_b];
    }
    disturb_users(world, row_a, row_b);
    world->schedule_dirty = true;
    return PLUMB_OK;
}

plumb_result plumb_material_pair_get(const plumb_world *world, plumb_material a, plumb_material b,
                                     plumb_material_pair *pair)
{
    PL_TRY(pl_check_world(world));
    uint32_t row_a, row_b;
    PL_TRY(check(world, __func__, a, b, &row_a, &row_b));
    PL_TRY(pl_check_pointer(world, __func__, "pair", pair));
    const plumb_material_pair *value = pl_material_pair_of(world, row_a, row_b);
    if (value == NULL) {
        return pl_fail(world, PLUMB_E_MISSING, __func__,
                       "nothing is set for a and b; their materials are mixed");
    }
    *pair = *value;
    return PLUMB_OK;
}
