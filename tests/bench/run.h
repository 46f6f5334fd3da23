/// run.h - one engine on one scene, in a process of its own.
#ifndef BENCH_RUN_H
#define BENCH_RUN_H

#include "scene.h"

/// An engine with the settings it runs under: one column of the comparison.
struct contender {
    char label[32]; ///< as given on the command line: name[:width][:solver][:tN]
    const struct engine *engine;
    int width;          ///< 0: the engine's choice
    int workers;        ///< threads; 0: one
    const char *solver; ///< NULL: the engine's choice
};

/// What all runs have in common.
struct run_settings {
    double steps_scale; ///< [-] factor on every scene's number of steps
    int substeps;       ///< 0: the engine's default
    bool sleep;         ///< let bodies sleep where the scene's origin does
    bool cpu_clock;     ///< time by the processor time of the process instead of elapsed time
    int core;           ///< to be pinned to, with more threads to those after it as well; < 0: none
    int sample_every;   ///< [steps] between two measurements of penetration
};

enum run_status {
    RUN_DONE,
    RUN_UNSUPPORTED, ///< the engine lacks a shape of the scene
    RUN_FAILED,      ///< the engine refused, or memory ran out
    RUN_CRASHED      ///< the process ended by a signal: see `signal`
};

/// Penetration over a run.
struct overlap {
    double mean;     ///< [m] over all overlapping pairs of all samples
    double max;      ///< [m] over all samples
    double end_mean; ///< [m] mean at the end
    double end_p99;  ///< [m] 99th percentile at the end
    long end_pairs;  ///< overlapping at the end
    double sum;      ///< [m] of all depths
    long pairs;      ///< of all samples
};

/// Separation of hinges over a run; all 0 without hinges.
struct apart {
    double mean;     ///< [m] over all hinges of all samples
    double max;      ///< [m] over all samples
    double end_mean; ///< [m] at the end
    double end_max;  ///< [m]
    double sum;      ///< [m] of all samples
    long hinges;     ///< of all samples
};

/// Result of one run. Timed runs fill times and memory, quality runs the rest.
struct run_result {
    enum run_status status;
    int signal;
    double mean_ms;      ///< [ms] a step
    double worst_ms;     ///< [ms] the slowest step
    long peak_bytes;     ///< growth of the resident set from before the world to its largest
    size_t engine_bytes; ///< what the engine says it holds at the end; 0: it cannot tell
    struct engine_counts counts; ///< at the end
    long astray;                 ///< bodies lost: not finite, or farther than 1 km
    double skin;                 ///< [m] of the engine: see struct engine
    struct overlap drawn;        ///< of the shapes as they were given
    struct overlap own;          ///< of the engine's own surfaces, skin included; equal without one
    struct apart apart;          ///< of hinges
};

/// Runs and times; poses are not looked at.
struct run_result run_timed(const struct scene_row *row, const struct scene *scene,
                            const struct contender *contender, const struct run_settings *settings);

/// Runs and measures penetration; not timed.
struct run_result run_quality(const struct scene_row *row, const struct scene *scene,
                              const struct contender *contender,
                              const struct run_settings *settings);

#endif
