// command.c - the command buffer: structural changes asked for while the world is locked.
//
// A record is a header, then its payload: the descriptor and the points it names, or a component's
// value. Everything a direct call would refuse is refused when the command is given, except what
// only time can tell: whether its body, entity and material are still there when it is carried out.
// A handle that a create command returns is reserved in the registry, and released again if the
// command is dropped.
//
// Reads, writes: the buffer, then whatever the commands change. Cost: O(1) to give, as the direct
// call to carry out; shapes are made twice, once to be checked.
#include "api/command.h"

#include "world/check.h"
#include "world/desc_list.h"
#include "world/destroy.h"
#include "world/observer.h"
#include "world/rows.h"
#include "world/told.h"

#include <string.h>

#define RECORD_ALIGN 16u // of records and payloads: enough for any descriptor

typedef enum command_kind {
    CREATE_BODY,
    CREATE_SHAPE,
    CREATE_ENTITY,
    DESTROY,
    TELEPORT,
    SET_COMPONENT,
    REMOVE_COMPONENT
} command_kind;

// For the messages.
static const char *const command_names[] = {
    [CREATE_BODY] = "plumb_command_body_create",
    [CREATE_SHAPE] = "plumb_command_shape_create",
    [CREATE_ENTITY] = "plumb_command_entity_create",
    [DESTROY] = "plumb_command_destroy",
    [TELEPORT] = "plumb_command_teleport",
    [SET_COMPONENT] = "plumb_command_component_set",
    [REMOVE_COMPONENT] = "plumb_command_component_remove",
};

// Records are saved: the bytes of equal ones are equal, so they have no padding.
typedef struct record {
    uint64_t bytes;      // header and payload, a multiple of RECORD_ALIGN
    plumb_entity target; // what it acts on; the reserved handle for creations
    plumb_body body;     // of a new shape
    double x, y, angle;  // [m], [rad] of a teleport
    plumb_component component;
    uint16_t kind;
    uint16_t has_more; // points of a shape, value of a component
} record;

_Static_assert(sizeof(record) == 8 * 6 + sizeof(plumb_component) + 2 * sizeof(uint16_t),
               "a record has padding");

// Descriptors as they are kept: member after member.
#define BODY_SIZE(path)  +sizeof(((plumb_body_desc *)0)->path)
#define SHAPE_SIZE(path) +sizeof(((plumb_shape_desc *)0)->path)
#define BODY_BYTES       (0 PL_BODY_DESC(BODY_SIZE))
#define SHAPE_BYTES      (0 PL_SHAPE_DESC(SHAPE_SIZE))

#define PUT(path)                                                                                  \
    memcpy(to, &desc->path, sizeof desc->path);                                                    \
    to += sizeof desc->path;
#define GET(path)                                                                                  \
    memcpy(&desc.path, from, sizeof desc.path);                                                    \
    from += sizeof desc.path;

static void put_body(char *to, const plumb_body_desc *desc)
{
    PL_BODY_DESC(PUT)
}

static plumb_body_desc get_body(const char *from)
{
    plumb_body_desc desc = { 0 };
    PL_BODY_DESC(GET)
    return desc;
}

static void put_shape(char *to, const plumb_shape_desc *desc)
{
    PL_SHAPE_DESC(PUT)
}

static plumb_shape_desc get_shape(const char *from)
{
    plumb_shape_desc desc = { 0 };
    PL_SHAPE_DESC(GET)
    return desc;
}

static size_t rounded(size_t bytes)
{
    return (bytes + (RECORD_ALIGN - 1)) & ~(size_t)(RECORD_ALIGN - 1);
}

static char *payload_of(const plumb_world *world, size_t at)
{
    return (char *)world->commands.bytes.data + at + rounded(sizeof(record));
}

void pl_commands_free(pl_memory *memory, pl_commands *commands)
{
    pl_buffer_free(memory, &commands->bytes);
    *commands = (pl_commands){ 0 };
}

//---- giving --------------------------------------------------------------------------------------

// Makes room for a record and, with `claims`, for the handle that it reserves.
static bool reserve_record(plumb_world *world, size_t payload, bool claims)
{
    size_t bytes = rounded(sizeof(record)) + rounded(payload);
    return (!claims || pl_registry_reserve(&world->memory, &world->registry, 1)) &&
           pl_buffer_reserve(&world->memory, &world->commands.bytes, world->commands.used + bytes);
}

