// test_api_ecs.c - entities, systems at their phases, commands, the columns that a system works on.
#include "world_fixture.h"

//---- entities ------------------------------------------------------------------------------------

// Does not compile if two of them are one type: then a shape could be handed over for a body.
#define KIND_OF(handle)                                                                            \
    _Generic((handle), plumb_entity : 1, plumb_body : 2, plumb_shape : 3, plumb_material : 4,      \
             plumb_joint : 5)

static void handles_of_every_kind_are_types_of_their_own(void **state)
{
    fixture *f = *state;
    plumb_joint joint = PLUMB_NULL_INIT;
    assert_int_equal(KIND_OF(f->dynamic.entity), 1);
    assert_int_equal(KIND_OF(f->dynamic), 2);
    assert_int_equal(KIND_OF(f->box), 3);
    assert_int_equal(KIND_OF(f->wood), 4);
    assert_int_equal(KIND_OF(joint), 5);
    assert_true(plumb_is_null(joint) && plumb_is_null(joint.entity) && plumb_is_null(NO_MATERIAL));
    assert_false(plumb_is_null(f->dynamic) || plumb_is_null(f->box) || plumb_is_null(f->wood));
    assert_true(plumb_same(f->dynamic, (plumb_body){ f->dynamic.entity }));
    assert_false(plumb_same(f->dynamic, f->fixed) || plumb_same(f->box.entity, f->wood.entity));
}

static void entities_of_every_kind_are_told_apart(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_entity bare = plumb_entity_create(w);
    assert_int_equal(plumb_entity_get_kind(w, bare), PLUMB_KIND_BARE);
    assert_int_equal(plumb_entity_get_kind(w, f->dynamic.entity), PLUMB_KIND_BODY);
    assert_int_equal(plumb_entity_get_kind(w, f->box.entity), PLUMB_KIND_SHAPE);
    assert_int_equal(plumb_entity_get_kind(w, f->wood.entity), PLUMB_KIND_MATERIAL);
    assert_int_equal(plumb_entity_get_kind(w, f->stale.entity), PLUMB_KIND_NONE);
    assert_false(plumb_entity_alive(w, f->stale.entity));
    const plumb_entity all[] = { bare, f->box.entity, f->dynamic.entity, f->wood.entity };
    for (int i = 0; i < 4; ++i) {
        assert_true(plumb_entity_alive(w, all[i]));
        assert_int_equal(plumb_entity_destroy(w, all[i]), PLUMB_OK);
        assert_false(plumb_entity_alive(w, all[i]));
        assert_int_equal(plumb_entity_get_kind(w, all[i]), PLUMB_KIND_NONE);
    }
    assert_false(plumb_entity_alive(NULL, bare));
    assert_int_equal(plumb_entity_get_kind(NULL, bare), PLUMB_KIND_NONE);
    static const char *const names[] = { "nothing",  "bare entity", "body", "shape",
                                         "material", "joint",       "law",  "soft body" };
    for (int kind = 0; kind <= PLUMB_KIND_SOFTBODY; ++kind) {
        assert_string_equal(plumb_entity_kind_name((plumb_entity_kind)kind), names[kind]);
    }
    assert_null(plumb_entity_kind_name((plumb_entity_kind)(PLUMB_KIND_SOFTBODY + 1)));
    assert_null(plumb_entity_kind_name((plumb_entity_kind)-1));
}

static void components_go_to_any_kind_and_leave_with_it(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_entity all[] = { plumb_entity_create(w), f->box.entity, f->fixed.entity,
                                 f->wood.entity };
    for (int i = 0; i < 4; ++i) {
        float value = (float)i;
        assert_int_equal(plumb_component_set(w, all[i], f->health, &value), PLUMB_OK);
    }
    assert_int_equal(plumb_component_find(w, "health").id, f->health.id);
    assert_int_equal(plumb_component_find(w, "nobody's").id, 0);
    assert_int_equal(plumb_component_find(NULL, "health").id, 0);
    assert_int_equal(plumb_world_column(w, f->health).count, 4);
    for (int i = 0; i < 4; ++i) {
        assert_true(*(float *)plumb_component_get(w, all[i], f->health) == (float)i);
        assert_int_equal(plumb_entity_destroy(w, all[i]), PLUMB_OK);
        assert_null(plumb_component_get(w, all[i], f->health));
        assert_int_equal(plumb_world_column(w, f->health).count, 3 - i);
    }
    assert_int_equal(plumb_component_set(w, f->dynamic.entity, f->health, NULL), PLUMB_OK);
    assert_true(*(float *)plumb_component_get(w, f->dynamic.entity, f->health) == 0);
    const plumb_component none = { 0 };
    assert_null(plumb_component_get(w, f->dynamic.entity, none));
    assert_int_equal(plumb_world_column(w, none).count, 0);
    assert_int_equal(plumb_world_column(NULL, f->health).count, 0);
}

//---- systems -------------------------------------------------------------------------------------

typedef struct trace {
    char order[64];
    double time[8];
    plumb_component health;
} trace;

