// substep.c - clusters of islands through the substeps of a step, row by row.
//
// A large cluster is solved by all threads together, one after another; small ones are in the hands of one thread
// each. What a row is and where it stands is the schedule's: here they are only run. The clock is read around a
// row where somebody asked for times; what threads take is added up a thread, in places of its own.
//
// Reads, writes: what the rows do. Order: after the graph. Cost: the rows', and 5 ns a row, cluster and substep.
#include "solver/substep.h"

#include "core/clock.h"
#include "joints/joint.h"
#include "world/state.h"

// A cluster of more bundles keeps all threads busy, one after another; smaller ones are a thread's each.
#define LARGE 512

static void run_row(pl_substep *s)
{
    const pl_substep_rows *rows = s->solving->step->rows;
    const uint32_t i = (uint32_t)(s->row - rows->items);
    if (rows->before != NULL) {
        rows->before(s);
    }
    const double start = rows->ns == NULL ? 0 : pl_now_ns();
    pl_substep_fn_of(s)(s);
    if (rows->ns != NULL) {
        rows->ns[(size_t)s->thread * rows->count + i] += pl_now_ns() - start;
    }
    if (rows->after != NULL) {
        rows->after(s);
    }
}

static void run_stage(pl_substep *s, pl_substep_stage stage, int times)
{
    const pl_substep_rows *rows = s->solving->step->rows;
    const pl_substep_row *first = rows->items + (stage == 0 ? 0 : rows->end[stage - 1]);
    const pl_substep_row *end = rows->items + rows->end[stage];
    const bool plain = rows->ns == NULL && rows->before == NULL;
    for (int i = 0; i < times; ++i) {
        s->first_sweep = i == 0;
        for (s->row = first; s->row < end; ++s->row) {
            if (pl_substep_fn_of(s) == NULL) {
                continue;
            }
            if (plain) {
                pl_substep_fn_of(s)(s);
            } else {
                run_row(s);
            }
        }
    }
}

// Sweeps that relax. In a fine island many, where a substep of the world ends: in each substep they take as much again as all else.
static int relaxations_of(const pl_substep *s)
{
    const plumb_world_desc *d = &s->world->desc;
    if (s->solving->exact || d->solver == PLUMB_SOLVER_EXACT) {
        return 1;
    }
    if (d->solver != PLUMB_SOLVER_SOFT) {
        return PL_CLASSIC_CORRECTIONS;
    }
    const bool ends = s->solving->fine && (s->number + 1) % s->finer == 0;
    return d->iterations + (ends ? PL_FINE_RELAXATIONS : 0);
}

static void run_substep(pl_substep *s)
{
    const bool exact = s->solving->exact || s->world->desc.solver == PLUMB_SOLVER_EXACT;
    run_stage(s, PL_SUBSTEP_FORCES, 1);
    run_stage(s, PL_SUBSTEP_VELOCITIES, 1);
    run_stage(s, PL_SUBSTEP_CONSTRAINTS, exact ? 1 : s->world->desc.iterations);
    run_stage(s, PL_SUBSTEP_POSITIONS, 1);
    run_stage(s, PL_SUBSTEP_RELAX, relaxations_of(s));
    run_stage(s, PL_SUBSTEP_SUMS, 1);
}

// The step's call for one cluster, in a thread's room for bundles.
static pl_contact_call call_of(const pl_solving_step *step, const pl_cluster *cluster,
                               uint32_t thread)
{
    const size_t room = (size_t)thread * step->world->solver.bundle_room;
    pl_contact_call call = step->call;
    if (call.lanes != NULL) { // else no step has had a contact yet
        call.lanes += cluster->first_lane;
        call.bundles = (char *)call.bundles + room * step->kernels->bundle_size;
    }
    if (call.extras != NULL) {
        call.extras = (char *)call.extras + room * step->kernels->extra_size;
    }
    if (call.specials != NULL) {
        call.specials = (char *)call.specials + room * step->kernels->special_size;
    }
    if (call.grips != NULL) {
        call.grips = (char *)call.grips + room * step->kernels->grip_size;
    }
    if (call.turnings != NULL) {
        call.turnings = (char *)call.turnings + room * step->kernels->turning_size;
    }
    if (call.bounces != NULL) {
        call.bounces = (char *)call.bounces + room * step->kernels->bounce_size;
    }
    return call;
}

