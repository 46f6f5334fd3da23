// rules.h - what the numbers of an image must be like: the last word of each row of world/columns.h; for a row of
// src/schema, its range. Numbers of bool and floating types are 0 or 1, or finite, without a rule saying so; how rows
// hang together is the business of check.c.
//
//   ANY           nothing more
//   GUARDED       any number at all: the guard of a step takes out what would not stay finite (step/quarantine.c)
//   POSITIVE      a real not below 0
//   UP_TO(n)      at most n
//   PLACE(what)   below the count of it;  OR_NONE: or PL_NONE;  ONE_MORE: 1 + such a place, or 0
#ifndef PL_RULES_H
#define PL_RULES_H

#include "plumb/joint.h"

#include "schema/row.h"

#include <stdint.h>

typedef enum pl_rule_kind {
    PL_RULE_IS_ANY,
    PL_RULE_IS_GUARDED,
    PL_RULE_IS_WITHIN, // of reals: low, high
    PL_RULE_IS_UP_TO,
    PL_RULE_IS_PLACE,
    PL_RULE_IS_PLACE_OR_NONE,
    PL_RULE_IS_ONE_MORE
} pl_rule_kind;

// What places are of.
enum {
    PL_OF_BODIES,
    PL_OF_PIECES,
    PL_OF_MATERIALS,
    PL_OF_JOINTS,
    PL_OF_CHARACTERS,
    PL_OF_SETTINGS,
    PL_OF_ISLANDS,
    PL_OF_SLEEPING
};

typedef struct pl_rule {
    pl_rule_kind kind;
    uint32_t of; // what a place is of; the most
    double low, high;
} pl_rule;

// clang-format off
#define ANY           { .kind = PL_RULE_IS_ANY }
#define GUARDED       { .kind = PL_RULE_IS_GUARDED }
#define UP_TO(n)      { .kind = PL_RULE_IS_UP_TO, .of = n }
#define PLACE(what)   { .kind = PL_RULE_IS_PLACE, .of = PL_OF_##what }
#define OR_NONE(what) { .kind = PL_RULE_IS_PLACE_OR_NONE, .of = PL_OF_##what }
#define ONE_MORE(what) { .kind = PL_RULE_IS_ONE_MORE, .of = PL_OF_##what }
#define POSITIVE      WITHIN_FROM(0, NO_END)

// Ranges of the schema. What 0 stands for is resolved: it lies in the range.
#define WITHIN_FROM(lo, hi)  { .kind = PL_RULE_IS_WITHIN, .low = lo, .high = hi }
#define WITHIN_ABOVE(lo, hi) WITHIN_FROM(lo, hi)
#define WITHIN_ANY           ANY
#define WITHIN_CHOICES(last) UP_TO(last)
// clang-format on

#endif
