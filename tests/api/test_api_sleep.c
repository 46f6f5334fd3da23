// test_api_sleep.c - plumb/sleep.h: falling asleep, waking by every kind of change, events, what is
// seen of sleeping bodies meanwhile, and every refusal.
#include "world_fixture.h"

#include <stdio.h>

static const plumb_real dt = R(1.0 / 60);

static void steps(plumb_world *w, int count)
{
    for (int i = 0; i < count; ++i) {
        assert_int_equal(plumb_world_step(w, dt), PLUMB_OK);
    }
}

//---- a scene -------------------------------------------------------------------------------------

// Two crates on one another and a third apart, on the ground; a kinematic ledge with a crate; two
// discs that are joined, without contacts, held by a hinge.
typedef struct place {
    plumb_world *w;
    plumb_body ground, ledge, low, high, apart, on_ledge, hung;
    plumb_shape floor, board, low_box;
    plumb_material wood;
    plumb_joint rod;
} place;

static plumb_body crate(plumb_world *w, double x, double y, plumb_material m, plumb_shape *shape)
{
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { R(x), R(y) } });
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) }, .material = m };
    plumb_shape made = plumb_shape_create(w, b, &box);
    if (shape != NULL) {
        *shape = made;
    }
    return b;
}

static place make_place(void)
{
    place p = { .w = NULL };
    assert_int_equal(plumb_world_create(NULL, &p.w), PLUMB_OK);
    p.wood = plumb_material_create(p.w, &(plumb_material_desc){ .friction = R(0.6) });
    p.ground =
        plumb_body_create(p.w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, -1 } });
    p.floor = plumb_shape_create(
        p.w, p.ground,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 50, 1 }, .material = p.wood });
    p.ledge = plumb_body_create(
        p.w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 10, 5 } });
    p.board = plumb_shape_create(p.w, p.ledge,
                                 &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 2, R(0.25) } });
    p.low = crate(p.w, 0, 0.5, p.wood, &p.low_box);
    p.high = crate(p.w, 0.1, 1.5, p.wood, NULL);
    p.apart = crate(p.w, 5, 0.5, p.wood, NULL);
    p.on_ledge = crate(p.w, 10, 5.75, p.wood, NULL);
    p.hung = crate(p.w, -10, 8, p.wood, NULL);
    p.rod = plumb_joint_create(p.w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                         .body_b = p.hung,
                                                         .anchor = { -10, 10 },
                                                         .anchor_b = { -10, 8 } });
    steps(p.w, 150);
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
    assert_int_equal(plumb_world_stats(p.w).dynamic_count, 0);
    assert_int_equal(plumb_world_stats(p.w).island_count, 4);
    return p;
}

//---- what wakes, and what does not ---------------------------------------------------------------

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
CHANGE(reset_mass, plumb_body_reset_mass(p->w, p->apart))
CHANGE(fix, plumb_body_set_fixed_rotation(p->w, p->apart, true))
CHANGE(not_fix, plumb_body_set_fixed_rotation(p->w, p->apart, false))
CHANGE(scale, plumb_body_set_gravity_scale(p->w, p->apart, 2))
CHANGE(same_scale, plumb_body_set_gravity_scale(p->w, p->apart, 1))
CHANGE(no_sleep, plumb_body_set_no_sleep(p->w, p->apart, true))
CHANGE(tag, plumb_body_set_user_data(p->w, p->apart, p))
CHANGE(gravity, plumb_world_set_gravity(p->w, plumb_v2(0, 9)))
CHANGE(same_gravity, plumb_world_set_gravity(p->w, plumb_world_gravity(p->w)))
CHANGE(remove_shape, plumb_shape_destroy(p->w, p->low_box))
CHANGE(shape_material, plumb_shape_set_material(p->w, p->low_box, (plumb_material)PLUMB_NULL_INIT))
CHANGE(same_material, plumb_shape_set_material(p->w, p->low_box, p->wood))
CHANGE(filter, plumb_shape_set_filter(p->w, p->low_box, (plumb_filter){ .category = 2 }))
CHANGE(sensor, plumb_shape_set_sensor(p->w, p->low_box, true))
CHANGE(not_sensor, plumb_shape_set_sensor(p->w, p->low_box, false))
CHANGE(exclude, plumb_world_exclude_pair(p->w, p->low, p->ground, true))
CHANGE(destroy_low, plumb_body_destroy(p->w, p->low))
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
CHANGE(set_wood, plumb_material_set(p->w, p->wood, &(plumb_material_desc){ .friction = R(0.1) }))
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
    return plumb_system_create(p->w, &(plumb_system_desc){ .name = "edit",
                                                           .phase = PLUMB_PHASE_CONTACTS,
                                                           .run = edit_nothing });
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
        p->w, &(plumb_system_desc){ .name = "push", .phase = phase, .run = push_low, .context = p });
}

