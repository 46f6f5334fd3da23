/// lint.c - `plumb check --lint`: what the rules find in a scene, but for what it allows.
///
/// A scene that is meant to be so says it in a line of its own: `-- lint: allow mass-ratio, size: why`.
///
/// Reads the scene's file again, for such lines; writes to stdout, the same on every run.
#include "lint.h"

#include <stdlib.h>
#include <string.h>

/// Of one rule, so many findings are told.
enum { TOLD = 3, LINE = 512 };

static const struct {
    const char *name, *advice;
} rules[] = {
#define ROW(name, look, text, advice) { name, advice },
    LINT_RULES(ROW)
#undef ROW
};

enum { RULES = sizeof rules / sizeof rules[0] };

/// The rule that begins here; RULES: none.
static int rule_at(const char *text, size_t length)
{
    int i = 0;
    while (i < RULES &&
           !(strlen(rules[i].name) == length && strncmp(rules[i].name, text, length) == 0)) {
        i++;
    }
    return i;
}

/// Notes the rules of a list; false after a message: one is none.
static bool allow(const char *list, const char *where, bool *allowed)
{
    while (*list != '\0') {
        list += strspn(list, " ,");
        const size_t length = strcspn(list, " ,:\r\n");
        if (length == 0) {
            break;
        }
        const int i = rule_at(list, length);
        if (i == RULES) {
            cli_message("%s: there is no rule '%.*s' to allow; see plumb help check", where,
                        (int)length, list);
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

/// What the scene's own lines allow. Those of a scene that is not a file are not seen.
static bool read_allowed(const char *path, bool *allowed)
{
    static const char mark[] = "-- lint: allow ";
    FILE *file = fopen(path, "r");
    char line[LINE];
    bool good = true;
    while (file != NULL && good && fgets(line, sizeof line, file) != NULL) {
        if (strncmp(line, mark, sizeof mark - 1) == 0) {
            good = allow(line + sizeof mark - 1, path, allowed);
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    return good;
}

/// The findings of one rule.
static int tell_rule(const engine_finding *list, int count, int rule, const char *scene)
{
    int found = 0;
    for (int i = 0; i < count; i++) {
        if (strcmp(list[i].rule, rules[rule].name) == 0 && ++found <= TOLD) {
            printf("lint  %s: %s: %s\n", scene, rules[rule].name, list[i].text);
        }
    }
    if (found > TOLD) {
        printf("lint  %s: %s: and %d more\n", scene, rules[rule].name, found - TOLD);
    }
    if (found > 0) {
        printf("      to do: %s\n", rules[rule].advice);
    }
    return found;
}

int lint_scene(const scene_run *run, const char *path, const cli_texts *allowed)
{
    const char *slash = strrchr(path, '/'), *scene = slash != NULL ? slash + 1 : path;
    bool silent[RULES] = { false };
    bool good = read_allowed(path, silent);
    for (int i = 0; i < allowed->count && good; i++) {
        good = allow(allowed->items[i], "--allow", silent);
    }
    const engine_finding *list = NULL;
    const int count = good ? run->engine->lint(run->session, &list) : -1;
    if (good && count < 0) {
        cli_message("out of memory");
    }
    int found = 0;
    for (int i = 0; i < RULES && count >= 0; i++) {
        found += silent[i] ? 0 : tell_rule(list, count, i, scene);
    }
    return count < 0 ? -1 : found;
}
