// memory.h - the library's only way to memory: a world's allocator hooks with byte accounting,
// and growable buffers on top.
#ifndef PL_MEMORY_H
#define PL_MEMORY_H

#include "plumb/base.h"

// Formats as C has them: the runtime of Windows knows others, and mingw-w64 brings those of C.
#if defined(__MINGW32__)
#define PL_PRINTF(format_at, first) __attribute__((format(gnu_printf, format_at, first)))
#else
#define PL_PRINTF(format_at, first) __attribute__((format(printf, format_at, first)))
#endif

#define PL_ALIGN 64 // a cache line and the widest vector

typedef struct pl_memory {
    plumb_allocator hooks; // both members resolved: never null
    size_t bytes;          // held now
    size_t peak;           // most ever held
} pl_memory;

// Resolves null hooks to the C library.
void pl_memory_init(pl_memory *memory, const plumb_allocator *hooks);

// (NULL, 0, n) allocates, (p, old, 0) frees. Returns NULL when out of memory; `old` is then intact.
void *pl_resize(pl_memory *memory, void *p, size_t old_size, size_t new_size);

// A growable byte buffer for scratch and lists. {0} is empty.
typedef struct pl_buffer {
    void *data;
    size_t size; // bytes allocated
} pl_buffer;

// Makes room for at least `size` bytes and keeps the content; grows by half again at the least.
bool pl_buffer_grow(pl_memory *memory, pl_buffer *buffer, size_t size);
static inline bool pl_buffer_reserve(pl_memory *memory, pl_buffer *buffer, size_t size)
{
    return size <= buffer->size || pl_buffer_grow(memory, buffer, size);
}
void pl_buffer_free(pl_memory *memory, pl_buffer *buffer);

#endif
