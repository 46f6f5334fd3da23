/// table.c - see table.h.
#include "table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool ends_with(const char *text, const char *end)
{
    size_t a = strlen(text), b = strlen(end);
    return a >= b && strcmp(text + a - b, end) == 0;
}

/// Devices (/dev/stdout) and "-" have none and get CSV.
static bool has_extension(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    return dot != NULL && dot != name;
}

int table_read_format(const cli_command *command, const char *output, int *format)
{
    if (*format >= 0) {
        return CLI_OK;
    }
    *format = TABLE_CSV;
    const char *path = output != NULL ? output : "";
    if (ends_with(path, ".jsonl") || ends_with(path, ".ndjson")) {
        *format = TABLE_JSONL;
    } else if (ends_with(path, ".json")) {
        cli_message("%s: option --output: JSON lines are named .jsonl; --format jsonl writes "
                    "them to '%.200s' all the same",
                    command->name, path);
        return CLI_USAGE;
    } else if (has_extension(path) && !ends_with(path, ".csv")) {
        cli_message(
            "%s: option --output: '%.200s' does not end in .csv, .jsonl or .ndjson; --format "
            "csv or --format jsonl writes to it all the same",
            command->name, path);
        return CLI_USAGE;
    }
    return CLI_OK;
}

int table_read_every(const cli_command *command, const char *text, table_sampling *every)
{
    *every = (table_sampling){ .steps = 1 };
    if (text == NULL) {
        return CLI_OK;
    }
    char *end;
    double number = strtod(text, &end);
    bool is_time = strcmp(end, "s") == 0;
    bool is_steps = *end == '\0' && number == floor(number);
    if (end == text || !isfinite(number) || number <= 0 || number > 1e15 ||
        (!is_time && !is_steps)) {
        cli_message("%s: option --every: '%.60s' is neither a number of steps (10) nor a time "
                    "(0.5s)",
                    command->name, text);
        return CLI_USAGE;
    }
    *every = (table_sampling){ .steps = is_time ? 0 : (long long)number,
                               .seconds = is_time ? number : 0 };
    return CLI_OK;
}

bool table_is_sample(const table_sampling *every, long long step, double dt)
{
    if (every->steps > 0) {
        return step % every->steps == 0;
    }
    // The first step at or after each multiple of `seconds`.
    double now = ((double)step * dt + 1e-9 * dt) / every->seconds;
    double before = ((double)(step - 1) * dt + 1e-9 * dt) / every->seconds;
    return step == 0 || floor(now) > floor(before);
}

void table_print_header(FILE *file, int format)
{
    if (format == TABLE_CSV) {
        fputs("time [s],name,x [m],y [m],angle [rad],vx [m/s],vy [m/s],w [rad/s]\n", file);
    }
}

void table_print_row(FILE *file, int format, bool is_float, double time, const engine_row *row)
{
    static const char *const keys[] = { ",\"x\":",  ",\"y\":",  ",\"angle\":",
                                        ",\"vx\":", ",\"vy\":", ",\"w\":" };
    const double numbers[] = { row->x, row->y, row->angle, row->vx, row->vy, row->w };
    bool is_csv = format == TABLE_CSV;

    // Twelve digits tell steps of a microsecond apart for eleven days and hide the roundings of
    // step * dt.
    fprintf(file, is_csv ? "%.12g," : "{\"time\":%.12g,\"name\":", time);
    if (is_csv) {
        cli_print_csv(file, row->name);
    } else {
        cli_print_json(file, row->name);
    }
    for (int i = 0; i < 6; i++) {
        fputs(is_csv ? "," : keys[i], file);
        cli_print_number(file, numbers[i], is_float);
    }
    fputs(is_csv ? "\n" : "}\n", file);
}
