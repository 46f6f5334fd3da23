// cable.c - a rope from a rim on A to a rim on B, which it winds on and off without slipping; it only pulls.
//
// n is the direction of the free run, m = left(n) the way from the centre of a rim to where the run touches it, if that is on
// the left; radii r are signed, < 0: on the right. Then d + (rb - ra) m = L n, L the free run, d from centre to centre: with
// e = ra - rb, d . n = L and d . m = e, so that
//     L = sqrt(d^2 - e^2),     n = (L d - e left(d)) / d^2.
// As the run turns by t since it was made, and the rims by a and b, it is wound on by -ra (t - a) + rb (t - b). The value is
//     L - ra (t - a) + rb (t - b),
// and its slope is n at the tangent points: what the turning of the run does to L and to what is wound cancels. Its bend is that of
// a length between the centres, for those of the tangent points cancel as well:
//     C'' = (m . (VB - VA))^2 / L + a'^2 n . arm of A - b'^2 n . arm of B,     V: velocities of the centres,
// which is what pl_one_bow adds from `along` and `over`.
//
// The row alone does not know how often the run has turned round: pl_joint.sum is by how much it had at the end of the step before,
// and a step turns it by less than a half.
//
// d < |e|: one rim is within the other, or both lie one upon the other and the rope crosses. No line touches both: it is loose, until
// the end of the step in which they have parted; where it would be too short by then, it has slipped by as much. (With the slope of C
// there, |e| / d, a rope would pull as hard as one likes. With less, what turns meanwhile is not what the row is told: in one of 200
// tangles energy grew by 75 %.)
// Value: free run, and what has been wound on since it was made, less what has slipped [m].
#include "joints/parts.h"
#include "world/check.h"
#include "world/state.h"

#include <math.h>

#define TURN  6.283185307179586476925
#define LOOSE ((real)1e6) // [m] by which a loose rope is too long

// pl_joint.target of a cable: how much has slipped [m]; 1 where rims were within one another as the last step ended.
#define SLIPPED  target.x
#define IS_LOOSE target.y

static plumb_vec2 direction(const plumb_world *world, const plumb_joint_desc *d)
{
    real length;
    return pl_cable_run(plumb_world_way(world, d->anchor, d->anchor_b), d->radius_a - d->radius_b,
                        &length);
}

static plumb_result check(const plumb_world *world, const char *fn, plumb_joint_desc *desc)
{
    const plumb_vec2 d = plumb_world_way(world, desc->anchor, desc->anchor_b);
    const real e = desc->radius_a - desc->radius_b;
    real length;
    pl_cable_run(d, e, &length);
    if (!(length > 0)) {
        return pl_fail(
            world, PLUMB_E_GEOMETRY, fn,
            "anchors are %g m apart; no rope touches both rims unless it is more than %g",
            (double)plumb_vec2_magnitude(d), (double)plumb_abs(e));
    }
    desc->length = desc->length != 0 ? desc->length : length;
    return PLUMB_OK;
}

// [rad] by which the run has turned since it was made: of all the same directions what is nearest to where it was.
static double turn_of(const pl_joint *j, const pl_joint_pose *a, plumb_vec2 n)
{
    const plumb_vec2 axis = pl_joint_axis(j, a);
    const double turn = (double)plumb_vec2_turn(axis, n) + a->angle;
    return turn + TURN * floor(((double)j->sum - turn) / TURN + 0.5);
}

// The row whose C is the value, less `length`.
static pl_row row_of(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, real length)
{
    const double ra = (double)j->desc.radius_a, rb = (double)j->desc.radius_b;
    const real e = j->desc.radius_a - j->desc.radius_b;
    real run;
    const plumb_vec2 d = pl_joint_apart(a, b), n = pl_cable_run(d, e, &run), m = plumb_vec2_left(n);
    const double turned = e != 0 ? (double)e * turn_of(j, a, n) : 0;
    const double wound = ra * a->angle - rb * b->angle - turned - (double)j->SLIPPED;
    plumb_vec2 at_a = plumb_vec2_scale(j->desc.radius_a, m);
    plumb_vec2 at_b = plumb_vec2_scale(j->desc.radius_b, m);
    if (run == 0) {
        // What it gave is taken back: at one point, or angular momentum would come of it.
        const plumb_vec2 way = plumb_vec2_sub(plumb_vec2_add(d, at_b), at_a);
        at_a = plumb_vec2_add_scaled(at_a, (real)0.5, way);
        at_b = plumb_vec2_add_scaled(at_b, (real)-0.5, way);
    }
    const plumb_vec2 arm_a = plumb_v2(a->rx, a->ry), arm_b = plumb_v2(b->rx, b->ry);
    return (pl_row){ .ax = -n.x,
                     .ay = -n.y,
                     .aw = -plumb_vec2_cross(plumb_vec2_add(arm_a, at_a), n),
                     .bx = n.x,
                     .by = n.y,
                     .bw = plumb_vec2_cross(plumb_vec2_add(arm_b, at_b), n),
                     .error = (real)((double)run + wound - (double)length),
                     .along_a = plumb_vec2_dot(n, arm_a),
                     .along_b = plumb_vec2_dot(n, arm_b),
                     .over = run > 0 ? 1 / run : 0,
                     .most = PL_UNBOUNDED,
                     .type = PL_ROW_EQUAL };
}

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    const pl_row row = row_of(j, a, b, j->desc.length);
    out->row[0] = pl_row_at_most(row, 0);
    if (row.over == 0 || j->IS_LOOSE != 0) { // not off: so what it gave is taken back
        out->row[0].error = LOOSE;
    }
    out->count = 1;
    out->block = 0;
}

static pl_row slope(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    return row_of(j, a, b, 0);
}

static real value(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    return row_of(j, a, b, 0).error;
}

static void advance(pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    real run;
    const real e = j->desc.radius_a - j->desc.radius_b;
    const plumb_vec2 n = pl_cable_run(pl_joint_apart(a, b), e, &run);
    j->sum = e != 0 ? (real)turn_of(j, a, n) : 0;
    const bool was_loose = j->IS_LOOSE != 0;
    j->IS_LOOSE = (real)(run > 0 ? 0 : 1);
    if (was_loose && run > 0) {
        j->SLIPPED += plumb_max(row_of(j, a, b, j->desc.length).error, 0);
    }
}

const pl_joint_class pl_joint_cable = { .name = "cable",
                                        .has = PL_JOINT_TWO_ANCHORS | PL_JOINT_LENGTH |
                                               PL_JOINT_RADII | PL_JOINT_TRAVELS,
                                        .check = check,
                                        .direction = direction,
                                        .rows = rows,
                                        .value = value,
                                        .slope = slope,
                                        .advance = advance };
