// test_table.c - tables of columns and growable buffers: alignment, growth, copies, failing memory.
#include "core/table.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

typedef struct things {
    pl_table table;
    double *weight;
    uint8_t *color;
    uint32_t *id;
} things;

static const pl_column columns[] = {
    { offsetof(things, weight), sizeof(double) },
    { offsetof(things, color), sizeof(uint8_t) },
    { offsetof(things, id), sizeof(uint32_t) },
};
#define COLUMN_COUNT 3

static bool reserve(pl_memory *memory, things *t, uint32_t capacity)
{
    return pl_table_reserve(memory, &t->table, columns, COLUMN_COUNT, capacity);
}

static void columns_are_aligned_zero_and_grow_together(void **state)
{
    (void)state;
    pl_memory memory;
    pl_memory_init(&memory, NULL);
    things t = { 0 };
    for (uint32_t row = 0; row < 5000; ++row) {
        assert_true(reserve(&memory, &t, row + 1));
        assert_true(t.weight[row] == 0 && t.color[row] == 0 && t.id[row] == 0);
        t.weight[row] = row * 0.5;
        t.color[row] = (uint8_t)row;
        t.id[row] = row;
        ++t.table.count;
    }
    assert_int_equal((uintptr_t)t.weight % PL_ALIGN, 0);
    assert_int_equal((uintptr_t)t.color % PL_ALIGN, 0);
    assert_int_equal((uintptr_t)t.id % PL_ALIGN, 0);
    for (uint32_t row = 0; row < 5000; ++row) {
        assert_true(t.weight[row] == row * 0.5);
        assert_int_equal(t.color[row], row & 255);
        assert_int_equal(t.id[row], row);
    }
    assert_in_range(t.table.capacity, 5000, 10000);
    assert_int_equal(memory.bytes, t.table.block_size);
    pl_table_free(&memory, &t.table, columns, COLUMN_COUNT);
    assert_int_equal(memory.bytes, 0);
    assert_null(t.weight);
}

static void rows_are_copied_and_cleared_in_all_columns(void **state)
{
    (void)state;
    pl_memory memory;
    pl_memory_init(&memory, NULL);
    things t = { 0 };
    assert_true(reserve(&memory, &t, 3));
    for (uint32_t row = 0; row < 3; ++row) {
        t.weight[row] = row + 1;
        t.color[row] = (uint8_t)(row + 10);
        t.id[row] = row + 100;
    }
    pl_table_copy(&t.table, columns, COLUMN_COUNT, 2, 0);
    pl_table_clear(&t.table, columns, COLUMN_COUNT, 2);
    assert_true(t.weight[0] == 3 && t.color[0] == 12 && t.id[0] == 102);
    assert_true(t.weight[1] == 2 && t.color[1] == 11 && t.id[1] == 101);
    assert_true(t.weight[2] == 0 && t.color[2] == 0 && t.id[2] == 0);
    pl_table_free(&memory, &t.table, columns, COLUMN_COUNT);
}

static void *refuse_all(void *context, void *memory, size_t old_size, size_t new_size)
{
    (void)old_size;
    ++*(int *)context;
    if (new_size == 0) {
        free(memory);
    }
    return NULL;
}

static void failing_to_grow_keeps_everything(void **state)
{
    (void)state;
    pl_memory memory;
    pl_memory_init(&memory, NULL);
    things t = { 0 };
    pl_buffer buffer = { 0 };
    assert_true(reserve(&memory, &t, 16));
    assert_true(pl_buffer_reserve(&memory, &buffer, 100));
    t.id[15] = 42;
    ((char *)buffer.data)[99] = 'x';

    size_t bytes = memory.bytes;
    int calls = 0;
    plumb_allocator good = memory.hooks;
    memory.hooks = (plumb_allocator){ refuse_all, &calls };
    assert_false(reserve(&memory, &t, 17));
    assert_false(pl_buffer_reserve(&memory, &buffer, 1000));
    assert_int_equal(calls, 2);
    assert_int_equal(memory.bytes, bytes);
    assert_int_equal(t.table.capacity, 16);
    assert_int_equal(t.id[15], 42);
    assert_int_equal(((char *)buffer.data)[99], 'x');
    memory.hooks = good;
    pl_table_free(&memory, &t.table, columns, COLUMN_COUNT);
    pl_buffer_free(&memory, &buffer);
    assert_int_equal(memory.bytes, 0);
    assert_in_range(memory.peak, bytes, bytes);
}

static void buffers_keep_their_content_and_grow_geometrically(void **state)
{
    (void)state;
    pl_memory memory;
    pl_memory_init(&memory, NULL);
    pl_buffer buffer = { 0 };
    int grown = 0;
    for (size_t i = 0; i < 100000; ++i) {
        size_t before = buffer.size;
        assert_true(pl_buffer_reserve(&memory, &buffer, i + 1));
        grown += buffer.size != before;
        ((unsigned char *)buffer.data)[i] = (unsigned char)(i % 251);
    }
    assert_in_range(grown, 1, 30);
    for (size_t i = 0; i < 100000; ++i) {
        assert_int_equal(((unsigned char *)buffer.data)[i], i % 251);
    }
    assert_int_equal((uintptr_t)buffer.data % PL_ALIGN, 0);
    pl_buffer_free(&memory, &buffer);
    assert_int_equal(memory.bytes, 0);
}

static void sizes_that_could_wrap_are_refused_without_asking(void **state)
{
    (void)state;
    int calls = 0;
    const plumb_allocator hooks = { refuse_all, &calls };
    pl_memory memory;
    pl_memory_init(&memory, &hooks);
    assert_null(pl_resize(&memory, NULL, 0, SIZE_MAX - 10));
    assert_null(pl_resize(&memory, NULL, 0, 0));
    assert_int_equal(calls, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_are_aligned_zero_and_grow_together),
        cmocka_unit_test(rows_are_copied_and_cleared_in_all_columns),
        cmocka_unit_test(failing_to_grow_keeps_everything),
        cmocka_unit_test(buffers_keep_their_content_and_grow_geometrically),
        cmocka_unit_test(sizes_that_could_wrap_are_refused_without_asking),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
