// test_render.c - the off-screen renderer: pixels of simple frames, camera, memory trouble, and
// every writer read back. Needs the font package and giflib, libpng; ffmpeg only where present.
#define _POSIX_C_SOURCE 200809L // mkdtemp, setenv

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gif_lib.h>
#include <png.h>

#include "../../tools/render/write.h"

static const render_rgba red = { 0xe0, 0x00, 0x00, 0xff };
static const render_rgba white = { 0xff, 0xff, 0xff, 0xff };

// Read by LeakSanitizer where it is linked in: Mesa keeps a few hundred bytes for every context.
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libOSMesa.so\n";
}

// ---- helpers

// Shapes only, flat, on white.
static render_options flat(void)
{
    return (render_options){ .show = RENDER_SHOW_NOTHING, .outline_px = -1.0, .background = white };
}

static render_frame *new_frame(void)
{
    render_frame *frame = render_frame_create(NULL);
    assert_non_null(frame);
    return frame;
}

static render_target *new_target(int width, int height)
{
    render_target *target = NULL;
    render_error error;
    if (render_target_create(&target, width, height, NULL, &error) != RENDER_OK) {
        fail_msg("%s", error.text);
    }
    return target;
}

static void draw(render_target *target, const render_frame *frame, render_camera camera,
                 render_options options)
{
    render_error error;
    if (render_target_draw(target, frame, &camera, &options, &error) != RENDER_OK) {
        fail_msg("%s", error.text);
    }
    assert_string_equal(error.text, "");
}

static const uint8_t *pixel(const render_target *target, int x, int y)
{
    return render_target_pixels(target) +
           4 * ((size_t)y * (size_t)render_target_width(target) + (size_t)x);
}

static void assert_color(const render_target *target, int x, int y, render_rgba color)
{
    const uint8_t *p = pixel(target, x, y);
    if (p[0] != color.r || p[1] != color.g || p[2] != color.b || p[3] != 0xff) {
        fail_msg("pixel %d, %d is %d %d %d %d, not %d %d %d", x, y, p[0], p[1], p[2], p[3], color.r,
                 color.g, color.b);
    }
}

// Covered pixels of a red picture on white, by the green channel, in the given rows.
static double coverage(const render_target *target, int from_row, int to_row)
{
    double sum = 0.0;
    for (int y = from_row; y < to_row; y++) {
        for (int x = 0; x < render_target_width(target); x++) {
            sum += (255.0 - pixel(target, x, y)[1]) / 255.0;
        }
    }
    return sum;
}

static void begin_red(render_frame *frame)
{
    assert_int_equal(render_body_begin(frame, &(render_style){ .color = red }), RENDER_OK);
}

static void add_disc(render_frame *frame, double x, double y, double radius)
{
    begin_red(frame);
    assert_int_equal(render_add_circle(frame, x, y, radius, 0.0), RENDER_OK);
    assert_int_equal(render_body_end(frame), RENDER_OK);
}

// ---- pixels

// A disc across the upper right corner of the period is seen at all four; one in the middle once.
static void test_period_is_drawn_at_both_sides(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(400, 300);
    const render_camera camera = { .view_height = 3.0 }; // 100 px a unit: 4 x 3 units in view
    const double pi = 3.14159265358979323846, whole = pi * 0.3 * 0.3 * 1e4;
    assert_int_equal(render_frame_set_period(frame, 4.0, 3.0), RENDER_OK);
    add_disc(frame, 1.9, 1.4, 0.3);
    add_disc(frame, 0.0, 0.0, 0.3);
    draw(target, frame, camera, flat());
    assert_true(fabs(coverage(target, 0, 300) - 2.0 * whole) < 0.02 * whole);
    assert_color(target, 390, 10, red);
    assert_color(target, 3, 10, red);
    assert_color(target, 390, 297, red);
    assert_color(target, 3, 297, red);
    // Along x alone nothing comes in at the bottom.
    assert_int_equal(render_frame_set_period(frame, 4.0, 0.0), RENDER_OK);
    draw(target, frame, camera, flat());
    assert_color(target, 3, 10, red);
    assert_color(target, 390, 297, white);
    // Seen from elsewhere, it is the same world.
    assert_int_equal(render_frame_set_period(frame, 4.0, 3.0), RENDER_OK);
    const render_camera aside = { .center = { 9.9, -4.6 }, .view_height = 3.0 };
    draw(target, frame, aside, flat());
    assert_true(fabs(coverage(target, 0, 300) - 2.0 * whole) < 0.02 * whole);
    assert_color(target, 200, 150, red);
    // With the grid on, what lies outside the period is faded.
    const render_camera wide = { .view_height = 6.0 }; // 50 px a unit
    render_options options = flat();
    options.show = RENDER_SHOW_GRID;
    draw(target, frame, wide, options);
    assert_color(target, 200, 150, red);
    assert_true(pixel(target, 200, 10)[1] > 128); // the disc in the middle, one period up
    assert_true(pixel(target, 200, 10)[1] < 255);
    render_frame_clear(frame);
    assert_int_equal(render_frame_set_period(frame, -1.0, 0.0), RENDER_E_ARGUMENT);
    render_frame_clear(frame);
    assert_int_equal(render_frame_set_period(frame, (double)INFINITY, 0.0), RENDER_E_NOT_FINITE);
    render_target_destroy(target);
    render_frame_destroy(frame);
}

