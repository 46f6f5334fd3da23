// joints.c - joints of all worlds gathered into one array, their motors set from one.
//
// Reads, writes: joints. Cost: O(worlds x joints x fields), shared among the workers.
#include "batch/batch.h"
#include "plumb/joint.h"
#include "world/check.h"

#define JOINTS_MOST (1u << 20)
#define FIELDS_MOST 64u
#define FIRST_WRITE PLUMB_JOINT_FIELD_MOTOR_SPEED
#define FIELD_COUNT (PLUMB_JOINT_FIELD_REST + 1)

typedef struct joint_window {
    const char *function;
    plumb_batch_joint_view view;
    plumb_real *out;      // observe
    const plumb_real *in; // drive
} joint_window;

static size_t first_number(const joint_window *w, uint32_t index)
{
    return (size_t)index * w->view.joint_count * w->view.field_count;
}

static plumb_result check_fields(plumb_batch *batch, const char *fn,
                                 const plumb_batch_joint_view *view, bool writes)
{
    uint32_t seen = 0;
    for (uint32_t i = 0; i < view->field_count; ++i) {
        const unsigned f = (unsigned)view->fields[i];
        if (f >= FIELD_COUNT || (writes && f < FIRST_WRITE)) {
            return pl_batch_fail(batch, PLUMB_E_RANGE, fn,
                                 "fields[%u] is %u; it must be a field that can be %s", (unsigned)i,
                                 f, writes ? "written" : "read");
        }
        if (writes && (seen >> f & 1u) != 0) {
            return pl_batch_fail(batch, PLUMB_E_DUPLICATE, fn,
                                 "fields[%u] is %u for the second time", (unsigned)i, f);
        }
        seen |= 1u << f;
    }
    return PLUMB_OK;
}

static plumb_result check_view(plumb_batch *batch, const char *fn,
                               const plumb_batch_joint_view *view, const plumb_real *numbers,
                               size_t capacity, bool writes)
{
    if (view == NULL || numbers == NULL) {
        return pl_batch_fail(batch, PLUMB_E_NULL, fn, "%s is null; it must be given",
                             view == NULL ? "view" : "numbers");
    }
    if (view->joint_count > JOINTS_MOST) {
        return pl_batch_fail(batch, PLUMB_E_RANGE, fn, "view.joint_count is %u; it must be 0 to %u",
                             (unsigned)view->joint_count, JOINTS_MOST);
    }
    if (view->field_count > FIELDS_MOST) {
        return pl_batch_fail(batch, PLUMB_E_RANGE, fn, "view.field_count is %u; it must be 0 to %u",
                             (unsigned)view->field_count, FIELDS_MOST);
    }
    if ((view->joint_count > 0 && view->joints == NULL) ||
        (view->field_count > 0 && view->fields == NULL)) {
        return pl_batch_fail(batch, PLUMB_E_NULL, fn, "view.%s is null; it must be given",
                             view->joint_count > 0 && view->joints == NULL ? "joints" : "fields");
    }
    const size_t needed = (size_t)plumb_batch_count(batch) * view->joint_count * view->field_count;
    if (capacity < needed) {
        return pl_batch_fail(batch, PLUMB_E_RANGE, fn, "capacity is %zu; it must be at least %zu",
                             capacity, needed);
    }
    return check_fields(batch, fn, view, writes);
}

static plumb_result check_joint(const plumb_world *world, const char *fn, plumb_joint joint)
{
    return plumb_joint_valid(world, joint)
               ? PLUMB_OK
               : pl_fail_handle(world, fn, "joint", joint.entity, "a live joint");
}

static plumb_real read_field(const plumb_world *world, plumb_joint joint,
                             const plumb_joint_desc *now, plumb_batch_joint_field field)
{
    switch (field) {
    case PLUMB_JOINT_FIELD_VALUE:
        return plumb_joint_value(world, joint);
    case PLUMB_JOINT_FIELD_RATE:
        return plumb_joint_rate(world, joint);
    case PLUMB_JOINT_FIELD_FORCE_X:
        return plumb_joint_force(world, joint).x;
    case PLUMB_JOINT_FIELD_FORCE_Y:
        return plumb_joint_force(world, joint).y;
    case PLUMB_JOINT_FIELD_TORQUE:
        return plumb_joint_torque(world, joint);
    case PLUMB_JOINT_FIELD_MOTOR_SPEED:
        return now->motor_speed;
    case PLUMB_JOINT_FIELD_MAX_MOTOR:
        return now->max_motor;
    default: // PLUMB_JOINT_FIELD_REST
        return now->kind == PLUMB_DISTANCE ? now->length : now->rest;
    }
}

