// test_api_wake.c - what wakes a sleeping body, and what does not: one row for each kind of change,
// with the bodies that are awake after the next step.
#include "sleep_fixture.h"

typedef struct waker {
    const char *name;
    plumb_result (*change)(place *p);
    unsigned wakes; // bits of `people`
} waker;

enum { LOW = 1, HIGH = 2, APART = 4, ON_LEDGE = 8, HUNG = 16, STACK = 3, ALL = 31 };

static const plumb_vec2 up = { 0, 1 }, none = { 0, 0 };

#define CHANGE(name, call)                                                                         \
    static plumb_result name(place *p)                                                             \
    {                                                                                              \
        return call;                                                                               \
    }

CHANGE(wake, plumb_body_wake(p->w, p->high))
CHANGE(teleport, plumb_body_teleport(p->w, p->apart, plumb_v2(5, 3), 0))
CHANGE(same_place, plumb_body_teleport(p->w, p->apart, plumb_body_position(p->w, p->apart),
                                       plumb_body_angle(p->w, p->apart)))
CHANGE(velocity, plumb_body_set_velocity(p->w, p->low, up))
CHANGE(same_velocity, plumb_body_set_velocity(p->w, p->low, none))
CHANGE(spin, plumb_body_set_angular_velocity(p->w, p->low, 1))
CHANGE(same_spin, plumb_body_set_angular_velocity(p->w, p->low, 0))
CHANGE(force, plumb_body_apply_force_center(p->w, p->low, up))
CHANGE(no_force, plumb_body_apply_force_center(p->w, p->low, none))
CHANGE(force_at, plumb_body_apply_force(p->w, p->low, up, none))
CHANGE(torque, plumb_body_apply_torque(p->w, p->low, 1))
CHANGE(impulse, plumb_body_apply_impulse(p->w, p->apart, up, none))
CHANGE(no_impulse, plumb_body_apply_impulse_center(p->w, p->apart, none))
CHANGE(turn, plumb_body_apply_angular_impulse(p->w, p->apart, 1))
CHANGE(mass, plumb_body_set_mass(p->w, p->apart, 3))
CHANGE(same_mass, plumb_body_reset_mass(p->w, p->apart))
CHANGE(inertia, plumb_body_set_inertia(p->w, p->apart, 3))
CHANGE(damping, plumb_body_set_damping(p->w, p->apart, 1, 0))
CHANGE(same_damping, plumb_body_set_damping(p->w, p->apart, 0, 0))
CHANGE(cap, plumb_body_set_speed_cap(p->w, p->apart, 1, 0))
CHANGE(same_cap, plumb_body_set_speed_cap(p->w, p->apart, 0, 0))
CHANGE(time_scale, plumb_body_set_time_scale(p->w, p->apart, 2))
CHANGE(same_time_scale, plumb_body_set_time_scale(p->w, p->apart, 1))
CHANGE(locks, plumb_body_set_locks(p->w, p->apart, (plumb_axis_locks){ .x = true }))
CHANGE(same_locks, plumb_body_set_locks(p->w, p->apart, (plumb_axis_locks){ .x = false }))
CHANGE(fix, plumb_body_set_fixed_rotation(p->w, p->apart, true))
CHANGE(not_fix, plumb_body_set_fixed_rotation(p->w, p->apart, false))
CHANGE(scale, plumb_body_set_gravity_scale(p->w, p->apart, 2))
CHANGE(same_scale, plumb_body_set_gravity_scale(p->w, p->apart, 1))
CHANGE(no_sleep, plumb_body_set_no_sleep(p->w, p->apart, true))
CHANGE(tag, plumb_body_set_user_data(p->w, p->apart, p))
CHANGE(gravity, plumb_world_set_gravity(p->w, plumb_v2(0, 9)))
CHANGE(same_gravity, plumb_world_set_gravity(p->w, plumb_world_gravity(p->w)))
CHANGE(tuning, plumb_world_set_contact_tuning(p->w, 12, 0, 0))
CHANGE(same_tuning, plumb_world_set_contact_tuning(p->w, 0, 0, 0))
CHANGE(remove_shape, plumb_shape_destroy(p->w, p->low_box))
CHANGE(shape_material, plumb_shape_set_material(p->w, p->low_box, (plumb_material)PLUMB_NULL_INIT))
CHANGE(same_material, plumb_shape_set_material(p->w, p->low_box, p->wood))
CHANGE(form,
       plumb_shape_set_geometry(p->w, p->low_box,
                                &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) }))
CHANGE(same_form, plumb_shape_set_geometry(p->w, p->low_box,
                                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                                .half = { R(0.5), R(0.5) } }))
CHANGE(same_floor,
       plumb_shape_set_geometry(p->w, p->floor,
                                &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 50, 1 } }))
