// interrupt.c - see interrupt.h.
#define _POSIX_C_SOURCE 200809L // sigaction

#include "harness/interrupt.h"

#include "plumb/cli.h"

#include <signal.h>

static volatile sig_atomic_t stopped;

static void on_stop(int number)
{
    (void)number;
    stopped = 1;
}

bool cli_interrupted(void)
{
    return stopped != 0;
}

void catch_interrupts(void)
{
    struct sigaction stop = { .sa_handler = on_stop };
    sigemptyset(&stop.sa_mask);
    sigaction(SIGINT, &stop, NULL);
    sigaction(SIGTERM, &stop, NULL);
}
