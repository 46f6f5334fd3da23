/// report.h - the benchmark's tables and its CSV file.
#ifndef BENCH_REPORT_H
#define BENCH_REPORT_H

#include "run.h"

#include <stdio.h>

/// One contender on one scene, all repeats taken together.
struct row_result {
    enum run_status status;
    int signal;
    double median_ms; ///< [ms] a step: median over the repeats of the mean over the run
    double min_ms;    ///< [ms] a step: the fastest repeat
    double worst_ms;  ///< [ms] slowest step, median over the repeats
    long peak_bytes;  ///< median over the repeats
    size_t engine_bytes;
    struct run_result quality;
};

/// Machine, compiler, and what each contender is: one line each.
void report_machine(const struct contender *contenders, int count);

void report_header(void);
/// The rows of one scene; ratios are against contender 0.
void report_scene(const struct scene_row *row, const struct contender *contenders,
                  const struct row_result *results, int count);
/// Times of all scenes side by side, their ratios and the geometric means of these.
/// `results` holds `count` entries a scene.
void report_summary(const struct scene_row *const *rows, int row_count,
                    const struct contender *contenders, const struct row_result *results,
                    int count);

/// CSV: the header line, then one line a scene and contender.
void report_csv_header(FILE *file);
void report_csv_scene(FILE *file, const struct scene_row *row, const struct contender *contenders,
                      const struct row_result *results, int count);

#endif
