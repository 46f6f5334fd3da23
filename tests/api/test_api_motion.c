// test_api_motion.c - how bodies move: locked axes, damping, caps, time scale, targets, given masses;
// what each refuses and in which words.
#include "world_fixture.h"

#define NONE ((plumb_body)PLUMB_NULL_INIT)
#define NAN_ ((plumb_real)NAN)
#define STEP R(1.0 / 60)

static void steps(fixture *f, int count)
{
    for (int i = 0; i < count; ++i) {
        assert_int_equal(plumb_world_step(f->world, STEP), PLUMB_OK);
    }
}

//---- locked axes ---------------------------------------------------------------------------------

static void locks_are_kept_and_told(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(3, 4));
    plumb_body_set_angular_velocity(w, f->dynamic, 5);
    plumb_axis_locks locks = plumb_body_locks(w, f->dynamic);
    assert_false(locks.x || locks.y || locks.rotation);
    assert_int_equal(plumb_body_set_locks(w, f->dynamic, (plumb_axis_locks){ .x = true }),
                     PLUMB_OK);
    assert_vec_near(plumb_body_velocity(w, f->dynamic), 0, 4, 0);
    plumb_body_apply_impulse(w, f->dynamic, plumb_v2(8, 8), plumb_v2(0, 5));
    assert_vec_near(plumb_body_velocity(w, f->dynamic), 0, 6, ROUNDED(1e-6));
    plumb_body_apply_force_center(w, f->dynamic, plumb_v2(100, 0));
    steps(f, 10);
    assert_true(plumb_body_position(w, f->dynamic).x == 0);
    assert_true(plumb_body_position(w, f->dynamic).y > 5);
    plumb_body_set_locks(w, f->dynamic, (plumb_axis_locks){ .y = true, .rotation = true });
    locks = plumb_body_locks(w, f->dynamic);
    assert_true(!locks.x && locks.y && locks.rotation);
    assert_near(plumb_body_inertia(w, f->dynamic), 0, 0);
    plumb_real y = plumb_body_position(w, f->dynamic).y;
    steps(f, 30);
    assert_true(plumb_body_position(w, f->dynamic).y == y);
    plumb_body_set_locks(w, f->dynamic, (plumb_axis_locks){ .x = false });
    steps(f, 30);
    assert_true(plumb_body_position(w, f->dynamic).y < y);
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .lock_x = true, .lock_y = true });
    locks = plumb_body_locks(w, b);
    assert_true(locks.x && locks.y && !locks.rotation);
    assert_false(plumb_body_locks(w, f->stale).x);
}

// Locked in everything, a body is a wall: what hits it comes back, and it does not stir.
static void a_body_locked_altogether_is_immovable(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    (void)w;
    for (int s = 0; s < 3; ++s) {
        plumb_world *own = NULL;
        plumb_world_create(&(plumb_world_desc){ .zero_gravity = true, .solver = solvers[s] }, &own);
        plumb_material m = plumb_material_create(
            own, &(plumb_material_desc){ .restitution = 1, .friction = R(0.3) });
        plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) }, .material = m };
        plumb_body wall = plumb_body_create(
            own, &(plumb_body_desc){ .lock_x = true, .lock_y = true, .fixed_rotation = true });
        plumb_shape_create(own, wall, &box);
        plumb_body ball = plumb_body_create(
            own, &(plumb_body_desc){ .position = { -3, 0 }, .velocity = { 5, 0 } });
        plumb_shape_create(own, ball, &box);
        for (int i = 0; i < 60; ++i) {
            assert_int_equal(plumb_world_step(own, STEP), PLUMB_OK);
        }
        assert_near(plumb_body_velocity(own, ball).x, -5, ROUNDED(1e-4));
        assert_vec_near(plumb_body_position(own, wall), 0, 0, 0);
        plumb_world_destroy(own);
    }
}