static void test_areas(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(400, 300);
    const render_camera camera = { .view_height = 3.0 }; // 100 px a unit
    const double pi = 3.14159265358979323846;
    const double radii[] = { 0.05, 0.31, 1.2 };
    for (size_t i = 0; i < 3; i++) {
        render_frame_clear(frame);
        add_disc(frame, 0.013, -0.027, radii[i]);
        draw(target, frame, camera, flat());
        const double expected = pi * radii[i] * radii[i] * 1e4;
        assert_true(fabs(coverage(target, 0, 300) - expected) < 0.01 * expected);
    }
    render_frame_clear(frame);
    begin_red(frame);
    render_add_capsule(frame, -0.5, -0.2, 0.6, 0.3, 0.25);
    render_body_end(frame);
    draw(target, frame, camera, flat());
    double expected = (pi * 0.25 * 0.25 + 0.5 * hypot(1.1, 0.5)) * 1e4;
    assert_true(fabs(coverage(target, 0, 300) - expected) < 0.01 * expected);
    render_frame_clear(frame);
    begin_red(frame);
    render_add_box(frame, 0.1, 0.1, 0.7, 0.4, 0.5, 0.1);
    render_body_end(frame);
    draw(target, frame, camera, flat());
    expected = (1.4 * 0.8 + 2.0 * 0.1 * (1.4 + 0.8) + pi * 0.01) * 1e4;
    assert_true(fabs(coverage(target, 0, 300) - expected) < 0.01 * expected);
    render_target_destroy(target);
    render_frame_destroy(frame);
}

static void test_polygon_orientation_does_not_matter(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(100, 100);
    const render_vec one[3] = { { -1.0, -1.0 }, { 1.0, -1.0 }, { 0.0, 1.0 } };
    const render_vec other[3] = { { 0.0, 1.0 }, { 1.0, -1.0 }, { -1.0, -1.0 } };
    double areas[2];
    for (int i = 0; i < 2; i++) {
        render_frame_clear(frame);
        begin_red(frame);
        render_add_polygon(frame, i == 0 ? one : other, 3, 0.0);
        render_body_end(frame);
        draw(target, frame, (render_camera){ .view_height = 4.0 }, flat());
        areas[i] = coverage(target, 0, 100);
    }
    assert_true(fabs(areas[0] - 1250.0) < 12.5);
    assert_true(fabs(areas[0] - areas[1]) < 1.0);
    render_target_destroy(target);
    render_frame_destroy(frame);
}

static void test_y_down_flips(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(200, 200);
    add_disc(frame, 0.0, 1.0, 0.4);
    render_camera camera = { .view_height = 4.0 };
    draw(target, frame, camera, flat());
    assert_color(target, 100, 50, red); // top row first: y upwards puts it into the upper half
    assert_true(coverage(target, 100, 200) < 1e-9);
    camera.y_down = true;
    draw(target, frame, camera, flat());
    assert_color(target, 100, 150, red);
    assert_true(coverage(target, 0, 100) < 1e-9);
    render_target_destroy(target);
    render_frame_destroy(frame);
}

static void test_seams_of_one_body_are_not_outlined(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(200, 200);
    render_options options = flat();
    options.outline_px = 3.0;
    options.ui_scale = 1.0;
    for (int separate = 0; separate < 2; separate++) {
        render_frame_clear(frame);
        begin_red(frame);
        render_add_box(frame, -0.5, 0.0, 0.5, 0.8, 0.0, 0.0);
        if (separate == 1) {
            render_body_end(frame);
            begin_red(frame);
        }
        // Two boxes face one long edge, so that the seam has a corner in its middle.
        render_add_box(frame, 0.5, 0.4, 0.5, 0.4, 0.0, 0.0);
        render_add_box(frame, 0.5, -0.4, 0.5, 0.4, 0.0, 0.0);
        render_body_end(frame);
        draw(target, frame, (render_camera){ .view_height = 4.0 }, options);
        int outlined = 0;
        for (int x = 90; x < 110; x++) {
            outlined += pixel(target, x, 80)[0] != red.r ? 1 : 0;
        }
        assert_true(separate == 1 ? outlined >= 4 : outlined == 0);
        for (int y = 90; y < 110; y++) {
            assert_color(target, 125, y, red); // between the two boxes
        }
        assert_int_not_equal(pixel(target, 149, 80)[0], red.r); // the outer edge is outlined
    }
    render_target_destroy(target);
    render_frame_destroy(frame);
}

// The outline of an L goes around its inner corner in full width, whatever its pieces are.
static void test_outline_of_a_concave_body(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(200, 200);
    render_options options = flat();
    options.outline_px = 4.0;
    options.ui_scale = 1.0;
    for (int upright = 0; upright < 2; upright++) {
        render_frame_clear(frame);
        begin_red(frame);
        // The inner corner is the origin, the pixel corner 100, 100.
        render_add_box(frame, upright == 1 ? -0.4 : 0.0, upright == 1 ? 0.0 : -0.4,
                       upright == 1 ? 0.4 : 0.8, upright == 1 ? 0.8 : 0.4, 0.0, 0.0);
        render_add_box(frame, upright == 1 ? 0.4 : -0.4, upright == 1 ? -0.4 : 0.4, 0.4, 0.4, 0.0,
                       0.0);
        render_body_end(frame);
        draw(target, frame, (render_camera){ .view_height = 4.0 }, options);
        for (int k = 1; k < 30; k++) {
            assert_color(target, 102 + k, 97 - k, white);
            assert_int_not_equal(pixel(target, 97, 100 - k)[0], red.r);
            assert_int_not_equal(pixel(target, 100 + k, 102)[0], red.r);
            assert_color(target, 93, 100 - k, red);
            assert_color(target, 100 + k, 106, red);
            assert_color(target, 100 - k / 2, 110, red); // across both possible seams
            assert_color(target, 90, 100 + k / 2, red);
        }
    }
    render_target_destroy(target);
    render_frame_destroy(frame);
}

