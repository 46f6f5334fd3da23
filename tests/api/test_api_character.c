// test_api_character.c - characters through the API: what is set is read, wrong calls are refused with
// their message and change nothing, the passes run only where they are wanted.
#include "world_fixture.h"

#include <stdio.h>

static bool scheduled(plumb_world *world, const char *name)
{
    plumb_pass_info rows[128];
    int count = plumb_world_schedule(world, rows, 128);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return rows[i].scheduled;
        }
    }
    fail_msg("no pass '%s'", name);
    return false;
}

static void comes_and_goes(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    assert_false(scheduled(w, "characters") || scheduled(w, "feet"));
    assert_false(plumb_body_is_character(w, f->kinematic));
    assert_int_equal(plumb_character_create(w, f->kinematic, NULL), PLUMB_OK);
    assert_true(plumb_body_is_character(w, f->kinematic));
    assert_true(scheduled(w, "characters") && scheduled(w, "feet"));
    assert_int_equal(plumb_character_create(w, f->dynamic, NULL), PLUMB_OK);
    assert_true(plumb_body_inertia(w, f->dynamic) == 0); // it cannot turn
    assert_int_equal(plumb_character_destroy(w, f->kinematic), PLUMB_OK);
    assert_true(plumb_body_is_character(w, f->dynamic));
    assert_int_equal(plumb_body_destroy(w, f->dynamic), PLUMB_OK);
    assert_false(plumb_body_is_character(w, f->dynamic));
    assert_false(scheduled(w, "characters"));
    assert_int_equal(plumb_world_step(w, R(0.01)), PLUMB_OK);
}

// Destroyed in any order, the others keep their settings.
static void the_array_closes_its_gaps(void **state)
{
    fixture *f = *state;
    plumb_body bodies[5];
    for (int i = 0; i < 5; ++i) {
        bodies[i] = plumb_body_create(f->world, &(plumb_body_desc){ .type = PLUMB_KINEMATIC });
        plumb_character_create(f->world, bodies[i], &(plumb_character_desc){ .mass = R(i + 1) });
    }
    plumb_body_destroy(f->world, bodies[1]);
    plumb_character_destroy(f->world, bodies[4]);
    plumb_body_destroy(f->world, bodies[0]);
    for (int i = 2; i < 4; ++i) {
        plumb_character_desc d;
        assert_int_equal(plumb_character_settings(f->world, bodies[i], &d), PLUMB_OK);
        assert_near(d.mass, i + 1, 0);
    }
}

static void settings_are_kept(void **state)
{
    fixture *f = *state;
    const plumb_character_desc desc = { .up = { 0, 2 },
                                        .max_slope = R(0.5),
                                        .skin = R(0.02),
                                        .step_height = R(0.3),
                                        .step_width = R(0.1),
                                        .snap_distance = R(0.2),
                                        .acceleration = 10,
                                        .air_acceleration = 5,
                                        .max_fall_speed = 20,
                                        .mass = 80,
                                        .push_force = 300 };
    plumb_character_desc got;
    assert_int_equal(plumb_character_create(f->world, f->kinematic, &desc), PLUMB_OK);
    assert_int_equal(plumb_character_settings(f->world, f->kinematic, &got), PLUMB_OK);
    assert_memory_equal(&got, &desc, sizeof got);
    const plumb_character_desc other = { .no_steps = true, .no_snap = true, .no_push = true };
    assert_int_equal(plumb_character_set(f->world, f->kinematic, &other), PLUMB_OK);
    plumb_character_settings(f->world, f->kinematic, &got);
    assert_memory_equal(&got, &other, sizeof got);
    assert_int_equal(plumb_character_set(f->world, f->kinematic, NULL), PLUMB_OK);
    plumb_character_state s;
    assert_int_equal(plumb_character_get(f->world, f->kinematic, &s), PLUMB_OK);
    assert_true(s.up.x == 0 && s.up.y == 1 && !s.on_ground && plumb_is_null(s.ground_body));
}

