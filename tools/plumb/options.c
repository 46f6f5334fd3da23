/// options.c - the option table at work: parsing and range checks.
///
/// Reads argv and a command's table, writes the command's struct. Cost: O(options x arguments).
#include "cli.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Longest choice or option name, and a little more.
enum { WORD_MAX = 48 };

/// Where a message about an option begins: "run: option --dt".
static void refuse(const cli_command *command, const cli_option *option, const char *what)
{
    cli_message("%s: option --%s: %s", command->name, option->name, what);
}

static bool read_real(const char *text, double *value)
{
    char *end;
    double number = strtod(text, &end);
    if (end == text) {
        return false;
    }
    if (*end == '/') {
        const char *rest = end + 1;
        double divisor = strtod(rest, &end);
        if (end == rest) {
            return false;
        }
        number /= divisor;
    }
    *value = number;
    return *end == '\0' && isfinite(number);
}

static bool read_int(const char *text, long *value, char **end)
{
    *value =
        strtol(text, end, 10); // too large a number becomes the largest, which is out of any range
    return *end != text;
}

/// Stores `number` when it is in range, else tells the range.
static bool in_range(const cli_command *command, const cli_option *option, const char *text,
                     double number)
{
    if (number >= option->min && number <= option->max) {
        return true;
    }
    char what[160];
    snprintf(what, sizeof what, "%.40s is outside %.10g to %.10g", text, option->min, option->max);
    refuse(command, option, what);
    return false;
}

static bool store_real(const cli_command *command, const cli_option *option, const char *text,
                       double *value)
{
    double number;
    if (!read_real(text, &number)) {
        char what[160];
        snprintf(what, sizeof what, "'%.60s' is not a number", text);
        refuse(command, option, what);
        return false;
    }
    if (!in_range(command, option, text, number)) {
        return false;
    }
    *value = number;
    return true;
}

static bool store_ints(const cli_command *command, const cli_option *option, const char *text,
                       cli_ints *list, int most)
{
    const char *at = text;
    list->count = 0;
    for (;;) {
        long number;
        char *end;
        if (!read_int(at, &number, &end) || (*end != '\0' && *end != ',') || list->count == most) {
            char what[160];
            snprintf(what, sizeof what, "'%.60s' is not %s", text,
                     most == 1 ? "a whole number" : "a list of whole numbers such as 1,2,4");
            refuse(command, option, what);
            return false;
        }
        if (!in_range(command, option, at, (double)number)) {
            return false;
        }
        list->items[list->count++] = (int)number;
        if (*end == '\0') {
            return true;
        }
        at = end + 1;
    }
}

static bool store_size(const cli_command *command, const cli_option *option, const char *text,
                       cli_size *size)
{
    long width, height;
    char *end;
    if (!read_int(text, &width, &end) || *end != 'x' || !read_int(end + 1, &height, &end) ||
        *end != '\0') {
        char what[160];
        snprintf(what, sizeof what, "'%.60s' is not a size such as 960x540", text);
        refuse(command, option, what);
        return false;
    }
    if (!in_range(command, option, text, (double)width) ||
        !in_range(command, option, text, (double)height)) {
        return false;
    }
    size->width = (int)width;
    size->height = (int)height;
    return true;
}

/// Index of `word` in the option's choices; -1 after a message.
static int find_choice(const cli_command *command, const cli_option *option, const char *word)
{
    char name[WORD_MAX + 1];
    for (int i = 0; cli_member(option->choices, i, name, sizeof name); i++) {
        if (strcmp(name, word) == 0) {
            return i;
        }
    }
    char what[400];
    int near = cli_nearest(word, option->choices);
    if (near >= 0 && cli_member(option->choices, near, name, sizeof name)) {
        snprintf(what, sizeof what, "'%.60s' is not one of %s; did you mean '%s'?", word,
                 option->choices, name);
    } else {
        snprintf(what, sizeof what, "'%.60s' is not one of %s", word, option->choices);
    }
    refuse(command, option, what);
    return -1;
}

static bool store_choices(const cli_command *command, const cli_option *option, const char *text,
                          unsigned *bits)
{
    char word[WORD_MAX + 1];
    const char *at = text;
    *bits = 0;
    for (;;) {
        size_t length = strcspn(at, ",");
        snprintf(word, sizeof word, "%.*s", (int)(length < WORD_MAX ? length : WORD_MAX), at);
        int index = find_choice(command, option, word);
        if (index < 0) {
            return false;
        }
        *bits |= 1u << index;
        if (at[length] == '\0') {
            return true;
        }
        at += length + 1;
    }
}

