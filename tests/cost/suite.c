// suite.c - `make cost`: the suite of scenes with a known truth, Plumb side by side with other engines: what a simulated
// second takes where all errors are within 1 %, 1e-3, 1e-6 of the size of the truth.
//
// Reads scenes; writes the closing table to stdout and, with what each setting did and charts, below a folder. Times
// are processor times of this process; the runs of all engines on a scene take turns. Main program.
#define _POSIX_C_SOURCE 200809L // mkdir

#include "harness/interrupt.h"
#include "harness/peer.h"

#include "plumb/cost.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum {
    NAMES = 4,
    TOLERANCES = 3,
    SCENES_MAX = 128,
    REASONS_MAX = 24,
    SIDES_MAX = 8
}; // two of each engine
static const double tolerances[TOLERANCES] = { 1e-2, 1e-3, 1e-6 };
static const char *const tolerance_names[TOLERANCES] = { "1 %", "1e-3", "1e-6" };

// An engine of the table: its settings as it comes, and the stiffest ones with four times the iterations.
static const struct {
    const char *name, *key;
    const engine_api *api;
    int substeps, iterations;
    unsigned ways;
} engines[NAMES] = {
    { "Plumb", "plumb", NULL, 0, 0, 0 },
    { "Box2D 2.4.1", "box2d 2.4", &peer_box2d2, 1, 8,
      1u << COST_BY_STEP | 1u << COST_BY_ITERATIONS },
    { "Chipmunk 7", "chipmunk", &peer_chipmunk, 1, 10,
      1u << COST_BY_STEP | 1u << COST_BY_ITERATIONS },
#ifdef PEER_BOX2D3
    { "Box2D 3", "box2d 3", &peer_box2d3, 4, 1,
      1u << COST_BY_STEP | 1u << COST_BY_SUBSTEPS | 1u << COST_BY_STEP_ALONE },
#endif
};

// What came of a scene.
struct result {
    char name[64];
    double cpu[NAMES][TOLERANCES]; // [s/s] < 0: not reached
    int reason[NAMES];             // why there is nothing; -1: there is
};

struct suite {
    struct result scenes[SCENES_MAX];
    int count;
    char reasons[REASONS_MAX][128];
    int reason_count;
    int engine_count;
    double budget;
    int repeat;
    const char *folder;
};

// ------------------------------------------------------------------------------------- measuring

static int reason_of(struct suite *suite, const char *text)
{
    for (int i = 0; i < suite->reason_count; i++) {
        if (strcmp(suite->reasons[i], text) == 0) {
            return i;
        }
    }
    if (suite->reason_count < REASONS_MAX) {
        snprintf(suite->reasons[suite->reason_count++], sizeof suite->reasons[0], "%.120s", text);
    }
    return suite->reason_count - 1;
}

// -1: the engine has words for the scene.
static int try_engine(struct suite *suite, const engine_api *api, const char *path)
{
    engine_error error = { 0 };
    engine_settings settings = { .path = path, .no_expect = true };
    engine_session *session = api->open(&settings, &error);
    int reason = session == NULL ? reason_of(suite, error.text) : -1;
    api->close(session);
    return reason;
}

static int list_sides(struct suite *suite, const char *path, struct result *result,
                      cost_side sides[SIDES_MAX])
{
    const unsigned float_and_double = 3;
    char solver[32];
    unsigned solvers = 0;
    for (int i = 0; cli_member(ENGINE_SOLVERS, i, solver, sizeof solver); i++) {
        solvers |= 1u << i;
    }
    int count = cost_own_sides(solvers, float_and_double, sides);
    result->reason[0] = -1;
    for (int e = 1; e < suite->engine_count; e++) {
        result->reason[e] = try_engine(suite, engines[e].api, path);
        for (int stiff = 0; stiff < 2 && result->reason[e] < 0; stiff++) {
            sides[count++] =
                (cost_side){ .name = engines[e].key,
                             .solvers = PEER_SOLVERS,
                             .solver_bits = 1u << stiff,
                             .precision_bits = 1,
                             .ways = engines[e].ways,
                             .engine = engines[e].api,
                             .substeps = engines[e].substeps,
                             .iterations = engines[e].iterations * (stiff != 0 ? 4 : 1) };
        }
    }
    return count;
}

