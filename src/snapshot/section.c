// section.c - see section.h. The lists of list.h and world/columns.h become tables of offsets.
#include "snapshot/section.h"

#include "api/command.h"
#include "schema/effects.h"
#include "world/marks.h"
#include "snapshot/section_own.h"

#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

//---- values: many numbers, one section -----------------------------------------------------------

typedef struct value_row {
    const char *name;
    size_t offset, size;
    pl_type type;
} value_row;

#define VALUE_ROW(path)                                                                            \
    { #path, offsetof(plumb_world, path), sizeof PL_STATE_OF(path), PL_TYPE(PL_STATE_OF(path)) },
#define VALUE_SIZE(path) +sizeof PL_STATE_OF(path)

#define EACH_VALUE(X)                                                                              \
    PL_STATE(X, PL_STATE_NO_TALLY, PL_STATE_NO_ARRAY, PL_STATE_NO_TABLE, PL_STATE_NO_OWN,          \
             PL_STATE_NO_LEFT)
#define EACH_TALLY(X)                                                                              \
    PL_STATE(PL_STATE_NO_VALUE, X, PL_STATE_NO_ARRAY, PL_STATE_NO_TABLE, PL_STATE_NO_OWN,          \
             PL_STATE_NO_LEFT)

static const value_row values[] = { EACH_VALUE(VALUE_ROW) };
static const value_row tallies[] = { EACH_TALLY(VALUE_ROW) };

#define VALUES_SIZE  (0 EACH_VALUE(VALUE_SIZE))
#define TALLIES_SIZE (0 EACH_TALLY(VALUE_SIZE))

_Static_assert(VALUES_SIZE <= PL_GATHERED_MOST, "raise PL_GATHERED_MOST");
_Static_assert(TALLIES_SIZE <= PL_GATHERED_MOST, "raise PL_GATHERED_MOST");

static void write_values(const plumb_world *world, const value_row *rows, size_t count, char *to)
{
    for (size_t i = 0; i < count; ++i) {
        memcpy(to, (const char *)world + rows[i].offset, rows[i].size);
        to += rows[i].size;
    }
}

static void read_values(plumb_world *world, const value_row *rows, size_t count, const char *from)
{
    for (size_t i = 0; i < count; ++i) {
        memcpy((char *)world + rows[i].offset, from, rows[i].size);
        from += rows[i].size;
    }
}

//---- tables --------------------------------------------------------------------------------------

typedef struct column_row {
    const char *table, *name;
    size_t offset; // of the column pointer in the world
    uint32_t stride, hashed;
    pl_type type;
    pl_rule rule;
} column_row;

// Not hashed: addresses, hints, and boxes of the grids.
// clang-format off
#define HASHED(type)                                                                                \
    _Generic(*(type *)NULL, void *: 0, pl_box: 0, pl_hint: 0, default: (uint32_t)sizeof(type))
// clang-format on

#define COLUMN_ROW(struct, type, name, ...)                                                        \
    { #struct,      #name,        offsetof(plumb_world, struct.name),                              \
      sizeof(type), HASHED(type), PL_TYPE(*(type *)NULL),                                          \
      __VA_ARGS__ },
#define BODY_ROW(type, name, ...)     COLUMN_ROW(bodies, type, name, __VA_ARGS__)
#define PIECE_ROW(type, name, ...)    COLUMN_ROW(pieces, type, name, __VA_ARGS__)
#define MATERIAL_ROW(type, name, ...) COLUMN_ROW(materials, type, name, __VA_ARGS__)

static const column_row columns[] = { PL_BODY_COLUMNS(BODY_ROW) PL_PIECE_COLUMNS(PIECE_ROW)
                                          PL_MATERIAL_COLUMNS(MATERIAL_ROW) };

static pl_table *table_of(const plumb_world *world, const column_row *column)
{
    // The first member of each concrete table.
    switch (column->table[0]) {
    case 'b':
        return (pl_table *)&world->bodies.table;
    case 'p':
        return (pl_table *)&world->pieces.table;
    default:
        return (pl_table *)&world->materials.table;
    }
}

// With what goes along with the rows: see pl_rows_reserve and pl_pieces_reserve.
static bool reserve_table(plumb_world *world, const column_row *column, uint32_t count)
{
    pl_memory *memory = &world->memory;
    switch (column->table[0]) {
    case 'b':
        return pl_table_reserve(memory, &world->bodies.table, pl_body_columns, pl_body_column_count,
                                count + 1) &&
               pl_buffer_reserve(memory, &world->poses, (count + 1) * sizeof(pl_pose));
    case 'p':
        return pl_table_reserve(memory, &world->pieces.table, pl_piece_columns,
                                pl_piece_column_count, count) &&
               pl_buffer_reserve(memory, &world->moving, count * sizeof(uint32_t)) &&
               pl_buffer_reserve(memory, &world->sleep.resting, count * sizeof(uint32_t)) &&
               pl_broad_reserve_left(world, (uint32_t)count) && pl_tombstones_reserve(world, count);
    default:
        return pl_table_reserve(memory, &world->materials.table, pl_material_columns,
                                pl_material_column_count, count);
    }
}

//---- arrays --------------------------------------------------------------------------------------

typedef struct array_row {
    const char *name;
    size_t buffer, count, count_size; // offsets in the world; bytes of the count
    uint32_t stride, pitch;
    int passing;
    uint32_t hashed, key;
} array_row;

#define ARRAY_ROW(type, buffer, count, hashed, key)                                                \
    { #buffer,                                                                                     \
      offsetof(plumb_world, buffer),                                                               \
      offsetof(plumb_world, count),                                                                \
      sizeof PL_STATE_OF(count),                                                                   \
      PL_SAVED_BYTES(type),                                                                        \
      sizeof(type),                                                                                \
      PL_PASSING_INDEX(type),                                                                      \
      hashed,                                                                                      \
      key },

static const array_row arrays[] = { PL_STATE(PL_STATE_NO_VALUE, PL_STATE_NO_TALLY, ARRAY_ROW,
                                             PL_STATE_NO_TABLE, PL_STATE_NO_OWN,
                                             PL_STATE_NO_LEFT) };

static pl_buffer *buffer_of(const plumb_world *world, const array_row *row)
{
    return (pl_buffer *)(void *)((char *)world + row->buffer);
}

static uint32_t array_count(const plumb_world *world, const array_row *row)
{
    size_t wide = 0;
    uint32_t narrow = 0;
    const char *from = (const char *)world + row->count;
    if (row->count_size == sizeof wide) {
        memcpy(&wide, from, sizeof wide);
        return (uint32_t)wide;
    }
    memcpy(&narrow, from, sizeof narrow);
    return narrow;
}

// With what has to have as much room.
static bool reserve_array(plumb_world *world, const array_row *row, uint32_t count)
{
    pl_memory *memory = &world->memory;
    pl_joints *joints = &world->joints;
    if (row->buffer == offsetof(plumb_world, joints.items) &&
        (!pl_buffer_reserve(memory, &joints->awake, count * sizeof(uint32_t)) ||
         !pl_buffer_reserve(memory, &joints->broken, count * sizeof(plumb_joint_break)))) {
        return false;
    }
    return pl_buffer_reserve(memory, buffer_of(world, row), (size_t)count * row->pitch);
}

static void set_array_count(plumb_world *world, const array_row *row, uint32_t count)
{
    size_t wide = count;
    char *to = (char *)world + row->count;
    if (row->count_size == sizeof wide) {
        memcpy(to, &wide, sizeof wide);
    } else {
        memcpy(to, &count, sizeof count);
    }
}

//---- all of them ---------------------------------------------------------------------------------

#define VALUES       0
#define TALLIES      1
#define FIRST_COLUMN 2
#define FIRST_ARRAY  (FIRST_COLUMN + (uint32_t)COUNT(columns))
#define FIRST_OWN    (FIRST_ARRAY + (uint32_t)COUNT(arrays))
#define FIXED_COUNT  (FIRST_OWN + PL_OWN_COUNT)

uint32_t pl_section_fixed_count(void)
{
    return FIXED_COUNT;
}

uint32_t pl_section_registry(void)
{
    return FIRST_OWN + PL_OWN_REGISTRY;
}

bool pl_section_value(uint32_t i, pl_member *member)
{
    uint32_t offset = 0;
    if (i >= COUNT(values)) {
        return false;
    }
    for (uint32_t k = 0; k < i; ++k) {
        offset += (uint32_t)values[k].size;
    }
    *member = (pl_member){ values[i].name, offset, (uint32_t)values[i].size, values[i].type };
    return true;
}

static bool is_array(uint32_t i, size_t buffer)
{
    return i >= FIRST_ARRAY && i < FIRST_OWN && arrays[i - FIRST_ARRAY].buffer == buffer;
}

void pl_section_strip(uint32_t i, char *data, uint32_t count)
{
    if (i >= FIRST_COLUMN && i < FIRST_ARRAY && columns[i - FIRST_COLUMN].type == PL_TYPE_POINTER) {
        memset(data, 0, (size_t)count * sizeof(void *));
    } else if (is_array(i, offsetof(plumb_world, commands.bytes))) {
        pl_commands_strip(data, count);
    } else if (is_array(i, offsetof(plumb_world, joints.items))) {
        for (uint32_t k = 0; k < count; ++k) {
            char *item = data + (size_t)k * PL_SAVED_BYTES(pl_joint);
            memset(item + offsetof(pl_joint, desc.user_data), 0, sizeof(void *));
        }
    }
}

uint32_t pl_section_key(uint32_t i)
{
    return i >= FIRST_ARRAY && i < FIRST_OWN ? arrays[i - FIRST_ARRAY].key : 0;
}

uint32_t pl_section_count(const plumb_world *world)
{
    return FIXED_COUNT + 2 * world->components.count;
}

pl_section pl_section_at(const plumb_world *world, uint32_t i)
{
    if (i == VALUES) {
        return (pl_section){ .table = "world",
                             .name = "values",
                             .count = 1,
                             .stride = VALUES_SIZE,
                             .hashed = VALUES_SIZE };
    }
    if (i == TALLIES) {
        return (
            pl_section){ .table = "world", .name = "tallies", .count = 1, .stride = TALLIES_SIZE };
    }
    if (i < FIRST_ARRAY) {
        const column_row *c = &columns[i - FIRST_COLUMN];
        char *data;
        memcpy(&data, (const char *)world + c->offset, sizeof data);
        return (pl_section){ .table = c->table,
                             .name = c->name,
                             .data = data,
                             .count = table_of(world, c)->count,
                             .stride = c->stride,
                             .pitch = c->stride,
                             .passing = -1,
                             .hashed = c->hashed,
                             .type = c->type };
    }
    if (i < FIRST_OWN) {
        const array_row *a = &arrays[i - FIRST_ARRAY];
        return (pl_section){ .table = "world",
                             .name = a->name,
                             .data = buffer_of(world, a)->data,
                             .count = array_count(world, a),
                             .stride = a->stride,
                             .pitch = a->pitch,
                             .passing = a->passing,
                             .hashed = a->hashed,
                             .key = a->key };
    }
    return i < FIXED_COUNT ? pl_own_section(world, i - FIRST_OWN)
                           : pl_own_component(world, i - FIXED_COUNT);
}

// Elements are saved as they are, one behind the other.
static bool is_block(const pl_section *section)
{
    return section->pitch == section->stride && section->passing < 0;
}

// Element k as it is saved.
static void write_element(const pl_section *section, size_t k, char *to)
{
    memcpy(to, section->data + k * section->pitch, section->stride);
    if (section->passing >= 0) {
        uint32_t index;
        memcpy(&index, to + section->passing, sizeof index);
        index = index != PL_NONE ? 0 : PL_NONE;
        memcpy(to + section->passing, &index, sizeof index);
    }
}

bool pl_section_equals(const plumb_world *world, uint32_t i, const pl_section *section,
                       const char *bytes)
{
    char gathered[PL_GATHERED_MOST];
    if (section->count == 0) {
        return true;
    }
    if (section->data == NULL) {
        pl_section_write(world, i, section, gathered);
        return memcmp(gathered, bytes, pl_section_bytes(section)) == 0;
    }
    if (is_block(section)) {
        return memcmp(section->data, bytes, pl_section_bytes(section)) == 0;
    }
    for (size_t k = 0; k < section->count; ++k) {
        write_element(section, k, gathered);
        if (memcmp(gathered, bytes + k * section->stride, section->stride) != 0) {
            return false;
        }
    }
    return true;
}

void pl_section_write(const plumb_world *world, uint32_t i, const pl_section *section, char *to)
{
    if (i == VALUES) {
        write_values(world, values, COUNT(values), to);
    } else if (i == TALLIES) {
        write_values(world, tallies, COUNT(tallies), to);
    } else if (i == FIRST_OWN + PL_OWN_SWITCHES) {
        pl_own_write_switches(world, to);
    } else if (section->count > 0 && is_block(section)) {
        memcpy(to, section->data, pl_section_bytes(section));
    } else {
        for (size_t k = 0; k < section->count; ++k) {
            write_element(section, k, to + k * section->stride);
        }
    }
}

bool pl_section_reserve(plumb_world *world, uint32_t i, uint32_t count)
{
    if (i < FIRST_COLUMN) {
        return true;
    }
    if (i < FIRST_ARRAY) {
        return reserve_table(world, &columns[i - FIRST_COLUMN], count);
    }
    if (i < FIRST_OWN) {
        return reserve_array(world, &arrays[i - FIRST_ARRAY], count);
    }
    return i < FIXED_COUNT ? pl_own_reserve(world, i - FIRST_OWN, count)
                           : pl_own_reserve_component(world, i - FIXED_COUNT, count);
}

void pl_section_read(plumb_world *world, uint32_t i, const char *from, uint32_t count)
{
    if (i == VALUES) {
        read_values(world, values, COUNT(values), from);
        return;
    }
    if (i == TALLIES) {
        read_values(world, tallies, COUNT(tallies), from);
        return;
    }
    if (i >= FIXED_COUNT) {
        pl_own_read_component(world, i - FIXED_COUNT, from, count);
        return;
    }
    if (i >= FIRST_OWN) {
        pl_own_read(world, i - FIRST_OWN, from, count);
        return;
    }
    if (i < FIRST_ARRAY) {
        table_of(world, &columns[i - FIRST_COLUMN])->count = count;
    } else {
        set_array_count(world, &arrays[i - FIRST_ARRAY], count);
    }
    const pl_section section = pl_section_at(world, i);
    if (count > 0 && is_block(&section)) {
        memcpy(section.data, from, pl_section_bytes(&section));
        return;
    }
    for (size_t k = 0; k < count; ++k) {
        char *to = section.data + k * section.pitch;
        memcpy(to, from + k * section.stride, section.stride);
        memset(to + section.stride, 0, section.pitch - section.stride);
    }
}

//---- of an image ---------------------------------------------------------------------------------

pl_rule pl_section_rule(uint32_t i)
{
    return i >= FIRST_COLUMN && i < FIRST_ARRAY ? columns[i - FIRST_COLUMN].rule
                                                : (pl_rule){ .kind = PL_RULE_IS_ANY };
}

static bool is_sound(pl_type type, const char *from)
{
    float f = 0;
    double d = 0;
    real v[2] = { 0 };
    switch (type) {
    case PL_TYPE_FLOAT:
        memcpy(&f, from, sizeof f);
        return f - f == 0;
    case PL_TYPE_DOUBLE:
        memcpy(&d, from, sizeof d);
        return d - d == 0;
    case PL_TYPE_VEC2:
        memcpy(v, from, sizeof v);
        return v[0] - v[0] == 0 && v[1] - v[1] == 0;
    case PL_TYPE_BOOL:
        return *(const unsigned char *)from <= 1;
    default:
        return true;
    }
}

static bool are_sound(const value_row *rows, size_t count, const char *from)
{
    for (size_t i = 0; i < count; ++i) {
        if (!is_sound(rows[i].type, from)) {
            return false;
        }
        from += rows[i].size;
    }
    return true;
}

bool pl_section_lend(plumb_world *world, uint32_t i, const char *data, uint32_t count)
{
    void *lent = (void *)(uintptr_t)data; // nobody writes to it
    if (i < FIRST_COLUMN) {
        const value_row *rows = i == VALUES ? values : tallies;
        const size_t number = i == VALUES ? COUNT(values) : COUNT(tallies);
        if (count != 1 || !are_sound(rows, number, data)) {
            return false;
        }
        read_values(world, rows, number, data);
    } else if (i < FIRST_ARRAY) {
        pl_table *table = table_of(world, &columns[i - FIRST_COLUMN]);
        const bool first =
            i == FIRST_COLUMN || table != table_of(world, &columns[i - 1 - FIRST_COLUMN]);
        memcpy((char *)world + columns[i - FIRST_COLUMN].offset, &lent, sizeof lent);
        if (!first && table->count != count) {
            return false;
        }
        table->count = count;
    } else if (i < FIRST_OWN) {
        buffer_of(world, &arrays[i - FIRST_ARRAY])->data = lent;
        set_array_count(world, &arrays[i - FIRST_ARRAY], count);
    } else {
        return pl_own_lend(world, i - FIRST_OWN, lent, count);
    }
    return true;
}

//---- schema --------------------------------------------------------------------------------------

static void add_text(pl_digest *digest, const char *text)
{
    pl_digest_add(digest, text, strlen(text));
}

static void add_number(pl_digest *digest, uint64_t number)
{
    pl_digest_add(digest, &number, sizeof number);
}

uint64_t pl_section_schema(void)
{
    pl_digest digest;
    pl_digest_begin(&digest);
    for (size_t i = 0; i < COUNT(values); ++i) {
        add_text(&digest, values[i].name);
        add_number(&digest, values[i].size);
    }
    for (size_t i = 0; i < COUNT(tallies); ++i) {
        add_text(&digest, tallies[i].name);
        add_number(&digest, tallies[i].size);
    }
    for (size_t i = 0; i < COUNT(columns); ++i) {
        add_text(&digest, columns[i].name);
        add_number(&digest, columns[i].stride);
    }
    for (size_t i = 0; i < COUNT(arrays); ++i) {
        add_text(&digest, arrays[i].name);
        add_number(&digest, arrays[i].stride);
    }
#define ADD_ABSENT(NAME, word, ...) PL_HAS(NAME) ? (void)0 : add_text(&digest, word);
    PL_EFFECTS(ADD_ABSENT)
#undef ADD_ABSENT
    return pl_digest_end(&digest);
}

uint64_t pl_section_user_schema(const plumb_world *world)
{
    pl_digest digest;
    pl_digest_begin(&digest);
    for (uint32_t i = 0; i < world->components.count; ++i) {
        add_text(&digest, world->components.items[i].name);
        add_number(&digest, world->components.items[i].desc.size);
    }
    return pl_digest_end(&digest);
}
