// test_cli.c - the command line as its users meet it: the built binary, run by a shell.
//
// Exit codes, what goes to stdout and what to stderr, suggestions for typos, hostile files, full
// disks, readers that leave, signals, and that the same command gives the same bytes.
// The binary is $PLUMB_BIN or build/plumb. Files are made in a folder of their own below $TMPDIR.
#define _XOPEN_SOURCE 700 // mkdtemp, realpath, popen's relatives

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

enum { OUTPUT_MAX = 1 << 20 };

static char binary[4096];
static char folder[64];
static char out[OUTPUT_MAX], err[OUTPUT_MAX]; // of the last command

// A ball that falls on a floor and comes to rest: everything a command may ask for.
static const char good_scene[] =
    "scene { title = 'drop', duration = 1, dt = 1/60 }\n"
    "body { name = 'floor', type = 'static', box { 10, 1 }, at = {0, -0.5} }\n"
    "body { name = 'ball', circle { 0.5 }, at = {0, 2} }\n"
    "body { name = 'a,\"b\"', box { 1, 1 }, at = {2, 3} }\n"
    "expect { 'ball stays up', body = 'ball', y = {0.4, 2}, always = true }\n";

static const char failing_scene[] =
    "scene { title = 'fails', duration = 0.5 }\n"
    "body { name = 'ball', circle { 0.5 }, at = {0, 2} }\n"
    "expect { 'ball floats', body = 'ball', y = {1.9, 2.1}, at = 0.5 }\n"
    "expect { 'ball falls', body = 'ball', vy = {-10, -1}, at = 0.5 }\n";

static const char exact_scene[] = "scene { title = 'throw', duration = 0.5, gravity = {0, -10} }\n"
                                  "body { name = 'ball', circle { 0.5 }, velocity = {3, 4} }\n"
                                  "exact { body = 'ball', x = function(t) return 3 * t end,\n"
                                  "        y = function(t) return 4 * t - 5 * t * t end }\n";

static void write_bytes(const char *name, const char *bytes, size_t count)
{
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, count, file), count);
    assert_int_equal(fclose(file), 0);
}

static void write_text(const char *name, const char *text)
{
    write_bytes(name, text, strlen(text));
}

static size_t read_text(const char *name, char *text)
{
    FILE *file = fopen(name, "rb");
    if (file == NULL) {
        text[0] = '\0';
        return 0;
    }
    size_t count = fread(text, 1, OUTPUT_MAX - 1, file);
    text[count] = '\0';
    fclose(file);
    return count;
}