static void locks_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    REFUSED(E_STATE, "plumb_body_set_locks: body is static; it must be dynamic",
            plumb_body_set_locks(w, f->fixed, (plumb_axis_locks){ .x = true }));
    REFUSED(E_HANDLE, "plumb_body_set_locks: body is null; it must be a live body",
            plumb_body_set_locks(w, NONE, (plumb_axis_locks){ .x = true }));
    plumb_body_set_locks(w, f->dynamic, (plumb_axis_locks){ .x = true });
    REFUSED(E_STATE,
            "plumb_body_set_velocity: velocity is (1, 2); its x must be 0 for a body locked in x",
            plumb_body_set_velocity(w, f->dynamic, plumb_v2(1, 2)));
    REFUSED(
        E_RANGE, "plumb_body_create: velocity is (0, 2); its y must be 0 with lock_y",
        made(w, plumb_body_create(w, &(plumb_body_desc){ .lock_y = true, .velocity = { 0, 2 } })));
}

//---- damping, caps, time scale -------------------------------------------------------------------

static void settings_are_read_back(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body b[5];
    for (int i = 0; i < 5; ++i) {
        b[i] = plumb_body_create(w, &(plumb_body_desc){ .damping = R(i),
                                                        .angular_damping = 2,
                                                        .max_speed = 30,
                                                        .max_spin = 40,
                                                        .time_scale = R(0.5) });
    }
    plumb_body_set_drag(w, b[3], R(0.25));
    assert_near(plumb_body_drag(w, b[3]), 0.25, 0);
    assert_near(plumb_body_drag(w, b[2]), 0, 0);
    plumb_body_set_thrust(w, b[3], 7);
    plumb_body_set_exhaust(w, b[3], 8);
    plumb_body_set_fuel(w, b[3], 9);
    plumb_body_set_thrust_x(w, b[3], 1);
    plumb_body_set_thrust_y(w, b[3], -2);
    plumb_body_set_thrust_angle(w, b[3], 3);
    plumb_body_desc d;
    assert_int_equal(plumb_body_settings(w, b[3], &d), PLUMB_OK);
    assert_true(d.thrust == 7 && d.exhaust == 8 && d.fuel == 9 && d.drag == R(0.25));
    assert_true(d.thrust_x == 1 && d.thrust_y == -2 && d.thrust_angle == 3);
    assert_true(plumb_body_fuel(w, b[3]) == 9 && plumb_body_thrust(w, b[2]) == 0);
    assert_near(plumb_body_damping(w, b[3]), 3, 0);
    assert_near(plumb_body_angular_damping(w, b[3]), 2, 0);
    assert_near(plumb_body_max_speed(w, b[3]), 30, 0);
    assert_near(plumb_body_max_spin(w, b[3]), 40, 0);
    assert_near(plumb_body_time_scale(w, b[3]), 0.5, 0);
    plumb_body_destroy(w, b[1]); // the last record moves into the gap
    plumb_body_set_damping(w, b[0], 0, 0);
    plumb_body_set_speed_cap(w, b[0], 0, 0);
    plumb_body_set_time_scale(w, b[0], 1); // nothing is left: no record
    assert_near(plumb_body_damping(w, b[4]), 4, 0);
    assert_near(plumb_body_damping(w, b[2]), 2, 0);
    assert_near(plumb_body_damping(w, b[0]), 0, 0);
    assert_near(plumb_body_max_speed(w, b[0]), 0, 0);
    assert_near(plumb_body_time_scale(w, b[0]), 1, 0);
    assert_near(plumb_body_time_scale(w, f->dynamic), 1, 0);
    plumb_body_set_type(w, b[4], PLUMB_STATIC); // rows move
    plumb_body_set_enabled(w, b[2], false);
    assert_near(plumb_body_damping(w, b[4]), 4, 0);
    assert_near(plumb_body_damping(w, b[2]), 2, 0);
    assert_int_equal(f->errors, 0);
    assert_near(plumb_body_time_scale(w, f->stale), 0, 0);
    assert_near(plumb_body_damping(w, f->stale), 0, 0);
    steps(f, 5);
    assert_int_equal(f->errors, 2); // both of the stale handle
}

static bool is_scheduled(plumb_world *w, const char *name)
{
    plumb_pass_info rows[128];
    int count = plumb_world_schedule(w, rows, 128);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return rows[i].scheduled;
        }
    }
    fail_msg("no pass %s", name);
    return false;
}

