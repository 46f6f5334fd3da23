// test_scene.c - what the scene language does: constructors, handlers, expectations, determinism,
// JSON. The messages of malformed scenes are in tests/api/test_scene_errors.c.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

// ---------------------------------------------------------------------------------- constructors

static void test_settings(void **state)
{
    (void)state;
    scene *s =
        load("scene{ title = 'T', description = 'D', gravity = {1, -2}, y = 'down', dt = 0.01,"
             " duration = 3, solver = 'pgs', substeps = 2, seed = 5 }");
    scene_info info = scene_get_info(s);
    assert_string_equal(info.title, "T");
    assert_string_equal(info.description, "D");
    assert_near(info.dt, 0.01, 0);
    assert_near(info.duration, 3, 0);
    assert_int_equal(info.y_axis, PLUMB_Y_DOWN);
    assert_int_equal(info.solver, PLUMB_SOLVER_PGS);
    assert_int_equal(info.substeps, 2);
    assert_int_equal(info.seed, 5);
    assert_true(plumb_world_gravity(scene_world(s)).x == (plumb_real)1);
    scene_destroy(s);
    s = load("body{ box{1, 1} }"); // everything by default; zero gravity is zero
    assert_string_equal(scene_get_info(s).title, "test");
    assert_near(scene_get_info(s).dt, 1.0 / 60, 0);
    assert_true(plumb_world_gravity(scene_world(s)).y < (plumb_real)-9.8);
    scene_destroy(s);
    s = load("scene{ gravity = {0, 0} }");
    assert_true(plumb_world_gravity(scene_world(s)).y == (plumb_real)0);
    assert_true(plumb_world_settings(scene_world(s)).wrap_x == (plumb_real)0);
    scene_destroy(s);
    s = load("scene{ wrap_x = 20, wrap_y = 12.5 }\nbody{ name = 'b', circle{1}, at = {19, 0} }");
    assert_true(plumb_world_settings(scene_world(s)).wrap_x == (plumb_real)20);
    assert_true(plumb_world_settings(scene_world(s)).wrap_y == (plumb_real)12.5);
    assert_true(plumb_body_position(scene_world(s), scene_body_get(s, 0).entity).x ==
                (plumb_real)-1);
    scene_destroy(s);
}

static void test_bodies_and_shapes(void **state)
{
    (void)state;
    scene *s = load("local m = material{ density = 2, friction = 0.25 }\n"
                    "body{ name = 'a', box{2, 3}, at = {1, 2}, angle_deg = 90, material = m }\n"
                    "body{ circle{0.5}, capsule{1, 0.2, at = {2, 0}}, regular(6, 1), mass = 7 }\n"
                    "body{ type = 'static', segment{{0, 0}, {1, 0}}, chain{{0, 0}, {1, 1}, {2, 0}, "
                    "closed = true} }\n"
                    "body{ type = 'kinematic', outline{{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}},"
                    " polygon{{0, 0}, {1, 0}, {0, 1}, round = 0.1}, velocity = {1, 0}, hidden = "
                    "true, color = '#0a0B0c' }\n");
    assert_int_equal(scene_body_count(s), 4);
    scene_body a = scene_body_find(s, "a");
    plumb_world *w = scene_world(s);
    assert_true(a.is_named);
    assert_near((double)plumb_body_mass(w, a.entity), 12, ROUNDED(1e-5));
    assert_near((double)plumb_body_angle(w, a.entity), 1.5707963, 1e-6);
    scene_body b = scene_body_get(s, 1);
    assert_string_equal(b.name, "body2");
    assert_false(b.is_named);
    assert_near((double)plumb_body_mass(w, b.entity), 7, ROUNDED(1e-5));
    assert_int_equal(plumb_body_shapes(w, b.entity, NULL, 0), 3);
    scene_body k = scene_body_get(s, 3);
    assert_true(k.hidden);
    assert_int_equal(k.color.g, 0x0b);
    assert_int_equal(k.color.a, 255);
    assert_int_equal(plumb_body_get_type(w, k.entity), PLUMB_KINEMATIC);
    assert_true(plumb_same(scene_body_of(s, a.entity).entity, a.entity));
    assert_true(plumb_is_null(scene_body_find(s, "nobody").entity));
    assert_true(plumb_is_null(scene_body_get(s, 99).entity));
    scene_destroy(s);
}

