// test_render_files.c - pictures and films as files: PNG, sequences, GIF, MP4, read back.
#define _POSIX_C_SOURCE 200809L // mkdtemp, setenv

#include "render_fixture.h"

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

static char path_text[512];

static const char *in_folder(const char *name)
{
    snprintf(path_text, sizeof path_text, "%s/%s", folder, name);
    return path_text;
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
