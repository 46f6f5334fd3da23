// test_scene_motion.c - how bodies of a scene move: locks, damping, caps, time scale, enabling, types,
// targets, blast{}; and their JSON.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static plumb_body named(scene *s, const char *name)
{
    return scene_body_find(s, name).entity;
}

#define EVERYTHING                                                                                 \
    "scene{ gravity = {0, 0} }\n"                                                                  \
    "local tar = material{ adhesion = 25, friction = 0.5 }\n"                                      \
    "body{ name = 'a', circle{1}, lock = {'y', 'rotation'}, material = tar }\n"                    \
    "body{ name = 'b', circle{1}, at = {5, 0}, damping = 0.5, angular_damping = 2, drag = 0.75, "  \
    "thrust = 2, exhaust = 3, fuel = 0.5, thrust_angle = 1, thrust_x = -1, thrust_y = 0.25 "       \
    "}\n"                                                                                          \
    "body{ name = 'c', circle{1}, at = {10, 0}, max_speed = 3, max_spin = 4 }\n"                   \
    "body{ name = 'd', circle{1}, at = {15, 0}, enabled = false, time_scale = 0.25 }\n"            \
    "body{ name = 'e', type = 'kinematic', circle{1}, at = {20, 0}, time_scale = 0 }\n"            \
    "body{ name = 'f', circle{1}, at = {25, 0}, mass = 5, damping = 1, lock = 'x' }\n"             \
    "body{ name = 'g', circle{1}, at = {30, 0}, dipole = 0.75, dipole_angle = -1.5 }\n"

static void fields_reach_the_world(void **state)
{
    (void)state;
    scene *s = load(EVERYTHING);
    const plumb_world *w = scene_world(s);
    plumb_axis_locks a = plumb_body_locks(w, named(s, "a")), f = plumb_body_locks(w, named(s, "f"));
    assert_true(!a.x && a.y && a.rotation);
    assert_true(f.x && !f.y && !f.rotation);
    assert_true(plumb_body_damping(w, named(s, "b")) == (plumb_real)0.5);
    assert_true(plumb_body_angular_damping(w, named(s, "b")) == 2);
    assert_true(plumb_body_drag(w, named(s, "b")) == (plumb_real)0.75);
    assert_true(plumb_body_max_speed(w, named(s, "c")) == 3);
    assert_true(plumb_body_max_spin(w, named(s, "c")) == 4);
    assert_false(plumb_body_is_enabled(w, named(s, "d")));
    assert_true(plumb_body_time_scale(w, named(s, "d")) == (plumb_real)0.25);
    assert_true(plumb_body_time_scale(w, named(s, "e")) == 0);
    assert_true(plumb_body_dipole(w, named(s, "g")) == (plumb_real)0.75);
    assert_true(plumb_body_dipole_angle(w, named(s, "g")) == (plumb_real)-1.5);
    plumb_shape shape;
    plumb_material_desc m;
    plumb_body_shapes(w, named(s, "a"), &shape, 1);
    plumb_material_settings(w, plumb_shape_material(w, shape), &m);
    assert_true(m.adhesion == 25);
    scene_destroy(s);
}

static void json_keeps_it(void **state)
{
    (void)state;
    scene *s = load(EVERYTHING "find('f'):set_type('kinematic') find('b'):set_damping(3) "
                               "find('c'):set_lock('x', 'y') find('c'):set_time_scale(2) "
                               "find('c'):set_drag(0.5) find('c'):set_thrust(4)"
                               "find('c'):set_dipole(-2) find('c'):set_dipole_angle(0.5)"
                               "find('d'):set_enabled(true) find('a'):set_enabled(false)\n");
    size_t size;
    char *text = export_json(s, &size);
    scene *t = load_as("test.json", text, size, NULL);
    char *again = export_json(t, &size);
    assert_string_equal(text, again);
    const plumb_world *w = scene_world(t);
    assert_int_equal(plumb_body_get_type(w, named(t, "f")), PLUMB_KINEMATIC);
    assert_true(plumb_body_damping(w, named(t, "b")) == 3);
    assert_true(plumb_body_angular_damping(w, named(t, "b")) == 2);
    assert_true(plumb_body_locks(w, named(t, "c")).x && plumb_body_locks(w, named(t, "c")).y);
    assert_true(plumb_body_time_scale(w, named(t, "c")) == 2);
    assert_true(plumb_body_drag(w, named(t, "b")) == (plumb_real)0.75);
    assert_true(plumb_body_drag(w, named(t, "c")) == (plumb_real)0.5);
    assert_true(plumb_body_thrust(w, named(t, "b")) == 2);
    assert_true(plumb_body_exhaust(w, named(t, "b")) == 3);
    assert_true(plumb_body_fuel(w, named(t, "b")) == (plumb_real)0.5);
    assert_true(plumb_body_thrust_x(w, named(t, "b")) == -1);
    assert_true(plumb_body_thrust_angle(w, named(t, "b")) == 1);
    assert_true(plumb_body_thrust(w, named(t, "c")) == 4);
    assert_true(plumb_body_dipole(w, named(t, "g")) == (plumb_real)0.75);
    assert_true(plumb_body_dipole_angle(w, named(t, "g")) == (plumb_real)-1.5);
    assert_true(plumb_body_dipole(w, named(t, "c")) == -2);
    assert_true(plumb_body_dipole_angle(w, named(t, "c")) == (plumb_real)0.5);
    assert_true(plumb_body_is_enabled(w, named(t, "d")));
    assert_false(plumb_body_is_enabled(w, named(t, "a")));
    free(text);
    free(again);
    scene_destroy(s);
    scene_destroy(t);
}

