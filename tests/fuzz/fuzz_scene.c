// fuzz_scene.c - hostile scene files: a scene or an error, never harm. Input that begins with '{'
// is JSON, else Lua; what loads is exported, and the export must load again and give the same
// bytes.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void be_silent(void *context, const char *line)
{
    (void)context, (void)line;
}

static scene *load(const char *name, const char *text, size_t size)
{
    scene_options options = { .path = name,
                              .text = text,
                              .text_size = size,
                              .memory_limit = (size_t)16 << 20,
                              .build_instructions = 300000,
                              .handler_instructions = 30000,
                              .print = be_silent };
    scene *s;
    scene_error e;
    if (scene_load(&options, &s, &e) != SCENE_OK && (e.text[0] == 0 || s != NULL)) {
        abort(); // an error without a message
    }
    return s;
}

static char *export_json(const scene *s, size_t *size)
{
    char *text = NULL; // from open_memstream
    FILE *file = open_memstream(&text, size);
    if (file == NULL || !scene_to_json(s, file) || fclose(file) != 0) {
        abort();
    }
    return text;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    scene *s =
        load(size > 0 && data[0] == '{' ? "fuzz.json" : "fuzz.lua", (const char *)data, size);
    size_t length = 0;
    char *text = s != NULL ? export_json(s, &length) : NULL;
    scene *copy = text != NULL ? load("copy.json", text, length) : NULL;
    if (copy != NULL) { // not every export fits the same memory limit
        char *again = export_json(copy, &length);
        if (strcmp(text, again) != 0) {
            abort();
        }
        free(again);
    }
    for (int i = 0; s != NULL && i < 5 && scene_step(s, NULL) == SCENE_OK; i++) {
    }
    scene_destroy(s);
    scene_destroy(copy);
    free(text);
    return 0;
}
