// batch.h - many worlds in one array, for the files of this folder. They use the public interface of
// worlds, and the check of handles.
#ifndef PL_BATCH_H
#define PL_BATCH_H

#include "core/memory.h"
#include "core/tasks.h"
#include "plumb/batch.h"

// What a world was when it was built.
typedef struct pl_batch_image {
    void *bytes;
    size_t size;
    bool shared; // the bytes are those of world 0, which is alike
} pl_batch_image;

typedef struct pl_batch_item {
    plumb_world *world;
    pl_batch_image image;
    uint64_t episode; // resets so far
    plumb_result result;
    uint32_t called; // number of the reset that named it last: no world twice
} pl_batch_item;

struct plumb_batch {
    pl_memory memory;
    plumb_batch_desc desc; // `world` null, for the user's may be gone
    pl_tasks *tasks;       // null: one thread
    pl_batch_item *items;  // desc.count
    uint32_t calls;        // resets
    plumb_batch_trouble trouble;
    char text[512]; // of the trouble
};

// A job on worlds: run(job, index) for each; its result is kept as the world's.
typedef plumb_result pl_batch_run(const void *job, plumb_batch *batch, uint32_t index);

// Runs a job on all worlds, or on those listed, shared out among the workers. Errors: that of the first
// by index, which is told in `trouble`.
plumb_result pl_batch_for(plumb_batch *batch, pl_batch_run *run, const void *job,
                          const uint32_t *worlds, uint32_t count);

// Refuses an argument: "<function>: <message>".
plumb_result pl_batch_fail(plumb_batch *batch, plumb_result code, const char *function,
                           const char *format, ...);

// Randomises a world for the episode that it is in.
plumb_result pl_batch_vary(plumb_batch *batch, plumb_batch_fn *vary, uint32_t index);

#endif