static void name_scene(const char *path, char *name, size_t size)
{
    const char *base = strrchr(path, '/');
    snprintf(name, size, "%s", base != NULL ? base + 1 : path);
    name[strcspn(name, ".")] = '\0';
}

static int write_scene(const struct suite *suite, const cost_plan *plan, const char *name)
{
    char path[512];
    cli_output out;
    snprintf(path, sizeof path, "%s/%s.csv", suite->folder, name);
    int code = cli_output_open(&out, path);
    if (code == CLI_OK) {
        cost_print_csv(out.file, plan, true);
        code = cli_output_close(&out, true);
    }
    snprintf(path, sizeof path, "%s/%s.svg", suite->folder, name);
    return code == CLI_OK ? cost_chart(plan, path, true) : code;
}

static int measure_scene(struct suite *suite, const char *path)
{
    struct result *result = &suite->scenes[suite->count];
    cost_side sides[SIDES_MAX];
    const scene_args args = SCENE_ARGS_INIT;
    cost_plan *plan = calloc(1, sizeof *plan);
    if (plan == NULL || suite->count == SCENES_MAX) {
        cli_message("out of memory, or more than %d scenes", SCENES_MAX);
        free(plan);
        return CLI_FAILED;
    }
    name_scene(path, result->name, sizeof result->name);
    plan->sides = sides;
    plan->side_count = list_sides(suite, path, result, sides);
    plan->budget = suite->budget;
    plan->repeat = suite->repeat;
    int code = cost_plan_open(plan, &args, path);
    code = code == CLI_OK ? cost_survey(plan) : code;
    code = code == CLI_OK ? cost_climb(plan) : code;
    if (code == CLI_OK) {
        cost_rank(plan);
        code = write_scene(suite, plan, result->name);
    }
    for (int e = 0; e < suite->engine_count; e++) {
        for (int t = 0; t < TOLERANCES && code == CLI_OK; t++) {
            const cost_row *row = cost_cheapest(plan, engines[e].key, tolerances[t], true);
            result->cpu[e][t] = row != NULL ? row->cpu : -1;
        }
    }
    suite->count += code == CLI_OK;
    cost_plan_free(plan);
    free(plan);
    return code;
}

// ------------------------------------------------------------------------------------------ tables

static double least_of(const struct suite *suite, const struct result *r, int t)
{
    double least = HUGE_VAL;
    for (int e = 0; e < suite->engine_count; e++) {
        least = r->cpu[e][t] >= 0 ? fmin(least, r->cpu[e][t]) : least;
    }
    return least;
}

static void put_cell(FILE *file, const struct suite *suite, const struct result *r, int e, int t)
{
    double cpu = r->cpu[e][t];
    if (r->reason[e] >= 0) {
        fprintf(file, " - %c |", 'a' + r->reason[e]);
    } else if (cpu < 0) {
        fprintf(file, " - |");
    } else {
        fprintf(file, cpu > least_of(suite, r, t) ? " %.3g |" : " **%.3g** |", 1e6 * cpu);
    }
}

static void put_table(FILE *file, const struct suite *suite)
{
    fprintf(file, "| scene |");
    for (int t = 0; t < TOLERANCES; t++) {
        for (int e = 0; e < suite->engine_count; e++) {
            fprintf(file, t == 0 || e > 0 ? " %s%s%s |" : " %s%s%s |",
                    e == 0 ? tolerance_names[t] : "", e == 0 ? ": " : "", engines[e].name);
        }
    }
    fprintf(file, "\n|---|");
    for (int i = 0; i < TOLERANCES * suite->engine_count; i++) {
        fprintf(file, "---|");
    }
    for (int i = 0; i < suite->count; i++) {
        fprintf(file, "\n| `%s` |", suite->scenes[i].name);
        for (int t = 0; t < TOLERANCES; t++) {
            for (int e = 0; e < suite->engine_count; e++) {
                put_cell(file, suite, &suite->scenes[i], e, t);
            }
        }
    }
    fprintf(
        file,
        "\n\nMicroseconds of processor time for a simulated second; the smallest of a tolerance "
        "in bold; -: no setting gets there.\n");
    for (int i = 0; i < suite->reason_count; i++) {
        fprintf(file, "%s%c: not brought over: %s", i > 0 ? "; " : "", 'a' + i, suite->reasons[i]);
    }
    fprintf(file, suite->reason_count > 0 ? ".\n" : "");
}

