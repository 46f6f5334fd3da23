// error.c - refused calls: the record, the log line, and the checks that every entry point shares.
//
// Reads: arguments, handles. Writes: world->error, which is bookkeeping and not state, and
// therefore is written through const worlds too. Cost: O(1); nothing is formatted unless a call is
// refused.
#include "world/rows.h"
#include "ecs/component.h"
#include "world/check.h"
#include "world/state.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void tell(const plumb_world *world, plumb_log_level level, const char *message)
{
    if (world->desc.log != NULL) {
        world->desc.log(world->desc.hook_context, level, message);
    }
}

plumb_result pl_fail(const plumb_world *world, plumb_result code, const char *function,
                     const char *format, ...)
{
    if (world == NULL) {
        return code;
    }
    plumb_world *record = (plumb_world *)world;
    char *text = record->error_text;
    size_t size = sizeof record->error_text;
    int used = snprintf(text, size, "%s: ", function);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - (size_t)used, format, arguments);
    va_end(arguments);
    record->error = (plumb_error){ code, function, text };
    tell(world, PLUMB_LOG_ERROR, text);
    return code;
}

void pl_warn(const plumb_world *world, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    tell(world, PLUMB_LOG_WARN, text);
}

plumb_error plumb_world_error(const plumb_world *world)
{
    if (world == NULL || world->error.function == NULL) {
        return (plumb_error){ PLUMB_OK, "", "" };
    }
    return world->error;
}

void plumb_world_clear_error(plumb_world *world)
{
    if (world != NULL) {
        world->error = (plumb_error){ PLUMB_OK, NULL, NULL };
    }
}

void plumb_log_stderr(void *context, plumb_log_level level, const char *message)
{
    static const char *const levels[] = { "error", "warning", "info" };
    (void)context;
    fprintf(stderr, "plumb %s: %s\n", levels[(unsigned)level <= PLUMB_LOG_INFO ? level : 0],
            message);
}

//---- locking -------------------------------------------------------------------------------------

// What to call instead while the world is locked. Others: wait until the step is over.
static const char *const remedies[][2] = {
    { "plumb_body_create", "plumb_command_body_create" },
    { "plumb_body_destroy", "plumb_command_destroy" },
    { "plumb_body_teleport", "plumb_command_teleport" },
    { "plumb_body_cut", "plumb_command_body_cut" },
    { "plumb_body_shatter", "plumb_command_body_shatter" },
    { "plumb_body_merge", "plumb_command_body_merge" },
    { "plumb_body_scale", "plumb_command_body_scale" },
    { "plumb_shape_create", "plumb_command_shape_create" },
    { "plumb_shape_destroy", "plumb_command_destroy" },
    { "plumb_joint_destroy", "plumb_command_destroy" },
    { "plumb_material_destroy", "plumb_command_destroy" },
    { "plumb_entity_create", "plumb_command_entity_create" },
    { "plumb_entity_destroy", "plumb_command_destroy" },
    { "plumb_component_set", "plumb_command_component_set" },
    { "plumb_component_remove", "plumb_command_component_remove" },
};

plumb_result pl_check_unlocked(const plumb_world *world, const char *function)
{
    if (world == NULL || world->locked_by == NULL) {
        return world == NULL ? PLUMB_E_NULL : PLUMB_OK;
    }
    const char *remedy = "call it between steps";
    char use[64];
    for (size_t i = 0; i < sizeof remedies / sizeof remedies[0]; ++i) {
        if (strcmp(remedies[i][0], function) == 0) {
            snprintf(use, sizeof use, "use %s", remedies[i][1]);
            remedy = use;
        }
    }
    const char *form = world->in_hook ? "a hook of component '%s' runs; %s"
                                      : "the world is stepping (system '%s'); %s";
    char text[192];
    snprintf(text, sizeof text, form, world->locked_by, remedy);
    return pl_fail(world, PLUMB_E_LOCKED, function, "%s", text);
}

//---- values --------------------------------------------------------------------------------------

// "nan" whatever its sign bit, which printf would show.
static double shown(plumb_real value)
{
    return value == value ? (double)value : (double)NAN;
}

plumb_result pl_check_finite(const plumb_world *world, const char *function, const char *field,
                             plumb_real value)
{
    if (plumb_is_finite(value)) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_NOT_FINITE, function, "%s is %g; it must be finite", field,
                   shown(value));
}

plumb_result pl_check_finite_vec(const plumb_world *world, const char *function, const char *field,
                                 plumb_vec2 value)
{
    if (plumb_vec2_is_finite(value)) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_NOT_FINITE, function, "%s is (%g, %g); it must be finite", field,
                   shown(value.x), shown(value.y));
}

plumb_result pl_check_range(const plumb_world *world, const char *function, const char *field,
                            plumb_real value, plumb_real low, plumb_real high)
{
    PL_TRY(pl_check_finite(world, function, field, value));
    if (value >= low && value <= high) {
        return PLUMB_OK;
    }
    if (high >= PLUMB_REAL_MAX) {
        return pl_fail(world, PLUMB_E_RANGE, function, "%s is %g; it must be at least %g", field,
                       shown(value), (double)low);
    }
    return pl_fail(world, PLUMB_E_RANGE, function, "%s is %g; it must be %g to %g", field,
                   shown(value), (double)low, (double)high);
}

