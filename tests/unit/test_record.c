// test_record.c - recordings as another build would have made them: well formed, but they do not replay here.
#include "harness/recording.h"
#include "record/format.h"

#define DT ((plumb_real)(1.0 / 60))

enum { STEPS = 30, PUSHED = 12 };

static void push(plumb_world *w, plumb_body ball)
{
    plumb_body_set_velocity(w, ball, (plumb_vec2){ 2, 0 });
}

// A ball that falls, and is pushed before step `pushed`.
static void record(recording *tape, int pushed, int substeps, plumb_body *ball)
{
    plumb_world *w;
    *tape = (recording){ 0 };
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .substeps = substeps }, &w), PLUMB_OK);
    *ball = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, 9 } });
    const plumb_recorder_desc desc = { .write = to_recording,
                                       .context = tape,
                                       .keyframe_every = 10 };
    assert_int_equal(plumb_recorder_start(w, &desc), PLUMB_OK);
    for (int i = 1; i <= STEPS; ++i) {
        if (i == pushed) {
            push(w, *ball);
        }
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
    assert_int_equal(plumb_recorder_stop(w), PLUMB_OK);
    plumb_world_destroy(w);
}

// The same without edits: what came of them comes out of nothing now, as it would in another build.
static void take_out_edits(recording *tape)
{
    recording out = { 0 };
    size_t at = sizeof(pl_record_header);
    pl_chunk chunk = { .kind = PL_CHUNK_CODE };
    to_recording(&out, tape->bytes, at);
    for (uint32_t number = 0; chunk.kind != PL_CHUNK_END; ++number) {
        assert_int_equal(pl_chunk_read(tape->bytes, tape->size, &at, number, &chunk),
                         PL_CHUNK_WHOLE);
        pl_step_head head;
        if (chunk.kind == PL_CHUNK_STEP) {
            memcpy(&head, chunk.data, sizeof head);
            head.edits = 0;
            chunk.data = (const char *)&head;
            chunk.bytes = sizeof head;
        }
        const pl_chunk_header h = pl_chunk_seal(chunk.kind, number, chunk.data, chunk.bytes);
        to_recording(&out, &h, sizeof h);
        if (chunk.bytes > 0) {
            to_recording(&out, chunk.data, chunk.bytes);
        }
    }
    recording_free(tape);
    *tape = out;
}

static plumb_replay *open_tape(const recording *tape)
{
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(tape->bytes, tape->size, NULL, &replay), PLUMB_OK);
    return replay;
}

static void a_step_that_gives_other_bits_is_found(void **state)
{
    (void)state;
    recording tape;
    plumb_body ball;
    record(&tape, PUSHED, 4, &ball);
    take_out_edits(&tape);
    plumb_replay *replay = open_tape(&tape);
    assert_int_equal(plumb_replay_seek(replay, PUSHED - 1), PLUMB_OK);
    assert_int_equal(plumb_replay_step(replay), PLUMB_E_IMAGE);
    assert_int_equal(plumb_replay_seek(replay, PUSHED + 3), PLUMB_E_IMAGE);
    // Behind the next keyframe it is itself again.
    assert_int_equal(plumb_replay_seek(replay, 21), PLUMB_OK);
    assert_int_equal(plumb_replay_seek(replay, STEPS), PLUMB_OK);
    plumb_replay_close(replay);
    recording_free(&tape);
}

static void two_builds_are_compared_by_what_they_recorded(void **state)
{
    (void)state;
    for (int swapped = 0; swapped < 2; ++swapped) {
        recording tapes[2];
        plumb_replay *replays[2];
        plumb_replay_difference d;
        plumb_body ball;
        record(&tapes[swapped], 0, 4, &ball);
        record(&tapes[1 - swapped], PUSHED, 4, &ball);
        take_out_edits(&tapes[1 - swapped]);
        replays[0] = open_tape(&tapes[0]);
        replays[1] = open_tape(&tapes[1]);
        assert_int_equal(plumb_replay_compare(replays[0], replays[1], &d), PLUMB_OK);
        assert_true(d.found);
        assert_int_equal(d.step, PUSHED);
        assert_string_equal(d.pass, "");
        assert_int_equal(d.seen, 20);
        assert_true(plumb_same(d.first.entity, ball.entity));
        assert_string_equal(d.first.component, "x");
        for (int i = 0; i < 2; ++i) {
            plumb_replay_close(replays[i]);
            recording_free(&tapes[i]);
        }
    }
}

static void where_settings_are_not_the_same_nothing_is_said(void **state)
{
    (void)state;
    recording tapes[2];
    plumb_replay_difference d;
    plumb_body ball;
    record(&tapes[0], 0, 4, &ball);
    record(&tapes[1], PUSHED, 5, &ball);
    take_out_edits(&tapes[1]);
    plumb_replay *a = open_tape(&tapes[0]), *b = open_tape(&tapes[1]);
    assert_int_equal(plumb_replay_compare(a, b, &d), PLUMB_E_IMAGE);
    assert_false(d.found);
    plumb_replay_close(a);
    plumb_replay_close(b);
    recording_free(&tapes[0]);
    recording_free(&tapes[1]);
}

// Version 1 had no notes, and is read; what comes after the present one is not.
static void versions_are_told_apart(void **state)
{
    (void)state;
    recording tape;
    plumb_body ball;
    record(&tape, 2, 4, &ball);
    for (uint32_t version = 0; version <= PL_RECORD_VERSION + 1; ++version) {
        pl_record_header header;
        memcpy(&header, tape.bytes, sizeof header);
        header.version = version;
        pl_record_seal(&header);
        memcpy(tape.bytes, &header, sizeof header);
        const char *wrong = pl_record_open(tape.bytes, tape.size, &header);
        if (version >= 1 && version <= PL_RECORD_VERSION) {
            assert_null(wrong);
            plumb_replay_close(open_tape(&tape));
        } else {
            assert_string_equal(wrong, "is of another version of the format");
        }
    }
    recording_free(&tape);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(versions_are_told_apart),
        cmocka_unit_test(a_step_that_gives_other_bits_is_found),
        cmocka_unit_test(two_builds_are_compared_by_what_they_recorded),
        cmocka_unit_test(where_settings_are_not_the_same_nothing_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
