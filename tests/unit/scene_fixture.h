// scene_fixture.h - what the tests of scenes share: a scene of a text, run, and its JSON. A source that includes
// it defines _POSIX_C_SOURCE 200809L first (open_memstream).
#ifndef SCENE_FIXTURE_H
#define SCENE_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "harness/near.h"
#include "scene/scene.h"

static inline scene *load_as(const char *file, const char *text, size_t size, const char *set)
{
    scene *s = NULL;
    scene_error e;
    scene_load(
        &(scene_options){
            .path = file, .text = text, .text_size = size, .sets = &set, .set_count = set != NULL },
        &s, &e);
    if (s == NULL) {
        printf("%s\n", e.text);
    }
    assert_non_null(s);
    return s;
}

static inline scene *load(const char *text)
{
    return load_as("test.lua", text, strlen(text), NULL);
}

static inline void run(scene *s)
{
    scene_error e = { 0 };
    while (!scene_done(s)) {
        scene_step(s, &e);
    }
    scene_finish(s, &e);
    if (e.code != SCENE_OK) {
        printf("%s\n", e.text);
    }
    assert_int_equal(e.code, SCENE_OK);
}

static inline double score(const scene *s, const char *name)
{
    for (int i = 0; i < scene_score_count(s); i++) {
        if (strcmp(scene_score_name(s, i), name) == 0) {
            return scene_score_value(s, i);
        }
    }
    return (double)NAN;
}

static inline void steps(scene *s, int count)
{
    scene_error e = { 0 };
    for (int i = 0; i < count; i++) {
        if (scene_step(s, &e) != SCENE_OK) {
            printf("%s\n", e.text);
        }
        assert_int_equal(e.code, SCENE_OK);
    }
}

// Runs to the end; every expectation must hold.
static inline void run_and_hold(scene *s)
{
    run(s);
    for (int i = 0; i < scene_expect_count(s); i++) {
        scene_expect_result r = scene_expect_get(s, i);
        if (!r.passed) {
            printf("%s: %s\n", r.name, r.description);
        }
    }
    assert_int_equal(scene_expect_failures(s), 0);
}

static inline char *export_json(const scene *s, size_t *size)
{
    char *text = NULL;
    FILE *file = open_memstream(&text, size);
    assert_non_null(file);
    assert_true(scene_to_json(s, file));
    fclose(file);
    return text;
}

#endif