CHANGE(push_at_begin, push_in_phase(p, PLUMB_PHASE_BEGIN))
CHANGE(push_with_forces, push_in_phase(p, PLUMB_PHASE_FORCES))

#define ROW(change, wakes) { #change, change, wakes }

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
    ROW(reset_mass, APART),
    ROW(fix, APART),
    ROW(not_fix, 0),
    ROW(scale, APART),
    ROW(same_scale, 0),
    ROW(no_sleep, APART),
    ROW(tag, 0),
    ROW(gravity, ALL),
    ROW(same_gravity, 0),
    ROW(remove_shape, STACK),
    ROW(shape_material, STACK),
    ROW(same_material, 0),
    ROW(filter, STACK),
    ROW(sensor, STACK),
    ROW(not_sensor, 0),
    ROW(exclude, STACK | APART),
    ROW(destroy_low, HIGH),
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
    ROW(break_at, 0),
    ROW(set_wood, ALL),
    ROW(pair_wood, ALL),
    ROW(no_sleeping, ALL),
    ROW(thresholds, 0),
    ROW(hit_speed, 0),
    ROW(add_shape, APART),
    ROW(add_joint, STACK | APART),
    ROW(add_ground_shape, STACK | APART), // to what the body touches already
    ROW(add_wall_beside, APART),          // 1 cm apart
    ROW(add_wall_apart, 0),               // 10 cm apart
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
    assert_near(plumb_body_velocity(p.w, p.apart).y, 6, 1e-5);
    steps(p.w, 30);
    plumb_vec2 to = plumb_body_position(p.w, p.apart);
    assert_near(to.y - from.y, 6 * 0.5 - 9.81 * 0.125, 2e-3);
    plumb_world_destroy(p.w);
}

//---- seen in their sleep -------------------------------------------------------------------------

static void contacts_are_seen_and_neither_end_nor_begin(void **state)
{
    (void)state;
    place p = make_place();
    plumb_contact c[4];
    int count, begins, ends;
    for (int round = 0; round < 2; ++round) {
        assert_int_equal(plumb_world_contacts(p.w, NULL, 0), 4);
        assert_int_equal(plumb_body_contacts(p.w, p.low, c, 4), 2);
        double weight = 0;
        for (int i = 0; i < 2; ++i) {
            bool on_floor = plumb_same(c[i].shape_a, p.floor) || plumb_same(c[i].shape_b, p.floor);
            for (int k = 0; on_floor && k < c[i].point_count; ++k) {
                assert_near(c[i].points[k].point.y, 0, 2e-3);
                weight += (double)c[i].points[k].normal_impulse;
            }
        }
        assert_near(weight * 4 * 60, 2 * 9.81, 0.02); // two crates of 1 kg
        assert_int_equal(plumb_body_contacts(p.w, p.ground, NULL, 0), 2);
        assert_int_equal(plumb_world_stats(p.w).contact_count, 4);
        plumb_body_wake(p.w, p.low);
        for (int i = 0; i < 120; ++i) {
            steps(p.w, 1);
            plumb_world_begin_events(p.w, &begins);
            plumb_world_end_events(p.w, &ends);
            assert_int_equal(begins + ends, 0);
        }
        assert_false(plumb_body_is_awake(p.w, p.low));
    }
    // Destroyed in its sleep: what is left has one contact less, and ends nothing that is gone.
    plumb_body_destroy(p.w, p.high);
    assert_int_equal(plumb_body_contacts(p.w, p.low, NULL, 0), 1);
    steps(p.w, 1);
    plumb_world_end_events(p.w, &ends);
    assert_int_equal(ends, 0);
    // Lifted off in its sleep: the contact ends.
    steps(p.w, 120);
    assert_false(plumb_body_is_awake(p.w, p.low));
    plumb_body_teleport(p.w, p.low, plumb_v2(0, 4), 0);
    steps(p.w, 1);
    const plumb_contact_end *end = plumb_world_end_events(p.w, &count);
    assert_int_equal(count, 1);
    assert_true(plumb_same(end->body_a, p.low) || plumb_same(end->body_b, p.low));
    plumb_world_destroy(p.w);
}

