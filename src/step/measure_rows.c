// measure_rows.c - what each row of the substeps does to the energy of its cluster's bodies.
//
// Around a row, the kinetic energy and height of each body are taken. An impulse p at J changes kinetic energy by
// J (v before + v behind) / 2 p, and of several these add up to all of the change, in whatever order they were given: so
// what a sweep did is shared out by how the impulses changed, without a look into the sweep. The same holds for
// accelerations, and for the impulses that a substep begins with: the soft step gives them body by body, with gravity
// (soft.c).
//
// Everything is kept a body, and added up in order of bodies (measure.c): the same bits with any number of threads.
//
// Reads: solver bodies, impulses. Writes: what is measured. Order: around each row. Cost: O(bodies + contacts +
// joints) a row, on the cluster's thread.
#include "joints/measure.h"
#include "step/measure.h"
#include "solver/measure.h"
#include "world/measured.h"
#include "world/state.h"

#include <math.h>
#include <string.h>

// What is to be found out about a row.
typedef enum row_kind {
    ROW_MOMENT,  // an effect: changes accelerations, or velocities
    ROW_DAMPING, // likewise, anew in each substep
    ROW_INTEGRATE, // gives what accelerations make of the substep, and by the soft step the impulses so far
    ROW_WARM_JOINTS,
    ROW_WARM_CONTACTS,
    ROW_HALVE,  // takes a share of the kick back
    ROW_DRIFT,  // moves bodies, and gives that share
    ROW_JOINTS, // sweeps
    ROW_CONTACTS,
    ROW_RELAX_CONTACTS, // takes out of velocities what pushed overlaps apart
    ROW_EXACT_PULL,     // takes half of the kick back, and gives all impulses anew
    ROW_EXACT_RELAX,    // gives that half, and what impulses changed by since
    ROW_WORK            // all that it does is of one kind
} row_kind;

typedef struct row_rule {
    pl_substep_fn *run;
    row_kind kind;
    plumb_work work;
} row_rule;

static const row_rule rules[] = {
    { pl_damping_row, ROW_DAMPING, PLUMB_WORK_DAMPING },
    { pl_fluid_row, ROW_MOMENT, PLUMB_WORK_FLUIDS },
    { pl_dipole_row, ROW_MOMENT, PLUMB_WORK_LAWS },
    { pl_law_row, ROW_MOMENT, PLUMB_WORK_LAWS },
    { pl_softbodies_row, ROW_MOMENT, PLUMB_WORK_SOFT },
    { pl_thrust_row, ROW_MOMENT, PLUMB_WORK_THRUST },
    { pl_drag_row, ROW_MOMENT, PLUMB_WORK_DAMPING },
    { pl_caps_row, ROW_MOMENT, PLUMB_WORK_DAMPING },
    { pl_acting_reset, ROW_WORK, PLUMB_WORK_REST },
    { pl_soft_integrate, ROW_INTEGRATE, PLUMB_WORK_FORCES },
    { pl_classic_integrate, ROW_INTEGRATE, PLUMB_WORK_FORCES },
    { pl_joints_row_warm_start, ROW_WARM_JOINTS, PLUMB_WORK_JOINTS },
    { pl_soft_warm_start, ROW_WARM_CONTACTS, PLUMB_WORK_NORMAL },
    { pl_classic_warm_start, ROW_WARM_CONTACTS, PLUMB_WORK_NORMAL },
    { pl_soft_impacts, ROW_WORK, PLUMB_WORK_IMPACTS },
    { pl_classic_impacts, ROW_WORK, PLUMB_WORK_IMPACTS },
    { pl_joints_row_strike, ROW_WORK, PLUMB_WORK_IMPACTS },
    { pl_joints_row_solve, ROW_JOINTS, PLUMB_WORK_JOINTS },
    { pl_joints_row_classic, ROW_JOINTS, PLUMB_WORK_JOINTS },
    { pl_joints_row_relax, ROW_JOINTS, PLUMB_WORK_JOINTS },
    { pl_joints_row_correct, ROW_WORK, PLUMB_WORK_JOINTS },
    { pl_soft_contacts, ROW_CONTACTS, PLUMB_WORK_NORMAL },
    { pl_classic_contacts, ROW_CONTACTS, PLUMB_WORK_NORMAL },
    { pl_soft_follow_moment, ROW_WORK, PLUMB_WORK_NORMAL },
    { pl_soft_relax, ROW_RELAX_CONTACTS, PLUMB_WORK_NORMAL },
    { pl_classic_correct, ROW_WORK, PLUMB_WORK_RECOVERY },
    { pl_exact_warm_start_joints, ROW_WARM_JOINTS, PLUMB_WORK_JOINTS },
    { pl_exact_warm_start, ROW_WARM_CONTACTS, PLUMB_WORK_NORMAL },
    { pl_exact_pull, ROW_EXACT_PULL, PLUMB_WORK_NORMAL },
    { pl_exact_relax, ROW_EXACT_RELAX, PLUMB_WORK_NORMAL },
    { pl_soft_halve, ROW_HALVE, PLUMB_WORK_FORCES },
    { pl_soft_move, ROW_DRIFT, PLUMB_WORK_GRAVITY },
    { pl_move_bodies, ROW_WORK, PLUMB_WORK_GRAVITY },
    { pl_classic_move, ROW_WORK, PLUMB_WORK_GRAVITY },
};

