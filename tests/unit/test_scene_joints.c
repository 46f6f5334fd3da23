// test_scene_joints.c - joints, filters, sensors, materials and events in the scene language: what
// they do, and that JSON keeps them. How they are misused is in tests/api/test_scene_joint_errors.c.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static void check(const char *text)
{
    scene *s = load(text);
    run_and_hold(s);
    scene_destroy(s);
}

// ----------------------------------------------------------------------------------------- joints

// One of each kind, with every part that it can have; used for JSON as well.
static const char all_kinds[] =
    "scene{ gravity = {0, -9.81}, duration = 2 }\n"
    "local function block(name, x, y)\n"
    "  return body{ name = name, box{0.6, 0.4}, at = {x, y}, density = 2 } end\n"
    "revolute{ block('a1', 0, 0), block('a2', 0.7, 0), at = {0.35, 0}, limits = {-1, 1},\n"
    "  motor = { speed = 2, torque = 3 }, spring = { frequency = 2, damping = 0.3, rest = 0.1 },\n"
    "  name = 'hinge', break_force = 1e6, break_torque = 1e6, collide = true, hidden = true }\n"
    "revolute{ 'a1', at = {-0.3, 0} }\n"
    "prismatic{ world, block('b', 3, 0), axis = {1, 1}, limits = {-0.5, 0.7},\n"
    "  motor = { speed = -1, force = 2 }, spring = { frequency = 1, damping = 0.1, rest = 0.2 } }\n"
    "weld{ block('c1', 6, 0), block('c2', 6.6, 0), at = {6.3, 0}, spring = { frequency = 3 } }\n"
    "weld{ 'c1', world }\n"
    "wheel{ block('d1', 9, 1), block('d2', 9, 0), axis = {0, 1}, limits = {-0.2, 0.2},\n"
    "  motor = { speed = 5, torque = 1 }, spring = { frequency = 4, damping = 0.7 } }\n"
    "distance{ world, block('e1', 12, 0), at_a = {12, 2}, limits = {0, 1.8} }\n"
    "distance{ 'e1', block('e2', 12, -2), at_a = {12.1, -0.2}, length = 1.5,\n"
    "  spring = { frequency = 2, damping = 0.2 } }\n"
    "mouse{ block('f', 15, 0), at = {15.2, 0.1}, target = {16, 1}, max_force = 100,\n"
    "  spring = { frequency = 3, damping = 0.9 } }\n"
    "motor{ world, block('g', 18, 0), angle = 0.5, offset = {0.2, 0.3}, max_force = 50,\n"
    "  max_torque = 20 }\n"
    "local h1 = revolute{ block('h1', 21, 0), motor = { speed = 3, torque = 100 } }\n"
    "local h2 = revolute{ block('h2', 22, 0) }\n"
    "local h3 = prismatic{ block('h3', 22, 2), axis = {1, 0} }\n"
    "gear{ h1, h2, ratio = -2 }\n"
    "gear{ h1, h3, ratio = 0.5 }\n"
    "pulley{ block('i1', 25, 0), block('i2', 27, -1), wheel_a = {25, 3}, wheel_b = {27, 3},\n"
    "  ratio = 2 }\n"
    "revolute{ block('j', 30, 0), at = {29.8, 0} }\n"
    "ratchet{ 'j', pitch = 0.3 }\n"
    "friction{ block('k', 33, 0), at = {33.1, 0}, max_force = 4, max_torque = 0.3 }\n"
    "cable{ world, block('l', 36, 0), at_a = {36.5, 3}, radius_a = 0.3, radius_b = -0.1,\n"
    "  length = 3.5 }\n"
    "cable{ block('m1', 39, 0), block('m2', 41, 1), radius_a = -0.2, radius_b = -0.2 }\n";

