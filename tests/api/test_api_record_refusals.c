// test_api_record_refusals.c - record.h: damaged recordings, every error of the recorder and the replay, full disks,
// memory that runs out.
#include "record_fixture.h"

//---- bad recordings ------------------------------------------------------------------------------
static void small_recording(recording *tape)
{
    plumb_world *w;
    *tape = (recording){ 0 };
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    plumb_body ball = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, 1 } });
    const plumb_recorder_desc desc = { .write = to_recording,
                                       .context = tape,
                                       .keyframe_every = 4 };
    assert_int_equal(plumb_recorder_start(w, &desc), PLUMB_OK);
    assert_int_equal(plumb_recorder_name(w, ball.entity, "ball"), PLUMB_OK);
    assert_int_equal(plumb_recorder_note(w, 1, "note", 4), PLUMB_OK);
    for (int i = 0; i < 6; ++i) {
        if (i == 2) {
            plumb_body_set_velocity(w, ball, (plumb_vec2){ 1, 1 });
        }
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
    assert_int_equal(plumb_recorder_stop(w), PLUMB_OK);
    plumb_world_destroy(w);
}

// Opened, it plays to its end or tells why not. Steps played, -1: refused.
static int play_bytes(const char *bytes, size_t size)
{
    plumb_replay *replay;
    plumb_result r = plumb_replay_open(bytes, size, NULL, &replay);
    if (r != PLUMB_OK) {
        assert_int_equal(r, PLUMB_E_IMAGE);
        assert_null(replay);
        return -1;
    }
    int steps = 0;
    while ((r = plumb_replay_step(replay)) == PLUMB_OK) {
        ++steps;
    }
    assert_int_equal(r, PLUMB_E_MISSING);
    plumb_replay_close(replay);
    return steps;
}

static void a_recording_cut_anywhere_is_a_prefix(void **state)
{
    (void)state;
    recording tape;
    small_recording(&tape);
    int longest = -1;
    for (size_t size = 0; size <= tape.size; ++size) {
        char *cut = malloc(size + 1); // so that a sanitizer sees what is read beyond
        assert_non_null(cut);
        memcpy(cut, tape.bytes, size);
        int steps = play_bytes(cut, size);
        assert_true(steps >= longest);
        longest = steps;
        free(cut);
    }
    assert_int_equal(longest, 6);
    recording_free(&tape);
}

static void a_flipped_bit_is_found(void **state)
{
    (void)state;
    recording tape;
    small_recording(&tape);
    int shorter = 0;
    for (size_t bit = 0; bit < 8 * tape.size; ++bit) {
        tape.bytes[bit / 8] = (char)(tape.bytes[bit / 8] ^ 1 << bit % 8);
        shorter += play_bytes(tape.bytes, tape.size) >= 0;
        tape.bytes[bit / 8] = (char)(tape.bytes[bit / 8] ^ 1 << bit % 8);
    }
    assert_int_equal(shorter, 0);
    assert_int_equal(play_bytes(tape.bytes, tape.size), 6);
    recording_free(&tape);
}

typedef struct message {
    char text[512];
    int count;
} message;

static void keep_message(void *context, plumb_log_level level, const char *text)
{
    message *m = context;
    assert_int_equal(level, PLUMB_LOG_ERROR);
    strncpy(m->text, text, sizeof m->text - 1);
    ++m->count;
}

static void check_open(const void *bytes, size_t size, const char *wrong)
{
    message m = { "", 0 };
    char text[256];
    plumb_replay *replay = (plumb_replay *)&m; // anything but null
    const plumb_replay_desc desc = { .log = keep_message, .hook_context = &m };
    assert_int_equal(plumb_replay_open(bytes, size, &desc, &replay), PLUMB_E_IMAGE);
    assert_null(replay);
    snprintf(text, sizeof text, "plumb_replay_open: bytes %s; it must be as it was recorded",
             wrong);
    assert_string_equal(m.text, text);
    assert_int_equal(m.count, 1);
}

