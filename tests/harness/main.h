/// main.h - what the command line gave to a test, its name first.
#ifndef HARNESS_MAIN_H
#define HARNESS_MAIN_H

extern int test_argument_count;
extern char **test_arguments;

#endif
