// test_scene_record.c - every shipped scene, recorded with its handlers running: the replay gives the same
// bits at every step, forwards, after seeking, backwards, at every SIMD width and with threads. Each scene is played, sought in and
// recorded again in one precision each, for that takes long; TRIALS=3: in all.
#include "scene_steps.h"

#include "harness/random.h"
#include "harness/recording.h"
#include "harness/trials.h"
#include "scene/scene.h"

#include <glob.h>
#include <malloc.h>
#include <stdio.h>

#define STEPS     240
#define SEEKS     12
#define KEYFRAMES 8

typedef struct run {
    recording bytes;
    int steps;
    uint64_t edited;
    uint64_t hashes[STEPS + 1];
} run;

// So many keyframes, beside the first; 0: as many as there are by default.
static void record(const char *path, int keyframes, run *out)
{
    scene *s = NULL;
    scene_error error;
    if (scene_load(&(scene_options){ .path = path }, &s, &error) != SCENE_OK) {
        print_error("%s\n", error.text);
    }
    assert_non_null(s);
    plumb_world *world = scene_world(s);
    out->steps = scene_steps(world, STEPS);
    const plumb_recorder_desc desc = { .write = to_recording,
                                       .context = &out->bytes,
                                       .keyframe_every = keyframes > 0 ? out->steps / keyframes : 0,
                                       .title = path };
    assert_int_equal(plumb_recorder_start(world, &desc), PLUMB_OK);
    out->hashes[0] = plumb_world_hash(world);
    for (int i = 1; i <= out->steps; ++i) {
        assert_int_equal(scene_step(s, &error), SCENE_OK);
        // Handlers for events run behind the world's step: what they do belongs to the next one.
        out->hashes[i] = plumb_recorder_get_info(world).hash;
    }
    plumb_recorder_info info = plumb_recorder_get_info(world);
    assert_int_equal(info.steps, out->steps);
    assert_int_equal(info.bytes, out->bytes.size);
    out->edited = info.edited;
    assert_int_equal(plumb_recorder_stop(world), PLUMB_OK);
    scene_destroy(s);
}

static plumb_replay *open_run(const run *r, const plumb_replay_desc *desc)
{
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(r->bytes.bytes, r->bytes.size, desc, &replay), PLUMB_OK);
    plumb_replay_info info;
    assert_int_equal(plumb_replay_get_info(replay, &info), PLUMB_OK);
    assert_true(info.complete);
    assert_int_equal(info.steps, r->steps);
    assert_int_equal(info.bytes, r->bytes.size);
    assert_int_equal(info.edited, r->edited);
    return replay;
}

static void check_at(plumb_replay *replay, const run *r, int step)
{
    plumb_replay_info info;
    assert_int_equal(plumb_replay_get_info(replay, &info), PLUMB_OK);
    assert_int_equal(info.step, step);
    if (info.hash != r->hashes[step]) {
        print_error("step %d: recorded %llx, run %llx\n", step, (unsigned long long)info.hash,
                    (unsigned long long)r->hashes[step]);
    }
    assert_true(info.hash == r->hashes[step]);
    assert_true(plumb_world_hash(plumb_replay_world(replay)) == r->hashes[step]);
}

static void check_result(plumb_replay *replay, plumb_result result)
{
    if (result != PLUMB_OK) {
        print_error("%s\n", plumb_replay_error(replay));
    }
    assert_int_equal(result, PLUMB_OK);
}

static void play_through(const run *r, const plumb_replay_desc *desc)
{
    plumb_replay *replay = open_run(r, desc);
    check_at(replay, r, 0);
    for (int i = 1; i <= r->steps; ++i) {
        check_result(replay, plumb_replay_step(replay));
        check_at(replay, r, i);
    }
    assert_int_equal(plumb_replay_step(replay), PLUMB_E_MISSING);
    plumb_replay_close(replay);
}

static void seek_about(const run *r)
{
    plumb_replay *replay = open_run(r, NULL);
    uint32_t seed = 5;
    for (int i = 0; i < SEEKS; ++i) {
        int to = (int)(sim_random(&seed) % (uint32_t)(r->steps + 1));
        check_result(replay, plumb_replay_seek(replay, (uint64_t)to));
        check_at(replay, r, to);
    }
    check_result(replay, plumb_replay_seek(replay, (uint64_t)r->steps));
    for (int i = r->steps; i > r->steps - 10; --i) {
        check_at(replay, r, i);
        check_result(replay, plumb_replay_step_back(replay));
    }
    check_result(replay, plumb_replay_seek(replay, 0));
    assert_int_equal(plumb_replay_step_back(replay), PLUMB_E_MISSING);
    plumb_replay_close(replay);
}

// `turn`: in which precision a scene has its turn.
static void for_all(void (*check)(const char *path, const run *r), int keyframes, uint32_t turn)
{
    static run r;
    glob_t found;
    assert_int_equal(glob("assets/scenes/*.lua", 0, NULL, &found), 0);
    assert_in_range(found.gl_pathc, 10, 1000);
    for (size_t i = 0; i < found.gl_pathc; ++i) {
        if (!trials_takes((uint32_t)i + turn, 3)) {
            continue;
        }
        r = (run){ .steps = 0 };
        record(found.gl_pathv[i], keyframes, &r);
        check(found.gl_pathv[i], &r);
        recording_free(&r.bytes);
    }
    globfree(&found);
}

static void check_widths(const char *path, const run *r)
{
    print_message("%s: %d steps, %llu with edits, %zu bytes\n", path, r->steps,
                  (unsigned long long)r->edited, r->bytes.size);
    play_through(r, NULL);
    play_through(r, &(plumb_replay_desc){ .simd_width = 4, .workers = 2 });
    play_through(r, &(plumb_replay_desc){ .simd_width = 16, .list_edits = true });
}

static void check_seeks(const char *path, const run *r)
{
    (void)path;
    seek_about(r);
}

static void replays_give_the_same_bits(void **state)
{
    (void)state;
    for_all(check_widths, 0, 0);
}

static void seeking_gives_the_same_bits(void **state)
{
    (void)state;
    for_all(check_seeks, KEYFRAMES, 1);
}

// The same scene recorded twice: the same bytes, pointers and all.
static void check_again(const char *path, const run *r)
{
    static run again;
    again = (run){ .steps = 0 };
    char *elsewhere = malloc(12345); // so that addresses are others
    mallopt(M_PERTURB, 0x5a);        // and so is what nobody has written
    record(path, KEYFRAMES, &again);
    mallopt(M_PERTURB, 0);
    if (again.bytes.size != r->bytes.size ||
        memcmp(again.bytes.bytes, r->bytes.bytes, r->bytes.size) != 0) {
        print_error("%s: another recording\n", path);
    }
    assert_int_equal(again.bytes.size, r->bytes.size);
    assert_memory_equal(again.bytes.bytes, r->bytes.bytes, r->bytes.size);
    recording_free(&again.bytes);
    free(elsewhere);
}

static void the_same_run_gives_the_same_recording(void **state)
{
    (void)state;
    for_all(check_again, KEYFRAMES, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(replays_give_the_same_bits),
        cmocka_unit_test(seeking_gives_the_same_bits),
        cmocka_unit_test(the_same_run_gives_the_same_recording),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