static void handlers_move_bodies(void **state)
{
    (void)state;
    scene *s =
        load("scene{ gravity = {0, 0} }\n"
             "local lift = body{ name = 'lift', type = 'kinematic', box{1, 1} }\n"
             "local ball = body{ name = 'ball', circle{0.5}, at = {5, 0} }\n"
             "local cart = body{ name = 'cart', type = 'kinematic', circle{1}, at = {20, 0} }\n"
             "at(0, function() lift:move_to(3, 4, 0.5, 0.5) cart:move_to({22, 0}, 1, 0.5, 3, 0, 2) "
             "end)\n"
             "at(0.25, function() ball:set_type('static') assert(ball:type() == 'static') end)\n"
             "at(0.75, function() ball:set_type('dynamic') ball:set_enabled(false)\n"
             "  assert(not ball:enabled()) lift:move_to({1, 1}) end)\n");
    steps(s, 30);
    const plumb_world *w = scene_world(s);
    assert_near(plumb_body_velocity(w, named(s, "cart")).x, 3, 0);
    assert_near(plumb_body_angular_velocity(w, named(s, "cart")), 2, 0);
    assert_near(plumb_body_position(w, named(s, "cart")).x, 22, 0);
    plumb_vec2 p = plumb_body_position(w, named(s, "lift"));
    assert_true(p.x == 3 && p.y == 4);
    assert_int_equal(plumb_body_get_type(w, named(s, "ball")), PLUMB_STATIC);
    steps(s, 16);
    p = plumb_body_position(w, named(s, "lift"));
    assert_true(p.x == 1 && p.y == 1);
    assert_false(plumb_body_is_enabled(w, named(s, "ball")));
    scene_destroy(s);
}

static void a_blast_pushes(void **state)
{
    (void)state;
    scene *s =
        load("scene{ gravity = {0, 0} }\n"
             "body{ name = 'bomb', circle{0.2} }\n"
             "body{ name = 'open', circle{0.5}, at = {-5, 0} }\n"
             "body{ name = 'hidden', circle{0.5}, at = {5, 0} }\n"
             "body{ type = 'static', box{0.5, 4}, at = {3, 0} }\n"
             "at(0.1, function() blast{ at = {0, 0}, radius = 8, falloff = 2, impulse = 4,\n"
             "  occlusion = 'walls', ignore = 'bomb' } end)\n"
             "at(0.5, function() blast{ at = {5, 1}, radius = 2, impulse = 7, per_body = true }"
             " end)\n");
    steps(s, 10);
    const plumb_world *w = scene_world(s);
    assert_true(plumb_body_velocity(w, named(s, "open")).x < -3);
    assert_true(plumb_body_velocity(w, named(s, "hidden")).x == 0);
    assert_true(plumb_body_velocity(w, named(s, "bomb")).x == 0);
    steps(s, 25);
    plumb_body hidden = named(s, "hidden");
    double impulse = (double)(plumb_body_velocity(w, hidden).y * plumb_body_mass(w, hidden));
    assert_near(impulse + 7, 0, ROUNDED(1e-4));
    scene_destroy(s);
}

// Time passes as before, a force acts in the first part alone, and what follows a step follows each part.
static void steps_are_split(void **state)
{
    (void)state;
    scene *s = load("scene{ gravity = {0, 0} }\n"
                    "body{ name = 'ball', circle{0.5}, mass = 1, velocity = {0, 3} }\n"
                    "body{ name = 'wall', type = 'static', box{4, 1}, at = {0, 2.1} }\n"
                    "split_step(10)\n"
                    "at(0, function() find('ball'):apply_force(60, 0) end)\n"
                    "at(1 / 60, function() split_step(1) find('ball'):apply_force(60, 0) end)\n"
                    "on_contact{ a = 'ball', function() score('met', score('met') + 1) end }\n"
                    "expect{ 'met once', score = 'met', value = 1 }\n");
    steps(s, 1);
    const plumb_world *w = scene_world(s);
    assert_near(scene_time(s) - 1 / 60.0, 0, 1e-15);
    assert_near((double)plumb_body_velocity(w, named(s, "ball")).x - 0.1, 0, ROUNDED(1e-5));
    assert_near((double)plumb_body_position(w, named(s, "ball")).y - 0.05, 0, ROUNDED(1e-5));
    char lacks[200];
    assert_true(scene_json_lacks(s, lacks, sizeof lacks) > 0);
    assert_non_null(strstr(lacks, "1 order to split steps"));
    steps(s, 1);
    assert_near((double)plumb_body_velocity(w, named(s, "ball")).x - 1.1, 0, ROUNDED(1e-5));
    run_and_hold(s);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_reach_the_world), cmocka_unit_test(json_keeps_it),
        cmocka_unit_test(handlers_move_bodies),   cmocka_unit_test(a_blast_pushes),
        cmocka_unit_test(steps_are_split),
    };
    return cmocka_run_group_tests_name("scene motion", tests, NULL, NULL);
}
