// newton.c - velocities and impulses of an island that obey all rows: proximal rounds of Newton's method.
//
// With impulses l of the round before and a stiffness p a row, the impulse that follows from velocities v is
//     L(v) = clamp((l / p + target - J v) / (give + 1 / p), bounds),
// the bounds of friction being those of the load L of the moment (Alart and Curnier 1991). The velocities of the round are the
// root of F(v) = v - base - M^-1 J^T L(v), which is smooth but for kinks: Newton's method with the slopes of the side
// that v is on. Then l = L(v); what is left of the law is |L - l| / p, a speed, and falls by a factor a round that grows
// with p. Rows that say the same twice do no harm: the matrix is 1 + M^-1 J^T W J.
//
// Where Newton's steps do not settle, points with friction are cones, whose lift is taken from the slip with which the round begins
// (De Saxce and Feng 1998): that problem is convex, and a step is shortened until its potential falls. In a crowd the rows are swept
// before each such round (sweep.c): sweeps follow the law itself, cones the slip of before, and what is left over from one is soon told
// by the other.
//
// Reads: rows, nodes. Writes: velocities, impulses. Cost: some 2 to 20 factors a solution.
#include "exact/exact.h"
#include "math/compare.h"

#include <math.h>

#define STIFFNESS    1e3 // of a row's own mass, in the first round
#define MOST_RATIO   1e6
#define GROWTH       1e4  // of the stiffness that is due, where rounds gain little
#define SLOW         0.05 // gain of a round, below which stiffness grows
#define CONES_SLOW   0.3  // the same with cones; and share of what is left
#define PULL_GROWTH  1e1  // where errors are undone
#define ROUNDS       30
#define NEWTONS      20    // steps of a round
#define ROUNDING     1e-12 // of the speeds that a row adds up: what is less is nothing
#define FAR_OFF      1.0   // of the same speeds: a solution that is none
#define FACTORS      600   // of a solution, after which it is said to have missed
#define OFF          1e-2 // likewise: of islands that nobody asked for, not solved, more or less (hard.c)
#define HOPELESS     60 // the same where a sweep of the step has missed
#define UNASKED      8  // the same in a world of the soft step: a frame is not to be missed for it
#define MOST_CHANGE  4  // of the speeds that rows have to undo
#define STALLS       6  // rounds without progress
#define PULL_STALLS  2
#define SHORTENINGS  6
#define BISECTIONS   40
#define SOFTER       0.1  // of the stiffness that is due: of cones, which sweeps brought near
#define NEAR         1e-3 // of the speeds to undo: slopes of friction are those of the solution
#define ROUGH        0.1  // of the same speeds: a round with cones that leaves more is of a crowd
#define SPOILT       1.4  // times what the round before left
#define FIRST_SWEEPS 200  // of the rows, before the first round of a crowd
#define SWEEPS       100  // before each of the others
#define RESCUES      30   // in place of a solution
#define UNEVEN       1e3  // ratio of masses beyond which sweeps come to nothing
// To move, where errors are undone: a speed that bodies take on counts as so much of one that is left.
#define RELUCTANCE 0.01

//---- a round -----------------------------------------------------------------------------------------------

// velocity += share of the step.
static void go(const pl_exact_system *s, double share)
{
    for (uint32_t k = 3 * s->island->first_node; k < 3 * s->island->end_node; ++k) {
        s->velocity[k] += share * s->step[k];
    }
}

// F . M step, F being in `change`: the slope of the potential along the step, where friction is cones.
static double slope_along(const pl_exact_system *s)
{
    double sum = 0;
    for (uint32_t i = s->island->first_node; i < s->island->end_node; ++i) {
        for (uint32_t c = 0; c < 3; ++c) {
            const double m = s->nodes[i].inv_mass[c];
            sum += m > 0 ? s->change[3 * i + c] * s->step[3 * i + c] / m : 0;
        }
    }
    return sum;
}

// Share of a step along which the potential falls most, as far as half the slope goes. Returns the size of F there.
static double descend(pl_exact_newton *n)
{
    const pl_exact_system *s = n->s;
    double low = 0, high = 1, at = 1;
    const double before = n->slope;
    go(s, 1);
    double size = pl_exact_evaluate(n);
    for (int i = 0; i < BISECTIONS; ++i) {
        const double slope = slope_along(s);
        if (fabs(slope) <= 0.5 * fabs(before)) {
            break;
        }
        if (slope > 0) {
            high = at;
        } else if (high > at) {
            low = at;
        } else {
            break; // still falls where Newton's step ends
        }
        const double next = (low + high) / 2;
        go(s, next - at);
        at = next;
        size = pl_exact_evaluate(n);
    }
    return size;
}