static void test_huge_ground_stays_exact(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(100, 100);
    // A slope through the origin, 1e9 pixels long: more than float coordinates resolve.
    const double angle = 0.3, c = cos(angle), s = sin(angle), along = 3e6, half = 1e7;
    begin_red(frame);
    render_add_box(frame, along * c + half * s, along * s - half * c, half, half, angle, 0.0);
    render_body_end(frame);
    draw(target, frame, (render_camera){ .view_height = 1.0 }, flat());
    for (int x = 0; x < 100; x += 11) {
        const double surface = 50.0 - (x + 0.5 - 50.0) * tan(angle);
        assert_color(target, x, (int)(surface - 2.0), white);
        assert_color(target, x, (int)(surface + 2.0), red);
        assert_color(target, x, 99, red);
    }
    render_target_destroy(target);
    render_frame_destroy(frame);
}

static size_t changed_pixels(const render_target *target)
{
    size_t count = 0;
    for (int y = 0; y < render_target_height(target); y++) {
        for (int x = 0; x < render_target_width(target); x++) {
            count += memcmp(pixel(target, x, y), &white, 4) != 0 ? 1 : 0;
        }
    }
    return count;
}

static void add_every_overlay(render_frame *frame)
{
    const render_vec path[3] = { { -1.0, -1.0 }, { 0.0, 1.0 }, { 1.0, 0.0 } };
    const render_box box = { { -0.5, -0.5 }, { 0.5, 0.5 } };
    assert_int_equal(render_add_contact(frame, 0.0, 0.0, 0.0, 1.0, 0.01), RENDER_OK);
    assert_int_equal(render_add_impulse(frame, 0.0, 0.0, 1.0, 1.0), RENDER_OK);
    assert_int_equal(render_add_velocity(frame, 0.0, 0.0, -1.0, 1.0), RENDER_OK);
    assert_int_equal(render_add_aabb(frame, box), RENDER_OK);
    assert_int_equal(render_add_cell(frame, box), RENDER_OK);
    assert_int_equal(render_add_trail(frame, path, 3, 2), RENDER_OK);
    assert_int_equal(render_add_surface(frame, path, 3, true, -0.3), RENDER_OK);
    for (int kind = 0; kind < RENDER_JOINT_KINDS; kind++) {
        for (int parts = 0; parts < 2; parts++) {
            const render_joint joint = { .kind = (render_joint_kind)kind,
                                         .b = { 1.0, 1.0 },
                                         .via_a = { 0.0, 1.0 },
                                         .via_b = { 1.0, 2.0 },
                                         .axis = { 0.6, 0.8 },
                                         .has_limit = parts != 0,
                                         .lower = -1.0,
                                         .upper = 0.5,
                                         .drive = parts,
                                         .has_spring = parts != 0,
                                         .slack = 0.5,
                                         .reach = 0.1 * parts };
            assert_int_equal(render_add_joint(frame, &joint), RENDER_OK);
        }
    }
    assert_int_equal(
        render_add_text(frame, 0.0, 0.0, RENDER_ANCHOR_ABOVE, "gr\xc3\xbc\xc3\x9f \xff"),
        RENDER_OK);
    assert_int_equal(render_frame_set_title(frame, "title"), RENDER_OK);
    assert_int_equal(render_frame_set_caption(frame, "caption"), RENDER_OK);
}

static void test_every_overlay_is_switchable(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(320, 240);
    add_every_overlay(frame);
    render_body_begin(frame, &(render_style){ .kind = RENDER_SENSOR, .label = "name" });
    render_add_circle(frame, 100.0, 0.0, 0.1, 0.0); // out of view, its label too
    render_body_end(frame);
    const render_camera camera = { .view_height = 4.0 };
    draw(target, frame, camera, flat());
    assert_int_equal(changed_pixels(target), 0);
    const unsigned alone = RENDER_SHOW_LABELS | RENDER_SHOW_LEGEND | RENDER_SHOW_SPOKES |
                           RENDER_SHOW_NOTHING; // these show nothing of an overlay
    for (unsigned bit = 0; bit < 16; bit++) {
        if ((1u << bit & alone) != 0) {
            continue;
        }
        render_options options = flat();
        options.show = 1u << bit;
        draw(target, frame, camera, options);
        assert_true(changed_pixels(target) > 20);
    }
    // The legend explains only what is on.
    render_options options = flat();
    options.show = RENDER_SHOW_LEGEND;
    draw(target, frame, camera, options);
    assert_int_equal(changed_pixels(target), 0);
    options.show = RENDER_SHOW_CONTACTS;
    draw(target, frame, camera, options);
    const size_t without = changed_pixels(target);
    options.show |= RENDER_SHOW_LEGEND;
    draw(target, frame, camera, options);
    assert_true(changed_pixels(target) > without + 100);
    render_target_destroy(target);
    render_frame_destroy(frame);
}

// Each kind of joint has a sign, and a row of the legend, of its own; signs shrink with their bodies.
static void test_joints_have_signs(void **state)
{
    (void)state;
    render_target *target = new_target(320, 240);
    const render_camera camera = { .view_height = 4.0 };
    size_t signs[RENDER_JOINT_KINDS], rows[RENDER_JOINT_KINDS];
    for (int kind = 0; kind < RENDER_JOINT_KINDS; kind++) {
        render_joint joint = { .kind = (render_joint_kind)kind,
                               .a = { -0.5, 0.0 },
                               .b = { 0.5, 0.1 },
                               .via_a = { -0.5, 1.0 },
                               .via_b = { 0.5, 1.0 },
                               .axis = { 1.0, 0.0 } };
        for (int pass = 0; pass < 3; pass++) {
            render_frame *frame = new_frame();
            render_options options = flat();
            options.show = RENDER_SHOW_JOINTS | (pass == 1 ? RENDER_SHOW_LEGEND : 0);
            joint.reach = pass == 2 ? 0.01 : 0.0;
            assert_int_equal(render_add_joint(frame, &joint), RENDER_OK);
            draw(target, frame, camera, options);
            const size_t pixels = changed_pixels(target);
            if (pass == 0) {
                signs[kind] = pixels;
                assert_true(pixels > 25);
            } else if (pass == 1) {
                rows[kind] = pixels - signs[kind];
                assert_true(rows[kind] > 100); // the letters
            } else {
                assert_true(pixels < signs[kind]);
            }
            render_frame_destroy(frame);
        }
        for (int other = 0; other < kind; other++) {
            assert_true(signs[other] != signs[kind] || rows[other] != rows[kind]);
        }
    }
    render_target_destroy(target);
}