// No body is in a contact, has a joint or is in the hands of an effect.
static bool moves_nothing(const plumb_world *world)
{
    return world->solver.slot_count <= 1;
}

// All of a step for one cluster. Joints that hold nothing that moves stay as they are, whoever looks on.
static void run_cluster(const pl_solving_step *step, uint32_t i, pl_tasks *tasks, uint32_t thread)
{
    const pl_cluster *cluster = &pl_clusters(&step->world->solver)[i];
    const bool fine = i == step->world->solver.fine_cluster;
    const int times = fine ? pl_fine_times(step->world) : 1;
    const near_real h = step->call.h / (near_real)times;
    pl_joint_context joints =
        pl_joint_context_of(step->world, i, tasks, thread, (real)h, (real)step->soft_substep);
    joints.recovery = (double)step->call.h / (double)step->soft_substep;
    pl_solving solving = { .step = step,
                           .call = call_of(step, cluster, thread),
                           .joints = &joints,
                           .any_joints = pl_joints_any(&joints) && !moves_nothing(step->world),
                           .elastic = i == 0 && step->elastic,
                           .exact = i == step->world->solver.hard_cluster,
                           .fine = fine };
    pl_substep s = { .world = step->world,
                     .cluster = cluster,
                     .tasks = tasks,
                     .thread = thread,
                     .h = h,
                     .count = step->world->desc.substeps * times,
                     .finer = times,
                     .solving = &solving };
    if (fine) {
        solving.call.h = h;
        solving.call.inv_h = 1 / h;
        solving.call.push_speed *= PL_FINE_PUSH;
        solving.call.finer = (near_real)times;
        solving.call.clock = pl_fine_clock_of(step->world, step->dt);
    }
    run_stage(&s, PL_SUBSTEP_PREPARE, 1);
    for (int k = 0; k < s.count; ++k) {
        s.number = k;
        s.first = k == 0;
        solving.call.since = (near_real)k * s.h;
        run_substep(&s);
    }
    run_stage(&s, PL_SUBSTEP_STORE, 1);
}

// Solved by all threads together. Joints are swept twice as often as contacts.
static bool is_large(const pl_solving_step *step, uint32_t i)
{
    const plumb_world *world = step->world;
    const pl_joint_context joints = pl_joint_context_of(step->world, i, NULL, 0, 0, 0);
    const uint32_t contacts = pl_clusters(&world->solver)[i].color_first[PL_COLOR_SLOTS];
    const uint32_t tied = pl_joints_any(&joints) ? joints.group->color_first[PL_JOINT_COLORS] -
                                                       joints.group->color_first[0]
                                                 : 0;
    return (i == 0 && step->together) || contacts + 2 * tied > LARGE;
}

static void run_small_ones(void *context, uint32_t thread)
{
    const pl_solving_step *step = context;
    const pl_share mine = pl_share_of(step->world->solver.cluster_count, step->threads, thread);
    for (uint32_t i = mine.first; i < mine.end; ++i) {
        if (!is_large(step, i)) {
            run_cluster(step, i, NULL, thread);
        }
    }
}

