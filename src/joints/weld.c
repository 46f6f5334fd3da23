// weld.c - glue: anchors coincide and B does not turn relative to A; a spring softens the turn.
// Value: the turn that is left [rad].
#include "joints/parts.h"

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    pl_rows_point(out, a, b, plumb_v2(0, 0));
    out->row[2] = pl_row_angle(a, b, j->desc.rest);
    out->row[2].hertz = j->desc.hertz;
    out->row[2].damping = j->desc.damping;
    out->block = j->desc.hertz > 0 ? 2 : 3;
    out->count = 3;
}

const pl_joint_class pl_joint_weld = { .name = "weld",
                                       .has = PL_JOINT_SPRING | PL_JOINT_REST | PL_JOINT_RADIANS,
                                       .rows = rows,
                                       .value = pl_value_turn };
