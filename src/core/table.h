// table.h - a table of columns: parallel arrays, one 64-byte aligned block, rows addressed by
// index. A concrete table is a struct whose first member is pl_table and whose other members are
// the column pointers; its columns are described by an array of pl_column made from one X-macro
// list.
#ifndef PL_TABLE_H
#define PL_TABLE_H

#include "core/memory.h"

typedef struct pl_column {
    size_t offset; // of the column pointer in the concrete table
    size_t size;   // of one value
} pl_column;

typedef struct pl_table {
    uint32_t count;    // rows in use, kept by the owner
    uint32_t capacity; // rows allocated
    void *block;
    size_t block_size;
} pl_table;

// Grows to at least `capacity` rows; all columns move together or not at all. New rows are zero.
bool pl_table_reserve(pl_memory *memory, pl_table *table, const pl_column *columns,
                      size_t column_count, uint32_t capacity);
void pl_table_free(pl_memory *memory, pl_table *table, const pl_column *columns,
                   size_t column_count);

// Copies row `from` over row `to`; zeroes a row.
void pl_table_copy(pl_table *table, const pl_column *columns, size_t column_count, uint32_t from,
                   uint32_t to);
void pl_table_clear(pl_table *table, const pl_column *columns, size_t column_count, uint32_t row);
// Exchanges two rows.
void pl_table_swap(pl_table *table, const pl_column *columns, size_t column_count, uint32_t a,
                   uint32_t b);

#endif