static void test_every_kind(void **state)
{
    (void)state;
    scene *s = load(all_kinds);
    plumb_world *w = scene_world(s);
    plumb_joint list[64];
    int count = plumb_world_joints(w, list, 64);
    assert_int_equal(count, 21);
    bool seen[32] = { false };
    for (int i = 0; i < count; i++) {
        seen[plumb_joint_get_kind(w, list[i])] = true;
    }
    for (int k = 0; plumb_joint_kind_name((plumb_joint_kind)k) != NULL; k++) {
        assert_true(seen[k]);
    }
    plumb_joint_desc d;
    assert_int_equal(plumb_joint_settings(w, list[0], &d), PLUMB_OK);
    assert_true(d.enable_limit && d.enable_motor && d.collide_connected);
    assert_true(d.motor_speed == 2 && d.max_motor == 3 && d.hertz == 2 && d.break_force > 0);
    assert_true(plumb_is_null(plumb_joint_body_a(w, list[1]))); // one body hangs on the world
    assert_true(plumb_same(plumb_joint_body_b(w, list[1]), scene_body_find(s, "a1").entity));
    run_and_hold(s);
    scene_destroy(s);
}

static void test_joint_methods(void **state)
{
    (void)state;
    check(
        "scene{ gravity = {0, 0}, duration = 1 }\n"
        "local b = body{ name = 'b', box{1, 0.2}, at = {0.5, 0} }\n"
        "local j = revolute{ b, at = {0, 0}, motor = { speed = 1, torque = 1000 }, name = 'j',\n"
        "  tell_impulse = true }\n"
        "local x, y, turn = j:impulse()\n"
        "assert(x == 0 and y == 0 and turn == 0)\n"
        "at(0.5, function() local x, y, turn = j:impulse() assert(turn ~= 0 or x ~= 0) end)\n"
        "assert(j:name() == 'j' and j:kind() == 'revolute' and j:alive() and tostring(j) == 'j')\n"
        "assert(j:a() == world and j:b() == b and find_joint('j') == j)\n"
        "assert(find_joint('k') == nil and joint_count() == 1)\n"
        "local x, y = j:anchor_b() assert(x == 0 and y == 0)\n"
        "local rod = distance{ b, world, at_b = {5, 0} } assert(rod:value() == 4.5)\n"
        "rod:destroy() assert(not rod:alive() and tostring(rod) == 'joint that is gone')\n"
        "at(0.5, function()\n"
        "  assert(math.abs(j:angle() - 0.5) < 0.01 and j:angle() == j:value())\n"
        "  assert(j:error() < 1e-3 and j:reaction() > 0)\n"
        "  local fx, fy = j:force() assert(math.abs(math.sqrt(fx*fx + fy*fy) - j:reaction()) < "
        "1e-6)\n"
        "  assert(j:torque() ~= nil)\n"
        "  j:set_motor_speed(-1) end)\n"
        "at(0.75, function() assert(math.abs(j:angle() - 0.25) < 0.02)\n"
        "  j:set_motor() j:set_limits(0, 0.1) end)\n"
        "at(0.9, function() j:set_limits() j:set_spring(5, 1, 0.3) j:set_rest(0.2)\n"
        "  j:set_restitution(0.5) j:set_stiffness(20, 1, 0.3) j:set_rest(0.25) j:set_spring(5, 1, "
        "0.2)\n"
        "  j:set_break(1e9, 1e9) end)\n"
        "local m = mouse{ b, at = {1, 0} } m:set_target(1, 0) m:set_target{1, 0} m:destroy()\n");
}

static void test_joints_go_with_bodies(void **state)
{
    (void)state;
    scene *s = load("local a = body{ name = 'a', box{1, 1} }\n"
                    "local b = body{ name = 'b', box{1, 1}, at = {2, 0} }\n"
                    "weld{ a, b, name = 'w' } weld{ b, world }\n"
                    "at(0.1, function() a:destroy() score('left', joint_count())\n"
                    "  assert(find_joint('w') == nil) weld{ b, world, name = 'w' } end)");
    steps(s, 12);
    assert_true(score(s, "left") == 1);
    assert_int_equal(plumb_world_joints(scene_world(s), NULL, 0), 2);
    scene_destroy(s);
}

