// test_scene_softbody.c - rope{}, cloth{}, jelly{}, balloon{}, softbody{}: what they make, what their objects do and tell, what they
// refuse, the way through JSON.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static const char yard[] =
    "scene{ duration = 1 }\n"
    "body{ type = 'static', box{30, 1, at = {0, -0.5}} }\n"
    "body{ name = 'crate', box{0.5, 0.5}, at = {-3, 1} }\n"
    "r = rope{ from = {-3, 4}, to = {-3, 1.3}, to_body = 'crate', hold = 'from', nodes = 9, mass = "
    "2,"
    " stiffness = 5e4, friction = 0, color = '#804020' }\n"
    "local c = cloth{ at = {2, 3}, size = {2, 1}, columns = 4, rows = 2, hold = 'top', mass = 3 }\n"
    "local j = jelly{ box{1, 1, at = {6, 2}}, spacing = 0.25, density = 100, young = 2e4,"
    " velocity = {1, 0} }\n"
    "local b = balloon{ at = {9, 2}, radius = 0.5, nodes = 12, mass = 1, pressure = 900 }\n"
    "softbody{ nodes = {{12, 2, 0, 0, 1, 0.1}, {12, 1, 0, 0, 1, 0.1}},"
    " edges = {{1, 2, 1, 1000, 0, 0, 0, 1}}, pins = {{1, 12, 2}} }\n"
    "local nodes, edges = r:count()\n"
    "print(nodes, edges, c:count())\n"
    "local x, y = r:node(9)\n"
    "print(x, y)\n"
    "print(string.format('%.3f %.1f %.1f', j:measure().mass, j:measure().momentum_x, "
    "b:measure().pressure))\n"
    "at(0.2, function() r:cut(4) c:release(15) b:set_gas(400) r:hold(9, 0, 0.2, find('crate')) "
    "end)\n"
    "at(0.8, function() j:remove() end)\n"
    "expect{ 'one edge is torn', at = 1, test = function() return r:measure().torn == 1 end }\n";

// A thread whose length at rest a handler halves hangs half as low.
static const char winch[] =
    "scene{ duration = 3 }\n"
    "body{ name = 'load', circle{0.1}, at = {0, -1}, mass = 1, damping = 2 }\n"
    "local r = rope{ from = {0, 0}, to = {0, -1}, to_body = 'load', hold = 'both', nodes = 2, mass "
    "="
    " 0.1, stiffness = 1e5 }\n"
    "local a, b, rest, torn = r:edge(1)\n"
    "score('told', a == 1 and b == 2 and rest == 1 and not torn and 1 or 0)\n"
    "every_step(function(t) r:set_rest(1, 1 - 0.5 * math.min(1, t)) end)\n"
    "expect{ 'drawn up', at = 3, body = 'load', y = {-0.52, -0.48} }\n";

static int count_of(const scene *s, plumb_softbody all[8])
{
    return plumb_world_softbodies(scene_world(s), all, 8);
}

static void an_edge_draws_in(void **state)
{
    (void)state;
    scene *s = load(winch);
    assert_true(score(s, "told") == 1);
    run_and_hold(s);
    scene_destroy(s);
}

static void words_make_them(void **state)
{
    (void)state;
    scene *s = load(yard);
    plumb_softbody all[8];
    assert_int_equal(count_of(s, all), 5);
    plumb_softbody_desc d;
    assert_int_equal(plumb_softbody_settings(scene_world(s), all[0], &d), PLUMB_OK);
    assert_int_equal(d.node_count, 9);
    assert_int_equal(d.edge_count, 8);
    assert_int_equal(d.pin_count, 2);
    assert_true(d.friction == 0 && d.nodes[0].position.y == 4);
    const scene_softbody looks = scene_get_softbody(s, all[0]);
    assert_true(looks.palette < 0 && looks.color.r == 0x80 && looks.color.a == 0xff);
    assert_int_equal(plumb_softbody_settings(scene_world(s), all[1], &d), PLUMB_OK);
    assert_int_equal(d.node_count, 15);
    assert_int_equal(plumb_softbody_settings(scene_world(s), all[3], &d), PLUMB_OK);
    assert_int_equal(d.ring_count, 12);
    assert_int_equal(plumb_softbody_settings(scene_world(s), all[4], &d), PLUMB_OK);
    assert_true(d.edges[0].stiffness == 1000 && d.edges[0].flags == PLUMB_EDGE_PULLS);
    run_and_hold(s);
    assert_int_equal(count_of(s, all), 4);
    assert_int_equal(plumb_softbody_settings(scene_world(s), all[2], &d), PLUMB_OK);
    assert_true(d.pressure == 400);
    assert_int_equal(plumb_softbody_settings(scene_world(s), all[1], &d), PLUMB_OK);
    assert_int_equal(d.pin_count, 4); // of five, one was released
    scene_destroy(s);
}