// Chevrons point the way and move on with the surface.
static void test_surfaces_run(void **state)
{
    (void)state;
    render_target *target = new_target(320, 240);
    const render_camera camera = { .view_height = 4.0 }; // 60 px a metre
    const render_vec path[2] = { { -2.0, 0.0 }, { 2.0, 0.0 } };
    static const double travels[] = { 0.1, 0.3, -0.1 };
    uint8_t first[320 * 240 * 4];
    for (int i = 0; i < 3; i++) {
        render_frame *frame = new_frame();
        render_options options = flat();
        options.show = RENDER_SHOW_SURFACES;
        render_add_surface(frame, path, 2, false, travels[i]);
        draw(target, frame, camera, options);
        assert_true(changed_pixels(target) > 100);
        if (i == 0) {
            memcpy(first, render_target_pixels(target), sizeof first);
        }
        const bool same = memcmp(first, render_target_pixels(target), sizeof first) == 0;
        assert_int_equal(same, i == 0);
        render_frame_destroy(frame);
    }
    render_target_destroy(target);
}

// Automatic scale makes a slow body's arrow long, but not the noise of one at rest.
static void test_rest_shows_no_velocity(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(320, 240);
    const render_camera camera = { .view_height = 4.0 };
    render_options options = flat();
    options.show = RENDER_SHOW_VELOCITIES;
    const double speeds[2] = { 1e-4, 0.1 };
    for (int i = 0; i < 2; i++) {
        render_frame_clear(frame);
        assert_int_equal(render_add_velocity(frame, 0.0, 0.0, speeds[i], 0.0), RENDER_OK);
        draw(target, frame, camera, options);
        assert_true(i == 0 ? changed_pixels(target) == 0 : changed_pixels(target) > 20);
    }
    render_target_destroy(target);
    render_frame_destroy(frame);
}

// Adds `rows` x `rows` touching boxes, of which the middle one has a name too long for it.
static void add_block(render_frame *frame, int rows, const char *label)
{
    for (int i = 0; i < rows * rows; i++) {
        const char *own = i == rows * rows / 2 ? label : NULL;
        render_body_begin(frame, &(render_style){ .color = red, .label = own });
        render_add_box(frame, i % rows, i / rows, 0.5, 0.5, 0.0, 0.0);
        render_body_end(frame);
    }
}

static void test_labels_leave_other_bodies_alone(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(320, 240);
    const render_camera camera = { .view_height = 12.0 }; // 20 px a box
    render_options options = flat();
    options.show = RENDER_SHOW_LABELS;
    options.ui_scale = 1.0;
    static uint8_t plain[320 * 240 * 4];
    // Alone a box has its name above it; between others, which are as large as the name, none.
    for (int rows = 1; rows <= 5; rows += 4) {
        render_frame_clear(frame);
        add_block(frame, rows, NULL);
        draw(target, frame, camera, options);
        memcpy(plain, render_target_pixels(target), sizeof plain);
        render_frame_clear(frame);
        add_block(frame, rows, "crate");
        draw(target, frame, camera, options);
        const bool same = memcmp(plain, render_target_pixels(target), sizeof plain) == 0;
        assert_int_equal(same, rows == 5);
    }
    render_target_destroy(target);
    render_frame_destroy(frame);
}

