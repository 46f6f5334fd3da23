/// cost_print.c - what `plumb cost` has measured, as a table for people and as CSV for programs.
#include "cost.h"

#include <math.h>
#include <string.h>

enum { COLUMNS_MAX = 4, TIMED_ROWS = 6 };

static void name_of(const char *list, int index, char *out, size_t size)
{
    if (!cli_member(list, index, out, size)) {
        out[0] = '\0';
    }
}

void cost_words(const cost_plan *plan, const cost_setting *set, char *text, size_t size)
{
    char solver[32], precision[16];
    const cost_side *side = &plan->sides[set->side];
    name_of(side->engine == NULL ? ENGINE_SOLVERS : side->solvers, set->solver, solver,
            sizeof solver);
    name_of(SCENE_PRECISIONS, set->precision, precision, sizeof precision);
    snprintf(text, size, "--solver %s --dt %.17g --substeps %d --iterations %d --precision %s%s%s",
             solver, set->dt, set->substeps, set->iterations, precision,
             side->set != NULL ? " --set " : "", side->set != NULL ? side->set : "");
}

// ---------------------------------------------------------------------------------------- table

static double shown(const cost_quantity *quantity, double error, bool relative)
{
    return relative && error >= 0 ? cost_relative(quantity, error) : error;
}

static const char *unit_of(const cost_quantity *quantity, bool relative)
{
    return relative && quantity->extent > 0 ? "1" : quantity->unit;
}

static void print_truth(const cost_plan *plan)
{
    bool all = plan->horizon >= plan->time;
    if (plan->has_exact) {
        printf("error: largest deviation from the scene's closed form, at every step\n");
    } else {
        printf("error: largest distance of a body from the scene's own finest setting, for the\n"
               "       scene has no closed form (soft, double, %d substeps, steps of %.3g s)\n",
               plan->reference_substeps, plan->reference_dt);
        printf("       which moves by %.2g m when its step is doubled: smaller errors say "
               "little\n",
               plan->quantities[0].floor);
    }
    if (all) {
        printf("trajectories can be compared to the end: a difference at the start grows %.2g "
               "times\n",
               plan->growth);
    } else {
        printf("trajectories can be compared up to %.4g s: beyond, %s\n", plan->horizon,
               plan->is_wandering ? "the reference itself moves by a twentieth of its way"
                                  : "a difference at the start has grown 1e5 times");
    }
    if (!all && plan->has_exact) {
        printf(
            "       so motion is compared up to there; what the scene measures itself, always\n");
    } else if (!all) {
        printf("       from there on, means over time of %d runs each whose starts differ by 1e-6 "
               "m;\n       of those, errors below their noise are none\n",
               (int)COST_MEMBERS);
    }
}

static void print_head(const cost_plan *plan)
{
    printf("%s: %.6g s in steps of %.6g s; times are the least of %d run%s, +- to their median\n",
           plan->title, plan->time, plan->dt, plan->repeat, plan->repeat == 1 ? "" : "s");
    print_truth(plan);
    if (plan->quantity_count > COLUMNS_MAX) {
        printf("shown are %d of %d quantities: the others by --csv or --quantity\n",
               (int)COLUMNS_MAX, plan->quantity_count);
    }
}

static int column_count(const cost_plan *plan)
{
    return plan->quantity_count < COLUMNS_MAX ? plan->quantity_count : COLUMNS_MAX;
}

static void print_setting(const cost_plan *plan, const cost_setting *set)
{
    char solver[32], precision[16];
    name_of(plan->sides[set->side].solvers, set->solver, solver, sizeof solver);
    name_of(SCENE_PRECISIONS, set->precision, precision, sizeof precision);
    printf("%-6s  %9.4g  %8d  %10d  %-9s", solver, set->dt, set->substeps, set->iterations,
           precision);
}

static void print_row(const cost_plan *plan, const cost_row *row, bool relative)
{
    printf("%c ", row->own ? '>' : ' ');
    print_setting(plan, &row->set);
    if (row->diverged) {
        printf("     diverged\n");
        return;
    }
    printf("  %11.4g %7.2g", 1e6 * row->cpu, 1e6 * row->jitter);
    for (int q = 0; q < column_count(plan); q++) {
        double error = shown(&plan->quantities[q], row->error[q], relative);
        if (row->error[q] < 0) {
            printf("  %15s ", "nothing");
        } else if (row->error[q] < row->noise[q]) {
            char text[32];
            snprintf(text, sizeof text, "< %.2g",
                     shown(&plan->quantities[q], row->noise[q], relative));
            printf("  %15s%c", text, row->front[q] ? '*' : ' ');
        } else {
            printf("  %15.3e%c", error, row->front[q] ? '*' : ' ');
        }
    }
    printf("  %9.2g\n", row->penetration);
}

static bool is_shown(const cost_plan *plan, const cost_row *row, bool all)
{
    bool front = false;
    for (int q = 0; q < plan->quantity_count; q++) {
        front = front || row->front[q];
    }
    return all || row->own || front;
}

static void print_titles(const cost_plan *plan, bool relative)
{
    printf("\n  solver     step s  substeps  iterations  precision  us a second      +-");
    for (int q = 0; q < column_count(plan); q++) {
        char title[96];
        snprintf(title, sizeof title, "%.11s %s", plan->quantities[q].name,
                 unit_of(&plan->quantities[q], relative));
        printf("  %15.15s ", title);
    }
    printf("  overlap m\n");
}

