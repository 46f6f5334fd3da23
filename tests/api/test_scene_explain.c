// test_scene_explain.c - `plumb explain`: because of whom a pass runs, what it visits, what was of no use; as JSON that a parser
// reads, and as a picture of the flow of data. As it counts all rows, a camera sees all soft bodies.
// PLUMB_FLOAT_ONLY: the command line holds all three precisions.
#define _DEFAULT_SOURCE // mkdtemp, realpath

#include "cli_fixture.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

// A pool with two bodies in it, one of them capped at more than it reaches; a pool, a sensor and a joint that nobody needs.
static const char pool_scene[] =
    "scene { title = 'A \"pool\" & <more>', duration = 1 }\n"
    "water { name = 'pool', at = {0, -2}, box { 10, 4 } }\n"
    "water { name = 'puddle', at = {50, -2}, box { 2, 4 } }\n"
    "body { name = 'gate', type = 'static', sensor = true, at = {80, 0}, box { 1, 1 } }\n"
    "body { name = 'cork', box { 1, 1, density = 0.2 }, at = {-2, 0}, max_speed = 100 }\n"
    "body { name = 'log', box { 1, 1, density = 500 }, at = {2, 0}, damping = 0.1 }\n"
    "body { name = 'post', type = 'static', at = {70, 0}, box { 0.1, 0.1 } }\n"
    "body { name = 'wheel', circle { 0.5 }, at = {70, 0} }\n"
    "revolute { 'post', 'wheel', at = {70, 0}, motor = { speed = 1, torque = 0 } }\n";

static const cJSON *pass_of(const cJSON *all, const char *name)
{
    const cJSON *pass;
    cJSON_ArrayForEach(pass, cJSON_GetObjectItem(all, "passes"))
    {
        if (strcmp(cJSON_GetObjectItem(pass, "name")->valuestring, name) == 0) {
            return pass;
        }
    }
    fail_msg("no pass '%s'", name);
    return NULL;
}

static double number(const cJSON *of, const char *key)
{
    const cJSON *item = cJSON_GetObjectItem(of, key);
    assert_true(cJSON_IsNumber(item));
    return item->valuedouble;
}

static bool lists(const cJSON *of, const char *key, const char *text)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(of, key))
    {
        if (strcmp(item->valuestring, text) == 0) {
            return true;
        }
    }
    return false;
}

static void json_tells_because_of_whom(void **state)
{
    (void)state;
    write_text("pool.lua", pool_scene);
    expect_code("\"$P\" explain pool.lua --json", 0);
    cJSON *all = cJSON_Parse(out);
    assert_non_null(all);
    assert_string_equal(cJSON_GetObjectItem(all, "scene")->valuestring, "A \"pool\" & <more>");
    assert_int_equal(number(all, "steps"), 60);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(all, "lacks")), 0);

    const cJSON *forces = pass_of(all, "fluid forces"),
                *because = cJSON_GetObjectItem(forces, "because");
    assert_string_equal(cJSON_GetObjectItem(because, "first")->valuestring, "pool");
    assert_int_equal(number(because, "count"), 2);
    assert_int_equal(number(forces, "rows"), 2);
    assert_true(number(forces, "bytes") > 0 && number(forces, "share") > 0);
    assert_true(lists(forces, "reads", "solver bodies") &&
                lists(forces, "writes", "accelerations"));
    assert_string_equal(
        cJSON_GetObjectItem(cJSON_GetObjectItem(pass_of(all, "damping"), "because"), "first")
            ->valuestring,
        "log");
    assert_true(lists(pass_of(all, "motion"), "variants", "damping") &&
                lists(pass_of(all, "motion"), "away", "locked axes"));
    assert_true(cJSON_IsFalse(cJSON_GetObjectItem(pass_of(all, "characters"), "runs")));
    assert_null(cJSON_GetObjectItem(pass_of(all, "characters"), "rows"));
    // All shares are one.
    double sum = 0;
    const cJSON *pass;
    cJSON_ArrayForEach(pass, cJSON_GetObjectItem(all, "passes"))
    {
        sum += cJSON_GetObjectItem(pass, "share") != NULL ? number(pass, "share") : 0;
    }
    assert_true(sum > 0.999 && sum < 1.001);
    cJSON_Delete(all);
}

