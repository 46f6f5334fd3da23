// joint_set.c - what can be changed of a joint. Reads: arguments, checked first. Writes: its
// descriptor.
#include "world/joint_list.h"
#include "joints/joint.h"
#include "plumb/math.h"
#include "world/check.h"
#include "world/state.h"

// The live joint, whose kind has `needs` (called `what` in the message).
static plumb_result find(plumb_world *world, const char *fn, plumb_joint joint, unsigned needs,
                         const char *what, pl_joint **out)
{
    if (world == NULL) {
        return PLUMB_E_NULL;
    }
    uint32_t slot = pl_joint_slot(world, joint);
    if (slot == PL_NONE) {
        return pl_fail_handle(world, fn, "joint", joint.entity, "a live joint");
    }
    *out = &pl_joint_items(&world->joints)[slot];
    const pl_joint_class *kind = pl_joint_classes[(*out)->desc.kind];
    if ((kind->has & needs) != needs) {
        return pl_fail(world, PLUMB_E_STATE, fn, "joint is a %s joint; it must be one with a %s",
                       kind->name, what);
    }
    return PLUMB_OK;
}

// What is set to what it was wakes nobody.
static void disturb_if(plumb_world *world, const pl_joint *joint, bool changed)
{
    if (changed) {
        pl_joint_disturb(world, joint);
    }
}

// Another descriptor, with which the joint may be solved in another way.
static void revise(plumb_world *world, pl_joint *joint, plumb_joint_desc wanted)
{
    if (pl_joint_variant(&joint->desc) != pl_joint_variant(&wanted)) {
        pl_joints_replan(&world->joints);
    }
    world->joints.watched -= pl_joint_is_watched(&joint->desc);
    pl_joint_copy_desc(&joint->desc, &wanted);
    world->joints.watched += pl_joint_is_watched(&joint->desc);
    world->schedule_dirty = true; // sums of reactions are wanted, or no more
}

plumb_result plumb_joint_set_limit(plumb_world *world, plumb_joint joint, bool enabled,
                                   plumb_real lower, plumb_real upper)
{
    pl_joint *j = NULL;
    plumb_result r = find(world, __func__, joint, PL_JOINT_LIMIT, "limit", &j);
    if (r != PLUMB_OK) {
        return r;
    }
    real least = j->desc.kind == PLUMB_DISTANCE ? 0 : -PLUMB_REAL_MAX;
    r = pl_check_range(world, __func__, "lower", lower, least, PLUMB_REAL_MAX);
    r = r != PLUMB_OK ? r : pl_check_range(world, __func__, "upper", upper, lower, PLUMB_REAL_MAX);
    if (r == PLUMB_OK) {
        plumb_joint_desc wanted = j->desc;
        wanted.enable_limit = enabled;
        wanted.lower = lower;
        wanted.upper = upper;
        disturb_if(world, j,
                   j->desc.enable_limit != enabled || j->desc.lower != lower ||
                       j->desc.upper != upper);
        revise(world, j, wanted);
    }
    return r;
}

plumb_result plumb_joint_set_motor(plumb_world *world, plumb_joint joint, bool enabled,
                                   plumb_real speed, plumb_real max_motor)
{
    pl_joint *j = NULL;
    plumb_result r = find(world, __func__, joint, PL_JOINT_MOTOR, "motor", &j);
    r = r != PLUMB_OK ? r : pl_check_finite(world, __func__, "speed", speed);
    r = r != PLUMB_OK ? r
                      : pl_check_range(world, __func__, "max_motor", max_motor, 0, PLUMB_REAL_MAX);
    if (r == PLUMB_OK) {
        plumb_joint_desc wanted = j->desc;
        wanted.enable_motor = enabled;
        wanted.motor_speed = speed;
        wanted.max_motor = max_motor;
        pl_joint_warn_of_motor(world, __func__, &wanted);
        disturb_if(world, j,
                   j->desc.enable_motor != enabled || j->desc.motor_speed != speed ||
                       j->desc.max_motor != max_motor);
        revise(world, j, wanted);
    }
    return r;
}

plumb_result plumb_joint_set_spring(plumb_world *world, plumb_joint joint, plumb_real hertz,
                                    plumb_real damping, plumb_real rest)
{
    pl_joint *j = NULL;
    plumb_result r = find(world, __func__, joint, PL_JOINT_SPRING, "spring", &j);
    r = r != PLUMB_OK ? r : pl_check_range(world, __func__, "hertz", hertz, 0, PLUMB_REAL_MAX);
    r = r != PLUMB_OK ? r : pl_check_range(world, __func__, "damping", damping, 0, PLUMB_REAL_MAX);
    r = r != PLUMB_OK ? r : pl_check_finite(world, __func__, "rest", rest);
    if (r != PLUMB_OK) {
        return r;
    }
    plumb_joint_desc wanted = j->desc;
    wanted.hertz = hertz;
    wanted.damping = damping;
    wanted.rest = rest;
    if (j->desc.kind == PLUMB_MOUSE) {
        r = pl_joint_classes[PLUMB_MOUSE]->check(world, __func__, &wanted); // resolves defaults
    }
    disturb_if(world, j,
               j->desc.hertz != wanted.hertz || j->desc.damping != wanted.damping ||
                   j->desc.rest != wanted.rest);
    revise(world, j, wanted);
    return r;
}

