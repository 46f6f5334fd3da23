// joint.c - where the bodies of joints are: poses from A's centre, full turns; who is awake.
//
// Reads: bodies, joints. Writes: poses and turns of joints, the list of those that are awake. Cost: O(1) a joint.
#include "joints/joint.h"

#include "plumb/math.h"
#include "world/check.h"
#include "world/desc_list.h"
#include "world/destroy.h"
#include "world/joint_list.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <string.h>

#define TURN 6.283185307179586476925

//---- lookup
//---------------------------------------------------------------------------------------

//---- sleep
//----------------------------------------------------------------------------------------

static bool is_awake(const plumb_world *world, const pl_joint *joint)
{
    return !plumb_is_null(joint->entity) &&
           !pl_row_is_asleep(world, pl_joint_row(world, &joint->a)) &&
           !pl_row_is_asleep(world, pl_joint_row(world, &joint->b));
}

bool pl_joints_any_awake(const plumb_world *world)
{
    const pl_joint *items = pl_joint_items(&world->joints);
    for (uint32_t i = 0; i < world->joints.count; ++i) {
        if (is_awake(world, &items[i])) {
            return true;
        }
    }
    return false;
}

uint32_t pl_joints_awake(plumb_world *world)
{
    pl_joints *joints = &world->joints;
    if (joints->awake_stale) {
        uint32_t *awake = joints->awake.data;
        joints->awake_stale = false;
        joints->awake_count = 0;
        pl_joints_replan(joints);
        for (uint32_t i = 0; i < joints->count; ++i) {
            if (is_awake(world, &pl_joint_items(joints)[i])) {
                awake[joints->awake_count++] = i;
            }
        }
    }
    return joints->awake_count;
}

//---- poses
//----------------------------------------------------------------------------------------

// [m] where a body's centre is; in the far build, where a double does not hold all of it, in two parts.
typedef struct spot {
    double x, y, residual_x, residual_y;
} spot;

// [m] from a body's centre to a point of it, in world axes.
static plumb_vec2 arm_to(const plumb_world *world, plumb_vec2 local, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return plumb_rot_apply((plumb_rot){ b->c[row], b->s[row] },
                           plumb_v2(local.x - b->local_x[row], local.y - b->local_y[row]));
}

// What never moves is held at the anchor, as the world is: in the far build its centre may be too far away.
static bool is_held_at_anchor(const plumb_world *world, uint32_t row)
{
    return row == PL_NONE || (PLUMB_IS_FAR && world->bodies.type[row] == PLUMB_STATIC);
}

// Centre of the body at `row`; the world's is the anchor.
static spot center_of(const plumb_world *world, plumb_vec2 local, uint32_t row)
{
    if (row == PL_NONE) {
        return (spot){ .x = (double)local.x, .y = (double)local.y };
    }
    const pl_bodies *b = &world->bodies;
    const double x = (double)b->center_x[row], y = (double)b->center_y[row];
    const double residual_x = (double)b->residual_x[row], residual_y = (double)b->residual_y[row];
    if (is_held_at_anchor(world, row)) {
        plumb_vec2 arm = arm_to(world, local, row);
        return (spot){ .x = x + (double)arm.x, .y = y + (double)arm.y };
    }
    return PLUMB_IS_FAR ? (spot){ x, y, residual_x, residual_y }
                        : (spot){ .x = x + residual_x, .y = y + residual_y };
}

static pl_shift way(const spot *from, const spot *to)
{
    pl_shift way = { to->x - from->x, to->y - from->y };
    if (PLUMB_IS_FAR) {
        way.x += to->residual_x - from->residual_x;
        way.y += to->residual_y - from->residual_y;
    }
    return way;
}

// [m] from a body's centre to its anchor, in world axes.
static plumb_vec2 arm_of(const plumb_world *world, plumb_vec2 local, uint32_t row)
{
    return is_held_at_anchor(world, row) ? plumb_v2(0, 0) : arm_to(world, local, row);
}

// `angle` [rad] of the body now, in (-pi, pi].
static pl_joint_pose pose_now(const plumb_world *world, const pl_joint_end *end, uint32_t row,
                              const spot *from, double angle)
{
    const spot center = center_of(world, end->local, row);
    const pl_shift d = way(from, &center);
    if (row == PL_NONE) {
        return (pl_joint_pose){ .x = (real)d.x, .y = (real)d.y, .c = 1 };
    }
    plumb_vec2 arm = arm_of(world, end->local, row);
    return (pl_joint_pose){ .x = (real)d.x,
                            .y = (real)d.y,
                            .angle = (angle - end->start) + TURN * (double)end->turns,
                            .c = world->bodies.c[row],
                            .s = world->bodies.s[row],
                            .rx = arm.x,
                            .ry = arm.y };
}

