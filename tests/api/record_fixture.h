// record_fixture.h - what the tests of record.h share: a world that its user interferes with, small recordings,
// replays to their end.
#ifndef RECORD_FIXTURE_H
#define RECORD_FIXTURE_H

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
static inline void on_add(plumb_world *world, plumb_entity entity, void *value, void *context)
{
    game *g = context;
    ((mark *)value)->heat += 1;
    if (plumb_same(entity, g->spawned.entity)) {
        plumb_command_teleport(world, (plumb_body){ entity }, (plumb_vec2){ 3, 9 }, R(0.5));
    }
}

static inline void at_begin(const plumb_system_call *call)
{
    game *g = call->context;
    // Through the columns, as well as by calls.
    plumb_component_span marks = plumb_world_column(call->world, g->mark);
    for (int i = 0; i < marks.count; ++i) {
        ((mark *)marks.values)[i].heat *= 0.75f;
    }
    plumb_body_set_angular_velocity(call->world, g->boxes[5], R(0.25));
}

static inline void at_forces(const plumb_system_call *call)
{
    const game *g = call->context;
    plumb_body_apply_force_center(call->world, g->ball, (plumb_vec2){ R(3), 0 });
}

static inline void at_contacts(const plumb_system_call *call)
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

static inline void at_end(const plumb_system_call *call)
{
    game *g = call->context;
    plumb_world *w = call->world;
    uint64_t step = plumb_world_stats(w).step_count;
    mark *m = plumb_component_get(w, g->boxes[0].entity, g->mark);
    if (m != NULL) {
        ++m->hits;
    }
    if (step == 40) {
        g->spawned = plumb_command_body_create(w, &(plumb_body_desc){ .position = { 0, 8 } });
        plumb_command_shape_create(w, g->spawned,
                                   &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.4) });
        plumb_command_component_set(w, g->spawned.entity, g->mark, &(mark){ 10, 0 });
    }
    if (step == 70) {
        plumb_command_destroy(w, g->boxes[3].entity);
        plumb_command_component_remove(w, g->boxes[0].entity, g->mark);
    }
}

static inline plumb_body add_box(plumb_world *w, plumb_body_type type, plumb_vec2 at,
                                 plumb_vec2 half)
{
    plumb_body body = plumb_body_create(w, &(plumb_body_desc){ .type = type, .position = at });
    plumb_shape_create(w, body, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = half });
    return body;
}

static inline void add_systems(game *g)
{
    const plumb_system_desc systems[] = {
        { .name = "cool", .phase = PLUMB_PHASE_BEGIN, .run = at_begin, .needs = { g->mark } },
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

static inline void make_game(game *g, bool systems)
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
    plumb_component_set(w, g->boxes[0].entity, g->mark, &(mark){ 300, 1 });
    if (systems) {
        add_systems(g);
    }
}

// What the user does between the steps.
static inline void interfere(game *g, int step)
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
        plumb_component_set(w, g->ball.entity, g->later, &(double){ 2.5 });
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

static inline void play(game *g)
{
    for (int i = 1; i <= STEPS; ++i) {
        interfere(g, i);
        assert_int_equal(plumb_world_step(g->world, i % 3 == 0 ? DT : R(1.0 / 50)), PLUMB_OK);
        g->hashes[i] = plumb_world_hash(g->world);
    }
}

static inline void record_game(game *g, bool systems)
{
    make_game(g, systems);
    const plumb_recorder_desc desc = {
        .write = to_recording, .context = &g->tape, .keyframe_every = KEYS, .title = "a game"
    };
    assert_int_equal(plumb_recorder_start(g->world, &desc), PLUMB_OK);
    g->hashes[0] = plumb_world_hash(g->world);
    assert_int_equal(plumb_recorder_name(g->world, g->ball.entity, "the ball"), PLUMB_OK);
    play(g);
    assert_int_equal(plumb_recorder_stop(g->world), PLUMB_OK);
}

static inline void free_game(game *g)
{
    plumb_world_destroy(g->world);
    recording_free(&g->tape);
}

static inline plumb_replay *open_tape(const recording *tape, const plumb_replay_desc *desc)
{
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(tape->bytes, tape->size, desc, &replay), PLUMB_OK);
    return replay;
}

static inline void check_at(plumb_replay *replay, const game *g, int step)
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

#endif
