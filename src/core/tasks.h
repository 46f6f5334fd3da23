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
// part. `tasks` null: one after another. Cost: about a microsecond while the threads are awake; they
// stay so for some tens of microseconds after a job. Not to be called from a task.
void pl_tasks_run(pl_tasks *tasks, plumb_task_fn *task, void *context, uint32_t chunks);

// Threads that take part, the caller included; 1 for null.
int pl_tasks_workers(const pl_tasks *tasks);

#endif
