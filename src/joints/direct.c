// direct.c - the joints of a group solved together and exactly, by a sparse block factor of A = J M^-1 J^T.
//
// One sweep after the other hands an impulse on from joint to joint: N links that bear R times their mass take some
// 2 N R sweeps a digit. Here the changes x of all impulses come at once from
//     (A + G) x = target - J v - G impulse
// G being what springs give. A is a block a joint and one for each pair of joints that are neighbours or become so (direct_plan.c).
// Limits and motors at their bounds are no unknowns; which ones these are is found by trying: who leaves its bounds is
// put there, who would come off is freed.
//
// As in one.c errors are undone in the sweep that pulls, whose velocities only move the bodies; the one that relaxes, with J of
// where they are then, leaves J v = 0: the way is a chord, and no energy comes of it (RATTLE, Andersen 1983).
//
// Reads: the plan, rows. Writes: impulses, solver bodies, parts, blocks. Cost: O(joints of chains and trees).
#include "joints/direct.h"
#include "plumb/math.h"
#include "world/state.h"

// Of the diagonal: a smaller pivot is what rounding of the rows left of a redundant one, which gets no impulse. A chain
// whose end is so many times as heavy as its links has such pivots, too: it is the ratio that can be told.
#define LEAST_PIVOT (sizeof(near_real) == sizeof(float) ? 1e-6 : 1e-10)
// [rad] that a body whose inertia is raised may turn in a substep: it has hardly any energy.
#define MOST_TURN 0.05
#define PASSES    8    // of finding who is at a bound
#define SLACK     1e-6 // [m/s], [rad/s] by which one must come off its bound to be freed

typedef struct joint_system {
    const pl_joint_context *context;
    const pl_direct_column *columns;
    const uint32_t *entries;
    pl_direct_part *parts;
    double *blocks;
    uint32_t first, end; // columns of joints that hang together
    uint32_t all;        // columns of all groups
} joint_system;

static double *diagonal(const joint_system *s, uint32_t column)
{
    return s->blocks + (size_t)column * PL_DIRECT_BLOCK;
}

static double *beside(const joint_system *s, uint32_t entry)
{
    return s->blocks + ((size_t)s->all + entry) * PL_DIRECT_BLOCK;
}

//---- rows ----------------------------------------------------------------------------------------

// By how much J v lacks what it is to be.
static double lack_of(const pl_direct_part *p, int i)
{
    const pl_lone *l = &p->lone;
    return p->law[i].target - (double)pl_one_rate(&l->joint->rows.row[i], l->a, l->b);
}

// Rows at a bound that would go beyond are no unknowns to begin with.
static bool begins_at_bound(const pl_direct_part *p, int i)
{
    const pl_joint *j = p->lone.joint;
    const double impulse = (double)j->impulse[i], lack = lack_of(p, i);
    return (impulse <= p->law[i].low && lack <= 0) || (impulse >= p->law[i].high && lack >= 0);
}

static void push(pl_direct_part *p, int i, double total)
{
    const pl_lone *l = &p->lone;
    const real before = l->joint->impulse[i];
    l->joint->impulse[i] = (real)total;
    pl_one_push(&l->joint->rows.row[i], l->a, l->b, (real)total - before);
}

// A motor and a limit of one value are one direction, of which the elimination leaves the motor nothing: so a limit that the
// motor leaves lets go first. If the motor is too weak for that, it ends at its bound, and the limit is freed again.
static void leave_limits(pl_direct_part *p)
{
    const pl_joint *j = p->lone.joint;
    for (int i = j->rows.block + 2; i < j->rows.count; ++i) {
        const double speed = p->law[i].target;
        const int left = speed > 0 ? i - 2 : i - 1; // lower, upper
        if (pl_one_is_limited(j, i) && p->law[i].in_force && speed != 0 && p->law[left].in_force &&
            (double)j->impulse[left] > p->law[left].low) {
            push(p, left, p->law[left].low);
            p->at_bound[left] = true;
        }
    }
}

