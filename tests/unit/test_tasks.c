// test_tasks.c - the task pool: every chunk of every job is done once, whatever the number of threads;
// small jobs in a row, jobs after a pause, pools that come and go; the user's hooks in its place.
#define _POSIX_C_SOURCE 199309L // nanosleep
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "core/tasks.h"

enum { most_chunks = 3000 };

typedef struct tally {
    atomic_uint times[most_chunks];
    unsigned plain[most_chunks]; // written without a lock: a sanitizer would see two writers
} tally;

static void count_chunk(void *context, uint32_t chunk)
{
    tally *t = context;
    atomic_fetch_add(&t->times[chunk], 1);
    ++t->plain[chunk];
}

static void expect_all_once(tally *t, uint32_t chunks)
{
    for (uint32_t i = 0; i < most_chunks; ++i) {
        assert_int_equal(atomic_exchange(&t->times[i], 0), i < chunks ? 1 : 0);
        assert_int_equal(t->plain[i], i < chunks ? 1 : 0);
        t->plain[i] = 0;
    }
}

static const plumb_task_hooks no_hooks = { NULL };

static void every_chunk_is_done_once(void **state)
{
    (void)state;
    static tally t;
    pl_memory memory;
    pl_memory_init(&memory, &(plumb_allocator){ 0 });
    const int workers[] = { 1, 2, 3, 8, PLUMB_WORKERS_MAX };
    const uint32_t chunks[] = { 0, 1, 2, 3, 7, 64, most_chunks };
    for (size_t w = 0; w < sizeof workers / sizeof workers[0]; ++w) {
        pl_tasks *tasks = pl_tasks_create(&memory, workers[w], &no_hooks, NULL);
        assert_non_null(tasks);
        assert_int_equal(pl_tasks_workers(tasks), workers[w]);
        for (size_t c = 0; c < sizeof chunks / sizeof chunks[0]; ++c) {
            pl_tasks_run(tasks, count_chunk, &t, chunks[c]);
            expect_all_once(&t, chunks[c]);
        }
        pl_tasks_destroy(&memory, tasks);
    }
    pl_tasks_run(NULL, count_chunk, &t, 5);
    expect_all_once(&t, 5);
    assert_int_equal(pl_tasks_workers(NULL), 1);
    pl_tasks_destroy(&memory, NULL);
    assert_int_equal(memory.bytes, 0);
}

// Jobs of a few chunks, one right after another: a thread that comes late to a job must not take
// chunks of the next one for its own.
static void many_small_jobs(void **state)
{
    (void)state;
    static tally t;
    pl_memory memory;
    pl_memory_init(&memory, &(plumb_allocator){ 0 });
    pl_tasks *tasks = pl_tasks_create(&memory, 3, &no_hooks, NULL);
    for (uint32_t job = 0; job < 20000; ++job) {
        uint32_t chunks = 2 + job % 5;
        pl_tasks_run(tasks, count_chunk, &t, chunks);
        for (uint32_t i = 0; i < chunks; ++i) {
            assert_int_equal(atomic_exchange(&t.times[i], 0), 1);
        }
    }
    memset(t.plain, 0, sizeof t.plain);
    pl_tasks_destroy(&memory, tasks);
}

// Threads that went to sleep are woken: by the first job, or before it.
static void jobs_after_pauses(void **state)
{
    (void)state;
    static tally t;
    pl_memory memory;
    pl_memory_init(&memory, &(plumb_allocator){ 0 });
    pl_tasks *tasks = pl_tasks_create(&memory, 4, &no_hooks, NULL);
    for (int i = 0; i < 20; ++i) {
        pl_tasks_rest(tasks);
        nanosleep(&(struct timespec){ 0, 2000000 }, NULL);
        if (i % 3 > 0) {
            pl_tasks_rouse(tasks);
        }
        if (i % 3 > 1) {
            continue; // roused for nothing
        }
        pl_tasks_run(tasks, count_chunk, &t, 100);
        expect_all_once(&t, 100);
    }
    pl_tasks_rouse(NULL);
    pl_tasks_destroy(&memory, tasks);
}

static void run_backwards(void *hook_context, plumb_task_fn *task, void *context, uint32_t chunks)
{
    ++*(int *)hook_context;
    while (chunks > 0) {
        task(context, --chunks);
    }
}

static void hooks_take_the_place_of_threads(void **state)
{
    (void)state;
    static tally t;
    pl_memory memory;
    pl_memory_init(&memory, &(plumb_allocator){ 0 });
    int calls = 0;
    const plumb_task_hooks hooks = { run_backwards };
    pl_tasks *tasks = pl_tasks_create(&memory, 4, &hooks, &calls);
    pl_tasks_run(tasks, count_chunk, &t, 9);
    expect_all_once(&t, 9);
    pl_tasks_run(tasks, count_chunk, &t, 1); // not worth a call
    expect_all_once(&t, 1);
    assert_int_equal(calls, 1);
    pl_tasks_destroy(&memory, tasks);
    assert_int_equal(memory.bytes, 0);
}

