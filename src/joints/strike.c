// strike.c - restitution of limits: where a joint's value would pass its bound within the substep, it bounces.
//
// As contacts do (solver/bounce.c): seen along the row, a substep begins at distance s from the bound with speed u under the
// acceleration a of forces and of what joints pull. It strikes at the speed
//     c = sqrt(u^2 - 2 a s)        after        t = 2 s / (c - u)
// and leaves at e c. Rows are those of that moment: a rope has turned until it is taut. Both the velocity and that
// which was integrated get (1 + e) c, and places lose t times as much, so that the substep ends where the parabolas
// do. The classic solver moves bodies by h v where they were pushed: their velocity is that of half a substep ago. In the
// soft step the sweep before the drift wants the rate of the middle, the one behind that of the end (halves.c).
//
// The impulse is that of the row together with the block of the same joint: an angle is struck about the hinge, not about
// the centre. What other joints and contacts have to do with it is left to the sweeps, in which the row
// wants no less than what it was given (the exact solver: no less than 0). Joints with restitution are solved one by one.
//
// Reads: solver bodies, motions, rows. Writes: those bodies and motions, strikes, sums of reactions. Order: in every
// substep, before the sweeps. Cost: O(joints with restitution).
#include "joints/one.h"

#include "plumb/math.h"
#include "world/joint_list.h"
#include "world/state.h"

#include <math.h>

// What a bearing limit's own load makes of a substep, times this, is no blow.
#define CALM 4

// An impulse of 1 along a row, with what the joint's block answers.
typedef struct hit {
    double row[6]; // J of all of it
    double rate;   // [1/kg] by which it changes the row's rate
} hit;

// How the bodies move in the substep if nothing strikes: velocities of A and B at its start, and accelerations.
typedef struct flight {
    double start[6], change[6];
    double ago; // [s] before now, when velocities are what the solver has of them
} flight;

static double along(const double j[6], const double v[6])
{
    return j[0] * v[0] + j[1] * v[1] + j[2] * v[2] + j[3] * v[3] + j[4] * v[4] + j[5] * v[5];
}

static void slope_of(const pl_row *r, double j[6])
{
    j[0] = (double)r->ax, j[1] = (double)r->ay, j[2] = (double)r->aw;
    j[3] = (double)r->bx, j[4] = (double)r->by, j[5] = (double)r->bw;
}

static hit hit_of(const pl_lone *l, int row)
{
    const pl_rows *rows = &l->joint->rows;
    const pl_row *r = &rows->row[row];
    const int n = rows->block;
    real answer[3];
    hit out = { .rate = (double)pl_one_answer(l->joint, row, l->a, l->b, answer) };
    slope_of(r, out.row);
    for (int i = 0; i < n; ++i) {
        double slope[6];
        slope_of(&rows->row[i], slope);
        for (int k = 0; k < 6; ++k) {
            out.row[k] += (double)answer[i] * slope[k];
        }
    }
    return out;
}

// What the joint did in the substep before, where a substep does not begin with it (exact/exact.c).
static void add_own_pull(const pl_lone *l, double push[6])
{
    const pl_joint *j = l->joint;
    for (int i = 0; i < j->rows.count; ++i) {
        double slope[6];
        slope_of(&j->rows.row[i], slope);
        for (int k = 0; k < 6 && j->rows.row[i].type != PL_ROW_OFF; ++k) {
            const pl_solver_body *body = k < 3 ? l->a : l->b;
            const near_real ease = k % 3 == 2 ? body->inv_inertia : body->inv_mass;
            push[k] += (double)ease * slope[k] * (double)j->impulse[i];
        }
    }
}