static void test_breaking(void **state)
{
    (void)state;
    check("scene{ duration = 1 }\n"
          "local b = body{ name = 'b', box{1, 1}, mass = 10 }\n"
          "local j = weld{ b, world, name = 'thread1', break_force = 50 }\n"
          "weld{ body{ box{1, 1}, at = {3, 0}, mass = 1 }, world, name = 'thread2', break_force = "
          "50 }\n"
          "on_break{ joint = 'thread*', function(name, e)\n"
          "  assert(name == 'thread1' and e.a == b or e.b == b)\n"
          "  assert(e.kind == 'weld' and (e.a == world or e.b == world) and not j:alive())\n"
          "  assert(math.sqrt(e.fx^2 + e.fy^2) > 50 and e.x == 0 and e.torque)\n"
          "  score('broken', score('broken') + 1) end }\n"
          "on_break{ joint = 'thread2', function() error('it holds') end }\n"
          "expect{ 'one breaks', broken = 1 }\n"
          "expect{ 'by name', joint = 'thread1', broken = 1 }\n"
          "expect{ 'the other holds', joint = 'thread2', broken = 0 }\n"
          "expect{ 'carries its weight', joint = 'thread2', at = 0.5, reaction = 9.81,\n"
          "  tolerance = 0.01 }\n"
          "expect{ 'score', score = 'broken', value = 1 }\n");
}

// Told as the load comes, not while it lasts; the joint holds on.
static void test_strain(void **state)
{
    (void)state;
    check("scene{ duration = 1 }\n"
          "local b = body{ name = 'b', box{1, 1}, mass = 10 }\n"
          "local j = weld{ b, world, name = 'thread1', event_force = 50 }\n"
          "weld{ body{ box{1, 1}, at = {3, 0}, mass = 1 }, world, name = 'thread2', event_force = "
          "50 }\n"
          "on_strain{ joint = 'thread*', function(name, e)\n"
          "  assert(name == 'thread1' and (e.a == b or e.b == b) and j:alive())\n"
          "  assert(e.kind == 'weld' and math.sqrt(e.fx^2 + e.fy^2) > 50)\n"
          "  score('strained', score('strained') + 1)\n"
          "  find_joint(name):destroy() end }\n"
          "on_strain{ joint = 'thread2', function() error('it is slack') end }\n"
          "on_break(function() error('none breaks') end)\n"
          "expect{ 'once', score = 'strained', value = 1 }\n"
          "expect{ 'none broke', broken = 0 }\n");
}

static void test_expectations(void **state)
{
    (void)state;
    scene *s = load("scene{ duration = 0.5 }\n"
                    "weld{ body{ box{1, 1}, mass = 2 }, world, name = 'w' }\n"
                    "expect{ 'value', joint = 'w', joint_value = 0, tolerance = 1e-3 }\n"
                    "expect{ 'error', max_joint_error = 1e-9 }\n"
                    "expect{ 'reaction', joint = 'w', reaction = {30, 40} }\n"
                    "expect{ 'torque', joint = 'w', reaction_torque = 0, tolerance = 1e-3 }\n"
                    "expect{ 'none left', joint = 'w*', joint_value = {-1, 1} }\n"
                    "at(0.4, function() if false then find_joint('w'):destroy() end end)");
    static const bool expected[] = { true, false, false, true, true };
    scene_error e = { 0 };
    while (!scene_done(s)) {
        assert_int_equal(scene_step(s, &e), SCENE_OK);
    }
    assert_int_equal(scene_finish(s, &e), SCENE_OK);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(scene_expect_get(s, i).passed, expected[i]);
    }
    assert_string_equal(scene_expect_get(s, 2).quantity, "w.reaction");
    assert_near(scene_expect_get(s, 2).measured, 2 * 9.81, ROUNDED(1e-2));
    scene_destroy(s);
    s = load("scene{ duration = 0.2 }\nweld{ body{ box{1, 1} }, world, name = 'w' }\n"
             "expect{ 'gone', joint = 'w', joint_value = 0 }\n"
             "at(0.1, function() find_joint('w'):destroy() end)");
    while (!scene_done(s)) {
        assert_int_equal(scene_step(s, &e), SCENE_OK);
    }
    assert_int_equal(scene_finish(s, &e), SCENE_OK);
    assert_int_equal(scene_expect_get(s, 0).status, SCENE_EXPECT_FAILED);
    scene_destroy(s);
}