static void note(const plumb_system_call *call, char name)
{
    trace *t = call->context;
    size_t used = strlen(t->order);
    t->time[used] = call->time;
    t->order[used] = name;
    t->order[used + 1] = '\0';
}

static void run_a(const plumb_system_call *call)
{
    note(call, 'a');
}

static void run_b(const plumb_system_call *call)
{
    note(call, 'b');
}

static void run_c(const plumb_system_call *call)
{
    note(call, 'c');
}

static void systems_run_by_phase_then_registration(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    trace t = { .order = "" };
    const plumb_system_desc descs[] = {
        { .name = "c", .phase = PLUMB_PHASE_END, .run = run_c, .context = &t },
        { .name = "b", .phase = PLUMB_PHASE_BEGIN, .run = run_b, .context = &t },
        { .name = "a", .phase = PLUMB_PHASE_FORCES, .run = run_a, .context = &t },
        { .name = "a2",
          .phase = PLUMB_PHASE_BEGIN,
          .run = run_a,
          .context = &t,
          .needs = { f->health } },
    };
    for (int i = 0; i < 4; ++i) {
        assert_int_equal(plumb_system_create(w, &descs[i]), PLUMB_OK);
    }
    plumb_world_step(w, R(0.25));
    assert_string_equal(t.order, "bac"); // a2 is not wanted: nobody has "health"
    assert_true(t.time[0] == 0 && t.time[1] == 0 && t.time[2] == 0.25);
    plumb_component_set(w, f->dynamic.entity, f->health, NULL);
    assert_int_equal(plumb_system_enable(w, "b", false), PLUMB_OK);
    t.order[0] = '\0';
    plumb_world_step(w, R(0.25));
    assert_string_equal(t.order, "aac");
    assert_int_equal(plumb_system_enable(w, "b", true), PLUMB_OK);
    t.order[0] = '\0';
    plumb_world_step(w, R(0.25));
    assert_string_equal(t.order, "baac");
}

static void systems_stand_in_the_schedule_with_reasons(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    trace t = { .order = "" };
    char name[] = "wind";
    plumb_system_create(w, &(plumb_system_desc){ .name = name,
                                                 .phase = PLUMB_PHASE_FORCES,
                                                 .run = run_a,
                                                 .needs = { f->health },
                                                 .reads = "health",
                                                 .writes = "forces",
                                                 .context = &t });
    memset(name, '?', 4); // copied
    plumb_pass_info rows[128];
    for (int round = 0; round < 3; ++round) {
        const char *const reasons[] = { "no entity has the component that it needs",
                                        "some entity has the component that it needs",
                                        "switched off" };
        int count = plumb_world_schedule(w, rows, 128);
        int found = 0;
        for (int i = 0; i < count; ++i) {
            if (strcmp(rows[i].name, "wind") == 0) {
                ++found;
                assert_true(rows[i].is_user);
                assert_string_equal(rows[i].reason, reasons[round]);
                assert_int_equal(rows[i].scheduled, round == 1);
                assert_string_equal(rows[i].reads, "health");
                assert_string_equal(rows[i].writes, "forces");
            }
        }
        assert_int_equal(found, 1);
        if (round == 0) {
            plumb_component_set(w, f->dynamic.entity, f->health, NULL);
        } else {
            plumb_system_enable(w, "wind", false);
        }
    }
}

// Lifts every body that has "health", by its column.
static void lift(const plumb_system_call *call)
{
    const trace *t = call->context;
    plumb_component_span span = plumb_world_column(call->world, t->health);
    for (int i = 0; i < span.count; ++i) {
        plumb_body_apply_force_center(call->world, (plumb_body){ span.entity[i] },
                                      plumb_v2(0, (plumb_real)((float *)span.values)[i]));
    }
}

static void a_system_pushes_through_columns(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    trace t = { .health = f->health };
    plumb_world_set_gravity(w, plumb_v2(0, 0));
    plumb_component_set(w, f->dynamic.entity, f->health, &(float){ 8 });
    plumb_system_create(w, &(plumb_system_desc){ .name = "lift",
                                                 .phase = PLUMB_PHASE_FORCES,
                                                 .run = lift,
                                                 .needs = { f->health },
                                                 .context = &t });
    plumb_world_step(w, R(0.5));
    assert_vec_near(plumb_body_velocity(w, f->dynamic), 0, 1, 1e-6); // 8 N / 4 kg * 0.5 s
}

//---- commands ------------------------------------------------------------------------------------

