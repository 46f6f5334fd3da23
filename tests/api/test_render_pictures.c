// test_render_pictures.c - what is to be seen in pictures. Where a scene says nothing of a camera: what moves, and large enough, from
// the first picture of a film to the last, and in one picture alone. Which platforms let one through. PLUMB_FLOAT_ONLY: the command line holds all three precisions.
#define _XOPEN_SOURCE 700 // mkdtemp, realpath, popen's relatives

#include "cli_fixture.h"

#include <png.h>

#define GROUND "body { type = 'static', box { 400, 1 }, at = {0, -0.5} }\n"

static const char *const scenes[] = {
    "scene { duration = 2 }\n" GROUND "body { circle { 0.5 }, at = {0, 6} }\n",
    "scene { duration = 2 }\nbody { circle { 0.5 }, at = {0, 6} }\n",
    "scene { duration = 2 }\n" GROUND
    "for i = 1, 3 do body { box { 1, 1 }, at = {0, 9 + i} } end\n",
    "scene { duration = 4, gravity = {0, 0} }\n" GROUND
    "body { box { 2, 1 }, at = {0, 0.6}, velocity = {15, 0} }\n",
    "scene { duration = 3, gravity = {0, 0} }\n"
    "attractor { at = {0, 0}, strength = 250 }\n"
    "body { circle { 0.6 }, at = {8, 0}, velocity = {0, 5.6} }\n"
    "body { circle { 0.4 }, at = {16, 0}, velocity = {0, 2} }\ncamera { trail = 2 }\n",
};

// [-] of a picture that has a colour: bodies have; paper, lines, ground and writing are grey.
static double coloured(const char *name)
{
    char path[sizeof folder + 64];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    png_image image = { .version = PNG_IMAGE_VERSION };
    if (!png_image_begin_read_from_file(&image, path)) {
        fail_msg("%s: %s", name, image.message);
    }
    image.format = PNG_FORMAT_RGB;
    png_byte *pixels = malloc(PNG_IMAGE_SIZE(image));
    assert_non_null(pixels);
    assert_true(png_image_finish_read(&image, NULL, pixels, 0, NULL));
    const size_t count = (size_t)image.width * image.height;
    size_t found = 0;
    for (size_t i = 0; i < count; i++) {
        const png_byte *p = &pixels[3 * i];
        const int most = p[0] > p[1] ? (p[0] > p[2] ? p[0] : p[2]) : (p[1] > p[2] ? p[1] : p[2]);
        const int least = p[0] < p[1] ? (p[0] < p[2] ? p[0] : p[2]) : (p[1] < p[2] ? p[1] : p[2]);
        found += most - least > 40;
    }
    free(pixels);
    return (double)found / (double)count;
}

static void what_moves_is_in_the_picture(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        write_text("moves.lua", scenes[i]);
        for (int still = 0; still <= 4; still++) {
            char line[128];
            snprintf(line, sizeof line,
                     "\"$P\" render moves.lua --size 320x180 --at %g -o still.png", still * 0.5);
            expect_code(line, 0);
            const double share = coloured("still.png");
            if (!(share > 0.001 && share < 0.7)) {
                fail_msg("scene %zu at %g s: %g of the picture are bodies", i, still * 0.5, share);
            }
        }
        expect_code("rm -f f*.png; \"$P\" render moves.lua --size 320x180 --fps 1 -o 'f%d.png'", 0);
        for (int k = 0; k <= 2; k++) {
            char name[16];
            snprintf(name, sizeof name, "f%d.png", k);
            const double share = coloured(name);
            if (!(share > 0.0003 && share < 0.7)) {
                fail_msg("scene %zu, picture %d: %g are bodies", i, k, share);
            }
        }
    }
}

// Arrow heads below it, in its colour.
static void a_one_way_platform_has_a_sign(void **state)
{
    (void)state;
    double share[2];
    for (int i = 0; i < 2; i++) {
        char scene[256];
        snprintf(scene, sizeof scene,
                 "camera { center = {0, 0}, height = 4 }\n"
                 "body { type = 'static', color = '#d03020', box { 4, 0.2 }, at = {0, 1} %s }\n",
                 i == 0 ? "" : ", one_way = {0, 1}");
        write_text("shelf.lua", scene);
        expect_code("\"$P\" render shelf.lua --size 320x180 -o shelf.png", 0);
        share[i] = coloured("shelf.png");
    }
    assert_true(share[1] > 1.02 * share[0] && share[1] < 1.5 * share[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_moves_is_in_the_picture),
        cmocka_unit_test(a_one_way_platform_has_a_sign),
    };
    return cmocka_run_group_tests(tests, set_up, clean_up);
}