// ------------------------------------------------------------------------------ filters, sensors

// Five pairs fall onto floors of their own; who passes tells which rule held.
static void test_filters(void **state)
{
    (void)state;
    check("scene{ duration = 1 }\n"
          "local function floor(x, keys) keys.type = 'static' keys[1] = box{2, 1}\n"
          "  keys.at = {x, -0.5} return body(keys) end\n"
          "local function ball(name, x, keys) keys.name = name keys[1] = keys[1] or circle{0.3}\n"
          "  keys.at = {x, 0.5} return body(keys) end\n"
          "floor(0, { category = 'floor' }) ball('ignores', 0, { ignores = 'floor' })\n"
          "floor(4, { category = {'floor', 'red'} })\n"
          "ball('collides', 4, { collides = {'red', 'default'} })\n"
          "floor(8, {}) ball('nothing', 8, { collides = {} })\n"
          "floor(12, { apart = 'x' }) ball('apart', 12, { apart = 'x' })\n"
          "floor(16, { together = 'y', collides = {} })\n"
          "ball('together', 16, { together = 'y', collides = {} })\n"
          "floor(20, { category = 'floor' })\n"
          "ball('shape', 20, { circle{0.3, ignores = {}}, ignores = 'floor' })\n"
          "local f = floor(24, {}) exclude(f, ball('excluded', 24, {}))\n"
          "local g = floor(28, { name = 'g' }) exclude(g, ball('again', 28, {}))\n"
          "exclude('again', 'g', false)\n"
          "ball('later', 32, { collides = {} }) floor(32, {})\n"
          "find('later'):set_filter{ collides = 'default' }\n"
          "for _, name in ipairs{ 'collides', 'together', 'shape', 'again', 'later' } do\n"
          "  expect{ name .. ' lands', body = name, y = 0.3, tolerance = 0.01 } end\n"
          "for _, name in ipairs{ 'ignores', 'nothing', 'apart', 'excluded' } do\n"
          "  expect{ name .. ' falls', body = name, y = {-9, -1} } end\n");
}

static void test_sensors(void **state)
{
    (void)state;
    check("scene{ duration = 2, gravity = {0, 0} }\n"
          "local zone = body{ name = 'zone', type = 'static', sensor = true, box{1, 2}, at = {2, "
          "0} }\n"
          "local ball = body{ name = 'ball1', circle{0.2}, velocity = {2, 0} }\n"
          "body{ name = 'ball2', circle{0.2}, at = {-2, 0}, velocity = {2, 0}, apart = 'no' }\n"
          "on_enter{ a = 'zone', b = 'ball1', function(z, b) assert(z == zone and b == ball)\n"
          "  score('in', time()) end }\n"
          "on_leave{ a = 'zone', function(z, b) score('out', score('out') + 1) end }\n"
          "on_enter{ a = 'ball*', function() error('a is the sensor') end }\n"
          "at(1, function() assert(#zone:overlaps() == 1 and zone:overlaps()[1] == ball) end)\n"
          "expect{ 'sees both', body = 'zone', visits = 2 }\n"
          "expect{ 'one after the other', at = 1, body = 'zone', inside = 1 }\n"
          "expect{ 'the second is in it', body = 'zone', inside = 1 }\n"
          "expect{ 'is not stopped', body = 'ball1', vx = 2, tolerance = 1e-6 }\n"
          "expect{ 'one left', score = 'out', value = 1 }\n"
          "expect{ 'in time', score = 'in', value = 0.65, tolerance = 0.02 }\n");
}

