/// cmd_diff.c - `plumb diff`: where two recordings differ first.
///
/// Reads both, replays them side by side, writes a few lines.
#include "recording.h"
#include "scene_args.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct diff_args {
    bool brief;
    double from; ///< step to begin with
} diff_args;

#define STEP_MAX 9007199254740992.0

static void print_change(const engine_change *c)
{
    bool values = c->from[0] != '\0' || c->to[0] != '\0';
    printf("%s: %s%s%s%s%s\n", c->who, c->what, values ? " " : "", c->from, values ? " | " : "",
           c->to);
}

/// Settings in which the two differ at their heads.
static int print_settings(recording *a, recording *b)
{
    const engine_change *list;
    int count = a->engine->replay_settings(a->replay, b->replay, &list);
    for (int i = 0; i < count; i++) {
        printf("setting: ");
        print_change(&list[i]);
    }
    if (count < 0) {
        cli_message("out of memory");
    }
    return count < 0 ? CLI_FAILED : CLI_OK;
}

static int print_difference(const engine_difference *d)
{
    if (d->step == 0) {
        printf("differ at the head, %.12g s", d->time[0]);
    } else {
        bool from_there = strcmp(d->pass, "head") == 0; // --from
        printf("differ %s step %llu, %.12g s", from_there ? "already behind" : "after", d->step,
               d->time[0]);
    }
    if (d->time[0] != d->time[1]) {
        printf(" | %.12g s", d->time[1]);
    }
    if (d->pass[0] == '\0') {
        printf("; one of them is of another build, which gives other bits here");
    } else if (strcmp(d->pass, "edits") == 0) {
        printf(", in what was done before it");
    } else if (strcmp(d->pass, "head") != 0) {
        printf(", in pass '%s'", d->pass);
    }
    printf("\n");
    if (d->pass[0] != '\0' || d->seen > 0) {
        if (d->pass[0] == '\0') {
            printf("at the keyframe behind step %llu, ", d->seen);
        }
        printf("first: ");
        print_change(&d->first);
    }
    return CLI_DIFFERS;
}

static int compare(const diff_args *args, recording *a, recording *b)
{
    engine_error error = { 0 };
    engine_difference difference;
    engine_replay_info at[2] = { a->engine->replay_info(a->replay),
                                 b->engine->replay_info(b->replay) };
    if (args->from > (double)at[0].steps || args->from > (double)at[1].steps) {
        cli_message("diff: option --from: %.0f is beyond the last step, %llu", args->from,
                    at[0].steps < at[1].steps ? at[0].steps : at[1].steps);
        return CLI_USAGE;
    }
    int code = args->brief ? CLI_OK : print_settings(a, b);
    if (code != CLI_OK) {
        return code;
    }
    code = a->engine->replay_seek(a->replay, (unsigned long long)args->from, &error);
    code = code != CLI_OK
               ? code
               : b->engine->replay_seek(b->replay, (unsigned long long)args->from, &error);
    code = code != CLI_OK ? code
                          : a->engine->replay_compare(a->replay, b->replay, &difference, &error);
    if (code != CLI_OK) {
        return scene_report(&error);
    }
    if (difference.found) {
        return args->brief ? CLI_DIFFERS : print_difference(&difference);
    }
    if (at[0].steps != at[1].steps) {
        if (!args->brief) {
            printf("the same for %llu steps; then only one goes on: %llu | %llu steps\n",
                   at[0].steps < at[1].steps ? at[0].steps : at[1].steps, at[0].steps, at[1].steps);
        }
        return CLI_DIFFERS;
    }
    if (!args->brief) {
        printf("the same for %llu steps\n", at[0].steps);
    }
    return CLI_OK;
}

static int diff_command(const cli_command *command, int argc, char **argv)
{
    diff_args args = { .from = 0 };
    cli_operands operands;
    recording a, b;

    int code = cli_parse(command, argc, argv, &args, &operands);
    if (code == CLI_OK && args.from != floor(args.from)) {
        cli_message("%s: option --from: %.10g is not a whole number", command->name, args.from);
        return CLI_USAGE;
    }
    code = code == CLI_OK ? recording_open(operands.items[0], 0, false, &a) : code;
    if (code != CLI_OK) {
        return code;
    }
    code = recording_open(operands.items[1], 0, false, &b);
    if (code != CLI_OK) {
        recording_close(&a);
        return code;
    }
    if (a.engine != b.engine) {
        cli_message(
            "%s: '%s' was recorded in %s precision, '%s' in %s; nothing in them is the same",
            command->name, operands.items[0], a.engine->precision, operands.items[1],
            b.engine->precision);
        code = CLI_FAILED;
    } else {
        code = compare(&args, &a, &b);
    }
    recording_close(&a);
    recording_close(&b);
    return code;
}

static const cli_option options[] = {
    { "brief", 'b', CLI_FLAG, offsetof(diff_args, brief), NULL, 0, 0, NULL,
      "print nothing: the exit code tells" },
    { "from", 0, CLI_REAL, offsetof(diff_args, from), "N", 0, STEP_MAX, NULL,
      "begin behind step N (default 0, the heads)" },
};

const cli_command cmd_diff = {
    .name = "diff",
    .summary = "finds where two recordings differ first: step, pass, entity, component",
    .operands = "RECORDING RECORDING",
    .text =
        "Replays two recordings side by side. Prints the settings in which they differ; then the "
        "first step after which the worlds are not the same in the bit, the pass of that step "
        "that made it so, and the first entity and component with both values. Exit code 0: "
        "the same steps; 6: they differ, or one does not replay to the bits it holds.",
    .examples = "plumb run stack.lua --record a.rec -o /dev/null\n"
                "plumb run stack.lua --substeps 8 --record b.rec -o /dev/null\n"
                "plumb diff a.rec b.rec",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 2,
    .operand_max = 2,
    .run = diff_command,
};
