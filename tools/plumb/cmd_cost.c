/// cmd_cost.c - `plumb cost`: what accuracy costs in time, on a scene of the user's own.
///
/// Reads the scene, writes a table (or CSV) to stdout. Cost: repeat + 1 runs of a setting, each below --budget as far
/// as it can be foreseen; without a closed form some twenty budgets more for a reference.
#include "cost.h"

#include <stdlib.h>
#include <string.h>

typedef struct cost_args {
    scene_args scene;
    unsigned solvers, precisions; ///< bits by index of choice
    cost_lists lists;
    int repeat;
    double tolerance;     ///< [unit] < 0: not given
    double budget;        ///< [s]
    const char *quantity; ///< NULL: all
    const char *chart;    ///< NULL: none
    bool csv, relative, all;
} cost_args;

/// Every member of a comma list of choices: the solvers are those that the engine has.
static const unsigned ALL = ~0u;
static const unsigned FLOAT_AND_DOUBLE = 3;

/// Only the solvers that there are.
static unsigned solvers_of(unsigned bits)
{
    unsigned there = 0;
    char name[32];
    for (int i = 0; cli_member(ENGINE_SOLVERS, i, name, sizeof name); i++) {
        there |= 1u << i;
    }
    return bits & there;
}

/// Leaves one quantity, which the user names.
static int choose_quantity(cost_plan *plan, const char *name)
{
    int slips = cli_slips(name);
    const char *near = NULL;
    for (int q = 0; q < plan->quantity_count; q++) {
        if (strcmp(plan->quantities[q].name, name) == 0) {
            plan->quantities[0] = plan->quantities[q];
            plan->quantity_count = 1;
            return CLI_OK;
        }
        near = cli_nearer(name, plan->quantities[q].name, &slips) ? plan->quantities[q].name : near;
    }
    if (near != NULL) {
        cli_message("cost: option --quantity: '%s' measures no '%.80s'; did you mean '%s'?",
                    plan->title, name, near);
    } else {
        cli_message("cost: option --quantity: '%s' measures no '%.80s'; the first quantity is '%s'",
                    plan->title, name, plan->quantities[0].name);
    }
    return CLI_USAGE;
}

/// Says which setting is the cheapest that is good enough.
static int judge(const cost_args *args, const cost_plan *plan, FILE *file)
{
    const cost_row *row = cost_cheapest(plan, NULL, args->tolerance, args->relative);
    const char *unit = args->relative ? "of the truth's size" : plan->quantities[0].unit;
    for (int q = 1; q < plan->quantity_count && !args->relative; q++) {
        unit = strcmp(plan->quantities[q].unit, unit) == 0 ? unit : "in each quantity's unit";
    }
    if (row == NULL) {
        fprintf(file, "no setting stays within %g %s\n", args->tolerance, unit);
        return CLI_EXPECT;
    }
    char words[256];
    cost_words(plan, &row->set, words, sizeof words);
    fprintf(file, "cheapest within %g %s: %s (%.4g us a second", args->tolerance, unit, words,
            1e6 * row->cpu);
    for (int q = 0; q < plan->quantity_count; q++) {
        const cost_quantity *quantity = &plan->quantities[q];
        double error = args->relative ? cost_relative(quantity, row->error[q]) : row->error[q];
        if (row->error[q] >= 0) {
            fprintf(file, ", %s %.3e", quantity->name, error);
        }
    }
    fprintf(file, ")\n");
    return CLI_OK;
}

static int report(const cost_args *args, cost_plan *plan)
{
    cost_rank(plan);
    if (args->csv) {
        cost_print_csv(stdout, plan, args->relative);
    } else {
        cost_print_table(plan, args->relative, args->all || plan->ladder_count == 0);
    }
    int code = args->chart != NULL ? cost_chart(plan, args->chart, args->relative) : CLI_OK;
    if (code == CLI_OK && args->tolerance >= 0) {
        code = judge(args, plan, args->csv ? stderr : stdout);
    }
    return code;
}

static int cost_command(const cli_command *command, int argc, char **argv)
{
    cost_args args = { .scene = SCENE_ARGS_INIT,
                       .solvers = ALL,
                       .precisions = FLOAT_AND_DOUBLE,
                       .repeat = 3,
                       .budget = 0.1,
                       .tolerance = -1 };
    cli_operands operands;
    int code = cli_parse(command, argc, argv, &args, &operands);
    code = code == CLI_OK ? scene_args_check(command, &args.scene) : code;
    code = code == CLI_OK && args.chart != NULL ? cost_chart_check(args.chart) : code;
    if (code == CLI_OK && args.chart != NULL) {
        const cli_file files[] = { { "SCENE", operands.items[0], false },
                                   { "--chart", args.chart, true } };
        code = cli_files_check(command, files, 2);
    }
    if (code != CLI_OK) {
        return code;
    }
    cost_side sides[2];
    int side_count = cost_own_sides(solvers_of(args.solvers), args.precisions, sides);
    cost_plan *plan = calloc(1, sizeof *plan); // too large for a stack
    if (plan == NULL) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    plan->sides = sides;
    plan->side_count = side_count;
    plan->lists = args.lists;
    plan->budget = args.budget;
    plan->repeat = args.repeat;
    code = cost_plan_open(plan, &args.scene, operands.items[0]);
    code = code == CLI_OK ? cost_survey(plan) : code;
    if (code == CLI_OK && args.quantity != NULL) {
        code = choose_quantity(plan, args.quantity);
    }
    code = code == CLI_OK ? cost_climb(plan) : code;
    code = code == CLI_OK ? report(&args, plan) : code;
    cost_plan_free(plan);
    free(plan);
    return code;
}

