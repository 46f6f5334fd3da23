/// rows.h - what rows of the schema (src/schema/row.h) are to the scene language: members of the struct that a
/// constructor fills, keys of its list, and members of the world's descriptor.
#ifndef SCENE_ROWS_H
#define SCENE_ROWS_H

#include "schema/material.h"

// Numbers are kept as their author wrote them: one scene serves all precisions.
#define SC_TYPE_REAL double
#define SC_TYPE_MIX  int

#define SC_KIND_REAL SC_NUMBER
#define SC_KIND_MIX  SC_CHOICE

/// A member of the struct.
#define SC_MEMBER(X, store, kind, name, word, ...) SC_TYPE_##kind word;

/// A key of the list; struct T. What has no end ends at BIG.
#define SC_ROW(X, store, kind, name, word, unit, range, initial, zero, text)                       \
    { #word, SC_KIND_##kind, AT(T, word), SC_SPAN_##range, unit, 0, SC_FLAGS_##range },
#define SC_SPAN_FROM(lo, hi)   lo, ((hi) > BIG ? BIG : (hi))
#define SC_SPAN_ABOVE(lo, hi)  SC_SPAN_FROM(lo, hi)
#define SC_SPAN_ANY            -BIG, BIG
#define SC_SPAN_CHOICES(last)  0, 0
#define SC_FLAGS_FROM(lo, hi)  0
#define SC_FLAGS_ABOVE(lo, hi) SC_ABOVE
#define SC_FLAGS_ANY           0
#define SC_FLAGS_CHOICES(last) 0

/// `desc` becomes what `def` says: statements. Whoever writes 0 means it: X(word), whether it was given.
#define SC_DESCRIBE(X, store, kind, name, word, unit, range, initial, zero, text)                  \
    desc.name = (PL_MEMBER_##kind)def->word;                                                       \
    SC_DESCRIBE_##zero(X(word) && desc.name == 0)
#define SC_DESCRIBE_ZERO(member) desc.member = SC_IS
#define SC_DESCRIBE_NO_ZERO      SC_IS_NOTHING
#define SC_IS(condition)         (condition);
#define SC_IS_NOTHING(condition)

#endif