CHANGE(filter, plumb_shape_set_filter(p->w, p->low_box, (plumb_filter){ .category = 2 }))
CHANGE(same_filter, plumb_shape_set_filter(p->w, p->low_box, (plumb_filter){ .category = 1 }))
CHANGE(same_one_way, plumb_shape_set_one_way(p->w, p->low_box, (plumb_one_way){ .angle = 0 }))
CHANGE(sensor, plumb_shape_set_sensor(p->w, p->low_box, true))
CHANGE(not_sensor, plumb_shape_set_sensor(p->w, p->low_box, false))
CHANGE(exclude, plumb_world_exclude_pair(p->w, p->low, p->ground, true))
CHANGE(destroy_low, plumb_body_destroy(p->w, p->low))
CHANGE(dig_away, plumb_shape_destroy(p->w, p->floor))
CHANGE(destroy_ground, plumb_body_destroy(p->w, p->ground))
CHANGE(move_ground, plumb_body_teleport(p->w, p->ground, plumb_v2(0, -9), 0))
CHANGE(floor_filter, plumb_shape_set_filter(p->w, p->floor, (plumb_filter){ .category = 2 }))
CHANGE(floor_sensor, plumb_shape_set_sensor(p->w, p->floor, true))
CHANGE(floor_material, plumb_shape_set_material(p->w, p->floor, (plumb_material)PLUMB_NULL_INIT))
CHANGE(drive_ledge, plumb_body_set_velocity(p->w, p->ledge, up))
CHANGE(still_ledge, plumb_body_set_velocity(p->w, p->ledge, none))
CHANGE(move_ledge, plumb_body_teleport(p->w, p->ledge, plumb_v2(10, 4), 0))
CHANGE(destroy_board, plumb_shape_destroy(p->w, p->board))
CHANGE(destroy_joint, plumb_joint_destroy(p->w, p->rod))
CHANGE(spring, plumb_joint_set_spring(p->w, p->rod, 1, 0, 0))
CHANGE(same_spring, plumb_joint_set_spring(p->w, p->rod, 0, 0, 0))
CHANGE(limit, plumb_joint_set_limit(p->w, p->rod, true, 0, 3))
CHANGE(same_limit, plumb_joint_set_limit(p->w, p->rod, false, 0, 0))
CHANGE(break_at, plumb_joint_set_break(p->w, p->rod, 1000, 0))
CHANGE(same_break, plumb_joint_set_break(p->w, p->rod, 0, 0))
CHANGE(break_by, plumb_joint_set_break_impulse(p->w, p->rod, R(0.01)))
CHANGE(same_impulse, plumb_joint_set_break_impulse(p->w, p->rod, 0))
CHANGE(tell_strain, plumb_joint_set_event(p->w, p->rod, 5, 0))
CHANGE(same_strain, plumb_joint_set_event(p->w, p->rod, 0, 0))
CHANGE(set_wood, plumb_material_set(p->w, p->wood, &(plumb_material_desc){ .friction = R(0.1) }))
// As it is already.
static plumb_result keep_wood(place *p)
{
    plumb_material_desc desc;
    assert_int_equal(plumb_material_settings(p->w, p->wood, &desc), PLUMB_OK);
    assert_int_equal(plumb_material_set(p->w, p->wood, &desc), PLUMB_OK);
    return plumb_material_pair_set(p->w, p->wood, p->wood, NULL);
}

CHANGE(pair_wood, plumb_material_pair_set(p->w, p->wood, p->wood, &(plumb_material_pair){ 0 }))
CHANGE(no_sleeping, plumb_world_set_sleep(p->w, false, 0, 0))
CHANGE(thresholds, plumb_world_set_sleep(p->w, true, R(0.1), 1))
CHANGE(hit_speed, plumb_world_set_hit_speed(p->w, 1))

static plumb_result add_shape(place *p)
{
    const plumb_shape_desc disc = { .kind = PLUMB_CIRCLE, .radius = R(0.1) };
    return made(p->w, plumb_shape_create(p->w, p->apart, &disc));
}

static plumb_result add_joint(place *p)
{
    const plumb_joint_desc weld = { .kind = PLUMB_WELD, .body_a = p->low, .body_b = p->apart };
    return made(p->w, plumb_joint_create(p->w, &weld));
}

static plumb_result add_ground_shape(place *p)
{
    const plumb_shape_desc post = { .kind = PLUMB_BOX, .half = { R(0.5), 1 }, .center = { 6, 1 } };
    return made(p->w, plumb_shape_create(p->w, p->ground, &post));
}

