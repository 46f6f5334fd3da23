/// cmd_replay.c - `plumb replay`: a recording in, a table of where everything was, what was done, or
/// pictures out.
///
/// Reads the recording, writes CSV, JSON lines or text, or lets film.c draw. Each step is verified against what was recorded.
#include "film.h"
#include "recording.h"
#include "scene_args.h"
#include "table.h"

#include <math.h>
#include <string.h>

typedef struct replay_args {
    int format; ///< -1: by the extension of `output`
    const char *output;
    const char *every;
    const char *only; ///< name of the one body to print, NULL = all
    double seek;      ///< [s] < 0: not given
    double step;      ///< < 0: not given
    bool list, info;
    film_args film;   ///< pictures instead, if `film.output` is given
    scene_args scene; ///< `quiet` alone
    int width;
} replay_args;

/// 2^53: steps are counted in doubles by the option.
#define STEP_MAX 9007199254740992.0

static int print_rows(const replay_args *args, recording *r, FILE *file, bool *found)
{
    const engine_row *rows;
    double time = r->engine->replay_info(r->replay).time;
    engine_stage *stage = r->engine->replay_stage(r->replay);
    int count = stage != NULL ? r->engine->rows(stage, &rows) : -1;
    for (int i = 0; i < count; i++) {
        if (args->only == NULL || strcmp(args->only, rows[i].name) == 0) {
            table_print_row(file, args->format, r->engine->is_float, time, &rows[i]);
            *found = true;
        }
    }
    if (count < 0) {
        cli_message("out of memory");
    }
    return count < 0 ? CLI_FAILED : CLI_OK;
}

/// A line for the step, and one for each change that the user made in it.
static int print_step(recording *r, FILE *file)
{
    const engine_change *changes;
    engine_replay_info info = r->engine->replay_info(r->replay);
    int count = r->engine->replay_edits(r->replay, &changes);
    fprintf(file, "step %llu  time %.12g s  dt %.9g s  hash %016llx\n", info.step, info.time,
            info.dt, info.hash);
    for (int i = 0; i < count; i++) {
        const engine_change *c = &changes[i];
        bool values = c->from[0] != '\0' || c->to[0] != '\0';
        fprintf(file, "  %s: %s: %s%s%s%s%s\n", c->when, c->who, c->what, values ? " " : "",
                c->from, values ? " -> " : "", c->to);
    }
    if (count < 0) {
        cli_message("out of memory");
    }
    return count < 0 ? CLI_FAILED : CLI_OK;
}

static void print_info(const recording *r, FILE *file)
{
    engine_replay_info info = r->engine->replay_info(r->replay);
    fprintf(file,
            "title      %s\nprecision  %s\nsteps      %llu, after %llu that are not recorded\n"
            "time       %.12g s to %.12g s\nedited     %llu steps\nkeyframes  %llu\n"
            "bytes      %llu\ncomplete   %s\n",
            info.title, r->engine->precision, info.steps, info.first, info.start, info.end,
            info.edited, info.keyframes, info.bytes,
            info.complete ? "yes" : "no: it breaks off after its last step");
}

static int tell_unknown(const replay_args *args, recording *r)
{
    engine_stage *stage = r->engine->replay_stage(r->replay);
    if (stage == NULL) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    const engine_scenery of = { r->engine, stage, r->engine->info(stage) };
    return scene_unknown_body(&of, "body", args->only);
}

/// From `first` to `last` step.
static int play(const replay_args *args, const table_sampling *every, recording *r,
                unsigned long long first, unsigned long long last, FILE *file)
{
    progress bar;
    engine_error error = { 0 };
    engine_replay_info info = r->engine->replay_info(r->replay);
    double start = info.start, dt = 0;
    bool found = false;
    progress_begin(&bar, info.title, (double)last + 1, args->scene.quiet);
    if (!args->list) {
        table_print_header(file, args->format);
    }
    int code = CLI_OK;
    for (unsigned long long step = first; code == CLI_OK && step <= last; step++) {
        code = r->engine->replay_seek(r->replay, step, &error);
        if (code != CLI_OK) {
            progress_end(&bar);
            code = scene_report(&error);
            break;
        }
        info = r->engine->replay_info(r->replay);
        dt = info.step > 0 ? (info.time - start) / (double)info.step : 0;
        if (first == last || table_is_sample(every, (long long)step, dt)) {
            code = args->list ? print_step(r, file) : print_rows(args, r, file, &found);
        }
        if (cli_interrupted() || ferror(file)) {
            break;
        }
        progress_update(&bar, (double)step);
    }
    progress_end(&bar);
    if (code == CLI_OK && !found && args->only != NULL && !args->list && !cli_interrupted()) {
        code = tell_unknown(args, r);
    }
    return code;
}

