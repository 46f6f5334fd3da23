// soft.c - contacts of the soft step, as rows of the substep: integrate, warm start, solve with soft contacts,
// relax. Their order is in schema/passes.h; joints and impacts are rows between them.
//
// Warm starting within the step is done a body at a time: with anchors frozen, the impulses with
// which a substep ended changed a body's velocity by v - u (u: velocity as integrated), and
// applying them again changes it by the same. So contacts are warm started one by one only at the
// start of the step. Joints likewise, and what their turning changes is
// added in every substep (joints/solve.c); they come before contacts in a sweep.
//
// Half of the kick comes behind the drift (halves.c): free flight is exact, the parabola, and what contacts push moves to
// second order.
//
// Reads: solver bodies, lanes. Writes: solver bodies, impulses of pairs. Order: after the graph.
// Cost: (2 substeps x iterations + 2) sweeps over the contacts, 2 substeps passes over the bodies.
#include "core/quad.h"
#include "effects/effects.h"
#include "math/decay.h"
#include "solver/substep.h"
#include "world/state.h"

// Contact frequency as a share of the substep rate. Stiffer contacts sink less, as the square, but from
// 3/16 on a pyramid of 100 rows takes long to come to rest and leans, and from 1/4 on one of 20 never
// rests, at one sweep a substep (DECISIONS.md has the table).
#define STIFFEST ((near_real)(1.0 / 6))

// [s] in which the stiffness of contacts and joints rises by e at most where steps become shorter.
#define STIFFENS ((real)0.5)

// A pile rests a little way into itself, by the stiffness that its substep bears. Were it stiffer at once when the
// next step is shorter, what it had sunk would be given back within a few substeps and throw it up: a stack of ten
// after steps of 1/60 s by 5 cm where the next were of 1/240 s, by 76 m where they were of 1 us. So stiffness falls at
// once where steps become longer, and rises in its own time where they become shorter.
near_real pl_soft_substep(const plumb_world *world, real dt)
{
    const near_real h = (near_real)(dt / (real)world->desc.substeps);
    const near_real before = world->soft_substep;
    if (before <= h) {
        return h;
    }
    const near_real now = before * (near_real)pl_decay_of((double)(dt / STIFFENS)).left;
    return now > h ? now : h;
}

