/// cmd_render.c - `plumb render`: pictures and films of a scene.
///
/// Runs the scene for film.c, which draws. To go back the scene is opened anew.
#include "commands.h"
#include "film.h"

#include <math.h>

typedef struct render_args {
    scene_args scene;
    film_args film;
    double at; ///< [s] < 0: not given
} render_args;

/// A scene as a source of pictures.
typedef struct scene_reel {
    const scene_args *args;
    const char *path;
    scene_run run;
} scene_reel;

static void show(film_source *source, const scene_run *run)
{
    source->seen = (engine_scenery){ run->engine, run->stage, run->info };
}

static bool has_ended(const film_source *source)
{
    const scene_run *run = &((const scene_reel *)source->context)->run;
    return run->engine->ended(run->session);
}

static int go(film_source *source, long long to, progress *bar)
{
    scene_reel *reel = source->context;
    int code = CLI_OK;
    if (to < source->step) {
        scene_run_close(&reel->run, CLI_OK);
        source->step = 0;
        code = scene_run_open(reel->args, reel->path, &reel->run);
        if (code != CLI_OK) {
            progress_end(bar);
            return code;
        }
        show(source, &reel->run);
    }
    while (code == CLI_OK && source->step < to && !cli_interrupted() && !has_ended(source)) {
        code = scene_run_step(&reel->run, bar);
        source->step++;
        progress_update(bar, (double)source->step);
    }
    return code;
}

static long long find(const film_source *source, double time)
{
    return llround(time / source->seen.info.dt);
}

/// What the table and film.c cannot check.
static int check_args(const cli_command *command, const render_args *args)
{
    if (args->film.output == NULL) {
        cli_message("%s: -o FILE is missing: picture.png, frame%%04d.png, film.gif or film.mp4",
                    command->name);
        return CLI_USAGE;
    }
    if (film_is_film(args->film.output) && args->at >= 0) {
        cli_message("%s: --at is for one picture; a film has --from and --to", command->name);
        return CLI_USAGE;
    }
    if (args->scene.time >= 0 && args->at > args->scene.time) {
        cli_message("%s: --at %g lies behind --time %g", command->name, args->at, args->scene.time);
        return CLI_USAGE;
    }
    return CLI_OK;
}

/// [s] Of many runs the end is the dullest moment: the scene may know a better one.
static double moment(const render_args *args, const scene_run *run)
{
    if (args->at >= 0) {
        return args->at;
    }
    return args->scene.time < 0 && run->info.camera.at >= 0 ? run->info.camera.at : run->time;
}

static int render_command(const cli_command *command, int argc, char **argv)
{
    render_args args = { .scene = SCENE_ARGS_INIT, .film = FILM_ARGS_INIT, .at = -1 };
    scene_reel reel = { .args = &args.scene };
    cli_operands operands;

    int code = cli_parse(command, argc, argv, &args, &operands);
    code = code == CLI_OK ? scene_args_check(command, &args.scene) : code;
    code = code == CLI_OK ? check_args(command, &args) : code;
    code = code == CLI_OK ? film_args_check(command, &args.film) : code;
    if (code != CLI_OK) {
        return code;
    }
    const cli_file files[] = { { "SCENE", operands.items[0], false },
                               { "--output", args.film.output, true } };
    code = cli_files_check(command, files, 2);
    if (code != CLI_OK) {
        return code;
    }
    reel.path = operands.items[0];
    code = scene_run_open(&args.scene, reel.path, &reel.run);
    if (code != CLI_OK) {
        return code;
    }
    scene_run_warn(&reel.run, reel.path);
    film_source source = { .end = reel.run.time,
                           .verb = "simulating",
                           .quiet = args.scene.quiet,
                           .context = &reel,
                           .go = go,
                           .find = find,
                           .ended = has_ended };
    show(&source, &reel.run);
    code = film_shoot(&args.film, &source, moment(&args, &reel.run));
    return scene_run_close(&reel.run, code);
}

static const cli_option options[] = {
    { "output", 'o', CLI_TEXT, offsetof(render_args, film.output), "FILE", 0, 0, NULL,
      "picture.png, frame%04d.png (one file a picture), film.gif or film.mp4 (needs ffmpeg)" },
    { "at", 0, CLI_REAL, offsetof(render_args, at), "S", 0, SCENE_TIME_MAX, NULL,
      "picture: the moment in seconds (default: --time, else camera{at}, else the scene's "
      "end)" },
    FILM_OPTIONS(render_args, film),
    SCENE_OPTIONS(render_args, scene),
    SCENE_OPTION_QUIET(render_args, scene),
};

const cli_command cmd_render = {
    .name = "render",
    .summary = "draws a scene: a picture, a sequence, a GIF or an MP4",
    .operands = "SCENE",
    .text = "Simulates SCENE and draws it; what is written depends on the name of FILE. The camera "
            "is where the scene puts it, else it shows all that moves throughout the run, except "
            "what flies or falls away while others stay.",
    .examples = "plumb render assets/scenes/stack.lua -o stack.png --at 2\n"
                "plumb render pong.lua -o pong.gif --to 5 --fps 25 --size 640x360\n"
                "plumb render cradle.lua -o cradle.mp4 --overlay contacts,velocities,legend\n"
                "plumb render ball.lua -o frames/%04d.png --follow ball",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 1,
    .run = render_command,
};
