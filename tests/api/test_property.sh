#!/bin/bash
# test_property.sh - what it takes to add a property: two files of a copy of the tree are changed, the float library and the
# scene loader built of it, and the property is used from C, Lua and JSON, refused beyond its range, saved and replayed.
set -u

. tests/harness/try.sh
skip_sanitized "the copy is not built with sanitizers"

tree=$work/tree

mkdir "$tree"
cp -r Makefile src include tools "$tree"

# The row, and the declarations for users.
sed -i '/^    R(X, OWN, BOOL, disabled/i\
    R(X, COLUMN, REAL, charge, SAID(charge), "C", FROM(0, 10), 0, NO_ZERO, "of a tracer") \\' \
    "$tree/src/schema/body.h"
sed -i -e '/^    bool disabled; /i\
    plumb_real charge; ///< [C] 0..10, default 0' \
    -e '/^\/\/\/ Sets the factor on gravity/i\
/// Sets and tells the charge [C] 0..10. Errors: E_HANDLE, E_NOT_FINITE, E_RANGE.\
PLUMB_API plumb_result plumb_body_set_charge(plumb_world *world, plumb_body body, plumb_real charge);\
PLUMB_API plumb_real plumb_body_charge(const plumb_world *world, plumb_body body);\
' "$tree/include/plumb/body.h"
two_files()
{
    [ "$(diff -rq src "$tree/src" | wc -l) $(diff -rq include "$tree/include" | wc -l)" = "1 1" ] &&
        diff -rq tools "$tree/tools" && diff -q Makefile "$tree/Makefile"
}
try "two files are changed" two_files
built()
{
    env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS make -C "$tree" --no-print-directory JOBS=1 O=build CFLAGS=-O0 WERROR=1 \
        build/libplumb.a build/float/libscene.a
}
try "library and loader are built without a warning" built

cat >"$work/use.c" <<'C'
#include "plumb/plumb.h"
#include "scene/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char tape[1 << 20], image[1 << 16];
static size_t used;

static bool keep(void *context, const void *bytes, size_t size)
{
    (void)context;
    memcpy(tape + used, bytes, size);
    used += size;
    return true;
}

static int is(const char *what, int good)
{
    printf("%s: %s\n", what, good ? "yes" : "NO");
    return !good;
}

static scene *load(const char *path, const char *text, scene_error *error)
{
    scene *s = NULL;
    const scene_options options = { .path = path, .text = text, .text_size = strlen(text) };
    scene_load(&options, &s, error);
    return s;
}

static plumb_real charge_in(scene *s)
{
    plumb_world *w = scene_world(s);
    return plumb_body_charge(w, plumb_world_bodies(w).body[0]);
}

int main(void)
{
    int bad = 0;
    plumb_world *w;
    plumb_world_create(NULL, &w);
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .charge = 3 });
    bad += is("made", plumb_body_charge(w, b) == 3);
    bad += is("refused", plumb_body_set_charge(w, b, 11) == PLUMB_E_RANGE &&
                             strstr(plumb_world_error(w).message, "charge is 11; it must be 0 to 10") != NULL);
    plumb_world_save(w, image, sizeof image);
    const uint64_t hash = plumb_world_hash(w);
    plumb_recorder_start(w, &(plumb_recorder_desc){ .write = keep });
    plumb_body_set_charge(w, b, 5);
    bad += is("hashed", plumb_world_hash(w) != hash);
    plumb_world_step(w, 0.01f);
    plumb_recorder_stop(w);
    plumb_replay *replay;
    plumb_replay_open(tape, used, NULL, &replay);
    plumb_replay_step(replay);
    bad += is("replayed", plumb_body_charge(plumb_replay_world(replay), b) == 5);
    plumb_world_restore(w, image, sizeof image);
    bad += is("restored", plumb_body_charge(w, b) == 3);
    const plumb_property *p = plumb_property_find(PLUMB_TABLE_BODY, "charge");
    bad += is("listed", p != NULL && p->high == 10 && strcmp(p->unit, "C") == 0);

    scene_error error;
    scene *s = load("a.lua", "body{ circle{1}, charge = 4 }", &error);
    bad += is("said in Lua", s != NULL && charge_in(s) == 4);
    char *json = NULL;
    size_t size;
    FILE *file = open_memstream(&json, &size);
    scene_to_json(s, file);
    fclose(file);
    scene *copy = load("a.json", json, &error);
    bad += is("said in JSON", strstr(json, "\"charge\":4") != NULL && copy != NULL && charge_in(copy) == 4);
    bad += is("refused in Lua", load("b.lua", "body{ circle{1}, charge = 12 }", &error) == NULL &&
                                    strstr(error.text, "'charge' of body{} must be at least 0 and at most 10 C"));
    return bad > 0;
}
C
used()
{
    # shellcheck disable=SC2046
    ${CC:-gcc} -std=c17 -D_POSIX_C_SOURCE=200809L -I"$tree/include" -I"$tree/tools" "$work/use.c" \
        "$tree/build/float/libscene.a" "$tree/build/libplumb.a" \
        $(pkg-config --libs lua5.4 libcjson 2>/dev/null || echo -llua5.4 -lcjson) -lm -lpthread -o "$work/use" &&
        "$work/use"
}
try "it is set, refused, saved, replayed, listed, said in Lua and JSON" used
[ "$failures" -eq 0 ]
