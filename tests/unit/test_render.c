// test_render.c - what is drawn: areas, outlines, cameras, worlds that wrap around; calls that are refused, memory
// that runs out.
#define _POSIX_C_SOURCE 200809L // mkdtemp, setenv

#include "harness/near.h"
#include "render_fixture.h"

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
    assert_near(coverage(target, 0, 300), 2.0 * whole, 0.02 * whole);
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
    assert_near(coverage(target, 0, 300), 2.0 * whole, 0.02 * whole);
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
        assert_near(coverage(target, 0, 300), expected, 0.01 * expected);
    }
    render_frame_clear(frame);
    begin_red(frame);
    render_add_capsule(frame, -0.5, -0.2, 0.6, 0.3, 0.25);
    render_body_end(frame);
    draw(target, frame, camera, flat());
    double expected = (pi * 0.25 * 0.25 + 0.5 * hypot(1.1, 0.5)) * 1e4;
    assert_near(coverage(target, 0, 300), expected, 0.01 * expected);
    render_frame_clear(frame);
    begin_red(frame);
    render_add_box(frame, 0.1, 0.1, 0.7, 0.4, 0.5, 0.1);
    render_body_end(frame);
    draw(target, frame, camera, flat());
    expected = (1.4 * 0.8 + 2.0 * 0.1 * (1.4 + 0.8) + pi * 0.01) * 1e4;
    assert_near(coverage(target, 0, 300), expected, 0.01 * expected);
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
    assert_near(areas[0], 1250, 12.5);
    assert_near(areas[0], areas[1], 1.0);
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
    render_add_trail(frame, trail, 2, render_palette(0));
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
    assert_int_equal(render_add_trail(frame, bad, 3, render_palette(0)), RENDER_E_NOT_FINITE);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_areas),
        cmocka_unit_test(test_polygon_orientation_does_not_matter),
        cmocka_unit_test(test_y_down_flips),
        cmocka_unit_test(test_seams_of_one_body_are_not_outlined),
        cmocka_unit_test(test_outline_of_a_concave_body),
        cmocka_unit_test(test_huge_ground_stays_exact),
        cmocka_unit_test(test_camera_fit_contains_everything),
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_bad_calls_are_refused),
        cmocka_unit_test(test_memory_running_out_is_reported),
        cmocka_unit_test(test_period_is_drawn_at_both_sides),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
