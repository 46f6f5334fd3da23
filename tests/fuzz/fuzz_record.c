// fuzz_record.c - hostile recordings: refused, or a prefix that plays; never harm.
//
// Input that begins with "PLUMBREC" is a recording as it stands. Any other says what is done to a good one:
// two bytes, how much is cut off its end; then threes, each a place and what it is xor-ed with.
#include "fuzz/tape.h"
#include "plumb/plumb.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { STEPS = 8 };

static void record(tape *t)
{
    plumb_world *w;
    t->size = 0;
    if (plumb_world_create(NULL, &w) != PLUMB_OK) {
        abort();
    }
    plumb_body ball = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, 1 } });
    plumb_shape_create(w, ball, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    plumb_recorder_start(
        w, &(plumb_recorder_desc){ .write = to_tape, .context = t, .keyframe_every = 3 });
    plumb_recorder_name(w, ball.entity, "ball");
    plumb_recorder_note(w, 1, "noted", 5);
    for (int i = 0; i < STEPS; ++i) {
        plumb_body_apply_torque(w, ball, (plumb_real)(i % 2));
        plumb_world_step(w, (plumb_real)(1.0 / 60));
    }
    if (plumb_recorder_stop(w) != PLUMB_OK) {
        abort();
    }
    plumb_world_destroy(w);
}

static void play(const unsigned char *bytes, size_t size, bool whole)
{
    plumb_replay *replay;
    plumb_replay_info info;
    const plumb_replay_desc desc = { .list_edits = true };
    plumb_result r = plumb_replay_open(bytes, size, &desc, &replay);
    if (r != PLUMB_OK) {
        if (replay != NULL || whole) {
            abort();
        }
        return;
    }
    while ((r = plumb_replay_step(replay)) == PLUMB_OK) {
        size_t length;
        const char *note = plumb_replay_note(replay, 1, &length);
        if ((note == NULL) != (length == 0)) {
            abort();
        }
        volatile char last = length > 0 ? note[length - 1] : '\0'; // all of it can be read
        (void)last;
    }
    plumb_replay_get_info(replay, &info);
    if (r == PLUMB_E_MISSING && info.steps > 0) {
        plumb_replay_seek(replay, info.steps / 2);
        plumb_replay_step_back(replay);
    } else if (whole) {
        abort();
    }
    plumb_replay_close(replay);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tape *t = malloc(sizeof *t);
    if (t == NULL) {
        return 0;
    }
    if (size >= 8 && memcmp(data, "PLUMBREC", 8) == 0) {
        play(data, size, false);
        free(t);
        return 0;
    }
    record(t);
    size_t cut = size >= 2 ? (size_t)data[0] << 8 | data[1] : 0;
    for (size_t i = 2; i + 3 <= size; i += 3) {
        t->bytes[((size_t)data[i] << 8 | data[i + 1]) % t->size] ^= data[i + 2];
    }
    play(t->bytes, cut < t->size ? t->size - cut : 0, size < 5 && cut == 0);
    free(t);
    return 0;
}
