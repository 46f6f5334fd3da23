// test_scene_rollback.c - every shipped scene, with both solvers: random rollbacks of 1 to 12 steps
// change nothing. The scenes' handlers do not run here, the worlds do. Each scene has its turn in one precision for each solver;
// TRIALS=3: in all.
#include "rollback.h"
#include "scene_steps.h"

#include "harness/trials.h"
#include "scene/scene.h"

#include <glob.h>
#include <stdio.h>

#define STEPS 150

static scene *load(const char *path, const char *solver)
{
    const char *const set[] = { solver };
    scene *s = NULL;
    scene_error error;
    if (scene_load(&(scene_options){ .path = path, .sets = set, .set_count = 1 }, &s, &error) !=
        SCENE_OK) {
        print_error("%s\n", error.text);
    }
    assert_non_null(s);
    return s;
}

static void step(plumb_world *world, void *context)
{
    const plumb_real *dt = context;
    assert_int_equal(plumb_world_step(world, *dt), PLUMB_OK);
}

static void roll_scene(const char *path, const char *solver, bool frames)
{
    static uint64_t hashes[STEPS + 1];
    scene *first = load(path, solver), *second = load(path, solver);
    plumb_real dt = (plumb_real)scene_get_info(first).dt;
    int steps = scene_steps(scene_world(first), STEPS);
    rollback_reference(scene_world(first), step, &dt, steps, hashes);
    int times = rollback_run(scene_world(second), NULL, step, &dt, steps, 12, frames, hashes);
    assert_in_range(times, 1, steps);
    print_message("%s %s: went back %d times in %d steps\n", solver, path, times, steps);
    scene_destroy(first);
    scene_destroy(second);
}

// `turn`: in which precision a scene has its turn.
static void roll_all(const char *solver, bool frames, uint32_t turn)
{
    glob_t found;
    assert_int_equal(glob("assets/scenes/*.lua", 0, NULL, &found), 0);
    for (size_t i = 0; i < found.gl_pathc; ++i) {
        if (trials_takes((uint32_t)i + turn, 3)) {
            roll_scene(found.gl_pathv[i], solver, frames);
        }
    }
    globfree(&found);
}

static void scenes_can_be_rolled_back_in_the_soft_step(void **state)
{
    (void)state;
    roll_all("solver=soft", false, 0);
}

static void scenes_can_be_rolled_back_in_the_classic_solver(void **state)
{
    (void)state;
    roll_all("solver=pgs", true, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_can_be_rolled_back_in_the_soft_step),
        cmocka_unit_test(scenes_can_be_rolled_back_in_the_classic_solver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
