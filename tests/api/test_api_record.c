// test_api_record.c - record.h: a world whose user interferes in every way that the API has is replayed in
// the same bits; what recorder and replay tell of it.
#include "record_fixture.h"

static void replay_all(const game *g, const plumb_replay_desc *desc)
{
    plumb_replay *replay = open_tape(&g->tape, desc);
    check_at(replay, g, 0);
    for (int i = 1; i <= STEPS; ++i) {
        plumb_result r = plumb_replay_step(replay);
        if (r != PLUMB_OK) {
            print_error("%s\n", plumb_replay_error(replay));
        }
        assert_int_equal(r, PLUMB_OK);
        check_at(replay, g, i);
    }
    assert_int_equal(plumb_replay_step(replay), PLUMB_E_MISSING);
    plumb_replay_close(replay);
}

static void whatever_a_user_does_is_replayed(void **state)
{
    (void)state;
    game g;
    record_game(&g, true);
    replay_all(&g, NULL);
    replay_all(&g, &(plumb_replay_desc){ .simd_width = 4, .workers = 3 });
    replay_all(&g, &(plumb_replay_desc){ .simd_width = 16, .list_edits = true });
    free_game(&g);
}

static void without_systems_too(void **state)
{
    (void)state;
    game g;
    record_game(&g, false);
    replay_all(&g, NULL);
    free_game(&g);
}

static void recording_changes_nothing(void **state)
{
    (void)state;
    game with, without;
    record_game(&with, true);
    make_game(&without, true);
    without.hashes[0] = plumb_world_hash(without.world);
    play(&without);
    assert_memory_equal(with.hashes, without.hashes, sizeof with.hashes);
    free_game(&with);
    free_game(&without);
}

static void seeks_go_anywhere(void **state)
{
    (void)state;
    game g;
    record_game(&g, true);
    plumb_replay *replay = open_tape(&g.tape, NULL);
    // Before, at and behind keyframes, and over the step at which a component was registered.
    static const int to[] = { 75, 20, 21, 19, 33, 32, 34, 31, 150, 0, 1, 40, 39, 100, 33, 32, 150 };
    for (size_t i = 0; i < sizeof to / sizeof to[0]; ++i) {
        assert_int_equal(plumb_replay_seek(replay, (uint64_t)to[i]), PLUMB_OK);
        check_at(replay, &g, to[i]);
    }
    for (int at = STEPS - 1; at >= STEPS - 130; --at) {
        assert_int_equal(plumb_replay_step_back(replay), PLUMB_OK);
        check_at(replay, &g, at);
    }
    plumb_replay_close(replay);
    free_game(&g);
}

static void contacts_and_events_are_those_of_the_step(void **state)
{
    (void)state;
    game g;
    record_game(&g, true);
    plumb_replay *through = open_tape(&g.tape, NULL), *there = open_tape(&g.tape, NULL);
    int events = 0;
    for (int i = 1; i <= 60; ++i) {
        assert_int_equal(plumb_replay_step(through), PLUMB_OK);
        assert_int_equal(plumb_replay_seek(there, 0), PLUMB_OK);
        assert_int_equal(plumb_replay_seek(there, (uint64_t)i), PLUMB_OK);
        plumb_stats a = plumb_world_stats(plumb_replay_world(through));
        plumb_stats b = plumb_world_stats(plumb_replay_world(there));
        assert_int_equal(a.contact_count, b.contact_count);
        assert_int_equal(a.point_count, b.point_count);
        int count, again;
        plumb_world_begin_events(plumb_replay_world(through), &count);
        plumb_world_begin_events(plumb_replay_world(there), &again);
        events += count;
        assert_int_equal(count, again);
    }
    assert_in_range(events, 5, 1000);
    plumb_replay_close(through);
    plumb_replay_close(there);
    free_game(&g);
}

//---- what it tells -------------------------------------------------------------------------------
static void it_tells_of_itself(void **state)
{
    (void)state;
    game g;
    record_game(&g, false);
    plumb_replay *replay = open_tape(&g.tape, NULL);
    plumb_replay_info info;
    assert_int_equal(plumb_replay_get_info(replay, &info), PLUMB_OK);
    assert_string_equal(info.title, "a game");
    assert_int_equal(info.steps, STEPS);
    assert_int_equal(info.step_count, 0);
    assert_int_equal(info.keyframe_every, KEYS);
    assert_int_equal(info.keyframes, 1 + STEPS / KEYS + 1); // the head, one for the component
    assert_int_equal(info.bytes, g.tape.size);
    assert_true(info.complete);
    assert_true(info.dt == 0);
    assert_near(info.end, plumb_world_stats(g.world).time, 1e-12);
    assert_int_equal(info.edited, 7); // of interfere, but for the step that was refused
    plumb_replay_close(replay);
    free_game(&g);
}

