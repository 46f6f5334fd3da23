// joint_set.c - what can be changed of a joint. Reads: arguments, checked first. Writes: its
// descriptor.
#include "world/joint_list.h"
#include "joints/joint.h"
#include "plumb/math.h"
#include "world/check.h"
#include "world/told.h"

// The live joint, whose kind has `needs` (called `what` in the message).
static plumb_result find(plumb_world *world, const char *fn, plumb_joint joint, unsigned needs,
                         const char *what, pl_joint **out)
{
    PL_TRY(pl_check_joint(world, fn, joint, out));
    const pl_joint_class *kind = pl_joint_classes[(*out)->desc.kind];
    if ((kind->has & needs) != needs) {
        return pl_fail(world, PLUMB_E_STATE, fn, "joint is a %s joint; it must be one with a %s",
                       kind->name, what);
    }
    return PLUMB_OK;
}

// Whether they differ in what the functions below set.
static bool differ(const plumb_joint_desc *a, const plumb_joint_desc *b)
{
    return a->enable_limit != b->enable_limit || a->lower != b->lower || a->upper != b->upper ||
           a->enable_motor != b->enable_motor || a->motor_speed != b->motor_speed ||
           a->max_motor != b->max_motor || a->hertz != b->hertz || a->damping != b->damping ||
           a->stiffness != b->stiffness || a->damper != b->damper || a->rest != b->rest ||
           a->length != b->length || a->restitution != b->restitution ||
           a->break_force != b->break_force || a->break_torque != b->break_torque ||
           a->break_impulse != b->break_impulse || a->event_force != b->event_force ||
           a->event_torque != b->event_torque;
}

// Another descriptor, with which the joint may be solved in another way. What is set to what it was wakes nobody.
static plumb_result revise(plumb_world *world, const char *fn, pl_joint *joint,
                           plumb_joint_desc wanted)
{
    pl_told(world, joint->entity.entity, fn);
    if (differ(&joint->desc, &wanted)) {
        pl_joint_disturb(world, joint);
    }
    if (pl_joint_variant(&joint->desc) != pl_joint_variant(&wanted) ||
        pl_joint_bounces(&joint->desc) != pl_joint_bounces(&wanted)) {
        pl_joints_replan(&world->joints);
    }
    world->joints.watched -= pl_joint_is_watched(&joint->desc);
    world->joints.bouncing -= pl_joint_bounces(&joint->desc);
    pl_joint_copy_desc(&joint->desc, &wanted);
    if (!pl_joint_is_watched(&wanted)) {
        joint->told_impulse = plumb_v2(0, 0);
        joint->told_turn = 0;
    }
    world->joints.watched += pl_joint_is_watched(&joint->desc);
    world->joints.bouncing += pl_joint_bounces(&joint->desc);
    world->schedule_dirty = true; // sums of reactions or blows at limits are wanted, or no more
    return PLUMB_OK;
}

plumb_result plumb_joint_set_limit(plumb_world *world, plumb_joint joint, bool enabled,
                                   plumb_real lower, plumb_real upper)
{
    pl_joint *j = NULL;
    PL_TRY(find(world, __func__, joint, PL_JOINT_LIMIT, "limit", &j));
    real least = j->desc.kind == PLUMB_DISTANCE ? 0 : -PLUMB_REAL_MAX;
    PL_TRY(pl_check_range(world, __func__, "lower", lower, least, PLUMB_REAL_MAX));
    PL_TRY(pl_check_range(world, __func__, "upper", upper, lower, PLUMB_REAL_MAX));
    plumb_joint_desc wanted = j->desc;
    wanted.enable_limit = enabled;
    wanted.lower = lower;
    wanted.upper = upper;
    return revise(world, __func__, j, wanted);
}

