/// cost_ladder.c - which settings are measured: ladders of settings that stop by themselves, or what the user lists.
///
/// A ladder turns one knob, each setting costing about twice the one before, and ends when two settings in a row made
/// no error smaller by a tenth, when the next run would take longer than the budget, or when the knob is at its end.
/// Settings that several ladders share are measured once.
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double WORTH_CLIMBING = 0.9; // an error must fall to less than so much of what it was
static const double ROUNDED = 1e-11;      // [-] of the truth: as good as rounding of a double
enum {
    FLAT_MOST = 2,
    DIVERGED_MOST = 4,
    SUBSTEPS_MOST = 64,
    ITERATIONS_MOST = 1000,
    PRECISIONS = 3
};
static const double STEP_LEAST = 1e-6, STEP_MOST = 1; // [s] as scenes allow

const char *cost_way_text(cost_way way)
{
    static const char *const texts[COST_WAYS] = { "substeps doubled", "steps halved",
                                                  "steps halved, one substep",
                                                  "iterations doubled" };
    return texts[way];
}

const char *cost_end_text(cost_end end)
{
    static const char *const texts[] = { "errors no longer fell", "rounding was reached",
                                         "the next run would exceed the budget",
                                         "no finer setting is allowed" };
    return texts[end];
}

static bool same_setting(const cost_setting *a, const cost_setting *b)
{
    return a->side == b->side && a->solver == b->solver && a->precision == b->precision &&
           a->substeps == b->substeps && a->iterations == b->iterations &&
           fabs(a->dt - b->dt) < 1e-9 * a->dt;
}

/// Measures a setting, if nobody has, and takes its first time. -1: failed, `code` says how.
static int row_of(cost_plan *plan, const cost_setting *set, int *code)
{
    for (int i = 0; i < plan->row_count; i++) {
        if (same_setting(&plan->rows[i].set, set)) {
            return i;
        }
    }
    if (plan->row_count == COST_ROWS_MAX) {
        progress_end(&plan->bar);
        cli_message("cost: more than %d settings; list fewer", COST_ROWS_MAX);
        *code = CLI_USAGE;
        return -1;
    }
    cost_row *row = &plan->rows[plan->row_count];
    *row = (cost_row){ .set = *set, .own = same_setting(set, &plan->own) };
    *code = cost_measure(plan, row);
    *code = *code == CLI_OK && !row->diverged && !row->given_up ? cost_time(plan, row) : *code;
    return *code == CLI_OK && !row->given_up ? plan->row_count++ : -1;
}

/// The setting of rung `k`; false: there is none.
static bool rung_of(const cost_ladder *ladder, const cost_plan *plan, int k, cost_setting *set)
{
    *set = ladder->base;
    if (ladder->way == COST_BY_SUBSTEPS) {
        set->substeps = k < 7 ? 1 << k : SUBSTEPS_MOST + 1;
    } else if (ladder->way == COST_BY_ITERATIONS) {
        set->iterations = k < 10 ? ladder->base.iterations << k : ITERATIONS_MOST + 1;
    } else {
        set->substeps = ladder->way == COST_BY_STEP_ALONE ? 1 : set->substeps;
        set->dt = ldexp(plan->dt, 1 - k);
    }
    return set->substeps <= SUBSTEPS_MOST && set->iterations <= ITERATIONS_MOST &&
           set->dt >= STEP_LEAST && set->dt <= STEP_MOST;
}

/// Whether a row makes an error smaller than all of the ladder before; `least` is lowered.
static bool improves(const cost_plan *plan, const cost_row *row, double *least)
{
    bool better = false;
    for (int q = 0; q < plan->quantity_count && !row->diverged; q++) {
        double error = row->error[q];
        if (error < 0) {
            continue;
        }
        // What is below what the truth itself is good for is no gain.
        double floor = fmax(plan->quantities[q].floor, row->noise[q]);
        better = better || (error < WORTH_CLIMBING * least[q] && least[q] > floor);
        least[q] = fmin(least[q], error);
    }
    return better;
}

