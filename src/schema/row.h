// row.h - how a row of the schema is written, and what becomes of it.
//
//     R(X, store, kind, name, word, unit, range, initial, zero, text)
//
//   X        handed through to R, so that a list of rows can be part of another list
//   store    COLUMN: a column of that name; RECORD: a member of the record of bodies that few have
//            (effects/effects.h); HEAT: of the record of those that have heat (world/heat_list.h); STATE: the descriptor is kept, and this member is saved and hashed; HERE: it is
//            kept and no state; OWN: code of its own keeps it
//   kind     REAL, INT, VEC2, BOOL, or an enum: MIX, BODY_TYPE, Y_AXIS, SOLVER, JOINT_KIND
//   name     of the descriptor's member
//   word     SAID(key) in scene files; NOT(key), which says the opposite; UNSAID
//   unit     "m/s"; "1" for a ratio and a bool; of an enum its values
//   range    FROM(low, high), ABOVE(low, high) without low itself, ANY finite number, CHOICES(last);
//            high may be NO_END. Of a vector, that of each component
//   initial  what 0 in the descriptor means
//   zero     ZERO(member), the bool that says that 0 is meant; NO_ZERO
//   text     one sentence
//
// What needs more than this is a function: of a check (api/material.c), of a setter.
#ifndef PL_SCHEMA_ROW_H
#define PL_SCHEMA_ROW_H

#include "plumb/schema.h"

#include <math.h>

// What a kind is: in a column, in a descriptor, for a user.
#define PL_COLUMN_REAL      plumb_real
#define PL_COLUMN_BOOL      bool
#define PL_COLUMN_MIX       uint8_t
#define PL_MEMBER_REAL      plumb_real
#define PL_MEMBER_VEC2      plumb_vec2
#define PL_MEMBER_BOOL      bool
#define PL_MEMBER_MIX       plumb_mix
#define PL_MEMBER_BODY_TYPE plumb_body_type
#define PL_MEMBER_INT       int
#define PL_MEMBER_Y_AXIS    plumb_y_axis
#define PL_MEMBER_SOLVER    plumb_solver
#define PL_KIND_REAL        PLUMB_PROPERTY_REAL
#define PL_KIND_VEC2        PLUMB_PROPERTY_VEC2
#define PL_KIND_BOOL        PLUMB_PROPERTY_BOOL
#define PL_KIND_MIX         PLUMB_PROPERTY_CHOICE
#define PL_KIND_BODY_TYPE   PLUMB_PROPERTY_CHOICE
#define PL_KIND_INT         PLUMB_PROPERTY_INT
#define PL_KIND_Y_AXIS      PLUMB_PROPERTY_CHOICE
#define PL_KIND_SOLVER      PLUMB_PROPERTY_CHOICE
#define PL_KIND_JOINT_KIND  PLUMB_PROPERTY_CHOICE

// In the order of their enums.
#define PL_MIX_CHOICES       "default|average|geometric|multiply|min|max"
#define PL_BODY_TYPE_CHOICES "dynamic|kinematic|static"
#define PL_Y_AXIS_CHOICES    "up|down"
#define PL_SOLVER_CHOICES    "soft|pgs|exact"

// What a range is: low, high, whether low is left out.
#define NO_END                 ((double)INFINITY)
#define PL_RANGE_FROM(lo, hi)  .low = lo, .high = hi
#define PL_RANGE_ABOVE(lo, hi) .low = lo, .high = hi, .above = true
#define PL_RANGE_ANY           .low = -NO_END, .high = NO_END
#define PL_RANGE_CHOICES(last) .low = 0, .high = last

// The parts of `word` and `zero` as arguments: what it is, and the name.
#define PL_CALL(macro, ...)       macro(__VA_ARGS__)
#define PL_WORD_SAID(key)         SAID, key
#define PL_WORD_NOT(key)          NOT, key
#define PL_WORD_UNSAID            UNSAID, unsaid
#define PL_ZERO_ARGS_ZERO(member) ZERO, member
#define PL_ZERO_ARGS_NO_ZERO      NO_ZERO, none

// Whether a descriptor `desc` says that 0 is meant.
#define PL_IS_ZERO(member) desc->member
#define PL_IS_NO_ZERO      false