// Appends a record (room must be reserved); returns its payload, which is 0.
static char *append(plumb_world *world, record r, size_t payload)
{
    size_t at = world->commands.used;
    r.bytes = rounded(sizeof(record)) + rounded(payload);
    memset((char *)world->commands.bytes.data + at, 0, (size_t)r.bytes);
    memcpy((char *)world->commands.bytes.data + at, &r, sizeof r);
    world->commands.used += (size_t)r.bytes;
    ++world->commands.count;
    return payload_of(world, at);
}

// Alive, or reserved by a command: it may be alive by the time this one is carried out.
static const pl_slot *find_expected(const plumb_world *world, plumb_entity entity)
{
    const pl_slot *slot = pl_registry_find(&world->registry, entity);
    return slot != NULL ? slot : pl_registry_find_pending(&world->registry, entity);
}

static plumb_result check_expected(const plumb_world *world, const char *fn, plumb_entity entity)
{
    return find_expected(world, entity) != NULL
               ? PLUMB_OK
               : pl_fail_handle(world, fn, "entity", entity,
                                "an entity or one that a command makes");
}

static plumb_result check_expected_body(const plumb_world *world, const char *fn, plumb_body body)
{
    const pl_slot *slot = find_expected(world, body.entity);
    return slot != NULL && slot->kind == PLUMB_KIND_BODY
               ? PLUMB_OK
               : pl_fail_handle(world, fn, "body", body.entity,
                                "a body or one that a command makes");
}

static plumb_result check_component(const plumb_world *world, const char *fn,
                                    plumb_component component)
{
    if (component.id != 0 && component.id <= world->components.count) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_HANDLE, fn, "component is %u; it must be a registered component",
                   (unsigned)component.id);
}

static plumb_entity reserve_handle(plumb_world *world, plumb_entity_kind kind)
{
    return pl_registry_acquire(&world->registry, (uint32_t)kind, PL_NONE, PL_SLOT_PENDING);
}

plumb_body plumb_command_body_create(plumb_world *world, const plumb_body_desc *desc)
{
    plumb_body body = PLUMB_NULL_INIT;
    if (world == NULL || pl_body_check(world, __func__, desc) != PLUMB_OK) {
        return body;
    }
    if (!reserve_record(world, BODY_BYTES, true)) {
        pl_fail_memory(world, __func__);
        return body;
    }
    body.entity = reserve_handle(world, PLUMB_KIND_BODY);
    put_body(append(world, (record){ .kind = CREATE_BODY, .target = body.entity }, BODY_BYTES),
             desc);
    return body;
}

plumb_shape plumb_command_shape_create(plumb_world *world, plumb_body body,
                                       const plumb_shape_desc *desc)
{
    plumb_shape shape = PLUMB_NULL_INIT;
    pl_made made;
    if (world == NULL || check_expected_body(world, __func__, body) != PLUMB_OK ||
        pl_shape_make(world, __func__, desc, &made) != PLUMB_OK) {
        return shape;
    }
    size_t points = desc->points == NULL ? 0 : (size_t)desc->count * sizeof(plumb_vec2);
    size_t payload = rounded(SHAPE_BYTES) + points;
    if (!reserve_record(world, payload, true)) {
        pl_fail_memory(world, __func__);
        return shape;
    }
    shape.entity = reserve_handle(world, PLUMB_KIND_SHAPE);
    record r = {
        .kind = CREATE_SHAPE, .target = shape.entity, .body = body, .has_more = points > 0
    };
    char *at = append(world, r, payload);
    put_shape(at, desc);
    if (points > 0) {
        memcpy(at + rounded(SHAPE_BYTES), desc->points, points);
    }
    return shape;
}

plumb_entity plumb_command_entity_create(plumb_world *world)
{
    plumb_entity entity = PLUMB_NULL_ENTITY_INIT;
    if (world == NULL) {
        return entity;
    }
    if (!reserve_record(world, 0, true)) {
        pl_fail_memory(world, __func__);
        return entity;
    }
    entity = reserve_handle(world, PLUMB_KIND_BARE);
    append(world, (record){ .kind = CREATE_ENTITY, .target = entity }, 0);
    return entity;
}

