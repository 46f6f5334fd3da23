// pool.c - the vertex pool: corners of all pieces in one array, in runs of 4, 8 or 16. A run is
// handed out as a whole and returned to the free list of its class, so that the pool never
// fragments between shapes of a size. The link of a free run lies in the bytes of its first corner.
//
// Reads, writes: the pool. Cost: O(1), growth amortised.
#include "world/rows.h"

#include <string.h>

#define SMALLEST_RUN 4u

uint8_t pl_pool_class(int count)
{
    return count <= 4 ? 0 : count <= 8 ? 1 : 2;
}

uint32_t pl_pool_run(uint8_t vertex_class)
{
    return SMALLEST_RUN << vertex_class;
}

void pl_pool_init(pl_vertex_pool *pool)
{
    *pool = (pl_vertex_pool){ 0 };
    for (int c = 0; c < PL_VERTEX_CLASSES; ++c) {
        pool->free_head[c] = PL_NONE;
    }
}

void pl_pool_free(pl_memory *memory, pl_vertex_pool *pool)
{
    pl_resize(memory, pool->items, pool->bytes, 0);
    pl_pool_init(pool);
}

bool pl_pool_reserve(pl_memory *memory, pl_vertex_pool *pool, uint32_t corners)
{
    if (corners > PL_NONE - 1 - pool->count) {
        return false;
    }
    uint32_t needed = pool->count + corners;
    if (needed <= pool->capacity) {
        return true;
    }
    uint32_t capacity = pool->capacity < PL_NONE / 2 ? pool->capacity * 2 : PL_NONE;
    capacity = capacity < needed ? needed : capacity;
    size_t bytes = capacity * sizeof(pl_vertex);
    pl_vertex *items = pl_resize(memory, pool->items, pool->bytes, bytes);
    if (items == NULL) {
        return false;
    }
    pool->items = items;
    pool->bytes = bytes;
    pool->capacity = capacity;
    return true;
}

uint32_t pl_pool_take(pl_vertex_pool *pool, uint8_t vertex_class)
{
    uint32_t first = pool->free_head[vertex_class];
    if (first == PL_NONE) {
        first = pool->count;
        pool->count += pl_pool_run(vertex_class);
    } else {
        memcpy(&pool->free_head[vertex_class], &pool->items[first], sizeof(uint32_t));
    }
    return first;
}

void pl_pool_give(pl_vertex_pool *pool, uint8_t vertex_class, uint32_t first)
{
    memcpy(&pool->items[first], &pool->free_head[vertex_class], sizeof(uint32_t));
    pool->free_head[vertex_class] = first;
}
