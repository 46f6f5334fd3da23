// soft.c - the soft step: substeps of integrate, impacts, solve with soft contacts, move, relax.
//
// Warm starting within the step is done a body at a time: with anchors frozen, the impulses with
// which a substep ended changed a body's velocity by v - u (u: velocity as integrated), and
// applying them again changes it by the same. So contacts are warm started one by one only at the
// start of the step. Joints likewise, and what their turning changes is
// added in every substep (joints/solve.c); they come before contacts in a sweep.
//
// Free flight is exact: a body that no contact pushed in the substep moves by h v - h^2 a / 2, the
// parabola, instead of h v. A pushed body moves by h v; the parabola would make resting bodies hop.
//
// Clusters of islands go through all of it one after another, small ones in the hands of one thread each.
//
// Reads: solver bodies, lanes. Writes: solver bodies, impulses of pairs. Order: after the graph.
// Cost: (2 substeps x iterations + 2) sweeps over the contacts, 2 substeps passes over the bodies.
#include "core/quad.h"
#include "world/state.h"

// Contact frequency as a share of the substep rate. Stiffer contacts sink less, as the square, but from
// 3/16 on a pyramid of 100 rows takes long to come to rest and leans, and from 1/4 on one of 20 never
// rests, at one sweep a substep (DECISIONS.md has the table).
#define STIFFEST ((near_real)(1.0 / 6))

typedef struct flight {
    const pl_solver *solver;
    uint32_t first; // slot
    near_real h;    // [s]
} flight;

// v = u + h a, plus what the contacts did in the substep before.
static void fly(void *context, uint32_t first, uint32_t count)
{
    const flight *f = context;
    const pl_solver *s = f->solver;
    const near_real h = f->h;
    pl_near_quad *body = (pl_near_quad *)(void *)(pl_solver_bodies(s) + f->first);
    pl_near_quad *motion = (pl_near_quad *)(void *)(pl_solver_motions(s) + f->first);
    for (uint32_t i = first; i < first + count; ++i) {
        pl_near_quad v = body[2 * i];
        pl_near_quad pushed = v - motion[2 * i + 1];
        pl_near_quad u = v + h * motion[2 * i];
        motion[2 * i + 1] = u;
        body[2 * i] = u + pushed;
    }
}

// The same, and what rounding takes from u of an elastic body is added in the next substep: without
// that, it gains or loses 2e-7 of its energy a bounce in the float library. For others this does, bit
// for bit, what the function above does.
static void fly_carefully(void *context, uint32_t first, uint32_t count)
{
    const flight *f = context;
    const pl_solver *s = f->solver;
    const near_real h = f->h;
    pl_near_quad *body = (pl_near_quad *)(void *)(pl_solver_bodies(s) + f->first);
    pl_near_quad *motion = (pl_near_quad *)(void *)(pl_solver_motions(s) + f->first);
    pl_near_quad *low = (pl_near_quad *)s->residuals.data + f->first;
    for (uint32_t i = first; i < first + count; ++i) {
        pl_near_quad v = body[2 * i];
        pl_near_quad pushed = v - motion[2 * i + 1];
        near_real kept = low[i][3];
        low[i][3] = 0;
        pl_near_quad wanted = h * motion[2 * i] + low[i];
        pl_near_quad u = v + wanted;
        low[i] = kept * (wanted - (u - v));
        low[i][3] = kept;
        motion[2 * i + 1] = u;
        body[2 * i] = u + pushed;
    }
}

// A share of fewer bundles than this is not worth a thread: about a microsecond of work.
#define LEAST 12
// A cluster of more bundles keeps all threads busy, one after another; smaller ones are a thread's each.
#define LARGE 512

// What all clusters of a step have in common.
typedef struct soft_step {
    plumb_world *world;
    const pl_contact_kernels *kernels;
    pl_contact_call call;
    uint32_t threads;
    pl_surface_variant surface;
    pl_motion_variant motion;
    bool tallies, elastic, resist;
} soft_step;

// One cluster in the hands of some threads; null: of one.
typedef struct solve_context {
    const soft_step *step;
    const pl_cluster *cluster;
    pl_tasks *tasks;
    pl_contact_call call; // the step's, for this cluster
    pl_joint_context joints;
    bool any_joints;
    bool elastic, resist; // of the world: for cluster 0
} solve_context;

typedef struct kernel_call {
    const pl_contact_call *call;
    pl_contact_kernel *kernel;
} kernel_call;

static void run_kernel(void *context, uint32_t first, uint32_t count)
{
    const kernel_call *c = context;
    c->kernel(c->call, first, count);
}

