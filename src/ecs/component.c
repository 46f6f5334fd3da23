// component.c - user components, each a sparse set: values and owners dense, a row number an entity
// slot.
//
// Adding appends; removing moves the last value into the gap. Room is made before anything changes,
// so running out of memory leaves the set as it was.
//
// Reads, writes: the component's set. Cost: O(1) a value.
#include "ecs/component.h"

#include <string.h>

//---- registration --------------------------------------------------------------------------------

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

plumb_component pl_component_register(pl_memory *memory, pl_components *components,
                                      const plumb_component_desc *desc)
{
    pl_component made = { .desc = *desc };
    if (!grow_items(memory, components) || !copy_fields(memory, &made, desc)) {
        return (plumb_component){ 0 };
    }
    memcpy(made.name, desc->name, strlen(desc->name) + 1);
    made.desc.fields = made.fields;
    pl_component *stored = &components->items[components->count++];
    *stored = made;
    stored->desc.name = stored->name;
    return (plumb_component){ components->count };
}

void pl_components_free(pl_memory *memory, pl_components *components)
{
    for (uint32_t i = 0; i < components->count; ++i) {
        pl_component *c = &components->items[i];
        pl_buffer *buffers[] = { &c->values, &c->owners, &c->rows, &c->order, &c->runs };
        pl_resize(memory, c->fields, c->fields_bytes, 0);
        for (size_t k = 0; k < sizeof buffers / sizeof buffers[0]; ++k) {
            pl_buffer_free(memory, buffers[k]);
        }
    }
    pl_resize(memory, components->items, components->bytes, 0);
    *components = (pl_components){ 0 };
}

//---- values --------------------------------------------------------------------------------------

pl_component *pl_component_find(const pl_components *components, plumb_component component)
{
    if (component.id == 0 || component.id > components->count) {
        return NULL;
    }
    return &components->items[component.id - 1];
}

uint32_t pl_component_place(const pl_component *c, uint32_t slot)
{
    if (slot >= c->rows.size / sizeof(uint32_t)) {
        return PL_ABSENT;
    }
    return ((const uint32_t *)c->rows.data)[slot] - 1;
}

static bool reserve_place(pl_memory *memory, pl_component *c, uint32_t slot)
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

void pl_component_write(const pl_component *c, uint32_t place, const void *value)
{
    if (value == NULL) {
        memset(pl_component_value(c, place), 0, c->desc.size);
    } else {
        memmove(pl_component_value(c, place), value, c->desc.size);
    }
}

uint32_t pl_component_append(pl_memory *memory, pl_component *c, plumb_entity entity,
                             const void *value)
{
    // A value of this very column, as when one entity's is given to another, moves when the column
    // grows.
    uintptr_t offset = (uintptr_t)value - (uintptr_t)c->values.data;
    bool is_own = value != NULL && offset < c->values.size;
    if (!reserve_place(memory, c, entity.index)) {
        return PL_ABSENT;
    }
    value = is_own ? (const char *)c->values.data + offset : value;
    uint32_t place = c->count++;
    ((uint32_t *)c->rows.data)[entity.index] = place + 1;
    pl_component_owners(c)[place] = entity;
    pl_component_write(c, place, value);
    ++c->version;
    return place;
}

