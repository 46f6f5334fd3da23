/// cost_truth.c - what there is to compare with: closed forms, else the scene's own finest setting; and up to when.
///
/// Up to when is told by a twin: the same run from a start that is moved by a billionth of the scene's size. Where
/// the two have come apart by a factor of 1e5, what rounding does to a float (1e-7) has become a part in a hundred:
/// from there on trajectories say nothing, and means over time and an ensemble are compared instead.
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double NUDGE = 1e-9;             // of the scene's size
static const double GROWTH_MOST = 1e5;        // [-]
static const double REFERENCE_WANDERS = 0.05; // of the longest way
static const double BUDGETS_MOST = 20;        // that the reference may take
enum { FINEST = 16 };                         // steps in one of the scene's, and substeps of each
enum { SOFT = 0, DOUBLE = 1 };
/// What the soft solver is called where joints are solved directly.
#define DIRECT_NAME "direct"

static int out_of_memory(void)
{
    cli_message("out of memory");
    return CLI_FAILED;
}

/// [m] of the box around what moves.
static double size_of(const scene_run *run)
{
    engine_box moving = { 0 }, fixed = { 0 };
    run->engine->bounds(run->stage, INFINITY, &moving, &fixed);
    double size = hypot(moving.max_x - moving.min_x, moving.max_y - moving.min_y);
    return moving.max_x >= moving.min_x && isfinite(size) ? fmax(size, 1e-3) : 1;
}

static void add_quantity(cost_plan *plan, const cost_quantity *quantity)
{
    if (plan->quantity_count < COST_QUANTITIES_MAX) {
        plan->quantities[plan->quantity_count++] = *quantity;
    } else if (plan->quantity_count == COST_QUANTITIES_MAX) {
        cli_message("warning: %s: more than %d closed forms; the rest is not measured", plan->title,
                    COST_QUANTITIES_MAX);
    }
}

// --------------------------------------------------------------------------------- closed forms

static int list_forms(cost_plan *plan, scene_run *run)
{
    for (int i = 0; i < run->info.exact_count; i++) {
        engine_form form;
        engine_error error = { 0 };
        int code = run->engine->form(run->session, i, &form, &error);
        if (code != CLI_OK) {
            return scene_report(&error);
        }
        cost_quantity quantity = { .kind = COST_FORM, .form = i, .till = HUGE_VAL };
        snprintf(quantity.name, sizeof quantity.name, "%s",
                 form.name[0] != '\0'        ? form.name
                 : run->info.exact_count > 1 ? "form"
                                             : "exact");
        if (form.name[0] == '\0' && run->info.exact_count > 1) {
            snprintf(quantity.name, sizeof quantity.name, "form %d", i + 1);
        }
        snprintf(quantity.unit, sizeof quantity.unit, "%s", form.unit);
        add_quantity(plan, &quantity);
    }
    return CLI_OK;
}

/// Least and largest of what a form has said.
typedef struct range {
    double low[2], high[2];
    engine_form form;
    bool seen;
} range;

static int widen(scene_run *run, const cost_quantity *quantity, range *r)
{
    engine_error error = { 0 };
    double distance;
    int code = run->engine->form_error(run->session, quantity->form, &distance, &error);
    if (code == CLI_OK && distance >= 0) { // it holds now
        code = run->engine->form(run->session, quantity->form, &r->form, &error);
        for (int k = 0; k < 2; k++) {
            double value = r->form.value[k];
            r->low[k] = r->seen ? fmin(r->low[k], value) : value;
            r->high[k] = r->seen ? fmax(r->high[k], value) : value;
        }
        r->seen = true;
    }
    return code == CLI_OK ? CLI_OK : scene_report(&error);
}

/// Size of the truth: of a place or an angle the way, of all else the largest value. What the author has divided by a
/// scale is relative already; what is to be 0 has no size.
static double extent_of(const range *r)
{
    double way = hypot(r->high[0] - r->low[0], r->high[1] - r->low[1]);
    double largest =
        hypot(fmax(fabs(r->low[0]), fabs(r->high[0])), fmax(fabs(r->low[1]), fabs(r->high[1])));
    return !r->seen ? 0 : r->form.is_scaled ? 1 : r->form.is_place ? way : largest;
}

