// exact.c - the exact solver as rows of the substep.
//
// Every substep is solved twice, like the soft one: with velocities that also undo overlaps and errors, by which the bodies
// move, and again from the same velocities without, which are kept. Bodies are warm started where impacts must know what
// rests; everywhere else impulses of the substep before are only where the solution begins.
//
// Reads, writes: solver bodies, impulses. Order: as schema/passes.h says. Cost: newton.c's.
#include "exact/exact.h"
#include "joints/law.h"
#include "math/compare.h"

#include <math.h>

// Share of the push speed, from which on what undoes errors leaves nothing in the velocities.
#define UNDONE       0.01
#define ASTRAY       0.1 // of the speeds that rows have to undo: a pull that leaves more cannot be obeyed
#define ASTRAY_SHARE 0.05 // of what such a pull undoes

static pl_exact_system system_of(const pl_substep *s, pl_joint_sweep sweep)
{
    pl_exact_solver *e = &s->world->exact;
    const size_t n = 3 * (size_t)e->node_count;
    double *blocks = e->blocks.data, *vectors = e->vectors.data;
    return (pl_exact_system){ .world = s->world,
                              .joints = s->solving->joints,
                              .exact = e,
                              .nodes = e->nodes.data,
                              .entries = e->elimination.entries.data,
                              .items = e->items.data,
                              .rows = e->rows.data,
                              .turnings = e->turnings.data,
                              .diagonal = blocks,
                              .above = blocks + 9 * (size_t)e->node_count,
                              .below = blocks + 9 * ((size_t)e->node_count + e->entry_count),
                              .velocity = vectors,
                              .base = vectors + n,
                              .change = vectors + 2 * n,
                              .step = vectors + 3 * n,
                              .kick = vectors + 4 * n,
                              .full = vectors + 5 * n,
                              .best = vectors + 6 * n,
                              .brisk = vectors + 7 * n,
                              .h = s->h,
                              .since = s->solving->call.since,
                              .inv_dt = (double)s->solving->call.inv_dt,
                              .first = s->first,
                              .sweep = sweep,
                              .recovery = 1 };
}

static bool is_warm(const pl_substep *s)
{
    return s->solving->elastic;
}

void pl_exact_warm_start(pl_substep *s)
{
    if (is_warm(s)) {
        pl_classic_warm_start(s);
    }
}

void pl_exact_warm_start_joints(pl_substep *s)
{
    if (is_warm(s) && s->solving->any_joints) {
        pl_joints_warm_start(s->solving->joints);
    }
}

// A body of the joint or contact swings faster about it, for its pull, than the substep can follow.
static bool is_tense(const pl_exact_system *s, const pl_exact_item *item)
{
    if (item->joint == PL_NONE) {
        return pl_exact_is_pressed(s, item);
    }
    const pl_joint *j = pl_joint_grouped(&s->world->joints, item->joint);
    double impulse[PL_JOINT_ROWS];
    for (uint32_t i = 0; i < PL_JOINT_ROWS; ++i) {
        impulse[i] = s->rows[item->first_row + i].next;
    }
    near_real pull[2];
    pl_law_pulls(j, impulse, pull);
    pull[0] *= 2, pull[1] *= 2; // as much again behind the drift
    return pl_joint_inertia(pull[0], s->h, pl_one_own_inertia(s->world, j, 0)) > 0 ||
           pl_joint_inertia(pull[1], s->h, pl_one_own_inertia(s->world, j, 1)) > 0;
}

// What undoes an error of the joint or contact is a speed to be reckoned with.
static bool is_undone(const pl_exact_system *s, const pl_exact_item *item)
{
    double most = 0;
    for (uint32_t k = item->first_row; k < item->first_row + item->row_count; ++k) {
        most = pl_greater(most, s->rows[k].in_force ? fabs(s->rows[k].undone) : 0);
    }
    return most > UNDONE * (double)s->world->desc.push_speed;
}