static void test_every_class_and_line_draws(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(160, 120);
    const render_vec chain[5] = {
        { -1.0, 0.0 }, { 0.0, 0.5 }, { 1.0, 0.0 }, { 1.0, 0.0 }, { 0.9, 0.02 }
    };
    for (int kind = 0; kind < RENDER_CLASS_COUNT; kind++) {
        for (unsigned flags = 0; flags < 4; flags++) {
            render_frame_clear(frame);
            render_body_begin(
                frame,
                &(render_style){ .kind = (render_class)kind, .palette = -7 + kind, .label = "n" });
            render_add_polyline(frame, chain, 5, 0.05 * (double)flags, flags);
            render_add_polyline(frame, chain, 2, 0.0, 0);
            render_add_capsule(frame, 0.3, 0.3, 0.3, 0.3, 0.2); // no length: a disc
            render_body_end(frame);
            draw(target, frame, (render_camera){ .view_height = 4.0 }, (render_options){ 0 });
        }
    }
    // Nothing to see, nothing wrong: no area, no length, far away.
    render_frame_clear(frame);
    begin_red(frame);
    render_add_circle(frame, 0.0, 0.0, 0.0, 0.0);
    render_add_box(frame, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    render_add_circle(frame, 1e29, -1e29, 1.0, 0.0);
    const render_vec far[2] = { { -1e29, -1e29 }, { 1e29, -1e29 } };
    render_add_polyline(frame, far, 2, 0.0, RENDER_LINE_TICKS);
    render_body_end(frame);
    draw(target, frame, (render_camera){ .view_height = 4.0 }, flat());
    assert_int_equal(changed_pixels(target), 0);
    render_target_destroy(target);
    render_frame_destroy(frame);
}

// ---- camera

static void test_camera_fit_contains_everything(void **state)
{
    (void)state;
    const int sizes[][2] = { { 960, 540 }, { 100, 700 }, { 33, 31 } };
    const render_box boxes[] = { { { -3.0, 2.0 }, { 9.0, 5.0 } },
                                 { { 100.0, -8.0 }, { 100.5, 800.0 } },
                                 { { -1.0, 1.0 }, { 2.0, 1.0 } } };
    for (int i = 0; i < 3 * 3 * 2; i++) {
        const int w = sizes[i % 3][0], h = sizes[i % 3][1];
        const render_box box = boxes[i / 3 % 3];
        const render_camera camera = render_camera_fit(box, w, h, 0.1, i >= 9);
        const render_vec a = render_camera_to_pixel(&camera, w, h, box.min);
        const render_vec b = render_camera_to_pixel(&camera, w, h, box.max);
        const double tolerance = 1e-9 * w;
        assert_true(fmin(a.x, b.x) >= 0.1 * w - tolerance);
        assert_true(fmax(a.x, b.x) <= 0.9 * w + tolerance);
        assert_true(fmin(a.y, b.y) >= 0.1 * h - tolerance);
        assert_true(fmax(a.y, b.y) <= 0.9 * h + tolerance);
        assert_true(box.min.y == box.max.y || (a.y < b.y) == (i >= 9));
        // It fills the room it has in one direction.
        assert_true(fabs(b.x - a.x) > 0.8 * w - 1e-6 || fabs(b.y - a.y) > 0.8 * h - 1e-6);
        const render_vec back = render_camera_to_world(&camera, w, h, b);
        assert_true(hypot(back.x - box.max.x, back.y - box.max.y) < 1e-9 * 800.0);
    }
    const render_frame *empty = new_frame();
    const render_camera camera = render_camera_fit(render_frame_bounds(empty), 10, 10, 0.1, false);
    assert_true(camera.view_height == 10.0 && camera.center.x == 0.0);
    render_frame_destroy((render_frame *)empty);
}

static void test_bounds(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    add_disc(frame, 1.0, 2.0, 0.5);
    const render_vec trail[2] = { { 0.0, 0.0 }, { 4.0, 1.0 } };
    render_add_trail(frame, trail, 2, 0);
    const render_box box = render_frame_bounds(frame);
    assert_true(box.min.x == 0.0 && box.min.y == 0.0 && box.max.x == 4.0 && box.max.y == 2.5);
    render_frame_destroy(frame);
}

// ---- refusals and memory

static void test_bad_calls_are_refused(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    const render_vec bad[3] = { { 0.0, 0.0 }, { 1.0, NAN }, { 0.0, 1.0 } };
    assert_int_equal(render_add_circle(frame, 0.0, 0.0, 1.0, 0.0), RENDER_E_ARGUMENT); // no body
    assert_int_equal(render_body_end(frame), RENDER_E_ARGUMENT);
    assert_int_equal(render_frame_status(frame), RENDER_E_ARGUMENT);
    render_frame_clear(frame);
    assert_int_equal(render_frame_status(frame), RENDER_OK);
    begin_red(frame);
    assert_int_equal(render_body_begin(frame, NULL), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_circle(frame, INFINITY, 0.0, 1.0, 0.0), RENDER_E_NOT_FINITE);
    assert_int_equal(render_add_circle(frame, 0.0, 0.0, -1.0, 0.0), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_circle(frame, 0.0, 0.0, NAN, 0.0), RENDER_E_NOT_FINITE);
    assert_int_equal(render_add_circle(frame, 0.0, 0.0, 1.0, NAN), RENDER_E_NOT_FINITE);
    assert_int_equal(render_add_polygon(frame, bad, 3, 0.0), RENDER_E_NOT_FINITE);
    assert_int_equal(render_add_polygon(frame, bad, 2, 0.0), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_polygon(frame, bad, RENDER_POLYGON_MAX + 1, 0.0),
                     RENDER_E_ARGUMENT);
    assert_int_equal(render_add_box(frame, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_polyline(frame, bad, 1, 0.0, 0), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_surface(frame, bad, 1, false, 0.0), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_surface(frame, NULL, 2, false, 0.0), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_joint(frame, NULL), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_joint(frame, &(render_joint){ .kind = RENDER_JOINT_KINDS }),
                     RENDER_E_ARGUMENT);
    assert_int_equal(render_add_joint(frame, &(render_joint){ .kind = RENDER_JOINT_SLIDER }),
                     RENDER_E_ARGUMENT);
    assert_int_equal(render_add_joint(frame, &(render_joint){ .value = NAN }), RENDER_E_NOT_FINITE);
    assert_int_equal(render_add_contact(frame, NAN, 0.0, 0.0, 1.0, 0.0), RENDER_E_NOT_FINITE);
    assert_int_equal(render_add_trail(frame, bad, 3, 0), RENDER_E_NOT_FINITE);
    assert_int_equal(render_add_text(frame, 0.0, 0.0, RENDER_ANCHOR_LEFT, NULL), RENDER_E_ARGUMENT);
    render_error error;
    render_target *target = new_target(8, 8);
    render_camera camera = { .view_height = 1.0 };
    assert_int_equal(render_target_draw(target, frame, &camera, NULL, &error), RENDER_E_ARGUMENT);
    render_body_end(frame); // dropped: it has no shape
    assert_int_equal(render_target_draw(target, frame, &camera, NULL, &error), RENDER_OK);
    camera.view_height = 0.0;
    assert_int_equal(render_target_draw(target, frame, &camera, NULL, &error), RENDER_E_ARGUMENT);
    render_target_destroy(target);
    render_frame_destroy(frame);
    assert_int_equal(render_target_create(&target, 0, 5, NULL, &error), RENDER_E_ARGUMENT);
    assert_null(target);
    assert_int_equal(render_target_create(&target, 5, RENDER_SIZE_MAX + 1, NULL, &error),
                     RENDER_E_ARGUMENT);
    const render_target_desc desc = { .font_path = "/nonexistent.ttf" };
    assert_int_equal(render_target_create(&target, 5, 5, &desc, &error), RENDER_E_FONT);
    assert_non_null(strstr(error.text, "/nonexistent.ttf"));
}

// Fails the call number `countdown` and all after it.
typedef struct poor_memory {
    long countdown;
    long balance;
} poor_memory;

static void *poor_resize(void *user, void *block, size_t old_size, size_t new_size)
{
    poor_memory *memory = user;
    if (new_size == 0) {
        memory->balance -= (long)old_size;
        free(block);
        return NULL;
    }
    if (memory->countdown-- <= 0) {
        return NULL;
    }
    void *grown = realloc(block, new_size);
    assert_non_null(grown);
    memory->balance += (long)new_size - (long)old_size;
    return grown;
}

enum { poor_size = 64, poor_bytes = 4 * poor_size * poor_size };

// Draws a frame with everything in it with memory that ends; true when it lasted, with the
// picture in `pixels`.
static bool draw_poorly(long allocations, uint8_t *pixels)
{
    poor_memory memory = { .countdown = allocations };
    const render_allocator allocator = { .resize = poor_resize, .user = &memory };
    const render_target_desc desc = { .allocator = allocator };
    bool done = false;
    render_target *target = NULL;
    render_error error;
    render_frame *frame = render_frame_create(&allocator);
    if (frame != NULL) {
        for (int i = 0; i < 200; i++) {
            render_body_begin(frame, &(render_style){ .label = "some name" });
            render_add_box(frame, i, 0.0, 0.5, 0.5, 0.0, 0.0);
            render_add_box(frame, i, 1.0, 0.5, 0.5, 0.0, 0.0);
            render_body_end(frame);
            render_add_impulse(frame, i, 0.0, 1.0, 1.0);
            render_add_joint(frame, &(render_joint){ .b = { i, 1.0 } });
        }
        const render_camera camera =
            render_camera_fit(render_frame_bounds(frame), poor_size, poor_size, 0.1, false);
        if (render_target_create(&target, poor_size, poor_size, &desc, &error) == RENDER_OK) {
            const render_result result = render_target_draw(target, frame, &camera, NULL, &error);
            done = result == RENDER_OK;
            assert_true(done || result == RENDER_E_MEMORY);
            assert_true(done || error.text[0] != '\0');
            memcpy(pixels, render_target_pixels(target), poor_bytes);
        } else {
            assert_null(target);
        }
    }
    render_target_destroy(target);
    render_frame_destroy(frame);
    assert_int_equal(memory.balance, 0);
    return done;
}

static void test_memory_running_out_is_reported(void **state)
{
    (void)state;
    static uint8_t whole[poor_bytes], picture[poor_bytes];
    assert_true(draw_poorly(1000000, whole));
    long allocations = 0;
    while (!draw_poorly(allocations, picture)) {
        allocations++;
        assert_true(allocations < 500);
    }
    assert_memory_equal(whole, picture, poor_bytes); // success means the whole picture
    assert_true(allocations > 15);                   // the hook is in use everywhere
}

// ---- writers

enum { width = 61, height = 47 }; // odd on purpose

// A gradient with a square that moves with `step`.
static void paint(uint8_t *pixels, int step)
{
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            const bool square = x >= 5 + step && x < 15 + step && y >= 10 && y < 20;
            uint8_t *p = pixels + 4 * (y * width + x);
            p[0] = square ? 200 : (uint8_t)(3 * x);
            p[1] = square ? 30 : (uint8_t)(4 * y);
            p[2] = 99;
            p[3] = 0xff;
        }
    }
}

