// write_gif.c - animated GIF through giflib.
//
// Each picture stores only the rectangle that changed; inside it, pixels equal to those of the
// picture before are transparent. The changed pixels get a palette of their own (median cut by
// giflib's GifQuantizeBuffer), so parts at rest never flicker and moving parts have 255 colours.
// The quantiser works on 5 bits a channel; replacing each palette entry by the mean of the pixels
// it stands for restores exact flat colours. Cost: about 8 ms for a 960 x 540 scene cut.
#include "write_internal.h"

#include <errno.h>
#include <gif_lib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { palette_size = 256, transparent = 255 };

// Viewers show delays below 2/100 s at about a tenth of the speed.
static const double fps_max = 50.0;

typedef struct gif_state {
    GifFileType *gif;
    FILE *file; // giflib's own files could be read by their owner only
    int reason; // errno of a write that failed
    char temporary[PLR_PATH_MAX];
    uint8_t *previous;    // RGBA of the picture before
    GifByteType *channel; // three planes: changed pixels, red, green, blue
    GifByteType *index;   // their palette entries
    GifByteType *line;    // one line of the output
} gif_state;

typedef struct region {
    int left, top, width, height;
} region;

static render_result gif_error(const render_writer *writer, int code, render_error *error)
{
    const gif_state *state = writer->state;
    const char *reason =
        state != NULL && state->reason != 0 ? strerror(state->reason) : GifErrorString(code);
    return plr_fail(error, RENDER_E_IO, "cannot write '%s': %s", writer->path,
                    reason != NULL ? reason : "giflib gives no reason");
}

static void gif_abandon(render_writer *writer)
{
    gif_state *state = writer->state;
    if (state->gif != NULL) {
        EGifCloseFile(state->gif, NULL);
    }
    if (state->file != NULL) {
        fclose(state->file);
        remove(state->temporary);
    }
    free(state->previous);
    free(state->channel);
    free(state->index);
    free(state->line);
    free(state);
    writer->state = NULL;
}

static int put_bytes(GifFileType *gif, const GifByteType *bytes, int count)
{
    gif_state *state = gif->UserData;
    errno = 0;
    const size_t written = fwrite(bytes, 1, (size_t)count, state->file);
    state->reason = written < (size_t)count ? errno : state->reason;
    return (int)written;
}

// The screen size, and the block by which Netscape made animations repeat for ever.
static bool put_header(GifFileType *gif, int width, int height)
{
    static const char application[] = "NETSCAPE2.0";
    static const GifByteType forever[3] = { 1, 0, 0 };
    EGifSetGifVersion(gif, true);
    return EGifPutScreenDesc(gif, width, height, 8, 0, NULL) == GIF_OK &&
           EGifPutExtensionLeader(gif, APPLICATION_EXT_FUNC_CODE) == GIF_OK &&
           EGifPutExtensionBlock(gif, (int)strlen(application), application) == GIF_OK &&
           EGifPutExtensionBlock(gif, (int)sizeof forever, forever) == GIF_OK &&
           EGifPutExtensionTrailer(gif) == GIF_OK;
}

static render_result gif_open(render_writer *writer, render_error *error)
{
    if (writer->fps > fps_max) {
        return plr_fail(error, RENDER_E_ARGUMENT,
                        "a GIF shows at most %g frames a second, not %g; choose a lower rate or "
                        "write .mp4",
                        fps_max, writer->fps);
    }
    const size_t pixels = (size_t)writer->width * (size_t)writer->height;
    gif_state *state = calloc(1, sizeof *state);
    if (state == NULL) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory");
    }
    writer->state = state;
    state->previous = malloc(pixels * 4);
    state->channel = malloc(pixels * 3);
    state->index = malloc(pixels);
    state->line = malloc((size_t)writer->width);
    if (state->previous == NULL || state->channel == NULL || state->index == NULL ||
        state->line == NULL) {
        gif_abandon(writer);
        return plr_fail(error, RENDER_E_MEMORY, "out of memory");
    }
    render_temporary_name(writer->path, state->temporary, sizeof state->temporary);
    state->file = fopen(state->temporary, "wb");
    if (state->file == NULL) {
        const int reason = errno;
        gif_abandon(writer);
        return plr_fail(error, RENDER_E_IO, "cannot write '%s': %s", writer->path,
                        strerror(reason));
    }
    int code = 0;
    state->gif = EGifOpen(state, put_bytes, &code);
    if (state->gif == NULL) {
        gif_abandon(writer);
        return gif_error(writer, code, error);
    }
    if (!put_header(state->gif, writer->width, writer->height)) {
        const render_result result = gif_error(writer, state->gif->Error, error);
        gif_abandon(writer);
        return result;
    }
    return RENDER_OK;
}