static void open_part(const joint_system *s, uint32_t column, pl_joint_sweep sweep)
{
    pl_direct_part *p = &s->parts[column];
    pl_one_take(s->context, s->columns[column].joint, &p->lone);
    for (int i = 0; i < p->lone.joint->rows.count; ++i) {
        pl_row_law_of(&p->lone, i, sweep, true, s->context->recovery, &p->law[i]);
        if (p->law[i].in_force) {
            p->at_bound[i] = i >= p->lone.joint->rows.block && begins_at_bound(p, i);
        }
    }
    leave_limits(p);
}

static void number_unknowns(pl_direct_part *p)
{
    p->count = 0;
    for (int i = 0; i < p->lone.joint->rows.count; ++i) {
        if (p->law[i].in_force && !p->at_bound[i]) {
            p->row[p->count++] = (uint8_t)i;
        }
    }
}

//---- the matrix ----------------------------------------------------------------------------------

// Of row i of p and row k of q: what they have to do with one another by the bodies that they share.
static double across(const pl_direct_part *p, int i, const pl_direct_part *q, int k)
{
    const pl_row *r = &p->lone.joint->rows.row[i], *t = &q->lone.joint->rows.row[k];
    const pl_solver_body *of_p[2] = { p->lone.a, p->lone.b };
    const pl_solver_body *of_q[2] = { q->lone.a, q->lone.b };
    const real *jp[2] = { &r->ax, &r->bx }, *jq[2] = { &t->ax, &t->bx };
    double sum = 0;
    for (int m = 0; m < 2; ++m) {
        for (int n = 0; n < 2; ++n) {
            if (of_p[m] == of_q[n]) {
                const real *x = jp[m], *y = jq[n];
                sum += (double)of_p[m]->inv_mass *
                           ((double)x[0] * (double)y[0] + (double)x[1] * (double)y[1]) +
                       (double)of_p[m]->inv_inertia * (double)x[2] * (double)y[2];
            }
        }
    }
    return sum;
}

static void assemble(const joint_system *s)
{
    for (uint32_t c = s->first; c < s->end; ++c) {
        pl_direct_part *p = &s->parts[c];
        double *d = diagonal(s, c);
        for (int i = 0; i < p->count; ++i) {
            for (int k = 0; k < p->count; ++k) {
                d[i * PL_JOINT_ROWS + k] = across(p, p->row[i], p, p->row[k]);
            }
            d[i * (PL_JOINT_ROWS + 1)] += p->law[p->row[i]].give;
            p->scale[i] = d[i * (PL_JOINT_ROWS + 1)];
        }
        const pl_direct_column *column = &s->columns[c];
        for (uint32_t e = column->first; e < column->first + column->count; ++e) {
            const pl_direct_part *q = &s->parts[s->entries[e]];
            for (int i = 0; i < p->count; ++i) {
                for (int k = 0; k < q->count; ++k) {
                    beside(s, e)[i * PL_JOINT_ROWS + k] = across(p, p->row[i], q, q->row[k]);
                }
            }
        }
    }
}

// Blocks of hinges, two rows each, are most of what there is: what works on blocks is compiled for two rows as well. The bits are
// the same.
#define BLOCK_PART static inline __attribute__((always_inline))

// Inverse of a positive definite block in place, by Gauss and Jordan. A pivot that rounding has eaten up is no
// direction of its own.
BLOCK_PART void invert_rows(double *d, const double *diagonal_of, int n)
{
    for (int p = 0; p < n; ++p) {
        const double pivot = d[p * (PL_JOINT_ROWS + 1)];
        const double inverse = pivot > LEAST_PIVOT * diagonal_of[p] ? 1 / pivot : 0;
        d[p * (PL_JOINT_ROWS + 1)] = 1;
        for (int k = 0; k < n; ++k) {
            d[p * PL_JOINT_ROWS + k] *= inverse;
        }
        for (int i = 0; i < n; ++i) {
            const double factor = i == p ? 0 : d[i * PL_JOINT_ROWS + p];
            if (i != p) {
                d[i * PL_JOINT_ROWS + p] = 0;
            }
            for (int k = 0; k < n; ++k) {
                d[i * PL_JOINT_ROWS + k] -= factor * d[p * PL_JOINT_ROWS + k];
            }
        }
    }
}