static char folder[64];
static char path_text[512];

static const char *in_folder(const char *name)
{
    snprintf(path_text, sizeof path_text, "%s/%s", folder, name);
    return path_text;
}

static int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/test_render_XXXXXX");
    return mkdtemp(folder) != NULL ? 0 : -1;
}

// Fails unless everything in it has been removed by the tests: no temporary files are left.
static int remove_folder(void **state)
{
    (void)state;
    return rmdir(folder);
}

static bool exists(const char *name)
{
    return access(in_folder(name), F_OK) == 0;
}

static void test_png_reads_back(void **state)
{
    (void)state;
    uint8_t pixels[4 * width * height], back[4 * width * height];
    render_error error;
    paint(pixels, 0);
    assert_int_equal(render_write_png(in_folder("a.png"), pixels, width, height, &error),
                     RENDER_OK);
    png_image image = { .version = PNG_IMAGE_VERSION };
    assert_true(png_image_begin_read_from_file(&image, in_folder("a.png")));
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    image.format = PNG_FORMAT_RGBA;
    assert_true(png_image_finish_read(&image, NULL, back, 0, NULL));
    assert_memory_equal(pixels, back, sizeof pixels);
    assert_int_equal(remove(in_folder("a.png")), 0);
    assert_int_equal(render_write_png("/nonexistent/a.png", pixels, width, height, &error),
                     RENDER_E_IO);
    assert_non_null(strstr(error.text, "/nonexistent/a.png"));
    assert_int_equal(render_write_png(in_folder("a.png"), pixels, 0, height, &error),
                     RENDER_E_ARGUMENT);
}