static void test_params_and_sets(void **state)
{
    (void)state;
    const char *text = "local n = param('n', 3, 1, 9)\nlocal title = param('who', 'x')\n"
                       "for i = 1, n do body{ circle{1}, at = {3 * i, 0} } end\ntext(title)";
    scene *s = load(text);
    assert_int_equal(scene_body_count(s), 3);
    assert_int_equal(scene_param_count(s), 2);
    assert_string_equal(scene_param_get(s, 0).value, "3");
    assert_false(scene_param_get(s, 0).overridden);
    scene_destroy(s);
    s = load_as("test.lua", text, strlen(text), "n=5");
    assert_int_equal(scene_body_count(s), 5);
    assert_true(scene_param_get(s, 0).overridden);
    scene_destroy(s);
    s = load_as("test.lua", text, strlen(text), "who=12");
    assert_string_equal(scene_get_text(s), "12");
    scene_destroy(s);
    s = load_as("test.lua", text, strlen(text), "gravity=0,-1");
    assert_true(plumb_world_gravity(scene_world(s)).y == (plumb_real)-1);
    scene_destroy(s);
}

static void test_camera(void **state)
{
    (void)state;
    scene *s =
        load("body{ name = 'b', circle{1} }\ncamera{ center = {1, 2}, height = 5, follow = 'b' }");
    scene_camera c = scene_get_camera(s);
    assert_true(c.has_view && !c.has_fit && c.center[1] == 2.0 && c.height == 5.0);
    assert_string_equal(c.follow, "b");
    scene_destroy(s);
    s = load("body{ circle{1} }\ncamera{ fit = {{3, 4}, {1, 2}} }");
    c = scene_get_camera(s);
    assert_true(c.has_fit && c.box[0] == 1.0 && c.box[3] == 4.0);
    scene_destroy(s);
}

// -------------------------------------------------------------------------------------- handlers

static void test_timed_handlers(void **state)
{
    (void)state;
    scene *s = load("scene{ duration = 1, dt = 0.01 }\nbody{ circle{1} }\n"
                    "at(0.5, function(t) score('at', t) end)\n"
                    "every(0.1, function() score('every', score('every') + 1) end)\n"
                    "every_step(function() score('steps', score('steps') + 1) end)\n"
                    "at(0.25, function() at(0.3, function(t) score('nested', t) end) end)");
    run(s);
    assert_near(score(s, "at"), 0.5, 1e-9);
    assert_near(score(s, "every"), 9, 0); // at 0.1 ... 0.9; 1.0 is the end
    assert_near(score(s, "steps"), 100, 0);
    assert_near(score(s, "nested"), 0.3, 1e-9);
    assert_true(scene_time(s) == 1.0);
    scene_destroy(s);
}

static void test_contact_handlers(void **state)
{
    (void)state;
    scene *s =
        load("scene{ duration = 2 }\n"
             "body{ name = 'floor', type = 'static', box{10, 1}, at = {0, -0.5} }\n"
             "body{ name = 'ball1', circle{0.5}, at = {0, 1} }\nbody{ name = 'ball2', circle{0.5}, "
             "at = {3, 1} }\n"
             "on_contact(function() score('all', score('all') + 1) end)\n"
             "on_contact{ a = 'floor', b = 'ball*', function(a, b, c)\n"
             "  assert(a:name() == 'floor' and b:name():find('ball', 1))\n"
             "  assert(c.ny > 0.99 and c.speed > 2)\n  score('balls', score('balls') + 1) end }\n"
             "on_contact{ a = find('ball2'), function(a) score('destroyed', 1) a:destroy()\n"
             "  body{ name = 'new', circle{0.2}, at = {0, 5} } end }\n"
             "on_end{ a = 'ball1', function(a, b) score('end', 1) end }\n"
             "at(1.5, function() find('ball1'):teleport(0, 9) end)");
    run(s);
    assert_true(score(s, "all") >= 2);
    assert_near(score(s, "balls"), 2, 0);
    assert_near(score(s, "destroyed"), 1, 0);
    assert_near(score(s, "end"), 1, 0);
    assert_true(plumb_is_null(scene_body_find(s, "ball2").entity));
    assert_false(plumb_is_null(scene_body_find(s, "new").entity));
    assert_int_equal(scene_body_count(s), 3);
    scene_destroy(s);
}

