// joint.c - joints are made and destroyed: checks of the descriptor, its defaults, the links to the bodies.
//
// Reads: arguments, checked first. Writes: a joint, its links, room for its events. Cost: O(1).
#include "joints/joint.h"
#include "world/check.h"
#include "world/desc_list.h"
#include "world/destroy.h"
#include "world/joint_list.h"
#include "world/rows.h"
#include "world/told.h"
#include "world/wrap.h"

#include <string.h>

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
    PL_TRY(pl_check_desc(world, fn, "", PLUMB_TABLE_JOINT, d));
    return pl_check_range(world, fn, "upper", d->upper, d->lower, PLUMB_REAL_MAX);
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
        { "reference", d->reference != 0, PL_JOINT_REFERENCE },
        { "enable_limit", d->enable_limit, PL_JOINT_LIMIT },
        { "lower", d->lower != 0, PL_JOINT_LIMIT },
        { "upper", d->upper != 0, PL_JOINT_LIMIT },
        { "restitution", d->restitution != 0, PL_JOINT_LIMIT },
        { "enable_motor", d->enable_motor, PL_JOINT_MOTOR },
        { "motor_speed", d->motor_speed != 0, PL_JOINT_MOTOR },
        { "max_motor", d->max_motor != 0, PL_JOINT_MOTOR },
        { "hertz", d->hertz != 0, PL_JOINT_SPRING },
        { "damping", d->damping != 0, PL_JOINT_SPRING },
        { "stiffness", d->stiffness != 0, PL_JOINT_SPRING },
        { "damper", d->damper != 0, PL_JOINT_SPRING },
        { "rest", d->rest != 0, PL_JOINT_REST },
        { "length", d->length != 0, PL_JOINT_LENGTH },
        { "radius_a", d->radius_a != 0, PL_JOINT_RADII },
        { "radius_b", d->radius_b != 0, PL_JOINT_RADII },
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

// A spring is told in one way.
static plumb_result check_spring(const plumb_world *world, const char *fn,
                                 const plumb_joint_desc *d)
{
    if (pl_spring_is_in_newtons(d) && (d->hertz != 0 || d->damping != 0)) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "%s is set with %s; a spring has either hertz and damping, or stiffness and "
                       "damper",
                       d->stiffness != 0 ? "stiffness" : "damper",
                       d->hertz != 0 ? "hertz" : "damping");
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
    if (!d->enable_limit && (d->lower != 0 || d->upper != 0 || d->restitution != 0)) {
        pl_warn(world, "%s: %s is set without enable_limit; there is no limit", fn,
                d->lower != 0 || d->upper != 0 ? "lower or upper" : "restitution");
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
    PL_TRY(PL_CHECK_HAS(world, fn, "a joint", JOINTS, "joints"));
    if ((unsigned)d->kind >= (unsigned)pl_joint_class_count) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "kind is %d; it must be a plumb_joint_kind",
                       (int)d->kind);
    }
    PL_TRY(check_ends(world, fn, d));
    PL_TRY(check_numbers(world, fn, d));
    PL_TRY(check_members(world, fn, d));
    PL_TRY(check_spring(world, fn, d));
    const pl_joint_class *kind = pl_joint_classes[d->kind];
    return kind->check != NULL ? kind->check(world, fn, d) : PLUMB_OK;
}

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

void pl_joint_copy_desc(plumb_joint_desc *to, const plumb_joint_desc *from)
{
    PL_JOINT_DESC(PL_COPY_MEMBER)
}

// [m] where a joint holds a body: at the body's centre (that of the other one for the world) or at the anchor.
static plumb_vec2 place_of(const plumb_world *world, const plumb_joint_desc *d, plumb_body body,
                           plumb_body other, plumb_vec2 anchor)
{
    if ((pl_joint_classes[d->kind]->has & PL_JOINT_CENTRAL) == 0) {
        return anchor;
    }
    return plumb_body_center(world, plumb_is_null(body) ? other : body);
}

// Where the value is 0: a slider's line begins so far before B, a hinge has turned by so much.
static plumb_vec2 zero_of(const plumb_joint_desc *d, plumb_vec2 anchor)
{
    const bool slides = (pl_joint_classes[d->kind]->has & PL_JOINT_TRAVELS) != 0;
    return slides ? plumb_vec2_add_scaled(anchor, -d->reference, d->axis) : anchor;
}

static void turn_by_reference(pl_joint *j)
{
    if ((pl_joint_classes[j->desc.kind]->has & PL_JOINT_RADIANS) == 0) {
        return;
    }
    if (plumb_is_null(j->b.body)) {
        j->a.start += (double)j->desc.reference;
    } else {
        j->b.start -= (double)j->desc.reference;
    }
}

static plumb_joint insert(plumb_world *world, const plumb_joint_desc *d)
{
    const plumb_joint none = PLUMB_NULL_INIT;
    uint32_t slot = take_slot(&world->joints);
    pl_joint *j = &pl_joint_items(&world->joints)[slot];
    const pl_joint_class *kind = pl_joint_classes[d->kind];
    bool two = (kind->has & PL_JOINT_TWO_ANCHORS) != 0;
    memset(j, 0, sizeof *j); // padding, too: it is saved
    pl_joint_copy_desc(&j->desc, d);
    attach(world, slot, &j->a, d->body_a,
           zero_of(d, place_of(world, d, d->body_a, d->body_b, d->anchor)));
    attach(world, slot, &j->b, d->body_b,
           place_of(world, d, d->body_b, d->body_a, two ? d->anchor_b : d->anchor));
    turn_by_reference(j);
    const plumb_vec2 axis = kind->direction != NULL ? kind->direction(world, d) : d->axis;
    j->axis = plumb_is_null(d->body_a) ? axis : plumb_body_local_vector(world, d->body_a, axis);
    j->entity.entity = pl_entity_claim(world, none.entity, PLUMB_KIND_JOINT, slot);
    pl_joint_begin(world, j);
    if (kind->keep != NULL) {
        j->sum = kind->keep(j, &j->pose_a, &j->pose_b);
    }
    ++world->joints.live;
    pl_joint_disturb(world, j);
    world->joints.watched += pl_joint_is_watched(d);
    world->joints.bouncing += pl_joint_bounces(d);
    pl_joint_revise(world, j);
    pl_told(world, j->entity.entity, "plumb_joint_create");
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

plumb_result plumb_joint_destroy(plumb_world *world, plumb_joint joint)
{
    pl_joint *j;
    PL_TRY(pl_check_joint(world, __func__, joint, &j));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_destroy_entity(world, joint.entity);
    return PLUMB_OK;
}
