/// cmd_cost.c - `plumb cost`: what accuracy costs in time, on a scene of the user's own.
///
/// Reads the scene, writes a table (or CSV) to stdout. Cost: about (repeat + 1) runs of the scene
/// a setting, and without a closed form a reference some hundred times as long as the scene.
#include "cost.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

typedef struct cost_args {
    scene_args scene;
    unsigned solvers, precisions; ///< bits by index of choice
    cli_ints substeps;
    int repeat;
    double tolerance; ///< [m] < 0: not given
    bool csv;
} cost_args;

enum { ROWS_MAX = 2 * 3 * CLI_INTS_MAX, COMPARED_MOMENTS = 200 };

static void name_of(const char *list, int index, char *out, size_t size)
{
    if (!cli_member(list, index, out, size)) {
        out[0] = '\0';
    }
}

static int list_rows(const cost_args *args, cost_row *rows)
{
    int count = 0;
    for (int solver = 0; solver < 2; solver++) {
        for (int s = 0; s < args->substeps.count; s++) {
            for (int precision = 0; precision < 3; precision++) {
                if ((args->solvers >> solver & 1u) != 0 &&
                    (args->precisions >> precision & 1u) != 0) {
                    rows[count++] = (cost_row){ .solver = solver,
                                                .substeps = args->substeps.items[s],
                                                .precision = precision,
                                                .cpu = DBL_MAX };
                }
            }
        }
    }
    return count;
}

static double total_work(const cost_plan *plan, const cost_args *args, const cost_row *rows,
                         int count)
{
    double steps = (double)plan->steps, work = 0;
    for (int i = 0; i < count; i++) {
        work += (args->repeat + 1) * cost_work(steps, rows[i].substeps);
    }
    if (!plan->has_exact) {
        work += cost_work(steps * COST_REFERENCE_FINER * 1.5, plan->reference_substeps);
    }
    return work;
}

static int measure(cost_plan *plan, const cost_args *args, cost_row *rows, int count)
{
    int code = CLI_OK;
    progress_begin(&plan->bar, "measuring", total_work(plan, args, rows, count), args->scene.quiet);
    if (!plan->has_exact) {
        code = cost_refer(plan);
    }
    for (int i = 0; i < count && code == CLI_OK; i++) {
        code = cost_measure(plan, &rows[i]);
    }
    // Repeats outside, rows inside: a slow second of the machine hits all rows alike.
    for (int r = 0; r < args->repeat; r++) {
        for (int i = 0; i < count && code == CLI_OK && !cli_interrupted(); i++) {
            if (!rows[i].diverged) {
                code = cost_time(plan, &rows[i]);
            }
        }
    }
    progress_end(&plan->bar);
    return cli_interrupted() ? CLI_FAILED : code;
}

/// By time; what diverged last, otherwise in the order of the table.
static int by_time(const void *a, const void *b)
{
    const cost_row *p = a, *q = b;
    if (p->diverged != q->diverged) {
        return p->diverged ? 1 : -1;
    }
    if (p->cpu != q->cpu) {
        return p->cpu < q->cpu ? -1 : 1;
    }
    return p->substeps - q->substeps;
}

/// [-] a row must be better by so much to be marked: less is luck of the roundings.
static const double WORTH_MENTIONING = 0.99;

/// Marks the rows that nothing cheaper equals: the Pareto front of time and error.
static void mark_best(cost_row *rows, int count)
{
    double least = DBL_MAX;
    for (int i = 0; i < count; i++) {
        if (!rows[i].diverged && rows[i].error >= 0 && rows[i].error < WORTH_MENTIONING * least) {
            least = rows[i].error;
            rows[i].best = true;
        }
    }
}

/// The unit of the table's errors.
static const char *error_unit(const cost_plan *plan, const scene_run *run)
{
    const char *unit = plan->has_exact ? run->info.exact_unit : "m";
    return unit[0] != '\0' ? unit : "mixed";
}