// -------------------------------------------------------------------------------------- pictures

/// [s] Half a mean step: sums of float steps are a little off the times that people ask for.
static double half_step(const recording *r)
{
    engine_replay_info info = r->engine->replay_info(r->replay);
    return info.steps > 0 ? (info.end - info.start) / (double)info.steps / 2 : 0;
}

static long long find(const film_source *source, double time)
{
    const recording *r = source->context;
    return (long long)r->engine->replay_find(r->replay, time + half_step(r));
}

static int go(film_source *source, long long to, progress *bar)
{
    const recording *r = source->context;
    engine_error error = { 0 };
    int code = r->engine->replay_seek(r->replay, (unsigned long long)to, &error);
    if (code == CLI_OK) {
        engine_stage *stage = r->engine->replay_stage(r->replay);
        if (stage != NULL) {
            source->seen.stage = stage;
            source->step = to;
            return CLI_OK;
        }
        error = (engine_error){ .code = CLI_FAILED, .text = "out of memory" };
    }
    progress_end(bar);
    return scene_report(&error);
}

/// The moment that the scene chose for its picture, if it was recorded; else `last`.
static unsigned long long chosen_step(const recording *r, unsigned long long last)
{
    engine_replay_info info = r->engine->replay_info(r->replay);
    engine_stage *stage = r->engine->replay_stage(r->replay);
    double at = stage != NULL ? r->engine->info(stage).camera.at : -1;
    bool recorded = at >= info.start && at <= info.end;
    return recorded ? r->engine->replay_find(r->replay, at + half_step(r)) : last;
}

/// The picture of step `at`, or a film.
static int render(const replay_args *args, recording *r, unsigned long long at)
{
    engine_replay_info info = r->engine->replay_info(r->replay);
    engine_error error = { 0 };
    double from = args->film.from >= 0 ? args->film.from : info.start;
    film_source source = { .start = info.start,
                           .end = info.end,
                           .verb = "replaying",
                           .quiet = args->scene.quiet,
                           .context = r,
                           .go = go,
                           .find = find };
    bool is_film = film_is_film(args->film.output);
    if (!is_film && args->seek < 0 && args->step < 0) {
        at = chosen_step(r, at);
    }
    source.step = is_film ? find(&source, from) : (long long)at;
    int code = r->engine->replay_seek(r->replay, (unsigned long long)source.step, &error);
    double time = r->engine->replay_info(r->replay).time;
    if (code == CLI_OK && !is_film) { // the camera wants to know where all began
        source.step = 0;
        code = r->engine->replay_seek(r->replay, 0, &error);
    }
    if (code != CLI_OK) {
        return scene_report(&error);
    }
    engine_stage *stage = r->engine->replay_stage(r->replay);
    if (stage == NULL) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    source.seen = (engine_scenery){ r->engine, stage, r->engine->info(stage) };
    return film_shoot(&args->film, &source, time);
}

// --------------------------------------------------------------------------------- what is asked

/// A moment that is to be in the recording.
static int check_moment(const cli_command *command, const recording *r, const char *option,
                        double time)
{
    engine_replay_info info = r->engine->replay_info(r->replay);
    if (time > info.end + half_step(r)) {
        cli_message("%s: option --%s: %.12g s is beyond the end, %.12g s", command->name, option,
                    time, info.end);
        return CLI_USAGE;
    }
    if (time >= 0 && time < info.start - half_step(r)) {
        cli_message("%s: option --%s: %.12g s is before the beginning, %.12g s", command->name,
                    option, time, info.start);
        return CLI_USAGE;
    }
    return CLI_OK;
}

