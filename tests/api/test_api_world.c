// test_api_world.c - worlds: defaults, refused descriptors, gravity, axes, statistics, energy,
// bodies as columns, two worlds side by side, result texts.
#define _POSIX_C_SOURCE 200809L // dup, fileno
#include "world_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

//---- creation ------------------------------------------------------------------------------------

static void a_zero_descriptor_means_the_documented_defaults(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    plumb_world_desc d = plumb_world_settings(w);
    assert_vec_near(d.gravity, 0, -9.81, ROUNDED(1e-6));
    assert_int_equal(d.solver, PLUMB_SOLVER_SOFT);
    assert_int_equal(d.substeps, 4);
    assert_int_equal(d.iterations, 1);
    assert_true(d.contact_hertz == 0 && d.restitution_speed == 0);
    assert_true(d.contact_damping == 3 && d.push_speed == 6);
    assert_true(d.simd_width == 4 || d.simd_width == 8 || d.simd_width == 16);
    assert_non_null((void *)(uintptr_t)d.allocator.resize);
    assert_vec_near(plumb_world_up(w), 0, 1, 0);
    assert_null(plumb_world_user_data(w));
    plumb_world_destroy(w);
}

static void given_settings_are_kept(void **state)
{
    (void)state;
    int mine = 0;
    const plumb_world_desc desc = { .gravity = { 1, 2 },
                                    .y_axis = PLUMB_Y_DOWN,
                                    .solver = PLUMB_SOLVER_PGS,
                                    .substeps = 3,
                                    .contact_hertz = 30,
                                    .contact_damping = 5,
                                    .push_speed = 2,
                                    .restitution_speed = 1,
                                    .simd_width = 4,
                                    .body_capacity = 100,
                                    .shape_capacity = 200,
                                    .contact_capacity = 300,
                                    .user_data = &mine };
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    plumb_world_desc d = plumb_world_settings(w);
    assert_vec_near(d.gravity, 1, 2, 0);
    assert_int_equal(d.substeps, 3);
    assert_int_equal(d.iterations, 10);
    assert_int_equal(d.simd_width, 4);
    assert_true(d.contact_hertz == 30 && d.contact_damping == 5 && d.push_speed == 2);
    assert_true(d.restitution_speed == 1);
    assert_int_equal(d.body_capacity, 100);
    assert_ptr_equal(plumb_world_user_data(w), &mine);
    assert_vec_near(plumb_world_up(w), 0, -1, 0);
    plumb_world *again;
    assert_int_equal(plumb_world_create(&d, &again),
                     PLUMB_OK); // resolved settings make the same world
    plumb_world_desc e = plumb_world_settings(again);
    assert_int_equal(e.iterations, d.iterations);
    plumb_world_destroy(again);
    plumb_world_destroy(w);
    plumb_world_destroy(NULL);
}

static void gravity_follows_axis_and_flags(void **state)
{
    (void)state;
    plumb_world *w;
    plumb_world_desc desc = { .y_axis = PLUMB_Y_DOWN };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    assert_vec_near(plumb_world_gravity(w), 0, 9.81, ROUNDED(1e-6));
    plumb_world_destroy(w);
    desc.zero_gravity = true;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    assert_vec_near(plumb_world_gravity(w), 0, 0, 0);
    assert_int_equal(plumb_world_set_gravity(w, plumb_v2(3, 0)), PLUMB_OK);
    assert_vec_near(plumb_world_gravity(w), 3, 0, 0);
    assert_false(plumb_world_settings(w).zero_gravity);
    assert_int_equal(plumb_world_set_gravity(w, plumb_v2(0, 0)), PLUMB_OK);
    assert_vec_near(plumb_world_gravity(w), 0, 0, 0);
    assert_true(plumb_world_settings(w).zero_gravity);
    plumb_world_destroy(w);
}

typedef struct bad_desc {
    plumb_world_desc desc;
    plumb_result code;
    const char *message;
} bad_desc;

