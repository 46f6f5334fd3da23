// one.c - one joint in the solvers: how its rows are solved, and what the turning of its bodies does.
//
// A rigid row first is a stiff soft one (backward Euler: Catto, Soft Constraints, GDC 2011); after
// the bodies have moved it is solved again, for C' = 0, with the Jacobian of where they are then.
// The way of a substep is thus a chord between two places on the circle, left and reached at equal
// angles, and no speed is lost to turning, as in RATTLE (Andersen 1983): a pendulum keeps its
// amplitude. Taking all of C back with impulses that never yield holds one joint better, and shakes
// bridges to pieces. The chord is met by the last sweep that pulls: it adds to the rows of a point what
// the arcs of the anchors make of a substep (add_arc). DECISIONS.md says why not by all sweeps, and not by J.
//
// soft.c warm starts body by body, v += v - u, with the directions of the substep before; halves.c gives a share of that
// behind the motion. What came before is along the J of then, what comes behind is to be along that of now, J'. So behind the
// motion (J' - J)^T start is paid of the share; (J' - J)^T of all other impulses is owed, and paid in the halves of the next
// substep. Else a stale pull along the old direction would feed energy to whatever swings.
//
// Springs as rows of their own are exact oscillators (spring.c). Those of blocks, and of the classic solver: b = 1 / (1 + 2
// z x + 2 (z x)^2 + x^4 / (1 + x^2)), x = h w, and the impulse such that v' = b (v - h w^2 C). The first terms are
// exp(-2 z x); the last makes stiff springs implicit, hence stable. At rest w^2 C is the acceleration, exactly.
//
// joint.simd.c does the same with several at a time. Reads: joints, body columns. Writes: solver bodies, impulses. Cost: O(1).
#include "joints/one.h"

#include "plumb/math.h"
#include "world/joint_list.h"
#include "world/state.h"

#include <string.h>

// Frequency of a rigid row as a share of the substep rate, and its damping ratio (DECISIONS.md).
#define SHARE ((real)0.35)
#define ZETA  ((real)3)
#define TAU   ((real)6.2831853071795864769)

// Of a rigid row that pulls. `soft` [s]: the substep that it is as stiff for (pl_soft_substep).
pl_joint_soft pl_joint_rigid(real h, real soft)
{
    const real x = TAU * SHARE * (h / soft), stiff = x * (2 * ZETA + x);
    return (pl_joint_soft){ stiff / (1 + stiff), x * x / (1 + stiff) / h, 1 / (1 + stiff), 0 };
}

static pl_joint_soft soften(const pl_joint_context *c, const pl_row *row, real mass,
                            pl_joint_sweep sweep, uint32_t degree)
{
    if (pl_row_is_spring(row) && sweep != PL_SWEEP_CLASSIC) {
        return pl_joint_oscillator(row, mass, c->h, degree).half[sweep == PL_SWEEP_RELAX];
    }
    const bool pulls =
        sweep == PL_SWEEP_PULL && row->type != PL_ROW_DRIVE && row->spring == PL_SPRING_NONE;
    return pulls ? c->rigid : pl_joint_spring(row, mass, c->h);
}

//---- one row -------------------------------------------------------------------------------------

real pl_one_rate(const pl_row *r, const pl_solver_body *a, const pl_solver_body *b)
{
    return (r->ax * a->vx + r->ay * a->vy + r->aw * a->w) +
           (r->bx * b->vx + r->by * b->vy + r->bw * b->w);
}

// What an impulse does to the velocity (x, y, turn) of a body, or a shift to its place.
static void give(const pl_solver_body *body, near_real *x, near_real *y, near_real *turn, real jx,
                 real jy, real jw, real amount)
{
    *x = (near_real)(*x + body->inv_mass * jx * amount);
    *y = (near_real)(*y + body->inv_mass * jy * amount);
    *turn = (near_real)(*turn + body->inv_inertia * jw * amount);
}

void pl_one_push(const pl_row *r, pl_solver_body *a, pl_solver_body *b, real impulse)
{
    give(a, &a->vx, &a->vy, &a->w, r->ax, r->ay, r->aw, impulse);
    give(b, &b->vx, &b->vy, &b->w, r->bx, r->by, r->bw, impulse);
}