// X(member) of each member of the descriptor.
#define PL_ROW_MEMBERS(X, store, kind, name, word, unit, range, initial, zero, text)               \
    X(name) PL_CALL(PL_ROW_ZERO_MEMBER, X, PL_ZERO_ARGS_##zero)
#define PL_ROW_ZERO_MEMBER(X, how, member) PL_ROW_MEMBER_##how(X, member)
#define PL_ROW_MEMBER_ZERO(X, member)      X(member)
#define PL_ROW_MEMBER_NO_ZERO(X, member)

// X(type, name, rule) of a row that is a column, for the lists of world/columns.h. The rule of its numbers in an
// image follows from the range: snapshot/rules.h.
#define PL_ROW_COLUMN(X, store, kind, name, word, unit, range, ...)                                \
    PL_ROW_COLUMN_##store(X, PL_COLUMN_##kind, name, WITHIN_##range)
#define PL_ROW_COLUMN_COLUMN(X, type, name, ...) X(type, name, __VA_ARGS__)
#define PL_ROW_COLUMN_RECORD(...)
#define PL_ROW_COLUMN_HEAT(...)
#define PL_ROW_COLUMN_OWN(...)

// X(desc.member) of a row that is state in a descriptor that is kept.
#define PL_ROW_STATE(X, store, kind, name, word, unit, range, initial, zero, text)                 \
    PL_ROW_STATE_##store(X, name, PL_ZERO_ARGS_##zero)
#define PL_ROW_STATE_STATE(X, name, ...) X(desc.name) PL_CALL(PL_STATE_ZERO_OF, X, __VA_ARGS__)
#define PL_STATE_ZERO_OF(X, how, member) PL_STATE_ZERO_##how(X, member)
#define PL_STATE_ZERO_ZERO(X, member)    X(desc.member)
#define PL_STATE_ZERO_NO_ZERO(X, member)
#define PL_ROW_STATE_HERE(...)
#define PL_ROW_STATE_OWN(...)

// X(name, initial) of a row that is a member of the record.
#define PL_ROW_RECORD(X, store, kind, name, word, unit, range, initial, ...)                       \
    PL_ROW_RECORD_##store(X, name, initial)
#define PL_ROW_RECORD_RECORD(X, name, initial) X(name, initial)
#define PL_ROW_RECORD_COLUMN(...)
#define PL_ROW_RECORD_OWN(...)
#define PL_ROW_RECORD_HEAT(...)

// The same of a member of the record of heat.
#define PL_ROW_HEAT(X, store, kind, name, word, unit, range, initial, ...)                         \
    PL_ROW_HEAT_##store(X, name, initial)
#define PL_ROW_HEAT_HEAT(X, name, initial) X(name, initial)
#define PL_ROW_HEAT_RECORD(...)
#define PL_ROW_HEAT_COLUMN(...)
#define PL_ROW_HEAT_OWN(...)

// What the member of `desc` means.
#define PL_MEANS(type, name, initial, zero)                                                        \
    ((type)(PL_IS_##zero ? 0 : desc->name != 0 ? desc->name : (type)(initial)))

// Row `row` of `table` becomes what `desc` says; and back.
#define PL_ROW_FILL(table, store, kind, name, word, unit, range, initial, zero, text)              \
    PL_ROW_FILL_##store(table, PL_COLUMN_##kind, name, initial, zero)
#define PL_ROW_FILL_COLUMN(table, type, name, initial, zero)                                       \
    (table)->name[row] = PL_MEANS(type, name, initial, zero);
#define PL_ROW_FILL_RECORD(...)
#define PL_ROW_FILL_HEAT(...)
#define PL_ROW_FILL_OWN(...)
#define PL_ROW_GET(table, store, kind, name, word, unit, range, initial, zero, text)               \
    PL_ROW_GET_##store(table, PL_MEMBER_##kind, name, zero)
#define PL_ROW_GET_COLUMN(table, type, name, zero)                                                 \
    desc->name = (type)(table)->name[row];                                                         \
    PL_GET_##zero(desc->name == 0)
#define PL_ROW_GET_RECORD(...)
#define PL_ROW_GET_HEAT(...)
#define PL_ROW_GET_OWN(...)
#define PL_GET_ZERO(member) desc->member = PL_GET_IS
#define PL_GET_NO_ZERO      PL_GET_NOTHING
#define PL_GET_IS(is)       (is);
#define PL_GET_NOTHING(is)

#endif
