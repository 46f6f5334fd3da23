// motor.c - drives B to a pose relative to A by bounded force and torque, rigid or as a spring.
// Value: the turn of B relative to A [rad].
#include "joints/parts.h"

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    pl_rows_point(out, a, b, j->target);
    out->row[2] = pl_row_angle(a, b, j->desc.rest);
    for (int i = 0; i < 3; ++i) {
        pl_row_soften(&out->row[i], &j->desc, i < 2 ? j->spring_mass : 0);
    }
    out->row[2].most = pl_joint_bound(j->desc.max_torque);
    out->block_most = pl_joint_bound(j->desc.max_force);
    out->count = 3;
}

const pl_joint_class pl_joint_motor = { .name = "motor",
                                        .has = PL_JOINT_SPRING | PL_JOINT_REST | PL_JOINT_TARGET |
                                               PL_JOINT_FORCE | PL_JOINT_TORQUE | PL_JOINT_RADIANS,
                                        .rows = rows,
                                        .value = pl_value_turn };
