/// film.c - see film.h.
///
/// Reads what the source shows, writes PNG, PNG sequences, GIF or MP4 by the name of the output. A film
/// is gone through twice unless the camera is aimed: once to find what must be visible, once to draw.
/// Cost: the way, and some 10 ms a picture of 960x540.
#include "film.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "trail.h"
#include "view.h"

/// [1/s] pictures a simulated second.
static const double FPS_DEFAULT = 30;
static const cli_size SIZE_DEFAULT = { 960, 540 };

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
    { "field", RENDER_SHOW_FIELD },
    { "flow", RENDER_SHOW_FLOW },
    { "joints", RENDER_SHOW_JOINTS },
    { "surfaces", RENDER_SHOW_SURFACES },
    { "dipoles", RENDER_SHOW_DIPOLES },
    { "grid", RENDER_SHOW_GRID },
    { "labels", RENDER_SHOW_LABELS },
    { "legend", RENDER_SHOW_LEGEND },
    { "scale", RENDER_SHOW_SCALE },
    { "title", RENDER_SHOW_TITLE },
    { "names", RENDER_SHOW_LABELS | ENGINE_SHOW_NAMES },
    { "spokes", RENDER_SHOW_SPOKES },
};

enum { OVERLAY_COUNT = (int)(sizeof overlays / sizeof overlays[0]) };

/// Everything that drawing one picture after another needs.
typedef struct film {
    const film_args *args;
    film_source *source;
    cli_size size;
    double fps;
    view view;
    trail_set trails;
    render_frame *frame;
    render_target *target;
    render_writer *writer;
    unsigned pictures; ///< written
    int guard;
    const char *path;     ///< of the file, through links to what they stand for
    char *resolved;       ///< owned
    char temporary[4096]; ///< what is being written
} film;

const char *film_overlay(int index)
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

bool film_is_film(const char *path)
{
    size_t length = strlen(path);
    return render_pattern_is(path) || (length > 4 && (strcmp(path + length - 4, ".gif") == 0 ||
                                                      strcmp(path + length - 4, ".mp4") == 0));
}

int film_args_check(const cli_command *command, film_args *args)
{
    bool is_film = film_is_film(args->output);
    if (!is_film && (args->from >= 0 || args->to >= 0)) {
        cli_message("%s: --from and --to are for films; '%.200s' is one picture", command->name,
                    args->output);
        return CLI_USAGE;
    }
    if (!is_film && args->fps > 0) {
        cli_message("%s: --fps is for films; '%.200s' is one picture", command->name, args->output);
        return CLI_USAGE;
    }
    if (args->to >= 0 && args->to < args->from) {
        cli_message("%s: --to %g lies before --from %g", command->name, args->to, args->from);
        return CLI_USAGE;
    }
    return read_overlays(command, args->overlay, &args->show);
}

// Read by LeakSanitizer where it is linked in: Mesa keeps a few hundred bytes for every context.
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libOSMesa.so\n";
}

static int fail_render(render_result result, const render_error *error)
{
    cli_message("%s", error->text);
    bool is_usage = result == RENDER_E_FORMAT || result == RENDER_E_PATTERN;
    return is_usage ? CLI_USAGE : CLI_FAILED;
}

/// Names the file that the next picture is written to, for the case that a signal ends the program in the midst.
static void guard(film *f)
{
    render_error error;
    char name[sizeof f->temporary];
    cli_output_unguard(f->guard);
    bool named = !render_pattern_is(f->path);
    snprintf(name, sizeof name, "%s", f->path);
    if (!named) {
        named = render_pattern_name(f->path, f->pictures++, name, sizeof name, &error) == RENDER_OK;
    }
    named = named && render_temporary_name(name, f->temporary, sizeof f->temporary);
    f->guard = named ? cli_output_guard(f->temporary, NULL) : -1;
}

static bool is_at_end(const film_source *source)
{
    return source->ended != NULL && source->ended(source);
}

/// Goes on to step `to`, one by one. With `feed` the view sees every step.
static int advance(film *f, long long to, bool feed, progress *bar)
{
    film_source *source = f->source;
    int code = CLI_OK;
    while (code == CLI_OK && source->step < to && !cli_interrupted() && !is_at_end(source)) {
        code = source->go(source, source->step + 1, bar);
        if (code == CLI_OK && feed) {
            view_feed(&f->view, &source->seen);
        }
        if (code == CLI_OK && !trail_record(&f->trails, &source->seen)) {
            cli_message("out of memory");
            code = CLI_FAILED;
        }
        progress_update(bar, (double)source->step);
    }
    return code;
}

static void write_caption(const engine_scenery *of, char *text, size_t size)
{
    char solver[16] = "";
    engine_stats s = of->engine->stats(of->stage);
    const char *scores = of->engine->text(of->stage);
    (void)cli_member(ENGINE_SOLVERS, of->info.solver, solver, sizeof solver);
    snprintf(text, size, "t = %.2f s   %u bod%s   %u contact%s   %s x %d, %s%s%s",
             of->engine->time(of->stage), s.bodies, s.bodies == 1 ? "y" : "ies", s.contacts,
             s.contacts == 1 ? "" : "s", solver, of->info.substeps, of->engine->precision,
             scores[0] != '\0' ? "   " : "", scores);
}

/// Arrows of the field, what flows, where they are wanted.
static int draw_field(film *f, const render_camera *camera)
{
    const engine_scenery *of = &f->source->seen;
    const double high = camera->view_height / 2, wide = high * f->size.width / f->size.height;
    const engine_box box = { camera->center.x - wide, camera->center.y - high,
                             camera->center.x + wide, camera->center.y + high };
    int code = CLI_OK;
    if ((f->args->show & RENDER_SHOW_FIELD) != 0) {
        code = of->engine->draw_field(of->stage, f->frame, &box);
    }
    if (code == CLI_OK && (f->args->show & RENDER_SHOW_FLOW) != 0) {
        code = of->engine->draw_flow(of->stage, f->frame, &box);
    }
    return code;
}

