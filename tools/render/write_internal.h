/// write_internal.h - what the writers' files share.
#ifndef RENDER_WRITE_INTERNAL_H
#define RENDER_WRITE_INTERNAL_H

#include "internal.h"
#include "write.h"

#define PLR_PATH_MAX 4096

/// A format. `finish` and `abandon` free what `open` put into writer->state; `open` leaves
/// nothing behind when it fails.
typedef struct plr_writer_kind {
    render_result (*open)(render_writer *writer, render_error *error);
    render_result (*add)(render_writer *writer, const uint8_t *pixels, render_error *error);
    render_result (*finish)(render_writer *writer, render_error *error);
    void (*abandon)(render_writer *writer);
} plr_writer_kind;

struct render_writer {
    const plr_writer_kind *kind;
    void *state;
    int width, height;
    double fps;
    unsigned count; ///< pictures added
    bool failed;
    char path[PLR_PATH_MAX];
};

extern const plr_writer_kind plr_writer_png;
extern const plr_writer_kind plr_writer_gif;
extern const plr_writer_kind plr_writer_mp4;

#endif
