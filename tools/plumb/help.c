/// help.c - the help of a command, made from its table: what the parser knows is what is told.
///
/// Reads cli_commands, writes stdout: for the terminal in lines of at most 80, or as a manual page in the macros of
/// man(7).
#include "cli.h"

#include "plumb/base.h"

#include <string.h>

enum { HELP_COLUMN = 26, HELP_WIDTH = 80 };

/// Prints `text` from `column` on, broken at spaces, the next lines indented to there.
static void print_wrapped(const char *text, int column)
{
    while (*text != '\0') {
        size_t room = (size_t)(HELP_WIDTH - column);
        size_t length = strlen(text);
        if (length > room) {
            length = room;
            while (length > 0 && text[length] != ' ') {
                length--;
            }
            if (length == 0) {
                length = strcspn(text, " ");
            }
        }
        printf("%.*s\n", (int)length, text);
        text += length;
        text += strspn(text, " ");
        if (*text != '\0') {
            printf("%*s", column, "");
        }
    }
}

static void print_option(const cli_option *option)
{
    char left[64];
    char letter[5] = "    ";
    if (option->letter != 0) {
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    }
    if (option->value != NULL) {
        snprintf(left, sizeof left, "  %s--%s %s", letter, option->name, option->value);
    } else {
        snprintf(left, sizeof left, "  %s--%s", letter, option->name);
    }
    if (strlen(left) + 2 > HELP_COLUMN) {
        printf("%s\n%*s", left, HELP_COLUMN, "");
    } else {
        printf("%-*s", HELP_COLUMN, left);
    }
    print_wrapped(option->help, HELP_COLUMN);
}

void cli_help(const cli_command *command)
{
    const char *space = command->operands[0] != '\0' ? " " : "";
    printf("usage: plumb %s%s%s [options]\n\n", command->name, space, command->operands);
    print_wrapped(command->text, 0);
    printf("\nOptions:\n");
    for (int i = 0; i < command->option_count; i++) {
        print_option(&command->options[i]);
    }
    printf("  -h, %-*s%s\n", HELP_COLUMN - 6, "--help", "this text");
    if (command->examples != NULL) {
        printf("\nExamples:\n");
        const char *at = command->examples;
        while (*at != '\0') {
            size_t length = strcspn(at, "\n");
            printf("  %.*s\n", (int)length, at);
            at += length + (at[length] == '\n');
        }
    }
}

//---- the manual page -----------------------------------------------------------------------------

/// Text as roff has it: hyphens that can be copied, no macro at the start of a line.
static void print_roff(const char *text, size_t length)
{
    bool line_begins = true;
    for (size_t i = 0; i < length; i++) {
        if (line_begins && (text[i] == '.' || text[i] == '\'')) {
            fputs("\\&", stdout);
        }
        if (text[i] == '-') {
            fputs("\\-", stdout);
        } else if (text[i] == '\\') {
            fputs("\\e", stdout);
        } else {
            putchar(text[i]);
        }
        line_begins = text[i] == '\n';
    }
}

static void print_roff_line(const char *text)
{
    print_roff(text, strlen(text));
    putchar('\n');
}

static void man_option(const cli_option *option)
{
    printf(".TP\n\\fB");
    if (option->letter != 0) {
        printf("\\-%c\\fR, \\fB", option->letter);
    }
    printf("\\-\\-");
    print_roff(option->name, strlen(option->name));
    printf("\\fR");
    if (option->value != NULL) {
        printf(" \\fI");
        print_roff(option->value, strlen(option->value));
        printf("\\fR");
    }
    putchar('\n');
    print_roff_line(option->help);
}

static void man_command(const cli_command *command)
{
    const char *space = command->operands[0] != '\0' ? " " : "";
    printf(".SS \"plumb %s%s", command->name, space);
    print_roff(command->operands, strlen(command->operands));
    printf(" [options]\"\n");
    print_roff_line(command->text);
    for (int i = 0; i < command->option_count; i++) {
        man_option(&command->options[i]);
    }
    if (command->examples != NULL) {
        printf(".PP\nExamples:\n.PP\n.nf\n");
        print_roff_line(command->examples);
        printf(".fi\n");
    }
}

void cli_man(const cli_command *const *commands, int count, const char *summary,
             const cli_exit_text *exits, int exit_count)
{
    printf(".TH PLUMB 1 %s \"Plumb %s\" \"User Commands\"\n", CLI_MAN_DATE, PLUMB_VERSION);
    printf(".SH NAME\nplumb \\- rigid bodies in two dimensions\n");
    printf(".SH SYNOPSIS\n.B plumb\n.I command\n[operands] [options]\n");
    printf(".SH DESCRIPTION\n");
    print_roff_line(summary);
    printf(".SH COMMANDS\n");
    for (int i = 0; i < count; i++) {
        man_command(commands[i]);
    }
    printf(".PP\nEach knows \\fB\\-\\-help\\fR.\n");
    printf(".SS \"plumb help [command]\"\nTells how to use a command.\n.SH \"EXIT STATUS\"\n");
    for (int i = 0; i < exit_count; i++) {
        printf(".TP\n%d\n", (int)exits[i].code);
        print_roff_line(exits[i].text);
    }
    printf(".SH \"SEE ALSO\"\nThe folders share/doc/plumb (the words of scene files, the library) "
           "and\n"
           "share/plumb (scenes, examples) beside the command.\n");
}