// What joints and contacts that turn gave stays in the velocities: relaxed along where they point then, the way of the
// substep is a chord between two places on the circle, left and reached at equal angles (RATTLE, Andersen 1983), and turning
// costs no energy. Not so where links are tense, which would make energy, and where errors could not be undone, or are: there
// springs alone give, as they act once a substep, and the rest is solved anew.
static void keep_given(const pl_exact_system *s)
{
    for (uint32_t i = s->island->first_item; i < s->island->end_item; ++i) {
        const pl_exact_item *item = &s->items[i];
        if (item->joint == PL_NONE &&
            (item->turning == PL_NONE || !s->turnings[item->turning].turns)) {
            continue;
        }
        const bool stays = !s->missed && !is_tense(s, item) && !is_undone(s, item);
        s->rows[item->first_row].stays = stays;
        for (uint32_t k = item->first_row; k < item->first_row + item->row_count; ++k) {
            const pl_exact_row *r = &s->rows[k];
            if (r->in_force && (stays || r->give > 0)) { // springs whatever else
                pl_exact_push(s, r, s->full, r->impulse);
            }
        }
    }
}

static void take_velocities(const pl_exact_system *s)
{
    for (uint32_t n = s->island->first_node; n < s->island->end_node; ++n) {
        pl_exact_node *node = &s->nodes[n];
        const pl_solver_body *body = &pl_solver_bodies(&s->world->solver)[node->slot];
        node->inv_mass[2] = (double)body->inv_inertia;
        s->velocity[3 * n] = (double)body->vx;
        s->velocity[3 * n + 1] = (double)body->vy;
        s->velocity[3 * n + 2] = (double)body->w;
        const pl_solver_motion *motion = &pl_solver_motions(&s->world->solver)[node->slot];
        const double half = (double)s->h / 2;
        s->kick[3 * n] = half * (double)motion->ax;
        s->kick[3 * n + 1] = half * (double)motion->ay;
        s->kick[3 * n + 2] = half * (double)motion->aw;
    }
}

// Bodies that nothing pushes keep their velocities to the bit: they fly by the parabola (integrate.c).
static void give_velocities(const pl_exact_system *s)
{
    for (uint32_t n = s->island->first_node; n < s->island->end_node; ++n) {
        s->nodes[n].where = 0;
    }
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        const pl_exact_row *r = &s->rows[k];
        for (int end = 0; end < 2 && r->in_force && r->next != 0; ++end) {
            if (r->item->node[end] != PL_NONE) {
                s->nodes[r->item->node[end]].where = 1;
            }
        }
    }
    for (uint32_t n = s->island->first_node; n < s->island->end_node; ++n) {
        pl_solver_body *body = &pl_solver_bodies(&s->world->solver)[s->nodes[n].slot];
        const double *v = (s->nodes[n].where != 0 ? s->velocity : s->full) + 3 * (size_t)n;
        body->vx = (near_real)v[0], body->vy = (near_real)v[1], body->w = (near_real)v[2];
    }
}

// Half of the kick comes before the drift, half behind it, and so do impulses (RATTLE, Andersen 1983): what is pushed moves
// to second order in the substep. Where impulses are sought from.
static void begin(const pl_exact_system *s, bool warm)
{
    const bool pulls = s->sweep == PL_SWEEP_PULL;
    if (pulls) {
        if (warm) {
            pl_exact_push_all(s, -1); // they came with the impulses of the substep before
        }
        pl_exact_copy(s, s->full, s->velocity);
        for (uint32_t k = 3 * s->island->first_node; k < 3 * s->island->end_node; ++k) {
            s->velocity[k] -= s->kick[k];
        }
    }
    pl_exact_spring(s, s->velocity);
    if (!pulls) {
        pl_exact_copy(s, s->velocity, s->full);
    }
    pl_exact_copy(s, s->base, s->velocity);
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        pl_exact_row *r = &s->rows[k];
        if (pulls) {
            r->impulse /= 2;
        } else if (!s->missed) {
            r->impulse += r->before / 2;
        }
    }
}

//---- errors undone no faster than they may -----------------------------------------------------------------

// [m/s] the largest change of a body between two sets of velocities.
static double most_between(const pl_exact_system *s, const double *from, const double *to)
{
    double most = 0;
    for (uint32_t k = 3 * s->island->first_node; k < 3 * s->island->end_node; k += 3) {
        const double x = to[k] - from[k], y = to[k + 1] - from[k + 1];
        most = pl_greater(most, x * x + y * y);
    }
    return sqrt(most);
}