// A kernel over all bundles. Those of one colour have no body in common that moves, so threads share
// them; overflow contacts come last, one bundle after another.
static void share_out(const solve_context *c, pl_contact_kernel *kernel, pl_share_fn *share)
{
    const pl_contact_call *call = &c->call;
    const uint32_t *first = c->cluster->color_first;
    share(c->tasks, first, PL_COLORS, LEAST, run_kernel, &(kernel_call){ call, kernel });
    kernel(call, first[PL_OVERFLOW_COLOR], first[PL_COLOR_SLOTS] - first[PL_OVERFLOW_COLOR]);
}

static void sweep(const solve_context *c, pl_contact_kernel *kernel)
{
    share_out(c, kernel, pl_tasks_phases);
}

// For a kernel in which every bundle stands by itself.
static void each(const solve_context *c, pl_contact_kernel *kernel)
{
    share_out(c, kernel, pl_tasks_shares);
}

static soft_step open_step(plumb_world *world, real dt)
{
    pl_solver *s = &world->solver;
    const near_real h = (near_real)(dt / (real)world->desc.substeps);
    const near_real stiffest = STIFFEST / h;
    const near_real asked = (near_real)world->desc.contact_hertz;
    const bool special = pl_solver_specials(world), tallies = pl_solver_tallies(world);
    const bool running = world->narrow.any_surface || special;
    return (soft_step){
        .world = world,
        .kernels = pl_solver_kernels(world),
        .call = { .bodies = pl_solver_bodies(s),
                  .dynamic_slots = s->dynamic_slots,
                  .bundles = s->bundles.data,
                  .lanes = s->lanes.data,
                  .slots = s->slots.data,
                  .movable_rows = world->dynamic_count + world->kinematic_count,
                  .immovable_slot = s->slot_count - 1,
                  .extras = running || tallies ? s->extras.data : NULL,
                  .specials = special ? s->specials.data : NULL,
                  .bounces = world->narrow.any_low ? s->bounces.data : NULL,
                  .motions = pl_solver_motions(s),
                  .restitution_speed = (near_real)world->desc.restitution_speed,
                  .struck = s->follows_impacts ? s->struck.data : NULL,
                  .bounce_count = &s->bounce_count,
                  .manifolds = pl_manifolds(&world->narrow),
                  .pairs = pl_pairs(&world->broad.pairs),
                  .h = h,
                  .inv_h = 1 / h,
                  .hertz = asked > 0 && asked < stiffest ? asked : stiffest,
                  .damping = (near_real)world->desc.contact_damping,
                  .push_speed = (near_real)world->desc.push_speed,
                  .flags = world->bodies.flags },
        .surface = special                      ? PL_SPECIAL
                   : running                    ? PL_RUNNING
                   : world->narrow.any_friction ? PL_ROUGH
                                                : PL_SMOOTH,
        .motion = world->desc.hit_speed > 0   ? PL_TELLING
                  : world->turning_bodies > 0 ? PL_TURNING
                                              : PL_STRAIGHT,
        .tallies = tallies,
        .elastic = s->follows_impacts,
        .resist = pl_effects_resist(world),
    };
}

static void prepare(const solve_context *c)
{
    const soft_step *step = c->step;
    each(c, step->kernels->prepare);
    if (c->call.extras != NULL) {
        each(c, step->kernels->prepare_extras);
    }
    if (c->call.specials != NULL) {
        each(c, step->kernels->prepare_specials);
    }
    if (c->call.bounces != NULL) {
        each(c, step->kernels->prepare_bounces);
    }
    if (c->elastic) {
        pl_impacts_prepare(step->world);
    }
    if (c->any_joints) {
        pl_joints_prepare(&c->joints);
    }
}

static void fly_all(const solve_context *c)
{
    const pl_slots slots = c->cluster->slots[0];
    pl_tasks_ranges(c->tasks, slots.count, PL_BODIES_SHARED, c->elastic ? fly_carefully : fly,
                    &(flight){ &c->step->world->solver, slots.first, c->call.h });
}

// Impacts with restitution: those that are followed one by one, then of all others what is due. These may set off
// some of the former again.
static void bounce(const solve_context *c)
{
    const soft_step *step = c->step;
    const pl_contact_kernels *kernels = step->kernels;
    if (c->elastic) {
        pl_impacts_run(step->world, c->call.h);
    }
    if (c->call.bounces != NULL) {
        sweep(c, step->surface == PL_SPECIAL ? kernels->bounce_special : kernels->bounce);
    }
    if (c->elastic) {
        if (c->call.bounces != NULL) {
            pl_impacts_run_on(step->world, c->call.h);
        }
        pl_impacts_tell(step->world, c->call.h);
    }
}

