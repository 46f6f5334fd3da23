/// main.c - `plumb`: picks the command and makes the process well-behaved.
///
/// Reads argv. SIGPIPE is ignored, so that a reader who leaves is seen as a write error and files
/// half written can be removed; SIGINT and SIGTERM set a flag that the loops look at, for the same
/// reason. What does not look in time (a step of a huge world, a replay that seeks) is ended by a timer; a second
/// SIGINT ends the program at once.
#define _XOPEN_SOURCE 700 // sigaction, fcntl, setitimer

#include "commands.h"

#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

#include "plumb/base.h"

static const cli_command *const commands[] = { &cmd_run,     &cmd_render, &cmd_check,
                                               &cmd_explain, &cmd_cost,   &cmd_convert,
                                               &cmd_replay,  &cmd_diff,   &cmd_list };

enum { COMMAND_COUNT = (int)(sizeof commands / sizeof commands[0]) };

// The one thing a signal handler may write.
static volatile sig_atomic_t stop_signal;

// [us] of processor time that remains to end in order. Not of the clock: a busy machine takes nothing from it.
enum { GRACE = 100000 };

static void on_stop(int number)
{
    const struct itimerval grace = { .it_value = { .tv_usec = GRACE } };
    stop_signal = number;
    setitimer(ITIMER_PROF, &grace, NULL); // in Linux and the BSDs nothing but a system call
}

// Ends the program where it stands, as the signal would have.
static void on_late(int number)
{
    (void)number;
    cli_output_abandon();
    signal(stop_signal, SIG_DFL);
    raise(stop_signal);
}

bool cli_interrupted(void)
{
    return stop_signal != 0;
}

static void set_signals(void)
{
    struct sigaction ignore = { .sa_handler = SIG_IGN };
    struct sigaction stop = { .sa_handler = on_stop, .sa_flags = (int)SA_RESETHAND };
    struct sigaction late = { .sa_handler = on_late };
    sigemptyset(&ignore.sa_mask);
    sigemptyset(&late.sa_mask);
    sigemptyset(&stop.sa_mask);
    sigaction(SIGPIPE, &ignore, NULL);
    sigaction(SIGPROF, &late, NULL);
    // Who was started with a signal ignored (nohup, a shell's background) keeps ignoring it.
    struct sigaction before;
    if (sigaction(SIGINT, NULL, &before) == 0 && before.sa_handler != SIG_IGN) {
        sigaction(SIGINT, &stop, NULL);
    }
    sigaction(SIGTERM, &stop, NULL);
}

/// When started with a closed stdin, stdout or stderr, a file opened later would take its number
/// and be written into by printf. Fill the gaps with something that cannot be written.
static void fill_standard_files(void)
{
    for (int file = 0; file <= 2; file++) {
        if (fcntl(file, F_GETFD) < 0 && open("/dev/null", O_RDONLY) < 0) {
            break;
        }
    }
}

static const char summary[] =
    "Plumb simulates rigid bodies in two dimensions from scene files in Lua or JSON.";

static const cli_exit_text exits[] = {
    { CLI_OK, "ok" },
    { CLI_FAILED, "failed at run time" },
    { CLI_USAGE, "wrong usage" },
    { CLI_SCENE, "wrong scene" },
    { CLI_EXPECT, "an expectation of the scene failed" },
    { CLI_DIVERGED, "the simulation diverged" },
    { CLI_DIFFERS, "two recordings differ, or a replay gives other bits" },
};
enum { EXIT_COUNT = sizeof exits / sizeof exits[0] };

static void print_usage(FILE *file)
{
    fprintf(file, "usage: plumb COMMAND [operands] [options]\n\n%s\n\nCommands:\n", summary);
    for (int i = 0; i < COMMAND_COUNT; i++) {
        fprintf(file, "  %-9s %s\n", commands[i]->name, commands[i]->summary);
    }
    fprintf(file, "  %-9s %s\n", "help", "tells how to use a command: plumb help run");
    fprintf(file, "\n  --help     this text\n"
                  "  --version  the version\n\n"
                  "Exit codes:");
    for (int i = 0, column = 11; i < EXIT_COUNT; i++) {
        const int length = (int)strlen(exits[i].text) + 4;
        if (column + length > 77) {
            fprintf(file, "\n           ");
            column = 11;
        }
        fprintf(file, " %d %s%s", exits[i].code, exits[i].text, i + 1 < EXIT_COUNT ? "," : "\n");
        column += length;
    }
}

static const cli_command *find_command(const char *name)
{
    for (int i = 0; i < COMMAND_COUNT; i++) {
        if (strcmp(commands[i]->name, name) == 0) {
            return commands[i];
        }
    }
    return NULL;
}

static int unknown_command(const char *name)
{
    char names[256] = "help", near_name[32];
    for (int i = 0; i < COMMAND_COUNT; i++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, ",%s", commands[i]->name);
    }
    int near = cli_nearest(name, names);
    size_t length = strlen(name);
    if (near >= 0 && cli_member(names, near, near_name, sizeof near_name)) {
        cli_message("unknown command '%.80s'; did you mean '%s'?", name, near_name);
    } else if (length > 4 && (strcmp(name + length - 4, ".lua") == 0 ||
                              strcmp(name + length - 5, ".json") == 0)) {
        cli_message("'%.200s' is a scene, not a command; did you mean 'plumb run %.200s'?", name,
                    name);
    } else {
        cli_message("unknown command '%.80s'; 'plumb --help' lists the commands", name);
    }
    return CLI_USAGE;
}

static int help(int argc, char **argv)
{
    if (argc < 3) {
        print_usage(stdout);
        return CLI_OK;
    }
    if (argc > 3) {
        cli_message("help: '%.80s' is one operand too many; usage: plumb help COMMAND", argv[3]);
        return CLI_USAGE;
    }
    if (strcmp(argv[2], "--man") == 0) {
        cli_man(commands, COMMAND_COUNT, summary, exits, EXIT_COUNT);
        return CLI_OK;
    }
    const cli_command *command = find_command(argv[2]);
    if (command == NULL) {
        return unknown_command(argv[2]);
    }
    cli_help(command);
    return CLI_OK;
}

static int dispatch(int argc, char **argv)
{
    if (argc < 2) {
        print_usage(stderr);
        return CLI_USAGE;
    }
    const char *name = argv[1];
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
        print_usage(stdout);
        return CLI_OK;
    }
    if (strcmp(name, "help") == 0) {
        return help(argc, argv);
    }
    if (strcmp(name, "--version") == 0) {
        printf("plumb %s\n", PLUMB_VERSION);
        return CLI_OK;
    }
    const cli_command *command = find_command(name);
    if (command != NULL) {
        return command->run(command, argc - 1, argv + 1);
    }
    if (name[0] == '-') {
        cli_message("the command comes first: plumb COMMAND [operands] %.80s; "
                    "'plumb --help' lists the commands",
                    name);
        return CLI_USAGE;
    }
    return unknown_command(name);
}

int main(int argc, char **argv)
{
    fill_standard_files();
    set_signals();
    int code = dispatch(argc, argv);
    code = cli_finish(code == CLI_HELP ? CLI_OK : code);
    if (stop_signal != 0) {
        raise(stop_signal); // end the way the caller expects of an interrupted program
    }
    return code;
}