static const cli_option options[] = {
    { "solvers", 0, CLI_CHOICES, offsetof(cost_args, solvers), "LIST", 0, 0, ENGINE_SOLVERS,
      "which solvers (default: all)" },
    { "precisions", 0, CLI_CHOICES, offsetof(cost_args, precisions), "LIST", 0, 0, SCENE_PRECISIONS,
      "which precisions (default float,double)" },
    { "substeps", 0, CLI_INTS, offsetof(cost_args, lists.substeps), "LIST", 1, 64, NULL,
      "these numbers of substeps alone, and no ladders" },
    { "iterations", 0, CLI_INTS, offsetof(cost_args, lists.iterations), "LIST", 1, 1000, NULL,
      "these numbers of solver sweeps alone, and no ladders" },
    { "divide", 0, CLI_INTS, offsetof(cost_args, lists.divide), "LIST", 1, 1000000, NULL,
      "the scene's step divided by these numbers alone, and no ladders" },
    { "tolerance", 0, CLI_REAL, offsetof(cost_args, tolerance), "X", 0, 1e9, NULL,
      "name the cheapest setting whose errors are at most X, each in its unit (with --relative: "
      "over the size of the truth); exit code 4 when there is none" },
    { "quantity", 0, CLI_TEXT, offsetof(cost_args, quantity), "NAME", 0, 0, NULL,
      "measure this one alone: the name of an exact{}, or place" },
    { "relative", 0, CLI_FLAG, offsetof(cost_args, relative), NULL, 0, 0, NULL,
      "errors over the size of the truth: of places and angles the way, else the largest value" },
    { "budget", 0, CLI_REAL, offsetof(cost_args, budget), "S", 1e-6, 1e6, NULL,
      "processor seconds that a run may take; a ladder ends before one that would take more "
      "(default 0.1)" },
    { "repeat", 0, CLI_INT, offsetof(cost_args, repeat), "N", 1, 1000, NULL,
      "runs by the clock a setting, of which the fastest counts (default 3)" },
    { "chart", 0, CLI_TEXT, offsetof(cost_args, chart), "FILE", 0, 0, NULL,
      "draw errors over processor time into FILE.svg or FILE.png; needs gnuplot" },
    { "all", 0, CLI_FLAG, offsetof(cost_args, all), NULL, 0, 0, NULL,
      "show settings that are on no front, too" },
    { "csv", 0, CLI_FLAG, offsetof(cost_args, csv), NULL, 0, 0, NULL,
      "print all settings and quantities as CSV, in SI units" },
    SCENE_OPTION_TIME(cost_args, scene),
    SCENE_OPTION_DT(cost_args, scene),
    SCENE_OPTION_WIDTH(cost_args, scene),
    SCENE_OPTION_WORKERS(cost_args, scene),
    SCENE_OPTION_SET(cost_args, scene),
    SCENE_OPTION_QUIET(cost_args, scene),
};

const cli_command cmd_cost = {
    .name = "cost",
    .summary = "measures what accuracy costs: error against time for every setting",
    .operands = "SCENE",
    .text = "Runs SCENE with every solver and precision along ladders: substeps doubled, steps "
            "halved, with the scene's substeps and with one, iterations doubled. A ladder ends by "
            "itself when errors no longer fall, or the next run would exceed --budget. Prints what "
            "error each setting makes in each quantity that the scene declares with exact{}, and "
            "what processor time a simulated second takes (the scene's own handlers included), "
            "cheapest first, those marked (*) that nothing as cheap equals. Without exact{} the "
            "scene's own finest setting is the truth, as long as trajectories can be compared; "
            "beyond, means over time and an ensemble are. Settings whose state became infinite are "
            "listed as diverged.",
    .examples = "plumb cost assets/scenes/projectile.lua\n"
                "plumb cost stack.lua --time 2 --substeps 2,4,8 --tolerance 1e-3\n"
                "plumb cost assets/scenes/accuracy/kepler.lua --relative --tolerance 1e-3\n"
                "plumb cost stack.lua --csv --chart stack.svg > stack.csv",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 1,
    .operand_max = 1,
    .run = cost_command,
};
