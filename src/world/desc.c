// desc.c - descriptors against the ranges of the schema (src/schema).
//
// Reads: the rows, a descriptor. Cost: O(rows).
#include "schema/schema.h"
#include "world/check.h"
#include "world/rows.h"

#include <stdio.h>
#include <string.h>

static plumb_real bound(double v)
{
    return v >= (double)PLUMB_REAL_MAX    ? PLUMB_REAL_MAX
           : v <= -(double)PLUMB_REAL_MAX ? -PLUMB_REAL_MAX
                                          : (plumb_real)v;
}

// Of what the member holds: 0 is the default and always allowed.
static bool is_in_range(const plumb_property *p, double value)
{
    return value == 0 || (value >= p->low && value <= p->high);
}

static plumb_result fail(const plumb_world *world, const char *function, const char *field,
                         const plumb_property *p, const void *desc)
{
    const plumb_real x = (plumb_real)pl_property_member(p, desc, 0);
    const plumb_real y = (plumb_real)pl_property_member(p, desc, 1);
    if (p->low > 0 && x - x == 0) { // so 0, the default, lies outside
        return pl_fail(world, PLUMB_E_RANGE, function, "%s is %g; it must be 0, or %g to %g", field,
                       (double)x, p->low, p->high);
    }
    switch (p->type) {
    case PLUMB_PROPERTY_CHOICE:
        return pl_fail(world, PLUMB_E_RANGE, function, "%s is %.0f; it must be one of %s", field,
                       pl_property_member(p, desc, 0), p->unit);
    case PLUMB_PROPERTY_VEC2:
        return pl_check_within(world, function, field, (plumb_vec2){ x, y }, bound(p->high));
    default:
        return pl_check_range(world, function, field, x, bound(p->low), bound(p->high));
    }
}

static bool is_sound(const plumb_property *p, const void *desc)
{
    const double x = pl_property_member(p, desc, 0), y = pl_property_member(p, desc, 1);
    return x - x == 0 && y - y == 0 && is_in_range(p, x) && is_in_range(p, y);
}

//---- what the library is built without -----------------------------------------------------------

plumb_result pl_fail_absent(const plumb_world *world, const char *function, const char *what,
                            const char *effect)
{
    return pl_fail(world, PLUMB_E_UNSUPPORTED, function,
                   "%s is asked for; this library was built without '%s' (make EFFECTS=...)", what,
                   effect);
}

// The effect that a property of worlds, bodies or materials belongs to, if it is not in the library; else NULL.
static const char *absent_of(plumb_property_table table, const char *name)
{
#define ROW(NAME, word, needs, files, properties, text) { word, properties, PL_HAS(NAME) },
    static const struct {
        const char *name, *properties;
        bool present;
    } effects[] = { PL_EFFECTS(ROW) };
#undef ROW
    const size_t length = strlen(name);
    for (size_t i = 0; i < sizeof effects / sizeof effects[0]; ++i) {
        const char *at =
            effects[i].present || table == PLUMB_TABLE_JOINT ? "" : effects[i].properties;
        for (; *at != '\0'; at += strcspn(at, " "), at += *at == ' ') {
            if (strcspn(at, " ") == length && memcmp(at, name, length) == 0) {
                return effects[i].name;
            }
        }
    }
    return NULL;
}

// E_UNSUPPORTED where a property that the library does not have is not at its default.
static plumb_result check_absent(const plumb_world *world, const char *function, const char *field,
                                 plumb_property_table table, const plumb_property *p, double value)
{
    const char *effect = PL_HAS_ALL || value == p->initial ? NULL : absent_of(table, p->name);
    return effect == NULL ? PLUMB_OK : pl_fail_absent(world, function, field, effect);
}

plumb_result pl_check_property(const plumb_world *world, const char *function, const char *field,
                               plumb_property_table table, const char *name, plumb_real value)
{
    const plumb_property *p = plumb_property_find(table, name);
    PL_TRY(pl_check_range(world, function, field, value, bound(p->low), bound(p->high)));
    return check_absent(world, function, field, table, p, (double)value);
}

plumb_result pl_check_desc(const plumb_world *world, const char *function, const char *prefix,
                           plumb_property_table table, const void *desc)
{
    int count;
    char field[64];
    const plumb_property *rows = plumb_properties(table, &count);
    for (int i = 0; i < count; ++i) {
        if (!is_sound(&rows[i], desc)) {
            snprintf(field, sizeof field, "%s%s", prefix, rows[i].name);
            return fail(world, function, field, &rows[i], desc);
        }
        for (int axis = 0; axis < 2 && !PL_HAS_ALL; ++axis) {
            snprintf(field, sizeof field, "%s%s", prefix, rows[i].name);
            const double value = pl_property_member(&rows[i], desc, axis);
            PL_TRY(check_absent(world, function, field, table, &rows[i],
                                value != 0 ? value : rows[i].initial));
        }
    }
    return PLUMB_OK;
}

bool pl_desc_is_sound(plumb_property_table table, const void *desc)
{
    int count;
    const plumb_property *rows = plumb_properties(table, &count);
    bool sound = true;
    for (int i = 0; i < count && sound; ++i) {
        sound = is_sound(&rows[i], desc);
    }
    return sound;
}

bool pl_descs_agree(plumb_property_table table, const void *a, const void *b)
{
    int count;
    const plumb_property *rows = plumb_properties(table, &count);
    bool agree = true;
    for (int i = 0; i < count && agree; ++i) {
        for (int axis = 0; axis < 2 && agree; ++axis) {
            agree =
                plumb_property_read(&rows[i], a, axis) == plumb_property_read(&rows[i], b, axis);
        }
    }
    return agree;
}
