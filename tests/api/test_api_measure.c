// test_api_measure.c - a world that is asked to measure its error, and one that is not.
#include "world_fixture.h"

static plumb_pass_info row_of(const plumb_world *w, const char *name)
{
    plumb_pass_info rows[128];
    const int count = plumb_world_schedule(w, rows, 128);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return rows[i];
        }
    }
    fail_msg("no row %s", name);
    return rows[0];
}

static size_t bytes_of_measures(const plumb_world *w)
{
    plumb_memory_row rows[32];
    const int count = plumb_world_memory(w, rows, 32);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, "measures") == 0) {
            return rows[i].bytes;
        }
    }
    fail();
    return 0;
}

static void off_nothing_of_it_is_there(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const char *rows[] = { "measure", "measure bodies", "measure contacts", "measure sums" };
    assert_false(plumb_world_settings(w).measure);
    for (int on = 0; on < 3; ++on) {
        assert_int_equal(plumb_world_set_measure(w, on == 1), PLUMB_OK);
        assert_true(plumb_world_settings(w).measure == (on == 1));
        assert_int_equal(plumb_world_step(w, (plumb_real)0.01), PLUMB_OK);
        for (int i = 0; i < 4; ++i) {
            assert_true(row_of(w, rows[i]).scheduled == (on == 1));
        }
        // Of the last step that was measured.
        assert_int_equal(plumb_world_measures(w)->step, on == 0 ? 0 : 2);
        assert_true((bytes_of_measures(w) > 0) == (on > 0));
    }
    assert_string_equal(row_of(w, "measure").reason, "nobody asked the world to measure its error");
}

// Nor does a step that moves nothing measure anything anew.
static void a_step_of_0_leaves_the_measures(void **state)
{
    fixture *f = *state;
    plumb_world_set_measure(f->world, true);
    plumb_world_step(f->world, (plumb_real)0.01);
    const plumb_measures first = *plumb_world_measures(f->world);
    plumb_body_teleport(f->world, f->dynamic, plumb_v2(3, 4), 0);
    assert_int_equal(plumb_world_step(f->world, 0), PLUMB_OK);
    assert_memory_equal(&first, plumb_world_measures(f->world), sizeof first);
}

static void names_and_refusals(void **state)
{
    (void)state;
    assert_string_equal(plumb_work_name(PLUMB_WORK_GRAVITY), "gravity");
    assert_string_equal(plumb_work_name(PLUMB_WORK_REST), "rest");
    assert_null(plumb_work_name(PLUMB_WORKS));
    assert_non_null(plumb_work_text(PLUMB_WORK_SPRINGS));
    assert_null(plumb_work_text(PLUMB_WORKS));
    assert_null(plumb_world_measures(NULL));
    assert_int_equal(plumb_world_set_measure(NULL, true), PLUMB_E_NULL);
}

static void do_nothing(const plumb_system_call *call)
{
    (void)call;
}

// Contact systems run in it, even where no step has been measured yet.
static void a_step_of_0_with_systems_measures_nothing(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_world_set_measure(w, true);
    plumb_world_set_watchdog(w, true);
    const plumb_system_desc system = { .name = "idle",
                                       .phase = PLUMB_PHASE_CONTACTS,
                                       .run = do_nothing };
    assert_int_equal(plumb_system_create(w, &system), PLUMB_OK);
    assert_int_equal(plumb_world_step(w, 0), PLUMB_OK);
    assert_int_equal(plumb_world_measures(w)->step, 0);
    assert_int_equal(plumb_world_step(w, (plumb_real)0.01), PLUMB_OK);
    const plumb_measures first = *plumb_world_measures(w);
    plumb_body_teleport(w, f->dynamic, plumb_v2(3, 4), 0);
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(9, 9));
    assert_int_equal(plumb_world_step(w, 0), PLUMB_OK);
    assert_memory_equal(&first, plumb_world_measures(w), sizeof first);
}

// A joint of what never moves is not begun, whoever looks on.
static void looking_on_changes_no_bit_of_joints_of_nothing(void **state)
{
    (void)state;
    enum { PLAIN, MEASURED, CHECKED, WATCHED, WAYS };
    for (int solver = 0; solver < 3; ++solver) {
        uint64_t hashes[WAYS];
        for (int way = 0; way < WAYS; ++way) {
            plumb_world *w;
            const plumb_world_desc desc = { .solver = (plumb_solver)solver,
                                            .measure = way == MEASURED,
                                            .watchdog = way == WATCHED };
            assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
            plumb_world_watch(w, way == CHECKED ? PLUMB_WATCH_WRITES : PLUMB_WATCH_NOTHING);
            const plumb_body wall = plumb_body_create(
                w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 1, 1 } });
            plumb_joint_create(w, &(plumb_joint_desc){ .body_b = wall });
            plumb_joint_create(
                w, &(plumb_joint_desc){ .kind = PLUMB_WELD, .body_b = wall, .tell_impulse = true });
            plumb_world_step(w, (plumb_real)0.01);
            hashes[way] = plumb_world_hash(w);
            assert_true(hashes[way] == hashes[PLAIN]);
            plumb_world_destroy(w);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(off_nothing_of_it_is_there),
        API_TEST(a_step_of_0_leaves_the_measures),
        API_TEST(a_step_of_0_with_systems_measures_nothing),
        cmocka_unit_test(looking_on_changes_no_bit_of_joints_of_nothing),
        cmocka_unit_test(names_and_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