static void queries_see_sleepers(void **state)
{
    (void)state;
    place p = make_place();
    plumb_ray_hit hit;
    plumb_nearest_hit near;
    plumb_shape shapes[8];
    for (int round = 0; round < 3; ++round) {
        assert_true(plumb_world_ray(p.w, plumb_v2(-3, R(0.5)), plumb_v2(3, R(0.5)), NULL, &hit));
        assert_true(plumb_same(hit.body, p.low));
        plumb_query_filter moving = { .ignore_static = true }, still = { .ignore_dynamic = true };
        assert_true(plumb_world_nearest(p.w, plumb_v2(5, 3), 9, &moving, &near));
        assert_true(plumb_same(near.body, p.apart));
        assert_false(plumb_world_ray(p.w, plumb_v2(-3, R(0.5)), plumb_v2(3, R(0.5)), &still, &hit));
        plumb_aabb box = { { -1, R(0.1) }, { 6, 2 } };
        assert_int_equal(plumb_world_overlap_aabb(p.w, box, NULL, shapes, 8), 3);
        if (round == 0) { // awake, the entries of their grid still there
            plumb_body_wake(p.w, p.low);
            steps(p.w, 1);
        } else if (round == 1) { // moved in its sleep, no step since
            steps(p.w, 120);
            assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
            plumb_body_teleport(p.w, p.high, plumb_v2(20, R(7.5)), 0);
            assert_true(plumb_world_ray(p.w, plumb_v2(15, 7), plumb_v2(25, 7), NULL, &hit));
            assert_true(plumb_same(hit.body, p.high));
            plumb_body_teleport(p.w, p.high, plumb_v2(R(0.1), R(1.5)), 0);
        }
    }
    plumb_body_destroy(p.w, p.low);
    assert_false(plumb_world_ray(p.w, plumb_v2(-3, R(0.5)), plumb_v2(3, R(0.5)), NULL, &hit));
    plumb_world_destroy(p.w);
}

static void sensor_events(const plumb_world *w, int *begins, int *ends)
{
    plumb_world_sensor_begin_events(w, begins);
    plumb_world_sensor_end_events(w, ends);
}