static void test_sequence_patterns(void **state)
{
    (void)state;
    static const struct {
        const char *pattern;
        unsigned index;
        const char *name;
    } good[] = { { "a%d.png", 7, "a7.png" },           { "a%04d.png", 7, "a0007.png" },
                 { "a%3d.png", 7, "a  7.png" },        { "%%%d%%.png", 12, "%12%.png" },
                 { "%02d", 12345, "12345" },           { "x%04d_%%s.png", 1, "x0001_%s.png" },
                 { "%9d", 4294967295u, "4294967295" }, { "dir/%01d", 3, "dir/3" } };
    static const char *const bad[] = { "a.png", "%s.png", "%n.png",  "%d%d.png", "%d%s", "%",
                                       "a%",    "%5",     "%05",     "%0d",      "%-4d", "%+d",
                                       "%10d",  "%*d",    "%.3d",    "%ld",      "%x",   "%% a.png",
                                       "%d%",   "% d",    "%1$d.png" };
    char out[64];
    render_error error;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        assert_int_equal(
            render_pattern_name(good[i].pattern, good[i].index, out, sizeof out, &error),
            RENDER_OK);
        assert_string_equal(out, good[i].name);
    }
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(render_pattern_name(bad[i], 1, out, sizeof out, &error), RENDER_E_PATTERN);
        assert_non_null(strstr(error.text, bad[i]));
        assert_string_equal(out, "");
    }
    assert_int_equal(render_pattern_name("abc%d", 1, out, 4, &error), RENDER_E_ARGUMENT);
    assert_int_equal(render_pattern_name("abc%d", 1, out, 5, &error), RENDER_OK);
}

static render_writer *open_writer(const char *name, double fps)
{
    render_writer *writer = NULL;
    render_error error;
    if (render_writer_open(&writer, in_folder(name), width, height, fps, &error) != RENDER_OK) {
        fail_msg("%s", error.text);
    }
    return writer;
}

static void test_png_writer(void **state)
{
    (void)state;
    uint8_t pixels[4 * width * height];
    render_error error;
    paint(pixels, 0);
    render_writer *writer = open_writer("s_%03d.png", 30.0);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(render_writer_add(writer, pixels, &error), RENDER_OK);
    }
    assert_int_equal(render_writer_close(writer, &error), RENDER_OK);
    assert_int_equal(remove(in_folder("s_000.png")), 0);
    assert_int_equal(remove(in_folder("s_001.png")), 0);
    assert_int_equal(remove(in_folder("s_002.png")), 0);
    writer = open_writer("one.PNG", 30.0);
    assert_int_equal(render_writer_add(writer, pixels, &error), RENDER_OK);
    assert_int_equal(render_writer_add(writer, pixels, &error), RENDER_E_PATTERN);
    assert_int_equal(render_writer_add(writer, pixels, &error), RENDER_E_IO);
    assert_int_equal(render_writer_close(writer, &error), RENDER_E_IO);
    assert_int_equal(remove(in_folder("one.PNG")), 0);
}

static void test_writers_refuse(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        double fps;
        render_result result;
    } cases[] = { { "a.jpg", 30.0, RENDER_E_FORMAT },         { "", 30.0, RENDER_E_ARGUMENT },
                  { ".gif", 30.0, RENDER_E_FORMAT },          { "a%s.png", 30.0, RENDER_E_PATTERN },
                  { "a%d%d.png", 30.0, RENDER_E_PATTERN },    { "a.gif", 0.0, RENDER_E_ARGUMENT },
                  { "a.gif", NAN, RENDER_E_ARGUMENT },        { "a.gif", 60.0, RENDER_E_ARGUMENT },
                  { "/nonexistent/a.gif", 25.0, RENDER_E_IO } };
    render_error error;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        render_writer *writer = (render_writer *)&error;
        assert_int_equal(
            render_writer_open(&writer, cases[i].path, width, height, cases[i].fps, &error),
            cases[i].result);
        assert_null(writer);
        assert_true(strlen(error.text) > 10);
    }
    render_writer *writer = open_writer("empty.gif", 10.0);
    assert_int_equal(render_writer_close(writer, &error), RENDER_E_ARGUMENT);
    assert_false(exists("empty.gif"));
    render_writer_abort(open_writer("given_up.gif", 10.0));
    assert_false(exists("given_up.gif"));
    render_writer_abort(NULL);
}

// Delay of a picture in 1/100 s.
static int delay_of(GifFileType *gif, int index, int *transparent)
{
    GraphicsControlBlock control;
    assert_int_equal(DGifSavedExtensionToGCB(gif, index, &control), GIF_OK);
    *transparent = control.TransparentColor;
    return control.DelayTime;
}

// Puts a picture of the file over the canvas.
static void compose(const GifFileType *gif, int index, int transparent, uint8_t *canvas)
{
    const SavedImage *image = &gif->SavedImages[index];
    const GifImageDesc *d = &image->ImageDesc;
    for (int y = 0; y < d->Height; y++) {
        for (int x = 0; x < d->Width; x++) {
            const int entry = image->RasterBits[y * d->Width + x];
            if (entry != transparent) {
                const GifColorType *c = &d->ColorMap->Colors[entry];
                uint8_t *p = canvas + 4 * ((d->Top + y) * width + d->Left + x);
                p[0] = c->Red;
                p[1] = c->Green;
                p[2] = c->Blue;
            }
        }
    }
}