static int draw(film *f)
{
    render_error error = { { 0 } };
    char caption[256];
    const engine_scenery *of = &f->source->seen;
    render_camera camera = view_camera(&f->view, of);
    render_options options = { .show = f->args->show & ~ENGINE_SHOW_NAMES };

    render_frame_clear(f->frame);
    write_caption(of, caption, sizeof caption);
    render_frame_set_title(f->frame, f->args->title != NULL ? f->args->title : of->info.name);
    render_frame_set_caption(f->frame, caption);
    if (of->engine->draw(of->stage, f->frame, f->args->show) != CLI_OK ||
        draw_field(f, &camera) != CLI_OK) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    trail_draw(&f->trails, f->frame);
    render_result result = render_target_draw(f->target, f->frame, &camera, &options, &error);
    if (result == RENDER_OK) {
        guard(f);
        result = render_writer_add(f->writer, render_target_pixels(f->target), &error);
    }
    return result == RENDER_OK ? CLI_OK : fail_render(result, &error);
}

/// Goes to step `to` once for the camera's sake and back again.
static int scout(film *f, long long to)
{
    progress bar;
    long long first = f->source->step;
    double seconds = f->trails.seconds;
    progress_begin(&bar, "looking ahead", (double)to, f->source->quiet);
    f->trails.seconds = 0;
    int code = advance(f, to, true, &bar);
    f->trails.seconds = seconds;
    code = code == CLI_OK && !cli_interrupted() ? f->source->go(f->source, first, &bar) : code;
    progress_end(&bar);
    return code;
}

static int shoot_film(film *f)
{
    film_source *source = f->source;
    double from = f->args->from >= 0 ? f->args->from : source->start;
    double to = f->args->to >= 0 ? f->args->to : source->end;
    int code = CLI_OK;
    progress bar;

    if (to < from) {
        cli_message("the film would begin at %g s, after its end at %g s", from, to);
        return CLI_USAGE;
    }
    if (view_needs_run(&f->view)) {
        code = scout(f, source->find(source, to));
    }
    progress_begin(&bar, "drawing", (double)source->find(source, to), source->quiet);
    // A thousandth of a picture of slack: times are sums of steps.
    long long pictures = (long long)fmin(floor((to - from) * f->fps + 1e-3), 0x1p53) + 1;
    for (long long i = 0; i < pictures && code == CLI_OK && !cli_interrupted(); i++) {
        double time = from + (double)i / f->fps;
        code = advance(f, source->find(source, time), false, &bar);
        code = code == CLI_OK ? draw(f) : code;
        if (is_at_end(source)) {
            break;
        }
    }
    progress_end(&bar);
    return code;
}

static int shoot_picture(film *f, double time)
{
    film_source *source = f->source;
    long long last = source->find(source, time);
    long long first = source->find(source, fmax(time - f->trails.seconds, source->start));
    progress bar;
    progress_begin(&bar, source->verb, (double)last, source->quiet);
    // On the way only the trail is to be seen, and the state at its end.
    int code = source->go(source, first, &bar);
    if (code == CLI_OK) {
        view_forget(&f->view);
        view_feed(&f->view, &source->seen);
        if (!trail_record(&f->trails, &source->seen)) {
            cli_message("out of memory");
            code = CLI_FAILED;
        }
    }
    code = code == CLI_OK ? advance(f, last, true, &bar) : code;
    progress_end(&bar);
    return code == CLI_OK && !cli_interrupted() ? draw(f) : code;
}

/// What follows the last dot.
static const char *ending(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot != NULL ? dot : "";
}

static int film_open(film *f)
{
    render_error error = { { 0 } };
    f->frame = render_frame_create(NULL);
    if (f->frame == NULL) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    int width = f->size.width, height = f->size.height;
    f->resolved = cli_is_link(f->args->output) ? cli_resolve(f->args->output) : NULL;
    // A link may stand for a name without an ending, which says what is written, or with a %.
    bool usable = f->resolved != NULL && !render_pattern_is(f->resolved) &&
                  strcmp(ending(f->resolved), ending(f->args->output)) == 0;
    f->path = usable ? f->resolved : f->args->output;
    render_result result = render_writer_open(&f->writer, f->path, width, height, f->fps, &error);
    if (result == RENDER_OK) {
        result = render_target_create(&f->target, width, height, NULL, &error);
    }
    if (result == RENDER_OK && !render_pattern_is(f->path)) {
        guard(f); // a film's file is there from now on
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
    cli_output_unguard(f->guard);
    trail_free(&f->trails);
    render_target_destroy(f->target);
    render_frame_destroy(f->frame);
    free(f->resolved);
    return code;
}

int film_shoot(const film_args *args, film_source *source, double at)
{
    film f = { .args = args,
               .source = source,
               .size = args->size.width > 0 ? args->size : SIZE_DEFAULT,
               .fps = args->fps > 0 ? args->fps : FPS_DEFAULT,
               .guard = -1 };
    f.trails.seconds = args->trail >= 0 ? args->trail : source->seen.info.camera.trail;
    view_wish wish = { args->follow, args->zoom > 0 ? args->zoom : 1, f.size.width, f.size.height };
    int code = view_begin(&f.view, &wish, &source->seen);
    code = code == CLI_OK ? film_open(&f) : code;
    if (code == CLI_OK) {
        code = film_is_film(args->output) ? shoot_film(&f) : shoot_picture(&f, at);
    }
    return film_close(&f, code);
}
