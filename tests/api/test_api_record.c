// test_api_record.c - record.h: a world whose user interferes in every way that the API has is replayed in
// the same bits; every error of the recorder and the replay.
#include "harness/heap.h"
#include "harness/recording.h"
#include "world_fixture.h"

#include <stdio.h>

#define DT R(1.0 / 60)

enum { STEPS = 150, KEYS = 20 };

//---- a world that is interfered with -------------------------------------------------------------

typedef struct mark {
    float heat;
    uint32_t hits;
} mark;

static const plumb_field mark_fields[] = {
    { "heat", PLUMB_FIELD_F32, offsetof(mark, heat), "K" },
    { "hits", PLUMB_FIELD_U32, offsetof(mark, hits), "1" },
};

typedef struct game {
    plumb_world *world;
    plumb_body floor, boxes[6], ball, platform, doll[2];
    plumb_joint hinge;
    plumb_component mark, later;
    plumb_body spawned;
    recording tape;
    uint64_t hashes[STEPS + 1];
} game;

// A hook that changes things itself: the component's value and, by a command, the body.
static void on_add(plumb_world *world, plumb_entity entity, void *value, void *context)
{
    game *g = context;
    ((mark *)value)->heat += 1;
    if (plumb_same(entity, g->spawned)) {
        plumb_command_teleport(world, entity, (plumb_vec2){ 3, 9 }, R(0.5));
    }
}

static void at_begin(const plumb_system_call *call)
{
    game *g = call->context;
    // Through the columns, as well as by calls.
    plumb_component_span marks = plumb_world_column(call->world, g->mark);
    for (int i = 0; i < marks.count; ++i) {
        ((mark *)marks.values)[i].heat *= 0.75f;
    }
    plumb_body_set_angular_velocity(call->world, g->boxes[5], R(0.25));
}

static void at_forces(const plumb_system_call *call)
{
    const game *g = call->context;
    plumb_body_apply_force_center(call->world, g->ball, (plumb_vec2){ R(3), 0 });
}

static void at_contacts(const plumb_system_call *call)
{
    game *g = call->context;
    for (int i = 0; i < plumb_contact_edit_count(call->world); ++i) {
        plumb_contact_edit edit;
        assert_int_equal(plumb_contact_edit_get(call->world, i, &edit), PLUMB_OK);
        if (plumb_same(edit.body_a, g->boxes[2]) || plumb_same(edit.body_b, g->boxes[2])) {
            edit.friction = R(0.05);
            edit.enabled = call->time < 1;
            assert_int_equal(plumb_contact_edit_set(call->world, i, &edit), PLUMB_OK);
        }
    }
    if (call->time > 0.5) {
        plumb_body_set_velocity(call->world, g->platform, (plumb_vec2){ R(0.3), 0 });
    }
}

static void at_end(const plumb_system_call *call)
{
    game *g = call->context;
    plumb_world *w = call->world;
    uint64_t step = plumb_world_stats(w).step_count;
    mark *m = plumb_component_get(w, g->boxes[0], g->mark);
    if (m != NULL) {
        ++m->hits;
    }
    if (step == 40) {
        g->spawned = plumb_command_body_create(w, &(plumb_body_desc){ .position = { 0, 8 } });
        plumb_command_shape_create(w, g->spawned,
                                   &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.4) });
        plumb_command_component_set(w, g->spawned, g->mark, &(mark){ 10, 0 });
    }
    if (step == 70) {
        plumb_command_destroy(w, g->boxes[3]);
        plumb_command_component_remove(w, g->boxes[0], g->mark);
    }
}

static plumb_body add_box(plumb_world *w, plumb_body_type type, plumb_vec2 at, plumb_vec2 half)
{
    plumb_body body = plumb_body_create(w, &(plumb_body_desc){ .type = type, .position = at });
    plumb_shape_create(w, body, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = half });
    return body;
}

