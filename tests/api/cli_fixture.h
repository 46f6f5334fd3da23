// cli_fixture.h - what the tests of the command line share: scenes in a folder of their own below $TMPDIR, the built
// binary run in it by a shell, what it said. The binary is $PLUMB_BIN or build/plumb.
#ifndef CLI_FIXTURE_H
#define CLI_FIXTURE_H

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

static inline void write_bytes(const char *name, const char *bytes, size_t count)
{
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, count, file), count);
    assert_int_equal(fclose(file), 0);
}

static inline void write_text(const char *name, const char *text)
{
    write_bytes(name, text, strlen(text));
}

static inline size_t read_text(const char *name, char *text)
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
static inline int shell(const char *command)
{
    char line[8192];
    snprintf(line, sizeof line, "{ %s\n} >out.txt 2>err.txt </dev/null", command);
    int status = system(line);
    read_text("out.txt", out);
    read_text("err.txt", err);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static inline void expect_code(const char *command, int code)
{
    int got = shell(command);
    if (got != code) {
        fail_msg("%s: exit code %d, not %d\nstderr: %s", command, got, code, err);
    }
}

static inline void expect_error(const char *command, int code, const char *message)
{
    expect_code(command, code);
    if (strstr(err, message) == NULL) {
        fail_msg("%s: '%s' is not in: %s", command, message, err);
    }
}

static inline int count_lines(const char *text)
{
    int count = 0;
    for (; *text != '\0'; text++) {
        count += *text == '\n';
    }
    return count;
}

// A command line that is refused: one line that tells why, and nothing else.
static inline void expect_usage_error(const char *command, const char *message)
{
    expect_error(command, 2, message);
    assert_int_equal(strncmp(err, "plumb: ", 7), 0);
    assert_int_equal(count_lines(err), 1);
    assert_string_equal(out, "");
}

static inline int set_up(void **state)
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

static inline int clean_up(void **state)
{
    (void)state;
    char line[128];
    snprintf(line, sizeof line, "rm -rf '%s'", folder);
    return chdir("/") == 0 && system(line) == 0 ? 0 : 1;
}

#endif