static void test_body_methods(void **state)
{
    (void)state;
    scene *s = load(
        "scene{ gravity = {0, 0}, duration = 0.1 }\n"
        "local b = body{ name = 'b', box{1, 1}, at = {1, 2}, user = { health = 3 } }\n"
        "local x, y = b:position() assert(x == 1 and y == 2)\n"
        "b:set_velocity(3, 4) assert(b:speed() == 5)\nb:set_velocity{0, 0}\n"
        "b:apply_impulse(2 * b:mass(), 0) assert((b:velocity()) == 2)\n"
        "b:set_spin(1) assert(b:spin() == 1)\nb:teleport(0, 0, 0.5) assert(math.abs(b:angle() - "
        "0.5) < 1e-6)\n"
        "b:set_mass(4) assert(b:mass() == 4)\nb.user.health = b.user.health - 1 "
        "assert(b.user.health == 2)\n"
        "b:set_gravity_scale(0) b:set_fixed_rotation(true) b:set_label('hi') b:set_color(4) "
        "b:set_continuous(true)\n"
        "b:apply_force(1, 0) b:apply_torque(1) b:apply_angular_impulse(0) assert(b:inertia() == "
        "0)\n"
        "assert(b:type() == 'dynamic' and b:name() == 'b' and tostring(b) == 'b' and b:alive())\n"
        "assert(find('b') == b and find('c') == nil and body_count() == 1)\n"
        "local d = body{ circle{1}, at = {9, 9} } d:destroy() assert(not d:alive() and tostring(d) "
        "== 'destroyed body')\n"
        "local kinetic = energy() assert(kinetic > 0 and (momentum()) > 7 and penetration() == 0 "
        "and time() == 0)");
    scene_body b = scene_body_find(s, "b");
    assert_string_equal(b.label, "hi");
    assert_int_equal(b.palette, 4);
    run(s);
    scene_destroy(s);
}

// ----------------------------------------------------------------------------------- expectations

static void test_expectations(void **state)
{
    (void)state;
    scene *s =
        load("scene{ gravity = {0, 0}, duration = 1, dt = 0.01 }\n"
             "body{ name = 'b', circle{0.5}, velocity = {2, 0} }\n"
             "expect{ 'right place', at = 0.5, body = 'b', position = {1, 0}, tolerance = 1e-4 }\n"
             "expect{ 'wrong place', at = 0.5, body = 'b', position = {3, 0}, tolerance = 0.5 }\n"
             "expect{ 'in a window', from = 0.4, till = 0.6, body = 'b', x = {0.79, 1.21} }\n"
             "expect{ 'leaves the window', from = 0.4, till = 0.7, body = 'b', x = {0.79, 1.21} }\n"
             "expect{ 'speed', always = true, min_speed = 1.9, max_speed = 2.1 }\n"
             "expect{ 'at the end', body = 'b', vx = 2, tolerance = 1e-5, energy_drift = 1e-5, "
             "momentum_drift = 1e-5 }\n"
             "expect{ 'count', count = 1 }\nexpect{ 'score', score = 's', value = {1, 2} }\n"
             "expect{ 'test', test = function() return true, 4, 5 end }\n"
             "expect{ 'test fails', test = function() return false, 7, 5 end }\nscore('s', 3)\n");
    static const scene_expect_status expected[] = {
        SCENE_EXPECT_PASSED, SCENE_EXPECT_FAILED, SCENE_EXPECT_PASSED, SCENE_EXPECT_FAILED,
        SCENE_EXPECT_PASSED, SCENE_EXPECT_PASSED, SCENE_EXPECT_PASSED, SCENE_EXPECT_FAILED,
        SCENE_EXPECT_PASSED, SCENE_EXPECT_FAILED,
    };
    assert_int_equal(scene_expect_get(s, 0).status, SCENE_EXPECT_PENDING);
    run(s);
    assert_int_equal(scene_expect_count(s), 10);
    for (int i = 0; i < 10; i++) {
        assert_int_equal(scene_expect_get(s, i).status, expected[i]);
    }
    scene_expect_result r = scene_expect_get(s, 1);
    assert_string_equal(r.quantity, "b.distance from position");
    assert_near(r.measured, 2, ROUNDED(1e-3));
    assert_near(r.limit, 0.5, 0);
    assert_int_equal(r.line, 4);
    r = scene_expect_get(s, 3); // reported where it first broke
    assert_near(r.time, 0.61, 1e-9);
    assert_near(scene_expect_get(s, 9).measured, 7, 0);
    assert_int_equal(scene_expect_failures(s), 4);
    scene_destroy(s);
}

