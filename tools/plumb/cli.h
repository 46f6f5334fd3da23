/// cli.h - what the commands of `plumb` share: exit codes, the option table and its parser,
/// output files that appear only when complete, the progress bar.
///
/// A command is a row of data (cli_command) and a function. The option table is the one truth:
/// the parser, the range checks, the suggestions and --help are all made from it.
#ifndef PLUMB_CLI_H
#define PLUMB_CLI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/// Exit codes of the program.
typedef enum cli_exit {
    CLI_OK = 0,
    CLI_FAILED = 1,   ///< at run time: a file, memory, the disk, a picture
    CLI_USAGE = 2,    ///< the command line is wrong
    CLI_SCENE = 3,    ///< the scene is wrong
    CLI_EXPECT = 4,   ///< an expectation of a scene does not hold
    CLI_DIVERGED = 5, ///< the state of the world is no longer finite
    CLI_DIFFERS = 6,  ///< two recordings differ, or a replay gives other bits than were recorded
    CLI_HELP = -1     ///< cli_parse only: help was printed, the command is done
} cli_exit;

/// What an option's value is and what it is stored as, at `offset` of the command's struct.
typedef enum cli_type {
    CLI_FLAG,    ///< bool, no value
    CLI_INT,     ///< int in min..max
    CLI_REAL,    ///< double in min..max; "1/60" is a number, too
    CLI_TEXT,    ///< const char *
    CLI_TEXTS,   ///< cli_texts, the option may be repeated
    CLI_CHOICE,  ///< int: index into `choices`
    CLI_CHOICES, ///< unsigned: a bit for each of `choices` in a comma list
    CLI_INTS,    ///< cli_ints: a comma list of ints in min..max
    CLI_SIZE     ///< cli_size: "960x540", each in min..max
} cli_type;

/// Most repetitions of one option, and most members of a comma list.
#define CLI_TEXTS_MAX 64
#define CLI_INTS_MAX  32

/// Values of a repeated option; they point into argv.
typedef struct cli_texts {
    const char *items[CLI_TEXTS_MAX];
    int count;
} cli_texts;

typedef struct cli_ints {
    int items[CLI_INTS_MAX];
    int count;
} cli_ints;

typedef struct cli_size {
    int width, height;
} cli_size;

/// One option.
typedef struct cli_option {
    const char *name; ///< long name, without the dashes
    char letter;      ///< short name, 0 = none
    cli_type type;
    size_t offset;       ///< [B] of the value in the command's struct
    const char *value;   ///< what the value is called in the help, NULL for flags
    double min, max;     ///< CLI_INT, CLI_REAL, CLI_INTS, CLI_SIZE: allowed range
    const char *choices; ///< CLI_CHOICE, CLI_CHOICES: "soft,pgs"
    const char *help;    ///< one sentence with unit and default
} cli_option;

typedef struct cli_command {
    const char *name;
    const char *summary;  ///< one line for the list of commands
    const char *operands; ///< as in the usage line: "SCENE"
    const char *text;     ///< a paragraph, broken into lines by the help
    const char *examples; ///< command lines, one each line
    const cli_option *options;
    int option_count;
    int operand_min, operand_max;
    int (*run)(const struct cli_command *command, int argc, char **argv); ///< answers a cli_exit
} cli_command;

/// Operands found by cli_parse.
typedef struct cli_operands {
    char **items; ///< in argv, which is put in order for that
    int count;
} cli_operands;

/// Reads argv[1..] into `values` (a struct with its defaults already in place) by the table.
/// Answers CLI_OK, CLI_HELP (printed), or CLI_USAGE (a message went to stderr).
/// Operands are moved to the front of argv.
int cli_parse(const cli_command *command, int argc, char **argv, void *values,
              cli_operands *operands);

/// Prints the help of a command to stdout.
void cli_help(const cli_command *command);

/// A status with which the program ends.
typedef struct cli_exit_text {
    int code;
    const char *text;
} cli_exit_text;

/// Prints the manual page of all commands to stdout, in the macros of man(7). CLI_MAN_DATE: of the last change of
/// the command line.
#define CLI_MAN_DATE "2026-11-23"
void cli_man(const cli_command *const *commands, int count, const char *summary,
             const cli_exit_text *exits, int exit_count);