static flight flight_of(const plumb_world *world, const pl_lone *l, double h)
{
    const pl_solver *s = &world->solver;
    const uint32_t slots[2] = { l->joint->slot_a, l->joint->slot_b };
    flight out = { .start = { 0 } };
    double push[6] = { 0 };
    bool pushed = false;
    for (int i = 0; i < 2; ++i) {
        const pl_solver_body *b = i == 0 ? l->a : l->b;
        const pl_solver_motion *m =
            slots[i] < s->dynamic_slots ? &pl_solver_motions(s)[slots[i]] : NULL;
        const near_real v[3] = { b->vx, b->vy, b->w };
        const near_real u[3] = { m ? m->ux : v[0], m ? m->uy : v[1], m ? m->uw : v[2] };
        const near_real a[3] = { m ? m->ax : 0, m ? m->ay : 0, m ? m->aw : 0 };
        for (int k = 0; k < 3; ++k) {
            push[3 * i + k] = (double)v[k] - (double)u[k];
            pushed |= push[3 * i + k] != 0;
            out.start[3 * i + k] = (double)u[k] - h * (double)a[k];
            out.change[3 * i + k] = (double)a[k];
        }
    }
    if (!pushed && world->desc.solver == PLUMB_SOLVER_EXACT) {
        add_own_pull(l, push);
    }
    // What the classic solver did to meet a blow in the substep before is no force that lasts.
    const bool lasts = world->desc.solver != PLUMB_SOLVER_PGS;
    for (int k = 0; k < 6; ++k) {
        pushed |= push[k] != 0;
        out.change[k] += lasts ? push[k] / h : 0;
    }
    out.ago = pushed && world->desc.solver == PLUMB_SOLVER_PGS ? h / 2 : 0;
    for (int k = 0; k < 6; ++k) {
        out.start[k] += out.ago * out.change[k];
    }
    return out;
}

// Rows where the bodies are at time t of the substep.
static void rows_at(const plumb_world *world, const pl_lone *l, const flight *f, double t)
{
    pl_solver_body then[2] = { *l->a, *l->b };
    for (int i = 0; i < 2; ++i) {
        const double *v = &f->start[3 * i], *a = &f->change[3 * i];
        then[i].dx += (near_real)(t * (v[0] + t * a[0] / 2));
        then[i].dy += (near_real)(t * (v[1] + t * a[1] / 2));
        then[i].da += (near_real)(t * (v[2] + t * a[2] / 2));
    }
    pl_one_rows(world, l->joint, &then[0], &then[1]);
}

static double rate_at(const pl_lone *l, int row, const flight *f, double t)
{
    double slope[6];
    slope_of(&l->joint->rows.row[row], slope);
    return along(slope, f->start) + t * along(slope, f->change);
}

// When it strikes, seen from where the substep begins; `speed` [m/s] or [rad/s], 0 where it does not. An overlap that the
// parabola cannot explain is an old one: struck now, at the speed of now.
static double foresee(double s, double u, double a, double h, double *speed)
{
    *speed = 0;
    if (s + h * u + h * h * a / 2 >= 0 || !(u < 0)) {
        return h;
    }
    const double square = u * u - 2 * a * s, fastest = u + h * a < u ? -(u + h * a) : -u;
    *speed = square > 0 ? sqrt(square) : 0;
    const double time = 2 * s / (*speed - u);
    if (square > 0 && time >= -h && *speed <= fastest) {
        return time;
    }
    *speed = s < 0 ? -u : fastest;
    return s < 0 ? 0 : s / fastest;
}

// Bodies that nothing pushed stay so, to the bit.
static void kick(near_real *v, near_real *u, double change)
{
    const bool free = *u == *v;
    *v = (near_real)((double)*v + change);
    *u = free ? *v : (near_real)((double)*u + change);
}

// `arm` [m]: to what a hinge holds, which is not to leave its place because the body is turned back about it.
static void push(const pl_solver *s, uint32_t slot, pl_solver_body *body, const double j[3],
                 double impulse, double time, plumb_vec2 arm)
{
    if (slot >= s->dynamic_slots) {
        return;
    }
    pl_solver_motion *m = &pl_solver_motions(s)[slot];
    const double x = (double)body->inv_mass * j[0] * impulse;
    const double y = (double)body->inv_mass * j[1] * impulse;
    const double w = (double)body->inv_inertia * j[2] * impulse;
    kick(&body->vx, &m->ux, x);
    kick(&body->vy, &m->uy, y);
    kick(&body->w, &m->uw, w);
    const double turn = time * w, sagging = turn * turn / 2;
    body->dx -= (near_real)(time * x - sagging * (double)arm.x);
    body->dy -= (near_real)(time * y - sagging * (double)arm.y);
    body->da -= (near_real)(time * w);
}

