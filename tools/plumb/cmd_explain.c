/// cmd_explain.c - `plumb explain`: the schedule of a scene, with reasons and shares of time.
///
/// Reads the scene and the engine's pass table after a short run, writes text or JSON (explain_json.c) to stdout. With
/// --no-timing the text is the same on every run.
#include "explain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct explain_args {
    scene_args scene;
    bool no_timing;
    bool columns;
    bool energy;
    bool json;
    const char *flow;
} explain_args;

/// [s] simulated unless told otherwise: long enough for things to meet, short enough to wait for.
static const double DEFAULT_TIME = 1;

/// In how many steps of a run it is asked because of whom passes run, and what they visit.
static const long long LOOKS = 16;

/// [-] of the largest energy: less is the rounding of two sums.
static const double BETWEEN = 1e-5;
/// [-] of the largest energy in a table: less is none.
static const double ROUNDING = 1e-12;

pass_tally *explain_find(const tally *t, const engine_pass *pass)
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
/// `looks`: because of whom it runs, and what it visits, is asked; it is where it runs first. -1 after a message.
static int note_schedule(tally *t, const scene_run *run, int steps, bool looks,
                         const engine_pass **list)
{
    int count = run->engine->passes(run->session, list);
    for (int i = 0; i < count; i++) {
        const engine_pass *pass = &(*list)[i];
        pass_tally *item = explain_find(t, pass);
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
        if (pass->scheduled && (item->steps == 0 || looks)) {
            engine_because now;
            run->engine->because(run->session, pass, &now);
            const bool more = item->steps == 0 || now.rows > item->because.rows ||
                              now.bytes > item->because.bytes;
            item->because = more ? now : item->because;
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
    if (s.soft_asleep > 0) {
        printf("  soft bodies asleep: %u\n", s.soft_asleep);
    }
    printf(
        "  pairs near: %u, contacts: %u, their points: %u, colours: %u, pair list rebuilds: %u\n",
        s.pairs, s.contacts, s.points, s.colors, s.pair_rebuilds);
    printf("  deepest overlap %.3g m, mean %.3g m; %.1f kB held\n", s.max_penetration,
           s.mean_penetration, (double)s.bytes / 1000);
}

/// How many rows of what, and bytes a step.
static void print_visited(const engine_because *b)
{
    static const char *const units[] = { " B", "kB", "MB", "GB" };
    double bytes = b->bytes;
    int unit = 0;
    for (; bytes >= 1000 && unit < 3; unit++) {
        bytes /= 1000;
    }
    if (b->rows >= 0) {
        char what[16];
        snprintf(what, sizeof what, "%.*s", (int)strlen(b->what) - (b->rows == 1), b->what);
        printf("  %6ld %-9s", b->rows, strcmp(what, "bodie") == 0 ? "body" : what);
    } else {
        printf("  %6s %-9s", "", "");
    }
    printf("  %5.3g %s", bytes, units[unit]);
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
    if (ran->steps > 0) {
        print_visited(&ran->because);
    }
    printf("  %s%s", ran->reason, pass->is_user ? " (registered by the scene)" : "");
    if (ran->steps > 0 && ran->because.first[0] != '\0') {
        printf(": '%s'", ran->because.first);
        if (ran->because.count > 1) {
            printf(" and %d more", ran->because.count - 1);
        }
    }
    for (int i = 0; i < pass->variant_count && ran->steps > 0; i++) {
        printf("%s%s", i == 0 ? "; with " : ", ", pass->variants[i]);
    }
    for (int i = 0; i < pass->away_count && ran->steps > 0; i++) {
        printf("%s%s", i == 0 ? "; without " : ", ", pass->away[i]);
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

static void print_schedule(const explain_report *r, bool columns)
{
    const widths width = longest(r->list, r->count);
    int left_out = 0;

    for (int i = 0; i < r->count; i++) {
        left_out += explain_find(r->tally, &r->list[i])->steps == 0;
    }
    printf("\nRuns, in this order:\n");
    printf("  %-*s  %-*s  %s%16s  %8s  why\n", width.name, "pass", width.phase, "stage",
           r->total > 0 ? "  share        a step  " : "", "visits", "a step");
    for (int i = 0; i < r->count; i++) {
        const pass_tally *ran = explain_find(r->tally, &r->list[i]);
        if (ran->steps > 0) {
            print_pass(&r->list[i], ran, width, r->total, r->run->steps, columns);
        }
    }
    if (left_out > 0) {
        printf("\nLeft out, costs nothing:\n");
    }
    for (int i = 0; i < r->count; i++) {
        const pass_tally *ran = explain_find(r->tally, &r->list[i]);
        if (ran->steps == 0) {
            print_pass(&r->list[i], ran, width, 0, r->run->steps, columns);
        }
    }
    for (int i = 0; r->run->engine->lacks(i) != NULL; i++) {
        printf("%s%s", i == 0 ? "\nNot in this program (make EFFECTS=...): " : ", ",
               r->run->engine->lacks(i));
    }
    if (r->run->engine->lacks(0) != NULL) {
        printf("\n");
    }
    if (r->unused_count > 0) {
        printf("\nDeclared, and of no use in these %lld steps:\n", r->run->steps);
    }
    for (int i = 0; i < r->unused_count; i++) {
        printf("  warning: %s: %s", r->unused[i].rule, r->unused[i].text);
        if (r->unused[i].more > 0) {
            printf(", and %d more", r->unused[i].more);
        }
        printf("\n");
        printf("    to do: %s\n", r->unused[i].advice);
    }
    if (r->total > 0) {
        printf("\nOne simulated second takes %.3g ms of passes.\n",
               1e-6 * r->total / ((double)r->run->steps * r->run->info.dt));
    }
}

/// Gathers what is told, and tells it.
static int report(const explain_args *args, const scene_run *run, const char *path, tally *t)
{
    explain_report r = { .run = run, .path = path, .tally = t };
    // Of no steps, what would run.
    r.count = note_schedule(t, run, run->steps == 0, true, &r.list);
    r.unused_count =
        r.count < 0 || run->steps == 0 ? 0 : run->engine->unused(run->session, &r.unused);
    if (r.count < 0 || r.unused_count < 0) {
        return CLI_FAILED;
    }
    for (int i = 0; i < r.count && !args->no_timing && run->steps > 0; i++) {
        r.total += r.list[i].total_ns;
    }
    int code = args->flow != NULL ? explain_flow(&r, args->flow) : CLI_OK;
    if (code == CLI_OK && args->json) {
        explain_json(&r);
    } else if (code == CLI_OK) {
        print_settings(run, path);
        print_schedule(&r, args->columns);
    }
    return code;
}

/// What is between the sum of the works and `after` - `before` was changed between the steps: by functions of the scene.
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
    const double between = m->after - m->before - sum[0] - sum[1];
    if (fabs(between) > BETWEEN * fmax(most, fmax(fabs(m->before), fabs(m->after)))) {
        printf("  %-10s%13s%13s%13.5g  what the scene's functions did between steps: blows, thrown "
               "and moved bodies, new ones\n",
               "script", "", "", between);
    }
    printf("  %-10s%13.5g%13.5g%13.5g\n", "all", sum[0], sum[1], m->after - m->before);
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
    const cli_file files[] = { { "SCENE", code == CLI_OK ? operands.items[0] : NULL, false },
                               { "--flow", args.flow, true } };
    code = code == CLI_OK ? cli_files_check(command, files, 2) : code;
    if (code == CLI_OK && args.flow != NULL && !explain_flow_names(args.flow)) {
        return CLI_USAGE;
    }
    if (code == CLI_OK && args.energy && (args.json || args.flow != NULL)) {
        cli_message("--energy tells of no passes: it goes with neither --json nor --flow");
        return CLI_USAGE;
    }
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
    const long long look = run.steps / LOOKS + 1;
    progress_begin(&bar, run.info.name, (double)run.steps, args.scene.quiet);
    for (long long step = 0; code == CLI_OK && !scene_run_done(&run, step); step++) {
        progress_update(&bar, (double)step);
        const bool looks = step % look == look - 1;
        code =
            note_schedule(&t, &run, 1, looks, &list) >= 0 ? scene_run_step(&run, &bar) : CLI_FAILED;
        if (code == CLI_OK && !args.energy && !run.engine->note_use(run.session)) {
            cli_message("out of memory");
            code = CLI_FAILED;
        }
        if (args.energy && code == CLI_OK) {
            run.engine->measure(run.session, &measures);
        }
    }
    progress_end(&bar);
    run.steps = (long long)run.engine->stats(run.stage).step_count; // the scene may end itself
    if (code == CLI_OK && !cli_interrupted()) {
        if (args.energy) {
            print_settings(&run, operands.items[0]);
            print_energy(&measures);
        } else {
            code = report(&args, &run, operands.items[0], &t);
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
    { "json", 'j', CLI_FLAG, offsetof(explain_args, json), NULL, 0, 0, NULL,
      "print it as JSON: the keys are in tools/plumb/README.md" },
    { "flow", 0, CLI_TEXT, offsetof(explain_args, flow), "FILE.svg", 0, 0, NULL,
      "also draw which pass reads and writes what" },
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
    .text =
        "Simulates SCENE for a second (or its duration, if that is shorter; see --time) and "
        "prints the schedule in order: which passes ran and because of what and whom, how many "
        "rows they "
        "visited and how many bytes the data has that they name, which were left "
        "out of all steps, and what share of the time each took; then what the scene declares that "
        "was of no use. Rows that are set in run "
        "inside of "
        "the row above them; with several threads they have shares of the time that it took.",
    .examples = "plumb explain assets/scenes/stack.lua\n"
                "plumb explain stack.lua --no-timing --columns\n"
                "plumb explain stack.lua --json --flow stack.svg\n"
                "plumb explain assets/scenes/billiards.lua --energy --time 10",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 1,
    .run = explain_command,
};