static void print_csv(const cost_row *rows, int count, const char *unit)
{
    char solver[16], precision[16];
    printf("solver,substeps,precision,cpu [s/s],error [%s],max penetration [m],pareto,diverged\n",
           unit);
    for (int i = 0; i < count; i++) {
        const cost_row *r = &rows[i];
        name_of(ENGINE_SOLVERS, r->solver, solver, sizeof solver);
        name_of(SCENE_PRECISIONS, r->precision, precision, sizeof precision);
        printf("%s,%d,%s,", solver, r->substeps, precision);
        if (r->diverged) {
            printf(",,,0,1\n");
        } else if (r->error < 0) {
            printf("%.6g,,%.6g,0,0\n", r->cpu, r->penetration);
        } else {
            printf("%.6g,%.6g,%.6g,%d,0\n", r->cpu, r->error, r->penetration, r->best);
        }
    }
}

static void print_head(const cost_plan *plan, const scene_run *run, const cost_args *args)
{
    printf("%s: %.6g s in steps of %.6g s; times are the least of %d run%s\n", run->info.name,
           plan->time, plan->dt, args->repeat, args->repeat == 1 ? "" : "s");
    if (plan->has_exact) {
        bool places = strcmp(run->info.exact_unit, "m") == 0;
        printf("error: largest %s the scene's closed form, at every step\n",
               places ? "distance of a body from" : "deviation from");
    } else {
        printf("error: largest distance of a body from the scene's own finest setting, for the\n"
               "       scene has no closed form (soft, double, %d substeps, steps of %.3g s)\n",
               plan->reference_substeps, plan->dt / COST_REFERENCE_FINER);
        if (plan->reference_error >= 0) {
            printf("       which moves by %.2g m when its step is doubled: smaller errors say "
                   "little\n",
                   plan->reference_error);
        }
    }
}

static void print_table(const cost_row *rows, int count, const char *unit)
{
    char solver[16], precision[16], title[32];
    snprintf(title, sizeof title, "error %s", unit);
    printf("\n  solver  substeps  precision  CPU ms a second  %10s  overlap m\n", title);
    for (int i = 0; i < count; i++) {
        const cost_row *r = &rows[i];
        name_of(ENGINE_SOLVERS, r->solver, solver, sizeof solver);
        name_of(SCENE_PRECISIONS, r->precision, precision, sizeof precision);
        printf("%c %-6s  %8d  %-9s", r->best ? '*' : ' ', solver, r->substeps, precision);
        if (r->diverged) {
            printf("         diverged\n");
        } else if (r->error < 0) {
            printf("  %15.4g  %10s  %9.2e\n", 1e3 * r->cpu, "unknown", r->penetration);
        } else {
            printf("  %15.4g  %10.3e  %9.2e\n", 1e3 * r->cpu, r->error, r->penetration);
        }
    }
    printf("\n* nothing cheaper is as accurate (to 1 %%)\n");
}

/// The cheapest row within the tolerance; rows are sorted by time.
static int judge(const cost_args *args, const cost_row *rows, int count, const char *unit,
                 FILE *file)
{
    char solver[16], precision[16];
    for (int i = 0; i < count; i++) {
        const cost_row *r = &rows[i];
        if (!r->diverged && r->error >= 0 && r->error <= args->tolerance) {
            name_of(ENGINE_SOLVERS, r->solver, solver, sizeof solver);
            name_of(SCENE_PRECISIONS, r->precision, precision, sizeof precision);
            fprintf(file,
                    "cheapest within %g %s: --solver %s --substeps %d --precision %s "
                    "(%.4g ms a second, error %.3e %s)\n",
                    args->tolerance, unit, solver, r->substeps, precision, 1e3 * r->cpu, r->error,
                    unit);
            return CLI_OK;
        }
    }
    fprintf(file, "no setting stays within %g %s\n", args->tolerance, unit);
    return CLI_EXPECT;
}

/// Fills the plan from the scene as the command line has it.
static int make_plan(const cost_args *args, const char *path, cost_plan *plan, scene_run *run)
{
    int code = scene_run_open(&args->scene, path, run);
    if (code != CLI_OK) {
        return code;
    }
    *plan = (cost_plan){ .args = &args->scene,
                         .path = path,
                         .time = run->time,
                         .dt = run->info.dt,
                         .steps = run->steps,
                         .has_exact = run->info.exact_count > 0 };
    plan->sample_steps = (plan->steps + COMPARED_MOMENTS - 1) / COMPARED_MOMENTS;
    for (int i = 0; i < args->substeps.count; i++) {
        int n = args->substeps.items[i];
        plan->reference_substeps = n > plan->reference_substeps ? n : plan->reference_substeps;
    }
    if (plan->steps < 1) {
        cli_message("%s: there is nothing to measure in %g s", run->info.name, run->time);
        return scene_run_close(run, CLI_FAILED);
    }
    return CLI_OK;
}

