// fill.h - memset that takes nothing of nothing: a buffer without bytes has no address, which memset may not be given.
#ifndef PL_FILL_H
#define PL_FILL_H

#include <stddef.h>
#include <string.h>

static inline void pl_fill(void *to, int byte, size_t bytes)
{
    if (bytes > 0) {
        memset(to, byte, bytes);
    }
}

#endif
