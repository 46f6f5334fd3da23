// joint.c - joints are made, checked, destroyed, and found.
//
// Joints lie in slots that stay for their life; each body has a list of its joints through them, so
// that neither rows that move nor other joints that go concern a joint. Reads: descriptor, bodies.
// Writes: joint slots, body lists. Cost: O(1); destruction O(joints of the two bodies).
#include "joints/joint.h"

#include "plumb/math.h"
#include "world/check.h"
#include "world/desc_list.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <string.h>

#define TURN 6.283185307179586476925

//---- lookup
//---------------------------------------------------------------------------------------

uint32_t pl_joint_slot(const plumb_world *world, plumb_joint joint)
{
    if (world == NULL) {
        return PL_NONE;
    }
    const pl_slot *slot = pl_registry_find(&world->registry, joint.entity);
    return slot != NULL && slot->kind == PLUMB_KIND_JOINT ? slot->row : PL_NONE;
}

uint32_t pl_joint_next(const pl_joint *joint, plumb_body body)
{
    return plumb_same(joint->a.body, body) ? joint->a.next : joint->b.next;
}

bool pl_joints_forbid(const plumb_world *world, uint32_t row, uint32_t other)
{
    const pl_joint *items = pl_joint_items(&world->joints);
    plumb_body body = world->bodies.entity[row], partner = world->bodies.entity[other];
    for (uint32_t i = world->bodies.first_joint[row]; i != PL_NONE;
         i = pl_joint_next(&items[i], body)) {
        if (!items[i].desc.collide_connected && !items[i].desc.disabled &&
            (plumb_same(items[i].a.body, partner) || plumb_same(items[i].b.body, partner))) {
            return true;
        }
    }
    return false;
}

bool pl_joints_part(const plumb_world *world, uint32_t row)
{
    const pl_joint *items = pl_joint_items(&world->joints);
    plumb_body body = world->bodies.entity[row];
    for (uint32_t i = world->bodies.first_joint[row]; i != PL_NONE;
         i = pl_joint_next(&items[i], body)) {
        if (!items[i].desc.collide_connected && !plumb_is_null(items[i].a.body) &&
            !plumb_is_null(items[i].b.body)) {
            return true;
        }
    }
    return false;
}

//---- sleep
//----------------------------------------------------------------------------------------

static uint32_t row_of(const plumb_world *world, const pl_joint_end *end)
{
    return plumb_is_null(end->body) ? PL_NONE : pl_body_row(world, end->body);
}

