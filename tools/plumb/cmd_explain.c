/// cmd_explain.c - `plumb explain`: the schedule of a scene, with reasons and shares of time.
///
/// Reads the scene and the engine's pass table after a short run, writes text to stdout. With
/// --no-timing the text is the same on every run.
#include "scene_args.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct explain_args {
    scene_args scene;
    bool no_timing;
    bool columns;
    bool energy;
} explain_args;

/// In how many steps a pass ran, and why when it last did: what falls asleep leaves the schedule. Of one
/// that never ran, why it did not in the first step.
typedef struct pass_tally {
    char name[64], reason[128];
    long long steps;
} pass_tally;

typedef struct tally {
    pass_tally *items;
    int count, room;
} tally;

/// [s] simulated unless told otherwise: long enough for things to meet, short enough to wait for.
static const double DEFAULT_TIME = 1;

/// [-] of the largest energy in a table: less is none.
static const double ROUNDING = 1e-12;

static pass_tally *find_tally(const tally *t, const engine_pass *pass)
{
    for (int i = 0; i < t->count; i++) {
        if (strcmp(t->items[i].name, pass->name) == 0) {
            return &t->items[i];
        }
    }
    return NULL;
}

static bool grow(tally *t)
{
    int room = t->room + t->room / 2 + 64;
    pass_tally *grown = realloc(t->items, (size_t)room * sizeof *grown);
    t->items = grown != NULL ? grown : t->items;
    t->room = grown != NULL ? room : t->room;
    return grown != NULL;
}

/// The schedule of now, each pass with its tally, in which `steps` more are counted if it is in the schedule.
/// -1 after a message.
static int note_schedule(tally *t, const scene_run *run, int steps, const engine_pass **list)
{
    int count = run->engine->passes(run->session, list);
    for (int i = 0; i < count; i++) {
        const engine_pass *pass = &(*list)[i];
        pass_tally *item = find_tally(t, pass);
        bool is_new = item == NULL;
        if (is_new && t->count == t->room && !grow(t)) {
            count = -1;
            break;
        }
        if (is_new) {
            item = &t->items[t->count++];
            *item = (pass_tally){ .steps = 0 };
            snprintf(item->name, sizeof item->name, "%s", pass->name);
        }
        if (is_new || (pass->scheduled && steps > 0)) {
            snprintf(item->reason, sizeof item->reason, "%s", pass->reason);
        }
        item->steps += pass->scheduled ? steps : 0;
    }
    if (count < 0) {
        cli_message("out of memory");
    }
    return count;
}

/// How wide the columns of names and stages are.
typedef struct widths {
    int name, phase;
} widths;

/// Rows of the substeps stand below the pass that they are inside of.
static int indent_of(const engine_pass *pass)
{
    return pass->in_substeps ? 2 : 0;
}

