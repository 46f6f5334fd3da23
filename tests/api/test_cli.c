// test_cli.c - the command line as its users meet it: help, suggestions for typos, exit codes, tables, and that the
// same command gives the same bytes.
#define _XOPEN_SOURCE 700 // mkdtemp, realpath, popen's relatives

#include "cli_fixture.h"

static const char *const helped[] = { "run",     "render", "check",  "explain", "cost",
                                      "convert", "list",   "replay", "diff" };

static void help_is_everywhere(void **state)
{
    (void)state;
    char line[64];
    expect_code("\"$P\" --help", 0);
    assert_string_equal(err, "");
    for (size_t i = 0; i < sizeof helped / sizeof helped[0]; i++) {
        char word[16];
        snprintf(word, sizeof word, "  %s ", helped[i]);
        expect_code("\"$P\" --help", 0);
        assert_non_null(strstr(out, word));
        snprintf(line, sizeof line, "\"$P\" %s --help", helped[i]);
        expect_code(line, 0);
        assert_string_equal(err, "");
        assert_non_null(strstr(out, "usage: plumb "));
        assert_non_null(strstr(out, "Options:"));
        snprintf(line, sizeof line, "\"$P\" %s -h >a; \"$P\" help %s >b; cmp a b", helped[i],
                 helped[i]);
        expect_code(line, 0);
        snprintf(line, sizeof line, "awk 'length > 80 { exit 1 }' a");
        expect_code(line, 0);
    }
    expect_code("\"$P\" --version", 0);
    assert_int_equal(strncmp(out, "plumb ", 6), 0);
    expect_code("\"$P\"", 2);
    assert_string_equal(out, "");
    assert_non_null(strstr(err, "usage: plumb COMMAND"));
}

static const struct {
    const char *arguments, *message;
} usage_cases[] = {
    { "rnu", "unknown command 'rnu'; did you mean 'run'?" },
    { "chekc good.lua", "did you mean 'check'?" },
    { "xyzzy", "unknown command 'xyzzy'; 'plumb --help' lists the commands" },
    { "good.lua", "did you mean 'plumb run good.lua'?" },
    { "--time 3", "the command comes first" },
    { "help rendr", "did you mean 'render'?" },
    { "help run run", "one operand too many" },
    { "run", "SCENE is missing" },
    { "render", "SCENE is missing" },
    { "check", "SCENE... is missing" },
    { "run good.lua more.lua", "'more.lua' is one operand too many" },
    { "run good.lua --substpes 3", "unknown option '--substpes'; did you mean '--substeps'?" },
    { "run good.lua --sub=3", "did you mean '--substeps'?" },
    { "run good.lua --qqqqqq", "'plumb help run' lists the options" },
    { "run good.lua -z", "unknown option '-z'" },
    { "run good.lua --quiet=yes", "--quiet: takes no value" },
    { "run good.lua --dt", "--dt: needs a value (S)" },
    { "run good.lua --dt abc", "'abc' is not a number" },
    { "run good.lua --dt nan", "'nan' is not a number" },
    { "run good.lua --dt inf", "'inf' is not a number" },
    { "run good.lua --dt 1/0", "'1/0' is not a number" },
    { "run good.lua --dt 0", "--dt: 0 is outside 1e-06 to 1" },
    { "run good.lua --dt 2", "--dt: 2 is outside 1e-06 to 1" },
    { "run good.lua --time -1", "--time: -1 is outside" },
    { "run good.lua --substeps 0", "--substeps: 0 is outside 1 to 64" },
    { "run good.lua --substeps 65", "--substeps: 65 is outside 1 to 64" },
    { "run good.lua --substeps 4.5", "'4.5' is not a whole number" },
    { "run good.lua --substeps 99999999999999999999",
      "--substeps: 99999999999999999999 is outside 1 to 64" },
    { "run good.lua --substeps ''", "'' is not a whole number" },
    { "run good.lua --solver sofd", "did you mean 'soft'?" },
    { "run good.lua --precision half", "'half' is not one of float,double,far" },
    { "run good.lua --width 5", "5 is not 0, 4, 8 or 16" },
    { "run good.lua --workers 0", "--workers: 0 is outside 1 to 64" },
    { "run good.lua --workers 65", "--workers: 65 is outside 1 to 64" },
    { "run good.lua --set workers=x", "'workers' of scene{} must be an integer, not a string" },
    { "run good.lua --set friction", "'friction' is not of the form key=value" },
    { "run good.lua --set =1", "'=1' is not of the form key=value" },
    { "run good.lua --set frictoin=1", "frictoin" },
    { "run good.lua --set frction=1", "neither a key of scene{} nor a param of this scene\n" },
    { "run good.lua --set solver=sfot", "must be one of soft|pgs|exact, not 'sfot' (did you mean" },
    { "run good.lua --set solver=3", "'solver' of scene{} must be a string, not a number" },
    { "run good.lua --every 0.5", "neither a number of steps (10) nor a time (0.5s)" },
    { "run good.lua --every 0", "neither a number of steps" },
    { "run good.lua --every -1s", "neither a number of steps" },
    { "run good.lua --format cvs", "did you mean 'csv'?" },
    { "run good.lua -o a.json", "JSON lines are named .jsonl" },
    { "run good.lua -o a.txt", "'a.txt' does not end in .csv, .jsonl or .ndjson" },
    { "run names.lua --body crat10", "is named 'crat10'; did you mean 'crate10'?" },
    { "run good.lua --body bal", "option --body: no body of 'drop' is named 'bal'; did you mean" },
    { "render good.lua", "-o FILE is missing" },
    { "render good.lua -o a.bmp", "'a.bmp'" },
    { "render good.lua -o a%s.png", "%" },
    { "render good.lua -o a.png --size 100", "'100' is not a size such as 960x540" },
    { "render good.lua -o a.png --size 0x9", "0x9 is outside 16 to 8192" },
    { "render good.lua -o a.png --overlay contcts", "did you mean 'contacts'?" },
    { "render good.lua -o a.png --from 1", "--from and --to are for films" },
    { "render good.lua -o a.png --fps 9", "--fps is for films; 'a.png' is one picture" },
    { "render good.lua -o a.gif --at 1", "--at is for one picture" },
    { "render good.lua -o a.gif --from 2 --to 1", "--to 1 lies before --from 2" },
    { "render good.lua -o a.png --follow bll",
      "option --follow: no body of 'drop' is named 'bll'" },
    { "convert good.lua a.txt", "does not end in .json" },
    { "list sovlers", "did you mean 'solvers'?" },
};

