// recording.h - a recording in memory.
#ifndef RECORDING_H
#define RECORDING_H

#include "plumb/plumb.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

typedef struct recording {
    char *bytes;
    size_t size, room;
} recording;

static inline bool to_recording(void *context, const void *bytes, size_t size)
{
    recording *r = context;
    if (r->size + size > r->room) {
        r->room = 2 * (r->size + size);
        r->bytes = realloc(r->bytes, r->room);
        assert_non_null(r->bytes);
    }
    memcpy(r->bytes + r->size, bytes, size);
    r->size += size;
    return true;
}

static inline void recording_free(recording *r)
{
    free(r->bytes);
    *r = (recording){ 0 };
}

#endif