// Rows are those of the moment.
static void strike_bodies(const plumb_world *world, const pl_lone *l, int row, const hit *b,
                          double speed, double time)
{
    pl_joint *j = l->joint;
    const double impulse = (1 + (double)j->desc.restitution) * speed / b->rate;
    const pl_row *r = j->rows.row;
    const bool hinge = j->rows.block == 2 && r[0].form == PL_FORM_POINT_X;
    // The classic solver cannot mend in its substep what other joints make of turning back: a chain would fly to pieces.
    const bool stays = hinge && world->desc.solver == PLUMB_SOLVER_PGS;
    const double back = stays ? 0 : time;
    const plumb_vec2 arm_a = hinge ? plumb_v2(-r[1].aw, r[0].aw) : plumb_v2(0, 0);
    const plumb_vec2 arm_b = hinge ? plumb_v2(r[1].bw, -r[0].bw) : plumb_v2(0, 0);
    push(&world->solver, j->slot_a, l->a, &b->row[0], impulse, back, arm_a);
    push(&world->solver, j->slot_b, l->b, &b->row[3], impulse, back, arm_b);
    j->struck = row;
    if (pl_joint_is_watched(&j->desc)) {
        const plumb_vec2 on_b = plumb_v2((real)(b->row[3] * impulse), (real)(b->row[4] * impulse));
        j->step_impulse = plumb_vec2_add(j->step_impulse, on_b);
        j->step_turn += (real)(b->row[5] * impulse) - plumb_vec2_cross(j->arm_b, on_b);
    }
}

// Whether limit `row` bounces in this substep.
static bool strike(const plumb_world *world, const pl_lone *l, int row, const flight *f, double h)
{
    pl_joint *j = l->joint;
    const pl_solver_body a = *l->a, b = *l->b;
    const double s = (double)j->rows.row[row].error, u = rate_at(l, row, f, 0);
    const double pull = (rate_at(l, row, f, h) - u) / h, e = (double)j->desc.restitution;
    double speed, time = foresee(s, u, pull, h, &speed);
    j->clear |= speed > 0 ? 0 : 1u << row;
    if (!(speed > (double)world->desc.restitution_speed)) {
        return false;
    }
    rows_at(world, l, f, time);
    const double rate = rate_at(l, row, f, time);
    if (s > 0 && rate < 0) { // the row has turned on the way
        time -= (double)j->rows.row[row].error / rate;
        time = time < 0 ? 0 : time > h ? h : time;
        rows_at(world, l, f, time);
        speed = -rate_at(l, row, f, time);
    }
    const hit of = hit_of(l, row);
    const bool calm = speed <= CALM * (double)j->impulse[row] * of.rate;
    const bool leaves = e * speed + pull * (h - time) / 2 > 0;
    const bool due = speed > 0 && of.rate > 0 && !calm && leaves;
    if (due) {
        strike_bodies(world, l, row, &of, speed, time);
        const bool halves = world->desc.solver == PLUMB_SOLVER_SOFT;
        j->struck_change = (real)(halves ? pull * h / 2 : 0);
        j->struck_rate = (real)(e * speed + pull * (h - time - f->ago)) - j->struck_change;
    }
    pl_one_rows(world, j, &a, &b);
    if (due && world->desc.solver == PLUMB_SOLVER_SOFT) {
        pl_one_turn(world, j, l->a, l->b);
    }
    return due;
}

void pl_joints_strike(const pl_joint_context *c)
{
    const double h = (double)c->h;
    for (uint32_t i = c->group->alone; i < c->group->end; ++i) {
        pl_lone l;
        pl_one_take(c, i, &l);
        pl_joint *j = l.joint;
        j->struck = 0;
        j->clear = 0;
        if (!pl_joint_bounces(&j->desc)) {
            continue;
        }
        const flight f = flight_of(c->world, &l, h);
        bool struck = false;
        for (int k = j->rows.block; k < j->rows.count && !struck; ++k) {
            struck = j->rows.row[k].type == PL_ROW_LEAST && strike(c->world, &l, k, &f, h);
        }
    }
}