uint32_t pl_joint_eighth(const plumb_world *world, uint32_t row)
{
    real c = world->bodies.c[row], s = world->bodies.s[row];
    real along = s < 0 ? -c : c, across = s < 0 ? -s : s; // half a turn back into the upper half
    uint32_t eighth = along > 0 ? (across > along) : 2 + (across < -along);
    return s < 0 ? eighth : 4 + eighth;
}

// From the middle of the eighth in which it was last seen: whether somebody looks while it stays in there, as
// plans do differently after a restore, decides nothing. Returns the angle of the body now.
static double count_turns(const plumb_world *world, pl_joint_end *end, uint32_t row)
{
    if (row == PL_NONE) {
        return 0;
    }
    plumb_rot q = { world->bodies.c[row], world->bodies.s[row] };
    double from = ((double)end->eighth + 0.5) * (TURN / 8) - TURN / 2;
    double now = (double)plumb_rot_angle(q), jump = now - from;
    end->turns += jump > TURN / 2 ? -1 : jump < -TURN / 2 ? 1 : 0;
    end->eighth = pl_joint_eighth(world, row);
    return now;
}

// In a world that wraps around: how much nearer an image of an anchor is to a place.
static pl_shift shift_of(const plumb_world *world, const pl_joint_end *end, uint32_t row,
                         double to_x, double to_y)
{
    const spot center = center_of(world, end->local, row);
    plumb_vec2 arm = arm_of(world, end->local, row);
    return pl_wrap_shift(world, center.x + (double)arm.x - to_x, center.y + (double)arm.y - to_y);
}

// Takes B's anchor by the image that is nearest to A's; those of a pulley by what is nearest to their wheels.
static void place_images(const plumb_world *world, pl_joint *joint, uint32_t row_a, uint32_t row_b)
{
    spot from = center_of(world, joint->a.local, row_a),
         to = center_of(world, joint->b.local, row_b);
    const plumb_vec2 arm = arm_of(world, joint->a.local, row_a);
    pl_shift a = { 0, 0 }, b;
    if (joint->desc.kind == PLUMB_PULLEY) {
        const plumb_vec2 wheel_a = joint->desc.ground_a, wheel_b = joint->desc.ground_b;
        a = shift_of(world, &joint->a, row_a, (double)wheel_a.x, (double)wheel_a.y);
        b = shift_of(world, &joint->b, row_b, (double)wheel_b.x, (double)wheel_b.y);
        joint->origin = plumb_v2((real)(from.x + a.x), (real)(from.y + a.y));
    } else {
        b = shift_of(world, &joint->b, row_b, from.x + (double)arm.x, from.y + (double)arm.y);
    }
    from.x -= b.x / 2, from.y -= b.y / 2;
    to.x += b.x / 2, to.y += b.y / 2;
    const pl_shift d = way(&from, &to);
    joint->pose_b.x = (real)(d.x - a.x);
    joint->pose_b.y = (real)(d.y - a.y);
}

// How a body gives way at an anchor: inverse mass and inertia, and the arm from its centre [m], in its own frame.
typedef struct ease {
    double mass, inertia, x, y;
} ease;

static ease ease_at(const plumb_world *world, const pl_joint_end *end, uint32_t row)
{
    if (row == PL_NONE) {
        return (ease){ 0, 0, 0, 0 };
    }
    const pl_bodies *b = &world->bodies;
    return (ease){ (double)b->inv_mass[row], (double)b->inv_inertia[row],
                   (double)(end->local.x - b->local_x[row]),
                   (double)(end->local.y - b->local_y[row]) };
}

// What a push meets there depends on its direction.
static bool is_uneven(const ease *e)
{
    return (e->x * e->x + e->y * e->y) * e->inertia > 0;
}

// Inverse mass that a push along n meets; without a direction: the mean of all.
static double ease_along(const ease *e, plumb_vec2 n)
{
    const double lever = e->x * (double)n.y - e->y * (double)n.x;
    const double square = n.x != 0 || n.y != 0 ? lever * lever : (e->x * e->x + e->y * e->y) / 2;
    return e->mass + square * e->inertia;
}

