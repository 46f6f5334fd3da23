// bench.c - the benchmark: the same scenes through several engines, side by side in one run.
// Reads: the command line. Writes: tables to stdout, progress to stderr, optionally a CSV file.
//
// For each scene the engines take turns (A B C A B C ...), so that the drift of a shared machine
// meets all of them alike; the median over the turns is what counts. See README.md.
#define _GNU_SOURCE // getopt_long, strtok_r
#include "drag.h"
#include "report.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct engine *const engines[] = {
    &engine_plumb,
#ifdef BENCH_BOX2D3
    &engine_box2d3,
#endif
    &engine_box2d2,
};

enum {
    engine_count = sizeof engines / sizeof engines[0],
    max_contenders = 16,
    max_scenes = 64,
    max_repeats = 101,
    exit_usage = 2
};

struct plan {
    struct run_settings settings;
    struct contender contenders[max_contenders];
    int contender_count;
    const struct scene_row *rows[max_scenes];
    int row_count;
    int repeats;
    int width; ///< for contenders that name none
    FILE *csv;
};

static const char usage[] =
    "usage: bench [options]\n"
    "  --scenes A,B      scenes in this order (default: the ten; --list shows all)\n"
    "  --engines X,Y     engines in this order, each name[:width][:solver][:tN]; ratios\n"
    "                    are against the first (default: all; --list shows them); t2: two threads\n"
    "  --repeats N       turns of every engine on a scene, 1..101 (default 5)\n"
    "  --steps-scale F   factor on the number of steps (default 1)\n"
    "  --substeps N      substeps of every engine; Box2D 2.4.1 takes N shorter steps\n"
    "                    (default: each its own)\n"
    "  --width N         SIMD lanes of Plumb where an engine names none (default: its choice)\n"
    "  --sleep           let bodies sleep in the scenes whose origin does\n"
    "  --clock wall|cpu  elapsed time (default), or processor time: steadier on a busy machine,\n"
    "                    but a few ms coarse on some\n"
    "  --core N          pin to this core, N threads to the N from there (default 0; -1: no)\n"
    "  --sample N        steps between measurements of penetration (default 25)\n"
    "  --quick           --repeats 1 --steps-scale 0.1\n"
    "  --drag            what drag costs by each way to have it, and nothing else (drag.c)\n"
    "  --csv FILE        write all figures there too\n"
    "  --list            list scenes and engines\n";

static _Noreturn void fail(const char *what, const char *value)
{
    fprintf(stderr, "bench: %s '%s'\n%s", what, value, usage);
    exit(exit_usage);
}

static double number(const char *option, const char *text, double low, double high)
{
    char *end = NULL;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= low && value <= high)) {
        fprintf(stderr, "bench: --%s takes a number from %g to %g, not '%s'\n", option, low, high,
                text);
        exit(exit_usage);
    }
    return value;
}

static void list_all(void)
{
    for (int i = 0; i < scene_row_count; ++i) {
        printf("scene  %-14s %4d steps  %s\n", scene_rows[i].name, scene_rows[i].steps,
               scene_rows[i].note);
    }
    for (int i = 0; i < (int)engine_count; ++i) {
        char text[256];
        engines[i]->describe(text, sizeof text);
        printf("engine %-14s %s\n", engines[i]->name, text);
    }
}

static void add_contender(struct plan *plan, char *spec)
{
    if (plan->contender_count == max_contenders) {
        fail("too many engines at", spec);
    }
    struct contender *c = &plan->contenders[plan->contender_count++];
    snprintf(c->label, sizeof c->label, "%s", spec);
    char *state = NULL;
    const char *name = strtok_r(spec, ":", &state);
    for (int i = 0; i < (int)engine_count && name != NULL; ++i) {
        if (strcmp(engines[i]->name, name) == 0) {
            c->engine = engines[i];
        }
    }
    if (c->engine == NULL) {
        fail("no such engine in this build:", c->label);
    }
    for (char *part = strtok_r(NULL, ":", &state); part != NULL;
         part = strtok_r(NULL, ":", &state)) {
        if (*part == 't' && part[1] >= '0' && part[1] <= '9') {
            if (!c->engine->has_threads) {
                fail("this engine has no threads:", c->label);
            }
            c->workers = (int)number("engines", part + 1, 1.0, 64.0);
            continue;
        }
        if (!c->engine->has_solver) {
            fail("this engine has neither widths nor solvers:", c->label);
        }
        if (*part >= '0' && *part <= '9') {
            c->width = (int)number("engines", part, 1.0, 64.0);
        } else {
            c->solver = part;
        }
    }
}

