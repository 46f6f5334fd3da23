// report.c - what the benchmark prints. Reads: results. Writes: stdout and the CSV file.
#include "report.h"

#include <math.h>
#include <string.h>

static void machine_name(char *name, size_t size)
{
    snprintf(name, size, "unknown processor");
    FILE *file = fopen("/proc/cpuinfo", "r");
    if (file == NULL) {
        return;
    }
    char line[256];
    while (fgets(line, (int)sizeof line, file) != NULL) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && colon != NULL) {
            snprintf(name, size, "%s", colon + 1 + strspn(colon + 1, " \t"));
            name[strcspn(name, "\n")] = '\0';
            break;
        }
    }
    fclose(file);
}

void report_machine(const struct contender *contenders, int count)
{
    char text[256];
    machine_name(text, sizeof text);
#if defined(__clang__)
    const char *compiler = "clang " __clang_version__;
#else
    const char *compiler = "gcc " __VERSION__;
#endif
    printf("machine: %s; bench compiled by %s\n", text, compiler);
    for (int i = 0; i < count; ++i) {
        contenders[i].engine->describe(text, sizeof text);
        printf("%s: %s\n", contenders[i].label, text);
    }
}

static const char *status_text(const struct row_result *r)
{
    static const char *const texts[] = { "done", "has no such shape", "failed", "crashed" };
    return texts[r->status];
}

static long bytes_per_body(const struct row_result *r)
{
    int bodies = r->quality.counts.bodies;
    return r->peak_bytes / (bodies > 0 ? bodies : 1);
}

static double ratio(const struct row_result *r, const struct row_result *base)
{
    return base->status == RUN_DONE && base->median_ms > 0.0 ? r->median_ms / base->median_ms
                                                             : (double)NAN;
}

void report_header(void)
{
    printf("\n%-14s %-12s %6s %6s %6s | %9s %9s %9s %6s | %9s %9s %9s %9s | %9s %9s %9s %9s | "
           "%7s %6s\n",
           "", "", "", "", "", "ms/step", "ms/step", "ms", "", "mm mean", "mm max", "mm mean",
           "mm p99", "joint mm", "joint mm", "joint mm", "joint mm", "bytes", "");
    printf("%-14s %-12s %6s %6s %6s | %9s %9s %9s %6s | %9s %9s %9s %9s | %9s %9s %9s %9s | "
           "%7s %6s\n",
           "scene", "engine", "bodies", "touch", "joints", "median", "min", "worst", "ratio",
           "whole run", "whole run", "at end", "at end", "mean", "max", "mean, end", "max, end",
           "a body", "astray");
}

// A ratio as text, or a dash where there is nothing to divide by.
static const char *ratio_text(char *text, size_t size, const struct row_result *r,
                              const struct row_result *base)
{
    double x = ratio(r, base);
    if (x > 0.0) {
        snprintf(text, size, "%.2f", x);
        return text;
    }
    return "-";
}

static void print_overlap(const struct overlap *o)
{
    printf("%9.2f %9.1f %9.2f %9.1f", o->mean * 1e3, o->max * 1e3, o->end_mean * 1e3,
           o->end_p99 * 1e3);
}

static void print_apart(const struct run_result *q)
{
    if (q->counts.joints > 0) {
        const struct apart *a = &q->apart;
        printf("%9.2f %9.2f %9.2f %9.2f", a->mean * 1e3, a->max * 1e3, a->end_mean * 1e3,
               a->end_max * 1e3);
    } else {
        printf("%9s %9s %9s %9s", "-", "-", "-", "-");
    }
}

