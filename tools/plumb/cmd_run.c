/// cmd_run.c - `plumb run`: a scene in, a table of where everything was out.
///
/// Reads the scene, writes CSV or JSON lines. The same command writes the same bytes every time.
/// Cost: the simulation, and about 1 us a number.
#include "scene_args.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct run_args {
    scene_args scene;
    int format; ///< -1: by the extension of `output`
    const char *output;
    const char *every;
    const char *only; ///< name of the one body to print, NULL = all
} run_args;

enum { FORMAT_CSV, FORMAT_JSONL };

/// Rows are printed at step 0, then every `steps` steps or whenever `seconds` have gone by.
typedef struct sampling {
    long long steps;
    double seconds;
} sampling;

static bool ends_with(const char *text, const char *end)
{
    size_t a = strlen(text), b = strlen(end);
    return a >= b && strcmp(text + a - b, end) == 0;
}

/// Devices (/dev/stdout) and "-" have none and get CSV.
static bool has_extension(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    return dot != NULL && dot != name;
}

static int read_format(const cli_command *command, run_args *args)
{
    if (args->format >= 0) {
        return CLI_OK;
    }
    args->format = FORMAT_CSV;
    const char *path = args->output != NULL ? args->output : "";
    if (ends_with(path, ".jsonl") || ends_with(path, ".ndjson")) {
        args->format = FORMAT_JSONL;
    } else if (ends_with(path, ".json")) {
        cli_message("%s: option --output: JSON lines are named .jsonl; --format jsonl writes "
                    "them to '%.200s' all the same",
                    command->name, path);
        return CLI_USAGE;
    } else if (has_extension(path) && !ends_with(path, ".csv")) {
        cli_message(
            "%s: option --output: '%.200s' does not end in .csv, .jsonl or .ndjson; --format "
            "csv or --format jsonl writes to it all the same",
            command->name, path);
        return CLI_USAGE;
    }
    return CLI_OK;
}

/// "10": every tenth step, "0.5s": every half second.
static int read_every(const cli_command *command, const char *text, sampling *every)
{
    *every = (sampling){ .steps = 1 };
    if (text == NULL) {
        return CLI_OK;
    }
    char *end;
    double number = strtod(text, &end);
    bool is_time = strcmp(end, "s") == 0;
    bool is_steps = *end == '\0' && number == floor(number);
    if (end == text || !isfinite(number) || number <= 0 || number > 1e15 ||
        (!is_time && !is_steps)) {
        cli_message("%s: option --every: '%.60s' is neither a number of steps (10) nor a time "
                    "(0.5s)",
                    command->name, text);
        return CLI_USAGE;
    }
    *every =
        (sampling){ .steps = is_time ? 0 : (long long)number, .seconds = is_time ? number : 0 };
    return CLI_OK;
}

/// True when step `step` is to be printed.
static bool is_sample(const sampling *every, long long step, double dt)
{
    if (every->steps > 0) {
        return step % every->steps == 0;
    }
    // The first step at or after each multiple of `seconds`.
    double now = ((double)step * dt + 1e-9 * dt) / every->seconds;
    double before = ((double)(step - 1) * dt + 1e-9 * dt) / every->seconds;
    return step == 0 || floor(now) > floor(before);
}

static void print_header(FILE *file, int format)
{
    if (format == FORMAT_CSV) {
        fputs("time [s],name,x [m],y [m],angle [rad],vx [m/s],vy [m/s],w [rad/s]\n", file);
    }
}

static void print_row(FILE *file, int format, bool is_float, double time, const engine_row *row)
{
    static const char *const keys[] = { ",\"x\":",  ",\"y\":",  ",\"angle\":",
                                        ",\"vx\":", ",\"vy\":", ",\"w\":" };
    const double numbers[] = { row->x, row->y, row->angle, row->vx, row->vy, row->w };
    bool is_csv = format == FORMAT_CSV;

    // Twelve digits tell steps of a microsecond apart for eleven days and hide the roundings of
    // step * dt.
    fprintf(file, is_csv ? "%.12g," : "{\"time\":%.12g,\"name\":", time);
    if (is_csv) {
        cli_print_csv(file, row->name);
    } else {
        cli_print_json(file, row->name);
    }
    for (int i = 0; i < 6; i++) {
        fputs(is_csv ? "," : keys[i], file);
        cli_print_number(file, numbers[i], is_float);
    }
    fputs(is_csv ? "\n" : "}\n", file);
}

/// Prints all bodies. *begun tells whether anything has been printed: the header comes before the
/// first body, so that a name that no body ever has is told without any output. The body asked for
/// may be one that the scene's code makes later.
static int print_rows(const run_args *args, scene_run *run, FILE *file, bool *begun)
{
    double time = run->engine->time(run->session);
    const engine_row *rows;
    int count = run->engine->rows(run->session, &rows);
    if (count < 0) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    for (int i = 0; i < count; i++) {
        if (args->only == NULL || strcmp(args->only, rows[i].name) == 0) {
            if (!*begun) {
                print_header(file, args->format);
                *begun = true;
            }
            print_row(file, args->format, run->engine->is_float, time, &rows[i]);
        }
    }
    return CLI_OK;
}

static int simulate(const run_args *args, const sampling *every, scene_run *run, cli_output *out)
{
    progress bar;
    int code = CLI_OK;
    bool begun = args->only == NULL;

    progress_begin(&bar, run->info.name, (double)run->steps, args->scene.quiet);
    if (begun) {
        print_header(out->file, args->format);
    }
    for (long long step = 0; code == CLI_OK; step++) {
        if (is_sample(every, step, run->info.dt)) {
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
        code = scene_unknown_body(run, "body", args->only);
    }
    return code;
}

static int run_command(const cli_command *command, int argc, char **argv)
{
    run_args args = { .scene = SCENE_ARGS_INIT, .format = -1 };
    cli_operands operands;
    sampling every;
    scene_run run;
    cli_output out;

    int code = cli_parse(command, argc, argv, &args, &operands);
    code = code == CLI_OK ? scene_args_check(command, &args.scene) : code;
    code = code == CLI_OK ? read_format(command, &args) : code;
    code = code == CLI_OK ? read_every(command, args.every, &every) : code;
    code = code == CLI_OK ? scene_run_open(&args.scene, operands.items[0], &run) : code;
    if (code != CLI_OK) {
        return code;
    }
    code = cli_output_open(&out, args.output);
    if (code == CLI_OK) {
        code = simulate(&args, &every, &run, &out);
        // What a diverging run had computed before is what one needs to find out why.
        bool keep = (code == CLI_OK || code == CLI_DIVERGED) && !cli_interrupted();
        int closed = cli_output_close(&out, keep);
        code = code == CLI_OK ? closed : code;
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
                "plumb run slide.lua --set friction=0.3 --dt 1/240 --format jsonl",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 1,
    .run = run_command,
};