static widths longest(const engine_pass *list, int count)
{
    widths most = { 4, 5 };
    for (int i = 0; i < count; i++) {
        int name = (int)strlen(list[i].name) + indent_of(&list[i]);
        int phase = (int)strlen(list[i].phase);
        most.name = name > most.name ? name : most.name;
        most.phase = phase > most.phase ? phase : most.phase;
    }
    return most;
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
    char accuracy[512];
    if (scene_run_accuracy(run, accuracy, sizeof accuracy)) {
        printf("  %s\n", accuracy);
    }
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
static void print_pass(const engine_pass *pass, const pass_tally *ran, widths width, double total,
                       long long steps, bool columns)
{
    const int indent = indent_of(pass);
    printf("  %*s%-*s  %-*s", indent, "", width.name - indent, pass->name, width.phase,
           pass->phase);
    if (total > 0) {
        printf("  %5.1f %%  %9.2f us", 100 * pass->total_ns / total,
               1e-3 * pass->total_ns / (double)steps);
    }
    printf("  %s%s", ran->reason, pass->is_user ? " (registered by the scene)" : "");
    for (int i = 0; i < pass->variant_count && ran->steps > 0; i++) {
        printf("%s%s", i == 0 ? "; with " : ", ", pass->variants[i]);
    }
    if (ran->steps > 0 && ran->steps < steps) {
        printf(" (in %lld of %lld steps)", ran->steps, steps);
    }
    printf("\n");
    if (columns) {
        printf("  %*s  reads %s; writes %s\n", width.name, "",
               pass->reads[0] ? pass->reads : "nothing",
               pass->writes[0] ? pass->writes : "nothing");
    }
}

static int print_schedule(const explain_args *args, const scene_run *run, tally *t)
{
    const engine_pass *list;
    // Of no steps, what would run.
    int count = note_schedule(t, run, run->steps == 0, &list);
    if (count < 0) {
        return CLI_FAILED;
    }
    const widths width = longest(list, count);
    int left_out = 0;
    double total = 0;

    for (int i = 0; i < count; i++) {
        total += list[i].total_ns;
        left_out += find_tally(t, &list[i])->steps == 0;
    }
    if (args->no_timing || run->steps == 0) {
        total = 0;
    }
    printf("\nRuns, in this order:\n");
    printf("  %-*s  %-*s  %swhy\n", width.name, "pass", width.phase, "stage",
           total > 0 ? "  share        a step  " : "");
    for (int i = 0; i < count; i++) {
        const pass_tally *ran = find_tally(t, &list[i]);
        if (ran->steps > 0) {
            print_pass(&list[i], ran, width, total, run->steps, args->columns);
        }
    }
    if (left_out > 0) {
        printf("\nLeft out, costs nothing:\n");
    }
    for (int i = 0; i < count; i++) {
        const pass_tally *ran = find_tally(t, &list[i]);
        if (ran->steps == 0) {
            print_pass(&list[i], ran, width, 0, run->steps, args->columns);
        }
    }
    if (total > 0) {
        printf("\nOne simulated second takes %.3g ms of passes.\n",
               1e-6 * total / ((double)run->steps * run->info.dt));
    }
    return CLI_OK;
}

/// What is between the sum and `after` - `before` was changed between the steps: by functions of the scene.
static void print_energy(const engine_measures *m)
{
    double sum[2] = { 0 }, most = 0;
    for (int i = 0; i < m->count; i++) {
        most = fmax(most, fmax(fabs(m->works[i].kinetic), fabs(m->works[i].potential)));
    }
    printf("\nEnergy over %lld steps [J]: %.6g before, %.6g after\n", m->steps, m->before,
           m->after);
    printf("  %-10s%13s%13s%13s  what it covers\n", "by", "kinetic", "potential", "both");
    for (int i = 0; i < m->count; i++) {
        const double kinetic = m->works[i].kinetic, potential = m->works[i].potential;
        sum[0] += kinetic, sum[1] += potential;
        // The last, what is unexplained, is told however little it is.
        if (i == m->count - 1 || fabs(kinetic) + fabs(potential) > ROUNDING * most) {
            printf("  %-10s%13.5g%13.5g%13.5g  %s\n", m->works[i].name, kinetic, potential,
                   kinetic + potential, m->works[i].text);
        }
    }
    printf("  %-10s%13.5g%13.5g%13.5g\n", "all", sum[0], sum[1], sum[0] + sum[1]);
    printf("\nMost in any step, where its last substep ended:\n");
    printf("  contacts overlap by %.3g m, approach at %.3g m/s, push over gaps with %.3g N s m, "
           "exceed friction by %.3g N s\n",
           m->gap, m->approach, m->complementarity, m->cone);
    printf("  momentum is off its impulses by %.3g N s; joints are off by %.3g m, %.3g rad\n",
           m->momentum, m->joint_length, m->joint_angle);
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
    tally t = { 0 };
    const engine_pass *list;
    engine_measures measures = { 0 };
    if (args.energy) {
        run.engine->measure(run.session, &measures);
    }
    progress_begin(&bar, run.info.name, (double)run.steps, args.scene.quiet);
    for (long long step = 0; code == CLI_OK && !scene_run_done(&run, step); step++) {
        progress_update(&bar, (double)step);
        code = note_schedule(&t, &run, 1, &list) >= 0 ? scene_run_step(&run, &bar) : CLI_FAILED;
        if (args.energy && code == CLI_OK) {
            run.engine->measure(run.session, &measures);
        }
    }
    progress_end(&bar);
    run.steps = (long long)run.engine->stats(run.stage).step_count; // the scene may end itself
    if (code == CLI_OK && !cli_interrupted()) {
        print_settings(&run, operands.items[0]);
        if (args.energy) {
            print_energy(&measures);
        } else {
            code = print_schedule(&args, &run, &t);
        }
    }
    free(t.items);
    return scene_run_close(&run, code);
}

static const cli_option options[] = {
    SCENE_OPTION_TIME_OR(explain_args, scene, "1, or the scene's duration if that is shorter"),
    { "no-timing", 0, CLI_FLAG, offsetof(explain_args, no_timing), NULL, 0, 0, NULL,
      "leave the times out: the text is then the same on every run" },
    { "columns", 'c', CLI_FLAG, offsetof(explain_args, columns), NULL, 0, 0, NULL,
      "also tell which columns each pass reads and writes" },
    { "energy", 'e', CLI_FLAG, offsetof(explain_args, energy), NULL, 0, 0, NULL,
      "instead of the schedule, tell where the energy went and what each step left unsolved" },
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
            "prints the schedule in order: which passes ran and because of what, which were left "
            "out of all steps, and what share of the time each took. Rows that are set in run "
            "inside of "
            "the row above them; with several threads they have shares of the time that it took.",
    .examples = "plumb explain assets/scenes/stack.lua\n"
                "plumb explain stack.lua --no-timing --columns\n"
                "plumb explain assets/scenes/billiards.lua --energy --time 10",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 1,
    .run = explain_command,
};