static void add_scene(struct plan *plan, const char *name)
{
    for (int i = 0; i < scene_row_count; ++i) {
        if (strcmp(scene_rows[i].name, name) == 0 && plan->row_count < max_scenes) {
            plan->rows[plan->row_count++] = &scene_rows[i];
            return;
        }
    }
    fail("no such scene:", name);
}

static const struct option long_options[] = {
    { "scenes", required_argument, NULL, 's' },   { "engines", required_argument, NULL, 'e' },
    { "repeats", required_argument, NULL, 'r' },  { "steps-scale", required_argument, NULL, 'f' },
    { "substeps", required_argument, NULL, 'u' }, { "width", required_argument, NULL, 'w' },
    { "sleep", no_argument, NULL, 'z' },          { "clock", required_argument, NULL, 'c' },
    { "core", required_argument, NULL, 'p' },     { "sample", required_argument, NULL, 'm' },
    { "quick", no_argument, NULL, 'q' },          { "drag", no_argument, NULL, 'd' },
    { "csv", required_argument, NULL, 'o' },      { "list", no_argument, NULL, 'l' },
    { "help", no_argument, NULL, 'h' },           { NULL, 0, NULL, 0 },
};

// One option. `optarg` outlives the plan: it points into argv.
static void take_option(struct plan *plan, int option)
{
    char *state = NULL;
    switch (option) {
    case 's':
        for (char *p = strtok_r(optarg, ",", &state); p != NULL; p = strtok_r(NULL, ",", &state)) {
            add_scene(plan, p);
        }
        break;
    case 'e':
        for (char *p = strtok_r(optarg, ",", &state); p != NULL; p = strtok_r(NULL, ",", &state)) {
            add_contender(plan, p);
        }
        break;
    case 'r':
        plan->repeats = (int)number("repeats", optarg, 1.0, max_repeats);
        break;
    case 'f':
        plan->settings.steps_scale = number("steps-scale", optarg, 1e-3, 1e3);
        break;
    case 'u':
        plan->settings.substeps = (int)number("substeps", optarg, 1.0, 64.0);
        break;
    case 'w':
        plan->width = (int)number("width", optarg, 0.0, 64.0);
        break;
    case 'z':
        plan->settings.sleep = true;
        break;
    case 'c':
        plan->settings.cpu_clock = strcmp(optarg, "cpu") == 0;
        if (!plan->settings.cpu_clock && strcmp(optarg, "wall") != 0) {
            fail("no such clock:", optarg);
        }
        break;
    case 'p':
        plan->settings.core = (int)number("core", optarg, -1.0, 1023.0);
        break;
    case 'm':
        plan->settings.sample_every = (int)number("sample", optarg, 1.0, 1e6);
        break;
    case 'q':
        plan->repeats = 1;
        plan->settings.steps_scale = 0.1;
        break;
    case 'o':
        plan->csv = fopen(optarg, "w");
        if (plan->csv == NULL) {
            fail("cannot write", optarg);
        }
        break;
    case 'd':
        exit(drag_report(plan->settings.core));
    case 'l':
        list_all();
        exit(0);
    case 'h':
        fputs(usage, stdout);
        exit(0);
    default:
        fputs(usage, stderr);
        exit(exit_usage);
    }
}