static bool has_variant(plumb_world *w, const char *pass, const char *variant)
{
    plumb_pass_info rows[128];
    int count = plumb_world_schedule(w, rows, 128);
    for (int i = 0; i < count; ++i) {
        for (int k = 0; strcmp(rows[i].name, pass) == 0 && k < rows[i].variant_count; ++k) {
            if (strcmp(rows[i].variants[k], variant) == 0) {
                return true;
            }
        }
    }
    return false;
}

static void check_what_is_asked_for(plumb_world *w, bool asked)
{
    const char *const names[] = { "damping", "speed caps", "targets" };
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(is_scheduled(w, names[i]), asked);
    }
    assert_int_equal(has_variant(w, "motion", "own time"), asked);
    assert_int_equal(has_variant(w, "contacts", "locked axes"), asked);
    assert_int_equal(has_variant(w, "contacts", "adhesion"), asked);
}

static void only_what_is_asked_for_is_scheduled(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    check_what_is_asked_for(w, false);
    plumb_body_set_damping(w, f->dynamic, 1, 0);
    plumb_body_set_speed_cap(w, f->dynamic, 0, 1);
    plumb_body_set_time_scale(w, f->dynamic, 2);
    plumb_body_set_locks(w, f->dynamic, (plumb_axis_locks){ .x = true });
    plumb_body_set_target(w, f->kinematic, plumb_v2(0, 0), 0, 1);
    plumb_material_set(w, f->used, &(plumb_material_desc){ .adhesion = 1 });
    check_what_is_asked_for(w, true);
    plumb_body_destroy(w, f->dynamic);
    plumb_body_destroy(w, f->kinematic);
    check_what_is_asked_for(w, false);
}

static void kinematic_bodies_have_their_time(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_set_velocity(w, f->kinematic, plumb_v2(2, 0));
    plumb_body_set_angular_velocity(w, f->kinematic, 1);
    plumb_body_set_time_scale(w, f->kinematic, R(0.25));
    steps(f, 60);
    assert_vec_near(plumb_body_position(w, f->kinematic), 10.5, 0, ROUNDED(1e-4));
    assert_near(plumb_body_angle(w, f->kinematic), 0.25, ROUNDED(1e-4));
    plumb_body_set_target(w, f->kinematic, plumb_v2(20, 1), 0, STEP);
    steps(f, 1);
    assert_vec_near(plumb_body_position(w, f->kinematic), 20, 1, 0);
    plumb_body_set_time_scale(w, f->kinematic, 0); // waits until it has time again
    plumb_body_set_target(w, f->kinematic, plumb_v2(30, 1), 0, STEP);
    steps(f, 10);
    assert_vec_near(plumb_body_position(w, f->kinematic), 20, 1, 0);
    plumb_body_set_time_scale(w, f->kinematic, 1);
    steps(f, 1);
    assert_vec_near(plumb_body_position(w, f->kinematic), 30, 1, 0);
    plumb_body_set_target(w, f->kinematic, plumb_v2(34, 1), 0, 1);
    plumb_body_set_time_scale(w, f->kinematic, R(0.5));
    assert_near(plumb_body_velocity(w, f->kinematic).x, 8, ROUNDED(1e-4));
}

