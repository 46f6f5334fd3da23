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

/// Moments of a run at which places are compared.
enum { COMPARED_MOMENTS = 200 };
/// [-] of a step: what ends within it of a moment is there.
static const double SAME_MOMENT = 1e-3;
/// [s] runs shorter than that are timed several times in a row: the clock's own noise is some microseconds.
static const double SHORT_RUN = 2e-3;
enum { SHORT_RUNS = 5 };
/// [s] scenes that take longer to load are not loaded for that: a script may integrate its own truth.
static const double LONG_LOAD = 5e-3;

/// A run, or an ensemble of them, that takes so many budgets is given up: of settings that are looked for, not of those that the user
/// names, nor of the scene's own.
enum { BUDGETS_GIVEN_UP = 20 };

static double cpu_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int open_for(const cost_plan *plan, const cost_setting *set, bool unseen, scene_run *run)
{
    scene_args args = *plan->args;
    args.engine = plan->sides[set->side].engine;
    args.solver = set->solver;
    args.substeps = set->substeps;
    args.iterations = set->iterations;
    args.precision = set->precision;
    args.dt = set->dt;
    args.time = plan->time;
    args.no_expect = true; // looking at them is none of the scene's work
    args.unseen = unseen;
    const char *set_of_side = plan->sides[set->side].set;
    if (set_of_side != NULL && args.sets.count < CLI_TEXTS_MAX) {
        args.sets.items[args.sets.count++] = set_of_side;
    }
    return scene_run_open(&args, plan->path, run);
}

int cost_open(const cost_plan *plan, const cost_setting *set, scene_run *run)
{
    return open_for(plan, set, false, run);
}

/// Of the scene's own steps, one at the least.
static double steps_of(const cost_plan *plan)
{
    return fmax(1, ceil(plan->time / plan->dt - 1e-6));
}

/// Steps of the scene's own from one moment to the next: both are there in a run of finer steps.
static double stride_of(const cost_plan *plan)
{
    return ceil(steps_of(plan) / COMPARED_MOMENTS);
}

int cost_moments(const cost_plan *plan)
{
    return (int)(steps_of(plan) / stride_of(plan));
}

double cost_moment(const cost_plan *plan, int moment)
{
    return (moment + 1) * stride_of(plan) * plan->dt;
}

/// What is taken down on the way.
typedef struct watch {
    const cost_plan *plan;
    cost_row *row;     ///< errors of closed forms and the depth of overlaps; null: none
    cost_track *track; ///< places; null: none
    double sums[4];    ///< of the totals from the horizon on
    int sum_count;
    int moment;  ///< the next one of cost_moments
    double cpu;  ///< [s] so far
    double most; ///< [s] from which on it is given up; 0: never
} watch;

static int part_of(const cost_plan *plan, double elapsed)
{
    int part = (int)(elapsed / plan->time * COST_PARTS - 1e-9);
    return part < 0 ? 0 : part < COST_PARTS ? part : COST_PARTS - 1;
}

static void note_error(const cost_plan *plan, cost_row *row, int q, double elapsed, double error)
{
    double *part = &row->part[q][part_of(plan, elapsed)];
    row->error[q] = fmax(row->error[q], error);
    *part = fmax(*part, error);
}

static int look_at_forms(watch *w, scene_run *run, double elapsed)
{
    for (int q = 0; q < w->plan->quantity_count; q++) {
        const cost_quantity *quantity = &w->plan->quantities[q];
        engine_error error = { 0 };
        double distance = -1;
        if (quantity->kind != COST_FORM || elapsed > quantity->till) {
            continue;
        }
        int code = run->engine->form_error(run->session, quantity->form, &distance, &error);
        // The survey has asked them all at the scene's own setting: where one has no answer now, the run is lost.
        if (code != CLI_OK || isnan(distance)) {
            return cli_interrupted() ? CLI_FAILED : CLI_DIVERGED;
        }
        if (distance >= 0) {
            note_error(w->plan, w->row, q, elapsed, distance);
        }
    }
    return CLI_OK;
}

