/// recording.h - a recording that a command reads.
#ifndef PLUMB_RECORDING_H
#define PLUMB_RECORDING_H

#include "engine.h"

typedef struct recording {
    const engine_api *engine; ///< of its precision
    engine_replay *replay;
    char *bytes;
} recording;

/// Reads `path` and opens it; a message tells of one that breaks off. On failure a message was printed and `out` holds nothing. CLI_OK or CLI_FAILED.
int recording_open(const char *path, int width, bool edits, recording *out);
void recording_close(recording *r);

#endif
