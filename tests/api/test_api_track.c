// test_api_track.c - kinematic bodies that are to arrive with a velocity: where they go, what ends it, what is refused.
#include "world_fixture.h"

#include "harness/random.h"

#define NONE ((plumb_body)PLUMB_NULL_INIT)
#define STEP R(1.0 / 60)

static void steps(fixture *f, int count)
{
    for (int i = 0; i < count; ++i) {
        assert_int_equal(plumb_world_step(f->world, STEP), PLUMB_OK);
    }
}

// From (10, 0), at rest, to (13, 4) and half a turn, at (2, -1) m/s and 1 rad/s.
static void send(fixture *f, plumb_real dt)
{
    assert_int_equal(plumb_body_set_target_moving(f->world, f->kinematic, plumb_v2(13, 4), R(0.5),
                                                  plumb_v2(2, -1), 1, dt),
                     PLUMB_OK);
    assert_true(plumb_body_has_target(f->world, f->kinematic));
}

// `rest` [s] ago: since then it has gone on.
static void check_arrived(fixture *f, double rest)
{
    const plumb_world *w = f->world;
    const plumb_rot turn = plumb_rot_make(R(0.5 + rest)),
                    is = plumb_body_transform(w, f->kinematic).q;
    assert_false(plumb_body_has_target(w, f->kinematic));
    assert_vec_near(plumb_body_position(w, f->kinematic), 13 + 2 * rest, 4 - rest,
                    rest > 0 ? ROUNDED(2e-6) : 0);
    assert_near(is.c, turn.c, rest > 0 ? ROUNDED(1e-6) : 0);
    assert_near(is.s, turn.s, rest > 0 ? ROUNDED(1e-6) : 0);
    assert_vec_near(plumb_body_velocity(w, f->kinematic), 2, -1, 0);
    assert_near(plumb_body_angular_velocity(w, f->kinematic), 1, 0);
}

// Whether the time is a whole number of steps or not, less than one or many; and it goes on.
static void pose_and_velocity_are_met(void **state)
{
    fixture *f = *state;
    const struct {
        double dt;
        int steps;
    } cases[] = { { 1.0 / 60, 1 }, { 0.004, 1 },  { 0.5, 30 },
                  { 0.51, 31 },    { 0.0251, 2 }, { 2, 120 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        plumb_body_teleport(f->world, f->kinematic, plumb_v2(10, 0), 0);
        plumb_body_set_velocity(f->world, f->kinematic, plumb_v2(0, i % 2 == 0 ? 0 : 3));
        plumb_body_set_angular_velocity(f->world, f->kinematic, 0);
        send(f, (plumb_real)cases[i].dt);
        steps(f, cases[i].steps - 1);
        assert_true(plumb_body_has_target(f->world, f->kinematic));
        steps(f, 1);
        const double rest = cases[i].dt < 1.0 / 60 ? 0 : cases[i].steps / 60.0 - cases[i].dt;
        check_arrived(f, fabs(rest) < 1e-9 ? 0 : rest);
        steps(f, 60);
        assert_vec_near(plumb_body_position(f->world, f->kinematic), 15 + 2 * rest, 3 - rest,
                        ROUNDED(1e-4));
    }
}

// Keyframes at times that are no multiples of the step, at one speed: each step goes as far as it says.
static void keyframes_follow_without_a_jerk(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    uint32_t random = 7;
    double key = 0, x = 10, now = 0;
    plumb_body_teleport(w, f->kinematic, plumb_v2(10, 0), 0);
    plumb_body_set_velocity(w, f->kinematic, plumb_v2(2, 0));
    plumb_body_set_angular_velocity(w, f->kinematic, 0);
    for (int i = 0; i < 300; ++i) {
        if (now >= key) {
            key += sim_uniform(&random, 0.05, 0.4);
            plumb_body_set_target_moving(w, f->kinematic, plumb_v2((plumb_real)(10 + 2 * key), 0),
                                         0, plumb_v2(2, 0), 0, (plumb_real)(key - now));
        }
        steps(f, 1);
        now += 1.0 / 60;
        const double before = x;
        x = (double)plumb_body_position(w, f->kinematic).x;
        assert_near(x - before, 2.0 / 60, ROUNDED(1e-4));
        assert_near(x, 10 + 2 * now, ROUNDED(1e-4));
    }
}

// It turns as often as its angular velocities would have it: 10 rad/s for 2 s are three turns and more.
static void turns_are_counted(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_set_angular_velocity(w, f->kinematic, 10);
    plumb_body_set_target_moving(w, f->kinematic, plumb_v2(10, 0), 20, plumb_v2(0, 0), 10, 2);
    for (int i = 0; i < 120; ++i) {
        steps(f, 1);
        assert_near(plumb_body_angular_velocity(w, f->kinematic), 10, ROUNDED(1e-4));
    }
    assert_false(plumb_body_has_target(w, f->kinematic));
}

static void a_new_order_takes_its_place(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body k = f->kinematic;
    send(f, 1);
    plumb_body_set_velocity(w, k, plumb_v2(0, 0));
    assert_false(plumb_body_has_target(w, k));
    send(f, 1);
    plumb_body_teleport(w, k, plumb_v2(1, 9), 0);
    assert_false(plumb_body_has_target(w, k));
    send(f, 1);
    plumb_body_set_type(w, k, PLUMB_STATIC);
    assert_false(plumb_body_has_target(w, k));
    plumb_body_set_type(w, k, PLUMB_KINEMATIC);
    send(f, 1);
    plumb_body_set_target(w, k, plumb_v2(5, 5), 0, R(0.5));
    steps(f, 30);
    assert_vec_near(plumb_body_position(w, k), 5, 5, 0);
    assert_vec_near(plumb_body_velocity(w, k), 0, 0, 0);
    plumb_body_set_target(w, k, plumb_v2(9, 9), 0, 1);
    send(f, R(0.5));
    steps(f, 30);
    check_arrived(f, 0);
    send(f, 1);
    plumb_body_destroy(w, k);
    steps(f, 2);
    assert_int_equal(f->errors, 0);
}

static void who_waits_goes_on(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    send(f, R(0.5));
    steps(f, 10);
    const plumb_vec2 at = plumb_body_position(w, f->kinematic);
    plumb_body_set_enabled(w, f->kinematic, false);
    steps(f, 5);
    plumb_body_set_enabled(w, f->kinematic, true);
    plumb_body_set_time_scale(w, f->kinematic, 0);
    steps(f, 5);
    assert_vec_near(plumb_body_position(w, f->kinematic), (double)at.x, (double)at.y, 0);
    plumb_body_set_time_scale(w, f->kinematic, R(0.5)); // the time of arrival is the world's
    steps(f, 19);
    assert_true(plumb_body_has_target(w, f->kinematic));
    steps(f, 1);
    assert_vec_near(plumb_body_position(w, f->kinematic), 13, 4, 0);
    assert_vec_near(plumb_body_velocity(w, f->kinematic), 4, -2, 0); // in its own time
}

// A target from rest has no velocity yet as the step begins; what sleeps on the lift wakes all the same.
static void sleepers_wake(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body box = plumb_body_create(w, &(plumb_body_desc){ .position = { 10, R(1.5) } });
    plumb_shape_create(w, box,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
    steps(f, 240);
    assert_false(plumb_body_is_awake(w, box));
    plumb_body_set_target_moving(w, f->kinematic, plumb_v2(10, 3), 0, plumb_v2(0, 0), 0, 2);
    steps(f, 1);
    assert_true(plumb_body_is_awake(w, box));
    steps(f, 119);
    assert_vec_near(plumb_body_position(w, box), 10, 4.5, 0.01);
}

static void it_is_saved_on_its_way(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world, *other;
    static char image[1 << 18];
    send(f, R(0.4));
    steps(f, 7);
    const size_t size = plumb_world_snapshot_size(w);
    assert_true(size <= sizeof image);
    assert_int_equal(plumb_world_save(w, image, size), PLUMB_OK);
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ 0 }, &other), PLUMB_OK);
    plumb_component_create(other,
                           &(plumb_component_desc){ .name = "health", .size = sizeof(float) });
    assert_int_equal(plumb_world_restore(other, image, size), PLUMB_OK);
    assert_true(plumb_world_hash(w) == plumb_world_hash(other));
    for (int i = 0; i < 17; ++i) {
        steps(f, 1);
        plumb_world_step(other, STEP);
        assert_true(plumb_world_hash(w) == plumb_world_hash(other));
    }
    check_arrived(&(fixture){ .world = other, .kinematic = f->kinematic }, 0);
    plumb_world_destroy(other);
}

