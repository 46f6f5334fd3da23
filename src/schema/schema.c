// schema.c - the rows as constant tables, and one property of a descriptor read and written: see plumb/schema.h.
//
// Reads: the rows, descriptors. Writes: descriptors. Cost: O(1); O(rows) to find one by its name.
#include "schema/schema.h"

#include "schema/body.h"
#include "schema/joint.h"
#include "schema/material.h"
#include "schema/world.h"

#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

// Of the descriptor OF.
#define PROPERTY(X, store, kind, member, key, what, range, from, none, sentence)                   \
    { .name = #member,                                                                             \
      PL_CALL(WORD, PL_WORD_##key),                                                                \
      .unit = what,                                                                                \
      .text = sentence,                                                                            \
      .saved = SAVED_##store,                                                                      \
      .type = PL_KIND_##kind,                                                                      \
      PL_RANGE_##range,                                                                            \
      .initial = (double)(from),                                                                   \
      .offset = offsetof(OF, member),                                                              \
      .zero = AT_##none },
#define SAVED_COLUMN     true
#define SAVED_RECORD     true
#define SAVED_HEAT       true
#define SAVED_STATE      true
#define SAVED_OWN        true
#define SAVED_HERE       false
#define AT_ZERO(member)  offsetof(OF, member)
#define AT_NO_ZERO       PLUMB_NO_MEMBER
#define WORD(how, key)   WORD_##how(key)
#define WORD_SAID(key)   .word = #key
#define WORD_NOT(key)    .word = #key, .opposite = true
#define WORD_UNSAID(key) .word = ""

#define OF plumb_body_desc
static const plumb_property bodies[] = { PL_BODY_ROWS(PROPERTY, ) };
#undef OF

#define OF plumb_world_desc
static const plumb_property worlds[] = { PL_WORLD_ROWS(PROPERTY, ) };
#undef OF

#define OF plumb_joint_desc
static const plumb_property joints[] = { PL_JOINT_DESC_ROWS(PROPERTY, ) };
#undef OF

#define OF plumb_material_desc
static const plumb_property materials[] = { PL_MATERIAL_ROWS(PROPERTY, ) };
#undef OF

#define OF plumb_material_pair
static const plumb_property pairs[] = { PL_MATERIAL_PAIR_ROWS(PROPERTY, ) };
#undef OF

static const struct {
    const plumb_property *rows;
    size_t count;
} tables[PLUMB_TABLE_COUNT] = {
    [PLUMB_TABLE_WORLD] = { worlds, COUNT(worlds) },
    [PLUMB_TABLE_JOINT] = { joints, COUNT(joints) },
    [PLUMB_TABLE_BODY] = { bodies, COUNT(bodies) },
    [PLUMB_TABLE_MATERIAL] = { materials, COUNT(materials) },
    [PLUMB_TABLE_MATERIAL_PAIR] = { pairs, COUNT(pairs) },
};

_Static_assert(sizeof(plumb_mix) == sizeof(int) && sizeof(plumb_body_type) == sizeof(int) &&
                   sizeof(plumb_y_axis) == sizeof(int) && sizeof(plumb_solver) == sizeof(int) &&
                   sizeof(plumb_joint_kind) == sizeof(int),
               "choices are read as int");

const plumb_property *plumb_properties(plumb_property_table table, int *count)
{
    const bool known = (unsigned)table < PLUMB_TABLE_COUNT;
    if (count != NULL) {
        *count = known ? (int)tables[table].count : 0;
    }
    return known ? tables[table].rows : NULL;
}

const plumb_property *plumb_property_find(plumb_property_table table, const char *name)
{
    int count;
    const plumb_property *rows = plumb_properties(table, &count);
    for (int i = 0; name != NULL && i < count; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return &rows[i];
        }
    }
    return NULL;
}

// The member, or a component of it.
static size_t offset_of(const plumb_property *property, int axis)
{
    const bool second = axis == 1 && property->type == PLUMB_PROPERTY_VEC2;
    return property->offset + (second ? offsetof(plumb_vec2, y) : 0);
}

double pl_property_member(const plumb_property *property, const void *desc, int axis)
{
    const char *member = (const char *)desc + offset_of(property, axis);
    plumb_real number;
    int choice;
    switch (property->type) {
    case PLUMB_PROPERTY_BOOL:
        return *(const unsigned char *)member != 0 ? 1 : 0; // whatever is in an image
    case PLUMB_PROPERTY_INT:
    case PLUMB_PROPERTY_CHOICE:
        memcpy(&choice, member, sizeof choice);
        return choice;
    default:
        memcpy(&number, member, sizeof number);
        return (double)number;
    }
}

double plumb_property_read(const plumb_property *property, const void *desc, int axis)
{
    if (property->zero != PLUMB_NO_MEMBER && ((const bool *)desc)[property->zero]) {
        return 0;
    }
    const double value = pl_property_member(property, desc, axis);
    return value != 0 ? value : property->initial;
}

void plumb_property_write(const plumb_property *property, void *desc, int axis, double value)
{
    char *member = (char *)desc + offset_of(property, axis);
    const plumb_real number = (plumb_real)value;
    const bool is_whole =
        property->type == PLUMB_PROPERTY_CHOICE || property->type == PLUMB_PROPERTY_INT;
    const int choice = is_whole ? (int)value : 0;
    switch (property->type) {
    case PLUMB_PROPERTY_BOOL:
        *(bool *)(void *)member = value != 0;
        break;
    case PLUMB_PROPERTY_INT:
    case PLUMB_PROPERTY_CHOICE:
        memcpy(member, &choice, sizeof choice);
        break;
    default:
        memcpy(member, &number, sizeof number);
    }
    if (property->zero != PLUMB_NO_MEMBER) {
        ((bool *)desc)[property->zero] = pl_property_member(property, desc, 0) == 0 &&
                                         pl_property_member(property, desc, 1) == 0;
    }
}