static pl_solving_step open_step(plumb_world *world, const pl_substep_rows *rows, real dt)
{
    pl_solver *s = &world->solver;
    const near_real h = (near_real)(dt / (real)world->desc.substeps);
    return (pl_solving_step){
        .world = world,
        .kernels = pl_solver_kernels(world),
        .call = { .bodies = pl_solver_bodies(s),
                  .dynamic_slots = s->dynamic_slots,
                  .slots = s->slots.data,
                  .movable_rows = world->dynamic_count + world->kinematic_count,
                  .immovable_slot = s->slot_count - 1,
                  .manifolds = pl_manifolds(&world->narrow),
                  .pairs = pl_pairs(&world->broad.pairs),
                  .rubbed = pl_solver_tallies(world) ? s->rubbed.data : NULL,
                  .h = h,
                  .inv_h = 1 / h,
                  .inv_dt = (near_real)(1 / dt),
                  .cores = world->pieces.core,
                  .kinds = world->pieces.kind,
                  .flags = world->bodies.flags,
                  .world = world },
        .elastic = world->solver.follows_impacts,
        .together = world->solver.follows_impacts || world->effects.any_alone,
        .soft_substep = pl_soft_substep(world, dt),
        .rows = rows,
        .dt = dt,
    };
}

// Whether rows have nothing to act on. Systems run all the same, and who checks rows is told of each.
static bool is_idle(const plumb_world *world, const pl_substep_rows *rows)
{
    return moves_nothing(world) && world->systems.in_substeps == 0 && !rows->alone;
}

void pl_substeps_run(plumb_world *world, const pl_substep_rows *rows, real dt)
{
    if (is_idle(world, rows)) {
        return;
    }
    pl_solving_step step = open_step(world, rows, dt);
    pl_tasks *tasks = rows->alone ? NULL : world->tasks;
    if (world->desc.solver == PLUMB_SOLVER_SOFT) {
        pl_soft_open(world, &step);
    }
    const uint32_t count = world->solver.cluster_count;
    if (count == 1) {
        run_cluster(&step, 0, tasks, 0);
        return;
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (is_large(&step, i)) {
            run_cluster(&step, i, tasks, 0);
        }
    }
    step.threads = pl_tasks_share_count(tasks, count, 1);
    pl_tasks_run(tasks, run_small_ones, &step, step.threads);
}

//---- rows of joints and impacts ------------------------------------------------------------------

void pl_joints_row_prepare(pl_substep *s)
{
    if (s->solving->any_joints) {
        pl_joints_prepare(s->solving->joints);
    }
}

void pl_joints_row_warm_start(pl_substep *s)
{
    // The soft step does that once: see soft.c.
    if (s->solving->any_joints && (s->first || s->world->desc.solver == PLUMB_SOLVER_PGS)) {
        pl_joints_warm_start(s->solving->joints);
    }
}

void pl_joints_row_strike(pl_substep *s)
{
    if (s->solving->any_joints) {
        pl_joints_strike(s->solving->joints);
    }
}

void pl_joints_row_solve(pl_substep *s)
{
    if (s->solving->any_joints) {
        pl_joints_solve(s->solving->joints, PL_SWEEP_PULL, s->first_sweep);
    }
}

void pl_joints_row_relax(pl_substep *s)
{
    if (s->solving->any_joints) {
        pl_joints_solve(s->solving->joints, PL_SWEEP_RELAX, s->first_sweep);
    }
}

void pl_joints_row_classic(pl_substep *s)
{
    if (s->solving->any_joints) {
        pl_joints_solve(s->solving->joints, PL_SWEEP_CLASSIC, false);
    }
}

void pl_joints_row_sum(pl_substep *s)
{
    if (s->solving->any_joints && s->world->joints.watched > 0) {
        pl_joints_tally(s->solving->joints);
    }
}

void pl_joints_row_store(pl_substep *s)
{
    if (s->solving->any_joints) {
        pl_joints_store(s->solving->joints);
    }
}

void pl_impacts_row_prepare(pl_substep *s)
{
    if (s->solving->elastic) {
        pl_impacts_prepare(s->world, s->h * (near_real)s->count);
    }
}

void pl_impacts_row_classic(pl_substep *s)
{
    if (s->solving->elastic) {
        pl_impacts_prepare_classic(s->world, s->h * (near_real)s->count);
    }
}
