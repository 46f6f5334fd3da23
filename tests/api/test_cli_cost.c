// test_cli_cost.c - `plumb cost`: ladders that always end, quantities, a recommendation that is true when it is run
// alone, CSV that can be read, wrong options that are refused with a hint. PLUMB_FLOAT_ONLY: the binary has all precisions.
#define _XOPEN_SOURCE 700 // mkdtemp, realpath, popen's relatives

#include "cli_fixture.h"

#include "harness/trials.h"

#include <math.h>
#include <stdbool.h>

static const struct {
    const char *arguments, *message;
} refused[] = {
    { "--substeps 1,x", "is not a list of whole numbers such as 1,2,4" },
    { "--substeps 1,,2", "is not a list of whole numbers" },
    { "--substeps 65", "--substeps: 65 is outside 1 to 64" },
    { "--iterations 0", "--iterations: 0 is outside 1 to 1000" },
    { "--divide 0", "--divide: 0 is outside 1 to 1000000" },
    { "--divide 1,1000000", "option --divide: steps of 1.67e-08 s are shorter than 1e-06 s" },
    { "--solvers soft,pg", "did you mean 'pgs'?" },
    { "--precisions flaot", "did you mean 'float'?" },
    { "--repeat 0", "--repeat: 0 is outside 1 to 1000" },
    { "--budget 0", "--budget: 0 is outside 1e-06 to 1000000" },
    { "--budget -1", "--budget: -1 is outside" },
    { "--budget nan", "'nan' is not a number" },
    { "--tolerance -1", "--tolerance: -1 is outside 0 to 1000000000" },
    { "--tolerance 1e-3m", "'1e-3m' is not a number" },
    { "--chart a.pdf", "option --chart: 'a.pdf' does not end in .svg or .png" },
    { "--chart .svg", "does not end in .svg or .png" },
    { "--tolerence 1", "did you mean '--tolerance'?" },
    { "--quantity hieght", "measures no 'hieght'; did you mean 'height'?" },
    { "--quantity xyzzy", "measures no 'xyzzy'; the first quantity is 'height'" },
};

static void hostile_options_are_refused(void **state)
{
    (void)state;
    write_text("fall.lua",
               "scene { duration = 0.1 }\nbody { name = 'b', circle { 1 } }\n"
               "exact { 'height', body = 'b', y = function(t) return -4.905 * t * t end }\n");
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        char line[256];
        snprintf(line, sizeof line, "\"$P\" cost fall.lua %s", refused[i].arguments);
        expect_usage_error(line, refused[i].message);
    }
    expect_error("\"$P\" cost fall.lua --time 0", 1, "there is nothing to measure in 0 s");
}

static void lists_are_measured_and_judged(void **state)
{
    (void)state;
    expect_code("\"$P\" cost exact.lua --solvers soft,pgs --substeps 1,4 --repeat 1 --csv", 0);
    assert_int_equal(count_lines(out), 1 + 2 * 2 * 2);
    assert_non_null(
        strstr(out, "engine,solver,dt [s],substeps,iterations,precision,quantity,unit,error,"));
    assert_non_null(strstr(out, ",4,1,double,exact,m,"));
    expect_code("\"$P\" cost exact.lua --solvers soft --precisions float --substeps 2 "
                "--iterations 1,3 --divide 1,2,5 --repeat 1 --csv",
                0);
    assert_int_equal(count_lines(out), 1 + 2 * 3);
    expect_code("\"$P\" cost exact.lua --substeps 4 --solvers soft --repeat 1", 0);
    assert_non_null(strstr(out, "closed form"));
    expect_code("\"$P\" cost good.lua --substeps 2 --solvers soft --precisions float --repeat 1",
                0);
    assert_non_null(strstr(out, "own finest setting"));
    expect_code("\"$P\" cost exact.lua --substeps 2 --repeat 1 --tolerance 10", 0);
    assert_non_null(strstr(out, "cheapest within 10 m: --solver "));
    expect_code("\"$P\" cost good.lua --substeps 1 --repeat 1 --tolerance 0", 4);
    assert_non_null(strstr(out, "no setting stays within 0 m"));
}