// Rows that no rule names: systems, and what else is of the moment, are forces, and else nobody knows.
static row_rule rule_of(const pl_substep *s)
{
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; ++i) {
        if (rules[i].run == pl_substep_fn_of(s)) {
            return rules[i];
        }
    }
    const pl_substep_rows *rows = s->solving->step->rows;
    const bool forces = s->row->system != PL_NO_SYSTEM ||
                        (uint32_t)(s->row - rows->items) < rows->end[PL_SUBSTEP_FORCES];
    return (row_rule){ pl_substep_fn_of(s), ROW_WORK,
                       forces ? PLUMB_WORK_FORCES : PLUMB_WORK_REST };
}

static bool is_soft(const pl_substep *s)
{
    return s->world->desc.solver == PLUMB_SOLVER_SOFT && !s->solving->exact;
}

static pl_measuring measuring_of(const pl_substep *s)
{
    return (pl_measuring){ .bodies = s->world->measure.bodies.data,
                           .count = s->world->solver.dynamic_slots };
}

//---- before --------------------------------------------------------------------------------------

static double booked(const pl_measured_body *b)
{
    double sum = 0;
    for (int i = 0; i < PLUMB_WORKS; ++i) {
        sum += b->work[i].kinetic;
    }
    return sum;
}

static void note_bodies(const pl_substep *s)
{
    const pl_solver *solver = &s->world->solver;
    const pl_slots slots = s->cluster->slots[0];
    pl_measured_body *measured = s->world->measure.bodies.data;
    for (uint32_t i = slots.first; i < slots.first + slots.count; ++i) {
        const pl_solver_body *body = &pl_solver_bodies(solver)[i];
        const pl_solver_motion *motion = &pl_solver_motions(solver)[i];
        pl_measured_body *b = &measured[i];
        b->vx = (double)body->vx, b->vy = (double)body->vy, b->w = (double)body->w;
        b->dx = (double)body->dx, b->dy = (double)body->dy;
        b->ax = (double)motion->ax, b->ay = (double)motion->ay, b->aw = (double)motion->aw;
        b->booked = booked(b);
    }
}

// A thread's copy of what its cluster has in a buffer of the solver's, in the measure's of the same layout.
static void *copy_of(const pl_substep *s, const pl_buffer *to, size_t record)
{
    return (char *)to->data + (size_t)s->thread * s->world->solver.bundle_room * record;
}

static void keep_contacts(const pl_substep *s)
{
    const pl_measure *m = &s->world->measure;
    const pl_contact_kernels *kernels = s->solving->step->kernels;
    const size_t count = is_soft(s)
                             ? s->cluster->color_first[PL_COLOR_SLOTS]
                             : pl_classic_count(&s->world->solver, s->world->narrow.manifold_count);
    if (count == 0) { // then there may be no room for any
        return;
    }
    if (!is_soft(s)) {
        memcpy(m->classic.data, s->world->solver.classic.data, count * sizeof(pl_classic_contact));
        return;
    }
    memcpy(copy_of(s, &m->bundles, kernels->bundle_size), s->solving->call.bundles,
           count * kernels->bundle_size);
    if (s->solving->call.extras != NULL) {
        memcpy(copy_of(s, &m->extras, kernels->extra_size), s->solving->call.extras,
               count * kernels->extra_size);
    }
}

static void forget_kicks(const pl_substep *s)
{
    const pl_slots slots = s->cluster->slots[0];
    pl_measured_body *measured = s->world->measure.bodies.data;
    for (uint32_t i = slots.first; i < slots.first + slots.count; ++i) {
        memset(measured[i].kick, 0, sizeof measured[i].kick);
    }
}

