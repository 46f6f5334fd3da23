/// allow.h - what a scene or the command line allows, by name: rules of the linter, alarms of the watchdog. A scene says it in
/// a line of its own: `-- lint: allow size: why`.
#ifndef PLUMB_ALLOW_H
#define PLUMB_ALLOW_H

#include "cli.h"

/// The words that may be allowed.
typedef struct allow_words {
    const char *mark; ///< "-- lint: allow "
    const char *what; ///< "rule"
    const char *const *names;
    int count;
} allow_words;

/// Notes in `allowed`, one a name, what the lines of a file allow, and what the options do. False after a message: a name is
/// none. Lines of what is not a file are not seen.
bool allow_read(const allow_words *words, const char *path, const cli_texts *options,
                bool *allowed);

#endif