// What ladders are climbed on: nothing to see, nothing that moves, what ends early, what flies apart, steps at both ends
// of what is allowed.
static const char *const odd[] = {
    "scene { duration = 0.2 }\n",
    "scene { duration = 0.2 }\nbody { type = 'static', box { 1, 1 } }\n",
    "scene { duration = 0.2 }\nbody { circle { 1 } }\nat(0.05, function() finish() end)\n",
    "scene { duration = 0.2 }\nbody { circle { 1 } }\nfinish()\n",
    "scene { duration = 0.2 }\nlocal b = body { circle { 1 } }\n"
    "at(0.1, function() b:destroy() end)\n",
    "scene { duration = 3, dt = 1 }\nbody { circle { 1 } }\n",
    "scene { duration = 1e-5, dt = 1e-6 }\nbody { circle { 1 } }\n",
    "scene { duration = 0.3, substeps = 64, iterations = 1000 }\nbody { circle { 1 } }\n",
    "scene { duration = 0.3 }\nbody { name = 'b', circle { 1 } }\n"
    "exact { 'late', body = 'b', from = 9, y = function(t) return 0 end }\n",
    "scene { duration = 0.3 }\nfor i = 1, 30 do body { name = 'b' .. i, circle { 1 }, at = {3 * i, "
    "0} }\n"
    "exact { 'f' .. i, body = 'b' .. i, y = function(t) return -4.9 * t * t end } end\n",
};

static void every_ladder_ends(void **state)
{
    (void)state;
    static const char *const budgets[] = { "1e-6", "1e-3", "4e-3" };
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        char line[128];
        write_text("odd.lua", odd[i]);
        snprintf(line, sizeof line, "\"$P\" cost odd.lua --repeat 1 --budget %s", budgets[i % 3]);
        expect_code(line, 0);
        const char *ends = strstr(out, "\nladders, their settings, and why they ended\n");
        assert_non_null(ends);
        // Each of them is told once, with its reason.
        int ladders = 0;
        for (const char *at = ends; (at = strpbrk(at, ":,")) != NULL; at++) {
            ladders += at[0] == ':' || strncmp(at, ", one", 5) != 0;
        }
        assert_true(ladders - 1 >=
                    4 * 3); // of two solvers and two precisions; the title has one comma
    }
}

static void motion_is_compared_as_long_as_it_can_be(void **state)
{
    (void)state;
    // A ball that rolls off a ball is unstable: e^(wt). One that falls is not.
    write_text("unstable.lua",
               "scene { duration = 6, gravity = {0, 0} }\nbody { name = 'b', circle { 0.1 }, "
               "sleep = false }\nfield { body = 'b', function(x, y) return 9 * x, 0 end }\n");
    expect_code("\"$P\" cost unstable.lua --substeps 4 --repeat 1", 0);
    const char *told = strstr(out, "trajectories can be compared up to ");
    assert_non_null(told);
    // cosh(3 t) is 1e5 at 4.07 s.
    double till = strtod(told + 35, NULL);
    assert_true(till > 3.7 && till < 4.4);
    assert_non_null(strstr(out, "  centre m   "));
    expect_code("\"$P\" cost exact.lua --substeps 4 --repeat 1", 0);
    assert_non_null(strstr(out, "trajectories can be compared to the end: a difference"));
}

static void what_diverges_is_no_truth(void **state)
{
    (void)state;
    write_text("burst.lua",
               "scene { duration = 0.3 }\nlocal b = body { name = 'b', circle { 1 } }\n"
               "every_step(function() b:apply_force(1e38, 0) end)\n");
    expect_error("\"$P\" cost burst.lua --repeat 1 --budget 1e-3", 5, "diverged");
}

// A name that gnuplot would take for commands or signs is only a name.
static void charts_are_drawn(void **state)
{
    (void)state;
    expect_error("PATH=/nowhere \"$P\" cost exact.lua --substeps 4 --repeat 1 --chart a.svg", 1,
                 "cannot draw 'a.svg': the program gnuplot is not on PATH; install the package "
                 "gnuplot-nox");
    if (shell("command -v gnuplot") != 0) {
        return; // what it draws can be seen only where it is
    }
    write_text("named.lua",
               "scene { title = 'it\\'s {/=99 a} ^name_ \\\\', duration = 0.2 }\n"
               "body { name = 'b', circle { 1 } }\n"
               "exact { '`ls` \\\\n{y}', body = 'b', y = function(t) return -5 * t * t end }\n"
               "exact { 'none', body = 'b', from = 9, y = function(t) return 0 end }\n");
    static const char *const scenes[] = { "exact.lua", "good.lua", "named.lua" };
    for (int i = 0; i < 3; i++) {
        char line[256];
        snprintf(line, sizeof line, "\"$P\" cost %s --repeat 1 --budget 1e-3 --chart \"a b'.svg\"",
                 scenes[i]);
        expect_code(line, 0);
        assert_string_equal(err, "");
        expect_code("cat \"a b'.svg\"", 0);
        assert_int_equal(strncmp(out, "<?xml ", 6), 0);
        assert_non_null(strstr(out, "</svg>"));
        assert_non_null(strstr(out, "soft, float"));
    }
    assert_non_null(strstr(out, "it's "));
    assert_non_null(strstr(out, "`ls` "));
    expect_code("\"$P\" cost exact.lua --substeps 1,4 --repeat 1 --chart a.png && "
                "head -c 4 a.png | tail -c 3",
                0);
    assert_non_null(strstr(out, "PNG"));
    expect_code("! ls | grep tmp", 0);
    expect_error("\"$P\" cost exact.lua --substeps 4 --repeat 1 --chart no/a.png", 1,
                 "cannot write 'no/a.png'");
}

