// section.h - the state of a world as a row of sections, each an array: what hash, images and deltas
// walk. Which they are follows from list.h.
//
// Order: values, tallies, columns of bodies, pieces, materials, arrays of list.h, registry, corners, switches
// of systems, then values and owners of each user component.
#ifndef PL_SECTION_H
#define PL_SECTION_H

#include "core/digest.h"
#include "snapshot/list.h"
#include "snapshot/rules.h"
#include "world/rows.h"

// What a number of the state is, for those who print it: a letter.
#define PL_TYPE(value)                                                                             \
    _Generic((value),                                                                              \
        float: PL_TYPE_FLOAT,                                                                      \
        double: PL_TYPE_DOUBLE,                                                                    \
        float *: PL_TYPE_FLOATS,                                                                   \
        double *: PL_TYPE_DOUBLES,                                                                 \
        bool: PL_TYPE_BOOL,                                                                        \
        uint8_t: PL_TYPE_U8,                                                                       \
        uint16_t: PL_TYPE_U16,                                                                     \
        uint32_t: PL_TYPE_U32,                                                                     \
        int32_t: PL_TYPE_I32,                                                                      \
        uint64_t: PL_TYPE_U64,                                                                     \
        plumb_vec2: PL_TYPE_VEC2,                                                                  \
        plumb_entity: PL_TYPE_ENTITY,                                                              \
        plumb_body: PL_TYPE_ENTITY,                                                                \
        plumb_shape: PL_TYPE_ENTITY,                                                               \
        plumb_material: PL_TYPE_ENTITY,                                                            \
        plumb_joint: PL_TYPE_ENTITY,                                                               \
        void *: PL_TYPE_POINTER,                                                                   \
        default: PL_TYPE_OTHER)

typedef enum pl_type {
    PL_TYPE_OTHER,
    PL_TYPE_FLOAT,
    PL_TYPE_DOUBLE,
    PL_TYPE_BOOL,
    PL_TYPE_U8,
    PL_TYPE_U16,
    PL_TYPE_U32,
    PL_TYPE_I32,
    PL_TYPE_U64,
    PL_TYPE_VEC2,
    PL_TYPE_ENTITY,
    PL_TYPE_POINTER,
    PL_TYPE_FLOATS, // arrays
    PL_TYPE_DOUBLES
} pl_type;

// A named number within an element.
typedef struct pl_member {
    const char *name;
    uint32_t offset, size; // [B]
    pl_type type;
} pl_member;

typedef struct pl_section {
    const char *table, *name; // "bodies", "vx"
    char *data;               // in the world; NULL: gathered from several places (pl_section_write)
    uint32_t count;           // elements
    uint32_t stride;          // [B] of an element in an image
    uint32_t pitch;           // [B] from element to element in the world; the rest is not saved
    int passing;              // [B] to an index that is saved as 0 or PL_NONE; -1: none; see list.h
    uint32_t hashed;          // [B] of each that count for the world hash; see list.h
    uint32_t key;             // [B] of each that name it; see list.h
    pl_type type;             // of the elements of a column
} pl_section;

// The sections that every world has; those of its components come behind them.
uint32_t pl_section_fixed_count(void);
// The registry's section.
uint32_t pl_section_registry(void);
uint32_t pl_section_count(const plumb_world *world);
// Member i of the section of all values (the first one); false past the last.
bool pl_section_value(uint32_t i, pl_member *member);
// Sets to 0 what of an image means something in this process only: pointers of the user's.
void pl_section_strip(uint32_t i, char *data, uint32_t count);
// [B] of an element's key in section i, see list.h.
uint32_t pl_section_key(uint32_t i);
// Section i; valid until a structural change. O(1).
pl_section pl_section_at(const plumb_world *world, uint32_t i);

#define PL_GATHERED_MOST 8192 // [B] of a section without `data`: values, switches of 256 systems

static inline size_t pl_section_bytes(const pl_section *section)
{
    return (size_t)section->count * section->stride;
}

// Whether the section is in the world as it is at `bytes`, of as many elements.
bool pl_section_equals(const plumb_world *world, uint32_t i, const pl_section *section,
                       const char *bytes);
// What the numbers of section i must be like: rules.h.
pl_rule pl_section_rule(uint32_t i);
// Makes a section that lies somewhere else, 8-byte aligned, that of a world which is only read. False: it
// holds a bool that is none, or a number that is not finite (of the sections of single numbers).
bool pl_section_lend(plumb_world *world, uint32_t i, const char *data, uint32_t count);
// Copies a section out.
void pl_section_write(const plumb_world *world, uint32_t i, const pl_section *section, char *to);
// Copies `count` elements in; room must be reserved. Sets the count.
void pl_section_read(plumb_world *world, uint32_t i, const char *from, uint32_t count);
// Makes room for `count` elements. False when out of memory.
bool pl_section_reserve(plumb_world *world, uint32_t i, uint32_t count);

// plumb_world_hash; `values` false: without the numbers of the first section (settings, time, counts).
uint64_t pl_world_digest(const plumb_world *world, bool values);

// What the sections of this build are: names and sizes of all that is saved, and which effects it lacks.
uint64_t pl_section_schema(void);
// The same of the components that a world has registered.
uint64_t pl_section_user_schema(const plumb_world *world);

#endif