static void check_note(const plumb_replay *replay, uint64_t key, const char *text)
{
    size_t size = 77;
    const char *note = plumb_replay_note(replay, key, &size);
    assert_int_equal(size, strlen(text));
    assert_true((note == NULL) == (size == 0));
    if (note != NULL) {
        assert_memory_equal(note, text, size);
        assert_int_equal((uintptr_t)note % 8, 0);
    }
}

static void notes_hold_from_their_step_on(void **state)
{
    (void)state;
    game g;
    make_game(&g, false);
    const plumb_recorder_desc desc = { .write = to_recording,
                                       .context = &g.tape,
                                       .keyframe_every = 4 };
    assert_int_equal(plumb_recorder_start(g.world, &desc), PLUMB_OK);
    assert_int_equal(plumb_recorder_note(g.world, 7, "old", 3), PLUMB_OK);
    assert_int_equal(plumb_recorder_note(g.world, 7, "head", 4), PLUMB_OK);
    for (int i = 1; i <= 12; ++i) {
        plumb_world_step(g.world, DT);
        if (i == 3) {
            assert_int_equal(plumb_recorder_note(g.world, UINT64_MAX, "score 3, level 1", 16),
                             PLUMB_OK);
            assert_int_equal(plumb_recorder_note(g.world, 0, "zero", 4), PLUMB_OK);
        }
        if (i == 5 || i == 9) {
            assert_int_equal(
                plumb_recorder_note(g.world, 7, i == 5 ? "five" : NULL, i == 5 ? 4 : 0), PLUMB_OK);
        }
    }
    assert_int_equal(plumb_recorder_get_info(g.world).bytes, g.tape.size);
    assert_int_equal(plumb_recorder_stop(g.world), PLUMB_OK);
    plumb_replay *replay = open_tape(&g.tape, NULL);
    static const int places[] = { 0, 12, 4, 5, 2, 3, 8, 9, 0 };
    for (size_t i = 0; i < sizeof places / sizeof places[0]; ++i) {
        int step = places[i];
        assert_int_equal(plumb_replay_seek(replay, (uint64_t)step), PLUMB_OK);
        check_note(replay, 7, step < 5 ? "head" : step < 9 ? "five" : "");
        check_note(replay, UINT64_MAX, step < 3 ? "" : "score 3, level 1");
        check_note(replay, 0, step < 3 ? "" : "zero");
        check_note(replay, 8, "");
    }
    assert_non_null(plumb_replay_note(replay, 7, NULL));
    check_note(NULL, 7, "");
    plumb_replay_close(replay);
    free_game(&g);
}

// What is noted is not part of what happened.
static void notes_are_no_difference(void **state)
{
    (void)state;
    game g[2];
    plumb_replay *replays[2];
    for (int k = 0; k < 2; ++k) {
        make_game(&g[k], false);
        const plumb_recorder_desc desc = { .write = to_recording, .context = &g[k].tape };
        assert_int_equal(plumb_recorder_start(g[k].world, &desc), PLUMB_OK);
        for (int i = 1; i <= 5; ++i) {
            plumb_world_step(g[k].world, DT);
            if (k == 1) {
                assert_int_equal(plumb_recorder_note(g[k].world, 1, &i, sizeof i), PLUMB_OK);
            }
        }
        assert_int_equal(plumb_recorder_stop(g[k].world), PLUMB_OK);
        replays[k] = open_tape(&g[k].tape, NULL);
    }
    plumb_replay_difference d;
    assert_int_equal(plumb_replay_compare(replays[0], replays[1], &d), PLUMB_OK);
    assert_false(d.found);
    for (int k = 0; k < 2; ++k) {
        plumb_replay_close(replays[k]);
        free_game(&g[k]);
    }
}

static void names_and_times_are_found(void **state)
{
    (void)state;
    game g;
    record_game(&g, false);
    plumb_replay *replay = open_tape(&g.tape, NULL);
    assert_string_equal(plumb_replay_name(replay, g.ball.entity), "the ball");
    assert_null(plumb_replay_name(replay, g.floor.entity));
    assert_null(plumb_replay_name(replay, (plumb_entity)PLUMB_NULL_ENTITY_INIT));
    assert_null(plumb_replay_name(NULL, g.ball.entity));
    assert_int_equal(plumb_replay_find(replay, -1), 0);
    assert_int_equal(plumb_replay_find(replay, 0), 0);
    assert_int_equal(plumb_replay_find(replay, 1e9), STEPS);
    assert_int_equal(plumb_replay_find(NULL, 1), 0);
    for (uint64_t step = 1; step < STEPS; step += 7) {
        plumb_replay_info info;
        assert_int_equal(plumb_replay_seek(replay, step), PLUMB_OK);
        assert_int_equal(plumb_replay_get_info(replay, &info), PLUMB_OK);
        assert_int_equal(plumb_replay_find(replay, info.time), step);
        assert_int_equal(plumb_replay_find(replay, info.time + 1e-4), step);
        assert_int_equal(plumb_replay_find(replay, info.time - 1e-4), step - 1);
    }
    plumb_replay_close(replay);
    free_game(&g);
}

