// tasks.c - a pool of threads that wait in a short spin, so that the many small jobs of a step cost
// little, and then in sleep, so that a world between two steps costs nothing.
//
// A job is open while `ticket` holds chunks that nobody took: its low half counts them, its high half
// numbers the jobs. Taking one is a compare and swap of the whole ticket. That also settles the one
// race there is: a thread that read the job's fields late, when another job had replaced them,
// finds another ticket and takes nothing.
#include "core/tasks.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

// Turns of the waiting loop before a thread goes to sleep, or, while a step is under way, lets others
// have its core for a moment: some tens of microseconds. Waking one costs as much.
#define SPINS 1000

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
    _Atomic bool busy; // a job was run, and more are to come soon
    pthread_mutex_t lock;
    pthread_cond_t wake;
    bool used;   // since they were roused; the caller's own
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
    while ((uint32_t)atomic_load(&t->ticket) == 0 && !atomic_load(&t->busy) &&
           !atomic_load(&t->ending)) {
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
        if (spins == SPINS && atomic_load_explicit(&t->busy, memory_order_relaxed)) {
            sched_yield();
        } else if (spins == SPINS) {
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
    t->used = true;
    atomic_store_explicit(&t->busy, true, memory_order_relaxed);
    atomic_store_explicit(&t->task, task, memory_order_relaxed);
    atomic_store_explicit(&t->context, context, memory_order_relaxed);
    atomic_store_explicit(&t->chunks, chunks, memory_order_relaxed);
    atomic_store_explicit(&t->done, 0, memory_order_relaxed);
    uint64_t job = (atomic_load_explicit(&t->ticket, memory_order_relaxed) >> 32) + 1;
    atomic_store(&t->ticket, job << 32 | chunks);
    wake_sleepers(t);
    while (work(t)) {
    }
    // With more threads than cores, the one that has the last chunk may have to get a core first.
    for (int spins = 0; atomic_load_explicit(&t->done, memory_order_acquire) < chunks; ++spins) {
        if (spins < SPINS) {
            relax();
        } else {
            sched_yield();
        }
    }
}

void pl_tasks_rouse(pl_tasks *t)
{
    if (t != NULL && t->used) {
        t->used = false;
        atomic_store(&t->busy, true);
        wake_sleepers(t);
    }
}

void pl_tasks_rest(pl_tasks *t)
{
    if (t != NULL) {
        atomic_store_explicit(&t->busy, false, memory_order_relaxed);
    }
}

typedef struct job {
    pl_range_fn *range;
    void *context;
    uint32_t first, count, shares;
    const uint32_t *bounds;
    uint32_t phases, least;
} job;

static uint32_t share_count(uint32_t workers, uint32_t count, uint32_t least)
{
    uint32_t most = count / least;
    return most < 1 ? 1 : most < workers ? most : workers;
}

uint32_t pl_tasks_share_count(const pl_tasks *t, uint32_t count, uint32_t least)
{
    return share_count((uint32_t)pl_tasks_workers(t), count, least);
}

static void run_share(void *context, uint32_t i)
{
    const job *j = context;
    pl_share s = pl_share_of(j->count, j->shares, i);
    j->range(j->context, j->first + s.first, s.end - s.first);
}

void pl_tasks_ranges(pl_tasks *t, uint32_t count, uint32_t least, pl_range_fn *range, void *context)
{
    job j = { .range = range,
              .context = context,
              .count = count,
              .shares = pl_tasks_share_count(t, count, least) };
    if (j.shares == 1) {
        range(context, 0, count);
        return;
    }
    pl_tasks_run(t, run_share, &j, j.shares);
}

typedef struct tally {
    pl_count_fn *range;
    void *context;
    uint32_t count, shares;
    uint32_t counted[PLUMB_WORKERS_MAX];
} tally;

static void count_share(void *context, uint32_t i)
{
    tally *all = context;
    pl_share s = pl_share_of(all->count, all->shares, i);
    all->counted[i] = all->range(all->context, s.first, s.end - s.first);
}

uint32_t pl_tasks_count(pl_tasks *t, uint32_t count, uint32_t least, pl_count_fn *range,
                        void *context)
{
    tally all = { .range = range,
                  .context = context,
                  .count = count,
                  .shares = pl_tasks_share_count(t, count, least) };
    pl_tasks_run(t, count_share, &all, all.shares);
    uint32_t sum = 0;
    for (uint32_t i = 0; i < all.shares; ++i) {
        sum += all.counted[i];
    }
    return sum;
}

void pl_tasks_phases(pl_tasks *t, const uint32_t *bounds, uint32_t phases, uint32_t least,
                     pl_range_fn *range, void *context)
{
    const uint32_t workers = (uint32_t)pl_tasks_workers(t);
    job j = { .range = range, .context = context };
    uint32_t done = bounds[0];
    for (uint32_t p = 0; p < phases && workers > 1; ++p) {
        j.first = bounds[p];
        j.count = bounds[p + 1] - bounds[p];
        j.shares = share_count(workers, j.count, least);
        if (j.shares > 1) {
            range(context, done, j.first - done); // small ones before it, one after another
            pl_tasks_run(t, run_share, &j, j.shares);
            done = bounds[p + 1];
        }
    }
    range(context, done, bounds[phases] - done);
}

// What thread i has of all phases; the first one has what is not shared.
static void run_all_shares(void *context, uint32_t i)
{
    job j = *(const job *)context;
    const uint32_t workers = j.shares;
    for (uint32_t p = 0; p < j.phases; ++p) {
        j.first = j.bounds[p];
        j.count = j.bounds[p + 1] - j.bounds[p];
        j.shares = share_count(workers, j.count, j.least);
        if (i < j.shares) {
            run_share(&j, i);
        }
    }
}

void pl_tasks_shares(pl_tasks *t, const uint32_t *bounds, uint32_t phases, uint32_t least,
                     pl_range_fn *range, void *context)
{
    job j = {
        .range = range, .context = context, .bounds = bounds, .phases = phases, .least = least
    };
    j.shares = (uint32_t)pl_tasks_workers(t);
    if (j.shares == 1 || bounds[phases] - bounds[0] < 2 * least) {
        range(context, bounds[0], bounds[phases] - bounds[0]);
    } else {
        pl_tasks_run(t, run_all_shares, &j, j.shares);
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