// The same nodes, edges and pins, to the last digit that is written, and the same way on.
static void json_keeps_them(void **state)
{
    (void)state;
    for (int before = 0; before <= 20; before += 20) {
        scene *a = load(yard);
        steps(a, before);
        size_t size;
        char *json = export_json(a, &size);
        scene *b = load_as("test.json", json, size, NULL);
        plumb_softbody p[8], q[8];
        assert_int_equal(count_of(a, p), count_of(b, q));
        for (int pass = 0; pass < 2; ++pass) {
            for (int i = 0; i < count_of(a, p); ++i) {
                plumb_softbody_desc c, d;
                assert_int_equal(plumb_softbody_settings(scene_world(a), p[i], &c), PLUMB_OK);
                assert_int_equal(plumb_softbody_settings(scene_world(b), q[i], &d), PLUMB_OK);
                assert_int_equal(c.node_count, d.node_count);
                assert_int_equal(c.edge_count, d.edge_count);
                assert_int_equal(c.triangle_count, d.triangle_count);
                assert_int_equal(c.bend_count, d.bend_count);
                assert_int_equal(c.ring_count, d.ring_count);
                assert_int_equal(c.pin_count, d.pin_count);
                for (int k = 0; k < c.node_count; ++k) {
                    const double x = (double)(c.nodes[k].position.x - d.nodes[k].position.x);
                    const double y = (double)(c.nodes[k].position.y - d.nodes[k].position.y);
                    assert_true(x * x + y * y < 1e-8);
                }
            }
            steps(a, 5);
            steps(b, 5);
        }
        free(json);
        scene_destroy(a);
        scene_destroy(b);
    }
}

// `sleep`, `asleep`, awake(), wake(), sleep(); JSON has who sleeps.
static void words_of_sleep(void **state)
{
    (void)state;
    scene *a =
        load("scene{ duration = 12 }\n"
             "body{ type = 'static', box{30, 1, at = {0, -0.5}} }\n"
             "local r = rope{ from = {-1, 0.6}, to = {1, 0.6}, drag = 1 }\n"
             "rope{ from = {4, 0.6}, to = {6, 0.6}, drag = 1, sleep = false }\n"
             "local s = softbody{ nodes = {{12, 9, 0, 0, 1, 0.1}}, asleep = true }\n"
             "expect{ 'up', at = 0.1, test = function() return r:awake() and not s:awake() end }\n"
             "expect{ 'rests', at = 8, test = function() return not r:awake() end }\n"
             "at(9, function() r:wake() end)\n"
             "expect{ 'woken', at = 9.1, test = function() return r:awake() end }\n"
             "at(9.2, function() r:sleep() end)\n"
             "expect{ 'sleeps', at = 9.25, test = function() return not r:awake() end }\n");
    run_and_hold(a);
    plumb_softbody p[8], q[8];
    size_t size;
    char *json = export_json(a, &size);
    scene *b = load_as("test.json", json, size, NULL);
    assert_int_equal(count_of(a, p), 3);
    assert_int_equal(count_of(b, q), 3);
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(plumb_softbody_is_awake(scene_world(a), p[i]), i == 1);
        assert_int_equal(plumb_softbody_is_awake(scene_world(b), q[i]), i == 1);
        assert_int_equal(plumb_softbody_no_sleep(scene_world(b), q[i]), i == 1);
    }
    free(json);
    scene_destroy(a);
    scene_destroy(b);
}