static plumb_result give(plumb_world *world, const char *fn, record r, const void *value,
                         size_t bytes)
{
    if (!reserve_record(world, bytes, false)) {
        return pl_fail_memory(world, fn);
    }
    char *payload = append(world, r, bytes);
    if (bytes > 0) {
        memcpy(payload, value, bytes);
    }
    return PLUMB_OK;
}

plumb_result plumb_command_destroy(plumb_world *world, plumb_entity entity)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(check_expected(world, __func__, entity));
    uint32_t material = pl_material_row(world, (plumb_material){ entity });
    PL_TRY(material != PL_NONE ? pl_check_unused(world, __func__, material) : PLUMB_OK);
    return give(world, __func__, (record){ .kind = DESTROY, .target = entity }, NULL, 0);
}

plumb_result plumb_command_teleport(plumb_world *world, plumb_body body, plumb_vec2 position,
                                    plumb_real angle)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(check_expected_body(world, __func__, body));
    PL_TRY(pl_place_check(world, __func__, position, angle));
    record to = { .kind = TELEPORT,
                  .target = body.entity,
                  .x = (double)position.x,
                  .y = (double)position.y,
                  .angle = (double)angle };
    return give(world, __func__, to, NULL, 0);
}

plumb_result plumb_command_component_set(plumb_world *world, plumb_entity entity,
                                         plumb_component component, const void *value)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(check_expected(world, __func__, entity));
    PL_TRY(check_component(world, __func__, component));
    record set = {
        .kind = SET_COMPONENT, .target = entity, .component = component, .has_more = value != NULL
    };
    size_t bytes = value == NULL ? 0 : world->components.items[component.id - 1].desc.size;
    return give(world, __func__, set, value, bytes);
}

plumb_result plumb_command_component_remove(plumb_world *world, plumb_entity entity,
                                            plumb_component component)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(check_expected(world, __func__, entity));
    PL_TRY(check_component(world, __func__, component));
    record remove = { .kind = REMOVE_COMPONENT, .target = entity, .component = component };
    return give(world, __func__, remove, NULL, 0);
}

//---- carrying out --------------------------------------------------------------------------------

// Dropped commands are no errors: the world went on while they waited.
static void drop(plumb_world *world, const record *r, const char *why)
{
    pl_warn(world, "%s: dropped for entity %u:%u; %s", command_names[r->kind],
            (unsigned)r->target.index, (unsigned)r->target.generation, why);
    if (pl_registry_find_pending(&world->registry, r->target) != NULL) {
        pl_registry_release(&world->registry, r->target);
    }
}

static plumb_result run_body(plumb_world *world, record *r, const char *payload)
{
    const plumb_body_desc desc = get_body(payload);
    plumb_body body = { r->target };
    return pl_body_insert(world, command_names[r->kind], &desc, &body);
}

static plumb_result run_shape(plumb_world *world, record *r, const char *payload)
{
    uint32_t row = pl_body_row(world, r->body);
    if (row == PL_NONE) {
        drop(world, r, "its body is gone");
        return PLUMB_OK;
    }
    plumb_shape_desc desc = get_shape(payload);
    if (r->has_more) {
        desc.points = (const plumb_vec2 *)(const void *)(payload + rounded(SHAPE_BYTES));
    }
    pl_made made;
    const char *fn = command_names[r->kind];
    plumb_result result = pl_shape_make(world, fn, &desc, &made);
    if (result == PLUMB_OK) {
        plumb_shape shape = { r->target };
        result = pl_shape_insert(world, fn, row, &desc, &made, &shape);
    }
    if (result != PLUMB_OK && result != PLUMB_E_MEMORY) {
        drop(world, r, "its material is gone or the body's mass leaves its range");
        return PLUMB_OK;
    }
    return result;
}

static plumb_result run_destroy(plumb_world *world, const record *r)
{
    uint32_t material = pl_material_row(world, (plumb_material){ r->target });
    if (material != PL_NONE && world->materials.users[material] > 0) {
        drop(world, r, "the material is in use by now");
    } else {
        pl_destroy_entity(world, r->target);
    }
    return PLUMB_OK;
}

