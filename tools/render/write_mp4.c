// write_mp4.c - MP4 (H.264) through the program ffmpeg, found on PATH.
//
// Pictures go to ffmpeg's standard input as raw RGB; no shell is involved. Its messages go to a
// temporary file, whose last line is shown when it fails. SIGPIPE is blocked while writing, so
// that an ffmpeg that dies is an error and not the end of this program.
// Cost: the encoder runs beside the caller.
#define _POSIX_C_SOURCE 200809L // getpid, posix_spawnp, sigtimedwait

#include "write_internal.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

typedef struct mp4_state {
    pid_t child;
    int pipe;       // writing end; -1 = closed
    FILE *messages; // what ffmpeg says
    uint8_t *rgb;   // one picture
    char temporary[PLR_PATH_MAX];
} mp4_state;

// ---- the child

static render_result spawn(mp4_state *state, const render_writer *writer, const int ends[2],
                           render_error *error)
{
    char size[32], rate[32], output[PLR_PATH_MAX + 8];
    snprintf(size, sizeof size, "%dx%d", writer->width, writer->height);
    snprintf(rate, sizeof rate, "%.6f", writer->fps);
    snprintf(output, sizeof output, "file:%s", state->temporary); // so a name cannot be an option
    // H.264 with 4:2:0 colour needs even sizes: a last odd row or column is repeated. Without the
    // matrix given, players would guess it from the size and shift the colours.
    char *const arguments[] = { "ffmpeg",
                                "-hide_banner",
                                "-nostdin",
                                "-loglevel",
                                "error",
                                "-y",
                                "-f",
                                "rawvideo",
                                "-pixel_format",
                                "rgb24",
                                "-video_size",
                                size,
                                "-framerate",
                                rate,
                                "-i",
                                "pipe:0",
                                "-an",
                                "-vf",
                                "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,"
                                "scale=out_color_matrix=bt709:out_range=tv",
                                "-c:v",
                                "libx264",
                                "-preset",
                                "medium",
                                "-crf",
                                "18",
                                "-pix_fmt",
                                "yuv420p",
                                "-colorspace",
                                "bt709",
                                "-color_primaries",
                                "bt709",
                                "-color_trc",
                                "bt709",
                                "-color_range",
                                "tv",
                                "-movflags",
                                "+faststart",
                                "-f",
                                "mp4",
                                output,
                                NULL };
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t pipe_signal;
    sigemptyset(&pipe_signal);
    sigaddset(&pipe_signal, SIGPIPE);
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(state->messages), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(state->messages), STDERR_FILENO);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setsigdefault(&attributes, &pipe_signal);
    const int code =
        posix_spawnp(&state->child, "ffmpeg", &actions, &attributes, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (code == ENOENT) {
        return plr_fail(error, RENDER_E_FFMPEG,
                        "cannot write '%s': the program ffmpeg is not on PATH; install the package "
                        "ffmpeg, or write .gif or .png",
                        writer->path);
    }
    return code == 0 ? RENDER_OK
                     : plr_fail(error, RENDER_E_FFMPEG, "cannot start ffmpeg: %s", strerror(code));
}

// The last line that ffmpeg wrote.
static void last_message(FILE *messages, char *out, size_t out_size)
{
    char line[256];
    snprintf(out, out_size, "%s", "no message");
    rewind(messages);
    while (fgets(line, (int)sizeof line, messages) != NULL) {
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0] != '\0') {
            snprintf(out, out_size, "%s", line);
        }
    }
}

// Closes the pipe and waits; true if ffmpeg ended well.
static bool wait_for_child(mp4_state *state)
{
    if (state->pipe >= 0) {
        close(state->pipe);
        state->pipe = -1;
    }
    int status = 0;
    pid_t ended;
    do {
        ended = waitpid(state->child, &status, 0);
    } while (ended < 0 && errno == EINTR);
    const bool well = ended == state->child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    state->child = 0;
    return well;
}

static render_result child_failed(const render_writer *writer, render_error *error)
{
    mp4_state *state = writer->state;
    char message[256];
    last_message(state->messages, message, sizeof message);
    return plr_fail(error, RENDER_E_FFMPEG, "ffmpeg could not write '%.200s': %.200s", writer->path,
                    message);
}