/// One run at the scene's own setting, to see how large the truth is.
static int survey_forms(cost_plan *plan, const cost_setting *own)
{
    scene_run run;
    range ranges[COST_QUANTITIES_MAX] = { 0 };
    int code = cost_open(plan, own, &run);
    if (code != CLI_OK) {
        return code;
    }
    code = list_forms(plan, &run);
    for (long long step = 0; step < run.steps && code == CLI_OK && !cli_interrupted(); step++) {
        engine_error error = { 0 };
        code = run.engine->step(run.session, &error);
        if (code != CLI_OK) {
            code = code == CLI_DIVERGED ? code : scene_report(&error);
            break;
        }
        for (int q = 0; q < plan->quantity_count && code == CLI_OK; q++) {
            code = widen(&run, &plan->quantities[q], &ranges[q]);
        }
        if (run.engine->ended(run.session)) {
            break;
        }
    }
    for (int q = 0; q < plan->quantity_count; q++) {
        plan->quantities[q].extent = extent_of(&ranges[q]);
        if (plan->horizon < plan->time && ranges[q].form.is_motion) {
            plan->quantities[q].till = plan->horizon;
        }
    }
    code = code == CLI_DIVERGED ? CLI_OK : code;
    return scene_run_close(&run, cli_interrupted() ? CLI_FAILED : code);
}

// ---------------------------------------------------------------------------------------- twins

/// When a twin of `track` has come apart from it by GROWTH_MOST.
static void find_horizon(cost_plan *plan, const cost_track *track, const cost_track *twin,
                         double nudge)
{
    plan->horizon = plan->time;
    for (int m = 0; m < cost_track_moments(track); m++) {
        double distance = cost_track_distance(track, twin, m);
        if (distance > GROWTH_MOST * nudge) {
            plan->horizon = cost_moment(plan, m - 1);
            break;
        }
        plan->growth = fmax(plan->growth, distance / nudge);
    }
}

/// Runs `set` twice from starts that are a billionth apart; `track` gets the first run.
static int run_twins(cost_plan *plan, const cost_setting *set, double nudge, cost_track *track)
{
    cost_track *twin = cost_track_new();
    if (twin == NULL || track == NULL) {
        cost_track_free(twin);
        return out_of_memory();
    }
    plan->horizon = plan->time;
    int code = cost_follow(plan, set, 0, 0, track);
    code = code == CLI_OK ? cost_follow(plan, set, nudge, 0, twin) : code;
    if (code == CLI_OK) {
        find_horizon(plan, track, twin, nudge);
    }
    cost_track_free(twin);
    return code;
}

// ------------------------------------------------------------------------------- own finest setting

/// Places are compared as long as the reference itself stays where it is when its step is doubled.
static void trust(cost_plan *plan, const cost_track *coarse)
{
    double way = cost_track_way(plan->reference);
    for (int m = 0; m < cost_track_moments(coarse); m++) {
        double elapsed = cost_moment(plan, m - 1);
        if (cost_track_distance(plan->reference, coarse, m) > REFERENCE_WANDERS * way &&
            elapsed < plan->horizon) {
            plan->horizon = elapsed;
            plan->is_wandering = true;
        }
    }
}

static int tell_divergence(cost_plan *plan, const cost_setting *set)
{
    progress_end(&plan->bar);
    cli_message("%s: the reference (soft, double, %d substeps, steps of %.3g s) diverged",
                plan->title, set->substeps, set->dt);
    return CLI_DIVERGED;
}

static int refer(cost_plan *plan, const cost_setting *finest, double nudge, double size)
{
    cost_track *coarse = cost_track_new();
    cost_setting half = *finest;
    half.dt *= 2;
    int code = run_twins(plan, finest, nudge, plan->reference);
    if (code == CLI_DIVERGED) {
        progress_end(&plan->bar);
        cli_message("%s: the reference (soft, double, %d substeps, steps of %.3g s) diverged",
                    plan->title, finest->substeps, finest->dt);
    }
    code = code != CLI_OK   ? code
           : coarse != NULL ? cost_follow(plan, &half, 0, 0, coarse)
                            : out_of_memory();
    if (code == CLI_OK) {
        trust(plan, coarse);
        cost_quantity places = { .kind = COST_PLACES, .name = "place", .unit = "m" };
        places.till = plan->horizon;
        places.extent = fmax(cost_track_way(plan->reference), 1e-3 * size);
        for (int m = 0; m < cost_track_moments(coarse); m++) {
            bool comparable = cost_moment(plan, m) <= plan->horizon + 1e-9;
            double distance = cost_track_distance(plan->reference, coarse, m);
            places.floor = comparable ? fmax(places.floor, distance) : places.floor;
        }
        add_quantity(plan, &places);
    }
    cost_track_free(coarse);
    return code;
}

