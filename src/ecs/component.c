// component.c - user components, each a sparse set: values and owners dense, a row number an entity
// slot.
//
// Adding appends; removing moves the last value into the gap. Room is made before anything changes,
// so running out of memory leaves the set as it was. Hooks run with the world locked.
//
// Reads, writes: the component's set. Cost: O(1) a value; O(components) to drop all of an entity.
#include "ecs/component.h"

#include "step/tape.h"
#include "world/check.h"
#include "world/state.h"

#include <string.h>

#define SIZE_MOST   65536u // [B] of a value, see plumb_component_desc
#define FIELDS_MOST 64

//---- lookup --------------------------------------------------------------------------------------

static pl_component *find(const plumb_world *world, plumb_component component)
{
    if (component.id == 0 || component.id > world->components.count) {
        return NULL;
    }
    return &world->components.items[component.id - 1];
}

// Dense row of an entity slot, PL_NONE without.
static uint32_t row_of(const pl_component *c, uint32_t slot)
{
    if (slot >= c->rows.size / sizeof(uint32_t)) {
        return PL_NONE;
    }
    return ((const uint32_t *)c->rows.data)[slot] - 1;
}

static char *value_at(const pl_component *c, uint32_t row)
{
    return (char *)c->values.data + (size_t)row * c->desc.size;
}

static plumb_result check_component(const plumb_world *world, const char *fn,
                                    plumb_component component)
{
    if (find(world, component) != NULL) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_HANDLE, fn, "component is %u; it must be a registered component",
                   (unsigned)component.id);
}

bool pl_component_in_use(const plumb_world *world, plumb_component component)
{
    const pl_component *c = find(world, component);
    return c != NULL && c->count > 0;
}

//---- registration --------------------------------------------------------------------------------

static plumb_result check_fields(const plumb_world *world, const char *fn,
                                 const plumb_component_desc *desc)
{
    static const size_t sizes[] = { 4, 8, 4, 8, 4, 8, sizeof(bool) };
    if (desc->field_count < 0 || desc->field_count > FIELDS_MOST) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "field_count is %d; it must be 0 to %d",
                       desc->field_count, FIELDS_MOST);
    }
    if (desc->field_count > 0 && desc->fields == NULL) {
        return pl_check_pointer(world, fn, "fields", NULL);
    }
    for (int i = 0; i < desc->field_count; ++i) {
        const plumb_field *f = &desc->fields[i];
        plumb_result r = pl_check_name(world, fn, "field name", f->name);
        if (r != PLUMB_OK) {
            return r;
        }
        if ((unsigned)f->type > PLUMB_FIELD_BOOL) {
            return pl_fail(world, PLUMB_E_RANGE, fn,
                           "type of field '%s' is %d; it must be a plumb_field_type", f->name,
                           (int)f->type);
        }
        if (f->offset > desc->size || desc->size - f->offset < sizes[f->type]) {
            return pl_fail(
                world, PLUMB_E_RANGE, fn,
                "offset of field '%s' is %zu; the field must lie in the %zu bytes of a value",
                f->name, f->offset, desc->size);
        }
    }
    return PLUMB_OK;
}

static plumb_result check_desc(const plumb_world *world, const char *fn,
                               const plumb_component_desc *desc)
{
    plumb_result r = pl_check_pointer(world, fn, "desc", desc);
    r = r != PLUMB_OK ? r : pl_check_name(world, fn, "name", desc->name);
    if (r == PLUMB_OK && (desc->size == 0 || desc->size > SIZE_MOST)) {
        r = pl_fail(world, PLUMB_E_RANGE, fn, "size is %zu; it must be 1 to %u", desc->size,
                    SIZE_MOST);
    }
    r = r != PLUMB_OK ? r : check_fields(world, fn, desc);
    if (r == PLUMB_OK && plumb_component_find(world, desc->name).id != 0) {
        r = pl_fail(world, PLUMB_E_DUPLICATE, fn, "name is '%s'; it must be new", desc->name);
    }
    if (r == PLUMB_OK && world->components.count == PL_COMPONENT_MAX) {
        r = pl_fail(world, PLUMB_E_CAPACITY, fn, "component is the %dth; there must be at most %d",
                    PL_COMPONENT_MAX + 1, PL_COMPONENT_MAX);
    }
    return r;
}

static size_t text_bytes(const char *text)
{
    return text == NULL ? 0 : strlen(text) + 1;
}

static const char *copy_text(char **cursor, const char *text)
{
    size_t bytes = text_bytes(text);
    if (bytes == 0) {
        return NULL;
    }
    char *copy = *cursor;
    memcpy(copy, text, bytes);
    *cursor += bytes;
    return copy;
}

