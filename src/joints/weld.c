// weld.c - glue: anchors coincide and B does not turn relative to A; a spring softens the turn.
// Value: the turn that is left [rad].
#include "joints/parts.h"

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    pl_rows_point(out, a, b, plumb_v2(0, 0));
    out->row[2] = pl_row_angle(a, b, j->desc.rest);
    pl_row_soften(&out->row[2], &j->desc, 0);
    out->block = pl_joint_has_spring(&j->desc) ? 2 : 3;
    out->count = 3;
}

const pl_joint_class pl_joint_weld = { .name = "weld",
                                       .has = PL_JOINT_SPRING | PL_JOINT_REST | PL_JOINT_RADIANS,
                                       .rows = rows,
                                       .value = pl_value_turn };