// --------------------------------------------------------------------------- materials, contacts

static void test_materials(void **state)
{
    (void)state;
    check("scene{ duration = 3 }\n"
          "local rough = material{ name = 'rough', friction = 0.8 }\n"
          "local belt = material{ name = 'belt', friction = 0.8, surface_speed = 1.5 }\n"
          "local ice = material{ name = 'ice', friction = 0.8, friction_mix = 'average' }\n"
          "local soft = material{ name = 'soft', friction = 0.8, rolling_resistance = 0.05 }\n"
          "local bouncy = material{ name = 'bouncy', restitution = 0.8, restitution_mix = 'min' }\n"
          "material_pair{ rough, ice, friction = 0 }\n"
          "local function lane(y, floor, m, shape, v)\n"
          "  body{ type = 'static', box{60, 0.2}, at = {0, y - 0.1}, material = floor }\n"
          "  return body{ shape, at = {0, y + 0.2}, material = m, velocity = {v, 0} } end\n"
          "local a = lane(0, belt, rough, box{0.6, 0.4}, 0)\n"
          "local b = lane(3, ice, rough, box{0.6, 0.4}, 2)\n"
          "local c = lane(6, soft, soft, circle{0.2}, 2)\n"
          "local d = lane(9, rough, bouncy, circle{0.2}, 0)\n"
          "expect{ 'carried', body = a:name(), vx = 1.5, tolerance = 0.02 }\n"
          "expect{ 'slides for ever', body = b:name(), vx = 2, tolerance = 1e-4 }\n"
          "expect{ 'ceases to roll', body = c:name(), vx = 0, tolerance = 0.01 }\n"
          "expect{ 'does not bounce', from = 1, body = d:name(), y = 9.2, tolerance = 0.01 }\n"
          "at(2.5, function() belt:set{ surface_speed = 0 } end)\n"
          "at(2.4, function() assert(math.abs((a:velocity()) - 1.5) < 0.02)\n"
          "  belt:set{ surface_speed = 1.5 } end)\n"
          "at(2.6, function() assert((a:velocity()) < 1.0) belt:set{ surface_speed = 1.5 } end)\n");
}

static void test_hits_and_edits(void **state)
{
    (void)state;
    check(
        "scene{ duration = 2 }\n"
        "body{ name = 'floor', type = 'static', box{20, 1}, at = {0, -0.5} }\n"
        "body{ name = 'ball', circle{0.5}, at = {0, 2.5}, mass = 2 }\n"
        "body{ name = 'ghost', circle{0.5}, at = {3, 2.5} }\n"
        "body{ name = 'slider', box{1, 1}, at = {-9, 0.5}, velocity = {3, 0} }\n"
        "on_hit{ a = 'ball', b = 'floor', speed = 3, function(a, b, c)\n"
        "  assert(a:name() == 'ball' and c.ny < -0.99)\n"
        "  score('speed', c.speed) score('impulse', c.impulse) score('time', c.time) end }\n"
        "on_hit{ speed = 100, function() error('too slow for this') end }\n"
        "edit_contact{ a = 'ghost', b = 'floor', function(a, b, c)\n"
        "  assert(a:name() == 'ghost' and c.enabled and math.abs(c.friction - 0.6) < 1e-6)\n"
        "  c.enabled = false end }\n"
        "edit_contact{ a = 'floor', b = 'slider', function(floor, slider, c) c.friction = 0 end }\n"
        "expect{ 'speed', score = 'speed', value = 6.2642, tolerance = 0.2 }\n"
        "expect{ 'impulse', score = 'impulse', value = 12.53, tolerance = 0.4 }\n"
        "expect{ 'time', score = 'time', value = 0.63855, tolerance = 1e-3 }\n"
        "expect{ 'falls through', body = 'ghost', y = {-100, -1} }\n"
        "expect{ 'does not rub', body = 'slider', vx = 3, tolerance = 1e-4 }\n");
}