static void invert(double *d, const double *diagonal_of, int n)
{
    if (n == 2) {
        invert_rows(d, diagonal_of, 2);
    } else {
        invert_rows(d, diagonal_of, n);
    }
}

// to -= x^T y, x of n rows and m columns, y of n rows and l columns.
BLOCK_PART void take_product_rows(double *to, const double *x, const double *y, int n, int m, int l)
{
    for (int i = 0; i < m; ++i) {
        for (int k = 0; k < l; ++k) {
            double sum = 0;
            for (int r = 0; r < n; ++r) {
                sum += x[r * PL_JOINT_ROWS + i] * y[r * PL_JOINT_ROWS + k];
            }
            to[i * PL_JOINT_ROWS + k] -= sum;
        }
    }
}

static void take_product(double *to, const double *x, const double *y, int n, int m, int l)
{
    if (n == 2 && m == 2 && l == 2) {
        take_product_rows(to, x, y, 2, 2, 2);
    } else {
        take_product_rows(to, x, y, n, m, l);
    }
}

// out = d x, n rows, m columns.
BLOCK_PART void multiply_rows(double *out, const double *d, const double *x, int n, int m)
{
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < m; ++k) {
            double sum = 0;
            for (int r = 0; r < n; ++r) {
                sum += d[i * PL_JOINT_ROWS + r] * x[r * PL_JOINT_ROWS + k];
            }
            out[i * PL_JOINT_ROWS + k] = sum;
        }
    }
}

static void multiply(double *out, const double *d, const double *x, int n, int m)
{
    if (n == 2 && m == 2) {
        multiply_rows(out, d, x, 2, 2);
    } else {
        multiply_rows(out, d, x, n, m);
    }
}

// What a column leaves of those behind it.
static void eliminate(const joint_system *s, uint32_t c)
{
    const pl_direct_column *column = &s->columns[c];
    const int n = s->parts[c].count;
    invert(diagonal(s, c), s->parts[c].scale, n);
    const uint32_t end = column->first + column->count;
    for (uint32_t e = column->first; e < end; ++e) {
        const uint32_t q = s->entries[e];
        const pl_direct_column *to = &s->columns[q];
        const int m = s->parts[q].count;
        double x[PL_DIRECT_BLOCK];
        multiply(x, diagonal(s, c), beside(s, e), n, m);
        take_product(diagonal(s, q), x, beside(s, e), n, m, m);
        for (uint32_t k = to->first; k < to->first + to->count; ++k) {
            s->parts[s->entries[k]].where = k;
        }
        for (uint32_t f = column->first; f < end; ++f) {
            const uint32_t r = s->entries[f];
            if (r > q) {
                take_product(beside(s, s->parts[r].where), x, beside(s, f), n, m,
                             s->parts[r].count);
            }
        }
    }
}

// q -= b^T d p.
BLOCK_PART void hand_down_rows(double *q, const double *b, const double *d, const double *p, int n,
                               int m)
{
    for (int i = 0; i < n; ++i) {
        double y = 0;
        for (int k = 0; k < n; ++k) {
            y += d[i * PL_JOINT_ROWS + k] * p[k];
        }
        for (int k = 0; k < m; ++k) {
            q[k] -= b[i * PL_JOINT_ROWS + k] * y;
        }
    }
}

static void hand_down(double *q, const double *b, const double *d, const double *p, int n, int m)
{
    if (n == 2 && m == 2) {
        hand_down_rows(q, b, d, p, 2, 2);
    } else {
        hand_down_rows(q, b, d, p, n, m);
    }
}

