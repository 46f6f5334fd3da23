// test_cli_stop.c - the first SIGINT or SIGTERM ends the command line, whatever it is doing: a script that never ends,
// one long step, a replay that seeks. Time is processor time of the child, which a busy machine does not lengthen.
// PLUMB_FLOAT_ONLY: the command line holds all three precisions.
#define _DEFAULT_SOURCE // wait4, mkdtemp, realpath

#include "cli_fixture.h"

#include <fcntl.h>
#include <glob.h>
#include <signal.h>
#include <sys/resource.h>
#include <stdbool.h>
#include <time.h>

static const double BEFORE = 0.1; // [s] of processor time until the signal
static const double AFTER = 2;    // [s] that may pass after it

static double seconds(const struct timeval *t)
{
    return (double)t->tv_sec + 1e-6 * (double)t->tv_usec;
}

// [s] that a child has used so far; 0: it cannot be told any more.
static double cpu_of(pid_t child)
{
    char name[64], text[1024];
    snprintf(name, sizeof name, "/proc/%ld/stat", (long)child);
    FILE *file = fopen(name, "r");
    size_t length = file != NULL ? fread(text, 1, sizeof text - 1, file) : 0;
    text[length] = '\0';
    if (file != NULL) {
        fclose(file);
    }
    const char *rest = strrchr(text, ')');
    unsigned long user = 0, system = 0;
    if (rest != NULL) {
        sscanf(rest, ") %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &user, &system);
    }
    return (double)(user + system) / (double)sysconf(_SC_CLK_TCK);
}

// Whether a file that is being written is there, by the name that it has until it is whole; null: none is waited for.
static bool is_begun(const char *file)
{
    glob_t found;
    char pattern[64];
    if (file == NULL) {
        return true;
    }
    snprintf(pattern, sizeof pattern, "%s.*.tmp", file);
    const bool there = glob(pattern, 0, NULL, &found) == 0;
    if (there) {
        globfree(&found);
    }
    return there;
}

// Starts a command, waits until it works and has begun a file, if one is named, sends the signal; it must end by that
// signal and soon.
static void expect_stop_with(const char *file, const char *command, int number)
{
    char line[512];
    snprintf(line, sizeof line, "exec \"$P\" %s", command);
    pid_t child = fork();
    if (child == 0) {
        int null = open("/dev/null", O_RDWR);
        dup2(null, 0);
        dup2(null, 1);
        dup2(open("err.txt", O_WRONLY | O_CREAT | O_TRUNC, 0666), 2);
        signal(SIGINT, SIG_DFL); // a shell lets what it runs in the background ignore it
        execl("/bin/sh", "sh", "-c", line, (char *)NULL);
        _exit(127);
    }
    assert_true(child > 0);
    double used = 0;
    int status = 0;
    struct rusage usage;
    while (used < BEFORE || !is_begun(file)) {
        if (wait4(child, &status, WNOHANG, &usage) == child) {
            read_text("err.txt", err);
            fail_msg("%s: ended by itself, status %d: %s", command, status, err);
        }
        nanosleep(&(struct timespec){ .tv_nsec = 2000000 }, NULL);
        used = cpu_of(child);
    }
    kill(child, number);
    assert_int_equal(wait4(child, &status, 0, &usage), child);
    double after = seconds(&usage.ru_utime) + seconds(&usage.ru_stime) - used;
    read_text("err.txt", err);
    if (!WIFSIGNALED(status) || WTERMSIG(status) != number || after > AFTER) {
        fail_msg("%s: status %d, %.2f s after the signal: %s", command, status, after, err);
    }
    assert_string_equal(err, ""); // who asked for it needs no message
}

static void expect_stop(const char *command, int number)
{
    expect_stop_with(NULL, command, number);
}

static void set_scenes(void)
{
    write_text("build.lua", "while true do end\n");
    write_text("concat.lua", "local t = {} for i = 1, 1e5 do t[i] = '' end\n"
                             "while true do table.concat(t) end\n");
    write_text("grow.lua", "local t = {} for i = 1, 1e9 do t[i * 3] = i end\n");
    write_text("handler.lua", "scene { duration = 1e7 }\nbody { circle { 1 } }\n"
                              "every_step(function() for i = 1, 1e6 do end end)\n");
    write_text("compare.lua",
               "body { circle { 1 } }\nlocal a, b = ('\\0'):rep(65000), ('\\0'):rep(64999)\n"
               "at(0, function() while true do local c = a < b end end)\n");
    write_text("steps.lua", "scene { duration = 1e7 }\nbody { circle { 1 }, sleep = false }\n"
                            "every_step(function() end)\n");
    write_text("drift.lua", "scene { duration = 1e7, gravity = {0, 0} }\n"
                            "body { circle { 1 }, sleep = false }\nevery_step(function() end)\n");
    // One step takes half a second.
    write_text("pile.lua",
               "scene { duration = 1e7, solver = 'pgs', substeps = 64, iterations = 1000 }\n"
               "body { type = 'static', box { 99, 1 }, at = { 0, -1.5 } }\n"
               "for i = 0, 299 do body { circle { 1 }, sleep = false, "
               "at = { i % 20 * 2, i // 20 * 2 } } end\n");
    write_text("blast.lua",
               "for i = 1, 4000 do body { circle { 1 }, at = { i % 60 * 3, i // 60 * 3 } } end\n"
               "every_step(function() blast { at = { 80, 80 }, radius = 500, impulse = 1, "
               "occlusion = 'all' } end)\n");
}

static void the_first_signal_ends_it(void **state)
{
    (void)state;
    static const char *const scenes[] = { "build",   "concat", "grow", "handler",
                                          "compare", "steps",  "pile", "blast" };
    static const char *const lines[] = { "run %s.lua -o never.csv",
                                         "check %s.lua",
                                         "render %s.lua -o never.png",
                                         "render %s.lua -o never.gif",
                                         "cost %s.lua",
                                         "explain %s.lua --time 1e6",
                                         "convert %s.lua --time 1e6 never.json",
                                         "run %s.lua --precision double -o never.jsonl" };
    enum {
        SCENES = (int)(sizeof scenes / sizeof *scenes),
        LINES = (int)(sizeof lines / sizeof *lines)
    };
    set_scenes();
    for (int i = 0; i < SCENES; i++) {
        for (int k = 0; k < LINES; k += 3) { // each with some of them, by turns
            char command[128];
            snprintf(command, sizeof command, lines[(i + k) % LINES], scenes[i]);
            expect_stop(command, (i + k) % 2 == 0 ? SIGINT : SIGTERM);
        }
    }
    expect_code("! ls | grep -E 'never|tmp|part' >&2", 0); // and nothing is left of it
}

// Between two steps, where no step tells of the signal: what would be said at the end is not.
static void a_stop_between_steps_is_silent(void **state)
{
    (void)state;
    set_scenes();
    for (int i = 0; i < 5; i++) {
        expect_stop("convert drift.lua --time 1e7 never.json", i % 2 == 0 ? SIGINT : SIGTERM);
    }
    expect_code("! ls | grep -E 'never|tmp|part' >&2", 0);
}

static void a_recording_stays_as_far_as_it_went(void **state)
{
    (void)state;
    set_scenes();
    expect_stop_with("steps.rec", "run steps.lua -o /dev/null --record steps.rec", SIGINT);
    expect_code("\"$P\" replay steps.rec --info", 0);
    expect_stop_with("pile.rec", "run pile.lua -o /dev/null --record pile.rec", SIGTERM);
    expect_code("\"$P\" replay pile.rec --info", 0);
    expect_code("! ls | grep tmp", 0);
}

static void a_replay_ends_too(void **state)
{
    (void)state;
    set_scenes();
    // A recording that breaks off after some hundred thousand steps, without a keyframe to seek by.
    expect_code("\"$P\" run steps.lua --time 4000 --every 1000000 --keyframes 1000000 --record "
                "long.rec -o /dev/null",
                0);
    expect_stop("replay long.rec --step 240000", SIGINT);
    expect_stop("replay long.rec -o never.csv", SIGTERM);
    expect_stop("replay long.rec --list", SIGINT);
    expect_stop("replay long.rec --render never.png", SIGINT);
    expect_stop("replay long.rec --render never%d.png --fps 1000", SIGINT);
    expect_stop("diff long.rec long.rec", SIGTERM);
    expect_code("rm -f never*.png; ! ls | grep -E 'never|tmp|part' >&2", 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_signal_ends_it),
        cmocka_unit_test(a_stop_between_steps_is_silent),
        cmocka_unit_test(a_recording_stays_as_far_as_it_went),
        cmocka_unit_test(a_replay_ends_too),
    };
    return cmocka_run_group_tests(tests, set_up, clean_up);
}
