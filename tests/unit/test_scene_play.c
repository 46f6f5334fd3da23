// test_scene_play.c - characters, one-way platforms and queries in scenes: what keys and methods do,
// and their JSON.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

// Runs a script whose expectations say what must hold.
static void holds(const char *text)
{
    scene *s = load(text);
    run_and_hold(s);
    assert_true(scene_expect_count(s) > 0);
    scene_destroy(s);
}

static void every_key_reaches_the_world(void **state)
{
    (void)state;
    scene *s = load(
        "character{ name = 'a', character = { max_slope = 0.5, skin = 0.01, step_height = 0.2,\n"
        "  step_width = 0.1, snap_distance = 0.3, acceleration = 7, air_acceleration = 8,\n"
        "  max_fall_speed = 9, mass = 50, push_force = 60, up = {0, 2}, gravity_scale = 0.5 } }\n"
        "character{ name = 'b', at = {9, 0}, box{1, 2}, character = { steps = false, snap = "
        "false,\n"
        "  push = false, air_control = false, max_slope_deg = 45 } }\n"
        "body{ name = 'c', at = {20, 0}, capsule{1, 0.3}, character = { acceleration = 5 } }\n"
        "body{ name = 'p', type = 'static', at = {30, 0}, box{4, 1}, one_way = {0, 3},\n"
        "  one_way_angle = 0.5 }\n");
    const plumb_world *w = scene_world(s);
    plumb_character_desc d;
    plumb_body a = scene_body_find(s, "a").entity, b = scene_body_find(s, "b").entity;
    assert_int_equal(plumb_character_settings(w, a, &d), PLUMB_OK);
    const plumb_real r[] = { d.max_slope,
                             d.skin,
                             d.step_height,
                             d.step_width,
                             d.snap_distance,
                             d.acceleration,
                             d.air_acceleration,
                             d.max_fall_speed,
                             d.mass,
                             d.push_force,
                             d.up.y };
    const double wanted[] = { 0.5, 0.01, 0.2, 0.1, 0.3, 7, 8, 9, 50, 60, 2 };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        assert_true(r[i] == (plumb_real)wanted[i]);
    }
    assert_true(plumb_body_gravity_scale(w, a) == (plumb_real)0.5);
    assert_int_equal(plumb_body_get_type(w, a), PLUMB_KINEMATIC);
    assert_int_equal(plumb_character_settings(w, b, &d), PLUMB_OK);
    assert_true(d.no_steps && d.no_snap && d.no_push && d.no_air_control);
    assert_near(d.max_slope, 0.7853981633974483, ROUNDED(1e-6));
    assert_true(plumb_body_is_character(w, scene_body_find(s, "c").entity));
    plumb_shape shape;
    plumb_body_shapes(w, scene_body_find(s, "p").entity, &shape, 1);
    plumb_one_way o = plumb_shape_one_way(w, shape);
    assert_true(o.direction.y == 1 && o.angle == (plumb_real)0.5);
    scene_destroy(s);
}

static void heroes_do_as_told(void **state)
{
    (void)state;
    holds("scene{ duration = 6 }\n"
          "body{ type = 'static', box{60, 1}, at = {0, -0.5} }\n"
          "body{ name = 'plank', type = 'static', box{4, 0.2}, at = {6, 1.5}, one_way = {0, 1} }\n"
          "local h = character{ name = 'hero', at = {0, 0.91} }\n"
          "local stood = 0\n"
          "at(0.5, function() h:walk(2) end)\n"
          "at(3, function() h:walk(0); assert(h:jump(6.5)); assert(h:on_ground()) end)\n"
          "at(3.2, function() assert(not h:jump(3)); assert(h:ground() == nil) end)\n"
          "at(4.5, function() local b, nx, ny = h:ground(); assert(b:name() == 'plank')\n"
          "  assert(math.abs(nx) < 0.001 and ny > 0.999); stood = stood + 1\n"
          "  assert(h:drop()); assert(not h:drop()) end)\n"
          "at(5.4, function() h:fly(0, 2) end)\n"
          "at(5.9, function() h:throw(3, 0) end)\n"
          "expect{ 'walked', at = 3, body = 'hero', x = 5, tolerance = 0.04 }\n"
          "expect{ 'up on the plank', at = 4.4, body = 'hero', y = 2.506, tolerance = 0.01 }\n"
          "expect{ 'down again', at = 5.3, body = 'hero', y = 0.906, tolerance = 0.01 }\n"
          "expect{ 'flew', at = 5.9, body = 'hero', y = 1.906, tolerance = 0.05 }\n"
          "expect{ 'stood', test = function() return stood == 1 end }\n");
}