static void bad_descriptors_are_refused_with_a_line_in_the_log(void **state)
{
    (void)state;
    const plumb_real nan = (plumb_real)NAN;
    const bad_desc bad[] = {
        { { .gravity = { nan, 0 } }, PLUMB_E_NOT_FINITE, "gravity is (nan, 0); it must be finite" },
        { { .gravity = { 0, 1 }, .zero_gravity = true },
          PLUMB_E_RANGE,
          "gravity is (0, 1); it must be (0, 0) with zero_gravity" },
        { { .y_axis = (plumb_y_axis)2 }, PLUMB_E_RANGE, "y_axis is 2; it must be one of up|down" },
        { { .solver = (plumb_solver)3 },
          PLUMB_E_RANGE,
          "solver is 3; it must be one of soft|pgs|exact" },
        { { .substeps = -1 }, PLUMB_E_RANGE, "substeps is -1; it must be 0, or 1 to 64" },
        { { .substeps = 65 }, PLUMB_E_RANGE, "substeps is 65; it must be 0, or 1 to 64" },
        { { .iterations = 1001 }, PLUMB_E_RANGE, "iterations is 1001; it must be 0, or 1 to 1000" },
        { { .contact_hertz = -1 }, PLUMB_E_RANGE, "contact_hertz is -1; it must be at least 0" },
        { { .contact_damping = nan },
          PLUMB_E_NOT_FINITE,
          "contact_damping is nan; it must be finite" },
        { { .push_speed = -2 }, PLUMB_E_RANGE, "push_speed is -2; it must be at least 0" },
        { { .restitution_speed = -1 },
          PLUMB_E_RANGE,
          "restitution_speed is -1; it must be at least 0" },
        { { .simd_width = 6 }, PLUMB_E_RANGE, "simd_width is 6; it must be 0, 4, 8 or 16" },
        { { .body_capacity = UINT32_MAX },
          PLUMB_E_RANGE,
          "body_capacity is 4294967295; it must be 0 to 16777216" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        fixture f = { .errors = 0 };
        plumb_world_desc desc = bad[i].desc;
        desc.log = keep_log;
        desc.hook_context = &f;
        plumb_world *w = (plumb_world *)&f; // must become null
        assert_int_equal(plumb_world_create(&desc, &w), bad[i].code);
        assert_null(w);
        assert_int_equal(f.errors, 1);
        assert_memory_equal(f.logged, "plumb_world_create: ", 20);
        assert_string_equal(f.logged + 20, bad[i].message);
    }
    assert_int_equal(plumb_world_create(NULL, NULL), PLUMB_E_NULL);
}

static void a_new_world_has_no_error_and_success_keeps_the_last_one(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    assert_int_equal(plumb_world_error(w).code, PLUMB_OK);
    assert_string_equal(plumb_world_error(w).function, "");
    assert_string_equal(plumb_world_error(w).message, "");
    plumb_world_step(w, 5);
    assert_int_equal(plumb_world_step(w, R(0.01)), PLUMB_OK);
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_RANGE);
    assert_string_equal(plumb_world_error(w).function, "plumb_world_step");
    plumb_world_destroy(w);
}

