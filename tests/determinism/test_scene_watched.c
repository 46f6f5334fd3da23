// test_scene_watched.c - in every shipped scene each row of the step writes only what it declares, and neither watching that
// nor the watchdog changes a bit.
#include "scene_steps.h"

#include "step/pass.h"
#include "step/data.h"
#include "plumb/plumb.h"
#include "scene/scene.h"
#include "world/state.h"

#include <glob.h>
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define SCENES       "assets/scenes/*.lua"
#define SCENES_LEAST 10
#define STEPS        40

static uint64_t run(const char *path, const char *solver, unsigned watched, bool dog,
                    uint32_t *breaches)
{
    char set[64];
    snprintf(set, sizeof set, "solver=%s", solver);
    const char *const sets[] = { set };
    const scene_options options = { .path = path, .sets = sets, .set_count = 1 };
    scene *s = NULL;
    scene_error error;
    assert_int_equal(scene_load(&options, &s, &error), SCENE_OK);
    plumb_world *world = scene_world(s);
    assert_int_equal(plumb_world_watch(world, watched), PLUMB_OK);
    assert_int_equal(plumb_world_set_watchdog(world, dog), PLUMB_OK);
    const int steps = scene_steps(world, STEPS);
    uint32_t seen = 0;
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(scene_step(s, &error), SCENE_OK);
        if (world->schedule.breaches > seen) {
            seen = world->schedule.breaches;
            print_error("%s, %s, step %d: %s\n", path, solver, i, plumb_world_error(world).message);
        }
    }
    *breaches += world->schedule.breaches;
    const uint64_t hash = plumb_world_hash(world);
    scene_destroy(s);
    return hash;
}

static void rows_write_what_they_declare(void **state)
{
    (void)state;
    glob_t found;
    assert_int_equal(glob(SCENES, 0, NULL, &found), 0);
    assert_true(found.gl_pathc >= SCENES_LEAST);
    uint32_t breaches = 0;
    for (size_t i = 0; i < found.gl_pathc; ++i) {
        const char *solver = i % 3 == 0 ? "pgs" : "soft";
        const char *path = found.gl_pathv[i];
        const uint64_t watched = run(path, solver, PLUMB_WATCH_WRITES, true, &breaches);
        assert_true(run(path, solver, PLUMB_WATCH_TIMES, false, &breaches) == watched);
    }
    globfree(&found);
    assert_int_equal(breaches, 0);
}

// Each name in the table is one of data.
static void the_table_names_data(void **state)
{
    (void)state;
    for (int i = 0; i < pl_pass_count; ++i) {
        uint32_t mask;
        const char *unknown = "";
        int length = 0;
        const bool sound = pl_data_parse(NULL, pl_passes[i].reads, &mask, &unknown, &length) &&
                           pl_data_parse(NULL, pl_passes[i].writes, &mask, &unknown, &length);
        if (!sound) {
            print_error("%s: %.*s\n", pl_passes[i].name, length, unknown);
        }
        assert_true(sound);
        assert_int_equal(pl_pass_find(pl_passes[i].name), i);
        assert_true(i == 0 || pl_passes[i - 1].stage <= pl_passes[i].stage);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_names_data),
        cmocka_unit_test(rows_write_what_they_declare),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
