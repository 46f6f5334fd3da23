/// recording.c - see recording.h.
#include "recording.h"

#include "scene_args.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char magic[] = "PLUMBREC"; // src/record/format.h
enum { MAGIC_SIZE = (int)sizeof magic - 1, CHUNK = 1 << 20 };

/// Reads a whole file, unless its beginning tells that it is no recording: a device need not end. NULL after a message.
static char *read_file(const char *path, size_t *size)
{
    errno = 0;
    FILE *file = fopen(path, "rb");
    char *bytes = NULL;
    size_t room = 0, got = 1;
    *size = 0;
    while (file != NULL && got > 0) {
        if (*size == room) {
            room = room == 0 ? 1 << 16 : 2 * room;
            char *grown = realloc(bytes, room);
            if (grown == NULL) {
                free(bytes);
                fclose(file);
                cli_message("'%s': out of memory", path);
                return NULL;
            }
            bytes = grown;
        }
        size_t most = *size < MAGIC_SIZE ? MAGIC_SIZE - *size : CHUNK;
        got = fread(bytes + *size, 1, room - *size < most ? room - *size : most, file);
        *size += got;
        if ((*size == MAGIC_SIZE && memcmp(bytes, magic, MAGIC_SIZE) != 0) || cli_interrupted()) {
            break; // what was read is refused like any other
        }
    }
    bool failed = file == NULL || ferror(file) != 0;
    int reason = errno;
    if (file != NULL) {
        fclose(file);
    }
    if (failed) {
        if (!cli_interrupted()) {
            cli_message("cannot read '%s': %s", path, strerror(reason));
        }
        free(bytes);
        return NULL;
    }
    return bytes;
}

/// The precision stands in the header behind magic number and version: src/record/format.h.
static const engine_api *engine_of(const char *bytes, size_t size)
{
    uint32_t precision = 0;
    if (size >= 16) {
        memcpy(&precision, bytes + 12, sizeof precision);
    }
    return precision == 8 ? &engine_double : precision == 12 ? &engine_far : &engine_float;
}

int recording_open(const char *path, int width, bool edits, recording *out)
{
    size_t size;
    engine_error error = { 0 };
    *out = (recording){ .bytes = read_file(path, &size) };
    if (out->bytes == NULL || cli_interrupted()) {
        free(out->bytes);
        *out = (recording){ 0 };
        return CLI_FAILED;
    }
    out->engine = engine_of(out->bytes, size);
    if (out->engine == NULL) {
        cli_message(CLI_LACKS_PRECISION);
        free(out->bytes);
        *out = (recording){ 0 };
        return CLI_FAILED;
    }
    out->replay = out->engine->replay_open(path, out->bytes, size, width, edits, &error);
    if (out->replay == NULL) {
        free(out->bytes);
        *out = (recording){ 0 };
        return scene_report(&error);
    }
    engine_replay_info info = out->engine->replay_info(out->replay);
    if (!info.complete) {
        cli_message("'%s' breaks off after step %llu: whatever wrote it did not end it", path,
                    info.steps);
    }
    return CLI_OK;
}

void recording_close(recording *r)
{
    if (r->engine != NULL) {
        r->engine->replay_close(r->replay);
    }
    free(r->bytes);
    r->bytes = NULL;
}