static void bodies_drop(void **state)
{
    (void)state;
    holds("scene{ duration = 3 }\n"
          "body{ type = 'static', box{9, 1}, at = {0, -3} }\n"
          "body{ type = 'static', box{4, 0.2}, one_way = {0, 1} }\n"
          "local b = body{ name = 'crate', box{1, 1}, at = {0, 0.7} }\n"
          "at(1, function() b:drop() end)\n"
          "expect{ 'held', at = 1, body = 'crate', y = 0.6, tolerance = 0.01 }\n"
          "expect{ 'dropped', body = 'crate', y = -2, tolerance = 0.01 }\n");
}

static void queries_answer(void **state)
{
    (void)state;
    holds(
        "scene{ gravity = {0, 0}, duration = 0.1 }\n"
        "local a = body{ name = 'a', type = 'static', box{2, 2} }\n"
        "local b = body{ name = 'b', type = 'static', box{2, 2}, at = {5, 0}, one_way = {0, 1} }\n"
        "local s = body{ name = 's', type = 'static', circle{1}, at = {0, 5}, sensor = true }\n"
        "local n = 0\n"
        "local function near(x, y) n = n + 1; return math.abs(x - y) < 1e-4 end\n"
        "expect{ 'ray', test = function()\n"
        "  local body, x, y, nx, ny, f = ray{ {-5, 0.5}, {5, 0.5} }\n"
        "  return body == a and near(x, -1) and near(y, 0.5) and near(nx, -1) and near(ny, 0)\n"
        "    and near(f, 0.4) and ray{ from = {-5, 3}, to = {5, 3} } == nil\n"
        "    and ray{ {-5, 0}, {20, 0}, ignore = a } == b end }\n"
        "expect{ 'one-way', test = function()\n"
        "  return ray{ {5, -4}, {5, 4} } == b and ray{ {5, -4}, {5, 4}, one_way = true } == nil\n"
        "    and ray{ {5, 4}, {5, -4}, one_way = true } == b end }\n"
        "expect{ 'sensors', test = function()\n"
        "  return ray{ {0, 9}, {0, 4} } == nil and ray{ {0, 9}, {0, 4}, sensors = true } == s end "
        "}\n"
        "expect{ 'cast', test = function()\n"
        "  local body, x, y, nx, ny, f = cast{ box{1, 1}, from = {-5, 0}, to = {0, 0} }\n"
        "  return body == a and near(x, -1) and near(nx, -1) and near(f, 0.7)\n"
        "    and cast{ circle{0.5}, from = {-5, 1.6}, to = {1, 1.6} } == nil end }\n"
        "expect{ 'nearest', test = function()\n"
        "  local body, x, y, d = nearest{ {-3, 0} }\n"
        "  return body == a and near(x, -1) and near(d, 2)\n"
        "    and nearest{ at = {-3, 0}, within = 1 } == nil end }\n"
        "expect{ 'inside', test = function()\n"
        "  local list = inside{ {0.5, 0.5} }\n"
        "  return #list == 1 and list[1] == a and #inside{ {9, 9} } == 0 end }\n");
}

// What JSON can hold comes back: settings, not the orders given.
static void json_keeps_settings(void **state)
{
    (void)state;
    char *text[2];
    size_t size;
    scene *s = load("body{ type = 'static', box{9, 1}, one_way = {0, 1}, one_way_angle = 0.25 }\n"
                    "local h = character{ name = 'hero', at = {0, 1.41},\n"
                    "  character = { acceleration = 5, steps = false, up = {0, 1} } }\n"
                    "h:walk(1)\n");
    steps(s, 30);
    for (int i = 0; i < 2; i++) {
        text[i] = export_json(s, &size);
        scene_destroy(s);
        s = i == 0 ? load_as("a.json", text[0], size, NULL) : NULL;
    }
    assert_string_equal(text[0], text[1]);
    assert_non_null(strstr(text[0], "\"character\":{\"acceleration\":5,\"steps\":false,"));
    assert_non_null(strstr(text[0], "\"one_way\":[0,1],\"one_way_angle\":0.25"));
    s = load_as("a.json", text[0], strlen(text[0]), NULL);
    assert_true(plumb_body_is_character(scene_world(s), scene_body_find(s, "hero").entity));
    scene_destroy(s);
    free(text[0]);
    free(text[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_key_reaches_the_world),
        cmocka_unit_test(heroes_do_as_told),
        cmocka_unit_test(bodies_drop),
        cmocka_unit_test(queries_answer),
        cmocka_unit_test(json_keeps_settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