// Share of a step that makes F smaller: halved until it does. Returns its size.
static double shorten(pl_exact_newton *n, double before)
{
    double share = 1, size = 0;
    go(n->s, 1);
    for (int i = 0; i < SHORTENINGS; ++i) {
        size = pl_exact_evaluate(n);
        if (size < before) {
            break;
        }
        share /= 2;
        go(n->s, -share);
    }
    return size;
}

// One step of Newton's from where F is in `change`; returns the size of F behind it.
static double advance(pl_exact_newton *n, double before)
{
    const pl_exact_system *s = n->s;
    pl_exact_factor(s);
    for (uint32_t k = 3 * s->island->first_node; k < 3 * s->island->end_node; ++k) {
        s->step[k] = -s->change[k];
    }
    pl_exact_substitute(s, s->step);
    n->slope = slope_along(s);
    return n->convex ? descend(n) : shorten(n, before);
}

// Velocities of the round, from where they are; false: they would not settle.
static bool settle(pl_exact_newton *n, int most)
{
    double size = pl_exact_evaluate(n);
    for (int i = 0; i < most && size > n->enough + n->noise; ++i) {
        const double before = size;
        size = advance(n, before);
        if (!n->convex && size > 0.9 * before) {
            return false;
        }
    }
    return size <= n->enough + n->noise;
}

// The slip of the moment as what cones take from their normals.
static void shift_cones(const pl_exact_newton *n)
{
    const pl_exact_system *s = n->s;
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        pl_exact_row *r = &s->rows[k];
        if (r->in_force && r->cone) {
            const double slip = fabs(pl_exact_rate(s, r, s->velocity) - r->target);
            r->shift = r->factor * pl_lesser(slip, n->fastest);
        }
    }
}

static void clear_shifts(const pl_exact_newton *n)
{
    for (uint32_t k = n->s->island->first_row; k < n->s->island->end_row; ++k) {
        n->s->rows[k].shift = 0;
    }
}

// A crowd from here on: rows are swept before each round, and may be softer, which leaves Newton's steps fewer kinks on their way.
static void begin_sweeps(pl_exact_newton *n)
{
    n->swept = true;
    n->stiffness = pl_lesser(n->stiffness, SOFTER * STIFFNESS);
    n->due *= SOFTER;
    pl_exact_sweep(n->s, FIRST_SWEEPS);
}

// A round: Newton's steps at the loads of the moment; or with cones, once those have not settled. Near the solution they do, and
// need no slip of before; where no point has friction, as among stiff springs, they alone come to one. Sweeps are left out behind a
// round that they spoilt. False: nothing has settled.
static bool round_off(pl_exact_newton *n)
{
    const bool rough =
        n->convex && n->last > ROUGH && n->cones && n->ratio <= UNEVEN && !n->unasked;
    if (!n->convex || n->last < NEAR || !n->cones) {
        n->convex = false;
        if (settle(n, NEWTONS)) {
            clear_shifts(n);
            return true;
        }
    }
    n->convex = true;
    if (!n->swept && rough) {
        begin_sweeps(n);
    } else if (n->swept && !n->spoilt) {
        pl_exact_sweep(n->s, SWEEPS);
    } else {
        pl_exact_follow(n->s);
    }
    shift_cones(n);
    return settle(n, 2 * NEWTONS);
}

// [m/s] by which impulses have not come to rest.
static double unrest_of(const pl_exact_newton *n, const pl_exact_row *r)
{
    const double left = fabs(r->next - r->impulse) / (n->stiffness * r->mass);
    if (!n->convex || !r->cone) {
        return left;
    }
    const double slip = pl_exact_rate(n->s, r, n->s->velocity) - r->target;
    const double shifted = fabs(r->factor * fabs(slip) - r->shift);
    return shifted > left ? shifted : left;
}

// `loads`: of rows without friction alone.
static double unrest(const pl_exact_newton *n, bool loads)
{
    const pl_exact_system *s = n->s;
    double most = 0;
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        const pl_exact_row *r = &s->rows[k];
        if (r->in_force && (r->leads == 0 || !loads)) {
            const double left = unrest_of(n, r);
            most = left > most ? left : most;
        }
    }
    return most;
}