static plumb_result build_and_dig(place *p)
{
    const plumb_shape_desc tile = { .kind = PLUMB_BOX,
                                    .half = { R(0.5), R(0.5) },
                                    .center = { 30, 1 } };
    const plumb_shape there = plumb_shape_create(p->w, p->ground, &tile);
    steps(p->w, 1);
    return plumb_shape_destroy(p->w, there);
}

static plumb_result add_wall_beside(place *p)
{
    plumb_body wall = plumb_body_create(
        p->w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { R(5.76), R(0.5) } });
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(0.25), R(0.25) } };
    return made(p->w, plumb_shape_create(p->w, wall, &box));
}

static plumb_result add_wall_apart(place *p)
{
    plumb_body wall = plumb_body_create(
        p->w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { R(5.85), R(0.5) } });
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(0.25), R(0.25) } };
    return made(p->w, plumb_shape_create(p->w, wall, &box));
}

static plumb_result add_kinematic_inside(place *p)
{
    plumb_body peg = plumb_body_create(
        p->w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 5, R(0.9) } });
    const plumb_shape_desc disc = { .kind = PLUMB_CIRCLE, .radius = R(0.25) };
    return made(p->w, plumb_shape_create(p->w, peg, &disc));
}

static plumb_result add_awake_beside(place *p)
{
    return made(p->w, crate(p->w, 6, 0.5, p->wood, NULL));
}

static plumb_result add_awake_apart(place *p)
{
    return made(p->w, crate(p->w, 6.1, 0.5, p->wood, NULL));
}

static void edit_nothing(const plumb_system_call *call)
{
    (void)call;
}

static plumb_result add_contact_system(place *p)
{
    return plumb_system_create(
        p->w,
        &(plumb_system_desc){ .name = "edit", .phase = PLUMB_PHASE_CONTACTS, .run = edit_nothing });
}

static void push_low(const plumb_system_call *call)
{
    place *p = call->context;
    if (plumb_world_stats(call->world).asleep_count > 0) {
        plumb_body_apply_impulse_center(call->world, p->low, plumb_v2(0, 1));
    }
}

static plumb_result push_in_phase(place *p, plumb_phase phase)
{
    return plumb_system_create(
        p->w,
        &(plumb_system_desc){ .name = "push", .phase = phase, .run = push_low, .context = p });
}

CHANGE(push_at_begin, push_in_phase(p, PLUMB_PHASE_BEGIN))
CHANGE(push_with_forces, push_in_phase(p, PLUMB_PHASE_FORCES))

#define ROW(change, wakes)                                                                         \
    {                                                                                              \
#change, change, wakes                                                                     \
    }

static const waker wakers[] = {
    ROW(wake, STACK),
    ROW(teleport, APART),
    ROW(velocity, STACK),
    ROW(same_velocity, 0),
    ROW(spin, STACK),
    ROW(same_spin, 0),
    ROW(force, STACK),
    ROW(no_force, 0),
    ROW(force_at, STACK),
    ROW(torque, STACK),
    ROW(impulse, APART),
    ROW(no_impulse, 0),
    ROW(turn, APART),
    ROW(mass, APART),
    ROW(same_mass, 0),
    ROW(inertia, APART),
    ROW(damping, APART),
    ROW(same_damping, 0),
    ROW(cap, APART),
    ROW(same_cap, 0),
    ROW(time_scale, APART),
    ROW(same_time_scale, 0),
    ROW(locks, APART),
    ROW(same_locks, 0),
    ROW(same_place, 0),
    ROW(same_filter, 0),
    ROW(same_one_way, 0),
    ROW(fix, APART),
    ROW(not_fix, 0),
    ROW(scale, APART),
    ROW(same_scale, 0),
    ROW(no_sleep, APART),
    ROW(tag, 0),
    ROW(gravity, ALL),
    ROW(same_gravity, 0),
    ROW(tuning, ALL),
    ROW(same_tuning, 0),
    ROW(remove_shape, STACK),
    ROW(shape_material, STACK),
    ROW(same_material, 0),
    ROW(form, STACK),
    ROW(same_form, 0),
    ROW(same_floor, 0),
    ROW(filter, STACK),
    ROW(sensor, STACK),
    ROW(not_sensor, 0),
    ROW(exclude, STACK | APART),
    ROW(destroy_low, HIGH),
    ROW(dig_away, STACK | APART),
    ROW(destroy_ground, STACK | APART),
    ROW(move_ground, STACK | APART),
    ROW(floor_filter, STACK | APART),
    ROW(floor_sensor, STACK | APART),
    ROW(floor_material, STACK | APART),
    ROW(drive_ledge, ON_LEDGE),
    ROW(still_ledge, 0),
    ROW(move_ledge, ON_LEDGE),
    ROW(destroy_board, ON_LEDGE),
    ROW(destroy_joint, HUNG),
    ROW(spring, HUNG),
    ROW(same_spring, 0),
    ROW(limit, HUNG),
    ROW(same_limit, 0),
    ROW(break_at, HUNG),
    ROW(same_break, 0),
    ROW(break_by, HUNG),
    ROW(same_impulse, 0),
    ROW(tell_strain, HUNG),
    ROW(same_strain, 0),
    ROW(set_wood, ALL),
    ROW(keep_wood, 0),
    ROW(pair_wood, ALL),
    ROW(no_sleeping, ALL),
    ROW(thresholds, 0),
    ROW(hit_speed, 0),
    ROW(add_shape, APART),
    ROW(add_joint, STACK | APART),
    ROW(add_ground_shape, APART), // touches one
    ROW(build_and_dig, 0),        // tiles of the same body, elsewhere
    ROW(add_wall_beside, APART),  // 1 cm apart
    ROW(add_wall_apart, 0),       // 10 cm apart
    ROW(add_kinematic_inside, APART),
    ROW(add_awake_beside, APART),
    ROW(add_awake_apart, 0),
    ROW(add_contact_system, ALL),
    ROW(push_at_begin, STACK),
    ROW(push_with_forces, STACK),
};