/// Which steps are asked for.
static int find_range(const cli_command *command, const replay_args *args, const recording *r,
                      unsigned long long *first, unsigned long long *last)
{
    engine_replay_info info = r->engine->replay_info(r->replay);
    *first = 0;
    *last = info.steps;
    if (args->step > (double)info.steps) {
        cli_message("%s: option --step: %.0f is beyond the last step, %llu", command->name,
                    args->step, info.steps);
        return CLI_USAGE;
    }
    int code = check_moment(command, r, "seek", args->seek);
    code = code == CLI_OK ? check_moment(command, r, "from", args->film.from) : code;
    code = code == CLI_OK ? check_moment(command, r, "to", args->film.to) : code;
    if (args->step >= 0) {
        *first = *last = (unsigned long long)args->step;
    } else if (args->seek >= 0) {
        *first = *last = r->engine->replay_find(r->replay, args->seek + half_step(r));
    }
    return code;
}

/// What belongs to pictures only, and what to anything else.
static int check_render(const cli_command *command, replay_args *args)
{
    const film_args *film = &args->film;
    const struct {
        const char *name;
        bool given;
    } of_pictures[] = { { "size", film->size.width > 0 }, { "from", film->from >= 0 },
                        { "to", film->to >= 0 },          { "fps", film->fps > 0 },
                        { "follow", film->follow },       { "zoom", film->zoom > 0 },
                        { "overlay", film->overlay },     { "trail", film->trail >= 0 },
                        { "title", film->title } },
      of_text[] = { { "list", args->list },     { "info", args->info },
                    { "output", args->output }, { "format", args->format >= 0 },
                    { "every", args->every },   { "body", args->only } };
    for (size_t i = 0; film->output == NULL && i < sizeof of_pictures / sizeof *of_pictures; i++) {
        if (of_pictures[i].given) {
            cli_message("%s: option --%s: is for pictures; --render FILE makes them", command->name,
                        of_pictures[i].name);
            return CLI_USAGE;
        }
    }
    for (size_t i = 0; film->output != NULL && i < sizeof of_text / sizeof *of_text; i++) {
        if (of_text[i].given) {
            cli_message("%s: option --%s: is for text; --render makes pictures", command->name,
                        of_text[i].name);
            return CLI_USAGE;
        }
    }
    if (film->output == NULL) {
        return CLI_OK;
    }
    if (film_is_film(film->output) && (args->seek >= 0 || args->step >= 0)) {
        cli_message("%s: option --%s: is for one picture; a film has --from and --to",
                    command->name, args->seek >= 0 ? "seek" : "step");
        return CLI_USAGE;
    }
    return film_args_check(command, &args->film);
}

static int check_args(const cli_command *command, const replay_args *args)
{
    if (scene_width_check(command, args->width) != CLI_OK) {
        return CLI_USAGE;
    }
    if (args->step >= 0 && args->step != floor(args->step)) {
        cli_message("%s: option --step: %.10g is not a whole number", command->name, args->step);
        return CLI_USAGE;
    }
    if (args->step >= 0 && args->seek >= 0) {
        cli_message("%s: option --step: --seek names a moment already", command->name);
        return CLI_USAGE;
    }
    if (args->list && (args->only != NULL || args->format >= 0)) {
        cli_message("%s: option --list: --body and --format belong to the table of bodies",
                    command->name);
        return CLI_USAGE;
    }
    return CLI_OK;
}

/// Prints what is asked for.
static int print(const replay_args *args, const table_sampling *every, recording *r,
                 unsigned long long first, unsigned long long last)
{
    cli_output out;
    int code = cli_output_open(&out, args->output);
    if (code != CLI_OK) {
        return code;
    }
    if (args->info) {
        print_info(r, out.file);
    } else {
        code = play(args, every, r, first, last, out.file);
    }
    bool keep = (code == CLI_OK || code == CLI_DIFFERS) && !cli_interrupted();
    int closed = cli_output_close(&out, keep);
    return code == CLI_OK ? closed : code;
}