// The edit of `component` of an entity in the step that led here; null: there is none.
static const plumb_replay_edit *find_edit(const plumb_replay_edit *edits, int count, int phase,
                                          plumb_entity entity, const char *component)
{
    for (int i = 0; i < count; ++i) {
        if (edits[i].phase == phase && plumb_same(edits[i].change.entity, entity) &&
            strcmp(edits[i].change.component, component) == 0) {
            return &edits[i];
        }
    }
    return NULL;
}

static void edits_are_told(void **state)
{
    (void)state;
    static plumb_replay_edit edits[512];
    game g;
    record_game(&g, true);
    plumb_replay *replay = open_tape(&g.tape, &(plumb_replay_desc){ .list_edits = true });
    assert_int_equal(plumb_replay_edits(replay, edits, 512), 0);
    assert_int_equal(plumb_replay_seek(replay, 5), PLUMB_OK);
    int count = plumb_replay_edits(replay, edits, 512);
    const plumb_replay_edit *e = find_edit(edits, count, -1, g.ball.entity, "vx");
    assert_non_null(e);
    assert_int_equal(e->change.kind, PLUMB_DIFFERS);
    assert_string_equal(e->change.table, "bodies");
    assert_string_equal(e->change.b, "6");
    assert_non_null(find_edit(edits, count, PLUMB_PHASE_FORCES, g.ball.entity, "fx"));
    assert_non_null(find_edit(edits, count, PLUMB_PHASE_BEGIN, g.boxes[0].entity, "mark.heat"));
    assert_non_null(find_edit(edits, count, PLUMB_PHASE_END, g.boxes[0].entity, "mark.hits"));
    assert_null(find_edit(edits, count, -1, g.ball.entity, "user_data"));

    assert_int_equal(plumb_replay_seek(replay, 12), PLUMB_OK);
    count = plumb_replay_edits(replay, edits, 512);
    assert_non_null(find_edit(edits, count, -1, g.hinge.entity, "desc.motor_speed"));
    e = find_edit(edits, count, -1, (plumb_entity)PLUMB_NULL_ENTITY_INIT, "gravity");
    assert_non_null(e);
    assert_string_equal(e->change.b, "(0.5, -9)");

    assert_int_equal(plumb_replay_seek(replay, 20), PLUMB_OK);
    count = plumb_replay_edits(replay, edits, 512);
    e = find_edit(edits, count, -1, g.ball.entity, "");
    assert_non_null(e);
    assert_string_equal(e->change.table, "settings");
    assert_int_equal(e->change.kind, PLUMB_ONLY_B);

    assert_int_equal(plumb_replay_seek(replay, 50), PLUMB_OK);
    count = plumb_replay_edits(replay, edits, 512);
    e = find_edit(edits, count, -1, g.boxes[4].entity, "");
    assert_non_null(e);
    assert_int_equal(e->change.kind, PLUMB_ONLY_A);
    assert_int_equal(e->change.entity_kind, PLUMB_KIND_BODY);
    e = find_edit(edits, count, -1, g.boxes[1].entity, "y");
    assert_non_null(e);
    assert_string_equal(e->change.b, "6");
    // A list that is too short is filled, and told to be.
    assert_int_equal(plumb_replay_edits(replay, edits, 1), count);
    assert_int_equal(plumb_replay_edits(replay, NULL, 0), count);
    assert_int_equal(plumb_replay_edits(NULL, edits, 1), 0);
    plumb_replay_close(replay);
    free_game(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whatever_a_user_does_is_replayed),
        cmocka_unit_test(without_systems_too),
        cmocka_unit_test(recording_changes_nothing),
        cmocka_unit_test(seeks_go_anywhere),
        cmocka_unit_test(contacts_and_events_are_those_of_the_step),
        cmocka_unit_test(it_tells_of_itself),
        cmocka_unit_test(names_and_times_are_found),
        cmocka_unit_test(notes_hold_from_their_step_on),
        cmocka_unit_test(notes_are_no_difference),
        cmocka_unit_test(edits_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
