// tasks.c - a pool of threads that wait in a short spin, so that the many small jobs of a step cost
// little, and then in sleep, so that a world between two steps costs nothing.
//
// A job is open while `ticket` holds chunks that nobody took: its low half counts them, its high half
// numbers the jobs. Taking one is a compare and swap of the whole ticket. That also settles the one
// race there is: a thread that read the job's fields late, when another job had replaced them,
// finds another ticket and takes nothing.
#include "core/tasks.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

// Turns of the waiting loop before a thread goes to sleep: some tens of microseconds.
#define SPINS 4000

struct pl_tasks {
    plumb_task_hooks hooks;
    void *hook_context;
    int workers;

    _Alignas(64) _Atomic uint64_t ticket;
    _Atomic uint32_t done;   // chunks of the open job that are finished
    _Atomic uint32_t chunks; // of the open job
    _Atomic(plumb_task_fn *) task;
    _Atomic(void *) context;

    _Alignas(64) _Atomic int sleeping;
    _Atomic bool ending;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    int threads; // that were started
    pthread_t thread[PLUMB_WORKERS_MAX];
};

static inline void relax(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

// Takes a chunk of the open job and does it. False: there is none.
static bool work(pl_tasks *t)
{
    uint64_t ticket = atomic_load_explicit(&t->ticket, memory_order_acquire);
    uint32_t left = (uint32_t)ticket;
    if (left == 0) {
        return false;
    }
    plumb_task_fn *task = atomic_load_explicit(&t->task, memory_order_relaxed);
    void *context = atomic_load_explicit(&t->context, memory_order_relaxed);
    uint32_t chunks = atomic_load_explicit(&t->chunks, memory_order_relaxed);
    if (atomic_compare_exchange_weak_explicit(&t->ticket, &ticket, ticket - 1, memory_order_acq_rel,
                                              memory_order_relaxed)) {
        task(context, chunks - left);
        atomic_fetch_add_explicit(&t->done, 1, memory_order_release);
    }
    return true;
}

static void sleep_until_work(pl_tasks *t)
{
    pthread_mutex_lock(&t->lock);
    atomic_fetch_add(&t->sleeping, 1);
    while ((uint32_t)atomic_load(&t->ticket) == 0 && !atomic_load(&t->ending)) {
        pthread_cond_wait(&t->wake, &t->lock);
    }
    atomic_fetch_sub(&t->sleeping, 1);
    pthread_mutex_unlock(&t->lock);
}

static void *worker(void *argument)
{
    pl_tasks *t = argument;
    while (!atomic_load_explicit(&t->ending, memory_order_relaxed)) {
        int spins = 0;
        while (spins < SPINS && !work(t)) {
            relax();
            ++spins;
        }
        if (spins == SPINS) {
            sleep_until_work(t);
        }
    }
    return NULL;
}

static void wake_sleepers(pl_tasks *t)
{
    if (atomic_load(&t->sleeping) > 0) {
        pthread_mutex_lock(&t->lock);
        pthread_cond_broadcast(&t->wake);
        pthread_mutex_unlock(&t->lock);
    }
}

void pl_tasks_run(pl_tasks *t, plumb_task_fn *task, void *context, uint32_t chunks)
{
    if (t != NULL && t->hooks.run != NULL && chunks > 1) {
        t->hooks.run(t->hook_context, task, context, chunks);
        return;
    }
    if (t == NULL || t->threads == 0 || chunks <= 1) {
        for (uint32_t i = 0; i < chunks; ++i) {
            task(context, i);
        }
        return;
    }
    atomic_store_explicit(&t->task, task, memory_order_relaxed);
    atomic_store_explicit(&t->context, context, memory_order_relaxed);
    atomic_store_explicit(&t->chunks, chunks, memory_order_relaxed);
    atomic_store_explicit(&t->done, 0, memory_order_relaxed);
    uint64_t job = (atomic_load_explicit(&t->ticket, memory_order_relaxed) >> 32) + 1;
    atomic_store(&t->ticket, job << 32 | chunks);
    wake_sleepers(t);
    while (work(t)) {
    }
    while (atomic_load_explicit(&t->done, memory_order_acquire) < chunks) {
        relax();
    }
}

static bool start_threads(pl_tasks *t)
{
    for (int i = 0; i < t->workers - 1; ++i) {
        if (pthread_create(&t->thread[i], NULL, worker, t) != 0) {
            return false;
        }
        ++t->threads;
    }
    return true;
}

pl_tasks *pl_tasks_create(pl_memory *memory, int workers, const plumb_task_hooks *hooks,
                          void *hook_context)
{
    pl_tasks *t = pl_resize(memory, NULL, 0, sizeof *t);
    if (t == NULL) {
        return NULL;
    }
    memset(t, 0, sizeof *t);
    t->hooks = *hooks;
    t->hook_context = hook_context;
    t->workers = workers;
    if (hooks->run != NULL || workers == 1) {
        return t;
    }
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->wake, NULL);
    if (!start_threads(t)) {
        pl_tasks_destroy(memory, t);
        return NULL;
    }
    return t;
}

void pl_tasks_destroy(pl_memory *memory, pl_tasks *t)
{
    if (t == NULL) {
        return;
    }
    if (t->hooks.run == NULL && t->workers > 1) {
        pthread_mutex_lock(&t->lock);
        atomic_store(&t->ending, true);
        pthread_cond_broadcast(&t->wake);
        pthread_mutex_unlock(&t->lock);
        for (int i = 0; i < t->threads; ++i) {
            pthread_join(t->thread[i], NULL);
        }
        pthread_cond_destroy(&t->wake);
        pthread_mutex_destroy(&t->lock);
    }
    pl_resize(memory, t, sizeof *t, 0);
}

int pl_tasks_workers(const pl_tasks *t)
{
    return t == NULL ? 1 : t->workers;
}