static void what_is_no_recording_is_refused(void **state)
{
    (void)state;
    recording tape;
    small_recording(&tape);
    check_open("hello", 5, "is no recording");
    check_open("hello, world", 12, "is no recording");
    check_open("GERBMULP", 8, "is no recording");
    check_open("CERBMULP", 8, "was made on a machine of another byte order");
    check_open(tape.bytes, 100, "is truncated before its first step");
    check_open(tape.bytes, 1000, "is truncated before its first step");
    tape.bytes[tape.size / 2] ^= 4;
    check_open(tape.bytes, tape.size, "is damaged");
    recording_free(&tape);
}

static void a_replay_notices_what_is_done_to_its_world(void **state)
{
    (void)state;
    game g;
    record_game(&g, false);
    plumb_replay *replay = open_tape(&g.tape, NULL);
    plumb_replay_info info;
    assert_int_equal(plumb_replay_seek(replay, 3), PLUMB_OK);
    plumb_body_set_velocity(plumb_replay_world(replay), g.ball, (plumb_vec2){ 0, 9 });
    for (int k = 0; k < 2; ++k) { // it is said again
        assert_int_equal(plumb_replay_step(replay), PLUMB_E_IMAGE);
        assert_string_equal(plumb_replay_error(replay),
                            "plumb_replay_step: step 4 does not give the bits that were "
                            "recorded; another build recorded it, or the world was changed");
        assert_int_equal(plumb_replay_get_info(replay, &info), PLUMB_OK);
        assert_true(info.differs);
        assert_int_equal(info.step, 4);
    }
    assert_int_equal(plumb_replay_seek(replay, 4), PLUMB_OK);
    check_at(replay, &g, 4);
    assert_int_equal(plumb_replay_seek(replay, STEPS), PLUMB_OK);
    check_at(replay, &g, STEPS);
    plumb_replay_close(replay);
    free_game(&g);
}