static void usage_errors_tell_the_remedy(void **state)
{
    (void)state;
    char line[256];
    expect_code("\"$P\" --help", 0);
    assert_non_null(strstr(out, "6 two recordings differ, or a replay gives other bits\n"));
    write_text(
        "names.lua",
        "for i = 1, 11 do body { name = 'crate' .. i, circle { 1 }, at = { 3 * i, 0 } } end\n");
    for (size_t i = 0; i < sizeof usage_cases / sizeof usage_cases[0]; i++) {
        snprintf(line, sizeof line, "\"$P\" %s", usage_cases[i].arguments);
        expect_usage_error(line, usage_cases[i].message);
    }
    assert_int_not_equal(access("a.png", F_OK), 0);
    assert_int_not_equal(access("a.gif", F_OK), 0);
    assert_int_not_equal(access("a.txt", F_OK), 0);
}

static void list_is_one_item_a_line(void **state)
{
    (void)state;
    expect_code("\"$P\" list solvers", 0);
    assert_string_equal(out, "solvers:\n  soft\n  pgs\n  exact\n");
    expect_code("\"$P\" list passes", 0);
    int passes = count_lines(out);
    assert_true(passes > 1 + 8);
    assert_non_null(strstr(out, "\n  classic solver  "));
    expect_code("\"$P\" list passes --brief", 0);
    assert_int_equal(count_lines(out), passes);
    assert_non_null(strstr(out, "\n  classic solver\n"));
    expect_code("\"$P\" list overlays", 0);
    assert_int_equal(count_lines(out), 1 + 17);
    assert_non_null(strstr(out, "\n  contacts\n"));
    expect_code("\"$P\" list scene --brief", 0);
    assert_int_equal(count_lines(out), 1 + 57);
    assert_non_null(strstr(out, "\n  scene\n  material\n  material_pair\n  body\n"));
    expect_code("\"$P\" list joints --brief", 0);
    assert_int_equal(count_lines(out), 1 + 12 + 2);
    assert_non_null(strstr(out, "joints of scene files:\n  revolute\n  prismatic\n"));
    expect_code("\"$P\" list joints", 0);
    assert_non_null(
        strstr(out, "\n    pitch             number, -1e+12 to 1e+12 [rad], required\n"));
    expect_code("\"$P\" list shapes --brief", 0);
    assert_int_equal(count_lines(out), 1 + 8);
    expect_code("\"$P\" list materials --brief", 0);
    assert_string_equal(out, "materials of scene files:\n  material\n  material_pair\n");
    expect_code("\"$P\" list scene", 0);
    assert_non_null(strstr(out, "\n    solver            one of soft|pgs|exact: "));
}

