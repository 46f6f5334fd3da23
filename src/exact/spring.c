// spring.c - springs as rows of the exact solver: the linear oscillator, exact over a substep, in two halves.
//
// With x = h w and z x of the oscillator C'' = -w^2 C - 2 z w C' + f, time in substeps: y(t) is what f = 1 makes of rest,
// so that y(1) and y'(1) are the place's and the velocity's, E00 = 1 - x^2 y, E01 = y', E11 = 1 - 2 z x y' - x^2 y, det E =
// exp(-2 z x). A substep is
//     u = p v + q C + g (s - v),    C' = C + h u,    v' = r u + t C' + k (s' - u),
// s and s' being what u and v' would be without the spring: s - v is half of what everything else does in the substep. With
//     p = r = exp(-z x), q h = -x^2 y, g = 2 y, t h = -x^2 d / p, k = 2 d / p, d = (det E - E11) / x^2
// places are those of E under any constant load, velocities are smaller by the factor p / y', 1 - x^2 / 6 of an undamped spring;
// overdamped ones have p = y', r = det E / y', and velocities, too, are E's. As g and k are at most 1,
//     (1 - g) u + g K impulse = (p - g) v + q C,    K = J M^-1 J^T,
// is a row that gives way: a spring and some mass that adds to the inertia of what it ties. Nothing is won where several meet: of
// an undamped spring both halves are one kick of Verlet's method with that mass.
//
// Beyond x = STIFF it fades to the implicit step, which damps; where many meet, before that, to the trapezoidal rule, which is
// stable whatever else acts.
//
// Reads: rows, velocities. Writes: targets and give of springs. Cost: some 20 terms of a series a spring and sweep.
#include "exact/exact.h"
#include "joints/law.h"
#include "math/compare.h"
#include "math/decay.h"

#include <math.h>

#define TAU    6.2831853071795864769
#define STIFF  1.0 // [-] x from which a spring fades, as far as twice that
#define MANY   1.2 // [-] the same, times the root of how many joints meet on a body
#define MOST   1e9 // [-] of x and z x
#define LOADED 0.1 // [-] d, in y, of the stiffest: load goes on to the velocity
#define SERIES 2.5 // [-] of x and 2 z x, as far as the series goes
#define TERMS  32
#define SLIGHT 1e-15 // [-] of a mass that a spring adds, in its row's

// See above. `own`: 1 - 2 y; `rest`: 1 - 2 d.
typedef struct motion {
    double x, zx;
    double y, rate, d;
    double own, rest;
    double det;
} motion;

static void find_swing(const pl_row *row, double mass, double h, double *x, double *zx)
{
    if (row->spring == PL_SPRING_HERTZ) {
        *x = pl_lesser(TAU * (double)row->stiff * h, MOST);
        *zx = pl_lesser((double)row->damp * *x, MOST);
    } else {
        *x = pl_lesser(h * sqrt((double)row->stiff / mass), MOST);
        *zx = pl_lesser((double)row->damp * h / mass / 2, MOST);
    }
}

// By powers of t: y'' + 2 z x y' + x^2 y = 1, and d' + 2 z x d = y'.
static void by_series(motion *m)
{
    const double xx = m->x * m->x, c = 2 * m->zx;
    double before = 0, term = 0.5, way = 0; // of y, the last two powers; of d
    m->y = term, m->rate = 1, m->d = 0;
    m->own = m->rest = 0;
    for (int n = 1; n < TERMS; ++n) {
        // n: the power that the term of d has before it grows; `term` is that of y at n + 1.
        way = ((double)(n + 1) * term - c * way) / (n + 1);
        m->d += way;
        m->rest -= n > 1 ? 2 * way : 0;
        const double next = -(c * (n + 1) * term + xx * before) / ((n + 1) * (n + 2));
        before = term, term = next;
        m->y += next;
        m->rate += (n + 2) * next;
        m->own -= 2 * next;
    }
}

// By its two rates, where it is overdamped, or else is no more than STIFF of the range of the series.
static void by_rates(motion *m)
{
    const double root = sqrt(m->zx * m->zx - m->x * m->x), fast = m->zx + root;
    const double slow = m->x * m->x / fast;
    const pl_decay one = pl_decay_of(slow), two = pl_decay_of(fast);
    m->y = (one.mean - two.mean) / (fast - slow);
    m->rate = (one.left - two.left) / (fast - slow);
    m->d = one.mean * two.mean - m->y;
    m->own = 1 - 2 * m->y;
    m->rest = 1 - 2 * m->d;
}

// Moves it by a share to another step of the same x and z x.
static void fade(motion *m, double share, double y, double rate, double last)
{
    const double xx = m->x * m->x, here = 1 - 2 * m->zx * m->rate - xx * m->y;
    m->y += share * (y - m->y);
    m->rate += share * (rate - m->rate);
    const double e11 = here + share * (last - here);
    m->det = (1 - xx * m->y) * e11 + xx * m->rate * m->rate;
    m->d = pl_greater((m->det - e11) / xx, LOADED * m->y);
    m->own = 1 - 2 * m->y;
    m->rest = 1 - 2 * m->d;
}