// J M^-1 K^T of two rows.
real pl_one_coupling(const pl_row *r, const pl_row *q, const pl_solver_body *a,
                     const pl_solver_body *b)
{
    return a->inv_mass * (r->ax * q->ax + r->ay * q->ay) + a->inv_inertia * r->aw * q->aw +
           b->inv_mass * (r->bx * q->bx + r->by * q->by) + b->inv_inertia * r->bw * q->bw;
}

// Of what is meant for small angles: 1 at 0, faded out up to a radian, from where it leads nowhere near.
static real fading(real x)
{
    const real xx = x * x;
    return xx < 1 ? 1 - xx * xx : 0;
}

real pl_one_bow(const pl_row *r, const pl_solver_body *a, const pl_solver_body *b, real h)
{
    const real across = (r->bx * (b->vy - a->vy) - r->by * (b->vx - a->vx)) +
                        (r->along_b * b->w - r->along_a * a->w);
    const real turn = across * r->over, of_a = fading(h * a->w) * a->w * a->w;
    const real of_b = fading(h * b->w) * b->w * b->w;
    const real bow = fading(h * turn) * across * turn;
    return h / 2 * (bow + (of_a * r->along_a - of_b * r->along_b));
}

bool pl_one_is_limited(const pl_joint *j, int i)
{
    const pl_row *drive = &j->rows.row[i], *upper = drive - 1;
    return drive->type == PL_ROW_DRIVE && i - 2 >= j->rows.block && upper->type == PL_ROW_LEAST &&
           upper->form == drive->form;
}

real pl_one_drive_speed(const pl_joint *j, int i)
{
    const pl_row *drive = &j->rows.row[i], *lower = drive - 2, *upper = drive - 1;
    if (!pl_one_is_limited(j, i)) {
        return drive->speed;
    }
    const real down = plumb_max(lower->error, 0) / j->h, up = plumb_max(upper->error, 0) / j->h;
    return plumb_min(plumb_max(drive->speed, -down), up);
}

real pl_one_answer(const pl_joint *j, int i, const pl_solver_body *a, const pl_solver_body *b,
                   real answer[3])
{
    const pl_row *r = &j->rows.row[i];
    const int n = j->rows.block;
    real coupled[3] = { 0 }, rate = pl_one_coupling(r, r, a, b);
    for (int k = 0; k < n; ++k) {
        coupled[k] = pl_one_coupling(&j->rows.row[k], r, a, b);
    }
    for (int k = 0; k < n; ++k) {
        answer[k] = 0;
        for (int m = 0; m < n; ++m) {
            answer[k] -= j->inverse[k][m] * coupled[m];
        }
        rate += coupled[k] * answer[k];
    }
    return rate;
}

// A block that yields or has a bound does not answer.
bool pl_one_is_answered(const pl_joint *j, int i)
{
    const pl_row *block = &j->rows.row[0];
    return j->rows.row[i].type == PL_ROW_LEAST && j->rows.block > 0 &&
           block->type == PL_ROW_EQUAL && block->spring == PL_SPRING_NONE &&
           !(j->rows.block_most < PL_UNBOUNDED);
}

// `answer`: of a limit's block; NULL: none.
static void give_row(pl_joint *j, int i, pl_solver_body *a, pl_solver_body *b, real change,
                     const real answer[3])
{
    pl_one_push(&j->rows.row[i], a, b, change);
    for (int k = 0; k < j->rows.block && answer != NULL && change != 0; ++k) {
        pl_one_push(&j->rows.row[k], a, b, answer[k] * change);
        j->impulse[k] += answer[k] * change;
    }
}