static void run_prints_every_body_and_step(void **state)
{
    (void)state;
    expect_code("\"$P\" run good.lua", 0);
    assert_string_equal(err, "");
    static const char begin[] =
        "time [s],name,x [m],y [m],angle [rad],vx [m/s],vy [m/s],w [rad/s]\n"
        "0,floor,0,-0.5,0,0,0,0\n0,ball,0,2,0,0,0,0\n0,\"a,\"\"b\"\"\",2,3,0,0,0,0\n"
        "0.0166666666667,floor,";
    assert_memory_equal(out, begin, sizeof begin - 1);
    assert_int_equal(count_lines(out), 1 + 3 * 61);
    expect_code("\"$P\" run good.lua --every 30 --body ball", 0);
    assert_int_equal(count_lines(out), 1 + 3);
    assert_non_null(strstr(out, "\n0.5,ball,0,"));
    expect_code("\"$P\" run good.lua --every 0.25s --body ball", 0);
    assert_int_equal(count_lines(out), 1 + 5);
    expect_code("\"$P\" run good.lua --time 0", 0);
    assert_int_equal(count_lines(out), 1 + 3);
    expect_code("\"$P\" run good.lua --time 0 --format jsonl", 0);
    assert_non_null(strstr(out, "{\"time\":0,\"name\":\"a,\\\"b\\\"\",\"x\":2,\"y\":3,\"angle\":0,"
                                "\"vx\":0,\"vy\":0,\"w\":0}\n"));
    expect_code("\"$P\" run -- good.lua", 0);
}

static void same_command_same_bytes(void **state)
{
    (void)state;
    expect_code("\"$P\" run good.lua >a; \"$P\" run good.lua >b; cmp a b", 0);
    expect_code("\"$P\" run good.lua -o c.csv && cmp a c.csv", 0);
    for (int width = 4; width <= 16; width *= 2) {
        char line[128];
        snprintf(line, sizeof line, "\"$P\" run good.lua --width %d >b; cmp a b", width);
        expect_code(line, 0);
    }
    expect_code("\"$P\" run good.lua --workers 3 >b; cmp a b", 0);
    expect_code("\"$P\" run good.lua --precision double >b; ! cmp -s a b", 0);
    expect_code("\"$P\" run good.lua --precision far >c; ! cmp -s a c && ! cmp -s b c", 0);
    expect_code(
        "\"$P\" run good.lua -o d.jsonl; \"$P\" run good.lua --format jsonl | cmp - d.jsonl", 0);
    expect_code(
        "for i in 1 2; do \"$P\" explain good.lua --no-timing >e$i || exit; done; cmp e1 e2", 0);
    expect_code("for i in 1 2; do \"$P\" list >l$i || exit; done; cmp l1 l2", 0);
    expect_code("for i in 1 2; do \"$P\" check good.lua >k$i || exit; done; cmp k1 k2", 0);
}

static void overrides_reach_the_scene(void **state)
{
    (void)state;
    expect_code("\"$P\" run good.lua --dt 1/30 --body ball", 0);
    assert_int_equal(count_lines(out), 1 + 31);
    expect_code("\"$P\" run good.lua --set duration=0.5 --body ball", 0);
    assert_int_equal(count_lines(out), 1 + 31);
    expect_code("\"$P\" explain good.lua --substeps 7 --solver pgs --precision double --width 4 "
                "--no-timing",
                0);
    assert_non_null(strstr(out, "pgs solver, 7 substeps"));
    assert_non_null(strstr(out, "double, 4 lanes"));
}

