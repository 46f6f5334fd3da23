// solve.c - the joints of a cluster in a substep: in lanes, then one by one.
//
// Joints of sleeping bodies are passed over (pl_joints_awake). Reads: joints, body columns. Writes: solver bodies,
// impulses. Cost: O(joints awake) a sweep.
#include "joints/joint.h"
#include "joints/direct.h"
#include "world/state.h"

#include <stddef.h>

// Sweeps that pull, and that relax, in a substep. Fewer bear less stiffness: DECISIONS.md has the table.
#define SWEEPS 2

//---- joints in lanes ----------------------------------------------------------------------------------

pl_joint_context pl_joint_context_of(plumb_world *world, uint32_t cluster, pl_tasks *tasks,
                                     uint32_t thread, real h, real soft)
{
    const pl_joint_plan *plan = &world->joints.plan;
    if (world->joints.live == 0 || cluster >= plan->group_count) {
        return (pl_joint_context){ .world = world };
    }
    return (pl_joint_context){ .world = world,
                               .group = &pl_joint_groups(&world->joints)[cluster],
                               .tasks = tasks,
                               // None while no joint has been solved in lanes.
                               .records = plan->room > 0 ? (unsigned char *)plan->records.data +
                                                               thread * plan->room
                                                         : NULL,
                               .h = h,
                               .exact = cluster == plan->exact_group,
                               .rigid = pl_joint_rigid(h, soft) };
}

static pl_joint_call call_of(const pl_joint_context *c)
{
    const plumb_world *world = c->world;
    const pl_joint_plan *plan = &world->joints.plan;
    return (pl_joint_call){ .bodies = pl_solver_bodies(&world->solver),
                            .dynamic_slots = world->solver.dynamic_slots,
                            .immovable_slot = world->solver.slot_count - 1,
                            .bundles = plan->bundles.data,
                            .patterns = plan->patterns,
                            .lanes = plan->lanes.data,
                            .slots = plan->slots.data,
                            .records = c->records,
                            .joints = pl_joint_items(&world->joints),
                            .kicked = world->solver.kicked.data,
                            .marks = pl_joint_marks(&world->joints),
                            .h = c->h,
                            .rigid = c->rigid };
}

// A share of fewer bundles than this is not worth a thread.
#define LEAST 8

typedef struct kernel_call {
    pl_joint_call call;
    pl_joint_kernel *kernel;
} kernel_call;

static void run_kernel(void *context, uint32_t first, uint32_t count)
{
    const kernel_call *c = context;
    pl_joint_call call = c->call;
    call.first = first, call.end = first + count;
    c->kernel(&call);
}

static void share_out(const pl_joint_context *c, pl_joint_kernel *kernel, pl_share_fn *share)
{
    share(c->tasks, c->group->color_first, PL_JOINT_COLORS, LEAST, run_kernel,
          &(kernel_call){ call_of(c), kernel });
}

// A kernel over all bundles, shared out among threads colour after colour.
static void sweep_bundles(const pl_joint_context *c, pl_joint_kernel *kernel)
{
    share_out(c, kernel, pl_tasks_phases);
}

// The same for a kernel in which every bundle stands by itself.
static void each_bundle(const pl_joint_context *c, pl_joint_kernel *kernel)
{
    share_out(c, kernel, pl_tasks_shares);
}

//---- joints solved one by one ----------------------------------------------------------------------

static pl_solver_body *body_of(const pl_joint_context *c, uint32_t slot, pl_solver_body *immovable)
{
    const pl_solver *s = &c->world->solver;
    return slot == s->slot_count - 1 ? immovable : &pl_solver_bodies(s)[slot];
}

void pl_one_take(const pl_joint_context *c, uint32_t i, pl_lone *out)
{
    pl_joint *j = pl_joint_grouped(&c->world->joints, i);
    out->joint = j;
    out->immovable = (pl_solver_body){ 0 };
    out->a = body_of(c, j->slot_a, &out->immovable);
    out->b = body_of(c, j->slot_b, &out->immovable);
}

//---- all joints ----------------------------------------------------------------------------------

