// write.c - opens writers by file name, numbers sequences, names temporary files.
//
// The format's own files (write_png.c, write_gif.c, write_mp4.c) fill a vtable. User strings are
// never used as printf formats: patterns are checked and expanded by hand.
#define _POSIX_C_SOURCE 200809L // getpid, posix_spawnp, sigtimedwait

#include "write_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// ---- patterns

// A pattern taken apart: text before and after the number, and how the number is padded.
typedef struct pattern {
    size_t before; // characters up to the %
    size_t after;  // where the text goes on
    int width;
    bool zeros;
} pattern;

// Reads one % sequence at text[at]; returns the position behind it, 0 if it is not allowed.
static size_t read_conversion(const char *text, size_t at, pattern *parsed, int *conversions)
{
    size_t i = at + 1;
    if (text[i] == '%') {
        return i + 1;
    }
    const bool zeros = text[i] == '0';
    i += zeros ? 1 : 0;
    int width = 0;
    if (text[i] >= '1' && text[i] <= '9') {
        width = text[i] - '0';
        i++;
    } else if (zeros) {
        return 0;
    }
    if (text[i] != 'd') {
        return 0;
    }
    *parsed = (pattern){ .before = at, .after = i + 1, .width = width, .zeros = zeros };
    *conversions += 1;
    return i + 1;
}

static bool parse_pattern(const char *text, pattern *parsed)
{
    int conversions = 0;
    for (size_t i = 0; text[i] != '\0';) {
        if (text[i] != '%') {
            i++;
            continue;
        }
        i = read_conversion(text, i, parsed, &conversions);
        if (i == 0) {
            return false;
        }
    }
    return conversions == 1;
}

bool render_pattern_is(const char *path)
{
    return path != NULL && strchr(path, '%') != NULL;
}

// Appends text[from..to) with %% as %; false when it does not fit.
static bool append(char *out, size_t out_size, size_t *length, const char *text, size_t from,
                   size_t to)
{
    for (size_t i = from; i < to; i++) {
        if (*length + 1 >= out_size) {
            return false;
        }
        out[(*length)++] = text[i];
        i += text[i] == '%' ? 1 : 0;
    }
    return true;
}

render_result render_pattern_name(const char *text, unsigned index, char *out, size_t out_size,
                                  render_error *error)
{
    pattern parsed = { 0 };
    if (text == NULL || out == NULL || out_size == 0) {
        return plr_fail(error, RENDER_E_ARGUMENT, "a sequence needs a pattern and room for names");
    }
    out[0] = '\0';
    if (!parse_pattern(text, &parsed)) {
        return plr_fail(error, RENDER_E_PATTERN,
                        "'%s' is not a sequence pattern: it must hold exactly one %%d or %%0Nd "
                        "(such as frame_%%04d.png), and %%%% for a percent sign",
                        text);
    }
    char number[16];
    snprintf(number, sizeof number, parsed.zeros ? "%0*u" : "%*u", parsed.width, index);
    size_t length = 0;
    const bool fits = append(out, out_size, &length, text, 0, parsed.before) &&
                      append(out, out_size, &length, number, 0, strlen(number)) &&
                      append(out, out_size, &length, text, parsed.after, strlen(text));
    out[fits ? length : 0] = '\0';
    return fits ? RENDER_OK
                : plr_fail(error, RENDER_E_ARGUMENT, "the file name made from '%s' is too long",
                           text);
}

// ---- files

bool render_temporary_name(const char *path, char *out, size_t out_size)
{
    const int length = snprintf(out, out_size, "%s.part%ld", path, (long)getpid());
    return length > 0 && (size_t)length < out_size;
}

// ---- writers

static bool has_extension(const char *path, const char *extension)
{
    const size_t length = strlen(path), tail = strlen(extension);
    if (length <= tail) {
        return false;
    }
    for (size_t i = 0; i < tail; i++) {
        const char c = path[length - tail + i];
        const char lower = c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
        if (lower != extension[i]) {
            return false;
        }
    }
    return true;
}

