/// soak.h - a busy small world for as many steps as one likes, twice at once: is memory flat, is all finite, are the bits the same?
///
///     soak_report report;
///     bool good = soak_run(&(soak_plan){ .steps = 5000, .seed = 1 }, &report);
///
/// Crates, discs, capsules, outlines, ragdolls, chains, breaking joints, sleepers, sensors, a belt, a lift, a one-way ledge,
/// two characters, water, wind, an attractor that comes and goes, liquid now and then; bodies are made and destroyed all the
/// time, never more than SOAK_BODIES of them; dt changes.
///
/// The first world goes back every SOAK_BACK steps and takes its steps again; the second one goes straight on, with other
/// lanes and a number of threads that changes. What is done follows from the seed and the world's state alone.
#ifndef HARNESS_SOAK_H
#define HARNESS_SOAK_H

#include "plumb/plumb.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SOAK_BODIES = 40, SOAK_BACK = 64, SOAK_AHEAD = 12 };

/// At a step.
typedef struct soak_row {
    uint64_t step;
    uint32_t bodies, asleep, contacts, joints;
    size_t bytes;          ///< [B] the most that the straight world held since the row before
    size_t image_bytes;    ///< [B] of its snapshot
    size_t resident_bytes; ///< [B] of the process, by Linux; 0: not told
    uint64_t hash;
} soak_row;

typedef struct soak_report {
    soak_row last;
    uint64_t made, destroyed, fell_asleep, woke, broken, rollbacks; ///< in the straight world
    const char *fault;   ///< what went wrong first, NULL: nothing
    uint64_t fault_step; ///< when
} soak_report;

typedef struct soak_plan {
    uint64_t steps;
    uint32_t seed;
    /// Called after steps 10^n, and after the last one. May be NULL.
    void (*tell)(const soak_row *row);
} soak_plan;

/// True: nothing went wrong. Memory has grown when the most that a world holds in the last tenth of the steps is more than
/// SOAK_GROWTH times the most of the first tenth, or of the first 10,000 steps.
bool soak_run(const soak_plan *plan, soak_report *report);
#define SOAK_GROWTH 1.5

#endif