static uint32_t slot_of(const plumb_world *world, uint32_t row)
{
    uint32_t movable = world->dynamic_count + world->kinematic_count;
    return pl_solver_slot(&world->solver, row < movable ? row : movable, movable);
}

static void begin(const plumb_world *world, pl_joint *j, real h)
{
    const pl_joint_mark *mark = &pl_joint_marks(&world->joints)[j - pl_joint_items(&world->joints)];
    pl_joint_place(world, j, mark->row_a, mark->row_b);
    j->slot_a = slot_of(world, mark->row_a);
    j->slot_b = slot_of(world, mark->row_b);
    real scale = pl_joint_carried(j, h);
    for (int k = 0; k < PL_JOINT_ROWS; ++k) {
        j->impulse[k] *= scale;
    }
    j->h = h;
    j->degree = mark->degree;
}

// A joint in a lane, its rows as they are now.
static void begin_wide(const plumb_world *world, pl_joint *j, pl_joint_start *start, pl_rows *rows,
                       real h)
{
    begin(world, j, h);
    pl_joint_classes[j->desc.kind]->rows(j, &j->pose_a, &j->pose_b, rows);
    *start = (pl_joint_start){ .arm_a = { (near_real)j->pose_a.rx, (near_real)j->pose_a.ry },
                               .arm_b = { (near_real)j->pose_b.rx, (near_real)j->pose_b.ry },
                               .apart = { (near_real)(j->pose_b.x - j->pose_a.x),
                                          (near_real)(j->pose_b.y - j->pose_a.y) } };
    for (int k = 0; k < rows->count; ++k) {
        j->impulse[k] = rows->row[k].type != PL_ROW_OFF ? j->impulse[k] : 0;
    }
}

// Lanes from one joint to that which is brought from memory meanwhile.
#define AHEAD 8

// What the beginning of a step reads and writes of a joint; of a bare hinge, its first line.
static inline void fetch(const pl_joint *j, bool bare)
{
    const size_t size = bare ? 1 : offsetof(pl_joint, mass);
    for (size_t at = 0; at < size; at += 64) {
        __builtin_prefetch((const char *)j + at, 1);
    }
}

// How the lanes of a bundle begin the step; slots as the kernels want them.
static void begin_lanes(const pl_joint_context *c, uint32_t bundle, pl_joint_start *starts,
                        pl_rows *rows)
{
    const plumb_world *world = c->world;
    const pl_joint_plan *plan = &world->joints.plan;
    const uint32_t width = (uint32_t)pl_joint_kernels_of(world)->width;
    const size_t first = (size_t)bundle * width;
    uint32_t *slots = (uint32_t *)plan->slots.data + 2 * first;
    pl_joint_lane *lanes = (pl_joint_lane *)plan->lanes.data + first;
    const bool bare =
        plan->patterns[((const pl_joint_bundle *)plan->bundles.data)[bundle].pattern].bare;
    const uint32_t end = width * (plan->bundle_count - bundle); // of lanes
    for (uint32_t i = 0; i < width; ++i) {
        uint32_t joint = lanes[i].joint;
        if (i + AHEAD < end && lanes[i + AHEAD].joint != PL_NONE) {
            fetch(&pl_joint_items(&world->joints)[lanes[i + AHEAD].joint], bare);
        }
        if (joint == PL_NONE) {
            slots[i] = slots[width + i] = world->solver.slot_count - 1;
            starts[i] = (pl_joint_start){ .arm_a = { 0, 0 } };
            continue;
        }
        const pl_joint_mark *mark = &pl_joint_marks(&world->joints)[joint];
        slots[i] = slot_of(world, mark->row_a);
        slots[width + i] = slot_of(world, mark->row_b);
        if (bare) {
            pl_joint_start_bare(world, &lanes[i], &starts[i], c->h);
        } else {
            begin_wide(world, &pl_joint_items(&world->joints)[joint], &starts[i], &rows[i], c->h);
        }
    }
}

typedef struct beginning {
    const pl_joint_context *context;
    bool tense; // some lane asks for more inertia
} beginning;

