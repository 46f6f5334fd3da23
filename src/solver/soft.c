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
// Reads: solver bodies, lanes. Writes: solver bodies, impulses of pairs. Order: after the graph.
// Cost: (2 substeps x iterations + 2) sweeps over the contacts, 2 substeps passes over the bodies.
#include "world/state.h"

// Contact frequency as a share of the substep rate. Stiffer contacts sink less, as the square, but from
// 3/16 on a pyramid of 100 rows takes long to come to rest and leans, and from 1/4 on one of 20 never
// rests, at one sweep a substep (README.md has the table).
#define STIFFEST ((near_real)(1.0 / 6))

typedef near_real quad __attribute__((vector_size(4 * sizeof(near_real)), may_alias));

typedef struct flight {
    const pl_solver *solver;
    near_real h; // [s]
} flight;

// v = u + h a, plus what the contacts did in the substep before.
static void fly(void *context, uint32_t first, uint32_t count)
{
    const flight *f = context;
    const pl_solver *s = f->solver;
    const near_real h = f->h;
    quad *body = (quad *)(void *)pl_solver_bodies(s);
    quad *motion = (quad *)(void *)pl_solver_motions(s);
    for (uint32_t i = first; i < first + count; ++i) {
        quad v = body[2 * i];
        quad pushed = v - motion[2 * i + 1];
        quad u = v + h * motion[2 * i];
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
    quad *body = (quad *)(void *)pl_solver_bodies(s);
    quad *motion = (quad *)(void *)pl_solver_motions(s);
    quad *low = (quad *)s->lows.data;
    for (uint32_t i = first; i < first + count; ++i) {
        quad v = body[2 * i];
        quad pushed = v - motion[2 * i + 1];
        near_real kept = low[i][3];
        low[i][3] = 0;
        quad wanted = h * motion[2 * i] + low[i];
        quad u = v + wanted;
        low[i] = kept * (wanted - (u - v));
        low[i][3] = kept;
        motion[2 * i + 1] = u;
        body[2 * i] = u + pushed;
    }
}

// A share of fewer bundles than this is not worth a thread: about a microsecond of work.
#define LEAST 12

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
static void share_out(const plumb_world *world, const pl_contact_call *call,
                      pl_contact_kernel *kernel, pl_share_fn *share)
{
    const pl_solver *s = &world->solver;
    const uint32_t shared = s->color_first[PL_COLORS];
    share(world->tasks, s->color_first, PL_COLORS, LEAST, run_kernel,
          &(kernel_call){ call, kernel });
    kernel(call, shared, s->bundle_count - shared);
}

static void sweep(const plumb_world *world, const pl_contact_call *call, pl_contact_kernel *kernel)
{
    share_out(world, call, kernel, pl_tasks_phases);
}

// For a kernel in which every bundle stands by itself.
static void each(const plumb_world *world, const pl_contact_call *call, pl_contact_kernel *kernel)
{
    share_out(world, call, kernel, pl_tasks_shares);
}

void pl_solver_soft(plumb_world *world, real dt)
{
    pl_solver *s = &world->solver;
    const pl_contact_kernels *kernels = pl_solver_kernels(world);
    const int substeps = world->desc.substeps;
    const near_real h = (near_real)(dt / (real)substeps);
    const near_real stiffest = STIFFEST / h;
    const near_real asked = (near_real)world->desc.contact_hertz;
    pl_contact_call call = { .bodies = pl_solver_bodies(s),
                             .dynamic_slots = s->dynamic_slots,
                             .bundles = s->bundles.data,
                             .lanes = s->lanes.data,
                             .slots = s->slots.data,
                             .movable_rows = world->dynamic_count + world->kinematic_count,
                             .immovable_slot = s->slot_count - 1,
                             .manifolds = pl_manifolds(&world->narrow),
                             .pairs = pl_pairs(&world->broad.pairs),
                             .h = h,
                             .inv_h = 1 / h,
                             .hertz = asked > 0 && asked < stiffest ? asked : stiffest,
                             .damping = (near_real)world->desc.contact_damping,
                             .push_speed = (near_real)world->desc.push_speed,
                             .flags = world->bodies.flags };
    const bool special = pl_solver_specials(world);
    const bool running = world->narrow.any_surface || special;
    const bool tallies = pl_solver_tallies(world);
    const pl_surface_variant surface = special                      ? PL_SPECIAL
                                       : running                    ? PL_RUNNING
                                       : world->narrow.any_friction ? PL_ROUGH
                                                                    : PL_SMOOTH;
    const bool rotation = world->turning_bodies > 0;
    const bool joints = pl_joints_awake(world) > 0;
    const bool bounce = world->narrow.any_bounce;
    const bool resist = pl_effects_resist(world);

    each(world, &call, kernels->prepare);
    if (running || tallies) {
        call.extras = s->extras.data;
        each(world, &call, kernels->prepare_extras);
    }
    if (special) {
        call.specials = s->specials.data;
        each(world, &call, kernels->prepare_specials);
    }
    if (bounce) {
        pl_impacts_prepare(world);
    }
    if (joints) {
        pl_joints_prepare(world, h);
    }
    for (int k = 0; k < substeps; ++k) {
        if (resist) {
            pl_effects_substep(world, h);
        }
        pl_tasks_ranges(world->tasks, s->dynamic_slots, PL_BODIES_SHARED,
                        bounce ? fly_carefully : fly, &(flight){ s, h });
        if (joints && k == 0) {
            pl_joints_warm_start(world);
        }
        if (k == 0) {
            sweep(world, &call, kernels->warm_start[surface][rotation]);
        }
        if (bounce) {
            pl_impacts_run(world, h);
        }
        for (int i = 0; i < world->desc.iterations; ++i) {
            if (joints) {
                pl_joints_solve(world, h, PL_SWEEP_PULL, i == 0);
            }
            sweep(world, &call, kernels->solve[surface][rotation]);
        }
        pl_integrate_positions(world, h);
        for (int i = 0; i < world->desc.iterations; ++i) {
            if (joints) {
                pl_joints_solve(world, h, PL_SWEEP_RELAX, i == 0);
            }
            sweep(world, &call, kernels->relax[surface][rotation]);
        }
        if (world->joints.impulsive > 0) {
            pl_joints_tally(world);
        }
        if (tallies) {
            each(world, &call, kernels->tally);
        }
    }
    if (joints) {
        pl_joints_store(world, h);
    }
    each(world, &call, kernels->store);
    if (running || tallies) {
        each(world, &call, kernels->store_extras);
    }
}
