// check.c - see check.h: values, columns by their rules (rules.h), then how rows hang together
// (check_rows.c, check_links.c).
//
// Reads: the image. Writes: nothing but scratch. Cost: O(state), each list walked once.
#include "snapshot/check.h"

#include "snapshot/image.h"
#include "snapshot/rules.h"
#include "world/check.h"

#include <string.h>

//---- numbers -------------------------------------------------------------------------------------

// Without a branch a number: infinity minus itself is not 0.
bool pl_are_reals(const void *data, size_t count)
{
    const real *v = data;
    real sum = 0;
    for (size_t i = 0; i < count; ++i) {
        sum += v[i] - v[i] != 0 ? (real)1 : (real)0;
    }
    return sum == 0;
}

bool pl_are_near_reals(const void *data, size_t count)
{
    const near_real *v = data;
    for (size_t i = 0; i < count; ++i) {
        if (v[i] - v[i] != 0) {
            return false;
        }
    }
    return true;
}

bool pl_are_bools(const void *data, size_t count)
{
    const unsigned char *v = data;
    unsigned char all = 0;
    for (size_t i = 0; i < count; ++i) {
        all |= v[i];
    }
    return all <= 1;
}

// A type says: finite, or 0 and 1.
static bool fits_type(pl_type type, const char *data, size_t bytes)
{
    switch (type) {
    case PL_TYPE_FLOAT:
    case PL_TYPE_DOUBLE:
    case PL_TYPE_VEC2:
        return pl_are_reals(data, bytes / sizeof(real));
    case PL_TYPE_BOOL:
        return pl_are_bools(data, bytes);
    default:
        return true;
    }
}

static uint64_t number_at(const char *data, uint32_t stride, uint32_t i)
{
    switch (stride) {
    case 1:
        return ((const uint8_t *)data)[i];
    case 2:
        return ((const uint16_t *)(const void *)data)[i];
    default:
        return ((const uint32_t *)(const void *)data)[i];
    }
}

static uint32_t count_of(const plumb_world *w, uint32_t of)
{
    const uint32_t counts[] = {
        [PL_OF_BODIES] = w->bodies.table.count,       [PL_OF_PIECES] = w->pieces.table.count,
        [PL_OF_MATERIALS] = w->materials.table.count, [PL_OF_JOINTS] = w->joints.count,
        [PL_OF_CHARACTERS] = w->characters.count,     [PL_OF_SETTINGS] = w->settings.count,
        [PL_OF_ISLANDS] = w->sleep.island_slots,      [PL_OF_SLEEPING] = w->sleep.contact_slots
    };
    return counts[of];
}

static bool keeps_rule(const plumb_world *w, pl_rule rule, const pl_section *section)
{
    if (rule.kind == PL_RULE_IS_ANY || rule.kind == PL_RULE_IS_GUARDED) {
        return true;
    }
    if (rule.kind == PL_RULE_IS_WITHIN) {
        const real *v = (const real *)(const void *)section->data;
        const real low = (real)rule.low, high = (real)rule.high;
        for (uint32_t i = 0; i < section->count; ++i) {
            if (!(v[i] >= low && v[i] <= high)) {
                return false;
            }
        }
        return true;
    }
    // As the greatest number that is allowed: 1 more than one below the count is the count.
    const uint64_t count = rule.kind == PL_RULE_IS_UP_TO ? 0 : count_of(w, rule.of);
    const uint64_t most = rule.kind == PL_RULE_IS_UP_TO      ? rule.of
                          : rule.kind == PL_RULE_IS_ONE_MORE ? count
                                                             : count - 1;
    for (uint32_t i = 0; i < section->count; ++i) {
        const uint64_t v = number_at(section->data, section->stride, i);
        const bool none = rule.kind == PL_RULE_IS_PLACE_OR_NONE && v == PL_NONE;
        if (!none && (v > most || (count == 0 && rule.kind == PL_RULE_IS_PLACE) ||
                      (count == 0 && rule.kind == PL_RULE_IS_PLACE_OR_NONE))) {
            return false;
        }
    }
    return true;
}

//---- values --------------------------------------------------------------------------------------

static bool is_amount(double v)
{
    return v - v == 0 && v >= 0;
}

static bool dial_is_sound(const pl_dial *d)
{
    return d->tier < PL_DIAL_TIERS && d->reason < PL_DIAL_REASONS && is_amount(d->elapsed) &&
           is_amount(d->speed) && is_amount(d->push) && is_amount(d->need) && is_amount(d->loose) &&
           is_amount(d->rest) && is_amount(d->motion) && is_amount(d->frozen) &&
           is_amount(d->worst);
}

