// write_png.c - PNG through libpng, one picture or a numbered sequence.
//
// libpng reports errors by longjmp; everything that lives across it sits in one struct. Written
// as 8-bit RGB beside the final name and renamed. Cost: 13 to 25 ms for 960 x 540.
#include "write_internal.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

typedef struct png_job {
    FILE *file;
    png_structp png;
    png_infop info;
    render_error *error;
    const char *path;
} png_job;

// libpng must not return from here.
static void on_error(png_structp png, png_const_charp message)
{
    const png_job *job = png_get_error_ptr(png);
    plr_fail(job->error, RENDER_E_IO, "cannot write '%s': %s", job->path,
             errno != 0 ? strerror(errno)
                        : message); // a full disk says so, libpng only "Write Error"
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message; // the picture is written all the same
}

static bool encode(png_job *job, const uint8_t *pixels, int width, int height)
{
    if (setjmp(png_jmpbuf(job->png)) != 0) {
        return false;
    }
    errno = 0;
    png_init_io(job->png, job->file);
    png_set_IHDR(job->png, job->info, (png_uint_32)width, (png_uint_32)height, 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(job->png, job->info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(job->png, job->info);
    png_set_filler(job->png, 0, PNG_FILLER_AFTER); // drops the alpha bytes
    for (int row = 0; row < height; row++) {
        png_write_row(job->png, pixels + (size_t)row * (size_t)width * 4);
    }
    png_write_end(job->png, job->info);
    return true;
}

static render_result write_file(const char *temporary, const char *path, const uint8_t *pixels,
                                int width, int height, render_error *error)
{
    png_job job = { .error = error, .path = path, .file = fopen(temporary, "wb") };
    if (job.file == NULL) {
        return plr_fail(error, RENDER_E_IO, "cannot write '%s': %s", path, strerror(errno));
    }
    job.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    job.info = job.png != NULL ? png_create_info_struct(job.png) : NULL;
    render_result result = RENDER_OK;
    if (job.info == NULL) {
        result = plr_fail(error, RENDER_E_MEMORY, "out of memory while writing '%s'", path);
    } else if (!encode(&job, pixels, width, height)) {
        result = RENDER_E_IO;
    }
    png_destroy_write_struct(&job.png, &job.info);
    if (fclose(job.file) != 0 && result == RENDER_OK) {
        result = plr_fail(error, RENDER_E_IO, "cannot write '%s': %s", path, strerror(errno));
    }
    return result;
}

render_result render_write_png(const char *path, const uint8_t *pixels, int width, int height,
                               render_error *error)
{
    plr_fail(error, RENDER_OK, "%s", "");
    char temporary[PLR_PATH_MAX];
    if (path == NULL || path[0] == '\0' || pixels == NULL || width < 1 || height < 1 ||
        width > RENDER_SIZE_MAX || height > RENDER_SIZE_MAX ||
        !render_temporary_name(path, temporary, sizeof temporary)) {
        return plr_fail(error, RENDER_E_ARGUMENT,
                        "writing a PNG needs a file name, pixels and a size within 1..%d",
                        RENDER_SIZE_MAX);
    }
    render_result result = write_file(temporary, path, pixels, width, height, error);
    if (result == RENDER_OK && rename(temporary, path) != 0) {
        result = plr_fail(error, RENDER_E_IO, "cannot write '%s': %s", path, strerror(errno));
    }
    if (result != RENDER_OK) {
        remove(temporary);
    }
    return result;
}

// ---- as a writer; needs no state

static render_result png_open(render_writer *writer, render_error *error)
{
    char name[PLR_PATH_MAX];
    return render_pattern_is(writer->path)
               ? render_pattern_name(writer->path, 0, name, sizeof name, error)
               : RENDER_OK;
}

static render_result png_add(render_writer *writer, const uint8_t *pixels, render_error *error)
{
    if (!render_pattern_is(writer->path)) {
        if (writer->count > 0) {
            return plr_fail(error, RENDER_E_PATTERN,
                            "'%s' holds one picture; name a sequence with a pattern such as "
                            "frame_%%04d.png",
                            writer->path);
        }
        return render_write_png(writer->path, pixels, writer->width, writer->height, error);
    }
    char name[PLR_PATH_MAX];
    const render_result result =
        render_pattern_name(writer->path, writer->count, name, sizeof name, error);
    return result == RENDER_OK
               ? render_write_png(name, pixels, writer->width, writer->height, error)
               : result;
}

static render_result png_finish(render_writer *writer, render_error *error)
{
    (void)writer;
    (void)error;
    return RENDER_OK;
}

static void png_abandon(render_writer *writer)
{
    (void)writer; // pictures that are complete stay
}

const plr_writer_kind plr_writer_png = {
    .open = png_open, .add = png_add, .finish = png_finish, .abandon = png_abandon
};
