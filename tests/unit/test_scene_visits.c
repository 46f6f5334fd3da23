// test_scene_visits.c - every on_enter has one on_leave, and every on_contact one on_end, whatever becomes of who came
// and of whom he visits: destroyed, disabled, filtered out, teleported, of another type, asleep; by each of them
// alone, and by random scripts.
#define _POSIX_C_SOURCE 200809L
#include "scene_fixture.h"

// Counts who is inside, asserts that nobody leaves who is not in, and at the end that all are out.
static const char *const counted =
    "local inside, touching = {}, {}\n"
    "local function key(a, b) if a < b then return a .. '/' .. b end return b .. '/' .. a end\n"
    "local function come(t, what, k) t[k] = (t[k] or 0) + 1 score(what, score(what) + 1) end\n"
    "local function go(t, what, k)\n"
    "  assert((t[k] or 0) > 0, what .. ' ' .. k) t[k] = t[k] - 1 score(what, score(what) + 1) end\n"
    "on_enter(function(s, v) come(inside, 'in', s:name() .. '/' .. v:name()) end)\n"
    "on_leave(function(s, v) go(inside, 'out', s:name() .. '/' .. v:name()) end)\n"
    "on_contact(function(a, b) come(touching, 'met', key(a:name(), b:name())) end)\n"
    "on_end(function(a, b) go(touching, 'parted', key(a:name(), b:name())) end)\n";

static scene *start(const char *script)
{
    size_t size = strlen(counted) + strlen(script) + 64;
    char *text = malloc(size);
    assert_non_null(text);
    const char *head = strstr(script, "body{");
    assert_non_null(head);
    snprintf(text, size, "%.*s%s%s", (int)(head - script), script, counted, head);
    scene *s = load(text);
    free(text);
    return s;
}

// ------------------------------------------------------------------------------------ one by one

static const char *const ends[] = {
    "v:destroy()",
    "v:set_enabled(false)",
    "v:set_filter{ collides = {} }",
    "v:teleport(20, 0)",
    "z:destroy()",
    "z:set_enabled(false)",
    "z:set_filter{ collides = {} }",
    "z:teleport(20, 0)",
    "v:destroy() z:destroy()",
    "z:destroy() v:destroy()",
    "v:set_enabled(false) v:destroy()",
    "v:teleport(20, 0) v:destroy()",
    "exclude(v, z) v:wake() v:teleport(0.1, 0)",
    "v:set_type('static') v:teleport(20, 0)",
    "v:sleep() v:destroy()",
    "v:sleep() z:destroy()",
    "v:sleep() v:set_filter{ collides = {} }",
    "v:set_type('static') v:destroy()",
};

// The visitor is in before, and out in the step after; who it was can still be asked.
static void each_way_out_is_told(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "scene{ duration = 1, gravity = {0, 0} }\n"
                 "body{ name = 'far', type = 'static', box{1, 1}, at = {0, 50} }\n"
                 "local z = body{ name = 'zone', type = 'static', sensor = true, box{2, 2}, "
                 "user = { gate = 7 } }\n"
                 "local v = body{ name = 'guest', circle{0.2}, user = { ticket = 42 } }\n"
                 "on_leave{ a = 'zone', b = 'guest', function(a, b)\n"
                 "  assert(a == z and b == v and a.user.gate == 7 and b.user.ticket == 42)\n"
                 "  assert(b:name() == 'guest')\n  score('when', time()) end }\n"
                 "at(0.5, function() assert(score('in') == 1 and score('out') == 0) %s end)\n",
                 ends[i]);
        scene *s = start(text);
        run(s);
        if (score(s, "out") != 1) {
            printf("%s\n", ends[i]);
        }
        assert_near(score(s, "in"), 1, 0);
        assert_near(score(s, "out"), 1, 0);
        assert_near(score(s, "when"), 0.5 + 1.0 / 60, 1e-6);
        scene_destroy(s);
    }
}

// Destroyed by the handler of its entry: the leave follows in the next step. Who is gone before any handler heard
// that he came is not told to go either.
static void destroyed_on_entry(void **state)
{
    (void)state;
    scene *s = start("scene{ duration = 0.2, gravity = {0, 0} }\n"
                     "body{ name = 'zone', type = 'static', sensor = true, box{2, 2}, box{1, 1} }\n"
                     "body{ name = 'guest', circle{0.2} }\n"
                     "on_enter{ a = 'zone', function(z, v) v:destroy() end }\n"
                     "on_leave{ a = 'zone', b = 'guest', function(z, v) assert(not v:alive())\n"
                     "  score('left', score('left') + 1) end }\n");
    run(s);
    assert_near(score(s, "in"), 1, 0); // of the two shapes of the zone, the second finds nobody
    assert_near(score(s, "out"), 1, 0);
    assert_near(score(s, "left"), 1, 0);
    scene_destroy(s);
}