static void what_is_of_no_use_is_told(void **state)
{
    (void)state;
    write_text("pool.lua", pool_scene);
    static const char *const told[] = {
        "fluid-without-body: no dynamic body was in the fluid of 'puddle'\n",
        "sensor-without-visitor: nothing was in the sensor of 'gate'\n",
        "cap-never-met: 'cork' went ", "the motor of 'joint1' has no force\n"
    };
    expect_code("\"$P\" explain pool.lua --no-timing", 0);
    for (size_t i = 0; i < sizeof told / sizeof told[0]; i++) {
        assert_non_null(strstr(out, told[i]));
    }
    assert_null(strstr(out, "fluid of 'pool'"));
    assert_non_null(strstr(out, "some sensor is of a fluid: 'pool' and 1 more\n"));
    // What is of use is not.
    write_text("used.lua",
               "water { name = 'pool', at = {0, -2}, box { 10, 4 } }\n"
               "body { name = 'cork', box { 1, 1, density = 0.2 }, at = {0, 9}, max_speed = 2 }\n");
    expect_code("\"$P\" explain used.lua --time 6 --no-timing", 0);
    assert_null(strstr(out, "warning"));
    expect_code("\"$P\" explain pool.lua --no-timing --json >a && \"$P\" explain pool.lua "
                "--no-timing --json >b && cmp a b",
                0);
    expect_code("\"$P\" explain pool.lua --time 0 --json", 0);
    cJSON *all = cJSON_Parse(out);
    assert_non_null(all);
    cJSON_Delete(all);
}

static void the_flow_is_drawn(void **state)
{
    (void)state;
    write_text("pool.lua", pool_scene);
    expect_code("\"$P\" explain pool.lua --flow f.svg && tail -n 1 f.svg && cat f.svg", 0);
    assert_int_equal(strncmp(out, "A \"pool\"", 8), 0);
    assert_non_null(strstr(out, "\n</svg>\n<svg "));
    assert_non_null(strstr(out, ">A \"pool\" &amp; &lt;more&gt;</text>"));
    assert_non_null(strstr(out, ">fluid forces</text>"));
    assert_null(strstr(out, ">characters</text>\n")); // a pass that did not run
    expect_error("\"$P\" explain pool.lua --flow no/f.svg", 1, "cannot write 'no/f.svg'");
    expect_usage_error("\"$P\" explain pool.lua --flow f.png",
                       "--flow is 'f.png'; it must be the name of a file that ends in .svg");
    expect_usage_error("\"$P\" explain pool.lua --flwo f.svg", "did you mean '--flow'?");
    expect_usage_error("\"$P\" explain pool.lua --energy --json", "--energy tells of no passes");
    expect_usage_error("ln -s pool.lua link.svg && \"$P\" explain pool.lua --flow link.svg",
                       "SCENE and --flow are one file");
}

// However many there are, each once: also who has two shapes, or lies in two fluids, or behind many that cannot move.
static void all_rows_are_counted(void **state)
{
    (void)state;
    write_text("many.lua",
               "scene { gravity = { 0, 0 }, duration = 0.2 }\n"
               "wind { box { 2000, 40 }, flow = { 1, 0 } }\n"
               "water { name = 'pond', box { 4, 4 }, flow = { 0, 0 } }\n"
               "for i = 1, 100 do\n"
               "    body { type = 'static', at = { 2 * i - 300, -10 }, box { 0.5, 0.5 } }\n"
               "    rope { from = { 2 * i - 300, 10 }, to = { 2 * i - 299, 10 }, nodes = 3 }\n"
               "end\n"
               "for i = 1, 300 do\n"
               "    body { at = { 2 * i - 300, 0 }, circle { 0.3 }, box { 0.9, 0.1 } }\n"
               "end\n");
    expect_code("\"$P\" explain many.lua --json", 0);
    cJSON *all = cJSON_Parse(out);
    assert_non_null(all);
    assert_true(number(pass_of(all, "immersion"), "rows") == 300);
    assert_true(number(pass_of(all, "soft bodies"), "rows") == 300);
    cJSON_Delete(all);
}

// The camera looks at all that moves, whichever comes first: pictures are the same.
static void all_soft_bodies_are_in_the_picture(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        char text[512];
        snprintf(text, sizeof text,
                 "scene { title = 'ropes', gravity = { 0, 0 } }\n"
                 "for i = 0, 127 do\n"
                 "    local k = %s\n"
                 "    local x = k %% 64 + (k < 64 and 0 or 200)\n"
                 "    rope { from = { x, 0 }, to = { x + 0.5, 0 }, nodes = 2, color = '#804020' }\n"
                 "end\n",
                 turned == 0 ? "i" : "127 - i");
        write_text(turned == 0 ? "to.lua" : "fro.lua", text);
    }
    expect_code(
        "\"$P\" render to.lua -o to.png && \"$P\" render fro.lua -o fro.png && cmp to.png fro.png",
        0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_tells_because_of_whom),
        cmocka_unit_test(what_is_of_no_use_is_told),
        cmocka_unit_test(the_flow_is_drawn),
        cmocka_unit_test(all_rows_are_counted),
        cmocka_unit_test(all_soft_bodies_are_in_the_picture),
    };
    return cmocka_run_group_tests(tests, set_up, clean_up);
}