void pl_measure_before_row(pl_substep *s)
{
    const row_kind kind = rule_of(s).kind;
    note_bodies(s);
    if (kind == ROW_INTEGRATE) {
        forget_kicks(s);
    }
    const bool exact = kind == ROW_EXACT_PULL || kind == ROW_EXACT_RELAX;
    if (kind == ROW_CONTACTS || kind == ROW_RELAX_CONTACTS || exact) {
        keep_contacts(s);
    }
    if ((kind == ROW_JOINTS || exact) && s->solving->any_joints) {
        pl_joints_keep(s->solving->joints, s->thread);
    }
}

//---- behind --------------------------------------------------------------------------------------

static void find_means(const pl_substep *s)
{
    const pl_slots slots = s->cluster->slots[0];
    pl_measured_body *measured = s->world->measure.bodies.data;
    for (uint32_t i = slots.first; i < slots.first + slots.count; ++i) {
        const pl_solver_body *body = &pl_solver_bodies(&s->world->solver)[i];
        pl_measured_body *b = &measured[i];
        b->mean_x = (b->vx + (double)body->vx) / 2;
        b->mean_y = (b->vy + (double)body->vy) / 2;
        b->mean_w = b->inertia > 0 ? (b->w + (double)body->w) / 2 : 0;
    }
}

static double gained(const pl_measured_body *b, const pl_solver_body *body)
{
    return b->mass *
               (((double)body->vx - b->vx) * b->mean_x + ((double)body->vy - b->vy) * b->mean_y) +
           b->inertia * ((double)body->w - b->w) * b->mean_w;
}

// All that a body's kinetic energy and height have changed by.
static void book_all(pl_measured_body *b, const pl_solver_body *body, plumb_work work)
{
    b->work[work].kinetic += gained(b, body);
    b->work[work].potential -=
        b->weight_x * ((double)body->dx - b->dx) + b->weight_y * ((double)body->dy - b->dy);
}

static void add_kick(pl_measured_body *b, plumb_work work, double x, double y, double turn)
{
    b->kick[work][0] += x, b->kick[work][1] += y, b->kick[work][2] += turn;
    b->work[work].kinetic += x * b->mean_x + y * b->mean_y + turn * b->mean_w;
}

static void book_force(pl_measured_body *b, plumb_work work, const double force[3], double h)
{
    add_kick(b, work, h * force[0], h * force[1], h * force[2]);
}

// Whom an acceleration comes from: what nobody else has is the user's.
static void book_accelerations(pl_measured_body *b, const pl_solver_motion *motion, double h)
{
    double left[3] = { b->mass * (double)motion->ax - b->pull_x,
                       b->mass * (double)motion->ay - b->pull_y, b->inertia * (double)motion->aw };
    add_kick(b, PLUMB_WORK_GRAVITY, h * b->pull_x, h * b->pull_y, 0);
    for (int i = 0; i < PLUMB_WORKS; ++i) {
        book_force(b, (plumb_work)i, b->push[i], h);
        for (int k = 0; k < 3; ++k) {
            left[k] -= b->push[i][k];
        }
    }
    for (int i = 0; i < PL_STEADY_WORKS; ++i) {
        book_force(b, pl_measure_steady(i), b->steady[i], h);
        for (int k = 0; k < 3; ++k) {
            left[k] -= b->steady[i][k];
        }
    }
    book_force(b, PLUMB_WORK_FORCES, left, h);
    memset(b->push, 0, sizeof b->push);
}

// A share of the kick that is given now, or taken back.
static void book_share(pl_measured_body *b, double share)
{
    for (int i = 0; i < PLUMB_WORKS; ++i) {
        const double *kick = b->kick[i];
        b->work[i].kinetic +=
            share * (kick[0] * b->mean_x + kick[1] * b->mean_y + kick[2] * b->mean_w);
    }
}

static void book_drift(pl_measured_body *b, const pl_solver_body *body, double share)
{
    b->work[PLUMB_WORK_GRAVITY].potential -=
        b->weight_x * ((double)body->dx - b->dx) + b->weight_y * ((double)body->dy - b->dy);
    book_share(b, share);
}

// What an effect makes of an acceleration. Where no row has reset it, damping began from the step's own.
static void note_push(const pl_substep *s, uint32_t slot, pl_measured_body *b, row_rule rule)
{
    const plumb_world *world = s->world;
    const pl_solver_motion *motion = &pl_solver_motions(&world->solver)[slot];
    double from[] = { b->ax, b->ay, b->aw };
    const bool is_new = motion->ax != (near_real)b->ax || motion->ay != (near_real)b->ay ||
                        motion->aw != (near_real)b->aw;
    if (rule.kind == ROW_DAMPING && !world->effects.resets) {
        const near_real *base = (const near_real *)world->effects.bases.data + (size_t)slot * 4;
        for (int i = 0; i < 3; ++i) {
            from[i] = (double)base[i];
        }
    } else if (!is_new) {
        return;
    }
    b->push[rule.work][0] += b->mass * ((double)motion->ax - from[0]);
    b->push[rule.work][1] += b->mass * ((double)motion->ay - from[1]);
    b->push[rule.work][2] += b->inertia * ((double)motion->aw - from[2]);
}

