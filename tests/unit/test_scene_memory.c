// test_scene_memory.c - the list of a world's memory is complete: what is not in a row of its own is the
// world's own structure and nothing else, in a world that uses everything.
#include "scene/scene.h"
#include "world/state.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void nothing(const plumb_system_call *call)
{
    (void)call;
}

static size_t bytes_of(const plumb_memory_row *rows, int count, const char *name)
{
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return rows[i].bytes;
        }
    }
    fail_msg("no row '%s'", name);
    return 0;
}

static void check(const plumb_world *world)
{
    plumb_memory_row rows[64];
    int count = plumb_world_memory(world, rows, 64);
    assert_in_range(count, 10, 64);
    size_t sum = 0;
    for (int i = 0; i < count; ++i) {
        sum += rows[i].bytes;
    }
    assert_int_equal(sum, plumb_world_stats(world).bytes);
    assert_int_equal(bytes_of(rows, count, "world"), sizeof(plumb_world));
}

// Scenes with contacts, joints, sensors, characters, effects, sleepers, internal edges.
static void nothing_is_left_out(void **state)
{
    (void)state;
    static const char *const scenes[] = { "hopper",   "ragdoll_blast", "platformer", "pinball",
                                          "conveyor", "tiles",         "stack" };
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; ++i) {
        char path[128];
        snprintf(path, sizeof path, "assets/scenes/%s.lua", scenes[i]);
        scene *s = NULL;
        scene_error error;
        assert_int_equal(scene_load(&(scene_options){ .path = path }, &s, &error), SCENE_OK);
        for (int step = 0; step < 90; ++step) {
            assert_int_equal(scene_step(s, &error), SCENE_OK);
        }
        plumb_world *world = scene_world(s);
        check(world);
        scene_destroy(s);
    }
}

static void user_tables_count(void **state)
{
    (void)state;
    plumb_world *world;
    assert_int_equal(plumb_world_create(NULL, &world), PLUMB_OK);
    check(world);
    plumb_component c = plumb_component_create(
        world, &(plumb_component_desc){ .name = "charge", .size = sizeof(float) });
    plumb_entity e = plumb_entity_create(world);
    float one = 1;
    assert_int_equal(plumb_component_set(world, e, c, &one), PLUMB_OK);
    plumb_system_create(world, &(plumb_system_desc){ .name = "idle", .run = nothing });
    check(world);
    plumb_memory_row rows[64];
    int count = plumb_world_memory(world, rows, 64);
    assert_true(bytes_of(rows, count, "components") > 0);
    assert_true(bytes_of(rows, count, "systems") > 0);
    plumb_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_left_out),
        cmocka_unit_test(user_tables_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
