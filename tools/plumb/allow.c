/// allow.c - lines of a scene's file and options that allow something by name.
///
/// Reads the scene's file.
#include "allow.h"

#include <string.h>

enum { LINE = 512 };

/// The name that begins here; `count`: none.
static int name_at(const allow_words *words, const char *text, size_t length)
{
    int i = 0;
    while (i < words->count &&
           !(strlen(words->names[i]) == length && strncmp(words->names[i], text, length) == 0)) {
        i++;
    }
    return i;
}

/// Notes the names of a list, up to a colon; false after a message: one is none.
static bool allow(const allow_words *words, const char *list, const char *where, bool *allowed)
{
    while (*list != '\0') {
        list += strspn(list, " ,");
        const size_t length = strcspn(list, " ,:\r\n");
        if (length == 0) {
            break;
        }
        const int i = name_at(words, list, length);
        if (i == words->count) {
            cli_message("%s: there is no %s '%.*s' to allow; see plumb help check", where,
                        words->what, (int)length, list);
            return false;
        }
        allowed[i] = true;
        list += length;
        if (*list == ':') {
            break;
        }
    }
    return true;
}

bool allow_read(const allow_words *words, const char *path, const cli_texts *options, bool *allowed)
{
    const size_t mark = strlen(words->mark);
    FILE *file = fopen(path, "r");
    char line[LINE];
    bool good = true;
    while (file != NULL && good && fgets(line, sizeof line, file) != NULL) {
        if (strncmp(line, words->mark, mark) == 0) {
            good = allow(words, line + mark, path, allowed);
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    for (int i = 0; i < options->count && good; i++) {
        good = allow(words, options->items[i], "--allow", allowed);
    }
    return good;
}
