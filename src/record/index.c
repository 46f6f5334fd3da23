// index.c - see index.h. Reads: the recording. Cost: O(bytes) digested; look-ups O(log entries).
#include "record/index.h"

#include "plumb/record.h"

#include <string.h>

typedef struct scan {
    pl_memory *memory;
    pl_index *index;
    bool starved;
} scan;

// Appends an element; false when out of memory.
static bool append(scan *s, pl_buffer *list, uint64_t count, const void *element, size_t size)
{
    if (!pl_buffer_reserve(s->memory, list, (size_t)(count + 1) * size)) {
        s->starved = true;
        return false;
    }
    memcpy((char *)list->data + (size_t)count * size, element, size);
    return true;
}

//---- what chunks must be like --------------------------------------------------------------------

// All of a CODE chunk lies inside, and its texts end.
static bool is_code(const pl_chunk *chunk)
{
    pl_code_head head;
    size_t at = sizeof head;
    if (chunk->bytes < sizeof head) {
        return false;
    }
    memcpy(&head, chunk->data, sizeof head);
    if (head.components > PL_COMPONENT_MAX || head.systems > PL_SYSTEM_MAX) {
        return false;
    }
    for (uint32_t i = 0; i < head.components; ++i) {
        pl_code_component c;
        if (chunk->bytes - at < sizeof c) {
            return false;
        }
        memcpy(&c, chunk->data + at, sizeof c);
        at += sizeof c;
        if (c.fields > 64 || chunk->bytes - at < c.fields * sizeof(pl_code_field) ||
            memchr(c.name, '\0', sizeof c.name) == NULL) {
            return false;
        }
        at += (size_t)c.fields * sizeof(pl_code_field);
    }
    return chunk->bytes - at == head.systems * sizeof(pl_code_system);
}

// All edits lie inside.
static bool is_step(const pl_chunk *chunk, pl_step_head *head)
{
    size_t at = sizeof *head;
    if (chunk->bytes < at) {
        return false;
    }
    memcpy(head, chunk->data, sizeof *head);
    if (!(head->dt >= 0 && head->dt <= 1)) {
        return false;
    }
    for (uint64_t i = 0; i < head->edits; ++i) {
        pl_edit_head edit;
        if (chunk->bytes - at < sizeof edit) {
            return false;
        }
        memcpy(&edit, chunk->data + at, sizeof edit);
        at += sizeof edit;
        if (edit.bytes > chunk->bytes - at ||
            pl_image_padded((size_t)edit.bytes) > chunk->bytes - at) {
            return false;
        }
        at += pl_image_padded((size_t)edit.bytes);
    }
    return at == chunk->bytes;
}

//---- chunks --------------------------------------------------------------------------------------

static bool add_code(scan *s, const pl_chunk *chunk)
{
    const pl_code_place place = { chunk->data, chunk->bytes };
    pl_index *index = s->index;
    if (!is_code(chunk) || !append(s, &index->codes, index->code_count, &place, sizeof place)) {
        return false;
    }
    ++index->code_count;
    return true;
}

static bool add_key(scan *s, const pl_chunk *chunk)
{
    pl_index *index = s->index;
    pl_key_head head;
    if (chunk->bytes < sizeof head || index->code_count == 0) {
        return false;
    }
    memcpy(&head, chunk->data, sizeof head);
    const pl_key_place place = { .step = head.step,
                                 .data = chunk->data + sizeof head,
                                 .bytes = chunk->bytes - sizeof head,
                                 .code = index->code_count - 1,
                                 .edits = head.edits != 0 };
    if (head.step != index->step_count ||
        !append(s, &index->keys, index->key_count, &place, sizeof place)) {
        return false;
    }
    ++index->key_count;
    return true;
}

static bool add_step(scan *s, const pl_chunk *chunk)
{
    pl_index *index = s->index;
    pl_step_head head;
    if (index->key_count == 0 || !is_step(chunk, &head) ||
        !append(s, &index->steps, index->step_count, chunk, sizeof *chunk)) {
        return false;
    }
    index->edited += head.edits > 0 || pl_index_key_of_edits(index, index->step_count) != NULL;
    ++index->step_count;
    return true;
}

static bool keep(scan *s, pl_kept *kept, uint64_t key, const char *data, size_t bytes)
{
    const pl_kept_place place = { s->index->step_count, data, bytes };
    const pl_keyed keyed = { key, kept->count, kept->count };
    if (!append(s, &kept->places, kept->count, &place, sizeof place) ||
        !append(s, &kept->keyed, kept->count, &keyed, sizeof keyed)) {
        return false;
    }
    ++kept->count;
    return true;
}