/// The places of a moment; `run` null: nobody looked. False: out of memory.
static bool keep(watch *w, const scene_run *run)
{
    w->moment++;
    return w->track == NULL || cost_track_add(w->track, run);
}

static int look(watch *w, scene_run *run, double elapsed)
{
    int code = CLI_OK;
    if (w->row != NULL) {
        // A closed form is cheap to ask and may be missed between moments: asked at every step.
        w->row->penetration =
            fmax(w->row->penetration, run->engine->stats(run->stage).max_penetration);
        code = look_at_forms(w, run, elapsed);
    }
    const double slack = SAME_MOMENT * run->info.dt;
    bool kept = true;
    while (kept &&
           cost_moment(w->plan, w->moment) < elapsed - slack) { // a long step passed it over
        kept = keep(w, NULL);
    }
    if (kept && (code != CLI_OK || cost_moment(w->plan, w->moment) > elapsed + slack)) {
        return code;
    }
    if (!kept || !keep(w, run)) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    if (elapsed > w->plan->horizon) {
        engine_totals now = run->engine->totals(run->stage);
        const double values[4] = { now.x, now.y, now.spread, now.energy };
        for (int k = 0; k < 4; k++) {
            w->sums[k] += values[k];
        }
        w->sum_count++;
    }
    return code;
}

/// Runs to the end. CLI_DIVERGED comes without a message.
static int watch_run(cost_plan *plan, scene_run *run, watch *w)
{
    int code = CLI_OK;
    const double begin = cpu_now();
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
        code = look(w, run, (double)step * run->info.dt);
        w->cpu = cpu_now() - begin;
        if (w->most > 0 && w->cpu > w->most) {
            break;
        }
    }
    return code;
}

int cost_follow(cost_plan *plan, const cost_setting *set, double nudge, unsigned seed,
                cost_track *track)
{
    scene_run run;
    watch w = { .plan = plan, .track = track };
    int code = cost_open(plan, set, &run);
    if (code != CLI_OK) {
        return code;
    }
    if (nudge > 0) {
        run.engine->nudge(run.session, nudge, seed);
    }
    return scene_run_close(&run, watch_run(plan, &run, &w));
}

/// [m] a start of an ensemble is moved by so much: far above rounding, far below what matters.
static const double ENSEMBLE_NUDGE = 1e-6;

int cost_ensemble(cost_plan *plan, const cost_setting *set, double mean[4], double error[4])
{
    double sums[4] = { 0 }, squares[4] = { 0 };
    for (unsigned member = 0; member < COST_MEMBERS; member++) {
        scene_run run;
        watch w = { .plan = plan };
        int code = cost_open(plan, set, &run);
        if (code != CLI_OK) {
            return code;
        }
        if (member > 0) {
            run.engine->nudge(run.session, ENSEMBLE_NUDGE, member);
        }
        code = scene_run_close(&run, watch_run(plan, &run, &w));
        if (code != CLI_OK) {
            return code;
        }
        for (int k = 0; k < 4; k++) {
            double value = w.sum_count > 0 ? w.sums[k] / w.sum_count : 0;
            sums[k] += value;
            squares[k] += value * value;
        }
    }
    for (int k = 0; k < 4; k++) {
        mean[k] = sums[k] / COST_MEMBERS;
        double variance = fmax(squares[k] / COST_MEMBERS - mean[k] * mean[k], 0);
        error[k] = sqrt(variance / (COST_MEMBERS - 1));
    }
    return CLI_OK;
}

/// Compares the ensemble of a row with that of the reference.
static int measure_ensemble(cost_plan *plan, cost_row *row)
{
    double mean[4], error[4];
    const double *truth = plan->means;
    int code = cost_ensemble(plan, &row->set, mean, error);
    for (int q = 0; q < plan->quantity_count && code == CLI_OK; q++) {
        int kind = plan->quantities[q].kind;
        if (kind == COST_CENTRE) {
            row->error[q] = hypot(mean[0] - truth[0], mean[1] - truth[1]);
            row->noise[q] = hypot(hypot(error[0], error[1]), hypot(truth[4], truth[5]));
        } else if (kind == COST_SPREAD || kind == COST_ENERGY) {
            int k = kind == COST_SPREAD ? 2 : 3;
            row->error[q] = fabs(mean[k] - truth[k]);
            row->noise[q] = hypot(error[k], truth[4 + k]);
        }
    }
    return code;
}