static void every_result_has_a_text(void **state)
{
    (void)state;
#define CHECK_TEXT(name, value, text)                                                              \
    assert_int_equal(PLUMB_##name, value);                                                         \
    assert_string_equal(plumb_result_text(PLUMB_##name), text);
    PLUMB_RESULT_LIST(CHECK_TEXT)
    assert_string_equal(plumb_result_text((plumb_result)15), "unknown result");
    assert_string_equal(plumb_result_text((plumb_result)-1), "unknown result");
}

//---- sums ----------------------------------------------------------------------------------------

static void statistics_count_what_is_there(void **state)
{
    fixture *f = *state;
    plumb_stats s = plumb_world_stats(f->world);
    assert_int_equal(s.body_count, 3);
    assert_int_equal(s.dynamic_count, 1);
    assert_int_equal(s.kinematic_count, 1);
    assert_int_equal(s.static_count, 1);
    assert_int_equal(s.shape_count, 3);
    assert_int_equal(s.piece_count, 3);
    assert_int_equal(s.step_count, 0);
    assert_true(s.bytes > sizeof(void *) && s.peak_bytes >= s.bytes);
    for (int i = 0; i < 10; ++i) {
        assert_int_equal(plumb_world_step(f->world, R(0.125)), PLUMB_OK);
    }
    s = plumb_world_stats(f->world);
    assert_int_equal(s.step_count, 10);
    assert_true(s.time == 1.25);
    assert_true(plumb_world_stats(NULL).bytes == 0);
    plumb_memory_row rows[32];
    int parts = plumb_world_memory(f->world, rows, 32);
    size_t sum = 0;
    assert_in_range(parts, 10, 32);
    for (int i = 0; i < parts; ++i) {
        sum += rows[i].bytes;
    }
    assert_int_equal(sum, plumb_world_stats(f->world).bytes);
    assert_string_equal(rows[0].name, "bodies");
    assert_int_equal(rows[0].count, plumb_world_stats(f->world).body_count);
    assert_int_equal(plumb_world_memory(f->world, NULL, 5), parts);
    assert_int_equal(plumb_world_memory(NULL, rows, 32), 0);
}

static void energy_is_that_of_the_dynamic_bodies(void **state)
{
    (void)state;
    plumb_world *w;
    const plumb_world_desc desc = { .gravity = { 0, -10 } };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    plumb_body_create(w, &(plumb_body_desc){ .mass = 2,
                                             .inertia = 3,
                                             .position = { 1, 4 },
                                             .velocity = { 3, -1 },
                                             .angular_velocity = 2 });
    plumb_body_create(w, &(plumb_body_desc){ .mass = 1, .position = { 0, 7 }, .no_gravity = true });
    plumb_body_create(w,
                      &(plumb_body_desc){ .mass = 1, .position = { 0, 1 }, .gravity_scale = -2 });
    plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .velocity = { 100, 0 } });
    plumb_energy e = plumb_world_energy(w);
    assert_near(e.kinetic, 10 + 6, 1e-5); // m v^2 / 2 + I w^2 / 2
    assert_near(e.potential, 80 + 0 - 20, ROUNDED(1e-5));
    assert_near(e.momentum_x, 6, ROUNDED(1e-6));
    assert_near(e.momentum_y, -2, ROUNDED(1e-6));
    assert_near(e.angular_momentum, 2 * (1 * -1 - 4 * 3) + 3 * 2, ROUNDED(1e-5));
    assert_near(e.mass, 4, ROUNDED(1e-6));
    plumb_world_destroy(w);
    assert_true(plumb_world_energy(NULL).mass == 0);
}

static void body_columns_are_partitioned_and_writable(void **state)
{
    fixture *f = *state;
    plumb_body_span b = plumb_world_bodies(f->world);
    assert_int_equal(b.count, 3);
    assert_int_equal(b.dynamic_count, 1);
    assert_int_equal(b.kinematic_count, 1);
    assert_int_equal(b.asleep_count, 0);
    assert_int_equal(b.static_count, 1);
    assert_true(plumb_same(b.body[0], f->dynamic));
    assert_true(plumb_same(b.body[1], f->kinematic));
    assert_true(plumb_same(b.body[2], f->fixed));
    assert_true(b.x[1] == 10 && b.y[0] == 5 && b.c[2] == 1 && b.s[2] == 0);
    assert_true(b.inv_mass[0] > 0 && b.inv_inertia[0] > 0 && b.inv_mass[1] == 0);
    b.vx[0] = 7;
    b.w[0] = 2;
    assert_vec_near(plumb_body_velocity(f->world, f->dynamic), 7, 0, 0);
    assert_near(plumb_body_angular_velocity(f->world, f->dynamic), 2, 0);
    assert_int_equal(plumb_world_bodies(NULL).count, 0);
}

static void worlds_share_nothing(void **state)
{
    fixture *f = *state;
    plumb_world *other;
    assert_int_equal(plumb_world_create(NULL, &other), PLUMB_OK);
    uint64_t before = digest_world(f->world);
    plumb_body_create(other, &(plumb_body_desc){ 0 });
    plumb_world_step(other, 1);
    plumb_world_step(other, 5);
    assert_true(digest_world(f->world) == before);
    assert_int_equal(plumb_world_error(f->world).code, PLUMB_OK);
    plumb_world_destroy(other);
}

// A body whose next state would not be finite is taken out where it is; the others do not notice. (In full:
// tests/determinism/test_quarantine.c.)
static void lost_body_is_stopped(void **state)
{
    (void)state;
    plumb_world *world;
    assert_int_equal(plumb_world_create(NULL, &world), PLUMB_OK);
    plumb_body lost = plumb_body_create(world, &(plumb_body_desc){ .position = { 1, 2 } });
    plumb_body other = plumb_body_create(world, &(plumb_body_desc){ .position = { 5, 5 } });
    assert_int_equal(plumb_body_set_velocity(world, lost, (plumb_vec2){ (plumb_real)1e30, 0 }),
                     PLUMB_OK);
    assert_int_equal(plumb_world_step(world, (plumb_real)(1.0 / 60)), PLUMB_OK);
    assert_int_equal(plumb_world_stats(world).arrested_count, 1);
    int count;
    const plumb_quarantine *out = plumb_world_quarantine_events(world, &count);
    assert_int_equal(count, 1);
    assert_true(plumb_same(out->body, lost));
    assert_string_equal(out->pass, "calls");
    assert_false(plumb_body_is_enabled(world, lost));
    plumb_vec2 at = plumb_body_position(world, lost), v = plumb_body_velocity(world, lost);
    assert_true(at.x == 1 && at.y == 2 && v.x == 0 && v.y == 0);
    assert_true(plumb_body_velocity(world, other).y < 0);
    plumb_world_destroy(world);
}

static void settings_change(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    int tag;
    assert_int_equal(plumb_world_set_substeps(w, 8, 2), PLUMB_OK);
    assert_int_equal(plumb_world_set_contact_tuning(w, 30, 5, 2), PLUMB_OK);
    assert_int_equal(plumb_world_set_restitution_speed(w, R(0.5)), PLUMB_OK);
    assert_int_equal(plumb_world_set_user_data(w, &tag), PLUMB_OK);
    plumb_world_desc d = plumb_world_settings(w);
    assert_int_equal(d.substeps, 8);
    assert_int_equal(d.iterations, 2);
    assert_near(d.contact_hertz, 30, 0);
    assert_near(d.contact_damping, 5, 0);
    assert_near(d.push_speed, 2, 0);
    assert_near(d.restitution_speed, 0.5, 0);
    assert_ptr_equal(plumb_world_user_data(w), &tag);
    assert_int_equal(plumb_world_set_contact_tuning(w, 0, 0, 0), PLUMB_OK);
    d = plumb_world_settings(w);
    assert_near(d.contact_damping, 3, 0); // the defaults
    assert_near(d.push_speed, 6, 0);
    assert_near(d.gravity.y, -9.81, ROUNDED(1e-6));
    assert_int_equal(plumb_world_step(w, R(0.01)), PLUMB_OK);
    REFUSED(E_RANGE, "plumb_world_set_substeps: substeps is 0; it must be 1 to 64",
            plumb_world_set_substeps(w, 0, 1));
    REFUSED(E_RANGE, "plumb_world_set_substeps: iterations is 1001; it must be 1 to 1000",
            plumb_world_set_substeps(w, 1, 1001));
    REFUSED(E_RANGE, "plumb_world_set_contact_tuning: hertz is -1; it must be at least 0",
            plumb_world_set_contact_tuning(w, -1, 0, 0));
    REFUSED(E_RANGE, "plumb_world_set_contact_tuning: damping is -1; it must be at least 0",
            plumb_world_set_contact_tuning(w, 0, -1, 0));
    REFUSED(E_NOT_FINITE, "plumb_world_set_contact_tuning: push_speed is nan; it must be finite",
            plumb_world_set_contact_tuning(w, 0, 0, R(NAN)));
    REFUSED(E_RANGE, "plumb_world_set_restitution_speed: speed is -1; it must be at least 0",
            plumb_world_set_restitution_speed(w, -1));
    assert_int_equal(plumb_world_set_workers(w, 2), PLUMB_OK);
    assert_int_equal(plumb_world_settings(w).workers, 2);
    assert_int_equal(plumb_world_set_workers(w, 0), PLUMB_OK);
    assert_int_equal(plumb_world_settings(w).workers, 1);
    REFUSED(E_RANGE, "plumb_world_set_workers: workers is 65; it must be 0 to 64",
            plumb_world_set_workers(w, 65));
    REFUSED(E_RANGE, "plumb_world_set_workers: workers is -1; it must be 0 to 64",
            plumb_world_set_workers(w, -1));
    assert_int_equal(plumb_world_set_workers(NULL, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_world_set_substeps(NULL, 1, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_world_set_contact_tuning(NULL, 1, 1, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_world_set_restitution_speed(NULL, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_world_set_user_data(NULL, NULL), PLUMB_E_NULL);
}

static void set_in_a_step(const plumb_system_call *call)
{
    assert_int_equal(plumb_world_set_substeps(call->world, 1, 1), PLUMB_E_LOCKED);
    assert_int_equal(plumb_world_set_workers(call->world, 2), PLUMB_E_LOCKED);
    assert_int_equal(plumb_world_set_contact_tuning(call->world, 1, 1, 1), PLUMB_E_LOCKED);
    assert_int_equal(plumb_world_set_restitution_speed(call->world, 1), PLUMB_E_LOCKED);
}

static void settings_are_locked_in_a_step(void **state)
{
    fixture *f = *state;
    plumb_system_create(f->world, &(plumb_system_desc){ .name = "s", .run = set_in_a_step });
    assert_int_equal(plumb_world_step(f->world, R(0.01)), PLUMB_OK);
}

// Every shape's lower corner lies in a cell that is told, no cell is told twice, and shapes of
// different sizes are filed in cells of different sizes.
static void cells_hold_what_is_there(void **state)
{
    (void)state;
    plumb_world *w;
    plumb_aabb cells[32];
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &w), PLUMB_OK);
    for (int i = 0; i < 6; ++i) {
        plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(0.4) * (plumb_real)(i / 2), R(0.1) },
                                   .type = i == 5 ? PLUMB_STATIC : PLUMB_DYNAMIC });
        plumb_real size = i == 5 ? 40 : R(0.05);
        plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { size, size } });
    }
    assert_int_equal(plumb_world_cells(NULL, cells, 32), 0);
    assert_int_equal(plumb_world_cells(w, cells, 32), 0); // nothing is filed before the first step
    assert_int_equal(plumb_world_step(w, R(0.01)), PLUMB_OK);
    int count = plumb_world_cells(w, cells, 32);
    assert_in_range(count, 3, 6);
    assert_int_equal(plumb_world_cells(w, cells, 1), count);
    assert_int_equal(plumb_world_cells(w, NULL, 0), count);
    plumb_shape shapes[8];
    int shape_count = plumb_world_shapes(w, shapes, 8);
    for (int i = 0; i < shape_count; ++i) {
        plumb_vec2 corner = plumb_shape_aabb(w, shapes[i]).min;
        bool held = false;
        for (int k = 0; k < count; ++k) {
            // Boxes are filed by the corner of their fat box, at most a tenth of a cell lower.
            plumb_real slack = R(0.2) * (cells[k].max.x - cells[k].min.x);
            held |= corner.x >= cells[k].min.x && corner.x <= cells[k].max.x + slack &&
                    corner.y >= cells[k].min.y && corner.y <= cells[k].max.y + slack;
        }
        assert_true(held);
    }
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < i; ++k) {
            assert_true(memcmp(&cells[i], &cells[k], sizeof cells[i]) != 0);
        }
    }
    assert_true(cells[count - 1].max.x - cells[count - 1].min.x >
                50 * (cells[0].max.x - cells[0].min.x));
    plumb_world_destroy(w);
}