static void sensors_see_sleepers(void **state)
{
    (void)state;
    place p = make_place();
    int begins, ends;
    plumb_shape seen[8];
    plumb_body zone = plumb_body_create(
        p.w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, 1 } });
    plumb_shape eye = plumb_shape_create(
        p.w, zone, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 2, 2 }, .sensor = true });
    steps(p.w, 1);
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 5); // a sensor wakes nobody
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins, 2); // placed over them
    assert_int_equal(plumb_shape_overlaps(p.w, eye, seen, 8), 2);
    steps(p.w, 3);
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins + ends, 0);
    assert_int_equal(plumb_shape_overlaps(p.w, eye, seen, 8), 2);
    // Waking and falling asleep are no events.
    plumb_body_wake(p.w, p.low);
    for (int i = 0; i < 120; ++i) {
        steps(p.w, 1);
        sensor_events(p.w, &begins, &ends);
        assert_int_equal(begins + ends, 0);
        assert_int_equal(plumb_shape_overlaps(p.w, eye, seen, 8), 2);
    }
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
    // Destroyed in its sleep; then the sensor is taken away.
    plumb_body_destroy(p.w, p.high);
    steps(p.w, 1);
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins, 0);
    assert_int_equal(ends, 1);
    steps(p.w, 120);
    plumb_body_teleport(p.w, zone, plumb_v2(-30, 1), 0);
    steps(p.w, 1);
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins, 0);
    assert_int_equal(ends, 1);
    assert_int_equal(plumb_shape_overlaps(p.w, eye, seen, 8), 0);
    // A sensor that moves, over sleepers; and one that sleeps.
    plumb_body scanner =
        plumb_body_create(p.w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC,
                                                   .position = { 3, 3 },
                                                   .velocity = { 2, 0 } });
    plumb_shape beam = plumb_shape_create(p.w, scanner, &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                                             .half = { R(0.1), 5 },
                                                                             .sensor = true });
    int all_begins = 0, all_ends = 0;
    for (int i = 0; i < 120; ++i) {
        steps(p.w, 1);
        sensor_events(p.w, &begins, &ends);
        all_begins += begins, all_ends += ends;
    }
    assert_int_equal(all_begins, 2); // the floor and one crate
    assert_int_equal(all_ends, 1);
    assert_int_equal(plumb_shape_overlaps(p.w, beam, seen, 8), 1);
    assert_false(plumb_body_is_awake(p.w, p.apart));
    plumb_world_destroy(p.w);
}

static void a_sensor_may_sleep(void **state)
{
    (void)state;
    place p = make_place();
    int begins, ends;
    plumb_shape feeler = plumb_shape_create(
        p.w, p.high, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1, .sensor = true });
    steps(p.w, 1);
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins, 1); // the lower crate
    for (int i = 0; i < 150; ++i) {
        steps(p.w, 1);
        sensor_events(p.w, &begins, &ends);
        assert_int_equal(begins + ends, 0);
    }
    assert_false(plumb_body_is_awake(p.w, p.high));
    assert_int_equal(plumb_shape_overlaps(p.w, feeler, NULL, 0), 1);
    // What flies by is seen, and wakes nobody.
    plumb_body ball = plumb_body_create(
        p.w, &(plumb_body_desc){ .position = { R(1.05), 2 }, .velocity = { 0, 1 } });
    plumb_shape_create(p.w, ball, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.1) });
    steps(p.w, 1);
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins, 1);
    assert_false(plumb_body_is_awake(p.w, p.high));
    plumb_world_destroy(p.w);
}

//---- by command, by descriptor -------------------------------------------------------------------

static void bodies_are_put_to_sleep(void **state)
{
    (void)state;
    place p = make_place();
    int events;
    plumb_body_apply_impulse_center(p.w, p.high, plumb_v2(1, 1));
    steps(p.w, 3);
    plumb_vec2 at = plumb_body_position(p.w, p.high);
    assert_int_equal(plumb_body_sleep(p.w, p.high), PLUMB_OK);
    assert_false(plumb_body_is_awake(p.w, p.high));
    assert_vec_near(plumb_body_velocity(p.w, p.high), 0, 0, 0);
    assert_int_equal(plumb_body_sleep(p.w, p.high), PLUMB_OK); // it does
    steps(p.w, 60);
    plumb_world_sleep_events(p.w, &events);
    assert_int_equal(events, 0);
    assert_vec_near(plumb_body_position(p.w, p.high), at.x, at.y, 0); // even in mid-air
    // With what it touches.
    plumb_body_teleport(p.w, p.high, plumb_v2(R(0.1), R(1.5)), 0);
    steps(p.w, 5);
    assert_true(plumb_body_is_awake(p.w, p.low));
    assert_int_equal(plumb_body_sleep(p.w, p.low), PLUMB_OK);
    assert_false(plumb_body_is_awake(p.w, p.high));
    assert_true(plumb_body_contacts(p.w, p.low, NULL, 0) >= 1);
    // A push, and second thoughts.
    plumb_body_apply_impulse_center(p.w, p.low, plumb_v2(1, 0));
    assert_true(plumb_body_is_awake(p.w, p.low));
    assert_int_equal(plumb_body_sleep(p.w, p.low), PLUMB_OK);
    assert_false(plumb_body_is_awake(p.w, p.low));
    assert_vec_near(plumb_body_velocity(p.w, p.low), 0, 0, 0);
    steps(p.w, 2);
    assert_false(plumb_body_is_awake(p.w, p.low));
    plumb_world_destroy(p.w);
}