// Runs a shell command in which $P is the binary; exit code, or 128 + signal.
static int shell(const char *command)
{
    char line[8192];
    snprintf(line, sizeof line, "{ %s\n} >out.txt 2>err.txt </dev/null", command);
    int status = system(line);
    read_text("out.txt", out);
    read_text("err.txt", err);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static void expect_code(const char *command, int code)
{
    int got = shell(command);
    if (got != code) {
        fail_msg("%s: exit code %d, not %d\nstderr: %s", command, got, code, err);
    }
}

static void expect_error(const char *command, int code, const char *message)
{
    expect_code(command, code);
    if (strstr(err, message) == NULL) {
        fail_msg("%s: '%s' is not in: %s", command, message, err);
    }
}

static int count_lines(const char *text)
{
    int count = 0;
    for (; *text != '\0'; text++) {
        count += *text == '\n';
    }
    return count;
}

static const char *const commands[] = { "run",  "render",  "check", "explain",
                                        "cost", "convert", "list" };
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
    { "run good.lua --substeps 99999999999999999999", "is not a whole number" },
    { "run good.lua --substeps ''", "'' is not a whole number" },
    { "run good.lua --solver sofd", "did you mean 'soft'?" },
    { "run good.lua --precision half", "'half' is not one of float,double" },
    { "run good.lua --width 5", "5 is not 0, 4, 8 or 16" },
    { "run good.lua --set friction", "'friction' is not of the form key=value" },
    { "run good.lua --set =1", "'=1' is not of the form key=value" },
    { "run good.lua --set frictoin=1", "frictoin" },
    { "run good.lua --set frction=1", "neither a key of scene{} nor a param of this scene\n" },
    { "run good.lua --set solver=sfot", "must be one of soft|pgs, not 'sfot' (did you mean" },
    { "run good.lua --set solver=3", "'solver' of scene{} must be a string, not a number" },
    { "run good.lua --every 0.5", "neither a number of steps (10) nor a time (0.5s)" },
    { "run good.lua --every 0", "neither a number of steps" },
    { "run good.lua --every -1s", "neither a number of steps" },
    { "run good.lua --format cvs", "did you mean 'csv'?" },
    { "run good.lua -o a.json", "JSON lines are named .jsonl" },
    { "run good.lua -o a.txt", "'a.txt' does not end in .csv, .jsonl or .ndjson" },
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
    { "cost good.lua --substeps 1,x", "is not a list of whole numbers such as 1,2,4" },
    { "cost good.lua --substeps 1,,2", "is not a list of whole numbers" },
    { "cost good.lua --solvers soft,pg", "did you mean 'pgs'?" },
    { "cost good.lua --repeat 0", "--repeat: 0 is outside 1 to 1000" },
    { "convert good.lua a.txt", "does not end in .json" },
    { "list sovlers", "did you mean 'solvers'?" },
};

static void usage_errors_tell_the_remedy(void **state)
{
    (void)state;
    char line[256];
    for (size_t i = 0; i < sizeof usage_cases / sizeof usage_cases[0]; i++) {
        snprintf(line, sizeof line, "\"$P\" %s", usage_cases[i].arguments);
        expect_error(line, 2, usage_cases[i].message);
        assert_int_equal(strncmp(err, "plumb: ", 7), 0);
        assert_int_equal(count_lines(err), 1);
        assert_string_equal(out, "");
    }
    assert_int_not_equal(access("a.png", F_OK), 0);
    assert_int_not_equal(access("a.gif", F_OK), 0);
    assert_int_not_equal(access("a.txt", F_OK), 0);
}

