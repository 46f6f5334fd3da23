/// cost.c - runs a scene with one setting: how far from the truth, in how much processor time.
///
/// Reads the scene; the clock is that of the process (user and system time of all threads), so
/// that what else runs on the machine counts little. Errors and times are taken in runs of their
/// own: looking at bodies between steps would cost time and warm other caches.
#define _POSIX_C_SOURCE 200809L // clock_gettime

#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

/// A body at a moment, found again by its name.
struct cost_point {
    unsigned long long name; ///< hash
    double x, y;             ///< [m]
};

static double cpu_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double cost_work(double steps, int substeps)
{
    return steps * (substeps + 2);
}

/// FNV-1a, 64 bits: http://www.isthe.com/chongo/tech/comp/fnv/
static unsigned long long hash_name(const char *name)
{
    unsigned long long hash = 14695981039346656037ull;
    for (; *name != '\0'; name++) {
        hash = (hash ^ (unsigned char)*name) * 1099511628211ull;
    }
    return hash;
}

void cost_track_free(cost_track *track)
{
    free(track->points);
    free(track->ends);
    *track = (cost_track){ 0 };
}

/// Appends the moving bodies as they are now. False: out of memory.
static bool track_add(cost_track *track, const scene_run *run)
{
    const engine_row *rows;
    int count = run->engine->rows(run->stage, &rows);
    if (count < 0) {
        return false;
    }
    if (track->count + (size_t)count > track->room) {
        size_t room = 2 * (track->count + (size_t)count);
        struct cost_point *grown = realloc(track->points, room * sizeof *grown);
        if (grown == NULL) {
            return false;
        }
        track->points = grown;
        track->room = room;
    }
    if (track->moments == track->moment_room) {
        int room = 2 * track->moment_room + 64;
        size_t *grown = realloc(track->ends, (size_t)room * sizeof *grown);
        if (grown == NULL) {
            return false;
        }
        track->ends = grown;
        track->moment_room = room;
    }
    for (int i = 0; i < count; i++) {
        if (rows[i].moves) {
            track->points[track->count++] =
                (struct cost_point){ hash_name(rows[i].name), rows[i].x, rows[i].y };
        }
    }
    track->ends[track->moments++] = track->count;
    return true;
}

/// The largest distance of two tracks; -1 when no body is in both. A body that only one of them
/// still has cannot be compared.
static double track_distance(const cost_track *a, const cost_track *b)
{
    double worst = -1;
    int moments = a->moments < b->moments ? a->moments : b->moments;
    for (int m = 0; m < moments; m++) {
        size_t a_begin = m > 0 ? a->ends[m - 1] : 0, b_begin = m > 0 ? b->ends[m - 1] : 0;
        size_t b_count = b->ends[m] - b_begin;
        for (size_t i = a_begin; i < a->ends[m]; i++) {
            // Bodies come in the same order; the search goes far only after one has vanished.
            for (size_t k = 0; k < b_count; k++) {
                const struct cost_point *p = &a->points[i];
                const struct cost_point *q = &b->points[b_begin + (i - a_begin + k) % b_count];
                if (p->name == q->name) {
                    worst = fmax(worst, hypot(p->x - q->x, p->y - q->y));
                    break;
                }
            }
        }
    }
    return worst;
}

static int open_row(const cost_plan *plan, int solver, int substeps, int precision, double dt,
                    scene_run *run)
{
    scene_args args = *plan->args;
    args.solver = solver;
    args.substeps = substeps;
    args.precision = precision;
    args.dt = dt;
    args.no_expect = true; // looking at them is none of the scene's work
    return scene_run_open(&args, plan->path, run);
}

/// Compares with the closed form now.
static int feed_exact(scene_run *run, cost_row *row)
{
    engine_error error = { 0 };
    double distance;
    int code = run->engine->exact(run->session, &distance, &error);
    if (code != CLI_OK) {
        return scene_report(&error);
    }
    row->error = fmax(row->error, distance);
    return CLI_OK;
}

