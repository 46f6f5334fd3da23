/// heap.h - an allocator for tests: counts, runs out of memory when it is told to, and finds sizes that
/// are not those of the block. Handed out memory is full of 0xa5. May be asked by several threads.
///
///     heap h = HEAP_INIT;
///     plumb_world_create(&(plumb_world_desc){ .allocator = heap_allocator(&h) }, &world);
///     heap_fail(&h, 3);                  // three calls from now one gets nothing
///     ... h.refused tells whether it came to that
#ifndef HARNESS_HEAP_H
#define HARNESS_HEAP_H

#include "plumb/plumb.h"

#include <stdatomic.h>
#include <stddef.h>

typedef struct heap {
    atomic_long calls;         ///< that asked for memory
    atomic_long refused;       ///< of those
    atomic_long blocks, bytes; ///< handed out
    long fail_at;              ///< the call, from 0, that is refused; -1: none
    bool from_there;           ///< and all after it
    long limit;                ///< [B] most to be handed out; 0: any
} heap;

#define HEAP_INIT                                                                                  \
    {                                                                                              \
        .fail_at = -1                                                                              \
    }

/// The allocator over `h`, which must outlive what it is given to.
plumb_allocator heap_allocator(heap *h);

/// Refuses the call after the next `calls` ones; negative: none.
void heap_fail(heap *h, long calls);

/// Plays a world from its beginning to its end, asking again for what is refused: with its allocation `fail_at` refused (-1: none),
/// how many it made in all, how often it was refused. Returns what the world came to.
typedef uint64_t heap_play(heap *h, long fail_at, long *calls, int *refused);

/// Refuses each allocation of a play once: it is told once, and the end is the same. A play makes `least` to `most`.
void heap_fail_each(heap_play *play, long least, long most);

#endif