static int cost_command(const cli_command *command, int argc, char **argv)
{
    cost_args args = { .scene = SCENE_ARGS_INIT,
                       .solvers = 3,
                       .precisions = 3,
                       .repeat = 3,
                       .substeps = { .items = { 1, 2, 4, 8, 16, 32 }, .count = 6 },
                       .tolerance = -1 };
    cli_operands operands;
    cost_row rows[ROWS_MAX];
    cost_plan plan;
    scene_run run;

    int code = cli_parse(command, argc, argv, &args, &operands);
    code = code == CLI_OK ? scene_args_check(command, &args.scene) : code;
    code = code == CLI_OK ? make_plan(&args, operands.items[0], &plan, &run) : code;
    if (code != CLI_OK) {
        return code;
    }
    int count = list_rows(&args, rows);
    code = measure(&plan, &args, rows, count);
    if (code == CLI_OK) {
        qsort(rows, (size_t)count, sizeof rows[0], by_time);
        mark_best(rows, count);
        if (args.csv) {
            print_csv(rows, count, error_unit(&plan, &run));
        } else {
            print_head(&plan, &run, &args);
            print_table(rows, count, error_unit(&plan, &run));
        }
        if (args.tolerance >= 0) {
            code = judge(&args, rows, count, error_unit(&plan, &run), args.csv ? stderr : stdout);
        }
    }
    cost_track_free(&plan.reference);
    return scene_run_close(&run, code);
}

static const cli_option options[] = {
    { "solvers", 0, CLI_CHOICES, offsetof(cost_args, solvers), "LIST", 0, 0, ENGINE_SOLVERS,
      "which solvers (default soft,pgs)" },
    { "substeps", 0, CLI_INTS, offsetof(cost_args, substeps), "LIST", 1, 64, NULL,
      "which numbers of substeps (default 1,2,4,8,16,32)" },
    { "precisions", 0, CLI_CHOICES, offsetof(cost_args, precisions), "LIST", 0, 0, SCENE_PRECISIONS,
      "which precisions (default float,double)" },
    { "tolerance", 0, CLI_REAL, offsetof(cost_args, tolerance), "M", 0, 1e9, NULL,
      "name the cheapest setting whose error is at most M metres, or in the unit of the scene's "
      "exact{}; exit code 4 when there is none" },
    { "repeat", 0, CLI_INT, offsetof(cost_args, repeat), "N", 1, 1000, NULL,
      "runs by the clock a setting, of which the fastest counts (default 3)" },
    { "csv", 0, CLI_FLAG, offsetof(cost_args, csv), NULL, 0, 0, NULL,
      "print the table as CSV, in SI units" },
    SCENE_OPTION_TIME(cost_args, scene),
    SCENE_OPTION_DT(cost_args, scene),
    SCENE_OPTION_ITERATIONS(cost_args, scene),
    SCENE_OPTION_WIDTH(cost_args, scene),
    SCENE_OPTION_WORKERS(cost_args, scene),
    SCENE_OPTION_SET(cost_args, scene),
    SCENE_OPTION_QUIET(cost_args, scene),
};

const cli_command cmd_cost = {
    .name = "cost",
    .summary = "measures what accuracy costs: error against time for every setting",
    .operands = "SCENE",
    .text = "Runs SCENE with every solver, number of substeps and precision, and prints what error "
            "each makes and what processor time it takes (the scene's own handlers included), "
            "cheapest first, those marked (*) that nothing cheaper equals. The error is measured "
            "against the closed form that the scene declares with exact{}; without one, against "
            "the scene's own finest setting, which the table then says. Settings whose state "
            "became infinite are listed as diverged.",
    .examples = "plumb cost assets/scenes/projectile.lua\n"
                "plumb cost stack.lua --time 2 --substeps 2,4,8 --tolerance 1e-3\n"
                "plumb cost stack.lua --csv > stack.csv",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 1,
    .run = cost_command,
};