static void read_plan(struct plan *plan, int argc, char **argv)
{
    plan->repeats = 5;
    plan->settings.steps_scale = 1.0;
    plan->settings.sample_every = 25;
    for (int option; (option = getopt_long(argc, argv, "", long_options, NULL)) != -1;) {
        take_option(plan, option);
    }
    if (optind < argc) {
        fail("unexpected argument", argv[optind]);
    }
    for (int i = 0; i < (int)engine_count && plan->contender_count <= i; ++i) {
        char name[32];
        snprintf(name, sizeof name, "%s", engines[i]->name);
        add_contender(plan, name);
    }
    for (int i = 0; i < scene_default_count && plan->row_count <= i; ++i) {
        add_scene(plan, scene_rows[i].name);
    }
    for (int i = 0; i < plan->contender_count; ++i) {
        struct contender *c = &plan->contenders[i];
        if (c->engine->has_solver && c->width == 0) {
            c->width = plan->width;
        }
    }
}

static void progress(const struct plan *plan, const struct scene_row *row, int contender,
                     const char *what, int turn)
{
    if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r\033[K%s: %s %s %d", row->name, plan->contenders[contender].label, what,
                turn + 1);
    }
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

// The middle value; sorts.
static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, by_value);
    return count % 2 == 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

static void take_together(struct row_result *r, const struct run_result *turns, int repeats)
{
    double mean[max_repeats];
    double worst[max_repeats];
    double bytes[max_repeats];
    for (int i = 0; i < repeats; ++i) {
        mean[i] = turns[i].mean_ms;
        worst[i] = turns[i].worst_ms;
        bytes[i] = (double)turns[i].peak_bytes;
        if (turns[i].status != RUN_DONE) {
            r->status = turns[i].status;
            r->signal = turns[i].signal;
        }
    }
    r->median_ms = median(mean, repeats);
    r->min_ms = mean[0]; // sorted by now
    r->worst_ms = median(worst, repeats);
    r->peak_bytes = (long)median(bytes, repeats);
    r->engine_bytes = turns[0].engine_bytes;
}

static void bench_scene(const struct plan *plan, const struct scene_row *row,
                        struct row_result *results)
{
    struct scene scene;
    scene_build(row, &scene);
    struct run_result turns[max_contenders][max_repeats];
    for (int i = 0; i < plan->contender_count; ++i) {
        progress(plan, row, i, "quality", 0);
        results[i].quality = run_quality(row, &scene, &plan->contenders[i], &plan->settings);
        results[i].status = results[i].quality.status;
        results[i].signal = results[i].quality.signal;
    }
    for (int turn = 0; turn < plan->repeats; ++turn) {
        for (int i = 0; i < plan->contender_count; ++i) {
            progress(plan, row, i, "turn", turn);
            if (results[i].status == RUN_DONE) {
                turns[i][turn] = run_timed(row, &scene, &plan->contenders[i], &plan->settings);
            }
        }
    }
    for (int i = 0; i < plan->contender_count; ++i) {
        if (results[i].status == RUN_DONE) {
            take_together(&results[i], turns[i], plan->repeats);
        }
    }
    if (isatty(STDERR_FILENO)) {
        fputs("\r\033[K", stderr);
    }
    report_scene(row, plan->contenders, results, plan->contender_count);
    if (plan->csv != NULL) {
        report_csv_scene(plan->csv, row, plan->contenders, results, plan->contender_count);
    }
    scene_free(&scene);
}

int main(int argc, char **argv)
{
    static struct plan plan;
    read_plan(&plan, argc, argv);
    int count = plan.contender_count;
    struct row_result *results = calloc((size_t)(plan.row_count * count), sizeof *results);
    if (results == NULL) {
        fputs("bench: out of memory\n", stderr);
        return 1;
    }
    report_machine(plan.contenders, count);
    report_header();
    if (plan.csv != NULL) {
        report_csv_header(plan.csv);
    }
    for (int s = 0; s < plan.row_count; ++s) {
        bench_scene(&plan, plan.rows[s], &results[s * count]);
    }
    report_summary(plan.rows, plan.row_count, plan.contenders, results, count);
    free(results);
    return plan.csv != NULL && fclose(plan.csv) != 0 ? 1 : 0;
}