// v = u + h a, plus what the contacts did in the substep before.
static void fly(void *context, uint32_t first, uint32_t count)
{
    const pl_passage *f = context;
    const pl_solver *s = &f->world->solver;
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
    const pl_passage *f = context;
    const pl_solver *s = &f->world->solver;
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
static void share_out(const pl_substep *s, pl_contact_kernel *kernel, pl_share_fn *share)
{
    const pl_contact_call *call = &s->solving->call;
    const uint32_t *first = s->cluster->color_first;
    share(s->tasks, first, PL_COLORS, LEAST, run_kernel, &(kernel_call){ call, kernel });
    kernel(call, first[PL_OVERFLOW_COLOR], first[PL_COLOR_SLOTS] - first[PL_OVERFLOW_COLOR]);
}

static void sweep(const pl_substep *s, pl_contact_kernel *kernel)
{
    share_out(s, kernel, pl_tasks_phases);
}

// For a kernel in which every bundle stands by itself.
static void each(const pl_substep *s, pl_contact_kernel *kernel)
{
    share_out(s, kernel, pl_tasks_shares);
}

void pl_soft_open(plumb_world *world, pl_solving_step *out)
{
    pl_solver *s = &world->solver;
    const near_real stiffest = STIFFEST / out->soft_substep;
    const near_real asked = (near_real)world->desc.contact_hertz;
    const bool special = pl_solver_specials(world);
    const bool running = world->narrow.any_surface || special;
    out->tallies = pl_solver_tallies(world);
    out->call.bundles = s->bundles.data;
    out->call.lanes = s->lanes.data;
    out->call.extras = running || out->tallies ? s->extras.data : NULL;
    out->call.specials = special ? s->specials.data : NULL;
    out->call.grips = world->narrow.any_kinetic ? s->grips.data : NULL;
    out->call.turnings = s->turning ? s->turnings.data : NULL;
    out->call.bounces = world->narrow.any_low ? s->bounces.data : NULL;
    out->call.motions = pl_solver_motions(s);
    out->call.kicked = s->kicked.data;
    out->call.restitution_speed = (near_real)world->desc.restitution_speed;
    out->call.struck = world->solver.follows_impacts ? s->struck.data : NULL;
    out->call.bounce_count = &s->bounce_count;
    out->call.hertz = asked > 0 && asked < stiffest ? asked : stiffest;
    out->call.stiffest = stiffest;
    out->call.most = asked > 0 ? asked : NEAR_MAX;
    out->call.damping = (near_real)world->desc.contact_damping;
    out->call.push_speed = (near_real)world->desc.push_speed;
    out->surface = special                      ? PL_SPECIAL
                   : running                    ? PL_RUNNING
                   : world->narrow.any_friction ? PL_ROUGH
                                                : PL_SMOOTH;
    out->motion = world->desc.hit_speed > 0   ? PL_TELLING
                  : world->turning_bodies > 0 ? PL_TURNING
                                              : PL_STRAIGHT;
}

//---- rows ----------------------------------------------------------------------------------------

void pl_soft_prepare(pl_substep *s)
{
    const pl_contact_kernels *kernels = s->solving->step->kernels;
    each(s, kernels->prepare);
    if (s->solving->call.extras != NULL) {
        each(s, kernels->prepare_extras);
    }
    if (s->solving->call.specials != NULL) {
        each(s, kernels->prepare_specials);
    }
    if (s->solving->fine) {
        each(s, kernels->prepare_fine);
    }
    if (s->solving->call.grips != NULL) {
        each(s, kernels->prepare_grips);
    }
    if (s->solving->call.bounces != NULL) {
        each(s, kernels->prepare_bounces);
    }
    if (s->solving->call.turnings != NULL) {
        each(s, kernels->prepare_moment);
    }
}

void pl_soft_integrate(pl_substep *s)
{
    if (s->world->tracks.count > 0) {
        pl_tracks_begin(s);
    }
    pl_pass_bodies(s, 0, s->solving->elastic ? fly_carefully : fly);
}

void pl_soft_warm_start(pl_substep *s)
{
    if (s->first) {
        sweep(s, s->solving->step->kernels
                     ->warm_start[s->solving->step->surface][s->solving->step->motion]);
    }
}

// Impacts with restitution: those that are followed one by one, then of all others what is due. These may set off
// some of the former again.
void pl_soft_impacts(pl_substep *s)
{
    plumb_world *world = s->world;
    const pl_contact_kernels *kernels = s->solving->step->kernels;
    if (s->solving->elastic) {
        world->solver.since = s->solving->call.since;
        pl_impacts_run(world, s->h);
    }
    if (s->solving->call.bounces != NULL) {
        sweep(s,
              s->solving->step->surface == PL_SPECIAL ? kernels->bounce_special : kernels->bounce);
    }
    if (s->solving->elastic) {
        if (s->solving->call.bounces != NULL) {
            pl_impacts_run_on(world, s->h);
        }
        pl_impacts_tell(world, s->h);
    }
}

void pl_soft_open_moment(pl_substep *s)
{
    if (s->solving->call.turnings != NULL) {
        each(s, s->solving->step->kernels->open_moment);
    }
}

void pl_soft_follow_moment(pl_substep *s)
{
    if (s->solving->call.turnings != NULL) {
        sweep(s, s->solving->step->kernels->follow_moment);
    }
}

void pl_soft_contacts(pl_substep *s)
{
    s->solving->call.unloaded = s->first && s->first_sweep ? NEAR_MAX : 0;
    sweep(s, s->solving->step->kernels->solve[s->solving->step->surface][s->solving->step->motion]);
    s->solving->call.unloaded = 0;
}

// Where they are relaxed, bodies are where the next substep begins.
void pl_soft_relax(pl_substep *s)
{
    s->solving->call.since = (near_real)(s->number + 1) * s->h;
    sweep(s, s->solving->step->kernels->relax[s->solving->step->surface][s->solving->step->motion]);
}

void pl_soft_sum(pl_substep *s)
{
    if (s->solving->step->tallies) {
        each(s, s->solving->step->kernels->tally);
    }
}

void pl_soft_store(pl_substep *s)
{
    if (s->solving->fine) {
        each(s, s->solving->step->kernels->close_fine);
    }
    each(s, s->solving->step->kernels->store);
    if (s->solving->call.extras != NULL) {
        each(s, s->solving->step->kernels->store_extras);
    }
    if (s->solving->call.grips != NULL) {
        each(s, s->solving->step->kernels->store_grips);
    }
    if (s->solving->call.bounces != NULL) {
        each(s, s->solving->step->kernels->store_bounces);
    }
}
