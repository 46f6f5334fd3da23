// index.h - where what lies in a recording, as found when it is opened.
#ifndef PL_RECORD_INDEX_H
#define PL_RECORD_INDEX_H

#include "core/sort.h"
#include "record/format.h"

typedef struct pl_key_place {
    uint64_t step;    // steps taken there
    const char *data; // image
    size_t bytes;
    uint32_t code; // of pl_index.codes
    bool edits;    // the user's edits before the next step are in it
} pl_key_place;

typedef struct pl_code_place {
    const char *data;
    size_t bytes;
} pl_code_place;

// What is kept by a key from a step on: names by entity, notes by the user's key.
typedef struct pl_kept_place {
    uint64_t step; // steps taken there
    const char *data;
    size_t bytes;
} pl_kept_place;

typedef struct pl_kept {
    pl_buffer places; // pl_kept_place, in order
    pl_buffer keyed;  // pl_keyed: key, which place; sorted
    uint32_t count;
} pl_kept;

typedef struct pl_index {
    pl_record_header header;
    pl_buffer steps; // pl_chunk each
    pl_buffer keys;  // pl_key_place, in order
    pl_buffer codes; // pl_code_place, in order
    pl_kept names;   // the last one of an entity counts
    pl_kept notes;
    uint64_t step_count, edited, bytes;
    uint32_t key_count, code_count;
    bool complete;
} pl_index;

// Verifies a recording and fills an empty index. What is wrong; NULL: nothing. *starved: memory ran out.
const char *pl_index_make(pl_memory *memory, const char *bytes, size_t size, pl_index *index,
                          bool *starved);
void pl_index_free(pl_memory *memory, pl_index *index);

static inline const pl_chunk *pl_index_step(const pl_index *index, uint64_t i)
{
    return (const pl_chunk *)index->steps.data + i;
}

static inline const pl_key_place *pl_index_key(const pl_index *index, uint32_t i)
{
    return (const pl_key_place *)index->keys.data + i;
}

// The head of step i, from 0.
pl_step_head pl_index_step_head(const pl_index *index, uint64_t i);
// The last key from which `step` can be reached with at least one step; the first one if none.
const pl_key_place *pl_index_key_before(const pl_index *index, uint64_t step);
// The key that takes the place of the user's edits before step i; NULL: none.
const pl_key_place *pl_index_key_of_edits(const pl_index *index, uint64_t i);
// The last place of a key up to `step`; NULL: none.
const pl_kept_place *pl_kept_find(const pl_kept *kept, uint64_t key, uint64_t step);

#endif
