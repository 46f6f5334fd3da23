// heap.c - see heap.h.
#include "harness/heap.h"
#include "harness/trials.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// The size is kept in front of the block.
#define FRONT 64

static bool is_refused(heap *h, size_t old_size, size_t new_size)
{
    long call = atomic_fetch_add(&h->calls, 1);
    bool now = h->fail_at >= 0 && (call == h->fail_at || (h->from_there && call > h->fail_at));
    bool full = h->limit > 0 && new_size > old_size &&
                h->bytes + (long)new_size - (long)old_size > h->limit;
    if (now || full) {
        atomic_fetch_add(&h->refused, 1);
    }
    return now || full;
}

static void *resize(void *context, void *memory, size_t old_size, size_t new_size)
{
    heap *h = context;
    char *old = memory != NULL ? (char *)memory - FRONT : NULL, *fresh = NULL;
    assert_int_equal(old != NULL ? *(size_t *)(void *)old : 0, old_size);
    if (new_size > 0) {
        if (is_refused(h, old_size, new_size)) {
            return NULL;
        }
        fresh = aligned_alloc(64, (new_size + FRONT + 63) / 64 * 64);
        assert_non_null(fresh);
        *(size_t *)(void *)fresh = new_size;
        memset(fresh + FRONT, 0xa5, new_size);
        atomic_fetch_add(&h->blocks, 1);
    }
    if (old != NULL) {
        if (fresh != NULL) {
            memcpy(fresh + FRONT, memory, old_size < new_size ? old_size : new_size);
        }
        free(old);
        atomic_fetch_sub(&h->blocks, 1);
    }
    atomic_fetch_add(&h->bytes, (long)new_size - (long)old_size);
    return fresh != NULL ? fresh + FRONT : NULL;
}

plumb_allocator heap_allocator(heap *h)
{
    return (plumb_allocator){ resize, h };
}

void heap_fail(heap *h, long calls)
{
    h->fail_at = calls < 0 ? -1 : h->calls + calls;
}

#define MANY 60 // of more, each is failed in one precision of three (trials.h)

void heap_fail_each(heap_play *play, long least, long most)
{
    static heap h;
    long calls, unused;
    int refused = 0;
    const uint64_t end = play(&h, -1, &calls, &refused);
    assert_int_equal(refused, 0);
    assert_in_range(calls, least, most);
    for (long k = 0; k < calls; ++k) {
        if (calls > MANY && !trials_takes((uint32_t)k, 3)) {
            continue;
        }
        refused = 0;
        assert_true(play(&h, k, &unused, &refused) == end);
        assert_int_equal(refused, 1);
    }
    print_message("%ld allocations, %s failed once\n", calls,
                  calls > MANY ? "a share of them" : "each");
}
