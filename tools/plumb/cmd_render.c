/// cmd_render.c - `plumb render`: pictures and films of a scene.
///
/// Reads the scene, writes PNG, PNG sequences, GIF or MP4 by the name of the output. A film is
/// simulated twice unless the scene aims the camera: once to find what must be visible, once to
/// draw. Cost: the simulation, and some 10 ms a picture of 960x540.
#include "commands.h"
#include "trail.h"
#include "view.h"

#include <math.h>
#include <string.h>

#include "../render/write.h"

typedef struct render_args {
    scene_args scene;
    const char *output;
    cli_size size;
    double fps;          ///< 0: not given
    double at, from, to; ///< [s]; < 0: not given
    const char *follow;
    double zoom;
    double trail; ///< [s]; < 0: the scene's
    const char *overlay;
    const char *title;
} render_args;

/// Overlays by name, each a bit of render_options.show.
static const struct {
    const char *name;
    unsigned bit;
} overlays[] = {
    { "contacts", RENDER_SHOW_CONTACTS },
    { "impulses", RENDER_SHOW_IMPULSES },
    { "velocities", RENDER_SHOW_VELOCITIES },
    { "aabbs", RENDER_SHOW_AABBS },
    { "cells", RENDER_SHOW_CELLS },
    { "joints", RENDER_SHOW_JOINTS },
    { "surfaces", RENDER_SHOW_SURFACES },
    { "grid", RENDER_SHOW_GRID },
    { "labels", RENDER_SHOW_LABELS },
    { "legend", RENDER_SHOW_LEGEND },
    { "scale", RENDER_SHOW_SCALE },
    { "title", RENDER_SHOW_TITLE },
    { "names", RENDER_SHOW_LABELS | ENGINE_SHOW_NAMES },
    { "spokes", RENDER_SHOW_SPOKES },
};

/// [1/s] pictures a simulated second.
static const double FPS_DEFAULT = 30;

enum { OVERLAY_COUNT = (int)(sizeof overlays / sizeof overlays[0]) };

/// Everything that drawing one picture after another needs.
typedef struct film {
    scene_run run;
    view view;
    trail_set trails;
    render_frame *frame;
    render_target *target;
    render_writer *writer;
    unsigned show;
    const char *title;
    long long step; ///< steps taken
} film;

const char *cmd_render_overlay(int index)
{
    return index < OVERLAY_COUNT ? overlays[index].name : NULL;
}

static int unknown_overlay(const cli_command *command, const char *word)
{
    char names[256] = "none", near_name[32];
    for (int i = 0; i < OVERLAY_COUNT; i++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, ",%s", overlays[i].name);
    }
    int near = cli_nearest(word, names);
    if (near >= 0 && cli_member(names, near, near_name, sizeof near_name)) {
        cli_message("%s: option --overlay: unknown overlay '%.40s'; did you mean '%s'?",
                    command->name, word, near_name);
    } else {
        cli_message("%s: option --overlay: '%.40s' is not one of %s", command->name, word, names);
    }
    return CLI_USAGE;
}

/// "contacts,no-grid": added to and taken from what is shown by default; "none" takes all.
static int read_overlays(const cli_command *command, const char *text, unsigned *show)
{
    char word[40];
    *show = RENDER_SHOW_DEFAULT;
    if (text == NULL) {
        return CLI_OK;
    }
    for (const char *at = text;; at++) {
        size_t length = strcspn(at, ",");
        snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word), at);
        at += length;
        bool is_off = strncmp(word, "no-", 3) == 0;
        const char *name = is_off ? word + 3 : word;
        int found = 0;
        while (found < OVERLAY_COUNT && strcmp(overlays[found].name, name) != 0) {
            found++;
        }
        if (strcmp(word, "none") == 0) {
            *show = RENDER_SHOW_NOTHING;
        } else if (found == OVERLAY_COUNT) {
            return unknown_overlay(command, name);
        } else if (is_off) {
            *show &= ~overlays[found].bit;
        } else {
            *show |= overlays[found].bit;
        }
        if (*at == '\0') {
            return CLI_OK;
        }
    }
}