static void settings_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    REFUSED(E_HANDLE, "plumb_body_set_damping: body is null; it must be a live body",
            plumb_body_set_damping(w, NONE, 0, 0));
    REFUSED(E_RANGE, "plumb_body_set_damping: linear is -1; it must be at least 0",
            plumb_body_set_damping(w, f->dynamic, -1, 0));
    REFUSED(E_NOT_FINITE, "plumb_body_set_damping: angular is nan; it must be finite",
            plumb_body_set_damping(w, f->dynamic, 0, NAN_));
    REFUSED(E_RANGE, "plumb_body_set_speed_cap: max_speed is -2; it must be at least 0",
            plumb_body_set_speed_cap(w, f->dynamic, -2, 0));
    REFUSED(E_RANGE, "plumb_body_set_speed_cap: max_spin is -2; it must be at least 0",
            plumb_body_set_speed_cap(w, f->dynamic, 0, -2));
    REFUSED(E_HANDLE, "plumb_body_set_speed_cap: body is a shape; it must be a live body",
            plumb_body_set_speed_cap(w, (plumb_body){ f->box.entity }, 0, 0));
    REFUSED(E_RANGE, "plumb_body_set_time_scale: scale is 101; it must be 0 to 100",
            plumb_body_set_time_scale(w, f->dynamic, 101));
    REFUSED(E_RANGE, "plumb_body_set_time_scale: scale is -1; it must be 0 to 100",
            plumb_body_set_time_scale(w, f->dynamic, -1));
    REFUSED(E_HANDLE, "plumb_body_set_time_scale: body is null; it must be a live body",
            plumb_body_set_time_scale(w, NONE, 1));
    REFUSED(E_RANGE, "plumb_body_set_drag: drag is -1; it must be 0 to 1e+09",
            plumb_body_set_drag(w, f->dynamic, -1));
    REFUSED(E_NOT_FINITE, "plumb_body_set_drag: drag is nan; it must be finite",
            plumb_body_set_drag(w, f->dynamic, NAN_));
    REFUSED(E_HANDLE, "plumb_body_set_drag: body is null; it must be a live body",
            plumb_body_set_drag(w, NONE, 1));
    REFUSED(E_RANGE, "plumb_body_create: drag is 2e+09; it must be 0 to 1e+09",
            made(w, plumb_body_create(w, &(plumb_body_desc){ .drag = R(2e9) })));
    REFUSED(E_RANGE, "plumb_body_set_thrust: thrust is -1; it must be 0 to 1e+12",
            plumb_body_set_thrust(w, f->dynamic, -1));
    REFUSED(E_RANGE, "plumb_body_set_exhaust: exhaust is -1; it must be 0 to 1e+09",
            plumb_body_set_exhaust(w, f->dynamic, -1));
    REFUSED(E_NOT_FINITE, "plumb_body_set_fuel: fuel is nan; it must be finite",
            plumb_body_set_fuel(w, f->dynamic, NAN_));
    REFUSED(E_HANDLE, "plumb_body_set_thrust_angle: body is null; it must be a live body",
            plumb_body_set_thrust_angle(w, NONE, 1));
    REFUSED(E_RANGE, "plumb_body_create: damping is -1; it must be at least 0",
            made(w, plumb_body_create(w, &(plumb_body_desc){ .damping = -1 })));
    REFUSED(E_RANGE, "plumb_body_create: time_scale is 200; it must be 0 to 100",
            made(w, plumb_body_create(w, &(plumb_body_desc){ .time_scale = 200 })));
    REFUSED(E_NOT_FINITE, "plumb_body_create: max_spin is nan; it must be finite",
            made(w, plumb_body_create(w, &(plumb_body_desc){ .max_spin = NAN_ })));
}

//---- targets -------------------------------------------------------------------------------------

static void targets_are_given_up_for_other_orders(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body k = f->kinematic;
    plumb_body_set_target(w, k, plumb_v2(20, 0), 0, 1);
    assert_near(plumb_body_velocity(w, k).x, 10, ROUNDED(1e-5));
    plumb_body_set_target(w, k, plumb_v2(10, 6), 0, 1); // a new one
    steps(f, 30);
    assert_vec_near(plumb_body_position(w, k), 10, 3, ROUNDED(1e-3));
    plumb_body_set_velocity(w, k, plumb_v2(0, 0));
    assert_false(plumb_body_has_target(w, k));
    steps(f, 30);
    assert_vec_near(plumb_body_position(w, k), 10, 3, ROUNDED(1e-3));
    plumb_body_set_target(w, k, plumb_v2(20, 0), 0, 1);
    plumb_body_set_angular_velocity(w, k, 0);
    assert_false(plumb_body_has_target(w, k));
    plumb_body_set_target(w, k, plumb_v2(20, 0), 0, 1);
    plumb_body_teleport(w, k, plumb_v2(1, 9), 0);
    assert_false(plumb_body_has_target(w, k));
    plumb_body_set_target(w, k, plumb_v2(20, 0), 0, 1);
    plumb_body_set_type(w, k, PLUMB_DYNAMIC);
    assert_false(plumb_body_has_target(w, k));
    plumb_body_set_type(w, k, PLUMB_KINEMATIC);
    plumb_body_set_target(w, k, plumb_v2(20, 0), 0, 1);
    plumb_body_destroy(w, k);
    steps(f, 2);
    assert_int_equal(f->errors, 0);
}