// p -= b q.
static void hand_up(double *p, const double *b, const double *q, int n, int m)
{
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < m; ++k) {
            p[i] -= b[i * PL_JOINT_ROWS + k] * q[k];
        }
    }
}

// x of the parts: right sides, then the solution.
static void substitute(const joint_system *s)
{
    for (uint32_t c = s->first; c < s->end; ++c) {
        const pl_direct_column *column = &s->columns[c];
        const pl_direct_part *p = &s->parts[c];
        for (uint32_t e = column->first; e < column->first + column->count; ++e) {
            pl_direct_part *q = &s->parts[s->entries[e]];
            hand_down(q->x, beside(s, e), diagonal(s, c), p->x, p->count, q->count);
        }
    }
    for (uint32_t c = s->end; c-- > s->first;) {
        const pl_direct_column *column = &s->columns[c];
        pl_direct_part *p = &s->parts[c];
        double x[PL_JOINT_ROWS] = { 0 };
        for (uint32_t e = column->first; e < column->first + column->count; ++e) {
            const pl_direct_part *q = &s->parts[s->entries[e]];
            hand_up(p->x, beside(s, e), q->x, p->count, q->count);
        }
        for (int i = 0; i < p->count; ++i) {
            for (int k = 0; k < p->count; ++k) {
                x[i] += diagonal(s, c)[i * PL_JOINT_ROWS + k] * p->x[k];
            }
        }
        for (int i = 0; i < p->count; ++i) {
            p->x[i] = x[i];
        }
    }
}

//---- who is at a bound -----------------------------------------------------------------------------

// Puts at its bound who would leave it. True: there were some, and the solution does not hold.
static bool hold_to_bounds(const joint_system *s)
{
    bool any = false;
    for (uint32_t c = s->first; c < s->end; ++c) {
        pl_direct_part *p = &s->parts[c];
        const pl_joint *j = p->lone.joint;
        for (int k = 0; k < p->count; ++k) {
            const int i = p->row[k];
            const double total = (double)j->impulse[i] + p->x[k];
            if (i >= j->rows.block && (total < p->law[i].low || total > p->law[i].high)) {
                push(p, i, total < p->law[i].low ? p->law[i].low : p->law[i].high);
                p->at_bound[i] = any = true;
            }
        }
    }
    return any;
}

// Frees who would come off its bound. True: there were some.
static bool let_go(const joint_system *s)
{
    bool any = false;
    for (uint32_t c = s->first; c < s->end; ++c) {
        pl_direct_part *p = &s->parts[c];
        const pl_joint *j = p->lone.joint;
        for (int i = j->rows.block; i < j->rows.count; ++i) {
            const double impulse = (double)j->impulse[i];
            const double above = impulse - p->law[i].low, below = p->law[i].high - impulse;
            if (!p->law[i].in_force || !p->at_bound[i] || above + below <= 0) {
                continue; // one that may give nothing never comes off
            }
            const bool low = above < below; // the nearer one: rounding leaves it a bit beside it
            const double lack = lack_of(p, i) - p->law[i].give * impulse;
            if (low ? lack > SLACK : lack < -SLACK) {
                p->at_bound[i] = false;
                any = true;
            }
        }
    }
    return any;
}

//---- inertia ---------------------------------------------------------------------------------------

static near_real own_inertia(const joint_system *s, uint32_t column, int end)
{
    return pl_one_own_inertia(s->context->world, s->parts[column].lone.joint, end);
}

// What impulses make a body spin by its inertia of now: `start` of them were the substep's to begin with, of which a
// share comes behind the drift (halves.c).
static void turn(const joint_system *s, pl_solver_body *body, uint32_t slot, near_real all,
                 near_real start)
{
    const pl_solver *solver = &s->context->world->solver;
    if (slot >= solver->dynamic_slots) {
        return;
    }
    near_real *kicked = (near_real *)solver->kicked.data;
    const near_real behind = pl_kick_behind(kicked, slot) * start;
    body->w += body->inv_inertia * (all - behind);
    kicked[4 * (size_t)slot + 2] += body->inv_inertia * behind;
}

