/// schema.h - what can be set, as data: every property of a descriptor with its type, unit, range and default, in
/// one list a table. For editors, bindings and loaders; `plumb list` prints it.
///
///     int count;
///     const plumb_property *p = plumb_properties(PLUMB_TABLE_MATERIAL, &count);
///     for (int i = 0; i < count; ++i) printf("%s [%s] %s\n", p[i].name, p[i].unit, p[i].text);
#ifndef PLUMB_SCHEMA_H
#define PLUMB_SCHEMA_H

#include "plumb/types.h"

PLUMB_BEGIN

// Offsets follow the precision: see plumb_real.
#define plumb_properties     PLUMB_SYMBOL(plumb_properties)
#define plumb_property_find  PLUMB_SYMBOL(plumb_property_find)
#define plumb_property_read  PLUMB_SYMBOL(plumb_property_read)
#define plumb_property_write PLUMB_SYMBOL(plumb_property_write)

/// Whose properties.
typedef enum plumb_property_table {
    PLUMB_TABLE_WORLD,         ///< plumb_world_desc, but capacities and hooks
    PLUMB_TABLE_BODY,          ///< plumb_body_desc
    PLUMB_TABLE_MATERIAL,      ///< plumb_material_desc
    PLUMB_TABLE_MATERIAL_PAIR, ///< plumb_material_pair
    PLUMB_TABLE_JOINT,         ///< plumb_joint_desc, but its bodies
    PLUMB_TABLE_COUNT
} plumb_property_table;

typedef enum plumb_property_type {
    PLUMB_PROPERTY_REAL,  ///< plumb_real
    PLUMB_PROPERTY_INT,   ///< int
    PLUMB_PROPERTY_VEC2,  ///< plumb_vec2
    PLUMB_PROPERTY_BOOL,  ///< bool
    PLUMB_PROPERTY_CHOICE ///< an enum; `unit` names its values in order: "up|down"
} plumb_property_type;

/// `zero` of a property that has no such member.
#define PLUMB_NO_MEMBER SIZE_MAX

/// One property. Texts are constant.
typedef struct plumb_property {
    const char *name; ///< of the descriptor's member
    const char *word; ///< its key in scene files; "": it has none of its own
    const char *unit; ///< "m/s"; "1" for a ratio and a bool; of a choice its values
    const char *text; ///< one sentence
    plumb_property_type type;
    bool saved;       ///< part of the state: of snapshots, hash and recordings. False: of this machine
    bool opposite;    ///< the word says the opposite of the member: sleep, no_sleep
    bool above;       ///< `low` is not allowed itself; where the member is 0 it means `initial` all the same
    double low, high; ///< range of what it can mean; -INFINITY, INFINITY: any finite number. Of each component
    double initial;   ///< what 0 in the descriptor means, the default
    size_t offset;    ///< [B] of the member in the descriptor
    size_t zero;      ///< [B] of the bool member that says that 0 is meant; PLUMB_NO_MEMBER: none
} plumb_property;

/// The properties of a table in order; *count may be null. Null and 0 for a number that is no table. O(1).
PLUMB_API const plumb_property *plumb_properties(plumb_property_table table, int *count);

/// The property of that name; null: there is none. O(properties).
PLUMB_API const plumb_property *plumb_property_find(plumb_property_table table, const char *name);

/// What a descriptor means by a property: a member that is 0 means `initial`, unless `zero` says otherwise. A choice
/// is its number, a bool 0 or 1; of a vector, its component `axis`: 0 is x, 1 is y.
PLUMB_API double plumb_property_read(const plumb_property *property, const void *desc, int axis);

/// Makes a descriptor mean a value: 0 sets the member `zero`, any other number takes it back. Nothing is
/// checked: the function that takes the descriptor does.
PLUMB_API void plumb_property_write(const plumb_property *property, void *desc, int axis, double value);

PLUMB_END

#endif
