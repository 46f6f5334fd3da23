// sort.c - see sort.h. Cost: O(n log n) to sort, O(log n) to find.
#include "core/sort.h"

#include <string.h>

static bool comes_before(const pl_keyed *a, const pl_keyed *b)
{
    return a->key != b->key       ? a->key < b->key
           : a->order != b->order ? a->order < b->order
                                  : a->value < b->value;
}

// Lets the item at `root` sink to its place in the heap of the first `count`.
static void sink(pl_keyed *items, uint32_t root, uint32_t count)
{
    pl_keyed sinking = items[root];
    for (uint32_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        if (child + 1 < count && comes_before(&items[child], &items[child + 1])) {
            ++child;
        }
        if (!comes_before(&sinking, &items[child])) {
            break;
        }
        items[root] = items[child];
        root = child;
    }
    items[root] = sinking;
}

void pl_sort_keyed(pl_keyed *items, uint32_t count)
{
    for (uint32_t root = count / 2; root-- > 0;) {
        sink(items, root, count);
    }
    for (uint32_t last = count; last-- > 1;) {
        pl_keyed largest = items[0];
        items[0] = items[last];
        items[last] = largest;
        sink(items, 0, last);
    }
}

uint32_t pl_find_key(const void *items, uint32_t count, uint32_t stride, uint64_t key, bool *found)
{
    uint32_t low = 0, high = count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        uint64_t at;
        memcpy(&at, (const char *)items + (size_t)middle * stride, sizeof at);
        if (at < key) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    *found = false;
    if (low < count) {
        uint64_t at;
        memcpy(&at, (const char *)items + (size_t)low * stride, sizeof at);
        *found = at == key;
    }
    return low;
}

uint32_t pl_counts_to_places(uint32_t *counts, uint32_t kinds, uint32_t first)
{
    for (uint32_t k = 0; k < kinds; ++k) {
        uint32_t here = counts[k];
        counts[k] = first;
        first += here;
    }
    return first;
}