/// Stores one value.
static bool store(const cli_command *command, const cli_option *option, const char *text,
                  void *values)
{
    void *field = (char *)values + option->offset;
    cli_ints one;
    int choice;

    switch (option->type) {
    case CLI_FLAG:
        *(bool *)field = true;
        return true;
    case CLI_INT:
        if (!store_ints(command, option, text, &one, 1)) {
            return false;
        }
        *(int *)field = one.items[0];
        return true;
    case CLI_REAL:
        return store_real(command, option, text, field);
    case CLI_TEXT:
        *(const char **)field = text;
        return true;
    case CLI_TEXTS: {
        cli_texts *list = field;
        if (list->count == CLI_TEXTS_MAX) {
            refuse(command, option, "is repeated too often");
            return false;
        }
        list->items[list->count++] = text;
        return true;
    }
    case CLI_CHOICE:
        choice = find_choice(command, option, text);
        if (choice < 0) {
            return false;
        }
        *(int *)field = choice;
        return true;
    case CLI_CHOICES:
        return store_choices(command, option, text, field);
    case CLI_INTS:
        return store_ints(command, option, text, field, CLI_INTS_MAX);
    case CLI_SIZE:
        return store_size(command, option, text, field);
    }
    return false;
}

static const cli_option *find_long(const cli_command *command, const char *name, size_t length)
{
    for (int i = 0; i < command->option_count; i++) {
        const cli_option *option = &command->options[i];
        if (strlen(option->name) == length && strncmp(option->name, name, length) == 0) {
            return option;
        }
    }
    return NULL;
}

static const cli_option *find_short(const cli_command *command, char letter)
{
    for (int i = 0; i < command->option_count; i++) {
        if (command->options[i].letter == letter) {
            return &command->options[i];
        }
    }
    return NULL;
}

static int unknown_option(const cli_command *command, const char *argument)
{
    char names[1024] = "help";
    char word[WORD_MAX + 1], name[WORD_MAX + 1];
    for (int i = 0; i < command->option_count; i++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, ",%s", command->options[i].name);
    }
    const char *bare = argument + strspn(argument, "-");
    snprintf(word, sizeof word, "%.*s", (int)strcspn(bare, "="), bare);
    int near = cli_nearest(word, names);
    if (near >= 0 && cli_member(names, near, name, sizeof name)) {
        cli_message("%s: unknown option '%.80s'; did you mean '--%s'?", command->name, argument,
                    name);
    } else {
        cli_message("%s: unknown option '%.80s'; 'plumb help %s' lists the options", command->name,
                    argument, command->name);
    }
    return CLI_USAGE;
}

/// Handles the option at argv[*at]; moves *at on when the value is the next argument.
static int take_option(const cli_command *command, int argc, char **argv, int *at, void *values)
{
    const char *argument = argv[*at];
    const char *value = NULL;
    const cli_option *option;

    if (argument[1] == '-') {
        size_t length = strcspn(argument + 2, "=");
        option = find_long(command, argument + 2, length);
        value = argument[2 + length] == '=' ? argument + 3 + length : NULL;
    } else {
        option = find_short(command, argument[1]);
        value = argument[2] != '\0' ? argument + 2 : NULL;
    }
    if (option == NULL) {
        return unknown_option(command, argument);
    }
    if (option->type == CLI_FLAG) {
        if (value != NULL) {
            refuse(command, option, "takes no value");
            return CLI_USAGE;
        }
    } else if (value == NULL) {
        if (*at + 1 >= argc) {
            char what[80];
            snprintf(what, sizeof what, "needs a value (%s)", option->value);
            refuse(command, option, what);
            return CLI_USAGE;
        }
        value = argv[++*at];
    }
    return store(command, option, value, values) ? CLI_OK : CLI_USAGE;
}

static int check_operands(const cli_command *command, const cli_operands *operands)
{
    if (operands->count < command->operand_min) {
        cli_message("%s: %s is missing; usage: plumb %s %s [options]", command->name,
                    operands->count == 0 ? command->operands : "an operand", command->name,
                    command->operands);
        return CLI_USAGE;
    }
    if (operands->count > command->operand_max) {
        cli_message("%s: '%.80s' is one operand too many; usage: plumb %s %s [options]",
                    command->name, operands->items[command->operand_max], command->name,
                    command->operands);
        return CLI_USAGE;
    }
    return CLI_OK;
}

int cli_parse(const cli_command *command, int argc, char **argv, void *values,
              cli_operands *operands)
{
    // Operands move to the front of argv, never past the argument being read.
    *operands = (cli_operands){ .items = argv + 1 };
    bool only_operands = false;
    for (int i = 1; i < argc; i++) {
        char *argument = argv[i];
        if (only_operands || argument[0] != '-' || argument[1] == '\0') {
            operands->items[operands->count++] = argument;
        } else if (strcmp(argument, "--") == 0) {
            only_operands = true;
        } else if (strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0) {
            cli_help(command);
            return CLI_HELP;
        } else {
            int code = take_option(command, argc, argv, &i, values);
            if (code != CLI_OK) {
                return code;
            }
        }
    }
    return check_operands(command, operands);
}
