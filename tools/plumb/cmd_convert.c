/// cmd_convert.c - `plumb convert`: a scene as canonical JSON.
///
/// Reads a scene (.lua or .json), writes JSON with sorted keys and shortest exact numbers: the
/// same scene gives the same bytes, so that two can be compared line by line.
#include "scene_args.h"

#include <string.h>

typedef struct convert_args {
    scene_args scene;
} convert_args;

static int convert_command(const cli_command *command, int argc, char **argv)
{
    convert_args args = { .scene = SCENE_ARGS_INIT };
    cli_operands operands;
    scene_run run;
    cli_output out;

    args.scene.time = 0; // as the scene begins, unless asked for later
    int code = cli_parse(command, argc, argv, &args, &operands);
    code = code == CLI_OK ? scene_args_check(command, &args.scene) : code;
    const char *target = operands.count > 1 ? operands.items[1] : NULL;
    if (code == CLI_OK && target != NULL && strcmp(target, "-") != 0) {
        size_t length = strlen(target);
        if (length < 5 || strcmp(target + length - 5, ".json") != 0) {
            cli_message("%s: '%.200s' does not end in .json, the only format that is written",
                        command->name, target);
            return CLI_USAGE;
        }
    }
    if (code == CLI_OK) {
        const cli_file files[] = { { "SCENE", operands.items[0], false },
                                   { "OUT.json", target, true } };
        code = cli_files_check(command, files, 2);
    }
    code = code == CLI_OK ? scene_run_open(&args.scene, operands.items[0], &run) : code;
    if (code != CLI_OK) {
        return code;
    }
    for (long long step = 0; code == CLI_OK && !scene_run_done(&run, step); step++) {
        code = scene_run_step(&run, NULL);
    }
    if (code == CLI_OK && cli_interrupted()) {
        code = CLI_FAILED; // between two steps: nothing is written, and nothing more is said
    }
    if (code == CLI_OK) {
        code = cli_output_open(&out, target);
    }
    if (code == CLI_OK) {
        bool written = run.engine->to_json(run.session, out.file);
        if (!written && cli_output_good(&out)) {
            cli_message("%s: out of memory", command->name);
            code = CLI_FAILED;
        }
        const char *lacks = run.engine->json_lacks(run.session);
        if (code == CLI_OK && lacks[0] != '\0' && !cli_interrupted()) {
            cli_message("%s: %s of '%s' have no JSON form and are left out", command->name, lacks,
                        operands.items[0]);
        }
        int closed = cli_output_close(&out, code == CLI_OK && !cli_interrupted());
        code = code == CLI_OK ? closed : code;
    }
    return scene_run_close(&run, code);
}

static const cli_option options[] = {
    SCENE_OPTION_PRECISION(convert_args, scene),
    SCENE_OPTION_SET(convert_args, scene),
    { "time", 't', CLI_REAL, offsetof(convert_args, scene.time), "S", 0, SCENE_TIME_MAX, NULL,
      "write the state after S seconds (default 0: as the scene begins)" },
};

const cli_command cmd_convert = {
    .name = "convert",
    .summary = "writes a scene as canonical JSON",
    .operands = "SCENE [OUT.json]",
    .text = "Loads SCENE (.lua or .json) and writes it as JSON, to stdout without a second name. "
            "Keys are sorted and numbers have as many digits as give the same number back, so "
            "that equal scenes are equal files. Handlers, closed forms and test functions of a Lua "
            "scene have no JSON form and are left out; a message tells of them.",
    .examples = "plumb convert stack.lua stack.json\n"
                "plumb convert stack.lua --time 2 | diff - after.json",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 2,
    .run = convert_command,
};