static void what_is_wrong_is_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_vec2 zero = { 0, 0 };
#define SEND(body, position, angle, velocity, w_end, dt)                                           \
    plumb_body_set_target_moving(w, body, position, angle, velocity, w_end, dt)
    REFUSED(E_HANDLE, "plumb_body_set_target_moving: body is null; it must be a live body",
            SEND(NONE, zero, 0, zero, 0, 1));
    REFUSED(E_STATE, "plumb_body_set_target_moving: body is dynamic; it must be kinematic",
            SEND(f->dynamic, zero, 0, zero, 0, 1));
    REFUSED(E_STATE, "plumb_body_set_target_moving: body is static; it must be kinematic",
            SEND(f->fixed, zero, 0, zero, 0, 1));
    REFUSED(E_RANGE, "plumb_body_set_target_moving: dt is -1; it must be above 0",
            SEND(f->kinematic, zero, 0, zero, 0, -1));
    REFUSED(E_NOT_FINITE, "plumb_body_set_target_moving: dt is inf; it must be finite",
            SEND(f->kinematic, zero, 0, zero, 0, R(INFINITY)));
    REFUSED(E_NOT_FINITE, "plumb_body_set_target_moving: angle is nan; it must be finite",
            SEND(f->kinematic, zero, R(NAN), zero, 0, 1));
    REFUSED(E_NOT_FINITE,
            "plumb_body_set_target_moving: angular_velocity is nan; it must be finite",
            SEND(f->kinematic, zero, 0, zero, R(NAN), 1));
    REFUSED(E_RANGE,
            "plumb_body_set_target_moving: position is (2e+09, 0); each component must be -1e+09 "
            "to 1e+09",
            SEND(f->kinematic, plumb_v2(R(2e9), 0), 0, zero, 0, 1));
    assert_int_equal(SEND(f->kinematic, zero, 0, plumb_v2(R(NAN), 0), 0, 1), PLUMB_E_NOT_FINITE);
    assert_int_equal(SEND(f->kinematic, zero, 0, plumb_v2(R(1e13), 0), 0, 1), PLUMB_E_RANGE);
    REFUSED(E_RANGE,
            "plumb_body_set_target_moving: dt is 1e-20; on its way the body would be faster than "
            "1e+12 m/s "
            "or rad/s",
            SEND(f->kinematic, zero, 0, zero, 0, R(1e-20)));
    assert_false(plumb_body_has_target(w, f->kinematic));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(pose_and_velocity_are_met), API_TEST(keyframes_follow_without_a_jerk),
        API_TEST(turns_are_counted),         API_TEST(a_new_order_takes_its_place),
        API_TEST(who_waits_goes_on),         API_TEST(sleepers_wake),
        API_TEST(it_is_saved_on_its_way),    API_TEST(what_is_wrong_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