static void add_systems(game *g)
{
    const plumb_system_desc systems[] = {
        { .name = "cool", .phase = PLUMB_PHASE_BEGIN, .run = at_begin, .needs = g->mark },
        { .name = "wind", .phase = PLUMB_PHASE_FORCES, .run = at_forces },
        { .name = "ice", .phase = PLUMB_PHASE_CONTACTS, .run = at_contacts },
        { .name = "rules", .phase = PLUMB_PHASE_END, .run = at_end },
    };
    for (size_t i = 0; i < sizeof systems / sizeof systems[0]; ++i) {
        plumb_system_desc desc = systems[i];
        desc.context = g;
        assert_int_equal(plumb_system_create(g->world, &desc), PLUMB_OK);
    }
}

static void make_game(game *g, bool systems)
{
    *g = (game){ .tape = { 0 } };
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .hit_speed = 1 }, &g->world),
                     PLUMB_OK);
    plumb_world *w = g->world;
    g->mark = plumb_component_create(w, &(plumb_component_desc){ .name = "mark",
                                                                 .size = sizeof(mark),
                                                                 .fields = mark_fields,
                                                                 .field_count = 2,
                                                                 .on_add = on_add,
                                                                 .context = g });
    g->floor = add_box(w, PLUMB_STATIC, (plumb_vec2){ 0, R(-0.5) }, (plumb_vec2){ 20, R(0.5) });
    for (int i = 0; i < 6; ++i) {
        g->boxes[i] =
            add_box(w, PLUMB_DYNAMIC,
                    (plumb_vec2){ R(0.1) * (plumb_real)i, R(1.01) * (plumb_real)i + R(0.5) },
                    (plumb_vec2){ R(0.5), R(0.5) });
    }
    g->ball = plumb_body_create(w, &(plumb_body_desc){ .position = { -5, 3 }, .user_data = g });
    plumb_shape_create(w, g->ball, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
    g->platform = add_box(w, PLUMB_KINEMATIC, (plumb_vec2){ 6, 1 }, (plumb_vec2){ 1, R(0.2) });
    for (int i = 0; i < 2; ++i) {
        g->doll[i] = add_box(w, PLUMB_DYNAMIC, (plumb_vec2){ R(-8) + (plumb_real)i, 4 },
                             (plumb_vec2){ R(0.45), R(0.2) });
    }
    g->hinge = plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                          .body_a = g->doll[0],
                                                          .body_b = g->doll[1],
                                                          .anchor = { R(-7.5), 4 },
                                                          .user_data = g });
    assert_false(plumb_is_null(g->hinge));
    plumb_component_set(w, g->boxes[0], g->mark, &(mark){ 300, 1 });
    if (systems) {
        add_systems(g);
    }
}

// What the user does between the steps.
static void interfere(game *g, int step)
{
    plumb_world *w = g->world;
    switch (step) {
    case 5:
        plumb_body_set_velocity(w, g->ball, (plumb_vec2){ 6, 1 });
        break;
    case 12:
        plumb_joint_set_motor(w, g->hinge, true, 2, 10);
        plumb_world_set_gravity(w, (plumb_vec2){ R(0.5), R(-9) });
        break;
    case 20:
        plumb_body_set_target(w, g->platform, (plumb_vec2){ 7, 2 }, 0, R(0.5));
        plumb_body_set_damping(w, g->ball, R(0.2), R(0.1));
        break;
    case 33: // registered in the midst of it
        g->later = plumb_component_create(
            w, &(plumb_component_desc){ .name = "later", .size = sizeof(double) });
        plumb_component_set(w, g->ball, g->later, &(double){ 2.5 });
        break;
    case 50:
        plumb_body_destroy(w, g->boxes[4]);
        plumb_body_teleport(w, g->boxes[1], (plumb_vec2){ 2, 6 }, 1);
        break;
    case 60:
        plumb_world_set_substeps(w, 6, 1);
        plumb_system_enable(w, "wind", false);
        plumb_body_set_type(w, g->boxes[5], PLUMB_KINEMATIC);
        break;
    case 80:
        plumb_joint_destroy(w, g->hinge);
        plumb_body_set_user_data(w, g->ball, NULL);
        break;
    case 90: // refused: nothing comes of it
        assert_int_equal(plumb_world_step(w, R(2)), PLUMB_E_RANGE);
        break;
    default:
        break;
    }
}