static void test_not_reached(void **state)
{
    (void)state;
    const char *text = "scene{ duration = 5 }\nbody{ name = 'b', circle{1} }\nexpect{ 'late', at = "
                       "4, max_speed = 1e6 }\n"
                       "expect{ 'gone', body = 'b', max_speed = 1e6 }\nat(0.01, function() "
                       "find('b'):destroy() end)";
    scene *s = load_as("test.lua", text, strlen(text), "duration=1");
    run(s);
    assert_int_equal(scene_expect_get(s, 0).status, SCENE_EXPECT_NOT_REACHED);
    assert_int_equal(scene_expect_get(s, 1).status, SCENE_EXPECT_FAILED);
    assert_int_equal(scene_expect_failures(s), 2);
    scene_destroy(s);
}

// ------------------------------------------------------------------------------------ the sandbox

static void test_environment(void **state)
{
    (void)state;
    scene *s = load( // the table is filled in an order that hashing would not keep
        "local t, keys = {}, ''\nfor _, k in ipairs{'pear', 'apple', 'fig', 'date'} do t[k] = 1 "
        "end t[3] = 1 t[1] = 1\n"
        "for k in pairs(t) do keys = keys .. k .. ' ' end\nassert(keys == '1 3 apple date fig pear "
        "', keys)\n"
        "local list = {3, 1, 2} table.sort(list) assert(table.concat(list, ',') == '1,2,3')\n"
        "table.insert(list, 4) table.insert(list, 1, 0) assert(table.remove(list) == 4 and "
        "table.remove(list, 1) == 0)\n"
        "assert(tostring({}) == 'table' and ('%s'):format({}) == 'table' and ('ab'):rep(2) == "
        "'abab')\n"
        "assert((''):rep(1e15) == '' and ('a.c'):find('.', 1) == 2)\n"
        "local a, b = random(), random(2, 3) assert(a >= 0 and a < 1 and b >= 2 and b < 3)\n"
        "local n = random_int(1, 6) assert(n >= 1 and n <= 6 and math.type(n) == 'integer')\n"
        "assert(2^2 == 4 and math.abs(math.pow(2, 0.5) - math.sqrt(2)) < 1e-15)\n");
    scene_destroy(s);
}

static void test_maths_agrees_with_libm(void **state)
{
    (void)state;
    scene *s = load(
        "local worst = 0\nfor i = -2000, 2000 do local x = i * 0.37\n"
        "  local c, n = math.cos(x), math.sin(x)\n"
        "  worst = math.max(worst, math.abs(c * c + n * n - 1))\n"
        "  worst = math.max(worst, math.abs(math.sin(math.atan(n, c)) - n))\n"
        "  local y = x / 40 worst = math.max(worst, math.abs(math.log(math.exp(y)) - y) / (1 + "
        "math.abs(y)))\n"
        "end\nscore('worst', worst)\nscore('sin', math.sin(1)) score('cos', math.cos(100))\n"
        "score('exp', math.exp(-3.3)) score('log', math.log(17)) score('atan', math.atan(-2, -3))\n"
        "score('asin', math.asin(0.3)) score('acos', math.acos(-0.4)) score('tan', math.tan(0.8))");
    assert_true(score(s, "worst") < 1e-15);
    assert_near(score(s, "sin"), sin(1), 3e-16);
    assert_near(score(s, "cos"), cos(100), 3e-16);
    assert_near(score(s, "exp"), exp(-3.3), 1e-17);
    assert_near(score(s, "log"), log(17), 1e-15);
    assert_near(score(s, "atan"), atan2(-2, -3), 1e-15);
    assert_near(score(s, "asin"), asin(0.3), 3e-16);
    assert_near(score(s, "acos"), acos(-0.4), 1e-15);
    assert_near(score(s, "tan"), tan(0.8), 1e-15);
    scene_destroy(s);
}

