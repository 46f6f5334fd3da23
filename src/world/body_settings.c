// body_settings.c - damping, speed caps and time scale of bodies, set and read.
//
// Reads: arguments, checked first. Writes: the body's record (effects/body_settings.c). Cost: O(1).
#include "effects/effects.h"
#include "world/check.h"
#include "world/rows.h"

#define TIME_SCALE_MOST ((real)100)

plumb_result pl_body_settings_check(const plumb_world *world, const char *fn,
                                    const plumb_body_desc *desc)
{
    const struct {
        const char *name;
        real value, most;
    } fields[] = {
        { "damping", desc->damping, PLUMB_REAL_MAX },
        { "angular_damping", desc->angular_damping, PLUMB_REAL_MAX },
        { "max_speed", desc->max_speed, PLUMB_REAL_MAX },
        { "max_spin", desc->max_spin, PLUMB_REAL_MAX },
        { "time_scale", desc->time_scale, TIME_SCALE_MOST },
    };
    plumb_result r = PLUMB_OK;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0] && r == PLUMB_OK; ++i) {
        r = pl_check_range(world, fn, fields[i].name, fields[i].value, 0, fields[i].most);
    }
    return r;
}

// The body's record, to be changed and given back with `store`.
static plumb_result open(plumb_world *world, const char *fn, uint32_t row, pl_body_settings *t)
{
    if (!pl_body_settings_reserve(world)) {
        return pl_fail_memory(world, fn);
    }
    *t = pl_body_settings_get(world, row);
    return PLUMB_OK;
}

static plumb_result store(plumb_world *world, uint32_t row, const pl_body_settings *t)
{
    pl_body_settings_set(world, row, t);
    pl_sleep_disturb(world, row);
    return PLUMB_OK;
}

plumb_result plumb_body_set_damping(plumb_world *world, plumb_body body, plumb_real linear,
                                    plumb_real angular)
{
    uint32_t row;
    pl_body_settings t;
    plumb_result r = pl_check_body(world, __func__, body, &row);
    r = r != PLUMB_OK ? r : pl_check_range(world, __func__, "linear", linear, 0, PLUMB_REAL_MAX);
    r = r != PLUMB_OK ? r : pl_check_range(world, __func__, "angular", angular, 0, PLUMB_REAL_MAX);
    r = r != PLUMB_OK ? r : open(world, __func__, row, &t);
    if (r != PLUMB_OK) {
        return r;
    }
    t.damping = linear;
    t.angular_damping = angular;
    return store(world, row, &t);
}

plumb_result plumb_body_set_speed_cap(plumb_world *world, plumb_body body, plumb_real max_speed,
                                      plumb_real max_spin)
{
    uint32_t row;
    pl_body_settings t;
    plumb_result r = pl_check_body(world, __func__, body, &row);
    r = r != PLUMB_OK ? r
                      : pl_check_range(world, __func__, "max_speed", max_speed, 0, PLUMB_REAL_MAX);
    r = r != PLUMB_OK ? r
                      : pl_check_range(world, __func__, "max_spin", max_spin, 0, PLUMB_REAL_MAX);
    r = r != PLUMB_OK ? r : open(world, __func__, row, &t);
    if (r != PLUMB_OK) {
        return r;
    }
    t.max_speed = max_speed;
    t.max_spin = max_spin;
    return store(world, row, &t);
}

plumb_result plumb_body_set_time_scale(plumb_world *world, plumb_body body, plumb_real scale)
{
    uint32_t row;
    pl_body_settings t;
    plumb_result r = pl_check_body(world, __func__, body, &row);
    r = r != PLUMB_OK ? r : pl_check_range(world, __func__, "scale", scale, 0, TIME_SCALE_MOST);
    r = r != PLUMB_OK ? r : open(world, __func__, row, &t);
    if (r != PLUMB_OK) {
        return r;
    }
    t.time_scale = scale;
    store(world, row, &t);
    pl_target_reaim(world, row);
    return PLUMB_OK;
}

//---- read ----------------------------------------------------------------------------------------

// Zeros for a bad handle.
static pl_body_settings look(const plumb_world *world, const char *fn, plumb_body body)
{
    uint32_t row = pl_ask_body(world, fn, body);
    return row == PL_NONE ? (pl_body_settings){ .time_scale = 0 }
                          : pl_body_settings_get(world, row);
}

plumb_real plumb_body_damping(const plumb_world *world, plumb_body body)
{
    return look(world, __func__, body).damping;
}

plumb_real plumb_body_angular_damping(const plumb_world *world, plumb_body body)
{
    return look(world, __func__, body).angular_damping;
}

plumb_real plumb_body_max_speed(const plumb_world *world, plumb_body body)
{
    return look(world, __func__, body).max_speed;
}

plumb_real plumb_body_max_spin(const plumb_world *world, plumb_body body)
{
    return look(world, __func__, body).max_spin;
}

plumb_real plumb_body_time_scale(const plumb_world *world, plumb_body body)
{
    return look(world, __func__, body).time_scale;
}
