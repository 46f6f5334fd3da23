// render_fixture.h - what the tests of the renderer share: frames, targets, pixels, and a folder for files.
#ifndef RENDER_FIXTURE_H
#define RENDER_FIXTURE_H

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

// ---- helpers

// Shapes only, flat, on white.
static inline render_options flat(void)
{
    return (render_options){ .show = RENDER_SHOW_NOTHING, .outline_px = -1.0, .background = white };
}

static inline render_frame *new_frame(void)
{
    render_frame *frame = render_frame_create(NULL);
    assert_non_null(frame);
    return frame;
}

static inline render_target *new_target(int width, int height)
{
    render_target *target = NULL;
    render_error error;
    if (render_target_create(&target, width, height, NULL, &error) != RENDER_OK) {
        fail_msg("%s", error.text);
    }
    return target;
}

static inline void draw(render_target *target, const render_frame *frame, render_camera camera,
                        render_options options)
{
    render_error error;
    if (render_target_draw(target, frame, &camera, &options, &error) != RENDER_OK) {
        fail_msg("%s", error.text);
    }
    assert_string_equal(error.text, "");
}

static inline const uint8_t *pixel(const render_target *target, int x, int y)
{
    return render_target_pixels(target) +
           4 * ((size_t)y * (size_t)render_target_width(target) + (size_t)x);
}

static inline void begin_red(render_frame *frame)
{
    assert_int_equal(render_body_begin(frame, &(render_style){ .color = red }), RENDER_OK);
}

// ---- writers
enum { width = 61, height = 47 }; // odd on purpose
static char folder[64];

static inline int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/test_render_XXXXXX");
    return mkdtemp(folder) != NULL ? 0 : -1;
}

// Fails unless everything in it has been removed by the tests: no temporary files are left.
static inline int remove_folder(void **state)
{
    (void)state;
    return rmdir(folder);
}

#endif
