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

#include "api/command_kept.h"
#include "api/fracture.h"
#include "world/check.h"
#include "world/destroy.h"
#include "world/observer.h"
#include "world/rows.h"
#include "world/told.h"

#include <string.h>

// For the messages.
static const char *const command_names[] = {
    [PL_COMMAND_CREATE_BODY] = "plumb_command_body_create",
    [PL_COMMAND_CREATE_SHAPE] = "plumb_command_shape_create",
    [PL_COMMAND_CREATE_ENTITY] = "plumb_command_entity_create",
    [PL_COMMAND_DESTROY] = "plumb_command_destroy",
    [PL_COMMAND_TELEPORT] = "plumb_command_teleport",
    [PL_COMMAND_SET_COMPONENT] = "plumb_command_component_set",
    [PL_COMMAND_REMOVE_COMPONENT] = "plumb_command_component_remove",
    [PL_COMMAND_CUT] = "plumb_command_body_cut",
    [PL_COMMAND_SHATTER] = "plumb_command_body_shatter",
    [PL_COMMAND_MERGE] = "plumb_command_body_merge",
    [PL_COMMAND_SCALE] = "plumb_command_body_scale",
};

const char *pl_command_name(const pl_command *r)
{
    return command_names[r->kind];
}

// Member after member.
#define PUT(path)                                                                                  \
    memcpy(to, &desc->path, sizeof desc->path);                                                    \
    to += sizeof desc->path;

static void put_body(char *to, const plumb_body_desc *desc)
{
    PL_BODY_DESC(PUT)
}

static void put_shape(char *to, const plumb_shape_desc *desc)
{
    PL_SHAPE_DESC(PUT)
}

static char *payload_of(const plumb_world *world, size_t at)
{
    return (char *)world->commands.bytes.data + at + pl_kept_room(sizeof(pl_command));
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
    size_t bytes = pl_kept_room(sizeof(pl_command)) + pl_kept_room(payload);
    return (!claims || pl_registry_reserve(&world->memory, &world->registry, 1)) &&
           pl_buffer_reserve(&world->memory, &world->commands.bytes, world->commands.used + bytes);
}

// Appends a record (room must be reserved); returns its payload, which is 0.
static char *append(plumb_world *world, pl_command r, size_t payload)
{
    size_t at = world->commands.used;
    r.bytes = pl_kept_room(sizeof(pl_command)) + pl_kept_room(payload);
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

plumb_result pl_command_check_body(const plumb_world *world, const char *fn, const char *field,
                                   plumb_body body)
{
    const pl_slot *slot = find_expected(world, body.entity);
    return slot != NULL && slot->kind == PLUMB_KIND_BODY
               ? PLUMB_OK
               : pl_fail_handle(world, fn, field, body.entity,
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
    if (!reserve_record(world, PL_KEPT_BODY, true)) {
        pl_fail_memory(world, __func__);
        return body;
    }
    body.entity = reserve_handle(world, PLUMB_KIND_BODY);
    put_body(append(world, (pl_command){ .kind = PL_COMMAND_CREATE_BODY, .target = body.entity },
                    PL_KEPT_BODY),
             desc);
    return body;
}

plumb_shape plumb_command_shape_create(plumb_world *world, plumb_body body,
                                       const plumb_shape_desc *desc)
{
    plumb_shape shape = PLUMB_NULL_INIT;
    pl_made made;
    if (world == NULL || pl_command_check_body(world, __func__, "body", body) != PLUMB_OK ||
        pl_shape_make(world, __func__, desc, &made) != PLUMB_OK) {
        return shape;
    }
    size_t points = desc->points == NULL ? 0 : (size_t)desc->count * sizeof(plumb_vec2);
    size_t payload = pl_kept_room(PL_KEPT_SHAPE) + points;
    if (!reserve_record(world, payload, true)) {
        pl_fail_memory(world, __func__);
        return shape;
    }
    shape.entity = reserve_handle(world, PLUMB_KIND_SHAPE);
    pl_command r = { .kind = PL_COMMAND_CREATE_SHAPE,
                     .target = shape.entity,
                     .body = body,
                     .has_more = points > 0 };
    char *at = append(world, r, payload);
    put_shape(at, desc);
    if (points > 0) {
        memcpy(at + pl_kept_room(PL_KEPT_SHAPE), desc->points, points);
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
    append(world, (pl_command){ .kind = PL_COMMAND_CREATE_ENTITY, .target = entity }, 0);
    return entity;
}

plumb_result pl_command_give(plumb_world *world, const char *fn, pl_command r, const void *payload,
                             size_t bytes)
{
    if (!reserve_record(world, bytes, false)) {
        return pl_fail_memory(world, fn);
    }
    char *to = append(world, r, bytes);
    if (bytes > 0) {
        memcpy(to, payload, bytes);
    }
    return PLUMB_OK;
}

plumb_result plumb_command_destroy(plumb_world *world, plumb_entity entity)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(check_expected(world, __func__, entity));
    uint32_t material = pl_material_row(world, (plumb_material){ entity });
    PL_TRY(material != PL_NONE ? pl_check_unused(world, __func__, material) : PLUMB_OK);
    return pl_command_give(world, __func__,
                           (pl_command){ .kind = PL_COMMAND_DESTROY, .target = entity }, NULL, 0);
}

plumb_result plumb_command_teleport(plumb_world *world, plumb_body body, plumb_vec2 position,
                                    plumb_real angle)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_command_check_body(world, __func__, "body", body));
    PL_TRY(pl_place_check(world, __func__, position, angle));
    pl_command to = { .kind = PL_COMMAND_TELEPORT,
                      .target = body.entity,
                      .x = (double)position.x,
                      .y = (double)position.y,
                      .angle = (double)angle };
    return pl_command_give(world, __func__, to, NULL, 0);
}

