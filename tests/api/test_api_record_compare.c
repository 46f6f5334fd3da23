// test_api_record_compare.c - record.h: what is not alike in two worlds, and where two recordings differ first.
#include "record_fixture.h"

//---- differences ---------------------------------------------------------------------------------
static void equal_worlds_do_not_differ(void **state)
{
    (void)state;
    game a, b;
    int count = -1;
    make_game(&a, true);
    make_game(&b, true);
    assert_int_equal(plumb_world_compare(a.world, b.world, NULL, 0, &count), PLUMB_OK);
    assert_int_equal(count, 0);
    play(&a);
    play(&b);
    assert_int_equal(plumb_world_compare(a.world, b.world, NULL, 0, &count), PLUMB_OK);
    assert_int_equal(count, 0);
    free_game(&a);
    free_game(&b);
}

static void check_row(const plumb_difference *row, plumb_difference_kind kind, plumb_entity entity,
                      const char *table, const char *component, const char *a, const char *b)
{
    assert_int_equal(row->kind, kind);
    assert_true(plumb_same(row->entity, entity));
    assert_string_equal(row->table, table);
    assert_string_equal(row->component, component);
    assert_string_equal(row->a, a);
    assert_string_equal(row->b, b);
}

static void differences_are_named(void **state)
{
    (void)state;
    plumb_difference rows[8];
    const plumb_entity none = PLUMB_NULL_ENTITY_INIT;
    game a, b;
    int count;
    make_game(&a, false);
    make_game(&b, false);
    plumb_body_set_velocity(b.world, b.ball, (plumb_vec2){ R(0.5), 0 });
    assert_int_equal(plumb_world_compare(a.world, b.world, rows, 8, &count), PLUMB_OK);
    assert_int_equal(count, 1);
    check_row(&rows[0], PLUMB_DIFFERS, a.ball.entity, "bodies", "vx", "0", "0.5");
    plumb_body_set_velocity(b.world, b.ball, (plumb_vec2){ 0, 0 });

    ((mark *)plumb_component_get(b.world, b.boxes[0].entity, b.mark))->hits = 7;
    plumb_world_set_gravity(b.world, (plumb_vec2){ 0, -1 });
    plumb_joint_set_motor(b.world, b.hinge, true, 2, 10);
    assert_int_equal(plumb_world_compare(a.world, b.world, rows, 8, &count), PLUMB_OK);
    assert_int_equal(count, 5);
    check_row(&rows[0], PLUMB_DIFFERS, a.hinge.entity, "joints", "desc.enable_motor", "false",
              "true");
    check_row(&rows[1], PLUMB_DIFFERS, a.hinge.entity, "joints", "desc.motor_speed", "0", "2");
    check_row(&rows[2], PLUMB_DIFFERS, a.hinge.entity, "joints", "desc.max_motor", "0", "10");
    check_row(&rows[3], PLUMB_DIFFERS, a.boxes[0].entity, "components", "mark.hits", "1", "7");
    check_row(&rows[4], PLUMB_DIFFERS, none, "world", "gravity",
              sizeof(plumb_real) == 4 ? "(0, -9.81000042)" : "(0, -9.8100000000000005)", "(0, -1)");

    plumb_body extra = plumb_body_create(b.world, &(plumb_body_desc){ 0 });
    plumb_body_destroy(b.world, b.boxes[1]);
    assert_int_equal(plumb_world_compare(a.world, b.world, rows, 8, &count), PLUMB_OK);
    check_row(&rows[0], PLUMB_ONLY_A, a.boxes[1].entity, "bodies", "", "", "");
    check_row(&rows[1], PLUMB_ONLY_B, extra.entity, "bodies", "", "", "");
    free_game(&a);
    free_game(&b);
}

static void worlds_that_cannot_be_compared(void **state)
{
    fixture *f = *state;
    game g;
    int count;
    make_game(&g, false);
    assert_int_equal(plumb_world_compare(NULL, f->world, NULL, 0, &count), PLUMB_E_NULL);
    assert_int_equal(plumb_world_compare(f->world, NULL, NULL, 0, &count), PLUMB_E_NULL);
    REFUSED(E_NULL, "plumb_world_compare: count is null; it must be given",
            plumb_world_compare(f->world, f->world, NULL, 0, NULL));
    REFUSED(E_IMAGE,
            "plumb_world_compare: b has other components; register the same ones in the same "
            "order",
            plumb_world_compare(f->world, g.world, NULL, 0, &count));
    free_game(&g);
}