/// Runs to the end, sampling every `sample` steps into `track` (may be null), the closed form at
/// each into `row` (may be null). CLI_DIVERGED comes without a message.
static int follow(cost_plan *plan, scene_run *run, long long sample, int substeps,
                  cost_track *track, cost_row *row)
{
    double before = plan->work;
    int code = CLI_OK;
    for (long long step = 1; step <= run->steps && code == CLI_OK; step++) {
        engine_error error = { 0 };
        if (cli_interrupted()) {
            return CLI_FAILED;
        }
        code = run->engine->step(run->session, &error);
        code = code == CLI_OK ? run->engine->check(run->session, &error) : code;
        if (code != CLI_OK) {
            if (code != CLI_DIVERGED) {
                progress_end(&plan->bar);
                scene_report(&error);
            }
            return code;
        }
        if (run->engine->ended(run->session)) {
            break;
        }
        if (row != NULL) {
            row->penetration =
                fmax(row->penetration, run->engine->stats(run->stage).max_penetration);
        }
        if (step % sample == 0 || step == run->steps) {
            if (track != NULL && !track_add(track, run)) {
                cli_message("out of memory");
                return CLI_FAILED;
            }
            if (row != NULL && plan->has_exact) {
                code = feed_exact(run, row);
            }
        }
        plan->work = before + cost_work((double)step, substeps);
        progress_update(&plan->bar, plan->work);
    }
    return code;
}

static int refer_once(cost_plan *plan, int finer, cost_track *track)
{
    scene_run run;
    const int soft = 0, is_double = 1;
    int code = open_row(plan, soft, plan->reference_substeps, is_double, plan->dt / finer, &run);
    if (code != CLI_OK) {
        return code;
    }
    run.steps = plan->steps * finer;
    code = follow(plan, &run, plan->sample_steps * finer, plan->reference_substeps, track, NULL);
    if (code == CLI_DIVERGED) {
        progress_end(&plan->bar);
        cli_message("%s: the reference (soft, double, %d substeps, steps of %.3g s) diverged",
                    run.info.name, plan->reference_substeps, plan->dt / finer);
    }
    return scene_run_close(&run, code);
}

int cost_refer(cost_plan *plan)
{
    cost_track coarse = { 0 };
    int code = refer_once(plan, COST_REFERENCE_FINER, &plan->reference);
    code = code == CLI_OK ? refer_once(plan, COST_REFERENCE_FINER / 2, &coarse) : code;
    if (code == CLI_OK) {
        plan->reference_error = track_distance(&plan->reference, &coarse);
    }
    cost_track_free(&coarse);
    return code;
}

int cost_measure(cost_plan *plan, cost_row *row)
{
    scene_run run;
    cost_track track = { 0 };

    row->error = -1;
    int code = open_row(plan, row->solver, row->substeps, row->precision, plan->dt, &run);
    if (code != CLI_OK) {
        return code;
    }
    run.steps = plan->steps;
    // The closed form is cheap to ask and may be missed between moments: ask at every step.
    code = follow(plan, &run, plan->has_exact ? 1 : plan->sample_steps, row->substeps,
                  plan->has_exact ? NULL : &track, row);
    row->diverged = code == CLI_DIVERGED;
    if (code == CLI_OK && !plan->has_exact) {
        row->error = track_distance(&plan->reference, &track);
    }
    cost_track_free(&track);
    return scene_run_close(&run, row->diverged ? CLI_OK : code);
}

int cost_time(cost_plan *plan, cost_row *row)
{
    scene_run run;
    engine_error error = { 0 };
    int code = open_row(plan, row->solver, row->substeps, row->precision, plan->dt, &run);
    if (code != CLI_OK) {
        return code;
    }
    double begin = cpu_now();
    long long step = 0;
    for (; step < plan->steps && code == CLI_OK && !run.engine->ended(run.session); step++) {
        code = run.engine->step(run.session, &error);
    }
    double cpu = (cpu_now() - begin) / ((double)step * plan->dt);
    if (code != CLI_OK) {
        progress_end(&plan->bar);
        return scene_run_close(&run, scene_report(&error));
    }
    row->cpu = fmin(row->cpu, cpu);
    plan->work += cost_work((double)plan->steps, row->substeps);
    progress_update(&plan->bar, plan->work);
    return scene_run_close(&run, CLI_OK);
}