plumb_result plumb_command_component_set(plumb_world *world, plumb_entity entity,
                                         plumb_component component, const void *value)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(check_expected(world, __func__, entity));
    PL_TRY(check_component(world, __func__, component));
    pl_command set = { .kind = PL_COMMAND_SET_COMPONENT,
                       .target = entity,
                       .component = component,
                       .has_more = value != NULL };
    size_t bytes = value == NULL ? 0 : world->components.items[component.id - 1].desc.size;
    return pl_command_give(world, __func__, set, value, bytes);
}

plumb_result plumb_command_component_remove(plumb_world *world, plumb_entity entity,
                                            plumb_component component)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(check_expected(world, __func__, entity));
    PL_TRY(check_component(world, __func__, component));
    pl_command remove = { .kind = PL_COMMAND_REMOVE_COMPONENT,
                          .target = entity,
                          .component = component };
    return pl_command_give(world, __func__, remove, NULL, 0);
}

//---- carrying out --------------------------------------------------------------------------------

// Dropped commands are no errors: the world went on while they waited.
void pl_command_drop(plumb_world *world, const pl_command *r, const char *why)
{
    pl_warn(world, "%s: dropped for entity %u:%u; %s", pl_command_name(r),
            (unsigned)r->target.index, (unsigned)r->target.generation, why);
    if (pl_registry_find_pending(&world->registry, r->target) != NULL) {
        pl_registry_release(&world->registry, r->target);
    }
}

static plumb_result run_body(plumb_world *world, pl_command *r, const char *payload)
{
    const plumb_body_desc desc = pl_kept_body(payload);
    plumb_body body = { r->target };
    return pl_body_insert(world, pl_command_name(r), &desc, &body);
}

static plumb_result run_shape(plumb_world *world, pl_command *r, const char *payload)
{
    uint32_t row = pl_body_row(world, r->body);
    if (row == PL_NONE) {
        pl_command_drop(world, r, "its body is gone");
        return PLUMB_OK;
    }
    plumb_shape_desc desc = pl_kept_shape(payload);
    if (r->has_more) {
        desc.points = (const plumb_vec2 *)(const void *)(payload + pl_kept_room(PL_KEPT_SHAPE));
    }
    pl_made made;
    const char *fn = pl_command_name(r);
    plumb_result result = pl_shape_make(world, fn, &desc, &made);
    if (result == PLUMB_OK) {
        plumb_shape shape = { r->target };
        result = pl_shape_insert(world, fn, row, &desc, &made, &shape);
    }
    if (result != PLUMB_OK && result != PLUMB_E_MEMORY) {
        pl_command_drop(world, r, "its material is gone or the body's mass leaves its range");
        return PLUMB_OK;
    }
    return result;
}

static plumb_result run_destroy(plumb_world *world, const pl_command *r)
{
    uint32_t material = pl_material_row(world, (plumb_material){ r->target });
    if (material != PL_NONE && world->materials.users[material] > 0) {
        pl_command_drop(world, r, "the material is in use by now");
    } else {
        pl_destroy_entity(world, r->target);
    }
    return PLUMB_OK;
}

static plumb_result run_on_live(plumb_world *world, const pl_command *r, const char *payload)
{
    if (pl_registry_find(&world->registry, r->target) == NULL) {
        pl_command_drop(world, r, "it is gone");
        return PLUMB_OK;
    }
    switch (r->kind) {
    case PL_COMMAND_DESTROY:
        return run_destroy(world, r);
    case PL_COMMAND_TELEPORT:
        pl_body_move_to(world, pl_command_name(r), pl_body_row(world, (plumb_body){ r->target }),
                        plumb_v2((plumb_real)r->x, (plumb_real)r->y), (plumb_real)r->angle);
        return PLUMB_OK;
    case PL_COMMAND_CUT:
    case PL_COMMAND_SHATTER:
    case PL_COMMAND_MERGE:
    case PL_COMMAND_SCALE:
        return pl_command_fracture_run(world, r, payload);
    case PL_COMMAND_SET_COMPONENT:
        return pl_component_put(world, r->target, r->component, r->has_more ? payload : NULL)
                   ? PLUMB_OK
                   : pl_fail_memory(world, pl_command_name(r));
    default:
        if (!pl_component_drop(world, r->target, r->component)) {
            pl_command_drop(world, r, "it does not have the component");
        }
        return PLUMB_OK;
    }
}

static plumb_result run_record(plumb_world *world, pl_command *r, const char *payload)
{
    switch (r->kind) {
    case PL_COMMAND_CREATE_BODY:
        return run_body(world, r, payload);
    case PL_COMMAND_CREATE_SHAPE:
        return run_shape(world, r, payload);
    case PL_COMMAND_CREATE_ENTITY:
        pl_entity_claim(world, r->target, PLUMB_KIND_BARE, PL_NONE);
        return PLUMB_OK;
    default:
        return run_on_live(world, r, payload);
    }
}

plumb_result pl_commands_run(plumb_world *world)
{
    pl_breaks_begin(world);
    if (world->observer != NULL && world->observer->replays) {
        return PLUMB_OK;
    }
    pl_commands *commands = &world->commands;
    size_t end = commands->used; // what hooks append meanwhile is for the next time
    size_t at = 0;
    plumb_result result = PLUMB_OK;
    while (at < end) {
        pl_command r;
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

plumb_result plumb_commands_apply(plumb_world *world)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    return pl_commands_run(world);
}