static int replay_command(const cli_command *command, int argc, char **argv)
{
    replay_args args = { .format = -1, .seek = -1, .step = -1, .film = FILM_ARGS_INIT };
    cli_operands operands;
    table_sampling every;
    recording r;
    unsigned long long first, last;

    int code = cli_parse(command, argc, argv, &args, &operands);
    code = code == CLI_OK ? check_args(command, &args) : code;
    code = code == CLI_OK ? check_render(command, &args) : code;
    if (code == CLI_OK && !args.list && !args.info) {
        code = table_read_format(command, args.output, &args.format);
    }
    code = code == CLI_OK ? table_read_every(command, args.every, &every) : code;
    if (code == CLI_OK) {
        const cli_file files[] = { { "RECORDING", operands.items[0], false },
                                   { "--output", args.output, true },
                                   { "--render", args.film.output, true } };
        code = cli_files_check(command, files, 3);
    }
    code = code == CLI_OK ? recording_open(operands.items[0], args.width, args.list, &r) : code;
    if (code != CLI_OK) {
        return code;
    }
    code = find_range(command, &args, &r, &first, &last);
    if (code == CLI_OK) {
        code = args.film.output != NULL ? render(&args, &r, last)
                                        : print(&args, &every, &r, first, last);
    }
    recording_close(&r);
    return code;
}

static const cli_option options[] = {
    { "seek", 0, CLI_REAL, offsetof(replay_args, seek), "S", 0, SCENE_TIME_MAX, NULL,
      "only the step nearest to S seconds" },
    { "step", 0, CLI_REAL, offsetof(replay_args, step), "N", 0, STEP_MAX, NULL,
      "only the state after N steps; 0 is the head of the recording" },
    { "list", 'l', CLI_FLAG, offsetof(replay_args, list), NULL, 0, 0, NULL,
      "print steps with their hashes, and what the user changed in each, in words" },
    { "info", 'i', CLI_FLAG, offsetof(replay_args, info), NULL, 0, 0, NULL,
      "print what the recording says of itself, and replay nothing" },
    { "output", 'o', CLI_TEXT, offsetof(replay_args, output), "FILE", 0, 0, NULL,
      "write to FILE, which appears when complete; .csv or .jsonl (default: CSV to stdout)" },
    { "format", 0, CLI_CHOICE, offsetof(replay_args, format), "NAME", 0, 0, "csv,jsonl",
      "csv or jsonl, whatever FILE is called" },
    { "every", 0, CLI_TEXT, offsetof(replay_args, every), "N", 0, 0, NULL,
      "print every N steps, or every so many seconds: 0.5s (default 1)" },
    { "body", 0, CLI_TEXT, offsetof(replay_args, only), "NAME", 0, 0, NULL,
      "print only the body of that name" },
    { "width", 0, CLI_INT, offsetof(replay_args, width), "N", 0, 16, NULL,
      "SIMD lanes of floats: 4, 8 or 16; 0 takes the best measured (default). Changes the speed, "
      "not a bit of the result" },
    { "render", 0, CLI_TEXT, offsetof(replay_args, film.output), "FILE", 0, 0, NULL,
      "draw instead: picture.png (of --seek or --step, else camera{at} of the scene, else the "
      "end), "
      "frame%04d.png (one file a picture), film.gif or film.mp4 (needs ffmpeg)" },
    FILM_OPTIONS(replay_args, film),
    SCENE_OPTION_QUIET(replay_args, scene),
};

const cli_command cmd_replay = {
    .name = "replay",
    .summary = "runs a recording again: prints where bodies are, what was done, or draws",
    .operands = "RECORDING",
    .text =
        "Replays what `plumb run --record` or a program with plumb_recorder_start wrote, without "
        "the scene, and verifies that every step gives the bits that were recorded (exit code 6 "
        "where one does not). Prints the table of `plumb run`, bodies in the order of their "
        "handles. Rows are the state right after a step; what handlers of the scene change then "
        "is in the next one. With --render it draws as `plumb render` does, with the colours, the "
        "texts and the camera of the scene.",
    .examples = "plumb replay pong.rec --seek 12.5\n"
                "plumb replay pong.rec --list --every 60\n"
                "plumb replay pong.rec --body ball -o ball.csv\n"
                "plumb replay pong.rec --render pong.png --seek 12.5 --trail 1\n"
                "plumb replay pong.rec --render pong.mp4 --from 10 --to 15",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 1,
    .run = replay_command,
};
