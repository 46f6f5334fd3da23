/// scene_args.c - opening a scene with what the command line overrides, stepping it, messages.
///
/// Reads the scene file, writes stderr.
#include "scene_args.h"

#include <math.h>
#include <string.h>

int scene_width_check(const cli_command *command, int width)
{
    if (width != 0 && width != 4 && width != 8 && width != 16) {
        cli_message("%s: option --width: %d is not 0, 4, 8 or 16", command->name, width);
        return CLI_USAGE;
    }
    return CLI_OK;
}

int scene_args_check(const cli_command *command, const scene_args *args)
{
    if (scene_width_check(command, args->width) != CLI_OK) {
        return CLI_USAGE;
    }
    for (int i = 0; i < args->sets.count; i++) {
        const char *text = args->sets.items[i];
        size_t key = strcspn(text, "=");
        if (key == 0 || text[key] == '\0') {
            cli_message("%s: option --set: '%.80s' is not of the form key=value", command->name,
                        text);
            return CLI_USAGE;
        }
    }
    return CLI_OK;
}

int scene_report(const engine_error *error)
{
    if (cli_interrupted()) {
        return error->code; // the user knows; main ends by the signal
    }
    fflush(stdout);
    // A scene's message begins with its own place, "file:line:column:", as compilers print it.
    if (error->code == CLI_SCENE) {
        fprintf(stderr, "%s\n", error->text);
    } else {
        cli_message("%s", error->text);
    }
    return error->code;
}

long long scene_step_count(double time, double dt)
{
    // 10 s in steps of 1/60 are 600 steps, also when the division gives 600.0000001.
    return (long long)ceil(time / dt - 1e-6);
}

int scene_run_open(const scene_args *args, const char *path, scene_run *run)
{
    engine_settings settings = { .path = path,
                                 .sets = args->sets.items,
                                 .set_count = args->sets.count,
                                 .dt = args->dt,
                                 .substeps = args->substeps,
                                 .iterations = args->iterations,
                                 .solver = args->solver,
                                 .accuracy = args->accuracy,
                                 .width = args->width,
                                 .workers = args->workers,
                                 .watchdog = args->watchdog,
                                 .no_expect = args->no_expect,
                                 .unseen = args->unseen };
    engine_error error = { 0 };

    const engine_api *const engines[] = { &engine_float, &engine_double, &engine_far };
    *run = (scene_run){ .engine = args->engine != NULL ? args->engine : engines[args->precision] };
    if (run->engine == NULL) {
        cli_message(CLI_LACKS_PRECISION);
        return CLI_FAILED;
    }
    run->session = run->engine->open(&settings, &error);
    if (run->session == NULL) {
        return scene_report(&error);
    }
    if (!watch_open(&run->watch, path, &args->allowed)) {
        return scene_run_close(run, CLI_USAGE);
    }
    run->stage = run->engine->stage(run->session);
    run->info = run->engine->info(run->stage);
    run->time = args->time >= 0 ? args->time : run->info.duration;
    run->steps = scene_step_count(run->time, run->info.dt);
    return CLI_OK;
}

void scene_run_warn(const scene_run *run, const char *path)
{
    enum { TOLD = 3 };
    const engine_overlap *list;
    int count = run->engine->overlaps(run->session, &list);
    for (int i = 0; i < count && i < TOLD; i++) {
        cli_message("warning: %s: '%s' and '%s' begin %.3g m inside one another", path, list[i].a,
                    list[i].b, list[i].depth);
    }
    if (count > TOLD) {
        cli_message("warning: %s: and %d more pair%s of bodies", path, count - TOLD,
                    count - TOLD == 1 ? "" : "s");
    }
}

bool scene_run_accuracy(const scene_run *run, char *text, size_t size)
{
    const engine_accuracy a = run->engine->accuracy(run->stage);
    char solver[16] = "";
    if (!(a.tolerance > 0)) {
        return false;
    }
    (void)cli_member(ENGINE_SOLVERS, a.solver, solver, sizeof solver);
    snprintf(
        text, size,
        "tolerance %g %s: error about %.2g (motion %.2g, frozen %.2g, rest %.2g); %s solver%s, %d "
        "substep%s: %s; %.3g substeps a step",
        a.tolerance, a.met ? "met" : "MISSED", a.worst, a.motion, a.frozen, a.rest, solver,
        a.direct_joints ? ", direct joints" : "", a.substeps, a.substeps == 1 ? "" : "s", a.reason,
        a.solved);
    return true;
}

int scene_run_step(scene_run *run, progress *bar)
{
    engine_error error = { 0 };
    int code = run->engine->step(run->session, &error);
    code = code == CLI_OK ? run->engine->check(run->session, &error) : code;
    if (code == CLI_OK) {
        return watch_step(&run->watch, run->engine, run->session);
    }
    if (bar != NULL) {
        progress_end(bar);
    }
    return scene_report(&error);
}

int scene_unknown_body(const engine_scenery *of, const char *option, const char *name)
{
    const engine_row *rows;
    int count = of->engine->rows(of->stage, &rows), slips = cli_slips(name);
    const char *near = NULL;
    for (int i = 0; i < count; i++) {
        near = cli_nearer(name, rows[i].name, &slips) ? rows[i].name : near;
    }
    if (near != NULL) {
        cli_message("option --%s: no body of '%s' is named '%.80s'; did you mean '%.80s'?", option,
                    of->info.name, name, near);
    } else {
        cli_message("option --%s: no body of '%s' is named '%.80s'", option, of->info.name, name);
    }
    return CLI_USAGE;
}

bool scene_run_done(const scene_run *run, long long step)
{
    return step >= run->steps || cli_interrupted() || run->engine->ended(run->session);
}

int scene_run_close(scene_run *run, int code)
{
    watch_close(&run->watch);
    if (run->engine != NULL) {
        run->engine->close(run->session);
    }
    run->session = NULL;
    return code;
}
