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
#define STIFFEST ((real)(1.0 / 6))

typedef real quad __attribute__((vector_size(4 * sizeof(real)), may_alias));

// v = u + h a, plus what the contacts did in the substep before.
static void integrate_velocities(const plumb_world *world, real h)
{
    const pl_solver *s = &world->solver;
    quad *body = (quad *)(void *)pl_solver_bodies(s);
    quad *motion = (quad *)(void *)pl_solver_motions(s);
    for (uint32_t i = 0; i < s->dynamic_slots; ++i) {
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
static void integrate_velocities_carefully(const plumb_world *world, real h)
{
    const pl_solver *s = &world->solver;
    quad *body = (quad *)(void *)pl_solver_bodies(s);
    quad *motion = (quad *)(void *)pl_solver_motions(s);
    quad *low = (quad *)s->lows.data;
    for (uint32_t i = 0; i < s->dynamic_slots; ++i) {
        quad v = body[2 * i];
        quad pushed = v - motion[2 * i + 1];
        real kept = low[i][3];
        low[i][3] = 0;
        quad wanted = h * motion[2 * i] + low[i];
        quad u = v + wanted;
        low[i] = kept * (wanted - (u - v));
        low[i][3] = kept;
        motion[2 * i + 1] = u;
        body[2 * i] = u + pushed;
    }
}

void pl_solver_soft(plumb_world *world, real dt)
{
    pl_solver *s = &world->solver;
    const pl_contact_kernels *kernels = pl_solver_kernels(world);
    const int substeps = world->desc.substeps;
    const real h = dt / (real)substeps;
    const real stiffest = STIFFEST / h;
    const real asked = world->desc.contact_hertz;
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
                             .damping = world->desc.contact_damping,
                             .push_speed = world->desc.push_speed,
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

    kernels->prepare(&call, 0, s->bundle_count);
    if (running || tallies) {
        call.extras = s->extras.data;
        kernels->prepare_extras(&call, 0, s->bundle_count);
    }
    if (special) {
        call.specials = s->specials.data;
        kernels->prepare_specials(&call, 0, s->bundle_count);
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
        if (bounce) {
            integrate_velocities_carefully(world, h);
        } else {
            integrate_velocities(world, h);
        }
        if (joints && k == 0) {
            pl_joints_warm_start(world);
        }
        if (k == 0) {
            kernels->warm_start[surface][rotation](&call, 0, s->bundle_count);
        }
        if (bounce) {
            pl_impacts_run(world, h);
        }
        for (int i = 0; i < world->desc.iterations; ++i) {
            if (joints) {
                pl_joints_solve(world, h, PL_SWEEP_PULL, i == 0);
            }
            kernels->solve[surface][rotation](&call, 0, s->bundle_count);
        }
        pl_integrate_positions(world, h);
        for (int i = 0; i < world->desc.iterations; ++i) {
            if (joints) {
                pl_joints_solve(world, h, PL_SWEEP_RELAX, i == 0);
            }
            kernels->relax[surface][rotation](&call, 0, s->bundle_count);
        }
        if (world->joints.impulsive > 0) {
            pl_joints_tally(world);
        }
        if (tallies) {
            kernels->tally(&call, 0, s->bundle_count);
        }
    }
    if (joints) {
        pl_joints_store(world, h);
    }
    kernels->store(&call, call.pairs, 0, s->bundle_count);
    if (running || tallies) {
        kernels->store_extras(&call, pl_manifolds(&world->narrow), 0, s->bundle_count);
    }
}