// What the command line does not say is the scene's to say.
static void the_scene_chooses_its_solver(void **state)
{
    (void)state;
    write_text("pgs.lua", "scene { solver = 'pgs' }\nbody { circle { 1 } }\n");
    expect_code("\"$P\" explain pgs.lua --no-timing", 0);
    assert_non_null(strstr(out, "pgs solver, 1 substep"));
    expect_code("\"$P\" explain pgs.lua --no-timing --set solver=soft", 0);
    assert_non_null(strstr(out, "soft solver, 4 substeps"));
    expect_code("\"$P\" explain good.lua --no-timing", 0);
    assert_non_null(strstr(out, "soft solver, 4 substeps"));
    expect_code("\"$P\" explain good.lua --no-timing --set solver=pgs", 0);
    assert_non_null(strstr(out, "pgs solver, 1 substep"));
    expect_code("\"$P\" explain good.lua --no-timing --set solver=pgs --solver soft", 0);
    assert_non_null(strstr(out, "soft solver, 4 substeps"));
}

// A pass that ran and runs no more, since all has fallen asleep, is not one that costs nothing.
static void what_ran_is_explained(void **state)
{
    (void)state;
    write_text("rest.lua", "body { type = 'static', box { 9, 1 } }\n"
                           "body { box { 1, 1 }, at = { 0, 1 } }\n");
    expect_code("\"$P\" explain rest.lua --no-timing", 0);
    const char *left_out = strstr(out, "Left out"), *solver = strstr(out, "  soft step ");
    assert_non_null(strstr(out, "(0 moving, 1 asleep in 1 island, 1 static)"));
    assert_true(solver != NULL && left_out != NULL && solver < left_out);
    assert_int_equal(strncmp(strchr(solver, '('), "(in ", 4), 0);
    assert_non_null(strstr(left_out, "  the world asks for the soft step\n"));
    assert_non_null(strstr(out, "waking  "));
    expect_code("\"$P\" explain rest.lua --time 0", 0);
    solver = strstr(out, "  soft step ");
    assert_true(solver != NULL && solver < strstr(out, "Left out"));
}

// Of a fall of 0.5 s without a contact, gravity has done it all.
static void energy_is_explained(void **state)
{
    (void)state;
    write_text("fall.lua", "scene { gravity = { 0, -10 } }\n"
                           "body { circle { 1, density = 1 / math.pi }, at = { 0, 9 } }\n");
    expect_code("\"$P\" explain fall.lua --energy --time 0.5 --precision double", 0);
    assert_non_null(strstr(out, "Energy over 30 steps [J]: 90 before, 90 after\n"));
    assert_non_null(strstr(out, "  gravity            12.5        -12.5 "));
    assert_null(strstr(out, "  normal "));
    assert_non_null(strstr(out, "  rest "));
    assert_null(strstr(out, "Left out"));
    assert_null(strstr(out, "  script "));
    assert_non_null(strstr(out, "contacts overlap by 0 m"));
    // A blow of 3 N s to the side gives a kilogram at rest there 4.5 J.
    write_text("blow.lua",
               "scene { gravity = { 0, -10 } }\n"
               "local ball = body { circle { 1, density = 1 / math.pi }, at = { 0, 9 } }\n"
               "at(0.25, function() ball:apply_impulse(3, 0) end)\n");
    expect_code("\"$P\" explain blow.lua --energy --time 0.5 --precision double", 0);
    assert_non_null(strstr(out, "Energy over 30 steps [J]: 90 before, 94.5 after\n"));
    assert_non_null(
        strstr(out, "  script                                        4.5  what the scene's"));
}

static void what_a_scene_prints_is_no_data(void **state)
{
    (void)state;
    write_text("print.lua", "print('from the scene')\nbody { name = 'ball', circle { 1 } }\n"
                            "at(0.1, function() body { name = 'late', circle { 1 } } end)\n");
    expect_code("\"$P\" run print.lua --time 0.2 -q", 0);
    assert_null(strstr(out, "from the scene"));
    assert_string_equal(err, "from the scene\n");
    // A body that the scene makes on its way may be asked for.
    expect_code("\"$P\" run print.lua --time 0.2 --body late", 0);
    assert_int_equal(strncmp(out, "time [s],name,", 14), 0);
    assert_true(count_lines(out) > 2);
    expect_code("\"$P\" check print.lua --time 0.2", 0);
    assert_non_null(strstr(out, "none  print.lua: nothing is expected\n"));
}

