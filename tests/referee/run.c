// run.c - scenes by engines, each in a process of its own, so that a crash or an endless step costs one cell (referee.h).
// What is measured comes back through memory that the processes share.
#define _DEFAULT_SOURCE // MAP_ANONYMOUS

#include "referee.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { JOBS_MAX = 64 };

static void copy(char *to, size_t size, const char *from)
{
    size_t length = from != NULL ? strlen(from) : 0;
    length = length < size ? length : size - 1;
    memcpy(to, from != NULL ? from : "", length);
    to[length] = '\0';
}

static void keep_lines(struct cell *cell, const engine_expect *list, int count)
{
    for (int i = 0; i < count && i < LINES_MAX; i++) {
        struct line *line = &cell->lines[cell->count++];
        copy(line->name, sizeof line->name, list[i].name[0] != '\0' ? list[i].name : list[i].text);
        copy(line->quantity, sizeof line->quantity, list[i].quantity);
        copy(line->unit, sizeof line->unit, list[i].unit);
        line->measured = list[i].measured;
        line->limit = list[i].limit;
        line->time = list[i].time;
        line->judged = list[i].reached;
        line->holds = list[i].reached && list[i].passed;
    }
}

static void judge(const struct contender *c, const struct task *task, struct cell *cell)
{
    char set[64] = "";
    const char *sets[2] = { c->set };
    int set_count = c->set != NULL;
    engine_error error = { 0 };
    engine_settings settings = { .path = task->path,
                                 .sets = sets,
                                 .solver = c->solver,
                                 .substeps = c->substeps,
                                 .iterations = c->iterations,
                                 .worst = true };
    if (task->key != NULL) {
        snprintf(set, sizeof set, "%s=%.17g", task->key, task->value);
        sets[set_count++] = set;
    }
    settings.set_count = set_count;
    engine_session *session = c->api->open(&settings, &error);
    if (session == NULL) {
        // What loads but is not brought over fails with the reason; Plumb has words for all.
        cell->status =
            error.code == CLI_FAILED && c->api != &engine_float ? CELL_LACKS : CELL_REFUSED;
        copy(cell->reason, sizeof cell->reason, error.text);
        return;
    }
    engine_info info = c->api->info(c->api->stage(session));
    long steps = lround(info.duration / info.dt);
    int code = CLI_OK;
    for (long i = 0; i < steps && code == CLI_OK && !c->api->ended(session); i++) {
        code = c->api->step(session, &error);
        code = code == CLI_OK ? c->api->check(session, &error) : code;
    }
    const engine_expect *list = NULL;
    bool lost = code == CLI_DIVERGED;
    code = code == CLI_OK ? c->api->finish(session, &error) : code;
    int count = c->api->expectations(session, &list);
    keep_lines(cell, list, count);
    for (int i = 0; i < cell->count && lost; i++) {
        cell->lines[i].holds = cell->lines[i].judged = false;
    }
    cell->status = lost                 ? CELL_LOST
                   : code == CLI_OK     ? CELL_JUDGED
                   : code == CLI_FAILED ? CELL_LACKS
                                        : CELL_REFUSED;
    copy(cell->reason, sizeof cell->reason, code == CLI_OK ? "" : error.text);
    c->api->close(session);
}

// ---------------------------------------------------------------------------------- processes

struct job {
    pid_t child;
    struct cell *cell;
};

static void end_one(struct job *jobs, int *running)
{
    int status = 0;
    pid_t child = waitpid(-1, &status, 0);
    for (int i = 0; i < *running; i++) {
        if (jobs[i].child == child) {
            if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
                jobs[i].cell->status = CELL_SLOW;
            } else if (WIFSIGNALED(status)) {
                jobs[i].cell->status = CELL_CRASHED;
            }
            jobs[i] = jobs[--*running];
            return;
        }
    }
}

static bool start_one(const struct referee *r, const struct contender *c, const struct task *task,
                      struct cell *cell, struct job *job)
{
    fflush(stdout);
    fflush(stderr);
    job->cell = cell;
    job->child = fork();
    if (job->child == 0) {
        rlim_t seconds = (rlim_t)ceil(r->limit);
        struct rlimit limit = { seconds, seconds + 5 }, no_core = { 0, 0 };
        setrlimit(RLIMIT_CPU, &limit);
        setrlimit(RLIMIT_CORE, &no_core);
        // What an engine or a scene says of itself is not asked for.
        if (freopen("/dev/null", "w", stderr) == NULL ||
            freopen("/dev/null", "w", stdout) == NULL) {
            _exit(1);
        }
        judge(c, task, cell);
        _exit(0);
    }
    return job->child > 0;
}

int referee_run(struct referee *r)
{
    size_t cells = (size_t)r->task_count * (size_t)r->contender_count;
    struct cell *shared = mmap(NULL, cells * sizeof *shared, PROT_READ | PROT_WRITE,
                               MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    struct job jobs[JOBS_MAX];
    int running = 0, most = r->jobs < JOBS_MAX ? r->jobs : JOBS_MAX;
    bool good = true;
    for (int t = 0; t < r->task_count && good; t++) {
        struct task *task = &r->tasks[t];
        task->cells = shared + (size_t)t * (size_t)r->contender_count;
        fprintf(stderr, "referee: %d of %d: %s%s\n", t + 1, r->task_count, task->path,
                task->key != NULL ? " (sweep)" : "");
        for (int c = 0; c < r->contender_count && good && !cli_interrupted(); c++) {
            if (running == most) {
                end_one(jobs, &running);
            }
            good = start_one(r, r->contenders[c], task, &task->cells[c], &jobs[running]);
            running += good;
        }
    }
    while (running > 0) {
        end_one(jobs, &running);
    }
    if (!good || cli_interrupted()) {
        cli_message(good ? "interrupted" : "cannot start a process");
        return CLI_FAILED;
    }
    return CLI_OK;
}