plumb_result plumb_joint_set_target(plumb_world *world, plumb_joint joint, plumb_vec2 target)
{
    pl_joint *j = NULL;
    plumb_result r = find(world, __func__, joint, PL_JOINT_TARGET, "target", &j);
    r = r != PLUMB_OK ? r : pl_check_finite_vec(world, __func__, "target", target);
    if (r != PLUMB_OK) {
        return r;
    }
    plumb_vec2 *kept = j->desc.kind == PLUMB_MOTOR ? &j->target : &j->a.local;
    if (kept == &j->a.local && !plumb_is_null(j->a.body)) {
        target = plumb_body_local_point(world, j->a.body, target);
    }
    disturb_if(world, j, kept->x != target.x || kept->y != target.y);
    *kept = target;
    return PLUMB_OK;
}

// The joint, if force and torque can be bounds of its reaction.
static plumb_result find_bounded(plumb_world *world, const char *fn, plumb_joint joint,
                                 plumb_real force, plumb_real torque, pl_joint **j)
{
    plumb_result r = find(world, fn, joint, 0, "", j);
    r = r != PLUMB_OK ? r : pl_check_range(world, fn, "force", force, 0, PLUMB_REAL_MAX);
    return r != PLUMB_OK ? r : pl_check_range(world, fn, "torque", torque, 0, PLUMB_REAL_MAX);
}

plumb_result plumb_joint_set_break(plumb_world *world, plumb_joint joint, plumb_real force,
                                   plumb_real torque)
{
    pl_joint *j = NULL;
    plumb_result r = find_bounded(world, __func__, joint, force, torque, &j);
    if (r == PLUMB_OK) {
        plumb_joint_desc wanted = j->desc;
        wanted.break_force = force;
        wanted.break_torque = torque;
        disturb_if(world, j, j->desc.break_force != force || j->desc.break_torque != torque);
        revise(world, j, wanted);
    }
    return r;
}

plumb_result plumb_joint_set_event(plumb_world *world, plumb_joint joint, plumb_real force,
                                   plumb_real torque)
{
    pl_joint *j = NULL;
    plumb_result r = find_bounded(world, __func__, joint, force, torque, &j);
    if (r == PLUMB_OK) {
        plumb_joint_desc wanted = j->desc;
        wanted.event_force = force;
        wanted.event_torque = torque;
        disturb_if(world, j, j->desc.event_force != force || j->desc.event_torque != torque);
        revise(world, j, wanted);
    }
    return r;
}

plumb_result plumb_joint_set_break_impulse(plumb_world *world, plumb_joint joint,
                                           plumb_real impulse)
{
    pl_joint *j = NULL;
    plumb_result r = find(world, __func__, joint, 0, "", &j);
    r = r != PLUMB_OK ? r : pl_check_range(world, __func__, "impulse", impulse, 0, PLUMB_REAL_MAX);
    if (r == PLUMB_OK) {
        plumb_joint_desc wanted = j->desc;
        wanted.break_impulse = impulse;
        disturb_if(world, j, j->desc.break_impulse != impulse);
        revise(world, j, wanted);
        pl_joints_replan(&world->joints); // perhaps it is solved by itself from now on
    }
    return r;
}

plumb_result plumb_joint_set_enabled(plumb_world *world, plumb_joint joint, bool enabled)
{
    pl_joint *j = NULL;
    plumb_result r = find(world, __func__, joint, 0, "", &j);
    r = r != PLUMB_OK ? r : pl_check_unlocked(world, __func__);
    if (r == PLUMB_OK && j->desc.disabled == enabled) {
        j->desc.disabled = !enabled;
        pl_joint_disturb(world, j);
        pl_joints_replan(&world->joints);
        if (!j->desc.collide_connected) {
            pl_rearranged(world);
        }
    }
    return r;
}

plumb_result plumb_joint_set_user_data(plumb_world *world, plumb_joint joint, void *user_data)
{
    pl_joint *j = NULL;
    plumb_result r = find(world, __func__, joint, 0, "", &j);
    if (r == PLUMB_OK) {
        j->desc.user_data = user_data;
    }
    return r;
}