// Random numbers come from the seed alone. The values are the generator's definition: they never
// change.
static void test_random_is_fixed(void **state)
{
    (void)state;
    const char *text = "scene{ seed = 42 }\nscore('a', random()) score('b', random_int(1, 1000))";
    scene *s = load(text);
    assert_near(score(s, "a"), 0.74156487877182331, 0);
    assert_near(score(s, "b"), 160, 0);
    scene_destroy(s);
}

// -------------------------------------------------------------------------------------------- JSON

static void check_round_trip(const scene *s)
{
    size_t size;
    size_t again_size;
    char *text = export_json(s, &size);
    scene *copy = load_as("test.json", text, size, NULL);
    char *again = export_json(copy, &again_size);
    assert_string_equal(again, text);
    assert_int_equal(scene_body_count(copy), scene_body_count(s));
    assert_near(scene_time(copy), scene_time(s), 0);
    for (int i = 0; i < scene_body_count(s); i++) {
        plumb_vec2 p = plumb_body_position(scene_world(s), scene_body_get(s, i).entity);
        plumb_vec2 q = plumb_body_position(scene_world(copy), scene_body_get(copy, i).entity);
        assert_true(p.x == q.x && p.y == q.y);
    }
    scene_destroy(copy);
    free(again);
    free(text);
}

static void test_json_round_trip(void **state)
{
    (void)state;
    scene *s =
        load("scene{ title = 'a \"b\" \\\\', gravity = {0.1, -9.81}, substeps = 8, duration = 2, "
             "wrap_x = 100, continuous = false }\n"
             "local m = material{ friction = 0.3, restitution = 1/3 }\nlocal n = material{ name = "
             "'n', density = 1e-3 }\n"
             "body{ type = 'static', box{10, 1}, at = {0, -0.5}, material = n, color = 3 }\n"
             "body{ circle{1/3}, capsule{1, 0.1, angle = 0.3, density = 0.7}, at = {0.1, 2}, "
             "angle_deg = 17, spin = 1e-7,"
             " velocity = {1/7, -3}, material = m, label = 'x\\ty', color = '#102030' }\n"
             "body{ outline{{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}}, at = {3, 1}, mass = 0.3, "
             "gravity_scale = 0 }\n"
             "body{ type = 'static', chain{{-5, 0}, {-6, 1}, closed = false}, segment{{5, 0}, {6, "
             "1}, material = m}, hidden = true }\n"
             "body{ regular(5, 0.4), polygon{{0, 0}, {1, 0}, {0, 1}, round = 0.1}, at = {-2, 3}, "
             "fixed_rotation = true, continuous = true, sleep = false }\n"
             "body{ circle(1), at = {40, 40}, asleep = true }\n"
             "camera{ fit = {{-5, 0}, {5, 5}} }\nexpect{ 'x', at = 2, max_speed = 100 }\nexpect{ "
             "'y', body = 'body2', x = {-9, 9} }");
    check_round_trip(s);
    scene_error e;
    for (int i = 0; i < 60; i++) {
        assert_int_equal(scene_step(s, &e), SCENE_OK);
    }
    check_round_trip(s);
    scene_destroy(s);
}

// The same scene twice, step by step, down to the last bit of its export.
static void test_runs_are_identical(void **state)
{
    (void)state;
    const char *text =
        "scene{ seed = 9, duration = 2 }\nbody{ type = 'static', box{20, 1} }\n"
        "for i = 1, 30 do body{ box{random(0.3, 1), random(0.3, 1)}, at = {random(-4, 4), 1 + i}, "
        "angle = random(0, 3) } end\n"
        "every(0.2, function() body{ circle{random(0.1, 0.4)}, at = {random(-1, 1), 12} } end)";
    scene *s[2] = { load(text), load(text) };
    size_t size[2];
    run(s[0]);
    run(s[1]);
    char *a = export_json(s[0], &size[0]);
    char *b = export_json(s[1], &size[1]);
    assert_string_equal(a, b);
    free(a);
    free(b);
    scene_destroy(s[0]);
    scene_destroy(s[1]);
}

