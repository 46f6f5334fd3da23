// test_cli_files.c - the command line and files: hostile scenes, full disks, readers that leave, signals, conversion.
#define _XOPEN_SOURCE 700 // mkdtemp, realpath, popen's relatives

#include "cli_fixture.h"

static const char *const commands[] = { "run",  "render",  "check", "explain",
                                        "cost", "convert", "list" };

static void bad_scenes_are_code_3(void **state)
{
    (void)state;
    static const char *const names[] = { "binary.lua", "empty.json", "deep.json",
                                         "broken.lua", "typo.lua",   "nul.json" };
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
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        for (size_t k = 0; k < sizeof commands / sizeof commands[0] - 1; k++) {
            char line[128];
            snprintf(line, sizeof line, "\"$P\" %s %s %s", commands[k], names[i],
                     strcmp(commands[k], "render") == 0 ? "-o never.png" : "");
            expect_error(line, 3, names[i]);
        }
    }
    expect_error("\"$P\" run typo.lua", 3, "typo.lua:2:");
    assert_int_not_equal(access("never.png", F_OK), 0);
    expect_error("\"$P\" check good.lua typo.lua good.lua", 3, "typo.lua:2:");
    assert_non_null(strstr(out, "1 scene could not be judged"));
    assert_non_null(strstr(out, "2 expectations of 2 scenes: 2 ok, 0 failed"));
}

// A file that cannot be read is no fault of the scene.
static void files_that_cannot_be_read_are_code_1(void **state)
{
    (void)state;
    static const char *const names[] = { "absent.lua", "absent.json", "folder.lua" };
    mkdir("folder.lua", 0777);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        for (size_t k = 0; k < sizeof commands / sizeof commands[0] - 1; k++) {
            char line[128];
            snprintf(line, sizeof line, "\"$P\" %s %s %s", commands[k], names[i],
                     strcmp(commands[k], "render") == 0 ? "-o never.png" : "");
            expect_error(line, 1, names[i]);
        }
    }
    expect_error("\"$P\" run absent.lua", 1, "plumb: absent.lua: cannot be opened: No such file");
    expect_error("\"$P\" run folder.lua", 1, "folder.lua: is a folder, not a scene\n");
    expect_error("\"$P\" replay absent.rec", 1, "'absent.rec': No such file");
    expect_error("\"$P\" replay /dev/zero", 1, "is no recording");
    expect_error("\"$P\" diff /dev/zero /dev/zero", 1, "is no recording");
}

static void one_file_is_not_written_twice(void **state)
{
    (void)state;
    expect_code(
        "cp good.lua s.lua && cp good.lua keep.lua && \"$P\" run s.lua --record r.rec -o t.csv && "
        "\"$P\" convert s.lua j.json && cp r.rec k.rec && cp j.json k.json",
        0);
    // Links of both kinds, also to what is not there yet; other ways to spell a name.
    expect_code(
        "ln -s new.csv to-new.csv && ln t.csv hard.csv && ln -s t.csv soft.csv && mkdir sub && "
        "ln -s ../new.csv sub/up.csv && ln -s s.lua scene.csv && ln r.rec r2.csv && "
        "ln -s to-new.csv twice.csv && ln -s j.json j2.json",
        0);
    static const char *const lines[] = {
        "run s.lua -o new.csv --record new.csv",
        "run s.lua -o new.csv --record ./new.csv",
        "run s.lua -o sub/../new.csv --record new.csv",
        "run s.lua -o to-new.csv --record new.csv",
        "run s.lua -o new.csv --record twice.csv",
        "run s.lua -o sub/up.csv --record new.csv",
        "run s.lua -o t.csv --record hard.csv",
        "run s.lua -o soft.csv --record hard.csv",
        "run s.lua -o \"$PWD/new.csv\" --record new.csv",
        "run s.lua -o s.lua --format csv",
        "run s.lua -o scene.csv",
        "run s.lua --record s.lua -o t.csv",
        "render s.lua -o s.lua",
        "convert j.json j.json",
        "convert j.json ./j.json",
        "convert j.json j2.json",
        "replay r.rec -o r2.csv",
        "replay r.rec -o r.rec --format csv",
        "replay r.rec --render r.rec",
        "run s.lua --record o.txt >o.txt",
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        char line[256];
        snprintf(line, sizeof line, "\"$P\" %s", lines[i]);
        expect_usage_error(line, " are one file, '");
    }
    static const char *const nameless[] = {
        "run '' ",     "run s.lua -o ''", "run s.lua --record ''", "render s.lua -o ''",
        "convert '' ", "replay '' "
    };
    for (size_t i = 0; i < sizeof nameless / sizeof *nameless; i++) {
        char line[256];
        snprintf(line, sizeof line, "\"$P\" %s", nameless[i]);
        expect_usage_error(line, "the name of the file is empty");
    }
    expect_usage_error("\"$P\" render s.lua -o a.png --at 2 --time 1",
                       "--at 2 lies behind --time 1");
    expect_code("cmp s.lua keep.lua && cmp r.rec k.rec && cmp j.json k.json && ! test -e new.csv",
                0);
    // What is no file may be named twice, and files that are two are two.
    expect_code("\"$P\" run s.lua -o /dev/null --record /dev/null", 0);
    expect_code(
        "\"$P\" run s.lua -o new.csv --record new.rec && test -s new.csv && test -s new.rec", 0);
    // A link stays one, also when its file is made only now.
    expect_code("ln -s late.csv link1.csv && \"$P\" run s.lua -o link1.csv && test -L link1.csv && "
                "test -s late.csv",
                0);
    expect_code("ln -s late.png link1.png && \"$P\" render s.lua --time 0 -o link1.png && "
                "test -L link1.png && test -s late.png",
                0);
}