static void equal_recordings_do_not_differ(void **state)
{
    (void)state;
    game a, b;
    plumb_replay_difference d;
    record_game(&a, true);
    record_game(&b, true);
    plumb_replay *ra = open_tape(&a.tape, NULL);
    plumb_replay *rb = open_tape(&b.tape, &(plumb_replay_desc){ .simd_width = 4 });
    assert_int_equal(plumb_replay_compare(ra, rb, &d), PLUMB_OK);
    assert_false(d.found);
    assert_string_equal(d.pass, "");
    assert_int_equal(plumb_replay_compare(NULL, rb, &d), PLUMB_E_NULL);
    assert_int_equal(plumb_replay_compare(ra, NULL, &d), PLUMB_E_NULL);
    assert_int_equal(plumb_replay_compare(ra, rb, NULL), PLUMB_E_NULL);
    plumb_replay_close(ra);
    plumb_replay_close(rb);
    free_game(&a);
    free_game(&b);
}

// Records with something done before step `at`.
static void record_with(recording *tape, int at, void (*change)(game *g), bool systems)
{
    game g;
    make_game(&g, systems);
    const plumb_recorder_desc desc = { .write = to_recording, .context = &g.tape };
    assert_int_equal(plumb_recorder_start(g.world, &desc), PLUMB_OK);
    for (int i = 1; i <= 40; ++i) {
        if (i == at) {
            change(&g);
        }
        assert_int_equal(plumb_world_step(g.world, DT), PLUMB_OK);
    }
    assert_int_equal(plumb_recorder_stop(g.world), PLUMB_OK);
    plumb_world_destroy(g.world);
    *tape = g.tape;
}

static void push_ball(game *g)
{
    plumb_body_set_velocity(g->world, g->ball, (plumb_vec2){ 2, 0 });
}

static void more_substeps(game *g)
{
    plumb_world_set_substeps(g->world, 8, 1);
}

static void stop_wind(game *g)
{
    plumb_system_enable(g->world, "wind", false);
}

static void nothing(game *g)
{
    (void)g;
}

static void check_difference(void (*change)(game *g), uint64_t step, const char *pass,
                             const char *component)
{
    recording a, b;
    game names;
    plumb_replay_difference d;
    make_game(&names, true);
    record_with(&a, 0, nothing, true);
    record_with(&b, 17, change, true);
    plumb_replay *ra = open_tape(&a, NULL), *rb = open_tape(&b, NULL);
    assert_int_equal(plumb_replay_compare(ra, rb, &d), PLUMB_OK);
    assert_true(d.found);
    assert_int_equal(d.step, step);
    assert_string_equal(d.pass, pass);
    if (component != NULL) {
        assert_string_equal(d.first.table, "bodies");
        assert_string_equal(d.first.component, component);
        assert_true(plumb_same(d.first.entity, names.ball.entity));
    }
    // Both stand behind the step.
    plumb_replay_info at;
    assert_int_equal(plumb_replay_get_info(ra, &at), PLUMB_OK);
    assert_int_equal(at.step, step);
    assert_int_equal(plumb_replay_get_info(rb, &at), PLUMB_OK);
    assert_int_equal(at.step, step);
    plumb_replay_close(ra);
    plumb_replay_close(rb);
    free_game(&names);
    recording_free(&a);
    recording_free(&b);
}

static void the_pass_that_differs_is_named(void **state)
{
    (void)state;
    check_difference(push_ball, 17, "edits", "vx");
    check_difference(more_substeps, 17, "soft step", NULL);
    check_difference(stop_wind, 17, "force systems", "fx");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_worlds_do_not_differ),
        cmocka_unit_test(differences_are_named),
        API_TEST(worlds_that_cannot_be_compared),
        cmocka_unit_test(equal_recordings_do_not_differ),
        cmocka_unit_test(the_pass_that_differs_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
