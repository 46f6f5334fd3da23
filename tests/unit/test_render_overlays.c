// test_render_overlays.c - what is drawn over bodies: contacts, joints, surfaces, labels; classes of bodies.
#define _POSIX_C_SOURCE 200809L // mkdtemp, setenv

#include "render_fixture.h"

#include <sys/resource.h>

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
    assert_int_equal(render_add_field(frame, 0.0, 0.0, 1.0, -0.5, 9.8, 0.7), RENDER_OK);
    assert_int_equal(render_add_aabb(frame, box), RENDER_OK);
    assert_int_equal(render_add_cell(frame, box), RENDER_OK);
    assert_int_equal(render_add_trail(frame, path, 3, render_palette(2)), RENDER_OK);
    assert_int_equal(render_add_flow(frame, path, 3, 2.0, 1.0), RENDER_OK);
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
    for (unsigned bit = 0; bit < 18; bit++) {
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

// An arrow of a field is about its place and as long as told; strong ones are darker; legends tell the strongest.
static void test_field_is_arrows(void **state)
{
    (void)state;
    render_target *target = new_target(320, 240);
    const render_camera camera = { .view_height = 4.0 }; // 60 px a metre
    int dark[2];
    for (int strong = 0; strong < 2; strong++) {
        render_frame *frame = new_frame();
        render_options options = flat();
        options.show = RENDER_SHOW_FIELD;
        assert_int_equal(render_add_field(frame, 0.0, 0.0, 1.0, 0.0, 9.81, strong), RENDER_OK);
        draw(target, frame, camera, options);
        const uint8_t *middle = pixel(target, 150, 120);
        dark[strong] = middle[0] + middle[1] + middle[2];
        assert_memory_equal(pixel(target, 126, 120), &white, 4);
        assert_memory_equal(pixel(target, 194, 120), &white, 4);
        assert_true(memcmp(pixel(target, 134, 120), &white, 4) != 0);
        assert_true(memcmp(pixel(target, 186, 120), &white, 4) != 0);
        assert_memory_equal(pixel(target, 134, 123), &white, 4); // the head is at the other end
        assert_true(memcmp(pixel(target, 185, 121), &white, 4) != 0);
        const size_t alone = changed_pixels(target);
        options.show |= RENDER_SHOW_LEGEND;
        draw(target, frame, camera, options);
        assert_true(changed_pixels(target) > alone + 100);
        assert_int_equal(render_add_field(frame, 0.0, 0.0, 1.0, 0.0, 1.0, 1.5), RENDER_E_ARGUMENT);
        assert_int_equal(render_add_field(frame, 0.0, 0.0, NAN, 0.0, 1.0, 0.5),
                         RENDER_E_NOT_FINITE);
        render_frame_destroy(frame);
    }
    assert_true(dark[1] + 100 < dark[0]);
    render_target_destroy(target);
}

// A needle, red ahead and blue behind, on top of its body.
static void test_dipoles_point(void **state)
{
    (void)state;
    render_target *target = new_target(320, 240);
    const render_camera camera = { .view_height = 4.0 }; // 60 px a metre
    render_frame *frame = new_frame();
    render_options options = flat();
    render_body_begin(frame, &(render_style){ .color = white });
    render_add_box(frame, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0);
    render_body_end(frame);
    assert_int_equal(render_add_dipole(frame, 0.0, 0.0, 0.8, 0.0, 0.2), RENDER_OK);
    options.show = RENDER_SHOW_NOTHING;
    draw(target, frame, camera, options);
    assert_memory_equal(pixel(target, 180, 120), &white, 4);
    options.show = RENDER_SHOW_DIPOLES;
    draw(target, frame, camera, options);
    const uint8_t *ahead = pixel(target, 180, 120), *behind = pixel(target, 140, 120);
    assert_true(ahead[0] > 150 && ahead[2] < 100);
    assert_true(behind[2] > 150 && behind[0] < 100);
    assert_memory_equal(pixel(target, 215, 120), &white, 4); // 48 px, and a rim
    const size_t alone = changed_pixels(target);
    options.show |= RENDER_SHOW_LEGEND;
    draw(target, frame, camera, options);
    assert_true(changed_pixels(target) > alone + 100);
    assert_int_equal(render_add_dipole(frame, 0.0, 0.0, 1.0, 0.0, -1.0), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_dipole(frame, 0.0, NAN, 1.0, 0.0, 1.0), RENDER_E_NOT_FINITE);
    render_frame_destroy(frame);
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

// As far out and as near as a camera goes: what is counted along the view (images, stripes, lines of the grid, dashes)
// has an end. A loop that has none ends by SIGXCPU.
static void test_cameras_far_out(void **state)
{
    (void)state;
    const double far[] = { 0.0, 1.0, -1e9, 1e15, -1e30 };
    const double heights[] = { 1e-30, 1e-3, 4.0, 1e9, 1e30 };
    const double periods[] = { 0.0, 0.1, 4.0, 1e30 };
    struct rlimit most;
    assert_int_equal(getrlimit(RLIMIT_CPU, &most), 0);
    most.rlim_cur = 240; // [s] some 100 times what all of it takes
    assert_int_equal(setrlimit(RLIMIT_CPU, &most), 0);
    render_frame *frame = new_frame();
    render_target *target = new_target(160, 120);
    for (int i = 0; i < 5 * 5 * 4 * 3; i++) {
        const double x = far[i % 5], view = heights[i / 5 % 5], period = periods[i / 25 % 4];
        const double size = i / 100 == 0 ? 1e-3 : i / 100 == 1 ? 1.0 : 1e12;
        render_frame_clear(frame);
        assert_int_equal(render_frame_set_period(frame, period, i % 2 ? period : 0.0), RENDER_OK);
        for (int kind = 0; kind < RENDER_CLASS_COUNT; kind++) {
            render_body_begin(frame, &(render_style){ .kind = (render_class)kind, .label = "n" });
            render_add_box(frame, x, -x, size, size, 0.3, 0.0);
            render_body_end(frame);
        }
        draw(target, frame, (render_camera){ .center = { x, -x }, .view_height = view },
             (render_options){ 0 });
    }
    render_target_destroy(target);
    render_frame_destroy(frame);
}

// A block of particles covers what it fills, in its colour, and nothing besides; from far off and near by, too.
static void test_a_liquid_fills_its_area(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(300, 300);
    render_vec points[400];
    for (int i = 0; i < 400; i++) {
        points[i] = (render_vec){ -0.95 + 0.1 * (i % 20), -0.95 + 0.1 * (i / 20) };
    }
    assert_int_equal(render_add_liquid(frame, points, 400, 0.1, (render_rgba){ 0, 0, 0, 0 }),
                     RENDER_OK);
    draw(target, frame, (render_camera){ .view_height = 3.0 }, flat());
    const double area = (double)changed_pixels(target) / (100.0 * 100.0);
    print_message("2 m x 2 m of liquid are drawn as %.3f m^2\n", area);
    assert_true(area > 4.0 && area < 4.7); // less than a spacing too much on each side
    const uint8_t *water = pixel(target, 150, 150);
    assert_true(water[2] > water[0] + 60);
    assert_memory_equal(pixel(target, 20, 150), &white, 4);
    render_frame_clear(frame);
    assert_int_equal(render_add_liquid(frame, points, 400, 0.1, red), RENDER_OK);
    draw(target, frame, (render_camera){ .view_height = 3.0 }, flat());
    assert_true(pixel(target, 150, 150)[0] > pixel(target, 150, 150)[2] + 60);
    assert_int_equal(render_add_liquid(frame, points, 1, 0.1, red), RENDER_OK);
    assert_int_equal(render_add_liquid(frame, points, 0, 0.1, red), RENDER_OK);
    const double heights[] = { 1e-9, 1e-3, 1e6, 1e12 };
    for (int i = 0; i < 4; i++) {
        draw(target, frame, (render_camera){ .view_height = heights[i] }, flat());
    }
    assert_int_equal(render_add_liquid(frame, points, 2, 0.0, red), RENDER_E_ARGUMENT);
    points[1].x = (double)NAN;
    assert_int_equal(render_add_liquid(frame, points, 2, 0.1, red), RENDER_E_NOT_FINITE);
    render_target_destroy(target);
    render_frame_destroy(frame);
}

// Smoke is thickest in its cells, in its colour; heat glows; nothing is drawn where neither is, or beyond its box.
static void test_smoke_is_a_veil(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(300, 300);
    render_vec cells[64] = { { 0.0, 0.0 } };
    const render_rgba grey = { 0, 0, 0, 0 };
    const render_vec low = { -1.0, -1.0 };
    cells[8 * 3 + 2].x = 3.0; // at (-0.375, -0.125)
    cells[8 * 5 + 6].y = 2.0; // at (0.625, 0.375)
    assert_int_equal(render_add_smoke(frame, low, 0.25, 8, cells, 64, grey), RENDER_OK);
    draw(target, frame, (render_camera){ .view_height = 3.0 }, flat());
    const uint8_t *smoke = pixel(target, 112, 162), *glow = pixel(target, 212, 112);
    assert_true(smoke[0] < 210 && smoke[2] < 215 && smoke[2] >= smoke[0]);
    assert_true(glow[0] > glow[2] + 40);
    assert_memory_equal(pixel(target, 150, 240), &white, 4);
    assert_memory_equal(pixel(target, 40, 150), &white, 4);
    const size_t some = changed_pixels(target);
    assert_in_range(some, 1000, 15000);
    render_frame_clear(frame);
    assert_int_equal(render_add_smoke(frame, low, 0.25, 8, cells, 64, red), RENDER_OK);
    draw(target, frame, (render_camera){ .view_height = 3.0 }, flat());
    assert_true(pixel(target, 112, 162)[0] > pixel(target, 112, 162)[2] + 60);
    const double heights[] = { 1e-9, 1e-3, 1e6, 1e12 };
    for (int i = 0; i < 4; i++) {
        draw(target, frame, (render_camera){ .view_height = heights[i] }, flat());
    }
    assert_int_equal(render_add_smoke(frame, low, 0.0, 8, cells, 64, grey), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_smoke(frame, low, 1.0, 7, cells, 64, grey), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_smoke(frame, low, 1.0, 0, cells, 64, grey), RENDER_E_ARGUMENT);
    cells[3].y = (double)NAN;
    assert_int_equal(render_add_smoke(frame, low, 1.0, 8, cells, 64, grey), RENDER_E_NOT_FINITE);
    assert_int_equal(render_add_flow(frame, cells, 1, 1.0, 0.5), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_flow(frame, cells, 3, 1.0, 1.5), RENDER_E_ARGUMENT);
    render_target_destroy(target);
    render_frame_destroy(frame);
}

// The brighter the wider, of its colour, and along the line alone.
static void test_beams_glow(void **state)
{
    (void)state;
    render_frame *frame = new_frame();
    render_target *target = new_target(300, 300);
    const render_rgba blue = { 20, 40, 220, 255 }, none = { 0, 0, 0, 0 };
    const render_vec a = { -1.2, 0.0 }, b = { 1.2, 0.0 };
    size_t changed[3];
    const double bright[3] = { 1.0, 0.25, 0.01 };
    for (int i = 0; i < 3; i++) {
        render_frame_clear(frame);
        assert_int_equal(render_add_beam(frame, a, b, bright[i], bright[i], blue), RENDER_OK);
        draw(target, frame, (render_camera){ .view_height = 3.0 }, flat());
        changed[i] = changed_pixels(target);
        const uint8_t *middle = pixel(target, 150, 150);
        assert_true(middle[2] > middle[0]);
        assert_memory_equal(pixel(target, 150, 120), &white, 4);
        assert_memory_equal(pixel(target, 10, 150), &white, 4);
    }
    assert_true(changed[0] > changed[1] && changed[1] > changed[2] && changed[2] > 0);
    render_frame_clear(frame);
    assert_int_equal(render_add_beam(frame, a, b, 1.0, 0.0, none), RENDER_OK); // fades
    draw(target, frame, (render_camera){ .view_height = 3.0 }, flat());
    assert_true(pixel(target, 60, 150)[1] + 60 < pixel(target, 240, 150)[1]);
    assert_true(pixel(target, 60, 150)[0] > pixel(target, 60, 150)[2] + 40);
    assert_int_equal(render_add_beam(frame, a, a, 1.0, 1.0, none), RENDER_OK);
    const double heights[] = { 1e-9, 1e-3, 1e6, 1e12 };
    for (int i = 0; i < 4; i++) {
        draw(target, frame, (render_camera){ .view_height = heights[i] }, flat());
    }
    assert_int_equal(render_add_beam(frame, a, b, -0.1, 0.0, none), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_beam(frame, a, b, 0.0, 1.1, none), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_beam(frame, a, b, (double)NAN, 1.0, none), RENDER_E_ARGUMENT);
    assert_int_equal(render_add_beam(frame, (render_vec){ (double)NAN, 0 }, b, 1.0, 1.0, none),
                     RENDER_E_NOT_FINITE);
    render_target_destroy(target);
    render_frame_destroy(frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cameras_far_out),
        cmocka_unit_test(test_every_overlay_is_switchable),
        cmocka_unit_test(test_a_liquid_fills_its_area),
        cmocka_unit_test(test_smoke_is_a_veil),
        cmocka_unit_test(test_beams_glow),
        cmocka_unit_test(test_joints_have_signs),
        cmocka_unit_test(test_field_is_arrows),
        cmocka_unit_test(test_dipoles_point),
        cmocka_unit_test(test_surfaces_run),
        cmocka_unit_test(test_rest_shows_no_velocity),
        cmocka_unit_test(test_labels_leave_other_bodies_alone),
        cmocka_unit_test(test_every_class_and_line_draws),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