void pl_component_erase(pl_component *c, uint32_t place)
{
    plumb_entity *owners = pl_component_owners(c);
    uint32_t *rows = c->rows.data;
    const uint32_t last = --c->count, slot = owners[place].index;
    if (place != last) {
        memcpy(pl_component_value(c, place), pl_component_value(c, last), c->desc.size);
        owners[place] = owners[last];
        rows[owners[place].index] = place + 1;
    }
    rows[slot] = 0;
    ++c->version;
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

//---- order ---------------------------------------------------------------------------------------

// Whether values lie by rising row, those without behind; *rows is 1 + the last row.
static bool is_in_order(const pl_component *c, const pl_registry *registry, uint32_t kind,
                        uint32_t *rows)
{
    const plumb_entity *owners = pl_component_owners(c);
    uint32_t before = 0; // 1 + the row of the value before
    bool rising = true;
    *rows = 0;
    for (uint32_t place = 0; place < c->count; ++place) {
        const uint32_t row = pl_row_of_kind(registry, owners[place], kind);
        rising &= row >= before;
        before = row == PL_ABSENT ? row : row + 1;
        *rows = row != PL_ABSENT && row >= *rows ? row + 1 : *rows;
    }
    return rising;
}

// Which value comes where: counting, for each row has one value at the most. `at_row` is room for `rows`
// numbers.
static void find_order(const pl_component *c, const pl_registry *registry, uint32_t kind,
                       uint32_t *order, uint32_t *at_row, uint32_t rows)
{
    const plumb_entity *owners = pl_component_owners(c);
    uint32_t of_kind = 0, behind;
    memset(at_row, 0, rows * sizeof *at_row);
    for (uint32_t place = 0; place < c->count; ++place) {
        const uint32_t row = pl_row_of_kind(registry, owners[place], kind);
        if (row != PL_ABSENT) {
            at_row[row] = place + 1;
            ++of_kind;
        }
    }
    behind = of_kind;
    for (uint32_t place = 0; place < c->count; ++place) {
        if (pl_row_of_kind(registry, owners[place], kind) == PL_ABSENT) {
            order[behind++] = place;
        }
    }
    for (uint32_t row = 0, next = 0; next < of_kind; ++row) {
        if (at_row[row] != 0) {
            order[next++] = at_row[row] - 1;
        }
    }
}

static void swap_values(const pl_component *c, uint32_t a, uint32_t b)
{
    char kept[256];
    char *p = pl_component_value(c, a), *q = pl_component_value(c, b);
    for (size_t left = c->desc.size, share; left > 0; left -= share, p += share, q += share) {
        share = left < sizeof kept ? left : sizeof kept;
        memcpy(kept, p, share);
        memcpy(p, q, share);
        memcpy(q, kept, share);
    }
    plumb_entity *owners = pl_component_owners(c), owner = owners[a];
    owners[a] = owners[b];
    owners[b] = owner;
}

// Value order[i] comes to place i, cycle by cycle.
static void put_in_order(const pl_component *c, uint32_t *order)
{
    for (uint32_t i = 0; i < c->count; ++i) {
        uint32_t at = i;
        while (order[at] != i) {
            const uint32_t from = order[at];
            swap_values(c, at, from);
            order[at] = at;
            at = from;
        }
        order[at] = at;
    }
    const plumb_entity *owners = pl_component_owners(c);
    uint32_t *rows = c->rows.data;
    for (uint32_t place = 0; place < c->count; ++place) {
        rows[owners[place].index] = place + 1;
    }
}

// Puts values in the order of the rows that their owners have in the registry, if they are of that kind;
// the others lie behind them, as they lay. False when out of memory (nothing changed). O(1) where nothing
// moved since the last time, else O(values + rows).
static bool align(pl_memory *memory, pl_component *c, const pl_registry *registry, uint32_t kind)
{
    uint32_t rows;
    if (pl_is_seen(c->aligned, c, registry)) {
        return true;
    }
    if (!is_in_order(c, registry, kind, &rows)) {
        const size_t numbers = (size_t)c->count + rows;
        if (!pl_buffer_reserve(memory, &c->order, numbers * sizeof(uint32_t))) {
            return false;
        }
        uint32_t *order = c->order.data;
        find_order(c, registry, kind, order, order + c->count, rows);
        put_in_order(c, order);
        ++c->version;
    }
    c->aligned = pl_see(c, registry);
    return true;
}

bool pl_components_align(pl_memory *memory, pl_components *components, const pl_registry *registry,
                         uint32_t kind)
{
    for (uint32_t i = 0; i < components->count; ++i) {
        if (!align(memory, &components->items[i], registry, kind)) {
            return false;
        }
    }
    return true;
}