static void play(game *g)
{
    for (int i = 1; i <= STEPS; ++i) {
        interfere(g, i);
        assert_int_equal(plumb_world_step(g->world, i % 3 == 0 ? DT : R(1.0 / 50)), PLUMB_OK);
        g->hashes[i] = plumb_world_hash(g->world);
    }
}

static void record_game(game *g, bool systems)
{
    make_game(g, systems);
    const plumb_recorder_desc desc = {
        .write = to_recording, .context = &g->tape, .keyframe_every = KEYS, .title = "a game"
    };
    assert_int_equal(plumb_recorder_start(g->world, &desc), PLUMB_OK);
    g->hashes[0] = plumb_world_hash(g->world);
    assert_int_equal(plumb_recorder_name(g->world, g->ball, "the ball"), PLUMB_OK);
    play(g);
    assert_int_equal(plumb_recorder_stop(g->world), PLUMB_OK);
}

static void free_game(game *g)
{
    plumb_world_destroy(g->world);
    recording_free(&g->tape);
}

static plumb_replay *open_tape(const recording *tape, const plumb_replay_desc *desc)
{
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(tape->bytes, tape->size, desc, &replay), PLUMB_OK);
    return replay;
}

static void check_at(plumb_replay *replay, const game *g, int step)
{
    plumb_replay_info info;
    assert_int_equal(plumb_replay_get_info(replay, &info), PLUMB_OK);
    assert_int_equal(info.step, step);
    assert_false(info.differs);
    if (plumb_world_hash(plumb_replay_world(replay)) != g->hashes[step]) {
        print_error("step %d: %s\n", step, plumb_replay_error(replay));
    }
    assert_true(plumb_world_hash(plumb_replay_world(replay)) == g->hashes[step]);
    assert_true(info.hash == g->hashes[step]);
}

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