// Fields, then their names and units, in one block.
static bool copy_fields(pl_memory *memory, pl_component *c, const plumb_component_desc *desc)
{
    size_t array = (size_t)desc->field_count * sizeof(plumb_field);
    size_t bytes = array;
    for (int i = 0; i < desc->field_count; ++i) {
        bytes += text_bytes(desc->fields[i].name) + text_bytes(desc->fields[i].unit);
    }
    if (bytes == 0) {
        return true;
    }
    c->fields = pl_resize(memory, NULL, 0, bytes);
    if (c->fields == NULL) {
        return false;
    }
    c->fields_bytes = bytes;
    char *cursor = (char *)c->fields + array;
    for (int i = 0; i < desc->field_count; ++i) {
        c->fields[i] = desc->fields[i];
        c->fields[i].name = copy_text(&cursor, desc->fields[i].name);
        c->fields[i].unit = copy_text(&cursor, desc->fields[i].unit);
    }
    return true;
}

// The array grows one by one: registrations are few and rare.
static bool grow_items(pl_memory *memory, pl_components *components)
{
    size_t bytes = (components->count + 1) * sizeof(pl_component);
    if (bytes <= components->bytes) {
        return true;
    }
    pl_component *items = pl_resize(memory, components->items, components->bytes, bytes);
    if (items == NULL) {
        return false;
    }
    components->items = items;
    components->bytes = bytes;
    for (uint32_t i = 0; i < components->count; ++i) {
        items[i].desc.name = items[i].name; // the names have moved along
    }
    return true;
}

plumb_component plumb_component_create(plumb_world *world, const plumb_component_desc *desc)
{
    plumb_component none = { 0 };
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        check_desc(world, __func__, desc) != PLUMB_OK) {
        return none;
    }
    pl_component made = { .desc = *desc };
    if (!grow_items(&world->memory, &world->components) ||
        !copy_fields(&world->memory, &made, desc)) {
        pl_fail_memory(world, __func__);
        return none;
    }
    memcpy(made.name, desc->name, strlen(desc->name) + 1);
    made.desc.fields = made.fields;
    pl_component *stored = &world->components.items[world->components.count++];
    *stored = made;
    stored->desc.name = stored->name;
    return (plumb_component){ world->components.count };
}

plumb_component plumb_component_find(const plumb_world *world, const char *name)
{
    if (world != NULL && name != NULL) {
        for (uint32_t i = 0; i < world->components.count; ++i) {
            if (strcmp(world->components.items[i].name, name) == 0) {
                return (plumb_component){ i + 1 };
            }
        }
    }
    return (plumb_component){ 0 };
}

plumb_result plumb_component_info(const plumb_world *world, plumb_component component,
                                  plumb_component_desc *desc)
{
    if (world == NULL) {
        return PLUMB_E_NULL;
    }
    plumb_result r = check_component(world, __func__, component);
    r = r != PLUMB_OK ? r : pl_check_pointer(world, __func__, "desc", desc);
    if (r == PLUMB_OK) {
        *desc = find(world, component)->desc;
    }
    return r;
}

//---- values --------------------------------------------------------------------------------------

static void run_hook(plumb_world *world, const pl_component *c, plumb_component_hook *hook,
                     uint32_t row)
{
    if (hook == NULL) {
        return;
    }
    const char *locked_by = world->locked_by;
    bool in_hook = world->in_hook;
    world->locked_by = c->name;
    world->in_hook = true;
    hook(world, ((const plumb_entity *)c->owners.data)[row], value_at(c, row), c->desc.context);
    world->locked_by = locked_by;
    world->in_hook = in_hook;
}

static bool reserve_row(pl_memory *memory, pl_component *c, uint32_t slot)
{
    size_t known = c->rows.size;
    size_t count = (size_t)c->count + 1;
    if (!pl_buffer_reserve(memory, &c->rows, ((size_t)slot + 1) * sizeof(uint32_t))) {
        return false;
    }
    memset((char *)c->rows.data + known, 0, c->rows.size - known);
    return pl_buffer_reserve(memory, &c->values, count * c->desc.size) &&
           pl_buffer_reserve(memory, &c->owners, count * sizeof(plumb_entity));
}

static void write_value(const pl_component *c, uint32_t row, const void *value)
{
    if (value == NULL) {
        memset(value_at(c, row), 0, c->desc.size);
    } else {
        memmove(value_at(c, row), value, c->desc.size);
    }
}

bool pl_component_put(plumb_world *world, plumb_entity entity, plumb_component component,
                      const void *value)
{
    pl_component *c = find(world, component);
    uint32_t row = row_of(c, entity.index);
    if (row != PL_NONE) {
        write_value(c, row, value);
        return true;
    }
    // A value of this very column, as when one entity's is given to another, moves when the column
    // grows.
    uintptr_t offset = (uintptr_t)value - (uintptr_t)c->values.data;
    bool is_own = value != NULL && offset < c->values.size;
    if (!reserve_row(&world->memory, c, entity.index)) {
        return false;
    }
    value = is_own ? (const char *)c->values.data + offset : value;
    row = c->count++;
    ((uint32_t *)c->rows.data)[entity.index] = row + 1;
    ((plumb_entity *)c->owners.data)[row] = entity;
    write_value(c, row, value);
    world->schedule_dirty = true;
    run_hook(world, c, c->desc.on_add, row);
    return true;
}