//---- refused calls -------------------------------------------------------------------------------
static void the_recorder_refuses(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    recording tape = { 0 };
    char title[300];
    memset(title, 'x', sizeof title);
    title[sizeof title - 1] = '\0';
    plumb_recorder_desc desc = { .write = to_recording, .context = &tape };
    assert_int_equal(plumb_recorder_start(NULL, &desc), PLUMB_E_NULL);
    assert_int_equal(plumb_recorder_stop(NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_recorder_name(NULL, f->dynamic.entity, "x"), PLUMB_E_NULL);
    assert_int_equal(plumb_recorder_note(NULL, 1, "x", 1), PLUMB_E_NULL);
    assert_false(plumb_recorder_get_info(NULL).recording);
    assert_false(plumb_recorder_get_info(w).recording);
    REFUSED(E_NULL, "plumb_recorder_start: desc is null; it must be given",
            plumb_recorder_start(w, NULL));
    REFUSED(E_NULL, "plumb_recorder_start: write is null; it must be given",
            plumb_recorder_start(w, &(plumb_recorder_desc){ 0 }));
    desc.keyframe_every = -1;
    REFUSED(E_RANGE, "plumb_recorder_start: keyframe_every is -1; it must be 0 to 1000000",
            plumb_recorder_start(w, &desc));
    desc.keyframe_every = 1000001;
    REFUSED(E_RANGE, "plumb_recorder_start: keyframe_every is 1000001; it must be 0 to 1000000",
            plumb_recorder_start(w, &desc));
    desc.keyframe_every = 0;
    desc.title = title;
    REFUSED(E_RANGE,
            "plumb_recorder_start: title is 'xxxxxxxxxxxxxxxx...'; it must have at most 255 "
            "characters",
            plumb_recorder_start(w, &desc));
    desc.title = NULL;
    REFUSED(E_STATE, "plumb_recorder_stop: the world is not recorded; start that first",
            plumb_recorder_stop(w));
    REFUSED(E_STATE, "plumb_recorder_name: the world is not recorded; start that first",
            plumb_recorder_name(w, f->dynamic.entity, "x"));
    REFUSED(E_STATE, "plumb_recorder_note: the world is not recorded; start that first",
            plumb_recorder_note(w, 1, "x", 1));
    assert_int_equal(tape.size, 0);
    assert_int_equal(plumb_recorder_start(w, &desc), PLUMB_OK);
    REFUSED(E_STATE, "plumb_recorder_start: the world is recorded already; stop that first",
            plumb_recorder_start(w, &desc));
    REFUSED(E_RANGE, "plumb_recorder_name: name is empty; it must have 1 to 63 characters",
            plumb_recorder_name(w, f->dynamic.entity, ""));
    REFUSED(E_NULL, "plumb_recorder_name: name is null; it must be given",
            plumb_recorder_name(w, f->dynamic.entity, NULL));
    REFUSED(E_HANDLE, "plumb_recorder_name: entity is null; it must be a live entity",
            plumb_recorder_name(w, (plumb_entity)PLUMB_NULL_ENTITY_INIT, "x"));
    REFUSED(E_NULL, "plumb_recorder_note: bytes is null; it must be given",
            plumb_recorder_note(w, 1, NULL, 1));
    REFUSED(E_RANGE, "plumb_recorder_note: size is 1048577; it must be 0 to 1048576",
            plumb_recorder_note(w, 1, title, PLUMB_NOTE_MAX + 1));
    assert_true(plumb_recorder_get_info(w).recording);
    assert_int_equal(plumb_recorder_stop(w), PLUMB_OK);
    recording_free(&tape);
}

static plumb_recorder_desc locked_desc;
static plumb_result locked_start, locked_stop;

static void call_recorder(const plumb_system_call *call)
{
    locked_start = plumb_recorder_start(call->world, &locked_desc);
    locked_stop = plumb_recorder_stop(call->world);
}

static void a_system_cannot_start_or_stop_it(void **state)
{
    fixture *f = *state;
    recording tape = { 0 };
    locked_desc = (plumb_recorder_desc){ .write = to_recording, .context = &tape };
    const plumb_system_desc desc = { .name = "meddler", .run = call_recorder };
    assert_int_equal(plumb_system_create(f->world, &desc), PLUMB_OK);
    assert_int_equal(plumb_world_step(f->world, DT), PLUMB_OK);
    assert_int_equal(locked_start, PLUMB_E_LOCKED);
    assert_int_equal(locked_stop, PLUMB_E_LOCKED);
    assert_int_equal(tape.size, 0);
}

typedef struct disk {
    recording tape;
    size_t room;
} disk;

static bool to_disk(void *context, const void *bytes, size_t size)
{
    disk *d = context;
    if (d->tape.size + size > d->room) {
        if (d->room > d->tape.size) { // as a full disk does
            to_recording(&d->tape, bytes, d->room - d->tape.size);
        }
        d->room = 0;
        return false;
    }
    return to_recording(&d->tape, bytes, size);
}

static void a_full_disk_ends_the_recording_not_the_world(void **state)
{
    (void)state;
    for (size_t room = 0; room < 9000; room += 37) {
        game g;
        disk d = { { 0 }, room };
        make_game(&g, false);
        const plumb_recorder_desc desc = { .write = to_disk, .context = &d };
        plumb_result started = plumb_recorder_start(g.world, &desc);
        if (started != PLUMB_OK) {
            assert_int_equal(started, PLUMB_E_WRITE);
            assert_string_equal(plumb_world_error(g.world).message,
                                "plumb_recorder_start: the write function took no more");
            free_game(&g);
            recording_free(&d.tape);
            continue;
        }
        for (int i = 1; i <= 30; ++i) {
            plumb_result noted = plumb_recorder_note(g.world, 1, &i, sizeof i);
            assert_int_equal(noted, plumb_recorder_get_info(g.world).ended);
            if (noted != PLUMB_OK) {
                assert_string_equal(plumb_world_error(g.world).message,
                                    "plumb_recorder_note: the recording ended early: a write "
                                    "function took no more");
            }
            assert_int_equal(plumb_world_step(g.world, DT), PLUMB_OK);
        }
        plumb_recorder_info info = plumb_recorder_get_info(g.world);
        assert_true(info.steps < 30 ? info.ended == PLUMB_E_WRITE : true);
        int steps = play_bytes(d.tape.bytes, d.tape.size);
        assert_int_equal(steps, info.steps);
        plumb_result stopped = plumb_recorder_stop(g.world);
        assert_int_equal(stopped, info.steps < 30 || d.room == 0 ? PLUMB_E_WRITE : PLUMB_OK);
        if (stopped == PLUMB_E_WRITE) {
            assert_string_equal(plumb_world_error(g.world).message,
                                "plumb_recorder_stop: the recording ended early: a write "
                                "function took no more");
        }
        free_game(&g);
        recording_free(&d.tape);
    }
}

static void a_world_that_goes_ends_its_recording(void **state)
{
    (void)state;
    recording tape = { 0 };
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    const plumb_recorder_desc desc = { .write = to_recording, .context = &tape };
    assert_int_equal(plumb_recorder_start(w, &desc), PLUMB_OK);
    assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    plumb_world_destroy(w);
    plumb_replay *replay = open_tape(&tape, NULL);
    plumb_replay_info info;
    assert_int_equal(plumb_replay_get_info(replay, &info), PLUMB_OK);
    assert_true(info.complete);
    assert_int_equal(info.steps, 1);
    plumb_replay_close(replay);
    recording_free(&tape);
}

static void the_replay_refuses(void **state)
{
    (void)state;
    recording tape;
    small_recording(&tape);
    plumb_replay *replay;
    plumb_replay_info info;
    message m = { "", 0 };
    const plumb_replay_desc desc = { .log = keep_message, .hook_context = &m };
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, &desc, NULL), PLUMB_E_NULL);
    assert_string_equal(m.text, "plumb_replay_open: replay is null; it must be given");
    assert_int_equal(plumb_replay_open(NULL, 0, &desc, &replay), PLUMB_E_NULL);
    assert_string_equal(m.text, "plumb_replay_open: bytes is null; it must be given");
    assert_null(replay);
    assert_int_equal(
        plumb_replay_open(tape.bytes, tape.size, &(plumb_replay_desc){ .simd_width = 5 }, &replay),
        PLUMB_E_RANGE);
    assert_null(replay);
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size,
                                       &(plumb_replay_desc){
                                           .workers = 65, .log = keep_message, .hook_context = &m },
                                       &replay),
                     PLUMB_E_RANGE);
    assert_string_equal(m.text, "plumb_replay_open: simd_width is 0, workers is 65; they must be "
                                "as for plumb_world_create");
    assert_int_equal(plumb_replay_step(NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_replay_step_back(NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_replay_seek(NULL, 0), PLUMB_E_NULL);
    assert_int_equal(plumb_replay_get_info(NULL, &info), PLUMB_E_NULL);
    assert_null(plumb_replay_world(NULL));
    assert_string_equal(plumb_replay_error(NULL), "");
    plumb_replay_close(NULL);
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, &desc, &replay), PLUMB_OK);
    assert_string_equal(plumb_replay_error(replay), "");
    assert_int_equal(plumb_replay_get_info(replay, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_replay_step_back(replay), PLUMB_E_MISSING);
    assert_string_equal(plumb_replay_error(replay),
                        "plumb_replay_step_back: the recording begins here, at step 0");
    assert_int_equal(plumb_replay_seek(replay, 7), PLUMB_E_RANGE);
    assert_string_equal(plumb_replay_error(replay),
                        "plumb_replay_seek: step is 7; it must be 0 to 6");
    assert_int_equal(plumb_replay_seek(replay, 6), PLUMB_OK);
    const message before = m;
    assert_int_equal(plumb_replay_step(replay), PLUMB_E_MISSING);
    assert_string_equal(plumb_replay_error(replay),
                        "plumb_replay_step: the recording ends here, at step 6");
    assert_memory_equal(&m, &before, sizeof m); // a loop that ended is nothing for the log
    // The world of a replay is not recorded.
    const plumb_recorder_desc again = { .write = to_recording, .context = &tape };
    assert_int_equal(plumb_recorder_start(plumb_replay_world(replay), &again), PLUMB_E_STATE);
    assert_string_equal(plumb_world_error(plumb_replay_world(replay)).message,
                        "plumb_recorder_start: the world is that of a replay; it must not be");
    assert_int_equal(plumb_recorder_stop(plumb_replay_world(replay)), PLUMB_E_STATE);
    plumb_replay_close(replay);
    recording_free(&tape);
}