static bool add_name(scan *s, const pl_chunk *chunk)
{
    plumb_entity entity;
    if (chunk->bytes != sizeof entity + PL_NAME_MAX) {
        return false;
    }
    memcpy(&entity, chunk->data, sizeof entity);
    const char *text = chunk->data + sizeof entity;
    return memchr(text, '\0', PL_NAME_MAX) != NULL &&
           keep(s, &s->index->names, pl_key(entity.index, entity.generation), text, PL_NAME_MAX);
}

static bool add_note(scan *s, const pl_chunk *chunk)
{
    pl_note_head head;
    if (chunk->bytes < sizeof head) {
        return false;
    }
    memcpy(&head, chunk->data, sizeof head);
    return head.bytes <= PLUMB_NOTE_MAX &&
           chunk->bytes - sizeof head == pl_image_padded((size_t)head.bytes) &&
           keep(s, &s->index->notes, head.key, chunk->data + sizeof head, (size_t)head.bytes);
}

static bool add_chunk(scan *s, const pl_chunk *chunk)
{
    switch (chunk->kind) {
    case PL_CHUNK_CODE:
        return add_code(s, chunk);
    case PL_CHUNK_KEY:
        return add_key(s, chunk);
    case PL_CHUNK_STEP:
        return add_step(s, chunk);
    case PL_CHUNK_NAME:
        return add_name(s, chunk);
    case PL_CHUNK_NOTE:
        return add_note(s, chunk);
    case PL_CHUNK_END:
        s->index->complete = true;
        return true;
    default:
        return false;
    }
}

const char *pl_index_make(pl_memory *memory, const char *bytes, size_t size, pl_index *index,
                          bool *starved)
{
    scan s = { .memory = memory, .index = index };
    const char *wrong = pl_record_open(bytes, size, &index->header);
    size_t at = sizeof index->header;
    *starved = false;
    if (wrong != NULL) {
        return wrong;
    }
    for (uint32_t number = 0; !index->complete; ++number) {
        pl_chunk chunk;
        pl_chunk_state state = pl_chunk_read(bytes, size, &at, number, &chunk);
        if (state == PL_CHUNK_CUT) {
            break;
        }
        if (state == PL_CHUNK_DAMAGED || !add_chunk(&s, &chunk)) {
            *starved = s.starved;
            return "is damaged";
        }
    }
    if (index->key_count == 0) {
        return "is truncated before its first step";
    }
    index->bytes = at;
    pl_kept *const sorted[] = { &index->names, &index->notes };
    for (size_t i = 0; i < sizeof sorted / sizeof sorted[0]; ++i) {
        if (sorted[i]->count > 0) {
            pl_sort_keyed(sorted[i]->keyed.data, sorted[i]->count);
        }
    }
    return NULL;
}

void pl_index_free(pl_memory *memory, pl_index *index)
{
    pl_buffer_free(memory, &index->steps);
    pl_buffer_free(memory, &index->keys);
    pl_buffer_free(memory, &index->codes);
    pl_kept *const all[] = { &index->names, &index->notes };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) {
        pl_buffer_free(memory, &all[i]->places);
        pl_buffer_free(memory, &all[i]->keyed);
    }
}

//---- look-ups ------------------------------------------------------------------------------------

pl_step_head pl_index_step_head(const pl_index *index, uint64_t i)
{
    pl_step_head head;
    memcpy(&head, pl_index_step(index, i)->data, sizeof head);
    return head;
}

// How many keys lie before `step`.
static uint32_t keys_below(const pl_index *index, uint64_t step)
{
    uint32_t low = 0, high = index->key_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (pl_index_key(index, middle)->step < step) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

const pl_key_place *pl_index_key_before(const pl_index *index, uint64_t step)
{
    uint32_t below = keys_below(index, step);
    return pl_index_key(index, below > 0 ? below - 1 : 0);
}

const pl_key_place *pl_index_key_of_edits(const pl_index *index, uint64_t i)
{
    const pl_key_place *last = NULL; // steps that were refused leave theirs before it
    for (uint32_t k = keys_below(index, i); k < index->key_count; ++k) {
        const pl_key_place *key = pl_index_key(index, k);
        if (key->step != i) {
            break;
        }
        last = key->edits ? key : last;
    }
    return last;
}

const pl_kept_place *pl_kept_find(const pl_kept *kept, uint64_t key, uint64_t step)
{
    const pl_keyed *keyed = kept->keyed.data;
    const pl_kept_place *places = kept->places.data;
    uint32_t low = 0, high = kept->count; // the first beyond
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        bool beyond = keyed[middle].key > key ||
                      (keyed[middle].key == key && places[keyed[middle].value].step > step);
        low = beyond ? low : middle + 1;
        high = beyond ? middle : high;
    }
    return low > 0 && keyed[low - 1].key == key ? &places[keyed[low - 1].value] : NULL;
}
