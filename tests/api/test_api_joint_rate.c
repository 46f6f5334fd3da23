// test_api_joint_rate.c - rates of joints: of each kind, what the value does in a short while; refusals.
#include "harness/random.h"
#include "world_fixture.h"

static const char *const names[] = {
#define NAME_ROW(NAME, name, text) #name,
    PLUMB_JOINT_LIST(NAME_ROW)
#undef NAME_ROW
};

enum { KINDS = sizeof names / sizeof names[0] };

static plumb_body add_body(plumb_world *w, uint32_t *seed, plumb_real time_scale)
{
    const plumb_body_desc desc = {
        .position = { R(sim_uniform(seed, -3, 3)), R(sim_uniform(seed, -3, 3)) },
        .angle = R(sim_uniform(seed, -3, 3)),
        .velocity = { R(sim_uniform(seed, -2, 2)), R(sim_uniform(seed, -2, 2)) },
        .angular_velocity = R(sim_uniform(seed, -2, 2)),
        .time_scale = time_scale,
    };
    const plumb_body body = plumb_body_create(w, &desc);
    plumb_shape_create(w, body,
                       &(plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                            .radius = R(0.1),
                                            .center = { R(sim_uniform(seed, -1, 1)), 0 },
                                            .filter = { .nothing = true } });
    return body;
}

static plumb_joint_desc random_joint(int kind, uint32_t *seed)
{
    plumb_joint_desc d = { .kind = (plumb_joint_kind)kind, .disabled = true };
    d.anchor = plumb_v2(R(sim_uniform(seed, -4, 4)), R(sim_uniform(seed, -4, 4)));
    const plumb_vec2 far = { R(sim_uniform(seed, -4, 4)), R(sim_uniform(seed, -4, 4)) };
    if (kind == PLUMB_DISTANCE || kind == PLUMB_PULLEY || kind == PLUMB_CABLE) {
        d.anchor_b = far;
    }
    if (kind == PLUMB_PULLEY) {
        d.ground_a = plumb_v2(-2, 9);
        d.ground_b = plumb_v2(2, 9);
    }
    if (kind == PLUMB_CABLE) { // above what A's may be
        d.anchor_b.y += 9;
        d.radius_a = R(0.5);
        d.radius_b = R(-0.25);
    }
    d.pitch = kind == PLUMB_RATCHET ? 1 : 0;
    d.ratio = kind == PLUMB_GEAR ? R(-2) : kind == PLUMB_PULLEY ? R(1.5) : 0;
    if (kind == PLUMB_PRISMATIC || kind == PLUMB_WHEEL || kind == PLUMB_GEAR) {
        d.axis = plumb_v2(R(sim_uniform(seed, -1, 1)), R(sim_uniform(seed, 0.2, 1)));
    }
    return d;
}

// Joints that are off let their bodies fly freely: the value changes by the rate.
static void rates_are_those_of_the_values(void **state)
{
    (void)state;
    const plumb_real dt = R(1.0 / 512);
    uint32_t seed = 20;
    double seen[KINDS] = { 0 };
    for (int round = 0; round < 40 * KINDS; ++round) {
        const int kind = round % KINDS;
        plumb_world *w;
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &w),
                         PLUMB_OK);
        plumb_joint_desc d = random_joint(kind, &seed);
        d.body_a = round % 3 == 0 && kind != PLUMB_GEAR ? d.body_a : add_body(w, &seed, R(0.5));
        d.body_b = add_body(w, &seed, 0);
        const plumb_joint j = plumb_joint_create(w, &d);
        assert_true(plumb_joint_valid(w, j));
        if (kind == PLUMB_MOUSE) { // else its length is 0
            plumb_joint_set_target(w, j, plumb_v2(5, 5));
        }
        for (int i = 0; i < 10; ++i) {
            const double before = (double)plumb_joint_value(w, j);
            const double rate = (double)plumb_joint_rate(w, j);
            assert_int_equal(plumb_world_step(w, dt), PLUMB_OK);
            const double change = (double)plumb_joint_value(w, j) - before;
            const double mean = (rate + (double)plumb_joint_rate(w, j)) / 2;
            if (fabs(change - mean * (double)dt) > 3e-5) {
                fail_msg("%s: %g in a step, %g told", names[kind], change, mean * (double)dt);
            }
            seen[kind] = fabs(rate) > seen[kind] ? fabs(rate) : seen[kind];
        }
        plumb_world_destroy(w);
    }
    for (int kind = 0; kind < KINDS; ++kind) {
        assert_true(seen[kind] > 0.5);
    }
}