static plumb_result observe_one(const void *of, plumb_batch *batch, uint32_t index)
{
    const joint_window *w = of;
    const plumb_world *world = batch->items[index].world;
    plumb_real *out = w->out + first_number(w, index);
    plumb_result r = PLUMB_OK;
    for (uint32_t j = 0; j < w->view.joint_count; ++j) {
        const plumb_joint joint = w->view.joints[j];
        plumb_joint_desc now = { .kind = PLUMB_REVOLUTE };
        const bool is_there = check_joint(world, w->function, joint) == PLUMB_OK &&
                              plumb_joint_settings(world, joint, &now) == PLUMB_OK;
        r = is_there ? r : PLUMB_E_HANDLE;
        for (uint32_t f = 0; f < w->view.field_count; ++f) {
            *out++ = is_there ? read_field(world, joint, &now, w->view.fields[f]) : 0;
        }
    }
    return r;
}

plumb_result plumb_batch_observe_joints(plumb_batch *batch, const plumb_batch_joint_view *view,
                                        plumb_real *numbers, size_t capacity)
{
    if (batch == NULL) {
        return PLUMB_E_NULL;
    }
    PL_TRY(check_view(batch, __func__, view, numbers, capacity, false));
    const joint_window w = { .function = __func__, .view = *view, .out = numbers };
    return pl_batch_for(batch, observe_one, &w, NULL, plumb_batch_count(batch));
}

static plumb_result write_joint(plumb_world *world, plumb_joint joint,
                                const plumb_batch_joint_view *view, const plumb_real *in)
{
    plumb_joint_desc now;
    PL_TRY(plumb_joint_settings(world, joint, &now));
    bool motor = false, spring = false;
    for (uint32_t f = 0; f < view->field_count; ++f) {
        motor |= view->fields[f] != PLUMB_JOINT_FIELD_REST;
        spring |= view->fields[f] == PLUMB_JOINT_FIELD_REST;
        *(view->fields[f] == PLUMB_JOINT_FIELD_MOTOR_SPEED ? &now.motor_speed
          : view->fields[f] == PLUMB_JOINT_FIELD_MAX_MOTOR ? &now.max_motor
                                                           : &now.rest) = in[f];
    }
    if (motor) {
        PL_TRY(plumb_joint_set_motor(world, joint, true, now.motor_speed, now.max_motor));
    }
    if (!spring) {
        return PLUMB_OK;
    }
    return now.stiffness > 0 || now.damper > 0
               ? plumb_joint_set_stiffness(world, joint, now.stiffness, now.damper, now.rest)
               : plumb_joint_set_spring(world, joint, now.hertz, now.damping, now.rest);
}

static plumb_result drive_one(const void *of, plumb_batch *batch, uint32_t index)
{
    const joint_window *w = of;
    plumb_world *world = batch->items[index].world;
    const plumb_real *in = w->in + first_number(w, index);
    for (uint32_t j = 0; j < w->view.joint_count; ++j) {
        PL_TRY(check_joint(world, w->function, w->view.joints[j]));
        PL_TRY(write_joint(world, w->view.joints[j], &w->view, in));
        in += w->view.field_count;
    }
    return PLUMB_OK;
}

plumb_result plumb_batch_drive_joints(plumb_batch *batch, const plumb_batch_joint_view *view,
                                      const plumb_real *numbers, size_t capacity)
{
    if (batch == NULL) {
        return PLUMB_E_NULL;
    }
    PL_TRY(check_view(batch, __func__, view, numbers, capacity, true));
    const joint_window w = { .function = __func__, .view = *view, .in = numbers };
    return pl_batch_for(batch, drive_one, &w, NULL, plumb_batch_count(batch));
}
