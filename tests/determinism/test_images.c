// test_images.c - no saved byte depends on capacity, history or addresses: worlds with equal hashes have equal
// images, byte for byte. Random sessions are taken twice, step for step, the second time in a world with other
// capacities, threads or width, restored from its own image, exchanged for a new one, asked about in between, or watched.
#include "session.h"

#include "harness/heap.h"
#include "harness/random.h"
#include "harness/trials.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 40, SESSIONS = 20 };

typedef enum variation { AGAIN, ROOMY, THREADS, RESTORED, EXCHANGED, ASKED, WATCHED } variation;

typedef struct image {
    char *bytes;
    size_t size;
} image;

static image image_of(const plumb_world *w)
{
    image i = { .size = plumb_world_snapshot_size(w) };
    i.bytes = malloc(i.size);
    assert_non_null(i.bytes);
    assert_int_equal(plumb_world_save(w, i.bytes, i.size), PLUMB_OK);
    return i;
}

static plumb_world_desc settings_of(variation how, uint32_t seed, heap *h)
{
    plumb_world_desc d = { .allocator = heap_allocator(h), .simd_width = 4 };
    if (how == ROOMY) {
        d.body_capacity = 50 + seed % 200;
        d.shape_capacity = seed % 300;
        d.contact_capacity = seed % 1000;
    } else if (how == THREADS) {
        d.workers = 2 + (int)(seed % 2);
        d.simd_width = seed % 3 == 0 ? 16 : 8;
    }
    return d;
}

static void ask(plumb_world *w)
{
    plumb_ray_hit hit;
    plumb_shape shapes[8];
    plumb_nearest_hit near;
    plumb_world_ray(w, (plumb_vec2){ -9, 1 }, (plumb_vec2){ 9, 2 }, NULL, &hit);
    plumb_world_nearest(w, (plumb_vec2){ 0, 3 }, 5, NULL, &near);
    plumb_world_overlap_aabb(w, (plumb_aabb){ { -2, -2 }, { 2, 2 } }, NULL, shapes, 8);
}

// By a watchdog, with measures or without; or no more.
static void watch(plumb_world *w, uint32_t *seed)
{
    assert_int_equal(plumb_world_set_watchdog(w, sim_random(seed) % 4 != 0), PLUMB_OK);
    assert_int_equal(plumb_world_set_measure(w, sim_random(seed) % 2 == 0), PLUMB_OK);
}

// What is done to the second world in between.
static void vary(session *s, variation how, uint32_t *seed, heap *h)
{
    if (how == ASKED) {
        ask(s->world);
    }
    if (how == WATCHED && sim_random(seed) % 8 == 0) {
        watch(s->world, seed);
    }
    if ((how != RESTORED && how != EXCHANGED) || sim_random(seed) % 3 != 0) {
        return;
    }
    image i = image_of(s->world);
    if (how == EXCHANGED) {
        session old = *s;
        const plumb_world_desc d = settings_of(sim_random(seed) % 2 ? ROOMY : AGAIN, *seed, h);
        session_twin(s, &old, &d);
        assert_int_equal(plumb_world_restore(s->world, i.bytes, i.size), PLUMB_OK);
        // Its hooks give commands to whoever lives.
        plumb_world *next = s->world;
        s->world = old.world;
        session_end(s);
        s->world = next;
    } else {
        assert_int_equal(plumb_world_restore(s->world, i.bytes, i.size), PLUMB_OK);
    }
    image after = image_of(s->world);
    assert_int_equal(i.size, after.size);
    assert_memory_equal(i.bytes, after.bytes, i.size);
    free(i.bytes);
    free(after.bytes);
}

static void tell(const session *a, const session *b, uint32_t seed, int step, const char *when)
{
    plumb_difference rows[8];
    int count = 0;
    print_error("session %" PRIu32 ", step %d, %s:\n", seed, step, when);
    if (plumb_world_compare(a->world, b->world, rows, 8, &count) == PLUMB_OK) {
        for (int i = 0; i < count && i < 8; ++i) {
            print_error("  %s %s %s %s\n", rows[i].table, rows[i].component, rows[i].a, rows[i].b);
        }
    }
}

static void check(const session *a, const session *b, uint32_t seed, int step, const char *when)
{
    uint64_t hash = plumb_world_hash(a->world);
    image x = image_of(a->world), y = image_of(b->world);
    bool same = x.size == y.size && memcmp(x.bytes, y.bytes, x.size) == 0;
    if (hash != plumb_world_hash(b->world) || !same) {
        size_t at = 0;
        while (at < x.size && at < y.size && x.bytes[at] == y.bytes[at]) {
            ++at;
        }
        tell(a, b, seed, step, when);
        print_error("hash %d, sizes %zu %zu, byte %zu\n", hash == plumb_world_hash(b->world),
                    x.size, y.size, at);
    }
    assert_true(hash == plumb_world_hash(b->world));
    assert_int_equal(x.size, y.size);
    assert_true(same);
    free(x.bytes);
    free(y.bytes);
}

static void run(uint32_t seed, variation how)
{
    heap heaps[2] = { HEAP_INIT, HEAP_INIT };
    session a, b;
    uint32_t moments = seed + 77;
    const plumb_world_desc plain = settings_of(AGAIN, seed, &heaps[0]);
    const plumb_world_desc other = settings_of(how, seed, &heaps[1]);
    session_begin(&a, seed, &plain);
    session_begin(&b, seed, &other);
    if (how == WATCHED) {
        watch(b.world, &moments);
    }
    for (int step = 0; step < STEPS; ++step) {
        session_act(&a);
        session_act(&b);
        check(&a, &b, seed, step, "after calls");
        vary(&b, how, &moments, &heaps[1]);
        check(&a, &b, seed, step, "before the step");
        plumb_real dt = session_dt(&a);
        assert_true(dt == session_dt(&b));
        assert_int_equal(plumb_world_step(a.world, dt), plumb_world_step(b.world, dt));
        check(&a, &b, seed, step, "after the step");
        vary(&b, how, &moments, &heaps[1]);
    }
    session_end(&a);
    session_end(&b);
}

static void run_all(variation how)
{
    const trials t = trials_from(0, SESSIONS);
    for (uint32_t seed = t.first; seed < t.end; ++seed) {
        run(seed, how);
    }
}

static void test_sessions_taken_again(void **state)
{
    (void)state;
    run_all(AGAIN);
}

static void test_other_capacities(void **state)
{
    (void)state;
    run_all(ROOMY);
}

static void test_other_threads_and_widths(void **state)
{
    (void)state;
    run_all(THREADS);
}

static void test_restored(void **state)
{
    (void)state;
    run_all(RESTORED);
}

static void test_exchanged_for_a_new_world(void **state)
{
    (void)state;
    run_all(EXCHANGED);
}

static void test_asked_in_between(void **state)
{
    (void)state;
    run_all(ASKED);
}

static void test_watched(void **state)
{
    (void)state;
    run_all(WATCHED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sessions_taken_again),
        cmocka_unit_test(test_other_capacities),
        cmocka_unit_test(test_other_threads_and_widths),
        cmocka_unit_test(test_restored),
        cmocka_unit_test(test_exchanged_for_a_new_world),
        cmocka_unit_test(test_asked_in_between),
        cmocka_unit_test(test_watched),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