static bool check_values(const pl_suspect *s)
{
    const plumb_world *w = &s->world;
    return pl_desc_is_sound(PLUMB_TABLE_WORLD, &w->desc) && w->desc.substeps > 0 &&
           w->desc.iterations > 0 && w->time - w->time == 0 && w->time >= 0 &&
           w->soft_substep - w->soft_substep == 0 && w->soft_substep >= 0 && w->sleep.since >= 0 &&
           w->sleep.passed >= 0 && dial_is_sound(&w->dial) && w->continuous.least_slack >= 0;
}

//---- all -----------------------------------------------------------------------------------------

static bool check_sections(const pl_suspect *s)
{
    for (uint32_t i = 0; i < pl_section_fixed_count(); ++i) {
        const pl_section section = pl_section_at(&s->world, i);
        const pl_rule rule = pl_section_rule(i);
        const bool guarded = rule.kind == PL_RULE_IS_GUARDED;
        if ((!guarded && !fits_type(section.type, section.data, pl_section_bytes(&section))) ||
            !keeps_rule(&s->world, rule, &section)) {
            return false;
        }
    }
    return true;
}

// Owners are alive, or a command will make them; and each has one.
static bool check_owners(pl_suspect *s, const plumb_entity *owner, uint32_t count)
{
    const pl_registry *r = &s->world.registry;
    bool sound = true;
    for (uint32_t i = 0; i < count && sound; ++i) {
        sound = pl_registry_find(r, owner[i]) != NULL && s->marks[owner[i].index]++ == 0;
    }
    memset(s->marks, 0, r->count * sizeof *s->marks);
    return sound;
}

static bool check_component(const pl_component *c, const char *values, uint32_t count)
{
    for (int k = 0; k < c->desc.field_count; ++k) {
        for (uint32_t i = 0; c->fields[k].type == PLUMB_FIELD_BOOL && i < count; ++i) {
            if (!pl_are_bools(values + i * c->desc.size + c->fields[k].offset, 1)) {
                return false;
            }
        }
    }
    return true;
}

// How many marks.
static size_t mark_room(const plumb_world *w)
{
    const size_t counts[] = { w->registry.count,        w->pieces.table.count,
                              w->bodies.table.count,    w->joints.count,
                              w->materials.table.count, w->sleep.island_slots,
                              w->sleep.contact_slots };
    size_t most = 0;
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i) {
        most = counts[i] > most ? counts[i] : most;
    }
    return most;
}

// Lends the sections of the image to `suspect`. False: its values cannot be read.
static bool lend_all(pl_suspect *suspect, const pl_image_part *parts, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (!pl_section_lend(&suspect->world, i, parts[i].data, parts[i].count)) {
            return false;
        }
    }
    return true;
}

static bool check_components(pl_suspect *s, const pl_image_part *parts)
{
    for (uint32_t i = 0; i < s->like->components.count; ++i) {
        const pl_image_part *values = &parts[2 * i], *owners = values + 1;
        if (values->count != owners->count ||
            !check_owners(s, (const plumb_entity *)(const void *)owners->data, owners->count) ||
            !check_component(&s->like->components.items[i], values->data, values->count)) {
            return false;
        }
    }
    return true;
}

bool pl_parts_are_sound(plumb_world *world, const pl_image_part *parts, bool *starved)
{
    pl_buffer *scratch = &world->checking;
    const uint32_t fixed = pl_section_fixed_count();
    *starved = !pl_buffer_reserve(&world->memory, scratch, sizeof(pl_suspect));
    if (*starved) {
        return false;
    }
    pl_suspect *s = scratch->data;
    memset(s, 0, sizeof *s);
    if (!lend_all(s, parts, fixed)) {
        return false;
    }
    const size_t room = mark_room(&s->world) * sizeof *s->marks;
    *starved = !pl_buffer_reserve(&world->memory, scratch, sizeof *s + room);
    if (*starved) {
        return false;
    }
    s = scratch->data;
    s->like = world;
    s->marks = (uint32_t *)(void *)(s + 1);
    memset(s->marks, 0, room);
    return check_sections(s) && check_values(s) && pl_check_registry(s) && pl_check_bodies(s) &&
           pl_check_pieces(s) && pl_check_materials(s) && pl_check_joints(s) && pl_check_sleep(s) &&
           pl_check_contacts(s) && pl_check_internal_edges(s) && pl_check_extras(s) &&
           check_components(s, parts + fixed);
}