void report_scene(const struct scene_row *row, const struct contender *contenders,
                  const struct row_result *results, int count)
{
    for (int i = 0; i < count; ++i) {
        const struct row_result *r = &results[i];
        const struct run_result *q = &r->quality;
        char text[32];
        printf("%-14s %-12s ", row->name, contenders[i].label);
        if (r->status != RUN_DONE) {
            printf("%s", status_text(r));
            if (r->status == RUN_CRASHED) {
                printf(" (signal %d)", r->signal);
            }
            printf("\n");
            continue;
        }
        printf("%6d %6d %6d | %9.3f %9.3f %9.3f %6s | ", q->counts.bodies, q->counts.contacts,
               q->counts.joints, r->median_ms, r->min_ms, r->worst_ms,
               ratio_text(text, sizeof text, r, &results[0]));
        print_overlap(&q->drawn);
        printf(" | ");
        print_apart(q);
        printf(" | %7ld %6ld\n", bytes_per_body(r), q->astray);
        if (q->skin > 0.0) {
            printf("%48s | %25s of %5.1f mm | ", "", "with its skin", q->skin * 1e3);
            print_overlap(&q->own);
            printf(" |\n");
        }
    }
    fflush(stdout);
}

void report_summary(const struct scene_row *const *rows, int row_count,
                    const struct contender *contenders, const struct row_result *results, int count)
{
    printf("\nmean ms a step (median of the repeats), and as a multiple of %s\n%-14s",
           contenders[0].label, "scene");
    for (int i = 0; i < count; ++i) {
        printf(" %20s", contenders[i].label);
    }
    printf("\n");
    for (int s = 0; s < row_count; ++s) {
        printf("%-14s", rows[s]->name);
        for (int i = 0; i < count; ++i) {
            const struct row_result *r = &results[s * count + i];
            char text[32];
            if (r->status == RUN_DONE) {
                printf(" %10.3f (%6sx)", r->median_ms,
                       ratio_text(text, sizeof text, r, &results[s * count]));
            } else {
                printf(" %20s", "-");
            }
        }
        printf("\n");
    }
    printf("%-14s", "geometric mean");
    for (int i = 0; i < count; ++i) {
        double sum = 0.0;
        int used = 0;
        for (int s = 0; s < row_count; ++s) {
            const struct row_result *r = &results[s * count + i];
            double x = r->status == RUN_DONE ? ratio(r, &results[s * count]) : (double)NAN;
            if (x > 0.0) {
                sum += log(x);
                ++used;
            }
        }
        if (used > 0) {
            printf(" %18.2fx ", exp(sum / used));
        } else {
            printf(" %20s", "-");
        }
    }
    printf("\n");
}

void report_csv_header(FILE *file)
{
    fputs("scene,engine,status,bodies,touching,median_ms,min_ms,worst_ms,ratio,"
          "peak_bytes_per_body,engine_bytes,astray,"
          "mean_depth_mm,max_depth_mm,end_mean_depth_mm,end_p99_depth_mm,end_overlapping_pairs,"
          "skin_mm,own_mean_depth_mm,own_max_depth_mm,own_end_mean_depth_mm,"
          "own_end_p99_depth_mm,own_end_overlapping_pairs,"
          "joints,joint_mean_mm,joint_max_mm,joint_end_mean_mm,joint_end_max_mm\n",
          file);
}

static void csv_overlap(FILE *file, const struct overlap *o)
{
    fprintf(file, ",%.6g,%.6g,%.6g,%.6g,%ld", o->mean * 1e3, o->max * 1e3, o->end_mean * 1e3,
            o->end_p99 * 1e3, o->end_pairs);
}

void report_csv_scene(FILE *file, const struct scene_row *row, const struct contender *contenders,
                      const struct row_result *results, int count)
{
    for (int i = 0; i < count; ++i) {
        const struct row_result *r = &results[i];
        const struct run_result *q = &r->quality;
        fprintf(file, "%s,%s,%s,%d,%d,%.6g,%.6g,%.6g,%.6g,%ld,%zu,%ld", row->name,
                contenders[i].label, status_text(r), q->counts.bodies, q->counts.contacts,
                r->median_ms, r->min_ms, r->worst_ms, ratio(r, &results[0]), bytes_per_body(r),
                r->engine_bytes, q->astray);
        csv_overlap(file, &q->drawn);
        fprintf(file, ",%.6g", q->skin * 1e3);
        csv_overlap(file, &q->own);
        fprintf(file, ",%d,%.6g,%.6g,%.6g,%.6g", q->counts.joints, q->apart.mean * 1e3,
                q->apart.max * 1e3, q->apart.end_mean * 1e3, q->apart.end_max * 1e3);
        fputs("\n", file);
    }
    fflush(file);
}