static void measure_places(const cost_plan *plan, const cost_track *track, cost_row *row)
{
    for (int q = 0; q < plan->quantity_count; q++) {
        for (int m = 0; m < cost_track_moments(track) && plan->quantities[q].kind == COST_PLACES;
             m++) {
            double elapsed = cost_moment(plan, m);
            double distance = cost_track_distance(plan->reference, track, m);
            if (elapsed <= plan->horizon + 1e-9 && distance >= 0) {
                note_error(plan, row, q, elapsed, distance);
            }
        }
    }
}

int cost_measure(cost_plan *plan, cost_row *row)
{
    scene_run run;
    for (int q = 0; q < plan->quantity_count; q++) {
        row->error[q] = -1;
        for (int k = 0; k < COST_PARTS; k++) {
            row->part[q][k] = -1;
        }
    }
    watch w = { .plan = plan, .row = row, .track = plan->has_exact ? NULL : cost_track_new() };
    if (w.track == NULL && !plan->has_exact) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    const cost_lists *lists = &plan->lists;
    const bool asked =
        lists->substeps.count + lists->iterations.count + lists->divide.count > 0 || row->own;
    w.most = asked ? 0 : BUDGETS_GIVEN_UP * plan->budget;
    int code = cost_open(plan, &row->set, &run);
    if (code == CLI_OK) {
        code = scene_run_close(&run, watch_run(plan, &run, &w));
    }
    const bool ensemble = w.track != NULL && plan->horizon < plan->time;
    row->given_up =
        code == CLI_OK && w.most > 0 && w.cpu * (ensemble ? 1 + COST_MEMBERS : 1) > w.most;
    if (code == CLI_OK && w.track != NULL && !row->given_up) {
        measure_places(plan, w.track, row);
        code = plan->horizon < plan->time ? measure_ensemble(plan, row) : CLI_OK;
    }
    cost_track_free(w.track);
    row->diverged = code == CLI_DIVERGED;
    return row->diverged ? CLI_OK : code;
}

static int by_value(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

/// Keeps a time; the least and the median follow.
static void add_sample(cost_row *row, double cpu)
{
    double sorted[COST_SAMPLES_MAX];
    int place = row->sample_count < COST_SAMPLES_MAX ? row->sample_count++ : COST_SAMPLES_MAX - 1;
    row->samples[place] = cpu;
    for (int i = 0; i < row->sample_count; i++) {
        sorted[i] = row->samples[i];
    }
    qsort(sorted, (size_t)row->sample_count, sizeof sorted[0], by_value);
    row->cpu = row->sample_count == 1 ? cpu : fmin(row->cpu, cpu);
    row->jitter = sorted[row->sample_count / 2] - row->cpu;
}

int cost_time(cost_plan *plan, cost_row *row)
{
    double spent = 0, loading = 0, least = HUGE_VAL;
    for (int i = 0; i < SHORT_RUNS && spent < SHORT_RUN && loading < LONG_LOAD; i++) {
        scene_run run;
        engine_error error = { 0 };
        double begin = cpu_now();
        int code = open_for(plan, &row->set, true, &run);
        if (code != CLI_OK) {
            return code;
        }
        loading = cpu_now() - begin;
        begin = cpu_now();
        long long step = 0;
        for (; step < run.steps && code == CLI_OK && !run.engine->ended(run.session); step++) {
            code = run.engine->step(run.session, &error);
        }
        double cpu = cpu_now() - begin;
        if (code != CLI_OK) {
            progress_end(&plan->bar);
            return scene_run_close(&run, scene_report(&error));
        }
        spent += cpu;
        least = fmin(least, cpu / ((double)(step > 0 ? step : 1) * run.info.dt));
        scene_run_close(&run, CLI_OK);
    }
    add_sample(row, least);
    return CLI_OK;
}