static plumb_result fresh(fixture *f, plumb_body_type type, const plumb_character_desc *d)
{
    static plumb_body bodies[2];
    plumb_body *body = &bodies[type == PLUMB_DYNAMIC];
    if (!plumb_body_valid(f->world, *body)) {
        *body = plumb_body_create(f->world, &(plumb_body_desc){ .type = type });
    }
    return plumb_character_create(f->world, *body, d);
}

#define NAN_ ((plumb_real)NAN)

static void wrong_settings_are_refused(void **state)
{
    fixture *f = *state;
    const struct {
        plumb_character_desc desc;
        bool dynamic;
        plumb_result code;
        const char *message;
    } cases[] = {
        { { .up = { NAN_, 0 } }, false, PLUMB_E_NOT_FINITE, "up is (nan, 0); it must be finite" },
        { { .max_slope = 2 }, false, PLUMB_E_RANGE, "max_slope is 2; it must be 0 to 1.5" },
        { { .max_slope = -1 }, true, PLUMB_E_RANGE, "max_slope is -1; it must be 0 to 1.5" },
        { { .skin = -1 }, false, PLUMB_E_RANGE, "skin is -1; it must be 0 to 1e+07" },
        { { .step_height = -1 }, false, PLUMB_E_RANGE, "step_height is -1; it must be 0 to 1e+07" },
        { { .step_width = NAN_ },
          false,
          PLUMB_E_NOT_FINITE,
          "step_width is nan; it must be finite" },
        { { .snap_distance = R(1e8) },
          false,
          PLUMB_E_RANGE,
          "snap_distance is 1e+08; it must be 0 to 1e+07" },
        { { .acceleration = -1 },
          true,
          PLUMB_E_RANGE,
          "acceleration is -1; it must be at least 0" },
        { { .air_acceleration = -2 },
          false,
          PLUMB_E_RANGE,
          "air_acceleration is -2; it must be at least 0" },
        { { .max_fall_speed = -2 },
          false,
          PLUMB_E_RANGE,
          "max_fall_speed is -2; it must be at least 0" },
        { { .mass = -2 }, false, PLUMB_E_RANGE, "mass is -2; it must be at least 0" },
        { { .push_force = -2 }, false, PLUMB_E_RANGE, "push_force is -2; it must be at least 0" },
        { { .step_height = 1, .no_steps = true },
          false,
          PLUMB_E_RANGE,
          "step_height is set; it must be 0 with no_steps" },
        { { .step_width = 1, .no_steps = true },
          false,
          PLUMB_E_RANGE,
          "step_width is set; it must be 0 with no_steps" },
        { { .snap_distance = 1, .no_snap = true },
          false,
          PLUMB_E_RANGE,
          "snap_distance is set; it must be 0 with no_snap" },
        { { .push_force = 1, .no_push = true },
          false,
          PLUMB_E_RANGE,
          "push_force is set; it must be 0 with no_push" },
        { { .air_acceleration = 1, .no_air_control = true },
          true,
          PLUMB_E_RANGE,
          "air_acceleration is set; it must be 0 with no_air_control" },
        { { .skin = 1 }, true, PLUMB_E_RANGE, "skin is set; it must be 0 for a dynamic character" },
        { { .step_height = 1 },
          true,
          PLUMB_E_RANGE,
          "step_height is set; it must be 0 for a dynamic character" },
        { { .step_width = 1 },
          true,
          PLUMB_E_RANGE,
          "step_width is set; it must be 0 for a dynamic character" },
        { { .snap_distance = 1 },
          true,
          PLUMB_E_RANGE,
          "snap_distance is set; it must be 0 for a dynamic character" },
        { { .max_fall_speed = 1 },
          true,
          PLUMB_E_RANGE,
          "max_fall_speed is set; it must be 0 for a dynamic character" },
        { { .mass = 1 }, true, PLUMB_E_RANGE, "mass is set; it must be 0 for a dynamic character" },
        { { .push_force = 1 },
          true,
          PLUMB_E_RANGE,
          "push_force is set; it must be 0 for a dynamic character" },
        { { .no_steps = true },
          true,
          PLUMB_E_RANGE,
          "no_steps is set; it must be 0 for a dynamic character" },
        { { .no_snap = true },
          true,
          PLUMB_E_RANGE,
          "no_snap is set; it must be 0 for a dynamic character" },
        { { .no_push = true },
          true,
          PLUMB_E_RANGE,
          "no_push is set; it must be 0 for a dynamic character" },
    };
    plumb_character_desc good = { .max_slope = -1 };
    fresh(f, PLUMB_KINEMATIC, &good); // makes the bodies
    fresh(f, PLUMB_DYNAMIC, &good);
    assert_int_equal(plumb_character_create(f->world, f->kinematic, NULL), PLUMB_OK);
    assert_int_equal(plumb_character_create(f->world, f->dynamic, NULL), PLUMB_OK);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[200];
        plumb_body_type type = cases[i].dynamic ? PLUMB_DYNAMIC : PLUMB_KINEMATIC;
        plumb_body known = cases[i].dynamic ? f->dynamic : f->kinematic;
        uint64_t before = digest_world(f->world);
        int errors = f->errors;
        snprintf(text, sizeof text, "plumb_character_create: %s", cases[i].message);
        check_refused(f, fresh(f, type, &cases[i].desc), before, errors, cases[i].code, text);
        errors = f->errors;
        snprintf(text, sizeof text, "plumb_character_set: %s", cases[i].message);
        check_refused(f, plumb_character_set(f->world, known, &cases[i].desc), before, errors,
                      cases[i].code, text);
    }
}