static void test_gif_reads_back(void **state)
{
    (void)state;
    enum { pictures = 7 };
    static uint8_t pixels[4 * width * height], canvas[4 * width * height];
    render_error error;
    render_writer *writer = open_writer("a.gif", 30.0);
    for (int i = 0; i < pictures; i++) {
        paint(pixels, i < 5 ? i : 5); // the last two are equal
        assert_int_equal(render_writer_add(writer, pixels, &error), RENDER_OK);
    }
    assert_int_equal(render_writer_close(writer, &error), RENDER_OK);
    struct stat status;
    assert_int_equal(stat(in_folder("a.gif"), &status), 0);
    const mode_t mask = umask(0);
    umask(mask);
    assert_int_equal(status.st_mode & 0777, 0666 & ~mask); // like any other file
    int code = 0;
    GifFileType *gif = DGifOpenFileName(in_folder("a.gif"), &code);
    assert_non_null(gif);
    assert_int_equal(DGifSlurp(gif), GIF_OK);
    assert_int_equal(gif->SWidth, width);
    assert_int_equal(gif->SHeight, height);
    assert_int_equal(gif->ImageCount, pictures);
    static const int delays[pictures] = { 3, 4, 3, 3, 4, 3, 3 }; // 100/30, sum 23 of 23.3
    for (int i = 0; i < pictures; i++) {
        int transparent = -1;
        assert_int_equal(delay_of(gif, i, &transparent), delays[i]);
        compose(gif, i, transparent, canvas);
        paint(pixels, i < 5 ? i : 5);
        double error_sum = 0.0;
        for (size_t k = 0; k < sizeof pixels; k++) {
            error_sum += k % 4 == 3 ? 0 : abs(pixels[k] - canvas[k]);
        }
        assert_true(error_sum / (3.0 * width * height) < 5.0); // 2,867 colours in 255
        const uint8_t *square = canvas + 4 * (15 * width + 12);
        assert_true(square[0] == 200 && square[1] == 30 && square[2] == 99);
    }
    assert_int_equal(gif->SavedImages[pictures - 1].ImageDesc.Width, 1); // nothing changed
    assert_true(gif->SavedImages[1].ImageDesc.Width <= 12);              // only the square
    DGifCloseFile(gif, NULL);
    assert_int_equal(remove(in_folder("a.gif")), 0);
}

static void test_mp4_without_ffmpeg(void **state)
{
    (void)state;
    char before[4096];
    snprintf(before, sizeof before, "%s", getenv("PATH"));
    render_writer *writer = NULL;
    render_error error;
    setenv("PATH", "/nonexistent", 1);
    const render_result result =
        render_writer_open(&writer, in_folder("a.mp4"), width, height, 30.0, &error);
    setenv("PATH", before, 1);
    assert_int_equal(result, RENDER_E_FFMPEG);
    assert_null(writer);
    assert_non_null(strstr(error.text, "ffmpeg is not on PATH"));
}

// An ffmpeg that dies at once: an error with its words, and no SIGPIPE.
static void test_mp4_with_broken_ffmpeg(void **state)
{
    (void)state;
    FILE *script = fopen(in_folder("ffmpeg"), "w");
    assert_non_null(script);
    fputs("#!/bin/sh\necho first line >&2\necho no such codec >&2\nexit 3\n", script);
    fclose(script);
    chmod(in_folder("ffmpeg"), 0755);
    char before[4096];
    snprintf(before, sizeof before, "%s", getenv("PATH"));
    setenv("PATH", folder, 1);
    render_writer *writer = open_writer("a.mp4", 30.0);
    setenv("PATH", before, 1);
    uint8_t pixels[4 * width * height];
    paint(pixels, 0);
    render_error error;
    render_result result = RENDER_OK;
    for (int i = 0; i < 1000 && result == RENDER_OK; i++) { // more than a pipe holds
        result = render_writer_add(writer, pixels, &error);
    }
    assert_int_equal(result, RENDER_E_FFMPEG);
    assert_non_null(strstr(error.text, "no such codec"));
    assert_int_equal(render_writer_close(writer, &error), RENDER_E_IO);
    assert_false(exists("a.mp4"));
    assert_int_equal(remove(in_folder("ffmpeg")), 0);
}

static void test_mp4(void **state)
{
    (void)state;
    if (system("ffmpeg -version >/dev/null 2>&1") != 0) {
        print_message("ffmpeg is absent; its success is not tested\n");
        skip();
    }
    static uint8_t pixels[4 * width * height];
    render_error error;
    render_writer *writer = open_writer("-a:b.mp4", 30.0);
    for (int i = 0; i < 5; i++) {
        paint(pixels, i);
        assert_int_equal(render_writer_add(writer, pixels, &error), RENDER_OK);
    }
    if (render_writer_close(writer, &error) != RENDER_OK) {
        fail_msg("%s", error.text);
    }
    FILE *file = fopen(in_folder("-a:b.mp4"), "rb");
    assert_non_null(file);
    char head[12] = { 0 };
    assert_int_equal(fread(head, 1, 12, file), 12);
    fclose(file);
    assert_memory_equal(head + 4, "ftyp", 4);
    assert_int_equal(remove(in_folder("-a:b.mp4")), 0);
    // Given up: ffmpeg is stopped and its file removed.
    writer = open_writer("b.mp4", 30.0);
    assert_int_equal(render_writer_add(writer, pixels, &error), RENDER_OK);
    render_writer_abort(writer);
    assert_false(exists("b.mp4"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_areas),
        cmocka_unit_test(test_period_is_drawn_at_both_sides),
        cmocka_unit_test(test_polygon_orientation_does_not_matter),
        cmocka_unit_test(test_y_down_flips),
        cmocka_unit_test(test_seams_of_one_body_are_not_outlined),
        cmocka_unit_test(test_outline_of_a_concave_body),
        cmocka_unit_test(test_huge_ground_stays_exact),
        cmocka_unit_test(test_every_overlay_is_switchable),
        cmocka_unit_test(test_joints_have_signs),
        cmocka_unit_test(test_surfaces_run),
        cmocka_unit_test(test_rest_shows_no_velocity),
        cmocka_unit_test(test_labels_leave_other_bodies_alone),
        cmocka_unit_test(test_every_class_and_line_draws),
        cmocka_unit_test(test_camera_fit_contains_everything),
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_bad_calls_are_refused),
        cmocka_unit_test(test_memory_running_out_is_reported),
        cmocka_unit_test(test_png_reads_back),
        cmocka_unit_test(test_sequence_patterns),
        cmocka_unit_test(test_png_writer),
        cmocka_unit_test(test_writers_refuse),
        cmocka_unit_test(test_gif_reads_back),
        cmocka_unit_test(test_mp4_without_ffmpeg),
        cmocka_unit_test(test_mp4_with_broken_ffmpeg),
        cmocka_unit_test(test_mp4),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