static void begin_bundles(void *context, uint32_t first, uint32_t count)
{
    beginning *out = context;
    const pl_joint_context *c = out->context;
    const pl_joint_kernels *kernels = pl_joint_kernels_of(c->world);
    // Bundle by bundle: what lanes begin with is made and goes into them before memory sees it.
    _Alignas(4 * sizeof(near_real)) pl_joint_start starts[PL_JOINT_LANES];
    pl_rows rows[PL_JOINT_LANES];
    bool tense = false;
    pl_joint_call call = call_of(c);
    call.starts = starts;
    call.rows = rows;
    call.tense = &tense;
    for (uint32_t k = first; k < first + count; ++k) {
        begin_lanes(c, k, starts, rows);
        call.first = k, call.end = k + 1;
        kernels->fill(&call);
    }
    if (tense) {
        __atomic_store_n(&out->tense, true, __ATOMIC_RELAXED);
    }
}

static void begin_lone(const pl_joint_context *c, uint32_t i, pl_lone *out)
{
    begin(c->world, pl_joint_grouped(&c->world->joints, i), c->h);
    pl_one_take(c, i, out);
    pl_one_forget(out->joint);
    pl_one_rows(c->world, out->joint, out->a, out->b);
    if (c->world->desc.solver == PLUMB_SOLVER_SOFT && !c->exact) {
        pl_one_note_springs(out->joint, out->a, out->b);
    }
}

// Impulse times arm of a joint with rows, of A and of B. [N m s]
static void pulls_of(const pl_joint *j, near_real out[2])
{
    real x = 0, y = 0;
    for (int i = 0; i < j->rows.count; ++i) {
        x += j->rows.row[i].bx * j->impulse[i];
        y += j->rows.row[i].by * j->impulse[i];
    }
    out[0] = (near_real) - (x * j->pose_a.rx + y * j->pose_a.ry);
    out[1] = (near_real)(x * j->pose_b.rx + y * j->pose_b.ry);
}

static bool begin_all(const pl_joint_context *c)
{
    beginning b = { .context = c };
    pl_tasks_shares(c->tasks, c->group->color_first, PL_JOINT_COLORS, LEAST, begin_bundles, &b);
    for (uint32_t i = c->group->alone; i < c->group->end; ++i) {
        pl_lone one;
        near_real pull[2];
        begin_lone(c, i, &one);
        pulls_of(one.joint, pull);
        b.tense |= pl_joint_inertia(pull[0], (near_real)c->h, one.a->inv_inertia) > 0 ||
                   pl_joint_inertia(pull[1], (near_real)c->h, one.b->inv_inertia) > 0;
    }
    return b.tense;
}

near_real pl_one_own_inertia(const plumb_world *world, const pl_joint *j, int end)
{
    const pl_joint_mark *mark = &pl_joint_marks(&world->joints)[j - pl_joint_items(&world->joints)];
    const uint32_t row = end == 0 ? mark->row_a : mark->row_b;
    return row < world->dynamic_count ? (near_real)world->bodies.inv_inertia[row] : 0;
}

static void stiffen_all(const pl_joint_context *c)
{
    const pl_joint_kernels *kernels = pl_joint_kernels_of(c->world);
    const near_real h = (near_real)c->h;
    pl_joint_call call = call_of(c);
    call.first = c->group->color_first[0], call.end = c->group->color_first[PL_JOINT_COLORS];
    kernels->stiffen(&call);
    for (uint32_t i = c->group->alone; i < c->group->end; ++i) {
        pl_lone one;
        near_real pull[2];
        pl_one_take(c, i, &one);
        pulls_of(one.joint, pull);
        pl_joint_stiffen(one.a, pull[0], h, pl_one_own_inertia(c->world, one.joint, 0));
        pl_joint_stiffen(one.b, pull[1], h, pl_one_own_inertia(c->world, one.joint, 1));
    }
}

void pl_joints_prepare(const pl_joint_context *c)
{
    if (!begin_all(c)) {
        return;
    }
    stiffen_all(c);
    each_bundle(c, pl_joint_kernels_of(c->world)->refill);
    for (uint32_t i = c->group->alone; i < c->group->end; ++i) {
        pl_lone one;
        pl_one_take(c, i, &one);
        pl_one_rows(c->world, one.joint, one.a, one.b);
    }
}

