// ratchet.c - a pawl on A lets B turn one way and falls behind every tooth that passes: C = turn -
// tooth, in the allowed direction. Value: the turn of B relative to A [rad].
#include "joints/parts.h"
#include "world/check.h"
#include "world/state.h"

static plumb_result check(const plumb_world *world, const char *fn, plumb_joint_desc *desc)
{
    if (desc->pitch != 0) {
        return pl_check_finite(world, fn, "pitch", desc->pitch);
    }
    return pl_fail(world, PLUMB_E_RANGE, fn, "pitch is 0; a ratchet must have teeth");
}

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    pl_row turn = pl_row_angle(a, b, 0);
    real tooth = j->sum; // where the pawl rests: see pl_joints_finish
    out->row[0] = j->desc.pitch > 0 ? pl_row_at_least(turn, tooth) : pl_row_at_most(turn, tooth);
    out->count = 1;
    out->block = 0;
}

// The pawl falls behind the last tooth that has passed; it never goes back.
static void advance(pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    double pitch = (double)j->desc.pitch;
    double passed = ((b->angle - a->angle) - (double)j->sum) / pitch;
    if (passed >= 1) {
        j->sum += (real)((double)(int64_t)plumb_min((real)passed, (real)1e9) * pitch);
    }
}

const pl_joint_class pl_joint_ratchet = { .name = "ratchet",
                                          .has = PL_JOINT_PITCH | PL_JOINT_RADIANS,
                                          .check = check,
                                          .rows = rows,
                                          .value = pl_value_turn,
                                          .advance = advance };