void pl_one_solve_row(const pl_joint_context *c, pl_joint *j, int i, pl_solver_body *a,
                      pl_solver_body *b, pl_joint_sweep sweep, bool first)
{
    const pl_row *r = &j->rows.row[i];
    if (r->type == PL_ROW_OFF || pl_joint_lets_come(j, i, sweep == PL_SWEEP_RELAX)) {
        return;
    }
    const pl_row_half *half = &j->half[i];
    real answer[3], mass = j->mass[i];
    const real own = mass > 0 ? 1 / mass : 0;
    const real whole = pl_one_is_answered(j, i) ? pl_one_answer(j, i, a, b, answer) : 0;
    const bool answered = whole > PL_PIVOT * own;
    mass = answered ? 1 / whole : mass;
    pl_joint_soft s = soften(c, r, j->mass[i], sweep, j->degree);
    bool apart = r->type == PL_ROW_LEAST && r->error > 0;
    if (apart) {
        s = (pl_joint_soft){ 1, 1 / j->h, 0, 0 }; // may close the gap
    }
    real v = pl_one_rate(r, a, b) - pl_one_drive_speed(j, i);
    if (i > 0 && i == j->struck) { // behind a blow it is on its way out
        s = (pl_joint_soft){ 1, 0, 0, 0 };
        v -= j->struck_rate;
    } else if (sweep == PL_SWEEP_PULL && !first && r->over != 0 && r->spring == PL_SPRING_NONE) {
        v += pl_one_bow(r, a, b, j->h);
    }
    real old = j->impulse[i];
    real lack = s.velocity * v - s.before * half->before + s.error * r->error;
    real total = old - mass * lack - s.impulse * (old - half->lag);
    real most = r->most * j->h;
    total = plumb_clamp(total, r->type == PL_ROW_LEAST ? 0 : -most, most);
    j->impulse[i] = total;
    give_row(j, i, a, b, total - old, answered ? answer : NULL);
}

//---- the block -----------------------------------------------------------------------------------

// Inverse of the block's K by Gauss-Jordan; a direction in which nothing can move is left out.
static void invert(pl_joint *j, const pl_solver_body *a, const pl_solver_body *b)
{
    const int n = j->rows.block;
    real k[3][6] = { { 0 } };
    real diagonal[3] = { 0 };
    for (int i = 0; i < n; ++i) {
        for (int m = 0; m < n; ++m) {
            k[i][m] = pl_one_coupling(&j->rows.row[i], &j->rows.row[m], a, b);
        }
        k[i][n + i] = 1;
        diagonal[i] = k[i][i];
    }
    for (int p = 0; p < n; ++p) {
        bool usable = k[p][p] > PL_PIVOT * diagonal[p];
        real inverse = usable ? 1 / k[p][p] : 0;
        for (int m = 0; m < 2 * n; ++m) {
            k[p][m] *= inverse;
        }
        for (int i = 0; i < n; ++i) {
            real factor = i == p ? 0 : k[i][p];
            for (int m = 0; m < 2 * n; ++m) {
                k[i][m] -= factor * k[p][m];
            }
        }
    }
    for (int i = 0; i < n; ++i) {
        for (int m = 0; m < n; ++m) {
            j->inverse[i][m] = k[i][n + m];
        }
    }
}

// Shortens the force of a two-row block to its bound.
static void bound_block(const pl_joint *j, real total[3])
{
    real most = j->rows.block_most * j->h;
    real now = plumb_vec2_magnitude(plumb_v2(total[0], total[1]));
    if (now > most) {
        total[0] *= most / now;
        total[1] *= most / now;
    }
}

// A body that turns by x = h w in a substep takes its anchor r round an arc: it ends (R(x) - 1 - x k x) r
// from where h J v leads. Added to J v of a point, whose rows have w0 and w1 of the body: the series, faded
// out up to a radian, from where a tangent leads nowhere near.
void pl_one_add_arc(real v[2], real w, real h, real w0, real w1)
{
    real x = h * w, xx = x * x;
    if (plumb_abs(x) > PL_LEAST_ARC && plumb_abs(x) < 1) {
        real u = w * (1 - xx * xx);
        real c = -x * u / 2, s = -xx * u / 6;
        v[0] += c * w1 + s * w0;
        v[1] += s * w1 - c * w0;
    }
}

// Of a rigid point of two bodies that move, apart by more than a sweep may draw together, and than its arms sweep over in a substep: the share
// that it may. It gives way less by the same share: so it bears what its spring would.
static real held_back(const pl_joint *j, pl_joint_soft s, const pl_solver_body *a,
                      const pl_solver_body *b)
{
    const pl_row *x = &j->rows.row[0], *y = &j->rows.row[1];
    if (x->form != PL_FORM_POINT_X || !pl_row_is_rigid(x) || !(s.error > 0) || a->inv_mass == 0 ||
        b->inv_mass == 0) {
        return 1;
    }
    const real swept = plumb_abs(a->w) * plumb_max(plumb_abs(x->aw), plumb_abs(y->aw)) +
                       plumb_abs(b->w) * plumb_max(plumb_abs(x->bw), plumb_abs(y->bw));
    const real most = PL_CLOSES / s.error + j->h * swept;
    return most / plumb_max(plumb_max(plumb_abs(x->error), plumb_abs(y->error)), most);
}