static void bodies_may_start_asleep(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } };
    plumb_body a = plumb_body_create(w, &(plumb_body_desc){ .asleep = true });
    plumb_shape_create(w, a, &box);
    plumb_body_set_mass(w, a, 5);
    plumb_body_teleport(w, a, plumb_v2(0, 5), 0);
    plumb_body b = plumb_command_body_create(
        w, &(plumb_body_desc){ .position = { 1, 5 }, .asleep = true });
    plumb_command_shape_create(w, b, &box);
    plumb_commands_apply(w);
    plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_WELD, .body_a = a, .body_b = b });
    assert_false(plumb_body_is_awake(w, a));
    steps(w, 60);
    assert_int_equal(plumb_world_stats(w).island_count, 2);
    assert_vec_near(plumb_body_position(w, a), 0, 5, 0);
    plumb_body_set_mass(w, a, 6); // a step has seen it
    steps(w, 1);
    assert_true(plumb_body_is_awake(w, a) && plumb_body_is_awake(w, b)); // joined
    // Pushed before the first step.
    plumb_body c = plumb_body_create(w, &(plumb_body_desc){ .position = { 9, 5 }, .asleep = true });
    plumb_body_set_velocity(w, c, plumb_v2(1, 0));
    steps(w, 1);
    assert_true(plumb_body_is_awake(w, c));
    // A body awake joined to one that starts asleep.
    plumb_body d = plumb_body_create(w, &(plumb_body_desc){ .position = { 20, 5 }, .asleep = true });
    plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_WELD, .body_a = c, .body_b = d });
    steps(w, 1);
    assert_true(plumb_body_is_awake(w, d));
    plumb_world_destroy(w);
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .no_sleep = true }, &w), PLUMB_OK);
    a = plumb_body_create(w, &(plumb_body_desc){ .asleep = true });
    assert_true(plumb_body_is_awake(w, a));
    plumb_world_destroy(w);
}

static void sleeping_is_optional(void **state)
{
    (void)state;
    place p = make_place();
    assert_int_equal(plumb_body_set_no_sleep(p.w, p.high, true), PLUMB_OK);
    assert_true(plumb_body_no_sleep(p.w, p.high) && !plumb_body_no_sleep(p.w, p.low));
    steps(p.w, 300);
    assert_true(plumb_body_is_awake(p.w, p.high) && plumb_body_is_awake(p.w, p.low));
    plumb_body_set_no_sleep(p.w, p.high, false);
    steps(p.w, 10);
    assert_false(plumb_body_is_awake(p.w, p.high));
    plumb_world_set_sleep(p.w, false, 0, 0);
    steps(p.w, 300);
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 0);
    assert_true(plumb_world_settings(p.w).no_sleep);
    plumb_world_set_sleep(p.w, true, R(0.2), 2);
    assert_near(plumb_world_settings(p.w).sleep_speed, 0.2, 0);
    assert_near(plumb_world_settings(p.w).sleep_time, 2, 0);
    plumb_world_set_sleep(p.w, true, 0, 0);
    assert_near(plumb_world_settings(p.w).sleep_speed, 0.05, 1e-9);
    assert_near(plumb_world_settings(p.w).sleep_time, 0.5, 0);
    steps(p.w, 60);
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
    plumb_world_destroy(p.w);
}