static void list_is_one_item_a_line(void **state)
{
    (void)state;
    expect_code("\"$P\" list solvers", 0);
    assert_string_equal(out, "solvers:\n  soft\n  pgs\n");
    expect_code("\"$P\" list passes", 0);
    int passes = count_lines(out);
    assert_true(passes > 1 + 8);
    assert_non_null(strstr(out, "\n  classic solver  "));
    expect_code("\"$P\" list passes --brief", 0);
    assert_int_equal(count_lines(out), passes);
    assert_non_null(strstr(out, "\n  classic solver\n"));
    expect_code("\"$P\" list overlays", 0);
    assert_int_equal(count_lines(out), 1 + 14);
    assert_non_null(strstr(out, "\n  contacts\n"));
    expect_code("\"$P\" list scene --brief", 0);
    assert_int_equal(count_lines(out), 1 + 37);
    assert_non_null(strstr(out, "\n  scene\n  material\n  material_pair\n  body\n"));
    expect_code("\"$P\" list joints --brief", 0);
    assert_int_equal(count_lines(out), 1 + 11 + 2);
    assert_non_null(strstr(out, "joints of scene files:\n  revolute\n  prismatic\n"));
    expect_code("\"$P\" list joints", 0);
    assert_non_null(
        strstr(out, "\n    pitch             number, -1e+12 to 1e+12 [rad], required\n"));
    expect_code("\"$P\" list shapes --brief", 0);
    assert_int_equal(count_lines(out), 1 + 8);
    expect_code("\"$P\" list materials --brief", 0);
    assert_string_equal(out, "materials of scene files:\n  material\n  material_pair\n");
    expect_code("\"$P\" list scene", 0);
    assert_non_null(strstr(out, "\n    solver            one of soft|pgs\n"));
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
    expect_code("\"$P\" run good.lua --precision double >b; ! cmp -s a b", 0);
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

static void bad_scenes_are_code_3(void **state)
{
    (void)state;
    static const char *const names[] = { "binary.lua", "empty.json", "deep.json",  "broken.lua",
                                         "typo.lua",   "absent.lua", "folder.lua", "nul.json" };
    char deep[20000], binary_bytes[4096];
    memset(deep, '[', sizeof deep);
    for (size_t i = 0; i < sizeof binary_bytes; i++) {
        binary_bytes[i] = (char)(i * 2654435761u >> 13);
    }
    write_bytes("binary.lua", binary_bytes, sizeof binary_bytes);
    write_bytes("deep.json", deep, sizeof deep);
    write_bytes("nul.json", "{\"a\":\0}", 7);
    write_text("empty.json", "");
    write_text("broken.lua", "scene { duration = \n");
    write_text("typo.lua", "scene { duration = 1 }\nbody { circle { 1 }, fristion = 2 }\n");
    mkdir("folder.lua", 0777);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        for (size_t k = 0; k < sizeof commands / sizeof commands[0] - 1; k++) {
            char line[128];
            snprintf(line, sizeof line, "\"$P\" %s %s %s", commands[k], names[i],
                     strcmp(commands[k], "render") == 0 ? "-o never.png" : "");
            expect_error(line, 3, names[i]);
        }
    }
    expect_error("\"$P\" run folder.lua", 3, "folder.lua: is a folder, not a scene\n");
    expect_error("\"$P\" run typo.lua", 3, "typo.lua:2:");
    assert_int_not_equal(access("never.png", F_OK), 0);
    expect_error("\"$P\" check good.lua typo.lua good.lua", 3, "typo.lua:2:");
    assert_non_null(strstr(out, "1 scene could not be judged"));
    assert_non_null(strstr(out, "2 expectations of 2 scenes: 2 ok, 0 failed"));
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

static void writing_fails_loudly(void **state)
{
    (void)state;
    if (access("/dev/full", W_OK) == 0) {
        expect_error("\"$P\" run good.lua >/dev/full", 1, "No space left");
        expect_error("\"$P\" run good.lua -o /dev/full", 1, "No space left");
        expect_error("\"$P\" list >/dev/full", 1, "No space left");
        expect_error("\"$P\" --help >/dev/full", 1, "No space left");
        expect_error("\"$P\" check good.lua >/dev/full", 1, "No space left");
        expect_error("\"$P\" convert good.lua >/dev/full", 1, "No space left");
    }
    expect_error("\"$P\" run good.lua >&-", 1, "cannot write to standard output");
    expect_error("\"$P\" run good.lua -o absent/a.csv", 1, "cannot write 'absent/a.csv'");
    expect_error("\"$P\" convert good.lua absent/a.json", 1, "cannot write 'absent/a.json'");
    expect_error("\"$P\" render good.lua --time 0 -o absent/a.png", 1, "absent/a.png");
}

static void a_reader_may_leave(void **state)
{
    (void)state;
    expect_code("{ \"$P\" run good.lua --dt 1e-4; echo $? >code; } | head -1; cat code >&2", 0);
    assert_int_equal(count_lines(out), 1);
    assert_string_equal(err, "0\n");
}

static void files_appear_when_complete(void **state)
{
    (void)state;
    write_text("keep.csv", "precious\n");
    expect_code("\"$P\" run typo.lua -o keep.csv", 3);
    expect_code("grep -qx precious keep.csv", 0);
    expect_code("\"$P\" run good.lua --body nobody -o keep.csv", 2);
    expect_code("grep -qx precious keep.csv", 0);
    // A run that would take days is stopped: by the signal, without a file or a piece of one.
    expect_code(
        "\"$P\" run good.lua --time 1e8 -o long.csv & p=$!; sleep 0.5; kill -TERM $p; wait $p",
        128 + 15);
    expect_code("! ls | grep -E 'long|tmp$'", 0);
    // Through a link to the file it stands for; rights stay.
    expect_code("ln -s keep.csv link.csv && chmod 600 keep.csv && \"$P\" run good.lua -o link.csv "
                "&& test -L link.csv && cmp keep.csv a && test \"$(stat -c %a keep.csv)\" = 600",
                0);
}

static void cost_measures_and_judges(void **state)
{
    (void)state;
    expect_code("\"$P\" cost exact.lua --substeps 1,4 --repeat 1 --csv", 0);
    assert_int_equal(count_lines(out), 1 + 2 * 2 * 2);
    assert_non_null(strstr(out, "solver,substeps,precision,cpu [s/s],error [m],"));
    assert_non_null(strstr(out, "soft,4,double,"));
    expect_code("\"$P\" cost exact.lua --substeps 4 --solvers soft --repeat 1", 0);
    assert_non_null(strstr(out, "closed form"));
    assert_int_equal(strncmp(strstr(out, "overlap m\n"), "overlap m\n*", 11), 0);
    expect_code("\"$P\" cost good.lua --substeps 2 --solvers soft --precisions float --repeat 1",
                0);
    assert_non_null(strstr(out, "own finest setting"));
    expect_code("\"$P\" cost exact.lua --substeps 2 --repeat 1 --tolerance 10", 0);
    assert_non_null(strstr(out, "cheapest within 10 m: --solver "));
    expect_code("\"$P\" cost good.lua --substeps 1 --repeat 1 --tolerance 0", 4);
    assert_non_null(strstr(out, "no setting stays within 0 m"));
}

static void convert_is_canonical(void **state)
{
    (void)state;
    expect_code("\"$P\" convert good.lua one.json && \"$P\" convert one.json two.json && "
                "cmp one.json two.json && \"$P\" convert good.lua | cmp - one.json",
                0);
    expect_code("\"$P\" run one.json >b && cmp a b", 0);
}

static unsigned big_endian(const char *bytes)
{
    const unsigned char *b = (const unsigned char *)bytes;
    return (unsigned)b[0] << 24 | (unsigned)b[1] << 16 | (unsigned)b[2] << 8 | b[3];
}

static void render_draws(void **state)
{
    (void)state;
    expect_code("\"$P\" render good.lua --at 0.5 --size 320x200 -o one.png", 0);
    assert_true(read_text("one.png", out) > 1000);
    assert_memory_equal(out, "\x89PNG\r\n\x1a\n", 8);
    assert_int_equal(big_endian(out + 16), 320);
    assert_int_equal(big_endian(out + 20), 200);
    expect_code("\"$P\" render good.lua --at 0.5 --size 320x200 -o two.png && cmp one.png two.png",
                0);
    expect_code("\"$P\" render good.lua --at 0.5 --size 320x200 -o two.png "
                "--overlay contacts,impulses,velocities,aabbs,legend,no-grid && "
                "! cmp -s one.png two.png",
                0);
    expect_code("\"$P\" render good.lua --size 64x64 --fps 4 -o 'f%02d.png' && "
                "test -e f04.png && ! test -e f05.png",
                0);
    expect_code("\"$P\" render good.lua --size 64x64 --fps 4 --follow ball -o film.gif", 0);
    assert_true(read_text("film.gif", out) > 100);
    assert_memory_equal(out, "GIF89a", 6);
    expect_error("PATH=/nowhere \"$P\" render good.lua --size 64x64 -o film.mp4", 1, "ffmpeg");
    assert_int_not_equal(access("film.mp4", F_OK), 0);
}

// camera{at, trail} say what a single picture shows; --at and --trail what else.
static void a_scene_knows_its_moment(void **state)
{
    (void)state;
    char text[1024];
    snprintf(text, sizeof text, "%scamera { at = 0.5, trail = 0.25 }\n", good_scene);
    write_text("moment.lua", text);
    expect_code("\"$P\" render moment.lua --size 64x64 -o m.png && "
                "\"$P\" render good.lua --size 64x64 --at 0.5 --trail 0.25 -o g.png && "
                "cmp m.png g.png",
                0);
    expect_code("\"$P\" render moment.lua --size 64x64 --at 1 --trail 0 -o m.png && "
                "\"$P\" render good.lua --size 64x64 -o g.png && cmp m.png g.png",
                0);
    expect_code("\"$P\" convert moment.lua", 0);
    assert_non_null(strstr(out, "\"at\":0.5"));
    assert_non_null(strstr(out, "\"trail\":0.25"));
}

//---- recordings ----------------------------------------------------------------------------------

// A ball that a handler pushes after half a second.
static const char push_scene[] =
    "scene { title = 'push', duration = 1, dt = 1/64 }\n"
    "body { name = 'floor', type = 'static', box { 10, 1 }, at = {0, -0.5} }\n"
    "local ball = body { name = 'ball', circle { 0.5 }, at = {0, 2} }\n"
    "at(0.5, function() ball:set_velocity(3, 1) end)\n";

static void a_recording_is_replayed(void **state)
{
    (void)state;
    write_text("push.lua", push_scene);
    expect_code(
        "\"$P\" run push.lua -o run.csv && \"$P\" run push.lua --record p.rec -o rec.csv && "
        "cmp run.csv rec.csv",
        0);
    expect_code("\"$P\" replay p.rec -o again.csv && cmp run.csv again.csv", 0);
    expect_code("\"$P\" replay p.rec --width 4 -o again.csv && cmp run.csv again.csv", 0);
    expect_code("\"$P\" run push.lua --record q.rec -o /dev/null && cmp p.rec q.rec", 0);
    expect_code("\"$P\" run push.lua --precision double --record d.rec -o run.csv && "
                "\"$P\" replay d.rec -o again.csv && cmp run.csv again.csv",
                0);
    expect_code("\"$P\" replay p.rec --info", 0);
    static const char head[] = "title      push\nprecision  float\nsteps      64, after 0 that are "
                               "not recorded\ntime       0 s to 1 s\nedited     1 steps\n"
                               "keyframes  1\nbytes      ";
    assert_memory_equal(out, head, sizeof head - 1);
    assert_non_null(strstr(out, "\ncomplete   yes\n"));
}

static void a_replay_goes_anywhere(void **state)
{
    (void)state;
    expect_code("\"$P\" run push.lua --every 16 --body ball >all.csv && "
                "\"$P\" run push.lua --keyframes 10 --record k.rec -o /dev/null && "
                "{ head -1 all.csv; for n in 0 16 32 48 64; do "
                "\"$P\" replay k.rec --step $n --body ball | tail -1; done; } | cmp - all.csv",
                0);
    expect_code("\"$P\" replay k.rec --step 32 >a && \"$P\" replay k.rec --seek 0.5 >b && cmp a b",
                0);
    expect_code("\"$P\" replay k.rec --step 33 --list", 0);
    assert_non_null(strstr(out, "step 33  time 0.515625 s  dt 0.015625 s  hash "));
    assert_non_null(strstr(out, "\n  before the step: body 'ball': vx 0 -> 3\n"));
    expect_code("\"$P\" replay k.rec --list", 0);
    assert_int_equal(strncmp(out, "step 0  time 0 s  dt 0 s  hash ", 31), 0);
    expect_error("\"$P\" replay k.rec --step 65", 2,
                 "plumb: replay: option --step: 65 is beyond the last step, 64\n");
    expect_error("\"$P\" replay k.rec --seek 1.5", 2,
                 "plumb: replay: option --seek: 1.5 s is beyond the end, 1 s\n");
    expect_error("\"$P\" replay k.rec --seek 1 --step 2", 2, "--seek names a moment already");
    expect_error("\"$P\" replay k.rec --list --body ball", 2, "belong to the table of bodies");
    expect_error("\"$P\" replay k.rec --body bell", 2,
                 "plumb: option --body: no body of 'push' is named 'bell'; did you mean 'ball'?\n");
    expect_error("\"$P\" replay k.rec --width 5", 2, "5 is not 0, 4, 8 or 16");
}

// Of a scene that gives no looks the pictures of a recording are those of the scene, to the byte.
static void a_recording_is_drawn(void **state)
{
    (void)state;
    expect_code("\"$P\" run good.lua --keyframes 10 --record g.rec -o /dev/null && "
                "\"$P\" render good.lua --size 320x200 -o s.png && "
                "\"$P\" replay g.rec --size 320x200 --render r.png && cmp s.png r.png",
                0);
    assert_string_equal(out, "");
    expect_code(
        "\"$P\" render good.lua --size 320x200 --at 0.5 --trail 0.25 --overlay contacts,legend "
        "--title x --zoom 2 --follow ball -o s.png && "
        "for when in '--seek 0.5' '--step 30'; do "
        "\"$P\" replay g.rec --size 320x200 $when --trail 0.25 --overlay contacts,legend "
        "--title x --zoom 2 --follow ball --render r.png && cmp s.png r.png || exit; done",
        0);
    expect_code("\"$P\" replay g.rec --size 64x64 --fps 4 --render 's%02d.png' && "
                "\"$P\" render good.lua --size 64x64 --fps 4 -o 'r%02d.png' && "
                "test -e s04.png && ! test -e s05.png && "
                "for i in 00 01 02 03 04; do cmp s$i.png r$i.png || exit; done",
                0);
    expect_code(
        "\"$P\" replay g.rec --size 64x64 --fps 8 --from 0.5 --to 0.75 --render 'h%02d.png' && "
        "test -e h02.png && ! test -e h03.png",
        0);
    expect_code("\"$P\" replay g.rec --size 64x64 --fps 4 --to 0.5 --render g.gif", 0);
    assert_true(read_text("g.gif", out) > 100);
    assert_memory_equal(out, "GIF89a", 6);
    // One without a step.
    expect_code("\"$P\" run good.lua --time 0 --record n.rec -o /dev/null && "
                "\"$P\" replay n.rec --size 64x64 --render n.png && "
                "\"$P\" replay n.rec --size 64x64 --fps 10 --render 'n%d.png' && test -e n0.png && "
                "! test -e n1.png",
                0);
    expect_code("\"$P\" run good.lua --precision double --record e.rec -o /dev/null && "
                "\"$P\" render good.lua --precision double --size 64x64 -o s.png && "
                "\"$P\" replay e.rec --size 64x64 --render r.png && cmp s.png r.png",
                0);
}

static const struct {
    const char *arguments, *message;
} replay_cases[] = {
    { "--render", "option --render: needs a value (FILE)" },
    { "--render z.bmp", "'z.bmp'" },
    { "--render z%s.png", "%" },
    { "--render z.png --size 1x9", "1x9 is outside 16 to 8192" },
    { "--render z.png --follow bell", "option --follow: no body of 'drop' is named 'bell'; did you "
                                      "mean 'ball'?" },
    { "--render z.png --overlay contcts", "did you mean 'contacts'?" },
    { "--render z.png --from 0.5", "--from and --to are for films; 'z.png' is one picture" },
    { "--render z.png --fps 5", "--fps is for films; 'z.png' is one picture" },
    { "--render z.gif --seek 0.5",
      "option --seek: is for one picture; a film has --from and --to" },
    { "--render z.gif --step 3", "option --step: is for one picture; a film has --from and --to" },
    { "--render z.gif --from 0.5 --to 0.25", "--to 0.25 lies before --from 0.5" },
    { "--render z.gif --to 2", "option --to: 2 s is beyond the end, 1" },
    { "--render z.gif --from 2", "option --from: 2 s is beyond the end, 1" },
    { "--render z.png --seek 2", "option --seek: 2 s is beyond the end, 1" },
    { "--render z.png --step 61", "option --step: 61 is beyond the last step, 60" },
    { "--render z.png --seek 1 --step 1", "--seek names a moment already" },
    { "--render z.png --list", "option --list: is for text; --render makes pictures" },
    { "--render z.png --info", "option --info: is for text" },
    { "--render z.png -o z.csv", "option --output: is for text" },
    { "--render z.png --format csv", "option --format: is for text" },
    { "--render z.png --every 2", "option --every: is for text" },
    { "--render z.png --body ball", "option --body: is for text" },
    { "--size 64x64", "option --size: is for pictures; --render FILE makes them" },
    { "--from 0", "option --from: is for pictures" },
    { "--to 1", "option --to: is for pictures" },
    { "--fps 30", "option --fps: is for pictures" },
    { "--follow ball", "option --follow: is for pictures" },
    { "--zoom 2", "option --zoom: is for pictures" },
    { "--overlay grid", "option --overlay: is for pictures" },
    { "--trail 0", "option --trail: is for pictures" },
    { "--title x", "option --title: is for pictures" },
};

static void drawing_a_recording_tells_the_remedy(void **state)
{
    (void)state;
    char line[256];
    for (size_t i = 0; i < sizeof replay_cases / sizeof replay_cases[0]; i++) {
        snprintf(line, sizeof line, "\"$P\" replay g.rec %s", replay_cases[i].arguments);
        expect_error(line, 2, replay_cases[i].message);
        assert_int_equal(strncmp(err, "plumb: ", 7), 0);
        assert_int_equal(count_lines(err), 1);
        assert_string_equal(out, "");
    }
    // Files that are no recording, or a piece of one, leave no picture behind.
    expect_error("\"$P\" replay good.lua --render z.png", 1, "plumb: 'good.lua' is no recording\n");
    expect_error("\"$P\" replay absent.rec --render z.png", 1, "cannot read 'absent.rec'");
    expect_error("{ head -c 3000 g.rec; printf x; tail -c +3002 g.rec; } >x.rec; "
                 "\"$P\" replay x.rec --render z.png",
                 1, "plumb: 'x.rec' is damaged\n");
    expect_code("head -c -100 g.rec >c.rec; \"$P\" replay c.rec --size 64x64 --render c.png", 0);
    expect_error("\"$P\" replay g.rec --render absent/z.png", 1, "absent/z.png");
    expect_error("PATH=/nowhere \"$P\" replay g.rec --size 64x64 --render z.mp4", 1, "ffmpeg");
    expect_code("! ls | grep '^z'", 0);
}

static void differences_are_found(void **state)
{
    (void)state;
    expect_code("\"$P\" diff p.rec k.rec", 0);
    assert_string_equal(out, "the same for 64 steps\n");
    expect_code("sed 's/(3, 1)/(4, 1)/' push.lua >pull.lua && "
                "\"$P\" run pull.lua --record o.rec -o /dev/null && \"$P\" diff p.rec o.rec",
                6);
    assert_string_equal(out, "differ after step 33, 0.515625 s, in what was done before it\n"
                             "first: body 'ball': vx 3 | 4\n");
    expect_code("\"$P\" diff --brief p.rec o.rec", 6);
    assert_string_equal(out, "");
    expect_code("\"$P\" run push.lua --substeps 8 --record s.rec -o /dev/null && "
                "\"$P\" diff p.rec s.rec",
                6);
    assert_int_equal(strncmp(out, "setting: world: substeps 4 | 8\ndiffer after step ", 49), 0);
    assert_non_null(strstr(out, "in pass 'soft step'\nfirst: contact of body 'ball' and body "
                                "'floor': normal "));
    expect_code("\"$P\" run push.lua --time 0.5 --record t.rec -o /dev/null && "
                "\"$P\" diff p.rec t.rec",
                6);
    assert_string_equal(out, "the same for 32 steps; then only one goes on: 64 | 32 steps\n");
    expect_error("\"$P\" diff p.rec d.rec", 1,
                 "plumb: diff: 'p.rec' was recorded in float precision, 'd.rec' in double; nothing "
                 "in them is the same\n");
    expect_error("\"$P\" diff p.rec", 2, "RECORDING");
    expect_error("\"$P\" diff --from 65 p.rec k.rec", 2,
                 "plumb: diff: option --from: 65 is beyond the last step, 64\n");
}

static void bad_recordings_are_refused(void **state)
{
    (void)state;
    expect_error("\"$P\" replay nowhere.rec", 1,
                 "plumb: cannot read 'nowhere.rec': No such file or directory\n");
    expect_error("\"$P\" replay push.lua", 1, "plumb: 'push.lua' is no recording\n");
    expect_error("\"$P\" diff p.rec push.lua", 1, "plumb: 'push.lua' is no recording\n");
    expect_error("head -c 600 p.rec >c.rec; \"$P\" replay c.rec", 1,
                 "plumb: 'c.rec' is truncated before its first step\n");
    expect_error("{ head -c 3000 p.rec; printf x; tail -c +3002 p.rec; } >x.rec; "
                 "\"$P\" replay x.rec",
                 1, "plumb: 'x.rec' is damaged\n");
    expect_code("head -c -100 p.rec >c.rec; \"$P\" replay c.rec --info", 0);
    assert_non_null(strstr(out, "complete   no: it breaks off after its last step\n"));
    expect_error("\"$P\" run push.lua --record -", 2,
                 "plumb: run: option --record: a recording goes to a file, not to stdout\n");
    expect_error("\"$P\" run push.lua --keyframes 3", 2,
                 "plumb: run: option --keyframes: needs --record\n");
    expect_error("\"$P\" run push.lua --record /nowhere/x.rec -o /dev/null", 1, "/nowhere/x.rec");
    if (access("/dev/full", W_OK) == 0) {
        expect_error("\"$P\" run push.lua --record /dev/full -o /dev/null", 1, "/dev/full");
    }
}

static int set_up(void **state)
{
    (void)state;
    const char *given = getenv("PLUMB_BIN");
    const char *place = getenv("TMPDIR");
    if (realpath(given != NULL ? given : "build/plumb", binary) == NULL) {
        fprintf(stderr, "no binary: set PLUMB_BIN or build build/plumb\n");
        return 1;
    }
    snprintf(folder, sizeof folder, "%.40s/plumb-cli-XXXXXX", place != NULL ? place : "/tmp");
    if (mkdtemp(folder) == NULL || chdir(folder) != 0 || setenv("P", binary, 1) != 0) {
        return 1;
    }
    write_text("good.lua", good_scene);
    write_text("failing.lua", failing_scene);
    write_text("exact.lua", exact_scene);
    return 0;
}

static int clean_up(void **state)
{
    (void)state;
    char line[128];
    snprintf(line, sizeof line, "rm -rf '%s'", folder);
    return chdir("/") == 0 && system(line) == 0 ? 0 : 1;
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
        cmocka_unit_test(the_scene_chooses_its_solver),
        cmocka_unit_test(what_a_scene_prints_is_no_data),
        cmocka_unit_test(bad_scenes_are_code_3),
        cmocka_unit_test(failed_expectations_are_code_4),
        cmocka_unit_test(writing_fails_loudly),
        cmocka_unit_test(a_reader_may_leave),
        cmocka_unit_test(files_appear_when_complete),
        cmocka_unit_test(cost_measures_and_judges),
        cmocka_unit_test(convert_is_canonical),
        cmocka_unit_test(render_draws),
        cmocka_unit_test(a_scene_knows_its_moment),
        cmocka_unit_test(a_recording_is_replayed),
        cmocka_unit_test(a_replay_goes_anywhere),
        cmocka_unit_test(a_recording_is_drawn),
        cmocka_unit_test(drawing_a_recording_tells_the_remedy),
        cmocka_unit_test(differences_are_found),
        cmocka_unit_test(bad_recordings_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, clean_up);
}
