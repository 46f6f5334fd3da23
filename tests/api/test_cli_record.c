// test_cli_record.c - the command line and pictures and recordings: render, run --record, replay, diff.
#define _XOPEN_SOURCE 700 // mkdtemp, realpath, popen's relatives

#include "cli_fixture.h"

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
                "--overlay contacts,impulses,velocities,aabbs,field,legend,no-grid && "
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
    expect_code("\"$P\" run push.lua --precision far --record f.rec -o run.csv && "
                "\"$P\" replay f.rec -o again.csv && cmp run.csv again.csv",
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

// The pictures of a recording are those of the scene, to the byte.
static void a_recording_is_drawn(void **state)
{
    (void)state;
    expect_code("\"$P\" run good.lua --keyframes 10 --record g.rec -o /dev/null && "
                "\"$P\" render good.lua --size 320x200 -o s.png && "
                "\"$P\" replay g.rec --size 320x200 --render r.png && cmp s.png r.png",
                0);
    assert_string_equal(out, "");
    expect_code(
        "\"$P\" render good.lua --size 320x200 --at 0.5 --trail 0.25 --overlay "
        "contacts,field,legend "
        "--title x --zoom 2 --follow ball -o s.png && "
        "for when in '--seek 0.5' '--step 30'; do "
        "\"$P\" replay g.rec --size 320x200 $when --trail 0.25 --overlay contacts,field,legend "
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

// Colours, labels, what is hidden, counters, texts and the camera are those of the moment.
static void a_recording_keeps_its_looks(void **state)
{
    (void)state;
    write_text(
        "looks.lua",
        "scene { duration = 1 }\n"
        "camera { fit = { { -4, -1 }, { 4, 3 } }, at = 0.6, trail = 0.2 }\n"
        "body { type = 'static', box { 8, 1 }, at = { 0, -0.5 }, color = '#336699' }\n"
        "local a = body { circle { 0.5 }, at = { -2, 2 }, label = 'one', color = 3 }\n"
        "local b = body { name = 'b', box { 1, 1 }, at = { 2, 2 } }\n"
        "local c = body { name = 'c', box { 1, 1 }, at = { 0, 2 }, hidden = true }\n"
        "revolute { a = b, b = c, at = { 1, 2 }, hidden = true }\n"
        "at(0.3, function() a:set_label('two') a:set_color('#aa0000') score('hits', 3) end)\n"
        "at(0.5, function() body { circle { 0.2 }, at = { 0, 1 }, color = 5 } text('late') end)\n"
        "at(0.7, function() text('') end)\n");
    expect_code("\"$P\" run looks.lua --record looks.rec -o /dev/null", 0);
    expect_code("for at in 0 0.25 0.4 0.6 0.9; do "
                "\"$P\" render looks.lua --size 320x200 --at $at -o s.png && "
                "\"$P\" replay looks.rec --size 320x200 --seek $at --render r$at.png && "
                "cmp s.png r$at.png || exit; done",
                0);
    expect_code("cmp r0.25.png r0.4.png", 1);
    // The scene's own moment, and a film that goes through all of it.
    expect_code("\"$P\" replay looks.rec --size 320x200 --render r.png && cmp r0.6.png r.png", 0);
    expect_code("\"$P\" replay looks.rec --size 64x64 --fps 9 --render r.gif && "
                "\"$P\" render looks.lua --size 64x64 --fps 9 -o s.gif && cmp s.gif r.gif",
                0);
    // Beyond the end of a recording that is shorter than the scene.
    expect_code("\"$P\" run looks.lua --time 0.2 --record short.rec -o /dev/null && "
                "\"$P\" replay short.rec --size 64x64 --render r.png && "
                "\"$P\" render looks.lua --size 64x64 --at 0.2 -o s.png && cmp s.png r.png",
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
        expect_usage_error(line, replay_cases[i].message);
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
    expect_code("\"$P\" diff --from 40 p.rec o.rec", 6);
    assert_string_equal(out, "differ already behind step 40, 0.625 s\n"
                             "first: body 'ball': x 0.375 | 0.5\n");
    expect_error("\"$P\" diff p.rec d.rec", 1,
                 "plumb: diff: 'p.rec' was recorded in float precision, 'd.rec' in double; nothing "
                 "in them is the same\n");
    expect_error("\"$P\" diff f.rec d.rec", 1,
                 "plumb: diff: 'f.rec' was recorded in far precision, 'd.rec' in double; nothing "
                 "in them is the same\n");
    expect_error("\"$P\" diff p.rec", 2,
                 "plumb: diff: an operand is missing; usage: plumb diff RECORDING ");
    expect_error("\"$P\" diff", 2, "plumb: diff: RECORDING RECORDING is missing; ");
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
    expect_error("\"$P\" run p.rec", 3,
                 "p.rec: is a recording, not a scene; 'plumb replay' plays it\n");
    expect_error("head -c 600 p.rec >c.rec; \"$P\" replay c.rec", 1,
                 "plumb: 'c.rec' is truncated before its first step\n");
    expect_error("{ head -c 3000 p.rec; printf x; tail -c +3002 p.rec; } >x.rec; "
                 "\"$P\" replay x.rec",
                 1, "plumb: 'x.rec' is damaged\n");
    expect_error("head -c -100 p.rec >c.rec; \"$P\" replay c.rec --info", 0,
                 "plumb: 'c.rec' breaks off after step 62: whatever wrote it did not end it\n");
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

// What broke is gone, and was a joint all the same; times are those that the run printed.
static void a_replay_speaks_as_the_run_did(void **state)
{
    (void)state;
    write_text("break.lua",
               "scene { duration = 1, dt = 1/60 }\nbody { name = 'hook', type = 'static', circle { "
               "0.1 } }\n"
               "body { name = 'load', circle { 1 }, at = {0, -3}, density = 100 }\n"
               "distance { 'hook', 'load', name = 'cord' }\n"
               "at(0.5, function() find_joint('cord'):destroy() find('hook'):destroy() end)\n");
    expect_code("\"$P\" run break.lua --record break.rec >a && \"$P\" replay break.rec --list", 0);
    assert_non_null(strstr(out, "joint 'cord': destroyed"));
    assert_non_null(strstr(out, "body 'hook': destroyed"));
    assert_null(strstr(out, "body 'cord'"));
    expect_code("cut -d, -f1 a | sort -u >t1; \"$P\" replay break.rec | cut -d, -f1 | sort -u >t2; "
                "cmp t1 t2",
                0);
    expect_code(
        "\"$P\" run break.lua --dt 1/7 --time 3 --record b.rec | cut -d, -f1 | sort -u >t1; "
        "\"$P\" replay b.rec | cut -d, -f1 | sort -u >t2; cmp t1 t2",
        0);
    expect_usage_error("\"$P\" replay break.rec --step 1.5", "1.5 is not a whole number");
    expect_usage_error("\"$P\" diff break.rec break.rec --from 0.5", "0.5 is not a whole number");
}

// A body that fell off the level is not looked for: the picture is the one that there is when it cannot be seen.
static void who_fell_off_is_let_go(void **state)
{
    (void)state;
    static const char level[] = "scene { title = 'level', duration = 6 }\n"
                                "body { type = 'static', box { 12, 0.5 }, at = {0, -0.25} }\n"
                                "for i = 1, 4 do body { box { 0.8, 0.8 }, at = {i - 4, 0.4} } end\n"
                                "body { name = 'ball', circle { 0.5 }, at = {4.5, 0.5}, velocity = "
                                "{3, 0}, label = 'b', hidden = %s }\n";
    char text[1024];
    snprintf(text, sizeof text, level, "false");
    write_text("seen.lua", text);
    snprintf(text, sizeof text, level, "true");
    write_text("unseen.lua", text);
    expect_code("\"$P\" render seen.lua --at 6 -o seen.png && \"$P\" render unseen.lua --at 6 -o "
                "unseen.png && "
                "cmp seen.png unseen.png",
                0);
    expect_code("\"$P\" run seen.lua -o /dev/null --record seen.rec && "
                "\"$P\" replay seen.rec --render again.png && cmp seen.png again.png",
                0);
    // While it is there it is seen, and where all leave they are followed.
    expect_code("\"$P\" render seen.lua --at 0 -o seen.png && \"$P\" render unseen.lua --at 0 -o "
                "unseen.png && "
                "! cmp -s seen.png unseen.png",
                0);
    write_text("flown.lua", "body { circle { 1 }, velocity = {30, 40}, label = 'up' }\n"
                            "body { type = 'static', box { 9, 1 }, at = {0, -2} }\n");
    write_text("gone.lua",
               "body { circle { 1 }, velocity = {30, 40}, label = 'up', hidden = true }\n"
               "body { type = 'static', box { 9, 1 }, at = {0, -2} }\n");
    expect_code("\"$P\" render flown.lua --at 3 --overlay none -o a.png && "
                "\"$P\" render gone.lua --at 3 --overlay none -o b.png && ! cmp -s a.png b.png",
                0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(render_draws),
        cmocka_unit_test(a_scene_knows_its_moment),
        cmocka_unit_test(a_recording_is_replayed),
        cmocka_unit_test(a_replay_goes_anywhere),
        cmocka_unit_test(a_recording_is_drawn),
        cmocka_unit_test(a_recording_keeps_its_looks),
        cmocka_unit_test(drawing_a_recording_tells_the_remedy),
        cmocka_unit_test(differences_are_found),
        cmocka_unit_test(bad_recordings_are_refused),
        cmocka_unit_test(a_replay_speaks_as_the_run_did),
        cmocka_unit_test(who_fell_off_is_let_go),
    };
    return cmocka_run_group_tests(tests, set_up, clean_up);
}