static void wrong_bodies_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_character_desc d;
    plumb_character_state s;
    REFUSED(E_HANDLE, "plumb_character_create: body is stale (0:1); it must be a live body",
            plumb_character_create(w, f->stale, NULL));
    REFUSED(E_STATE, "plumb_character_create: body is static; it must be kinematic or dynamic",
            plumb_character_create(w, f->fixed, NULL));
    plumb_character_create(w, f->kinematic, NULL);
    REFUSED(E_STATE, "plumb_character_create: body is a character; it must not be one already",
            plumb_character_create(w, f->kinematic, NULL));
#define NO_CHARACTER "body is no character; it must be made one with plumb_character_create"
    REFUSED(E_HANDLE, "plumb_character_destroy: " NO_CHARACTER,
            plumb_character_destroy(w, f->dynamic));
    REFUSED(E_HANDLE, "plumb_character_settings: " NO_CHARACTER,
            plumb_character_settings(w, f->dynamic, &d));
    REFUSED(E_HANDLE, "plumb_character_set: " NO_CHARACTER, plumb_character_set(w, f->dynamic, &d));
    REFUSED(E_HANDLE, "plumb_character_walk: " NO_CHARACTER,
            plumb_character_walk(w, f->dynamic, 1));
    REFUSED(E_HANDLE, "plumb_character_fly: " NO_CHARACTER,
            plumb_character_fly(w, f->dynamic, plumb_v2(1, 0)));
    REFUSED(E_HANDLE, "plumb_character_set_velocity: " NO_CHARACTER,
            plumb_character_set_velocity(w, f->dynamic, plumb_v2(1, 0)));
    REFUSED(E_HANDLE, "plumb_character_get: " NO_CHARACTER, plumb_character_get(w, f->dynamic, &s));
    REFUSED(E_HANDLE, "plumb_character_jump: " NO_CHARACTER,
            (assert_false(plumb_character_jump(w, f->dynamic, 1)), plumb_world_error(w).code));
    REFUSED(E_HANDLE, "plumb_character_drop: " NO_CHARACTER,
            (assert_false(plumb_character_drop(w, f->dynamic)), plumb_world_error(w).code));
    REFUSED(E_HANDLE, "plumb_character_hits: " NO_CHARACTER,
            (assert_int_equal(plumb_character_hits(w, f->dynamic, NULL, 0), -1),
             plumb_world_error(w).code));
    assert_int_equal(plumb_character_create(NULL, f->kinematic, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_character_walk(NULL, f->kinematic, 1), PLUMB_E_NULL);
    assert_false(plumb_character_jump(NULL, f->kinematic, 1));
    assert_int_equal(plumb_character_hits(NULL, f->kinematic, NULL, 0), -1);
    assert_false(plumb_body_is_character(NULL, f->kinematic));
}

