/// cost_front.c - which settings are worth their time, and which is the cheapest that is good enough.
#include "cost.h"

#include <math.h>
#include <string.h>

/// [-] an error must be smaller by so much to count: less is luck of the roundings.
static const double WORTH_MENTIONING = 0.99;

double cost_relative(const cost_quantity *quantity, double error)
{
    return quantity->extent > 0 ? error / quantity->extent : error;
}

/// By time; rows of the same array, so that of two equal times one comes first.
static bool comes_before(const cost_row *a, const cost_row *b)
{
    return a->diverged != b->diverged           ? b->diverged
           : a->cpu < b->cpu || a->cpu > b->cpu ? a->cpu < b->cpu
                                                : a < b;
}

/// What can be told of an error: not less than the truth, or the noise of ensembles, is good for.
static double told(const cost_plan *plan, const cost_row *row, int q)
{
    return fmax(row->error[q], plan->quantities[q].floor);
}

/// True when nothing is cheaper, or as cheap within what repeats are apart, and as accurate.
static bool on_front(const cost_plan *plan, const cost_row *row, int q)
{
    double mine = told(plan, row, q);
    for (int i = 0; i < plan->row_count; i++) {
        const cost_row *other = &plan->rows[i];
        if (other == row || other->diverged || other->error[q] < 0) {
            continue;
        }
        double its = told(plan, other, q);
        bool as_cheap = other->cpu <= row->cpu + fmax(row->jitter, other->jitter);
        if ((comes_before(other, row) && mine >= WORTH_MENTIONING * its) ||
            (as_cheap && its < WORTH_MENTIONING * mine)) {
            return false;
        }
    }
    return true;
}

/// What an ensemble cannot tell apart is equal, and the cheapest of it the best: the median of the rows' noise is the
/// floor of all.
static void raise_floor(cost_plan *plan, int q)
{
    int below = 0;
    double floor = 0;
    for (int i = 0; i < plan->row_count; i++) {
        double noise = plan->rows[i].noise[q];
        below = 0;
        for (int k = 0; k < plan->row_count; k++) {
            below += plan->rows[k].noise[q] <= noise;
        }
        floor = 2 * below >= plan->row_count && (noise < floor || !(floor > 0)) ? noise : floor;
    }
    plan->quantities[q].floor = fmax(plan->quantities[q].floor, floor);
}

void cost_rank(cost_plan *plan)
{
    for (int q = 0; q < plan->quantity_count; q++) {
        raise_floor(plan, q);
    }
    for (int i = 0; i < plan->row_count; i++) {
        int place = i;
        for (; place > 0 && comes_before(&plan->rows[i], &plan->rows[plan->order[place - 1]]);
             place--) {
            plan->order[place] = plan->order[place - 1];
        }
        plan->order[place] = i;
    }
    for (int i = 0; i < plan->row_count; i++) {
        cost_row *row = &plan->rows[i];
        for (int q = 0; q < plan->quantity_count; q++) {
            row->front[q] = !row->diverged && row->error[q] >= 0 && on_front(plan, row, q);
        }
    }
}

const cost_row *cost_cheapest(const cost_plan *plan, const char *side, double tolerance,
                              bool relative)
{
    for (int i = 0; i < plan->row_count; i++) {
        const cost_row *row = &plan->rows[plan->order[i]];
        bool seen = false;
        bool good =
            !row->diverged && (side == NULL || strcmp(plan->sides[row->set.side].name, side) == 0);
        for (int q = 0; q < plan->quantity_count && good; q++) {
            double error = row->error[q];
            seen = seen || error >= 0;
            good = error < 0 ||
                   (relative ? cost_relative(&plan->quantities[q], error) : error) <= tolerance;
        }
        if (good && seen) {
            return row;
        }
    }
    return NULL;
}