static double share_of(double x, double from)
{
    return pl_lesser(pl_greater(x / from - 1, 0), 1);
}

static motion motion_of(double x, double zx, uint32_t degree)
{
    motion m = { .x = x, .zx = zx };
    const double stiff = share_of(x, STIFF);
    m.det = pl_decay_of(2 * zx).left;
    if (2 * zx > SERIES && zx > x) {
        by_rates(&m);
    } else if (stiff < 1) {
        by_series(&m);
    }
    const double many = share_of(x, MANY / sqrt((double)degree));
    if (many > 0 && stiff < 1) {
        const double y = 1 / (2 + 2 * zx + x * x / 2);
        fade(&m, many, y, 2 * y, 4 * y - 1);
    }
    if (stiff > 0) {
        const double b = 1 / (1 + 2 * zx + x * x);
        fade(&m, stiff, b, b, b);
    }
    return m;
}

// (1 - g) u + g K impulse = (along - g) rate + error: as a row. `own`: 1 - g.
static void aim(pl_exact_row *r, double own, double along, double rate, double error)
{
    const double mass = pl_greater(own, SLIGHT), g = 1 - own;
    r->give = g / (r->mass * mass);
    r->target = ((along - g) * rate + error) / mass;
}

// `rate`: J v, or J u behind the drift.
static void aim_half(const pl_exact_system *s, uint32_t degree, const pl_row *row, pl_exact_row *r,
                     double rate)
{
    double x, zx;
    find_swing(row, r->mass, (double)s->h, &x, &zx);
    const motion m = motion_of(x, zx, degree);
    const double even = sqrt(pl_greater(m.det, 0)), p = pl_greater(m.rate, even);
    const double error = -x * x * (double)row->error / (double)s->h;
    if (s->sweep == PL_SWEEP_PULL) {
        aim(r, m.own, p, rate, error * m.y);
        return;
    }
    const double lost = p > m.rate ? m.zx * pl_decay_of(m.zx).mean : 1 - p; // 1 - p
    const bool plain = p > m.rate && share_of(x, STIFF) <= 0;
    const double own = (m.rest - (plain ? lost : 1 - p)) / p;
    aim(r, own, pl_greater(m.det, 0) / p, rate, error * m.d / p);
}

// [m/s] J times half of what forces do in the substep.
static double kick_of(const pl_exact_system *s, const pl_exact_row *r)
{
    double sum = 0;
    for (int end = 0; end < 2; ++end) {
        const uint32_t node = r->item->node[end];
        for (uint32_t c = 0; node != PL_NONE && c < 3; ++c) {
            sum += r->j[3 * (uint32_t)end + c] * s->kick[3 * node + c];
        }
    }
    return sum;
}

static const pl_joint *joint_of(const pl_exact_system *s, const pl_exact_item *item)
{
    return item->joint == PL_NONE ? NULL : pl_joint_grouped(&s->world->joints, item->joint);
}

// Of each node, into `where`: how many joints with springs are at it.
static void count_springs(const pl_exact_system *s)
{
    for (uint32_t n = s->island->first_node; n < s->island->end_node; ++n) {
        s->nodes[n].where = 0;
    }
    for (uint32_t i = s->island->first_item; i < s->island->end_item; ++i) {
        const pl_exact_item *item = &s->items[i];
        const pl_joint *j = joint_of(s, item);
        bool springs = false;
        for (int k = 0; j != NULL && k < j->rows.count; ++k) {
            springs |= s->rows[item->first_row + (uint32_t)k].in_force &&
                       pl_row_is_spring(&j->rows.row[k]);
        }
        for (int end = 0; springs && end < 2; ++end) {
            if (item->node[end] != PL_NONE) {
                ++s->nodes[item->node[end]].where;
            }
        }
    }
}

static uint32_t degree_of(const pl_exact_system *s, const pl_exact_item *item)
{
    uint32_t most = 1;
    for (int end = 0; end < 2; ++end) {
        if (item->node[end] != PL_NONE && s->nodes[item->node[end]].where > most) {
            most = s->nodes[item->node[end]].where;
        }
    }
    return most;
}

void pl_exact_spring(const pl_exact_system *s, const double *velocity)
{
    count_springs(s);
    for (uint32_t i = s->island->first_item; i < s->island->end_item; ++i) {
        const pl_exact_item *item = &s->items[i];
        const pl_joint *j = joint_of(s, item);
        for (int k = 0; j != NULL && k < j->rows.count; ++k) {
            pl_exact_row *r = &s->rows[item->first_row + (uint32_t)k];
            if (r->in_force && pl_row_is_spring(&j->rows.row[k])) {
                const double kick = s->sweep == PL_SWEEP_PULL ? kick_of(s, r) : 0;
                aim_half(s, degree_of(s, item), &j->rows.row[k], r,
                         pl_exact_rate(s, r, velocity) - kick);
            }
        }
    }
}
