// table.c - the soak as a table: `make soak`. Arguments: steps (1,000,000), a seed (1). Exit status 1 when anything went wrong.
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "harness/soak.h"

static void tell(const soak_row *row)
{
    printf("| %" PRIu64 " | %" PRIu32 " | %" PRIu32 " | %" PRIu32 " | %" PRIu32
           " | %zu | %zu | %zu | %016" PRIx64 " |\n",
           row->step, row->bodies, row->asleep, row->contacts, row->joints, row->image_bytes / 1024,
           row->bytes / 1024, row->resident_bytes / 1024, row->hash);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    const soak_plan plan = { .steps = argc > 1 ? strtoull(argv[1], NULL, 10) : 1000000,
                             .seed = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 1,
                             .tell = tell };
    soak_report report;
    printf("| steps | bodies | asleep | contacts | joints | image [KiB] | world [KiB] | process "
           "[KiB] | hash |\n"
           "|---|---|---|---|---|---|---|---|---|\n");
    const bool good = soak_run(&plan, &report);
    printf("\n%" PRIu64 " bodies made, %" PRIu64 " destroyed; %" PRIu64 " fell asleep, %" PRIu64
           " woke; %" PRIu64 " joints broke; %" PRIu64 " times back by %d steps\n",
           report.made, report.destroyed, report.fell_asleep, report.woke, report.broken,
           report.rollbacks, SOAK_AHEAD);
    if (!good) {
        printf("step %" PRIu64 ": %s\n", report.fault_step, report.fault);
    }
    return good ? 0 : 1;
}