static int climb(cost_plan *plan, cost_ladder *ladder)
{
    double least[COST_QUANTITIES_MAX];
    int code = CLI_OK, flat = 0, diverged = 0, k = 0;
    cost_setting set;
    // Where trajectories cannot be compared a setting takes an ensemble.
    int runs = !plan->has_exact && plan->horizon < plan->time ? 1 + COST_MEMBERS : 1;
    for (int q = 0; q < COST_QUANTITIES_MAX; q++) {
        least[q] = HUGE_VAL;
    }
    ladder->end = COST_RANGE;
    // A scene may take steps of a second already: the first rung, twice as long, is then left out.
    k = rung_of(ladder, plan, 0, &set) ? 0 : 1;
    for (; rung_of(ladder, plan, k, &set) && ladder->count < 48; k++) {
        const cost_row *last =
            ladder->count > 0 ? &plan->rows[ladder->rows[ladder->count - 1]] : NULL;
        if (last != NULL && 2 * last->cpu * plan->time * runs > plan->budget) {
            ladder->end = COST_BUDGET;
            break;
        }
        int row = row_of(plan, &set, &code);
        if (row < 0) {
            ladder->end = COST_BUDGET;
            return code;
        }
        ladder->rows[ladder->count++] = row;
        diverged = plan->rows[row].diverged ? diverged + 1 : 0;
        bool better = improves(plan, &plan->rows[row], least);
        flat = better ? 0 : plan->rows[row].diverged ? flat : flat + 1;
        if (flat == FLAT_MOST || diverged == DIVERGED_MOST) {
            ladder->end = COST_FLAT;
            break;
        }
        progress_update(&plan->bar, plan->ladder_count - 1 + 0.1 * fmin(ladder->count, 9));
    }
    return code;
}

/// The scene's own, as the solver and the command line have it.
static int base_of(const cost_plan *plan, int side, int solver, int precision, cost_setting *set)
{
    scene_run run;
    const cost_side *s = &plan->sides[side];
    *set = (cost_setting){ side, solver, precision, s->substeps, s->iterations, plan->dt };
    int code = cost_open(plan, set, &run);
    if (code == CLI_OK) {
        set->substeps = run.info.substeps;
        set->iterations = run.info.iterations;
        scene_run_close(&run, CLI_OK);
    }
    return code;
}

static int climb_ways(cost_plan *plan, const cost_setting *base)
{
    const cost_side *side = &plan->sides[base->side];
    int code = CLI_OK;
    row_of(plan, base, &code);
    for (int way = 0; way < COST_WAYS && code == CLI_OK; way++) {
        bool twice = way == COST_BY_STEP_ALONE && base->substeps == 1;
        if ((side->ways >> way & 1u) == 0 || twice || plan->ladder_count == COST_LADDERS_MAX) {
            continue;
        }
        cost_ladder *ladder = &plan->ladders[plan->ladder_count++];
        *ladder = (cost_ladder){ .base = *base, .way = (cost_way)way };
        code = climb(plan, ladder);
    }
    return code;
}

static int go_through_lists(cost_plan *plan, const cost_setting *base)
{
    const cost_lists *lists = &plan->lists;
    int code = CLI_OK;
    for (int i = 0; i == 0 || i < lists->substeps.count; i++) {
        for (int k = 0; k == 0 || k < lists->iterations.count; k++) {
            for (int d = 0; (d == 0 || d < lists->divide.count) && code == CLI_OK; d++) {
                cost_setting set = *base;
                set.substeps = lists->substeps.count > 0 ? lists->substeps.items[i] : set.substeps;
                set.iterations =
                    lists->iterations.count > 0 ? lists->iterations.items[k] : set.iterations;
                set.dt /= lists->divide.count > 0 ? lists->divide.items[d] : 1;
                if (set.dt < STEP_LEAST) {
                    cli_message("cost: option --divide: steps of %.3g s are shorter than %g s",
                                set.dt, STEP_LEAST);
                    return CLI_USAGE;
                }
                row_of(plan, &set, &code);
            }
        }
    }
    return code;
}

/// The least error of a ladder; huge: none.
static double least_error(const cost_plan *plan, const cost_ladder *ladder, int q)
{
    double least = HUGE_VAL;
    for (int r = 0; r < ladder->count; r++) {
        const cost_row *row = &plan->rows[ladder->rows[r]];
        least = row->diverged || row->error[q] < 0 ? least : fmin(least, row->error[q]);
    }
    return least;
}

/// Whether rounding holds the errors of a ladder: those of its sister in double are far smaller, or as small as doubles
/// get.
static bool is_rounded(const cost_plan *plan, const cost_ladder *ladder, const cost_ladder *sister)
{
    bool rounded = plan->quantity_count > 0;
    for (int q = 0; q < plan->quantity_count; q++) {
        double mine = least_error(plan, ladder, q), its = least_error(plan, sister, q);
        rounded =
            rounded && (cost_relative(&plan->quantities[q], mine) < ROUNDED || its < mine / 2);
    }
    return rounded;
}

