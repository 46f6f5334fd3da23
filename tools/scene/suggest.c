// suggest.c - "did you mean": the known word that is fewest slips of the pen away.
// Also what other engines call our words, which no distance finds. Cost: O(length of word * length of
// candidate) a candidate, only on the way to an error.
#include <string.h>

#include "internal.h"
#include "slips.h"

sc_suggest sc_suggest_start(const char *word)
{
    // One slip in words up to 6 letters, one more every 4: "desnity" finds "density", "w" nothing,
    // and "frction" not "duration", which is 3 slips away.
    int slips = ((int)strlen(word) + 1) / 4;
    return (sc_suggest){ .word = word, .distance = (slips > 1 ? slips : 1) + 1 };
}

void sc_suggest_offer(sc_suggest *g, const char *candidate)
{
    int d = sc_slips(g->word, candidate);
    if (d >= (int)strlen(candidate) || d > g->distance || strlen(candidate) >= sizeof g->best) {
        return;
    }
    if (d < g->distance || (g->best[0] != 0 && strcmp(candidate, g->best) < 0)) {
        g->distance = d;
        snprintf(g->best, sizeof g->best, "%s", candidate);
    }
}

void sc_suggest_force(sc_suggest *g, const char *candidate)
{
    snprintf(g->best, sizeof g->best, "%s", candidate);
    g->distance = 0;
}

const char *sc_suggest_best(const sc_suggest *g)
{
    return g->best[0] != 0 ? g->best : NULL;
}

// clang-format off
const sc_synonym sc_synonyms[] = {
    { "position", "at" },
    { "rotation", "angle" },
    { "angular_velocity", "spin" },
    { "omega", "spin" },
    { "bounce", "restitution" },
    { "elasticity", "restitution" },
    { "radius", "r" },
    { "width", "w" },
    { "height", "h" },
    { "linear_velocity", "velocity" },
    { "time_step", "dt" },
    { "colour", "color" },
    { "seconds", "duration" },
    { "rounding", "round" },
    { "sides", "n" },
    { "anchor", "at" },
    { "anchor_a", "at_a" },
    { "anchor_b", "at_b" },
    { "limit", "limits" },
    { "hertz", "frequency" },
    { "stiffness", "frequency" },
    { "teeth", "pitch" },
    { "group", "apart" },
    { "mask", "collides" },
    { "layer", "category" },
    { "body_a", "a" },
    { "body_b", "b" },
    { "ground_a", "wheel_a" },
    { "ground_b", "wheel_b" },
    { "rolling_friction", "rolling_resistance" },
    { "static_friction", "friction" },
    { "dynamic_friction", "kinetic_friction" },
    { "sliding_friction", "kinetic_friction" },
    { "trigger", "sensor" },
    { "is_sensor", "sensor" },
    { "bullet", "continuous" },
    { "is_bullet", "continuous" },
    { "ccd", "continuous" },
    { "linear_damping", "damping" },
    { "spin_damping", "angular_damping" },
    { "can_sleep", "sleep" },
    { NULL, NULL },
};

const sc_synonym sc_absent_names[] = {
    { "math.random", "random(a, b) and random_int(a, b) follow scene{seed}" },
    { "math.randomseed", "scene{seed = 1} begins random(a, b) and random_int(a, b)" },
    { "string.match", "string.find(text, word) finds plain text" },
    { "string.gmatch", "string.find(text, word) finds plain text" },
    { "string.gsub", "string.find(text, word) finds plain text" },
    { "table.move", "a loop copies as well" },
    { "pcall", "a script ends with its first error" },
    { "xpcall", "a script ends with its first error" },
    { "os", "a scene knows no clock but time()" },
    { "io", "a scene reads and writes no files" },
    { "require", "a scene is one file" },
    { "dofile", "a scene is one file" },
    { "load", "a scene is one file" },
    { "setmetatable", "a scene has plain tables" },
    { "coroutine", "at(), every() and every_step() come back later" },
    { "next", "pairs(t) goes in sorted order" },
    { "rawget", "a scene has plain tables" },
    { "friction", "it is a key: material{ friction = 0.5 }" },
    { "restitution", "it is a key: material{ restitution = 0.5 }" },
    { "density", "it is a key: material{ density = 2 }" },
    { "gravity", "it is a key: scene{ gravity = {0, -9.81} }" },
    { NULL, NULL },
};

const sc_synonym sc_other_names[] = {
    { "rod", "distance" },
    { "spring", "distance" },
    { "hinge", "revolute" },
    { "pin", "revolute" },
    { "slider", "prismatic" },
    { "axle", "wheel" },
    { "fixed", "weld" },
    { "sensor", "body" },
    { "on_begin", "on_contact" },
    { "on_trigger", "on_enter" },
    { "filter", "exclude" },
    { NULL, NULL },
};
// clang-format on