static plumb_result run_on_live(plumb_world *world, const record *r, const char *payload)
{
    if (pl_registry_find(&world->registry, r->target) == NULL) {
        drop(world, r, "it is gone");
        return PLUMB_OK;
    }
    switch (r->kind) {
    case DESTROY:
        return run_destroy(world, r);
    case TELEPORT:
        pl_body_place(world, pl_body_row(world, (plumb_body){ r->target }),
                      plumb_v2((plumb_real)r->x, (plumb_real)r->y), (plumb_real)r->angle);
        pl_told(world, r->target, command_names[r->kind]);
        return PLUMB_OK;
    case SET_COMPONENT:
        return pl_component_put(world, r->target, r->component, r->has_more ? payload : NULL)
                   ? PLUMB_OK
                   : pl_fail_memory(world, command_names[r->kind]);
    default:
        if (!pl_component_drop(world, r->target, r->component)) {
            drop(world, r, "it does not have the component");
        }
        return PLUMB_OK;
    }
}

static plumb_result run_record(plumb_world *world, record *r, const char *payload)
{
    switch (r->kind) {
    case CREATE_BODY:
        return run_body(world, r, payload);
    case CREATE_SHAPE:
        return run_shape(world, r, payload);
    case CREATE_ENTITY:
        pl_entity_claim(world, r->target, PLUMB_KIND_BARE, PL_NONE);
        return PLUMB_OK;
    default:
        return run_on_live(world, r, payload);
    }
}

plumb_result pl_commands_run(plumb_world *world)
{
    if (world->observer != NULL && world->observer->replays) {
        return PLUMB_OK;
    }
    pl_commands *commands = &world->commands;
    size_t end = commands->used; // what hooks append meanwhile is for the next time
    size_t at = 0;
    plumb_result result = PLUMB_OK;
    while (at < end) {
        record r;
        memcpy(&r, (const char *)commands->bytes.data + at, sizeof r);
        result = run_record(world, &r, payload_of(world, at));
        if (result != PLUMB_OK) {
            break;
        }
        at += (size_t)r.bytes;
        --commands->count;
    }
    if (at > 0) {
        commands->used -= at;
        memmove(commands->bytes.data, (const char *)commands->bytes.data + at, commands->used);
    }
    return result;
}

//---- saved ---------------------------------------------------------------------------------------

// [B] of the payload that count for the hash: not the user's data at the end of a descriptor.
static size_t digested_bytes(const record *r)
{
    switch (r->kind) {
    case CREATE_BODY:
        return BODY_BYTES - sizeof(void *);
    case CREATE_SHAPE:
        return SHAPE_BYTES - sizeof(void *);
    default:
        return 0;
    }
}

void pl_commands_digest(const plumb_world *world, pl_digest *digest)
{
    const pl_commands *commands = &world->commands;
    for (size_t at = 0; at < commands->used;) {
        record r;
        memcpy(&r, (const char *)commands->bytes.data + at, sizeof r);
        const char *payload = payload_of(world, at);
        pl_digest_add(digest, &r, sizeof r);
        pl_digest_add(digest, payload, digested_bytes(&r));
        if (r.kind == CREATE_SHAPE) {
            size_t points = rounded(SHAPE_BYTES);
            pl_digest_add(digest, payload + points, (size_t)r.bytes - rounded(sizeof r) - points);
        } else if (r.kind == SET_COMPONENT && r.has_more) {
            pl_component_digest(&world->components.items[r.component.id - 1], payload, digest);
        }
        at += (size_t)r.bytes;
    }
}

void pl_commands_strip(char *bytes, size_t used)
{
    for (size_t at = 0; at < used;) {
        record r;
        memcpy(&r, bytes + at, sizeof r);
        const size_t behind = digested_bytes(&r);
        if (behind > 0) {
            memset(bytes + at + rounded(sizeof r) + behind, 0, sizeof(void *));
        }
        at += (size_t)r.bytes;
    }
}

// Bytes that are read as bool.
#define IS_BOOL(path) &&*(const unsigned char *)(const void *)&desc.path <= 1
#define BODY_BOOLS(X)                                                                              \
    X(no_gravity)                                                                                  \
    X(fixed_rotation) X(no_sleep) X(asleep) X(continuous) X(lock_x) X(lock_y) X(disabled)
#define SHAPE_BOOLS(X) X(closed) X(filter.nothing) X(sensor)

