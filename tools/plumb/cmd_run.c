/// cmd_run.c - `plumb run`: a scene in, a table of where everything was out.
///
/// Reads the scene, writes CSV or JSON lines. The same command writes the same bytes every time.
/// Cost: the simulation, and about 1 us a number.
#include "scene_args.h"
#include "table.h"

#include <string.h>

typedef struct run_args {
    scene_args scene;
    int format; ///< -1: by the extension of `output`
    const char *output;
    const char *every;
    const char *only; ///< name of the one body to print, NULL = all
    const char *record;
    int keyframes; ///< [steps] 0: the library's default
} run_args;

/// Prints all bodies. *begun tells whether anything has been printed: the header comes before the
/// first body, so that a name that no body ever has is told without any output. The body asked for
/// may be one that the scene's code makes later.
static int print_rows(const run_args *args, scene_run *run, FILE *file, bool *begun)
{
    double time = run->engine->time(run->stage);
    const engine_row *rows;
    int count = run->engine->rows(run->stage, &rows);
    if (count < 0) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    for (int i = 0; i < count; i++) {
        if (args->only == NULL || strcmp(args->only, rows[i].name) == 0) {
            if (!*begun) {
                table_print_header(file, args->format);
                *begun = true;
            }
            table_print_row(file, args->format, run->engine->is_float, time, &rows[i]);
        }
    }
    return CLI_OK;
}

static int simulate(const run_args *args, const table_sampling *every, scene_run *run,
                    cli_output *out)
{
    progress bar;
    int code = CLI_OK;
    bool begun = args->only == NULL;

    progress_begin(&bar, run->info.name, (double)run->steps, args->scene.quiet);
    if (begun) {
        table_print_header(out->file, args->format);
    }
    for (long long step = 0; code == CLI_OK; step++) {
        if (table_is_sample(every, step, run->info.dt)) {
            code = print_rows(args, run, out->file, &begun);
        }
        if (code != CLI_OK || !cli_output_good(out) || scene_run_done(run, step)) {
            break;
        }
        progress_update(&bar, (double)step);
        code = scene_run_step(run, &bar);
    }
    progress_end(&bar);
    if (code == CLI_OK && !begun && !cli_interrupted()) {
        const engine_scenery of = { run->engine, run->stage, run->info };
        code = scene_unknown_body(&of, "body", args->only);
    }
    return code;
}

/// A run that fails or is stopped leaves its recording, as far as it went: that tells why.
static int record_and_simulate(const run_args *args, const table_sampling *every, scene_run *run,
                               cli_output *out)
{
    cli_output recording;
    engine_error error = { 0 };
    if (args->record == NULL) {
        return simulate(args, every, run, out);
    }
    int code = cli_output_open(&recording, args->record);
    if (code != CLI_OK) {
        return code;
    }
    cli_output_keep_beginning(&recording);
    code = run->engine->record(run->session, recording.file, args->keyframes, &error);
    if (code != CLI_OK) {
        recording.reason = error.reason;
        return cli_output_close(&recording, false) != CLI_OK ? CLI_FAILED : scene_report(&error);
    }
    code = simulate(args, every, run, out);
    int ended = run->engine->record_end(run->session, &error);
    recording.reason = error.reason;
    int closed = cli_output_close(&recording, true);
    if (closed == CLI_OK && ended != CLI_OK) {
        closed = scene_report(&error);
    }
    return code == CLI_OK ? closed : code;
}

static int check_record(const cli_command *command, const run_args *args)
{
    if (args->record != NULL && strcmp(args->record, "-") == 0) {
        cli_message("%s: option --record: a recording goes to a file, not to stdout",
                    command->name);
        return CLI_USAGE;
    }
    if (args->keyframes > 0 && args->record == NULL) {
        cli_message("%s: option --keyframes: needs --record", command->name);
        return CLI_USAGE;
    }
    return CLI_OK;
}

static int run_command(const cli_command *command, int argc, char **argv)
{
    run_args args = { .scene = SCENE_ARGS_INIT, .format = -1 };
    cli_operands operands;
    table_sampling every;
    scene_run run;
    cli_output out;

    int code = cli_parse(command, argc, argv, &args, &operands);
    code = code == CLI_OK ? scene_args_check(command, &args.scene) : code;
    code = code == CLI_OK ? table_read_format(command, args.output, &args.format) : code;
    code = code == CLI_OK ? table_read_every(command, args.every, &every) : code;
    code = code == CLI_OK ? check_record(command, &args) : code;
    const cli_file files[] = { { "SCENE", code == CLI_OK ? operands.items[0] : NULL, false },
                               { "--output", args.output != NULL ? args.output : "-", true },
                               { "--record", args.record, true } };
    code = code == CLI_OK ? cli_files_check(command, files, 3) : code;
    code = code == CLI_OK ? scene_run_open(&args.scene, operands.items[0], &run) : code;
    if (code != CLI_OK) {
        return code;
    }
    scene_run_warn(&run, operands.items[0]);
    code = cli_output_open(&out, args.output);
    if (code == CLI_OK) {
        code = record_and_simulate(&args, &every, &run, &out);
        // What a diverging run had computed before is what one needs to find out why.
        bool keep = (code == CLI_OK || code == CLI_DIVERGED) && !cli_interrupted();
        int closed = cli_output_close(&out, keep);
        code = code == CLI_OK ? closed : code;
    }
    char text[512];
    if (code == CLI_OK && scene_run_accuracy(&run, text, sizeof text)) {
        cli_message("%s", text);
    }
    return scene_run_close(&run, code);
}

static const cli_option options[] = {
    { "output", 'o', CLI_TEXT, offsetof(run_args, output), "FILE", 0, 0, NULL,
      "write to FILE, which appears when complete; .csv or .jsonl (default: CSV to stdout)" },
    { "format", 0, CLI_CHOICE, offsetof(run_args, format), "NAME", 0, 0, "csv,jsonl",
      "csv or jsonl, whatever FILE is called" },
    { "every", 0, CLI_TEXT, offsetof(run_args, every), "N", 0, 0, NULL,
      "print every N steps, or every so many seconds: 0.5s (default 1)" },
    { "body", 0, CLI_TEXT, offsetof(run_args, only), "NAME", 0, 0, NULL,
      "print only the body of that name" },
    { "record", 0, CLI_TEXT, offsetof(run_args, record), "FILE", 0, 0, NULL,
      "write the run to FILE as well, for `plumb replay` and `plumb diff`" },
    { "keyframes", 0, CLI_INT, offsetof(run_args, keyframes), "N", 1, 1000000, NULL,
      "in the recording, keep all of the world every N steps, to seek by (default 120)" },
    SCENE_OPTIONS(run_args, scene),
    SCENE_OPTION_QUIET(run_args, scene),
};

const cli_command cmd_run = {
    .name = "run",
    .summary = "simulates a scene and prints where every body is at every step",
    .operands = "SCENE",
    .text = "Simulates SCENE (.lua or .json) and prints a line for every body and step: time [s], "
            "name, x, y [m] of the body's origin, angle [rad], vx, vy [m/s] of its centre of mass, "
            "w [rad/s]. Numbers have as many digits as give the same number back when read, and "
            "the same command prints the same bytes every time.",
    .examples = "plumb run assets/scenes/stack.lua --every 0.5s\n"
                "plumb run pong.lua --time 60 --body ball -o ball.csv\n"
                "plumb run stack.lua --record stack.rec -o /dev/null\n"
                "plumb run slide.lua --set friction=0.3 --dt 1/240 --format jsonl",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 1,
    .run = run_command,
};