// One field of a CSV line; the next begins behind it.
static double field(const char **at)
{
    char *end;
    double value = strtod(*at, &end);
    bool quoted = **at == '"';
    end = quoted ? strchr(*at + 1, '"') + 1 : strpbrk(*at, ",\n");
    assert_non_null(end);
    *at = end + 1;
    return value;
}

// In order of time, on a front errors fall: of each quantity alone.
enum { FIELDS = 23 };

// A line of --csv: its fields behind the engine's name.
static void read_line(const char **at, double values[FIELDS])
{
    (void)field(at);
    for (int i = 0; i < FIELDS; i++) {
        values[i] = field(at);
    }
}

static void csv_can_be_read(void **state)
{
    (void)state;
    write_text(
        "two.lua",
        "scene { duration = 2 }\nbody { name = 'b', circle { 1 }, at = {1, 0} }\n"
        "distance { world, 'b', at_a = {0, 0} }\n"
        "exact { 'energy, total', scale = 10, value = function() return 0 end,\n"
        "        measure = function()\n    local kinetic, potential = energy() return (kinetic + "
        "potential) / find('b'):mass() end }\n"
        "exact { 'length', unit = 'm', value = function() return 1 end, measure = function()\n"
        "    local x, y = find('b'):position() return math.sqrt(x * x + y * y) end }\n");
    expect_code("\"$P\" cost two.lua --repeat 2 --budget 0.01 --csv", 0);
    double last[2] = { INFINITY, INFINITY }, cpu = 0;
    int lines = 0, own = 0, fronts = 0;
    for (const char *at = strchr(out, '\n') + 1; *at != '\0'; lines++) {
        double values[FIELDS];
        const char *line = at;
        read_line(&at, values);
        assert_int_equal(at[-1], '\n');
        int q =
            strstr(line, "\"energy, total\",1,") != NULL && strstr(line, "\"energy") < at ? 0 : 1;
        assert_int_equal(q, lines % 2);
        assert_true(values[1] > 0 && values[1] <= 1.0 / 30 && values[2] >= 1 && values[3] >= 1);
        assert_true(values[17] >= cpu && values[18] >= 0);
        cpu = values[17];
        if (values[20] > 0) { // on the front
            if (!(values[7] < last[q])) {
                fail_msg("on the front, but no better than %g: %.*s", last[q], (int)(at - line),
                         line);
            }
            last[q] = values[7];
            fronts++;
        }
        own += values[21] > 0;
    }
    assert_true(lines > 20 && fronts >= 2);
    assert_int_equal(own, 2);
}

// Places of settings with longer steps are those of the same moments: what flies freely is everywhere right, in runs whose steps are not
// a multiple of the moments that are compared, too.
static void places_are_those_of_the_same_moment(void **state)
{
    (void)state;
    static const char *const durations[] = { "1", "4", "3.9" };
    for (int i = 0; i < 3; i++) {
        char text[128];
        snprintf(text, sizeof text,
                 "scene { duration = %s }\nbody { circle { 0.1 }, velocity = {3, 4} }\n",
                 durations[i]);
        write_text("flies.lua", text);
        expect_code("\"$P\" cost flies.lua --solvers soft,pgs --precisions double --repeat 1 "
                    "--budget 0.01 --csv",
                    0);
        int lines = 0, longer = 0;
        for (const char *at = strchr(out, '\n') + 1; *at != '\0'; lines++) {
            double values[FIELDS];
            read_line(&at, values);
            longer += values[1] > 0.02;
            assert_true(values[7] >= 0 && values[7] < 1e-9);
        }
        assert_true(lines > 5 && longer > 0);
    }
}

// What a scene of the recommendation test is, and the truth of it.
static double truth_of(int kind, double t)
{
    return kind == 0   ? 3 - 4.905 * t * t
           : kind == 1 ? cos(6.283185307179586 * t)
                       : 2 - 2 * exp(-1.5 * t);
}

static const char *const recommended[] = {
    "scene { duration = 2 }\nbody { name = 'b', circle { 0.1 }, at = {0, 3} }\n"
    "exact { 'y', body = 'b', y = function(t) return 3 - 4.905 * t * t end }\n",
    "scene { duration = 2, gravity = {0, 0} }\nbody { name = 'b', circle { 0.1 }, at = {0, 1} }\n"
    "field { body = 'b', function(x, y) return 0, -39.47841760435743 * y end }\n"
    "exact { 'y', body = 'b', y = function(t) return math.cos(6.283185307179586 * t) end }\n",
    "scene { duration = 2, gravity = {0, 0} }\n"
    "body { name = 'b', circle { 0.1 }, velocity = {0, 3} }\n"
    "field { body = 'b', function(x, y, vx, vy) return 0, -1.5 * vy end }\n"
    "exact { 'y', body = 'b', y = function(t) return 2 - 2 * math.exp(-1.5 * t) end }\n",
};

