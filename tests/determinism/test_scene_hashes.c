// test_scene_hashes.c - every shipped scene ends in the committed bits, at every SIMD width and with
// several threads.
//
// hashes.txt has a line a scene and solver: precision, solver, file, steps, plumb_world_hash. With the
// argument --print the program writes such lines for its precision instead (`make hashes`), with
// --table what `make determinism` compares.
#include "scene_steps.h"

#include "plumb/plumb.h"
#include "harness/main.h"
#include "scene/scene.h"

#include <glob.h>
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define HASHES "tests/determinism/hashes.txt"
#define SCENES "assets/scenes/*.lua"

#define STEPS         120
#define SCENES_LEAST  10
#define SPEEDS_TESTED 4 // of `speeds`; make determinism runs all

static const char *precision(void)
{
    return PLUMB_IS_FAR ? "far" : sizeof(plumb_real) == sizeof(float) ? "float" : "double";
}

static const char *const solvers[] = { "soft", "pgs" };

// What must not change a bit.
typedef struct speed {
    int width, workers;
} speed;

static const speed speeds[] = { { 4, 1 }, { 8, 1 }, { 16, 1 }, { 8, 2 }, { 4, 3 }, { 16, 8 } };

typedef struct outcome {
    uint64_t hash;
    int steps;
    int width; // in force: a machine may not have what was asked for
} outcome;

// `steps` 0: as many as the size of the scene allows.
static outcome run(const char *path, const char *solver, speed at, int steps)
{
    char sets[3][64];
    snprintf(sets[0], sizeof sets[0], "solver=%s", solver);
    snprintf(sets[1], sizeof sets[1], "simd_width=%d", at.width);
    snprintf(sets[2], sizeof sets[2], "workers=%d", at.workers);
    const char *const set[] = { sets[0], sets[1], sets[2] };
    const scene_options options = { .path = path, .sets = set, .set_count = 3 };
    scene *s = NULL;
    scene_error error;
    if (scene_load(&options, &s, &error) != SCENE_OK) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    plumb_world *world = scene_world(s);
    outcome out = { .steps = steps > 0 ? steps : scene_steps(world, STEPS),
                    .width = plumb_world_settings(world).simd_width };
    for (int i = 0; i < out.steps; ++i) {
        if (scene_step(s, &error) != SCENE_OK) {
            fprintf(stderr, "%s\n", error.text);
            exit(1);
        }
    }
    out.hash = plumb_world_hash(world);
    scene_destroy(s);
    return out;
}

typedef struct line {
    char precision[16], solver[16], path[256];
    int steps;
    uint64_t hash;
} line;

static bool read_line(FILE *file, line *out)
{
    char text[512];
    while (fgets(text, sizeof text, file) != NULL) {
        if (text[0] != '#') {
            return sscanf(text, "%15s %15s %255s %d %" SCNx64, out->precision, out->solver,
                          out->path, &out->steps, &out->hash) == 5;
        }
    }
    return false;
}

// Of those lines every so many: 1, unless --every says otherwise.
static int every = 1;

static void committed_hashes_hold_at_every_speed(void **state)
{
    (void)state;
    FILE *file = fopen(HASHES, "r");
    assert_non_null(file);
    line l;
    int lines = 0, wrong = 0;
    while (read_line(file, &l)) {
        if (strcmp(l.precision, precision()) != 0) {
            continue;
        }
        if (lines++ % every != 0) {
            continue;
        }
        for (size_t k = 0; k < SPEEDS_TESTED; ++k) {
            outcome got = run(l.path, l.solver, speeds[k], l.steps);
            if (got.hash != l.hash) {
                print_error("%s %s %s width %d, %d workers: %016" PRIx64
                            " after %d steps, committed %016" PRIx64 "\n",
                            l.precision, l.solver, l.path, got.width, speeds[k].workers, got.hash,
                            l.steps, l.hash);
                ++wrong;
            }
        }
    }
    fclose(file);
    if (wrong > 0) {
        print_error("if physics was meant to change: make hashes\n");
    }
    assert_int_equal(wrong, 0);
    assert_in_range(lines, 2 * SCENES_LEAST, 1000);
}

static void print_lines(bool table)
{
    glob_t found;
    if (glob(SCENES, 0, NULL, &found) != 0) {
        exit(1);
    }
    for (size_t i = 0; i < found.gl_pathc; ++i) {
        for (int s = 0; s < 2; ++s) {
            for (size_t k = 0; k < (table ? sizeof speeds / sizeof speeds[0] : 1); ++k) {
                outcome o = run(found.gl_pathv[i], solvers[s], speeds[k], 0);
                if (table) {
                    printf("%s %s %d->%d,%d %s %d %016" PRIx64 "\n", precision(), solvers[s],
                           speeds[k].width, o.width, speeds[k].workers, found.gl_pathv[i], o.steps,
                           o.hash);
                } else {
                    printf("%s %s %s %d %016" PRIx64 "\n", precision(), solvers[s],
                           found.gl_pathv[i], o.steps, o.hash);
                }
                fflush(stdout);
            }
        }
    }
    globfree(&found);
}

int main(void)
{
    const int argc = test_argument_count;
    char **argv = test_arguments;
    if (argc == 2 && strcmp(argv[1], "--print") == 0) {
        print_lines(false);
        return 0;
    }
    if (argc == 2 && strcmp(argv[1], "--table") == 0) {
        print_lines(true);
        return 0;
    }
    if (argc == 3 && strcmp(argv[1], "--every") == 0) {
        long wanted = strtol(argv[2], NULL, 10);
        every = wanted > 0 && wanted < 1000 ? (int)wanted : 1;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(committed_hashes_hold_at_every_speed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
