// effects.c - the list of effects.h as a constant table, for users.
#include "schema/effects.h"

#include "plumb/effect.h"

#define EFFECT(NAME, word, needs, files, properties, what)                                         \
    { .name = word, .text = what, .present = PL_HAS(NAME) },

static const plumb_effect effects[] = { PL_EFFECTS(EFFECT) };

const plumb_effect *plumb_effects(int *count)
{
    if (count != NULL) {
        *count = (int)(sizeof effects / sizeof effects[0]);
    }
    return effects;
}
