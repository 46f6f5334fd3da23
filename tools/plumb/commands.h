/// commands.h - the commands, one file each: cmd_<name>.c.
#ifndef PLUMB_COMMANDS_H
#define PLUMB_COMMANDS_H

#include "cli.h"

extern const cli_command cmd_run, cmd_render, cmd_check, cmd_explain, cmd_cost, cmd_convert,
    cmd_list, cmd_replay, cmd_diff;

#endif