static void names_and_times_are_found(void **state)
{
    (void)state;
    game g;
    record_game(&g, false);
    plumb_replay *replay = open_tape(&g.tape, NULL);
    assert_string_equal(plumb_replay_name(replay, g.ball), "the ball");
    assert_null(plumb_replay_name(replay, g.floor));
    assert_null(plumb_replay_name(replay, (plumb_entity)PLUMB_NULL_INIT));
    assert_null(plumb_replay_name(NULL, g.ball));
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
    const plumb_replay_edit *e = find_edit(edits, count, -1, g.ball, "vx");
    assert_non_null(e);
    assert_int_equal(e->change.kind, PLUMB_DIFFERS);
    assert_string_equal(e->change.table, "bodies");
    assert_string_equal(e->change.b, "6");
    assert_non_null(find_edit(edits, count, PLUMB_PHASE_FORCES, g.ball, "fx"));
    assert_non_null(find_edit(edits, count, PLUMB_PHASE_BEGIN, g.boxes[0], "mark.heat"));
    assert_non_null(find_edit(edits, count, PLUMB_PHASE_END, g.boxes[0], "mark.hits"));
    assert_null(find_edit(edits, count, -1, g.ball, "user_data"));

    assert_int_equal(plumb_replay_seek(replay, 12), PLUMB_OK);
    count = plumb_replay_edits(replay, edits, 512);
    assert_non_null(find_edit(edits, count, -1, g.hinge, "desc.motor_speed"));
    e = find_edit(edits, count, -1, (plumb_entity)PLUMB_NULL_INIT, "gravity");
    assert_non_null(e);
    assert_string_equal(e->change.b, "(0.5, -9)");

    assert_int_equal(plumb_replay_seek(replay, 20), PLUMB_OK);
    count = plumb_replay_edits(replay, edits, 512);
    e = find_edit(edits, count, -1, g.ball, "");
    assert_non_null(e);
    assert_string_equal(e->change.table, "tunings");
    assert_int_equal(e->change.kind, PLUMB_ONLY_B);

    assert_int_equal(plumb_replay_seek(replay, 50), PLUMB_OK);
    count = plumb_replay_edits(replay, edits, 512);
    e = find_edit(edits, count, -1, g.boxes[4], "");
    assert_non_null(e);
    assert_int_equal(e->change.kind, PLUMB_ONLY_A);
    assert_int_equal(e->change.entity_kind, PLUMB_KIND_BODY);
    e = find_edit(edits, count, -1, g.boxes[1], "y");
    assert_non_null(e);
    assert_string_equal(e->change.b, "6");
    // A list that is too short is filled, and told to be.
    assert_int_equal(plumb_replay_edits(replay, edits, 1), count);
    assert_int_equal(plumb_replay_edits(replay, NULL, 0), count);
    assert_int_equal(plumb_replay_edits(NULL, edits, 1), 0);
    plumb_replay_close(replay);
    free_game(&g);
}

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
    assert_int_equal(plumb_recorder_name(w, ball, "ball"), PLUMB_OK);
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
    assert_int_equal(plumb_recorder_name(NULL, f->dynamic, "x"), PLUMB_E_NULL);
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
            plumb_recorder_name(w, f->dynamic, "x"));
    assert_int_equal(tape.size, 0);
    assert_int_equal(plumb_recorder_start(w, &desc), PLUMB_OK);
    REFUSED(E_STATE, "plumb_recorder_start: the world is recorded already; stop that first",
            plumb_recorder_start(w, &desc));
    REFUSED(E_RANGE, "plumb_recorder_name: name is empty; it must have 1 to 63 characters",
            plumb_recorder_name(w, f->dynamic, ""));
    REFUSED(E_NULL, "plumb_recorder_name: name is null; it must be given",
            plumb_recorder_name(w, f->dynamic, NULL));
    REFUSED(E_HANDLE, "plumb_recorder_name: entity is null; it must be a live entity",
            plumb_recorder_name(w, (plumb_entity)PLUMB_NULL_INIT, "x"));
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
    assert_int_equal(plumb_replay_step(replay), PLUMB_E_MISSING);
    assert_string_equal(plumb_replay_error(replay),
                        "plumb_replay_step: the recording ends here, at step 6");
    // The world of a replay is not recorded.
    const plumb_recorder_desc again = { .write = to_recording, .context = &tape };
    assert_int_equal(plumb_recorder_start(plumb_replay_world(replay), &again), PLUMB_E_STATE);
    assert_string_equal(plumb_world_error(plumb_replay_world(replay)).message,
                        "plumb_recorder_start: the world is that of a replay; it must not be");
    assert_int_equal(plumb_recorder_stop(plumb_replay_world(replay)), PLUMB_E_STATE);
    plumb_replay_close(replay);
    recording_free(&tape);
}

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
    const plumb_entity none = PLUMB_NULL_INIT;
    game a, b;
    int count;
    make_game(&a, false);
    make_game(&b, false);
    plumb_body_set_velocity(b.world, b.ball, (plumb_vec2){ R(0.5), 0 });
    assert_int_equal(plumb_world_compare(a.world, b.world, rows, 8, &count), PLUMB_OK);
    assert_int_equal(count, 1);
    check_row(&rows[0], PLUMB_DIFFERS, a.ball, "bodies", "vx", "0", "0.5");
    plumb_body_set_velocity(b.world, b.ball, (plumb_vec2){ 0, 0 });

    ((mark *)plumb_component_get(b.world, b.boxes[0], b.mark))->hits = 7;
    plumb_world_set_gravity(b.world, (plumb_vec2){ 0, -1 });
    plumb_joint_set_motor(b.world, b.hinge, true, 2, 10);
    assert_int_equal(plumb_world_compare(a.world, b.world, rows, 8, &count), PLUMB_OK);
    assert_int_equal(count, 5);
    check_row(&rows[0], PLUMB_DIFFERS, a.hinge, "joints", "desc.enable_motor", "false", "true");
    check_row(&rows[1], PLUMB_DIFFERS, a.hinge, "joints", "desc.motor_speed", "0", "2");
    check_row(&rows[2], PLUMB_DIFFERS, a.hinge, "joints", "desc.max_motor", "0", "10");
    check_row(&rows[3], PLUMB_DIFFERS, a.boxes[0], "components", "mark.hits", "1", "7");
    check_row(&rows[4], PLUMB_DIFFERS, none, "world", "gravity",
              sizeof(plumb_real) == 4 ? "(0, -9.81000042)" : "(0, -9.8100000000000005)", "(0, -1)");

    plumb_body extra = plumb_body_create(b.world, &(plumb_body_desc){ 0 });
    plumb_body_destroy(b.world, b.boxes[1]);
    assert_int_equal(plumb_world_compare(a.world, b.world, rows, 8, &count), PLUMB_OK);
    check_row(&rows[0], PLUMB_ONLY_A, a.boxes[1], "bodies", "", "", "");
    check_row(&rows[1], PLUMB_ONLY_B, extra, "bodies", "", "", "");
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
        assert_true(plumb_same(d.first.entity, names.ball));
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
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ .allocator = heap_allocator(&h) }, &w),
                         PLUMB_OK);
        plumb_body ball = plumb_body_create(w, &(plumb_body_desc){ 0 });
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
        heap_fail(&h, k);
        const plumb_recorder_desc desc = { .write = to_recording, .context = &tape };
        plumb_result r = plumb_recorder_start(w, &desc);
        assert_true(r == PLUMB_OK || r == PLUMB_E_MEMORY);
        for (int i = 0; r == PLUMB_OK && i < 4; ++i) {
            plumb_body_set_velocity(w, ball, (plumb_vec2){ (plumb_real)i, 1 });
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
        cmocka_unit_test(whatever_a_user_does_is_replayed),
        cmocka_unit_test(without_systems_too),
        cmocka_unit_test(recording_changes_nothing),
        cmocka_unit_test(seeks_go_anywhere),
        cmocka_unit_test(contacts_and_events_are_those_of_the_step),
        cmocka_unit_test(it_tells_of_itself),
        cmocka_unit_test(names_and_times_are_found),
        cmocka_unit_test(edits_are_told),
        cmocka_unit_test(a_recording_cut_anywhere_is_a_prefix),
        cmocka_unit_test(a_flipped_bit_is_found),
        cmocka_unit_test(what_is_no_recording_is_refused),
        cmocka_unit_test(a_replay_notices_what_is_done_to_its_world),
        API_TEST(the_recorder_refuses),
        API_TEST(a_system_cannot_start_or_stop_it),
        cmocka_unit_test(a_full_disk_ends_the_recording_not_the_world),
        cmocka_unit_test(a_world_that_goes_ends_its_recording),
        cmocka_unit_test(the_replay_refuses),
        cmocka_unit_test(equal_worlds_do_not_differ),
        cmocka_unit_test(differences_are_named),
        API_TEST(worlds_that_cannot_be_compared),
        cmocka_unit_test(equal_recordings_do_not_differ),
        cmocka_unit_test(the_pass_that_differs_is_named),
        cmocka_unit_test(a_replay_survives_each_failing_allocation),
        cmocka_unit_test(a_recorder_that_runs_out_of_memory_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