// What it does within a step is recorded there, and replayed without it: see step/tape.h.
static void run_drop_hook(plumb_world *world, const pl_component *c, uint32_t row)
{
    pl_tape *tape = world->tape;
    bool told = tape != NULL && tape->steps;
    if (told && tape->dropping != NULL) {
        tape->dropping(tape, world);
    }
    run_hook(world, c, c->desc.on_remove, row);
    if (told && tape->dropped != NULL) {
        tape->dropped(tape, world);
    }
}

bool pl_component_drop(plumb_world *world, plumb_entity entity, plumb_component component)
{
    pl_component *c = find(world, component);
    uint32_t row = row_of(c, entity.index);
    if (row == PL_NONE) {
        return false;
    }
    run_drop_hook(world, c, row);
    plumb_entity *owners = c->owners.data;
    uint32_t *rows = c->rows.data;
    uint32_t last = --c->count;
    if (row != last) {
        memcpy(value_at(c, row), value_at(c, last), c->desc.size);
        owners[row] = owners[last];
        rows[owners[row].index] = row + 1;
    }
    rows[entity.index] = 0;
    world->schedule_dirty = true;
    return true;
}

void pl_components_drop_all(plumb_world *world, plumb_entity entity)
{
    for (uint32_t id = 1; id <= world->components.count; ++id) {
        pl_component_drop(world, entity, (plumb_component){ id });
    }
}

void pl_component_digest(const pl_component *c, const char *value, pl_digest *digest)
{
    static const uint8_t sizes[] = { 4, 8, 4, 8, 4, 8, sizeof(bool) };
    for (int k = 0; k < c->desc.field_count; ++k) {
        pl_digest_add(digest, value + c->fields[k].offset, sizes[c->fields[k].type]);
    }
    if (c->desc.field_count == 0) {
        pl_digest_add(digest, value, c->desc.size);
    }
}

void pl_components_bury(plumb_world *world)
{
    for (uint32_t i = 0; i < world->components.count; ++i) {
        pl_component *c = &world->components.items[i];
        for (uint32_t row = 0; row < c->count; ++row) {
            run_hook(world, c, c->desc.on_remove, row);
        }
    }
}

void pl_components_free(pl_memory *memory, pl_components *components)
{
    for (uint32_t i = 0; i < components->count; ++i) {
        pl_component *c = &components->items[i];
        pl_resize(memory, c->fields, c->fields_bytes, 0);
        pl_buffer_free(memory, &c->values);
        pl_buffer_free(memory, &c->owners);
        pl_buffer_free(memory, &c->rows);
    }
    pl_resize(memory, components->items, components->bytes, 0);
    *components = (pl_components){ 0 };
}

plumb_result plumb_component_set(plumb_world *world, plumb_entity entity, plumb_component component,
                                 const void *value)
{
    plumb_result r = pl_check_entity(world, __func__, entity);
    r = r != PLUMB_OK ? r : check_component(world, __func__, component);
    if (r == PLUMB_OK && row_of(find(world, component), entity.index) == PL_NONE) {
        r = pl_check_unlocked(world, __func__); // adding a row is structural, overwriting is not
    }
    if (r == PLUMB_OK && !pl_component_put(world, entity, component, value)) {
        r = pl_fail_memory(world, __func__);
    }
    return r;
}

void *plumb_component_get(plumb_world *world, plumb_entity entity, plumb_component component)
{
    if (world == NULL || pl_check_entity(world, __func__, entity) != PLUMB_OK) {
        return NULL;
    }
    const pl_component *c = find(world, component);
    uint32_t row = c == NULL ? PL_NONE : row_of(c, entity.index);
    return row == PL_NONE ? NULL : value_at(c, row);
}

plumb_result plumb_component_remove(plumb_world *world, plumb_entity entity,
                                    plumb_component component)
{
    plumb_result r = pl_check_entity(world, __func__, entity);
    r = r != PLUMB_OK ? r : check_component(world, __func__, component);
    r = r != PLUMB_OK ? r : pl_check_unlocked(world, __func__);
    if (r == PLUMB_OK && !pl_component_drop(world, entity, component)) {
        r = pl_fail(world, PLUMB_E_MISSING, __func__, "entity has no '%s'; it must have it",
                    find(world, component)->name);
    }
    return r;
}

plumb_component_span plumb_world_column(plumb_world *world, plumb_component component)
{
    const pl_component *c = world == NULL ? NULL : find(world, component);
    if (c == NULL) {
        return (plumb_component_span){ 0 };
    }
    return (plumb_component_span){ (int)c->count, c->desc.size, c->owners.data, c->values.data };
}
