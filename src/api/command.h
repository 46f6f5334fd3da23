// command.h - what becomes of the commands of a world: carried out, hashed, checked when a saved world has them.
#ifndef PL_API_COMMAND_H
#define PL_API_COMMAND_H

#include "core/digest.h"
#include "ecs/registry.h"
#include "plumb/ecs.h"
#include "world/command.h"

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

#endif