static void failed_expectations_are_code_4(void **state)
{
    (void)state;
    expect_code("\"$P\" check good.lua", 0);
    assert_non_null(strstr(out, "ok    good.lua: ball stays up: "));
    assert_non_null(strstr(out, "1 expectation of 1 scene: 1 ok, 0 failed\n"));
    expect_code("\"$P\" check good.lua failing.lua", 4);
    assert_non_null(strstr(out, "FAIL  failing.lua: ball floats: "));
    assert_non_null(strstr(out, "ok    failing.lua: ball falls: "));
    assert_non_null(strstr(out, "3 expectations of 2 scenes: 2 ok, 1 failed\n"));
    expect_code("\"$P\" check failing.lua --time 0.1", 4);
    assert_non_null(strstr(out, "0 ok, 2 failed"));
}

// --set takes a value as a scene would write it, and is held by the bounds of the scene.
static void set_takes_what_scenes_say(void **state)
{
    (void)state;
    static const char *const same[][2] = {
        { "gravity={0,-5}", "gravity=0,-5" },      { "gravity={ 0, -5 }", "gravity=0,-5" },
        { "dt=1/120", "dt=0.008333333333333333" }, { "solver=\"pgs\"", "solver=pgs" },
        { "gravity={0,-10/2}", "gravity=0,-5" },
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        char line[256];
        snprintf(
            line, sizeof line,
            "\"$P\" run good.lua --set '%s' >a && \"$P\" run good.lua --set '%s' >b && cmp a b",
            same[i][0], same[i][1]);
        expect_code(line, 0);
    }
    expect_usage_error("\"$P\" run good.lua --set 'gravity={0,x}'",
                       "must be two numbers {x, y}, not a string");
    expect_usage_error("\"$P\" run good.lua --set 'gravity=0,-5,x'",
                       "must be two numbers {x, y}, not a string");
    expect_usage_error("\"$P\" run good.lua --set 'gravity={0}'", "must be two numbers {x, y}");
    static const char *const tiny[] = { "run good.lua --set dt=1e-30",
                                        "cost good.lua --set dt=1e-30",
                                        "render good.lua -o a.png --set dt=1e-300",
                                        "convert good.lua --set dt=1e-30",
                                        "explain good.lua --set dt=0" };
    for (size_t i = 0; i < sizeof tiny / sizeof *tiny; i++) {
        char line[256];
        snprintf(line, sizeof line, "\"$P\" %s", tiny[i]);
        expect_usage_error(line, "'dt' of scene{} must be at least 1e-06 and at most 1 s");
    }
    expect_error("\"$P\" check good.lua --set dt=1e-7", 2, "must be at least 1e-06");
    expect_code("\"$P\" list materials", 0);
    assert_null(strstr(out, "[1]"));
    write_text(
        "score.lua",
        "body { circle { 1 } }\nscore('n', 2)\nexpect { 's', score = 'n', value = {0, 1} }\n");
    expect_code("\"$P\" check score.lua --time 0", 4);
    assert_non_null(strstr(out, "n.score 2 (breaks limit 1) at 0 s"));
}

