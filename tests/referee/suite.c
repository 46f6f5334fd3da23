// suite.c - `make stability`: hard scenes by several engines, judged by one referee that sees poses alone.
//
// Reads scenes; writes the table to stdout and, with CSV, Markdown and the charts of the sweeps, below a folder. Every
// run is a process of its own. Main program.
#define _POSIX_C_SOURCE 200809L // mkdir, isatty

#include "referee.h"

#include "harness/interrupt.h"

#include "harness/peer.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Solvers of Plumb by ENGINE_SOLVERS, of a peer by PEER_SOLVERS. At their best: what the manuals advise against what gives way:
// more substeps or shorter steps, more iterations, the stiffest contacts.
enum { SCENE = -1, EXACT = 2, USUAL = 0, STIFF = 1 };
const struct contender referee_contenders[CONTENDERS_MAX] = {
    { "Plumb", "default", "plumb", &engine_float, SCENE, 0, 0, NULL },
    { "Plumb", "16 substeps, direct joints", "plumb+", &engine_float, SCENE, 16, 0,
      "direct_joints=true" },
    { "Plumb", "exact", "exact", &engine_float, EXACT, 0, 0, NULL },
    { "Box2D 2.4.1", "8 and 3 iterations", "box2d2", &peer_box2d2, USUAL, 1, 8, NULL },
    { "Box2D 2.4.1", "240 Hz, 32 and 12, no skin", "box2d2+", &peer_box2d2, STIFF, 4, 32, NULL },
    { "Chipmunk 7", "10 iterations", "chipmunk", &peer_chipmunk, USUAL, 1, 10, NULL },
    { "Chipmunk 7", "240 Hz, 40, slop 0.1 mm", "chipmunk+", &peer_chipmunk, STIFF, 4, 40, NULL },
#ifdef PEER_BOX2D3
    { "Box2D 3", "4 substeps", "box2d3", &peer_box2d3, USUAL, 4, 1, NULL },
    { "Box2D 3", "16 substeps, stiffest", "box2d3+", &peer_box2d3, STIFF, 16, 1, NULL },
#endif
};

struct arguments {
    const char *folder, *csv, *sweeps, *engines;
    int jobs;
    double limit;
};

// Whether `key` is in the comma list; everything is in none.
static bool is_asked(const char *list, const char *key)
{
    size_t length = strlen(key);
    for (const char *at = list; at != NULL; at = strchr(at, ','), at = at != NULL ? at + 1 : NULL) {
        if (strncmp(at, key, length) == 0 && (at[length] == ',' || at[length] == '\0')) {
            return true;
        }
    }
    return list == NULL;
}

static bool find_contenders(struct referee *r, const char *list)
{
    size_t asked = 0;
    for (int i = 0; i < CONTENDERS_MAX && referee_contenders[i].api != NULL; i++) {
        if (is_asked(list, referee_contenders[i].key)) {
            r->contenders[r->contender_count++] = &referee_contenders[i];
            asked += strlen(referee_contenders[i].key) + 1;
        }
    }
    return list == NULL || asked == strlen(list) + 1; // each word of the list is one
}

static int write_file(const struct referee *r, int scenes, const char *path,
                      void (*print)(FILE *file, const struct referee *r, int count))
{
    cli_output out;
    int code = cli_output_open(&out, path);
    if (code == CLI_OK) {
        print(out.file, r, scenes);
        code = cli_output_close(&out, true);
    }
    return code;
}

static void print_report(FILE *file, const struct referee *r, int count)
{
    referee_print_summary(file, r, count, true);
    fprintf(file, "\n");
    referee_print_markdown(file, r, count);
    fprintf(file, "\nThe worst moment of each expectation; x: it does not hold; -: the engine has "
                  "no words for the "
                  "scene.\n");
}