static void a_disabled_body_waits_on_its_way(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body k = f->kinematic;
    plumb_body_set_target(w, k, plumb_v2(12, 0), 0, R(2.0 / 60));
    steps(f, 1);
    plumb_body_set_enabled(w, k, false);
    steps(f, 5);
    assert_vec_near(plumb_body_position(w, k), 11, 0, ROUNDED(1e-5));
    plumb_body_set_enabled(w, k, true);
    steps(f, 1);
    assert_vec_near(plumb_body_position(w, k), 12, 0, 0);
}

static void targets_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_vec2 zero = { 0, 0 };
    REFUSED(E_HANDLE, "plumb_body_set_target: body is null; it must be a live body",
            plumb_body_set_target(w, NONE, zero, 0, 1));
    REFUSED(E_STATE, "plumb_body_set_target: body is dynamic; it must be kinematic",
            plumb_body_set_target(w, f->dynamic, zero, 0, 1));
    REFUSED(E_STATE, "plumb_body_set_target: body is static; it must be kinematic",
            plumb_body_set_target(w, f->fixed, zero, 0, 1));
    REFUSED(E_RANGE, "plumb_body_set_target: dt is 0; it must be above 0",
            plumb_body_set_target(w, f->kinematic, zero, 0, 0));
    REFUSED(E_NOT_FINITE, "plumb_body_set_target: angle is nan; it must be finite",
            plumb_body_set_target(w, f->kinematic, zero, NAN_, 1));
    REFUSED(E_RANGE,
            "plumb_body_set_target: position is (2e+09, 0); each component must be -1e+09 to 1e+09",
            plumb_body_set_target(w, f->kinematic, plumb_v2(R(2e9), 0), 0, 1));
}

//---- given masses and the rest -------------------------------------------------------------------

static void inertia_and_centre_can_be_given(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    // A square of side 2 and density 1: 4 kg, 8/3 kg m^2.
    assert_int_equal(plumb_body_set_inertia(w, f->dynamic, 7), PLUMB_OK);
    assert_near(plumb_body_inertia(w, f->dynamic), 7, 0);
    assert_near(plumb_body_mass(w, f->dynamic), 4, ROUNDED(1e-6));
    plumb_body_reset_mass(w, f->dynamic);
    assert_near(plumb_body_inertia(w, f->dynamic), 8.0 / 3, ROUNDED(1e-5));
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(0, 0));
    plumb_body_set_angular_velocity(w, f->dynamic, 3);
    assert_int_equal(plumb_body_set_local_center(w, f->dynamic, plumb_v2(1, 0)), PLUMB_OK);
    assert_vec_near(plumb_body_local_center(w, f->dynamic), 1, 0, 0);
    assert_vec_near(plumb_body_center(w, f->dynamic), 1, 5, 0);
    assert_near(plumb_body_inertia(w, f->dynamic), 8.0 / 3 + 4, 1e-5); // I + m d^2
    assert_vec_near(plumb_body_velocity(w, f->dynamic), 0, 3, ROUNDED(1e-6));
    plumb_shape_create(w, f->dynamic, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    assert_vec_near(plumb_body_local_center(w, f->dynamic), 1, 0, 0); // stays where it was put
    plumb_body_set_mass(w, f->dynamic, 10);
    assert_vec_near(plumb_body_local_center(w, f->dynamic), 1, 0, 0);
    plumb_body_reset_mass(w, f->dynamic);
    assert_vec_near(plumb_body_local_center(w, f->dynamic), 0, 0, 0);
    REFUSED(E_RANGE, "plumb_body_set_inertia: inertia is 0; it must be 1e-36 to 1e+36",
            plumb_body_set_inertia(w, f->dynamic, 0));
    REFUSED(E_STATE, "plumb_body_set_inertia: body is kinematic; it must be dynamic",
            plumb_body_set_inertia(w, f->kinematic, 1));
    REFUSED(E_STATE, "plumb_body_set_local_center: body is static; it must be dynamic",
            plumb_body_set_local_center(w, f->fixed, plumb_v2(0, 0)));
    REFUSED(
        E_RANGE,
        "plumb_body_set_local_center: center is (2e+07, 0); each component must be -1e+07 to 1e+07",
        plumb_body_set_local_center(w, f->dynamic, plumb_v2(R(2e7), 0)));
}