// Keys that no double holds; floats beyond all integers; what is removed on the way.
static void test_pairs_keeps_every_key(void **state)
{
    (void)state;
    scene *s = load(
        "body{ box{1, 1} }\n"
        "local big = 1 << 53\n"
        "local t = { [big] = 'a', [big + 1] = 'b', [big + 2] = 'c', [-big - 1] = 'd', [-big] = "
        "'e',\n"
        "  [math.maxinteger] = 'f', [math.maxinteger - 1] = 'g', [math.mininteger] = 'h',\n"
        "  [0x1p63] = 'i', [1e300] = 'j', [1/0] = 'k', [-1/0] = 'l', [0.5] = 'm', [-1e300] = 'n',\n"
        "  [1] = 'o', x = 'p' }\n"
        "local order = ''\n"
        "for k, v in pairs(t) do assert(t[k] == v) order = order .. v end\n"
        "assert(order == 'lnhdemoabcgfijkp', order)\n"
        "local n = 0\n"
        "for i = 0, 999 do t[big + 7 * i] = i end\n"
        "for k, v in pairs(t) do n = n + 1 t[k] = nil end\n"
        "assert(n == 1015, n)\n");
    scene_destroy(s);
}

// string.find is our own: where it finds what.
static void test_find_is_plain(void **state)
{
    (void)state;
    scene *s = load(
        "body{ box{1, 1} }\n"
        "local function is(a, b, x, y) assert(a == x and b == y, tostring(a) .. ' ' .. "
        "tostring(b)) end\n"
        "local function at(x, y, ...) local a, b = string.find(...) is(a, b, x, y) end\n"
        "at(1, 1, 'abc', 'a') at(3, 3, 'abc', 'c') at(2, 3, 'abcbc', 'bc') at(4, 5, 'abcbc', 'bc', "
        "3)\n"
        "at(nil, nil, 'abc', 'd') at(nil, nil, 'abc', 'abcd') at(1, 3, 'abc', 'abc')\n"
        "at(1, 0, 'abc', '') at(4, 3, 'abc', '', 4) at(nil, nil, 'abc', '', 5) at(1, 0, '', '')\n"
        "at(3, 3, 'abc', 'c', -1) at(nil, nil, 'abc', 'a', -2) at(1, 1, 'abc', 'a', -9)\n"
        "at(1, 1, 'abc', 'a', 0) at(2, 2, 'a.c', '.') at(2, 3, 'a%d', '%d') at(4, 6, 'aabaab', "
        "'aab', 2)\n");
    scene_destroy(s);
}

// Periods below the step, and times far away, are no numbers that an integer must hold.
static void test_any_period_is_a_period(void **state)
{
    (void)state;
    scene *s = load("scene{ duration = 1 }\nbody{ box{1, 1} }\n"
                    "score('tiny', 0) score('huge', 0)\n"
                    "every(1e-300, function() score('tiny', score('tiny') + 1) end)\n"
                    "every(1e300, function() score('huge', 1) end)\n");
    run(s);
    assert_true(score(s, "tiny") >= 59); // each step, but perhaps the first, which begins at 0
    assert_near(score(s, "huge"), 0, 0);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_settings),
        cmocka_unit_test(test_bodies_and_shapes),
        cmocka_unit_test(test_params_and_sets),
        cmocka_unit_test(test_camera),
        cmocka_unit_test(test_timed_handlers),
        cmocka_unit_test(test_contact_handlers),
        cmocka_unit_test(test_body_methods),
        cmocka_unit_test(test_expectations),
        cmocka_unit_test(test_not_reached),
        cmocka_unit_test(test_environment),
        cmocka_unit_test(test_maths_agrees_with_libm),
        cmocka_unit_test(test_random_is_fixed),
        cmocka_unit_test(test_json_round_trip),
        cmocka_unit_test(test_runs_are_identical),
        cmocka_unit_test(test_pairs_keeps_every_key),
        cmocka_unit_test(test_find_is_plain),
        cmocka_unit_test(test_any_period_is_a_period),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