// What goes wrong within a step is told when the step is over, and the scene stays failed.
static void test_edit_errors(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "c.friction = 'high'",
          "test.lua:3:1: 'friction' of a contact must be a number, not a string" },
        { "c.restitution = 11",
          "test.lua:3:1: edit_contact: restitution is 11; it must be 0 to 10" },
        { "c.enabled = nil",
          "test.lua:3:1: 'enabled' of a contact must be true or false, not nothing" },
        { "body{ box{1, 1} }", NULL },
        { "error('no')", "test.lua:3:1: no" },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[400];
        snprintf(text, sizeof text,
                 "body{ type = 'static', box{9, 1} }\nbody{ circle{0.5}, at = {0, 1} }\n"
                 "edit_contact(function(a, b, c) %s end)",
                 rows[i][0]);
        scene *s = load(text);
        scene_error e = { 0 };
        scene_error again = { 0 };
        assert_int_not_equal(scene_step(s, &e), SCENE_OK);
        if (rows[i][1] != NULL) {
            assert_string_equal(e.text, rows[i][1]);
        }
        assert_int_equal(scene_step(s, &again), e.code);
        assert_string_equal(again.text, e.text);
        scene_destroy(s);
    }
}

// ------------------------------------------------------------------------------------------- JSON

// Both scenes are in the same state, to the bit.
static void assert_same_state(const scene *a, const scene *b)
{
    assert_int_equal(scene_body_count(a), scene_body_count(b));
    for (int i = 0; i < scene_body_count(a); i++) {
        plumb_body p = scene_body_get(a, i).entity, q = scene_body_get(b, i).entity;
        plumb_transform t = plumb_body_transform(scene_world(a), p);
        plumb_transform u = plumb_body_transform(scene_world(b), q);
        plumb_vec2 v = plumb_body_velocity(scene_world(a), p);
        plumb_vec2 w = plumb_body_velocity(scene_world(b), q);
        assert_true(t.p.x == u.p.x && t.p.y == u.p.y && t.q.c == u.q.c && t.q.s == u.q.s);
        assert_true(v.x == w.x && v.y == w.y);
    }
}

// What is read back runs as what was written, bit by bit, and writes the same bytes.
static void check_json(const char *text)
{
    scene *s = load(text);
    size_t size, again_size;
    char *json = export_json(s, &size);
    scene *copy = load_as("test.json", json, size, NULL);
    char *again = export_json(copy, &again_size);
    assert_string_equal(again, json);
    steps(s, 90);
    steps(copy, 90);
    assert_same_state(s, copy);
    free(json);
    free(again);
    scene_destroy(copy);
    json = export_json(s, &size); // in the middle of the run: what joints know of their past
    copy = load_as("test.json", json, size, NULL);
    again = export_json(copy, &again_size);
    assert_string_equal(again, json);
    plumb_joint mine[64], theirs[64];
    int count = plumb_world_joints(scene_world(s), mine, 64);
    assert_int_equal(plumb_world_joints(scene_world(copy), theirs, 64), count);
    for (int i = 0; i < count; i++) { // full turns included
        double v = (double)plumb_joint_value(scene_world(s), mine[i]);
        double w = (double)plumb_joint_value(scene_world(copy), theirs[i]);
        assert_near(v, w, 2e-5 * (1 + fabs(v)));
    }
    free(json);
    free(again);
    scene_destroy(copy);
    scene_destroy(s);
}

static void test_json_joints(void **state)
{
    (void)state;
    check_json(all_kinds);
}

