// test_registry.c - entity slots: generations, stale handles, first in first out reuse,
// reservation.
#include "ecs/registry.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

typedef struct fixture {
    pl_memory memory;
    pl_registry registry;
} fixture;

static int set_up(void **state)
{
    static fixture f;
    pl_memory_init(&f.memory, NULL);
    pl_registry_init(&f.registry);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    pl_registry_free(&f->memory, &f->registry);
    return f->memory.bytes == 0 ? 0 : -1;
}

static plumb_entity take(fixture *f, uint32_t row)
{
    assert_true(pl_registry_reserve(&f->memory, &f->registry, 1));
    return pl_registry_acquire(&f->registry, 1, row, PL_SLOT_LIVE);
}

static void a_handle_finds_its_row_until_it_is_released(void **state)
{
    fixture *f = *state;
    plumb_entity e = take(f, 7);
    assert_int_equal(e.generation, 1);
    assert_int_equal(pl_registry_find(&f->registry, e)->row, 7);
    pl_registry_release(&f->registry, e);
    assert_null(pl_registry_find(&f->registry, e));
    assert_int_equal(f->registry.live, 0);
}

static void null_foreign_and_future_handles_find_nothing(void **state)
{
    fixture *f = *state;
    plumb_entity e = take(f, 0);
    assert_null(pl_registry_find(&f->registry, (plumb_entity){ 0, 0 }));
    assert_null(pl_registry_find(&f->registry, (plumb_entity){ e.index, 0 }));
    assert_null(pl_registry_find(&f->registry, (plumb_entity){ e.index, e.generation + 1 }));
    assert_null(pl_registry_find(&f->registry, (plumb_entity){ e.index + 1, 1 }));
    assert_null(pl_registry_find(&f->registry, (plumb_entity){ UINT32_MAX, 1 }));
}

static void slots_are_reused_first_in_first_out(void **state)
{
    fixture *f = *state;
    plumb_entity e[3];
    for (uint32_t i = 0; i < 3; ++i) {
        e[i] = take(f, i);
        assert_int_equal(e[i].index, i);
    }
    pl_registry_release(&f->registry, e[2]);
    pl_registry_release(&f->registry, e[0]);
    pl_registry_release(&f->registry, e[1]);
    const uint32_t order[] = { 2, 0, 1, 3 };
    for (int i = 0; i < 4; ++i) {
        plumb_entity again = take(f, 0);
        assert_int_equal(again.index, order[i]);
        assert_int_equal(again.generation, i < 3 ? 2 : 1);
    }
}

static void a_pending_slot_is_taken_but_not_alive(void **state)
{
    fixture *f = *state;
    assert_true(pl_registry_reserve(&f->memory, &f->registry, 1));
    plumb_entity e = pl_registry_acquire(&f->registry, 2, 0, PL_SLOT_PENDING);
    assert_null(pl_registry_find(&f->registry, e));
    assert_non_null(pl_registry_find_pending(&f->registry, e));
    assert_int_not_equal(take(f, 0).index, e.index);
    pl_registry_find_pending(&f->registry, e)->state = PL_SLOT_LIVE;
    assert_non_null(pl_registry_find(&f->registry, e));
    assert_null(pl_registry_find_pending(&f->registry, e));
}

static void a_slot_without_generations_left_is_retired(void **state)
{
    fixture *f = *state;
    plumb_entity e = take(f, 0);
    f->registry.slots[e.index].generation = UINT32_MAX;
    e.generation = UINT32_MAX;
    assert_non_null(pl_registry_find(&f->registry, e));
    pl_registry_release(&f->registry, e);
    assert_null(pl_registry_find(&f->registry, e));
    plumb_entity next = take(f, 0);
    assert_int_not_equal(next.index, e.index);
}

static void acquiring_what_was_reserved_allocates_nothing(void **state)
{
    fixture *f = *state;
    assert_true(pl_registry_reserve(&f->memory, &f->registry, 1000));
    size_t bytes = f->memory.bytes;
    const pl_slot *slots = f->registry.slots;
    for (uint32_t i = 0; i < 1000; ++i) {
        pl_registry_acquire(&f->registry, 1, i, PL_SLOT_LIVE);
    }
    assert_int_equal(f->memory.bytes, bytes);
    assert_ptr_equal(f->registry.slots, slots);
    for (uint32_t i = 0; i < 1000; ++i) {
        assert_int_equal(pl_registry_find(&f->registry, (plumb_entity){ i, 1 })->row, i);
    }
}

static void reserving_beyond_the_last_slot_is_refused(void **state)
{
    fixture *f = *state;
    take(f, 0);
    assert_false(pl_registry_reserve(&f->memory, &f->registry, UINT32_MAX));
    assert_int_equal(f->registry.count, 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_handle_finds_its_row_until_it_is_released),
        TEST(null_foreign_and_future_handles_find_nothing),
        TEST(slots_are_reused_first_in_first_out),
        TEST(a_pending_slot_is_taken_but_not_alive),
        TEST(a_slot_without_generations_left_is_retired),
        TEST(acquiring_what_was_reserved_allocates_nothing),
        TEST(reserving_beyond_the_last_slot_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