static bool is_film(const char *path)
{
    size_t length = strlen(path);
    return render_pattern_is(path) || (length > 4 && (strcmp(path + length - 4, ".gif") == 0 ||
                                                      strcmp(path + length - 4, ".mp4") == 0));
}

// Read by LeakSanitizer where it is linked in: Mesa keeps a few hundred bytes for every context.
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libOSMesa.so\n";
}

/// What the table cannot check.
static int check_args(const cli_command *command, const render_args *args)
{
    if (args->output == NULL) {
        cli_message("%s: -o FILE is missing: picture.png, frame%%04d.png, film.gif or film.mp4",
                    command->name);
        return CLI_USAGE;
    }
    if (is_film(args->output) && args->at >= 0) {
        cli_message("%s: --at is for one picture; a film has --from and --to", command->name);
        return CLI_USAGE;
    }
    if (!is_film(args->output) && (args->from >= 0 || args->to >= 0)) {
        cli_message("%s: --from and --to are for films; one picture has --at", command->name);
        return CLI_USAGE;
    }
    if (!is_film(args->output) && args->fps > 0) {
        cli_message("%s: --fps is for films; '%.200s' is one picture", command->name, args->output);
        return CLI_USAGE;
    }
    if (args->to >= 0 && args->to < args->from) {
        cli_message("%s: --to %g lies before --from %g", command->name, args->to, args->from);
        return CLI_USAGE;
    }
    return CLI_OK;
}

static int fail_render(render_result result, const render_error *error)
{
    cli_message("%s", error->text);
    bool is_usage = result == RENDER_E_FORMAT || result == RENDER_E_PATTERN;
    return is_usage ? CLI_USAGE : CLI_FAILED;
}

/// Simulates up to step `to`. With `feed` the view sees every step.
static int advance(film *f, long long to, bool feed, progress *bar)
{
    int code = CLI_OK;
    while (code == CLI_OK && f->step < to && !cli_interrupted() &&
           !f->run.engine->ended(f->run.session)) {
        code = scene_run_step(&f->run, bar);
        f->step++;
        if (feed) {
            view_feed(&f->view, &f->run);
        }
        if (code == CLI_OK && !trail_record(&f->trails, &f->run)) {
            cli_message("out of memory");
            code = CLI_FAILED;
        }
        progress_update(bar, (double)f->step);
    }
    return code;
}

static void write_caption(film *f, char *text, size_t size)
{
    char solver[16] = "";
    engine_stats s = f->run.engine->stats(f->run.session);
    const char *scores = f->run.engine->text(f->run.session);
    (void)cli_member(ENGINE_SOLVERS, f->run.info.solver, solver, sizeof solver);
    snprintf(text, size, "t = %.2f s   %u bod%s   %u contact%s   %s x %d, %s%s%s",
             f->run.engine->time(f->run.session), s.bodies, s.bodies == 1 ? "y" : "ies", s.contacts,
             s.contacts == 1 ? "" : "s", solver, f->run.info.substeps, f->run.engine->precision,
             scores[0] != '\0' ? "   " : "", scores);
}

static int draw(film *f)
{
    render_error error = { { 0 } };
    char caption[256];
    render_camera camera = view_camera(&f->view, &f->run);
    render_options options = { .show = f->show & ~ENGINE_SHOW_NAMES };

    render_frame_clear(f->frame);
    write_caption(f, caption, sizeof caption);
    render_frame_set_title(f->frame, f->title != NULL ? f->title : f->run.info.name);
    render_frame_set_caption(f->frame, caption);
    if (f->run.engine->draw(f->run.session, f->frame, f->show) != CLI_OK) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    trail_draw(&f->trails, f->frame);
    render_result result = render_target_draw(f->target, f->frame, &camera, &options, &error);
    if (result == RENDER_OK) {
        result = render_writer_add(f->writer, render_target_pixels(f->target), &error);
    }
    return result == RENDER_OK ? CLI_OK : fail_render(result, &error);
}

