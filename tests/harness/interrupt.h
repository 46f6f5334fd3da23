// interrupt.h - main programs that stop at SIGINT and SIGTERM with what they have: cli_interrupted() of plumb/cli.h, asked by
// the parts of the command line that they are linked with, says so from then on.
#ifndef HARNESS_INTERRUPT_H
#define HARNESS_INTERRUPT_H

void catch_interrupts(void);

#endif