plumb_result plumb_joint_set_restitution(plumb_world *world, plumb_joint joint,
                                         plumb_real restitution)
{
    pl_joint *j = NULL;
    PL_TRY(find(world, __func__, joint, PL_JOINT_LIMIT, "limit", &j));
    PL_TRY(pl_check_range(world, __func__, "restitution", restitution, 0, 1));
    plumb_joint_desc wanted = j->desc;
    wanted.restitution = restitution;
    return revise(world, __func__, j, wanted);
}

plumb_result plumb_joint_set_motor(plumb_world *world, plumb_joint joint, bool enabled,
                                   plumb_real speed, plumb_real max_motor)
{
    pl_joint *j = NULL;
    PL_TRY(find(world, __func__, joint, PL_JOINT_MOTOR, "motor", &j));
    PL_TRY(pl_check_finite(world, __func__, "speed", speed));
    PL_TRY(pl_check_range(world, __func__, "max_motor", max_motor, 0, PLUMB_REAL_MAX));
    plumb_joint_desc wanted = j->desc;
    wanted.enable_motor = enabled;
    wanted.motor_speed = speed;
    wanted.max_motor = max_motor;
    pl_joint_warn_of_motor(world, __func__, &wanted);
    return revise(world, __func__, j, wanted);
}

// Where the spring is at rest: of a rod or spring between two points that is its length, of which 0 means as it is.
static plumb_result take_rest(const plumb_world *world, const char *fn, real rest,
                              plumb_joint_desc *wanted)
{
    const pl_joint_class *kind = pl_joint_classes[wanted->kind];
    PL_TRY(pl_check_finite(world, fn, "rest", rest));
    if ((kind->has & PL_JOINT_REST) != 0) {
        wanted->rest = rest;
    } else if ((kind->has & PL_JOINT_LENGTH) != 0) {
        PL_TRY(pl_check_range(world, fn, "rest", rest, 0, PLUMB_REAL_MAX));
        wanted->length = rest > 0 ? rest : wanted->length;
    } else if (rest != 0) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "rest is %g; it must be 0 for a %s joint",
                       (double)rest, kind->name);
    }
    return PLUMB_OK;
}

static plumb_result revise_spring(plumb_world *world, const char *fn, pl_joint *joint,
                                  plumb_joint_desc wanted)
{
    if (joint->desc.kind == PLUMB_MOUSE) {
        PL_TRY(pl_joint_classes[PLUMB_MOUSE]->check(world, fn, &wanted)); // resolves defaults
    }
    return revise(world, fn, joint, wanted);
}

plumb_result plumb_joint_set_spring(plumb_world *world, plumb_joint joint, plumb_real hertz,
                                    plumb_real damping, plumb_real rest)
{
    pl_joint *j = NULL;
    PL_TRY(find(world, __func__, joint, PL_JOINT_SPRING, "spring", &j));
    PL_TRY(pl_check_range(world, __func__, "hertz", hertz, 0, PLUMB_REAL_MAX));
    PL_TRY(pl_check_range(world, __func__, "damping", damping, 0, PLUMB_REAL_MAX));
    plumb_joint_desc wanted = j->desc;
    PL_TRY(take_rest(world, __func__, rest, &wanted));
    wanted.hertz = hertz;
    wanted.damping = damping;
    wanted.stiffness = wanted.damper = 0;
    return revise_spring(world, __func__, j, wanted);
}

plumb_result plumb_joint_set_stiffness(plumb_world *world, plumb_joint joint, plumb_real stiffness,
                                       plumb_real damper, plumb_real rest)
{
    pl_joint *j = NULL;
    PL_TRY(find(world, __func__, joint, PL_JOINT_SPRING, "spring", &j));
    PL_TRY(pl_check_range(world, __func__, "stiffness", stiffness, 0, PLUMB_REAL_MAX));
    PL_TRY(pl_check_range(world, __func__, "damper", damper, 0, PLUMB_REAL_MAX));
    plumb_joint_desc wanted = j->desc;
    PL_TRY(take_rest(world, __func__, rest, &wanted));
    wanted.hertz = wanted.damping = 0;
    wanted.stiffness = stiffness;
    wanted.damper = damper;
    return revise_spring(world, __func__, j, wanted);
}

