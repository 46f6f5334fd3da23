// compare.c - see compare.h. Entity by entity, so that rows that have changed places are no difference.
//
// Two rounds: the first tells what a user knows of (positions, velocities, settings, ...); only where that
// is all alike, the second tells the rest (links, timers, boxes).
//
// Reads: two images, names of a world. Cost: O(state), of lists in which everything has moved O(n x 64).
#include "record/compare.h"

#include "record/value.h"
#include "world/check.h"

#include <stdio.h>
#include <string.h>

#define COUNT(array)  (sizeof(array) / sizeof((array)[0]))
#define SECTIONS_MOST (256 + 2 * PL_COMPONENT_MAX)
#define SEARCH_MOST   64u // contacts that are searched for the same pair

typedef struct side {
    const char *bytes;             // of the image
    uint32_t place[SECTIONS_MOST]; // of a section in it, in units of 8 bytes
    uint32_t count[SECTIONS_MOST];
    uint32_t sections;
} side;

typedef struct comparison {
    const plumb_world *layout;
    side a, b;
    uint32_t sections; // in both
    plumb_difference *rows;
    int capacity, count;
    bool settings;
    bool second; // round: the rest is told, too
} comparison;

static const char *data_of(const side *s, uint32_t section)
{
    return s->bytes + (size_t)8 * s->place[section];
}

static void open_side(side *s, const pl_image *image)
{
    pl_image_cursor at = pl_image_begin(image);
    s->bytes = image->bytes;
    s->sections = (uint32_t)image->header.section_count;
    for (uint32_t i = 0; i < s->sections && i < SECTIONS_MOST; ++i) {
        pl_image_next(image, &at);
        s->place[i] = (uint32_t)((size_t)(at.data - image->bytes) / 8);
        s->count[i] = at.entry.count;
    }
}

//---- rows ----------------------------------------------------------------------------------------

static void add(comparison *c, const plumb_difference *row)
{
    if (c->count < c->capacity) {
        c->rows[c->count] = *row;
    }
    ++c->count;
}

// The two values of a member of one thing, if they are not alike.
static void add_member(comparison *c, const plumb_difference *who, const char *a, const char *b,
                       const pl_member *m)
{
    a += m->offset;
    b += m->offset;
    if (memcmp(a, b, m->size) == 0) {
        return;
    }
    plumb_difference row = *who;
    snprintf(row.component, sizeof row.component, "%s", m->name);
    pl_value_texts(&row, a, b, m);
    add(c, &row);
}

static void add_members(comparison *c, const plumb_difference *who, const char *a, const char *b,
                        const pl_member *members, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        add_member(c, who, a, b, &members[i]);
    }
}

static plumb_difference thing(plumb_entity entity, plumb_entity_kind kind, const char *table)
{
    plumb_difference row = { .entity = entity, .entity_kind = kind };
    snprintf(row.table, sizeof row.table, "%s", table);
    return row;
}

// What a user knows of: not what links rows, names pieces, or times rest.
static bool is_told(const comparison *c, const pl_section *section)
{
    static const char *const rest[] = { "rest_time", "rest_x",    "rest_y",  "rest_c",
                                        "rest_s",    "rest_dx",   "rest_dy", "rest_samples",
                                        "slack",     "rest_turn", "fat" };
    bool told = section->type != PL_TYPE_U32 && section->type != PL_TYPE_POINTER &&
                section->type != PL_TYPE_ENTITY;
    for (size_t i = 0; told && i < sizeof rest / sizeof rest[0]; ++i) {
        told = strcmp(section->name, rest[i]) != 0;
    }
    return told || c->second;
}

// Columns of a table, row `a` of A against row `b` of B.
static void add_columns(comparison *c, const plumb_difference *who, const char *table, uint32_t a,
                        uint32_t b)
{
    for (uint32_t i = 2; i < pl_section_fixed_count(); ++i) {
        pl_section section = pl_section_at(c->layout, i);
        size_t stride = section.stride;
        if (strcmp(section.table, table) != 0 || a >= c->a.count[i] || b >= c->b.count[i]) {
            continue;
        }
        const char *va = data_of(&c->a, i) + a * stride, *vb = data_of(&c->b, i) + b * stride;
        if (memcmp(va, vb, stride) != 0 && is_told(c, &section)) {
            const pl_member m = { section.name, 0, section.stride, section.type };
            add_member(c, who, va, vb, &m);
        }
    }
}

