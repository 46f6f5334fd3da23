// motor.c - drives B to a pose relative to A by bounded force and torque, rigid or as a spring.
// Value: the turn of B relative to A [rad].
#include "joints/parts.h"

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    plumb_vec2 offset = plumb_rot_apply((plumb_rot){ a->c, a->s }, j->target);
    // The wanted point turns with A: its arm, not the anchor's, is what A's turning moves.
    pl_joint_pose from = *a;
    from.rx += offset.x;
    from.ry += offset.y;
    pl_rows_point(out, &from, b, plumb_v2(0, 0));
    out->row[2] = pl_row_angle(a, b, j->desc.rest);
    for (int i = 0; i < 3; ++i) {
        out->row[i].hertz = j->desc.hertz;
        out->row[i].damping = j->desc.damping;
    }
    out->row[2].most = pl_joint_bound(j->desc.max_torque);
    out->block_most = pl_joint_bound(j->desc.max_force);
    out->count = 3;
}

static real value(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    (void)j;
    return pl_joint_turn(a, b);
}

const pl_joint_class pl_joint_motor = { .name = "motor",
                                        .has = PL_JOINT_SPRING | PL_JOINT_TARGET | PL_JOINT_RADIANS,
                                        .rows = rows,
                                        .value = value };
