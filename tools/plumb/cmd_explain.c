/// cmd_explain.c - `plumb explain`: the schedule of a scene, with reasons and shares of time.
///
/// Reads the scene and the engine's pass table after a short run, writes text to stdout. With
/// --no-timing the text is the same on every run.
#include "scene_args.h"

#include <string.h>

typedef struct explain_args {
    scene_args scene;
    bool no_timing;
    bool columns;
} explain_args;

/// [s] simulated unless told otherwise: long enough for things to meet, short enough to wait for.
static const double DEFAULT_TIME = 1;

static int longest(const engine_pass *list, int count)
{
    int width = 4;
    for (int i = 0; i < count; i++) {
        int length = (int)strlen(list[i].name);
        width = length > width ? length : width;
    }
    return width;
}

static void print_settings(const scene_run *run, const char *path)
{
    char solver[16] = "";
    engine_stats s = run->engine->stats(run->stage);
    (void)cli_member(ENGINE_SOLVERS, run->info.solver, solver, sizeof solver);
    printf("%s (%s)\n", run->info.name, path);
    printf("  %s solver, %d substep%s, %d sweep%s, steps of %.6g s, %s, %d lanes\n", solver,
           run->info.substeps, run->info.substeps == 1 ? "" : "s", run->info.iterations,
           run->info.iterations == 1 ? "" : "s", run->info.dt, run->engine->precision,
           run->info.width);
    printf(
        "  after %.6g s (%lld steps): %u bodies (%u moving, %u asleep in %u island%s, %u static), "
        "%u shapes of %u pieces\n",
        (double)run->steps * run->info.dt, run->steps, s.bodies, s.moving, s.asleep, s.islands,
        s.islands == 1 ? "" : "s", s.statics, s.shapes, s.pieces);
    printf(
        "  pairs near: %u, contacts: %u, their points: %u, colours: %u, pair list rebuilds: %u\n",
        s.pairs, s.contacts, s.points, s.colors, s.pair_rebuilds);
    printf("  deepest overlap %.3g m, mean %.3g m; %.1f kB held\n", s.max_penetration,
           s.mean_penetration, (double)s.bytes / 1000);
}

/// One row of the table. `total` [ns]: of all passes; 0: no timing.
static void print_pass(const engine_pass *pass, int width, double total, long long steps,
                       bool columns)
{
    printf("  %-*s  %-8s", width, pass->name, pass->phase);
    if (total > 0) {
        if (pass->total_ns > 0) {
            printf("  %5.1f %%  %9.2f us", 100 * pass->total_ns / total,
                   1e-3 * pass->total_ns / (double)steps);
        } else {
            printf("  %7s  %12s", "-", "-"); // part of another pass, not timed apart
        }
    }
    printf("  %s%s\n", pass->reason, pass->is_user ? " (registered by the scene)" : "");
    if (columns) {
        printf("  %*s  reads %s; writes %s\n", width, "", pass->reads[0] ? pass->reads : "nothing",
               pass->writes[0] ? pass->writes : "nothing");
    }
}

static int print_schedule(const explain_args *args, scene_run *run)
{
    const engine_pass *list;
    int count = run->engine->passes(run->session, &list);
    if (count < 0) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    int width = longest(list, count);
    int left_out = 0;
    double total = 0;

    for (int i = 0; i < count; i++) {
        total += list[i].total_ns;
        left_out += !list[i].scheduled;
    }
    if (args->no_timing || run->steps == 0) {
        total = 0;
    }
    printf("\nRuns, in this order:\n");
    printf(total > 0 ? "  %-*s  phase      share      a step  why\n" : "  %-*s  phase     why\n",
           width, "pass");
    for (int i = 0; i < count; i++) {
        if (list[i].scheduled) {
            print_pass(&list[i], width, total, run->steps, args->columns);
        }
    }
    if (left_out > 0) {
        printf("\nLeft out, costs nothing:\n");
    }
    for (int i = 0; i < count; i++) {
        if (!list[i].scheduled) {
            print_pass(&list[i], width, 0, run->steps, args->columns);
        }
    }
    if (total > 0) {
        printf("\nOne simulated second takes %.3g ms of passes.\n",
               1e-6 * total / ((double)run->steps * run->info.dt));
    }
    return CLI_OK;
}

static int explain_command(const cli_command *command, int argc, char **argv)
{
    explain_args args = { .scene = SCENE_ARGS_INIT };
    cli_operands operands;
    scene_run run;
    progress bar;

    int code = cli_parse(command, argc, argv, &args, &operands);
    code = code == CLI_OK ? scene_args_check(command, &args.scene) : code;
    code = code == CLI_OK ? scene_run_open(&args.scene, operands.items[0], &run) : code;
    if (code != CLI_OK) {
        return code;
    }
    if (args.scene.time < 0 && run.time > DEFAULT_TIME) {
        run.time = DEFAULT_TIME;
        run.steps = scene_step_count(run.time, run.info.dt);
    }
    progress_begin(&bar, run.info.name, (double)run.steps, args.scene.quiet);
    for (long long step = 0; code == CLI_OK && !scene_run_done(&run, step); step++) {
        progress_update(&bar, (double)step);
        code = scene_run_step(&run, &bar);
    }
    progress_end(&bar);
    run.steps = (long long)run.engine->stats(run.stage).step_count; // the scene may end itself
    if (code == CLI_OK && !cli_interrupted()) {
        print_settings(&run, operands.items[0]);
        code = print_schedule(&args, &run);
    }
    return scene_run_close(&run, code);
}

static const cli_option options[] = {
    SCENE_OPTION_TIME(explain_args, scene),
    { "no-timing", 0, CLI_FLAG, offsetof(explain_args, no_timing), NULL, 0, 0, NULL,
      "leave the times out: the text is then the same on every run" },
    { "columns", 'c', CLI_FLAG, offsetof(explain_args, columns), NULL, 0, 0, NULL,
      "also tell which columns each pass reads and writes" },
    SCENE_OPTION_DT(explain_args, scene),
    SCENE_OPTION_SUBSTEPS(explain_args, scene),
    SCENE_OPTION_ITERATIONS(explain_args, scene),
    SCENE_OPTION_SOLVER(explain_args, scene),
    SCENE_OPTION_WIDTH(explain_args, scene),
    SCENE_OPTION_WORKERS(explain_args, scene),
    SCENE_OPTION_PRECISION(explain_args, scene),
    SCENE_OPTION_SET(explain_args, scene),
    SCENE_OPTION_QUIET(explain_args, scene),
};

const cli_command cmd_explain = {
    .name = "explain",
    .summary = "tells which passes a scene runs, why, and what each costs",
    .operands = "SCENE",
    .text = "Simulates SCENE for a second (or its duration, if that is shorter; see --time) and "
            "prints the schedule in order: which passes run and because of what, which were left "
            "out, and what share of the time each took.",
    .examples = "plumb explain assets/scenes/stack.lua\n"
                "plumb explain stack.lua --no-timing --columns",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 1,
    .run = explain_command,
};
