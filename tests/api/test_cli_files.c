// test_cli_files.c - the command line and files: hostile scenes, full disks, readers that leave, signals, conversion.
#define _XOPEN_SOURCE 700 // mkdtemp, realpath, popen's relatives

#include "cli_fixture.h"

static const char *const commands[] = { "run",  "render",  "check", "explain",
                                        "cost", "convert", "list" };

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
    expect_code("\"$P\" run good.lua >a", 0);
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

static void convert_is_canonical(void **state)
{
    (void)state;
    expect_code("\"$P\" convert good.lua one.json && \"$P\" convert one.json two.json && "
                "cmp one.json two.json && \"$P\" convert good.lua | cmp - one.json",
                0);
    expect_code("\"$P\" run good.lua >a && \"$P\" run one.json >b && cmp a b", 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_scenes_are_code_3), cmocka_unit_test(writing_fails_loudly),
        cmocka_unit_test(a_reader_may_leave),    cmocka_unit_test(files_appear_when_complete),
        cmocka_unit_test(convert_is_canonical),
    };
    return cmocka_run_group_tests(tests, set_up, clean_up);
}