// How many scenes reach the tolerance, how often as the cheapest, and what that takes against Plumb where both do.
static void put_summary_cell(FILE *file, const struct suite *suite, int e, int t)
{
    int told = 0, reached = 0, first = 0, both = 0;
    double sum = 0;
    for (int i = 0; i < suite->count; i++) {
        const struct result *r = &suite->scenes[i];
        told += r->reason[e] < 0;
        if (r->cpu[e][t] < 0 || r->reason[e] >= 0) {
            continue;
        }
        reached++;
        first += r->cpu[e][t] <= least_of(suite, r, t);
        if (r->cpu[0][t] > 0) {
            sum += log(r->cpu[e][t] / r->cpu[0][t]);
            both++;
        }
    }
    fprintf(file, " %d of %d, first in %d", reached, told, first);
    if (e > 0 && both > 0) {
        fprintf(file, ", %.2gx in %d", exp(sum / both), both);
    }
    fprintf(file, " |");
}

static void put_summary(FILE *file, const struct suite *suite)
{
    fprintf(file, "| all errors within |");
    for (int e = 0; e < suite->engine_count; e++) {
        fprintf(file, " %s |", engines[e].name);
    }
    fprintf(file, "\n|---|");
    for (int e = 0; e < suite->engine_count; e++) {
        fprintf(file, "---|");
    }
    for (int t = 0; t < TOLERANCES; t++) {
        fprintf(file, "\n| %s |", tolerance_names[t]);
        for (int e = 0; e < suite->engine_count; e++) {
            put_summary_cell(file, suite, e, t);
        }
    }
    fprintf(file, "\n\nScenes that any setting of the engine brings there, of those that it has "
                  "words for; in how many "
                  "it is the cheapest; its time over Plumb's, geometric mean of the scenes that "
                  "both bring there.\n");
}

// ------------------------------------------------------------------------------------------ chart