static bool is_awake(const plumb_world *world, const pl_joint *joint)
{
    return !plumb_is_null(joint->entity) && !pl_row_is_asleep(world, row_of(world, &joint->a)) &&
           !pl_row_is_asleep(world, row_of(world, &joint->b));
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

// A joint made awake between a body that is and one that sleeps wakes it, even a furnished one.
void pl_joint_disturb(plumb_world *world, const pl_joint *joint)
{
    uint32_t a = row_of(world, &joint->a), b = row_of(world, &joint->b);
    bool mixed =
        a != PL_NONE && b != PL_NONE && (a < world->dynamic_count) != (b < world->dynamic_count);
    const uint32_t rows[2] = { a, b };
    for (int i = 0; i < 2; ++i) {
        if (rows[i] != PL_NONE && mixed && pl_row_is_asleep(world, rows[i])) {
            pl_sleep_stir(world, rows[i]);
        } else if (rows[i] != PL_NONE) {
            pl_sleep_disturb(world, rows[i]);
        }
    }
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

void pl_joint_place(const plumb_world *world, pl_joint *joint, uint32_t row_a, uint32_t row_b)
{
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
    real scale = j->h > 0 ? h / j->h : 0;
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
    pl_joint_place(world, joint, row_of(world, &joint->a), row_of(world, &joint->b));
}

//---- checks
//---------------------------------------------------------------------------------------

static plumb_result check_ends(const plumb_world *world, const char *fn, const plumb_joint_desc *d)
{
    const struct {
        const char *name;
        plumb_body body;
    } ends[] = { { "body_a", d->body_a }, { "body_b", d->body_b } };
    for (int i = 0; i < 2; ++i) {
        if (!plumb_is_null(ends[i].body) && pl_body_row(world, ends[i].body) == PL_NONE) {
            return pl_fail_handle(world, fn, ends[i].name, ends[i].body.entity,
                                  "a live body or null");
        }
    }
    if (plumb_same(d->body_a, d->body_b)) {
        return pl_fail(world, PLUMB_E_HANDLE, fn, "body_b is %s; it must be another",
                       plumb_is_null(d->body_b) ? "null as body_a is" : "body_a");
    }
    return PLUMB_OK;
}

static plumb_result check_numbers(const plumb_world *world, const char *fn,
                                  const plumb_joint_desc *d)
{
    plumb_result r = pl_check_desc(world, fn, "", PLUMB_TABLE_JOINT, d);
    return r != PLUMB_OK ? r
                         : pl_check_range(world, fn, "upper", d->upper, d->lower, PLUMB_REAL_MAX);
}

static bool is_set(plumb_vec2 v)
{
    return v.x != 0 || v.y != 0;
}

// What a kind does not have would be left out in silence: it is refused.
static plumb_result check_members(const plumb_world *world, const char *fn,
                                  const plumb_joint_desc *d)
{
    const pl_joint_class *kind = pl_joint_classes[d->kind];
    const struct {
        const char *name;
        bool used;
        unsigned needs;
    } members[] = {
        { "anchor_b", is_set(d->anchor_b), PL_JOINT_TWO_ANCHORS },
        { "ground_a", is_set(d->ground_a), PL_JOINT_GROUNDS },
        { "ground_b", is_set(d->ground_b), PL_JOINT_GROUNDS },
        { "axis", is_set(d->axis), PL_JOINT_AXIS },
        { "enable_limit", d->enable_limit, PL_JOINT_LIMIT },
        { "lower", d->lower != 0, PL_JOINT_LIMIT },
        { "upper", d->upper != 0, PL_JOINT_LIMIT },
        { "enable_motor", d->enable_motor, PL_JOINT_MOTOR },
        { "motor_speed", d->motor_speed != 0, PL_JOINT_MOTOR },
        { "max_motor", d->max_motor != 0, PL_JOINT_MOTOR },
        { "hertz", d->hertz != 0, PL_JOINT_SPRING },
        { "damping", d->damping != 0, PL_JOINT_SPRING },
        { "rest", d->rest != 0, PL_JOINT_REST },
        { "length", d->length != 0, PL_JOINT_LENGTH },
        { "ratio", d->ratio != 0, PL_JOINT_RATIO },
        { "pitch", d->pitch != 0, PL_JOINT_PITCH },
        { "max_force", d->max_force != 0, PL_JOINT_FORCE },
        { "max_torque", d->max_torque != 0, PL_JOINT_TORQUE },
    };
    for (size_t i = 0; i < sizeof members / sizeof members[0]; ++i) {
        if (members[i].used && (kind->has & members[i].needs) == 0) {
            return pl_fail(world, PLUMB_E_RANGE, fn, "%s is set; it must be 0 for a %s joint",
                           members[i].name, kind->name);
        }
    }
    return PLUMB_OK;
}

void pl_joint_warn_of_motor(const plumb_world *world, const char *fn, const plumb_joint_desc *d)
{
    if (d->enable_motor && d->max_motor == 0) {
        pl_warn(world, "%s: max_motor is 0; the motor does nothing", fn);
    }
}

// Members that do nothing as the others are: allowed, as they may be switched on later, but seldom meant.
static void warn_of_idle(const plumb_world *world, const char *fn, const plumb_joint_desc *d)
{
    if (!d->enable_limit && (d->lower != 0 || d->upper != 0)) {
        pl_warn(world, "%s: lower or upper is set without enable_limit; there is no limit", fn);
    }
    if (!d->enable_motor && (d->motor_speed != 0 || d->max_motor != 0)) {
        pl_warn(world,
                "%s: motor_speed or max_motor is set without enable_motor; there is no motor", fn);
    }
    pl_joint_warn_of_motor(world, fn, d);
}

// Checks a descriptor and resolves its defaults in place.
static plumb_result check_desc(const plumb_world *world, const char *fn, plumb_joint_desc *d)
{
    if ((unsigned)d->kind >= (unsigned)pl_joint_class_count) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "kind is %d; it must be a plumb_joint_kind",
                       (int)d->kind);
    }
    plumb_result r = check_ends(world, fn, d);
    r = r != PLUMB_OK ? r : check_numbers(world, fn, d);
    r = r != PLUMB_OK ? r : check_members(world, fn, d);
    const pl_joint_class *kind = pl_joint_classes[d->kind];
    return r == PLUMB_OK && kind->check != NULL ? kind->check(world, fn, d) : r;
}

//---- create, destroy
//------------------------------------------------------------------------------

static bool reserve(plumb_world *world)
{
    pl_joints *joints = &world->joints;
    size_t slots = (size_t)joints->count + 1;
    return pl_registry_reserve(&world->memory, &world->registry, 1) &&
           pl_buffer_reserve(&world->memory, &joints->items, slots * sizeof(pl_joint)) &&
           pl_buffer_reserve(&world->memory, &joints->awake, slots * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &joints->broken, slots * sizeof(plumb_joint_break));
}

// Room must be reserved.
static uint32_t take_slot(pl_joints *joints)
{
    uint32_t slot = joints->free_head;
    if (slot == PL_NONE) {
        return joints->count++;
    }
    joints->free_head = pl_joint_items(joints)[slot].a.next;
    return slot;
}