/// Errors part by part of the time, of some settings of the first quantity's front.
static void print_times(const cost_plan *plan, bool relative)
{
    const cost_quantity *quantity = &plan->quantities[0];
    int told = 0;
    printf("\nlargest %s error [%s] in each eighth of the time\n", quantity->name,
           unit_of(quantity, relative));
    for (int i = 0; i < plan->row_count && told < TIMED_ROWS; i++) {
        const cost_row *row = &plan->rows[plan->order[i]];
        if (row->diverged || !(row->own || row->front[0])) {
            continue;
        }
        printf("%c ", row->own ? '>' : ' ');
        print_setting(plan, &row->set);
        for (int k = 0; k < COST_PARTS; k++) {
            if (row->part[0][k] < 0) {
                printf("  %7s", "-");
            } else {
                printf("  %7.1e", shown(quantity, row->part[0][k], relative));
            }
        }
        printf("\n");
        told++;
    }
}

/// Ladders of the same knob and end, in one line.
static void print_ends(const cost_plan *plan)
{
    printf("\nladders, their settings, and why they ended\n");
    for (int kind = 0; kind < COST_WAYS * COST_ENDS; kind++) {
        cost_way way = (cost_way)(kind / COST_ENDS);
        cost_end end = (cost_end)(kind % COST_ENDS);
        bool begun = false;
        for (int i = 0; i < plan->ladder_count; i++) {
            const cost_ladder *ladder = &plan->ladders[i];
            char solver[32], precision[16];
            if (ladder->way != way || ladder->end != end) {
                continue;
            }
            name_of(plan->sides[ladder->base.side].solvers, ladder->base.solver, solver,
                    sizeof solver);
            name_of(SCENE_PRECISIONS, ladder->base.precision, precision, sizeof precision);
            if (begun) {
                printf(", ");
            } else {
                printf("  %-26s ", cost_way_text(way));
            }
            printf("%s %s %d", solver, precision, ladder->count);
            begun = true;
        }
        if (begun) {
            printf(": %s\n", cost_end_text(end));
        }
    }
}

void cost_print_table(const cost_plan *plan, bool relative, bool all)
{
    int hidden = 0;
    print_head(plan);
    print_titles(plan, relative);
    for (int i = 0; i < plan->row_count; i++) {
        const cost_row *row = &plan->rows[plan->order[i]];
        if (is_shown(plan, row, all)) {
            print_row(plan, row, relative);
        } else {
            hidden++;
        }
    }
    printf("\n* nothing cheaper is as accurate, nor anything as cheap within +- more so (to 1 %%)"
           "\n> the scene's own setting\n");
    if (hidden > 0) {
        printf("%d more settings are on no front: --all shows them\n", hidden);
    }
    print_times(plan, relative);
    if (plan->ladder_count > 0) {
        print_ends(plan);
    }
}

// ------------------------------------------------------------------------------------------ CSV

static void csv_number(FILE *file, double value, bool there)
{
    if (there) {
        fprintf(file, "%.6g", value);
    }
    fputc(',', file);
}

static void csv_line(FILE *file, const cost_plan *plan, const cost_row *row, int q, bool relative)
{
    const cost_quantity *quantity = &plan->quantities[q];
    char solver[32], precision[16];
    name_of(plan->sides[row->set.side].solvers, row->set.solver, solver, sizeof solver);
    name_of(SCENE_PRECISIONS, row->set.precision, precision, sizeof precision);
    fprintf(file, "%s,%s,%.17g,%d,%d,%s,", plan->sides[row->set.side].name, solver, row->set.dt,
            row->set.substeps, row->set.iterations, precision);
    cli_print_csv(file, quantity->name);
    fputc(',', file);
    cli_print_csv(file, unit_of(quantity, relative));
    fputc(',', file);
    bool there = !row->diverged && row->error[q] >= 0;
    csv_number(file, shown(quantity, row->error[q], relative), there);
    csv_number(file, shown(quantity, row->noise[q], relative), there);
    for (int k = 0; k < COST_PARTS; k++) {
        csv_number(file, shown(quantity, row->part[q][k], relative), there && row->part[q][k] >= 0);
    }
    csv_number(file, row->cpu, !row->diverged);
    csv_number(file, row->jitter, !row->diverged);
    csv_number(file, row->penetration, !row->diverged);
    fprintf(file, "%d,%d,%d\n", row->front[q], row->own, row->diverged);
}

void cost_print_csv(FILE *file, const cost_plan *plan, bool relative)
{
    fprintf(file, "engine,solver,dt [s],substeps,iterations,precision,quantity,unit,error,noise,");
    for (int k = 0; k < COST_PARTS; k++) {
        fprintf(file, "error %d/%d,", k + 1, (int)COST_PARTS);
    }
    fprintf(file, "cpu [s/s],cpu noise [s/s],max penetration [m],pareto,own,diverged\n");
    for (int i = 0; i < plan->row_count; i++) {
        for (int q = 0; q < plan->quantity_count; q++) {
            csv_line(file, plan, &plan->rows[plan->order[i]], q, relative);
        }
    }
}
