// loop.c - fixed steps, and poses between them: see plumb/loop.h.
//
// Commands are carried out before poses are kept, so a teleport by command is no motion; and a body whose pose
// is not the one that the step left has been moved since. Static bodies need none; those that sleep may wake in the step.
//
// Reads: poses. Writes: its own last_poses; steps the world. Cost: O(bodies that are not static) a step.
#include "api/command.h"
#include "plumb/loop.h"
#include "plumb/math.h"
#include "world/check.h"
#include "world/state.h"

#include <float.h>

// Where a body was before the last step and behind it: a place in the world's own terms, so centre and rotation.
typedef struct last_pose {
    uint32_t generation;
    uint32_t tick; // of the loop, when it was kept
    real from_x, from_y, from_c, from_s;
    real x, y, c, s;
} last_pose;

struct plumb_loop {
    plumb_world *world;
    pl_memory memory;
    plumb_loop_desc desc; // defaults resolved
    double owed;          // [s] < dt between frames
    uint32_t tick;
    pl_buffer last_poses; // last_pose by slot of the registry
    uint32_t kept;        // slots that the buffer is made for
};

#define STEPS_MOST 1000

plumb_result plumb_loop_create(plumb_world *world, const plumb_loop_desc *desc, plumb_loop **loop)
{
    const plumb_loop_desc none = { 0 };
    plumb_loop made = { .world = world, .desc = desc == NULL ? none : *desc };
    if (loop != NULL) {
        *loop = NULL;
    }
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_pointer(world, __func__, "loop", loop));
    PL_TRY(pl_check_range(world, __func__, "dt", (real)made.desc.dt, 0, 1));
    if ((made.desc.steps_max < 0 || made.desc.steps_max > STEPS_MOST)) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "steps_max is %d; it must be 0 to %d",
                       made.desc.steps_max, STEPS_MOST);
    }
    made.desc.dt = made.desc.dt > 0 ? made.desc.dt : 1.0 / 60;
    made.desc.steps_max = made.desc.steps_max > 0 ? made.desc.steps_max : 8;
    pl_memory_init(&made.memory, &world->memory.hooks);
    *loop = pl_resize(&made.memory, NULL, 0, sizeof made);
    if (*loop == NULL) {
        return pl_fail_memory(world, __func__);
    }
    **loop = made;
    return PLUMB_OK;
}

void plumb_loop_destroy(plumb_loop *loop)
{
    if (loop != NULL) {
        pl_memory memory = loop->memory;
        pl_buffer_free(&memory, &loop->last_poses);
        pl_resize(&memory, loop, sizeof *loop, 0);
    }
}

// Steps of a frame are counted with a grain of time to spare: sums of sixtieths round.
#define GRAIN 1e-9 // [-] of a step

int plumb_loop_frame(plumb_loop *loop, double seconds)
{
    if (loop == NULL) {
        return -1;
    }
    if (!(seconds >= 0 && seconds <= DBL_MAX)) {
        pl_fail(loop->world, seconds < 0 ? PLUMB_E_RANGE : PLUMB_E_NOT_FINITE, __func__,
                "seconds is %g; it must be %s", seconds, seconds < 0 ? "0 or more" : "finite");
        return -1;
    }
    const double most = (double)loop->desc.steps_max, dt = loop->desc.dt;
    const double due = (loop->owed + seconds) / dt + GRAIN;
    if (due >= most + 1) {
        loop->owed = 0;
        return loop->desc.steps_max;
    }
    const int steps = (int)due;
    const double left = loop->owed + seconds - steps * dt;
    loop->owed = left > 0 ? left : 0;
    return steps;
}

plumb_real plumb_loop_alpha(const plumb_loop *loop)
{
    return loop == NULL ? 0 : (real)(loop->owed / loop->desc.dt);
}

//---- poses ---------------------------------------------------------------------------------------

static bool reserve(plumb_loop *loop)
{
    const uint32_t slots = loop->world->registry.count;
    if (!pl_buffer_reserve(&loop->memory, &loop->last_poses, (size_t)slots * sizeof(last_pose))) {
        return false;
    }
    for (; loop->kept < slots; ++loop->kept) {
        ((last_pose *)loop->last_poses.data)[loop->kept] = (last_pose){ .generation = 0 };
    }
    return true;
}

// Static rows come last.
static uint32_t movable_rows(const plumb_world *world)
{
    return world->dynamic_count + world->kinematic_count + world->asleep_count;
}

static void keep_before(plumb_loop *loop)
{
    const pl_bodies *b = &loop->world->bodies;
    for (uint32_t row = 0; row < movable_rows(loop->world); ++row) {
        const plumb_entity body = b->entity[row].entity;
        last_pose *n = (last_pose *)loop->last_poses.data + body.index;
        n->generation = body.generation;
        n->tick = loop->tick;
        n->from_x = b->center_x[row], n->from_y = b->center_y[row];
        n->from_c = b->c[row], n->from_s = b->s[row];
    }
}

// What was kept before the step; rows may have moved.
static void keep_after(plumb_loop *loop)
{
    const pl_bodies *b = &loop->world->bodies;
    for (uint32_t row = 0; row < movable_rows(loop->world); ++row) {
        const plumb_entity body = b->entity[row].entity;
        if (body.index < loop->kept) {
            last_pose *n = (last_pose *)loop->last_poses.data + body.index;
            n->x = b->center_x[row], n->y = b->center_y[row];
            n->c = b->c[row], n->s = b->s[row];
        }
    }
}

plumb_result plumb_loop_step(plumb_loop *loop)
{
    if (loop == NULL) {
        return PLUMB_E_NULL;
    }
    plumb_world *world = loop->world;
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_commands_run(world));
    if (!reserve(loop)) {
        return pl_fail_memory(world, __func__);
    }
    ++loop->tick;
    keep_before(loop);
    PL_TRY(plumb_world_step(world, (real)loop->desc.dt));
    keep_after(loop);
    return PLUMB_OK;
}

plumb_transform plumb_loop_transform(const plumb_loop *loop, plumb_body body)
{
    const uint32_t row = loop == NULL ? PL_NONE : pl_body_row(loop->world, body);
    if (row == PL_NONE) {
        return (plumb_transform){ { 0, 0 }, { 0, 0 } };
    }
    const plumb_world *world = loop->world;
    const pl_bodies *b = &world->bodies;
    const plumb_transform now = { { b->x[row], b->y[row] }, { b->c[row], b->s[row] } };
    const plumb_entity e = body.entity;
    const last_pose *n =
        e.index < loop->kept ? (const last_pose *)loop->last_poses.data + e.index : NULL;
    const bool moved_on = n != NULL && n->generation == e.generation && n->tick == loop->tick &&
                          n->x == b->center_x[row] && n->y == b->center_y[row] &&
                          n->c == b->c[row] && n->s == b->s[row];
    if (!moved_on) {
        return now;
    }
    // Centres fly on smooth curves, origins of bodies that spin do not.
    const real back = 1 - plumb_loop_alpha(loop);
    const plumb_vec2 center = plumb_v2(n->x, n->y);
    const plumb_vec2 way = plumb_world_way(world, center, plumb_v2(n->from_x, n->from_y));
    const plumb_rot q = plumb_rot_blend(now.q, (plumb_rot){ n->from_c, n->from_s }, back);
    const plumb_vec2 arm = plumb_rot_apply(q, plumb_v2(b->local_x[row], b->local_y[row]));
    return (plumb_transform){ plumb_vec2_sub(plumb_vec2_add_scaled(center, back, way), arm), q };
}
