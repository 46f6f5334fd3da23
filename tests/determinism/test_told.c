// test_told.c - random sessions, recorded: the replay tells the events of each step as the run did, every stream of them, and
// whatever a session has come to, its image may be restored.
#include "session_rest.h"

#include "harness/random.h"
#include "harness/recording.h"
#include "harness/trials.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 30, SESSIONS = 4, SEEKS = 6 };

typedef enum stream {
    BEGINS,
    ENDS,
    HITS,
    ENTERS,
    LEAVES,
    SLEEPS,
    WAKES,
    SNAPS,
    STRAINS,
    BREAKS,
    PARTS,
    GONE,
    WET,
    DRY,
    QUARANTINED,
    STREAMS
} stream;

static const char *const names[] = { "begin", "end",  "hit",   "sensor begin", "sensor end",
                                     "sleep", "wake", "break", "strain",       "body break",
                                     "part",  "gone", "wet",   "dry",          "quarantine" };

// What a step told: how many, and a digest of them.
typedef struct told {
    int count[STREAMS];
    uint64_t digest[STREAMS];
} told;

static void add(told *t, stream which, const void *bytes, size_t size)
{
    const unsigned char *b = bytes;
    for (size_t i = 0; i < size; ++i) {
        t->digest[which] = (t->digest[which] ^ b[i]) * UINT64_C(1099511628211);
    }
}

#define ADD(which, value) add(t, which, &(value), sizeof(value))

static void add_contacts(told *t, const plumb_world *w)
{
    const plumb_contact_begin *b = plumb_world_begin_events(w, &t->count[BEGINS]);
    for (int i = 0; i < t->count[BEGINS]; ++i) {
        ADD(BEGINS, b[i].shape_a);
        ADD(BEGINS, b[i].shape_b);
        ADD(BEGINS, b[i].point);
        ADD(BEGINS, b[i].approach_speed);
    }
    const plumb_contact_end *e = plumb_world_end_events(w, &t->count[ENDS]);
    for (int i = 0; i < t->count[ENDS]; ++i) {
        ADD(ENDS, e[i].shape_a);
        ADD(ENDS, e[i].shape_b);
    }
    const plumb_contact_hit *h = plumb_world_hit_events(w, &t->count[HITS]);
    for (int i = 0; i < t->count[HITS]; ++i) {
        ADD(HITS, h[i].shape_a);
        ADD(HITS, h[i].shape_b);
        ADD(HITS, h[i].moment);
        ADD(HITS, h[i].impulse);
    }
}

static void add_sensors(told *t, const plumb_world *w)
{
    const plumb_sensor_event *s[2] = { plumb_world_sensor_begin_events(w, &t->count[ENTERS]),
                                       plumb_world_sensor_end_events(w, &t->count[LEAVES]) };
    for (int k = 0; k < 2; ++k) {
        const stream which = k == 0 ? ENTERS : LEAVES;
        for (int i = 0; i < t->count[which]; ++i) {
            ADD(which, s[k][i].sensor);
            ADD(which, s[k][i].shape);
        }
    }
}

static void add_joints(told *t, const plumb_world *w)
{
    const plumb_joint_break *j[2] = { plumb_world_joint_break_events(w, &t->count[SNAPS]),
                                      plumb_world_joint_strain_events(w, &t->count[STRAINS]) };
    for (int k = 0; k < 2; ++k) {
        const stream which = k == 0 ? SNAPS : STRAINS;
        for (int i = 0; i < t->count[which]; ++i) {
            ADD(which, j[k][i].joint);
            ADD(which, j[k][i].force);
            ADD(which, j[k][i].torque);
        }
    }
}

static void add_lists(told *t, const plumb_world *w)
{
    const plumb_body *bodies[3] = { plumb_world_sleep_events(w, &t->count[SLEEPS]),
                                    plumb_world_wake_events(w, &t->count[WAKES]),
                                    plumb_world_body_break_parts(w, &t->count[PARTS]) };
    const stream which[3] = { SLEEPS, WAKES, PARTS };
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < t->count[which[k]]; ++i) {
            ADD(which[k], bodies[k][i]);
        }
    }
    const plumb_quarantine *q = plumb_world_quarantine_events(w, &t->count[QUARANTINED]);
    for (int i = 0; i < t->count[QUARANTINED]; ++i) {
        ADD(QUARANTINED, q[i].body);
        add(t, QUARANTINED, q[i].pass, strlen(q[i].pass));
    }
}

static void add_ends(told *t, const plumb_world *w)
{
    const plumb_body_break *b = plumb_world_body_break_events(w, &t->count[BREAKS]);
    for (int i = 0; i < t->count[BREAKS]; ++i) {
        ADD(BREAKS, b[i].body);
        ADD(BREAKS, b[i].other);
        ADD(BREAKS, b[i].point);
        ADD(BREAKS, b[i].normal);
        ADD(BREAKS, b[i].impulse);
        ADD(BREAKS, b[i].energy);
        ADD(BREAKS, b[i].first_part);
        ADD(BREAKS, b[i].part_count);
    }
    const plumb_body_gone *g = plumb_world_body_gone_events(w, &t->count[GONE]);
    for (int i = 0; i < t->count[GONE]; ++i) {
        ADD(GONE, g[i].body);
        ADD(GONE, g[i].position);
        ADD(GONE, g[i].mass);
        ADD(GONE, g[i].end);
    }
}

