// run.c - what a batch does to its worlds: step, reset, gather and scatter.
//
// Reads and writes: the worlds, through their public functions; the user's array. Each world writes to
// a part of its own. Cost: that of the worlds; of observe and act O(numbers).
#include "batch/batch.h"
#include "plumb/body.h"
#include "plumb/math.h"
#include "plumb/snapshot.h"
#include "world/check.h"

#define STEPS_MOST      1000000
#define BODIES_MOST     (1u << 20)
#define FIELDS_MOST     64
#define FIELD_COUNT     (PLUMB_FIELD_TORQUE + 1)
#define FIELDS_READ     PLUMB_FIELD_FORCE_X // so many can be read: those before it
#define IS_SET(mask, f) (((mask) >> (f)&1u) != 0)

//---- step ----------------------------------------------------------------------------------------

typedef struct stepping {
    plumb_real dt;
    int steps;
} stepping;

static plumb_result step_one(const void *of, plumb_batch *batch, uint32_t index)
{
    const stepping *s = of;
    for (int i = 0; i < s->steps; ++i) {
        PL_TRY(plumb_world_step(batch->items[index].world, s->dt));
    }
    return PLUMB_OK;
}

plumb_result plumb_batch_step(plumb_batch *batch, plumb_real dt, int steps)
{
    if (batch == NULL) {
        return PLUMB_E_NULL;
    }
    if (!plumb_is_finite(dt)) {
        return pl_batch_fail(batch, PLUMB_E_NOT_FINITE, __func__, "dt is not finite");
    }
    if (!(dt > 0 && dt <= 1)) {
        return pl_batch_fail(batch, PLUMB_E_RANGE, __func__,
                             "dt is %g; it must be above 0 and at most 1", (double)dt);
    }
    if (steps < 0 || steps > STEPS_MOST) {
        return pl_batch_fail(batch, PLUMB_E_RANGE, __func__, "steps is %d; it must be 0 to %d",
                             steps, STEPS_MOST);
    }
    const stepping s = { dt, steps };
    return pl_batch_for(batch, step_one, &s, NULL, batch->desc.count);
}

//---- reset ---------------------------------------------------------------------------------------

static plumb_result reset_one(const void *of, plumb_batch *batch, uint32_t index)
{
    (void)of;
    pl_batch_item *item = &batch->items[index];
    PL_TRY(plumb_world_restore(item->world, item->image.bytes, item->image.size));
    ++item->episode;
    return pl_batch_vary(batch, batch->desc.randomise, index);
}

plumb_result plumb_batch_reset(plumb_batch *batch, const uint32_t *worlds, uint32_t count)
{
    if (batch == NULL) {
        return PLUMB_E_NULL;
    }
    uint32_t call = ++batch->calls;
    for (uint32_t i = 0; worlds != NULL && i < count; ++i) {
        if (worlds[i] >= batch->desc.count) {
            return pl_batch_fail(batch, PLUMB_E_RANGE, __func__,
                                 "worlds[%u] is %u; it must be below %u", (unsigned)i,
                                 (unsigned)worlds[i], (unsigned)batch->desc.count);
        }
        pl_batch_item *item = &batch->items[worlds[i]];
        if (item->called == call) {
            return pl_batch_fail(batch, PLUMB_E_DUPLICATE, __func__,
                                 "worlds[%u] is %u for the second time", (unsigned)i,
                                 (unsigned)worlds[i]);
        }
        item->called = call;
    }
    return pl_batch_for(batch, reset_one, NULL, worlds, worlds == NULL ? batch->desc.count : count);
}

//---- gather and scatter --------------------------------------------------------------------------

typedef struct window {
    const char *function;
    plumb_batch_view view;
    plumb_real *out;      // observe
    const plumb_real *in; // act
} window;

static size_t first_number(const window *w, uint32_t index)
{
    return (size_t)index * w->view.body_count * w->view.field_count;
}

static plumb_result check_fields(plumb_batch *batch, const char *fn, const plumb_batch_view *view,
                                 bool writes)
{
    uint32_t seen = 0;
    for (uint32_t i = 0; i < view->field_count; ++i) {
        unsigned f = (unsigned)view->fields[i];
        bool fits = writes ? f < FIELD_COUNT && (f < PLUMB_FIELD_COS || f > PLUMB_FIELD_ANGLE)
                           : f < FIELDS_READ;
        if (!fits) {
            return pl_batch_fail(batch, PLUMB_E_RANGE, fn,
                                 "fields[%u] is %u; it must be a field that can be %s", (unsigned)i,
                                 f, writes ? "written" : "read");
        }
        if (writes && IS_SET(seen, f)) {
            return pl_batch_fail(batch, PLUMB_E_DUPLICATE, fn,
                                 "fields[%u] is %u for the second time", (unsigned)i, f);
        }
        seen |= 1u << f;
    }
    return PLUMB_OK;
}

static plumb_result check_view(plumb_batch *batch, const char *fn, const plumb_batch_view *view,
                               const plumb_real *numbers, size_t capacity, bool writes)
{
    if (view == NULL || numbers == NULL) {
        return pl_batch_fail(batch, PLUMB_E_NULL, fn, "%s is null; it must be given",
                             view == NULL ? "view" : "numbers");
    }
    if (view->body_count > BODIES_MOST) {
        return pl_batch_fail(batch, PLUMB_E_RANGE, fn, "view.body_count is %u; it must be 0 to %u",
                             (unsigned)view->body_count, BODIES_MOST);
    }
    if (view->field_count > FIELDS_MOST) {
        return pl_batch_fail(batch, PLUMB_E_RANGE, fn, "view.field_count is %u; it must be 0 to %u",
                             (unsigned)view->field_count, (unsigned)FIELDS_MOST);
    }
    if ((view->body_count > 0 && view->bodies == NULL) ||
        (view->field_count > 0 && view->fields == NULL)) {
        return pl_batch_fail(batch, PLUMB_E_NULL, fn, "view.%s is null; it must be given",
                             view->body_count > 0 && view->bodies == NULL ? "bodies" : "fields");
    }
    size_t needed = (size_t)batch->desc.count * view->body_count * view->field_count;
    if (capacity < needed) {
        return pl_batch_fail(batch, PLUMB_E_RANGE, fn, "capacity is %zu; it must be at least %zu",
                             capacity, needed);
    }
    return check_fields(batch, fn, view, writes);
}