static int write_all(const struct referee *r, int scenes, const struct arguments *a)
{
    char path[512];
    snprintf(path, sizeof path, "%.400s/table.md", a->folder);
    int code = write_file(r, scenes, path, print_report);
    snprintf(path, sizeof path, "%.400s/table.csv", a->folder);
    code = code == CLI_OK ? write_file(r, scenes, a->csv != NULL ? a->csv : path, referee_print_csv)
                          : code;
    if (code == CLI_OK && a->sweeps != NULL) {
        code = referee_sweep_draw(r, r->tasks + scenes, a->folder);
    }
    bool colour = isatty(STDOUT_FILENO) && getenv("NO_COLOR") == NULL;
    referee_print(stdout, r, scenes, colour);
    referee_print_summary(stdout, r, scenes, false);
    return code;
}

static int read_arguments(struct arguments *a, int argc, char **argv)
{
    int i = 1;
    for (; i + 1 < argc && argv[i][0] == '-'; i += 2) {
        char *end = NULL;
        double number = strtod(argv[i + 1], &end);
        bool is_number = end != argv[i + 1] && *end == '\0' && number > 0 && number <= 1e6;
        if (strcmp(argv[i], "--jobs") == 0 && is_number) {
            a->jobs = number < 1 ? 1 : (int)number;
        } else if (strcmp(argv[i], "--limit") == 0 && is_number) {
            a->limit = number;
        } else if (strcmp(argv[i], "--folder") == 0) {
            a->folder = argv[i + 1];
        } else if (strcmp(argv[i], "--csv") == 0) {
            a->csv = argv[i + 1];
        } else if (strcmp(argv[i], "--sweeps") == 0) {
            a->sweeps = argv[i + 1];
        } else if (strcmp(argv[i], "--engines") == 0) {
            a->engines = argv[i + 1];
        } else {
            return -1;
        }
    }
    return i < argc && argv[i][0] != '-' ? i : -1;
}

static int usage(void)
{
    fprintf(stderr, "usage: referee [--jobs N] [--limit S] [--engines LIST] [--folder DIR] [--csv "
                    "FILE] [--sweeps DIR] "
                    "SCENE...\n"
                    "  --jobs N        runs at a time (default 1)\n"
                    "  --limit S       processor seconds that a run may take (default 40)\n"
                    "  --engines LIST  of these:");
    for (int i = 0; i < CONTENDERS_MAX && referee_contenders[i].api != NULL; i++) {
        fprintf(stderr, "%s%s", i > 0 ? "," : " ", referee_contenders[i].key);
    }
    fprintf(stderr, " (default all)\n"
                    "  --folder DIR    where tables and charts go (default build/referee-out)\n"
                    "  --csv FILE      where the CSV goes instead\n"
                    "  --sweeps DIR    the scenes of the sweeps: they are run and drawn, too\n");
    return CLI_USAGE;
}

int main(int argc, char **argv)
{
    struct arguments a = { .folder = "build/referee-out", .jobs = 1, .limit = 40 };
    struct referee r = { 0 };
    catch_interrupts();
    int first = read_arguments(&a, argc, argv);
    if (first < 0 || !find_contenders(&r, a.engines)) {
        return usage();
    }
    if (mkdir(a.folder, 0777) != 0 && errno != EEXIST) {
        cli_message("cannot make '%s': %s", a.folder, strerror(errno));
        return CLI_FAILED;
    }
    int scenes = argc - first, points = a.sweeps != NULL ? referee_sweep_points() : 0;
    r.jobs = a.jobs;
    r.limit = a.limit;
    r.task_count = scenes + points;
    r.tasks = calloc((size_t)r.task_count, sizeof *r.tasks);
    if (r.tasks == NULL) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    for (int i = 0; i < scenes; i++) {
        r.tasks[i].path = argv[first + i];
    }
    if (points > 0) {
        referee_sweep_tasks(r.tasks + scenes, a.sweeps);
    }
    int code = referee_run(&r);
    code = code == CLI_OK ? write_all(&r, scenes, &a) : code;
    for (int t = 0; t < r.task_count && code == CLI_OK;
         t++) { // the first engine has words for every scene that is right
        const struct cell *cell = &r.tasks[t].cells[0];
        if (cell->status == CELL_REFUSED) {
            cli_message("%s", cell->reason);
            code = CLI_SCENE;
        }
    }
    free(r.tasks);
    return cli_finish(code);
}