plumb_result plumb_joint_set_target(plumb_world *world, plumb_joint joint, plumb_vec2 target)
{
    pl_joint *j = NULL;
    PL_TRY(find(world, __func__, joint, PL_JOINT_TARGET, "target", &j));
    PL_TRY(pl_check_finite_vec(world, __func__, "target", target));
    plumb_vec2 *kept = j->desc.kind == PLUMB_MOTOR ? &j->target : &j->a.local;
    if (kept == &j->a.local && !plumb_is_null(j->a.body)) {
        target = plumb_body_local_point(world, j->a.body, target);
    }
    if (kept->x != target.x || kept->y != target.y) {
        pl_joint_disturb(world, j);
    }
    *kept = target;
    pl_told(world, joint.entity, __func__);
    return PLUMB_OK;
}

// The joint, if force and torque can be bounds of its reaction.
static plumb_result find_bounded(plumb_world *world, const char *fn, plumb_joint joint,
                                 plumb_real force, plumb_real torque, pl_joint **j)
{
    PL_TRY(find(world, fn, joint, 0, "", j));
    PL_TRY(pl_check_range(world, fn, "force", force, 0, PLUMB_REAL_MAX));
    return pl_check_range(world, fn, "torque", torque, 0, PLUMB_REAL_MAX);
}

plumb_result plumb_joint_set_break(plumb_world *world, plumb_joint joint, plumb_real force,
                                   plumb_real torque)
{
    pl_joint *j = NULL;
    PL_TRY(find_bounded(world, __func__, joint, force, torque, &j));
    plumb_joint_desc wanted = j->desc;
    wanted.break_force = force;
    wanted.break_torque = torque;
    return revise(world, __func__, j, wanted);
}

plumb_result plumb_joint_set_event(plumb_world *world, plumb_joint joint, plumb_real force,
                                   plumb_real torque)
{
    pl_joint *j = NULL;
    PL_TRY(find_bounded(world, __func__, joint, force, torque, &j));
    plumb_joint_desc wanted = j->desc;
    wanted.event_force = force;
    wanted.event_torque = torque;
    return revise(world, __func__, j, wanted);
}

plumb_result plumb_joint_set_break_impulse(plumb_world *world, plumb_joint joint,
                                           plumb_real impulse)
{
    pl_joint *j = NULL;
    PL_TRY(find(world, __func__, joint, 0, "", &j));
    PL_TRY(pl_check_range(world, __func__, "impulse", impulse, 0, PLUMB_REAL_MAX));
    plumb_joint_desc wanted = j->desc;
    wanted.break_impulse = impulse;
    pl_joints_replan(&world->joints); // perhaps it is solved by itself from now on
    return revise(world, __func__, j, wanted);
}

plumb_result plumb_joint_set_tell_impulse(plumb_world *world, plumb_joint joint, bool tell)
{
    pl_joint *j = NULL;
    PL_TRY(find(world, __func__, joint, 0, "", &j));
    plumb_joint_desc wanted = j->desc;
    wanted.tell_impulse = tell;
    return revise(world, __func__, j, wanted);
}

plumb_result plumb_joint_set_enabled(plumb_world *world, plumb_joint joint, bool enabled)
{
    pl_joint *j = NULL;
    PL_TRY(find(world, __func__, joint, 0, "", &j));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (j->desc.disabled == enabled) {
        j->desc.disabled = !enabled;
        pl_joint_disturb(world, j);
        pl_joints_replan(&world->joints);
        if (!j->desc.collide_connected) {
            pl_rearranged(world);
        }
    }
    pl_told(world, joint.entity, __func__);
    return PLUMB_OK;
}

plumb_result plumb_joint_set_user_data(plumb_world *world, plumb_joint joint, void *user_data)
{
    pl_joint *j = NULL;
    PL_TRY(find(world, __func__, joint, 0, "", &j));
    j->desc.user_data = user_data;
    return PLUMB_OK;
}