// A descriptor that the call itself would take, whatever else is in the world.
static bool is_body(const char *payload)
{
    const plumb_body_desc desc = get_body(payload);
    return true BODY_BOOLS(IS_BOOL) && pl_body_check(NULL, "", &desc) == PLUMB_OK;
}

static bool is_shape(const record *r, const char *payload, size_t bytes)
{
    const plumb_shape_desc desc = get_shape(payload);
    const size_t points = bytes - rounded(SHAPE_BYTES);
    return true SHAPE_BOOLS(IS_BOOL) &&
           (r->has_more ? desc.count > 0 && (size_t)desc.count <= points / sizeof(plumb_vec2)
                        : desc.count >= 0);
}

static size_t least_payload(const plumb_world *world, const record *r)
{
    switch (r->kind) {
    case CREATE_BODY:
        return rounded(BODY_BYTES);
    case CREATE_SHAPE:
        return rounded(SHAPE_BYTES);
    case SET_COMPONENT:
        return r->has_more ? rounded(world->components.items[r->component.id - 1].desc.size) : 0;
    default:
        return 0;
    }
}

// Fields that are read as bool hold one.
static bool is_value(const pl_component *c, const char *payload)
{
    for (int k = 0; k < c->desc.field_count; ++k) {
        if (c->fields[k].type == PLUMB_FIELD_BOOL &&
            ((const unsigned char *)payload)[c->fields[k].offset] > 1) {
            return false;
        }
    }
    return true;
}

// Who is pending is made by one command, and named by later ones; who is teleported is, or was, a body.
static bool has_target(const pl_registry *registry, const record *r, uint32_t *marks)
{
    static const uint32_t made[] = { [CREATE_BODY] = PLUMB_KIND_BODY,
                                     [CREATE_SHAPE] = PLUMB_KIND_SHAPE,
                                     [CREATE_ENTITY] = PLUMB_KIND_BARE };
    const pl_slot *pending = pl_registry_find_pending(registry, r->target);
    if (r->kind <= CREATE_ENTITY) {
        return pending != NULL && pending->kind == made[r->kind] && marks[r->target.index]++ == 0;
    }
    const pl_slot *slot = pending != NULL ? pending : pl_registry_find(registry, r->target);
    return (pending == NULL || marks[r->target.index] == 1) &&
           (r->kind != TELEPORT || slot == NULL || slot->kind == PLUMB_KIND_BODY);
}

static bool is_record(const plumb_world *world, const record *r, const char *payload, size_t bytes)
{
    const bool components = r->kind == SET_COMPONENT || r->kind == REMOVE_COMPONENT;
    if (r->kind > REMOVE_COMPONENT || r->has_more > 1 ||
        (components && (r->component.id == 0 || r->component.id > world->components.count)) ||
        bytes < least_payload(world, r)) {
        return false;
    }
    switch (r->kind) {
    case CREATE_BODY:
        return is_body(payload);
    case CREATE_SHAPE:
        return is_shape(r, payload, bytes);
    case SET_COMPONENT:
        return !r->has_more || is_value(&world->components.items[r->component.id - 1], payload);
    case TELEPORT:
        return r->x >= -1e9 && r->x <= 1e9 && r->y >= -1e9 && r->y <= 1e9 &&
               r->angle - r->angle == 0;
    default:
        return true;
    }
}

bool pl_commands_are_sound(const plumb_world *world, const pl_registry *registry, const char *bytes,
                           size_t used, uint32_t count, uint32_t *marks)
{
    const size_t head = rounded(sizeof(record));
    uint32_t seen = 0;
    bool sound = true;
    for (size_t at = 0; sound && at < used; ++seen) {
        record r;
        if (used - at < head) {
            sound = false;
            break;
        }
        memcpy(&r, bytes + at, sizeof r);
        sound = r.bytes >= head && r.bytes % RECORD_ALIGN == 0 && r.bytes <= used - at &&
                is_record(world, &r, bytes + at + head, (size_t)r.bytes - head) &&
                has_target(registry, &r, marks);
        at += (size_t)r.bytes;
    }
    memset(marks, 0, registry->count * sizeof *marks);
    return sound && seen == count;
}

plumb_result plumb_commands_apply(plumb_world *world)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    return pl_commands_run(world);
}