// Adds to what bodies spin by what the joints' impulses make of their inertia, `share` of it.
static void spin(const joint_system *s, near_real share)
{
    for (uint32_t c = s->first; c < s->end; ++c) {
        const pl_lone *l = &s->parts[c].lone;
        const pl_joint *j = l->joint;
        real a[2] = { 0, 0 }, b[2] = { 0, 0 };
        for (int i = 0; i < j->rows.count; ++i) {
            const pl_row *r = &j->rows.row[i];
            if (r->type != PL_ROW_OFF) {
                a[0] += r->aw * j->impulse[i], a[1] += r->aw * j->half[i].start;
                b[0] += r->bw * j->impulse[i], b[1] += r->bw * j->half[i].start;
            }
        }
        turn(s, l->a, j->slot_a, share * (near_real)a[0], share * (near_real)a[1]);
        turn(s, l->b, j->slot_b, share * (near_real)b[0], share * (near_real)b[1]);
    }
}

static void reset_inertia(const joint_system *s)
{
    for (uint32_t c = s->first; c < s->end; ++c) {
        pl_lone *l = &s->parts[c].lone;
        l->a->inv_inertia = own_inertia(s, c, 0);
        l->b->inv_inertia = own_inertia(s, c, 1);
    }
}

static void keep_inertia(const joint_system *s)
{
    for (uint32_t c = s->first; c < s->end; ++c) {
        pl_direct_part *p = &s->parts[c];
        p->inertia[0] = p->lone.a->inv_inertia;
        p->inertia[1] = p->lone.b->inv_inertia;
    }
}

// No body has less than it had.
static void hold_inertia(const joint_system *s)
{
    for (uint32_t c = s->first; c < s->end; ++c) {
        pl_direct_part *p = &s->parts[c];
        pl_solver_body *body[2] = { p->lone.a, p->lone.b };
        for (int i = 0; i < 2; ++i) {
            if (p->inertia[i] < body[i]->inv_inertia) {
                body[i]->inv_inertia = p->inertia[i];
            }
        }
    }
}

// Geometric stiffness by the impulses that the solution found would make: a chain that snaps taut is not yet tense
// when the step begins. True: some body got more inertia.
static bool stiffen(const joint_system *s)
{
    const near_real h = (near_real)s->context->h;
    bool any = false;
    spin(s, -1);
    keep_inertia(s);
    reset_inertia(s);
    for (uint32_t c = s->first; c < s->end; ++c) {
        pl_direct_part *p = &s->parts[c];
        const pl_joint *j = p->lone.joint;
        double total[PL_JOINT_ROWS] = { 0 };
        for (int k = 0; k < p->count; ++k) {
            total[p->row[k]] = (double)j->impulse[p->row[k]] + p->x[k];
        }
        near_real pull[2];
        pl_law_pulls(j, total, pull);
        const near_real own_a = own_inertia(s, c, 0), own_b = own_inertia(s, c, 1);
        any |= pl_joint_inertia(pull[0], h, own_a) > 0 || pl_joint_inertia(pull[1], h, own_b) > 0;
        pl_joint_stiffen(p->lone.a, pull[0], h, own_a);
        pl_joint_stiffen(p->lone.b, pull[1], h, own_b);
    }
    hold_inertia(s);
    spin(s, 1);
    return any;
}

// A link that flutters under a tension of which the substep knew nothing.
static void slow_down(const joint_system *s)
{
    const near_real most = (near_real)MOST_TURN / (near_real)s->context->h;
    for (uint32_t c = s->first; c < s->end; ++c) {
        pl_lone *l = &s->parts[c].lone;
        pl_solver_body *body[2] = { l->a, l->b };
        for (int i = 0; i < 2; ++i) {
            if (body[i]->inv_inertia < own_inertia(s, c, i)) {
                near_real w = body[i]->w;
                body[i]->w = w > most ? most : w < -most ? -most : w;
            }
        }
    }
}