// ---- the writer

static void mp4_abandon(render_writer *writer)
{
    mp4_state *state = writer->state;
    if (state->child > 0) {
        kill(state->child, SIGTERM); // our own child, by its number
        wait_for_child(state);
    }
    if (state->pipe >= 0) {
        close(state->pipe);
    }
    if (state->temporary[0] != '\0') {
        remove(state->temporary);
    }
    if (state->messages != NULL) {
        fclose(state->messages);
    }
    free(state->rgb);
    free(state);
    writer->state = NULL;
}

static bool make_pipe(int ends[2])
{
    if (pipe(ends) != 0) {
        return false;
    }
    // Other children of this program must not keep the pipe open.
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    return true;
}

static render_result mp4_open(render_writer *writer, render_error *error)
{
    mp4_state *state = calloc(1, sizeof *state);
    if (state == NULL) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory");
    }
    writer->state = state;
    state->pipe = -1;
    int ends[2];
    render_result result = RENDER_OK;
    state->rgb = malloc((size_t)writer->width * (size_t)writer->height * 3);
    state->messages = tmpfile();
    if (state->rgb == NULL) {
        result = plr_fail(error, RENDER_E_MEMORY, "out of memory");
    } else if (state->messages == NULL || !make_pipe(ends)) {
        result = plr_fail(error, RENDER_E_IO, "cannot prepare for ffmpeg: %s", strerror(errno));
    } else {
        fcntl(fileno(state->messages), F_SETFD, FD_CLOEXEC);
        state->pipe = ends[1];
        render_temporary_name(writer->path, state->temporary, sizeof state->temporary);
        result = spawn(state, writer, ends, error);
        close(ends[0]);
    }
    if (result != RENDER_OK) {
        mp4_abandon(writer);
    }
    return result;
}

// Writes everything; false when ffmpeg has closed its end.
static bool write_all(int pipe, const uint8_t *data, size_t size)
{
    while (size > 0) {
        const ssize_t written = write(pipe, data, size);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            return false;
        }
        data += written;
        size -= (size_t)written;
    }
    return true;
}

// The same with SIGPIPE held back in this thread; one that was raised by us is taken away.
static bool write_quietly(int pipe, const uint8_t *data, size_t size)
{
    sigset_t wanted, before, pending;
    sigemptyset(&wanted);
    sigaddset(&wanted, SIGPIPE);
    sigpending(&pending);
    const bool was_pending = sigismember(&pending, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &wanted, &before);
    const bool done = write_all(pipe, data, size);
    if (!done && !was_pending) {
        const struct timespec no_wait = { 0, 0 };
        while (sigtimedwait(&wanted, NULL, &no_wait) < 0 && errno == EINTR) {
        }
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return done;
}

static render_result mp4_add(render_writer *writer, const uint8_t *pixels, render_error *error)
{
    mp4_state *state = writer->state;
    const size_t count = (size_t)writer->width * (size_t)writer->height;
    for (size_t i = 0; i < count; i++) {
        memcpy(state->rgb + 3 * i, pixels + 4 * i, 3);
    }
    if (write_quietly(state->pipe, state->rgb, 3 * count)) {
        return RENDER_OK;
    }
    wait_for_child(state); // all of its messages are there then
    return child_failed(writer, error);
}

static render_result mp4_finish(render_writer *writer, render_error *error)
{
    mp4_state *state = writer->state;
    render_result result = RENDER_OK;
    if (!wait_for_child(state)) {
        result = child_failed(writer, error);
    } else if (rename(state->temporary, writer->path) != 0) {
        result =
            plr_fail(error, RENDER_E_IO, "cannot write '%s': %s", writer->path, strerror(errno));
    } else {
        state->temporary[0] = '\0'; // nothing left to remove
    }
    mp4_abandon(writer);
    return result;
}

const plr_writer_kind plr_writer_mp4 = {
    .open = mp4_open, .add = mp4_add, .finish = mp4_finish, .abandon = mp4_abandon
};