plumb_result pl_check_within(const plumb_world *world, const char *function, const char *field,
                             plumb_vec2 value, plumb_real limit)
{
    PL_TRY(pl_check_finite_vec(world, function, field, value));
    if (plumb_abs(value.x) <= limit && plumb_abs(value.y) <= limit) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_RANGE, function,
                   "%s is (%g, %g); each component must be %g to %g", field, shown(value.x),
                   shown(value.y), -(double)limit, (double)limit);
}

plumb_result pl_check_pointer(const plumb_world *world, const char *function, const char *field,
                              const void *pointer)
{
    if (pointer != NULL) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_NULL, function, "%s is null; it must be given", field);
}

plumb_result pl_check_name(const plumb_world *world, const char *function, const char *field,
                           const char *name)
{
    PL_TRY(pl_check_pointer(world, function, field, name));
    if (name[0] == '\0') {
        return pl_fail(world, PLUMB_E_RANGE, function,
                       "%s is empty; it must have 1 to 63 characters", field);
    }
    if (memchr(name, '\0', PL_NAME_MAX) == NULL) {
        return pl_fail(world, PLUMB_E_RANGE, function,
                       "%s is '%.16s...'; it must have 1 to 63 characters", field, name);
    }
    return PLUMB_OK;
}

//---- handles -------------------------------------------------------------------------------------

const char *pl_kind_name(uint32_t kind)
{
    static const char *const names[] = { "nothing",  "bare entity", "body", "shape",
                                         "material", "joint",       "law",  "soft body" };
    _Static_assert(sizeof names / sizeof names[0] == PLUMB_KIND_SOFTBODY + 1, "a name a kind");
    return kind <= PLUMB_KIND_SOFTBODY ? names[kind] : NULL;
}

plumb_result pl_fail_handle(const plumb_world *world, const char *function, const char *field,
                            plumb_entity entity, const char *wanted)
{
    PL_TRY(pl_check_world(world));
    char is[64];
    const pl_slot *slot = pl_registry_find(&world->registry, entity);
    if (plumb_is_null(entity)) {
        snprintf(is, sizeof is, "null");
    } else if (slot != NULL) {
        snprintf(is, sizeof is, "a %s", pl_kind_name(slot->kind));
    } else if (pl_registry_find_pending(&world->registry, entity) != NULL) {
        snprintf(is, sizeof is, "not yet made by its command");
    } else {
        snprintf(is, sizeof is, "stale (%u:%u)", (unsigned)entity.index,
                 (unsigned)entity.generation);
    }
    return pl_fail(world, PLUMB_E_HANDLE, function, "%s is %s; it must be %s", field, is, wanted);
}

plumb_result pl_fail_memory(const plumb_world *world, const char *function)
{
    return pl_fail(world, PLUMB_E_MEMORY, function, "the allocator returned no memory");
}

plumb_result pl_check_body(const plumb_world *world, const char *function, plumb_body body,
                           uint32_t *row)
{
    *row = pl_body_row(world, body);
    return *row != PL_NONE ? PLUMB_OK
                           : pl_fail_handle(world, function, "body", body.entity, "a live body");
}

uint32_t pl_ask_body(const plumb_world *world, const char *function, plumb_body body)
{
    uint32_t row;
    pl_check_body(world, function, body, &row);
    return row;
}

plumb_result pl_check_shape(const plumb_world *world, const char *function, plumb_shape shape,
                            uint32_t *piece)
{
    *piece = pl_shape_piece(world, shape);
    return *piece != PL_NONE
               ? PLUMB_OK
               : pl_fail_handle(world, function, "shape", shape.entity, "a live shape");
}

uint32_t pl_ask_shape(const plumb_world *world, const char *function, plumb_shape shape)
{
    uint32_t piece;
    pl_check_shape(world, function, shape, &piece);
    return piece;
}

plumb_result pl_check_material(const plumb_world *world, const char *function,
                               plumb_material material, uint32_t *row)
{
    PL_TRY(pl_check_world(world));
    *row = plumb_is_null(material) ? 0 : pl_material_row(world, material);
    return *row != PL_NONE ? PLUMB_OK
                           : pl_fail_handle(world, function, "material", material.entity,
                                            "a live material or null");
}

plumb_result pl_check_entity(const plumb_world *world, const char *function, plumb_entity entity)
{
    PL_TRY(pl_check_world(world));
    return pl_registry_find(&world->registry, entity) != NULL
               ? PLUMB_OK
               : pl_fail_handle(world, function, "entity", entity, "a live entity");
}

plumb_result pl_place_check(const plumb_world *world, const char *fn, plumb_vec2 position,
                            plumb_real angle)
{
    PL_TRY(pl_check_within(world, fn, "position", position, (real)1e9));
    return pl_check_finite(world, fn, "angle", angle);
}