//---- all -----------------------------------------------------------------------------------------

// `arcs`: with what the bodies' turning does to the anchors within the substep.
static void fill_sides(const joint_system *s, bool arcs)
{
    for (uint32_t c = s->first; c < s->end; ++c) {
        pl_direct_part *p = &s->parts[c];
        const pl_lone *l = &p->lone;
        const pl_joint *j = l->joint;
        const pl_row *row = j->rows.row;
        real arc[2] = { 0, 0 };
        if (arcs && row[0].form == PL_FORM_POINT_X && row[0].type == PL_ROW_EQUAL) {
            pl_one_add_arc(arc, l->a->w, j->h, row[0].aw, row[1].aw);
            pl_one_add_arc(arc, l->b->w, j->h, row[0].bw, row[1].bw);
        } else if (arcs && row[0].type == PL_ROW_EQUAL && row[0].spring == PL_SPRING_NONE) {
            arc[0] = pl_one_bow(&row[0], l->a, l->b, j->h);
        }
        for (int k = 0; k < p->count; ++k) {
            const int i = p->row[k];
            p->x[k] = lack_of(p, i) - p->law[i].give * (double)j->impulse[i] -
                      (i < 2 ? (double)arc[i] : 0);
        }
    }
}

static void apply(const joint_system *s)
{
    for (uint32_t c = s->first; c < s->end; ++c) {
        pl_direct_part *p = &s->parts[c];
        for (int k = 0; k < p->count; ++k) {
            push(p, p->row[k], (double)p->lone.joint->impulse[p->row[k]] + p->x[k]);
        }
    }
}

static void factor(const joint_system *s)
{
    for (uint32_t c = s->first; c < s->end; ++c) {
        number_unknowns(&s->parts[c]);
    }
    assemble(s);
    for (uint32_t c = s->first; c < s->end; ++c) {
        eliminate(s, c);
    }
}

// Holds those who would leave their bounds, and whom that makes leave theirs, until none does.
static void hold_all(const joint_system *s, bool arcs)
{
    for (int pass = 0; pass < PASSES && hold_to_bounds(s); ++pass) {
        factor(s);
        fill_sides(s, arcs);
        substitute(s);
    }
}

static void solve_system(const joint_system *s, pl_joint_sweep sweep)
{
    for (uint32_t c = s->first; c < s->end; ++c) {
        open_part(s, c, sweep);
    }
    for (int pass = 0; pass < PASSES; ++pass) {
        factor(s);
        fill_sides(s, false);
        substitute(s);
        if (pass == 0 && sweep == PL_SWEEP_PULL && stiffen(s)) {
            continue;
        }
        if (pass < PASSES - 1 && hold_to_bounds(s)) {
            continue;
        }
        hold_all(s, false);
        apply(s);
        if (sweep == PL_SWEEP_PULL) {
            fill_sides(s, true);
            substitute(s);
            hold_all(s, true);
            apply(s);
        }
        if (!let_go(s)) {
            break;
        }
    }
    slow_down(s);
}

// One system behind another (direct_plan.c): who is at a bound, and how often that is asked, is a matter of each.
void pl_direct_solve(const pl_joint_context *context, pl_joint_sweep sweep)
{
    const pl_direct *direct = &context->world->joints.plan.direct;
    joint_system s = { .context = context,
                       .columns = direct->columns.data,
                       .entries = direct->entries.data,
                       .parts = direct->parts.data,
                       .blocks = direct->blocks.data,
                       .end = context->group->direct_first,
                       .all = direct->column_count };
    while (s.end < context->group->direct_end) {
        s.first = s.end;
        while (s.columns[s.end++].count > 0) {
        }
        solve_system(&s, sweep);
    }
}