static void events_tell_who_slept_and_who_woke(void **state)
{
    (void)state;
    place p = make_place();
    int slept, woken;
    assert_null(plumb_world_sleep_events(p.w, &slept));
    assert_null(plumb_world_wake_events(p.w, &woken));
    plumb_body_wake(p.w, p.low);
    steps(p.w, 1);
    const plumb_body *who = plumb_world_wake_events(p.w, &woken);
    assert_int_equal(woken, 2);
    assert_true(plumb_same(who[0], p.low) && plumb_same(who[1], p.high));
    for (slept = 0; slept == 0;) {
        steps(p.w, 1);
        who = plumb_world_sleep_events(p.w, &slept);
    }
    assert_int_equal(slept, 2);
    assert_true(plumb_same(who[0], p.low) && plumb_same(who[1], p.high));
    steps(p.w, 1);
    plumb_world_sleep_events(p.w, &slept);
    assert_int_equal(slept, 0);
    assert_null(plumb_world_sleep_events(NULL, &slept));
    assert_null(plumb_world_wake_events(NULL, &woken));
    plumb_world_destroy(p.w);
}

static void rows_are_partitioned_as_told(void **state)
{
    (void)state;
    place p = make_place();
    plumb_body_span s = plumb_world_bodies(p.w);
    assert_int_equal(s.dynamic_count, 0);
    assert_int_equal(s.asleep_count, 5);
    assert_true(plumb_same(s.entity[0], p.ledge));
    plumb_body_wake(p.w, p.apart);
    steps(p.w, 1);
    plumb_body_wake(p.w, p.low);
    steps(p.w, 1);
    s = plumb_world_bodies(p.w);
    assert_int_equal(s.dynamic_count, 3);
    assert_true(plumb_same(s.entity[0], p.apart)); // who wakes comes last
    assert_true(plumb_same(s.entity[1], p.low) && plumb_same(s.entity[2], p.high));
    assert_true(plumb_same(s.entity[3], p.ledge));
    plumb_body_sleep(p.w, p.apart);
    s = plumb_world_bodies(p.w);
    assert_true(plumb_same(s.entity[3], p.apart)); // who falls asleep comes first of them
    plumb_world_destroy(p.w);
}

//---- refusals ------------------------------------------------------------------------------------

static plumb_result made_body(fixture *f, plumb_body_desc desc)
{
    return made(f->world, plumb_body_create(f->world, &desc));
}

static void sleep_in_a_system(const plumb_system_call *call)
{
    fixture *f = call->context;
    assert_int_equal(plumb_body_sleep(call->world, f->dynamic), PLUMB_E_LOCKED);
    assert_int_equal(plumb_body_wake(call->world, f->dynamic), PLUMB_OK);
}