static void every_change_wakes_whom_it_concerns(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof wakers / sizeof wakers[0]; ++i) {
        place p = make_place();
        const plumb_body people[] = { p.low, p.high, p.apart, p.on_ledge, p.hung };
        assert_int_equal(wakers[i].change(&p), PLUMB_OK);
        int woken;
        steps(p.w, 1);
        plumb_world_wake_events(p.w, &woken);
        for (int k = 0; k < 5; ++k) {
            if (!plumb_body_valid(p.w, people[k])) {
                continue;
            }
            bool wanted = (wakers[i].wakes >> k & 1u) != 0;
            if (plumb_body_is_awake(p.w, people[k]) != wanted) {
                fail_msg("%s: body %d is %s", wakers[i].name, k, wanted ? "asleep" : "awake");
            }
            woken -= wanted;
        }
        assert_int_equal(woken, 0);
        plumb_world_destroy(p.w);
    }
}

// A push in the last phase acts in the next step.
static void systems_at_the_end_wake_for_the_next_step(void **state)
{
    (void)state;
    place p = make_place();
    assert_int_equal(push_in_phase(&p, PLUMB_PHASE_END), PLUMB_OK);
    steps(p.w, 1);
    assert_true(plumb_body_is_awake(p.w, p.low)); // it is due
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
    plumb_system_enable(p.w, "push", false);
    steps(p.w, 1);
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 3);
    assert_true(plumb_body_velocity(p.w, p.high).y != 0);
    plumb_world_destroy(p.w);
}

static void pushes_lose_nothing_to_sleep(void **state)
{
    (void)state;
    place p = make_place();
    plumb_real m = plumb_body_mass(p.w, p.apart);
    plumb_vec2 from = plumb_body_position(p.w, p.apart);
    plumb_body_apply_impulse_center(p.w, p.apart, plumb_v2(0, 6 * m));
    assert_near(plumb_body_velocity(p.w, p.apart).y, 6, ROUNDED(1e-5));
    steps(p.w, 30);
    plumb_vec2 to = plumb_body_position(p.w, p.apart);
    assert_near(to.y - from.y, 6 * 0.5 - 9.81 * 0.125, ROUNDED(2e-3));
    plumb_world_destroy(p.w);
}

// Above the stack: what sees it is pushed as hard asleep as awake, and nothing else wakes.
static void explosions_push_sleeping_bodies(void **state)
{
    (void)state;
    plumb_vec2 pushed[2];
    for (int awake = 0; awake < 2; ++awake) {
        place p = make_place();
        const plumb_explosion_desc blast = { .position = { 0, 4 }, .radius = 3, .impulse = 5000 };
        if (awake == 1) {
            plumb_body_wake(p.w, p.high);
            steps(p.w, 1);
            plumb_body_set_velocity(p.w, p.high, none);
            plumb_body_set_angular_velocity(p.w, p.high, 0);
        }
        assert_int_equal(plumb_world_explode(p.w, &blast), PLUMB_OK);
        pushed[awake] = plumb_body_velocity(p.w, p.high);
        assert_true(plumb_body_is_awake(p.w, p.high));
        assert_false(plumb_body_is_awake(p.w, p.on_ledge));
        plumb_world_destroy(p.w);
    }
    assert_true(pushed[0].y < -1);
    assert_near(pushed[0].y, pushed[1].y, 1e-2 * (double)-pushed[1].y);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_change_wakes_whom_it_concerns),
        cmocka_unit_test(systems_at_the_end_wake_for_the_next_step),
        cmocka_unit_test(pushes_lose_nothing_to_sleep),
        cmocka_unit_test(explosions_push_sleeping_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