// The push that the sweeps over contacts gave for overlaps is in the ways of the substep, and is gone from the
// velocities now: what it lifted is theirs, not gravity's.
static void book_recovery(pl_measured_body *b, const pl_solver_body *body, double h)
{
    const double lifted =
        -h * (b->weight_x * (b->vx - (double)body->vx) + b->weight_y * (b->vy - (double)body->vy));
    b->work[PLUMB_WORK_RECOVERY].potential += lifted;
    b->work[PLUMB_WORK_GRAVITY].potential -= lifted;
}

static void measure_joints(const pl_substep *s, pl_measuring m, bool from_kept,
                           pl_measured_debt debt)
{
    const pl_measure *measure = &s->world->measure;
    if (!s->solving->any_joints) {
        return;
    }
    const size_t room = s->world->joints.plan.room;
    m.kept = from_kept && measure->records.data != NULL
                 ? (const char *)measure->records.data + (size_t)s->thread * room
                 : NULL;
    m.kept_impulses = from_kept ? measure->impulses.data : NULL;
    m.debt = debt;
    pl_joints_measure(s->solving->joints, &m);
}

static void measure_contacts(const pl_substep *s, pl_measuring m, bool from_kept)
{
    const pl_measure *measure = &s->world->measure;
    const pl_contact_kernels *kernels = s->solving->step->kernels;
    const uint32_t count = s->cluster->color_first[PL_COLOR_SLOTS];
    if (!is_soft(s)) {
        pl_classic_measure(s->world, from_kept ? measure->classic.data : NULL, &m);
        return;
    }
    if (count == 0 || s->world->narrow.manifold_count == 0) {
        return;
    }
    m.kept = from_kept ? copy_of(s, &measure->bundles, kernels->bundle_size) : NULL;
    m.kept_extras = from_kept && s->solving->call.extras != NULL
                        ? copy_of(s, &measure->extras, kernels->extra_size)
                        : NULL;
    kernels->measure(&s->solving->call, 0, count, &m);
}

static void share_out(const pl_substep *s, row_kind kind)
{
    pl_measuring m = measuring_of(s);
    // The soft step warm starts in its first substep, and from then on body by body, as it integrates; the exact solver where
    // something bounces.
    const bool soft = is_soft(s);
    const bool exact = s->solving->exact || s->world->desc.solver == PLUMB_SOLVER_EXACT;
    // Of the exact solver's kick, half is taken back and given again: the forces', not what impulses begin with.
    m.kicks =
        !exact && (kind == ROW_INTEGRATE || kind == ROW_WARM_JOINTS || kind == ROW_WARM_CONTACTS);
    const bool starts = soft ? s->first : !exact || s->solving->elastic;
    switch (kind) {
    case ROW_INTEGRATE:
        if (soft && !s->first) {
            measure_contacts(s, m, false);
            measure_joints(s, m, false, PL_DEBT_OPEN);
        }
        break;
    case ROW_WARM_JOINTS:
        if (starts) {
            measure_joints(s, m, false, PL_DEBT_NONE);
        }
        break;
    case ROW_WARM_CONTACTS:
        if (starts) {
            measure_contacts(s, m, false);
        }
        break;
    case ROW_JOINTS:
        measure_joints(s, m, true,
                       !soft || !s->first_sweep                     ? PL_DEBT_NONE
                       : pl_substep_fn_of(s) == pl_joints_row_solve ? PL_DEBT_PAID
                                                                    : PL_DEBT_PAID_BEHIND);
        break;
    case ROW_CONTACTS:
    case ROW_RELAX_CONTACTS:
        measure_contacts(s, m, true);
        break;
    case ROW_EXACT_PULL:
    case ROW_EXACT_RELAX: {
        const bool from_kept = kind == ROW_EXACT_RELAX || s->solving->elastic;
        measure_contacts(s, m, from_kept);
        measure_joints(s, m, from_kept, PL_DEBT_NONE);
        break;
    }
    default:
        break;
    }
}

// An impulse moves the mass that a fluid lends as well, and what of it that takes is the fluid's. Fuel that burns makes a body lighter.
static plumb_work lender_of(const pl_measured_body *b)
{
    return b->met > b->mass ? PLUMB_WORK_FLUIDS : PLUMB_WORK_THRUST;
}

