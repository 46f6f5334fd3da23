/// write.h - pictures to files: PNG, PNG sequences, animated GIF, MP4.
///
/// Pixels are RGBA, 8 bits each, top row first; alpha is ignored (pictures are opaque). Files
/// appear under their name only when complete: they are written beside it and then renamed.
#ifndef RENDER_WRITE_H
#define RENDER_WRITE_H

#include "render.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Writes one PNG file. Errors: ARGUMENT, MEMORY, IO.
render_result render_write_png(const char *path, const uint8_t *pixels, int width, int height,
                               render_error *error);

/// True if `path` holds a conversion ("%d", "%4d", "%04d"), valid or not: it names a sequence.
bool render_pattern_is(const char *path);
/// Puts the file name number `index` of a sequence into `out`. The pattern holds exactly one %d,
/// %Nd or %0Nd (N 1..9); %% is a percent sign; nothing else may follow a %.
/// Errors: PATTERN; ARGUMENT if the name does not fit.
render_result render_pattern_name(const char *pattern, unsigned index, char *out, size_t out_size,
                                  render_error *error);

/// The name under which a file is written until it is complete: beside `path`, with the process
/// number, so that two programs do not meet. False when it does not fit.
bool render_temporary_name(const char *path, char *out, size_t out_size);

/// Something that takes one picture after another.
typedef struct render_writer render_writer;

/// Opens a writer by the extension of `path`: .png (with a pattern: a sequence numbered from 0;
/// without: one picture, a second one is refused), .gif (at most 50 frames a second: the format
/// counts in 1/100 s and viewers slow down delays below 2), .mp4 (through ffmpeg on PATH, H.264).
/// `fps` > 0 is used by .gif and .mp4. Errors: ARGUMENT, PATTERN, FORMAT, MEMORY, IO, FFMPEG.
render_result render_writer_open(render_writer **writer, const char *path, int width, int height,
                                 double fps, render_error *error);
/// Adds a picture of the size given at opening. After an error the writer takes no more pictures.
render_result render_writer_add(render_writer *writer, const uint8_t *pixels, render_error *error);
/// Completes the file and frees the writer, also on failure. An animation without a picture, or
/// one whose render_writer_add failed, is an error and leaves no file.
render_result render_writer_close(render_writer *writer, render_error *error);
/// Gives up: frees the writer and removes unfinished files. NULL is allowed.
void render_writer_abort(render_writer *writer);

#ifdef __cplusplus
}
#endif

#endif