static int by_value(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

// How many scenes are within a tolerance by so much time: a stair that rises from left to right. False: none.
static bool put_stair(FILE *script, const struct suite *suite, int e, int t, double last)
{
    double times[SCENES_MAX];
    int count = 0;
    for (int i = 0; i < suite->count; i++) {
        const struct result *r = &suite->scenes[i];
        if (r->reason[e] < 0 && r->cpu[e][t] >= 0) {
            times[count++] = 1e6 * r->cpu[e][t];
        }
    }
    qsort(times, (size_t)count, sizeof times[0], by_value);
    fprintf(script, "$d%d_%d << EOD\n", e, t);
    for (int i = 0; i < count; i++) {
        if (i == 0) {
            fprintf(script, "%.6g 0\n", times[i]);
        }
        fprintf(script, "%.6g %d\n", times[i], i + 1);
    }
    fprintf(script, "%.6g %d\nEOD\n", last, count);
    return count > 0;
}

static void put_chart(FILE *script, const char *path, const void *context)
{
    static const char *const hues[NAMES] = { "#1f6fb4", "#d9741a", "#8a5bb5", "#2d9d63" };
    const struct suite *suite = context;
    double low = HUGE_VAL, high = 0;
    for (int i = 0; i < suite->count * NAMES * TOLERANCES; i++) {
        double cpu =
            suite->scenes[i / (NAMES * TOLERANCES)].cpu[i / TOLERANCES % NAMES][i % TOLERANCES];
        low = cpu > 0 ? fmin(low, 1e6 * cpu) : low;
        high = fmax(high, 1e6 * cpu);
    }
    low = high > 0 ? low / 1.5 : 1;
    high = high > 0 ? high * 1.5 : 10;
    cost_put_terminal(script, path, 1200, 440);
    fprintf(script,
            "set multiplot layout 1,3 title '{/:Bold=14 What accuracy costs}{/=11    scenes of %d "
            "with all errors within a share of the truth}'\n"
            "set logscale x\nset xrange [%g:%g]\nset yrange [0:%d]\nset format x '10^{%%T}'\n"
            "set xlabel 'processor time for a simulated second [us]'\n",
            suite->count, low, high, suite->count);
    for (int t = 0; t < TOLERANCES; t++) {
        for (int e = 0; e < suite->engine_count; e++) {
            (void)put_stair(script, suite, e, t, high);
        }
        fprintf(script, "set title '{/:Bold within %s}'\nset ylabel '%s'\nplot ",
                tolerance_names[t], t == 0 ? "scenes" : "");
        for (int e = 0; e < suite->engine_count; e++) {
            fprintf(script, "%s$d%d_%d with steps lw 2.5 lc rgb '%s' title '%s'", e > 0 ? ", " : "",
                    e, t, hues[e], engines[e].name);
        }
        fprintf(script, "\n");
    }
    fprintf(script, "unset multiplot\n");
}

// -------------------------------------------------------------------------------------------- main

static int write_tables(const struct suite *suite)
{
    static const char *const names[] = { "table.md", "summary.md" };
    char path[512];
    int code = CLI_OK;
    for (int i = 0; i < 2 && code == CLI_OK; i++) {
        cli_output out;
        snprintf(path, sizeof path, "%s/%s", suite->folder, names[i]);
        code = cli_output_open(&out, path);
        if (code == CLI_OK) {
            (i == 0 ? put_table : put_summary)(out.file, suite);
            code = cli_output_close(&out, true);
        }
    }
    static const char *const charts[] = { "cost.svg", "cost.png" };
    for (int i = 0; i < 2 && code == CLI_OK; i++) {
        snprintf(path, sizeof path, "%s/%s", suite->folder, charts[i]);
        code = cost_draw(path, put_chart, suite);
    }
    put_table(stdout, suite);
    printf("\n");
    put_summary(stdout, suite);
    return code;
}

static int read_arguments(struct suite *suite, int argc, char **argv)
{
    int i = 1;
    for (; i + 1 < argc && argv[i][0] == '-'; i += 2) {
        char *end = NULL;
        double number = strtod(argv[i + 1], &end);
        bool is_number = end != argv[i + 1] && *end == '\0' && number > 0;
        if (strcmp(argv[i], "--budget") == 0 && is_number) {
            suite->budget = number;
        } else if (strcmp(argv[i], "--repeat") == 0 && is_number && number <= 1000) {
            suite->repeat = number < 1 ? 1 : (int)number;
        } else if (strcmp(argv[i], "--folder") == 0) {
            suite->folder = argv[i + 1];
        } else {
            return -1;
        }
    }
    return i < argc && argv[i][0] != '-' ? i : -1;
}

int main(int argc, char **argv)
{
    static struct suite suite = { .budget = 0.02, .repeat = 3, .folder = "build/cost" };
    catch_interrupts();
    int first = read_arguments(&suite, argc, argv);
    if (first < 0) {
        fprintf(stderr,
                "usage: cost [--budget S] [--repeat N] [--folder DIR] SCENE...\n"
                "  --budget S    processor seconds that a run may take (default 0.02)\n"
                "  --repeat N    runs by the clock of which the fastest counts (default 3)\n"
                "  --folder DIR  where tables, CSV and charts go (default build/cost)\n");
        return CLI_USAGE;
    }
    while (suite.engine_count < NAMES && engines[suite.engine_count].name != NULL) {
        suite.engine_count++;
    }
    if (mkdir(suite.folder, 0777) != 0 && errno != EEXIST) {
        cli_message("cannot make '%s': %s", suite.folder, strerror(errno));
        return CLI_FAILED;
    }
    for (int i = first; i < argc; i++) {
        fprintf(stderr, "cost: %d of %d: %s\n", i - first + 1, argc - first, argv[i]);
        int code = measure_scene(&suite, argv[i]);
        if (code != CLI_OK) {
            return code;
        }
    }
    return cli_finish(write_tables(&suite));
}