// Whether what loads a row of friction may pull: then it rubs though nothing presses.
static bool is_drawn(const pl_exact_system *s, const pl_exact_row *r)
{
    bool drawn = false;
    for (uint32_t l = r->lead; l < r->lead + r->leads; ++l) {
        drawn |= s->rows[l].in_force && s->rows[l].low < 0;
    }
    return drawn;
}

// [m/s] most that rows have to undo: what need not be pushed and cannot pull has nothing to undo. Most that slips.
static void find_scale(pl_exact_newton *n)
{
    const pl_exact_system *s = n->s;
    double slip = 0, sum = 0;
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        const pl_exact_row *r = &s->rows[k];
        if (!r->in_force) {
            continue;
        }
        n->cones |= r->cone;
        const double lack = (r->target - pl_exact_rate(s, r, s->base)) / (1 + r->give * r->mass);
        sum = pl_greater(sum, pl_exact_sum(s, r));
        if (r->leads > 0) {
            slip = pl_greater(slip, fabs(lack));
            n->scale = pl_greater(n->scale, is_drawn(s, r) ? fabs(lack) : 0);
        } else {
            n->scale = pl_greater(n->scale, r->low < 0 ? fabs(lack) : lack);
        }
    }
    n->fastest = slip + 2 * n->scale;
    n->scale = n->scale > ROUNDING * sum ? n->scale : 0;
    n->tolerance = pl_greater((double)s->world->desc.exact_tolerance,
                              n->scale > 0 ? ROUNDING * sum / n->scale : 0);
}

// [kg]; its ratio to the lightest.
static double heaviest(const pl_exact_system *s, double *ratio)
{
    double most = 0, least = INFINITY;
    for (uint32_t i = s->island->first_node; i < s->island->end_node; ++i) {
        const double inverse = s->nodes[i].inv_mass[0];
        most = inverse > 0 && 1 / inverse > most ? 1 / inverse : most;
        least = inverse > 0 && 1 / inverse < least ? 1 / inverse : least;
    }
    *ratio = most > 0 ? pl_lesser(most / least, MOST_RATIO) : 1;
    return most;
}

// [m/s] the largest change of a body.
static double most_change(const pl_exact_system *s)
{
    double most = 0;
    for (size_t k = 3 * (size_t)s->island->first_node; k < 3 * (size_t)s->island->end_node;
         k += 3) {
        most = pl_greater(most, fabs(s->velocity[k] - s->base[k]));
        most = pl_greater(most, fabs(s->velocity[k + 1] - s->base[k + 1]));
    }
    return most;
}

// Rounds need not come nearer: where bars hang in a line, undoing their errors to the last digit asks for any speed across
// it, and what that bends is the error of the next round. The best of the rounds is kept; where errors are undone, that which
// leaves least of rows that bear for the way that bodies go for it.
static void keep_best(pl_exact_newton *n, double left, double loads)
{
    const pl_exact_system *s = n->s;
    const bool pulls = s->sweep == PL_SWEEP_PULL;
    const double merit = pulls ? loads * n->scale + RELUCTANCE * most_change(s) : left;
    if (n->rounds++ > 0 && merit >= n->merit) {
        return;
    }
    pl_exact_copy(s, s->best, s->velocity);
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        s->rows[k].best = s->rows[k].next;
    }
    n->merit = merit, n->left = left;
}

static void take_best(const pl_exact_newton *n)
{
    const pl_exact_system *s = n->s;
    pl_exact_copy(s, s->velocity, s->best);
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        s->rows[k].impulse = s->rows[k].next = s->rows[k].best;
    }
}

// Nothing settles: friction as cones without more, from the impulses before. What Newton's steps come to keeps momentum, settled
// or not. That no body changes by much more than what there was to undo, the change of all is shortened; impulses that do not
// belong to it are not carried on.
static void give_in(pl_exact_newton *n)
{
    const pl_exact_system *s = n->s;
    const size_t first = 3 * (size_t)s->island->first_node, end = 3 * (size_t)s->island->end_node;
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        s->rows[k].impulse = s->rows[k].before;
    }
    pl_exact_copy(s, s->velocity, s->base);
    clear_shifts(n);
    n->convex = true;
    n->stiffness = STIFFNESS;
    settle(n, 4 * NEWTONS);
    const double most = most_change(s);
    const double share = most > MOST_CHANGE * n->scale ? MOST_CHANGE * n->scale / most : 1;
    for (size_t k = first; k < end; ++k) {
        s->velocity[k] = s->base[k] + share * (s->velocity[k] - s->base[k]);
    }
    for (uint32_t k = s->island->first_row; k < s->island->end_row && share < 1; ++k) {
        s->rows[k].next = s->rows[k].before;
    }
}