// Impulses of a rigid block, or of a spring of one frequency whatever the direction.
static void pull_as_one(const pl_joint *j, pl_joint_soft s, const pl_solver_body *a,
                        const pl_solver_body *b, const real v[3], real total[3])
{
    const int n = j->rows.block;
    const real share = n > 1 ? held_back(j, s, a, b) : 1;
    real wrong[3];
    for (int i = 0; i < n; ++i) {
        const real error = (i < 2 ? share : 1) * j->rows.row[i].error;
        wrong[i] = s.velocity * v[i] - s.before * j->half[i].before + s.error * error;
    }
    for (int i = 0; i < n; ++i) {
        const real gives = s.impulse * (i < 2 ? share : 1);
        total[i] = j->impulse[i] - gives * (j->impulse[i] - j->half[i].lag);
        for (int m = 0; m < n; ++m) {
            total[i] -= j->inverse[i][m] * wrong[m];
        }
    }
}

// A unit direction in which the inverse of K, of two rows, points where it is led.
static plumb_vec2 axis_of(const pl_joint *j)
{
    const real half = (j->inverse[0][0] - j->inverse[1][1]) / 2, mixed = j->inverse[0][1];
    const real root = plumb_vec2_magnitude(plumb_v2(half, mixed));
    const plumb_vec2 axis = half > 0 ? plumb_v2(half + root, mixed) : plumb_v2(mixed, root - half);
    return mixed != 0 ? plumb_vec2_unit(axis) : plumb_v2(1, 0);
}

// Impulses of a spring in newtons, as stiff in all directions, on a block of two rows: along the axes of K each is an
// oscillator by itself, of the mass that it meets there.
static void pull_by_axes(const pl_joint_context *c, const pl_joint *j, pl_joint_sweep sweep,
                         const real v[3], real total[3])
{
    const plumb_vec2 first = axis_of(j), axes[2] = { first, { -first.y, first.x } };
    const pl_row *row = j->rows.row;
    total[0] = total[1] = 0;
    for (int k = 0; k < 2; ++k) {
        const plumb_vec2 u = axes[k];
        const real mass = u.x * (j->inverse[0][0] * u.x + j->inverse[0][1] * u.y) +
                          u.y * (j->inverse[1][0] * u.x + j->inverse[1][1] * u.y);
        if (mass > 0) {
            const pl_joint_soft s = soften(c, &row[0], mass, sweep, j->degree);
            const real rate = u.x * v[0] + u.y * v[1];
            const real before = u.x * j->half[0].before + u.y * j->half[1].before;
            const real error = u.x * row[0].error + u.y * row[1].error;
            const real old = u.x * j->impulse[0] + u.y * j->impulse[1];
            const real lag = u.x * j->half[0].lag + u.y * j->half[1].lag;
            const real lack = s.velocity * rate - s.before * before + s.error * error;
            const real push = old - s.impulse * (old - lag) - mass * lack;
            total[0] += u.x * push, total[1] += u.y * push;
        }
    }
}

void pl_one_solve_block(const pl_joint_context *c, pl_joint *j, pl_solver_body *a,
                        pl_solver_body *b, pl_joint_sweep sweep, bool first)
{
    const int n = j->rows.block;
    const pl_row *row = j->rows.row;
    if (n == 0) {
        return;
    }
    real v[3] = { 0 }, total[3] = { 0 };
    for (int i = 0; i < n; ++i) {
        v[i] = pl_one_rate(&row[i], a, b);
    }
    bool holds = row[0].type == PL_ROW_EQUAL && row[0].spring == PL_SPRING_NONE;
    if (holds && sweep == PL_SWEEP_PULL && !first && row[0].form == PL_FORM_POINT_X) {
        pl_one_add_arc(v, a->w, j->h, row[0].aw, row[1].aw);
        pl_one_add_arc(v, b->w, j->h, row[0].bw, row[1].bw);
    }
    if (row[0].spring == PL_SPRING_NEWTONS) {
        pull_by_axes(c, j, sweep, v, total);
    } else {
        pull_as_one(j, soften(c, &row[0], 0, sweep, j->degree), a, b, v, total);
    }
    if (j->rows.block_most < PL_UNBOUNDED) {
        bound_block(j, total);
    }
    for (int i = 0; i < n; ++i) {
        pl_one_push(&row[i], a, b, total[i] - j->impulse[i]);
        j->impulse[i] = total[i];
    }
}

