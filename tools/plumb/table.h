/// table.h - the table of where bodies are, as `run` and `replay` print it: CSV or JSON lines.
#ifndef PLUMB_TABLE_H
#define PLUMB_TABLE_H

#include "engine.h"

enum { TABLE_CSV, TABLE_JSONL };

/// Rows are printed at step 0, then every `steps` steps or whenever `seconds` have gone by.
typedef struct table_sampling {
    long long steps;
    double seconds;
} table_sampling;

/// Where *format is -1, it follows from the name of the output file (NULL: stdout). CLI_OK or
/// CLI_USAGE after a message.
int table_read_format(const cli_command *command, const char *output, int *format);
/// "10": every tenth step, "0.5s": every half second; NULL: every step. CLI_OK or CLI_USAGE after a
/// message.
int table_read_every(const cli_command *command, const char *text, table_sampling *every);
/// True when step `step` is to be printed.
bool table_is_sample(const table_sampling *every, long long step, double dt);
void table_print_header(FILE *file, int format);
void table_print_row(FILE *file, int format, bool is_float, double time, const engine_row *row);

#endif