static void add_liquid(told *t, const plumb_world *w)
{
    const plumb_liquid_contact *c = plumb_liquid_contacts(w, &t->count[WET]);
    for (int i = 0; i < t->count[WET]; ++i) {
        ADD(WET, c[i].body);
        ADD(WET, c[i].softbody);
        ADD(WET, c[i].force);
        ADD(WET, c[i].torque);
        ADD(WET, c[i].began);
    }
    const plumb_liquid_end *e = plumb_liquid_ends(w, &t->count[DRY]);
    for (int i = 0; i < t->count[DRY]; ++i) {
        ADD(DRY, e[i].body);
        ADD(DRY, e[i].softbody);
    }
}

static told told_by(const plumb_world *w)
{
    told t;
    memset(&t, 0, sizeof t);
    add_contacts(&t, w);
    add_sensors(&t, w);
    add_joints(&t, w);
    add_lists(&t, w);
    add_ends(&t, w);
    add_liquid(&t, w);
    return t;
}

//---- a session -----------------------------------------------------------------------------------

typedef struct run {
    session session;
    recording tape;
    told told[STEPS + 1];
    uint64_t hash[STEPS + 1];
    int steps;
    bool restored; // all images of it
} run;

// Its image, which an empty world of the same registrations takes.
static bool may_be_restored(const session *s)
{
    const size_t size = plumb_world_snapshot_size(s->world);
    char *image = malloc(size);
    session twin;
    assert_non_null(image);
    assert_int_equal(plumb_world_save(s->world, image, size), PLUMB_OK);
    session_twin(&twin, s, NULL);
    const bool taken = plumb_world_restore(twin.world, image, size) == PLUMB_OK &&
                       plumb_world_hash(twin.world) == plumb_world_hash(s->world);
    session_end(&twin);
    free(image);
    return taken;
}

static void record(run *r, uint32_t number)
{
    *r = (run){ .restored = true };
    session *s = &r->session;
    session_begin(s, number, &(plumb_world_desc){ .simd_width = 4 << number % 3 });
    if (number % 4 == 1) { // a pool, which sessions pour rarely; worlds that wrap refuse it
        plumb_liquid_create(s->world, &(plumb_liquid_desc){ .spacing = (plumb_real)0.12 });
        plumb_liquid_add_box(s->world, plumb_v2(-4, 0), plumb_v2(4, (plumb_real)0.8), NULL);
    }
    const plumb_recorder_desc desc = { .write = to_recording,
                                       .context = &r->tape,
                                       .keyframe_every = 1 + (int)(number % 9) };
    assert_int_equal(plumb_recorder_start(s->world, &desc), PLUMB_OK);
    for (int i = 0; i < STEPS; ++i) {
        session_act(s);
        session_act_besides(s);
        const plumb_real dt = sim_random(&s->seed) % 24 == 0 ? 0 : session_dt(s);
        if (plumb_world_step(s->world, dt) == PLUMB_OK) {
            ++r->steps;
            r->hash[r->steps] = plumb_world_hash(s->world);
            r->told[r->steps] = told_by(s->world);
        }
        r->restored = r->restored && (i % 3 != 0 || may_be_restored(s));
    }
    assert_int_equal(plumb_recorder_stop(s->world), PLUMB_OK);
    session_end(s);
}

static uint32_t compare(const run *r, uint32_t number, int step, const plumb_world *w)
{
    const told t = told_by(w);
    uint32_t failures = 0;
    for (int k = 0; k < STREAMS; ++k) {
        if (t.count[k] != r->told[step].count[k] || t.digest[k] != r->told[step].digest[k]) {
            print_error("session %" PRIu32 ", step %d: events '%s': %d, and %d in the replay\n",
                        number, step, names[k], r->told[step].count[k], t.count[k]);
            ++failures;
        }
    }
    return failures + (plumb_world_hash(w) != r->hash[step]);
}

static uint32_t replay(const run *r, uint32_t number)
{
    plumb_replay *replay;
    const plumb_replay_desc desc = { .simd_width = 4 << (number + 1) % 3,
                                     .workers = 1 + (int)(number % 2) };
    uint32_t failures = 0, seed = number * 77 + 1;
    assert_int_equal(plumb_replay_open(r->tape.bytes, r->tape.size, &desc, &replay), PLUMB_OK);
    for (int i = 1; i <= r->steps + SEEKS && failures == 0; ++i) {
        const int to = i <= r->steps ? i : 1 + (int)(sim_random(&seed) % (uint32_t)r->steps);
        if (plumb_replay_seek(replay, (uint64_t)to) != PLUMB_OK) {
            print_error("session %" PRIu32 ": %s\n", number, plumb_replay_error(replay));
            ++failures;
        } else {
            failures += compare(r, number, to, plumb_replay_world(replay));
        }
    }
    plumb_replay_close(replay);
    return failures;
}

static void replays_tell_what_runs_told(void **state)
{
    (void)state;
    static run r;
    const trials t = trials_whole(0, SESSIONS);
    uint32_t failures = 0;
    uint64_t all[STREAMS] = { 0 };
    for (uint32_t number = t.first; number < t.end; ++number) {
        record(&r, number);
        if (!r.restored) {
            print_error("session %" PRIu32 ": an image is refused\n", number);
        }
        failures += !r.restored + replay(&r, number);
        for (int i = 1; i <= r.steps; ++i) {
            for (int k = 0; k < STREAMS; ++k) {
                all[k] += (uint64_t)r.told[i].count[k];
            }
        }
        recording_free(&r.tape);
    }
    for (int k = 0; k < STREAMS; ++k) {
        print_message("%" PRIu64 " of '%s'\n", all[k], names[k]);
    }
    assert_int_equal(failures, 0);
    assert_true(all[BREAKS] > 0 && all[GONE] > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(replays_tell_what_runs_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