//---- rows at a pose ------------------------------------------------------------------------------

// Bodies turn little in a step: Taylor's series, off by x^9 / 9! = 3e-15 at most.
static plumb_rot turned_by(real x)
{
    if (plumb_abs(x) > (real)0.1) {
        return plumb_rot_make(x);
    }
    real xx = x * x;
    return (plumb_rot){ 1 - xx / 2 * (1 - xx / 12 * (1 - xx / 30 * (1 - xx / 56))),
                        x * (1 - xx / 6 * (1 - xx / 20 * (1 - xx / 42))) };
}

static pl_joint_pose moved(pl_joint_pose pose, plumb_body of, const pl_solver_body *body)
{
    if (plumb_is_null(of)) {
        return pose;
    }
    pose.x += body->dx;
    pose.y += body->dy;
    if (body->da != 0) {
        plumb_rot turn = turned_by(body->da);
        plumb_vec2 arm = plumb_rot_apply(turn, plumb_v2(pose.rx, pose.ry));
        plumb_rot q = plumb_rot_mul(turn, (plumb_rot){ pose.c, pose.s });
        pose.angle += (double)body->da;
        pose.rx = arm.x, pose.ry = arm.y;
        pose.c = q.c, pose.s = q.s;
    }
    return pose;
}

static void add_momentum(pl_joint *j, real sign)
{
    for (int i = 0; i < j->rows.count; ++i) {
        const pl_row *r = &j->rows.row[i];
        if (j->impulse[i] == 0) {
            continue;
        }
        real impulse = sign * j->impulse[i];
        j->turn[0] += r->ax * impulse, j->turn[1] += r->ay * impulse, j->turn[2] += r->aw * impulse;
        j->turn[3] += r->bx * impulse, j->turn[4] += r->by * impulse, j->turn[5] += r->bw * impulse;
    }
}

void pl_one_rows(const plumb_world *world, pl_joint *j, const pl_solver_body *a,
                 const pl_solver_body *b)
{
    pl_joint_pose pa = moved(j->pose_a, j->a.body, a), pb = moved(j->pose_b, j->b.body, b);
    pl_joint_classes[j->desc.kind]->rows(j, &pa, &pb, &j->rows);
    j->arm_b = plumb_v2(pb.rx, pb.ry);
    if (world->locked_bodies > 0) {
        pl_joint_lock_rows(world, j);
    }
    invert(j, a, b);
    for (int i = j->rows.block; i < j->rows.count; ++i) {
        const pl_row *r = &j->rows.row[i];
        real k = r->type == PL_ROW_OFF ? 0 : pl_one_coupling(r, r, a, b);
        j->mass[i] = k > 0 ? 1 / k : 0;
        j->impulse[i] = k > 0 ? j->impulse[i] : 0;
    }
}

void pl_one_note_springs(pl_joint *j, const pl_solver_body *a, const pl_solver_body *b)
{
    for (int i = 0; i < j->rows.count; ++i) {
        if (pl_row_is_spring(&j->rows.row[i])) {
            j->half[i].before = pl_one_rate(&j->rows.row[i], a, b);
        }
    }
}

void pl_one_let_go(pl_joint *j, const pl_solver_body *a, const pl_solver_body *b)
{
    if (j->struck > 0) {
        const real now = pl_one_rate(&j->rows.row[j->struck], a, b);
        j->struck_rate = plumb_min(j->struck_rate + j->struck_change, now);
    }
}

void pl_one_forget(pl_joint *j)
{
    for (int k = 0; k < 6; ++k) {
        j->turn[k] = 0;
    }
}