static void forces_can_be_read_and_taken_back(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_apply_force(w, f->dynamic, plumb_v2(3, 0), plumb_v2(0, 7));
    assert_vec_near(plumb_body_force(w, f->dynamic), 3, 0, 0);
    assert_near(plumb_body_torque(w, f->dynamic), -6, ROUNDED(1e-6));
    assert_int_equal(plumb_body_clear_forces(w, f->dynamic), PLUMB_OK);
    assert_vec_near(plumb_body_force(w, f->dynamic), 0, 0, 0);
    assert_near(plumb_body_torque(w, f->dynamic), 0, 0);
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(3, 4));
    plumb_body_set_angular_velocity(w, f->dynamic, 3);
    assert_near(plumb_body_kinetic_energy(w, f->dynamic), 4 * 25 / 2.0 + 8.0 / 3 * 9 / 2,
                ROUNDED(1e-4));
    assert_near(plumb_body_kinetic_energy(w, f->kinematic), 0, 0);
    assert_vec_near(plumb_body_force(w, f->stale), 0, 0, 0);
    assert_near(plumb_body_torque(w, f->stale), 0, 0);
    REFUSED(E_HANDLE, "plumb_body_clear_forces: body is null; it must be a live body",
            plumb_body_clear_forces(w, NONE));
}

static void half_a_teleport(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_teleport(w, f->dynamic, plumb_v2(1, 2), R(0.7));
    plumb_rot q = plumb_body_transform(w, f->dynamic).q;
    assert_int_equal(plumb_body_set_position(w, f->dynamic, plumb_v2(5, 6)), PLUMB_OK);
    assert_true(plumb_body_transform(w, f->dynamic).q.c == q.c);
    assert_true(plumb_body_transform(w, f->dynamic).q.s == q.s);
    assert_vec_near(plumb_body_position(w, f->dynamic), 5, 6, 0);
    assert_int_equal(plumb_body_set_angle(w, f->dynamic, 1), PLUMB_OK);
    assert_near(plumb_body_angle(w, f->dynamic), 1, ROUNDED(1e-6));
    assert_vec_near(plumb_body_position(w, f->dynamic), 5, 6, 0);
    REFUSED(E_RANGE,
            "plumb_body_set_position: position is (0, 3e+09); each component must be -1e+09 to "
            "1e+09",
            plumb_body_set_position(w, f->dynamic, plumb_v2(0, R(3e9))));
    REFUSED(E_HANDLE, "plumb_body_set_position: body is null; it must be a live body",
            plumb_body_set_position(w, NONE, plumb_v2(0, 0)));
    REFUSED(E_NOT_FINITE, "plumb_body_set_angle: angle is nan; it must be finite",
            plumb_body_set_angle(w, f->dynamic, NAN_));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(locks_are_kept_and_told),
        API_TEST(a_body_locked_altogether_is_immovable),
        API_TEST(locks_are_refused),
        API_TEST(settings_are_read_back),
        API_TEST(only_what_is_asked_for_is_scheduled),
        API_TEST(kinematic_bodies_have_their_time),
        API_TEST(settings_are_refused),
        API_TEST(targets_are_given_up_for_other_orders),
        API_TEST(a_disabled_body_waits_on_its_way),
        API_TEST(targets_are_refused),
        API_TEST(inertia_and_centre_can_be_given),
        API_TEST(forces_can_be_read_and_taken_back),
        API_TEST(half_a_teleport),
    };
    return cmocka_run_group_tests_name("motion", tests, NULL, NULL);
}