//---- memory --------------------------------------------------------------------------------------
static void a_replay_survives_each_failing_allocation(void **state)
{
    (void)state;
    recording tape;
    small_recording(&tape);
    int refused = 0;
    for (long k = 0;; ++k) {
        heap h = HEAP_INIT;
        heap_fail(&h, k);
        const plumb_replay_desc desc = { .allocator = heap_allocator(&h), .list_edits = true };
        plumb_replay *replay;
        plumb_result r = plumb_replay_open(tape.bytes, tape.size, &desc, &replay);
        if (r != PLUMB_OK) {
            assert_int_equal(r, PLUMB_E_MEMORY);
            assert_null(replay);
            ++refused;
            continue;
        }
        for (int i = 0; i < 6; ++i) {
            r = plumb_replay_step(replay);
            if (r != PLUMB_OK) { // going back makes it whole
                assert_int_equal(r, PLUMB_E_MEMORY);
                ++refused;
                assert_int_equal(plumb_replay_seek(replay, (uint64_t)i + 1), PLUMB_OK);
            }
        }
        assert_int_equal(plumb_replay_step(replay), PLUMB_E_MISSING);
        plumb_replay_close(replay);
        if (h.refused == 0) {
            break;
        }
    }
    assert_in_range(refused, 10, 10000);
    recording_free(&tape);
}