// What is struck down ceases to touch.
static void contacts_of_the_destroyed_end(void **state)
{
    (void)state;
    scene *s = start("scene{ duration = 1, sleep = false }\n"
                     "body{ name = 'floor', type = 'static', box{10, 1}, at = {0, -0.5} }\n"
                     "local b = body{ name = 'ball', circle{0.2}, at = {0, 0.2} }\n"
                     "on_end{ a = 'ball', function(x, f) assert(x == b and f:alive())\n"
                     "  score('end', time()) end }\n"
                     "at(0.5, function() b:destroy() end)\n");
    run(s);
    assert_near(score(s, "parted"), 1, 0);
    assert_near(score(s, "end"), 0.5 + 1.0 / 60, 1e-6);
    scene_destroy(s);
}

// ----------------------------------------------------------------------------------- by chance

// Bodies are made, moved and undone at random; then all go.
static const char *const by_chance =
    "local live, n = {}, 0\n"
    "local function make()\n"
    "  n = n + 1\n"
    "  local kind = random_int(1, 4)\n"
    "  local at = {random(-3, 3), random(0.5, 4)}\n"
    "  if kind == 1 then live[#live + 1] = body{ name = 'z' .. n, sensor = true, at = at,\n"
    "    type = random() < 0.5 and 'static' or 'kinematic', box{2, 1}, circle{0.7} }\n"
    "  elseif kind == 2 then live[#live + 1] = body{ name = 'm' .. n, at = at, box{0.4, 0.4},\n"
    "    circle{0.8, sensor = true} }\n"
    "  else live[#live + 1] = body{ name = 'v' .. n, at = at, circle{random(0.1, 0.4)},\n"
    "    box{0.3, 0.3, at = {0.2, 0}} } end\n"
    "end\n"
    "for i = 1, 12 do make() end\n"
    "local function upset()\n"
    "  local i = random_int(1, #live)\n"
    "  local b, what = live[i], random_int(1, 10)\n"
    "  if what <= 3 then b:destroy() live[i] = live[#live] live[#live] = nil make()\n"
    "  elseif what == 4 then b:set_enabled(not b:enabled())\n"
    "  elseif what == 5 then b:set_filter{ collides = {} }\n"
    "  elseif what == 6 then b:set_filter{ collides = 'default' }\n"
    "  elseif what == 7 then b:teleport(random(-3, 3), random(0.5, 4))\n"
    "  elseif what == 8 and may_sleep and b:enabled() and b:type() == 'dynamic' then b:sleep()\n"
    "  elseif what == 9 then b:set_type(({'static', 'kinematic'})[random_int(1, 2)])\n"
    "  elseif what == 10 then b:set_type('dynamic') end\n"
    "end\n"
    "every_step(function(t)\n"
    "  if t < 1.9 then for i = 1, random_int(0, 2) do upset() end end\n"
    "end)\n"
    "if greedy then on_enter(function(s, v) if random() < 0.2 then\n"
    "  for i = 1, #live do if live[i] == v then live[i] = live[#live] live[#live] = nil break end "
    "end\n"
    "  v:destroy() make() end end) end\n"
    "at(1.95, function() for i = 1, #live do live[i]:destroy() end end)\n"
    "expect{ 'who came has left', test = function()\n"
    "  local left = 0\n"
    "  for k, c in pairs(inside) do left = left + c end\n"
    "  for k, c in pairs(touching) do left = left + (may_sleep and 0 or c) end\n"
    "  return left == 0, left, 0 end }\n";

static void whatever_becomes_of_them(void **state)
{
    (void)state;
    double in = 0, met = 0;
    for (int seed = 0; seed < 60; seed++) {
        const bool asleep = seed % 3 == 0; // whose contacts end without a word when the others go
        const char *sleeps = asleep ? "true" : "false";
        char text[4096];
        snprintf(text, sizeof text,
                 "scene{ duration = 2, sleep = %s, seed = %d }\nlocal may_sleep, greedy = %s, %s\n"
                 "body{ name = 'floor', type = 'static', box{12, 1}, at = {0, -0.5} }\n%s",
                 sleeps, seed, sleeps, seed % 2 != 0 ? "true" : "false", by_chance);
        scene *s = start(text);
        run_and_hold(s);
        in += score(s, "in"), met += score(s, "met");
        assert_near(score(s, "in"), score(s, "out"), 0);
        assert_true(asleep || score(s, "met") == score(s, "parted"));
        scene_destroy(s);
    }
    assert_true(in > 1000 && met > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_way_out_is_told),
        cmocka_unit_test(destroyed_on_entry),
        cmocka_unit_test(contacts_of_the_destroyed_end),
        cmocka_unit_test(whatever_becomes_of_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
