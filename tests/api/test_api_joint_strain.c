// test_api_joint_strain.c - strain events: told when the reaction rises above its bound, once until it was below,
// for every solver and however the joint is solved; refusals.
#include "world_fixture.h"

#define DT R(1.0 / 60)

enum { HOOKS = 5 };

// Weights of 1 kg that hang from the world, each on a joint of its own.
typedef struct rack {
    plumb_world *w;
    plumb_body weights[HOOKS];
    plumb_joint hooks[HOOKS];
} rack;

static rack make_rack(plumb_world_desc desc, plumb_joint_desc joint)
{
    rack r = { .w = NULL };
    assert_int_equal(plumb_world_create(&desc, &r.w), PLUMB_OK);
    for (int i = 0; i < HOOKS; ++i) {
        const plumb_vec2 at = plumb_v2(R(3 * i), 0);
        r.weights[i] = plumb_body_create(r.w, &(plumb_body_desc){ .position = at });
        plumb_shape_create(r.w, r.weights[i],
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
        joint.body_b = r.weights[i];
        joint.anchor = at;
        if (joint.kind == PLUMB_DISTANCE) {
            joint.anchor_b = at;
            joint.anchor = plumb_v2(at.x, 2);
        }
        r.hooks[i] = plumb_joint_create(r.w, &joint);
        assert_true(plumb_joint_valid(r.w, r.hooks[i]));
    }
    return r;
}

// Pulls some weights down by `force` [N] for so many steps; returns how many events were told in all.
static int pull(rack *r, unsigned which, double force, int steps)
{
    int told = 0;
    for (int i = 0; i < steps; ++i) {
        for (int k = 0; k < HOOKS; ++k) {
            if ((which >> k & 1u) != 0) {
                plumb_body_apply_force_center(r->w, r->weights[k], plumb_v2(0, R(-force)));
            }
        }
        assert_int_equal(plumb_world_step(r->w, DT), PLUMB_OK);
        int count;
        const plumb_joint_strain *e = plumb_world_joint_strain_events(r->w, &count);
        for (int k = 0; k < count; ++k) {
            assert_true(plumb_joint_valid(r->w, e[k].joint));
            assert_near(e[k].force.y, 9.81 + force, 0.5);
            assert_true(k == 0 || e[k].joint.entity.index > e[k - 1].joint.entity.index);
        }
        told += count;
    }
    return told;
}

static void crossings_are_told_once(void **state)
{
    (void)state;
    const plumb_joint_kind kinds[] = { PLUMB_REVOLUTE, PLUMB_WELD, PLUMB_DISTANCE, PLUMB_MOTOR };
    for (int i = 0; i < 16; ++i) {
        const plumb_world_desc world = { .solver =
                                             i % 2 == 0 ? PLUMB_SOLVER_SOFT : PLUMB_SOLVER_PGS,
                                         .iterations = 30,
                                         .no_sleep = true };
        // One that breaks by impulse is solved by itself.
        rack r =
            make_rack(world, (plumb_joint_desc){ .kind = kinds[i / 4],
                                                 .event_force = 20,
                                                 .break_impulse = i / 2 % 2 == 0 ? 0 : R(1e6) });
        assert_int_equal(pull(&r, 0, 0, 30), 0);
        assert_int_equal(pull(&r, 0x0b, 15, 30), 3); // three of them, once, while it lasts
        assert_int_equal(pull(&r, 0x1b, 15, 30), 1); // one more
        assert_int_equal(pull(&r, 0, 0, 30), 0);
        assert_int_equal(pull(&r, 0x1f, 15, 30), 5); // all, again
        assert_int_equal(pull(&r, 0x1f, 8, 1), 0);   // below for a moment is below
        pull(&r, 0x1f, 5, 5);
        assert_int_equal(pull(&r, 0x02, 15, 5), 1);
        assert_true(plumb_joint_valid(r.w, r.hooks[0])); // nothing has broken
        plumb_world_destroy(r.w);
    }
}

static void torques_count_too(void **state)
{
    (void)state;
    rack r =
        make_rack((plumb_world_desc){ .no_sleep = true }, (plumb_joint_desc){ .kind = PLUMB_WELD });
    int told = 0, count;
    assert_int_equal(plumb_joint_set_event(r.w, r.hooks[2], 0, 3), PLUMB_OK);
    for (int i = 0; i < 40; ++i) {
        plumb_body_apply_torque(r.w, r.weights[2], i < 20 ? 2 : 5);
        plumb_world_step(r.w, DT);
        const plumb_joint_strain *e = plumb_world_joint_strain_events(r.w, &count);
        if (count > 0) {
            assert_int_equal(i, 20);
            assert_near(plumb_abs(e->torque), 5, 0.2);
            assert_true(plumb_same(e->joint, r.hooks[2]));
            assert_true(plumb_same(e->body_b, r.weights[2]));
            assert_int_equal(e->kind, PLUMB_WELD);
            assert_vec_near(e->point, 6, 0, 1e-3);
        }
        told += count;
    }
    assert_int_equal(told, 1);
    plumb_world_destroy(r.w);
}

static void what_breaks_tells_that_instead(void **state)
{
    (void)state;
    rack r = make_rack(
        (plumb_world_desc){ .no_sleep = true },
        (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .event_force = 20, .break_force = 40 });
    int breaks;
    pull(&r, 0, 0, 5);
    for (int k = 0; k < HOOKS; k += 2) { // some break, some strain, in one step
        plumb_body_apply_force_center(r.w, r.weights[k], plumb_v2(0, -60));
    }
    assert_int_equal(pull(&r, 0x0a, 15, 1), 2);
    plumb_world_joint_break_events(r.w, &breaks);
    assert_int_equal(breaks, 3);
    assert_false(plumb_joint_valid(r.w, r.hooks[0]));
    plumb_world_destroy(r.w);
}

// What was told is part of the state: it is not told anew by a world that was restored in between.
static void a_restored_world_remembers(void **state)
{
    (void)state;
    static char image[200000];
    rack r = make_rack((plumb_world_desc){ .no_sleep = true },
                       (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .event_force = 20 });
    pull(&r, 0, 0, 5);
    const uint64_t calm = plumb_world_hash(r.w);
    assert_int_equal(pull(&r, 0x1f, 15, 10), 5);
    assert_true(plumb_world_hash(r.w) != calm);
    assert_in_range(plumb_world_snapshot_size(r.w), 1, sizeof image);
    plumb_world_save(r.w, image, sizeof image);
    assert_int_equal(pull(&r, 0, 0, 10), 0);
    assert_int_equal(plumb_world_restore(r.w, image, sizeof image), PLUMB_OK);
    int count = 7;
    assert_null(plumb_world_joint_strain_events(r.w, &count));
    assert_int_equal(count, 0);
    assert_int_equal(pull(&r, 0x1f, 15, 10), 0);
    // Switched off, it bears nothing.
    assert_int_equal(plumb_joint_set_enabled(r.w, r.hooks[0], false), PLUMB_OK);
    plumb_world_step(r.w, DT);
    plumb_world_step(r.w, 0); // a refresh has no events of its own
    assert_null(plumb_world_joint_strain_events(r.w, NULL));
    plumb_world_destroy(r.w);
}

static void bounds_are_checked(void **state)
{
    fixture *f = *state;
    plumb_joint_desc d = { .kind = PLUMB_WELD, .body_b = f->dynamic, .event_force = 3 };
    const plumb_joint j = plumb_joint_create(f->world, &d);
    assert_int_equal(plumb_joint_set_event(f->world, j, 4, 5), PLUMB_OK);
    assert_int_equal(plumb_joint_settings(f->world, j, &d), PLUMB_OK);
    assert_true(d.event_force == 4 && d.event_torque == 5);
    REFUSED(E_RANGE, "plumb_joint_set_event: force is -1; it must be at least 0",
            plumb_joint_set_event(f->world, j, -1, 0));
    REFUSED(E_RANGE, "plumb_joint_set_event: torque is -1; it must be at least 0",
            plumb_joint_set_event(f->world, j, 0, -1));
    REFUSED(E_NOT_FINITE, "plumb_joint_set_event: torque is nan; it must be finite",
            plumb_joint_set_event(f->world, j, 0, R(NAN)));
    REFUSED(E_HANDLE, "plumb_joint_set_event: joint is null; it must be a live joint",
            plumb_joint_set_event(f->world, (plumb_joint){ 0 }, 1, 1));
    d.event_torque = -2;
    assert_true(plumb_is_null(plumb_joint_create(f->world, &d)));
    assert_int_equal(plumb_world_error(f->world).code, PLUMB_E_RANGE);
    assert_int_equal(plumb_joint_set_event(NULL, j, 1, 1), PLUMB_E_NULL);
    assert_null(plumb_world_joint_strain_events(NULL, NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crossings_are_told_once),
        cmocka_unit_test(torques_count_too),
        cmocka_unit_test(what_breaks_tells_that_instead),
        cmocka_unit_test(a_restored_world_remembers),
        API_TEST(bounds_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