static void the_recommended_setting_is_as_good_as_told(void **state)
{
    (void)state;
    static const double tolerances[] = { 1e-1, 1e-3, 3e-5 };
    for (int i = 0; i < 9; i++) {
        if (!trials_takes((uint32_t)(i / 3 + i % 3), 3)) {
            continue;
        }
        char line[512], words[256];
        double tolerance = tolerances[i / 3];
        write_text("best.lua", recommended[i % 3]);
        snprintf(line, sizeof line, "\"$P\" cost best.lua --repeat 1 --budget 0.02 --tolerance %g",
                 tolerance);
        expect_code(line, 0);
        const char *begin = strstr(strstr(out, "\ncheapest within "), "--solver");
        assert_non_null(begin);
        snprintf(words, sizeof words, "%.*s", (int)strcspn(begin, "("), begin);
        snprintf(line, sizeof line, "\"$P\" run best.lua --body b %s", words);
        expect_code(line, 0);
        int rows = 0;
        for (const char *at = strchr(out, '\n') + 1; *at != '\0'; rows++) {
            double t = strtod(at, NULL), y = strtod(strstr(strstr(at, ",b,") + 3, ",") + 1, NULL);
            assert_true(fabs(y - truth_of(i % 3, t)) <= tolerance * (1 + 1e-6));
            at = strchr(at, '\n') + 1;
        }
        assert_true(rows > 2);
    }
}

// A setting that takes many budgets is given up, not waited for: 60 discs by the exact solver would be run 30 times.
static void what_takes_too_long_is_given_up(void **state)
{
    (void)state;
    write_text("heap.lua", "scene { duration = 1 }\n"
                           "body { type = 'static', box { 9, 1 }, at = {0, -0.5} }\n"
                           "for i = 0, 59 do body { circle { 0.2 }, at = {i % 10 * 0.41 - 2, 0.3 + "
                           "i // 10 * 0.41}, sleep = false } end\n"
                           "exact { 'energy', measure = function() return energy() end, value = "
                           "function() return 0 end }\n");
    expect_code("\"$P\" cost heap.lua --solvers exact --precisions float --repeat 1 --budget 1e-6",
                0);
    assert_non_null(strstr(out, "exact float 0: the next run would exceed the budget"));
}

// What a long chain bears sweeps do not bring to its top, and solving its joints together does; the words for it are those of `run`.
static void joints_are_solved_directly_too(void **state)
{
    (void)state;
    write_text("chain.lua",
               "scene { duration = 1 }\nlocal last = world\nfor i = 1, 40 do\n"
               "    local b = body { name = 'b' .. i, box { 0.1, 0.5 }, at = {0, -0.5 * i}, "
               "mass = 1, sleep = false }\n"
               "    revolute { last, b, at = {0, 0.25 - 0.5 * i} } last = b\nend\n"
               "exact { 'end', body = 'b40', x = function() return 0 end, y = function() return "
               "-20 end }\n");
    expect_code(
        "\"$P\" cost chain.lua --solvers soft,pgs --repeat 1 --budget 2e-3 --tolerance 1e-4", 0);
    const char *begin = strstr(strstr(out, "\ncheapest within "), "--solver");
    assert_non_null(begin);
    char line[512];
    snprintf(line, sizeof line, "\"$P\" run chain.lua --every 1s --body b40 %.*s",
             (int)strcspn(begin, "("), begin);
    assert_non_null(strstr(line, " --set direct_joints=true"));
    expect_code(line, 0);
    const char *end = strstr(out, "\n1,b40,");
    assert_non_null(end);
    assert_true(fabs(strtod(strchr(end + 7, ',') + 1, NULL) + 20) <= 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hostile_options_are_refused),
        cmocka_unit_test(lists_are_measured_and_judged),
        cmocka_unit_test(every_ladder_ends),
        cmocka_unit_test(motion_is_compared_as_long_as_it_can_be),
        cmocka_unit_test(places_are_those_of_the_same_moment),
        cmocka_unit_test(what_diverges_is_no_truth),
        cmocka_unit_test(charts_are_drawn),
        cmocka_unit_test(what_takes_too_long_is_given_up),
        cmocka_unit_test(joints_are_solved_directly_too),
        cmocka_unit_test(csv_can_be_read),
        cmocka_unit_test(the_recommended_setting_is_as_good_as_told),
    };
    return cmocka_run_group_tests(tests, set_up, clean_up);
}
