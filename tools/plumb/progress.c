/// progress.c - a progress bar with the time that is left, on stderr, only on a terminal.
///
/// Reads the monotonic clock, writes stderr. Cost: a clock reading an update, a line ten times
/// a second. Work that is done within 0.3 s shows no bar at all.
#define _POSIX_C_SOURCE 200809L // clock_gettime, isatty, fileno

#include "cli.h"

#include <string.h>
#include <time.h>
#include <unistd.h>

enum { BAR_WIDTH = 28 };

static const double QUIET_TIME = 0.3;  // [s] before the bar appears
static const double REDRAW_TIME = 0.1; // [s] between two drawings

// [s] on a monotonic clock.
static double monotonic_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void progress_begin(progress *bar, const char *label, double total, bool quiet)
{
    *bar = (progress){ .total = total, .on = !quiet && total > 0 && isatty(fileno(stderr)) };
    snprintf(bar->label, sizeof bar->label, "%s", label);
    bar->started = monotonic_now();
}

static void print_time(double seconds)
{
    long whole = (long)(seconds + 0.5);
    if (whole >= 3600) {
        fprintf(stderr, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    } else {
        fprintf(stderr, "%ld:%02ld", whole / 60, whole % 60);
    }
}

void progress_update(progress *bar, double done)
{
    if (!bar->on) {
        return;
    }
    double now = monotonic_now();
    if (now - bar->started < QUIET_TIME || now - bar->shown < REDRAW_TIME) {
        return;
    }
    double share = done / bar->total;
    share = share < 0 ? 0 : share > 1 ? 1 : share;
    int full = (int)(share * BAR_WIDTH);
    fprintf(stderr, "\r%s [", bar->label);
    for (int i = 0; i < BAR_WIDTH; i++) {
        fputc(i < full ? '#' : '.', stderr);
    }
    fprintf(stderr, "] %3d%%  ", (int)(share * 100));
    if (share > 0.01) {
        print_time((now - bar->started) * (1 - share) / share);
        fputs(" left", stderr);
    }
    fputs("\033[K", stderr); // clears what a longer line has left behind
    fflush(stderr);
    bar->shown = now;
    bar->drawn = true;
}

void progress_end(progress *bar)
{
    if (bar->drawn) {
        fputs("\r\033[K", stderr);
        fflush(stderr);
    }
    bar->on = bar->drawn = false;
}