// What has gained energy is no solution: sweeps from no impulses at all.
static void rescue(const pl_exact_system *s)
{
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        s->rows[k].impulse = 0;
    }
    pl_exact_sweep(s, RESCUES);
}

//---- rounds --------------------------------------------------------------------------------------------

static uint32_t factors_of(const pl_exact_newton *n)
{
    return n->unasked ? UNASKED : n->s->island->hopeless ? HOPELESS : FACTORS;
}

// Where rounds gain little rows are stiffer in the next one; with cones only if loads are much of what is left: no stiffness finds
// their slip.
static void stiffen(pl_exact_newton *n, double loads, double left)
{
    const bool pulls = n->s->sweep == PL_SWEEP_PULL;
    const double most = STIFFNESS * n->ratio * (pulls ? PULL_GROWTH : GROWTH);
    const bool slow = n->convex ? loads > CONES_SLOW * n->loads && loads > CONES_SLOW * left
                                : loads > SLOW * n->loads;
    if (n->stiffness < n->due || (slow && n->stiffness < most)) {
        n->stiffness *= 10;
    }
}

// Rounds until one leaves no more than the tolerance; returns what the last one left.
static double run_rounds(pl_exact_newton *n)
{
    const pl_exact_system *s = n->s;
    const bool pulls = s->sweep == PL_SWEEP_PULL;
    const int most_stalls = pulls ? PULL_STALLS : STALLS;
    const uint32_t most_factored = s->exact->factored + factors_of(n);
    double left = 0, best = INFINITY;
    for (int round = 0, stalled = 0;
         stalled < most_stalls && round < ROUNDS && s->exact->factored < most_factored; ++round) {
        if (pulls) {
            pl_exact_bend(s, round);
        }
        const bool settled = round_off(n);
        left = unrest(n, false) / n->scale;
        const double loads = unrest(n, true) / n->scale;
        for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
            s->rows[k].impulse = s->rows[k].next;
        }
        if (left <= n->tolerance) {
            break;
        }
        keep_best(n, left, loads);
        stalled = left < 0.7 * best || n->stiffness < n->due ? 0 : stalled + 1;
        n->spoilt = left > SPOILT * n->last && !n->spoilt;
        n->last = left;
        best = pl_lesser(left, best);
        if (settled && loads > n->tolerance) {
            stiffen(n, loads, left);
        }
        n->loads = loads;
    }
    return left;
}

void pl_exact_solve(pl_exact_system *s)
{
    const bool pulls = s->sweep == PL_SWEEP_PULL;
    pl_exact_newton n = { .s = s,
                          .stiffness = STIFFNESS,
                          .loads = INFINITY,
                          .last = INFINITY,
                          .unasked = pl_exact_is_unasked(s->world) };
    if (pulls) {
        pl_exact_bend(s, 0); // what the arcs of the start ask for is to be undone, too
    }
    find_scale(&n);
    pl_exact_push_all(s, 1); // where the solution begins
    const double enough = n.tolerance * n.scale;
    n.enough = 1e-4 * enough * enough * heaviest(s, &n.ratio);
    n.due = STIFFNESS * n.ratio; // heavy on light has to be stiffer by as much
    double left = 0;
    for (uint32_t k = s->island->first_row; n.scale == 0 && k < s->island->end_row; ++k) {
        s->rows[k].impulse = s->rows[k].next = 0;
    }
    if (n.scale > 0) {
        left = run_rounds(&n);
    }
    s->missed = left > n.tolerance;
    if (s->missed) {
        take_best(&n);
        left = n.left;
    }
    s->left = left;
    s->island->solved |= left <= OFF;
    if (left > FAR_OFF && !n.unasked) {
        give_in(&n);
    }
    if (s->missed && pl_exact_has_gained(s)) {
        rescue(s);
    }
    if (!pulls) { // what cannot be undone is no miss
        s->exact->missed += s->missed;
        s->island->hopeless |= s->missed;
        const double told =
            s->missed ? left : pl_lesser(left, (double)s->world->desc.exact_tolerance);
        s->exact->residual = pl_greater(s->exact->residual, told);
    }
}