static void mistakes_are_told(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "rope{ from = {0, 1} }", "to" },
        { "rope{ from = {0, 1}, to = {0, 1} }", "" },
        { "rope{ from = {0, 1}, to = {3, 1}, lenght = 3 }", "did you mean 'length'" },
        { "rope{ from = {0, 1}, to = {3, 1}, mass = -1 }", "mass" },
        { "rope{ from = {0, 1}, to = {3, 1}, nodes = 1 }", "nodes" },
        { "rope{ from = {0, 1}, to = {3, 1}, hold = 'middle' }", "hold" },
        { "rope{ from = {0, 1}, to = {3, 1}, to_body = 'who' }", "who" },
        { "rope(3)", "takes one table" },
        { "cloth{ at = {0, 0} }", "size" },
        { "cloth{ at = {0, 0}, size = {1, 0} }", "size" },
        { "cloth{ at = {0, 0}, size = {1, 1}, columns = 1000 }", "columns" },
        { "jelly{ spacing = 0.1 }", "one shape" },
        { "jelly{ box{1, 1}, circle{1} }", "one shape" },
        { "jelly{ box{1, 1}, poisson = 1 }", "poisson" },
        { "balloon{ at = {0, 0}, nodes = 2 }", "nodes" },
        { "balloon{ at = {0, 0}, radius = 0 }", "radius" },
        { "softbody{ }", "nodes" },
        { "softbody{ nodes = {{0, 0, 0, 0, 1}} }", "nodes" },
        { "softbody{ nodes = {{0, 0, 0, 0, 1, 0}}, edges = {{1, 2, 1, 1, 0, 0, 0, 0}} }", "edges" },
        { "softbody{ nodes = {{0, 0, 0, 0, 1, 0}, {1, 0, 0, 0, 1, 0}}, edges = {{1, 2, 1, 1, 0, 0, "
          "0, "
          "9}} }",
          "0, 1 (it only pulls)" },
        { "softbody{ nodes = {{0, 0, 0, 0, 1, 0}}, pins = {{1, 'x', 0}} }", "pin 1 must be" },
        { "local r = rope{ from = {0, 1}, to = {3, 1} } r:cut(1000)", "there are edges" },
        { "local r = rope{ from = {0, 1}, to = {3, 1} } r:edge(0)", "there are edges" },
        { "local r = rope{ from = {0, 1}, to = {3, 1} } r:set_rest(1.5, 1)", "there are edges" },
        { "local r = rope{ from = {0, 1}, to = {3, 1} } r:set_rest(1, 0)", "length is 0" },
        { "local r = rope{ from = {0, 1}, to = {3, 1} } r:set_rest(1, 1e7)", "length is 1e+07" },
        { "local r = rope{ from = {0, 1}, to = {3, 1} } r:node(0)", "node" },
        { "local r = rope{ from = {0, 1}, to = {3, 1} } r:hold(1, 0, 0, 3)", "a body" },
        { "local r = rope{ from = {0, 1}, to = {3, 1} } r:release(2)", "nothing holds node 2" },
        { "local r = rope{ from = {0, 1}, to = {3, 1} } r:remove() r:measure()", "was removed" },
        { "local r = rope{ from = {0, 1}, to = {3, 1} } r:set_gas(1)", "" },
        { "scene{ wrap_x = 10 } rope{ from = {0, 1}, to = {3, 1} }", "wrap" },
    };
    int wrong = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        scene *s = NULL;
        scene_error e = { 0 };
        const char *text = rows[i][0];
        scene_load(&(scene_options){ .path = "test.lua", .text = text, .text_size = strlen(text) },
                   &s, &e);
        if (s != NULL || strstr(e.text, rows[i][1]) == NULL ||
            strstr(e.text, "test.lua:1") == NULL) {
            print_error("%s: %s\n", text, e.text);
            ++wrong;
        }
    }
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_make_them),   cmocka_unit_test(an_edge_draws_in),
        cmocka_unit_test(json_keeps_them),   cmocka_unit_test(words_of_sleep),
        cmocka_unit_test(mistakes_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