static bool same_color(const uint8_t *a, const uint8_t *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static bool is_changed(const render_writer *writer, const uint8_t *pixels, size_t at)
{
    const gif_state *state = writer->state;
    return writer->count == 0 || !same_color(pixels + 4 * at, state->previous + 4 * at);
}

// The smallest rectangle around what changed; one pixel when nothing did.
static region find_region(const render_writer *writer, const uint8_t *pixels)
{
    int left = writer->width, top = writer->height, right = -1, bottom = -1;
    for (int y = 0; y < writer->height; y++) {
        for (int x = 0; x < writer->width; x++) {
            if (is_changed(writer, pixels, (size_t)y * (size_t)writer->width + (size_t)x)) {
                left = x < left ? x : left;
                right = x > right ? x : right;
                top = y < top ? y : top;
                bottom = y;
            }
        }
    }
    return right < 0 ? (region){ 0, 0, 1, 1 }
                     : (region){ left, top, right - left + 1, bottom - top + 1 };
}

// Replaces each colour by the mean of the pixels that use it.
static void refine(const gif_state *state, size_t count, size_t plane, GifColorType *colors)
{
    unsigned long sum[palette_size][4] = { { 0 } };
    for (size_t i = 0; i < count; i++) {
        unsigned long *entry = sum[state->index[i]];
        for (size_t c = 0; c < 3; c++) {
            entry[c] += state->channel[c * plane + i];
        }
        entry[3]++;
    }
    for (int i = 0; i < palette_size; i++) {
        const unsigned long n = sum[i][3];
        if (n > 0) {
            colors[i] = (GifColorType){ (GifByteType)((sum[i][0] + n / 2) / n),
                                        (GifByteType)((sum[i][1] + n / 2) / n),
                                        (GifByteType)((sum[i][2] + n / 2) / n) };
        }
    }
}

// Gathers the changed pixels of the region and gives them palette entries.
static bool quantise(const render_writer *writer, const uint8_t *pixels, region area,
                     GifColorType *colors)
{
    const gif_state *state = writer->state;
    const size_t plane = (size_t)writer->width * (size_t)writer->height;
    size_t count = 0;
    for (int y = area.top; y < area.top + area.height; y++) {
        for (int x = area.left; x < area.left + area.width; x++) {
            const size_t at = (size_t)y * (size_t)writer->width + (size_t)x;
            if (is_changed(writer, pixels, at)) {
                for (size_t c = 0; c < 3; c++) {
                    state->channel[c * plane + count] = pixels[4 * at + c];
                }
                count++;
            }
        }
    }
    if (count == 0) {
        return true;
    }
    int size = palette_size - 1; // the last entry is the transparent one
    if (GifQuantizeBuffer((unsigned)count, 1, &size, state->channel, state->channel + plane,
                          state->channel + 2 * plane, state->index, colors) != GIF_OK) {
        return false;
    }
    refine(state, count, plane, colors);
    return true;
}

// The delay of this picture in 1/100 s; rounded so that the sum does not drift.
static int delay_of(const render_writer *writer)
{
    return (int)(lround(100.0 * (writer->count + 1.0) / writer->fps) -
                 lround(100.0 * writer->count / writer->fps));
}

static bool put_lines(render_writer *writer, const uint8_t *pixels, region area)
{
    gif_state *state = writer->state;
    size_t next = 0;
    for (int y = area.top; y < area.top + area.height; y++) {
        for (int x = 0; x < area.width; x++) {
            const size_t at = (size_t)y * (size_t)writer->width + (size_t)x + (size_t)area.left;
            state->line[x] = is_changed(writer, pixels, at) ? state->index[next++] : transparent;
        }
        if (EGifPutLine(state->gif, state->line, area.width) != GIF_OK) {
            return false;
        }
    }
    return true;
}

static render_result gif_add(render_writer *writer, const uint8_t *pixels, render_error *error)
{
    gif_state *state = writer->state;
    GifColorType colors[palette_size] = { { 0, 0, 0 } };
    const region area = find_region(writer, pixels);
    if (!quantise(writer, pixels, area, colors)) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory while choosing colours for '%s'",
                        writer->path);
    }
    const GraphicsControlBlock control = { .DisposalMode = DISPOSE_DO_NOT,
                                           .DelayTime = delay_of(writer),
                                           .TransparentColor = transparent };
    GifByteType extension[4];
    EGifGCBToExtension(&control, extension);
    ColorMapObject *map = GifMakeMapObject(palette_size, colors);
    if (map == NULL) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory");
    }
    const bool written = EGifPutExtension(state->gif, GRAPHICS_EXT_FUNC_CODE, (int)sizeof extension,
                                          extension) == GIF_OK &&
                         EGifPutImageDesc(state->gif, area.left, area.top, area.width, area.height,
                                          false, map) == GIF_OK &&
                         put_lines(writer, pixels, area);
    GifFreeMapObject(map);
    if (!written) {
        return gif_error(writer, state->gif->Error, error);
    }
    memcpy(state->previous, pixels, (size_t)writer->width * (size_t)writer->height * 4);
    return RENDER_OK;
}

static render_result gif_finish(render_writer *writer, render_error *error)
{
    gif_state *state = writer->state;
    int code = 0;
    const bool ended = EGifCloseFile(state->gif, &code) == GIF_OK;
    state->gif = NULL;
    const bool closed = fclose(state->file) == 0;
    state->file = NULL;
    render_result result = RENDER_OK;
    if (!ended) {
        result = gif_error(writer, code, error);
    } else if (!closed || rename(state->temporary, writer->path) != 0) {
        result =
            plr_fail(error, RENDER_E_IO, "cannot write '%s': %s", writer->path, strerror(errno));
    }
    if (result != RENDER_OK) {
        remove(state->temporary);
    }
    gif_abandon(writer); // frees the rest
    return result;
}

const plr_writer_kind plr_writer_gif = {
    .open = gif_open, .add = gif_add, .finish = gif_finish, .abandon = gif_abandon
};