static void a_recorder_that_runs_out_of_memory_ends(void **state)
{
    (void)state;
    int ended = 0;
    for (long k = 0;; ++k) {
        heap h = HEAP_INIT;
        recording tape = { 0 };
        plumb_world *w;
        assert_int_equal(
            plumb_world_create(&(plumb_world_desc){ .allocator = heap_allocator(&h) }, &w),
            PLUMB_OK);
        plumb_body ball = plumb_body_create(w, &(plumb_body_desc){ 0 });
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
        heap_fail(&h, k);
        const plumb_recorder_desc desc = { .write = to_recording, .context = &tape };
        plumb_result r = plumb_recorder_start(w, &desc);
        assert_true(r == PLUMB_OK || r == PLUMB_E_MEMORY);
        for (int i = 0; r == PLUMB_OK && i < 4; ++i) {
            static const char bytes[5000];
            plumb_body_set_velocity(w, ball, (plumb_vec2){ (plumb_real)i, 1 });
            plumb_result noted = plumb_recorder_note(w, 1, bytes, 1500 * (size_t)i);
            assert_int_equal(noted, plumb_recorder_get_info(w).ended);
            assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
        }
        plumb_recorder_info info = plumb_recorder_get_info(w);
        if (r == PLUMB_OK) {
            assert_int_equal(play_bytes(tape.bytes, tape.size), info.steps);
            assert_int_equal(plumb_recorder_stop(w), info.ended);
        }
        ended += r != PLUMB_OK || info.ended != PLUMB_OK;
        plumb_world_destroy(w);
        recording_free(&tape);
        if (h.refused == 0) {
            break;
        }
    }
    assert_in_range(ended, 4, 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_recording_cut_anywhere_is_a_prefix),
        cmocka_unit_test(a_flipped_bit_is_found),
        cmocka_unit_test(what_is_no_recording_is_refused),
        cmocka_unit_test(a_replay_notices_what_is_done_to_its_world),
        API_TEST(the_recorder_refuses),
        API_TEST(a_system_cannot_start_or_stop_it),
        cmocka_unit_test(a_full_disk_ends_the_recording_not_the_world),
        cmocka_unit_test(a_world_that_goes_ends_its_recording),
        cmocka_unit_test(the_replay_refuses),
        cmocka_unit_test(a_replay_survives_each_failing_allocation),
        cmocka_unit_test(a_recorder_that_runs_out_of_memory_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
