// command.h - what becomes of the commands of a world: carried out, hashed, checked when a saved world has them.
#ifndef PL_API_COMMAND_H
#define PL_API_COMMAND_H

#include "core/digest.h"
#include "ecs/registry.h"
#include "plumb/ecs.h"
#include "world/command.h"

// What images hold: a new kind comes last.
typedef enum pl_command_kind {
    PL_COMMAND_CREATE_BODY,
    PL_COMMAND_CREATE_SHAPE,
    PL_COMMAND_CREATE_ENTITY,
    PL_COMMAND_DESTROY,
    PL_COMMAND_TELEPORT,
    PL_COMMAND_SET_COMPONENT,
    PL_COMMAND_REMOVE_COMPONENT,
    PL_COMMAND_CUT,
    PL_COMMAND_SHATTER,
    PL_COMMAND_MERGE,
    PL_COMMAND_SCALE
} pl_command_kind;

// The header of a record. Records are saved: the bytes of equal ones are equal, so they have no padding.
typedef struct pl_command {
    uint64_t bytes;      // header and payload, a multiple of 16
    plumb_entity target; // what it acts on; the reserved handle for creations
    plumb_body body;     // of a new shape; that becomes part of another
    double x, y,
        angle; // [m], [rad] of a teleport; [m] where a body is divided; x: [-] factor of its size
    plumb_component component;
    uint16_t kind;
    uint16_t has_more; // points of a shape, value of a component
} pl_command;

_Static_assert(sizeof(pl_command) == 8 * 6 + sizeof(plumb_component) + 2 * sizeof(uint16_t),
               "a record has padding");

void pl_commands_free(pl_memory *memory, pl_commands *commands);

// Carries out the commands that were pending when it began; those given meanwhile (by hooks) stay for
// the next time. On E_MEMORY the command that failed and those after it stay. A replay has what they did instead.
plumb_result pl_commands_run(plumb_world *world);

// Adds what is pending to the world hash: all but the user's data.
void pl_commands_digest(const plumb_world *world, pl_digest *digest);
// Whether saved records are some that a world with such a registry may have; components as in `world`.
// `marks`: one a slot of the registry, 0 before and after.
bool pl_commands_are_sound(const plumb_world *world, const pl_registry *registry, const char *bytes,
                           size_t used, uint32_t count, uint32_t *marks);
// Takes the user's data out of saved records.
void pl_commands_strip(char *bytes, size_t used);

//---- what files of commands share ----------------------------------------------------------------

// The function that gave it.
const char *pl_command_name(const pl_command *r);
// A body that lives, or that a command makes: it may live when this one is carried out.
plumb_result pl_command_check_body(const plumb_world *world, const char *fn, const char *field,
                                   plumb_body body);
// Appends a record with a copy of its payload [B].
plumb_result pl_command_give(plumb_world *world, const char *fn, pl_command r, const void *payload,
                             size_t bytes);
// It is not carried out, and its handle is released: a warning says why.
void pl_command_drop(plumb_world *world, const pl_command *r, const char *why);

//---- command_fracture.c --------------------------------------------------------------------------

// Of a body that is there. E_MEMORY: nothing has changed.
plumb_result pl_command_fracture_run(plumb_world *world, const pl_command *r, const char *payload);
// [B] that lie behind its header.
size_t pl_command_fracture_payload(const pl_command *r);
// Values that the call would take.
bool pl_command_fracture_is_sound(const pl_command *r, const char *payload);

#endif
