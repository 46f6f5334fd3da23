/// help.c - the help of a command, made from its table: what the parser knows is what is told.
///
/// Reads a cli_command, writes stdout. Lines are at most 80 wide.
#include "cli.h"

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
