// test_sort.c - sorting and finding of keyed records, against the definition.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "harness/random.h"
#include "core/sort.h"

#define MOST 300

static void sorted_by_key_then_order(void **state)
{
    (void)state;
    uint32_t seed = 1;
    for (uint32_t count = 0; count < MOST; ++count) {
        pl_keyed items[MOST];
        uint64_t sum = 0;
        for (uint32_t i = 0; i < count; ++i) {
            items[i] = (pl_keyed){ pl_key(sim_random(&seed) % 4, sim_random(&seed) % 8), i,
                                   sim_random(&seed) };
            sum += items[i].key * 31 + items[i].value;
        }
        pl_sort_keyed(items, count);
        for (uint32_t i = 0; i < count; ++i) {
            sum -= items[i].key * 31 + items[i].value;
            if (i > 0) {
                assert_true(
                    items[i - 1].key < items[i].key ||
                    (items[i - 1].key == items[i].key && items[i - 1].order < items[i].order));
            }
        }
        assert_true(sum == 0);
    }
}

static void found_where_it_stands_or_would(void **state)
{
    (void)state;
    for (uint32_t count = 0; count < 40; ++count) {
        pl_keyed items[40] = { 0 };
        for (uint32_t i = 0; i < count; ++i) {
            items[i] = (pl_keyed){ .key = 2 * i + 1 };
        }
        for (uint64_t key = 0; key <= 2 * count; ++key) {
            bool found;
            uint32_t at = pl_find_key(items, count, sizeof items[0], key, &found);
            assert_int_equal(found, key % 2 == 1);
            assert_int_equal(at, key / 2);
        }
    }
}

static void counts_become_places(void **state)
{
    (void)state;
    uint32_t counts[4] = { 3, 0, 2, 1 };
    const uint32_t places[4] = { 10, 13, 13, 15 };
    assert_int_equal(pl_counts_to_places(counts, 4, 10), 16);
    assert_memory_equal(counts, places, sizeof places);
    assert_int_equal(pl_counts_to_places(counts, 0, 7), 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sorted_by_key_then_order),
        cmocka_unit_test(found_where_it_stands_or_would),
        cmocka_unit_test(counts_become_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