/// What is compared beyond the horizon.
static int refer_ensemble(cost_plan *plan, const cost_setting *finest, double size)
{
    // Of the ensemble it is the means that count: a quarter of the work does for each member.
    cost_setting set = *finest;
    set.dt = fmin(plan->dt, 4 * set.dt);
    int code = cost_ensemble(plan, &set, plan->means, plan->means + 4);
    const double *m = plan->means, *e = plan->means + 4;
    add_quantity(plan, &(cost_quantity){ COST_CENTRE, 0, "centre", "m", size, plan->time,
                                         hypot(e[0], e[1]) });
    add_quantity(plan, &(cost_quantity){ COST_SPREAD, 0, "spread", "m", size, plan->time, e[2] });
    add_quantity(plan,
                 &(cost_quantity){ COST_ENERGY, 0, "energy", "J", fabs(m[3]), plan->time, e[3] });
    return code;
}

/// The scene's own finest setting, as fine as a few budgets of processor time allow.
static int survey_finest(cost_plan *plan, const cost_setting *own, double nudge, double size)
{
    cost_row probe = { .set = *own, .own = true };
    probe.set.solver = SOFT;
    probe.set.precision = DOUBLE;
    // Before the clock: what diverges may be an error in the scene's code a step later.
    int code = cost_measure(plan, &probe);
    if (code != CLI_OK || probe.diverged) {
        return code != CLI_OK ? code : tell_divergence(plan, &probe.set);
    }
    code = cost_time(plan, &probe);
    int finer = FINEST, substeps = own->substeps > FINEST ? own->substeps : FINEST;
    double run = probe.cpu * plan->time / (own->substeps + 2) * (substeps + 2);
    while (finer > 2 && run * finer > BUDGETS_MOST * plan->budget) {
        finer /= 2;
    }
    cost_setting finest = probe.set;
    finest.substeps = substeps;
    finest.dt = fmax(plan->dt / finer, 1e-6);
    plan->reference_substeps = substeps;
    plan->reference_dt = finest.dt;
    plan->reference = cost_track_new();
    code = code == CLI_OK ? refer(plan, &finest, nudge, size) : code;
    if (code == CLI_OK && plan->horizon < plan->time) {
        code = refer_ensemble(plan, &finest, size);
    }
    return code;
}

int cost_own_sides(unsigned solver_bits, unsigned precision_bits, cost_side sides[2])
{
    sides[0] = (cost_side){ .name = "plumb",
                            .solvers = ENGINE_SOLVERS,
                            .solver_bits = solver_bits,
                            .precision_bits = precision_bits,
                            .ways = (1u << COST_WAYS) - 1 };
    sides[1] = sides[0];
    sides[1].solvers = DIRECT_NAME;
    sides[1].set = "direct_joints=true";
    sides[1].solver_bits &= 1u << SOFT; // the only solver that knows it
    return 2;
}

int cost_plan_open(cost_plan *plan, const scene_args *args, const char *path)
{
    scene_run run;
    int code = scene_run_open(args, path, &run);
    if (code != CLI_OK) {
        return code;
    }
    plan->args = args;
    plan->path = path;
    plan->time = run.time;
    plan->dt = run.info.dt;
    plan->own = (cost_setting){
        0, run.info.solver, args->precision, run.info.substeps, run.info.iterations, run.info.dt
    };
    plan->has_joints = run.info.joint_count > 0;
    snprintf(plan->title, sizeof plan->title, "%s", run.info.name);
    if (run.steps < 1) {
        cli_message("%s: there is nothing to measure in %g s", run.info.name, run.time);
        return scene_run_close(&run, CLI_FAILED);
    }
    return scene_run_close(&run, CLI_OK);
}

int cost_survey(cost_plan *plan)
{
    const cost_setting own = plan->own;
    cost_setting twin = own;
    scene_run run;
    int code = cost_open(plan, &own, &run);
    if (code != CLI_OK) {
        return code;
    }
    double size = size_of(&run), nudge = NUDGE * size;
    plan->has_exact = run.info.exact_count > 0;
    plan->horizon = plan->time;
    scene_run_close(&run, CLI_OK);
    if (!plan->has_exact) {
        return survey_finest(plan, &own, nudge, size);
    }
    cost_track *track = cost_track_new();
    twin.precision = DOUBLE; // a float does not see so small a difference
    code = run_twins(plan, &twin, nudge, track);
    cost_track_free(track);
    if (code == CLI_DIVERGED) {
        plan->horizon = plan->time;
        code = CLI_OK;
    }
    return code == CLI_OK ? survey_forms(plan, &own) : code;
}

void cost_plan_free(cost_plan *plan)
{
    cost_track_free(plan->reference);
    free(plan->rows);
    free(plan->ladders);
}