static plumb_real read_field(const plumb_world *world, plumb_body body, plumb_batch_field field)
{
    switch (field) {
    case PLUMB_FIELD_X:
        return plumb_body_position(world, body).x;
    case PLUMB_FIELD_Y:
        return plumb_body_position(world, body).y;
    case PLUMB_FIELD_COS:
        return plumb_body_transform(world, body).q.c;
    case PLUMB_FIELD_SIN:
        return plumb_body_transform(world, body).q.s;
    case PLUMB_FIELD_ANGLE:
        return plumb_body_angle(world, body);
    case PLUMB_FIELD_VX:
        return plumb_body_velocity(world, body).x;
    case PLUMB_FIELD_VY:
        return plumb_body_velocity(world, body).y;
    default: // PLUMB_FIELD_W
        return plumb_body_angular_velocity(world, body);
    }
}

static plumb_result observe_one(const void *of, plumb_batch *batch, uint32_t index)
{
    const window *w = of;
    const plumb_world *world = batch->items[index].world;
    plumb_real *out = w->out + first_number(w, index);
    plumb_result r = PLUMB_OK;
    for (uint32_t b = 0; b < w->view.body_count; ++b) {
        plumb_body body = w->view.bodies[b];
        uint32_t row;
        bool is_there = pl_check_body(world, w->function, body, &row) == PLUMB_OK;
        r = is_there ? r : PLUMB_E_HANDLE;
        for (uint32_t f = 0; f < w->view.field_count; ++f) {
            *out++ = is_there ? read_field(world, body, w->view.fields[f]) : 0;
        }
    }
    return r;
}

plumb_result plumb_batch_observe(plumb_batch *batch, const plumb_batch_view *view,
                                 plumb_real *numbers, size_t capacity)
{
    if (batch == NULL) {
        return PLUMB_E_NULL;
    }
    PL_TRY(check_view(batch, __func__, view, numbers, capacity, false));
    const window w = { .function = __func__, .view = *view, .out = numbers };
    return pl_batch_for(batch, observe_one, &w, NULL, batch->desc.count);
}

static plumb_result write_body(plumb_world *world, plumb_body body, const plumb_batch_view *view,
                               const plumb_real *in)
{
    plumb_vec2 at = plumb_body_position(world, body), v = plumb_body_velocity(world, body);
    plumb_real value[FIELD_COUNT] = { [PLUMB_FIELD_X] = at.x,
                                      [PLUMB_FIELD_Y] = at.y,
                                      [PLUMB_FIELD_VX] = v.x,
                                      [PLUMB_FIELD_VY] = v.y };
    uint32_t given = 0;
    for (uint32_t f = 0; f < view->field_count; ++f) {
        value[view->fields[f]] = in[f];
        given |= 1u << view->fields[f];
    }
    plumb_vec2 to = { value[PLUMB_FIELD_X], value[PLUMB_FIELD_Y] };
    plumb_vec2 force = { value[PLUMB_FIELD_FORCE_X], value[PLUMB_FIELD_FORCE_Y] };
    if (to.x != at.x || to.y != at.y) {
        PL_TRY(plumb_body_set_position(world, body, to));
    }
    if (IS_SET(given, PLUMB_FIELD_VX) || IS_SET(given, PLUMB_FIELD_VY)) {
        v = plumb_v2(value[PLUMB_FIELD_VX], value[PLUMB_FIELD_VY]);
        PL_TRY(plumb_body_set_velocity(world, body, v));
    }
    if (IS_SET(given, PLUMB_FIELD_W)) {
        PL_TRY(plumb_body_set_angular_velocity(world, body, value[PLUMB_FIELD_W]));
    }
    if (force.x != 0 || force.y != 0) {
        PL_TRY(plumb_body_apply_force_center(world, body, force));
    }
    return value[PLUMB_FIELD_TORQUE] != 0
               ? plumb_body_apply_torque(world, body, value[PLUMB_FIELD_TORQUE])
               : PLUMB_OK;
}

static plumb_result act_one(const void *of, plumb_batch *batch, uint32_t index)
{
    const window *w = of;
    plumb_world *world = batch->items[index].world;
    const plumb_real *in = w->in + first_number(w, index);
    for (uint32_t b = 0; b < w->view.body_count; ++b) {
        uint32_t row;
        PL_TRY(pl_check_body(world, w->function, w->view.bodies[b], &row));
        PL_TRY(write_body(world, w->view.bodies[b], &w->view, in));
        in += w->view.field_count;
    }
    return PLUMB_OK;
}

plumb_result plumb_batch_act(plumb_batch *batch, const plumb_batch_view *view,
                             const plumb_real *numbers, size_t capacity)
{
    if (batch == NULL) {
        return PLUMB_E_NULL;
    }
    PL_TRY(check_view(batch, __func__, view, numbers, capacity, true));
    const window w = { .function = __func__, .view = *view, .in = numbers };
    return pl_batch_for(batch, act_one, &w, NULL, batch->desc.count);
}
