/// cmd_check.c - `plumb check`: runs scenes to their end and judges their `expect` lines.
///
/// Reads scenes, writes one line for each expectation to stdout, the same on every run.
#include "lint.h"
#include "scene_args.h"

#include <string.h>

typedef struct check_args {
    scene_args scene;
    bool verbose;
    bool lint;
    cli_texts rules; ///< with it, what --allow names
} check_args;

typedef struct tally {
    int scenes, broken; ///< scenes that ran to their end, and that did not
    int held, failed;   ///< expectations
    int found, faulty;  ///< findings of the linter, and scenes that have some
    int watched;        ///< scenes with alarms
    long long alarms;
    int worst; ///< exit code
} tally;

/// Of two codes the one to answer: a scene that does not even load outranks one that diverged,
/// and that one an expectation missed.
static int worse(int a, int b)
{
    static const int order[] = { CLI_USAGE, CLI_SCENE, CLI_FAILED, CLI_DIVERGED, CLI_EXPECT };
    for (int i = 0; i < (int)(sizeof order / sizeof order[0]); i++) {
        if (a == order[i] || b == order[i]) {
            return order[i];
        }
    }
    return CLI_OK;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

static int judge(scene_run *run, const char *path, tally *sum)
{
    const engine_expect *list;
    int count = run->engine->expectations(run->session, &list);
    if (count < 0) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    if (count == 0) {
        printf("none  %s: nothing is expected\n", base_name(path));
    }
    for (int i = 0; i < count; i++) {
        const engine_expect *e = &list[i];
        printf("%s  %s: %s: %s%s\n", e->passed ? "ok  " : "FAIL", base_name(path), e->name, e->text,
               e->reached ? "" : " (the run ended before it could be judged)");
        sum->held += e->passed;
        sum->failed += !e->passed;
        sum->worst = worse(sum->worst, e->passed ? CLI_OK : CLI_EXPECT);
    }
    return CLI_OK;
}

/// Runs one scene to its end, without judging.
static int simulate(scene_run *run, progress *bar)
{
    int code = CLI_OK;
    for (long long step = 0; code == CLI_OK && !scene_run_done(run, step); step++) {
        progress_update(bar, (double)step);
        code = scene_run_step(run, bar);
    }
    engine_error error = { 0 };
    if (cli_interrupted()) {
        return CLI_FAILED;
    }
    if (code == CLI_OK) {
        code = run->engine->finish(run->session, &error);
        if (code != CLI_OK) {
            progress_end(bar);
            scene_report(&error);
        }
    }
    return code;
}

static void print_verbose(const scene_run *run, const char *path)
{
    char solver[16] = "";
    engine_stats stats = run->engine->stats(run->stage);
    (void)cli_member(ENGINE_SOLVERS, run->info.solver, solver, sizeof solver);
    printf(
        "note  %s: %lld steps of %.6g s, %s, %d substeps, %s; at the end %u bodies, %u contacts, "
        "deepest overlap %.3g m\n",
        base_name(path), run->steps, run->info.dt, solver, run->info.substeps,
        run->engine->precision, stats.bodies, stats.contacts, stats.max_penetration);
}

static void print_cut(const scene_run *run, const char *path)
{
    const unsigned cut = run->engine->stats(run->stage).cut_chains;
    if (cut > 0) {
        printf(
            "note  %s: %u time%s a contact had more impacts in a substep than are followed: energy "
            "is lost\n",
            base_name(path), cut, cut == 1 ? "" : "s");
    }
}

static void print_missed(const scene_run *run, const char *path)
{
    const unsigned missed = run->engine->stats(run->stage).soft_missed;
    if (missed > 0) {
        printf("note  %s: %u substep%s soft bodies had not settled when the iteration ended\n",
               base_name(path), missed, missed == 1 ? " whose" : "s whose");
    }
}

static void print_accuracy(const scene_run *run, const char *path)
{
    char text[512];
    if (scene_run_accuracy(run, text, sizeof text)) {
        printf("note  %s: %s\n", base_name(path), text);
    }
}

/// Looks at the scene as it begins, and does not run it.
static int lint(const check_args *args, const scene_run *run, const char *path, tally *sum)
{
    const int found = lint_scene(run, path, &args->rules);
    if (found == 0) {
        printf("ok    %s: nothing found\n", base_name(path));
    }
    if (found > 0) {
        sum->found += found;
        sum->faulty++;
        sum->worst = worse(sum->worst, CLI_EXPECT);
    }
    return found < 0 ? CLI_FAILED : CLI_OK;
}

/// A scene that has a watchdog of its own expects alarms, or not; who asks for one here wants none.
static void count_alarms(const check_args *args, scene_run *run, tally *sum)
{
    const long long found = watch_close(&run->watch);
    sum->alarms += found;
    sum->watched += found > 0;
    if (args->scene.watchdog && found > 0) {
        sum->worst = worse(sum->worst, CLI_EXPECT);
    }
}

static void check_one(const check_args *args, const char *path, tally *sum)
{
    scene_run run;
    int code = scene_run_open(&args->scene, path, &run);
    if (code == CLI_OK && args->lint) {
        code = lint(args, &run, path, sum);
        scene_run_close(&run, CLI_OK);
    } else if (code == CLI_OK) {
        progress bar;
        scene_run_warn(&run, path);
        run.watch.to_stdout = true;
        progress_begin(&bar, base_name(path), (double)run.steps, args->scene.quiet);
        code = simulate(&run, &bar);
        progress_end(&bar);
        count_alarms(args, &run, sum);
        if (code == CLI_OK && args->verbose) {
            print_verbose(&run, path);
        }
        if (code == CLI_OK) {
            print_cut(&run, path);
            print_missed(&run, path);
            print_accuracy(&run, path);
            code = judge(&run, path, sum);
        }
        scene_run_close(&run, CLI_OK);
    }
    if (code == CLI_OK) {
        sum->scenes++;
        return;
    }
    if (!cli_interrupted()) {
        printf("FAIL  %s: %s\n", base_name(path),
               code == CLI_SCENE      ? "the scene is wrong"
               : code == CLI_USAGE    ? "the command line does not fit the scene"
               : code == CLI_DIVERGED ? "the simulation diverged"
                                      : "the run failed");
    }
    sum->broken++;
    sum->worst = worse(sum->worst, code);
}

static void print_broken(const tally *sum)
{
    if (sum->broken > 0) {
        printf("; %d scene%s could not be judged", sum->broken, sum->broken == 1 ? "" : "s");
    }
    printf("\n");
}

static int check_command(const cli_command *command, int argc, char **argv)
{
    check_args args = { .scene = SCENE_ARGS_INIT };
    cli_operands operands;
    tally sum = { 0 };

    int code = cli_parse(command, argc, argv, &args, &operands);
    code = code == CLI_OK ? scene_args_check(command, &args.scene) : code;
    if (code != CLI_OK) {
        return code;
    }
    if (args.lint) {
        args.rules = args.scene.allowed;
        args.scene.allowed = (cli_texts){ .count = 0 };
    }
    for (int i = 0; i < operands.count && !cli_interrupted(); i++) {
        check_one(&args, operands.items[i], &sum);
        fflush(stdout);
    }
    if (args.lint) {
        printf("%d finding%s in %d of %d scene%s", sum.found, sum.found == 1 ? "" : "s", sum.faulty,
               sum.scenes, sum.scenes == 1 ? "" : "s");
        print_broken(&sum);
        return sum.worst;
    }
    printf("%d expectation%s of %d scene%s: %d ok, %d failed", sum.held + sum.failed,
           sum.held + sum.failed == 1 ? "" : "s", sum.scenes, sum.scenes == 1 ? "" : "s", sum.held,
           sum.failed);
    if (args.scene.watchdog || sum.alarms > 0) {
        printf("; %lld alarm%s in %d scene%s", sum.alarms, sum.alarms == 1 ? "" : "s", sum.watched,
               sum.watched == 1 ? "" : "s");
    }
    print_broken(&sum);
    return sum.worst;
}

#define RULE_TEXT(name, look, text, advice) " " name ": " text "."

static const cli_option options[] = {
    SCENE_OPTIONS(check_args, scene),
    { "verbose", 'v', CLI_FLAG, offsetof(check_args, verbose), NULL, 0, 0, NULL,
      "also tell the settings and the state at the end" },
    { "lint", 'l', CLI_FLAG, offsetof(check_args, lint), NULL, 0, 0, NULL,
      "do not run the scenes: look for what is likely to go wrong as they begin" },
    { "allow", 0, CLI_TEXTS, offsetof(check_args, scene.allowed), "RULE,...", 0, 0, NULL,
      "with --lint: rules that may find something; else alarms that may be told" },
    SCENE_OPTION_QUIET(check_args, scene),
};

const cli_command cmd_check = {
    .name = "check",
    .summary = "runs scenes to their end and judges what they expect",
    .operands = "SCENE...",
    .text =
        "Runs every SCENE to its end and prints a line for each of its expectations: ok or "
        "FAIL, the scene, the name of the expectation, what was measured, the limit. The exit "
        "code is 4 when any failed, 3 when a scene does not load, 5 when one diverged. A scene "
        "that expects nothing fails nothing: it is told so (none) and the exit code stays 0. With "
        "--lint "
        "scenes are not run: rules look at each as it begins and tell what is likely to go wrong, "
        "and what to "
        "do; the exit code is 4 when one finds something. A scene that is meant to be so says it "
        "in a line of "
        "its own, \"-- lint: allow mass-ratio, size: why\". The rules:" LINT_RULES(
            RULE_TEXT) " With --watchdog every step of every scene is watched and measured, which "
                       "takes several times as long; an alarm is "
                       "told with the body or joint, what was found and its bound, when, in which "
                       "row of the schedule and by which work, and the last call that "
                       "changed the body; the exit code is 4 when there is one. A scene may allow "
                       "some as above: \"-- watchdog: allow torn-joint: why\". "
                       "The alarms, with their bounds:" PLUMB_ALARM_LIST(WATCH_TEXT),
    .examples = "plumb check assets/scenes/*.lua\n"
                "plumb check stack.lua --precision double --verbose\n"
                "plumb check --lint assets/scenes/*.lua\n"
                "plumb check --watchdog crates.lua",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 1 << 20,
    .run = check_command,
};