static void an_error_is_forgotten_when_asked(void **state)
{
    fixture *f = *state;
    plumb_body_destroy(f->world, f->stale);
    assert_int_equal(plumb_world_error(f->world).code, PLUMB_E_HANDLE);
    plumb_world_clear_error(f->world);
    assert_int_equal(plumb_world_error(f->world).code, PLUMB_OK);
    assert_string_equal(plumb_world_error(f->world).function, "");
    assert_string_equal(plumb_world_error(f->world).message, "");
    plumb_world_clear_error(NULL);
    plumb_body_destroy(f->world, f->stale);
    assert_int_equal(plumb_world_error(f->world).code, PLUMB_E_HANDLE);
}

// The line is read back from a file in stderr's place.
static void the_ready_made_log_writes_to_stderr(void **state)
{
    (void)state;
    plumb_world *w;
    FILE *file = tmpfile();
    char lines[256] = "";
    fflush(stderr);
    int kept = dup(STDERR_FILENO);
    assert_true(file != NULL && dup2(fileno(file), STDERR_FILENO) >= 0);
    plumb_result made = plumb_world_create(&(plumb_world_desc){ .log = plumb_log_stderr }, &w);
    plumb_body_position(w, NO_BODY);
    plumb_log_stderr(NULL, PLUMB_LOG_WARN, "odd");
    plumb_log_stderr(NULL, PLUMB_LOG_INFO, "so");
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
    plumb_world_destroy(w);
    rewind(file);
    size_t size = fread(lines, 1, sizeof lines - 1, file);
    fclose(file);
    assert_int_equal(made, PLUMB_OK);
    assert_true(size > 0);
    assert_string_equal(lines,
                        "plumb error: plumb_body_position: body is null; it must be a live body\n"
                        "plumb warning: odd\nplumb info: so\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(an_error_is_forgotten_when_asked),
        cmocka_unit_test(the_ready_made_log_writes_to_stderr),
        cmocka_unit_test(cells_hold_what_is_there),
        cmocka_unit_test(lost_body_is_stopped),
        cmocka_unit_test(a_zero_descriptor_means_the_documented_defaults),
        cmocka_unit_test(given_settings_are_kept),
        cmocka_unit_test(gravity_follows_axis_and_flags),
        cmocka_unit_test(bad_descriptors_are_refused_with_a_line_in_the_log),
        cmocka_unit_test(a_new_world_has_no_error_and_success_keeps_the_last_one),
        cmocka_unit_test(every_result_has_a_text),
        API_TEST(statistics_count_what_is_there),
        cmocka_unit_test(energy_is_that_of_the_dynamic_bodies),
        API_TEST(body_columns_are_partitioned_and_writable),
        API_TEST(worlds_share_nothing),
        API_TEST(settings_change),
        API_TEST(settings_are_locked_in_a_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
