// joint_memory.c - what a joint knows of its past, read and given back: saving and loading.
//
// Poses are told anew at the start of every step, so the past is: anchors and axis in their bodies'
// frames, the angles at which things were made, full turns since, what is kept, and the impulses that
// the next step starts with. Reads, writes: one joint. Cost: O(1).
#include "world/joint_list.h"
#include "joints/joint.h"
#include "plumb/math.h"
#include "world/check.h"
#include "world/state.h"

#define POINT_MOST ((real)1e9) // [m] as positions of bodies
#define UNIT_SLACK ((real)1e-3)

_Static_assert(sizeof((plumb_joint_memory *)0)->impulses == PL_JOINT_ROWS * sizeof(real),
               "one impulse a row");

plumb_result plumb_joint_get_memory(const plumb_world *world, plumb_joint joint,
                                    plumb_joint_memory *memory)
{
    pl_joint *j;
    PL_TRY(pl_check_joint(world, __func__, joint, &j));
    PL_TRY(pl_check_pointer(world, __func__, "memory", memory));
    pl_joint now = *j;
    pl_joint_begin(world, &now); // counts the turns of the last step
    *memory = (plumb_joint_memory){
        .anchor_a = now.a.local,
        .anchor_b = now.b.local,
        .axis = now.axis,
        .offset = now.target,
        .start_a = (real)now.a.start,
        .start_b = (real)now.b.start,
        .turns_a = now.a.turns,
        .turns_b = now.b.turns,
        .kept = now.sum,
        .substep = now.h,
    };
    for (int i = 0; i < PL_JOINT_ROWS; ++i) {
        memory->impulses[i] = now.impulse[i];
    }
    return PLUMB_OK;
}

static plumb_result check(const plumb_world *world, const char *fn, const plumb_joint_memory *m)
{
    PL_TRY(pl_check_within(world, fn, "anchor_a", m->anchor_a, POINT_MOST));
    PL_TRY(pl_check_within(world, fn, "anchor_b", m->anchor_b, POINT_MOST));
    PL_TRY(pl_check_finite_vec(world, fn, "axis", m->axis));
    PL_TRY(pl_check_finite_vec(world, fn, "offset", m->offset));
    PL_TRY(pl_check_finite(world, fn, "start_a", m->start_a));
    PL_TRY(pl_check_finite(world, fn, "start_b", m->start_b));
    PL_TRY(pl_check_finite(world, fn, "kept", m->kept));
    PL_TRY(pl_check_range(world, fn, "substep", m->substep, 0, 1));
    for (int i = 0; i < PL_JOINT_ROWS; ++i) {
        PL_TRY(pl_check_finite(world, fn, "impulses", m->impulses[i]));
    }
    real length = plumb_vec2_magnitude(m->axis);
    if (length != 0 && plumb_abs(length - 1) > UNIT_SLACK) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "axis is (%g, %g); it must have length 1, or be 0",
                       (double)m->axis.x, (double)m->axis.y);
    }
    return PLUMB_OK;
}

static void recall(const plumb_world *world, pl_joint_end *end, plumb_vec2 anchor, real start,
                   int32_t turns)
{
    end->local = anchor;
    if (!plumb_is_null(end->body)) {
        end->start = (double)start;
        end->eighth = pl_joint_eighth(world, pl_body_row(world, end->body));
        end->turns = turns;
    }
}

plumb_result plumb_joint_set_memory(plumb_world *world, plumb_joint joint,
                                    const plumb_joint_memory *memory)
{
    pl_joint *j;
    PL_TRY(pl_check_joint(world, __func__, joint, &j));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "memory", memory));
    PL_TRY(check(world, __func__, memory));
    recall(world, &j->a, memory->anchor_a, memory->start_a, memory->turns_a);
    recall(world, &j->b, memory->anchor_b, memory->start_b, memory->turns_b);
    j->axis = memory->axis;
    j->target = memory->offset;
    j->sum = memory->kept;
    j->h = memory->substep;
    for (int i = 0; i < PL_JOINT_ROWS; ++i) {
        j->impulse[i] = memory->impulses[i];
    }
    pl_joint_disturb(world, j);
    pl_joints_replan(&world->joints);
    return PLUMB_OK;
}