static void run_substep(solve_context *c, bool first)
{
    const soft_step *step = c->step;
    const pl_contact_kernels *kernels = step->kernels;
    plumb_world *world = step->world;
    const near_real h = c->call.h;
    if (c->resist) {
        pl_effects_substep(world, h);
    }
    fly_all(c);
    if (c->any_joints && first) {
        pl_joints_warm_start(&c->joints);
    }
    if (first) {
        sweep(c, kernels->warm_start[step->surface][step->motion]);
    }
    bounce(c);
    for (int i = 0; i < world->desc.iterations; ++i) {
        if (c->any_joints) {
            pl_joints_solve(&c->joints, PL_SWEEP_PULL, i == 0);
        }
        c->call.unloaded = first && i == 0 ? NEAR_MAX : 0;
        sweep(c, kernels->solve[step->surface][step->motion]);
    }
    c->call.unloaded = 0;
    pl_integrate_positions(&world->solver, c->cluster, c->tasks, h);
    for (int i = 0; i < world->desc.iterations; ++i) {
        if (c->any_joints) {
            pl_joints_solve(&c->joints, PL_SWEEP_RELAX, i == 0);
        }
        sweep(c, kernels->relax[step->surface][step->motion]);
    }
    if (c->any_joints && world->joints.watched > 0) {
        pl_joints_tally(&c->joints);
    }
    if (step->tallies) {
        each(c, kernels->tally);
    }
}

static void store(const solve_context *c)
{
    const soft_step *step = c->step;
    if (c->any_joints) {
        pl_joints_store(&c->joints);
    }
    each(c, step->kernels->store);
    if (c->call.extras != NULL) {
        each(c, step->kernels->store_extras);
    }
    if (c->call.bounces != NULL) {
        each(c, step->kernels->store_bounces);
    }
}

// All of a step for one cluster, in a thread's room for bundles.
static void run_cluster(const soft_step *step, uint32_t i, pl_tasks *tasks, uint32_t thread)
{
    const pl_solver *s = &step->world->solver;
    const size_t room = (size_t)thread * s->bundle_room;
    solve_context c = { .step = step,
                        .cluster = &pl_clusters(s)[i],
                        .tasks = tasks,
                        .call = step->call,
                        .joints = pl_joint_context_of(step->world, i, tasks, thread, step->call.h),
                        .elastic = i == 0 && step->elastic,
                        .resist = i == 0 && step->resist };
    c.any_joints = pl_joints_any(&c.joints);
    if (c.call.lanes != NULL) { // else no step has had a contact yet
        c.call.lanes += c.cluster->first_lane;
        c.call.bundles = (char *)c.call.bundles + room * step->kernels->bundle_size;
    }
    if (c.call.extras != NULL) {
        c.call.extras = (char *)c.call.extras + room * step->kernels->extra_size;
    }
    if (c.call.specials != NULL) {
        c.call.specials = (char *)c.call.specials + room * step->kernels->special_size;
    }
    if (c.call.bounces != NULL) {
        c.call.bounces = (char *)c.call.bounces + room * step->kernels->bounce_size;
    }
    prepare(&c);
    for (int k = 0; k < step->world->desc.substeps; ++k) {
        run_substep(&c, k == 0);
    }
    store(&c);
}

// Solved by all threads together. Joints are swept twice as often as contacts.
static bool is_large(const soft_step *step, uint32_t i)
{
    const plumb_world *world = step->world;
    const pl_joint_context joints = pl_joint_context_of(step->world, i, NULL, 0, 0);
    const uint32_t contacts = pl_clusters(&world->solver)[i].color_first[PL_COLOR_SLOTS];
    const uint32_t tied = pl_joints_any(&joints) ? joints.group->color_first[PL_JOINT_COLORS] -
                                                       joints.group->color_first[0]
                                                 : 0;
    return (i == 0 && (step->elastic || step->resist)) || contacts + 2 * tied > LARGE;
}

static void run_small_ones(void *context, uint32_t thread)
{
    const soft_step *step = context;
    const pl_share mine = pl_share_of(step->world->solver.cluster_count, step->threads, thread);
    for (uint32_t i = mine.first; i < mine.end; ++i) {
        if (!is_large(step, i)) {
            run_cluster(step, i, NULL, thread);
        }
    }
}

void pl_solver_soft(plumb_world *world, real dt)
{
    soft_step step = open_step(world, dt);
    const uint32_t count = world->solver.cluster_count;
    if (count == 1) {
        run_cluster(&step, 0, world->tasks, 0);
        return;
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (is_large(&step, i)) {
            run_cluster(&step, i, world->tasks, 0);
        }
    }
    step.threads = pl_tasks_share_count(world->tasks, count, 1);
    pl_tasks_run(world->tasks, run_small_ones, &step, step.threads);
}