static uint32_t find_section(const comparison *c, const char *table, const char *name)
{
    uint32_t i = 0;
    for (; i < pl_section_fixed_count(); ++i) {
        pl_section section = pl_section_at(c->layout, i);
        if (strcmp(section.table, table) == 0 && strcmp(section.name, name) == 0) {
            break;
        }
    }
    return i;
}

//---- entities ------------------------------------------------------------------------------------

#define MEMBER(struct, path)                                                                       \
    { #path, offsetof(struct, path), sizeof(((struct *)0)->path), PL_TYPE(((struct *)0)->path) },
#define JOINT_MEMBER(path)           MEMBER(pl_joint, path)
#define TUNING_MEMBER(name, initial) MEMBER(pl_body_settings, name)
#define CHARACTER_MEMBER(path)       MEMBER(pl_character, path)

static const pl_member joint_members[] = { PL_STATE_JOINT(JOINT_MEMBER)
                                               PL_STATE_CABLE(JOINT_MEMBER) };
static const pl_member character_members[] = { PL_STATE_CHARACTER(CHARACTER_MEMBER) };
static const pl_member settings_members[] = { PL_BODY_ROWS(PL_ROW_RECORD, TUNING_MEMBER) };
static const pl_member target_members[] = { MEMBER(pl_target, x) MEMBER(pl_target, y)
                                                MEMBER(pl_target, turn) MEMBER(pl_target, left) };
static const pl_member track_members[] = { MEMBER(pl_track, axis) MEMBER(pl_track, end)
                                               MEMBER(pl_track, time) MEMBER(pl_track, left)
                                                   MEMBER(pl_track, x) MEMBER(pl_track, y)
                                                       MEMBER(pl_track, turn) };
static const pl_member pair_members[] = { MEMBER(pl_pair, normal) MEMBER(pl_pair, tangent)
                                              MEMBER(pl_pair, rolling) MEMBER(pl_pair, flags) };

static const char *table_of(plumb_entity_kind kind)
{
    switch (kind) {
    case PLUMB_KIND_BODY:
        return "bodies";
    case PLUMB_KIND_SHAPE:
        return "shapes";
    case PLUMB_KIND_MATERIAL:
        return "materials";
    case PLUMB_KIND_JOINT:
        return "joints";
    default:
        return "entities"; // of no table that is compared
    }
}

static void add_joint(comparison *c, const plumb_difference *who, uint32_t a, uint32_t b)
{
    uint32_t i = find_section(c, "world", "joints.items");
    const size_t stride = PL_SAVED_BYTES(pl_joint);
    add_members(c, who, data_of(&c->a, i) + a * stride, data_of(&c->b, i) + b * stride,
                joint_members, COUNT(joint_members));
}

static bool is_kind(const pl_slot *slot, plumb_entity_kind kind)
{
    return slot->state == PL_SLOT_LIVE && slot->kind == (uint32_t)kind;
}

static void add_slot(comparison *c, plumb_entity_kind kind, uint32_t index, const pl_slot *a,
                     const pl_slot *b)
{
    bool in_a = is_kind(a, kind), in_b = is_kind(b, kind);
    bool same = in_a && in_b && a->generation == b->generation;
    if (same) {
        plumb_difference who = thing((plumb_entity){ index, a->generation }, kind, table_of(kind));
        if (kind == PLUMB_KIND_JOINT) {
            add_joint(c, &who, a->row, b->row);
        } else if (kind != PLUMB_KIND_BARE) {
            const char *columns = kind == PLUMB_KIND_SHAPE ? "pieces" : who.table;
            add_columns(c, &who, columns, a->row, b->row);
        }
        return;
    }
    if (in_a) {
        plumb_difference who = thing((plumb_entity){ index, a->generation }, kind, table_of(kind));
        who.kind = PLUMB_ONLY_A;
        add(c, &who);
    }
    if (in_b) {
        plumb_difference who = thing((plumb_entity){ index, b->generation }, kind, table_of(kind));
        who.kind = PLUMB_ONLY_B;
        add(c, &who);
    }
}

static void add_kind(comparison *c, plumb_entity_kind kind)
{
    uint32_t section = pl_section_registry();
    uint32_t most =
        c->a.count[section] > c->b.count[section] ? c->a.count[section] : c->b.count[section];
    for (uint32_t i = 0; i < most; ++i) {
        pl_slot a = { 0 }, b = { 0 };
        if (i < c->a.count[section]) {
            memcpy(&a, data_of(&c->a, section) + i * sizeof a, sizeof a);
        }
        if (i < c->b.count[section]) {
            memcpy(&b, data_of(&c->b, section) + i * sizeof b, sizeof b);
        }
        add_slot(c, kind, i, &a, &b);
    }
}

//---- lists ---------------------------------------------------------------------------------------

static plumb_entity entity_at(const char *from)
{
    plumb_entity entity;
    memcpy(&entity, from, sizeof entity);
    return entity;
}

// Where in B's list the element with the key of A's stands: at `hint`, near it, or anywhere up to `most`.
static uint32_t find_key(const side *b, uint32_t i, size_t stride, const char *key, size_t bytes,
                         uint32_t hint, uint32_t most)
{
    for (uint32_t k = 0; k < b->count[i] && k < most; ++k) {
        uint32_t at = (hint + k) % b->count[i];
        if (memcmp(data_of(b, i) + at * stride, key, bytes) == 0) {
            return at;
        }
    }
    return UINT32_MAX;
}

// A list of which each element begins with the body that it is of.
typedef struct body_list {
    const char *section, *table;
    size_t stride;
    const pl_member *members;
    size_t member_count;
} body_list;

static void add_of_bodies(comparison *c, const body_list *list)
{
    uint32_t i = find_section(c, "world", list->section);
    size_t stride = list->stride;
    for (uint32_t k = 0; k < c->a.count[i]; ++k) {
        const char *a = data_of(&c->a, i) + k * stride;
        uint32_t at = find_key(&c->b, i, stride, a, sizeof(plumb_entity), k, UINT32_MAX);
        plumb_difference who = thing(entity_at(a), PLUMB_KIND_BODY, list->table);
        if (at != UINT32_MAX) {
            add_members(c, &who, a, data_of(&c->b, i) + at * stride, list->members,
                        list->member_count);
        } else {
            who.kind = PLUMB_ONLY_A;
            add(c, &who);
        }
    }
    for (uint32_t k = 0; k < c->b.count[i]; ++k) {
        const char *b = data_of(&c->b, i) + k * stride;
        if (find_key(&c->a, i, stride, b, sizeof(plumb_entity), k, UINT32_MAX) == UINT32_MAX) {
            plumb_difference who = thing(entity_at(b), PLUMB_KIND_BODY, list->table);
            who.kind = PLUMB_ONLY_B;
            add(c, &who);
        }
    }
}

static void add_contacts(comparison *c)
{
    uint32_t i = find_section(c, "world", "broad.pairs.items");
    uint32_t shapes = find_section(c, "pieces", "shape");
    uint32_t hint = 0;
    for (uint32_t k = 0; k < c->a.count[i]; ++k) {
        const char *a = data_of(&c->a, i) + k * sizeof(pl_pair);
        uint32_t at = find_key(&c->b, i, sizeof(pl_pair), a, 8, hint, SEARCH_MOST);
        if (at == UINT32_MAX) {
            continue; // which pairs are near is no news; what their contacts do is
        }
        pl_pair pa, pb;
        memcpy(&pa, a, sizeof pa);
        memcpy(&pb, data_of(&c->b, i) + at * sizeof pb, sizeof pb);
        pa.flags &= ~PL_PAIR_FACE_MASK;
        pb.flags &= ~PL_PAIR_FACE_MASK;
        hint = at + 1;
        if (pa.a < c->a.count[shapes] && pa.b < c->a.count[shapes]) {
            plumb_difference who =
                thing(entity_at(data_of(&c->a, shapes) + pa.a * sizeof(plumb_entity)),
                      PLUMB_KIND_SHAPE, "contacts");
            who.other = entity_at(data_of(&c->a, shapes) + pa.b * sizeof(plumb_entity));
            add_members(c, &who, (const char *)&pa, (const char *)&pb, pair_members,
                        COUNT(pair_members));
        }
    }
}

//---- components ----------------------------------------------------------------------------------

static void add_value(comparison *c, const pl_component *component, plumb_difference *who,
                      const char *a, const char *b)
{
    static const struct {
        pl_type type;
        uint32_t size;
    } types[] = { { PL_TYPE_FLOAT, 4 }, { PL_TYPE_DOUBLE, 8 }, { PL_TYPE_I32, 4 },
                  { PL_TYPE_U64, 8 },   { PL_TYPE_U32, 4 },    { PL_TYPE_U64, 8 },
                  { PL_TYPE_BOOL, 1 } };
    for (int k = 0; k < component->desc.field_count; ++k) {
        const plumb_field *field = &component->fields[k];
        char name[64];
        snprintf(name, sizeof name, "%.31s.%.31s", component->name, field->name);
        const pl_member m = { name, (uint32_t)field->offset, types[field->type].size,
                              types[field->type].type };
        add_member(c, who, a, b, &m);
    }
    if (component->desc.field_count == 0 && memcmp(a, b, component->desc.size) != 0) {
        snprintf(who->component, sizeof who->component, "%s", component->name);
        add(c, who);
    }
}

// Those that only one of the two has.
static void add_owners(comparison *c, const pl_component *component, uint32_t i, bool in_a)
{
    const side *has = in_a ? &c->a : &c->b, *lacks = in_a ? &c->b : &c->a;
    for (uint32_t k = 0; k < has->count[i]; ++k) {
        const char *owner = data_of(has, i) + k * sizeof(plumb_entity);
        if (find_key(lacks, i, sizeof(plumb_entity), owner, sizeof(plumb_entity), k, UINT32_MAX) ==
            UINT32_MAX) {
            plumb_difference who = thing(entity_at(owner), PLUMB_KIND_NONE, "components");
            snprintf(who.component, sizeof who.component, "%s", component->name);
            who.kind = in_a ? PLUMB_ONLY_A : PLUMB_ONLY_B;
            add(c, &who);
        }
    }
}

static void add_components(comparison *c)
{
    for (uint32_t i = pl_section_fixed_count(); i + 1 < c->sections; i += 2) {
        const pl_component *component =
            &c->layout->components.items[(i - pl_section_fixed_count()) / 2];
        size_t size = component->desc.size;
        for (uint32_t k = 0; k < c->a.count[i]; ++k) {
            const char *owner = data_of(&c->a, i + 1) + k * sizeof(plumb_entity);
            uint32_t at = find_key(&c->b, i + 1, sizeof(plumb_entity), owner, sizeof(plumb_entity),
                                   k, UINT32_MAX);
            if (at != UINT32_MAX) {
                plumb_difference who = thing(entity_at(owner), PLUMB_KIND_NONE, "components");
                add_value(c, component, &who, data_of(&c->a, i) + k * size,
                          data_of(&c->b, i) + at * size);
            }
        }
        add_owners(c, component, i + 1, true);
        add_owners(c, component, i + 1, false);
    }
}

//---- the world -----------------------------------------------------------------------------------

static void add_world(comparison *c)
{
    pl_member m;
    plumb_difference who = thing((plumb_entity){ 0 }, PLUMB_KIND_NONE, "world");
    for (uint32_t i = 0; pl_section_value(i, &m); ++i) {
        bool is_setting = strncmp(m.name, "desc.", 5) == 0 && strcmp(m.name, "desc.gravity") != 0;
        bool is_told = is_setting || strcmp(m.name, "gravity") == 0 ||
                       strcmp(m.name, "time") == 0 || strcmp(m.name, "commands.count") == 0;
        m.name += is_setting ? 5 : 0;
        if (is_told || c->second) {
            add_member(c, &who, data_of(&c->a, 0), data_of(&c->b, 0), &m);
        }
    }
}

// The rest, a row each.
static void add_rest(comparison *c)
{
    for (uint32_t i = 2; i < pl_section_fixed_count(); ++i) {
        pl_section section = pl_section_at(c->layout, i);
        size_t stride = section.stride;
        if (section.hashed == 0) {
            continue;
        }
        uint32_t least = c->a.count[i] < c->b.count[i] ? c->a.count[i] : c->b.count[i], k = 0;
        while (k < least && memcmp(data_of(&c->a, i) + k * stride, data_of(&c->b, i) + k * stride,
                                   section.hashed) == 0) {
            ++k;
        }
        if (k < c->a.count[i] || k < c->b.count[i]) {
            plumb_difference who = thing((plumb_entity){ 0 }, PLUMB_KIND_NONE, section.table);
            snprintf(who.component, sizeof who.component, "%.48s[%u]", section.name, (unsigned)k);
            add(c, &who);
        }
    }
}

static void compare(comparison *c)
{
    const body_list settings = { "settings.items", "settings", sizeof(pl_body_settings),
                                 settings_members, COUNT(settings_members) };
    const body_list targets = { "targets.items", "targets", sizeof(pl_target), target_members,
                                COUNT(target_members) };
    const body_list tracks = { "tracks.items", "tracks", sizeof(pl_track), track_members,
                               COUNT(track_members) };
    const body_list characters = { "characters.items", "characters", sizeof(pl_character),
                                   character_members, COUNT(character_members) };
    add_kind(c, PLUMB_KIND_BODY);
    add_of_bodies(c, &settings);
    add_of_bodies(c, &targets);
    add_of_bodies(c, &tracks);
    add_kind(c, PLUMB_KIND_SHAPE);
    add_kind(c, PLUMB_KIND_JOINT);
    add_of_bodies(c, &characters);
    add_kind(c, PLUMB_KIND_BARE);
    add_components(c);
    add_contacts(c);
    add_kind(c, PLUMB_KIND_MATERIAL);
    if (c->settings) {
        add_world(c);
    }
    if (c->second) {
        add_rest(c);
    }
}

int pl_compare_images(const plumb_world *layout, const pl_image *a, const pl_image *b,
                      bool settings, plumb_difference *rows, int capacity)
{
    comparison c = { .layout = layout,
                     .settings = settings,
                     .rows = rows,
                     .capacity = rows == NULL ? 0 : capacity };
    open_side(&c.a, a);
    open_side(&c.b, b);
    c.sections = c.a.sections < c.b.sections ? c.a.sections : c.b.sections;
    compare(&c);
    if (c.count == 0) {
        c.second = true;
        compare(&c);
    }
    return c.count;
}

//---- two worlds ----------------------------------------------------------------------------------

static bool keep(pl_memory *memory, const plumb_world *world, pl_buffer *buffer, pl_image *image)
{
    size_t size = plumb_world_snapshot_size(world);
    return pl_buffer_reserve(memory, buffer, size) && pl_image_write(world, buffer->data, size) &&
           pl_image_view(buffer->data, size, image);
}

plumb_result plumb_world_compare(const plumb_world *a, const plumb_world *b, plumb_difference *rows,
                                 int capacity, int *count)
{
    if (a == NULL || b == NULL) {
        return PLUMB_E_NULL;
    }
    PL_TRY(pl_check_unlocked(a, __func__));
    PL_TRY(pl_check_unlocked(b, __func__));
    PL_TRY(pl_check_pointer(a, __func__, "count", count));
    if (pl_section_user_schema(a) != pl_section_user_schema(b)) {
        return pl_fail(a, PLUMB_E_IMAGE, __func__,
                       "b has other components; register the same ones in the same order");
    }
    *count = 0;
    if (plumb_world_hash(a) == plumb_world_hash(b)) {
        return PLUMB_OK;
    }
    pl_memory memory;
    pl_buffer buffers[2] = { { 0 } };
    pl_image images[2];
    plumb_result r = PLUMB_OK;
    pl_memory_init(&memory, &a->desc.allocator);
    if (keep(&memory, a, &buffers[0], &images[0]) && keep(&memory, b, &buffers[1], &images[1])) {
        *count = pl_compare_images(a, &images[0], &images[1], true, rows, capacity);
    } else {
        r = pl_fail_memory(a, __func__);
    }
    pl_buffer_free(&memory, &buffers[0]);
    pl_buffer_free(&memory, &buffers[1]);
    return r;
}