/// Of ladders that became flat, those that met rounding.
static void tell_rounding(cost_plan *plan)
{
    for (int i = 0; i < plan->ladder_count; i++) {
        cost_ladder *ladder = &plan->ladders[i];
        for (int k = 0; k < plan->ladder_count && ladder->end == COST_FLAT; k++) {
            cost_setting base = plan->ladders[k].base;
            base.precision = ladder->base.precision;
            bool is_sister = plan->ladders[k].way == ladder->way &&
                             plan->ladders[k].base.precision == 1 &&
                             same_setting(&base, &ladder->base);
            if (is_sister && is_rounded(plan, ladder, &plan->ladders[k])) {
                ladder->end = COST_ROUNDING;
            }
        }
    }
}

/// [-] what costs so many times as much as what is as good in all is not timed again.
static const double FAR_BEHIND = 3;

static bool is_far_behind(const cost_plan *plan, const cost_row *row)
{
    const char *side = plan->sides[row->set.side].name;
    for (int i = 0; i < plan->row_count; i++) {
        const cost_row *other = &plan->rows[i];
        bool better = !other->diverged && FAR_BEHIND * other->cpu < row->cpu &&
                      strcmp(plan->sides[other->set.side].name, side) == 0;
        for (int q = 0; q < plan->quantity_count && better; q++) {
            better = other->error[q] <= row->error[q];
        }
        if (better) {
            return !row->own;
        }
    }
    return false;
}

/// Further times of all rows that may come to be on a front, in turns.
static int time_all(cost_plan *plan)
{
    int code = CLI_OK;
    progress_begin(&plan->bar, "timing", (double)plan->repeat * plan->row_count, plan->args->quiet);
    for (int r = 1; r < plan->repeat; r++) {
        for (int i = 0; i < plan->row_count && code == CLI_OK && !cli_interrupted(); i++) {
            bool skipped = plan->rows[i].diverged || is_far_behind(plan, &plan->rows[i]);
            code = skipped ? CLI_OK : cost_time(plan, &plan->rows[i]);
            progress_update(&plan->bar, (double)(r - 1) * plan->row_count + i);
        }
    }
    progress_end(&plan->bar);
    return code;
}

static int count_bits(unsigned bits)
{
    int count = 0;
    for (; bits != 0; bits &= bits - 1) {
        count++;
    }
    return count;
}

static int climb_sides(cost_plan *plan)
{
    bool listed =
        plan->lists.substeps.count + plan->lists.iterations.count + plan->lists.divide.count > 0;
    int code = CLI_OK;
    for (int side = 0; side < plan->side_count; side++) {
        if (plan->sides[side].set != NULL && !plan->has_joints) {
            continue;
        }
        for (int bit = 0; bit < 32 * PRECISIONS && code == CLI_OK; bit++) {
            int solver = bit / PRECISIONS, precision = bit % PRECISIONS;
            cost_setting base;
            if ((plan->sides[side].solver_bits >> solver & 1u) == 0 ||
                (plan->sides[side].precision_bits >> precision & 1u) == 0) {
                continue;
            }
            code = base_of(plan, side, solver, precision, &base);
            if (code == CLI_OK) {
                code = listed ? go_through_lists(plan, &base) : climb_ways(plan, &base);
            }
        }
    }
    return code;
}

int cost_climb(cost_plan *plan)
{
    double ladders = 0;
    for (int i = 0; i < plan->side_count; i++) {
        const cost_side *side = &plan->sides[i];
        ladders += count_bits(side->solver_bits) * count_bits(side->precision_bits) *
                   count_bits(side->ways);
    }
    plan->rows = calloc(COST_ROWS_MAX, sizeof *plan->rows);
    plan->ladders = calloc(COST_LADDERS_MAX, sizeof *plan->ladders);
    if (plan->rows == NULL || plan->ladders == NULL) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    progress_begin(&plan->bar, "measuring", ladders, plan->args->quiet);
    int code = climb_sides(plan);
    progress_end(&plan->bar);
    code = code == CLI_OK ? time_all(plan) : code;
    tell_rounding(plan);
    return cli_interrupted() ? CLI_FAILED : code;
}
