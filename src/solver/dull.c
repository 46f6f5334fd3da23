// dull.c - runs the kernels for impacts of dull contacts (dull.simd.c) over the bundles of a world.
//
// Reads, writes: what pl_dull_call lists. Order: instead of the records of impact.c where nothing livelier
// bounces, or for its prediction. Cost: that of the kernels; with several threads, bundles are shared out.
#include "solver/dull.h"
#include "world/state.h"

// So many bundles are worth a thread.
#define LEAST 12

typedef struct dull_job {
    const pl_contact_kernels *kernels;
    pl_dull_call call;
} dull_job;

static dull_job job_of(const plumb_world *world, near_real h)
{
    const pl_solver *s = &world->solver;
    return (dull_job){ .kernels = pl_solver_kernels(world),
                       .call = { .bodies = pl_solver_bodies(s),
                                 .motions = pl_solver_motions(s),
                                 .residuals = s->residuals.data,
                                 .struck = s->struck.data,
                                 .dynamic_slots = s->dynamic_slots,
                                 .bundles = s->bundles.data,
                                 .color_first = pl_clusters(s)->color_first,
                                 .lanes = s->lanes.data,
                                 .manifolds = pl_manifolds(&world->narrow),
                                 .pairs = pl_pairs(&world->broad.pairs),
                                 .fields = s->predicted_fields.data,
                                 .marks = s->predicted_open.data,
                                 .looks_up = world->narrow.any_surface || pl_solver_tallies(world),
                                 .h = h,
                                 .restitution_speed = (double)world->desc.restitution_speed } };
}

static uint32_t prepare_bundles(void *context, uint32_t first, uint32_t count)
{
    const dull_job *j = context;
    return j->kernels->dull_prepare(&j->call, first, count);
}

static void look_at_bundles(void *context, uint32_t first, uint32_t count)
{
    const dull_job *j = context;
    j->kernels->dull_look(&j->call, first, count);
}

static void strike_bundles(void *context, uint32_t first, uint32_t count)
{
    const dull_job *j = context;
    j->kernels->dull_strike(&j->call, first, count);
}

uint32_t pl_dull_impacts_prepare(const plumb_world *world)
{
    dull_job job = job_of(world, 0);
    return pl_tasks_count(world->tasks, world->solver.bundle_count, LEAST, prepare_bundles, &job);
}

void pl_dull_impacts_look(const plumb_world *world, near_real h)
{
    dull_job job = job_of(world, h);
    pl_tasks_ranges(world->tasks, world->solver.bundle_count, LEAST, look_at_bundles, &job);
}

// Colour by colour, as contacts are solved; those without colour one after another.
void pl_dull_impacts_run(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    const uint8_t *marks = s->predicted_open.data;
    dull_job job = job_of(world, h);
    const uint32_t shared = job.call.color_first[PL_OVERFLOW_COLOR];
    pl_tasks_phases(world->tasks, job.call.color_first, PL_COLORS, LEAST, strike_bundles, &job);
    strike_bundles(&job, shared, s->bundle_count - shared);
    for (uint32_t lane = 0; lane < s->predicted_lanes; ++lane) {
        s->bounce_count += marks[lane] & PL_DULL_STRUCK;
    }
}