static void refusals(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_body null = PLUMB_NULL_INIT;
    REFUSED(E_HANDLE, "plumb_body_wake: body is null; it must be a live body",
            plumb_body_wake(w, null));
    REFUSED(E_HANDLE, "plumb_body_sleep: body is null; it must be a live body",
            plumb_body_sleep(w, null));
    REFUSED(E_STATE, "plumb_body_sleep: body is static; it must be dynamic",
            plumb_body_sleep(w, f->fixed));
    REFUSED(E_STATE, "plumb_body_sleep: body is kinematic; it must be dynamic",
            plumb_body_sleep(w, f->kinematic));
    REFUSED(E_HANDLE, "plumb_body_set_no_sleep: body is a shape; it must be a live body",
            plumb_body_set_no_sleep(w, f->box, true));
    REFUSED(E_RANGE, "plumb_world_set_sleep: speed is -1; it must be at least 0",
            plumb_world_set_sleep(w, true, -1, 0));
    REFUSED(E_NOT_FINITE, "plumb_world_set_sleep: time is nan; it must be finite",
            plumb_world_set_sleep(w, true, 0, R(NAN)));
    REFUSED(E_RANGE, "plumb_body_create: asleep is true; it must be false for a static body",
            made_body(f, (plumb_body_desc){ .type = PLUMB_STATIC, .asleep = true }));
    REFUSED(E_RANGE, "plumb_body_create: asleep is true; it must be false for a kinematic body",
            made_body(f, (plumb_body_desc){ .type = PLUMB_KINEMATIC, .asleep = true }));
    REFUSED(E_RANGE, "plumb_body_create: asleep is true; it must be false with no_sleep",
            made_body(f, (plumb_body_desc){ .no_sleep = true, .asleep = true }));
    REFUSED(E_RANGE, "plumb_body_create: asleep is true; it must be false for a body that moves",
            made_body(f, (plumb_body_desc){ .velocity = { 1, 0 }, .asleep = true }));
    plumb_body_set_no_sleep(w, f->dynamic, true);
    char message[128];
    snprintf(message, sizeof message,
             "plumb_body_sleep: body is in an island with one that may not sleep (%u:%u)",
             f->dynamic.index, f->dynamic.generation);
    REFUSED(E_STATE, message, plumb_body_sleep(w, f->dynamic));
    plumb_body_set_no_sleep(w, f->dynamic, false);
    plumb_world_set_sleep(w, false, 0, 0);
    REFUSED(E_STATE, "plumb_body_sleep: the world has no_sleep; see plumb_world_set_sleep",
            plumb_body_sleep(w, f->dynamic));
    plumb_world_set_sleep(w, true, 0, 0);
    assert_int_equal(plumb_world_set_sleep(NULL, true, 0, 0), PLUMB_E_NULL);
    assert_int_equal(plumb_body_wake(NULL, null), PLUMB_E_NULL);
    assert_int_equal(plumb_body_sleep(NULL, null), PLUMB_E_NULL);
    assert_int_equal(plumb_body_set_no_sleep(NULL, null, true), PLUMB_E_NULL);
    assert_false(plumb_body_is_awake(w, null) || plumb_body_is_awake(w, f->stale));
    assert_false(plumb_body_is_awake(NULL, null) || plumb_body_no_sleep(NULL, null));
    assert_true(plumb_body_is_awake(w, f->fixed) && plumb_body_is_awake(w, f->kinematic));
    assert_int_equal(plumb_body_wake(w, f->fixed), PLUMB_OK);
    plumb_system_create(w, &(plumb_system_desc){
                               .name = "s", .run = sleep_in_a_system, .context = f });
    assert_int_equal(plumb_world_step(w, dt), PLUMB_OK);
}

static void thresholds_are_checked(void **state)
{
    (void)state;
    plumb_world *w;
    const plumb_world_desc bad[] = { { .sleep_speed = -1 }, { .sleep_time = R(NAN) } };
    assert_int_equal(plumb_world_create(&bad[0], &w), PLUMB_E_RANGE);
    assert_int_equal(plumb_world_create(&bad[1], &w), PLUMB_E_NOT_FINITE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_change_wakes_whom_it_concerns),
        cmocka_unit_test(systems_at_the_end_wake_for_the_next_step),
        cmocka_unit_test(pushes_lose_nothing_to_sleep),
        cmocka_unit_test(contacts_are_seen_and_neither_end_nor_begin),
        cmocka_unit_test(queries_see_sleepers),
        cmocka_unit_test(sensors_see_sleepers),
        cmocka_unit_test(a_sensor_may_sleep),
        cmocka_unit_test(bodies_are_put_to_sleep),
        cmocka_unit_test(bodies_may_start_asleep),
        cmocka_unit_test(sleeping_is_optional),
        cmocka_unit_test(events_tell_who_slept_and_who_woke),
        cmocka_unit_test(rows_are_partitioned_as_told),
        API_TEST(refusals),
        cmocka_unit_test(thresholds_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