/// How many slips of the pen, and one more, may lie between `word` and what was meant.
int cli_slips(const char *word);
/// True when fewer than *slips lie between `word` and `name`; *slips, at first cli_slips(word), becomes their number.
bool cli_nearer(const char *word, const char *name, int *slips);
/// The name in the comma list `names` nearest to `word`, or -1 when none is near; its index.
int cli_nearest(const char *word, const char *names);
/// Copies member `index` of a comma list into `out`; false when there is no such member.
bool cli_member(const char *list, int index, char *out, size_t out_size);

/// Prints "plumb: ..." as one line to stderr.
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
void cli_message(const char *format, ...);

/// Completes stdout: `code`, or CLI_FAILED with a message when what was printed did not arrive.
/// A reader that went away (`| head`) is no error.
int cli_finish(int code);

/// True once the user has asked to stop (SIGINT, SIGTERM). Loops look at it and clean up.
bool cli_interrupted(void);

// ------------------------------------------------------------------------------------- output

/// A file being written: beside its name first, renamed when complete. Or stdout.
typedef struct cli_output {
    FILE *file;
    char *path; ///< NULL: stdout
    char *temp; ///< NULL: written in place (stdout, devices, pipes)
    int guard;  ///< of cli_output_guard
    int reason; ///< errno of a write that failed, 0: none, or unknown
} cli_output;

/// A file that a command line names.
typedef struct cli_file {
    const char *what; ///< for messages: "SCENE", "--output"
    const char *path; ///< NULL: not given; "-" of what is written: stdout
    bool is_written;
} cli_file;

/// No file is written that is read or written under another name, however it is spelled: links are followed.
/// Devices and pipes may be named twice. CLI_OK, or CLI_USAGE after a message.
int cli_files_check(const cli_command *command, const cli_file *files, int count);
/// The name of a file without links, also of one that is not there yet. To be freed; NULL: errno says why.
char *cli_resolve(const char *path);
/// True when the name is that of a symbolic link.
bool cli_is_link(const char *path);

/// Opens `path` (NULL or "-": stdout). CLI_OK, or CLI_FAILED after a message.
int cli_output_open(cli_output *out, const char *path);
/// True as long as writing makes sense; false after a write error or when the reader is gone.
bool cli_output_good(const cli_output *out);
/// Closes. `keep` false throws an unfinished file away. Answers CLI_OK, or CLI_FAILED after a
/// message (disk full, ...).
int cli_output_close(cli_output *out, bool keep);

/// Says that `temp` is being written, for the case that a signal ends the program in the midst: it is then removed,
/// or renamed to `path` if that is not NULL. Both must stay where they are until cli_output_unguard. Answers a number
/// for that, -1 when too many are being written.
int cli_output_guard(const char *temp, const char *path);
void cli_output_unguard(int guard);
/// A file of which a beginning is worth keeping: a recording.
void cli_output_keep_beginning(cli_output *out);
/// Removes, or renames, what is guarded. Calls nothing that a signal handler may not.
void cli_output_abandon(void);

/// Prints a number in as few digits as give the same number back: of a float or of a double.
void cli_print_number(FILE *file, double value, bool is_float);
/// Prints a field of a CSV line, in quotes when it must be.
void cli_print_csv(FILE *file, const char *text);
/// Prints a JSON string with its quotes.
void cli_print_json(FILE *file, const char *text);

// ----------------------------------------------------------------------------------- progress

/// A progress bar on stderr; silent when that is not a terminal.
typedef struct progress {
    bool on, drawn;
    double total;   ///< in the caller's unit
    double started; ///< [s] on the monotonic clock
    double shown;   ///< [s] when last drawn
    char label[64];
} progress;

/// Starts a bar that is complete at `total` (> 0). `quiet`: never draw.
void progress_begin(progress *bar, const char *label, double total, bool quiet);
/// Says how much is done; draws at most ten times a second.
void progress_update(progress *bar, double done);
/// Removes the bar from the screen.
void progress_end(progress *bar);

#endif