static void test_json_others(void **state)
{
    (void)state;
    check_json(
        "scene{ duration = 2 }\n"
        "local ice = material{ name = 'ice', friction = 0.02, friction_mix = 'min' }\n"
        "local belt = material{ surface_speed = -1/3, rolling_resistance = 0.01,\n"
        "  restitution = 0.1, restitution_mix = 'average' }\n"
        "material_pair{ ice, belt, friction = 0.3, restitution = 0.2 }\n"
        "body{ name = 'floor', type = 'static', box{30, 1}, at = {0, -0.5}, material = belt,\n"
        "  category = {'ground', 'belt'} }\n"
        "for i = 1, 8 do body{ name = 'b' .. i, box{0.5, 0.5}, at = {i * 0.4, i * 0.6},\n"
        "  material = i % 2 == 0 and ice or belt, category = 'crate', apart = i > 6 and 'top'\n"
        "  or nil, ignores = i == 3 and {} or nil } end\n"
        "body{ name = 'ghost', circle{0.4}, at = {-3, 2}, collides = {} }\n"
        "body{ name = 'eye', type = 'static', box{3, 3, sensor = true, collides = {'crate',\n"
        "  'default'}}, circle{0.1, at = {0, 5}, together = 'all'} }\n"
        "exclude('b1', 'b2') exclude(find('b4'), 'b5')\n"
        "expect{ 'x', body = 'eye', inside = {0, 9}, visits = {0, 99} }\n"
        "expect{ 'y', max_joint_error = 1, broken = 0 }\n");
}

// Limits, motors and the like as handlers left them.
static void test_json_after_setters(void **state)
{
    (void)state;
    check_json(
        "scene{ duration = 9, gravity = {0, 0} }\n"
        "local j = revolute{ body{ box{1, 0.1}, at = {0.5, 0} }, at = {0, 0}, limits = {0, 1},\n"
        "  motor = { speed = 1, torque = 5 } }\n"
        "j:set_limits() j:set_motor(9, 50) j:set_spring(1, 0.5, 2) j:set_break(1e7, 1e8)\n"
        "local m = mouse{ body{ circle{0.5}, at = {9, 9} } } m:set_target(8, 9)\n");
}

// Whatever the limit, a scene loads and runs or says that its memory is used up; nothing leaks.
static void test_memory_running_out(void **state)
{
    (void)state;
    static const char text[] =
        "local a = body{ name = 'a', box{1, 1}, category = 'x', apart = 'g' }\n"
        "local b = body{ name = 'b', box{1, 1}, at = {0, 2}, collides = {'x', 'y'} }\n"
        "body{ name = 'z', type = 'static', sensor = true, box{9, 9}, category = 'y' }\n"
        "for i = 1, 20 do weld{ a, b, name = 'w' .. i, break_force = 0.001 } end exclude(a, b)\n"
        "on_break(function() end) on_enter(function() end) on_hit(function() end)\n"
        "edit_contact(function(p, q, c) c.friction = 0 end)\n"
        "expect{ 'broken', broken = 20 }";
    bool done = false;
    int refused = 0;
    for (size_t limit = 20000; !done; limit += 3001) {
        scene *s = NULL;
        scene_error e = { 0 };
        scene_load(&(scene_options){ .path = "m.lua",
                                     .text = text,
                                     .text_size = sizeof text - 1,
                                     .memory_limit = limit },
                   &s, &e);
        for (int i = 0; i < 5 && s != NULL && e.code == SCENE_OK; i++) {
            scene_step(s, &e);
        }
        done = s != NULL && e.code == SCENE_OK;
        refused += !done;
        if (!done && e.code != SCENE_E_LIMIT) {
            printf("%zu: %s\n", limit, e.text);
        }
        assert_true(done || e.code == SCENE_E_LIMIT);
        scene_destroy(s);
    }
    assert_true(refused > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_kind),
        cmocka_unit_test(test_joint_methods),
        cmocka_unit_test(test_joints_go_with_bodies),
        cmocka_unit_test(test_breaking),
        cmocka_unit_test(test_strain),
        cmocka_unit_test(test_expectations),
        cmocka_unit_test(test_filters),
        cmocka_unit_test(test_sensors),
        cmocka_unit_test(test_materials),
        cmocka_unit_test(test_hits_and_edits),
        cmocka_unit_test(test_edit_errors),
        cmocka_unit_test(test_json_joints),
        cmocka_unit_test(test_json_others),
        cmocka_unit_test(test_json_after_setters),
        cmocka_unit_test(test_memory_running_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
