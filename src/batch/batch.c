// batch.c - a batch is made, destroyed and asked; jobs are shared out among its workers.
//
// A job works on whole worlds in chunks of neighbours. Each leaves its result in its world's item, and
// who called looks for the first by index: nothing depends on which thread was where.
//
// Cost: of making, O(state of all worlds); of a job, a look at each result.
#include "batch/batch.h"

#include "core/try.h"
#include "plumb/snapshot.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define CHUNKS_A_WORKER 8 // so many turns each: worlds take unequal times

//---- refused calls -------------------------------------------------------------------------------

plumb_result pl_batch_fail(plumb_batch *batch, plumb_result code, const char *function,
                           const char *format, ...)
{
    int used = snprintf(batch->text, sizeof batch->text, "%s: ", function);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(batch->text + used, sizeof batch->text - (size_t)used, format, arguments);
    va_end(arguments);
    batch->trouble = (plumb_batch_trouble){ .code = code, .message = batch->text };
    return code;
}

// The message is the world's own, when its last refused call is the one.
static plumb_result tell_first(plumb_batch *batch, uint32_t first, uint32_t count)
{
    plumb_result code = batch->items[first].result;
    plumb_error said = plumb_world_error(batch->items[first].world);
    snprintf(batch->text, sizeof batch->text, "world %u: %s", (unsigned)first,
             said.code == code ? said.message : plumb_result_text(code));
    batch->trouble = (plumb_batch_trouble){ code, first, count, batch->text };
    return code;
}

plumb_batch_trouble plumb_batch_error(const plumb_batch *batch)
{
    if (batch == NULL || batch->trouble.message == NULL) {
        return (plumb_batch_trouble){ .message = "" };
    }
    return batch->trouble;
}

//---- jobs ----------------------------------------------------------------------------------------

typedef struct job {
    plumb_batch *batch;
    pl_batch_run *run;
    const void *of;
    const uint32_t *worlds; // null: all
    uint32_t count, chunk;  // chunk: worlds in one
} job;

static void run_chunk(void *context, uint32_t chunk)
{
    const job *j = context;
    uint32_t first = chunk * j->chunk;
    uint32_t end = j->count - first < j->chunk ? j->count : first + j->chunk;
    for (uint32_t i = first; i < end; ++i) {
        uint32_t index = j->worlds == NULL ? i : j->worlds[i];
        j->batch->items[index].result = j->run(j->of, j->batch, index);
    }
}

plumb_result pl_batch_for(plumb_batch *batch, pl_batch_run *run, const void *of,
                          const uint32_t *worlds, uint32_t count)
{
    uint32_t turns = CHUNKS_A_WORKER * (uint32_t)pl_tasks_workers(batch->tasks);
    job j = { batch, run, of, worlds, count, (count + turns - 1) / turns };
    if (count == 0) {
        return PLUMB_OK;
    }
    pl_tasks_run(batch->tasks, run_chunk, &j, (count + j.chunk - 1) / j.chunk);
    pl_tasks_rest(batch->tasks);
    uint32_t first = batch->desc.count, refused = 0;
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t index = worlds == NULL ? i : worlds[i];
        if (batch->items[index].result != PLUMB_OK) {
            ++refused;
            first = index < first ? index : first;
        }
    }
    return refused == 0 ? PLUMB_OK : tell_first(batch, first, refused);
}

//---- making --------------------------------------------------------------------------------------

plumb_result pl_batch_vary(plumb_batch *batch, plumb_batch_fn *vary, uint32_t index)
{
    pl_batch_item *item = &batch->items[index];
    if (vary == NULL) {
        return PLUMB_OK;
    }
    uint64_t key = plumb_random_stream(batch->desc.seed, index).key;
    plumb_random random = plumb_random_stream(key, item->episode);
    return vary(item->world, index, &random, batch->desc.context);
}

// The image of a world; one for all that are alike.
static plumb_result keep_image(plumb_batch *batch, uint32_t index)
{
    pl_batch_item *item = &batch->items[index];
    pl_batch_image *image = &item->image;
    const pl_batch_image *first = &batch->items[0].image;
    image->size = plumb_world_snapshot_size(item->world);
    image->bytes = pl_resize(&batch->memory, NULL, 0, image->size);
    if (image->bytes == NULL) {
        return PLUMB_E_MEMORY;
    }
    PL_TRY(plumb_world_save(item->world, image->bytes, image->size));
    if (index > 0 && image->size == first->size &&
        memcmp(image->bytes, first->bytes, first->size) == 0) {
        pl_resize(&batch->memory, image->bytes, image->size, 0);
        *image = (pl_batch_image){ first->bytes, first->size, true };
    }
    return PLUMB_OK;
}

static plumb_result make_world(plumb_batch *batch, const plumb_world_desc *desc, uint32_t index)
{
    PL_TRY(plumb_world_create(desc, &batch->items[index].world));
    PL_TRY(pl_batch_vary(batch, batch->desc.build, index));
    return keep_image(batch, index);
}

static plumb_result vary_one(const void *of, plumb_batch *batch, uint32_t index)
{
    (void)of;
    return pl_batch_vary(batch, batch->desc.randomise, index);
}

