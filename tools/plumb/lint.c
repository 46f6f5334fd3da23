/// lint.c - `plumb check --lint`: what the rules find in a scene, but for what it allows.
///
/// A scene that is meant to be so says it in a line of its own: `-- lint: allow mass-ratio, size: why`.
///
/// Reads the scene's file again, for such lines; writes to stdout, the same on every run.
#include "lint.h"

#include "allow.h"

#include <string.h>

/// Of one rule, so many findings are told.
enum { TOLD = 3 };

static const struct {
    const char *name, *advice;
} rules[] = {
#define ROW(name, look, text, advice) { name, advice },
    LINT_RULES(ROW)
#undef ROW
};

enum { RULES = sizeof rules / sizeof rules[0] };

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
    const char *names[RULES];
    for (int i = 0; i < RULES; i++) {
        names[i] = rules[i].name;
    }
    const allow_words words = { "-- lint: allow ", "rule", names, RULES };
    const bool good = allow_read(&words, path, allowed, silent);
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