/// Runs the scene up to `time` once for the camera's sake and opens it anew.
static int scout(film *f, const render_args *args, const char *path, double time)
{
    progress bar;
    long long steps = scene_step_count(time, f->run.info.dt);
    progress_begin(&bar, "looking ahead", (double)steps, args->scene.quiet);
    f->trails.seconds = 0;
    int code = advance(f, steps, true, &bar);
    progress_end(&bar);
    scene_run_close(&f->run, CLI_OK);
    f->step = 0;
    f->trails.seconds = args->trail;
    return code == CLI_OK ? scene_run_open(&args->scene, path, &f->run) : code;
}

static int shoot_film(film *f, const render_args *args, const char *path)
{
    double from = args->from >= 0 ? args->from : 0;
    double to = args->to >= 0 ? args->to : f->run.time;
    double dt = f->run.info.dt;
    int code = CLI_OK;
    progress bar;

    if (to < from) {
        cli_message("the film would begin at %g s, after its end at %g s", from, to);
        return CLI_USAGE;
    }
    if (view_needs_run(&f->view)) {
        code = scout(f, args, path, to);
        if (code != CLI_OK) {
            return code;
        }
    }
    progress_begin(&bar, "drawing", to / dt, args->scene.quiet);
    long long pictures = (long long)floor((to - from) * args->fps + 1e-6) + 1;
    for (long long i = 0; i < pictures && code == CLI_OK && !cli_interrupted(); i++) {
        double time = from + (double)i / args->fps;
        code = advance(f, llround(time / dt), false, &bar);
        code = code == CLI_OK ? draw(f) : code;
        if (f->run.engine->ended(f->run.session)) {
            break;
        }
    }
    progress_end(&bar);
    return code;
}

static int shoot_picture(film *f, const render_args *args)
{
    double time = args->at >= 0 ? args->at : f->run.time;
    // Of many runs the end is the dullest moment: the scene may know a better one.
    if (args->at < 0 && args->scene.time < 0 && f->run.info.camera.at >= 0) {
        time = f->run.info.camera.at;
    }
    long long steps = llround(time / f->run.info.dt);
    progress bar;
    progress_begin(&bar, "simulating", (double)steps, args->scene.quiet);
    // Of the run only the trail is to be seen, and the state at its end.
    int code = advance(f, steps - llround(args->trail / f->run.info.dt), false, &bar);
    f->view.start = f->view.seen = (engine_box){ 1, 1, -1, -1 };
    view_feed(&f->view, &f->run);
    code = code == CLI_OK ? advance(f, steps, true, &bar) : code;
    progress_end(&bar);
    return code == CLI_OK && !cli_interrupted() ? draw(f) : code;
}

static int film_open(film *f, const render_args *args)
{
    render_error error = { { 0 } };
    f->frame = render_frame_create(NULL);
    if (f->frame == NULL) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    int width = args->size.width, height = args->size.height;
    render_result result =
        render_writer_open(&f->writer, args->output, width, height, args->fps, &error);
    if (result == RENDER_OK) {
        result = render_target_create(&f->target, width, height, NULL, &error);
    }
    return result == RENDER_OK ? CLI_OK : fail_render(result, &error);
}

static int film_close(film *f, int code)
{
    render_error error = { { 0 } };
    if (code != CLI_OK || cli_interrupted()) {
        render_writer_abort(f->writer);
    } else {
        render_result result = render_writer_close(f->writer, &error);
        code = result == RENDER_OK ? CLI_OK : fail_render(result, &error);
    }
    trail_free(&f->trails);
    render_target_destroy(f->target);
    render_frame_destroy(f->frame);
    return scene_run_close(&f->run, code);
}

