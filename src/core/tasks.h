// tasks.h - work shared out among threads: one call runs a function over the chunks of a job on all
// of them and returns when every chunk is done.
//
// Nothing depends on which thread takes which chunk: a chunk writes to places of its own, and who
// called puts the results together in the order of chunks. Then the bits are the same with any number
// of threads.
#ifndef PL_TASKS_H
#define PL_TASKS_H

#include "core/memory.h"
#include "plumb/base.h"

typedef struct pl_tasks pl_tasks;

// Threads are made here, `workers` - 1 of them; with one worker, or with hooks, none. Null when out of
// memory or threads.
pl_tasks *pl_tasks_create(pl_memory *memory, int workers, const plumb_task_hooks *hooks,
                          void *hook_context);
// Ends the threads. Null is ignored.
void pl_tasks_destroy(pl_memory *memory, pl_tasks *tasks);

// Runs task(context, i) for every i below `chunks`, in any order and on any thread; the caller takes
// part. `tasks` null: one after another. Cost: half a microsecond while the threads are awake, 50 where
// they have to be woken. They stay awake until pl_tasks_rest. Not to be called from a task.
void pl_tasks_run(pl_tasks *tasks, plumb_task_fn *task, void *context, uint32_t chunks);
// Jobs will follow soon, if there have been any since this was called the last time: threads are woken meanwhile.
// Null is ignored.
void pl_tasks_rouse(pl_tasks *tasks);
// No job will follow soon: threads may go to sleep. Null is ignored.
void pl_tasks_rest(pl_tasks *tasks);

// Items [first, end) of a job that a thread has.
typedef struct pl_share {
    uint32_t first, end;
} pl_share;

// How many threads are worth having for so many items, if none is to get fewer than `least`.
uint32_t pl_tasks_share_count(const pl_tasks *tasks, uint32_t count, uint32_t least);
// What thread i of `shares` gets: equal parts, in order.
static inline pl_share pl_share_of(uint32_t count, uint32_t shares, uint32_t i)
{
    return (pl_share){ (uint32_t)((uint64_t)count * i / shares),
                       (uint32_t)((uint64_t)count * (i + 1) / shares) };
}

typedef void pl_range_fn(void *context, uint32_t first, uint32_t count);

// Shares `count` items out as ranges in order, one a thread and none of fewer than `least`; with one
// thread that is a plain call. The same range goes to the same thread as a rule, so that a job over the
// same items finds them in its cache.
void pl_tasks_ranges(pl_tasks *tasks, uint32_t count, uint32_t least, pl_range_fn *range,
                     void *context);

// The same for what is counted on the way: the sum of what the ranges return.
typedef uint32_t pl_count_fn(void *context, uint32_t first, uint32_t count);
uint32_t pl_tasks_count(pl_tasks *tasks, uint32_t count, uint32_t least, pl_count_fn *range,
                        void *context);

// Items in phases: phase p is [bounds[p], bounds[p + 1]). Phases follow one another, the items of one are
// shared out as above. A thread has the same share of a phase in every call.
typedef void pl_share_fn(pl_tasks *tasks, const uint32_t *bounds, uint32_t phases, uint32_t least,
                         pl_range_fn *range, void *context);
pl_share_fn pl_tasks_phases;
// The same shares, all at once: for what is to be in the cache of the thread that has it in the phases.
pl_share_fn pl_tasks_shares;

// Threads that take part, the caller included; 1 for null.
int pl_tasks_workers(const pl_tasks *tasks);

#endif
