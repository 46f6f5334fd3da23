// memory.c - allocator hooks with accounting, growable buffers. The default hook over-aligns,
// so that every array of the library begins on a cache line.
#include "core/memory.h"

#include <stdlib.h>
#include <string.h>
#if defined(_WIN32)
#include <malloc.h>
#endif

static size_t rounded(size_t size)
{
    return (size + (PL_ALIGN - 1)) & ~(size_t)(PL_ALIGN - 1);
}

// Windows has no aligned_alloc: its free could not tell such a block from others.
static void *aligned_new(size_t size)
{
#if defined(_WIN32)
    return _aligned_malloc(rounded(size), PL_ALIGN);
#else
    return aligned_alloc(PL_ALIGN, rounded(size));
#endif
}

static void aligned_free(void *memory)
{
#if defined(_WIN32)
    _aligned_free(memory);
#else
    free(memory);
#endif
}

static void *libc_resize(void *context, void *memory, size_t old_size, size_t new_size)
{
    (void)context;
    if (new_size == 0) {
        aligned_free(memory);
        return NULL;
    }
    void *fresh = aligned_new(new_size);
    if (fresh != NULL && memory != NULL) {
        memcpy(fresh, memory, old_size < new_size ? old_size : new_size);
        aligned_free(memory);
    }
    return fresh;
}

void pl_memory_init(pl_memory *memory, const plumb_allocator *hooks)
{
    *memory = (pl_memory){ 0 };
    if (hooks != NULL && hooks->resize != NULL) {
        memory->hooks = *hooks;
    } else {
        memory->hooks.resize = libc_resize;
    }
}

void *pl_resize(pl_memory *memory, void *p, size_t old_size, size_t new_size)
{
    if (new_size > SIZE_MAX / 2) {
        return NULL;
    }
    if (p == NULL && new_size == 0) {
        return NULL;
    }
    void *fresh = memory->hooks.resize(memory->hooks.context, p, old_size, new_size);
    if (fresh == NULL && new_size > 0) {
        return NULL;
    }
    memory->bytes += new_size;
    memory->bytes -= old_size;
    if (memory->bytes > memory->peak) {
        memory->peak = memory->bytes;
    }
    return fresh;
}

bool pl_buffer_grow(pl_memory *memory, pl_buffer *buffer, size_t size)
{
    size_t grown = buffer->size + buffer->size / 2;
    size_t target = rounded(grown > size ? grown : size);
    void *data = pl_resize(memory, buffer->data, buffer->size, target);
    if (data == NULL) {
        return false;
    }
    buffer->data = data;
    buffer->size = target;
    return true;
}

void pl_buffer_free(pl_memory *memory, pl_buffer *buffer)
{
    pl_resize(memory, buffer->data, buffer->size, 0);
    *buffer = (pl_buffer){ 0 };
}