static void writing_fails_loudly(void **state)
{
    (void)state;
    // A disk that is full after 4 KiB: every way to write a file tells why.
    static const char *const outputs[] = {
        "run good.lua -o x.csv",      "run good.lua -o /dev/null --record x.rec",
        "render good.lua -o x.png",   "render good.lua --to 0.5 -o x.gif",
        "render good.lua -o x%d.png", "convert many.lua x.json",
        "run good.lua >x.txt",
    };
    write_text("many.lua", "for i = 1, 100 do body { circle { 1 }, at = { 3 * i, 0 } } end\n");
    for (size_t i = 0; i < sizeof outputs / sizeof *outputs; i++) {
        char line[256];
        snprintf(line, sizeof line, "trap '' XFSZ; ulimit -f 4; \"$P\" %s", outputs[i]);
        expect_error(line, 1, "File too large");
        assert_int_equal(count_lines(err), 1);
    }
    expect_code("rm -f x.txt; ! ls | grep -E '^x|tmp|part'", 0);
    if (access("/dev/full", W_OK) == 0) {
        expect_error("\"$P\" run good.lua >/dev/full", 1, "No space left");
        expect_error("\"$P\" run good.lua -o /dev/full", 1, "No space left");
        expect_error("\"$P\" run good.lua -o /dev/null --record /dev/full", 1, "No space left");
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
    write_text("lacks.lua",
               "body { name = 'a', circle { 1 }, user = { 1 } }\nat(1, function() end)\n"
               "every(1, function() end)\nevery_step(function() end)\n"
               "on_contact(function() end)\non_contact(function() end)\n"
               "exact { body = 'a', x = function(t) return 0 end }\n"
               "expect { 'e', test = function() return true end }\n");
    expect_code("\"$P\" convert lacks.lua >/dev/null", 0);
    assert_string_equal(err,
                        "plumb: convert: 5 handlers (at, every, every_step, on_contact), 1 closed "
                        "form, 1 test function, 1 user table of 'lacks.lua' have no JSON form and "
                        "are left out\n");
    expect_code("\"$P\" convert good.lua >/dev/null", 0);
    assert_string_equal(err, "");
    expect_code("\"$P\" convert good.lua one.json && \"$P\" convert one.json two.json && "
                "cmp one.json two.json && \"$P\" convert good.lua | cmp - one.json",
                0);
    expect_code("\"$P\" run good.lua >a && \"$P\" run one.json >b && cmp a b", 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_scenes_are_code_3),
        cmocka_unit_test(writing_fails_loudly),
        cmocka_unit_test(files_that_cannot_be_read_are_code_1),
        cmocka_unit_test(one_file_is_not_written_twice),
        cmocka_unit_test(a_reader_may_leave),
        cmocka_unit_test(files_appear_when_complete),
        cmocka_unit_test(convert_is_canonical),
    };
    return cmocka_run_group_tests(tests, set_up, clean_up);
}
