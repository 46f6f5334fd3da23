// law_list.c - the list of laws: dense, in the order in which they were made; formulas in the order of those that have one.
//
// Reads, writes: the list, the registry. Cost: O(laws); to wake O(bodies).
#include "world/law_list.h"

#include "world/body_settings.h"
#include "world/island.h"
#include "world/rows.h"

#include <string.h>

uint32_t pl_law_find(const plumb_world *world, plumb_law law)
{
    if (world == NULL) {
        return PL_NONE;
    }
    const pl_slot *slot = pl_registry_find(&world->registry, law.entity);
    return slot != NULL && slot->kind == PLUMB_KIND_LAW ? slot->row : PL_NONE;
}

void pl_law_disturb(plumb_world *world, const pl_law_data *d)
{
    const double half = (double)(d->half.x + d->half.y);
    const double reach = half > 0 ? half : (double)d->radius;
    if (!(reach > 0) || !plumb_is_null(d->body) || d->kind == PLUMB_LAW_MUTUAL) {
        pl_sleep_disturb_all(world);
        return;
    }
    const pl_bodies *b = &world->bodies;
    for (uint32_t row = 0; row < b->table.count; ++row) {
        const double x = (double)b->center_x[row] - (double)d->position.x;
        const double y = (double)b->center_y[row] - (double)d->position.y;
        if (b->type[row] == PLUMB_DYNAMIC && x * x + y * y <= reach * reach) {
            pl_sleep_disturb(world, row);
        }
    }
}

// How many formulas those before a row have.
static uint32_t formulas_before(const pl_laws *laws, uint32_t row)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < row; ++i) {
        count += pl_law_items(laws)[i].formula > 0;
    }
    return count;
}

static void number_formulas(pl_laws *laws)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < laws->count; ++i) {
        pl_law *item = &pl_law_items(laws)[i];
        item->formula = item->desc.kind == PLUMB_LAW_FORMULA ? ++count : 0;
    }
}

static void keep_formula(pl_laws *laws, uint32_t row, const pl_law_formula *formula)
{
    const uint32_t at = formulas_before(laws, row);
    pl_law_formula *place = pl_law_formulas(laws) + at;
    const bool had = pl_law_items(laws)[row].formula > 0;
    if (had && formula == NULL) {
        --laws->formula_count;
        memmove(place, place + 1, (laws->formula_count - at) * sizeof *place);
    } else if (!had && formula != NULL) {
        memmove(place + 1, place, (laws->formula_count - at) * sizeof *place);
        ++laws->formula_count;
    }
    if (formula != NULL) {
        *place = *formula;
        place->law = pl_law_items(laws)[row].entity;
    }
}

static void copy(pl_law_data *to, const pl_law_data *from)
{
    PL_LAW_DESC(PL_COPY_MEMBER)
}

void pl_law_become(plumb_world *world, uint32_t row, const pl_law_data *desc,
                   const pl_law_formula *formula)
{
    pl_laws *laws = &world->laws;
    if (formula != NULL || pl_law_items(laws)[row].formula > 0) {
        keep_formula(laws, row, formula);
    }
    copy(&pl_law_items(laws)[row].desc, desc);
    number_formulas(laws);
    world->schedule_dirty = true;
}

void pl_law_remove(plumb_world *world, uint32_t row)
{
    pl_laws *laws = &world->laws;
    pl_law *items = pl_law_items(laws);
    pl_law_disturb(world, &items[row].desc);
    if (items[row].formula > 0) {
        keep_formula(laws, row, NULL);
    }
    pl_registry_release(&world->registry, items[row].entity.entity);
    memmove(&items[row], &items[row + 1], (--laws->count - row) * sizeof *items);
    for (uint32_t i = row; i < laws->count; ++i) {
        pl_registry_move(&world->registry, items[i].entity.entity.index, i);
    }
    number_formulas(laws);
    world->schedule_dirty = true;
}

void pl_laws_miss(plumb_world *world, uint32_t row)
{
    const pl_body_settings t = pl_body_settings_get(world, row);
    for (uint32_t i = 0; i < world->laws.count; ++i) {
        const pl_law_data *d = &pl_law_items(&world->laws)[i].desc;
        const bool holds =
            d->hold == PLUMB_LAW_ON_CHARGE ? t.charge != 0 || t.dipole != 0 : t.attraction > 0;
        if (d->kind == PLUMB_LAW_MUTUAL && holds) {
            pl_sleep_disturb_all(world);
            return;
        }
    }
}

void pl_laws_forget(plumb_world *world, plumb_body body)
{
    for (uint32_t i = world->laws.count; i-- > 0;) {
        if (plumb_same(pl_law_items(&world->laws)[i].desc.body, body)) {
            pl_law_remove(world, i);
        }
    }
}
