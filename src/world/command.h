// command.h - the command buffer: structural changes recorded in order, applied at the start of a step
// (api/command.h).
#ifndef PL_COMMAND_H
#define PL_COMMAND_H

#include "core/memory.h"

typedef struct pl_commands {
    pl_buffer bytes; // records, one after another, each 16-byte aligned, payload copied in
    size_t used;
    uint32_t count;
} pl_commands;

#endif
