// desc.c - descriptors against the ranges of the schema (src/schema).
//
// Reads: the rows, a descriptor. Cost: O(rows).
#include "schema/schema.h"
#include "world/check.h"
#include "world/rows.h"

#include <stdio.h>

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

static plumb_result check(const plumb_world *world, const char *function, const char *prefix,
                          const plumb_property *p, const void *desc)
{
    char field[64];
    const double value = pl_property_member(p, desc);
    if (plumb_is_finite((plumb_real)value) && is_in_range(p, value)) {
        return PLUMB_OK;
    }
    snprintf(field, sizeof field, "%s%s", prefix, p->name);
    return p->type == PLUMB_PROPERTY_CHOICE
               ? pl_fail(world, PLUMB_E_RANGE, function, "%s is %d; it must be one of %s", field,
                         (int)value, p->unit)
               : pl_check_range(world, function, field, (plumb_real)value, bound(p->low),
                                bound(p->high));
}

plumb_result pl_check_desc(const plumb_world *world, const char *function, const char *prefix,
                           plumb_property_table table, const void *desc)
{
    int count;
    const plumb_property *rows = plumb_properties(table, &count);
    plumb_result r = PLUMB_OK;
    for (int i = 0; i < count && r == PLUMB_OK; ++i) {
        r = check(world, function, prefix, &rows[i], desc);
    }
    return r;
}

bool pl_desc_is_sound(plumb_property_table table, const void *desc)
{
    int count;
    const plumb_property *rows = plumb_properties(table, &count);
    bool sound = true;
    for (int i = 0; i < count && sound; ++i) {
        const double value = pl_property_member(&rows[i], desc);
        sound = value - value == 0 && is_in_range(&rows[i], value);
    }
    return sound;
}