// Whether what errors ask for adds up to more than the push speed: rows in a line do, like boxes of a pile that begins with
// overlaps, or links of a chain that is torn.
static bool is_brisk(const pl_exact_system *s)
{
    double sum = 0;
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        sum += s->rows[k].in_force ? fabs(s->rows[k].undone) : 0;
    }
    const double push = (double)s->world->desc.push_speed;
    return sum > push && most_between(s, s->base, s->velocity) > push;
}

// What a pull could not obey, as of bodies in a box too small for them, has velocities that share the errors out; but undone all at
// once they are others in each substep. Islands that nobody asked for have had too few rounds to tell.
static bool is_astray(const pl_exact_system *s)
{
    return s->missed && s->left > ASTRAY && !pl_exact_is_unasked(s->world);
}

// Velocities without undoing anything, and of what undoing adds to them as much as moves no body by more than the push
// speed, and no more than `part`: rows are bounds and lines, so what lies between two sets that obey them obeys them, too.
static void slow_down(pl_exact_system *s, double part)
{
    pl_exact_copy(s, s->brisk, s->velocity);
    pl_exact_copy(s, s->velocity, s->base);
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        pl_exact_row *r = &s->rows[k];
        r->brisk = r->next;
        r->target -= r->undone;
        r->impulse = r->next = r->in_force ? r->before / 2 : 0;
        r->shift = 0;
    }
    s->recovery = 0;
    pl_exact_solve(s);
    s->recovery = 1;
    s->missed = true; // nothing of it stays
    const double push = (double)s->world->desc.push_speed;
    const double most = most_between(s, s->velocity, s->brisk);
    const double share = pl_lesser(part, most > push ? push / most : 1);
    for (uint32_t k = 3 * s->island->first_node; k < 3 * s->island->end_node; ++k) {
        s->velocity[k] += share * (s->brisk[k] - s->velocity[k]);
    }
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        pl_exact_row *r = &s->rows[k];
        r->next += share * (r->brisk - r->next);
        r->impulse = r->next;
    }
}

static void solve_island(pl_exact_system *s, bool warm)
{
    take_velocities(s);
    s->missed = s->sweep == PL_SWEEP_RELAX &&
                s->island->missed; // what could not be undone pushed beyond measure
    pl_exact_fill(s);
    begin(s, warm);
    pl_exact_solve(s);
    if (s->sweep == PL_SWEEP_PULL) {
        if (is_astray(s)) {
            slow_down(s, ASTRAY_SHARE);
        } else if (is_brisk(s)) {
            slow_down(s, 1);
        }
    }
    s->island->missed = s->missed;
    pl_exact_keep(s);
    give_velocities(s);
    if (s->sweep == PL_SWEEP_PULL) {
        keep_given(s);
    }
}

static void solve_all(const pl_substep *substep, pl_joint_sweep sweep)
{
    if (substep->world->exact.island_count == 0) {
        return; // nothing was planned, so there are no arrays
    }
    pl_exact_system s = system_of(substep, sweep);
    pl_exact_island *islands = s.exact->islands.data;
    for (uint32_t i = 0; i < s.exact->island_count; ++i) {
        s.island = &islands[i];
        if (s.island->end_item > s.island->first_item) {
            solve_island(&s, is_warm(substep));
        }
    }
}

void pl_exact_pull(pl_substep *s)
{
    solve_all(s, PL_SWEEP_PULL);
}

void pl_exact_relax(pl_substep *s)
{
    solve_all(s, PL_SWEEP_RELAX);
    if (s->world->desc.solver == PLUMB_SOLVER_SOFT && !pl_solver_tallies(s->world)) {
        pl_classic_sum(s); // no row of this world does
    }
}

void pl_exact_tell(plumb_world *world)
{
    pl_exact_solver *e = &world->exact;
    if (e->missed > 0 && !e->told) {
        e->told = true;
        pl_warn(world, "the exact solver missed its tolerance at %g s: %g of a speed was left",
                world->time, e->residual);
    }
}