static plumb_result make_all(plumb_batch *batch, const plumb_world_desc *world)
{
    const plumb_batch_desc *d = &batch->desc;
    size_t bytes = d->count * sizeof *batch->items;
    batch->items = pl_resize(&batch->memory, NULL, 0, bytes);
    if (batch->items == NULL) {
        return PLUMB_E_MEMORY;
    }
    memset(batch->items, 0, bytes);
    if (d->workers > 1 || d->tasks.run != NULL) {
        batch->tasks = pl_tasks_create(&batch->memory, d->workers, &d->tasks, d->hook_context);
        if (batch->tasks == NULL) {
            return PLUMB_E_MEMORY;
        }
    }
    for (uint32_t i = 0; i < d->count; ++i) {
        PL_TRY(make_world(batch, world, i));
    }
    return d->randomise == NULL ? PLUMB_OK : pl_batch_for(batch, vary_one, NULL, NULL, d->count);
}

// Told to the log of the world's descriptor: the batch does not come to be.
static plumb_result refuse(const plumb_batch_desc *desc, plumb_result code, const char *format, ...)
{
    const plumb_world_desc *w = desc == NULL ? NULL : desc->world;
    if (w != NULL && w->log != NULL) {
        char text[160];
        int used = snprintf(text, sizeof text, "plumb_batch_create: ");
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(text + used, sizeof text - (size_t)used, format, arguments);
        va_end(arguments);
        w->log(w->hook_context, PLUMB_LOG_ERROR, text);
    }
    return code;
}

static plumb_result check(const plumb_batch_desc *desc, plumb_batch **batch)
{
    if (batch == NULL || desc == NULL) {
        return refuse(desc, PLUMB_E_NULL, "%s is null; it must be given",
                      batch == NULL ? "batch" : "desc");
    }
    if (desc->count < 1 || desc->count > PLUMB_BATCH_MAX) {
        return refuse(desc, PLUMB_E_RANGE, "count is %u; it must be 1 to %u", (unsigned)desc->count,
                      PLUMB_BATCH_MAX);
    }
    if (desc->workers < 0 || desc->workers > PLUMB_WORKERS_MAX) {
        return refuse(desc, PLUMB_E_RANGE, "workers is %d; it must be 0 to %d", desc->workers,
                      PLUMB_WORKERS_MAX);
    }
    const plumb_world_desc *w = desc->world;
    if (w != NULL && (w->workers < 0 || w->workers > 1 || w->tasks.run != NULL)) {
        return refuse(desc, PLUMB_E_RANGE,
                      "world.workers is %d; worlds of a batch work with one thread and no tasks",
                      w->workers);
    }
    return PLUMB_OK;
}

plumb_result plumb_batch_create(const plumb_batch_desc *desc, plumb_batch **batch)
{
    if (batch != NULL) {
        *batch = NULL;
    }
    PL_TRY(check(desc, batch));
    pl_memory memory;
    pl_memory_init(&memory, &desc->allocator);
    plumb_batch *made = pl_resize(&memory, NULL, 0, sizeof *made);
    if (made == NULL) {
        return refuse(desc, PLUMB_E_MEMORY, "the allocator returned no memory");
    }
    memset(made, 0, sizeof *made);
    made->memory = memory;
    made->desc = *desc;
    made->desc.world = NULL;
    made->desc.workers = desc->workers == 0 ? 1 : desc->workers;
    const plumb_result r = make_all(made, desc->world);
    if (r != PLUMB_OK) {
        plumb_batch_destroy(made);
        return refuse(desc, r, "%s", plumb_result_text(r));
    }
    *batch = made;
    return PLUMB_OK;
}

void plumb_batch_destroy(plumb_batch *batch)
{
    if (batch == NULL) {
        return;
    }
    pl_memory memory = batch->memory;
    pl_tasks_destroy(&memory, batch->tasks);
    uint32_t count = batch->items == NULL ? 0 : batch->desc.count;
    for (uint32_t i = count; i-- > 0;) { // world 0 last: others may have its image
        pl_batch_item *item = &batch->items[i];
        plumb_world_destroy(item->world);
        if (item->image.bytes != NULL && !item->image.shared) {
            pl_resize(&memory, item->image.bytes, item->image.size, 0);
        }
    }
    if (batch->items != NULL) {
        pl_resize(&memory, batch->items, count * sizeof *batch->items, 0);
    }
    pl_resize(&memory, batch, sizeof *batch, 0);
}

//---- questions -----------------------------------------------------------------------------------

uint32_t plumb_batch_count(const plumb_batch *batch)
{
    return batch == NULL ? 0 : batch->desc.count;
}

plumb_world *plumb_batch_world(plumb_batch *batch, uint32_t index)
{
    return batch == NULL || index >= batch->desc.count ? NULL : batch->items[index].world;
}

uint64_t plumb_batch_episode(const plumb_batch *batch, uint32_t index)
{
    return batch == NULL || index >= batch->desc.count ? 0 : batch->items[index].episode;
}

plumb_result plumb_batch_result(const plumb_batch *batch, uint32_t index)
{
    return batch == NULL || index >= batch->desc.count ? PLUMB_E_RANGE : batch->items[index].result;
}

size_t plumb_batch_bytes(const plumb_batch *batch)
{
    size_t bytes = batch == NULL ? 0 : batch->memory.bytes;
    for (uint32_t i = 0; i < plumb_batch_count(batch); ++i) {
        bytes += plumb_world_stats(batch->items[i].world).bytes;
    }
    return bytes;
}