static void pay(pl_joint *j, pl_solver_body *a, pl_solver_body *b)
{
    const real *m = j->paid;
    const pl_row owed = { m[0], m[1], m[2], m[3], m[4], m[5], .type = PL_ROW_EQUAL };
    pl_one_push(&owed, a, b, 1);
}

// Before the drift: what has turned by now, but for the share that comes behind.
void pl_one_pay(const pl_joint_context *c, pl_joint *j, pl_solver_body *a, pl_solver_body *b)
{
    const pl_solver *solver = &c->world->solver;
    const near_real *kicked = solver->kicked.data;
    const real share = pl_joint_lag(kicked, solver->dynamic_slots, j->slot_a, j->slot_b);
    j->lag = share;
    const real stiff = share * pl_joint_spared(j->degree);
    j->behind[0] = pl_joint_behind(kicked, solver->dynamic_slots, j->slot_a);
    j->behind[1] = pl_joint_behind(kicked, solver->dynamic_slots, j->slot_b);
    for (int k = 0; k < 6; ++k) {
        j->paid[k] = (1 - j->behind[k / 3]) * j->turn[k];
    }
    pay(j, a, b);
    for (int i = 0; i < j->rows.count; ++i) {
        j->half[i].start = j->impulse[i];
        j->half[i].lag = (pl_row_is_spring(&j->rows.row[i]) ? share : stiff) * j->impulse[i];
    }
}

// Behind the drift: that share; of the impulse with which the substep began, what came behind turns as well. What came
// before the drift was given in the direction of then, and is to turn for the next substep.
void pl_one_refresh(const pl_joint_context *c, pl_joint *j, pl_solver_body *a, pl_solver_body *b)
{
    pl_row old[PL_JOINT_ROWS];
    const real *behind = j->behind;
    memcpy(old, j->rows.row, sizeof old);
    for (int k = 0; k < 6; ++k) {
        j->paid[k] = behind[k / 3] * j->turn[k];
    }
    pl_one_rows(c->world, j, a, b);
    pl_one_forget(j);
    for (int i = 0; i < j->rows.count; ++i) {
        const pl_row *r = &j->rows.row[i], *o = &old[i];
        pl_row_half *half = &j->half[i];
        const real by[6] = { r->ax - o->ax, r->ay - o->ay, r->aw - o->aw,
                             r->bx - o->bx, r->by - o->by, r->bw - o->bw };
        const real due = j->lag * half->start; // of both the same, or momentum would come of it
        for (int k = 0; k < 6; ++k) {
            j->paid[k] += due * by[k];
            j->turn[k] += (j->impulse[i] - due) * by[k];
        }
        half->before = (r->error - o->error) / c->h;
        half->lag = j->impulse[i] - half->lag;
    }
    pay(j, a, b);
}

void pl_one_turn(const plumb_world *world, pl_joint *j, const pl_solver_body *a,
                 const pl_solver_body *b)
{
    add_momentum(j, -1);
    pl_one_rows(world, j, a, b);
    add_momentum(j, 1);
}

//---- positions, for the classic solver -----------------------------------------------------------

static void shift(const pl_row *r, pl_solver_body *a, pl_solver_body *b, real amount)
{
    give(a, &a->dx, &a->dy, &a->da, r->ax, r->ay, r->aw, amount);
    give(b, &b->dx, &b->dy, &b->da, r->bx, r->by, r->bw, amount);
}

void pl_one_move(const pl_joint *j, pl_solver_body *a, pl_solver_body *b, real share)
{
    for (int k = j->rows.count - 1; k >= j->rows.block; --k) {
        if (pl_row_is_rigid(&j->rows.row[k]) && j->rows.row[k].most >= PL_UNBOUNDED) {
            shift(&j->rows.row[k], a, b, -share * j->mass[k] * j->rows.row[k].error);
        }
    }
    bool block =
        j->rows.block > 0 && pl_row_is_rigid(&j->rows.row[0]) && j->rows.block_most >= PL_UNBOUNDED;
    for (int k = 0; block && k < j->rows.block; ++k) {
        real amount = 0;
        for (int m = 0; m < j->rows.block; ++m) {
            amount += j->inverse[k][m] * j->rows.row[m].error;
        }
        shift(&j->rows.row[k], a, b, -share * amount);
    }
}