// ---- ranges, phases, shares

typedef struct items {
    unsigned times[most_chunks]; // written without a lock: no two threads have one item
    unsigned order[most_chunks]; // phase in which an item was visited
    atomic_uint calls;
    const uint32_t *bounds;
    uint32_t phases;
} items;

static void visit_range(void *context, uint32_t first, uint32_t count)
{
    items *all = context;
    atomic_fetch_add(&all->calls, 1);
    for (uint32_t i = first; i < first + count; ++i) {
        ++all->times[i];
    }
}

static uint32_t count_odd(void *context, uint32_t first, uint32_t count)
{
    (void)context;
    uint32_t odd = 0;
    for (uint32_t i = first; i < first + count; ++i) {
        odd += i % 2;
    }
    return odd;
}

static void ranges_cover_all_once(void **state)
{
    (void)state;
    static items all;
    pl_memory memory;
    pl_memory_init(&memory, &(plumb_allocator){ 0 });
    const uint32_t counts[] = { 0, 1, 9, 10, 19, 20, 21, 1000, most_chunks };
    for (int workers = 1; workers <= 8; ++workers) {
        pl_tasks *tasks = pl_tasks_create(&memory, workers, &no_hooks, NULL);
        for (size_t c = 0; c < sizeof counts / sizeof counts[0]; ++c) {
            all = (items){ .calls = 0 };
            pl_tasks_ranges(tasks, counts[c], 10, visit_range, &all);
            for (uint32_t i = 0; i < most_chunks; ++i) {
                assert_int_equal(all.times[i], i < counts[c] ? 1 : 0);
            }
            uint32_t shares = pl_tasks_share_count(tasks, counts[c], 10);
            assert_int_equal(pl_tasks_count(tasks, counts[c], 10, count_odd, NULL), counts[c] / 2);
            assert_int_equal(all.calls, shares);
            assert_true(shares >= 1 && shares <= (uint32_t)workers);
            assert_true(shares == 1 || counts[c] / shares >= 10);
        }
        pl_tasks_rest(tasks);
        pl_tasks_destroy(&memory, tasks);
    }
    pl_tasks_rest(NULL);
    assert_int_equal(memory.bytes, 0);
}

// Each item of a phase asks whether all of the phase before are done.
static void visit_in_order(void *context, uint32_t first, uint32_t count)
{
    items *all = context;
    for (uint32_t i = first; i < first + count; ++i) {
        uint32_t phase = 0;
        while (i >= all->bounds[phase + 1]) {
            ++phase;
        }
        for (uint32_t k = phase > 0 ? all->bounds[phase - 1] : 0; k < all->bounds[phase]; ++k) {
            all->order[i] += all->times[k]; // a race here is a phase begun too early
        }
        ++all->times[i];
    }
}

static void phases_follow_one_another(void **state)
{
    (void)state;
    static items all;
    pl_memory memory;
    pl_memory_init(&memory, &(plumb_allocator){ 0 });
    // Phases to be shared out, phases too small for that, empty ones.
    static const uint32_t bounds[] = { 0, 100, 101, 101, 400, 410, 415, 700, 700, 715 };
    const uint32_t phases = sizeof bounds / sizeof bounds[0] - 1;
    for (int workers = 1; workers <= 4; ++workers) {
        pl_tasks *tasks = pl_tasks_create(&memory, workers, &no_hooks, NULL);
        for (int turn = 0; turn < 50; ++turn) {
            all = (items){ .bounds = bounds, .phases = phases };
            pl_tasks_phases(tasks, bounds, phases, 8, visit_in_order, &all);
            for (uint32_t p = 0; p < phases; ++p) {
                uint32_t before = p > 0 ? bounds[p] - bounds[p - 1] : 0;
                for (uint32_t i = bounds[p]; i < bounds[p + 1]; ++i) {
                    assert_int_equal(all.times[i], 1);
                    assert_int_equal(all.order[i], before);
                }
            }
            pl_tasks_shares(tasks, bounds, phases, 8, visit_range, &all);
            for (uint32_t i = 0; i < most_chunks; ++i) {
                assert_int_equal(all.times[i], i < bounds[phases] ? 2 : 0);
            }
        }
        pl_tasks_destroy(&memory, tasks);
    }
    assert_int_equal(memory.bytes, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_chunk_is_done_once),
        cmocka_unit_test(many_small_jobs),
        cmocka_unit_test(jobs_after_pauses),
        cmocka_unit_test(hooks_take_the_place_of_threads),
        cmocka_unit_test(ranges_cover_all_once),
        cmocka_unit_test(phases_follow_one_another),
    };
    return cmocka_run_group_tests_name("tasks", tests, NULL, NULL);
}
