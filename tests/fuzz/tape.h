// tape.h - where a harness records to: memory, refused when it is full.
#ifndef FUZZ_TAPE_H
#define FUZZ_TAPE_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

enum { ROOM = 1 << 18 };

typedef struct tape {
    unsigned char bytes[ROOM];
    size_t size;
} tape;

// A recorder's `write`.
static inline bool to_tape(void *context, const void *bytes, size_t size)
{
    tape *t = context;
    if (size > ROOM - t->size) {
        return false;
    }
    memcpy(t->bytes + t->size, bytes, size);
    t->size += size;
    return true;
}

#endif