static void commands_are_carried_out_in_order(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_vec2 points[] = { { 0, 0 }, { 2, 0 }, { 0, 2 } };
    plumb_body body = plumb_command_body_create(w, &(plumb_body_desc){ .position = { 7, 7 } });
    plumb_shape shape = plumb_command_shape_create(
        w, body, &(plumb_shape_desc){ .kind = PLUMB_POLYGON, .points = points, .count = 3 });
    memset(points, 0, sizeof points); // copied
    plumb_entity bare = plumb_command_entity_create(w);
    assert_int_equal(plumb_command_component_set(w, bare, f->health, &(float){ 3 }), PLUMB_OK);
    assert_int_equal(plumb_command_component_set(w, body.entity, f->health, NULL), PLUMB_OK);
    assert_int_equal(plumb_command_component_remove(w, body.entity, f->health), PLUMB_OK);
    assert_int_equal(plumb_command_teleport(w, body, plumb_v2(-1, -2), 0), PLUMB_OK);
    assert_int_equal(plumb_command_destroy(w, f->kinematic.entity), PLUMB_OK);

    assert_false(plumb_body_valid(w, body));
    assert_false(plumb_entity_alive(w, bare));
    assert_true(plumb_body_valid(w, f->kinematic));
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_true(plumb_body_valid(w, body));
    assert_vec_near(plumb_body_position(w, body), -1, -2, 0);
    assert_true(plumb_same(plumb_shape_body(w, shape), body));
    assert_near(plumb_body_mass(w, body), 2, ROUNDED(1e-6));
    assert_true(*(float *)plumb_component_get(w, bare, f->health) == 3);
    assert_null(plumb_component_get(w, body.entity, f->health));
    assert_false(plumb_body_valid(w, f->kinematic));
    assert_int_equal(f->errors + f->warnings, 0);
    uint64_t after = digest_world(w);
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_true(digest_world(w) == after); // once
}

static void commands_on_the_dead_are_dropped_with_a_warning(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_shape_desc circle = { .kind = PLUMB_CIRCLE, .radius = 1 };
    plumb_shape lost = plumb_command_shape_create(w, f->dynamic, &circle);
    plumb_command_component_set(w, lost.entity, f->health, NULL);
    plumb_command_destroy(w, f->dynamic.entity);
    plumb_command_destroy(w, f->dynamic.entity);
    plumb_command_teleport(w, f->dynamic, plumb_v2(0, 0), 0);
    plumb_command_component_remove(w, f->fixed.entity, f->health);
    plumb_body_destroy(w, f->dynamic);
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_int_equal(f->warnings, 6);
    assert_int_equal(f->errors, 0);
    assert_string_equal(f->logged, "plumb_command_component_remove: dropped for entity 4:1; "
                                   "it does not have the component");
    assert_false(plumb_shape_valid(w, lost));
    assert_int_equal(plumb_command_destroy(w, lost.entity), PLUMB_E_HANDLE); // its handle is stale
}

static void a_command_whose_material_is_gone_is_dropped(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_shape lost = plumb_command_shape_create(
        w, f->dynamic,
        &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1, .material = f->wood });
    plumb_material_destroy(w, f->wood);
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_int_equal(f->warnings, 1);
    assert_false(plumb_shape_valid(w, lost));
    // Taken into use between the command and its time: kept.
    plumb_material m = plumb_material_create(w, &(plumb_material_desc){ 0 });
    plumb_command_destroy(w, m.entity);
    plumb_shape_set_material(w, f->box, m);
    plumb_commands_apply(w);
    assert_int_equal(f->warnings, 2);
    assert_true(plumb_entity_alive(w, m.entity));
}

static void spawn(const plumb_system_call *call)
{
    fixture *f = call->context;
    plumb_body b =
        plumb_command_body_create(call->world, &(plumb_body_desc){ .position = { 0, 50 } });
    plumb_command_shape_create(call->world, b,
                               &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    f->stale = b;
}

static void commands_of_systems_come_true_in_the_next_step(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_system_create(w, &(plumb_system_desc){ .name = "spawner", .run = spawn, .context = f });
    plumb_world_step(w, R(0.01));
    plumb_body first = f->stale;
    assert_false(plumb_body_valid(w, first));
    plumb_world_step(w, R(0.01));
    assert_true(plumb_body_valid(w, first));
    assert_int_equal(plumb_world_stats(w).body_count, 4);
    assert_int_equal(plumb_world_stats(w).shape_count, 4);
}

// Every addition asks for another one.
static void breed(plumb_world *w, plumb_entity e, void *value, void *context)
{
    (void)e;
    (void)value;
    plumb_component c = { *(uint32_t *)context };
    plumb_command_component_set(w, plumb_command_entity_create(w), c, NULL);
}

static void commands_of_hooks_wait_for_the_next_time(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    uint32_t id = 0;
    plumb_component c = plumb_component_create(
        w,
        &(plumb_component_desc){ .name = "rabbit", .size = 16, .on_add = breed, .context = &id });
    id = c.id;
    plumb_component_set(w, f->fixed.entity, c, NULL);
    for (int i = 1; i <= 5; ++i) {
        assert_int_equal(plumb_world_column(w, c).count, i);
        assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(handles_of_every_kind_are_types_of_their_own),
        API_TEST(entities_of_every_kind_are_told_apart),
        API_TEST(components_go_to_any_kind_and_leave_with_it),
        API_TEST(systems_run_by_phase_then_registration),
        API_TEST(systems_stand_in_the_schedule_with_reasons),
        API_TEST(a_system_pushes_through_columns),
        API_TEST(commands_are_carried_out_in_order),
        API_TEST(commands_on_the_dead_are_dropped_with_a_warning),
        API_TEST(a_command_whose_material_is_gone_is_dropped),
        API_TEST(commands_of_systems_come_true_in_the_next_step),
        API_TEST(commands_of_hooks_wait_for_the_next_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