static void attach(plumb_world *world, uint32_t slot, pl_joint_end *end, plumb_body body,
                   plumb_vec2 anchor)
{
    end->body = body; // of a joint that is all 0
    end->local = anchor;
    end->next = PL_NONE;
    if (plumb_is_null(body)) {
        return;
    }
    uint32_t row = pl_body_row(world, body);
    end->local = plumb_body_local_point(world, body, anchor);
    end->start = (double)plumb_body_angle(world, body);
    end->eighth = pl_joint_eighth(world, row);
    end->next = world->bodies.first_joint[row];
    world->bodies.first_joint[row] = slot;
}

// Pairs of the two bodies come or go with the joint.
static void revise_pairs(plumb_world *world, const pl_joint *joint)
{
    if (!joint->desc.collide_connected && !plumb_is_null(joint->a.body) &&
        !plumb_is_null(joint->b.body)) {
        pl_rearranged(world);
        pl_internal_edges_touch_static(world, pl_body_row(world, joint->a.body));
        pl_internal_edges_touch_static(world, pl_body_row(world, joint->b.body));
    }
    world->joints.awake_stale = true;
    world->schedule_dirty = true;
    pl_joints_replan(&world->joints);
}

void pl_joint_copy_desc(plumb_joint_desc *to, const plumb_joint_desc *from)
{
    PL_JOINT_DESC(PL_COPY_MEMBER)
}

static plumb_joint insert(plumb_world *world, const plumb_joint_desc *d)
{
    const plumb_joint none = PLUMB_NULL_INIT;
    uint32_t slot = take_slot(&world->joints);
    pl_joint *j = &pl_joint_items(&world->joints)[slot];
    bool two = (pl_joint_classes[d->kind]->has & PL_JOINT_TWO_ANCHORS) != 0;
    memset(j, 0, sizeof *j); // padding, too: it is saved
    pl_joint_copy_desc(&j->desc, d);
    attach(world, slot, &j->a, d->body_a, d->anchor);
    attach(world, slot, &j->b, d->body_b, two ? d->anchor_b : d->anchor);
    j->axis =
        plumb_is_null(d->body_a) ? d->axis : plumb_body_local_vector(world, d->body_a, d->axis);
    j->entity.entity = pl_entity_claim(world, none.entity, PLUMB_KIND_JOINT, slot);
    pl_joint_begin(world, j);
    if (pl_joint_classes[d->kind]->keep != NULL) {
        j->sum = pl_joint_classes[d->kind]->keep(j, &j->pose_a, &j->pose_b);
    }
    ++world->joints.live;
    pl_joint_disturb(world, j);
    world->joints.watched += pl_joint_is_watched(d);
    revise_pairs(world, j);
    return j->entity;
}

plumb_joint plumb_joint_create(plumb_world *world, const plumb_joint_desc *desc)
{
    plumb_joint joint = PLUMB_NULL_INIT;
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        pl_check_pointer(world, __func__, "desc", desc) != PLUMB_OK) {
        return joint;
    }
    plumb_joint_desc resolved = *desc;
    if (check_desc(world, __func__, &resolved) != PLUMB_OK) {
        return joint;
    }
    if (!reserve(world)) {
        pl_fail_memory(world, __func__);
        return joint;
    }
    warn_of_idle(world, __func__, desc);
    return insert(world, &resolved);
}

static void detach(plumb_world *world, uint32_t slot, const pl_joint_end *end)
{
    if (plumb_is_null(end->body)) {
        return;
    }
    pl_joint *items = pl_joint_items(&world->joints);
    uint32_t *link = &world->bodies.first_joint[pl_body_row(world, end->body)];
    while (*link != slot) {
        pl_joint *j = &items[*link];
        link = plumb_same(j->a.body, end->body) ? &j->a.next : &j->b.next;
    }
    *link = end->next;
}

void pl_joint_remove(plumb_world *world, uint32_t slot)
{
    pl_joint *j = &pl_joint_items(&world->joints)[slot];
    detach(world, slot, &j->a);
    detach(world, slot, &j->b);
    pl_joint_disturb(world, j);
    revise_pairs(world, j);
    pl_registry_release(&world->registry, j->entity.entity);
    world->joints.watched -= pl_joint_is_watched(&j->desc);
    memset(j, 0, sizeof *j);
    j->a.next = world->joints.free_head;
    world->joints.free_head = slot;
    --world->joints.live;
}

plumb_result plumb_joint_destroy(plumb_world *world, plumb_joint joint)
{
    if (world == NULL) {
        return PLUMB_E_NULL;
    }
    if (pl_joint_slot(world, joint) == PL_NONE) {
        return pl_fail_handle(world, __func__, "joint", joint.entity, "a live joint");
    }
    plumb_result r = pl_check_unlocked(world, __func__);
    if (r == PLUMB_OK) {
        pl_destroy_entity(world, joint.entity);
    }
    return r;
}

void pl_joints_free(pl_memory *memory, pl_joints *joints)
{
    pl_buffer_free(memory, &joints->items);
    pl_buffer_free(memory, &joints->broken);
    pl_buffer_free(memory, &joints->awake);
    pl_joints_plan_free(memory, &joints->plan);
}