static render_result check_arguments(const char *path, int width, int height, double fps,
                                     render_error *error)
{
    if (path == NULL || path[0] == '\0' || width < 1 || height < 1 || width > RENDER_SIZE_MAX ||
        height > RENDER_SIZE_MAX) {
        return plr_fail(error, RENDER_E_ARGUMENT,
                        "a writer needs a file name and a picture size within 1..%d",
                        RENDER_SIZE_MAX);
    }
    if (strlen(path) >= PLR_PATH_MAX - 32) {
        return plr_fail(error, RENDER_E_ARGUMENT, "the file name is too long");
    }
    if (!(fps > 0.0) || !(fps <= 1000.0)) {
        return plr_fail(error, RENDER_E_ARGUMENT, "%g frames a second are not within 0..1000", fps);
    }
    return RENDER_OK;
}

static const plr_writer_kind *find_kind(const char *path)
{
    static const struct {
        const char *extension;
        const plr_writer_kind *kind;
    } kinds[] = { { ".png", &plr_writer_png },
                  { ".gif", &plr_writer_gif },
                  { ".mp4", &plr_writer_mp4 } };
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (has_extension(path, kinds[i].extension)) {
            return kinds[i].kind;
        }
    }
    return NULL;
}

render_result render_writer_open(render_writer **out, const char *path, int width, int height,
                                 double fps, render_error *error)
{
    plr_fail(error, RENDER_OK, "%s", "");
    if (out == NULL) {
        return plr_fail(error, RENDER_E_ARGUMENT, "no place for the writer");
    }
    *out = NULL;
    render_result result = check_arguments(path, width, height, fps, error);
    if (result != RENDER_OK) {
        return result;
    }
    const plr_writer_kind *kind = find_kind(path);
    if (kind == NULL) {
        return plr_fail(error, RENDER_E_FORMAT, "'%s' does not end in .png, .gif or .mp4", path);
    }
    render_writer *writer = calloc(1, sizeof *writer);
    if (writer == NULL) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory");
    }
    *writer = (render_writer){ .kind = kind, .width = width, .height = height, .fps = fps };
    snprintf(writer->path, sizeof writer->path, "%s", path);
    result = kind->open(writer, error);
    if (result != RENDER_OK) {
        free(writer);
        return result;
    }
    *out = writer;
    return RENDER_OK;
}

render_result render_writer_add(render_writer *writer, const uint8_t *pixels, render_error *error)
{
    plr_fail(error, RENDER_OK, "%s", "");
    if (writer == NULL || pixels == NULL) {
        return plr_fail(error, RENDER_E_ARGUMENT, "no writer or no picture");
    }
    if (writer->failed) {
        return plr_fail(error, RENDER_E_IO, "'%s' has failed before", writer->path);
    }
    const render_result result = writer->kind->add(writer, pixels, error);
    writer->failed = result != RENDER_OK;
    writer->count += writer->failed ? 0 : 1;
    return result;
}

render_result render_writer_close(render_writer *writer, render_error *error)
{
    plr_fail(error, RENDER_OK, "%s", "");
    if (writer == NULL) {
        return plr_fail(error, RENDER_E_ARGUMENT, "no writer");
    }
    render_result result;
    if (writer->failed || writer->count == 0) {
        result =
            plr_fail(error, writer->failed ? RENDER_E_IO : RENDER_E_ARGUMENT,
                     writer->failed ? "'%s' is incomplete and was removed" : "'%s' got no picture",
                     writer->path);
        writer->kind->abandon(writer);
    } else {
        result = writer->kind->finish(writer, error);
    }
    free(writer);
    return result;
}

void render_writer_abort(render_writer *writer)
{
    if (writer != NULL) {
        writer->kind->abandon(writer);
        free(writer);
    }
}