// Two boxes of one size that overlap more or less, at every scale and to every side.
static void overlaps_at_the_start_are_told(void **state)
{
    (void)state;
    static const double sizes[] = { 0.05, 1, 40 }, shares[] = { -0.5, 0, 0.03, 0.08, 0.4, 0.9 };
    for (int i = 0; i < 18; i++) {
        double size = sizes[i / 6], share = shares[i % 6], d = size * (1 - share);
        char text[512];
        snprintf(text, sizeof text,
                 "scene { gravity = {0, 0} }\nbody { name = 'a', box { %g, %g } }\n"
                 "body { name = 'b', type = '%s', box { %g, %g }, at = { %g, %g } }\n",
                 size, size, i % 2 == 0 ? "dynamic" : "static", size, size, i % 3 == 0 ? d : 0,
                 i % 3 == 0   ? 0
                 : i % 3 == 1 ? -d
                              : d);
        write_text("two.lua", text);
        expect_code("\"$P\" run two.lua --time 0 -o /dev/null", 0);
        if (share < 0.05) {
            assert_string_equal(err, "");
        } else {
            assert_non_null(strstr(err, "plumb: warning: two.lua: '"));
            assert_non_null(strstr(err, " m inside one another\n"));
            assert_int_equal(count_lines(err), 1);
        }
    }
    write_text("row.lua",
               "for i = 1, 9 do body { name = 'b' .. i, circle { 1 }, at = { 2 * i - i * i / 20, 0 "
               "} } end\n"
               "body { name = 'ground', type = 'static', segment { {-9, -0.8}, {40, -0.8} } }\n");
    static const char *const lines[] = { "run row.lua --time 0 -o /dev/null",
                                         "check row.lua --time 0",
                                         "render row.lua --time 0 -o row.png" };
    for (int i = 0; i < 3; i++) {
        char line[128];
        snprintf(line, sizeof line, "\"$P\" %s", lines[i]);
        expect_code(line, 0);
        assert_int_equal(
            strncmp(err, "plumb: warning: row.lua: 'b8' and 'b9' begin 0.85 m inside one another\n",
                    70),
            0);
        assert_non_null(strstr(err, "plumb: warning: row.lua: and "));
        assert_int_equal(count_lines(err), 4);
    }
}

// Whoever never meets is not told of, nor what only sees.
static void overlaps_that_are_meant_are_not(void **state)
{
    (void)state;
    static const char *const meant[] = {
        "body { box { 1, 1 }, collides = {} } body { box { 1, 1 } }",
        "body { box { 1, 1 }, apart = 'doll' } body { box { 1, 1 }, apart = 'doll' }",
        "body { name = 'a', box { 1, 1 } } body { name = 'b', box { 1, 1 } } revolute { 'a', 'b' }",
        "local a, b = body { box { 1, 1 } }, body { box { 1, 1 } } exclude(a, b)",
        "body { box { 1, 1 } } body { box { 9, 9 }, sensor = true, type = 'static' }",
        "body { type = 'static', box { 1, 1 } } body { type = 'static', box { 1, 1 } }",
        "body { type = 'kinematic', box { 1, 1 } } body { type = 'static', box { 1, 1 } }",
        "body { box { 1, 1 }, enabled = false } body { box { 1, 1 } }",
        "body { box { 1, 1 }, box { 1, 1, at = { 0.5, 0 } } }",
    };
    for (size_t i = 0; i < sizeof meant / sizeof *meant; i++) {
        write_text("meant.lua", meant[i]);
        expect_code("\"$P\" run meant.lua --time 0 -o /dev/null", 0);
        if (err[0] != '\0') {
            fail_msg("%s: %s", meant[i], err);
        }
    }
    write_text("joined.lua", "body { name = 'a', box { 1, 1 } } body { name = 'b', box { 1, 1 } }\n"
                             "revolute { 'a', 'b', collide = true }\n");
    expect_error("\"$P\" run joined.lua --time 0 -o /dev/null", 0, "'a' and 'b' begin 1 m inside");
    write_text("asleep.lua",
               "for i = 1, 2 do body { name = 'a' .. i, box { 1, 1 }, asleep = true } end\n");
    expect_error("\"$P\" run asleep.lua --time 0 -o /dev/null", 0,
                 "'a1' and 'a2' begin 1 m inside");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_is_everywhere),
        cmocka_unit_test(usage_errors_tell_the_remedy),
        cmocka_unit_test(list_is_one_item_a_line),
        cmocka_unit_test(run_prints_every_body_and_step),
        cmocka_unit_test(same_command_same_bytes),
        cmocka_unit_test(overrides_reach_the_scene),
        cmocka_unit_test(set_takes_what_scenes_say),
        cmocka_unit_test(overlaps_at_the_start_are_told),
        cmocka_unit_test(overlaps_that_are_meant_are_not),
        cmocka_unit_test(the_scene_chooses_its_solver),
        cmocka_unit_test(what_ran_is_explained),
        cmocka_unit_test(energy_is_explained),
        cmocka_unit_test(what_a_scene_prints_is_no_data),
        cmocka_unit_test(failed_expectations_are_code_4),
    };
    return cmocka_run_group_tests(tests, set_up, clean_up);
}