static plumb_joint make(fixture *f, plumb_joint_kind kind)
{
    const bool two = kind == PLUMB_DISTANCE || kind == PLUMB_PULLEY || kind == PLUMB_CABLE;
    const plumb_real high = kind == PLUMB_PULLEY ? 8 : 0;
    const plumb_joint_desc d = { .kind = kind,
                                 .body_a = f->kinematic,
                                 .body_b = f->dynamic,
                                 .anchor = { 10, 0 },
                                 .anchor_b = { two ? R(10) : 0, two ? R(5) : 0 },
                                 .ground_a = { 0, high },
                                 .ground_b = { 0, high },
                                 .axis = { 0, kind == PLUMB_WHEEL ? R(1) : 0 },
                                 .pitch = kind == PLUMB_RATCHET ? R(1) : 0 };
    const plumb_joint j = plumb_joint_create(f->world, &d);
    assert_true(plumb_joint_valid(f->world, j));
    return j;
}

static void turns_and_travels_are_told_apart(void **state)
{
    fixture *f = *state;
    const plumb_joint wheel = make(f, PLUMB_WHEEL);
    plumb_body_set_velocity(f->world, f->dynamic, plumb_v2(0, 3));
    plumb_body_set_angular_velocity(f->world, f->dynamic, 7);
    plumb_body_set_angular_velocity(f->world, f->kinematic, 2);
    assert_near(plumb_joint_turn_rate(f->world, wheel), 5, ROUNDED(1e-6));
    // Up with B's anchor, 10 m to the right of B's centre; A's own turn carries no point on its axis.
    assert_near(plumb_joint_travel_rate(f->world, wheel), 3 + 7 * 10, ROUNDED(1e-4));
    assert_near(plumb_joint_rate(f->world, wheel), 3 + 7 * 10, ROUNDED(1e-4));
    for (int kind = 0; kind < KINDS; ++kind) {
        const bool turns = kind == PLUMB_REVOLUTE || kind == PLUMB_WELD || kind == PLUMB_WHEEL ||
                           kind == PLUMB_MOTOR || kind == PLUMB_FRICTION || kind == PLUMB_RATCHET;
        const bool travels = kind == PLUMB_PRISMATIC || kind == PLUMB_WHEEL ||
                             kind == PLUMB_DISTANCE || kind == PLUMB_MOUSE || kind == PLUMB_CABLE;
        const plumb_joint j = make(f, (plumb_joint_kind)kind);
        const int errors = f->errors;
        const plumb_real turn = plumb_joint_turn_rate(f->world, j);
        assert_near(turn, turns ? 5 : 0, ROUNDED(1e-6));
        assert_int_equal(f->errors, errors + !turns);
        plumb_joint_travel_rate(f->world, j);
        assert_int_equal(f->errors, errors + !turns + !travels);
    }
}

static plumb_result refused(const plumb_world *w, plumb_real rate)
{
    assert_true(rate == 0);
    return plumb_world_error(w).code;
}

static void rates_refuse(void **state)
{
    fixture *f = *state;
    const plumb_joint gear = make(f, PLUMB_GEAR), slider = make(f, PLUMB_PRISMATIC);
    const plumb_joint none = PLUMB_NULL_INIT;
    plumb_joint stale = make(f, PLUMB_WELD);
    plumb_joint_destroy(f->world, stale);
    REFUSED(E_STATE,
            "plumb_joint_travel_rate: joint is a gear joint; it must be of a kind that travels",
            refused(f->world, plumb_joint_travel_rate(f->world, gear)));
    REFUSED(E_STATE,
            "plumb_joint_turn_rate: joint is a prismatic joint; it must be of a kind that turns",
            refused(f->world, plumb_joint_turn_rate(f->world, slider)));
    REFUSED(E_HANDLE, "plumb_joint_turn_rate: joint is null; it must be a live joint",
            refused(f->world, plumb_joint_turn_rate(f->world, none)));
    assert_true(plumb_joint_travel_rate(f->world, stale) == 0);
    assert_int_equal(plumb_world_error(f->world).code, PLUMB_E_HANDLE);
    assert_true(plumb_joint_rate(f->world, stale) == 0);
    assert_true(plumb_joint_rate(NULL, gear) == 0);
    assert_true(plumb_joint_turn_rate(NULL, gear) == 0);
    assert_true(plumb_joint_travel_rate(NULL, slider) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rates_are_those_of_the_values),
        API_TEST(turns_and_travels_are_told_apart),
        API_TEST(rates_refuse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
