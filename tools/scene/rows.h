/// rows.h - what rows of the schema (src/schema/row.h) are to the scene language: members of the struct that a
/// constructor fills, keys of its list, and members of the world's descriptor.
#ifndef SCENE_ROWS_H
#define SCENE_ROWS_H

#include "schema/body.h"
#include "schema/joint.h"
#include "schema/material.h"
#include "schema/world.h"

// Numbers are kept as their author wrote them: one scene serves all precisions.
#define SC_MEMBER_REAL(word)      double word;
#define SC_MEMBER_VEC2(word)      double word[2];
#define SC_MEMBER_BOOL(word)      bool word;
#define SC_MEMBER_MIX(word)       int word;
#define SC_MEMBER_BODY_TYPE(word) int word;
#define SC_MEMBER_INT(word)       double word;
#define SC_MEMBER_Y_AXIS(word)    int word;
#define SC_MEMBER_SOLVER(word)    int word;

#define SC_KIND_REAL      SC_NUMBER
#define SC_KIND_VEC2      SC_VEC2
#define SC_KIND_BOOL      SC_BOOL
#define SC_KIND_MIX       SC_CHOICE
#define SC_KIND_BODY_TYPE SC_CHOICE
#define SC_KIND_INT       SC_INTEGER
#define SC_KIND_Y_AXIS    SC_CHOICE
#define SC_KIND_SOLVER    SC_CHOICE

/// A member of the struct.
#define SC_MEMBER(X, store, kind, name, word, ...) PL_CALL(SC_MEMBER_OF, kind, PL_WORD_##word)
#define SC_MEMBER_OF(kind, how, word)              SC_MEMBER_##how(kind, word)
#define SC_MEMBER_SAID(kind, word)                 SC_MEMBER_##kind(word)
#define SC_MEMBER_NOT(kind, word)                  SC_MEMBER_##kind(word)
#define SC_MEMBER_UNSAID(kind, word)

/// A key of the list; struct T. What has no end ends at BIG.
#define SC_ROW(X, store, kind, name, word, unit, range, initial, zero, text)                       \
    PL_CALL(SC_ROW_OF, SC_KIND_##kind, unit, SC_FLAGS_##range, SC_SPAN_##range, PL_WORD_##word)
#define SC_ROW_OF(kind, unit, flags, lo, hi, how, word)                                            \
    SC_ROW_##how(kind, unit, flags, lo, hi, word)
#define SC_ROW_SAID(kind, unit, flags, lo, hi, word)                                               \
    { #word, kind, AT(T, word), lo, hi, kind == SC_BOOL ? NULL : unit, 0, flags },
#define SC_ROW_NOT(kind, unit, flags, lo, hi, word) SC_ROW_SAID(kind, unit, flags, lo, hi, word)
#define SC_ROW_UNSAID(kind, unit, flags, lo, hi, word)
#define SC_SPAN_FROM(lo, hi)   lo, ((hi) > BIG ? BIG : (hi))
#define SC_SPAN_ABOVE(lo, hi)  SC_SPAN_FROM(lo, hi)
#define SC_SPAN_ANY            -BIG, BIG
#define SC_SPAN_CHOICES(last)  0, 0
#define SC_FLAGS_FROM(lo, hi)  0
#define SC_FLAGS_ABOVE(lo, hi) SC_ABOVE
#define SC_FLAGS_ANY           0
#define SC_FLAGS_CHOICES(last) 0

/// `def` means the defaults: statements.
#define SC_DEFAULT(X, store, kind, name, word, unit, range, initial, ...)                          \
    PL_CALL(SC_DEFAULT_OF, kind, initial, PL_WORD_##word)
#define SC_DEFAULT_OF(kind, initial, how, word) SC_DEFAULT_##how(kind, initial, word)
#define SC_DEFAULT_SAID(kind, initial, word)    SC_DEFAULT_##kind(word, initial)
#define SC_DEFAULT_NOT(kind, initial, word)     def.word = !(initial);
#define SC_DEFAULT_UNSAID(kind, initial, word)
#define SC_DEFAULT_REAL(word, initial)      def.word = initial;
#define SC_DEFAULT_VEC2(word, initial)      def.word[0] = def.word[1] = initial;
#define SC_DEFAULT_BOOL(word, initial)      def.word = initial;
#define SC_DEFAULT_MIX(word, initial)       def.word = initial;
#define SC_DEFAULT_BODY_TYPE(word, initial) def.word = initial;

/// `desc` becomes what `def` says: statements. X(word): whether it was given. Whoever writes 0 means it.
#define SC_DESCRIBE(X, store, kind, name, word, unit, range, initial, zero, text)                  \
    PL_CALL(SC_DESCRIBE_OF, X, kind, name, PL_ZERO_ARGS_##zero, PL_WORD_##word)
#define SC_DESCRIBE_OF(X, kind, name, zero, member, how, word)                                     \
    SC_DESCRIBE_##how(X, kind, name, zero, member, word)
#define SC_DESCRIBE_SAID(X, kind, name, zero, member, word)                                        \
    if (X(word)) {                                                                                 \
        SC_DESCRIBE_##kind(name, word) SC_DESCRIBE_##zero(kind, name, member)                      \
    }
#define SC_DESCRIBE_NOT(X, kind, name, zero, member, word)                                         \
    if (X(word)) {                                                                                 \
        desc.name = !def->word;                                                                    \
    }
#define SC_DESCRIBE_UNSAID(X, kind, name, zero, member, word)
#define SC_DESCRIBE_REAL(name, word)      desc.name = (plumb_real)def->word;
#define SC_DESCRIBE_INT(name, word)       desc.name = (int)def->word;
#define SC_DESCRIBE_BOOL(name, word)      desc.name = def->word;
#define SC_DESCRIBE_MIX(name, word)       desc.name = (plumb_mix)def->word;
#define SC_DESCRIBE_BODY_TYPE(name, word) desc.name = (plumb_body_type)def->word;
#define SC_DESCRIBE_Y_AXIS(name, word)    desc.name = (plumb_y_axis)def->word;
#define SC_DESCRIBE_SOLVER(name, word)    desc.name = (plumb_solver)def->word;
#define SC_DESCRIBE_VEC2(name, word)                                                               \
    desc.name = (plumb_vec2){ (plumb_real)def->word[0], (plumb_real)def->word[1] };
#define SC_DESCRIBE_ZERO(kind, name, member) desc.member = SC_IS_ZERO_##kind(desc.name);
#define SC_DESCRIBE_NO_ZERO(kind, name, member)
#define SC_IS_ZERO_REAL(value) (value) == 0
#define SC_IS_ZERO_VEC2(value) (value).x == 0 && (value).y == 0

#endif