// What the exact solver did: half of the forces' kick, back or forth, the impulses, booked by now, and the rest, which is
// what turning made of them, and bodies that nothing pushes, which keep the kick whole.
static void book_exact(pl_measured_body *b, const pl_solver_body *body, double share)
{
    book_share(b, share);
    const plumb_work rest = b->borrows ? lender_of(b) : PLUMB_WORK_NORMAL;
    b->work[rest].kinetic += gained(b, body) - (booked(b) - b->booked);
}

static void book_body(const pl_substep *s, uint32_t slot, row_rule rule)
{
    const pl_solver *solver = &s->world->solver;
    const pl_solver_body *body = &pl_solver_bodies(solver)[slot];
    pl_measured_body *b = (pl_measured_body *)s->world->measure.bodies.data + slot;
    if (rule.kind == ROW_WORK) {
        book_all(b, body, rule.work);
    } else if (rule.kind == ROW_DAMPING || rule.kind == ROW_MOMENT) {
        book_all(b, body, rule.work); // of magnetic fields, which turn velocities
        note_push(s, slot, b, rule);
    } else if (rule.kind == ROW_HALVE || rule.kind == ROW_DRIFT) {
        const double share = (double)pl_kick_behind(solver->kicked.data, slot);
        if (rule.kind == ROW_HALVE) {
            book_share(b, -share);
        } else {
            book_drift(b, body, share);
        }
    } else if (rule.kind == ROW_INTEGRATE) {
        book_accelerations(b, &pl_solver_motions(solver)[slot], (double)s->h);
    } else if (rule.kind == ROW_RELAX_CONTACTS) {
        book_recovery(b, body, (double)s->h);
    } else if (rule.kind == ROW_EXACT_PULL || rule.kind == ROW_EXACT_RELAX) {
        book_exact(b, body, rule.kind == ROW_EXACT_PULL ? -0.5 : 0.5);
        return;
    }
    // Joints may give a body more inertia than its own (pl_joint_inertia), and those that are solved together slow down
    // links that flutter: what that does is theirs.
    const bool joints_know =
        body->inv_inertia != b->ease || (s->solving->any_joints && pl_joints_direct(s->world));
    if ((joints_know || b->borrows) && rule.kind != ROW_WORK) {
        b->work[b->borrows ? lender_of(b) : PLUMB_WORK_JOINTS].kinetic +=
            gained(b, body) - (booked(b) - b->booked);
    }
}

void pl_measure_after_row(pl_substep *s)
{
    const row_rule rule = rule_of(s);
    const pl_slots slots = s->cluster->slots[0];
    find_means(s);
    share_out(s, rule.kind);
    for (uint32_t slot = slots.first; slot < slots.first + slots.count; ++slot) {
        book_body(s, slot, rule);
    }
}

//---- what is left --------------------------------------------------------------------------------

static void find_imbalance(const pl_substep *s, pl_measuring *found)
{
    const pl_solver *solver = &s->world->solver;
    const pl_slots slots = s->cluster->slots[0];
    pl_measured_body *measured = s->world->measure.bodies.data;
    pl_measuring m = measuring_of(s);
    m.balances = true;
    for (uint32_t i = slots.first; i < slots.first + slots.count; ++i) {
        measured[i].px = measured[i].py = measured[i].pw = 0;
    }
    measure_contacts(s, m, false);
    measure_joints(s, m, false, PL_DEBT_OPEN);
    for (uint32_t i = slots.first; i < slots.first + slots.count; ++i) {
        const pl_measured_body *b = &measured[i];
        const pl_solver_body *body = &pl_solver_bodies(solver)[i];
        const pl_solver_motion *motion = &pl_solver_motions(solver)[i];
        const uint32_t row = ((const uint32_t *)solver->rows.data)[i];
        if ((s->world->bodies.flags[row] & PL_BODY_LOCKED) == 0) {
            const double x = b->met * (double)(body->vx - motion->ux) - b->px;
            const double y = b->met * (double)(body->vy - motion->uy) - b->py;
            pl_measure_most(&found->momentum, sqrt(x * x + y * y));
        }
    }
}

void pl_measure_row(pl_substep *s)
{
    pl_measuring *found = (pl_measuring *)s->world->measure.found.data + s->thread;
    const uint32_t count = s->cluster->color_first[PL_COLOR_SLOTS];
    if (!is_soft(s)) {
        pl_classic_residual(s->world, found);
        return;
    }
    if (count > 0 && s->world->narrow.manifold_count > 0) {
        s->solving->step->kernels->residual(&s->solving->call, 0, count, found);
    }
    find_imbalance(s, found);
}