void pl_joints_warm_start(const pl_joint_context *c)
{
    sweep_bundles(c, pl_joint_kernels_of(c->world)->warm_start);
    for (uint32_t i = c->group->alone; i < c->group->end; ++i) {
        pl_lone one;
        pl_one_take(c, i, &one);
        const pl_joint *j = one.joint;
        for (int k = 0; k < j->rows.count; ++k) {
            if (j->impulse[k] != 0) {
                pl_one_push(&j->rows.row[k], one.a, one.b, j->impulse[k]);
            }
        }
    }
}

static void sweep_lanes(const pl_joint_context *c, pl_joint_sweep sweep, bool first)
{
    const pl_joint_kernels *kernels = pl_joint_kernels_of(c->world);
    if (sweep == PL_SWEEP_PULL) {
        sweep_bundles(c, first ? kernels->pull_first : kernels->pull);
    } else if (sweep == PL_SWEEP_RELAX) {
        sweep_bundles(c, first ? kernels->relax_first : kernels->relax);
    }
}

static void sweep_alone(const pl_joint_context *c, pl_joint_sweep sweep, bool first)
{
    const bool *swept = pl_joints_direct(c->world) ? c->world->joints.plan.direct.swept.data : NULL;
    for (uint32_t i = c->group->alone; i < c->group->end; ++i) {
        pl_lone one;
        pl_one_take(c, i, &one);
        pl_joint *j = one.joint;
        if (first && sweep == PL_SWEEP_PULL) {
            pl_one_pay(c, j, one.a, one.b);
        } else if (first && sweep == PL_SWEEP_RELAX) {
            pl_one_refresh(c, j, one.a, one.b);
            pl_one_let_go(j, one.a, one.b);
        }
        if (swept != NULL && !swept[i]) {
            continue;
        }
        for (int k = j->rows.count - 1; k >= j->rows.block; --k) {
            if (!pl_one_is_answered(j, k)) {
                pl_one_solve_row(c, j, k, one.a, one.b, sweep, first);
            }
        }
        pl_one_solve_block(c, j, one.a, one.b, sweep, first);
        for (int k = j->rows.count - 1; k >= j->rows.block; --k) {
            if (pl_one_is_answered(j, k)) {
                pl_one_solve_row(c, j, k, one.a, one.b, sweep, first);
            }
        }
    }
}

void pl_joints_solve(const pl_joint_context *c, pl_joint_sweep sweep, bool first)
{
    const int sweeps = sweep == PL_SWEEP_CLASSIC ? 1 : SWEEPS;
    for (int i = 0; i < sweeps; ++i) {
        sweep_lanes(c, sweep, first && i == 0);
        sweep_alone(c, sweep, first && i == 0);
    }
    if (pl_joints_direct(c->world)) {
        pl_direct_solve(c, sweep);
    }
    for (uint32_t i = c->group->alone; i < c->group->end && sweep == PL_SWEEP_RELAX; ++i) {
        pl_lone one;
        pl_one_take(c, i, &one);
        pl_one_note_springs(one.joint, one.a, one.b);
    }
}

void pl_joints_tally_lanes(const pl_joint_context *c)
{
    each_bundle(c, pl_joint_kernels_of(c->world)->tally);
}

void pl_joints_measure_lanes(const pl_joint_context *c, const struct pl_measuring *m)
{
    pl_joint_call call = call_of(c);
    call.first = c->group->color_first[0], call.end = c->group->color_first[PL_JOINT_COLORS];
    pl_joint_kernels_of(c->world)->measure(&call, m);
}

void pl_joints_store(const pl_joint_context *c)
{
    each_bundle(c, pl_joint_kernels_of(c->world)->store);
}

void pl_joints_move(const pl_joint_context *c, real share)
{
    for (uint32_t i = c->group->alone; i < c->group->end; ++i) {
        pl_lone one;
        pl_one_take(c, i, &one);
        pl_one_rows(c->world, one.joint, one.a, one.b);
        pl_one_move(one.joint, one.a, one.b, share);
        pl_one_rows(c->world, one.joint, one.a, one.b);
    }
}
