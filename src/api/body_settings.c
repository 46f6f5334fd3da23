// body_settings.c - properties of bodies set and read: what follows from the rows of the schema, damping, speed caps and
// time scale.
//
// Reads: arguments, checked first. Writes: columns, the body's record (world/body_settings.c). Cost: O(1).
#include "world/body_settings.h"
#include "world/heat_list.h"
#include "world/island.h"
#include "world/told.h"
#include "plumb/fracture.h"
#include "plumb/law.h"
#include "effects/effects.h"
#include "world/check.h"
#include "world/rows.h"

static plumb_result check(const plumb_world *world, const char *fn, const char *field,
                          const char *property, plumb_real value)
{
    return pl_check_property(world, fn, field, PLUMB_TABLE_BODY, property, value);
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

static bool are_equal(const pl_body_settings *a, const pl_body_settings *b)
{
#define IS_EQUAL(name, initial) &&a->name == b->name
    return true PL_BODY_ROWS(PL_ROW_RECORD, IS_EQUAL);
#undef IS_EQUAL
}

// What is set to what it was wakes nobody.
static plumb_result store(plumb_world *world, const char *fn, uint32_t row,
                          const pl_body_settings *t)
{
    const pl_body_settings was = pl_body_settings_get(world, row);
    if (!are_equal(&was, t)) {
        pl_body_settings_set(world, row, t);
        pl_sleep_disturb(world, row);
        pl_told(world, t->body.entity, fn);
    }
    return PLUMB_OK;
}

plumb_result plumb_body_set_damping(plumb_world *world, plumb_body body, plumb_real linear,
                                    plumb_real angular)
{
    uint32_t row;
    pl_body_settings t;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(check(world, __func__, "linear", "damping", linear));
    PL_TRY(check(world, __func__, "angular", "angular_damping", angular));
    PL_TRY(open(world, __func__, row, &t));
    t.damping = linear;
    t.angular_damping = angular;
    return store(world, __func__, row, &t);
}

plumb_result plumb_body_set_speed_cap(plumb_world *world, plumb_body body, plumb_real max_speed,
                                      plumb_real max_spin)
{
    uint32_t row;
    pl_body_settings t;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(check(world, __func__, "max_speed", "max_speed", max_speed));
    PL_TRY(check(world, __func__, "max_spin", "max_spin", max_spin));
    PL_TRY(open(world, __func__, row, &t));
    t.max_speed = max_speed;
    t.max_spin = max_spin;
    return store(world, __func__, row, &t);
}

plumb_result plumb_body_set_time_scale(plumb_world *world, plumb_body body, plumb_real scale)
{
    uint32_t row;
    pl_body_settings t;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(check(world, __func__, "scale", "time_scale", scale));
    PL_TRY(open(world, __func__, row, &t));
    const bool other = scale != t.time_scale;
    t.time_scale = scale;
    store(world, __func__, row, &t);
    if (other) {
        pl_target_reaim(world, row);
    }
    return PLUMB_OK;
}

// Of one number: plumb_body_set_charge and so on.
#define NUMBER_SETTER(name)                                                                        \
    plumb_result plumb_body_set_##name(plumb_world *world, plumb_body body, plumb_real name)       \
    {                                                                                              \
        uint32_t row;                                                                              \
        pl_body_settings t;                                                                        \
        PL_TRY(pl_check_body(world, __func__, body, &row));                                        \
        PL_TRY(check(world, __func__, #name, #name, name));                                        \
        PL_TRY(open(world, __func__, row, &t));                                                    \
        t.name = name;                                                                             \
        return store(world, __func__, row, &t);                                                    \
    }
NUMBER_SETTER(charge)
NUMBER_SETTER(attraction)
NUMBER_SETTER(dipole)
NUMBER_SETTER(dipole_angle)
NUMBER_SETTER(drag)
NUMBER_SETTER(thrust)
NUMBER_SETTER(exhaust)
NUMBER_SETTER(fuel)
NUMBER_SETTER(thrust_x)
NUMBER_SETTER(thrust_y)
NUMBER_SETTER(thrust_angle)
NUMBER_SETTER(break_force)
NUMBER_SETTER(break_impulse)
NUMBER_SETTER(break_energy)
NUMBER_SETTER(break_cells)

//---- columns ------------------------------------------------------------------------------------

// plumb_body_set_<name>, plumb_body_<name> of each row of the schema that is a column.
#define SETTER(X, store, kind, name, ...) SETTER_##store(PL_MEMBER_##kind, name)
#define SETTER_COLUMN(type, name)                                                                  \
    plumb_result plumb_body_set_##name(plumb_world *world, plumb_body body, type name)             \
    {                                                                                              \
        uint32_t row;                                                                              \
        PL_TRY(pl_check_body(world, __func__, body, &row));                                        \
        PL_TRY(check(world, __func__, #name, #name, (real)name));                                  \
        if (name != world->bodies.name[row]) {                                                     \
            pl_sleep_disturb(world, row);                                                          \
        }                                                                                          \
        world->bodies.name[row] = name;                                                            \
        pl_told(world, body.entity, __func__);                                                     \
        world->schedule_dirty = true;                                                              \
        return PLUMB_OK;                                                                           \
    }
#define SETTER_RECORD(...)
#define SETTER_HEAT(...)
#define SETTER_OWN(...)
PL_BODY_ROWS(SETTER, )

#define GETTER(X, store, kind, name, ...) GETTER_##store(PL_MEMBER_##kind, name)
#define GETTER_COLUMN(type, name)                                                                  \
    type plumb_body_##name(const plumb_world *world, plumb_body body)                              \
    {                                                                                              \
        uint32_t row = pl_ask_body(world, __func__, body);                                         \
        return row == PL_NONE ? (type)0 : (type)world->bodies.name[row];                           \
    }
#define GETTER_RECORD(...)
#define GETTER_HEAT(...)
#define GETTER_OWN(...)
PL_BODY_ROWS(GETTER, )

//---- read ----------------------------------------------------------------------------------------

// Zeros for a bad handle.
static pl_body_settings look(const plumb_world *world, const char *fn, plumb_body body)
{
    uint32_t row = pl_ask_body(world, fn, body);
    return row == PL_NONE ? (pl_body_settings){ .damping = 0 } : pl_body_settings_get(world, row);
}

#define RECORD_GETTER(name, initial)                                                               \
    plumb_real plumb_body_##name(const plumb_world *world, plumb_body body)                        \
    {                                                                                              \
        return look(world, __func__, body).name;                                                   \
    }
PL_BODY_ROWS(PL_ROW_RECORD, RECORD_GETTER)

plumb_result plumb_body_settings(const plumb_world *world, plumb_body body, plumb_body_desc *desc)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    const pl_bodies *b = &world->bodies;
    const pl_body_settings t = pl_body_settings_get(world, row);
    const uint32_t flags = b->flags[row];
    *desc = (plumb_body_desc){ .type = (plumb_body_type)b->type[row],
                               .position = { b->x[row], b->y[row] },
                               .angle = plumb_body_angle(world, body),
                               .velocity = { b->vx[row], b->vy[row] },
                               .angular_velocity = b->w[row],
                               .mass = b->set_mass[row],
                               .inertia = b->set_inertia[row],
                               .fixed_rotation = (flags & PL_BODY_FIXED_ROTATION) != 0,
                               .no_sleep = (flags & PL_BODY_NO_SLEEP) != 0,
                               .asleep = b->island[row] != PL_NONE,
                               .continuous = (flags & PL_BODY_CONTINUOUS) != 0,
                               .lock_x = (flags & PL_BODY_LOCK_X) != 0,
                               .lock_y = (flags & PL_BODY_LOCK_Y) != 0,
                               .disabled = (flags & PL_BODY_DISABLED) != 0,
                               .user_data = b->user_data[row] };
    PL_BODY_ROWS(PL_ROW_GET, b)
#define GET(name, initial) desc->name = t.name;
    PL_BODY_ROWS(PL_ROW_RECORD, GET)
#undef GET
    const pl_heat heat = pl_heat_get(world, body);
#define GET(name, initial) desc->name = (plumb_real)heat.name;
    PL_BODY_ROWS(PL_ROW_HEAT, GET)
#undef GET
    return PLUMB_OK;
}
