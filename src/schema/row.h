// row.h - how a row of the schema is written, and what becomes of it.
//
//     R(X, store, kind, name, word, unit, range, initial, zero, text)
//
//   X        handed through to R, so that a list of rows can be part of another list
//   store    COLUMN: a column of that name; OWN: code of its own keeps it
//   kind     REAL, or an enum: MIX
//   name     of the descriptor's member
//   word     key in scene files
//   unit     "m/s"; "1" for a ratio; of an enum its values
//   range    FROM(low, high), ABOVE(low, high) without low itself, ANY finite number, CHOICES(last);
//            high may be NO_END
//   initial  what 0 in the descriptor means
//   zero     ZERO(member), the bool that says that 0 is meant; NO_ZERO
//   text     one sentence
//
// What needs more than this is a function: of a check (world/material.c), of a setter.
#ifndef PL_SCHEMA_ROW_H
#define PL_SCHEMA_ROW_H

#include "plumb/schema.h"

#include <math.h>

// What a kind is: in a column, in a descriptor, for a user.
#define PL_COLUMN_REAL plumb_real
#define PL_COLUMN_MIX  uint8_t
#define PL_MEMBER_REAL plumb_real
#define PL_MEMBER_MIX  plumb_mix
#define PL_KIND_REAL   PLUMB_PROPERTY_REAL
#define PL_KIND_MIX    PLUMB_PROPERTY_CHOICE

#define PL_MIX_CHOICES "default|average|geometric|multiply|min|max" // in the order of plumb_mix

// What a range is: low, high, whether low is left out.
#define NO_END                 ((double)INFINITY)
#define PL_RANGE_FROM(lo, hi)  .low = lo, .high = hi
#define PL_RANGE_ABOVE(lo, hi) .low = lo, .high = hi, .above = true
#define PL_RANGE_ANY           .low = -NO_END, .high = NO_END
#define PL_RANGE_CHOICES(last) .low = 0, .high = last

// Whether a descriptor `desc` says that 0 is meant.
#define PL_IS_ZERO(member) desc->member
#define PL_IS_NO_ZERO      false

// A column of a table, for the lists of world/columns.h. The rule of its numbers in an image follows
// from the range: snapshot/rules.h.
#define PL_ROW_COLUMN(X, store, kind, name, word, unit, range, ...)                                \
    PL_ROW_STORE_##store(X, PL_COLUMN_##kind, name, WITHIN_##range)
#define PL_ROW_STORE_COLUMN(X, type, name, ...) X(type, name, __VA_ARGS__)
#define PL_ROW_STORE_OWN(...)

// What row `row` of `table` becomes by the member of `desc`, and back.
#define PL_ROW_FILL(table, store, kind, name, word, unit, range, initial, zero, text)              \
    PL_FILL_##store(table, PL_COLUMN_##kind, name, initial, PL_IS_##zero)
#define PL_FILL_COLUMN(table, type, name, initial, is_zero)                                        \
    (table)->name[row] = (type)(is_zero ? 0 : desc->name != 0 ? desc->name : (type)(initial));
#define PL_FILL_OWN(...)
#define PL_ROW_GET(table, store, kind, name, ...) PL_GET_##store(table, PL_MEMBER_##kind, name)
#define PL_GET_COLUMN(table, type, name)          desc->name = (type)(table)->name[row];
#define PL_GET_OWN(...)

#endif