static void wrong_arguments_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body b = f->kinematic;
    plumb_character_create(w, b, NULL);
    REFUSED(E_NULL, "plumb_character_settings: desc is null; it must be given",
            plumb_character_settings(w, b, NULL));
    REFUSED(E_NULL, "plumb_character_get: state is null; it must be given",
            plumb_character_get(w, b, NULL));
    REFUSED(E_NOT_FINITE, "plumb_character_walk: speed is nan; it must be finite",
            plumb_character_walk(w, b, NAN_));
    REFUSED(E_RANGE, "plumb_character_walk: speed is 1e+07; it must be -1e+06 to 1e+06",
            plumb_character_walk(w, b, R(1e7)));
    REFUSED(E_NOT_FINITE, "plumb_character_fly: velocity is (0, nan); it must be finite",
            plumb_character_fly(w, b, plumb_v2(0, NAN_)));
    REFUSED(E_NOT_FINITE, "plumb_character_set_velocity: velocity is (nan, 0); it must be finite",
            plumb_character_set_velocity(w, b, plumb_v2(NAN_, 0)));
    REFUSED(E_RANGE, "plumb_character_jump: speed is 0; it must be above 0",
            (plumb_character_jump(w, b, 0), plumb_world_error(w).code));
    REFUSED(E_RANGE, "plumb_character_jump: speed is -1; it must be 0 to 1e+06",
            (plumb_character_jump(w, b, -1), plumb_world_error(w).code));
    REFUSED(E_RANGE, "plumb_character_hits: capacity is -1; it must be at least 0",
            (plumb_character_hits(w, b, NULL, -1), plumb_world_error(w).code));
    REFUSED(E_NULL, "plumb_character_hits: hits is null; it must be given",
            (plumb_character_hits(w, b, NULL, 1), plumb_world_error(w).code));
    int errors = f->errors;
    assert_false(plumb_character_jump(w, b, 1)); // in the air: an answer, not an error
    assert_false(plumb_character_drop(w, b));
    assert_int_equal(f->errors, errors);
}

static void try_to_change(const plumb_system_call *call)
{
    plumb_body *bodies = call->context;
    assert_int_equal(plumb_character_create(call->world, bodies[1], NULL), PLUMB_E_LOCKED);
    assert_int_equal(plumb_character_destroy(call->world, bodies[0]), PLUMB_E_LOCKED);
    assert_int_equal(plumb_character_walk(call->world, bodies[0], 1), PLUMB_OK);
}

static void systems_give_orders_only(void **state)
{
    fixture *f = *state;
    plumb_body bodies[2] = { f->kinematic, f->dynamic };
    plumb_character_create(f->world, bodies[0], NULL);
    plumb_system_create(f->world, &(plumb_system_desc){ .name = "brain",
                                                        .phase = PLUMB_PHASE_BEGIN,
                                                        .run = try_to_change,
                                                        .context = bodies });
    plumb_vec2 p = plumb_body_position(f->world, f->kinematic);
    assert_int_equal(plumb_world_step(f->world, R(0.1)), PLUMB_OK);
    assert_near(plumb_body_position(f->world, f->kinematic).x, p.x + R(0.1), ROUNDED(1e-5));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(comes_and_goes),           API_TEST(the_array_closes_its_gaps),
        API_TEST(settings_are_kept),        API_TEST(wrong_settings_are_refused),
        API_TEST(wrong_bodies_are_refused), API_TEST(wrong_arguments_are_refused),
        API_TEST(systems_give_orders_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
