/// cmd_list.c - `plumb list`: what there is. Everything is asked of the engine, the scene loader
/// and the option tables themselves; nothing is written down twice.
///
/// Writes stdout, the same on every run.
#include "commands.h"
#include "film.h"
#include "scene_args.h"

#include <string.h>

typedef struct list_args {
    bool brief;
} list_args;

// With what stands between them: as options have them, and as a sentence that can be wrapped.
#define TOPIC_LIST(S)                                                                              \
    "solvers" S "precisions" S "passes" S "scene" S "settings" S "materials" S "bodies" S          \
    "shapes" S "joints" S "events" S "overlays"
#define TOPICS TOPIC_LIST(",")

static void print_members(const char *title, const char *list)
{
    char name[32];
    printf("%s:\n", title);
    for (int i = 0; cli_member(list, i, name, sizeof name); i++) {
        printf("  %s\n", name);
    }
}

/// All passes, from a world without anything in it.
static int print_passes(bool brief)
{
    engine_settings settings = { .path = "(empty scene)", .text = "scene {} ", .solver = -1 };
    engine_error error = { 0 };
    const engine_api *engine = &engine_float;
    engine_session *session = engine->open(&settings, &error);
    if (session == NULL) {
        return scene_report(&error);
    }
    const engine_pass *list;
    int count = engine->passes(session, &list);
    printf("passes of a step, in order:\n");
    for (int i = 0; i < count; i++) {
        if (brief) {
            printf("  %s\n", list[i].name);
        } else {
            printf("  %-22s %-9s reads %s; writes %s\n", list[i].name, list[i].phase,
                   list[i].reads[0] != '\0' ? list[i].reads : "nothing",
                   list[i].writes[0] != '\0' ? list[i].writes : "nothing");
        }
    }
    engine->close(session);
    if (count < 0) {
        cli_message("out of memory");
        return CLI_FAILED;
    }
    return CLI_OK;
}

static void print_word(const engine_word *word)
{
    bool is_choice = strcmp(word->kind, "one of") == 0;
    printf("    %-17s %s", word->name, word->kind);
    if (word->min < word->max) {
        printf(", %s%g to %g", word->above ? "above " : "", word->min, word->max);
    }
    if (word->unit[0] != '\0') {
        printf(is_choice ? " %s" : " [%s]", word->unit);
    }
    if (word->position > 0) {
        printf(", also element %d", word->position);
    }
    if (word->text[0] != '\0' && word->min < word->max && !word->required) {
        const bool is_none = word->initial < word->min || (word->above && word->initial == 0);
        printf(is_none ? ", default none" : ", default %g", word->initial);
    }
    printf("%s%s%s\n", word->required ? ", required" : "", word->text[0] != '\0' ? ": " : "",
           word->text);
}

/// Constructors of one topic, or of all (null).
static void print_scene(const char *topic, bool brief)
{
    engine_word word;
    printf("%s of scene files:\n", topic != NULL ? topic : "constructors");
    for (int c = 0; engine_float.word(c, -1, &word); c++) {
        if (topic != NULL && strcmp(topic, word.topic) != 0) {
            continue;
        }
        printf("  %s\n", word.name);
        for (int k = 0; !brief && engine_float.word(c, k, &word); k++) {
            print_word(&word);
        }
    }
}

static void print_overlays(void)
{
    const char *name;
    printf("overlays of pictures:\n");
    for (int i = 0; (name = film_overlay(i)) != NULL; i++) {
        printf("  %s\n", name);
    }
}

static int print_topic(const char *topic, bool brief)
{
    if (strcmp(topic, "passes") == 0) {
        return print_passes(brief);
    }
    if (strcmp(topic, "solvers") == 0) {
        print_members("solvers", ENGINE_SOLVERS);
    } else if (strcmp(topic, "precisions") == 0) {
        print_members("precisions", SCENE_PRECISIONS);
    } else if (strcmp(topic, "overlays") == 0) {
        print_overlays();
    } else {
        print_scene(strcmp(topic, "scene") == 0 ? NULL : topic, brief);
    }
    return CLI_OK;
}

/// The constructors of these are among those of the scene: not told twice.
static bool is_part(const char *topic)
{
    static const char *const parts[] = { "settings", "materials", "bodies",
                                         "shapes",   "joints",    "events" };
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        if (strcmp(topic, parts[i]) == 0) {
            return true;
        }
    }
    return false;
}

static int list_command(const cli_command *command, int argc, char **argv)
{
    list_args args = { 0 };
    cli_operands operands;
    char name[32];

    int code = cli_parse(command, argc, argv, &args, &operands);
    if (code != CLI_OK) {
        return code;
    }
    bool all = operands.count == 0, found = all;
    for (int i = 0; cli_member(TOPICS, i, name, sizeof name) && code == CLI_OK; i++) {
        if (all ? !is_part(name) : strcmp(name, operands.items[0]) == 0) {
            code = print_topic(name, args.brief);
            found = true;
        }
    }
    if (found) {
        return code;
    }
    int near = cli_nearest(operands.items[0], TOPICS);
    if (near >= 0 && cli_member(TOPICS, near, name, sizeof name)) {
        cli_message("list: unknown topic '%.60s'; did you mean '%s'?", operands.items[0], name);
    } else {
        cli_message("list: '%.60s' is not one of %s", operands.items[0], TOPICS);
    }
    return CLI_USAGE;
}

static const cli_option options[] = {
    { "brief", 'b', CLI_FLAG, offsetof(list_args, brief), NULL, 0, 0, NULL, "names only" },
};

const cli_command cmd_list = {
    .name = "list",
    .summary = "lists solvers, passes, words of scene files (shapes, joints, ...), overlays",
    .operands = "[TOPIC]",
    .text = "Lists what there is: solvers, precisions, the passes of a step, the constructors of "
            "scene files with their keys, ranges and units, overlays of pictures. "
            "TOPIC is one of " TOPIC_LIST(", ") ".",
    .examples = "plumb list scene\nplumb list joints\nplumb list --brief",
    .options = options,
    .option_count = (int)(sizeof options / sizeof options[0]),
    .operand_min = 0,
    .operand_max = 1,
    .run = list_command,
};
