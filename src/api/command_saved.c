// command_saved.c - commands that are pending when a world is hashed or saved, and what strangers put in their place.
//
// Reads: the buffer; saved bytes, of which nothing is trusted. Writes: nothing, but for what is stripped. Cost: O(bytes).
#include "api/command.h"

#include "api/command_kept.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

// [B] of the payload that count for the hash: not the user's data at the end of a descriptor.
static size_t digested_bytes(const pl_command *r)
{
    switch (r->kind) {
    case PL_COMMAND_CREATE_BODY:
        return PL_KEPT_BODY - sizeof(void *);
    case PL_COMMAND_CREATE_SHAPE:
        return PL_KEPT_SHAPE - sizeof(void *);
    case PL_COMMAND_CUT:
    case PL_COMMAND_SHATTER:
        return pl_command_fracture_payload(r);
    default:
        return 0;
    }
}

void pl_commands_digest(const plumb_world *world, pl_digest *digest)
{
    const pl_commands *commands = &world->commands;
    for (size_t at = 0; at < commands->used;) {
        pl_command r;
        memcpy(&r, (const char *)commands->bytes.data + at, sizeof r);
        const char *payload = (const char *)commands->bytes.data + at + pl_kept_room(sizeof r);
        pl_digest_add(digest, &r, sizeof r);
        pl_digest_add(digest, payload, digested_bytes(&r));
        if (r.kind == PL_COMMAND_CREATE_SHAPE) {
            size_t points = pl_kept_room(PL_KEPT_SHAPE);
            pl_digest_add(digest, payload + points,
                          (size_t)r.bytes - pl_kept_room(sizeof r) - points);
        } else if (r.kind == PL_COMMAND_SET_COMPONENT && r.has_more) {
            pl_component_digest(&world->components.items[r.component.id - 1], payload, digest);
        }
        at += (size_t)r.bytes;
    }
}

void pl_commands_strip(char *bytes, size_t used)
{
    for (size_t at = 0; at < used;) {
        pl_command r;
        memcpy(&r, bytes + at, sizeof r);
        if (r.kind == PL_COMMAND_CREATE_BODY || r.kind == PL_COMMAND_CREATE_SHAPE) {
            memset(bytes + at + pl_kept_room(sizeof r) + digested_bytes(&r), 0, sizeof(void *));
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
    const plumb_body_desc desc = pl_kept_body(payload);
    return true BODY_BOOLS(IS_BOOL) && pl_body_check(NULL, "", &desc) == PLUMB_OK;
}

static bool is_shape(const pl_command *r, const char *payload, size_t bytes)
{
    const plumb_shape_desc desc = pl_kept_shape(payload);
    const size_t points = bytes - pl_kept_room(PL_KEPT_SHAPE);
    return true SHAPE_BOOLS(IS_BOOL) &&
           (r->has_more ? desc.count > 0 && (size_t)desc.count <= points / sizeof(plumb_vec2)
                        : desc.count >= 0);
}

static size_t least_payload(const plumb_world *world, const pl_command *r)
{
    switch (r->kind) {
    case PL_COMMAND_CREATE_BODY:
        return pl_kept_room(PL_KEPT_BODY);
    case PL_COMMAND_CREATE_SHAPE:
        return pl_kept_room(PL_KEPT_SHAPE);
    case PL_COMMAND_SET_COMPONENT:
        return r->has_more ? pl_kept_room(world->components.items[r->component.id - 1].desc.size)
                           : 0;
    case PL_COMMAND_CUT:
    case PL_COMMAND_SHATTER:
        return pl_kept_room(pl_command_fracture_payload(r));
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

// Who is gone, is of the kind, or is made by one command before.
static bool is_named(const pl_registry *registry, plumb_entity entity, uint32_t kind,
                     const uint32_t *marks)
{
    const pl_slot *pending = pl_registry_find_pending(registry, entity);
    const pl_slot *slot = pending != NULL ? pending : pl_registry_find(registry, entity);
    return (pending == NULL || marks[entity.index] == 1) &&
           (kind == PLUMB_KIND_NONE || slot == NULL || slot->kind == kind);
}

// Who is pending is made by one command, and named by later ones; who is teleported or cut is, or was, a body.
static bool has_target(const pl_registry *registry, const pl_command *r, uint32_t *marks)
{
    static const uint32_t made[] = { [PL_COMMAND_CREATE_BODY] = PLUMB_KIND_BODY,
                                     [PL_COMMAND_CREATE_SHAPE] = PLUMB_KIND_SHAPE,
                                     [PL_COMMAND_CREATE_ENTITY] = PLUMB_KIND_BARE };
    const pl_slot *pending = pl_registry_find_pending(registry, r->target);
    if (r->kind <= PL_COMMAND_CREATE_ENTITY) {
        return pending != NULL && pending->kind == made[r->kind] && marks[r->target.index]++ == 0;
    }
    const bool acts_on_body = r->kind == PL_COMMAND_TELEPORT || r->kind >= PL_COMMAND_CUT;
    return is_named(registry, r->target, acts_on_body ? PLUMB_KIND_BODY : PLUMB_KIND_NONE, marks) &&
           (r->kind != PL_COMMAND_MERGE ||
            is_named(registry, r->body.entity, PLUMB_KIND_BODY, marks));
}

static bool is_record(const plumb_world *world, const pl_command *r, const char *payload,
                      size_t bytes)
{
    const bool components =
        r->kind == PL_COMMAND_SET_COMPONENT || r->kind == PL_COMMAND_REMOVE_COMPONENT;
    if (r->kind > PL_COMMAND_SCALE || r->has_more > 1 ||
        (components && (r->component.id == 0 || r->component.id > world->components.count)) ||
        bytes < least_payload(world, r)) {
        return false;
    }
    switch (r->kind) {
    case PL_COMMAND_CREATE_BODY:
        return is_body(payload);
    case PL_COMMAND_CREATE_SHAPE:
        return is_shape(r, payload, bytes);
    case PL_COMMAND_SET_COMPONENT:
        return !r->has_more || is_value(&world->components.items[r->component.id - 1], payload);
    case PL_COMMAND_TELEPORT:
        return r->x >= -1e9 && r->x <= 1e9 && r->y >= -1e9 && r->y <= 1e9 &&
               fabs(r->angle) <= (double)PLUMB_REAL_MAX;
    case PL_COMMAND_CUT:
    case PL_COMMAND_SHATTER:
    case PL_COMMAND_MERGE:
    case PL_COMMAND_SCALE:
        return pl_command_fracture_is_sound(r, payload);
    default:
        return true;
    }
}

bool pl_commands_are_sound(const plumb_world *world, const pl_registry *registry, const char *bytes,
                           size_t used, uint32_t count, uint32_t *marks)
{
    const size_t head = pl_kept_room(sizeof(pl_command));
    uint32_t seen = 0;
    bool sound = true;
    for (size_t at = 0; sound && at < used; ++seen) {
        pl_command r;
        if (used - at < head) {
            sound = false;
            break;
        }
        memcpy(&r, bytes + at, sizeof r);
        sound = r.bytes >= head && r.bytes % PL_KEPT_ALIGN == 0 && r.bytes <= used - at &&
                is_record(world, &r, bytes + at + head, (size_t)r.bytes - head) &&
                has_target(registry, &r, marks);
        at += (size_t)r.bytes;
    }
    memset(marks, 0, registry->count * sizeof *marks);
    return sound && seen == count;
}
