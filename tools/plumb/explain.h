/// explain.h - what `plumb explain` has found out, for those that print it.
#ifndef PLUMB_EXPLAIN_H
#define PLUMB_EXPLAIN_H

#include "scene_args.h"

/// In how many steps a pass ran, and why when it last did: what falls asleep leaves the schedule. Of one
/// that never ran, why it did not in the first step.
typedef struct pass_tally {
    char name[64], reason[128];
    long long steps;
    engine_because because; ///< where it visited most
} pass_tally;

typedef struct tally {
    pass_tally *items;
    int count, room;
} tally;

typedef struct explain_report {
    const scene_run *run;
    const char *path; ///< of the scene
    const engine_pass *list;
    int count;
    const tally *tally;
    const engine_finding *unused;
    int unused_count;
    double total; ///< [ns] of all passes; 0: no timing
} explain_report;

/// NULL: it has none yet.
pass_tally *explain_find(const tally *t, const engine_pass *pass);

/// explain_json.c: all of it on stdout.
void explain_json(const explain_report *report);
/// explain_flow.c: passes as rows, data as columns, as SVG. CLI_FAILED after a message.
/// False after a message: it is not the name of an SVG.
bool explain_flow_names(const char *path);
int explain_flow(const explain_report *report, const char *path);

#endif