real pl_joint_spring_mass(const plumb_world *world, const pl_joint *joint, uint32_t row_a,
                          uint32_t row_b)
{
    const plumb_joint_desc *d = &joint->desc;
    const bool may_turn =
        d->kind == PLUMB_DISTANCE || d->kind == PLUMB_WHEEL || d->kind == PLUMB_MOTOR;
    if (!(d->hertz > 0) || !may_turn ||
        (pl_joint_locks(world, row_a) | pl_joint_locks(world, row_b)) != 0) {
        return 0;
    }
    const ease a = ease_at(world, &joint->a, row_a), b = ease_at(world, &joint->b, row_b);
    if (!is_uneven(&b) &&
        (d->kind == PLUMB_WHEEL || !is_uneven(&a))) { // a wheel's line lies as it does on A
        return 0;
    }
    const plumb_rot to_b = plumb_rot_make((real)(joint->a.start - joint->b.start));
    const double sum =
        ease_along(&a, joint->axis) + ease_along(&b, plumb_rot_apply(to_b, joint->axis));
    return sum > 0 ? (real)(1 / sum) : 0;
}

void pl_joint_place(const plumb_world *world, pl_joint *joint, uint32_t row_a, uint32_t row_b)
{
    joint->spring_mass = pl_joint_spring_mass(world, joint, row_a, row_b);
    const double angle_a = count_turns(world, &joint->a, row_a);
    const double angle_b = count_turns(world, &joint->b, row_b);
    const spot origin = center_of(world, joint->a.local, row_a);
    joint->origin = plumb_v2((real)origin.x, (real)origin.y);
    joint->pose_a = pose_now(world, &joint->a, row_a, &origin, angle_a);
    joint->pose_b = pose_now(world, &joint->b, row_b, &origin, angle_b);
    if (pl_is_wrapped(world)) {
        place_images(world, joint, row_a, row_b);
    }
}

// Turns are told apart as long as a body does not pass three eighths of a turn in a step.
static void look_at_turns(const plumb_world *world, pl_joint_end *end, uint32_t row,
                          uint8_t *eighth)
{
    if (row != PL_NONE && pl_joint_eighth(world, row) != *eighth) {
        count_turns(world, end, row);
        *eighth = (uint8_t)end->eighth;
    }
}

void pl_joint_start_bare(const plumb_world *world, pl_joint_lane *lane, pl_joint_start *start,
                         real h)
{
    pl_joint *j = &pl_joint_items(&world->joints)[lane->joint];
    const pl_joint_mark *mark = &pl_joint_marks(&world->joints)[lane->joint];
    spot from = center_of(world, lane->local_a, mark->row_a);
    spot to = center_of(world, lane->local_b, mark->row_b);
    if (pl_is_wrapped(world)) {
        pl_joint_end a = { .local = lane->local_a }, b = { .local = lane->local_b };
        plumb_vec2 arm = arm_of(world, a.local, mark->row_a);
        pl_shift s =
            shift_of(world, &b, mark->row_b, from.x + (double)arm.x, from.y + (double)arm.y);
        from.x -= s.x / 2, from.y -= s.y / 2;
        to.x += s.x / 2, to.y += s.y / 2;
    }
    const pl_shift d = way(&from, &to);
    real scale = pl_joint_carried(j, h);
    const plumb_vec2 arm_a = arm_of(world, lane->local_a, mark->row_a);
    const plumb_vec2 arm_b = arm_of(world, lane->local_b, mark->row_b);
    *start = (pl_joint_start){ .arm_a = { (near_real)arm_a.x, (near_real)arm_a.y },
                               .arm_b = { (near_real)arm_b.x, (near_real)arm_b.y },
                               .apart = { (near_real)d.x, (near_real)d.y },
                               .impulse = { (near_real)(scale * j->impulse[0]),
                                            (near_real)(scale * j->impulse[1]) } };
    look_at_turns(world, &j->a, mark->row_a, &lane->eighth_a);
    look_at_turns(world, &j->b, mark->row_b, &lane->eighth_b);
}

void pl_joint_begin(const plumb_world *world, pl_joint *joint)
{
    pl_joint_place(world, joint, pl_joint_row(world, &joint->a), pl_joint_row(world, &joint->b));
}

void pl_joints_free(pl_memory *memory, pl_joints *joints)
{
    pl_buffer_free(memory, &joints->items);
    pl_buffer_free(memory, &joints->broken);
    pl_buffer_free(memory, &joints->awake);
    pl_joints_plan_free(memory, &joints->plan);
}

plumb_vec2 pl_joint_anchor(const plumb_world *world, const pl_joint_end *end)
{
    const uint32_t row = pl_joint_row(world, end);
    if (row == PL_NONE) {
        return end->local;
    }
    const pl_bodies *b = &world->bodies;
    const plumb_transform at = { plumb_v2(b->x[row], b->y[row]), { b->c[row], b->s[row] } };
    return plumb_transform_apply(at, end->local);
}