static int render_command(const cli_command *command, int argc, char **argv)
{
    render_args args = { .scene = SCENE_ARGS_INIT,
                         .size = { 960, 540 },
                         .at = -1,
                         .from = -1,
                         .to = -1,
                         .zoom = 1,
                         .trail = -1 };
    cli_operands operands;
    film f = { .step = 0 };

    int code = cli_parse(command, argc, argv, &args, &operands);
    code = code == CLI_OK ? scene_args_check(command, &args.scene) : code;
    code = code == CLI_OK ? check_args(command, &args) : code;
    code = code == CLI_OK ? read_overlays(command, args.overlay, &f.show) : code;
    code = code == CLI_OK ? scene_run_open(&args.scene, operands.items[0], &f.run) : code;
    if (code != CLI_OK) {
        return code;
    }
    view_wish wish = { args.follow, args.zoom, args.size.width, args.size.height };
    if (args.trail < 0) {
        args.trail = f.run.info.camera.trail;
    }
    if (args.fps <= 0) {
        args.fps = FPS_DEFAULT;
    }
    f.title = args.title;
    f.trails.seconds = args.trail;
    code = view_begin(&f.view, &wish, &f.run);
    code = code == CLI_OK ? film_open(&f, &args) : code;
    if (code == CLI_OK) {
        code = is_film(args.output) ? shoot_film(&f, &args, operands.items[0])
                                    : shoot_picture(&f, &args);
    }
    return film_close(&f, code);
}

static const cli_option options[] = {
    { "output", 'o', CLI_TEXT, offsetof(render_args, output), "FILE", 0, 0, NULL,
      "picture.png, frame%04d.png (one file a picture), film.gif or film.mp4 (needs ffmpeg)" },
    { "size", 's', CLI_SIZE, offsetof(render_args, size), "WxH", 16, RENDER_SIZE_MAX, NULL,
      "in pixels (default 960x540)" },
    { "at", 0, CLI_REAL, offsetof(render_args, at), "S", 0, SCENE_TIME_MAX, NULL,
      "picture: the moment in seconds (default: --time, else camera{at}, else the scene's "
      "end)" },
    { "from", 0, CLI_REAL, offsetof(render_args, from), "S", 0, SCENE_TIME_MAX, NULL,
      "film: where it begins (default 0)" },
    { "to", 0, CLI_REAL, offsetof(render_args, to), "S", 0, SCENE_TIME_MAX, NULL,
      "film: where it ends (default: --time, the scene's end)" },
    { "fps", 0, CLI_REAL, offsetof(render_args, fps), "N", 0.01, 1000, NULL,
      "film: pictures a simulated second (default 30)" },
    { "follow", 0, CLI_TEXT, offsetof(render_args, follow), "NAME", 0, 0, NULL,
      "keep the body of that name in the middle" },
    { "zoom", 0, CLI_REAL, offsetof(render_args, zoom), "F", 0.001, 1000, NULL,
      "show 1/F of the height that would be shown (default 1)" },
    { "overlay", 0, CLI_TEXT, offsetof(render_args, overlay), "LIST", 0, 0, NULL,
      "contacts, impulses, velocities, aabbs, cells (of the broad phase), legend, names (of all "
      "bodies); on unless taken away (no-grid): joints, surfaces (the way they run), grid, labels, "
      "scale, title, spokes; none: nothing but the bodies" },
    { "trail", 0, CLI_REAL, offsetof(render_args, trail), "S", 0, SCENE_TIME_MAX, NULL,
      "draw behind every moving body where it was in the last S seconds (default: "
      "camera{trail}, else none)" },
    { "title", 0, CLI_TEXT, offsetof(render_args, title), "TEXT", 0, 0, NULL,
      "instead of the scene's; \"\" for none" },
    SCENE_OPTIONS(render_args, scene),
    SCENE_OPTION_QUIET(render_args, scene),
};

const cli_command cmd_render = {
    .name = "render",
    .summary = "draws a scene: a picture, a sequence, a GIF or an MP4",
    .operands = "SCENE",
    .text = "Simulates SCENE and draws it; what is written depends on the name of FILE. The camera "
            "is where the scene puts it, else it shows all that moves throughout the run.",
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
