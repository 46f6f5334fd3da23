// pulley.c - a rope from A's anchor over two fixed wheels to B's: |A - ground_a| + ratio |B -
// ground_b| is kept. Value: the sum, less what it was [m].
#include "joints/parts.h"
#include "world/check.h"
#include "world/state.h"

static plumb_result check(const plumb_world *world, const char *fn, plumb_joint_desc *desc)
{
    desc->ratio = desc->ratio != 0 ? desc->ratio : 1;
    PL_TRY(pl_check_finite_vec(world, fn, "ground_a", desc->ground_a));
    PL_TRY(pl_check_finite_vec(world, fn, "ground_b", desc->ground_b));
    if (desc->ratio < 0) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "ratio is %g; it must be above 0, or 0 for 1",
                       (double)desc->ratio);
    }
    if ((plumb_vec2_distance(desc->anchor, desc->ground_a) == 0 ||
         plumb_vec2_distance(desc->anchor_b, desc->ground_b) == 0)) {
        return pl_fail(world, PLUMB_E_GEOMETRY, fn,
                       "ground_%c is the anchor; the rope must have length on both sides",
                       plumb_vec2_distance(desc->anchor, desc->ground_a) == 0 ? 'a' : 'b');
    }
    return PLUMB_OK;
}

// From a wheel of the world to an anchor: pose->x is told from the joint's origin.
static plumb_vec2 rope(const pl_joint_pose *pose, plumb_vec2 ground, real *length)
{
    plumb_vec2 to = { pose->x + pose->rx - ground.x, pose->y + pose->ry - ground.y };
    return plumb_vec2_unit_and_magnitude(to, length);
}

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    real length_a, length_b, ratio = j->desc.ratio;
    // Poses are told from where A's centre was at the start of the step.
    plumb_vec2 ground_a = plumb_vec2_sub(j->desc.ground_a, j->origin);
    plumb_vec2 ground_b = plumb_vec2_sub(j->desc.ground_b, j->origin);
    plumb_vec2 ua = rope(a, ground_a, &length_a), ub = rope(b, ground_b, &length_b);
    out->row[0] = (pl_row){ .ax = ua.x,
                            .ay = ua.y,
                            .aw = a->rx * ua.y - a->ry * ua.x,
                            .bx = ratio * ub.x,
                            .by = ratio * ub.y,
                            .bw = ratio * (b->rx * ub.y - b->ry * ub.x),
                            .error = length_a + ratio * length_b - j->sum,
                            .most = PL_UNBOUNDED,
                            .type = PL_ROW_EQUAL };
    out->count = 1;
    out->block = 0;
}

const pl_joint_class pl_joint_pulley = { .name = "pulley",
                                         .has = PL_JOINT_TWO_ANCHORS | PL_JOINT_GROUNDS |
                                                PL_JOINT_RATIO,
                                         .check = check,
                                         .rows = rows,
                                         .keep = pl_value_row,
                                         .value = pl_value_row,
                                         .slope = pl_slope_row };
